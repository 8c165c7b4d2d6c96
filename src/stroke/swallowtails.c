/* Swallowtails: where a surface folds over a little, its outline turns back at a cusp, turns once more at a second one,
 * and crosses itself on its way on (Koenderink 1990). Where all of that is hidden no one can read so small a figure
 * from dashes: the line goes on at the crossing, and the two cusps with what lies between them are left out. */
#include <math.h>
#include <string.h>

#include "stroke/stroke_private.h"

/* What a line runs from the crossing back to it, at most. */
#define LOOP (16 * PAPER_UNITS_PER_MM)

typedef struct self_crossing {
    uint32_t point[2];    /* a segment of each stroke begins there */
    double   fraction[2]; /* of that segment */
} self_crossing;

static float arc_at(const stroke_set *set, const self_crossing *c, int side)
{
    const stroke_point *p = &set->points[c->point[side]];
    return p->arc + (float)c->fraction[side] * (p[1].arc - p->arc);
}

static float arc_of_end(const stroke_set *set, const stroke *s)
{
    return set->points[s->first + s->count - 1].arc;
}

static bool is_hidden_outline(const stroke *s)
{
    return s->kind == STROKE_CONTOUR && s->hidden_by > 0 && s->count > 1;
}

/* Do two segments cross within both? */
static bool do_cross(const stroke_point *p, const stroke_point *q, double fraction[2])
{
    const double px = (double)p[1].x - p->x, py = (double)p[1].y - p->y, qx = (double)q[1].x - q->x,
                 qy = (double)q[1].y - q->y, x = (double)q->x - p->x, y = (double)q->y - p->y;
    const double area = px * qy - py * qx;
    if (area == 0)
        return false;
    fraction[0] = (x * qy - y * qx) / area;
    fraction[1] = (x * py - y * px) / area;
    return fraction[0] >= 0 && fraction[0] <= 1 && fraction[1] >= 0 && fraction[1] <= 1;
}

/* Where the end of a stroke is crossed by the begin of a later one of its chain, with no more of the line between. */
static bool find_crossing(const stroke_set *set, const stroke *s, const stroke *t, self_crossing *out)
{
    const float end = arc_of_end(set, s), begin = set->points[t->first].arc;
    for (uint32_t i = s->first + s->count - 1; i-- > s->first && end - set->points[i + 1].arc <= LOOP;)
        for (uint32_t k = t->first; k + 1 < t->first + t->count && set->points[k].arc - begin <= LOOP; k++) {
            *out = (self_crossing){.point = {i, k}};
            if (do_cross(&set->points[i], &set->points[k], out->fraction) &&
                arc_at(set, out, 1) - arc_at(set, out, 0) <= LOOP)
                return true;
        }
    return false;
}

static stroke_point point_at(const stroke_set *set, const self_crossing *c, int side)
{
    const stroke_point *p = &set->points[c->point[side]], *q = p + 1;
    const float         t = (float)c->fraction[side];
    stroke_point        out = *p;
    out.x += t * (q->x - p->x);
    out.y += t * (q->y - p->y);
    out.depth += t * (q->depth - p->depth);
    out.arc += t * (q->arc - p->arc);
    out.weight += t * (q->weight - p->weight);
    out.fine_count = 0;
    return out;
}

/* All of the chain that comes later lies so much nearer to its begin now. */
static void close_up(stroke_set *set, size_t from, float cut, float by)
{
    const uint32_t chain = set->strokes[from].chain;
    for (size_t i = from; i < set->stroke_count && set->strokes[i].chain == chain; i++)
        for (uint32_t k = 0; k < set->strokes[i].count; k++)
            set->points[set->strokes[i].first + k].arc -= by;
    for (size_t i = 0; i < set->mark_count; i++)
        if (set->marks[i].chain == chain && set->marks[i].arc > cut)
            set->marks[i].arc = fmaxf(set->marks[i].arc - by, cut);
    for (size_t i = 0; i < set->stroke_count; i++)
        if (set->strokes[i].chain == chain)
            set->strokes[i].chain_length -= by;
}

/* The first stroke ends at the crossing, the later one begins there, and those between are gone. */
static void cut(stroke_set *set, size_t first, size_t later, const self_crossing *c)
{
    stroke            *s = &set->strokes[first], *t = &set->strokes[later];
    const stroke_point end = point_at(set, c, 0), begin = point_at(set, c, 1);
    const uint32_t     skipped = c->point[1] - t->first;
    s->count = c->point[0] - s->first + 2;
    set->points[c->point[0]].fine_count = 0;
    set->points[c->point[0] + 1] = end;
    t->first += skipped;
    t->count -= skipped;
    set->points[t->first] = begin;
    close_up(set, later, end.arc, begin.arc - end.arc);
    memmove(s + 1, t, (set->stroke_count - later) * sizeof *s);
    set->stroke_count -= later - first - 1;
}

void strokes_cut_swallowtails(stroke_set *set)
{
    for (size_t i = 0; i < set->stroke_count; i++) {
        if (!is_hidden_outline(&set->strokes[i]))
            continue;
        const float end = arc_of_end(set, &set->strokes[i]);
        for (size_t k = i + 1; k < set->stroke_count; k++) {
            const stroke *t = &set->strokes[k];
            self_crossing at;
            if (t->chain != set->strokes[i].chain || !is_hidden_outline(t) || set->points[t->first].arc - end > LOOP)
                break;
            if (k > i + 1 && t->hidden_by == set->strokes[i].hidden_by &&
                find_crossing(set, &set->strokes[i], t, &at)) {
                cut(set, i, k, &at);
                break;
            }
        }
    }
}
