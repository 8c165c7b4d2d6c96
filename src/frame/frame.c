/* A frame: figure after figure onto the page, then the page encoded. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"

void figure_release(frame *f, figure_state *s)
{
    for (int i = 0; i < TARGET_COUNT; i++)
        gpu_target_release(f->g, s->targets[i]);
    solids_release(f->g, &s->solids);
}

static void clear_page(frame *f)
{
    gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth, .clear = true};
    frame_ground(f, pass.clear_values[0]);
    if (f->window[2] > 0)
        window_around(f, window_margin(f), pass.clear_box);
    gpu_pass_begin(f->g, &pass);
}

static void draw_figures(frame *f);

/* Draws everything but the mirror as its plane shows it, with lines of its own, into a picture of the page's size. */
static void draw_reflection(frame *f, figure_state *s)
{
    frame inner;
    if (!mirror_prepare(f, s->figure, &inner))
        return;
    stopwatch w = watch_start(&f->profile);
    inner.page = frame_acquire(f, TARGET_PAGE);
    inner.page_depth = frame_acquire(f, TARGET_DEPTH);
    if (!gpu_failed(f->g)) {
        clear_page(&inner);
        draw_figures(&inner);
    }
    gpu_target_release(f->g, inner.page_depth);
    s->targets[TARGET_REFLECTION] = inner.page;
    watch_stop(&f->profile, w, "surface", "reflection");
}

/* From the figure's G-buffer to its sprite, or to its maps. */
static void draw_sprite(frame *f, figure_state *s)
{
    /* Lines that are folded into the fill would move with it. */
    bool one_by_one =
        !f->maps && rule_use(s->figure->rule, KIND_PERTURB) && s->figure->rule->use_counts[KIND_LINES] > 1;
    s->filled = !s->apart;
    for (int k = KIND_LAYERS; k < KIND_MOTION; k++) {
        bool wanted = !f->maps || (f->maps->whole && k != KIND_COMPOSE);
        if (wanted && !(one_by_one && (k == KIND_LINES || k == KIND_COMPOSE)))
            passes_run_kind(f, s, (kind_id)k);
    }
    if (one_by_one)
        passes_compose_lines(f, s, false);
    if (f->maps)
        collect_figure(f, s);
}

void figure_finish(frame *f, figure_state *s)
{
    s->geometry = s->targets[TARGET_NORMAL_DEPTH];
    if (s->figure->deferred) {
        passes_prepare(f, s);
        raster_shade_deferred(f, s);
    }
    if (s->targets[TARGET_SHADE])
        marks_draw(f, s, s->targets[TARGET_SHADE]);
    figure_find_boxes(f, s);
    draw_sprite(f, s);
    mem_free(s->edges);
    mem_free(s->boxes);
}

void frame_draw_figure(frame *f, const figure *fig)
{
    figure_state s;
    if (!figure_open(f, &s, fig))
        return;
    if (fig->reflects && !f->mirror)
        draw_reflection(f, &s);
    if (fig->direct && !f->maps) {
        raster_direct(f, &s);
    } else {
        raster_figure(f, &s);
        raster_meeting(f, &s);
        figure_finish(f, &s);
    }
    figure_release(f, &s);
}

static void draw_figures(frame *f)
{
    const plan *p = f->plan;
    for (size_t i = 0, next; i < p->figure_count; i = next) {
        next = i + 1;
        if (p->figures[i].mover && !f->mirror) { /* they are the last; in mirrors they are as all others */
            movers_draw(f, &p->figures[i], p->figure_count - i);
            return;
        }
        if (!p->figures[i].layered) {
            const size_t together = together_count(f, &p->figures[i], p->figure_count - i);
            if (together > 1)
                together_draw(f, &p->figures[i], together);
            else if (&p->figures[i] != f->mirror)
                frame_draw_figure(f, &p->figures[i]);
            next = together > 1 ? i + together : next;
            continue;
        }
        while (next < p->figure_count && p->figures[next].layered && next - i < FIGURES_TOGETHER_MAX &&
               p->figures[next].mover == p->figures[i].mover)
            next++;
        layered_draw(f, &p->figures[i], (int)(next - i));
    }
}

static void encode(frame *f, gpu_texture *out)
{
    stopwatch w = watch_start(&f->profile);
    text      prelude = {0};
    paper_declare(&prelude, f);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "finish/encode.frag", &prelude);
    if (p && !gpu_failed(f->g)) {
        gpu_pass pass = {.colours = {out}, .colour_count = 1};
        for (int k = 0; k < 4; k++)
            pass.scissor[k] = f->window[k] / f->samples;
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){0});
        gpu_set_texture(f->g, "t_page", f->page, false);
        gpu_set_int(f->g, "u_samples", f->samples);
        paper_set(f);
        gpu_draw_screen(f->g);
    }
    watch_stop(&f->profile, w, "", "encode");
}

/* Is its depth kept while it is composed, which alone knows where its perturbation puts it? */
static bool keeps_moved_depth(const figure *fig)
{
    return fig->layered && !fig->mover && rule_use(fig->rule, KIND_PERTURB) != NULL;
}

static void open_moved_depth(frame *f)
{
    bool any = false;
    for (size_t i = 0; i < f->plan->figure_count; i++)
        any = any || keeps_moved_depth(&f->plan->figures[i]);
    gpu_target_release(f->g, f->moved_depth);
    f->moved_depth = any ? frame_acquire(f, TARGET_DEPTH) : NULL;
    if (f->moved_depth && !gpu_failed(f->g))
        gpu_pass_begin(f->g, &(gpu_pass){.depth = f->moved_depth, .clear = true});
}

/* Figures that are seen through leave no depth on the page, nor do those that move. */
static void keep_seen_depth(frame *f)
{
    const plan *p = f->plan;
    bool        any = false, *parts = mem_calloc(p->part_count, sizeof *parts);
    if (!parts) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    for (size_t i = 0; i < p->figure_count; i++) {
        const figure *fig = &p->figures[i];
        if ((!fig->layered && !fig->mover) || keeps_moved_depth(fig))
            continue;
        int reach = figure_reach(fig);
        f->seen_reach = reach > f->seen_reach ? reach : f->seen_reach;
        for (size_t k = 0; k < p->part_count; k++)
            any |= parts[k] |= fig->designated[k];
    }
    if (any) {
        f->seen_depth = frame_acquire(f, TARGET_DEPTH);
        if (!gpu_failed(f->g))
            raster_depth_of(f, f->seen_depth, parts);
    }
    mem_free(parts);
}

static void draw_page(frame *f)
{
    f->page = frame_acquire(f, TARGET_PAGE);
    f->page_depth = frame_acquire(f, TARGET_DEPTH);
    memset(f->strokes, 0, sizeof f->strokes);
    f->search = (outline_search){0, 0};
    f->marks = (mark_facts){0, 0, 0};
    memset(&f->traces, 0, sizeof f->traces);
    facts_open(f);
    shadow_draw(f);
    if (!gpu_failed(f->g))
        visibility_draw(f);
    if (f->keeps_depth && !gpu_failed(f->g))
        open_moved_depth(f);
    if (!gpu_failed(f->g)) {
        clear_page(f);
        ground_draw(f);
        draw_figures(f);
    }
    if (!gpu_failed(f->g) && !f->maps)
        traces_draw(f);
    if (f->keeps_depth && !gpu_failed(f->g))
        keep_seen_depth(f);
}

static void release_page(frame *f)
{
    gpu_target_release(f->g, f->page);
    if (f->keeps_depth)
        f->kept_depth = f->page_depth;
    else
        gpu_target_release(f->g, f->page_depth);
    shadow_release(f);
    gpu_target_release(f->g, f->visibility);
    gpu_target_release(f->g, f->facts);
    f->facts = NULL;
    f->page = f->page_depth = f->shadow = f->visibility = NULL;
}

void frame_draw(frame *f, gpu_texture *out)
{
    draw_page(f);
    if (out && !gpu_failed(f->g))
        encode(f, out);
    release_page(f);
}

/* Draws the page and makes the next of pictures that are taken together; `value` is what the program is told. */
static void take_page(frame *f, gpu_texture **all, const char *fragment, const char *uniform, double value, bool *hides)
{
    gpu_texture *depths[2] = {NULL, NULL};
    text         prelude = {0};
    float        ground[4];
    gpu_texture *next = gpu_target_acquire(f->g, f->width, f->height, GPU_RGBA32F);
    draw_page(f);
    frame_ground(f, ground);
    for (int i = 0; i < 2 && hides && !gpu_failed(f->g); i++) {
        depths[i] = frame_acquire(f, TARGET_DEPTH);
        raster_depth_of(f, depths[i], i ? f->plan->selected : hides);
    }
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", fragment, &prelude);
    if (p && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {next}, .colour_count = 1});
        gpu_use(f->g, p, (gpu_state){0});
        gpu_set_texture(f->g, "t_page", f->page, false);
        gpu_set_texture(f->g, "t_mean", *all ? *all : f->page, false);
        gpu_set_float(f->g, uniform, (float)value);
        gpu_set_vec4(f->g, "u_ground", ground);
        gpu_set_int(f->g, "u_first", *all == NULL);
        if (depths[1]) {
            gpu_set_texture(f->g, "t_moving", depths[0], false);
            gpu_set_texture(f->g, "t_all", depths[1], false);
            gpu_set_int(f->g, "u_hides", 1);
        }
        gpu_draw_screen(f->g);
    }
    for (int i = 0; i < 2; i++)
        gpu_target_release(f->g, depths[i]);
    release_page(f);
    gpu_target_release(f->g, *all);
    *all = next;
}

void frame_draw_into_mean(frame *f, gpu_texture **mean, double part)
{
    take_page(f, mean, "motion/mean.frag", "u_part", part, NULL);
}

void frame_draw_onto_plate(frame *f, gpu_texture **plate, double ink, bool *hides)
{
    take_page(f, plate, "motion/plate.frag", "u_ink", ink, hides);
}

void frame_encode_mean(frame *f, gpu_texture *mean, gpu_texture *out)
{
    f->page = mean;
    encode(f, out);
    f->page = NULL;
}
