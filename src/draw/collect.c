/* Maps: what the figures were made of, read back and merged by nearest depth. */
#include "draw/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

lmn_status frame_maps_create(frame_maps *m, int width, int height, lmn_error *error)
{
    size_t count = (size_t)width * (size_t)height;
    *m = (frame_maps){.width = width, .height = height};
    m->depth = mem_alloc(count * sizeof(float));
    m->normal = mem_calloc(count, 3 * sizeof(float));
    m->id = mem_calloc(count, sizeof(uint32_t));
    m->edge = mem_alloc(count * 4 * sizeof(float));
    m->shade = mem_calloc(count, 4 * sizeof(float));
    if (!m->depth || !m->normal || !m->id || !m->edge || !m->shade) {
        frame_maps_release(m);
        return error_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        m->depth[i] = INFINITY;
    for (size_t i = 0; i < count * 4; i++)
        m->edge[i] = 1;
    return LMN_OK;
}

void frame_maps_release(frame_maps *m)
{
    mem_free(m->depth);
    mem_free(m->normal);
    mem_free(m->id);
    mem_free(m->edge);
    mem_free(m->shade);
    memset(m, 0, sizeof *m);
}

/* Takes a figure's pixels where they are the nearest so far; ink outside its boundary darkens what is empty. */
static void merge_maps(frame_maps *m, const float *normal_depth, const uint32_t *id, const float *edge, const float *shade)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    for (size_t i = 0; i < count; i++) {
        bool own = id[2 * i] != 0 && !(id[2 * i + 1] & 0x80000000u);
        bool nearer = own && normal_depth[4 * i + 3] <= m->depth[i];
        if (nearer) {
            m->depth[i] = normal_depth[4 * i + 3];
            m->id[i] = id[2 * i];
            memcpy(&m->normal[3 * i], &normal_depth[4 * i], 3 * sizeof(float));
            memcpy(&m->shade[4 * i], &shade[4 * i], 4 * sizeof(float));
            memcpy(&m->edge[4 * i], &edge[4 * i], 4 * sizeof(float));
        } else if (!own && m->id[i] == 0) {
            for (int k = 0; k < 4; k++)
                m->edge[4 * i + (size_t)k] = fminf(m->edge[4 * i + (size_t)k], edge[4 * i + (size_t)k]);
        }
    }
}

/* Keeps the darkest of the edge maps of a figure with several line techniques. */
void collect_edges(frame *f, figure_state *s)
{
    size_t count = (size_t)f->width * (size_t)f->height * 4;
    float *edge = mem_alloc(count * sizeof(float));
    if (!edge) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    gpu_read(f->g, s->targets[TARGET_EDGE], edge);
    if (!s->edges) {
        s->edges = edge;
        return;
    }
    for (size_t i = 0; i < count; i++)
        s->edges[i] = fminf(s->edges[i], edge[i]);
    mem_free(edge);
}

void collect_figure(frame *f, figure_state *s)
{
    size_t count = (size_t)f->width * (size_t)f->height;
    float *normal_depth = mem_alloc(count * 16), *shade = mem_alloc(count * 16);
    uint32_t *id = mem_alloc(count * 8);
    if (!s->edges && (s->edges = mem_alloc(count * 16)))
        for (size_t i = 0; i < count * 4; i++)
            s->edges[i] = 1;
    if (normal_depth && s->edges && shade && id) {
        gpu_read(f->g, s->targets[TARGET_NORMAL_DEPTH], normal_depth);
        gpu_read(f->g, s->targets[TARGET_ID], id);
        gpu_read(f->g, s->targets[TARGET_SHADE], shade);
        if (!gpu_failed(f->g))
            merge_maps(f->maps, normal_depth, id, s->edges, shade);
    } else {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    }
    mem_free(normal_depth);
    mem_free(shade);
    mem_free(id);
}
