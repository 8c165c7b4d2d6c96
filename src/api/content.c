/* include/limner/content.h: checks arguments and forwards. */
#include "limner/content.h"

#include <math.h>
#include <string.h>

#include "api/check_content.h"
#include "api/complete.h"
#include "api/content_mesh.h"
#include "base/colour.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "scene/content.h"
#include "scene/solid.h"

/* --- arguments ------------------------------------------------------------------------------------------ */

static const double pi = 3.14159265358979323846;

static lmn_status check_matrix(const double *m, const char *caller, lmn_error *error)
{
    if (!m)
        return error_set(error, LMN_USAGE, "%s: the matrix is NULL", caller);
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return error_set(error, LMN_USAGE, "%s: number %d of the matrix is %g", caller, i, m[i]);
    if (m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1)
        return LMN_OK;
    error_set(error, LMN_USAGE, "%s: the last row is %g %g %g %g, not 0 0 0 1", caller, m[3], m[7], m[11], m[15]);
    error_hint(error, "numbers are given column after column, so a translation is numbers 12, 13 and 14");
    return LMN_USAGE;
}

static void give(uint32_t *out, size_t count)
{
    if (out)
        *out = (uint32_t)count;
}

static void settle_up(lmn_scene *scene)
{
    if (!scene->up)
        scene->up = 'y';
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static lmn_status make_mesh(primitive *out, const lmn_scene *scene, int32_t index, const lmn_mesh_desc *desc,
                            const char *caller, lmn_error *error)
{
    lmn_mesh_desc full = LMN_MESH_DESC_INIT;
    lmn_status    status = desc_complete(&full, sizeof full, desc, "LMN_MESH_DESC_INIT", error);
    if (status == LMN_OK)
        status = content_mesh_make(out, scene, &full, caller, error);
    if (status != LMN_OK)
        return status;
    status = scene_check_mesh(scene, index, out, error);
    if (status != LMN_OK)
        primitive_release(out);
    return status;
}

lmn_status lmn_scene_add_mesh(lmn_scene *scene, const lmn_mesh_desc *desc, uint32_t *out, lmn_error *error)
{
    primitive  p;
    char      *name = NULL;
    lmn_status status = content_check_scene(scene, "lmn_scene_add_mesh", error);
    if (status == LMN_OK)
        status = make_mesh(&p, scene, NONE, desc, "lmn_scene_add_mesh", error);
    if (status != LMN_OK)
        return status;
    mesh *m = content_copy_name(&name, desc->name) ? scene_append_mesh(scene) : NULL;
    if (m)
        m->revision = m->topology = scene_next_revision();
    status = m ? scene_exchange_mesh(scene, (int32_t)scene->mesh_count - 1, &p, error) : error_memory(error);
    if (status == LMN_OK) {
        scene->meshes[scene->mesh_count - 1].name = name;
        settle_up(scene);
        give(out, scene->mesh_count);
        return LMN_OK;
    }
    scene->mesh_count -= m != NULL;
    mem_free(name);
    primitive_release(&p);
    return status;
}

/* A mesh that can be exchanged: a single piece that no solid is made of. */
static lmn_status check_own_mesh(const lmn_scene *scene, uint32_t number, const char *caller, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, caller, error);
    if (status == LMN_OK && number == 0)
        return error_set(error, LMN_USAGE, "%s: the scene has no mesh 0", caller);
    if (status == LMN_OK)
        status = content_check_number(number, scene->mesh_count, "mesh", caller, error);
    if (status != LMN_OK)
        return status;
    const mesh *m = &scene->meshes[number - 1];
    if (m->spare || m->primitive_count != 1 || m->primitives[0].morph_count)
        return error_set(error, LMN_USAGE, "%s: mesh %u has %zu pieces or morph targets, and stays as it is", caller,
                         (unsigned)number, m->primitive_count);
    for (size_t i = 0; i < scene->solid_count; i++)
        for (size_t k = 0; k < scene->solids[i].node_count; k++)
            if (scene->solids[i].nodes[k].mesh == (int32_t)number - 1)
                return error_set(error, LMN_USAGE, "%s: mesh %u belongs to a solid", caller, (unsigned)number);
    return LMN_OK;
}

lmn_status lmn_scene_set_mesh(lmn_scene *scene, uint32_t number, const lmn_mesh_desc *desc, lmn_error *error)
{
    primitive  p;
    lmn_status status = check_own_mesh(scene, number, "lmn_scene_set_mesh", error);
    if (status == LMN_OK)
        status = make_mesh(&p, scene, (int32_t)number - 1, desc, "lmn_scene_set_mesh", error);
    if (status != LMN_OK)
        return status;
    status = scene_exchange_mesh(scene, (int32_t)number - 1, &p, error);
    if (status != LMN_OK)
        primitive_release(&p);
    return status;
}

lmn_status lmn_scene_set_positions(lmn_scene *scene, uint32_t number, const float *positions, const float *normals,
                                   size_t vertex_count, lmn_error *error)
{
    const char *caller = "lmn_scene_set_positions";
    vec3       *moved, *turned;
    lmn_status  status = check_own_mesh(scene, number, caller, error);
    if (status == LMN_OK && !positions)
        status = error_set(error, LMN_USAGE, "%s: `positions` is NULL", caller);
    if (status == LMN_OK && vertex_count != scene->meshes[number - 1].primitives[0].vertex_count)
        status = error_set(error, LMN_USAGE, "%s: %zu positions for %u vertices", caller, vertex_count,
                           (unsigned)scene->meshes[number - 1].primitives[0].vertex_count);
    if (status == LMN_OK)
        status = content_positions_make(&moved, &turned, positions, normals, vertex_count, caller, error);
    if (status != LMN_OK)
        return status;
    status = scene_exchange_positions(scene, (int32_t)number - 1, moved, turned, error);
    if (status != LMN_OK) {
        mem_free(moved);
        mem_free(turned);
    }
    return status;
}

/* --- materials and textures ----------------------------------------------------------------------------- */

lmn_status lmn_scene_add_texture(lmn_scene *scene, const char *name, int width, int height, const uint8_t *pixels,
                                 uint32_t *out, lmn_error *error)
{
    const char *caller = "lmn_scene_add_texture";
    lmn_status  status = content_check_scene(scene, caller, error);
    if (status == LMN_OK && !pixels)
        status = error_set(error, LMN_USAGE, "%s: `pixels` is NULL", caller);
    if (status == LMN_OK)
        status = content_check_range(width, 1, LIMIT_IMAGE_SIDE, "the width", caller, error);
    if (status == LMN_OK)
        status = content_check_range(height, 1, LIMIT_IMAGE_SIDE, "the height", caller, error);
    if (status != LMN_OK)
        return status;
    image  made = {.width = (uint32_t)width, .height = (uint32_t)height};
    bool   good = content_copy_name(&made.name, name);
    image *i = NULL;
    if (good && (made.pixels = mem_copy(pixels, (size_t)width * (size_t)height * 4)) != NULL)
        i = scene_append_image(scene);
    if (!i) {
        mem_free(made.name);
        mem_free(made.pixels);
        return error_memory(error);
    }
    *i = made;
    scene->revision = scene_next_revision();
    give(out, scene->image_count);
    return LMN_OK;
}

static lmn_status make_material(material *out, const lmn_scene *scene, const lmn_material_desc *desc,
                                const char *caller, lmn_error *error)
{
    lmn_material_desc full = LMN_MATERIAL_DESC_INIT;
    lmn_status        status = desc_complete(&full, sizeof full, desc, "LMN_MATERIAL_DESC_INIT", error);
    for (int i = 0; i < 4 && status == LMN_OK; i++)
        status = content_check_range((double)full.colour[i], 0, 1, "a number of the colour", caller, error);
    if (status == LMN_OK)
        status = content_check_range((double)full.alpha_cutoff, 0, 1, "alpha_cutoff", caller, error);
    if (status == LMN_OK)
        status = content_check_number(full.texture, scene->image_count, "texture", caller, error);
    if (status != LMN_OK)
        return status;
    const float *c = full.colour;
    *out = (material){.base_colour = {colour_to_linear(c[0]), colour_to_linear(c[1]), colour_to_linear(c[2]), c[3]},
                      .base_texture = TEXTURE_USE_NONE,
                      .normal_texture = TEXTURE_USE_NONE,
                      .normal_scale = 1,
                      .alpha = full.alpha_cutoff > 0 ? ALPHA_MASK
                               : c[3] < 1            ? ALPHA_BLEND
                                                     : ALPHA_OPAQUE,
                      .alpha_cutoff = full.alpha_cutoff,
                      .unlit = full.unlit};
    out->base_texture.image = content_index(full.texture);
    return content_copy_name(&out->name, full.name) ? LMN_OK : error_memory(error);
}

lmn_status lmn_scene_add_material(lmn_scene *scene, const lmn_material_desc *desc, uint32_t *out, lmn_error *error)
{
    material   made;
    lmn_status status = content_check_scene(scene, "lmn_scene_add_material", error);
    if (status == LMN_OK)
        status = make_material(&made, scene, desc, "lmn_scene_add_material", error);
    if (status != LMN_OK)
        return status;
    material *m = scene_append_material(scene);
    if (!m) {
        mem_free(made.name);
        return error_memory(error);
    }
    *m = made;
    scene->revision = scene_next_revision();
    give(out, scene->material_count);
    return LMN_OK;
}

lmn_status lmn_scene_set_material(lmn_scene *scene, uint32_t number, const lmn_material_desc *desc, lmn_error *error)
{
    const char *caller = "lmn_scene_set_material";
    material    made;
    lmn_status  status = content_check_scene(scene, caller, error);
    if (status == LMN_OK && (number == 0 || number > scene->material_count))
        status = error_set(error, LMN_USAGE, "%s: the scene has no material %u", caller, (unsigned)number);
    if (status == LMN_OK)
        status = make_material(&made, scene, desc, caller, error);
    if (status != LMN_OK)
        return status;
    mem_free(scene->materials[number - 1].name);
    scene->materials[number - 1] = made;
    scene->revision = scene_next_revision();
    return LMN_OK;
}

/* --- cameras, lights, skins ----------------------------------------------------------------------------- */

lmn_status lmn_scene_add_camera(lmn_scene *scene, const lmn_camera_desc *desc, uint32_t *out, lmn_error *error)
{
    const char     *caller = "lmn_scene_add_camera";
    lmn_camera_desc full = LMN_CAMERA_DESC_INIT;
    char           *name = NULL;
    lmn_status      status = content_check_scene(scene, caller, error);
    if (status == LMN_OK)
        status = desc_complete(&full, sizeof full, desc, "LMN_CAMERA_DESC_INIT", error);
    if (status == LMN_OK && !full.orthographic)
        status = content_check_range(full.fov_deg, 1, 170, "fov_deg", caller, error);
    if (status == LMN_OK && full.orthographic)
        status = content_check_range(full.half_height, 1e-18, 1e18, "half_height", caller, error);
    if (status != LMN_OK)
        return status;
    camera *c = content_copy_name(&name, full.name) ? scene_append_camera(scene) : NULL;
    if (!c) {
        mem_free(name);
        return error_memory(error);
    }
    *c = (camera){.name = name,
                  .orthographic = full.orthographic,
                  .fov_y = full.fov_deg * (pi / 180),
                  .half_height = full.half_height};
    scene->revision = scene_next_revision();
    give(out, scene->camera_count);
    return LMN_OK;
}

static lmn_status check_light(const lmn_light_desc *d, const char *caller, lmn_error *error)
{
    lmn_status status =
        content_check_range((double)d->type, LMN_LIGHT_DIRECTIONAL, LMN_LIGHT_SPOT, "the type", caller, error);
    for (int i = 0; i < 3 && status == LMN_OK; i++)
        status = content_check_range((double)d->colour[i], 0, 1, "a number of the colour", caller, error);
    if (status == LMN_OK)
        status = content_check_range((double)d->intensity, 0, 1e9, "the intensity", caller, error);
    if (status == LMN_OK && d->type == LMN_LIGHT_SPOT)
        status = content_check_range((double)d->outer_cone, 0.01, 90, "outer_cone", caller, error);
    if (status == LMN_OK && d->type == LMN_LIGHT_SPOT && !(d->inner_cone >= 0 && d->inner_cone < d->outer_cone))
        status = error_set(error, LMN_USAGE, "%s: inner_cone is %g, not 0 to less than outer_cone (%g)", caller,
                           (double)d->inner_cone, (double)d->outer_cone);
    return status;
}

lmn_status lmn_scene_add_light(lmn_scene *scene, const lmn_light_desc *desc, uint32_t *out, lmn_error *error)
{
    const char    *caller = "lmn_scene_add_light";
    lmn_light_desc full = LMN_LIGHT_DESC_INIT;
    char          *name = NULL;
    lmn_status     status = content_check_scene(scene, caller, error);
    if (status == LMN_OK)
        status = desc_complete(&full, sizeof full, desc, "LMN_LIGHT_DESC_INIT", error);
    if (status == LMN_OK)
        status = check_light(&full, caller, error);
    if (status != LMN_OK)
        return status;
    light *l = content_copy_name(&name, full.name) ? scene_append_light(scene) : NULL;
    if (!l) {
        mem_free(name);
        return error_memory(error);
    }
    l->name = name;
    l->type = (light_type)full.type; /* both count in the same order */
    for (int i = 0; i < 3; i++)
        l->colour[i] = colour_to_linear(full.colour[i]);
    l->intensity = full.intensity;
    l->inner_cone = full.inner_cone * (float)(pi / 180);
    l->outer_cone = full.outer_cone * (float)(pi / 180);
    scene->revision = scene_next_revision();
    give(out, scene->light_count);
    return LMN_OK;
}

static lmn_status check_skin(const lmn_scene *scene, const uint32_t *joints, const double *binds, size_t count,
                             const char *caller, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, caller, error);
    if (status == LMN_OK && (!joints || !binds))
        status = error_set(error, LMN_USAGE, "%s: `%s` is NULL", caller, joints ? "inverse_binds" : "joints");
    if (status == LMN_OK)
        status = content_check_range((double)count, 1, UINT16_MAX, "the number of joints", caller, error);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        status = content_check_node(scene, joints[i], caller, error);
        if (status == LMN_OK)
            status = check_matrix(&binds[16 * i], caller, error);
    }
    return status;
}

lmn_status lmn_scene_add_skin(lmn_scene *scene, const uint32_t *joints, const double *inverse_binds, size_t joint_count,
                              uint32_t *out, lmn_error *error)
{
    lmn_status status = check_skin(scene, joints, inverse_binds, joint_count, "lmn_scene_add_skin", error);
    if (status != LMN_OK)
        return status;
    int32_t *nodes = mem_alloc(joint_count * sizeof *nodes);
    mat4    *binds = mem_copy(inverse_binds, joint_count * sizeof *binds);
    skin    *s = nodes && binds ? scene_append_skin(scene) : NULL;
    if (!s) {
        mem_free(nodes);
        mem_free(binds);
        return error_memory(error);
    }
    for (size_t i = 0; i < joint_count; i++)
        nodes[i] = (int32_t)joints[i] - 1;
    *s = (skin){.joints = nodes, .inverse_binds = binds, .joint_count = joint_count};
    scene->revision = scene_next_revision();
    give(out, scene->skin_count);
    return LMN_OK;
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

static lmn_status check_joints(const lmn_scene *scene, const lmn_node_desc *d, const char *caller, lmn_error *error)
{
    if (!d->skin)
        return LMN_OK;
    const mesh *m = d->mesh ? &scene->meshes[d->mesh - 1] : NULL;
    const skin *s = &scene->skins[d->skin - 1];
    if (!m)
        return error_set(error, LMN_USAGE, "%s: a skin without a mesh", caller);
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; p->joints && k < (size_t)p->vertex_count * p->influences; k++)
            if (p->joints[k] >= s->joint_count)
                return error_set(error, LMN_USAGE, "%s: mesh %u uses joint %u, but skin %u has only %zu", caller,
                                 (unsigned)d->mesh, (unsigned)p->joints[k], (unsigned)d->skin, s->joint_count);
    }
    return LMN_OK;
}

static lmn_status check_node_desc(const lmn_scene *scene, const lmn_node_desc *d, const char *caller, lmn_error *error)
{
    lmn_status status = d->parent ? content_check_node(scene, d->parent, caller, error) : LMN_OK;
    if (status == LMN_OK)
        status = content_check_number(d->mesh, scene->mesh_count, "mesh", caller, error);
    if (status == LMN_OK && d->mesh && scene->meshes[d->mesh - 1].spare)
        status = error_set(error, LMN_USAGE, "%s: the scene has no mesh %u", caller, (unsigned)d->mesh);
    if (status == LMN_OK)
        status = content_check_number(d->camera, scene->camera_count, "camera", caller, error);
    if (status == LMN_OK)
        status = content_check_number(d->light, scene->light_count, "light", caller, error);
    if (status == LMN_OK)
        status = content_check_number(d->skin, scene->skin_count, "skin", caller, error);
    if (status == LMN_OK)
        status = check_joints(scene, d, caller, error);
    return status == LMN_OK ? check_matrix(d->matrix, caller, error) : status;
}

lmn_status lmn_scene_add_node(lmn_scene *scene, const lmn_node_desc *desc, uint32_t *out, lmn_error *error)
{
    const char   *caller = "lmn_scene_add_node";
    lmn_node_desc full = LMN_NODE_DESC_INIT;
    lmn_status    status = content_check_scene(scene, caller, error);
    if (status == LMN_OK)
        status = desc_complete(&full, sizeof full, desc, "LMN_NODE_DESC_INIT", error);
    if (status == LMN_OK)
        status = check_node_desc(scene, &full, caller, error);
    if (status != LMN_OK)
        return status;
    node n = {.parent = content_index(full.parent),
              .first_child = NONE,
              .next_sibling = NONE,
              .last_child = NONE,
              .mesh = content_index(full.mesh),
              .skin = content_index(full.skin),
              .camera = content_index(full.camera),
              .light = content_index(full.light),
              .solid = NONE};
    mat4 matrix;
    memcpy(matrix.m, full.matrix, sizeof matrix.m);
    status = content_copy_name(&n.name, full.name) && node_set_matrix(&n, &matrix) ? scene_add_node(scene, &n, error)
                                                                                   : error_memory(error);
    if (status != LMN_OK) {
        mem_free(n.place);
        mem_free(n.name);
        return status;
    }
    settle_up(scene);
    give(out, scene->node_count);
    return LMN_OK;
}

uint32_t lmn_scene_node_of_part(const lmn_scene *scene, uint32_t part)
{
    return scene && part > 0 && part <= scene->part_count ? (uint32_t)scene->parts[part - 1].node + 1 : 0;
}

lmn_status lmn_scene_set_matrix(lmn_scene *scene, uint32_t node_number, const double matrix[16], lmn_error *error)
{
    mat4       m;
    lmn_status status = content_check_node(scene, node_number, "lmn_scene_set_matrix", error);
    if (status == LMN_OK)
        status = check_matrix(matrix, "lmn_scene_set_matrix", error);
    if (status != LMN_OK)
        return status;
    memcpy(m.m, matrix, sizeof m.m);
    return scene_move_node(scene, (int32_t)node_number - 1, &m, error);
}

lmn_status lmn_scene_set_instances(lmn_scene *scene, uint32_t node_number, const double *matrices, size_t count,
                                   lmn_error *error)
{
    const char *caller = "lmn_scene_set_instances";
    lmn_status  status = content_check_node(scene, node_number, caller, error);
    if (status == LMN_OK && scene->nodes[node_number - 1].mesh == NONE)
        status = error_set(error, LMN_USAGE, "%s: node %u has no mesh", caller, (unsigned)node_number);
    if (status == LMN_OK && count > LIMIT_INSTANCES)
        status = error_set(error, LMN_LIMIT, "%s: more than %zu instances", caller, LIMIT_INSTANCES);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        status = check_matrix(matrices ? &matrices[16 * i] : NULL, caller, error);
    if (status != LMN_OK)
        return status;
    mat4 *copy = count ? mem_copy(matrices, count * sizeof *copy) : NULL;
    if (count && !copy)
        return error_memory(error);
    status = scene_set_instances(scene, (int32_t)node_number - 1, copy, count, error);
    if (status != LMN_OK)
        mem_free(copy);
    return status;
}

lmn_status lmn_scene_set_visible(lmn_scene *scene, uint32_t node_number, bool visible, lmn_error *error)
{
    lmn_status status = content_check_node(scene, node_number, "lmn_scene_set_visible", error);
    if (status == LMN_OK)
        scene_hide_node(scene, (int32_t)node_number - 1, !visible);
    return status;
}

lmn_status lmn_scene_set_attribute(lmn_scene *scene, uint32_t node_number, const char *key, const char *value,
                                   lmn_error *error)
{
    lmn_status status = content_check_node(scene, node_number, "lmn_scene_set_attribute", error);
    if (status == LMN_OK && (!key || !key[0]))
        status = error_set(error, LMN_USAGE, "lmn_scene_set_attribute: the key is empty");
    return status == LMN_OK ? scene_set_attribute(scene, (int32_t)node_number - 1, key, value, error) : status;
}

lmn_status lmn_scene_remove_node(lmn_scene *scene, uint32_t node_number, lmn_error *error)
{
    lmn_status status = content_check_node(scene, node_number, "lmn_scene_remove_node", error);
    return status == LMN_OK ? scene_remove_node(scene, (int32_t)node_number - 1, error) : status;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

lmn_status lmn_scene_set_up(lmn_scene *scene, lmn_up_axis up, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, "lmn_scene_set_up", error);
    if (status == LMN_OK && up != LMN_UP_Y && up != LMN_UP_Z)
        status = error_set(error, LMN_USAGE, "lmn_scene_set_up: %d is neither LMN_UP_Y nor LMN_UP_Z", (int)up);
    if (status == LMN_OK && (scene->node_count > 0 || scene->mesh_count > 0)) {
        status = error_set(error, LMN_USAGE, "lmn_scene_set_up: the scene has content already");
        error_hint(error, "call it before the first mesh, node, solid or file");
    }
    if (status == LMN_OK)
        scene->up = up == LMN_UP_Z ? 'z' : 'y';
    return status;
}

lmn_status lmn_scene_begin_changes(lmn_scene *scene, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, "lmn_scene_begin_changes", error);
    if (status == LMN_OK)
        scene_begin_changes(scene);
    return status;
}

lmn_status lmn_scene_end_changes(lmn_scene *scene, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, "lmn_scene_end_changes", error);
    return status == LMN_OK ? scene_end_changes(scene, error) : status;
}
