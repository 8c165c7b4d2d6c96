/* Where strokes meet. Ends that lie on other lines are nodes: there lines keep their width, so that round ends close
 * corners without gaps or pinholes. A line that goes behind another one runs on to its axis, so that the pen leaves
 * no slit beside it. What is left are free ends, where lines run out. */
#include <math.h>

#include "base/memory.h"
#include "stroke/ribbon_private.h"

/* Lengths on paper. */
static const float touching = 0.3f;    /* beyond another line's ink, and still on it */
static const float onward_most = 1.9f; /* a line runs on by so much at most beyond the other one's ink: half a mm */
static const float flattest = 0.3f;    /* sine of the angle under which it may do so */
static const float same_cosine = 0.9f; /* lines that go on as each other turn by less */
static const float own_apart = 6;      /* of its own stroke a line meets what is farther along than this */

typedef struct meeting_search {
    const ribbon_job   *job;
    const segment_grid *grid;
    uint32_t            own;
    const stroke_point *end;
    float               half, out[2]; /* of the pen; the direction in which the line ends */
    stroke_meeting      found;
    float               widest; /* half the width of the widest line there */
    bool                same_way;
} meeting_search;

/* The last direction of a stroke, away from it. */
static bool direction_of(const stroke_set *set, const stroke *s, bool at_end, float out[2])
{
    const stroke_point *points = &set->points[s->first], *end = &points[at_end ? s->count - 1 : 0];
    for (uint32_t i = 1; i < s->count; i++) {
        const stroke_point *p = at_end ? end - i : end + i;
        float               x = end->x - p->x, y = end->y - p->y, length = hypotf(x, y);
        if (length > 0 && isfinite(length)) {
            out[0] = x / length;
            out[1] = y / length;
            return true;
        }
    }
    return false;
}

static float distance_to(const stroke_point *p, const stroke_point *a, const stroke_point *b)
{
    float x = b->x - a->x, y = b->y - a->y, square = x * x + y * y;
    float fraction = square > 0 ? ((p->x - a->x) * x + (p->y - a->y) * y) / square : 0;
    fraction = fminf(fmaxf(fraction, 0), 1);
    return hypotf(p->x - a->x - fraction * x, p->y - a->y - fraction * y);
}

/* How far the end is from a segment's axis along its own direction; NaN: not there, or too flat. */
static float onward_to(const meeting_search *m, const stroke_point *a, const stroke_point *b)
{
    float x = b->x - a->x, y = b->y - a->y, length = hypotf(x, y), area = m->out[0] * y - m->out[1] * x;
    float past = touching;
    if (!(length > 0) || !(fabsf(area) > flattest * length))
        return NAN;
    float t = ((a->x - m->end->x) * y - (a->y - m->end->y) * x) / area;
    float u = ((a->x - m->end->x) * m->out[1] - (a->y - m->end->y) * m->out[0]) / area;
    return u * length >= -past && (u - 1) * length <= past ? t : NAN;
}

static void meet(meeting_search *m, ribbon_segment other)
{
    const stroke_set   *set = m->job->strokes;
    const stroke_point *a = &set->points[other.point], *b = a + 1;
    const stroke       *s = &set->strokes[other.stroke];
    float               half = ribbon_width(m->job, s) / 2;
    if (other.stroke == m->own &&
        fminf(fabsf(a->arc - m->end->arc), fabsf(b->arc - m->end->arc)) < own_apart + 2 * m->half)
        return;
    float onward = onward_to(m, a, b);
    if (distance_to(m->end, a, b) <= half + touching) {
        float x = b->x - a->x, y = b->y - a->y;
        bool  along = fabsf(x * m->out[0] + y * m->out[1]) > same_cosine * hypotf(x, y);
        m->same_way = half > m->widest ? along : m->same_way || (half == m->widest && along);
        m->widest = fmaxf(m->widest, half);
        m->found.meets = true;
    } else if (!(onward > 0 && onward <= half + onward_most))
        return;
    if (onward > 0 && onward <= half + onward_most && !(m->found.onward >= onward)) {
        m->found.meets = true;
        m->found.onward = onward;
    }
}

static stroke_meeting search(const ribbon_job *job, const segment_grid *g, uint32_t index, bool at_end)
{
    const stroke       *s = &job->strokes->strokes[index];
    const stroke_point *end = &job->strokes->points[s->first + (at_end ? s->count - 1 : 0)];
    meeting_search      m = {.job = job, .grid = g, .own = index, .end = end, .half = ribbon_width(job, s) / 2};
    int                 cells[4];
    float               reach = onward_most + job->style->width / 2 + m.half;
    if (!direction_of(job->strokes, s, at_end, m.out) || !segment_grid_box(g, end, end, reach, cells))
        return m.found;
    for (int row = cells[1]; row <= cells[3]; row++)
        for (int column = cells[0]; column <= cells[2]; column++) {
            size_t cell = (size_t)row * (size_t)g->columns + (size_t)column;
            for (uint32_t i = g->starts[cell]; i < g->starts[cell + 1]; i++)
                meet(&m, g->items[i]);
        }
    m.found.half = m.same_way && m.widest < 0.95f * m.half ? m.widest : 0;
    /* Lines of form run out beside others; halos shall stay open. */
    if (s->kind >= STROKE_SUGGESTIVE || job->style->halo > 0)
        m.found.onward = 0;
    return m.found;
}

bool ribbon_find_meetings(ribbon_job *job, const segment_grid *grid)
{
    const stroke_set *set = job->strokes;
    job->meetings = mem_calloc(2 * set->stroke_count + 1, sizeof *job->meetings);
    if (!job->meetings)
        return false;
    for (size_t i = 0; i < set->stroke_count && grid->items; i++)
        for (int end = 0; end < 2; end++)
            if (job->drawn[i] && set->strokes[i].hidden_by == 0 && !set->strokes[i].closed)
                job->meetings[2 * i + (size_t)end] = search(job, grid, (uint32_t)i, end);
    return true;
}
