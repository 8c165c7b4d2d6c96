/* Vibration lines: what swings to and fro has small arcs beside both of its sides, as comics draw what shakes. Großmann
 * 2011, section 2.2.3. */
#include "trace/trace_private.h"

#include <math.h>

#include "base/memory.h"

/* Pieces of arcs, units. */
#define APART 2.0
/* A change of direction counts where it goes back by this fraction of the whole swing; what swings less far, units,
 * rests; half of an arc, and how much shorter the next one is. */
#define BACK    0.25
#define LEAST   1.0
#define HALF    (35 * 3.14159265358979323846 / 180)
#define SHORTER 0.15
/* What swings less than this fraction of the farthest has no arcs. */
#define SWINGS 0.5
/* How often what swings turns round within the exposure at least; or once, where it is back as near as BACK. */
enum { TURNS = 2 };

/* What shakes: how it lies on the page, measured from its middle along and across its swing. */
typedef struct shake {
    double   axis[2], middle[2], half[2], depth;
    uint32_t part;
} shake;

/* The direction in which positions differ most: of the covariance, the eigenvector of the larger eigenvalue. */
static void find_axis(const double (*at)[3], uint32_t count, double out[2])
{
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (uint32_t k = 0; k < count; k++) {
        x += at[k][0] / count;
        y += at[k][1] / count;
    }
    for (uint32_t k = 0; k < count; k++) {
        xx += (at[k][0] - x) * (at[k][0] - x);
        xy += (at[k][0] - x) * (at[k][1] - y);
        yy += (at[k][1] - y) * (at[k][1] - y);
    }
    double angle = 0.5 * atan2(2 * xy, xx - yy);
    out[0] = cos(angle);
    out[1] = sin(angle);
}

/* Does a way swing along an axis: to and fro, or once there and back? */
static bool swings(const double (*at)[3], uint32_t count, const double axis[2])
{
    double low = INFINITY, high = -INFINITY, farthest = 0;
    int    turns = 0, sense = 0;
    for (uint32_t k = 0; k < count; k++) {
        double s = at[k][0] * axis[0] + at[k][1] * axis[1];
        low = fmin(low, s);
        high = fmax(high, s);
    }
    for (uint32_t k = 0; k < count && high - low >= LEAST; k++) {
        double s = at[k][0] * axis[0] + at[k][1] * axis[1], back = BACK * (high - low);
        if (k == 0 || (sense && sense * (s - farthest) > 0))
            farthest = s;
        if (!sense && fabs(s - farthest) > back) {
            sense = s > farthest ? 1 : -1;
            farthest = s;
        } else if (sense && sense * (farthest - s) > back) {
            sense = -sense;
            farthest = s;
            turns++;
        }
    }
    double net = (at[count - 1][0] - at[0][0]) * axis[0] + (at[count - 1][1] - at[0][1]) * axis[1];
    return turns >= TURNS || (turns == 1 && fabs(net) <= BACK * (high - low));
}

/* How far a position of the page swings. */
static double swing_of(const trace_job *j, const mat4 *moved, const double p[3])
{
    double world[3], then[3];
    page_unproject(&j->o->camera, p, world);
    vec3 at = mat4_transform_point(moved, (vec3){(float)world[0], (float)world[1], (float)world[2]});
    return page_project(&j->o->camera, at, then) ? hypot(then[0] - p[0], then[1] - p[1]) : 0;
}

/* The extents of a body on the page, of what swings more than half as far as the farthest: `moved` says how. */
static void measure(const trace_job *j, const trace_body *b, const mat4 *moved, shake *s)
{
    const trace_bodies *t = &j->bodies;
    double              low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, farthest = 0;
    for (uint32_t i = 3 * b->first; i < 3 * (b->first + b->count); i++)
        farthest = fmax(farthest, swing_of(j, moved, t->now[t->triangles[i / 3][i % 3]]));
    for (uint32_t i = 3 * b->first; i < 3 * (b->first + b->count); i++) {
        const double *p = t->now[t->triangles[i / 3][i % 3]];
        if (swing_of(j, moved, p) < SWINGS * farthest)
            continue;
        double at[2] = {p[0] * s->axis[0] + p[1] * s->axis[1], p[1] * s->axis[0] - p[0] * s->axis[1]};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    double along = (low[0] + high[0]) / 2, across = (low[1] + high[1]) / 2;
    s->middle[0] = along * s->axis[0] - across * s->axis[1];
    s->middle[1] = along * s->axis[1] + across * s->axis[0];
    for (int k = 0; k < 2; k++)
        s->half[k] = (high[k] - low[k]) / 2;
}

lmn_status body_moved_since(mat4 *out, const trace_job *j, const trace_body *b, double fraction, lmn_error *error)
{
    pose earlier = {.scene = NULL};
    *out = mat4_identity();
    if (b->node == NONE)
        return LMN_OK;
    lmn_status status = pose_ago(&earlier, j->o, fraction, error);
    if (status == LMN_OK) {
        mat4 back = mat4_inverse(&pose_rigid_worlds(j->o->pose)[b->node]);
        *out = mat4_multiply(&pose_rigid_worlds(&earlier)[b->node], &back);
    }
    pose_release(&earlier);
    return status;
}

/* An arc beside one side: concentric with a body as wide as it is long, else round a circle that touches its side. */
typedef struct shake_arc {
    const shake *s;
    int          side; /* 1, −1 */
    double       radius, half, back;
} shake_arc;

static shake_arc arc_of(const trace_job *j, const shake *s, int32_t number, int side, double off)
{
    const traces_values *v = j->o->values;
    return (shake_arc){s, side, s->half[1] + (double)v->begin + number * (double)v->vibration_apart,
                       HALF * fmax(1 - SHORTER * number, 0.3), s->half[0] - s->half[1] + off};
}

static void arc_point(const shake_arc *a, double angle, double out[3])
{
    double along = a->side * (a->back + a->radius * cos(angle)), across = a->radius * sin(angle);
    out[0] = a->s->middle[0] + along * a->s->axis[0] - across * a->s->axis[1];
    out[1] = a->s->middle[1] + along * a->s->axis[1] + across * a->s->axis[0];
    out[2] = a->s->depth;
}

/* How far arcs are moved off flat sides, which they would run into. */
static double off_side(const trace_job *j, const shake *s, int side)
{
    enum { LOOKS = 16 };
    double off = 0;
    for (bool covered = true; covered && off < s->half[1] / 2; off += covered) {
        shake_arc a = arc_of(j, s, 0, side, off);
        covered = false;
        for (int n = 0; n <= LOOKS && !covered; n++) {
            double p[3];
            arc_point(&a, (2.0 * n / LOOKS - 1) * a.half, p);
            covered = page_mask_has(&j->mask, p[0], p[1]);
        }
    }
    return off;
}

static bool put_arc(trace_job *j, const shake_arc *a, uint64_t id)
{
    double        pieces = fmin(fmax(ceil(2 * a->half * a->radius / APART), 4), 4096), begin = 0, p[3];
    ribbon_point *points = mem_alloc(((size_t)pieces + 1) * sizeof *points);
    size_t        count = 0;
    bool          good = points != NULL;
    for (double n = 0; n <= pieces + 1 && good; n++) {
        double at = n / pieces, angle = (2 * at - 1) * a->half;
        arc_point(a, angle, p);
        if (n > pieces || page_mask_has(&j->mask, p[0], p[1]) || !nothing_hides(j->o, a->s->part - 1, p)) {
            good = count < 3 || put_ribbon(j, STROKE_SPEED, a->s->part, id, points, count);
            count = 0;
            begin = at;
            continue;
        }
        double wide = 0.35 + 0.65 * cos(1.5 * angle / a->half);
        points[count++] = (ribbon_point){.x = (float)p[0],
                                         .y = (float)p[1],
                                         .depth = (float)p[2],
                                         .arc = (float)((at - begin) * 2 * a->half * a->radius),
                                         .half = (float)(0.5 * (double)j->o->values->width * wide),
                                         .alpha = 1};
    }
    mem_free(points);
    return good;
}

static bool put_arcs(trace_job *j, const shake *s, size_t body)
{
    bool good = true;
    for (int side = -1; side <= 1 && good; side += 2) {
        double off = off_side(j, s, side);
        for (int32_t i = 0; i < j->o->values->vibration && good; i++) {
            shake_arc a = arc_of(j, s, i, side, off);
            good = put_arc(j, &a, (uint64_t)body << 32 | 1u << 31 | (uint64_t)(2 * i + (side > 0)));
        }
    }
    return good;
}

/* The fraction of the exposure at which a way was farthest off along an axis. */
static double farthest_ago(const trace_ways *w, const double axis[2])
{
    double   most = -1;
    uint32_t at = 0;
    for (uint32_t k = 0; k <= w->steps; k++) {
        double off = fabs((w->at[k][0] - w->at[0][0]) * axis[0] + (w->at[k][1] - w->at[0][1]) * axis[1]);
        if (off > most) {
            most = off;
            at = k;
        }
    }
    return (double)at / w->steps;
}

static lmn_status shake_body(trace_job *j, size_t number, lmn_error *error)
{
    const trace_body *b = &j->bodies.bodies[number];
    uint32_t          vertex = j->bodies.triangles[b->first][0], mesh = trace_mesh_of(&j->bodies, vertex);
    uint32_t          own = vertex - j->bodies.meshes[mesh].first;
    trace_origin      origin = {.mesh = mesh, .vertex = {own, own}, .body = (uint32_t)number};
    trace_ways        w;
    shake             s = {.part = j->bodies.meshes[mesh].part + 1};
    lmn_status        status = ways_follow(&w, j->o, &j->bodies, &origin, 1, error);
    if (status != LMN_OK)
        return status;
    find_axis((const double(*)[3])w.at, w.steps + 1, s.axis);
    s.depth = w.at[0][2];
    bool   shakes = swings((const double(*)[3])w.at, w.steps + 1, s.axis);
    double ago = farthest_ago(&w, s.axis);
    mat4   moved;
    ways_release(&w);
    if (!shakes)
        return LMN_OK;
    status = body_moved_since(&moved, j, b, ago, error);
    if (status != LMN_OK)
        return status;
    measure(j, b, &moved, &s);
    if (!isfinite(s.middle[0]) || !isfinite(s.half[0]) || !isfinite(s.half[1]))
        return LMN_OK;
    j->facts->shaking++;
    return put_arcs(j, &s, number) ? LMN_OK : error_memory(error);
}

static uint32_t part_of(const trace_bodies *t, const trace_body *b)
{
    return t->meshes[trace_mesh_of(t, t->triangles[b->first][0])].part;
}

/* The shaking ones of what moves since a fraction of the exposure ago, of parts that are not `done`. */
static lmn_status shake_bodies(trace_job *j, double fraction, bool *done, lmn_error *error)
{
    pose         before = {.scene = NULL};
    trace_bodies known = j->bodies;
    lmn_status   status = pose_ago(&before, j->o, fraction, error);
    if (status == LMN_OK)
        status = bodies_find(&j->bodies, j->o->pose, &before, fraction,
                             &(bodies_wanted){j->o->parts, NULL, &j->o->camera, j->o->section}, error);
    pose_release(&before);
    if (status == LMN_OK) {
        const trace_bodies *t = &j->bodies;
        for (size_t i = 0; status == LMN_OK && i < t->body_count; i++)
            if (t->bodies[i].count && !done[part_of(t, &t->bodies[i])])
                status = shake_body(j, i, error);
        for (size_t i = 0; i < t->body_count; i++)
            if (t->bodies[i].count)
                done[part_of(t, &t->bodies[i])] = true;
        bodies_release(&j->bodies);
    }
    j->bodies = known;
    return status;
}

/* What turns round just now hardly moves: bodies are looked for over several times, and each part is taken once. */
lmn_status shakes_put(trace_job *j, lmn_error *error)
{
    static const double fractions[] = {1.0 / 16, 3.0 / 16, 5.0 / 16};
    bool               *done = mem_calloc(j->o->pose->part_count + 1, sizeof *done);
    lmn_status          status = done ? LMN_OK : error_memory(error);
    j->facts->shakes_wanted = true;
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions && status == LMN_OK; i++)
        status = shake_bodies(j, fractions[i], done, error);
    mem_free(done);
    return status;
}
