/* Marks in clusters (marks/clusters.h): halved again and again at the median of what they differ in most, place or
 * normal. */
#include "marks/clusters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "marks/d3.h"

enum { CLUSTER_MARKS = 256, CLUSTERS_MOST = 1024, KEYS = 6 };

/* What marks are grouped by: place as a fraction of the surface's extent, weighed against the normal. */
static const double PLACE_WEIGHT = 3;

typedef struct grouping {
    const marks        *marks;
    const mark_surface *surface;
    float (*keys)[KEYS];
    uint32_t     *order, *triangles; /* the latter by the number of the mark */
    float        *ranks;             /* by the number of the mark */
    mark_cluster *clusters;
    size_t        count, capacity, most; /* most: marks of a cluster */
} grouping;

static d3 unit(d3 a)
{
    double length = sqrt(dot(a, a));
    return length > 0 ? (d3){a.x / length, a.y / length, a.z / length} : (d3){0, 0, 1};
}

static d3 face_of(const mark_surface *s, uint32_t triangle)
{
    const uint32_t *t = &s->indices[3 * (size_t)triangle];
    d3              a = of(s->positions[t[0]]), b = of(s->positions[t[1]]), c = of(s->positions[t[2]]);
    d3              n = cross(minus(b, a), minus(c, a));
    d3              look = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        d3 own = of(s->normals[t[k]]);
        look = (d3){look.x + own.x, look.y + own.y, look.z + own.z};
    }
    n = unit(n);
    /* By normals and not by the way round of corners, which differs between files. */
    return dot(n, look) < 0 ? (d3){-n.x, -n.y, -n.z} : n;
}

static size_t count_of(const marks *m)
{
    return m->dot_count ? m->dot_count : m->line_count;
}

/* The triangle that each mark is decided on: of a stroke that is drawn whole, in its middle. */
static void find_triangles(const marks *m, uint32_t *out)
{
    for (size_t i = 0; i < m->dot_count; i++)
        out[i] = m->dots[i].triangle;
    for (size_t i = 0, next; m->dot_count == 0 && i < m->line_count; i = next) {
        const mark_line *first = &m->lines[i];
        uint32_t         triangle = first->triangle;
        for (next = i + 1; !m->flow && next < m->line_count && m->lines[next].stroke == first->stroke; next++)
            if (m->lines[next].from < first->length / 2)
                triangle = m->lines[next].triangle;
        for (size_t k = i; k < next; k++)
            out[k] = triangle;
    }
}

/* Positions at which a mark is decided, with the normals there; returns how many. */
static int decided_at(const marks *m, size_t i, d3 at[2], d3 normals[2])
{
    if (m->dot_count) {
        at[0] = of(m->dots[i].position);
        normals[0] = of(m->dots[i].normal);
        return 1;
    }
    const mark_line *l = &m->lines[i];
    at[0] = of(m->flow ? l->a : l->middle);
    normals[0] = of(m->flow ? l->ends[0].normal : l->middle_normal);
    at[1] = of(l->b);
    normals[1] = of(l->ends[1].normal);
    return m->flow ? 2 : 1;
}

/* The least fraction of all marks with which it is drawn. Lines of the first level never go. */
static float rank_of(const marks *m, size_t i)
{
    if (m->dot_count)
        return 1 - m->dots[i].priority;
    return m->flow && m->lines[i].level == 0 ? 0 : 1 - m->lines[i].perspective;
}

/* --- bounds --------------------------------------------------------------------------------------------- */

static void widen(double low[3], double high[3], d3 p)
{
    const double v[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(low[k], v[k]);
        high[k] = fmax(high[k], v[k]);
    }
}

static double angle_between(d3 a, d3 b)
{
    return acos(fmin(fmax(dot(unit(a), unit(b)), -1), 1));
}

/* Of a mark that runs along a direction; dots do not. */
static double steepness_of(const marks *m, size_t i, d3 normal)
{
    if (m->dot_count)
        return 0;
    const mark_line *l = &m->lines[i];
    d3               along = m->flow ? minus(of(l->b), of(l->a)) : of(l->middle_direction);
    return fabs(dot(unit(along), unit(normal)));
}

static double lean_of(d3 normal, d3 face)
{
    const double SPARE = 0.02, NEVER = 2;
    double       angle = angle_between(normal, face);
    return angle < 1.4 ? sin(angle) + SPARE : NEVER;
}

/* Returns how far its normal leans. */
static double measure_mark(const grouping *g, mark_cluster *c, size_t i)
{
    const marks *m = g->marks;
    d3           at[2], normals[2], axis = {c->axis[0], c->axis[1], c->axis[2]};
    int          count = decided_at(m, i, at, normals);
    double       lean = lean_of(normals[0], face_of(g->surface, g->triangles[i]));
    c->lean = fmax(c->lean, lean);
    for (int k = 0; k < count; k++) {
        widen(c->decided[0], c->decided[1], at[k]);
        c->spread = fmax(c->spread, angle_between(normals[k], axis));
        c->steepest = fmax(c->steepest, steepness_of(m, i, normals[k]));
    }
    if (m->dot_count) {
        widen(c->low, c->high, at[0]);
    } else {
        widen(c->low, c->high, of(m->lines[i].a));
        widen(c->low, c->high, of(m->lines[i].b));
        c->density = fmin(c->density, (double)m->lines[i].density);
    }
    return lean;
}

static void measure(const grouping *g, mark_cluster *c, float *leans)
{
    const marks *m = g->marks;
    d3           axis = {0, 0, 0};
    for (uint32_t i = 0; i < c->count; i++) {
        d3 at[2], normals[2];
        decided_at(m, g->order[c->first + i], at, normals);
        axis = (d3){axis.x + normals[0].x, axis.y + normals[0].y, axis.z + normals[0].z};
    }
    axis = unit(axis);
    *c = (mark_cluster){.first = c->first,
                        .count = c->count,
                        .low = {INFINITY, INFINITY, INFINITY},
                        .high = {-INFINITY, -INFINITY, -INFINITY},
                        .decided = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}},
                        .axis = {axis.x, axis.y, axis.z},
                        .density = m->dot_count ? (double)m->dot_count / m->area : INFINITY};
    for (uint32_t i = 0; i < c->count; i++)
        leans[c->first + i] = (float)measure_mark(g, c, g->order[c->first + i]);
}

/* --- grouping ------------------------------------------------------------------------------------------- */

static bool goes_before(const grouping *g, int key, uint32_t a, uint32_t b)
{
    float x = g->keys[a][key], y = g->keys[b][key];
    return x != y ? x < y : a < b;
}

static void swap(uint32_t *a, uint32_t *b)
{
    uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

/* Orders a range so far that no mark before the middle has a larger key than one behind it (Hoare's selection). */
static void select_middle(const grouping *g, int key, uint32_t *order, size_t count)
{
    size_t low = 0, high = count - 1, middle = count / 2;
    while (low < high) {
        size_t half = low + (high - low) / 2;
        if (goes_before(g, key, order[half], order[low]))
            swap(&order[half], &order[low]);
        if (goes_before(g, key, order[high], order[low]))
            swap(&order[high], &order[low]);
        if (goes_before(g, key, order[high], order[half]))
            swap(&order[high], &order[half]);
        uint32_t pivot = order[half];
        size_t   i = low, j = high;
        for (;;) {
            while (goes_before(g, key, order[i], pivot))
                i++;
            while (goes_before(g, key, pivot, order[j]))
                j--;
            if (i >= j)
                break;
            swap(&order[i++], &order[j--]);
        }
        if (middle <= j)
            high = j;
        else
            low = j + 1;
    }
}

static int widest_key(const grouping *g, const uint32_t *order, size_t count)
{
    double most = -1;
    int    key = 0;
    for (int k = 0; k < KEYS; k++) {
        float low = g->keys[order[0]][k], high = low;
        for (size_t i = 1; i < count; i++) {
            low = fminf(low, g->keys[order[i]][k]);
            high = fmaxf(high, g->keys[order[i]][k]);
        }
        if ((double)high - (double)low > most) {
            most = (double)high - (double)low;
            key = k;
        }
    }
    return key;
}

static void split(grouping *g, size_t first, size_t count)
{
    if (count > g->most) {
        size_t half = count / 2;
        select_middle(g, widest_key(g, g->order + first, count), g->order + first, count);
        split(g, first, half);
        split(g, first + half, count - half);
        return;
    }
    if (g->count < g->capacity)
        g->clusters[g->count++] = (mark_cluster){.first = (uint32_t)first, .count = (uint32_t)count};
}

typedef struct ranked {
    float    rank;
    uint32_t mark;
} ranked;

static int by_rank(const void *left, const void *right)
{
    const ranked *a = left, *b = right;
    if (a->rank != b->rank)
        return a->rank < b->rank ? -1 : 1;
    return a->mark < b->mark ? -1 : a->mark > b->mark;
}

static bool sort_clusters(grouping *g, float *ranks)
{
    ranked *room = mem_alloc(g->most * sizeof *room);
    for (size_t k = 0; room && k < g->count; k++) {
        uint32_t first = g->clusters[k].first, count = g->clusters[k].count;
        for (uint32_t i = 0; i < count; i++)
            room[i] = (ranked){g->ranks[g->order[first + i]], g->order[first + i]};
        qsort(room, count, sizeof *room, by_rank);
        for (uint32_t i = 0; i < count; i++) {
            g->order[first + i] = room[i].mark;
            ranks[first + i] = room[i].rank;
        }
    }
    mem_free(room);
    return room != NULL;
}

static void fill_keys(grouping *g, size_t count)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    d3     at[2], normals[2];
    for (size_t i = 0; i < count; i++) {
        decided_at(g->marks, i, at, normals);
        widen(low, high, at[0]);
    }
    double extent = fmax(sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]) +
                              (high[2] - low[2]) * (high[2] - low[2])),
                         1e-300);
    for (size_t i = 0; i < count; i++) {
        decided_at(g->marks, i, at, normals);
        const double keys[KEYS] = {PLACE_WEIGHT * (at[0].x - low[0]) / extent,
                                   PLACE_WEIGHT * (at[0].y - low[1]) / extent,
                                   PLACE_WEIGHT * (at[0].z - low[2]) / extent,
                                   normals[0].x,
                                   normals[0].y,
                                   normals[0].z};
        for (int k = 0; k < KEYS; k++)
            g->keys[i][k] = isfinite(keys[k]) ? (float)keys[k] : 0;
        g->ranks[i] = rank_of(g->marks, i);
        g->order[i] = (uint32_t)i;
    }
}

bool mark_clusters_make(mark_clusters *out, const marks *m, const mark_surface *s)
{
    size_t   count = count_of(m);
    grouping g = {.marks = m, .surface = s};
    *out = (mark_clusters){.mark_count = count};
    if (!count)
        return true;
    g.most = count / CLUSTERS_MOST + 1 > CLUSTER_MARKS ? count / CLUSTERS_MOST + 1 : CLUSTER_MARKS;
    g.capacity = 2 * (count / g.most) + 2; /* halves of more than that many have at least half as many */
    g.keys = mem_alloc(count * sizeof *g.keys);
    g.ranks = mem_alloc(count * sizeof *g.ranks);
    g.order = out->order = mem_alloc(count * sizeof *g.order);
    g.clusters = out->clusters = mem_alloc(g.capacity * sizeof *g.clusters);
    out->ranks = mem_alloc(count * sizeof *out->ranks);
    out->leans = mem_alloc(count * sizeof *out->leans);
    g.triangles = out->triangles = mem_alloc(count * sizeof *g.triangles);
    bool done = g.keys && g.ranks && g.order && g.clusters && out->ranks && out->leans && g.triangles;
    if (done) {
        find_triangles(m, g.triangles);
        fill_keys(&g, count);
        split(&g, 0, count);
        out->count = g.count;
        done = sort_clusters(&g, out->ranks);
    }
    for (size_t i = 0; done && i < out->count; i++)
        measure(&g, &out->clusters[i], out->leans);
    mem_free(g.keys);
    mem_free(g.ranks);
    if (!done)
        mark_clusters_release(out);
    return done;
}

void mark_clusters_release(mark_clusters *c)
{
    mem_free(c->clusters);
    mem_free(c->order);
    mem_free(c->ranks);
    mem_free(c->leans);
    mem_free(c->triangles);
    *c = (mark_clusters){.count = 0};
}

void mark_clusters_measure(mark_clusters *c, const marks *m, const mark_surface *s)
{
    const grouping g = {.marks = m, .surface = s, .order = c->order, .triangles = c->triangles};
    for (size_t i = 0; i < c->count; i++)
        measure(&g, &c->clusters[i], c->leans);
}

/* --- what a view needs of them -------------------------------------------------------------------------- */

static void corner_of(const double low[3], const double high[3], int i, double out[4])
{
    for (int k = 0; k < 3; k++)
        out[k] = i >> k & 1 ? high[k] : low[k];
    out[3] = 1;
}

static void transform(const mat4 *m, const double p[4], double out[4])
{
    for (int k = 0; k < 4; k++)
        out[k] = m->m[k] * p[0] + m->m[4 + k] * p[1] + m->m[8 + k] * p[2] + m->m[12 + k] * p[3];
}

/* Is all of the box beside the same side of the page, or before the near plane? */
static bool is_beside(const mark_cluster *c, const cluster_view *v)
{
    const double wider[2] = {1 + 2 * v->reach / v->width, 1 + 2 * v->reach / v->height};
    int          beside[5] = {0, 0, 0, 0, 0};
    for (int i = 0; i < 8; i++) {
        double at[4], eye[4], clip[4];
        corner_of(c->low, c->high, i, at);
        transform(&v->model_view, at, eye);
        transform(&v->projection, eye, clip);
        for (int k = 0; k < 2; k++) {
            beside[2 * k] += clip[k] < -wider[k] * clip[3];
            beside[2 * k + 1] += clip[k] > wider[k] * clip[3];
        }
        beside[4] += !v->orthographic && -eye[2] < v->near * 0.999;
    }
    for (int k = 0; k < 5; k++)
        if (beside[k] == 8)
            return true;
    return false;
}

/* The least and the most angle between the axis of its normals and the ways to the viewer, radians. */
static void find_angles(const mark_cluster *c, const cluster_view *v, double *least, double *most)
{
    double middle[4] = {0, 0, 0, 1}, half[3], eye[4], axis[4], around = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (c->decided[0][k] + c->decided[1][k]);
        half[k] = 0.5 * (c->decided[1][k] - c->decided[0][k]);
    }
    double radius = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    transform(&v->model_view, middle, eye);
    transform(&v->model_view, (const double[]){c->axis[0], c->axis[1], c->axis[2], 0}, axis);
    d3     to_viewer = v->orthographic ? (d3){0, 0, 1} : (d3){-eye[0], -eye[1], -eye[2]};
    double distance = sqrt(dot(to_viewer, to_viewer));
    if (!v->orthographic)
        around = radius < distance ? asin(radius / distance) : 4;
    double angle = angle_between((d3){axis[0], axis[1], axis[2]}, to_viewer);
    *least = angle - around;
    *most = angle + around;
}

cluster_fate mark_cluster_fate(const mark_clusters *c, const mark_cluster *cluster, const cluster_view *view)
{
    const double HALF_TURN = 3.14159265358979, SPARE = 0.002; /* radians */
    if (is_beside(cluster, view))
        return CLUSTER_BESIDE;
    double least, most;
    find_angles(cluster, view, &least, &most);
    bool turned = cluster->lean < 1 && least - cluster->spread > HALF_TURN / 2 + asin(cluster->lean) + SPARE;
    return c->solid && view->outside && turned ? CLUSTER_TURNED_AWAY : CLUSTER_SEEN;
}

/* What marks across which a surface's shaded normal leans ask for beyond those that lie in it: marks_law.c divides by
 * how long they are on the page. */
static double leaning(const mark_cluster *c, const cluster_view *v)
{
    const double HALF_TURN = 3.14159265358979, END_ON = 0.02;
    double       least, most;
    if (c->steepest < 1e-6)
        return 1;
    find_angles(c, v, &least, &most);
    least -= c->spread;
    most += c->spread;
    /* The least cosine, without its sign, of the normals with the ways to the viewer. */
    bool   edge_on = least < HALF_TURN / 2 && most > HALF_TURN / 2;
    double facing = edge_on ? 0 : fmin(fabs(cos(fmax(least, 0))), fabs(cos(fmin(most, HALF_TURN))));
    double end_on = fmin(sqrt(fmax(1 - facing * facing, 0)) + c->steepest, 1);
    return 1 + c->steepest / fmax(sqrt(fmax(1 - end_on * end_on, 0)), END_ON);
}

double mark_cluster_scale(const mark_cluster *cluster, const cluster_view *view, bool area)
{
    double nearest = INFINITY, farthest = 0;
    for (int i = 0; i < 8; i++) {
        double at[4], eye[4];
        corner_of(cluster->decided[0], cluster->decided[1], i, at);
        transform(&view->model_view, at, eye);
        nearest = fmin(nearest, -eye[2]);
        farthest = fmax(farthest, sqrt(eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]));
    }
    if (view->orthographic)
        return area ? view->focal * view->focal : view->focal * leaning(cluster, view);
    if (!(nearest > 0))
        return INFINITY;
    /* Beside the middle of the picture things are seen larger. */
    double scale = view->focal * farthest / (nearest * nearest);
    return area ? scale * view->focal / nearest : scale * leaning(cluster, view);
}

size_t mark_cluster_prefix(const mark_clusters *c, const mark_cluster *cluster, double rank)
{
    const float *ranks = &c->ranks[cluster->first];
    size_t       low = 0, high = cluster->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if ((double)ranks[middle] <= rank)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
