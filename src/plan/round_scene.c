#include "plan/round_scene.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "light/light.h"
#include "scene/round.h"
#include "stroke/edges.h"

/* Half a pixel of an ordinary picture that one mesh fills. */
#define TOLERANCE (1.0 / 2000)
enum { MOST_VERTICES = 2000000 }; /* that are added to a scene */

/* What a mesh of the scene is drawn as. */
typedef struct round_mesh {
    bool     known;
    uint64_t revision, topology; /* of the mesh that it was made of */
    mesh     made;               /* without primitives: the mesh itself */
} round_mesh;

static size_t vertices_of(const mesh *m)
{
    size_t count = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        count += m->primitives[i].vertex_count;
    return count;
}

static void forget(round_scene *r)
{
    for (size_t i = 0; i < r->count; i++)
        mesh_release(&r->meshes[i].made);
    r->count = 0;
}

static void release_copy(round_scene *r)
{
    mem_free(r->scene.meshes);
    mem_free(r->scene.parts);
    r->scene = (lmn_scene){.nodes = NULL};
    r->identity = 0;
}

void round_scene_release(round_scene *r)
{
    forget(r);
    release_copy(r);
    mem_free(r->meshes);
    *r = (round_scene){.meshes = NULL};
}

/* By how much a crease turns as a line: that of a whole chain, not of one edge; a narrow rounding as much as can be. */
static float turn_of(const edge_mesh *m, const mesh_edge *e)
{
    const float most = 3.14159265f;
    if (e->flags & EDGE_ROUNDED || e->face[1] == EDGE_NO_FACE)
        return most;
    vec3  n = m->normals[e->face[0]], o = m->normals[e->face[1]];
    float cosine = n.x * o.x + n.y * o.y + n.z * o.z;
    return e->turn > 0 ? e->turn : acosf(fminf(fmaxf(e->flags & EDGE_TWISTED ? -cosine : cosine, -1), 1));
}

/* Which edges are creases is judged where the mesh is as it was made. */
static lmn_status find_sharp(round_options *out, const mesh *m, lmn_error *error)
{
    edge_mesh  edges = {.vertex_count = 0};
    lmn_status status = edge_mesh_create(&edges, m, NULL, out->crease_angle, error);
    if (status != LMN_OK)
        return status;
    round_crease *sharp = mem_alloc(edges.edge_count * sizeof *sharp + 1);
    out->sharp_count = 0;
    for (uint32_t i = 0; sharp && i < edges.edge_count; i++) {
        const mesh_edge *e = &edges.edges[i];
        if (!(e->flags & EDGE_CREASE))
            continue;
        sharp[out->sharp_count++] =
            (round_crease){{edges.positions[e->vertex[0]], edges.positions[e->vertex[1]]}, turn_of(&edges, e)};
    }
    edge_mesh_release(&edges);
    out->sharp = sharp;
    return sharp ? LMN_OK : error_memory(error);
}

static lmn_status round_one(round_mesh *to, const mesh *m, double crease_angle, bool forms, size_t *left,
                            lmn_error *error)
{
    round_options options = {crease_angle, TOLERANCE, *left, forms, NULL, 0};
    mesh_release(&to->made);
    to->known = false;
    lmn_status status = mesh_round(&to->made, m, &options, error);
    if (status == LMN_OK && to->made.primitive_count && !forms) { /* which have no creases that are said */
        mesh_release(&to->made);
        status = find_sharp(&options, m, error);
        if (status == LMN_OK)
            status = mesh_round(&to->made, m, &options, error);
        mem_free((void *)options.sharp);
    }
    if (status != LMN_OK)
        return status;
    size_t more = to->made.primitive_count ? vertices_of(&to->made) - vertices_of(m) : 0;
    *left -= more < *left ? more : *left;
    to->known = true;
    to->revision = m->revision;
    to->topology = m->topology;
    to->made.revision = to->made.topology = scene_next_revision();
    return LMN_OK;
}

/* Where normals are made they are those of a pose, and would be others in the next. */
static bool has_own_normals(const mesh *m)
{
    for (size_t i = 0; i < m->primitive_count; i++)
        if (!m->primitives[i].normals && (m->primitives[i].joints || m->primitives[i].morph_count))
            return false;
    return true;
}

/* Which meshes nodes draw: what solids are made of keeps the planes that it has. */
static bool *find_drawn(const lmn_scene *scene)
{
    bool *drawn = mem_calloc(scene->mesh_count + 1, sizeof *drawn);
    for (size_t i = 0; drawn && i < scene->node_count; i++)
        if (scene->nodes[i].mesh != NONE && scene->nodes[i].solid == NONE)
            drawn[scene->nodes[i].mesh] = true;
    return drawn;
}

/* Those that are not made yet, or of what has changed since. */
static lmn_status round_all(round_scene *r, const lmn_scene *scene, lmn_error *error)
{
    size_t had = r->count, left = MOST_VERTICES;
    if (!mem_grow((void **)&r->meshes, &r->room, scene->mesh_count + 1, sizeof *r->meshes))
        return error_memory(error);
    for (size_t i = scene->mesh_count; i < had; i++)
        mesh_release(&r->meshes[i].made);
    for (size_t i = had; i < scene->mesh_count; i++)
        r->meshes[i] = (round_mesh){.known = false};
    r->count = scene->mesh_count;
    bool      *drawn = find_drawn(scene);
    lmn_status status = drawn ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < scene->mesh_count && status == LMN_OK; i++) {
        round_mesh *to = &r->meshes[i];
        if (!drawn[i] || !has_own_normals(&scene->meshes[i]))
            mesh_release(&to->made);
        else if (!to->known || to->revision != scene->meshes[i].revision || to->topology != scene->meshes[i].topology)
            status = round_one(to, &scene->meshes[i], r->crease_angle, r->forms, &left, error);
    }
    mem_free(drawn);
    return status;
}

static bool anything_is_round(const round_scene *r)
{
    for (size_t i = 0; i < r->count; i++)
        if (r->meshes[i].made.primitive_count)
            return true;
    return false;
}

/* Meshes with the same content go on having it: what is made of one serves the other. */
static void keep_twins(lmn_scene *copy, const lmn_scene *scene)
{
    for (size_t i = 0; i < copy->mesh_count; i++) {
        mesh  *m = &copy->meshes[i];
        size_t twin = scene->meshes[i].twin;
        m->twin = twin;
        if (twin && scene->meshes[twin - 1].revision == scene->meshes[i].revision &&
            (m->primitives != scene->meshes[i].primitives) ==
                (copy->meshes[twin - 1].primitives != scene->meshes[twin - 1].primitives)) {
            m->revision = copy->meshes[twin - 1].revision;
            m->topology = copy->meshes[twin - 1].topology;
        }
    }
}

static lmn_status make_copy(round_scene *r, const lmn_scene *scene, lmn_error *error)
{
    size_t all = scene->part_count + scene->ghost_count;
    mat4  *worlds = scene_world_matrices(scene, NULL);
    mesh  *meshes = mem_copy(scene->meshes, scene->mesh_count * sizeof *meshes);
    part  *parts = mem_copy(scene->parts, all * sizeof *parts);
    if (!meshes || !parts || !worlds) {
        mem_free(worlds);
        mem_free(meshes);
        mem_free(parts);
        return error_memory(error);
    }
    r->scene = *scene;
    r->scene.meshes = meshes;
    r->scene.parts = parts;
    for (size_t i = 0; i < scene->mesh_count; i++)
        if (r->meshes[i].made.primitive_count)
            meshes[i] = r->meshes[i].made;
    keep_twins(&r->scene, scene);
    r->scene.revision = scene_next_revision(); /* nothing that was made of another copy fits this one */
    for (size_t i = 0; i < all; i++) {
        int32_t m = scene->nodes[parts[i].node].mesh;
        if (m == NONE || !r->meshes[m].made.primitive_count)
            continue;
        parts[i].triangles = 0;
        for (size_t k = 0; k < meshes[m].primitive_count; k++)
            parts[i].triangles += meshes[m].primitives[k].index_count / 3;
        parts[i].bounds = node_bounds(&r->scene, worlds, parts[i].node, NULL, NULL);
    }
    mem_free(worlds);
    r->identity = scene->identity;
    r->revision = scene->revision;
    return LMN_OK;
}

lmn_status round_scene_find(const lmn_scene **out, round_scene *r, const lmn_scene *scene, const lmn_look *look,
                            lmn_error *error)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    const double        crease = (double)v->crease_angle * (3.14159265358979323846 / 180);
    *out = scene;
    if (v->round == ROUND_NONE)
        return LMN_OK;
    const bool forms = v->round == ROUND_FORMS;
    bool       same = r->identity == scene->identity && r->crease_angle == crease && r->forms == forms;
    if (!same)
        forget(r);
    if (same && r->revision == scene->revision) {
        *out = anything_is_round(r) ? &r->scene : scene;
        return LMN_OK;
    }
    release_copy(r);
    r->crease_angle = crease;
    r->forms = forms;
    lmn_status status = round_all(r, scene, error);
    if (status == LMN_OK)
        status = make_copy(r, scene, error);
    if (status == LMN_OK && anything_is_round(r))
        *out = &r->scene;
    return status;
}
