/* include/limner/maps.h: checks arguments and forwards. */
#include "limner/maps.h"

#include <string.h>

#include "api/check_desc.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "draw/pick.h"

int lmn_map_components(lmn_map map)
{
    static const int components[] = {
        [LMN_MAP_DEPTH] = 1, [LMN_MAP_NORMAL] = 3,      [LMN_MAP_ID] = 1,       [LMN_MAP_EDGE] = 4,
        [LMN_MAP_SHADE] = 4, [LMN_MAP_UNCERTAINTY] = 3, [LMN_MAP_VELOCITY] = 3, [LMN_MAP_DIRECTION] = 3};
    return map >= LMN_MAP_DEPTH && map <= LMN_MAP_DIRECTION ? components[map] : 0;
}

static lmn_status on_gpu_alone(const char *caller, lmn_error *error)
{
    error_set(error, LMN_USAGE, "%s: the drawing lies on the GPU alone", caller);
    error_hint(error, "call lmn_drawing_read_back before the renderer draws again");
    return LMN_USAGE;
}

static lmn_status check_drawing(const lmn_drawing *d, const char *caller, lmn_error *error)
{
    if (!d)
        return error_set(error, LMN_USAGE, "%s: `drawing` is NULL", caller);
    if (d->maps.depth)
        return LMN_OK;
    if (d->kept && d->kept->maps.on_gpu)
        return on_gpu_alone(caller, error);
    error_set(error, LMN_USAGE, "%s: the drawing was made without its maps", caller);
    error_hint(error, "set `maps` in its description");
    return LMN_USAGE;
}

lmn_status lmn_drawing_copy_map(const lmn_drawing *d, lmn_map map, void *out, size_t count, lmn_error *error)
{
    const char *caller = "lmn_drawing_copy_map";
    lmn_status  status = check_drawing(d, caller, error);
    if (status != LMN_OK)
        return status;
    size_t components = (size_t)lmn_map_components(map), row = (size_t)d->width * components;
    if (!components)
        return error_set(error, LMN_USAGE, "%s: %d is no map", caller, (int)map);
    if (!out || count != row * (size_t)d->height)
        return error_set(error, LMN_USAGE, "%s: there is room for %zu numbers, not %zu", caller, out ? count : 0,
                         row * (size_t)d->height);
    const char *from = pick_map(d, map);
    if (!from)
        return error_set(error, LMN_USAGE, "%s: the drawing does not have this map", caller);
    row *= sizeof(float); /* as large as uint32_t */
    for (size_t y = 0; y < (size_t)d->height; y++)
        memcpy((char *)out + y * row, from + ((size_t)d->height - 1 - y) * row, row);
    return LMN_OK;
}

lmn_status lmn_drawing_pick(const lmn_drawing *d, int x, int y, lmn_pick *out, lmn_error *error)
{
    lmn_status status = check_drawing(d, "lmn_drawing_pick", error);
    if (status == LMN_OK && !out)
        return error_set(error, LMN_USAGE, "lmn_drawing_pick: `out` is NULL");
    if (status != LMN_OK)
        return status;
    memset(out, 0, sizeof *out);
    if (x >= 0 && y >= 0 && x < d->width && y < d->height)
        *out = pick_at(d, x, y);
    return LMN_OK;
}

lmn_status lmn_draw_pick(lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                         const lmn_draw_desc *desc, int x, int y, lmn_pick *out, lmn_error *error)
{
    if (out)
        memset(out, 0, sizeof *out);
    if (!renderer || !scene || !look || !out)
        return error_set(error, LMN_USAGE, "lmn_draw_pick: a renderer, a scene, a look and `out` are needed");
    lmn_draw_desc full;
    lmn_status    status = check_draw_desc(&full, desc, error);
    if (status != LMN_OK)
        return status;
    full.maps = full.profile = full.textures = false;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    status = check_pixels(&full, error);
    if (status == LMN_OK)
        status = renderer_pick(renderer, scene, look, &full, x, y, out, error);
    return work_end(&w, status, error);
}

lmn_status lmn_drawing_pick_parts(const lmn_drawing *d, int x, int y, int width, int height, uint32_t *parts,
                                  size_t capacity, size_t *count, lmn_error *error)
{
    lmn_status status = check_drawing(d, "lmn_drawing_pick_parts", error);
    if (status == LMN_OK && (!count || (!parts && capacity)))
        return error_set(error, LMN_USAGE, "lmn_drawing_pick_parts: `%s` is NULL", count ? "parts" : "count");
    if (status != LMN_OK)
        return status;
    bool *seen = mem_calloc(d->facts.part_count + 1, sizeof *seen);
    if (!seen)
        return error_memory(error);
    int64_t right = (int64_t)x + width, low = (int64_t)y + height;
    for (int64_t v = y > 0 ? y : 0; v < low && v < d->height; v++)
        for (int64_t u = x > 0 ? x : 0; u < right && u < d->width; u++) {
            uint32_t id = d->maps.id[(size_t)(d->height - 1 - v) * (size_t)d->width + (size_t)u];
            seen[id <= d->facts.part_count ? id : 0] = true;
        }
    *count = 0;
    for (size_t i = 1; i <= d->facts.part_count; i++) {
        if (seen[i] && *count < capacity)
            parts[*count] = (uint32_t)i;
        *count += seen[i];
    }
    mem_free(seen);
    return LMN_OK;
}

bool lmn_drawing_project(const lmn_drawing *d, const double point[3], double pixel[2], double *depth)
{
    double ignored;
    return d && point && pixel && pick_project(d, point, pixel, depth ? depth : &ignored);
}

void lmn_drawing_unproject(const lmn_drawing *d, const double pixel[2], double depth, double point[3])
{
    if (d && pixel && point)
        pick_unproject(d, pixel, depth, point);
}

void lmn_drawing_camera(const lmn_drawing *d, double view[16], double projection[16])
{
    if (d && view)
        memcpy(view, d->camera.view.m, sizeof d->camera.view.m);
    if (d && projection)
        memcpy(projection, d->camera.projection.m, sizeof d->camera.projection.m);
}
