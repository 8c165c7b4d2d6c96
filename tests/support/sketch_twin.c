#include "sketch_twin.h"

#include <math.h>

#include "check.h"
#include "picture.h"

sketch_maps sketch_maps_of(const shot *s)
{
    return (sketch_maps){s->width, s->height, s->depth, s->edge, s->shade, (const float(*)[3])s->uncertainty};
}

sketch_maps sketch_maps_of_layer(const shot *s, int layer)
{
    const shot_layer *l = &s->layers[layer];
    return (sketch_maps){s->width, s->height, l->depth, l->edge, l->shade, (const float(*)[3])s->uncertainty};
}

sketch_degree sketch_scaled(double degree)
{
    return (sketch_degree){degree, 0, 0, degree};
}

sketch_degree sketch_times(sketch_degree a, sketch_degree b)
{
    return (sketch_degree){a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
                           a.yx * b.xy + a.yy * b.yy};
}

sketch_degree sketch_turn(double degrees)
{
    double angle = degrees * 3.14159265358979323846 / 180;
    return (sketch_degree){cos(angle), -sin(angle), sin(angle), cos(angle)};
}

/* Index of a texel; beyond the border lies the border. */
static size_t texel(const sketch_maps *m, int x, int y)
{
    x = x < 0 ? 0 : x >= m->width ? m->width - 1 : x;
    y = y < 0 ? 0 : y >= m->height ? m->height - 1 : y;
    return (size_t)(m->height - 1 - y) * (size_t)m->width + (size_t)x;
}

sketch_position sketch_moved(const sketch_maps *m, int x, int y, double amount, sketch_degree degree)
{
    const float *n = m->uncertainty[texel(m, x, y)];
    return (sketch_position){x + amount * (degree.xx * (double)n[0] + degree.xy * (double)n[1]),
                             y + amount * (degree.yx * (double)n[0] + degree.yy * (double)n[1])};
}

bool sketch_inside(const sketch_maps *m, sketch_position p)
{
    return p.x >= 0 && p.y >= 0 && p.x <= m->width - 1 && p.y <= m->height - 1;
}

double sketch_depth(const sketch_maps *m, sketch_position p)
{
    return (double)m->depth[texel(m, (int)floor(p.x + 0.5), (int)floor(p.y + 0.5))];
}

double sketch_depth_around(const sketch_maps *m, sketch_position p)
{
    double x = floor(p.x), y = floor(p.y), least = INFINITY;
    for (int k = 0; k < 4; k++)
        least = fmin(least, sketch_depth(m, (sketch_position){x + k % 2, y + k / 2}));
    return least;
}

double sketch_reach(const sketch_maps *m, sketch_position p, int reach)
{
    double least = INFINITY;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            least = fmin(least, sketch_depth(m, (sketch_position){p.x + x, p.y + y}));
    return least;
}

/* The four texels around a position and their weights. */
static void around(const sketch_maps *m, sketch_position p, size_t at[4], double weight[4])
{
    int    x = (int)floor(p.x), y = (int)floor(p.y);
    double u = p.x - x, v = p.y - y;
    for (int k = 0; k < 4; k++) {
        at[k] = texel(m, x + k % 2, y + k / 2);
        weight[k] = (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
    }
}

double sketch_field(const sketch_maps *m, double x, double y, int channel)
{
    size_t at[4];
    double weight[4], sum = 0;
    around(m, (sketch_position){x, y}, at, weight);
    for (int k = 0; k < 4; k++)
        sum += weight[k] * (double)m->uncertainty[at[k]][channel];
    return sum;
}

void sketch_edge(const sketch_maps *m, sketch_position p, double out[4])
{
    size_t at[4];
    double weight[4];
    around(m, p, at, weight);
    for (int c = 0; c < 4; c++) {
        out[c] = 0;
        for (int k = 0; k < 4; k++)
            out[c] += weight[k] * m->edge[4 * at[k] + (size_t)c] / 255;
    }
}

sketch_paint sketch_shade(const sketch_maps *m, sketch_position p)
{
    size_t       at[4];
    double       weight[4];
    sketch_paint sum = {0, 0, 0, 0};
    around(m, p, at, weight);
    for (int k = 0; k < 4; k++) {
        const uint8_t *t = &m->shade[4 * at[k]];
        sketch_paint   own = sketch_fraction(sketch_colour(t, t[3] / 255.0), weight[k]);
        sum = (sketch_paint){sum.r + own.r, sum.g + own.g, sum.b + own.b, sum.a + own.a};
    }
    return sum;
}

sketch_paint sketch_colour(const uint8_t srgb[3], double alpha)
{
    return (sketch_paint){alpha * picture_shown(srgb[0]), alpha * picture_shown(srgb[1]),
                          alpha * picture_shown(srgb[2]), alpha};
}

sketch_paint sketch_fraction(sketch_paint p, double fraction)
{
    return (sketch_paint){p.r * fraction, p.g * fraction, p.b * fraction, p.a * fraction};
}

sketch_paint sketch_over(sketch_paint front, sketch_paint back)
{
    back = sketch_fraction(back, 1 - front.a);
    return (sketch_paint){front.r + back.r, front.g + back.g, front.b + back.b, front.a + back.a};
}

sketch_paint sketch_ink(const double edge[4], sketch_paint colour)
{
    double clear = (1 - colour.a * (1 - edge[0])) * (1 - colour.a * (1 - edge[1])) * (1 - colour.a * (1 - edge[3]));
    return colour.a > 0 ? sketch_fraction(colour, (1 - clear) / colour.a) : colour;
}

sketch_degree sketch_copy(const sketch_style *style, int i)
{
    double        more = pow(style->repeat > 1 ? style->repeat_degree : 1, i);
    sketch_degree d = sketch_times(style->edges, sketch_turn(360.0 * i / (style->repeat > 1 ? style->repeat : 1)));
    return (sketch_degree){d.xx * more, d.xy * more, d.yx * more, d.yy * more};
}

/* Pressed, the soft rims of a line fill; eased, they go first, and what is left is paler. Every other copy is pressed
 * where the first one is eased. */
static double pressed(double ink, double force)
{
    double more = fmax(force, 0), less = fmax(-force, 0), full = fmin(ink * (1 + 4 * more), 1);
    return fmax(1 - (1 - full) * (1 + 1.5 * less), 0) * (1 - 0.6 * less);
}

sketch_paint sketch_copy_ink(const sketch_maps *m, const sketch_style *style, int i, int x, int y, double *depth)
{
    sketch_position e = sketch_moved(m, x, y, style->amount, sketch_copy(style, i));
    double          edge[4];
    sketch_edge(m, e, edge);
    sketch_paint ink = sketch_ink(edge, i ? style->repeat_inks[i - 1] : style->ink);
    if (style->pressure > 0 && ink.a > 0)
        ink =
            sketch_fraction(ink, pressed(ink.a, style->pressure * (i % 2 ? -1 : 1) * sketch_field(m, x, y, 2)) / ink.a);
    *depth = sketch_depth(m, e);
    if (!isfinite(*depth) && ink.a > 0)
        *depth = sketch_reach(m, e, 2); /* half the line's width, and one pixel for what filtering spreads */
    return ink;
}

sketch_paint sketch_opaque(const sketch_maps *m, const sketch_style *style, int x, int y, double *depth)
{
    sketch_position s = sketch_moved(m, x, y, style->amount, style->shades);
    double          fill_depth = sketch_depth_around(m, s), line_depth;
    bool bare = !style->without_lines && isfinite(sketch_depth(m, sketch_moved(m, x, y, style->amount, style->edges)));
    sketch_paint fill = {0, 0, 0, 0}, ink = {0, 0, 0, 0};
    if (isfinite(fill_depth))
        fill = sketch_shade(m, s);
    if (!isfinite(sketch_depth(m, s)) && bare && !style->without_fill)
        fill = sketch_over(fill, style->fallback);
    *depth = style->without_fill ? INFINITY : fill_depth;
    for (int i = style->repeat > 1 ? style->repeat - 1 : 0; i >= 0 && !style->without_lines; i--) {
        ink = sketch_over(sketch_copy_ink(m, style, i, x, y, &line_depth), ink);
        *depth = fmin(*depth, line_depth);
    }
    return isfinite(*depth) ? sketch_over(ink, fill) : (sketch_paint){0, 0, 0, 0};
}

const uint8_t *sketch_pixel(const shot *s, int x, int y)
{
    return &s->picture[4 * ((size_t)(s->height - 1 - y) * (size_t)s->width + (size_t)x)];
}

double sketch_levels_off(const uint8_t *drawn, sketch_paint wanted)
{
    double off = fmax(fabs(drawn[0] - picture_level(wanted.r)), fabs(drawn[1] - picture_level(wanted.g)));
    return fmax(0, fmax(off, fabs(drawn[2] - picture_level(wanted.b))) - 0.5);
}

void sketch_judge(sketch_tally *t, const shot *s, int x, int y, sketch_paint wanted, double levels)
{
    double off = sketch_levels_off(sketch_pixel(s, x, y), wanted);
    t->pixels++;
    t->right += off <= levels;
    if (off > t->worst) {
        t->worst = off;
        t->x = x;
        t->y = y;
    }
}

bool sketch_check(const char *row, const sketch_tally *t, const shot *s, double fraction, const char *what)
{
    bool holds = check_at_least(row, t->pixels ? (double)t->right / t->pixels : 0, fraction,
                                "%s: fraction of %d pixels as predicted", what, t->pixels);
    if (!holds && s->picture && t->pixels) {
        const uint8_t *p = sketch_pixel(s, t->x, t->y);
        check_note("%d wrong; worst at %d, %d from the lower left: %.1f levels, drawn %d %d %d", t->pixels - t->right,
                   t->x, t->y, t->worst, p[0], p[1], p[2]);
    }
    return holds;
}

bool sketch_check_opaque(const char *row, const shot *s, const sketch_style *style, double levels, double fraction,
                         const char *what)
{
    sketch_maps  m = sketch_maps_of(s);
    sketch_tally t = {0};
    double       depth;
    if (!m.uncertainty)
        return check_that(row, false, "%s: the drawing has its field of uncertainty", what);
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            sketch_judge(&t, s, x, y, sketch_over(sketch_opaque(&m, style, x, y, &depth), style->ground), levels);
    return sketch_check(row, &t, s, fraction, what);
}
