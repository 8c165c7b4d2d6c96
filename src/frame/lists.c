/* Layers from one geometry pass: every fragment goes into a list of its pixel (GL 4.3 storage blocks), and the
 * nearest are sorted out in rounds of up to eight. 32 bytes a fragment, 48 with shade or albedo, 4 a pixel; at most
 * one storage block of nodes. */
#include "frame/frame_private.h"

#include <string.h>

enum { KEPT_MAX = 8, NODE_VECTORS_BARE = 2, NODE_VECTORS_COLOURED = 3 };

static void bind_buffers(frame *f, const layer_stack *stack)
{
    gpu_buffer_bind(f->g, stack->heads, 0);
    gpu_buffer_bind(f->g, stack->list, 1);
    gpu_buffer_bind(f->g, stack->counter, 2);
}

void lists_release(frame *f, layer_stack *stack)
{
    gpu_buffer_release(f->g, stack->heads);
    gpu_buffer_release(f->g, stack->list);
    gpu_buffer_release(f->g, stack->counter);
    stack->heads = stack->list = stack->counter = NULL;
    for (int i = 0; i < 2; i++) {
        gpu_target_release(f->g, stack->nodes[i]);
        stack->nodes[i] = NULL;
    }
}

int lists_build(frame *f, layer_stack *stack, size_t capacity)
{
    stopwatch w = watch_start(&f->profile);
    size_t    pixels = (size_t)stack->around[2] * (size_t)stack->around[3];
    size_t    block = (size_t)gpu_capabilities_of(f->g)->max_storage_mib << 20;
    capacity = capacity < block ? capacity : block;
    stack->node_vectors =
        stack->channels & (CHANNEL_SHADE | CHANNEL_ALBEDO) ? NODE_VECTORS_COLOURED : NODE_VECTORS_BARE;
    unsigned limit = (unsigned)(capacity / (4 * sizeof(uint32_t) * (size_t)stack->node_vectors));
    stack->heads = gpu_buffer_acquire(f->g, pixels * sizeof(uint32_t));
    stack->list = gpu_buffer_acquire(f->g, capacity);
    stack->counter = gpu_buffer_acquire(f->g, 64);
    gpu_buffer_fill(f->g, stack->heads, 0, pixels * sizeof(uint32_t));
    gpu_buffer_fill(f->g, stack->counter, 0, 64);
    bind_buffers(f, stack);
    if (!gpu_failed(f->g))
        raster_lists(f, stack, stack->node_vectors, limit);
    gpu_buffer_barrier(f->g);
    uint32_t wanted = 0;
    gpu_buffer_read(f->g, stack->counter, sizeof wanted, &wanted);
    watch_stop(&f->profile, w, "layers", "lists");
    return wanted <= limit || gpu_failed(f->g) ? 1 : (int)((wanted + (limit - 1)) / limit);
}

/* One figure that asks for it is enough: they are sorted together. */
static bool settles_ties(const layer_stack *stack)
{
    bool settles = false;
    for (int i = 0; i < stack->count; i++)
        settles = settles || stack->states[i].figure->layering.settle_ties;
    return settles;
}

/* A round settles nothing about its last one, so that it has one more than are wanted. */
static int kept_of(const layer_stack *stack)
{
    int wanted = stack->limit + (settles_ties(stack) ? 1 : 0);
    return wanted < KEPT_MAX ? wanted : KEPT_MAX;
}

/* The next round of layers: their nodes. */
static void sort_round(frame *f, layer_stack *stack, bool follows)
{
    stopwatch w = watch_start(&f->profile);
    int       kept = kept_of(stack), pictures = kept > 4 ? 2 : 1;
    text      prelude = {0};
    text_append(&prelude, "#define NODE_VECTORS %d\n#define KEPT %d\n#define LAST %c\n%s%s", stack->node_vectors, kept,
                "xyzw"[(kept - 1) % 4], follows ? "#define FOLLOWS\n" : "",
                settles_ties(stack) ? "#define SETTLES_TIES\n" : "");
    gpu_program *p = program_of(f, GPU_FAST, "gpu/screen.vert", "layer/list_sort.frag", &prelude);
    gpu_texture *fresh[2] = {0};
    gpu_pass     pass = {.colour_count = pictures};
    for (int i = 0; i < pictures; i++)
        pass.colours[i] = fresh[i] = gpu_target_acquire(f->g, f->width, f->height, GPU_RGBA32UI);
    memcpy(pass.scissor, stack->around, sizeof pass.scissor);
    if (p && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){0});
        const int *box = stack->around;
        gpu_set_vec4(f->g, "u_list_box", (float[]){(float)box[0], (float)box[1], (float)box[2], (float)box[3]});
        if (follows)
            gpu_set_texture(f->g, "t_last", stack->nodes[pictures - 1], false);
        bind_buffers(f, stack);
        gpu_draw_screen(f->g);
    }
    for (int i = 0; i < 2; i++) {
        gpu_target_release(f->g, stack->nodes[i]);
        stack->nodes[i] = fresh[i];
    }
    watch_stop(&f->profile, w, "layers", "sort");
}

void lists_layer(frame *f, layer_stack *stack, int index)
{
    int kept = kept_of(stack), slot = index % kept;
    if (slot == 0)
        sort_round(f, stack, index > 0);
    stopwatch w = watch_start(&f->profile);
    text      prelude = {0};
    text_append(&prelude, "#define NODE_VECTORS %d\n", stack->node_vectors);
    gpu_pass pass = {0};
    layer_outputs_open(f, stack, &pass, &prelude);
    /* Lines look beyond the layer; every pixel that they can see is written, so that nothing needs to be cleared. */
    pass.clear = f->maps != NULL;
    stack->box_count = tiles_boxes(&stack->tiles, 2 * stack->reach, stack->around, stack->boxes);
    gpu_program *p = program_of(f, GPU_FAST, "gpu/boxes.vert", "layer/list_layer.frag", &prelude);
    if (p && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){.depth_write = true});
        gpu_set_texture(f->g, "t_nodes", stack->nodes[slot / 4], false);
        gpu_set_int(f->g, "u_slot", slot % 4);
        gpu_set_float(f->g, "u_far", (float)f->camera.far);
        gpu_set_vec2(f->g, "u_target", (float)f->width, (float)f->height);
        bind_buffers(f, stack);
        gpu_draw_boxes(f->g, stack->boxes, stack->box_count);
    }
    watch_stop(&f->profile, w, "layers", "fetch");
}
