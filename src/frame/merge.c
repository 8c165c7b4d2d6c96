/* Maps on the GPU: a figure's pictures over what the figures before have left, pixel by pixel. */
#include "frame/merge.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* What every picture has, in the order of the shader's outputs; velocity only where something was drawn at a time. */
enum { MERGED = LMN_MAP_SHADE + 1 };

static gpu_format format_of(lmn_map map)
{
    static const gpu_format formats[FRAME_MAPS] = {
        [LMN_MAP_DEPTH] = GPU_R32F,       [LMN_MAP_NORMAL] = GPU_RGBA32F,   [LMN_MAP_ID] = GPU_R32UI,
        [LMN_MAP_EDGE] = GPU_RGBA16F,     [LMN_MAP_SHADE] = GPU_RGBA16F,    [LMN_MAP_UNCERTAINTY] = GPU_RGBA32F,
        [LMN_MAP_VELOCITY] = GPU_RGBA32F, [LMN_MAP_DIRECTION] = GPU_RGBA16F};
    return formats[map];
}

/* A picture of one value. */
static gpu_texture *filled(gpu *g, int width, int height, gpu_format format, float value)
{
    gpu_texture *out = gpu_target_acquire(g, width, height, format);
    if (out)
        gpu_pass_begin(
            g, &(gpu_pass){
                   .colours = {out}, .colour_count = 1, .clear = true, .clear_values = {{value, value, value, value}}});
    return out;
}

static gpu_texture *map_of(frame *f, lmn_map map)
{
    frame_maps *m = f->maps;
    if (!m->textures[map])
        m->textures[map] = filled(f->g, f->width, f->height, format_of(map), 0);
    return m->textures[map];
}

void frame_maps_open(frame_maps *m, gpu *g, int width, int height)
{
    *m = (frame_maps){.width = width, .height = height, .whole = true, .on_gpu = true};
    for (int i = 0; i < MERGED; i++)
        m->textures[i] = filled(g, width, height, format_of((lmn_map)i),
                                i == LMN_MAP_DEPTH  ? INFINITY
                                : i == LMN_MAP_EDGE ? 1
                                                    : 0);
}

void frame_maps_release_textures(frame_maps *m, gpu *g)
{
    for (int i = 0; i < FRAME_MAPS; i++)
        gpu_target_release(g, m->textures[i]);
    gpu_target_release(g, m->edges);
    memset(m->textures, 0, sizeof m->textures);
    m->edges = NULL;
}

/* Of a texture's texels the first numbers; NULL when memory is gone. */
static void *read_map(gpu *g, gpu_texture *t, size_t components)
{
    size_t texels = (size_t)gpu_texture_width(t) * (size_t)gpu_texture_height(t), wide = components == 1 ? 1 : 4;
    float *all = mem_alloc(texels * wide * sizeof *all), *out = mem_alloc(texels * components * sizeof *out);
    if (all && out) {
        gpu_read(g, t, all);
        for (size_t i = 0; i < texels; i++)
            memcpy(&out[i * components], &all[i * wide], components * sizeof *out);
    } else {
        mem_free(out);
        out = NULL;
    }
    mem_free(all);
    return out;
}

bool frame_maps_read(const frame_maps *m, gpu *g, frame_maps *out)
{
    *out = (frame_maps){.width = m->width, .height = m->height, .whole = true};
    void **const into[FRAME_MAPS] = {[LMN_MAP_DEPTH] = (void **)&out->depth,
                                     [LMN_MAP_NORMAL] = (void **)&out->normal,
                                     [LMN_MAP_ID] = (void **)&out->id,
                                     [LMN_MAP_EDGE] = (void **)&out->edge,
                                     [LMN_MAP_SHADE] = (void **)&out->shade,
                                     [LMN_MAP_UNCERTAINTY] = (void **)&out->uncertainty,
                                     [LMN_MAP_VELOCITY] = (void **)&out->velocity,
                                     [LMN_MAP_DIRECTION] = (void **)&out->direction};
    for (int i = 0; i < FRAME_MAPS; i++)
        if (m->textures[i] && !(*into[i] = read_map(g, m->textures[i], (size_t)lmn_map_components((lmn_map)i)))) {
            frame_maps_release(out);
            return false;
        }
    return true;
}

/* Begins a pass with a program; false after an error. */
static bool begin(frame *f, const char *shader, text *prelude, const gpu_pass *pass, gpu_blend blend)
{
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", shader, prelude);
    if (!p || gpu_failed(f->g))
        return false;
    gpu_pass_begin(f->g, pass);
    gpu_use(f->g, p, (gpu_state){.blend = blend});
    return true;
}

void merge_edges(frame *f, const figure_state *s)
{
    frame_maps *m = f->maps;
    text        prelude = {0};
    if (!m->edges)
        m->edges = filled(f->g, f->width, f->height, GPU_RGBA16F, 1);
    if (!begin(f, "frame/merge_edge.frag", &prelude, &(gpu_pass){.colours = {m->edges}, .colour_count = 1},
               GPU_BLEND_MIN))
        return;
    gpu_set_texture(f->g, "t_edge", s->targets[TARGET_EDGE], false);
    gpu_draw_screen(f->g);
}

void merge_layer_edges_end(frame *f)
{
    gpu_target_release(f->g, f->maps->edges);
    f->maps->edges = NULL;
}

static void declare(text *prelude, const frame_maps *m, const figure_state *s)
{
    if (m->edges)
        text_append(prelude, "#define HAS_EDGES\n");
    if (m->textures[LMN_MAP_VELOCITY])
        text_append(prelude, "#define HAS_VELOCITY\n");
    if (s->targets[TARGET_VELOCITY])
        text_append(prelude, "#define HAS_OWN_VELOCITY\n");
    if (s->shared)
        text_append(prelude, "#define SHARED\n");
}

static void set_pictures(gpu *g, const frame_maps *m, const figure_state *s)
{
    static const char *const names[FRAME_MAPS] = {
        [LMN_MAP_DEPTH] = "t_depth", [LMN_MAP_NORMAL] = "t_normal", [LMN_MAP_ID] = "t_id",
        [LMN_MAP_EDGE] = "t_edge",   [LMN_MAP_SHADE] = "t_shade",   [LMN_MAP_VELOCITY] = "t_velocity"};
    for (int i = 0; i < FRAME_MAPS; i++)
        if (names[i])
            gpu_set_texture(g, names[i], m->textures[i], false);
    gpu_set_texture(g, "t_own_normal_depth", s->targets[TARGET_NORMAL_DEPTH], false);
    gpu_set_texture(g, "t_own_id", s->targets[TARGET_ID], false);
    gpu_set_texture(g, "t_own_shade", s->targets[TARGET_SHADE], false);
    gpu_set_texture(g, "t_own_edge", m->edges, false);
    gpu_set_texture(g, "t_own_velocity", s->targets[TARGET_VELOCITY], false);
    gpu_set_int(g, "u_index", s->index);
}

/* A pass cannot write what it reads: it writes other pictures, which take the place of those before. */
void merge_figure(frame *f, const figure_state *s)
{
    frame_maps *m = f->maps;
    text        prelude = {0};
    if (s->targets[TARGET_VELOCITY])
        map_of(f, LMN_MAP_VELOCITY);
    int          count = m->textures[LMN_MAP_VELOCITY] ? MERGED + 1 : MERGED;
    gpu_texture *next[GPU_COLOURS_MAX] = {NULL};
    gpu_pass     pass = {.colour_count = count};
    for (int i = 0; i < count; i++)
        pass.colours[i] = next[i] =
            gpu_target_acquire(f->g, f->width, f->height, format_of(i < MERGED ? (lmn_map)i : LMN_MAP_VELOCITY));
    declare(&prelude, m, s);
    if (begin(f, "frame/merge.frag", &prelude, &pass, GPU_BLEND_NONE)) {
        set_pictures(f->g, m, s);
        gpu_draw_screen(f->g);
    }
    for (int i = 0; i < count; i++) {
        gpu_texture **map = &m->textures[i < MERGED ? i : LMN_MAP_VELOCITY];
        gpu_target_release(f->g, *map);
        *map = next[i];
    }
    merge_layer_edges_end(f);
}

void merge_uncertainty(frame *f, const figure_state *s)
{
    gpu_texture *before = map_of(f, LMN_MAP_UNCERTAINTY);
    gpu_texture *next = gpu_target_acquire(f->g, f->width, f->height, format_of(LMN_MAP_UNCERTAINTY));
    text         prelude = {0};
    if (begin(f, "frame/merge_field.frag", &prelude, &(gpu_pass){.colours = {next}, .colour_count = 1},
              GPU_BLEND_NONE)) {
        gpu_set_texture(f->g, "t_before", before, false);
        gpu_set_texture(f->g, "t_field", s->targets[TARGET_FIELD], false);
        gpu_draw_screen(f->g);
    }
    gpu_target_release(f->g, before);
    f->maps->textures[LMN_MAP_UNCERTAINTY] = next;
}

void merge_direction(frame *f, const figure_state *s)
{
    text prelude = {0};
    if (!begin(f, "frame/merge_direction.frag", &prelude,
               &(gpu_pass){.colours = {map_of(f, LMN_MAP_DIRECTION)}, .colour_count = 1}, GPU_BLEND_NONE))
        return;
    gpu_set_texture(f->g, "t_direction", s->targets[TARGET_DIRECTION], false);
    gpu_draw_screen(f->g);
}
