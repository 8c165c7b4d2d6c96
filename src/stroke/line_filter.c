#include "stroke/line_filter.h"

#include <math.h>

/* Differences of coordinates are below 2^25, so that each of a side's four roundings is of less than twice the
 * differences of the segment's ends. */
line_test line_test_of(const window_segment *s, double units)
{
    bool   right = s->a.x < s->b.x, down = s->a.y < s->b.y;
    double x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y;
    return (line_test){(float)s->a.x,
                       (float)s->a.y,
                       (float)x,
                       (float)y,
                       (float)(1.001 * GAP * units * sqrt(x * x + y * y) + 16 * (fabs(x) + fabs(y))),
                       (float)(4 * GAP * units + 16),
                       (float)(right ? s->a.x : s->b.x),
                       (float)(down ? s->a.y : s->b.y),
                       (float)(right ? s->b.x : s->a.x),
                       (float)(down ? s->b.y : s->a.y),
                       nextafterf((float)(s->a.z > s->b.z ? s->a.z : s->b.z), INFINITY),
                       nextafterf((float)(s->a.z < s->b.z ? s->a.z : s->b.z), -INFINITY)};
}

/* Which of the entries of a group have to be compared, 1 or 0 each. Their boxes meet the segment's, they begin in front
 * of its end, not all their corners are clearly to one side of its line, nor both its ends clearly to the outer side of
 * one of their edges; and of inner ones in front of it, none of which its first end is clearly outside. Single
 * precision, with what it may be off by to spare, and without a branch, as which of them do cannot be foretold:
 * compilers make it one for many entries at a time. */
static inline __attribute__((always_inline)) void test_group(const grid_corners *c, size_t corner,
                                                             const line_test *line, int32_t meets[GRID_LANES])
{
    const float *x0 = c->x[0] + corner, *x1 = c->x[1] + corner, *x2 = c->x[2] + corner, *y0 = c->y[0] + corner,
                *y1 = c->y[1] + corner, *y2 = c->y[2] + corner, *z = c->near_z + corner, *turn = c->turn + corner,
                *inner = c->inner_z + corner;
    const line_test t = *line;
    for (int i = 0; i < GRID_LANES; i++) {
        float px0 = x0[i] - t.x, px1 = x1[i] - t.x, px2 = x2[i] - t.x, py0 = y0[i] - t.y, py1 = y1[i] - t.y,
              py2 = y2[i] - t.y;
        float s0 = t.along_x * py0 - t.along_y * px0, s1 = t.along_x * py1 - t.along_y * px1,
              s2 = t.along_x * py2 - t.along_y * px2;
        float ex0 = x1[i] - x0[i], ey0 = y1[i] - y0[i], ex1 = x2[i] - x1[i], ey1 = y2[i] - y1[i], ex2 = x0[i] - x2[i],
              ey2 = y0[i] - y2[i];
        /* How far inside of each edge the segment's first end is, and its last one. */
        float a0 = (ey0 * px0 - ex0 * py0) * turn[i], a1 = (ey1 * px1 - ex1 * py1) * turn[i],
              a2 = (ey2 * px2 - ex2 * py2) * turn[i];
        float b0 = a0 - (s1 - s0) * turn[i], b1 = a1 - (s2 - s1) * turn[i], b2 = a2 - (s0 - s2) * turn[i];
        float m0 = 2 * t.margin + t.apart * (fabsf(ex0) + fabsf(ey0)),
              m1 = 2 * t.margin + t.apart * (fabsf(ex1) + fabsf(ey1)),
              m2 = 2 * t.margin + t.apart * (fabsf(ex2) + fabsf(ey2));
        int32_t counts = inner[i] >= t.front_z; /* wherever it is met, not at the first end alone */
        meets[i] = ((x0[i] <= t.high_x) | (x1[i] <= t.high_x) | (x2[i] <= t.high_x)) &
                   ((x0[i] >= t.low_x) | (x1[i] >= t.low_x) | (x2[i] >= t.low_x)) &
                   ((y0[i] <= t.high_y) | (y1[i] <= t.high_y) | (y2[i] <= t.high_y)) &
                   ((y0[i] >= t.low_y) | (y1[i] >= t.low_y) | (y2[i] >= t.low_y)) & (z[i] <= t.far_z) &
                   ((s0 <= t.margin) | (s1 <= t.margin) | (s2 <= t.margin)) &
                   ((s0 >= -t.margin) | (s1 >= -t.margin) | (s2 >= -t.margin)) &
                   ((a0 >= -m0) | (counts & (b0 >= -m0))) & ((a1 >= -m1) | (counts & (b1 >= -m1))) &
                   ((a2 >= -m2) | (counts & (b2 >= -m2)));
    }
}

static inline __attribute__((always_inline)) size_t find_with(const grid_corners *c, const line_test *line,
                                                              size_t corner, size_t count, uint16_t *out)
{
    size_t found = 0;
    for (size_t begin = 0; begin < count; begin += GRID_LANES) {
        int32_t meets[GRID_LANES];
        size_t  lanes = count - begin < GRID_LANES ? count - begin : GRID_LANES;
        test_group(c, corner + begin, line, meets);
        for (size_t i = 0; i < lanes; i++) {
            out[found] = (uint16_t)(begin + i);
            found += (size_t)meets[i];
        }
    }
    return found;
}

#ifdef __x86_64__
/* Where the processor takes twice as many numbers at a time. */
static __attribute__((target("avx2"))) size_t find_wide(const grid_corners *c, const line_test *line, size_t corner,
                                                        size_t count, uint16_t *out)
{
    return find_with(c, line, corner, count, out);
}

bool line_filter_is_wide(void)
{
    return __builtin_cpu_supports("avx2");
}
#else
static size_t find_wide(const grid_corners *c, const line_test *line, size_t corner, size_t count, uint16_t *out)
{
    return find_with(c, line, corner, count, out);
}

bool line_filter_is_wide(void)
{
    return false;
}
#endif

size_t line_filter(const grid_corners *c, const line_test *line, bool wide, size_t corner, size_t count, uint16_t *out)
{
    return wide ? find_wide(c, line, corner, count, out) : find_with(c, line, corner, count, out);
}
