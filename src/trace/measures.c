/* The requirements of speed lines, measured on the ribbons themselves: nothing is asked of what made them but which
 * body each is of. */
#include "trace/trace_private.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* So near to the outline, units, a line begins on it, once it is followed back over the gap. */
#define ON_OUTLINE 2.0
/* Lines of wheels begin beyond the rim by this fraction of the radius at most. */
#define AROUND_MOST 0.25
/* Density is counted over this fraction of the extent. */
#define WINDOW 0.2

static int compare_numbers(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Is what moves met where a line begins, followed straight back? Lines at the extremes pass it at a tangent. Those of
 * wheels run around them, so that the way to their middle is followed instead. */
static bool meets(const trace_job *j, const trace_body *b, const ribbon_point *p, double reach)
{
    double x = (double)p[0].x - (double)p[1].x, y = (double)p[0].y - (double)p[1].y;
    if (b->round) {
        x = b->centre[0] - (double)p->x;
        y = b->centre[1] - (double)p->y;
        reach += AROUND_MOST * b->across[1];
    }
    double length = fmax(hypot(x, y), 1e-9);
    for (double d = 0; d <= reach; d += 0.5)
        for (int aside = -1; aside <= 1; aside++)
            if (page_mask_has(&j->mask, (double)p->x + (d * x - aside * ON_OUTLINE * y) / length,
                              (double)p->y + (d * y + aside * ON_OUTLINE * x) / length))
                return true;
    return false;
}

/* The extremes of what of a body would have lines beside all that moves. False: nothing would. */
static bool find_extremes(const trace_job *j, uint32_t number, double out[2])
{
    const trace_body *b = &j->bodies.bodies[number];
    uint32_t          first = j->heights.first ? j->heights.first[number] : 0,
             count = j->heights.first ? j->heights.first[number + 1] - first : 0;
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        double across = b->across[0] + (b->across[1] - b->across[0]) * i / fmax(count - 1.0, 1);
        if (!j->heights.open[first + i])
            continue;
        out[0] = any ? out[0] : across;
        out[1] = across;
        any = true;
    }
    return any;
}

/* Of one body that moves along: how uneven and how crowded the heights of its lines are. */
static void measure_heights(trace_measures *m, const double extremes[2], double *heights, size_t count)
{
    double mean = 0, square = 0, range = extremes[1] - extremes[0];
    qsort(heights, count, sizeof *heights, compare_numbers);
    m->extent = fmax(m->extent, fmax(fabs(heights[0] - extremes[0]), fabs(heights[count - 1] - extremes[1])));
    for (size_t i = 1; i < count; i++)
        mean += (heights[i] - heights[i - 1]) / (double)(count - 1);
    for (size_t i = 1; i < count; i++)
        square += pow(heights[i] - heights[i - 1] - mean, 2) / (double)(count - 1);
    m->uneven = fmax(m->uneven, mean > 0 ? sqrt(square) / mean : 0);
    for (size_t i = 0; i < count && range > 0; i++) {
        size_t within = 0;
        for (size_t k = i; k < count && heights[k] - heights[i] <= WINDOW * range; k++)
            within++;
        m->crowded = fmax(m->crowded, (double)within / fmax(WINDOW * (double)(count - 1) + 1, 1));
    }
}

/* Is it a speed line, and the piece where it begins? What hides a line may leave several pieces, one after the other.
 */
static bool begins(const trace_job *j, size_t ribbon_number)
{
    const ribbon *r = &j->out->ribbons[ribbon_number];
    return r->kind == STROKE_SPEED && !(r->id & TRACE_FLOW) &&
           !(ribbon_number > 0 && r[-1].kind == r->kind && r[-1].id == r->id);
}

/* The origin of a line; there is one. */
static size_t origin_of(const trace_job *j, const ribbon *r)
{
    size_t i = 0;
    while (i + 1 < j->origins.count &&
           !(j->origins.items[i].body == r->id >> 32 && j->origins.items[i].number == (uint32_t)r->id / TRACE_GROUPS))
        i++;
    return i;
}

/* Heights are those of the positions whose ways lines are: where these bend, they may begin at others. */
static void measure_body(trace_measures *m, const trace_job *j, uint32_t number, double *heights)
{
    const trace_body *b = &j->bodies.bodies[number];
    double            extremes[2];
    size_t            count = 0;
    for (size_t i = 0; i < j->out->ribbon_count && b->motion == MOVES_ALONG; i++) {
        const ribbon *r = &j->out->ribbons[i];
        if (!begins(j, i) || r->id >> 32 != number)
            continue;
        double along;
        body_coordinates(b, j->ways.at[origin_of(j, r) * (j->ways.steps + 1)], &along, &heights[count++]);
    }
    if (count > 2 && find_extremes(j, number, extremes))
        measure_heights(m, extremes, heights, count);
}

/* The length of a line, with what hides it between its pieces, as a fraction of its own way. */
static double length_of(const trace_job *j, size_t first)
{
    const ribbon *r = &j->out->ribbons[first], *last = r;
    while (last + 1 < j->out->ribbons + j->out->ribbon_count && last[1].kind == r->kind && last[1].id == r->id)
        last++;
    double length = (double)(j->out->points[last->first + last->count - 1].arc - j->out->points[r->first].arc);
    double way = way_length(&j->ways, origin_of(j, r));
    return way > 0 ? length / way : 0;
}

lmn_status measures_take(trace_job *j, lmn_error *error)
{
    trace_measures *m = &j->facts->measures;
    size_t          on_outline = 0;
    double         *heights = mem_alloc((j->out->ribbon_count + 1) * sizeof *heights), lengths = 0;
    if (!heights)
        return error_memory(error);
    for (size_t i = 0; i < j->out->ribbon_count; i++) {
        const ribbon *r = &j->out->ribbons[i];
        if (r->kind != STROKE_SPEED || r->id & TRACE_FLOW)
            continue;
        const ribbon_point *p = &j->out->points[r->first];
        for (uint32_t k = 1; k < r->count; k++)
            if (page_mask_has(&j->mask, (double)p[k].x, (double)p[k].y))
                m->inside += (double)(p[k].arc - p[k - 1].arc);
        if (!begins(j, i))
            continue;
        m->lines++;
        on_outline += meets(j, &j->bodies.bodies[r->id >> 32], p, (double)j->o->values->begin + ON_OUTLINE);
        lengths += length_of(j, i);
    }
    for (uint32_t i = 0; i < j->bodies.body_count; i++)
        measure_body(m, j, i, heights);
    m->salient = m->lines ? (double)on_outline / (double)m->lines : 0;
    m->length = m->lines ? lengths / (double)m->lines : 0;
    mem_free(heights);
    return LMN_OK;
}

static double mean_of(double a, size_t of_a, double b, size_t of_b)
{
    return of_a + of_b ? (a * (double)of_a + b * (double)of_b) / (double)(of_a + of_b) : 0;
}

void trace_facts_add(trace_facts *all, const trace_facts *one)
{
    trace_measures       *m = &all->measures;
    const trace_measures *n = &one->measures;
    all->bodies += one->bodies;
    all->towards += one->towards;
    all->jumps += one->jumps;
    all->leaps += one->leaps;
    all->contours += one->contours;
    all->bones_missing = all->bones_missing || one->bones_missing;
    all->lines_missing = all->lines_missing || one->lines_missing;
    all->shaking += one->shaking;
    all->shakes_wanted = all->shakes_wanted || one->shakes_wanted;
    if (one->telling.count)
        all->telling = one->telling;
    m->extent = fmax(m->extent, n->extent);
    m->salient = mean_of(m->salient, m->lines, n->salient, n->lines);
    m->length = mean_of(m->length, m->lines, n->length, n->lines);
    m->uneven = m->lines && n->lines ? fmin(m->uneven, n->uneven) : fmax(m->uneven, n->uneven);
    m->crowded = fmax(m->crowded, n->crowded);
    m->inside += n->inside;
    m->lines += n->lines;
}
