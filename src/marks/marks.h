/* Marks on surfaces: dots, strokes and polygons that lie on a mesh, each with priorities that decide where and when it
 * is drawn. Freudenberg 2003, chapter 5 (explicit halftoning); rows EX-01 to EX-16 and EX-26 to EX-33. Needs no GPU.
 *
 *   a mesh ──► marks, once ──► thresholds from light and position, each frame ──► what is drawn of them: on the GPU, or
 * here as a marks_page
 */
#ifndef LIMNER_MARKS_MARKS_H
#define LIMNER_MARKS_MARKS_H

#include "base/colour.h"
#include "scene/scene.h"

struct strokes; /* stroke_texture/strokes.h */

/* Triangles that marks are put on. Borrowed. */
typedef struct mark_surface {
    const vec3     *positions, *normals; /* per vertex; normals unit */
    const vec2     *uvs;                 /* NULL: none */
    const uint32_t *indices;             /* three a triangle */
    uint32_t        vertex_count, triangle_count;
    vec3            up; /* of the scene, unit; 0: nobody knows */
    /* How bright the surface itself is at a place of a triangle, linear, 0 … 1: the mean over so much around it.
     * NULL: 1 everywhere. */
    double (*brightness)(const void *of, uint32_t triangle, vec3 at, double around);
    const void *brightness_of;
} mark_surface;

/* A dot. It has one priority for light and distance together (EX-31). */
typedef struct mark_dot {
    vec3     position, normal;
    float    fraction[2]; /* of the triangle's second and third corner */
    float    priority;    /* 1 − rank / count; every prefix of the ranks is evenly spread */
    float    bright;      /* of what it lies on, 0 … 1, linear: set by who knows the material; 1 */
    uint32_t triangle;
} mark_dot;

/* By how much pieces may leave the surface of a stroke that bends, fraction of its length. */
#define MARK_SAG 0.012

/* How many widths of its strip a line that flows knows, and the most points that lines are followed in. */
enum { FLOW_SPACES = 4, FLOW_POINTS_MAX = 8000000 };

/* An end of a piece of a line that flows. */
typedef struct flow_end {
    vec3  normal;
    float drawn;   /* fraction of a grouped stroke that was drawn up to here; one half without groups */
    float bright;  /* of what the line lies on, 0 … 1, linear */
    float shade;   /* how dark the place is among those of its flat face, −1 … 1; elsewhere 0 */
    float to_edge; /* along the line to where the surface or its field ends, model units; FLOW_ENDLESS: nowhere */
    float room;    /* how broad its face is, or the edge that the line goes round, model units */
    float shift;   /* how far the hand is off the line, in its largest errors: −1 … 1, to the left of a to b */
    float to_end;  /* along the line to where it runs out, model units; FLOW_ENDLESS: it does not */
    float spaces[FLOW_SPACES]; /* how wide its strip is once its level, and the ones after it, are whole: fractions of
                                  what it would be if all were even; later ones are about 1 */
} flow_end;
#define FLOW_ENDLESS 1e30f

/* A straight piece of a stroke, on one triangle or over small ones. Pieces of a stroke follow each other. */
typedef struct mark_line {
    vec3  a, b, normal;
    vec3  middle, middle_normal; /* of the whole stroke: where its tone is decided, so that it is drawn whole */
    vec3  middle_direction;      /* along it there, unit: pieces of strokes that flow have none */
    float light, perspective;    /* priorities */
    float span; /* 0: two thresholds (EX-01). Else the light priority is the top of a layer that is this wide, and
                 * within it the share that light asks for is multiplied by that of distance, so that one order serves
                 * both (EX-31) */
    float    from, to; /* along the stroke, model units, from its beginning */
    float    length;   /* of the whole stroke, model units */
    float    density;  /* length of all strokes there to a unit of area */
    float    bright;   /* as a dot's; of lines that flow, their ends have it */
    uint32_t triangle, stroke;
    flow_end ends[2]; /* of lines that flow: these decide about themselves all along */
    float    rank;    /* the level at which it comes, 0 … */
    float    group;   /* −1 … 1: how dark its group is among others */
    uint8_t  level, set;
} mark_line;

/* Marks of one surface. */
typedef struct marks {
    mark_dot       *dots; /* in the order of their ranks */
    size_t          dot_count;
    mark_line      *lines;
    size_t          line_count, line_capacity;
    size_t          stroke_count;
    double          area;        /* of the surface, model units */
    double          line_length; /* of all lines */
    bool            flow;        /* lines flow: marks_flow.c */
    double          apart;       /* then: of those of level 0, model units */
    int             levels;
    double          sag;   /* how far pieces may leave the surface */
    const uint32_t *parts; /* per triangle: index of its part, borrowed; NULL: nobody asks */
} marks;
void surface_marks_release(marks *m);
/* Tells all pieces of a stroke, of which there is one at least, in their order, how it runs at its middle. Returns
 * which piece that is. */
size_t mark_stroke_middle(mark_line *pieces, size_t count);

/* Area of a surface. */
double mark_surface_area(const mark_surface *s);

/* --- dots (marks_stipple.c, marks_eliminate.c) ---------------------------------------------------------- */

/* Spreads `count` dots (at most LIMIT_MARKS) evenly over a surface, each part of it as densely: every prefix of
 * them is blue noise. Points on opposite sides of thin walls do not know of each other. Deterministic, whatever the
 * number of threads. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status marks_stipple(marks *out, const mark_surface *s, size_t count, uint32_t seed, lmn_error *error);

/* The same, found again on disk (base/store.h) where it was made before. */
lmn_status marks_stipple_kept(marks *out, const mark_surface *s, size_t count, uint32_t seed, lmn_error *error);
/* The same, of what is longer than wide: `direction` gives the direction of a stroke at a dot, and its length counts.
 * NULL: dots. */
typedef vec3 (*mark_direction_fn)(void *user, const mark_dot *at);
lmn_status marks_spread(marks *out, const mark_surface *s, size_t count, uint32_t seed, mark_direction_fn direction,
                        void *user, double length, lmn_error *error);

/* A point among candidates. */
typedef struct spread_position {
    vec3 position, normal;
    vec3 direction; /* unit: along the stroke that begins there; 0 for dots */
} spread_position;

/* Orders points by taking away, again and again, the one that is most crowded by those left (sample elimination:
 * Yuksel 2015). ranks[i] is the number of point i in the order, those that are left longest first; what goes before
 * `wanted` points are left has UINT32_MAX. `area`: of what they lie on; `length`: of the strokes that will be
 * there, 0 for dots: strokes keep away from each other more sideways than along. False: memory is gone. */
bool marks_eliminate(uint32_t *ranks, const spread_position *points, size_t count, size_t wanted, double area,
                     double length);

/* --- strokes of a stroke texture (marks_tile.c) --------------------------------------------------------- */

typedef struct tile_options {
    float    repeat; /* how many times the unit square of strokes lies on the unit of texture coordinates */
    float    jitter; /* how far copies of a stroke are moved, fraction of the square, at most 0.5 (EX-33) */
    float    turn;   /* turns the strokes, radians */
    uint32_t seed;
    /* Indication (EX-28): a grey map over texture coordinates, 0 … 1, row 0 at the bottom; 0.5 changes nothing.
     * NULL: none. */
    const float *indication;
    int          indication_width, indication_height;
    float        indication_strength;
} tile_options;

/* Lays strokes over the range of texture coordinates, cuts them at every triangle, and lifts them onto the surface.
 * A stroke keeps its number, its priorities and its arc length across triangles. Triangles without area in texture
 * coordinates get none. Errors: LMN_MEMORY, LMN_LIMIT, LMN_USAGE (the surface has no texture coordinates). */
lmn_status marks_tile(marks *out, const mark_surface *s, const struct strokes *strokes, const tile_options *options,
                      lmn_error *error);

/* The part of the segment from a to b that lies in a triangle, as parameters along it; false when there is none. */
bool mark_clip_line(const double a[2], const double b[2], const double corners[3][2], double out[2]);
/* Barycentric coordinates; false when the triangle has no area. */
bool mark_barycentrics(const double p[2], const double corners[3][2], double out[3]);

/* --- strokes in planes (marks_trace.c) ------------------------------------------------------------------ */

typedef struct trace_options {
    size_t   count;  /* of strokes */
    double   length; /* of a stroke, model units */
    float    uneven; /* how much lengths and directions differ, 0 … 1 */
    int      series; /* 1 … 4: sets of strokes that cross; later ones for darker positions */
    float    turn;   /* angle between one set and the next, radians */
    uint32_t seed;
} trace_options;

/* Strokes begin at evenly spread positions and walk both ways over the surface, each in a plane of its own, until they
 * are long enough or come to a border or a sharp edge. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status marks_trace(marks *out, const mark_surface *s, const trace_options *options, lmn_error *error);

/* --- grass (marks_grass.c) ------------------------------------------------------------------------------ */

typedef struct grass_options {
    size_t   count;   /* of blades */
    int      tuft;    /* how many grow from one place */
    double   length;  /* mean, model units */
    double   upright; /* 0: along the surface's normal; 1: upwards */
    double   lean;    /* mean angle to that, radians */
    double   combed;  /* how much they lean to the same side, down the slope: 0 … 1 */
    double   uneven;  /* how much lengths and angles differ, 0 … 1 */
    vec3     up;
    uint32_t seed;
} grass_options;

/* Blades that stand on the surface; tufts are strewn evenly, those of any share of the ranks, too, and have one rank.
 * Their tone is that of their root. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status marks_grass(marks *out, const mark_surface *s, const grass_options *options, lmn_error *error);

/* --- strokes along the form (streamlines_*.c) ----------------------------------------------------------- */

typedef struct flow_options {
    double apart;   /* of lines where all are there, model units */
    int    levels;  /* of lines, each with half the distance of the one before; that of the first is all this doubled */
    double length;  /* mean length of strokes that lines are cut into, model units; 0: whole lines */
    float  uneven;  /* how much lengths differ, 0 … 1 */
    double groups;  /* breadth of groups in which strokes begin and end together, in their lengths; 0: none */
    double overlap; /* how far they run on into the next group, at most, in their lengths */
    int    series;  /* 1 … 4: sets of lines that cross */
    float  turn;    /* angle between one set and the next, radians */
    float  slant;   /* angle of the first set to the field where that was chosen, on flat faces, radians */
    double sag;     /* how far pieces may leave the surface, model units */
    bool   whole;   /* strokes are drawn whole, by their middle (marks_law.c), instead of flowing (marks_flow.c) */
    uint32_t seed;
} flow_options;

/* Lines along the directions in which a surface bends (field/direction_field.h), evenly spaced at each level, with
 * those of coarser levels among those of finer ones; none crosses another of its set. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status marks_streamlines(marks *out, const mark_surface *s, const flow_options *options, lmn_error *error);

/* --- on what moves (marks_carry.c) ---------------------------------------------------------------------- */

/* Brings marks that were made on `before` to where the same triangles are `now`: dots stay at their fractions, pieces
 * of strokes where they are in their triangle, joints closed. Priorities, densities and lengths along strokes stay
 * those of `before`, so that no mark comes or goes because the surface bends. */
void marks_carry(marks *m, const mark_surface *before, const mark_surface *now);

/* --- polygons (marks_polygon.c) ------------------------------------------------------------------------- */

enum { MARK_POLYGON_MAX = 6 };

/* A corner that moves from its source to its target as tone goes from 0 to 1 (EX-15). */
typedef struct mark_corner {
    double source[2], target[2];
} mark_corner;
void mark_corner_at(const mark_corner *corners, size_t count, double tone, double (*out)[2]);

/* A triangle M1 M2 M3 whose third corner moves from M2 (p = 0) to M3 (p = 1), cut to another triangle once so that
 * it shrinks as the whole one does (EX-16). */
typedef struct mark_cut {
    double first[2];   /* M1 */
    double side, base; /* |M1 M2|, |M2 M3| */
    double angle;      /* at M2 */
    int    count;      /* corners, at most MARK_POLYGON_MAX; 0: nothing is left */
    double corners[MARK_POLYGON_MAX][2];
    double turns[MARK_POLYGON_MAX]; /* angle at M1 from M2 to the corner */
} mark_cut;
void mark_cut_make(mark_cut *out, const double mark[3][2], const double onto[3][2]);
/* Its corners at p; `out` has room for MARK_POLYGON_MAX + 1. Returns how many. */
int mark_cut_at(const mark_cut *c, double p, double (*out)[2]);

/* --- thresholds (marks_law.c; surface/marks.glsl is the same for the GPU) ------------------------------- */

typedef enum mark_law {
    MARK_LAW_THESIS, /* 1 − t = d |N·P| / |P|², as printed: right for lines that lie across the way a surface tilts */
    MARK_LAW_LINE,   /* the same ink on the page for lines of any direction: knows how much each is foreshortened */
    MARK_LAW_DOT     /* for dots, which do not get smaller */
} mark_law;

/* Fraction of the marks to be drawn at an eye-space position when all are drawn face-on at distance `d`, not clamped:
 * 1 − t of the thesis' thresholds for distance and slope together, or by another law (EX-03 to EX-05). `direction`:
 * unit, of a line. The last two laws are exact off the picture's middle too. Without perspective d is a number to a
 * unit of length. */
double mark_fraction(mark_law law, const double position[3], const double normal[3], const double direction[3],
                     double d, bool orthographic);

/* Page area, in pixels, of a unit of a surface's area (EX-02); `focal`: of the projection, pixels at depth 1, or to
 * a unit without perspective. */
double mark_page_area(const double position[3], const double normal[3], double focal, bool orthographic);
/* Page length of a unit of length along a direction. */
double mark_page_length(const double position[3], const double direction[3], double focal, bool orthographic);

/* EX-07: visible where both priorities are at least their thresholds. */
bool mark_is_drawn(float light, float perspective, float light_threshold, float perspective_threshold);
/* EX-08: 1 drawn whole … 0 not at all; `ramp` of thresholds over which it comes. Thresholds are stretched so that
 * at 0 all is drawn and at 1 nothing. */
float mark_fade(float light, float perspective, float light_threshold, float perspective_threshold, float ramp);

/* How much of a dot is drawn, fraction of its area, when `fraction` of all dots are wanted: those of low rank whole,
 * some around the fraction in part. Dots grow where there are not enough of them, to `most` times their area. */
float mark_dot_ink(float priority, float fraction, float ramp, float most);
/* How much of a stroke is drawn, fraction of its width. `light_fraction`, `fraction`: what light and distance ask for,
 * 0 … 1. */
float mark_line_ink(const mark_line *line, float light_fraction, float fraction, float ramp);

/* Sum of the areas of evenly spread dots, for a position of the page to be covered to this fraction by what does not
 * overlap. `rim`: 0 for true discs; for those that are drawn in pixels 1 / diameter²: the soft rims of dots that
 * touch cover less. */
float mark_ink_of_cover(float cover, float rim);
/* The same for strokes, in layers of `span` (a fraction of all) of strokes side by side that cross those before; 0:
 * strewn at random. `darkest`: of all strokes. `crowded`: how far those of one set are from being side by side, to
 * being strewn at random. */
#define MARK_CROWDED_IN_PLANES 0.24f /* measured */
float mark_ink_of_strokes(float cover, float darkest, float span, float crowded);

/* --- lines that flow (marks_flow.c; surface/marks_lines.vert is the same for the GPU) ------------------- */

/* Over how much of a level a line grows from its rank on: all of a level grow at nearly the same time, so that lines on
 * the page are as far apart everywhere; their ranks differ by FLOW_UNEVEN, so that ends do not line up. */
#define FLOW_RAMP   0.5
#define FLOW_UNEVEN 0.3
/* How far the longest lines go into what is bare, distances of lines. */
#define FLOW_SPARSE 14.0

/* How much of the page the lines of a set cover, for a position to be this dark: the first carries it alone up to
 * `crossed`, and what it leaves bare later ones cover alike. `steady`: each but the last goes up to `crossed` only, and
 * the next one begins there. */
double mark_cover_of_set(double darkness, double crossed, int set, int series, bool steady);
/* How wide a line is, model units, where `level` is wanted: log2 of the distance of level 0 over the wanted one.
 * `apart`: distance of level 0. */
/* A line's own width, 1 ± uneven / 2. */
double mark_flow_swell(const mark_line *line, double uneven);
/* What a hand makes of it: firm where strokes of a group begin, `pressure` (0 … 1) less where they end, and some groups
 * darker than others, by `patchy` (0 … 1). The mean is 1. */
double mark_flow_hand(const mark_line *line, const flow_end *end, double pressure, double patchy);
/* How much of a place lines shall cover on a flat face that gets darker from one side to the other, by `gradient` of
 * itself: of what is dark, between lines that are white, or they themselves. */
double mark_flow_gradient(double cover, const flow_end *end, double gradient, bool white);
/* What is covered where light leaves the page bare: of `sparse` (0 … 1) of all lines so much as the least of them
 * have, next to edges. `distances`: of lines on the page, to the edge. */
double mark_flow_sparse(const mark_line *line, double distances, double sparse, double least);
/* How much is left where the surface is seen edge-on: nothing up to this cosine, all from three times that. Lines there
 * would be a blot, and whether they are seen would be chance. What shall be black is so as far as its rim. */
#define FLOW_GRAZING 0.05
/* What lines cover that fill a face without room: more than all, as they are no longer evenly apart there. */
#define FLOW_FILLED 2.0
double mark_flow_grazing(double facing, double darkness);
/* How much is left on a face that has room for so few distances of lines: nothing below half of `room`. */
double mark_flow_room(double distances, double room);
/* How much of the width is left so many distances from where a line runs out, which takes `taper`: all where so much is
 * covered that lines join, from half of that on more than the tip has. */
double mark_flow_tip(double to_end, double taper, double tip, double cover, double join);
double mark_flow_width(const mark_line *line, const float spaces[FLOW_SPACES], double apart, int levels, double level,
                       double cover);

/* --- what is drawn of them, on a page (marks_page.c) ---------------------------------------------------- */

enum { MARK_LIGHTS_MAX = 8, FLOW_ANY_WIDTH = 2 /* of mark_style.widest: no limit */ };

/* How records of strokes lie in the GPU's memory (EX-29): whole floats at each corner; packed at each corner; packed,
 * once. */
typedef enum mark_layout { LAID_CORNERS, LAID_PACKED, LAID_ONCE } mark_layout;
/* How strokes are left out (EX-13). */
typedef enum mark_hiding {
    HIDE_OUTSIDE, /* outside of what is drawn */
    HIDE_WINDING, /* wound the other way round */
    HIDE_WIDTH,   /* without width */
    HIDE_DEPTH,   /* by the depth test */
    HIDE_DISCARD, /* pixel by pixel */
    HIDE_ALPHA    /* drawn without opacity */
} mark_hiding;

/* How marks look and what decides. */
typedef struct mark_style {
    float   diameter;                                 /* of dots, or width of strokes, pixels */
    float   scale;                                    /* strokes: mean distance where it is darkest, pixels */
    float   fade, most;                               /* ramp; how much larger dots may become, times their area */
    float   taper;                                    /* fraction of a stroke over which each end runs out */
    int32_t law;                                      /* mark_law, of strokes */
    float   crowded;                                  /* mark_ink_of_strokes */
    float   crossed, least, widest, tip, join, swell; /* lines that flow: darkness from which sets cross; cover below
                                                         which lines run out; most width, in distances; how pointed
                                                         ends are, and the cover from which they are not; unevenness
                                                         of widths. `taper` is in distances of lines */
    float gradient, sparse, black;       /* mark_flow_gradient, mark_flow_sparse; darkness from which faces without room
                                            for lines are black; 0: never */
    float pressure, patchy, stray, room; /* mark_flow_hand; how far strokes leave their lines, in distances;
                                            mark_flow_room */
    int32_t series;
    bool    steady; /* mark_cover_of_set */
    float   shadow, light, contrast,
        texture;      /* tone without and in full light; its bend; fraction of the surface's own brightness */
    bool white;       /* marks stand for light */
    bool by_priority; /* a stroke is there where its light priority reaches the tone, whatever ink that makes */
    bool pixels; /* dots are blended into pixels: the same ones are drawn as on the GPU; else true discs of the same
                    tone */
    colour      ink;
    mark_layout layout; /* on the GPU, of strokes */
    mark_hiding hiding;
    float       stands; /* how far marks may stand out of the surface, fraction of the diagonal of all of it: what hides
                           them is what lies before them, and they end in a tip; 0: they lie in it */
    bool thin;          /* strokes are native lines there, a pixel wide */
} mark_style;

/* A camera, and light in its eye space as shaders have it: w 0: a direction, w 1: a position. */
typedef struct mark_view {
    mat4  model_view, projection;
    bool  orthographic;
    int   width, height; /* of the page, pixels */
    float lights[MARK_LIGHTS_MAX][4], colours[MARK_LIGHTS_MAX][4];
    int   light_count;
} mark_view;

/* How many surfaces lie in front of positions in model axes: 0 is visible. */
typedef void (*mark_hidden_fn)(void *user, const double (*positions)[3], size_t count, uint32_t *out);

typedef struct marks_page_point {
    float    x, y, width;
    uint32_t part; /* of dots: id of what it lies on; 0: not known */
} marks_page_point;

typedef struct marks_page_line {
    uint32_t first, count; /* points */
    uint32_t stroke;
    uint32_t part; /* id; 0: not known */
} marks_page_line;

/* What is to be drawn, in pixels; origin at the top left, y down. */
typedef struct marks_page {
    marks_page_point *dots; /* width: diameter */
    size_t            dot_count, dot_capacity;
    marks_page_line  *lines;
    marks_page_point *points; /* of lines; widths differ where strokes run out */
    size_t            line_count, line_capacity, point_count, point_capacity;
    colour            ink; /* linear, straight alpha */
} marks_page;
void marks_page_release(marks_page *p);

/* Adds what is drawn of marks in this view. `hidden` may be NULL: then nothing but what turns away is hidden.
 * Errors: LMN_MEMORY. */
lmn_status marks_visible(marks_page *out, const marks *m, const mark_view *view, const mark_style *style,
                         mark_hidden_fn hidden, void *user, lmn_error *error);

#endif
