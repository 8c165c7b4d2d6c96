/* The smooth surface that a mesh stands for: normals, how it bends and how that changes. View-independent; what
 * lines of form are made from. */
#ifndef LIMNER_STROKE_FORM_SURFACE_H
#define LIMNER_STROKE_FORM_SURFACE_H

#include "stroke/edges.h"

/* How a surface bends at a knot. Curvatures are above 0 where it is convex: moving along w, the normal turns by
 * II(w, ·). The derivative of II is a symmetric form of three directions (Rusinkiewicz 2004), here along the
 * principal directions d and e = n × d: ddd, dde, dee, eee. */
typedef struct surface_bend {
    vec3  direction; /* d: unit, of the greater curvature */
    float greater, lesser;
    float change[4];
} surface_bend;

/* What around a mesh's knots does not depend on where they are: of samplings it stays when they move. */
typedef struct form_knots {
    uint32_t knot_count;
    uint32_t (*corners)[3], *opposite, *vertices; /* as in form_surface */
    uint32_t *fan_starts, *fan_faces;             /* likewise */
    uint32_t *corner_starts, *corner_list;        /* per knot: its corners, ascending */
    uint32_t *beside_starts, *beside_list;        /* per knot of a sampling: those along edges; NULL: not asked for */
} form_knots;
void form_knots_destroy(form_knots **k);

/* A knot is a vertex, once for each smooth stretch of surface around it: sharp edges have knots of their own on
 * either side. */
typedef struct form_surface {
    uint32_t knot_count, face_count;
    uint32_t (*corners)[3]; /* per face: knots */
    uint32_t *opposite; /* per half-edge 3 · face + corner: the other one where the surface goes on smoothly, NO_HALF
                           elsewhere */
    uint32_t     *vertices;               /* per knot: of the mesh */
    vec3         *normals;                /* per knot: unit, outward where the piece is closed, else by winding */
    vec3         *calm_normals;           /* the same without noise, of samplings; NULL: the mesh is none */
    surface_bend *bends;                  /* per knot; NULL: not asked for */
    uint32_t     *fan_starts, *fan_faces; /* faces around each vertex of the mesh */
    double        size;                   /* diagonal of the mesh */
    form_knots   *own;                    /* what the arrays of numbers belong to; NULL: to the mesh's topology */
} form_surface;
#define NO_HALF UINT32_MAX

/* `bends`: also how it bends, measured over about a hundredth of the mesh's size, at least over a ring of faces.
 * Errors: LMN_MEMORY, LMN_LIMIT. End with form_surface_release. */
lmn_status form_surface_make(form_surface *out, const edge_mesh *m, bool bends, lmn_error *error);
void       form_surface_release(form_surface *s);

#endif
