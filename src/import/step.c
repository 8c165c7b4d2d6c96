/* STEP and IGES: a child with OpenCASCADE in it gets the file's bytes and nothing else. It makes triangles of the
 * faces, with their own normals, and lines of the edges; what it answers is checked as if a stranger had sent it. */
#include "import/step.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/colour.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"
#include "fence/fence.h"
#include "import/build.h"
#include "import/exchange_file.h"
#include "import/step_library.h"

/* --- behind the fence ----------------------------------------------------------------------------------- */

typedef struct request_head {
    double    deflection;
    uint64_t  most_triangles;
    step_kind kind;
} request_head;

static bool put(void *to, const void *bytes, size_t size)
{
    fence_bytes *answer = to;
    fence_put(answer, bytes, size);
    return !answer->failed;
}

static lmn_status no_library(lmn_error *error)
{
    error_set(error, LMN_UNSUPPORTED, "STEP and IGES files are read with OpenCASCADE, which is not here");
    error_hint(error, "`limner doctor` says what is missing; or convert the model to glTF");
    return LMN_UNSUPPORTED;
}

static lmn_status answer_step(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    const step_module  *module = step_library_get();
    fence_reader        r = fence_read(request, size);
    const request_head *from = fence_take(&r, sizeof *from);
    request_head        head;
    char                message[256] = "";
    if (!module)
        return no_library(error);
    if (!from)
        return error_set(error, LMN_INTERNAL, "the request is cut off");
    memcpy(&head, from, sizeof head);
    const step_request what = {r.at, (size_t)(r.end - r.at), head.kind, head.deflection, head.most_triangles};
    switch (module->read(&what, put, answer, message, sizeof message)) {
    case STEP_DONE: return LMN_OK;
    case STEP_TOO_MUCH_MEMORY:
        error_set(error, LMN_LIMIT, "reading the file takes more memory than it may");
        error_hint(error, "a larger --deflection makes fewer triangles");
        return LMN_LIMIT;
    case STEP_TOO_MANY:
        error_set(error, LMN_LIMIT, "the model has more than %llu triangles", (unsigned long long)head.most_triangles);
        error_hint(error, "a larger --deflection makes fewer of them");
        return LMN_LIMIT;
    case STEP_NO_SIZE:
        error_set(error, LMN_FORMAT, "the unit of the file is %.200s", message);
        error_hint(error, "see whether that is the unit it was made in, and export it again in millimetres");
        return LMN_FORMAT;
    case STEP_EMPTY: return error_set(error, LMN_FORMAT, "nothing in the file can be drawn");
    default:
        error_set(error, LMN_FORMAT, "the data is damaged%s%.200s", message[0] ? ": " : "", message);
        error_hint(error, "export it again; the copy or download may have been cut off");
        return LMN_FORMAT;
    }
}

static lmn_status answer_version(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    const step_module *module = step_library_get();
    (void)request, (void)size;
    if (!module)
        return no_library(error);
    fence_put_text(answer, module->version);
    return LMN_OK;
}

char *step_version(void)
{
    fence_bytes request = {0}, answer = {0};
    char       *text = NULL;
    if (fence_call_prepared(&answer, answer_version, step_prepare, "the reader of CAD files", &request, NULL) ==
        LMN_OK) {
        fence_reader r = fence_read(answer.bytes, answer.size);
        text = fence_take_text(&r);
    }
    mem_free(answer.bytes);
    return text;
}

/* --- the answer ----------------------------------------------------------------------------------------- */

enum { FACTS = 4 }; /* of the header */

typedef struct step_reader {
    const import_job *job;
    fence_reader      r;
    lmn_error        *error;
    step_kind         kind;
    step_losses       losses;
    lmn_status        status;
    int32_t           plain; /* the material of what has no colour; NONE: not needed yet */
    uint64_t          vertices, triangles, lines;
} step_reader;

static void broken(step_reader *s)
{
    if (s->status == LMN_OK)
        s->status = error_set(s->error, LMN_FORMAT, "the reader of CAD files gave broken data");
}

static void out_of_memory(step_reader *s)
{
    if (s->status == LMN_OK)
        s->status = error_memory(s->error);
}

static uint32_t take_count(step_reader *s, size_t smallest)
{
    uint32_t count = fence_take_u32(&s->r);
    if (s->r.ended || count > (size_t)(s->r.end - s->r.at) / smallest)
        broken(s);
    return s->status == LMN_OK ? count : 0;
}

static char *take_name(step_reader *s)
{
    uint32_t    size = take_count(s, 1);
    const char *from = size ? fence_take(&s->r, size) : NULL;
    char       *name = from ? scene_clean_name(from, size) : NULL;
    if (from && !name)
        out_of_memory(s);
    return name;
}

/* At least one element: what is empty is not sent. */
static void *take_array(step_reader *s, size_t count, size_t size)
{
    size_t      bytes = 0;
    const void *from = NULL;
    if (s->status == LMN_OK && count && size_mul(count, size, &bytes))
        from = fence_take(&s->r, bytes);
    void *copy = from ? mem_copy(from, bytes) : NULL;
    if (!from)
        broken(s);
    else if (!copy)
        out_of_memory(s);
    return copy;
}

static void check_indices(step_reader *s, const uint32_t *indices, size_t count, uint32_t vertices)
{
    for (size_t i = 0; s->status == LMN_OK && i < count; i++)
        if (indices[i] >= vertices)
            broken(s);
}

/* --- colours -------------------------------------------------------------------------------------------- */

static float unit(float value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

/* Parts of one colour share a material. */
static int32_t find_material(step_reader *s, uint32_t there, const float rgba[4])
{
    lmn_scene *scene = s->job->scene;
    if (!there) {
        if (s->plain == NONE && (s->plain = build_plain_material(scene, false)) == NONE)
            out_of_memory(s);
        return s->plain;
    }
    const vec4 colour = {colour_to_linear(unit(rgba[0])), colour_to_linear(unit(rgba[1])),
                         colour_to_linear(unit(rgba[2])), unit(rgba[3])};
    for (size_t i = 0; i < scene->material_count; i++)
        if ((int32_t)i != s->plain && memcmp(&scene->materials[i].base_colour, &colour, sizeof colour) == 0)
            return (int32_t)i;
    material *m = scene_append_material(scene);
    if (!m) {
        out_of_memory(s);
        return NONE;
    }
    char name[16];
    snprintf(name, sizeof name, "#%02x%02x%02x", (unsigned)lroundf(255 * unit(rgba[0])),
             (unsigned)lroundf(255 * unit(rgba[1])), (unsigned)lroundf(255 * unit(rgba[2])));
    m->name = mem_copy_text(name);
    if (!m->name)
        out_of_memory(s);
    m->base_colour = colour;
    m->alpha = colour.w < 1 ? ALPHA_BLEND : ALPHA_OPAQUE;
    return (int32_t)scene->material_count - 1;
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static void check_size(step_reader *s)
{
    if (s->status == LMN_OK && (s->vertices > 3 * LIMIT_VERTICES || s->triangles > LIMIT_TRIANGLES))
        s->status = error_set(s->error, LMN_LIMIT, "more than %zu triangles", LIMIT_TRIANGLES);
    if (s->status == LMN_OK && s->lines > LIMIT_LINES)
        s->status = error_set(s->error, LMN_LIMIT, "more than %zu lines", LIMIT_LINES);
}

static void read_group(step_reader *s, primitive *p)
{
    uint32_t    there = fence_take_u32(&s->r);
    const void *from = fence_take(&s->r, 4 * sizeof(float));
    float       rgba[4] = {0, 0, 0, 0};
    p->vertex_count = fence_take_u32(&s->r);
    p->index_count = fence_take_u32(&s->r);
    if (!from || p->index_count % 3)
        broken(s);
    s->vertices += p->vertex_count;
    s->triangles += p->index_count / 3;
    check_size(s);
    if (s->status != LMN_OK)
        return;
    memcpy(rgba, from, sizeof rgba);
    p->positions = take_array(s, p->vertex_count, sizeof *p->positions);
    p->normals = take_array(s, p->vertex_count, sizeof *p->normals);
    p->indices = take_array(s, p->index_count, sizeof *p->indices);
    p->edges.values = take_array(s, p->index_count, 1);
    check_indices(s, p->indices, p->index_count, p->vertex_count);
    for (size_t i = 0; s->status == LMN_OK && i < p->index_count; i++)
        if (p->edges.values[i] != STEP_INSIDE && p->edges.values[i] != STEP_SHARP)
            broken(s);
    p->material = find_material(s, there, rgba);
}

static void read_lines(step_reader *s, primitive *p)
{
    p->vertex_count = fence_take_u32(&s->r);
    p->line_count = fence_take_u32(&s->r);
    p->edge_lines = fence_take_u32(&s->r) == 0;
    p->material = NONE;
    if (p->line_count == 0)
        return;
    s->vertices += p->vertex_count;
    s->lines += p->line_count;
    check_size(s);
    p->positions = take_array(s, p->vertex_count, sizeof *p->positions);
    p->lines = take_array(s, (size_t)p->line_count * 2, sizeof *p->lines);
    check_indices(s, p->lines, (size_t)p->line_count * 2, p->vertex_count);
}

/* The arrays are the mesh's from the beginning, so that its scene frees them however this ends. */
static void read_mesh(step_reader *s)
{
    mesh *m = scene_append_mesh(s->job->scene);
    char *name = take_name(s);
    if (!m) {
        mem_free(name);
        out_of_memory(s);
        return;
    }
    m->name = name;
    uint32_t groups = take_count(s, 28);
    m->primitives = mem_calloc((size_t)groups + 1, sizeof *m->primitives);
    if (!m->primitives)
        out_of_memory(s);
    for (uint32_t i = 0; i < groups && s->status == LMN_OK; i++) {
        m->primitive_count++;
        read_group(s, &m->primitives[i]);
    }
    if (s->status != LMN_OK)
        return;
    primitive *last = &m->primitives[m->primitive_count];
    read_lines(s, last);
    if (last->line_count || s->status != LMN_OK)
        m->primitive_count++;
    else
        primitive_release(last);
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

static void read_node(step_reader *s, uint32_t index)
{
    uint32_t    parent = fence_take_u32(&s->r);
    char       *name = take_name(s);
    const void *matrix = fence_take(&s->r, 16 * sizeof(double));
    uint32_t    drawn = fence_take_u32(&s->r);
    if (s->r.ended || (parent != STEP_NONE && parent >= index) ||
        (drawn != STEP_NONE && drawn >= s->job->scene->mesh_count))
        broken(s);
    node *n = s->status == LMN_OK ? scene_append_node(s->job->scene) : NULL;
    if (!n) {
        mem_free(name);
        out_of_memory(s);
        return;
    }
    n->name = name;
    mat4 place;
    memcpy(place.m, matrix, sizeof place.m);
    if (!node_set_matrix(n, &place))
        out_of_memory(s);
    n->mesh = drawn == STEP_NONE ? NONE : (int32_t)drawn;
    if (parent != STEP_NONE)
        scene_link_child(s->job->scene, (int32_t)parent, (int32_t)index);
}

/* "INCH", "millimetre": of the file; coordinates are millimetres in any case. */
static void tell_unit(step_reader *s, const char *unit_name)
{
    lmn_scene *scene = s->job->scene;
    for (size_t i = 0; unit_name && i < scene->node_count && s->status == LMN_OK; i++)
        if (scene->nodes[i].mesh != NONE && !build_attribute(&scene->nodes[i], "file-unit", unit_name))
            out_of_memory(s);
}

/* What writers put when they have not been told, which is nothing. */
static bool is_made_up(const char *fact)
{
    static const char *const words[] = {
        "Author", "Unknown", "Organization", "Organisation", "Company", "UNSPECIFIED", "Not specified", "None",
        "*",      "-"};
    bool found = strncasecmp(fact, "Open CASCADE", 12) == 0 || !*fact;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        found = found || strcasecmp(fact, words[i]) == 0;
    return found;
}

/* What the header says, of all that the file brings: as attributes of its uppermost nodes. */
static void tell_header(step_reader *s, char *const *facts)
{
    static const char *const keys[FACTS] = {"file-title", "file-author", "file-organisation", "file-date"};
    lmn_scene               *scene = s->job->scene;
    for (size_t i = 0; i < scene->node_count; i++)
        for (int k = 0; k < FACTS && s->status == LMN_OK; k++)
            if (scene->nodes[i].parent == NONE && facts[k] && !is_made_up(facts[k]) &&
                !build_attribute(&scene->nodes[i], keys[k], facts[k]))
                out_of_memory(s);
}

static void tell_losses(const step_reader *s)
{
    warnings   *list = &s->job->scene->warnings;
    step_losses is = s->losses;
    char        sign = s->kind == STEP_KIND_IGES ? 'D' : '#';
    if (is.lost)
        warnings_add(list, WARNING_BAD_GEOMETRY, "%u of %u faces could not be made and are missing, the first: %c%u",
                     (unsigned)is.lost, (unsigned)is.faces, sign, (unsigned)is.first_lost);
    if (is.damaged)
        warnings_add(list, WARNING_BAD_GEOMETRY,
                     "%u entities are damaged or refer to what the file does not have, the first: %c%u; "
                     "parts or edges of them may be missing",
                     (unsigned)is.damaged, sign, (unsigned)is.first_damaged);
}

static void read_nodes(step_reader *s)
{
    uint32_t count = take_count(s, 4 + 4 + 16 * sizeof(double) + 4);
    if (s->status == LMN_OK && count > LIMIT_NODES)
        s->status = error_set(s->error, LMN_LIMIT, "%u nodes, allowed are %zu", (unsigned)count, LIMIT_NODES);
    for (uint32_t i = 0; i < count && s->status == LMN_OK; i++)
        read_node(s, i);
}

lmn_status step_answer_read(const import_job *job, step_kind kind, const unsigned char *bytes, size_t size,
                            lmn_error *error)
{
    step_reader s = {.job = job, .r = fence_read(bytes, size), .kind = kind, .error = error, .plain = NONE};
    char       *unit_name = take_name(&s), *facts[FACTS];
    for (int i = 0; i < FACTS; i++)
        facts[i] = take_name(&s);
    const void *from = fence_take(&s.r, sizeof(float)), *losses = fence_take(&s.r, sizeof s.losses);
    float       coarser = 1;
    uint32_t    meshes = take_count(&s, 16);
    if (from)
        memcpy(&coarser, from, sizeof coarser);
    if (losses)
        memcpy(&s.losses, losses, sizeof s.losses);
    for (uint32_t i = 0; i < meshes && s.status == LMN_OK; i++)
        read_mesh(&s);
    if (s.status == LMN_OK)
        read_nodes(&s);
    tell_unit(&s, unit_name);
    tell_header(&s, facts);
    mem_free(unit_name);
    for (int i = 0; i < FACTS; i++)
        mem_free(facts[i]);
    if (s.status == LMN_OK && (s.r.ended || s.r.at != s.r.end))
        broken(&s);
    if (s.status == LMN_OK && coarser > 1)
        warnings_add(&job->scene->warnings, WARNING_BAD_VALUE,
                     "the deflection is less than a millionth of a part's size: chords are up to %.3g times as coarse",
                     (double)coarser);
    if (s.status == LMN_OK)
        tell_losses(&s);
    return s.status;
}

/* --- the formats ---------------------------------------------------------------------------------------- */

static bool is_step(const file_data *file)
{
    return exchange_file_kind(file) == EXCHANGE_STEP;
}

/* Lines of 80 letters, of which the 73rd says what they belong to and the last seven count: first the start section. */
static bool is_iges(const file_data *file)
{
    enum { SECTION = 72, LINE = 80 };
    const unsigned char *at = file->data;
    if (file->size < 2 * LINE || at[SECTION] != 'S')
        return false;
    for (int i = 0; i < LINE; i++)
        if (i < SECTION ? at[i] == '\n' || at[i] == '\r' : i > SECTION && at[i] != ' ' && !isdigit(at[i]))
            return false;
    return at[LINE - 1] == '1' && (at[LINE] == '\n' || at[LINE] == '\r');
}

static lmn_status read_kind(const import_job *job, step_kind kind, lmn_error *error)
{
    fence_bytes        request = {0}, answer = {0};
    const uint64_t     most = work_limits().triangles;
    const request_head head = {job->desc ? job->desc->deflection : 0, most ? most : LIMIT_TRIANGLES, kind};
    const char        *what = kind == STEP_KIND_IGES ? "the reader of IGES" : "the reader of STEP";
    fence_put(&request, &head, sizeof head);
    fence_put(&request, job->file->data, job->file->size);
    lmn_status status = fence_call_prepared(&answer, answer_step, step_prepare, what, &request, error);
    mem_free(request.bytes);
    if (status == LMN_OK)
        status = import_progress(job, 0.7, "reading", error);
    if (status == LMN_OK)
        status = step_answer_read(job, kind, answer.bytes, answer.size, error);
    mem_free(answer.bytes);
    if (status != LMN_OK)
        error_file(error, job->path);
    return status;
}

static lmn_status read_step(const import_job *job, lmn_error *error)
{
    return read_kind(job, STEP_KIND_STEP, error);
}

static lmn_status read_iges(const import_job *job, lmn_error *error)
{
    return read_kind(job, STEP_KIND_IGES, error);
}

const import_format import_step = {
    .name = "STEP",
    .endings = ".step .stp .p21",
    .up = 'z',
    .recognises = is_step,
    .read = read_step,
    .curved = true,
};

const import_format import_iges = {
    .name = "IGES",
    .endings = ".iges .igs",
    .up = 'z',
    .recognises = is_iges,
    .read = read_iges,
    .curved = true,
};
