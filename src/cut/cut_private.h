/* Inside the scene folder: what slicing and capping share. */
#ifndef LIMNER_CUT_CUT_PRIVATE_H
#define LIMNER_CUT_CUT_PRIVATE_H

#include "cut/cut.h"

/* A point of the part: its own vertices first, one for each position, then those made on edges, one for each edge. */
typedef struct cut_vertex {
    double   world[3], local[3];
    uint32_t positive, negative; /* planes that it lies on these sides of; in neither: it lies in the plane */
    uint32_t shell;              /* connected piece of the mesh */
} cut_vertex;

typedef struct cut_point {
    uint32_t vertex;
    float    weights[3];
} cut_point;

/* A flat convex polygon: a piece of a triangle, or of a cut face. */
typedef struct cut_piece {
    size_t   first; /* in the job's points */
    uint32_t count, primitive, triangle;
    uint32_t positive, negative; /* of its points together; once sliced, of the material behind it */
    bool     whole;              /* still the triangle that it was */
    bool     kept;
    int32_t  cap; /* of the result, −1: a surface's */
} cut_piece;

/* Which vertex divides an edge. */
typedef struct cut_edge {
    uint64_t key; /* lower and higher vertex; 0: free */
    uint32_t vertex;
    bool     kept; /* what borders on it stays divided */
} cut_edge;

typedef struct cut_job {
    const cut       *cut;
    const cut_input *inputs;
    const mat4      *world;
    cut_vertex      *vertices;
    size_t           vertex_count, vertex_capacity;
    cut_point       *points;
    size_t           point_count, point_capacity;
    cut_piece       *pieces;
    size_t           piece_count, piece_capacity;
    size_t           surface_pieces; /* the first ones; those of cut faces follow */
    cut_edge        *edges;
    size_t           edge_slots, edge_count;
    size_t           shell_count;
    double           centre[3], scale; /* of the part: brings it to about 1 */
    bool             inside_out;       /* the part's triangles face inward */
    bool             failed;           /* memory is gone */
    cut_result      *out;
} cut_job;

/* A polygon gains a corner with each plane at most, but rounding may make it ever so slightly concave. */
enum { CUT_POLYGON_MAX = 4 * CUT_PLANES_MAX };

/* --- cut_slice.c --- */
uint32_t job_add_vertex(cut_job *j, const cut_vertex *v);
/* A point between others, on the plane (−1: on none). Its sides agree with those it lies between. */
uint32_t   job_blend(cut_job *j, const uint32_t *from, const double *weights, int count, int plane);
cut_piece *job_add_piece(cut_job *j, const cut_point *points, uint32_t count, uint32_t primitive, uint32_t triangle);
/* Where an edge is divided; NULL: it is not. */
cut_edge *job_find_edge(const cut_job *j, uint32_t a, uint32_t b);
/* Divides pieces from `first` on along the plane. */
void job_slice(cut_job *j, size_t first, int plane);
bool cut_is_inside(const cut *c, uint32_t positive, uint32_t negative);
/* The corner from which a fan has no triangle that is thinner than it must be. */
uint32_t job_fan_start(const cut_job *j, const cut_piece *p);

/* --- cut_mend.c --- */
/* Puts divided triangles together again of which nothing is gone; `originals`: the first pieces, triangles when they
 * came. After that cut faces are no longer made. */
void job_mend(cut_job *j, size_t originals);

/* --- cut_stitch.c --- */
/* Gives pieces that meet in a line of two planes the same corners there. */
void job_stitch(cut_job *j);

/* --- cut_cap.c --- */
/* The cut faces in one plane whose normals point to its positive or negative side. */
void job_cap(cut_job *j, int plane, bool positive);

/* --- cut_outline.c --- */
typedef struct cut_segment {
    uint32_t from, to; /* vertices; material on the left, seen from where the cap's normal points */
    uint32_t primitive;
} cut_segment;

/* Closed loops: loop k is points[starts[k]] … points[starts[k + 1] − 1]. */
typedef struct cut_loops {
    uint32_t *points; /* vertices */
    size_t    point_count, point_capacity;
    size_t   *starts, start_capacity;
    uint32_t *primitives; /* of each loop's first segment */
    size_t    primitive_capacity;
    size_t    count;    /* starts has one more */
    size_t    directed; /* the loops before have their material on the left; from here on, any side */
    bool      open;     /* something did not close */
} cut_loops;
/* Chains segments to loops; `segments` is rearranged. False when memory is gone. */
bool outline_chain(cut_loops *out, const cut_job *j, cut_segment *segments, size_t count);
void outline_release(cut_loops *l);

/* --- cut_tessellate.c --- */
/* A body's outline in a plane. */
typedef struct cut_contour {
    const uint32_t *points;
    size_t          count;
    bool            reversed;
} cut_contour;
typedef enum cut_rule { CUT_RULE_NONZERO, CUT_RULE_POSITIVE, CUT_RULE_ODD } cut_rule;
typedef struct cut_triangles {
    uint32_t *corners; /* vertices, counter-clockwise around the normal */
    size_t    count, capacity;
} cut_triangles;
/* Where a vertex is along the axes, in parts of the part's extent. */
void contour_position(const cut_job *j, double axes[2][3], uint32_t vertex, double out[2]);
/* Fills the contours; new vertices may be added to the job. False when it cannot be done; memory trouble is in
 * job->failed. */
bool contours_fill(cut_triangles *out, cut_job *j, int plane, double axes[2][3], const cut_contour *contours,
                   size_t count, cut_rule rule);

#endif
