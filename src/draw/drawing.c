#include "draw/drawing.h"

#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/clock.h"
#include "base/memory.h"
#include "draw/refuse.h"
#include "draw/room.h"
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
    made_textures_release(&r->made, r->g);
    gpu_destroy(&r->g);
    mem_free(r);
    *renderer = NULL;
}

/* The parts that a selector matches; NULL text or an empty one: `otherwise`. Ghosts go with their parts. */
static lmn_status match_parts(bool **out, const lmn_scene *scene, const char *text, bool otherwise, lmn_error *error)
{
    selector *wanted = NULL;
    lmn_status status = text && text[0] ? selector_parse(&wanted, text, error) : LMN_OK;
    *out = status == LMN_OK ? mem_calloc(scene->part_count + scene->ghost_count, sizeof **out) : NULL;
    if (status == LMN_OK && !*out)
        status = error_memory(error);
    for (size_t i = 0; i < scene->part_count && *out; i++)
        (*out)[i] = wanted ? selector_matches(wanted, scene, i) : otherwise;
    for (size_t i = scene->part_count; i < scene->part_count + scene->ghost_count && *out; i++) {
        size_t owner = scene_part_of_ghost(scene, i);
        (*out)[i] = (wanted && selector_matches(wanted, scene, i)) || (owner != SIZE_MAX && (*out)[owner]);
    }
    selector_destroy(&wanted);
    return status;
}

/* What the look cuts away; percentages count along the bounds of what is selected. */
static lmn_status find_section(upload_section *out, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, lmn_error *error)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    *out = (upload_section){.spared = NULL};
    memset(&out->cut, 0, sizeof out->cut);
    if (!v->cut.text[0])
        return LMN_OK;
    bool *selected;
    box3 box = box3_empty();
    lmn_status status = match_parts(&selected, scene, desc->select, true, error);
    for (size_t i = 0; i < scene->part_count && status == LMN_OK; i++)
        if (selected[i])
            box = box3_union(box, scene->parts[i].bounds);
    mem_free(selected);
    if (status == LMN_OK)
        status = cut_parse(&out->cut, v->cut.text, box, error);
    if (status == LMN_OK)
        status = match_parts(&out->spared, scene, v->cut_keep.text, false, error);
    return status;
}

static bool same_section(const upload_section *a, const upload_section *b, size_t part_count)
{
    return memcmp(&a->cut, &b->cut, sizeof a->cut) == 0 && !a->spared == !b->spared &&
           (!a->spared || memcmp(a->spared, b->spared, part_count * sizeof *a->spared) == 0);
}

static bool asks_for_removed(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++)
        if (look->rules[i].selector && selector_names_removed(look->rules[i].selector))
            return true;
    return false;
}

/* What the look's surfaces want meshes to have. */
static mesh_wishes wishes_of(const lmn_look *look)
{
    mesh_wishes all = {false, 0};
    for (size_t i = 0; i < look->rule_count; i++) {
        const technique_use *surface = rule_use(&look->rules[i], KIND_SURFACE);
        if (!surface || !surface->technique->wishes)
            continue;
        mesh_wishes own = surface->technique->wishes(surface->values);
        all.field = all.field || own.field;
        all.patch = own.patch > 0 ? own.patch : all.patch;
    }
    return all;
}

/* Puts the scene on the GPU unless it is there already. */
static lmn_status bring_scene(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, lmn_error *error)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    double crease = (double)v->crease_angle * (3.14159265358979323846 / 180);
    upload_desc wanted = {.crease_angle = crease, .removed = scene->ghost_count > 0 && asks_for_removed(look), .wishes = wishes_of(look)};
    lmn_status status = find_section(&wanted.section, scene, look, desc, error);
    bool same_meshes = r->up.crease_angle == crease && (r->up.wishes.field || !wanted.wishes.field) &&
                       (r->up.wishes.patch == wanted.wishes.patch || wanted.wishes.patch == 0);
    bool there = r->up_valid && r->up.has_removed == wanted.removed && r->scene == scene && r->up.revision == scene->revision && same_meshes;
    if (status != LMN_OK || (there && same_section(&r->up.section, &wanted.section, scene->part_count + scene->ghost_count))) {
        mem_free(wanted.section.spared);
        return status;
    }
    upload earlier = r->up;
    bool related = r->up_valid && earlier.identity == scene->identity && same_meshes;
    if (related)
        wanted.wishes = earlier.wishes; /* what is taken over has them */
    else
        upload_release(&earlier, r->g); /* at once: two scenes may not fit */
    status = upload_create(&r->up, r->g, scene, &wanted, related ? &earlier : NULL, desc->progress, desc->progress_user, error);
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

static lmn_status place_camera(session *s, const lmn_scene *scene, const lmn_draw_desc *desc, warnings *notes, lmn_error *error)
{
    view_camera *c = &s->frame.camera;
    lmn_status status = camera_place(c, desc, scene, s->renderer->up.worlds, s->plan.box, error);
    if (status != LMN_OK)
        return status;
    double nearest = INFINITY, farthest = -INFINITY;
    for (size_t i = 0; i < s->plan.part_count; i++)
        if (s->plan.selected[i] && !box3_is_empty(s->renderer->up.part_boxes[i]))
            camera_depth_range(c, s->renderer->up.part_boxes[i], &nearest, &farthest);
    if (!c->orthographic && s->plan.selected_count && farthest <= 0)
        warnings_add(notes, WARNING_UNUSED, "the model is behind the viewer: the page stays empty");
    if (!(farthest >= nearest))
        nearest = farthest = 1;
    camera_set_range(c, nearest, farthest);
    return LMN_OK;
}

static lmn_status find_ground(colour *out, const lmn_look *look, const lmn_draw_desc *desc, lmn_error *error)
{
    *out = ((const sheet_values *)look->wide[KIND_FINISH].values)->ground;
    if (!desc->background || colour_parse(desc->background, out))
        return LMN_OK;
    lmn_status status = error_set(error, LMN_USAGE, "'%s' is not a colour", desc->background);
    error_hint(error, "give #rgb, #rrggbb, #rrggbbaa, a basic colour name, or none");
    return status;
}

/* Where materials have strokes of their own, each gets its textures. */
static lmn_status bring_by_material(lmn_renderer *r, figure *fig, const technique_use *surface, const lmn_scene *scene, lmn_error *error)
{
    void *values = mem_copy(surface->values, surface->technique->params_size);
    fig->material_textures = mem_calloc(scene->material_count, sizeof *fig->material_textures);
    lmn_status status = values && fig->material_textures ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < scene->material_count && status == LMN_OK; i++) {
        int32_t index = scene->materials[i].base_texture.image;
        memcpy(values, surface->values, surface->technique->params_size);
        surface->technique->by_material(values, index >= 0 ? scene->images[index].strokes : NULL);
        status = made_textures_find(&r->made, r->g, &(technique_use){surface->technique, values}, &fig->material_textures[i], error);
    }
    mem_free(values);
    return status;
}

/* What was asked for and gives no ink. */
static void note_textures(const figure *fig, const technique_use *surface, const plan *p, warnings *notes)
{
    bool none = fig->material_textures != NULL;
    for (size_t i = 0; i < p->scene->image_count; i++)
        none = none && !p->scene->images[i].strokes;
    if (none)
        warnings_add(notes, WARNING_UNUSED, "no material has strokes beside its picture (.stx): all are drawn with the standard ones");
    for (size_t i = 0; surface && i < surface->technique->texture_count; i++)
        if (fig->textures.textures[i] && fig->textures.blank[i])
            warnings_add(notes, WARNING_UNUSED, "the %s of surface '%s' has no ink anywhere", surface->technique->textures[i].name, surface->technique->name);
}

/* What techniques, and unless maps are drawn the sheet, make on the CPU. */
static lmn_status bring_textures(lmn_renderer *r, plan *p, bool maps, warnings *notes, lmn_error *error)
{
    made_textures_trim(&r->made, r->g);
    lmn_status status = made_textures_find(&r->made, r->g, maps ? NULL : &p->look->wide[KIND_FINISH], &p->sheet_textures, error);
    for (size_t i = 0; i < p->figure_count && status == LMN_OK; i++) {
        figure *fig = &p->figures[i];
        const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
        technique_use plain = {surface ? surface->technique : NULL, NULL};
        bool differ = surface && surface->technique->by_material && (plain.values = mem_copy(surface->values, surface->technique->params_size)) &&
                      surface->technique->by_material(plain.values, NULL);
        status = made_textures_find(&r->made, r->g, differ ? &plain : surface, &fig->textures, error);
        if (status == LMN_OK && differ)
            status = bring_by_material(r, fig, surface, p->scene, error);
        if (status == LMN_OK)
            note_textures(fig, surface, p, notes);
        if (status == LMN_OK)
            status = made_textures_find(&r->made, r->g, rule_use(fig->rule, KIND_PERTURB), &fig->perturb_textures, error);
        mem_free(plain.values);
    }
    return status;
}

/* Shadows that were asked for and cannot be. */
static void note_lights(const lmn_scene *scene, const lmn_look *look, warnings *notes)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    if (!v->shadows || v->lights != LIGHTS_FILE)
        return;
    for (size_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].light < 0)
            continue;
        if (scene->lights[scene->nodes[i].light].type != LIGHT_DIRECTIONAL)
            warnings_add(notes, WARNING_UNUSED, "scene.shadows: the file's first light shines from a place; only light from one direction throws shadows");
        return;
    }
}

lmn_status session_open(session *s, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                        bool maps, warnings *notes, lmn_error *error)
{
    memset(s, 0, sizeof *s);
    s->renderer = r;
    gpu_make_current(r->g);
    int side = maps ? 1 : square_root(desc->samples);
    lmn_status status = room_check_sides(r->g, desc->width, desc->height, side, error);
    if (status == LMN_OK)
        status = bring_scene(r, scene, look, desc, error);
    plan_wishes wishes = {.select = desc->select, .pixel_scale = side, .as_sprites = maps};
    if (status == LMN_OK)
        status = find_ground(&wishes.ground, look, desc, error);
    if (status == LMN_OK)
        status = plan_create(&s->plan, scene, look, &r->up, &wishes, notes, error);
    if (r->width != desc->width || r->height != desc->height || r->samples != desc->samples)
        gpu_targets_trim(r->g);
    if (status == LMN_OK)
        status = room_check(r->g, &s->plan, &(room_wishes){desc->width, desc->height, side, !maps && (desc->maps || desc->profile)}, error);
    if (status == LMN_OK)
        note_lights(scene, look, notes);
    if (status == LMN_OK)
        status = bring_textures(r, &s->plan, maps, notes, error);
    if (status == LMN_OK)
        status = place_camera(s, scene, desc, notes, error);
    if (status != LMN_OK)
        return status;
    r->width = desc->width;
    r->height = desc->height;
    r->samples = desc->samples;
    frame *f = &s->frame;
    f->g = r->g;
    f->up = &r->up;
    f->plan = &s->plan;
    f->samples = side;
    f->width = desc->width * side;
    f->height = desc->height * side;
    f->ground = wishes.ground;
    f->seed = desc->seed;
    f->time_s = desc->time_s;
    if (!maps)
        s->out = gpu_target_acquire(r->g, desc->width, desc->height, GPU_RGBA8);
    return gpu_check(r->g, error);
}

void session_close(session *s)
{
    if (s->renderer)
        gpu_target_release(s->renderer->g, s->out);
    plan_release(&s->plan);
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
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique *t = r->uses[KIND_LINES][i].technique;
        for (size_t k = 0; k < t->pass_count; k++)
            if (t->passes[k].strokes)
                return true;
    }
    return false;
}

static bool has_solids(const plan *p, const figure *fig)
{
    for (size_t k = 0; k < p->scene->part_count; k++)
        if (fig->designated[k] && p->scene->nodes[p->scene->parts[k].node].solid != NONE)
            return true;
    return false;
}

/* Strokes know the meshes of parts as they are in the scene. */
static lmn_status refuse_strokes(const refusal *r, const session *s, const upload *up)
{
    bool solids = false, cut = false;
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure *fig = &s->plan.figures[i];
        bool strokes = has_strokes(fig->rule);
        solids = solids || (strokes && has_solids(&s->plan, fig));
        cut = cut || (strokes && up->section.cut.cell_count > 0);
    }
    const char *instead = "operators like 'discontinuity' draw them (--set lines.operator=discontinuity)";
    lmn_status status = LMN_OK;
    if (solids)
        status = refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED, instead, "lines 'strokes' are those of meshes: solids have none");
    if (cut && status == LMN_OK)
        status = refuse(r, LMN_USAGE, WARNING_UNUSED, instead, "lines 'strokes' are those of whole parts: what a section takes away is drawn too");
    return status;
}

/* Marks lie on the triangles of parts as they are in the scene. */
static lmn_status refuse_marks(const refusal *r, const session *s)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure *fig = &s->plan.figures[i];
        const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
        if (!surface || !surface->technique->marks || !has_solids(&s->plan, fig))
            continue;
        lmn_status status = refuse(r, LMN_UNSUPPORTED, WARNING_UNUSED, "'dots' and 'hatch' are worked out on any surface (--set surface.technique=hatch)",
                                   "surface '%s' lies on meshes: solids have none", surface->technique->name);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

static void note_marks(const session *s, warnings *notes)
{
    for (size_t i = 0; i < s->plan.figure_count; i++) {
        const figure *fig = &s->plan.figures[i];
        const technique_use *surface = rule_use(fig->rule, KIND_SURFACE), *compose = rule_shades_again(fig->rule);
        if (!surface || !surface->technique->marks)
            continue;
        if (compose)
            warnings_add(notes, WARNING_UNUSED, "compose '%s' shades again and leaves out the marks of surface '%s'; 'opaque' draws them", compose->technique->name, surface->technique->name);
    }
}

/* What could not be drawn as it was asked for. */
static void keep_notes(lmn_drawing *d, const lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const session *s)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    const upload *up = &r->up;
    bool cut_out = false, spares = false;
    note_marks(s, &d->warnings);
    for (size_t i = 0; i < up->item_count && !cut_out; i++) {
        const draw_item *item = &up->items[i];
        bool blended = item->material >= 0 && scene->materials[item->material].alpha == ALPHA_BLEND;
        cut_out = blended && s->plan.opaque[item->part_index]; /* what is seen through keeps its opacity */
    }
    if (cut_out)
        warnings_add(&d->warnings, WARNING_TRANSPARENCY, "transparent materials are drawn as cut-outs");
    if (up->section.cut.cell_count > 0 && up->triangles == 0)
        warnings_add(&d->warnings, WARNING_UNUSED, "the section leaves nothing of the model: the page stays empty");
    if (up->open_parts)
        warnings_add(&d->warnings, WARNING_CUT_OPEN, "%zu of %zu parts are not closed and have no cut face there", up->open_parts,
                     scene->part_count);
    for (size_t i = 0; up->section.spared && i < up->part_count; i++)
        spares = spares || up->section.spared[i];
    if (up->section.spared && v->cut_keep.text[0] && !spares)
        warnings_add(&d->warnings, WARNING_NO_MATCH, "scene.cut_keep '%s' selects no part", v->cut_keep.text);
}

static lmn_status keep_facts(lmn_drawing *d, const lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                             const session *s, const lmn_draw_desc *desc, lmn_error *error)
{
    const gpu_facts *facts = gpu_facts_of(r->g);
    d->look = mem_copy_text(look->name ? look->name : "");
    d->vendor = mem_copy_text(facts->vendor);
    d->renderer = mem_copy_text(facts->renderer);
    d->version = mem_copy_text(facts->version);
    d->seed = desc->seed;
    d->camera = s->frame.camera;
    d->triangles = r->up.triangles;
    d->bounds = s->plan.box;
    d->load_ms = scene->load_ms;
    size_t part_count = r->up.part_count;
    d->part_names = mem_calloc(part_count, sizeof *d->part_names);
    if (!d->part_names || !d->look || !d->vendor || !d->renderer || !d->version)
        return error_memory(error);
    d->part_count = part_count;
    for (size_t i = 0; i < part_count; i++)
        if (!(d->part_names[i] = mem_copy_text(scene->parts[i].name)))
            return error_memory(error);
    warnings_append(&d->warnings, &scene->warnings);
    keep_notes(d, r, scene, look, s);
    refusal refusals = {scene, desc->lenient, &d->warnings, error};
    lmn_status status = refuse_time(&refusals, look, desc->time_s, true);
    if (status == LMN_OK && s->plan.figure_count == 0)
        status = refuse(&refusals, LMN_USAGE, WARNING_NO_MATCH, NULL, "no rule of the look '%s' selects a part: the page stays empty", d->look);
    if (status == LMN_OK)
        status = refuse_strokes(&refusals, s, &r->up);
    return status == LMN_OK ? refuse_marks(&refusals, s) : status;
}

/* An extra frame with one sample and all buffers read back. */
static lmn_status draw_maps(lmn_drawing *d, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                            lmn_error *error)
{
    enum { LARGE = 1 << 21 }; /* pixels from which on the drawing's own pictures are not kept while maps are read */
    session s;
    warnings ignored = {0};
    if ((int64_t)desc->width * desc->height >= LARGE)
        gpu_targets_trim(r->g);
    lmn_status status = session_open(&s, r, scene, look, desc, true, &ignored, error);
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
    d->part_pixels = mem_calloc(d->part_count, sizeof *d->part_pixels);
    if (!d->part_pixels)
        return error_memory(error);
    for (size_t i = 0, count = (size_t)desc->width * (size_t)desc->height; i < count; i++)
        if (d->maps.id[i])
            d->part_pixels[d->maps.id[i] - 1]++;
    if (!desc->maps)
        frame_maps_release(&d->maps);
    return LMN_OK;
}

static lmn_status draw_frames(lmn_drawing *d, session *s, const lmn_draw_desc *desc, lmn_error *error)
{
    double start = clock_ms();
    frame_draw(&s->frame, s->out);
    gpu_finish(s->renderer->g);
    d->frame_ms = clock_ms() - start;
    d->programs = gpu_program_count(s->renderer->g);
    lmn_status status = gpu_check(s->renderer->g, error);
    memcpy(d->strokes, s->frame.strokes, sizeof d->strokes);
    d->layers = s->frame.producer ? s->frame.layers : 1;
    d->producer = s->frame.producer;
    if (s->frame.lists_full)
        warnings_add(&d->warnings, WARNING_LAYER_MEMORY, "layers did not fit into layers.memory and were peeled instead, which takes longer");
    if (status == LMN_OK)
        status = read_pixels(d, s, error);
    if (status != LMN_OK || !desc->profile)
        return status;
    s->frame.profile = true;
    frame_draw(&s->frame, s->out);
    memcpy(d->times, s->frame.times, sizeof d->times);
    d->time_count = s->frame.time_count;
    return gpu_check(s->renderer->g, error);
}

static bool cancelled(const lmn_draw_desc *desc, double fraction, const char *stage)
{
    return desc->progress && !desc->progress(fraction, stage, desc->progress_user);
}

lmn_status renderer_draw(lmn_drawing **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                         lmn_error *error)
{
    *out = NULL;
    lmn_drawing *d = mem_calloc(1, sizeof *d);
    if (!d)
        return error_memory(error);
    d->width = desc->width;
    d->height = desc->height;
    session s;
    lmn_status status = session_open(&s, r, scene, look, desc, false, &d->warnings, error);
    if (status == LMN_OK && cancelled(desc, 0.3, "drawing"))
        status = error_set(error, LMN_CANCELLED, "cancelled");
    if (status == LMN_OK)
        status = keep_facts(d, r, scene, look, &s, desc, error);
    if (status == LMN_OK)
        status = draw_frames(d, &s, desc, error);
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
    mem_free(d->look);
    mem_free(d->vendor);
    mem_free(d->renderer);
    mem_free(d->version);
    for (size_t i = 0; i < d->part_count; i++)
        mem_free(d->part_names[i]);
    mem_free(d->part_names);
    mem_free(d->part_pixels);
    mem_free(d);
    *drawing = NULL;
}
