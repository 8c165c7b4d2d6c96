#include "contact/surface.h"

#include <math.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "contact/sphere.h"
#include "contact/turned.h"

static void to_world(double (*out)[3], const vec3 *positions, uint32_t count, const mat4 *world)
{
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            out[i][k] = world->m[k] * (double)positions[i].x + world->m[4 + k] * (double)positions[i].y +
                        world->m[8 + k] * (double)positions[i].z + world->m[12 + k];
}

typedef void seer(const surface_piece *piece, void *user);

static lmn_status visit_primitive(seer *see, void *user, const pose *p, size_t part, const primitive *from,
                                  lmn_error *error)
{
    const node *n = &p->scene->nodes[p->scene->parts[part].node];
    const bool  moved = pose_deforms(&p->parts[part], from);
    vec3       *posed = moved ? mem_alloc((from->vertex_count + 1) * sizeof *posed) : NULL;
    double(*world)[3] = mem_alloc((from->vertex_count + 1) * sizeof *world);
    bool good = world && (posed || !moved);
    if (good && moved)
        pose_vertices(&p->parts[part], from, NULL, NULL, from->vertex_count, posed, NULL);
    for (size_t i = 0; good && i < node_draw_count(n); i++) {
        const mat4 to = pose_instance(p, part, i);
        to_world(world, moved ? posed : from->positions, from->vertex_count, &to);
        see(&(surface_piece){part, from, (const double(*)[3])world, to, moved}, user);
    }
    mem_free(posed);
    mem_free(world);
    return good ? LMN_OK : error_memory(error);
}

lmn_status surface_visit(const pose *p, size_t part, seer *see, void *user, lmn_error *error)
{
    const node *n = &p->scene->nodes[p->scene->parts[part].node];
    const mesh *m = n->mesh == NONE ? NULL : &p->scene->meshes[n->mesh];
    lmn_status  status = LMN_OK;
    for (size_t i = 0; m && i < m->primitive_count && status == LMN_OK; i++)
        status = visit_primitive(see, user, p, part, &m->primitives[i], error);
    return status;
}

/* --- outermost ------------------------------------------------------------------------------------------------ */

typedef struct outer {
    const double *direction;
    double        tie, least, sum[3];
    size_t        count;
} outer;

static void take_outer(outer *o, const double at[3])
{
    const double along = vector3_dot(at, o->direction);
    if (along > o->least + o->tie)
        return;
    if (along < o->least - o->tie) { /* those so far were none */
        o->count = 0;
        vector3_set(o->sum, 0, 0, 0);
    }
    o->least = fmin(o->least, along);
    vector3_add(o->sum, o->sum, 1, at);
    o->count++;
}

static void take_placed(outer *o, const double local[3], const mat4 *world)
{
    double at[3];
    for (int k = 0; k < 3; k++)
        at[k] = world->m[k] * local[0] + world->m[4 + k] * local[1] + world->m[8 + k] * local[2] + world->m[12 + k];
    take_outer(o, at);
}

/* Of the unit sphere that a matrix takes to the world, what the direction's image under the transposed one meets. */
static void take_sphere(outer *o, const sphere *s, const mat4 *world)
{
    double local[3];
    for (int k = 0; k < 3; k++)
        local[k] = vector3_dot(&world->m[4 * k], o->direction);
    const bool directed = vector3_normalise(local);
    vector3_add(local, s->centre, directed ? -s->radius : 0, local);
    take_placed(o, local, world);
}

/* Of both rims what lies outermost, or all around, evenly. */
static void take_turned(outer *o, const turned *t, const mat4 *world)
{
    enum { EVENLY = 48 };
    double across[3], at[3];
    for (int k = 0; k < 3; k++)
        across[k] = -vector3_dot(&world->m[4 * ((t->axis + 1 + k) % 3)], o->direction);
    const bool faces = sqrt(across[0] * across[0] + across[1] * across[1]) > 1e-4 * vector3_length(across);
    for (int i = 0; i < (faces ? 1 : EVENLY); i++)
        for (int end = 0; end < 2; end++) {
            turned_rim(t, faces ? atan2(across[1], across[0]) : 6.283185307179586 * i / EVENLY, end, at);
            take_placed(o, at, world);
        }
}

static void find_outer(const surface_piece *piece, void *user)
{
    outer *o = user;
    sphere s;
    turned t;
    if (!piece->deformed && sphere_of(&s, piece->from))
        take_sphere(o, &s, &piece->world);
    else if (!piece->deformed && turned_of(&t, piece->from))
        take_turned(o, &t, &piece->world);
    else
        for (uint32_t i = 0; i < piece->from->vertex_count; i++)
            take_outer(o, piece->vertices[i]);
}

lmn_status surface_outermost(double out[3], bool *found, const pose *p, const bool *parts, const double direction[3],
                             double tie, lmn_error *error)
{
    outer      o = {.direction = direction, .tie = tie, .least = INFINITY};
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < p->scene->part_count && status == LMN_OK; i++)
        if (parts[i])
            status = surface_visit(p, i, find_outer, &o, error);
    *found = status == LMN_OK && o.count > 0;
    for (int k = 0; k < 3 && *found; k++)
        out[k] = o.sum[k] / (double)o.count;
    return status;
}

/* --- nearest -------------------------------------------------------------------------------------------------- */

typedef struct near {
    const double  *at;
    surface_place *best;
    bool           found;
} near;

/* Nearest point of a piece of a straight line. */
static void nearest_on_edge(const double p[3], const double a[3], const double b[3], double out[3])
{
    double along[3], to[3];
    vector3_add(along, b, -1, a);
    vector3_add(to, p, -1, a);
    double length = vector3_dot(along, along), f = length > 0 ? vector3_dot(to, along) / length : 0;
    vector3_mix(out, a, b, fmin(fmax(f, 0), 1));
}

void surface_nearest_on_triangle(const double p[3], const double *const c[3], double out[3], double normal[3])
{
    double a[3], b[3], to[3], best = INFINITY;
    vector3_add(a, c[1], -1, c[0]);
    vector3_add(b, c[2], -1, c[0]);
    vector3_cross(normal, a, b);
    bool inside = vector3_normalise(normal);
    vector3_add(to, p, -1, c[0]);
    double below[3];
    vector3_add(below, p, -vector3_dot(to, normal), normal);
    for (int k = 0; k < 3; k++) {
        double edge[3], from[3], side[3], at[3];
        vector3_add(edge, c[(k + 1) % 3], -1, c[k]);
        vector3_add(from, below, -1, c[k]);
        vector3_cross(side, edge, from);
        inside = inside && vector3_dot(side, normal) >= 0;
        nearest_on_edge(p, c[k], c[(k + 1) % 3], at);
        if (vector3_distance(at, p) < best) {
            best = vector3_distance(at, p);
            vector3_copy(out, at);
        }
    }
    if (inside)
        vector3_copy(out, below);
}

/* Is its box too far away? */
static bool is_away(const double p[3], const double *const c[3], double within)
{
    for (int k = 0; k < 3; k++)
        if (fmin(fmin(c[0][k], c[1][k]), c[2][k]) > p[k] + within ||
            fmax(fmax(c[0][k], c[1][k]), c[2][k]) < p[k] - within)
            return true;
    return false;
}

static void find_nearest(const surface_piece *piece, void *user)
{
    near            *n = user;
    const primitive *from = piece->from;
    const double(*vertices)[3] = piece->vertices;
    for (uint32_t i = 0; i + 2 < from->index_count && !work_stopped(); i += 3) {
        const double *const c[3] = {vertices[from->indices[i]], vertices[from->indices[i + 1]],
                                    vertices[from->indices[i + 2]]};
        double              at[3], normal[3];
        if (is_away(n->at, c, n->best->distance))
            continue;
        surface_nearest_on_triangle(n->at, c, at, normal);
        const double distance = vector3_distance(at, n->at);
        if (n->found ? distance >= n->best->distance : distance > n->best->distance)
            continue;
        n->found = true;
        n->best->part = piece->part;
        n->best->distance = distance;
        vector3_copy(n->best->place, at);
    }
}

static double box_distance(const box3 *b, const double p[3])
{
    const double low[3] = {(double)b->min.x, (double)b->min.y, (double)b->min.z},
                 high[3] = {(double)b->max.x, (double)b->max.y, (double)b->max.z};
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += pow(fmax(fmax(low[k] - p[k], p[k] - high[k]), 0), 2);
    return sqrt(sum);
}

lmn_status surface_nearest(surface_place *out, bool *found, const pose *p, const bool *parts, const double at[3],
                           double within, lmn_error *error)
{
    near       n = {at, out, false};
    lmn_status status = LMN_OK;
    *out = (surface_place){.distance = within};
    for (size_t i = 0; i < p->scene->part_count && status == LMN_OK; i++)
        /* Boxes are of single precision. */
        if (parts[i] && box_distance(&p->part_boxes[i], at) <= out->distance * (1 + 1e-5) + 1e-9)
            status = surface_visit(p, i, find_nearest, &n, error);
    *found = n.found;
    return status == LMN_OK ? work_check(error) : status;
}
