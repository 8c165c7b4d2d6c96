/* From a pair of faces that turn a little, a cylinder grows over all faces around whose corners lie on it; it is
 * fitted to them, closer each time. Regions on one axis are one cylinder then, if they go round more than half of it.
 * From patches of what is left then, cones grow in the same way. */
#include "draft/cylinders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "draft/cylinder_fit.h"
#include "draft/faces.h"
#include "stroke/solid.h"

enum { CYLINDER = 1, CONE };
enum { BINS = 720, PATCH_MOST = 12, TRIES = 3, FAILED_MOST = 4, GROWN_MOST = 32 };
static const double pi = 3.14159265358979323846;
static const double turn_same = 0.05;    /* of a turn: what may be off of two steps of one cone */
static const double flat_turn = 1e-3;    /* radians: what turns less is one plane in two triangles */
static const double leaning_most = 0.25; /* cosine between the normal of a face and the axis */
static const double bent_most = 0.01;    /* the same for the line from a cone's tip: of domes it is no line */
static const double round_least = 0.9;   /* cosine between it and the radius there: half of what a step turns */
static const double tolerances[TRIES] = {1e-2, 2e-3, 3e-4}; /* of the radius, from round to round */
static const double tip_most = 1e-3;                        /* of the other corners' radius: this one is the tip */
static const double arc_least = 0.8;                        /* radians: shorter regions say too little of their axis */
static const double same_axis = 2e-3;                       /* of regions that may be one: radii, radians */
static const double ring_most = 1.6; /* a ring no higher than so many of the ones beside it belongs to a bulge */

/* A region of one cylinder, in the axes of its mesh. */
typedef struct region {
    cylinder_fit fit;
    double       low, high; /* along the axis, from fit.centre */
    bool         hollow;
    uint8_t      bins[BINS / 8]; /* of the circle: which parts of it there are */
} region;

typedef struct finder {
    const edge_mesh *mesh;
    draft_faces      faces;
    uint8_t         *taken;     /* per face: what it is part of */
    uint8_t         *failed_at; /* per face: how many growths it was in that came to nothing; so work stays in bounds */
    uint8_t  *grown_at; /* per face: how many first growths it was in; on a ball they are wide, the last ones small */
    uint32_t *mark;     /* per face: of the growth at hand */
    uint32_t  turn;
    uint32_t *region; /* faces of it */
    size_t    region_count;
    double (*points)[3];
    size_t         point_count;
    region        *found;
    size_t         found_count, found_capacity;
    solid_trimmer *trimmer; /* of a solid */
    double         near;    /* what positions are exact to */
    bool           cones;   /* those are looked for, not cylinders */
    bool           failed;
} finder;

static void corner_of(const finder *f, uint32_t face, int k, double out[3])
{
    vec3 p = f->mesh->positions[f->mesh->faces[face][k]];
    vector3_set(out, (double)p.x, (double)p.y, (double)p.z);
}

/* --- growing -------------------------------------------------------------------------------------------- */

static void radius_at(const cylinder_fit *c, const double p[3], double out[3])
{
    double d[3];
    vector3_add(d, p, -1, c->centre);
    vector3_add(out, d, -vector3_dot(d, c->axis), c->axis);
    vector3_normalise(out);
}

/* Do all corners lie on it, and does the face look along the radius, to the side that `sign` says? */
static bool lies_on(const finder *f, const cylinder_fit *c, uint32_t face, double tolerance, double sign)
{
    const double *normal = f->faces.normals[face];
    double        most = tolerance * c->radius + f->near, middle[3] = {0}, radius[3], along;
    if (c->slope == 0 && fabs(vector3_dot(normal, c->axis)) > leaning_most)
        return false;
    for (int k = 0; k < 3; k++) {
        double p[3];
        corner_of(f, face, k, p);
        double away = cylinder_distance(c, p, NULL, &along);
        if (!(fabs(away - cylinder_radius(c, along)) <= most * sqrt(1 + c->slope * c->slope)))
            return false;
        vector3_add(middle, middle, 1.0 / 3, p);
    }
    radius_at(c, middle, radius);
    double along_it = vector3_dot(normal, c->axis) + c->slope * vector3_dot(normal, radius);
    if (c->slope != 0 && fabs(along_it) > bent_most * sqrt(1 + c->slope * c->slope))
        return false;
    vector3_add(radius, radius, -c->slope, c->axis);
    vector3_normalise(radius);
    return sign * vector3_dot(normal, radius) > round_least;
}

static double side_of(const finder *f, const cylinder_fit *c, uint32_t face)
{
    double p[3], radius[3], middle[3] = {0};
    for (int k = 0; k < 3; k++) {
        corner_of(f, face, k, p);
        vector3_add(middle, middle, 1.0 / 3, p);
    }
    radius_at(c, middle, radius);
    return vector3_dot(f->faces.normals[face], radius) > 0 ? 1 : -1;
}

static void put_corners(finder *f)
{
    f->point_count = 0;
    for (size_t i = 0; i < f->region_count; i++)
        for (int k = 0; k < 3; k++)
            corner_of(f, f->region[i], k, f->points[f->point_count++]);
}

static void begin_region(finder *f)
{
    f->turn++;
    f->region_count = 0;
}

static void add_to_region(finder *f, uint32_t face)
{
    f->mark[face] = f->turn;
    f->region[f->region_count++] = face;
}

/* Collects the faces around `seed` that lie on the cylinder. */
static void grow(finder *f, const cylinder_fit *c, uint32_t seed, double tolerance)
{
    double sign = side_of(f, c, seed);
    begin_region(f);
    if (!lies_on(f, c, seed, tolerance, sign))
        return;
    add_to_region(f, seed);
    for (size_t i = 0; i < f->region_count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t other = draft_faces_beside(&f->faces, f->region[i], k);
            if (other == EDGE_NO_FACE || f->mark[other] == f->turn || f->taken[other])
                continue;
            if (lies_on(f, c, other, tolerance, sign)) {
                add_to_region(f, other);
            }
        }
    put_corners(f);
}

/* The faces nearest to a seed, as many as say where an axis is. */
static void take_patch(finder *f, uint32_t seed, const double *axis)
{
    begin_region(f);
    add_to_region(f, seed);
    for (size_t i = 0; i < f->region_count; i++)
        for (int k = 0; k < 3 && f->region_count < PATCH_MOST; k++) {
            uint32_t other = draft_faces_beside(&f->faces, f->region[i], k);
            if (other == EDGE_NO_FACE || f->mark[other] == f->turn || f->taken[other] ||
                (axis && fabs(vector3_dot(f->faces.normals[other], axis)) > leaning_most))
                continue;
            add_to_region(f, other);
        }
    put_corners(f);
}

/* The cylinder that two faces beside an edge along its axis would be of. */
static bool start_at_edge(finder *f, cylinder_fit *c, uint32_t seed, uint32_t other, int corner)
{
    double a[3], b[3], points[4][3];
    corner_of(f, seed, corner, a);
    corner_of(f, seed, (corner + 1) % 3, b);
    vector3_add(c->axis, b, -1, a);
    if (!vector3_normalise(c->axis))
        return false;
    corner_of(f, seed, (corner + 2) % 3, points[0]);
    vector3_copy(points[1], a);
    vector3_copy(points[2], b);
    for (int k = 0; k < 3; k++)
        if (f->mesh->faces[other][k] != f->mesh->faces[seed][corner] &&
            f->mesh->faces[other][k] != f->mesh->faces[seed][(corner + 1) % 3])
            corner_of(f, other, k, points[3]);
    return cylinder_start(c, (const double(*)[3])points, 4);
}

/* Where no edge runs along the axis: from how the faces around are turned. */
static bool start_at_patch(finder *f, cylinder_fit *c, uint32_t seed)
{
    double normals[PATCH_MOST][3];
    take_patch(f, seed, NULL);
    for (size_t i = 0; i < f->region_count; i++)
        vector3_copy(normals[i], f->faces.normals[f->region[i]]);
    cylinder_axis_of_normals(c->axis, (const double(*)[3])normals, f->region_count);
    take_patch(f, seed, c->axis);
    return f->region_count >= 4 && cylinder_start(c, (const double(*)[3])f->points, f->point_count);
}

/* Around a seed, over edges that turn by as much as one of its own or not at all: the sides of a cone all do. */
static bool start_cone(finder *f, cylinder_fit *c, uint32_t seed, double turn)
{
    double normals[PATCH_MOST][3];
    begin_region(f);
    add_to_region(f, seed);
    for (size_t i = 0; i < f->region_count; i++)
        for (int k = 0; k < 3 && f->region_count < PATCH_MOST; k++) {
            uint32_t face = f->region[i], other = draft_faces_beside(&f->faces, face, k);
            if (other == EDGE_NO_FACE || f->mark[other] == f->turn || f->taken[other])
                continue;
            double own = draft_faces_turn(&f->faces, face, other);
            if (own >= flat_turn && fabs(own - turn) > turn_same * turn)
                continue;
            add_to_region(f, other);
        }
    put_corners(f);
    for (size_t i = 0; i < f->region_count; i++)
        vector3_copy(normals[i], f->faces.normals[f->region[i]]);
    return cone_start(c, (const double(*)[3])normals, f->region_count, (const double(*)[3])f->points, f->point_count);
}

/* --- what was found ------------------------------------------------------------------------------------- */

static double angle_between(double a, double b)
{
    return remainder(b - a, 2 * pi);
}

static void set_bins(region *r, double from, double to)
{
    double turned = angle_between(from, to), begin = turned >= 0 ? from : to;
    double scale = BINS / (2 * pi), first = (begin + pi) * scale, last = first + fabs(turned) * scale;
    for (long i = (long)floor(first + 1e-3); (double)i < last - 1e-3; i++) {
        long at = (i % BINS + BINS) % BINS;
        r->bins[at / 8] |= (uint8_t)(1 << at % 8);
    }
}

static double sweep_of(const region *r)
{
    int count = 0;
    for (int i = 0; i < BINS; i++)
        count += r->bins[i / 8] >> i % 8 & 1;
    return 2 * pi * count / BINS;
}

static void take_angles(region *r, const double angles[3])
{
    for (int k = 0; k < 3; k++)
        set_bins(r, angles[k], angles[(k + 1) % 3]);
}

static void reach(region *r, double along)
{
    r->low = fmin(r->low, along);
    r->high = fmax(r->high, along);
}

/* The line through the middle of a face that runs along the axis, of a cone to its tip, from edge to edge of it;
 * `ends`: where that is along the axis. */
static bool line_across(const finder *f, const cylinder_fit *c, uint32_t face, double lines[2][3], double ends[2])
{
    double        p[3][3], middle[3] = {0}, radius[3], way[3], across[3];
    const double *normal = f->faces.normals[face];
    int           count = 0;
    for (int k = 0; k < 3; k++) {
        corner_of(f, face, k, p[k]);
        vector3_add(middle, middle, 1.0 / 3, p[k]);
    }
    radius_at(c, middle, radius);
    double lean = c->slope == 0 ? 0 : -vector3_dot(normal, c->axis) / vector3_dot(normal, radius);
    vector3_add(way, c->axis, lean, radius);
    vector3_cross(across, normal, way);
    for (int k = 0; k < 3 && count < 2; k++) {
        double to[2][3], sides[2];
        for (int n = 0; n < 2; n++) {
            vector3_add(to[n], p[(k + n) % 3], -1, middle);
            sides[n] = vector3_dot(to[n], across);
        }
        if ((sides[0] < 0) == (sides[1] < 0))
            continue;
        vector3_mix(lines[count], p[k], p[(k + 1) % 3], sides[0] / (sides[0] - sides[1]));
        cylinder_distance(c, lines[count], NULL, &ends[count]);
        count++;
    }
    return count == 2;
}

/* Around and along of a face's corners. The tip of a cone is anywhere around: in the middle of the other two. */
static void around_and_along(const finder *f, const cylinder_fit *c, uint32_t face, double angles[3], double along[3])
{
    double away[3];
    for (int k = 0; k < 3; k++) {
        double p[3];
        corner_of(f, face, k, p);
        away[k] = cylinder_distance(c, p, &angles[k], &along[k]);
    }
    for (int k = 0; k < 3; k++)
        if (away[k] < tip_most * fmax(away[(k + 1) % 3], away[(k + 2) % 3]))
            angles[k] = angles[(k + 1) % 3] + angle_between(angles[(k + 1) % 3], angles[(k + 2) % 3]) / 2;
}

/* Of a face of a solid: as much of it as bounds that. */
static void take_bounding(finder *f, region *r, uint32_t face, const double angles[3])
{
    double             ends[2], lines[2][3];
    const solid_share *shares;
    size_t             count;
    if (!line_across(f, &r->fit, face, lines, ends))
        return;
    if (!solid_trim(f->trimmer, face, lines[0], lines[1], &shares, &count)) {
        f->failed = true;
        return;
    }
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++)
            reach(r, ends[0] + (k ? shares[i].to : shares[i].from) * (ends[1] - ends[0]));
    if (count)
        take_angles(r, angles);
}

static void measure(finder *f, region *r)
{
    r->low = INFINITY;
    r->high = -INFINITY;
    for (size_t i = 0; i < f->region_count && !f->failed; i++) {
        double angles[3], along[3];
        around_and_along(f, &r->fit, f->region[i], angles, along);
        if (f->trimmer) {
            take_bounding(f, r, f->region[i], angles);
            continue;
        }
        take_angles(r, angles);
        for (int k = 0; k < 3; k++)
            reach(r, along[k]);
    }
}

/* Is it a ring of what bends along the axis, too, as a ball's equator is? Then it goes on smoothly on both sides, in
 * rings of about its own height; a cone on one of them, if not into a cylinder, since a ball's last ring has a tip. */
static bool is_of_bulge(const finder *f, const region *r)
{
    const bool cone = r->fit.slope != 0;
    double     beside[2] = {0, 0}, middle = (r->low + r->high) / 2;
    double     length = (r->high - r->low) * sqrt(1 + r->fit.slope * r->fit.slope);
    for (size_t i = 0; i < f->region_count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t face = f->region[i], other = draft_faces_beside(&f->faces, face, k);
            double   a[3], b[3], at, most = 0;
            if (other == EDGE_NO_FACE || f->mark[other] == f->turn ||
                draft_faces_turn(&f->faces, face, other) < flat_turn || (cone && f->taken[other] == CYLINDER))
                continue;
            corner_of(f, face, k, a);
            corner_of(f, face, (k + 1) % 3, b);
            vector3_mix(a, a, b, 0.5);
            double away = cylinder_distance(&r->fit, a, NULL, &at);
            for (int n = 0; n < 3; n++) {
                double t;
                corner_of(f, other, n, b);
                double out = cylinder_distance(&r->fit, b, NULL, &t);
                most = fmax(most, cone ? hypot(t - at, out - away) : fabs(t - at));
            }
            beside[at > middle] = fmax(beside[at > middle], most);
        }
    if (cone)
        return length < ring_most * fmax(beside[0], beside[1]);
    return beside[0] > 0 && beside[1] > 0 && r->high - r->low < ring_most * fmax(beside[0], beside[1]);
}

static void keep(finder *f, const cylinder_fit *c, uint32_t seed)
{
    region r = {.fit = *c, .hollow = side_of(f, c, seed) < 0};
    for (size_t i = 0; i < f->region_count; i++)
        f->taken[f->region[i]] = f->cones ? CONE : CYLINDER;
    measure(f, &r);
    if (f->failed || !(r.high > r.low) || is_of_bulge(f, &r))
        return;
    if (!mem_grow((void **)&f->found, &f->found_capacity, f->found_count + 1, sizeof *f->found)) {
        f->failed = true;
        return;
    }
    f->found[f->found_count++] = r;
}

/* How much of the circle the faces of the growth go round. */
static double arc_of_growth(finder *f, const cylinder_fit *c)
{
    region whole = {.fit = *c};
    for (size_t i = 0; i < f->region_count; i++) {
        double angles[3], along[3];
        around_and_along(f, c, f->region[i], angles, along);
        take_angles(&whole, angles);
    }
    return sweep_of(&whole);
}

static void grow_first(finder *f, const cylinder_fit *c, uint32_t seed)
{
    grow(f, c, seed, tolerances[0]);
    for (size_t i = 0; i < f->region_count; i++)
        if (f->grown_at[f->region[i]] < GROWN_MOST)
            f->grown_at[f->region[i]]++;
}

static bool settle(finder *f, cylinder_fit *c, uint32_t seed)
{
    for (int i = 0; i < TRIES; i++) {
        if (i == 0)
            grow_first(f, c, seed);
        else
            grow(f, c, seed, tolerances[i]);
        if (f->region_count < 3 || arc_of_growth(f, c) < arc_least ||
            !cylinder_refine(c, (const double(*)[3])f->points, f->point_count))
            return false;
    }
    grow(f, c, seed, tolerances[TRIES - 1]);
    return f->region_count >= 3 && arc_of_growth(f, c) >= arc_least;
}

static void fail_at(finder *f, uint32_t face)
{
    if (f->failed_at[face] < FAILED_MOST)
        f->failed_at[face]++;
}

static bool try_from(finder *f, cylinder_fit *c, uint32_t seed)
{
    if (!settle(f, c, seed)) {
        for (size_t i = 0; i < f->region_count; i++)
            fail_at(f, f->region[i]);
        fail_at(f, seed);
        return false;
    }
    keep(f, c, seed);
    return true;
}

static void search_cone(finder *f, uint32_t face)
{
    cylinder_fit c = {.slope = 0};
    for (int k = 0; k < 3; k++) {
        uint32_t other = draft_faces_beside(&f->faces, face, k);
        double   turn = other == EDGE_NO_FACE ? 0 : draft_faces_turn(&f->faces, face, other);
        if (turn >= flat_turn && !f->taken[other] && start_cone(f, &c, face, turn) && try_from(f, &c, face))
            return;
    }
}

static void search(finder *f, uint32_t face)
{
    cylinder_fit c = {.slope = 0};
    bool         turns = false;
    for (int k = 0; k < 3; k++) {
        uint32_t other = draft_faces_beside(&f->faces, face, k);
        if (other == EDGE_NO_FACE || f->taken[other] || draft_faces_turn(&f->faces, face, other) < flat_turn)
            continue;
        turns = true;
        if (start_at_edge(f, &c, face, other, k) && try_from(f, &c, face))
            return;
    }
    if (turns && start_at_patch(f, &c, face))
        try_from(f, &c, face);
}

/* --- regions on one axis -------------------------------------------------------------------------------- */

static bool are_one(const region *a, const region *b)
{
    double along, apart;
    apart = cylinder_distance(&a->fit, b->fit.centre, NULL, &along);
    if (a->hollow != b->hollow ||
        fabs(cylinder_radius(&a->fit, along) - b->fit.radius) > same_axis * fmin(a->fit.radius, b->fit.radius) ||
        fabs(vector3_dot(a->fit.axis, b->fit.axis)) < cos(same_axis))
        return false;
    double way = vector3_dot(b->fit.axis, a->fit.axis), ends[2] = {along + way * b->low, along + way * b->high};
    double low = fmin(ends[0], ends[1]), high = fmax(ends[0], ends[1]);
    if (fabs(a->fit.slope - (way < 0 ? -1 : 1) * b->fit.slope) > same_axis)
        return false;
    double common = fmin(high, a->high) - fmax(low, a->low), shorter = fmin(high - low, a->high - a->low);
    return apart < same_axis * a->fit.radius && common > 0.5 * shorter;
}

/* What another region has of the circle, counted around the axis of this one. */
static void join(region *a, const region *b)
{
    for (int i = 0; i < BINS; i++) {
        double angle = 2 * pi * (i + 0.5) / BINS - pi, p[3], at, along;
        if (!(b->bins[i / 8] >> i % 8 & 1))
            continue;
        vector3_add(p, b->fit.centre, b->fit.radius * cos(angle), b->fit.across[0]);
        vector3_add(p, p, b->fit.radius * sin(angle), b->fit.across[1]);
        cylinder_distance(&a->fit, p, &at, &along);
        long bin = (long)floor((at + pi) / (2 * pi) * BINS) % BINS;
        a->bins[bin / 8] |= (uint8_t)(1 << bin % 8);
    }
    for (int k = 0; k < 2; k++) {
        double p[3], along;
        vector3_add(p, b->fit.centre, k ? b->high : b->low, b->fit.axis);
        cylinder_distance(&a->fit, p, NULL, &along);
        reach(a, along);
    }
}

static void join_regions(finder *f)
{
    for (size_t i = 0; i < f->found_count; i++)
        for (size_t k = i + 1; k < f->found_count;)
            if (sweep_of(&f->found[i]) < 2 * pi * 0.98 && are_one(&f->found[i], &f->found[k])) {
                join(&f->found[i], &f->found[k]);
                f->found[k] = f->found[--f->found_count];
                k = i + 1;
            } else {
                k++;
            }
}

/* --- the scene ------------------------------------------------------------------------------------------ */

static lmn_status find_in_mesh(finder *f, const edge_mesh *m, lmn_error *error)
{
    double size = 0;
    *f = (finder){.mesh = m};
    for (uint32_t i = 0; i < m->vertex_count; i++)
        size = fmax(size, fmax(fabs((double)m->positions[i].x),
                               fmax(fabs((double)m->positions[i].y), fabs((double)m->positions[i].z))));
    f->near = 2e-7 * size;
    f->taken = mem_calloc((size_t)m->face_count + 1, 1);
    f->failed_at = mem_calloc((size_t)m->face_count + 1, 1);
    f->grown_at = mem_calloc((size_t)m->face_count + 1, 1);
    f->mark = mem_calloc((size_t)m->face_count + 1, sizeof *f->mark);
    f->region = mem_alloc(((size_t)m->face_count + PATCH_MOST) * sizeof *f->region);
    f->points = mem_alloc(((size_t)m->face_count + PATCH_MOST) * 3 * sizeof *f->points);
    f->trimmer = m->solid ? solid_trimmer_create(m->solid) : NULL;
    f->failed =
        !f->taken || !f->failed_at || !f->grown_at || !f->mark || !f->region || !f->points || (m->solid && !f->trimmer);
    if (f->failed || draft_faces_make(&f->faces, m, error) != LMN_OK)
        return error_memory(error);
    for (int kind = 0; kind < 2; kind++) {
        f->cones = kind == 1;
        memset(f->failed_at, 0, m->face_count);
        memset(f->grown_at, 0, m->face_count);
        for (uint32_t i = 0; i < m->face_count && !f->failed; i++) {
            if (i % 1024 == 0 && work_stopped())
                return error_memory(error);
            if (!f->taken[i] && f->failed_at[i] < FAILED_MOST && f->grown_at[i] < GROWN_MOST)
                f->cones ? search_cone(f, i) : search(f, i);
        }
    }
    join_regions(f);
    return f->failed ? error_memory(error) : LMN_OK;
}

static void release(finder *f)
{
    draft_faces_release(&f->faces);
    solid_trimmer_destroy(&f->trimmer);
    mem_free(f->taken);
    mem_free(f->failed_at);
    mem_free(f->grown_at);
    mem_free(f->mark);
    mem_free(f->region);
    mem_free(f->points);
    mem_free(f->found);
}

/* By how much a matrix enlarges; 0: not the same in all directions, so that circles become ellipses. */
static double growth_of(const mat4 *m)
{
    double lengths[3];
    for (int k = 0; k < 3; k++)
        lengths[k] = vector3_length(&m->m[4 * k]);
    for (int k = 0; k < 3; k++) {
        const double *a = &m->m[4 * k], *b = &m->m[4 * ((k + 1) % 3)];
        if (fabs(lengths[k] - lengths[0]) > 1e-5 * lengths[0] ||
            fabs(vector3_dot(a, b)) > 1e-5 * lengths[0] * lengths[0])
            return 0;
    }
    return lengths[0];
}

static void to_world(double out[3], const mat4 *m, const double p[3], double place)
{
    for (int row = 0; row < 3; row++)
        out[row] = m->m[row] * p[0] + m->m[4 + row] * p[1] + m->m[8 + row] * p[2] + place * m->m[12 + row];
}

static bool put_cylinder(draft_cylinders *out, const stroke_item *item, const region *r)
{
    double         grown = growth_of(&item->world), sweep = sweep_of(r);
    double         low = fmax(cylinder_radius(&r->fit, r->low), 0), high = fmax(cylinder_radius(&r->fit, r->high), 0);
    draft_cylinder c = {.part = item->part_index + 1,
                        .radius = fmax(low, high) * grown,
                        .radii = {low * grown, high * grown},
                        .cone = r->fit.slope != 0,
                        .sweep = sweep,
                        .hollow = r->hollow};
    if (!(grown > 0) || sweep < DRAFT_SWEEP_LEAST)
        return true;
    to_world(c.axis, &item->world, r->fit.axis, 0);
    if (!vector3_normalise(c.axis))
        return true;
    for (int k = 0; k < 2; k++) {
        double p[3];
        vector3_add(p, r->fit.centre, k ? r->high : r->low, r->fit.axis);
        to_world(c.ends[k], &item->world, p, 1);
    }
    if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
        return false;
    out->items[out->count++] = c;
    return true;
}

lmn_status draft_cylinders_find(draft_cylinders *out, const stroke_scene *scene, lmn_error *error)
{
    lmn_status status = LMN_OK;
    *out = (draft_cylinders){NULL, 0, 0};
    for (size_t mesh = 0; mesh < scene->mesh_count && status == LMN_OK; mesh++) {
        finder f;
        status = find_in_mesh(&f, &scene->meshes[mesh], error);
        for (size_t i = 0; i < scene->item_count && status == LMN_OK; i++)
            for (size_t k = 0; k < f.found_count && scene->items[i].mesh == mesh && status == LMN_OK; k++)
                if (!put_cylinder(out, &scene->items[i], &f.found[k]))
                    status = error_memory(error);
        release(&f);
    }
    return status;
}

void draft_cylinders_release(draft_cylinders *c)
{
    mem_free(c->items);
    *c = (draft_cylinders){NULL, 0, 0};
}
