/* The scene of a BVH file: nodes that move, bones that can be drawn, and the motion as channels. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "import/build.h"
#include "import/bvh.h"

/* --- bones ---------------------------------------------------------------------------------------------- */

/* A slender octahedron of length 1 along +y, broadest near the joint where it begins. */
static const float  BONE_BREADTH = 0.09f, BONE_BROADEST = 0.15f;
static const double BONE_LEAST = 1e-9; /* shorter ones have no direction */

/* All bones share one mesh; their nodes turn and scale it. Returns its index, NONE when memory is gone. */
static int32_t add_bone_mesh(lmn_scene *s)
{
    const float    b = BONE_BREADTH, y = BONE_BROADEST;
    const vec3     corners[6] = {{0, 0, 0}, {b, y, 0}, {0, y, -b}, {-b, y, 0}, {0, y, b}, {0, 1, 0}};
    const uint32_t indices[24] = {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1};
    primitive      p = {.vertex_count = 6, .index_count = 24, .welded = true};
    p.material = build_plain_material(s, false);
    p.positions = mem_copy(corners, sizeof corners);
    p.indices = mem_copy(indices, sizeof indices);
    mesh *m = p.material != NONE && p.positions && p.indices ? scene_append_mesh(s) : NULL;
    if (m && mesh_set_primitives(m, &p, 1))
        return (int32_t)s->mesh_count - 1;
    primitive_release(&p);
    return NONE;
}

/* The shortest turn from +y to a direction of this length. */
static void turn_from_y(const double to[3], double length, double out[4])
{
    double w = length + to[1];
    if (w < 1e-9 * length) {
        memcpy(out, (double[4]){1, 0, 0, 0}, 4 * sizeof *out); /* half a turn */
        return;
    }
    /* y × to, and 1 + cos: twice the half angle's sine and cosine, up to the length. */
    const double q[4] = {to[2], 0, -to[0], w};
    double       norm = sqrt(q[0] * q[0] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        out[i] = q[i] / norm;
}

static bool add_bone(lmn_scene *s, int32_t mesh_index, const bvh_joint *from, const bvh_joint *to)
{
    const double *o = to->offset;
    double        length = sqrt(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]);
    if (!(length > BONE_LEAST) || !isfinite(length))
        return true;
    node *n = scene_append_node(s);
    if (!n)
        return false;
    n->name = mem_copy_text(from->name);
    n->mesh = mesh_index;
    node_place *own = node_own_place(n);
    if (!own)
        return false;
    own->scale[0] = own->scale[1] = own->scale[2] = length;
    turn_from_y(o, length, own->rotation);
    scene_link_child(s, from->node, (int32_t)s->node_count - 1);
    return !from->name || n->name;
}

static bool add_joint(lmn_scene *s, bvh_joint *j, int32_t parent)
{
    node *n = scene_append_node(s);
    if (!n)
        return false;
    j->node = (int32_t)s->node_count - 1;
    n->name = mem_copy_text(j->name);
    node_place *own = node_own_place(n);
    if (own)
        memcpy(own->translation, j->offset, sizeof own->translation);
    scene_link_child(s, parent, j->node);
    return own && (!j->name || n->name);
}

lmn_status bvh_build_skeleton(lmn_scene *s, bvh_skeleton *skeleton, lmn_error *error)
{
    int32_t mesh_index = add_bone_mesh(s);
    bool    good = mesh_index != NONE;
    for (size_t i = 0; i < skeleton->count && good; i++) {
        bvh_joint       *j = &skeleton->joints[i];
        const bvh_joint *parent = j->parent == NONE ? NULL : &skeleton->joints[j->parent];
        if (parent)
            good = add_bone(s, mesh_index, parent, j);
        if (good && !j->is_end)
            good = add_joint(s, j, parent ? parent->node : NONE);
    }
    return good ? LMN_OK : error_memory(error);
}

/* --- motion --------------------------------------------------------------------------------------------- */

static bool has_channels(const bvh_joint *j, bool rotations)
{
    for (int i = 0; i < j->channel_count; i++)
        if ((j->channels[i] >= BVH_X_ROTATION) == rotations)
            return true;
    return false;
}

static bool add_channel(animation *a, int32_t target, animation_path path, size_t frames, const float *times)
{
    animation_channel *c = &a->channels[a->channel_count++];
    *c = (animation_channel){.target = target,
                             .path = path,
                             .interpolation = INTERPOLATION_LINEAR,
                             .key_count = frames,
                             .components = path == PATH_ROTATION ? 4 : 3};
    c->times = mem_copy(times, frames * sizeof *times);
    c->values = mem_calloc(frames, c->components * sizeof *c->values);
    return c->times && c->values;
}

animation *bvh_add_motion(lmn_scene *s, const bvh_skeleton *skeleton, size_t frames, double frame_time)
{
    animation *a = scene_append_animation(s);
    float     *times = mem_alloc(frames * sizeof *times);
    if (a)
        a->channels = mem_calloc(2 * skeleton->count, sizeof *a->channels);
    bool good = a && a->channels && times;
    for (size_t i = 0; i < frames && good; i++)
        times[i] = (float)((double)i * frame_time);
    for (size_t i = 0; i < skeleton->count && good; i++) {
        const bvh_joint *j = &skeleton->joints[i];
        if (has_channels(j, false))
            good = add_channel(a, j->node, PATH_TRANSLATION, frames, times);
        if (good && has_channels(j, true))
            good = add_channel(a, j->node, PATH_ROTATION, frames, times);
    }
    mem_free(times);
    return good ? a : NULL;
}

/* q · (a turn about one of the axes), in place. */
static void turn_about_axis(double q[4], int axis, double degrees)
{
    double    half = degrees * (3.14159265358979323846 / 360), c = cos(half), s = sin(half);
    double    turned[4];
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    turned[axis] = q[axis] * c + q[3] * s;
    turned[next] = q[next] * c + q[last] * s;
    turned[last] = q[last] * c - q[next] * s;
    turned[3] = q[3] * c - q[axis] * s;
    memcpy(q, turned, sizeof turned);
}

static void put_rotation(animation_channel *c, size_t frame, const double q[4])
{
    float *to = c->values + 4 * frame;
    double along = 0;
    for (int i = 0; i < 4 && frame > 0; i++)
        along += q[i] * (double)to[i - 4];
    for (int i = 0; i < 4; i++)
        to[i] = (float)(along < 0 ? -q[i] : q[i]);
}

void bvh_put_frame(animation *motion, const bvh_skeleton *skeleton, size_t frame, const double *numbers)
{
    animation_channel *channel = motion->channels;
    for (size_t i = 0; i < skeleton->count; i++) {
        const bvh_joint *j = &skeleton->joints[i];
        double           position[3], q[4] = {0, 0, 0, 1};
        memcpy(position, j->offset, sizeof position); /* of axes that have no channel */
        for (int k = 0; k < j->channel_count; k++, numbers++)
            if (j->channels[k] < BVH_X_ROTATION)
                position[j->channels[k]] = *numbers;
            else
                turn_about_axis(q, j->channels[k] - BVH_X_ROTATION, *numbers);
        if (has_channels(j, false)) {
            for (int k = 0; k < 3; k++)
                channel->values[3 * frame + (size_t)k] = (float)position[k];
            channel++;
        }
        if (has_channels(j, true))
            put_rotation(channel++, frame, q);
    }
}
