/* Figures of the past that are no outlines: bones as lines, joints as marks (Marey's partial chronophotographs), and
 * solids in place of limbs (Duchamp). Großmann 2011, sections 2.1.4, 2.1.5 and 2.3; rows 77d, 77h. */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Marks have this radius, widths of contours. */
#define MARK 1.6
enum { ROUND = 24 };
static const double pi = 3.14159265358979323846;

typedef struct figure_writer {
    stroke_set      *out;
    const trace_job *job;
    size_t           stroke_capacity, point_capacity;
} figure_writer;

static bool put_line(figure_writer *w, const double (*points)[3], size_t count, uint32_t part)
{
    stroke_set *s = w->out;
    if (!mem_grow((void **)&s->strokes, &w->stroke_capacity, s->stroke_count + 1, sizeof *s->strokes) ||
        !mem_grow((void **)&s->points, &w->point_capacity, s->point_count + count, sizeof *s->points))
        return false;
    s->strokes[s->stroke_count] = (stroke){.kind = STROKE_PAST,
                                           .part = part + 1,
                                           .chain = (uint32_t)s->stroke_count,
                                           .id = s->stroke_count,
                                           .first = (uint32_t)s->point_count,
                                           .count = (uint32_t)count};
    double arc = 0;
    for (size_t i = 0; i < count; i++) {
        arc += i ? hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]) : 0;
        s->points[s->point_count++] =
            (stroke_point){(float)points[i][0], (float)points[i][1], (float)points[i][2], (float)arc, 1};
    }
    s->stroke_count++;
    return true;
}

static bool put_circle(figure_writer *w, const double at[3], double radius, uint32_t part)
{
    double points[ROUND + 1][3];
    for (int i = 0; i <= ROUND; i++) {
        double angle = 2 * pi * (i % ROUND) / ROUND;
        memcpy(points[i], (double[]){at[0] + radius * cos(angle), at[1] + radius * sin(angle), at[2]}, sizeof *points);
    }
    return put_line(w, (const double(*)[3])points, ROUND + 1, part);
}

/* The outline of two discs and what lies between them: half of each, or all of the larger one where it holds the other.
 */
static bool put_tapered(figure_writer *w, const double at[2][3], const double radius[2], uint32_t part)
{
    double x = at[1][0] - at[0][0], y = at[1][1] - at[0][1], apart = hypot(x, y), points[2 * ROUND + 3][3];
    int    count = 0, large = radius[1] > radius[0];
    if (apart <= fabs(radius[0] - radius[1]))
        return put_circle(w, at[large], radius[large], part);
    /* Tangents touch both where their normals are at this angle to the axis. */
    double axis = atan2(y, x), open = acos((radius[0] - radius[1]) / apart);
    for (int end = 0; end < 2; end++) {
        double from = end ? -open : open, to = end ? open : 2 * pi - open;
        for (int i = 0; i <= ROUND; i++) {
            double angle = axis + from + (to - from) * i / ROUND;
            memcpy(points[count++],
                   (double[]){at[end][0] + radius[end] * cos(angle), at[end][1] + radius[end] * sin(angle), at[end][2]},
                   sizeof *points);
        }
    }
    memcpy(points[count++], points[0], sizeof *points);
    return put_line(w, (const double(*)[3])points, (size_t)count, part);
}

/* Units of the page that a length has at a depth. */
static double on_page(const stroke_camera *c, double length, double depth)
{
    return 0.5 * c->height * c->projection.m[5] * length / (c->orthographic ? 1 : depth);
}

static bool put_bone(figure_writer *w, const trace_bone *b, const pose *then)
{
    const traces_options *o = w->job->o;
    double                at[2][3], radius[2], mark = MARK * (double)o->values->contour_width;
    const vec3            ends[2] = {b->from, b->to};
    for (int k = 0; k < 2; k++) {
        if (!page_project(&o->camera, mat4_transform_point(&then->worlds[b->node], ends[k]), at[k]))
            return true;
        radius[k] = on_page(&o->camera, b->radius[k], at[k][2]);
    }
    if (o->values->figures == TRACES_SOLIDS)
        return put_tapered(w, (const double(*)[3])at, radius, b->part);
    bool good = put_circle(w, at[0], mark, b->part) && put_circle(w, at[1], mark, b->part);
    return good && (o->values->figures == TRACES_POINTS || put_line(w, (const double(*)[3])at, 2, b->part));
}

lmn_status figures_find(stroke_set *out, const trace_job *j, const pose *then, lmn_error *error)
{
    figure_writer w = {.out = out, .job = j};
    bool          good = true;
    for (size_t i = 0; i < j->bones.count && good; i++)
        good = put_bone(&w, &j->bones.items[i], then);
    return good ? LMN_OK : error_memory(error);
}
