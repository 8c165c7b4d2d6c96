/* The shadow that the first light throws on the ground: where it is hard, made as a picture first, so that its border
 * can be calmed and scraps be left out; and fading with height, where a map says how high it is what throws it. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "light/appendages.h"
#include "light/contour.h"
#include "light/light.h"
#include "light/scraps.h"
#include "light/spread.h"

static const double CONTACT = 0.02; /* of the model's size: what is so near the ground throws no scraps */

static const scene_values *values_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

/* Where the shadow that the first light throws can lie: from the model to where its top's shadow falls. */
static bool find_cast(const frame *f, double world[3], box3 *out)
{
    const ground_plane *ground = &f->ground_plane;
    double              towards[3];
    if (!f->shadow || !lights_first_direction(f, towards))
        return false;
    for (int k = 0; k < 3; k++)
        world[k] = f->camera.view.m[4 * k] * towards[0] + f->camera.view.m[4 * k + 1] * towards[1] +
                   f->camera.view.m[4 * k + 2] * towards[2];
    if (!(world[ground->up] > 1e-3))
        return false;
    float  low[3] = {0}, high[3] = {0};
    double half = (double)values_of(f)->shadow_softness * (3.14159265358979 / 360);
    for (int axis = 0; axis < 3; axis++) {
        double range[2], upward[2];
        ground_range(ground->box, axis, range);
        ground_range(ground->box, ground->up, upward);
        double soft = tan(half) * (upward[1] - ground->level) / (world[ground->up] * world[ground->up]),
               off = -world[axis] / world[ground->up] * (upward[1] - ground->level);
        bool level = axis != ground->up;
        low[axis] = (float)(level ? range[0] + fmin(off, 0) - soft : ground->level);
        high[axis] = (float)(level ? range[1] + fmax(off, 0) + soft : ground->level);
    }
    *out = (box3){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    return true;
}

/* As it falls: how much of each pixel of the ground lies in it, and whether what throws it is near. */
static void draw_dark(frame *f, const figure_state *s, gpu_texture *into)
{
    text   prelude = {0};
    double plane[4];
    target_declare(&prelude, &target_rows[TARGET_SHADOW]);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_dark.frag", &prelude);
    gpu_pass     pass = {.colours = {into}, .colour_count = 1, .clear = true};
    if (!p || gpu_failed(f->g))
        return;
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){0});
    frame_set_common(f, s);
    ground_plane_set(f, plane);
    gpu_set_float(f->g, "u_contact", (float)(CONTACT * f->ground_plane.size));
    gpu_draw_screen(f->g);
}

/* Leaves out what is too small to be told, and calms the border; the third number becomes the shadow with a soft one.
 * False: no memory. */
static bool calm_texels(uint8_t *texels, const calmed_shadow *as)
{
    return scraps_drop(texels, as->width, as->height, as->smoothing) &&
           appendages_cut(texels, as->width, as->height, as->smoothing) &&
           contours_calm(texels, as->width, as->height, as->smoothing) &&
           (!as->softened || coverage_spread(texels, as->width, as->height, as->smoothing));
}

static bool fell_so_before(const calmed_shadow *kept, const calmed_shadow *now)
{
    return kept->fallen && kept->width == now->width && kept->height == now->height &&
           kept->smoothing == now->smoothing && kept->softened == now->softened &&
           memcmp(kept->fallen, now->fallen, 4 * (size_t)now->width * (size_t)now->height) == 0;
}

static void keep_calmed(calmed_shadow *kept, const calmed_shadow *now)
{
    mem_free(kept->fallen);
    mem_free(kept->calmed);
    *kept = *now;
}

/* Tracing takes longer than a frame may: a shadow that fell so in the last one is not traced again. */
static void calm(frame *f, const int box[4], gpu_texture *dark)
{
    const scene_values *v = values_of(f);
    size_t              bytes = 4 * (size_t)box[2] * (size_t)box[3];
    calmed_shadow      *kept = &f->up->ground_shadow;
    calmed_shadow       now = {.fallen = mem_alloc(bytes),
                               .width = box[2],
                               .height = box[3],
                               .smoothing = (double)v->ground_smoothing,
                               .softened = v->ground_fade > 0 && !v->ground_flat && !(v->ground_hatch > 0)};
    if (now.fallen)
        gpu_read_box(f->g, dark, box, now.fallen);
    if (now.fallen && !gpu_failed(f->g) && fell_so_before(kept, &now)) {
        mem_free(now.fallen);
    } else {
        now.calmed = now.fallen && !gpu_failed(f->g) ? mem_copy(now.fallen, bytes) : NULL;
        if (!gpu_failed(f->g) && (!now.calmed || !calm_texels(now.calmed, &now)))
            gpu_fail(f->g, LMN_MEMORY, "out of memory");
        keep_calmed(kept, &now);
    }
    if (!gpu_failed(f->g))
        gpu_target_write(f->g, dark, box, kept->calmed);
    else
        keep_calmed(kept, &(calmed_shadow){.fallen = NULL});
}

/* How much of each pixel of the ground lies in shadow. The caller gives it back. */
static gpu_texture *draw_hard(frame *f, const figure_state *s)
{
    gpu_texture *out = gpu_target_acquire(f->g, f->width, f->height, GPU_RGBA8);
    draw_dark(f, s, out);
    if (values_of(f)->ground_smoothing > 0 && !f->draft && !gpu_failed(f->g))
        calm(f, s->pixels, out);
    return out;
}

/* What light/ground_cast.frag reads. */
typedef struct cast_maps {
    gpu_texture *dark, *height; /* or NULL: it is soft; it is even */
    mat4         from_eye;      /* to the map of heights */
} cast_maps;

static void set_height(frame *f, const cast_maps *maps)
{
    float matrix[16];
    if (!maps->height)
        return;
    for (int k = 0; k < 16; k++)
        matrix[k] = (float)maps->from_eye.m[k];
    gpu_set_mat4(f->g, "u_ground_from_eye", matrix);
    gpu_set_float(f->g, "u_ground_fade", values_of(f)->ground_fade);
    gpu_set_texture(f->g, "t_ground_height", maps->height, true);
}

static void set_cast(frame *f, const cast_maps *maps)
{
    const scene_values *v = values_of(f);
    const colour        c = v->ground_colour;
    double              angle = (double)v->ground_angle * (3.14159265358979323846 / 180), plane[4];
    ground_plane_set(f, plane);
    gpu_set_float(f->g, "u_ground_strength", v->ground_strength);
    gpu_set_float(f->g, "u_ground_edge", v->ground_edge);
    if (maps->dark)
        gpu_set_texture(f->g, "t_ground_dark", maps->dark, false);
    set_height(f, maps);
    if (v->ground_hatch > 0) {
        gpu_set_float(f->g, "u_ground_hatch", v->ground_hatch);
        gpu_set_vec2(f->g, "u_ground_along", (float)cos(angle), (float)sin(angle));
    }
    gpu_set_vec4(f->g, "u_ground_colour", (float[]){c.r, c.g, c.b, c.a});
}

/* Who draws it: no one, so that it is laid as it is; the figure's medium, as something of its own colour over the page;
 * or the medium's strokes, as they draw what the model touches. Hard ones are flat shapes, whose border strokes would
 * fray. */
typedef enum cast_by { CAST_BY_NONE, CAST_BY_MEDIUM, CAST_BY_STROKES } cast_by;

static cast_by drawn_by(const frame *f, const figure *fig)
{
    const scene_values  *v = values_of(f);
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    const surface_row   *row = surface ? surface->technique->surface : NULL;
    if (!row || fig->layered || v->ground_flat || v->ground_hatch > 0)
        return CAST_BY_NONE;
    if (row->casts_on_ground)
        return CAST_BY_MEDIUM;
    return v->shadow_softness > 0 && ground_is_drawn_by(f, fig) ? CAST_BY_STROKES : CAST_BY_NONE;
}

static void draw_cast(frame *f, figure_state *s, const cast_maps *maps, text *prelude, cast_by by)
{
    memcpy(s->around, s->pixels, sizeof s->around);
    if (ground_buffers(f, s, "light/ground_cast.frag", prelude)) {
        set_cast(f, maps);
        if (by == CAST_BY_STROKES) /* their ink is their own */
            gpu_set_vec4(f->g, "u_ground_colour", (float[]){1, 1, 1, 1});
        gpu_draw_screen(f->g);
    }
    if (by == CAST_BY_STROKES) {
        s->geometry = s->targets[TARGET_NORMAL_DEPTH];
        if (!gpu_failed(f->g))
            passes_prepare(f, s);
    }
    ground_shade(f, s, by == CAST_BY_MEDIUM);
}

static void lay_cast(frame *f, figure_state *s, const cast_maps *maps)
{
    const scene_values *v = values_of(f);
    bool                soft = !maps->dark;
    cast_by             by = drawn_by(f, s->figure);
    text                prelude = {0};
    text_append(&prelude, "%s%s%s%s%s%s%s", v->ground_hatch > 0 ? "#define HATCHED\n" : "",
                soft ? "#define SOFT\n" : "", !soft && v->ground_edge > 0 ? "#define EDGED\n" : "",
                maps->height ? "#define FADING\n" : "", v->ground_flat ? "#define FLAT\n" : "",
                by ? "#define SHADED\n" : "", by == CAST_BY_STROKES ? "#define STROKED\n" : "");
    target_declare(&prelude, &target_rows[TARGET_SHADOW]);
    if (by) {
        draw_cast(f, s, maps, &prelude, by);
        return;
    }
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_cast.frag", &prelude);
    gpu_pass     pass = {.colours = {f->page}, .colour_count = 1};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){.blend = GPU_BLEND_OVER});
    frame_set_common(f, s);
    set_cast(f, maps);
    gpu_draw_screen(f->g);
}

void ground_cast(frame *f)
{
    figure       fig = f->plan->figures[0];
    figure_state s = {.figure = &fig, .near = f->camera.near, .far = f->camera.far, .ground = true};
    cast_maps    maps = {0};
    double       towards[3];
    box3         lies;
    if (!find_cast(f, towards, &lies))
        return;
    camera_pixels(&f->camera, lies, f->width, f->height, 2, s.pixels);
    window_clip(f, WINDOW_MARGIN, s.pixels);
    if (s.pixels[2] <= 0 || s.pixels[3] <= 0)
        return;
    stopwatch w = watch_start(&f->profile);
    if (!(values_of(f)->shadow_softness > 0))
        maps.dark = draw_hard(f, &s);
    if (values_of(f)->ground_fade > 0 && !gpu_failed(f->g))
        maps.height = ground_height(f, towards, &lies, values_of(f)->ground_flat, &maps.from_eye);
    lay_cast(f, &s, &maps);
    gpu_target_release(f->g, maps.dark);
    gpu_target_release(f->g, maps.height);
    watch_stop(&f->profile, w, "scene", "shadow on the ground");
}
