/* Meshes and draw items of an upload. */
#include "stage/upload_private.h"

#include <string.h>

#include "base/memory.h"

gpu_mesh_data upload_data_of(const vertex_arrays *from)
{
    return (gpu_mesh_data){.vertex_count = from->vertex_count,
                           .index_count = from->index_count,
                           .positions = from->positions,
                           .normals = from->normals,
                           .uvs = {from->uvs[0], from->uvs[1]},
                           .colours = from->colours,
                           .indices = from->indices};
}

gpu_mesh_data upload_data_over_time(const upload_vertices *v)
{
    gpu_mesh_data data = upload_data_of(v->now);
    data.rest = (const float *)v->rest_positions;
    data.walls = v->walls;
    for (int k = 0; k < POSE_PAST_MAX; k++)
        data.past[k] = (const float *)v->past[k];
    return data;
}

gpu_mesh *upload_mesh_make(gpu *g, const upload_part_job *job, size_t primitive_index, const gpu_mesh_data *data)
{
    gpu_mesh    **former = job->former ? &job->former[primitive_index] : NULL;
    gpu_mesh_data moved = *data;
    /* As many as the primitive has are its own ones, which do not change from moment to moment. */
    if (data->vertex_count == job->mesh->primitives[primitive_index].vertex_count) {
        moved.uvs[0] = moved.uvs[1] = moved.colours = NULL;
        moved.indices = NULL;
    }
    if (!former || !gpu_mesh_rewrite(g, *former, &moved))
        return gpu_mesh_create(g, data);
    gpu_mesh *out = *former;
    *former = NULL;
    return out;
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
    return (draw_item){.part_id = (uint32_t)job->part_index + 1,
                       .surface_id = (uint32_t)primitive_index + 1,
                       .part_index = job->part_index,
                       .material = p->material,
                       .has_uvs = p->uvs[0] || p->uvs[1],
                       .has_uv1 = p->uvs[1] != NULL,
                       .has_colours = p->colours != NULL};
}
