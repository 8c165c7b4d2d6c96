/* Edges of what sections leave of meshes. */
#ifndef LIMNER_STROKE_SCENE_CUT_H
#define LIMNER_STROKE_SCENE_CUT_H

#include "cut/cut.h"
#include "stroke/edges.h"

/* What a section leaves of one instance of a mesh, with its cut faces, as edges. `positions`: of all primitives, one
 * after the other. Nothing is made unless the verdict is CUT_CROSSED. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status scene_cut_mesh(edge_mesh *out, cut_verdict *verdict, const mesh *m, const vec3 *positions, const cut *c,
                          const mat4 *world, double crease_angle, lmn_error *error);

#endif
