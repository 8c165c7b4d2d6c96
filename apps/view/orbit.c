#include "orbit.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double STANDARD_FOV_DEG = 30;
static const double FILL = 0.9; /* of the frame, as the command fits */

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* From axes with Y up to those of the scene. */
static void to_scene(char up, const double v[3], double out[3])
{
    out[0] = v[0];
    out[1] = up == 'z' ? -v[2] : v[1];
    out[2] = up == 'z' ? v[1] : v[2];
}

static void from_scene(char up, const double v[3], double out[3])
{
    out[0] = v[0];
    out[1] = up == 'z' ? v[2] : v[1];
    out[2] = up == 'z' ? -v[1] : v[2];
}

orbit orbit_make(char up)
{
    orbit o = {.distance = 1, .fov_deg = STANDARD_FOV_DEG, .up = up};
    orbit_turn_to(&o, LMN_VIEW_ISO);
    return o;
}

void orbit_turn_to(orbit *o, lmn_view view)
{
    static const double angles[][2] = {
        [LMN_VIEW_ISO] = {45, 0},   [LMN_VIEW_FRONT] = {0, 0}, [LMN_VIEW_BACK] = {180, 0},   [LMN_VIEW_LEFT] = {-90, 0},
        [LMN_VIEW_RIGHT] = {90, 0}, [LMN_VIEW_TOP] = {0, 90},  [LMN_VIEW_BOTTOM] = {0, -90},
    };
    o->yaw = angles[view][0] * PI / 180;
    o->pitch = view == LMN_VIEW_ISO ? atan(sqrt(0.5)) : angles[view][1] * PI / 180;
}

void orbit_axes(const orbit *o, double right[3], double up[3], double forward[3])
{
    double sy = sin(o->yaw), cy = cos(o->yaw), sp = sin(o->pitch), cp = cos(o->pitch);
    /* The up vector is the direction's change with pitch: it is there at the poles, too. */
    const double r[3] = {cy, 0, -sy}, u[3] = {-sp * sy, cp, -sp * cy}, f[3] = {-cp * sy, -sp, -cp * cy};
    to_scene(o->up, r, right);
    to_scene(o->up, u, up);
    to_scene(o->up, f, forward);
}

void orbit_eye(const orbit *o, double eye[3])
{
    double right[3], up[3], forward[3];
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++)
        eye[k] = o->target[k] - o->distance * forward[k];
}

/* Half the picture's height at the target, in the scene's unit. */
static double half_height(const orbit *o)
{
    return o->distance * tan(o->fov_deg * PI / 360);
}

void orbit_fit(orbit *o, const double box_min[3], const double box_max[3], int width, int height)
{
    double right[3], up[3], forward[3], extent = 0, needed = 0;
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++) {
        o->target[k] = (box_min[k] + box_max[k]) / 2;
        extent = fmax(extent, box_max[k] - box_min[k]);
    }
    double ty = tan(o->fov_deg * PI / 360) * FILL, tx = ty * width / height;
    for (int i = 0; i < 8; i++) {
        double v[3];
        for (int k = 0; k < 3; k++)
            v[k] = (i >> k & 1 ? box_max[k] : box_min[k]) - o->target[k];
        double z = o->orthographic ? 0 : dot3(v, forward);
        needed = fmax(needed, fmax(fabs(dot3(v, right)) / tx, fabs(dot3(v, up)) / ty) - z);
    }
    o->distance = needed > 0 && isfinite(needed) ? needed : extent > 0 ? extent : 1;
}

/* Pitch stays between the poles, yaw within a turn. */
static void settle(orbit *o)
{
    o->pitch = fmin(fmax(o->pitch, -PI / 2), PI / 2);
    o->yaw = remainder(o->yaw, 2 * PI);
}

void orbit_turn(orbit *o, double dx, double dy, int height)
{
    double by = PI / height; /* the whole height is half a turn */
    o->yaw -= dx * by;
    o->pitch += dy * by;
    settle(o);
}

static void move(orbit *o, double to_right, double to_up, double to_front)
{
    double right[3], up[3], forward[3];
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++)
        o->target[k] += to_right * right[k] + to_up * up[k] + to_front * forward[k];
}

void orbit_pan(orbit *o, double dx, double dy, int height)
{
    double by = 2 * half_height(o) / height;
    move(o, -dx * by, dy * by, 0);
}

void orbit_zoom(orbit *o, double factor, double x, double y, int width, int height)
{
    double by = 2 * half_height(o) / height, rest = 1 - factor;
    move(o, (x - width / 2.0) * by * rest, (height / 2.0 - y) * by * rest, 0);
    o->distance = fmin(fmax(o->distance * factor, 1e-9), 1e12);
}

void orbit_walk(orbit *o, double forward, double right, double up)
{
    move(o, right, up, forward);
}

void orbit_look(orbit *o, double dx, double dy, int height)
{
    double eye[3], right[3], up[3], forward[3];
    orbit_eye(o, eye);
    double by = o->fov_deg * PI / 180 / height;
    o->yaw -= dx * by;
    o->pitch += dy * by;
    settle(o);
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++)
        o->target[k] = eye[k] + o->distance * forward[k];
}

void orbit_place(orbit *o, const double eye[3], const double target[3])
{
    double v[3], d[3];
    for (int k = 0; k < 3; k++)
        v[k] = eye[k] - target[k];
    from_scene(o->up, v, d);
    double length = sqrt(dot3(d, d));
    if (!(length > 0) || !isfinite(length))
        return;
    memcpy(o->target, target, sizeof o->target);
    o->distance = length;
    o->pitch = asin(fmin(fmax(d[1] / length, -1), 1));
    if (fabs(d[0]) + fabs(d[2]) > 1e-9 * length)
        o->yaw = atan2(d[0], d[2]);
}

bool orbit_project(const orbit *o, const double point[3], int width, int height, double pixel[2])
{
    double right[3], up[3], forward[3], eye[3], v[3];
    orbit_axes(o, right, up, forward);
    orbit_eye(o, eye);
    for (int k = 0; k < 3; k++)
        v[k] = point[k] - eye[k];
    double depth = dot3(v, forward);
    if (!o->orthographic && depth <= 0)
        return false;
    double half = o->orthographic ? half_height(o) : depth * tan(o->fov_deg * PI / 360);
    pixel[0] = width / 2.0 + dot3(v, right) / half * height / 2;
    pixel[1] = height / 2.0 - dot3(v, up) / half * height / 2;
    return true;
}

void orbit_ray(const orbit *o, double x, double y, int width, int height, double origin[3], double direction[3])
{
    double right[3], up[3], forward[3];
    orbit_axes(o, right, up, forward);
    orbit_eye(o, origin);
    double by = 2 * half_height(o) / height, to_right = (x - width / 2.0) * by, to_up = (height / 2.0 - y) * by;
    for (int k = 0; k < 3; k++) {
        double across = to_right * right[k] + to_up * up[k];
        direction[k] = o->orthographic ? forward[k] : forward[k] + across / o->distance;
        origin[k] += o->orthographic ? across : 0;
    }
}

void orbit_describe(const orbit *o, lmn_draw_desc *desc)
{
    double right[3], forward[3];
    orbit  placed = *o;
    /* Parallel rays have no angle of view: the command measures them by the standard one. */
    if (o->orthographic) {
        placed.fov_deg = STANDARD_FOV_DEG;
        placed.distance = half_height(o) / tan(STANDARD_FOV_DEG * PI / 360);
    }
    desc->eye_given = true;
    orbit_eye(&placed, desc->eye);
    memcpy(desc->target, o->target, sizeof desc->target);
    orbit_axes(o, right, desc->up, forward);
    desc->fov_deg = placed.fov_deg;
    desc->orthographic = o->orthographic;
}
