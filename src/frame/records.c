/* The pass "records": where the edges of a figure's meshes are on the page, exactly, for lines that are found in
 * pictures. Pixels tell that surfaces part, records where. Persson's geometric post-process antialiasing (2011) does
 * the same for edges of triangles. */
#include "base/memory.h"
#include "base/paper.h"
#include "frame/frame_private.h"
#include "lines/stroke/strokes.h"

#include <math.h>
#include <string.h>

/* In a record's bits, of what is wanted: outlines. */
enum { RECORD_OUTLINE = 32 };

/* Which edges a program draws; ALL_EDGES: of every kind. */
enum { SHORT_EDGES = 1, SMOOTH_OUTLINES = 2, KINDS_OF_EDGES = 4, ALL_EDGES = 7 };

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

/* Are bodies open, where parts of the model are left out? Then not all that is nearer is seen. */
static bool has_open_bodies(const frame *f)
{
    return f->plan->has_cut || f->up->has_removed;
}

static gpu_program *program(frame *f, const figure_state *s, const pass *p, const technique_use *use, int which)
{
    text prelude = {0};
    uniforms_declare(&prelude, use_own_set(KIND_LINES, use));
    uniforms_declare(&prelude, use_common_set(KIND_LINES, use));
    reads_declare(&prelude, f, s, p, NULL);
    text_append(&prelude, "%s%s%s", has_open_bodies(f) ? "#define OPEN_BODIES\n" : "",
                which & SHORT_EDGES ? "#define SHORT_EDGES\n" : "",
                which & SMOOTH_OUTLINES ? "#define SMOOTH_OUTLINES\n" : "");
    if (which == ALL_EDGES)
        text_append(&prelude, "#define ALL_EDGES\n");
    return program_of(f, GPU_FLOOR, "lines/records.vert", "lines/records.frag", &prelude);
}

/* Can it have edges that are not short on the page (lines/record.glsl)? */
static bool may_be_long(const frame *f, const stroke_item *item)
{
    enum { LONGEST_SHORT = 192 };
    return camera_size_of(&f->camera, f->up->pose->part_boxes[item->part_index], f->height) >= LONGEST_SHORT;
}

/* Can it have outlines that are no creases? */
static bool may_be_smooth(const stroke_store *store, const stroke_item *item, double faint)
{
    return store->scene.meshes[item->mesh].moves || (double)store->turns[item->mesh] <= faint;
}

/* Pixels take for creases only what turns by more than facets may. Creases of meshes have been judged by feature: for
 * them so much of those angles is enough. Radians; "faint" or "crease". */
static double judged_angle(const technique_use *use, const char *key)
{
    const double judged = 2.0 / 3;
    double       degrees = 180;
    for (size_t i = 0; i < use->technique->param_count; i++)
        if (strcmp(use->technique->params[i].key, key) == 0)
            degrees = (double)*(const float *)param_field(&use->technique->params[i], use->values);
    return judged * degrees * (3.14159265358979323846 / 180);
}

static bool is_drawn(const frame *f, const figure_state *s, const stroke_item *item)
{
    return s->figure->designated[item->part_index] && is_large(f, item->part_index, 1);
}

/* Has the item edges of the kind? */
static bool has_kind(const frame *f, const stroke_store *store, const stroke_item *item, int which, double faint)
{
    if (which == ALL_EDGES)
        return true;
    return (which & SHORT_EDGES || has_open_bodies(f) || may_be_long(f, item)) &&
           (!(which & SMOOTH_OUTLINES) || may_be_smooth(store, item, 1.01 * faint));
}

/* Edges of one of four kinds: short on the page or not, outlines of what is smooth or not. What only some need costs a
 * software driver as much as all. */
static void draw_some(frame *f, figure_state *s, const pass *p, stroke_store *store, const technique_use *use,
                      int which)
{
    gpu_program *drawing = gpu_failed(f->g) ? NULL : program(f, s, p, use, which);
    bool         begun = false;
    double       faint = judged_angle(use, "faint"), crease = judged_angle(use, "crease");
    for (uint32_t i = 0; i < store->scene.item_count && drawing && !gpu_failed(f->g); i++) {
        const stroke_item *item = &store->scene.items[i];
        if (!is_drawn(f, s, item) || !has_kind(f, store, item, which, faint))
            continue;
        if (!begun) {
            gpu_use(f->g, drawing, (gpu_state){.blend = GPU_BLEND_MIN});
            frame_set_common(f, s);
            uniforms_set(f->g, use_own_set(KIND_LINES, use));
            uniforms_set(f->g, use_common_set(KIND_LINES, use));
            reads_set(f, s, p, NULL);
            gpu_set_vec2(f->g, "u_judged", (float)cos(faint), (float)cos(crease));
            gpu_set_vec2(f->g, "u_far_corner", (float)(f->width - 1), (float)(f->height - 1));
            gpu_set_int(f->g, "u_wanted", RECORD_OUTLINE | RECORD_BORDER | RECORD_CREASE);
            gpu_set_int(f->g, "u_inside", has_open_bodies(f) || !eye_is_outside(f));
            gpu_settle(f->g);
            begun = true;
        }
        edges_draw(f, store, i, false);
    }
}

static void draw(frame *f, figure_state *s, const pass *p, stroke_store *store, const technique_use *use)
{
    /* Before the pass begins: making records takes the place of what is bound. */
    for (uint32_t i = 0; store && i < store->scene.item_count && !gpu_failed(f->g); i++)
        if (is_drawn(f, s, &store->scene.items[i]))
            edges_bring(f, store, i, false);
    open_pictures(f, s, p);
    /* GPUs are quicker with each edge once: most are no lines, and end in the vertex shader. */
    bool at_once = !gpu_capabilities_of(f->g)->software;
    if (store && at_once)
        draw_some(f, s, p, store, use, ALL_EDGES);
    for (int which = 0; store && !at_once && which < KINDS_OF_EDGES; which++)
        if (!(which & SHORT_EDGES) || !has_open_bodies(f))
            draw_some(f, s, p, store, use, which);
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
