/* How much is drawn. Chains are taken in the order of what they say and laid onto the page; a chain goes, whole, where
 * most of it would run beside lines that are there already, or where there is enough ink. So gear rims, vents and
 * cities do not fuse to black, and what is left is lines, not bits of them. After Grabli, Durand and Sillion 2004
 * (density in four directions, causal: what is drawn already counts).
 *
 *     significance = (1 − e^(−length / 8 mm)) × strength of the kind
 *
 * Small pieces of surface have their outlines alone. All of it on paper, so that every resolution has the same lines.
 */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

#define MM               PAPER_UNITS_PER_MM
#define LONG             (8 * MM)
#define CELL             MM
#define STEP             (0.25 * MM)
#define PARALLEL         0.94 /* cosine of 20° */
#define BESIDE_WIDTHS    2.2
#define BESIDE_LEAST     (0.35 * MM)
#define DENSITY_LEAST    0.12
#define DENSITY_MORE     0.36
#define LIKE_WIDTH       0.9 /* a line does not give way to finer ones */
#define MOST_OF_IT       0.5
#define MOST_OF_OUTLINES 0.9
#define BARE_OUTLINE     MM   /* so much of an outline may go without another line beside it */
#define BARE_LINE        LONG /* … of other lines, in one stretch: it tells what no other line does */
#define OUTERMOST        1.1
#define OUTLINE_ALONE    (4 * MM)
#define INNER_WIDTH      0.7 /* of lines that are no outlines, as techniques have it */
enum { DIRECTIONS = 4, WINDOW = 1 /* cells to each side */, CHAINS_A_CELL = 64 };

static const double strengths[STROKE_CLASS_COUNT] = {
    [STROKE_CONTOUR] = 0.9,  [STROKE_BORDER] = 0.7,    [STROKE_CREASE] = 0.6,      [STROKE_INTERSECTION] = 0.5,
    [STROKE_MATERIAL] = 0.5, [STROKE_DRAWN] = 0.55,    [STROKE_SUGGESTIVE] = 0.35, [STROKE_RIDGE] = 0.35,
    [STROKE_VALLEY] = 0.35,  [STROKE_APPARENT] = 0.35, [STROKE_SPEED] = 0.5,       [STROKE_PAST] = 0.5};

/* Ink that is there, of one line in one cell. */
typedef struct trace {
    float    x, y, along_x, along_y, width;
    uint32_t next; /* of its cell, + 1 */
} trace;

typedef struct sample {
    float x, y, along_x, along_y, length;
} sample;

/* A chain: its strokes follow each other. */
typedef struct chain {
    uint32_t first, count;
    double   significance;
} chain;

typedef struct density {
    stroke_set           *set;
    const stroke_options *options;
    int                   columns, rows;
    float                *all;   /* per cell and direction: length of everything that could be drawn */
    float                *drawn; /* per cell: length × width */
    uint32_t             *heads; /* per cell: a trace + 1 */
    trace                *traces;
    sample               *samples; /* of the chain that is judged */
    size_t                trace_count, trace_capacity, sample_count, sample_capacity;
} density;

static size_t cell_at(const density *d, double x, double y)
{
    int column = (int)(x / CELL), row = (int)(y / CELL);
    column = column < 0 ? 0 : column >= d->columns ? d->columns - 1 : column;
    row = row < 0 ? 0 : row >= d->rows ? d->rows - 1 : row;
    return (size_t)row * (size_t)d->columns + (size_t)column;
}

static int direction_of(float x, float y)
{
    double turn = atan2(y, x) / 3.14159265358979323846 * DIRECTIONS; /* either way round is the same */
    int    number = (int)floor(turn + 0.5);
    return ((number % DIRECTIONS) + DIRECTIONS) % DIRECTIONS;
}

static bool is_outline(const stroke *s)
{
    return s->kind == STROKE_CONTOUR || s->kind == STROKE_BORDER;
}

static double width_of(const density *d, const stroke *s)
{
    return stroke_width_on_piece(s, d->options->width * (is_outline(s) ? 1 : INNER_WIDTH));
}

/* Positions along what is visible of a chain. */
static bool take_samples(density *d, const chain *c)
{
    d->sample_count = 0;
    for (uint32_t i = c->first; i < c->first + c->count; i++) {
        const stroke *s = &d->set->strokes[i];
        for (uint32_t k = 0; k + 1 < s->count && s->hidden_by == 0; k++) {
            const stroke_point *p = &d->set->points[s->first + k], *q = p + 1;
            double              x = (double)q->x - p->x, y = (double)q->y - p->y, length = sqrt(x * x + y * y);
            int                 steps = (int)(length / STEP) + 1;
            if (!(length > 0))
                continue;
            if (!mem_grow((void **)&d->samples, &d->sample_capacity, d->sample_count + (size_t)steps,
                          sizeof *d->samples))
                return false;
            for (int n = 0; n < steps; n++)
                d->samples[d->sample_count++] =
                    (sample){(float)(p->x + x * (n + 0.5) / steps), (float)(p->y + y * (n + 0.5) / steps),
                             (float)(x / length), (float)(y / length), (float)(length / steps)};
        }
    }
    return true;
}

/* --- significance --------------------------------------------------------------------------------------- */

/* Length of lines of one direction in the cell that lies aside of a sample. */
static float beside(const density *d, const sample *s, int direction, double aside)
{
    double x = s->x - aside * s->along_y, y = s->y + aside * s->along_x;
    if (x < 0 || y < 0 || x >= d->columns * CELL || y >= d->rows * CELL)
        return 0;
    return d->all[DIRECTIONS * cell_at(d, x, y) + (size_t)direction];
}

/* Of a family of parallels, those at its rim have neighbours to one side only. */
static bool is_outermost(const density *d)
{
    size_t rim = 0;
    for (size_t i = 0; i < d->sample_count; i++) {
        const sample *s = &d->samples[i];
        int           direction = direction_of(s->along_x, s->along_y);
        rim += (beside(d, s, direction, 1.5 * CELL) > 0) != (beside(d, s, direction, -1.5 * CELL) > 0);
    }
    return (double)rim > MOST_OF_IT * (double)d->sample_count;
}

static void weigh(density *d, chain *c)
{
    double length = 0, weight = 0;
    for (size_t i = 0; i < d->sample_count; i++)
        length += (double)d->samples[i].length;
    const stroke *s = &d->set->strokes[c->first];
    for (uint32_t k = 0; k < s->count; k++)
        weight += (double)d->set->points[s->first + k].weight / s->count;
    c->significance = (1 - exp(-length / LONG)) * strengths[s->kind] * weight * (is_outermost(d) ? OUTERMOST : 1);
}

/* Chains in the order of the strokes; fills `all` on the way. */
static chain *find_chains(density *d, size_t *count)
{
    stroke_set *set = d->set;
    chain      *out = mem_calloc(set->stroke_count + 1, sizeof *out);
    *count = 0;
    for (uint32_t i = 0; i < set->stroke_count && out; i++) {
        if (!i || set->strokes[i].chain != set->strokes[i - 1].chain)
            out[(*count)++] = (chain){.first = i};
        out[*count - 1].count++;
    }
    bool good = out != NULL;
    for (int pass = 0; pass < 2 && good; pass++)
        for (size_t i = 0; i < *count && good; i++) {
            good = take_samples(d, &out[i]);
            for (size_t k = 0; k < d->sample_count && good && !pass; k++) {
                const sample *s = &d->samples[k];
                d->all[DIRECTIONS * cell_at(d, s->x, s->y) + (size_t)direction_of(s->along_x, s->along_y)] += s->length;
            }
            if (good && pass)
                weigh(d, &out[i]);
        }
    if (!good) {
        mem_free(out);
        return NULL;
    }
    return out;
}

static int compare_chains(const void *a, const void *b)
{
    const chain *p = a, *q = b;
    if (p->significance != q->significance)
        return p->significance > q->significance ? -1 : 1;
    return p->first < q->first ? -1 : p->first > q->first;
}

/* --- laying chains onto the page ------------------------------------------------------------------------ */

/* Is a line there that runs the same way, no finer than this one? */
static bool runs_beside(const density *d, const sample *s, double reach, double width)
{
    int column = (int)(s->x / CELL), row = (int)(s->y / CELL), cells = (int)ceil(reach / CELL);
    for (int r = row - cells; r <= row + cells; r++)
        for (int k = column - cells; k <= column + cells; k++) {
            if (r < 0 || k < 0 || r >= d->rows || k >= d->columns)
                continue;
            int left = CHAINS_A_CELL;
            for (uint32_t at = d->heads[(size_t)r * (size_t)d->columns + (size_t)k]; at && left--;
                 at = d->traces[at - 1].next) {
                const trace *t = &d->traces[at - 1];
                double       x = (double)t->x - s->x, y = (double)t->y - s->y;
                double       along = fabs(x * s->along_x + y * s->along_y), aside = x * s->along_y - y * s->along_x;
                if ((double)t->width >= LIKE_WIDTH * width && along <= STEP && fabs(aside) < reach &&
                    fabs((double)t->along_x * s->along_x + (double)t->along_y * s->along_y) > PARALLEL)
                    return true;
            }
        }
    return false;
}

/* Fraction of the page that is inked around a position. */
static double ink_around(const density *d, const sample *s)
{
    int    column = (int)(s->x / CELL), row = (int)(s->y / CELL), count = 0;
    double ink = 0;
    for (int r = row - WINDOW; r <= row + WINDOW; r++)
        for (int k = column - WINDOW; k <= column + WINDOW; k++, count++)
            if (r >= 0 && k >= 0 && r < d->rows && k < d->columns)
                ink += (double)d->drawn[(size_t)r * (size_t)d->columns + (size_t)k];
    return ink / (count * CELL * CELL);
}

/* Is so much of a chain in ink that is there already? */
static bool is_dense(const density *d, double most, double limit, double *all)
{
    double dense = 0;
    size_t cell = SIZE_MAX;
    bool   in_ink = false;
    *all = 0;
    for (size_t i = 0; i < d->sample_count; i++) {
        const sample *s = &d->samples[i];
        if (cell_at(d, s->x, s->y) != cell) { /* several lie in one */
            cell = cell_at(d, s->x, s->y);
            in_ink = ink_around(d, s) > most;
        }
        *all += (double)s->length;
        dense += in_ink ? (double)s->length : 0;
    }
    return dense > limit * *all;
}

static bool is_crowded(const density *d, const stroke *s, double width)
{
    double limit = is_outline(s) || s->kind >= STROKE_SUGGESTIVE ? MOST_OF_OUTLINES : MOST_OF_IT;
    double detail = d->options->detail, reach = fmax(BESIDE_WIDTHS * width, BESIDE_LEAST) * 2 * (1 - detail),
           most = DENSITY_LEAST + DENSITY_MORE * detail, all, parallel = 0, other = 0, alone = 0, most_alone = 0;
    if (is_dense(d, most, limit, &all))
        return true;
    for (size_t i = 0; i < d->sample_count; i++) {
        const sample *p = &d->samples[i];
        bool          beside_another = runs_beside(d, p, reach, width);
        parallel += beside_another ? (double)p->length : 0;
        other += beside_another ? 0 : (double)p->length;
        if (all - other < (1 - 1e-9) * limit * all) /* what is left cannot be enough any more */
            return false;
        alone = beside_another || ink_around(d, p) > most ? 0 : alone + (double)p->length;
        most_alone = fmax(most_alone, alone);
    }
    bool bare = is_outline(s) ? all - parallel > BARE_OUTLINE : most_alone > BARE_LINE;
    return parallel > limit * all && !bare;
}

static bool lay(density *d, double width)
{
    for (size_t i = 0; i < d->sample_count; i++) {
        const sample *s = &d->samples[i];
        size_t        cell = cell_at(d, s->x, s->y);
        if (!mem_grow((void **)&d->traces, &d->trace_capacity, d->trace_count + 1, sizeof *d->traces))
            return false;
        d->traces[d->trace_count++] = (trace){s->x, s->y, s->along_x, s->along_y, (float)width, d->heads[cell]};
        d->heads[cell] = (uint32_t)d->trace_count;
        d->drawn[cell] += s->length * (float)width;
    }
    return true;
}

/* --- small pieces --------------------------------------------------------------------------------------- */

/* The longer side of the box around a box of a mesh on paper. */
static double size_on_paper(const stroke_view *v, const stroke_item *item, const box3 *box)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 8; k++) {
        window_point p;
        vec3         corner = {k & 1 ? box->max.x : box->min.x, k & 2 ? box->max.y : box->min.y,
                       k & 4 ? box->max.z : box->min.z};
        if (!view_position(v, item_position(item, corner), &p))
            return INFINITY;
        low[0] = fmin(low[0], p.x);
        low[1] = fmin(low[1], p.y);
        high[0] = fmax(high[0], p.x);
        high[1] = fmax(high[1], p.y);
    }
    return fmax(high[0] - low[0], high[1] - low[1]) / v->units;
}

/* Sizes of each piece of each item on paper. NULL: out of memory. */
static float *find_sizes(const stroke_view *v)
{
    float *sizes = mem_calloc((size_t)v->piece_count + 1, sizeof *sizes);
    for (size_t i = 0; i < v->scene->item_count && sizes; i++) {
        const stroke_item *item = &v->scene->items[i];
        const edge_mesh   *m = &v->scene->meshes[item->mesh];
        for (uint32_t p = 0; p < m->piece_count; p++)
            sizes[v->items[i].first_piece + p] =
                m->face_count ? (float)size_on_paper(v, item, &m->boxes[p]) : INFINITY; /* nothing else would be left */
    }
    return sizes;
}

/* --- all ------------------------------------------------------------------------------------------------ */

static bool open_density(density *d, const stroke_view *v)
{
    d->columns = (int)(v->camera.width / CELL) + 1;
    d->rows = (int)(v->camera.height / CELL) + 1;
    size_t cells = (size_t)d->columns * (size_t)d->rows;
    d->all = mem_calloc(DIRECTIONS * cells, sizeof *d->all);
    d->drawn = mem_calloc(cells, sizeof *d->drawn);
    d->heads = mem_calloc(cells, sizeof *d->heads);
    return d->all && d->drawn && d->heads;
}

/* Of a chain; what is hidden is not beside what is seen, and tells of what lies there: the sides of a bore, the rim of
 * which is seen from the edge, on another line. */
static double hidden_length(const density *d, const chain *c)
{
    double length = 0;
    for (uint32_t k = 0; k < c->count; k++) {
        const stroke *s = &d->set->strokes[c->first + k];
        for (uint32_t i = 1; i < s->count && s->hidden_by; i++) {
            const stroke_point *p = &d->set->points[s->first + i];
            length += hypot((double)p->x - (double)p[-1].x, (double)p->y - (double)p[-1].y);
        }
    }
    return length;
}

static bool choose(density *d, chain *chains, size_t count, uint8_t *gone)
{
    double small = OUTLINE_ALONE * fmin(2 * (1 - (double)d->options->detail), 1);
    qsort(chains, count, sizeof *chains, compare_chains);
    for (size_t i = 0; i < count; i++) {
        const chain  *c = &chains[i];
        const stroke *s = &d->set->strokes[c->first];
        double        width = width_of(d, s);
        if (!take_samples(d, c))
            return false;
        if (d->sample_count == 0) /* nothing of it is visible */
            continue;
        bool goes = (!is_outline(s) && s->kind < STROKE_SUGGESTIVE && s->size < small) || is_crowded(d, s, width);
        bool hidden_stays = goes && hidden_length(d, c) > BARE_LINE;
        for (uint32_t k = 0; k < c->count && goes; k++)
            gone[c->first + k] = !(hidden_stays && d->set->strokes[c->first + k].hidden_by);
        if (!goes && !lay(d, width))
            return false;
    }
    return true;
}

lmn_status strokes_choose(stroke_set *set, const stroke_view *v, const stroke_options *options, uint8_t *gone,
                          lmn_error *error)
{
    if (!(options->detail < 1) || set->stroke_count == 0)
        return LMN_OK;
    density d = {.set = set, .options = options};
    size_t  count = 0;
    float  *sizes = find_sizes(v);
    for (size_t i = 0; i < set->stroke_count && sizes; i++)
        set->strokes[i].size = sizes[set->strokes[i].piece];
    chain *chains = sizes && open_density(&d, v) ? find_chains(&d, &count) : NULL;
    bool   good = chains && choose(&d, chains, count, gone);
    mem_free(sizes);
    mem_free(chains);
    mem_free(d.all);
    mem_free(d.drawn);
    mem_free(d.heads);
    mem_free(d.traces);
    mem_free(d.samples);
    return good ? LMN_OK : error_memory(error);
}
