/* All meshes of a scene as one polyhedron, for what needs a closed shape. */
#ifndef LIMNER_IMPORT_GATHER_H
#define LIMNER_IMPORT_GATHER_H

#include "construct/construct.h"

/* At rest, in the scene's axes, solids left out. *open: some have borders. Errors: LMN_MEMORY; release the result
 * all the same. */
lmn_status import_gather(polyhedron *out, const lmn_scene *scene, bool *open, lmn_error *error);

#endif
