/* Two meshes that come together straight: which vertex meets which face first, or which edge which edge. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "contact/touch_private.h"

/* A triangle in axes that lie across the motion (0, 1) and along it (2). */
typedef struct flat_triangle {
    double at[3][3], low[3], high[3];
    bool   is_inner[3]; /* the edge from corner k on: another triangle goes on behind it in the same plane */
} flat_triangle;

typedef struct flat_list {
    flat_triangle *items;
    size_t         count;
} flat_list;

typedef struct sweep {
    const touch_pair *pair;
    double            axes[3][3]; /* across, across, along */
    touch_places     *all;
} sweep;

static void axes_across(const double along[3], double axes[3][3])
{
    double least[3] = {0, 0, 0};
    int    k = fabs(along[0]) < fabs(along[1]) ? 0 : 1;
    k = fabs(along[2]) < fabs(along[k]) ? 2 : k;
    least[k] = 1;
    vector3_copy(axes[2], along);
    vector3_cross(axes[0], along, least);
    vector3_normalise(axes[0]);
    vector3_cross(axes[1], along, axes[0]);
}

static flat_triangle flat_of(const sweep *s, const touch_piece *p, uint32_t first)
{
    flat_triangle t = {.is_inner = {false}};
    vector3_set(t.low, INFINITY, INFINITY, INFINITY);
    vector3_set(t.high, -INFINITY, -INFINITY, -INFINITY);
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
            t.at[k][a] = vector3_dot(p->vertices[p->indices[first + (uint32_t)k]], s->axes[a]);
            t.low[a] = fmin(t.low[a], t.at[k][a]);
            t.high[a] = fmax(t.high[a], t.at[k][a]);
        }
    return t;
}

static void normal_of(const flat_triangle *t, double out[3])
{
    double a[3], b[3];
    vector3_add(a, t->at[1], -1, t->at[0]);
    vector3_add(b, t->at[2], -1, t->at[0]);
    vector3_cross(out, a, b);
}

/* Does it turn its back to what comes? Who leaves something that it was in goes through such faces. */
static bool is_turned_away(const touch_piece *p, const flat_triangle *t, bool own)
{
    double normal[3];
    normal_of(t, normal);
    return p->outward * normal[2] * (own ? 1 : -1) < -1e-9 * vector3_length(normal);
}

static int compare_low(const void *a, const void *b)
{
    const double x = ((const flat_triangle *)a)->low[0], y = ((const flat_triangle *)b)->low[0];
    return (x > y) - (x < y);
}

/* --- edges inside faces ------------------------------------------------------------------------------------------- */

/* An edge of a triangle, its ends in an order that does not depend on the triangle. */
typedef struct flat_edge {
    const double  *ends[2];
    flat_triangle *of;
    int            first; /* corner */
} flat_edge;

static int compare_places(const double *a, const double *b)
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k])
            return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const flat_edge *x = a, *y = b;
    const int        begin = compare_places(x->ends[0], y->ends[0]);
    return begin ? begin : compare_places(x->ends[1], y->ends[1]);
}

static bool are_coplanar(const flat_triangle *a, const flat_triangle *b)
{
    const double alike = 1e-4; /* sine of the angle between them */
    double       n[3], m[3], across[3];
    normal_of(a, n);
    normal_of(b, m);
    vector3_cross(across, n, m);
    return vector3_dot(n, m) > 0 && vector3_length(across) < alike * vector3_length(n) * vector3_length(m);
}

/* Marks edges that two triangles of one plane share: faces have none inside. What is near of an edge is near of all
 * triangles beside it, so that those of the list suffice. False: out of memory. */
static bool mark_inner_edges(flat_list *l)
{
    enum { SHARED_MOST = 8 }; /* triangles at one edge that are compared */
    const size_t count = 3 * l->count;
    flat_edge   *edges = mem_alloc((count + 1) * sizeof *edges);
    for (size_t i = 0; edges && i < count; i++) {
        flat_triangle *t = &l->items[i / 3];
        const int      k = (int)(i % 3);
        const double  *a = t->at[k], *b = t->at[(k + 1) % 3];
        const bool     turns = compare_places(a, b) > 0;
        edges[i] = (flat_edge){{turns ? b : a, turns ? a : b}, t, k};
    }
    if (edges && count > 1)
        qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; edges && i + 1 < count; i++)
        for (size_t k = i + 1; k < count && k <= i + SHARED_MOST && compare_edges(&edges[i], &edges[k]) == 0; k++)
            if (are_coplanar(edges[i].of, edges[k].of))
                edges[i].of->is_inner[edges[i].first] = edges[k].of->is_inner[edges[k].first] = true;
    mem_free(edges);
    return edges != NULL;
}

/* --- what is near ------------------------------------------------------------------------------------------------- */

/* The box that a piece fills. */
static void extent_of(const sweep *s, const touch_piece *p, double low[3], double high[3])
{
    vector3_set(low, INFINITY, INFINITY, INFINITY);
    vector3_set(high, -INFINITY, -INFINITY, -INFINITY);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        for (int a = 0; a < 3; a++) {
            const double at = vector3_dot(p->vertices[i], s->axes[a]);
            low[a] = fmin(low[a], at);
            high[a] = fmax(high[a], at);
        }
}

/* Those of a piece that can meet what fills a box, by their places across. False: out of memory. */
static bool list_near(flat_list *out, const sweep *s, const touch_piece *p, const double low[3], const double high[3])
{
    const double beyond = s->pair->within + s->pair->tie;
    out->count = 0;
    out->items = mem_alloc((p->index_count / 3 + 1) * sizeof *out->items);
    for (uint32_t i = 0; out->items && i + 2 < p->index_count; i += 3) {
        const flat_triangle t = flat_of(s, p, i);
        bool                away = is_turned_away(p, &t, p == s->pair->own);
        for (int a = 0; a < 3; a++) {
            const double room = a == 2 ? beyond : s->pair->tie;
            away = away || t.low[a] > high[a] + room || t.high[a] < low[a] - room;
        }
        if (!away)
            out->items[out->count++] = t;
    }
    if (out->items && out->count > 1)
        qsort(out->items, out->count, sizeof *out->items, compare_low);
    return out->items && mark_inner_edges(out);
}

/* --- meetings ----------------------------------------------------------------------------------------------------- */

/* What has been found at a place of the own piece, in the sweep's axes. */
static lmn_status keep(const sweep *s, const double own[3], double normal[3], double gone, bool of_face,
                       lmn_error *error)
{
    if (!(fabs(gone) <= s->pair->within) || !vector3_normalise(normal) || fabs(normal[2]) < TOUCH_STEEP)
        return LMN_OK;
    const double turned = normal[2] > 0 ? -1 : 1;
    touch_place  place = {.gap = gone * fabs(normal[2]), .of_face = of_face};
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
            place.own[k] += own[a] * s->axes[a][k];
            place.normal[k] += turned * normal[a] * s->axes[a][k];
        }
    return touch_keep(s->all, &place, gone, s->pair->tie, error);
}

static double area2(const double a[3], const double b[3], const double c[3])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Where a line along the motion through a point meets a triangle; false: it passes by. */
static bool depth_at(const flat_triangle *t, const double p[3], double *out)
{
    const double whole = area2(t->at[0], t->at[1], t->at[2]);
    double       depth = 0;
    if (!(fabs(whole) > 0))
        return false;
    for (int k = 0; k < 3; k++) {
        const double share = area2(p, t->at[(k + 1) % 3], t->at[(k + 2) % 3]) / whole;
        if (!(share >= -1e-7))
            return false;
        depth += share * t->at[k][2];
    }
    *out = depth;
    return true;
}

/* The corners of one with the face of the other. */
static lmn_status corners_meet(const sweep *s, const flat_triangle *corners, const flat_triangle *face, bool own_corner,
                               lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (int k = 0; k < 3 && status == LMN_OK; k++) {
        double depth, normal[3], own[3];
        if (!depth_at(face, corners->at[k], &depth))
            continue;
        normal_of(face, normal);
        vector3_copy(own, corners->at[k]);
        own[2] = own_corner ? own[2] : depth;
        status = keep(s, own, normal, own_corner ? depth - corners->at[k][2] : corners->at[k][2] - depth, true, error);
    }
    return status;
}

/* An edge of the own triangle with one of the other. */
static lmn_status edges_meet(const sweep *s, const double a[3], const double b[3], const double c[3], const double d[3],
                             lmn_error *error)
{
    double       own[3], other[3], normal[3];
    const double turn = (b[0] - a[0]) * (d[1] - c[1]) - (b[1] - a[1]) * (d[0] - c[0]);
    vector3_add(own, b, -1, a);
    vector3_add(other, d, -1, c);
    if (!(fabs(turn) > 1e-9 * vector3_length(own) * vector3_length(other)))
        return LMN_OK;
    const double f = ((c[0] - a[0]) * other[1] - (c[1] - a[1]) * other[0]) / turn,
                 g = ((c[0] - a[0]) * own[1] - (c[1] - a[1]) * own[0]) / turn;
    if (!(f >= 0 && f <= 1 && g >= 0 && g <= 1))
        return LMN_OK;
    vector3_cross(normal, own, other);
    vector3_mix(own, a, b, f);
    return keep(s, own, normal, c[2] + g * other[2] - own[2], false, error);
}

static lmn_status triangles_meet(const sweep *s, const flat_triangle *own, const flat_triangle *other, lmn_error *error)
{
    if (other->low[2] - own->high[2] > fmin(s->all->first, s->pair->within) + s->pair->tie)
        return LMN_OK;
    lmn_status status = corners_meet(s, own, other, true, error);
    if (status == LMN_OK)
        status = corners_meet(s, other, own, false, error);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3 && status == LMN_OK; k++)
            if (!own->is_inner[i] && !other->is_inner[k])
                status = edges_meet(s, own->at[i], own->at[(i + 1) % 3], other->at[k], other->at[(k + 1) % 3], error);
    return status;
}

static lmn_status lists_meet(const sweep *s, const flat_list *own, const flat_list *others, lmn_error *error)
{
    const double tie = s->pair->tie;
    double       broad = 0;
    size_t       begin = 0;
    lmn_status   status = LMN_OK;
    for (size_t i = 0; i < others->count; i++)
        broad = fmax(broad, others->items[i].high[0] - others->items[i].low[0]);
    for (size_t i = 0; i < own->count && status == LMN_OK; i++) {
        const flat_triangle *a = &own->items[i];
        while (begin < others->count && others->items[begin].low[0] + broad < a->low[0] - tie)
            begin++;
        for (size_t k = begin; k < others->count && status == LMN_OK; k++) {
            const flat_triangle *b = &others->items[k];
            if (b->low[0] > a->high[0] + tie)
                break;
            if (b->high[0] >= a->low[0] - tie && b->low[1] <= a->high[1] + tie && b->high[1] >= a->low[1] - tie)
                status = triangles_meet(s, a, b, error);
        }
        if (status == LMN_OK)
            status = work_check(error);
    }
    return status;
}

lmn_status touch_sweep(touch_places *all, const touch_pair *pair, lmn_error *error)
{
    sweep     s = {.pair = pair, .all = all};
    double    low[3], high[3];
    flat_list own = {0}, others = {0};
    axes_across(pair->along, s.axes);
    extent_of(&s, pair->other, low, high);
    bool good = list_near(&own, &s, pair->own, low, high);
    extent_of(&s, pair->own, low, high);
    good = good && list_near(&others, &s, pair->other, low, high);
    lmn_status status = good ? lists_meet(&s, &own, &others, error) : error_memory(error);
    mem_free(own.items);
    mem_free(others.items);
    return status;
}
