/* Morphs and skinning on the CPU. */
#include <math.h>

#include "scene/mesh.h"

/* The upper left 3x3 times a direction. */
static vec3 turn(const mat4 *m, vec3 n)
{
    const double *e = m->m;
    return (vec3){(float)(e[0] * n.x + e[4] * n.y + e[8] * n.z), (float)(e[1] * n.x + e[5] * n.y + e[9] * n.z),
                  (float)(e[2] * n.x + e[6] * n.y + e[10] * n.z)};
}

static vec3 to_unit(vec3 n)
{
    double length = sqrt((double)n.x * n.x + (double)n.y * n.y + (double)n.z * n.z);
    if (!(length > 0))
        return (vec3){0, 0, 1};
    return (vec3){(float)(n.x / length), (float)(n.y / length), (float)(n.z / length)};
}

/* Normals follow the cofactors of the 3x3, which is the inverse transpose times the determinant: right under
 * non-uniform scale, and defined when the matrix is singular. */
static mat4 cofactors(const mat4 *m)
{
    const double *e = m->m;
    mat4          c = mat4_identity();
    c.m[0] = e[5] * e[10] - e[6] * e[9];
    c.m[1] = e[6] * e[8] - e[4] * e[10];
    c.m[2] = e[4] * e[9] - e[5] * e[8];
    c.m[4] = e[2] * e[9] - e[1] * e[10];
    c.m[5] = e[0] * e[10] - e[2] * e[8];
    c.m[6] = e[1] * e[8] - e[0] * e[9];
    c.m[8] = e[1] * e[6] - e[2] * e[5];
    c.m[9] = e[2] * e[4] - e[0] * e[6];
    c.m[10] = e[0] * e[5] - e[1] * e[4];
    return c;
}

/* The weighted sum of a vertex's joint matrices. */
static mat4 blend(const primitive *p, uint32_t vertex, const mat4 *joints, size_t joint_count)
{
    mat4         sum = {{0}};
    const float *weights = &p->weights[vertex].x;
    for (int k = 0; k < 4; k++) {
        uint16_t joint = p->joints[(size_t)vertex * 4 + (size_t)k];
        if (weights[k] == 0 || joint >= joint_count)
            continue;
        for (int i = 0; i < 16; i++)
            sum.m[i] += (double)weights[k] * joints[joint].m[i];
    }
    return sum;
}

static void add_scaled(vec3 *to, const vec3 *offsets, uint32_t vertex, float weight)
{
    if (!offsets)
        return;
    to->x += offsets[vertex].x * weight;
    to->y += offsets[vertex].y * weight;
    to->z += offsets[vertex].z * weight;
}

void mesh_pose(const primitive *p, const float *weights, size_t weight_count, const mat4 *joint_matrices,
               size_t joint_count, const vec3 *normals, const uint32_t *source, uint32_t count, vec3 *out_positions,
               vec3 *out_normals)
{
    bool   skinned = joint_matrices && p->joints && p->weights;
    size_t morphs = weights ? weight_count < p->morph_count ? weight_count : p->morph_count : 0;
    bool   with_normals = normals && out_normals;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t vertex = source ? source[i] : i;
        vec3     position = p->positions[vertex], normal = with_normals ? normals[i] : (vec3){0, 0, 1};
        for (size_t m = 0; m < morphs; m++) {
            if (weights[m] == 0)
                continue;
            add_scaled(&position, p->morphs[m].positions, vertex, weights[m]);
            add_scaled(&normal, p->morphs[m].normals, vertex, weights[m]);
        }
        if (skinned) {
            mat4 joint = blend(p, vertex, joint_matrices, joint_count);
            position = mat4_transform_point(&joint, position);
            if (with_normals) {
                mat4 turned = cofactors(&joint);
                normal = turn(&turned, normal);
            }
        }
        out_positions[i] = position;
        if (with_normals)
            out_normals[i] = to_unit(normal);
    }
}
