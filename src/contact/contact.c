#include "contact/contact.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "contact/surface.h"
#include "scene/content.h"

static bool is_below(const lmn_scene *s, int32_t node_index, int32_t above)
{
    while (node_index != NONE && node_index != above)
        node_index = s->nodes[node_index].parent;
    return node_index != NONE;
}

lmn_status contact_sides_find(contact_sides *out, const lmn_scene *s, int32_t node_index, lmn_error *error)
{
    box3 box = box3_empty();
    *out =
        (contact_sides){mem_calloc(s->part_count + 1, sizeof(bool)), mem_calloc(s->part_count + 1, sizeof(bool)), 0, 0};
    mat4 *worlds = scene_world_matrices(s, NULL);
    if (!out->own || !out->others || !worlds) {
        mem_free(worlds);
        return error_memory(error);
    }
    for (size_t i = 0; i < s->part_count; i++) {
        int32_t own = s->parts[i].node;
        out->own[i] = is_below(s, own, node_index);
        out->others[i] = !out->own[i] && !scene_is_hidden(s, own);
        if (out->own[i])
            box = box3_union(box, part_bounds(s, worlds, i));
    }
    mem_free(worlds);
    out->radius = box3_is_empty(box) ? 0 : box3_diagonal(box) / (2 * sqrt(3));
    out->reach = 0.1 * out->radius;
    return LMN_OK;
}

void contact_sides_release(contact_sides *s)
{
    mem_free(s->own);
    mem_free(s->others);
    memset(s, 0, sizeof *s);
}

bool contact_is_hit(const double before[3], const double after[3], const double normal[3], double facing)
{
    double change[3];
    vector3_add(change, after, -1, before);
    const double in = -vector3_dot(before, normal), out = vector3_dot(after, normal);
    return facing >= 0.5 && in > 0 && in >= 0.1 * vector3_length(change) && out >= -0.1 * in;
}

double contact_reach(double reach, const double before[3], const double normal[3], double since, double until)
{
    const bool sampled = since > 0 && until > 0 && since <= 0.05 && until <= 0.05;
    return reach + (sampled ? fmax(-vector3_dot(before, normal), 0) * fmin(since, until) : 0);
}

/* The search for contacts of one node. */
typedef struct search {
    const schedule *s;
    const moment   *clips;
    int32_t         node_index;
    contact_sides   sides;
    pose            posed;
    bool            is_posed;
} search;

static void transform_point(const mat4 *m, const double p[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * p[0] + m->m[4 + k] * p[1] + m->m[8 + k] * p[2] + m->m[12 + k];
}

/* How fast a place of a node's surface is at a time, on one side of it. */
static lmn_status velocity_of(double out[3], const search *q, int32_t node_index, const double place[3], double seconds,
                              time_side side, lmn_error *error)
{
    const mat4        world = schedule_world(q->s, node_index, seconds, SIDE_AT), inverse = mat4_inverse(&world);
    double            local[3];
    trajectory_sample sample;
    transform_point(&inverse, place, local);
    lmn_status status = schedule_point_at(&sample, q->s, node_index, local, seconds, side, error);
    vector3_copy(out, sample.velocity);
    return status;
}

/* Do two nodes belong to one body: does one hang on the other, or both on something that is moved? */
static bool are_kin(const search *q, int32_t other)
{
    const lmn_scene *scene = q->s->scene;
    if (is_below(scene, other, q->node_index) || is_below(scene, q->node_index, other))
        return true;
    for (int32_t n = other; n != NONE; n = scene->nodes[n].parent) {
        bool moved = false;
        for (int k = PATH_TRANSLATION; k <= PATH_SCALE && !moved; k++)
            moved = schedule_property(q->s, (animation_path)k, n) != NONE;
        if (moved && is_below(scene, q->node_index, n))
            return true;
    }
    return false;
}

/* Limbs touch each other all the time; they meet where they have been apart. Half way since the hit before. */
static lmn_status were_apart(bool *out, search *q, const contact *c, double before, int32_t other, lmn_error *error)
{
    const lmn_scene *scene = q->s->scene;
    const double     then = (before + c->hit.seconds) / 2;
    moment           when = *q->clips;
    mat4             world = schedule_world(q->s, q->node_index, c->hit.seconds, SIDE_AT), back = mat4_inverse(&world);
    bool             near = false, *theirs = mem_calloc(scene->part_count + 1, sizeof *theirs);
    double           local[3], at[3];
    surface_place    there;
    if (!theirs)
        return error_memory(error);
    for (size_t i = 0; i < scene->part_count; i++)
        theirs[i] = q->sides.others[i] && scene->parts[i].node == other;
    transform_point(&back, c->hit.place, local);
    world = schedule_world(q->s, q->node_index, then, SIDE_AT);
    transform_point(&world, local, at);
    when.seconds = fmin(fmax(then, 0), moment_duration(&when, scene));
    lmn_status status = pose_move(&q->posed, &when, error);
    if (status == LMN_OK)
        status = surface_nearest(&there, &near, &q->posed, theirs, at, q->sides.reach, NULL, error);
    *out = !near;
    mem_free(theirs);
    return status;
}

/* Do both come together where the surface is, and go on together or apart? */
static lmn_status is_hit(bool *out, const search *q, const contact *c, int32_t other, double facing, lmn_error *error)
{
    static const time_side sides[] = {SIDE_BEFORE, SIDE_BEHIND};
    double                 apart[2][3] = {{0}}, theirs[3];
    lmn_status             status = LMN_OK;
    for (int i = 0; i < 2 && status == LMN_OK; i++) {
        status = velocity_of(apart[i], q, q->node_index, c->hit.place, c->hit.seconds, sides[i], error);
        if (status == LMN_OK)
            status = velocity_of(theirs, q, other, c->hit.place, c->hit.seconds, sides[i], error);
        if (status == LMN_OK)
            vector3_add(apart[i], apart[i], -1, theirs);
    }
    *out = status == LMN_OK && contact_is_hit(apart[0], apart[1], c->hit.normal, facing);
    return status;
}

/* A contact of what has been found in the motion; `before` is when the motion changed before. */
static lmn_status meet(contact *c, double before, search *q, lmn_error *error)
{
    const lmn_scene *scene = q->s->scene;
    moment           when = *q->clips;
    bool             found = false, near = false, hit = false;
    surface_place    there;
    when.seconds = fmin(fmax(c->hit.seconds, 0), moment_duration(&when, scene));
    lmn_status status = q->is_posed ? pose_move(&q->posed, &when, error) : pose_create(&q->posed, scene, &when, error);
    q->is_posed = true;
    if (status == LMN_OK)
        status = surface_outermost(c->hit.place, &found, &q->posed, q->sides.own, c->hit.normal, 1e-5 * q->sides.radius,
                                   error);
    if (status == LMN_OK && found)
        status =
            surface_nearest(&there, &near, &q->posed, q->sides.others, c->hit.place,
                            contact_reach(q->sides.reach, c->hit.before, c->hit.normal, c->hit.since, c->hit.until),
                            c->hit.normal, error);
    if (status == LMN_OK && near)
        status = is_hit(&hit, q, c, scene->parts[there.part].node, there.facing, error);
    if (status == LMN_OK && hit && are_kin(q, scene->parts[there.part].node)) {
        hit = there.distance <= q->sides.reach;
        if (hit)
            status = were_apart(&hit, q, c, before, scene->parts[there.part].node, error);
    }
    if (status == LMN_OK && hit) {
        c->other = scene->parts[there.part].node;
        c->distance = there.distance;
    }
    return status;
}

/* What has no surface meets nothing. */
static bool has_surface(const contact_sides *sides, const lmn_scene *scene)
{
    for (size_t i = 0; i < scene->part_count; i++)
        if (sides->own[i])
            return true;
    return false;
}

lmn_status contacts_find(contact **out, size_t *count, const schedule *s, const moment *clips, int32_t node_index,
                         double from, double to, double least, lmn_error *error)
{
    search  q = {.s = s, .clips = clips, .node_index = node_index};
    impact *hits = NULL;
    size_t  kept = 0;
    *out = NULL;
    *count = 0;
    lmn_status status = contact_sides_find(&q.sides, s->scene, node_index, error);
    if (status == LMN_OK && has_surface(&q.sides, s->scene))
        status = impacts_find(&hits, count, s, node_index, from, to, least, error);
    if (status == LMN_OK && *count > 0) {
        *out = mem_calloc(*count, sizeof **out);
        status = *out ? LMN_OK : error_memory(error);
    }
    for (size_t i = 0; i < *count && status == LMN_OK; i++) {
        contact *c = &(*out)[kept];
        *c = (contact){hits[i], NONE, 0};
        status = meet(c, i > 0 ? hits[i - 1].seconds : from, &q, error);
        kept += c->other != NONE || hits[i].thrown_back;
    }
    *count = kept;
    if (q.is_posed)
        pose_release(&q.posed);
    contact_sides_release(&q.sides);
    mem_free(hits);
    if (status != LMN_OK) {
        mem_free(*out);
        *out = NULL;
        *count = 0;
    }
    return status;
}

lmn_status schedule_of_moment(schedule *out, moment *clips, const lmn_scene *scene, const char *names, lmn_error *error)
{
    const struct behaviour *b = scene->behaviour;
    const bool              behaves = !names && b && b->root_count && b->written != NONE;
    *out = (schedule){.scene = scene};
    *clips = moment_at_rest();
    if (behaves)
        clips->clips[clips->clip_count++] = (uint32_t)b->written;
    lmn_status status = behaves ? LMN_OK : moment_find(clips, scene, names, 0, NULL, error);
    if (status != LMN_OK)
        return status;
    return behaves ? schedule_create(out, scene, error)
                   : schedule_of_clips(out, scene, clips->clips, clips->clip_count, error);
}
