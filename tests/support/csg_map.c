#include "csg_map.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

/* How far a rasteriser may move what it draws, in pixels: it rounds corners to 1/256. For what must not lie near,
 * more. */
static const double moved = 1.0 / 256, reach = 1.0 / 100;

static const double corners[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};

static const double depth_tolerance = 1e-4, normal_tolerance = 1; /* share, degrees */

enum { OWNER_LEVELS = 1 };

const char *const csg_verdict_names[CSG_VERDICTS] = {"right", "count", "owner", "depth", "normal", "facing", "hole"};

size_t csg_trace_pixel(csg_rays *r, const shot *view, double x, double y, csg_hit out[CSG_HITS_MAX],
                       csg_passage *passage)
{
    dvec   origin, direction;
    size_t kept = 0;
    shot_ray(view, x, y, &origin, &direction);
    size_t found = csg_trace(r, origin, direction, out, CSG_HITS_MAX, passage);
    for (size_t k = 0; k < found; k++) {
        csg_hit hit = out[k];
        hit.depth = -shot_to_eye(view, dvec_add(origin, dvec_scale(direction, hit.t)), 1).z;
        if (!view->orthographic && (hit.depth < view->near_depth || hit.depth > view->far_depth))
            continue;
        hit.normal = dvec_unit(shot_to_eye(view, hit.normal, 0));
        out[kept++] = hit;
    }
    return kept;
}

static bool same_structure(const csg_hit *a, const csg_hit *b, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (a[k].leaf != b[k].leaf || a[k].front != b[k].front)
            return false;
    return true;
}

static bool is_sharp(csg_rays *r, const shot *view, int x, int y, const csg_hit *own, size_t count, uint64_t crossings)
{
    csg_hit     other[CSG_HITS_MAX];
    csg_passage passage;
    for (size_t k = 0; k < count && !view->orthographic; k++)
        if (fabs(own[k].depth - view->near_depth) <= 1e-3 * view->near_depth)
            return false;
    for (int k = 0; k < 4; k++)
        if (csg_trace_pixel(r, view, x + 0.5 + corners[k][0] * reach, y + 0.5 + corners[k][1] * reach, other,
                            &passage) != count ||
            passage.close || passage.crossings != crossings || !same_structure(own, other, count))
            return false;
    return true;
}

static void make_map(csg_map *out, csg_rays *r, const shot *view, bool judged)
{
    int    count = view->width * view->height;
    size_t capacity = 4096, used = 0;
    *out = (csg_map){.width = view->width, .height = view->height};
    out->first = check_alloc((size_t)count + 1, sizeof *out->first);
    out->sharp = check_alloc((size_t)count, sizeof *out->sharp);
    out->hits = check_alloc(capacity, sizeof *out->hits);
    for (int i = 0; i < count; i++) {
        csg_hit     own[CSG_HITS_MAX];
        csg_passage passage;
        int         x = i % view->width, y = i / view->width;
        size_t      found = csg_trace_pixel(r, view, x + 0.5, y + 0.5, own, &passage);
        if (used + found > capacity) {
            csg_hit *grown = check_alloc(capacity = 2 * capacity + found, sizeof *grown);
            memcpy(grown, out->hits, used * sizeof *grown);
            free(out->hits);
            out->hits = grown;
        }
        memcpy(out->hits + used, own, found * sizeof *own);
        used += found;
        out->first[i + 1] = used;
        out->sharp[i] = judged && !passage.close && is_sharp(r, view, x, y, own, found, passage.crossings);
        out->sharp_count += out->sharp[i];
        out->most = found > out->most ? found : out->most;
        if (out->sharp[i] && found > out->most_sharp)
            out->most_sharp = found;
    }
}

void csg_map_make(csg_map *out, csg_rays *r, const shot *view)
{
    make_map(out, r, view, true);
}

void csg_map_quickly(csg_map *out, csg_rays *r, const shot *view)
{
    make_map(out, r, view, false);
}

void csg_map_release(csg_map *m)
{
    free(m->first);
    free(m->hits);
    free(m->sharp);
    *m = (csg_map){0};
}

static bool differs(const csg_map *m, int one, int other, size_t layers, double step)
{
    size_t a = csg_count(m, one), b = csg_count(m, other);
    a = layers && a > layers ? layers : a;
    b = layers && b > layers ? layers : b;
    if (a != b || !same_structure(csg_at(m, one), csg_at(m, other), a))
        return true;
    for (size_t k = 0; k < a; k++)
        if (fabs(csg_at(m, one)[k].depth - csg_at(m, other)[k].depth) > step * csg_at(m, one)[k].depth)
            return true;
    return false;
}

bool csg_map_border(const csg_map *m, int x, int y, size_t layers)
{
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            if (i >= 0 && j >= 0 && i < m->width && j < m->height &&
                differs(m, y * m->width + x, j * m->width + i, layers, 0.03))
                return true;
    return false;
}

/* --- comparison ----------------------------------------------------------------------------------------- */

/* One layer's maps; a drawing without layer maps has those of its front. */
static shot_layer layer_of(const shot *s, size_t k)
{
    if (s->layer_count > 0)
        return s->layers[k];
    return (shot_layer){.depth = s->depth, .normal = s->normal, .id = s->id, .edge = s->edge, .shade = s->shade};
}

static size_t layers_of(const shot *s)
{
    return s->layer_count > 0 ? (size_t)s->layer_count : 1;
}

static double degrees_between(dvec a, dvec b)
{
    return 2 * asin(fmin(1, dvec_length(dvec_sub(a, b)) / 2)) * 180 / pi;
}

/* Depth of a surface's facet, carried on to another position of the picture. */
static double facet_depth(const shot *s, const csg_hit *h, double from_x, double from_y, double x, double y)
{
    dvec origin, direction;
    shot_ray(s, from_x, from_y, &origin, &direction);
    dvec position = dvec_add(origin, dvec_scale(direction, h->t));
    shot_ray(s, x, y, &origin, &direction);
    double t = dvec_dot(h->flat, dvec_sub(position, origin)) / dvec_dot(h->flat, direction);
    return -shot_to_eye(s, dvec_add(origin, dvec_scale(direction, t)), 1).z;
}

/* The least errors where the rasteriser may have moved the surface from; its position in the order is the same there.
 * Near an edge between facets it may carry either on to the pixel's centre. */
static void judge_again(csg_rays *r, const shot *s, int x, int y, size_t k, double depth, dvec normal,
                        double *depth_error, double *normal_error)
{
    csg_hit     other[CSG_HITS_MAX];
    csg_passage passage;
    double      low = INFINITY, high = 0;
    for (int c = 0; c < 5; c++) {
        double shift = c < 4 ? moved : 0, at_x = x + 0.5 + corners[c % 4][0] * shift,
               at_y = y + 0.5 + corners[c % 4][1] * shift;
        if (k >= csg_trace_pixel(r, s, at_x, at_y, other, &passage))
            continue;
        double carried = facet_depth(s, &other[k], at_x, at_y, x + 0.5, y + 0.5);
        low = fmin(low, fmin(carried, other[k].depth));
        high = fmax(high, fmax(carried, other[k].depth));
        *normal_error = fmin(*normal_error, degrees_between(normal, other[k].normal));
    }
    *depth_error = fmin(*depth_error, fmax(0, fmax(low - depth, depth - high)) / low);
}

typedef struct judgement {
    csg_verdict what;
    int         layer;
    double      depth_error, normal_error;
} judgement;

static bool has_colour(const shot_layer *l, int i, const uint8_t *colour)
{
    for (int k = 0; k < 3; k++)
        if (abs(l->shade[4 * i + k] - colour[k]) > OWNER_LEVELS)
            return false;
    return true;
}

static judgement judge_surface(csg_rays *r, const shot *s, int i, size_t k, const csg_hit *hit, bool owners)
{
    shot_layer l = layer_of(s, k);
    judgement  j = {.layer = (int)k};
    dvec       normal = dvec_from(l.normal[i]);
    double     depth = (double)l.depth[i];
    j.depth_error = fabs(depth - hit->depth) / hit->depth;
    j.normal_error = degrees_between(normal, hit->normal);
    if (!(j.depth_error <= depth_tolerance && j.normal_error <= normal_tolerance))
        judge_again(r, s, i % s->width, i / s->width, k, depth, normal, &j.depth_error, &j.normal_error);
    if (!(j.depth_error <= depth_tolerance))
        j.what = CSG_DEPTH;
    else if (owners && !has_colour(&l, i, csg_rays_colour(r, hit->leaf)))
        j.what = CSG_OWNER;
    else if (!(j.normal_error <= normal_tolerance))
        j.what = dvec_dot(normal, hit->normal) < 0 ? CSG_FACING : CSG_NORMAL;
    return j;
}

static judgement judge_pixel(const csg_map *m, csg_rays *r, const shot *s, int i, size_t limit, bool owners)
{
    judgement j = {0};
    size_t    count = csg_count(m, i), drawn = 0, last = 0;
    count = limit && count > limit ? limit : count;
    for (size_t k = 0; k < layers_of(s); k++)
        if (!isinf(layer_of(s, k).depth[i])) {
            drawn++;
            last = k + 1;
        }
    if (last != drawn)
        return (j.what = CSG_HOLE, j);
    if (drawn != count)
        return (j.what = CSG_COUNT, j.layer = (int)(drawn < count ? drawn : count), j);
    for (size_t k = 0; k < count && j.what == CSG_RIGHT; k++) {
        judgement own = judge_surface(r, s, i, k, &csg_at(m, i)[k], owners);
        own.depth_error = fmax(own.depth_error, j.depth_error);
        own.normal_error = fmax(own.normal_error, j.normal_error);
        j = own;
    }
    return j;
}

/* Is the picture full or empty around this pixel, by the truth? */
static bool near_outline(const csg_map *m, int x, int y)
{
    bool own = csg_count(m, y * m->width + x) > 0;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            if (i >= 0 && j >= 0 && i < m->width && j < m->height && (csg_count(m, j * m->width + i) > 0) != own)
                return true;
    return false;
}

csg_score csg_compare(const csg_map *m, csg_rays *r, const shot *s, size_t layers, bool owners)
{
    csg_score score = {0};
    for (int i = 0; i < m->width * m->height; i++) {
        int       x = i % m->width, y = i / m->width;
        judgement j = judge_pixel(m, r, s, i, layers, owners);
        bool      right = j.what == CSG_RIGHT, inner = !csg_map_border(m, x, y, layers);
        score.pixels++;
        score.right += right;
        score.inner += inner;
        score.right_inner += inner && right;
        score.outline_wrong += isinf(layer_of(s, 0).depth[i]) != (csg_count(m, i) == 0) && !near_outline(m, x, y);
        if (!m->sharp[i])
            continue;
        score.sharp++;
        score.right_sharp += right;
        if (score.wrong[j.what]++ == 0)
            memcpy(score.first[j.what], (int[2]){x, y}, sizeof *score.first);
        if (right) {
            score.depth_error = fmax(score.depth_error, j.depth_error);
            score.normal_error = fmax(score.normal_error, j.normal_error);
        }
    }
    return score;
}

void csg_explain(const csg_map *m, csg_rays *r, const shot *s, int x, int y)
{
    int i = y * m->width + x;
    check_note("pixel %d, %d: %s, %zu surfaces by rays; clip planes at %.6g and %.6g", x, y,
               m->sharp[i] ? "sharp" : "not sharp", csg_count(m, i), s->near_depth, s->far_depth);
    for (size_t k = 0; k < csg_count(m, i); k++) {
        const csg_hit *h = &csg_at(m, i)[k];
        const uint8_t *c = csg_rays_colour(r, h->leaf);
        check_note("  ray   %2zu %s leaf %2d (%3d %3d %3d) depth %.9g normal %.4f %.4f %.4f%s", k,
                   h->front ? "front" : "back ", h->leaf, c[0], c[1], c[2], h->depth, h->normal.x, h->normal.y,
                   h->normal.z, h->coplanar ? ", coplanar" : "");
    }
    for (size_t k = 0; k < layers_of(s); k++) {
        shot_layer l = layer_of(s, k);
        if (!isinf(l.depth[i]))
            check_note("  drawn %2zu id %d (%3d %3d %3d) depth %.9g normal %.4f %.4f %.4f", k, l.id[i], l.shade[4 * i],
                       l.shade[4 * i + 1], l.shade[4 * i + 2], (double)l.depth[i], (double)l.normal[i][0],
                       (double)l.normal[i][1], (double)l.normal[i][2]);
    }
}
