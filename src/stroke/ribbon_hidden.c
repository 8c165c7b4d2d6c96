/* Hidden lines are drawn whole or not at all (ISO 128): single dashes that float about say nothing. A *run* is what of
 * a chain is hidden without a visible stretch that could be seen; runs that end at one corner are one *figure*. A
 * figure of fewer than four dashes is left out, and so is a run that ends at no other line, as long as there are any;
 * where most of a body goes, the rest of it goes too. And so is a figure that is mostly crumpled: dashes that are
 * longer than the line is straight show no line. */
#include "stroke/ribbon_hidden.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_features.h"

enum { DASHES_LEAST = 4, ROUNDS_MOST = 12 };
static const float unseen_widths = 1.5f; /* visible stretches shorter than this many widths part no run */
static const float touching = 2;         /* on paper, beyond a line's ink: an end lies on it */
static const float own_apart = 4;     /* of its own stroke an end lies on what is farther along than this, in reaches */
static const float same_place = 0.5f; /* on paper: ends at one corner */
static const float same_depth = 0.02f; /* the same in depth, fraction of the depth of all lines */

static const float corner_cosine = 0.7f;  /* of the least turn that is a corner */
static const float crumpled_least = 0.5f; /* of a figure that is left out for that */
/* Of all hidden lines of a body of which none are drawn then: of noise, or teeth, what is left would be chance. */
static const float crumpled_body = 0.2f;
static const float crumpled_pieces = 32; /* and it is so many dashes and gaps: a few may be short in any body */

/* Of the hidden lines of a wholly hidden body or part so much is drawn, or nothing is, and of one that is seen. */
static const float group_least[2] = {0.7f, 0.4f};

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
    const gap_list   *gaps;     /* sorted: what is left out for other reasons */
    bool             *kept;     /* per stroke: drawn so far */
    uint32_t         *figures;  /* per stroke: another one of its figure, or itself */
    uint32_t         *runs;     /* the same of its run */
    float            *shown;    /* per stroke: length without gaps */
    float            *lengths;  /* of figures */
    float            *trifles;  /* per stroke: of what was left out as too small a figure, so much was shown */
    float            *crumpled; /* per stroke, of it: length in pieces between corners shorter than a dash and a gap */
    float            *creased;  /* the same, of figures */
    bool             *loose;    /* of runs: has an end at nothing */
    hidden_runs       order;    /* all of them, by bodies */
    float            *wanted;   /* per run in that order: length that was to be drawn before any was found wanting */
    stroke_set        twin;     /* all that is drawn as if it were visible: what meets what does not ask for that */
    ribbon_job        all;
    segment_grid      grid;
} hidden_figures;

static uint32_t first_of(uint32_t *sets, uint32_t i)
{
    while (sets[i] != i)
        i = sets[i] = sets[sets[i]];
    return i;
}

static void unite(uint32_t *sets, uint32_t a, uint32_t b)
{
    uint32_t p = first_of(sets, a), q = first_of(sets, b);
    sets[p > q ? p : q] = p > q ? q : p;
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
                    unite(f->figures, own, other);
            }
        }
}

/* What lies where now. */
static bool look_again(hidden_figures *f)
{
    segment_grid_release(&f->grid);
    return segment_grid_build(&f->grid, &f->all);
}

/* The first gap of a stroke; the sorted list's end if it has none. */
static size_t first_gap(const gap_list *gaps, uint32_t index)
{
    size_t low = 0, high = gaps->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (gaps->items[middle].stroke < index)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool is_in_gap(const gap_list *gaps, uint32_t index, float arc)
{
    for (size_t i = first_gap(gaps, index); i < gaps->count && gaps->items[i].stroke == index; i++)
        if (arc >= gaps->items[i].from && arc <= gaps->items[i].to)
            return true;
    return false;
}

/* Is a segment so near to a place of a stroke, and drawn there? */
static bool is_near(const hidden_figures *f, ribbon_segment other, uint32_t own, const stroke_point *p, float reach)
{
    const stroke_set   *set = f->job->strokes;
    const stroke_point *a = &set->points[other.point], *b = a + 1;
    float               x = b->x - a->x, y = b->y - a->y, square = x * x + y * y;
    float               fraction = square > 0 ? ((p->x - a->x) * x + (p->y - a->y) * y) / square : 0;
    fraction = fminf(fmaxf(fraction, 0), 1);
    float arc = a->arc + fraction * (b->arc - a->arc);
    float away = hypotf(p->x - a->x - fraction * x, p->y - a->y - fraction * y);
    if (!(away <= reach + ribbon_width(f->job, &set->strokes[other.stroke]) / 2))
        return false;
    return !(other.stroke == own && fabsf(arc - p->arc) < own_apart * reach) && !is_in_gap(f->gaps, other.stroke, arc);
}

/* Is there nothing else around a place of a stroke? */
static bool is_alone(const hidden_figures *f, uint32_t own, const stroke_point *p, float reach)
{
    int cells[4];
    if (!f->grid.items || !segment_grid_box(&f->grid, p, p, reach + f->job->style->width, cells))
        return false;
    for (int row = cells[1]; row <= cells[3]; row++)
        for (int column = cells[0]; column <= cells[2]; column++) {
            size_t cell = (size_t)row * (size_t)f->grid.columns + (size_t)column;
            for (uint32_t i = f->grid.starts[cell]; i < f->grid.starts[cell + 1]; i++)
                if (is_near(f, f->grid.items[i], own, p, reach))
                    return false;
        }
    return true;
}

/* Where along a stroke is that arc, which lies within it? */
static stroke_point point_at(const stroke_set *set, const stroke *s, float arc)
{
    uint32_t k = s->first;
    while (k + 2 < s->first + s->count && set->points[k + 1].arc < arc)
        k++;
    const stroke_point *a = &set->points[k], *b = a + 1;
    float               t = b->arc > a->arc ? (arc - a->arc) / (b->arc - a->arc) : 0;
    return (stroke_point){.x = a->x + t * (b->x - a->x), .y = a->y + t * (b->y - a->y), .depth = a->depth, .arc = arc};
}

/* Does a stroke begin, end or break off where nothing else is? What is left out because other lines crowd breaks off
 * next to those. */
static bool is_loose(const hidden_figures *f, uint32_t own)
{
    const stroke_set *set = f->job->strokes;
    const stroke     *s = &set->strokes[own];
    float             crowd = fmaxf(f->job->style->hidden_crowd, touching);
    for (int end = 0; end < 2; end++) {
        const stroke_point *p = end_of(set, own, end);
        if (s->closed && !is_in_gap(f->gaps, own, end_of(set, own, !end)->arc))
            continue;
        if (!is_in_gap(f->gaps, own, p->arc) && is_alone(f, own, p, touching))
            return true;
    }
    for (size_t i = first_gap(f->gaps, own); i < f->gaps->count && f->gaps->items[i].stroke == own; i++)
        for (int k = 0; k < 2; k++) {
            float arc = k ? f->gaps->items[i].to : f->gaps->items[i].from;
            if (!(arc > end_of(set, own, false)->arc && arc < end_of(set, own, true)->arc))
                continue;
            stroke_point p = point_at(set, s, arc);
            if (is_alone(f, own, &p, crowd))
                return true;
        }
    return false;
}

/* How much of a stroke lies in pieces between corners that are shorter than a dash and a gap. What its ends cut off may
 * go on beyond them, unless the run ends there, too. */
static float crumpled_of(const hidden_figures *f, uint32_t index)
{
    const stroke_set *set = f->job->strokes;
    const stroke     *s = &set->strokes[index];
    const float       least = ribbon_dash_length(f->job, s) + f->job->style->hidden_gap;
    bool              cut = !s->closed && neighbour(f->job, index, -1, SIZE_MAX) != SIZE_MAX;
    float             sum = 0, piece = 0, before[2] = {0, 0};
    for (uint32_t k = 0; k + 1 < s->count; k++) {
        const stroke_point *a = &set->points[s->first + k], *b = a + 1;
        const float         x = b->x - a->x, y = b->y - a->y, length = hypotf(x, y);
        if (!(length > 0))
            continue;
        if (x * before[0] + y * before[1] < corner_cosine * length && piece > 0) {
            sum += piece < least && !cut ? piece : 0;
            piece = 0;
            cut = false;
        }
        before[0] = x / length;
        before[1] = y / length;
        piece += length;
    }
    cut = cut || s->closed || neighbour(f->job, index, 1, SIZE_MAX) != SIZE_MAX;
    return sum + (piece < least && !cut ? piece : 0);
}

static void gather(hidden_figures *f)
{
    const stroke_set *set = f->job->strokes;
    for (uint32_t i = 0; i < set->stroke_count; i++) {
        f->figures[i] = f->runs[i] = i;
        f->lengths[i] = f->creased[i] = 0;
        f->loose[i] = false;
    }
    for (uint32_t i = 0; i < set->stroke_count; i++)
        if (f->kept[i] && is_hidden(f->job, i)) {
            size_t next = neighbour(f->job, i, 1, i);
            unite_at(f, i, false);
            unite_at(f, i, true);
            if (f->kept[next]) {
                unite(f->figures, i, (uint32_t)next);
                unite(f->runs, i, (uint32_t)next);
            }
        }
    for (uint32_t i = 0; i < set->stroke_count; i++)
        if (f->kept[i] && is_hidden(f->job, i)) {
            f->lengths[first_of(f->figures, i)] += f->shown[i];
            f->creased[first_of(f->figures, i)] += f->crumpled[i];
            if (is_loose(f, i))
                f->loose[first_of(f->runs, i)] = true;
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
        float          dash = ribbon_dash_length(f->job, &f->job->strokes->strokes[i]);
        float          least = DASHES_LEAST * dash + (DASHES_LEAST - 1) * style->hidden_gap;
        const uint32_t figure = first_of(f->figures, i);
        const bool     small =
            f->lengths[figure] < least * 0.9999f || f->creased[figure] > crumpled_least * f->lengths[figure];
        if (small || f->loose[first_of(f->runs, i)]) {
            f->kept[i] = false;
            f->trifles[i] = small ? f->shown[i] : 0;
            some = true;
        }
    }
    return some;
}

/* Length of what says nothing in a run, however much of the rest is drawn: teeth have much of that. */
static float trifles_of(const hidden_figures *f, const hidden_run *run)
{
    float length = 0;
    for (uint32_t i = 0; i < run->count; i++)
        length += f->trifles[run->first + i];
    return length;
}

/* Length of what is drawn of a run. */
static float drawn_of(const hidden_figures *f, const hidden_run *run)
{
    float length = 0;
    for (uint32_t i = 0; i < run->count; i++)
        length += f->kept[run->first + i] ? f->shown[run->first + i] : 0;
    return length;
}

static bool is_one_group(const hidden_run *a, const hidden_run *b, bool parts)
{
    return parts ? a->part == b->part : a->body == b->body;
}

/* Are hidden runs crumpled, by all their length, whether it is drawn or not? */
static bool is_crumpled(const hidden_figures *f, const hidden_run *runs, size_t count)
{
    const stroke_style *style = f->job->style;
    float               crumpled = 0, length = 0;
    for (size_t k = 0; k < count; k++)
        for (uint32_t n = 0; n < runs[k].count; n++) {
            const uint32_t i = runs[k].first + n;
            crumpled += f->crumpled[i];
            length += is_hidden(f->job, i) ? length_of(f->job->strokes, &f->job->strokes->strokes[i]) : 0;
        }
    return crumpled > crumpled_body * length && crumpled > crumpled_pieces * (style->hidden_dash + style->hidden_gap);
}

/* Takes out bodies, or whole parts, of which most is gone, and bodies that are crumpled; true: there were some. */
static bool sift_groups(hidden_figures *f, bool parts)
{
    const hidden_run *runs = f->order.items;
    bool              some = false;
    for (size_t i = 0, end; i < f->order.count; i = end) {
        float wanted = 0, left = 0;
        bool  seen = false;
        for (end = i; end < f->order.count && is_one_group(&runs[end], &runs[i], parts); end++) {
            wanted += fmaxf(f->wanted[end] - trifles_of(f, &runs[end]), 0);
            left += drawn_of(f, &runs[end]);
            seen = seen || runs[end].seen;
        }
        if (!(left > 0) || (left >= group_least[seen] * wanted && (parts || !is_crumpled(f, &runs[i], end - i))))
            continue;
        some = true;
        for (size_t k = i; k < end; k++)
            for (uint32_t n = 0; n < runs[k].count; n++)
                f->kept[runs[k].first + n] = false;
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
        if (s->count < 2)
            continue;
        float begin = set->points[s->first].arc, end = set->points[s->first + s->count - 1].arc;
        f->shown[gap->stroke] -= fmaxf(fminf(gap->to, end) - fmaxf(gap->from, begin), 0);
    }
}

static bool open_figures(hidden_figures *f, const gap_list *gaps)
{
    f->gaps = gaps;
    const stroke_set *set = f->job->strokes;
    size_t            count = set->stroke_count + 1;
    f->kept = mem_calloc(count, sizeof *f->kept);
    f->figures = mem_calloc(count, sizeof *f->figures);
    f->shown = mem_calloc(count, sizeof *f->shown);
    f->lengths = mem_calloc(count, sizeof *f->lengths);
    f->crumpled = mem_calloc(count, sizeof *f->crumpled);
    f->trifles = mem_calloc(count, sizeof *f->trifles);
    f->creased = mem_calloc(count, sizeof *f->creased);
    f->loose = mem_calloc(count, sizeof *f->loose);
    f->runs = mem_calloc(count, sizeof *f->runs);
    f->wanted = mem_calloc(count, sizeof *f->wanted);
    f->twin = *set;
    f->twin.strokes = mem_calloc(count, sizeof *f->twin.strokes);
    if (!f->kept || !f->figures || !f->shown || !f->lengths || !f->loose || !f->runs || !f->wanted || !f->crumpled ||
        !f->trifles || !f->creased || !f->twin.strokes || !hidden_runs_find(&f->order, f->job))
        return false;
    memcpy(f->twin.strokes, set->strokes, set->stroke_count * sizeof *set->strokes);
    memcpy(f->kept, f->job->drawn, set->stroke_count * sizeof *f->kept);
    for (size_t i = 0; i < set->stroke_count; i++)
        f->twin.strokes[i].hidden_by = 0;
    measure(f, gaps);
    for (uint32_t i = 0; i < set->stroke_count; i++)
        f->crumpled[i] = is_hidden(f->job, i) ? crumpled_of(f, i) : 0;
    for (size_t i = 0; i < gaps->count; i++)
        if (isinf(gaps->items[i].from) && isinf(gaps->items[i].to))
            f->kept[gaps->items[i].stroke] = false;
    for (size_t i = 0; i < f->order.count; i++)
        f->wanted[i] = drawn_of(f, &f->order.items[i]);
    f->all = *f->job;
    f->all.strokes = &f->twin;
    f->all.drawn = f->kept;
    f->all.meetings = NULL;
    return true;
}

static void close_figures(hidden_figures *f)
{
    segment_grid_release(&f->grid);
    mem_free(f->twin.strokes);
    mem_free(f->kept);
    mem_free(f->figures);
    mem_free(f->shown);
    mem_free(f->lengths);
    mem_free(f->crumpled);
    mem_free(f->trifles);
    mem_free(f->creased);
    mem_free(f->loose);
    mem_free(f->runs);
    mem_free(f->wanted);
    mem_free(f->order.items);
}

float ribbons_figure(const stroke_style *style)
{
    const bool dashed = style->hidden == HIDDEN_DASHED && style->hidden_dash > 0;
    return dashed ? DASHES_LEAST * style->hidden_dash + (DASHES_LEAST - 1) * style->hidden_gap : 0;
}

void ribbon_find_loose(gap_list *out, const ribbon_job *job)
{
    hidden_figures f = {.job = job};
    if (job->style->hidden != HIDDEN_DASHED || !(job->style->hidden_dash > 0) || out->failed)
        return;
    gap_list_sort(out);
    bool good = open_figures(&f, out), some = true;
    for (int round = 0; round < ROUNDS_MOST && good && some; round++) {
        good = look_again(&f);
        if (good) {
            gather(&f);
            some = sift(&f) || sift_groups(&f, false) || sift_groups(&f, true);
        }
    }
    for (size_t i = 0; i < job->strokes->stroke_count && good; i++)
        if (is_hidden(job, i) && !f.kept[i])
            gap_list_add(out, (uint32_t)i, -INFINITY, INFINITY);
    out->failed = out->failed || !good;
    close_figures(&f);
}
