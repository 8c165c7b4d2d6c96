/* Images of models: decoded into the scene, or warned about. */
#include "base/image_read.h"
#include "base/limits.h"
#include "base/memory.h"
#include "import/build.h"
#include "import/import.h"

lmn_status build_image_bytes(const import_job *job, const char *name, const unsigned char *bytes, size_t size,
                             int32_t *out, lmn_error *error)
{
    *out = NONE;
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
    decoded.name = mem_copy_text(name);
    image *added = decoded.name ? scene_append_image(job->scene) : NULL;
    if (!added) {
        mem_free(decoded.name);
        mem_free(decoded.pixels);
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
