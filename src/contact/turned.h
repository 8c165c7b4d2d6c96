/* Meshes that stand for a cylinder or a cone, cut off or not. A mesh touches a floor with the edge that lies nearest,
 * which is not where the cylinder that it was made for does: what is recognised as one is met as one. */
#ifndef LIMNER_CONTACT_TURNED_H
#define LIMNER_CONTACT_TURNED_H

#include "scene/scene.h"

/* In the mesh's axes: from the middle of the one end, by the whole height along an axis of the mesh, to that of the
 * other. */
typedef struct turned {
    double base[3], height, radii[2]; /* of the ends; one of them may be 0 */
    int    axis;                      /* 0 … 2; across it are the next two, in that order */
} turned;

/* Is a primitive the whole of one, drawn smooth: all vertices lie on the rims or in the middles of its ends, all
 * around, it encloses what it should, and normals that it has are those of its side or ends? */
bool turned_of(turned *out, const primitive *p);

/* A place of its side: at an angle around its axis, radians, on the rim of one of its ends. */
void turned_rim(const turned *t, double angle, int end, double out[3]);
/* How far its side leans: what its normal, of length 1 across the axis, has along it. */
double turned_slope(const turned *t);
/* A place in its own axes: x and y across, z along from its base. */
void turned_own(const turned *t, const double at[3], double out[3]);

#endif
