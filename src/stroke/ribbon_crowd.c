/* Hidden lines that would crowd: those behind more surfaces and the shorter ones give way. The visible lines come first
 * and leave samples in a grid; then one body after the other is tried, the nearest and the largest first, and of each
 * one feature after the other (ribbon_features.h). From corner to corner, a hidden line goes where a visible one stands
 * for it. What is left of a feature is drawn whole, or not at all where much of it lies too near to what is there, and
 * a body of which most would go is left out as a whole: a part of a hidden thing says nothing that a reader could use.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_features.h"

enum { CELLS_MOST = 4096 };
static const float samples_apart = 0.5f; /* fractions of the distance that is kept */
static const float own_apart = 4;        /* along a line, from where on it may crowd itself, in distances */
static const float run_crumb = 2.5f;     /* runs shorter than this say nothing, in distances */
static const float section_least = 4;    /* nearer to each other corners part nothing, in distances */
static const float crowded_from = 0.5f;  /* fraction of crowded samples, of a feature and from corner to corner */
/* Of the hidden lines of a wholly hidden body so much is drawn, of one that is seen, of a small one, such as a bolt,
 * and of a part: of what no visible line stands for. */
static const float  body_from[2] = {0.6f, 0.12f}, small_from = 0.8f, part_from = 0.6f;
static const float  small_body = 208;   /* on paper */
static const float  body_least = 0.08f; /* … and of all of them */
static const float  island_least = 30;  /* on paper: what is smaller and wholly hidden is left out */
static const float  least_apart = 0.5f; /* on paper */
static const float  longest = 1e6f;     /* of a segment that anybody draws, pixels */
static const size_t samples_most = 50000000;

typedef struct crowd_sample {
    float    x, y, arc;
    uint32_t chain, next; /* the next of its cell, + 1 */
    bool     visible;
} crowd_sample;

typedef struct crowd_grid {
    const ribbon_job *job;
    float             apart, cell, left, top;
    int               columns, rows;
    uint32_t         *heads; /* sample + 1 */
    crowd_sample     *samples;
    size_t            count, capacity;
    bool              failed;
} crowd_grid;

static bool grid_begin(crowd_grid *g, const ribbon_job *job)
{
    const stroke_set *set = job->strokes;
    float             low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < set->point_count; i++) {
        const float position[2] = {set->points[i].x, set->points[i].y};
        for (int k = 0; k < 2 && isfinite(position[0]) && isfinite(position[1]); k++) {
            low[k] = fminf(low[k], position[k]);
            high[k] = fmaxf(high[k], position[k]);
        }
    }
    if (!(high[0] >= low[0]))
        return false;
    *g = (crowd_grid){.job = job, .apart = fmaxf(job->style->hidden_crowd, least_apart), .left = low[0], .top = low[1]};
    g->cell = fmaxf(g->apart, fmaxf(high[0] - low[0], high[1] - low[1]) / CELLS_MOST);
    g->columns = (int)((high[0] - low[0]) / g->cell) + 1;
    g->rows = (int)((high[1] - low[1]) / g->cell) + 1;
    g->heads = mem_calloc((size_t)g->columns * (size_t)g->rows, sizeof *g->heads);
    g->failed = !g->heads;
    return g->heads != NULL;
}

static void cell_at(const crowd_grid *g, float x, float y, int out[2])
{
    out[0] = (int)fminf(fmaxf(floorf((x - g->left) / g->cell), 0), (float)(g->columns - 1));
    out[1] = (int)fminf(fmaxf(floorf((y - g->top) / g->cell), 0), (float)(g->rows - 1));
}

static void grid_put(crowd_grid *g, const crowd_sample *sample)
{
    int cell[2];
    cell_at(g, sample->x, sample->y, cell);
    uint32_t *head = &g->heads[(size_t)cell[1] * (size_t)g->columns + (size_t)cell[0]];
    if (g->count >= samples_most || !mem_grow((void **)&g->samples, &g->capacity, g->count + 1, sizeof *g->samples)) {
        g->failed = g->failed || g->count < samples_most;
        return;
    }
    g->samples[g->count] = *sample;
    g->samples[g->count].next = *head;
    *head = (uint32_t)++g->count;
}

/* Takes out the samples that were put in last. */
static void grid_take_back(crowd_grid *g, size_t count)
{
    while (g->count > count) {
        const crowd_sample *sample = &g->samples[--g->count];
        int                 cell[2];
        cell_at(g, sample->x, sample->y, cell);
        g->heads[(size_t)cell[1] * (size_t)g->columns + (size_t)cell[0]] = sample->next;
    }
}

/* Is there a line too near, or a visible one? The chain's own counts only from some way along it on. */
static bool is_crowded(const crowd_grid *g, const crowd_sample *sample, bool by_visible)
{
    int cell[2];
    cell_at(g, sample->x, sample->y, cell);
    for (int row = cell[1] - 1; row <= cell[1] + 1; row++)
        for (int column = cell[0] - 1; column <= cell[0] + 1; column++) {
            if (row < 0 || column < 0 || row >= g->rows || column >= g->columns)
                continue;
            for (uint32_t at = g->heads[(size_t)row * (size_t)g->columns + (size_t)column]; at;
                 at = g->samples[at - 1].next) {
                const crowd_sample *other = &g->samples[at - 1];
                if (by_visible && !other->visible)
                    continue;
                if (other->chain == sample->chain && fabsf(other->arc - sample->arc) < own_apart * g->apart)
                    continue;
                if (hypotf(other->x - sample->x, other->y - sample->y) < g->apart)
                    return true;
            }
        }
    return false;
}

/* --- samples of strokes --------------------------------------------------------------------------------- */

typedef struct sample_list {
    crowd_sample *items;
    size_t        count, capacity;
    bool          failed;
} sample_list;

static void sample_stroke(sample_list *out, const ribbon_job *job, uint32_t index, float step)
{
    const stroke *s = &job->strokes->strokes[index];
    float         next = -INFINITY;
    for (uint32_t k = 0; k + 1 < s->count; k++) {
        const stroke_point *a = &job->strokes->points[s->first + k], *b = a + 1;
        float               length = b->arc - a->arc;
        if (!(length > 0) || !(length < longest) || !isfinite(a->x + a->y + b->x + b->y + length))
            continue;
        if (next < a->arc)
            next = a->arc;
        for (; next <= b->arc; next += step) {
            float t = (next - a->arc) / length;
            if (next + step == next ||
                !mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items)) {
                out->failed = next + step != next;
                return;
            }
            out->items[out->count++] = (crowd_sample){
                a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), next, job->chain_of[index], 0, s->hidden_by == 0};
        }
    }
}

/* --- features -------------------------------------------------------------------------------------------- */

/* What has been tried of a body: length, but for what lies along visible lines; what of it is drawn; and all. */
typedef struct body_tally {
    float open, kept, all;
} body_tally;

/* Takes out of a run's strokes what lies between two arcs. */
static void take_out(gap_list *out, const hidden_run *run, float from, float to)
{
    for (uint32_t i = 0; i < run->count; i++)
        gap_list_add(out, run->first + i, from, to);
}

static void take_out_all(gap_list *out, const hidden_run *runs, size_t count)
{
    for (size_t i = 0; i < count; i++)
        take_out(out, &runs[i], -INFINITY, INFINITY);
}

/* The corner after which the next section begins, as a number of the job's; `from`: where this one does. */
static size_t next_corner(const crowd_grid *g, const hidden_run *run, size_t corner, float from)
{
    const chain_facts *chain = &g->job->chains[g->job->chain_of[run->first]];
    size_t             end = chain->first_corner + chain->corner_count;
    corner = corner < chain->first_corner ? chain->first_corner : corner;
    while (corner < end && g->job->corners[corner] < from + section_least * g->apart)
        corner++;
    return corner < end ? corner : SIZE_MAX;
}

/* Samples of a run from one corner to the next. */
typedef struct run_section {
    size_t first, end;
    float  from, to;
} run_section;

/* The section that begins with this sample, at the arc `from`. */
static run_section find_section(const crowd_grid *g, const sample_list *list, size_t first, size_t corner, float from)
{
    run_section s = {first, list->count, from, corner == SIZE_MAX ? INFINITY : g->job->corners[corner]};
    if (corner != SIZE_MAX)
        for (s.end = first; s.end < list->count && list->items[s.end].arc < s.to; s.end++) {
        }
    if (s.end == list->count)
        s.to = INFINITY;
    return s;
}

static bool runs_along_visible(const crowd_grid *g, const sample_list *list, run_section s)
{
    size_t beside = 0;
    for (size_t i = s.first; i < s.end; i++)
        beside += is_crowded(g, &list->items[i], true);
    return (float)beside >= crowded_from * (float)(s.end - s.first);
}

/* Samples a run and takes out what visible lines stand for. */
static void open_run(gap_list *out, crowd_grid *g, const hidden_run *run, sample_list *list)
{
    size_t before = list->count, corner = 0, left = before;
    float  from = -INFINITY;
    if (run->length < run_crumb * g->apart) {
        take_out(out, run, -INFINITY, INFINITY);
        return;
    }
    for (uint32_t i = 0; i < run->count; i++)
        sample_stroke(list, g->job, run->first + i, g->apart * samples_apart);
    for (size_t first = before; first < list->count && !list->failed;) {
        corner = next_corner(g, run, corner, fmaxf(from, list->items[first].arc));
        run_section s = find_section(g, list, first, corner, from);
        bool        stands = runs_along_visible(g, list, s);
        if (stands)
            take_out(out, run, s.from, s.to);
        for (size_t i = s.first; i < s.end && !stands; i++)
            list->items[left++] = list->items[i];
        first = s.end;
        from = s.to;
    }
    list->count = left;
}

/* Puts the samples of a feature into the grid, unless much of it is crowded, by itself too. */
static bool put_feature(crowd_grid *g, const sample_list *list)
{
    size_t before = g->count, crowded = 0, waiting = 0;
    bool  *near = mem_calloc(list->count + 1, sizeof *near);
    g->failed = g->failed || !near;
    for (size_t i = 0; near && i < list->count; i++) {
        near[i] = is_crowded(g, &list->items[i], false);
        crowded += near[i];
        /* What lies free is there for the rest of its own chain at once. */
        for (; !near[i] && waiting <= i; waiting++)
            if (!near[waiting])
                grid_put(g, &list->items[waiting]);
    }
    bool stays = near && list->count && (float)crowded < crowded_from * (float)list->count;
    for (size_t i = 0; stays && i < list->count; i++)
        if (near[i])
            grid_put(g, &list->items[i]);
    if (!stays)
        grid_take_back(g, before); /* what is not drawn crowds nothing */
    mem_free(near);
    return stays;
}

static void judge_feature(gap_list *out, crowd_grid *g, const hidden_run *runs, size_t count, sample_list *list,
                          body_tally *tally)
{
    float step = g->apart * samples_apart;
    list->count = 0;
    for (size_t i = 0; i < count; i++) {
        open_run(out, g, &runs[i], list);
        tally->all += runs[i].length;
    }
    bool stays = put_feature(g, list);
    tally->open += step * (float)list->count;
    tally->kept += stays ? step * (float)list->count : 0;
    if (!stays)
        take_out_all(out, runs, count);
}

/* Small things that cannot be seen at all are not what a drawing is about, and what is left of others must be most. */
static bool says_something(const hidden_run *run, const body_tally *tally)
{
    float least = run->extent < small_body ? small_from : body_from[run->seen];
    return (run->seen || run->extent >= island_least) && tally->kept >= least * tally->open &&
           tally->kept >= body_least * tally->all;
}

static void add_tally(body_tally *to, const body_tally *by, bool kept)
{
    to->open += by->open;
    to->all += by->all;
    to->kept += kept ? by->kept : 0;
}

static void judge_body(gap_list *out, crowd_grid *g, const hidden_run *runs, size_t count, sample_list *list,
                       body_tally *part)
{
    body_tally tally = {0};
    size_t     before = g->count;
    for (size_t i = 0, end; i < count && !g->failed && !list->failed; i = end) {
        for (end = i + 1; end < count && runs[end].feature == runs[i].feature;)
            end++;
        judge_feature(out, g, runs + i, end - i, list, &tally);
    }
    bool stays = says_something(runs, &tally);
    add_tally(part, &tally, stays);
    if (stays)
        return;
    grid_take_back(g, before);
    take_out_all(out, runs, count);
}

/* What is there many times, such as joists and bolts, is drawn for most of them or for none. A part that is all there
 * is (`alone`), as files of one mesh have it, is no such thing: its bodies stand for themselves. */
static void judge_part(gap_list *out, crowd_grid *g, const hidden_run *runs, size_t count, bool alone,
                       sample_list *list)
{
    body_tally tally = {0};
    size_t     before = g->count;
    for (size_t i = 0, end; i < count && !g->failed && !list->failed; i = end) {
        for (end = i + 1; end < count && runs[end].body == runs[i].body;)
            end++;
        judge_body(out, g, runs + i, end - i, list, &tally);
    }
    if (alone || tally.kept >= part_from * tally.open)
        return;
    grid_take_back(g, before);
    take_out_all(out, runs, count);
}

float ribbons_island(const stroke_style *style)
{
    return style->hidden != HIDDEN_NONE && style->hidden_crowd > 0 ? island_least : 0;
}

void ribbon_find_crowds(gap_list *out, const ribbon_job *job)
{
    crowd_grid  g;
    sample_list list = {0};
    hidden_runs runs = {0};
    if (!(job->style->hidden_crowd > 0) || job->style->hidden == HIDDEN_NONE || !grid_begin(&g, job))
        return;
    g.failed = g.failed || !hidden_runs_find(&runs, job);
    for (size_t i = 0; runs.count && i < job->strokes->stroke_count && !list.failed; i++)
        if (job->drawn[i] && job->strokes->strokes[i].hidden_by == 0)
            sample_stroke(&list, job, (uint32_t)i, g.apart * samples_apart);
    for (size_t i = 0; i < list.count && !g.failed; i++)
        grid_put(&g, &list.items[i]);
    for (size_t i = 0, end; i < runs.count && !g.failed && !list.failed && !out->failed; i = end) {
        for (end = i + 1; end < runs.count && runs.items[end].part == runs.items[i].part;)
            end++;
        judge_part(out, &g, runs.items + i, end - i, end - i == runs.count, &list);
    }
    out->failed = out->failed || g.failed || list.failed;
    mem_free(runs.items);
    mem_free(list.items);
    mem_free(g.heads);
    mem_free(g.samples);
}
