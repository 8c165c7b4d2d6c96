/* Where two things meet: the nearest place of the partner's surface. */
#include "depict/meeting.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"

static void corner(const vec3 *v, double out[3])
{
    vector3_set(out, (double)v->x, (double)v->y, (double)v->z);
}

/* Nearest point of a piece of a straight line. */
static void nearest_on_edge(const double p[3], const double a[3], const double b[3], double out[3])
{
    double along[3], to[3];
    vector3_add(along, b, -1, a);
    vector3_add(to, p, -1, a);
    double length = vector3_dot(along, along), f = length > 0 ? vector3_dot(to, along) / length : 0;
    vector3_mix(out, a, b, fmin(fmax(f, 0), 1));
}

/* Nearest point of a triangle: below the point where that is inside, else on the nearest edge. */
static void nearest_on_triangle(const double p[3], const double c[3][3], double out[3])
{
    double normal[3], a[3], b[3], to[3], best = INFINITY;
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

static void nearest_on_primitive(const double p[3], const primitive *from, const vec3 *positions, const mat4 *world,
                                 double best[3], double *distance)
{
    for (uint32_t i = 0; i + 2 < from->index_count && !work_stopped(); i += 3) {
        double c[3][3], at[3];
        for (uint32_t k = 0; k < 3; k++) {
            vec3 moved = mat4_transform_point(world, positions[from->indices[i + k]]);
            corner(&moved, c[k]);
        }
        nearest_on_triangle(p, (const double(*)[3])c, at);
        if (vector3_distance(at, p) < *distance) {
            *distance = vector3_distance(at, p);
            vector3_copy(best, at);
        }
    }
}

lmn_status nearest_place(const double p[3], double best[3], double *distance, int32_t *node_index, const depict_job *j,
                         const depict_target *t, double seconds, lmn_error *error)
{
    const pose *posed = NULL;
    lmn_status  status = depict_pose(&posed, j, seconds, error);
    for (size_t i = 0; i < t->part_count && status == LMN_OK; i++) {
        const double before = *distance;
        const node  *n = &j->scene->nodes[j->scene->parts[i].node];
        const mesh  *m = !t->parts[i] || n->mesh == NONE ? NULL : &j->scene->meshes[n->mesh];
        for (size_t k = 0; m && k < m->primitive_count && status == LMN_OK; k++) {
            const primitive *from = &m->primitives[k];
            vec3            *positions = mem_alloc((from->vertex_count + 1) * sizeof *positions);
            if (!positions)
                status = error_memory(error);
            else
                pose_vertices(&posed->parts[i], from, NULL, NULL, from->vertex_count, positions, NULL);
            for (size_t d = 0; d < node_draw_count(n) && status == LMN_OK; d++) {
                mat4 world = pose_instance(posed, i, d);
                nearest_on_primitive(p, from, positions, &world, best, distance);
            }
            mem_free(positions);
        }
        if (*distance < before)
            *node_index = j->scene->parts[i].node;
    }
    return status == LMN_OK ? work_check(error) : status;
}

lmn_status meeting_place(double out[3], bool *met, const depict_job *j, const depict_target *t, int32_t partner,
                         const depict_impact *impact, lmn_error *error)
{
    lmn_status status = impact_contact(out, j, t, impact, error);
    *met = true;
    if (status != LMN_OK || partner == NONE)
        return status;
    depict_target other;
    double        at[3], distance = INFINITY;
    int32_t       own = partner;
    status = target_open(&other, j, partner, error);
    if (status == LMN_OK)
        status = nearest_place(out, at, &distance, &own, j, &other, impact->time, error);
    *met = distance < 0.5 * t->radius;
    if (status == LMN_OK && *met)
        vector3_mix(out, out, at, 0.5);
    target_release(&other);
    return status;
}
