/* Stroke textures: strokes in the unit square, which repeats, each with two priorities and a layer. Freudenberg
 * 2003, section 5.2; rows EX-17 to EX-24. */
#ifndef LIMNER_STROKE_TEXTURE_STROKES_H
#define LIMNER_STROKE_TEXTURE_STROKES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/text.h"

/* A straight stroke. The start lies in [0, 1)²; the end may lie outside: the stroke goes on at the opposite side
 * (EX-18). v grows upwards. A dot has both ends at one position. */
typedef struct texture_stroke {
    float u0, v0, u1, v1;
    float light; /* priority: drawn where light < priority; 1 stays longest, above 1 (legal, by indication) even in full
                    light, below 0 never */
    float   perspective; /* the same for distance: drawn at mip level k when at least 1 − 2^−k */
    int32_t layer;       /* 0 is the most important one */
} texture_stroke;

typedef struct strokes {
    texture_stroke *items;
    size_t          count, capacity;
    float           width; /* of a stroke, fraction of its usual width; dots: of their diameter. 1 */
} strokes;

bool strokes_add(strokes *s, texture_stroke item); /* false: memory is gone */
void strokes_release(strokes *s);
/* Moves starts into the unit square, ends with them. Files may have any finite numbers. */
void strokes_wrap(strokes *s);
/* Length in the square. */
double  stroke_length(const texture_stroke *s);
int32_t strokes_layer_count(const strokes *s); /* the largest layer + 1 */

/* --- files --- */

/* Freudenberg's text format: seven numbers a line, blanks between: u0 v0 u1 v1 light perspective layer. Empty lines
 * and what follows '#' are ignored. `name` is for messages, which have file and line. Errors: LMN_FORMAT (wrong
 * count, not a number, not finite, a layer outside of 0 … 65535, coordinates beyond ±16), LMN_LIMIT (a million
 * strokes), LMN_MEMORY. No strokes at all is allowed. */
lmn_status strokes_read(strokes *out, const char *name, const char *bytes, size_t size, lmn_error *error);
/* Exactly what strokes_read takes; numbers are as short as they can be and read back as they were. */
void strokes_write(text *out, const strokes *s);

/* The lines of an SVG drawing: line, polyline, polygon, rect, circle, ellipse and path elements with their
 * transforms, curves as chords. The view box (or width and height, or the bounds of everything) becomes the unit
 * square, its longer side 1. Each group (g) at the first level of nesting that has several is a layer, in drawing
 * order; without groups everything is layer 0. What stands between groups belongs to the layer before. Priorities
 * are set in drawing order, first = 1, perspective the same, unless every element states both in data-light and
 * data-perspective. Elements with display none are left out, so are definitions and a rectangle that covers all.
 * Circles of a radius below 2 % of the square are dots, as are lines without length. Strokes are wrapped. Errors:
 * LMN_FORMAT with file and line (also: more than 16 times the size away, nested deeper than 200), LMN_LIMIT,
 * LMN_MEMORY. */
lmn_status strokes_read_svg(strokes *out, const char *name, const char *bytes, size_t size, lmn_error *error);
/* An SVG with a group per layer, which strokes_read_svg reads back: strokes sorted by layer, with their priorities. */
void strokes_write_svg(text *out, const strokes *s);

/* A file by its ending, .stx or .svg; strokes are wrapped. Errors as above and as file_load; LMN_UNSUPPORTED for
 * another ending. */
lmn_status strokes_load(strokes *out, const char *path, lmn_error *error);

/* --- generators --- */

typedef enum stroke_pattern {
    PATTERN_PARALLEL, /* hatching along u, slightly irregular */
    PATTERN_CROSS,    /* series of hatching, each a layer: 0°, 90°, 45°, 135° */
    PATTERN_CONTOUR,  /* bent strokes like those that follow a form: each of several chords */
    PATTERN_BRICK,    /* joints of a running bond in layer 0, scratches on bricks in layers 1 and 2 */
    PATTERN_STIPPLE,  /* dots, every prefix evenly spread */
    PATTERN_SCRIBBLE, /* loops that wander */
    PATTERN_RANDOM,   /* strokes of any direction */
    PATTERN_COUNT
} stroke_pattern;
extern const char *const stroke_pattern_names[PATTERN_COUNT + 1]; /* NULL-terminated */

typedef struct pattern_options {
    stroke_pattern pattern;
    size_t         count;  /* of strokes, about; 0: what suits the pattern (a few hundred, dots: 4096) */
    float          length; /* mean length in the square; 0: what suits it */
    float          uneven; /* 0 regular … 1 very irregular */
    uint32_t       seed;
} pattern_options;

/* Wraps around without seams; the same options give the same strokes. Both priorities are set: the light priority
 * so that every prefix is evenly spread and layers follow each other, the perspective priority by
 * strokes_set_perspective's PERSPECTIVE_EVEN. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status strokes_generate(strokes *out, const pattern_options *options, lmn_error *error);

/* --- priorities --- */

/* Chords that follow each other in the list, each in the layer of the one before and beginning where that ends, are
 * one curve: it is ordered as a whole, and its chords have the same priority. */

typedef enum priority_order {
    ORDER_DRAWN,    /* within a layer as they are in the list */
    ORDER_SHUFFLED, /* within a layer at random (EX-19) */
    ORDER_EVEN      /* within a layer so that what is left is always evenly spread: farthest next, around the corners */
} priority_order;

typedef enum priority_fraction {
    FRACTION_COUNT,  /* all strokes take the same step */
    FRACTION_LENGTH, /* a layer's fraction of 0 … 1 is its fraction of all lengths (EX-20), a stroke's step its own
                        length */
    FRACTION_AREA    /* equalised: a stroke's step is the area that it covers anew at width `covering` (EX-21) */
} priority_fraction;

/* Sets all light priorities: layer by layer, the earliest on top. covering: stroke width in the square, for
 * FRACTION_AREA; the ink of all strokes with priority above 1 − t is then t × the ink of all. Errors: LMN_MEMORY. */
lmn_status strokes_set_light(strokes *s, priority_order order, priority_fraction fraction, double covering,
                             uint32_t seed, lmn_error *error);

typedef enum perspective_order {
    PERSPECTIVE_TIED,   /* equal to the light priority */
    PERSPECTIVE_RANDOM, /* a random permutation of all strokes */
    PERSPECTIVE_EVEN,   /* every prefix evenly spread, and as long together as its fraction */
    PERSPECTIVE_LAYERS  /* late layers go first, so that what is far keeps strokes of few directions (R-P3) */
} perspective_order;
extern const char *const perspective_order_names[5];

lmn_status strokes_set_perspective(strokes *s, perspective_order order, uint32_t seed, lmn_error *error);

/* --- drawing --- */

struct stroke_image;

/* What is drawn and how wide. */
typedef struct stroke_brush {
    double width; /* texels */
    double taper; /* fraction of the length over which both ends run out to nothing; 0: round ends */
    double cap; /* above 0: the same in texels, at any length; at most a quarter of it each, so that short strokes have
                   a middle too. `taper` does not count */
    double grain; /* 0 even … 1: streaks along the stroke, as long and as wide on any picture, and less pressure towards
                     its end */
    double from, to; /* a chord's position on its line of length 1, so that a curve runs out at its ends only; both 0:
                        it is the whole line */
    const struct stroke_image *image; /* NULL, or what strokes look like (dots do not): then `taper` and `cap` do not
                                         count. Lent */
} stroke_brush;

/* The brush for one stroke of a list: with the list's width, and its position on its curve. */
stroke_brush strokes_brush_at(const strokes *s, size_t index, const stroke_brush *brush);

/* Combines one stroke into a square picture of `side` texels that repeats: calls `texel` for each texel that it
 * touches, row 0 at the bottom, with the fraction of the texel that it covers: min(1, width, width / 2 + 1/2 −
 * distance to the axis), above 0, or the image's mean ink there. Copies around the border are included; a texel is
 * called once at most. */
typedef void (*stroke_texel_fn)(void *user, size_t index, float coverage);
void stroke_draw(const texture_stroke *s, int side, const stroke_brush *brush, stroke_texel_fn texel, void *user);

/* Ink of all strokes with light ≥ threshold_light and perspective ≥ threshold_perspective (EX-01: both), black on
 * white, 255 is paper: the picture beside the .stx that guides the placing of texture coordinates (EX-24). `out`
 * has side² bytes, row 0 at the bottom. */
void strokes_draw(const strokes *s, int side, const stroke_brush *brush, float threshold_light,
                  float threshold_perspective, uint8_t *out);

#endif
