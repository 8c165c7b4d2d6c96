/* Maps of what compositions find: where something is perturbed, lines and fill are looked up beside the pixel, and the
 * nearer of them is how deep it is. Of every layer, and of what is nearest. Nienhaus et al. 2006, figure 4 b to d. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

static bool is_perturbed(const plan *p)
{
    for (size_t i = 0; i < p->figure_count; i++)
        if (rule_use(p->figures[i].rule, KIND_PERTURB))
            return true;
    return false;
}

static uint8_t byte_of(float v)
{
    return v > 0 ? v < 1 ? (uint8_t)lroundf(v * 255) : 255 : 0;
}

/* Compositions find one edge map; of several line techniques the darkest of all takes its place. */
static void join_edges(frame *f, figure_state *s, const float *edges)
{
    size_t   count = (size_t)f->width * (size_t)f->height * 4;
    uint8_t *bytes = mem_alloc(count);
    if (!bytes) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    for (size_t i = 0; i < count; i++)
        bytes[i] = byte_of(edges[i]);
    gpu_target_release(f->g, s->targets[TARGET_EDGE]);
    s->targets[TARGET_EDGE] = gpu_target_acquire(f->g, f->width, f->height, GPU_RGBA8);
    gpu_target_write(f->g, s->targets[TARGET_EDGE], (int[]){0, 0, f->width, f->height}, bytes);
    mem_free(bytes);
}

/* Where several figures are, the nearest is kept; where none is, the darkest lines beside them. */
static void merge(layer_map *m, const float edge[4], const float shade[4], float depth)
{
    bool there = depth > 0;
    if (there ? depth > m->depth : isfinite(m->depth))
        return;
    for (size_t k = 0; k < 4; k++) {
        uint8_t own = byte_of(edge[k]);
        m->edge[k] = there || own < m->edge[k] ? own : m->edge[k];
    }
    if (!there)
        return;
    m->depth = depth;
    for (size_t k = 0; k < 3; k++)
        m->shade[k] = byte_of(shade[3] > 0 ? shade[k] / shade[3] : 0);
    m->shade[3] = byte_of(shade[3]);
}

void collect_perturbed(frame *f, figure_state *s, const float *edges, bool layered)
{
    gpu_texture *found[LOOKED_UP] = {NULL};
    float       *values[LOOKED_UP] = {NULL};
    size_t       count = (size_t)f->width * (size_t)f->height;
    bool         there = true;
    if (!is_perturbed(f->plan))
        return;
    if (s->figure->rule->use_counts[KIND_LINES] > 1)
        join_edges(f, s, edges);
    passes_look_up(f, s, found);
    for (int i = 0; i < LOOKED_UP; i++) {
        values[i] = mem_alloc(count * 16);
        there = there && values[i];
        if (there && !gpu_failed(f->g))
            gpu_read(f->g, found[i], values[i]);
        gpu_target_release(f->g, found[i]);
    }
    if (!there)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    layer_map *nearest = !layered || s->layer == 0 ? collect_layer_of(f, &f->maps->perturbed, 0) : NULL;
    layer_map *layer = layered ? collect_layer_of(f, &f->maps->perturbed_layers, (size_t)s->layer) : NULL;
    for (size_t i = 0; i < count && !gpu_failed(f->g); i++) {
        if (nearest)
            merge(&nearest[i], &values[0][4 * i], &values[1][4 * i], values[2][4 * i]);
        if (layer)
            merge(&layer[i], &values[0][4 * i], &values[1][4 * i], values[2][4 * i]);
    }
    for (int i = 0; i < LOOKED_UP; i++)
        mem_free(values[i]);
}
