/* Faces of meshes, welded by position; those without area are left out. */
#include "stroke/edge_builder.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "scene/mesh.h"
#include "stroke/drawn.h"

/* In double precision: slivers on large coordinates would lose their direction. */
vec3 edge_face_normal(const vec3 *positions, const uint32_t corners[3])
{
    vec3   p = positions[corners[0]], q = positions[corners[1]], r = positions[corners[2]];
    double ax = (double)q.x - p.x, ay = (double)q.y - p.y, az = (double)q.z - p.z;
    double bx = (double)r.x - p.x, by = (double)r.y - p.y, bz = (double)r.z - p.z;
    double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0))
        return (vec3){0, 0, 0};
    return (vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
}
static bool count_mesh(const mesh *m, size_t *vertices, size_t *corners, bool *said, bool *shaded)
{
    *vertices = *corners = 0;
    *said = *shaded = false;
    for (size_t i = 0; i < m->primitive_count; i++) {
        *vertices += m->primitives[i].vertex_count;
        *corners += m->primitives[i].index_count;
        *said = *said || m->primitives[i].edges.values;
        *shaded = *shaded || m->primitives[i].normals;
    }
    return *vertices < UINT32_MAX / 4 && *corners < UINT32_MAX / 4;
}

/* All primitives' positions, one after the other. */
static vec3 *gather_positions(const mesh *m, const vec3 *posed, size_t count)
{
    vec3  *positions = mem_alloc(count * sizeof *positions);
    size_t at = 0;
    for (size_t i = 0; i < m->primitive_count && positions; at += m->primitives[i++].vertex_count)
        memcpy(positions + at, posed ? posed + at : m->primitives[i].positions,
               m->primitives[i].vertex_count * sizeof *positions);
    return positions;
}

/* Keeps one vertex a position, in order of appearance; ids[v] becomes its new number. */
static void weld(edge_mesh *out, uint32_t *ids, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (ids[i] != i) {
            ids[i] = ids[ids[i]];
            continue;
        }
        out->positions[kept] = out->positions[i];
        ids[i] = kept++;
    }
    out->vertex_count = kept;
}

/* Faces with three corners and an area. */
static void gather_faces(edge_builder *b, const mesh *m, const uint32_t *ids)
{
    edge_mesh *out = b->mesh;
    uint32_t   base = 0;
    for (size_t i = 0; i < m->primitive_count; base += m->primitives[i++].vertex_count) {
        const primitive *p = &m->primitives[i];
        for (uint32_t k = 0; k + 2 < p->index_count; k += 3) {
            uint32_t corners[3];
            for (int c = 0; c < 3; c++)
                corners[c] = ids[base + p->indices[k + (uint32_t)c]];
            vec3 normal = edge_face_normal(out->positions, corners);
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2])
                continue;
            if (dot(normal, normal) == 0) {
                b->has_flat = true;
                continue;
            }
            uint32_t f = out->face_count++;
            memcpy(out->faces[f], corners, sizeof corners);
            out->normals[f] = normal;
            if (out->materials)
                out->materials[f] = p->material;
            for (uint32_t c = 0; c < 3 && out->said; c++)
                out->said[3 * f + c] = p->edges.values ? p->edges.values[k + c] : SAID_NOTHING;
            for (uint32_t c = 0; c < 3 && b->normals; c++)
                b->normals[3 * f + c] = p->normals ? shading_pack(p->normals[p->indices[k + c]]) : SHADING_NONE;
        }
    }
}

/* Faces that are there already, without those that have no area. */
lmn_status edge_faces_take(edge_builder *b, const edge_faces *in, lmn_error *error)
{
    edge_mesh *out = b->mesh;
    size_t     count = in->face_count;
    out->vertex_count = in->vertex_count;
    out->positions = mem_copy(in->positions, (size_t)in->vertex_count * sizeof *out->positions);
    out->faces = mem_alloc(count * sizeof *out->faces);
    out->normals = mem_alloc(count * sizeof *out->normals);
    out->materials = in->materials ? mem_alloc(count * sizeof *out->materials) : NULL;
    out->said = in->said ? mem_alloc(3 * count) : NULL;
    b->origins = mem_alloc(count * sizeof *b->origins);
    if (!out->positions || !out->faces || !out->normals || (in->materials && !out->materials) ||
        (in->said && !out->said) || !b->origins)
        return error_memory(error);
    for (uint32_t i = 0; i < in->face_count; i++) {
        uint32_t f = out->face_count;
        vec3     normal = edge_face_normal(out->positions, in->faces[i]);
        if (dot(normal, normal) == 0)
            continue;
        out->face_count++;
        memcpy(out->faces[f], in->faces[i], sizeof in->faces[i]);
        out->normals[f] = normal;
        b->origins[f] = i;
        if (out->materials)
            out->materials[f] = in->materials[i];
        if (out->said)
            memcpy(&out->said[3 * f], &in->said[3 * i], 3);
    }
    return LMN_OK;
}

static uint32_t *count_up(uint32_t count)
{
    uint32_t *out = mem_alloc(count * sizeof *out);
    for (uint32_t i = 0; i < count && out; i++)
        out[i] = i;
    return out;
}

lmn_status edge_faces_make(edge_builder *b, const mesh *m, const vec3 *posed, lmn_error *error)
{
    edge_mesh *out = b->mesh;
    size_t     vertices, corners;
    bool       said, shaded;
    if (!count_mesh(m, &vertices, &corners, &said, &shaded))
        return error_set(error, LMN_LIMIT,
                         "a mesh of %zu vertices and %zu corners is too large for its edges to be sorted", vertices,
                         corners);
    out->positions = gather_positions(m, posed, vertices);
    bool      welded = m->primitive_count == 1 && m->primitives[0].welded && !posed;
    uint32_t *ids =
        !out->positions ? NULL
        : welded        ? count_up((uint32_t)vertices)
                 : mesh_position_ids(&(primitive){.vertex_count = (uint32_t)vertices, .positions = out->positions});
    out->faces = mem_alloc(corners * sizeof **out->faces);
    out->normals = mem_alloc(corners / 3 * sizeof *out->normals);
    bool mixed = false;
    for (size_t i = 1; i < m->primitive_count; i++)
        mixed = mixed || m->primitives[i].material != m->primitives[0].material;
    out->materials = mixed ? mem_alloc(corners / 3 * sizeof *out->materials) : NULL;
    out->said = said ? mem_alloc(corners) : NULL;
    b->normals = shaded ? mem_alloc(corners * sizeof *b->normals) : NULL;
    double near = ids ? mesh_near(out->positions, vertices) : 0;
    bool   good = ids && mesh_weld_near(out->positions, ids, vertices, near) && out->faces && out->normals &&
                (out->materials || !mixed) && (out->said || !said) && (b->normals || !shaded);
    if (good) {
        weld(out, ids, (uint32_t)vertices);
        gather_faces(b, m, ids);
        good = drawn_take(out, m, ids);
    }
    if (b->keeps) {
        b->keeps->welded = ids;
        b->keeps->vertex_count = vertices;
        b->keeps->near = near;
        b->keeps->has_flat = b->has_flat;
        ids = NULL;
    }
    mem_free(ids);
    return good ? LMN_OK : error_memory(error);
}
