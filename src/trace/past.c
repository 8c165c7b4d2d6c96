/* Contours of the past: at earlier times, what moves is looked at as if it were there alone, and its outlines are drawn
 * behind what is there now, each time fainter by the same factor. */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Outlines are cut in pieces so long, units; which side trails is looked up so far beside them. */
#define APART  2.0
#define BESIDE 1.5
/* Two poses so far apart, fraction of the exposure, say which way it goes. */
#define MOMENT 0.02

/* Fractions of the exposure at which as many equal lengths of the way have passed. */
static lmn_status find_lengths(trace_job *j, double *out, size_t count, lmn_error *error)
{
    const traces_options *o = j->o;
    /* The first vertex of the largest body goes before. */
    const trace_body *b = &j->bodies.bodies[0];
    for (size_t i = 1; i < j->bodies.body_count; i++)
        if (j->bodies.bodies[i].count > b->count)
            b = &j->bodies.bodies[i];
    uint32_t vertex = j->bodies.triangles[b->first][0], mesh = 0;
    while (mesh + 1 < j->bodies.mesh_count && j->bodies.meshes[mesh + 1].first <= vertex)
        mesh++;
    uint32_t     own = vertex - j->bodies.meshes[mesh].first;
    trace_origin origin = {.mesh = mesh, .vertex = {own, own}, .body = (uint32_t)(b - j->bodies.bodies)};
    trace_ways   w;
    lmn_status   status = ways_follow(&w, o, &j->bodies, &origin, 1, error);
    if (status != LMN_OK)
        return status;
    double whole = 0, passed = 0;
    for (uint32_t k = 1; k <= w.steps; k++)
        whole += hypot(w.at[k][0] - w.at[k - 1][0], w.at[k][1] - w.at[k - 1][1]);
    size_t i = 0;
    for (uint32_t k = 1; k <= w.steps && whole > 0; k++) {
        double step = hypot(w.at[k][0] - w.at[k - 1][0], w.at[k][1] - w.at[k - 1][1]);
        for (; i < count && passed + step >= whole * (double)(i + 1) / (double)count * (1 - 1e-12); i++) {
            double wanted = whole * (double)(i + 1) / (double)count - passed;
            out[i] = fmin((k - 1 + (step > 0 ? fmax(wanted, 0) / step : 1)) / w.steps, 1);
        }
        passed += step;
    }
    ways_release(&w);
    return LMN_OK;
}

/* Those that tell most; fewer where figures would cover each other. */
static lmn_status find_telling(trace_job *j, double *out, size_t *count, lmn_error *error)
{
    const traces_options *o = j->o;
    double                exposure = fmin((double)o->values->common.exposure, o->pose->when.seconds);
    const telling_options wanted = {.pose = o->pose,
                                    .parts = o->parts,
                                    .seconds = exposure,
                                    .camera = o->camera,
                                    .count = o->values->moments == TRACES_AUTO ? 0 : (int)*count,
                                    .cover = (double)o->values->cover,
                                    .beside_now = true};
    lmn_status            status = telling_find(&j->facts->telling, &wanted, error);
    *count = j->facts->telling.count < *count ? j->facts->telling.count : *count;
    for (size_t i = 0; i < *count; i++)
        out[i] = j->facts->telling.at[i].ago / exposure;
    return status;
}

/* Fractions of the exposure, newest first. */
static lmn_status find_moments(trace_job *j, double *out, size_t *count, lmn_error *error)
{
    for (size_t i = 0; i < *count; i++)
        out[i] = (double)(i + 1) / (double)*count;
    if (j->o->values->moments == TRACES_AT_LENGTHS && j->bodies.body_count > 0)
        return find_lengths(j, out, *count, error);
    return j->o->values->moments >= TRACES_TELLING ? find_telling(j, out, count, error) : LMN_OK;
}

/* What is drawn of one time. */
typedef struct past_moment {
    stroke_set   set;
    trace_bodies bodies;
    page_mask    mask;
    float        alpha;
} past_moment;

static lmn_status find_outlines(past_moment *m, const trace_job *j, const pose *then, lmn_error *error)
{
    const traces_options *o = j->o;
    const stroke_camera   camera = page_camera_of_the_past(&o->camera);
    stroke_scene          scene = {NULL};
    stroke_view          *view = NULL;
    stroke_options        w = STROKE_OPTIONS_INIT;
    w.creases = o->values->creases;
    w.materials = w.drawn = w.intersections = false;
    w.width = o->values->contour_width;
    lmn_status status = stroke_scene_create(&scene, then, j->moves, o->crease_angle, NULL, NULL, error);
    if (status == LMN_OK)
        status = stroke_view_create(&view, &scene, &camera, NULL, NULL, error);
    if (status == LMN_OK)
        status = stroke_find(&m->set, view, &w, NULL, NULL, NULL, error);
    stroke_view_destroy(&view);
    stroke_scene_release(&scene);
    return status;
}

/* Does this position of an outline trail? Then what moves lies ahead of it and nothing of it behind. */
static bool trails(const past_moment *m, double x, double y)
{
    for (size_t i = 0; i < m->bodies.body_count; i++) {
        double way[2];
        body_way(&m->bodies.bodies[i], x, y, way);
        if (page_mask_has(&m->mask, x + BESIDE * way[0], y + BESIDE * way[1]) &&
            !page_mask_has(&m->mask, x - BESIDE * way[0], y - BESIDE * way[1]))
            return true;
    }
    return false;
}

static bool is_shown(const trace_job *j, const past_moment *m, const double p[3])
{
    if (page_mask_has(&j->mask, p[0], p[1]) || (j->o->values->trailing && !trails(m, p[0], p[1])))
        return false;
    return nothing_hides(j->o, p);
}

/* One outline, in runs of what is shown. */
static bool put_outline(trace_job *j, const past_moment *m, const stroke *s)
{
    const stroke_point *all = m->set.points + s->first;
    ribbon_point       *points = NULL;
    size_t              count = 0, capacity = 0;
    bool                good = true;
    for (uint32_t i = 0; i + 1 < s->count && good; i++) {
        double length = hypot((double)all[i + 1].x - (double)all[i].x, (double)all[i + 1].y - (double)all[i].y),
               pieces = fmin(fmax(ceil(length / APART), 1), 4096);
        bool last = i + 2 == s->count;
        for (double n = 0; n < pieces + last && good; n++) {
            float  f = (float)(n / pieces);
            double p[3] = {(double)(all[i].x + f * (all[i + 1].x - all[i].x)),
                           (double)(all[i].y + f * (all[i + 1].y - all[i].y)),
                           (double)(all[i].depth + f * (all[i + 1].depth - all[i].depth))};
            if (!is_shown(j, m, p)) {
                good = count < 2 || put_ribbon(j, STROKE_PAST, s->part, s->id, points, count);
                count = 0;
                continue;
            }
            good = mem_grow((void **)&points, &capacity, count + 1, sizeof *points);
            if (good)
                points[count++] = (ribbon_point){(float)p[0],
                                                 (float)p[1],
                                                 (float)p[2],
                                                 all[i].arc + f * (all[i + 1].arc - all[i].arc),
                                                 0.5f * j->o->values->contour_width,
                                                 m->alpha};
        }
    }
    good = good && (count < 2 || put_ribbon(j, STROKE_PAST, s->part, s->id, points, count));
    mem_free(points);
    return good;
}

static lmn_status put_moment(trace_job *j, double fraction, float alpha, lmn_error *error)
{
    const traces_options *o = j->o;
    past_moment           m = {.alpha = alpha};
    pose                  then = {.scene = NULL}, before = {.scene = NULL};
    lmn_status            status = pose_ago(&then, o, fraction, error);
    if (status == LMN_OK)
        status = pose_ago(&before, o, fraction + MOMENT, error);
    if (status == LMN_OK)
        status = find_outlines(&m, j, &then, error);
    if (status == LMN_OK)
        status = bodies_find(&m.bodies, &then, &before, MOMENT, j->moves, &o->camera, error);
    if (status == LMN_OK && !page_mask_open(&m.mask, &o->camera))
        status = error_memory(error);
    for (size_t i = 0; i < m.bodies.triangle_count && status == LMN_OK; i++) {
        const uint32_t *t = m.bodies.triangles[i];
        page_mask_add(&m.mask, m.bodies.now[t[0]], m.bodies.now[t[1]], m.bodies.now[t[2]]);
    }
    for (size_t i = 0; i < m.set.stroke_count && status == LMN_OK; i++)
        if (m.set.strokes[i].hidden_by == 0 && !put_outline(j, &m, &m.set.strokes[i]))
            status = error_memory(error);
    j->facts->contours += status == LMN_OK;
    page_mask_close(&m.mask);
    bodies_release(&m.bodies);
    stroke_set_release(&m.set);
    pose_release(&then);
    pose_release(&before);
    return status;
}

lmn_status past_contours_put(trace_job *j, lmn_error *error)
{
    size_t     count = (size_t)j->o->values->contours;
    double    *moments = mem_alloc((count + 1) * sizeof *moments);
    lmn_status status = moments ? find_moments(j, moments, &count, error) : error_memory(error);
    /* The oldest first, so that newer ones lie over it. */
    for (size_t i = count; i-- > 0 && status == LMN_OK;)
        status = put_moment(j, moments[i], powf(j->o->values->fade, (float)(i + 1)), error);
    mem_free(moments);
    return status;
}
