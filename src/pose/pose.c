#include "pose/pose.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "pose/animate.h"
#include "scene/mesh.h"

static const skin *skin_of(const lmn_scene *scene, size_t part_index)
{
    const node *n = &scene->nodes[scene->parts[part_index].node];
    return n->mesh != NONE && n->skin != NONE ? &scene->skins[n->skin] : NULL;
}

static size_t count_joints(const lmn_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->part_count; i++)
        count += skin_of(scene, i) ? skin_of(scene, i)->joint_count : 0;
    return count;
}

/* World · inverse bind, one a joint. */
static void set_joints(mat4 *out, const mat4 *worlds, const skin *s)
{
    for (size_t i = 0; i < s->joint_count; i++)
        out[i] = s->inverse_binds ? mat4_multiply(&worlds[s->joints[i]], &s->inverse_binds[i]) : worlds[s->joints[i]];
}

/* `weights` (may be NULL): of its node, where they move. `posed` (may be NULL): where its vertices are kept. */
static void pose_part(pose *p, size_t part_index, mat4 *joints, const float *weights, posed_vertices *posed)
{
    const node *n = &p->scene->nodes[p->scene->parts[part_index].node];
    const skin *s = skin_of(p->scene, part_index);
    if (n->mesh == NONE)
        return;
    const mesh *m = &p->scene->meshes[n->mesh];
    if (s)
        set_joints(joints, p->worlds, s);
    p->parts[part_index] =
        (part_pose){.primitives = m->primitives,
                    .posed = posed,
                    .primitive_count = posed ? m->primitive_count : 0,
                    .joints = s ? joints : NULL,
                    .joint_count = s ? s->joint_count : 0,
                    .weights = weights            ? weights
                               : n->morph_weights ? n->morph_weights
                                                  : m->morph_weights,
                    .weight_count = n->morph_weights ? n->morph_weight_count : m->morph_weight_count};
}

/* --- boxes ---------------------------------------------------------------------------------------------- */

/* Does anything move a part away from where it is at rest? */
static bool is_moved(const pose *p, size_t part_index, const float *weights)
{
    const lmn_scene *s = p->scene;
    const node      *n = &s->nodes[s->parts[part_index].node];
    const skin      *k = n->mesh != NONE && n->skin != NONE ? &s->skins[n->skin] : NULL;
    const mat4      *at_rest = p->at_rest->worlds;
    bool moved = weights || memcmp(&p->worlds[s->parts[part_index].node], &at_rest[s->parts[part_index].node],
                                   sizeof *at_rest) != 0;
    for (size_t i = 0; k && i < k->joint_count && !moved; i++)
        moved = memcmp(&p->worlds[k->joints[i]], &at_rest[k->joints[i]], sizeof *at_rest) != 0;
    return moved;
}

static void forget_posed(posed_vertices *posed, size_t count)
{
    for (size_t i = 0; posed && i < count; i++)
        posed[i].made = false;
}

/* Of a part that bends. False: out of memory. */
static bool set_bent_box(pose *p, size_t part_index)
{
    const part_pose *own = &p->parts[part_index];
    const mesh      *m = &p->scene->meshes[p->scene->nodes[p->scene->parts[part_index].node].mesh];
    mat4             world = pose_instance(p, part_index, 0);
    box3             box = box3_empty();
    forget_posed(own->posed, own->primitive_count); /* which is not bent */
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *q = &m->primitives[i];
        vec3            *moved = mem_alloc((size_t)q->vertex_count * sizeof *moved);
        if (!moved)
            return false;
        pose_vertices(own, q, NULL, NULL, q->vertex_count, moved, NULL);
        for (uint32_t k = 0; k < q->vertex_count; k++)
            box = box3_with_point(box, mat4_transform_point(&world, moved[k]));
        mem_free(moved);
    }
    p->part_boxes[part_index] = box;
    return true;
}

/* At rest the scene knows them. */
static bool set_boxes(pose *p, const animated_state *moved)
{
    bool good = true;
    p->box = box3_empty();
    const lmn_scene *s = p->scene;
    size_t           all = p->part_count + p->ghost_count;
    for (size_t i = 0; i < all; i++) {
        int32_t      node_index = s->parts[i].node;
        const float *weights = moved->weights ? moved->weights[node_index] : NULL;
        p->part_boxes[i] =
            p->at_rest && is_moved(p, i, weights)
                ? node_bounds(s, p->worlds, node_index, weights, i < p->part_count ? p->parts[i].posed : NULL)
                : s->parts[i].bounds;
        if (i < p->part_count && p->parts[i].bend && p->parts[i].bend->active)
            good = set_bent_box(p, i) && good;
        if (i < p->part_count)
            p->box = box3_union(p->box, p->part_boxes[i]);
    }
    p->fit_boxes = p->part_boxes;
    return good;
}

/* --- deformation ---------------------------------------------------------------------------------------- */

/* Also while it stands still, so that it has vertices of its own before and after, too. */
static bool part_is_late(const pose *p, size_t part_index)
{
    const part_deformation *how = &p->when.deformation->parts[part_index];
    return p->scene->nodes[p->scene->parts[part_index].node].mesh != NONE && part_deformation_bends(how);
}

/* Deforms what has been posed by how it moves. */
static lmn_status deform(pose *p, const animated_state *moved, lmn_error *error)
{
    const lmn_scene *s = p->scene;
    deformed_nodes   d;
    lmn_status       status = deformed_nodes_find(&d, p, error);
    p->rigid = mem_copy(p->worlds, s->node_count * sizeof *p->rigid);
    if (status == LMN_OK && !p->rigid)
        status = error_memory(error);
    for (size_t i = 0; i < s->node_count && status == LMN_OK; i++)
        if (d.changed[i])
            p->worlds[i] = mat4_multiply(&d.changes[i], &p->worlds[i]);
    if (status == LMN_OK) {
        p->bends = d.bends;
        p->deformed_count = d.count;
        p->coarse_count = d.coarse;
        p->bend_joints = d.joints;
        d.bends = NULL;
        d.joints = NULL;
    }
    for (size_t i = 0; i < s->part_count && status == LMN_OK; i++) {
        part_pose  *own = &p->parts[i];
        const skin *k = skin_of(s, i);
        if (k)
            set_joints(p->joints + (own->joints - p->joints), p->worlds, k);
        own->bend = p->bends && part_is_late(p, i) ? &p->bends[i] : NULL;
    }
    deformed_nodes_release(&d);
    forget_posed(p->posed, p->posed_count);
    return status == LMN_OK && !set_boxes(p, moved) ? error_memory(error) : status;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

/* As the scene's check says it of parts at rest. */
static lmn_status check_positions(const pose *p, lmn_error *error)
{
    const float FARTHEST = 1e18f;
    for (size_t i = 0; p->when.clip_count && i < p->part_count; i++) {
        const float *b = &p->part_boxes[i].min.x;
        bool         near = true;
        for (int k = 0; k < 6 && !box3_is_empty(p->part_boxes[i]); k++)
            near = near && b[k] >= -FARTHEST && b[k] <= FARTHEST;
        if (near)
            continue;
        error_set(error, LMN_FORMAT, "at %g s part '%.100s' lies farther than 1e18 from the origin", p->when.seconds,
                  p->scene->parts[i].name);
        error_hint(error, "check the animations that move it");
        return LMN_FORMAT;
    }
    return LMN_OK;
}

static lmn_status fill(pose *p, animated_state *moved, lmn_error *error)
{
    const lmn_scene *scene = p->scene;
    p->worlds = scene_world_matrices(scene, moved->locals);
    p->parts = mem_calloc(scene->part_count, sizeof *p->parts);
    p->part_boxes = mem_calloc(scene->part_count + scene->ghost_count, sizeof *p->part_boxes);
    p->joints = mem_calloc(count_joints(scene), sizeof *p->joints);
    if (!p->worlds || !p->parts || !p->part_boxes || !p->joints)
        return error_memory(error);
    mat4           *joints = p->joints;
    posed_vertices *posed = p->posed;
    for (size_t i = 0; i < scene->part_count; i++) {
        pose_part(p, i, joints, moved->weights ? moved->weights[scene->parts[i].node] : NULL, posed);
        joints += p->parts[i].joint_count;
        posed = posed ? posed + p->parts[i].primitive_count : NULL;
    }
    p->cameras = moved->cameras;
    p->lights = moved->lights;
    p->weights = moved->weight_data;
    moved->cameras = NULL;
    moved->lights = NULL;
    moved->weight_data = NULL;
    if (!set_boxes(p, moved))
        return error_memory(error);
    lmn_status status = p->when.deformation && p->when.clip_count ? deform(p, moved, error) : LMN_OK;
    return status == LMN_OK ? check_positions(p, error) : status;
}

/* Room for what is posed on the way to the boxes. */
static lmn_status open_posed(pose *p, lmn_error *error)
{
    const lmn_scene *s = p->scene;
    for (size_t i = 0; i < s->part_count; i++) {
        int32_t m = s->nodes[s->parts[i].node].mesh;
        p->posed_count += m != NONE ? s->meshes[m].primitive_count : 0;
    }
    p->posed = mem_calloc(p->posed_count, sizeof *p->posed);
    return p->posed ? LMN_OK : error_memory(error);
}

static void release_posed(pose *p)
{
    for (size_t i = 0; p->posed && i < p->posed_count; i++) {
        mem_free(p->posed[i].positions);
        mem_free(p->posed[i].normals);
    }
    mem_free(p->posed);
}

static lmn_status add_rest(pose *p, lmn_error *error)
{
    moment when = moment_at_rest();
    p->at_rest = mem_calloc(1, sizeof *p->at_rest);
    return p->at_rest ? pose_create(p->at_rest, p->scene, &when, error) : error_memory(error);
}

/* `keeps`: what is posed for boxes is drawn, too. `earlier` (may be NULL): of the same scene, it gives what serves. */
static lmn_status create(pose *out, const lmn_scene *scene, const moment *when, bool keeps, pose *earlier,
                         lmn_error *error)
{
    animated_state moved;
    *out = (pose){.scene = scene,
                  .revision = scene->revision,
                  .when = *when,
                  .part_count = scene->part_count,
                  .ghost_count = scene->ghost_count,
                  .box = box3_empty()};
    lmn_status status = animate(&moved, scene, when, error);
    if (earlier && when->clip_count) {
        out->at_rest = earlier->at_rest;
        out->posed = earlier->posed;
        out->posed_count = earlier->posed_count;
        earlier->at_rest = NULL;
        earlier->posed = NULL;
        forget_posed(out->posed, out->posed_count);
    }
    if (status == LMN_OK && when->clip_count && !out->at_rest)
        status = add_rest(out, error);
    if (status == LMN_OK && when->clip_count && keeps && !out->posed)
        status = open_posed(out, error);
    if (status == LMN_OK)
        status = fill(out, &moved, error);
    animated_state_release(&moved);
    return status;
}

lmn_status pose_create(pose *out, const lmn_scene *scene, const moment *when, lmn_error *error)
{
    if (scene->changes_open) {
        *out = (pose){.scene = NULL};
        return error_set(error, LMN_USAGE, "the scene is being changed: call lmn_scene_end_changes before it is drawn");
    }
    return create(out, scene, when, true, NULL, error);
}

lmn_status pose_move(pose *p, const moment *when, lmn_error *error)
{
    pose       earlier = *p;
    lmn_status status = create(p, earlier.scene, when, true, &earlier, error);
    pose_release(&earlier);
    return status;
}

static void release_past(pose *p)
{
    for (int i = 0; i < POSE_PAST_MAX; i++) {
        if (p->past[i])
            pose_release(p->past[i]);
        mem_free(p->past[i]);
        p->past[i] = NULL;
    }
    p->past_count = 0;
}

lmn_status pose_add_past(pose *p, double seconds, int count, lmn_error *error)
{
    moment when = p->when;
    double now = when.held ? when.held_seconds : when.seconds, reached = now < seconds ? now : seconds; /* clips
                                                                                              begin at 0 */
    lmn_status status = LMN_OK;
    if (!p->at_rest || (p->past_count == count && p->past_seconds == seconds))
        return LMN_OK;
    release_past(p);
    p->past_seconds = seconds;
    for (int i = 0; i < count && status == LMN_OK; i++) {
        p->past[i] = mem_calloc(1, sizeof *p->past[i]);
        when.seconds = now - reached * (i + 1) / count;
        status = p->past[i] ? pose_create(p->past[i], p->scene, &when, error) : error_memory(error);
        p->past_count = i + 1;
    }
    return status;
}

void pose_release(pose *p)
{
    release_past(p);
    if (p->at_rest)
        pose_release(p->at_rest);
    mem_free(p->at_rest);
    release_posed(p);
    mem_free(p->worlds);
    mem_free(p->parts);
    mem_free(p->part_boxes);
    mem_free(p->joints);
    mem_free(p->rigid);
    mem_free(p->bends);
    mem_free(p->bend_joints);
    mem_free(p->weights);
    mem_free(p->cameras);
    mem_free(p->lights);
    memset(p, 0, sizeof *p);
}

bool pose_deforms(const part_pose *pose, const primitive *p)
{
    return pose->joints || (pose->weights && p->morph_count) || pose->bend;
}

const mat4 *pose_rigid_worlds(const pose *p)
{
    return p->rigid ? p->rigid : p->worlds;
}

bool pose_part_deforms(const part_pose *pose)
{
    return pose->joints || pose->weight_count > 0 || pose->bend;
}

void pose_vertices(const part_pose *pose, const primitive *p, const vec3 *normals, const uint32_t *source,
                   uint32_t count, vec3 *out_positions, vec3 *out_normals)
{
    mesh_pose(p, pose->weights, pose->weight_count, pose->joints, pose->joint_count, normals, source, count,
              out_positions, out_normals);
    if (pose->bend && pose->bend->joints && p->joints && p->weights)
        bend_skin(pose->bend, p, pose->weights, pose->weight_count, normals, source, count, out_positions, out_normals);
    else if (pose->bend)
        bend_vertices(pose->bend, count, out_positions, normals ? out_normals : NULL);
}

void pose_warn_of_rigid(const pose *p, warnings *warnings)
{
    if (p->when.deformation && p->when.clip_count && !p->deformed_count)
        warnings_add(
            warnings, WARNING_UNUSED,
            "motion: nothing is deformed: at %g s nothing that motion.stretch, squash, lean, inertia, lag, drag and "
            "comb are set for moves from its place",
            p->when.seconds);
    if (p->coarse_count)
        warnings_add(
            warnings, WARNING_REDUCED,
            "motion.comb: %zu things that move have too few vertices in their rear for so many teeth; take a finer "
            "mesh or a lower motion.comb_teeth",
            p->coarse_count);
}

const posed_vertices *pose_vertices_of(const part_pose *pose, const primitive *p)
{
    for (size_t i = 0; i < pose->primitive_count; i++)
        if (&pose->primitives[i] == p)
            return pose->posed[i].made ? &pose->posed[i] : NULL;
    return NULL;
}

mat4 pose_instance(const pose *p, size_t part_index, size_t instance)
{
    const node *n = &p->scene->nodes[p->scene->parts[part_index].node];
    mat4        world = part_index < p->part_count && p->parts[part_index].joints
                            ? mat4_identity()
                            : p->worlds[p->scene->parts[part_index].node];
    return n->instance_count ? mat4_multiply(&world, &n->instances[instance]) : world;
}

/* Its joints have room of their own. */
static void hold_bend(part_bend *own, const part_bend *held)
{
    mat4 *joints = own->joints;
    *own = *held;
    own->joints = joints;
    if (joints && held->joints)
        memcpy(joints, held->joints, (BEND_STEPS + 1) * own->joint_count * sizeof *joints);
}

static void hold_part(pose *p, const pose *held, size_t part_index)
{
    int32_t node_index = p->scene->parts[part_index].node;
    p->worlds[node_index] = held->worlds[node_index];
    if (p->rigid)
        p->rigid[node_index] = pose_rigid_worlds(held)[node_index];
    p->part_boxes[part_index] = held->part_boxes[part_index];
    if (part_index >= p->part_count)
        return;
    part_pose       *own = &p->parts[part_index];
    const part_pose *other = &held->parts[part_index];
    forget_posed(own->posed, own->primitive_count);
    if (own->bend && other->bend)
        hold_bend(&p->bends[part_index], other->bend);
    if (own->joints)
        memcpy(p->joints + (own->joints - p->joints), other->joints, own->joint_count * sizeof *own->joints);
    if (own->weights != other->weights) /* those that move are the pose's own */
        memcpy(p->weights + (own->weights - p->weights), other->weights, own->weight_count * sizeof *own->weights);
}

void pose_hold(pose *p, const pose *held, const bool *moves)
{
    size_t   all = p->part_count + p->ghost_count, still = 0;
    uint64_t hash = 1469598103934665603u; /* FNV-1a */
    for (size_t i = 0; i < all; i++) {
        still += !moves[i];
        hash = (hash ^ moves[i]) * 1099511628211u;
    }
    if (!still)
        return;
    for (size_t i = 0; i < p->scene->node_count; i++)
        if (p->scene->nodes[i].mesh == NONE && p->scene->nodes[i].solid == NONE) {
            p->worlds[i] = held->worlds[i]; /* with the cameras and lights there */
            if (p->rigid)
                p->rigid[i] = pose_rigid_worlds(held)[i];
        }
    memcpy(p->cameras, held->cameras, p->scene->camera_count * sizeof *p->cameras);
    memcpy(p->lights, held->lights, p->scene->light_count * sizeof *p->lights);
    p->box = box3_empty();
    for (size_t i = 0; i < all; i++) {
        if (!moves[i])
            hold_part(p, held, i);
        if (i < p->part_count)
            p->box = box3_union(p->box, p->part_boxes[i]);
    }
    p->when.held_seconds = held->when.seconds;
    p->when.held = hash;
}

/* --- over time ------------------------------------------------------------------------------------------ */

static int by_size(const void *left, const void *right)
{
    float a = *(const float *)left, b = *(const float *)right;
    return a < b ? -1 : a > b;
}

/* The times of all keys of a moment's clips and evenly spread ones between, in order and each once; of too many, evenly
 * spread ones alone. NULL when memory is gone. */
static float *times_of(const lmn_scene *scene, const moment *when, size_t *out_count)
{
    enum { EVEN = 48, KEYS_MOST = 512, EVEN_AT_MOST = 1024 };
    double end = moment_duration(when, scene);
    size_t keys = 0, count = 0, kept = 0;
    for (size_t i = 0; i < when->clip_count; i++)
        for (size_t k = 0; k < scene->animations[when->clips[i]].channel_count; k++)
            keys += scene->animations[when->clips[i]].channels[k].key_count;
    float *times = mem_alloc((keys + EVEN_AT_MOST + 1) * sizeof *times);
    if (!times)
        return NULL;
    for (size_t i = 0; i < when->clip_count; i++)
        for (size_t k = 0; k < scene->animations[when->clips[i]].channel_count; k++) {
            const animation_channel *c = &scene->animations[when->clips[i]].channels[k];
            memcpy(&times[count], c->times, c->key_count * sizeof *times);
            count += c->key_count;
        }
    qsort(times, count, sizeof *times, by_size);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || times[i] != times[kept - 1])
            times[kept++] = times[i];
    size_t even = kept > KEYS_MOST ? EVEN_AT_MOST : EVEN;
    kept = kept > KEYS_MOST ? 0 : kept;
    for (size_t i = 0; i <= even; i++)
        times[kept++] = (float)(end * (double)i / (double)even);
    *out_count = end > 0 ? kept : 1;
    return times;
}

lmn_status pose_boxes_at(box3 **out, const lmn_scene *scene, const moment *when, const double *times, size_t time_count,
                         lmn_error *error)
{
    size_t     count = scene->part_count + scene->ghost_count;
    box3      *boxes = mem_alloc(count * sizeof *boxes);
    lmn_status status = boxes ? LMN_OK : error_memory(error);
    for (size_t i = 0; boxes && i < count; i++)
        boxes[i] = box3_empty();
    for (size_t k = 0; k < time_count && status == LMN_OK; k++) {
        moment at = *when;
        pose   p;
        at.seconds = times[k];
        status = create(&p, scene, &at, false, NULL, error);
        for (size_t i = 0; i < count && status == LMN_OK; i++)
            boxes[i] = box3_union(boxes[i], p.part_boxes[i]);
        pose_release(&p);
        if (status == LMN_OK)
            status = work_check(error);
    }
    if (status != LMN_OK)
        mem_free(boxes);
    *out = status == LMN_OK ? boxes : NULL;
    return status;
}

lmn_status pose_swept_boxes(box3 **out, const lmn_scene *scene, const moment *when, lmn_error *error)
{
    size_t     count = 0;
    float     *keys = times_of(scene, when, &count);
    double    *times = keys ? mem_alloc(count * sizeof *times) : NULL;
    lmn_status status = times ? LMN_OK : error_memory(error);
    *out = NULL;
    for (size_t k = 0; k < count && times; k++)
        times[k] = (double)keys[k] > 0 ? (double)keys[k] : 0;
    if (status == LMN_OK)
        status = pose_boxes_at(out, scene, when, times, count, error);
    mem_free(keys);
    mem_free(times);
    return status;
}
