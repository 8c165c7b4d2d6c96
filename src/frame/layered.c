/* Figures that are seen through: layer after layer, nearest first, each with its lines, put under those before.
 * Several figures share the layers, so that they interleave per pixel. Nienhaus 2005, chapter 5; rows B01–B13. */
#include "frame/frame_private.h"

#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"

/* From this many layers on, one pass into lists is faster than a pass for each. */
enum { LISTS_PAY_FROM = 3 };

static void stack_open(frame *f, layer_stack *stack, const figure *figures, int count)
{
    *stack = (layer_stack){.states = mem_calloc((size_t)count, sizeof *stack->states),
                           .hidden = mem_calloc((size_t)count, sizeof *stack->hidden),
                           .boxes = mem_alloc(TILE_BOXES_MAX * sizeof *stack->boxes)};
    if (!stack->states || !stack->hidden || !stack->boxes) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    for (int i = 0; i < count; i++) {
        const figure *fig = &figures[i];
        figure_state *s = &stack->states[stack->count];
        if (!fig->part_count || !figure_open(f, s, fig))
            continue;
        s->index = stack->count;
        s->rear = 1;
        stack->hidden[stack->count] = *fig;
        stack->hidden[stack->count].rule = fig->hidden;
        stack->channels |= fig->channels;
        stack->limit = fig->layer_count > stack->limit ? fig->layer_count : stack->limit;
        int reach = figure_reach(fig);
        stack->reach = reach > stack->reach ? reach : stack->reach;
        if (stack->count == 0)
            memcpy(stack->box, s->pixels, sizeof stack->box);
        camera_widen_pixels(stack->box, s->pixels);
        stack->count++;
    }
    for (int i = 0; i < stack->count; i++)
        stack->states[i].shared = stack->count > 1;
    if (stack->count > 1)
        stack->channels |= CHANNEL_ID;
    if (f->maps && !f->maps->whole && !f->maps->part) /* that is made of what the whole maps are, to the bit */
        stack->limit = 1;
    if (f->maps && !f->maps->part) /* are read back whole */
        memcpy(stack->box, (int[]){0, 0, f->width, f->height}, sizeof stack->box);
}

/* Does a figure keep such a picture from layer to layer, or lend it from the stack? */
static bool is_kept(target t)
{
    return target_rows[t].owner >= OWNER_LINES && target_rows[t].owner <= OWNER_FIGURE;
}

static bool is_lent(target t)
{
    return target_rows[t].owner == OWNER_LAYER || target_rows[t].owner == OWNER_LAYERS;
}

/* Gives back what the figures keep of the lines in front. */
static void forget_lines(frame *f, layer_stack *stack)
{
    for (int i = 0; i < stack->count; i++)
        for (target t = 0; t < TARGET_COUNT; t++)
            if (is_kept(t)) {
                gpu_target_release(f->g, stack->states[i].targets[t]);
                stack->states[i].targets[t] = NULL;
            }
}

static void stack_close(frame *f, layer_stack *stack)
{
    forget_lines(f, stack);
    for (int i = 0; i < stack->count; i++) {
        gpu_target_release(f->g, stack->states[i].targets[TARGET_MEETING]);
        mem_free(stack->states[i].edges);
    }
    for (int t = 0; t < TARGET_COUNT; t++)
        gpu_target_release(f->g, stack->targets[t]);
    gpu_target_release(f->g, stack->before_depth);
    gpu_target_release(f->g, stack->before_id);
    gpu_target_release(f->g, stack->mask);
    solids_release(f->g, &stack->solids);
    lists_release(f, stack);
    mem_free(stack->states);
    mem_free(stack->hidden);
    mem_free(stack->boxes);
}

/* Gives the pictures of a layer back; by peeling, its depth and ids tell the next one where to go on. */
static void forget_layer(frame *f, layer_stack *stack, bool keep_order)
{
    gpu_target_release(f->g, stack->before_depth);
    gpu_target_release(f->g, stack->before_id);
    stack->before_depth = stack->before_id = NULL;
    if (keep_order) {
        stack->before_depth = stack->targets[TARGET_DEPTH];
        stack->before_id = stack->targets[TARGET_ID];
        stack->targets[TARGET_DEPTH] = stack->targets[TARGET_ID] = NULL;
    }
    for (int t = 0; t < TARGET_COUNT; t++) {
        if (target_rows[t].owner != OWNER_LAYER)
            continue;
        gpu_target_release(f->g, stack->targets[t]);
        stack->targets[t] = NULL;
    }
}

typedef struct coverage {
    double covered, uncovered, mask; /* pixels: of the layer; of the focus, not behind it any more; of the focus */
} coverage;

/* Takes the counts of the tiles; tiles that the layer before had left empty were not counted again. */
static coverage take_counts(layer_stack *stack, const float *values)
{
    coverage   out = {0};
    tile_grid *t = &stack->tiles;
    for (int y = 0; y < t->rows; y++)
        for (int x = 0; x < t->columns; x++) {
            const float *v = &values[4 * (y * TILES_SIDE + x)];
            if (t->full[y][x]) {
                t->full[y][x] = v[0] > 0;
                t->mask[y][x] = (uint32_t)v[2];
                out.covered += v[0];
                out.uncovered += v[1];
            } else {
                out.uncovered += t->mask[y][x];
            }
            out.mask += t->mask[y][x];
        }
    return out;
}

/* Counted by a shader and read back as a small picture, which every driver can, WebGL too. */
static coverage count_coverage(frame *f, layer_stack *stack)
{
    coverage  out = {0};
    stopwatch w = watch_start(&f->profile);
    text      prelude = {0};
    if (stack->mask)
        text_append(&prelude, "#define HAS_MASK\n");
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/boxes.vert", "layer/coverage.frag", &prelude);
    gpu_texture *sums = gpu_target_acquire(f->g, TILES_SIDE, TILES_SIDE, GPU_RGBA32F);
    float       *values = mem_alloc(sizeof(float) * 4 * TILES_SIDE * TILES_SIDE);
    if (!values)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    if (p && sums && !gpu_failed(f->g)) {
        const int *band = stack->band;
        tile_grid  counted = stack->tiles;
        counted.size = 1;
        memcpy(counted.band, (int[]){0, 0, counted.columns, counted.rows}, sizeof counted.band);
        stack->box_count = tiles_boxes(&counted, 0, counted.band, stack->boxes);
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {sums}, .colour_count = 1});
        gpu_use(f->g, p, (gpu_state){0});
        gpu_set_texture(f->g, "t_depth", stack->targets[TARGET_DEPTH], false);
        if (stack->mask)
            gpu_set_texture(f->g, "t_mask", stack->mask, false);
        gpu_set_vec2(f->g, "u_first", (float)band[0], (float)band[1]);
        gpu_set_vec2(f->g, "u_end", (float)(band[0] + band[2]), (float)(band[1] + band[3]));
        gpu_set_float(f->g, "u_block", (float)stack->tiles.size);
        gpu_set_vec2(f->g, "u_target", TILES_SIDE, TILES_SIDE);
        gpu_draw_boxes(f->g, stack->boxes, stack->box_count);
        gpu_read(f->g, sums, values);
        if (!gpu_failed(f->g))
            out = take_counts(stack, values);
    }
    mem_free(values);
    gpu_target_release(f->g, sums);
    watch_stop(&f->profile, w, "layers", "count");
    return out;
}

static void compose_figure(frame *f, layer_stack *stack, int which, int layer)
{
    figure_state *s = &stack->states[which];
    const figure *visible = s->figure;
    if (layer > 0)
        s->figure = &stack->hidden[which];
    s->layer = layer;
    for (target t = 0; t < TARGET_COUNT; t++)
        if (is_lent(t))
            s->targets[t] = stack->targets[t];
    if (!(stack->channels & CHANNEL_ID)) /* peeling has ids of its own need */
        s->targets[TARGET_ID] = NULL;
    s->geometry = s->targets[TARGET_NORMAL_DEPTH];
    if (s->targets[TARGET_SHADE])
        marks_draw(f, s, s->targets[TARGET_SHADE]);
    /* One field for all layers: they move together, and their order stays. Nienhaus 2005, section 6.8. */
    if (layer == 0 && (!f->maps || f->maps->whole))
        passes_run_kind(f, s, KIND_PERTURB);
    if (f->maps) {
        if (f->maps->whole)
            passes_run_kind(f, s, KIND_LINES);
        collect_layer(f, s);
    } else {
        passes_compose_lines(f, s, true);
    }
    for (target t = 0; t < TARGET_COUNT; t++)
        if (is_lent(t))
            s->targets[t] = NULL;
    s->figure = visible;
}

static bool is_behind(const figure_state *s, int layer)
{
    return layer >= s->figure->layer_count;
}

/* Has the figure had its last layer? */
static bool is_finished(const frame *f, figure_state *s, coverage c)
{
    const layering *how = &s->figure->layering;
    if (!how->several)
        return true;
    if (how->fraction > 0 && c.covered < (double)how->fraction * f->width * f->height)
        return true;
    if (s->figure->focus && c.uncovered >= (double)how->focus_fraction * c.mask) {
        s->rear = how->rear;
        return how->rear <= 0;
    }
    return false;
}

/* Passes over the layer's lines and colours go where it is, and as far around as lines reach. */
static void set_boxes(const frame *f, layer_stack *stack)
{
    bool all = f->maps != NULL; /* are read back whole */
    if (!all)
        stack->box_count = tiles_boxes(&stack->tiles, stack->reach, stack->around, stack->boxes);
    for (int i = 0; i < stack->count; i++) {
        stack->states[i].boxes = all ? NULL : stack->boxes;
        stack->states[i].box_count = stack->box_count;
    }
}

/* Draws the layers inside the current band; returns how many there were. */
static int draw_layers(frame *f, layer_stack *stack, bool lists)
{
    int  drawn = 0;
    bool finished[FIGURES_TOGETHER_MAX] = {false};
    tiles_start(&stack->tiles, stack->band);
    forget_lines(f, stack);
    for (int layer = 0; layer < stack->limit && !gpu_failed(f->g); layer++) {
        if (lists)
            lists_layer(f, stack, layer);
        else
            raster_layer(f, stack, layer == 0);
        coverage c = count_coverage(f, stack);
        if (c.covered == 0)
            break;
        drawn++;
        set_boxes(f, stack);
        bool open = false;
        for (int i = 0; i < stack->count; i++) {
            figure_state *s = &stack->states[i];
            if (finished[i] || is_behind(s, layer))
                continue;
            compose_figure(f, stack, i, layer);
            finished[i] = is_finished(f, s, c);
            open = open || !finished[i];
        }
        forget_layer(f, stack, !lists);
        if (!open || (f->maps && (f->maps->on_gpu || f->maps->part))) /* maps of layers are made in memory alone */
            break;
    }
    forget_layer(f, stack, false);
    return drawn;
}

/* Puts what the band's layers add up to onto the page. */
static void put_on_page(frame *f, const layer_stack *stack, const int band[4])
{
    stopwatch w = watch_start(&f->profile);
    text      prelude = {0};
    target_declare(&prelude, &target_rows[TARGET_LAYERS]);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "compose/stack.frag", &prelude);
    if (p && !gpu_failed(f->g)) {
        gpu_pass pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
        memcpy(pass.scissor, band, sizeof pass.scissor);
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){.blend = GPU_BLEND_OVER});
        gpu_set_texture(f->g, target_rows[TARGET_LAYERS].name, stack->targets[TARGET_LAYERS], false);
        gpu_draw_screen(f->g);
    }
    watch_stop(&f->profile, w, "layers", "page");
}

static void clear_sum(frame *f, layer_stack *stack)
{
    stack->targets[TARGET_LAYERS] = frame_acquire(f, TARGET_LAYERS);
    if (gpu_failed(f->g))
        return;
    gpu_pass pass = {.colours = {stack->targets[TARGET_LAYERS]}, .colour_count = 1, .clear = true};
    target_empty(&target_rows[TARGET_LAYERS], f->camera.far, pass.clear_values[0]);
    memcpy(pass.clear_box, stack->box, sizeof pass.clear_box);
    gpu_pass_begin(f->g, &pass);
}

/* Selects a band of the stack's box, and what is looked at around it. */
static void set_band(const frame *f, layer_stack *stack, const int band[4])
{
    bool      whole = memcmp(band, stack->box, sizeof stack->box) == 0;
    const int limits[2] = {f->width, f->height};
    memcpy(stack->band, band, sizeof stack->band);
    for (int k = 0; k < 2; k++) {
        int low = band[k] - 2 * stack->reach, high = band[k] + band[2 + k] + 2 * stack->reach;
        low = low < 0 ? 0 : low;
        high = high > limits[k] ? limits[k] : high;
        stack->around[k] = low;
        stack->around[2 + k] = high - low;
    }
    for (int i = 0; i < stack->count; i++) {
        figure_state *s = &stack->states[i];
        memcpy(s->band, stack->band, sizeof s->band);
        memcpy(s->pixels, whole ? stack->band : stack->around, sizeof s->pixels);
        memcpy(s->around, stack->around, sizeof s->around);
    }
}

/* What all figures of the stack ask for. */
typedef struct stack_options {
    bool   lists; /* from one pass, where that can be done */
    bool   whole; /* pieces will not do: something depends on all of the picture */
    size_t bytes; /* that lists may take */
} stack_options;

static stack_options options_of(const frame *f, const layer_stack *stack)
{
    stack_options out = {.lists = gpu_has_lists(f->g), .whole = f->maps != NULL, .bytes = SIZE_MAX};
    for (int i = 0; i < stack->count; i++) {
        const rule     *r = stack->states[i].figure->rule;
        const layering *how = &stack->states[i].figure->layering;
        if (!how->several)
            continue;
        if (how->producer == PRODUCER_PEELING || (stack->channels & (CHANNEL_REST | CHANNEL_VELOCITY)) ||
            (how->producer == PRODUCER_AUTO && stack->limit < LISTS_PAY_FROM))
            out.lists = false;
        out.whole = out.whole || how->fraction > 0 || stack->states[i].figure->focus || rule_traces_lines(r) ||
                    rule_traces_lines(stack->hidden[i].rule) || rule_use(r, KIND_PERTURB);
        size_t bytes = (size_t)how->memory << 20;
        out.bytes = bytes < out.bytes ? bytes : out.bytes;
    }
    return out;
}

static void draw_band(frame *f, layer_stack *stack, bool lists)
{
    int drawn = draw_layers(f, stack, lists);
    if (lists || !f->producer)
        f->producer = lists ? "lists" : "peeling";
    for (int i = 0; i < stack->count; i++)
        stack->states[i].rear = 1;
    if (!f->maps)
        put_on_page(f, stack, stack->band);
    if (drawn > f->layers)
        f->layers = drawn;
}

static void peel_band(frame *f, layer_stack *stack)
{
    lists_release(f, stack);
    draw_band(f, stack, false);
}

/* At once where lists have room; else in pieces, and a piece that is too full even when it is small is peeled. */
static void list_band(frame *f, layer_stack *stack, const stack_options *options, const int region[4], int depth)
{
    enum { DEPTH_MAX = 2, PIECES_MAX = 8, PIECE_SIDE_MIN = 64 };
    int band[4];
    memcpy(band, region, sizeof band);
    lists_release(f, stack);
    set_band(f, stack, band);
    int pieces = lists_build(f, stack, options->bytes), axis = band[2] > band[3] ? 0 : 1;
    if (pieces == 1) {
        draw_band(f, stack, true);
        return;
    }
    if (options->whole || depth == DEPTH_MAX || pieces > PIECES_MAX || band[2 + axis] / pieces < PIECE_SIDE_MIN) {
        f->lists_full = true;
        peel_band(f, stack);
        return;
    }
    for (int i = 0; i < pieces && !gpu_failed(f->g); i++) {
        int piece[4];
        memcpy(piece, band, sizeof piece);
        piece[axis] = band[axis] + band[2 + axis] * i / pieces;
        piece[2 + axis] = band[axis] + band[2 + axis] * (i + 1) / pieces - piece[axis];
        list_band(f, stack, options, piece, depth + 1);
    }
}

static void draw_bands(frame *f, layer_stack *stack)
{
    stack_options options = options_of(f, stack);
    if (options.lists) {
        list_band(f, stack, &options, stack->box, 0);
    } else {
        set_band(f, stack, stack->box);
        peel_band(f, stack);
    }
}

/* The depth of all that is to be uncovered, by whatever figure. */
static void draw_mask(frame *f, layer_stack *stack)
{
    size_t count = f->up->part_count;
    bool   any = false, *parts = mem_calloc(count, sizeof *parts);
    if (!parts) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    for (int i = 0; i < stack->count; i++)
        for (size_t part = 0; stack->states[i].figure->focus && part < count; part++)
            any |= parts[part] |= stack->states[i].figure->focus[part];
    if (any)
        raster_mask(f, stack, parts);
    mem_free(parts);
}

void layered_draw(frame *f, const figure *figures, int count)
{
    layer_stack stack;
    stack_open(f, &stack, figures, count);
    if (stack.count && !gpu_failed(f->g)) {
        draw_mask(f, &stack);
        for (int i = 0; i < stack.count && !gpu_failed(f->g); i++)
            raster_meeting(f, &stack.states[i]);
        clear_sum(f, &stack);
        draw_bands(f, &stack);
    }
    stack_close(f, &stack);
}
