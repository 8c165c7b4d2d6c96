/* The camera: from the description of a drawing to matrices. Right-handed, looking along −Z in eye space. */
#ifndef LIMNER_PLAN_CAMERA_H
#define LIMNER_PLAN_CAMERA_H

#include "limner/draw.h"
#include "plan/fit.h"
#include "pose/pose.h"

typedef struct view_camera {
    double eye[3], target[3], up[3];
    bool   orthographic;
    double fov_y;        /* radians */
    double half_height;  /* orthographic */
    double half_size[2]; /* orthographic, fitted: of what is fitted, across and up; else 0 */
    double aspect, near, far;
    bool   limited; /* near and far stay within the limits, those of a projection that was given */
    double limits[2];
    mat4   view, projection;
} view_camera;

/* Sets everything but the clip planes. `body` is what is to be fitted.
 * Errors: LMN_USAGE (eye equals target, unknown camera: nearest in the hint; matrices of no camera), LMN_UNSUPPORTED (a
 * perspective with a shifted middle). */
lmn_status camera_place(view_camera *out, const lmn_draw_desc *desc, const pose *pose, const fit_body *body,
                        lmn_error *error);

/* Where a named view's right, up and way to the eye point, unit. `up_axis`: of the scene, 'y' or 'z'. */
void camera_view_axes(lmn_view view, char up_axis, double out[3][3]);

/* Sets near and far so that they hug depths from `nearest` to `farthest` (eye depth), and the projection. */
void camera_set_range(view_camera *camera, double nearest, double farthest);

/* How large a ball around a box is on a page of this height, pixels; 0 where nothing of it is seen, infinite where it
 * may reach the eye. */
double camera_size_of(const view_camera *camera, box3 box, int height);

/* Widens a range of eye depths by the corners of a box (world axes). Start with INFINITY and −INFINITY. */
void camera_depth_range(const view_camera *camera, box3 box, double *nearest, double *farthest);

/* The pixels that a box can cover: x, y, width, height from the bottom left, `margin` pixels added. The whole
 * picture when the box reaches behind the near plane. */
void camera_pixels(const view_camera *camera, box3 box, int width, int height, int margin, int out[4]);

/* Planes through the eye around a part of the picture. */
typedef struct camera_bounds {
    double planes[4][4];
} camera_bounds;
/* Around pixels (x, y, width, height from the bottom left; width 0: all of them), and two more on each side. */
camera_bounds camera_bounds_of(const view_camera *camera, int width, int height, const int pixels[4]);
/* May anything in the box be seen there? */
bool camera_bounds_meet(const camera_bounds *bounds, box3 box);

/* Widens a box of pixels by another. */
void camera_widen_pixels(int box[4], const int other[4]);

#endif
