/* Strokes held against rays: positions of strokes are looked at along straight lines from the eye through the
 * triangles as they stand in the world, by other arithmetic than that which found them (no window, no grid, no
 * whole numbers). */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/solid.h"

/* A position counts as right when one within half a pixel is as it should be. Outlines are the rim of what they belong
 * to; and between parts that run in each other there may be no more to be seen through than a hundredth of a pixel.
 * Distances at which is looked, pixels. */
static const double near_by[] = {0, 0.25, 0.5, 0.1, 0.03, 0.008};
enum { DIRECTIONS = 8, RINGS = sizeof near_by / sizeof *near_by, STACK = 128, TICK = 4096 };

typedef struct ray {
    double3 from, along; /* `along` is a unit vector */
    double  until;       /* distance of the position that is looked at */
    double  near;        /* surfaces that pass it at less than this are as good as at the position: half a pixel */
} ray;

/* Surfaces in front: those that are so beyond doubt, and all. */
typedef struct ray_count {
    uint32_t sure, all;
} ray_count;

/* Where a ray meets a face of a solid. */
typedef struct solid_ray {
    uint32_t  item;
    bool      nearer;
    solid_hit hit;
} solid_ray;

typedef struct verifier {
    const stroke_view *v;
    hierarchy          tree;
    box3              *boxes; /* per face of all items */
    double3 (*corners)[3];
    uint8_t     *unseen; /* per face: as view_unseen says of its piece */
    solid_ray   *hits;   /* of solids, along the ray at hand */
    size_t       hit_count, hit_capacity;
    solid_hit   *sorted;
    size_t       sorted_capacity;
    solid_state *states; /* per item that is a solid */
    bool         failed;
    mat4         to_world;                /* from eye space */
    double       half_width, half_height; /* of the page in eye space: at depth 1 in perspective */
} verifier;

/* --- preparation ---------------------------------------------------------------------------------------- */

static void load_item(verifier *w, size_t index, const uint8_t *unseen)
{
    const stroke_view *v = w->v;
    const stroke_item *item = &v->scene->items[index];
    const edge_mesh   *m = &v->scene->meshes[item->mesh];
    for (uint32_t f = 0; f < m->face_count; f++) {
        uint32_t face = v->items[index].first_face + f;
        box3     box = box3_empty();
        for (int k = 0; k < 3; k++) {
            double3 p = item_position(item, m->positions[m->faces[f][k]]);
            w->corners[face][k] = p;
            box = box3_with_point(box, (vec3){nextafterf((float)p.x, -INFINITY), nextafterf((float)p.y, -INFINITY),
                                              nextafterf((float)p.z, -INFINITY)});
            box = box3_with_point(box, (vec3){nextafterf((float)p.x, INFINITY), nextafterf((float)p.y, INFINITY),
                                              nextafterf((float)p.z, INFINITY)});
        }
        w->boxes[face] = box;
        w->unseen[face] = unseen[m->pieces[f]];
    }
}

/* The view matrix turns and moves: its inverse is its transpose. */
static mat4 inverse_view(const mat4 *view)
{
    const double *m = view->m;
    mat4          out = mat4_identity();
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            out.m[4 * c + r] = m[4 * r + c];
        out.m[12 + r] = -(m[4 * r] * m[12] + m[4 * r + 1] * m[13] + m[4 * r + 2] * m[14]);
    }
    return out;
}

static void release(verifier *w)
{
    hierarchy_release(&w->tree);
    mem_free(w->boxes);
    mem_free(w->corners);
    mem_free(w->unseen);
    mem_free(w->hits);
    mem_free(w->sorted);
    for (size_t i = 0; i < w->v->scene->item_count && w->states; i++)
        solid_state_release(&w->states[i]);
    mem_free(w->states);
}

static lmn_status open_states(verifier *w, lmn_error *error)
{
    const stroke_scene *s = w->v->scene;
    bool                good = true;
    if (!w->v->solids)
        return LMN_OK;
    w->states = mem_calloc(s->item_count + 1, sizeof *w->states);
    for (size_t i = 0; i < s->item_count && w->states && good; i++) {
        const edge_mesh *m = &s->meshes[s->items[i].mesh];
        good = !m->solid || solid_state_open(&w->states[i], &m->solid->program);
    }
    return w->states && good ? LMN_OK : error_memory(error);
}

static lmn_status prepare(verifier *w, lmn_error *error)
{
    const stroke_view *v = w->v;
    w->boxes = mem_alloc(((size_t)v->face_count + 1) * sizeof *w->boxes);
    w->corners = mem_alloc(((size_t)v->face_count + 1) * sizeof *w->corners);
    w->unseen = mem_alloc((size_t)v->face_count + 1);
    lmn_status status = w->boxes && w->corners && w->unseen ? open_states(w, error) : error_memory(error);
    for (size_t i = 0; i < v->scene->item_count && status == LMN_OK; i++) {
        uint8_t *unseen = view_unseen(v, i);
        if (unseen)
            load_item(w, i, unseen);
        else
            status = error_memory(error);
        mem_free(unseen);
    }
    if (status == LMN_OK)
        status = hierarchy_build(&w->tree, w->boxes, (hierarchy_kin){{NULL}}, v->face_count, error);
    w->to_world = inverse_view(&v->camera.view);
    w->half_width = 1 / v->camera.projection.m[0];
    w->half_height = 1 / v->camera.projection.m[5];
    return status;
}

/* --- rays ----------------------------------------------------------------------------------------------- */

static double3 position_of(const verifier *w, double x, double y, double z)
{
    const double *m = w->to_world.m;
    return (double3){m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
                     m[2] * x + m[6] * y + m[10] * z + m[14]};
}

/* The line from the eye (parallel: from far before it) to the position at a depth behind a position of the page. */
static ray ray_to(const verifier *w, double x, double y, double depth)
{
    const stroke_camera *c = &w->v->camera;
    double               right =
        (2 * x / c->width - 1 + (c->orthographic ? -c->projection.m[12] : c->projection.m[8])) * w->half_width;
    double up =
        (1 - 2 * y / c->height + (c->orthographic ? -c->projection.m[13] : c->projection.m[9])) * w->half_height;
    double3 to, from;
    if (c->orthographic) {
        to = position_of(w, right, up, -depth);
        from = position_of(w, right, up, -depth + 4 * w->v->scene->extent);
    } else {
        to = position_of(w, right * depth, up * depth, -depth);
        from = position_of(w, right * c->near, up * c->near, -c->near);
    }
    double3 along = double3_minus(to, from);
    double  length = sqrt(double3_dot(along, along)), fraction = length > 0 ? 1 / length : 0;
    double  pixel = 2 * w->half_height / c->height * (c->orthographic ? 1 : depth);
    return (ray){from, {along.x * fraction, along.y * fraction, along.z * fraction}, length, 0.5 * pixel};
}

static bool passes(const box3 *b, const ray *r)
{
    const double low[3] = {b->min.x, b->min.y, b->min.z}, high[3] = {b->max.x, b->max.y, b->max.z};
    const double from[3] = {r->from.x, r->from.y, r->from.z}, along[3] = {r->along.x, r->along.y, r->along.z};
    double       enter = 0, leave = r->until;
    for (int k = 0; k < 3; k++) {
        if (along[k] == 0) {
            if (from[k] < low[k] || from[k] > high[k])
                return false;
            continue;
        }
        double a = (low[k] - from[k]) / along[k], b2 = (high[k] - from[k]) / along[k];
        enter = fmax(enter, fmin(a, b2));
        leave = fmin(leave, fmax(a, b2));
    }
    return enter <= leave;
}

static void put_hit(verifier *w, uint32_t item, uint32_t face, double at, bool nearer, bool sure)
{
    const edge_solid *s = w->v->scene->meshes[w->v->scene->items[item].mesh].solid;
    uint32_t          own = face - w->v->items[item].first_face;
    if (!mem_grow((void **)&w->hits, &w->hit_capacity, w->hit_count + 1, sizeof *w->hits)) {
        w->failed = true;
        return;
    }
    w->hits[w->hit_count++] = (solid_ray){item, nearer, {at, s->operands[own], s->planes[own], sure}};
}

/* Möller and Trumbore's test. Counts the face when it lies in front of the ray's end. */
static void count_face(verifier *w, uint32_t face, const ray *r, ray_count *out)
{
    const double3 *p = w->corners[face];
    double3        a = double3_minus(p[1], p[0]), b = double3_minus(p[2], p[0]), h = double3_cross(r->along, b),
            normal = double3_cross(a, b);
    double det = double3_dot(a, h);
    if (det == 0 || w->unseen[face] == (det > 0 ? 2 : 1))
        return;
    double3 s = double3_minus(r->from, p[0]), q = double3_cross(s, a);
    double  u = double3_dot(s, h) / det, v = double3_dot(r->along, q) / det, t = double3_dot(b, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t < 0)
        return;
    uint32_t solid = view_solid(w->v, face);
    bool     sure = (r->until - t) * fabs(double3_dot(r->along, normal)) > r->near * sqrt(double3_dot(normal, normal));
    if (solid) {
        put_hit(w, solid - 1, face, t, t < r->until, sure);
    } else if (t < r->until) {
        out->all++;
        out->sure += sure;
    }
}

static int compare_hits(const void *a, const void *b)
{
    const solid_ray *p = a, *q = b;
    return (p->item > q->item) - (p->item < q->item);
}

/* What is met an odd number of times, in front of the position or behind it, holds where the ray begins. */
static void count_solids(verifier *w, ray_count *out)
{
    if (!w->hit_count || !mem_grow((void **)&w->sorted, &w->sorted_capacity, w->hit_count, sizeof *w->sorted))
        return;
    qsort(w->hits, w->hit_count, sizeof *w->hits, compare_hits);
    for (size_t i = 0, end; i < w->hit_count; i = end) {
        solid_state *s = &w->states[w->hits[i].item];
        size_t       count = 0;
        for (end = i; end < w->hit_count && w->hits[end].item == w->hits[i].item; end++) {
            solid_state_pass(s, w->hits[end].hit.operand);
            if (w->hits[end].nearer)
                w->sorted[count++] = w->hits[end].hit;
        }
        solid_entries entries = solid_count_entries(s, w->sorted, count);
        for (size_t k = i; k < end; k++)
            solid_state_pass(s, w->hits[k].hit.operand);
        out->all += entries.all;
        out->sure += entries.sure;
    }
}

static ray_count count_in_front(verifier *w, const ray *r)
{
    uint32_t  stack[STACK], depth = 0;
    ray_count count = {0, 0};
    ray       whole = *r;
    if (w->v->solids) /* what lies behind says whether the eye is inside */
        whole.until = INFINITY;
    w->hit_count = 0;
    if (w->tree.node_count)
        stack[depth++] = 0;
    while (depth > 0) {
        const hierarchy_node *n = &w->tree.nodes[stack[--depth]];
        if (!passes(&n->box, &whole))
            continue;
        for (uint32_t i = 0; i < n->count; i++)
            count_face(w, w->tree.members[n->first + i], r, &count);
        if (n->count == 0 && depth + 2 <= STACK) {
            stack[depth++] = n->first;
            stack[depth++] = n->first + 1;
        }
    }
    count_solids(w, &count);
    return count;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

static void check_position(verifier *w, const stroke *s, double x, double y, double depth, stroke_check *out)
{
    bool right = false, counted = false;
    for (int ring = 0; ring < RINGS && !counted; ring++)
        for (int k = 0; k < (ring ? DIRECTIONS : 1) && !counted; k++) {
            double turn = 2 * 3.14159265358979323846 * k / DIRECTIONS;
            ray    r = ray_to(w, x + near_by[ring] * cos(turn), y + near_by[ring] * sin(turn), depth);
            r.near += (double)s->lift;
            ray_count count = count_in_front(w, &r);
            right = right || (s->hidden_by ? count.all > 0 : count.sure == 0);
            counted = count.sure <= s->hidden_by && s->hidden_by <= count.all;
        }
    out->samples++;
    out->wrong += !right;
    out->miscounted += !counted;
}

/* Depth runs evenly along the page in parallel projection, its inverse in perspective. */
static double depth_between(const stroke_view *v, const stroke_point *p, const stroke_point *q, double fraction)
{
    if (v->camera.orthographic)
        return p->depth + fraction * (q->depth - p->depth);
    return 1 / (1 / p->depth + fraction * (1 / q->depth - 1 / p->depth));
}

static void check_stroke(verifier *w, const stroke_set *set, const stroke *s, double apart, stroke_check *out)
{
    double next = apart / 2; /* along the stroke */
    double done = 0;
    for (uint32_t i = 0; i + 1 < s->count; i++) {
        const stroke_point *p = &set->points[s->first + i], *q = p + 1;
        double              length = hypot((double)q->x - p->x, (double)q->y - p->y);
        for (; next < done + length; next += apart) {
            double fraction = (next - done) / length;
            /* Curves that stand for lines are held against the mesh where these are: the mesh has no other there. */
            double home[2][2] = {{p->x - p->aside[0], p->y - p->aside[1]}, {q->x - q->aside[0], q->y - q->aside[1]}};
            check_position(w, s, home[0][0] + fraction * (home[1][0] - home[0][0]),
                           home[0][1] + fraction * (home[1][1] - home[0][1]), depth_between(w->v, p, q, fraction), out);
        }
        done += length;
    }
}

lmn_status stroke_verify(stroke_check *out, const stroke_set *set, const stroke_view *v, float apart,
                         lmn_progress_fn progress, void *user, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    verifier   w = {.v = v};
    lmn_status status = prepare(&w, error);
    uint64_t   told = 0;
    for (size_t i = 0; i < set->stroke_count && status == LMN_OK; i++) {
        if (!set->strokes[i].smooth) /* rays know nothing of what is meant by the mesh */
            check_stroke(&w, set, &set->strokes[i], apart > 0 ? apart : 1, out);
        if (w.failed)
            status = error_memory(error);
        if (progress && out->samples >= told + TICK) {
            told = out->samples;
            if (!progress((double)i / (double)set->stroke_count, "verifying", user))
                status = error_set(error, LMN_CANCELLED, "cancelled while strokes were verified");
        }
    }
    release(&w);
    return status;
}
