#include "contact/contact.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "contact/surface.h"
#include "contact/touch.h"
#include "scene/content.h"

static bool is_below(const lmn_scene *s, int32_t node_index, int32_t above)
{
    while (node_index != NONE && node_index != above)
        node_index = s->nodes[node_index].parent;
    return node_index != NONE;
}

void box_sides(box3 box, double out[BOX_SIDES][3])
{
    const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z},
                 high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    for (int i = 0; i < BOX_SIDES; i++)
        for (int k = 0; k < 3; k++)
            out[i][k] = box3_is_empty(box) ? 0 : i / 2 != k ? (low[k] + high[k]) / 2 : i % 2 ? high[k] : low[k];
}

lmn_status contact_sides_find(contact_sides *out, const lmn_scene *s, int32_t node_index, lmn_error *error)
{
    box3 box = box3_empty();
    *out = (contact_sides){.own = mem_calloc(s->part_count + 1, sizeof(bool)),
                           .others = mem_calloc(s->part_count + 1, sizeof(bool))};
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
    box_sides(box, out->outermost);
    out->radius = box3_is_empty(box) ? 0 : box3_diagonal(box) / (2 * sqrt(3));
    out->reach = CONTACT_REACH * out->radius;
    return LMN_OK;
}

void contact_sides_release(contact_sides *s)
{
    mem_free(s->own);
    mem_free(s->others);
    memset(s, 0, sizeof *s);
}

bool contact_is_hit(const double before[3], const double after[3], const double normal[3])
{
    double change[3];
    vector3_add(change, after, -1, before);
    const double in = -vector3_dot(before, normal), out = vector3_dot(after, normal);
    return in > 0 && in >= 0.1 * vector3_length(change) && out >= -0.1 * in;
}

bool contact_is_off_hinge(const double place_velocity[3], const double farthest_velocity[3])
{
    return vector3_length(place_velocity) > 0.25 * vector3_length(farthest_velocity);
}

double contact_reach(double reach, const double before[3], double since, double until)
{
    const bool sampled = since > 0 && until > 0 && since <= 0.05 && until <= 0.05;
    return reach + (sampled ? vector3_length(before) * fmin(since, until) : 0);
}

/* The search for contacts of one node. */
typedef struct search {
    const schedule *s;
    const moment   *clips;
    int32_t         node_index;
    contact_sides   sides;
    pose            posed, earlier;
    bool            is_posed, is_earlier;
    const impact   *hit;      /* that is looked at */
    double          before;   /* when the motion changed before it */
    double          point[3]; /* of the node, in its axes: whose motion tells when it hits something */
    bool            turns;    /* on the spot: it is not the origin */
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

static lmn_status pose_at(pose *posed, bool *is_posed, const search *q, double seconds, lmn_error *error)
{
    moment when = *q->clips;
    when.seconds = fmin(fmax(seconds, 0), moment_duration(&when, q->s->scene));
    lmn_status status = *is_posed ? pose_move(posed, &when, error) : pose_create(posed, q->s->scene, &when, error);
    *is_posed = true;
    return status;
}

/* Limbs touch each other all the time, and so does a door its hinge; they meet where they have been apart. Half way
 * since the hit before, or, of what turns on the spot, when the place was three reaches farther off, if that is longer
 * ago. */
static lmn_status were_apart(bool *out, search *q, const touch *t, int32_t other, double speed, lmn_error *error)
{
    const lmn_scene *scene = q->s->scene;
    const double     since = (q->hit->seconds - q->before) / 2,
                 then = q->hit->seconds -
                        (q->turns ? fmax(since, fmin(3 * q->sides.reach / speed, q->hit->seconds)) : since);
    mat4          world = schedule_world(q->s, q->node_index, q->hit->seconds, SIDE_AT), back = mat4_inverse(&world);
    bool          near = false, *theirs = mem_calloc(scene->part_count + 1, sizeof *theirs);
    double        local[3], at[3];
    surface_place there;
    if (!theirs)
        return error_memory(error);
    for (size_t i = 0; i < scene->part_count; i++)
        theirs[i] = q->sides.others[i] && scene->parts[i].node == other;
    transform_point(&back, t->place, local);
    world = schedule_world(q->s, q->node_index, then, SIDE_AT);
    transform_point(&world, local, at);
    lmn_status status = pose_at(&q->earlier, &q->is_earlier, q, then, error);
    if (status == LMN_OK)
        status = surface_nearest(&there, &near, &q->earlier, theirs, at, q->sides.reach, error);
    *out = !near;
    mem_free(theirs);
    return status;
}

/* How fast it comes to a place of another part, or leaves it. */
static lmn_status relative_velocity(double out[3], const search *q, size_t part, const double place[3], time_side side,
                                    lmn_error *error)
{
    double     theirs[3];
    lmn_status status = velocity_of(out, q, q->node_index, place, q->hit->seconds, side, error);
    if (status == LMN_OK)
        status = velocity_of(theirs, q, q->s->scene->parts[part].node, place, q->hit->seconds, side, error);
    if (status == LMN_OK)
        vector3_add(out, out, -1, theirs);
    return status;
}

static lmn_status approach(double out[3], void *user, size_t part, const double place[3], lmn_error *error)
{
    return relative_velocity(out, user, part, place, SIDE_BEFORE, error);
}

/* Do both come together where the surface is, and go on together or apart? What is one body, and what turns on the
 * spot, have been apart, too. */
static lmn_status accepts(bool *out, void *user, const touch *found, lmn_error *error)
{
    search       *q = user;
    double        before[3], after[3];
    const int32_t other = q->s->scene->parts[found->part].node;
    lmn_status    status = relative_velocity(before, q, found->part, found->place, SIDE_BEFORE, error);
    if (status == LMN_OK)
        status = relative_velocity(after, q, found->part, found->place, SIDE_BEHIND, error);
    *out = status == LMN_OK && contact_is_hit(before, after, found->normal);
    if (!*out || !(q->turns || are_kin(q, other)))
        return status;
    *out = fabs(found->gap) <= q->sides.reach && (!q->turns || contact_is_off_hinge(before, q->hit->before));
    return *out ? were_apart(out, q, found, other, vector3_length(before), error) : LMN_OK;
}

/* Where nothing is met it touches with what is outermost. */
static lmn_status take_outermost(contact *c, const search *q, lmn_error *error)
{
    bool found;
    return surface_outermost(c->hit.place, &found, &q->posed, q->sides.own, c->hit.normal, 1e-5 * q->sides.radius,
                             error);
}

/* Of what turns each place has its own velocity: that where it is hit. */
static lmn_status take_velocities(contact *c, const search *q, lmn_error *error)
{
    double     change[3];
    lmn_status status = velocity_of(c->hit.before, q, q->node_index, c->hit.place, q->hit->seconds, SIDE_BEFORE, error);
    if (status == LMN_OK)
        status = velocity_of(c->hit.after, q, q->node_index, c->hit.place, q->hit->seconds, SIDE_BEHIND, error);
    vector3_add(change, c->hit.after, -1, c->hit.before);
    c->hit.speed = vector3_length(change);
    return status;
}

/* A contact of what has been found in the motion. */
static lmn_status meet(contact *c, search *q, lmn_error *error)
{
    touch              there;
    bool               touches = false;
    const touch_motion motion = {approach, accepts, q,
                                 contact_reach(q->sides.reach, q->hit->before, q->hit->since, q->hit->until), q->turns};
    lmn_status         status = pose_at(&q->posed, &q->is_posed, q, q->hit->seconds, error);
    if (status == LMN_OK)
        status = touch_find(&there, &touches, &q->posed, q->sides.own, q->sides.others, &motion, error);
    if (status != LMN_OK || !touches)
        return status == LMN_OK ? take_outermost(c, q, error) : status;
    c->other = q->s->scene->parts[there.part].node;
    c->distance = fabs(there.gap);
    vector3_copy(c->hit.place, there.place);
    vector3_copy(c->hit.normal, there.normal);
    return q->turns ? take_velocities(c, q, error) : LMN_OK;
}

/* How far a point of the node goes. */
static double way_of(const search *q, const double point[3], double from, double to)
{
    enum { STEPS = 32 };
    double length = 0, at[3], last[3] = {0, 0, 0};
    for (int i = 0; i <= STEPS; i++) {
        const mat4 world = schedule_world(q->s, q->node_index, from + (to - from) * i / STEPS, SIDE_AT);
        transform_point(&world, point, at);
        length += i > 0 ? vector3_distance(at, last) : 0;
        vector3_copy(last, at);
    }
    return length;
}

static bool is_turned(const search *q)
{
    bool turned = false;
    for (int32_t n = q->node_index; n != NONE && !turned; n = q->s->scene->nodes[n].parent)
        turned = schedule_property(q->s, PATH_ROTATION, n) != NONE;
    return turned;
}

/* What goes about its origin, which stays or hardly moves, has an outermost place that goes farthest. */
static lmn_status find_point(search *q, double from, double to, lmn_error *error)
{
    const double on_the_spot = 0.3; /* of the farthest way */
    mat4        *worlds = is_turned(q) ? scene_world_matrices(q->s->scene, NULL) : NULL;
    if (!worlds)
        return is_turned(q) ? error_memory(error) : LMN_OK;
    const mat4   inverse = mat4_inverse(&worlds[q->node_index]);
    const double own = way_of(q, q->point, from, to);
    double       farthest = 0;
    mem_free(worlds);
    for (int i = 0; i < BOX_SIDES; i++) {
        double point[3];
        transform_point(&inverse, q->sides.outermost[i], point);
        const double length = way_of(q, point, from, to);
        if (length > farthest && own < on_the_spot * length) {
            farthest = length;
            vector3_copy(q->point, point);
            q->turns = true;
        }
    }
    return LMN_OK;
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
    const bool solid = status == LMN_OK && has_surface(&q.sides, s->scene);
    if (solid)
        status = find_point(&q, from, to, error);
    if (solid && status == LMN_OK)
        status = impacts_find(&hits, count, s, node_index, q.point, from, to, least, error);
    if (status == LMN_OK && *count > 0) {
        *out = mem_calloc(*count, sizeof **out);
        status = *out ? LMN_OK : error_memory(error);
    }
    for (size_t i = 0; i < *count && status == LMN_OK; i++) {
        contact *c = &(*out)[kept];
        *c = (contact){hits[i], NONE, 0};
        q.hit = &hits[i];
        q.before = i > 0 ? hits[i - 1].seconds : from;
        status = meet(c, &q, error);
        kept += c->other != NONE || hits[i].thrown_back;
    }
    *count = kept;
    if (q.is_posed)
        pose_release(&q.posed);
    if (q.is_earlier)
        pose_release(&q.earlier);
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
