#include "api/solid_shape.h"

#include <math.h>
#include <string.h>

#include "api/complete.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "construct/construct.h"

enum { SLICES_MAX = 1000000 };

typedef struct shape_check {
    const lmn_shape *shape;
    const char      *caller;
    lmn_error       *error;
} shape_check;

const char *solid_shape_name(lmn_shape_kind kind)
{
    static const char *const names[] = {"", "box", "sphere", "cylinder", "polyhedron", "extrusion", "revolution"};
    return kind >= LMN_SHAPE_BOX && kind <= LMN_SHAPE_REVOLUTION ? names[kind] : "";
}

static lmn_status refuse(const shape_check *c, const char *what, double found, const char *hint)
{
    error_set(c->error, LMN_USAGE, "%s: the %s of the %s is %g", c->caller, what, solid_shape_name(c->shape->kind),
              found);
    error_hint(c->error, "%s", hint);
    return LMN_USAGE;
}

static lmn_status check_size(const shape_check *c, const char *what, double size)
{
    return isfinite(size) && size > 0 ? LMN_OK : refuse(c, what, size, "sizes are finite and above 0");
}

static lmn_status check_radii(const shape_check *c)
{
    const double radii[2] = {c->shape->radius, c->shape->top_radius};
    for (int i = 0; i < 2; i++)
        if (!(isfinite(radii[i]) && radii[i] >= 0))
            return refuse(c, i == 0 ? "radius" : "top_radius", radii[i],
                          "radii are finite and 0 or more; one of them is above 0");
    return radii[0] > 0 || radii[1] > 0 ? LMN_OK
                                        : refuse(c, "larger radius", 0, "one of radius and top_radius must be above 0");
}

static lmn_status check_facets(const shape_check *c)
{
    const lmn_facets *f = &c->shape->facets;
    if (!(isfinite(f->fn) && f->fn >= 0))
        return refuse(c, "facets.fn", f->fn, "it is finite and 0 or more");
    if (!(isfinite(f->fa) && f->fa > 0))
        return refuse(c, "facets.fa", f->fa, "it is finite and above 0; 12 is the default");
    if (!(isfinite(f->fs) && f->fs > 0))
        return refuse(c, "facets.fs", f->fs, "it is finite and above 0; 2 is the default");
    return LMN_OK;
}

static facets facets_of(const lmn_shape *shape)
{
    return (facets){shape->facets.fn, shape->facets.fa, shape->facets.fs};
}

/* --- plain ones ----------------------------------------------------------------------------------------- */

static lmn_status make_box(const shape_check *c, polyhedron *out)
{
    static const char *const names[3] = {"size in x", "size in y", "size in z"};
    lmn_status               status = LMN_OK;
    for (int i = 0; i < 3 && status == LMN_OK; i++)
        status = check_size(c, names[i], c->shape->size[i]);
    return status == LMN_OK ? construct_cube(out, c->shape->size, c->shape->centred, c->error) : status;
}

static lmn_status make_sphere(const shape_check *c, polyhedron *out)
{
    lmn_status status = check_size(c, "radius", c->shape->radius);
    if (status == LMN_OK)
        status = check_facets(c);
    return status == LMN_OK ? construct_sphere(out, c->shape->radius, facets_of(c->shape), c->error) : status;
}

static lmn_status make_cylinder(const shape_check *c, polyhedron *out)
{
    const lmn_shape *s = c->shape;
    lmn_status       status = check_size(c, "height", s->height);
    if (status == LMN_OK)
        status = check_radii(c);
    if (status == LMN_OK)
        status = check_facets(c);
    return status == LMN_OK
               ? construct_cylinder(out, s->height, s->radius, s->top_radius, s->centred, facets_of(s), c->error)
               : status;
}

/* --- polyhedra ------------------------------------------------------------------------------------------ */

static lmn_status wrong(const shape_check *c, const char *what, const char *hint)
{
    error_set(c->error, LMN_USAGE, "%s: %s", c->caller, what);
    error_hint(c->error, "%s", hint);
    return LMN_USAGE;
}

/* Numbers of corners below 3, and their sum. */
static lmn_status check_counts(const shape_check *c, const uint32_t *sizes, size_t count, const char *what, size_t *sum)
{
    *sum = 0;
    for (size_t i = 0; i < count; i++) {
        if (sizes[i] < 3)
            return wrong(c, what, "each has 3 points or more");
        *sum += sizes[i];
    }
    return LMN_OK;
}

static lmn_status too_many(const shape_check *c, size_t count)
{
    return error_set(c->error, LMN_LIMIT, "%s: %zu points are more than the %zu that one shape may have", c->caller,
                     count, LIMIT_SHAPE_POINTS);
}

static lmn_status check_faces(const shape_check *c)
{
    const lmn_shape *s = c->shape;
    size_t           total = 0;
    if (!s->points || !s->corners || !s->face_sizes || s->face_count < 4)
        return wrong(c, "the polyhedron has no points, or fewer than 4 faces",
                     "give points, corners, and face_sizes of all faces");
    if (s->point_count > LIMIT_SHAPE_POINTS || s->face_count > LIMIT_SHAPE_POINTS)
        return too_many(c, s->point_count > s->face_count ? s->point_count : s->face_count);
    lmn_status status =
        check_counts(c, s->face_sizes, s->face_count, "a face of the polyhedron has fewer than 3 corners", &total);
    if (status == LMN_OK && total > LIMIT_SHAPE_POINTS)
        status = too_many(c, total);
    for (size_t i = 0; i < total && status == LMN_OK; i++)
        if (s->corners[i] >= s->point_count) {
            status = error_set(c->error, LMN_USAGE, "%s: a face of the polyhedron has point %u, there are %zu",
                               c->caller, (unsigned)s->corners[i], s->point_count);
            error_hint(c->error, "points are numbered from 0 on");
        }
    for (size_t i = 0; i < s->point_count && status == LMN_OK; i++)
        for (int k = 0; k < 3 && status == LMN_OK; k++)
            if (!isfinite(s->points[i][k]))
                status = refuse(c, "coordinate of a point", s->points[i][k], "coordinates are finite");
    return status;
}

static lmn_status make_polyhedron(const shape_check *c, polyhedron *out)
{
    const lmn_shape *s = c->shape;
    lmn_status       status = check_faces(c);
    point3          *points = status == LMN_OK ? mem_alloc(s->point_count * sizeof *points) : NULL;
    if (status != LMN_OK)
        return status;
    if (!points)
        return error_memory(c->error);
    for (size_t i = 0; i < s->point_count; i++)
        points[i] = (point3){s->points[i][0], s->points[i][1], s->points[i][2]};
    bool flawed = false;
    status =
        construct_polyhedron(out, points, s->point_count, s->corners, s->face_sizes, s->face_count, &flawed, c->error);
    mem_free(points);
    if (status == LMN_OK && flawed)
        status = wrong(c, "the polyhedron is not closed, or its faces do not run the same way round",
                       "each edge belongs to two faces, which pass it in opposite directions");
    return status;
}

/* --- from profiles -------------------------------------------------------------------------------------- */

static lmn_status check_profile(const shape_check *c, const uint32_t *sizes, size_t count)
{
    const lmn_shape *s = c->shape;
    size_t           total = 0;
    if (!s->profile || s->profile_count < 3)
        return wrong(c, "the profile has fewer than 3 points", "give profile and profile_count");
    if (s->profile_count > LIMIT_SHAPE_POINTS || count > LIMIT_SHAPE_POINTS)
        return too_many(c, s->profile_count > count ? s->profile_count : count);
    lmn_status status = check_counts(c, sizes, count, "a contour of the profile has fewer than 3 points", &total);
    if (status == LMN_OK && total != s->profile_count) {
        status = error_set(c->error, LMN_USAGE, "%s: the contours have %zu points, the profile has %zu", c->caller,
                           total, s->profile_count);
        error_hint(c->error, "contour_sizes add up to profile_count");
    }
    for (size_t i = 0; i < s->profile_count && status == LMN_OK; i++)
        for (int k = 0; k < 2 && status == LMN_OK; k++)
            if (!isfinite(s->profile[i][k]))
                status = refuse(c, "coordinate of a point", s->profile[i][k], "coordinates are finite");
    return status;
}

static lmn_status make_profile(const shape_check *c, region *out)
{
    const lmn_shape *s = c->shape;
    const uint32_t   whole = (uint32_t)s->profile_count, *sizes = s->contour_sizes ? s->contour_sizes : &whole;
    size_t           count = s->contour_sizes ? s->contour_count : 1;
    lmn_status       status = check_profile(c, sizes, count);
    if (status != LMN_OK)
        return status;
    point2   *points = mem_alloc(s->profile_count * sizeof *points);
    uint32_t *corners = mem_alloc(s->profile_count * sizeof *corners);
    for (uint32_t i = 0; i < s->profile_count && points && corners; i++) {
        points[i] = (point2){s->profile[i][0], s->profile[i][1]};
        corners[i] = i;
    }
    status = points && corners ? construct_polygon(out, points, s->profile_count, corners, sizes, count, c->error)
                               : error_memory(c->error);
    mem_free(points);
    mem_free(corners);
    if (status == LMN_OK && out->count == 0)
        status = wrong(c, "the profile has no area", "its contours must enclose something");
    return status;
}

static lmn_status make_extrusion(const shape_check *c, polyhedron *out)
{
    const lmn_shape *s = c->shape;
    linear_extrusion how = {.height = s->height,
                            .twist = s->twist,
                            .scale = {s->scale[0], s->scale[1]},
                            .centre = s->centred,
                            .has_slices = s->slices > 0,
                            .slices = (int)(s->slices < SLICES_MAX ? s->slices : SLICES_MAX),
                            .facets = facets_of(s)};
    lmn_status       status = check_size(c, "height", s->height);
    if (status == LMN_OK)
        status = check_facets(c);
    if (status == LMN_OK && !isfinite(s->twist))
        status = refuse(c, "twist", s->twist, "it is finite");
    for (int i = 0; i < 2 && status == LMN_OK; i++)
        if (!(isfinite(s->scale[i]) && s->scale[i] >= 0))
            status = refuse(c, "scale", s->scale[i], "it is finite and 0 or more; 1 is the default");
    if (status == LMN_OK && s->slices > SLICES_MAX)
        status = refuse(c, "number of slices", s->slices, "it is at most 1 000 000; 0 chooses by twist and facets");
    region profile = {0};
    if (status == LMN_OK)
        status = make_profile(c, &profile);
    if (status == LMN_OK)
        status = construct_linear_extrude(out, &profile, &how, c->error);
    region_release(&profile);
    return status;
}

static lmn_status make_revolution(const shape_check *c, polyhedron *out)
{
    const lmn_shape *s = c->shape;
    lmn_status       status = check_facets(c);
    if (status == LMN_OK && !(isfinite(s->angle) && s->angle != 0 && fabs(s->angle) <= 360))
        status = refuse(c, "angle", s->angle, "it is -360 to 360 degrees and not 0");
    region profile = {0};
    if (status == LMN_OK)
        status = make_profile(c, &profile);
    if (status == LMN_OK)
        status = construct_rotate_extrude(out, &profile, s->angle, facets_of(s), c->error);
    region_release(&profile);
    return status;
}

/* --- all ------------------------------------------------------------------------------------------------ */

static lmn_status make_any(const shape_check *c, polyhedron *out)
{
    switch (c->shape->kind) {
    case LMN_SHAPE_BOX: return make_box(c, out);
    case LMN_SHAPE_SPHERE: return make_sphere(c, out);
    case LMN_SHAPE_CYLINDER: return make_cylinder(c, out);
    case LMN_SHAPE_POLYHEDRON: return make_polyhedron(c, out);
    case LMN_SHAPE_EXTRUSION: return make_extrusion(c, out);
    case LMN_SHAPE_REVOLUTION: return make_revolution(c, out);
    }
    error_set(c->error, LMN_USAGE, "%s: %d is no kind of shape", c->caller, (int)c->shape->kind);
    error_hint(c->error, "make shapes with lmn_shape_box, lmn_shape_sphere and so on");
    return LMN_USAGE;
}

/* A caller built against an older header hands over a shorter shape; what it lacks keeps its default. */
static lmn_status complete(lmn_shape *full, const lmn_shape *given, const char *caller, lmn_error *error)
{
    if (!given)
        return error_set(error, LMN_USAGE, "%s: `shape` is NULL", caller);
    if (given->struct_size < offsetof(lmn_shape, centred)) {
        error_set(error, LMN_USAGE, "%s: the shape's struct_size is not set", caller);
        error_hint(error, "make shapes with lmn_shape_box, lmn_shape_sphere and so on");
        return LMN_USAGE;
    }
    *full = lmn_shape_of(given->kind);
    return desc_complete(full, sizeof *full, given, "lmn_shape_of", error);
}

lmn_status solid_shape_make(mesh *out, const lmn_shape *shape, const char *caller, lmn_error *error)
{
    lmn_shape   full;
    lmn_error   own = {0};
    shape_check c = {&full, caller, &own};
    polyhedron  made = {0};
    *out = (mesh){.name = NULL};
    lmn_status status = complete(&full, shape, caller, &own);
    if (status == LMN_OK)
        status = make_any(&c, &made);
    /* To those who made the numbers up, wrong ones are no fault of a file. */
    if (status == LMN_FORMAT)
        status = own.status = LMN_USAGE;
    if (status == LMN_OK && !polyhedron_into_mesh(out, &made))
        status = error_memory(&own);
    if (status == LMN_OK && mesh_triangle_count(out) == 0)
        status = wrong(&c, "the shape has no volume in single precision",
                       "choose larger sizes, and a matrix to make it smaller");
    polyhedron_release(&made);
    if (status == LMN_OK)
        return LMN_OK;
    mesh_release(out);
    if (error)
        *error = own;
    return status;
}
