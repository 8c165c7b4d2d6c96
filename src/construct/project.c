/* Polyhedra to regions: where the plane z = 0 cuts them, and their shadow on it. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "construct/construct_private.h"

/* --- the cut -------------------------------------------------------------------------------------------- */

/* Where the plane cuts one triangle: from the edge on which its border comes down to that on which it goes up, so
 * that the inside is on the left. An edge is known by its two points, the smaller number first. */
typedef struct segment {
    uint64_t from, to;
    bool     used;
} segment;

typedef struct section {
    const polyhedron *p;
    bool              at_is_above; /* which side points in the plane are on */
    segment          *segments;
    size_t            count, capacity;
    bool              failed;
} section;

static bool is_above(const section *s, uint32_t point)
{
    double z = s->p->points[point].z;
    return s->at_is_above ? z >= 0 : z > 0;
}

static void cut_triangle(section *s, const uint32_t *t)
{
    segment found = {0};
    int     crossings = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t a = t[k], b = t[(k + 1) % 3];
        bool     above = is_above(s, a);
        if (above == is_above(s, b))
            continue;
        uint64_t edge = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
        *(above ? &found.from : &found.to) = edge;
        crossings++;
    }
    if (crossings != 2)
        return;
    if (!mem_grow((void **)&s->segments, &s->capacity, s->count + 1, sizeof *s->segments)) {
        s->failed = true;
        return;
    }
    s->segments[s->count++] = found;
}

static int compare_segments(const void *a, const void *b)
{
    const segment *p = a, *q = b;
    if (p->from != q->from)
        return p->from < q->from ? -1 : 1;
    return (p->to > q->to) - (p->to < q->to);
}

/* A segment that begins on this edge and is not used yet. */
static segment *find_next(const section *s, uint64_t edge)
{
    size_t low = 0, high = s->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (s->segments[middle].from < edge)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < s->count && s->segments[low].from == edge; low++)
        if (!s->segments[low].used)
            return &s->segments[low];
    return NULL;
}

static void add_crossing(const section *s, region_builder *b, uint64_t edge)
{
    const point3 *a = &s->p->points[edge >> 32], *c = &s->p->points[edge & UINT32_MAX];
    double        t = a->z / (a->z - c->z);
    builder_set_position(b, a->x + (c->x - a->x) * t, a->y + (c->y - a->y) * t);
}

/* Leaves out points where only the triangles of one flat face meet: nearer than this to the line through their
 * neighbours. */
static void drop_straight(contour *c, double nearness)
{
    size_t kept = 0;
    for (size_t i = 0; i < c->count; i++) {
        point2 a = c->points[kept > 0 ? kept - 1 : c->count - 1], b = c->points[i],
               next = c->points[i + 1 < c->count ? i + 1 : 0];
        double x = next.x - a.x, y = next.y - a.y, length = hypot(x, y);
        bool   between = (b.x - a.x) * x + (b.y - a.y) * y > 0 && (next.x - b.x) * x + (next.y - b.y) * y > 0;
        if (!between || fabs(x * (b.y - a.y) - y * (b.x - a.x)) > nearness * length)
            c->points[kept++] = b;
    }
    c->count = kept;
}

/* Chains of segments that come back to where they began; others are gaps of a flawed surface and are left out. */
static void chain_segments(section *s, region_builder *b, double nearness)
{
    for (size_t i = 0; i < s->count && !b->failed; i++) {
        segment *at = &s->segments[i];
        if (at->used)
            continue;
        uint64_t begin = at->from, end = begin;
        builder_contour(b);
        for (; at && !b->failed; at = end == begin ? NULL : find_next(s, end)) {
            at->used = true;
            add_crossing(s, b, at->from);
            end = at->to;
        }
        if (b->failed)
            return;
        if (end != begin)
            b->contours[b->count - 1].count = 0;
        drop_straight(&b->contours[b->count - 1], nearness);
        builder_end_contour(b);
    }
}

static lmn_status cut(region *out, const polyhedron *p, bool at_is_above, lmn_error *error)
{
    section        s = {.p = p, .at_is_above = at_is_above};
    region_builder b = {0};
    point3         low, high;
    *out = (region){0};
    if (!polyhedron_bounds(p, &low, &high))
        return LMN_OK;
    for (size_t i = 0; i < p->triangle_count && !s.failed; i++)
        cut_triangle(&s, &p->triangles[i * 3]);
    if (s.count > 0)
        qsort(s.segments, s.count, sizeof *s.segments, compare_segments);
    if (!s.failed)
        chain_segments(&s, &b, 1e-9 * fmax(high.x - low.x, high.y - low.y));
    b.failed = b.failed || s.failed;
    mem_free(s.segments);
    return region_builder_finish(&b, out, error);
}

static lmn_status check_points(const char *shape, const polyhedron *p, lmn_error *error)
{
    return p->point_count > 0 ? check_numbers(shape, &p->points->x, p->point_count * 3, error) : LMN_OK;
}

/* A face that lies in the plane belongs to the cut, whether the solid is above it or below: both cases are looked
 * at. */
lmn_status polyhedron_slice(region *out, const polyhedron *p, lmn_error *error)
{
    *out = (region){0};
    region     both[2] = {{0}, {0}};
    lmn_status status = check_points("projection", p, error);
    for (int i = 0; status == LMN_OK && i < 2; i++)
        status = cut(&both[i], p, i == 1, error);
    if (status == LMN_OK)
        status = region_cover(out, both, 2, COVER_UNION, error);
    region_release(&both[0]);
    region_release(&both[1]);
    return status;
}

/* --- the shadow ----------------------------------------------------------------------------------------- */

lmn_status polyhedron_shadow(region *out, const polyhedron *p, lmn_error *error)
{
    *out = (region){0};
    lmn_status status = check_points("projection", p, error);
    if (status != LMN_OK)
        return status;
    region_builder b = {0};
    for (size_t i = 0; i < p->triangle_count && !b.failed; i++) {
        point2 corners[3];
        for (size_t k = 0; k < 3; k++) {
            const point3 *at = &p->points[p->triangles[i * 3 + k]];
            corners[k] = (point2){grid_position(at->x), grid_position(at->y)};
        }
        /* What faces down lies below what faces up. */
        if (!(contour_area2(corners, 3) > 0))
            continue;
        builder_contour(&b);
        for (int k = 0; k < 3; k++)
            builder_set_position(&b, corners[k].x, corners[k].y);
        builder_end_contour(&b);
    }
    region triangles;
    status = region_builder_finish(&b, &triangles, error);
    if (status == LMN_OK)
        status = region_unite_polygons(out, &triangles, error);
    region_release(&triangles);
    return status;
}
