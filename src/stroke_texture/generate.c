/* Patterns of strokes: what they have in common, and the table of them. */
#include "stroke_texture/generate.h"

#include "base/memory.h"

const char *const stroke_pattern_names[PATTERN_COUNT + 1] = {"parallel", "cross",    "contour", "brick",
                                                             "stipple",  "scribble", "random",  NULL};

/* Enough positions to choose from for any picture; more would only take time. */
enum { THROWN_MAX = 400000 };

/* What suits a pattern, and how its light priorities are shared out. */
typedef struct pattern_row {
    void (*generate)(generator *g);
    size_t         count;
    double         length;
    priority_order order;
} pattern_row;

static const pattern_row pattern_rows[PATTERN_COUNT] = {
    [PATTERN_PARALLEL] = {pattern_parallel, 240, 0.25, ORDER_EVEN},
    [PATTERN_CROSS] = {pattern_cross, 760, 0.25, ORDER_EVEN},
    [PATTERN_CONTOUR] = {pattern_contour, 1600, 0.3, ORDER_EVEN},
    [PATTERN_BRICK] = {pattern_brick, 900, 0.06, ORDER_EVEN},
    [PATTERN_STIPPLE] = {pattern_stipple, 4096, 0, ORDER_DRAWN}, /* dots come in the even order already */
    [PATTERN_SCRIBBLE] = {pattern_scribble, 12000, 1.5, ORDER_EVEN},
    [PATTERN_RANDOM] = {pattern_random, 500, 0.16, ORDER_EVEN},
};

void generate_stroke(generator *g, position from, position to, int32_t layer)
{
    texture_stroke s = {(float)from.u, (float)from.v, (float)to.u, (float)to.v, 1, 1, layer};
    if (!g->failed && !strokes_add(g->out, s))
        g->failed = true;
}

void generate_curve(generator *g, const position *points, size_t count, int32_t layer)
{
    for (size_t i = 0; i + 1 < count; i++)
        generate_stroke(g, points[i], points[i + 1], layer);
}

/* Of many positions thrown at random the one that is farthest from all before is taken, again and again; the fewer
 * there are to choose from, the less even. */
void generate_positions(generator *g, position *out, size_t count, double uneven)
{
    size_t thrown = count * (size_t)(1 + 15 * (1 - uneven) * (1 - uneven));
    thrown = thrown <= THROWN_MAX ? thrown : count < THROWN_MAX ? THROWN_MAX : count;
    spread_point *points = mem_calloc(thrown, sizeof *points);
    size_t       *order = mem_calloc(count, sizeof *order);
    for (size_t i = 0; points && i < thrown; i++) {
        points[i].u = (float)random_unit(&g->chance);
        points[i].v = (float)random_unit(&g->chance);
        points[i].item = i;
    }
    if (g->failed || !points || !order || !spread_order(order, count, points, thrown, thrown, g->seed))
        g->failed = true;
    for (size_t i = 0; !g->failed && i < count; i++)
        out[i] = (position){(double)points[order[i]].u, (double)points[order[i]].v};
    mem_free(points);
    mem_free(order);
}

static const double turn = 6.28318530717958648;

sway sway_of(random_source *chance, double amplitude, int rough)
{
    sway s;
    for (int i = 0; i < SWAY_WAVES; i++) {
        s.u[i] = 1 + i % rough;
        s.v[i] = (int)random_below(chance, (size_t)(2 * rough + 1)) - rough;
        s.phase[i] = turn * random_unit(chance);
        /* Long waves sway most. */
        s.amplitude[i] = amplitude * (0.5 + random_unit(chance)) / (s.u[i] * sqrt(SWAY_WAVES));
    }
    return s;
}

double sway_at(const sway *s, position at)
{
    double sum = 0;
    for (int i = 0; i < SWAY_WAVES; i++)
        sum += s->amplitude[i] * sin(turn * (s->u[i] * at.u + s->v[i] * at.v) + s->phase[i]);
    return sum;
}

lmn_status strokes_generate(strokes *out, const pattern_options *options, lmn_error *error)
{
    *out = (strokes){.width = 1};
    const pattern_row *row = &pattern_rows[options->pattern];
    generator          g = {
                 .out = out, .seed = options->seed, .chance = random_start(options->seed, (uint32_t)options->pattern)};
    g.count = options->count ? options->count : row->count;
    g.length = options->length > 0 ? fmin((double)options->length, 4) : row->length;
    g.uneven = fmin(fmax((double)options->uneven, 0), 1);
    if (g.count > LIMIT_STROKES / 2)
        return error_set(error, LMN_LIMIT, "%zu strokes; allowed are %d", g.count, LIMIT_STROKES / 2);
    row->generate(&g);
    strokes_wrap(out);
    lmn_status status = g.failed ? error_memory(error) : LMN_OK;
    if (status == LMN_OK)
        status = strokes_set_light(out, row->order, FRACTION_LENGTH, 0, g.seed, error);
    if (status == LMN_OK)
        status = strokes_set_perspective(out, PERSPECTIVE_EVEN, g.seed + 1, error);
    if (status != LMN_OK)
        strokes_release(out);
    return status;
}
