/* Edges of what sections leave of meshes. */
#ifndef LIMNER_STROKE_SCENE_CUT_H
#define LIMNER_STROKE_SCENE_CUT_H

#include "cut/cut.h"
#include "stroke/edges.h"

/* How a face in one of a cut's planes is hatched. */
edge_cap scene_cut_cap(const cut *c, int32_t plane, uint32_t body);

/* What a section leaves of one instance of a mesh, with its cut faces, as edges. `positions`: of all primitives, one
 * after the other. Nothing is made unless the verdict is CUT_CROSSED. `open`: some outlines do not close and have no
 * cut face. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status scene_cut_mesh(edge_mesh *out, cut_verdict *verdict, bool *open, const mesh *m, const vec3 *positions,
                          const cut *c, const mat4 *world, double crease_angle, lmn_error *error);

#endif
