#include "pose/posed_mesh.h"

#include <string.h>

#include "base/memory.h"

void *posed_gather(const void *source, const uint32_t *map, uint32_t count, size_t size)
{
    if (!source)
        return NULL;
    unsigned char *out = mem_alloc((size_t)count * size);
    for (uint32_t i = 0; out && i < count; i++)
        memcpy(out + (size_t)i * size, (const unsigned char *)source + (size_t)map[i] * size, size);
    return out;
}

void posed_release(posed_mesh *m)
{
    mem_free(m->positions);
    mem_free(m->normals);
    for (int i = 0; i < UV_SETS; i++)
        mem_free(m->uvs[i]);
    mem_free(m->colours);
    render_vertices_release(&m->split);
    memset(m, 0, sizeof *m);
}

/* Moves positions and turns normals, unless that was done for the part's box. */
static bool deform(posed_mesh *out, const primitive *p, const part_pose *pose, const vec3 *normals)
{
    const posed_vertices *known = pose_vertices_of(pose, p);
    uint32_t              count = out->split.vertex_count;
    if (known && known->normals) {
        out->data.positions = (const float *)known->positions;
        out->data.normals = (const float *)known->normals;
        return true;
    }
    out->positions = mem_alloc(sizeof(vec3) * (size_t)count);
    out->normals = mem_alloc(sizeof(vec3) * (size_t)count);
    if (!out->positions || !out->normals)
        return false;
    mesh_pose(p, pose->weights, pose->weight_count, pose->joints, pose->joint_count, normals, out->split.source, count,
              out->positions, out->normals);
    out->data.positions = (const float *)out->positions;
    out->data.normals = (const float *)out->normals;
    return true;
}

/* Points at what needs no change and makes the rest. */
static lmn_status pose_vertices(posed_mesh *out, const primitive *p, const part_pose *pose, lmn_error *error)
{
    const render_vertices *split = &out->split;
    uint32_t               count = split->vertex_count;
    const vec3            *normals = split->normals ? split->normals : p->normals;
    bool                   done = true;
    vertex_arrays         *data = &out->data;
    *data = (vertex_arrays){.vertex_count = count,
                            .index_count = p->index_count,
                            .indices = split->indices ? split->indices : p->indices,
                            .normals = (const float *)normals,
                            .positions = (const float *)p->positions,
                            .colours = (const float *)p->colours};
    if (pose_deforms(pose, p)) {
        done = deform(out, p, pose, normals);
    } else if (split->source) {
        data->positions = posed_gather(p->positions, split->source, count, sizeof(vec3));
        out->positions = (vec3 *)(void *)(uintptr_t)data->positions;
    }
    for (int i = 0; i < UV_SETS; i++) {
        out->uvs[i] = split->source ? posed_gather(p->uvs[i], split->source, count, sizeof(vec2)) : NULL;
        data->uvs[i] = (const float *)(split->source ? out->uvs[i] : p->uvs[i]);
        done = done && (!p->uvs[i] || data->uvs[i]);
    }
    if (split->source)
        data->colours = (const float *)(out->colours = posed_gather(p->colours, split->source, count, sizeof(vec4)));
    done = done && data->positions && data->normals && (!p->colours || data->colours);
    return done ? LMN_OK : error_memory(error);
}

vec3 *posed_positions(const primitive *p, const part_pose *pose, const render_vertices *split)
{
    const posed_vertices *known = pose_vertices_of(pose, p);
    if (known && split->source)
        return posed_gather(known->positions, split->source, split->vertex_count, sizeof(vec3));
    vec3 *out = mem_alloc((size_t)split->vertex_count * sizeof *out);
    if (out && known)
        memcpy(out, known->positions, (size_t)split->vertex_count * sizeof *out);
    else if (out)
        mesh_pose(p, pose->weights, pose->weight_count, pose->joints, pose->joint_count, NULL, split->source,
                  split->vertex_count, out, NULL);
    return out;
}

lmn_status posed_make(posed_mesh *out, const primitive *p, double crease_angle, const part_pose *pose, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->split = (render_vertices){.vertex_count = p->vertex_count, .index_count = p->index_count};
    lmn_status status = LMN_OK;
    if (!p->normals)
        status = mesh_make_normals(&out->split, p, crease_angle, error);
    return status == LMN_OK ? pose_vertices(out, p, pose, error) : status;
}
