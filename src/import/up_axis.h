/* Which way is up, in files of formats that do not say. */
#ifndef LIMNER_IMPORT_UP_AXIS_H
#define LIMNER_IMPORT_UP_AXIS_H

#include "scene/scene.h"

/* What is found of one direction as up. */
typedef struct up_measure {
    double support;   /* area on which it stands, flat faces and the inside of open rims, of its footprint */
    bool   stands;    /* its centre lies above what it stands on */
    bool   symmetric; /* it has an upright plane of symmetry */
    double score;
} up_measure;

/* The axis that points up: 'x', 'y', 'z', or in capitals the negative ones. `usual` unless another one is clearly
 * better, on which the model stands more firmly; then the scene is warned of it. Also `usual` for what has no
 * triangles. The scene is finished. Errors: LMN_MEMORY, and that of work that is to stop. */
lmn_status up_axis_guess(char *out, lmn_scene *scene, char usual, const char *format, lmn_error *error);

/* Of 'x', 'y', 'z', 'X', 'Y', 'Z', in this order; all 0 where nothing can be said. Errors: the same. */
lmn_status up_axis_measure(up_measure out[6], const lmn_scene *scene, lmn_error *error);

#endif
