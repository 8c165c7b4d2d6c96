/* City models to scenes, whatever format they came in. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "import/build.h"
#include "import/city.h"
#include "import/city_crs.h"
#include "import/terrain.h"

typedef struct face_key {
    uint64_t key; /* word, then material */
    uint32_t face;
} face_key;

typedef struct city_scratch {
    city_turner   *turner;
    city_triangles triangles;
    uint32_t      *ends; /* a face: where its triangles end in `triangles` */
    face_key      *order;
    uint32_t      *local; /* a point or corner: its number in the primitive that is made; UINT32_MAX */
    uint32_t      *used;
    size_t         end_capacity, order_capacity, local_capacity, used_capacity;
} city_scratch;

/* --- shapes --------------------------------------------------------------------------------------------- */

void city_shape_clear(city_shape *s)
{
    s->corner_count = s->ring_count = s->face_count = s->uv_count = 0;
    s->lines = false;
}

void city_shape_release(city_shape *s)
{
    mem_free(s->corners);
    mem_free(s->rings);
    mem_free(s->faces);
    mem_free(s->uvs);
    memset(s, 0, sizeof *s);
}

bool city_shape_corner(city_shape *s, uint32_t point)
{
    if (s->corner_count == s->corner_capacity &&
        !mem_grow((void **)&s->corners, &s->corner_capacity, s->corner_count + 1, sizeof *s->corners))
        return false;
    s->corners[s->corner_count++] = point;
    return true;
}

bool city_shape_end_ring(city_shape *s)
{
    if (s->ring_count == s->ring_capacity &&
        !mem_grow((void **)&s->rings, &s->ring_capacity, s->ring_count + 1, sizeof *s->rings))
        return false;
    s->rings[s->ring_count++] = (uint32_t)s->corner_count;
    return true;
}

bool city_shape_end_face(city_shape *s, int32_t material, uint8_t word, uint8_t flags)
{
    if (s->face_count == s->face_capacity &&
        !mem_grow((void **)&s->faces, &s->face_capacity, s->face_count + 1, sizeof *s->faces))
        return false;
    s->faces[s->face_count++] = (city_face){(uint32_t)s->ring_count, material, word, flags};
    return true;
}

/* --- faces as they can be drawn ------------------------------------------------------------------------- */

typedef struct cleaning {
    size_t corners, rings, faces; /* kept */
} cleaning;

/* Keeps the corners of a ring that differ from the one before, and from the first at its end. False: it is to be left
 * out, and *missing says that points do not exist. */
static bool clean_ring(const city_builder *b, city_shape *s, size_t first, size_t end, cleaning *c, bool *missing)
{
    size_t begin = c->corners;
    for (size_t i = first; i < end; i++) {
        uint32_t point = s->corners[i];
        if (point >= b->point_count) {
            *missing = true;
            return false;
        }
        if (c->corners > begin && s->corners[c->corners - 1] == point)
            continue;
        s->corners[c->corners] = point;
        if (s->uv_count)
            s->uvs[c->corners] = s->uvs[i];
        c->corners++;
    }
    while (c->corners > begin + 1 && s->corners[c->corners - 1] == s->corners[begin])
        c->corners--;
    return c->corners >= begin + 3 && c->corners - begin <= LIMIT_POLYGON_CORNERS;
}

/* A hole that is none is left out, a face whose outline is none goes with its holes. */
static void clean_shape(city_builder *b, city_shape *s)
{
    cleaning c = {0};
    size_t   ring = 0, corner = 0;
    for (size_t f = 0; f < s->face_count; f++) {
        city_face      face = s->faces[f];
        const cleaning before = c;
        bool           good = ring < face.ring_end, missing = false;
        for (size_t k = 0; ring < face.ring_end; ring++, k++) {
            size_t end = s->rings[ring], kept = c.corners;
            bool   right = good && clean_ring(b, s, corner, end, &c, &missing);
            if (right)
                s->rings[c.rings++] = (uint32_t)c.corners;
            else
                c.corners = kept;
            good = good && !missing && (right || k > 0);
            corner = end;
        }
        if (!good) {
            c = before;
            b->tally.missing_points += missing;
            b->tally.degenerate += !missing;
            continue;
        }
        face.ring_end = (uint32_t)c.rings;
        s->faces[c.faces++] = face;
    }
    s->face_count = c.faces;
    s->ring_count = c.rings;
    s->corner_count = c.corners;
    s->uv_count = s->uv_count ? c.corners : 0;
}

/* What the faces of a building are where its file does not say: level ones are roofs, the lowest of them grounds, all
 * others walls. */
static void guess_words(const city_builder *b, city_shape *s, uint8_t roof, uint8_t wall, uint8_t ground)
{
    float low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < s->corner_count; i++) {
        low = fminf(low, b->points[s->corners[i]].z);
        high = fmaxf(high, b->points[s->corners[i]].z);
    }
    for (size_t f = 0; f < s->face_count; f++) {
        double n[3];
        float  top = -INFINITY;
        city_normal(b->points, s, f, n);
        size_t ring = city_first_ring(s, f);
        for (size_t i = city_first_corner(s, ring); i < s->rings[ring]; i++)
            top = fmaxf(top, b->points[s->corners[i]].z);
        bool level = fabs(n[2]) > 0.17 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        s->faces[f].word = !level || (n[2] < 0 && top > low + 0.1f * (high - low)) ? wall : n[2] < 0 ? ground : roof;
    }
}

static void name_faces(city_builder *b, city_shape *s, uint8_t own, bool building)
{
    bool any = own != CITY_NO_WORD || !building;
    for (size_t f = 0; f < s->face_count && !any; f++)
        any = s->faces[f].word != CITY_NO_WORD;
    if (!any) {
        guess_words(b, s, city_word_of_class("RoofSurface", 11), city_word_of_class("WallSurface", 11),
                    city_word_of_class("GroundSurface", 13));
        b->tally.guessed += s->face_count;
    }
    for (size_t f = 0; f < s->face_count; f++) {
        if (s->faces[f].word == CITY_NO_WORD)
            s->faces[f].word = own;
        b->surfaces[s->faces[f].word == CITY_NO_WORD ? city_word_count : s->faces[f].word]++;
    }
}

static lmn_status cut_faces(city_builder *b, const city_shape *s)
{
    city_scratch *x = b->scratch;
    x->triangles.count = 0;
    if (!mem_grow((void **)&x->ends, &x->end_capacity, s->face_count, sizeof *x->ends))
        return error_memory(b->error);
    for (size_t f = 0; f < s->face_count; f++) {
        city_cut how = city_triangulate(&x->triangles, b->points, s, f);
        if (how == CITY_CUT_NO_MEMORY)
            return error_memory(b->error);
        b->tally.degenerate += how == CITY_CUT_NOTHING;
        b->tally.crossing += how == CITY_CUT_CROSSING;
        b->tally.uneven += how == CITY_CUT_UNEVEN;
        x->ends[f] = (uint32_t)x->triangles.count;
    }
    return LMN_OK;
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static int compare_keys(const void *a, const void *b)
{
    const face_key *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->face < y->face ? -1 : x->face > y->face;
}

static lmn_status sort_faces(city_builder *b, const city_shape *s)
{
    city_scratch *x = b->scratch;
    if (!mem_grow((void **)&x->order, &x->order_capacity, s->face_count, sizeof *x->order))
        return error_memory(b->error);
    bool sorted = true;
    for (size_t f = 0; f < s->face_count; f++) {
        x->order[f] = (face_key){(uint64_t)s->faces[f].word << 32 | (uint32_t)(s->faces[f].material + 1), (uint32_t)f};
        sorted = sorted && (f == 0 || x->order[f - 1].key <= x->order[f].key);
    }
    if (!sorted)
        qsort(x->order, s->face_count, sizeof *x->order, compare_keys);
    return LMN_OK;
}

/* Room for numbers of points, or of corners where each has a place of its own in a texture. */
static bool make_local(city_scratch *x, size_t count)
{
    size_t had = x->local_capacity;
    if (count <= had)
        return true;
    if (!mem_grow((void **)&x->local, &x->local_capacity, count, sizeof *x->local))
        return false;
    memset(x->local + had, 0xFF, (x->local_capacity - had) * sizeof *x->local);
    return true;
}

static void fill_primitive(const city_builder *b, const city_shape *s, primitive *p, const uint32_t *used)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        p->positions[i] = b->points[s->uv_count ? s->corners[used[i]] : used[i]];
        if (p->uvs[0])
            p->uvs[0][i] = s->uvs[used[i]];
    }
}

/* One of the faces order[from] … order[to − 1], which have one material. */
static lmn_status make_primitive(city_builder *b, const city_shape *s, size_t from, size_t to, primitive *p)
{
    city_scratch *x = b->scratch;
    size_t        corners = 0, at = 0;
    for (size_t i = from; i < to; i++) {
        uint32_t f = x->order[i].face;
        corners += x->ends[f] - (f ? x->ends[f - 1] : 0);
    }
    *p = (primitive){.material = s->faces[x->order[from].face].material};
    if (p->material == NONE)
        p->material = b->plain;
    p->indices = mem_alloc(corners * sizeof *p->indices);
    if (!p->indices || !make_local(x, s->uv_count ? s->corner_count : b->point_count) ||
        !mem_grow((void **)&x->used, &x->used_capacity, corners, sizeof *x->used)) {
        primitive_release(p);
        return error_memory(b->error);
    }
    for (size_t i = from; i < to; i++) {
        uint32_t f = x->order[i].face;
        for (size_t k = f ? x->ends[f - 1] : 0; k < x->ends[f]; k++) {
            uint32_t corner = x->triangles.corners[k], number = s->uv_count ? corner : s->corners[corner];
            if (x->local[number] == UINT32_MAX) {
                x->used[p->vertex_count] = number;
                x->local[number] = p->vertex_count++;
            }
            p->indices[at++] = x->local[number];
        }
    }
    p->index_count = (uint32_t)at;
    p->positions = mem_alloc(p->vertex_count * sizeof *p->positions);
    p->uvs[0] = s->uv_count ? mem_alloc(p->vertex_count * sizeof *p->uvs[0]) : NULL;
    bool good = p->positions && (p->uvs[0] || !s->uv_count);
    if (good)
        fill_primitive(b, s, p, x->used);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        x->local[x->used[i]] = UINT32_MAX;
    if (good)
        return LMN_OK;
    primitive_release(p);
    return error_memory(b->error);
}

static lmn_status add_form(city_builder *b, primitive *primitives, size_t count, uint8_t word, city_forms *out)
{
    if (out->count == out->capacity) { /* most objects have three: arrays of objects wait by the thousand */
        size_t     room = out->capacity ? 2 * out->capacity : 4;
        city_form *grown = mem_realloc(out->items, room * sizeof *grown);
        if (!grown)
            return error_memory(b->error);
        out->items = grown;
        out->capacity = room;
    }
    primitive *kept = mem_copy(primitives, count * sizeof *primitives);
    if (!kept)
        return error_memory(b->error);
    out->items[out->count++] = (city_form){kept, count, word};
    return LMN_OK;
}

void city_forms_release(city_forms *forms)
{
    for (size_t i = 0; i < forms->count; i++) {
        for (size_t k = 0; k < forms->items[i].count; k++)
            primitive_release(&forms->items[i].primitives[k]);
        mem_free(forms->items[i].primitives);
    }
    mem_free(forms->items);
    *forms = (city_forms){NULL, 0, 0};
}

lmn_status city_keep(city_builder *b, city_forms *forms, city_meshes *out)
{
    for (size_t i = 0; i < forms->count; i++) {
        city_form *form = &forms->items[i];
        if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
            return error_memory(b->error);
        mesh *m = scene_append_mesh(b->scene);
        if (!m)
            return error_memory(b->error);
        m->primitives = form->primitives;
        m->primitive_count = form->count;
        out->items[out->count++] = (city_mesh){(int32_t)b->scene->mesh_count - 1, form->word};
        *form = (city_form){NULL, 0, CITY_NO_WORD};
    }
    forms->count = 0;
    return LMN_OK;
}

/* The faces order[from] … order[to − 1] of one word: a primitive for each material. */
static lmn_status make_form(city_builder *b, const city_shape *s, size_t from, size_t to, city_forms *out)
{
    const face_key *order = b->scratch->order;
    primitive      *list = NULL;
    size_t          count = 0, capacity = 0;
    lmn_status      status = LMN_OK;
    uint8_t         word = s->faces[order[from].face].word;
    bool            ground = word != CITY_NO_WORD && strcmp(city_words[word], "terrain") == 0;
    for (size_t i = from; i < to && status == LMN_OK;) {
        size_t end = i + 1;
        while (end < to && order[end].key == order[i].key)
            end++;
        primitive p = {0};
        status = make_primitive(b, s, i, end, &p);
        if (status == LMN_OK && p.index_count && ground && !terrain_make_smooth(&p)) {
            primitive_release(&p);
            status = error_memory(b->error);
        }
        if (status == LMN_OK && p.index_count == 0) {
            primitive_release(&p);
        } else if (status == LMN_OK && !mem_grow((void **)&list, &capacity, count + 1, sizeof *list)) {
            primitive_release(&p);
            status = error_memory(b->error);
        } else if (status == LMN_OK) {
            list[count++] = p;
        }
        i = end;
    }
    if (status == LMN_OK && count)
        status = add_form(b, list, count, s->faces[order[from].face].word, out);
    for (size_t i = 0; status != LMN_OK && i < count; i++)
        primitive_release(&list[i]);
    mem_free(list);
    return status;
}

static lmn_status make_lines(city_builder *b, const city_shape *s, uint8_t own, city_forms *out)
{
    primitive p = {.material = b->plain};
    p.positions = mem_calloc(s->corner_count, sizeof *p.positions);
    p.lines = mem_calloc(2 * s->corner_count, sizeof *p.lines);
    for (size_t r = 0; p.positions && p.lines && r < s->ring_count; r++)
        for (size_t i = city_first_corner(s, r); i < s->rings[r]; i++) {
            bool begins = i == city_first_corner(s, r) || p.vertex_count == 0;
            if (s->corners[i] >= b->point_count) {
                b->tally.missing_points++;
                continue;
            }
            p.positions[p.vertex_count] = b->points[s->corners[i]];
            if (!begins) {
                p.lines[2 * p.line_count] = p.vertex_count - 1;
                p.lines[2 * p.line_count + 1] = p.vertex_count;
                p.line_count++;
            }
            p.vertex_count++;
        }
    lmn_status status = p.positions && p.lines ? LMN_OK : error_memory(b->error);
    bool       any = p.line_count > 0;
    if (status == LMN_OK && any)
        status = add_form(b, &p, 1, own, out);
    if (status != LMN_OK || !any)
        primitive_release(&p);
    return status;
}

lmn_status city_form_shape(city_builder *b, city_shape *s, uint8_t own, bool building, city_forms *out)
{
    if (s->lines)
        return make_lines(b, s, own, out);
    clean_shape(b, s);
    if (s->face_count == 0)
        return LMN_OK;
    if (!city_turn(b->scratch->turner, b->points, s, building, &b->tally.turned))
        return error_memory(b->error);
    name_faces(b, s, own, building);
    lmn_status status = cut_faces(b, s);
    if (status == LMN_OK)
        status = sort_faces(b, s);
    for (size_t i = 0; i < s->face_count && status == LMN_OK;) {
        size_t end = i + 1;
        while (end < s->face_count && b->scratch->order[end].key >> 32 == b->scratch->order[i].key >> 32)
            end++;
        status = make_form(b, s, i, end, out);
        i = end;
    }
    return status;
}

lmn_status city_make(city_builder *b, city_shape *s, uint8_t own, bool building, city_meshes *out)
{
    city_forms forms = {NULL, 0, 0};
    lmn_status status = city_form_shape(b, s, own, building, &forms);
    if (status == LMN_OK)
        status = city_keep(b, &forms, out);
    city_forms_release(&forms);
    return status;
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

bool city_attribute_sized(lmn_scene *scene, int32_t node_index, const char *key, size_t key_size, const char *value,
                          size_t value_size)
{
    node      *n = &scene->nodes[node_index];
    attribute *grown = node_own_facts(n) ? mem_realloc(n->attributes, (n->attribute_count + 1) * sizeof *grown) : NULL;
    if (!grown)
        return false;
    n->attributes = grown;
    bool good = attribute_make_sized(&grown[n->attribute_count], key, key_size, value, value_size);
    n->attribute_count += good;
    return good;
}

bool city_attribute(lmn_scene *scene, int32_t node, const char *key, const char *value)
{
    return city_attribute_sized(scene, node, key, strlen(key), value, strlen(value));
}

/* As most texts are: what stands in the file is what is meant. */
bool city_attribute_of_spans(lmn_scene *scene, int32_t node, json_span key, json_span value)
{
    if (span_is_plain(key) && span_is_plain(value))
        return city_attribute_sized(scene, node, key.at, key.size, value.at, value.size);
    char *name = span_decode(key), *copy = name ? span_decode(value) : NULL;
    bool  good = copy && city_attribute(scene, node, name, copy);
    mem_free(name);
    mem_free(copy);
    return good;
}

int32_t city_object(city_builder *b, char *id, const char *type, size_t type_size)
{
    node   *n = id ? scene_append_node(b->scene) : NULL;
    int32_t index = (int32_t)b->scene->node_count - 1;
    if (!n) {
        mem_free(id);
        error_memory(b->error);
        return NONE;
    }
    n->name = id;
    char *name = scene_clean_name(type, type_size);
    if (!name || !city_add(&b->scene->city, CITY_OBJECTS, name, 1) || !city_attribute(b->scene, index, "type", name)) {
        mem_free(name);
        error_memory(b->error);
        return NONE;
    }
    mem_free(name);
    return index;
}

bool city_link(city_builder *b, int32_t parent, int32_t child)
{
    const node *nodes = b->scene->nodes;
    bool        good = nodes[child].parent == NONE;
    int         depth = 0;
    for (int32_t n = parent; n != NONE && good; n = nodes[n].parent)
        good = n != child && ++depth < LIMIT_NODE_DEPTH / 2;
    if (good)
        scene_link_child(b->scene, parent, child);
    else
        b->tally.cyclic++;
    return good;
}

/* Puts a mesh there; `alone`: the node is for it alone and gets its name, too. */
static lmn_status put(city_builder *b, int32_t at, const city_mesh *m, const mat4 *matrix, bool alone)
{
    node *n = &b->scene->nodes[at];
    n->mesh = m->mesh;
    if (matrix && !node_set_matrix(n, matrix))
        return error_memory(b->error);
    if (alone)
        city_lend_facts(n, m->word);
    else if (m->word != CITY_NO_WORD && !city_attribute(b->scene, at, CITY_SURFACE_KEY, city_words[m->word]))
        return error_memory(b->error);
    return LMN_OK;
}

lmn_status city_attach(city_builder *b, int32_t node_index, const city_meshes *meshes, const mat4 *matrix, bool alone)
{
    alone = alone || !matrix;
    if (meshes->count == 1 && alone && b->scene->nodes[node_index].mesh == NONE)
        return put(b, node_index, &meshes->items[0], matrix, false);
    for (size_t i = 0; i < meshes->count; i++) {
        if (!scene_append_node(b->scene))
            return error_memory(b->error);
        int32_t    index = (int32_t)b->scene->node_count - 1;
        lmn_status status = put(b, index, &meshes->items[i], matrix, true);
        if (status != LMN_OK)
            return status;
        scene_link_child(b->scene, node_index, index);
    }
    return LMN_OK;
}

/* --- open and close ------------------------------------------------------------------------------------- */

static city_scratch *open_scratch(void)
{
    city_scratch *x = mem_calloc(1, sizeof *x);
    if (x)
        x->turner = city_turner_new();
    return x;
}

static void close_scratch(city_builder *b)
{
    city_scratch *x = b->scratch;
    if (!x)
        return;
    city_turner_free(x->turner);
    mem_free(x->triangles.corners);
    mem_free(x->ends);
    mem_free(x->order);
    mem_free(x->local);
    mem_free(x->used);
    mem_free(x);
    b->scratch = NULL;
}

lmn_status city_builder_fork(city_builder *out, const city_builder *b, lmn_error *error)
{
    *out = (city_builder){
        .job = b->job, .error = error, .points = b->points, .point_count = b->point_count, .plain = b->plain};
    out->scratch = open_scratch();
    return out->scratch && out->scratch->turner ? LMN_OK : error_memory(error);
}

void city_builder_join(city_builder *b, city_builder *forked)
{
    uint64_t       *to = (uint64_t *)&b->tally;
    const uint64_t *from = (const uint64_t *)&forked->tally;
    for (size_t i = 0; i < sizeof b->tally / sizeof *to; i++)
        to[i] += from[i];
    for (size_t i = 0; i < sizeof b->surfaces / sizeof *b->surfaces; i++)
        b->surfaces[i] += forked->surfaces[i];
    close_scratch(forked);
}

lmn_status city_builder_open(city_builder *b, const import_job *job, lmn_error *error)
{
    *b = (city_builder){.job = job, .scene = job->scene, .error = error};
    b->scratch = open_scratch();
    b->plain = b->scratch && b->scratch->turner ? build_plain_material(job->scene, false) : NONE;
    return b->plain != NONE ? LMN_OK : error_memory(error);
}

void city_builder_points(city_builder *b, const vec3 *points, size_t count)
{
    b->points = points;
    b->point_count = count;
}

/* What each count is called in reports, and the warning that it is worth. */
typedef struct tally_row {
    uint64_t     count;
    city_group   group;
    const char  *name, *text;
    warning_code code;
} tally_row;

static void tell(const city_builder *b, const tally_row *row)
{
    if (!row->count)
        return;
    city_add(&b->scene->city, row->group, row->name, row->count);
    if (row->text)
        warnings_add(&b->scene->warnings, row->code, "%llu %s", (unsigned long long)row->count, row->text);
}

static void tell_all(const city_builder *b)
{
    const city_tally *t = &b->tally;
    const tally_row   rows[] = {
          {t->degenerate, CITY_SKIPPED, "degenerate-faces", "faces have no area and are left out", WARNING_BAD_GEOMETRY},
          {t->missing_points, CITY_SKIPPED, "missing-points", "faces refer to points that do not exist and are left out",
           WARNING_BAD_GEOMETRY},
          {t->bad_geometry, CITY_SKIPPED, "bad-geometries",
           "geometries are not built as their type says and are left out", WARNING_BAD_GEOMETRY},
          {t->no_geometry, CITY_SKIPPED, "objects-without-geometry", NULL, WARNING_IGNORED},
          {t->no_lod, CITY_SKIPPED, "objects-without-this-lod",
           "objects have no geometry of the level of detail that is asked for", WARNING_IGNORED},
          {t->coarser, CITY_SKIPPED, "coarser-than-parts", NULL, WARNING_IGNORED},
          {t->points, CITY_SKIPPED, "points", "geometries consist of points, which are not drawn", WARNING_IGNORED},
          {t->broken_references, CITY_SKIPPED, "broken-references", "references lead nowhere", WARNING_BAD_VALUE},
          {t->cyclic, CITY_SKIPPED, "parents", "objects have a second parent or are their own ancestors; that is ignored",
           WARNING_BAD_VALUE},
          {t->extensions, CITY_SKIPPED, "extensions", NULL, WARNING_IGNORED},
          {t->unknown_types, CITY_SKIPPED, "unknown-types", "geometries are of types that are not known and are left out",
           WARNING_IGNORED},
          {t->crossing, CITY_REPAIRED, "self-crossing-faces",
           "faces cross themselves; they are filled nearly as they mean", WARNING_BAD_GEOMETRY},
          {t->uneven, CITY_REPAIRED, "uneven-faces", NULL, WARNING_APPROXIMATE},
          {t->turned, CITY_REPAIRED, "turned-faces", NULL, WARNING_APPROXIMATE},
          {t->guessed, CITY_REPAIRED, "guessed-surfaces", NULL, WARNING_APPROXIMATE},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        tell(b, &rows[i]);
    for (size_t i = 0; i <= city_word_count; i++)
        if (b->surfaces[i])
            city_add(&b->scene->city, CITY_SURFACES, i < city_word_count ? city_words[i] : "other", b->surfaces[i]);
}

/* Nothing came of the file: the first cause that is known. */
static lmn_status nothing_made(const city_builder *b)
{
    const city_tally *t = &b->tally;
    const struct {
        uint64_t    count;
        const char *text, *hint;
    } rows[] = {
        {t->no_lod, "objects have no geometry of the level of detail that is asked for", "ask for another one: --lod"},
        {t->bad_geometry, "geometries are not nested as their type says", NULL},
        {t->unknown_types, "geometries are of types that are not known", NULL},
        {t->missing_points, "faces or positions refer to points that do not exist, or are no numbers", NULL},
        {t->degenerate, "faces have no area", NULL},
        {t->points, "geometries consist of points",
         "points alone are not drawn; export the model with its surfaces or lines"},
        {t->no_geometry, "objects have no geometry", NULL},
    };
    char        cause[200] = "it has no objects of a city";
    const char *hint = NULL;
    if (b->cause[0])
        snprintf(cause, sizeof cause, "%s", b->cause);
    for (size_t i = 0; i < sizeof rows / sizeof *rows && !b->cause[0]; i++)
        if (rows[i].count) {
            snprintf(cause, sizeof cause, "%llu %s", (unsigned long long)rows[i].count, rows[i].text);
            hint = rows[i].hint;
            break;
        }
    error_in_file(b->error, LMN_FORMAT, b->job->path, 0, "nothing to draw: the file has no triangles or lines: %s",
                  cause);
    if (hint)
        error_hint(b->error, "%s", hint);
    return LMN_FORMAT;
}

/* Coordinates of an unknown system are taken as metres: that may be wrong. */
static void tell_system(const city_builder *b)
{
    const city_facts *facts = &b->scene->city;
    if (!facts->crs && !facts->geographic)
        warnings_add(&b->scene->warnings, WARNING_APPROXIMATE,
                     "the file does not say in which coordinate system it lies; its numbers are taken as metres");
    else if (facts->crs && !city_crs_is_known(facts->crs))
        warnings_add(&b->scene->warnings, WARNING_APPROXIMATE,
                     "the coordinate system '%.80s' is not known; its numbers are taken as metres", facts->crs);
}

lmn_status city_builder_close(city_builder *b, lmn_status status)
{
    if (status == LMN_OK)
        status = city_builder_terrain(b);
    if (status == LMN_OK && b->terrain)
        status = terrain_into_scene(b->terrain, b);
    terrain_free(b->terrain);
    b->terrain = NULL;
    if (status == LMN_OK && b->scene->mesh_count == 0)
        status = nothing_made(b);
    if (status == LMN_OK) {
        tell_all(b);
        tell_system(b);
        warnings_fold(&b->scene->warnings, WARNING_MISSING_FILE, "texture", "textures are missing");
    }
    close_scratch(b);
    return status;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The middle of most of the points, by a sample. */
static void find_middle(double (*points)[3], size_t count, double low[3], double high[3])
{
    enum { SAMPLES = 999 };
    double sample[SAMPLES];
    for (int k = 0; k < 3; k++) {
        size_t taken = 0;
        for (size_t i = 0; i < SAMPLES && i < count; i++) {
            double v = points[count < SAMPLES ? i : i * count / SAMPLES][k];
            if (isfinite(v))
                sample[taken++] = v;
        }
        qsort(sample, taken, sizeof *sample, compare_doubles);
        low[k] = high[k] = taken ? sample[taken / 2] : 0;
    }
}

void city_extent(double (*points)[3], size_t count, double low[3], double high[3])
{
    static const double FAR = 1e6;
    bool                near = true;
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
        for (size_t i = 0; i < count; i++) {
            low[k] = points[i][k] < low[k] ? points[i][k] : low[k];
            high[k] = points[i][k] > high[k] ? points[i][k] : high[k];
        }
        near = near && high[k] - low[k] <= FAR;
    }
    if (!near)
        find_middle(points, count, low, high);
}

/* `at` in the file's unit. */
static void widen_place(city_facts *facts, const double at[2])
{
    double p[2] = {(at[0] - facts->origin[0]) * city_metres(facts, 0),
                   (at[1] - facts->origin[1]) * city_metres(facts, 0)};
    if (facts->geographic) {
        double zero[2], meridian = city_meridian(facts->origin[0]);
        city_plane(facts->origin[0], facts->origin[1], meridian, zero);
        city_plane(at[0], at[1], meridian, p);
        p[0] -= zero[0];
        p[1] -= zero[1];
    }
    for (int k = 0; k < 2; k++) {
        facts->low[k] = fmin(facts->low[k], p[k]);
        facts->high[k] = fmax(facts->high[k], p[k]);
    }
}

void city_choose_origin(city_facts *facts, const double low[3], const double high[3])
{
    facts->known = true;
    for (int k = 0; k < 3; k++) {
        double middle = low[k] + (high[k] - low[k]) / 2, step = facts->geographic && k < 2 ? 1e-4 : 1;
        /* Heights stay what they are, where they are heights. */
        facts->origin[k] = k == 2 && fabs(middle) < 1e5 ? 0 : round(middle / step) * step;
    }
    for (int k = 0; k < 2; k++) {
        facts->low[k] = INFINITY;
        facts->high[k] = -INFINITY;
    }
    for (int corner = 0; corner < 4; corner++) {
        const double at[2] = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1]};
        widen_place(facts, at);
    }
}
