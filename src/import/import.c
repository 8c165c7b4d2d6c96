/* The table of formats, and the way from a path to a finished scene. */
#include "base/error.h"
#include "import/import.h"
#include "import/openscad.h"

#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/work.h"
#include "import/access.h"
#include "import/gunzip.h"
#include "import/up_axis.h"

/* Asked in this order; the last takes every other ending. */
static const import_format *const formats[] = {&import_cityjson, &import_geojson, &import_citygml, &import_geodata,
                                               &import_step,     &import_iges,    &import_ifc,     &import_gltf,
                                               &import_ply,      &import_stl,     &import_obj,     &import_bvh,
                                               &import_csg,      &import_scad,    &import_script,  &import_assimp};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

lmn_status import_progress(const import_job *job, double fraction, const char *stage, lmn_error *error)
{
    lmn_status status = work_progress(fraction, stage, error);
    if (status != LMN_OK)
        error_file(error, job->path);
    return status;
}

static bool is_among(const char *endings, const char *ending)
{
    size_t length = strlen(ending);
    for (const char *at = endings; length > 1 && (at = strstr(at, ending)); at += length)
        if ((at[length] == '\0' || at[length] == ' ') && (at == endings || at[-1] == ' '))
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
        if (is_among(formats[i]->endings, ending))
            return formats[i];
    return NULL;
}

static lmn_status choose(const import_format **out, const char *path, const file_data *file, lmn_error *error)
{
    char ending[16];
    gunzip_ending(path, ending, sizeof ending);
    const import_format *named = by_ending(ending), *found = by_content(file);
    *out = found;
    if (file->size == 0) {
        error_in_file(error, LMN_FORMAT, path, 0, "the file is empty");
        error_hint(error, "export it again; the copy or download may have been cut off");
        return LMN_FORMAT;
    }
    if (named && found && !is_among(found->endings, ending)) {
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
    error_hint(error, "limner reads glTF, GLB, STL, PLY, OBJ, BVH, STEP, IGES, OpenSCAD's CSG and what "
                      "docs/reference/formats.md lists");
    return LMN_UNSUPPORTED;
}

/* A file with one unnamed part is called like the file. */
static lmn_status name_single_node(lmn_scene *scene, const char *path, lmn_error *error)
{
    if (scene_plain_node_count(scene) != 1 || scene->nodes[0].name ||
        (scene->nodes[0].mesh == NONE ? scene->nodes[0].solid == NONE
                                      : scene->meshes[scene->nodes[0].mesh].name != NULL))
        return LMN_OK;
    scene->nodes[0].name = scene_name_of_file(path);
    return scene->nodes[0].name ? LMN_OK : error_memory(error);
}

static lmn_status check_triangles(const import_job *job, lmn_error *error)
{
    const lmn_scene *s = job->scene;
    uint64_t         total = 0, lines = 0, most = work_limits().triangles;
    for (size_t i = 0; i < s->part_count; i++) {
        total += (s->parts[i].triangles + s->parts[i].lines) * node_draw_count(&s->nodes[s->parts[i].node]);
        lines += s->parts[i].lines;
    }
    if (!most || total <= most)
        return LMN_OK;
    work_exceeded(error, "triangles", "the model has %llu triangles%s, instances counted; allowed are %llu",
                  (unsigned long long)total, lines ? " and lines" : "", (unsigned long long)most);
    error_file(error, job->path);
    return LMN_LIMIT;
}

static lmn_status fill(const import_job *job, const import_format *format, lmn_error *error)
{
    lmn_status status = import_progress(job, 0, "reading", error);
    return status == LMN_OK ? format->read(job, error) : status;
}

/* What is the same for all formats. The file's bytes are no longer there: a model may be several times as large. */
static lmn_status finish(const import_job *job, const import_format *format, lmn_up_axis up, lmn_error *error)
{
    lmn_status status = name_single_node(job->scene, job->path, error);
    if (status == LMN_OK)
        status = import_progress(job, 0.9, "checking", error);
    if (status == LMN_OK)
        status = scene_finish(job->scene, job->path, error);
    if (status == LMN_OK)
        status = check_triangles(job, error);
    char own = job->scene->up ? job->scene->up : format->up; /* some of one reader's formats are otherwise */
    job->scene->up = up == LMN_UP_Y ? 'y' : up == LMN_UP_Z ? 'z' : own;
    if (status == LMN_OK && up == LMN_UP_AUTO && format->up_guessed && job->model == job->path)
        status = up_axis_guess(&job->scene->up, job->scene, format->up, format->name, error);
    return status;
}

/* What is asked of programs must not be left out in silence where there is none. */
static lmn_status check_options(const import_format *format, const char *path, const lmn_load_desc *desc,
                                lmn_error *error)
{
    if (format == &import_scad && !openscad_is_allowed()) {
        error_in_file(error, LMN_UNSUPPORTED, path, 0,
                      "this is a program, which openscad runs, and which may read any file");
        error_hint(error, "--safe refuses programs; evaluate it where it may run: openscad -o model.csg model.scad");
        return LMN_UNSUPPORTED;
    }
    if (desc->lod && format != &import_cityjson && format != &import_citygml) {
        error_in_file(error, LMN_USAGE, path, 0,
                      "levels of detail are of city models (CityJSON, CityGML), and this is %s", format->name);
        return LMN_USAGE;
    }
    bool footprints = format == &import_geojson || format == &import_geodata;
    if (desc->terrain && !footprints && format != &import_cityjson && format != &import_citygml)
        return error_in_file(error, LMN_USAGE, path, 0, "terrain is for models of cities, and this is %s",
                             format->name);
    if (desc->populate > 0 && !footprints)
        return error_in_file(error, LMN_USAGE, path, 0, "only footprints and roads are populated, and this is %s",
                             format->name);
    if (desc->deflection > 0 && !format->curved)
        return error_in_file(error, LMN_USAGE, path, 0,
                             "a deflection is of models with curved surfaces (STEP, IGES), and this is %s",
                             format->name);
    if (format == &import_scad || (!desc->define_count && !desc->strict))
        return LMN_OK;
    return error_in_file(error, LMN_USAGE, path, 0, "%s for OpenSCAD programs (.scad), and this is %s",
                         desc->define_count ? "definitions are" : "being strict is", format->name);
}

/* --- formats of the caller's ---------------------------------------------------------------------------- */

/* The caller's importer for this file; NULL: there is none. */
static const lmn_importer *find_importer(const lmn_load_desc *desc, const char *path, const file_data *file)
{
    char ending[16];
    gunzip_ending(path, ending, sizeof ending);
    for (size_t i = 0; i < desc->importer_count && file->size; i++) {
        const lmn_importer *of = desc->importers[i];
        if (of->probe ? of->probe(file->data, file->size, of->user) : is_among(of->endings, ending))
            return of;
    }
    return NULL;
}

/* What it made it has made by calls, which leave the scene whole. */
static lmn_status read_outside(const import_job *job, const lmn_importer *by, lmn_error *error)
{
    lmn_scene *scene = job->scene;
    lmn_error  own = {0};
    if (job->desc->define_count || job->desc->strict)
        return error_in_file(error, LMN_USAGE, job->path, 0,
                             "definitions and being strict are for OpenSCAD programs "
                             "(.scad), and this is %s",
                             by->name);
    lmn_status status = import_progress(job, 0, "reading", error);
    if (status != LMN_OK)
        return status;
    status = by->read(scene, job->path, job->file->data, job->file->size, by->user, &own);
    if (status == LMN_OK && scene->changes_open)
        status = error_set(&own, LMN_USAGE, "the importer of %s has left changes of the scene open", by->name);
    if (status != LMN_OK) {
        error_in_file(error, status, job->path, own.line, "%s",
                      own.message[0] ? own.message : "the importer has failed and does not say why");
        if (own.hint[0])
            error_hint(error, "%s", own.hint);
        return status;
    }
    if (job->desc->up_axis != LMN_UP_AUTO)
        scene->up = job->desc->up_axis == LMN_UP_Y ? 'y' : 'z';
    status = name_single_node(scene, job->path, error);
    return status == LMN_OK ? check_triangles(job, error) : status;
}

/* --- from a path to a scene ----------------------------------------------------------------------------- */

static lmn_status read_ours(import_job *job, file_data *file, lmn_error *error)
{
    const import_format *format = NULL;
    lmn_status           status = choose(&format, job->path, job->file, error);
    if (status == LMN_OK)
        status = check_options(format, job->path, job->desc, error);
    if (status == LMN_OK)
        status = fill(job, format, error);
    file_data_release(file);
    job->file = NULL;
    return status == LMN_OK ? finish(job, format, job->desc->up_axis, error) : status;
}

static lmn_status load(lmn_scene **out, const import_job *by, const char *path, const lmn_load_desc *desc,
                       lmn_error *error)
{
    *out = NULL;
    double     start = clock_ms();
    file_data  file;
    lmn_status status = access_read(by, by ? "file" : "model", path, &file, NULL, error);
    if (status == LMN_OK)
        status = gunzip(&file, path, error);
    if (status != LMN_OK)
        return status;
    const lmn_importer *outside = find_importer(desc, path, &file);
    lmn_scene          *scene = scene_new();
    import_job job = {.path = path, .model = by ? by->model : path, .file = &file, .scene = scene, .desc = desc};
    if (!scene)
        status = error_memory(error);
    else
        status = outside ? read_outside(&job, outside, error) : read_ours(&job, &file, error);
    file_data_release(&file);
    if (status != LMN_OK) {
        /* Readers of parts of a file need not know its name. */
        if (error && !error->file[0])
            error_file(error, path);
        scene_free(scene);
        return status;
    }
    scene->load_ms = clock_ms() - start;
    *out = scene;
    return LMN_OK;
}

lmn_status import_file(lmn_scene **out, const char *path, const lmn_load_desc *desc, lmn_error *error)
{
    return load(out, NULL, path, desc, error);
}

lmn_status import_named_file(lmn_scene **out, const import_job *job, const char *path, lmn_error *error)
{
    const lmn_load_desc standard = LMN_LOAD_DESC_INIT;
    return load(out, job, path, &standard, error);
}
