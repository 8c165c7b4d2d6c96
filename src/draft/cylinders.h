/* Cylinders and cones that the surfaces of a scene are made of: what axes, pitch circles and threads are drawn for.
 * Found in the faces, so that meshes, solids and what came from STEP files are one. */
#ifndef LIMNER_DRAFT_CYLINDERS_H
#define LIMNER_DRAFT_CYLINDERS_H

#include "stroke/stroke.h"

/* World axes. */
typedef struct draft_cylinder {
    double   axis[3];    /* unit */
    double   ends[2][3]; /* on the axis: how far the surface reaches along it, ends[1] on the side of `axis` */
    double   radius;     /* of a cone the larger one */
    double   radii[2];   /* at the ends */
    bool     cone;
    double   sweep;  /* of the circle, radians: 2π is all of it */
    bool     hollow; /* a bore, not a shaft */
    uint32_t part;   /* id */
} draft_cylinder;

typedef struct draft_cylinders {
    draft_cylinder *items;
    size_t          count, capacity;
    uint64_t        grown; /* faces that growing regions took in, all together: what the work was */
} draft_cylinders;

/* Less of a circle is a rounding, which has no axis in drawings: radians. */
#define DRAFT_SWEEP_LEAST 3.49

/* All of the scene, part by part, of each mesh cylinders before cones. A prism or pyramid whose edges are drawn is
 * none, nor are roundings of half a turn or less, nor what bends both ways. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status draft_cylinders_find(draft_cylinders *out, const stroke_scene *scene, lmn_error *error);
void       draft_cylinders_release(draft_cylinders *c);

#endif
