#include "contact/surface.h"

#include <math.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"

/* What is done with each primitive of a part, its vertices in the world. */
typedef struct visit {
    void (*primitive)(const primitive *from, const double (*vertices)[3], size_t part, void *user);
    void *user;
} visit;

static void to_world(double (*out)[3], const vec3 *positions, uint32_t count, const mat4 *world)
{
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            out[i][k] = world->m[k] * (double)positions[i].x + world->m[4 + k] * (double)positions[i].y +
                        world->m[8 + k] * (double)positions[i].z + world->m[12 + k];
}

static lmn_status visit_primitive(const visit *v, const pose *p, size_t part, const primitive *from, lmn_error *error)
{
    const node *n = &p->scene->nodes[p->scene->parts[part].node];
    const bool  moved = pose_deforms(&p->parts[part], from);
    vec3       *posed = moved ? mem_alloc((from->vertex_count + 1) * sizeof *posed) : NULL;
    double(*world)[3] = mem_alloc((from->vertex_count + 1) * sizeof *world);
    bool good = world && (posed || !moved);
    if (good && moved)
        pose_vertices(&p->parts[part], from, NULL, NULL, from->vertex_count, posed, NULL);
    for (size_t i = 0; good && i < node_draw_count(n); i++) {
        mat4 to = pose_instance(p, part, i);
        to_world(world, moved ? posed : from->positions, from->vertex_count, &to);
        v->primitive(from, (const double(*)[3])world, part, v->user);
    }
    mem_free(posed);
    mem_free(world);
    return good ? LMN_OK : error_memory(error);
}

static lmn_status visit_part(const visit *v, const pose *p, size_t part, lmn_error *error)
{
    const node *n = &p->scene->nodes[p->scene->parts[part].node];
    const mesh *m = n->mesh == NONE ? NULL : &p->scene->meshes[n->mesh];
    lmn_status  status = LMN_OK;
    for (size_t i = 0; m && i < m->primitive_count && status == LMN_OK; i++)
        status = visit_primitive(v, p, part, &m->primitives[i], error);
    return status;
}

/* --- outermost ------------------------------------------------------------------------------------------------ */

typedef struct outer {
    const double *direction;
    double        tie, least, sum[3];
    size_t        count;
} outer;

static void find_outer(const primitive *from, const double (*vertices)[3], size_t part, void *user)
{
    outer *o = user;
    (void)part;
    for (uint32_t i = 0; i < from->vertex_count; i++) {
        double along = vector3_dot(vertices[i], o->direction);
        if (along > o->least + o->tie)
            continue;
        if (along < o->least - o->tie) { /* those so far were none */
            o->count = 0;
            vector3_set(o->sum, 0, 0, 0);
        }
        o->least = fmin(o->least, along);
        vector3_add(o->sum, o->sum, 1, vertices[i]);
        o->count++;
    }
}

lmn_status surface_outermost(double out[3], bool *found, const pose *p, const bool *parts, const double direction[3],
                             double tie, lmn_error *error)
{
    outer       o = {.direction = direction, .tie = tie, .least = INFINITY};
    const visit v = {find_outer, &o};
    lmn_status  status = LMN_OK;
    for (size_t i = 0; i < p->scene->part_count && status == LMN_OK; i++)
        if (parts[i])
            status = visit_part(&v, p, i, error);
    *found = status == LMN_OK && o.count > 0;
    for (int k = 0; k < 3 && *found; k++)
        out[k] = o.sum[k] / (double)o.count;
    return status;
}

/* --- nearest -------------------------------------------------------------------------------------------------- */

typedef struct near {
    const double  *at, *direction;
    double         tie; /* distances that differ by less are the same */
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

/* Nearest point of a triangle: below the point where that is inside, else on the nearest edge. Its normal is 0 where
 * it has no area. */
static void nearest_on_triangle(const double p[3], const double *const c[3], double out[3], double normal[3])
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

static bool is_nearer(const near *n, double distance, double facing)
{
    if (!n->found)
        return distance <= n->best->distance;
    if (fabs(distance - n->best->distance) <= n->tie)
        return facing > n->best->facing || (facing == n->best->facing && distance < n->best->distance);
    return distance < n->best->distance;
}

static void find_nearest(const primitive *from, const double (*vertices)[3], size_t part, void *user)
{
    near *n = user;
    for (uint32_t i = 0; i + 2 < from->index_count && !work_stopped(); i += 3) {
        const double *const c[3] = {vertices[from->indices[i]], vertices[from->indices[i + 1]],
                                    vertices[from->indices[i + 2]]};
        double              at[3], normal[3];
        if (is_away(n->at, c, n->best->distance + n->tie))
            continue;
        nearest_on_triangle(n->at, c, at, normal);
        const double distance = vector3_distance(at, n->at),
                     facing = n->direction ? fabs(vector3_dot(normal, n->direction)) : 1;
        if (!is_nearer(n, distance, facing))
            continue;
        n->found = true;
        n->best->part = part;
        n->best->distance = distance;
        n->best->facing = facing;
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
                           double within, const double direction[3], lmn_error *error)
{
    near        n = {at, direction, isfinite(within) ? 1e-5 * within : 0, out, false};
    const visit v = {find_nearest, &n};
    lmn_status  status = LMN_OK;
    *out = (surface_place){.distance = within};
    for (size_t i = 0; i < p->scene->part_count && status == LMN_OK; i++)
        /* Boxes are of single precision. */
        if (parts[i] && box_distance(&p->part_boxes[i], at) <= out->distance * (1 + 1e-5) + n.tie + 1e-9)
            status = visit_part(&v, p, i, error);
    *found = n.found;
    return status == LMN_OK ? work_check(error) : status;
}
