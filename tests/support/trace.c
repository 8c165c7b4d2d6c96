#include "trace.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

/* Below DEEP levels nodes are halved, so that no tree outgrows the stack. */
enum { LEAF = 4, STACK = 64, BINS = 16, DEEP = 28 };

typedef struct box {
    double side[2][3]; /* least and greatest corner */
} box;

typedef struct bvh_node {
    box      bounds;
    uint32_t first, count; /* count > 0: a leaf of triangles order[first…]; else children first and first + 1, cut along
                              this axis */
    int axis;
} bvh_node;

struct tracer {
    trace_triangle *triangles;
    uint32_t       *order;
    bvh_node       *nodes;
    size_t          count, node_count;
};

static double axis_of(dvec v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static void collect(tracer *t, const shape *s)
{
    size_t at = 0;
    for (size_t i = 0; i < s->count; i++)
        at += s->parts[i].index_count / 3;
    t->triangles = check_alloc(at, sizeof *t->triangles);
    at = 0;
    for (size_t i = 0; i < s->count; i++) {
        const shape_part *p = &s->parts[i];
        for (uint32_t k = 0; k < p->index_count; k += 3) {
            trace_triangle *f = &t->triangles[at++];
            f->part = (uint32_t)i;
            for (uint32_t c = 0; c < 3; c++)
                f->p[c] = shape_point(p, p->indices[k + c]);
            f->flat = dvec_unit(dvec_cross(dvec_sub(f->p[1], f->p[0]), dvec_sub(f->p[2], f->p[0])));
            for (uint32_t c = 0; c < 3; c++)
                f->n[c] = p->normals ? shape_normal(p, p->indices[k + c]) : f->flat;
        }
    }
    t->count = at;
}

static const box nothing = {{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}};

static void grow(box *b, const box *other)
{
    for (int a = 0; a < 3; a++) {
        b->side[0][a] = other->side[0][a] < b->side[0][a] ? other->side[0][a] : b->side[0][a];
        b->side[1][a] = other->side[1][a] > b->side[1][a] ? other->side[1][a] : b->side[1][a];
    }
}

static box box_of(const trace_triangle *f)
{
    box b = nothing;
    for (int c = 0; c < 3; c++) {
        box corner = {{{f->p[c].x, f->p[c].y, f->p[c].z}, {f->p[c].x, f->p[c].y, f->p[c].z}}};
        grow(&b, &corner);
    }
    return b;
}

/* Half of a box's surface: how many rays meet it. */
static double surface_of(const box *b)
{
    double x = b->side[1][0] - b->side[0][0], y = b->side[1][1] - b->side[0][1], z = b->side[1][2] - b->side[0][2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

static double middle_of(const tracer *t, uint32_t triangle, int axis)
{
    const trace_triangle *f = &t->triangles[triangle];
    return (axis_of(f->p[0], axis) + axis_of(f->p[1], axis) + axis_of(f->p[2], axis)) / 3;
}

/* The best of the borders between bins along an axis: the surfaces of both sides, each times what is in it. */
static double best_border(const tracer *t, uint32_t first, uint32_t count, int axis, double low, double high,
                          double *border)
{
    box      boxes[BINS];
    uint32_t counts[BINS] = {0}, left_count = 0;
    double   costs[BINS] = {0}, least = INFINITY, width = (high - low) / BINS;
    for (int k = 0; k < BINS; k++)
        boxes[k] = nothing;
    for (uint32_t i = first; i < first + count; i++) {
        box own = box_of(&t->triangles[t->order[i]]);
        int bin = (int)((middle_of(t, t->order[i], axis) - low) / width);
        bin = bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
        grow(&boxes[bin], &own);
        counts[bin]++;
    }
    box left = nothing, right = nothing;
    for (int k = 0; k + 1 < BINS; k++) {
        grow(&left, &boxes[k]);
        left_count += counts[k];
        costs[k] = surface_of(&left) * left_count;
    }
    for (int k = BINS - 1; k > 0; k--) {
        grow(&right, &boxes[k]);
        uint32_t right_count = 0;
        for (int i = k; i < BINS; i++)
            right_count += counts[i];
        double cost = costs[k - 1] + surface_of(&right) * right_count;
        if (cost < least) {
            least = cost;
            *border = low + k * width;
        }
    }
    return least;
}

/* Where and along which axis to split; the middles that border lies between. */
static double border_of(const tracer *t, uint32_t first, uint32_t count, int *axis)
{
    double least = INFINITY, border = 0;
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY, at = 0;
        for (uint32_t i = first; i < first + count; i++) {
            double middle = middle_of(t, t->order[i], a);
            low = middle < low ? middle : low;
            high = middle > high ? middle : high;
        }
        double cost = high > low ? best_border(t, first, count, a, low, high, &at) : INFINITY;
        if (cost < least) {
            least = cost;
            border = at;
            *axis = a;
        }
    }
    return border;
}

static uint32_t sort_by(tracer *t, uint32_t first, uint32_t count, int axis, double border)
{
    uint32_t left = first;
    for (uint32_t i = first; i < first + count; i++)
        if (middle_of(t, t->order[i], axis) < border) {
            uint32_t moved = t->order[i];
            t->order[i] = t->order[left];
            t->order[left++] = moved;
        }
    return left;
}

/* Splits where rays then meet the fewest triangles; when that leaves one half empty, by count. */
static void split(tracer *t, size_t index, uint32_t first, uint32_t count, int level)
{
    bvh_node *node = &t->nodes[index];
    node->bounds = nothing;
    for (uint32_t i = first; i < first + count; i++) {
        box own = box_of(&t->triangles[t->order[i]]);
        grow(&node->bounds, &own);
    }
    if (count <= LEAF) {
        node->first = first;
        node->count = count;
        return;
    }
    int      axis = 0;
    double   border = level < DEEP ? border_of(t, first, count, &axis) : 0;
    uint32_t left = level < DEEP ? sort_by(t, first, count, axis, border) : first;
    if (left == first || left == first + count)
        left = first + count / 2;
    size_t child = t->node_count;
    t->node_count += 2;
    node->first = (uint32_t)child;
    node->axis = axis;
    split(t, child, first, left - first, level + 1);
    split(t, child + 1, left, first + count - left, level + 1);
}

/* A hair wider than what is in them: then rounding loses no ray, and none lies in a side. */
static void pad(tracer *t)
{
    double hair = 0;
    for (int a = 0; a < 3; a++)
        hair = fmax(hair, fmax(fabs(t->nodes[0].bounds.side[0][a]), fabs(t->nodes[0].bounds.side[1][a])));
    for (size_t i = 0; i < t->node_count; i++)
        for (int a = 0; a < 3; a++) {
            t->nodes[i].bounds.side[0][a] -= 1e-9 * hair;
            t->nodes[i].bounds.side[1][a] += 1e-9 * hair;
        }
}

static tracer *with_tree(tracer *t)
{
    t->order = check_alloc(t->count, sizeof *t->order);
    for (uint32_t i = 0; i < t->count; i++)
        t->order[i] = i;
    t->nodes = check_alloc(2 * t->count + 1, sizeof *t->nodes);
    t->node_count = 1;
    split(t, 0, 0, (uint32_t)t->count, 0);
    if (t->count)
        pad(t);
    return t;
}

tracer *tracer_create(const shape *s)
{
    tracer *t = check_alloc(1, sizeof *t);
    collect(t, s);
    return with_tree(t);
}

tracer *tracer_of_triangles(trace_triangle *triangles, size_t count)
{
    tracer *t = check_alloc(1, sizeof *t);
    t->triangles = triangles;
    t->count = count;
    return with_tree(t);
}

tracer *tracer_of_parts(const shape *s, const char *prefix, bool with)
{
    shape some = {.parts = check_alloc(s->count, sizeof *some.parts), .count = s->count};
    memcpy(some.parts, s->parts, s->count * sizeof *some.parts);
    for (size_t i = 0; i < s->count; i++)
        if ((strncmp(s->parts[i].name, prefix, strlen(prefix)) == 0) != with)
            some.parts[i].index_count = 0;
    tracer *t = tracer_create(&some);
    free(some.parts);
    return t;
}

void tracer_destroy(tracer *t)
{
    if (!t)
        return;
    free(t->triangles);
    free(t->order);
    free(t->nodes);
    free(t);
}

const trace_triangle *tracer_triangles(const tracer *t, size_t *count)
{
    *count = t->count;
    return t->triangles;
}

/* The weights get a hair of tolerance so that no ray slips through between two triangles. */
static bool hit_triangle(const trace_triangle *f, dvec origin, dvec direction, double low, double high, trace_hit *out)
{
    const double slack = 1e-12;
    dvec         a = dvec_sub(f->p[1], f->p[0]), b = dvec_sub(f->p[2], f->p[0]);
    dvec         across = dvec_cross(direction, b);
    double       det = dvec_dot(a, across);
    if (det == 0)
        return false;
    dvec   from = dvec_sub(origin, f->p[0]);
    double u = dvec_dot(from, across) / det;
    if (u < -slack || u > 1 + slack)
        return false;
    dvec   q = dvec_cross(from, a);
    double v = dvec_dot(direction, q) / det;
    if (v < -slack || u + v > 1 + slack)
        return false;
    double t = dvec_dot(b, q) / det;
    if (!(t > low && t < high))
        return false;
    out->t = t;
    out->u = u;
    out->v = v;
    return true;
}

/* What a ray asks of boxes. */
typedef struct box_ray {
    double origin[3], inverse[3];
    int    back[3]; /* runs towards lower coordinates */
} box_ray;

/* Along an axis that a ray does not run along, it is in a box for all its length or never: times far beyond any other.
 */
static box_ray box_ray_of(dvec origin, dvec direction)
{
    box_ray r = {.origin = {origin.x, origin.y, origin.z}};
    for (int a = 0; a < 3; a++) {
        double d = axis_of(direction, a);
        r.inverse[a] = fabs(d) > 1e-200 ? 1 / d : 1e200;
        r.back[a] = r.inverse[a] < 0;
    }
    return r;
}

/* Comparisons and not fmin and fmax, which are calls of the library: most of a tracer's time is spent here. */
static inline bool hit_box(const box *b, const box_ray *r, double low, double high)
{
    for (int a = 0; a < 3; a++) {
        double near = (b->side[r->back[a]][a] - r->origin[a]) * r->inverse[a],
               far = (b->side[!r->back[a]][a] - r->origin[a]) * r->inverse[a];
        low = near > low ? near : low;
        high = far < high ? far : high;
    }
    return low <= high;
}

/* The first hit, or `any` hit, whichever comes up. */
static bool search(const tracer *t, dvec origin, dvec direction, double low, double high, const int64_t skip[2],
                   bool any, trace_hit *out)
{
    box_ray  ray = box_ray_of(origin, direction);
    uint32_t stack[STACK];
    int      depth = 0;
    bool     found = false;
    if (t->count)
        stack[depth++] = 0;
    while (depth > 0) {
        const bvh_node *node = &t->nodes[stack[--depth]];
        if (!hit_box(&node->bounds, &ray, low, high))
            continue;
        if (node->count == 0 && depth + 2 <= STACK) { /* the nearer child is on top */
            bool nearer = ray.back[node->axis];
            stack[depth++] = node->first + !nearer;
            stack[depth++] = node->first + nearer;
        }
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            uint32_t triangle = t->order[i];
            if (skip && (skip[0] == triangle || skip[1] == triangle))
                continue;
            if (hit_triangle(&t->triangles[triangle], origin, direction, low, high, out)) {
                out->triangle = triangle;
                high = out->t;
                found = true;
                if (any)
                    return true;
            }
        }
    }
    return found;
}

bool tracer_hit(const tracer *t, dvec origin, dvec direction, double low, double high, const int64_t skip[2],
                trace_hit *out)
{
    return search(t, origin, direction, low, high, skip, false, out);
}

bool tracer_blocked(const tracer *t, dvec origin, dvec direction, double low, double high, uint32_t *last)
{
    trace_hit hit;
    if (*last < t->count && hit_triangle(&t->triangles[*last], origin, direction, low, high, &hit))
        return true;
    if (!search(t, origin, direction, low, high, NULL, true, &hit))
        return false;
    *last = hit.triangle;
    return true;
}

static int by_distance(const void *a, const void *b)
{
    const trace_hit *one = a, *other = b;
    if (one->t < other->t || one->t > other->t)
        return one->t < other->t ? -1 : 1;
    return one->triangle < other->triangle ? -1 : one->triangle > other->triangle;
}

size_t tracer_hits(const tracer *t, dvec origin, dvec direction, double low, double high, trace_hit *out,
                   size_t capacity)
{
    box_ray  ray = box_ray_of(origin, direction);
    uint32_t stack[STACK];
    int      depth = 0;
    size_t   found = 0;
    if (t->count)
        stack[depth++] = 0;
    while (depth > 0) {
        const bvh_node *node = &t->nodes[stack[--depth]];
        if (!hit_box(&node->bounds, &ray, low, high))
            continue;
        if (node->count == 0 && depth + 2 <= STACK) {
            stack[depth++] = node->first;
            stack[depth++] = node->first + 1;
        }
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            trace_hit hit = {.triangle = t->order[i]};
            if (!hit_triangle(&t->triangles[hit.triangle], origin, direction, low, high, &hit))
                continue;
            if (found < capacity)
                out[found] = hit;
            found++;
        }
    }
    qsort(out, found < capacity ? found : capacity, sizeof *out, by_distance);
    return found;
}

/* One ray's answer: depth, normal and id where it hits; empty otherwise. */
static uint16_t look_at(const tracer *t, const shot *view, double x, double y, double *depth, dvec *normal)
{
    dvec      origin, direction;
    trace_hit hit;
    shot_ray(view, x, y, &origin, &direction);
    *depth = INFINITY;
    *normal = dvec_of(0, 0, 0);
    /* Parallel rays begin nowhere: the near plane is tight around the scene. */
    if (!tracer_hit(t, origin, direction, view->orthographic ? -INFINITY : 0, INFINITY, NULL, &hit))
        return 0;
    const trace_triangle *f = &t->triangles[hit.triangle];
    dvec                  point = dvec_add(origin, dvec_scale(direction, hit.t));
    dvec                  n = dvec_add(dvec_scale(f->n[0], 1 - hit.u - hit.v),
                                       dvec_add(dvec_scale(f->n[1], hit.u), dvec_scale(f->n[2], hit.v)));
    *depth = -shot_to_eye(view, point, 1).z;
    *normal = dvec_unit(shot_to_eye(view, n, 0));
    return (uint16_t)(f->part + 1);
}

double trace_normal_error(const tracer *t, const shot *view, int x, int y, dvec normal)
{
    static const double shift[5][2] = {{0, 0}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    double              least = INFINITY, depth;
    dvec                other;
    for (int k = 0; k < 5; k++)
        if (look_at(t, view, x + 0.5 + shift[k][0] / 128, y + 0.5 + shift[k][1] / 128, &depth, &other))
            least = fmin(least, dvec_length(dvec_sub(normal, other)));
    return least;
}

void trace_map_make(trace_map *out, const tracer *t, const shot *view)
{
    size_t count = (size_t)view->width * (size_t)view->height;
    out->width = view->width;
    out->height = view->height;
    out->depth = check_alloc(count, sizeof *out->depth);
    out->normal = check_alloc(count, sizeof *out->normal);
    out->id = check_alloc(count, sizeof *out->id);
    for (size_t i = 0; i < count; i++)
        out->id[i] = look_at(t, view, (double)(i % (size_t)view->width) + 0.5, (double)(i / (size_t)view->width) + 0.5,
                             &out->depth[i], &out->normal[i]);
}

void trace_map_release(trace_map *m)
{
    free(m->depth);
    free(m->normal);
    free(m->id);
    *m = (trace_map){0};
}

bool trace_map_border(const trace_map *m, int x, int y, double fraction)
{
    size_t own = (size_t)y * (size_t)m->width + (size_t)x;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= m->width || j >= m->height)
                continue;
            size_t at = (size_t)j * (size_t)m->width + (size_t)i;
            if (m->id[at] != m->id[own])
                return true;
            if (m->id[own] && fabs(m->depth[at] - m->depth[own]) > fraction * m->depth[own])
                return true;
        }
    return false;
}
