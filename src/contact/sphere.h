/* Meshes that stand for a sphere. A mesh touches a slope with the vertex that lies nearest, which is not where the
 * sphere that it was made for does: what is recognised as one is met as one. */
#ifndef LIMNER_CONTACT_SPHERE_H
#define LIMNER_CONTACT_SPHERE_H

#include "scene/scene.h"

typedef struct sphere {
    double centre[3], radius; /* in the mesh's axes */
} sphere;

/* Is a primitive the whole of a sphere, drawn smooth: all vertices lie on it, its triangles close around its middle and
 * are so many that none is far from it, and normals that it has point away from its middle? */
bool sphere_of(sphere *out, const primitive *p);

#endif
