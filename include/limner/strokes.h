/* Stroke textures: strokes in a square that repeats without seams, for hatching surfaces. A stroke has two priorities,
 * which say how long it stays: one as light grows, one as the surface moves away. Made from a pattern, from a drawing
 * (.svg) or stroke by stroke; kept as text
 * (.stx). docs/reference/strokes.md has the files.
 *
 * Every function can fail with LMN_USAGE (a NULL, a number that is not finite or not in its range) and LMN_MEMORY;
 * other errors are named, and on any error nothing has changed. Strokes are used by one thread at a time. No GL context
 * needed. Freudenberg 2003, section 5.2. */
#ifndef LIMNER_STROKES_H
#define LIMNER_STROKES_H

#include "limner/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_strokes lmn_strokes;

/* A straight stroke. The start lies in the square, 0 to 1, v upwards; the end may lie outside: the stroke goes on
 * at the opposite side. A dot has both ends at one position. A stroke in the layer of the one before, and beginning
 * where that ends, goes on with its curve. */
typedef struct lmn_stroke {
    float u0, v0, u1, v1; /* −16 … 16 */
    float light; /* priority: the stroke is drawn in light up to it; 1 stays longest, above 1 for ever, below 0 is never
                    drawn */
    float perspective; /* the same for distance: seen from twice, four times … as far, those with at least 1/2, 3/4 …
                          stay */
    int32_t layer;     /* 0 … 65535; 0 is the most important one */
} lmn_stroke;

typedef enum lmn_stroke_pattern {
    LMN_PATTERN_PARALLEL = 0, /* hatching */
    LMN_PATTERN_CROSS,        /* four series of hatching, each a layer */
    LMN_PATTERN_CONTOUR,      /* bent strokes, as they follow a form */
    LMN_PATTERN_BRICK,        /* bricks, and scratches on them in layers 1 and 2 */
    LMN_PATTERN_STIPPLE,      /* dots */
    LMN_PATTERN_SCRIBBLE,     /* loops */
    LMN_PATTERN_RANDOM        /* strokes of any direction */
} lmn_stroke_pattern;

/* What a pattern shall be like. Initialise with LMN_PATTERN_DESC_INIT. */
typedef struct lmn_pattern_desc {
    size_t             struct_size; /* set by LMN_PATTERN_DESC_INIT */
    lmn_stroke_pattern pattern;
    size_t             count;  /* of strokes, about; 0: what suits the pattern; at most 500000 */
    double             length; /* mean length in the square, up to 4; 0: what suits it */
    double             uneven; /* 0 regular … 1 very irregular */
    uint32_t           seed;
} lmn_pattern_desc;
#define LMN_PATTERN_DESC_INIT                                                                                          \
    {                                                                                                                  \
        sizeof(lmn_pattern_desc), LMN_PATTERN_PARALLEL, 0, 0, 0.5, 0                                                   \
    }

/* The order of strokes within a layer: as they are in the list, at random, or so that what is left is always evenly
 * spread. */
typedef enum lmn_stroke_order { LMN_ORDER_DRAWN = 0, LMN_ORDER_SHUFFLED, LMN_ORDER_EVEN } lmn_stroke_order;

/* How much of 0 … 1 a stroke takes: the same for all, by its length, or by the area that it covers anew (then tone
 * follows light on a straight line). */
typedef enum lmn_stroke_fraction { LMN_FRACTION_COUNT = 0, LMN_FRACTION_LENGTH, LMN_FRACTION_AREA } lmn_stroke_fraction;

/* Priorities for distance: those for light, a random order, one that is always evenly spread, or late layers go
 * first. */
typedef enum lmn_stroke_perspective {
    LMN_PERSPECTIVE_TIED = 0,
    LMN_PERSPECTIVE_RANDOM,
    LMN_PERSPECTIVE_EVEN,
    LMN_PERSPECTIVE_LAYERS
} lmn_stroke_perspective;

/* A picture of strokes. Initialise with LMN_STROKES_VIEW_INIT. */
typedef struct lmn_strokes_view {
    size_t struct_size; /* set by LMN_STROKES_VIEW_INIT */
    int    size;        /* pixels a side, 1 … 8192 */
    double width;       /* of strokes in pixels, above 0, at most 256; 0: 1/170 of the size */
    double light;       /* only strokes with at least this priority for light are shown */
    double distance;    /* … and with at least this one for distance */
} lmn_strokes_view;
#define LMN_STROKES_VIEW_INIT                                                                                          \
    {                                                                                                                  \
        sizeof(lmn_strokes_view), 512, 0, 0, 0                                                                         \
    }

/* Makes strokes from a pattern; with NULL there are none yet. The same description gives the same strokes. End them
 * with lmn_strokes_destroy. Errors: LMN_LIMIT (count). */
LMN_API lmn_status lmn_strokes_create(lmn_strokes **out, const lmn_pattern_desc *desc, lmn_error *error);

/* Reads a .stx file, or the lines of a drawing in .svg. End them with lmn_strokes_destroy. Errors: LMN_READ,
 * LMN_FORMAT (with file and line), LMN_LIMIT (a million strokes), LMN_UNSUPPORTED (another ending). */
LMN_API lmn_status lmn_strokes_load(lmn_strokes **out, const char *path, lmn_error *error);

/* Frees strokes and sets the handle to NULL; NULL and a pointer to NULL are accepted. */
LMN_API void lmn_strokes_destroy(lmn_strokes **strokes);

/* The name of a pattern ("cross"; static); NULL when there is none with this number. */
LMN_API const char *lmn_stroke_pattern_name(int pattern);

/* How many strokes there are. */
LMN_API size_t lmn_strokes_count(const lmn_strokes *strokes);

/* Reads one stroke. Errors: LMN_USAGE (index). */
LMN_API lmn_status lmn_strokes_get(const lmn_strokes *strokes, size_t index, lmn_stroke *out, lmn_error *error);

/* Changes one stroke; index = count adds one. A start outside of the square is moved into it, and the end with it.
 * Errors: LMN_USAGE (index, what is in the stroke), LMN_LIMIT (a million strokes). */
LMN_API lmn_status lmn_strokes_set(lmn_strokes *strokes, size_t index, const lmn_stroke *stroke, lmn_error *error);

/* Sets the priorities for light of all strokes: layer by layer, the first on top. `width` is that of strokes in the
 * square, for LMN_FRACTION_AREA: above 0, at most 1. */
LMN_API lmn_status lmn_strokes_set_light(lmn_strokes *strokes, lmn_stroke_order order, lmn_stroke_fraction fraction,
                                         double width, uint32_t seed, lmn_error *error);

/* Sets the priorities for distance of all strokes. */
LMN_API lmn_status lmn_strokes_set_perspective(lmn_strokes *strokes, lmn_stroke_perspective perspective, uint32_t seed,
                                               lmn_error *error);

/* Writes strokes. The format comes from `format` (".stx", ".svg", ".png") or, when that is NULL, from the path's
 * ending; path "-" is standard output. `view` says how a picture looks (NULL: LMN_STROKES_VIEW_INIT); .stx and .svg
 * have all strokes and do not look at it. A file appears whole or not at all. Errors: LMN_USAGE (unknown ending),
 * LMN_WRITE. */
LMN_API lmn_status lmn_strokes_write(const lmn_strokes *strokes, const char *path, const char *format,
                                     const lmn_strokes_view *view, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
