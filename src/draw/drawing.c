#include "draw/drawing.h"
#include "draw/exposure.h"

#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/clock.h"
#include "base/memory.h"
#include "plan/refuse.h"
#include "frame/capacity.h"
#include "finish/finish.h"
#include "light/light.h"

lmn_status renderer_create(lmn_renderer **out, bool es, bool debug, lmn_error *error)
{
    *out = NULL;
    lmn_renderer *r = mem_calloc(1, sizeof *r);
    if (!r)
        return error_memory(error);
    lmn_status status = gpu_create(&r->g, es, debug, error);
    if (status != LMN_OK) {
        mem_free(r);
        return status;
    }
    *out = r;
    return LMN_OK;
}

void renderer_destroy(lmn_renderer **renderer)
{
    if (!renderer || !*renderer)
        return;
    lmn_renderer *r = *renderer;
    gpu_make_current(r->g);
    upload_release(&r->up, r->g);
    pose_release(&r->pose);
    swept_boxes_release(&r->swept);
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
    bool posed = r->pose.scene == scene && r->pose.revision == scene->revision && moment_equal(&r->pose.when, &when);
    if (status == LMN_OK && !posed) {
        pose_release(&r->pose);
        status = pose_create(&r->pose, scene, &when, error);
        if (status == LMN_OK && options->held)
            pose_hold(&r->pose, options->held, options->moves);
    }
    if (status == LMN_OK && options->maps)
        status = pose_add_before(&r->pose, time_exposure(look), error);
    if (status == LMN_OK)
        r->pose.fit_boxes = r->pose.part_boxes;
    if (status == LMN_OK && desc->fit_time)
        status = swept_boxes_fit(&r->swept, &r->pose, error);
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
                       (r->up.needs.rest || !p->meshes.rest) &&
                       (r->up.needs.patch == p->meshes.patch || p->meshes.patch == 0);
    bool there = r->up_valid && r->up.has_removed == p->has_removed && r->scene == scene &&
                 r->up.revision == scene->revision && same_meshes && moment_equal(&r->up.when, &r->pose.when) &&
                 r->up.before_seconds == (r->pose.before ? r->pose.before_seconds : 0);
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

static int square_root(int samples)
{
    int side = 1;
    while (side * side < samples)
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

/* The plan, and on the GPU what it needs. */
static lmn_status prepare(session *s, const lmn_scene *scene, const lmn_look *look, const draw_options *w, int side,
                          warnings *warnings, lmn_error *error)
{
    lmn_renderer        *r = s->renderer;
    const lmn_draw_desc *desc = w->desc;
    plan_options         options = {.select = desc->select,
                                    .background = desc->background,
                                    .pixel_scale = side,
                                    .as_sprites = w->maps,
                                    .surfaces_only = w->surfaces_only};
    lmn_status           status = capacity_check_sides(r->g, desc->width, desc->height, side, error);
    if (status == LMN_OK)
        status = bring_pose(r, scene, look, w, warnings, error);
    if (status == LMN_OK)
        status = plan_create(&s->plan, &r->pose, look, &options, warnings, error);
    if (status == LMN_OK)
        status = bring_stage(r, &s->plan, desc, error);
    if (r->width != desc->width || r->height != desc->height || r->samples != desc->samples)
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
    int                  side = options->maps ? 1 : square_root(desc->samples);
    frame               *f = &s->frame;
    memset(s, 0, sizeof *s);
    s->renderer = r;
    gpu_make_current(r->g);
    lmn_status status = prepare(s, scene, look, options, side, warnings, error);
    if (status == LMN_OK && options->camera)
        f->camera = *options->camera;
    else if (status == LMN_OK)
        status = camera_place(&f->camera, desc, &r->pose, s->plan.fit_box, error);
    if (status != LMN_OK)
        return status;
    plan_camera_range(&s->plan, &f->camera, warnings);
    f->camera_before = f->camera;
    if (r->pose.before && desc->camera)
        status = camera_place(&f->camera_before, desc, r->pose.before, s->plan.fit_box, error);
    if (status != LMN_OK)
        return status;
    r->width = desc->width;
    r->height = desc->height;
    r->samples = desc->samples;
    f->g = r->g;
    f->profile.g = r->g;
    f->up = &r->up;
    f->plan = &s->plan;
    f->sheet = &s->textures.sheet;
    f->samples = side;
    f->width = desc->width * side;
    f->height = desc->height * side;
    f->ground = s->plan.ground;
    f->seed = desc->seed;
    f->time_s = desc->time_s;
    if (!options->maps)
        s->out = gpu_target_acquire(r->g, desc->width, desc->height, GPU_RGBA8);
    return gpu_check(r->g, error);
}

void session_close(session *s)
{
    if (s->renderer)
        gpu_target_release(s->renderer->g, s->out);
    plan_release(&s->plan);
    plan_textures_release(&s->textures);
    memset(s, 0, sizeof *s);
}

static lmn_status read_pixels(lmn_drawing *d, session *s, lmn_error *error)
{
    size_t stride = (size_t)d->width * 4;
    d->pixels = mem_alloc(stride * (size_t)d->height);
    uint8_t *row = mem_alloc(stride);
    if (!d->pixels || !row) {
        mem_free(row);
        return error_memory(error);
    }
    gpu_read(s->renderer->g, s->out, d->pixels);
    for (int y = 0; y < d->height / 2; y++) {
        uint8_t *top = d->pixels + (size_t)y * stride, *bottom = d->pixels + (size_t)(d->height - 1 - y) * stride;
        memcpy(row, top, stride);
        memcpy(top, bottom, stride);
        memcpy(bottom, row, stride);
    }
    mem_free(row);
    return gpu_check(s->renderer->g, error);
}

static bool has_strokes(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (technique_draws_strokes(r->uses[KIND_LINES][i].technique))
            return true;
    return false;
}

/* Strokes know the meshes of parts as they are in the scene. */
static lmn_status refuse_strokes(const refusal *r, const session *s, const upload *up)
{
    bool solids = false, cut = false;
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure *fig = &s->plan.figures[i];
        bool          strokes = has_strokes(fig->rule);
        solids = solids || (strokes && figure_has_solids(&s->plan, fig));
        cut = cut || (strokes && up->section.cut.cell_count > 0);
    }
    const char *instead = "operators like 'discontinuity' draw them (--set lines.operator=discontinuity)";
    lmn_status  status = LMN_OK;
    if (solids)
        status = refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED, instead,
                        "lines 'strokes' are those of meshes: solids have none");
    if (cut && status == LMN_OK)
        status = refuse(r, LMN_USAGE, WARNING_UNUSED, instead,
                        "lines 'strokes' are those of whole parts: what a section takes away is drawn too");
    return status;
}

/* Marks lie on the triangles of parts as they are in the scene. */
static lmn_status refuse_marks(const refusal *r, const session *s)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure        *fig = &s->plan.figures[i];
        const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
        if (!surface || !surface->technique->surface->marks || fig->unmarked || !figure_has_solids(&s->plan, fig))
            continue;
        lmn_status status = refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED,
                                   "'dots' and 'hatch' are worked out on any surface (--set surface.technique=hatch)",
                                   "surface '%s' lies on meshes: solids have none", surface->technique->name);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

static void warn_of_marks(const session *s, warnings *warnings)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure        *fig = &s->plan.figures[i];
        const technique_use *surface = rule_use(fig->rule, KIND_SURFACE), *compose = rule_shades_again(fig->rule);
        if (!surface || !surface->technique->surface->marks || fig->unmarked)
            continue;
        if (compose)
            warnings_add(warnings, WARNING_UNUSED,
                         "compose '%s' shades again and leaves out the marks of surface '%s'; 'opaque' draws them",
                         compose->technique->name, surface->technique->name);
    }
}

/* What could not be drawn as it was asked for. */
static void keep_warnings(lmn_drawing *d, const lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                          const session *s)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    const upload       *up = &r->up;
    bool                cut_out = false, spares = false;
    warn_of_marks(s, &d->warnings);
    for (size_t i = 0; i < up->item_count && !cut_out; i++) {
        const draw_item *item = &up->items[i];
        bool             blended = item->material >= 0 && scene->materials[item->material].alpha == ALPHA_BLEND;
        cut_out = blended && s->plan.opaque[item->part_index]; /* what is seen through keeps its opacity */
    }
    if (cut_out)
        warnings_add(&d->warnings, WARNING_TRANSPARENCY, "transparent materials are drawn as cut-outs");
    if (up->section.cut.cell_count > 0 && up->triangles == 0)
        warnings_add(&d->warnings, WARNING_UNUSED, "the section leaves nothing of the model: the page stays empty");
    if (up->open_parts)
        warnings_add(&d->warnings, WARNING_CUT_OPEN, "%zu of %zu parts are not closed and have no cut face there",
                     up->open_parts, scene->part_count);
    for (size_t i = 0; up->section.spared && i < up->part_count; i++)
        spares = spares || up->section.spared[i];
    if (up->section.spared && v->cut_keep.text[0] && !spares)
        warnings_add(&d->warnings, WARNING_NO_MATCH, "scene.cut_keep '%s' selects no part", v->cut_keep.text);
}

static lmn_status keep_facts(lmn_drawing *d, const lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                             const session *s, const lmn_draw_desc *desc, lmn_error *error)
{
    const gpu_capabilities *facts = gpu_capabilities_of(r->g);
    d->vendor = mem_copy_text(facts->vendor);
    d->renderer = mem_copy_text(facts->renderer);
    d->version = mem_copy_text(facts->version);
    d->camera = s->frame.camera;
    if (!d->vendor || !d->renderer || !d->version)
        return error_memory(error);
    lmn_status status = facts_take(&d->facts, &r->pose, look, s->plan.part_count, desc->seed, error);
    if (status != LMN_OK)
        return status;
    d->facts.triangles = r->up.triangles;
    d->facts.bounds = s->plan.box;
    warnings_append(&d->warnings, &scene->warnings);
    keep_warnings(d, r, scene, look, s);
    refusal refusals = {scene, desc->lenient, &d->warnings, error};
    status = refuse_time(&refusals, look, desc->time_s, true);
    if (status == LMN_OK && s->plan.figure_count == 0)
        status = refuse(&refusals, LMN_USAGE, WARNING_NO_MATCH, NULL,
                        "no rule of the look '%s' selects a part: the page stays empty", d->facts.look);
    if (status == LMN_OK)
        status = refuse_strokes(&refusals, s, &r->up);
    return status == LMN_OK ? refuse_marks(&refusals, s) : status;
}

/* An extra frame with one sample and all buffers read back. */
static lmn_status draw_maps(lmn_drawing *d, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                            const lmn_draw_desc *desc, lmn_error *error)
{
    enum { LARGE = 1 << 21 }; /* pixels from which on the drawing's own pictures are not kept while maps are read */
    session  s;
    warnings ignored = {0};
    if ((int64_t)desc->width * desc->height >= LARGE)
        gpu_targets_trim(r->g);
    lmn_status status = session_open(&s, r, scene, look, &(draw_options){.desc = desc, .maps = true}, &ignored, error);
    if (status == LMN_OK)
        status = frame_maps_create(&d->maps, desc->width, desc->height, desc->maps, error);
    if (status == LMN_OK) {
        s.frame.maps = &d->maps;
        frame_draw(&s.frame, NULL);
        status = gpu_check(r->g, error);
    }
    session_close(&s);
    warnings_release(&ignored);
    if (status != LMN_OK)
        return status;
    d->part_pixels = mem_calloc(d->facts.part_count, sizeof *d->part_pixels);
    if (!d->part_pixels)
        return error_memory(error);
    for (size_t i = 0, count = (size_t)desc->width * (size_t)desc->height; i < count; i++)
        if (d->maps.id[i])
            d->part_pixels[d->maps.id[i] - 1]++;
    if (!desc->maps)
        frame_maps_release(&d->maps);
    return LMN_OK;
}

/* The drawing whose frame is there. */
typedef struct drawn_frame {
    lmn_drawing         *drawing;
    const lmn_draw_desc *desc;
    double               start_ms;
} drawn_frame;

/* Takes what a frame has drawn. */
static lmn_status keep_frame(session *s, void *user, lmn_error *error)
{
    const drawn_frame   *drawn = user;
    lmn_drawing         *d = drawn->drawing;
    const lmn_draw_desc *desc = drawn->desc;
    gpu_finish(s->renderer->g);
    d->frame_ms = clock_ms() - drawn->start_ms;
    d->programs = gpu_program_count(s->renderer->g);
    lmn_status status = gpu_check(s->renderer->g, error);
    memcpy(d->strokes, s->frame.strokes, sizeof d->strokes);
    d->layers = s->frame.producer ? s->frame.layers : 1;
    d->producer = s->frame.producer;
    if (s->frame.lists_full)
        warnings_add(&d->warnings, WARNING_LAYER_MEMORY,
                     "layers did not fit into layers.memory and were peeled instead, which takes longer");
    if (status == LMN_OK)
        status = read_pixels(d, s, error);
    if (status != LMN_OK || !desc->profile)
        return status;
    s->frame.profile.on = true;
    frame_draw(&s->frame, s->out);
    d->profile = s->frame.profile;
    return gpu_check(s->renderer->g, error);
}

static lmn_status draw_frame(lmn_drawing *d, session *s, const lmn_look *look, const draw_options *options,
                             lmn_error *error)
{
    drawn_frame drawn = {d, options->desc, clock_ms()};
    exposure    e;
    lmn_status  status = exposure_find(&e, &s->plan, error);
    if (status == LMN_OK && e.technique) {
        status = exposure_draw(&e, s, look, options, keep_frame, &drawn, error);
    } else if (status == LMN_OK) {
        frame_draw(&s->frame, s->out);
        status = keep_frame(s, &drawn, error);
    }
    exposure_release(&e);
    return status;
}

static bool cancelled(const lmn_draw_desc *desc, double fraction, const char *stage)
{
    return desc->progress && !desc->progress(fraction, stage, desc->progress_user);
}

lmn_status renderer_draw(lmn_drawing **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                         const draw_options *options, lmn_error *error)
{
    const lmn_draw_desc *desc = options->desc;
    *out = NULL;
    lmn_drawing *d = mem_calloc(1, sizeof *d);
    if (!d)
        return error_memory(error);
    d->width = desc->width;
    d->height = desc->height;
    session    s;
    lmn_status status = session_open(&s, r, scene, look, options, &d->warnings, error);
    if (status == LMN_OK && cancelled(desc, 0.3, "drawing"))
        status = error_set(error, LMN_CANCELLED, "cancelled");
    if (status == LMN_OK)
        status = keep_facts(d, r, scene, look, &s, desc, error);
    if (status == LMN_OK)
        status = draw_frame(d, &s, look, options, error);
    session_close(&s);
    if (status == LMN_OK && cancelled(desc, 0.8, "drawing"))
        status = error_set(error, LMN_CANCELLED, "cancelled");
    if (status == LMN_OK && (desc->maps || desc->profile))
        status = draw_maps(d, r, scene, look, desc, error);
    if (status != LMN_OK)
        drawing_destroy(&d);
    *out = d;
    return status;
}

void drawing_destroy(lmn_drawing **drawing)
{
    if (!drawing || !*drawing)
        return;
    lmn_drawing *d = *drawing;
    mem_free(d->pixels);
    frame_maps_release(&d->maps);
    warnings_release(&d->warnings);
    facts_release(&d->facts);
    mem_free(d->vendor);
    mem_free(d->renderer);
    mem_free(d->version);
    mem_free(d->part_pixels);
    mem_free(d);
    *drawing = NULL;
}
