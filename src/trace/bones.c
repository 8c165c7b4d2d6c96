/* What holds a body up: of skins the bones from joint to joint, of other parts the middle line along their box. Each
 * tapers from one radius to another, as far as the mesh around it is away from it on the mean at rest. */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

/* A bone while vertices are given to it. */
typedef struct growing {
    vec3   from, to; /* at rest, in the world */
    double sums[2];  /* of distances, in its first half and its second one */
    size_t counts[2];
} growing;

typedef struct bone_finder {
    trace_bones *out;
    const pose  *rest;
    const char  *wanted;
    growing     *growing; /* per bone */
    size_t       capacity, growing_capacity;
} bone_finder;

static double length_of(vec3 v)
{
    return sqrt((double)v.x * (double)v.x + (double)v.y * (double)v.y + (double)v.z * (double)v.z);
}

static vec3 between(vec3 a, vec3 b, double f)
{
    return (vec3){a.x + (float)f * (b.x - a.x), a.y + (float)f * (b.y - a.y), a.z + (float)f * (b.z - a.z)};
}

static vec3 less(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(vec3 a, vec3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

/* In coordinates of its node at rest. False: out of memory. */
static bool put_bone(bone_finder *f, uint32_t part, int32_t node_index, vec3 from, vec3 to)
{
    trace_bones *b = f->out;
    const char  *name = f->rest->scene->nodes[node_index].name;
    if (f->wanted[0] && !(name && text_glob(f->wanted, name)))
        return true;
    if (!mem_grow((void **)&b->items, &f->capacity, b->count + 1, sizeof *b->items) ||
        !mem_grow((void **)&f->growing, &f->growing_capacity, b->count + 1, sizeof *f->growing))
        return false;
    mat4 back = mat4_inverse(&f->rest->worlds[node_index]);
    f->growing[b->count] = (growing){.from = from, .to = to};
    b->items[b->count++] = (trace_bone){.part = part,
                                        .node = node_index,
                                        .from = mat4_transform_point(&back, from),
                                        .to = mat4_transform_point(&back, to)};
    return true;
}

/* --- skins --------------------------------------------------------------------------------------------------- */

static int32_t joint_above(const lmn_scene *s, const skin *k, int32_t joint)
{
    for (int32_t i = s->nodes[joint].parent; i != NONE; i = s->nodes[i].parent)
        for (size_t n = 0; n < k->joint_count; n++)
            if (k->joints[n] == i)
                return i;
    return NONE;
}

static vec3 origin_of(const bone_finder *f, int32_t node_index)
{
    return mat4_transform_point(&f->rest->worlds[node_index], (vec3){0, 0, 0});
}

/* Where the vertices of a joint that is the last one end: as far beyond their middle as that is from the joint. */
static bool put_last_bone(bone_finder *f, uint32_t part, int32_t joint, const vec3 *world, const primitive *p)
{
    double   sums[3] = {0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (trace_joint_of(f->rest->scene, &f->rest->scene->nodes[f->rest->scene->parts[part].node], p, i) == joint) {
            sums[0] += (double)world[i].x;
            sums[1] += (double)world[i].y;
            sums[2] += (double)world[i].z;
            count++;
        }
    if (!count)
        return true;
    vec3 from = origin_of(f, joint),
         middle = {(float)(sums[0] / count), (float)(sums[1] / count), (float)(sums[2] / count)};
    return put_bone(f, part, joint, from, between(from, middle, 2));
}

static bool put_skin(bone_finder *f, uint32_t part, const skin *k, const vec3 *world, const primitive *p)
{
    const lmn_scene *s = f->rest->scene;
    bool             good = true;
    for (size_t i = 0; i < k->joint_count && good; i++) {
        int32_t above = joint_above(s, k, k->joints[i]);
        bool    last = true;
        for (size_t n = 0; n < k->joint_count && last; n++)
            last = joint_above(s, k, k->joints[n]) != k->joints[i];
        vec3 own = origin_of(f, k->joints[i]);
        if (above != NONE && length_of(less(own, origin_of(f, above))) > 0)
            good = put_bone(f, part, above, origin_of(f, above), own);
        if (good && last)
            good = put_last_bone(f, part, k->joints[i], world, p);
    }
    return good;
}

/* Gives each vertex to the nearest of the bones that go with its joint. */
static void measure_skin(bone_finder *f, uint32_t part, size_t first, const vec3 *world, const primitive *p)
{
    const lmn_scene *s = f->rest->scene;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        int32_t joint = trace_joint_of(s, &s->nodes[s->parts[part].node], p, i);
        double  nearest = INFINITY, at = 0;
        size_t  best = 0;
        for (size_t n = first; n < f->out->count; n++) {
            const growing *g = &f->growing[n];
            vec3           way = less(g->to, g->from);
            double         f_own = fmin(fmax(dot(less(world[i], g->from), way) / fmax(dot(way, way), 1e-30), 0), 1),
                   apart = length_of(less(world[i], between(g->from, g->to, f_own)));
            if (f->out->items[n].node == joint && apart < nearest) {
                nearest = apart;
                at = f_own;
                best = n;
            }
        }
        if (nearest < INFINITY) {
            f->growing[best].sums[at > 0.5] += nearest;
            f->growing[best].counts[at > 0.5]++;
        }
    }
}

/* A half without vertices is as thick as the other one; joints that move nothing, as handles of animators, have no
 * bones. */
static void settle_radii(bone_finder *f, size_t first)
{
    size_t kept = first;
    for (size_t n = first; n < f->out->count; n++) {
        const growing *g = &f->growing[n];
        if (!g->counts[0] && !g->counts[1])
            continue;
        for (int k = 0; k < 2; k++) {
            int from = g->counts[k] ? k : 1 - k;
            f->out->items[n].radius[k] = g->counts[from] ? g->sums[from] / (double)g->counts[from] : 0;
        }
        f->out->items[kept++] = f->out->items[n];
    }
    f->out->count = kept;
}

/* --- other parts ------------------------------------------------------------------------------------------------ */

static bool put_middle_line(bone_finder *f, uint32_t part, const vec3 *world, const primitive *p)
{
    int32_t own = f->rest->scene->parts[part].node;
    mat4    back = mat4_inverse(&f->rest->worlds[own]);
    double  low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3         local = mat4_transform_point(&back, world[i]);
        const double at[3] = {(double)local.x, (double)local.y, (double)local.z};
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    int longest = 0;
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[longest] - low[longest])
            longest = k;
    float ends[2][3];
    for (int e = 0; e < 2; e++)
        for (int k = 0; k < 3; k++)
            ends[e][k] = (float)(k == longest ? (e ? high[k] : low[k]) : 0.5 * (low[k] + high[k]));
    vec3 from = mat4_transform_point(&f->rest->worlds[own], (vec3){ends[0][0], ends[0][1], ends[0][2]}),
         to = mat4_transform_point(&f->rest->worlds[own], (vec3){ends[1][0], ends[1][1], ends[1][2]});
    size_t before = f->out->count;
    if (!(low[0] <= high[0]))
        return true;
    if (!put_bone(f, part, own, from, to))
        return false;
    double scale = length_of(less(to, from)) / fmax(high[longest] - low[longest], 1e-30), width = 0;
    for (int k = 0; k < 3; k++)
        width += k == longest ? 0 : 0.25 * (high[k] - low[k]) * scale;
    if (f->out->count > before)
        f->out->items[before].radius[0] = f->out->items[before].radius[1] = width;
    return true;
}

static bool put_part(bone_finder *f, uint32_t part)
{
    const lmn_scene *s = f->rest->scene;
    const node      *n = &s->nodes[s->parts[part].node];
    bool             good = true;
    for (size_t k = 0; k < s->meshes[n->mesh].primitive_count && good; k++) {
        const primitive *p = &s->meshes[n->mesh].primitives[k];
        vec3            *world = trace_positions(f->rest, &(trace_mesh){part, 0, 0, p});
        size_t           first = f->out->count;
        bool             skinned = n->skin != NONE && p->influences > 0 && s->skins[n->skin].joint_count > 0;
        good =
            world && (skinned ? put_skin(f, part, &s->skins[n->skin], world, p) : put_middle_line(f, part, world, p));
        if (good && skinned) {
            measure_skin(f, part, first, world, p);
            settle_radii(f, first);
        }
        mem_free(world);
    }
    return good;
}

lmn_status bones_find(trace_bones *out, const pose *now, const bool *parts, const char *wanted, lmn_error *error)
{
    bone_finder f = {.out = out, .rest = now->at_rest, .wanted = wanted};
    bool        good = true;
    memset(out, 0, sizeof *out);
    for (size_t part = 0; part < now->part_count && good; part++)
        if (parts[part] && now->scene->nodes[now->scene->parts[part].node].mesh != NONE)
            good = put_part(&f, (uint32_t)part);
    mem_free(f.growing);
    if (!good)
        bones_release(out);
    return good ? LMN_OK : error_memory(error);
}

void bones_release(trace_bones *b)
{
    mem_free(b->items);
    memset(b, 0, sizeof *b);
}
