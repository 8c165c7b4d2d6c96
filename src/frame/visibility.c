/* Soft shadows and ambient occlusion: a small picture of how much of the first light and of the sky arrives at what
 * is seen, made once a frame. Whoever asks for light looks it up (src/light/light.glsl). */
#include "frame/frame_private.h"

#include <math.h>

#include "light/light.h"

/* Half as large as the page; with several samples a pixel as large as it will be in the end. */
static void size_of(const frame *f, int out[2])
{
    int fraction = f->samples > 1 ? f->samples : 2;
    out[0] = (f->width + fraction - 1) / fraction;
    out[1] = (f->height + fraction - 1) / fraction;
}

static const scene_values *values_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

static void set_positions(const frame *f, int width, int height)
{
    const double *m = f->camera.projection.m;
    gpu_set_float(f->g, "u_perspective", f->camera.orthographic ? 0 : 1);
    gpu_set_vec2(f->g, "u_unproject", (float)(1 / m[0]), (float)(1 / m[5]));
    gpu_set_vec2(f->g, "u_pixel", (float)(2 / (m[0] * width)), (float)(2 / (m[5] * height)));
}

/* How the depth buffer's numbers and eye depth belong together. */
static void set_depth(const frame *f, int width, int height)
{
    const double *m = f->camera.projection.m;
    if (f->camera.orthographic) {
        double whole = -2 / m[10];
        gpu_set_vec4(f->g, "u_depth_terms", (float[]){(float)f->camera.near, (float)whole, 1, 0});
        gpu_set_vec2(f->g, "u_slope", (float)(-whole * m[0] * width / 2), (float)(-whole * m[5] * height / 2));
    } else {
        double near = f->camera.near, far = f->camera.far, apart = 1 / far - 1 / near;
        gpu_set_vec4(f->g, "u_depth_terms", (float[]){1, 0, (float)(1 / near), (float)apart});
        gpu_set_vec2(f->g, "u_slope", (float)(apart * m[0] * width / 2), (float)(apart * m[5] * height / 2));
    }
}

/* Where of a small picture light is measured: around the window, as far as it is blurred. */
static void limit_to_window(const frame *f, int width, gpu_pass *pass)
{
    int fraction = f->width > width ? (f->width + width - 1) / width : 1;
    if (f->window[2] <= 0)
        return;
    window_around(f, WINDOW_MARGIN * fraction, pass->scissor);
    for (int k = 0; k < 2; k++) {
        int end = (pass->scissor[k] + pass->scissor[2 + k] + fraction - 1) / fraction;
        pass->scissor[k] /= fraction;
        pass->scissor[2 + k] = end - pass->scissor[k];
    }
}

static void measure(frame *f, gpu_texture *depth, gpu_texture *fraction, gpu_texture *normals)
{
    const scene_values *v = values_of(f);
    int                 width = gpu_texture_width(depth), height = gpu_texture_height(depth);
    text                prelude = {0};
    text_append(&prelude, "%s%s", shadow_is_soft(f) ? "#define HAS_SOFT_SHADOW\n" : "",
                v->occlusion > 0 ? "#define HAS_OCCLUSION\n" : "");
    if (shadow_is_soft(f))
        target_declare(&prelude, &target_rows[TARGET_SHADOW]);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/visibility.frag", &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass pass = {.colours = {fraction, normals}, .colour_count = 2};
    limit_to_window(f, width, &pass);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){0});
    set_positions(f, width, height);
    set_depth(f, width, height);
    gpu_set_texture(f->g, "t_depth", depth, false);
    if (shadow_is_soft(f))
        shadow_set(f);
    gpu_set_float(f->g, "u_radius", (float)((double)v->occlusion_radius * box3_diagonal(f->plan->box)));
    gpu_draw_screen(f->g);
}

static void blur(frame *f, gpu_texture *from, gpu_texture *to, gpu_texture *normals, bool upwards)
{
    text         prelude = {0};
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/visibility_blur.frag", &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass pass = {.colours = {to}, .colour_count = 1};
    limit_to_window(f, gpu_texture_width(to), &pass);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){0});
    set_positions(f, gpu_texture_width(to), gpu_texture_height(to));
    gpu_set_vec2(f->g, "u_along", upwards ? 0 : 1, upwards ? 1 : 0);
    gpu_set_texture(f->g, "t_fraction", from, false);
    gpu_set_texture(f->g, "t_normals", normals, false);
    gpu_draw_screen(f->g);
}

/* The scene's depth in the small picture. The caller gives it back. */
static gpu_texture *small_depth(frame *f, int width, int height)
{
    frame small = *f;
    small.width = width;
    small.height = height;
    small.maps = NULL;
    small.shadow = NULL;
    small.page_depth =
        gpu_target_acquire(f->g, width, height, GPU_DEPTH32F); /* what solids are gathered in must be as large */
    if (!gpu_failed(f->g))
        raster_depth(&small, small.page_depth);
    return small.page_depth;
}

void visibility_draw(frame *f)
{
    if ((!shadow_is_soft(f) && values_of(f)->occlusion <= 0) || box3_is_empty(f->plan->box))
        return;
    int size[2];
    size_of(f, size);
    stopwatch    w = watch_start(&f->profile);
    gpu_texture *depth = small_depth(f, size[0], size[1]);
    watch_stop(&f->profile, w, "scene", "visible depth");
    w = watch_start(&f->profile);
    gpu_texture *fraction = gpu_target_acquire(f->g, size[0], size[1], GPU_RGBA32F),
                *other = gpu_target_acquire(f->g, size[0], size[1], GPU_RGBA32F);
    gpu_texture *normals = gpu_target_acquire(f->g, size[0], size[1], GPU_RGBA32F);
    if (!gpu_failed(f->g))
        measure(f, depth, fraction, normals);
    watch_stop(&f->profile, w, "scene", "visibility");
    w = watch_start(&f->profile);
    if (!gpu_failed(f->g)) {
        blur(f, fraction, other, normals, false);
        blur(f, other, fraction, normals, true);
    }
    gpu_target_release(f->g, depth);
    gpu_target_release(f->g, other);
    gpu_target_release(f->g, normals);
    f->visibility = fraction;
    watch_stop(&f->profile, w, "scene", "visibility blur");
}
