/* Regions to solids: along the z axis, and round it. */
#include <math.h>

#include "base/memory.h"
#include "construct/construct_private.h"

/* --- caps ----------------------------------------------------------------------------------------------- */

/* A region and the triangles that fill it, three corners each. */
typedef struct cap {
    region        cleaned; /* empty when the region is used as it is */
    const region *outline;
    uint32_t     *corners;
    size_t        corner_count;
} cap;

static void cap_release(cap *c)
{
    mem_free(c->corners);
    region_release(&c->cleaned);
}

static lmn_status fill(cap *c, const region *r, bool *exact, lmn_error *error)
{
    mem_free(c->corners);
    c->corners = NULL;
    c->outline = r;
    return contours_triangulate(r->contours, r->count, &c->corners, &c->corner_count, exact, error);
}

/* Sides and caps must have the same points. Where an outline's edges touch or cross, by rounding after a turn for
 * example, it is cleaned first. */
static lmn_status make_cap(cap *c, const region *r, const char *shape, lmn_error *error)
{
    bool exact = false;
    *c = (cap){0};
    lmn_status status = fill(c, r, &exact, error);
    if (status == LMN_OK && !exact)
        status = region_cover(&c->cleaned, r, 1, COVER_POSITIVE, error);
    if (status == LMN_OK && !exact)
        status = fill(c, &c->cleaned, &exact, error);
    if (status == LMN_OK && !exact)
        status = error_set(error, LMN_FORMAT, "%s: the outline crosses itself", shape);
    if (status != LMN_OK)
        cap_release(c);
    return status;
}

/* The cap between the points from `up` on, and again between those from `down` on the other way round. */
static void add_caps(solid_builder *b, const cap *c, uint32_t up, uint32_t down)
{
    for (size_t i = 0; i < c->corner_count; i += 3) {
        builder_triangle(b, up + c->corners[i], up + c->corners[i + 1], up + c->corners[i + 2]);
        builder_triangle(b, down + c->corners[i], down + c->corners[i + 2], down + c->corners[i + 1]);
    }
}

/* --- linear: how many slices ---------------------------------------------------------------------------- */

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

/* The way of the farthest point when it turns and comes nearer to the axis, or goes away from it, at once. OpenSCAD
 * takes the radius before scaling as the larger one in both cases, and so does this. */
static double conical_length(double radius, double height, double twist, double scale)
{
    double turn = fabs(twist) * PI / 180, end = scale > 1 ? turn * scale / (scale - 1) : turn / (1 - scale),
           start = end - turn;
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
    bool    even = scale[0] == scale[1];
    if (how->twist == 0)
        return even ? 1 : slices_of_shift(s.shift, how->height, how->facets);
    double helix = hypot(s.radius * how->twist * PI / 180, how->height);
    double length = even && scale[0] != 1 ? conical_length(s.radius, how->height, how->twist, scale[0]) : helix;
    return slices_of_turn(length, how->twist, how->facets);
}

/* --- linear: the sides ---------------------------------------------------------------------------------- */

/* The region's points at this fraction of the height: turned, then scaled. */
static void add_slice(solid_builder *b, const region *r, const linear_extrusion *how, const double scale[2],
                      double fraction)
{
    double angle = -how->twist * fraction, c = cosine_of_degrees(angle), s = sine_of_degrees(angle);
    double x = 1 - (1 - scale[0]) * fraction, y = 1 - (1 - scale[1]) * fraction;
    double z = how->height * fraction - (how->centre ? how->height / 2 : 0);
    if (fraction == 1) { /* without rounding */
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

/* One quad of the side, cut along its shorter diagonal; among equal ones (to ten in a million) the twist decides.
 * Where the slice above is a line, OpenSCAD takes the longer one. */
static void add_side(solid_builder *b, uint32_t below, uint32_t next_below, uint32_t above, uint32_t next_above,
                     double twist, bool to_line)
{
    double forwards = plane_distance(b, below, next_above), backwards = plane_distance(b, next_below, above);
    bool   equal = fabs(forwards - backwards) * 2e5 <= forwards + backwards;
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

static lmn_status extrude(polyhedron *out, const cap *c, const linear_extrusion *how, lmn_error *error)
{
    const double  scale[2] = {fmax(how->scale[0], 0), fmax(how->scale[1], 0)};
    const region *r = c->outline;
    double        slices = slice_count(r, how, scale);
    size_t        points = region_point_count(r);
    lmn_status    status = check_point_count("linear_extrude", (double)points * (slices + 1), error);
    if (status != LMN_OK)
        return status;
    bool          line = (scale[0] == 0) != (scale[1] == 0);
    int           last = (int)slices;
    solid_builder b = {0};
    for (int i = 0; i <= last; i++)
        add_slice(&b, r, how, scale, i == last ? 1 : (double)i / last);
    for (int i = 0; !b.failed && i < last; i++)
        add_sides(&b, r, (uint32_t)((size_t)i * points), (uint32_t)points, how->twist, line && i + 1 == last);
    add_caps(&b, c, (uint32_t)((size_t)last * points), 0);
    return builder_finish(&b, out, error);
}

lmn_status construct_linear_extrude(polyhedron *out, const region *r, const linear_extrusion *how, lmn_error *error)
{
    *out = (polyhedron){0};
    cap        c;
    lmn_status status =
        check_numbers("linear_extrude", (double[]){how->height, how->twist, how->scale[0], how->scale[1]}, 4, error);
    if (status == LMN_OK)
        status = check_region("linear_extrude", r, error);
    if (status != LMN_OK || !(how->height > 0) || r->count == 0)
        return status;
    status = make_cap(&c, r, "linear_extrude", error);
    if (status != LMN_OK)
        return status;
    status = extrude(out, &c, how, error);
    cap_release(&c);
    return status;
}

/* --- round the axis ------------------------------------------------------------------------------------- */

/* The region's points at this angle. Nearly on the axis is on it: there the ring is one position. */
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
static lmn_status turn(polyhedron *out, const cap *c, double angle, int pieces, double reach, lmn_error *error)
{
    bool          full = fabs(angle) >= 360;
    const region *r = c->outline;
    size_t        points = region_point_count(r);
    int           rings = full ? pieces : pieces + 1;
    solid_builder b = {0};
    for (int i = 0; i < rings; i++)
        add_ring(&b, r, (full ? 180 : 0) + (i == pieces ? angle : angle * i / pieces), reach);
    for (int i = 0; i < pieces; i++)
        add_turn(&b, r, (uint32_t)((size_t)i * points), (uint32_t)((size_t)((i + 1) % rings) * points));
    /* Seen along the turn, the region's plane shows its back. */
    if (!full)
        add_caps(&b, c, 0, (uint32_t)((size_t)pieces * points));
    return builder_finish(&b, out, error);
}

/* How far from the axis the region reaches; it must be on one side of it. */
static lmn_status measure_reach(const region *r, double *reach, lmn_error *error)
{
    double low[2] = {0, 0}, high[2] = {0, 0};
    region_bounds(r, low, high);
    *reach = fmax(-low[0], high[0]);
    if (!(low[0] < -1e-12 * *reach && high[0] > 1e-12 * *reach))
        return LMN_OK;
    error_set(error, LMN_FORMAT, "rotate_extrude: the outline lies on both sides of the axis, from x = %g to %g",
              low[0], high[0]);
    error_hint(error, "move it to one side, or intersect it with one half of the plane");
    return LMN_FORMAT;
}

lmn_status construct_rotate_extrude(polyhedron *out, const region *r, double angle_degrees, facets f, lmn_error *error)
{
    *out = (polyhedron){0};
    double     angle = fabs(angle_degrees) > 360 ? 360 : angle_degrees, reach = 0;
    cap        c;
    lmn_status status = check_numbers("rotate_extrude", &angle_degrees, 1, error);
    if (status == LMN_OK)
        status = check_region("rotate_extrude", r, error);
    if (status == LMN_OK)
        status = measure_reach(r, &reach, error);
    if (status != LMN_OK || angle == 0 || r->count == 0)
        return status;
    double pieces = fmax(floor(facets_of_circle(reach, f) * fabs(angle) / 360), 1);
    status = check_point_count("rotate_extrude", (double)region_point_count(r) * (pieces + 1), error);
    if (status == LMN_OK)
        status = make_cap(&c, r, "rotate_extrude", error);
    if (status != LMN_OK)
        return status;
    status = turn(out, &c, angle, (int)pieces, reach, error);
    cap_release(&c);
    return status;
}
