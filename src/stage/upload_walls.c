/* Meshes whose vertices know where on a wall they are: what facades are laid out by. */
#include "stage/upload_private.h"

#include <math.h>

#include "base/memory.h"
#include "field/walls.h"

/* Four numbers a vertex: where it lies on its wall, the wall's length and the height of its eaves. */
static float (*numbers_of(const wall_mesh *m))[4]
{
    float(*out)[4] = mem_calloc(m->vertex_count, sizeof *out);
    for (uint32_t i = 0; out && i < m->vertex_count; i++)
        for (int k = 0; k < 2; k++) {
            out[i][k] = m->at[i][k];
            out[i][2 + k] = m->extent[i][k];
        }
    return out;
}

static bool split(upload_walls *out, const wall_mesh *m, const vertex_arrays *from)
{
    out->positions = posed_gather(from->positions, m->source, m->vertex_count, 3 * sizeof(float));
    out->normals = posed_gather(from->normals, m->source, m->vertex_count, 3 * sizeof(float));
    out->colours = posed_gather(from->colours, m->source, m->vertex_count, 4 * sizeof(float));
    bool done = out->positions && (out->normals || !from->normals) && (out->colours || !from->colours);
    for (int i = 0; i < UV_SETS; i++) {
        out->uvs[i] = posed_gather(from->uvs[i], m->source, m->vertex_count, 2 * sizeof(float));
        done = done && (out->uvs[i] || !from->uvs[i]);
    }
    out->data = (vertex_arrays){.vertex_count = m->vertex_count,
                                .index_count = m->index_count,
                                .positions = out->positions,
                                .normals = out->normals,
                                .uvs = {out->uvs[0], out->uvs[1]},
                                .colours = out->colours,
                                .indices = m->indices};
    return done;
}

/* The lowest of what a projection has bent, before it did. */
static vec3 lowest(const vec3 *straight, uint32_t count)
{
    vec3 low = {INFINITY, INFINITY, INFINITY};
    for (uint32_t i = 0; i < count; i++)
        low = (vec3){fminf(low.x, straight[i].x), fminf(low.y, straight[i].y), fminf(low.z, straight[i].z)};
    return low;
}

lmn_status upload_find_walls(upload_walls *out, const upload *u, const upload_part_job *job, const upload_vertices *v,
                             lmn_error *error)
{
    const vertex_arrays *data = v->now;
    primitive            p = {.vertex_count = data->vertex_count,
                              .index_count = data->index_count,
                              .positions = v->straight ? (vec3 *)(uintptr_t)v->straight : (vec3 *)(uintptr_t)data->positions,
                              .indices = (uint32_t *)(uintptr_t)data->indices};
    const lmn_scene     *scene = u->pose->scene;
    int                  up = scene->up == 'z' ? 2 : 1;
    vec3                 low = u->pose->part_boxes[job->part_index].min;
    mat4                 world = pose_instance(u->pose, job->part_index, job->instance);
    if (v->straight) {
        low = lowest(v->straight, data->vertex_count);
        world = mat4_identity();
    }
    wall_mesh  made;
    lmn_status status = wall_mesh_make(&made, &p, &world, up, (double)(up == 2 ? low.z : low.y), error);
    if (status == LMN_OK) {
        out->numbers = numbers_of(&made);
        if (!split(out, &made, data) || !out->numbers)
            status = error_memory(error);
        out->indices = made.indices;
        made.indices = NULL;
    }
    wall_mesh_release(&made);
    return status;
}

void upload_walls_release(upload_walls *w)
{
    mem_free(w->positions);
    mem_free(w->normals);
    mem_free(w->colours);
    for (int i = 0; i < UV_SETS; i++)
        mem_free(w->uvs[i]);
    mem_free(w->indices);
    mem_free(w->numbers);
    *w = (upload_walls){.indices = NULL};
}
