/* Which triangles of a cell a line may meet: a first look at many of them at a time, in single precision. */
#ifndef LIMNER_STROKE_LINE_FILTER_H
#define LIMNER_STROKE_LINE_FILTER_H

#include "stroke/stroke_private.h"

/* Gaps between bodies are no wider than twice this where it is roundings that make them, pixels. */
#define GAP 0.01

/* What triangles are held against: window coordinates, which single precision has exactly; only what is worked out with
 * them is rounded. */
typedef struct line_test {
    float x, y, along_x, along_y;
    float margin; /* who is farther than that to one side of the line is to that side: not along it, nor by rounding */
    float apart;  /* the same of the line of an edge, times its length */
    float low_x, low_y, high_x, high_y;
    float far_z;   /* of the segment, or a little more: what begins behind is no cover */
    float front_z; /* … or a little less: what ends before is in front of all of it; −INFINITY: nobody asks */
} line_test;

line_test line_test_of(const window_segment *s, double units);

/* The entries of a run that have to be compared with the segment, by their places in it; no more than `count` numbers,
 * which 16 bits hold. `wide`: the processor has the registers that line_filter_is_wide asks for; what is found is the
 * same without them. */
size_t line_filter(const grid_corners *c, const line_test *line, bool wide, size_t corner, size_t count, uint16_t *out);
bool   line_filter_is_wide(void);

#endif
