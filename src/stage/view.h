/* What programs that draw the stage get of a view. */
#ifndef LIMNER_STAGE_VIEW_H
#define LIMNER_STAGE_VIEW_H

#include "base/text.h"
#include "gpu/gpu.h"
#include "plan/camera.h"

/* u_model_view, in double precision first, and u_normal_matrix: its inverse transpose, up to a positive scale. */
void view_set_transform(gpu *g, const view_camera *camera, const mat4 *world);
/* u_projection. */
/* u_past_STEP: to clip space as it was at a step of the past, from 1 on. Of meshes from their axes; of what has no
 * vertices from the eye's, where `now` sees it in `world`. */
void view_set_past(gpu *g, int step, const view_camera *then, const mat4 *past);
void view_set_past_of_eye(gpu *g, int step, const view_camera *then, const mat4 *past, const view_camera *now,
                          const mat4 *world);
void view_set_projection(gpu *g, const view_camera *camera);
/* From eye space to the world, measured from `origin`: columns. */
void view_world_from_eye(const view_camera *camera, const double origin[3], double out[16]);

/* The program of these files with this prelude, which is used up; it knows the bits of surface ids. NULL after an
 * error. */
gpu_program *view_program(gpu *g, gpu_dialect dialect, const char *vertex, const char *fragment, text *prelude);

#endif
