/* Halos: lines stop short of visible lines that pass in front of them. Crossings are found in a grid of the visible
 * strokes' segments. A stroke that ends at what hides it touches that line and no more, so its ends are looked for
 * a little beyond. */
#include <math.h>

#include "stroke/ribbon_private.h"

static const float beyond = 1.5f;          /* how far beyond its ends a stroke is looked for crossings, on paper */
static const float depth_fraction = 1e-3f; /* what is nearer than this fraction of all depths is at the same position */
static const float lies_beside = 0.75f;    /* points of lines may lie so far beside them, on paper */
static const float flattest = 0.5f;        /* sine of the angle between two lines below which a gap grows no longer */
static const float crossing = 0.35f;       /* the same below which lines that go on do not cross but run side by side */

typedef struct halo_search {
    const ribbon_job   *job;
    const segment_grid *grid;
    float               depth_gap;
    gap_list           *out;
} halo_search;

/* One segment against one visible one in front of it. */
static void cross(halo_search *h, uint32_t own, const stroke_point *a, const stroke_point *b, bool first, bool last,
                  ribbon_segment front)
{
    const stroke_set   *set = h->job->strokes;
    const stroke_point *c = &set->points[front.point], *d = c + 1;
    float               ux = b->x - a->x, uy = b->y - a->y, vx = d->x - c->x, vy = d->y - c->y;
    float               length = hypotf(ux, uy), across = hypotf(vx, vy), area = ux * vy - uy * vx;
    if (front.stroke == own || !(length > 0) || !(across > 0) || fabsf(area) < 1e-3f * length * across)
        return;
    float t = ((c->x - a->x) * vy - (c->y - a->y) * vx) / area, u = ((c->x - a->x) * uy - (c->y - a->y) * ux) / area;
    float past = beyond, reach = past / length, own_reach = past / across;
    if (t < (first ? -reach : 0) || t > (last ? 1 + reach : 1) || u < -own_reach || u > 1 + own_reach)
        return;
    float fraction = fminf(fmaxf(t, 0), 1), front_fraction = fminf(fmaxf(u, 0), 1);
    float depth = ribbon_depth_between(h->job, a->depth, b->depth, fraction),
          nearer = ribbon_depth_between(h->job, c->depth, d->depth, front_fraction);
    /* Lines that meet on a surface are as deep as each other there but for how far they may lie beside their crossing.
     */
    float slope = fabsf(b->depth - a->depth) / length + fabsf(d->depth - c->depth) / across;
    if (!(nearer < depth - h->depth_gap - lies_beside * slope))
        return;
    float sine = fabsf(area) / (length * across);
    bool  goes_on = !(first && t * length < past) && !(last && (1 - t) * length < past);
    if (goes_on && sine < crossing)
        return;
    float half = (h->job->style->halo + ribbon_width(h->job, &set->strokes[front.stroke]) / 2) / fmaxf(sine, flattest);
    float arc = a->arc + t * (b->arc - a->arc);
    gap_list_add(h->out, own, arc - half, arc + half);
}

static void search_segment(halo_search *h, uint32_t own, uint32_t point)
{
    const stroke_set   *set = h->job->strokes;
    const stroke       *s = &set->strokes[own];
    const stroke_point *a = &set->points[point], *b = a + 1;
    const segment_grid *g = h->grid;
    int                 cells[4];
    bool                first = point == s->first, last = point + 2 == s->first + s->count;
    float               margin = beyond;
    if (!segment_grid_box(g, a, b, margin, cells))
        return;
    for (int row = cells[1]; row <= cells[3]; row++)
        for (int column = cells[0]; column <= cells[2]; column++) {
            size_t cell = (size_t)row * (size_t)g->columns + (size_t)column;
            if (g->starts[cell] == g->starts[cell + 1] || !segment_grid_meets(g, a, b, margin, column, row))
                continue;
            for (uint32_t i = g->starts[cell]; i < g->starts[cell + 1]; i++)
                cross(h, own, a, b, first, last, g->items[i]);
        }
}

void ribbon_find_halos(gap_list *out, const ribbon_job *job, const segment_grid *grid)
{
    halo_search h = {.job = job, .grid = grid, .depth_gap = depth_fraction * grid->depth_range, .out = out};
    if (!(job->style->halo > 0) || !grid->items)
        return;
    for (size_t i = 0; i < job->strokes->stroke_count && !out->failed; i++)
        for (uint32_t k = 0; job->drawn[i] && k + 1 < job->strokes->strokes[i].count; k++)
            search_segment(&h, (uint32_t)i, job->strokes->strokes[i].first + k);
}
