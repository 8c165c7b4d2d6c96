/* The geometry pass: a figure's parts into its G-buffer or onto the page. */
#include "draw/frame_private.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
    else
        text_append(prelude, "#define DEFERRED\n");
}

/* Adds what a geometry pass with ink needs: the lines' parameters, the maps that the pass reads, and their files. */
static void declare_ink(text *prelude, char *path, size_t size, const frame *f, const figure_state *s, const pass *inking)
{
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    const pass *merged = rule_merged_detection(s->figure->rule);
    uniforms_declare(prelude, use_common_set(KIND_LINES, lines));
    text_append(prelude, "#define INKED\n%s", merged ? "#define MERGED\n" : "");
    if (merged)
        uniforms_declare(prelude, use_own_set(KIND_LINES, lines));
    reads_declare(prelude, f, s, inking, merged);
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
    if (f->mirror)
        text_append(&prelude, "#define CLIPPED\n");
    char path[320] = "layer/raster.frag";
    if (o.shade >= 0) {
        lights_declare(&prelude, f);
        uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
        snprintf(path, sizeof path, "%s+layer/raster.frag", surface->technique->surface);
    }
    if (inking)
        declare_ink(&prelude, path, sizeof path, f, s, inking);
    return program_of(f, "layer/raster.vert", path, &prelude);
}

static void set_ink(frame *f, const figure_state *s, const pass *inking)
{
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    uniforms_set(f->g, use_common_set(KIND_LINES, lines));
    uniforms_set(f->g, use_own_set(KIND_LINES, lines));
    reads_set(f, s, inking, rule_merged_detection(s->figure->rule));
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
            frame_set_common(f, s);
            set_projection(f);
            if (o.shade >= 0)
                uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
            if (inking)
                set_ink(f, s, inking);
            if (f->mirror)
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

/* Adds a channel to the geometry pass; background is depth "far", normal to the viewer, id 0, and no colour. */
static int add_output(frame *f, figure_state *s, gpu_pass *pass, target t, const float clear[4])
{
    s->targets[t] = frame_acquire(f, t);
    memcpy(pass->clear_values[pass->colour_count], clear, 4 * sizeof(float));
    pass->colours[pass->colour_count] = s->targets[t];
    return pass->colour_count++;
}

void raster_figure(frame *f, figure_state *s)
{
    const figure *fig = s->figure;
    stopwatch w = watch_start(f);
    gpu_pass pass = {.clear = true};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
    outputs o = {-1, -1, -1, -1};
    if (fig->channels & CHANNEL_NORMAL_DEPTH)
        o.normal_depth = add_output(f, s, &pass, TARGET_NORMAL_DEPTH, (float[]){0, 0, 1, (float)s->far});
    if (fig->channels & CHANNEL_ID)
        o.id = add_output(f, s, &pass, TARGET_ID, (float[]){0, 0, 0, 0});
    if (fig->channels & CHANNEL_ALBEDO)
        o.albedo = add_output(f, s, &pass, TARGET_ALBEDO, (float[]){1, 1, 1, 0});
    if (!fig->deferred)
        o.shade = add_output(f, s, &pass, TARGET_SHADE, (float[]){0, 0, 0, 0});
    pass.depth = s->targets[TARGET_DEPTH] = frame_acquire(f, TARGET_DEPTH);
    if (!gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &pass);
        draw_parts(f, s, o, NULL);
    }
    watch_stop(f, w, "", "geometry");
}

void raster_shade_deferred(frame *f, figure_state *s)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    stopwatch w = watch_start(f);
    text prelude = {0};
    lights_declare(&prelude, f);
    uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
    char path[160];
    snprintf(path, sizeof path, "%s+layer/deferred.frag", surface->technique->surface);
    s->targets[TARGET_SHADE] = frame_acquire(f, TARGET_SHADE);
    gpu_program *p = program_of(f, "gpu/screen.vert", path, &prelude);
    if (p && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {s->targets[TARGET_SHADE]}, .colour_count = 1, .clear = true});
        gpu_use(f->g, p, (gpu_state){0});
        frame_set_common(f, s);
        uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
        gpu_set_texture(f->g, "t_normal_depth", s->targets[TARGET_NORMAL_DEPTH], false);
        gpu_set_texture(f->g, "t_id", s->targets[TARGET_ID], false);
        gpu_set_texture(f->g, "t_albedo", s->targets[TARGET_ALBEDO], false);
        gpu_draw_screen(f->g);
    }
    watch_stop(f, w, "", "deferred shading");
}

void raster_direct(frame *f, figure_state *s)
{
    stopwatch w = watch_start(f);
    gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_pass_begin(f->g, &pass);
    draw_parts(f, s, (outputs){-1, -1, -1, 0}, NULL);
    watch_stop(f, w, "", "geometry");
}

/* The seed's third pass: the parts once more, with the edge map projected on them. */
void raster_inked(frame *f, figure_state *s, const pass *inking)
{
    gpu_pass onto = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
    memcpy(onto.scissor, s->pixels, sizeof onto.scissor);
    gpu_pass_begin(f->g, &onto);
    draw_parts(f, s, (outputs){-1, -1, -1, 0}, rule_inked_lines(s->figure->rule) ? inking : NULL);
}
