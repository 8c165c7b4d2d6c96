/* Coarse meshes as the curved surfaces that they stand for: where normals say that a surface bends, its edges are
 * halved until they follow the bend, as curved PN triangles do (A. Vlachos, J. Peters, C. Boyd, J. L. Mitchell: Curved
 * PN Triangles, I3D 2001, section 3.1). There triangles with different normals at a place part; here what is done to an
 * edge is decided once, from both its sides, and creases bend along themselves, so that nothing parts. Normals go on as
 * they did over the coarse triangle: what looked smooth looks the same. Free forms (round_form.c), whose normals are
 * none that curves could follow, are subdivided instead. */
#ifndef LIMNER_SCENE_ROUND_H
#define LIMNER_SCENE_ROUND_H

#include "scene/scene.h"

/* An edge that is a crease: its ends, exactly where vertices of the mesh are, and by how much it turns as a line,
 * radians. */
typedef struct round_crease {
    vec3  ends[2];
    float turn;
} round_crease;

typedef struct round_options {
    double              crease_angle;  /* radians; of primitives without normals */
    double              tolerance;     /* how far edges may lie off the surface, of the mesh's diagonal */
    size_t              most_vertices; /* that are added; the last halving that would add more is left out */
    bool                forms_only;    /* what is no free form stays as it is */
    const round_crease *sharp;         /* edges that are creases */
    size_t              sharp_count;
} round_options;

/* `out` becomes the mesh that is drawn instead, with normals and triangles of its own, revision 0; vertices that were
 * there keep their order, and but for free forms their places. It says of its edges that they may be outlines, or are
 * creases where edges were sharp, and by how much these turned, which their faces no longer do; unless the mesh says
 * more itself. With `forms_only` nothing but that edges within free forms are outlines at most. Without primitives: the
 * mesh is as round as it can be. Released with mesh_release. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status mesh_round(mesh *out, const mesh *m, const round_options *options, lmn_error *error);

/* --- one edge, for tests -------------------------------------------------------------------------------- */

/* A side of an edge: the normals there at its two ends, and the face's own. How far, in lengths of the edge, the first
 * face goes that it would go on over beyond either end; INFINITY where there is none. */
typedef struct round_side {
    double normals[2][3], face[3], beyond[2];
    bool   plane; /* the face lies in a plane, to which the edge keeps; then all three normals are its own */
} round_side;

typedef struct round_edge {
    double middle[3]; /* where the curve is half-way */
    double distance;  /* of the curve from the edge, about */
} round_edge;

/* `other` is NULL at borders. */
round_edge round_edge_of(const double ends[2][3], const round_side *one, const round_side *other);
#endif
