#include "draw/frame.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "draw/uniforms.h"
#include "light/light.h"

/* A figure while it is drawn: its pictures and its range of depth. */
typedef struct figure_state {
    const figure *figure;
    gpu_texture  *targets[TARGET_COUNT];
    gpu_texture  *geometry;  /* the normal-depth buffer as it was drawn; techniques may filter a copy of it */
    float        *edges;     /* for maps: darkest of all line techniques' edge maps, 4 a pixel */
    int           pixels[4]; /* scissor */
    double        near, far;
} figure_state;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* --- profiling ------------------------------------------------------------------------------------------------- */

typedef struct stopwatch {
    double   start;
    uint64_t draws;
} stopwatch;

static stopwatch watch_start(frame *f)
{
    if (!f->profile)
        return (stopwatch){0};
    gpu_finish(f->g);
    return (stopwatch){now_ms(), gpu_draw_count(f->g)};
}

static void watch_stop(frame *f, stopwatch w, const char *group, const char *name)
{
    if (!f->profile)
        return;
    gpu_finish(f->g);
    char joined[sizeof f->times[0].name];
    snprintf(joined, sizeof joined, "%s%s%s", group, *group ? ": " : "", name);
    pass_time *t = NULL;
    for (size_t i = 0; i < f->time_count && !t; i++)
        if (strcmp(f->times[i].name, joined) == 0)
            t = &f->times[i];
    if (!t) {
        if (f->time_count == PASS_TIMES_MAX)
            return;
        t = &f->times[f->time_count++];
        memset(t, 0, sizeof *t);
        memcpy(t->name, joined, sizeof joined);
    }
    t->ms += now_ms() - w.start;
    t->draws += gpu_draw_count(f->g) - w.draws;
}

/* --- uniforms of the whole frame --------------------------------------------------------------------------------- */

static const scene_values *scene_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

static void add_light(float positions[][4], float colours[][4], int *count, const double direction[3], double w, const float rgb[3],
                      float strength)
{
    if (*count >= LIGHTS_MAX)
        return;
    double length = w > 0 ? 1 : sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int k = 0; k < 3; k++) {
        positions[*count][k] = (float)(direction[k] / (length > 0 ? length : 1));
        colours[*count][k] = rgb[k] * strength;
    }
    positions[*count][3] = (float)w;
    colours[*count][3] = 1;
    ++*count;
}

static void add_file_lights(const frame *f, float positions[][4], float colours[][4], int *count, float scale)
{
    const lmn_scene *scene = f->plan->scene;
    for (size_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].light < 0)
            continue;
        const light *l = &scene->lights[scene->nodes[i].light];
        mat4 eye = mat4_multiply(&f->camera.view, &f->up->worlds[i]);
        /* Lights shine along their node's −Z. Physical units are not used: every light counts as fully bright. */
        double back[3] = {eye.m[8], eye.m[9], eye.m[10]}, place[3] = {eye.m[12], eye.m[13], eye.m[14]};
        bool placed = l->type != LIGHT_DIRECTIONAL;
        add_light(positions, colours, count, placed ? place : back, placed ? 1 : 0, l->colour, scale);
    }
}

typedef struct light_list {
    float positions[LIGHTS_MAX][4], colours[LIGHTS_MAX][4];
    int   count; /* at least 1 */
} light_list;

static light_list list_lights(const frame *f)
{
    light_list l = {.count = 0};
    const scene_values *v = scene_of(f);
    if (v->lights == LIGHTS_FILE)
        add_file_lights(f, l.positions, l.colours, &l.count, v->light_scale);
    if (l.count > 0)
        return l;
    static const float white[3] = {1, 1, 1};
    double key[3] = {v->light_direction.x, v->light_direction.y, v->light_direction.z};
    if (key[0] == 0 && key[1] == 0 && key[2] == 0)
        key[2] = 1;
    /* The light goes with the viewer, but what a mirror shows is lit as the scene itself is. */
    double along = 0;
    for (int k = 0; k < 3 && f->mirror_depth; k++)
        along += key[k] * (double)f->clip_plane[k];
    for (int k = 0; k < 3 && f->mirror_depth; k++)
        key[k] -= 2 * along * (double)f->clip_plane[k];
    double fill[3] = {-key[0], -0.3 * key[1], fabs(key[2]) + 0.2};
    add_light(l.positions, l.colours, &l.count, key, 0, white, v->light_scale);
    if (v->fill > 0)
        add_light(l.positions, l.colours, &l.count, fill, 0, white, v->light_scale * v->fill);
    return l;
}

static void declare_lights(text *prelude, const frame *f)
{
    light_list l = list_lights(f);
    text_append(prelude, "#define LIGHT_COUNT %d\n", l.count);
}

static void set_lights(frame *f)
{
    light_list l = list_lights(f);
    gpu_set_vec4_array(f->g, "u_light_position", l.positions[0], l.count);
    gpu_set_vec4_array(f->g, "u_light_colour", l.colours[0], l.count);
}

static void set_common(frame *f, const figure_state *s)
{
    gpu *g = f->g;
    gpu_set_vec2(g, "u_size", (float)f->width, (float)f->height);
    gpu_set_float(g, "u_perspective", f->camera.orthographic ? 0 : 1);
    gpu_set_vec2(g, "u_unproject", (float)(1 / f->camera.projection.m[0]), (float)(1 / f->camera.projection.m[5]));
    gpu_set_float(g, "u_near", (float)s->near);
    gpu_set_float(g, "u_far", (float)s->far);
    if (gpu_has_uniform(g, "u_light_position"))
        set_lights(f);
}

static const char *prefix_of(kind_id id)
{
    return id == KIND_LINES ? "u_line_" : "u_";
}

static param_set own_set(kind_id id, const technique_use *use)
{
    return (param_set){prefix_of(id), use->technique->params, use->technique->param_count, use->values};
}

static param_set common_set(kind_id id, const technique_use *use)
{
    return (param_set){prefix_of(id), kinds[id]->common, kinds[id]->common_count, use->values};
}

/* The line technique that a composition inks; NULL when the rule has none. */
static const technique_use *inked_lines(const rule *r)
{
    size_t count = r->use_counts[KIND_LINES];
    return count ? &r->uses[KIND_LINES][count - 1] : NULL;
}

/* --- geometry pass ----------------------------------------------------------------------------------------------- */

static bool is_drawn(const frame *f, const figure *fig, const draw_item *item)
{
    if (f->mirror && f->mirror->designated[item->part_index])
        return false; /* a mirror does not see itself */
    return fig->designated[item->part_index] || (fig->complement && f->plan->selected[item->part_index]);
}

static const material *material_of(const frame *f, const draw_item *item)
{
    /* Formats without materials: a light neutral grey. */
    static const material standard = {.base_colour = {0.6f, 0.6f, 0.6f, 1}, .base_texture = TEXTURE_USE_NONE,
                                      .normal_texture = TEXTURE_USE_NONE, .normal_scale = 1, .alpha_cutoff = 0.5f};
    return item->material >= 0 ? &f->plan->scene->materials[item->material] : &standard;
}

typedef struct item_textures {
    gpu_texture *base, *normal;
} item_textures;

static item_textures textures_of(frame *f, const draw_item *item, const material *m)
{
    item_textures t = {NULL, NULL};
    if (!item->has_uvs)
        return t;
    t.base = upload_texture(f->up, f->g, f->plan->scene, &m->base_texture, false);
    t.normal = upload_texture(f->up, f->g, f->plan->scene, &m->normal_texture, true);
    return t;
}

static void declare_material(text *prelude, const draw_item *item, const material *m, item_textures t)
{
    if (t.base || t.normal)
        text_append(prelude, "#define HAS_UV\n");
    if (item->has_colours)
        text_append(prelude, "#define HAS_COLOURS\n");
    if (t.base)
        text_append(prelude, "#define HAS_BASE_TEXTURE\n");
    if (t.normal)
        text_append(prelude, "#define HAS_NORMAL_TEXTURE\n");
    if (m->alpha != ALPHA_OPAQUE)
        text_append(prelude, "#define CUT_OUT\n");
}

static void set_texture_matrix(gpu *g, const char *matrix, const char *offset, const texture_use *use, float strength)
{
    float c = cosf(use->rotation), s = sinf(use->rotation);
    gpu_set_vec4(g, matrix, (float[]){c * use->scale[0], -s * use->scale[0], s * use->scale[1], c * use->scale[1]});
    gpu_set_vec4(g, offset, (float[]){use->offset[0], use->offset[1], (float)use->uv_set, strength});
}

static void set_material(gpu *g, const material *m, item_textures t)
{
    const vec4 *c = &m->base_colour;
    gpu_set_vec4(g, "u_base_colour", (float[]){c->x, c->y, c->z, c->w});
    /* Blended surfaces are drawn as cut-outs: what is mostly there is there. */
    gpu_set_float(g, "u_alpha_cutoff", m->alpha == ALPHA_BLEND ? 0.1f : m->alpha_cutoff);
    gpu_set_int(g, "u_unlit", m->unlit);
    if (t.base) {
        gpu_set_texture(g, "t_base", t.base, true);
        set_texture_matrix(g, "u_base_matrix", "u_base_offset", &m->base_texture, 0);
    }
    if (t.normal) {
        gpu_set_texture(g, "t_normal", t.normal, true);
        set_texture_matrix(g, "u_normal_uv_matrix", "u_normal_uv_offset", &m->normal_texture, m->normal_scale);
    }
}

/* Model-view in double precision, then float; the normal matrix is its inverse transpose, up to a positive scale. */
static void set_transform(frame *f, const mat4 *world)
{
    mat4 both = mat4_multiply(&f->camera.view, world);
    float model_view[16], normal[9];
    for (int i = 0; i < 16; i++)
        model_view[i] = (float)both.m[i];
    const double *m = both.m;
    double cofactor[9] = {
        m[5] * m[10] - m[6] * m[9], m[6] * m[8] - m[4] * m[10], m[4] * m[9] - m[5] * m[8],
        m[9] * m[2] - m[10] * m[1], m[10] * m[0] - m[8] * m[2], m[8] * m[1] - m[9] * m[0],
        m[1] * m[6] - m[2] * m[5],  m[2] * m[4] - m[0] * m[6],  m[0] * m[5] - m[1] * m[4],
    };
    double determinant = m[0] * cofactor[0] + m[1] * cofactor[1] + m[2] * cofactor[2], largest = 0;
    for (int i = 0; i < 9; i++)
        largest = fmax(largest, fabs(cofactor[i]));
    double scale = (determinant < 0 ? -1 : 1) / (largest > 0 ? largest : 1);
    for (int i = 0; i < 9; i++)
        normal[i] = (float)(cofactor[i] * scale);
    gpu_set_mat4(f->g, "u_model_view", model_view);
    gpu_set_mat3(f->g, "u_normal_matrix", normal);
}

static void set_projection(frame *f)
{
    float projection[16];
    for (int i = 0; i < 16; i++)
        projection[i] = (float)f->camera.projection.m[i];
    gpu_set_mat4(f->g, "u_projection", projection);
}

/* What the geometry pass writes and where. */
typedef struct outputs {
    int normal_depth, id, albedo, shade; /* attachment, −1 = not */
} outputs;

static void declare_outputs(text *prelude, outputs o)
{
    if (o.normal_depth >= 0)
        text_append(prelude, "#define AT_NORMAL_DEPTH %d\n", o.normal_depth);
    if (o.id >= 0)
        text_append(prelude, "#define AT_ID %d\n", o.id);
    if (o.albedo >= 0)
        text_append(prelude, "#define AT_ALBEDO %d\n", o.albedo);
    if (o.shade >= 0)
        text_append(prelude, "#define AT_SHADE %d\n", o.shade);
}

/* Adds what a geometry pass with ink needs: the lines' parameters, the maps that the pass reads, and their files. */
static void declare_ink(text *prelude, char *path, size_t size, const frame *f, const figure_state *s, const pass *inking)
{
    const technique_use *lines = inked_lines(s->figure->rule), *compose = rule_use(s->figure->rule, KIND_COMPOSE);
    bool merged = compose->technique->merges && lines->technique->detect;
    uniforms_declare(prelude, common_set(KIND_LINES, lines));
    text_append(prelude, "#define INKED\n%s%s", merged ? "#define MERGED\n" : "", s->targets[TARGET_ID] ? "#define HAS_ID\n" : "");
    if (merged)
        uniforms_declare(prelude, own_set(KIND_LINES, lines));
    for (int i = 0; i < PASS_READS_MAX && inking->reads[i]; i++)
        if (s->targets[inking->reads[i]])
            target_declare(prelude, inking->reads[i]);
    (void)f;
    char joined[320];
    snprintf(joined, sizeof joined, "%s%s%s+%s", merged ? lines->technique->detect : "", merged ? "+" : "", inking->shader, path);
    snprintf(path, size, "%s", joined);
}

static gpu_program *raster_program(frame *f, const figure_state *s, const draw_item *item, const material *m, item_textures t, outputs o,
                                   const pass *inking)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    text prelude = {0};
    declare_outputs(&prelude, o);
    declare_material(&prelude, item, m, t);
    if (f->mirror_depth)
        text_append(&prelude, "#define CLIPPED\n");
    char path[320] = "layer/raster.frag";
    if (o.shade >= 0) {
        declare_lights(&prelude, f);
        uniforms_declare(&prelude, own_set(KIND_SURFACE, surface));
        snprintf(path, sizeof path, "%s+layer/raster.frag", surface->technique->surface);
    }
    if (inking)
        declare_ink(&prelude, path, sizeof path, f, s, inking);
    char *finished = text_take(&prelude);
    gpu_program *p = finished ? gpu_program_of(f->g, "layer/raster.vert", path, finished) : NULL;
    if (!finished)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    mem_free(finished);
    return p;
}

static void set_ink(frame *f, const figure_state *s, const pass *inking)
{
    const technique_use *lines = inked_lines(s->figure->rule);
    uniforms_set(f->g, common_set(KIND_LINES, lines));
    uniforms_set(f->g, own_set(KIND_LINES, lines));
    for (int i = 0; i < PASS_READS_MAX && inking->reads[i]; i++)
        gpu_set_texture(f->g, target_name(inking->reads[i]), s->targets[inking->reads[i]], false);
}

/* Draws the figure's parts (and its complement) into the current pass; with `inking`, lines on top and no complement. */
static void draw_parts(frame *f, const figure_state *s, outputs o, const pass *inking)
{
    const figure *fig = s->figure;
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    int32_t last_material = -2;
    bool last_uvs = false, last_colours = false;
    gpu_program *program = NULL;
    for (size_t i = 0; i < f->up->item_count && !gpu_failed(f->g); i++) {
        const draw_item *item = &f->up->items[i];
        if (!is_drawn(f, fig, item) || (inking && !fig->designated[item->part_index]))
            continue;
        const material *m = material_of(f, item);
        if (!program || item->material != last_material || item->has_uvs != last_uvs || item->has_colours != last_colours) {
            item_textures t = textures_of(f, item, m);
            program = raster_program(f, s, item, m, t, o, inking);
            gpu_use(f->g, program, (gpu_state){.depth_test = true, .depth_write = true});
            if (gpu_failed(f->g))
                return;
            set_common(f, s);
            set_projection(f);
            if (o.shade >= 0)
                uniforms_set(f->g, own_set(KIND_SURFACE, surface));
            if (inking)
                set_ink(f, s, inking);
            if (f->mirror_depth)
                gpu_set_vec4(f->g, "u_clip_plane", f->clip_plane);
            if (s->targets[TARGET_REFLECTION])
                gpu_set_texture(f->g, "t_reflection", s->targets[TARGET_REFLECTION], false);
            set_material(f->g, m, t);
            last_material = item->material;
            last_uvs = item->has_uvs;
            last_colours = item->has_colours;
        }
        set_transform(f, &item->world);
        gpu_set_uint(f->g, "u_part_id", item->part_id);
        bool other = !fig->designated[item->part_index];
        gpu_set_uint(f->g, "u_surface_id", item->surface_id | (other ? 0x80000000u : 0));
        gpu_draw_mesh(f->g, item->mesh);
    }
}

static gpu_texture *acquire(frame *f, target t)
{
    static const gpu_format formats[TARGET_COUNT] = {
        [TARGET_NORMAL_DEPTH] = GPU_RGBA32F, [TARGET_ID] = GPU_RG32UI,     [TARGET_ALBEDO] = GPU_RGBA16F,
        [TARGET_SHADE] = GPU_RGBA16F,        [TARGET_DEPTH] = GPU_DEPTH32F, [TARGET_EDGE] = GPU_RGBA16F,
        [TARGET_GROUND] = GPU_RGBA16F,       [TARGET_REFLECTION] = GPU_RGBA16F, [TARGET_PAGE] = GPU_RGBA16F,
    };
    return gpu_target_acquire(f->g, f->width, f->height, formats[t]);
}

/* Adds a channel to the geometry pass; background is depth "far", normal to the viewer, id 0, and no colour. */
static int add_output(frame *f, figure_state *s, gpu_pass *pass, target t, const float clear[4])
{
    s->targets[t] = acquire(f, t);
    memcpy(pass->clear_values[pass->colour_count], clear, 4 * sizeof(float));
    pass->colours[pass->colour_count] = s->targets[t];
    return pass->colour_count++;
}

static void draw_geometry(frame *f, figure_state *s)
{
    const figure *fig = s->figure;
    stopwatch w = watch_start(f);
    gpu_pass pass = {.clear = true};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    outputs o = {-1, -1, -1, -1};
    if (fig->channels & CHANNEL_NORMAL_DEPTH)
        o.normal_depth = add_output(f, s, &pass, TARGET_NORMAL_DEPTH, (float[]){0, 0, 1, (float)s->far});
    if (fig->channels & CHANNEL_ID)
        o.id = add_output(f, s, &pass, TARGET_ID, (float[]){0, 0, 0, 0});
    if (fig->channels & CHANNEL_ALBEDO)
        o.albedo = add_output(f, s, &pass, TARGET_ALBEDO, (float[]){1, 1, 1, 0});
    if (!fig->deferred)
        o.shade = add_output(f, s, &pass, TARGET_SHADE, (float[]){0, 0, 0, 0});
    pass.depth = s->targets[TARGET_DEPTH] = acquire(f, TARGET_DEPTH);
    if (!gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &pass);
        draw_parts(f, s, o, NULL);
    }
    watch_stop(f, w, "", "geometry");
}

static void shade_deferred(frame *f, figure_state *s)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    stopwatch w = watch_start(f);
    text prelude = {0};
    declare_lights(&prelude, f);
    uniforms_declare(&prelude, own_set(KIND_SURFACE, surface));
    char path[160], *finished = text_take(&prelude);
    snprintf(path, sizeof path, "%s+layer/deferred.frag", surface->technique->surface);
    s->targets[TARGET_SHADE] = acquire(f, TARGET_SHADE);
    gpu_program *p = finished ? gpu_program_of(f->g, "gpu/screen.vert", path, finished) : NULL;
    mem_free(finished);
    if (p && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {s->targets[TARGET_SHADE]}, .colour_count = 1, .clear = true});
        gpu_use(f->g, p, (gpu_state){0});
        set_common(f, s);
        uniforms_set(f->g, own_set(KIND_SURFACE, surface));
        gpu_set_texture(f->g, "t_normal_depth", s->targets[TARGET_NORMAL_DEPTH], false);
        gpu_set_texture(f->g, "t_id", s->targets[TARGET_ID], false);
        gpu_set_texture(f->g, "t_albedo", s->targets[TARGET_ALBEDO], false);
        gpu_draw_screen(f->g);
    }
    watch_stop(f, w, "", "deferred shading");
}

/* --- declared passes --------------------------------------------------------------------------------------------- */

static gpu_texture *target_of(const frame *f, const figure_state *s, target t)
{
    return t == TARGET_PAGE ? f->page : s->targets[t];
}

typedef struct pass_params {
    param_set sets[3];
    size_t    count;
} pass_params;

static gpu_program *pass_program(frame *f, const figure_state *s, const pass *p, const pass_params *params)
{
    text prelude = {0};
    for (size_t i = 0; i < params->count; i++)
        uniforms_declare(&prelude, params->sets[i]);
    for (int i = 0; i < PASS_READS_MAX && p->reads[i]; i++)
        if (target_of(f, s, p->reads[i]))
            target_declare(&prelude, p->reads[i]);
    if (s->targets[TARGET_EDGE])
        text_append(&prelude, "#define HAS_LINES\n");
    if (s->targets[TARGET_ID])
        text_append(&prelude, "#define HAS_ID\n");
    if (s->figure->complement)
        text_append(&prelude, "#define HAS_COMPLEMENT\n");
    char *finished = text_take(&prelude);
    gpu_program *program = finished ? gpu_program_of(f->g, "gpu/screen.vert", p->shader, finished) : NULL;
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

/* The seed's third pass: the parts once more, with the edge map projected on them. */
static void run_geometry_pass(frame *f, figure_state *s, const pass *p, const char *group)
{
    stopwatch w = watch_start(f);
    gpu_pass onto = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
    memcpy(onto.scissor, s->pixels, sizeof onto.scissor);
    gpu_pass_begin(f->g, &onto);
    draw_parts(f, s, (outputs){-1, -1, -1, 0}, inked_lines(s->figure->rule) ? p : NULL);
    watch_stop(f, w, group, p->name);
}

static void run_pass(frame *f, figure_state *s, const pass *p, const pass_params *params, const char *group, int iteration)
{
    stopwatch w = watch_start(f);
    gpu_program *program = pass_program(f, s, p, params);
    bool page = p->writes == TARGET_PAGE;
    gpu_texture *written = page ? f->page : acquire(f, p->writes);
    if (program && written && !gpu_failed(f->g)) {
        gpu_pass target = {.colours = {written}, .colour_count = 1, .depth = p->depth ? f->page_depth : NULL,
                           .clear = !page, .keep_depth = true};
        memcpy(target.clear_values[0], neutral(p->writes), 4 * sizeof(float));
        memcpy(target.scissor, s->pixels, sizeof target.scissor);
        gpu_pass_begin(f->g, &target);
        gpu_use(f->g, program, (gpu_state){.depth_test = p->depth, .depth_write = p->depth,
                                           .blend = p->blend == BLEND_OVER ? GPU_BLEND_OVER
                                                    : p->blend == BLEND_MIN ? GPU_BLEND_MIN : GPU_BLEND_NONE});
        set_common(f, s);
        gpu_set_int(f->g, "u_iteration", iteration);
        for (size_t i = 0; i < params->count; i++)
            uniforms_set(f->g, params->sets[i]);
        for (int i = 0; i < PASS_READS_MAX && p->reads[i]; i++) {
            /* 16-bit float pictures may be filtered; whoever wants whole texels fetches them. */
            bool linear = p->reads[i] == TARGET_SHADE || p->reads[i] == TARGET_EDGE;
            gpu_set_texture(f->g, target_name(p->reads[i]), target_of(f, s, p->reads[i]), linear);
        }
        gpu_draw_screen(f->g);
    }
    if (!page) {
        if (s->targets[p->writes] != s->geometry)
            gpu_target_release(f->g, s->targets[p->writes]);
        s->targets[p->writes] = written;
    }
    watch_stop(f, w, group, p->name);
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

static void run_use(frame *f, figure_state *s, kind_id id, const technique_use *use)
{
    const technique *t = use->technique;
    pass_params params = {.sets = {own_set(id, use), common_set(id, use)}, .count = 2};
    /* A composition inks the lines as well, with the parameters that all line techniques share. */
    const technique_use *lines = inked_lines(s->figure->rule);
    if (id == KIND_COMPOSE && lines)
        params.sets[params.count++] = common_set(KIND_LINES, lines);
    for (size_t i = 0; i < t->pass_count; i++) {
        const pass *p = &t->passes[i];
        if (!pass_applies(id, p, use))
            continue;
        if (p->geometry)
            run_geometry_pass(f, s, p, kinds[id]->name);
        else
            for (int k = 0; k < (p->repeat > 1 ? p->repeat : 1); k++)
                run_pass(f, s, p, &params, kinds[id]->name, k);
    }
}

static void collect_edges(frame *f, figure_state *s);

static void run_kind(frame *f, figure_state *s, kind_id id)
{
    const rule *r = s->figure->rule;
    const kind *k = kinds[id];
    const technique_use *compose = rule_use(r, KIND_COMPOSE), *lines = inked_lines(r);
    if (id == KIND_LINES && lines && compose && compose->technique->merges && lines->technique->detect && !f->maps)
        return; /* the composition detects the edges itself */
    for (size_t i = 0; i < r->use_counts[id]; i++) {
        const technique_use *use = &r->uses[id][i];
        run_use(f, s, id, use);
        if (f->maps && id == KIND_LINES) {
            collect_edges(f, s);
        } else if (k->fold && i + 1 < r->use_counts[id]) {
            pass_params params = {.sets = {common_set(id, use)}, .count = 1};
            run_pass(f, s, k->fold, &params, k->name, 0);
        }
        if (s->targets[TARGET_NORMAL_DEPTH] != s->geometry) {
            gpu_target_release(f->g, s->targets[TARGET_NORMAL_DEPTH]);
            s->targets[TARGET_NORMAL_DEPTH] = s->geometry;
        }
    }
}

/* --- figures ------------------------------------------------------------------------------------------------------- */

static void collect_maps(frame *f, figure_state *s);

static void release_targets(frame *f, figure_state *s)
{
    for (int i = 0; i < TARGET_COUNT; i++)
        if (i != TARGET_REFLECTION)
            gpu_target_release(f->g, s->targets[i]);
}

static int reach_of(const figure *fig)
{
    const rule *r = fig->rule;
    float widest = 0;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const kind *k = kinds[KIND_LINES];
        for (size_t p = 0; p < k->common_count; p++)
            if (k->common[p].unit == UNIT_PX && k->common[p].type == PARAM_FLOAT)
                widest += fabsf(*(const float *)param_field(&k->common[p], r->uses[KIND_LINES][i].values));
    }
    return (int)ceilf(widest) + 2;
}

static void draw_direct(frame *f, figure_state *s)
{
    stopwatch w = watch_start(f);
    gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_pass_begin(f->g, &pass);
    draw_parts(f, s, (outputs){-1, -1, -1, 0}, NULL);
    watch_stop(f, w, "", "geometry");
}

static void draw_reflection(frame *f, figure_state *s);

static void draw_figure(frame *f, const figure *fig)
{
    figure_state s = {.figure = fig, .near = f->camera.near, .far = f->camera.far};
    double nearest = INFINITY, farthest = -INFINITY;
    box3 box = fig->complement ? f->plan->box : fig->box;
    camera_depth_range(&f->camera, box, &nearest, &farthest);
    double margin = fmax((farthest - nearest) * 1e-3, farthest * 1e-6);
    s.near = fmax(nearest - margin, f->camera.near);
    s.far = fmin(farthest + margin, f->camera.far);
    if (!(s.far > s.near))
        s.far = s.near + 1;
    camera_pixels(&f->camera, fig->box, f->width, f->height, reach_of(fig), s.pixels);
    if (s.pixels[2] <= 0 || s.pixels[3] <= 0 || gpu_failed(f->g))
        return;
    if (fig->reflects && !f->mirror_depth)
        draw_reflection(f, &s);
    if (fig->direct && !f->maps) {
        draw_direct(f, &s);
    } else {
        draw_geometry(f, &s);
        s.geometry = s.targets[TARGET_NORMAL_DEPTH];
        if (fig->deferred)
            shade_deferred(f, &s);
        for (int k = KIND_LAYERS; k < KIND_FINISH; k++)
            if (k != KIND_COMPOSE || !f->maps)
                run_kind(f, &s, (kind_id)k);
        if (f->maps)
            collect_maps(f, &s);
        mem_free(s.edges);
    }
    release_targets(f, &s);
}

static void clear_page(frame *f)
{
    gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth, .clear = true};
    uniforms_linear(f->ground, pass.clear_values[0]);
    for (int k = 0; k < 3; k++)
        pass.clear_values[0][k] *= f->ground.a;
    gpu_pass_begin(f->g, &pass);
}

static void draw_figures(frame *f)
{
    for (size_t i = 0; i < f->plan->figure_count; i++)
        if (&f->plan->figures[i] != f->mirror)
            draw_figure(f, &f->plan->figures[i]);
}

/* --- mirrors: seed 000, section 4.6; row E14 -------------------------------------------------------------------- */

/* The plane of a figure's parts in eye space: area-weighted normal through the centre. False when there is no area. */
static bool mirror_plane(const frame *f, const figure *fig, double plane[4])
{
    double normal[3] = {0, 0, 0}, centre[3] = {0, 0, 0}, area = 0;
    for (size_t i = 0; i < f->up->item_count; i++) {
        const draw_item *item = &f->up->items[i];
        if (!fig->designated[item->part_index])
            continue;
        const node *n = &f->plan->scene->nodes[f->plan->scene->parts[item->part_index].node];
        const primitive *p = &f->plan->scene->meshes[n->mesh].primitives[item->surface_id - 1];
        mat4 eye = mat4_multiply(&f->camera.view, &item->world);
        for (uint32_t t = 0; t + 2 < p->index_count; t += 3) {
            vec3 v[3];
            for (int k = 0; k < 3; k++)
                v[k] = mat4_transform_point(&eye, p->positions[p->indices[t + (uint32_t)k]]);
            double a[3] = {v[1].x - v[0].x, v[1].y - v[0].y, v[1].z - v[0].z}, b[3] = {v[2].x - v[0].x, v[2].y - v[0].y, v[2].z - v[0].z};
            double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
            double size = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
            double sum[3] = {(double)v[0].x + v[1].x + v[2].x, (double)v[0].y + v[1].y + v[2].y, (double)v[0].z + v[1].z + v[2].z};
            for (int k = 0; k < 3; k++) {
                normal[k] += c[k];
                centre[k] += size * sum[k] / 3;
            }
            area += size;
        }
    }
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    if (!(length > 0) || !(area > 0))
        return false;
    plane[3] = 0;
    for (int k = 0; k < 3; k++) {
        plane[k] = normal[k] / length;
        plane[3] -= plane[k] * centre[k] / area;
    }
    return true;
}

/* Draws everything but the mirror as its plane shows it, with lines of its own, into a picture of the page's size. */
static void draw_reflection(frame *f, figure_state *s)
{
    double p[4];
    if (!mirror_plane(f, s->figure, p))
        return;
    /* The viewer is on one side of the plane; only what is on his side is reflected. */
    double side = f->camera.orthographic ? p[2] : p[3];
    if (side < 0)
        for (int k = 0; k < 4; k++)
            p[k] = -p[k];
    mat4 reflect = mat4_identity();
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            reflect.m[4 * column + row] -= 2 * p[column] * p[row];
    for (int row = 0; row < 3; row++)
        reflect.m[12 + row] = -2 * p[3] * p[row];
    frame inner = *f;
    inner.camera.view = mat4_multiply(&reflect, &f->camera.view);
    inner.mirror = s->figure;
    inner.mirror_depth = f->mirror_depth + 1;
    inner.maps = NULL;
    inner.profile = false;
    inner.ground = (colour){0, 0, 0, 0};
    inner.page = acquire(f, TARGET_PAGE);
    inner.page_depth = acquire(f, TARGET_DEPTH);
    /* Reflected eye space lies beyond the plane, where dot(p, eye) + p.w is negative. */
    for (int k = 0; k < 4; k++)
        inner.clip_plane[k] = (float)-p[k];
    double nearest = INFINITY, farthest = -INFINITY;
    camera_depth_range(&inner.camera, f->plan->box, &nearest, &farthest);
    camera_set_range(&inner.camera, fmax(nearest, f->camera.orthographic ? nearest : 0), farthest);
    stopwatch w = watch_start(f);
    if (!gpu_failed(f->g)) {
        clear_page(&inner);
        draw_figures(&inner);
    }
    watch_stop(f, w, "surface", "reflection");
    gpu_target_release(f->g, inner.page_depth);
    s->targets[TARGET_REFLECTION] = inner.page;
}

/* --- the whole ----------------------------------------------------------------------------------------------------- */

static void encode(frame *f, gpu_texture *out)
{
    stopwatch w = watch_start(f);
    gpu_program *p = gpu_program_of(f->g, "gpu/screen.vert", "finish/encode.frag", "");
    if (p && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {out}, .colour_count = 1});
        gpu_use(f->g, p, (gpu_state){0});
        gpu_set_texture(f->g, "t_page", f->page, false);
        gpu_set_int(f->g, "u_samples", f->samples);
        gpu_draw_screen(f->g);
    }
    watch_stop(f, w, "", "encode");
}

void frame_draw(frame *f, gpu_texture *out)
{
    f->page = acquire(f, TARGET_PAGE);
    f->page_depth = acquire(f, TARGET_DEPTH);
    if (!gpu_failed(f->g)) {
        clear_page(f);
        draw_figures(f);
        if (out)
            encode(f, out);
    }
    gpu_target_release(f->g, f->page);
    gpu_target_release(f->g, f->page_depth);
}

/* --- maps ---------------------------------------------------------------------------------------------------------- */

lmn_status frame_maps_create(frame_maps *m, int width, int height, lmn_error *error)
{
    size_t count = (size_t)width * (size_t)height;
    *m = (frame_maps){.width = width, .height = height};
    m->depth = mem_alloc(count * sizeof(float));
    m->normal = mem_calloc(count, 3 * sizeof(float));
    m->id = mem_calloc(count, sizeof(uint32_t));
    m->edge = mem_alloc(count * 4 * sizeof(float));
    m->shade = mem_calloc(count, 4 * sizeof(float));
    if (!m->depth || !m->normal || !m->id || !m->edge || !m->shade) {
        frame_maps_release(m);
        return error_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        m->depth[i] = INFINITY;
    for (size_t i = 0; i < count * 4; i++)
        m->edge[i] = 1;
    return LMN_OK;
}

void frame_maps_release(frame_maps *m)
{
    mem_free(m->depth);
    mem_free(m->normal);
    mem_free(m->id);
    mem_free(m->edge);
    mem_free(m->shade);
    memset(m, 0, sizeof *m);
}

/* Takes a figure's pixels where they are the nearest so far; ink outside its boundary darkens what is empty. */
static void merge_maps(frame_maps *m, const float *normal_depth, const uint32_t *id, const float *edge, const float *shade)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    for (size_t i = 0; i < count; i++) {
        bool own = id[2 * i] != 0 && !(id[2 * i + 1] & 0x80000000u);
        bool nearer = own && normal_depth[4 * i + 3] <= m->depth[i];
        if (nearer) {
            m->depth[i] = normal_depth[4 * i + 3];
            m->id[i] = id[2 * i];
            memcpy(&m->normal[3 * i], &normal_depth[4 * i], 3 * sizeof(float));
            memcpy(&m->shade[4 * i], &shade[4 * i], 4 * sizeof(float));
            memcpy(&m->edge[4 * i], &edge[4 * i], 4 * sizeof(float));
        } else if (!own && m->id[i] == 0) {
            for (int k = 0; k < 4; k++)
                m->edge[4 * i + (size_t)k] = fminf(m->edge[4 * i + (size_t)k], edge[4 * i + (size_t)k]);
        }
    }
}

/* Keeps the darkest of the edge maps of a figure with several line techniques. */
static void collect_edges(frame *f, figure_state *s)
{
    size_t count = (size_t)f->width * (size_t)f->height * 4;
    float *edge = mem_alloc(count * sizeof(float));
    if (!edge) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    gpu_read(f->g, s->targets[TARGET_EDGE], edge);
    if (!s->edges) {
        s->edges = edge;
        return;
    }
    for (size_t i = 0; i < count; i++)
        s->edges[i] = fminf(s->edges[i], edge[i]);
    mem_free(edge);
}

static void collect_maps(frame *f, figure_state *s)
{
    size_t count = (size_t)f->width * (size_t)f->height;
    float *normal_depth = mem_alloc(count * 16), *shade = mem_alloc(count * 16);
    uint32_t *id = mem_alloc(count * 8);
    if (!s->edges && (s->edges = mem_alloc(count * 16)))
        for (size_t i = 0; i < count * 4; i++)
            s->edges[i] = 1;
    if (normal_depth && s->edges && shade && id) {
        gpu_read(f->g, s->targets[TARGET_NORMAL_DEPTH], normal_depth);
        gpu_read(f->g, s->targets[TARGET_ID], id);
        gpu_read(f->g, s->targets[TARGET_SHADE], shade);
        if (!gpu_failed(f->g))
            merge_maps(f->maps, normal_depth, id, s->edges, shade);
    } else {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    }
    mem_free(normal_depth);
    mem_free(shade);
    mem_free(id);
}
