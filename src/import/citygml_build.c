/* What was read of CityGML to a scene: references, levels of detail, points, faces, nodes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "import/city_crs.h"
#include "import/citygml.h"

/* Polygons that an object only refers to may be as many as it has itself, and some. */
enum { BORROWED_ALWAYS = 1000000 };

/* The polygons of all owners, owner by owner: those of `i` are order[starts[i]] … order[starts[i + 1] − 1]. Templates
 * come behind the objects, and then borrowed ones take the place of own ones. */
typedef struct gml_groups {
    uint32_t *order, *starts;
    uint32_t *borrowed, *borrowed_starts;
} gml_groups;

typedef struct weld_table {
    uint32_t *slots, *round_of;
    size_t    capacity;
    uint32_t  round;
} weld_table;

typedef struct gml_building {
    citygml_reader *r;
    gml_groups      groups;
    weld_table      weld;
    city_shape      shape;
    city_meshes     meshes;
    city_meshes    *templates;
    bool           *template_made;
    vec3           *points, *template_points;
    size_t          lods[GML_LODS];
} gml_building;

/* --- ids ------------------------------------------------------------------------------------------------ */

static int compare_ranges(const void *a, const void *b)
{
    const gml_range *x = a, *y = b;
    return x->id < y->id ? -1 : x->id > y->id;
}

static int compare_places(const void *a, const void *b)
{
    const gml_places *x = a, *y = b;
    return x->ring < y->ring ? -1 : x->ring > y->ring;
}

static const gml_range *find_range(const citygml_reader *r, gml_id id)
{
    const gml_range key = {.id = id};
    return r->ranges_count ? bsearch(&key, r->ranges, r->ranges_count, sizeof key, compare_ranges) : NULL;
}

static const gml_places *find_places(const citygml_reader *r, gml_id ring)
{
    const gml_places key = {.ring = ring};
    return ring && r->places_count ? bsearch(&key, r->places, r->places_count, sizeof key, compare_places) : NULL;
}

static void paint_polygons(citygml_reader *r)
{
    for (size_t i = 0; i < r->paints_count; i++) {
        const gml_range *range = find_range(r, r->paints[i].target);
        for (uint32_t k = range ? range->first : 0; range && k < range->end; k++)
            if (r->polygons[k].material == NONE)
                r->polygons[k].material = r->paints[i].material;
    }
}

static size_t corners_of(const citygml_reader *r, uint32_t polygon)
{
    size_t count = 0;
    for (uint32_t k = polygon ? r->polygons[polygon - 1].ring_end : 0; k < r->polygons[polygon].ring_end; k++)
        count += r->rings[k].count;
    return count;
}

/* A reference within one object and one level of detail says again what is there, or says what it is. */
static void settle_reference(citygml_reader *r, const gml_reference *f)
{
    const gml_range *range = find_range(r, f->id);
    if (!range) {
        r->builder.tally.broken_references++;
        return;
    }
    for (uint32_t k = range->first; k < range->end && r->status == LMN_OK; k++) {
        gml_polygon *p = &r->polygons[k];
        if (p->owner == f->owner && p->lod == f->lod) {
            p->word = p->word == CITY_NO_WORD ? f->word : p->word;
            continue;
        }
        r->borrowed_corners += corners_of(r, k);
        if (r->borrowed_corners > BORROWED_ALWAYS + r->points_count) {
            citygml_fail(r, LMN_LIMIT, "its references repeat more geometry than there is");
            return;
        }
        gml_borrowed *b = GML_APPEND(r, borrowed);
        if (b)
            *b = (gml_borrowed){f->owner, k, f->lod, f->word};
    }
}

/* --- owners --------------------------------------------------------------------------------------------- */

/* Where an owner stands in the groups; behind the last: nowhere. */
static size_t slot_of(const citygml_reader *r, int32_t owner)
{
    size_t templates = r->template_count;
    if (owner >= 0)
        return (size_t)owner;
    if (owner <= -2 && (size_t)(-2 - owner) < templates)
        return r->objects_count + (size_t)(-2 - owner);
    return r->objects_count + templates;
}

static uint32_t *make_starts(citygml_reader *r, size_t slots)
{
    uint32_t *starts = mem_calloc(slots + 2, sizeof *starts);
    if (!starts)
        citygml_no_memory(r);
    return starts;
}

static bool group(gml_building *b)
{
    citygml_reader *r = b->r;
    gml_groups     *g = &b->groups;
    size_t          slots = r->objects_count + r->template_count;
    g->starts = make_starts(r, slots);
    g->borrowed_starts = make_starts(r, slots);
    g->order = mem_calloc(r->polygons_count + 1, sizeof *g->order);
    g->borrowed = mem_calloc(r->borrowed_count + 1, sizeof *g->borrowed);
    if (!g->starts || !g->borrowed_starts || !g->order || !g->borrowed)
        return citygml_no_memory(r);
    for (size_t i = 0; i < r->polygons_count; i++)
        g->starts[slot_of(r, r->polygons[i].owner) + 1]++;
    for (size_t i = 0; i < r->borrowed_count; i++)
        g->borrowed_starts[slot_of(r, r->borrowed[i].owner) + 1]++;
    for (size_t i = 1; i < slots + 2; i++) {
        g->starts[i] += g->starts[i - 1];
        g->borrowed_starts[i] += g->borrowed_starts[i - 1];
    }
    /* Filled from the back, so that starts come out as they were. */
    for (size_t i = r->polygons_count; i-- > 0;)
        g->order[--g->starts[slot_of(r, r->polygons[i].owner) + 1]] = (uint32_t)i;
    for (size_t i = r->borrowed_count; i-- > 0;)
        g->borrowed[--g->borrowed_starts[slot_of(r, r->borrowed[i].owner) + 1]] = (uint32_t)i;
    return true;
}

/* After filling, what was the end of a slot is its beginning. */
static uint32_t begin_of(const uint32_t *starts, size_t slot)
{
    return starts[slot + 1];
}

static uint32_t end_of(const citygml_reader *r, const uint32_t *starts, size_t slot, size_t total)
{
    return slot + 1 < r->objects_count + r->template_count + 1 ? starts[slot + 2] : (uint32_t)total;
}

static void raise_lod(citygml_reader *r, int32_t owner, int8_t lod)
{
    if (owner >= 0 && lod <= r->wish && lod > r->objects[owner].lod)
        r->objects[owner].lod = lod;
}

static void choose_lods(citygml_reader *r)
{
    for (size_t i = 0; i < r->polygons_count; i++)
        raise_lod(r, r->polygons[i].owner, r->polygons[i].lod);
    for (size_t i = 0; i < r->borrowed_count; i++)
        raise_lod(r, r->borrowed[i].owner, r->borrowed[i].lod);
    for (size_t i = 0; i < r->instances_count; i++)
        raise_lod(r, r->instances[i].owner, r->instances[i].lod);
    for (size_t i = 0; i < r->objects_count; i++) {
        const gml_object *o = &r->objects[i];
        if (o->is_part && o->parent != NONE && o->lod > r->objects[o->parent].below_lod)
            r->objects[o->parent].below_lod = o->lod;
    }
}

/* --- points --------------------------------------------------------------------------------------------- */

/* In the same block, from its beginning. */
static vec3 *to_floats(double *list, size_t numbers)
{
    for (size_t i = 0; i < numbers / 3; i++) {
        vec3 small = {(float)list[3 * i], (float)list[3 * i + 1], (float)list[3 * i + 2]};
        memcpy((char *)list + i * sizeof small, &small, sizeof small);
    }
    return (vec3 *)(void *)list;
}

static void place(gml_building *b)
{
    citygml_reader *r = b->r;
    city_facts     *facts = &r->scene->city;
    double          low[3], high[3];
    size_t          count = r->points_count / 3;
    double(*points)[3] = (double(*)[3])(void *)(count ? r->points : NULL);
    if (count) {
        city_extent(points, count, low, high);
    } else if (r->instances_count) {
        memcpy(low, r->instances[0].at, sizeof low);
        memcpy(high, low, sizeof high);
    } else {
        return;
    }
    city_crs_understand(facts, facts->crs, low, high, &r->latitude_first);
    city_choose_origin(facts, low, high);
    for (size_t i = 0; i < count; i++)
        city_crs_local(facts, r->latitude_first, points[i]);
    for (size_t i = 0; i < r->instances_count; i++)
        city_crs_local(facts, r->latitude_first, r->instances[i].at);
}

static bool same_point(vec3 a, vec3 b)
{
    return !(a.x < b.x || a.x > b.x || a.y < b.y || a.y > b.y || a.z < b.z || a.z > b.z);
}

static bool weld_room(weld_table *w, size_t corners)
{
    size_t slots = 256;
    while (slots < corners * 2)
        slots *= 2;
    if (slots > w->capacity) {
        mem_free(w->slots);
        mem_free(w->round_of);
        w->slots = mem_calloc(slots, sizeof *w->slots);
        w->round_of = mem_calloc(slots, sizeof *w->round_of);
        w->capacity = w->slots && w->round_of ? slots : 0;
        w->round = 0;
    }
    if (++w->round == 0) {
        memset(w->round_of, 0, w->capacity * sizeof *w->round_of);
        w->round = 1;
    }
    return w->capacity > 0;
}

/* The first point of the shape that lies where this one does; UINT32_MAX for one that lies nowhere. */
static uint32_t weld(weld_table *w, const vec3 *points, uint32_t point)
{
    vec3     p = points[point];
    uint32_t bits[3];
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
        return UINT32_MAX;
    p = (vec3){p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; /* −0 is 0 */
    memcpy(bits, &p, sizeof bits);
    uint64_t h = (bits[0] | (uint64_t)bits[1] << 32) * UINT64_C(0xBF58476D1CE4E5B9);
    h = ((h ^ h >> 32) + bits[2]) * UINT64_C(0x94D049BB133111EB);
    size_t mask = w->capacity - 1, slot = (h >> 32) & mask;
    while (w->round_of[slot] == w->round && !same_point(points[w->slots[slot]], p))
        slot = (slot + 1) & mask;
    if (w->round_of[slot] != w->round) {
        w->round_of[slot] = w->round;
        w->slots[slot] = point;
    }
    return w->slots[slot];
}

/* --- shapes --------------------------------------------------------------------------------------------- */

static bool put_places(gml_building *b, const gml_ring *ring, size_t first_corner, int32_t *material)
{
    citygml_reader   *r = b->r;
    const gml_places *p = find_places(r, ring->id);
    city_shape       *s = &b->shape;
    if (!p && !s->uv_count)
        return true;
    if (!mem_grow((void **)&s->uvs, &s->uv_capacity, s->corner_count, sizeof *s->uvs))
        return citygml_no_memory(r);
    memset(s->uvs + s->uv_count, 0, (s->corner_count - s->uv_count) * sizeof *s->uvs);
    s->uv_count = s->corner_count;
    for (size_t i = first_corner; p && i < s->corner_count; i++)
        if (i - first_corner < p->count)
            s->uvs[i] = r->uvs[p->first + (i - first_corner)];
    if (p)
        *material = p->material;
    return true;
}

static bool add_face(gml_building *b, const vec3 *points, uint32_t polygon, uint8_t word)
{
    citygml_reader    *r = b->r;
    const gml_polygon *p = &r->polygons[polygon];
    int32_t            material = p->material;
    for (uint32_t k = polygon ? r->polygons[polygon - 1].ring_end : 0; k < p->ring_end; k++) {
        const gml_ring *ring = &r->rings[k];
        size_t          first = b->shape.corner_count;
        for (uint32_t i = 0; i < ring->count; i++)
            if (!city_shape_corner(&b->shape, weld(&b->weld, points, ring->first + i)))
                return citygml_no_memory(r);
        if (!put_places(b, ring, first, &material) || !city_shape_end_ring(&b->shape))
            return citygml_no_memory(r);
    }
    return city_shape_end_face(&b->shape, material, word, p->inner ? CITY_INNER : 0) || citygml_no_memory(r);
}

/* Solids often repeat, without saying what they are, the surfaces that bound the object. */
static bool repeats(const gml_building *b, size_t slot, int8_t lod)
{
    const citygml_reader *r = b->r;
    size_t                named = 0, plain = 0;
    for (uint32_t i = begin_of(b->groups.starts, slot); i < end_of(r, b->groups.starts, slot, r->polygons_count); i++) {
        const gml_polygon *p = &r->polygons[b->groups.order[i]];
        named += p->lod == lod && p->word != CITY_NO_WORD && !p->in_solid;
        plain += p->lod == lod && p->word == CITY_NO_WORD && p->in_solid;
    }
    return named * 2 >= plain && named > 0;
}

/* All faces of an owner at a level of detail; −1: at all. */
static bool fill_shape(gml_building *b, size_t slot, int8_t lod)
{
    citygml_reader *r = b->r;
    const uint32_t *order = b->groups.order, *borrowed = b->groups.borrowed;
    uint32_t begin = begin_of(b->groups.starts, slot), end = end_of(r, b->groups.starts, slot, r->polygons_count);
    uint32_t borrowed_begin = begin_of(b->groups.borrowed_starts, slot),
             borrowed_end = end_of(r, b->groups.borrowed_starts, slot, r->borrowed_count);
    bool        own_points = slot < r->objects_count, skip_plain = lod >= 0 && repeats(b, slot, lod);
    const vec3 *points = own_points ? b->points : b->template_points;
    size_t      corners = 0;
    for (uint32_t i = begin; i < end; i++)
        corners += corners_of(r, order[i]);
    for (uint32_t i = borrowed_begin; i < borrowed_end; i++)
        corners += corners_of(r, r->borrowed[borrowed[i]].polygon);
    city_shape_clear(&b->shape);
    if (!weld_room(&b->weld, corners))
        return citygml_no_memory(r);
    for (uint32_t i = begin; i < end; i++) {
        const gml_polygon *p = &r->polygons[order[i]];
        if ((lod >= 0 && p->lod != lod) || (skip_plain && p->in_solid && p->word == CITY_NO_WORD))
            continue;
        if (!add_face(b, points, order[i], p->word))
            return false;
    }
    for (uint32_t i = borrowed_begin; i < borrowed_end; i++) {
        const gml_borrowed *f = &r->borrowed[borrowed[i]];
        bool                here = (r->polygons[f->polygon].owner >= 0) == own_points;
        uint8_t             word = f->word == CITY_NO_WORD ? r->polygons[f->polygon].word : f->word;
        if (here && (lod < 0 || f->lod == lod) && !add_face(b, points, f->polygon, word))
            return false;
    }
    return true;
}

/* --- objects -------------------------------------------------------------------------------------------- */

static bool is_building(const char *type)
{
    return strncmp(type, "Building", 8) == 0 || strcmp(type, "OtherConstruction") == 0 || strcmp(type, "Storey") == 0;
}

static void put_instance(gml_building *b, const gml_instance *i)
{
    citygml_reader  *r = b->r;
    gml_object      *o = &r->objects[i->owner];
    const gml_range *range = i->id ? find_range(r, i->id) : NULL;
    int32_t          index = i->template_index;
    if (index == NONE && range && r->polygons[range->first].owner <= -2)
        index = -2 - r->polygons[range->first].owner;
    if (index < 0 || (size_t)index >= r->template_count) {
        r->builder.tally.broken_references++;
        return;
    }
    uint8_t own = city_word_of_class(o->type, strlen(o->type));
    if (!b->template_made[index]) {
        b->template_made[index] = true;
        city_builder_points(&r->builder, b->template_points, r->template_points_count / 3);
        if (fill_shape(b, r->objects_count + (size_t)index, -1))
            r->status = city_make(&r->builder, &b->shape, own, false, &b->templates[index]);
        city_builder_points(&r->builder, b->points, r->points_count / 3);
    }
    mat4 matrix;
    for (int k = 0; k < 16; k++)
        matrix.m[(k % 4) * 4 + k / 4] = i->matrix[k];
    for (int k = 0; k < 3; k++)
        matrix.m[12 + k] += i->at[k];
    if (r->status == LMN_OK)
        r->status = city_attach(&r->builder, o->node, &b->templates[index], &matrix, !o->has_children);
}

static bool put_node(citygml_reader *r, gml_object *o)
{
    char *id = o->id;
    o->id = NULL;
    o->node = city_object(&r->builder, id, o->type, strlen(o->type));
    if (o->node == NONE) {
        r->status = LMN_MEMORY;
        return false;
    }
    for (size_t k = 0; k < o->attribute_count; k++) {
        const attribute *a = &o->attributes[k];
        if (!city_attribute(r->scene, o->node, a->key, a->value))
            return citygml_no_memory(r);
    }
    return true;
}

static void put_object(gml_building *b, size_t index)
{
    citygml_reader *r = b->r;
    gml_object     *o = &r->objects[index];
    if (!put_node(r, o))
        return;
    uint32_t begin = begin_of(b->groups.starts, index), end = end_of(r, b->groups.starts, index, r->polygons_count);
    if (o->lod < 0 || o->lod < o->below_lod) {
        r->builder.tally.no_lod += o->lod < 0 && begin < end;
        r->builder.tally.no_geometry += o->lod < 0 && begin == end;
        r->builder.tally.coarser += o->lod >= 0;
        return;
    }
    b->lods[o->lod]++;
    if (!fill_shape(b, index, o->lod))
        return;
    b->meshes.count = 0;
    if (b->shape.face_count)
        r->status = city_make(&r->builder, &b->shape, city_word_of_class(o->type, strlen(o->type)),
                              is_building(o->type), &b->meshes);
    if (r->status == LMN_OK)
        r->status = city_attach(&r->builder, o->node, &b->meshes, NULL, true);
}

static void put_all(gml_building *b)
{
    citygml_reader *r = b->r;
    city_builder_points(&r->builder, b->points, r->points_count / 3);
    for (size_t i = 0; i < r->objects_count && r->status == LMN_OK; i++) {
        put_object(b, i);
        if (i % 512 == 511 && r->status == LMN_OK)
            r->status = import_progress(r->job, 0.6 + 0.3 * (double)i / (double)r->objects_count, "building", r->error);
    }
    for (size_t i = 0; i < r->instances_count && r->status == LMN_OK; i++) {
        const gml_instance *f = &r->instances[i];
        if (f->owner != NONE && f->lod == r->objects[f->owner].lod)
            put_instance(b, f);
    }
    for (size_t i = 0; i < r->objects_count && r->status == LMN_OK; i++)
        if (r->objects[i].parent != NONE)
            city_link(&r->builder, r->objects[r->objects[i].parent].node, r->objects[i].node);
}

static void tell(gml_building *b)
{
    citygml_reader *r = b->r;
    city_facts     *facts = &r->scene->city;
    for (int i = 0; i < GML_LODS; i++) {
        char name[8];
        snprintf(name, sizeof name, "%d", i);
        if (b->lods[i])
            city_add(facts, CITY_LODS, name, b->lods[i]);
    }
    if (r->interiors)
        city_add(facts, CITY_SKIPPED, "interiors", r->interiors);
    if (r->foreign)
        city_add(facts, CITY_SKIPPED, "external-content", r->foreign);
}

void citygml_build(citygml_reader *r)
{
    gml_building b = {.r = r};
    if (r->ranges_count)
        qsort(r->ranges, r->ranges_count, sizeof *r->ranges, compare_ranges);
    if (r->places_count)
        qsort(r->places, r->places_count, sizeof *r->places, compare_places);
    paint_polygons(r);
    for (size_t i = 0; i < r->references_count && r->status == LMN_OK; i++)
        settle_reference(r, &r->references[i]);
    b.templates = mem_calloc(r->template_count + 1, sizeof *b.templates);
    b.template_made = mem_calloc(r->template_count + 1, sizeof *b.template_made);
    if (!b.templates || !b.template_made)
        citygml_no_memory(r);
    if (r->status == LMN_OK && group(&b)) {
        choose_lods(r);
        place(&b);
        b.points = to_floats(r->points, r->points_count);
        b.template_points = to_floats(r->template_points, r->template_points_count);
        put_all(&b);
        tell(&b);
    }
    for (size_t i = 0; b.templates && i < r->template_count; i++)
        mem_free(b.templates[i].items);
    mem_free(b.templates);
    mem_free(b.template_made);
    mem_free(b.meshes.items);
    city_shape_release(&b.shape);
    mem_free(b.weld.slots);
    mem_free(b.weld.round_of);
    mem_free(b.groups.order);
    mem_free(b.groups.starts);
    mem_free(b.groups.borrowed);
    mem_free(b.groups.borrowed_starts);
}
