/* The lines of one view: edges that are always drawn, edges where front and back meet, and where pieces run through
 * each other. Freudenberg 2003, section 7.1.3; rows OE-03, OE-05. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/butterfly_mesh.h"

static const char *const class_names[STROKE_CLASS_COUNT] = {"contour",  "border",   "crease",     "intersection",
                                                            "material", "drawn",    "suggestive", "ridge",
                                                            "valley",   "apparent", "speed",      "past"};

const char *stroke_class_name(stroke_class c)
{
    return (unsigned)c < STROKE_CLASS_COUNT ? class_names[c] : "";
}

typedef struct collector {
    view_lines           *out;
    const stroke_view    *v;
    const stroke_options *options;
    const bool           *parts;
    const uint8_t        *hidden;    /* pieces whose lines are not wanted; NULL: none */
    double3              *positions; /* of the ends that only lines have, from v->vertex_count on */
    uint32_t             *slots;     /* hash table of them; NO_VERTEX when empty */
    size_t                position_count, position_capacity, slot_mask;
    uint8_t              *outline; /* per edge of a refined mesh: the silhouette that was propagated runs along it */
} collector;

uint64_t line_id(uint64_t a, uint64_t b)
{
    uint64_t h = a * UINT64_C(0x9E3779B97F4A7C15) + b;
    h = (h ^ h >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    h = (h ^ h >> 27) * UINT64_C(0x94D049BB133111EB);
    return h ^ h >> 31;
}

static bool put_line(view_lines *out, view_line line, window_segment segment)
{
    if (!mem_grow((void **)&out->lines, &out->capacity, out->count + 1, sizeof *out->lines) ||
        !mem_grow((void **)&out->segments, &out->segment_capacity, out->count + 1, sizeof *out->segments))
        return false;
    out->lines[out->count] = line;
    out->segments[out->count++] = segment;
    return true;
}

/* Does the segment touch the page? By its box. */
static bool is_near_page(const stroke_view *v, window_point a, window_point b)
{
    double x = 0.5 * v->camera.width * v->units, y = 0.5 * v->camera.height * v->units;
    return !((a.x < -x && b.x < -x) || (a.x > x && b.x > x) || (a.y < -y && b.y < -y) || (a.y > y && b.y > y));
}

static double3 between(double3 a, double3 b, double fraction)
{
    return (double3){a.x + fraction * (b.x - a.x), a.y + fraction * (b.y - a.y), a.z + fraction * (b.z - a.z)};
}

bool lines_put(view_lines *out, const stroke_view *v, view_line line, double3 a, double3 b, const uint32_t faces[2])
{
    double cut[2];
    if (!view_clip_line(v, a, b, cut))
        return true;
    window_segment s = {.ends = {NO_VERTEX, NO_VERTEX}, .faces = {faces[0], faces[1]}};
    for (int k = 0; k < 2; k++) {
        bool   whole = cut[k] == k; /* nothing is cut off at this end */
        double fraction =
            whole ? k : cut[k] + (k ? -1e-9 : 1e-9); /* a little inside, where rounding cannot put it outside again */
        if (!view_position(v, between(a, b, fraction), k ? &s.b : &s.a))
            return true;
        if (!whole)
            line.ends[k] = out->end_count++;
    }
    return !is_near_page(v, s.a, s.b) || put_line(out, line, s);
}

/* --- edges ---------------------------------------------------------------------------------------------- */

/* What the edge is in this view; STROKE_CLASS_COUNT: no line. */
static stroke_class class_of(const collector *c, size_t mesh, const mesh_edge *e, uint32_t first_face)
{
    const stroke_options *w = c->options;
    if (e->flags & EDGE_BORDER)
        return w->borders ? STROKE_BORDER : STROKE_CLASS_COUNT;
    bool differ = view_is_front(c->v, first_face + e->face[0]) != view_is_front(c->v, first_face + e->face[1]);
    bool turns = differ != ((e->flags & EDGE_TWISTED) != 0);
    bool as_edges = w->contours == CONTOURS_EDGES || (w->contours == CONTOURS_SMOOTH && (e->flags & EDGE_CREASE)) ||
                    (w->contours == CONTOURS_SMOOTH && c->v->scene->meshes[mesh].solid);
    bool asked = (e->flags & EDGE_CREASE) || ((e->flags & EDGE_CANDIDATE) && (w->hidden || !(e->flags & EDGE_HOLLOW)));
    if (turns && as_edges && asked && !has_calm_outline(c->v->scene, mesh))
        return STROKE_CONTOUR;
    if ((e->flags & EDGE_CREASE) && w->creases)
        return STROKE_CREASE;
    if ((e->flags & EDGE_MATERIAL) && w->materials)
        return STROKE_MATERIAL;
    return STROKE_CLASS_COUNT;
}

static bool put_edge(collector *c, uint32_t index, const mesh_edge *e, uint64_t id, stroke_class kind)
{
    const stroke_view *v = c->v;
    const stroke_item *item = &v->scene->items[index];
    const edge_mesh   *m = &v->scene->meshes[item->mesh];
    const view_item   *at = &v->items[index];
    uint32_t           a = at->first_point + e->vertex[0], b = at->first_point + e->vertex[1];
    const uint32_t     faces[2] = {e->face[0] == EDGE_NO_FACE ? EDGE_NO_FACE : at->first_face + e->face[0],
                               e->face[1] == EDGE_NO_FACE ? EDGE_NO_FACE : at->first_face + e->face[1]};
    view_line line = {kind,
                      index,
                      {a, b},
                      id,
                      {1, 1},
                      (e->flags & (EDGE_CREASE | EDGE_BORDER)) != 0,
                      kind == STROKE_CONTOUR && !view_is_front(v, faces[0])};
    if (v->outside[a] & v->outside[b])
        return true;
    uint32_t least = kind == STROKE_CONTOUR && e->flags & EDGE_HOLLOW ? 1 : 0;
    if (v->outside[a] | v->outside[b]) {
        size_t before = c->out->count;
        bool   good = lines_put(c->out, v, line, item_position(item, m->positions[e->vertex[0]]),
                                item_position(item, m->positions[e->vertex[1]]), faces);
        if (c->out->count > before)
            c->out->segments[before].least = least;
        return good;
    }
    window_segment s = {
        .a = v->points[a], .b = v->points[b], .ends = {a, b}, .faces = {faces[0], faces[1]}, .least = least};
    return !is_near_page(v, s.a, s.b) || put_line(c->out, line, s);
}

typedef struct front_test {
    const stroke_view *v;
    const edge_mesh   *mesh;
    uint32_t           item;
} front_test;

/* On the last level as the view has it, so that nothing is found that the view does not show. */
static bool is_front(void *user, uint32_t level, uint32_t face)
{
    const front_test      *t = user;
    const edge_refinement *r = t->mesh->refinement;
    if (level + 1 == r->surface.level_count && r->faces[face] != EDGE_NO_FACE)
        return view_is_front(t->v, t->v->items[t->item].first_face + r->faces[face]);
    const uint32_t    *corners = r->surface.levels[level].faces[face];
    const stroke_item *item = &t->v->scene->items[t->item];
    return view_shows_front(t->v, item_position(item, t->mesh->positions[corners[0]]),
                            item_position(item, t->mesh->positions[corners[1]]),
                            item_position(item, t->mesh->positions[corners[2]]));
}

/* Of a mesh that was refined, outlines are looked for only near those of the coarser one. */
static lmn_status find_outline(collector *c, uint32_t index, lmn_error *error)
{
    const edge_mesh *m = &c->v->scene->meshes[c->v->scene->items[index].mesh];
    mem_free(c->outline);
    c->outline = NULL;
    if (!m->refinement || c->options->contours != CONTOURS_EDGES)
        return LMN_OK;
    c->outline = mem_alloc((size_t)m->edge_count + 1);
    front_test test = {c->v, m, index};
    uint64_t   tested = 0;
    lmn_status status =
        c->outline ? edge_mesh_silhouette(m, is_front, &test, c->outline, &tested, error) : error_memory(error);
    for (uint32_t i = 0; i < m->refinement->surface.level_count; i++)
        c->out->search.faces += m->refinement->surface.levels[i].face_count;
    c->out->search.tested += tested;
    return status;
}

static bool collect_edges(collector *c, uint32_t index)
{
    const stroke_item *item = &c->v->scene->items[index];
    const edge_mesh   *m = &c->v->scene->meshes[item->mesh];
    uint32_t           first_face = c->v->items[index].first_face;
    for (uint32_t i = 0; i < m->edge_count; i++) {
        if (c->hidden && c->hidden[c->v->items[index].first_piece + m->pieces[m->edges[i].face[0]]])
            continue;
        stroke_class kind = class_of(c, item->mesh, &m->edges[i], first_face);
        if (kind == STROKE_CONTOUR && c->outline && !c->outline[i] && !(m->edges[i].flags & EDGE_CREASE))
            continue;
        if (kind != STROKE_CLASS_COUNT &&
            !put_edge(c, index, &m->edges[i], line_id((uint64_t)index << 32 | item->part_index, i), kind))
            return false;
    }
    return true;
}

/* Lines that the file brings, but those along an edge that is a line anyway. Positions are the mesh's own: two lines
 * meet, and meet faces, where their vertices do. */
static bool collect_drawn(collector *c, uint32_t index)
{
    const stroke_item *item = &c->v->scene->items[index];
    const edge_mesh   *m = &c->v->scene->meshes[item->mesh];
    uint32_t           first_face = c->v->items[index].first_face;
    double             grown = mat4_growth(&item->world);
    for (uint32_t i = 0; i < m->line_count && c->options->drawn; i++) {
        const mesh_line *l = &m->lines[i];
        const mesh_edge *along = l->edge == EDGE_NO_FACE ? NULL : &m->edges[l->edge];
        const mesh_edge  e = {{l->vertex[0], l->vertex[1]},
                              {along ? along->face[0] : EDGE_NO_FACE, along ? along->face[1] : EDGE_NO_FACE},
                              0};
        size_t           before = c->out->count;
        if (along && class_of(c, item->mesh, along, first_face) != STROKE_CLASS_COUNT)
            continue;
        if (!put_edge(c, index, &e, line_id((uint64_t)index << 32 | item->part_index, (uint64_t)1 << 32 | i),
                      STROKE_DRAWN))
            return false;
        if (c->out->count > before)
            c->out->segments[before].lift = (float)(l->lift * grown);
    }
    return true;
}

/* --- intersections -------------------------------------------------------------------------------------- */

/* The number of a position; equal positions have one. */
static bool number_position(collector *c, double3 p, uint32_t *out)
{
    uint64_t bits[3];
    memcpy(bits, &p, sizeof bits);
    size_t slot = line_id(line_id(bits[0], bits[1]), bits[2]) & c->slot_mask;
    while (c->slots[slot] != NO_VERTEX) {
        if (memcmp(&c->positions[c->slots[slot]], &p, sizeof p) == 0) {
            *out = c->v->vertex_count + c->slots[slot];
            return true;
        }
        slot = (slot + 1) & c->slot_mask;
    }
    if (!mem_grow((void **)&c->positions, &c->position_capacity, c->position_count + 1, sizeof *c->positions))
        return false;
    c->slots[slot] = (uint32_t)c->position_count;
    *out = c->v->vertex_count + (uint32_t)c->position_count;
    c->positions[c->position_count++] = p;
    return true;
}

static bool make_slots(collector *c, size_t count)
{
    size_t slots = 64;
    while (slots < 4 * count)
        slots *= 2;
    c->slots = mem_alloc(slots * sizeof *c->slots);
    if (c->slots)
        memset(c->slots, 0xFF, slots * sizeof *c->slots);
    c->slot_mask = slots - 1;
    return c->slots != NULL;
}

static bool collect_crossings(collector *c, const crossing_list *crossings)
{
    const stroke_view *v = c->v;
    if (!make_slots(c, crossings->count))
        return false;
    uint32_t(*numbers)[2] = mem_alloc((crossings->count + 1) * sizeof *numbers);
    bool good = numbers != NULL;
    for (size_t i = 0; i < crossings->count && good; i++)
        good = number_position(c, crossings->crossings[i].ends[0], &numbers[i][0]) &&
               number_position(c, crossings->crossings[i].ends[1], &numbers[i][1]);
    c->out->end_count = v->vertex_count + (uint32_t)c->position_count;
    for (size_t i = 0; i < crossings->count && good; i++) {
        const face_crossing *x = &crossings->crossings[i];
        const stroke_item   *item = &v->scene->items[x->items[0]];
        if (c->parts && !c->parts[item->part_index] && !c->parts[v->scene->items[x->items[1]].part_index])
            continue;
        const uint32_t faces[2] = {v->items[x->items[0]].first_face + x->faces[0],
                                   v->items[x->items[1]].first_face + x->faces[1]};
        view_line      line = {STROKE_INTERSECTION,
                               x->items[0],
                               {numbers[i][0], numbers[i][1]},
                               line_id((uint64_t)x->items[0] << 32 | x->faces[0], (uint64_t)x->items[1] << 32 | x->faces[1]),
                               {1, 1},
                               false,
                               false};
        good = numbers[i][0] == numbers[i][1] || lines_put(c->out, v, line, x->ends[0], x->ends[1], faces);
    }
    mem_free(numbers);
    return good;
}

/* --- all ------------------------------------------------------------------------------------------------ */

lmn_status lines_collect(view_lines *out, const stroke_view *v, const stroke_options *options, const bool *parts,
                         const uint8_t *hidden, lmn_progress_fn progress, void *user, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    collector c = {.out = out, .v = v, .options = options, .parts = parts, .hidden = hidden};
    out->end_count = v->vertex_count;
    crossing_list        own = {0};
    const crossing_list *crossings = !options->intersections ? NULL : v->scene->crossings ? v->scene->crossings : &own;
    lmn_status           status =
        crossings == &own ? crossings_find(&own, v->scene, parts, hidden, progress, user, error) : LMN_OK;
    if (status == LMN_OK && crossings && !collect_crossings(&c, crossings))
        status = error_memory(error);
    for (uint32_t i = 0; i < v->scene->item_count && status == LMN_OK; i++) {
        if (parts && !parts[v->scene->items[i].part_index])
            continue;
        status = find_outline(&c, i, error);
        if (status == LMN_OK && !(collect_edges(&c, i) && collect_drawn(&c, i)))
            status = error_memory(error);
    }
    if (status == LMN_OK)
        status = form_collect(out, v, options, parts, progress, user, error);
    if (status == LMN_OK && crossings && !beside_link(out, v, crossings))
        status = error_memory(error);
    crossings_release(&own);
    mem_free(c.outline);
    mem_free(c.positions);
    mem_free(c.slots);
    if (status != LMN_OK)
        lines_release(out);
    return status;
}

void lines_release(view_lines *l)
{
    mem_free(l->lines);
    mem_free(l->segments);
    mem_free(l->ignored);
    mem_free(l->beside);
    mem_free(l->bare);
    mem_free(l->lifts);
    memset(l, 0, sizeof *l);
}
