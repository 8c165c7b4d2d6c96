/* Formats that are not read here: assimp does, behind the fence, because it reads out of bounds on some damaged
 * files and takes all memory on others. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "fence/fence.h"
#include "import/assimp_stream.h"
#include "import/build.h"
#include "import/threemf.h"

/* The ending is all that assimp needs of the path. */
static void put_request(fence_bytes *request, const import_job *job)
{
    const char *slash = strrchr(job->path, '/');
    fence_put_text(request, slash ? slash + 1 : job->path);
    fence_put(request, job->file->data, job->file->size);
}

/* Files that assimp looked for beside the model, and that are there. */
static lmn_status warn_of_others(const import_job *job, fence_reader *r, lmn_error *error)
{
    for (uint32_t i = 0, count = fence_take_u32(r); i < count && !r->ended; i++) {
        char *raw = fence_take_text(r), *name = raw ? scene_clean_name(raw, strlen(raw)) : NULL;
        bool  there = name && build_has_file(job, name);
        mem_free(raw);
        if (!name)
            return error_memory(error);
        if (there)
            warnings_add(&job->scene->warnings, WARNING_IGNORED,
                         "the file \"%s\" beside the model is not read in this format", name);
        mem_free(name);
    }
    return LMN_OK;
}

lmn_status assimp_load(const import_job *job, lmn_error *error)
{
    fence_bytes request = {0}, answer;
    put_request(&request, job);
    lmn_status status = fence_call_always(&answer, assimp_read, "the reader of this format", &request, error);
    mem_free(request.bytes);
    if (status == LMN_FORMAT || status == LMN_LIMIT)
        error_hint(error, "convert the model to glTF, for example with Blender");
    if (status != LMN_OK) {
        error_file(error, job->path);
        return status;
    }
    char ending[16];
    file_ending(job->path, ending, sizeof ending);
    const bool threemf = strcmp(ending, ".3mf") == 0;
    if (threemf)
        job->scene->up = 'z'; /* by its specification, which assimp leaves to its users */
    fence_reader r = fence_read(answer.bytes, answer.size);
    status = warn_of_others(job, &r, error);
    if (status == LMN_OK)
        status = assimp_stream_read(job, r.at, (size_t)(r.end - r.at), error);
    mem_free(answer.bytes);
    return status == LMN_OK && threemf ? threemf_describe(job, error) : status;
}

const import_format import_assimp = {
    "a format that assimp reads",
    ".fbx .dae .3ds .off .3mf .blend .x .ase .ac .lwo .dxf .b3d .md2 .md3 .md5mesh .ms3d .x3d .cob .amf .assbin",
    'y',
    false,
    NULL,
    assimp_load};
