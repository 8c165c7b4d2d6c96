#include "stroke/scene_cut.h"

#include <string.h>

#include "base/memory.h"

/* No material of any file: where a cut face meets what it closes, there is a line however flat they meet. */
enum { CUT_MATERIAL = -2 };

static lmn_status cut_inputs(cut_result *out, const mesh *m, const vec3 *positions, const cut *c, const mat4 *world,
                             lmn_error *error)
{
    cut_input *inputs = mem_alloc((m->primitive_count + 1) * sizeof *inputs);
    memset(out, 0, sizeof *out);
    for (size_t i = 0; inputs && i < m->primitive_count; positions += m->primitives[i++].vertex_count)
        inputs[i] = (cut_input){positions, m->primitives[i].vertex_count, m->primitives[i].indices,
                                m->primitives[i].index_count};
    lmn_status status = inputs ? cut_part(out, c, world, inputs, m->primitive_count, error) : error_memory(error);
    mem_free(inputs);
    return status;
}

/* The triangles that stay as they are, and those that were made of others. */
static bool take_surface(primitive *out, const primitive *from, const vec3 *positions, const cut_surface *s)
{
    *out = (primitive){.vertex_count = from->vertex_count + (uint32_t)s->corner_count,
                       .index_count = (uint32_t)(3 * s->whole_count + s->corner_count),
                       .material = from->material};
    out->positions = mem_alloc(((size_t)out->vertex_count + 1) * sizeof *out->positions);
    out->indices = mem_alloc(((size_t)out->index_count + 1) * sizeof *out->indices);
    if (!out->positions || !out->indices)
        return false;
    memcpy(out->positions, positions, from->vertex_count * sizeof *positions);
    for (size_t k = 0; k < s->whole_count; k++)
        memcpy(out->indices + 3 * k, from->indices + 3 * (size_t)s->whole[k], 3 * sizeof *out->indices);
    for (uint32_t k = 0; k < s->corner_count; k++) {
        out->positions[from->vertex_count + k] = s->corners[k].position;
        out->indices[3 * s->whole_count + k] = from->vertex_count + k;
    }
    return true;
}

static bool take_cap(primitive *out, const cut_cap *cap)
{
    *out = (primitive){
        .vertex_count = (uint32_t)cap->count, .index_count = (uint32_t)cap->count, .material = CUT_MATERIAL};
    out->positions = mem_copy(cap->positions, cap->count * sizeof *out->positions);
    out->indices = mem_alloc((cap->count + 1) * sizeof *out->indices);
    for (uint32_t i = 0; out->indices && i < cap->count; i++)
        out->indices[i] = i;
    return out->positions && out->indices;
}

static bool take_result(mesh *out, const mesh *m, const vec3 *positions, const cut_result *r)
{
    bool good = out->primitives != NULL;
    for (size_t i = 0; i < r->surface_count && good; positions += m->primitives[i++].vertex_count)
        good = take_surface(&out->primitives[i], &m->primitives[i], positions, &r->surfaces[i]);
    for (size_t i = 0; i < r->cap_count && good; i++)
        good = take_cap(&out->primitives[r->surface_count + i], &r->caps[i]);
    return good;
}

lmn_status scene_cut_mesh(edge_mesh *out, cut_verdict *verdict, const mesh *m, const vec3 *positions, const cut *c,
                          const mat4 *world, double crease_angle, lmn_error *error)
{
    cut_result r;
    lmn_status status = cut_inputs(&r, m, positions, c, world, error);
    *verdict = status == LMN_OK ? r.verdict : CUT_GONE;
    if (status == LMN_OK && r.verdict == CUT_CROSSED) {
        mesh left = {.primitive_count = r.surface_count + r.cap_count};
        left.primitives = mem_calloc(left.primitive_count + 1, sizeof *left.primitives);
        status = take_result(&left, m, positions, &r) ? edge_mesh_create(out, &left, NULL, crease_angle, error)
                                                      : error_memory(error);
        for (size_t i = 0; left.primitives && i < left.primitive_count; i++) {
            mem_free(left.primitives[i].positions);
            mem_free(left.primitives[i].indices);
        }
        mem_free(left.primitives);
    }
    cut_result_release(&r);
    return status;
}
