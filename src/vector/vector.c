#include "vector/vector.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "annotate/annotate.h"
#include "base/clock.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/paper.h"
#include "base/work.h"
#include "plan/deformation.h"
#include "plan/plan.h"
#include "plan/refuse.h"
#include "plan/round_scene.h"
#include "plan/time.h"
#include "plan/unit.h"
#include "vector/vector_job.h"
#include "export/export.h"
#include "finish/finish.h"
#include "sheet/fit.h"
#include "stroke/hatch.h"
#include "light/light.h"

static const double speck_on_page = 0.1; /* mm; the thinnest pens draw wider lines */
/* Of what curves may be off: what points are left out for, and what writers round numbers by and arcs that they have
 * none of, mm. */
static const double simplified_part = 0.25, written_error = 0.0017;

/* Progress of a part of the work, as a part of the whole. */
static bool report_part(double fraction, const char *stage, void *user)
{
    vector_job *j = user;
    lmn_error   error;
    j->reported = fmax(j->reported, fmin(j->begun + fraction * j->fraction, 1)); /* each rule begins anew */
    return work_progress(j->reported, stage, &error) == LMN_OK;
}

static refusal refusal_of(const vector_job *j, lmn_error *error)
{
    return (refusal){j->scene, j->desc->lenient, &j->out->warnings, error};
}

/* --- what is drawn -------------------------------------------------------------------------------------- */

/* Of solids there is what bounds them: no marks, which lie on triangles, no lines of form, and nothing of what is taken
 * away. */
static lmn_status refuse_of_solids(const vector_job *j, lmn_error *error)
{
    const lmn_scene *scene = j->scene;
    refusal          r = refusal_of(j, error);
    stroke_options   options;
    stroke_style     style;
    size_t           marked = 0, formed = 0;
    bool             removed = false;
    for (size_t i = 0; i < scene->part_count; i++) {
        const rule *own = scene->nodes[scene->parts[i].node].solid != NONE ? plan_rule(&j->plan, i) : NULL;
        marked += own && vector_rule_marks(own);
        formed += own && vector_rule_strokes(own, &options, &style) && stroke_options_form(&options);
    }
    for (size_t i = 0; i < j->look->rule_count && j->pose.ghost_count; i++)
        removed = removed || (j->look->rules[i].selector && selector_names_removed(j->look->rules[i].selector) &&
                              vector_rule_strokes(&j->look->rules[i], &options, &style));
    lmn_status status = LMN_OK;
    if (marked)
        status = refuse(&r, LMN_UNSUPPORTED, WARNING_NO_STROKES, "take a look without marks, or draw a picture (.png)",
                        "marks lie on meshes: %zu solids of set operations have their lines alone", marked);
    if (status == LMN_OK && formed)
        status = refuse(
            &r, LMN_UNSUPPORTED, WARNING_NO_STROKES, NULL,
            "lines of form (suggestive, ridges, valleys, apparent) are those of meshes: %zu solids have none", formed);
    if (status == LMN_OK && removed)
        status = refuse(&r, LMN_UNSUPPORTED, WARNING_NO_STROKES, "draw a picture (.png)",
                        "what solids take away has no lines in vector drawings");
    return status;
}

/* Which parts are drawn, by which rules. */
static lmn_status plan_parts(vector_job *j, lmn_error *error)
{
    const lmn_scene   *scene = j->scene;
    const plan_options options = {.on_sheet = true,
                                  .select = j->desc->select,
                                  .background = j->desc->background,
                                  .pixels_per_mm = VECTOR_PIXELS_PER_MM,
                                  .parts_only = true};
    moment             when;
    lmn_status         status = time_moment(&when, scene, j->desc, &j->out->warnings, error);
    if (status == LMN_OK)
        status = deformation_find(&j->deformation, &when, scene, j->look, &j->out->warnings, error);
    if (status == LMN_OK)
        status = pose_create(&j->pose, scene, &when, error);
    if (status == LMN_OK) {
        pose_warn_of_flat(&j->pose, &j->out->warnings);
        pose_warn_of_rigid(&j->pose, &j->out->warnings);
    }
    if (status == LMN_OK && j->desc->fit_time)
        status = swept_boxes_fit(&j->swept, &j->pose, error);
    if (status == LMN_OK)
        status = plan_create(&j->plan, &j->pose, j->look, &options, &j->out->warnings, error);
    if (status == LMN_OK)
        j->look = j->plan.look;
    for (size_t i = 0; i < scene->part_count && status == LMN_OK; i++)
        j->stroked[i] = plan_rule(&j->plan, i) != NULL;
    return status == LMN_OK ? refuse_of_solids(j, error) : status;
}
/* What the look cuts away, of surfaces and lines alike. */
static lmn_status find_section(vector_job *j, lmn_error *error)
{
    return section_find(&j->section, &j->pose, j->look, j->desc->select, error);
}

/* What is neither lines nor a shape. */
static bool is_seen_in_pictures_alone(const technique_use *motion)
{
    return motion && (motion->technique->motion->times || motion->technique->pass_count);
}

/* A picture of several times is none of lines. */
static lmn_status refuse_motion(const vector_job *j, lmn_error *error)
{
    refusal r = refusal_of(j, error);
    time_warn_of_rest(j->look, &j->pose, &j->out->warnings);
    for (size_t i = 0; j->pose.at_rest && i < j->look->rule_count; i++)
        if (is_seen_in_pictures_alone(rule_use(&j->look->rules[i], KIND_MOTION)))
            return refuse(&r, LMN_USAGE, WARNING_UNUSED, "draw a picture (.png), or set motion.technique=none",
                          "motion '%s' has no lines in vector drawings, which show one time",
                          rule_use(&j->look->rules[i], KIND_MOTION)->technique->name);
    return LMN_OK;
}

static void lay_ground(vector_job *j)
{
    const sheet_values *finish = j->look->wide[KIND_FINISH].values;
    const scene_values *scene = j->look->wide[KIND_SCENE].values;
    j->out->page.ground = j->plan.ground;
    if (scene->ground != GROUND_NONE && (j->lines_only || j->wanted->fill)) /* where a renderer lacks, that is said */
        warnings_add(&j->out->warnings, WARNING_UNUSED,
                     "scene.ground: the shadow on the ground is left out of drawings of lines alone");
    if (finish->paper && !j->pixels)
        warnings_add(&j->out->warnings, WARNING_UNUSED,
                     "finish.paper: the grain of paper is left out of drawings of lines alone");
}

static lmn_status begin_page(vector_job *j, lmn_error *error)
{
    double     resolution = paper_pixels_per_mm(j->desc->width, j->desc->height, j->desc->dpi);
    double     size[2] = {j->desc->width / resolution, j->desc->height / resolution};
    lmn_status status = vector_check_fields(j->wanted, error);
    if (status == LMN_OK)
        status = vector_take_header(j, error);
    if (status == LMN_OK && j->wanted->page)
        status = vector_parse_page(j->wanted->page, size, error);
    if (status == LMN_OK && j->wanted->scale)
        status = vector_parse_scale(j->wanted->scale, &j->scale, error);
    if (status == LMN_OK)
        status = unit_find(j->wanted->unit, j->scene, &j->unit_mm, &j->out->unit, &j->unit_stated, error);
    if (status != LMN_OK)
        return status;
    if (!j->unit_stated && (j->scale > 0 || j->wanted->frame))
        warnings_add(&j->out->warnings, WARNING_PAGE, "the file does not say its unit; it is taken for millimetres");
    j->usual_scale = j->wanted->frame;
    sheet_begin(&j->out->page, size[0], size[1], VECTOR_PIXELS_PER_MM);
    return LMN_OK;
}

/* --- drawing -------------------------------------------------------------------------------------------- */

/* As finely as the picture would be drawn; on a page of its own 96 pixels an inch, or as many as are asked for. */
static void set_resolution(const vector_job *j, lmn_draw_desc *d)
{
    bool   stated = !j->wanted->page || j->desc->dpi > 0;
    double finer =
        stated ? paper_pixels_per_mm(j->desc->width, j->desc->height, j->desc->dpi) / VECTOR_PIXELS_PER_MM : 1;
    finer = fmin(finer, (double)LIMIT_PICTURE_SIDE / (d->width > d->height ? d->width : d->height));
    d->width = (int)fmax(round(d->width * finer), 1);
    d->height = (int)fmax(round(d->height * finer), 1);
    d->dpi = PX_PER_INCH * finer;
}

/* Of the circle that a detail is cut out at, pixels of the view. */
static double radius_of_detail(const vector_view *v)
{
    return v->extra->radius * v->height / (2 * v->camera.half_height);
}

/* Nothing is seen outside of a circle around the middle; its radius is a fraction of the width. */
static void keep_circle(uint8_t *pixels, int width, int height, double radius)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double   away = hypot(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height), in = radius * width - away + 0.5;
            uint8_t *alpha = &pixels[4 * ((size_t)y * (size_t)width + (size_t)x) + 3];
            *alpha = (uint8_t)lrint(*alpha * fmin(fmax(in, 0), 1));
        }
}

/* The surfaces of a view as pixels. The eye is given, so that the camera is the same. */
static lmn_status put_picture(vector_job *j, const vector_view *v, uint32_t group, lmn_error *error)
{
    uint8_t      *pixels = NULL;
    lmn_draw_desc d = vector_view_desc(j, v);
    char          ground[10];
    colour_print(j->plan.ground, ground);
    d.background = ground;
    d.maps = d.profile = false;
    d.progress = NULL;
    set_resolution(j, &d);
    if (!d.camera) {
        double distance =
            v->camera.orthographic ? v->camera.half_height / tan(d.fov_deg * (3.14159265358979323846 / 360)) : 0;
        for (int k = 0; k < 3; k++) {
            double forward = -v->camera.view.m[4 * k + 2];
            d.eye[k] = v->camera.orthographic ? v->camera.target[k] - forward * distance : v->camera.eye[k];
            d.target[k] = v->camera.target[k];
            d.up[k] = v->camera.up[k];
        }
        d.eye_given = true;
        d.fit_direction = false;
        d.orthographic = v->camera.orthographic;
    }
    char cut[VECTOR_CUT_TEXT_SIZE];
    if (j->cut_open)
        vector_cut_text(j, j->cut_open, cut, sizeof cut);
    lmn_status status = j->draw_surfaces(&pixels, &d, j->cut_open ? cut : NULL, j->user, error);
    if (status == LMN_OK && v->extra && v->extra->kind == DRAFT_DETAIL)
        keep_circle(pixels, d.width, d.height, radius_of_detail(v) / v->width);
    export_bytes png = {0};
    if (status == LMN_OK)
        status = export_png(&png, pixels, d.width, d.height, error);
    if (status == LMN_OK)
        sheet_add_image(&j->out->page, group, png.data, png.size, v->box[0], v->box[1], v->box[2], v->box[3]);
    mem_free(png.data);
    mem_free(pixels);
    return status;
}

static void count_strokes(vector_job *j, const stroke_set *set, const stroke_style *style)
{
    j->out->search.faces += set->search.faces;
    j->out->search.tested += set->search.tested;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        bool          drawn = s->hidden_by == 0 || (style->hidden != HIDDEN_NONE &&
                                           (style->hidden_depth <= 0 || s->hidden_by <= (uint32_t)style->hidden_depth));
        j->out->counts[s->kind] += drawn;
        j->out->hidden += drawn && s->hidden_by > 0;
        if (s->hidden_by == 0 && s->part > 0 && s->part <= j->out->facts.part_count)
            j->out->part_strokes[s->part - 1]++;
    }
}

/* The parts that a rule draws, and how many they are; NULL: memory is gone. */
static bool *parts_of(const vector_job *j, const rule *r, size_t *count)
{
    bool *parts = mem_calloc(j->scene->part_count, sizeof *parts);
    *count = 0;
    for (size_t i = 0; parts && i < j->scene->part_count; i++) {
        parts[i] = j->stroked[i] && plan_rule(&j->plan, i) == r;
        *count += parts[i];
    }
    return parts;
}

/* Where a rule's marks may lie in what is cut away, as some of its parts are spared, only what lies beside surfaces
 * goes. */
static bool spares_any(const vector_job *j, const bool *parts)
{
    bool any = false;
    for (size_t i = 0; i < j->scene->part_count && j->spared; i++)
        any = any || (parts[i] && j->spared[i]);
    return any;
}

/* The marks of one rule's parts. */
static lmn_status draw_marks(vector_job *j, const stroke_view *view, const vector_view *v, const rule *r,
                             const vector_ink *ink, const cut *cut, lmn_error *error)
{
    const technique_use *surface = vector_rule_marks(r);
    size_t               count = 0;
    if (!surface)
        return LMN_OK;
    bool *parts = parts_of(j, r, &count);
    if (!parts)
        return error_memory(error);
    vector_marks m = {.view = view,
                      .cut = cut->cell_count && !spares_any(j, parts) ? cut : NULL,
                      .ground = j->plan.ground,
                      .one_pen = j->wanted->plotter,
                      .part_marks = j->out->part_marks,
                      .options = {.pose = &j->pose,
                                  .look = j->look,
                                  .parts = parts,
                                  .part_count = j->scene->part_count,
                                  .crease_angle = j->plan.crease_angle,
                                  .surface = surface,
                                  .camera = &v->camera,
                                  .width = v->width,
                                  .height = v->height}};
    lmn_status   status = LMN_OK;
    if (!report_part(0, "marks", j))
        status = error_set(error, LMN_CANCELLED, "cancelled");
    else if (count)
        status = vector_put_marks(ink, &m, error);
    mem_free(parts);
    j->out->dots += m.dots;
    j->out->marks += m.lines;
    return status;
}

/* Where parts of two rules run through each other, the line is its own part's; the other rule has it only where
 * that one draws no such lines. */
static void keep_own_crossings(const vector_job *j, stroke_set *set, const rule *r)
{
    size_t kept = 0;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke  *s = &set->strokes[i];
        const rule    *owner = s->kind == STROKE_INTERSECTION && s->part > 0 && s->part <= j->scene->part_count
                                   ? plan_rule(&j->plan, s->part - 1)
                                   : r;
        stroke_options options = {.intersections = false};
        stroke_style   style;
        if (owner != r && owner && vector_rule_strokes(owner, &options, &style) && options.intersections)
            continue;
        set->strokes[kept++] = *s;
    }
    set->stroke_count = kept;
}

/* The strokes of one rule's parts, as ribbons. */
static lmn_status draw_rule(vector_job *j, stroke_view *view, const rule *r, ribbon_set *out, lmn_error *error)
{
    stroke_options options;
    stroke_style   style;
    stroke_set     set = {0};
    size_t         count = 0;
    *out = (ribbon_set){0};
    if (!vector_rule_strokes(r, &options, &style))
        return LMN_OK;
    if (j->wanted->line_group > 0)
        vector_style_in_group(&style, j->wanted->line_group);
    if (j->cut_open) { /* what lies behind a section is not drawn there */
        style.hidden = HIDDEN_NONE;
        options.hidden = false;
    }
    options.width = style.width;
    options.island = ribbons_island(&style);
    options.figure = ribbons_figure(&style);
    options.fine = (float)(simplified_part * j->wanted->smooth * VECTOR_PIXELS_PER_MM);
    style.keeps_dashed = !j->wanted->plotter;
    bool *parts = parts_of(j, r, &count);
    if (!parts)
        return error_memory(error);
    lmn_status status = count ? stroke_find(&set, view, &options, parts, report_part, j, error) : LMN_OK;
    mem_free(parts);
    keep_own_crossings(j, &set, r);
    if (status == LMN_OK)
        status = ribbons_make(out, &set, &style, j->desc->seed, error);
    if (status == LMN_OK)
        count_strokes(j, &set, &style);
    if (status == LMN_OK && j->wanted->verify && set.stroke_count) {
        stroke_check check = {0};
        status = stroke_verify(&check, &set, view, VECTOR_VERIFY_APART, report_part, j, error);
        j->out->check.samples += check.samples;
        j->out->check.wrong += check.wrong;
        j->out->verified = true;
    }
    stroke_set_release(&set);
    return status;
}

/* Speed lines and contours of the past of a rule's parts. */
static lmn_status draw_traces(vector_job *j, const stroke_view *view, const stroke_camera *camera, const rule *r,
                              ribbon_set *out, lmn_error *error)
{
    size_t      count = 0;
    trace_facts facts = {0};
    bool       *parts = traces_of_rule(r) ? parts_of(j, r, &count) : NULL;
    if (!traces_of_rule(r))
        return LMN_OK;
    if (!parts)
        return error_memory(error);
    traces_options options = {.pose = &j->pose,
                              .parts = parts,
                              .values = traces_of_rule(r),
                              .camera = *camera,
                              .seen = view,
                              .crease_angle = j->plan.crease_angle,
                              .seed = j->desc->seed};
    traces_take_lines(&options, r);
    lmn_status status = count ? traces_make(out, &facts, &options, error) : LMN_OK;
    for (size_t i = 0; i < out->ribbon_count && status == LMN_OK; i++)
        j->out->counts[out->ribbons[i].kind]++;
    trace_facts_add(&j->out->traces, &facts);
    j->out->has_traces = true;
    mem_free(parts);
    return status;
}

static lmn_status draw_lines(vector_job *j, stroke_view *view, const stroke_camera *camera, const vector_ink *ink,
                             lmn_error *error)
{
    size_t      rules = j->look->rule_count;
    ribbon_set *sets = mem_calloc(2 * rules + 1, sizeof *sets); /* lines, then traces */
    lmn_status  status = sets ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < rules && status == LMN_OK; i++)
        status = draw_rule(j, view, &j->look->rules[i], &sets[i], error);
    for (size_t i = 0; i < rules && status == LMN_OK; i++)
        status = draw_traces(j, view, camera, &j->look->rules[i], &sets[rules + i], error);
    if (status == LMN_OK)
        status = vector_put_ribbons(ink, sets, 2 * rules, error);
    for (size_t i = 0; sets && i < 2 * rules; i++)
        ribbon_set_release(&sets[i]);
    mem_free(sets);
    return status;
}

/* In layers cut faces are hatched in the ink of the lines, as in pictures. */
static colour colour_of_hatch(const rule *r, colour otherwise)
{
    const technique_use *compose = r ? rule_use(r, KIND_COMPOSE) : NULL;
    stroke_options       options = {.intersections = false};
    stroke_style         style;
    bool layered = compose && compose->technique->compose->layered && vector_rule_strokes(r, &options, &style);
    return layered ? style.colours[STROKE_CONTOUR] : otherwise;
}

static lmn_status draw_hatch(vector_job *j, const stroke_view *view, const vector_ink *ink, lmn_error *error)
{
    scene_values values = *(const scene_values *)j->look->wide[KIND_SCENE].values, *v = &values;
    stroke_check check = {0};
    if (j->wanted->line_group > 0)
        v->cut_width = (float)(vector_narrow(j) * VECTOR_PIXELS_PER_MM);
    if (j->cut_open) /* 45 degrees to the page, whatever it is cut along */
        v->cut_angle -= (float)hatch_turn(draft_section_axis(j->cut_open));
    colour *colours = mem_alloc((j->scene->part_count + 1) * sizeof *colours);
    for (size_t i = 0; colours && i < j->scene->part_count; i++)
        colours[i] = colour_of_hatch(plan_rule(&j->plan, i), v->cut_colour);
    lmn_status status =
        colours ? vector_put_hatch(ink, view, v, j->stroked, colours, j->wanted->loose_hatch || j->wanted->plotter,
                                   &j->out->hatches, j->wanted->verify ? &check : NULL, error)
                : error_memory(error);
    mem_free(colours);
    j->out->check.samples += check.samples;
    j->out->check.wrong += check.wrong;
    return status;
}

/* What lies on surfaces, and lines over it. */
static lmn_status draw_ink(vector_job *j, const vector_view *v, const vector_ink *ink, const cut *cut, lmn_error *error)
{
    stroke_view  *view = NULL;
    stroke_camera camera = {v->camera.view, v->camera.projection, v->camera.near, v->camera.orthographic, v->width,
                            v->height};
    lmn_status    status = stroke_view_create(&view, j->shown, &camera, report_part, j, error);
    stroke_view  *as_is = NULL;
    if (status == LMN_OK && j->as_is.item_count)
        status = stroke_view_create(&as_is, &j->as_is, &camera, report_part, j, error);
    for (size_t i = 0; i < j->look->rule_count && status == LMN_OK; i++)
        status = draw_marks(j, as_is ? as_is : view, v, &j->look->rules[i], ink, cut, error);
    stroke_view_destroy(&as_is);
    if (status == LMN_OK && cut->cell_count)
        status = draw_hatch(j, view, ink, error);
    if (status == LMN_OK)
        status = draw_lines(j, view, &camera, ink, error);
    if (status == LMN_OK)
        status = vector_put_threads(j, v, view, cut, ink->group, error);
    if (status == LMN_OK)
        status = vector_put_centres(j, v, view, cut, ink->group, error);
    if (status == LMN_OK && j->out->has_traces && j->pose.at_rest)
        trace_warn(&j->out->traces, &j->out->warnings);
    stroke_view_destroy(&view);
    return status;
}

/* Parts of which no stroke is seen have no label; where there are no strokes at all, nobody knows. */
static lmn_status put_annotations(vector_job *j, const vector_view *v, uint32_t group, lmn_error *error)
{
    bool known = false;
    for (size_t i = 0; i < j->scene->part_count; i++)
        known = known || j->out->part_strokes[i];
    annotated_view view = {.plan = &j->plan,
                           .camera = &v->camera,
                           .box = {v->box[0], v->box[1], v->box[2], v->box[3]},
                           .visible = known ? j->out->part_strokes : NULL,
                           .unit_mm = j->unit_stated ? j->unit_mm : 0,
                           .ground = j->plan.ground};
    return annotate(&j->out->page, (int32_t)group, &view, &j->out->warnings, error);
}

/* The part that a group is of, or that around it; 0: none. */
static uint32_t part_of_group(const sheet *page, uint32_t group)
{
    int32_t at = (int32_t)group;
    while (at >= 0 && !page->groups[at].part)
        at = page->groups[at].parent;
    return at >= 0 ? page->groups[at].part : 0;
}

/* Ghost images are mixed with paper, as in pictures. */
static void make_paler(vector_job *j, size_t first)
{
    sheet       *page = &j->out->page;
    const colour ground = page->ground.a > 0 ? page->ground : (colour){1, 1, 1, 1};
    for (size_t i = first; i < page->item_count; i++) {
        sheet_item    *item = &page->items[i];
        const uint32_t part = part_of_group(page, item->group);
        const rule    *r = part > 0 && part <= j->scene->part_count ? plan_rule(&j->plan, part - 1) : NULL;
        if (!r || r->pale <= 0)
            continue;
        item->ink.r += (ground.r - item->ink.r) * r->pale;
        item->ink.g += (ground.g - item->ink.g) * r->pale;
        item->ink.b += (ground.b - item->ink.b) * r->pale;
    }
}

/* A detail ends at its circle, whose rim is drawn by a break line. */
static void cut_out_detail(sheet *page, const vector_view *v, size_t first)
{
    const double centre[2] = {v->box[0] + v->box[2] / 2, v->box[1] + v->box[3] / 2};
    sheet_clip_circle(page, first, centre, radius_of_detail(v) / VECTOR_PIXELS_PER_MM);
}

static lmn_status draw_view(vector_job *j, const vector_view *v, const cut *cut, lmn_error *error)
{
    sheet       *page = &j->out->page;
    const size_t first = page->item_count;
    char         name[32];
    lmn_status   status = LMN_OK;
    snprintf(name, sizeof name, "view-%s", v->name);
    uint32_t   group = sheet_add_group(page, -1, strcmp(v->name, "view") == 0 ? "view" : name, "view", 0);
    vector_ink ink = {page, j->scene, group, {v->box[0], v->box[1]}, j->lines_only};
    if (j->pixels)
        status = put_picture(j, v, sheet_add_group(page, (int32_t)group, "surfaces", "surfaces", 0), error);
    if (status == LMN_OK && j->wanted->fill && !j->lines_only)
        status = vector_put_fills(page, &ink, v, j->shown, &j->plan, report_part, j, error);
    if (status == LMN_OK)
        status = draw_ink(j, v, &ink, cut, error);
    if (status == LMN_OK && !v->extra)
        status = vector_put_revolved(j, v, group, error);
    if (v->extra && v->extra->kind == DRAFT_DETAIL)
        cut_out_detail(page, v, first);
    make_paler(j, first);
    return status == LMN_OK && annotate_wanted(j->look) && !j->wanted->plotter ? put_annotations(j, v, group, error)
                                                                               : status;
}

colour vector_frame_ink(colour ground)
{
    float light = 0.2126f * ground.r + 0.7152f * ground.g + 0.0722f * ground.b;
    return ground.a > 0 && light < 0.2f ? (colour){1, 1, 1, 1} : (colour){0.01f, 0.01f, 0.01f, 1};
}

static void warn_of_open(vector_job *j)
{
    if (j->strokes.open_parts)
        warnings_add(&j->out->warnings, WARNING_CUT_OPEN, "%zu parts are not closed and have no cut face there",
                     j->strokes.open_parts);
    if (j->strokes.open_operands)
        warnings_add(
            &j->out->warnings, WARNING_BAD_GEOMETRY,
            "%u operands of solids are not closed: lines are where an odd number of their faces encloses something",
            (unsigned)j->strokes.open_operands);
}

/* What all views draw on: surfaces as fine as the rule that wants them finest. */
static lmn_status make_scene(vector_job *j, lmn_error *error)
{
    double  crease = j->plan.crease_angle;
    int32_t refine = 0;
    bool    bends = false;
    for (size_t i = 0; i < j->scene->part_count; i++) {
        stroke_options options;
        stroke_style   style;
        if (!j->stroked[i] || !vector_rule_strokes(plan_rule(&j->plan, i), &options, &style))
            continue;
        refine = options.refine > refine ? options.refine : refine;
        bends = bends || stroke_options_bend(&options);
    }
    const stroke_section section = {&j->section.cut, j->section.spared};
    lmn_status           status =
        stroke_scene_create_cut(&j->strokes, &j->pose, j->stroked, crease, refine, &section, report_part, j, error);
    if (status == LMN_OK)
        warn_of_open(j);
    if (status == LMN_OK && bends)
        status = stroke_scene_bend(&j->strokes, report_part, j, error);
    bool marked = false;
    for (size_t i = 0; i < j->look->rule_count; i++)
        marked = marked || vector_rule_marks(&j->look->rules[i]);
    return status == LMN_OK && marked && refine > 0
               ? stroke_scene_create_cut(&j->as_is, &j->pose, j->stroked, crease, 0, &section, report_part, j, error)
               : status;
}

/* A section has a scene of its own. */
static lmn_status draw_section(vector_job *j, const vector_view *v, lmn_error *error)
{
    section      own = {.spared = NULL};
    stroke_scene scene = {0};
    memset(&own.cut, 0, sizeof own.cut);
    lmn_status           status = vector_section(&own, j, v->extra, error);
    const stroke_section cut = {&own.cut, own.spared};
    if (status == LMN_OK)
        status =
            stroke_scene_create_cut(&scene, &j->pose, j->stroked, j->plan.crease_angle, 0, &cut, report_part, j, error);
    if (status == LMN_OK) {
        vector_hide_turns(&scene, v->extra);
        vector_settle_rims(&scene, v->extra);
        j->shown = &scene;
        j->cut_open = v->extra;
        j->spared = own.spared;
        status = draw_view(j, v, &own.cut, error);
        j->shown = &j->strokes;
        j->cut_open = NULL;
        j->spared = j->section.spared;
    }
    stroke_scene_release(&scene);
    section_release(&own);
    return status;
}

/* How large the largest view of the model is on the page, mm; infinite where that is not told by a scale. */
static double size_on_page(const vector_job *j)
{
    double most = 0;
    for (size_t i = 0; i < j->out->view_count && j->out->scale > 0; i++) {
        double    size[2];
        lmn_error ignored = {0};
        if (vector_measure_view(j, &j->out->views[i], size, &ignored) == LMN_OK)
            most = fmax(most, fmax(size[0], size[1]) * j->unit_mm * j->out->scale);
    }
    return j->out->scale > 0 ? most : INFINITY;
}

/* A page on which nothing of the model is to be seen is no drawing of it. */
static lmn_status check_page(vector_job *j, lmn_error *error)
{
    lmn_sheet *s = j->out;
    refusal    r = refusal_of(j, error);
    char       scale[32], instead[80] = "";
    double     size = j->wanted->scale ? size_on_page(j) : INFINITY;
    bool       speck = size < speck_on_page;
    if (s->page.item_count > 0 && !speck)
        return LMN_OK;
    if (!j->wanted->scale && s->view_count == 1 && !j->desc->eye_given && !j->desc->camera)
        return refuse(&r, LMN_USAGE, WARNING_PAGE, "take another look, or draw a picture (.png)",
                      "nothing of the model lies on the page: the look '%s' has no strokes for it",
                      j->look->name ? j->look->name : "");
    double fitting = vector_scale_that_fits(j, error);
    if (fitting > 0 && s->scale > 0) {
        vector_print_scale(scale, fitting);
        snprintf(instead, sizeof instead, "it fits at --scale %s", scale);
    }
    if (speck)
        return refuse(&r, LMN_USAGE, WARNING_PAGE, *instead ? instead : NULL,
                      "at %s the model is %.2g mm large on the page, with %s as its unit", s->scale_text, size,
                      s->unit);
    return refuse(&r, LMN_USAGE, WARNING_PAGE, *instead ? instead : NULL, "nothing of the model lies on the page%s%s",
                  s->scale > 0 ? " at " : "", s->scale > 0 ? s->scale_text : "");
}

/* What reaches beyond the paper, or the inside of its frame, is cut off: plotters and CAD programs have no clips. */
static lmn_status finish_page(vector_job *j, lmn_error *error)
{
    lmn_sheet *s = j->out;
    double     area[4] = {0, 0, s->page.width, s->page.height};
    if (j->wanted->frame)
        vector_inside_frame(j->wanted, s->page.width, s->page.height, area);
    bool cut = sheet_clip(&s->page, area[0], area[1], area[2], area[3]);
    if (cut && j->wanted->scale && !j->wanted->views)
        warnings_add(&s->warnings, WARNING_PAGE, "at %s the model reaches beyond the page", j->wanted->scale);
    lmn_status status = check_page(j, error);
    if (status == LMN_OK)
        vector_put_frame(s, j->wanted, vector_frame_ink(s->page.ground));
    return status;
}

static lmn_status draw_sheet(vector_job *j, lmn_error *error)
{
    lmn_sheet *s = j->out;
    lmn_status status = work_progress(0.3, "drawing", error);
    j->begun = 0.3;
    j->fraction = 0.2;
    if (status == LMN_OK)
        status = make_scene(j, error);
    j->shown = &j->strokes;
    j->spared = j->section.spared;
    if (status == LMN_OK)
        status = vector_find_axes(j, error);
    for (size_t i = 0; i < s->view_count && status == LMN_OK; i++) {
        j->fraction = 0.45 / (double)s->view_count;
        j->begun = 0.5 + j->fraction * (double)i;
        status = s->views[i].extra && s->views[i].extra->kind == DRAFT_SECTION
                     ? draw_section(j, &s->views[i], error)
                     : draw_view(j, &s->views[i], &j->section.cut, error);
    }
    if (status == LMN_OK)
        vector_put_marks_of_views(j);
    if (status == LMN_OK)
        status = finish_page(j, error);
    if (status == LMN_OK && j->wanted->plotter)
        status = vector_order_for_plotter(&s->page, error);
    if (status == LMN_OK)
        sheet_fit(&s->page, (1 - simplified_part) * j->wanted->smooth - written_error);
    if (status == LMN_OK && s->page.failed)
        status = error_memory(error);
    return status == LMN_OK ? work_progress(0.95, "drawing", error) : status;
}

/* Marks of vector drawings know the look's lights, and no more than these. */
static void warn_of_marks(vector_job *j)
{
    const scene_values *scene = j->look->wide[KIND_SCENE].values;
    bool                any = false, again = false;
    for (size_t i = 0; i < j->look->rule_count; i++) {
        const technique_use *surface = rule_use(&j->look->rules[i], KIND_SURFACE);
        any = any || vector_rule_marks(&j->look->rules[i]);
        again = again || (surface && surface->technique->surface->marks && rule_shades_again(&j->look->rules[i]));
    }
    if (again)
        warnings_add(&j->out->warnings, WARNING_UNUSED,
                     "a composition that shades again leaves out the marks of surfaces; 'opaque' draws them");
    if (any && (scene->shadows || scene->occlusion > 0 || scene->focus > 0))
        warnings_add(
            &j->out->warnings, WARNING_UNUSED,
            "shadows, occlusion and depth focus do not change the dots and strokes of surfaces in vector drawings");
}

static lmn_status keep_facts(vector_job *j, lmn_error *error)
{
    lmn_sheet *s = j->out;
    size_t     count = j->scene->part_count;
    lmn_status status = facts_take(&s->facts, &j->pose, j->look, count, j->desc->seed, error);
    if (status != LMN_OK)
        return status;
    s->facts.bounds = j->plan.box;
    s->part_strokes = mem_calloc(count, sizeof *s->part_strokes);
    s->part_marks = mem_calloc(count, sizeof *s->part_marks);
    if (!s->part_strokes || !s->part_marks)
        return error_memory(error);
    for (size_t i = 0; i < count; i++)
        s->facts.triangles += j->scene->parts[i].triangles * node_draw_count(&j->scene->nodes[j->scene->parts[i].node]);
    char description[256];
    snprintf(description, sizeof description, "Look %.100s; %zu parts%s%s", s->facts.look, count,
             *s->scale_text ? "; scale " : "", s->scale_text);
    const char *file = j->scene->file_count ? strrchr(j->scene->files[0], '/') : NULL, *title = j->wanted->title;
    file = file ? file + 1 : j->scene->file_count ? j->scene->files[0] : NULL;
    sheet_set_title(&s->page, title && *title ? title : file, description);
    warn_of_marks(j);
    refusal r = refusal_of(j, error);
    return refuse_time(&r, j->look, j->desc->time_s, false);
}

/* Everything that is known before the first line is drawn. */
static lmn_status prepare(vector_job *j, lmn_error *error)
{
    lmn_status status = plan_parts(j, error);
    if (status == LMN_OK)
        status = begin_page(j, error);
    if (status == LMN_OK)
        status = find_section(j, error);
    if (status == LMN_OK)
        status = refuse_motion(j, error);
    if (status != LMN_OK)
        return status;
    lay_ground(j);
    status = vector_place_all(j, error);
    return status == LMN_OK ? keep_facts(j, error) : status;
}

static void end_job(vector_job *j)
{
    stroke_scene_release(&j->strokes);
    stroke_scene_release(&j->as_is);
    section_release(&j->section);
    draft_cylinders_release(&j->cylinders);
    draft_pitches_release(&j->pitches);
    draft_threads_release(&j->threads);
    draft_thread_scene_release(&j->smooth);
    mem_free(j->threaded);
    plan_release(&j->plan);
    swept_boxes_release(&j->swept);
    pose_deformation_release(&j->deformation);
    pose_release(&j->pose);
    round_scene_release(&j->round);
    mem_free(j->stroked);
    mem_free(j->fields);
}

lmn_status vector_draw(lmn_sheet **out, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                       const lmn_sheet_desc *wanted, surfaces_fn draw_surfaces, void *user, lmn_error *error)
{
    double start = clock_ms();
    bool   surfaces = vector_needs_pixels(look);
    *out = NULL;
    vector_job j = {.draw_surfaces = draw_surfaces,
                    .user = user,
                    .scene = scene,
                    .look = look,
                    .desc = desc,
                    .wanted = wanted,
                    .lines_only = wanted->lines_only || wanted->plotter};
    bool       wants_pixels = surfaces && !j.lines_only && !wanted->fill;
    j.out = mem_calloc(1, sizeof *j.out);
    j.stroked = mem_calloc(scene->part_count, sizeof *j.stroked);
    j.pixels = wants_pixels && draw_surfaces;
    lmn_status status = j.out && j.stroked ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        warnings_append(&j.out->warnings, &scene->warnings);
        if (wants_pixels && !draw_surfaces)
            warnings_add(&j.out->warnings, WARNING_NO_STROKES,
                         "the surfaces of the look '%s' need pixels and a renderer; lines alone are drawn",
                         look->name ? look->name : "");
        status = round_scene_find(&j.scene, &j.round, scene, look, error);
    }
    if (status == LMN_OK)
        status = vector_smooth_threads(&j, error);
    if (status == LMN_OK)
        status = prepare(&j, error);
    if (status == LMN_OK)
        status = draw_sheet(&j, error);
    end_job(&j);
    if (status != LMN_OK) {
        vector_destroy(&j.out);
        return status;
    }
    j.out->frame_ms = clock_ms() - start;
    *out = j.out;
    return LMN_OK;
}

void vector_destroy(lmn_sheet **sheet)
{
    if (!sheet || !*sheet)
        return;
    lmn_sheet *s = *sheet;
    sheet_release(&s->page);
    warnings_release(&s->warnings);
    facts_release(&s->facts);
    mem_free(s->part_strokes);
    mem_free(s->part_marks);
    mem_free(s);
    *sheet = NULL;
}
