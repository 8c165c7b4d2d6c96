#include "draw/drawing.h"

#include <string.h>

#include "annotate/annotate.h"
#include "base/clock.h"
#include "base/memory.h"
#include "draw/exposure.h"
#include "light/light.h"
#include "export/export.h"
#include "plan/refuse.h"
#include "lines/stroke/strokes.h"
#include "plan/unit.h"

static void swap_rows(uint8_t *pixels, uint8_t *row, size_t stride, int height)
{
    for (int y = 0; y < height / 2; y++) {
        uint8_t *top = pixels + (size_t)y * stride, *bottom = pixels + (size_t)(height - 1 - y) * stride;
        memcpy(row, top, stride);
        memcpy(top, bottom, stride);
        memcpy(bottom, row, stride);
    }
}

/* Of a picture that may be larger, the part (from its upper left corner) that the drawing is. */
static lmn_status read_pixels(lmn_drawing *d, gpu *g, gpu_texture *picture, const int part[4], lmn_error *error)
{
    int    width = gpu_texture_width(picture), height = gpu_texture_height(picture);
    size_t stride = (size_t)d->width * 4;
    d->pixels = mem_alloc(stride * (size_t)d->height);
    uint8_t *row = mem_alloc(stride);
    if (!d->pixels || !row) {
        mem_free(row);
        return error_memory(error);
    }
    gpu_read_box(g, picture, (int[]){part[0], height - part[1] - part[3], part[2], part[3]}, d->pixels);
    swap_rows(d->pixels, row, stride, d->height);
    mem_free(row);
    lmn_status status = gpu_check(g, error);
    return status == LMN_OK && d->annotations.item_count
               ? export_paint(d->pixels, part, width, height, &d->annotations, error)
               : status;
}

/* Of a drawing that stays on the GPU: what is written beside it is painted by the same hand, so that the texture has
 * the same bytes. Reading it afterwards adds nothing. */
static lmn_status paint_picture(lmn_drawing *d, gpu *g, gpu_texture *picture, lmn_error *error)
{
    const int  whole[4] = {0, 0, d->width, d->height};
    size_t     stride = (size_t)d->width * 4;
    uint8_t   *row = mem_alloc(stride);
    lmn_status status = row ? read_pixels(d, g, picture, whole, error) : error_memory(error);
    if (status == LMN_OK) {
        swap_rows(d->pixels, row, stride, d->height);
        gpu_target_write(g, picture, whole, d->pixels);
        sheet_release(&d->annotations);
        status = gpu_check(g, error);
    }
    mem_free(row);
    mem_free(d->pixels);
    d->pixels = NULL;
    return status;
}

lmn_status drawing_read_back(lmn_drawing *d, lmn_error *error)
{
    if (d->pixels)
        return LMN_OK;
    gpu       *g = d->kept->renderer->g;
    lmn_status status = gpu_enter(g, error);
    if (status != LMN_OK)
        return status;
    if (d->kept->maps.on_gpu && !d->maps.depth && !frame_maps_read(&d->kept->maps, g, &d->maps))
        status = error_memory(error);
    if (status == LMN_OK)
        status = read_pixels(d, g, d->kept->picture, (int[]){0, 0, d->width, d->height}, error);
    if (status != LMN_OK) {
        mem_free(d->pixels);
        d->pixels = NULL;
        frame_maps_release(&d->maps);
    }
    return gpu_leave(g, status, error);
}

static bool has_strokes(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (technique_draws_strokes(r->uses[KIND_LINES][i].technique))
            return true;
    return false;
}

static bool has_lines_of_form(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique_use *use = &r->uses[KIND_LINES][i];
        if (use->technique != &lines_strokes)
            continue;
        stroke_options options = strokes_options_of(use->values);
        if (stroke_options_form(&options))
            return true;
    }
    return false;
}

static bool has_removed(const plan *p, const figure *f)
{
    for (size_t i = p->scene->part_count; i < p->part_count; i++)
        if (f->designated[i])
            return true;
    return false;
}

/* Of solids strokes know what bounds them: neither how they bend, nor what they take away. */
static lmn_status refuse_strokes(const refusal *r, const session *s)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure *fig = &s->plan.figures[i];
        lmn_status    status = LMN_OK;
        if (has_lines_of_form(fig->rule) && figure_has_solids(&s->plan, fig))
            status =
                refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED, NULL,
                       "lines of form (suggestive, ridges, valleys, apparent) are those of meshes: solids have none");
        else if (has_strokes(fig->rule) && has_removed(&s->plan, fig))
            status = refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED,
                            "operators like 'discontinuity' draw them (--set lines.operator=discontinuity)",
                            "lines 'strokes' are those of what is there: what solids take away has none");
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
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

/* Their vertices are drawn where they were. */
static lmn_status refuse_scattered(const refusal *r, const session *s)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure        *fig = &s->plan.figures[i];
        const technique_use *motion = rule_use(fig->rule, KIND_MOTION);
        if (!fig->mover || !motion->technique->motion->of_meshes || !figure_has_solids(&s->plan, fig))
            continue;
        return refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED, "'blur' and 'accumulate' blur solids, too",
                      "motion '%s' is that of meshes: solids have no vertices", motion->technique->name);
    }
    return LMN_OK;
}

/* Layers of what moves and of what rests do not interleave. */
static void warn_of_movers(const session *s, warnings *warnings)
{
    bool moves = false, rests = false;
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        moves = moves || (s->plan.figures[i].mover && s->plan.figures[i].layered);
        rests = rests || (!s->plan.figures[i].mover && s->plan.figures[i].layered);
    }
    if (moves && rests)
        warnings_add(warnings, WARNING_UNUSED,
                     "motion: of what is seen through, moving parts are drawn over those that rest");
}

/* What moves would throw shadows, and the look has none. */
static void warn_of_shadows(const session *s, const scene_values *scene, warnings *warnings)
{
    for (size_t i = 0; i < s->plan.figure_count && !scene->shadows; i++) {
        const technique_use *use = s->plan.figures[i].mover ? rule_use(s->plan.figures[i].rule, KIND_MOTION) : NULL;
        for (size_t k = 0; use && k < use->technique->pass_count; k++) {
            const technique *t = use->technique;
            if (t->passes[k].writes == TARGET_SHADOW &&
                params_condition(t->passes[k].when, t->params, t->param_count, use->values))
                warnings_add(warnings, WARNING_UNUSED, "motion.%s: the look has no shadows (scene.shadows)",
                             t->passes[k].when);
        }
    }
}

/* Lines that files bring are strokes: pictures show surfaces alone, and lines that are found there are theirs. */
static void warn_of_lines(const session *s, const lmn_scene *scene, warnings *warnings)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure *fig = &s->plan.figures[i];
        bool          lines = fig->rule->use_counts[KIND_LINES] > 0;
        for (size_t k = 0; k < scene->part_count && !has_strokes(fig->rule); k++) {
            if (!fig->designated[k] || !scene->parts[k].lines || (!lines && scene->parts[k].triangles))
                continue;
            if (scene->parts[k].edge_lines) /* pictures find these edges themselves */
                continue;
            warnings_add(warnings, WARNING_UNUSED,
                         "lines that the file brings are drawn by looks with strokes (--set lines.operator=strokes)");
            return;
        }
    }
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

lmn_status drawing_refuse(const session *s, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                          warnings *warnings, lmn_error *error)
{
    refusal    refusals = {scene, desc->lenient, warnings, error};
    lmn_status status = refuse_time(&refusals, look, desc->time_s, true);
    if (status == LMN_OK && s->plan.figure_count == 0)
        status = refuse(&refusals, LMN_USAGE, WARNING_NO_MATCH, NULL,
                        "no rule of the look '%s' selects a part: the page stays empty", look->name);
    if (status == LMN_OK)
        status = refuse_strokes(&refusals, s);
    if (status == LMN_OK)
        status = refuse_scattered(&refusals, s);
    return status == LMN_OK ? refuse_marks(&refusals, s) : status;
}

/* What could not be drawn as it was asked for. */
static void keep_warnings(lmn_drawing *d, const lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                          const session *s)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    const upload       *up = &r->up;
    bool                cut_out = false, spares = false, lines = false;
    warn_of_marks(s, &d->warnings);
    warn_of_lines(s, scene, &d->warnings);
    warn_of_movers(s, &d->warnings);
    warn_of_shadows(s, v, &d->warnings);
    time_warn_of_rest(look, &r->pose, &d->warnings);
    for (size_t i = 0; i < up->item_count && !cut_out; i++) {
        const draw_item *item = &up->items[i];
        bool             blended = item->material >= 0 && scene->materials[item->material].alpha == ALPHA_BLEND;
        cut_out = blended && s->plan.opaque[item->part_index]; /* what is seen through keeps its opacity */
    }
    if (cut_out)
        warnings_add(&d->warnings, WARNING_TRANSPARENCY, "transparent materials are drawn as cut-outs");
    for (size_t i = 0; i < scene->part_count; i++)
        lines = lines || scene->parts[i].lines;
    if (up->section.cut.cell_count > 0 && up->triangles == 0 && !lines)
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
    return drawing_refuse(s, scene, look, desc, &d->warnings, error);
}

/* What lies below the lines of a sheet gets that from the sheet. */
static bool annotates(const lmn_look *look, const draw_options *options)
{
    return annotate_wanted(look) && !options->surfaces_only && !options->maps;
}

/* What is written beside the picture, laid out while its plan is there. */
static lmn_status lay_annotations(lmn_drawing *d, const session *s, const lmn_draw_desc *desc, lmn_error *error)
{
    const double   per_mm = s->plan.pixels_per_mm / samples_side(desc);
    annotated_view view = {.plan = &s->plan,
                           .camera = &s->frame.camera,
                           .box = {0, 0, desc->width / per_mm, desc->height / per_mm},
                           .visible = d->part_pixels,
                           .ground = s->plan.ground};
    const char    *name;
    bool           stated;
    if (unit_find(NULL, s->plan.scene, &view.unit_mm, &name, &stated, error) != LMN_OK || !stated)
        view.unit_mm = 0;
    sheet_begin(&d->annotations, view.box[2], view.box[3], per_mm);
    return annotate(&d->annotations, -1, &view, &d->warnings, error);
}

/* The extra frame of the maps: one sample a pixel. */
static lmn_status draw_buffers(frame_maps *maps, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                               const lmn_draw_desc *desc, lmn_error *error)
{
    enum { LARGE = 1 << 21 }; /* pixels from which on the drawing's own pictures are not kept while maps are read */
    session  s;
    warnings ignored = {0};
    if ((int64_t)desc->width * desc->height >= LARGE)
        gpu_targets_trim(r->g);
    lmn_status status = session_open(&s, r, scene, look, &(draw_options){.desc = desc, .maps = true}, &ignored, error);
    if (status == LMN_OK) {
        if (maps->on_gpu)
            frame_maps_open(maps, r->g, desc->width, desc->height);
        s.frame.maps = maps;
        frame_draw(&s.frame, NULL);
        status = gpu_check(r->g, error);
    }
    session_close(&s);
    warnings_release(&ignored);
    return status;
}

/* The maps in memory, which are counted too, and kept where they are asked for. */
static lmn_status draw_maps(lmn_drawing *d, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                            const lmn_draw_desc *desc, bool kept, lmn_error *error)
{
    lmn_status status = frame_maps_create(&d->maps, desc->width, desc->height, kept, error);
    if (status == LMN_OK)
        status = draw_buffers(&d->maps, r, scene, look, desc, error);
    if (status == LMN_OK && !d->part_pixels) {
        d->part_pixels = mem_calloc(scene->part_count + scene->ghost_count + 1, sizeof *d->part_pixels);
        status = d->part_pixels ? LMN_OK : error_memory(error);
        for (size_t i = 0, count = (size_t)desc->width * (size_t)desc->height; i < count && status == LMN_OK; i++)
            if (d->maps.id[i])
                d->part_pixels[d->maps.id[i] - 1]++;
    }
    if (!kept)
        frame_maps_release(&d->maps);
    return status;
}

/* The drawing whose frame is there. */
typedef struct drawn_frame {
    lmn_drawing         *drawing;
    const lmn_draw_desc *desc;
    bool                 annotated;
    double               start_ms;
} drawn_frame;

/* Takes what a frame has drawn. */
static lmn_status keep_frame(session *s, void *user, lmn_error *error)
{
    const drawn_frame   *drawn = user;
    lmn_drawing         *d = drawn->drawing;
    const lmn_draw_desc *desc = drawn->desc;
    if (!desc->textures)
        gpu_finish(s->renderer->g);
    d->frame_ms = clock_ms() - drawn->start_ms;
    d->programs = gpu_program_count(s->renderer->g);
    lmn_status status = gpu_check(s->renderer->g, error);
    memcpy(d->strokes, s->frame.strokes, sizeof d->strokes);
    d->search = s->frame.search;
    d->marks = s->frame.marks;
    d->traces = s->frame.traces;
    for (size_t i = 0; i < s->plan.figure_count; i++)
        d->has_traces = d->has_traces || (traces_of_rule(s->plan.figures[i].rule) && !s->plan.figures[i].unmarked);
    if (d->has_traces && s->renderer->pose.at_rest)
        trace_warn(&d->traces, &d->warnings);
    d->layers = s->frame.producer ? s->frame.layers : 1;
    d->producer = s->frame.producer;
    if (s->frame.lists_full)
        warnings_add(&d->warnings, WARNING_LAYER_MEMORY,
                     "layers did not fit into layers.memory and were peeled instead, which takes longer");
    if (status == LMN_OK && drawn->annotated)
        status = lay_annotations(d, s, desc, error);
    if (status == LMN_OK && d->kept && d->annotations.item_count)
        status = paint_picture(d, s->renderer->g, s->out, error);
    if (status == LMN_OK && d->kept) {
        d->kept->picture = s->out;
        s->out = NULL;
    } else if (status == LMN_OK) {
        status = read_pixels(d, s->renderer->g, s->out,
                             desc->window[2] > 0 ? desc->window : (const int[]){0, 0, d->width, d->height}, error);
    }
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
    drawn_frame drawn = {d, options->desc, annotates(look, options), clock_ms()};
    exposure    e;
    lmn_status  status = exposure_find(&e, &s->plan, error);
    if (status == LMN_OK && e.technique) {
        status = exposure_draw(&e, s, look, options, keep_frame, &drawn, error);
        d->traces.telling = e.telling;
        telling_warn(&e.telling, &d->warnings);
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

static lmn_status draw_picture(lmn_drawing **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                               const draw_options *options, lmn_error *error)
{
    const lmn_draw_desc *desc = options->desc;
    lmn_drawing         *d = mem_calloc(1, sizeof *d);
    if (!d)
        return error_memory(error);
    bool windowed = desc->window[2] > 0;
    d->width = windowed ? desc->window[2] : desc->width;
    d->height = windowed ? desc->window[3] : desc->height;
    if (desc->textures && !(d->kept = mem_calloc(1, sizeof *d->kept))) {
        mem_free(d);
        return error_memory(error);
    }
    session    s;
    lmn_status status = annotates(look, options) && annotate_wants_visible(look, scene)
                            ? draw_maps(d, r, scene, look, desc, false, error)
                            : LMN_OK;
    if (status != LMN_OK) {
        drawing_destroy(&d);
        return status;
    }
    status = session_open(&s, r, scene, look, options, &d->warnings, error);
    if (status == LMN_OK && cancelled(desc, 0.3, "drawing"))
        status = error_set(error, LMN_CANCELLED, "cancelled");
    if (status == LMN_OK)
        status = keep_facts(d, r, scene, look, &s, desc, error);
    if (status == LMN_OK)
        status = draw_frame(d, &s, look, options, error);
    session_close(&s);
    if (status == LMN_OK && cancelled(desc, 0.8, "drawing"))
        status = error_set(error, LMN_CANCELLED, "cancelled");
    if (status == LMN_OK && d->kept && desc->maps) {
        d->kept->maps.on_gpu = true;
        status = draw_buffers(&d->kept->maps, r, scene, look, desc, error);
    } else if (status == LMN_OK && (desc->maps || desc->profile)) {
        status = draw_maps(d, r, scene, look, desc, desc->maps, error);
    }
    kept_lend(d->kept, r);
    if (status != LMN_OK) {
        kept_drop(r);
        drawing_destroy(&d);
    }
    *out = d;
    return status;
}

lmn_status renderer_draw(lmn_drawing **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                         const draw_options *options, lmn_error *error)
{
    *out = NULL;
    lmn_status status = gpu_enter(r->g, error);
    if (status != LMN_OK)
        return status;
    status = gpu_leave(r->g, draw_picture(out, r, scene, look, options, error), error);
    if (status != LMN_OK)
        drawing_destroy(out);
    return status;
}

void drawing_destroy(lmn_drawing **drawing)
{
    if (!drawing || !*drawing)
        return;
    lmn_drawing *d = *drawing;
    mem_free(d->pixels);
    sheet_release(&d->annotations);
    frame_maps_release(&d->maps);
    kept_release(d->kept);
    warnings_release(&d->warnings);
    facts_release(&d->facts);
    mem_free(d->vendor);
    mem_free(d->renderer);
    mem_free(d->version);
    mem_free(d->part_pixels);
    mem_free(d);
    *drawing = NULL;
}
