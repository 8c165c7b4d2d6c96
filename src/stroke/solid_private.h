/* What the files that find a solid's lines share. */
#ifndef LIMNER_STROKE_SOLID_PRIVATE_H
#define LIMNER_STROKE_SOLID_PRIVATE_H

#include <math.h>

#include "stroke/solid.h"
#include "stroke/stroke_private.h"

/* A face as wide as what is one place: it does not know its own plane. */
enum { SOLID_THIN = 8 };

/* A face in double precision. */
typedef struct solid_face {
    double3 p[3], normal; /* unit, outwards of the solid; 0 where it has no area */
} solid_face;

/* A straight line that may bound the solid. */
typedef struct solid_candidate {
    double3  ends[2];
    uint32_t faces[2];  /* that it is of: two of an edge, or two that cross */
    uint32_t flags;     /* of an edge: edge_flag; of a crossing: 0 */
    float    turn;      /* of an edge, as in mesh_edge */
    uint32_t vertex[2]; /* of an edge; NO_VERTEX */
} solid_candidate;

/* An operand. */
typedef struct solid_part {
    uint32_t first_face, face_count;
    box3     box;     /* widened */
    bool     open;    /* no closed mesh */
    bool     crossed; /* runs through itself */
    bool     taken_away;
    size_t   first_meet, meet_count; /* of `meets` */
    bool     alone;                  /* bounds the solid where no other operand is near */
} solid_part;

typedef struct solid_builder {
    edge_mesh       *mesh; /* while it is built */
    edge_solid      *solid;
    double           near; /* what lies no farther apart is in one place */
    double           crease;
    solid_face      *faces;
    box3            *boxes; /* per face, widened */
    uint8_t         *lined; /* per face, a bit a corner: the edge that begins there is a candidate; SOLID_THIN */
    hierarchy        tree;  /* of the faces */
    solid_part      *parts;
    uint32_t        *meets; /* per operand those whose boxes meet its own, one list after the other */
    int32_t         *caps;  /* per operand, while it is built: of the mesh, where it is a cutter; NONE */
    size_t           vertex_capacity, face_capacity, operand_capacity, material_capacity, lined_capacity;
    solid_candidate *candidates;
    size_t           candidate_count, candidate_capacity;
    bool             failed;
} solid_builder;

/* --- solid_faces.c --- */
/* Faces of all operands and the candidates that are their edges. */
lmn_status solid_load(solid_builder *b, const lmn_scene *scene, const solid_form *form, const int32_t *used,
                      size_t count, lmn_error *error);

/* --- solid_pairs.c --- */
/* Adds the candidates in which faces meet. */
lmn_status solid_cross(solid_builder *b, lmn_error *error);

/* --- solid_around.c --- */
/* A stretch of a candidate that bounds the solid. */
typedef struct solid_stretch {
    double3  ends[2];
    uint32_t faces[2]; /* as in mesh_edge */
    uint32_t flags;
    float    turn;
    uint32_t vertex[2]; /* NO_VERTEX: none of an operand */
} solid_stretch;
typedef struct solid_stretches {
    solid_stretch *items;
    size_t         count, capacity;
} solid_stretches;
/* Which stretches of the candidates bound the solid. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status solid_bound(const solid_builder *b, solid_stretches *out, lmn_error *error);

static inline double3 double3_plus(double3 a, double3 b, double factor)
{
    return (double3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}

static inline double double3_length(double3 a)
{
    return sqrt(double3_dot(a, a));
}

static inline bool boxes_meet(const box3 *a, const box3 *b)
{
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y && b->min.y <= a->max.y &&
           a->min.z <= b->max.z && b->min.z <= a->max.z;
}

#endif
