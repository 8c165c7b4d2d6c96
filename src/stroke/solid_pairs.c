/* Where faces of a solid's operands meet: straight lines in which two of them cross, or one comes to the other's plane
 * with an edge. Faces of one plane make none: their edges do. */
#include "stroke/solid_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"

typedef struct pair_search {
    solid_builder *b;
    uint32_t       ticks;
    bool           failed;
} pair_search;

enum { TICKS = 4096 };

/* Heights of a face's corners over another one's plane; what is as good as on it is on it. False: it does not come to
 * the plane with more than a corner. */
static bool find_heights(const solid_builder *b, const solid_face *f, const solid_face *plane, double out[3])
{
    int above = 0, below = 0;
    for (int k = 0; k < 3; k++) {
        double height = double3_dot(double3_minus(f->p[k], plane->p[0]), plane->normal);
        out[k] = fabs(height) <= b->near ? 0 : height;
        above += out[k] > 0;
        below += out[k] < 0;
    }
    return (above && below) || above + below == 1;
}

static bool crosses(const double heights[3])
{
    return (heights[0] > 0 || heights[1] > 0 || heights[2] > 0) && (heights[0] < 0 || heights[1] < 0 || heights[2] < 0);
}

/* Does it come with an edge that is a candidate itself? */
static bool comes_with_line(const solid_builder *b, uint32_t face, const double heights[3])
{
    for (int k = 0; k < 3; k++)
        if (heights[k] == 0 && heights[(k + 1) % 3] == 0)
            return b->lined[face] >> k & 1;
    return false;
}

/* Where an edge passes the plane: the same number for both faces of the edge. */
static double3 edge_at_plane(const solid_builder *b, uint32_t face, const double heights[3], int from, int to)
{
    const uint32_t *v = b->mesh->faces[face];
    if (v[from] > v[to]) {
        int other = from;
        from = to;
        to = other;
    }
    double3 p = b->faces[face].p[from], q = b->faces[face].p[to];
    return double3_plus(p, double3_minus(q, p), heights[from] / (heights[from] - heights[to]));
}

/* The two places where a face's rim passes the plane. */
static void rim_at_plane(const solid_builder *b, uint32_t face, const double heights[3], double3 out[2])
{
    int found = 0;
    for (int k = 0; k < 3 && found < 2; k++) {
        int next = (k + 1) % 3;
        if ((heights[k] > 0 && heights[next] < 0) || (heights[k] < 0 && heights[next] > 0))
            out[found++] = edge_at_plane(b, face, heights, k, next);
        else if (heights[k] == 0)
            out[found++] = b->faces[face].p[k];
    }
}

static bool common_line(const solid_builder *b, uint32_t first, uint32_t second, const double heights[2][3],
                        double3 ends[2])
{
    double3 along = double3_cross(b->faces[first].normal, b->faces[second].normal), p[2], q[2];
    rim_at_plane(b, first, heights[0], p);
    rim_at_plane(b, second, heights[1], q);
    int p0 = double3_dot(along, p[0]) <= double3_dot(along, p[1]) ? 0 : 1,
        q0 = double3_dot(along, q[0]) <= double3_dot(along, q[1]) ? 0 : 1;
    ends[0] = double3_dot(along, p[p0]) >= double3_dot(along, q[q0]) ? p[p0] : q[q0];
    ends[1] = double3_dot(along, p[1 - p0]) <= double3_dot(along, q[1 - q0]) ? p[1 - p0] : q[1 - q0];
    double3 length = double3_minus(ends[1], ends[0]);
    return double3_dot(along, length) > 0 && double3_length(length) > b->near;
}

static bool share_corner(const uint32_t a[3], const uint32_t b[3])
{
    for (int k = 0; k < 3; k++)
        if (a[k] == b[0] || a[k] == b[1] || a[k] == b[2])
            return true;
    return false;
}

static bool cross_faces(void *user, uint32_t first, uint32_t second)
{
    pair_search   *s = user;
    solid_builder *b = s->b;
    if (++s->ticks % TICKS == 0 && work_stopped()) {
        s->failed = true;
        return false;
    }
    if (first > second) {
        uint32_t other = first;
        first = second;
        second = other;
    }
    bool     own = b->solid->operands[first] == b->solid->operands[second];
    uint16_t plane = b->solid->planes[first];
    if ((plane && plane == b->solid->planes[second]) ||
        (own && share_corner(b->mesh->faces[first], b->mesh->faces[second])))
        return true;
    double  heights[2][3];
    double3 ends[2];
    if (!find_heights(b, &b->faces[first], &b->faces[second], heights[0]) ||
        !find_heights(b, &b->faces[second], &b->faces[first], heights[1]) || comes_with_line(b, first, heights[0]) ||
        comes_with_line(b, second, heights[1]) || !common_line(b, first, second, (const double(*)[3])heights, ends))
        return true;
    if (own && crosses(heights[0]) && crosses(heights[1]))
        b->parts[b->solid->operands[first]].crossed = true;
    if (!mem_grow((void **)&b->candidates, &b->candidate_capacity, b->candidate_count + 1, sizeof *b->candidates)) {
        s->failed = true;
        return false;
    }
    b->candidates[b->candidate_count++] =
        (solid_candidate){{ends[0], ends[1]}, {first, second}, 0, 0, {NO_VERTEX, NO_VERTEX}};
    return true;
}

lmn_status solid_cross(solid_builder *b, lmn_error *error)
{
    pair_search s = {.b = b};
    hierarchy_pairs(&b->tree, b->boxes, (hierarchy_kin){{NULL}}, cross_faces, &s);
    return s.failed ? error_memory(error) : LMN_OK;
}
