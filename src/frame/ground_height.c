/* How high over the ground that is what throws a shadow there: the model is looked at from below, and from each place
 * of the ground a way is gone towards the light until something stands in it. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
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

/* --- what hangs over the ground -------------------------------------------------------------------------- */

/* Of e^(-height): from where on it is dark where there are two tones; where something stands; what is left of what does
 * not. */
static const float DARK = 0.5F, STANDS = 0.93F, PALE = 0.3F;

typedef struct heights {
    float   *near; /* per place two numbers: what `blur` makes, of which the first over the second is how near it is */
    uint8_t *mark; /* per place */
    int     *found;
} heights;

enum { OPEN, GATHERED, STOOD, PALED };

static float near_at(const heights *h, int i)
{
    return h->near[2 * i] / fmaxf(h->near[2 * i + 1], 1e-3F);
}

/* All of a hill, down to what is pale, but for what belongs to something that stands. */
static int gather(heights *h, int first, uint8_t mark, float down_to, bool *stands)
{
    int count = 1;
    h->found[0] = first;
    h->mark[first] = mark;
    for (int k = 0; k < count; k++) {
        int at = h->found[k], x = at % SIDE, y = at / SIDE;
        *stands = *stands || near_at(h, at) > STANDS;
        for (int n = 0; n < 9; n++) {
            int dx = n % 3 - 1, dy = n / 3 - 1, next = at + dy * SIDE + dx;
            if (x + dx < 0 || x + dx >= SIDE || y + dy < 0 || y + dy >= SIDE || h->mark[next] == mark ||
                h->mark[next] == STOOD || near_at(h, next) <= down_to ||
                (near_at(h, next) <= DARK && near_at(h, next) > near_at(h, at)))
                continue;
            h->mark[next] = mark;
            h->found[count++] = next;
        }
    }
    return count;
}

/* Of two tones the darker one is what stands on the ground has at its foot: what is dark by itself becomes pale. */
static void pale_what_hangs(heights *h)
{
    bool any = false;
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool stands = false;
        if (h->mark[i] != OPEN || near_at(h, i) <= DARK)
            continue;
        int count = gather(h, i, GATHERED, DARK, &stands);
        for (int k = 0; k < count && stands; k++)
            h->mark[h->found[k]] = STOOD;
        any = any || stands;
    }
    for (int i = 0; i < SIDE * SIDE && any; i++) {
        bool stands = false;
        if (h->mark[i] != GATHERED)
            continue;
        int count = gather(h, i, PALED, PALE, &stands);
        for (int k = 0; k < count; k++)
            h->near[2 * h->found[k]] = PALE * h->near[2 * h->found[k] + 1];
    }
}

static void keep_feet(frame *f, gpu_texture *map)
{
    heights   h = {.near = mem_alloc(sizeof *h.near * 2 * SIDE * SIDE)};
    const int box[4] = {0, 0, SIDE, SIDE};
    h.mark = mem_calloc((size_t)SIDE * SIDE, 1);
    h.found = mem_alloc(sizeof *h.found * SIDE * SIDE);
    if (h.near && h.mark && h.found)
        gpu_read_box(f->g, map, box, h.near);
    else
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    if (!gpu_failed(f->g)) {
        pale_what_hangs(&h);
        gpu_target_write(f->g, map, box, h.near);
    }
    mem_free(h.near);
    mem_free(h.mark);
    mem_free(h.found);
}

gpu_texture *ground_height(frame *f, const double towards[3], const box3 *shadow, bool flat, mat4 *from_eye)
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
    if (flat && !gpu_failed(f->g))
        keep_feet(f, out);
    return out;
}
