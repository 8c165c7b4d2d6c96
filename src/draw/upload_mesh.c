/* Meshes and draw items of an upload: primitives in their pose, split where the crease angle asks for it. */
#include "draw/upload_private.h"

#include <string.h>

#include "base/memory.h"

void *upload_gather(const void *source, const uint32_t *map, uint32_t count, size_t size)
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

/* Points at what needs no change and makes the rest. */
static lmn_status pose_vertices(posed_mesh *out, const primitive *p, const part_pose *pose, lmn_error *error)
{
    const render_vertices *split = &out->split;
    uint32_t count = split->vertex_count;
    const vec3 *normals = split->normals ? split->normals : p->normals;
    bool done = true;
    gpu_mesh_data *data = &out->data;
    *data = (gpu_mesh_data){.vertex_count = count, .index_count = p->index_count,
                            .indices = split->indices ? split->indices : p->indices, .normals = (const float *)normals,
                            .positions = (const float *)p->positions, .colours = (const float *)p->colours};
    if (pose->joints || (pose->weights && p->morph_count)) {
        out->positions = mem_alloc(sizeof(vec3) * (size_t)count);
        out->normals = mem_alloc(sizeof(vec3) * (size_t)count);
        done = out->positions && out->normals;
        if (done)
            mesh_pose(p, pose->weights, pose->weight_count, pose->joints, pose->joint_count, normals, split->source, count, out->positions,
                      out->normals);
        data->normals = (const float *)out->normals;
        data->positions = (const float *)out->positions;
    } else if (split->source) {
        data->positions = upload_gather(p->positions, split->source, count, sizeof(vec3));
        out->positions = (vec3 *)(void *)(uintptr_t)data->positions;
    }
    for (int i = 0; i < UV_SETS; i++) {
        out->uvs[i] = split->source ? upload_gather(p->uvs[i], split->source, count, sizeof(vec2)) : NULL;
        data->uvs[i] = (const float *)(split->source ? out->uvs[i] : p->uvs[i]);
        done = done && (!p->uvs[i] || data->uvs[i]);
    }
    if (split->source)
        data->colours = (const float *)(out->colours = upload_gather(p->colours, split->source, count, sizeof(vec4)));
    done = done && data->positions && data->normals && (!p->colours || data->colours);
    return done ? LMN_OK : error_memory(error);
}

lmn_status posed_make(posed_mesh *out, const upload *u, const primitive *p, const part_pose *pose, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->split = (render_vertices){.vertex_count = p->vertex_count, .index_count = p->index_count};
    lmn_status status = LMN_OK;
    if (!p->normals)
        status = mesh_make_normals(&out->split, p, u->crease_angle, error);
    return status == LMN_OK ? pose_vertices(out, p, pose, error) : status;
}

lmn_status upload_add_piece(upload *u, gpu *g, gpu_mesh **out, const gpu_mesh_data *data, lmn_error *error)
{
    *out = gpu_mesh_create(g, data);
    lmn_status status = gpu_check(g, error);
    if (status != LMN_OK)
        return status;
    if (!mem_grow((void **)&u->pieces, &u->piece_capacity, u->piece_count + 1, sizeof *u->pieces)) {
        gpu_mesh_destroy(g, out);
        return error_memory(error);
    }
    u->pieces[u->piece_count++] = *out;
    return LMN_OK;
}

bool upload_add_item(upload *u, const draw_item *item)
{
    if (!mem_grow((void **)&u->items, &u->item_capacity, u->item_count + 1, sizeof *u->items))
        return false;
    u->items[u->item_count++] = *item;
    return true;
}

/* What all items of a part's primitive share. */
draw_item upload_item(const upload_part_job *job, size_t primitive_index)
{
    const primitive *p = &job->mesh->primitives[primitive_index];
    return (draw_item){.part_id = (uint32_t)job->part_index + 1, .surface_id = (uint32_t)primitive_index + 1, .part_index = job->part_index,
                       .material = p->material, .has_uvs = p->uvs[0] || p->uvs[1], .has_uv1 = p->uvs[1] != NULL, .has_colours = p->colours != NULL};
}
