#include "plan/fit.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Points are measured by the block, so that a compiler can take several at once. */
enum { BLOCK = 256, LANES = 8 };
/* More vertices, instances counted, are measured by the boxes of their meshes: that takes longer than it is worth. */
static const double VERTICES_MOST = 8e6;

typedef struct lanes {
    float most[LANES];
} lanes;

/* A measurement under way, in single precision around the middle. */
typedef struct measuring {
    const fit_view        *view;
    lanes                  sides[2][2][FIT_STEPS + 1]; /* axis, plus or minus, step */
    float                  x[2][BLOCK], z[BLOCK];
    size_t                 count;
    struct touched_ground *ground; /* NULL: what touches it does not count */
} measuring;

/* The ground below what touches it or nearly so, which is dark up to some way around. */
typedef struct touched_ground {
    const fit_ground *ground;
    measuring         points; /* down on the ground */
} touched_ground;

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void widen(lanes *l, const float *x, const float *z, float sign, float slope)
{
    for (size_t i = 0; i < BLOCK; i += LANES)
        for (size_t k = 0; k < LANES; k++) {
            float reach = sign * x[i + k] - slope * z[i + k];
            l->most[k] = reach > l->most[k] ? reach : l->most[k];
        }
}

/* A block that is not full repeats its first point. */
static void measure_block(measuring *m)
{
    if (m->count == 0)
        return;
    for (size_t i = m->count; i < BLOCK; i++) {
        m->x[0][i] = m->x[0][0];
        m->x[1][i] = m->x[1][0];
        m->z[i] = m->z[0];
    }
    for (int axis = 0; axis < 2; axis++) {
        int steps = m->view->slope[axis] > 0 ? FIT_STEPS : 0;
        for (int s = 0; s <= steps; s++) {
            float slope = (float)(m->view->slope[axis] * s / FIT_STEPS);
            widen(&m->sides[axis][0][s], m->x[axis], m->z, 1, slope);
            widen(&m->sides[axis][1][s], m->x[axis], m->z, -1, slope);
        }
    }
    m->count = 0;
}

/* The axes of the view, seen from what a matrix takes to the world. */
typedef struct local_view {
    float axes[3][4]; /* right, up, forward: point · axis + the last */
} local_view;

static local_view localise(const fit_view *view, const mat4 *world)
{
    const double *axes[3] = {view->right, view->up, view->forward};
    local_view    out;
    for (int a = 0; a < 3; a++) {
        for (int k = 0; k < 3; k++)
            out.axes[a][k] = (float)dot3(axes[a], world->m + 4 * k);
        const double origin[3] = {world->m[12] - view->middle[0], world->m[13] - view->middle[1],
                                  world->m[14] - view->middle[2]};
        out.axes[a][3] = (float)dot3(axes[a], origin);
    }
    return out;
}

static float along(const float axis[4], vec3 p)
{
    return axis[0] * p.x + axis[1] * p.y + axis[2] * p.z + axis[3];
}

static void measure_points(measuring *m, const local_view *l, const vec3 *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        m->x[0][m->count] = along(l->axes[0], points[i]);
        m->x[1][m->count] = along(l->axes[1], points[i]);
        m->z[m->count++] = along(l->axes[2], points[i]);
        if (m->count == BLOCK)
            measure_block(m);
    }
}

static void measure_touching(touched_ground *t, const mat4 *world, const vec3 *points, size_t count)
{
    measuring       *m = &t->points;
    const int        up = t->ground->up;
    const local_view l = localise(m->view, world);
    const double    *axes[3] = {m->view->right, m->view->up, m->view->forward};
    const float      upright[4] = {(float)world->m[up], (float)world->m[4 + up], (float)world->m[8 + up],
                                   (float)(world->m[12 + up] - t->ground->level)};
    for (size_t i = 0; i < count; i++) {
        float height = along(upright, points[i]);
        if (!((double)height < t->ground->spread))
            continue;
        m->x[0][m->count] = along(l.axes[0], points[i]) - height * (float)axes[0][up];
        m->x[1][m->count] = along(l.axes[1], points[i]) - height * (float)axes[1][up];
        m->z[m->count++] = along(l.axes[2], points[i]) - height * (float)axes[2][up];
        if (m->count == BLOCK)
            measure_block(m);
    }
}

/* Points that a matrix takes to the world, and their shadows. */
static void measure_placed(measuring *m, const mat4 *world, const vec3 *points, size_t count)
{
    local_view l = localise(m->view, world);
    measure_points(m, &l, points, count);
    if (m->ground)
        measure_touching(m->ground, world, points, count);
    if (m->view->shadow) {
        mat4 on_ground = mat4_multiply(m->view->shadow, world);
        l = localise(m->view, &on_ground);
        measure_points(m, &l, points, count);
    }
}

static void measure_box(measuring *m, const mat4 *world, box3 box)
{
    vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] =
            (vec3){i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z};
    if (!box3_is_empty(box))
        measure_placed(m, world, corners, 8);
}

static box3 box_of(const vec3 *points, size_t count)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < count; i++)
        box = box3_with_point(box, points[i]);
    return box;
}

/* Where vertices are that nobody has posed yet, as at rest, where boxes are known without; the caller frees them. NULL
 * when memory is gone. */
static vec3 *pose_points(const primitive *p, const part_pose *own)
{
    vec3 *out = mem_alloc((size_t)p->vertex_count * sizeof *out);
    if (out)
        pose_vertices(own, p, NULL, NULL, p->vertex_count, out, NULL);
    return out;
}

/* False when memory is gone: the part's box serves. */
static bool measure_primitive(measuring *m, const fit_body *body, size_t part, const primitive *p)
{
    const pose           *pose = body->pose;
    const node           *n = &pose->scene->nodes[pose->scene->parts[part].node];
    const part_pose      *own = &pose->parts[part];
    bool                  deforms = pose_deforms(own, p);
    const posed_vertices *posed = deforms ? pose_vertices_of(own, p) : NULL;
    vec3                 *made = deforms && !posed ? pose_points(p, own) : NULL;
    if (deforms && !posed && !made)
        return false;
    const vec3 *points = posed ? posed->positions : made ? made : p->positions;
    size_t      instances = node_draw_count(n);
    bool        whole = (double)p->vertex_count * (double)instances <= VERTICES_MOST;
    box3        box = whole ? box3_empty() : box_of(points, p->vertex_count);
    for (size_t i = 0; i < instances; i++) {
        mat4 world = pose_instance(pose, part, i);
        if (whole)
            measure_placed(m, &world, points, p->vertex_count);
        else
            measure_box(m, &world, box);
    }
    mem_free(made);
    return true;
}

static bool measure_mesh(measuring *m, const fit_body *body, size_t part)
{
    const lmn_scene *scene = body->pose->scene;
    const node      *n = &scene->nodes[scene->parts[part].node];
    if (part >= body->pose->part_count || n->mesh == NONE || body->pose->fit_boxes != body->pose->part_boxes)
        return false;
    bool        good = true;
    const mesh *mesh = &scene->meshes[n->mesh];
    for (size_t i = 0; i < mesh->primitive_count; i++)
        good = measure_primitive(m, body, part, &mesh->primitives[i]) && good;
    return good;
}

static void begin(measuring *m, const fit_view *view)
{
    m->view = view;
    m->count = 0;
    m->ground = NULL;
    lanes *all = &m->sides[0][0][0];
    for (size_t i = 0; i < sizeof m->sides / sizeof *all; i++)
        for (int k = 0; k < LANES; k++)
            all[i].most[k] = -INFINITY;
}

static double most_of(const lanes *l)
{
    float most = l->most[0];
    for (int k = 1; k < LANES; k++)
        most = fmaxf(most, l->most[k]);
    return (double)most;
}

/* Widens a reach to discs on the ground around the points there. */
static void reach_around(fit_reach *out, const touched_ground *t, int axis, int step)
{
    const fit_view *v = t->points.view;
    const int       from = v->slope[axis] > 0 ? step : 0, level[2] = {0, 3 - t->ground->up};
    const double   *across = axis ? v->up : v->right, slope = v->slope[axis] * step / FIT_STEPS;
    double          wide[2] = {0, 0};
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 2; k++) {
            double part = (side ? -1 : 1) * across[level[k]] - slope * v->forward[level[k]];
            wide[side] += part * part;
        }
    out->plus[step] =
        fmax(out->plus[step], most_of(&t->points.sides[axis][0][from]) + t->ground->spread * sqrt(wide[0]));
    out->minus[step] =
        fmax(out->minus[step], most_of(&t->points.sides[axis][1][from]) + t->ground->spread * sqrt(wide[1]));
}

void fit_measure(fit_reach out[2], const fit_body *body, const fit_view *view)
{
    measuring      m;
    touched_ground touched = {.ground = &body->ground};
    const mat4     identity = mat4_identity();
    begin(&m, view);
    if (body->ground.there && body->ground.spread > 0 && -view->forward[body->ground.up] > GROUND_EDGE_ON) {
        begin(&touched.points, view);
        m.ground = &touched;
    }
    for (size_t i = 0; i < body->part_count && body->fitted; i++) {
        const bool ghost = body->pose->scene->parts[i].ghost;
        const box3 whole = ghost ? body->ghost_boxes[i] : body->pose->fit_boxes[i],
                   box = ghost ? whole : scene_fitted_box(body->pose->scene, i, whole);
        if (!body->fitted[i] || box3_is_empty(box))
            continue;
        if (ghost || memcmp(&box, &whole, sizeof box) != 0 || !measure_mesh(&m, body, i))
            measure_box(&m, &identity, box);
    }
    measure_block(&m);
    if (m.ground)
        measure_block(&touched.points);
    for (int axis = 0; axis < 2; axis++)
        for (int s = 0; s <= FIT_STEPS; s++) {
            int from = view->slope[axis] > 0 ? s : 0;
            out[axis].plus[s] = most_of(&m.sides[axis][0][from]);
            out[axis].minus[s] = most_of(&m.sides[axis][1][from]);
            if (m.ground)
                reach_around(&out[axis], &touched, axis, s);
        }
}

/* The most of functions that are linear in the slope is convex: between steps a straight line lies above it. */
static double between_steps(const double steps[FIT_STEPS + 1], double slope, double most)
{
    double at = most > 0 ? fmin(fmax(slope / most, 0), 1) * FIT_STEPS : 0;
    int    s = (int)at < FIT_STEPS ? (int)at : FIT_STEPS - 1;
    return steps[s] + (steps[s + 1] - steps[s]) * (at - s);
}

double fit_plus(const fit_reach *r, double slope, double most)
{
    return between_steps(r->plus, slope, most);
}

double fit_minus(const fit_reach *r, double slope, double most)
{
    return between_steps(r->minus, slope, most);
}
