/* Shapes from numbers, as OpenSCAD makes them: polyhedra in double precision and regions of the plane. Facet counts
 * come from $fn, $fa and $fs. Everything fails with a status; input with NaN or infinities is LMN_FORMAT, too much
 * of it LMN_LIMIT. */
#ifndef LIMNER_CONSTRUCT_CONSTRUCT_H
#define LIMNER_CONSTRUCT_CONSTRUCT_H

#include "base/error.h"
#include "scene/scene.h"

typedef struct point2 {
    double x, y;
} point2;
typedef struct point3 {
    double x, y, z;
} point3;

/* A closed surface of triangles, anticlockwise seen from outside: each directed edge has one opposite edge, or as
 * many as there are of it where parts touch. Owned arrays; zero-initialised is empty. */
typedef struct polyhedron {
    point3   *points;
    size_t    point_count;
    uint32_t *triangles; /* 3 a triangle */
    size_t    triangle_count;
    bool      convex; /* known to be */
} polyhedron;
void polyhedron_release(polyhedron *p);

/* A region of the plane: outer contours anticlockwise, holes clockwise, none crossing another; they may touch at
 * points that both have. The last point is not the first repeated. Owned; zero-initialised is empty. */
typedef struct contour {
    point2 *points;
    size_t  count;
} contour;
typedef struct region {
    contour *contours;
    size_t   count;
} region;
void region_release(region *r);

/* How finely round things are divided: OpenSCAD's special variables. */
typedef struct facets {
    double fn, fa, fs;
} facets;
/* How many pieces a full circle of this radius has. */
int facets_of_circle(double radius, facets f);

/* --- solids.c: the plain ones; sizes that are not positive give an empty one ---------------------------- */
lmn_status construct_cube(polyhedron *out, const double size[3], bool centre, lmn_error *error);
lmn_status construct_sphere(polyhedron *out, double radius, facets f, lmn_error *error);
lmn_status construct_cylinder(polyhedron *out, double height, double r1, double r2, bool centre, facets f,
                              lmn_error *error);
/* Faces as OpenSCAD has them: clockwise seen from outside, corners one after the other, `face_sizes[i]` of them.
 * *flawed: not closed or not consistently wound; made all the same. */
lmn_status construct_polyhedron(polyhedron *out, const point3 *points, size_t point_count, const uint32_t *corners,
                                const uint32_t *face_sizes, size_t face_count, bool *flawed, lmn_error *error);
/* A field of heights, `columns` by `rows`, row 0 at y = 0, on a base one unit below the lowest, but never above 0
 * (OpenSCAD's surface()). */
lmn_status construct_heights(polyhedron *out, const double *heights, size_t columns, size_t rows, bool centre,
                             lmn_error *error);

/* --- regions.c: plain regions and their set operations (GEOS) ------------------------------------------- */
lmn_status construct_square(region *out, const double size[2], bool centre, lmn_error *error);
lmn_status construct_circle(region *out, double radius, facets f, lmn_error *error);
/* Any closed paths, crossing ones too, by the even-odd rule; `path_sizes` as face_sizes. */
lmn_status construct_polygon(region *out, const point2 *points, size_t point_count, const uint32_t *corners,
                             const uint32_t *path_sizes, size_t path_count, lmn_error *error);
typedef enum region_operation { REGION_UNION, REGION_INTERSECTION, REGION_DIFFERENCE } region_operation;
/* All operands in order; a difference takes the later ones from the first. */
lmn_status region_combine(region *out, const region *operands, size_t count, region_operation operation,
                          lmn_error *error);
/* Affine: x' = m[0]x + m[2]y + m[4], y' = m[1]x + m[3]y + m[5]; mirrored contours are turned round again. */
lmn_status region_transform(region *out, const region *r, const double m[6], lmn_error *error);
/* OpenSCAD's offset: `rounded` (r =, arcs by facets) or `delta` with or without chamfer. */
lmn_status region_offset(region *out, const region *r, double distance, bool rounded, bool chamfer, facets f,
                         lmn_error *error);
lmn_status region_hull(region *out, const region *operands, size_t count, lmn_error *error);
lmn_status region_minkowski(region *out, const region *a, const region *b, lmn_error *error);
/* False when empty. */
bool region_bounds(const region *r, double low[2], double high[2]);

/* --- text.c: outlines of letters (fontconfig, FreeType, HarfBuzz) --------------------------------------- */
typedef struct text_style {
    const char *font; /* "Liberation Sans:style=Bold"; NULL or "": OpenSCAD's default */
    double      size, spacing;
    const char *direction, *language, *script, *halign, *valign; /* as OpenSCAD names them; NULL: its defaults */
    /* Characters that the font lacks come from other fonts, and what runs from right to left does so beside what does
     * not; else as OpenSCAD has it. Then characters that no font has are an error: LMN_UNSUPPORTED. */
    bool fallback;
} text_style;
/* *missing: another font stands in for the one asked for. */
lmn_status construct_text(region *out, const char *utf8, const text_style *style, facets f, bool *missing,
                          lmn_error *error);
/* Do the installed fonts have all of it, where others may stand in? Errors: those of construct_text. */
lmn_status construct_text_check(const char *utf8, const char *font, lmn_error *error);

/* --- extrude.c ------------------------------------------------------------------------------------------ */
typedef struct linear_extrusion {
    double height, twist /* degrees */, scale[2];
    bool   centre, has_slices;
    int    slices;
    facets facets;
} linear_extrusion;
lmn_status construct_linear_extrude(polyhedron *out, const region *r, const linear_extrusion *how, lmn_error *error);
/* Around the z axis; points with x < 0 as OpenSCAD takes them (all on one side, else LMN_FORMAT). */
lmn_status construct_rotate_extrude(polyhedron *out, const region *r, double angle_degrees, facets f, lmn_error *error);

/* --- polyhedra.c: from polyhedra ------------------------------------------------------------------------ */
/* Column-major, as mat4; mirrored ones are turned round again. Zero scale gives what it gives. */
lmn_status polyhedron_transform(polyhedron *out, const polyhedron *p, const mat4 *m, lmn_error *error);
/* The convex hull of all points (qhull); empty when flat. */
lmn_status polyhedron_hull(polyhedron *out, const polyhedron *operands, size_t count, lmn_error *error);
/* The sum of two convex ones; LMN_UNSUPPORTED when one is not. */
lmn_status polyhedron_minkowski(polyhedron *out, const polyhedron *a, const polyhedron *b, lmn_error *error);
/* Where the plane z = 0 cuts it, and its shadow on that plane. */
lmn_status polyhedron_slice(region *out, const polyhedron *p, lmn_error *error);
lmn_status polyhedron_shadow(region *out, const polyhedron *p, lmn_error *error);
/* Is every point on or behind every face (within 1e-9 of the extent)? Sets `convex`. */
bool polyhedron_check_convex(polyhedron *p);
bool polyhedron_bounds(const polyhedron *p, point3 *low, point3 *high);
/* A mesh of one primitive without normals and material. Points are welded as they are. False when memory is gone. */
bool polyhedron_into_mesh(mesh *out, const polyhedron *p);
/* The same in the scene; NONE when memory is gone. */
int32_t polyhedron_into_scene(lmn_scene *scene, const polyhedron *p);

#endif
