/* How a hand draws strokes: pull by pull, from corner to corner, long curves in several that overlap. Each pull that is
 * drawn again is drawn anew: with ends of its own, some short of the corner and some beyond it, at a small angle to the
 * one before, so that both cross, with a little bow and its own pressure. What is short is drawn once, and nothing runs
 * on by more than a fraction of its own length: small parts stay legible. Circles begin where the hand likes, and their
 * ends miss each other.
 *
 * After how sketching is taught and how it has been imitated: several strokes an edge that cross and run past corners
 * (Curtis 1998). What is random belongs to the stroke's id,
 * so that it stays from frame to frame as long as a chain has the same corners. */
#include <math.h>

#include "base/memory.h"
#include "stroke/ribbon_private.h"

/* A corner turns by more than 39° within 0.8 mm: rounder ones are drawn in one go. */
static const float corner_cosine = 0.777f, corner_reach = 1.5f;
static const float near_fraction = 0.25f; /* how far the first copy lies off, of what the others do */
static const float lap_fraction = 0.12f;  /* of a piece, by which it overlaps the next one */
static const float lap_most = 9;
static const float straight_most = 0.997f; /* chord over length of what is drawn in one go, however long */
static const float met_fraction = 0.25f;   /* of corners, at which a line ends as it should */
static const float crowded_pen = 0.85f;    /* lines that yield more are drawn once */

static const float least_apart = 0.2f; /* what is left where lines run side by side */

/* What is random of a piece. */
enum {
    RANDOM_COUNT = 100,
    RANDOM_CUT,
    RANDOM_ROUND,
    RANDOM_TILT,
    RANDOM_SHIFT,
    RANDOM_BOW,
    RANDOM_WEIGHT,
    RANDOM_SIDE,
    RANDOM_BEYOND,
    RANDOM_SHORT = RANDOM_BEYOND + 2,
    RANDOM_CORNER = RANDOM_SHORT + 2
};

/* --- pulls ---------------------------------------------------------------------------------------------- */

static void add_point(hand_pulls *p, stroke_point point)
{
    if (p->failed || !mem_grow((void **)&p->points, &p->point_capacity, p->point_count + 1, sizeof *p->points)) {
        p->failed = true;
        return;
    }
    p->points[p->point_count++] = point;
}

static void add_pull(hand_pulls *p, uint32_t from, uint32_t to, bool begins, bool ends)
{
    if (to <= from)
        return;
    if (p->failed || !mem_grow((void **)&p->items, &p->capacity, p->count + 1, sizeof *p->items)) {
        p->failed = true;
        return;
    }
    p->items[p->count++] = (hand_pull){from, to - from + 1, {begins, ends}};
}

/* The next corner from a point on, and before `end`; of points near each other the one that turns most. 0: none. */
static uint32_t next_corner(const hand_pulls *p, uint32_t from, uint32_t end)
{
    uint32_t found = 0;
    float    sharpest = corner_cosine;
    for (uint32_t k = from; k < end; k++) {
        if (found && p->points[k].arc - p->points[found].arc > 2 * corner_reach)
            break;
        float turn = ribbon_turn(p->points, (uint32_t)p->point_count, k, corner_reach);
        if (turn < sharpest) {
            sharpest = turn;
            found = k;
        }
    }
    return found;
}

/* The first point at least so far along. */
static uint32_t point_after(const hand_pulls *p, uint32_t from, float arc)
{
    while (from < p->point_count && p->points[from].arc < arc)
        from++;
    return from;
}

static void cut_open(hand_pulls *p)
{
    uint32_t last = (uint32_t)p->point_count - 1, begin = 0, from = 1;
    for (uint32_t corner; (corner = next_corner(p, from, last)) != 0;) {
        add_pull(p, begin, corner, begin > 0, true);
        begin = corner;
        from = point_after(p, corner + 1, p->points[corner].arc + 2 * corner_reach);
    }
    add_pull(p, begin, last, begin > 0, false);
}

/* Of closed ones, in the second time round. */
static void cut_closed(hand_pulls *p, uint32_t pieces)
{
    uint32_t first = next_corner(p, pieces, 2 * pieces), begin = first;
    p->round = first == 0;
    if (p->round) {
        add_pull(p, 0, (uint32_t)p->point_count - 1, true, true);
        return;
    }
    while (begin < first + pieces) {
        uint32_t from = point_after(p, begin + 1, p->points[begin].arc + 2 * corner_reach), end = first + pieces;
        uint32_t corner = from < end ? next_corner(p, from, end) : 0;
        corner = corner && p->points[end].arc - p->points[corner].arc > 2 * corner_reach ? corner : end;
        add_pull(p, begin, corner, true, true);
        begin = corner;
    }
}

void hand_pulls_find(hand_pulls *out, const stroke_set *set, const stroke *s)
{
    const stroke_point *points = &set->points[s->first];
    out->point_count = out->count = 0;
    out->round = false;
    out->loop = s->closed && s->count > 3 ? points[s->count - 1].arc - points[0].arc : 0;
    if (!(out->loop > 0 && isfinite(out->loop))) {
        out->loop = 0;
        for (uint32_t k = 0; k < s->count; k++)
            add_point(out, points[k]);
        if (!out->failed)
            cut_open(out);
        return;
    }
    for (uint32_t k = 0, pieces = s->count - 1; k <= HAND_ROUNDS * pieces; k++) {
        stroke_point p = points[k % pieces];
        p.arc += (float)(k / pieces) * out->loop;
        add_point(out, p);
    }
    if (!out->failed)
        cut_closed(out, s->count - 1);
}

void hand_pulls_release(hand_pulls *p)
{
    mem_free(p->points);
    mem_free(p->items);
    *p = (hand_pulls){0};
}

/* --- pieces --------------------------------------------------------------------------------------------- */

bool hand_draws(const stroke_style *style)
{
    return style->overshoot > 0 || style->repeats > 1 || style->pull > 0;
}

int hand_copies(const stroke_style *style, float length, float pen)
{
    int most = style->repeats > 1 ? style->repeats : 1;
    if (!(style->repeat_least > 0) || most == 1)
        return most;
    float share = pen < crowded_pen ? 0 : fminf(fmaxf(length / style->repeat_least - 1, 0), 1);
    return 1 + (int)((float)(most - 1) * share + 0.5f);
}

stroke_style hand_style_in(const stroke_style *style, hand_space space)
{
    stroke_style out = *style;
    out.repeat_apart *= least_apart + (1 - least_apart) * space.copies;
    out.overshoot *= space.beyond;
    if (style->repeats > 1)
        out.repeats = 1 + (int32_t)((float)(style->repeats - 1) * space.copies + 0.5f);
    return out;
}

static float length_of(const hand_pulls *p, const hand_pull *pull)
{
    return p->round ? p->loop : p->points[pull->first + pull->count - 1].arc - p->points[pull->first].arc;
}

int hand_piece_count(const stroke_style *style, const hand_pulls *p, const hand_pull *pull, uint64_t key)
{
    const stroke_point *a = &p->points[pull->first], *b = &p->points[pull->first + pull->count - 1];
    float               length = length_of(p, pull);
    bool                straight = !p->round && hypotf(b->x - a->x, b->y - a->y) > straight_most * length;
    if (!(style->pull > 0) || straight || !isfinite(length))
        return 1;
    float count = length / style->pull + 0.5f + 0.35f * ribbon_random(key, RANDOM_COUNT);
    return (int)fminf(fmaxf(count, 1), HAND_PIECES_MOST);
}

static stroke_point position_at(const hand_pulls *p, const hand_pull *pull, float arc)
{
    uint32_t low = pull->first, high = pull->first + pull->count - 1;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (p->points[middle].arc <= arc)
            low = middle;
        else
            high = middle;
    }
    stroke_point a = p->points[low], b = p->points[high];
    float        t = b.arc > a.arc ? fminf(fmaxf((arc - a.arc) / (b.arc - a.arc), 0), 1) : 0;
    a.x += t * (b.x - a.x);
    a.y += t * (b.y - a.y);
    return a;
}

static bool hand_restates(const stroke_style *style)
{
    return style->repeats > 1 || style->pull > 0;
}

/* Where a copy lies across the true line, fraction of what copies may lie off: spread out, so that two that follow each
 * other are never on top of each other. */
static float shift_of(uint64_t key, int copy)
{
    static const float places[] = {0, 0.36f, -0.36f, 0.14f, -0.2f};
    float              spread = places[copy % (int)(sizeof places / sizeof *places)];
    return fminf(fmaxf(spread + 0.1f * ribbon_random(key, RANDOM_SHIFT), -0.4f), 0.4f);
}

/* Copies by turns lean to one side and to the other: neighbours always cross, off their middle. */
static void lean(const stroke_style *style, const hand_pulls *p, const hand_pull *pull, uint64_t key, int copy,
                 hand_piece *out)
{
    float length = out->to - out->from, off = style->repeat_apart * (copy > 0 ? 1 : near_fraction);
    if (!hand_restates(style) || !(off > 0) || !(length > 0))
        return;
    if (style->repeat_turn > 0)
        off = fminf(off, sinf(style->repeat_turn * (3.14159265f / 180)) * length / 1.2f);
    stroke_point a = position_at(p, pull, out->from), b = position_at(p, pull, out->to);
    float x = b.x - a.x, y = b.y - a.y, chord = hypotf(x, y), angle = 3.1415927f * ribbon_random(key, RANDOM_SIDE);
    bool  along = chord > 0.5f * length;
    float aside[2] = {along ? -y / chord : cosf(angle), along ? x / chord : sinf(angle)};
    float tilt = 0.45f + 0.15f * ribbon_random(key, RANDOM_TILT), shift = shift_of(key, copy);
    float bow = 0.3f * ribbon_random(key, RANDOM_BOW), side = copy % 2 ? 1 : -1;
    for (int axis = 0; axis < 2; axis++) {
        out->lean[0][axis] = off * (shift - side * tilt) * aside[axis];
        out->lean[1][axis] = off * (shift + side * tilt) * aside[axis];
        out->bow[axis] = off * bow * aside[axis];
    }
}

hand_piece hand_piece_of(const stroke_style *style, const hand_pulls *p, const hand_pull *pull, uint64_t key, int copy,
                         int index, int count)
{
    float      length = length_of(p, pull), each = length / (float)count, begin = p->points[pull->first].arc;
    hand_piece out = {.opacity = 1};
    /* Where a curve is cut is each copy's own. */
    uint64_t copied = key + 131071 * (uint64_t)(unsigned)copy, own = copied + 977 * (uint64_t)(unsigned)index;
    float    wander = count > 1 ? 0.2f * each * ribbon_random(copied, RANDOM_CUT) : 0;
    float    lap = fminf(lap_fraction * each, lap_most);
    if (p->round)
        begin += length * (1.5f + 0.5f * ribbon_random(copied, RANDOM_ROUND));
    out.inside[0] = index > 0 || p->round;
    out.inside[1] = index + 1 < count || p->round;
    out.from = begin + each * (float)index + (out.inside[0] ? wander - lap : 0);
    out.to = begin + each * (float)(index + 1) + (out.inside[1] ? wander + lap : 0);
    lean(style, p, pull, own, copy, &out);
    out.weight = 1 + 0.4f * style->pressure * ribbon_random(own, RANDOM_WEIGHT);
    if (style->repeat_fade > 0)
        out.opacity = powf(style->repeat_fade, (float)copy);
    return out;
}

/* How far beyond a corner, fraction of the overshoot: one corner in four is met, a few are left far behind. */
static float corner_share(uint64_t key, bool at_end, int copy)
{
    float at = 0.5f + 0.5f * ribbon_random(key, RANDOM_CORNER + at_end);
    if (at < met_fraction)
        return 0;
    float share = (at - met_fraction) / (1 - met_fraction);
    return (copy > 0 ? 0.85f : 1) * (0.25f + 1.35f * share * share);
}

float hand_run_on(const stroke_style *style, const hand_piece *piece, bool at_end, bool straight, uint64_t key,
                  int copy)
{
    float random = ribbon_random(key, RANDOM_BEYOND + at_end), length = piece->to - piece->from, by = 0;
    float most = (style->overshoot_most > 0 ? style->overshoot_most : 1) * length;
    if (style->overshoot > 0 && straight)
        by = style->overshoot * (hand_restates(style) ? corner_share(key, at_end, copy) : 0.75f + 0.25f * random);
    if (style->repeats > 1 && copy > 0) /* some fall short */
        by += style->repeat_apart * (0.1f + 0.9f * ribbon_random(key, RANDOM_SHORT + at_end));
    return fmaxf(fminf(by, most), -0.5f * fminf(most, 0.2f * length));
}
