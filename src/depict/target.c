/* What is told of: a node with what is below it, where its middle is, and where it meets something. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "behaviour/carry.h"
#include "contact/surface.h"
#include "depict/depict_private.h"

/* Is a node below another one, or the same? */
static bool is_below(const lmn_scene *s, int32_t node, int32_t above)
{
    while (node != NONE && node != above)
        node = s->nodes[node].parent;
    return node != NONE;
}

/* What carries a skinned part: its hip, or else the joint that all others are below. */
static int32_t hip_of(const lmn_scene *s, const skin *k)
{
    static const char *const names[] = {"hip", "Hip", "pelvis", "Pelvis"};
    for (size_t i = 0; i < k->joint_count; i++)
        for (size_t n = 0; n < 4; n++)
            if (s->nodes[k->joints[i]].name && strstr(s->nodes[k->joints[i]].name, names[n]))
                return k->joints[i];
    int32_t top = k->joint_count ? k->joints[0] : NONE;
    for (size_t i = 1; i < k->joint_count; i++)
        if (top != NONE && is_below(s, top, k->joints[i]))
            top = k->joints[i];
    return top;
}

static void put_in(const mat4 *m, double place[3])
{
    double out[3];
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * place[0] + m->m[4 + k] * place[1] + m->m[8 + k] * place[2] + m->m[12 + k];
    vector3_copy(place, out);
}

lmn_status target_open(depict_target *out, const depict_job *j, int32_t node, lmn_error *error)
{
    const lmn_scene *s = j->scene;
    box3             box = box3_empty();
    int32_t          carrier = node;
    const mat4      *worlds = depict_worlds_at_rest(j);
    memset(out, 0, sizeof *out);
    out->node = node;
    out->part_count = s->part_count;
    out->parts = mem_calloc(s->part_count + 1, sizeof *out->parts);
    if (!out->parts || !worlds)
        return error_memory(error);
    for (size_t i = 0; i < s->part_count; i++) {
        int32_t own = s->parts[i].node;
        out->parts[i] = is_below(s, own, node);
        if (!out->parts[i])
            continue;
        box = box3_union(box, part_bounds(s, worlds, i));
        if (s->nodes[own].skin != NONE && carrier == node)
            carrier = hip_of(s, &s->skins[s->nodes[own].skin]);
    }
    carrier = carrier == NONE ? node : carrier;
    mat4 inverse = mat4_inverse(&worlds[carrier]);
    vec3 middle = {(float)worlds[node].m[12], (float)worlds[node].m[13], (float)worlds[node].m[14]};
    if (!box3_is_empty(box))
        middle = (vec3){(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2};
    middle = mat4_transform_point(&inverse, middle);
    if (carrier == node)
        vector3_set(out->centre, (double)middle.x, (double)middle.y, (double)middle.z);
    box_sides(box, out->outermost);
    for (int i = 0; i < BOX_SIDES; i++)
        put_in(&inverse, out->outermost[i]);
    out->radius = box3_is_empty(box) ? j->size * 0.02 : box3_diagonal(box) / (2 * 1.7320508);
    if (!(out->radius > 0))
        out->radius = j->size * 0.02;
    out->reach = box3_is_empty(box)
                     ? out->radius
                     : (double)fmaxf(fmaxf(box.max.x - box.min.x, box.max.y - box.min.y), box.max.z - box.min.z) / 2;
    return way_open(&out->way, s, carrier, &j->when, error);
}

bool *depict_moved_nodes(const lmn_scene *s, const moment *when)
{
    bool *moved = mem_calloc(s->node_count + 1, sizeof *moved);
    for (size_t k = 0; moved && k < when->clip_count; k++) {
        const animation *a = &s->animations[when->clips[k]];
        for (size_t c = 0; c < a->channel_count; c++)
            if (animation_thing_of(a->channels[c].path) == ANIMATED_NODE)
                moved[a->channels[c].target] = true;
    }
    return moved;
}

lmn_status target_take_tip(depict_target *t, const depict_job *j, lmn_error *error)
{
    const size_t count = j->scene->node_count;
    bool        *moved = depict_moved_nodes(j->scene, &j->when), *carried = mem_calloc(count + 1, sizeof *carried);
    double(*tips)[3] = mem_calloc(count + 1, sizeof *tips);
    const bool good = moved && carried && tips;
    if (good) {
        moved[t->node] = true; /* it is looked at by itself */
        node_tips(tips, carried, j->scene, moved);
        vector3_copy(t->centre, tips[t->node]);
    }
    mem_free(moved);
    mem_free(carried);
    mem_free(tips);
    if (!good)
        return error_memory(error);
    way_release(&t->way);
    return way_open(&t->way, j->scene, t->node, &j->when, error);
}

void target_release(depict_target *t)
{
    mem_free(t->parts);
    way_release(&t->way);
    memset(t, 0, sizeof *t);
}

/* --- vertices --------------------------------------------------------------------------------------------------------
 */

static bool put_part(vec3 **out, size_t *count, size_t *capacity, const pose *p, size_t part)
{
    const lmn_scene *s = p->scene;
    const node      *n = &s->nodes[s->parts[part].node];
    const mesh      *m = n->mesh == NONE ? NULL : &s->meshes[n->mesh];
    for (size_t k = 0; m && k < m->primitive_count; k++)
        for (size_t i = 0; i < node_draw_count(n); i++) {
            const primitive *from = &m->primitives[k];
            mat4             world = pose_instance(p, part, i);
            if (!mem_grow((void **)out, capacity, *count + from->vertex_count + 1, sizeof **out))
                return false;
            pose_vertices(&p->parts[part], from, NULL, NULL, from->vertex_count, *out + *count, NULL);
            for (uint32_t v = 0; v < from->vertex_count; v++, ++*count)
                (*out)[*count] = mat4_transform_point(&world, (*out)[*count]);
        }
    return true;
}

lmn_status target_vertices(vec3 **out, size_t *count, const depict_job *j, const depict_target *t, double seconds,
                           lmn_error *error)
{
    const pose *p = NULL;
    size_t      capacity = 0;
    *out = NULL;
    *count = 0;
    lmn_status status = depict_pose(&p, j, seconds, error);
    for (size_t i = 0; i < t->part_count && status == LMN_OK; i++)
        if (t->parts[i] && !put_part(out, count, &capacity, p, i))
            status = error_memory(error);
    if (status != LMN_OK) {
        mem_free(*out);
        *out = NULL;
        *count = 0;
    }
    return status;
}

/* --- impacts ---------------------------------------------------------------------------------------------------------
 */

/* How the velocity differs between `span` before a time and `span` after it. Two keys may lie at a bounce. */
static void change_at(const depict_target *t, const double place[3], double seconds, double span, double before[3],
                      double change[3])
{
    double p[4][3];
    for (int i = 0; i < 4; i++)
        way_point(&t->way, place, seconds + (i < 2 ? i - 2 : i - 1) * span, p[i]);
    for (int k = 0; k < 3; k++) {
        before[k] = (p[1][k] - p[0][k]) / span;
        change[k] = (p[3][k] - p[2][k]) / span - before[k];
    }
}

static int compare_impacts(const void *a, const void *b)
{
    double x = ((const depict_impact *)a)->time, y = ((const depict_impact *)b)->time;
    return (x > y) - (x < y);
}

/* Of more than there is room for the weakest goes. */
static void impact_keep(depict_impact *out, size_t most, size_t *count, const depict_impact *now)
{
    size_t place = *count;
    if (*count == most) {
        place = 0;
        for (size_t k = 1; k < most; k++)
            if (vector3_length(out[k].change) < vector3_length(out[place].change))
                place = k;
        if (most == 0 || vector3_length(out[place].change) >= vector3_length(now->change))
            return;
    } else
        ++*count;
    out[place] = *now;
}

/* Of a place in the way's axes. */
static lmn_status impacts_of(depict_impact *out, size_t most, size_t *count, const depict_target *t,
                             const double place[3], double from, double to, lmn_error *error)
{
    trajectory way;
    lmn_status status = way_trajectory(&way, &t->way, place, from, to, t->radius * 0.02, error);
    double     length = 0;
    *count = 0;
    for (size_t i = 1; i < way.count && status == LMN_OK; i++)
        length += vector3_distance(way.samples[i - 1].position, way.samples[i].position);
    const double usual = to > from ? length / (to - from) : 0, span = (to - from) * 1e-4;
    double       last = -INFINITY;
    for (size_t i = 1; i + 1 < way.count && status == LMN_OK && usual > 0; i++) {
        depict_impact now = {.time = way.samples[i].seconds};
        if (now.time - last < 4 * span || now.time - from < 4 * span || to - now.time < 4 * span)
            continue;
        change_at(t, place, now.time, span, now.before, now.change);
        now.speed = vector3_length(now.before);
        /* What only bends hardly turns within so short a time. */
        double turn = vector3_length(now.change);
        if (turn < 0.3 * usual || now.speed < 0.05 * usual)
            continue;
        last = now.time;
        vector3_copy(now.at, way.samples[i].position);
        now.since = now.time - way.samples[i - 1].seconds;
        now.until = way.samples[i + 1].seconds - now.time;
        impact_keep(out, most, count, &now);
    }
    if (*count > 1)
        qsort(out, *count, sizeof *out, compare_impacts);
    trajectory_release(&way);
    return status;
}

lmn_status target_impacts(depict_impact *out, size_t most, size_t *count, const depict_target *t, double from,
                          double to, lmn_error *error)
{
    return impacts_of(out, most, count, t, t->centre, from, to, error);
}

/* How far a place goes. */
static double way_of(const depict_target *t, const double place[3], double from, double to)
{
    enum { STEPS = 32 };
    double length = 0, at[3], last[3] = {0, 0, 0};
    for (int i = 0; i <= STEPS; i++) {
        way_point(&t->way, place, from + (to - from) * i / STEPS, at);
        length += i > 0 ? vector3_distance(at, last) : 0;
        vector3_copy(last, at);
    }
    return length;
}

/* Does what moves it turn it by itself? */
static bool is_turned(const depict_target *t)
{
    bool turned = false;
    for (size_t i = 0; i < t->way.count && !turned; i++)
        turned = t->way.steps[i].rotation != NULL;
    return turned;
}

lmn_status target_hits(depict_impact *out, size_t most, size_t *count, const depict_target *t, double from, double to,
                       lmn_error *error)
{
    const double on_the_spot = 0.3, /* of the farthest way */
        origin[3] = {0, 0, 0};
    const double *farthest = t->centre;
    double        longest = 0;
    for (int i = 0; i < BOX_SIDES && is_turned(t); i++) {
        const double length = way_of(t, t->outermost[i], from, to);
        if (length > longest) {
            longest = length;
            farthest = t->outermost[i];
        }
    }
    const bool turns = is_turned(t) && way_of(t, origin, from, to) < on_the_spot * longest;
    lmn_status status = impacts_of(out, most, count, t, turns ? farthest : t->centre, from, to, error);
    for (size_t i = 0; i < *count && status == LMN_OK; i++)
        out[i].turns = turns;
    return status;
}

lmn_status impact_contact(double out[3], const depict_job *j, const depict_target *t, const depict_impact *impact,
                          lmn_error *error)
{
    const pose *posed = NULL;
    double      way[3];
    bool        found = false;
    lmn_status  status = depict_pose(&posed, j, impact->time, error);
    vector3_copy(out, impact->at);
    vector3_copy(way, impact->change);
    if (status != LMN_OK || !vector3_normalise(way))
        return status;
    return surface_outermost(out, &found, posed, t->parts, way, 1e-5 * t->radius, error);
}
