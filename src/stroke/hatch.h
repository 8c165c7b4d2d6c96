/* Hatching of cut faces as lines: as far as the faces are seen. */
#ifndef LIMNER_STROKE_HATCH_H
#define LIMNER_STROKE_HATCH_H

#include "stroke/stroke.h"

typedef struct hatch_line {
    float    ends[2][2], depths[2]; /* page; eye depth */
    uint32_t part;                  /* id */
} hatch_line;

typedef struct hatch_lines {
    hatch_line *items;
    size_t      count, capacity;
} hatch_lines;

/* Parallel lines on all cut faces of the parts with `parts[index]`, `apart` units apart at an angle (radians), turned
 * and spaced for each part and body as pictures do (light/cut.glsl). Free `items` with mem_free. Errors: LMN_MEMORY,
 * LMN_CANCELLED. */
lmn_status hatch_find(hatch_lines *out, const stroke_view *v, double apart, double angle, const bool *parts,
                      lmn_error *error);

/* By how much lines are turned on planes nearest to being at right angles to an axis (0 … 2), degrees: all planes of
 * one drawing that shows a single one need no turn. */
double hatch_turn(int axis);

/* Holds the lines against rays, as stroke_verify does. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status hatch_verify(stroke_check *out, const hatch_lines *lines, const stroke_view *v, float apart,
                        lmn_error *error);

#endif
