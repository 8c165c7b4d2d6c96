/* Hidden lines are drawn whole or not at all (ISO 128): single dashes that float about say nothing. A *run* is what of
 * a chain is hidden without a visible stretch that could be seen; runs that end at one corner are one *figure*. A
 * figure of fewer than four dashes is left out. Where it ends at no other line it must be longer, by as much again for
 * each of at most two such ends. Lines of parts that are smooth, with hardly an edge, say little of what is behind:
 * there figures that end at nothing are left out. */
#include "stroke/ribbon_hidden.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

enum { DASHES_LEAST = 4, ENDS_COUNTED = 2, ROUNDS_MOST = 4, NO_RUN = -1 };
static const float unseen_widths = 1.5f; /* visible stretches shorter than this many widths part no run */
static const float same_place = 0.5f;    /* on paper: ends at one corner */
static const float same_depth = 0.02f;   /* the same in depth, fraction of the depth of all lines */
static const float sharp_least = 0.4f;   /* of the length of a part's lines, edges and rims: else it is smooth */

/* --- runs ------------------------------------------------------------------------------------------------ */

static float length_of(const stroke_set *set, const stroke *s)
{
    return s->count > 1 ? set->points[s->first + s->count - 1].arc - set->points[s->first].arc : 0;
}

static bool is_hidden(const ribbon_job *job, size_t i)
{
    return job->strokes->strokes[i].hidden_by > 0 && job->drawn[i];
}

/* The next hidden stroke of the run on this side of a stroke; `none`: it ends here. */
static size_t neighbour(const ribbon_job *job, size_t index, int step, size_t none)
{
    const stroke_set  *set = job->strokes;
    const stroke      *s = &set->strokes[index];
    const chain_facts *chain = &job->chains[job->chain_of[index]];
    float              unseen = unseen_widths * ribbon_width(job, s), passed = 0;
    size_t             i = index;
    while (step > 0 ? i + 1 < (size_t)chain->first + chain->count : i > chain->first) {
        size_t        before = i;
        const stroke *first, *second;
        i = step > 0 ? i + 1 : i - 1;
        first = &set->strokes[step > 0 ? before : i];
        second = &set->strokes[step > 0 ? i : before];
        if (first->count < 2 || second->count < 2)
            return none;
        passed += set->points[second->first].arc - set->points[first->first + first->count - 1].arc;
        if (!(passed <= unseen))
            return none;
        if (set->strokes[i].hidden_by > 0)
            return job->drawn[i] ? i : none;
        passed += length_of(set, &set->strokes[i]);
    }
    return none;
}

span ribbon_hidden_run(const ribbon_job *job, size_t index)
{
    const stroke_set *set = job->strokes;
    size_t            first = index, last = index;
    for (size_t i; (i = neighbour(job, first, -1, SIZE_MAX)) != SIZE_MAX;)
        first = i;
    for (size_t i; (i = neighbour(job, last, 1, SIZE_MAX)) != SIZE_MAX;)
        last = i;
    const stroke *s = &set->strokes[last];
    return (span){set->points[set->strokes[first].first].arc, set->points[s->first + s->count - 1].arc};
}

/* --- figures --------------------------------------------------------------------------------------------- */

typedef struct hidden_figures {
    const ribbon_job *job;
    bool             *kept;    /* per stroke: drawn so far */
    uint32_t         *figures; /* per stroke: another one of its figure, or itself */
    float            *shown;   /* per stroke: length without gaps */
    float            *lengths; /* of figures */
    uint32_t         *loose;   /* of figures: ends at nothing */
    bool             *soft;    /* of figures: of smooth parts alone */
    bool             *smooth;  /* per part id */
    uint32_t          part_count;
    stroke_set        twin; /* all that is drawn as if it were visible: what meets what does not ask for that */
    ribbon_job        all;
    segment_grid      grid;
} hidden_figures;

static uint32_t figure_of(hidden_figures *f, uint32_t i)
{
    while (f->figures[i] != i)
        i = f->figures[i] = f->figures[f->figures[i]];
    return i;
}

static void unite(hidden_figures *f, uint32_t a, uint32_t b)
{
    uint32_t p = figure_of(f, a), q = figure_of(f, b);
    f->figures[p > q ? p : q] = p > q ? q : p;
}

static const stroke_point *end_of(const stroke_set *set, uint32_t index, bool at_end)
{
    const stroke *s = &set->strokes[index];
    return &set->points[s->first + (at_end ? s->count - 1 : 0)];
}

static bool are_one_place(const hidden_figures *f, const stroke_point *p, const stroke_point *q)
{
    return hypotf(p->x - q->x, p->y - q->y) <= same_place &&
           fabsf(p->depth - q->depth) <= same_depth * f->grid.depth_range;
}

/* Joins the figures of all hidden strokes that end where this one does. */
static void unite_at(hidden_figures *f, uint32_t own, bool at_end)
{
    const stroke_point *p = end_of(f->job->strokes, own, at_end);
    int                 cells[4];
    if (!f->grid.items || !segment_grid_box(&f->grid, p, p, same_place, cells))
        return;
    for (int row = cells[1]; row <= cells[3]; row++)
        for (int column = cells[0]; column <= cells[2]; column++) {
            size_t cell = (size_t)row * (size_t)f->grid.columns + (size_t)column;
            for (uint32_t i = f->grid.starts[cell]; i < f->grid.starts[cell + 1]; i++) {
                uint32_t other = f->grid.items[i].stroke;
                if (other != own && f->kept[other] && is_hidden(f->job, other) &&
                    (are_one_place(f, p, end_of(f->job->strokes, other, false)) ||
                     are_one_place(f, p, end_of(f->job->strokes, other, true))))
                    unite(f, own, other);
            }
        }
}

static bool is_sharp(stroke_class kind)
{
    return kind == STROKE_BORDER || kind == STROKE_CREASE || kind == STROKE_INTERSECTION || kind == STROKE_MATERIAL ||
           kind == STROKE_DRAWN;
}

/* Which parts have hardly an edge. */
static bool find_smooth(hidden_figures *f)
{
    const stroke_set *set = f->job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++)
        f->part_count = set->strokes[i].part > f->part_count ? set->strokes[i].part : f->part_count;
    float *sums = mem_calloc(2 * ((size_t)f->part_count + 1), sizeof *sums);
    f->smooth = mem_calloc((size_t)f->part_count + 1, sizeof *f->smooth);
    for (size_t i = 0; i < set->stroke_count && sums; i++)
        sums[2 * set->strokes[i].part + is_sharp(set->strokes[i].kind)] += length_of(set, &set->strokes[i]);
    for (size_t i = 0; i <= f->part_count && sums && f->smooth; i++)
        f->smooth[i] = sums[2 * i + 1] < sharp_least * (sums[2 * i] + sums[2 * i + 1]);
    bool good = sums && f->smooth;
    mem_free(sums);
    return good;
}

/* What strokes meet now. */
static bool look_again(hidden_figures *f)
{
    segment_grid_release(&f->grid);
    mem_free(f->all.meetings);
    f->all.meetings = NULL;
    return segment_grid_build(&f->grid, &f->all) && ribbon_find_meetings(&f->all, &f->grid);
}

/* Does nothing else lie at this end? */
static bool is_loose(const hidden_figures *f, uint32_t i, bool at_end)
{
    return !f->job->strokes->strokes[i].closed && !f->all.meetings[2 * (size_t)i + at_end].meets;
}

static void gather(hidden_figures *f)
{
    const stroke_set *set = f->job->strokes;
    for (uint32_t i = 0; i < set->stroke_count; i++) {
        f->figures[i] = i;
        f->lengths[i] = 0;
        f->loose[i] = 0;
        f->soft[i] = true;
    }
    for (uint32_t i = 0; i < set->stroke_count; i++)
        if (f->kept[i] && is_hidden(f->job, i)) {
            size_t next = neighbour(f->job, i, 1, i);
            unite_at(f, i, false);
            unite_at(f, i, true);
            if (f->kept[next])
                unite(f, i, (uint32_t)next);
        }
    for (uint32_t i = 0; i < set->stroke_count; i++)
        if (f->kept[i] && is_hidden(f->job, i)) {
            const stroke *s = &set->strokes[i];
            uint32_t      figure = figure_of(f, i);
            f->lengths[figure] += f->shown[i];
            f->loose[figure] += (uint32_t)is_loose(f, i, false) + (uint32_t)is_loose(f, i, true);
            f->soft[figure] = f->soft[figure] && f->smooth[s->part];
        }
}

/* Takes out the figures that say nothing; true: there were some. */
static bool sift(hidden_figures *f)
{
    const stroke_style *style = f->job->style;
    bool                some = false;
    for (uint32_t i = 0; i < f->job->strokes->stroke_count; i++) {
        if (!f->kept[i] || !is_hidden(f->job, i))
            continue;
        uint32_t figure = figure_of(f, i), ends = f->loose[figure];
        float    dash = ribbon_dash_length(f->job, &f->job->strokes->strokes[i]);
        float    least = DASHES_LEAST * dash + (DASHES_LEAST - 1) * style->hidden_gap;
        least *= 1 + (float)(ends < ENDS_COUNTED ? ends : ENDS_COUNTED);
        if (f->lengths[figure] < least * 0.9999f || (f->soft[figure] && ends > 0)) {
            f->kept[i] = false;
            some = true;
        }
    }
    return some;
}

/* Lengths of strokes without their gaps. */
static void measure(hidden_figures *f, const gap_list *gaps)
{
    const stroke_set *set = f->job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++)
        f->shown[i] = length_of(set, &set->strokes[i]);
    for (size_t i = 0; i < gaps->count; i++) {
        const stroke_gap *gap = &gaps->items[i];
        const stroke     *s = &set->strokes[gap->stroke];
        if (s->count > 1)
            f->shown[gap->stroke] -= fmaxf(fminf(gap->to, set->points[s->first + s->count - 1].arc) -
                                               fmaxf(gap->from, set->points[s->first].arc),
                                           0);
    }
}

static bool open_figures(hidden_figures *f, const gap_list *gaps)
{
    const stroke_set *set = f->job->strokes;
    size_t            count = set->stroke_count + 1;
    f->kept = mem_calloc(count, sizeof *f->kept);
    f->figures = mem_calloc(count, sizeof *f->figures);
    f->shown = mem_calloc(count, sizeof *f->shown);
    f->lengths = mem_calloc(count, sizeof *f->lengths);
    f->loose = mem_calloc(count, sizeof *f->loose);
    f->soft = mem_calloc(count, sizeof *f->soft);
    f->twin = *set;
    f->twin.strokes = mem_calloc(count, sizeof *f->twin.strokes);
    if (!f->kept || !f->figures || !f->shown || !f->lengths || !f->loose || !f->soft || !f->twin.strokes ||
        !find_smooth(f))
        return false;
    memcpy(f->twin.strokes, set->strokes, set->stroke_count * sizeof *set->strokes);
    memcpy(f->kept, f->job->drawn, set->stroke_count * sizeof *f->kept);
    for (size_t i = 0; i < set->stroke_count; i++)
        f->twin.strokes[i].hidden_by = 0;
    measure(f, gaps);
    for (size_t i = 0; i < gaps->count; i++)
        if (isinf(gaps->items[i].from) && isinf(gaps->items[i].to))
            f->kept[gaps->items[i].stroke] = false;
    f->all = *f->job;
    f->all.strokes = &f->twin;
    f->all.drawn = f->kept;
    f->all.meetings = NULL;
    return true;
}

static void close_figures(hidden_figures *f)
{
    segment_grid_release(&f->grid);
    mem_free(f->all.meetings);
    mem_free(f->twin.strokes);
    mem_free(f->kept);
    mem_free(f->figures);
    mem_free(f->shown);
    mem_free(f->lengths);
    mem_free(f->loose);
    mem_free(f->soft);
    mem_free(f->smooth);
}

void ribbon_find_loose(gap_list *out, const ribbon_job *job)
{
    hidden_figures f = {.job = job};
    if (job->style->hidden != HIDDEN_DASHED || !(job->style->hidden_dash > 0) || out->failed)
        return;
    bool good = open_figures(&f, out), some = true;
    for (int round = 0; round < ROUNDS_MOST && good && some; round++) {
        good = look_again(&f);
        if (good) {
            gather(&f);
            some = sift(&f);
        }
    }
    for (size_t i = 0; i < job->strokes->stroke_count && good; i++)
        if (is_hidden(job, i) && !f.kept[i])
            gap_list_add(out, (uint32_t)i, -INFINITY, INFINITY);
    out->failed = out->failed || !good;
    close_figures(&f);
}
