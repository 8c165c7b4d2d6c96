/* KHR_animation_pointer: what a JSON pointer into the file moves in the scene. */
#include <string.h>

#include "import/gltf.h"

/* A pointer is `before`, an index, and `after`. */
typedef struct pointer_row {
    const char    *before, *after;
    animation_path path;
} pointer_row;

static const pointer_row rows[] = {
    {"/nodes/", "/translation", PATH_TRANSLATION},
    {"/nodes/", "/rotation", PATH_ROTATION},
    {"/nodes/", "/scale", PATH_SCALE},
    {"/nodes/", "/weights", PATH_WEIGHTS},
    {"/cameras/", "/perspective/yfov", PATH_CAMERA_FOV},
    {"/cameras/", "/orthographic/ymag", PATH_CAMERA_HALF_HEIGHT},
    {"/extensions/KHR_lights_punctual/lights/", "/color", PATH_LIGHT_COLOUR},
    {"/extensions/KHR_lights_punctual/lights/", "/intensity", PATH_LIGHT_INTENSITY},
};
enum { ROWS = sizeof rows / sizeof *rows, DIGITS_MAX = 9 };

/* The index of a JSON pointer: digits without zeros in front. Returns what stands behind it, NULL when it is none. */
static const char *parse_index(const char *at, size_t *out)
{
    int digits = 0;
    *out = 0;
    while (digits < DIGITS_MAX && at[digits] >= '0' && at[digits] <= '9')
        *out = *out * 10 + (size_t)(at[digits++] - '0');
    return digits == 0 || (at[0] == '0' && digits > 1) ? NULL : at + digits;
}

static const pointer_row *find_row(const char *pointer, size_t *index)
{
    for (size_t i = 0; i < ROWS; i++) {
        size_t length = strlen(rows[i].before);
        if (strncmp(pointer, rows[i].before, length) != 0)
            continue;
        const char *after = parse_index(pointer + length, index);
        if (after && strcmp(after, rows[i].after) == 0)
            return &rows[i];
    }
    return NULL;
}

/* Cameras and lights are in the scene in the order of the file. A camera has one of its two properties. */
static gltf_pointer find_target(const gltf_reader *r, size_t index, animation_path path, int32_t *target)
{
    const lmn_scene *s = r->scene;
    *target = (int32_t)index;
    switch (animation_thing_of(path)) {
    case ANIMATED_NODE:
        if (index >= r->node_count)
            return GLTF_POINTER_UNKNOWN;
        *target = r->node_map[index];
        return *target == NONE ? GLTF_POINTER_OUTSIDE : GLTF_POINTER_FOUND;
    case ANIMATED_CAMERA:
        return index < s->camera_count && s->cameras[index].orthographic == (path == PATH_CAMERA_HALF_HEIGHT)
                   ? GLTF_POINTER_FOUND
                   : GLTF_POINTER_UNKNOWN;
    default: return index < s->light_count ? GLTF_POINTER_FOUND : GLTF_POINTER_UNKNOWN;
    }
}

gltf_pointer gltf_find_pointer(const gltf_reader *r, const char *pointer, animation_path *path, int32_t *target)
{
    size_t             index;
    const pointer_row *row = find_row(pointer, &index);
    if (!row)
        return GLTF_POINTER_UNKNOWN;
    *path = row->path;
    return find_target(r, index, row->path, target);
}
