/* The directions strokes take on the page, against the principal directions of surfaces whose equation is known. Notes:
 * seed-pencil-city P23 to P27, P36. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "shape.h"
#include "shot.h"

static const double PI = 3.14159265358979323846;

/* --- bodies --------------------------------------------------------------------------------------------- */

typedef struct body {
    const char *name;
    double (*level)(dvec p);        /* 0 on the surface, negative inside */
    dvec (*at)(double u, double v); /* u, v in 0 … 1 */
    int nu, nv;
} body;

static double ellipsoid_level(dvec p)
{
    return p.x * p.x / 4 + p.y * p.y / 1.44 + p.z * p.z / 0.81 - 1;
}

static dvec ellipsoid_at(double u, double v)
{
    return dvec_of(2 * sin(PI * v) * cos(2 * PI * u), 1.2 * cos(PI * v), -0.9 * sin(PI * v) * sin(2 * PI * u));
}

static double torus_level(dvec p)
{
    double ring = sqrt(p.x * p.x + p.z * p.z) - 1.5;
    return sqrt(ring * ring + p.y * p.y) - 0.6;
}

static dvec torus_at(double u, double v)
{
    double ring = 1.5 + 0.6 * cos(2 * PI * v);
    return dvec_of(ring * cos(2 * PI * u), 0.6 * sin(2 * PI * v), ring * sin(2 * PI * u));
}

static double cylinder_level(dvec p)
{
    return sqrt(p.x * p.x + p.z * p.z) - 0.9;
}

static dvec cylinder_at(double u, double v)
{
    return dvec_of(0.9 * cos(2 * PI * u), 4 * v - 2, -0.9 * sin(2 * PI * u));
}

/* Both curvatures have signs of their own. */
static double saddle_level(dvec p)
{
    return p.z - 0.35 * p.x * p.x + 0.15 * p.y * p.y;
}

static dvec saddle_at(double u, double v)
{
    double x = 3 * u - 1.5, y = 3 * v - 1.5;
    return dvec_of(x, y, 0.35 * x * x - 0.15 * y * y);
}

static const body bodies[] = {
    {"ellipsoid", ellipsoid_level, ellipsoid_at, 240, 160},
    {"torus", torus_level, torus_at, 240, 120},
    {"cylinder", cylinder_level, cylinder_at, 240, 24},
    {"saddle", saddle_level, saddle_at, 160, 160},
};

/* Columns: where the body's axes point. */
typedef struct turn {
    dvec x, y, z;
} turn;

static turn turn_of(double about_x, double about_z)
{
    double cx = cos(about_x), sx = sin(about_x), cz = cos(about_z), sz = sin(about_z);
    return (turn){{cz, sz * cx, sz * sx}, {-sz, cz * cx, cz * sx}, {0, -sx, cx}};
}

static dvec turned(const turn *t, dvec p)
{
    return dvec_add(dvec_add(dvec_scale(t->x, p.x), dvec_scale(t->y, p.y)), dvec_scale(t->z, p.z));
}

static dvec turned_back(const turn *t, dvec p)
{
    return dvec_of(dvec_dot(t->x, p), dvec_dot(t->y, p), dvec_dot(t->z, p));
}

static dvec gradient(const body *b, dvec p)
{
    const double h = 1e-5;
    return dvec_scale(dvec_of(b->level(dvec_of(p.x + h, p.y, p.z)) - b->level(dvec_of(p.x - h, p.y, p.z)),
                              b->level(dvec_of(p.x, p.y + h, p.z)) - b->level(dvec_of(p.x, p.y - h, p.z)),
                              b->level(dvec_of(p.x, p.y, p.z + h)) - b->level(dvec_of(p.x, p.y, p.z - h))),
                      0.5 / h);
}

/* How the unit normal changes along a unit tangent. */
static dvec turn_of_normal(const body *b, dvec p, dvec tangent)
{
    const double h = 1e-4;
    return dvec_scale(dvec_sub(dvec_unit(gradient(b, dvec_add(p, dvec_scale(tangent, h)))),
                               dvec_unit(gradient(b, dvec_add(p, dvec_scale(tangent, -h))))),
                      0.5 / h);
}

/* The tangent along the greatest curvature (by size); false where both differ by less than a fifth. */
static bool greatest(const body *b, dvec p, dvec *out)
{
    dvec n = dvec_unit(gradient(b, p)),
         t1 = dvec_unit(dvec_cross(fabs(n.y) < 0.9 ? dvec_of(0, 1, 0) : dvec_of(1, 0, 0), n)), t2 = dvec_cross(n, t1);
    dvec   d1 = turn_of_normal(b, p, t1), d2 = turn_of_normal(b, p, t2);
    double a = dvec_dot(d1, t1), m = 0.5 * (dvec_dot(d1, t2) + dvec_dot(d2, t1)), c = dvec_dot(d2, t2);
    double mean = (a + c) / 2, apart = sqrt((a - c) * (a - c) / 4 + m * m),
           large = fmax(fabs(mean + apart), fabs(mean - apart)), small = fmin(fabs(mean + apart), fabs(mean - apart));
    if (large - small < 0.2 * large)
        return false;
    double angle = 0.5 * atan2(2 * m, a - c) + (mean < 0 ? PI / 2 : 0);
    *out = dvec_add(dvec_scale(t1, cos(angle)), dvec_scale(t2, sin(angle)));
    return true;
}

static void add_body(shape *s, const body *b, const turn *t)
{
    uint32_t    columns = (uint32_t)b->nu + 1, rows = (uint32_t)b->nv + 1, k = 0;
    shape_part *p = shape_add(s, b->name, columns * rows, (uint32_t)(b->nu * b->nv) * 6, true, false);
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            dvec at = b->at((double)i / b->nu, (double)j / b->nv), position = turned(t, at),
                 normal = turned(t, dvec_unit(gradient(b, at)));
            const double values[2][3] = {{position.x, position.y, position.z}, {normal.x, normal.y, normal.z}};
            for (int c = 0; c < 3; c++) {
                p->positions[j * columns + i][c] = (float)values[0][c];
                p->normals[j * columns + i][c] = (float)values[1][c];
            }
        }
    for (uint32_t j = 0; j + 1 < rows; j++)
        for (uint32_t i = 0; i + 1 < columns; i++) {
            uint32_t       a = j * columns + i;
            const uint32_t corners[6] = {a, a + columns, a + 1, a + 1, a + columns, a + columns + 1};
            for (int c = 0; c < 6; c++)
                p->indices[k++] = corners[c];
        }
}

/* --- comparing ------------------------------------------------------------------------------------------ */

static int by_size(const void *a, const void *b)
{
    double left = *(const double *)a, right = *(const double *)b;
    return left < right ? -1 : left > right;
}

/* The surface's point that a pixel's ray hits, in the body's axes; the picture's depth says which of several. */
static bool point_seen(const shot *s, const body *b, const turn *t, int x, int y, dvec *out)
{
    double depth = (double)s->depth[(size_t)y * (size_t)s->width + (size_t)x];
    if (!isfinite(depth))
        return false;
    dvec origin, direction;
    shot_ray(s, x + 0.5, y + 0.5, &origin, &direction);
    double start = -shot_to_eye(s, origin, 1).z, rate = -shot_to_eye(s, direction, 0).z, along = (depth - start) / rate;
    for (int i = 0; i < 12; i++) {
        dvec   p = turned_back(t, dvec_add(origin, dvec_scale(direction, along)));
        double slope = dvec_dot(gradient(b, p), turned_back(t, direction));
        if (fabs(slope) < 1e-9)
            return false;
        along -= b->level(p) / slope;
    }
    *out = turned_back(t, dvec_add(origin, dvec_scale(direction, along)));
    return true;
}

/* Angle on the page of a tangent at a point of the body, from the right to the top. */
static double seen_angle(const shot *s, const turn *t, dvec p, dvec tangent)
{
    dvec a = shot_project(s, turned(t, dvec_add(p, dvec_scale(tangent, 1e-4)))),
         b = shot_project(s, turned(t, dvec_add(p, dvec_scale(tangent, -1e-4))));
    return atan2(b.y - a.y, a.x - b.x);
}

static double off_by(double a, double b)
{
    double off = fabs(fmod(a - b, PI));
    return (off > PI / 2 ? PI - off : off) * 180 / PI;
}

/* The page's normal is at least so steep, and so are those some pixels around: borders are another matter. */
static bool is_inside(const shot *s, int x, int y, int margin)
{
    for (int j = -margin; j <= margin; j += margin)
        for (int i = -margin; i <= margin; i += margin) {
            if (x + i < 0 || y + j < 0 || x + i >= s->width || y + j >= s->height)
                return false;
            size_t at = (size_t)(y + j) * (size_t)s->width + (size_t)(x + i);
            if (!isfinite((double)s->depth[at]) || (double)s->normal[at][2] < 0.3)
                return false;
        }
    return true;
}

static const char form_look[] = "{\"version\":1,\"name\":\"form\",\"doc\":\"x.\",\"rules\":[{\"select\":\"*\","
                                "\"surface\":{\"technique\":\"pencil\",\"coordinates\":\"form\"}}]}";

/* Sorted errors in degrees. */
static size_t errors_of(const shot *s, const body *b, const turn *t, double **out)
{
    size_t count = 0;
    *out = check_alloc((size_t)s->width * (size_t)s->height, sizeof **out);
    for (int y = s->height - 3; y >= 0;
         y -= 4) /* pixels that the small picture is measured at: the third of four, from the bottom */
        for (int x = 2; x < s->width; x += 4) {
            dvec p, direction;
            if (!is_inside(s, x, y, 8) || !point_seen(s, b, t, x, y, &p) || !greatest(b, p, &direction))
                continue;
            const float *v = s->direction[(size_t)y * (size_t)s->width + (size_t)x];
            (*out)[count++] = off_by(0.5 * atan2((double)v[1], (double)v[0]), seen_angle(s, t, p, direction));
        }
    qsort(*out, count, sizeof **out, by_size);
    return count;
}

static void directions_on_smooth_bodies(void)
{
    static const double turns[3][2] = {{0.3, 0}, {-0.7, 0.9}, {1.2, 2.0}};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++)
        for (int k = 0; k < 6; k++) {
            turn  t = turn_of(turns[k / 2][0], turns[k / 2][1]);
            shape s = {0};
            shot  got;
            add_body(&s, &bodies[i], &t);
            const shot_view view = {.width = 560,
                                    .height = 420,
                                    .eye = {0.6, 1.1, 6},
                                    .up = {0, 1, 0},
                                    .fov_deg = 32,
                                    .orthographic = k & 1};
            if (shot_of_shape(&got, &s, "body.glb", form_look, NULL, &view) &&
                check_that("P25", got.direction != NULL, "%s: there is a map of directions", bodies[i].name)) {
                double *errors;
                size_t  count = errors_of(&got, &bodies[i], &t, &errors);
                check_at_least("P25", (double)count, 500, "%s, turn %d, %s: places compared", bodies[i].name, k / 2,
                               k & 1 ? "parallel" : "perspective");
                check_at_most("P25", count ? errors[count / 2] : 90, 1, "%s: median error of directions, degrees",
                              bodies[i].name);
                check_at_most("P25", count ? errors[count * 95 / 100] : 90, 5, "%s: 95 %% of them", bodies[i].name);
                free(errors);
            }
            shot_release(&got);
            shape_release(&s);
        }
}

/* At the page's borders fewer neighbours tell, down to its corners. */
static void directions_at_the_corners(void)
{
    const turn      t = turn_of(0.2, 0.5);
    const body     *cylinder = &bodies[2];
    const shot_view view = {
        .width = 560, .height = 420, .eye = {0, 0, 6}, .up = {0, 1, 0}, .fov_deg = 7, .orthographic = true};
    shape s = {0};
    shot  got;
    add_body(&s, cylinder, &t);
    if (shot_of_shape(&got, &s, "corners.glb", form_look, NULL, &view) &&
        check_that("P25", got.direction != NULL, "there is a map of directions")) {
        double least = 1, most = 0;
        for (int k = 0; k < 4; k++) {
            const int    x = k & 1 ? got.width - 2 : 2, y = k & 2 ? got.height - 3 : 1;
            const float *v = got.direction[(size_t)y * (size_t)got.width + (size_t)x];
            dvec         p, direction = {0, 0, 0};
            if (check_that("P25", point_seen(&got, cylinder, &t, x, y, &p) && greatest(cylinder, p, &direction),
                           "a cylinder is at the corner %d, %d", x, y)) {
                check_at_most("P25",
                              off_by(0.5 * atan2((double)v[1], (double)v[0]), seen_angle(&got, &t, p, direction)), 2,
                              "  degrees by which strokes are off there");
                least = fmin(least, hypot((double)v[0], (double)v[1]));
                most = fmax(most, hypot((double)v[0], (double)v[1]));
            }
        }
        check_at_least("P25", least / most, 0.85, "how sure they are at the one corner, over the other");
    }
    shot_release(&got);
    shape_release(&s);
}

/* --- no direction of their own -------------------------------------------------------------------------------- */

/* A ball, a box and a plane have no greatest curvature; on walls strokes run up, on level roofs along the house,
 * however it is turned. */
static void directions_where_nothing_bends(void)
{
    static const double degrees[] = {0, 20, 45, 77};
    for (int k = 0; k < 4; k++) {
        shape s = {0};
        shot  got;
        shape_box(&s, "house", dvec_of(-1, 0, -0.7), dvec_of(1, 1.6, 0.7));
        shape_place(&s, dvec_of(0, 1, 0), degrees[k], dvec_of(0, 0, 0));
        shape_sphere(&s, "ball", dvec_of(0, 2.2, 0), 0.5, 48, 96, true);
        shape_make_normals(&s, 30);
        const shot_view view = {.width = 480, .height = 360, .eye = {2, 2.4, 6}, .up = {0, 1, 0}, .fov_deg = 32};
        if (shot_of_shape(&got, &s, "plain.glb", form_look, NULL, &view)) {
            int    walls = 0, off = 0, tops = 0, tops_off = 0, bad = 0, speckles = 0;
            double first = NAN;
            for (int y = got.height - 3; y >= 2; y -= 4)
                for (int x = 2; x + 4 < got.width; x += 4) {
                    size_t at = (size_t)y * (size_t)got.width + (size_t)x;
                    if (!isfinite((double)got.depth[at]))
                        continue;
                    const float *v = got.direction[at], *next = got.direction[at + 4];
                    bad += !isfinite(v[0]) || !isfinite(v[1]) || hypot((double)v[0], (double)v[1]) < 1e-4;
                    if (got.id[at] != 1 || !is_inside(&got, x, y, 12))
                        continue;
                    /* Two faces of one box do not blend beyond their edge. */
                    dvec n = dvec_from(got.normal[at]), beside = dvec_from(got.normal[at + 12]),
                         above = dvec_from(got.normal[at - 12 * (size_t)got.width]);
                    if (dvec_dot(n, beside) < 0.9 || dvec_dot(n, above) < 0.9)
                        continue;
                    speckles += off_by(0.5 * atan2((double)v[1], (double)v[0]),
                                       0.5 * atan2((double)next[1], (double)next[0])) > 3;
                    dvec up = shot_to_eye(&got, dvec_of(0, 1, 0), 0), p = dvec_of(0, 0, 0), origin, ray;
                    shot_ray(&got, x + 0.5, y + 0.5, &origin, &ray);
                    double start = -shot_to_eye(&got, origin, 1).z, rate = -shot_to_eye(&got, ray, 0).z;
                    p = dvec_add(origin, dvec_scale(ray, ((double)got.depth[at] - start) / rate));
                    const turn none = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
                    double     own = 0.5 * atan2((double)v[1], (double)v[0]);
                    if (fabs(dvec_dot(n, up)) < 0.1) {
                        walls++;
                        off += off_by(own, seen_angle(&got, &none, p, dvec_of(0, 1, 0))) > 1;
                    } else if (dvec_dot(n, up) > 0.99) {
                        tops++;
                        double turn = degrees[k] * PI / 180,
                               off_axis = off_by(own, seen_angle(&got, &none, p, dvec_of(cos(turn), 0, -sin(turn))));
                        first = isnan(first) ? off_axis : first;
                        tops_off += off_axis > 1;
                    }
                }
            check_at_most("P27", bad, 0, "house turned by %g degrees, ball: places without a way", degrees[k]);
            check_at_most("P27", speckles, 0, "neighbours on a face that lie differently");
            check_at_least("P27", walls, 350, "places on walls");
            check_at_most("P27", off, 0, "of them whose strokes do not run up");
            check_at_most("P27", tops ? (double)tops_off / tops : 1, 0,
                          "of the roof, share whose strokes do not run along the house (%g degrees off)", first);
        }
        shot_release(&got);
        shape_release(&s);
    }
}

/* A ball bends all directions alike: strokes run up it, though rounding always leaves some direction of greatest
 * curvature. */
static void directions_on_a_ball(void)
{
    const turn none = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 2; k++) {
        shape s = {0};
        shot  got;
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1.2, 192, 384, true);
        const shot_view view = {
            .width = 480, .height = 360, .eye = {1, 1.4, 6}, .up = {0, 1, 0}, .fov_deg = 32, .orthographic = k};
        if (shot_of_shape(&got, &s, "ball.glb", form_look, NULL, &view) &&
            check_that("P27", got.direction != NULL, "there is a map of directions")) {
            int all = 0, off = 0;
            for (int y = got.height - 3; y >= 2; y -= 4)
                for (int x = 2; x < got.width; x += 4) {
                    size_t at = (size_t)y * (size_t)got.width + (size_t)x;
                    dvec   origin, ray;
                    if (!is_inside(&got, x, y, 12))
                        continue;
                    shot_ray(&got, x + 0.5, y + 0.5, &origin, &ray);
                    double start = -shot_to_eye(&got, origin, 1).z, rate = -shot_to_eye(&got, ray, 0).z;
                    dvec   p = dvec_add(origin, dvec_scale(ray, ((double)got.depth[at] - start) / rate)),
                         n = dvec_unit(p);
                    if (fabs(n.y) > 0.8) /* above it turns to an axis */
                        continue;
                    const float *v = got.direction[at];
                    all++;
                    off += off_by(0.5 * atan2((double)v[1], (double)v[0]),
                                  seen_angle(&got, &none, p, dvec_sub(dvec_of(0, 1, 0), dvec_scale(n, n.y)))) > 3;
                }
            check_at_least("P27", all, 300, "places on a ball, %s", k ? "parallel" : "perspective");
            check_at_most("P27", off, 0.02 * all, "of them whose strokes do not run up");
        }
        shot_release(&got);
        shape_release(&s);
    }
}

/* A tube has strokes around it, unless it is as thin as an edge: then they run up, as they do beside it. */
static void directions_on_thin_tubes(void)
{
    static const double radii[] = {0.3, 0.04}; /* 31 and 4 pixels */
    for (int k = 0; k < 2; k++) {
        shape s = {0};
        shot  got;
        int   all = 0, off = 0;
        shape_torus(&s, "ring", 1.2, radii[k], 400, 64);
        shape_place(&s, dvec_of(1, 0, 0), 90, dvec_of(0, 0, 0));
        const shot_view view = {
            .width = 480, .height = 360, .eye = {0, 0, 6}, .up = {0, 1, 0}, .fov_deg = 32, .orthographic = true};
        if (shot_of_shape(&got, &s, "tube.glb", form_look, NULL, &view) &&
            check_that("P27", got.direction != NULL, "there is a map of directions"))
            for (int y = got.height - 3; y >= 2; y -= 4)
                for (int x = 2; x < got.width; x += 4) {
                    size_t at = (size_t)y * (size_t)got.width + (size_t)x;
                    if (abs(y - got.height / 2) > 30 || !isfinite((double)got.depth[at]) ||
                        (double)got.normal[at][2] < 0.9)
                        continue;
                    const float *v = got.direction[at];
                    all++;
                    off += off_by(0.5 * atan2((double)v[1], (double)v[0]), k ? PI / 2 : 0) > 20;
                }
        check_at_least("P27", all, 15, "places along the crest of a tube of radius %g", radii[k]);
        check_at_most("P27", off, 0.1 * all, "of them whose strokes do not run %s", k ? "up" : "around it");
        shot_release(&got);
        shape_release(&s);
    }
}

static const check_case cases[] = {
    {"directions_on_smooth_bodies", directions_on_smooth_bodies},
    {"directions_at_the_corners", directions_at_the_corners},
    {"directions_where_nothing_bends", directions_where_nothing_bends},
    {"directions_on_a_ball", directions_on_a_ball},
    {"directions_on_thin_tubes", directions_on_thin_tubes},
};

int main(int argc, char **argv)
{
    int status = check_main(argc, argv, "pencil_directions", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
