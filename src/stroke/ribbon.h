/* Ribbons: strokes as they are drawn. One description for the screen, SVG and PDF: a line of points with a width
 * and an opacity at each. */
#ifndef LIMNER_STROKE_RIBBON_H
#define LIMNER_STROKE_RIBBON_H

#include "base/colour.h"
#include "stroke/stroke.h"

typedef enum hidden_style { HIDDEN_NONE, HIDDEN_SOLID, HIDDEN_DASHED } hidden_style;
typedef enum stroke_brush { BRUSH_PEN, BRUSH_BRUSH, BRUSH_PENCIL, BRUSH_CHARCOAL, BRUSH_COUNT } stroke_brush;

/* How strokes are drawn. Lengths in units of the page (stroke/stroke.h). */
typedef struct stroke_style {
    colour  colours[STROKE_CLASS_COUNT]; /* NaN red: not drawn in a colour of its own, takes that of the contour */
    float   width;
    float   crease_width;          /* of all that is no outline, fraction of the width */
    int32_t brush;                 /* stroke_brush */
    float   cover;                 /* the most of the page that lines cover where they crowd; 0 and 1: any */
    bool    narrow;                /* borders of colours and tangent edges are half as wide, as on drawings */
    float   taper;                 /* length over which ends thin out; 0: none */
    float   pressure;              /* 0 … 1: how much the width varies along */
    float   wobble, wobble_length; /* how far from the true line; how far apart its waves are */
    float   overshoot;             /* how far ends run on, corners too */
    float   overshoot_most;        /* fraction of a line's own length; 0: as far as they like */
    int32_t repeats;               /* times each line is drawn, from corner to corner */
    float   repeat_apart;          /* how far repeats differ */
    float   repeat_turn;           /* and in direction at most, degrees */
    float   repeat_least;          /* shorter ones are drawn once */
    float   repeat_fade;           /* opacity of each repetition, fraction of the one before; 0: the same */
    float   pull;                  /* longest curve that is drawn in one go; 0: any */
    float   dash, gap;             /* along the chain; dash 0: unbroken */
    float   halo;                  /* gap beside what passes in front */
    int32_t hidden;                /* hidden_style */
    colour  hidden_colour;
    float   hidden_width, hidden_dash, hidden_gap;
    float   hidden_fade;  /* opacity is multiplied by it with each pair of surfaces more in front */
    int32_t hidden_depth; /* surfaces in front at most; 0: any number */
    float hidden_crowd; /* hidden lines keep at least this far apart: the more important one stays; 0: all are drawn */
    bool  keeps_dashed; /* a dashed line of one width is one ribbon with its dashes, for who can dash it himself; else
                           each  dash is a ribbon */
} stroke_style;

typedef struct ribbon_point {
    float x, y, depth, arc;
    float half;  /* half the width */
    float alpha; /* 0 … 1 */
} ribbon_point;

typedef enum ribbon_end { RIBBON_ROUND, RIBBON_BUTT } ribbon_end;

typedef struct ribbon {
    stroke_class kind;
    uint32_t     part, hidden_by, chain;
    uint64_t     id;
    colour       ink; /* straight alpha, sRGB */
    int32_t      brush;
    uint32_t     first, count;           /* points */
    uint32_t     first_dash, dash_count; /* 0: unbroken */
    bool         closed,
        even; /* closed: ends where it began, the first point once more; even: one width and opacity all along */
    ribbon_end end;
} ribbon;

typedef struct ribbon_set {
    ribbon       *ribbons;
    ribbon_point *points;
    float (*dashes)[2]; /* from, to: arcs from where the ribbon begins; the first begins there, the last ends with it */
    size_t ribbon_count, point_count, dash_count;
} ribbon_set;

/* What this style draws of hidden lines: none of pieces of surface that are smaller on the page than the first, where
 * nothing of them is seen, nor of what is shorter than the second with all that it hangs together with. For
 * stroke_options. */
float ribbons_island(const stroke_style *style);
float ribbons_figure(const stroke_style *style);
/* Draws strokes in a style: what is hidden comes first, so that what is visible lies on it. The same seed, the same
 * ribbons; what is random belongs to a chain's id and position along it, so that it stays from frame to frame. Errors:
 * LMN_MEMORY. */
lmn_status ribbons_make(ribbon_set *out, const stroke_set *strokes, const stroke_style *style, uint32_t seed,
                        lmn_error *error);
void       ribbon_set_release(ribbon_set *r);

#endif
