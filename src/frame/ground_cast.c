/* The shadow that the first light throws on the ground: where it is hard, made as a picture first, so that its border
 * can be calmed and scraps be left out. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "light/light.h"
#include "light/scraps.h"
#include "surface/form.h"

static const double CONTACT = 0.02; /* of the model's size: what is so near the ground throws no scraps */

static const scene_values *values_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

/* Where the shadow that the first light throws can be seen: from the model to where its top's shadow falls. */
static bool find_cast_pixels(const frame *f, int out[4])
{
    const ground_plane *ground = &f->ground_plane;
    double              towards[3], world[3];
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
    camera_pixels(&f->camera, (box3){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, f->width, f->height, 2,
                  out);
    return true;
}

/* A full screen of one of the shaders that make the picture. */
static void draw_step(frame *f, const figure_state *s, const char *shader, const char *defines, gpu_texture *from,
                      gpu_texture *into, int round)
{
    text   prelude = {0};
    double plane[4];
    text_append(&prelude, "%s", defines);
    target_declare(&prelude, &target_rows[TARGET_SHADOW]);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", shader, &prelude);
    gpu_pass     pass = {.colours = {into}, .colour_count = 1, .clear = true};
    if (!p || gpu_failed(f->g))
        return;
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){0});
    frame_set_common(f, s);
    ground_plane_set(f, plane);
    gpu_set_float(f->g, "u_contact", (float)(CONTACT * f->ground_plane.size));
    gpu_set_float(f->g, "u_smoothing", values_of(f)->ground_smoothing);
    gpu_set_int(f->g, "u_iteration", round);
    if (from)
        gpu_set_texture(f->g, "t_ground_dark", from, false);
    gpu_draw_screen(f->g);
}

/* Leaves out what is too small to be told. */
static void drop_scraps(frame *f, const int box[4], gpu_texture *dark)
{
    size_t   count = (size_t)box[2] * (size_t)box[3];
    uint8_t *texels = mem_alloc(4 * count);
    if (!texels)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    else
        gpu_read_box(f->g, dark, box, texels);
    if (!gpu_failed(f->g) && !scraps_drop(texels, box[2], box[3], (double)values_of(f)->ground_smoothing))
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    if (!gpu_failed(f->g))
        gpu_target_write(f->g, dark, box, texels);
    mem_free(texels);
}

/* How much of each pixel of the ground lies in shadow. The caller gives it back. */
static gpu_texture *draw_hard(frame *f, figure_state *s)
{
    static const char *shader = "light/ground_dark.frag";
    double             smoothing = (double)values_of(f)->ground_smoothing;
    gpu_texture       *out = gpu_target_acquire(f->g, f->width, f->height, GPU_RGBA8), *last = NULL;
    if (!(smoothing > 0)) {
        draw_step(f, s, shader, "", NULL, out, 0);
        return out;
    }
    int rounds = form_rounds(smoothing);
    for (int k = 0; k <= rounds && !gpu_failed(f->g); k++) {
        gpu_texture *next = gpu_target_acquire(f->g, f->width, f->height, GPU_RG16F);
        draw_step(f, s, shader, k ? "#define CALMED\n" : "", last, next, k - 1);
        gpu_target_release(f->g, last);
        last = next;
    }
    draw_step(f, s, shader, "#define SHARPENED\n", last, out, 0);
    gpu_target_release(f->g, last);
    if (!gpu_failed(f->g))
        drop_scraps(f, s->pixels, out);
    return out;
}

static void lay_cast(frame *f, const figure_state *s, bool soft, gpu_texture *dark)
{
    const scene_values *v = values_of(f);
    const colour        c = v->ground_colour;
    bool                hatched = v->ground_hatch > 0;
    double              angle = (double)v->ground_angle * (3.14159265358979323846 / 180), plane[4];
    text                prelude = {0};
    text_append(&prelude, "%s%s%s", hatched ? "#define HATCHED\n" : "", soft ? "#define SOFT\n" : "",
                !soft && v->ground_edge > 0 ? "#define EDGED\n" : "");
    target_declare(&prelude, &target_rows[TARGET_SHADOW]);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_cast.frag", &prelude);
    gpu_pass     pass = {.colours = {f->page}, .colour_count = 1};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){.blend = GPU_BLEND_OVER});
    frame_set_common(f, s);
    ground_plane_set(f, plane);
    gpu_set_float(f->g, "u_ground_strength", v->ground_strength);
    gpu_set_float(f->g, "u_ground_edge", v->ground_edge);
    if (dark)
        gpu_set_texture(f->g, "t_ground_dark", dark, false);
    if (hatched) {
        gpu_set_float(f->g, "u_ground_hatch", v->ground_hatch);
        gpu_set_vec2(f->g, "u_ground_along", (float)cos(angle), (float)sin(angle));
    }
    gpu_set_vec4(f->g, "u_ground_colour", (float[]){c.r, c.g, c.b, c.a});
    gpu_draw_screen(f->g);
}

void ground_cast(frame *f)
{
    figure       fig = f->plan->figures[0];
    figure_state s = {.figure = &fig, .near = f->camera.near, .far = f->camera.far, .ground = true};
    bool         soft = values_of(f)->shadow_softness > 0;
    if (!find_cast_pixels(f, s.pixels))
        return;
    window_clip(f, WINDOW_MARGIN, s.pixels);
    if (s.pixels[2] <= 0 || s.pixels[3] <= 0)
        return;
    stopwatch    w = watch_start(&f->profile);
    gpu_texture *dark = soft ? NULL : draw_hard(f, &s);
    lay_cast(f, &s, soft, dark);
    gpu_target_release(f->g, dark);
    watch_stop(&f->profile, w, "scene", "shadow on the ground");
}
