/* Cut faces of different planes are filled one by one, so along the line in which they meet each has corners that
 * the other has not, and a gap of a pixel could shine through. Here each gets all corners that any has. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut_private.h"

/* A corner on a line of two planes. */
typedef struct bead {
    int32_t  line; /* 32 · lower plane + higher plane */
    uint32_t vertex;
    double   along;
} bead;

static int compare_beads(const void *a, const void *b)
{
    const bead *s = a, *t = b;
    if (s->line != t->line)
        return s->line < t->line ? -1 : 1;
    if (s->along != t->along)
        return s->along < t->along ? -1 : 1;
    return (s->vertex > t->vertex) - (s->vertex < t->vertex);
}

static int32_t lowest_bit(uint32_t bits)
{
    int32_t i = 0;
    while (!(bits >> i & 1))
        i++;
    return i;
}

/* The line that both vertices lie on; −1: none. */
static int32_t line_of(const cut_job *j, uint32_t a, uint32_t b)
{
    const cut_vertex *p = &j->vertices[a], *q = &j->vertices[b];
    uint32_t          all = j->cut->plane_count == 32 ? UINT32_MAX : (UINT32_C(1) << j->cut->plane_count) - 1;
    uint32_t          in = all & ~(p->positive | p->negative | q->positive | q->negative);
    if (!(in & (in - 1)))
        return -1;
    return 32 * lowest_bit(in) + lowest_bit(in & (in - 1));
}

static bead bead_of(const cut_job *j, int32_t line, uint32_t vertex)
{
    const double *n = j->cut->planes[line / 32].normal, *m = j->cut->planes[line % 32].normal,
                 *at = j->vertices[vertex].world;
    bead out = {.line = line, .vertex = vertex};
    for (int k = 0; k < 3; k++)
        out.along += (n[(k + 1) % 3] * m[(k + 2) % 3] - n[(k + 2) % 3] * m[(k + 1) % 3]) * (at[k] - j->centre[k]);
    return out;
}

/* Corners on lines, sorted, each once. */
static bead *collect(cut_job *j, size_t *out_count)
{
    bead  *beads = NULL;
    size_t count = 0, capacity = 0, kept = 0;
    for (size_t i = 0; i < j->piece_count && !j->failed; i++) {
        const cut_piece *p = &j->pieces[i];
        for (uint32_t k = 0; k < p->count && p->kept; k++) {
            uint32_t a = j->points[p->first + k].vertex, b = j->points[p->first + (k + 1) % p->count].vertex;
            int32_t  line = line_of(j, a, b);
            if (line < 0)
                continue;
            if (!mem_grow((void **)&beads, &capacity, count + 2, sizeof *beads)) {
                j->failed = true;
                break;
            }
            beads[count++] = bead_of(j, line, a);
            beads[count++] = bead_of(j, line, b);
        }
    }
    if (count)
        qsort(beads, count, sizeof *beads, compare_beads);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || compare_beads(&beads[kept - 1], &beads[i]) != 0)
            beads[kept++] = beads[i];
    *out_count = kept;
    return beads;
}

/* The position of a bead that is in the list. */
static size_t find(const bead *beads, size_t count, const bead *wanted)
{
    size_t low = 0, high = count;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (compare_beads(&beads[middle], wanted) <= 0)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* How many corners stand between two neighbours of a piece; with `out`, they are written there. */
static size_t between(const cut_job *j, const bead *beads, size_t count, cut_point a, cut_point b, cut_point *out)
{
    int32_t line = line_of(j, a.vertex, b.vertex);
    if (line < 0)
        return 0;
    bead   ends[2] = {bead_of(j, line, a.vertex), bead_of(j, line, b.vertex)};
    size_t from = find(beads, count, &ends[0]), to = find(beads, count, &ends[1]);
    size_t found = from < to ? to - from : from - to, written = found ? found - 1 : 0;
    for (size_t i = 0; i < written && out; i++) {
        const bead *at = &beads[from < to ? from + 1 + i : from - 1 - i];
        double      length = ends[1].along - ends[0].along,
               fraction = length != 0 ? (at->along - ends[0].along) / length : 0;
        out[i].vertex = at->vertex;
        for (int k = 0; k < 3; k++)
            out[i].weights[k] = (float)((1 - fraction) * (double)a.weights[k] + fraction * (double)b.weights[k]);
    }
    return written;
}

static void refine(cut_job *j, cut_piece *p, const bead *beads, size_t count)
{
    size_t added = 0;
    for (uint32_t k = 0; k < p->count; k++)
        added += between(j, beads, count, j->points[p->first + k], j->points[p->first + (k + 1) % p->count], NULL);
    if (added == 0)
        return;
    size_t first = j->point_count, at = first;
    if (!mem_grow((void **)&j->points, &j->point_capacity, j->point_count + p->count + added, sizeof *j->points)) {
        j->failed = true;
        return;
    }
    for (uint32_t k = 0; k < p->count; k++) {
        cut_point a = j->points[p->first + k], b = j->points[p->first + (k + 1) % p->count];
        j->points[at++] = a;
        at += between(j, beads, count, a, b, &j->points[at]);
    }
    j->point_count = at;
    p->first = first;
    p->count = (uint32_t)(at - first);
    p->whole = false;
}

void job_stitch(cut_job *j)
{
    if (j->cut->plane_count < 2)
        return;
    size_t count;
    bead  *beads = collect(j, &count);
    for (size_t i = 0; i < j->piece_count && count && !j->failed; i++)
        if (j->pieces[i].count && j->pieces[i].kept)
            refine(j, &j->pieces[i], beads, count);
    mem_free(beads);
}
