#include "depict/movers.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "behaviour/carry.h"
#include "depict/meeting.h"
#include "scene/channel.h"

enum { LIMBS_LEAST = 4, STEPS = 48, SHAPES = 12 };

/* --- who moves -------------------------------------------------------------------------------------------------- */

/* What skins carry moves with their joints, and what has a camera or a light that changes is told of, too. */
static void add_carried(bool *moved, const lmn_scene *s, const moment *when)
{
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        for (size_t k = 0; n->skin != NONE && k < s->skins[n->skin].joint_count && !moved[s->parts[i].node]; k++)
            moved[s->parts[i].node] = moved[s->skins[n->skin].joints[k]];
    }
    for (size_t k = 0; k < when->clip_count; k++) {
        const animation *a = &s->animations[when->clips[k]];
        for (size_t c = 0; c < a->channel_count; c++) {
            const animated_thing thing = animation_thing_of(a->channels[c].path);
            for (size_t i = 0; i < s->node_count && thing != ANIMATED_NODE; i++)
                if (a->channels[c].target == (thing == ANIMATED_CAMERA ? s->nodes[i].camera : s->nodes[i].light))
                    moved[i] = true;
        }
    }
}

/* A flag a node: is there anything above it that has the flag? Parents may come behind their children. */
static bool is_below_any(const lmn_scene *s, int32_t node, const bool *set)
{
    for (int32_t n = s->nodes[node].parent; n != NONE; n = s->nodes[n].parent)
        if (set[n])
            return true;
    return false;
}

/* What a node has at itself and below it. */
typedef struct contents {
    bool   part, camera, light;
    size_t joints; /* nodes that move by themselves */
} contents;

static contents contents_of(const lmn_scene *s, int32_t node, const bool *moved, const bool *parts)
{
    contents c = {false, false, false, 0};
    for (int32_t n = node; n != NONE; n = scene_next_node(s, node, n)) {
        c.part = c.part || parts[n];
        c.camera = c.camera || s->nodes[n].camera != NONE;
        c.light = c.light || s->nodes[n].light != NONE;
        c.joints += moved[n];
    }
    return c;
}

/* --- how ---------------------------------------------------------------------------------------------------------- */

/* Angle between two orientations, radians. */
static double angle_between(const mat4 *a, const mat4 *b)
{
    double trace = 0;
    for (int c = 0; c < 3; c++) {
        double la = vector3_length(&a->m[4 * c]), lb = vector3_length(&b->m[4 * c]);
        trace += la > 0 && lb > 0 ? vector3_dot(&a->m[4 * c], &b->m[4 * c]) / (la * lb) : 1;
    }
    return acos(fmin(fmax((trace - 1) / 2, -1), 1));
}

/* Of the changes of velocity those where it hits something. */
static lmn_status count_hits(mover *m, const depict_job *j, const depict_target *t, span all, lmn_error *error)
{
    depict_impact impacts[MOVER_HITS];
    size_t        count = 0;
    lmn_status    status = target_hits(impacts, MOVER_HITS, &count, t, all.from, all.to, error);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        bool    hits = false;
        int32_t whom = NONE;
        status = meeting_touches(&hits, &whom, j, t, &impacts[i], error);
        if (!hits)
            continue;
        m->hit = m->hits == 0 || m->hit == whom ? whom : NONE;
        m->hit_times[m->hits] = impacts[i].time;
        m->hit_whom[m->hits++] = whom;
    }
    return status;
}

/* The piece around now in which sizes at even times only grow or only shrink. What rests now will change, or else has
 * changed. */
static void find_growth(mover *m, const double *sizes, int steps, span all, double now)
{
    const double step = (all.to - all.from) / steps;
    const int    here = (int)fmin(fmax(step > 0 ? (now - all.from) / step : 0, 0), steps - 1);
    double       low = INFINITY, high = 0;
    int          nearest = -1;
    for (int i = 0; i <= steps; i++) {
        low = fmin(low, sizes[i]);
        high = fmax(high, sizes[i]);
    }
    const double least = 1e-4 * high;
    m->scaled = !(high > 0) ? 1 : low > 1e-2 * high ? high / low : 100; /* from nothing, too */
    m->growth = 1;
    m->grows = all;
    for (int i = 0; i < steps; i++) {
        const int away = i >= here ? i - here : 2 * (here - i), best = nearest < 0       ? 3 * steps
                                                                       : nearest >= here ? nearest - here
                                                                                         : 2 * (here - nearest);
        if (fabs(sizes[i + 1] - sizes[i]) > least && away < best)
            nearest = i;
    }
    if (nearest < 0)
        return;
    const double sense = sizes[nearest + 1] > sizes[nearest] ? 1 : -1;
    int          first = nearest, end = nearest + 1;
    while (first > 0 && sense * (sizes[first] - sizes[first - 1]) > least)
        first--;
    while (end < steps && sense * (sizes[end + 1] - sizes[end]) > least)
        end++;
    m->grows = (span){all.from + step * first, all.from + step * end};
    m->growth = fmin(fmax(sizes[end] / fmax(sizes[first], 1e-2 * high), 1e-2), 1e2);
}

/* Is half of a way's length and more gone back within a quarter of the radius? Of its length, not of its time: what
 * sways where it waits goes nowhere. */
static bool goes_back(const double (*at)[3], double radius)
{
    double all = 0, back = 0;
    for (int i = 1; i < STEPS; i++) {
        double here[3], there[3];
        vector3_add(here, at[i + 1], -1, at[i - 1]);
        all += vector3_length(here);
        for (int k = i + 2; k < STEPS; k++) {
            vector3_add(there, at[k + 1], -1, at[k - 1]);
            if (vector3_distance(at[i], at[k]) < 0.25 * radius &&
                vector3_dot(here, there) < -0.8 * vector3_length(here) * vector3_length(there)) {
                back += 2 * vector3_length(here);
                break;
            }
        }
    }
    return 2 * back > all;
}

static void measure_way(mover *m, const depict_target *t, span all, double now)
{
    double sizes[STEPS + 1], points[STEPS + 1][3], last_at[3], at[3], own[3];
    mat4   last = way_world(&t->way, all.from);
    way_point(&t->way, t->centre, all.from, last_at);
    for (int i = 0; i <= STEPS; i++) {
        const double seconds = all.from + (all.to - all.from) * i / STEPS;
        mat4         here = way_world(&t->way, seconds);
        way_point(&t->way, t->centre, seconds, at);
        vector3_copy(points[i], at);
        m->length += vector3_distance(last_at, at);
        m->turned += angle_between(&last, &here);
        vector3_add(own, &here.m[12], -1, &last.m[12]);
        m->origin += vector3_length(own);
        sizes[i] = cbrt(fabs(mat4_cofactors(&here, (double[9]){0})));
        vector3_copy(last_at, at);
        last = here;
    }
    find_growth(m, sizes, STEPS, all, now);
    m->doubles = goes_back((const double(*)[3])points, t->radius);
}

/* The middle of vertices, and how far they are from it in the mean square. */
static double spread_of(const vec3 *vertices, size_t count, double middle[3])
{
    double sum = 0;
    vector3_set(middle, 0, 0, 0);
    for (size_t i = 0; i < count; i++) {
        const double p[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z};
        vector3_add(middle, middle, 1.0 / (double)count, p);
    }
    for (size_t i = 0; i < count; i++) {
        const double p[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z};
        sum += pow(vector3_distance(p, middle), 2);
    }
    return count ? sqrt(sum / (double)count) : 0;
}

/* How far vertices are from where they were, were all moved as their middle. */
static double shape_apart(const vec3 *a, const double middle_a[3], const vec3 *b, const double middle_b[3],
                          size_t count)
{
    double far = 0;
    for (size_t i = 0; i < count; i++) {
        const double x = (double)b[i].x - (double)a[i].x - (middle_b[0] - middle_a[0]),
                     y = (double)b[i].y - (double)a[i].y - (middle_b[1] - middle_a[1]),
                     z = (double)b[i].z - (double)a[i].z - (middle_b[2] - middle_a[2]);
        far = fmax(far, sqrt(x * x + y * y + z * z));
    }
    return far;
}

/* Of what has morph targets: how its shape changes, and whether it grows by that. */
static lmn_status measure_shape(mover *m, const depict_job *j, const depict_target *t, span all, double now,
                                lmn_error *error)
{
    double     sizes[SHAPES + 1], begin[3] = {0, 0, 0}, middle[3];
    vec3      *first = NULL, *vertices = NULL;
    size_t     count = 0, found = 0;
    lmn_status status = target_vertices(&first, &count, j, t, all.from, error);
    for (int i = 0; i <= SHAPES && status == LMN_OK; i++) {
        status = target_vertices(&vertices, &found, j, t, all.from + (all.to - all.from) * i / SHAPES, error);
        sizes[i] = spread_of(vertices, found, middle);
        if (i == 0)
            vector3_copy(begin, middle);
        m->shaped = fmax(m->shaped, shape_apart(first, begin, vertices, middle, found < count ? found : count));
        mem_free(vertices);
    }
    mem_free(first);
    if (status == LMN_OK)
        find_growth(m, sizes, SHAPES, all, now);
    return status;
}

static bool has_morphs(const depict_job *j, const depict_target *t)
{
    for (size_t k = 0; k < j->when.clip_count; k++) {
        const animation *a = &j->scene->animations[j->when.clips[k]];
        for (size_t c = 0; c < a->channel_count; c++)
            for (size_t i = 0; i < t->part_count && a->channels[c].path == PATH_WEIGHTS; i++)
                if (t->parts[i] && j->scene->parts[i].node == a->channels[c].target)
                    return true;
    }
    return false;
}

/* How much larger things become in a camera's picture. */
static double zoom_of(const depict_job *j, int32_t node, span all)
{
    double zoomed = 1;
    for (size_t k = 0; k < j->when.clip_count; k++) {
        const animation *a = &j->scene->animations[j->when.clips[k]];
        for (size_t c = 0; c < a->channel_count; c++) {
            const animation_channel *channel = &a->channels[c];
            double                   low = INFINITY, high = 0;
            bool                     own = false;
            for (int32_t n = node; n != NONE && !own && animation_thing_of(channel->path) == ANIMATED_CAMERA;
                 n = scene_next_node(j->scene, node, n))
                own = j->scene->nodes[n].camera == channel->target;
            for (int i = 0; i <= STEPS && own && channel->key_count > 0; i++) {
                double value = 0;
                animation_channel_at(channel, all.from + (all.to - all.from) * i / STEPS, &value);
                value = channel->path == PATH_CAMERA_FOV ? tan(value / 2) : value;
                low = fmin(low, value);
                high = fmax(high, value);
            }
            zoomed = fmax(zoomed, low > 0 && high > 0 ? high / low : 1);
        }
    }
    return zoomed;
}

static lmn_status measure(mover *m, const depict_job *j, span all, double now, lmn_error *error)
{
    depict_target t;
    lmn_status    status = target_open(&t, j, m->node, error);
    if (status == LMN_OK) {
        m->radius = t.radius;
        m->reach = t.reach;
        measure_way(m, &t, all, now);
        m->zoomed = m->camera ? zoom_of(j, m->node, all) : 1;
        for (size_t i = 0; i < t.part_count; i++)
            m->figure = m->figure || (t.parts[i] && j->scene->nodes[j->scene->parts[i].node].skin != NONE);
        m->morphs = !m->figure && has_morphs(j, &t);
        if (m->morphs)
            status = measure_shape(m, j, &t, all, now, error);
        if (status == LMN_OK)
            status = count_hits(m, j, &t, all, error);
        m->weight = m->length + m->shaped +
                    m->radius * (fmin(m->turned, 6) + fabs(log(m->scaled)) + log(m->zoomed) + (m->figure ? 1 : 0));
    }
    target_release(&t);
    return status;
}

/* --- all of them -------------------------------------------------------------------------------------------------- */

static int compare_movers(const void *a, const void *b)
{
    const mover *x = a, *y = b;
    if (x->weight != y->weight)
        return x->weight < y->weight ? 1 : -1;
    return (x->node > y->node) - (x->node < y->node);
}

static lmn_status find_all(mover_list *out, const depict_job *j, span all, double now, const bool *moved,
                           const bool *parts, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < j->scene->node_count && status == LMN_OK; i++) {
        if (!moved[i] || is_below_any(j->scene, (int32_t)i, moved))
            continue;
        const contents c = contents_of(j->scene, (int32_t)i, moved, parts);
        if (!c.part && !c.camera && !c.light)
            continue;
        mover m = {.node = (int32_t)i, .hit = NONE, .camera = c.camera && !c.part};
        m.light = c.light && !c.part && !c.camera;
        m.figure = c.joints > LIMBS_LEAST;
        status = measure(&m, j, all, now, error);
        if (status == LMN_OK && !mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
            status = error_memory(error);
        if (status == LMN_OK)
            out->items[out->count++] = m;
    }
    return status;
}

lmn_status movers_find(mover_list *out, const depict_job *j, double from, double to, double now, lmn_error *error)
{
    const lmn_scene *s = j->scene;
    bool            *moved = depict_moved_nodes(s, &j->when), *parts = mem_calloc(s->node_count + 1, sizeof *parts);
    memset(out, 0, sizeof *out);
    lmn_status status = moved && parts ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        add_carried(moved, s, &j->when);
        for (size_t i = 0; i < s->part_count; i++)
            parts[s->parts[i].node] = true;
        status = find_all(out, j, (span){from, to}, now, moved, parts, error);
    }
    mem_free(moved);
    mem_free(parts);
    if (out->count > 1)
        qsort(out->items, out->count, sizeof *out->items, compare_movers);
    return status;
}

void movers_release(mover_list *l)
{
    mem_free(l->items);
    memset(l, 0, sizeof *l);
}

/* --- limbs -------------------------------------------------------------------------------------------------------- */

/* The search for the one that goes farthest. */
typedef struct limbs {
    const depict_job *j;
    const bool       *moved;
    bool             *carried;
    double (*tips)[3], (*last)[3], *gone;
    pose posed;
    bool is_posed;
} limbs;

static bool is_of(const lmn_scene *s, int32_t node, int32_t above)
{
    /* Joints of a skin may lie beside what it carries. */
    if (s->nodes[above].skin != NONE) {
        const skin *k = &s->skins[s->nodes[above].skin];
        for (size_t i = 0; i < k->joint_count; i++)
            if (k->joints[i] == node)
                return true;
    }
    while (node != NONE && node != above)
        node = s->nodes[node].parent;
    return node != NONE;
}

/* Where all ends are at a time, and how far each has gone since the time before. */
static lmn_status step_to(limbs *l, double seconds, bool first, lmn_error *error)
{
    moment when = l->j->when;
    when.seconds = seconds;
    lmn_status status =
        l->is_posed ? pose_move(&l->posed, &when, error) : pose_create(&l->posed, l->j->scene, &when, error);
    l->is_posed = true;
    for (size_t i = 0; i < l->j->scene->node_count && status == LMN_OK; i++) {
        const mat4 *m = &l->posed.worlds[i];
        double      at[3];
        if (!l->moved[i])
            continue;
        for (int k = 0; k < 3; k++)
            at[k] = m->m[k] * l->tips[i][0] + m->m[4 + k] * l->tips[i][1] + m->m[8 + k] * l->tips[i][2] + m->m[12 + k];
        l->gone[i] += first ? 0 : vector3_distance(at, l->last[i]);
        vector3_copy(l->last[i], at);
    }
    return status;
}

/* The farthest of those that carry anything. */
static void take_farthest(int32_t *out, double *length, limbs *l, int32_t node)
{
    const lmn_scene *s = l->j->scene;
    for (;;) {
        int32_t best = NONE;
        for (size_t i = 0; i < s->node_count; i++)
            if (l->moved[i] && l->gone[i] > 0 && (best == NONE || l->gone[i] > l->gone[best]))
                best = (int32_t)i;
        if (best == NONE)
            return;
        if (is_of(s, best, node) && l->carried[best]) {
            *out = best;
            *length = l->gone[best];
            return;
        }
        l->gone[best] = 0;
    }
}

lmn_status mover_limb(int32_t *out, double *length, const depict_job *j, int32_t node, double from, double to,
                      lmn_error *error)
{
    enum { MOMENTS = 16 };
    const lmn_scene *s = j->scene;
    limbs            l = {.j = j, .moved = depict_moved_nodes(s, &j->when)};
    l.carried = mem_calloc(s->node_count + 1, sizeof *l.carried);
    l.tips = mem_calloc(s->node_count + 1, sizeof *l.tips);
    l.last = mem_calloc(s->node_count + 1, sizeof *l.last);
    l.gone = mem_calloc(s->node_count + 1, sizeof *l.gone);
    lmn_status status = l.moved && l.carried && l.tips && l.last && l.gone ? LMN_OK : error_memory(error);
    *out = NONE;
    *length = 0;
    if (status == LMN_OK)
        node_tips(l.tips, l.carried, s, l.moved);
    for (int k = 0; k <= MOMENTS && status == LMN_OK && to > from; k++)
        status = step_to(&l, from + (to - from) * k / MOMENTS, k == 0, error);
    if (status == LMN_OK)
        take_farthest(out, length, &l, node);
    if (l.is_posed)
        pose_release(&l.posed);
    mem_free((bool *)l.moved);
    mem_free(l.carried);
    mem_free(l.tips);
    mem_free(l.last);
    mem_free(l.gone);
    return status;
}
