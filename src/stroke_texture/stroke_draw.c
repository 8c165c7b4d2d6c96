/* Strokes as antialiased capsules in a picture that repeats. Rows EX-18, EX-23, EX-24. */
#include "stroke_texture/strokes_private.h"

#include <string.h>

#include "stroke_texture/stroke_image.h"

/* Curves of more chords each way run out as if they were shorter: looking along them must not take long. */
enum { CURVE_CHORDS = 512 };

/* A stroke in texels; texel centres lie at half numbers. */
typedef struct capsule {
    double              x0, y0, dx, dy; /* start and way to the end */
    double              length_square;
    double              width, taper, reach; /* reach: no ink farther from the axis */
    double              from, to;            /* the stroke's position on the line that it is part of */
    double              grain, length;
    uint32_t            key;   /* of its streaks */
    const stroke_image *image; /* or NULL */
} capsule;

typedef struct span {
    int from, to; /* empty where from > to */
} span;

/* --- grain ---------------------------------------------------------------------------------------------- */

static const double STREAK_LENGTH = 7, STREAK_WIDTH = 0.8; /* texels */
static const double BARE = 0.85;                           /* of the ink is gone in the barest streak */
static const double LIFT = 0.4;                            /* of the pressure is gone at the end */
static const double CAPACITY =
    20; /* texels that a stroke takes to show all its grain; shorter ones are marks rather than strokes */

static double lane_noise(uint32_t key, int lane, int position)
{
    uint32_t h = key + (uint32_t)lane * 0xc2b2ae35u + (uint32_t)position * 0x27d4eb2fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return (double)((h ^ (h >> 15)) >> 8) * 0x1p-24;
}

/* Along one lane, from one random number to the next. */
static double lane_at(uint32_t key, int lane, double along)
{
    double at = along / STREAK_LENGTH + lane_noise(key, lane, -7), fraction = at - floor(at);
    double before = lane_noise(key, lane, (int)floor(at)), after = lane_noise(key, lane, (int)floor(at) + 1);
    return before + (after - before) * fraction * fraction * (3 - 2 * fraction);
}

/* The fraction of ink that graphite leaves at a position of the stroke. */
static double grain_at(const capsule *c, double along, double aside)
{
    double at = aside / STREAK_WIDTH, fraction = at - floor(at), t = c->from + along * (c->to - c->from);
    double streak = lane_at(c->key, (int)floor(at), along * c->length) * (1 - fraction) +
                    lane_at(c->key, (int)floor(at) + 1, along * c->length) * fraction;
    return (1 - c->grain * BARE * fmin(fmax(2 * streak - 0.5, 0), 1)) * (1 - c->grain * LIFT * t * t);
}

static double grain_of(double grain, double texels)
{
    return grain * fmin(texels / CAPACITY, 1);
}

double stroke_grain_mean(double grain, double texels)
{
    grain = grain_of(grain, texels);
    return (1 - grain * BARE * 0.5) * (1 - grain * LIFT / 3);
}

/* A number for a stroke, by where it is: it has the same streaks wherever it is drawn. */
static uint32_t key_of(const texture_stroke *s)
{
    const float ends[4] = {s->u0, s->v0, s->u1, s->v1};
    uint32_t    bits[4], key = 0x9e3779b9;
    memcpy(bits, ends, sizeof bits);
    for (int i = 0; i < 4; i++)
        key = (key ^ bits[i]) * 0x85ebca6bu + (key >> 15);
    return key;
}

static capsule capsule_of(const texture_stroke *s, int side, const stroke_brush *brush)
{
    double  scale = side;
    capsule c = {.x0 = (double)s->u0 * scale, .y0 = (double)s->v0 * scale, .width = brush->width};
    c.dx = ((double)s->u1 - (double)s->u0) * scale;
    c.dy = ((double)s->v1 - (double)s->v0) * scale;
    c.length_square = c.dx * c.dx + c.dy * c.dy;
    c.reach = 0.5 * c.width + 0.5;
    c.from = brush->from;
    c.to = brush->to > brush->from ? brush->to : 1;
    c.length = sqrt(c.length_square);
    /* A dot has no length to run out over. */
    if (c.length > 0)
        c.taper = brush->cap > 0 ? fmin(brush->cap * (c.to - c.from) / c.length, 0.25) : fmin(brush->taper, 0.5);
    c.grain = grain_of(brush->grain, c.length / (c.to - c.from));
    c.key = c.grain > 0 ? key_of(s) : 0;
    c.image = c.length > 0 ? brush->image : NULL;
    if (c.image)
        c.reach += 0.5; /* its corners */
    return c;
}

/* A pen that is set down and lifted: quick at first, then full. */
static double width_at(const capsule *c, double t)
{
    double at = c->from + t * (c->to - c->from), fraction = fmin(at, 1 - at) / c->taper;
    return fraction >= 1 ? c->width : c->width * fraction * (2 - fraction);
}

/* How much of the texel lies between both ends of a line. */
static double covered_of(double along, double length)
{
    return fmax(0, fmin(along + 0.5, length) - fmax(along - 0.5, 0));
}

/* What the image has there. A chord shows its part of it, of a texel that it shares with the next as much as it
 * covers. */
static double image_at(const capsule *c, double px, double py)
{
    double        along = (px * c->dx + py * c->dy) / c->length, left = (py * c->dx - px * c->dy) / c->length;
    stroke_extent whole = {c->length / (c->to - c->from), c->width};
    double        before = c->from * whole.length, covered = covered_of(along, c->length);
    if (covered <= 0)
        return 0;
    double ink = stroke_image_at(c->image, &whole, before + along, left);
    if (whole.length > c->length)
        ink *= fmin(covered / covered_of(before + along, whole.length), 1);
    return c->grain > 0 ? ink * grain_at(c, fmax(0, fmin(along / c->length, 1)), left) : ink;
}

static double coverage_at(const capsule *c, double x, double y)
{
    double px = x - c->x0, py = y - c->y0, t = 0, width = c->width;
    if (c->image)
        return image_at(c, px, py);
    if (c->length_square > 0)
        t = fmax(0, fmin(1, (px * c->dx + py * c->dy) / c->length_square));
    if (c->taper > 0)
        width = width_at(c, t);
    px -= t * c->dx;
    py -= t * c->dy;
    double distance = sqrt(px * px + py * py), covered = fmax(0, fmin(fmin(1, width), 0.5 * width + 0.5 - distance));
    if (c->grain > 0 && covered > 0)
        covered *= grain_at(c, t, c->length > 0 ? (py * c->dx - px * c->dy) / c->length : py);
    return covered;
}

/* Texels whose centres lie between two positions. */
static span span_between(double low, double high)
{
    return (span){(int)ceil(low - 0.5), (int)floor(high - 0.5)};
}

static span rows_of(const capsule *c)
{
    double end = c->y0 + c->dy;
    return span_between(fmin(c->y0, end) - c->reach, fmax(c->y0, end) + c->reach);
}

/* Where a row can meet the capsule: around the piece of its axis that is within reach of the row. */
static span columns_of(const capsule *c, int row)
{
    double y = row + 0.5 - c->y0, from = 0, to = 1;
    if (c->dy != 0) {
        double a = (y - c->reach) / c->dy, b = (y + c->reach) / c->dy;
        from = fmax(0, fmin(a, b));
        to = fmin(1, fmax(a, b));
        if (from > to)
            return (span){0, -1};
    }
    double a = c->x0 + from * c->dx, b = c->x0 + to * c->dx;
    return span_between(fmin(a, b) - c->reach, fmax(a, b) + c->reach);
}

static span all_columns_of(const capsule *c)
{
    double end = c->x0 + c->dx;
    return span_between(fmin(c->x0, end) - c->reach, fmax(c->x0, end) + c->reach);
}

static int wrap(int at, int side)
{
    int rest = at % side;
    return rest < 0 ? rest + side : rest;
}

static void draw_once(const capsule *c, int side, stroke_texel_fn texel, void *user)
{
    span rows = rows_of(c);
    for (int y = rows.from; y <= rows.to; y++) {
        span   columns = columns_of(c, y);
        size_t row = (size_t)wrap(y, side) * (size_t)side;
        for (int x = columns.from; x <= columns.to; x++) {
            double coverage = coverage_at(c, x + 0.5, y + 0.5);
            if (coverage > 0)
                texel(user, row + (size_t)wrap(x, side), (float)coverage);
        }
    }
}

/* A stroke that is as large as the picture meets texels several times; the most counts. */
static double most_coverage(const capsule *c, int side, int x, int y, int last_row)
{
    double most = 0;
    for (int row = y; row <= last_row; row += side) {
        span columns = columns_of(c, row);
        int  first = x + (columns.from > x ? (columns.from - x + side - 1) / side * side : 0);
        for (int column = first; column <= columns.to; column += side)
            most = fmax(most, coverage_at(c, column + 0.5, row + 0.5));
    }
    return most;
}

static void draw_often(const capsule *c, int side, stroke_texel_fn texel, void *user)
{
    span rows = rows_of(c), columns = all_columns_of(c);
    for (int y = rows.from; y <= rows.to && y < rows.from + side; y++)
        for (int x = columns.from; x <= columns.to && x < columns.from + side; x++) {
            double coverage = most_coverage(c, side, x, y, rows.to);
            if (coverage > 0)
                texel(user, (size_t)wrap(y, side) * (size_t)side + (size_t)wrap(x, side), (float)coverage);
        }
}

void stroke_draw(const texture_stroke *s, int side, const stroke_brush *brush, stroke_texel_fn texel, void *user)
{
    if (side <= 0 || !(brush->width > 0))
        return;
    capsule c = capsule_of(s, side, brush);
    span    rows = rows_of(&c), columns = all_columns_of(&c);
    if (rows.to - rows.from < side && columns.to - columns.from < side)
        draw_once(&c, side, texel, user);
    else
        draw_often(&c, side, texel, user);
}

stroke_brush strokes_brush_at(const strokes *s, size_t index, const stroke_brush *brush)
{
    stroke_brush out = *brush;
    size_t       first = index, last = index;
    double       before = 0, all = 0;
    if (s->width > 0)
        out.width *= (double)s->width;
    if (brush->taper <= 0 && brush->cap <= 0 && brush->grain <= 0 && !brush->image)
        return out;
    while (first > 0 && index - first < CURVE_CHORDS && stroke_goes_on(&s->items[first - 1], &s->items[first]))
        first--;
    while (last + 1 < s->count && last - index < CURVE_CHORDS && stroke_goes_on(&s->items[last], &s->items[last + 1]))
        last++;
    for (size_t i = first; i <= last; i++) {
        double length = stroke_length(&s->items[i]);
        before += i < index ? length : 0;
        all += length;
    }
    if (all > 0 && last > first) {
        out.from = before / all;
        out.to = (before + stroke_length(&s->items[index])) / all;
    }
    return out;
}

/* Texels that several strokes touch have the ink of the one that covers most, so that strokes that meet do not show
 * a seam or a knot. */
static void darken(void *user, size_t index, float coverage)
{
    uint8_t *out = user, paper = (uint8_t)lrintf(255.0f * (1.0f - coverage));
    if (paper < out[index])
        out[index] = paper;
}

void strokes_draw(const strokes *s, int side, const stroke_brush *brush, float threshold_light,
                  float threshold_perspective, uint8_t *out)
{
    memset(out, 255, (size_t)side * (size_t)side);
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].light < threshold_light || s->items[i].perspective < threshold_perspective)
            continue;
        stroke_brush fitting = strokes_brush_at(s, i, brush);
        stroke_draw(&s->items[i], side, &fitting, darken, out);
    }
}
