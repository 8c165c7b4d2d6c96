/* The pass "records": where the edges of a figure's meshes are on the page, exactly, for lines that are found in
 * pictures. Pixels tell that surfaces part, records where. Persson's geometric post-process antialiasing (2011) does
 * the same for edges of triangles. */
#include "base/memory.h"
#include "frame/frame_private.h"
#include "lines/stroke/strokes.h"

#include <string.h>

static stroke_store *find_store(frame *f)
{
    bool *parts = mem_calloc(f->up->part_count, sizeof *parts);
    for (size_t i = 0; parts && i < f->up->part_count; i++)
        parts[i] = f->plan->selected[i];
    if (!parts)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    stroke_store_options options = {f->up->pose, parts, f->up->part_count, f->up->crease_angle, 0};
    stroke_store        *s = parts ? stroke_store_find(&f->up->strokes[STROKES_LOOKED_UP], f->g, &options) : NULL;
    mem_free(parts);
    return s;
}

static void open_picture(frame *f, figure_state *s, const pass *p, gpu_texture *depth)
{
    gpu_target_release(f->g, s->targets[p->writes]);
    s->targets[p->writes] = frame_acquire_for(f, s, p->writes);
    gpu_pass target = {.colours = {s->targets[p->writes]}, .colour_count = 1, .depth = depth, .clear = true};
    target_empty(target_row_of(s, p->writes), s->far, target.clear_values[0]);
    memcpy(target.clear_box, s->around, sizeof target.clear_box);
    memcpy(target.scissor, s->pixels, sizeof target.scissor);
    if (!gpu_failed(f->g))
        gpu_pass_begin(f->g, &target);
}

static void draw(frame *f, figure_state *s, const pass *p, stroke_store *store, const technique_use *use)
{
    const param_set own = use_own_set(KIND_LINES, use);
    text            prelude = {0};
    uniforms_declare(&prelude, own);
    reads_declare(&prelude, f, s, p, NULL);
    if (s->figure->layered || f->plan->has_cut || f->up->has_removed) /* then not all that is nearer is seen */
        text_append(&prelude, "#define SEEN_THROUGH\n");
    gpu_program *program = program_of(f, GPU_FLOOR, "lines/records.vert", "lines/records.frag", &prelude);
    /* Before the pass begins: making records takes the place of what is bound. */
    for (uint32_t i = 0; i < store->scene.item_count; i++)
        if (s->figure->designated[store->scene.items[i].part_index])
            edges_bring(f, store, i, false);
    gpu_texture *depth = frame_acquire(f, TARGET_DEPTH);
    open_picture(f, s, p, depth);
    if (program && !gpu_failed(f->g)) {
        gpu_use(f->g, program, (gpu_state){.depth_test = true, .depth_write = true, .depth_compare = GPU_LESS});
        frame_set_common(f, s);
        uniforms_set(f->g, own);
        reads_set(f, s, p, NULL);
        gpu_set_vec2(f->g, "u_far_corner", (float)(f->width - 1), (float)(f->height - 1));
        gpu_set_int(f->g, "u_wanted", 32 | RECORD_BORDER | RECORD_CREASE);
        gpu_set_int(f->g, "u_inside", s->figure->layered || f->plan->has_cut || f->up->has_removed || !eye_is_outside(f));
        gpu_settle(f->g);
        for (uint32_t i = 0; i < store->scene.item_count; i++)
            if (s->figure->designated[store->scene.items[i].part_index])
                edges_draw(f, store, i, false);
    }
    gpu_target_release(f->g, depth);
}

void records_run(frame *f, figure_state *s, const pass *p, const technique_use *use, const char *group)
{
    /* Movers and mirrors are drawn in other moments and halves of the scene than the store's. */
    if (f->mirror || s->figure->mover || gpu_failed(f->g))
        return;
    stopwatch     w = watch_start(&f->profile);
    stroke_store *store = find_store(f);
    if (store && store->scene.item_count > 0)
        draw(f, s, p, store, use);
    watch_stop(&f->profile, w, group, p->name);
}
