/* Declared passes: programs from tables, pictures from the pool, in the order in which a technique lists them. */
#include "draw/frame_private.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"

void frame_set_common(frame *f, const figure_state *s)
{
    gpu *g = f->g;
    gpu_set_vec2(g, "u_size", (float)f->width, (float)f->height);
    gpu_set_vec2(g, "u_texel", 1 / (float)f->width, 1 / (float)f->height);
    gpu_set_float(g, "u_perspective", f->camera.orthographic ? 0 : 1);
    gpu_set_vec2(g, "u_unproject", (float)(1 / f->camera.projection.m[0]), (float)(1 / f->camera.projection.m[5]));
    gpu_set_float(g, "u_near", (float)s->near);
    gpu_set_float(g, "u_far", (float)s->far);
    if (gpu_has_uniform(g, "u_light_position"))
        lights_set(f);
}

static const char *prefix_of(kind_id id)
{
    return id == KIND_LINES ? "u_line_" : "u_";
}

param_set use_own_set(kind_id id, const technique_use *use)
{
    return (param_set){prefix_of(id), use->technique->params, use->technique->param_count, use->values};
}

param_set use_common_set(kind_id id, const technique_use *use)
{
    return (param_set){prefix_of(id), kinds[id]->common, kinds[id]->common_count, use->values};
}

/* The line technique that a composition inks; NULL when the rule has none. */
const technique_use *rule_inked_lines(const rule *r)
{
    size_t count = r->use_counts[KIND_LINES];
    return count ? &r->uses[KIND_LINES][count - 1] : NULL;
}

gpu_texture *frame_acquire(frame *f, target t)
{
    static const gpu_format formats[TARGET_COUNT] = {
        [TARGET_NORMAL_DEPTH] = GPU_RGBA32F, [TARGET_ID] = GPU_RG32UI,     [TARGET_ALBEDO] = GPU_RGBA16F,
        [TARGET_SHADE] = GPU_RGBA16F,        [TARGET_DEPTH] = GPU_DEPTH32F, [TARGET_EDGE] = GPU_RGBA16F,
        [TARGET_GROUND] = GPU_RGBA16F,       [TARGET_REFLECTION] = GPU_RGBA16F, [TARGET_PAGE] = GPU_RGBA16F,
    };
    return gpu_target_acquire(f->g, f->width, f->height, formats[t]);
}

static gpu_texture *target_of(const frame *f, const figure_state *s, target t)
{
    return t == TARGET_PAGE ? f->page : s->targets[t];
}

static bool pass_applies(kind_id id, const pass *p, const technique_use *use)
{
    const technique *t = use->technique;
    const kind *k = kinds[id];
    if (!p->when)
        return true;
    char key[32];
    size_t length = strcspn(p->when, "=<>");
    if (length >= sizeof key)
        return false;
    memcpy(key, p->when, length);
    key[length] = '\0';
    for (size_t i = 0; i < k->common_count; i++)
        if (strcmp(k->common[i].key, key) == 0)
            return params_condition(p->when, k->common, k->common_count, use->values);
    return params_condition(p->when, t->params, t->param_count, use->values);
}

const pass *rule_merged_detection(const rule *r)
{
    const technique_use *compose = rule_use(r, KIND_COMPOSE), *lines = rule_inked_lines(r);
    if (!compose || !compose->technique->merges_when || r->use_counts[KIND_LINES] != 1 || !lines->technique->detect ||
        !params_condition(compose->technique->merges_when, kinds[KIND_LINES]->common, kinds[KIND_LINES]->common_count, lines->values))
        return NULL;
    const pass *only = NULL;
    for (size_t i = 0; i < lines->technique->pass_count; i++) {
        const pass *p = &lines->technique->passes[i];
        if (!pass_applies(KIND_LINES, p, lines))
            continue;
        if (only)
            return NULL;
        only = p;
    }
    return only;
}

/* The pictures of both passes, each once. Returns how many. */
static int union_of_reads(const pass *a, const pass *b, target out[2 * PASS_READS_MAX])
{
    int count = 0;
    for (int which = 0; which < 2; which++) {
        const pass *p = which ? b : a;
        for (int i = 0; p && i < PASS_READS_MAX && p->reads[i]; i++) {
            bool known = false;
            for (int k = 0; k < count; k++)
                known = known || out[k] == p->reads[i];
            if (!known)
                out[count++] = p->reads[i];
        }
    }
    return count;
}

void reads_declare(text *prelude, const frame *f, const figure_state *s, const pass *a, const pass *b)
{
    target reads[2 * PASS_READS_MAX];
    int count = union_of_reads(a, b, reads);
    for (int i = 0; i < count; i++)
        if (target_of(f, s, reads[i]))
            target_declare(prelude, reads[i]);
    if (s->targets[TARGET_ID])
        text_append(prelude, "#define HAS_ID\n");
}

void reads_set(frame *f, const figure_state *s, const pass *a, const pass *b)
{
    target reads[2 * PASS_READS_MAX];
    int count = union_of_reads(a, b, reads);
    for (int i = 0; i < count; i++) {
        /* 16-bit float pictures may be filtered; whoever wants whole texels fetches them. */
        bool linear = reads[i] == TARGET_SHADE || reads[i] == TARGET_EDGE;
        gpu_set_texture(f->g, target_name(reads[i]), target_of(f, s, reads[i]), linear);
    }
}

typedef struct pass_params {
    param_set   sets[4];
    const pass *merged; /* line detection that this pass does too, or NULL */
    size_t      count;
} pass_params;

static gpu_program *pass_program(frame *f, const figure_state *s, const pass *p, const pass_params *params)
{
    text prelude = {0};
    for (size_t i = 0; i < params->count; i++)
        uniforms_declare(&prelude, params->sets[i]);
    reads_declare(&prelude, f, s, p, params->merged);
    if (s->targets[TARGET_EDGE] || params->merged)
        text_append(&prelude, "#define HAS_LINES\n");
    char path[160];
    snprintf(path, sizeof path, "%s", p->shader);
    if (params->merged) {
        text_append(&prelude, "#define MERGED\n");
        snprintf(path, sizeof path, "%s+%s", rule_inked_lines(s->figure->rule)->technique->detect, p->shader);
    }
    if (s->figure->complement)
        text_append(&prelude, "#define HAS_COMPLEMENT\n");
    char *finished = text_take(&prelude);
    gpu_program *program = finished ? gpu_program_of(f->g, "gpu/screen.vert", path, finished) : NULL;
    if (!finished)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    mem_free(finished);
    return program;
}

/* The value a written picture has outside the scissor. */
static const float *neutral(target t)
{
    static const float paper[4] = {1, 1, 1, 1}, nothing[4] = {0, 0, 0, 0};
    return t == TARGET_EDGE ? paper : nothing;
}

static void run_geometry(frame *f, figure_state *s, const pass *p, const char *group)
{
    stopwatch w = watch_start(f);
    raster_inked(f, s, p);
    watch_stop(f, w, group, p->name);
}

static void run_pass(frame *f, figure_state *s, const pass *p, const pass_params *params, const char *group, int iteration)
{
    stopwatch w = watch_start(f);
    gpu_program *program = pass_program(f, s, p, params);
    bool page = p->writes == TARGET_PAGE;
    gpu_texture *written = page ? f->page : frame_acquire(f, p->writes);
    if (program && written && !gpu_failed(f->g)) {
        gpu_pass target = {.colours = {written}, .colour_count = 1, .depth = p->depth ? f->page_depth : NULL,
                           .clear = !page, .keep_depth = true};
        memcpy(target.clear_values[0], neutral(p->writes), 4 * sizeof(float));
        memcpy(target.scissor, s->pixels, sizeof target.scissor);
        memcpy(target.clear_box, s->around, sizeof target.clear_box);
        gpu_pass_begin(f->g, &target);
        gpu_use(f->g, program, (gpu_state){.depth_test = p->depth, .depth_write = p->depth,
                                           .blend = p->blend == BLEND_OVER ? GPU_BLEND_OVER
                                                    : p->blend == BLEND_MIN ? GPU_BLEND_MIN : GPU_BLEND_NONE});
        frame_set_common(f, s);
        gpu_set_int(f->g, "u_iteration", iteration);
        for (size_t i = 0; i < params->count; i++)
            uniforms_set(f->g, params->sets[i]);
        reads_set(f, s, p, params->merged);
        gpu_draw_screen(f->g);
    }
    if (!page) {
        if (s->targets[p->writes] != s->geometry)
            gpu_target_release(f->g, s->targets[p->writes]);
        s->targets[p->writes] = written;
    }
    watch_stop(f, w, group, p->name);
}

static void run_use(frame *f, figure_state *s, kind_id id, const technique_use *use)
{
    const technique *t = use->technique;
    pass_params params = {.sets = {use_own_set(id, use), use_common_set(id, use)}, .count = 2};
    /* A composition inks the lines as well, with the parameters that all line techniques share. */
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    if (id == KIND_COMPOSE && lines) {
        params.sets[params.count++] = use_common_set(KIND_LINES, lines);
        params.merged = rule_merged_detection(s->figure->rule);
        if (params.merged)
            params.sets[params.count++] = use_own_set(KIND_LINES, lines);
    }
    for (size_t i = 0; i < t->pass_count; i++) {
        const pass *p = &t->passes[i];
        if (!pass_applies(id, p, use))
            continue;
        if (p->geometry)
            run_geometry(f, s, p, kinds[id]->name);
        else
            for (int k = 0; k < (p->repeat > 1 ? p->repeat : 1); k++)
                run_pass(f, s, p, &params, kinds[id]->name, k);
    }
}

void passes_run_kind(frame *f, figure_state *s, kind_id id)
{
    const rule *r = s->figure->rule;
    const kind *k = kinds[id];
    if (id == KIND_LINES && !f->maps && rule_merged_detection(r))
        return;
    for (size_t i = 0; i < r->use_counts[id]; i++) {
        const technique_use *use = &r->uses[id][i];
        run_use(f, s, id, use);
        if (f->maps && id == KIND_LINES) {
            collect_edges(f, s);
        } else if (k->fold && i + 1 < r->use_counts[id]) {
            pass_params params = {.sets = {use_common_set(id, use)}, .count = 1};
            run_pass(f, s, k->fold, &params, k->name, 0);
        }
        if (s->targets[TARGET_NORMAL_DEPTH] != s->geometry) {
            gpu_target_release(f->g, s->targets[TARGET_NORMAL_DEPTH]);
            s->targets[TARGET_NORMAL_DEPTH] = s->geometry;
        }
    }
}
