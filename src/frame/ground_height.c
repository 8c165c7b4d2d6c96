/* How high over the ground that is what throws a shadow there: the model is looked at from below, and from each place
 * of the ground a way is gone towards the light until something stands in it. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "light/light.h"

enum { SIDE = GROUND_SIDE / 2, BLURS = 2 };

static ground_square square_of(const ground_plane *ground, const box3 *shadow)
{
    ground_square s = {.axes = {0, 3 - ground->up}};
    double        range[2];
    for (int k = 0; k < 2; k++) {
        ground_range(*shadow, s.axes[k], range);
        s.middle[k] = (range[0] + range[1]) / 2;
        s.half = fmax(s.half, (range[1] - range[0]) / 2);
    }
    ground_range(ground->box, ground->up, range);
    s.height = fmax(range[1] - ground->level, 1e-3 * ground->size);
    return s;
}

/* How far the map is gone over for each unit that the way to the light rises. */
static void find_slope(const ground_square *s, const view_camera *below, const double towards[3], int up, double out[2])
{
    for (int row = 0; row < 2; row++) {
        double run = 0;
        for (int k = 0; k < 3; k++)
            run += k == up ? 0 : below->view.m[4 * k + row] * towards[k];
        out[row] = run / towards[up] / (2 * s->half);
    }
}

static void draw_heights(frame *f, const ground_square *s, const view_camera *below, const double slope[2],
                         gpu_texture *depth, gpu_texture *into)
{
    text         prelude = {0};
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_height.frag", &prelude);
    double       reach = f->ground_plane.reach;
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &(gpu_pass){.colours = {into}, .colour_count = 1});
    gpu_use(f->g, p, (gpu_state){0});
    gpu_set_texture(f->g, "t_below", depth, false);
    gpu_set_vec4(f->g, "u_heights",
                 (float[]){(float)((below->near - s->height) / reach), (float)((below->far - below->near) / reach),
                           (float)(s->height / reach), 1.0F / SIDE});
    gpu_set_vec2(f->g, "u_rising", (float)(slope[0] * reach), (float)(slope[1] * reach));
    gpu_draw_screen(f->g);
}

static void blur(frame *f, gpu_texture *from, gpu_texture *into)
{
    text         prelude = {0};
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_blur.frag", &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &(gpu_pass){.colours = {into}, .colour_count = 1});
    gpu_use(f->g, p, (gpu_state){0});
    gpu_set_texture(f->g, "t_slab", from, true);
    gpu_draw_screen(f->g);
}

gpu_texture *ground_height(frame *f, const double towards[3], const box3 *shadow, mat4 *from_eye)
{
    ground_square square = square_of(&f->ground_plane, shadow);
    view_camera   below = ground_camera(&f->ground_plane, &square, true);
    double        slope[2];
    gpu_texture  *depth = ground_depth(f, &below), *out = gpu_target_acquire(f->g, SIDE, SIDE, GPU_RG16F);
    find_slope(&square, &below, towards, f->ground_plane.up, slope);
    *from_eye = ground_map_from_eye(f, &below);
    if (!gpu_failed(f->g))
        draw_heights(f, &square, &below, slope, depth, out);
    gpu_target_release(f->g, depth);
    for (int k = 0; k < BLURS && !gpu_failed(f->g); k++) {
        gpu_texture *next = gpu_target_acquire(f->g, SIDE, SIDE, GPU_RG16F);
        blur(f, out, next);
        gpu_target_release(f->g, out);
        out = next;
    }
    return out;
}
