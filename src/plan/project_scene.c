/* A scene as a projection has it: what is posed and placed is bent, and lies in a scene of its own whose nodes move
 * nothing. So that all who draw scenes draw it, none of them knows of projections. */
#include "plan/project_scene.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "plan/project_mesh.h"
#include "plan/refuse.h"
#include "plan/time.h"
#include "pose/pose.h"

static bool copy_text(char **out, const char *from)
{
    *out = from ? mem_copy_text(from) : NULL;
    return *out || !from;
}

static bool copy_images(lmn_scene *to, const lmn_scene *from)
{
    for (size_t i = 0; i < from->image_count; i++) {
        const image *source = &from->images[i];
        image       *made = scene_append_image(to);
        if (!made || !copy_text(&made->name, source->name) || !copy_text(&made->strokes, source->strokes))
            return false;
        made->width = source->width;
        made->height = source->height;
        made->pixels = source->pixels ? mem_copy(source->pixels, 4 * (size_t)source->width * source->height) : NULL;
        if (source->pixels && !made->pixels)
            return false;
    }
    return true;
}

/* What parts look like, and what is known of all of them. */
static bool copy_appearance(lmn_scene *to, const lmn_scene *from)
{
    bool good = copy_images(to, from);
    for (size_t i = 0; i < from->material_count && good; i++) {
        material *made = scene_append_material(to);
        good = made != NULL;
        if (good) {
            *made = from->materials[i];
            good = copy_text(&made->name, from->materials[i].name);
        }
    }
    for (size_t i = 0; i < from->file_count && good; i++) {
        good = mem_grow((void **)&to->files, &to->file_capacity, to->file_count + 1, sizeof *to->files) &&
               copy_text(&to->files[to->file_count], from->files[i]);
        to->file_count += good;
    }
    for (size_t i = 0; i < from->city.count_count && good; i++)
        good = city_add(&to->city, from->city.counts[i].group, from->city.counts[i].name, from->city.counts[i].count);
    warnings_append(&to->warnings, &from->warnings);
    to->up = from->up;
    to->load_ms = from->load_ms;
    return good;
}

static bool copy_node(lmn_scene *to, const node *from)
{
    node *n = scene_append_node(to);
    if (!n)
        return false;
    n->parent = from->parent;
    n->first_child = from->first_child;
    n->last_child = from->last_child;
    n->next_sibling = from->next_sibling;
    n->hidden = from->hidden;
    n->removed = from->removed;
    n->numbered = from->numbered;
    n->attributes = from->attribute_count ? mem_alloc(from->attribute_count * sizeof *n->attributes) : NULL;
    bool good = copy_text(&n->name, from->name) && (n->attributes || !from->attribute_count);
    for (size_t i = 0; i < from->attribute_count && good; i++) {
        good = attribute_make(&n->attributes[i], from->attributes[i].key, from->attributes[i].value);
        n->attribute_count = (uint32_t)i + good;
    }
    return good;
}

/* What stands somewhere without being bent gets a node of its own, behind all others. */
static node *place_node(lmn_scene *to, const node *from, const mat4 *world)
{
    node *n = scene_append_node(to);
    return n && copy_text(&n->name, from->name) && node_set_matrix(n, world) ? n : NULL;
}

static bool copy_viewers(lmn_scene *to, const lmn_scene *from, const pose *p)
{
    bool good = true;
    for (size_t i = 0; i < from->node_count && good; i++) {
        const node *source = &from->nodes[i];
        if (source->light != NONE) {
            light *made = scene_append_light(to);
            node  *n = made ? place_node(to, source, &p->worlds[i]) : NULL;
            good = n != NULL;
            if (good) {
                *made = p->lights[source->light];
                n->light = (int32_t)to->light_count - 1;
                good = copy_text(&made->name, from->lights[source->light].name);
            }
        }
        if (source->camera != NONE && good) {
            camera *made = scene_append_camera(to);
            node   *n = made ? place_node(to, source, &p->worlds[i]) : NULL;
            good = n != NULL;
            if (good) {
                *made = p->cameras[source->camera];
                n->camera = (int32_t)to->camera_count - 1;
                good = copy_text(&made->name, from->cameras[source->camera].name);
            }
        }
    }
    return good;
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static lmn_status bend_primitive(projected_primitive *to, const projection_map *map, const pose *p, size_t part,
                                 const primitive *from, lmn_error *error)
{
    const part_pose *own = &p->parts[part];
    const node      *n = &p->scene->nodes[p->scene->parts[part].node];
    vec3            *moved = NULL, *turned = NULL;
    lmn_status       status = LMN_OK;
    if (pose_deforms(own, from)) {
        moved = mem_alloc((size_t)from->vertex_count * sizeof *moved);
        turned = from->normals ? mem_alloc((size_t)from->vertex_count * sizeof *turned) : NULL;
        if (!moved || (from->normals && !turned))
            status = error_memory(error);
        else
            pose_vertices(own, from, from->normals, NULL, from->vertex_count, moved, turned);
    }
    for (size_t k = 0; k < node_draw_count(n) && status == LMN_OK; k++) {
        mat4 world = pose_instance(p, part, k);
        status = project_primitive(to, map, from, moved ? moved : from->positions, turned ? turned : from->normals,
                                   &world, error);
    }
    mem_free(moved);
    mem_free(turned);
    return status;
}

static lmn_status bend_part(lmn_scene *to, const projection_map *map, const pose *p, size_t part, lmn_error *error)
{
    int32_t     node_index = p->scene->parts[part].node;
    const mesh *from = &p->scene->meshes[p->scene->nodes[node_index].mesh];
    mesh       *made = scene_append_mesh(to);
    lmn_status  status = made && copy_text(&made->name, from->name) ? LMN_OK : error_memory(error);
    if (status == LMN_OK && !(made->primitives = mem_calloc(from->primitive_count, sizeof *made->primitives)))
        status = error_memory(error);
    for (size_t i = 0; i < from->primitive_count && status == LMN_OK; i++) {
        projected_primitive bent = {.slots = NULL};
        status = bend_primitive(&bent, map, p, part, &from->primitives[i], error);
        if (status == LMN_OK && (bent.out.index_count || bent.out.line_count))
            project_finish(&bent, &made->primitives[made->primitive_count++]);
        project_release(&bent);
    }
    if (status == LMN_OK)
        to->nodes[node_index].mesh = (int32_t)to->mesh_count - 1;
    return status;
}

static lmn_status bend_all(lmn_scene *to, const projection_map *map, const pose *p, lmn_error *error)
{
    const lmn_scene *from = p->scene;
    lmn_status       status = copy_appearance(to, from) ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < from->node_count && status == LMN_OK; i++)
        status = copy_node(to, &from->nodes[i]) ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < from->part_count && status == LMN_OK; i++)
        if (from->nodes[from->parts[i].node].mesh != NONE)
            status = bend_part(to, map, p, i, error);
    if (status == LMN_OK && !copy_viewers(to, from, p))
        status = error_memory(error);
    return status == LMN_OK ? scene_finish(to, from->file_count ? from->files[0] : "", error) : status;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

static lmn_status check(const lmn_scene *scene, const lmn_draw_desc *desc, warnings *warned, lmn_error *error)
{
    if (desc->matrices_given)
        return error_set(error, LMN_UNSUPPORTED, "a projection takes the place of the matrices that are given");
    if (desc->fit_time)
        return error_set(error, LMN_UNSUPPORTED, "a scene that is bent stands still: it cannot be fitted to all times");
    for (size_t i = 0; i < scene->part_count; i++) {
        if (scene->nodes[scene->parts[i].node].solid == NONE)
            continue;
        if (desc->lenient) {
            warnings_add(warned, WARNING_REDUCED, "part '%.100s' is a solid, which cannot be bent, and is left out",
                         scene->parts[i].name);
        } else {
            error_in_file(error, LMN_UNSUPPORTED, refuse_file(scene), 0,
                          "part '%.100s' is a solid of set operations, which cannot be bent", scene->parts[i].name);
            error_hint(error, "write it as a mesh first");
            return LMN_UNSUPPORTED;
        }
    }
    return LMN_OK;
}

/* Where the viewer is who sees it without the projection. */
static lmn_status place_viewer(view_camera *out, const pose *p, const lmn_draw_desc *desc, lmn_error *error)
{
    bool *all = mem_calloc(p->part_count + p->ghost_count + 1, sizeof *all);
    if (!all)
        return error_memory(error);
    for (size_t i = 0; i < p->part_count; i++)
        all[i] = true;
    fit_body body = {
        .pose = p, .fitted = all, .ghost_boxes = p->part_boxes, .part_count = p->part_count, .box = p->box};
    lmn_status status = camera_place(out, desc, p, &body, error);
    mem_free(all);
    return status;
}

/* A camera of the file keeps its place; what the map changes of the view is said by numbers. */
static void say_view(lmn_draw_desc *desc, const view_camera *c)
{
    if (!desc->camera)
        return;
    desc->camera = NULL;
    desc->eye_given = true;
    desc->orthographic = c->orthographic;
    desc->fov_deg = fmin(fmax(c->fov_y * (180 / 3.14159265358979323846), 1), 170);
    for (int k = 0; k < 3; k++) {
        desc->eye[k] = c->eye[k];
        desc->target[k] = c->target[k];
        desc->up[k] = c->up[k];
    }
}

/* North is +Y where Z is up, as surveyors have it, and −Z where Y is. */
static void keep_directions(lmn_scene *to, const projection_map *map, char up)
{
    const double north[3] = {0, up == 'z' ? 1 : 0, up == 'z' ? 0 : -1}, zenith[3] = {0, up != 'z', up == 'z'};
    projection_lean(map, north, to->north);
    projection_lean(map, zenith, to->zenith);
}

lmn_status project_scene(lmn_scene **out, const lmn_scene *scene, lmn_draw_desc *desc, const lmn_projection_desc *how,
                         lmn_error *error)
{
    projection_map map = {.row = projection_row_of((int)how->projection)};
    lmn_scene     *made = NULL;
    warnings       warned = {0};
    moment         when;
    pose           p = {.scene = NULL};
    view_camera    viewer;
    lmn_status     status = check(scene, desc, &warned, error);
    if (status == LMN_OK)
        status = time_moment(&when, scene, desc, &warned, error);
    if (status == LMN_OK)
        status = pose_create(&p, scene, &when, error);
    if (status == LMN_OK)
        status = place_viewer(&viewer, &p, desc, error);
    if (status == LMN_OK) {
        say_view(desc, &viewer);
        status = map.row->lay(&map, &viewer, p.box, scene->up == 'z' ? 2 : 1, how, desc, error);
    }
    if (status == LMN_OK && !(made = scene_new()))
        status = error_memory(error);
    if (status == LMN_OK)
        warnings_append(&made->warnings, &warned);
    if (status == LMN_OK)
        status = bend_all(made, &map, &p, error);
    if (status == LMN_OK)
        keep_directions(made, &map, scene->up);
    if (status != LMN_OK) {
        scene_free(made);
        made = NULL;
    } else {
        desc->time_s = 0;
        desc->time_given = false;
        desc->clip = NULL;
    }
    pose_release(&p);
    warnings_release(&warned);
    *out = made;
    return status;
}
