/* Inside the marks folder: lines that follow a surface's field of directions (marks_streamlines, marks.h). */
#ifndef LIMNER_MARKS_STREAMLINES_H
#define LIMNER_MARKS_STREAMLINES_H

#include "field/direction_field.h"
#include "marks/d3.h"
#include "marks/marks.h"

static inline d3 d3_along(d3 from, d3 direction, double by)
{
    return (d3){from.x + by * direction.x, from.y + by * direction.y, from.z + by * direction.z};
}

static inline double d3_length(d3 v)
{
    return sqrt(dot(v, v));
}

static inline d3 d3_unit(d3 v)
{
    double length = d3_length(v);
    return length > 0 ? (d3){v.x / length, v.y / length, v.z / length} : v;
}

/* --- walking over a surface (streamlines_walk.c) -------------------------------------------------------- */

/* A flat face: lines get darker along its way, which is unit, as far as it reaches from its middle. */
typedef struct flow_plane {
    d3     middle, way;
    double reach;
    double sure; /* 0 … 1: much less where it goes over into what is round */
} flow_plane;

/* A surface with its field, and how its triangles hang together. */
typedef struct flow_surface {
    const mark_surface *surface;
    primitive           mesh;     /* the surface, for who knows only these */
    uint32_t           *across;   /* mesh_adjacency */
    uint32_t           *bodies;   /* per triangle: the first one of those that it hangs together with */
    float              *rooms;    /* per triangle: how broad its face is, between creases (streamlines_rooms.c) */
    uint32_t           *plane_of; /* per triangle: its flat face, which is at the number of one of its triangles */
    flow_plane         *planes;
    direction_field     field;
    double              slant; /* by which directions of flat faces are turned, radians */
} flow_surface;

/* Errors: LMN_MEMORY.
 * Release also after one. */
/* `apart`: of lines of level 0, which decides which bends are too small for them; 0: none is. */
lmn_status flow_surface_make(flow_surface *out, const mark_surface *s, double apart, lmn_error *error);
void       flow_surface_release(flow_surface *f);
/* False when memory is gone. */
bool flow_rooms_make(flow_surface *f);
bool flow_planes_make(flow_surface *f);
/* How dark a place is among those of its flat face, −1 … 1, with mean 0; 0 where that is small for lines so far `apart`
 * (streamlines_planes.c). */
double flow_shade_at(const flow_surface *f, uint32_t triangle, vec3 at, double apart);

/* A position on a triangle, and which way a walk goes there (unit, in the triangle's plane). */
typedef struct flow_position {
    d3       at, direction;
    uint32_t triangle;
    bool     over; /* the last step went over a border of the field, at which the line could have ended, too */
} flow_position;

/* What a step came to. */
typedef enum flow_step {
    FLOW_ON,
    FLOW_EDGE /* of the surface, or a crease */,
    FLOW_TURNED /* the field has another arm */
} flow_step;

/* The field's line there, turned by an angle about the normal; its sign is that which is nearer to `like`. False where
 * there is none. */
bool flow_direction(const flow_surface *f, const flow_position *p, double turn, d3 like, d3 *out);
/* Walks on, at most `length` and at most to the triangle's end: along the field turned by `turn`. `*gone`: how far. */
flow_step flow_along(const flow_surface *f, flow_position *p, double turn, double length, double *gone);
/* The same straight ahead. */
flow_step flow_straight(const flow_surface *f, flow_position *p, double length, double *gone);
d3        flow_face_normal(const flow_surface *f, uint32_t triangle);
/* The surface's own normal there, from its vertices. */
d3 flow_normal(const flow_surface *f, const flow_position *p);

/* --- lines that keep their distance (streamlines.c) ----------------------------------------------------- */

typedef struct flow_point {
    vec3  at, normal;
    float arc;                 /* from the line's beginning */
    float spaces[FLOW_SPACES]; /* how wide the strip is that is the line's own, once all lines of its level, the
                                  next, and the one after that are there */
    uint32_t triangle;
} flow_point;

typedef struct flow_line {
    uint32_t first, count; /* points */
    uint8_t  level;
    bool     closed;
    bool     bounded[2]; /* this end lies where the surface or the field ends: there is no other line in the way */
    uint32_t ends[2];    /* the points, from `first`, where it runs out; what lies beyond goes on between lines that are
                            too near, and is drawn only where lines join */
    float rank;          /* level at which it comes, between its own and the one before */
} flow_line;

typedef struct flow_lines {
    flow_point *points;
    flow_line  *lines;
    size_t      point_count, point_capacity, line_count, line_capacity;
    double      apart; /* of lines of level 0 */
    int         levels;
} flow_lines;
void flow_lines_release(flow_lines *l);

/* Lines of a set: of as many levels as are asked for, each half as far from each other as those of the level before,
 * among which they lie. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status flow_lines_make(flow_lines *out, const flow_surface *f, const flow_options *w, int set, lmn_error *error);

/* Does the edge of its triangle that a point lies on, next to the others, end a face? */
bool flow_is_at_crease(const flow_surface *f, const flow_point *p);
/* The triangle that a line lies on from one of its points to the next. */
uint32_t flow_triangle_between(const flow_surface *f, const flow_point *a, const flow_point *b);

/* --- bends (streamlines_bends.c) ------------------------------------------------------------------------- */

/* How broad the edge is that a line goes round at an arc, outwards; INFINITY: it goes straight on, or inwards. `apart`:
 * of the closest lines. */
double flow_bend_room(const flow_point *points, uint32_t count, double arc, double apart);

/* --- groups of strokes (streamlines_groups.c) ------------------------------------------------------------ */

typedef struct flow_group {
    uint64_t number;
    double   tone, tilt; /* 0 … 1, −1 … 1: how dark it is among others, how much it is turned */
    d3       toward;     /* which way its strokes are drawn */
} flow_group;

/* The group that a position on a line belongs to; `direction`: the line's, unit. */
void flow_group_find(flow_group *out, d3 at, d3 direction, double length, double breadth, uint32_t seed);

/* --- who is near (streamlines_grid.c) ------------------------------------------------------------------- */

typedef struct flow_sample {
    vec3     at, normal, direction;
    float    arc, loop; /* from the line's beginning; length of a closed line, 0 of others */
    uint32_t line, point, body;
    uint32_t next; /* in its bucket */
    int32_t  cell[3];
} flow_sample;

typedef struct flow_grid {
    flow_sample *samples;
    uint32_t    *buckets;
    size_t       count, capacity;
    uint32_t     mask;
    double       apart; /* of lines */
    float        cells; /* to a unit; their side is 1.2 distances of lines */
} flow_grid;

/* Of lines `apart` from each other, for about `count` samples; false when memory is gone. */
bool flow_grid_open(flow_grid *g, double apart, size_t count);
void flow_grid_release(flow_grid *g);
bool flow_grid_add(flow_grid *g, const flow_sample *s);
/* Takes the last ones away again. */
void flow_grid_shorten(flow_grid *g, size_t count);

/* Is a sample of another line, or of this one farther along than `own`, nearer than `distance`? On the same side of the
 * surface, and of the same body. */
bool flow_grid_is_near(const flow_grid *g, const flow_sample *s, double distance, double own);
/* How far the next line to the left and to the right is, at most `reach`; INFINITY: none. */
void flow_grid_gaps(const flow_grid *g, const flow_sample *s, double reach, double out[2]);

#endif
