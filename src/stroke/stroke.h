/* Strokes: lines with geometry. From a scene and a camera to chains of points on the page, each stretch with the number
 * of surfaces in front of it. Needs no GPU. Freudenberg 2003, chapter 7.
 *
 *   stroke_scene: edges of all parts, once a scene ──► stroke_view: what a camera sees of it ──► stroke_set: the lines
 * that were asked for
 *
 * The page has its origin at the top left, x to the right, y down, in units of 1/96 inch of paper, whatever pixels a
 * picture of it has: so pictures of all sizes, and vectors, have the same lines. What lies outside it is cut off. */
#ifndef LIMNER_STROKE_STROKE_H
#define LIMNER_STROKE_STROKE_H

#include "base/paper.h"
#include "limner/error.h"
#include "pose/pose.h"
#include "scene/scene.h"
#include "stroke/edges.h"

/* What a line is, most important first. A line that is several of these is the first of them. */
typedef enum stroke_class {
    STROKE_CONTOUR, /* where a surface turns away from the eye */
    STROKE_BORDER,  /* where a surface ends */
    STROKE_CREASE,
    STROKE_INTERSECTION, /* where two surfaces run through each other */
    STROKE_MATERIAL,
    STROKE_DRAWN,      /* that the file brings */
    STROKE_SUGGESTIVE, /* where a contour would appear if the eye moved a little */
    STROKE_RIDGE,
    STROKE_VALLEY,
    STROKE_APPARENT, /* apparent ridge: where what is seen bends most */
    STROKE_SPEED,    /* behind what moves, along the way that it came (src/trace) */
    STROKE_PAST,     /* a contour where something has been */
    STROKE_CLASS_COUNT
} stroke_class;
/* "contour", "border" …: names in files, reports and looks. */
const char *stroke_class_name(stroke_class c);

typedef struct stroke_point {
    float x, y;
    float depth;    /* eye depth, file units */
    float arc;      /* length along the whole chain up to here, units */
    float weight;   /* 0 … 1: how sure the line is; 1 but where kinds of lines fade */
    float aside[2]; /* how far it lies off the line of the mesh that it stands for, where curves stand for lines: what
                       hides the one there hides the other here */
    uint32_t fine, fine_count; /* of the set's fine points: between this one and the next one of its stroke */
} stroke_point;

/* Where a line runs between two points more exactly than they say. Nothing is decided by it. */
typedef struct stroke_fine {
    float x, y, depth;
    float along; /* arc from the point that it is of */
} stroke_fine;

/* A stretch of a chain with one number of surfaces in front of it. Strokes of a chain follow each other, in order;
 * where chains were linked over a gap, arcs count it. */
typedef struct stroke {
    stroke_class kind;
    uint32_t     part;      /* id */
    uint32_t     piece;     /* of surface that it lies on, of all pieces in the view */
    uint32_t     hidden_by; /* surfaces in front, of closed bodies those that face the eye; 0: visible */
    uint32_t     chain;     /* number of the chain, from 0 */
    uint64_t     id;        /* of the chain: the same as long as its most lasting edge is in it, from frame to frame */
    uint32_t     first, count; /* points; neighbours in a chain both have the point between them */
    bool         closed;       /* the whole chain is this stroke and ends where it began, the first point once more */
    float        phase; /* arc to add so that what repeats along the chain stays where it was; see stroke_follow */
    float        chain_length; /* units */
    float        lift;         /* so far it may lie off a surface that it is on, file units: lines that files bring */
    float        size;         /* of the piece on the page, units, its longer side; 0: not asked for */
    bool smooth; /* an outline by normals: it lies beside the mesh's own, whose fold does not count as being in front of
                    it */
} stroke;

/* Where on a chain one of its lasting edges begins: what a chain of the next frame is recognised by. */
typedef struct stroke_mark {
    uint64_t id;
    uint32_t chain;
    float    arc;
} stroke_mark;

/* What finding the outlines of refined meshes took: faces of all levels, and those that were asked which way they look.
 */
typedef struct outline_search {
    uint64_t faces, tested;
} outline_search;

typedef struct stroke_set {
    stroke        *strokes;
    stroke_point  *points;
    stroke_mark   *marks; /* in the order of the chains */
    stroke_fine   *fine;  /* with stroke_options.fine */
    size_t         stroke_count, point_count, chain_count, mark_count, fine_count;
    bool           perspective;   /* between two points it is 1 / depth that is linear on the page, not depth */
    outline_search search;        /* over all meshes that were refined */
    uint64_t       pairs;         /* of lines and triangles that were compared: what the work was */
    uint64_t       entries;       /* of cells, likewise, whether they meet the line or not */
    uint64_t       ends_compared; /* pairs of ends of lines, likewise */
    uint64_t       lines;         /* whose visibility was asked for, likewise */
} stroke_set;
void stroke_set_release(stroke_set *s);

/* --- the scene ------------------------------------------------------------------------------------------ */

/* One part at one position. */
typedef struct stroke_item {
    uint32_t part_index; /* id − 1 */
    uint32_t mesh;       /* in the scene's edge meshes */
    mat4     world;
    bool     is_sign; /* no body of the scene: it runs through none, though it is where one is */
    uint32_t image;   /* of a sign: whose pieces it runs through; 0: through none */
    double   reach;   /* the largest coordinate of its mesh as large as it is drawn, which says how exact positions are:
                         where a node puts it is exact */
} stroke_item;

typedef struct crossing_list crossing_list;

typedef struct stroke_scene {
    struct form_surface *surfaces;  /* per mesh, how it bends; NULL: not asked for yet */
    crossing_list       *crossings; /* where pieces run through each other; NULL: not asked for yet */
    edge_mesh           *meshes;
    size_t               mesh_count;
    stroke_item         *items;
    size_t               item_count;
    size_t               open_parts;    /* some of whose sections do not close */
    uint32_t             open_operands; /* of solids, that are no closed meshes: what they enclose is not certain */
    double               extent, reach; /* diagonal of all; the largest reach of an item */
} stroke_scene;

/* Takes the parts with `parts[index]` (NULL: all) as they are posed; of solids what bounds them (stroke/solid.h).
 * Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status stroke_scene_create(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                               lmn_progress_fn progress, void *user, lmn_error *error);
/* The same with all meshes refined `refine` times (0 … 3; each makes four triangles of one): what hides is as round
 * as the lines are. Takes stroke_options.refine. Also LMN_LIMIT. */
lmn_status stroke_scene_create_refined(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                                       int32_t refine, lmn_progress_fn progress, void *user, lmn_error *error);
/* What is cut away: neither lines nor what hides them. Cut faces close what is left, and are of a material of their
 * own. */
typedef struct stroke_section {
    const struct cut *cut;
    const bool       *spared; /* per part: stays whole; NULL: none */
} stroke_section;
lmn_status stroke_scene_create_cut(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                                   int32_t refine, const stroke_section *section, lmn_progress_fn progress, void *user,
                                   lmn_error *error);
/* The same again and again, with a section (may be NULL), for poses of one scene: what these have in common is kept in
 * `kept`, which belongs to the caller. It is zero-initialised at first, and ended with stroke_topologies_release. */
typedef struct stroke_topologies {
    struct edge_topology **meshes; /* per mesh of the scene; NULL: not asked for yet */
    size_t                 count;
} stroke_topologies;
lmn_status stroke_scene_create_keeping(stroke_scene *out, const pose *pose, const bool *parts, double crease_angle,
                                       int32_t refine, stroke_topologies *kept, const stroke_section *section,
                                       lmn_error *error);
void       stroke_topologies_release(stroke_topologies *t);
void       stroke_scene_release(stroke_scene *s);
/* Makes the smooth surfaces that dense samplings stand for, unless they are there: views need them, and
 * stroke_scene_create_keeping leaves them out, as not all who draw edges have views. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status stroke_scene_calm(stroke_scene *s, lmn_error *error);
/* Finds out where pieces run through each other and keeps it, for scenes that are drawn more than once; else
 * stroke_find does it each time. Of these parts (a flag each; NULL: all) alone, and what they run through. Errors:
 * LMN_MEMORY, LMN_CANCELLED. */
lmn_status stroke_scene_cross(stroke_scene *s, const bool *parts, size_t part_count, lmn_progress_fn progress,
                              void *user, lmn_error *error);
/* Is that there already? */
bool stroke_scene_has_crossings(const stroke_scene *s, const bool *parts, size_t part_count);
/* Finds out how surfaces bend and keeps it, for scenes of which more than one view has smooth outlines or lines of
 * form; else stroke_find does it each time. Errors: LMN_MEMORY, LMN_LIMIT, LMN_CANCELLED. */
lmn_status stroke_scene_bend(stroke_scene *s, lmn_progress_fn progress, void *user, lmn_error *error);
/* What was found: straight lines, world axes, with the item of the first of both surfaces. None before
 * stroke_scene_cross. `outward`: unit normals of both, away from what they enclose; 0, 0, 0 where they enclose
 * nothing. */
size_t   stroke_scene_crossing_count(const stroke_scene *s);
uint32_t stroke_scene_crossing(const stroke_scene *s, size_t index, double ends[2][3], vec3 outward[2]);
/* The indices of those of an item, ascending; lent. */
const size_t *stroke_scene_crossings_of(const stroke_scene *s, uint32_t item, size_t *count);

/* --- the view ------------------------------------------------------------------------------------------- */

/* For numbers of taste that are said in mm. */
#define PAPER_UNITS_PER_MM (PX_PER_INCH / MM_PER_INCH)

typedef struct stroke_camera {
    mat4   view, projection; /* GL's; near and far do not matter, but what is nearer than the near plane is cut off */
    double near;             /* eye depth, above 0 in perspective */
    bool   orthographic;
    int    width, height; /* of the page, units */
} stroke_camera;

typedef struct stroke_view stroke_view;
/* Projects the scene, which is borrowed until the view is destroyed. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status stroke_view_create(stroke_view **out, const stroke_scene *scene, const stroke_camera *camera,
                              lmn_progress_fn progress, void *user, lmn_error *error);
void       stroke_view_destroy(stroke_view **v);

/* How many surfaces lie in front of each of these positions (world axes), of closed bodies those that face the eye,
 * UINT32_MAX for those outside the page. What a position lies on does not count. Any thread. */
void stroke_view_count(const stroke_view *v, const double (*positions)[3], size_t count, uint32_t *out);

typedef enum contour_kind {
    CONTOURS_NONE,
    CONTOURS_EDGES, /* edges of the mesh between front and back: exactly the outline of what is there. Of scans and
                       other dense samplings, that of the surface that is sampled, without its noise. */
    CONTOURS_SMOOTH /* where the interpolated normal is at right angles to the view: the outline of the surface that is
                       meant */
} contour_kind;

/* Which lines are wanted. */
typedef struct stroke_options {
    int32_t contours; /* contour_kind */
    bool    creases, borders, materials, intersections;
    bool    drawn;                                 /* lines that files bring */
    float   suggestive, ridges, valleys, apparent; /* 0: none; 1: the strongest only … 0.01: nearly all */
    bool    hidden;                                /* stretches behind surfaces too */
    float   simplify;                              /* by how much points may be moved, units */
    float   fine;                                  /* the same of points between those; 0: there are none */
    float   shortest;                              /* whole chains shorter than this are left out, units */
    float   width;  /* that lines are drawn with, units: what is thinner in front of a chain does not end it */
    float   crowd;  /* strokes that run all their length this close to more important ones are left out, units */
    float   detail; /* 1: all lines; less: what says least goes where lines crowd, whole chains, down to 0 */
    int32_t refine; /* 0 … 3: how often surfaces are refined, by whoever makes the scene: stroke_scene_create_refined */
    int32_t curve; /* 0 … 4: how often chains of contours are refined as curves */
    /* With hidden, where there are thousands of pieces of surface smaller than `island` on the page: those of which
     * nothing is seen have no lines, and those of which less than `figure` is hidden only visible ones; units. */
    float island, figure;
    float round; /* with curve 0: by how much lines that stand for curves may leave the mesh, units; 0: not at all */
} stroke_options;
#define STROKE_OPTIONS_INIT                                                                                            \
    {                                                                                                                  \
        CONTOURS_EDGES, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0.1f, 0, 1.0f, 2.0f, 0.75f, 1.0f, 0, 0, 0, 0, 0                  \
    }

/* Do they ask for lines that depend on how surfaces bend? Then stroke_scene_bend pays where there is more than one
 * view. */
bool stroke_options_bend(const stroke_options *w);
/* Do they ask for lines of form, which solids have none of? Outlines of solids are always those of their edges. */
bool stroke_options_form(const stroke_options *w);

/* Finds the lines of the parts with `parts[index]` (NULL: all of the scene); all of the scene's parts may hide
 * them. Same call, same strokes, whatever the number of threads. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status stroke_find(stroke_set *out, const stroke_view *v, const stroke_options *options, const bool *parts,
                       lmn_progress_fn progress, void *user, lmn_error *error);

/* What `stroke_verify` found. */
typedef struct stroke_check {
    uint64_t samples;
    uint64_t wrong;      /* visible where it should be hidden, or the other way round */
    uint64_t miscounted; /* the same or a wrong number of surfaces in front */
} stroke_check;
/* Samples strokes every `apart` pixels and counts surfaces in front by casting rays at the triangles themselves,
 * with other arithmetic. A sample is wrong when no position within half a pixel is as the stroke says. Smooth outlines
 * are left out: the triangles that they stand for cover them. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status stroke_verify(stroke_check *out, const stroke_set *set, const stroke_view *v, float apart,
                         lmn_progress_fn progress, void *user, lmn_error *error);

/* Gives strokes of a new frame the phases of those of the frame before: chains that share an edge keep what repeats
 * along them where it was on the model; where chains split, each part goes on, and where they merge, the longest
 * one hands over. Without memory left everything stays as it is. After Kalnins and others 2003 (coherent stylized
 * silhouettes), in the simplest form: one offset a chain. */
void stroke_follow(stroke_set *now, const stroke_set *before);

#endif
