/* The area that a mover sweeps: its meshes, pulled from where they were to where they are. Großmann 2011, section
 * 4.5.5, after Wloka and Zeleznik; row 45. Solids have no vertices: techniques find where they were from their pixels.
 */
#include "frame/frame_private.h"

#include <string.h>

/* Where the item was, in clip space and in the eye's axes of then. */
static void set_past(frame *f, const draw_item *item)
{
    int         last = f->up->past_count - 1;
    view_camera eye = f->camera_past[last];
    eye.projection = mat4_identity();
    view_set_past(f->g, 1, &f->camera_past[last], &item->past[last]);
    view_set_past(f->g, 2, &eye, &item->past[last]);
}

static void draw_item_stretched(frame *f, const figure_state *s, const draw_item *item)
{
    text prelude = {0};
    if (gpu_mesh_has_past(item->mesh))
        text_append(&prelude, "#define HAS_PAST\n#define PAST_LOCATION %d\n", 9 + f->up->past_count);
    gpu_program *p = program_of(f, GPU_FLOOR, "layer/stretched.vert", "layer/stretched.frag", &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_use(f->g, p, (gpu_state){.depth_test = true, .depth_write = true, .depth_clamp = true});
    frame_set_common(f, s);
    view_set_projection(f->g, &f->camera);
    view_set_transform(f->g, &f->camera, &item->world);
    set_past(f, item);
    gpu_set_uint(f->g, "u_part_id", item->part_id);
    gpu_draw_mesh(f->g, item->mesh);
    gpu_draw_glue(f->g, item->mesh);
}

void stretched_draw(frame *f, figure_state *s)
{
    stopwatch    w = watch_start(&f->profile);
    gpu_texture *depth = frame_acquire(f, TARGET_DEPTH);
    s->targets[TARGET_STRETCHED] = frame_acquire(f, TARGET_STRETCHED);
    gpu_pass pass = {.colours = {s->targets[TARGET_STRETCHED]}, .colour_count = 1, .depth = depth, .clear = true};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
    if (!gpu_failed(f->g))
        gpu_pass_begin(f->g, &pass);
    for (size_t i = 0; i < f->up->item_count && !gpu_failed(f->g); i++) {
        const draw_item *item = &f->up->items[i];
        if (!item->is_solid && s->figure->designated[item->part_index])
            draw_item_stretched(f, s, item);
    }
    gpu_target_release(f->g, depth);
    watch_stop(&f->profile, w, "motion", "stretched");
}
