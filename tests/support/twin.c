#include "twin.h"

#include <stdlib.h>

#include "check.h"

static size_t at(const twin_map *m, int x, int y)
{
    x = x < 0 ? 0 : x >= m->width ? m->width - 1 : x;
    y = y < 0 ? 0 : y >= m->height ? m->height - 1 : y;
    return (size_t)y * (size_t)m->width + (size_t)x;
}

void twin_map_make(twin_map *out, const shot *s)
{
    size_t count = (size_t)s->width * (size_t)s->height;
    out->width = s->width;
    out->height = s->height;
    out->normal = check_alloc(count, sizeof *out->normal);
    out->depth = check_alloc(count, sizeof *out->depth);
    for (size_t i = 0; i < count; i++) {
        bool   empty = isinf(s->depth[i]);
        double linear = ((double)s->depth[i] - s->near_depth) / (s->far_depth - s->near_depth);
        out->depth[i] = empty ? 1 : linear;
        out->normal[i] = empty ? dvec_of(0, 0, 1) : dvec_unit(dvec_from(s->normal[i]));
    }
}

void twin_map_release(twin_map *m)
{
    free(m->normal);
    free(m->depth);
    *m = (twin_map){0};
}

void twin_sharpen(twin_map *m, double amount)
{
    size_t  count = (size_t)m->width * (size_t)m->height;
    dvec   *normal = check_alloc(count, sizeof *normal);
    double *depth = check_alloc(count, sizeof *depth);
    for (size_t i = 0; i < count; i++) {
        int x = (int)(i % (size_t)m->width), y = (int)(i / (size_t)m->width);
        normal[i] = dvec_scale(m->normal[i], 1 + 9 * amount);
        depth[i] = m->depth[i] * (1 + 9 * amount);
        for (int k = 0; k < 9; k++) {
            size_t other = at(m, x + k % 3 - 1, y + k / 3 - 1);
            normal[i] = dvec_sub(normal[i], dvec_scale(m->normal[other], amount));
            depth[i] -= amount * m->depth[other];
        }
    }
    free(m->normal);
    free(m->depth);
    m->normal = normal;
    m->depth = depth;
}

void twin_bilinear(const twin_map *m, double x, double y, dvec *normal, double *depth)
{
    double fx = floor(x - 0.5), fy = floor(y - 0.5), u = x - 0.5 - fx, v = y - 0.5 - fy;
    double weight[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    *normal = dvec_of(0, 0, 0);
    *depth = 0;
    for (int k = 0; k < 4; k++) {
        size_t i = at(m, (int)fx + (k & 1), (int)fy + (k >> 1));
        *normal = dvec_add(*normal, dvec_scale(m->normal[i], weight[k]));
        *depth += weight[k] * m->depth[i];
    }
}

static double limited(double v)
{
    return v < 0 ? 0 : v > 1 ? 1 : v;
}

twin_value twin_four_tap(const twin_map *m, int x, int y, double offset, bool squared)
{
    static const int corner[4][2] = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}}; /* A H C F */
    dvec             n[4];
    double           d[4];
    for (int k = 0; k < 4; k++) {
        twin_bilinear(m, x + 0.5 + offset * corner[k][0], y + 0.5 + offset * corner[k][1], &n[k], &d[k]);
        n[k] = dvec_unit(n[k]);
        d[k] = limited(d[k]);
    }
    double profile = (1 - 0.5 * fabs(d[0] - d[1])) * (1 - 0.5 * fabs(d[2] - d[3]));
    return (twin_value){.profile = squared ? profile * profile : profile,
                        .inner = 0.5 * (dvec_dot(n[0], n[1]) + dvec_dot(n[2], n[3]))};
}

/* Four numbers a pixel, so that one gradient serves depth and normal. */
typedef struct quad {
    double v[4];
} quad;

static quad quad_at(const twin_map *m, int x, int y)
{
    size_t i = at(m, x, y);
    return (quad){{m->normal[i].x, m->normal[i].y, m->normal[i].z, m->depth[i]}};
}

static quad quad_between(const twin_map *m, double x, double y)
{
    dvec   n;
    double d;
    twin_bilinear(m, x, y, &n, &d);
    return (quad){{n.x, n.y, n.z, d}};
}

/* Magnitudes over both directions; a unit step along an axis has gradient 4 and becomes full ink. */
static twin_value from_gradients(const double gx[4], const double gy[4])
{
    double normal = 0;
    for (int k = 0; k < 3; k++)
        normal += gx[k] * gx[k] + gy[k] * gy[k];
    return (twin_value){.profile = 1 - 0.25 * hypot(gx[3], gy[3]), .inner = 1 - 0.25 * sqrt(normal)};
}

twin_value twin_sobel_nine(const twin_map *m, int x, int y)
{
    static const double kernel[3][3] = {{-1, 0, 1}, {-2, 0, 2}, {-1, 0, 1}};
    double              gx[4] = {0}, gy[4] = {0};
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            quad q = quad_at(m, x + i - 1, y + j - 1);
            for (int k = 0; k < 4; k++) {
                gx[k] += kernel[j][i] * q.v[k];
                gy[k] += kernel[i][j] * q.v[k];
            }
        }
    return from_gradients(gx, gy);
}

twin_value twin_sobel_eight(const twin_map *m, int x, int y)
{
    double gx[4], gy[4], cx = x + 0.5, cy = y + 0.5;
    quad   t0 = quad_between(m, cx - 1, cy - 0.5), t1 = quad_between(m, cx - 1, cy + 0.5);
    quad   t2 = quad_between(m, cx + 1, cy - 0.5), t3 = quad_between(m, cx + 1, cy + 0.5);
    quad   s0 = quad_between(m, cx - 0.5, cy - 1), s1 = quad_between(m, cx + 0.5, cy - 1);
    quad   s2 = quad_between(m, cx - 0.5, cy + 1), s3 = quad_between(m, cx + 0.5, cy + 1);
    for (int k = 0; k < 4; k++) {
        gx[k] = 2 * (t2.v[k] + t3.v[k] - t0.v[k] - t1.v[k]);
        gy[k] = 2 * (s2.v[k] + s3.v[k] - s0.v[k] - s1.v[k]);
    }
    return from_gradients(gx, gy);
}

twin_value twin_sobel_five(const twin_map *m, int x, int y)
{
    double gx[4], gy[4], cx = x + 0.5, cy = y + 0.5;
    quad   tl = quad_between(m, cx - 0.5, cy - 0.5), tr = quad_between(m, cx + 0.5, cy - 0.5);
    quad   bl = quad_between(m, cx - 0.5, cy + 0.5), br = quad_between(m, cx + 0.5, cy + 0.5);
    for (int k = 0; k < 4; k++) {
        gx[k] = 4 * (tr.v[k] + br.v[k] - tl.v[k] - bl.v[k]);
        gy[k] = 4 * (bl.v[k] + br.v[k] - tl.v[k] - tr.v[k]);
    }
    return from_gradients(gx, gy);
}

/* Depths of the 3x3 neighbourhood in the order A B C D X E F G H. */
static void depths(const twin_map *m, int x, int y, double out[9])
{
    for (int k = 0; k < 9; k++)
        out[k] = limited(m->depth[at(m, x + k % 3 - 1, y + k / 3 - 1)]);
}

static double first_order(const twin_map *m, int x, int y)
{
    double d[9];
    depths(m, x, y, d);
    return (fabs(d[0] + 2 * d[1] + d[2] - d[6] - 2 * d[7] - d[8]) +
            fabs(d[2] + 2 * d[5] + d[8] - d[0] - 2 * d[3] - d[6])) /
           8;
}

static double second_order(const twin_map *m, int x, int y)
{
    double d[9], sum = 0;
    depths(m, x, y, d);
    for (int k = 0; k < 9; k++)
        sum += d[k];
    return (9 * d[4] - sum) / 3;
}

twin_value twin_saito(const twin_map *m, int x, int y)
{
    return (twin_value){.profile = 1 - first_order(m, x, y), .inner = 1 - fabs(second_order(m, x, y))};
}

twin_value twin_pencil(const twin_map *m, int x, int y, double scale)
{
    double d[9], sum = 0;
    depths(m, x, y, d);
    for (int k = 0; k < 9; k++)
        sum += (k % 2 ? 0.25 : 0.125) * fabs(d[k] - d[4]);
    return (twin_value){.profile = 1 - scale * sum, .inner = 1 - fabs(second_order(m, x, y))};
}

/* The seeds name this normalisation without a formula. Reading taken: a neighbourhood whose gradients all agree is
 * a slope and no line; the difference of its extremes is measured against the least gradient that counts as a jump,
 * and saturates; inner lines stand only where no jump is near. */
twin_value twin_saito_normalised(const twin_map *m, int x, int y, double jump, double floor_value)
{
    double least = INFINITY, greatest = 0;
    for (int k = 0; k < 9; k++) {
        int    i = x + k % 3 - 1, j = y + k / 3 - 1;
        double g = first_order(m,
                               i < 0           ? 0
                               : i >= m->width ? m->width - 1
                                               : i,
                               j < 0            ? 0
                               : j >= m->height ? m->height - 1
                                                : j);
        least = fmin(least, g);
        greatest = fmax(greatest, g);
    }
    double profile = greatest > floor_value ? (greatest - least) / fmax(greatest, jump) : 0;
    double inner = greatest >= jump ? 0 : limited(fabs(second_order(m, x, y)) / jump);
    return (twin_value){1 - profile, 1 - inner,
                        fabs(greatest - jump) < 1e-3 * jump || fabs(greatest - floor_value) < 1e-3 * floor_value};
}

/* The sample lies half a pixel up and to the right of the centre, where four pixels weigh the same. */
twin_value twin_denormal(const twin_map *m, int x, int y, double tolerance, bool with_depth)
{
    dvec   n;
    double d, c = 0, s = 0;
    twin_bilinear(m, x + 1.0, y, &n, &d);
    for (int k = 0; k < 4; k++) {
        double angle = 3.14159265358979323846 * limited(m->depth[at(m, x + (k & 1), y - (k >> 1))]);
        c += 0.25 * cos(angle);
        s += 0.25 * sin(angle);
    }
    double profile = with_depth ? 1 - 4 * (1 - (c * c + s * s + tolerance)) : 1;
    return (twin_value){.profile = profile, .inner = 1 - 4 * (1 - (dvec_dot(n, n) + tolerance))};
}

double twin_byte(double intensity)
{
    return 255 * limited(intensity);
}
