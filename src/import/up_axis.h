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
 * better, on which the model stands more firmly; then the scene is warned of it. Also `usual` when memory is gone, and
 * for what has no triangles. The scene is finished. */
char up_axis_guess(lmn_scene *scene, char usual, const char *format);

/* Of 'x', 'y', 'z', 'X', 'Y', 'Z', in this order. False: nothing can be said. For tests, too. */
bool up_axis_measure(const lmn_scene *scene, up_measure out[6]);

#endif
