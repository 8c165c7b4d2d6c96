#include "depict/depict.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "depict/depict_private.h"
#include "depict/preview.h"
#include "depict/staging.h"
#include "plan/time.h"
#include "scene/content.h"

/* Until the viewer stays. What is lifted before a huge ground lies near the eye, and goes with it. */
enum { PASSES = 2, PASSES_STAGED = 6 };

static const char root_name[] = "glyphs", hidden_key[] = "depicted";

extern const depiction depiction_path, depiction_motion, depiction_still, depiction_still_plane, depiction_collision,
    depiction_turnaround, depiction_tailspin, depiction_expand, depiction_collapse, depiction_speech, depiction_thought,
    depiction_camera_path, depiction_shot_flow, depiction_explode, depiction_split_path, depiction_cause,
    depiction_travelling, depiction_inset;

const depiction *const depictions[] = {&depiction_path,
                                       &depiction_motion,
                                       &depiction_still,
                                       &depiction_still_plane,
                                       &depiction_collision,
                                       &depiction_turnaround,
                                       &depiction_tailspin,
                                       &depiction_expand,
                                       &depiction_collapse,
                                       &depiction_speech,
                                       &depiction_thought,
                                       &depiction_camera_path,
                                       &depiction_shot_flow,
                                       &depiction_explode,
                                       &depiction_split_path,
                                       &depiction_cause,
                                       &depiction_travelling,
                                       &depiction_inset,
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
    scene->staged = false;
    if (!has_glyphs(scene))
        return LMN_OK;
    scene_begin_changes(scene);
    lmn_status status = take_out(scene, error), ended = scene_end_changes(scene, status == LMN_OK ? error : NULL);
    return status == LMN_OK ? ended : status;
}

/* --- the job
 * ------------------------------------------------------------------------------------------------------------ */

/* The box of all that the scene has, and the size of what pictures are fitted to, wherever it goes. */
static lmn_status measure_scene(depict_job *j, lmn_error *error)
{
    lmn_status status = LMN_OK;
    box3       fitted = box3_empty();
    j->box = box3_empty();
    for (int i = 0; i < STAGING_MOMENTS && status == LMN_OK; i++) {
        const pose *p = NULL;
        status = depict_pose(&p, j, staging_moment(j, i), error);
        for (size_t k = 0; k < j->scene->part_count && status == LMN_OK; k++)
            if (!scene_is_hidden(j->scene, j->scene->parts[k].node)) {
                j->box = box3_union(j->box, p->part_boxes[k]);
                fitted = box3_union(fitted, scene_fitted_box(j->scene, k, p->part_boxes[k]));
            }
    }
    j->size = box3_is_empty(fitted) ? 1 : box3_diagonal(fitted);
    return status;
}

/* Where no camera is given and the scene is much larger than what is told, it gets a stage. */
static lmn_status stage_scene(lmn_scene *scene, depict_job *j, const expression_list *expressions, lmn_error *error)
{
    const double much = 0.8, whole = j->size;
    box3         stage = box3_empty();
    lmn_status   status = j->fixed_view ? LMN_OK : staging_find(&stage, j, expressions, error);
    if (status != LMN_OK || box3_is_empty(stage))
        return status;
    scene->stage = stage;
    scene->staged = true;
    status = measure_scene(j, error);
    if (status != LMN_OK || j->size < much * whole)
        return status;
    scene->staged = false;
    return measure_scene(j, error);
}

/* The viewer that the description places before a scene: glyphs turn towards it. */
static lmn_status place_viewer(depict_job *j, const lmn_scene *scene, const lmn_draw_desc *desc, lmn_error *error)
{
    pose       p;
    lmn_status status = pose_create(&p, scene, &j->when, error);
    box3      *swept = NULL;
    moment     clips = j->when;
    clips.seconds = 0;
    if (status == LMN_OK && desc->fit_time)
        status = pose_swept_boxes(&swept, scene, &clips, error);
    bool *fitted = status == LMN_OK ? mem_alloc(p.part_count + p.ghost_count + 1) : NULL;
    if (status == LMN_OK && !fitted)
        status = error_memory(error);
    if (status == LMN_OK) {
        fit_body body = {.pose = &p, .fitted = fitted, .part_count = p.part_count, .box = box3_empty()};
        p.fit_boxes = swept ? swept : p.part_boxes;
        for (size_t i = 0; i < p.part_count; i++) {
            fitted[i] = !scene_is_hidden(scene, scene->parts[i].node);
            if (fitted[i])
                body.box = box3_union(body.box, scene_fitted_box(scene, i, p.fit_boxes[i]));
        }
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

void depict_say_nothing(depict_job *j, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(j->nothing, sizeof j->nothing, format, arguments);
    va_end(arguments);
}

/* What somebody asked for, or Limner chose, and nobody can see. */
static void say_without_sign(const depict_job *j, const expression *e)
{
    char numbered[DEPICT_NAME_SIZE];
    warnings_add(j->warnings, WARNING_UNTOLD, "expression %u, '%s' of '%.60s', has no sign: %s", e->number + 1,
                 e->row->characteristic, depict_name_of(j->scene, e->target, numbered),
                 j->nothing[0] ? j->nothing : "nothing of it happens in its interval");
}

/* Which of several things a pattern means. */
static void say_choice(const depict_job *j, const expression *e)
{
    static const char *const whose[] = {"target", "partner"};
    const int32_t            taken[] = {e->target, e->partner};
    for (int i = 0; i < 2; i++) {
        char numbered[DEPICT_NAME_SIZE];
        if (e->choice[i] > 1)
            warnings_add(j->warnings, WARNING_UNTOLD,
                         "expression %u, '%s': its %s means %zu things, of which '%.60s' is taken", e->number + 1,
                         e->row->characteristic, whose[i], e->choice[i], depict_name_of(j->scene, taken[i], numbered));
    }
}

static lmn_status make_one(depict_job *j, const expression *e, lmn_error *error)
{
    const size_t before = j->glyph_count;
    j->nothing[0] = '\0';
    say_choice(j, e);
    lmn_status status = e->row->depict(j, e, error);
    if (status != LMN_OK)
        return expression_blame(e, j->scene, status, error);
    if (j->glyph_count == before)
        say_without_sign(j, e);
    return LMN_OK;
}

static lmn_status make_glyphs(depict_job *j, const expression_list *expressions, lmn_error *error)
{
    lmn_status status = LMN_OK;
    glyphs_release(j);
    warnings_release(j->warnings);
    for (int last = 0; last < 2; last++)
        for (size_t i = 0; i < expressions->count && status == LMN_OK; i++)
            if (expressions->items[i].row->last == (last != 0))
                status = make_one(j, &expressions->items[i], error);
    return status;
}

/* Does it see all at the same places? How near and far it sees is of no matter to glyphs. */
static bool sees_alike(const view_camera *a, const view_camera *b)
{
    return memcmp(a->view.m, b->view.m, sizeof a->view.m) == 0 && a->orthographic == b->orthographic &&
           a->fov_y == b->fov_y && a->half_height == b->half_height && a->aspect == b->aspect;
}

/* Glyphs have room on the page, so that the viewer steps back for them; they are made anew for where it is then, unless
 * it stays where it was. */
static lmn_status turn_to_viewer(depict_job *j, const expression_list *expressions, const lmn_draw_desc *desc,
                                 bool *moved, lmn_error *error)
{
    preview           with;
    const view_camera before = j->camera;
    lmn_status        status = preview_open(&with, j, expressions, error);
    if (status == LMN_OK)
        status = place_viewer(j, &with.scene, desc, error);
    preview_release(&with);
    *moved = j->drafts || !sees_alike(&before, &j->camera);
    j->drafts = false;
    return status == LMN_OK && *moved ? make_glyphs(j, expressions, error) : status;
}

lmn_status depict(lmn_scene *scene, const expression_list *expressions, const lmn_draw_desc *desc, warnings *said,
                  lmn_error *error)
{
    depict_poses poses = {.count = 0};
    warnings     of_glyphs = {0}; /* that are there in the end */
    bool         moved = true;
    depict_job   j = {.scene = scene,
                      .poses = &poses,
                      .letterings = &scene->letterings,
                      .seed = desc->seed,
                      .warnings = &of_glyphs,
                      .expressions = expressions};
    j.fixed_view = desc->camera || desc->matrices_given || (desc->eye_given && !desc->fit_direction);
    j.drafts = !j.fixed_view;
    lmn_status status = depict_clear(scene, error);
    if (status == LMN_OK)
        status = time_moment(&j.when, scene, desc, NULL, error); /* who draws says what is wrong with the time */
    if (status == LMN_OK)
        status = measure_scene(&j, error);
    if (status == LMN_OK)
        status = stage_scene(scene, &j, expressions, error);
    if (status == LMN_OK)
        status = place_viewer(&j, scene, desc, error);
    if (status == LMN_OK)
        status = make_glyphs(&j, expressions, error);
    for (int pass = 0; pass < (scene->staged ? PASSES_STAGED : PASSES) && status == LMN_OK && moved; pass++)
        status = turn_to_viewer(&j, expressions, desc, &moved, error);
    depict_poses_release(&poses);
    if (status == LMN_OK)
        status = change_scene(scene, &j, expressions, error);
    scene->staged = scene->staged && status == LMN_OK;
    glyphs_release(&j);
    if (said)
        warnings_append(said, &of_glyphs);
    warnings_release(&of_glyphs);
    return status;
}
