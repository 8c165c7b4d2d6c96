/* Triangles that were divided and of which nothing is gone become again what they were. Outlines are filled with all
 * that a plane meets, but a half section takes away on one side alone: on the other one, dividing moves points by what
 * they are rounded to, so that walls that are seen exactly from the edge lean to either side. Where a neighbour stays
 * divided, a triangle keeps the corners on the edge between them. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut_private.h"

typedef enum triangle_state { TRIANGLE_STAYS, TRIANGLE_LOSES, TRIANGLE_MENDED } triangle_state;

typedef struct mender {
    cut_job *job;
    size_t  *first;  /* of each primitive's triangles */
    uint8_t *states; /* of triangles: triangle_state */
} mender;

static uint8_t *state_of(const mender *m, const cut_piece *p)
{
    return &m->states[m->first[p->primitive] + p->triangle];
}

static bool begin(mender *m)
{
    size_t count = 0, primitives = m->job->out->surface_count;
    m->first = mem_alloc((primitives + 1) * sizeof *m->first);
    for (size_t i = 0; i < primitives && m->first; i++) {
        m->first[i] = count;
        count += m->job->inputs[i].index_count / 3;
    }
    m->states = m->first ? mem_calloc(count + 1, sizeof *m->states) : NULL;
    return m->states != NULL;
}

/* Edges of what loses a piece keep the corners that they were given. */
static void keep_divided(const mender *m, size_t originals)
{
    cut_job *j = m->job;
    for (size_t i = 0; i < originals; i++) {
        const cut_piece *p = &j->pieces[i];
        for (uint32_t k = 0; k < 3 && !p->count && *state_of(m, p) == TRIANGLE_LOSES; k++) {
            cut_edge *e = job_find_edge(j, j->points[p->first + k].vertex, j->points[p->first + (k + 1) % 3].vertex);
            if (e)
                e->kept = true;
        }
    }
}

typedef struct corner_list {
    cut_point points[CUT_POLYGON_MAX];
    uint32_t  count;
} corner_list;

static double apart(const cut_job *j, uint32_t a, uint32_t b)
{
    const double *p = j->vertices[a].world, *q = j->vertices[b].world;
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

/* Corners between two on an edge of the triangle, in their order. */
static void put_between(corner_list *out, cut_job *j, const cut_point *a, const cut_point *b, uint32_t from,
                        uint32_t to)
{
    const cut_edge *e = job_find_edge(j, from, to);
    if (!e || out->count >= CUT_POLYGON_MAX)
        return;
    put_between(out, j, a, b, from, e->vertex);
    double whole = apart(j, a->vertex, b->vertex), t = whole > 0 ? apart(j, a->vertex, e->vertex) / whole : 0;
    if (out->count < CUT_POLYGON_MAX) {
        cut_point *p = &out->points[out->count++];
        p->vertex = e->vertex;
        for (int k = 0; k < 3; k++)
            p->weights[k] = (float)((1 - t) * (double)a->weights[k] + t * (double)b->weights[k]);
    }
    put_between(out, j, a, b, e->vertex, to);
}

static void mend(const mender *m, size_t index)
{
    cut_job    *j = m->job;
    corner_list list = {.count = 0};
    for (uint32_t k = 0; k < 3; k++) {
        const cut_point a = j->points[j->pieces[index].first + k], b = j->points[j->pieces[index].first + (k + 1) % 3];
        const cut_edge *e = job_find_edge(j, a.vertex, b.vertex);
        list.points[list.count++] = a;
        if (e && e->kept)
            put_between(&list, j, &a, &b, a.vertex, b.vertex);
    }
    if (!mem_grow((void **)&j->points, &j->point_capacity, j->point_count + list.count, sizeof *j->points)) {
        j->failed = true;
        return;
    }
    cut_piece *p = &j->pieces[index];
    memcpy(&j->points[j->point_count], list.points, list.count * sizeof *list.points);
    p->first = j->point_count;
    p->count = list.count;
    p->whole = list.count == 3;
    p->kept = true;
    j->point_count += list.count;
}

void job_mend(cut_job *j, size_t originals)
{
    mender m = {.job = j};
    if (j->cut->plane_count < 2)
        return; /* what it divides loses one side */
    j->failed = j->failed || !begin(&m);
    for (size_t i = 0; i < j->surface_pieces && !j->failed; i++)
        if (j->pieces[i].count && !j->pieces[i].kept)
            *state_of(&m, &j->pieces[i]) = TRIANGLE_LOSES;
    if (!j->failed)
        keep_divided(&m, originals);
    for (size_t i = 0; i < originals && !j->failed; i++)
        if (!j->pieces[i].count && *state_of(&m, &j->pieces[i]) == TRIANGLE_STAYS)
            *state_of(&m, &j->pieces[i]) = TRIANGLE_MENDED;
    for (size_t i = 0; i < j->surface_pieces && !j->failed; i++) {
        if (*state_of(&m, &j->pieces[i]) != TRIANGLE_MENDED)
            continue;
        j->pieces[i].count = 0;
        if (i < originals)
            mend(&m, i);
    }
    mem_free(m.first);
    mem_free(m.states);
}
