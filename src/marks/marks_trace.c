/* Strokes in planes: from evenly spread positions, each walks over the triangles in a plane of its own, so
 * that it is straight where it is drawn and bends only as the surface does. For meshes without texture coordinates,
 * which Freudenberg's explicit strokes need (2003, section 5.3.2). */
#include "marks/d3.h"
#include "marks/marks.h"

#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/random.h"
#include "scene/mesh.h"

enum { POINTS_MAX = 512 /* of one half of a stroke */ };

static const double SHARP = 0.5; /* cosine between faces at which strokes end */

typedef struct tracer {
    const mark_surface  *surface;
    const trace_options *options;
    primitive            mesh;   /* the surface, for who knows only these */
    uint32_t            *across; /* mesh_adjacency */
    marks               *out;
    double               density;
} tracer;

/* A stroke while it is walked: positions from its seed, and the triangle that each chord towards it lies in. */
typedef struct path {
    d3       points[2 * POINTS_MAX + 1];
    uint32_t triangles[2 * POINTS_MAX + 1];
    size_t   count;
} path;

static d3 along(d3 from, d3 to, double fraction)
{
    return (d3){from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y),
                from.z + fraction * (to.z - from.z)};
}

static d3 unit(d3 v)
{
    double length = sqrt(dot(v, v));
    return length > 0 ? (d3){v.x / length, v.y / length, v.z / length} : v;
}

static vec3 rounded(d3 v)
{
    return (vec3){(float)v.x, (float)v.y, (float)v.z};
}

static void corners_of(const tracer *t, uint32_t triangle, d3 out[3])
{
    for (uint32_t i = 0; i < 3; i++)
        out[i] = of(t->surface->positions[t->surface->indices[3 * (size_t)triangle + i]]);
}

static d3 face_normal(const tracer *t, uint32_t triangle)
{
    d3 c[3];
    corners_of(t, triangle, c);
    return unit(cross(minus(c[1], c[0]), minus(c[2], c[0])));
}

/* --- walking -------------------------------------------------------------------------------------------- */

/* One step of a walk in the plane through `seed` with this normal: from a position in a triangle to where it leaves
 * it, not by the edge that it came in by. Returns the edge, or −1 where there is no way on. */
static int leave(const tracer *t, uint32_t triangle, int entered, d3 seed, d3 plane, d3 direction, d3 *out)
{
    d3 c[3];
    corners_of(t, triangle, c);
    double off[3];
    for (int i = 0; i < 3; i++)
        off[i] = dot(plane, minus(c[i], seed));
    int    best = -1;
    double farthest = 0;
    for (int i = 0; i < 3; i++) {
        double from = off[i], to = off[(i + 1) % 3];
        if (i == entered || (from >= 0) == (to >= 0))
            continue;
        d3     at = along(c[i], c[(i + 1) % 3], from / (from - to));
        double gone = entered >= 0 ? 1 : dot(direction, minus(at, seed)); /* from the seed: forwards */
        if (gone > farthest) {
            farthest = gone;
            best = i;
            *out = at;
        }
    }
    return best;
}

/* Walks at most `length`; appends to the path. */
static void walk(const tracer *t, path *p, uint32_t triangle, d3 seed, d3 plane, d3 direction, double length)
{
    int entered = -1;
    d3  at = seed;
    for (int steps = 0; steps < POINTS_MAX - 1 && length > 0; steps++) {
        d3  next;
        int edge = leave(t, triangle, entered, seed, plane, direction, &next);
        if (edge < 0)
            return;
        d3     step = minus(next, at);
        double size = sqrt(dot(step, step));
        bool   ends = size >= length;
        p->points[p->count] = ends ? along(at, next, length / size) : next;
        p->triangles[p->count++] = triangle;
        uint32_t other = t->across[3 * (size_t)triangle + (size_t)edge];
        length -= size;
        if (ends || other == UINT32_MAX || dot(face_normal(t, triangle), face_normal(t, other / 3)) < SHARP)
            return;
        triangle = other / 3;
        entered = (int)(other % 3);
        at = next;
    }
}

/* Both ways from the seed, in order. */
static void walk_both(const tracer *t, path *p, const mark_dot *seed, d3 plane, double length)
{
    d3 at = of(seed->position), direction = cross(face_normal(t, seed->triangle), plane);
    p->count = 0;
    walk(t, p, seed->triangle, at, plane, (d3){-direction.x, -direction.y, -direction.z}, 0.5 * length);
    /* Turned around: the chord towards a point becomes the one away from it. */
    for (size_t i = 0, k = p->count; i + 1 < k; i++, k--) {
        d3       point = p->points[i];
        uint32_t triangle = p->triangles[i];
        p->points[i] = p->points[k - 1];
        p->triangles[i] = p->triangles[k - 1];
        p->points[k - 1] = point;
        p->triangles[k - 1] = triangle;
    }
    p->points[p->count] = at;
    for (size_t i = p->count; i > 0; i--)
        p->triangles[i] = p->triangles[i - 1];
    p->triangles[p->count++] = seed->triangle;
    walk(t, p, seed->triangle, at, plane, direction, 0.5 * length);
}

/* --- chords --------------------------------------------------------------------------------------------- */

/* The farthest point from the chord between two, and how far. */
static double farthest_of(const path *p, size_t first, size_t last, size_t *at)
{
    d3     a = p->points[first], chord = minus(p->points[last], a);
    double square = dot(chord, chord), most = 0;
    *at = first;
    for (size_t i = first + 1; i < last; i++) {
        d3     to = minus(p->points[i], a);
        double fraction = square > 0 ? dot(to, chord) / square : 0;
        d3     away = minus(to, (d3){fraction * chord.x, fraction * chord.y, fraction * chord.z});
        double off = sqrt(dot(away, away));
        if (off > most) {
            most = off;
            *at = i;
        }
    }
    return most;
}

/* Marks which points are kept. Without recursion: a stack of stretches. */
static void simplify(const path *p, double most, bool *kept)
{
    size_t stack[2 * POINTS_MAX + 2][2], depth = 0;
    memset(kept, 0, p->count * sizeof *kept);
    kept[0] = kept[p->count - 1] = true;
    stack[depth][0] = 0;
    stack[depth++][1] = p->count - 1;
    while (depth > 0) {
        size_t first = stack[--depth][0], last = stack[depth][1], at;
        if (last - first < 2 || farthest_of(p, first, last, &at) <= most)
            continue;
        kept[at] = true;
        stack[depth][0] = first;
        stack[depth++][1] = at;
        stack[depth][0] = at;
        stack[depth++][1] = last;
    }
}

static double path_length(const path *p)
{
    double sum = 0;
    for (size_t i = 1; i < p->count; i++) {
        d3 step = minus(p->points[i], p->points[i - 1]);
        sum += sqrt(dot(step, step));
    }
    return sum;
}

static bool add_line(tracer *t, const path *p, size_t first, size_t last, mark_line *line)
{
    marks *m = t->out;
    if (!mem_grow((void **)&m->lines, &m->line_capacity, m->line_count + 1, sizeof *m->lines))
        return false;
    d3     step = minus(p->points[last], p->points[first]);
    double size = sqrt(dot(step, step));
    line->a = rounded(p->points[first]);
    line->b = rounded(p->points[last]);
    line->triangle = p->triangles[(first + last + 1) / 2];
    line->normal = rounded(face_normal(t, line->triangle));
    line->from = line->to;
    line->to = (float)((double)line->from + size);
    m->lines[m->line_count++] = *line;
    m->line_length += size;
    return true;
}

static bool add_stroke(tracer *t, const path *p, const mark_dot *seed, float light, float perspective)
{
    double length = path_length(p);
    if (p->count < 2 || !(length > 0))
        return true;
    bool kept[2 * POINTS_MAX + 1];
    simplify(p, MARK_SAG * length, kept);
    mark_line line = {.middle = seed->position,
                      .middle_normal = seed->normal,
                      .light = light,
                      .perspective = perspective,
                      .span = 1.0f / (float)t->options->series,
                      .length = (float)length,
                      .bright = 1,
                      .stroke = (uint32_t)t->out->stroke_count++};
    size_t    first = t->out->line_count;
    bool      done = true;
    for (size_t last = 0, i = 1; i < p->count && done; i++)
        if (kept[i]) {
            done = add_line(t, p, last, i, &line);
            last = i;
        }
    for (size_t i = first; i < t->out->line_count; i++)
        t->out->lines[i].length = line.to; /* of the chords */
    if (t->out->line_count > first)
        mark_stroke_middle(&t->out->lines[first], t->out->line_count - first);
    return done;
}

/* --- directions ----------------------------------------------------------------------------------------- */

/* Axes of the planes that strokes lie in: askew, so that hardly a face lies in one, and a second one where a
 * surface nearly does. */
static d3 plane_of_model(d3 normal)
{
    const d3     first = {0.5794, -0.4803, 0.6582}, second = {0.8138, 0.2962, -0.5};
    const double FLAT = 0.93;
    return fabs(dot(normal, first)) < FLAT ? first : second;
}

/* The plane of a stroke: turned about the normal from the one that the surface asks for. */
static d3 plane_at(const tracer *t, const mark_dot *seed, int set, double uneven, random_source *r)
{
    const double MOST = 0.35; /* radians */
    d3           normal = face_normal(t, seed->triangle), plane = plane_of_model(normal);
    double       turn = set * (double)t->options->turn + uneven * MOST * random_hand(r);
    /* Rodrigues' rotation. */
    d3     aside = cross(normal, plane);
    double c = cos(turn), s = sin(turn), rest = (1 - c) * dot(normal, plane);
    return unit((d3){c * plane.x + s * aside.x + rest * normal.x, c * plane.y + s * aside.y + rest * normal.y,
                     c * plane.z + s * aside.z + rest * normal.z});
}

typedef struct set_directions {
    const tracer *tracer;
    int           set;
} set_directions;

/* Of a stroke, before its own unevenness. */
static vec3 direction_of_set(void *user, const mark_dot *at)
{
    const set_directions *w = user;
    random_source         none = {0};
    d3                    normal = face_normal(w->tracer, at->triangle);
    return rounded(unit(cross(normal, plane_at(w->tracer, at, w->set, 0, &none))));
}

/* One set of strokes; seeds of a set are spread evenly among themselves. */
static lmn_status trace_set(tracer *t, int set, size_t count, path *p, lmn_error *error)
{
    const trace_options *w = t->options;
    marks                seeds;
    lmn_status status = marks_spread(&seeds, t->surface, count, w->seed + (uint32_t)set * 7919u, direction_of_set,
                                     &(set_directions){t, set}, w->length, error);
    for (size_t i = 0; i < seeds.dot_count && status == LMN_OK; i++) {
        const mark_dot *seed = &seeds.dots[i];
        random_source   r = random_start(w->seed, (uint32_t)(set * 0x10001) ^ (uint32_t)i * 2654435761u);
        d3              plane = plane_at(t, seed, set, (double)w->uneven, &r);
        double          length = w->length * (1 + 0.6 * (double)w->uneven * random_signed(&r));
        walk_both(t, p, seed, plane, length);
        if (!add_stroke(t, p, seed, 1 - (float)set / (float)w->series, seed->priority))
            status = error_memory(error);
        else if (t->out->line_count > LIMIT_MARKS)
            status = error_set(error, LMN_LIMIT, "the strokes on this surface have more than %d pieces", LIMIT_MARKS);
    }
    surface_marks_release(&seeds);
    return status;
}

lmn_status marks_trace(marks *out, const mark_surface *s, const trace_options *options, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->area = mark_surface_area(s);
    if (!(out->area > 0))
        return LMN_OK;
    tracer t = {.surface = s, .options = options, .out = out};
    t.mesh = (primitive){.vertex_count = s->vertex_count,
                         .index_count = 3 * s->triangle_count,
                         .positions = (vec3 *)(uintptr_t)s->positions,
                         .indices = (uint32_t *)(uintptr_t)s->indices,
                         .material = NONE};
    t.across = mesh_adjacency(&t.mesh);
    path      *capacity = mem_alloc(sizeof *capacity);
    lmn_status status = t.across && capacity ? LMN_OK : error_memory(error);
    size_t     each = (options->count + (size_t)options->series - 1) / (size_t)options->series;
    for (int set = 0; set < options->series && status == LMN_OK; set++)
        status = trace_set(&t, set, each, capacity, error);
    for (size_t i = 0; i < out->line_count; i++)
        out->lines[i].density = (float)(out->line_length / out->area);
    mem_free(capacity);
    mem_free(t.across);
    if (status != LMN_OK)
        surface_marks_release(out);
    return status;
}
