#include "pose/posed_mesh.h"

#include <string.h>

#include "base/memory.h"

void *posed_gather(const void *source, const uint32_t *map, uint32_t count, size_t size)
{
    if (!source)
        return NULL;
    unsigned char *out = mem_alloc((size_t)count * size);
    for (uint32_t i = 0; out && i < count; i++)
        memcpy(out + (size_t)i * size, (const unsigned char *)source + (size_t)map[i] * size, size);
    return out;
}

void posed_release(posed_mesh *m)
{
    mem_free(m->positions);
    mem_free(m->normals);
    for (int i = 0; i < UV_SETS; i++)
        mem_free(m->uvs[i]);
    mem_free(m->colours);
    render_vertices_release(&m->split);
    memset(m, 0, sizeof *m);
}

/* What is posed already because the part's box was made of it is borrowed. */
static bool deform(posed_mesh *out, const primitive *p, const part_pose *pose)
{
    const posed_vertices *known = pose_vertices_of(pose, p);
    vertex_arrays        *data = &out->data;
    if (known) {
        data->positions = (const float *)known->positions;
        data->normals = (const float *)known->normals;
        return true;
    }
    out->positions = mem_alloc(sizeof(vec3) * (size_t)p->vertex_count);
    out->normals = p->normals ? mem_alloc(sizeof(vec3) * (size_t)p->vertex_count) : NULL;
    if (!out->positions || (p->normals && !out->normals))
        return false;
    pose_vertices(pose, p, p->normals, NULL, p->vertex_count, out->positions, out->normals);
    data->positions = (const float *)out->positions;
    data->normals = (const float *)out->normals;
    return true;
}

/* Normals and creases of a mesh that has no normals, in the position it has come to. Corners that are in one position
 * at rest belong together as long as they still are: what only comes to touch stays apart. */
static lmn_status make_normals(posed_mesh *out, const primitive *p, double crease_angle, corner_groups *kept,
                               lmn_error *error)
{
    corner_groups own = {NULL}, *groups = kept ? kept : &own;
    primitive     bent = *p;
    bent.positions = (vec3 *)(uintptr_t)out->data.positions;
    lmn_status status = groups->ids ? LMN_OK : corner_groups_make(groups, p, error);
    if (status == LMN_OK)
        status = bent.positions == p->positions || corner_groups_hold(groups, &bent)
                     ? mesh_make_normals_in(&out->split, &bent, groups, crease_angle, error)
                     : mesh_make_normals(&out->split, &bent, crease_angle, error);
    corner_groups_release(&own);
    out->data.normals = (const float *)out->split.normals;
    return status;
}

/* Elements of an array in the order of the split vertices. What was there is freed when it is the mesh's own. */
static void *split_array(void *own, const float **data, const render_vertices *split, size_t size, bool *done)
{
    void *out = posed_gather(*data, split->source, split->vertex_count, size);
    *done = *done && (out || !*data);
    mem_free(own);
    *data = out;
    return out;
}

static bool split_vertices(posed_mesh *out)
{
    const render_vertices *split = &out->split;
    vertex_arrays         *data = &out->data;
    data->vertex_count = split->vertex_count;
    data->indices = split->indices;
    bool done = true;
    out->positions = split_array(out->positions, &data->positions, split, sizeof(vec3), &done);
    out->colours = split_array(out->colours, &data->colours, split, sizeof(vec4), &done);
    for (int i = 0; i < UV_SETS; i++)
        out->uvs[i] = split_array(out->uvs[i], &data->uvs[i], split, sizeof(vec2), &done);
    return done;
}

vec3 *posed_positions(const primitive *p, const part_pose *pose, const render_vertices *split)
{
    const posed_vertices *known = pose_vertices_of(pose, p);
    if (known && split->source)
        return posed_gather(known->positions, split->source, split->vertex_count, sizeof(vec3));
    vec3 *out = mem_alloc((size_t)split->vertex_count * sizeof *out);
    if (out && known)
        memcpy(out, known->positions, (size_t)split->vertex_count * sizeof *out);
    else if (out)
        pose_vertices(pose, p, NULL, split->source, split->vertex_count, out, NULL);
    return out;
}

lmn_status posed_make_keeping(posed_mesh *out, const primitive *p, double crease_angle, const part_pose *pose,
                              corner_groups *kept, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->split = (render_vertices){.vertex_count = p->vertex_count, .index_count = p->index_count};
    out->data = (vertex_arrays){.vertex_count = p->vertex_count,
                                .index_count = p->index_count,
                                .indices = p->indices,
                                .positions = (const float *)p->positions,
                                .normals = (const float *)p->normals,
                                .uvs = {(const float *)p->uvs[0], (const float *)p->uvs[1]},
                                .colours = (const float *)p->colours};
    if (pose_deforms(pose, p) && !deform(out, p, pose))
        return error_memory(error);
    lmn_status status = p->normals ? LMN_OK : make_normals(out, p, crease_angle, kept, error);
    if (status == LMN_OK && out->split.source && !split_vertices(out))
        status = error_memory(error);
    return status;
}

lmn_status posed_make(posed_mesh *out, const primitive *p, double crease_angle, const part_pose *pose, lmn_error *error)
{
    return posed_make_keeping(out, p, crease_angle, pose, NULL, error);
}
