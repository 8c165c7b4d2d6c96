/* Files that .csg files name: meshes through the readers here, drawings, fields of heights. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/work.h"
#include "fence/image_read.h"
#include "import/access.h"
#include "import/build.h"
#include "import/csg.h"
#include "import/gather.h"

static const char *name_of(const csg_reader *r, int32_t node)
{
    return csg_string(&r->tree, node, "file", 0, "");
}

static bool ends_in(const char *name, const char *const *endings, size_t count)
{
    char ending[16];
    file_ending(name, ending, sizeof ending);
    for (size_t i = 0; i < count; i++)
        if (strcmp(ending, endings[i]) == 0)
            return true;
    return false;
}

int csg_file_dimension(const csg_reader *r, int32_t node)
{
    static const char *const drawings[] = {".dxf", ".svg"};
    static const char *const meshes[] = {".stl", ".off", ".amf", ".3mf", ".obj", ".ply"};
    const char              *name = name_of(r, node);
    if (ends_in(name, drawings, sizeof drawings / sizeof *drawings))
        return 2;
    return ends_in(name, meshes, sizeof meshes / sizeof *meshes) ? 3 : 0;
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static lmn_status gather_scene(csg_reader *r, int32_t node, const lmn_scene *s, polyhedron *out)
{
    bool       open = false;
    lmn_status status = import_gather(out, s, &open, r->error);
    if (status == LMN_OK && open)
        csg_warn(r, node, WARNING_BAD_GEOMETRY, "the mesh in \"%.200s\" is not closed", name_of(r, node));
    return status;
}

/* A file that is missing or broken is a warning, and the model is drawn without it. */
static lmn_status without_file(csg_reader *r, int32_t node, lmn_status status)
{
    if (status == LMN_MEMORY || status == LMN_CANCELLED || status == LMN_OK || r->refused || work_stopped())
        return status;
    csg_warn(r, node, WARNING_MISSING_FILE, "%s() is left out: %s", csg_word(&r->tree, node), r->error->message);
    memset(r->error, 0, sizeof *r->error);
    r->absent = true;
    return LMN_OK;
}

/* The path of the file that a node names, which the model must be allowed to have: what it lacks then cannot be
 * left out. */
static lmn_status find_file(csg_reader *r, int32_t node, char **path)
{
    *path = file_beside(r->job->path, name_of(r, node));
    lmn_error  problem = {0};
    lmn_status status = *path ? access_check(r->job, "file", *path, &problem) : error_memory(r->error);
    if (*path && status != LMN_OK) {
        error_in_file(r->error, status, r->job->path, r->evaluated ? 0 : (int)r->tree.nodes[node].line, "%s",
                      problem.message);
        error_hint(r->error, "%s", problem.hint);
    }
    return status;
}

lmn_status csg_import_mesh(csg_reader *r, int32_t node, polyhedron *out)
{
    char      *path = NULL;
    lmn_scene *scene = NULL;
    lmn_status status = find_file(r, node, &path);
    if (status != LMN_OK) {
        mem_free(path);
        return status;
    }
    status = import_named_file(&scene, r->job, path, r->error);
    if (status == LMN_OK)
        status = gather_scene(r, node, scene, out);
    scene_free(scene);
    mem_free(path);
    return without_file(r, node, status);
}

/* --- drawings ------------------------------------------------------------------------------------------- */

static lmn_status load(csg_reader *r, int32_t node, file_data *out)
{
    *out = (file_data){0};
    char      *path = NULL;
    lmn_status status = find_file(r, node, &path);
    r->refused = status != LMN_OK;
    if (status == LMN_OK)
        status = access_read(r->job, "file", path, out, NULL, r->error);
    mem_free(path);
    return status;
}

lmn_status csg_import_region(csg_reader *r, int32_t node, region *out)
{
    static const char *const dxf[] = {".dxf"};
    const csg_tree          *t = &r->tree;
    file_data                file = {0};
    if (!ends_in(name_of(r, node), dxf, 1))
        return without_file(
            r, node,
            error_set(r->error, LMN_UNSUPPORTED, "\"%.200s\": of drawings only DXF is read", name_of(r, node)));
    /* linear_extrude(file = …) has a scale of its own. */
    bool        own_scale = strcmp(csg_word(t, node), "import") == 0;
    csg_drawing how = {.layer = csg_string(t, node, "layer", NONE, ""),
                       .facets = csg_facets(r, node),
                       .scale = own_scale ? csg_number(t, node, "scale", NONE, 1) : 1};
    csg_numbers(t, node, "origin", NONE, how.origin, 2, false);
    lmn_status status = load(r, node, &file);
    if (status == LMN_OK)
        status = csg_dxf((const char *)file.data, file.size, &how, out, r->error);
    file_data_release(&file);
    return without_file(r, node, status);
}

/* --- heights -------------------------------------------------------------------------------------------- */

typedef struct height_field {
    double *values;
    size_t  count, capacity, columns, rows;
} height_field;

static lmn_status too_long(csg_reader *r)
{
    return error_set(r->error, LMN_FORMAT,
                     "a row of heights has another length than the first, or is no row of numbers");
}

/* Rows of numbers, as many in each; # begins a comment. */
static lmn_status read_heights(csg_reader *r, const file_data *file, height_field *f)
{
    const char *at = (const char *)file->data, *end = at + file->size;
    while (at < end) {
        size_t before = f->count;
        for (; at < end && *at != '\n';) {
            if (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',') {
                at++;
            } else if (*at == '#') {
                const char *newline = memchr(at, '\n', (size_t)(end - at));
                at = newline ? newline : end;
            } else {
                if (!mem_grow((void **)&f->values, &f->capacity, f->count + 1, sizeof *f->values))
                    return error_memory(r->error);
                at = text_parse_double(at, end, &f->values[f->count++]);
                if (!at)
                    return too_long(r);
            }
        }
        at++;
        if (f->count == before)
            continue;
        if (f->rows++ == 0)
            f->columns = f->count;
        else if (f->count - before != f->columns)
            return too_long(r);
    }
    return LMN_OK;
}

/* Brightness from 0 to 100; the picture's last row lies at y = 0. The way an inverted one is counted is OpenSCAD's. */
static lmn_status heights_of_image(csg_reader *r, const file_data *file, bool invert, height_field *f)
{
    image_pixels picture;
    lmn_status   status = image_read(&picture, file->data, file->size, 0, r->error);
    if (status != LMN_OK)
        return status;
    f->columns = picture.width;
    f->rows = picture.height;
    f->count = f->columns * f->rows;
    f->values = mem_alloc(f->count * sizeof *f->values);
    for (size_t i = 0; f->values && i < f->count; i++) {
        const uint8_t *pixel = picture.rgba + 4 * i;
        double         bright = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
        f->values[(f->rows - 1 - i / f->columns) * f->columns + i % f->columns] =
            100.0 / 255 * (invert ? 1 - bright : bright);
    }
    mem_free(picture.rgba);
    return f->values ? LMN_OK : error_memory(r->error);
}

lmn_status csg_surface(csg_reader *r, int32_t node, polyhedron *out)
{
    static const char *const pictures[] = {".png"};
    const csg_tree          *t = &r->tree;
    file_data                file = {0};
    height_field             f = {0};
    lmn_status               status = load(r, node, &file);
    if (status == LMN_OK)
        status = ends_in(name_of(r, node), pictures, 1)
                     ? heights_of_image(r, &file, csg_bool(t, node, "invert", NONE, false), &f)
                     : read_heights(r, &file, &f);
    if (status == LMN_OK && f.rows > 1 && f.columns > 1)
        status = construct_heights(out, f.values, f.columns, f.rows, csg_bool(t, node, "center", 1, false), r->error);
    file_data_release(&file);
    mem_free(f.values);
    return without_file(r, node, status);
}
