/* Surfaces as they are in a pose: what of them lies outermost, and what of them is near. */
#ifndef LIMNER_CONTACT_SURFACE_H
#define LIMNER_CONTACT_SURFACE_H

#include "pose/pose.h"

/* A primitive as it is in a pose: an instance of a part's. */
typedef struct surface_piece {
    size_t           part;
    const primitive *from;
    const double (*vertices)[3]; /* in the world */
    mat4 world;                  /* where its mesh is */
    bool deformed;               /* its vertices have been moved within the mesh */
} surface_piece;

/* Shows all pieces of a part. Errors: LMN_MEMORY. */
lmn_status surface_visit(const pose *p, size_t part, void (*see)(const surface_piece *piece, void *user), void *user,
                         lmn_error *error);

/* The nearest point of a triangle: below the point where that is inside, else on the nearest edge. Its normal, unit, is
 * 0 where it has no area. */
void surface_nearest_on_triangle(const double p[3], const double *const corners[3], double out[3], double normal[3]);

/* Of some parts (a flag each) the place that lies outermost against a direction, unit: the mean of all vertices within
 * `tie` of the outermost one; of a mesh that stands for a sphere (contact/sphere.h), that of the sphere. *found is
 * false, and `out` as it was, where they have no vertices. Errors: LMN_MEMORY. */
lmn_status surface_outermost(double out[3], bool *found, const pose *p, const bool *parts, const double direction[3],
                             double tie, lmn_error *error);

typedef struct surface_place {
    size_t part; /* index */
    double place[3], distance;
} surface_place;

/* The nearest place of the surfaces of some parts that is within a distance of a point; of several that are as near,
 * the first one. *found is false where there is none. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status surface_nearest(surface_place *out, bool *found, const pose *p, const bool *parts, const double at[3],
                           double within, lmn_error *error);

#endif
