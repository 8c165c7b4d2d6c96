/* A scene's parts with their edges sorted: what does not depend on the view. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/scene_cut.h"
#include "scene/mesh.h"
#include "stroke/butterfly_mesh.h"
#include "stroke/planes.h"
#include "stroke/solid.h"
#include "stroke/stroke_private.h"

typedef struct scene_builder {
    stroke_scene         *out;
    const pose           *pose;
    const lmn_scene      *scene;
    double                crease_angle;
    int32_t               refine;
    int32_t              *shared; /* per mesh of the scene: its number in `out`, NONE */
    stroke_topologies    *kept;
    const stroke_section *section; /* NULL: nothing is cut away */
    size_t                mesh_capacity, item_capacity;
    box3                  box;
} scene_builder;

/* Positions of all primitives, deformed; NULL when memory is gone. */
static vec3 *pose_positions(const mesh *m, const part_pose *pose)
{
    size_t count = 0, at = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        count += m->primitives[i].vertex_count;
    vec3 *out = mem_alloc(count * sizeof *out);
    for (size_t i = 0; i < m->primitive_count && out; at += m->primitives[i++].vertex_count) {
        const primitive      *p = &m->primitives[i];
        const posed_vertices *known = pose_vertices_of(pose, p);
        if (known)
            memcpy(out + at, known->positions, (size_t)p->vertex_count * sizeof *out);
        else
            pose_vertices(pose, p, NULL, NULL, p->vertex_count, out + at, NULL);
    }
    return out;
}

/* Room for those of all meshes; those that are there may belong to a scene with fewer. */
static bool open_topologies(stroke_topologies *t, size_t count)
{
    if (t->count >= count)
        return true;
    struct edge_topology **more = mem_realloc(t->meshes, count * sizeof *more);
    if (!more)
        return false;
    memset(more + t->count, 0, (count - t->count) * sizeof *more);
    t->meshes = more;
    t->count = count;
    return true;
}

void stroke_topologies_release(stroke_topologies *t)
{
    for (size_t i = 0; i < t->count; i++)
        edge_topology_destroy(&t->meshes[i]);
    mem_free(t->meshes);
    memset(t, 0, sizeof *t);
}

/* Edges of a deformed mesh: judged anew where its topology is that of the mesh at rest, else sorted anew. */
static lmn_status pose_edges(scene_builder *b, edge_mesh *out, int32_t mesh_index, const vec3 *positions,
                             lmn_error *error)
{
    const mesh            *m = &b->scene->meshes[mesh_index];
    struct edge_topology **t = &b->kept->meshes[mesh_index];
    lmn_status             status = LMN_OK;
    bool                   fits = false;
    if (*t && edge_topology_revision(*t) != m->topology)
        edge_topology_destroy(t);
    if (!*t)
        status = edge_topology_create(t, m, error);
    if (status == LMN_OK)
        status = edge_mesh_pose(out, *t, positions, b->crease_angle, &fits, error);
    if (status == LMN_OK && fits)
        out->topology = *t;
    return status == LMN_OK && !fits ? edge_mesh_create(out, m, positions, b->crease_angle, error) : status;
}

static bool is_deformed(const mesh *m, const part_pose *pose)
{
    bool deformed = false;
    for (size_t i = 0; i < m->primitive_count; i++)
        deformed = deformed || pose_deforms(pose, &m->primitives[i]);
    return deformed;
}

/* The number of the part's edge mesh, made when it is not there yet. */
static lmn_status find_mesh(scene_builder *b, size_t part_index, uint32_t *out, lmn_error *error)
{
    const node      *n = &b->scene->nodes[b->scene->parts[part_index].node];
    const part_pose *pose = &b->pose->parts[part_index];
    const mesh      *m = &b->scene->meshes[n->mesh];
    bool             posed = is_deformed(m, pose) || m->moved;
    if (!posed && b->shared[n->mesh] == NONE && m->twin && b->scene->meshes[m->twin - 1].revision == m->revision)
        b->shared[n->mesh] = b->shared[m->twin - 1];
    if (!posed && b->shared[n->mesh] != NONE) {
        *out = (uint32_t)b->shared[n->mesh];
        return LMN_OK;
    }
    stroke_scene *s = b->out;
    if (!mem_grow((void **)&s->meshes, &b->mesh_capacity, s->mesh_count + 1, sizeof *s->meshes))
        return error_memory(error);
    vec3      *positions = posed ? pose_positions(m, pose) : NULL;
    lmn_status status = posed && !positions ? error_memory(error) : LMN_OK;
    if (status == LMN_OK && posed)
        status = pose_edges(b, &s->meshes[s->mesh_count], n->mesh, positions, error);
    else if (status == LMN_OK)
        status = edge_mesh_create(&s->meshes[s->mesh_count], m, NULL, b->crease_angle, error);
    mem_free(positions);
    if (status != LMN_OK)
        return status;
    status = edge_mesh_refine(&s->meshes[s->mesh_count], b->refine, error);
    if (status != LMN_OK) {
        edge_mesh_release(&s->meshes[s->mesh_count]);
        return status;
    }
    s->meshes[s->mesh_count].moves = posed;
    *out = (uint32_t)s->mesh_count++;
    if (!posed)
        b->shared[n->mesh] = (int32_t)*out;
    return LMN_OK;
}

/* The largest coordinate of a box. */
double box_farthest(box3 box)
{
    return fmax(fmax(fmax(fabs(box.min.x), fabs(box.max.x)), fmax(fabs(box.min.y), fabs(box.max.y))),
                fmax(fabs(box.min.z), fabs(box.max.z)));
}

double mat4_growth(const mat4 *m)
{
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = fmax(most, sqrt(m->m[4 * k] * m->m[4 * k] + m->m[4 * k + 1] * m->m[4 * k + 1] +
                               m->m[4 * k + 2] * m->m[4 * k + 2]));
    return most;
}

/* Widens the box of all; returns how far the item reaches. */
static double widen_box(scene_builder *b, const edge_mesh *m, const mat4 *world)
{
    double grown = mat4_growth(world), reach = 0;
    for (uint32_t k = 0; k < m->piece_count; k++) {
        b->box = box3_union(b->box, box3_transform(m->boxes[k], world));
        reach = fmax(reach, grown * box_farthest(m->boxes[k]));
    }
    b->out->reach = fmax(b->out->reach, reach);
    return reach;
}

static lmn_status put_item(scene_builder *b, size_t part_index, uint32_t mesh, const mat4 *world, lmn_error *error)
{
    stroke_scene *s = b->out;
    if (!mem_grow((void **)&s->items, &b->item_capacity, s->item_count + 1, sizeof *s->items))
        return error_memory(error);
    const node *n = &b->pose->scene->nodes[b->pose->scene->parts[part_index].node];
    double      reach = widen_box(b, &s->meshes[mesh], world);
    s->items[s->item_count++] =
        (stroke_item){(uint32_t)part_index, mesh, *world, !node_throws_shadow(n), node_image(n), reach};
    return LMN_OK;
}

/* What a section leaves of an instance that it goes through: a mesh of its own. */
static lmn_status add_cut(scene_builder *b, size_t part_index, const mat4 *world, cut_verdict *verdict, bool *open,
                          lmn_error *error)
{
    bool             own_open = false;
    stroke_scene    *s = b->out;
    const part_pose *pose = &b->pose->parts[part_index];
    const mesh      *m = &b->scene->meshes[b->scene->nodes[b->scene->parts[part_index].node].mesh];
    edge_mesh        made = {0};
    vec3            *positions = pose_positions(m, pose);
    lmn_status status = positions ? scene_cut_mesh(&made, verdict, &own_open, m, positions, b->section->cut, world,
                                                   b->crease_angle, error)
                                  : error_memory(error);
    mem_free(positions);
    *open = *open || own_open;
    if (status != LMN_OK || *verdict != CUT_CROSSED)
        return status;
    status = edge_mesh_refine(&made, b->refine, error);
    if (status == LMN_OK && !mem_grow((void **)&s->meshes, &b->mesh_capacity, s->mesh_count + 1, sizeof *s->meshes))
        status = error_memory(error);
    if (status != LMN_OK) {
        edge_mesh_release(&made);
        return status;
    }
    s->meshes[s->mesh_count] = made;
    return put_item(b, part_index, (uint32_t)s->mesh_count++, world, error);
}

static cut_verdict judge_part(const scene_builder *b, size_t part_index)
{
    if (!b->section || b->section->cut->cell_count == 0)
        return CUT_WHOLE;
    cut_verdict verdict = cut_judge_box(b->section->cut, b->pose->part_boxes[part_index]);
    /* What stays whole goes all the same where it lies in what is cut away. */
    bool spared = b->section->spared && b->section->spared[part_index];
    return verdict == CUT_CROSSED && spared ? CUT_WHOLE : verdict;
}

/* One instance of a solid, or all, as lines of what its operations leave. */
static lmn_status make_solid(scene_builder *b, size_t part_index, const mat4 *world, uint32_t *number, lmn_error *error)
{
    static const cut nothing = {.cell_count = 0};
    const cut       *c = b->section ? b->section->cut : &nothing;
    bool             spared = b->section && b->section->spared && b->section->spared[part_index];
    stroke_scene    *s = b->out;
    solid_form       form;
    solid_cutter    *cutters = NULL;
    lmn_status       status = solid_form_create(
              &form, &b->scene->solids[b->scene->nodes[b->scene->parts[part_index].node].solid], true, error);
    if (status == LMN_OK)
        status = solid_form_cut(&form, c, spared, world, (int32_t)b->scene->mesh_count, &cutters, error);
    if (status == LMN_OK && !mem_grow((void **)&s->meshes, &b->mesh_capacity, s->mesh_count + 1, sizeof *s->meshes))
        status = error_memory(error);
    if (status == LMN_OK)
        status = edge_mesh_create_solid(&s->meshes[s->mesh_count], b->scene, &form, c, cutters, b->crease_angle, error);
    solid_form_release(&form);
    mem_free(cutters);
    if (status != LMN_OK)
        return status;
    *number = (uint32_t)s->mesh_count++;
    s->open_operands += s->meshes[*number].solid->open_operands;
    return LMN_OK;
}

/* Instances are one solid, unless a section cuts each elsewhere. */
static lmn_status add_solid(scene_builder *b, size_t part_index, lmn_error *error)
{
    const node *n = &b->scene->nodes[b->scene->parts[part_index].node];
    bool        apart = b->section && b->section->cut->cell_count > 0;
    uint32_t    number = 0;
    lmn_status  status = LMN_OK;
    for (size_t i = 0; i < node_draw_count(n) && status == LMN_OK; i++) {
        mat4 world = pose_instance(b->pose, part_index, i);
        if (i == 0 || apart)
            status = make_solid(b, part_index, &world, &number, error);
        if (status == LMN_OK && b->out->meshes[number].piece_count)
            status = put_item(b, part_index, number, &world, error);
    }
    return status;
}

static lmn_status add_part(scene_builder *b, size_t part_index, lmn_error *error)
{
    const node *n = &b->scene->nodes[b->scene->parts[part_index].node];
    cut_verdict part = n->mesh < 0 ? CUT_GONE : judge_part(b, part_index);
    uint32_t    number = UINT32_MAX;
    bool        open = false;
    lmn_status  status = LMN_OK;
    if (n->solid != NONE)
        return add_solid(b, part_index, error);
    for (size_t i = 0; i < node_draw_count(n) && part != CUT_GONE && status == LMN_OK; i++) {
        mat4        world = pose_instance(b->pose, part_index, i);
        cut_verdict own = part;
        if (part == CUT_CROSSED)
            status = add_cut(b, part_index, &world, &own, &open, error);
        if (status == LMN_OK && own == CUT_WHOLE && number == UINT32_MAX)
            status = find_mesh(b, part_index, &number, error);
        if (status == LMN_OK && own == CUT_WHOLE)
            status = put_item(b, part_index, number, &world, error);
    }
    b->out->open_parts += open;
    return status;
}

lmn_status stroke_scene_create(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                               lmn_progress_fn progress, void *user, lmn_error *error)
{
    return stroke_scene_create_refined(out, pose, parts, crease_angle, 0, progress, user, error);
}

static lmn_status fill(scene_builder *b, const bool *parts, lmn_progress_fn progress, void *user, lmn_error *error)
{
    stroke_scene    *out = b->out;
    const lmn_scene *scene = b->scene;
    memset(out, 0, sizeof *out);
    b->box = box3_empty();
    b->shared = mem_alloc((scene->mesh_count + 1) * sizeof *b->shared);
    lmn_status status = b->shared && open_topologies(b->kept, scene->mesh_count) ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < scene->mesh_count && status == LMN_OK; i++)
        b->shared[i] = NONE;
    for (size_t i = 0; i < scene->part_count && status == LMN_OK; i++) {
        if (parts && !parts[i])
            continue;
        if (progress && !progress((double)i / (double)scene->part_count, "sorting edges", user))
            status = error_set(error, LMN_CANCELLED, "cancelled while edges were sorted");
        else
            status = add_part(b, i, error);
    }
    mem_free(b->shared);
    for (size_t i = 0; i < out->mesh_count && status == LMN_OK; i++)
        status = planes_find(&out->meshes[i]) ? LMN_OK : error_memory(error);
    out->extent = box3_is_empty(b->box) ? 0 : box3_diagonal(b->box);
    if (status != LMN_OK)
        stroke_scene_release(out);
    return status;
}

lmn_status stroke_scene_create_refined(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                                       int32_t refine, lmn_progress_fn progress, void *user, lmn_error *error)
{
    return stroke_scene_create_cut(out, pose, parts, crease_angle, refine, NULL, progress, user, error);
}

lmn_status stroke_scene_create_cut(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                                   int32_t refine, const stroke_section *section, lmn_progress_fn progress, void *user,
                                   lmn_error *error)
{
    stroke_topologies own = {NULL};
    scene_builder     b = {.out = out,
                           .pose = pose,
                           .scene = pose->scene,
                           .crease_angle = crease_angle,
                           .refine = refine,
                           .kept = &own,
                           .section = section};
    lmn_status        status = fill(&b, parts, progress, user, error);
    for (size_t i = 0; i < out->mesh_count; i++)
        out->meshes[i].topology = NULL;
    stroke_topologies_release(&own);
    if (status != LMN_OK)
        return status;
    status = stroke_scene_calm(out, error);
    if (status != LMN_OK)
        stroke_scene_release(out);
    return status;
}

lmn_status stroke_scene_create_keeping(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                                       int32_t refine, stroke_topologies *kept, const stroke_section *section,
                                       lmn_error *error)
{
    scene_builder b = {.out = out,
                       .pose = pose,
                       .scene = pose->scene,
                       .crease_angle = crease_angle,
                       .refine = refine,
                       .kept = kept,
                       .section = section};
    return fill(&b, parts, NULL, NULL, error);
}

void stroke_scene_release(stroke_scene *s)
{
    form_surfaces_destroy(s);
    for (size_t i = 0; i < s->mesh_count; i++)
        edge_mesh_release(&s->meshes[i]);
    if (s->crossings)
        crossings_release(s->crossings);
    mem_free(s->crossings);
    mem_free(s->meshes);
    mem_free(s->items);
    memset(s, 0, sizeof *s);
}
