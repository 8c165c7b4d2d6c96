#include "behaviour/clip.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "behaviour/evaluate.h"
#include "scene/decompose.h"

enum { KEYS_MAX = 4000000, HALVINGS_MAX = 24, COMPONENTS_MAX = 4 };
static const double TOLERANCE = 1e-6;

/* One channel while it grows. */
typedef struct writer {
    const schedule           *s;
    const behaviour_property *p;
    const behaviour_span     *span;       /* that drives the piece; NULL: rest */
    size_t                    n;          /* numbers of a value */
    double                    begin, end; /* of the piece */
    double                    reach;      /* how far values go */
    double                   *room;       /* of 8 values */
    float                    *times;      /* keys so far, and n · 3 numbers of each */
    float                    *values;
    size_t                    count, time_capacity, value_capacity;
    lmn_status                status;
    lmn_error                *error;
} writer;

/* The value of this piece, whoever drives at its ends. */
static void piece_value(writer *w, double t, double *out)
{
    if (w->span)
        schedule_span_value(w->s, w->span, t, out);
    else
        schedule_rest(w->s->scene, w->p->path, w->p->target, out);
    for (size_t k = 0; k < w->n && w->status == LMN_OK; k++)
        if (!(fabs(out[k]) <= 1e18)) /* callbacks say what they like */
            w->status =
                behaviour_refuse(&w->s->nodes[w->span ? w->span->node : 0], w->span ? (size_t)w->span->node : 0,
                                 LMN_FORMAT, w->error, "gives a number at %g s that is not finite, or beyond 1e18", t);
    if (w->p->path != PATH_ROTATION || w->count == 0)
        return;
    /* Of the two quaternions of a rotation the one near the key before. */
    const float *before = w->values + (3 * (w->count - 1) + 1) * w->n;
    double       along = 0;
    for (int k = 0; k < 4; k++)
        along += out[k] * (double)before[k];
    for (int k = 0; k < 4 && along < 0; k++)
        out[k] = -out[k];
}

/* The derivative within the piece, by differences of second order that stay inside of it. */
static void slope(writer *w, double t, double *out)
{
    double *a = w->room, *b = a + w->n, *c = b + w->n, span = w->end - w->begin, h = 1e-4 * span;
    double  at = t - w->begin < h ? t : w->end - t < h ? t - 2 * h : t - h;
    piece_value(w, at, a);
    piece_value(w, at + h, b);
    piece_value(w, at + 2 * h, c);
    for (size_t k = 0; k < w->n; k++)
        out[k] = at == t      ? (-3 * a[k] + 4 * b[k] - c[k]) / (2 * h)
                 : at < t - h ? (a[k] - 4 * b[k] + 3 * c[k]) / (2 * h)
                              : (c[k] - a[k]) / (2 * h);
}

static bool room_for_key(writer *w)
{
    if (w->count >= KEYS_MAX || work_stopped())
        w->status = work_stopped() ? work_check(w->error)
                                   : error_set(w->error, LMN_LIMIT, "the behaviour takes more than %d keys", KEYS_MAX);
    else if (!mem_grow((void **)&w->times, &w->time_capacity, w->count + 1, sizeof *w->times) ||
             !mem_grow((void **)&w->values, &w->value_capacity, 3 * w->n * (w->count + 1), sizeof *w->values))
        w->status = error_memory(w->error);
    return w->status == LMN_OK;
}

/* A key with the same slope on both sides; later ones may change the one behind. */
static void add_key(writer *w, float time, const double *value, const double *tangent)
{
    if (w->status != LMN_OK || (w->count > 0 && time <= w->times[w->count - 1]) || !room_for_key(w))
        return;
    float *to = w->values + 3 * w->n * w->count;
    w->times[w->count++] = time;
    for (size_t k = 0; k < w->n; k++) {
        to[k] = to[2 * w->n + k] = (float)(tangent ? tangent[k] : 0);
        to[w->n + k] = (float)value[k];
    }
}

/* How far the cubic between two keys is from what it stands for. */
static double error_between(writer *w, double from, double to, const double *a, const double *b, const double *da,
                            const double *db)
{
    double worst = 0, span = to - from, *exact = w->room, made[COMPONENTS_MAX], length = 0;
    bool   turns = w->p->path == PATH_ROTATION;
    for (int i = 1; i < 8; i++) {
        double t = i / 8.0, square = t * t, cube = square * t;
        piece_value(w, from + t * span, exact);
        length = 0;
        for (size_t k = 0; k < w->n; k++) {
            double v = (2 * cube - 3 * square + 1) * a[k] + span * (cube - 2 * square + t) * da[k] +
                       (3 * square - 2 * cube) * b[k] + span * (cube - square) * db[k];
            length += v * v;
            if (turns)
                made[k] = v;
            else
                worst = fmax(worst, fabs(v - exact[k]));
        }
        for (size_t k = 0; turns && k < w->n; k++)
            worst = fmax(worst, fabs(made[k] / sqrt(length) - exact[k]));
    }
    return worst;
}

/* Keys behind `from`, which is there, up to `to`. `a` and `da` are what it has. */
static void add_between(writer *w, double from, double to, const double *a, const double *da, int halvings)
{
    double *b = mem_calloc(2 * w->n, sizeof *b), *db = b ? b + w->n : NULL;
    if (!b) {
        w->status = error_memory(w->error);
        return;
    }
    double middle = from + (to - from) / 2;
    piece_value(w, to, b);
    slope(w, to, db);
    if (w->status == LMN_OK && halvings > 0 && (float)middle > (float)from && (float)middle < (float)to &&
        error_between(w, from, to, a, b, da, db) > TOLERANCE * w->reach) {
        /* Keys lie where single precision can say, and so do their values. */
        middle = (double)(float)middle;
        double *m = mem_calloc(2 * w->n, sizeof *m);
        add_between(w, from, middle, a, da, halvings - 1);
        if (m && w->status == LMN_OK) {
            piece_value(w, middle, m);
            slope(w, middle, m + w->n);
            add_between(w, middle, to, m, m + w->n, halvings - 1);
        } else if (w->status == LMN_OK) {
            w->status = error_memory(w->error);
        }
        mem_free(m);
    } else {
        add_key(w, (float)to, b, db);
    }
    mem_free(b);
}

/* Joins the piece that begins here with the one before: by another slope, or by a jump. */
static void begin_piece(writer *w, const double *value, const double *tangent)
{
    float  time = (float)w->begin;
    size_t n = w->n;
    if (w->count == 0 || w->times[w->count - 1] < time) {
        add_key(w, time, value, tangent);
        return;
    }
    float *last = w->values + 3 * n * (w->count - 1), *before = &w->times[w->count - 1];
    double apart = 0;
    for (size_t k = 0; k < n; k++)
        apart = fmax(apart, fabs(value[k] - (double)last[n + k]));
    if (apart <= TOLERANCE * w->reach) {
        for (size_t k = 0; k < n; k++)
            last[2 * n + k] = (float)tangent[k];
        return;
    }
    float earlier = nextafterf(time, -1);
    if (*before != time)
        return; /* pieces shorter than single precision can tell apart */
    if (w->count > 1 && w->times[w->count - 2] >= earlier)
        w->count--; /* the one between has no room */
    else
        *before = earlier;
    for (size_t k = 0; k < n && w->count; k++)
        w->values[3 * n * (w->count - 1) + 2 * n + k] = 0;
    add_key(w, time, value, tangent);
    for (size_t k = 0; k < n && w->status == LMN_OK; k++)
        w->values[3 * n * (w->count - 1) + k] = 0;
}

static void write_piece(writer *w, double *room)
{
    double  middle = w->begin + (w->end - w->begin) / 2;
    int32_t driver = schedule_driver(w->s, w->p, middle, SIDE_AT);
    w->span = driver == NONE ? NULL : &w->s->spans[driver];
    if (w->end <= w->begin || (float)w->end <= (float)w->begin)
        return;
    piece_value(w, w->begin, room);
    slope(w, w->begin, room + w->n);
    if (w->status == LMN_OK)
        begin_piece(w, room, room + w->n);
    if (w->status == LMN_OK)
        add_between(w, w->begin, w->end, room, room + w->n, HALVINGS_MAX);
}

/* How far the values go from their middle, sampled: what an error is compared with. */
static void find_reach(writer *w, const double *times, size_t count)
{
    double *value = w->room;
    w->reach = w->p->path == PATH_ROTATION ? 1 : 1e-9;
    for (size_t i = 0; i + 1 < count && w->p->path != PATH_ROTATION; i++)
        for (int step = 0; step <= 4; step++) {
            schedule_value(w->s, w->p, times[i] + step / 4.0 * (times[i + 1] - times[i]), SIDE_AT, value);
            for (size_t k = 0; k < w->n; k++)
                w->reach = fmax(w->reach, fabs(value[k]));
        }
}

static lmn_status write_channel(animation_channel *out, const schedule *s, const behaviour_property *p,
                                lmn_error *error)
{
    writer  w = {.s = s, .p = p, .n = p->components, .error = error};
    double *times = NULL;
    size_t  count = 0, capacity = 0;
    w.room = mem_calloc(8 * (w.n > 4 ? w.n : 4), sizeof *w.room);
    if (!w.room || !schedule_breaks(s, p, 0, s->duration, &times, &count, &capacity) ||
        !mem_grow((void **)&times, &capacity, count + 2, sizeof *times)) {
        w.status = error_memory(error);
    } else {
        times[count++] = 0;
        times[count++] = s->duration;
        trajectory_sort_times(times, &count);
        find_reach(&w, times, count);
        for (size_t i = 0; i + 1 < count && w.status == LMN_OK; i++) {
            w.begin = times[i];
            w.end = times[i + 1];
            write_piece(&w, w.room + 4 * w.n);
        }
    }
    mem_free(times);
    mem_free(w.room);
    *out = (animation_channel){p->target, p->path, INTERPOLATION_CUBIC, w.count, w.n, w.times, w.values};
    return w.status;
}

static void release_channels(animation_channel *channels, size_t count)
{
    for (size_t i = 0; channels && i < count; i++) {
        mem_free(channels[i].times);
        mem_free(channels[i].values);
    }
    mem_free(channels);
}

/* A matrix is what nodes of programs have by nature: it is told only where something of it is lost. */
static void split_matrix(lmn_scene *scene, int32_t index)
{
    node  *n = &scene->nodes[index];
    double t[3], r[4], size[3];
    if (!n->has_matrix || !mat4_decompose(&n->place->matrix, t, r, size)) {
        node_split_matrix(scene, index);
        return;
    }
    memcpy(n->place->translation, t, sizeof t);
    memcpy(n->place->rotation, r, sizeof r);
    memcpy(n->place->scale, size, sizeof size);
    n->has_matrix = false;
    n->place->matrix = mat4_identity();
}

lmn_status behaviour_write_clip(lmn_scene *scene, int32_t index, lmn_error *error)
{
    schedule           s;
    animation_channel *made = NULL;
    lmn_status         status = schedule_create(&s, scene, error);
    if (status == LMN_OK)
        status = schedule_check_followers(&s, error);
    if (status == LMN_OK) {
        made = mem_calloc(s.property_count, sizeof *made);
        status = made ? LMN_OK : error_memory(error);
    }
    for (size_t i = 0; i < s.property_count && status == LMN_OK; i++)
        status = write_channel(&made[i], &s, &s.properties[i], error);
    if (status == LMN_OK) {
        animation *a = &scene->animations[index];
        release_channels(a->channels, a->channel_count);
        a->channels = made;
        a->channel_count = s.property_count;
        a->duration = s.duration;
        for (size_t i = 0; i < a->channel_count; i++)
            if (made[i].path <= PATH_SCALE)
                split_matrix(scene, made[i].target);
        scene->behaviour->written = index;
    } else {
        release_channels(made, made ? s.property_count : 0);
    }
    schedule_release(&s);
    return status;
}
