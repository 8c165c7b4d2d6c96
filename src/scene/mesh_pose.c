/* Morphs and skinning on the CPU. */
#include <math.h>
#include <string.h>

#include "base/threads.h"
#include "scene/mesh.h"

/* A 3 by 4 matrix, column by column, times a point. */
static vec3 move(const double m[12], vec3 p)
{
    double x = (double)p.x, y = (double)p.y, z = (double)p.z;
    return (vec3){(float)(m[0] * x + m[3] * y + m[6] * z + m[9]), (float)(m[1] * x + m[4] * y + m[7] * z + m[10]),
                  (float)(m[2] * x + m[5] * y + m[8] * z + m[11])};
}

/* Normals follow the cofactors of the 3x3, which is the inverse transpose times the determinant: right under
 * non-uniform scale, and defined when the matrix is singular. */
static vec3 turn_normal(const double m[12], vec3 n)
{
    const double *a = m, *b = m + 3, *c = m + 6;
    double        x = (double)n.x, y = (double)n.y, z = (double)n.z;
    return (vec3){
        (float)((b[1] * c[2] - b[2] * c[1]) * x + (c[1] * a[2] - c[2] * a[1]) * y + (a[1] * b[2] - a[2] * b[1]) * z),
        (float)((b[2] * c[0] - b[0] * c[2]) * x + (c[2] * a[0] - c[0] * a[2]) * y + (a[2] * b[0] - a[0] * b[2]) * z),
        (float)((b[0] * c[1] - b[1] * c[0]) * x + (c[0] * a[1] - c[1] * a[0]) * y + (a[0] * b[1] - a[1] * b[0]) * z)};
}

static vec3 to_unit(vec3 n)
{
    double length = sqrt((double)n.x * n.x + (double)n.y * n.y + (double)n.z * n.z);
    if (!(length > 0))
        return (vec3){0, 0, 1};
    return (vec3){(float)(n.x / length), (float)(n.y / length), (float)(n.z / length)};
}

/* Two numbers that are computed with together. */
typedef double pair __attribute__((vector_size(16)));

static pair pair_at(const double *from)
{
    pair out;
    memcpy(&out, from, sizeof out);
    return out;
}

/* The weighted sum of a vertex's joint matrices; the last row is left out. In pairs and unrolled, so that the sums stay
 * in registers: a third of the time. */
static void blend(const primitive *p, uint32_t vertex, const mat4 *joints, size_t joint_count, double out[12])
{
    const float    *weights = &p->weights[(size_t)vertex * p->influences];
    const uint16_t *numbers = &p->joints[(size_t)vertex * p->influences];
    pair            upper[4] = {{0, 0}}, lower[4] = {{0, 0}}; /* of each column */
    for (uint32_t k = 0; k < p->influences; k++) {
        if (weights[k] == 0 || numbers[k] >= joint_count)
            continue;
        const double *m = joints[numbers[k]].m, weight = (double)weights[k];
#pragma GCC unroll 4
        for (int column = 0; column < 4; column++) {
            upper[column] += weight * pair_at(m + 4 * column);
            lower[column] += weight * pair_at(m + 4 * column + 2);
        }
    }
    for (int column = 0; column < 4; column++) {
        out[3 * column] = upper[column][0];
        out[3 * column + 1] = upper[column][1];
        out[3 * column + 2] = lower[column][0];
    }
}

static void add_scaled(vec3 *to, const vec3 *offsets, uint32_t vertex, float weight)
{
    if (!offsets)
        return;
    to->x += offsets[vertex].x * weight;
    to->y += offsets[vertex].y * weight;
    to->z += offsets[vertex].z * weight;
}

typedef struct pose_job {
    const primitive *p;
    const float     *weights;
    size_t           morphs;
    const mat4      *joints; /* NULL: not skinned */
    size_t           joint_count;
    const vec3      *normals; /* NULL: none are asked for */
    const uint32_t  *source;
    vec3            *out_positions, *out_normals;
} pose_job;

static void pose_some(size_t begin, size_t end, void *user)
{
    const pose_job  *j = user;
    const primitive *p = j->p;
    for (size_t i = begin; i < end; i++) {
        uint32_t vertex = j->source ? j->source[i] : (uint32_t)i;
        vec3     position = p->positions[vertex], normal = j->normals ? j->normals[i] : (vec3){0, 0, 1};
        for (size_t m = 0; m < j->morphs; m++) {
            if (j->weights[m] == 0)
                continue;
            add_scaled(&position, p->morphs[m].positions, vertex, j->weights[m]);
            add_scaled(&normal, p->morphs[m].normals, vertex, j->weights[m]);
        }
        if (j->joints) {
            double m[12];
            blend(p, vertex, j->joints, j->joint_count, m);
            position = move(m, position);
            if (j->normals)
                normal = turn_normal(m, normal);
        }
        j->out_positions[i] = position;
        if (j->normals)
            j->out_normals[i] = to_unit(normal);
    }
}

void mesh_pose(const primitive *p, const float *weights, size_t weight_count, const mat4 *joint_matrices,
               size_t joint_count, const vec3 *normals, const uint32_t *source, uint32_t count, vec3 *out_positions,
               vec3 *out_normals)
{
    enum { SMALLEST = 4096 };
    pose_job j = {.p = p,
                  .weights = weights,
                  .morphs = weights ? weight_count < p->morph_count ? weight_count : p->morph_count : 0,
                  .joints = p->joints && p->weights ? joint_matrices : NULL,
                  .joint_count = joint_count,
                  .normals = out_normals ? normals : NULL,
                  .source = source,
                  .out_positions = out_positions,
                  .out_normals = out_normals};
    threads_for(count, SMALLEST, pose_some, &j);
}
