/* Hatching of cut faces as lines: as far as the faces are seen. */
#ifndef LIMNER_STROKE_HATCH_H
#define LIMNER_STROKE_HATCH_H

#include "stroke/stroke.h"

typedef struct hatch_line {
    float    ends[2][2], depths[2]; /* page; eye depth */
    uint32_t part;                  /* id */
    uint32_t area;                  /* 1 + that of `hatch_areas` that has it, too; 0: none has */
} hatch_line;

typedef struct hatch_lines {
    hatch_line *items;
    size_t      count, capacity;
} hatch_lines;

/* A cut face of which all is seen, as what its lines lie in: they are all over it, at multiples of `apart` from one
 * through `origin`, along an angle (radians, from x to y of the page, which grows downwards). */
typedef struct hatch_area {
    uint32_t part; /* id */
    double   apart, angle, origin[2];
    uint32_t first, count; /* loops */
} hatch_area;

typedef struct hatch_areas {
    hatch_area *items;
    uint32_t   *loops;  /* where each begins in `points`; one more at the end. Holes run the other way round */
    float (*points)[2]; /* page */
    size_t count, capacity, loop_count, loop_capacity, point_count, point_capacity;
} hatch_areas;
void hatch_areas_release(hatch_areas *a);

/* Parallel lines on all cut faces of the parts with `parts[index]`, `apart` units apart at an angle (radians), turned
 * and spaced for each part and body as pictures do (light/cut.glsl). Free `items` with mem_free. `areas` (may be NULL)
 * gets the faces of meshes of which no line is hidden anywhere: filled with lines like these, they look the same.
 * Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status hatch_find(hatch_lines *out, hatch_areas *areas, const stroke_view *v, double apart, double angle,
                      const bool *parts, lmn_error *error);

/* By how much lines are turned on planes nearest to being at right angles to an axis (0 … 2), degrees: all planes of
 * one drawing that shows a single one need no turn. */
double hatch_turn(int axis);

/* Holds the lines against rays, as stroke_verify does. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status hatch_verify(stroke_check *out, const hatch_lines *lines, const stroke_view *v, float apart,
                        lmn_error *error);

#endif
