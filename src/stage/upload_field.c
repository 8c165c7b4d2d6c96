/* Meshes with the way their surfaces bend, and covered with patches: what strokes are laid along where a model has
 * no texture coordinates. */
#include "stage/upload_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "field/lapped.h"

enum { PATCH_SEED = 1 };

float upload_patch_radius(const upload *u, box3 b)
{
    float x = b.max.x - b.min.x, y = b.max.y - b.min.y, z = b.max.z - b.min.z;
    return u->needs.patch * sqrtf(x * x + y * y + z * z);
}

/* As fields and patches are made of: of vertices as they are drawn. It borrows. */
static primitive primitive_of(const vertex_arrays *data)
{
    primitive p = {.vertex_count = data->vertex_count,
                   .index_count = data->index_count,
                   .positions = (vec3 *)(uintptr_t)data->positions,
                   .normals = (vec3 *)(uintptr_t)data->normals,
                   .indices = (uint32_t *)(uintptr_t)data->indices,
                   .bounds = box3_empty()};
    for (uint32_t i = 0; i < p.vertex_count; i++)
        p.bounds = box3_union(p.bounds, (box3){p.positions[i], p.positions[i]});
    return p;
}

/* One tensor a vertex: that of a corner. */
static float (*tensors_of(const direction_field *field, const primitive *p))[6]
{
    float(*out)[6] = mem_calloc(p->vertex_count, sizeof *out);
    for (uint32_t i = 0; out && i < p->index_count; i++)
        memcpy(out[p->indices[i]], direction_field_at(field, p, i), sizeof *out);
    return out;
}

static lmn_status upload_lapped_mesh(gpu *g, gpu_mesh **out, const lapped_mesh *l, const vertex_arrays *data,
                                     lmn_error *error)
{
    float *positions = posed_gather(data->positions, l->source, l->vertex_count, 3 * sizeof(float)),
          *normals = posed_gather(data->normals, l->source, l->vertex_count, 3 * sizeof(float));
    float *colours = posed_gather(data->colours, l->source, l->vertex_count, 4 * sizeof(float)), *uvs[2];
    for (int i = 0; i < 2; i++)
        uvs[i] = posed_gather(data->uvs[i], l->source, l->vertex_count, 2 * sizeof(float));
    bool done =
        positions && normals && (colours || !data->colours) && (uvs[0] || !data->uvs[0]) && (uvs[1] || !data->uvs[1]);
    if (done)
        *out = gpu_mesh_create(g, &(gpu_mesh_data){.vertex_count = l->vertex_count,
                                                   .index_count = l->index_count,
                                                   .positions = positions,
                                                   .normals = normals,
                                                   .colours = colours,
                                                   .uvs = {uvs[0], uvs[1]},
                                                   .patches = (const float *)l->positions,
                                                   .indices = l->indices});
    mem_free(positions);
    mem_free(normals);
    mem_free(colours);
    mem_free(uvs[0]);
    mem_free(uvs[1]);
    return done ? LMN_OK : error_memory(error);
}

lmn_status upload_with_field(const upload *u, gpu *g, gpu_mesh **out, gpu_mesh **lapped, const vertex_arrays *data,
                             lmn_error *error)
{
    primitive       p = primitive_of(data);
    direction_field field = {0};
    lapped_mesh     patches = {0};
    lmn_status      status = direction_field_make(&field, &p, u->crease_angle > 0 ? u->crease_angle : 0.5, 0, error);
    float(*tensors)[6] = status == LMN_OK ? tensors_of(&field, &p) : NULL;
    if (status == LMN_OK && !tensors)
        status = error_memory(error);
    if (status == LMN_OK) {
        gpu_mesh_data with = upload_data_of(data);
        with.tensors = (const float *)tensors;
        *out = gpu_mesh_create(g, &with);
    }
    if (status == LMN_OK && u->needs.patch > 0) {
        status = lapped_make(&patches, &p, &field, (double)upload_patch_radius(u, p.bounds), PATCH_SEED, error);
        if (status == LMN_OK)
            status = upload_lapped_mesh(g, lapped, &patches, data, error);
    }
    mem_free(tensors);
    lapped_release(&patches);
    direction_field_release(&field);
    return status;
}
