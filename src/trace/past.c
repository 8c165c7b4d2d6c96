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
/* From one dash to the next, dashes. */
#define GAP_AFTER 1.5

/* Fractions of the exposure at which as many equal lengths of the way have passed. */
static lmn_status find_lengths(trace_job *j, double *out, size_t count, lmn_error *error)
{
    const traces_options *o = j->o;
    /* The first vertex of the largest body goes before. */
    const trace_body *b = &j->bodies.bodies[0];
    for (size_t i = 1; i < j->bodies.body_count; i++)
        if (j->bodies.bodies[i].count > b->count)
            b = &j->bodies.bodies[i];
    uint32_t     vertex = j->bodies.triangles[b->first][0], mesh = trace_mesh_of(&j->bodies, vertex);
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
    stroke_topologies     own = {NULL};
    w.creases = o->values->creases;
    w.materials = w.drawn = w.intersections = false;
    w.width = o->values->contour_width;
    lmn_status status = stroke_scene_create_keeping(&scene, then, j->moves, o->crease_angle, 0, &own,
                                                    o->section.cut ? &o->section : NULL, error);
    if (status == LMN_OK)
        status = stroke_scene_calm(&scene, error);
    if (status == LMN_OK)
        status = stroke_view_create(&view, &scene, &camera, NULL, NULL, error);
    if (status == LMN_OK)
        status = stroke_find(&m->set, view, &w, NULL, NULL, NULL, error);
    stroke_view_destroy(&view);
    stroke_scene_release(&scene);
    stroke_topologies_release(&own);
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

static bool is_shown(const trace_job *j, const past_moment *m, uint32_t part, const double p[3])
{
    if (j->o->values->in_front)
        return !is_cut_away(j->o, part, p);
    if (page_mask_has(&j->mask, p[0], p[1]) || (j->o->values->trailing && !trails(m, p[0], p[1])))
        return false;
    return nothing_hides(j->o, part, p);
}

/* A line of the past while it is put down, in runs of what is shown. */
typedef struct past_run {
    trace_job         *job;
    const past_moment *moment;
    uint32_t           part;
    uint64_t           id;
    ribbon_point      *points;
    size_t             count, capacity;
} past_run;

static bool end_run(past_run *r)
{
    bool good = r->count < 2 || put_ribbon(r->job, STROKE_PAST, r->part, r->id, r->points, r->count);
    r->count = 0;
    return good;
}

/* What leaves the page has no outline along its border. */
static bool is_at_border(const stroke_camera *c, const double p[3])
{
    const double near = 4;
    return p[0] < near || p[1] < near || p[0] > c->width - near || p[1] > c->height - near;
}

static bool put_position(past_run *r, const double p[3], double arc)
{
    double dash = (double)r->job->o->values->contour_dash;
    bool   swept = r->job->o->values->figures == TRACES_SWEPT;
    if (swept && is_at_border(&r->job->o->camera, p))
        return end_run(r);
    bool gap = dash > 0 && fmod(arc, GAP_AFTER * dash) > dash;
    if (gap || !is_shown(r->job, r->moment, r->part - 1, p))
        return end_run(r);
    if (!mem_grow((void **)&r->points, &r->capacity, r->count + 1, sizeof *r->points))
        return false;
    r->points[r->count++] = (ribbon_point){
        (float)p[0], (float)p[1], (float)p[2], (float)arc, 0.5f * r->job->o->values->contour_width, r->moment->alpha};
    return true;
}

static bool put_past_line(past_run *r, const double (*all)[3], size_t count)
{
    double arc = 0, dash = (double)r->job->o->values->contour_dash, apart = dash > 0 ? fmin(APART, dash / 8) : APART;
    bool   good = true;
    r->count = 0;
    for (size_t i = 0; i + 1 < count && good; i++) {
        double length = hypot(all[i + 1][0] - all[i][0], all[i + 1][1] - all[i][1]),
               pieces = fmin(fmax(ceil(length / apart), 1), 4096);
        bool last = i + 2 == count;
        for (double n = 0; n < pieces + last && good; n++) {
            double f = n / pieces, p[3];
            for (int k = 0; k < 3; k++)
                p[k] = all[i][k] + f * (all[i + 1][k] - all[i][k]);
            good = put_position(r, p, arc + f * length);
        }
        arc += length;
    }
    return good && end_run(r);
}

static bool put_outline(past_run *r, const stroke_set *set, const stroke *s)
{
    double(*points)[3] = mem_alloc((s->count + 1) * sizeof *points);
    for (uint32_t i = 0; points && i < s->count; i++) {
        const stroke_point *p = &set->points[s->first + i];
        memcpy(points[i], (double[]){(double)p->x, (double)p->y, (double)p->depth}, sizeof *points);
    }
    r->part = s->part;
    r->id = s->id;
    bool good = points && put_past_line(r, (const double(*)[3])points, s->count);
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
        status = o->values->figures == TRACES_OUTLINES ? find_outlines(&m, j, &then, error)
                                                       : figures_find(&m.set, j, &then, error);
    if (status == LMN_OK)
        status = bodies_find(&m.bodies, &then, &before, MOMENT,
                             &(bodies_wanted){j->moves, NULL, &o->camera, o->section}, error);
    if (status == LMN_OK && !page_mask_open(&m.mask, &o->camera))
        status = error_memory(error);
    for (size_t i = 0; i < m.bodies.triangle_count && status == LMN_OK; i++) {
        const uint32_t *t = m.bodies.triangles[i];
        page_mask_add(&m.mask, m.bodies.now[t[0]], m.bodies.now[t[1]], m.bodies.now[t[2]]);
    }
    past_run run = {.job = j, .moment = &m};
    for (size_t i = 0; i < m.set.stroke_count && status == LMN_OK; i++)
        if (m.set.strokes[i].hidden_by == 0 && !put_outline(&run, &m.set, &m.set.strokes[i]))
            status = error_memory(error);
    mem_free(run.points);
    j->facts->contours += status == LMN_OK;
    page_mask_close(&m.mask);
    bodies_release(&m.bodies);
    stroke_set_release(&m.set);
    pose_release(&then);
    pose_release(&before);
    return status;
}

static bool put_swept_line(void *user, const double (*points)[3], size_t count)
{
    past_run *run = user;
    run->id++;
    return put_past_line(run, points, count);
}

static lmn_status put_swept(trace_job *j, lmn_error *error)
{
    const past_moment all = {.alpha = 1};
    past_run          run = {.job = j, .moment = &all, .part = j->bodies.meshes[0].part + 1};
    lmn_status        status = swept_put(j, put_swept_line, &run, error);
    mem_free(run.points);
    j->facts->contours += status == LMN_OK;
    return status;
}

lmn_status past_contours_put(trace_job *j, lmn_error *error)
{
    if (j->o->values->figures == TRACES_SWEPT)
        return put_swept(j, error);
    size_t     count = (size_t)j->o->values->contours;
    double    *moments = mem_alloc((count + 1) * sizeof *moments);
    lmn_status status = LMN_OK;
    if (j->o->values->figures != TRACES_OUTLINES)
        status = bones_find(&j->bones, j->o->pose, j->moves, j->o->values->bones.text, error);
    j->facts->bones_missing = j->o->values->figures != TRACES_OUTLINES && j->bones.count == 0;
    if (status == LMN_OK)
        status = moments ? find_moments(j, moments, &count, error) : error_memory(error);
    /* The oldest first, so that newer ones lie over it. */
    for (size_t i = count; i-- > 0 && status == LMN_OK;)
        status = put_moment(j, moments[i], powf(j->o->values->fade, (float)(i + 1)), error);
    mem_free(moments);
    return status;
}
