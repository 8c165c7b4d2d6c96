#include "feature.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"

const char *const feature_names[FEATURE_CLASSES] = {"silhouette", "border", "crease", "intersection"};

static const double sample_step = 0.2, outside = 3.0; /* px */

void feature_release(feature_lines *f)
{
    free(f->edges);
    free(f->samples);
    *f = (feature_lines){0};
}

static void *grow(void *items, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return items;
    *capacity = *capacity ? 2 * *capacity : 1024;
    void *grown = check_alloc(*capacity, size);
    if (count)
        memcpy(grown, items, count * size);
    free(items);
    return grown;
}

static void add_edge(feature_lines *f, dvec a, dvec b, int64_t first, int64_t second, feature_class kind)
{
    f->edges = grow(f->edges, f->edge_count, &f->edge_capacity, sizeof *f->edges);
    f->edges[f->edge_count++] = (feature){a, b, {first, second}, kind};
}

/* --- edges of the mesh ---------------------------------------------------------------------------------- */

/* A triangle's side, its ends ordered, so that the two sides of an edge compare equal. */
typedef struct side {
    dvec     low, high;
    uint32_t part, triangle;
} side;

static int compare_points(dvec a, dvec b)
{
    if (a.x != b.x)
        return a.x < b.x ? -1 : 1;
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return a.z < b.z ? -1 : a.z > b.z;
}

static int compare_sides(const void *left, const void *right)
{
    const side *a = left, *b = right;
    if (a->part != b->part)
        return a->part < b->part ? -1 : 1;
    int order = compare_points(a->low, b->low);
    order = order ? order : compare_points(a->high, b->high);
    return order ? order : (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static bool same_edge(const side *a, const side *b)
{
    return a->part == b->part && compare_points(a->low, b->low) == 0 && compare_points(a->high, b->high) == 0;
}

static double facing(const trace_triangle *f, dvec viewer, double w)
{
    return dvec_dot(f->flat, w > 0 ? dvec_sub(viewer, f->p[0]) : viewer);
}

static bool is_concave(const trace_triangle *a, const trace_triangle *b)
{
    dvec middle = dvec_scale(dvec_add(dvec_add(b->p[0], b->p[1]), b->p[2]), 1.0 / 3);
    return dvec_dot(a->flat, dvec_sub(middle, a->p[0])) > 0;
}

/* What an edge of two triangles is; FEATURE_CLASSES: nothing. On a closed mesh a concave fold hides its own
 * silhouette. */
static feature_class classify(const trace_triangle *a, const trace_triangle *b, dvec viewer, double w, double crease,
                              bool closed)
{
    double fa = facing(a, viewer, w), fb = facing(b, viewer, w);
    if (fa * fb < 0)
        return closed && is_concave(a, b) ? FEATURE_CLASSES : FEATURE_SILHOUETTE;
    return dvec_dot(a->flat, b->flat) <= crease ? FEATURE_CREASE : FEATURE_CLASSES;
}

static side *sorted_sides(const trace_triangle *triangles, size_t count)
{
    side *sides = check_alloc(3 * count, sizeof *sides);
    for (size_t i = 0; i < 3 * count; i++) {
        const trace_triangle *f = &triangles[i / 3];
        dvec                  a = f->p[i % 3], b = f->p[(i + 1) % 3];
        bool                  turned = compare_points(a, b) > 0;
        sides[i] = (side){turned ? b : a, turned ? a : b, f->part, (uint32_t)(i / 3)};
    }
    qsort(sides, 3 * count, sizeof *sides, compare_sides);
    return sides;
}

static void find_mesh_edges(feature_lines *out, const shape *s, const trace_triangle *triangles, size_t count,
                            const shot *view, double crease)
{
    side  *sides = sorted_sides(triangles, count);
    bool  *closed = check_alloc(s->count, sizeof *closed);
    double w;
    dvec   viewer = shot_viewer(view, &w);
    memset(closed, true, s->count);
    for (int round = 0; round < 2; round++)
        for (size_t i = 0, next; i < 3 * count; i = next) {
            for (next = i + 1; next < 3 * count && same_edge(&sides[i], &sides[next]); next++)
                continue;
            const side *e = &sides[i];
            if (round == 0) {
                closed[e->part] = closed[e->part] && next - i == 2;
            } else if (next - i != 2) {
                add_edge(out, e->low, e->high, e->triangle, TRACE_NONE, FEATURE_BORDER);
            } else {
                feature_class kind = classify(&triangles[e->triangle], &triangles[sides[i + 1].triangle], viewer, w,
                                              crease, closed[e->part]);
                if (kind != FEATURE_CLASSES)
                    add_edge(out, e->low, e->high, e->triangle, sides[i + 1].triangle, kind);
            }
        }
    free(closed);
    free(sides);
}

/* --- where triangles cut each other --------------------------------------------------------------------- */

/* Points where the sides of `a` pass through `b`. */
static int pierce(const trace_triangle *a, const trace_triangle *b, dvec *points, int count)
{
    for (int k = 0; k < 3; k++) {
        dvec   p = a->p[k], q = a->p[(k + 1) % 3];
        double dp = dvec_dot(b->flat, dvec_sub(p, b->p[0])), dq = dvec_dot(b->flat, dvec_sub(q, b->p[0]));
        if (dp * dq >= 0)
            continue;
        dvec x = dvec_mix(p, q, dp / (dp - dq));
        bool inside = true;
        for (int c = 0; c < 3 && inside; c++) {
            dvec along = dvec_sub(b->p[(c + 1) % 3], b->p[c]);
            inside = dvec_dot(dvec_cross(along, dvec_sub(x, b->p[c])), b->flat) >= -1e-12;
        }
        if (inside && count < 6)
            points[count++] = x;
    }
    return count;
}

static bool share_corner(const trace_triangle *a, const trace_triangle *b)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (compare_points(a->p[i], b->p[j]) == 0)
                return true;
    return false;
}

static void cut(feature_lines *out, const trace_triangle *triangles, uint32_t i, uint32_t j)
{
    const trace_triangle *a = &triangles[i], *b = &triangles[j];
    dvec                  points[6];
    int                   from = 0, to = 0;
    if (a->part == b->part && share_corner(a, b))
        return;
    int count = pierce(b, a, points, pierce(a, b, points, 0));
    for (int k = 0; k < count; k++)
        for (int l = 0; l < k; l++)
            if (dvec_length(dvec_sub(points[k], points[l])) > dvec_length(dvec_sub(points[from], points[to]))) {
                from = k;
                to = l;
            }
    if (from != to)
        add_edge(out, points[from], points[to], i, j, FEATURE_INTERSECTION);
}

typedef struct extent {
    double   low[3], high[3];
    uint32_t triangle;
} extent;

static int compare_extents(const void *left, const void *right)
{
    const extent *a = left, *b = right;
    return (a->low[0] > b->low[0]) - (a->low[0] < b->low[0]);
}

static void find_cuts(feature_lines *out, const trace_triangle *triangles, size_t count)
{
    extent *boxes = check_alloc(count, sizeof *boxes);
    for (size_t i = 0; i < count; i++) {
        const dvec *p = triangles[i].p;
        boxes[i] = (extent){{fmin(p[0].x, fmin(p[1].x, p[2].x)), fmin(p[0].y, fmin(p[1].y, p[2].y)),
                             fmin(p[0].z, fmin(p[1].z, p[2].z))},
                            {fmax(p[0].x, fmax(p[1].x, p[2].x)), fmax(p[0].y, fmax(p[1].y, p[2].y)),
                             fmax(p[0].z, fmax(p[1].z, p[2].z))},
                            (uint32_t)i};
    }
    qsort(boxes, count, sizeof *boxes, compare_extents);
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count && boxes[j].low[0] <= boxes[i].high[0]; j++) {
            bool apart = false;
            for (int k = 1; k < 3; k++)
                apart = apart || boxes[j].low[k] > boxes[i].high[k] || boxes[i].low[k] > boxes[j].high[k];
            if (!apart)
                cut(out, triangles, boxes[i].triangle, boxes[j].triangle);
        }
    free(boxes);
}

/* --- visibility ----------------------------------------------------------------------------------------- */

static bool is_visible(const tracer *t, const feature *e, dvec point, dvec viewer, double w)
{
    trace_hit hit;
    if (w > 0)
        return !tracer_hit(t, viewer, dvec_sub(point, viewer), 0, 1 - 1e-7, e->triangles, &hit);
    dvec towards = dvec_unit(viewer);
    return !tracer_hit(t, point, towards, 1e-7, INFINITY, e->triangles, &hit);
}

/* Samples are even on the picture; perspective asks for other steps on the line. */
static void sample_edge(feature_lines *out, const tracer *t, const shot *view, const feature *e, dvec viewer, double w)
{
    dvec a = shot_project(view, e->a), b = shot_project(view, e->b);
    if (a.z <= 0 || b.z <= 0)
        return;
    double length = hypot(b.x - a.x, b.y - a.y);
    int    count = (int)ceil(length / sample_step);
    bool   seen = false;
    for (int i = 0; i < count; i++) {
        double s = (i + 0.5) / count, t3 = s * a.z / (b.z + s * (a.z - b.z));
        double x = a.x + s * (b.x - a.x), y = a.y + s * (b.y - a.y);
        if (x < -outside || y < -outside || x > view->width + outside || y > view->height + outside)
            continue;
        if (!is_visible(t, e, dvec_mix(e->a, e->b, t3), viewer, w))
            continue;
        seen = true;
        out->samples = grow(out->samples, out->sample_count, &out->sample_capacity, sizeof *out->samples);
        out->samples[out->sample_count++] = (feature_sample){(float)x, (float)y, e->kind};
    }
    out->visible_edges += seen;
}

void feature_find(feature_lines *out, const shape *s, const tracer *t, const shot *view, double crease_degrees)
{
    size_t                count;
    const trace_triangle *triangles = tracer_triangles(t, &count);
    *out = (feature_lines){0};
    find_mesh_edges(out, s, triangles, count, view, cos(crease_degrees * 3.14159265358979323846 / 180) + 1e-9);
    find_cuts(out, triangles, count);
    double w;
    dvec   viewer = shot_viewer(view, &w);
    for (size_t i = 0; i < out->edge_count; i++)
        sample_edge(out, t, view, &out->edges[i], viewer, w);
}

/* --- score ---------------------------------------------------------------------------------------------- */

static bool ink_within(const shot *s, double x, double y, double radius)
{
    for (int j = (int)floor(y - radius - 0.5); j <= (int)ceil(y + radius); j++)
        for (int i = (int)floor(x - radius - 0.5); i <= (int)ceil(x + radius); i++)
            if (i >= 0 && j >= 0 && i < s->width && j < s->height && hypot(i + 0.5 - x, j + 0.5 - y) <= radius &&
                shot_ink(s, i, j) <= 127)
                return true;
    return false;
}

static void mark_near(bool *near, const shot *s, double x, double y, double radius)
{
    for (int j = (int)floor(y - radius - 0.5); j <= (int)ceil(y + radius); j++)
        for (int i = (int)floor(x - radius - 0.5); i <= (int)ceil(x + radius); i++)
            if (i >= 0 && j >= 0 && i < s->width && j < s->height && hypot(i + 0.5 - x, j + 0.5 - y) <= radius)
                near[(size_t)j * (size_t)s->width + (size_t)i] = true;
}

static void put_pixel(uint8_t *pixels, const shot *s, double x, double y, const uint8_t rgb[3])
{
    int i = (int)floor(x), j = (int)floor(y);
    if (i >= 0 && j >= 0 && i < s->width && j < s->height)
        memcpy(&pixels[4 * ((size_t)j * (size_t)s->width + (size_t)i)], rgb, 3);
}

feature_score feature_compare(const feature_lines *f, const shot *s, const char *path)
{
    static const uint8_t black[] = {0, 0, 0}, green[] = {0, 190, 0}, red[] = {255, 0, 0}, blue[] = {0, 0, 255};
    feature_score        score = {0};
    size_t   count = (size_t)s->width * (size_t)s->height, found = 0, wrong = 0, found_of[FEATURE_CLASSES] = {0};
    bool    *near = check_alloc(count, sizeof *near);
    uint8_t *pixels = check_alloc(count, 4);
    memset(pixels, 255, count * 4);
    for (size_t i = 0; i < f->sample_count; i++)
        mark_near(near, s, (double)f->samples[i].x, (double)f->samples[i].y, 2.5);
    for (size_t i = 0; i < count; i++) {
        int x = (int)(i % (size_t)s->width), y = (int)(i / (size_t)s->width);
        if (shot_ink(s, x, y) > 127)
            continue;
        score.ink++;
        wrong += !near[i];
        put_pixel(pixels, s, x, y, near[i] ? black : blue);
    }
    for (size_t i = 0; i < f->sample_count; i++) {
        double x = (double)f->samples[i].x, y = (double)f->samples[i].y;
        if (x < 0 || y < 0 || x > s->width || y > s->height)
            continue;
        bool has_ink = ink_within(s, x, y, 1.5);
        score.samples++;
        score.samples_of[f->samples[i].kind]++;
        found += has_ink;
        found_of[f->samples[i].kind] += has_ink;
        put_pixel(pixels, s, x, y, has_ink ? green : red);
    }
    score.recall = score.samples ? (double)found / (double)score.samples : 1;
    score.false_ink = score.ink ? (double)wrong / (double)score.ink : 0;
    for (int k = 0; k < FEATURE_CLASSES; k++)
        score.recall_of[k] = score.samples_of[k] ? (double)found_of[k] / (double)score.samples_of[k] : 1;
    if (path)
        picture_write_rgba(path, pixels, s->width, s->height);
    free(near);
    free(pixels);
    return score;
}
