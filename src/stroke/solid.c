/* The lines of a solid of set operations; see solid.h. Edges of operands and the lines in which they meet are cut where
 * they meet faces (solid_around.c); what is left of them is welded, and each line is kept once. */
#include "stroke/solid_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "csg_tree/planes.h"
#include "stroke/scene_cut.h"

/* --- welding -------------------------------------------------------------------------------------------- */

typedef struct welder {
    solid_builder *b;
    uint32_t      *cells; /* hash of cell to vertex + 1; 0: empty */
    uint32_t      *next;  /* per vertex: in the same cell, + 1 */
    size_t         mask, next_capacity;
    double         size; /* of a cell */
} welder;

static size_t cell_of(const welder *w, int64_t x, int64_t y, int64_t z)
{
    return line_id(line_id((uint64_t)x, (uint64_t)y), (uint64_t)z) & w->mask;
}

static double3 vertex_at(const welder *w, uint32_t vertex)
{
    vec3 p = w->b->mesh->positions[vertex];
    return (double3){(double)p.x, (double)p.y, (double)p.z};
}

static bool is_near(const welder *w, double3 a, double3 b)
{
    return double3_length(double3_minus(a, b)) <= 2 * w->b->near;
}

/* The vertex that was put here first; NO_VERTEX: none was. */
static uint32_t find_vertex(const welder *w, double3 p)
{
    const double margin = 2 * w->b->near;
    int64_t      low[3] = {(int64_t)floor((p.x - margin) / w->size), (int64_t)floor((p.y - margin) / w->size),
                           (int64_t)floor((p.z - margin) / w->size)},
            high[3] = {(int64_t)floor((p.x + margin) / w->size), (int64_t)floor((p.y + margin) / w->size),
                       (int64_t)floor((p.z + margin) / w->size)};
    uint32_t found = NO_VERTEX;
    for (int64_t x = low[0]; x <= high[0]; x++)
        for (int64_t y = low[1]; y <= high[1]; y++)
            for (int64_t z = low[2]; z <= high[2]; z++)
                for (uint32_t v = w->cells[cell_of(w, x, y, z)]; v; v = w->next[v - 1])
                    if (v - 1 < found && is_near(w, vertex_at(w, v - 1), p))
                        found = v - 1;
    return found;
}

static bool put_vertex(welder *w, uint32_t vertex)
{
    double3 p = vertex_at(w, vertex);
    if (!mem_grow((void **)&w->next, &w->next_capacity, (size_t)vertex + 1, sizeof *w->next))
        return false;
    uint32_t *cell = &w->cells[cell_of(w, (int64_t)floor(p.x / w->size), (int64_t)floor(p.y / w->size),
                                       (int64_t)floor(p.z / w->size))];
    w->next[vertex] = *cell;
    *cell = vertex + 1;
    return true;
}

/* The vertex of a position; `own`: the operand's there, which is the first choice; NO_VERTEX: none. */
static bool weld(welder *w, double3 p, uint32_t own, uint32_t *out)
{
    edge_mesh *m = w->b->mesh;
    *out = find_vertex(w, p);
    if (*out != NO_VERTEX)
        return true;
    *out = own;
    if (own == NO_VERTEX) {
        if (!mem_grow((void **)&m->positions, &w->b->vertex_capacity, (size_t)m->vertex_count + 1,
                      sizeof *m->positions))
            return false;
        *out = m->vertex_count++;
        m->positions[*out] = (vec3){(float)p.x, (float)p.y, (float)p.z};
    }
    return put_vertex(w, *out);
}

static bool open_welder(welder *w, solid_builder *b, size_t positions)
{
    size_t cells = 64;
    while (cells < 2 * positions)
        cells *= 2;
    *w = (welder){.b = b, .mask = cells - 1, .size = 8 * b->near};
    w->cells = mem_calloc(cells, sizeof *w->cells);
    return w->cells != NULL;
}

/* --- edges ---------------------------------------------------------------------------------------------- */

/* Lines that are there already, by their ends. */
typedef struct line_table {
    uint32_t *slots; /* edge + 1; 0: empty */
    size_t    mask;
} line_table;

static bool is_new(line_table *t, const edge_mesh *m, const uint32_t ends[2])
{
    uint32_t low = ends[0] < ends[1] ? ends[0] : ends[1], high = ends[0] < ends[1] ? ends[1] : ends[0];
    size_t   slot = line_id(low, high) & t->mask;
    for (; t->slots[slot]; slot = (slot + 1) & t->mask) {
        const uint32_t *v = m->edges[t->slots[slot] - 1].vertex;
        if ((v[0] == low && v[1] == high) || (v[0] == high && v[1] == low))
            return false;
    }
    t->slots[slot] = m->edge_count + 1;
    return true;
}

/* Operands' own edges come first, as candidates do. */
static lmn_status make_edges(solid_builder *b, const solid_stretches *found, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    welder     w;
    size_t     slots = 64;
    while (slots < 2 * found->count)
        slots *= 2;
    line_table table = {mem_calloc(slots, sizeof *table.slots), slots - 1};
    m->edges = mem_alloc((found->count + 1) * sizeof *m->edges);
    bool good = open_welder(&w, b, 2 * found->count) && table.slots && m->edges;
    for (size_t i = 0; i < found->count && good; i++) {
        const solid_stretch *s = &found->items[i];
        mesh_edge            e = {.face = {s->faces[0], s->faces[1]}, .flags = s->flags, .turn = s->turn};
        good = weld(&w, s->ends[0], s->vertex[0], &e.vertex[0]) && weld(&w, s->ends[1], s->vertex[1], &e.vertex[1]);
        if (good && e.vertex[0] != e.vertex[1] && is_new(&table, m, e.vertex))
            m->edges[m->edge_count++] = e;
    }
    mem_free(w.cells);
    mem_free(w.next);
    mem_free(table.slots);
    return good ? LMN_OK : error_memory(error);
}

/* --- all ------------------------------------------------------------------------------------------------ */

/* Of what can be left of the solid: cutters may be far longer. */
static double extent_of(const solid_form *form)
{
    box3 box = form->root == NONE ? box3_empty() : form->terms[form->root].box;
    return box3_is_empty(box) ? 0 : box3_diagonal(box);
}

static lmn_status find_planes(solid_builder *b, double extent, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    uint32_t  *owners = mem_alloc(((size_t)m->face_count + 1) * sizeof *owners);
    uint16_t  *numbers = NULL;
    csg_plane *planes = NULL;
    size_t     count;
    for (uint32_t f = 0; f < m->face_count && owners; f++)
        owners[f] = b->solid->operands[f] + 1;
    csg_soup soup = {m->positions, (const uint32_t *)m->faces, owners, m->face_count, extent};
    bool     good = owners && csg_find_planes(&soup, &numbers, &planes, &count);
    if (good && m->face_count)
        memcpy(b->solid->planes, numbers, m->face_count * sizeof *numbers);
    mem_free(owners);
    mem_free(numbers);
    mem_free(planes);
    return good ? LMN_OK : error_memory(error);
}

/* All is one piece, and closed: of what is not, nobody knows what is inside. */
static bool close_pieces(edge_mesh *m, const solid_form *form)
{
    m->piece_count = 1;
    m->pieces = mem_calloc((size_t)m->face_count + 1, sizeof *m->pieces);
    m->closed = mem_calloc(2, sizeof *m->closed);
    m->inward = mem_calloc(2, sizeof *m->inward);
    m->boxes = mem_calloc(2, sizeof *m->boxes);
    if (!m->pieces || !m->closed || !m->inward || !m->boxes)
        return false;
    m->closed[0] = true;
    m->boxes[0] = form->terms[form->root].box;
    return true;
}

static lmn_status find_lines(solid_builder *b, const solid_form *form, lmn_error *error)
{
    solid_stretches found = {NULL};
    double          extent = extent_of(form);
    lmn_status      status = find_planes(b, extent, error);
    if (status == LMN_OK)
        status = hierarchy_build(&b->tree, b->boxes, (hierarchy_kin){{NULL}}, b->mesh->face_count, error);
    if (status == LMN_OK)
        status = solid_cross(b, error);
    if (status == LMN_OK)
        status = solid_bound(b, &found, error);
    if (status == LMN_OK)
        status = make_edges(b, &found, error);
    mem_free(found.items);
    return status == LMN_OK && !close_pieces(b->mesh, form) ? error_memory(error) : status;
}

static void ground_destroy(solid_builder **b)
{
    if (!*b)
        return;
    hierarchy_release(&(*b)->tree);
    mem_free((*b)->faces);
    mem_free((*b)->boxes);
    mem_free((*b)->lined);
    mem_free((*b)->parts);
    mem_free((*b)->meets);
    mem_free((*b)->candidates);
    mem_free(*b);
    *b = NULL;
}

/* A cut face a cutter that is left. */
static bool put_caps(solid_builder *b, const int32_t *used, size_t count, const cut *c, const solid_cutter *cutters)
{
    b->mesh->caps = mem_alloc((count + 1) * sizeof *b->mesh->caps);
    b->caps = mem_alloc((count + 1) * sizeof *b->caps);
    for (size_t i = 0; i < count && b->caps && b->mesh->caps; i++) {
        int32_t plane = cutters ? cutters[used[i]].plane : NONE;
        b->caps[i] = plane == NONE ? NONE : (int32_t)b->mesh->cap_count;
        if (plane != NONE)
            b->mesh->caps[b->mesh->cap_count++] = scene_cut_cap(c, plane, 0);
    }
    return b->caps && b->mesh->caps;
}

static lmn_status build(solid_builder *b, const lmn_scene *scene, const solid_form *form, const cut *c,
                        const solid_cutter *cutters, lmn_error *error)
{
    int32_t   *used = mem_alloc((form->operand_count + 1) * sizeof *used);
    size_t     count = used ? solid_form_used(form, used) : 0;
    lmn_status status = used ? LMN_OK : error_memory(error);
    if (status == LMN_OK && !put_caps(b, used, count, c, cutters))
        status = error_memory(error);
    if (status == LMN_OK && count)
        status = solid_load(b, scene, form, used, count, error);
    if (status == LMN_OK && b->mesh->face_count)
        status = find_lines(b, form, error);
    mem_free(used);
    mem_free(b->candidates);
    mem_free(b->caps);
    b->candidates = NULL;
    b->caps = NULL;
    b->mesh = NULL;
    return status;
}

lmn_status edge_mesh_create_solid(edge_mesh *out, const lmn_scene *scene, const solid_form *form, const cut *c,
                                  const solid_cutter *cutters, double crease_angle, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    solid_builder *b = mem_calloc(1, sizeof *b);
    out->solid = mem_calloc(1, sizeof *out->solid);
    lmn_status status = b && out->solid ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        *b = (solid_builder){
            .mesh = out, .solid = out->solid, .near = CSG_COINCIDENT * extent_of(form), .crease = crease_angle};
        out->solid->ground = b;
        status = build(b, scene, form, c, cutters, error);
    } else {
        mem_free(b);
    }
    if (status != LMN_OK)
        edge_mesh_release(out);
    return status;
}

void edge_solid_destroy(edge_solid **s)
{
    if (!*s)
        return;
    ground_destroy(&(*s)->ground);
    csg_program_release(&(*s)->program);
    mem_free((*s)->operands);
    mem_free((*s)->planes);
    mem_free(*s);
    *s = NULL;
}
