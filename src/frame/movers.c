/* Movers: each is drawn alone, as its rule says, and measured: how far each of its pixels has moved. Its technique of
 * motion makes of both what is seen of it. So nothing of what stands beside it is smeared, and where it fades, what
 * lies behind shows, another mover too. */
#include "frame/frame_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* How many are put in order for each pixel; more are drawn in groups, the farthest first. */
enum { TOGETHER_MAX = 7 };

/* What one mover became. */
typedef struct mover_layer {
    gpu_texture *colour, *depth;
    int          pixels[4];
} mover_layer;

/* All pixels where it is or was, and as far beside them as its lines reach. */
static void find_pixels(const frame *f, figure_state *s)
{
    const pose *now = f->up->pose;
    int         margin = figure_reach(s->figure);
    for (size_t part = 0; part < f->plan->part_count; part++)
        for (int k = 0; k < now->past_count && s->figure->designated[part]; k++) {
            int box[4];
            camera_pixels(&f->camera_past[k], now->past[k]->part_boxes[part], f->width, f->height, margin, box);
            camera_widen_pixels(s->pixels, box);
        }
    const int limits[2] = {f->width, f->height};
    for (int k = 0; k < 2; k++) {
        int low = s->pixels[k] - margin, high = s->pixels[k] + s->pixels[2 + k] + margin;
        s->around[k] = low < 0 ? 0 : low;
        s->around[2 + k] = (high > limits[k] ? limits[k] : high) - s->around[k];
    }
}

/* A page of its own for what follows: nothing on it. */
static void open_page(frame *f, const int box[4])
{
    f->page = frame_acquire(f, TARGET_PAGE);
    f->page_depth = frame_acquire(f, TARGET_DEPTH);
    gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth, .clear = true};
    memcpy(pass.clear_box, box, sizeof pass.clear_box);
    if (!gpu_failed(f->g))
        gpu_pass_begin(f->g, &pass);
}

/* The mover as its rule draws it, into TARGET_MOVER. */
static void draw_alone(frame *f, figure_state *s)
{
    frame page = *f;
    open_page(f, s->around);
    if (s->figure->layered)
        layered_draw(f, s->figure, 1);
    else
        frame_draw_figure(f, s->figure);
    s->targets[TARGET_MOVER] = f->page;
    s->targets[TARGET_MOVER_DEPTH] = f->page_depth;
    f->page = page.page;
    f->page_depth = page.page_depth;
}

static void release(frame *f, figure_state *s)
{
    s->targets[TARGET_SCENE_DEPTH] = NULL; /* the page's */
    for (int i = 0; i < TARGET_COUNT; i++)
        gpu_target_release(f->g, s->targets[i]);
    solids_release(f->g, &s->solids);
}

static void measure(frame *f, figure_state *s)
{
    const technique_use *use = rule_use(s->figure->rule, KIND_MOTION);
    const motion_row    *row = use->technique->motion;
    raster_moved(f, s, row->steps(use->values), row->moved ? row->moved(use->values) : 0);
    if (row->stretched)
        stretched_draw(f, s);
}

/* Draws what a mover's technique makes of it, onto the page or, where `layer` is given, into that. */
static void draw_mover(frame *f, const figure *fig, mover_layer *layer)
{
    figure_state s;
    frame        page = *f;
    if (!figure_open(f, &s, fig))
        return;
    find_pixels(f, &s);
    draw_alone(f, &s);
    measure(f, &s);
    s.geometry = s.targets[TARGET_NORMAL_DEPTH];
    s.targets[TARGET_SCENE_DEPTH] = page.page_depth;
    if (layer) {
        open_page(f, s.around);
        *layer = (mover_layer){.colour = f->page, .depth = f->page_depth};
        memcpy(layer->pixels, s.pixels, sizeof layer->pixels);
    } else {
        f->page_depth = NULL; /* it is read; nothing is drawn after the only mover */
    }
    passes_run_kind(f, &s, KIND_MOTION);
    f->page = page.page;
    f->page_depth = page.page_depth;
    release(f, &s);
}

static bool throws_shadows(const figure *fig)
{
    const technique_use *use = fig->mover ? rule_use(fig->rule, KIND_MOTION) : NULL;
    for (size_t i = 0; use && i < use->technique->pass_count; i++)
        if (use->technique->passes[i].writes == TARGET_SHADOW &&
            pass_applies(KIND_MOTION, &use->technique->passes[i], use))
            return true;
    return false;
}

void movers_throw_shadows(frame *f)
{
    for (size_t i = 0; i < f->plan->figure_count && !gpu_failed(f->g); i++) {
        figure_state s;
        if (!throws_shadows(&f->plan->figures[i]) || !figure_open(f, &s, &f->plan->figures[i]))
            continue;
        find_pixels(f, &s);
        measure(f, &s);
        passes_throw_shadows(f, &s);
        release(f, &s);
    }
}

/* Puts layers over the page, for each pixel the farthest first. */
static void put_on_page(frame *f, const mover_layer *layers, int count)
{
    stopwatch w = watch_start(&f->profile);
    text      prelude = {0};
    int       box[4] = {0, 0, 0, 0};
    text_append(&prelude, "#define LAYERS %d\n", count);
    for (int i = 0; i < count; i++) {
        text_append(&prelude, "uniform sampler2D t_colour_%d, t_depth_%d;\nuniform vec4 u_box_%d;\n", i, i, i);
        camera_widen_pixels(box, layers[i].pixels);
    }
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "motion/together.frag", &prelude);
    if (p && !gpu_failed(f->g)) {
        gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
        memcpy(pass.scissor, box, sizeof pass.scissor);
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){.depth_test = true, .depth_write = true, .blend = GPU_BLEND_OVER});
        for (int i = 0; i < count; i++) {
            char       name[24];
            const int *b = layers[i].pixels;
            snprintf(name, sizeof name, "t_colour_%d", i);
            gpu_set_texture(f->g, name, layers[i].colour, false);
            snprintf(name, sizeof name, "t_depth_%d", i);
            gpu_set_texture(f->g, name, layers[i].depth, false);
            snprintf(name, sizeof name, "u_box_%d", i);
            gpu_set_vec4(f->g, name, (float[]){(float)b[0], (float)b[1], (float)(b[0] + b[2]), (float)(b[1] + b[3])});
        }
        gpu_draw_screen(f->g);
    }
    watch_stop(&f->profile, w, "motion", "together");
}

static void draw_together(frame *f, const figure *const *figures, int count)
{
    mover_layer layers[TOGETHER_MAX];
    int         drawn = 0;
    for (int i = 0; i < count && !gpu_failed(f->g); i++) {
        layers[drawn] = (mover_layer){.colour = NULL};
        draw_mover(f, figures[i], &layers[drawn]);
        drawn += layers[drawn].colour != NULL;
    }
    if (drawn && !gpu_failed(f->g))
        put_on_page(f, layers, drawn);
    for (int i = 0; i < drawn; i++) {
        gpu_target_release(f->g, layers[i].colour);
        gpu_target_release(f->g, layers[i].depth);
    }
}

/* A mover and how far it is. */
typedef struct mover_at {
    const figure *figure;
    double        depth;
} mover_at;

/* The farthest first; of equal ones the first. */
static int by_depth(const void *left, const void *right)
{
    const mover_at *a = left, *b = right;
    if (a->depth != b->depth)
        return a->depth > b->depth ? -1 : 1;
    return a->figure < b->figure ? -1 : 1;
}

static double depth_of(const frame *f, const figure *fig)
{
    double nearest = INFINITY, farthest = -INFINITY;
    camera_depth_range(&f->camera, fig->box, &nearest, &farthest);
    return (nearest + farthest) / 2;
}

void movers_draw(frame *f, const figure *figures, size_t count)
{
    if (count == 1) {
        draw_mover(f, figures, NULL);
        return;
    }
    mover_at *order = mem_alloc(count * sizeof *order);
    if (!order) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    for (size_t i = 0; i < count; i++)
        order[i] = (mover_at){&figures[i], depth_of(f, &figures[i])};
    qsort(order, count, sizeof *order, by_depth);
    /* The first group takes what is left over, so that the nearest ones are in one. */
    for (size_t i = 0, step; i < count && !gpu_failed(f->g); i += step) {
        const figure *group[TOGETHER_MAX];
        step = (count - i) % TOGETHER_MAX ? (count - i) % TOGETHER_MAX : TOGETHER_MAX;
        for (size_t k = 0; k < step; k++)
            group[k] = order[i + k].figure;
        draw_together(f, group, (int)step);
    }
    mem_free(order);
}
