/* Walks over triangles along a field of directions. Inside a triangle the cross of its corners is interpolated, and
 * which of its arms is meant; over an edge a walk goes on in the next triangle as if both lay in one plane. */
#include <math.h>
#include <string.h>

#include "base/groups.h"
#include "base/memory.h"
#include "marks/streamlines.h"
#include "scene/mesh.h"

static const double FEATURE = 0.7;     /* radians: edges over which directions do not go on */
static const double TURNED = 0.64;     /* cosine of 50 degrees: more is another arm */
static const double BENT_ASIDE = 0.26; /* radians: 15 degrees */
static const double FOLLOWED = 0.375;  /* distances of the first lines: a hand follows no bend that is smaller */
static const double SHARP = 0.94;      /* cosine of 20 degrees: edges that are seen */
static const double HALF_PI = 1.57079632679489662;

/* A triangle laid flat. */
typedef struct flat_triangle {
    d3     origin, u, v, normal;
    double x[3], y[3];
} flat_triangle;

static d3 corner_of(const flow_surface *f, uint32_t triangle, uint32_t k)
{
    return of(f->surface->positions[f->surface->indices[3 * (size_t)triangle + k]]);
}

static bool lay_flat(const flow_surface *f, uint32_t triangle, flat_triangle *out)
{
    d3 b = corner_of(f, triangle, 1), c = corner_of(f, triangle, 2);
    out->origin = corner_of(f, triangle, 0);
    b = minus(b, out->origin);
    c = minus(c, out->origin);
    out->u = d3_unit(b);
    out->normal = d3_unit(cross(b, c));
    out->v = cross(out->normal, out->u);
    const double x[3] = {0, dot(b, out->u), dot(c, out->u)}, y[3] = {0, 0, dot(c, out->v)};
    memcpy(out->x, x, sizeof x);
    memcpy(out->y, y, sizeof y);
    return x[1] > 0 && y[2] > 0;
}

static d3 lifted(const flat_triangle *t, double x, double y)
{
    return d3_along(d3_along(t->origin, t->u, x), t->v, y);
}

static void fractions_at(const flat_triangle *t, double x, double y, double out[3])
{
    out[2] = y / t->y[2];
    out[1] = (x - out[2] * t->x[2]) / t->x[1];
    out[0] = 1 - out[1] - out[2];
}

/* The angle of a tensor's line in a flat triangle; false where it has none. */
static bool angle_of(const float *m, const flat_triangle *t, double *out)
{
    d3     tu = {(double)m[0] * t->u.x + (double)m[3] * t->u.y + (double)m[5] * t->u.z,
                 (double)m[3] * t->u.x + (double)m[1] * t->u.y + (double)m[4] * t->u.z,
                 (double)m[5] * t->u.x + (double)m[4] * t->u.y + (double)m[2] * t->u.z};
    d3     tv = {(double)m[0] * t->v.x + (double)m[3] * t->v.y + (double)m[5] * t->v.z,
                 (double)m[3] * t->v.x + (double)m[1] * t->v.y + (double)m[4] * t->v.z,
                 (double)m[5] * t->v.x + (double)m[4] * t->v.y + (double)m[2] * t->v.z};
    double x = dot(t->u, tu) - dot(t->v, tv), y = 2 * dot(t->u, tv);
    *out = 0.5 * atan2(y, x);
    return x != 0 || y != 0;
}

/* The field's angle at a position of a flat triangle. */
static bool angle_at(const flow_surface *f, uint32_t triangle, const flat_triangle *t, double x, double y, double *out)
{
    double angles[3], part[3], side, turned = 0;
    for (uint32_t k = 0; k < 3; k++)
        if (!angle_of(direction_field_at(&f->field, &f->mesh, 3 * triangle + k), t, &angles[k]))
            return false;
    fractions_at(t, x, y, part);
    side = part[0];
    for (int k = 1; k < 3; k++) {
        double off = remainder(angles[k] - angles[0], 2 * HALF_PI), quarters = rint(off / HALF_PI);
        turned += part[k] * (off - quarters * HALF_PI);
        side += quarters != 0 ? -part[k] : part[k];
    }
    *out = angles[0] + turned + (side < 0 ? HALF_PI : 0);
    return true;
}

static bool same_tensor(const flow_surface *f, uint32_t a, uint32_t b)
{
    return memcmp(direction_field_at(&f->field, &f->mesh, a), direction_field_at(&f->field, &f->mesh, b),
                  sizeof *f->field.tensors) == 0;
}

/* A plane of its own, of flow_plane's `sure`. */
static const double ALONE = 0.5;

/* Directions of planes were chosen, one for all of it: nothing of the form asks for just these, but where a plane goes
 * over into what is round, whose lines are to go on. */
static double slant_at(const flow_surface *f, uint32_t triangle)
{
    return f->slant != 0 && f->planes[f->plane_of[triangle]].sure > ALONE &&
                   same_tensor(f, 3 * triangle, 3 * triangle + 1) && same_tensor(f, 3 * triangle, 3 * triangle + 2)
               ? f->slant
               : 0;
}

static bool direction_at(const flow_surface *f, uint32_t triangle, const flat_triangle *t, const double at[2],
                         double turn, const double like[2], double out[2])
{
    double angle;
    if (!angle_at(f, triangle, t, at[0], at[1], &angle))
        return false;
    angle += turn + slant_at(f, triangle);
    out[0] = cos(angle);
    out[1] = sin(angle);
    if (out[0] * like[0] + out[1] * like[1] < 0) {
        out[0] = -out[0];
        out[1] = -out[1];
    }
    return true;
}

static void place_in(const flat_triangle *t, const flow_position *p, double at[2], double direction[2])
{
    d3 from = minus(p->at, t->origin);
    at[0] = dot(from, t->u);
    at[1] = dot(from, t->v);
    direction[0] = dot(p->direction, t->u);
    direction[1] = dot(p->direction, t->v);
}

bool flow_direction(const flow_surface *f, const flow_position *p, double turn, d3 like, d3 *out)
{
    flat_triangle t;
    double        at[2], to[2], near[2] = {0, 0};
    if (!lay_flat(f, p->triangle, &t))
        return false;
    place_in(&t, p, at, near);
    near[0] = dot(like, t.u);
    near[1] = dot(like, t.v);
    if (!direction_at(f, p->triangle, &t, at, turn, near, to))
        return false;
    *out = d3_along((d3){to[0] * t.u.x, to[0] * t.u.y, to[0] * t.u.z}, t.v, to[1]);
    return true;
}

/* Where a straight line leaves a triangle: the edge, and how far on; −1: not at all. */
static int leave(const flat_triangle *t, const double at[2], const double direction[2], double *distance)
{
    int best = -1;
    for (int k = 0; k < 3; k++) {
        int    next = (k + 1) % 3;
        double inward[2] = {t->y[k] - t->y[next], t->x[next] - t->x[k]};
        double off = (at[0] - t->x[k]) * inward[0] + (at[1] - t->y[k]) * inward[1],
               rate = direction[0] * inward[0] + direction[1] * inward[1];
        if (rate >= 0)
            continue;
        double to = fmax(off, 0) / -rate;
        if (best < 0 || to < *distance) {
            best = k;
            *distance = to;
        }
    }
    return best;
}

static uint32_t next_corner(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

/* Where a plane begins, which has one direction for all of it, lines go on if it is nearly that of what lies beside
 * it, and there is no crease. */
static bool agrees_beyond(const flow_surface *f, const flow_position *p, const flat_triangle *here, uint32_t beyond,
                          const flat_triangle *there)
{
    double at[2], by_place[2], from, to;
    if (dot(here->normal, there->normal) < cos(FEATURE))
        return false;
    place_in(here, p, at, by_place);
    if (!angle_at(f, p->triangle, here, at[0], at[1], &from))
        return false;
    place_in(there, p, at, by_place);
    if (!angle_at(f, beyond, there, at[0], at[1], &to))
        return false;
    from += slant_at(f, p->triangle);
    to += slant_at(f, beyond);
    d3 line = d3_unit((d3){cos(from) * here->u.x + sin(from) * here->v.x, cos(from) * here->u.y + sin(from) * here->v.y,
                           cos(from) * here->u.z + sin(from) * here->v.z});
    double off = atan2(dot(line, there->v), dot(line, there->u)) - to;
    return fabs(remainder(off, HALF_PI)) < BENT_ASIDE;
}

/* Into the triangle beyond an edge; false where the surface ends, or the field is parted. */
static bool go_over(const flow_surface *f, flow_position *p, uint32_t edge, const flat_triangle *here)
{
    uint32_t other = f->across[edge];
    if (other == UINT32_MAX)
        return false;
    flat_triangle t;
    bool          same = f->surface->indices[edge] == f->surface->indices[other];
    uint32_t      a = same ? other : next_corner(other), b = same ? next_corner(other) : other;
    if (!lay_flat(f, other / 3, &t))
        return false;
    p->over = !same_tensor(f, edge, a) && !same_tensor(f, next_corner(edge), b);
    if (p->over && !agrees_beyond(f, p, here, other / 3, &t))
        return false;
    /* Directions turn with the normal by the least rotation: about the edge. */
    double agree = dot(here->normal, t.normal);
    if (agree < -0.9)
        return false;
    d3 sum = {here->normal.x + t.normal.x, here->normal.y + t.normal.y, here->normal.z + t.normal.z};
    p->direction = d3_unit(d3_along(p->direction, sum, -dot(p->direction, t.normal) / (1 + agree)));
    p->triangle = other / 3;
    return true;
}

static flow_step walk(const flow_surface *f, flow_position *p, const flat_triangle *t, const double at[2],
                      const double direction[2], double length, double *gone)
{
    double distance = 0;
    int    edge = leave(t, at, direction, &distance);
    bool   leaves = edge >= 0 && distance <= length;
    *gone = leaves ? distance : length;
    p->at = lifted(t, at[0] + *gone * direction[0], at[1] + *gone * direction[1]);
    p->direction =
        d3_along((d3){direction[0] * t->u.x, direction[0] * t->u.y, direction[0] * t->u.z}, t->v, direction[1]);
    if (!leaves)
        return FLOW_ON;
    return go_over(f, p, 3 * p->triangle + (uint32_t)edge, t) ? FLOW_ON : FLOW_EDGE;
}

flow_step flow_along(const flow_surface *f, flow_position *p, double turn, double length, double *gone)
{
    flat_triangle t;
    double        at[2], before[2], here[2], middle[2], there[2], end = 0;
    *gone = 0;
    if (!lay_flat(f, p->triangle, &t))
        return FLOW_EDGE;
    place_in(&t, p, at, before);
    if (!direction_at(f, p->triangle, &t, at, turn, before, here))
        return FLOW_TURNED;
    if (here[0] * before[0] + here[1] * before[1] < TURNED)
        return FLOW_TURNED;
    /* The direction half-way is that of the whole step. */
    if (leave(&t, at, here, &end) >= 0)
        length = fmin(length, fmax(end, 0.01 * length) * 1.5);
    middle[0] = at[0] + 0.5 * fmin(length, end) * here[0];
    middle[1] = at[1] + 0.5 * fmin(length, end) * here[1];
    if (!direction_at(f, p->triangle, &t, middle, turn, here, there) ||
        here[0] * there[0] + here[1] * there[1] < TURNED)
        return FLOW_TURNED;
    return walk(f, p, &t, at, there, length, gone);
}

flow_step flow_straight(const flow_surface *f, flow_position *p, double length, double *gone)
{
    flat_triangle t;
    double        at[2], direction[2];
    *gone = 0;
    if (!lay_flat(f, p->triangle, &t))
        return FLOW_EDGE;
    place_in(&t, p, at, direction);
    double size = hypot(direction[0], direction[1]);
    if (!(size > 0))
        return FLOW_EDGE;
    direction[0] /= size;
    direction[1] /= size;
    return walk(f, p, &t, at, direction, length, gone);
}

d3 flow_face_normal(const flow_surface *f, uint32_t triangle)
{
    d3 a = corner_of(f, triangle, 0);
    return d3_unit(cross(minus(corner_of(f, triangle, 1), a), minus(corner_of(f, triangle, 2), a)));
}

d3 flow_normal(const flow_surface *f, const flow_position *p)
{
    flat_triangle t;
    double        at[2], direction[2], part[3];
    if (!lay_flat(f, p->triangle, &t))
        return (d3){0, 0, 1};
    place_in(&t, p, at, direction);
    fractions_at(&t, at[0], at[1], part);
    d3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        sum = d3_along(sum, of(f->surface->normals[f->surface->indices[3 * (size_t)p->triangle + k]]), part[k]);
    double length = d3_length(sum);
    return length > 1e-6 ? d3_unit(sum) : t.normal;
}

/* The least part that a corner of a triangle has in a position. */
static double least_part(const flow_surface *f, uint32_t triangle, d3 at)
{
    flat_triangle t;
    double        part[3];
    if (!lay_flat(f, triangle, &t))
        return -INFINITY;
    d3 from = minus(at, t.origin);
    fractions_at(&t, dot(from, t.u), dot(from, t.v), part);
    /* What lies off its plane is not on it. */
    return fmin(fmin(part[0], part[1]), part[2]) - fabs(dot(from, t.normal)) / t.x[1];
}

bool flow_is_at_crease(const flow_surface *f, const flow_point *p)
{
    flat_triangle t;
    double        part[3];
    if (!lay_flat(f, p->triangle, &t))
        return false;
    d3 from = minus(of(p->at), t.origin);
    fractions_at(&t, dot(from, t.u), dot(from, t.v), part);
    uint32_t far = part[0] <= part[1] && part[0] <= part[2] ? 0 : part[1] <= part[2] ? 1 : 2;
    uint32_t other = f->across[3 * p->triangle + (far + 1) % 3];
    return other == UINT32_MAX || dot(t.normal, flow_face_normal(f, other / 3)) < SHARP;
}

uint32_t flow_triangle_between(const flow_surface *f, const flow_point *a, const flow_point *b)
{
    d3 middle = d3_along(of(a->at), minus(of(b->at), of(a->at)), 0.5);
    if (a->triangle == b->triangle)
        return a->triangle;
    return least_part(f, a->triangle, middle) >= least_part(f, b->triangle, middle) ? a->triangle : b->triangle;
}

/* --- the surface ---------------------------------------------------------------------------------------- */

lmn_status flow_surface_make(flow_surface *out, const mark_surface *s, double apart, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->surface = s;
    out->mesh = (primitive){.vertex_count = s->vertex_count,
                            .index_count = 3 * s->triangle_count,
                            .positions = (vec3 *)(uintptr_t)s->positions,
                            .normals = (vec3 *)(uintptr_t)s->normals,
                            .indices = (uint32_t *)(uintptr_t)s->indices,
                            .material = NONE};
    out->across = mesh_adjacency(&out->mesh);
    out->bodies = mem_alloc((size_t)s->triangle_count * sizeof *out->bodies);
    if (!out->across || !out->bodies)
        return error_memory(error);
    for (uint32_t t = 0; t < s->triangle_count; t++)
        out->bodies[t] = t;
    for (uint32_t h = 0; h < 3 * s->triangle_count; h++)
        if (out->across[h] != UINT32_MAX)
            group_join(out->bodies, h / 3, out->across[h] / 3);
    for (uint32_t t = 0; t < s->triangle_count; t++)
        out->bodies[t] = group_root(out->bodies, t);
    if (!flow_rooms_make(out) || !flow_planes_make(out))
        return error_memory(error);
    return direction_field_make(&out->field, &out->mesh, FEATURE, 0, FOLLOWED * apart, error);
}

void flow_surface_release(flow_surface *f)
{
    direction_field_release(&f->field);
    mem_free(f->across);
    mem_free(f->bodies);
    mem_free(f->rooms);
    mem_free(f->plane_of);
    mem_free(f->planes);
    memset(f, 0, sizeof *f);
}
