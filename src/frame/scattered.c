/* A mover as each pixel sees it, at moments of its own: its triangles are drawn at MOMENTS times a sample, and each
 * pixel keeps those of one of them, which a number without a pattern picks. Time-continuous triangles (Akenine-Möller,
 * Munkberg and Hasselgren 2007) test each pixel at its time within one draw; this tests each time at its pixels, which
 * needs neither geometry shaders nor storage. */
#include "frame/frame_private.h"

#include <string.h>

#include "base/random.h"

enum { MOMENTS = 16, STREAM_MOMENTS = 83 };

/* The pictures of one sample, and of all so far. */
typedef struct scatter {
    gpu_texture *sample, *sample_depth, *mean, *depth;
    const pass  *pass;
} scatter;

static void draw_item_at(frame *f, const figure_state *s, const scatter *to, const draw_item *item, int sample,
                         double moment, double ago)
{
    text prelude = {0};
    text_append(&prelude, "#define MOMENTS %d\n", MOMENTS);
    reads_declare(&prelude, f, s, to->pass, NULL);
    if (gpu_mesh_has_past(item->mesh))
        text_append(&prelude, "#define HAS_PAST\n#define PAST_LOCATION %d\n", 9 + f->up->past_count);
    gpu_program *p = program_of(f, GPU_FLOOR, "motion/scattered.vert", to->pass->shader, &prelude);
    if (!p || gpu_failed(f->g))
        return;
    int last = f->up->past_count - 1;
    gpu_use(f->g, p, (gpu_state){.depth_test = true, .depth_write = true, .depth_clamp = true});
    frame_set_common(f, s);
    view_set_projection(f->g, &f->camera);
    view_set_transform(f->g, &f->camera, &item->world);
    view_set_past(f->g, 1, &f->camera_past[last], &item->past[last]);
    reads_set(f, s, to->pass, NULL);
    gpu_set_float(f->g, "u_ago", (float)ago);
    gpu_set_uint(f->g, "u_moment", (unsigned)moment);
    gpu_set_uint(f->g, "u_sample", (unsigned)sample);
    gpu_set_uint(f->g, "u_seed", f->seed);
    gpu_draw_mesh(f->g, item->mesh);
}

/* One sample of each pixel, in its part of the exposure. */
static void draw_sample(frame *f, const figure_state *s, const scatter *to, int sample, int samples, double offset)
{
    gpu_pass pass = {.colours = {to->sample}, .colour_count = 1, .depth = to->sample_depth, .clear = true};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
    if (gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &pass);
    for (int moment = 0; moment < MOMENTS; moment++)
        for (size_t i = 0; i < f->up->item_count && !gpu_failed(f->g); i++) {
            const draw_item *item = &f->up->items[i];
            double           ago = (sample + (moment + offset) / MOMENTS) / samples;
            if (!item->is_solid && s->figure->designated[item->part_index])
                draw_item_at(f, s, to, item, sample, moment, ago);
        }
}

/* A screen over the mover's pixels, from the pictures of a sample. */
static void draw_over(frame *f, const figure_state *s, const scatter *to, const char *shader, gpu_pass pass, float part)
{
    text prelude = {0};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", shader, &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){.depth_test = pass.depth, .depth_write = pass.depth});
    gpu_set_texture(f->g, "t_page", to->sample, false);
    gpu_set_texture(f->g, "t_mean", to->mean, false);
    gpu_set_texture(f->g, "t_sample_depth", to->sample_depth, false);
    gpu_set_float(f->g, "u_part", part);
    gpu_draw_screen(f->g);
}

/* Takes the sample into the mean of all so far, and into the nearest depth. */
static void take_sample(frame *f, const figure_state *s, scatter *to, int sample)
{
    gpu_texture *next = frame_acquire_for(f, s, to->pass->writes);
    draw_over(f, s, to, "motion/mean.frag", (gpu_pass){.colours = {next}, .colour_count = 1}, 1 / (float)(sample + 1));
    gpu_target_release(f->g, to->mean);
    to->mean = next;
    draw_over(f, s, to, "motion/nearer_depth.frag", (gpu_pass){.depth = to->depth}, 0);
}

void scattered_draw(frame *f, figure_state *s, const pass *p, int samples)
{
    random_source r = random_start(f->seed, STREAM_MOMENTS);
    double        offset = random_unit(&r);
    target        depth = p->writes + 1; /* the row behind it */
    scatter  to = {frame_acquire(f, TARGET_PAGE), frame_acquire(f, TARGET_DEPTH), frame_acquire_for(f, s, p->writes),
                   frame_acquire_for(f, s, depth), p};
    gpu_pass clear = {.depth = to.depth, .clear = true};
    memcpy(clear.clear_box, s->around, sizeof clear.clear_box);
    if (!gpu_failed(f->g))
        gpu_pass_begin(f->g, &clear);
    for (int sample = 0; sample < samples && !gpu_failed(f->g); sample++) {
        draw_sample(f, s, &to, sample, samples, offset);
        take_sample(f, s, &to, sample);
    }
    gpu_target_release(f->g, to.sample);
    gpu_target_release(f->g, to.sample_depth);
    s->targets[p->writes] = to.mean;
    s->targets[depth] = to.depth;
}
