/* Maps: what the figures were made of, read back and merged by nearest depth. */
#include "frame/merge.h"

#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/memory.h"
#include "layer/layer.h"

lmn_status frame_maps_create(frame_maps *m, int width, int height, bool whole, lmn_error *error)
{
    size_t count = (size_t)width * (size_t)height;
    *m = (frame_maps){.width = width, .height = height, .whole = whole};
    m->depth = mem_alloc(count * sizeof(float));
    m->id = mem_calloc(count, sizeof(uint32_t));
    if (whole) {
        m->normal = mem_calloc(count, 3 * sizeof(float));
        m->edge = mem_alloc(count * 4 * sizeof(float));
        m->shade = mem_calloc(count, 4 * sizeof(float));
    }
    if (!m->depth || !m->id || (whole && (!m->normal || !m->edge || !m->shade))) {
        frame_maps_release(m);
        return error_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        m->depth[i] = INFINITY;
    for (size_t i = 0; whole && i < count * 4; i++)
        m->edge[i] = 1;
    return LMN_OK;
}

lmn_status frame_maps_create_pixel(frame_maps *m, int x, int y, lmn_error *error)
{
    lmn_status status = frame_maps_create(m, 1, 1, false, error);
    m->x = x;
    m->y = y;
    m->part = true;
    m->normal = status == LMN_OK ? mem_calloc(3, sizeof(float)) : NULL;
    if (status != LMN_OK || m->normal)
        return status;
    frame_maps_release(m);
    return error_memory(error);
}

static void release_layers(layer_maps *l)
{
    for (size_t i = 0; i < l->count; i++)
        mem_free(l->items[i]);
    mem_free(l->items);
}

void frame_maps_release(frame_maps *m)
{
    mem_free(m->depth);
    mem_free(m->normal);
    mem_free(m->id);
    mem_free(m->edge);
    mem_free(m->shade);
    mem_free(m->uncertainty);
    mem_free(m->direction);
    mem_free(m->velocity);
    release_layers(&m->layers);
    release_layers(&m->perturbed);
    release_layers(&m->perturbed_layers);
    memset(m, 0, sizeof *m);
}

/* Does the pixel belong to this figure, and not to another one that is there for its edges or shares the layers? */
static bool is_own(const figure_state *s, const uint32_t id[2])
{
    if (id[0] == 0 || id[1] & SURFACE_COMPLEMENT)
        return false;
    return !s->shared || (id[1] >> SURFACE_INDEX_BITS & FIGURES_TOGETHER_MAX) == (uint32_t)s->index;
}

/* What was read back of a figure or of one layer of it. */
typedef struct readings {
    float    *normal_depth, *shade, *edge, *velocity; /* 4 a pixel; velocity may be NULL */
    uint32_t *id;                                     /* 2 a pixel */
} readings;

/* Takes a figure's pixels where they are the nearest so far; ink outside its boundary darkens what is empty. */
static void merge_maps(frame_maps *m, const figure_state *s, const readings *r)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    for (size_t i = 0; i < count; i++) {
        bool own = is_own(s, &r->id[2 * i]);
        bool nearer = own && r->normal_depth[4 * i + 3] <= m->depth[i];
        if (nearer) {
            m->depth[i] = r->normal_depth[4 * i + 3];
            m->id[i] = r->id[2 * i];
            if (m->normal)
                memcpy(&m->normal[3 * i], &r->normal_depth[4 * i], 3 * sizeof(float));
            if (!m->whole)
                continue;
            memcpy(&m->shade[4 * i], &r->shade[4 * i], 4 * sizeof(float));
            memcpy(&m->edge[4 * i], &r->edge[4 * i], 4 * sizeof(float));
            if (r->velocity)
                memcpy(&m->velocity[3 * i], &r->velocity[4 * i], 2 * sizeof(float));
        } else if (m->whole && !own && m->id[i] == 0) {
            for (size_t k = 0; k < 4; k++)
                m->edge[4 * i + k] = fminf(m->edge[4 * i + k], r->edge[4 * i + k]);
        }
    }
}

static uint8_t byte_of(float v)
{
    return v > 0 ? v < 1 ? (uint8_t)lroundf(v * 255) : 255 : 0;
}

/* The same for one layer. */
static void merge_layer(layer_map *layer, size_t count, const figure_state *s, const readings *r)
{
    for (size_t i = 0; i < count; i++) {
        layer_map *m = &layer[i];
        bool       own = is_own(s, &r->id[2 * i]);
        for (size_t k = 0; k < 4; k++) {
            uint8_t edge = byte_of(r->edge[4 * i + k]);
            m->edge[k] = own || edge < m->edge[k] ? edge : m->edge[k];
        }
        if (!own)
            continue;
        m->depth = r->normal_depth[4 * i + 3];
        m->id = r->id[2 * i];
        memcpy(m->normal, &r->normal_depth[4 * i], sizeof m->normal);
        const float *shade = &r->shade[4 * i];
        for (size_t k = 0; k < 3; k++)
            m->shade[k] = byte_of(shade[3] > 0 ? shade[k] / shade[3] : 0);
        m->shade[3] = byte_of(shade[3]);
    }
}

/* Keeps the darkest of the edge maps of a figure with several line techniques. */
void collect_edges(frame *f, figure_state *s)
{
    if (f->maps->on_gpu) {
        merge_edges(f, s);
        return;
    }
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

/* Takes the field over, where no figure before has one. */
void collect_uncertainty(frame *f, figure_state *s)
{
    frame_maps *m = f->maps;
    if (m->on_gpu) {
        merge_uncertainty(f, s);
        return;
    }
    size_t count = (size_t)f->width * (size_t)f->height;
    float *field = mem_alloc(count * 4 * sizeof *field);
    if (!m->uncertainty)
        m->uncertainty = mem_calloc(count, 3 * sizeof *m->uncertainty);
    if (!field || !m->uncertainty) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    } else {
        gpu_read(f->g, s->targets[TARGET_FIELD], field);
        for (size_t i = 0; i < count; i++) {
            float *own = &m->uncertainty[3 * i];
            if (own[0] == 0 && own[1] == 0 && own[2] == 0)
                memcpy(own, &field[4 * i], 3 * sizeof *own);
        }
    }
    mem_free(field);
}

void collect_direction(frame *f, figure_state *s)
{
    frame_maps *m = f->maps;
    if (m->on_gpu)
        merge_direction(f, s);
    if (m->on_gpu || !m->whole)
        return;
    int columns = gpu_texture_width(s->targets[TARGET_DIRECTION]),
        rows = (f->height + DIRECTION_APART - 1) / DIRECTION_APART;
    float *coarse = mem_alloc((size_t)columns * (size_t)rows * 4 * sizeof *coarse);
    if (!m->direction)
        m->direction = mem_calloc((size_t)f->width * (size_t)f->height, 3 * sizeof *m->direction);
    if (!coarse || !m->direction) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        mem_free(coarse);
        return;
    }
    gpu_read(f->g, s->targets[TARGET_DIRECTION], coarse);
    for (size_t y = 0; y < (size_t)f->height; y++)
        for (size_t x = 0; x < (size_t)f->width; x++) {
            const float *from = &coarse[4 * (y / DIRECTION_APART * (size_t)columns + x / DIRECTION_APART)];
            if (from[3] > 0)
                memcpy(&m->direction[3 * (y * (size_t)f->width + x)], from, 2 * sizeof *from);
        }
    mem_free(coarse);
}

layer_map *collect_layer_of(frame *f, layer_maps *m, size_t index)
{
    size_t count = (size_t)f->width * (size_t)f->height;
    while (m->count <= index && !gpu_failed(f->g)) {
        layer_map *layer = mem_calloc(count, sizeof *layer);
        if (!layer || !mem_grow((void **)&m->items, &m->capacity, m->count + 1, sizeof *m->items)) {
            mem_free(layer);
            gpu_fail(f->g, LMN_MEMORY, "out of memory");
            return NULL;
        }
        for (size_t i = 0; i < count; i++) {
            layer[i].depth = INFINITY;
            memset(layer[i].edge, 255, sizeof layer[i].edge);
        }
        m->items[m->count++] = layer;
    }
    return gpu_failed(f->g) ? NULL : m->items[index];
}

/* Reads velocities where there are any; false when memory is gone. */
static bool read_velocity(frame *f, const figure_state *s, readings *r)
{
    frame_maps *m = f->maps;
    size_t      count = (size_t)f->width * (size_t)f->height;
    if (!m->whole || !s->targets[TARGET_VELOCITY])
        return true;
    if (!m->velocity)
        m->velocity = mem_calloc(count, 3 * sizeof *m->velocity);
    r->velocity = mem_alloc(count * 16);
    if (m->velocity && r->velocity)
        gpu_read(f->g, s->targets[TARGET_VELOCITY], r->velocity);
    return m->velocity && r->velocity;
}

/* Reads the figure's pictures and merges them, into a layer's map too when the figure has several. */
static void collect(frame *f, figure_state *s, bool layered)
{
    const frame_maps *m = f->maps;
    const int         box[4] = {m->x, m->y, m->width, m->height};
    size_t            count = (size_t)m->width * (size_t)m->height;
    bool              whole = m->whole;
    readings          r = {.normal_depth = mem_alloc(count * 16), .id = mem_alloc(count * 8), .edge = s->edges};
    if (whole) {
        r.shade = mem_alloc(count * 16);
        if (!r.edge && (r.edge = s->edges = mem_alloc(count * 16)))
            for (size_t i = 0; i < count * 4; i++)
                r.edge[i] = 1;
    }
    if (r.normal_depth && r.id && (!whole || (r.edge && r.shade)) && read_velocity(f, s, &r)) {
        gpu_read_box(f->g, s->targets[TARGET_NORMAL_DEPTH], box, r.normal_depth);
        gpu_read_box(f->g, s->targets[TARGET_ID], box, r.id);
        if (whole)
            gpu_read(f->g, s->targets[TARGET_SHADE], r.shade);
        if (!gpu_failed(f->g) && (!layered || s->layer == 0))
            merge_maps(f->maps, s, &r);
        layer_map *layer = layered && whole ? collect_layer_of(f, &f->maps->layers, (size_t)s->layer) : NULL;
        if (layer)
            merge_layer(layer, count, s, &r);
        if (whole && !gpu_failed(f->g))
            collect_perturbed(f, s, r.edge, layered);
    } else {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    }
    mem_free(r.normal_depth);
    mem_free(r.shade);
    mem_free(r.velocity);
    mem_free(r.id);
}

void collect_figure(frame *f, figure_state *s)
{
    if (f->maps->on_gpu)
        merge_figure(f, s);
    else
        collect(f, s, false);
}

void collect_layer(frame *f, figure_state *s)
{
    if (f->maps->on_gpu && s->layer == 0)
        merge_figure(f, s);
    else if (f->maps->on_gpu)
        merge_layer_edges_end(f);
    else
        collect(f, s, true);
    mem_free(s->edges);
    s->edges = NULL;
}
