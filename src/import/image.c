/* Images of models: decoded into the scene, or warned about. */
#include <string.h>

#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/work.h"
#include "fence/image_read.h"
#include "import/access.h"
#include "import/build.h"
#include "import/import.h"

static const char stroke_ending[] = ".stx";

/* Freudenberg 2003, section 5.3.2: strokes lie beside the picture that showed where they go, under its name. *out
 * stays NULL when there are none. */
static lmn_status find_strokes(const import_job *job, const char *name, char **out, lmn_error *error)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(name, '.');
    size_t      stem = dot && (!slash || dot > slash) ? (size_t)(dot - name) : strlen(name);
    text        beside = {0};
    text_append_bytes(&beside, name, stem);
    text_append(&beside, "%s", stroke_ending);
    char *own = text_take(&beside), *path = own ? file_beside(job->path, own) : NULL;
    mem_free(own);
    if (!path)
        return error_memory(error);
    if (access_has(job, path))
        *out = path;
    else
        mem_free(path);
    return LMN_OK;
}

/* A material whose picture was replaced by its strokes: white where these are not drawn. */
static lmn_status build_strokes(const import_job *job, const char *name, int32_t *out, lmn_error *error)
{
    image  white = {.width = 1,
                    .height = 1,
                    .pixels = mem_copy("\xff\xff\xff\xff", 4),
                    .name = mem_copy_text(name),
                    .strokes = file_beside(job->path, name)};
    image *added = white.pixels && white.name && white.strokes ? scene_append_image(job->scene) : NULL;
    if (!added) {
        mem_free(white.pixels);
        mem_free(white.name);
        mem_free(white.strokes);
        return error_memory(error);
    }
    *added = white;
    *out = (int32_t)job->scene->image_count - 1;
    return LMN_OK;
}

static void note_halved(const import_job *job, const char *name, const image *i, int times)
{
    warnings_add(&job->scene->warnings, WARNING_REDUCED,
                 "texture \"%s\" was made smaller, to %u x %u (1/%d): the limit for textures is %.0f MiB", name,
                 i->width, i->height, 1 << times, (double)work_limits().textures / (1 << 20));
}

static size_t bytes_of(const image *i)
{
    return (size_t)i->width * i->height * 4;
}

/* Halves the largest textures until all fit. */
static void make_room(const import_job *job, size_t capacity)
{
    lmn_scene *s = job->scene;
    while (capacity && !work_stopped()) {
        size_t total = 0;
        image *largest = NULL;
        for (size_t i = 0; i < s->image_count; i++) {
            total += bytes_of(&s->images[i]);
            if (!largest || bytes_of(&s->images[i]) > bytes_of(largest))
                largest = &s->images[i];
        }
        if (total <= capacity || bytes_of(largest) <= 4)
            return;
        image_pixels p = {.width = largest->width, .height = largest->height, .rgba = largest->pixels};
        image_halve(&p);
        void *smaller = mem_realloc(p.rgba, (size_t)p.width * p.height * 4);
        largest->pixels = smaller ? smaller : p.rgba;
        largest->width = p.width;
        largest->height = p.height;
        note_halved(job, largest->name ? largest->name : "", largest, 1);
    }
}

lmn_status build_image_bytes(const import_job *job, const char *name, const unsigned char *bytes, size_t size,
                             int32_t *out, lmn_error *error)
{
    *out = NONE;
    char ending[8];
    file_ending(name, ending, sizeof ending);
    if (strcmp(ending, stroke_ending) == 0)
        return build_strokes(job, name, out, error);
    lmn_error    problem;
    image_pixels pixels;
    size_t       capacity = (size_t)work_limits().textures;
    lmn_status   status = image_read(&pixels, bytes, size, capacity, &problem);
    if (status == LMN_MEMORY)
        return error_set(error, status, "texture \"%s\": %s", name, problem.message);
    if (status == LMN_CANCELLED || work_stopped()) {
        mem_free(pixels.rgba); /* time may run out while it is read, and it is read nevertheless */
        return work_check(error);
    }
    if (status != LMN_OK) {
        warnings_add(&job->scene->warnings, WARNING_BAD_TEXTURE, "texture \"%s\": %s", name, problem.message);
        return LMN_OK;
    }
    image decoded = {.width = pixels.width, .height = pixels.height, .pixels = pixels.rgba};
    if (find_strokes(job, name, &decoded.strokes, error) != LMN_OK) {
        mem_free(decoded.pixels);
        return LMN_MEMORY;
    }
    decoded.name = mem_copy_text(name);
    image *added = decoded.name ? scene_append_image(job->scene) : NULL;
    if (!added) {
        mem_free(decoded.name);
        mem_free(decoded.pixels);
        mem_free(decoded.strokes);
        return error_memory(error);
    }
    *added = decoded;
    *out = (int32_t)job->scene->image_count - 1;
    if (pixels.halved)
        note_halved(job, name, &decoded, pixels.halved);
    make_room(job, capacity);
    return LMN_OK;
}

lmn_status build_image_file(const import_job *job, const char *name, int32_t *out, lmn_error *error)
{
    *out = NONE;
    file_data  file;
    lmn_status status = build_side_file(job, "texture", name, &file, error);
    if (status != LMN_OK || !file.data)
        return status;
    status = build_image_bytes(job, name, file.data, file.size, out, error);
    file_data_release(&file);
    return status;
}
