#include "depict/depict.h"

#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "depict/depict_private.h"
#include "plan/time.h"
#include "scene/content.h"

static const char root_name[] = "glyphs", hidden_key[] = "depicted";

extern const depiction depiction_path, depiction_still, depiction_still_plane, depiction_motion;

const depiction *const depictions[] = {&depiction_path, &depiction_motion, &depiction_still, &depiction_still_plane,
                                       NULL};

/* --- taking glyphs out
 * ------------------------------------------------------------------------------------------------ */

static const char *attribute_of(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0)
            return n->attributes[i].value;
    return NULL;
}

static bool is_root(const node *n)
{
    return n->parent == NONE && !n->removed && attribute_of(n, root_name);
}

static lmn_status take_out(lmn_scene *scene, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < scene->node_count && status == LMN_OK; i++) {
        if (is_root(&scene->nodes[i]))
            status = scene_remove_node(scene, (int32_t)i, error);
        else if (attribute_of(&scene->nodes[i], hidden_key)) {
            scene_hide_node(scene, (int32_t)i, false);
            status = scene_set_attribute(scene, (int32_t)i, hidden_key, NULL, error);
        }
    }
    return status;
}

static bool has_glyphs(const lmn_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++)
        if (is_root(&scene->nodes[i]) || attribute_of(&scene->nodes[i], hidden_key))
            return true;
    return false;
}

lmn_status depict_clear(lmn_scene *scene, lmn_error *error)
{
    if (!has_glyphs(scene))
        return LMN_OK;
    scene_begin_changes(scene);
    lmn_status status = take_out(scene, error), ended = scene_end_changes(scene, status == LMN_OK ? error : NULL);
    return status == LMN_OK ? ended : status;
}

/* --- the job
 * ------------------------------------------------------------------------------------------------------------ */

/* The viewer that the description places before there are glyphs: these turn towards it. */
static lmn_status place_viewer(depict_job *j, const lmn_draw_desc *desc, lmn_error *error)
{
    pose       p;
    lmn_status status = pose_create(&p, j->scene, &j->when, error);
    box3      *swept = NULL;
    if (status == LMN_OK) {
        moment clips = j->when;
        clips.seconds = 0;
        status = pose_swept_boxes(&swept, j->scene, &clips, error);
    }
    bool *fitted = status == LMN_OK ? mem_alloc(p.part_count + p.ghost_count + 1) : NULL;
    if (status == LMN_OK && !fitted)
        status = error_memory(error);
    if (status == LMN_OK) {
        fit_body body = {.pose = &p, .fitted = fitted, .part_count = p.part_count, .box = box3_empty()};
        for (size_t i = 0; i < p.part_count + p.ghost_count; i++)
            fitted[i] = i < p.part_count;
        p.fit_boxes = swept;
        for (size_t i = 0; i < p.part_count; i++)
            body.box = box3_union(body.box, swept[i]);
        j->size = box3_is_empty(body.box) ? 1 : box3_diagonal(body.box);
        status = camera_place(&j->camera, desc, &p, &body, error);
        p.fit_boxes = p.part_boxes;
    }
    mem_free(fitted);
    mem_free(swept);
    pose_release(&p);
    return status;
}

static lmn_status add_root(lmn_scene *scene, int32_t *root, lmn_error *error)
{
    node       wanted = {.name = mem_copy_text(root_name),
                         .parent = NONE,
                         .first_child = NONE,
                         .next_sibling = NONE,
                         .last_child = NONE,
                         .rotation = {0, 0, 0, 1},
                         .scale = {1, 1, 1},
                         .mesh = NONE,
                         .skin = NONE,
                         .camera = NONE,
                         .light = NONE,
                         .solid = NONE};
    lmn_status status = wanted.name ? scene_add_node(scene, &wanted, error) : error_memory(error);
    if (status != LMN_OK) {
        mem_free(wanted.name);
        return status;
    }
    *root = (int32_t)scene->node_count - 1;
    return scene_set_attribute(scene, *root, root_name, "", error);
}

static lmn_status hide_target(lmn_scene *scene, const expression *e, lmn_error *error)
{
    if (!e->row->hides_target || scene->nodes[e->target].hidden)
        return LMN_OK;
    scene_hide_node(scene, e->target, true);
    return scene_set_attribute(scene, e->target, hidden_key, "", error);
}

/* All that was made comes into the scene, whose parts are numbered anew once. */
static lmn_status change_scene(lmn_scene *scene, depict_job *j, const expression_list *expressions, lmn_error *error)
{
    int32_t root = NONE;
    scene_begin_changes(scene);
    lmn_status status = add_root(scene, &root, error);
    if (status == LMN_OK)
        status = glyphs_into_scene(scene, j, root, error);
    for (size_t i = 0; i < expressions->count && status == LMN_OK; i++)
        status = hide_target(scene, &expressions->items[i], error);
    if (status == LMN_OK)
        status = scene_end_changes(scene, error);
    if (status != LMN_OK) {
        /* The list of parts never knew of the glyphs. */
        take_out(scene, NULL);
        scene_drop_changes(scene);
    }
    return status;
}

lmn_status depict(lmn_scene *scene, const expression_list *expressions, const lmn_draw_desc *desc, warnings *warnings,
                  lmn_error *error)
{
    depict_job j = {.scene = scene, .seed = desc->seed, .warnings = warnings};
    lmn_status status = depict_clear(scene, error);
    if (status == LMN_OK)
        status = time_moment(&j.when, scene, desc, warnings, error);
    if (status == LMN_OK)
        status = place_viewer(&j, desc, error);
    for (size_t i = 0; i < expressions->count && status == LMN_OK; i++)
        status = expressions->items[i].row->depict(&j, &expressions->items[i], error);
    if (status == LMN_OK)
        status = change_scene(scene, &j, expressions, error);
    glyphs_release(&j);
    return status;
}
