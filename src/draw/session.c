#include "draw/session.h"

#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/paper.h"
#include "finish/finish.h"
#include "frame/capacity.h"
#include "light/light.h"
#include "plan/deformation.h"
#include "plan/movers.h"
#include "plan/refuse.h"

lmn_status renderer_create(lmn_renderer **out, const lmn_renderer_desc *desc, lmn_error *error)
{
    *out = NULL;
    lmn_renderer *r = mem_calloc(1, sizeof *r);
    if (!r)
        return error_memory(error);
    lmn_status status = desc->adopt ? gpu_adopt(&r->g, desc->debug, desc->no_restore, error)
                                    : gpu_create(&r->g, desc->es, desc->debug, error);
    if (status == LMN_OK)
        status = gpu_leave(r->g, LMN_OK, error);
    if (status != LMN_OK && !r->g)
        mem_free(r);
    else if (status != LMN_OK)
        renderer_destroy(&r);
    else
        *out = r;
    return status;
}

void kept_lend(kept_textures *k, lmn_renderer *r)
{
    if (!k)
        return;
    k->renderer = r;
    k->owners = 2;
    r->kept = k;
}

void kept_release(kept_textures *k)
{
    if (k && atomic_fetch_sub(&k->owners, 1) <= 1)
        mem_free(k);
}

void kept_drop(lmn_renderer *r)
{
    kept_textures *k = r->kept;
    if (!k)
        return;
    gpu_target_release(r->g, k->picture);
    frame_maps_release_textures(&k->maps, r->g);
    k->renderer = NULL;
    k->picture = NULL;
    r->kept = NULL;
    kept_release(k);
}

void renderer_destroy(lmn_renderer **renderer)
{
    if (!renderer || !*renderer)
        return;
    lmn_renderer *r = *renderer;
    gpu_enter_to_free(r->g);
    kept_drop(r);
    upload_release(&r->up, r->g);
    pose_release(&r->pose);
    pose_deformation_release(&r->deformation);
    swept_boxes_release(&r->swept);
    swept_boxes_release(&r->plate);
    round_scene_release(&r->round);
    made_textures_release(&r->made, r->g);
    gpu_destroy(&r->g);
    mem_free(r);
    *renderer = NULL;
}

/* Poses the scene unless it is posed already. */
static lmn_status bring_pose(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const draw_options *options,
                             warnings *warnings, lmn_error *error)
{
    const lmn_draw_desc *desc = options->desc;
    moment               when;
    lmn_status           status = time_moment(&when, scene, desc, warnings, error);
    if (status == LMN_OK)
        status = deformation_find(&r->deformation, &when, scene, look, warnings, error);
    bool same = r->pose.scene == scene && r->pose.revision == scene->revision,
         posed = same && moment_equal(&r->pose.when, &when);
    if (status == LMN_OK && !posed) {
        if (!same)
            pose_release(&r->pose);
        status = same ? pose_move(&r->pose, &when, error) : pose_create(&r->pose, scene, &when, error);
        if (status == LMN_OK && options->held)
            pose_hold(&r->pose, options->held, options->moves);
    }
    int steps = movers_steps(look);
    if (status == LMN_OK)
        status = time_check(look, error);
    if (status == LMN_OK && (options->maps || steps))
        status = pose_add_past(&r->pose, time_exposure(look), steps ? steps : 1, error);
    if (status == LMN_OK) {
        r->pose.fit_boxes = r->pose.part_boxes;
        pose_warn_of_flat(&r->pose, warnings);
        pose_warn_of_rigid(&r->pose, warnings);
    }
    if (!options->held)
        swept_boxes_release(&r->plate);
    if (status == LMN_OK && desc->fit_time)
        status = swept_boxes_fit(&r->swept, &r->pose, error);
    else if (status == LMN_OK && options->held && r->plate.boxes)
        r->pose.fit_boxes = r->plate.boxes; /* all times of a plate, as its first drawing */
    else if (status == LMN_OK && !options->surfaces_only)
        status = plate_boxes_fit(&r->plate, &r->pose, look, error);
    if (status != LMN_OK)
        pose_release(&r->pose);
    return status;
}

/* Puts the scene on the GPU as the plan needs it, unless it is there already. */
static lmn_status bring_stage(lmn_renderer *r, const plan *p, const lmn_draw_desc *desc, lmn_error *error)
{
    const lmn_scene *scene = p->scene;
    upload_desc      wanted = {
             .crease_angle = p->crease_angle, .removed = p->has_removed, .needs = p->meshes, .section = &p->section};
    bool same_meshes = r->up.crease_angle == p->crease_angle && (r->up.needs.field || !p->meshes.field) &&
                       (r->up.needs.rest || !p->meshes.rest) && (r->up.needs.glue || !p->meshes.glue) &&
                       (r->up.needs.walls || !p->meshes.walls) &&
                       (r->up.needs.patch == p->meshes.patch || p->meshes.patch == 0);
    bool there = r->up_valid && r->up.has_removed == p->has_removed && r->scene == scene &&
                 r->up.revision == scene->revision && same_meshes && moment_equal(&r->up.when, &r->pose.when) &&
                 r->up.past_count == r->pose.past_count &&
                 (!r->up.past_count || r->up.past_seconds == r->pose.past_seconds);
    if (there && section_equal(&r->up.section, &p->section, scene->part_count + scene->ghost_count))
        return LMN_OK;
    upload earlier = r->up;
    bool   related = r->up_valid && earlier.identity == scene->identity && same_meshes;
    if (related)
        wanted.needs = earlier.needs; /* what is taken over has them */
    else
        upload_release(&earlier, r->g); /* at once: two scenes may not fit */
    lmn_status status = upload_create(&r->up, r->g, &r->pose, &wanted, related ? &earlier : NULL, desc->progress,
                                      desc->progress_user, error);
    if (status != LMN_OK)
        refuse_in_file(error, scene);
    upload_release(&earlier, r->g);
    r->scene = scene;
    r->up_valid = status == LMN_OK;
    return status;
}

int samples_side(const lmn_draw_desc *desc)
{
    int side = 1;
    if (!desc->samples)
        return paper_samples_side(desc->width, desc->height, desc->dpi);
    while (side * side < desc->samples)
        side++;
    return side;
}

/* Shadows that were asked for and cannot be. */
static void warn_of_lights(const lmn_scene *scene, const lmn_look *look, warnings *warnings)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    if (!v->shadows || v->lights != LIGHTS_FILE)
        return;
    for (size_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].light < 0)
            continue;
        if (scene->lights[scene->nodes[i].light].type != LIGHT_DIRECTIONAL)
            warnings_add(warnings, WARNING_UNUSED,
                         "scene.shadows: the file's first light shines from a place; only light from one direction "
                         "throws shadows");
        return;
    }
}

/* The camera now and in the past. */
static lmn_status place_cameras(session *s, const draw_options *options, warnings *warnings, lmn_error *error)
{
    frame      *f = &s->frame;
    const pose *now = s->plan.pose;
    lmn_status  status = LMN_OK;
    if (options->camera)
        f->camera = *options->camera;
    else
        status = camera_place(&f->camera, options->desc, now, &s->plan.fit, error);
    if (status != LMN_OK)
        return status;
    plan_camera_range(&s->plan, &f->camera, warnings);
    status = tone_range_find(&f->tone_range, &s->plan, &f->camera, error);
    if (status != LMN_OK)
        return status;
    f->ground_plane = ground_find(&s->plan, &f->camera);
    for (int k = 0; k < POSE_PAST_MAX; k++)
        f->camera_past[k] = f->camera;
    for (int k = 0; k < now->past_count && status == LMN_OK; k++) {
        view_camera *past = &f->camera_past[k];
        if (!options->desc->camera || options->camera)
            continue;
        status = camera_place(past, options->desc, now->past[k], &s->plan.fit, error);
        /* The same depths as now. */
        camera_set_range(past, f->camera.near, f->camera.far);
        past->near = f->camera.near;
        past->far = f->camera.far;
        past->projection.m[10] = f->camera.projection.m[10];
        past->projection.m[14] = f->camera.projection.m[14];
    }
    return status;
}

/* What moves on the page is drawn by itself where rules tell of motion so. */
static lmn_status split_movers(session *s, const draw_options *options, int side, warnings *warnings, lmn_error *error)
{
    enum { REST_PARTS = 4 }; /* of a pixel that is seen: less is no motion */
    const lmn_draw_desc *desc = options->desc;
    movers_view          view = {&s->frame.camera, s->frame.camera_past, desc->width * side, desc->height * side,
                                 (double)side / REST_PARTS};
    return options->maps || options->surfaces_only ? LMN_OK : plan_split_movers(&s->plan, &view, warnings, error);
}

/* Shaders of techniques from outside of the library. */
static lmn_status give_sources(gpu *g, const lmn_look *look, lmn_error *error)
{
    for (size_t i = 0; i < look->rule_count; i++)
        for (size_t u = 0; u < look->rules[i].use_counts[KIND_SURFACE]; u++) {
            const surface_row *row = look->rules[i].uses[KIND_SURFACE][u].technique->surface;
            if (row->outside && !gpu_give_source(g, strrchr(row->shader, '+') + 1, row->label, row->outside))
                return error_memory(error);
        }
    return LMN_OK;
}

/* The plan, and on the GPU what it needs. */
static lmn_status prepare(session *s, const lmn_scene *scene, const lmn_look *look, const draw_options *w, int side,
                          warnings *warnings, lmn_error *error)
{
    lmn_renderer        *r = s->renderer;
    const lmn_draw_desc *desc = w->desc;
    plan_options         options = {.select = desc->select,
                                    .background = desc->background,
                                    .pixels_per_mm = paper_pixels_per_mm(desc->width, desc->height, desc->dpi) * side,
                                    .as_sprites = w->maps,
                                    .cut = w->cut,
                                    .surfaces_only = w->surfaces_only};
    lmn_status           status = capacity_check_sides(r->g, desc->width, desc->height, side, error);
    if (status == LMN_OK)
        status = give_sources(r->g, look, error);
    if (status == LMN_OK)
        status = bring_pose(r, scene, look, w, warnings, error);
    if (status == LMN_OK)
        status = plan_create(&s->plan, &r->pose, look, &options, warnings, error);
    if (status == LMN_OK)
        status = place_cameras(s, w, warnings, error);
    if (status == LMN_OK)
        status = split_movers(s, w, side, warnings, error);
    if (status == LMN_OK)
        status = bring_stage(r, &s->plan, desc, error);
    if (r->width != desc->width || r->height != desc->height || r->samples != side)
        gpu_targets_trim(r->g);
    if (status == LMN_OK)
        status = capacity_check(
            r->g, &s->plan,
            &(capacity_options){desc->width, desc->height, side, !w->maps && (desc->maps || desc->profile)}, error);
    if (status == LMN_OK)
        warn_of_lights(scene, look, warnings);
    if (status == LMN_OK)
        status = plan_textures_make(&s->textures, &r->made, r->g, &s->plan, !w->maps, warnings, error);
    return status;
}

lmn_status session_open(session *s, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                        const draw_options *options, warnings *warnings, lmn_error *error)
{
    const lmn_draw_desc *desc = options->desc;
    int                  side = options->maps ? 1 : samples_side(desc);
    frame               *f = &s->frame;
    memset(s, 0, sizeof *s);
    s->renderer = r;
    kept_drop(r);
    lmn_status status = round_scene_find(&scene, &r->round, scene, look, error);
    if (status == LMN_OK)
        status = prepare(s, scene, look, options, side, warnings, error);
    if (status != LMN_OK)
        return status;
    r->width = desc->width;
    r->height = desc->height;
    r->samples = side;
    f->g = r->g;
    f->profile.g = r->g;
    f->up = &r->up;
    f->plan = &s->plan;
    f->sheet = &s->textures.sheet;
    f->samples = side;
    f->pixels_per_mm = s->plan.pixels_per_mm;
    f->width = desc->width * side;
    f->height = desc->height * side;
    if (desc->window[2] > 0 && !options->maps)
        memcpy(f->window,
               (int[]){desc->window[0] * side, (desc->height - desc->window[1] - desc->window[3]) * side,
                       desc->window[2] * side, desc->window[3] * side},
               sizeof f->window);
    f->ground = s->plan.ground;
    f->anchor = s->plan.box;
    f->seed = desc->seed;
    f->time_s = desc->time_s;
    f->draft = desc->draft;
    f->keeps_depth = options->keeps_depth;
    if (!options->maps)
        s->out = gpu_target_acquire(r->g, desc->width, desc->height, GPU_RGBA8);
    return gpu_check(r->g, error);
}

void session_close(session *s)
{
    if (s->renderer) {
        gpu_target_release(s->renderer->g, s->out);
        gpu_target_release(s->renderer->g, s->frame.kept_depth);
        gpu_target_release(s->renderer->g, s->frame.seen_depth);
        gpu_target_release(s->renderer->g, s->frame.moved_depth);
    }
    plan_release(&s->plan);
    plan_textures_release(&s->textures);
    memset(s, 0, sizeof *s);
}
