/* What turns about an axis and lies all around it, as wheels, gears and discs do. That is a matter of space: seen
 * aslant a wheel is no circle, and edge-on nothing of it turns on the page. */
#include "trace/trace_private.h"

#include <math.h>

/* A turn counts from so many radians on; what goes along its axis as it turns goes less far than this fraction of what
 * its rim does. */
#define LEAST_TURN 1e-4
#define SCREW      0.3
/* It lies all around where in nearly all sectors it reaches so far, radii. */
#define REACHES 0.6
enum { SECTORS = 36, SECTORS_ROUND = 32, EDGE_SAMPLES = 8 };
/* Its nearer end, of what reaches so far, and a little before it, radii: there circles about it are seen. */
#define WIDE       0.9
#define BEFORE_END 0.03
static const double pi = 3.14159265358979323846;

typedef struct axis_frame {
    double axis[3], u[3], v[3], point[3];
} axis_frame;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Two directions across an axis. */
static void span(axis_frame *f)
{
    const double *a = f->axis, other[3] = {fabs(a[0]) < 0.6, fabs(a[0]) >= 0.6, 0};
    cross(a, other, f->u);
    double length = sqrt(dot(f->u, f->u));
    for (int k = 0; k < 3; k++)
        f->u[k] /= length;
    cross(a, f->u, f->v);
}

/* The axis about which a map turns, and how far; false: it does not, or does more. */
static bool find_axis(const mat4 *map, axis_frame *f, double *turn, double *along)
{
    const double *m = map->m;
    double        sine[3] = {m[6] - m[9], m[8] - m[2], m[1] - m[4]}, trace = m[0] + m[5] + m[10],
           length = sqrt(dot(sine, sine));
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (fabs(dot(m + 4 * i, m + 4 * k) - (i == k)) > 0.01)
                return false;
    *turn = atan2(length, trace - 1);
    if (!(*turn > LEAST_TURN) || !(length > 1e-9))
        return false;
    for (int k = 0; k < 3; k++)
        f->axis[k] = sine[k] / length;
    /* p = R p + t, across the axis: p = (t + cot(turn / 2) a × t) / 2. */
    double across[3], turned[3];
    *along = dot(m + 12, f->axis);
    for (int k = 0; k < 3; k++)
        across[k] = m[12 + k] - *along * f->axis[k];
    cross(f->axis, across, turned);
    for (int k = 0; k < 3; k++)
        f->point[k] = 0.5 * (across[k] + turned[k] / tan(*turn / 2));
    span(f);
    return true;
}

/* How far from the axis a body reaches in each sector; of what is farther than `wide`, from where to where along it. */
static double look_around(const trace_body *b, const trace_bodies *all, const stroke_camera *camera,
                          const axis_frame *f, double wide, double reach[SECTORS], double ends[2])
{
    double radius = 0;
    ends[0] = INFINITY;
    ends[1] = -INFINITY;
    for (uint32_t i = 3 * b->first; i < 3 * (b->first + b->count); i++) {
        double corners[2][3];
        for (int k = 0; k < 2; k++)
            page_unproject(camera, all->now[all->triangles[i / 3][(i + (uint32_t)k) % 3]], corners[k]);
        for (int n = 0; n < EDGE_SAMPLES; n++) {
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = corners[0][k] + (double)n / EDGE_SAMPLES * (corners[1][k] - corners[0][k]) - f->point[k];
            double x = dot(p, f->u), y = dot(p, f->v), s = dot(p, f->axis), r = hypot(x, y);
            int    sector = (int)fmin((atan2(y, x) + pi) / (2 * pi) * SECTORS, SECTORS - 1);
            reach[sector] = fmax(reach[sector], r);
            radius = fmax(radius, r);
            if (r >= wide) {
                ends[0] = fmin(ends[0], s);
                ends[1] = fmax(ends[1], s);
            }
        }
    }
    return radius;
}

bool body_turns(trace_body *b, const trace_bodies *all, const pose *now, const pose *before, double fraction,
                const stroke_camera *camera)
{
    mat4       back = mat4_inverse(&before->worlds[b->node]), map = mat4_multiply(&now->worlds[b->node], &back);
    axis_frame f;
    double     turn, along, reach[SECTORS] = {0}, ends[2], page[2][3];
    int        count = 0;
    if (!find_axis(&map, &f, &turn, &along))
        return false;
    b->radius = look_around(b, all, camera, &f, 0, reach, ends);
    for (int i = 0; i < SECTORS; i++)
        count += reach[i] >= REACHES * b->radius;
    if (count < SECTORS_ROUND || fabs(along) > SCREW * turn * b->radius)
        return false;
    look_around(b, all, camera, &f, WIDE * b->radius, reach, ends);
    vec3 at[2];
    for (int k = 0; k < 2; k++) {
        double s = ends[k] + (k ? BEFORE_END : -BEFORE_END) * b->radius;
        at[k] = (vec3){(float)(f.point[0] + s * f.axis[0]), (float)(f.point[1] + s * f.axis[1]),
                       (float)(f.point[2] + s * f.axis[2])};
        if (!page_project(camera, at[k], page[k]))
            return false;
    }
    int nearer = page[1][2] < page[0][2];
    b->pivot = at[nearer];
    b->axis = (vec3){(float)f.axis[0], (float)f.axis[1], (float)f.axis[2]};
    b->turn = turn / fraction;
    b->motion = MOVES_AROUND;
    b->centre[0] = page[nearer][0];
    b->centre[1] = page[nearer][1];
    b->zero = 0;
    return true;
}

vec3 body_circle(const trace_body *b, double radius, double angle)
{
    axis_frame f = {.axis = {(double)b->axis.x, (double)b->axis.y, (double)b->axis.z}};
    double     x = radius * cos(angle), y = radius * sin(angle);
    span(&f);
    return (vec3){(float)((double)b->pivot.x + x * f.u[0] + y * f.v[0]),
                  (float)((double)b->pivot.y + x * f.u[1] + y * f.v[1]),
                  (float)((double)b->pivot.z + x * f.u[2] + y * f.v[2])};
}
