/* Surfaces as they are in a pose: what of them lies outermost, and what of them is near. */
#ifndef LIMNER_CONTACT_SURFACE_H
#define LIMNER_CONTACT_SURFACE_H

#include "pose/pose.h"

/* Of some parts (a flag each) the place that lies outermost against a direction, unit: the mean of all vertices within
 * `tie` of the outermost one. *found is false, and `out` as it was, where they have no vertices. Errors: LMN_MEMORY. */
lmn_status surface_outermost(double out[3], bool *found, const pose *p, const bool *parts, const double direction[3],
                             double tie, lmn_error *error);

typedef struct surface_place {
    size_t part; /* index */
    double place[3], distance;
    double facing; /* 0 … 1: how far the surface lies square to the direction that was given; 1: none was */
} surface_place;

/* The nearest place of the surfaces of some parts that is within a distance of a point; of several that are as near,
 * as faces are that meet at an edge, the one that lies most square to a direction, unit (NULL: the first one). *found
 * is false where there is none. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status surface_nearest(surface_place *out, bool *found, const pose *p, const bool *parts, const double at[3],
                           double within, const double direction[3], lmn_error *error);

#endif
