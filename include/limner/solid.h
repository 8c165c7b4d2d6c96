/* Solids: what is left when shapes are united, intersected and taken from one another (constructive solid geometry),
 * and editing them from drawing to drawing. A solid is a tree of nodes: operations, and shapes at its ends. Nobody
 * computes its surface; drawing finds it pixel by pixel, so that each edit shows in the next drawing and costs next to
 * nothing.
 *
 * A solid belongs to a scene, which names it with an id from 1 on; the solid names its nodes in the same way, its root
 * is LMN_SOLID_ROOT. Ids stay what they are through all edits, and that of something removed is never given again.
 * Files read with lmn_scene_add_file may bring solids too (.csg, .scad); they are edited like any other. Lengths are in
 * the scene's unit, angles in degrees. A scene that begins with a solid has +Z up.
 *
 * On any error the scene is unchanged. Every function can fail with LMN_USAGE (a NULL, an id that is not there, a
 * number that is not finite or not in its range) and LMN_MEMORY; other errors are named. A scene is edited by one
 * thread at a time and never while it is drawn. No GL context needed. Nienhaus, Kirsch and Döllner 2006, section 2. */
#ifndef LIMNER_SOLID_H
#define LIMNER_SOLID_H

#include "limner/error.h"
#include "limner/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { LMN_SOLID_ROOT = 1 };

/* An operation has any number of operands, in order. A union or intersection of none is empty; a difference takes
 * all later operands from the first. LMN_SHAPE is no operation: the node is a shape. */
typedef enum lmn_operation { LMN_SHAPE = 0, LMN_UNION, LMN_INTERSECTION, LMN_DIFFERENCE } lmn_operation;

/* How finely round things are divided, as OpenSCAD's $fn, $fa and $fs: fn pieces a circle, or with 0 as many as
 * neither turn by less than fa degrees nor are shorter than fs, five at least. fn is 0 or more, fa and fs are above
 * 0. */
typedef struct lmn_facets {
    double fn, fa, fs;
} lmn_facets;
#define LMN_FACETS_INIT                                                                                                \
    {                                                                                                                  \
        0, 12, 2                                                                                                       \
    }

typedef enum lmn_shape_kind {
    LMN_SHAPE_BOX = 1,
    LMN_SHAPE_SPHERE,
    LMN_SHAPE_CYLINDER, /* a cone with two radii */
    LMN_SHAPE_POLYHEDRON,
    LMN_SHAPE_EXTRUSION, /* a profile drawn up along z */
    LMN_SHAPE_REVOLUTION /* a profile in x and z turned around z */
} lmn_shape_kind;

/* A shape. Make one with the functions below, then change what they leave at its default. Arrays are borrowed for
 * the call that the shape is given to. Sizes, radii and heights are above 0 unless something else is said. At most
 * 4 000 000 points a shape. */
typedef struct lmn_shape {
    size_t         struct_size;
    lmn_shape_kind kind;
    bool centred;      /* box: all of it around the origin, else in the positive octant; cylinder, extrusion: along z */
    lmn_facets facets; /* sphere, cylinder, revolution; an extrusion that twists */
    double     size[3];    /* box */
    double     radius;     /* sphere; cylinder: at the bottom, 0 is a tip */
    double     top_radius; /* cylinder: at the top, 0 is a tip; not both */
    double     height;     /* cylinder, extrusion */
    double     twist;      /* extrusion: degrees from bottom to top, clockwise seen from above; default 0 */
    double     scale[2];   /* extrusion: of the top, 0 or more; default 1 */
    uint32_t   slices;     /* extrusion: layers, at most 1 000 000; 0, the default: by twist and facets */
    double     angle;      /* revolution: −360 … 360, not 0 */
    /* Extrusion and revolution: closed contours, one after the other, in any order and either way round. What lies
     * inside an odd number of them is filled, so a contour in another is a hole. For revolutions all x have one
     * sign. */
    const double (*profile)[2];
    size_t          profile_count;
    const uint32_t *contour_sizes; /* points of each, 3 or more; NULL: one contour */
    size_t          contour_count;
    /* Polyhedron: faces of 3 corners or more, one after the other. All are anticlockwise seen from outside, or all
     * clockwise, and each edge belongs to two faces, which pass it in opposite directions. */
    const double (*points)[3];
    size_t          point_count;
    const uint32_t *corners; /* numbers of points */
    const uint32_t *face_sizes;
    size_t          face_count;
} lmn_shape;

/* Shapes with all else at its default. The functions check nothing; who takes the shape does. */
static inline lmn_shape lmn_shape_of(lmn_shape_kind kind)
{
    lmn_shape shape = {sizeof(lmn_shape),
                       kind,
                       false,
                       LMN_FACETS_INIT,
                       {0, 0, 0},
                       0,
                       0,
                       0,
                       0,
                       {1, 1},
                       0,
                       0,
                       NULL,
                       0,
                       NULL,
                       0,
                       NULL,
                       0,
                       NULL,
                       NULL,
                       0};
    return shape;
}

static inline lmn_shape lmn_shape_box(double x, double y, double z)
{
    lmn_shape shape = lmn_shape_of(LMN_SHAPE_BOX);
    shape.size[0] = x;
    shape.size[1] = y;
    shape.size[2] = z;
    return shape;
}

static inline lmn_shape lmn_shape_sphere(double radius)
{
    lmn_shape shape = lmn_shape_of(LMN_SHAPE_SPHERE);
    shape.radius = radius;
    return shape;
}

static inline lmn_shape lmn_shape_cylinder(double height, double bottom_radius, double top_radius)
{
    lmn_shape shape = lmn_shape_of(LMN_SHAPE_CYLINDER);
    shape.height = height;
    shape.radius = bottom_radius;
    shape.top_radius = top_radius;
    return shape;
}

static inline lmn_shape lmn_shape_polyhedron(const double (*points)[3], size_t point_count, const uint32_t *corners,
                                             const uint32_t *face_sizes, size_t face_count)
{
    lmn_shape shape = lmn_shape_of(LMN_SHAPE_POLYHEDRON);
    shape.points = points;
    shape.point_count = point_count;
    shape.corners = corners;
    shape.face_sizes = face_sizes;
    shape.face_count = face_count;
    return shape;
}

static inline lmn_shape lmn_shape_extrusion(const double (*profile)[2], size_t profile_count, double height)
{
    lmn_shape shape = lmn_shape_of(LMN_SHAPE_EXTRUSION);
    shape.profile = profile;
    shape.profile_count = profile_count;
    shape.height = height;
    return shape;
}

static inline lmn_shape lmn_shape_revolution(const double (*profile)[2], size_t profile_count, double angle)
{
    lmn_shape shape = lmn_shape_of(LMN_SHAPE_REVOLUTION);
    shape.profile = profile;
    shape.profile_count = profile_count;
    shape.angle = angle;
    return shape;
}

/* --- building. New nodes are their parent's last operand, have no colour, and stand where the parent does; ids go to
 * the last argument before `error`, which may be NULL. At most 16383 shapes a solid and in all solids that are drawn
 * together, and 4096 levels: LMN_LIMIT.
 * --------------------------------------------------------------------------------------------------------------------
 */

/* Adds a solid whose root is this operation. It is a part of this name (NULL: "part-ID") as long as its shapes have
 * triangles. */
LMN_API lmn_status lmn_scene_add_solid(lmn_scene *scene, const char *name, lmn_operation root, uint32_t *solid,
                                       lmn_error *error);

/* Adds an operation without operands yet. */
LMN_API lmn_status lmn_solid_add_operation(lmn_scene *scene, uint32_t solid, uint32_t parent, lmn_operation operation,
                                           uint32_t *node, lmn_error *error);

/* Its name is that of its kind: "box", "sphere", … Errors: LMN_LIMIT. */
LMN_API lmn_status lmn_solid_add_shape(lmn_scene *scene, uint32_t solid, uint32_t parent, const lmn_shape *shape,
                                       uint32_t *node, lmn_error *error);

/* Adds a model file as one node with the file's name, turned to the scene's up axis: a shape of all its meshes,
 * which should be closed (else the scene gets the warning `bad-geometry`), without their materials; for .csg and
 * .scad a union of its solids. `desc` may be NULL. Errors: those of lmn_scene_add_file. */
LMN_API lmn_status lmn_solid_add_file(lmn_scene *scene, uint32_t solid, uint32_t parent, const char *path,
                                      const lmn_load_desc *desc, uint32_t *node, lmn_error *error);

/* Adds a node of the same solid once more, with all below it: matrices, colours and names are copied, meshes are
 * shared. */
LMN_API lmn_status lmn_solid_add_copy(lmn_scene *scene, uint32_t solid, uint32_t parent, uint32_t source,
                                      uint32_t *node, lmn_error *error);

/* --- editing -------------------------------------------------------------------------------------------- */

/* Where a node stands, measured from its parent: 16 numbers, column after column, acting on columns; the last row
 * is 0 0 0 1, and what is below is not flattened. Nothing may lie farther than 1e18 from the solid's origin. The
 * root's matrix moves the whole solid. */
LMN_API lmn_status lmn_solid_set_matrix(lmn_scene *scene, uint32_t solid, uint32_t node, const double matrix[16],
                                        lmn_error *error);

/* sRGB and straight alpha, 0 … 1; NULL: none. A colour counts for all below; of several the outermost does. Without
 * any, light grey. */
LMN_API lmn_status lmn_solid_set_colour(lmn_scene *scene, uint32_t solid, uint32_t node, const float colour[4],
                                        lmn_error *error);

/* Leaves a node, with all below it, out of the solid as if it were no operand, or brings it back: of a difference
 * without its first operand the second is the first, what is left of an intersection is that of the others. Ids, counts
 * and parts are the same meanwhile; the bounds of what is left out are empty. New nodes are shown. */
LMN_API lmn_status lmn_solid_set_shown(lmn_scene *scene, uint32_t solid, uint32_t node, bool shown, lmn_error *error);

/* Turns an operation into another. */
LMN_API lmn_status lmn_solid_set_operation(lmn_scene *scene, uint32_t solid, uint32_t node, lmn_operation operation,
                                           lmn_error *error);

/* Puts another shape in a shape's position; matrix, colour and name stay. Copies keep the shape they have. Errors:
 * LMN_LIMIT. */
LMN_API lmn_status lmn_solid_set_shape(lmn_scene *scene, uint32_t solid, uint32_t node, const lmn_shape *shape,
                                       lmn_error *error);

/* NULL: no name. The root's name is the part's. */
LMN_API lmn_status lmn_solid_set_name(lmn_scene *scene, uint32_t solid, uint32_t node, const char *name,
                                      lmn_error *error);

/* Removes a node and all below it; with the root the whole solid. */
LMN_API lmn_status lmn_solid_remove(lmn_scene *scene, uint32_t solid, uint32_t node, lmn_error *error);

/* Makes a node, with all below it, an operand of this operation, in front of its operand `before` (0: behind all).
 * The matrix stays, so it stands where its new parent puts it. The root cannot be moved, and nothing to what is
 * below it. Errors: LMN_LIMIT. */
LMN_API lmn_status lmn_solid_move(lmn_scene *scene, uint32_t solid, uint32_t node, uint32_t parent, uint32_t before,
                                  lmn_error *error);

/* --- reading back --------------------------------------------------------------------------------------- */

/* A node of a solid. Ids are 0 where there is none. */
typedef struct lmn_solid_info {
    lmn_operation operation; /* LMN_SHAPE: it is none */
    uint32_t      parent, first_child, next_sibling;
    size_t        child_count;
    const char   *name; /* NULL: none; borrowed, valid until the next edit */
    double        matrix[16];
    bool          has_colour;
    float         colour[4];                    /* as it was set */
    uint64_t      triangles;                    /* of all shapes below, copies counted */
    bool          is_empty;                     /* for certain; then the bounds are 0 */
    double        bounds_min[3], bounds_max[3]; /* the solid's axes; it can be no larger than that */
    uint32_t      part;                         /* that draws the solid; 0: there is none */
} lmn_solid_info;

/* How many solids the scene has, and the id of one (0 … count−1; 0 when out of range). */
LMN_API size_t   lmn_scene_solid_count(const lmn_scene *scene);
LMN_API uint32_t lmn_scene_solid_at(const lmn_scene *scene, size_t index);

/* Is the node no operand that was left out? What is above it may be. False when there is no such solid or node. */
LMN_API bool lmn_solid_is_shown(const lmn_scene *scene, uint32_t solid, uint32_t node);

/* False when there is no such solid or node. */
LMN_API bool lmn_solid_info_of(const lmn_scene *scene, uint32_t solid, uint32_t node, lmn_solid_info *out);

#ifdef __cplusplus
}
#endif
#endif
