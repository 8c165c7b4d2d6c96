/* Flow lines: behind what moves they run on ahead of it, to where it goes: side by side, or to one point; of what turns
 * along arcs. Großmann 2011, section 2.2.3, after Schüwer 2008; row 77m. */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* They spread over so many times the extent of what moves, and begin so far behind its rear as a fraction of their
 * length. */
#define SPREAD 1.8
#define BEHIND 0.5
/* Lines to one point end before they meet: at these fractions of the way, by chance. */
#define ENDS_FIRST 0.72
#define ENDS_LAST  0.94
/* So far apart lines are looked at, units. */
#define APART 2.0
/* Of what turns they run ahead by so many radians at most, and come no nearer to its centre than this fraction of it.
 */
#define TURN_MOST 2.0
#define NEAREST   0.2
/* The time before, from which it is measured how a way bends: fraction of the exposure; and the least turn that a line
 * of straight length would make, radians. */
#define BEFORE     (1.0 / 16)
#define BEND_LEAST 0.15
/* What is less than this fraction of all that moves has none. */
#define MUCH 0.4
/* Shorter pieces are left out: widths. */
#define SHORTEST 4.0

/* Where a body lies along its way, and how deep. */
static void extent_of(const trace_bodies *t, const trace_body *b, double along[2], double *depth)
{
    double sum = 0;
    along[0] = INFINITY;
    along[1] = -INFINITY;
    for (uint32_t i = b->first; i < b->first + b->count; i++)
        for (int k = 0; k < 3; k++) {
            const double *p = t->now[t->triangles[i][k]];
            double        at, across;
            body_coordinates(b, p, &at, &across);
            along[0] = fmin(along[0], at);
            along[1] = fmax(along[1], at);
            sum += p[2];
        }
    *depth = sum / fmax(3.0 * b->count, 1);
}

/* A line from one position to another in the coordinates of its body: straight, or along an arc. */
typedef struct flow_line {
    const trace_body *body;
    double            along[2], across[2], depth;
} flow_line;

static double radius_of(const trace_body *b)
{
    return 0.5 * (b->across[0] + b->across[1]);
}

/* The position of the page at a fraction of a line. */
static void place(const flow_line *l, double f, double out[2])
{
    const trace_body *b = l->body;
    double            along = l->along[0] + f * (l->along[1] - l->along[0]),
           across = l->across[0] + f * (l->across[1] - l->across[0]), angle = b->zero + b->sense * along;
    bool around = b->motion == MOVES_AROUND;
    out[0] = b->centre[0] + (around ? across * cos(angle) : along * b->way[0] - across * b->way[1]);
    out[1] = b->centre[1] + (around ? across * sin(angle) : along * b->way[1] + across * b->way[0]);
}

static double length_of(const flow_line *l)
{
    double a = l->along[1] - l->along[0];
    a *= l->body->motion == MOVES_AROUND ? 0.5 * (l->across[0] + l->across[1]) : 1;
    return hypot(a, l->across[1] - l->across[0]);
}

/* From end to end, thin at both, where nothing is in front of it. */
static bool put_line(trace_job *j, uint32_t body, uint32_t number, const flow_line *l)
{
    double        length = length_of(l);
    size_t        steps = (size_t)fmin(fmax(ceil(length / APART), 1), 8192), count = 0;
    ribbon_point *points = mem_alloc((steps + 2) * sizeof *points);
    bool          good = points != NULL;
    uint32_t      mesh = trace_mesh_of(&j->bodies, j->bodies.triangles[j->bodies.bodies[body].first][0]);
    for (size_t i = 0; i <= steps + 1 && good; i++) {
        double f = fmin((double)i / (double)steps, 1), end = fmin(1, 4 * fmin(f, 1 - f)), p[3] = {0, 0, l->depth};
        place(l, f, p);
        if (i <= steps && !page_mask_has(&j->mask, p[0], p[1]) && nothing_hides(j->o, j->bodies.meshes[mesh].part, p)) {
            points[count++] = (ribbon_point){(float)p[0],
                                             (float)p[1],
                                             (float)l->depth,
                                             (float)(f * length),
                                             (float)(0.5 * (double)j->o->values->width * (0.15 + 0.85 * end)),
                                             1};
            continue;
        }
        if (count > 1 && (double)(points[count - 1].arc - points[0].arc) >= SHORTEST * (double)j->o->values->width)
            good = put_ribbon(j, STROKE_SPEED, j->bodies.meshes[mesh].part + 1,
                              (uint64_t)body << 32 | TRACE_FLOW | number, points, count);
        count = 0;
    }
    mem_free(points);
    return good;
}

/* From where to where across the motion lines are spread. */
static void spread_of(const trace_body *b, double out[2])
{
    double middle = radius_of(b), wide = SPREAD * (b->across[1] - b->across[0]);
    out[0] = middle - wide / 2;
    out[1] = middle + wide / 2;
    if (b->motion == MOVES_AROUND)
        out[0] = fmax(out[0], NEAREST * b->across[1]);
}

/* Where a position of the page was. */
static bool position_before(const trace_job *j, const mat4 *moved, const double p[3], double out[3])
{
    double world[3];
    page_unproject(&j->o->camera, p, world);
    vec3 then = mat4_transform_point(moved, (vec3){(float)world[0], (float)world[1], (float)world[2]});
    return page_project(&j->o->camera, then, out);
}

/* What goes along a bend turns about a centre on the page: the position that a turn by the angle by which it has turned
 * leaves where it is. `ahead`: how far lines reach. False: its way is straight. */
static bool find_bend(trace_body *turned, const trace_job *j, const trace_body *b, const mat4 *moved, double depth,
                      double ahead)
{
    const double apart = 10, at[3] = {b->centre[0], b->centre[1], depth}, beside[3] = {at[0] + apart, at[1], depth};
    double       was[3], was_beside[3];
    if (!position_before(j, moved, at, was) || !position_before(j, moved, beside, was_beside))
        return false;
    double turn = atan2(was_beside[1] - was[1], was_beside[0] - was[0]), x = was[0] - at[0], y = was[1] - at[1],
           far = turn != 0 ? 0.5 / tan(turn / 2) : 0;
    *turned = *b;
    turned->motion = MOVES_AROUND;
    turned->centre[0] += 0.5 * x - far * y;
    turned->centre[1] += 0.5 * y + far * x;
    turned->sense = turn < 0 ? 1 : -1;
    turned->zero = atan2(at[1] - turned->centre[1], at[0] - turned->centre[0]);
    double radius = hypot(at[0] - turned->centre[0], at[1] - turned->centre[1]);
    turned->across[0] = INFINITY;
    turned->across[1] = 0;
    for (uint32_t i = 3 * b->first; i < 3 * (b->first + b->count); i++) {
        double along, across;
        body_coordinates(turned, j->bodies.now[j->bodies.triangles[i / 3][i % 3]], &along, &across);
        turned->across[0] = fmin(turned->across[0], across);
        turned->across[1] = fmax(turned->across[1], across);
    }
    return turn != 0 && radius > 0 && ahead / radius >= BEND_LEAST && isfinite(radius) &&
           turned->across[0] < turned->across[1];
}

static bool put_body(trace_job *j, uint32_t number, const mat4 *moved, int32_t count)
{
    const trace_body    *b = &j->bodies.bodies[number];
    trace_body           turned;
    const traces_values *v = j->o->values;
    double along[2], depth, spread[2], ahead = (double)v->flow_length * fmax(j->o->camera.width, j->o->camera.height),
                                       middle;
    bool good = true;
    extent_of(&j->bodies, b, along, &depth);
    if (b->motion == MOVES_ALONG && find_bend(&turned, j, b, moved, depth, ahead)) {
        b = &turned;
        extent_of(&j->bodies, b, along, &depth);
    }
    middle = radius_of(b);
    spread_of(b, spread);
    if (b->motion == MOVES_AROUND)
        ahead = fmin(ahead / fmax(middle, 1), TURN_MOST);
    for (int32_t i = 0; i < count && good; i++) {
        double shaken = (double)v->uneven * (trace_random(j->o, number, (uint32_t)i, 41) - 0.5),
               height = spread[0] + (spread[1] - spread[0]) * (i + 0.5 + shaken) / count,
               begin =
                   along[0] - ahead * BEHIND * (1 - (double)v->uneven * trace_random(j->o, number, (uint32_t)i, 42)),
               chance = trace_random(j->o, number, (uint32_t)i, 43), f = ENDS_FIRST + (ENDS_LAST - ENDS_FIRST) * chance;
        flow_line l = {b, {begin, along[1] + ahead * (1 - (double)v->uneven * chance)}, {height, height}, depth};
        if (v->flow_way == TRACES_CONVERGING) {
            l.along[1] = begin + f * (along[1] + ahead - begin);
            l.across[1] = height + f * (middle - height);
        }
        good = put_line(j, number, (uint32_t)i, &l);
    }
    return good;
}

/* What a body covers on the page, about. */
static double size_of(const trace_bodies *t, const trace_body *b)
{
    double along[2], depth;
    extent_of(t, b, along, &depth);
    return (along[1] - along[0]) * (b->across[1] - b->across[0]) * (b->motion == MOVES_AROUND ? radius_of(b) : 1);
}

/* How many lines a body deserves: none unless it goes one way, or turns and is no wheel, and is much of what moves, as
 * a whole figure is and a limb is not. */
static double weight_of(const trace_bodies *t, const trace_body *b, double all)
{
    bool flows = (b->motion == MOVES_ALONG || (b->motion == MOVES_AROUND && !b->round)) && size_of(t, b) >= MUCH * all;
    return flows ? b->speed * (b->across[1] - b->across[0]) : 0;
}

lmn_status flow_lines_put(trace_job *j, lmn_error *error)
{
    double whole = 0, carried = 0, all = 0;
    bool   good = true;
    for (size_t i = 0; i < j->bodies.body_count; i++)
        if (j->bodies.bodies[i].motion != MOVES_TOWARDS)
            all += size_of(&j->bodies, &j->bodies.bodies[i]);
    for (size_t i = 0; i < j->bodies.body_count; i++)
        whole += weight_of(&j->bodies, &j->bodies.bodies[i], all);
    for (size_t i = 0; i < j->bodies.body_count && good && whole > 0; i++) {
        carried += weight_of(&j->bodies, &j->bodies.bodies[i], all) / whole * j->o->values->flow;
        int32_t own = (int32_t)floor(carried + 0.5);
        carried -= own;
        mat4 moved;
        if (own <= 0)
            continue;
        lmn_status status = body_moved_since(&moved, j, &j->bodies.bodies[i], BEFORE, error);
        if (status != LMN_OK)
            return status;
        good = put_body(j, (uint32_t)i, &moved, own);
    }
    return good ? LMN_OK : error_memory(error);
}
