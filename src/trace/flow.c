/* Flow lines: behind what moves they run on ahead of it, to where it goes: side by side, or to one point. Großmann
 * 2011, section 2.2.3, after Schüwer 2008; row 77m. */
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

/* From end to end, thin at both, where nothing is in front of it. */
static bool put_line(trace_job *j, uint32_t body, uint32_t number, const double from[2], const double to[2],
                     double depth)
{
    double        length = hypot(to[0] - from[0], to[1] - from[1]);
    size_t        steps = (size_t)fmin(fmax(ceil(length / APART), 1), 8192), count = 0;
    ribbon_point *points = mem_alloc((steps + 2) * sizeof *points);
    bool          good = points != NULL;
    uint32_t      mesh = trace_mesh_of(&j->bodies, j->bodies.triangles[j->bodies.bodies[body].first][0]);
    for (size_t i = 0; i <= steps + 1 && good; i++) {
        double f = fmin((double)i / (double)steps, 1), end = fmin(1, 4 * fmin(f, 1 - f));
        double p[3] = {from[0] + f * (to[0] - from[0]), from[1] + f * (to[1] - from[1]), depth};
        if (i <= steps && !page_mask_has(&j->mask, p[0], p[1]) && nothing_hides(j->o, j->bodies.meshes[mesh].part, p)) {
            points[count++] = (ribbon_point){(float)p[0],
                                             (float)p[1],
                                             (float)depth,
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

/* A position of the page at coordinates of a body that moves along. */
static void place(const trace_body *b, double along, double across, double out[2])
{
    out[0] = b->centre[0] + along * b->way[0] - across * b->way[1];
    out[1] = b->centre[1] + along * b->way[1] + across * b->way[0];
}

static bool put_body(trace_job *j, uint32_t number, int32_t count)
{
    const trace_body    *b = &j->bodies.bodies[number];
    const traces_values *v = j->o->values;
    double along[2], depth, ahead = (double)v->flow_length * fmax(j->o->camera.width, j->o->camera.height),
                            middle = 0.5 * (b->across[0] + b->across[1]), wide = SPREAD * (b->across[1] - b->across[0]);
    bool good = true;
    extent_of(&j->bodies, b, along, &depth);
    for (int32_t i = 0; i < count && good; i++) {
        double shaken = (double)v->uneven * (trace_random(j->o, number, (uint32_t)i, 41) - 0.5),
               height = middle + wide * ((i + 0.5 + shaken) / count - 0.5),
               begin =
                   along[0] - ahead * BEHIND * (1 - (double)v->uneven * trace_random(j->o, number, (uint32_t)i, 42)),
               chance = trace_random(j->o, number, (uint32_t)i, 43), from[2], to[2];
        place(b, begin, height, from);
        if (v->flow_way == TRACES_CONVERGING) {
            double point[2], f = ENDS_FIRST + (ENDS_LAST - ENDS_FIRST) * chance;
            place(b, along[1] + ahead, middle, point);
            for (int k = 0; k < 2; k++)
                to[k] = from[k] + f * (point[k] - from[k]);
        } else
            place(b, along[1] + ahead * (1 - (double)v->uneven * chance), height, to);
        good = put_line(j, number, (uint32_t)i, from, to, depth);
    }
    return good;
}

/* What a body covers on the page, about. */
static double size_of(const trace_bodies *t, const trace_body *b)
{
    double along[2], depth;
    extent_of(t, b, along, &depth);
    return (along[1] - along[0]) * (b->across[1] - b->across[0]);
}

/* How many lines a body deserves: none unless it goes one way and is much of what moves, as a whole figure is and a
 * limb is not. */
static double weight_of(const trace_bodies *t, const trace_body *b, double all)
{
    bool flows = b->motion == MOVES_ALONG && size_of(t, b) >= MUCH * all;
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
        good = own <= 0 || put_body(j, (uint32_t)i, own);
    }
    return good ? LMN_OK : error_memory(error);
}
