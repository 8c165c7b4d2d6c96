/* PLY: text, little and big endian, any order of properties; polygons and triangle strips. */
#include "import/ply.h"

#include <string.h>

#include "base/colour.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/build.h"

/* Where a vertex property goes. */
typedef enum ply_slot {
    SLOT_X,
    SLOT_Y,
    SLOT_Z,
    SLOT_NX,
    SLOT_NY,
    SLOT_NZ,
    SLOT_RED,
    SLOT_GREEN,
    SLOT_BLUE,
    SLOT_ALPHA,
    SLOT_U,
    SLOT_V,
    SLOT_COUNT,
    SLOT_NONE = SLOT_COUNT
} ply_slot;

typedef struct model {
    primitive p;
    size_t    index_capacity;
    uint32_t *corners; /* of the current face */
    size_t    corner_capacity;
    bool      have_vertices;
    float     to_linear[256];
} model;

static bool recognises(const file_data *file)
{
    return file->size >= 4 && memcmp(file->data, "ply", 3) == 0 &&
           (file->data[3] == '\n' || file->data[3] == '\r' || file->data[3] == ' ');
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

static uint64_t load_bytes(const char *at, size_t size, bool big)
{
    uint64_t value = 0;
    for (size_t i = 0; i < size; i++)
        value |= (uint64_t)(unsigned char)at[big ? size - 1 - i : i] << (8 * i);
    return value;
}

static double decode(ply_type type, uint64_t bits)
{
    uint32_t low = (uint32_t)bits;
    float    single;
    double   whole;
    switch (type) {
    case PLY_INT8: return (int8_t)bits;
    case PLY_UINT8: return (uint8_t)bits;
    case PLY_INT16: return (int16_t)bits;
    case PLY_UINT16: return (uint16_t)bits;
    case PLY_INT32: return (int32_t)bits;
    case PLY_UINT32: return low;
    case PLY_FLOAT32: memcpy(&single, &low, sizeof single); return single;
    case PLY_FLOAT64: memcpy(&whole, &bits, sizeof whole); return whole;
    case PLY_NONE: break;
    }
    return 0;
}

bool ply_read_value(ply_reader *r, ply_type type, double *out)
{
    if (r->encoding != PLY_ASCII) {
        size_t size = ply_type_size(type);
        if ((size_t)(r->end - r->at) < size)
            return false;
        *out = decode(type, load_bytes(r->at, size, r->encoding == PLY_BIG));
        r->at += size;
        return true;
    }
    while (r->at < r->end && is_blank(*r->at))
        r->at++;
    const char *next = text_parse_double(r->at, r->end, out);
    if (!next || (next < r->end && !is_blank(*next)))
        return false;
    r->at = next;
    return true;
}

lmn_status ply_bad_row(const ply_reader *r, const ply_element *e, uint64_t row, const char *what)
{
    int        line = r->encoding == PLY_ASCII ? build_line(r->begin, r->at) : 0;
    lmn_status status;
    if (r->encoding == PLY_ASCII)
        status = error_in_file(r->error, LMN_FORMAT, r->job->path, line, "%s %llu: %s", e->name,
                               (unsigned long long)row, what);
    else
        status = error_in_file(r->error, LMN_FORMAT, r->job->path, 0, "%s %llu (byte %zu): %s", e->name,
                               (unsigned long long)row, (size_t)(r->at - r->begin), what);
    return status;
}

static lmn_status bad_value(const ply_reader *r, const ply_element *e, uint64_t row)
{
    bool       ended = r->encoding != PLY_ASCII || r->at >= r->end;
    lmn_status status = ply_bad_row(r, e, row, ended ? "the file is cut off here" : "expected a number");
    if (ended)
        error_hint(r->error, "the header promises %llu of them; copy or export the file again",
                   (unsigned long long)e->count);
    return status;
}

/* Text rows are lines; what stands behind the last property is not used. */
static void end_row(ply_reader *r)
{
    if (r->encoding != PLY_ASCII)
        return;
    bool extra = false;
    for (; r->at < r->end && *r->at != '\n' && *r->at != '\r'; r->at++)
        extra |= !is_blank(*r->at);
    if (extra)
        warnings_add(&r->job->scene->warnings, WARNING_IGNORED, "values behind the last property of a line");
}

/* The fewest bytes that a row takes. */
static size_t smallest_row(const ply_reader *r, const ply_element *e)
{
    size_t size = 0;
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        size += r->encoding == PLY_ASCII ? 2 : ply_type_size(p->count_type ? p->count_type : p->type);
    }
    return size;
}

/* A count that the file cannot hold is refused before anything is allocated for it. */
static lmn_status check_count(const ply_reader *r, const ply_element *e, uint64_t limit)
{
    size_t row = smallest_row(r, e), left = (size_t)(r->end - r->at) + (r->encoding == PLY_ASCII);
    if (row > 0 && e->count > left / row) {
        error_in_file(r->error, LMN_FORMAT, r->job->path, 0,
                      "the header promises %llu of \"%s\", but only %zu bytes follow", (unsigned long long)e->count,
                      e->name, left);
        error_hint(r->error, "the file is cut off or damaged; copy or export it again");
        return LMN_FORMAT;
    }
    if (e->count > limit)
        return error_in_file(r->error, LMN_LIMIT, r->job->path, 0, "%llu of \"%s\" are more than the limit of %llu",
                             (unsigned long long)e->count, e->name, (unsigned long long)limit);
    return LMN_OK;
}

/* --- vertices ------------------------------------------------------------------------------------------- */

static ply_slot slot_of(const char *name)
{
    static const struct {
        const char *name;
        ply_slot    slot;
    } names[] = {{"x", SLOT_X},
                 {"y", SLOT_Y},
                 {"z", SLOT_Z},
                 {"nx", SLOT_NX},
                 {"ny", SLOT_NY},
                 {"nz", SLOT_NZ},
                 {"red", SLOT_RED},
                 {"green", SLOT_GREEN},
                 {"blue", SLOT_BLUE},
                 {"alpha", SLOT_ALPHA},
                 {"r", SLOT_RED},
                 {"g", SLOT_GREEN},
                 {"b", SLOT_BLUE},
                 {"a", SLOT_ALPHA},
                 {"s", SLOT_U},
                 {"t", SLOT_V},
                 {"u", SLOT_U},
                 {"v", SLOT_V},
                 {"texture_u", SLOT_U},
                 {"texture_v", SLOT_V},
                 {"texture_s", SLOT_U},
                 {"texture_t", SLOT_V},
                 {"diffuse_red", SLOT_RED},
                 {"diffuse_green", SLOT_GREEN},
                 {"diffuse_blue", SLOT_BLUE},
                 {"diffuse_alpha", SLOT_ALPHA}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i].name) == 0)
            return names[i].slot;
    return SLOT_NONE;
}

static double unit_scale(ply_type type)
{
    return type == PLY_UINT8 ? 1 / 255.0 : type == PLY_UINT16 ? 1 / 65535.0 : 1;
}

static bool allocate_vertices(primitive *p, size_t count, const bool *has)
{
    p->vertex_count = (uint32_t)count;
    p->positions = mem_calloc(count, sizeof *p->positions);
    bool good = p->positions != NULL;
    if (good && has[SLOT_NX] && has[SLOT_NY] && has[SLOT_NZ])
        good = (p->normals = mem_calloc(count, sizeof *p->normals)) != NULL;
    if (good && has[SLOT_RED] && has[SLOT_GREEN] && has[SLOT_BLUE])
        good = (p->colours = mem_calloc(count, sizeof *p->colours)) != NULL;
    if (good && has[SLOT_U] && has[SLOT_V])
        good = (p->uvs[0] = mem_calloc(count, sizeof *p->uvs[0])) != NULL;
    return good;
}

/* PLY colours are encoded for display, as everywhere in files without a statement. */
static float linear_colour(const model *m, double value)
{
    if (!(value > 0))
        return 0;
    if (value >= 1)
        return 1;
    double index = value * 255;
    if (index == (double)(int)index)
        return m->to_linear[(int)index];
    return colour_to_linear((float)value);
}

static void store_vertex(model *m, size_t i, const double *v)
{
    primitive *p = &m->p;
    p->positions[i] = (vec3){(float)v[SLOT_X], (float)v[SLOT_Y], (float)v[SLOT_Z]};
    if (p->normals)
        p->normals[i] = (vec3){(float)v[SLOT_NX], (float)v[SLOT_NY], (float)v[SLOT_NZ]};
    if (p->colours)
        p->colours[i] = (vec4){linear_colour(m, v[SLOT_RED]), linear_colour(m, v[SLOT_GREEN]),
                               linear_colour(m, v[SLOT_BLUE]), (float)v[SLOT_ALPHA]};
    /* PLY counts v from the bottom of the picture. */
    if (p->uvs[0])
        p->uvs[0][i] = (vec2){(float)v[SLOT_U], 1.0f - (float)v[SLOT_V]};
}

static lmn_status skip_list(ply_reader *r, const ply_element *e, const ply_property *property, uint64_t row)
{
    double count, value;
    if (!ply_read_value(r, property->count_type, &count))
        return bad_value(r, e, row);
    if (r->encoding != PLY_ASCII) {
        double bytes = count * (double)ply_type_size(property->type);
        if (count < 0 || bytes > (double)(r->end - r->at))
            return bad_value(r, e, row);
        r->at += (size_t)bytes;
        return LMN_OK;
    }
    for (double i = 0; i < count; i++)
        if (!ply_read_value(r, property->type, &value))
            return bad_value(r, e, row);
    return LMN_OK;
}

typedef struct layout {
    ply_slot slots[1024];
    double   scales[1024];
    bool     has[SLOT_COUNT];
} layout;

static void make_layout(const ply_reader *r, const ply_element *e, layout *l)
{
    memset(l->has, 0, sizeof l->has);
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        ply_slot            slot = p->count_type ? SLOT_NONE : slot_of(p->name);
        if (slot != SLOT_NONE && l->has[slot])
            slot = SLOT_NONE;
        l->slots[i] = slot;
        l->scales[i] = slot >= SLOT_RED && slot <= SLOT_ALPHA ? unit_scale(p->type) : 1;
        if (slot != SLOT_NONE)
            l->has[slot] = true;
        else
            warnings_add(&r->job->scene->warnings, WARNING_IGNORED, "PLY vertex property \"%s\"", p->name);
    }
}

static lmn_status read_vertex_rows(ply_reader *r, const ply_element *e, model *m, const layout *l)
{
    double values[SLOT_COUNT + 1] = {0};
    values[SLOT_ALPHA] = 1;
    for (uint64_t row = 0; row < e->count; row++) {
        for (size_t i = 0; i < e->property_count; i++) {
            const ply_property *p = &e->properties[i];
            double              value;
            if (p->count_type) {
                lmn_status status = skip_list(r, e, p, row);
                if (status != LMN_OK)
                    return status;
                continue;
            }
            if (!ply_read_value(r, p->type, &value))
                return bad_value(r, e, row);
            values[l->slots[i]] = value * l->scales[i];
        }
        end_row(r);
        store_vertex(m, row, values);
    }
    return LMN_OK;
}

static lmn_status read_vertices(ply_reader *r, const ply_element *e, model *m)
{
    if (m->have_vertices)
        return error_in_file(r->error, LMN_FORMAT, r->job->path, 0, "PLY header: two elements \"vertex\"");
    m->have_vertices = true;
    lmn_status status = check_count(r, e, LIMIT_VERTICES);
    if (status != LMN_OK)
        return status;
    layout l;
    make_layout(r, e, &l);
    if (!l.has[SLOT_X] || !l.has[SLOT_Y] || !l.has[SLOT_Z])
        return error_in_file(r->error, LMN_FORMAT, r->job->path, 0,
                             "PLY header: element \"vertex\" lacks one of the properties x, y, z");
    if (!allocate_vertices(&m->p, (size_t)e->count, l.has))
        return error_memory(r->error);
    return read_vertex_rows(r, e, m, &l);
}

/* --- faces and strips ----------------------------------------------------------------------------------- */

static lmn_status grow_indices(const ply_reader *r, model *m, size_t more)
{
    size_t wanted = (size_t)m->p.index_count + more;
    if (wanted / 3 > LIMIT_TRIANGLES)
        return error_in_file(r->error, LMN_LIMIT, r->job->path, 0, "more than %zu triangles", LIMIT_TRIANGLES);
    return mem_grow((void **)&m->p.indices, &m->index_capacity, wanted, sizeof *m->p.indices) ? LMN_OK
                                                                                              : error_memory(r->error);
}

static lmn_status add_polygon(const ply_reader *r, const ply_element *e, model *m, uint32_t count, uint64_t row)
{
    if (count < 3) {
        warnings_add(&r->job->scene->warnings, WARNING_BAD_GEOMETRY,
                     "faces with fewer than three corners were left out");
        return LMN_OK;
    }
    for (uint32_t i = 0; i < count; i++)
        if (m->corners[i] >= m->p.vertex_count)
            return ply_bad_row(r, e, row, "a vertex number is out of range");
    lmn_status status = grow_indices(r, m, (size_t)(count - 2) * 3);
    if (status != LMN_OK)
        return status;
    build_triangulate(m->p.positions, m->corners, count, m->p.indices + m->p.index_count);
    m->p.index_count += (count - 2) * 3;
    return LMN_OK;
}

/* −1 starts a new strip; every second triangle is turned. */
static lmn_status add_strip(const ply_reader *r, const ply_element *e, model *m, uint32_t count, uint64_t row)
{
    uint32_t begin = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (m->corners[i] == UINT32_MAX) {
            begin = i + 1;
            continue;
        }
        if (m->corners[i] >= m->p.vertex_count)
            return ply_bad_row(r, e, row, "a vertex number is out of range");
        if (i < begin + 2)
            continue;
        lmn_status status = grow_indices(r, m, 3);
        if (status != LMN_OK)
            return status;
        bool      odd = (i - begin) & 1;
        uint32_t *out = m->p.indices + m->p.index_count;
        out[0] = m->corners[odd ? i - 1 : i - 2];
        out[1] = m->corners[odd ? i - 2 : i - 1];
        out[2] = m->corners[i];
        m->p.index_count += 3;
    }
    return LMN_OK;
}

static lmn_status read_corners(ply_reader *r, const ply_element *e, const ply_property *p, uint64_t row, size_t limit,
                               model *m, uint32_t *out_count)
{
    double count, value;
    if (!ply_read_value(r, p->count_type, &count))
        return bad_value(r, e, row);
    size_t bytes = r->encoding == PLY_ASCII ? 2 : ply_type_size(p->type);
    if (!(count >= 0) || count > ((double)(r->end - r->at) + 1) / (double)bytes)
        return ply_bad_row(r, e, row, "its list is longer than the rest of the file");
    if (count > (double)limit)
        return error_in_file(r->error, LMN_LIMIT, r->job->path, 0,
                             "%s %llu has %.0f corners, more than the limit of %zu", e->name, (unsigned long long)row,
                             count, limit);
    *out_count = (uint32_t)count;
    if (!mem_grow((void **)&m->corners, &m->corner_capacity, *out_count, sizeof *m->corners))
        return error_memory(r->error);
    for (uint32_t i = 0; i < *out_count; i++) {
        if (!ply_read_value(r, p->type, &value))
            return bad_value(r, e, row);
        /* Whatever is no vertex number becomes the restart mark, which a face refuses. */
        m->corners[i] = value >= 0 && value < (double)UINT32_MAX ? (uint32_t)value : UINT32_MAX;
    }
    return LMN_OK;
}

static bool is_corner_list(const ply_property *p)
{
    return p->count_type && (strcmp(p->name, "vertex_indices") == 0 || strcmp(p->name, "vertex_index") == 0);
}

static lmn_status read_face(ply_reader *r, const ply_element *e, model *m, uint64_t row, bool strips)
{
    bool done = false;
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        lmn_status          status = LMN_OK;
        double              value;
        uint32_t            count = 0;
        if (!done && is_corner_list(p)) {
            done = true;
            status = read_corners(r, e, p, row, strips ? LIMIT_VERTICES : LIMIT_POLYGON_CORNERS, m, &count);
            if (status == LMN_OK)
                status = strips ? add_strip(r, e, m, count, row) : add_polygon(r, e, m, count, row);
        } else if (p->count_type)
            status = skip_list(r, e, p, row);
        else if (!ply_read_value(r, p->type, &value))
            status = bad_value(r, e, row);
        if (status != LMN_OK)
            return status;
    }
    end_row(r);
    return LMN_OK;
}

static lmn_status read_faces(ply_reader *r, const ply_element *e, model *m, bool strips)
{
    if (!m->have_vertices)
        return error_in_file(r->error, LMN_FORMAT, r->job->path, 0,
                             "PLY header: element \"%s\" comes before element \"vertex\"", e->name);
    bool found = false;
    for (size_t i = 0; i < e->property_count; i++) {
        if (!found && is_corner_list(&e->properties[i]))
            found = true;
        else
            warnings_add(&r->job->scene->warnings, WARNING_IGNORED, "PLY %s property \"%s\"", e->name,
                         e->properties[i].name);
    }
    if (!found && e->count > 0)
        return error_in_file(r->error, LMN_FORMAT, r->job->path, 0,
                             "PLY header: element \"%s\" has no list \"vertex_indices\" or \"vertex_index\"", e->name);
    lmn_status status = check_count(r, e, LIMIT_TRIANGLES);
    for (uint64_t row = 0; row < e->count && status == LMN_OK; row++) {
        status = read_face(r, e, m, row, strips);
        if (status == LMN_OK && (row & 0xFFFF) == 0xFFFF)
            status = import_progress(r->job, 0.5 + 0.4 * (double)row / (double)e->count, "reading", r->error);
    }
    return status;
}

static lmn_status skip_element(ply_reader *r, const ply_element *e)
{
    if (e->count == 0)
        return LMN_OK;
    warnings_add(&r->job->scene->warnings, WARNING_IGNORED, "PLY element \"%s\"", e->name);
    lmn_status status = check_count(r, e, UINT64_MAX);
    for (uint64_t row = 0; e->property_count && row < e->count && status == LMN_OK; row++) {
        for (size_t i = 0; i < e->property_count && status == LMN_OK; i++) {
            const ply_property *p = &e->properties[i];
            double              value;
            if (p->count_type)
                status = skip_list(r, e, p, row);
            else if (!ply_read_value(r, p->type, &value))
                status = bad_value(r, e, row);
        }
        end_row(r);
    }
    return status;
}

static lmn_status read_elements(ply_reader *r, model *m)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < r->element_count && status == LMN_OK; i++) {
        const ply_element *e = &r->elements[i];
        if (strcmp(e->name, "vertex") == 0)
            status = read_vertices(r, e, m);
        else if (strcmp(e->name, "face") == 0)
            status = read_faces(r, e, m, false);
        else if (strcmp(e->name, "tristrips") == 0)
            status = read_faces(r, e, m, true);
        else
            status = skip_element(r, e);
    }
    return status;
}

/* "comment TextureFile NAME" is how several programs name the picture. */
static lmn_status use_texture(const ply_reader *r, model *m)
{
    if (!r->texture || !m->p.uvs[0])
        return LMN_OK;
    size_t length = r->texture_length;
    while (length > 0 && is_blank(r->texture[length - 1]))
        length--;
    char *name = scene_clean_name(r->texture, length);
    if (!name)
        return error_memory(r->error);
    lmn_scene *s = r->job->scene;
    int32_t    index = NONE;
    lmn_status status = build_image_file(r->job, name, &index, r->error);
    mem_free(name);
    if (status == LMN_OK && index != NONE) {
        material *used = &s->materials[m->p.material];
        used->base_texture.image = index;
        used->base_colour = (vec4){1, 1, 1, 1};
    }
    return status;
}

static lmn_status read_ply(const import_job *job, lmn_error *error)
{
    const char *begin = (const char *)job->file->data;
    ply_reader  r = {.job = job, .error = error, .begin = begin, .at = begin, .end = begin + job->file->size};
    model       m = {.p = {.material = NONE}};
    for (int i = 0; i < 256; i++)
        m.to_linear[i] = colour_to_linear((float)i / 255.0f);
    lmn_status status = ply_read_header(&r);
    if (status == LMN_OK)
        status = read_elements(&r, &m);
    if (status == LMN_OK && m.p.index_count > 0) {
        m.p.material = build_plain_material(job->scene, m.p.colours != NULL);
        status = m.p.material == NONE ? error_memory(error) : use_texture(&r, &m);
        if (status == LMN_OK)
            status = build_part(job->scene, &m.p, NULL, error);
    }
    primitive_release(&m.p);
    mem_free(m.corners);
    ply_release(&r);
    return status;
}

const import_format import_ply = {"PLY", ".ply", 'y', true, recognises, read_ply};
