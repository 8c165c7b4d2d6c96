/* Sections on the GPU: what is left of cut parts, and their cut faces. */
#include "stage/upload_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"

/* Bits of a cut face's surface id, from the lowest: positive side, plane, nearest axis, body (light/cut.glsl). */
enum {
    ID_PLANE_SHIFT = 1,
    ID_AXIS_SHIFT = 6,
    ID_BODY_SHIFT = 8,
    ID_BODY_MASK = (1 << (SURFACE_INDEX_BITS - ID_BODY_SHIFT)) - 1
};

uint32_t cut_face_bits(const cut *c, int32_t plane, uint32_t body, bool positive)
{
    const double *n = c->planes[plane].normal;
    double        x = fabs(n[0]), y = fabs(n[1]), z = fabs(n[2]);
    uint32_t      axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return SURFACE_CUT | (body & ID_BODY_MASK) << ID_BODY_SHIFT | axis << ID_AXIS_SHIFT |
           (uint32_t)plane << ID_PLANE_SHIFT | (uint32_t)positive;
}

/* --- what cutting reads --------------------------------------------------------------------------------- */

static lmn_status open_input(upload_part_job *job, size_t i, lmn_error *error)
{
    const primitive *p = &job->mesh->primitives[i];
    const part_pose *pose = job->pose;
    const vec3      *positions = p->positions;
    if (pose_deforms(pose, p)) {
        vec3 *moved = job->input_positions[i] = mem_alloc(p->vertex_count * sizeof *moved);
        if (!moved)
            return error_memory(error);
        pose_vertices(pose, p, NULL, NULL, p->vertex_count, moved, NULL);
        for (uint32_t k = 0; k < p->vertex_count; k++)
            job->box = box3_with_point(job->box, moved[k]);
        positions = moved;
    } else {
        job->box = box3_union(job->box, p->bounds);
    }
    job->inputs[i] = (cut_input){positions, p->vertex_count, p->indices, p->index_count};
    return LMN_OK;
}

/* Once for all instances. */
static lmn_status open_inputs(upload_part_job *job, lmn_error *error)
{
    size_t count = job->mesh->primitive_count;
    if (job->inputs)
        return LMN_OK;
    job->box = box3_empty();
    job->inputs = mem_calloc(count, sizeof *job->inputs);
    job->input_positions = mem_calloc(count, sizeof *job->input_positions);
    job->posed = mem_calloc(count, sizeof *job->posed);
    lmn_status status = job->inputs && job->input_positions && job->posed ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        status = open_input(job, i, error);
    return status;
}

void upload_part_close(upload_part_job *job)
{
    for (size_t i = 0; i < job->mesh->primitive_count; i++) {
        if (job->input_positions)
            mem_free(job->input_positions[i]);
        if (job->posed)
            posed_release(&job->posed[i]);
    }
    mem_free(job->inputs);
    mem_free(job->input_positions);
    mem_free(job->posed);
}

/* --- surfaces ------------------------------------------------------------------------------------------- */

/* An attribute with new vertices behind the old ones; NULL when there is none or memory is gone. */
static float *extend(const vertex_arrays *from, const float *values, size_t width, const cut_surface *s, bool *done)
{
    if (!values)
        return NULL;
    float *out = mem_alloc((from->vertex_count + s->corner_count) * width * sizeof *out);
    *done = *done && out;
    if (!out)
        return NULL;
    memcpy(out, values, from->vertex_count * width * sizeof *out);
    for (size_t i = 0; i < s->corner_count; i++) {
        const cut_corner *c = &s->corners[i];
        const uint32_t   *t = &from->indices[3 * c->triangle];
        float            *at = out + (from->vertex_count + i) * width;
        for (size_t k = 0; k < width; k++)
            at[k] = c->weights[0] * values[t[0] * width + k] + c->weights[1] * values[t[1] * width + k] +
                    c->weights[2] * values[t[2] * width + k];
    }
    return out;
}

/* Blended normals are shorter; where they cancel, the nearest corner's serves. */
static void mend_normals(float *normals, const vertex_arrays *from, const cut_surface *s)
{
    for (size_t i = 0; i < s->corner_count; i++) {
        float *n = normals + 3 * (from->vertex_count + i);
        float  length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (length > 1e-4f) {
            for (int k = 0; k < 3; k++)
                n[k] /= length;
            continue;
        }
        const float *w = s->corners[i].weights;
        int          nearest = w[0] >= w[1] ? (w[0] >= w[2] ? 0 : 2) : (w[1] >= w[2] ? 1 : 2);
        memcpy(n, from->normals + 3 * from->indices[3 * s->corners[i].triangle + (uint32_t)nearest], 3 * sizeof *n);
    }
}

/* Where the pieces of a bent part were earlier: data->past, the caller's to free. */
static lmn_status add_past(const upload *u, const upload_part_job *job, size_t i, const cut_surface *s,
                           gpu_mesh_data *data, lmn_error *error)
{
    const primitive *p = &job->mesh->primitives[i];
    bool             done = true;
    for (int k = 0; k < u->past_count && pose_deforms(job->pose, p) && done; k++) {
        vec3 *was = posed_positions(p, &u->pose->past[k]->parts[job->part_index], &job->posed[i].split);
        data->past[k] = was ? extend(&job->posed[i].data, (const float *)was, 3, s, &done) : NULL;
        done = done && was;
        mem_free(was);
    }
    return done ? LMN_OK : error_memory(error);
}

static lmn_status add_surface(upload *u, gpu *g, upload_part_job *job, size_t i, const cut_surface *s,
                              const mat4 *world, lmn_error *error)
{
    lmn_status status = LMN_OK;
    if (s->whole_count + s->corner_count == 0)
        return LMN_OK;
    posed_mesh *posed = &job->posed[i];
    if (!posed->data.positions)
        status = posed_make(posed, &job->mesh->primitives[i], u->crease_angle, job->pose, error);
    if (status != LMN_OK)
        return status;
    const vertex_arrays *from = &posed->data;
    bool                 done = true;
    float *positions = extend(from, from->positions, 3, s, &done), *normals = extend(from, from->normals, 3, s, &done);
    float *uvs[2] = {extend(from, from->uvs[0], 2, s, &done), extend(from, from->uvs[1], 2, s, &done)};
    float *colours = extend(from, from->colours, 4, s, &done);
    size_t count = 3 * s->whole_count + s->corner_count;
    uint32_t *indices = mem_alloc(count * sizeof *indices);
    if (!done || !indices) {
        status = error_memory(error);
    } else {
        mend_normals(normals, from, s);
        for (size_t k = 0; k < s->corner_count; k++) {
            memcpy(positions + 3 * (from->vertex_count + k), &s->corners[k].position, sizeof(vec3));
            indices[3 * s->whole_count + k] = from->vertex_count + (uint32_t)k;
        }
        for (size_t k = 0; k < s->whole_count; k++)
            memcpy(indices + 3 * k, from->indices + 3 * s->whole[k], 3 * sizeof *indices);
        gpu_mesh_data data = {.vertex_count = from->vertex_count + (uint32_t)s->corner_count,
                              .index_count = (uint32_t)count,
                              .positions = positions,
                              .normals = normals,
                              .uvs = {uvs[0], uvs[1]},
                              .colours = colours,
                              .indices = indices};
        draw_item     item = upload_item(job, i);
        item.world = *world;
        upload_set_past(u, &item, job->instance);
        status = add_past(u, job, i, s, &data, error);
        if (status == LMN_OK)
            status = upload_glue(u, &data, error);
        if (status == LMN_OK)
            status = upload_add_piece(u, g, &item.mesh, &data, error);
        mem_free((void *)(uintptr_t)data.glue);
        for (int k = 0; k < POSE_PAST_MAX; k++)
            mem_free((void *)(uintptr_t)data.past[k]);
        u->triangles += count / 3;
        if (status == LMN_OK && !upload_add_item(u, &item))
            status = error_memory(error);
    }
    mem_free(positions);
    mem_free(normals);
    mem_free(uvs[0]);
    mem_free(uvs[1]);
    mem_free(colours);
    mem_free(indices);
    return status;
}

/* --- cut faces ------------------------------------------------------------------------------------------ */

static lmn_status add_cap(upload *u, gpu *g, upload_part_job *job, const cut_cap *cap, const mat4 *world,
                          lmn_error *error)
{
    vec3      *normals = mem_alloc(cap->count * sizeof *normals);
    uint32_t  *indices = mem_alloc(cap->count * sizeof *indices);
    lmn_status status = normals && indices ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < cap->count && status == LMN_OK; i++) {
        normals[i] = cap->normal;
        indices[i] = (uint32_t)i;
    }
    gpu_mesh_data data = {.vertex_count = (uint32_t)cap->count,
                          .index_count = (uint32_t)cap->count,
                          .positions = (const float *)cap->positions,
                          .normals = (const float *)normals,
                          .indices = indices};
    draw_item     item = upload_item(job, cap->primitive);
    item.world = *world;
    upload_set_past(u, &item, job->instance);
    item.is_cut = true;
    item.nearer = job->nearer;
    item.has_uvs = item.has_colours = false;
    item.surface_id = cut_face_bits(&u->section.cut, cap->plane, cap->body, cap->positive);
    if (status == LMN_OK)
        status = upload_add_piece(u, g, &item.mesh, &data, error);
    u->triangles += cap->count / 3;
    if (status == LMN_OK && !upload_add_item(u, &item))
        status = error_memory(error);
    mem_free(normals);
    mem_free(indices);
    return status;
}

lmn_status upload_cut(upload *u, gpu *g, upload_part_job *job, const mat4 *world, cut_verdict *verdict,
                      lmn_error *error)
{
    const cut *c = &u->section.cut;
    *verdict = CUT_WHOLE;
    if (c->cell_count == 0)
        return LMN_OK;
    lmn_status status = open_inputs(job, error);
    if (status != LMN_OK)
        return status;
    *verdict = cut_judge_box(c, box3_transform(job->box, world));
    /* What stays whole goes all the same where it lies in what is cut away. */
    if (*verdict == CUT_CROSSED && u->section.spared && u->section.spared[job->part_index])
        *verdict = CUT_WHOLE;
    if (*verdict != CUT_CROSSED)
        return LMN_OK;
    cut_result r;
    status = cut_part(&r, c, world, job->inputs, job->mesh->primitive_count, error);
    *verdict = r.verdict;
    if (status == LMN_OK && r.verdict == CUT_CROSSED) {
        for (size_t i = 0; i < r.surface_count && status == LMN_OK; i++)
            status = add_surface(u, g, job, i, &r.surfaces[i], world, error);
        for (size_t i = 0; i < r.cap_count && status == LMN_OK; i++)
            status = add_cap(u, g, job, &r.caps[i], world, error);
        u->open_parts += r.open && !job->open;
        job->open = job->open || r.open;
    }
    cut_result_release(&r);
    return status;
}
