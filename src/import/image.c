/* Images of models: decoded into the scene, or warned about. */
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/image_read.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/build.h"
#include "import/import.h"

static const char stroke_ending[] = ".stx";

/* Seed 001, section 5.3.2: strokes lie beside the picture that showed where they go, under its name. *out stays NULL when there are none. */
static lmn_status find_strokes(const import_job *job, const char *name, char **out, lmn_error *error)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(name, '.');
    size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - name) : strlen(name);
    text beside = {0};
    text_append_bytes(&beside, name, stem);
    text_append(&beside, "%s", stroke_ending);
    char *own = text_take(&beside), *path = own ? file_beside(job->path, own) : NULL;
    mem_free(own);
    if (!path)
        return error_memory(error);
    if (access(path, R_OK) == 0)
        *out = path;
    else
        mem_free(path);
    return LMN_OK;
}

/* A material whose picture was replaced by its strokes: white where these are not drawn. */
static lmn_status build_strokes(const import_job *job, const char *name, int32_t *out, lmn_error *error)
{
    image white = {.width = 1, .height = 1, .pixels = mem_copy("\xff\xff\xff\xff", 4), .name = mem_copy_text(name), .strokes = file_beside(job->path, name)};
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

lmn_status build_image_bytes(const import_job *job, const char *name, const unsigned char *bytes, size_t size,
                             int32_t *out, lmn_error *error)
{
    *out = NONE;
    char ending[8];
    file_ending(name, ending, sizeof ending);
    if (strcmp(ending, stroke_ending) == 0)
        return build_strokes(job, name, out, error);
    lmn_error problem;
    image_pixels pixels;
    lmn_status status = image_read(&pixels, bytes, size, &problem);
    if (status == LMN_MEMORY)
        return error_memory(error);
    if (status != LMN_OK) {
        warnings_add(&job->scene->warnings, WARNING_BAD_TEXTURE, "texture \"%s\": %s", name, problem.message);
        return LMN_OK;
    }
    image decoded = {.width = pixels.width, .height = pixels.height, .pixels = pixels.rgba};
    size_t total = (size_t)decoded.width * decoded.height;
    for (size_t i = 0; i < job->scene->image_count; i++)
        total += (size_t)job->scene->images[i].width * job->scene->images[i].height;
    if (total > LIMIT_SCENE_PIXELS) {
        warnings_add(&job->scene->warnings, WARNING_BAD_TEXTURE, "texture \"%s\": all textures together have more than %zu pixels",
                     name, LIMIT_SCENE_PIXELS);
        mem_free(decoded.pixels);
        return LMN_OK;
    }
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
    return LMN_OK;
}

lmn_status build_image_file(const import_job *job, const char *name, int32_t *out, lmn_error *error)
{
    *out = NONE;
    file_data file;
    lmn_status status = build_side_file(job, "texture", name, &file, error);
    if (status != LMN_OK || !file.data)
        return status;
    status = build_image_bytes(job, name, file.data, file.size, out, error);
    file_data_release(&file);
    return status;
}
