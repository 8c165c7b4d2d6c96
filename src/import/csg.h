/* Inside the import folder: the meaning of .csg files. Solids become trees of set operations ("shapes" until the
 * whole is known), what lies in the plane is computed at once; leaves that say the same share a mesh. */
#ifndef LIMNER_IMPORT_CSG_H
#define LIMNER_IMPORT_CSG_H

#include "construct/construct.h"
#include "import/csg_tree.h"
#include "scene/solid.h"

/* Not a shape: nothing (NONE), or something that cannot be read and is drawn as if it did not stand there. */
enum { CSG_ABSENT = -2 };

/* An operand or operation in the making; children are linked. */
typedef struct csg_shape {
    solid_kind kind;
    int32_t    first_child, last_child, next;
    int32_t    node; /* of the syntax tree: name and line */
    int32_t    mesh; /* operand: of the reader */
    mat4       matrix;
    bool       has_colour;
    vec4       colour;
} csg_shape;

typedef struct csg_mesh {
    polyhedron polyhedron;
    int32_t    scene_mesh; /* NONE until something draws it */
    int32_t    node;       /* where it was first met; NONE: found under no name */
    bool       plate;      /* of a plane figure that stands for itself */
    bool       absent;
} csg_mesh;

typedef struct csg_reader {
    const import_job *job;
    bool              evaluated; /* from a .scad file: lines are not those of the file that the user knows */
    csg_tree          tree;
    csg_mesh         *meshes;
    size_t            mesh_count, mesh_capacity;
    int32_t          *slots; /* hash table of meshes */
    size_t            slot_count;
    csg_shape        *shapes;
    size_t            shape_count, shape_capacity;
    bool              absent;  /* set by a reader of files that finds nothing to read */
    bool              refused; /* the model may not have the file that it names */
    lmn_error        *error;   /* never NULL */
} csg_reader;

/* What a word of the file means; of mesh, region and shape those that it can be. */
typedef struct csg_meaning {
    const char *word;
    int         dimension; /* 2, 3; 0: that of the children, −1: that of the file it names */
    lmn_status (*mesh)(csg_reader *r, int32_t node, polyhedron *out);
    lmn_status (*region)(csg_reader *r, int32_t node, region *out);
    lmn_status (*shape)(csg_reader *r, int32_t node, int32_t *shape);
    bool groups; /* only puts together what is below it */
} csg_meaning;

/* --- csg.c ---------------------------------------------------------------------------------------------- */

/* Reads the job's bytes as .csg. */
lmn_status csg_read(const import_job *job, bool evaluated, lmn_error *error);

/* --- csg_nodes.c: words, children, shapes, the cache of leaves ------------------------------------------ */

const csg_meaning *csg_meaning_of(const csg_reader *r, int32_t node); /* NULL: unknown */
/* Sets the dimension of all nodes and warns of those that are left out. */
void csg_set_dimensions(csg_reader *r);
/* The child after this one (NONE: the first) that counts: neither % nor *. NONE at the end. */
int32_t csg_child(const csg_reader *r, int32_t parent, int32_t previous);
void    csg_warn(csg_reader *r, int32_t node, warning_code code, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* What cannot be made is left out with a warning; limits, memory and cancelling end the reading. */
lmn_status csg_tolerate(csg_reader *r, int32_t node, lmn_status status);
/* Makes the shape of a solid node: an index, NONE or CSG_ABSENT. */
lmn_status csg_shape_of(csg_reader *r, int32_t node, int32_t *shape);
/* The same of a figure in the plane, as a plate from z = −0.5 to 0.5. */
lmn_status csg_plate_of(csg_reader *r, int32_t node, int32_t *shape);
/* All that counts below a node, put together. */
lmn_status csg_group(csg_reader *r, int32_t node, solid_kind kind, int32_t *shape);
lmn_status csg_append_shape(csg_reader *r, solid_kind kind, int32_t node, int32_t *shape);
void       csg_append_child(csg_reader *r, int32_t parent, int32_t child);
/* Takes over what the polyhedron holds, also when it fails. */
lmn_status csg_append_mesh(csg_reader *r, polyhedron *p, int32_t *mesh);

/* --- csg_leaves.c --------------------------------------------------------------------------------------- */

facets     csg_facets(const csg_reader *r, int32_t node);
lmn_status csg_cube(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_sphere(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_cylinder(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_polyhedron(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_linear_extrude(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_rotate_extrude(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_plate_mesh(csg_reader *r, int32_t node, polyhedron *out);
/* Paths of indices (polyhedron's faces, polygon's paths) as flat arrays; free with mem_free. */
typedef struct csg_paths {
    uint32_t *corners, *sizes;
    size_t    corner_count, count;
} csg_paths;
/* Errors: LMN_FORMAT for indices that no point has, LMN_MEMORY. */
lmn_status csg_read_paths(csg_reader *r, int32_t value, size_t point_count, csg_paths *out);
void       csg_paths_release(csg_paths *p);

/* --- csg_operations.c ----------------------------------------------------------------------------------- */

lmn_status csg_union(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_difference(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_intersection(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_multmatrix(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_color(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_resize(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_hull(csg_reader *r, int32_t node, polyhedron *out);
/* Factors of resize() for something of this size in as many dimensions. */
void csg_resize_factors(const csg_reader *r, int32_t node, const double *size, int dimensions, double *factors);
/* False when it is not a matrix of finite numbers or flattens in this many dimensions. */
bool csg_read_matrix(csg_reader *r, int32_t node, int dimensions, mat4 *out);
/* False when the node names none. */
bool csg_read_colour(const csg_reader *r, int32_t node, vec4 *out);

/* --- csg_minkowski.c, csg_projection.c ------------------------------------------------------------------ */

lmn_status csg_minkowski(csg_reader *r, int32_t node, int32_t *shape);
lmn_status csg_projection(csg_reader *r, int32_t node, region *out);

/* --- csg_openscad.c ------------------------------------------------------------------------------------- */

/* The surface of "HEAD {shapes}", each placed by `above`, as openscad evaluates it, or has once. *why is NULL when it
 * has, else it says why not, and `out` is empty. Errors: LMN_MEMORY, LMN_WRITE, LMN_CANCELLED. */
lmn_status csg_evaluate(csg_reader *r, const char *head, const mat4 *above, const int32_t *shapes, size_t count,
                        polyhedron *out, const char **why);

/* --- csg_regions.c -------------------------------------------------------------------------------------- */

lmn_status csg_region_of(csg_reader *r, int32_t node, region *out, bool *absent);
/* All figures below a node, united. */
lmn_status csg_children_region(csg_reader *r, int32_t node, region *out);
lmn_status csg_square(csg_reader *r, int32_t node, region *out);
lmn_status csg_circle(csg_reader *r, int32_t node, region *out);
lmn_status csg_polygon(csg_reader *r, int32_t node, region *out);
lmn_status csg_text(csg_reader *r, int32_t node, region *out);
lmn_status csg_offset(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_union(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_difference(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_intersection(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_multmatrix(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_hull(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_minkowski(csg_reader *r, int32_t node, region *out);
lmn_status csg_region_resize(csg_reader *r, int32_t node, region *out);

/* --- csg_files.c, csg_dxf.c ----------------------------------------------------------------------------- */

/* 2 for drawings, 3 for meshes, 0 when the ending says neither. */
int        csg_file_dimension(const csg_reader *r, int32_t node);
lmn_status csg_import_mesh(csg_reader *r, int32_t node, polyhedron *out);
lmn_status csg_import_region(csg_reader *r, int32_t node, region *out);
lmn_status csg_surface(csg_reader *r, int32_t node, polyhedron *out);

typedef struct csg_drawing {
    const char *layer; /* "": all */
    double      origin[2], scale;
    facets      facets;
} csg_drawing;
/* The paths of a DXF drawing. Errors: LMN_FORMAT with the line, LMN_LIMIT, LMN_MEMORY. */
lmn_status csg_dxf(const char *bytes, size_t size, const csg_drawing *how, region *out, lmn_error *error);

#endif
