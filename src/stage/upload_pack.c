/* Packs: small meshes that stay as they are lie side by side in the same buffers, so that a town of a hundred thousand
 * parts is a few vertex arrays and a few draw calls instead of as many as it has parts. A pack's vertices carry the
 * mesh's key, by which shaders look up what is known about the part (src/frame/facts.c). */
#include "stage/upload_private.h"

#include <string.h>

#include "base/memory.h"

/* Larger meshes cost more to draw than to call for; a pack that is full is closed and the next one begun. */
enum { PACKED_VERTICES_MOST = 4096, PACK_VERTICES = 1 << 17 };

/* What vertices have; meshes of one pack have the same. */
enum { HAS_NORMALS, HAS_UV0, HAS_UV1, HAS_COLOURS, HAS_WALLS, ATTRIBUTES };
static const int components[ATTRIBUTES] = {3, 2, 2, 4, 4};

struct upload_pack {
    gpu_mesh *whole; /* NULL: not begun */
    float    *positions, *values[ATTRIBUTES];
    uint32_t *keys, *indices;
    size_t    vertex_count, index_count, vertex_capacity, index_capacity;
};

static void arrays_of(const gpu_mesh_data *data, const float *out[ATTRIBUTES])
{
    out[HAS_NORMALS] = data->normals;
    out[HAS_UV0] = data->uvs[0];
    out[HAS_UV1] = data->uvs[1];
    out[HAS_COLOURS] = data->colours;
    out[HAS_WALLS] = data->walls;
}

static size_t pack_of(const gpu_mesh_data *data)
{
    const float *arrays[ATTRIBUTES];
    size_t       number = 0;
    arrays_of(data, arrays);
    for (int i = 0; i < ATTRIBUTES; i++)
        number |= (size_t)(arrays[i] != NULL) << i;
    return number;
}

/* How often meshes of the scene are drawn. One that several nodes draw cannot carry what is known of each. */
uint32_t *upload_count_uses(const lmn_scene *scene)
{
    uint32_t *uses = mem_calloc(scene->mesh_count + 1, sizeof *uses);
    for (size_t i = 0; uses && i < scene->node_count; i++) {
        const node *n = &scene->nodes[i];
        size_t      count = n->mesh != NONE ? node_draw_count(n) : 0;
        if (count > 0)
            uses[n->mesh] += count > 1 ? 2 : 1;
    }
    return uses;
}

bool upload_packs(const upload *u, const upload_part_job *job, const gpu_mesh_data *data)
{
    return job->mesh_uses == 1 && data->vertex_count > 0 && data->vertex_count <= PACKED_VERTICES_MOST &&
           !job->former && !job->mesh->moved && !pose_part_deforms(job->pose) && !data->rest && !data->past[0] &&
           !data->tensors && !data->patches && !data->glue && u->key_count < UPLOAD_KEYS_MOST;
}

static bool grow(upload_pack *p, const float *const arrays[ATTRIBUTES], size_t vertices, size_t indices)
{
    const size_t needed = p->vertex_count + vertices;
    bool   good = mem_grow((void **)&p->indices, &p->index_capacity, p->index_count + indices, sizeof *p->indices);
    size_t capacity = p->vertex_capacity;
    good = good && mem_grow((void **)&p->positions, &capacity, needed, 3 * sizeof(float));
    for (int i = 0; i < ATTRIBUTES && good; i++) {
        size_t own = p->vertex_capacity;
        good = !arrays[i] || mem_grow((void **)&p->values[i], &own, needed, (size_t)components[i] * sizeof(float));
    }
    size_t own = p->vertex_capacity;
    good = good && mem_grow((void **)&p->keys, &own, needed, sizeof *p->keys);
    if (good)
        p->vertex_capacity = capacity;
    return good;
}

static void append(upload_pack *p, const gpu_mesh_data *data, const float *const arrays[ATTRIBUTES], uint32_t key)
{
    size_t vertices = data->vertex_count;
    memcpy(&p->positions[3 * p->vertex_count], data->positions, 3 * vertices * sizeof(float));
    for (int i = 0; i < ATTRIBUTES; i++)
        if (arrays[i])
            memcpy(&p->values[i][(size_t)components[i] * p->vertex_count], arrays[i],
                   (size_t)components[i] * vertices * sizeof(float));
    for (size_t i = 0; i < vertices; i++)
        p->keys[p->vertex_count + i] = key;
    for (size_t i = 0; i < data->index_count; i++)
        p->indices[p->index_count + i] = (uint32_t)p->vertex_count + data->indices[i];
    p->vertex_count += vertices;
    p->index_count += data->index_count;
}

static void forget(upload_pack *p)
{
    mem_free(p->positions);
    for (int i = 0; i < ATTRIBUTES; i++)
        mem_free(p->values[i]);
    mem_free(p->keys);
    mem_free(p->indices);
    *p = (upload_pack){.whole = NULL};
}

static void close_pack(upload_pack *p, gpu *g)
{
    if (p->whole)
        gpu_mesh_fill(g, p->whole,
                      &(gpu_mesh_data){.vertex_count = (uint32_t)p->vertex_count,
                                       .index_count = (uint32_t)p->index_count,
                                       .positions = p->positions,
                                       .normals = p->values[HAS_NORMALS],
                                       .uvs = {p->values[HAS_UV0], p->values[HAS_UV1]},
                                       .colours = p->values[HAS_COLOURS],
                                       .walls = p->values[HAS_WALLS],
                                       .keys = p->keys,
                                       .indices = p->indices});
    gpu_mesh_destroy(g, &p->whole);
    forget(p);
}

lmn_status upload_pack_add(upload *u, gpu *g, gpu_mesh **out, const gpu_mesh_data *data, lmn_error *error)
{
    const float *arrays[ATTRIBUTES];
    arrays_of(data, arrays);
    if (!u->packs && !(u->packs = mem_calloc((size_t)1 << ATTRIBUTES, sizeof *u->packs)))
        return error_memory(error);
    upload_pack *p = &u->packs[pack_of(data)];
    if (p->vertex_count + data->vertex_count > PACK_VERTICES)
        close_pack(p, g);
    if (!p->whole)
        p->whole = gpu_mesh_open(g);
    if (p->whole && !grow(p, arrays, data->vertex_count, data->index_count))
        return error_memory(error);
    uint32_t key = (uint32_t)u->key_count;
    *out = gpu_mesh_within(g, p->whole, (uint32_t)p->index_count, data->index_count, key);
    if (*out) {
        append(p, data, arrays, key);
        u->key_count++;
    }
    return gpu_check(g, error);
}

void upload_packs_close(upload *u, gpu *g)
{
    for (size_t i = 0; u->packs && i < (size_t)1 << ATTRIBUTES; i++)
        close_pack(&u->packs[i], g);
    mem_free(u->packs);
    u->packs = NULL;
}
