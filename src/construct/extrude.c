/* Regions to solids: along the z axis, and round it. */
#include <math.h>

#include "base/memory.h"
#include "construct/construct_private.h"

/* --- caps --------------------------------------------------------------------------------------------------------- */

/* The region's triangles, between the points of `up` and again those of `down` the other way round, which both begin with the
 * region's first point. What cannot be filled exactly crosses itself. */
static lmn_status add_caps(solid_builder *b, const region *r, uint32_t up, uint32_t down, const char *shape, lmn_error *error)
{
    uint32_t *corners = NULL;
    size_t count = 0;
    bool exact = false;
    lmn_status status = contours_triangulate(r->contours, r->count, &corners, &count, &exact, error);
    if (status == LMN_OK && !exact)
        status = error_set(error, LMN_FORMAT, "%s: the outline crosses itself", shape);
    for (size_t i = 0; status == LMN_OK && i < count; i += 3) {
        builder_triangle(b, up + corners[i], up + corners[i + 1], up + corners[i + 2]);
        builder_triangle(b, down + corners[i], down + corners[i + 2], down + corners[i + 1]);
    }
    mem_free(corners);
    return status;
}

/* --- linear: how many slices ------------------------------------------------------------------------------------------ */

typedef struct slicing {
    double radius; /* of the point farthest from the axis */
    double shift;  /* how far scaling moves the point that it moves farthest */
} slicing;

static slicing measure(const region *r, const double scale[2])
{
    slicing s = {0, 0};
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < r->contours[i].count; k++) {
            point2 p = r->contours[i].points[k];
            s.radius = fmax(s.radius, hypot(p.x, p.y));
            s.shift = fmax(s.shift, hypot(p.x * (scale[0] - 1), p.y * (scale[1] - 1)));
        }
    return s;
}

/* Slices of a curve this long that turns by this many degrees: never more than 120 degrees in one. */
static double slices_of_turn(double length, double twist, facets f)
{
    double least = fmax(ceil(fabs(twist) / 120), 1);
    if (f.fn > 0)
        return fmax(ceil(fabs(twist) / 360 * f.fn), least);
    return fmax(fmin(ceil(fabs(twist) / fmax(f.fa, 0.01)), ceil(length / fmax(f.fs, 0.01))), least);
}

/* The length of Archimedes' spiral r = a·t from its centre to the angle t. */
static double spiral_length(double a, double t)
{
    return 0.5 * a * (t * sqrt(1 + t * t) + asinh(t));
}

/* The way of the farthest point when it turns and comes nearer to the axis, or goes away from it, at once. OpenSCAD takes the
 * radius before scaling as the larger one in both cases, and so does this. */
static double conical_length(double radius, double height, double twist, double scale)
{
    double turn = fabs(twist) * PI / 180, end = scale > 1 ? turn * scale / (scale - 1) : turn / (1 - scale), start = end - turn;
    double a = radius / end;
    return hypot(spiral_length(a, end) - spiral_length(a, start), height);
}

static double slices_of_shift(double shift, double height, facets f)
{
    if (f.fn > 0)
        return fmax(f.fn, 1);
    return fmax(ceil(hypot(shift, height) / fmax(f.fs, 0.01)), 1);
}

static double slice_count(const region *r, const linear_extrusion *how, const double scale[2])
{
    if (how->has_slices)
        return fmax(how->slices, 1);
    slicing s = measure(r, scale);
    bool even = scale[0] == scale[1];
    if (how->twist == 0)
        return even ? 1 : slices_of_shift(s.shift, how->height, how->facets);
    double helix = hypot(s.radius * how->twist * PI / 180, how->height);
    double length = even && scale[0] != 1 ? conical_length(s.radius, how->height, how->twist, scale[0]) : helix;
    return slices_of_turn(length, how->twist, how->facets);
}

/* --- linear: the sides ------------------------------------------------------------------------------------------------ */

/* The region's points at this share of the height: turned, then scaled. */
static void add_slice(solid_builder *b, const region *r, const linear_extrusion *how, const double scale[2], double share)
{
    double angle = -how->twist * share, c = cosine_of_degrees(angle), s = sine_of_degrees(angle);
    double x = 1 - (1 - scale[0]) * share, y = 1 - (1 - scale[1]) * share;
    double z = how->height * share - (how->centre ? how->height / 2 : 0);
    if (share == 1) { /* without rounding */
        x = scale[0];
        y = scale[1];
        z = how->centre ? how->height / 2 : how->height;
    }
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < r->contours[i].count; k++) {
            point2 p = r->contours[i].points[k];
            builder_point(b, x * (c * p.x - s * p.y), y * (s * p.x + c * p.y), z);
        }
}

static double plane_distance(const solid_builder *b, uint32_t i, uint32_t j)
{
    return hypot(b->points[i].x - b->points[j].x, b->points[i].y - b->points[j].y);
}

/* One quad of the side, cut along its shorter diagonal; among equal ones (to ten in a million) the twist decides. Where the slice
 * above is a line, OpenSCAD takes the longer one. */
static void add_side(solid_builder *b, uint32_t below, uint32_t next_below, uint32_t above, uint32_t next_above, double twist,
                     bool to_line)
{
    double forwards = plane_distance(b, below, next_above), backwards = plane_distance(b, next_below, above);
    bool equal = fabs(forwards - backwards) * 2e5 <= forwards + backwards;
    if (equal ? twist > 0 : (forwards < backwards) != to_line)
        builder_quad(b, below, next_below, next_above, above);
    else
        builder_quad(b, next_below, next_above, above, below);
}

static void add_sides(solid_builder *b, const region *r, uint32_t first, uint32_t points, double twist, bool to_line)
{
    for (size_t i = 0; i < r->count; i++) {
        uint32_t count = (uint32_t)r->contours[i].count;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t below = first + k, next = first + (k + 1) % count;
            add_side(b, below, next, below + points, next + points, twist, to_line);
        }
        first += count;
    }
}

lmn_status construct_linear_extrude(polyhedron *out, const region *r, const linear_extrusion *how, lmn_error *error)
{
    *out = (polyhedron){0};
    lmn_status status = check_numbers("linear_extrude", (double[]){how->height, how->twist, how->scale[0], how->scale[1]}, 4, error);
    if (status == LMN_OK)
        status = check_region("linear_extrude", r, error);
    if (status != LMN_OK || !(how->height > 0) || r->count == 0)
        return status;
    const double scale[2] = {fmax(how->scale[0], 0), fmax(how->scale[1], 0)};
    double slices = slice_count(r, how, scale);
    size_t points = region_point_count(r);
    status = check_point_count("linear_extrude", (double)points * (slices + 1), error);
    if (status != LMN_OK)
        return status;
    bool line = (scale[0] == 0) != (scale[1] == 0);
    solid_builder b = {0};
    for (int i = 0; i <= (int)slices; i++)
        add_slice(&b, r, how, scale, i == (int)slices ? 1 : i / floor(slices));
    for (int i = 0; !b.failed && i < (int)slices; i++)
        add_sides(&b, r, (uint32_t)((size_t)i * points), (uint32_t)points, how->twist, i + 1 == (int)slices && line);
    status = add_caps(&b, r, (uint32_t)((size_t)slices * points), 0, "linear_extrude", error);
    if (status != LMN_OK) {
        builder_release(&b);
        return status;
    }
    return builder_finish(&b, out, error);
}

/* --- round the axis --------------------------------------------------------------------------------------------------- */

/* The region's points at this angle. Nearly on the axis is on it: there the ring is one place. */
static void add_ring(solid_builder *b, const region *r, double angle, double reach)
{
    double c = cosine_of_degrees(angle), s = sine_of_degrees(angle);
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < r->contours[i].count; k++) {
            point2 p = r->contours[i].points[k];
            double x = fabs(p.x) <= 1e-12 * reach ? 0 : p.x;
            builder_point(b, x * c, x * s, p.y);
        }
}

static void add_turn(solid_builder *b, const region *r, uint32_t from, uint32_t to)
{
    uint32_t first = 0;
    for (size_t i = 0; i < r->count; i++) {
        uint32_t count = (uint32_t)r->contours[i].count;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t here = first + k, next = first + (k + 1) % count;
            builder_quad(b, from + here, to + here, to + next, from + next);
        }
        first += count;
    }
}

/* A full turn begins at 180 degrees, a part of one at 0. */
static lmn_status turn(polyhedron *out, const region *r, double angle, int pieces, double reach, lmn_error *error)
{
    bool full = fabs(angle) >= 360;
    size_t points = region_point_count(r);
    int rings = full ? pieces : pieces + 1;
    solid_builder b = {0};
    for (int i = 0; i < rings; i++)
        add_ring(&b, r, (full ? 180 : 0) + (i == pieces ? angle : angle * i / pieces), reach);
    for (int i = 0; i < pieces; i++)
        add_turn(&b, r, (uint32_t)((size_t)i * points), (uint32_t)((size_t)((i + 1) % rings) * points));
    /* Seen along the turn, the region's plane shows its back. */
    lmn_status status = full ? LMN_OK : add_caps(&b, r, 0, (uint32_t)((size_t)pieces * points), "rotate_extrude", error);
    if (status != LMN_OK) {
        builder_release(&b);
        return status;
    }
    return builder_finish(&b, out, error);
}

lmn_status construct_rotate_extrude(polyhedron *out, const region *r, double angle_degrees, facets f, lmn_error *error)
{
    *out = (polyhedron){0};
    double low[2], high[2], angle = fabs(angle_degrees) > 360 ? 360 : angle_degrees;
    lmn_status status = check_numbers("rotate_extrude", &angle_degrees, 1, error);
    if (status == LMN_OK)
        status = check_region("rotate_extrude", r, error);
    if (status != LMN_OK || angle == 0 || !region_bounds(r, low, high))
        return status;
    double reach = fmax(-low[0], high[0]);
    if (low[0] < -1e-12 * reach && high[0] > 1e-12 * reach) {
        error_set(error, LMN_FORMAT, "rotate_extrude: the outline lies on both sides of the axis, from x = %g to %g", low[0], high[0]);
        error_hint(error, "move it to one side, or intersect it with one half of the plane");
        return LMN_FORMAT;
    }
    int whole = facets_of_circle(reach, f);
    double pieces = fmax(floor(whole * fabs(angle) / 360), 1);
    status = check_point_count("rotate_extrude", (double)region_point_count(r) * (pieces + 1), error);
    return status == LMN_OK ? turn(out, r, angle, (int)pieces, reach, error) : status;
}
