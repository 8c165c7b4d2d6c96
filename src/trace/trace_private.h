/* What the files of this room share. Positions on the page: x, y in units, eye depth. */
#ifndef LIMNER_TRACE_TRACE_PRIVATE_H
#define LIMNER_TRACE_TRACE_PRIVATE_H

#include "trace/trace.h"

/* --- page.c ----------------------------------------------------------------------------------------------- */

/* A position on the page; false when it is behind the near plane. */
bool page_project(const stroke_camera *c, vec3 world, double out[3]);
/* What sees whatever page_project does. */
stroke_camera page_camera_of_the_past(const stroke_camera *c);
/* And back. */
void page_unproject(const stroke_camera *c, const double page[3], double out[3]);

/* Which of the page is covered by triangles, sampled twice a unit. */
typedef struct page_mask {
    uint8_t *covered;
    int      columns, rows;
} page_mask;
bool page_mask_open(page_mask *m, const stroke_camera *c); /* false: out of memory */
void page_mask_close(page_mask *m);
void page_mask_add(page_mask *m, const double *a, const double *b, const double *c);
bool page_mask_has(const page_mask *m, double x, double y);
/* All that parts show in a pose, the whole of each triangle before the near plane; with `before` (may be NULL), also on
 * their straight ways from that. False: out of memory. */
bool page_mask_add_parts(page_mask *m, const pose *p, const pose *before, const bool *parts,
                         const stroke_camera *camera);

/* --- bodies.c: what moves ----------------------------------------------------------------------------------- */

/* A primitive of a part, and where its vertices begin among all. */
typedef struct trace_mesh {
    uint32_t         part, instance, first;
    const primitive *primitive;
} trace_mesh;

/* World positions of all its vertices; the caller frees them with mem_free. NULL: out of memory. */
vec3 *trace_positions(const pose *p, const trace_mesh *m);

/* The joint that a vertex of a skinned primitive follows most. */
int32_t trace_joint_of(const lmn_scene *s, const node *n, const primitive *p, uint32_t vertex);

typedef enum body_motion {
    MOVES_ALONG,  /* one way */
    MOVES_AROUND, /* a centre on the page */
    MOVES_TOWARDS /* the viewer, or away */
} body_motion;

/* What moves as one: a node with what is below it, or of a skin the limbs that move alike. Its own coordinates on the
 * page are along and across its motion: units, or around a centre radians and units of radius, or towards the viewer
 * units of radius and radians. */
typedef struct trace_body {
    body_motion motion;
    int32_t     node;         /* that it moves with; NONE: its vertices move by themselves */
    double      way[2];       /* of its middle on the page, unit; MOVES_ALONG */
    double      centre[2];    /* of turning, or the middle */
    double      sense;        /* of turning: 1 or −1; towards the viewer 1, away −1 */
    double      zero;         /* the angle from which others are counted */
    double      speed;        /* how far it moves during the exposure, units, mean */
    double      across[2];    /* from, to */
    bool        round;        /* MOVES_AROUND: it lies all around an axis, as a wheel does, however that is seen */
    vec3        axis, pivot;  /* of that, in the world: unit, and where its nearer end meets it */
    double      radius, turn; /* in the world; radians during the exposure, about the axis */
    uint32_t    first, count; /* triangles */
} trace_body;

typedef struct trace_bodies {
    trace_mesh *meshes;
    double (*now)[3]; /* per vertex of all meshes, on the page; NaN: behind the viewer */
    uint32_t (*triangles)[3];
    trace_body *bodies;
    size_t      mesh_count, vertex_count, triangle_count, body_count;
} trace_bodies;

/* Which parts' bodies are looked for, and without what. */
typedef struct bodies_wanted {
    const bool          *parts;
    const bool          *jumping; /* per node, or NULL: those move by no way, and are none */
    const stroke_camera *camera;
    stroke_section       section; /* triangles that are cut away are none of a body */
} bodies_wanted;
/* Finds what moves between two poses, `before` being `fraction` of the exposure earlier. Errors: LMN_MEMORY. */
lmn_status bodies_find(trace_bodies *out, const pose *now, const pose *before, double fraction,
                       const bodies_wanted *wanted, lmn_error *error);
void       bodies_release(trace_bodies *b);
/* The mesh that a vertex of all is in; there is one. */
uint32_t trace_mesh_of(const trace_bodies *t, uint32_t vertex);
/* A position of the page in the body's own coordinates. */
void body_coordinates(const trace_body *b, const double page[3], double *along, double *across);
/* The direction in which the body moves at a position, unit; 0, 0 at a centre. */
void body_way(const trace_body *b, double x, double y, double out[2]);

/* --- ways.c: where positions were ----------------------------------------------------------------------------- */

/* --- turns.c: what turns about an axis ------------------------------------------------------------------------ */

/* Is a body one that lies all around the axis that its node turns about? Then sets motion, centre and all of `round`.
 */
bool body_turns(trace_body *b, const trace_bodies *all, const pose *now, const pose *before, double fraction,
                const stroke_camera *camera);
/* A position on a circle about the axis of a round body. */
vec3 body_circle(const trace_body *b, double radius, double angle);

/* --- jumps.c --------------------------------------------------------------------------------------------------- */

/* Which bodies' nodes jump from one place to another between two poses; counts them. Errors: LMN_MEMORY, LMN_FORMAT. */
lmn_status jumps_find(bool *jumping, size_t *count, const trace_bodies *bodies, const traces_options *o,
                      const pose *before, double fraction, lmn_error *error);

/* A position on an edge or on what goes on beyond it: between two vertices; or any position of the world. */
typedef struct trace_origin {
    uint32_t mesh, vertex[2]; /* of the mesh's primitive */
    double   fraction;
    bool     beside; /* it is `at`, on no edge */
    vec3     at;
    uint32_t body, number; /* of the line in its body */
    double   longest;      /* of its way, fraction */
} trace_origin;

/* Ways of all origins: position k of way i is at[i · (steps + 1) + k], at k / steps of the exposure ago. */
typedef struct trace_ways {
    double (*at)[3];
    uint32_t steps;
} trace_ways;
/* Follows origins back, in steps so fine that straight pieces lie within a quarter of a unit of the way. Errors:
 * LMN_MEMORY, LMN_FORMAT. */
lmn_status ways_follow(trace_ways *out, const traces_options *o, const trace_bodies *bodies,
                       const trace_origin *origins, size_t count, lmn_error *error);
void       ways_release(trace_ways *w);
/* The pose so many seconds before another one, not before its clips begin. */
lmn_status pose_before(pose *out, const pose *now, double seconds, lmn_error *error);
/* The pose at a fraction of the exposure ago. */
lmn_status pose_ago(pose *out, const traces_options *o, double fraction, lmn_error *error);

/* --- origins.c: where lines begin --------------------------------------------------------------------------- */

typedef struct origin_list {
    trace_origin *items;
    size_t        count, capacity;
} origin_list;
/* The rearmost positions of a body at heights from one of its extremes to the other, where there are any: their
 * `number` says at which. False: out of memory. */
bool origins_of_heights(origin_list *out, const trace_bodies *bodies, uint32_t body, uint32_t heights);
/* Heights of bodies from which a line would be seen beside all that moves: one after the other for all bodies. */
typedef struct trace_heights {
    bool     *open;
    uint32_t *first; /* per body, and one more */
} trace_heights;
/* Spreads the lines that are wished for over bodies, by how large and fast they are, and over what of them is open.
 * False: out of memory. */
bool origins_find(origin_list *out, const traces_options *o, const trace_bodies *bodies, const trace_heights *heights);

/* --- bones.c, figures.c ------------------------------------------------------------------------------------- */

typedef struct trace_bone {
    uint32_t part;
    int32_t  node; /* that it goes with */
    vec3     from, to;
    double   radius[2]; /* of what is around it at either end, in the world at rest */
} trace_bone;

typedef struct trace_bones {
    trace_bone *items;
    size_t      count;
} trace_bones;

/* The bones of these parts whose nodes match a glob; empty: all. Errors: LMN_MEMORY. */
lmn_status bones_find(trace_bones *out, const pose *now, const bool *parts, const char *wanted, lmn_error *error);
void       bones_release(trace_bones *b);

/* --- speed.c, past.c, shakes.c -------------------------------------------------------------------------------- */

typedef struct trace_job {
    const traces_options *o;
    trace_bodies          bodies;
    bool                 *moves; /* per part */
    page_mask             mask;  /* of all that moves, now */
    trace_bones           bones;
    trace_heights         heights;
    origin_list           origins;
    trace_ways            ways;
    ribbon_set           *out;
    trace_facts          *facts;
    size_t                ribbon_capacity, point_capacity;
} trace_job;

/* In the number of a line, the lower half of its ribbons' ids: it is a flow line. */
#define TRACE_FLOW 0x80000000u
/* Otherwise it is its origin's number, times this, and which of its group it is. */
#define TRACE_GROUPS 8u
lmn_status flow_lines_put(trace_job *j, lmn_error *error);
lmn_status speed_lines_put(trace_job *j, lmn_error *error);
/* How far a position has gone on the page during the exposure, units; NaN: it was behind the viewer. */
double way_length(const trace_ways *w, size_t origin);
/* From which heights lines would be seen. Errors: LMN_MEMORY, LMN_FORMAT. */
lmn_status heights_find(trace_heights *out, trace_job *j, lmn_error *error);
void       heights_release(trace_heights *h);
lmn_status past_contours_put(trace_job *j, lmn_error *error);
lmn_status shakes_put(trace_job *j, lmn_error *error);
/* How what moves stood at a fraction of the exposure ago, from how it stands now: in the world. Of what moves by its
 * joints nothing is known, and it is the identity. Errors: LMN_MEMORY, LMN_FORMAT. */
lmn_status body_moved_since(mat4 *out, const trace_job *j, const trace_body *b, double fraction, lmn_error *error);
/* What is drawn of bones in a pose, as lines. Errors: LMN_MEMORY. */
lmn_status figures_find(stroke_set *out, const trace_job *j, const pose *then, lmn_error *error);
/* The outline of all that is covered during the exposure, line by line. */
typedef bool (*past_line_fn)(void *user, const double (*points)[3], size_t count);
lmn_status swept_put(trace_job *j, past_line_fn put, void *user, lmn_error *error);
bool       put_ribbon(trace_job *j, stroke_class kind, uint32_t part, uint64_t id, const ribbon_point *points,
                      size_t count); /* false: out of memory */
/* Is a position on the page, with its depth, before all that is there now, and not cut away with its part? */
bool nothing_hides(const traces_options *o, uint32_t part, const double page[3]);
/* Is it cut away? */
bool is_cut_away(const traces_options *o, uint32_t part, const double page[3]);
/* 0 … 1, the same for the same numbers. */
double trace_random(const traces_options *o, uint32_t body, uint32_t line, uint32_t what);

/* --- measures.c ------------------------------------------------------------------------------------------------ */
lmn_status measures_take(trace_job *j, lmn_error *error);

#endif
