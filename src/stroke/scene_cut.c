#include "stroke/scene_cut.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

edge_cap scene_cut_cap(const cut *c, int32_t plane, uint32_t body)
{
    const cut_plane *p = &c->planes[plane];
    double           x = fabs(p->normal[0]), y = fabs(p->normal[1]), z = fabs(p->normal[2]);
    edge_cap         out = {x >= y && x >= z ? 0 : y >= z ? 1 : 2, body, {0, 0, 0}, p->offset};
    memcpy(out.normal, p->normal, sizeof out.normal);
    return out;
}

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

/* Where a cut face meets what it closes, there is a line however flat they meet: it has a material of its own. */
static bool take_cap(primitive *out, const cut_cap *cap, size_t number)
{
    *out = (primitive){.vertex_count = (uint32_t)cap->count,
                       .index_count = (uint32_t)cap->count,
                       .material = EDGE_CAP_MATERIAL(number)};
    out->positions = mem_copy(cap->positions, cap->count * sizeof *out->positions);
    out->indices = mem_alloc((cap->count + 1) * sizeof *out->indices);
    for (uint32_t i = 0; out->indices && i < cap->count; i++)
        out->indices[i] = i;
    return out->positions && out->indices;
}

/* --- lines ----------------------------------------------------------------------------------------------- */

static double height_over(const cut_plane *plane, const double p[3])
{
    return plane->normal[0] * p[0] + plane->normal[1] * p[1] + plane->normal[2] * p[2] - plane->offset;
}

/* The part of a line that lies in a cell. */
static bool find_inside(const cut *c, const cut_cell *cell, const double p[3], const double q[3], double inside[2])
{
    inside[0] = 0;
    inside[1] = 1;
    for (int i = 0; i < cell->count; i++) {
        const cut_plane *plane = &c->planes[cell->faces[i].plane];
        double           sign = cell->faces[i].positive ? 1 : -1, from = sign * height_over(plane, p),
               to = sign * height_over(plane, q);
        if (from <= c->snap && to <= c->snap) /* what lies in the plane stays */
            return false;
        if (from < 0)
            inside[0] = fmax(inside[0], from / (from - to));
        else if (to < 0)
            inside[1] = fmin(inside[1], from / (from - to));
    }
    return inside[0] < inside[1];
}

typedef struct line_cutter {
    const cut  *c;
    const mat4 *world;
    const vec3 *positions; /* of the primitive that is cut */
    primitive  *out;
    size_t      position_capacity, line_capacity;
    bool        changed;
} line_cutter;

static void to_world(const mat4 *m, vec3 p, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * p.x + m->m[4 + k] * p.y + m->m[8 + k] * p.z + m->m[12 + k];
}

/* Ends that stay are bit by bit what they were, so that lines still meet there. */
static bool put_stretch(line_cutter *w, vec3 p, vec3 q, double from, double to)
{
    primitive *out = w->out;
    if (!mem_grow((void **)&out->positions, &w->position_capacity, out->vertex_count + 2, sizeof *out->positions) ||
        !mem_grow((void **)&out->lines, &w->line_capacity, 2 * ((size_t)out->line_count + 1), sizeof *out->lines))
        return false;
    const double at[2] = {from, to};
    for (int k = 0; k < 2; k++) {
        double t = at[k];
        vec3   between = {(float)(p.x + t * ((double)q.x - p.x)), (float)(p.y + t * ((double)q.y - p.y)),
                          (float)(p.z + t * ((double)q.z - p.z))};
        out->lines[2 * out->line_count + (uint32_t)k] = out->vertex_count;
        out->positions[out->vertex_count++] = t <= 0 ? p : t >= 1 ? q : between;
    }
    out->line_count++;
    return true;
}

/* What no cell takes away, from one end to the other. */
static bool cut_line(line_cutter *w, vec3 p, vec3 q)
{
    double a[3], b[3], inside[CUT_CELLS_MAX][2], at = 0;
    int    count = 0;
    to_world(w->world, p, a);
    to_world(w->world, q, b);
    for (int i = 0; i < w->c->cell_count; i++)
        count += find_inside(w->c, &w->c->cells[i], a, b, inside[count]);
    w->changed = w->changed || count;
    for (;;) {
        double next = 1, after = at;
        for (int i = 0; i < count; i++) {
            if (inside[i][0] <= at)
                after = fmax(after, inside[i][1]);
            else
                next = fmin(next, inside[i][0]);
        }
        if (after > at) {
            at = after;
            if (at >= 1)
                return true;
            continue;
        }
        if (!put_stretch(w, p, q, at, next))
            return false;
        if (next >= 1)
            return true;
        at = next;
    }
}

/* What is left of the lines of all primitives. */
static bool cut_lines(line_cutter *w, const mesh *m, const vec3 *positions)
{
    bool good = true;
    for (size_t i = 0; i < m->primitive_count; positions += m->primitives[i++].vertex_count)
        for (uint32_t k = 0; k < m->primitives[i].line_count && good; k++) {
            const uint32_t *l = &m->primitives[i].lines[2 * k];
            good = cut_line(w, positions[l[0]], positions[l[1]]);
        }
    return good;
}

/* --- all ------------------------------------------------------------------------------------------------- */

/* A surface that no plane meets. */
static bool take_whole(primitive *out, const primitive *from, const vec3 *positions)
{
    *out =
        (primitive){.vertex_count = from->vertex_count, .index_count = from->index_count, .material = from->material};
    out->positions = mem_copy(positions, from->vertex_count * sizeof *positions);
    out->indices = mem_copy(from->indices, from->index_count * sizeof *from->indices);
    return out->positions && out->indices;
}

/* There is room for all. */
static bool take_result(mesh *out, const mesh *m, const vec3 *positions, const cut_result *r)
{
    bool good = out->primitives != NULL;
    for (size_t i = 0; i < m->primitive_count && good; positions += m->primitives[i++].vertex_count) {
        const primitive *from = &m->primitives[i];
        if (from->index_count == 0 || r->verdict == CUT_GONE)
            continue;
        primitive *p = &out->primitives[out->primitive_count++];
        good = r->verdict == CUT_WHOLE ? take_whole(p, from, positions)
                                       : take_surface(p, from, positions, &r->surfaces[i]);
    }
    for (size_t i = 0; i < r->cap_count && good; i++)
        good = take_cap(&out->primitives[out->primitive_count++], &r->caps[i], i);
    return good;
}

/* Of surfaces and lines together. */
static cut_verdict judge(cut_result *r, uint64_t triangles, const line_cutter *lines)
{
    if (triangles == 0)
        r->verdict = lines->changed ? CUT_GONE : CUT_WHOLE;
    if (r->verdict == CUT_WHOLE)
        return lines->changed ? CUT_CROSSED : CUT_WHOLE;
    return r->verdict == CUT_GONE && lines->out->line_count ? CUT_CROSSED : r->verdict;
}

static bool keep_caps(edge_mesh *out, const cut_result *r, const cut *c)
{
    out->caps = mem_alloc((r->cap_count + 1) * sizeof *out->caps);
    for (size_t i = 0; i < r->cap_count && out->caps; i++)
        out->caps[out->cap_count++] = scene_cut_cap(c, r->caps[i].plane, r->caps[i].body);
    return out->caps != NULL;
}

lmn_status scene_cut_mesh(edge_mesh *out, cut_verdict *verdict, bool *open, const mesh *m, const vec3 *positions,
                          const cut *c, const mat4 *world, double crease_angle, lmn_error *error)
{
    cut_result  r;
    lmn_status  status = cut_inputs(&r, m, positions, c, world, error);
    primitive   lines = {.material = NONE};
    line_cutter cutter = {.c = c, .world = world, .out = &lines};
    if (status == LMN_OK && !cut_lines(&cutter, m, positions))
        status = error_memory(error);
    *open = r.open;
    *verdict = status == LMN_OK ? judge(&r, mesh_triangle_count(m), &cutter) : CUT_GONE;
    if (*verdict == CUT_CROSSED) {
        mesh left = {.primitives = mem_calloc(m->primitive_count + r.cap_count + 1, sizeof *left.primitives)};
        bool good = take_result(&left, m, positions, &r);
        if (good && lines.line_count) {
            left.primitives[left.primitive_count++] = lines;
            lines = (primitive){.material = NONE};
        }
        status = good ? edge_mesh_create(out, &left, NULL, crease_angle, error) : error_memory(error);
        mesh_release(&left);
        if (status == LMN_OK && !keep_caps(out, &r, c)) {
            edge_mesh_release(out);
            status = error_memory(error);
        }
    }
    primitive_release(&lines);
    cut_result_release(&r);
    return status;
}
