/* The surface of a solid, found on rays in double precision: trees of set operations over closed triangle meshes.
 * Nothing of the engine is used, and no surface is ever computed: a ray crosses the leaves, and where the tree's
 * value changes is the solid. */
#ifndef TRUTH_CSG_TRUTH_H
#define TRUTH_CSG_TRUTH_H

#include "trace.h"

typedef enum csg_kind { CSG_LEAF, CSG_UNION, CSG_INTERSECTION, CSG_DIFFERENCE } csg_kind;

/* A closed surface, anticlockwise seen from outside; corners of one position are one point. */
typedef struct csg_mesh {
    dvec     *points;
    uint32_t *faces; /* 3 a triangle */
    size_t    point_count, face_count;
} csg_mesh;

typedef struct csg_node {
    csg_kind kind;
    int      parent; /* −1: the root */
    double   matrix[16];
    bool     has_colour; /* of all leaves below that have none from above */
    uint8_t  colour[3];  /* sRGB */
    csg_mesh mesh;       /* leaf */
} csg_node;

/* Node 0 is the root. Parents come before their children, children in the order of their operation. */
typedef struct csg {
    csg_node *nodes;
    int       count;
} csg;

int  csg_add(csg *c, int parent, csg_kind kind);
void csg_release(csg *c);
int  csg_leaf_count(const csg *c);
/* Appends a copy of what is at and below a node. */
int csg_copy(csg *c, int parent, const csg *from, int node);

/* As text that OpenSCAD reads: leaves are polyhedra with 17 digits, so that everybody has the same triangles. */
bool csg_write(const csg *c, const char *path);

/* --- rays ----------------------------------------------------------------------------------------------- */

typedef struct csg_rays csg_rays;

/* Corner normals of leaves are those of a crease angle, in degrees. */
csg_rays      *csg_rays_create(const csg *c, double crease);
void           csg_rays_destroy(csg_rays *r);
double         csg_rays_extent(const csg_rays *r); /* diagonal of the leaves' box */
void           csg_rays_box(const csg_rays *r, dvec *low, dvec *high);
size_t         csg_rays_leaves(const csg_rays *r);
const uint8_t *csg_rays_colour(const csg_rays *r, int leaf);

/* One surface of the solid on a ray. */
typedef struct csg_hit {
    double t;        /* in lengths of the direction */
    double depth;    /* eye depth; only of rays through pictures */
    dvec   normal;   /* unit, outward of the solid, interpolated; of rays through pictures: eye space */
    dvec   flat;     /* the triangle's own */
    int    leaf;     /* whose surface it is */
    bool   front;    /* the ray goes into the solid */
    bool   coplanar; /* leaves of one plane meet here */
} csg_hit;

enum { CSG_HITS_MAX = 256 };

typedef struct csg_passage {
    bool close; /* somewhere the order of two crossings that are not in one plane matters, and they are closer than 1e-5
                   of the extent */
    uint64_t crossings; /* stands for all crossings in their order, whether the solid changes there or not */
} csg_passage;

/* On a whole line, nearest first. Crossings of different leaves in one plane are one event: there is a surface when
 * the tree's value before all of them is not that after. Within it, ends of the solid come before beginnings; among
 * ends leaves that are kept and then those that are taken away, among beginnings the other way round; then the
 * order of the tree. The one at which the tree's value changes owns the surface. */
size_t csg_trace(csg_rays *r, dvec origin, dvec direction, csg_hit *out, size_t capacity, csg_passage *passage);

bool csg_inside(csg_rays *r, dvec point);
/* The same from one leaf's surface alone. */
bool csg_inside_leaf(csg_rays *r, int leaf, dvec point);

/* Volume by parallel rays along an axis (0 … 2), `cells` a side of the box's face. */
double csg_volume(csg_rays *r, int axis, int cells);

#endif
