/* Declared passes: programs from tables, pictures from the pool, in the order in which a technique lists them. */
#include "frame/frame_private.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"
#include "lines/lines.h"

typedef struct pass_params {
    param_set            sets[5];
    const pass          *merged;    /* line detection that this pass does too, or NULL */
    const perturbation  *perturbed; /* moves what this pass looks up, or NULL */
    const technique_use *made;      /* of motion: has made textures; or NULL */
    size_t               count;
} pass_params;

static bool goes_onto_page(const pass *p)
{
    return p->writes == TARGET_PAGE || p->writes == TARGET_LAYERS || p->writes == TARGET_SHADOW;
}

/* Does the figure's perturbation move what the pass looks up? */
static bool is_moved(const pass *p, const pass_params *params)
{
    return params->perturbed && (p->looks_up || goes_onto_page(p));
}

/* Is its picture one that is there and added to? */
static bool adds(const pass *p)
{
    return p->onto || goes_onto_page(p);
}

/* Is the pass drawn in the tiles that have something, instead of everywhere? */
static bool in_boxes(const figure_state *s, const pass *p)
{
    return s->boxes && !p->tiles && target_row_of(s, p->writes)->scale == SCALE_PAGE;
}

static gpu_program *pass_program(frame *f, const figure_state *s, const pass *p, const pass_params *params,
                                 bool depth_alone)
{
    text prelude = {0};
    if (depth_alone)
        text_append(&prelude, "#define SEEN_DEPTH\n");
    for (size_t i = 0; i < params->count; i++)
        uniforms_declare(&prelude, params->sets[i]);
    if (p->prepares) /* for what is shaded: it may look at light as that does */
        lights_declare(&prelude, f);
    reads_declare(&prelude, f, s, p, params->merged);
    if ((s->targets[TARGET_EDGE] || params->merged) && !p->looks_up)
        text_append(&prelude, "#define HAS_LINES\n");
    char path[160];
    snprintf(path, sizeof path, "%s", p->shader);
    if (params->merged) {
        text_append(&prelude, "#define MERGED\n");
        snprintf(path, sizeof path, "%s+%s", rule_inked_lines(s->figure->rule)->technique->lines->detect, p->shader);
    }
    if (params->made)
        used_textures_declare(&prelude, params->made, &s->figure->textures->motion);
    if (s->figure->layered)
        text_append(&prelude, "#define SEEN_THROUGH\n");
    if (s->figure->complement)
        text_append(&prelude, "#define HAS_COMPLEMENT\n");
    if (p->writes_too)
        text_append(&prelude, "#define WRITES_TOO\n");
    if (p->tiles)
        text_append(&prelude, "#define TILES %s\n", target_row_of(s, p->tiles)->name);
    if (is_moved(p, params)) {
        text_append(&prelude, "#define PERTURBED\n");
        const technique_use *lines = rule_inked_lines(s->figure->rule);
        if (lines && ((const lines_common *)lines->values)->width > (float)LINES_FOUND_WIDTH * (float)f->samples)
            text_append(&prelude, "#define BROAD_LINES\n");
        used_textures_declare(&prelude, rule_use(s->figure->rule, KIND_PERTURB), &s->figure->textures->perturb);
        snprintf(path, sizeof path, "%s+%s", params->perturbed->positions, p->shader);
    }
    if (p->strips && target_row_of(s, p->writes)->format == TEXEL_DEPTH32F)
        text_append(&prelude, "#define DEPTH_ALONE\n%s", p->writes == TARGET_SHADOW ? "#define INTO_SHADOW\n" : "");
    const char *vertex = p->strips        ? p->strips->vertex
                         : in_boxes(s, p) ? "gpu/boxes.vert"
                         : p->tiles       ? "lines/tile.vert"
                                          : "gpu/screen.vert";
    return program_of(f, GPU_FLOOR, vertex, path, &prelude);
}

/* The value of a parameter that is a length. */
static float length_of(kind_id id, const technique_use *use, const char *key)
{
    const param *p = kind_find_param(kinds[id], use->technique, key);
    return p ? *(const float *)param_field(p, use->values) : 0;
}

static void run_geometry(frame *f, figure_state *s, const pass *p, kind_id id, const technique_use *use)
{
    stopwatch w = watch_start(&f->profile);
    if (p->shell)
        raster_shell(f, s, p->writes, length_of(id, use, p->enlarge));
    else if (p->enlarge)
        raster_enlarged(f, s, p->writes, length_of(id, use, p->enlarge));
    else
        raster_inked(f, s, p);
    watch_stop(&f->profile, w, kinds[id]->name, p->name);
}

/* Where a pass draws: the figure's pixels, or the coarse texels over them. */
static void set_scissor(const frame *f, const figure_state *s, const pass *p, gpu_pass *out)
{
    if (p->writes == TARGET_SHADOW) /* another eye's */
        return;
    memcpy(out->scissor, p->writes == TARGET_LAYERS ? s->band : s->pixels, sizeof out->scissor);
    memcpy(out->clear_box, s->around, sizeof out->clear_box);
    target_scale scale = target_row_of(s, p->writes)->scale;
    if (scale == SCALE_PAGE)
        return;
    int size[2], beyond = scale == SCALE_CELL ? 1 : 0; /* a perturbation's have one texel more */
    target_size(f, s, scale, size);
    const int limits[2] = {f->width, f->height};
    memset(out->clear_box, 0, sizeof out->clear_box);
    for (int k = 0; k < 2; k++) { /* lookups between texels need those beside */
        int low = (int)((int64_t)s->pixels[k] * (size[k] - beyond) / limits[k]) - 1;
        int high = (int)((int64_t)(s->pixels[k] + s->pixels[2 + k]) * (size[k] - beyond) / limits[k]) + 2;
        out->scissor[k] = low > 0 ? low : 0;
        out->scissor[2 + k] = (high < size[k] ? high : size[k]) - out->scissor[k];
    }
}

static void draw_strips(frame *f, const figure_state *s, const pass *p, const technique_use *use)
{
    strip_view view = {f->width, f->height, {0}, f->seed, f->time_s};
    size_t     count = 0;
    camera_pixels(&f->camera, s->figure->box, f->width, f->height, 0, view.box);
    float *records = p->strips->make(&count, use->values, &view);
    if (!records)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    gpu_marks *strips =
        count ? gpu_marks_create_strips(f->g, 1, records, count, p->strips->vertices(use->values)) : NULL;
    mem_free(records);
    gpu_settle(f->g);
    gpu_draw_marks(f->g, strips);
    gpu_marks_destroy(f->g, &strips);
}

/* The figure's tiles as quads; those that have nothing are left out where vertices are placed. */
static void draw_tiles(frame *f, const figure_state *s)
{
    const int *b = s->pixels, first[2] = {b[0] / TILE_PIXELS, b[1] / TILE_PIXELS};
    int        columns = (b[0] + b[2] - 1) / TILE_PIXELS - first[0] + 1;
    int        rows = (b[1] + b[3] - 1) / TILE_PIXELS - first[1] + 1;
    float     *records = mem_alloc((size_t)columns * (size_t)rows * 4 * sizeof *records), *at = records;
    for (int i = 0; records && i < columns * rows; i++, at += 4) {
        at[0] = (float)(first[0] + i % columns);
        at[1] = (float)(first[1] + i / columns);
        at[2] = at[3] = 0;
    }
    gpu_marks *tiles = records ? gpu_marks_create(f->g, 1, records, (size_t)columns * (size_t)rows) : NULL;
    if (!records)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    mem_free(records);
    gpu_settle(f->g);
    if (tiles)
        gpu_draw_marks(f->g, tiles);
    gpu_marks_destroy(f->g, &tiles);
}

/* What a pass draws into. */
static gpu_pass pass_target(frame *f, const figure_state *s, const pass *p, gpu_texture *written, gpu_texture *too)
{
    bool     page = adds(p), depth_alone = target_row_of(s, p->writes)->format == TEXEL_DEPTH32F;
    gpu_pass target = {.colours = {depth_alone ? NULL : written, too},
                       .colour_count = depth_alone ? 0
                                       : too       ? 2
                                                   : 1,
                       .depth = depth_alone ? written
                                : p->depth  ? f->page_depth
                                            : NULL,
                       .clear = !page,
                       .keep_depth = !depth_alone};
    target_empty(target_row_of(s, p->writes), s->far, target.clear_values[0]);
    if (too)
        target_empty(target_row_of(s, p->writes_too), s->far, target.clear_values[1]);
    return target;
}

static gpu_state pass_state(const figure_state *s, const pass *p)
{
    bool depth_alone = target_row_of(s, p->writes)->format == TEXEL_DEPTH32F;
    return (gpu_state){.depth_test = p->depth || depth_alone,
                       .depth_write = depth_alone || (p->depth && p->writes != TARGET_LAYERS),
                       .blend = p->blend == BLEND_OVER    ? GPU_BLEND_OVER
                                : p->blend == BLEND_UNDER ? GPU_BLEND_UNDER
                                : p->blend == BLEND_MIN   ? GPU_BLEND_MIN
                                                          : GPU_BLEND_NONE};
}

/* A pass's picture takes the place of the one before. */
static void keep_written(frame *f, figure_state *s, target t, gpu_texture *written)
{
    if (s->targets[t] != s->geometry)
        gpu_target_release(f->g, s->targets[t]);
    s->targets[t] = written;
}

/* What prepares shading is needed only where something is shaded: software drivers skip blocks of pixels by the depth
 * test, as in raster_shade_deferred. */
static void where_shaded(frame *f, const figure_state *s, const pass *p, gpu_pass *target, gpu_state *state)
{
    gpu_texture *depth = s->targets[TARGET_DEPTH];
    if (!p->prepares || !depth || target_row_of(s, p->writes)->scale != SCALE_PAGE)
        return;
    gpu_pass_begin(f->g, target);
    target->clear = false;
    target->depth = depth;
    *state = (gpu_state){.depth_test = true, .depth_compare = GPU_GREATER};
}

/* Into pictures that are there, with all that the program asks for. */
static void draw_pass(frame *f, figure_state *s, const pass *p, const pass_params *params, gpu_program *program,
                      const gpu_pass *target, gpu_state state, int iteration)
{
    gpu_pass_begin(f->g, target);
    gpu_use(f->g, program, state);
    frame_set_common(f, s);
    gpu_set_int(f->g, "u_iteration", iteration);
    for (size_t i = 0; i < params->count; i++)
        uniforms_set(f->g, params->sets[i]);
    reads_set(f, s, p, params->merged);
    if (is_moved(p, params)) {
        used_textures_set(f->g, rule_use(s->figure->rule, KIND_PERTURB), &s->figure->textures->perturb);
        frame_set_numbers(f, rule_use(s->figure->rule, KIND_PERTURB));
    }
    if (params->made)
        used_textures_set(f->g, params->made, &s->figure->textures->motion);
    gpu_set_vec2(f->g, "u_target", (float)f->width, (float)f->height);
    if (p->strips)
        draw_strips(f, s, p, params->made);
    else if (in_boxes(s, p))
        gpu_draw_boxes(f->g, s->boxes, s->box_count);
    else if (p->tiles)
        draw_tiles(f, s);
    else
        gpu_draw_screen(f->g);
}

/* A sketch that is seen through has its nearest layer's depth, which only who composes it knows: once more, for the
 * depth alone. One field moves all layers, so that none of them gets before it. */
static void keep_moved_depth(frame *f, figure_state *s, const pass *p, const pass_params *params)
{
    if (p->writes != TARGET_LAYERS || !f->moved_depth || s->layer > 0 || s->figure->mover || !params->perturbed)
        return;
    gpu_program *program = pass_program(f, s, p, params, true);
    gpu_pass     target = {.depth = f->moved_depth};
    set_scissor(f, s, p, &target);
    if (program && !gpu_failed(f->g))
        draw_pass(f, s, p, params, program, &target, (gpu_state){.depth_test = true, .depth_write = true}, 0);
}

static void run_pass(frame *f, figure_state *s, const pass *p, const pass_params *params, const char *group,
                     int iteration)
{
    stopwatch    w = watch_start(&f->profile);
    gpu_program *program = pass_program(f, s, p, params, false);
    bool         page = adds(p);
    gpu_texture *written = page ? target_of(f, s, p->writes) : frame_acquire_for(f, s, p->writes);
    gpu_texture *too = p->writes_too ? frame_acquire_for(f, s, p->writes_too) : NULL;
    if (program && written && !gpu_failed(f->g)) {
        gpu_pass  target = pass_target(f, s, p, written, too);
        gpu_state state = pass_state(s, p);
        set_scissor(f, s, p, &target);
        where_shaded(f, s, p, &target, &state);
        draw_pass(f, s, p, params, program, &target, state, iteration);
        keep_moved_depth(f, s, p, params);
    }
    if (!page)
        keep_written(f, s, p->writes, written);
    if (too)
        keep_written(f, s, p->writes_too, too);
    watch_stop(&f->profile, w, group, p->name);
}

/* Gives back what lasts no longer. */
static void forget(frame *f, figure_state *s, target_owner owner)
{
    for (int t = 0; t < TARGET_COUNT; t++)
        if (target_rows[t].owner == owner) {
            gpu_target_release(f->g, s->targets[t]);
            s->targets[t] = NULL;
        }
}

/* What the technique kept for itself while its passes ran. */
static void forget_own(frame *f, figure_state *s)
{
    for (int t = TARGET_COUNT; t < TARGET_SLOTS; t++) {
        gpu_target_release(f->g, s->targets[t]);
        s->targets[t] = NULL;
    }
    s->own_targets = NULL;
}

/* Where a pass has anything to do: the box around all that is drawn. */
static void box_of_interest(const figure_state *s, int out[4])
{
    memcpy(out, s->boxes && s->box_count ? s->boxes[0] : s->pixels, 4 * sizeof *out);
    for (size_t i = 1; s->boxes && i < s->box_count; i++)
        camera_widen_pixels(out, s->boxes[i]);
}

/* A picture that a pass on the CPU reads. Depths are taken as they were drawn: filters invent some beside edges. */
static const float *read_floats(frame *f, const figure_state *s, target t, const int box[4])
{
    float *out = mem_alloc((size_t)box[2] * (size_t)box[3] * 4 * sizeof *out);
    if (out)
        gpu_read_box(f->g, t == TARGET_NORMAL_DEPTH ? s->geometry : target_of(f, s, t), box, out);
    else
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    return out;
}

/* Where the figure's own surfaces are; NULL when all are, or memory is gone. */
static const uint8_t *read_own(frame *f, const figure_state *s, const int box[4])
{
    if (!s->targets[TARGET_ID] || (!s->figure->complement && !s->shared))
        return NULL;
    size_t    count = (size_t)box[2] * (size_t)box[3];
    uint32_t *ids = mem_alloc(count * 2 * sizeof *ids);
    uint8_t  *own = mem_alloc(count);
    if (ids && own)
        gpu_read_box(f->g, s->targets[TARGET_ID], box, ids);
    else
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    bool good = !gpu_failed(f->g);
    for (size_t i = 0; i < count && good; i++) {
        uint32_t surface = ids[2 * i + 1], figure = (surface >> SURFACE_INDEX_BITS) & FIGURES_TOGETHER_MAX;
        own[i] = ids[2 * i] && !(surface & SURFACE_COMPLEMENT) && (!s->shared || (int)figure == s->index);
    }
    mem_free(ids);
    if (!good)
        mem_free(own);
    return good ? own : NULL;
}

/* A pass on the CPU. Outside the box its picture is undefined: nothing is inked there. */
static void run_process(frame *f, figure_state *s, const pass *p, const technique_use *use, const char *group)
{
    stopwatch w = watch_start(&f->profile);
    int       box[4];
    box_of_interest(s, box);
    pass_pixels in = {.own = read_own(f, s, box),
                      .x = box[0],
                      .y = box[1],
                      .width = box[2],
                      .height = box[3],
                      .pixel = (float)(2 / (f->camera.projection.m[5] * f->height)),
                      .scale = (float)f->samples,
                      .perspective = !f->camera.orthographic};
    for (int i = 0; i < PASS_READS_MAX && p->reads[i]; i++)
        if (p->reads[i] < TARGET_COUNT || s->targets[p->reads[i]])
            in.values[i] = read_floats(f, s, p->reads[i], box);
    gpu_texture *written = frame_acquire_for(f, s, p->writes);
    void        *out = written ? mem_calloc((size_t)box[2] * (size_t)box[3], gpu_texel_size(written)) : NULL;
    if (out && s->targets[p->writes])
        gpu_read_box(f->g, s->targets[p->writes], box, out);
    if (!out || (!gpu_failed(f->g) && !p->process(&in, out, use->values)))
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    gpu_target_write(f->g, written, box, out);
    for (int i = 0; i < PASS_READS_MAX; i++)
        mem_free((void *)in.values[i]);
    mem_free((void *)in.own);
    mem_free(out);
    gpu_target_release(f->g, s->targets[p->writes]);
    s->targets[p->writes] = written;
    watch_stop(&f->profile, w, group, p->name);
}

static void run_scattered(frame *f, figure_state *s, const pass *p, const technique_use *use)
{
    const param *samples = kind_find_param(kinds[KIND_MOTION], use->technique, p->scattered);
    stopwatch    w = watch_start(&f->profile);
    scattered_draw(f, s, p, *(const int32_t *)param_field(samples, use->values));
    watch_stop(&f->profile, w, kinds[KIND_MOTION]->name, p->name);
}

/* Does the pass belong to this run: before the figure is shaded, or after? */
static bool is_due(const frame *f, const pass *p, bool before)
{
    return p->prepares == before && !(p->stylised && f->maps) && p->writes != TARGET_SHADOW;
}

/* Are the pictures there that the pass depends on, and none that it stands in for? */
static bool has_pictures(const figure_state *s, const pass *p)
{
    return (!p->with || s->targets[p->with]) && (!p->without || !s->targets[p->without]);
}

static int rounds_of(const pass *p, const technique_use *use)
{
    return p->rounds ? p->rounds(use->values) : p->repeat > 1 ? p->repeat : 1;
}

static void run_use(frame *f, figure_state *s, kind_id id, const technique_use *use, bool before)
{
    const technique *t = use->technique;
    if (id == KIND_LINES)
        forget(f, s, OWNER_LINES);
    s->own_targets = t->targets;
    pass_params params = {.sets = {use_own_set(id, use), use_common_set(id, use)}, .count = 2};
    if (id == KIND_MOTION)
        params.made = use;
    /* A composition inks the lines as well, with the parameters that all line techniques share. */
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    if (id == KIND_COMPOSE && lines) {
        params.sets[params.count++] = use_common_set(KIND_LINES, lines);
        params.merged = rule_merged_detection(s->figure->rule);
        if (params.merged || lines->technique->lines->own_ink)
            params.sets[params.count++] = use_own_set(KIND_LINES, lines);
    }
    const technique_use *perturb = rule_use(s->figure->rule, KIND_PERTURB);
    if (id == KIND_COMPOSE && perturb) {
        params.sets[params.count++] = use_own_set(KIND_PERTURB, perturb);
        params.perturbed = perturb->technique->perturbs;
    }
    for (size_t i = 0; i < t->pass_count; i++) {
        const pass *p = &t->passes[i];
        if (!pass_applies(id, p, use) || !is_due(f, p, before) || !has_pictures(s, p))
            continue;
        if (p->strokes)
            strokes_run(f, s, p, use, kinds[id]->name);
        else if (p->records)
            records_run(f, s, p, use, kinds[id]->name);
        else if (p->scattered)
            run_scattered(f, s, p, use);
        else if (p->geometry)
            run_geometry(f, s, p, id, use);
        else if (p->process)
            run_process(f, s, p, use, kinds[id]->name);
        else
            for (int k = 0; k < rounds_of(p, use); k++)
                run_pass(f, s, p, &params, kinds[id]->name, k);
    }
    forget_own(f, s);
}

void passes_throw_shadows(frame *f, figure_state *s)
{
    const technique_use *use = rule_use(s->figure->rule, KIND_MOTION);
    pass_params          params = {
                 .sets = {use_own_set(KIND_MOTION, use), use_common_set(KIND_MOTION, use)}, .count = 2, .made = use};
    s->own_targets = use->technique->targets;
    for (size_t i = 0; i < use->technique->pass_count; i++)
        if (use->technique->passes[i].writes == TARGET_SHADOW &&
            pass_applies(KIND_MOTION, &use->technique->passes[i], use))
            run_pass(f, s, &use->technique->passes[i], &params, kinds[KIND_MOTION]->name, 0);
}

/* Takes what a line technique found into the picture before the next one looks. */
static void fold_lines(frame *f, figure_state *s, kind_id id, const technique_use *use)
{
    pass_params params = {.sets = {use_common_set(id, use)}, .count = 1};
    if (use->technique->lines->own_ink)
        params.sets[params.count++] = use_own_set(id, use);
    run_pass(f, s, kinds[id]->fold, &params, kinds[id]->name, 0);
}

void passes_prepare(frame *f, figure_state *s)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    run_use(f, s, KIND_SURFACE, surface, true);
    if (f->maps && s->targets[TARGET_DIRECTION])
        collect_direction(f, s);
}

void passes_run_kind(frame *f, figure_state *s, kind_id id)
{
    const rule *r = s->figure->rule;
    if (id == KIND_LINES)
        forget(f, s, OWNER_ALL_LINES);
    if (id == KIND_LINES && !f->maps && rule_merged_detection(r)) {
        forget(f, s, OWNER_LINES);
        return;
    }
    for (size_t i = 0; i < r->use_counts[id]; i++) {
        const technique_use *use = &r->uses[id][i];
        run_use(f, s, id, use, false);
        if (f->maps && id == KIND_LINES)
            collect_edges(f, s);
        else if (kinds[id]->fold && i + 1 < r->use_counts[id])
            fold_lines(f, s, id, use);
        if (s->targets[TARGET_NORMAL_DEPTH] != s->geometry) {
            gpu_target_release(f->g, s->targets[TARGET_NORMAL_DEPTH]);
            s->targets[TARGET_NORMAL_DEPTH] = s->geometry;
        }
    }
    if (f->maps && id == KIND_PERTURB && rule_use(r, id) && rule_use(r, id)->technique->perturbs->map) {
        const technique_use *use = rule_use(r, id);
        run_pass(f, s, use->technique->perturbs->map, &(pass_params){.sets = {use_own_set(id, use)}, .count = 1},
                 kinds[id]->name, 0);
        collect_uncertainty(f, s);
    }
}

void passes_look_up(frame *f, figure_state *s, gpu_texture *out[LOOKED_UP])
{
    static const target_row rows[LOOKED_UP] = {
        {"t_found_edge", TEXEL_RGBA32F}, {"t_found_shade", TEXEL_RGBA32F}, {"t_found_depth", TEXEL_RGBA32F}};
    static const pass    passes[] = {{.name = "lines and fill",
                                      .shader = "compose/looked_up.frag",
                                      .reads = {TARGET_SHADE, TARGET_DEPTH, TARGET_EDGE, TARGET_ID, TARGET_UNCERTAINTY},
                                      .writes = TARGET_OWN(0),
                                      .writes_too = TARGET_OWN(1),
                                      .looks_up = true},
                                     {.name = "depth",
                                      .shader = "compose/looked_up.frag",
                                      .reads = {TARGET_SHADE, TARGET_DEPTH, TARGET_ID, TARGET_UNCERTAINTY},
                                      .writes = TARGET_OWN(2),
                                      .looks_up = true}};
    const technique_use *perturb = rule_use(s->figure->rule, KIND_PERTURB);
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    pass_params          params = {.count = 0};
    if (lines)
        params.sets[params.count++] = use_common_set(KIND_LINES, lines);
    if (perturb) {
        params.sets[params.count++] = use_own_set(KIND_PERTURB, perturb);
        params.perturbed = perturb->technique->perturbs;
    }
    s->own_targets = rows;
    for (int i = 0; i < 2; i++)
        run_pass(f, s, &passes[i], &params, "maps", 0);
    for (int i = 0; i < LOOKED_UP; i++) {
        out[i] = s->targets[TARGET_OWN(i)];
        s->targets[TARGET_OWN(i)] = NULL;
    }
    s->own_targets = NULL;
}

void passes_compose_lines(frame *f, figure_state *s, bool nearest_first)
{
    const figure *whole = s->figure;
    const rule   *r = whole->rule;
    size_t        lines = r->use_counts[KIND_LINES], count = lines > 1 ? lines : 1;
    for (size_t k = 0; k < count; k++) {
        size_t i = nearest_first ? count - 1 - k : k;
        rule   single = *r;
        figure alone = *whole;
        alone.rule = &single;
        if (lines)
            single.uses[KIND_LINES] = &r->uses[KIND_LINES][i];
        single.use_counts[KIND_LINES] = lines > 0;
        s->figure = &alone;
        s->filled = i == 0;
        passes_run_kind(f, s, KIND_LINES);
        passes_run_kind(f, s, KIND_COMPOSE);
        gpu_target_release(f->g, s->targets[TARGET_EDGE_BEFORE]);
        s->targets[TARGET_EDGE_BEFORE] = NULL;
        if (lines == 1)
            s->targets[TARGET_EDGE_BEFORE] = s->targets[TARGET_EDGE];
        else
            gpu_target_release(f->g, s->targets[TARGET_EDGE]);
        s->targets[TARGET_EDGE] = NULL;
    }
    s->figure = whole;
}
