/* The table of formats, and the way from a path to a finished scene. */
#include "base/error.h"
#include "import/import.h"

#include <string.h>

#include "base/clock.h"
#include "base/memory.h"

/* Asked in this order; the last takes every other ending. */
static const import_format *const formats[] = {&import_gltf, &import_ply, &import_stl, &import_obj, &import_csg, &import_scad,
                                              &import_assimp};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

lmn_status import_progress(const import_job *job, double fraction, const char *stage, lmn_error *error)
{
    if (!job->progress || job->progress(fraction, stage, job->progress_user))
        return LMN_OK;
    return error_in_file(error, LMN_CANCELLED, job->path, 0, "loading was cancelled");
}

static bool has_ending(const import_format *f, const char *ending)
{
    size_t length = strlen(ending);
    for (const char *at = f->endings; length > 1 && (at = strstr(at, ending)); at += length)
        if ((at[length] == '\0' || at[length] == ' ') && (at == f->endings || at[-1] == ' '))
            return true;
    return false;
}

static const import_format *by_content(const file_data *file)
{
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (formats[i]->recognises && formats[i]->recognises(file))
            return formats[i];
    return NULL;
}

static const import_format *by_ending(const char *ending)
{
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (has_ending(formats[i], ending))
            return formats[i];
    return NULL;
}

static lmn_status choose(const import_format **out, const char *path, const file_data *file, lmn_error *error)
{
    char ending[16];
    file_ending(path, ending, sizeof ending);
    const import_format *named = by_ending(ending), *found = by_content(file);
    *out = found;
    if (file->size == 0) {
        error_in_file(error, LMN_FORMAT, path, 0, "the file is empty");
        error_hint(error, "export it again; the copy or download may have been cut off");
        return LMN_FORMAT;
    }
    if (named && found && named != found) {
        error_in_file(error, LMN_FORMAT, path, 0, "the content is %s, but the ending %s says %s", found->name, ending,
                      named->name);
        error_hint(error, "rename the file so that its ending fits its content (%s)", found->endings);
        return LMN_FORMAT;
    }
    if (!found)
        *out = named;
    if (*out)
        return LMN_OK;
    error_in_file(error, LMN_UNSUPPORTED, path, 0, "the format of this file is not known (ending \"%s\")", ending);
    error_hint(error, "limner reads glTF, GLB, STL, PLY, OBJ, OpenSCAD's CSG and what docs/reference/formats.md lists");
    return LMN_UNSUPPORTED;
}

/* A file with one unnamed part is called like the file. */
static lmn_status name_single_node(lmn_scene *scene, const char *path, lmn_error *error)
{
    if (scene_plain_node_count(scene) != 1 || scene->nodes[0].name ||
        (scene->nodes[0].mesh == NONE ? scene->nodes[0].solid == NONE : scene->meshes[scene->nodes[0].mesh].name != NULL))
        return LMN_OK;
    scene->nodes[0].name = scene_name_of_file(path);
    return scene->nodes[0].name ? LMN_OK : error_memory(error);
}

static lmn_status read_into(const import_job *job, const import_format *format, lmn_up_axis up, lmn_error *error)
{
    lmn_status status = import_progress(job, 0, "reading", error);
    if (status == LMN_OK)
        status = format->read(job, error);
    if (status == LMN_OK)
        status = name_single_node(job->scene, job->path, error);
    if (status == LMN_OK)
        status = import_progress(job, 0.9, "checking", error);
    if (status == LMN_OK)
        status = scene_finish(job->scene, job->path, error);
    job->scene->up = up == LMN_UP_Y ? 'y' : up == LMN_UP_Z ? 'z' : format->up;
    return status;
}

lmn_status import_file(lmn_scene **out, const char *path, const lmn_load_desc *desc, lmn_error *error)
{
    *out = NULL;
    double start = clock_ms();
    file_data file;
    lmn_status status = file_load(&file, path, error);
    if (status != LMN_OK)
        return status;
    const import_format *format = NULL;
    lmn_scene *scene = scene_new();
    status = scene ? choose(&format, path, &file, error) : error_memory(error);
    if (status == LMN_OK) {
        import_job job = {.path = path, .file = &file, .scene = scene, .progress = desc->progress,
                          .progress_user = desc->progress_user};
        status = read_into(&job, format, desc->up_axis, error);
    }
    file_data_release(&file);
    if (status != LMN_OK) {
        /* Readers of parts of a file need not know its name. */
        if (error && !error->file[0] && status != LMN_MEMORY)
            strncpy(error->file, path, sizeof error->file - 1);
        scene_free(scene);
        return status;
    }
    scene->load_ms = clock_ms() - start;
    *out = scene;
    return LMN_OK;
}
