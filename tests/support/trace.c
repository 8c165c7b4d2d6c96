#include "trace.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { LEAF = 4, STACK = 64 };

typedef struct box {
    double low[3], high[3];
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

static box bounds_of(const tracer *t, uint32_t first, uint32_t count)
{
    box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = first; i < first + count; i++)
        for (int c = 0; c < 3; c++)
            for (int a = 0; a < 3; a++) {
                double v = axis_of(t->triangles[t->order[i]].p[c], a);
                b.low[a] = fmin(b.low[a], v);
                b.high[a] = fmax(b.high[a], v);
            }
    return b;
}

static double middle_of(const tracer *t, uint32_t triangle, int axis)
{
    const trace_triangle *f = &t->triangles[triangle];
    return axis_of(f->p[0], axis) + axis_of(f->p[1], axis) + axis_of(f->p[2], axis);
}

/* Splits at the middle of the longest side; when that leaves one half empty, by count. */
static void split(tracer *t, size_t index, uint32_t first, uint32_t count)
{
    bvh_node *node = &t->nodes[index];
    node->bounds = bounds_of(t, first, count);
    if (count <= LEAF) {
        node->first = first;
        node->count = count;
        return;
    }
    int axis = 0;
    for (int a = 1; a < 3; a++)
        if (node->bounds.high[a] - node->bounds.low[a] > node->bounds.high[axis] - node->bounds.low[axis])
            axis = a;
    double   border = 1.5 * (node->bounds.low[axis] + node->bounds.high[axis]);
    uint32_t left = first;
    for (uint32_t i = first; i < first + count; i++)
        if (middle_of(t, t->order[i], axis) < border) {
            uint32_t moved = t->order[i];
            t->order[i] = t->order[left];
            t->order[left++] = moved;
        }
    if (left == first || left == first + count)
        left = first + count / 2;
    size_t child = t->node_count;
    t->node_count += 2;
    node->first = (uint32_t)child;
    node->axis = axis;
    split(t, child, first, left - first);
    split(t, child + 1, left, first + count - left);
}

static tracer *with_tree(tracer *t)
{
    t->order = check_alloc(t->count, sizeof *t->order);
    for (uint32_t i = 0; i < t->count; i++)
        t->order[i] = i;
    t->nodes = check_alloc(2 * t->count + 1, sizeof *t->nodes);
    t->node_count = 1;
    split(t, 0, 0, (uint32_t)t->count);
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

/* Comparisons and not fmin and fmax, which are calls of the library: most of a tracer's time is spent here. */
static bool hit_box(const box *b, const double origin[3], const double inverse[3], double low, double high)
{
    for (int a = 0; a < 3; a++) {
        if (inverse[a] > DBL_MAX || inverse[a] < -DBL_MAX) { /* along the slab: in it or not */
            if (origin[a] < b->low[a] || origin[a] > b->high[a])
                return false;
            continue;
        }
        bool   forward = inverse[a] >= 0;
        double near = ((forward ? b->low[a] : b->high[a]) - origin[a]) * inverse[a],
               far = ((forward ? b->high[a] : b->low[a]) - origin[a]) * inverse[a];
        near -= near > 0 ? 1e-12 * near : -1e-12 * near;
        far += far > 0 ? 1e-12 * far : -1e-12 * far;
        low = near > low ? near : low;
        high = far < high ? far : high;
    }
    return low <= high;
}

/* The first hit, or `any` hit, whichever comes up. */
static bool search(const tracer *t, dvec origin, dvec direction, double low, double high, const int64_t skip[2],
                   bool any, trace_hit *out)
{
    double   o[3] = {origin.x, origin.y, origin.z};
    double   inverse[3] = {1 / direction.x, 1 / direction.y, 1 / direction.z};
    uint32_t stack[STACK];
    int      depth = 0;
    bool     found = false;
    if (t->count)
        stack[depth++] = 0;
    while (depth > 0) {
        const bvh_node *node = &t->nodes[stack[--depth]];
        if (!hit_box(&node->bounds, o, inverse, low, high))
            continue;
        if (node->count == 0 && depth + 2 <= STACK) { /* the nearer child is on top */
            bool nearer = inverse[node->axis] < 0;
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
    double   o[3] = {origin.x, origin.y, origin.z};
    double   inverse[3] = {1 / direction.x, 1 / direction.y, 1 / direction.z};
    uint32_t stack[STACK];
    int      depth = 0;
    size_t   found = 0;
    if (t->count)
        stack[depth++] = 0;
    while (depth > 0) {
        const bvh_node *node = &t->nodes[stack[--depth]];
        if (!hit_box(&node->bounds, o, inverse, low, high))
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
