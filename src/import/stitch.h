/* Inside the import folder: meshes whose faces lie side by side without sharing corners. */
#ifndef LIMNER_IMPORT_STITCH_H
#define LIMNER_IMPORT_STITCH_H

#include "scene/scene.h"

/* Corners that are nearer than `near` to each other become one place, and triangles are cut where the corner of another
 * one lies in one of their edges, so that what touches is joined. Of triangles without normals. False: memory is gone,
 * or the work is to stop. */
bool stitch(primitive *p, double near);

/* Fills what is missing of flat faces of bodies: holes that lie in one plane with a face beside them, and that another
 * face bounds, too, which does not. So holes of sheets and the rims of open boxes stay. After `stitch`; false: as
 * there. */
bool stitch_holes(primitive *p, double near);

#endif
