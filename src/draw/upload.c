#include "draw/upload.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "scene/mesh.h"


static void *gather(const void *source, const uint32_t *map, uint32_t count, size_t size)
{
    if (!source)
        return NULL;
    unsigned char *out = mem_alloc((size_t)count * size);
    for (uint32_t i = 0; out && i < count; i++)
        memcpy(out + (size_t)i * size, (const unsigned char *)source + (size_t)map[i] * size, size);
    return out;
}

/* Positions and normals in the pose, split where the crease angle asks for it. Frees nothing of the primitive. */
static lmn_status make_mesh(gpu_mesh **out, gpu *g, const primitive *p, const render_vertices *split, const mat4 *joints,
                            size_t joint_count, const float *weights, size_t weight_count, lmn_error *error)
{
    uint32_t count = split->vertex_count;
    const vec3 *normals = split->normals ? split->normals : p->normals;
    bool posed = joints || (weights && p->morph_count);
    vec3 *positions = NULL, *posed_normals = NULL;
    vec2 *uvs[UV_SETS] = {NULL};
    vec4 *colours = NULL;
    lmn_status status = LMN_OK;
    gpu_mesh_data data = {.vertex_count = count, .index_count = p->index_count,
                          .indices = split->indices ? split->indices : p->indices, .normals = (const float *)normals,
                          .positions = (const float *)p->positions, .colours = (const float *)p->colours};
    if (posed) {
        positions = mem_alloc(sizeof(vec3) * (size_t)count);
        posed_normals = mem_alloc(sizeof(vec3) * (size_t)count);
        if (!positions || !posed_normals)
            status = error_memory(error);
        else
            mesh_pose(p, weights, weight_count, joints, joint_count, normals, split->source, count, positions, posed_normals);
        data.positions = (const float *)positions;
        data.normals = (const float *)posed_normals;
    } else if (split->source) {
        positions = gather(p->positions, split->source, count, sizeof(vec3));
        data.positions = (const float *)positions;
    }
    for (int i = 0; i < UV_SETS; i++) {
        uvs[i] = split->source ? gather(p->uvs[i], split->source, count, sizeof(vec2)) : NULL;
        data.uvs[i] = (const float *)(split->source ? uvs[i] : p->uvs[i]);
    }
    if (split->source)
        data.colours = (const float *)(colours = gather(p->colours, split->source, count, sizeof(vec4)));
    if (status == LMN_OK && (!data.positions || !data.normals))
        status = error_memory(error);
    if (status == LMN_OK) {
        *out = gpu_mesh_create(g, &data);
        status = gpu_check(g, error);
    }
    mem_free(positions);
    mem_free(posed_normals);
    for (int i = 0; i < UV_SETS; i++)
        mem_free(uvs[i]);
    mem_free(colours);
    return status;
}

static lmn_status upload_primitive(upload *u, gpu *g, gpu_mesh **out, const primitive *p, const mat4 *joints, size_t joint_count,
                                   const float *weights, size_t weight_count, lmn_error *error)
{
    render_vertices split = {.vertex_count = p->vertex_count, .index_count = p->index_count};
    lmn_status status = LMN_OK;
    if (!p->normals)
        status = mesh_make_normals(&split, p, u->crease_angle, error);
    if (status == LMN_OK)
        status = make_mesh(out, g, p, &split, joints, joint_count, weights, weight_count, error);
    render_vertices_release(&split);
    if (status != LMN_OK)
        return status;
    if (!mem_grow((void **)&u->meshes, &u->mesh_capacity, u->mesh_count + 1, sizeof *u->meshes)) {
        gpu_mesh_destroy(g, out);
        return error_memory(error);
    }
    u->meshes[u->mesh_count++] = *out;
    u->bytes += gpu_mesh_bytes(*out);
    return LMN_OK;
}

/* Joint matrices in world axes: world · inverse bind. */
static mat4 *joint_matrices(const lmn_scene *scene, const mat4 *worlds, const skin *s)
{
    mat4 *out = mem_alloc(sizeof(mat4) * (s->joint_count ? s->joint_count : 1));
    for (size_t i = 0; out && i < s->joint_count; i++)
        out[i] = s->inverse_binds ? mat4_multiply(&worlds[s->joints[i]], &s->inverse_binds[i]) : worlds[s->joints[i]];
    (void)scene;
    return out;
}

static bool add_item(upload *u, const draw_item *item)
{
    if (!mem_grow((void **)&u->items, &u->item_capacity, u->item_count + 1, sizeof *u->items))
        return false;
    u->items[u->item_count++] = *item;
    return true;
}

static lmn_status upload_part(upload *u, gpu *g, const lmn_scene *scene, size_t part_index, gpu_mesh **shared, lmn_error *error)
{
    const node *n = &scene->nodes[scene->parts[part_index].node];
    const mesh *m = &scene->meshes[n->mesh];
    const skin *s = n->skin >= 0 ? &scene->skins[n->skin] : NULL;
    const float *weights = n->morph_weights ? n->morph_weights : m->morph_weights;
    size_t weight_count = n->morph_weights ? n->morph_weight_count : m->morph_weight_count;
    mat4 *joints = s ? joint_matrices(scene, u->worlds, s) : NULL;
    if (s && !joints)
        return error_memory(error);
    bool own = s || weight_count > 0;
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < m->primitive_count && status == LMN_OK; i++) {
        const primitive *p = &m->primitives[i];
        if (p->index_count == 0)
            continue;
        gpu_mesh *mesh_on_gpu = own ? NULL : shared[i];
        if (!mesh_on_gpu) {
            status = upload_primitive(u, g, &mesh_on_gpu, p, joints, s ? s->joint_count : 0, weights, weight_count, error);
            if (status != LMN_OK)
                break;
            if (!own)
                shared[i] = mesh_on_gpu;
        }
        size_t copies = n->instance_count ? n->instance_count : 1;
        u->triangles += (uint64_t)(p->index_count / 3) * copies;
        for (size_t k = 0; k < copies && status == LMN_OK; k++) {
            /* A skin's joints already carry world places; the node's own matrix does not count (glTF 2.0, section 3.7.3.3). */
            mat4 world = s ? mat4_identity() : u->worlds[scene->parts[part_index].node];
            if (n->instance_count)
                world = mat4_multiply(&world, &n->instances[k]);
            draw_item item = {.mesh = mesh_on_gpu, .world = world, .part_id = (uint32_t)part_index + 1,
                              .surface_id = (uint32_t)i + 1, .part_index = part_index, .material = p->material,
                              .has_uvs = p->uvs[0] || p->uvs[1], .has_colours = p->colours != NULL};
            if (!add_item(u, &item))
                status = error_memory(error);
        }
    }
    mem_free(joints);
    return status;
}

lmn_status upload_create(upload *out, gpu *g, const lmn_scene *scene, double crease_angle, lmn_progress_fn progress, void *user,
                         lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->revision = scene->revision;
    out->crease_angle = crease_angle;
    out->worlds = scene_world_matrices(scene);
    out->part_count = scene->part_count;
    out->part_boxes = mem_calloc(scene->part_count, sizeof *out->part_boxes);
    out->texture_count = scene->image_count * 2;
    out->textures = mem_calloc(out->texture_count, sizeof(gpu_texture *));
    size_t *first = mem_calloc(scene->mesh_count + 1, sizeof *first);
    size_t total = 0;
    for (size_t i = 0; first && i < scene->mesh_count; i++) {
        first[i] = total;
        total += scene->meshes[i].primitive_count;
    }
    gpu_mesh **shared = mem_calloc(total, sizeof *shared);
    lmn_status status = LMN_OK;
    if (!out->worlds || !out->part_boxes || !out->textures || !first || !shared)
        status = error_memory(error);
    for (size_t i = 0; i < scene->part_count && status == LMN_OK; i++) {
        if (progress && !progress((double)i / (double)scene->part_count, "preparing", user))
            status = error_set(error, LMN_CANCELLED, "cancelled");
        if (status == LMN_OK)
            status = upload_part(out, g, scene, i, &shared[first[scene->nodes[scene->parts[i].node].mesh]], error);
        out->part_boxes[i] = part_bounds(scene, out->worlds, i);
    }
    mem_free(first);
    mem_free(shared);
    return status;
}

void upload_release(upload *u, gpu *g)
{
    for (size_t i = 0; i < u->mesh_count; i++)
        gpu_mesh_destroy(g, &u->meshes[i]);
    for (size_t i = 0; i < u->texture_count && u->textures; i++)
        gpu_texture_destroy(g, &u->textures[i]);
    mem_free(u->meshes);
    mem_free(u->textures);
    mem_free(u->items);
    mem_free(u->worlds);
    mem_free(u->part_boxes);
    memset(u, 0, sizeof *u);
}

static gpu_wrap wrap_of(wrap_mode wrap)
{
    return wrap == WRAP_REPEAT ? GPU_REPEAT : wrap == WRAP_MIRROR ? GPU_MIRROR : GPU_CLAMP;
}

gpu_texture *upload_texture(upload *u, gpu *g, const lmn_scene *scene, const texture_use *use, bool linear)
{
    if (use->image < 0 || !scene->images[use->image].pixels)
        return NULL;
    gpu_texture **slot = &u->textures[2 * (size_t)use->image + linear];
    const image *i = &scene->images[use->image];
    if (!*slot)
        *slot = gpu_texture_create(g, (int)i->width, (int)i->height, linear ? GPU_RGBA8 : GPU_SRGB8, i->pixels, use->nearest,
                                   wrap_of(use->wrap_u), wrap_of(use->wrap_v));
    return *slot;
}
