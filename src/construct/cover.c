/* Contours of any kind to clean regions, by GEOS: all edges are cut where they cross, on a fixed grid; the faces between them are
 * kept or not by how often the contours run round them; what is kept is united. GEOS takes memory past base/memory.h. */
#include <geos_c.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"

/* A contour on the grid, and the operand it belongs to. */
typedef struct path {
    point2 *points;
    size_t  count, operand;
    double  low_y, high_y, high_x;
} path;

typedef struct cover {
    GEOSContextHandle_t geos;
    char                message[200];
    path               *paths;
    size_t              path_count, operand_count;
    int                *windings; /* of one place, by operand */
    cover_rule          rule;
    bool                failed;   /* memory is gone, ours */
} cover;

static void keep_message(const char *message, void *user)
{
    cover *c = user;
    strncpy(c->message, message, sizeof c->message - 1);
}

static bool cover_begin(cover *c)
{
    c->geos = GEOS_init_r();
    if (!c->geos)
        return false;
    GEOSContext_setErrorMessageHandler_r(c->geos, keep_message, c);
    return true;
}

static lmn_status cover_end(cover *c, lmn_status status, lmn_error *error)
{
    for (size_t i = 0; i < c->path_count; i++)
        mem_free(c->paths[i].points);
    mem_free(c->paths);
    mem_free(c->windings);
    if (c->geos)
        GEOS_finish_r(c->geos);
    if (status != LMN_OK && (c->failed || !c->geos || strstr(c->message, "bad_alloc")))
        return error_memory(error);
    if (status != LMN_OK)
        return error_set(error, LMN_INTERNAL, "a set operation on regions failed: %s", c->message);
    return LMN_OK;
}

/* --- contours to lines ---------------------------------------------------------------------------------------------- */

/* The contour on the grid, without points repeated in a row. */
static bool make_path(path *out, const contour *from, size_t operand)
{
    *out = (path){.operand = operand, .low_y = INFINITY, .high_y = -INFINITY, .high_x = -INFINITY};
    out->points = mem_calloc(from->count, sizeof *out->points);
    if (!out->points)
        return false;
    for (size_t i = 0; i < from->count; i++) {
        point2 p = {grid_place(from->points[i].x), grid_place(from->points[i].y)};
        if (out->count > 0 && p.x == out->points[out->count - 1].x && p.y == out->points[out->count - 1].y)
            continue;
        out->points[out->count++] = p;
        out->low_y = fmin(out->low_y, p.y);
        out->high_y = fmax(out->high_y, p.y);
        out->high_x = fmax(out->high_x, p.x);
    }
    while (out->count > 1 && out->points[0].x == out->points[out->count - 1].x && out->points[0].y == out->points[out->count - 1].y)
        out->count--;
    return true;
}

static bool make_paths(cover *c, const region *operands, size_t count)
{
    size_t total = 0;
    for (size_t i = 0; i < count; i++)
        total += operands[i].count;
    c->paths = mem_calloc(total, sizeof *c->paths);
    c->windings = mem_calloc(count, sizeof *c->windings);
    c->operand_count = count;
    if (!c->paths || !c->windings)
        return false;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < operands[i].count; k++) {
            path *p = &c->paths[c->path_count];
            if (!make_path(p, &operands[i].contours[k], i))
                return false;
            if (p->count >= 3)
                c->path_count++;
            else
                mem_free(p->points);
        }
    return true;
}

/* The closed path as coordinates, the first point again at the end. NULL when GEOS fails. */
static GEOSCoordSequence *make_sequence(cover *c, const point2 *points, size_t count)
{
    GEOSCoordSequence *sequence = GEOSCoordSeq_create_r(c->geos, (unsigned)count + 1, 2);
    for (size_t i = 0; sequence && i <= count; i++)
        GEOSCoordSeq_setXY_r(c->geos, sequence, (unsigned)i, points[i % count].x, points[i % count].y);
    return sequence;
}

/* Hands over the parts, which GEOS then owns, all or none. */
static GEOSGeometry *make_collection(cover *c, int type, GEOSGeometry **parts, size_t count)
{
    GEOSGeometry *all = GEOSGeom_createCollection_r(c->geos, type, parts, (unsigned)count);
    for (size_t i = 0; !all && i < count; i++)
        GEOSGeom_destroy_r(c->geos, parts[i]);
    return all;
}

/* All paths as lines, or as polygons. */
static GEOSGeometry *make_geometry(cover *c, bool polygons)
{
    GEOSGeometry **parts = mem_calloc(c->path_count, sizeof(GEOSGeometry *)), *all = NULL;
    c->failed = c->failed || !parts;
    size_t made = 0;
    for (; parts && made < c->path_count; made++) {
        GEOSCoordSequence *sequence = make_sequence(c, c->paths[made].points, c->paths[made].count);
        if (!sequence)
            break;
        GEOSGeometry *ring = polygons ? GEOSGeom_createLinearRing_r(c->geos, sequence)
                                      : GEOSGeom_createLineString_r(c->geos, sequence);
        parts[made] = polygons && ring ? GEOSGeom_createPolygon_r(c->geos, ring, NULL, 0) : ring;
        if (!parts[made])
            break;
    }
    if (parts && made == c->path_count)
        all = make_collection(c, polygons ? GEOS_MULTIPOLYGON : GEOS_MULTILINESTRING, parts, made);
    else
        for (size_t i = 0; i < made; i++)
            GEOSGeom_destroy_r(c->geos, parts[i]);
    mem_free(parts);
    return all;
}

/* --- which faces are inside ------------------------------------------------------------------------------------------- */

/* How often the path runs anticlockwise round the place: its edges that cross the ray to the right. */
static int winding_of(const path *p, double x, double y)
{
    int winding = 0;
    if (y < p->low_y || y > p->high_y || x > p->high_x)
        return 0;
    for (size_t i = 0; i < p->count; i++) {
        const point2 *a = &p->points[i], *b = &p->points[i + 1 == p->count ? 0 : i + 1];
        if ((a->y > y) == (b->y > y))
            continue;
        double side = (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
        if (b->y > a->y ? side > 0 : side < 0)
            winding += b->y > a->y ? 1 : -1;
    }
    return winding;
}

static bool is_inside(cover *c, double x, double y)
{
    memset(c->windings, 0, c->operand_count * sizeof *c->windings);
    for (size_t i = 0; i < c->path_count; i++)
        c->windings[c->paths[i].operand] += winding_of(&c->paths[i], x, y);
    if (c->rule == COVER_ODD)
        return c->windings[0] % 2 != 0;
    bool first = c->windings[0] > 0, any = false, all = true;
    for (size_t i = 1; i < c->operand_count; i++) {
        any = any || c->windings[i] > 0;
        all = all && c->windings[i] > 0;
    }
    switch (c->rule) {
    case COVER_UNION:
        return first || any;
    case COVER_INTERSECTION:
        return first && all;
    case COVER_DIFFERENCE:
        return first && !any;
    default:
        return first;
    }
}

/* A face too small to have a place of its own inside is outside. */
static bool face_is_inside(cover *c, const GEOSGeometry *face)
{
    double x, y;
    GEOSGeometry *place = GEOSPointOnSurface_r(c->geos, face);
    bool found = place && GEOSGeomGetX_r(c->geos, place, &x) == 1 && GEOSGeomGetY_r(c->geos, place, &y) == 1;
    GEOSGeom_destroy_r(c->geos, place);
    return found && is_inside(c, x, y);
}

static GEOSGeometry *choose_faces(cover *c, const GEOSGeometry *faces)
{
    int count = GEOSGetNumGeometries_r(c->geos, faces);
    GEOSGeometry **kept = mem_calloc((size_t)(count > 0 ? count : 0), sizeof(GEOSGeometry *)), *all = NULL;
    size_t kept_count = 0;
    c->failed = c->failed || !kept;
    bool cloned = kept && count >= 0;
    for (int i = 0; cloned && i < count; i++) {
        const GEOSGeometry *face = GEOSGetGeometryN_r(c->geos, faces, i);
        if (!face_is_inside(c, face))
            continue;
        kept[kept_count] = GEOSGeom_clone_r(c->geos, face);
        cloned = kept[kept_count] != NULL;
        kept_count += cloned;
    }
    if (cloned)
        all = make_collection(c, GEOS_GEOMETRYCOLLECTION, kept, kept_count);
    else
        for (size_t i = 0; i < kept_count; i++)
            GEOSGeom_destroy_r(c->geos, kept[i]);
    mem_free(kept);
    return all;
}

/* --- back to a region --------------------------------------------------------------------------------------------------- */

/* The result's points, sorted: those that come twice are where contours touch. */
typedef struct corners {
    point2 *points;
    size_t  count, capacity;
    bool    failed;
} corners;

static int compare_places(const void *a, const void *b)
{
    const point2 *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

static bool is_shared(const corners *all, point2 p)
{
    const point2 *found = bsearch(&p, all->points, all->count, sizeof p, compare_places);
    if (!found)
        return false;
    return (found > all->points && compare_places(found - 1, &p) == 0) ||
           (found + 1 < all->points + all->count && compare_places(found + 1, &p) == 0);
}

/* Leaves out points on the straight line between their neighbours, and spikes; until none is left. Where another contour touches
 * the line the point stays: without it the touching would be found again later, and not by all in the same way. */
static size_t drop_straight(const corners *all, point2 *points, size_t count)
{
    size_t before = count + 1;
    while (count >= 3 && count < before) {
        before = count;
        size_t kept = 0;
        for (size_t i = 0; i < before; i++) {
            point2 a = points[kept > 0 ? kept - 1 : before - 1], b = points[i], next = points[i + 1 < before ? i + 1 : 0];
            bool straight = (b.x - a.x) * (next.y - b.y) == (b.y - a.y) * (next.x - b.x);
            if (!straight || is_shared(all, b))
                points[kept++] = b;
        }
        count = kept;
    }
    return count;
}

/* The ring's points, the last not the first again; NULL when it has none, or memory is gone. The caller frees them. */
static point2 *ring_points(cover *c, const GEOSGeometry *ring, size_t *count)
{
    const GEOSCoordSequence *sequence = GEOSGeom_getCoordSeq_r(c->geos, ring);
    unsigned size = 0;
    if (!sequence || GEOSCoordSeq_getSize_r(c->geos, sequence, &size) != 1 || size < 4)
        return NULL;
    point2 *points = mem_calloc(size, sizeof *points);
    c->failed = c->failed || !points;
    for (unsigned i = 0; points && i < size; i++)
        GEOSCoordSeq_getXY_r(c->geos, sequence, i, &points[i].x, &points[i].y);
    *count = size - 1;
    return points;
}

static void add_ring(cover *c, region_builder *b, const corners *all, const GEOSGeometry *ring, bool hole)
{
    size_t count;
    point2 *points = ring_points(c, ring, &count);
    if (!points)
        return;
    size_t kept = drop_straight(all, points, count);
    bool reversed = (contour_area2(points, kept) < 0) != hole;
    builder_contour(b);
    for (size_t i = 0; i < kept; i++)
        builder_place(b, points[reversed ? kept - 1 - i : i].x, points[reversed ? kept - 1 - i : i].y);
    builder_end_contour(b);
    mem_free(points);
}

static void collect_ring(cover *c, corners *all, const GEOSGeometry *ring)
{
    size_t count;
    point2 *points = ring_points(c, ring, &count);
    if (points && mem_grow((void **)&all->points, &all->capacity, all->count + count, sizeof *points)) {
        memcpy(all->points + all->count, points, count * sizeof *points);
        all->count += count;
    } else {
        all->failed = all->failed || points;
    }
    mem_free(points);
}

/* Goes through all rings; with a builder they are added to it, without one their points are collected. */
static void visit_rings(cover *c, region_builder *b, corners *all, const GEOSGeometry *g)
{
    int count = GEOSGetNumGeometries_r(c->geos, g);
    for (int i = 0; i < count; i++) {
        const GEOSGeometry *polygon = GEOSGetGeometryN_r(c->geos, g, i);
        if (GEOSGeomTypeId_r(c->geos, polygon) != GEOS_POLYGON || GEOSisEmpty_r(c->geos, polygon) != 0)
            continue;
        int holes = GEOSGetNumInteriorRings_r(c->geos, polygon);
        for (int k = -1; k < holes; k++) {
            const GEOSGeometry *ring = k < 0 ? GEOSGetExteriorRing_r(c->geos, polygon) : GEOSGetInteriorRingN_r(c->geos, polygon, k);
            if (b)
                add_ring(c, b, all, ring, k >= 0);
            else
                collect_ring(c, all, ring);
        }
    }
}

/* Unites what lies side by side, and hands it over. */
static lmn_status unite(cover *c, region *out, const GEOSGeometry *parts)
{
    GEOSGeometry *whole = parts ? GEOSUnaryUnionPrec_r(c->geos, parts, GRID) : NULL;
    if (!whole)
        return LMN_INTERNAL;
    region_builder b = {0};
    corners all = {0};
    visit_rings(c, NULL, &all, whole);
    if (all.count > 0)
        qsort(all.points, all.count, sizeof *all.points, compare_places);
    if (!all.failed && all.count > 0)
        visit_rings(c, &b, &all, whole);
    b.failed = b.failed || all.failed || c->failed;
    mem_free(all.points);
    GEOSGeom_destroy_r(c->geos, whole);
    lmn_status status = region_builder_finish(&b, out, NULL);
    c->failed = c->failed || status != LMN_OK;
    return status;
}

static lmn_status cover_paths(cover *c, region *out)
{
    lmn_status status = LMN_INTERNAL;
    GEOSGeometry *lines = make_geometry(c, false), *faces = NULL, *kept = NULL;
    GEOSGeometry *cut = lines ? GEOSUnaryUnionPrec_r(c->geos, lines, GRID) : NULL;
    if (cut)
        faces = GEOSPolygonize_r(c->geos, (const GEOSGeometry *const[]){cut}, 1);
    if (faces)
        kept = choose_faces(c, faces);
    if (kept)
        status = unite(c, out, kept);
    GEOSGeom_destroy_r(c->geos, kept);
    GEOSGeom_destroy_r(c->geos, faces);
    GEOSGeom_destroy_r(c->geos, cut);
    GEOSGeom_destroy_r(c->geos, lines);
    return status;
}

lmn_status region_cover(region *out, const region *operands, size_t count, cover_rule rule, lmn_error *error)
{
    *out = (region){0};
    cover c = {.rule = rule};
    if (!cover_begin(&c))
        return error_memory(error);
    lmn_status status = LMN_OK;
    c.failed = !make_paths(&c, operands, count);
    if (c.failed)
        status = LMN_MEMORY;
    else if (c.path_count > 0)
        status = cover_paths(&c, out);
    return cover_end(&c, status, error);
}

lmn_status region_unite_polygons(region *out, const region *polygons, lmn_error *error)
{
    *out = (region){0};
    cover c = {.rule = COVER_UNION};
    if (!cover_begin(&c))
        return error_memory(error);
    lmn_status status = LMN_OK;
    c.failed = !make_paths(&c, polygons, 1);
    if (c.failed) {
        status = LMN_MEMORY;
    } else if (c.path_count > 0) {
        GEOSGeometry *parts = make_geometry(&c, true);
        status = unite(&c, out, parts);
        GEOSGeom_destroy_r(c.geos, parts);
    }
    return cover_end(&c, status, error);
}
