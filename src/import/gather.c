#include "import/gather.h"

#include "base/memory.h"
#include "scene/mesh.h"

static lmn_status append_primitive(polyhedron *out, const primitive *p, const mat4 *position, lmn_error *error)
{
    size_t  points = out->point_count + p->vertex_count, corners = 3 * out->triangle_count + p->index_count;
    point3 *grown = mem_realloc(out->points, points * sizeof *grown);
    if (grown)
        out->points = grown;
    uint32_t *triangles = mem_realloc(out->triangles, corners * sizeof *triangles);
    if (triangles)
        out->triangles = triangles;
    if (!grown || !triangles)
        return error_memory(error);
    for (uint32_t i = 0; i < p->index_count; i++)
        triangles[3 * out->triangle_count + i] = p->indices[i] + (uint32_t)out->point_count;
    const double *m = position->m;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double x = (double)p->positions[i].x, y = (double)p->positions[i].y, z = (double)p->positions[i].z;
        grown[out->point_count + i] =
            (point3){m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
                     m[2] * x + m[6] * y + m[10] * z + m[14]};
    }
    out->point_count = points;
    out->triangle_count = corners / 3;
    return LMN_OK;
}

static bool has_border(const primitive *p)
{
    uint32_t *adjacent = mesh_adjacency(p);
    bool      found = false;
    for (uint32_t i = 0; adjacent && i < p->index_count && !found; i++)
        found = adjacent[i] == UINT32_MAX;
    mem_free(adjacent);
    return found;
}

lmn_status import_gather(polyhedron *out, const lmn_scene *s, bool *open, lmn_error *error)
{
    mat4      *worlds = scene_world_matrices(s, NULL);
    lmn_status status = worlds ? LMN_OK : error_memory(error);
    *open = false;
    for (size_t i = 0; i < s->part_count && status == LMN_OK; i++) {
        int32_t at = s->parts[i].node, m = s->nodes[at].mesh;
        for (size_t k = 0; m != NONE && k < s->meshes[m].primitive_count && status == LMN_OK; k++) {
            if (s->meshes[m].primitives[k].index_count == 0)
                continue;
            *open = *open || has_border(&s->meshes[m].primitives[k]);
            status = append_primitive(out, &s->meshes[m].primitives[k], &worlds[at], error);
        }
    }
    mem_free(worlds);
    return status;
}
