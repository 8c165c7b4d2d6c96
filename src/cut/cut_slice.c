/* Pieces of triangles divided by planes. Every vertex is on one side of each plane or in it, decided once; an edge
 * is divided once, by one vertex that all its triangles share; nothing else decides what meets what, so closed
 * meshes stay closed however badly numbers round. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut_private.h"

uint32_t job_add_vertex(cut_job *j, const cut_vertex *v)
{
    if (j->failed || j->vertex_count >= UINT32_MAX - 1 ||
        !mem_grow((void **)&j->vertices, &j->vertex_capacity, j->vertex_count + 1, sizeof *j->vertices)) {
        j->failed = true;
        return 0;
    }
    j->vertices[j->vertex_count] = *v;
    return (uint32_t)j->vertex_count++;
}

static double height(const cut_plane *p, const double at[3])
{
    return p->normal[0] * at[0] + p->normal[1] * at[1] + p->normal[2] * at[2] - p->offset;
}

uint32_t job_blend(cut_job *j, const uint32_t *from, const double *weights, int count, int plane)
{
    cut_vertex out = {.shell = j->vertices[from[0]].shell};
    for (int i = 0; i < count; i++) {
        const cut_vertex *v = &j->vertices[from[i]];
        for (int k = 0; k < 3; k++) {
            out.world[k] += weights[i] * v->world[k];
            out.local[k] += weights[i] * v->local[k];
        }
        out.positive |= v->positive;
        out.negative |= v->negative;
    }
    uint32_t unclear = out.positive & out.negative;
    for (int k = 0; k < j->cut->plane_count; k++) {
        uint32_t bit = UINT32_C(1) << k;
        double   h = unclear & bit ? height(&j->cut->planes[k], out.world) : 0;
        if (k == plane || (unclear & bit && !(h > j->cut->snap)))
            out.positive &= ~bit;
        if (k == plane || (unclear & bit && !(h < -j->cut->snap)))
            out.negative &= ~bit;
    }
    return job_add_vertex(j, &out);
}

static size_t edge_slot(const cut_edge *edges, size_t slots, uint64_t key)
{
    uint64_t h = key * UINT64_C(0x9E3779B97F4A7C15);
    size_t   slot = (size_t)(h >> 20) & (slots - 1);
    while (edges[slot].key && edges[slot].key != key)
        slot = (slot + 1) & (slots - 1);
    return slot;
}

static bool grow_edges(cut_job *j)
{
    size_t    slots = j->edge_slots ? j->edge_slots * 2 : 1024;
    cut_edge *bigger = mem_calloc(slots, sizeof *bigger);
    if (!bigger)
        return false;
    for (size_t i = 0; i < j->edge_slots; i++)
        if (j->edges[i].key)
            bigger[edge_slot(bigger, slots, j->edges[i].key)] = j->edges[i];
    mem_free(j->edges);
    j->edges = bigger;
    j->edge_slots = slots;
    return true;
}

static uint64_t key_of(uint32_t a, uint32_t b)
{
    return (uint64_t)(a < b ? a : b) << 32 | (a < b ? b : a);
}

cut_edge *job_find_edge(const cut_job *j, uint32_t a, uint32_t b)
{
    cut_edge *e = j->edge_slots ? &j->edges[edge_slot(j->edges, j->edge_slots, key_of(a, b))] : NULL;
    return e && e->key ? e : NULL;
}

/* The vertex where the edge goes through the plane, and its fraction of the way from a to b. */
static uint32_t divide_edge(cut_job *j, uint32_t a, uint32_t b, int plane, double *fraction)
{
    uint32_t ends[2] = {a < b ? a : b, a < b ? b : a};
    double   low = height(&j->cut->planes[plane], j->vertices[ends[0]].world);
    double   high = height(&j->cut->planes[plane], j->vertices[ends[1]].world);
    double   t = low / (low - high);
    if (!(t > 0 && t < 1)) /* the sides were inherited and rounding says something else */
        t = low == 0 || fabs(low) < fabs(high) ? 0 : 1;
    *fraction = a < b ? t : 1 - t;
    if (j->edge_count * 2 >= j->edge_slots && !grow_edges(j)) {
        j->failed = true;
        return 0;
    }
    uint64_t  key = key_of(a, b);
    cut_edge *e = &j->edges[edge_slot(j->edges, j->edge_slots, key)];
    if (!e->key) {
        e->vertex = job_blend(j, ends, (double[]){1 - t, t}, 2, plane);
        e->key = key;
        j->edge_count++;
    }
    return e->vertex;
}

cut_piece *job_add_piece(cut_job *j, const cut_point *points, uint32_t count, uint32_t primitive, uint32_t triangle)
{
    if (j->failed || !mem_grow((void **)&j->pieces, &j->piece_capacity, j->piece_count + 1, sizeof *j->pieces) ||
        !mem_grow((void **)&j->points, &j->point_capacity, j->point_count + count, sizeof *j->points)) {
        j->failed = true;
        return NULL;
    }
    cut_piece *p = &j->pieces[j->piece_count++];
    *p = (cut_piece){.first = j->point_count, .count = count, .primitive = primitive, .triangle = triangle, .cap = -1};
    memcpy(&j->points[j->point_count], points, count * sizeof *points);
    j->point_count += count;
    for (uint32_t i = 0; i < count; i++) {
        p->positive |= j->vertices[points[i].vertex].positive;
        p->negative |= j->vertices[points[i].vertex].negative;
    }
    return p;
}

typedef struct polygon {
    cut_point points[CUT_POLYGON_MAX];
    uint32_t  count;
} polygon;

static void add_point(polygon *p, cut_point point)
{
    if (p->count < CUT_POLYGON_MAX)
        p->points[p->count++] = point;
}

static void divide_piece(cut_job *j, size_t index, int plane)
{
    cut_piece piece = j->pieces[index];
    uint32_t  bit = UINT32_C(1) << plane;
    polygon   above = {.count = 0}, below = {.count = 0};
    for (uint32_t i = 0; i < piece.count && !j->failed; i++) {
        cut_point         a = j->points[piece.first + i], b = j->points[piece.first + (i + 1) % piece.count];
        const cut_vertex *va = &j->vertices[a.vertex], *vb = &j->vertices[b.vertex];
        bool              crosses = (va->positive & vb->negative & bit) || (va->negative & vb->positive & bit);
        if (!(va->negative & bit))
            add_point(&above, a);
        if (!(va->positive & bit))
            add_point(&below, a);
        if (!crosses)
            continue;
        double    fraction;
        cut_point middle = {.vertex = divide_edge(j, a.vertex, b.vertex, plane, &fraction)};
        for (int k = 0; k < 3; k++)
            middle.weights[k] = (float)((1 - fraction) * (double)a.weights[k] + fraction * (double)b.weights[k]);
        add_point(&above, middle);
        add_point(&below, middle);
    }
    if (above.count >= 3)
        job_add_piece(j, above.points, above.count, piece.primitive, piece.triangle);
    if (below.count >= 3)
        job_add_piece(j, below.points, below.count, piece.primitive, piece.triangle);
    j->pieces[index].count = 0;
}

void job_slice(cut_job *j, size_t first, int plane)
{
    uint32_t bit = UINT32_C(1) << plane;
    size_t   end = j->piece_count;
    for (size_t i = first; i < end && !j->failed; i++)
        if (j->pieces[i].count && j->pieces[i].positive & j->pieces[i].negative & bit)
            divide_piece(j, i, plane);
}

bool cut_is_inside(const cut *c, uint32_t positive, uint32_t negative)
{
    for (int i = 0; i < c->cell_count; i++) {
        const cut_cell *cell = &c->cells[i];
        bool            inside = true;
        for (int k = 0; k < cell->count && inside; k++)
            inside = (cell->faces[k].positive ? positive : negative) >> cell->faces[k].plane & 1;
        if (inside)
            return true;
    }
    return false;
}

static double corner_area(const cut_job *j, const cut_piece *p, uint32_t a, uint32_t b, uint32_t c)
{
    const double  *at[3];
    const uint32_t corners[3] = {a % p->count, b % p->count, c % p->count};
    for (int i = 0; i < 3; i++)
        at[i] = j->vertices[j->points[p->first + corners[i]].vertex].world;
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = at[1][k] - at[0][k];
        v[k] = at[2][k] - at[0][k];
    }
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return x * x + y * y + z * z;
}

uint32_t job_fan_start(const cut_job *j, const cut_piece *p)
{
    uint32_t best = 0;
    double   best_least = -1;
    /* Each corner of the usual few; of many corners some, as trying is quadratic. */
    for (uint32_t s = 0; s < p->count && p->count > 3; s += 1 + p->count / 32) {
        double least = INFINITY;
        for (uint32_t i = 1; i + 1 < p->count; i++)
            least = fmin(least, corner_area(j, p, s, s + i, s + i + 1));
        if (least > best_least) {
            best = s;
            best_least = least;
        }
    }
    return best;
}
