/* Contours of any kind to clean regions, by GEOS: all edges are cut where they cross, on a fixed grid; the faces
 * between them are kept or not by how often the contours run round them; what is kept is traced. GEOS takes memory
 * past base/memory.h. */
#include <geos_c.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"
#include "construct/fenced.h"

/* A contour on the grid, and the operand it belongs to. */
typedef struct path {
    point2 *points;
    size_t  count, operand;
} path;

typedef struct cover {
    GEOSContextHandle_t geos;
    char                message[200];
    path               *paths;
    size_t              path_count, operand_count;
    edge_strips         edges;
    int                *windings; /* of one position, by operand */
    cover_rule          rule;
    bool                failed; /* memory is gone, ours */
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
    edge_strips_release(&c->edges);
    if (c->geos)
        GEOS_finish_r(c->geos);
    if (status != LMN_OK && (c->failed || !c->geos || strstr(c->message, "bad_alloc")))
        return error_memory(error);
    if (status != LMN_OK)
        return error_set(error, LMN_INTERNAL, "a set operation on regions failed: %s", c->message);
    return LMN_OK;
}

/* --- contours to lines ---------------------------------------------------------------------------------- */

/* The contour on the grid, without points repeated in a row. */
static bool make_path(path *out, const contour *from, size_t operand)
{
    *out = (path){.operand = operand};
    out->points = mem_calloc(from->count, sizeof *out->points);
    if (!out->points)
        return false;
    for (size_t i = 0; i < from->count; i++) {
        point2 p = {grid_position(from->points[i].x), grid_position(from->points[i].y)};
        if (out->count > 0 && p.x == out->points[out->count - 1].x && p.y == out->points[out->count - 1].y)
            continue;
        out->points[out->count++] = p;
    }
    while (out->count > 1 && out->points[0].x == out->points[out->count - 1].x &&
           out->points[0].y == out->points[out->count - 1].y)
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
        GEOSGeometry *ring =
            polygons ? GEOSGeom_createLinearRing_r(c->geos, sequence) : GEOSGeom_createLineString_r(c->geos, sequence);
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

/* --- which faces are inside ----------------------------------------------------------------------------- */

static bool index_edges(cover *c)
{
    size_t count = 0, at = 0;
    for (size_t i = 0; i < c->path_count; i++)
        count += c->paths[i].count;
    wound_edge *edges = mem_calloc(count, sizeof *edges);
    for (size_t i = 0; edges && i < c->path_count; i++) {
        const path *p = &c->paths[i];
        for (size_t k = 0; k < p->count; k++)
            edges[at++] = (wound_edge){p->points[k], p->points[k + 1 < p->count ? k + 1 : 0], p->operand};
    }
    return edges && edge_strips_make(&c->edges, edges, count);
}

static bool is_inside(cover *c, double x, double y)
{
    memset(c->windings, 0, c->operand_count * sizeof *c->windings);
    edge_strips_wind(&c->edges, x, y, c->windings);
    if (c->rule == COVER_ODD)
        return c->windings[0] % 2 != 0;
    bool first = c->windings[0] > 0, any = false, all = true;
    for (size_t i = 1; i < c->operand_count; i++) {
        any = any || c->windings[i] > 0;
        all = all && c->windings[i] > 0;
    }
    switch (c->rule) {
    case COVER_UNION: return first || any;
    case COVER_INTERSECTION: return first && all;
    case COVER_DIFFERENCE: return first && !any;
    default: return first;
    }
}

/* A face too small to have a position of its own inside is outside. */
static bool face_is_inside(cover *c, const GEOSGeometry *face)
{
    double        x, y;
    GEOSGeometry *position = GEOSPointOnSurface_r(c->geos, face);
    bool found = position && GEOSGeomGetX_r(c->geos, position, &x) == 1 && GEOSGeomGetY_r(c->geos, position, &y) == 1;
    GEOSGeom_destroy_r(c->geos, position);
    return found && is_inside(c, x, y);
}

/* --- back to a region ----------------------------------------------------------------------------------- */

typedef struct border {
    plane_edge *edges;
    size_t      count, capacity;
} border;

/* The ring's points, the last not the first again; NULL when it has none, or memory is gone. The caller frees them. */
static point2 *ring_points(cover *c, const GEOSGeometry *ring, size_t *count)
{
    const GEOSCoordSequence *sequence = GEOSGeom_getCoordSeq_r(c->geos, ring);
    unsigned                 size = 0;
    if (!sequence || GEOSCoordSeq_getSize_r(c->geos, sequence, &size) != 1 || size < 4)
        return NULL;
    point2 *points = mem_calloc(size, sizeof *points);
    c->failed = c->failed || !points;
    for (unsigned i = 0; points && i < size; i++)
        GEOSCoordSeq_getXY_r(c->geos, sequence, i, &points[i].x, &points[i].y);
    *count = size - 1;
    return points;
}

/* The ring's edges, turned so that the inside is on the left. */
static void add_ring(cover *c, border *out, const GEOSGeometry *ring, bool hole)
{
    size_t  count;
    point2 *points = ring_points(c, ring, &count);
    if (!points)
        return;
    bool reversed = (contour_area2(points, count) < 0) != hole;
    if (!mem_grow((void **)&out->edges, &out->capacity, out->count + count, sizeof *out->edges)) {
        c->failed = true;
        count = 0;
    }
    for (size_t i = 0; i < count; i++) {
        point2 a = points[i], b = points[i + 1 < count ? i + 1 : 0];
        out->edges[out->count++] = reversed ? (plane_edge){b, a} : (plane_edge){a, b};
    }
    mem_free(points);
}

static void add_polygon(cover *c, border *out, const GEOSGeometry *polygon)
{
    if (GEOSGeomTypeId_r(c->geos, polygon) != GEOS_POLYGON || GEOSisEmpty_r(c->geos, polygon) != 0)
        return;
    add_ring(c, out, GEOSGetExteriorRing_r(c->geos, polygon), false);
    int holes = GEOSGetNumInteriorRings_r(c->geos, polygon);
    for (int i = 0; i < holes; i++)
        add_ring(c, out, GEOSGetInteriorRingN_r(c->geos, polygon, i), true);
}

/* The contours around all faces, or around those that are inside. */
static lmn_status trace_faces(cover *c, region *out, const GEOSGeometry *faces, bool all)
{
    border edges = {0};
    int    count = GEOSGetNumGeometries_r(c->geos, faces);
    for (int i = 0; i < count && !c->failed; i++) {
        const GEOSGeometry *face = GEOSGetGeometryN_r(c->geos, faces, i);
        if (all || face_is_inside(c, face))
            add_polygon(c, &edges, face);
    }
    if (!c->failed && edges.count > 0)
        c->failed = !edges_trace(out, edges.edges, edges.count);
    mem_free(edges.edges);
    return c->failed ? LMN_MEMORY : LMN_OK;
}

static lmn_status cover_paths(cover *c, region *out)
{
    lmn_status    status = LMN_INTERNAL;
    GEOSGeometry *lines = make_geometry(c, false), *faces = NULL;
    GEOSGeometry *cut = lines ? GEOSUnaryUnionPrec_r(c->geos, lines, GRID) : NULL;
    if (cut)
        faces = GEOSPolygonize_r(c->geos, (const GEOSGeometry *const[]){cut}, 1);
    if (faces)
        status = trace_faces(c, out, faces, false);
    GEOSGeom_destroy_r(c->geos, faces);
    GEOSGeom_destroy_r(c->geos, cut);
    GEOSGeom_destroy_r(c->geos, lines);
    return status;
}

static lmn_status cover_here(region *out, const region *operands, size_t count, cover_rule rule, lmn_error *error)
{
    *out = (region){0};
    cover c = {.rule = rule};
    if (!cover_begin(&c))
        return error_memory(error);
    lmn_status status = LMN_OK;
    c.failed = !make_paths(&c, operands, count) || !index_edges(&c);
    if (c.failed)
        status = LMN_MEMORY;
    else if (c.path_count > 0)
        status = cover_paths(&c, out);
    return cover_end(&c, status, error);
}

static lmn_status unite_here(region *out, const region *polygons, lmn_error *error)
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
        GEOSGeometry *parts = make_geometry(&c, true),
                     *whole = parts ? GEOSUnaryUnionPrec_r(c.geos, parts, GRID) : NULL;
        status = whole ? trace_faces(&c, out, whole, true) : LMN_INTERNAL;
        GEOSGeom_destroy_r(c.geos, whole);
        GEOSGeom_destroy_r(c.geos, parts);
    }
    return cover_end(&c, status, error);
}

/* --- behind the fence and before it --------------------------------------------------------------------- */

enum { UNITE_POLYGONS = 1000 }; /* beside the rules */

static void release_all(region *regions, size_t count)
{
    for (size_t i = 0; regions && i < count; i++)
        region_release(&regions[i]);
    mem_free(regions);
}

/* Request: rule, number of operands, operands. Answer: the region. */
static lmn_status cover_request(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_reader r = fence_read(request, size);
    uint32_t     rule = fence_take_u32(&r), count = fence_take_u32(&r);
    region      *operands = mem_calloc(count, sizeof *operands), out = {0};
    bool         good = operands != NULL;
    for (uint32_t i = 0; good && i < count; i++)
        good = region_take(&operands[i], &r);
    lmn_status status = LMN_MEMORY;
    if (good)
        status = rule == UNITE_POLYGONS ? unite_here(&out, operands, error)
                                        : cover_here(&out, operands, count, (cover_rule)rule, error);
    else
        error_memory(error);
    if (status == LMN_OK)
        region_put(answer, out.contours, out.count);
    release_all(operands, count);
    region_release(&out);
    return status;
}

static lmn_status cover_fenced(region *out, const region *operands, size_t count, uint32_t rule, lmn_error *error)
{
    fence_bytes request = {0}, answer;
    fence_put_u32(&request, rule);
    fence_put_u32(&request, (uint32_t)count);
    for (size_t i = 0; i < count; i++)
        region_put(&request, operands[i].contours, operands[i].count);
    lmn_status   status = fence_call_always(&answer, cover_request, "a set operation on regions", &request, error);
    fence_reader r = fence_read(answer.bytes, answer.size);
    if (status == LMN_OK && !region_take(out, &r)) {
        region_release(out);
        status = error_memory(error);
    }
    mem_free(request.bytes);
    mem_free(answer.bytes);
    return status;
}

static bool is_large(const region *operands, size_t count)
{
    size_t points = 0;
    for (size_t i = 0; i < count; i++)
        points += region_point_count(&operands[i]);
    return points > FENCED_PLANE_POINTS;
}

lmn_status region_cover(region *out, const region *operands, size_t count, cover_rule rule, lmn_error *error)
{
    *out = (region){0};
    return is_large(operands, count) ? cover_fenced(out, operands, count, (uint32_t)rule, error)
                                     : cover_here(out, operands, count, rule, error);
}

lmn_status region_unite_polygons(region *out, const region *polygons, lmn_error *error)
{
    *out = (region){0};
    return is_large(polygons, 1) ? cover_fenced(out, polygons, 1, UNITE_POLYGONS, error)
                                 : unite_here(out, polygons, error);
}
