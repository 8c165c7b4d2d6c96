#include "plan/projection.h"

#include <math.h>
#include <string.h>

#include "base/error.h"

static const double PI = 3.14159265358979323846;

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void projection_to_frame(const projection_map *m, const double world[3], double out[3])
{
    double off[3];
    for (int k = 0; k < 3; k++)
        off[k] = world[k] - m->origin[k];
    for (int k = 0; k < 3; k++)
        out[k] = dot3(m->axes[k], off);
}

void projection_to_world(const projection_map *m, const double frame[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->origin[k] + frame[0] * m->axes[0][k] + frame[1] * m->axes[1][k] + frame[2] * m->axes[2][k];
}

void projection_lean(const projection_map *m, const double way[3], double out[3])
{
    double ahead = dot3(m->axes[1], way), upward = dot3(m->axes[2], way);
    double c = cos(m->lean), s = sin(m->lean);
    for (int k = 0; k < 3; k++)
        out[k] = dot3(m->axes[0], way) * m->axes[0][k] + (ahead * c - upward * s) * m->axes[1][k] +
                 (ahead * s + upward * c) * m->axes[2][k];
}

/* Level axes, the second along the view. False: it looks straight up or down. */
static bool lay_frame(projection_map *m, const view_camera *c, int up)
{
    const double LEAST = 0.02; /* of the view's direction that is level: a degree */
    double      *right = m->axes[0], *forward = m->axes[1], *upward = m->axes[2], length = 0;
    for (int k = 0; k < 3; k++) {
        forward[k] = k == up ? 0 : -c->view.m[4 * k + 2];
        upward[k] = k == up;
        length += forward[k] * forward[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++)
        forward[k] /= length > 0 ? length : 1;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3, last = (k + 2) % 3;
        right[k] = forward[next] * upward[last] - forward[last] * upward[next];
    }
    return length >= LEAST;
}

/* How far a box reaches along an axis from the origin. */
static void reach_of(const projection_map *m, box3 box, int axis, double out[2])
{
    out[0] = INFINITY;
    out[1] = -INFINITY;
    for (int i = 0; i < 8; i++) {
        const double corner[3] = {(double)(i & 1 ? box.max.x : box.min.x), (double)(i & 2 ? box.max.y : box.min.y),
                                  (double)(i & 4 ? box.max.z : box.min.z)};
        double       at[3];
        projection_to_frame(m, corner, at);
        out[0] = fmin(out[0], at[axis]);
        out[1] = fmax(out[1], at[axis]);
    }
}

/* --- multi-perspective ---------------------------------------------------------------------------------- */

/* How far down the view looks, radians. */
static double falls(const view_camera *c, int up)
{
    return asin(fmin(fmax(c->view.m[4 * up + 2], -1), 1));
}

/* What is flat turns by less than two degrees from one piece to the next. */
enum { JOINTS = 48 };

/* Before the first joint the ground is level, behind the last one it only rises. */
static void lay_joints(projection_map *m)
{
    m->pieces = JOINTS + 1;
    m->plane_count = JOINTS;
    for (int k = 0; k < JOINTS; k++) {
        m->planes[k][0] = 0;
        m->planes[k][1] = 1;
        m->planes[k][2] = m->from + m->radius * m->angle * k / (JOINTS - 1);
    }
}

/* Where the middle ray of the view, this high over the ground, first meets it. */
static double lean_in_the_middle(const projection_map *m, double height, double down)
{
    enum { STEPS = 512 };
    for (int k = 0; k < STEPS; k++) {
        double turned = m->angle * k / STEPS, along = m->from + m->radius * sin(turned);
        if (height - along * tan(down) <= m->radius * (1 - cos(turned)))
            return turned;
    }
    return m->angle;
}

static lmn_status lay_bend(projection_map *m, const view_camera *c, box3 box, int up, const lmn_projection_desc *how,
                           lmn_draw_desc *desc, lmn_error *error)
{
    const double WANTED = 65 * PI / 180, LEAST = 10 * PI / 180, TALLEST = 0.9;
    const float  bottom[3] = {box.min.x, box.min.y, box.min.z};
    double       depth[2], height[2], down = falls(c, up);
    if (!lay_frame(m, c, up)) {
        error_set(error, LMN_USAGE, "a view from straight above or below has no distance that could be bent");
        error_hint(error, "choose a view that looks along the ground, such as --view iso, or --eye and --target");
        return LMN_USAGE;
    }
    memcpy(m->origin, c->eye, sizeof m->origin);
    m->origin[up] = (double)bottom[up];
    reach_of(m, box, 1, depth);
    reach_of(m, box, 2, height);
    /* Named views stand where the picture is fitted, outside. */
    double near = desc->eye_given && !desc->fit_direction ? fmax(depth[0], 0) : depth[0], size = depth[1] - near;
    m->angle = how->angle_deg > 0 ? how->angle_deg * PI / 180 : fmax(WANTED - down, LEAST);
    if (m->angle + down > PI / 2 + 1e-9)
        return error_set(
            error, LMN_USAGE,
            "the view looks down by %.0f degrees; with %.0f more the distance would be seen from beyond the "
            "zenith",
            down * 180 / PI, m->angle * 180 / PI);
    if (!(size > 0))
        return error_set(error, LMN_USAGE, "all of the scene lies behind the viewer");
    m->from = near + how->from * size;
    m->radius = (how->to - how->from) * size / m->angle;
    lay_joints(m);
    m->lean = lean_in_the_middle(m, c->eye[up] - m->origin[up], down);
    if (height[1] <= TALLEST * m->radius)
        return LMN_OK;
    error_set(error, LMN_UNSUPPORTED, "the scene is %.3g high, too tall for ground that bends within %.3g", height[1],
              m->radius * m->angle);
    error_hint(error, "bend it less, or over a longer way");
    return LMN_UNSUPPORTED;
}

/* Above the ground at a joint, and past it by `beyond` along the ground. */
static void at_joint(const projection_map *m, int joint, const double at[3], double beyond, double out[3])
{
    double turned = m->angle * joint / (JOINTS - 1);
    out[0] = at[0];
    out[1] = m->from + m->radius * sin(turned) + beyond * cos(turned) - at[2] * sin(turned);
    out[2] = m->radius * (1 - cos(turned)) + beyond * sin(turned) + at[2] * cos(turned);
}

/* Along the ground ways keep their length; heights stand on it. */
static void bend_ground(const projection_map *m, int piece, projection_where where, const double at[3], double out[3])
{
    double low[3], high[3];
    if (where == PROJECTION_ON_LOW)
        at_joint(m, piece - 1, at, 0, out);
    else if (where == PROJECTION_ON_HIGH)
        at_joint(m, piece, at, 0, out);
    else if (piece == 0 || piece == JOINTS)
        at_joint(m, piece ? JOINTS - 1 : 0, at, at[1] - m->planes[piece ? JOINTS - 1 : 0][2], out);
    else {
        double begin = m->planes[piece - 1][2], share = (at[1] - begin) / (m->planes[piece][2] - begin);
        at_joint(m, piece - 1, at, 0, low);
        at_joint(m, piece, at, 0, high);
        for (int k = 0; k < 3; k++)
            out[k] = (1 - share) * low[k] + share * high[k];
    }
}

/* --- panorama ------------------------------------------------------------------------------------------- */

enum { WEDGES = 360 };

/* From behind the eye on the left once around. */
static double azimuth_of(int plane)
{
    return PI * (2.0 * plane / WEDGES - 1);
}

static void lay_wedges(projection_map *m)
{
    m->pieces = m->plane_count = WEDGES;
    for (int k = 0; k < WEDGES; k++) {
        m->planes[k][0] = cos(azimuth_of(k));
        m->planes[k][1] = -sin(azimuth_of(k));
        m->planes[k][2] = 0;
    }
}

static lmn_status lay_cylinder(projection_map *m, const view_camera *c, box3 box, int up,
                               const lmn_projection_desc *how, lmn_draw_desc *desc, lmn_error *error)
{
    (void)box;
    const double STANDARD = 180, FOV_MOST = 170 * PI / 180;
    if (!desc->eye_given || desc->fit_direction || c->orthographic) {
        error_set(error, LMN_USAGE, "a panorama is seen in perspective from a place: it needs an eye");
        error_hint(error, "give --eye X,Y,Z, and --target X,Y,Z for the direction of its middle");
        return LMN_USAGE;
    }
    if (!lay_frame(m, c, up))
        return error_set(error, LMN_USAGE, "the middle of a panorama cannot lie straight above or below the eye");
    memcpy(m->origin, c->eye, sizeof m->origin);
    m->angle = (how->angle_deg > 0 ? how->angle_deg : STANDARD) / 2 * PI / 180;
    lay_wedges(m);
    double fov = 2 * atan(m->angle * desc->height / desc->width);
    if (fov > FOV_MOST)
        return error_set(error, LMN_USAGE, "a picture of %d x %d pixels is too high for %.0f degrees of the horizon",
                         desc->width, desc->height, 2 * m->angle * 180 / PI);
    desc->fov_deg = fmax(fov * 180 / PI, 1);
    for (int k = 0; k < 3; k++) {
        desc->target[k] = desc->eye[k] + m->axes[1][k];
        desc->up[k] = k == up;
    }
    return LMN_OK;
}

/* As deep as it is far, and so far to the side that its slope is its azimuth; between the rays of a wedge as these are
 * mixed. */
static void bend_round(const projection_map *m, int piece, projection_where where, const double at[3], double out[3])
{
    (void)m;
    double low = azimuth_of(piece), high = azimuth_of(piece + 1), far = hypot(at[0], at[1]), wide = sin(high - low);
    double shares[2] = {where != PROJECTION_ON_HIGH ? far : 0, where == PROJECTION_ON_HIGH ? far : 0};
    if (where == PROJECTION_BETWEEN) {
        shares[0] = (at[1] * sin(high) - at[0] * cos(high)) / wide;
        shares[1] = (at[0] * cos(low) - at[1] * sin(low)) / wide;
    }
    out[0] = shares[0] * low + shares[1] * high;
    out[1] = shares[0] + shares[1];
    out[2] = at[2];
}

/* --- the table ------------------------------------------------------------------------------------------ */

static const projection_row rows[] = {
    [LMN_PROJECTION_MULTI_PERSPECTIVE] = {.name = "multi-perspective", .lay = lay_bend, .bend = bend_ground},
    [LMN_PROJECTION_PANORAMA] = {.name = "panorama", .round = true, .lay = lay_cylinder, .bend = bend_round},
};

void projection_planes(const projection_map *m, int piece, int *low, int *high)
{
    if (m->row->round) {
        *low = piece;
        *high = (piece + 1) % m->plane_count;
    } else {
        *low = piece > 0 ? piece - 1 : PROJECTION_NO_PLANE;
        *high = piece < m->plane_count ? piece : PROJECTION_NO_PLANE;
    }
}

double projection_behind(const projection_map *m, int plane, const double at[3])
{
    const double *p = m->planes[plane];
    return p[0] * at[0] + p[1] * at[1] - p[2];
}

const projection_row *projection_row_of(int projection)
{
    return projection >= 0 && projection < (int)(sizeof rows / sizeof *rows) ? &rows[projection] : NULL;
}
