/* How dark lines get along flat faces: nothing bends there, so light alone makes one even field of them, and whoever
 * draws has them fade from one side to the other. A flat face is what hangs together in one plane. */
#include <math.h>

#include "base/groups.h"
#include "base/memory.h"
#include "marks/streamlines.h"

static const double FLAT = 0.99996;      /* cosine of half a degree */
static const double SMOOTH = 0.94;       /* cosine of 20 degrees */
static const double SMOOTH_MOST = 0.2;   /* fraction of its rim that goes on smoothly, at which a plane stays even */
static const double TIGHT = 0.1;         /* of how wide a plane is: a rounding that narrow is an edge of it */
static const double ROUNDED = 0.77;      /* cosine of 40 degrees, by which that turns */
static const double WIDE = 1.0 / 2000;   /* of the whole surface */
static const double ASIDE = 0.4;         /* on what stands upright, how much the way leans off upwards */
static const double LEVEL = 0.3;         /* sine of a slope below which a face lies */
static const double FEW = 3, ENOUGH = 9; /* distances of lines across half of a face: too few, enough to fade */

enum { STEPS_MOST = 16 }; /* triangles across a rounding */

/* Sums over the triangles of a plane: area, first and second moments. */
typedef struct plane_sums {
    double area, first[3], second[3][3], rim, smooth; /* length of its rim, and of what goes on smoothly there */
    d3     normal;
} plane_sums;

static void add_triangle(plane_sums *s, const flow_surface *f, uint32_t t)
{
    const uint32_t *i = &f->surface->indices[3 * (size_t)t];
    const vec3     *p = f->surface->positions;
    d3              c[3] = {of(p[i[0]]), of(p[i[1]]), of(p[i[2]])};
    d3              normal = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    double          area = 0.5 * d3_length(normal);
    s->area += area;
    s->normal = d3_along(s->normal, normal, 1);
    /* A triangle has the moments of a third of its area at the middle of each side. */
    for (int k = 0; k < 3; k++) {
        d3           m = d3_along(c[k], minus(c[(k + 1) % 3], c[k]), 0.5);
        const double at[3] = {m.x, m.y, m.z};
        for (int row = 0; row < 3; row++) {
            s->first[row] += area / 3 * at[row];
            for (int column = 0; column < 3; column++)
                s->second[row][column] += area / 3 * at[row] * at[column];
        }
    }
}

/* Which way a plane is longest: a few steps towards the greatest spread. */
static d3 longest(const plane_sums *s)
{
    d3 n = d3_unit(s->normal), along = fabs(n.x) < 0.6 ? (d3){1, 0.3, 0.2} : (d3){0.2, 1, 0.3};
    for (int step = 0; step < 24; step++) {
        const double a[3] = {along.x, along.y, along.z};
        double       to[3] = {0, 0, 0};
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 3; column++)
                to[row] += a[column] *
                           (s->second[row][column] / s->area - s->first[row] * s->first[column] / (s->area * s->area));
        d3 next = {to[0], to[1], to[2]};
        along = d3_unit(d3_along(next, n, -dot(next, n)));
    }
    return along.x + along.y + along.z < 0 ? (d3){-along.x, -along.y, -along.z} : along;
}

/* Towards where it gets darker: up, a little to a side, where there is an up. */
static d3 darker_way(const plane_sums *s, d3 up)
{
    d3     n = d3_unit(s->normal), upwards = d3_along(up, n, -dot(up, n));
    double steep = d3_length(upwards);
    if (steep < LEVEL)
        return longest(s);
    upwards = d3_unit(upwards);
    return d3_unit(d3_along(upwards, cross(n, upwards), ASIDE));
}

static d3 corner_at(const flow_surface *f, uint32_t corner)
{
    return of(f->surface->positions[f->surface->indices[corner]]);
}

static uint32_t next_corner(uint32_t half)
{
    return half % 3 == 2 ? half - 2 : half + 1;
}

/* The side by which a straight way through a triangle leaves it, which it entered by another one. */
static uint32_t leave(const flow_surface *f, uint32_t entered, d3 from, d3 way, d3 normal, double *distance)
{
    uint32_t found = UINT32_MAX;
    *distance = INFINITY;
    for (uint32_t half = next_corner(entered); half != entered; half = next_corner(half)) {
        d3     a = corner_at(f, half), out = cross(minus(corner_at(f, next_corner(half)), a), normal);
        double speed = dot(way, out), to = speed > 0 ? fmax(dot(minus(a, from), out) / speed, 0) : INFINITY;
        if (to < *distance) {
            *distance = to;
            found = half;
        }
    }
    return found;
}

/* Does the surface turn over a side of a triangle, and on for so far, as much as an edge that is rounded a little? */
static bool is_rounded_edge(const flow_surface *f, uint32_t half, double far)
{
    d3 before = flow_face_normal(f, half / 3), a = corner_at(f, half),
       along = minus(corner_at(f, next_corner(half)), a), at = d3_along(a, along, 0.5);
    d3       way = d3_unit(cross(along, before)), normal = before;
    uint32_t entered = f->across[half];
    for (int step = 0; step < STEPS_MOST && entered != UINT32_MAX; step++) {
        double distance;
        d3     next = flow_face_normal(f, entered / 3);
        way = d3_unit(d3_along(way, d3_along(normal, next, 1), -dot(way, next) / (1 + fmax(dot(normal, next), -0.9))));
        normal = next;
        if (dot(normal, before) < ROUNDED)
            return true;
        uint32_t left = leave(f, entered, at, way, normal, &distance);
        if (left == UINT32_MAX || distance > far)
            return false;
        far -= distance;
        at = d3_along(at, way, distance);
        entered = f->across[left];
    }
    return false;
}

/* Where a plane goes over into something round, one cannot fade without the other. Planes that are much smaller than
 * all of the surface do not fade anyway. */
static void add_rim(plane_sums *s, const flow_surface *f, uint32_t half, double whole)
{
    const uint32_t *i = &f->surface->indices[3 * (size_t)(half / 3)];
    const vec3     *p = f->surface->positions;
    uint32_t        other = f->across[half];
    double          length = d3_length(minus(of(p[i[(half + 1) % 3]]), of(p[i[half % 3]])));
    if (other != UINT32_MAX && f->plane_of[other / 3] == f->plane_of[half / 3])
        return;
    s->rim += length;
    if (other != UINT32_MAX && dot(flow_face_normal(f, half / 3), flow_face_normal(f, other / 3)) > SMOOTH &&
        !(s->area > WIDE * whole && is_rounded_edge(f, half, TIGHT * sqrt(s->area))))
        s->smooth += length;
}

static void group_planes(const flow_surface *f, uint32_t *planes)
{
    uint32_t count = f->surface->triangle_count;
    for (uint32_t t = 0; t < count; t++)
        planes[t] = t;
    for (uint32_t h = 0; h < 3 * count; h++)
        if (f->across[h] != UINT32_MAX && f->across[h] > h &&
            dot(flow_face_normal(f, h / 3), flow_face_normal(f, f->across[h] / 3)) > FLAT)
            group_join(planes, h / 3, f->across[h] / 3);
    for (uint32_t t = 0; t < count; t++)
        planes[t] = group_root(planes, t);
}

/* How far a plane reaches from its middle, along its way. */
static void measure_planes(flow_surface *f, double *reach)
{
    const mark_surface *s = f->surface;
    for (uint32_t c = 0; c < 3 * s->triangle_count; c++) {
        uint32_t          plane = f->plane_of[c / 3];
        const flow_plane *p = &f->planes[plane];
        reach[plane] = fmax(reach[plane], fabs(dot(minus(of(s->positions[s->indices[c]]), p->middle), p->way)));
    }
    for (uint32_t t = 0; t < s->triangle_count; t++)
        f->planes[t].reach = reach[t];
}

bool flow_planes_make(flow_surface *f)
{
    uint32_t    count = f->surface->triangle_count;
    plane_sums *sums = mem_calloc(count, sizeof *sums);
    double     *reach = mem_calloc(count, sizeof *reach), whole = 0;
    f->plane_of = mem_alloc((size_t)count * sizeof *f->plane_of);
    f->planes = mem_calloc(count, sizeof *f->planes);
    bool done = sums && reach && f->plane_of && f->planes;
    if (done)
        group_planes(f, f->plane_of);
    for (uint32_t t = 0; t < count && done; t++)
        add_triangle(&sums[f->plane_of[t]], f, t);
    for (uint32_t t = 0; t < count && done; t++)
        whole += sums[t].area;
    for (uint32_t h = 0; h < 3 * count && done; h++)
        add_rim(&sums[f->plane_of[h / 3]], f, h, whole);
    for (uint32_t t = 0; t < count && done; t++) {
        const plane_sums *s = &sums[t];
        if (f->plane_of[t] != t || !(s->area > 0) || !(s->rim > 0))
            continue;
        f->planes[t].middle = (d3){s->first[0] / s->area, s->first[1] / s->area, s->first[2] / s->area};
        f->planes[t].sure = fmax(1 - s->smooth / (SMOOTH_MOST * s->rim), 0);
        f->planes[t].way = darker_way(s, of(f->surface->up));
    }
    if (done)
        measure_planes(f, reach);
    mem_free(sums);
    mem_free(reach);
    return done;
}

double flow_shade_at(const flow_surface *f, uint32_t triangle, vec3 at, double apart)
{
    const flow_plane *p = &f->planes[f->plane_of[triangle]];
    double            room = (p->reach / apart - FEW) / (ENOUGH - FEW), sure = p->sure * fmin(fmax(room, 0), 1);
    return sure > 0 ? sure * fmin(fmax(dot(minus(of(at), p->middle), p->way) / p->reach, -1), 1) : 0;
}
