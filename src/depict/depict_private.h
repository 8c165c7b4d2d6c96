/* What the rooms of glyphs share. */
#ifndef LIMNER_DEPICT_DEPICT_PRIVATE_H
#define LIMNER_DEPICT_DEPICT_PRIVATE_H

#include "base/vector3.h"
#include "contact/contact.h"
#include "depict/depict.h"
#include "depict/way.h"
#include "plan/camera.h"

/* --- the job: glyphs of one scene for one viewer ------------------------------------------------------------- */

typedef enum glyph_tense { GLYPH_PAST, GLYPH_PRESENT, GLYPH_FUTURE } glyph_tense;
struct glyph;

enum { DEPICT_POSES = 64 };
/* Zero-initialise. */
typedef struct depict_poses {
    pose   at[DEPICT_POSES];
    size_t count, next; /* who goes next when there are more */
    mat4  *worlds;      /* of all nodes at rest; NULL: nobody has asked */
} depict_poses;

typedef struct depict_job {
    const lmn_scene       *scene; /* without glyphs */
    moment                 when;
    view_camera            camera;
    bool                   fixed_view; /* it does not step back for signs */
    bool                   drafts;     /* signs are made to find the view alone: turns need not be rounded */
    double                 size;       /* of the scene: the diagonal of its box */
    box3                   box;        /* of all that it has, wherever it goes */
    uint32_t               seed;
    warnings              *warnings;
    depict_poses          *poses;       /* kept; lent */
    letterings            *letterings;  /* kept with the scene; lent */
    const expression_list *expressions; /* all that are told; lent, NULL: none */
    struct glyph          *glyphs;      /* made so far; owned */
    size_t                 glyph_count, glyph_capacity;
    char                   nothing[200]; /* why the expression that is told now has no sign; empty: nobody says */
} depict_job;

/* Direction from a position to the viewer, unit. */
void depict_to_eye(const depict_job *j, const double at[3], double out[3]);
/* 0 … 1, the same for the same numbers. */
double depict_random(const depict_job *j, const expression *e, uint32_t which, uint32_t what);
/* The page's axes, unit. */
void depict_page_axes(const depict_job *j, double right[3], double up[3]);
/* A position moved towards the viewer: the same place on the page, before all that is nearer than `distance`. */
void depict_lift(const depict_job *j, double at[3], double distance);
/* Says why the expression that is told has no sign. */
void depict_say_nothing(depict_job *j, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* How far a position is to be moved so that it is before all that the scene has, wherever that goes. */
double depict_front(const depict_job *j, const double at[3]);

/* --- poses.c: the scene at moments, without glyphs --------------------------------------------------------------- */

/* Lent until the next call. Errors: as of pose_create. */
lmn_status depict_pose(const pose **out, const depict_job *j, double seconds, lmn_error *error);
/* Lent; NULL: out of memory. */
const mat4 *depict_worlds_at_rest(const depict_job *j);
void        depict_poses_release(depict_poses *kept);

/* --- target.c: what is told of -------------------------------------------------------------------------------- */

/* Its parts are those at its node and below. */
typedef struct depict_target {
    int32_t node;                    /* that was named */
    way     way;                     /* of the node, or of what carries a skin: its hip */
    double  centre[3];               /* in the way's axes */
    double  radius;                  /* of its box, world, at rest */
    double  reach;                   /* half of that box's longest side */
    double  outermost[BOX_SIDES][3]; /* in the middles of that box's sides; in the way's axes */
    bool   *parts;                   /* per part of the scene */
    size_t  part_count;
} depict_target;
lmn_status target_open(depict_target *out, const depict_job *j, int32_t node, lmn_error *error);
void       target_release(depict_target *t);
/* Its place is that which is farthest from its node's origin, as the end of a limb, instead of its middle. Errors:
 * LMN_MEMORY. */
lmn_status target_take_tip(depict_target *t, const depict_job *j, lmn_error *error);
/* A flag a node: does one of the clips move it by itself? NULL: out of memory. */
bool *depict_moved_nodes(const lmn_scene *scene, const moment *when);

/* All vertices of its parts in the world at a time; mem_free. NULL: out of memory, or *count is 0. */
lmn_status target_vertices(vec3 **out, size_t *count, const depict_job *j, const depict_target *t, double seconds,
                           lmn_error *error);

/* When something's velocity changes at once within an interval, most of all: impacts. */
typedef struct depict_impact {
    double time, at[3];  /* of the centre */
    double change[3];    /* of velocity, units a second */
    double before[3];    /* its velocity before it */
    double speed;        /* of that */
    double since, until; /* how long it has gone straight before, and does behind */
    bool   turns;        /* all that is of another place than the centre, since it turns on the spot */
} depict_impact;
/* Those of a target, in order, at most `most`. *count gets how many. Errors: LMN_MEMORY. */
lmn_status target_impacts(depict_impact *out, size_t most, size_t *count, const depict_target *t, double from,
                          double to, lmn_error *error);
/* The same where it may hit something: of what turns on the spot they are those of the place that goes farthest. */
lmn_status target_hits(depict_impact *out, size_t most, size_t *count, const depict_target *t, double from, double to,
                       lmn_error *error);
/* Where it touches what it meets: the vertex that is farthest against the change of velocity. */
lmn_status impact_contact(double out[3], const depict_job *j, const depict_target *t, const depict_impact *i,
                          lmn_error *error);

/* --- build.c: glyphs as meshes ------------------------------------------------------------------- */

typedef struct glyph_mesh {
    vec3     *positions;
    uint32_t *indices; /* 3 a triangle */
    uint32_t *lines;   /* 2 a line; a mesh has triangles or lines */
    size_t    position_count, position_capacity, index_count, index_capacity, line_count, line_capacity;
    bool      failed; /* out of memory: all later calls do nothing */
} glyph_mesh;

uint32_t glyph_vertex(glyph_mesh *m, const double at[3]);
void     glyph_triangle(glyph_mesh *m, uint32_t a, uint32_t b, uint32_t c);
void     glyph_line(glyph_mesh *m, uint32_t a, uint32_t b);
void     glyph_mesh_release(glyph_mesh *m);

/* How a glyph can be selected, and its colour (sRGB, straight alpha). */
typedef struct glyph_label {
    const char *glyph; /* "arrow" */
    int32_t     of;    /* node */
    glyph_tense when;
    colour      tint;
    bool        sketchy; /* to be drawn loosely */
    bool        overlay; /* the picture is not fitted to it */
    uint32_t image; /* which image of things it is a piece of, so that its pieces run through each other; 0: of none */
    colour   own;   /* its colour there */
    int      pale;  /* how much paler than other things looks draw it that do not speak of signs, eighths */
} glyph_label;

typedef struct glyph {
    glyph_mesh  mesh;
    glyph_label label;
    mat4        world; /* from the mesh to the world */
    uint64_t    shape; /* not 0: meshes of the same number are the same */
} glyph;

/* --- put.c: glyphs as content of the scene ------------------------------------------------------------------- */

/* Puts a mesh among the job's glyphs, which take over what it holds; nothing of an empty one. Errors: LMN_MEMORY. */
lmn_status glyph_put(depict_job *j, glyph_mesh *m, const glyph_label *label, lmn_error *error);
/* The same of a mesh that lies elsewhere and is, but for its place, that of other glyphs with this shape (not 0). */
lmn_status glyph_put_placed(depict_job *j, glyph_mesh *m, const mat4 *world, uint64_t shape, const glyph_label *label,
                            lmn_error *error);
void       glyphs_release(depict_job *j);
/* A vertex in the world. */
vec3 glyph_position(const glyph *g, size_t vertex);
/* All of the job's glyphs below a node of the scene. Errors: LMN_MEMORY, LMN_LIMIT, LMN_FORMAT. */
lmn_status glyphs_into_scene(lmn_scene *scene, depict_job *j, int32_t root, lmn_error *error);

/* --- build.c: flat things that face the viewer ---------------------------------------------------------------- */

/* A line with breadth that faces the viewer, through points in the world. */
typedef struct glyph_ribbon {
    const double (*points)[3];
    const double *widths; /* per point */
    size_t        count;
} glyph_ribbon;
void glyph_put_ribbon(glyph_mesh *m, const depict_job *j, const glyph_ribbon *r);

/* --- arrow.c ------------------------------------------------------------------------------------------------------ */

typedef struct arrow_style {
    double width;     /* units */
    double dash, gap; /* units along it; 0: solid */
    double tail;      /* width where it begins, fraction */
    double head;      /* its length in widths; 0: none */
    double short_of;  /* units that it ends before the last point */
} arrow_style;
/* An arrow through points in the world. */
void glyph_put_arrow(glyph_mesh *m, const depict_job *j, const double (*points)[3], size_t count,
                     const arrow_style *style);

/* Moves a way before all that the scene has, on its lines of sight. Returns how much smaller things have to be there to
 * be seen as large. */
double glyph_lift_before(const depict_job *j, double (*points)[3], size_t count);

/* The colours of tenses where nobody says another. */
colour depict_tint(glyph_tense when, colour wanted);

#endif
