#include "pose/deform.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "pose/animate.h"
#include "pose/pose.h"
#include "scene/mesh.h"
#include "scene/solid.h"

enum { BEFORE, NOW, AFTER, TIMES };

/* What moves as one: a node with all below it, or a character with its skeleton. */
typedef struct body {
    int32_t          root;
    bool             skinned;
    double           weight, centre[TIMES][3];
    box3             rest, box;              /* at rest, and now */
    double           size;                   /* of its box at rest */
    double           velocity[3], change[3]; /* around now; and by how much it changes within the response */
    double           before, speed;          /* how fast it came along the change; how fast it is */
    bool             still;                  /* its middle keeps its place */
    bool             hinged;                 /* its own origin stays: it turns about it */
    double           origin[3];
    double           stop;    /* how far it reaches against the change: what stops it is there */
    bool             on_spot; /* it turns about its middle, or only joints of a character move */
    bool             bends;
    double           front, rear, middle[3], across[3], low, high, farthest;
    double           late; /* the most of its parts */
    bool             dragged;
    part_deformation how; /* of nodes without geometry */
} body;

typedef struct finder {
    deformed_nodes         *out;
    const pose             *p;
    const pose_deformation *wanted;
    mat4                   *worlds[TIMES]; /* that of now is the pose's */
    double                  seconds[TIMES];
    int32_t                *body_of_node, *body_of_part, *part_of_node;
    body                   *bodies;
    size_t                  body_count, body_capacity;
    int                     up;
    box3                    whole; /* the scene at rest */
} finder;

bool part_deformation_is_none(const part_deformation *d)
{
    return d->stretch == 0 && d->squash == 0 && d->lean == 0 && d->inertia == 0 && d->slit == 0 && d->lag == 0 &&
           d->comb == 0 && d->drag == 0;
}

bool part_deformation_bends(const part_deformation *d)
{
    return d->lag + d->comb + d->drag > 0;
}

void pose_deformation_release(pose_deformation *d)
{
    mem_free(d->parts);
    memset(d, 0, sizeof *d);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* To length 1; 0 where there is none. Returns the length. */
static double to_unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++)
        v[k] = length > 0 ? v[k] / length : 0;
    return length;
}

static void transform(const mat4 *m, const double p[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * p[0] + m->m[4 + k] * p[1] + m->m[8 + k] * p[2] + m->m[12 + k];
}

/* --- three times ------------------------------------------------------------------------------------------ */

static lmn_status worlds_at(mat4 **out, const pose *p, double seconds, lmn_error *error)
{
    animated_state moved;
    moment         when = p->when;
    when.deformation = NULL;
    when.seconds = seconds;
    lmn_status status = animate(&moved, p->scene, &when, error);
    *out = status == LMN_OK ? scene_world_matrices(p->scene, moved.locals) : NULL;
    animated_state_release(&moved);
    return status == LMN_OK && !*out ? error_memory(error) : status;
}

/* Times around now; at the ends of clips there is only one side. */
static lmn_status open_times(finder *f, lmn_error *error)
{
    const pose *p = f->p;
    double      end = moment_duration(&p->when, p->scene);
    f->seconds[BEFORE] = fmax(p->when.seconds - f->wanted->response, 0);
    f->seconds[NOW] = p->when.seconds;
    f->seconds[AFTER] = fmin(p->when.seconds + f->wanted->response, end);
    f->worlds[NOW] = p->worlds;
    lmn_status status = worlds_at(&f->worlds[BEFORE], p, f->seconds[BEFORE], error);
    return status == LMN_OK ? worlds_at(&f->worlds[AFTER], p, f->seconds[AFTER], error) : status;
}

static bool node_moves(const finder *f, int32_t i)
{
    return memcmp(&f->worlds[NOW][i], &f->worlds[BEFORE][i], sizeof(mat4)) != 0 ||
           memcmp(&f->worlds[NOW][i], &f->worlds[AFTER][i], sizeof(mat4)) != 0;
}

/* --- bodies ----------------------------------------------------------------------------------------------- */

static const skin *skin_of(const lmn_scene *s, const node *n)
{
    return n->mesh != NONE && n->skin != NONE && s->skins[n->skin].joint_count > 0 ? &s->skins[n->skin] : NULL;
}

static bool is_above(const lmn_scene *s, int32_t above, int32_t i)
{
    while (i != NONE && i != above)
        i = s->nodes[i].parent;
    return i != NONE;
}

/* The lowest node with all joints of a skin below it; NONE: there is none. */
static int32_t above_joints(const lmn_scene *s, const skin *k)
{
    int32_t out = k->joints[0];
    for (size_t i = 1; i < k->joint_count; i++)
        while (out != NONE && !is_above(s, out, k->joints[i]))
            out = s->nodes[out].parent;
    return out;
}

/* The uppermost node that moves above a part or its skeleton; of skeletons of which only what is below moves, the one
 * above all of it. NONE: nothing does. */
static int32_t root_of(const finder *f, size_t part)
{
    const lmn_scene *s = f->p->scene;
    int32_t          own = s->parts[part].node, found = NONE;
    const skin      *k = skin_of(s, &s->nodes[own]);
    int32_t          lowest = k ? above_joints(s, k) : own;
    for (int32_t i = lowest; i != NONE; i = s->nodes[i].parent)
        found = node_moves(f, i) ? i : found;
    for (size_t i = 0; k && found == NONE && i < k->joint_count; i++)
        found = node_moves(f, k->joints[i]) ? lowest : found;
    return found;
}

static size_t settings_of(const finder *f, size_t part)
{
    size_t owner = scene_part_of_ghost(f->p->scene, part);
    return owner == SIZE_MAX ? part : owner;
}

static bool find_bodies(finder *f)
{
    const pose *p = f->p;
    size_t      all = p->part_count + p->ghost_count;
    for (size_t i = 0; i < p->scene->node_count; i++)
        f->body_of_node[i] = f->part_of_node[i] = NONE;
    for (size_t i = 0; i < all; i++) {
        const node *n = &p->scene->nodes[p->scene->parts[i].node];
        f->part_of_node[p->scene->parts[i].node] = (int32_t)i;
        f->body_of_part[i] = NONE;
        const part_deformation *how = &f->wanted->parts[settings_of(f, i)];
        int32_t                 root = part_deformation_is_none(how) ? NONE : root_of(f, i);
        if (root == NONE)
            continue;
        if (f->body_of_node[root] == NONE) {
            if (!mem_grow((void **)&f->bodies, &f->body_capacity, f->body_count + 1, sizeof *f->bodies))
                return false;
            f->bodies[f->body_count] = (body){.root = root, .how = *how, .rest = box3_empty(), .box = box3_empty()};
            f->body_of_node[root] = (int32_t)f->body_count++;
        }
        body *b = &f->bodies[f->body_of_node[root]];
        if (skin_of(p->scene, n) && !b->skinned)
            b->how = *how; /* its joints are nodes without geometry */
        b->skinned = b->skinned || skin_of(p->scene, n);
        b->late = fmax(b->late, how->lag + how->comb);
        b->dragged = b->dragged || how->drag > 0;
        f->body_of_part[i] = f->body_of_node[root];
    }
    return true;
}

/* The body that a node belongs to; NONE. */
static int32_t body_above(const finder *f, int32_t i)
{
    while (i != NONE && f->body_of_node[i] == NONE)
        i = f->p->scene->nodes[i].parent;
    return i != NONE ? f->body_of_node[i] : NONE;
}

/* --- middles ---------------------------------------------------------------------------------------------- */

static void add_centre(body *b, int time, double weight, const double at[3])
{
    for (int k = 0; k < 3; k++)
        b->centre[time][k] += weight * at[k];
}

/* The mean of a skin's vertices at all times: that is linear in the joints, which are summed up once. False: out of
 * memory. */
static bool add_skinned(finder *f, body *b, const node *n, double weight)
{
    const lmn_scene *s = f->p->scene;
    const mesh      *m = &s->meshes[n->mesh];
    const skin      *k = &s->skins[n->skin];
    double(*sums)[4] = mem_calloc(k->joint_count, sizeof *sums);
    double total = 0;
    for (size_t i = 0; sums && i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        size_t           count = p->joints && p->weights ? (size_t)p->vertex_count * p->influences : 0;
        for (size_t w = 0; w < count; w++) {
            if (p->joints[w] >= k->joint_count)
                continue;
            vec3   at = p->positions[w / p->influences];
            double own = (double)p->weights[w], *sum = sums[p->joints[w]];
            sum[0] += own * (double)at.x;
            sum[1] += own * (double)at.y;
            sum[2] += own * (double)at.z;
            sum[3] += own;
            total += own;
        }
    }
    for (int t = 0; sums && total > 0 && t < TIMES; t++)
        for (size_t j = 0; j < k->joint_count; j++) {
            const mat4 *world = &f->worlds[t][k->joints[j]];
            mat4        joint = k->inverse_binds ? mat4_multiply(world, &k->inverse_binds[j]) : *world;
            double      at[3];
            for (int r = 0; r < 3; r++)
                at[r] = joint.m[r] * sums[j][0] + joint.m[4 + r] * sums[j][1] + joint.m[8 + r] * sums[j][2] +
                        joint.m[12 + r] * sums[j][3];
            add_centre(b, t, weight / total, at);
        }
    b->weight += total > 0 ? weight : 0;
    mem_free(sums);
    return sums;
}

/* The middle of a part's box in its node's axes. */
static bool own_middle(const lmn_scene *s, const node *n, double out[3])
{
    box3 box = n->solid != NONE ? solid_bounds(&s->solids[n->solid]) : box3_empty();
    for (size_t i = 0; n->mesh != NONE && i < s->meshes[n->mesh].primitive_count; i++)
        box = box3_union(box, s->meshes[n->mesh].primitives[i].bounds);
    if (box3_is_empty(box))
        return false;
    box3_middle(box, out);
    return true;
}

static void add_rigid(finder *f, body *b, const node *n, int32_t node_index, double weight)
{
    double middle[3], placed[3], at[3];
    size_t draws = node_draw_count(n);
    if (!own_middle(f->p->scene, n, middle))
        return;
    for (size_t i = 0; i < draws; i++) {
        memcpy(placed, middle, sizeof placed);
        if (n->instance_count)
            transform(&n->instances[i], middle, placed);
        for (int t = 0; t < TIMES; t++) {
            transform(&f->worlds[t][node_index], placed, at);
            add_centre(b, t, weight / (double)draws, at);
        }
    }
    b->weight += weight;
}

/* Parts count as their boxes' squares do. */
static bool find_middles(finder *f)
{
    const lmn_scene *s = f->p->scene;
    bool             good = true;
    for (size_t i = 0; i < f->p->part_count && good; i++) {
        if (f->body_of_part[i] == NONE)
            continue;
        body       *b = &f->bodies[f->body_of_part[i]];
        const node *n = &s->nodes[s->parts[i].node];
        double      diagonal = box3_is_empty(s->parts[i].bounds) ? 0 : box3_diagonal(s->parts[i].bounds);
        b->rest = box3_union(b->rest, s->parts[i].bounds);
        b->box = box3_union(b->box, f->p->part_boxes[i]);
        if (skin_of(s, n))
            good = add_skinned(f, b, n, diagonal * diagonal);
        else
            add_rigid(f, b, n, s->parts[i].node, diagonal * diagonal);
    }
    for (size_t i = 0; i < f->body_count; i++)
        for (int t = 0; t < TIMES; t++)
            for (int k = 0; k < 3; k++)
                f->bodies[i].centre[t][k] /= f->bodies[i].weight > 0 ? f->bodies[i].weight : 1;
    return good;
}

/* --- how far bodies reach --------------------------------------------------------------------------------- */

/* Along a direction, or with `from` off a point; with `tips`, which teeth have vertices near their tips. */
typedef struct reach {
    const double    *along, *from;
    double           low, high;
    const part_bend *bend;
    bool            *tips;
} reach;

static void reach_point(reach *r, const double at[3])
{
    double far = r->along ? dot(r->along, at) : 0;
    if (r->from) {
        double off[3] = {at[0] - r->from[0], at[1] - r->from[1], at[2] - r->from[2]};
        far = sqrt(dot(off, off));
    }
    r->low = fmin(r->low, far);
    r->high = fmax(r->high, far);
    int32_t tooth = r->tips ? bend_tooth(r->bend, at) : -1;
    if (tooth >= 0)
        r->tips[tooth] = true;
}

static void reach_box(reach *r, box3 box)
{
    for (int i = 0; i < 8 && !box3_is_empty(box); i++) {
        const double at[3] = {(double)(i & 1 ? box.max.x : box.min.x), (double)(i & 2 ? box.max.y : box.min.y),
                              (double)(i & 4 ? box.max.z : box.min.z)};
        reach_point(r, at);
    }
}

static bool reach_primitive(reach *r, const pose *p, size_t part, const primitive *q)
{
    const part_pose *own = &p->parts[part];
    vec3            *moved = NULL;
    if (pose_deforms(own, q)) {
        moved = mem_alloc((size_t)q->vertex_count * sizeof *moved);
        if (!moved)
            return false;
        pose_vertices(own, q, NULL, NULL, q->vertex_count, moved, NULL);
    }
    size_t draws = node_draw_count(&p->scene->nodes[p->scene->parts[part].node]);
    for (size_t i = 0; i < draws; i++) {
        mat4 world = pose_instance(p, part, i);
        for (uint32_t v = 0; v < q->vertex_count; v++) {
            vec3         at = moved ? moved[v] : q->positions[v];
            const double from[3] = {(double)at.x, (double)at.y, (double)at.z};
            double       to[3];
            transform(&world, from, to);
            reach_point(r, to);
        }
    }
    mem_free(moved);
    return true;
}

/* Of all vertices; where instances make them very many, and of solids, of boxes. */
static bool find_reach(reach *r, const finder *f, size_t number)
{
    enum { POINTS_MOST = 1 << 24 };
    const pose *p = f->p;
    bool        good = true;
    r->low = INFINITY;
    r->high = -INFINITY;
    for (size_t i = 0; i < p->part_count && good; i++) {
        const node *n = &p->scene->nodes[p->scene->parts[i].node];
        if (f->body_of_part[i] != (int32_t)number)
            continue;
        for (size_t k = 0; n->mesh != NONE && k < p->scene->meshes[n->mesh].primitive_count && good; k++) {
            const primitive *q = &p->scene->meshes[n->mesh].primitives[k];
            if (q->vertex_count > POINTS_MOST / node_draw_count(n))
                reach_box(r, p->part_boxes[i]);
            else
                good = reach_primitive(r, p, i, q);
        }
        if (n->mesh == NONE)
            reach_box(r, p->part_boxes[i]);
    }
    return good;
}

/* --- how bodies move -------------------------------------------------------------------------------------- */

/* Per second, from one time to another. */
static void rate(const finder *f, double (*at)[3], int from, int to, double out[3])
{
    double span = f->seconds[to] - f->seconds[from];
    for (int k = 0; k < 3; k++)
        out[k] = span > 0 ? (at[to][k] - at[from][k]) / span : 0;
}

static void find_motion(const finder *f, body *b)
{
    enum { HINGE = 10 }; /* what is so many times slower stays */
    double       came[3], goes[3], own[TIMES][3], origin[3];
    const double SLIGHT = 1e-3;
    b->size = box3_is_empty(b->rest) ? 0 : box3_diagonal(b->rest);
    rate(f, b->centre, BEFORE, AFTER, b->velocity);
    rate(f, b->centre, BEFORE, NOW, came);
    rate(f, b->centre, NOW, AFTER, goes);
    bool both = f->seconds[BEFORE] < f->seconds[NOW] && f->seconds[NOW] < f->seconds[AFTER];
    for (int k = 0; k < 3; k++)
        b->change[k] = both ? goes[k] - came[k] : 0;
    double direction[3] = {b->change[0], b->change[1], b->change[2]};
    to_unit(direction);
    b->before = dot(came, direction);
    b->speed = sqrt(dot(b->velocity, b->velocity));
    b->still = fmax(dot(came, came), dot(goes, goes)) < SLIGHT * SLIGHT * b->size * b->size;
    for (int t = 0; t < TIMES; t++)
        memcpy(own[t], f->worlds[t][b->root].m + 12, sizeof own[t]);
    rate(f, own, BEFORE, AFTER, origin);
    memcpy(b->origin, own[NOW], sizeof b->origin);
    b->hinged = b->speed > 0 && sqrt(dot(origin, origin)) * HINGE < b->speed;
}

/* Teeth stand above each other, of what moves upright beside each other. */
static void find_across(const finder *f, body *b, const double way[3])
{
    double up[3] = {0, 0, 0}, rest = 0;
    for (int round = 0; round < 2 && rest < 0.5; round++) {
        int axis = round ? 0 : f->up;
        for (int k = 0; k < 3; k++)
            up[k] = (k == axis) - way[axis] * way[k];
        rest = to_unit(up);
    }
    memcpy(b->across, up, sizeof b->across);
}

static bool find_reaches(const finder *f, size_t number)
{
    body  *b = &f->bodies[number];
    double against[3] = {b->change[0], b->change[1], b->change[2]},
           way[3] = {b->velocity[0], b->velocity[1], b->velocity[2]};
    bool good = true;
    if (to_unit(against) > 0) {
        reach r = {.along = against};
        good = find_reach(&r, f, number);
        b->stop = r.low;
    }
    b->on_spot = b->still || (b->skinned && !node_moves(f, b->root));
    b->bends = (b->late > 0 || b->dragged) && (to_unit(way) > 0 || b->on_spot);
    memcpy(b->middle, b->hinged && !b->on_spot ? b->origin : b->centre[NOW], sizeof b->middle);
    if (b->bends && good) {
        reach along = {.along = way}, off = {.from = b->middle};
        find_across(f, b, way);
        reach beside = {.along = b->across};
        good = find_reach(&along, f, number) && find_reach(&beside, f, number) && find_reach(&off, f, number);
        b->front = along.high;
        b->rear = along.low;
        b->low = beside.low;
        b->high = beside.high;
        b->farthest = off.high;
    }
    return good;
}

/* --- what becomes of them --------------------------------------------------------------------------------- */

/* Longer by a factor along a direction and thinner across it, so that the volume stays. */
static void stretch_along(double m[9], const double direction[3], double factor)
{
    double thin = 1 / sqrt(factor), out[9];
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += ((r == k) * thin + (factor - thin) * direction[r] * direction[k]) * m[3 * c + k];
            out[3 * c + r] = sum;
        }
    memcpy(m, out, sizeof out);
}

/* By how much the speed along its change grows or, negative, is lost within the response: halfway between before and
 * after, so that what bounces back loses all of it. */
static double gain_of(const body *b, double change)
{
    double gain = fmin(change, 2 * fabs(b->before)) / 2;
    return b->before < 0 ? -gain : gain;
}

/* What keeps its place: a hinge; the ground below what moves along it; the side that is stopped; else the middle. */
static void find_anchor(const finder *f, const body *b, const double way[3], const double change[3], double size,
                        double out[3])
{
    const float *low = &b->box.min.x;
    memcpy(out, b->hinged ? b->origin : b->centre[NOW], 3 * sizeof *out);
    if (b->hinged)
        return;
    double level = b->speed > 0 ? 1 - fabs(way[f->up]) : 0, stopped = b->before < 0 ? fmin(size / -b->before, 1) : 0,
           aside;
    out[f->up] += level * ((double)low[f->up] - out[f->up]);
    aside = stopped * (b->stop - dot(change, out));
    for (int k = 0; k < 3; k++)
        out[k] += aside * change[k];
}

/* Leans forward with the speed, back with the acceleration, about the lowest point. */
static void shear(const finder *f, const body *b, const part_deformation *how, mat4 *m)
{
    double speed[3], gain[3], shift[3], base = b->hinged ? b->origin[f->up] : (double)(&b->box.min.x)[f->up];
    memcpy(speed, b->velocity, sizeof speed);
    for (int k = 0; k < 3; k++)
        gain[k] = b->change[k] / (0.5 * (f->seconds[AFTER] - f->seconds[BEFORE]));
    speed[f->up] = gain[f->up] = 0;
    double fast = to_unit(speed) / b->size / how->full_speed,
           growing = to_unit(gain) / b->size / how->full_acceleration, forward = tan(how->lean * fmin(fast, 1)),
           back = tan(how->inertia * fmin(growing, 1));
    mat4 leaning = mat4_identity();
    for (int k = 0; k < 3; k++) {
        shift[k] = forward * speed[k] - back * gain[k];
        leaning.m[4 * f->up + k] += shift[k];
        leaning.m[12 + k] = -base * shift[k];
    }
    *m = mat4_multiply(&leaning, m);
}

/* --- slit shutters ------------------------------------------------------------------------------------------ */

/* Who goes farthest in its own lengths is what the photographer follows. */
static const double *followed(const finder *f)
{
    static const double none[3] = {0, 0, 0};
    const double       *out = none;
    double              most = 0;
    for (size_t i = 0; i < f->body_count; i++) {
        const body *b = &f->bodies[i];
        if (b->speed * b->size > most) {
            most = b->speed * b->size;
            out = b->velocity;
        }
    }
    return out;
}

/* A slit that goes up over the picture exposes each height a little later than what is below it, and by then things
 * have moved on: they lean forward by their speed past a camera that follows the fastest one, and what is slower than
 * that leans back (Lartigue). Großmann 2011, section 2.1.5; row 77f. */
static void shear_by_slit(const finder *f, const double velocity[3], const part_deformation *how, mat4 *m)
{
    box3          whole = f->whole;
    const double *subject = followed(f);
    double        base = (double)(&whole.min.x)[f->up], height = (double)(&whole.max.x)[f->up] - base;
    mat4          leaning = mat4_identity();
    if (!(height > 0) || how->slit == 0)
        return;
    for (int k = 0; k < 3; k++) {
        double shift = k == f->up ? 0 : (velocity[k] - how->pan * subject[k]) * how->slit / height;
        leaning.m[4 * f->up + k] += shift;
        leaning.m[12 + k] = -base * shift;
    }
    *m = mat4_multiply(&leaning, m);
}

static mat4 change_of(const finder *f, const body *b, const part_deformation *how)
{
    double way[3], change[3], m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, anchor[3];
    mat4   out = mat4_identity();
    if (!(b->size > 0))
        return out;
    if (b->still) {
        shear_by_slit(f, b->velocity, how, &out);
        return out;
    }
    memcpy(way, b->velocity, sizeof way);
    memcpy(change, b->change, sizeof change);
    double speed = to_unit(way), size = to_unit(change), full = how->full_speed * b->size,
           gain = fmin(fmax(gain_of(b, size) / full, -1), 1);
    stretch_along(m, way, 1 + how->stretch * fmin(speed / full, 1));
    stretch_along(m, change, 1 + gain * (gain < 0 ? how->squash : how->stretch));
    find_anchor(f, b, way, change, size, anchor);
    for (int c = 0; c < 3; c++)
        memcpy(out.m + 4 * c, m + 3 * c, 3 * sizeof *m);
    for (int r = 0; r < 3; r++)
        out.m[12 + r] = anchor[r] - m[r] * anchor[0] - m[3 + r] * anchor[1] - m[6 + r] * anchor[2];
    if (how->lean != 0 || how->inertia != 0)
        shear(f, b, how, &out);
    shear_by_slit(f, b->velocity, how, &out);
    return out;
}

static void change_nodes(finder *f)
{
    const lmn_scene *s = f->p->scene;
    const mat4       none = mat4_identity();
    for (size_t i = 0; i < s->node_count; i++) {
        int32_t     number = body_above(f, (int32_t)i);
        const node *n = &s->nodes[i];
        bool        bare = n->mesh == NONE && n->solid == NONE;
        if (bare && (n->camera != NONE || n->light != NONE))
            continue; /* who looks and what shines keep their shape */
        int32_t                 part = f->part_of_node[i];
        const part_deformation *own = part != NONE     ? &f->wanted->parts[settings_of(f, (size_t)part)]
                                      : number != NONE ? &f->bodies[number].how
                                                       : NULL;
        if (!own || part_deformation_is_none(own))
            continue;
        f->out->changes[i] = none;
        if (number != NONE)
            f->out->changes[i] = change_of(f, &f->bodies[number], own);
        else /* what rests, while the camera goes by */
            shear_by_slit(f, (const double[3]){0, 0, 0}, own, &f->out->changes[i]);
        f->out->changed[i] = memcmp(&f->out->changes[i], &none, sizeof none) != 0;
        f->out->count += f->out->changed[i];
    }
}

/* --- what is late ----------------------------------------------------------------------------------------- */

/* How far the rear is pushed that has kept its velocity for `drag` seconds while the rest was accelerated: a·drag²/2
 * against the acceleration, at most half of its length. What turns back within that time is about to have its rear on
 * the other side, and is pushed less. */
static void find_push(const finder *f, const body *b, double drag, bool around, double length, double out[3])
{
    double gain[3], span = 0.5 * (f->seconds[AFTER] - f->seconds[BEFORE]);
    for (int k = 0; k < 3; k++)
        gain[k] = span > 0 ? b->change[k] / span : 0;
    double size = to_unit(gain), far = fmin(0.5 * size * drag * drag, 0.5 * length),
           steady = around || size * drag <= b->speed ? 1 : b->speed / (size * drag);
    for (int k = 0; k < 3; k++)
        out[k] = -far * steady * gain[k];
}

static void bend_part(finder *f, size_t part, const body *b, const mat4 *earlier)
{
    bool                    around = b->hinged || b->on_spot;
    const lmn_scene        *s = f->p->scene;
    const part_deformation *how = &f->wanted->parts[part];
    const node             *n = &s->nodes[s->parts[part].node];
    part_bend              *out = &f->out->bends[part];
    *out = (part_bend){.active = true,
                       .joints = out->joints,
                       .joint_count = out->joint_count,
                       .seconds = b->late,
                       .lag = how->lag,
                       .comb = how->comb,
                       .teeth = how->teeth,
                       .front = b->front,
                       .length = around ? b->farthest : b->front - b->rear,
                       .around = around,
                       .low = b->low,
                       .width = b->high - b->low};
    memcpy(out->way, b->velocity, sizeof out->way);
    to_unit(out->way);
    find_push(f, b, how->drag, around, out->length, out->push);
    memcpy(out->middle, b->middle, sizeof out->middle);
    memcpy(out->across, b->across, sizeof out->across);
    memcpy(out->earlier, earlier, sizeof out->earlier);
    /* Of skins, vertices are in the world, and deformed otherwise with it. */
    out->to_world = f->p->worlds[s->parts[part].node];
    if (skin_of(s, n)) {
        mat4 change = change_of(f, b, &b->how);
        out->to_world = mat4_inverse(&change);
    }
    out->to_mesh = mat4_inverse(&out->to_world);
    f->out->count++;
}

/* Where the joints of a body's skins were at one step. */
static void put_joints(finder *f, size_t number, int step, const mat4 *worlds)
{
    const lmn_scene *s = f->p->scene;
    for (size_t i = 0; i < f->p->part_count; i++) {
        part_bend  *out = &f->out->bends[i];
        const skin *k = skin_of(s, &s->nodes[s->parts[i].node]);
        for (size_t j = 0; f->body_of_part[i] == (int32_t)number && out->joints && k && j < k->joint_count; j++) {
            const mat4 *world = &worlds[k->joints[j]];
            out->joints[(size_t)step * k->joint_count + j] =
                k->inverse_binds ? mat4_multiply(world, &k->inverse_binds[j]) : *world;
        }
    }
}

/* Has what moves vertices for half of its teeth at least? False: out of memory. */
static bool count_tips(finder *f, size_t number, const part_bend *bend)
{
    size_t teeth = (size_t)bend->teeth, count = 0;
    reach  r = {.along = bend->across, .bend = bend, .tips = mem_calloc(teeth, sizeof *r.tips)};
    bool   good = r.tips && find_reach(&r, f, number);
    for (size_t i = 0; good && i < teeth; i++)
        count += r.tips[i];
    f->out->coarse += good && 2 * count < teeth;
    mem_free(r.tips);
    return good;
}

static lmn_status bend_body(finder *f, size_t number, lmn_error *error)
{
    const body      *b = &f->bodies[number];
    mat4             earlier[BEND_STEPS + 1], back = mat4_inverse(&f->p->worlds[b->root]);
    bool             moves = b->skinned || b->dragged;
    const part_bend *combed = NULL;
    earlier[0] = mat4_identity();
    put_joints(f, number, 0, f->p->worlds);
    for (int k = 1; k <= BEND_STEPS; k++) {
        mat4      *worlds = NULL;
        lmn_status status = worlds_at(&worlds, f->p, fmax(f->seconds[NOW] - b->late * k / BEND_STEPS, 0), error);
        if (status != LMN_OK)
            return status;
        put_joints(f, number, k, worlds);
        earlier[k] = memcmp(&worlds[b->root], &f->p->worlds[b->root], sizeof back) != 0
                         ? mat4_multiply(&worlds[b->root], &back)
                         : mat4_identity();
        moves = moves || memcmp(&earlier[k], &earlier[0], sizeof back) != 0;
        mem_free(worlds);
    }
    for (size_t i = 0; i < f->p->part_count && moves; i++) {
        const lmn_scene        *s = f->p->scene;
        const node             *n = &s->nodes[s->parts[i].node];
        const part_deformation *how = &f->wanted->parts[i];
        /* Instances share one shape. */
        if (f->body_of_part[i] != (int32_t)number || n->mesh == NONE || n->instance_count ||
            !part_deformation_bends(how))
            continue;
        bend_part(f, i, b, earlier);
        combed = how->comb > 0 ? &f->out->bends[i] : combed;
    }
    return !combed || count_tips(f, number, combed) ? LMN_OK : error_memory(error);
}

static bool wants_bends(const pose_deformation *d)
{
    for (size_t i = 0; i < d->part_count; i++)
        if (part_deformation_bends(&d->parts[i]))
            return true;
    return false;
}

/* --- the whole -------------------------------------------------------------------------------------------- */

/* Room for the joints of skins that are late, whether they move now or not. */
static bool open_joints(finder *f)
{
    const lmn_scene *s = f->p->scene;
    size_t           count = 0;
    for (int round = 0; round < 2; round++) {
        mat4 *at = f->out->joints = round ? mem_calloc(count + 1, sizeof *at) : NULL;
        if (round && !at)
            return false;
        for (size_t i = 0; i < f->p->part_count; i++) {
            const skin *k = skin_of(s, &s->nodes[s->parts[i].node]);
            if (!k || !part_deformation_bends(&f->wanted->parts[i]))
                continue;
            f->out->bends[i].joints = round ? at : NULL;
            f->out->bends[i].joint_count = k->joint_count;
            at = round ? at + (BEND_STEPS + 1) * k->joint_count : NULL;
            count += (BEND_STEPS + 1) * k->joint_count;
        }
    }
    return true;
}

static lmn_status open_finder(finder *f, lmn_error *error)
{
    const lmn_scene *s = f->p->scene;
    size_t           all = f->p->part_count + f->p->ghost_count;
    f->out->changed = mem_calloc(s->node_count, sizeof *f->out->changed);
    f->out->changes = mem_alloc((s->node_count + 1) * sizeof *f->out->changes);
    f->out->bends = wants_bends(f->wanted) ? mem_calloc(f->p->part_count, sizeof *f->out->bends) : NULL;
    f->body_of_node = mem_alloc((s->node_count + 1) * sizeof *f->body_of_node);
    f->part_of_node = mem_alloc((s->node_count + 1) * sizeof *f->part_of_node);
    f->body_of_part = mem_alloc((all + 1) * sizeof *f->body_of_part);
    bool good = f->out->changed && f->out->changes && f->body_of_node && f->body_of_part && f->part_of_node &&
                (f->out->bends || !wants_bends(f->wanted));
    good = good && (!f->out->bends || open_joints(f));
    return good ? open_times(f, error) : error_memory(error);
}

lmn_status deformed_nodes_find(deformed_nodes *out, const struct pose *p, lmn_error *error)
{
    finder f = {.out = out, .p = p, .wanted = p->when.deformation, .up = p->scene->up == 'z' ? 2 : 1};
    memset(out, 0, sizeof *out);
    f.whole = box3_empty();
    for (size_t i = 0; i < p->part_count; i++)
        f.whole = box3_union(f.whole, p->scene->parts[i].bounds);
    lmn_status status = open_finder(&f, error);
    if (status == LMN_OK && !(find_bodies(&f) && find_middles(&f)))
        status = error_memory(error);
    for (size_t i = 0; i < f.body_count && status == LMN_OK; i++) {
        find_motion(&f, &f.bodies[i]);
        if (!find_reaches(&f, i))
            status = error_memory(error);
    }
    if (status == LMN_OK)
        change_nodes(&f);
    for (size_t i = 0; i < f.body_count && status == LMN_OK; i++)
        if (f.bodies[i].bends)
            status = bend_body(&f, i, error);
    mem_free(f.worlds[BEFORE]);
    mem_free(f.worlds[AFTER]);
    mem_free(f.body_of_node);
    mem_free(f.body_of_part);
    mem_free(f.part_of_node);
    mem_free(f.bodies);
    return status;
}

void deformed_nodes_release(deformed_nodes *d)
{
    mem_free(d->changed);
    mem_free(d->changes);
    mem_free(d->bends);
    mem_free(d->joints);
    memset(d, 0, sizeof *d);
}
