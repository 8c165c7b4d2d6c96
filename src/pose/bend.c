#include "pose/bend.h"

#include <math.h>
#include <string.h>

#include "base/threads.h"
#include "scene/mesh.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void transform(const mat4 *m, const double p[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * p[0] + m->m[4 + k] * p[1] + m->m[8 + k] * p[2] + m->m[12 + k];
}

/* From 0 at the front to 1 at the rear. */
static double rear_of(const part_bend *b, const double point[3])
{
    double off = b->front - dot(b->way, point);
    if (b->around) {
        double from[3] = {point[0] - b->middle[0], point[1] - b->middle[1], point[2] - b->middle[2]};
        off = sqrt(dot(from, from));
    }
    return fmin(fmax(b->length > 0 ? off / b->length : 0, 0), 1);
}

int32_t bend_tooth(const part_bend *b, const double point[3])
{
    double at = b->width > 0 ? (dot(b->across, point) - b->low) / b->width * b->teeth : 0;
    bool   tip = rear_of(b, point) > 0.5 && fabs(2 * (at - floor(at)) - 1) < 0.5 && at < b->teeth;
    return tip ? (int32_t)at : -1;
}

/* Teeth grow from the middle on, so that nothing tears and what goes ahead keeps its shape. */
static double tooth_of(const part_bend *b, const double point[3], double rear)
{
    double at = b->width > 0 ? (dot(b->across, point) - b->low) / b->width * b->teeth : 0;
    return fmax(2 * rear - 1, 0) * (1 - fabs(2 * (at - floor(at)) - 1));
}

double bend_delay(const part_bend *b, const double point[3])
{
    double rear = rear_of(b, point), delay = b->lag * rear;
    return b->comb > 0 ? delay + b->comb * tooth_of(b, point, rear) : delay;
}

/* Between which steps a point is, `before` and the next one. False: it stays. */
static bool find_step(const part_bend *b, const double point[3], int *before, double *part)
{
    double step = b->seconds > 0 ? bend_delay(b, point) / b->seconds * BEND_STEPS : 0;
    if (!(step > 0))
        return false;
    *before = step < BEND_STEPS ? (int)step : BEND_STEPS - 1;
    *part = fmin(step - *before, 1);
    return true;
}

/* What a point is dragged by moves where it has come to. False: it stays there. */
static bool push_point(const part_bend *b, const double point[3], double out[3])
{
    double rear = rear_of(b, point), part = rear * rear;
    bool   pushed = false;
    for (int k = 0; k < 3; k++) {
        out[k] += part * b->push[k];
        pushed = pushed || part * b->push[k] != 0;
    }
    return pushed;
}

/* Where a point of the world comes to. False: it stays. */
static bool bend_point(const part_bend *b, const double point[3], double out[3])
{
    double part, from[3], to[3];
    int    before;
    bool   late = find_step(b, point, &before, &part);
    memcpy(out, point, 3 * sizeof *out);
    if (late) {
        transform(&b->earlier[before], point, from);
        transform(&b->earlier[before + 1], point, to);
        for (int k = 0; k < 3; k++)
            out[k] = from[k] + part * (to[k] - from[k]);
    }
    return push_point(b, point, out) || late;
}

/* Normals follow the cofactors of how the surroundings of a point are bent, by differences over a thousandth of the
 * whole. */
static vec3 bend_normal(const part_bend *b, const double point[3], vec3 normal)
{
    double reach = fmax(b->length, b->width) * 1e-3, out[9];
    mat4   around = mat4_identity();
    for (int k = 0; k < 3; k++) {
        double side[2][3], moved[2][3];
        for (int s = 0; s < 2; s++) {
            memcpy(side[s], point, sizeof side[s]);
            side[s][k] += s ? reach : -reach;
            if (!bend_point(b, side[s], moved[s]))
                memcpy(moved[s], side[s], sizeof moved[s]);
        }
        for (int r = 0; r < 3; r++)
            around.m[4 * k + r] = (moved[1][r] - moved[0][r]) / (2 * reach);
    }
    mat4 whole = mat4_multiply(&around, &b->to_world);
    whole = mat4_multiply(&b->to_mesh, &whole);
    double sign = mat4_cofactors(&whole, out) < 0 ? -1 : 1, n[3], length = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = sign * (out[k] * (double)normal.x + out[3 + k] * (double)normal.y + out[6 + k] * (double)normal.z);
        length += n[k] * n[k];
    }
    length = sqrt(length);
    return length > 0 ? (vec3){(float)(n[0] / length), (float)(n[1] / length), (float)(n[2] / length)} : normal;
}

typedef struct bend_job {
    const part_bend *b;
    vec3            *positions, *normals;
} bend_job;

static void bend_some(size_t begin, size_t end, void *user)
{
    const bend_job *j = user;
    for (size_t i = begin; i < end; i++) {
        const double at[3] = {(double)j->positions[i].x, (double)j->positions[i].y, (double)j->positions[i].z};
        double       point[3], to[3], back[3];
        transform(&j->b->to_world, at, point);
        if (!bend_point(j->b, point, to))
            continue;
        transform(&j->b->to_mesh, to, back);
        j->positions[i] = (vec3){(float)back[0], (float)back[1], (float)back[2]};
        if (j->normals)
            j->normals[i] = bend_normal(j->b, point, j->normals[i]);
    }
}

void bend_vertices(const part_bend *b, uint32_t count, vec3 *positions, vec3 *normals)
{
    enum { SMALLEST = 2048 };
    bend_job j = {b, positions, normals};
    if (b->active)
        threads_for(count, SMALLEST, bend_some, &j);
}

typedef struct skin_job {
    const part_bend *b;
    const primitive *p;
    const float     *weights;
    size_t           weight_count;
    const vec3      *normals;
    const uint32_t  *source;
    vec3            *positions, *out_normals;
} skin_job;

/* Where a vertex was between two steps, in the world, and its normal. */
static void late_vertex(const skin_job *j, size_t i, int before, double part, double world[3], double normal[3])
{
    const part_bend *b = j->b;
    uint32_t         vertex = j->source ? j->source[i] : (uint32_t)i;
    vec3             was[2], facing[2] = {{0, 0, 0}, {0, 0, 0}};
    for (int k = 0; k < 2; k++)
        mesh_pose(j->p, j->weights, j->weight_count, b->joints + (size_t)(before + k) * b->joint_count, b->joint_count,
                  j->normals ? &j->normals[i] : NULL, &vertex, 1, &was[k], j->normals ? &facing[k] : NULL);
    for (int k = 0; k < 3; k++) {
        double from = (double)(&was[0].x)[k], to = (double)(&was[1].x)[k];
        world[k] = from + part * (to - from);
        normal[k] = (double)(&facing[0].x)[k] * (1 - part) + (double)(&facing[1].x)[k] * part;
    }
}

static void skin_some(size_t begin, size_t end, void *user)
{
    const skin_job  *j = user;
    const part_bend *b = j->b;
    double           turn[9], sign = mat4_cofactors(&b->to_mesh, turn) < 0 ? -1 : 1;
    for (size_t i = begin; i < end; i++) {
        const double at[3] = {(double)j->positions[i].x, (double)j->positions[i].y, (double)j->positions[i].z};
        double       point[3], part, n[3], length = 0, world[3], back[3], facing[3];
        int          before;
        transform(&b->to_world, at, point);
        bool late = find_step(b, point, &before, &part);
        memcpy(world, point, sizeof world);
        if (late)
            late_vertex(j, i, before, part, world, n);
        if (!push_point(b, point, world) && !late)
            continue;
        transform(&b->to_mesh, world, back);
        j->positions[i] = (vec3){(float)back[0], (float)back[1], (float)back[2]};
        if (!late || !j->normals)
            continue;
        for (int r = 0; r < 3; r++) {
            facing[r] = sign * (turn[r] * n[0] + turn[3 + r] * n[1] + turn[6 + r] * n[2]);
            length += facing[r] * facing[r];
        }
        length = sqrt(length);
        if (length > 0)
            j->out_normals[i] =
                (vec3){(float)(facing[0] / length), (float)(facing[1] / length), (float)(facing[2] / length)};
    }
}

void bend_skin(const part_bend *b, const primitive *p, const float *weights, size_t weight_count, const vec3 *normals,
               const uint32_t *source, uint32_t count, vec3 *positions, vec3 *out_normals)
{
    enum { SMALLEST = 1024 };
    skin_job j = {b, p, weights, weight_count, out_normals ? normals : NULL, source, positions, out_normals};
    if (b->active)
        threads_for(count, SMALLEST, skin_some, &j);
}
