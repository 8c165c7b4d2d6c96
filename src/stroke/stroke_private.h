/* What the files of this room share: what a camera sees of a scene, made ready for asking what lies in front of what.
 *
 * In *window space* x and y are whole numbers, small fractions of a unit of paper measured from the middle of the page,
 * so that on which side of a line a point lies is worked out without rounding: products of differences stay below 2^53.
 * z grows with the distance from the eye: the eye depth d in parallel projection, −1/d in perspective. Both make lines
 * and planes of the scene lines and planes of the window. */
#ifndef LIMNER_STROKE_STROKE_PRIVATE_H
#define LIMNER_STROKE_STROKE_PRIVATE_H

#include "stroke/stroke.h"
#include "stroke/wheels.h"

#define NO_VERTEX   UINT32_MAX
#define NO_TRIANGLE UINT32_MAX
/* Window coordinates stay within this. */
#define WINDOW_LIMIT 16777216.0
/* What two positions may differ by and still be one, fraction of the largest coordinate: a few roundings of single
 * precision. */
#define SAME_POSITION 1e-6

typedef struct window_point {
    int32_t x, y;
    double  z;
} window_point;

typedef struct double3 {
    double x, y, z;
} double3;

static inline double3 double3_minus(double3 a, double3 b)
{
    return (double3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double3 double3_cross(double3 a, double3 b)
{
    return (double3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double double3_dot(double3 a, double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* A triangle in the window. */
typedef struct window_triangle {
    uint32_t v[3]; /* in the view's points */
    uint32_t face; /* that it is (a part of) */
} window_triangle;

/* Where it lies, for a first look. */
typedef struct window_box {
    int32_t low_x, low_y, high_x, high_y;
    float   near_z; /* or a little less */
    float   slope;  /* by how much z changes at most over one unit: positions are rounded to units */
    float   far_z;  /* what begins here or farther away is behind all of it, by more than what positions are off by;
                       INFINITY: of a solid */
    float inner_z;  /* the same of one inside of a surface; INFINITY: of a rim */
} window_box;

/* A grid of cells. */
typedef struct grid_level {
    int32_t   low_x, low_y;        /* its corner, window units */
    double    cells;               /* in a window unit: 1 / cell */
    int32_t   cell, columns, rows; /* side of a cell, window units */
    uint32_t *starts;              /* per cell, and one more, in the grid's entries */
    uint32_t *subs;      /* per cell: 1 + the finer grid that crowded ones have, 0: none; NULL: no cell has one */
    float     copies;    /* of finer grids: how often a triangle is entered in them, with all above, on average */
    bool      divisible; /* their cells may have some, too */
} grid_level;

/* Grids of several sizes. Each triangle lies in one of the levels, in all cells that it touches there; crowded
 * cells have a finer grid in them. */
enum { GRID_LEVELS = 10, GRID_SPAN = 16, GRID_LANES = 16 };
/* The corners of the triangles of cells, in the cells' order: those that are looked at together lie together. As single
 * precision, which window coordinates fit in. */
typedef struct grid_corners {
    float *x[3], *y[3], *near_z; /* per entry of the grid, behind them those of the finer ones; GRID_LANES more may be
                                    read; near_z: as boxes have it */
    float *inner_z;              /* likewise */
    float *turn;                 /* 1, or −1 where they run the other way round; 0: they lie in a line */
    float *memory;
} grid_corners;

typedef struct window_grid {
    grid_level  levels[GRID_LEVELS];
    grid_level *subs; /* their starts and subs are parts of sub_starts and sub_links */
    uint32_t   *sub_starts, *sub_links;
    uint32_t   *entries, *sub_entries; /* triangles */
    size_t      entry_count;
    size_t      sub_count, sub_capacity, sub_start_count, sub_start_capacity, sub_link_capacity, sub_entry_count,
        sub_entry_capacity;
    window_wheels wheels;
} window_grid;

typedef struct view_item {
    uint32_t first_point, first_face, first_piece, first_plane; /* numbers that the item's own begin at */
} view_item;

struct stroke_view {
    const stroke_scene *scene;
    stroke_camera       camera; /* the same on paper; see paper.c */
    mat4                whole;  /* world to clip space */
    double              units;  /* window units in a unit of paper */
    double              same;   /* SAME_POSITION in file units, of the item that reaches farthest */
    float              *sames;  /* per piece: its item's; NULL: they are alike */
    view_item          *items;
    window_point       *points; /* of all items' vertices; behind them those of clipped faces */
    size_t              point_count, point_capacity;
    uint8_t            *outside; /* per vertex of an item: which planes it is outside of */
    uint8_t            *fronts;  /* per face of all items, one bit: seen from the front */
    window_triangle    *triangles;
    size_t              triangle_count, triangle_capacity;
    window_box         *boxes; /* per triangle */
    uint32_t (*beyond)[3];     /* likewise: the triangle beyond the edge that begins at each corner, where the surface
                                  goes on and is seen from the same side; NO_TRIANGLE: none */
    window_grid grid;
    uint32_t    face_count, piece_count, vertex_count;
    uint32_t   *face_pieces; /* per face: of all pieces in the view */
    uint32_t   *planes;      /* per face: the plane in which it lies with others, from 1 on; NULL: not known */
    uint32_t   *solids;      /* per piece: 1 + the item of which it is, where that is a solid; NULL: there are none */
    bool       *around;      /* per item: a solid that reaches up to the eye, which may be in it */
};

/* A straight line whose visibility is asked for. */
typedef struct window_segment {
    window_point    a, b;
    uint32_t        ends[2];  /* points of the view that a and b are; NO_VERTEX: neither */
    uint32_t        faces[2]; /* that it lies on; EDGE_NO_FACE: none */
    const uint32_t *ignored;  /* faces that do not count, ascending */
    uint32_t        ignored_count;
    uint32_t        least;  /* as many surfaces lie in front at least */
    float           lift;   /* what lies no farther in front, at right angles, does not count: file units */
    const uint32_t *beside; /* pieces that change places with its own, ascending: they have a lift of their own */
    uint32_t        beside_count;
} window_segment;

/* From `from` on (fraction of the segment) this many surfaces lie in front. */
typedef struct visibility_span {
    float    from;
    uint32_t count;
} visibility_span;

/* --- scene.c --- */
double mat4_growth(const mat4 *m); /* by how much it may lengthen things */
double box_farthest(box3 box);     /* its largest coordinate */

/* --- project.c --- */
/* Eye space and back: a position of the world in the window, and whether it can be seen (not nearer than the near
 * plane, not far outside). */
bool view_position(const stroke_view *v, double3 world, window_point *out);
/* Cuts a line of the world to what lies in the window; false when nothing does. `cut`: the shares that are left. */
bool view_clip_line(const stroke_view *v, double3 a, double3 b, double cut[2]);
/* Is a triangle of the world seen from the front? Its corners run anticlockwise then. */
bool    view_shows_front(const stroke_view *v, double3 a, double3 b, double3 c);
double3 item_position(const stroke_item *item, vec3 p);
double  view_depth(const stroke_view *v, double z);                  /* eye depth */
double  view_tolerance(const stroke_view *v, double same, double z); /* of z */
/* Which side of each piece's faces is never seen: 1 the back, 2 the front, 0 none. Of a closed body with the eye
 * outside, what faces away lies behind what faces the eye, so that it need not be counted. Free with mem_free; NULL
 * when memory is gone. */
uint8_t           *view_unseen(const stroke_view *v, size_t item);
static inline bool view_is_front(const stroke_view *v, uint32_t face)
{
    return v->fronts[face >> 3] >> (face & 7) & 1;
}

/* Twice the area of a triangle in the window, above 0 anticlockwise with y down … exactly. */
static inline double window_side(window_point a, window_point b, window_point c)
{
    return ((double)b.x - a.x) * ((double)c.y - a.y) - ((double)b.y - a.y) * ((double)c.x - a.x);
}

/* 1 + the item of a face of a solid, 0: the face is a mesh's, and each face is a surface. */
static inline uint32_t view_solid(const stroke_view *v, uint32_t face)
{
    return v->solids ? v->solids[v->face_pieces[face]] : 0;
}

/* --- inner.c --- */
/* Finds what lies beyond the edges of triangles. False when memory is gone. */
bool inner_find(stroke_view *v);

/* --- grid.c --- */
lmn_status grid_build(window_grid *out, const stroke_view *v, lmn_error *error);
void       grid_release(window_grid *g);
/* Puts the corners of a view's triangles together, which pays where many segments are asked for. False when memory is
 * gone. */
bool grid_corners_make(grid_corners *out, const stroke_view *v);
void grid_corners_release(grid_corners *c);
/* The runs of entries of the cells of a level that a segment touches: calls `visit` for each run. `corner`: where its
 * corners begin. `alone`: it is the only one of the level. */
typedef void (*grid_visit)(void *user, const uint32_t *entries, size_t corner, size_t count, bool alone);
/* Runs with more entries are sorted by the planes of the view, where it has any. */
enum { GRID_CROWD = 64 };
void grid_walk(const window_grid *g, window_point a, window_point b, grid_visit visit, void *user);

/* --- visibility.c --- */
/* What covers segments: `spans` of segment i are spans[starts[i]] … spans[starts[i + 1] − 1], the first from 0 on. */
typedef struct visibility {
    visibility_span *spans;
    uint32_t        *starts;
    uint64_t         pairs, entries; /* that were compared; of cells that were looked at */
} visibility;
lmn_status visibility_find(visibility *out, const stroke_view *v, const window_segment *segments, size_t count,
                           lmn_progress_fn progress, void *user, lmn_error *error);
void       visibility_release(visibility *out);

/* --- hierarchy.c: boxes around boxes --- */
enum { KIN_WAYS = 3 };
typedef struct hierarchy_node {
    box3     box;
    uint32_t first, count;  /* leaf: members; else count 0, and `first` is the left child, the right one behind it */
    uint32_t kin[KIN_WAYS]; /* what all its members are of; KIN_MIXED: of several */
    double   size;          /* diagonal of the box */
} hierarchy_node;
#define KIN_MIXED UINT32_MAX

/* What each member is of, in some ways: those that are of one in any are no pair. NULL: all differ; KIN_MIXED: it is of
 * none. */
typedef struct hierarchy_kin {
    const uint32_t *of[KIN_WAYS];
} hierarchy_kin;

typedef struct hierarchy {
    hierarchy_node *nodes;
    uint32_t       *members;
    uint32_t        node_count, member_count;
} hierarchy;
/* Sorts boxes into a tree with a few of them a leaf. */
lmn_status hierarchy_build(hierarchy *out, const box3 *boxes, hierarchy_kin kin, uint32_t count, lmn_error *error);
void       hierarchy_release(hierarchy *h);

/* Calls `pair` for all pairs of members that are no kin and whose boxes overlap, each once; false from it ends the
 * search. */
typedef bool (*hierarchy_pair)(void *user, uint32_t a, uint32_t b);
bool hierarchy_pairs(const hierarchy *h, const box3 *boxes, hierarchy_kin kin, hierarchy_pair pair, void *user);

/* --- intersections.c --- */
/* A straight line in which two faces of different pieces cross. */
typedef struct face_crossing {
    double3  ends[2];
    uint32_t items[2], faces[2]; /* faces: of the items' meshes */
    uint32_t pieces[2];          /* of all in the scene */
    bool     one_surface;        /* the faces are nearly one */
} face_crossing;
struct crossing_list {
    face_crossing *crossings;
    size_t         count, capacity;
    uint32_t (*beside)[2]; /* pieces, of all in the scene, that nearly coincide, so that one is in front here and the
                              other one there; each pair both ways, ascending */
    size_t   beside_count, beside_capacity;
    size_t  *first, *order; /* per item, and one more: its first one in `order`, which has their indices */
    bool    *parts;         /* that were asked for, a flag each; NULL: all */
    size_t   part_count;
    uint64_t compared; /* pairs of faces that were: what the work was */
};
void crossings_release(crossing_list *c);
/* So far pieces that nearly coincide may lie in front of each other: fraction of the scene's diagonal. */
#define BESIDE_LIFT 1.5e-3
/* All that one of these parts (a flag each; NULL: all) has, in an order that depends on the scene alone; but for those
 * that hidden pieces (a flag each, of all in the scene; NULL: none) have with each other. */
lmn_status crossings_find(crossing_list *out, const stroke_scene *scene, const bool *parts, const uint8_t *hidden,
                          lmn_progress_fn progress, void *user, lmn_error *error);

/* --- lines.c --- */
/* Line edges of one view, before they are chained. */
typedef struct view_line {
    stroke_class kind;
    uint32_t     item;
    uint32_t     ends[2]; /* of view points, or numbers from vertex_count on that only lines have */
    uint64_t     id;
    float        weights[2]; /* at its ends */
    bool         sharp;      /* runs along a sharp edge */
    bool         turned;     /* outlines: what is seen from the front lies to its other side */
} view_line;

/* Outlines of samplings are looked for a little outside of the surface, where its noise does not reach. */
typedef struct view_lift {
    uint32_t     line;
    window_point a, b;    /* where it is looked for */
    double3      ends[2]; /* the same in the world */
    double       edge;    /* mean edge of the mesh there */
} view_lift;

typedef struct view_lines {
    view_line      *lines;
    window_segment *segments; /* one a line */
    size_t          count, capacity, segment_capacity;
    view_lift      *lifts; /* of lines in ascending order */
    size_t          lift_count, lift_capacity;
    uint32_t        end_count; /* numbers that ends have: 0 … end_count − 1 */
    uint32_t       *ignored;   /* what the segments' lists of faces are parts of */
    uint32_t       *beside;    /* … and those of pieces */
    uint8_t        *bare;      /* pieces of whose lines only what is seen is wanted, a flag each; NULL: none */
    outline_search  search;
} view_lines;
/* --- beside.c --- */
/* Leaves out crossings of pieces that nearly coincide, by what most of the length of those that hang together is, and
 * keeps which pieces these are. False when memory is gone. */
bool crossings_settle(crossing_list *list);
/* Says which pieces change places with those that segments are of. False when memory is gone. */
bool beside_link(view_lines *out, const stroke_view *v, const crossing_list *crossings);
/* `hidden`: pieces whose own lines are not wanted, a flag each; NULL: none. */
lmn_status lines_collect(view_lines *out, const stroke_view *v, const stroke_options *options, const bool *parts,
                         const uint8_t *hidden, lmn_progress_fn progress, void *user, lmn_error *error);
void       lines_release(view_lines *l);
/* Adds a line of the world, as far as it lies in the window; ends that are cut off get numbers of their own. False
 * when memory is gone. */
bool lines_put(view_lines *out, const stroke_view *v, view_line line, double3 a, double3 b, const uint32_t faces[2]);
uint64_t line_id(uint64_t a, uint64_t b); /* numbers that differ for different lines and stay from view to view */

/* --- occlusion.c --- */
/* Flags pieces of the view that lie wholly behind others, beyond doubt, and are smaller than stroke_options.island; any
 * size where nothing hidden is wanted. *hidden: NULL where there are too few such pieces to ask; free it with mem_free.
 */
lmn_status occlusion_find(uint8_t **hidden, const stroke_view *v, const stroke_options *options, lmn_error *error);
/* Drops the lines that are only on such pieces: all of those on which no line is seen; and says whose hidden lines are
 * no longer together than stroke_options.figure. False when memory is gone. */
bool occlusion_drop(view_lines *lines, visibility *by, const stroke_view *v, const stroke_options *options);

/* --- form.c --- */
/* Is a mesh a sampling of a surface, whose outline is that surface's however it is asked for? */
bool has_calm_outline(const stroke_scene *s, size_t mesh);
void form_surfaces_destroy(stroke_scene *s);
/* Adds the lines of smooth surfaces that are wished for: outlines by normals, suggestive contours, ridges, valleys,
 * apparent ridges. */
lmn_status form_collect(view_lines *out, const stroke_view *v, const stroke_options *options, const bool *parts,
                        lmn_progress_fn progress, void *user, lmn_error *error);

/* --- outlines.c --- */
/* What of lines is hidden. Outlines of samplings are whole where only their own noise would hide them, and what is
 * short for the size of faces goes. */
lmn_status outlines_see(visibility *out, const stroke_view *v, view_lines *lines, lmn_progress_fn progress, void *user,
                        lmn_error *error);

/* --- chains.c --- */
lmn_status chains_make(stroke_set *out, const stroke_view *v, const view_lines *lines, const visibility *seen,
                       const stroke_options *options, lmn_error *error);

/* --- join.c --- */
/* Makes chains whole: links strokes whose ends lie close together and follow each other, leaves out only then what is
 * too short, and joins outlines that run past each other. */
lmn_status strokes_join(stroke_set *set, const stroke_view *v, const stroke_options *options, lmn_error *error);

/* --- overlap.c --- */
/* Cuts visible outlines that run past each other, side by side, to where they meet. *cut: the ends that meet there now,
 * 2 · stroke, + 1 for its last point, to be joined; the caller frees it, also after an error. */
lmn_status strokes_trim(stroke_set *set, const stroke_view *v, uint32_t (**cut)[2], size_t *count, lmn_error *error);

/* --- density.c --- */
/* Small pieces are drawn with a finer pen, so that their outlines enclose something. */
static inline double stroke_width_on_piece(const stroke *s, double width)
{
    double most = s->size / 6, least = width / 3;
    return !(s->size > 0) || most > width ? width : most > least ? most : least;
}
/* Marks the strokes of the chains that say least where lines crowd, by the options' detail: a flag each, 0 before. */
lmn_status strokes_choose(stroke_set *set, const stroke_view *v, const stroke_options *options, uint8_t *gone,
                          lmn_error *error);
/* --- closing.c --- */
/* Of strokes that are gone (a flag each), brings back short ones without which a line that is drawn would end in the
 * open. False: out of memory. */
bool strokes_close_corners(const stroke_set *set, uint8_t *gone);

/* --- orphans.c --- */
/* Marks short inner lines that end in the open and have no other line near them, the longer ones the less detail there
 * is; and always those, outlines too, that are shorter than a few times the shortest chains. False: out of memory. */
bool strokes_drop_orphans(const stroke_set *set, float detail, float shortest, uint8_t *gone);

/* --- swallowtails.c --- */
/* Cuts small loops of hidden outlines off where these cross themselves. */
void strokes_cut_swallowtails(stroke_set *set);

/* --- crowd.c --- */
/* Marks strokes that run all their length within about this many units of more important ones that are not gone; the
 * page's size in units. */
lmn_status strokes_thin(const stroke_set *set, float apart, int width, int height, uint8_t *gone, lmn_error *error);

#endif
