/* Planes that many faces of a mesh lie in: these neither cross nor hide each other, however many there are. */
#ifndef LIMNER_STROKE_PLANES_H
#define LIMNER_STROKE_PLANES_H

#include "stroke/edges.h"

/* Sets mesh.planes where the mesh has many pieces of few faces, else leaves it NULL: there faces that are compared are
 * few. False when memory is gone. */
bool planes_find(edge_mesh *m);

#endif
