/* What the line technique `strokes` and who draws it share. */
#ifndef LIMNER_LINES_STROKE_STROKES_H
#define LIMNER_LINES_STROKE_STROKES_H

#include "lines/lines.h"
#include "stroke/ribbon.h"

typedef enum stroke_visibility { VISIBILITY_AUTO, VISIBILITY_EXACT, VISIBILITY_SAMPLED } stroke_visibility;

/* What lines of all techniques have is in `common` alone: strokes_style_of takes it into the style. */
typedef struct strokes_values {
    lines_common   common;
    stroke_options options;
    stroke_style   style;
    int32_t        visibility; /* stroke_visibility */
} strokes_values;

/* The style and the options as a drawing has them. */
stroke_style   strokes_style_of(const strokes_values *v);
stroke_options strokes_options_of(const strokes_values *v);

/* Do these lines need chains, which only the CPU makes? Else every edge can be drawn by itself, on the GPU. */
bool strokes_need_chains(const strokes_values *v);

/* --- records of edges: what the GPU needs to decide whether an edge is a line, and to draw it ----------- */

enum { EDGE_RECORD_VECTORS = 4, EDGE_RECORD_FLOATS = 4 * EDGE_RECORD_VECTORS };

/* Bits in the fourth number of a record; the shader has the same. */
typedef enum record_bit {
    RECORD_BORDER = 1,
    RECORD_CREASE = 2,
    RECORD_MATERIAL = 4,
    RECORD_PAIR = 8,    /* two faces, so that it may be an outline */
    RECORD_CLOSED = 16, /* of a closed piece: seen from behind, it is hidden */
    RECORD_CROSSING = 64,
    RECORD_DRAWN = 128,   /* the file brings it: no normals */
    RECORD_ROUNDED = 256, /* a crease in the middle of a rounding, whatever its own faces turn */
    RECORD_QUIET = 512    /* judged to be no crease, though its faces turn as far */
} record_bit;

/* One record an edge: x, y, z, bits; x, y, z, less the bend at the end; the normals of both faces, outward where the
 * piece is closed, with the turn of the chain and the bend at the begin (record_bends.h) behind them. Then one a line
 * that the file brings, with its lift behind the second position. NULL when memory is gone; the caller frees it. */
float *strokes_edge_records(const edge_mesh *m);
size_t strokes_edge_record_count(const edge_mesh *m);
/* By how much the gentlest edge turns, radians, that may be an outline and is neither border nor rounded crease: 0
 * where there is one within a smooth surface, pi where there is none. */
double strokes_gentlest_turn(const edge_mesh *m);
/* Those that may be lines for one viewer (`u_viewer` of lines/stroke/decide.glsl), in the same order, and hardly any
 * others: of meshes that move, for which all of them would be made and sent for one picture. Sets *count. */
float *strokes_edge_records_seen(const edge_mesh *m, const float viewer[4], size_t *count);
/* The same for the lines in which surfaces of an item cross others, in world axes. Sets *count. */
float *strokes_crossing_records(const stroke_scene *s, uint32_t item, size_t *count);

/* --- records of ribbons --------------------------------------------------------------------------------- */

enum { RIBBON_RECORD_VECTORS = 4, RIBBON_RECORD_FLOATS = 4 * RIBBON_RECORD_VECTORS };

/* The edge map's channel that a class is drawn into: 0 profile, 1 inner, 3 id. */
int strokes_channel(stroke_class c);
/* Hidden lines have the second of the map's channels that is not a class's; the composition tells them from the
 * rest. */
enum { CHANNEL_HIDDEN = 2 };

/* One record a piece of a ribbon: x, y, depth, half width at both ends, y upwards; opacity at both, channel, bits
 * of ends and brush; lengths along the ribbon up to both, of all of it, and a number of its own. `height`: of the
 * page. Sets *count. NULL when memory is gone; the caller frees it. */
float *strokes_ribbon_records(const ribbon_set *r, int height, size_t *count);

#endif
