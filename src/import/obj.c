/* OBJ: polygons and lines with separate indices for positions, texture coordinates and normals. A part is an object
 * ("o"), in files without objects a group ("g"). Corners that agree in all three indices are one vertex, so sharing
 * stays as the file has it. */
#include "import/obj.h"

#include <string.h>

#include "base/colour.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/build.h"

enum { CHAIN_MAX = 64, ABSENT = -1, LINES_PER_STEP = 1 << 16 };

/* Indices from 0, ABSENT when a corner has none. */
typedef struct corner {
    int32_t position, uv, normal;
} corner;

/* The triangles of one material of one part, or its lines: three or two corners each. */
typedef struct piece {
    int32_t material;
    bool    lines;
    corner *corners;
    size_t  count, capacity;
} piece;

typedef struct object {
    char  *name; /* NULL: before the first "o" or "g" */
    piece *pieces;
    size_t count, capacity;
} object;

/* Names to numbers, open addressing; the names belong to others. */
typedef struct name_entry {
    const char *name; /* NULL: free */
    int32_t     value;
} name_entry;

typedef struct name_table {
    name_entry *entries;
    size_t      capacity, used; /* room is a power of two */
} name_table;

/* Where the piece of a material is, as long as the object has not changed since. */
typedef struct piece_start {
    size_t switches, index;
} piece_start;

typedef struct obj_reader {
    const import_job *job;
    lmn_error        *error;
    obj_text          text;
    vec3             *positions, *normals;
    vec4             *colours; /* as many as positions, once a vertex has one */
    vec2             *uvs;
    size_t position_count, position_capacity, colour_count, colour_capacity, normal_count, normal_capacity, uv_count,
        uv_capacity;
    object      *objects;
    size_t       object_count, object_capacity, current;
    name_table   object_names, material_names;
    int32_t      material;
    piece_start *starts; /* by 2 · (material + 1), and one more for lines */
    size_t       start_capacity, switches;
    size_t       triangles, lines;
    corner      *polygon;
    vec3        *polygon_positions;
    uint32_t    *polygon_order, *polygon_triangles;
    size_t       polygon_capacity, polygon_position_capacity, polygon_order_capacity, polygon_triangle_capacity;
    bool         has_objects;
} obj_reader;

/* --- vertices ------------------------------------------------------------------------------------------- */

static lmn_status wrong(const obj_reader *r, const char *what)
{
    return error_in_file(r->error, LMN_FORMAT, r->job->path, build_line(r->text.begin, r->text.at), "%s", what);
}

static lmn_status too_many(const obj_reader *r, const char *what, size_t limit)
{
    return error_in_file(r->error, LMN_LIMIT, r->job->path, build_line(r->text.begin, r->text.at), "more than %zu %s",
                         limit, what);
}

static float to_linear(double value)
{
    return colour_to_linear(value > 0 ? value < 1 ? (float)value : 1.0f : 0.0f);
}

/* Vertices before the first with a colour are white. */
static lmn_status add_colour(obj_reader *r, const double *rgb)
{
    if (!mem_grow((void **)&r->colours, &r->colour_capacity, r->position_count, sizeof *r->colours))
        return error_memory(r->error);
    while (r->colour_count < r->position_count)
        r->colours[r->colour_count++] = (vec4){1, 1, 1, 1};
    if (rgb)
        r->colours[r->colour_count - 1] = (vec4){to_linear(rgb[0]), to_linear(rgb[1]), to_linear(rgb[2]), 1};
    return LMN_OK;
}

/* "v x y z", "v x y z w" or, a common extension, "v x y z r g b". */
static lmn_status read_position(obj_reader *r)
{
    double v[6];
    int    count = 0;
    while (count < 6 && obj_number(&r->text, &v[count]))
        count++;
    if (count < 3)
        return wrong(r, "expected three numbers after \"v\"");
    if (r->position_count >= LIMIT_VERTICES)
        return too_many(r, "vertices", LIMIT_VERTICES);
    if (!mem_grow((void **)&r->positions, &r->position_capacity, r->position_count + 1, sizeof *r->positions))
        return error_memory(r->error);
    r->positions[r->position_count++] = (vec3){(float)v[0], (float)v[1], (float)v[2]};
    return count == 6 || r->colours ? add_colour(r, count == 6 ? v + 3 : NULL) : LMN_OK;
}

static lmn_status read_normal(obj_reader *r)
{
    double v[3];
    for (int i = 0; i < 3; i++)
        if (!obj_number(&r->text, &v[i]))
            return wrong(r, "expected three numbers after \"vn\"");
    if (r->normal_count >= LIMIT_VERTICES)
        return too_many(r, "normals", LIMIT_VERTICES);
    if (!mem_grow((void **)&r->normals, &r->normal_capacity, r->normal_count + 1, sizeof *r->normals))
        return error_memory(r->error);
    r->normals[r->normal_count++] = (vec3){(float)v[0], (float)v[1], (float)v[2]};
    return LMN_OK;
}

/* OBJ counts v from the bottom of the picture. */
static lmn_status read_uv(obj_reader *r)
{
    double u, v = 0;
    if (!obj_number(&r->text, &u))
        return wrong(r, "expected numbers after \"vt\"");
    obj_number(&r->text, &v);
    if (r->uv_count >= LIMIT_VERTICES)
        return too_many(r, "texture coordinates", LIMIT_VERTICES);
    if (!mem_grow((void **)&r->uvs, &r->uv_capacity, r->uv_count + 1, sizeof *r->uvs))
        return error_memory(r->error);
    r->uvs[r->uv_count++] = (vec2){(float)u, 1.0f - (float)v};
    return LMN_OK;
}

/* --- objects -------------------------------------------------------------------------------------------- */

static uint64_t hash_name(const char *name)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (; *name; name++)
        h = (h ^ (unsigned char)*name) * UINT64_C(1099511628211);
    return h ^ h >> 31;
}

static name_entry *find_name(const name_table *t, const char *name)
{
    size_t slot = hash_name(name) & (t->capacity - 1);
    while (t->entries[slot].name && strcmp(t->entries[slot].name, name) != 0)
        slot = (slot + 1) & (t->capacity - 1);
    return &t->entries[slot];
}

/* Room for one more name. */
static bool grow_names(name_table *t)
{
    if (t->capacity > 2 * t->used)
        return true;
    name_table bigger = {.capacity = t->capacity ? t->capacity * 4 : 64, .used = t->used};
    bigger.entries = mem_calloc(bigger.capacity, sizeof *bigger.entries);
    if (!bigger.entries)
        return false;
    for (size_t i = 0; i < t->capacity; i++)
        if (t->entries[i].name)
            *find_name(&bigger, t->entries[i].name) = t->entries[i];
    mem_free(t->entries);
    *t = bigger;
    return true;
}

static void put_name(name_table *t, const char *name, int32_t value)
{
    name_entry *entry = find_name(t, name);
    if (entry->name)
        return; /* the first of a name wins */
    *entry = (name_entry){name, value};
    t->used++;
}

/* Makes the object of this name the current one; takes `name` over. A name that comes again continues its object. */
static lmn_status use_object(obj_reader *r, char *name)
{
    if (r->object_count >= LIMIT_NODES) {
        mem_free(name);
        return too_many(r, "objects", LIMIT_NODES);
    }
    if (!grow_names(&r->object_names) ||
        !mem_grow((void **)&r->objects, &r->object_capacity, r->object_count + 1, sizeof *r->objects)) {
        mem_free(name);
        return error_memory(r->error);
    }
    r->switches++;
    const name_entry *known = name ? find_name(&r->object_names, name) : NULL;
    if (known && known->name) {
        r->current = (size_t)known->value;
        mem_free(name);
        return LMN_OK;
    }
    r->objects[r->object_count] = (object){.name = name};
    r->current = r->object_count++;
    if (name)
        put_name(&r->object_names, name, (int32_t)r->current);
    return LMN_OK;
}

static lmn_status read_object(obj_reader *r)
{
    char *name = obj_rest(&r->text);
    return name ? use_object(r, name) : error_memory(r->error);
}

/* A material that no library has keeps its name, so that it can be selected. */
static lmn_status read_use(obj_reader *r)
{
    lmn_scene *s = r->job->scene;
    char      *name = obj_rest(&r->text);
    if (!name || !grow_names(&r->material_names)) {
        mem_free(name);
        return error_memory(r->error);
    }
    const name_entry *known = find_name(&r->material_names, name);
    if (known->name) {
        r->material = known->value;
        mem_free(name);
        return LMN_OK;
    }
    r->material = build_plain_material(s, r->colours != NULL);
    if (r->material == NONE) {
        mem_free(name);
        return error_memory(r->error);
    }
    mem_free(s->materials[r->material].name);
    s->materials[r->material].name = name;
    put_name(&r->material_names, name, r->material);
    return LMN_OK;
}

static lmn_status read_libraries(obj_reader *r)
{
    char *name = obj_rest(&r->text);
    if (!name)
        return error_memory(r->error);
    lmn_scene *s = r->job->scene;
    size_t     first = s->material_count;
    obj_slash_path(name);
    lmn_status status = obj_read_library(r->job, name, r->error);
    mem_free(name);
    for (size_t i = first; i < s->material_count && status == LMN_OK; i++) {
        if (!grow_names(&r->material_names))
            return error_memory(r->error);
        put_name(&r->material_names, s->materials[i].name, (int32_t)i);
    }
    return status;
}

/* --- faces ---------------------------------------------------------------------------------------------- */

/* One index of a corner: from 1, or negative from the end of what was read so far. False when it names nothing. */
static bool read_index(obj_text *t, size_t count, int32_t *out)
{
    long long   value;
    const char *next = text_parse_int(t->at, t->end, &value);
    if (!next)
        return false;
    t->at = next;
    long long index = value < 0 ? (long long)count + value : value - 1;
    if (value == 0 || index < 0 || index >= (long long)count)
        return false;
    *out = (int32_t)index;
    return true;
}

/* "v", "v/t", "v//n" or "v/t/n". */
static bool read_corner(obj_reader *r, corner *out)
{
    obj_text *t = &r->text;
    *out = (corner){ABSENT, ABSENT, ABSENT};
    if (!read_index(t, r->position_count, &out->position))
        return false;
    if (t->at >= t->end || *t->at != '/')
        return t->at >= t->end || obj_is_blank(*t->at) || *t->at == '\\';
    t->at++;
    if (t->at < t->end && *t->at != '/' && !obj_is_blank(*t->at) && !read_index(t, r->uv_count, &out->uv))
        return false;
    if (t->at < t->end && *t->at == '/') {
        t->at++;
        if (t->at < t->end && !obj_is_blank(*t->at) && !read_index(t, r->normal_count, &out->normal))
            return false;
    }
    return t->at >= t->end || obj_is_blank(*t->at) || *t->at == '\\';
}

/* The piece of the current object and material. An object that is continued gets a new one, which does no harm. */
static piece *current_piece(obj_reader *r, bool lines)
{
    object *o = &r->objects[r->current];
    size_t  slot = 2 * (size_t)(r->material + 1) + lines, had = r->start_capacity;
    if (!mem_grow((void **)&r->starts, &r->start_capacity, slot + 1, sizeof *r->starts))
        return NULL;
    memset(r->starts + had, 0, (r->start_capacity - had) * sizeof *r->starts);
    piece_start *start = &r->starts[slot];
    if (start->switches == r->switches && o->count > 0)
        return &o->pieces[start->index];
    if (!mem_grow((void **)&o->pieces, &o->capacity, o->count + 1, sizeof *o->pieces))
        return NULL;
    *start = (piece_start){r->switches, o->count};
    o->pieces[o->count] = (piece){.material = r->material, .lines = lines};
    return &o->pieces[o->count++];
}

static lmn_status read_polygon(obj_reader *r, size_t *count)
{
    *count = 0;
    while (!obj_at_line_end(&r->text)) {
        if (*count >= LIMIT_POLYGON_CORNERS)
            return too_many(r, "corners in a face", LIMIT_POLYGON_CORNERS);
        if (!mem_grow((void **)&r->polygon, &r->polygon_capacity, *count + 1, sizeof *r->polygon))
            return error_memory(r->error);
        if (!read_corner(r, &r->polygon[*count]))
            return wrong(r, "a face has a corner that is no \"v/vt/vn\" or names a vertex that was not given before");
        ++*count;
    }
    return LMN_OK;
}

static lmn_status cut_polygon(obj_reader *r, size_t count)
{
    if (!mem_grow((void **)&r->polygon_positions, &r->polygon_position_capacity, count, sizeof *r->polygon_positions) ||
        !mem_grow((void **)&r->polygon_order, &r->polygon_order_capacity, count, sizeof *r->polygon_order) ||
        !mem_grow((void **)&r->polygon_triangles, &r->polygon_triangle_capacity, (count - 2) * 3,
                  sizeof *r->polygon_triangles))
        return error_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        r->polygon_positions[i] = r->positions[r->polygon[i].position];
        r->polygon_order[i] = (uint32_t)i;
    }
    build_triangulate(r->polygon_positions, r->polygon_order, (uint32_t)count, r->polygon_triangles);
    return LMN_OK;
}

static lmn_status read_face(obj_reader *r)
{
    size_t     count;
    lmn_status status = read_polygon(r, &count);
    if (status != LMN_OK)
        return status;
    if (count < 3) {
        warnings_add(&r->job->scene->warnings, WARNING_BAD_GEOMETRY,
                     "faces with fewer than three corners were left out");
        return LMN_OK;
    }
    r->triangles += count - 2;
    if (r->triangles > LIMIT_TRIANGLES)
        return too_many(r, "triangles", LIMIT_TRIANGLES);
    if (r->object_count == 0)
        status = use_object(r, NULL);
    piece *p = status == LMN_OK ? current_piece(r, false) : NULL;
    if (!p || !mem_grow((void **)&p->corners, &p->capacity, p->count + (count - 2) * 3, sizeof *p->corners))
        return status == LMN_OK ? error_memory(r->error) : status;
    if (count == 3) {
        memcpy(p->corners + p->count, r->polygon, 3 * sizeof *p->corners);
    } else {
        status = cut_polygon(r, count);
        for (size_t i = 0; status == LMN_OK && i < (count - 2) * 3; i++)
            p->corners[p->count + i] = r->polygon[r->polygon_triangles[i]];
    }
    if (status == LMN_OK)
        p->count += (count - 2) * 3;
    return status;
}

/* "l v1 v2 …": a line from each to the next. Texture coordinates, if any, say nothing of lines. */
static lmn_status read_polyline(obj_reader *r)
{
    if (obj_at_line_end(&r->text)) {
        warnings_add(&r->job->scene->warnings, WARNING_BAD_GEOMETRY, "lines with fewer than two points were left out");
        return LMN_OK;
    }
    lmn_status status = r->object_count == 0 ? use_object(r, NULL) : LMN_OK;
    piece     *p = status == LMN_OK ? current_piece(r, true) : NULL;
    corner     before = {ABSENT, ABSENT, ABSENT};
    if (!p)
        return status == LMN_OK ? error_memory(r->error) : status;
    for (size_t count = 0; !obj_at_line_end(&r->text); count++) {
        corner here;
        if (!read_corner(r, &here))
            return wrong(r,
                         "a line has a point that is no \"v\" or \"v/vt\" or names a vertex that was not given before");
        here.uv = here.normal = ABSENT;
        if (count && ++r->lines > LIMIT_LINES)
            return too_many(r, "lines", LIMIT_LINES);
        if (count && !mem_grow((void **)&p->corners, &p->capacity, p->count + 2, sizeof *p->corners))
            return error_memory(r->error);
        if (count) {
            p->corners[p->count++] = before;
            p->corners[p->count++] = here;
        } else if (obj_at_line_end(&r->text)) {
            warnings_add(&r->job->scene->warnings, WARNING_BAD_GEOMETRY,
                         "lines with fewer than two points were left out");
        }
        before = here;
    }
    return LMN_OK;
}

/* --- lines of text --------------------------------------------------------------------------------------- */

static lmn_status read_line(obj_reader *r)
{
    const char *word;
    size_t      length;
    if (!obj_word(&r->text, &word, &length))
        return LMN_OK;
    if (obj_is(word, length, "v"))
        return read_position(r);
    if (obj_is(word, length, "f") || obj_is(word, length, "fo"))
        return read_face(r);
    if (obj_is(word, length, "vn"))
        return read_normal(r);
    if (obj_is(word, length, "vt"))
        return read_uv(r);
    if (obj_is(word, length, "usemtl"))
        return read_use(r);
    if (obj_is(word, length, "mtllib"))
        return read_libraries(r);
    if (obj_is(word, length, "o") || (obj_is(word, length, "g") && !r->has_objects))
        return read_object(r);
    if (obj_is(word, length, "l"))
        return read_polyline(r);
    if (obj_is(word, length, "p"))
        warnings_add(&r->job->scene->warnings, WARNING_IGNORED, "points are not drawn");
    else if (!obj_is(word, length, "g") && !obj_is(word, length, "s"))
        warnings_add(&r->job->scene->warnings, WARNING_IGNORED,
                     "OBJ statements other than v, vt, vn, f, l, o, g, s, usemtl and mtllib");
    return LMN_OK;
}

static bool find_objects(obj_text t)
{
    for (; t.at < t.end; obj_next_line(&t))
        if (t.end - t.at > 2 && t.at[0] == 'o' && (t.at[1] == ' ' || t.at[1] == '\t'))
            return true;
    return false;
}

static lmn_status read_lines(obj_reader *r)
{
    lmn_status status = LMN_OK;
    for (size_t line = 0; r->text.at < r->text.end && status == LMN_OK; line++) {
        status = read_line(r);
        obj_next_line(&r->text);
        if (status == LMN_OK && line % LINES_PER_STEP == LINES_PER_STEP - 1)
            status = import_progress(r->job,
                                     0.7 * (double)(r->text.at - r->text.begin) / (double)(r->text.end - r->text.begin),
                                     "reading", r->error);
    }
    return status;
}

/* --- to primitives -------------------------------------------------------------------------------------- */

/* For each of the file's positions the newest vertex made from it, valid when `stamp` is the current piece's
 * number. */
typedef struct joiner {
    uint32_t *newest, *stamp, *older;
    corner   *made;
    uint32_t  piece_number;
} joiner;

static uint32_t join(joiner *j, corner c, uint32_t *count)
{
    uint32_t v = j->stamp[c.position] == j->piece_number ? j->newest[c.position] : UINT32_MAX;
    uint32_t first = v;
    for (int steps = 0; v != UINT32_MAX && steps < CHAIN_MAX; v = j->older[v], steps++)
        if (j->made[v].uv == c.uv && j->made[v].normal == c.normal)
            return v;
    j->older[*count] = first;
    j->made[*count] = c;
    j->stamp[c.position] = j->piece_number;
    j->newest[c.position] = *count;
    return (*count)++;
}

static bool fill_vertices(const obj_reader *r, const joiner *j, primitive *p)
{
    bool uvs = false, normals = false, colours = r->colours && !p->lines;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        uvs |= j->made[i].uv != ABSENT;
        normals |= j->made[i].normal != ABSENT;
    }
    p->positions = mem_alloc(p->vertex_count * sizeof *p->positions);
    p->uvs[0] = uvs ? mem_calloc(p->vertex_count, sizeof *p->uvs[0]) : NULL;
    p->normals = normals ? mem_calloc(p->vertex_count, sizeof *p->normals) : NULL;
    p->colours = colours ? mem_alloc(p->vertex_count * sizeof *p->colours) : NULL;
    if (!p->positions || (uvs && !p->uvs[0]) || (normals && !p->normals) || (colours && !p->colours))
        return false;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        corner c = j->made[i];
        p->positions[i] = r->positions[c.position];
        if (c.uv != ABSENT)
            p->uvs[0][i] = r->uvs[c.uv];
        if (c.normal != ABSENT)
            p->normals[i] = r->normals[c.normal];
        if (p->colours)
            p->colours[i] = (size_t)c.position < r->colour_count ? r->colours[c.position] : (vec4){1, 1, 1, 1};
    }
    return true;
}

static bool make_primitive(const obj_reader *r, joiner *j, const piece *from, primitive *p)
{
    uint32_t *indices = mem_alloc(from->count * sizeof *indices);
    p->material = from->material;
    if (from->lines) {
        p->lines = indices;
        p->line_count = (uint32_t)(from->count / 2);
    } else {
        p->indices = indices;
        p->index_count = (uint32_t)from->count;
    }
    j->older = mem_alloc(from->count * sizeof *j->older);
    j->made = mem_alloc(from->count * sizeof *j->made);
    bool good = indices && j->older && j->made;
    j->piece_number++;
    for (size_t i = 0; good && i < from->count; i++)
        indices[i] = join(j, from->corners[i], &p->vertex_count);
    good = good && fill_vertices(r, j, p);
    mem_free(j->older);
    mem_free(j->made);
    if (!good)
        primitive_release(p);
    return good;
}

static lmn_status make_part(const obj_reader *r, joiner *j, const object *o)
{
    lmn_scene *s = r->job->scene;
    mesh      *m = scene_append_mesh(s);
    if (!m || !(m->primitives = mem_calloc(o->count, sizeof *m->primitives)))
        return error_memory(r->error);
    for (size_t i = 0; i < o->count; i++) {
        if (o->pieces[i].count == 0)
            continue;
        if (!make_primitive(r, j, &o->pieces[i], &m->primitives[m->primitive_count]))
            return error_memory(r->error);
        m->primitive_count++;
    }
    node *n = scene_append_node(s);
    if (!n)
        return error_memory(r->error);
    n->mesh = (int32_t)s->mesh_count - 1;
    n->name = o->name && o->name[0] ? mem_copy_text(o->name) : NULL;
    return !o->name || !o->name[0] || n->name ? LMN_OK : error_memory(r->error);
}

static lmn_status make_parts(obj_reader *r)
{
    joiner     j = {.newest = mem_alloc(r->position_count * sizeof *j.newest),
                    .stamp = mem_calloc(r->position_count, sizeof *j.stamp)};
    lmn_status status = j.newest && j.stamp ? LMN_OK : error_memory(r->error);
    int32_t    plain = NONE;
    for (size_t i = 0; i < r->object_count && status == LMN_OK; i++) {
        object *o = &r->objects[i];
        for (size_t k = 0; k < o->count && status == LMN_OK; k++) {
            if (o->pieces[k].material == NONE && plain == NONE)
                plain = build_plain_material(r->job->scene, r->colours != NULL);
            if (o->pieces[k].material == NONE)
                o->pieces[k].material = plain;
            if (o->pieces[k].material == NONE)
                status = error_memory(r->error);
        }
        if (status == LMN_OK && o->count > 0)
            status = make_part(r, &j, o);
        if (status == LMN_OK && i % 256 == 255)
            status = import_progress(r->job, 0.7 + 0.2 * (double)i / (double)r->object_count, "reading", r->error);
    }
    mem_free(j.newest);
    mem_free(j.stamp);
    return status;
}

static void release(obj_reader *r)
{
    for (size_t i = 0; i < r->object_count; i++) {
        for (size_t k = 0; k < r->objects[i].count; k++)
            mem_free(r->objects[i].pieces[k].corners);
        mem_free(r->objects[i].pieces);
        mem_free(r->objects[i].name);
    }
    mem_free(r->objects);
    mem_free(r->object_names.entries);
    mem_free(r->material_names.entries);
    mem_free(r->starts);
    mem_free(r->positions);
    mem_free(r->normals);
    mem_free(r->colours);
    mem_free(r->uvs);
    mem_free(r->polygon);
    mem_free(r->polygon_positions);
    mem_free(r->polygon_order);
    mem_free(r->polygon_triangles);
}

static lmn_status read_obj(const import_job *job, lmn_error *error)
{
    const char *begin = (const char *)job->file->data, *end = begin + job->file->size;
    obj_reader  r = {.job = job, .error = error, .text = {begin, begin, end}, .material = NONE};
    if (job->file->size >= 3 && memcmp(begin, "\xEF\xBB\xBF", 3) == 0)
        r.text.at += 3;
    r.has_objects = find_objects(r.text);
    lmn_status status = read_lines(&r);
    if (status == LMN_OK)
        status = make_parts(&r);
    release(&r);
    return status;
}

const import_format import_obj = {"OBJ", ".obj", 'y', true, NULL, read_obj};
