/* Convex hulls in space and sums of convex polyhedra, by Qhull's reentrant library. It takes memory past
 * base/memory.h and gives all of it back. */
#include <libqhull_r/qhull_ra.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"
#include "construct/fenced.h"

/* The facet's corners, all facets turned the same way; builder_finish sees which way that is. */
static void add_facet(qhT *qh, solid_builder *b, facetT *facet)
{
    uint32_t corners[3] = {0, 0, 0};
    int      count = 0;
    vertexT *vertex, **vertexp;
    FOREACHvertex_(facet->vertices)
    {
        if (count < 3)
            corners[count] = (uint32_t)qh_pointid(qh, vertex->point);
        count++;
    }
    if (facet->toporient)
        builder_triangle(b, corners[0], corners[1], corners[2]);
    else
        builder_triangle(b, corners[0], corners[2], corners[1]);
}

/* Qhull's exit code. It reports in words as well; to a little memory, because a library does not print, and behind
 * the fence no file can be opened. */
static int find_hull_here(solid_builder *b)
{
    enum { WORDS = 1 << 12 };
    qhT   qh;
    FILE *nowhere = fmemopen(NULL, WORDS, "w");
    if (!nowhere)
        return qh_ERRmem;
    qh_zero(&qh, nowhere);
    /* Qt: facets of more than three corners become triangles; Pp: no warnings about precision. */
    char    command[] = "qhull Qt Pp";
    int     code = qh_new_qhull(&qh, 3, (int)b->point_count, &b->points->x, False, command, nowhere, nowhere);
    facetT *facet;
    if (code == qh_ERRnone)
        for (facet = qh.facet_list; facet && facet->next; facet = facet->next)
            add_facet(&qh, b, facet);
    int left_blocks, left_bytes;
    qh_freeqhull(&qh, !qh_ALL);
    qh_memfreeshort(&qh, &left_blocks, &left_bytes);
    fclose(nowhere);
    return code;
}

/* Request: the points. Answer: Qhull's exit code, then the corners. */
static lmn_status hull_request(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    solid_builder b = {0};
    for (size_t at = 0; at + sizeof(point3) <= size; at += sizeof(point3)) {
        point3 p;
        memcpy(&p, request + at, sizeof p);
        builder_point(&b, p.x, p.y, p.z);
    }
    int code = b.failed ? qh_ERRmem : find_hull_here(&b);
    if (b.failed)
        code = qh_ERRmem;
    fence_put_u32(answer, (uint32_t)code);
    fence_put(answer, b.triangles, b.triangle_count * 3 * sizeof *b.triangles);
    builder_release(&b);
    return answer->failed ? error_memory(error) : LMN_OK;
}

/* The same with Qhull's exit code in *code. */
static lmn_status find_hull_fenced(solid_builder *b, int *code, lmn_error *error)
{
    fence_bytes request = {.bytes = (unsigned char *)b->points, .size = b->point_count * sizeof *b->points}, answer;
    lmn_status  status = fence_call_always(&answer, hull_request, "the search for a hull", &request, error);
    if (status != LMN_OK)
        return status;
    fence_reader r = fence_read(answer.bytes, answer.size);
    *code = (int)fence_take_u32(&r);
    const unsigned char *at;
    while ((at = fence_take(&r, 3 * sizeof(uint32_t)))) {
        uint32_t corners[3];
        memcpy(corners, at, sizeof corners);
        if (corners[0] < b->point_count && corners[1] < b->point_count && corners[2] < b->point_count)
            builder_triangle(b, corners[0], corners[1], corners[2]);
    }
    mem_free(answer.bytes);
    return LMN_OK;
}

/* The hull of the builder's points, which has no triangles yet. The builder is empty afterwards. */
static lmn_status finish_hull(solid_builder *b, polyhedron *out, lmn_error *error)
{
    *out = (polyhedron){0};
    int        code = qh_ERRsingular;
    lmn_status status = LMN_OK;
    if (!b->failed && b->point_count > FENCED_HULL_POINTS)
        status = find_hull_fenced(b, &code, error);
    else if (!b->failed && b->point_count >= 4)
        code = find_hull_here(b);
    if (status != LMN_OK) {
        builder_release(b);
        return status;
    }
    if (b->failed || code == qh_ERRmem) {
        builder_release(b);
        return error_memory(error);
    }
    if (code != qh_ERRnone) {
        builder_release(b);
        /* Flat ones have no hull in space; that is no mistake. */
        bool flat = code == qh_ERRsingular || code == qh_ERRinput || code == qh_ERRprec;
        return flat ? LMN_OK
                    : error_set(error, LMN_INTERNAL, "no convex hull could be made: Qhull ended with %d", code);
    }
    status = builder_finish(b, out, error);
    out->convex = status == LMN_OK && out->triangle_count > 0;
    return status;
}

static lmn_status check_points(const char *shape, const polyhedron *p, lmn_error *error)
{
    return p->point_count > 0 ? check_numbers(shape, &p->points->x, p->point_count * 3, error) : LMN_OK;
}

lmn_status polyhedron_hull(polyhedron *out, const polyhedron *operands, size_t count, lmn_error *error)
{
    *out = (polyhedron){0};
    double     total = 0;
    lmn_status status = LMN_OK;
    for (size_t i = 0; status == LMN_OK && i < count; i++) {
        total += (double)operands[i].point_count;
        status = check_points("hull", &operands[i], error);
    }
    if (status == LMN_OK)
        status = check_point_count("hull", total, error);
    if (status != LMN_OK)
        return status;
    solid_builder b = {0};
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < operands[i].point_count; k++)
            builder_point(&b, operands[i].points[k].x, operands[i].points[k].y, operands[i].points[k].z);
    return finish_hull(&b, out, error);
}

static bool is_convex(const polyhedron *p)
{
    polyhedron seen = *p;
    return seen.convex || polyhedron_check_convex(&seen);
}

lmn_status polyhedron_minkowski(polyhedron *out, const polyhedron *a, const polyhedron *b, lmn_error *error)
{
    *out = (polyhedron){0};
    lmn_status status = check_points("minkowski", a, error);
    if (status == LMN_OK)
        status = check_points("minkowski", b, error);
    if (status == LMN_OK)
        status = check_point_count("minkowski", (double)a->point_count * (double)b->point_count, error);
    if (status != LMN_OK || a->triangle_count == 0 || b->triangle_count == 0)
        return status;
    if (!is_convex(a) || !is_convex(b))
        return error_set(error, LMN_UNSUPPORTED,
                         "minkowski: only sums of convex shapes can be made, and one here is not convex");
    solid_builder sum = {0};
    for (size_t i = 0; i < a->point_count; i++)
        for (size_t k = 0; k < b->point_count; k++)
            builder_point(&sum, a->points[i].x + b->points[k].x, a->points[i].y + b->points[k].y,
                          a->points[i].z + b->points[k].z);
    return finish_hull(&sum, out, error);
}
