#include "draft/pitch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "draft/cylinder_fit.h"

enum { GROUP_MOST = 24, LONELY_LEAST = 5, LEAST = 3 };
static const double pi = 3.14159265358979323846;
static const double same = 2e-3;       /* of the circle's radius: what may be off */
static const double aligned = 0.99999; /* cosine between axes that are parallel */
static const double alike = 1e-3;      /* of radii that are one size */

typedef struct search {
    const draft_cylinders *all;
    draft_pitches         *out;
    size_t                 group[GROUP_MOST]; /* cylinders of one size and direction in one part */
    size_t                 count;
    cylinder_fit           frame;
    double                 at[GROUP_MOST][2]; /* where they are across the axis */
} search;

static void middle_of(const draft_cylinder *c, double out[3])
{
    vector3_mix(out, c->ends[0], c->ends[1], 0.5);
}

static bool are_parallel(const draft_cylinder *a, const draft_cylinder *b)
{
    return fabs(vector3_dot(a->axis, b->axis)) > aligned;
}

/* One part, one size, side by side. */
static bool are_alike(const draft_cylinder *a, const draft_cylinder *b)
{
    double p[3], q[3];
    middle_of(a, p);
    middle_of(b, q);
    vector3_add(p, p, -1, q);
    double height = vector3_distance(a->ends[0], a->ends[1]), other = vector3_distance(b->ends[0], b->ends[1]);
    return a->part == b->part && a->hollow == b->hollow && a->cone == b->cone &&
           fabs(a->radius - b->radius) < alike * a->radius && are_parallel(a, b) &&
           fabs(vector3_dot(p, a->axis)) < 0.25 * (height + other);
}

static void place(const search *s, const double p[3], double out[2])
{
    double d[3];
    vector3_add(d, p, -1, s->frame.centre);
    for (int k = 0; k < 2; k++)
        out[k] = vector3_dot(d, s->frame.across[k]);
}

/* The members at one distance from a place, by angle; returns how many. */
typedef struct spoke {
    double angle;
    size_t member;
} spoke;

static int compare_spokes(const void *a, const void *b)
{
    const spoke *x = a, *y = b;
    return x->angle < y->angle ? -1 : x->angle > y->angle ? 1 : x->member < y->member ? -1 : x->member > y->member;
}

static size_t spokes_at(const search *s, const double centre[2], double radius, spoke *out)
{
    size_t count = 0;
    for (size_t i = 0; i < s->count; i++) {
        double x = s->at[i][0] - centre[0], y = s->at[i][1] - centre[1];
        if (s->out->of_cylinder[s->group[i]] < 0 && fabs(hypot(x, y) - radius) < same * radius)
            out[count++] = (spoke){atan2(y, x), i};
    }
    qsort(out, count, sizeof *out, compare_spokes);
    return count;
}

/* Are gaps all equal, or all but one that is a whole number of them? Returns how many gaps go round, 0: no; `first`
 * gets the spoke behind the large gap. */
static size_t steps_of(const spoke *spokes, size_t count, size_t *first)
{
    double least = 2 * pi;
    *first = 0;
    for (size_t i = 0; i < count; i++) {
        double gap = spokes[(i + 1) % count].angle - spokes[i].angle + (i + 1 == count ? 2 * pi : 0);
        least = fmin(least, gap);
    }
    double steps = round(2 * pi / least), step = 2 * pi / steps;
    size_t large = 0;
    if (steps > 2 * (double)count)
        return 0;
    for (size_t i = 0; i < count; i++) {
        double gap = spokes[(i + 1) % count].angle - spokes[i].angle + (i + 1 == count ? 2 * pi : 0);
        if (fabs(remainder(gap, step)) > 2 * same)
            return 0;
        if (gap > 1.5 * step) {
            large++;
            *first = (i + 1) % count;
        }
    }
    return large <= 1 ? (size_t)steps : 0;
}

/* Takes the circle around a place through a member, if that is one with at least so many. */
static lmn_status try_circle(search *s, const double centre[2], size_t member, bool has_middle, size_t least,
                             lmn_error *error)
{
    spoke  spokes[GROUP_MOST];
    size_t first;
    double radius = hypot(s->at[member][0] - centre[0], s->at[member][1] - centre[1]);
    if (!(radius > s->all->items[s->group[member]].radius * 1.01))
        return LMN_OK;
    size_t count = spokes_at(s, centre, radius, spokes), steps = count >= LEAST ? steps_of(spokes, count, &first) : 0;
    if (!steps || count < least || (!has_middle && (count < LONELY_LEAST || steps != count)))
        return LMN_OK;
    draft_pitch p = {.radius = radius,
                     .count = count,
                     .steps = steps,
                     .part = s->all->items[s->group[0]].part,
                     .from = spokes[first].angle,
                     .sweep = steps == count ? 2 * pi : 2 * pi / (double)steps * (double)(count - 1)};
    vector3_copy(p.axis, s->frame.axis);
    memcpy(p.across, s->frame.across, sizeof p.across);
    vector3_add(p.centre, s->frame.centre, centre[0], s->frame.across[0]);
    vector3_add(p.centre, p.centre, centre[1], s->frame.across[1]);
    if (!mem_grow((void **)&s->out->items, &s->out->capacity, s->out->count + 1, sizeof *s->out->items))
        return error_memory(error);
    for (size_t i = 0; i < count; i++)
        s->out->of_cylinder[s->group[spokes[i].member]] = (int32_t)s->out->count;
    s->out->items[s->out->count++] = p;
    return LMN_OK;
}

/* Around what is round: bores and shafts that are parallel. */
static lmn_status search_around_axes(search *s, size_t least, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < s->all->count && status == LMN_OK; i++) {
        const draft_cylinder *c = &s->all->items[i];
        double                centre[2];
        const draft_cylinder *member = &s->all->items[s->group[0]];
        if (!are_parallel(c, member) || are_alike(c, member)) /* of a grid of bores each lies between four */
            continue;
        place(s, c->ends[0], centre);
        for (size_t k = 0; k < s->count && status == LMN_OK; k++)
            status = try_circle(s, centre, k, true, least, error);
    }
    return status;
}

static bool circle_through(const double a[2], const double b[2], const double c[2], double out[2])
{
    double x1 = b[0] - a[0], y1 = b[1] - a[1], x2 = c[0] - a[0], y2 = c[1] - a[1], d = 2 * (x1 * y2 - x2 * y1);
    double s1 = x1 * x1 + y1 * y1, s2 = x2 * x2 + y2 * y2;
    if (!(fabs(d) > 1e-3 * fmax(s1, s2)))
        return false;
    out[0] = a[0] + (y2 * s1 - y1 * s2) / d;
    out[1] = a[1] + (x1 * s2 - x2 * s1) / d;
    return true;
}

static lmn_status search_alone(search *s, size_t least, lmn_error *error)
{
    lmn_status status = LMN_OK;
    double     centre[2];
    for (size_t a = 0; a < s->count; a++)
        for (size_t b = a + 1; b < s->count; b++)
            for (size_t c = b + 1; c < s->count && status == LMN_OK; c++)
                if (s->out->of_cylinder[s->group[a]] < 0 && circle_through(s->at[a], s->at[b], s->at[c], centre))
                    status = try_circle(s, centre, a, false, least, error);
    return status;
}

static void begin_group(search *s, size_t first)
{
    const draft_cylinder *c = &s->all->items[first];
    s->count = 0;
    s->frame = (cylinder_fit){.radius = c->radius};
    vector3_copy(s->frame.axis, c->axis);
    middle_of(c, s->frame.centre);
    cylinder_frame(&s->frame);
    for (size_t i = first; i < s->all->count && s->count < GROUP_MOST; i++)
        if (s->out->of_cylinder[i] < 0 && are_alike(c, &s->all->items[i])) {
            double p[3];
            middle_of(&s->all->items[i], p);
            place(s, p, s->at[s->count]);
            s->group[s->count++] = i;
        }
}

lmn_status draft_pitches_find(draft_pitches *out, const draft_cylinders *cylinders, lmn_error *error)
{
    search     s = {.all = cylinders, .out = out};
    lmn_status status = LMN_OK;
    *out = (draft_pitches){.of_cylinder = mem_alloc((cylinders->count + 1) * sizeof *out->of_cylinder)};
    if (!out->of_cylinder)
        return error_memory(error);
    for (size_t i = 0; i < cylinders->count; i++)
        out->of_cylinder[i] = -1;
    for (size_t i = 0; i < cylinders->count && status == LMN_OK; i++) {
        if (out->of_cylinder[i] >= 0 || cylinders->items[i].cone) /* what is round about a bore is its cylinder */
            continue;
        begin_group(&s, i);
        /* The fullest first: of six holes on a circle three are another one's, too. */
        for (size_t least = s.count; least >= LEAST && status == LMN_OK && s.group[0] == i; least--) {
            status = search_around_axes(&s, least, error);
            if (status == LMN_OK && least >= LONELY_LEAST)
                status = search_alone(&s, least, error);
        }
    }
    return status;
}

void draft_pitches_release(draft_pitches *p)
{
    mem_free(p->items);
    mem_free(p->of_cylinder);
    *p = (draft_pitches){NULL, 0, 0, NULL};
}
