/* How edges of meshes are sorted (stroke/edges.h): what its parts share. */
#ifndef LIMNER_STROKE_EDGE_BUILDER_H
#define LIMNER_STROKE_EDGE_BUILDER_H

#include "stroke/creases.h"
#include "stroke/edges.h"
#include "stroke/form_surface.h"

typedef struct half_edge {
    uint32_t high, corner; /* corner: 3 · face + number of the corner that it begins at */
} half_edge;

/* Ranges of vertices whose edges are taken side by side. */
enum { RANGES = 16, RANGES_LEAST = 4096 };

struct edge_topology {
    uint64_t    revision;
    uint32_t    range_edges[RANGES + 1]; /* per range: how many edges those before it have */
    edge_mesh   mesh;                    /* at rest */
    uint32_t   *welded;                  /* per vertex of the mesh: its number */
    double      near;                    /* so far apart those of one number may lie */
    size_t      vertex_count;
    uint32_t   *starts; /* of `mesh`, as below */
    half_edge  *halves;
    uint32_t   *opposite; /* of crease_facts, as are these */
    uint8_t    *shading;
    bool        mixed;
    bool        has_flat; /* faces without area were left out */
    form_knots *knots;
};

typedef struct edge_builder {
    edge_mesh     *mesh;
    edge_topology *keeps;  /* NULL: nobody asks */
    uint32_t      *starts; /* per vertex, and one more */
    half_edge     *halves;
    uint8_t       *dropped;  /* per face: 1: the same as another one */
    uint32_t      *origins;  /* per face: its number before any were dropped; NULL: nobody asks */
    uint32_t      *pieces;   /* per face: another one of its piece, itself at the root */
    uint32_t      *normals;  /* per corner: the file's, packed; NULL: it has none */
    uint32_t      *opposite; /* per half-edge, of crease_facts */
    size_t         edge_capacity;
    float          crease; /* cosine of … */
    double         angle;
    bool           has_flat; /* faces without area were left out */
    bool           whole;    /* nothing is dropped that is there twice */
    bool has_twins; /* there may be faces that are there twice: edges have more than two, or both of an edge are the
                       same, or lie on each other */
} edge_builder;

static inline vec3 minus(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Unit, or zero where the face has no area. */
vec3 edge_face_normal(const vec3 *positions, const uint32_t corners[3]);

/* Faces of a mesh, welded by position, or of what is welded already. Errors: LMN_LIMIT, LMN_MEMORY. */
lmn_status edge_faces_make(edge_builder *b, const mesh *m, const vec3 *posed, lmn_error *error);
lmn_status edge_faces_take(edge_builder *b, const edge_faces *in, lmn_error *error);

/* Sorts the edges of the faces that are there, unless making them failed. */
lmn_status edges_finish(edge_builder *b, lmn_status status, lmn_error *error);

/* The half-edges of one edge, the lower vertex of which is `low`. False: memory is gone. */
typedef bool (*edge_visit)(edge_builder *b, uint32_t low, const half_edge *group, size_t count);
/* All edges whose lower vertex is in this range. */
bool edges_visit(edge_builder *b, uint32_t first, uint32_t end_vertex, edge_visit visit);
/* Judges an edge and puts it into the mesh if it may be a line (edge_visit). */
bool edges_take(edge_builder *b, uint32_t low, const half_edge *group, size_t count);

/* Volume of each closed piece, or NULL when memory is gone: freed by the caller. Finds boxes and which look inwards. */
double *edges_measure_pieces(edge_mesh *m);
/* Of closed pieces, candidates that are concave are hollow, and come last. False: no memory. */
bool edges_mark_hollow(edge_mesh *m, const double *volumes);

#endif
