/* The pass "records": where the edges of a figure's meshes are on the page, exactly, for lines that are found in
 * pictures. Pixels tell that surfaces part, records where. Persson's geometric post-process antialiasing (2011) does
 * the same for edges of triangles. */
#include "base/memory.h"
#include "base/paper.h"
#include "frame/frame_private.h"
#include "lines/stroke/strokes.h"

#include <string.h>

/* In a record's bits, of what is wanted: outlines. */
enum { RECORD_OUTLINE = 32 };

/* Pixels tell all that there is about parts no larger than this, points of paper. */
#define SMALLEST_PART 8.0

/* Is the part so large? `share`: of that size. */
static bool is_large(const frame *f, size_t part_index, double share)
{
    double smallest = share * SMALLEST_PART * MM_PER_POINT * f->pixels_per_mm;
    return camera_size_of(&f->camera, f->up->pose->part_boxes[part_index], f->height) >= smallest;
}

/* Do all parts that are wanted now have edges in the store, and only parts that are drawn? */
static bool still_serves(const frame *f, const stroke_store *s, const bool *wanted)
{
    bool serves = s && s->part_count == f->up->part_count && s->revision == f->up->pose->revision;
    for (size_t i = 0; serves && i < s->part_count; i++)
        serves = s->parts[i] ? f->plan->selected[i] : !wanted[i];
    return serves;
}

/* Edges are sorted of parts alone that are large enough in this view; of a town that is seen from afar they would be
 * most of what a picture takes. Where the view has moved, those of before stay, and a few more come than are asked for,
 * so that not every next picture sorts again. */
static stroke_store *find_store(frame *f)
{
    stroke_store **slot = &f->up->strokes[STROKES_LOOKED_UP];
    size_t         count = f->up->part_count, found = 0;
    bool          *parts = mem_calloc(count, sizeof *parts);
    for (size_t i = 0; parts && i < count; i++)
        found += parts[i] = f->plan->selected[i] && is_large(f, i, 1);
    if (!parts)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    bool serves = parts && still_serves(f, *slot, parts), known = *slot && (*slot)->part_count == count;
    for (size_t i = 0; parts && found && i < count; i++)
        parts[i] = serves ? (*slot)->parts[i]
                          : f->plan->selected[i] && (parts[i] || (known && ((*slot)->parts[i] || is_large(f, i, 0.5))));
    stroke_store_options options = {f->up->pose, parts, count, f->up->crease_angle, 0, NULL};
    stroke_store        *s = parts && found ? stroke_store_find(slot, f->g, &options) : NULL;
    mem_free(parts);
    return s;
}

/* Are there meshes, with edges of which records could tell? */
static bool has_meshes(const frame *f)
{
    const lmn_scene *scene = f->plan->scene;
    for (size_t i = 0; i < scene->part_count; i++)
        if (f->plan->selected[i] && scene->nodes[scene->parts[i].node].mesh != NONE)
            return true;
    return false;
}

static gpu_texture *renew(frame *f, figure_state *s, target t)
{
    gpu_target_release(f->g, s->targets[t]);
    s->targets[t] = frame_acquire_for(f, s, t);
    return s->targets[t];
}

static void open_pictures(frame *f, figure_state *s, const pass *p)
{
    const target written[] = {p->writes, p->writes_too};
    gpu_pass     into = {.colour_count = 2, .clear = true};
    for (int i = 0; i < 2; i++) {
        into.colours[i] = renew(f, s, written[i]);
        target_empty(target_row_of(s, written[i]), s->far, into.clear_values[i]);
    }
    memcpy(into.clear_box, s->around, sizeof into.clear_box);
    memcpy(into.scissor, s->pixels, sizeof into.scissor);
    if (!gpu_failed(f->g))
        gpu_pass_begin(f->g, &into);
}

static gpu_program *program(frame *f, const figure_state *s, const pass *p, const technique_use *use)
{
    text prelude = {0};
    uniforms_declare(&prelude, use_own_set(KIND_LINES, use));
    uniforms_declare(&prelude, use_common_set(KIND_LINES, use));
    reads_declare(&prelude, f, s, p, NULL);
    if (f->plan->has_cut || f->up->has_removed) /* then not all that is nearer is seen */
        text_append(&prelude, "#define OPEN_BODIES\n");
    return program_of(f, GPU_FLOOR, "lines/records.vert", "lines/records.frag", &prelude);
}

static bool is_drawn(const frame *f, const figure_state *s, const stroke_item *item)
{
    return s->figure->designated[item->part_index] && is_large(f, item->part_index, 1);
}

static void draw(frame *f, figure_state *s, const pass *p, stroke_store *store, const technique_use *use)
{
    gpu_program *drawing = gpu_failed(f->g) ? NULL : program(f, s, p, use);
    /* Before the pass begins: making records takes the place of what is bound. */
    size_t count = store ? store->scene.item_count : 0;
    for (uint32_t i = 0; i < count; i++)
        if (is_drawn(f, s, &store->scene.items[i]))
            edges_bring(f, store, i, false);
    open_pictures(f, s, p);
    if (drawing && !gpu_failed(f->g)) {
        gpu_use(f->g, drawing, (gpu_state){.blend = GPU_BLEND_MIN});
        frame_set_common(f, s);
        uniforms_set(f->g, use_own_set(KIND_LINES, use));
        uniforms_set(f->g, use_common_set(KIND_LINES, use));
        reads_set(f, s, p, NULL);
        gpu_set_vec2(f->g, "u_far_corner", (float)(f->width - 1), (float)(f->height - 1));
        gpu_set_int(f->g, "u_wanted", RECORD_OUTLINE | RECORD_BORDER | RECORD_CREASE);
        gpu_set_int(f->g, "u_inside", f->plan->has_cut || f->up->has_removed || !eye_is_outside(f));
        gpu_settle(f->g);
        for (uint32_t i = 0; i < count; i++)
            if (is_drawn(f, s, &store->scene.items[i]))
                edges_draw(f, store, i, false);
    }
}

void records_run(frame *f, figure_state *s, const pass *p, const technique_use *use, const char *group)
{
    /* Movers and mirrors are drawn in other moments and halves of the scene than the store's; of layers each would
     * have to look for its own. */
    if (f->draft || f->mirror || s->figure->mover || s->figure->layered || gpu_failed(f->g))
        return;
    stopwatch w = watch_start(&f->profile);
    if (has_meshes(f))
        draw(f, s, p, find_store(f), use);
    watch_stop(&f->profile, w, group, p->name);
}
