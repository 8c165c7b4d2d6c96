/* Where the strokes of a tonal art map go: into the widest gap (after Praun 2001), or one into each strip (Müller,
 * section 3.1). */
#include "halftone/tonal_art_map_private.h"

#include <math.h>

#include "base/memory.h"

enum {
    CANDIDATES = 320, /* tried for one stroke of the best fit, */
    CANDIDATES_LEAST = 8,
    CHOSEN_STROKES = 1500, /* while a level has that many; where more lie, each matters less */
    STRIP_CANDIDATES = 8,
    CROWD_STEPS = 4,     /* entries of the table of crowding, a texel */
    STROKES_A_TEXEL = 16 /* where more would be needed, it stays as light as it is */
};

static const float  END_STRETCH = 3;                  /* how much farther away a stroke seems past its ends */
static const float  END_SLOPE = 4, END_LEAST = 0.25f; /* a quarter of the stroke crowds less; share at its very end */
static const double SHORTEST = 0.3;                   /* of the longest stroke */
static const double LONG_ENOUGH = 3; /* widths that a stroke should be long on the level for which it is drawn */
static const double SWAY = 0.16;     /* slope of the most uneven strokes */
static const double REACH = 4; /* gaps between even strokes of the tone over which strokes keep away from each other */
static const double STRIP_FRACTION = 0.7; /* of a strip, for hatching, in which strokes begin */

/* --- crowding ------------------------------------------------------------------------------------------- */

/* Strokes repel each other like charges, more the nearer, up to a few gaps of the tone: where that is least, is the
 * widest gap. */
bool tam_set_crowding(tam *t)
{
    const tam_options *w = t->options;
    double             reach = REACH * t->brush.width / tam_target(w, t->tone);
    reach = fmin(fmax(reach, 3 * t->brush.width), w->side / 2.0);
    size_t count = (size_t)(reach * CROWD_STEPS) + 2;
    float *table = mem_realloc(t->crowding, count * sizeof *table);
    if (!table)
        return false;
    t->crowding = table;
    t->crowding_count = count;
    for (size_t i = 0; i < count; i++) {
        double distance = (double)i / CROWD_STEPS, fade = 1 - distance / reach;
        table[i] = fade > 0 ? (float)(fade * fade / (distance / t->brush.width + 0.8)) : 0;
    }
    return true;
}

/* Ends are thin and crowd less, so that strokes go in between them; else there would be white lenses. */
static float end_fraction(float along)
{
    float fraction = fminf(along, 1 - along) * END_SLOPE;
    return fraction >= 1 ? 1 : END_LEAST + (1 - END_LEAST) * fraction;
}

void tam_add_crowd(tam *t, tam_level *level, const texture_stroke *s, int direction)
{
    int    side = level->side, mask = side - 1;
    double most = (double)(t->crowding_count - 1) / CROWD_STEPS, reach = fmin(most, side / 2.0 - 1);
    float  x0 = (float)((double)s->u0 * side), y0 = (float)((double)s->v0 * side);
    float  dx = (float)((double)s->u1 * side) - x0, dy = (float)((double)s->v1 * side) - y0, size = dx * dx + dy * dy;
    int    left = (int)floor((double)fminf(x0, x0 + dx) - reach), right = (int)ceil((double)fmaxf(x0, x0 + dx) + reach);
    int    low = (int)floor((double)fminf(y0, y0 + dy) - reach), high = (int)ceil((double)fmaxf(y0, y0 + dy) + reach);
    for (int y = low; y < high; y++) {
        float *row = level->crowd[direction] + (size_t)(y & mask) * (size_t)side, py = (float)y + 0.5f - y0;
        for (int x = left; x < right; x++) {
            float  px = (float)x + 0.5f - x0, along = (px * dx + py * dy) / size, aside = px * dy - py * dx;
            float  inside = along < 0 ? 0 : along > 1 ? 1 : along, past = END_STRETCH * (along - inside);
            size_t entry = (size_t)(sqrtf(aside * aside / size + past * past * size) * CROWD_STEPS);
            if (entry < t->crowding_count)
                row[x & mask] += t->crowding[entry] * end_fraction(inside);
        }
    }
}

/* Mean crowding along a stroke's axis, or anything above `best` as soon as it is certain to be worse. */
static float crowd_along(const tam_level *level, const float *crowd, const texture_stroke *s, float best)
{
    double   side = level->side, length = stroke_length(s) * side;
    int      count = 2 + (int)(length / 1.5);
    uint32_t mask = (uint32_t)level->side - 1;
    int64_t  x = (int64_t)((double)s->u0 * side * 65536), y = (int64_t)((double)s->v0 * side * 65536);
    int64_t  step_x = (int64_t)(((double)s->u1 - (double)s->u0) * side * 65536 / (count - 1));
    int64_t  step_y = (int64_t)(((double)s->v1 - (double)s->v0) * side * 65536 / (count - 1));
    float    sum = 0, most = best * (float)count;
    for (int i = 0; i < count && sum < most; i++, x += step_x, y += step_y)
        sum += crowd[((uint32_t)(y >> 16) & mask) * (mask + 1) + ((uint32_t)(x >> 16) & mask)];
    return sum / (float)count;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* Tones from the middle on are drawn across, until as much lies that way as the other, and then in turns. */
static int direction_of(const tam *t)
{
    bool across = t->options->cross && 2 * t->tone >= t->options->tones &&
                  t->drawn_length[TAM_ACROSS] < t->drawn_length[TAM_ALONG];
    return across ? TAM_ACROSS : TAM_ALONG;
}

/* A length for the next stroke; 0 when none is needed any more. Coarse levels get the longer ones, which would be
 * dots there otherwise. The last stroke is as long as the tone still needs. */
static double next_length(tam *t)
{
    const tam_options *w = t->options;
    double least = fmin(w->length, fmax(SHORTEST * w->length, LONG_ENOUGH * t->brush.width / t->levels[t->level].side));
    double length = least + (w->length - least) * random_unit(&t->random), missing = tam_missing(t);
    double needed = length * missing / tam_expected(t, t->level, length);
    if (needed < length)
        length = fmax(needed, SHORTEST * w->length);
    return missing > 0.5 * tam_expected(t, t->level, length) ? length : 0;
}

static texture_stroke stroke_at(tam *t, double u, double v, double length, int direction)
{
    double slope = SWAY * (double)t->options->uneven * random_hand(&t->random), unit = length / sqrt(1 + slope * slope);
    double along = unit, aside = unit * slope;
    texture_stroke s = {.u0 = (float)u, .v0 = (float)v};
    s.u1 = s.u0 + (float)(direction == TAM_ALONG ? along : aside);
    s.v1 = s.v0 + (float)(direction == TAM_ALONG ? aside : along);
    return s;
}

static size_t strokes_most(const tam *t)
{
    size_t side = (size_t)t->levels[t->level].side;
    return STROKES_A_TEXEL * side * side + 16;
}

/* Where strokes cover each other anyway and little paper is left, gaps are found by the ink: the crowd is as dense
 * everywhere by then, and the last gaps of a coarse level would take so many strokes that finer ones got too dark. */
static const float *what_fills(const tam *t, const tam_level *level, int direction)
{
    bool full = t->opacity < 1 && level->sum > 0.5 * (double)t->limit * level->side * level->side;
    return full ? level->ink : level->crowd[direction];
}

/* The part of a stroke that is as wide as strokes are: its ends fill no gaps. */
static texture_stroke middle_of(const texture_stroke *s)
{
    float du = 0.25f * (s->u1 - s->u0), dv = 0.25f * (s->v1 - s->v0);
    return (texture_stroke){.u0 = s->u0 + du, .v0 = s->v0 + dv, .u1 = s->u1 - du, .v1 = s->v1 - dv};
}

/* Tries positions in a band across strokes' direction and draws where it is least crowded. */
static bool put_best(tam *t, double length, int direction, double band, double thickness, int candidates)
{
    const tam_level *level = &t->levels[t->level];
    texture_stroke   best = {0};
    const float     *filled = what_fills(t, level, direction);
    float            least = INFINITY;
    for (int k = 0; k < candidates; k++) {
        double at = random_unit(&t->random), aside = band + thickness * random_unit(&t->random);
        aside -= floor(aside);
        texture_stroke s =
            stroke_at(t, direction == TAM_ALONG ? at : aside, direction == TAM_ALONG ? aside : at, length, direction);
        texture_stroke middle = middle_of(&s);
        float          crowd = crowd_along(level, filled, filled == level->ink ? &middle : &s, least);
        if (crowd < least) {
            least = crowd;
            best = s;
        }
    }
    return tam_put(t, best, direction);
}

bool tam_fill_best(tam *t)
{
    const tam_level *level = &t->levels[t->level];
    size_t           most = strokes_most(t);
    while (level->count < most) {
        int    direction = direction_of(t), candidates = CANDIDATES;
        double length = next_length(t);
        if (length <= 0)
            return true;
        if (level->count > CHOSEN_STROKES)
            candidates = (int)(CANDIDATES * CHOSEN_STROKES / level->count);
        if (!put_best(t, length, direction, 0, 1, candidates > CANDIDATES_LEAST ? candidates : CANDIDATES_LEAST))
            return false;
    }
    return true;
}

/* --- strips --------------------------------------------------------------------------------------------- */

static const double GOLDEN = 0.61803398875;

static size_t common_divisor(size_t a, size_t b)
{
    while (b > 0) {
        size_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* As many strips as strokes are needed, one stroke into each, until the tone is there. Strips are taken in steps of
 * the golden section, so that those that are left over at the end lie apart. Müller's strips are of an empty
 * picture; here there are strokes of lighter tones and coarser levels already, so that each stroke takes the best
 * of a few positions in its strip. */
bool tam_fill_strips(tam *t)
{
    const tam_options *w = t->options;
    double             inside = w->opacity < 1 ? 1 : STRIP_FRACTION;
    const tam_level   *level = &t->levels[t->level];
    size_t             most = strokes_most(t);
    while (level->count < most) {
        double needed = tam_missing(t) / tam_expected(t, t->level, 0.5 * (1 + SHORTEST) * w->length),
               from = random_unit(&t->random);
        size_t strips = needed > 1 ? (size_t)needed : 1, step = (size_t)((double)strips * GOLDEN) + 1, strip = 0;
        while (common_divisor(strips, step) > 1)
            step--;
        for (size_t i = 0; i < strips && level->count < most; i++, strip = (strip + step) % strips) {
            int    direction = direction_of(t);
            double length = next_length(t);
            if (length <= 0)
                return true;
            double band = from + ((double)strip + 0.5 * (1 - inside)) / (double)strips;
            if (!put_best(t, length, direction, band, inside / (double)strips, STRIP_CANDIDATES))
                return false;
        }
    }
    return true;
}
