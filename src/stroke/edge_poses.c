/* Edges of a mesh in its poses: what stays is kept, the rest is judged side by side. */
#include "stroke/edge_builder.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "stroke/drawn.h"

void edge_topology_destroy(edge_topology **topology)
{
    edge_topology *t = *topology;
    if (!t)
        return;
    edge_mesh_release(&t->mesh);
    mem_free(t->welded);
    mem_free(t->starts);
    mem_free(t->halves);
    mem_free(t->opposite);
    mem_free(t->shading);
    form_knots_destroy(&t->knots);
    mem_free(t);
    *topology = NULL;
}

struct form_knots **edge_topology_knots(edge_topology *t)
{
    return &t->knots;
}

uint64_t edge_topology_revision(const edge_topology *t)
{
    return t->revision;
}

/* Numbers were given in the order of appearance. False when vertices that were one have come apart. */
static bool weld_again(edge_mesh *out, const edge_topology *t, const vec3 *positions)
{
    uint32_t seen = 0;
    double   apart = 2 * t->near; /* a pose may stretch */
    for (size_t i = 0; i < t->vertex_count; i++) {
        uint32_t number = t->welded[i];
        if (number == seen)
            out->positions[seen++] = positions[i];
        vec3 p = out->positions[number];
        if (!(fabs((double)p.x - positions[i].x) <= apart && fabs((double)p.y - positions[i].y) <= apart &&
              fabs((double)p.z - positions[i].z) <= apart))
            return false;
    }
    return true;
}

static void find_normals(size_t begin, size_t end, void *user)
{
    edge_mesh *m = user;
    for (size_t f = begin; f < end; f++)
        m->normals[f] = edge_face_normal(m->positions, m->faces[f]);
}

/* Copies of what no pose changes, and room for the rest. */
static bool copy_topology(edge_mesh *out, const edge_topology *t)
{
    const edge_mesh *from = &t->mesh;
    size_t           faces = from->face_count;
    out->vertex_count = from->vertex_count;
    out->face_count = from->face_count;
    out->piece_count = drawn_face_pieces(from);
    out->positions = mem_alloc((size_t)from->vertex_count * sizeof *out->positions);
    out->normals = mem_alloc(faces * sizeof *out->normals);
    out->faces = mem_copy(from->faces, faces * sizeof *out->faces);
    out->pieces = mem_copy(from->pieces, faces * sizeof *out->pieces);
    out->materials = from->materials ? mem_copy(from->materials, faces * sizeof *out->materials) : NULL;
    out->said = from->said ? mem_copy(from->said, 3 * faces) : NULL;
    out->opposite = mem_copy(t->opposite, 3 * faces * sizeof *out->opposite);
    return out->opposite && out->positions && out->normals && out->faces && out->pieces &&
           (out->materials || !from->materials) && (out->said || !from->said) && drawn_copy(out, from);
}

/* Edges of a range of vertices: of a copy of the mesh, which has no other ones. */
typedef struct edge_range {
    edge_mesh    mesh;
    edge_builder b;
    uint32_t     first, end;
    bool         done;
} edge_range;

/* What is judged of a pose side by side: whoever has nothing to do takes the next one, the longest first. */
enum { JUDGE_NOISE, JUDGE_PIECES, JUDGE_RANGES };

typedef struct pose_judge {
    edge_mesh     *mesh;
    crease_facts   facts;
    crease_measure measured;
    bool           has_measured;
    double        *volumes; /* of the pieces; NULL: memory was gone */
    edge_range     ranges[RANGES];
    uint32_t       range_count;
    atomic_uint    next;
} pose_judge;

static void judge_next(size_t begin, size_t end, void *user)
{
    pose_judge *j = user;
    (void)begin;
    (void)end;
    for (unsigned i; (i = atomic_fetch_add(&j->next, 1)) < JUDGE_RANGES + j->range_count;) {
        edge_range *r = i < JUDGE_RANGES ? NULL : &j->ranges[i - JUDGE_RANGES];
        if (i == JUDGE_NOISE)
            j->has_measured = creases_measure(&j->measured, j->mesh, &j->facts);
        else if (i == JUDGE_PIECES)
            j->volumes = edges_measure_pieces(j->mesh);
        else
            r->done = edges_visit(&r->b, r->first, r->end, edges_take);
    }
}

static uint32_t range_count(const edge_mesh *m)
{
    return m->vertex_count < RANGES_LEAST ? 1 : RANGES;
}

/* The first vertex of a range. */
static uint32_t range_start(const edge_mesh *m, uint32_t range)
{
    return (uint32_t)((uint64_t)m->vertex_count * range / range_count(m));
}

static bool count_edge(edge_builder *b, uint32_t low, const half_edge *group, size_t count)
{
    (void)low;
    (void)group;
    (void)count;
    b->keeps->mesh.all_edges++;
    return true;
}

static void count_ranges(edge_topology *t)
{
    edge_builder b = {.mesh = &t->mesh, .keeps = t, .starts = t->starts, .halves = t->halves};
    t->mesh.all_edges = 0;
    for (uint32_t i = 0; i < range_count(&t->mesh); i++) {
        t->range_edges[i] = t->mesh.all_edges;
        edges_visit(&b, range_start(&t->mesh, i), range_start(&t->mesh, i + 1), count_edge);
    }
}

/* Each range puts its edges where there is room for all that it may have. */
static void open_ranges(pose_judge *j, const edge_builder *b, const edge_topology *t)
{
    j->range_count = range_count(b->mesh);
    for (uint32_t i = 0; i < j->range_count; i++) {
        edge_range *r = &j->ranges[i];
        *r = (edge_range){
            .mesh = *b->mesh, .b = *b, .first = range_start(b->mesh, i), .end = range_start(b->mesh, i + 1)};
        r->b.mesh = &r->mesh;
        r->b.edge_capacity = SIZE_MAX;
        r->mesh.edges += t->range_edges[i];
    }
}

/* Ranges side by side, put one behind the other: as each_edge has them. */
static bool close_ranges(pose_judge *j)
{
    edge_mesh *m = j->mesh;
    bool       done = true;
    for (uint32_t i = 0; i < j->range_count; i++) {
        const edge_mesh *from = &j->ranges[i].mesh;
        memmove(m->edges + m->edge_count, from->edges, from->edge_count * sizeof *m->edges);
        m->edge_count += from->edge_count;
        m->all_edges += from->all_edges;
        m->loose_edges += from->loose_edges;
        done = done && j->ranges[i].done;
    }
    return done;
}

/* Edges, with faces and half-edges that are there. */
static lmn_status judge_again(edge_builder *b, const edge_topology *t, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    pose_judge j = {.mesh = m, .facts = {t->opposite, t->shading, t->mixed, b->angle}};
    m->edges = mem_alloc(((size_t)t->mesh.all_edges + 1) * sizeof *m->edges);
    if (!m->edges)
        return error_memory(error);
    open_ranges(&j, b, t);
    threads_for(j.range_count, 1, judge_next, &j);
    bool good = close_ranges(&j) && j.has_measured && j.volumes && creases_judge(m, &j.facts, &j.measured);
    if (good) {
        memcpy(m->closed, t->mesh.closed, m->piece_count * sizeof *m->closed);
        good = edges_mark_hollow(m, j.volumes);
    }
    mem_free(j.volumes);
    return good && drawn_close(m) ? LMN_OK : error_memory(error);
}

lmn_status edge_topology_create(edge_topology **out, const mesh *m, lmn_error *error)
{
    edge_topology *t = *out = mem_calloc(1, sizeof *t);
    if (!t)
        return error_memory(error);
    edge_builder b = {.mesh = &t->mesh, .keeps = t, .crease = 0, .angle = 1.5};
    t->revision = m->topology;
    lmn_status status = edges_finish(&b, edge_faces_make(&b, m, NULL, error), error);
    mem_free(t->mesh.positions); /* every pose has its own */
    mem_free(t->mesh.normals);
    mem_free(t->mesh.edges);
    t->mesh.positions = t->mesh.normals = NULL;
    t->mesh.edges = NULL;
    if (status == LMN_OK)
        count_ranges(t);
    else
        edge_topology_destroy(out);
    return status;
}

lmn_status edge_mesh_pose(edge_mesh *out, const edge_topology *t, const vec3 *positions, double crease_angle,
                          bool *fits, lmn_error *error)
{
    enum { FACES_PER_THREAD = 16384 };
    memset(out, 0, sizeof *out);
    *fits = !t->has_flat;
    if (!*fits)
        return LMN_OK;
    edge_builder b = {.mesh = out,
                      .starts = t->starts,
                      .halves = t->halves,
                      .crease = (float)cos(crease_angle),
                      .angle = crease_angle};
    lmn_status   status = copy_topology(out, t) ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        *fits = weld_again(out, t, positions);
    if (status == LMN_OK && *fits)
        threads_for(out->face_count, FACES_PER_THREAD, find_normals, out);
    for (uint32_t f = 0; f < out->face_count && status == LMN_OK && *fits; f++)
        *fits = dot(out->normals[f], out->normals[f]) != 0;
    if (status == LMN_OK && *fits)
        status = judge_again(&b, t, error);
    if (status != LMN_OK || !*fits)
        edge_mesh_release(out);
    return status;
}
