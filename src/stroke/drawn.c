#include "stroke/drawn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Numbers in files are rounded: so far a line may lie off the surface that it is on, fraction of the mesh's diagonal.
 * Half a step of 12 bits, which is what compressed meshes have, is a little more than this for each axis. */
#define ROUNDED 1e-4
/* Where two lines turn by more than this they meet at a corner; by less, they are chords of one curve: cosine. */
#define CURVES_ON 0.7
/* Heights of arcs. */
#define STEPS_ASIDE 2.5

/* --- taking ---------------------------------------------------------------------------------------------- */

static uint32_t low_of(const mesh_line *l)
{
    return l->vertex[0] < l->vertex[1] ? l->vertex[0] : l->vertex[1];
}

static uint32_t high_of(const mesh_line *l)
{
    return l->vertex[0] < l->vertex[1] ? l->vertex[1] : l->vertex[0];
}

/* By their ends, whichever way round; `edge` is the line's number as long as lines are sorted. */
static int compare_lines(const void *a, const void *b)
{
    const mesh_line *p = a, *q = b;
    if (low_of(p) != low_of(q))
        return low_of(p) < low_of(q) ? -1 : 1;
    if (high_of(p) != high_of(q))
        return high_of(p) < high_of(q) ? -1 : 1;
    return p->edge < q->edge ? -1 : p->edge > q->edge;
}

static int compare_numbers(const void *a, const void *b)
{
    const mesh_line *p = a, *q = b;
    return p->edge < q->edge ? -1 : p->edge > q->edge;
}

static void drop_twins(edge_mesh *m)
{
    uint32_t kept = 0;
    qsort(m->lines, m->line_count, sizeof *m->lines, compare_lines);
    for (uint32_t i = 0; i < m->line_count; i++) {
        const mesh_line *l = &m->lines[i], *before = kept ? &m->lines[kept - 1] : NULL;
        if (!before || low_of(before) != low_of(l) || high_of(before) != high_of(l))
            m->lines[kept++] = *l;
    }
    m->line_count = kept;
    qsort(m->lines, m->line_count, sizeof *m->lines, compare_numbers);
}

bool drawn_take(edge_mesh *out, const mesh *m, const uint32_t *ids)
{
    size_t   count = mesh_line_count(m);
    uint32_t base = 0;
    if (count == 0)
        return true;
    out->lines = mem_alloc(count * sizeof *out->lines);
    for (size_t i = 0; out->lines && i < m->primitive_count; base += m->primitives[i++].vertex_count) {
        const primitive *p = &m->primitives[i];
        for (uint32_t k = 0; k < p->line_count; k++) {
            uint32_t a = ids[base + p->lines[2 * k]], b = ids[base + p->lines[2 * k + 1]];
            if (a != b)
                out->lines[out->line_count] = (mesh_line){{a, b}, out->line_count, 0}, out->line_count++;
        }
    }
    if (out->lines)
        drop_twins(out);
    return out->lines != NULL;
}

bool drawn_copy(edge_mesh *out, const edge_mesh *from)
{
    out->lines = from->lines ? mem_copy(from->lines, from->line_count * sizeof *out->lines) : NULL;
    out->line_count = from->line_count;
    return out->lines || !from->lines;
}

/* --- what they run along --------------------------------------------------------------------------------- */

/* Numbers of lines in the order of their ends, to be searched. NULL: out of memory. */
static mesh_line *sort_lines(const edge_mesh *m)
{
    mesh_line *sorted = mem_copy(m->lines, m->line_count * sizeof *sorted);
    for (uint32_t i = 0; sorted && i < m->line_count; i++)
        sorted[i].edge = i;
    if (sorted)
        qsort(sorted, m->line_count, sizeof *sorted, compare_lines);
    return sorted;
}

/* The first line, in that order, whose lower end is no less than this. */
static uint32_t first_from(const mesh_line *sorted, uint32_t count, uint32_t low)
{
    uint32_t begin = 0, end = count;
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if (low_of(&sorted[middle]) < low)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

static bool find_edges(edge_mesh *m)
{
    mesh_line *sorted = sort_lines(m);
    for (uint32_t i = 0; i < m->line_count; i++)
        m->lines[i].edge = EDGE_NO_FACE;
    for (uint32_t i = 0; i < m->edge_count && sorted; i++) {
        const mesh_line e = {{m->edges[i].vertex[0], m->edges[i].vertex[1]}, 0, 0};
        uint32_t        k = first_from(sorted, m->line_count, low_of(&e));
        for (; k < m->line_count && low_of(&sorted[k]) == low_of(&e); k++)
            if (high_of(&sorted[k]) == high_of(&e))
                m->lines[sorted[k].edge].edge = i;
    }
    bool good = sorted != NULL;
    mem_free(sorted);
    return good;
}

/* --- how far off their surface they may lie ---------------------------------------------------------------- */

static void vector_of(const edge_mesh *m, const mesh_line *l, uint32_t from, double out[3])
{
    vec3   p = m->positions[from], q = m->positions[l->vertex[0] == from ? l->vertex[1] : l->vertex[0]];
    double x = (double)q.x - p.x, y = (double)q.y - p.y, z = (double)q.z - p.z;
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

/* Height of an arc over its chord, where the next chord turns by an angle: the surface may be as far away, when it is
 * divided otherwise, and seen from the side its next face may rise a little farther before the line. */
static double bulge(double length, double cosine)
{
    return STEPS_ASIDE * 0.5 * length * tan(0.25 * acos(fmax(-1, fmin(1, cosine))));
}

static void lift_at(edge_mesh *m, uint32_t vertex, mesh_line *a, mesh_line *b)
{
    double p[3], q[3], dot = 0, lengths[2] = {0, 0};
    vector_of(m, a, vertex, p);
    vector_of(m, b, vertex, q);
    for (int k = 0; k < 3; k++) {
        dot -= p[k] * q[k];
        lengths[0] += p[k] * p[k];
        lengths[1] += q[k] * q[k];
    }
    lengths[0] = sqrt(lengths[0]);
    lengths[1] = sqrt(lengths[1]);
    double cosine = lengths[0] > 0 && lengths[1] > 0 ? dot / (lengths[0] * lengths[1]) : -1;
    if (cosine < CURVES_ON)
        return;
    a->lift = fmaxf(a->lift, (float)bulge(lengths[0], cosine));
    b->lift = fmaxf(b->lift, (float)bulge(lengths[1], cosine));
}

/* Vertices where two lines meet. */
static bool lift_curves(edge_mesh *m)
{
    uint32_t(*at)[2] = mem_calloc((size_t)m->vertex_count + 1, sizeof *at); /* lines + 1 */
    uint8_t *count = mem_calloc((size_t)m->vertex_count + 1, 1);
    bool     good = at && count;
    for (uint32_t i = 0; i < m->line_count && good; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t v = m->lines[i].vertex[k];
            if (count[v] < 2)
                at[v][count[v]] = i;
            count[v] = (uint8_t)(count[v] < 3 ? count[v] + 1 : 3);
        }
    for (uint32_t v = 0; v < m->vertex_count && good; v++)
        if (count[v] == 2)
            lift_at(m, v, &m->lines[at[v][0]], &m->lines[at[v][1]]);
    mem_free(at);
    mem_free(count);
    return good;
}

/* --- all --------------------------------------------------------------------------------------------------- */

uint32_t drawn_face_pieces(const edge_mesh *m)
{
    return m->piece_count - (m->line_count > 0);
}

bool drawn_close(edge_mesh *m)
{
    if (m->line_count == 0)
        return true;
    box3 box = box3_empty(), all;
    for (uint32_t i = 0; i < m->line_count; i++)
        for (int k = 0; k < 2; k++)
            box = box3_with_point(box, m->positions[m->lines[i].vertex[k]]);
    all = box;
    for (uint32_t i = 0; i < m->piece_count; i++)
        all = box3_union(all, m->boxes[i]);
    for (uint32_t i = 0; i < m->line_count; i++)
        m->lines[i].lift = (float)(ROUNDED * box3_diagonal(all));
    m->boxes[m->piece_count] = box; /* arrays of pieces have room for one more */
    m->closed[m->piece_count] = m->inward[m->piece_count] = false;
    m->piece_count++;
    return find_edges(m) && lift_curves(m);
}
