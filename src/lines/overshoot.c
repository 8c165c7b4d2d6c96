/* Lines that run on, as a draughtsman's do who lifts the pencil behind the corner and not before it. A chain that
 * is straight for long enough before it meets others goes on in its own direction, and in space: where a surface
 * lies in front of the line's course it stays hidden, and outside the figure it has the depth that the edge itself
 * would have there. Goes past Nienhaus 2005, section 6, which perturbs lines but cannot lengthen them: edges of
 * pictures have no ends. */
#include "lines/overshoot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "lines/lines.h"

enum { WINDOW_MAX = 192, SIDES = 2 };

/* Lines shorter than this, in pixels as they are seen, are detail and end where they end; a line runs on by a fraction
 * of its length at most, and not by less than a dot. */
static const float LEAST_LINE = 20, OWN_FRACTION = 0.3f, LEAST_STROKE = 3;

/* The part of a chain that tells its direction, and how far it may bow: long ones first, then shorter ones that
 * must be straighter, so that arcs do not pass by their short pieces. */
static const struct {
    float span, bow;
} windows[] = {{150, 0.5f}, {90, 0.45f}, {40, 0.25f}};

/* Pixels at a chain's ends that other lines' ink has moved; of pointed junctions more. A chain needs this much
 * between its ends. */
static const float skips[] = {3, 6, 10};
static const float LEAST_SPAN = 12, MOST_OFF = 0.8f, LEAST_BOW = 0.25f, LEAST_RADIUS = 560;

/* What leaves within the first angle is the same line, and what leaves within the second is a bend of it, unless
 * its halves differ by the third. */
static const float SAME_TURN = 0.14f, BEND_TURN = 0.37f, ARC_TURN = 0.12f;
/* Ends this near to each other meet; and a point this far beside a line is not on it. */
static const int   MEETING = 3;
static const float OFF_LINE = 1.2f;

/* Lines that an arc touches must be this long, also in lengths of their extensions, since arcs look straight for a
 * while. */
static const float LEAST_TANGENT = 48, TANGENT_TIMES = 4, MOST_TANGENT = 128, TANGENT_BOW = 0.3f;

/* A extension that leaves other ink later than this leaves it at a small angle. Until shortly before it is not
 * drawn. */
static const float LEAVING = 8, LEAVING_FRACTION = 1.5f, BEFORE_LEAVING = 6, BEFORE_END = 2.5f;

typedef struct chain_end {
    uint32_t pixel;
    uint32_t chain;
    int      side; /* 0: the chain's beginning, 1: its end */
} chain_end;

typedef struct finding {
    const chain_set       *set;
    const pass_pixels     *in;
    const uint8_t         *ink;
    const overshoot_style *style;
    chain_end             *ends; /* joined ones, by pixel */
    size_t                 end_count;
    extension_set         *found;
} finding;

/* The k-th point from one side of a chain. */
static const trace_point *point_from(const finding *f, const chain *c, int side, size_t k)
{
    return &f->set->points[c->first + (side ? c->count - 1 - k : k)];
}

/* How far along the chain that is, from this side. */
static float arc_from(const chain *c, const trace_point *p, int side)
{
    return side ? c->length - p->along : p->along;
}

/* --- the direction of a chain's end --------------------------------------------------------------------- */

/* Points of a chain near its end. */
typedef struct window {
    const trace_point *points[WINDOW_MAX];
    size_t             count;
    float              x, y, dx, dy; /* middle, and direction towards the end */
} window;

static void gather(window *w, const finding *f, const chain *c, int side, float from, float to)
{
    w->count = 0;
    for (size_t k = 0; k < c->count && w->count < WINDOW_MAX; k++) {
        const trace_point *p = point_from(f, c, side, k);
        float              arc = arc_from(c, p, side);
        if (arc > to)
            break;
        if (arc >= from)
            w->points[w->count++] = p;
    }
}

/* The line that has the least squared distances to the points. */
static void fit(window *w)
{
    float xx = 0, xy = 0, yy = 0, n = (float)w->count;
    w->x = w->y = 0;
    for (size_t i = 0; i < w->count; i++) {
        w->x += w->points[i]->x / n;
        w->y += w->points[i]->y / n;
    }
    for (size_t i = 0; i < w->count; i++) {
        float x = w->points[i]->x - w->x, y = w->points[i]->y - w->y;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    float angle = 0.5f * atan2f(2 * xy, xx - yy);
    w->dx = cosf(angle);
    w->dy = sinf(angle);
    const trace_point *a = w->points[w->count - 1], *b = w->points[0]; /* the first is next to the end */
    if ((b->x - a->x) * w->dx + (b->y - a->y) * w->dy < 0) {
        w->dx = -w->dx;
        w->dy = -w->dy;
    }
}

/* How far the middle of the points stands out from a straight line, by the parabola that suits them best; infinite
 * when some point is off the line. */
static float bow_of(const window *w)
{
    float half = 0, sum = 0, square = 0, mean = 0, n = (float)w->count;
    for (size_t i = 0; i < w->count; i++) {
        float along = (w->points[i]->x - w->x) * w->dx + (w->points[i]->y - w->y) * w->dy;
        half = fmaxf(half, fabsf(along));
        mean += along * along / n;
    }
    for (size_t i = 0; i < w->count; i++) {
        float x = w->points[i]->x - w->x, y = w->points[i]->y - w->y, along = x * w->dx + y * w->dy,
              off = y * w->dx - x * w->dy;
        if (fabsf(off) > MOST_OFF)
            return INFINITY;
        float bent = along * along - mean;
        sum += bent * off;
        square += bent * bent;
    }
    return square > 0 ? fabsf(sum / square) * half * half : 0;
}

/* Is the chain straight where it comes to this side? Then `w` has its line. */
static bool find_line(window *w, const finding *f, const chain *c, int side)
{
    for (size_t i = 0; i < sizeof windows / sizeof *windows; i++) {
        if (i > 0 && c->length < windows[i].span)
            continue; /* all of it has been seen */
        for (size_t k = 0; k < sizeof skips / sizeof *skips; k++) {
            float from = skips[k], to = fminf(from + windows[i].span, c->length - skips[0]);
            if (to - from < LEAST_SPAN)
                break;
            gather(w, f, c, side, from, to);
            if (w->count < (size_t)LEAST_SPAN / 2)
                break;
            fit(w);
            /* Short pieces of arcs bow little; steps from pixel to pixel look as if they did. */
            if (bow_of(w) <= fminf(windows[i].bow, fmaxf(LEAST_BOW, (to - from) * (to - from) / (8 * LEAST_RADIUS))))
                return true;
        }
    }
    return false;
}

/* How far a point lies beside the window's line. */
static float beside(const window *w, const trace_point *p)
{
    return fabsf((p->y - w->y) * w->dx - (p->x - w->x) * w->dy);
}

/* --- what is around a chain's end ----------------------------------------------------------------------- */

static int by_pixel(const void *a, const void *b)
{
    const chain_end *p = a, *q = b;
    if (p->pixel != q->pixel)
        return p->pixel < q->pixel ? -1 : 1;
    if (p->chain != q->chain)
        return p->chain < q->chain ? -1 : 1;
    return p->side - q->side;
}

static bool gather_ends(finding *f)
{
    f->ends = mem_alloc((SIDES * f->set->chain_count + 1) * sizeof *f->ends);
    if (!f->ends)
        return false;
    for (uint32_t i = 0; i < f->set->chain_count; i++)
        for (int side = 0; side < SIDES; side++) {
            const chain *c = &f->set->chains[i];
            if (c->joined[side] && !c->closed)
                f->ends[f->end_count++] = (chain_end){point_from(f, c, side, 0)->pixel, i, side};
        }
    qsort(f->ends, f->end_count, sizeof *f->ends, by_pixel);
    return true;
}

/* The first end at this pixel or behind it. */
static size_t first_end(const finding *f, uint32_t pixel)
{
    size_t low = 0, high = f->end_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (f->ends[middle].pixel < pixel)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The angle from a direction to the way between two points. */
static float turn_between(float dx, float dy, const trace_point *a, const trace_point *b)
{
    float x = b->x - a->x, y = b->y - a->y;
    return atan2f(dx * y - dy * x, x * dx + y * dy);
}

/* Does this chain, from this point on, carry the extension's line on, or bend it a little? An arc that touches the
 * line does not. */
static bool carries_on(const finding *f, const chain *c, int side, size_t first, const extension *s)
{
    const trace_point *start = point_from(f, c, side, first), *middle = NULL, *end = start;
    float from = arc_from(c, start, side), arc = fminf(c->length - from, fminf(64, fmaxf(3 * s->length, 24)));
    if (arc < 5)
        return false;
    for (size_t k = first; k < c->count && arc_from(c, end, side) - from < arc; k++) {
        end = point_from(f, c, side, k);
        if (!middle && arc_from(c, end, side) - from >= 0.5f * arc)
            middle = end;
    }
    float turn = fabsf(turn_between(s->dx, s->dy, start, end));
    if (turn >= BEND_TURN || !middle)
        return false;
    return turn < SAME_TURN || fabsf(turn_between(middle->x - start->x, middle->y - start->y, middle, end)) < ARC_TURN;
}

static bool is_carried_on(const finding *f, const chain_end *own, const extension *s)
{
    int x = (int)(own->pixel % (uint32_t)f->in->width), y = (int)(own->pixel / (uint32_t)f->in->width);
    for (int row = y > MEETING ? y - MEETING : 0; row <= y + MEETING && row < f->in->height; row++) {
        int left = x > MEETING ? x - MEETING : 0, right = x + MEETING < f->in->width ? x + MEETING : f->in->width - 1;
        uint32_t last = (uint32_t)row * (uint32_t)f->in->width + (uint32_t)right;
        for (size_t i = first_end(f, last - (uint32_t)(right - left)); i < f->end_count && f->ends[i].pixel <= last;
             i++)
            if ((f->ends[i].chain != own->chain || f->ends[i].side != own->side) &&
                carries_on(f, &f->set->chains[f->ends[i].chain], f->ends[i].side, 0, s))
                return true;
    }
    return false;
}

/* Is there ink within a pixel of a position on the extension's line? */
static bool has_ink(const finding *f, const extension *s, float along)
{
    int x = (int)lroundf(s->x + along * s->dx), y = (int)lroundf(s->y + along * s->dy);
    for (int k = 0; k < 9; k++) {
        int column = x + k % 3 - 1, row = y + k / 3 - 1;
        if (column >= 0 && row >= 0 && column < f->in->width && row < f->in->height &&
            f->ink[(size_t)row * (size_t)f->in->width + (size_t)column])
            return true;
    }
    return false;
}

/* Lets the extension begin where it leaves the ink that is there; false when that goes on, or its outer part would
 * lie on other ink. */
static bool leave_ink(const finding *f, extension *s)
{
    float most = LEAVING_FRACTION * s->length + LEAVING;
    s->start = 0;
    while (s->start <= most && (has_ink(f, s, s->start) || has_ink(f, s, s->start + 1)))
        s->start += 1;
    if (s->start > most)
        return false;
    int all = 0, inked = 0;
    for (float along = s->start + 0.5f * s->length; along <= s->start + s->length; along += 1) {
        all++;
        inked += has_ink(f, s, along);
    }
    return 5 * inked <= 3 * all;
}

/* How long the line before the extension is, across junctions; not counted beyond `most`. */
static float length_before(const finding *f, const extension *s, float most)
{
    float last = 0;
    for (float along = 1; along <= most && along < last + 4; along += 1)
        if (has_ink(f, s, -along))
            last = along;
    return last;
}

/* --- length --------------------------------------------------------------------------------------------- */

static float hash_of(int x, int y)
{
    uint32_t h = (uint32_t)x * 0x9E3779B1u ^ (uint32_t)y * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    h ^= h >> 15;
    return (float)(h >> 8) / 16777216.0f;
}

/* What a extension's length is multiplied by: it goes with position and direction and changes slowly with both, so
 * that lines which move do not flicker, and with the length asked for, so that it is the same at every resolution. */
static float variation_at(const finding *f, const extension *s)
{
    float cell = 2 * f->style->length + 1;
    float x = (s->x + (float)f->in->x) / cell + 5 * s->dx, y = (s->y + (float)f->in->y) / cell + 5 * s->dy;
    int   column = (int)floorf(x), row = (int)floorf(y);
    float fx = x - (float)column, fy = y - (float)row;
    float low = hash_of(column, row) * (1 - fx) + hash_of(column + 1, row) * fx;
    float high = hash_of(column, row + 1) * (1 - fx) + hash_of(column + 1, row + 1) * fx;
    float mean = (low * (1 - fy) + high * fy - 0.5f) * 3; /* means of four are seldom far from the middle */
    return 1 + OVERSHOOT_VARIATION * fminf(1, fmaxf(-1, mean));
}

/* --- depth ---------------------------------------------------------------------------------------------- */

/* Eye depth of the nearest surface within a pixel of this one, or of the pixel alone; 0 where there is none. */
static float surface_at(const finding *f, int x, int y, int reach)
{
    float nearest = 0;
    for (int row = y - reach; row <= y + reach; row++)
        for (int column = x - reach; column <= x + reach; column++) {
            if (column < 0 || row < 0 || column >= f->in->width || row >= f->in->height)
                continue;
            float depth = f->in->values[1][4 * ((size_t)row * (size_t)f->in->width + (size_t)column) + 3];
            if (depth > 0 && (nearest == 0 || depth < nearest))
                nearest = depth;
        }
    return nearest;
}

static int by_value(const void *a, const void *b)
{
    float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

static float median_of(float *values, size_t count)
{
    qsort(values, count, sizeof *values, by_value);
    return values[count / 2];
}

static float depth_along(const finding *f, const extension *s, float along)
{
    float value = s->depth + along * s->slope;
    return f->in->perspective ? value > 0 ? 1 / value : INFINITY : value;
}

/* The line's depth, which is straight in space and so (in perspective its inverse) on the picture. Medians: other
 * lines' surfaces come near some of its points. */
static void find_depth(const finding *f, const window *w, extension *s)
{
    float  along[WINDOW_MAX], depth[WINDOW_MAX], values[WINDOW_MAX];
    size_t n = 0;
    for (size_t i = 0; i < w->count && f->in->values[1]; i++) {
        const trace_point *p = w->points[i];
        float              surface = surface_at(f, (int)lroundf(p->x), (int)lroundf(p->y), 1);
        if (surface <= 0)
            continue;
        along[n] = (p->x - s->x) * s->dx + (p->y - s->y) * s->dy;
        depth[n++] = f->in->perspective ? 1 / surface : surface;
    }
    if (n < 4)
        return;
    size_t half = n / 2;
    for (size_t i = 0; i < half; i++)
        values[i] = (depth[i] - depth[i + n - half]) / (along[i] - along[i + n - half]);
    s->slope = median_of(values, half);
    for (size_t i = 0; i < n; i++)
        values[i] = depth[i] - s->slope * along[i];
    s->depth = median_of(values, n);
}

/* Ends the extension where a surface of its figure is in front of it: a line that is hidden does not come out
 * again. Surfaces that it touches, or hardly dives into, as it does in a concave corner, do not count. */
static void end_where_hidden(const finding *f, extension *s)
{
    for (float along = 2; along <= s->length && s->depth > 0; along += 1) {
        int   x = (int)lroundf(s->x + along * s->dx), y = (int)lroundf(s->y + along * s->dy);
        float surface = surface_at(f, x, y, 0), depth = depth_along(f, s, along);
        float pixel = f->in->pixel * (f->in->perspective ? surface : 1);
        if (surface > 0 && surface < depth - pixel * (3 + 2 * along))
            s->length = along - 1;
    }
}

/* --- extensions ----------------------------------------------------------------------------------------- */

/* The line's ink: its classes, each as strong as it is on average. */
static void find_classes(const finding *f, const window *w, extension *s)
{
    static const int channels[OVERSHOOT_CLASSES] = {0, 1, 3};
    for (int k = 0; k < OVERSHOOT_CLASSES; k++) {
        for (size_t i = 0; i < w->count; i++)
            s->ink[k] +=
                1 - fminf(1, fmaxf(0, f->in->values[0][4 * (size_t)w->points[i]->pixel + (size_t)channels[k]]));
        s->ink[k] /= (float)w->count;
        if (s->ink[k] < 0.1f) /* what other lines left */
            s->ink[k] = 0;
    }
}

/* Lines of surfaces that other figures draw run on there. */
static bool is_own(const finding *f, const window *w)
{
    size_t count = 0;
    for (size_t i = 0; i < w->count && f->in->own; i++) {
        int x = (int)lroundf(w->points[i]->x), y = (int)lroundf(w->points[i]->y), found = 0;
        for (int row = y - 1; row <= y + 1; row++)
            for (int column = x - 1; column <= x + 1; column++)
                if (column >= 0 && row >= 0 && column < f->in->width && row < f->in->height)
                    found |= f->in->own[(size_t)row * (size_t)f->in->width + (size_t)column];
        count += found != 0;
    }
    return !f->in->own || 2 * count > w->count;
}

/* A point of a chain where a line ends that runs on: what lies before it, the way that `side` looks, goes
 * elsewhere. */
typedef struct line_end {
    const chain     *chain;
    int              side;
    size_t           position; /* of the point, from that side */
    const chain_end *meets;    /* the chain's end, or NULL where an arc of the same chain touches the line */
} line_end;

static bool is_needed(const finding *f, const line_end *e, extension *s)
{
    if (s->length < LEAST_STROKE * f->in->scale)
        return false;
    bool carried = e->meets ? is_carried_on(f, e->meets, s)
                            : carries_on(f, e->chain, !e->side, e->chain->count - 1 - e->position, s);
    if (carried || !leave_ink(f, s))
        return false;
    if (e->meets && s->start <= LEAVING) /* what leaves at once is measured from the corner */
        s->start = 0;
    return true;
}

/* Adds the extension by which a line runs on, unless it should not. False when memory is gone. */
static bool add_stroke(const finding *f, const window *w, const line_end *e)
{
    const trace_point *end = point_from(f, e->chain, e->side, e->position);
    float              along = (end->x - w->x) * w->dx + (end->y - w->y) * w->dy;
    extension          s = {
                 .x = w->x + along * w->dx, .y = w->y + along * w->dy, .dx = w->dx, .dy = w->dy, .length = f->style->length};
    s.length *= variation_at(f, &s);
    float line = length_before(f, &s, s.length / OWN_FRACTION);
    s.length = fminf(s.length, OWN_FRACTION * fmaxf(e->meets ? e->chain->length : 0, line));
    if (!is_own(f, w) || !is_needed(f, e, &s))
        return true;
    s.length += s.start;
    find_depth(f, w, &s);
    end_where_hidden(f, &s);
    find_classes(f, w, &s);
    if (s.length - s.start < LEAST_STROKE * f->in->scale)
        return true;
    if (!mem_grow((void **)&f->found->extensions, &f->found->capacity, f->found->count + 1,
                  sizeof *f->found->extensions))
        return false;
    f->found->extensions[f->found->count++] = s;
    return true;
}

/* The nearest point to a side of the chain that is on the window's line, from `position` on towards the side. */
static size_t position_on_line(const finding *f, const window *w, const chain *c, int side, size_t position,
                               bool outwards)
{
    while (outwards && position > 0 && beside(w, point_from(f, c, side, position - 1)) <= OFF_LINE)
        position--;
    while (!outwards && position + 1 < c->count && beside(w, point_from(f, c, side, position)) > OFF_LINE)
        position++;
    return position;
}

/* The extension at an end of a chain, where the line meets others. */
static bool add_at_end(const finding *f, const chain_end *e)
{
    const chain *c = &f->set->chains[e->chain];
    window       w;
    if (c->broad || c->length < LEAST_LINE * f->in->scale || !find_line(&w, f, c, e->side))
        return true;
    return add_stroke(f, &w, &(line_end){c, e->side, position_on_line(f, &w, c, e->side, 0, false), e});
}

/* Is the chain straight from this point, which lies at this way, to `span` behind it? Asks its middle first, which
 * is quick. */
static bool is_straight(window *w, const finding *f, const chain *c, int side, size_t position, float span)
{
    const trace_point *a = point_from(f, c, side, position);
    float              arc = arc_from(c, a, side);
    size_t             last = position + (size_t)(0.7f * span); /* at least as many points on any slope */
    if (last >= c->count)
        return false;
    const trace_point *b = point_from(f, c, side, (position + last) / 2), *d = point_from(f, c, side, last);
    float              dx = d->x - a->x, dy = d->y - a->y;
    if (fabsf((b->x - a->x) * dy - (b->y - a->y) * dx) > 1.2f * hypotf(dx, dy))
        return false;
    gather(w, f, c, side, arc, arc + span);
    fit(w);
    return bow_of(w) <= TANGENT_BOW;
}

/* Strokes inside a chain, where a long straight line ends in an arc that it touches: a cylinder's side at the rim. */
static bool add_tangents(const finding *f, const chain *c, int side)
{
    float span = fminf(fmaxf(LEAST_TANGENT, TANGENT_TIMES * f->style->length), MOST_TANGENT);
    bool  was_straight = false, good = true;
    for (size_t k = 0; k < c->count && good && !c->broad;) {
        const trace_point *p = point_from(f, c, side, k);
        if (arc_from(c, p, side) + span > c->length)
            break;
        window w;
        bool   straight = is_straight(&w, f, c, side, k, span);
        if (straight && !was_straight) {
            size_t position = position_on_line(f, &w, c, side, k, true);
            if (arc_from(c, point_from(f, c, side, position), side) >
                skips[2]) /* lines at the chain's end have been seen to */
                good = add_stroke(f, &w, &(line_end){c, side, position, NULL});
        }
        was_straight = straight;
        k += straight ? (size_t)(0.5f * span) : 3;
    }
    return good;
}

bool overshoot_find(extension_set *out, const chain_set *set, const pass_pixels *in, const uint8_t *ink,
                    const overshoot_style *style)
{
    finding f = {.set = set, .in = in, .ink = ink, .style = style, .found = out};
    *out = (extension_set){0};
    bool good = gather_ends(&f);
    for (size_t i = 0; i < f.end_count && good; i++)
        good = add_at_end(&f, &f.ends[i]);
    for (size_t i = 0; i < SIDES * set->chain_count && good; i++)
        good = add_tangents(&f, &set->chains[i / SIDES], (int)(i % SIDES));
    mem_free(f.ends);
    if (!good)
        overshoot_release(out);
    return good;
}

void overshoot_release(extension_set *s)
{
    mem_free(s->extensions);
    *s = (extension_set){0};
}

/* --- painting ------------------------------------------------------------------------------------------- */

/* The pencil's pressure along a extension: it is lifted towards the tip. Broad pens end bluntly. */
static float pressure_at(const extension *s, const overshoot_style *style, float along)
{
    float t = (along - s->start) / (s->length - s->start);
    t = fminf(1, fmaxf(0, (t - 0.35f) / 0.65f));
    return 1 - style->fade * t * t;
}

static uint32_t with_ink(uint32_t packed, const extension *s, float fraction)
{
    for (int k = 0; k < OVERSHOOT_CLASSES; k++) {
        uint32_t shift = 8 * (uint32_t)k, ink = (uint32_t)(fraction * s->ink[k] * 255 + 0.5f);
        if (ink > (packed >> shift & 255))
            packed = (packed & ~(255u << shift)) | ink << shift;
    }
    return packed;
}

/* The nearer of two depths as bits of floats; 0 is none. */
static uint32_t with_depth(uint32_t before, float depth)
{
    uint32_t bits;
    memcpy(&bits, &depth, sizeof bits);
    return depth > 0 && isfinite(depth) && (before == 0 || bits < before)
               ? bits
               : before; /* floats above 0 are ordered as their bits */
}

typedef struct painter {
    const extension       *extension;
    const overshoot_style *style;
    bool                   perspective;
} painter;

static void paint_pixel(const painter *p, uint32_t *out, float x, float y)
{
    const extension *s = p->extension;
    float along = (x - s->x) * s->dx + (y - s->y) * s->dy, off = fabsf((y - s->y) * s->dx - (x - s->x) * s->dy);
    if (off > p->style->spread || along < -p->style->spread || along > s->length + p->style->spread)
        return;
    /* It begins before the end of the line, which need not reach into the corner. */
    float first = s->start > 0 ? s->start - BEFORE_LEAVING : -BEFORE_END;
    float inside = fminf(fminf(0.5f * p->style->width + 0.5f - off, s->length + 0.5f - along), along - first);
    if (inside > 0)
        out[0] = with_ink(out[0], s, fminf(1, inside) * pressure_at(s, p->style, along));
    if (s->depth > 0) {
        float value = s->depth + along * s->slope;
        out[1] = with_depth(out[1], p->perspective ? 1 / value : value);
    }
}

/* Pixels of a row that a extension reaches, at most. */
static void span_of(const extension *s, float spread, float y, float out[2])
{
    float low = fminf(0, s->length * s->dx), high = fmaxf(0, s->length * s->dx);
    out[0] = s->x + low - spread;
    out[1] = s->x + high + spread;
    if (fabsf(s->dy) < 0.2f)
        return;
    float middle = s->x + (y - s->y) * s->dx / s->dy, half = spread / fabsf(s->dy);
    out[0] = fmaxf(out[0], middle - half);
    out[1] = fminf(out[1], middle + half);
}

void overshoot_paint(uint32_t *out, const pass_pixels *in, const extension_set *set, const overshoot_style *style)
{
    for (size_t i = 0; i < set->count; i++) {
        const extension *s = &set->extensions[i];
        painter          p = {s, style, in->perspective};
        float            low = s->y + fminf(0, s->length * s->dy) - style->spread,
              high = s->y + fmaxf(0, s->length * s->dy) + style->spread;
        for (int y = low > 0 ? (int)low : 0; y <= (int)high && y < in->height; y++) {
            float span[2];
            span_of(s, style->spread, (float)y, span);
            for (int x = span[0] > 0 ? (int)span[0] : 0; x <= (int)span[1] && x < in->width; x++)
                paint_pixel(&p, &out[2 * ((size_t)y * (size_t)in->width + (size_t)x)], (float)x, (float)y);
        }
    }
}

/* --- the pass ------------------------------------------------------------------------------------------- */

/* How far beside the detected line its ink may come to lie once it has grown and been moved, and what is added to
 * be safe. */
static float spread_of(const lines_common *lines)
{
    float moved = fmaxf(fabsf(lines->offset_x), fabsf(lines->offset_y));
    return 0.5f * lines->width + 3 + (lines->contrast > 0 ? fmaxf(moved, lines->width) : 0);
}

bool overshoot_process(const pass_pixels *in, void *out, const void *values)
{
    const lines_common *lines = values;
    overshoot_style     style = {lines->overshoot, fminf(fmaxf(lines->width, 1), 2), spread_of(lines),
                                 0.75f * fminf(1, 2.5f * in->scale / lines->width)};
    size_t              count = (size_t)in->width * (size_t)in->height;
    uint32_t           *words = out;
    for (size_t i = 0; i < count;
         i++) /* other techniques' ink is drawn already; how deep it lies must be known to the end */
        words[2 * i] = 0;
    chain_set     chains = {0};
    extension_set extensions = {0};
    uint8_t      *ink = mem_alloc(count);
    if (ink)
        lines_find_ink(ink, in->values[0], count, lines);
    bool good = ink && chains_trace(&chains, ink, in->width, in->height, LINES_SPUR) &&
                overshoot_find(&extensions, &chains, in, ink, &style);
    if (good)
        overshoot_paint(words, in, &extensions, &style);
    overshoot_release(&extensions);
    chains_release(&chains);
    mem_free(ink);
    return good;
}
