/* Hidden lines that would crowd: those behind more surfaces and the shorter ones give way. Lines are taken in the
 * order of their importance, the visible ones first, and leave samples in a grid; from corner to corner, one that is
 * hidden is left out as a whole where much of it lies too near to what is there, so that nothing is left of it that
 * could be taken for something else. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_private.h"

enum { CELLS_MOST = 4096 };
static const float  samples_apart = 0.5f; /* fractions of the distance that is kept */
static const float  own_apart = 4;        /* along a line, from where on it may crowd itself, in distances */
static const float  run_crumb = 2.5f;     /* runs shorter than this say nothing, in distances */
static const float  section_least = 4;    /* nearer to each other corners part nothing, in distances */
static const float  crowded_from = 0.5f;  /* fraction of crowded samples from one corner to the next … */
static const float  mostly_from = 0.6f;   /* … and of a whole run */
static const float  least_apart = 0.5f;   /* on paper */
static const float  longest = 1e6f;       /* of a segment that anybody draws, pixels */
static const size_t samples_most = 50000000;

/* Strokes of a chain that follow each other and are hidden. */
typedef struct hidden_run {
    uint32_t     first, count;  /* strokes */
    float        length, depth; /* the mean of surfaces in front */
    stroke_class kind;
} hidden_run;

typedef struct crowd_sample {
    float    x, y, arc;
    uint32_t chain, stroke, next; /* the next of its cell, + 1 */
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

/* Is there a line too near? The chain's own counts only from some way along it on. */
static bool is_crowded(const crowd_grid *g, const crowd_sample *sample)
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
                a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), next, job->chain_of[index], index, 0};
        }
    }
}

/* --- runs ----------------------------------------------------------------------------------------------- */

static int compare_runs(const void *a, const void *b)
{
    const hidden_run *one = a, *other = b;
    if (one->depth != other->depth)
        return one->depth < other->depth ? -1 : 1;
    if (one->kind != other->kind)
        return one->kind < other->kind ? -1 : 1;
    if (one->length != other->length)
        return one->length > other->length ? -1 : 1;
    return one->first < other->first ? -1 : one->first > other->first;
}

static hidden_run *find_runs(const ribbon_job *job, size_t *count)
{
    const stroke_set *set = job->strokes;
    hidden_run       *runs = mem_calloc(set->stroke_count, sizeof *runs);
    *count = 0;
    for (size_t i = 0; runs && i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        if (s->hidden_by == 0 || !job->drawn[i])
            continue;
        bool goes_on =
            i > 0 && set->strokes[i - 1].hidden_by > 0 && job->drawn[i - 1] && job->chain_of[i] == job->chain_of[i - 1];
        if (!goes_on)
            runs[(*count)++] = (hidden_run){.first = (uint32_t)i, .kind = s->kind};
        hidden_run *run = &runs[*count - 1];
        float       length = s->count ? set->points[s->first + s->count - 1].arc - set->points[s->first].arc : 0;
        length = isfinite(length) ? length : 0;
        run->count++;
        run->depth += length * (float)s->hidden_by;
        run->length += length;
    }
    for (size_t i = 0; runs && i < *count; i++)
        runs[i].depth = runs[i].length > 0 ? roundf(runs[i].depth / runs[i].length) : 0;
    if (runs)
        qsort(runs, *count, sizeof *runs, compare_runs);
    return runs;
}

/* Takes out of a run's strokes what lies between two arcs. */
static void take_out(gap_list *out, const hidden_run *run, float from, float to)
{
    for (uint32_t i = 0; i < run->count; i++)
        gap_list_add(out, run->first + i, from, to);
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

static void judge_section(gap_list *out, crowd_grid *g, const hidden_run *run, const sample_list *list, size_t *sums,
                          run_section s)
{
    size_t waiting = s.first, before = g->count;
    for (size_t i = s.first; i < s.end; i++) {
        bool crowded = is_crowded(g, &list->items[i]);
        sums[i + 1] = sums[i] + crowded;
        /* What lies free is there for the rest of its own chain at once. */
        for (; !crowded && waiting <= i; waiting++)
            if (sums[waiting + 1] == sums[waiting])
                grid_put(g, &list->items[waiting]);
    }
    bool gone = (float)(sums[s.end] - sums[s.first]) >= crowded_from * (float)(s.end - s.first);
    if (gone) {
        take_out(out, run, s.from, s.to);
        grid_take_back(g, before); /* what is not drawn crowds nothing */
    }
    for (size_t i = s.first; i < s.end && !gone; i++)
        if (sums[i + 1] != sums[i])
            grid_put(g, &list->items[i]);
}

/* Of what is nearly all crowded, single edges would be fragments. */
static bool is_mostly_crowded(const crowd_grid *g, const sample_list *list)
{
    size_t crowded = 0;
    for (size_t i = 0; i < list->count; i++)
        crowded += is_crowded(g, &list->items[i]);
    return (float)crowded >= mostly_from * (float)list->count;
}

static void judge_run(gap_list *out, crowd_grid *g, const hidden_run *run, sample_list *list)
{
    list->count = 0;
    if (run->length < run_crumb * g->apart) {
        take_out(out, run, -INFINITY, INFINITY);
        return;
    }
    for (uint32_t i = 0; i < run->count; i++)
        sample_stroke(list, g->job, run->first + i, g->apart * samples_apart);
    if (is_mostly_crowded(g, list)) {
        take_out(out, run, -INFINITY, INFINITY);
        return;
    }
    size_t *sums = mem_calloc(list->count + 1, sizeof *sums);
    g->failed = g->failed || !sums || list->failed;
    size_t corner = 0;
    float  from = -INFINITY;
    for (size_t first = 0; first < list->count && !g->failed;) {
        corner = next_corner(g, run, corner, fmaxf(from, list->items[first].arc));
        run_section s = find_section(g, list, first, corner, from);
        judge_section(out, g, run, list, sums, s);
        first = s.end;
        from = s.to;
    }
    mem_free(sums);
}

void ribbon_find_crowds(gap_list *out, const ribbon_job *job)
{
    crowd_grid  g;
    sample_list list = {0};
    if (!(job->style->hidden_crowd > 0) || job->style->hidden == HIDDEN_NONE || !grid_begin(&g, job))
        return;
    size_t      count;
    hidden_run *runs = find_runs(job, &count);
    for (size_t i = 0; count && i < job->strokes->stroke_count && !list.failed; i++)
        if (job->drawn[i] && job->strokes->strokes[i].hidden_by == 0)
            sample_stroke(&list, job, (uint32_t)i, g.apart * samples_apart);
    for (size_t i = 0; i < list.count && !g.failed; i++)
        grid_put(&g, &list.items[i]);
    for (size_t i = 0; runs && i < count && !g.failed && !list.failed && !out->failed; i++)
        judge_run(out, &g, &runs[i], &list);
    out->failed = out->failed || !runs || g.failed || list.failed;
    mem_free(runs);
    mem_free(list.items);
    mem_free(g.heads);
    mem_free(g.samples);
}
