/* Outlines in the plane to triangles, by GLU's tessellator. It takes memory past base/memory.h and gives all of it
 * back. */
#include <GL/glu.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "construct/construct_private.h"
#include "construct/fenced.h"

typedef struct filling {
    uint32_t *corners;
    size_t    count, capacity;
    bool      failed, refused; /* memory is gone; edges cross */
} filling;

/* Points travel through GLU as their number + 1. */
static void *as_pointer(size_t point)
{
    return (void *)((uintptr_t)point + 1);
}

static void GLAPIENTRY on_vertex(void *point, void *user)
{
    filling *f = user;
    if (!point) {
        f->refused = true;
    } else if (!mem_grow((void **)&f->corners, &f->capacity, f->count + 1, sizeof *f->corners)) {
        f->failed = true;
    } else {
        f->corners[f->count++] = (uint32_t)((uintptr_t)point - 1);
    }
}

/* Being there makes GLU give single triangles instead of fans and strips. */
static void GLAPIENTRY on_edge_flag(GLboolean flag, void *user)
{
    (void)flag;
    (void)user;
}

static void GLAPIENTRY on_error(GLenum error, void *user)
{
    filling *f = user;
    f->refused = true;
    f->failed = f->failed || error == GLU_OUT_OF_MEMORY;
}

/* Two points at the same position are one. Where edges cross no point is made: the border comes out wrong and is found
 * so. */
static void GLAPIENTRY on_combine(GLdouble at[3], void *data[4], GLfloat fractions[4], void **out, void *user)
{
    (void)at;
    (void)fractions;
    (void)user;
    *out = data[0];
}

static bool fill(filling *f, const contour *contours, size_t count)
{
    GLUtesselator *t = gluNewTess();
    if (!t)
        return false;
    gluTessCallback(t, GLU_TESS_VERTEX_DATA, (_GLUfuncptr)on_vertex);
    gluTessCallback(t, GLU_TESS_EDGE_FLAG_DATA, (_GLUfuncptr)on_edge_flag);
    gluTessCallback(t, GLU_TESS_COMBINE_DATA, (_GLUfuncptr)on_combine);
    gluTessCallback(t, GLU_TESS_ERROR_DATA, (_GLUfuncptr)on_error);
    gluTessProperty(t, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_POSITIVE);
    gluTessNormal(t, 0, 0, 1);
    gluTessBeginPolygon(t, f);
    size_t point = 0;
    for (size_t i = 0; i < count; i++) {
        gluTessBeginContour(t);
        for (size_t k = 0; k < contours[i].count; k++) {
            GLdouble at[3] = {contours[i].points[k].x, contours[i].points[k].y, 0};
            gluTessVertex(t, at, as_pointer(point++));
        }
        gluTessEndContour(t);
    }
    gluTessEndPolygon(t);
    gluDeleteTess(t);
    f->count -= f->count % 3;
    return !f->failed;
}

/* --- is the triangles' border that of the contours? ----------------------------------------------------- */

/* Both directions of each edge of the sum "contours minus triangles": it must be its own reverse, by positions. */
static bool borders_agree(const contour *contours, size_t count, const filling *f, const point2 *points,
                          size_t point_count, bool *failed)
{
    size_t      total = f->count + point_count, at = 0;
    plane_edge *edges = mem_calloc(total * 2, sizeof *edges);
    *failed = !edges;
    if (!edges)
        return false;
    for (size_t i = 0; i < f->count; i++)
        edges[at++] = (plane_edge){points[f->corners[i]], points[f->corners[i % 3 == 2 ? i - 2 : i + 1]]};
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < contours[i].count; k++)
            edges[at++] = (plane_edge){contours[i].points[(k + 1) % contours[i].count], contours[i].points[k]};
    for (size_t i = 0; i < total; i++)
        edges[total + i] = (plane_edge){edges[i].to, edges[i].from};
    qsort(edges, total, sizeof *edges, compare_plane_edges);
    qsort(edges + total, total, sizeof *edges, compare_plane_edges);
    bool same = true;
    for (size_t i = 0; same && i < total; i++)
        same = compare_plane_edges(&edges[i], &edges[total + i]) == 0;
    mem_free(edges);
    return same;
}

static point2 *all_points(const contour *contours, size_t count, size_t *point_count)
{
    *point_count = 0;
    for (size_t i = 0; i < count; i++)
        *point_count += contours[i].count;
    point2 *points = mem_calloc(*point_count, sizeof *points);
    size_t  at = 0;
    for (size_t i = 0; points && i < count; i++)
        for (size_t k = 0; k < contours[i].count; k++)
            points[at++] = contours[i].points[k];
    return points;
}

static lmn_status triangulate_here(const contour *contours, size_t count, uint32_t **corners, size_t *corner_count,
                                   bool *exact, lmn_error *error)
{
    filling f = {0};
    size_t  point_count;
    bool    failed = true;
    point2 *points = all_points(contours, count, &point_count);
    if (points && fill(&f, contours, count))
        *exact = borders_agree(contours, count, &f, points, point_count, &failed) && !f.refused;
    mem_free(points);
    if (failed) {
        mem_free(f.corners);
        return error_memory(error);
    }
    *corners = f.corners;
    *corner_count = f.count;
    return LMN_OK;
}

/* --- behind the fence and before it --------------------------------------------------------------------- */

/* Request: the contours. Answer: whether it is exact, then the corners. */
static lmn_status triangulate_request(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_reader r = fence_read(request, size);
    region       contours;
    uint32_t    *corners = NULL;
    size_t       count = 0;
    bool         exact = false;
    lmn_status   status = region_take(&contours, &r)
                              ? triangulate_here(contours.contours, contours.count, &corners, &count, &exact, error)
                              : error_memory(error);
    if (status == LMN_OK) {
        fence_put_u32(answer, exact);
        fence_put(answer, corners, count * sizeof *corners);
    }
    mem_free(corners);
    region_release(&contours);
    return status;
}

static lmn_status triangulate_fenced(const contour *contours, size_t count, size_t points, uint32_t **corners,
                                     size_t *corner_count, bool *exact, lmn_error *error)
{
    fence_bytes request = {0}, answer;
    region_put(&request, contours, count);
    lmn_status status = fence_call_always(&answer, triangulate_request, "the division into triangles", &request, error);
    mem_free(request.bytes);
    if (status != LMN_OK)
        return status;
    fence_reader r = fence_read(answer.bytes, answer.size);
    *exact = fence_take_u32(&r) != 0;
    *corner_count = (size_t)(r.end - r.at) / sizeof **corners;
    *corners = mem_copy(r.at, *corner_count * sizeof **corners);
    bool good = *corner_count % 3 == 0;
    for (size_t i = 0; *corners && good && i < *corner_count; i++)
        good = (*corners)[i] < points;
    mem_free(answer.bytes);
    if (*corners && good)
        return LMN_OK;
    status = *corners ? error_set(error, LMN_INTERNAL, "the division into triangles gave a wrong answer")
                      : error_memory(error);
    mem_free(*corners);
    *corners = NULL;
    return status;
}

/* GLU follows its own lists astray among numbers that are in no order. */
static bool is_finite(const contour *contours, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < contours[i].count; k++)
            if (!isfinite(contours[i].points[k].x) || !isfinite(contours[i].points[k].y))
                return false;
    return true;
}

lmn_status contours_triangulate(const contour *contours, size_t count, uint32_t **corners, size_t *corner_count,
                                bool *exact, lmn_error *error)
{
    size_t points = 0;
    for (size_t i = 0; i < count; i++)
        points += contours[i].count;
    *corners = NULL;
    *corner_count = 0;
    *exact = false;
    if (!is_finite(contours, count))
        return LMN_OK;
    return points > FENCED_PLANE_POINTS
               ? triangulate_fenced(contours, count, points, corners, corner_count, exact, error)
               : triangulate_here(contours, count, corners, corner_count, exact, error);
}
