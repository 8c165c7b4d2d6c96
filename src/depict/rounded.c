#include "depict/rounded.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "depict/course.h"

/* A way of more widths than this is looked at less finely. */
enum { SAMPLES_MOST = 6000, A_WIDTH = 6 };

/* The way on the page: x and y as seen from its mean distance, in the world's unit, and how far away. */
typedef struct page_way {
    const depict_job *job;
    double (*points)[3];
    double *lengths; /* on the page */
    size_t  count;
    double  distance, width;
    double (*samples)[3]; /* evenly along it, and then moved where it turns sharply */
    double *places;       /* how far along each was */
    bool   *moved, *gone; /* a flag a sample */
    size_t  sample_count;
} page_way;

static void to_page(const page_way *w, const double at[3], double out[3])
{
    const double *m = w->job->camera.view.m;
    double        eye[3];
    for (int k = 0; k < 3; k++)
        eye[k] = m[k] * at[0] + m[4 + k] * at[1] + m[8 + k] * at[2] + m[12 + k];
    const double scale = w->job->camera.orthographic ? 1 : w->distance / fmax(-eye[2], 1e-30);
    vector3_set(out, eye[0] * scale, eye[1] * scale, eye[2]);
}

static void to_world(const page_way *w, const double on_page[3], double out[3])
{
    const double *m = w->job->camera.view.m;
    const double  scale = w->job->camera.orthographic ? 1 : fmax(-on_page[2], 1e-30) / w->distance;
    const double  eye[3] = {on_page[0] * scale - m[12], on_page[1] * scale - m[13], on_page[2] - m[14]};
    for (int k = 0; k < 3; k++) /* the view is a rotation, and a shift */
        out[k] = m[4 * k] * eye[0] + m[4 * k + 1] * eye[1] + m[4 * k + 2] * eye[2];
}

/* Lengths of a page neither overflow nor vanish: hypot, which sees to that, takes most of the time of an arrow. */
static double length_of(double x, double y)
{
    return sqrt(x * x + y * y);
}

static double apart(const double a[3], const double b[3])
{
    return length_of(a[0] - b[0], a[1] - b[1]);
}

static course course_of(const page_way *w)
{
    return (course){(const double(*)[3])w->points, w->lengths, w->count};
}

/* Between the directions a → b and b → c on the page, radians. */
static double turn_between(const double a[3], const double b[3], const double c[3])
{
    const double x1 = b[0] - a[0], y1 = b[1] - a[1], x2 = c[0] - b[0], y2 = c[1] - b[1];
    if (!(length_of(x1, y1) > 0) || !(length_of(x2, y2) > 0))
        return 0;
    return fabs(atan2(x1 * y2 - y1 * x2, x1 * x2 + y1 * y2));
}

/* Half the width and a little more: what a line can turn by without folding. */
static double least_radius(const page_way *w)
{
    return 0.62 * w->width;
}

/* Is a turn surely less than a tenth, radians? Most are; an arc tangent takes most of the time of a radius. */
static bool hardly_turns(const double a[3], const double b[3], const double c[3])
{
    const double x1 = b[0] - a[0], y1 = b[1] - a[1], x2 = c[0] - b[0], y2 = c[1] - b[1];
    return fabs(x1 * y2 - y1 * x2) < 0.1003 * (x1 * x2 + y1 * y2); /* tan 0.1 is more than that */
}

/* How sharply it turns at a sample: the radius of that; many times the width where it hardly turns. */
static double radius_at(const page_way *w, size_t i)
{
    const size_t reach = A_WIDTH / 2, a = i > reach ? i - reach : 0,
                 c = i + reach < w->sample_count ? i + reach : w->sample_count - 1;
    if (i == 0 || i + 1 >= w->sample_count || hardly_turns(w->samples[a], w->samples[i], w->samples[c]))
        return 10 * w->width;
    const double turned = turn_between(w->samples[a], w->samples[i], w->samples[c]);
    const double legs = apart(w->samples[a], w->samples[i]) + apart(w->samples[i], w->samples[c]);
    return turned > 0.1 ? legs / 2 / turned : 10 * w->width;
}

/* Can a sample's radius have changed where those that have a flag have moved? */
static bool may_have_turned(const page_way *w, const bool *moved, size_t i)
{
    const size_t reach = A_WIDTH / 2;
    return moved[i] || moved[i > reach ? i - reach : 0] ||
           moved[i + reach < w->sample_count ? i + reach : w->sample_count - 1];
}

/* Marks what is to be moved: a width around each sharp turn. False: there is none. Where nothing has moved since the
 * last time (`moved`; NULL: all is new) it was broad, and is. */
static bool mark_sharp(page_way *w, const bool *moved, bool *active)
{
    bool any = false;
    memset(active, 0, w->sample_count * sizeof *active);
    for (size_t i = 1; i + 1 < w->sample_count; i++) {
        if ((moved && !may_have_turned(w, moved, i)) || radius_at(w, i) >= least_radius(w))
            continue;
        any = true;
        const size_t low = i > A_WIDTH + 1 ? i - A_WIDTH : 1;
        for (size_t k = low; k <= i + A_WIDTH && k + 1 < w->sample_count; k++)
            active[k] = w->moved[k] = true;
    }
    return any;
}

/* One step of a thread under tension, of the samples that are listed, in order: each goes half way to the middle
 * between its neighbours, all at once. */
static void pull(page_way *w, const size_t *listed, size_t count)
{
    double before[3] = {0, 0, 0}; /* where the last one was */
    for (size_t n = 0; n < count; n++) {
        const size_t  i = listed[n];
        double       *at = w->samples[i];
        const double *last = n > 0 && listed[n - 1] + 1 == i ? before : w->samples[i - 1], *next = w->samples[i + 1];
        const double  x = (last[0] + 2 * at[0] + next[0]) / 4, y = (last[1] + 2 * at[1] + next[1]) / 4,
                     z = (last[2] + 2 * at[2] + next[2]) / 4;
        vector3_copy(before, at);
        vector3_set(at, x, y, z);
    }
}

/* Sharp turns give way, as a thread under tension does, until they are broad. */
static void relax(page_way *w)
{
    enum { ROUNDS = 60, STEPS = 12 };
    const size_t room = w->sample_count + 1;
    bool        *active = mem_calloc(2 * room, sizeof *active), *before = active ? active + room : NULL;
    size_t      *listed = mem_alloc(room * sizeof *listed);
    const bool   good = active && listed;
    for (int round = 0; round < ROUNDS && good && mark_sharp(w, round ? before : NULL, active); round++) {
        size_t count = 0;
        for (size_t i = 1; i + 1 < w->sample_count; i++)
            if (active[i])
                listed[count++] = i;
        for (int step = 0; step < STEPS; step++)
            pull(w, listed, count);
        memcpy(before, active, room * sizeof *active);
    }
    mem_free(active);
    mem_free(listed);
}

/* From a sample on, one way or the other, those that were moved go back to where the way is: the turn is left out that
 * they had given way to. */
static void put_back(page_way *w, size_t from, bool onward)
{
    const course way = course_of(w);
    for (size_t i = from; i < w->sample_count && w->moved[i] && !w->gone[i]; i += onward ? 1 : SIZE_MAX) {
        course_at(&way, w->places[i], w->samples[i]);
        w->moved[i] = false;
    }
}

/* What is still sharp turns back nearly where it came from: legs that would lie on each other are left out. */
static void break_reversals(page_way *w)
{
    const size_t most = 4 * A_WIDTH;
    for (size_t i = 1; i + 1 < w->sample_count; i++) {
        if (w->gone[i] || radius_at(w, i) >= 0.5 * w->width)
            continue;
        size_t gap = 1;
        while (gap < most && gap < i && i + gap + 1 < w->sample_count &&
               apart(w->samples[i - gap], w->samples[i + gap]) < 1.3 * w->width)
            gap++;
        for (size_t k = i - gap + 1; k < i + gap; k++)
            w->gone[k] = true;
        put_back(w, i - gap, false);
        put_back(w, i + gap, true);
    }
}

/* Pieces too short to say where they lead. */
static void drop_bits(page_way *w)
{
    size_t first = 0;
    for (size_t i = 0; i <= w->sample_count; i++) {
        if (i < w->sample_count && !w->gone[i])
            continue;
        for (size_t k = first; k < i && i - first < A_WIDTH && i - first < w->sample_count; k++)
            w->gone[k] = true;
        first = i + 1;
    }
}

static bool take_samples(page_way *w)
{
    const course way = course_of(w);
    const double end = course_end(&way), step = fmax(w->width / A_WIDTH, end / SAMPLES_MOST);
    w->sample_count = (size_t)(end / step) + 2;
    w->samples = mem_alloc(w->sample_count * sizeof *w->samples);
    w->places = mem_alloc(w->sample_count * sizeof *w->places);
    w->moved = mem_calloc(w->sample_count, sizeof *w->moved);
    w->gone = mem_calloc(w->sample_count, sizeof *w->gone);
    if (!w->samples || !w->places || !w->moved || !w->gone)
        return false;
    for (size_t i = 0; i < w->sample_count; i++) {
        w->places[i] = end * (double)i / (double)(w->sample_count - 1);
        course_at(&way, w->places[i], w->samples[i]);
    }
    return true;
}

static void add_point(rounded_way *out, const double at[3])
{
    if (out->failed ||
        !mem_grow((void **)&out->points, &out->point_capacity, out->point_count + 1, sizeof *out->points)) {
        out->failed = true;
        return;
    }
    memcpy(out->points[out->point_count++], at, sizeof *out->points);
    out->runs[out->run_count - 1].count++;
}

static void begin_run(rounded_way *out)
{
    if (out->run_count && out->runs[out->run_count - 1].count < 2) { /* nothing of it is seen */
        out->point_count = out->runs[out->run_count - 1].first;
        out->run_count--;
    }
    if (out->failed || !mem_grow((void **)&out->runs, &out->run_capacity, out->run_count + 1, sizeof *out->runs)) {
        out->failed = true;
        return;
    }
    out->runs[out->run_count++] = (rounded_run){out->point_count, 0};
}

static void add_sample(rounded_way *out, const page_way *w, size_t i)
{
    double at[3];
    to_world(w, w->samples[i], at);
    add_point(out, at);
}

/* Samples where it was moved or begins and ends; between them its own points. */
static void put_runs(rounded_way *out, const page_way *w, const double (*points)[3])
{
    size_t next = 0; /* of its own points */
    for (size_t i = 0; i < w->sample_count && !out->failed; i++) {
        const bool begins = !w->gone[i] && (i == 0 || w->gone[i - 1]),
                   ends = !w->gone[i] && (i + 1 == w->sample_count || w->gone[i + 1]);
        if (begins && i > 0)
            begin_run(out);
        if (w->gone[i])
            continue;
        if (w->moved[i] || begins || ends)
            add_sample(out, w, i);
        const bool between = !ends && !w->moved[i] && !w->moved[i + 1];
        while (next < w->count && w->lengths[next] <= w->places[i])
            next++;
        for (; between && next < w->count && w->lengths[next] < w->places[i + 1]; next++)
            add_point(out, points[next]);
    }
    if (out->run_count > 1 && out->runs[out->run_count - 1].count < 2)
        out->run_count--;
}

/* As it was given. */
static void put_all(rounded_way *out, const double (*points)[3], size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_point(out, points[i]);
}

static bool any_of(const bool *flags, size_t count)
{
    bool any = false;
    for (size_t i = 0; i < count; i++)
        any = any || flags[i];
    return any;
}

void rounded_make(rounded_way *out, const depict_job *j, const double (*points)[3], size_t count, double width)
{
    page_way w = {.job = j, .count = count, .width = width};
    memset(out, 0, sizeof *out);
    begin_run(out);
    w.points = mem_alloc((count + 1) * sizeof *w.points);
    w.lengths = mem_alloc((count + 1) * sizeof *w.lengths);
    out->failed = out->failed || !w.points || !w.lengths;
    for (size_t i = 0; i < count && !j->camera.orthographic; i++)
        w.distance += vector3_distance(points[i], j->camera.eye) / (double)count;
    w.distance = w.distance > 0 ? w.distance : 1;
    for (size_t i = 0; i < count && !out->failed; i++) {
        to_page(&w, points[i], w.points[i]);
        w.lengths[i] = i == 0 ? 0 : w.lengths[i - 1] + apart(w.points[i - 1], w.points[i]);
    }
    const course way = course_of(&w);
    const bool   turns = !out->failed && !j->drafts && count > 2 && width > 0 && course_end(&way) > width;
    if (turns && take_samples(&w)) {
        relax(&w);
        break_reversals(&w);
        drop_bits(&w);
    } else {
        out->failed = out->failed || turns;
    }
    if (!out->failed && turns && (any_of(w.moved, w.sample_count) || any_of(w.gone, w.sample_count)))
        put_runs(out, &w, points);
    else if (!out->failed)
        put_all(out, points, count);
    if (!out->failed && out->point_count < 2 && count > 1) { /* it is nowhere broad enough: from its begin to its end */
        out->point_count = out->run_count = 0;
        begin_run(out);
        add_point(out, points[0]);
        add_point(out, points[count - 1]);
    }
    mem_free(w.points);
    mem_free(w.lengths);
    mem_free(w.samples);
    mem_free(w.places);
    mem_free(w.moved);
    mem_free(w.gone);
}

void rounded_release(rounded_way *r)
{
    mem_free(r->points);
    mem_free(r->runs);
    memset(r, 0, sizeof *r);
}
