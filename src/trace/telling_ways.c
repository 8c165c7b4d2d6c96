/* Events on the ways of marks: each mark's coordinates on the page, and the same as seen from the middle of all marks,
 * so that legs which are farthest apart count although the walker goes on. An event counts as far as the mark has come
 * since the one before it. */
#include "trace/telling_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Samples a second, and how many there are at least and at most. */
#define RATE 60.0
enum { SAMPLES_LEAST = 17, SAMPLES_MOST = 901, MARKS_MOST = 2048, SERIES = 4, BINS_A_SAMPLE = 8, REASONS = 3 };
/* A turn is one when the mark comes back by this fraction of its range, and by a unit. */
#define TURN_LEAST 0.1
/* Events that are so near to each other, samples, are one moment. */
#define TOGETHER 3.0
/* An end of the animation counts as this fraction of a turn. */
#define END_WEIGHT 0.4
/* Where something rebounds, its velocity changes within one sample by about as much as within two; where it turns
 * smoothly, by half. */
#define REBOUND_LEAST 0.62
/* From faster than the first of these fractions of its greatest speed to slower than the second: it has stopped. */
#define STOP_FROM 0.25
#define STOP_TO   0.02

/* A position that goes with a node, or a corner of a part's box where its vertices move by themselves. */
typedef struct mark {
    int32_t  node; /* NONE: a box */
    uint32_t part;
    vec3     at; /* in the node; of a box 0 or 1 each */
} mark;

typedef struct event {
    double         at, weight; /* sample */
    telling_reason reason;
} event;

typedef struct ways {
    const telling_options *o;
    mark                  *marks;
    size_t                 mark_count, mark_capacity, samples;
    double                 seconds, step;
    double (*at)[2];     /* per mark, per sample */
    double (*middle)[2]; /* per sample */
    double *series;      /* of one mark: one number a sample */
    event  *events;
    size_t  event_count, event_capacity;
} ways;

/* --- marks ------------------------------------------------------------------------------------------------- */

static bool put_mark(ways *w, mark m)
{
    if (w->mark_count >= MARKS_MOST)
        return true;
    if (!mem_grow((void **)&w->marks, &w->mark_capacity, w->mark_count + 1, sizeof *w->marks))
        return false;
    w->marks[w->mark_count++] = m;
    return true;
}

static bool put_joints(ways *w, uint32_t part, const skin *k, bool *known)
{
    bool good = true;
    for (size_t i = 0; i < k->joint_count && good; i++) {
        if (known[k->joints[i]])
            continue;
        known[k->joints[i]] = true;
        good = put_mark(w, (mark){k->joints[i], part, {0, 0, 0}});
    }
    return good;
}

static bool put_corners(ways *w, uint32_t part, int32_t node_index, const mesh *m)
{
    box3 box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t k = 0; k < m->primitive_count; k++)
        for (uint32_t i = 0; i < m->primitives[k].vertex_count; i++) {
            vec3 p = m->primitives[k].positions[i];
            box.min = (vec3){fminf(box.min.x, p.x), fminf(box.min.y, p.y), fminf(box.min.z, p.z)};
            box.max = (vec3){fmaxf(box.max.x, p.x), fmaxf(box.max.y, p.y), fmaxf(box.max.z, p.z)};
        }
    bool good = true;
    for (int i = 0; i < 8 && good && box.min.x <= box.max.x; i++)
        good = put_mark(
            w, (mark){node_index,
                      part,
                      {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z}});
    return good;
}

static bool put_part(ways *w, uint32_t part, bool *known)
{
    const lmn_scene *s = w->o->pose->scene;
    int32_t          own = s->parts[part].node;
    const node      *n = &s->nodes[own];
    if (n->mesh == NONE)
        return true;
    if (n->skin != NONE)
        return put_joints(w, part, &s->skins[n->skin], known);
    if (w->o->pose->parts[part].weight_count)
        return put_mark(w, (mark){NONE, part, {0, 0, 0}}) && put_mark(w, (mark){NONE, part, {1, 1, 1}});
    return put_corners(w, part, own, &s->meshes[n->mesh]);
}

static lmn_status put_marks(ways *w, lmn_error *error)
{
    const lmn_scene *s = w->o->pose->scene;
    bool            *known = mem_calloc(s->node_count + 1, sizeof *known), good = known != NULL;
    for (size_t part = 0; part < w->o->pose->part_count && good; part++)
        if (w->o->parts[part])
            good = put_part(w, (uint32_t)part, known);
    mem_free(known);
    return good ? LMN_OK : error_memory(error);
}

/* --- ways --------------------------------------------------------------------------------------------------- */

static vec3 place(const pose *p, const mark *m)
{
    if (m->node != NONE)
        return mat4_transform_point(&p->worlds[m->node], m->at);
    const box3 *b = &p->part_boxes[m->part];
    return m->at.x > 0 ? b->max : b->min;
}

static void put_sample(ways *w, const pose *p, size_t sample)
{
    double *middle = w->middle[sample];
    size_t  seen = 0;
    for (size_t i = 0; i < w->mark_count; i++) {
        double page[3], *at = w->at[i * w->samples + sample];
        bool   good = page_project(&w->o->camera, place(p, &w->marks[i]), page) && isfinite(page[0] + page[1]);
        at[0] = good ? page[0] : NAN;
        at[1] = good ? page[1] : NAN;
        middle[0] += good ? page[0] : 0;
        middle[1] += good ? page[1] : 0;
        seen += good;
    }
    middle[0] /= (double)(seen ? seen : 1);
    middle[1] /= (double)(seen ? seen : 1);
}

static lmn_status follow(ways *w, lmn_error *error)
{
    pose       p = {.scene = NULL};
    moment     when = w->o->pose->when;
    lmn_status status = LMN_OK;
    w->at = mem_alloc((w->mark_count * w->samples + 1) * sizeof *w->at);
    w->middle = mem_calloc(w->samples + 1, sizeof *w->middle);
    w->series = mem_alloc((w->samples + 1) * sizeof *w->series);
    if (!w->at || !w->middle || !w->series)
        return error_memory(error);
    when.held = 0;
    when.held_seconds = 0;
    for (size_t k = 0; k < w->samples && status == LMN_OK; k++) {
        when.seconds = w->o->pose->when.seconds - w->step * (double)(w->samples - 1 - k);
        when.seconds = when.seconds > 0 ? when.seconds : 0;
        status = k ? pose_move(&p, &when, error) : pose_create(&p, w->o->pose->scene, &when, error);
        if (status == LMN_OK)
            put_sample(w, &p, k);
    }
    pose_release(&p);
    return status;
}

/* --- events --------------------------------------------------------------------------------------------------- */

static bool put_event(ways *w, double at, double weight, telling_reason reason)
{
    if (!(weight > 0))
        return true;
    if (!mem_grow((void **)&w->events, &w->event_capacity, w->event_count + 1, sizeof *w->events))
        return false;
    w->events[w->event_count++] = (event){at, weight, reason};
    return true;
}

/* Where between samples a parabola through three of them turns. */
static double refined(const double *v, size_t i, size_t count)
{
    if (i == 0 || i + 1 >= count)
        return (double)i;
    double bend = v[i - 1] - 2 * v[i] + v[i + 1], slope = 0.5 * (v[i + 1] - v[i - 1]);
    return bend != 0 ? (double)i - fmin(fmax(slope / bend, -0.5), 0.5) : (double)i;
}

static bool rebounds(const double *v, size_t i, size_t count)
{
    if (i < 2 || i + 2 >= count)
        return false;
    double near_change = fabs(v[i + 1] - 2 * v[i] + v[i - 1]), far_change = fabs(v[i + 2] - 2 * v[i] + v[i - 2]) / 2;
    return near_change > REBOUND_LEAST * far_change;
}

/* How slow a mark is at a sample: 1 when it rests, 0 when it is as fast as it ever is. Where a coordinate turns at full
 * speed, as that of a pendulum's height at the bottom, nothing turns back. */
static double slowness(const ways *w, const double (*at)[2], size_t sample, bool absolute)
{
    double fastest = 0, own = 0;
    for (size_t i = 1; i + 1 < w->samples; i++) {
        double v[2];
        for (int k = 0; k < 2; k++)
            v[k] = at[i + 1][k] - at[i - 1][k] - (absolute ? 0 : w->middle[i + 1][k] - w->middle[i - 1][k]);
        double speed = hypot(v[0], v[1]);
        fastest = fmax(fastest, speed);
        own = i == sample ? speed : own;
    }
    return fastest > 0 ? 1 - own * own / (fastest * fastest) : 0;
}

/* Turns of w->series, each as far as the mark has come since the last one. */
static bool put_turns(ways *w, const double (*at)[2], double weight, bool absolute)
{
    const double *v = w->series;
    size_t        count = w->samples, best = 0, last = 0;
    double        low = INFINITY, high = -INFINITY, came = 0;
    for (size_t i = 0; i < count; i++) {
        low = fmin(low, v[i]);
        high = fmax(high, v[i]);
    }
    double threshold = fmax(TURN_LEAST * (high - low), 1);
    int    sense = 0; /* of the way to `best` */
    bool   good = true;
    if (!(high - low >= threshold))
        return true;
    for (size_t i = 1; i < count && good; i++) {
        double back = v[i] - v[best];
        if (sense == 0 ? fabs(v[i] - v[0]) >= threshold : back * sense > 0) {
            sense = v[i] > v[best] ? 1 : -1;
            best = i;
        } else if (sense != 0 && -back * sense >= threshold) {
            came = fabs(v[best] - v[last]);
            bool hits = absolute && rebounds(v, best, count);
            good = put_event(w, refined(v, best, count), weight * came * (hits ? 1.5 : slowness(w, at, best, absolute)),
                             hits ? TELLING_CONTACT : TELLING_TURN);
            good = good && (last > 0 || put_event(w, 0, END_WEIGHT * weight * came, TELLING_END));
            last = best;
            best = i;
            sense = -sense;
        }
    }
    if (good && last == 0)
        good = put_event(w, 0, END_WEIGHT * weight * fabs(v[count - 1] - v[0]), TELLING_END);
    return good && put_event(w, (double)(count - 1), END_WEIGHT * weight * fabs(v[count - 1] - v[last]), TELLING_END);
}

/* Where a mark stops at once. */
static bool put_stops(ways *w, const double (*at)[2], double weight)
{
    double fastest = 0, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    bool   good = true;
    for (size_t i = 0; i < w->samples; i++) {
        if (i > 0)
            fastest = fmax(fastest, hypot(at[i][0] - at[i - 1][0], at[i][1] - at[i - 1][1]));
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[i][k]);
            high[k] = fmax(high[k], at[i][k]);
        }
    }
    for (size_t i = 2; i + 2 < w->samples && good && fastest > 0; i++) {
        double before = hypot(at[i - 1][0] - at[i - 2][0], at[i - 1][1] - at[i - 2][1]),
               after = hypot(at[i + 2][0] - at[i + 1][0], at[i + 2][1] - at[i + 1][1]);
        if (before > STOP_FROM * fastest && after < STOP_TO * fastest) {
            good = put_event(w, (double)i, weight * hypot(high[0] - low[0], high[1] - low[1]), TELLING_CONTACT);
            i += 2;
        }
    }
    return good;
}

static double length_of(const ways *w, const double (*at)[2])
{
    double sum = 0;
    for (size_t i = 1; i < w->samples; i++)
        sum += hypot(at[i][0] - at[i - 1][0], at[i][1] - at[i - 1][1]);
    return sum;
}

/* Which parts move, and events of all marks; those that go farther count more. */
static bool put_events(ways *w, bool *moves)
{
    double whole = 0;
    bool   good = true;
    for (size_t i = 0; i < w->mark_count; i++) {
        double own = length_of(w, (const double(*)[2])w->at + i * w->samples);
        whole += isfinite(own) ? own : 0;
    }
    for (size_t i = 0; i < w->mark_count && good; i++) {
        const double(*at)[2] = (const double(*)[2])w->at + i * w->samples;
        double own = length_of(w, at);
        if (!isfinite(own) || own < 1)
            continue;
        moves[w->marks[i].part] = true;
        for (int k = 0; k < SERIES && good; k++) {
            for (size_t n = 0; n < w->samples; n++)
                w->series[n] = at[n][k & 1] - (k > 1 ? w->middle[n][k & 1] : 0);
            good = put_turns(w, at, own / whole, k < 2);
        }
        good = good && put_stops(w, at, own / whole);
    }
    return good;
}

/* --- candidates -------------------------------------------------------------------------------------------------- */

static int compare_events(const void *a, const void *b)
{
    const event *p = a, *q = b;
    return p->at != q->at ? (p->at > q->at) - (p->at < q->at) : (p->weight < q->weight) - (p->weight > q->weight);
}

/* Of all events near to one: their weight, their mean time and their reason. Events are sorted by time. */
static telling_candidate sum_near(const ways *w, size_t middle, const bool *taken)
{
    double weights[REASONS] = {0}, sum = 0, at = 0, now = w->events[middle].at, last = (double)(w->samples - 1);
    size_t first = middle;
    while (first > 0 && now - w->events[first - 1].at <= TOGETHER)
        first--;
    for (size_t i = first; i < w->event_count && w->events[i].at - now <= TOGETHER; i++) {
        double own = taken[i] ? 0 : w->events[i].weight * (1 - 0.5 * fabs(w->events[i].at - now) / TOGETHER);
        weights[w->events[i].reason] += own;
        sum += own;
        at += own * w->events[i].at;
    }
    telling_reason reason = weights[TELLING_CONTACT] >= 0.3 * sum ? TELLING_CONTACT
                            : weights[TELLING_END] > 0.5 * sum    ? TELLING_END
                                                                  : TELLING_TURN;
    at = sum > 0 ? at / sum : now;
    if (reason == TELLING_END)
        at = at > 0.5 * last ? last : 0;
    return (telling_candidate){{(last - at) * w->step, reason, 0}, sum};
}

/* The heaviest cluster of events again and again. Events are sorted by time. */
static bool gather(telling_candidate *out, size_t *count, const ways *w)
{
    bool *taken = mem_calloc(w->event_count + 1, sizeof *taken);
    *count = 0;
    while (taken && *count < TELLING_MOST) {
        telling_candidate best = {.score = 0};
        size_t            middle = 0;
        for (size_t i = 0; i < w->event_count; i++) {
            if (taken[i])
                continue;
            telling_candidate one = sum_near(w, i, taken);
            if (one.score > best.score) {
                best = one;
                middle = i;
            }
        }
        if (!(best.score > 0))
            break;
        double at = w->events[middle].at;
        for (size_t i = 0; i < w->event_count; i++)
            taken[i] = taken[i] || fabs(w->events[i].at - at) <= TOGETHER;
        out[(*count)++] = best;
    }
    bool good = taken != NULL;
    mem_free(taken);
    return good;
}

/* Events of about one time and of one reason become one: there are many marks and few moments. */
static bool merge_events(ways *w)
{
    size_t bins = (w->samples + 1) * BINS_A_SAMPLE, kept = 0;
    event *merged = mem_calloc(REASONS * bins + 1, sizeof *merged);
    if (!merged)
        return false;
    for (size_t i = 0; i < w->event_count; i++) {
        const event *e = &w->events[i];
        event       *bin = &merged[(size_t)fmax(e->at * BINS_A_SAMPLE, 0) * REASONS + (size_t)e->reason];
        bin->at += e->weight * e->at;
        bin->weight += e->weight;
        bin->reason = e->reason;
    }
    for (size_t i = 0; i < REASONS * bins; i++)
        if (merged[i].weight > 0)
            merged[kept++] = (event){merged[i].at / merged[i].weight, merged[i].weight, merged[i].reason};
    qsort(merged, kept, sizeof *merged, compare_events);
    mem_free(w->events);
    w->events = merged;
    w->event_count = kept;
    return true;
}

/* However far things go: ends come behind what turns. */
static void lower_ends(telling_candidate *list, size_t count)
{
    double best = 0;
    for (size_t i = 0; i < count; i++)
        if (list[i].moment.reason != TELLING_END)
            best = fmax(best, list[i].score);
    for (size_t i = 0; i < count && best > 0; i++)
        if (list[i].moment.reason == TELLING_END)
            list[i].score = fmin(list[i].score, END_WEIGHT * best);
}

lmn_status telling_candidates(telling_candidate *out, size_t *count, bool *moves, const telling_options *o,
                              lmn_error *error)
{
    ways w = {.o = o, .seconds = fmin(o->seconds, o->pose->when.seconds)};
    *count = 0;
    if (!o->pose->at_rest || !(w.seconds > 0))
        return LMN_OK;
    w.samples = (size_t)fmin(fmax(ceil(w.seconds * RATE) + 1, SAMPLES_LEAST), SAMPLES_MOST);
    w.step = w.seconds / (double)(w.samples - 1);
    lmn_status status = put_marks(&w, error);
    if (status == LMN_OK)
        status = follow(&w, error);
    if (status == LMN_OK && !put_events(&w, moves))
        status = error_memory(error);
    if (status == LMN_OK && w.event_count) {
        status = merge_events(&w) && gather(out, count, &w) ? LMN_OK : error_memory(error);
        lower_ends(out, *count);
    }
    mem_free(w.marks);
    mem_free(w.at);
    mem_free(w.middle);
    mem_free(w.series);
    mem_free(w.events);
    return status;
}
