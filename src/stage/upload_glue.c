/* Glue patches: where the two sides of an edge have vertices of their own, a quad between these. It has no area until
 * motion pulls the sides apart. Großmann 2011, section 4.5.6; row 46. */
#include "stage/upload_private.h"

#include "base/memory.h"

/* Do two vertices at one position move alike when normals decide? */
static bool same_normal(const gpu_mesh_data *data, uint32_t a, uint32_t b)
{
    const float *m = data->normals + 3 * (size_t)a, *n = data->normals + 3 * (size_t)b;
    return a == b || (m[0] == n[0] && m[1] == n[1] && m[2] == n[2]);
}

/* The quad between half-edge h and its opposite, two triangles; false when both sides move alike. */
static bool patch_of(const gpu_mesh_data *data, uint32_t h, uint32_t opposite, uint32_t out[6])
{
    uint32_t next = h % 3 == 2 ? h - 2 : h + 1, other = opposite % 3 == 2 ? opposite - 2 : opposite + 1;
    uint32_t a = data->indices[h], b = data->indices[next], far_b = data->indices[opposite],
             far_a = data->indices[other];
    if (same_normal(data, a, far_a) && same_normal(data, b, far_b))
        return false;
    const uint32_t corners[6] = {a, far_b, b, a, far_a, far_b};
    for (int k = 0; k < 6; k++)
        out[k] = corners[k];
    return true;
}

lmn_status upload_glue(const upload *u, gpu_mesh_data *data, lmn_error *error)
{
    if (!u->needs.glue || data->index_count == 0)
        return LMN_OK;
    primitive  p = {.vertex_count = data->vertex_count,
                    .index_count = data->index_count,
                    .positions = (vec3 *)(uintptr_t)data->positions,
                    .indices = (uint32_t *)(uintptr_t)data->indices};
    uint32_t  *opposite = mesh_adjacency(&p), *indices = NULL, patch[6];
    size_t     capacity = 0;
    lmn_status status = opposite ? LMN_OK : error_memory(error);
    for (uint32_t h = 0; status == LMN_OK && h < p.index_count; h++) {
        if (opposite[h] == UINT32_MAX || opposite[h] < h || !patch_of(data, h, opposite[h], patch))
            continue;
        if (!mem_grow((void **)&indices, &capacity, (size_t)data->glue_count + 6, sizeof *indices))
            status = error_memory(error);
        for (int k = 0; k < 6 && status == LMN_OK; k++)
            indices[data->glue_count++] = patch[k];
    }
    mem_free(opposite);
    data->glue = indices;
    return status;
}
