/* One fuzzer a parser, chosen by a macro. Input goes to the reader and, when it is accepted, through everything that is
 * derived from meshes; side files are looked for in an empty place. */
#include <string.h>

#include "base/memory.h"
#include "base/image_read.h"
#include "halftone/strokes.h"
#include "import/assimp_stream.h"
#include "import/csg.h"
#include "import/import.h"
#include "scene/mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static lmn_status read_format(const import_job *job, lmn_error *error)
{
#if defined(FUZZ_gltf)
    return import_gltf.read(job, error);
#elif defined(FUZZ_stl)
    return import_stl.read(job, error);
#elif defined(FUZZ_ply)
    return import_ply.read(job, error);
#elif defined(FUZZ_obj)
    return import_obj.read(job, error);
#elif defined(FUZZ_csg)
    return import_csg.read(job, error);
#elif defined(FUZZ_dxf)
    const csg_drawing how = {.layer = "", .scale = 1, .facets = {8, 12, 2}};
    region figure = {0};
    lmn_status status = csg_dxf((const char *)job->file->data, job->file->size, &how, &figure, error);
    region_release(&figure);
    return status == LMN_OK ? LMN_CANCELLED : status;
#elif defined(FUZZ_stx) || defined(FUZZ_svg)
    strokes s = {0};
#if defined(FUZZ_stx)
    lmn_status status = strokes_read(&s, job->path, (const char *)job->file->data, job->file->size, error);
#else
    lmn_status status = strokes_read_svg(&s, job->path, (const char *)job->file->data, job->file->size, error);
#endif
    strokes_release(&s);
    return status == LMN_OK ? LMN_CANCELLED : status;
#elif defined(FUZZ_stream)
    return assimp_stream_read(job, job->file->data, job->file->size, error);
#else
    image_pixels decoded;
    lmn_status status = image_read(&decoded, job->file->data, job->file->size, error);
    mem_free(decoded.rgba);
    return status == LMN_OK ? LMN_CANCELLED : status;
#endif
}

static void use(const lmn_scene *s)
{
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            render_vertices r;
            if (mesh_make_normals(&r, &s->meshes[i].primitives[k], 0.5, NULL) == LMN_OK)
                render_vertices_release(&r);
            mem_free(mesh_adjacency(&s->meshes[i].primitives[k]));
        }
    mem_free(scene_info_json(s));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    /* Readers may rely on the NUL byte behind a file. */
    unsigned char *copy = mem_alloc(size + 1);
    lmn_scene *scene = scene_new(), *into = scene_new();
    if (copy && scene && into) {
        memcpy(copy, bytes, size);
        copy[size] = '\0';
        file_data file = {.data = copy, .size = size};
        import_job job = {.path = "/nonexistent/fuzz", .file = &file, .scene = scene};
        lmn_error error;
        scene->up = 'y';
        if (read_format(&job, &error) == LMN_OK && scene_finish(scene, job.path, &error) == LMN_OK &&
            scene_merge(into, scene, job.path, &error) == LMN_OK)
            use(into);
    }
    scene_free(scene);
    scene_free(into);
    mem_free(copy);
    return 0;
}
