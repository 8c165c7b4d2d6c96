/* Hatching: series of strokes that run along, as straight as a hand draws them. */
#include "stroke_texture/generate.h"

#include "base/memory.h"

static const double golden = 0.61803398874989485;

/* Closed parallel lines on the torus, with strokes end to end on each. */
typedef struct rows {
    double along_u, along_v, across_u, across_v; /* unit vectors */
    double length, spacing;                      /* of a row; between rows */
    size_t count, strokes;                       /* rows; strokes a row */
} rows;

static rows rows_of(const generator *g, int along_u, int along_v, size_t count)
{
    rows r = {.length = hypot(along_u, along_v)};
    r.along_u = along_u / r.length;
    r.along_v = along_v / r.length;
    r.across_u = -r.along_v;
    r.across_v = r.along_u;
    /* A seventh of a stroke is left between strokes. */
    r.strokes = (size_t)fmax(1, floor(r.length / (g->length * 1.14) + 0.5));
    r.count = (count + r.strokes / 2) / r.strokes;
    r.count = r.count ? r.count : 1;
    r.spacing = 1 / (r.length * (double)r.count);
    return r;
}

static position position_on(const rows *r, double along, double across)
{
    return (position){along * r->along_u + across * r->across_u, along * r->along_v + across * r->across_v};
}

static position swayed(const rows *r, const sway *s, double along, double across)
{
    return position_on(r, along, across + sway_at(s, position_on(r, along, across)));
}

/* A stroke's ends on its row: rows begin at different positions, so that gaps do not line up. */
static void ends_on_row(generator *g, const rows *r, size_t row, size_t k, double *from, double *to)
{
    double pitch = r->length / (double)r->strokes, phase = golden * (double)row;
    double begin = (phase - floor(phase)) * pitch + pitch * (double)k;
    double length = fmin(g->length, 0.93 * pitch) * (1 + 0.42 * g->uneven * random_hand(&g->chance));
    begin += g->uneven * 0.3 * pitch * random_hand(&g->chance);
    *from = begin;
    *to = begin + (r->strokes == 1 ? g->length * (1 + 0.42 * g->uneven * random_hand(&g->chance)) : length);
}

void generate_hatching(generator *g, int along_u, int along_v, size_t count, int32_t layer)
{
    rows r = rows_of(g, along_u, along_v, count);
    sway drift = sway_of(&g->chance, 0.011 * g->uneven, 3);
    for (size_t row = 0; row < r.count; row++)
        for (size_t k = 0; k < r.strokes; k++) {
            double from, to, across = ((double)row + 0.5) * r.spacing;
            ends_on_row(g, &r, row, k, &from, &to);
            across += g->uneven * 0.5 * r.spacing * random_hand(&g->chance);
            double slope = g->uneven * 0.4 * r.spacing * random_hand(&g->chance);
            generate_stroke(g, swayed(&r, &drift, from, across - slope), swayed(&r, &drift, to, across + slope), layer);
        }
}

void pattern_parallel(generator *g)
{
    generate_hatching(g, 1, 0, g->count, 0);
}

void pattern_cross(generator *g)
{
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    for (int i = 0; i < 4; i++)
        generate_hatching(g, directions[i][0], directions[i][1], (g->count + (size_t)i) / 4, i);
}

enum { CONTOUR_CHORDS = 8 };

/* Rows that bend together, as over a form that swells and sinks. */
void pattern_contour(generator *g)
{
    size_t curves = g->count / CONTOUR_CHORDS;
    rows   r = rows_of(g, 1, 0, curves ? curves : 1);
    sway   drift = sway_of(&g->chance, 0.008 * g->uneven, 3);
    double phase = random_unit(&g->chance), lean = random_unit(&g->chance);
    for (size_t row = 0; row < r.count; row++)
        for (size_t k = 0; k < r.strokes; k++) {
            position points[CONTOUR_CHORDS + 1];
            double   from, to, across = ((double)row + 0.5) * r.spacing;
            ends_on_row(g, &r, row, k, &from, &to);
            across += g->uneven * 0.5 * r.spacing * random_hand(&g->chance);
            for (int i = 0; i <= CONTOUR_CHORDS; i++) {
                double along = from + (to - from) * i / CONTOUR_CHORDS;
                double form = 0.055 * sin(6.28318530717958648 * (along + phase)) +
                              0.016 * sin(6.28318530717958648 * (2 * along + across + lean));
                points[i] = swayed(&r, &drift, along, across + form);
            }
            generate_curve(g, points, CONTOUR_CHORDS + 1, 0);
        }
}
