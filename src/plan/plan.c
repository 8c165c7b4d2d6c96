#include "plan/plan.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/paper.h"
#include "compose/compose.h"
#include "finish/finish.h"
#include "layer/layer.h"
#include "light/light.h"
#include "lines/lines.h"
#include "plan/ground.h"
#include "plan/pale.h"
#include "plan/paper_look.h"
#include "plan/refuse.h"
#include "scene/content.h"

const technique_use *rule_use(const rule *r, kind_id id)
{
    return r->use_counts[id] ? &r->uses[id][0] : NULL;
}

bool technique_draws_strokes(const technique *t)
{
    for (size_t i = 0; i < t->pass_count; i++)
        if (t->passes[i].strokes)
            return true;
    return false;
}

const technique_use *rule_shades_again(const rule *r)
{
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    for (size_t i = 0; compose && i < compose->technique->pass_count; i++)
        if (compose->technique->passes[i].geometry && compose->technique->passes[i].writes == TARGET_PAGE)
            return compose;
    return NULL;
}

/* Leaves a perturbation out that moves nothing, so that such a picture is exactly the one without it; and where a
 * composition cannot look anything up elsewhere. */
static void settle_perturbation(rule *r, warnings *warnings)
{
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    technique_use       *perturb = r->use_counts[KIND_PERTURB] ? &r->uses[KIND_PERTURB][0] : NULL;
    if (!perturb)
        return;
    bool active = perturb->technique->perturbs->active(perturb->values),
         able = !compose || compose->technique->compose->perturbable;
    if (active && able)
        return;
    if (!able)
        warnings_add(warnings, WARNING_UNUSED, "compose '%s' cannot be perturbed; 'opaque' and those of layers can",
                     compose->technique->name);
    use_release(perturb);
    r->use_counts[KIND_PERTURB] = 0;
}

/* Colours that are the page's ground unless they are set. */
static void settle_grounds(rule *r, colour ground)
{
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; i < r->use_counts[k]; i++) {
            const technique *t = r->uses[k][i].technique;
            for (size_t n = 0; n < t->param_count; n++)
                if (t->params[n].auto_ground && param_is_auto(&t->params[n], r->uses[k][i].values))
                    memcpy((char *)r->uses[k][i].values + t->params[n].offset, &ground, sizeof ground);
        }
}

static void drop_lines(rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        use_release(&r->uses[KIND_LINES][i]);
    r->use_counts[KIND_LINES] = 0;
}

/* Lines that run on do so in space, and those with halos by the planes of surfaces. */
static bool lines_are_spatial(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const lines_common *lines = r->uses[KIND_LINES][i].values;
        if (lines->overshoot > 0 || lines->halo > 0)
            return true;
    }
    return false;
}

static unsigned channels_of(const rule *r, bool several_parts)
{
    unsigned channels = lines_are_spatial(r) ? CHANNEL_NORMAL_DEPTH : 0;
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; i < r->use_counts[k]; i++)
            channels |=
                r->uses[k][i].technique->channels | (several_parts ? r->uses[k][i].technique->part_channels : 0);
    return channels;
}

/* Operands of a solid have borders as parts have. */
bool figure_has_solids(const plan *p, const figure *f)
{
    for (size_t i = 0; i < p->part_count; i++)
        if (f->designated[i] && p->scene->nodes[p->scene->parts[i].node].solid != NONE)
            return true;
    return false;
}

/* What is deformed carries along where it is when nothing has moved, for what is tied to the model and drawn from
 * the G-buffer. */
static bool wants_rest(const plan *p, const figure *f)
{
    if (!p->pose->at_rest || !p->meshes.rest || !(rule_use(f->rule, KIND_PERTURB) || f->deferred))
        return false;
    for (size_t i = 0; i < p->scene->part_count; i++) {
        const part_pose *pose = &p->pose->parts[i];
        if (f->designated[i] && pose_part_deforms(pose))
            return true;
    }
    return false;
}

/* Contrast-aware lines look at the picture they are drawn on. */
static bool lines_read_shade(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (((const lines_common *)r->uses[KIND_LINES][i].values)->contrast > 0)
            return true;
    return false;
}

static bool has_active_pass(const technique_use *use)
{
    const technique *t = use->technique;
    for (size_t i = 0; i < t->pass_count; i++)
        if (params_condition(t->passes[i].when, t->params, t->param_count, use->values))
            return true;
    return false;
}

static bool is_seen_through(const rule *r)
{
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    return compose && compose->technique->compose->layered;
}

static void find_opaque_parts(plan *p)
{
    memset(p->opaque, 0, p->part_count * sizeof *p->opaque);
    p->opaque_count = 0;
    for (size_t i = 0; i < p->figure_count; i++) {
        bool hides = !is_seen_through(p->figures[i].rule) && !p->figures[i].mover; /* movers may fade */
        for (size_t part = 0; part < p->part_count && hides; part++)
            if (p->figures[i].designated[part]) {
                p->opaque[part] = true;
                p->opaque_count++;
            }
    }
}

static bool has_ghosts_alone(const plan *p, const figure *f)
{
    for (size_t i = 0; i < p->part_count; i++)
        if (f->designated[i] && !p->scene->parts[i].ghost)
            return false;
    return true;
}

static void settle_layers(figure *f, const plan *p, bool as_sprites)
{
    const rule *r = f->rule;
    f->ghostly = has_ghosts_alone(p, f);
    f->layer_count = f->layering.count ? f->layering.count : LAYERS_MAX;
    f->channels =
        channels_of(r, f->part_count > 1 || p->has_cut || figure_has_solids(p, f)) | (p->has_cut ? CHANNEL_ID : 0);
    if (as_sprites || lines_read_shade(r))
        f->channels |= CHANNEL_SHADE;
    if (as_sprites)
        f->channels |= CHANNEL_NORMAL_DEPTH | CHANNEL_ID;
    if (wants_rest(p, f))
        f->channels |= CHANNEL_REST;
    if (as_sprites && p->pose->past_count)
        f->channels |= CHANNEL_VELOCITY;
}

/* Does the geometry pass tell more than colour and normal? */
static bool tells_detail(const technique_use *surface)
{
    const surface_row *row = surface->technique->surface;
    return row->detail && row->needs && row->needs(surface->values).walls;
}

bool shades_with_geometry(const technique_use *surface)
{
    const technique *t = surface->technique;
    return t->surface->forward || (t->surface->forward_when && params_condition(t->surface->forward_when, t->params,
                                                                                t->param_count, surface->values));
}

/* Lines with geometry find those of other rules themselves. Row nienhaus E18. */
static bool finds_meetings(const figure *f)
{
    const technique_use *lines = rule_use(f->rule, KIND_LINES);
    return f->layering.complement && lines && !technique_draws_strokes(lines->technique) && !f->mover &&
           (f->layered || rule_use(f->rule, KIND_PERTURB));
}

static void settle_figure(figure *f, const plan *p, bool as_sprites)
{
    const rule          *r = f->rule;
    const technique_use *surface = rule_use(r, KIND_SURFACE);
    f->layering = layering_of(rule_use(r, KIND_LAYERS));
    f->layered = is_seen_through(r);
    f->meets = finds_meetings(f);
    if (f->layered) {
        settle_layers(f, p, as_sprites);
        return;
    }
    bool             perturbed = rule_use(r, KIND_PERTURB) != NULL;
    const technique *shader = surface ? surface->technique : NULL;
    bool             later = shader && shader->surface->deferred_when &&
                 params_condition(shader->surface->deferred_when, shader->params, shader->param_count, surface->values);
    f->deferred = surface && (f->layering.deferred || later) && !shades_with_geometry(surface);
    /* A perturbed figure looks beside the pixel for what it shows there: it must not find others in front of it. */
    f->complement = f->layering.complement && r->use_counts[KIND_LINES] > 0 && f->part_count < p->opaque_count &&
                    !perturbed && !f->mover;
    f->reflects = surface && surface->technique->surface->reflects;
    bool plain_surface = !surface || (surface->technique->surface->direct && !has_active_pass(surface));
    f->direct =
        !as_sprites && r->pale <= 0 && !r->use_counts[KIND_LINES] && plain_surface && !f->deferred && !perturbed;
    f->channels =
        channels_of(r, f->complement || f->part_count > 1 || p->has_cut || figure_has_solids(p, f)) | CHANNEL_SHADE;
    if (f->complement || as_sprites)
        f->channels |= CHANNEL_ID;
    if (f->deferred)
        f->channels |=
            CHANNEL_NORMAL_DEPTH | CHANNEL_ID | CHANNEL_ALBEDO | (tells_detail(surface) ? CHANNEL_DETAIL : 0);
    if (as_sprites)
        f->channels |= CHANNEL_NORMAL_DEPTH;
    if (wants_rest(p, f))
        f->channels |= CHANNEL_REST;
    if (as_sprites && p->pose->past_count)
        f->channels |= CHANNEL_VELOCITY;
}

static int figure_rank(const figure *f)
{
    return f->mover ? 4 : f->direct ? 0 : f->layered ? 3 : f->reflects ? 2 : 1;
}

/* A stable insertion sort: opaque plain figures first, then mirrors, and last what is seen through. */
static void order_figures(plan *p)
{
    for (size_t i = 1; i < p->figure_count; i++) {
        figure moving = p->figures[i];
        size_t k = i;
        for (; k > 0 && figure_rank(&p->figures[k - 1]) > figure_rank(&moving); k--)
            p->figures[k] = p->figures[k - 1];
        p->figures[k] = moving;
    }
}

/* A ghost belongs to the part that it was taken away from, and can be selected by itself. */
static bool is_selected(const plan *p, const selector *wanted, size_t part_index)
{
    if (scene_is_hidden(p->scene, p->scene->parts[part_index].node))
        return false;
    if (!wanted || selector_matches(wanted, p->scene, part_index))
        return true;
    size_t owner = scene_part_of_ghost(p->scene, part_index);
    return owner != SIZE_MAX && p->selected[owner];
}

static lmn_status select_parts(plan *p, const char *select, lmn_error *error)
{
    selector  *wanted = NULL;
    lmn_status status = select ? selector_parse(&wanted, select, error) : LMN_OK;
    for (size_t i = 0; status == LMN_OK && i < p->part_count; i++) {
        p->selected[i] = is_selected(p, wanted, i);
        p->selected_count += p->selected[i];
    }
    selector_destroy(&wanted);
    if (status == LMN_OK && p->selected_count == 0) {
        if (!select && p->scene->part_count > 0)
            return error_set(error, LMN_USAGE, "all %zu parts are hidden", p->scene->part_count);
        if (!select) {
            error_in_file(error, LMN_FORMAT, refuse_file(p->scene), 0, "the scene has no parts to draw");
            /* What was left out while loading is why. */
            if (p->scene->warnings.count > 0)
                error_hint(error, "%s", p->scene->warnings.items[0].text);
            return LMN_FORMAT;
        }
        status = error_in_file(error, LMN_USAGE, refuse_file(p->scene), 0,
                               "the selection '%s' matches none of %zu parts", select, p->scene->part_count);
        error_hint(error, "`limner info` lists the parts with their names and paths");
    }
    return status;
}

/* What the picture is fitted to of a part. Cutters may stick out far: of a ghost, what lies within a quarter of its
 * solid's diagonal. */
static box3 fitted_box(const plan *p, const box3 *boxes, size_t part_index)
{
    box3   box = boxes[part_index];
    size_t owner = scene_part_of_ghost(p->scene, part_index);
    if (owner == SIZE_MAX || box3_is_empty(boxes[owner]))
        return box;
    box3  near = boxes[owner];
    float x = near.max.x - near.min.x, y = near.max.y - near.min.y, z = near.max.z - near.min.z;
    float margin = sqrtf(x * x + y * y + z * z) / 4;
    box.min = (vec3){fmaxf(box.min.x, near.min.x - margin), fmaxf(box.min.y, near.min.y - margin),
                     fmaxf(box.min.z, near.min.z - margin)};
    box.max = (vec3){fminf(box.max.x, near.max.x + margin), fminf(box.max.y, near.max.y + margin),
                     fminf(box.max.z, near.max.z + margin)};
    return box3_is_empty(box) ? box3_empty() : box;
}

static void fit_to(plan *p, size_t part_index, bool ghost)
{
    const box3 *now = p->pose->part_boxes, *ever = p->pose->fit_boxes;
    p->box = box3_union(p->box, ghost ? fitted_box(p, now, part_index) : now[part_index]);
    box3 box = ghost ? fitted_box(p, ever, part_index) : scene_fitted_box(p->scene, part_index, ever[part_index]);
    p->fitted[part_index] = true;
    p->ghost_boxes[part_index] = box;
    p->fit.box = box3_union(p->fit.box, box);
}

/* Gives every selected part to the last rule that selects it. A part that no rule selects is not drawn, so it hides
 * nothing and has no lines; the picture is fitted to it all the same, so that looks of one scene can be compared,
 * but not to a ghost. */
static void share_parts(plan *p)
{
    const lmn_look *look = p->look;
    for (size_t i = 0; i < p->part_count; i++) {
        p->rule_of[i] = NONE;
        if (!p->selected[i])
            continue;
        bool ghost = p->scene->parts[i].ghost;
        if (!ghost && node_is_overlay(&p->scene->nodes[p->scene->parts[i].node]))
            p->box = box3_union(p->box, p->pose->part_boxes[i]);
        else if (!ghost)
            fit_to(p, i, false);
        for (size_t r = look->rule_count; r-- > 0 && p->rule_of[i] == NONE;) {
            const selector *s = look->rules[r].selector;
            if (look->rules[r].pale <= 0 && (s ? selector_matches(s, p->scene, i) : !ghost))
                p->rule_of[i] =
                    (int32_t)pale_find_rule(look, r, node_paleness(&p->scene->nodes[p->scene->parts[i].node]));
        }
        bool taken = p->rule_of[i] != NONE;
        if (ghost && taken)
            fit_to(p, i, true);
        p->selected[i] = taken;
        p->throws[i] = taken && node_throws_shadow(&p->scene->nodes[p->scene->parts[i].node]);
        p->selected_count -= !taken;
    }
}

/* Rules for what only some scenes have: looks that ship have them for these. */
static bool is_for_some_scenes(const char *select)
{
    return !select || strcmp(select, "*") == 0 || strcmp(select, "@solid") == 0 || strncmp(select, "[glyph", 6) == 0;
}

/* Rules for what solids take away have no parts where that is left to others. */
static void warn_of_idle_rules(const plan *p, bool without_removed, warnings *warnings)
{
    const lmn_look *look = p->look;
    for (size_t r = 0; r < look->rule_count; r++) {
        const rule *own = &look->rules[r];
        bool        idle = own->pale <= 0 && !is_for_some_scenes(own->select);
        if (without_removed && own->selector && selector_names_removed(own->selector))
            idle = false;
        for (size_t i = 0; idle && i < p->part_count; i++)
            idle = p->rule_of[i] != (int32_t)r;
        if (idle)
            warnings_add(warnings, WARNING_NO_MATCH, "rule %zu of look '%s' selects no part: '%s'", r, look->name,
                         own->select);
    }
}

/* One figure a rule that has parts. */
static lmn_status make_figures(plan *p, const plan_options *options, warnings *warnings, lmn_error *error)
{
    for (size_t r = 0; r < p->look->rule_count; r++) {
        p->rule_count++;
        if (!paper_rule_create(&p->rules[r], &p->look->rules[r]))
            return error_memory(error);
        if (options->surfaces_only)
            drop_lines(&p->rules[r]);
        settle_perturbation(&p->rules[r], warnings);
        settle_grounds(&p->rules[r], p->ground);
        figure f = {.rule = &p->rules[r], .box = box3_empty(), .unmarked = options->surfaces_only};
        f.designated = mem_calloc(p->part_count, sizeof *f.designated);
        if (!f.designated)
            return error_memory(error);
        for (size_t i = 0; i < p->part_count; i++)
            if (p->rule_of[i] == (int32_t)r) {
                f.designated[i] = true;
                f.part_count++;
                f.box = box3_union(f.box, p->pose->part_boxes[i]);
            }
        if (f.part_count)
            p->figures[p->figure_count++] = f;
        else
            mem_free(f.designated);
    }
    return LMN_OK;
}

/* Each mirror has a plane of its own, so each part of a mirror rule becomes a figure. */
static lmn_status split_mirrors(plan *p, lmn_error *error)
{
    size_t  before = p->figure_count, capacity = before + p->part_count;
    figure *grown = mem_realloc(p->figures, capacity * sizeof *grown);
    if (!grown)
        return error_memory(error);
    p->figures = grown;
    for (size_t i = 0; i < before; i++) {
        const technique_use *surface = rule_use(p->figures[i].rule, KIND_SURFACE);
        if (!surface || !surface->technique->surface->reflects || is_seen_through(p->figures[i].rule))
            continue;
        for (size_t part = 0; part < p->part_count && p->figures[i].part_count > 1; part++) {
            if (!p->figures[i].designated[part])
                continue;
            figure single = {.rule = p->figures[i].rule, .part_count = 1, .box = p->pose->part_boxes[part]};
            single.designated = mem_calloc(p->part_count, sizeof *single.designated);
            if (!single.designated)
                return error_memory(error);
            single.designated[part] = true;
            p->figures[p->figure_count++] = single;
            p->figures[i].designated[part] = false;
            p->figures[i].part_count--;
        }
        p->figures[i].box = box3_empty();
        for (size_t part = 0; part < p->part_count; part++)
            if (p->figures[i].designated[part])
                p->figures[i].box = p->pose->part_boxes[part];
    }
    return LMN_OK;
}

/* A variant of a rule, owned by the plan; NULL when memory is gone. */
static rule *add_rule(plan *p, const rule *from)
{
    rule *r = &p->rules[p->rule_count++]; /* there is room for two variants of each */
    return paper_rule_create(r, from) ? r : NULL;
}

/* The same lines as hidden layers have them. */
static bool add_hidden_rule(plan *p, figure *f)
{
    const layer_style *style = rule_use(f->rule, KIND_COMPOSE)->values;
    rule              *r = add_rule(p, f->rule);
    for (size_t i = 0; r && i < r->use_counts[KIND_LINES]; i++) {
        lines_common *lines = r->uses[KIND_LINES][i].values;
        if (!isnan(style->hidden_colour.r))
            lines->colour = lines->inner_colour = lines->id_colour = style->hidden_colour;
        if (!isnan(style->hidden_width))
            lines->width = style->hidden_width;
        if (style->hidden_dash > 0) {
            lines->dash = style->hidden_dash;
            lines->gap = style->hidden_gap;
        }
    }
    f->hidden = r;
    return r != NULL;
}

/* The figure's parts that are its own focus become an opaque figure in front of which the layers lie. */
static lmn_status split_focus(plan *p, size_t index, colour highlight, lmn_error *error)
{
    figure *f = &p->figures[index];
    figure  opaque = {.box = box3_empty(), .highlight = highlight};
    opaque.designated = mem_calloc(p->part_count, sizeof *opaque.designated);
    rule *r = opaque.designated ? add_rule(p, f->rule) : NULL;
    if (!r) {
        mem_free(opaque.designated);
        return error_memory(error);
    }
    opaque.rule = r;
    /* What shows one surface, opaque. */
    static const kind_id replaced[] = {KIND_LAYERS, KIND_COMPOSE};
    for (size_t i = 0; i < 2; i++) {
        technique_use *use = &r->uses[replaced[i]][0], fresh;
        if (!use_create(&fresh, kinds[replaced[i]], kinds[replaced[i]]->standard)) {
            mem_free(opaque.designated);
            return error_memory(error);
        }
        use_release(use);
        *use = fresh;
    }
    box3 left = box3_empty();
    for (size_t i = 0; i < p->part_count; i++) {
        if (f->designated[i] && f->focus[i]) {
            f->designated[i] = false;
            opaque.designated[i] = true;
            opaque.part_count++;
            opaque.box = box3_union(opaque.box, p->pose->part_boxes[i]);
        } else if (f->designated[i]) {
            left = box3_union(left, p->pose->part_boxes[i]);
        }
    }
    f->part_count -= opaque.part_count;
    f->box = left;
    figure *grown = mem_realloc(p->figures, (p->figure_count + 1) * sizeof *grown);
    if (!grown) {
        mem_free(opaque.designated);
        return error_memory(error);
    }
    p->figures = grown;
    p->figures[p->figure_count++] = opaque;
    return LMN_OK;
}

static lmn_status find_focus(plan *p, size_t index, warnings *warnings, lmn_error *error)
{
    figure  *f = &p->figures[index];
    layering how = layering_of(rule_use(f->rule, KIND_LAYERS));
    if (!how.focus[0])
        return LMN_OK;
    selector  *wanted = NULL;
    lmn_status status = selector_parse(&wanted, how.focus, error);
    if (status != LMN_OK)
        return status;
    f->focus = mem_calloc(p->part_count, sizeof *f->focus);
    size_t found = 0, own = 0;
    for (size_t i = 0; f->focus && i < p->part_count; i++) {
        f->focus[i] = p->selected[i] && selector_matches(wanted, p->scene, i);
        found += f->focus[i];
        own += f->focus[i] && f->designated[i];
    }
    selector_destroy(&wanted);
    if (!f->focus)
        return error_memory(error);
    if (found == 0) {
        warnings_add(warnings, WARNING_NO_MATCH, "layers.focus '%s' selects no part that is drawn", how.focus);
        mem_free(f->focus);
        f->focus = NULL;
    }
    return own ? split_focus(p, index, how.focus_colour, error) : LMN_OK;
}

/* Layered figures: what is to be uncovered, and the lines of hidden layers. */
static lmn_status prepare_layers(plan *p, warnings *warnings, lmn_error *error)
{
    for (size_t i = 0, count = p->figure_count; i < count; i++) {
        if (!is_seen_through(p->figures[i].rule))
            continue;
        lmn_status status = find_focus(p, i, warnings, error);
        if (status != LMN_OK)
            return status;
        if (!add_hidden_rule(p, &p->figures[i]))
            return error_memory(error);
    }
    return LMN_OK;
}

/* What the look's techniques want meshes to have. */
static mesh_needs needs_of(const lmn_look *look, const pose *pose)
{
    mesh_needs all = {.field = false};
    for (size_t i = 0; i < look->rule_count; i++) {
        const technique_use *surface = rule_use(&look->rules[i], KIND_SURFACE),
                            *motion = rule_use(&look->rules[i], KIND_MOTION);
        all.glue = all.glue || (motion && motion->technique->motion->stretched && pose->past_count);
        all.rest = all.rest || rule_use(&look->rules[i], KIND_PERTURB);
        if (!surface || !surface->technique->surface->needs)
            continue;
        mesh_needs own = surface->technique->surface->needs(surface->values);
        all.field = all.field || own.field;
        all.patch = own.patch > 0 ? own.patch : all.patch;
        all.rest = all.rest || own.rest;
        all.walls = all.walls || own.walls;
    }
    return all;
}

static bool asks_for_removed(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++)
        if (look->rules[i].selector && selector_names_removed(look->rules[i].selector))
            return true;
    return false;
}

static lmn_status find_ground(colour *out, const lmn_look *look, const char *background, lmn_error *error)
{
    *out = ((const sheet_values *)look->wide[KIND_FINISH].values)->ground;
    if (!background || colour_parse(background, out))
        return LMN_OK;
    lmn_status status = error_set(error, LMN_USAGE, "'%s' is not a colour", background);
    error_hint(error, "give #rgb, #rrggbb, #rrggbbaa, a basic colour name, or none");
    return status;
}

static lmn_status open_plan(plan *out, const pose *pose, const lmn_look *look, const plan_options *options,
                            lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->pose = pose;
    out->scene = pose->scene;
    out->pixels_per_mm = options->pixels_per_mm;
    out->look = look = out->own_look = paper_look_create(look, options->pixels_per_mm * MM_PER_POINT);
    if (!look || !pale_add_rules(out->own_look, pose->scene))
        return error_memory(error);
    if (options->surfaces_only) /* hatching is lines */
        ((scene_values *)out->own_look->wide[KIND_SCENE].values)->cut_hatch = 0;
    out->box = out->fit.box = box3_empty();
    out->crease_angle =
        (double)((const scene_values *)look->wide[KIND_SCENE].values)->crease_angle * (3.14159265358979323846 / 180);
    out->meshes = needs_of(look, pose);
    out->has_removed = pose->ghost_count > 0 && asks_for_removed(look) && !options->parts_only;
    out->part_count = pose->part_count + (out->has_removed ? pose->ghost_count : 0);
    out->rule_of = mem_calloc(out->part_count, sizeof *out->rule_of);
    out->selected = mem_calloc(out->part_count, sizeof *out->selected);
    out->fitted = mem_calloc(out->part_count, sizeof *out->fitted);
    out->throws = mem_calloc(out->part_count, sizeof *out->throws);
    out->ghost_boxes = mem_calloc(out->part_count, sizeof *out->ghost_boxes);
    out->opaque = mem_calloc(out->part_count, sizeof *out->opaque);
    out->figures = mem_calloc(look->rule_count, sizeof *out->figures);
    out->rules = mem_calloc(3 * look->rule_count, sizeof *out->rules);
    if (!out->rule_of || !out->selected || !out->opaque || !out->figures || !out->rules || !out->fitted ||
        !out->throws || !out->ghost_boxes)
        return error_memory(error);
    out->fit = (fit_body){.pose = pose,
                          .look = look,
                          .fitted = out->fitted,
                          .ghost_boxes = out->ghost_boxes,
                          .part_count = out->part_count,
                          .box = box3_empty()};
    lmn_status status = find_ground(&out->ground, look, options->background, error);
    if (status == LMN_OK && !options->parts_only)
        status = options->cut ? section_find_cut(&out->section, options->cut, pose, look, options->select, error)
                              : section_find(&out->section, pose, look, options->select, error);
    out->has_cut = out->section.cut.cell_count > 0;
    return status;
}

void plan_settle(plan *p, bool as_sprites)
{
    find_opaque_parts(p);
    for (size_t i = 0; i < p->figure_count; i++)
        settle_figure(&p->figures[i], p, as_sprites);
    order_figures(p);
}

static lmn_status plan_figures(plan *p, const plan_options *options, warnings *warnings, lmn_error *error)
{
    lmn_status status = make_figures(p, options, warnings, error);
    if (status == LMN_OK)
        status = split_mirrors(p, error);
    if (status == LMN_OK)
        status = prepare_layers(p, warnings, error);
    if (status != LMN_OK)
        return status;
    plan_settle(p, options->as_sprites);
    return LMN_OK;
}

lmn_status plan_create(plan *out, const pose *pose, const lmn_look *look, const plan_options *options,
                       warnings *warnings, lmn_error *error)
{
    lmn_status status = open_plan(out, pose, look, options, error);
    if (status == LMN_OK)
        status = select_parts(out, options->select, error);
    if (status != LMN_OK)
        return status;
    share_parts(out);
    warn_of_idle_rules(out, options->parts_only && pose->ghost_count > 0, warnings);
    status = datum_make(&out->datum, out->pose, out->look->wide[KIND_SCENE].values, out->selected, out->part_count,
                        warnings, error);
    ground_settle(out);
    return status == LMN_OK && !options->parts_only ? plan_figures(out, options, warnings, error) : status;
}

const rule *plan_rule(const plan *p, size_t part_index)
{
    int32_t index = p->rule_of[part_index];
    return index != NONE ? &p->look->rules[index] : NULL;
}

const colour *plan_datum_colour(const plan *p, size_t part_index)
{
    const colour *c = p->datum.colours && part_index < p->part_count ? &p->datum.colours[part_index] : NULL;
    return c && c->a > 0 ? c : NULL;
}

void plan_camera_range(const plan *p, view_camera *camera, warnings *warnings)
{
    double nearest = INFINITY, farthest = -INFINITY;
    for (size_t i = 0; i < p->part_count; i++)
        if (p->selected[i] && !box3_is_empty(p->pose->part_boxes[i]))
            camera_depth_range(camera, p->pose->part_boxes[i], &nearest, &farthest);
    if (!camera->orthographic && p->selected_count && farthest <= 0)
        warnings_add(warnings, WARNING_UNUSED, "the model is behind the viewer: the page stays empty");
    if (!(farthest >= nearest))
        nearest = farthest = 1;
    camera_set_range(camera, nearest, farthest);
}

void plan_release(plan *p)
{
    for (size_t i = 0; i < p->figure_count; i++) {
        mem_free(p->figures[i].designated);
        mem_free(p->figures[i].focus);
    }
    for (size_t i = 0; i < p->rule_count; i++)
        paper_rule_release(&p->rules[i]);
    mem_free(p->rules);
    mem_free(p->figures);
    mem_free(p->rule_of);
    section_release(&p->section);
    datum_release(&p->datum);
    mem_free(p->selected);
    mem_free(p->fitted);
    mem_free(p->throws);
    mem_free(p->ghost_boxes);
    mem_free(p->opaque);
    paper_look_destroy(&p->own_look);
    memset(p, 0, sizeof *p);
}
