#include "moving.h"

#include <math.h>
#include <string.h>

/* --- shapes --------------------------------------------------------------------------------------------- */

static void normalise(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

/* Along the path at a point: the mean of the directions before and after it. */
static void tangent(const double (*points)[3], int count, int i, double out[3])
{
    double before[3] = {0}, after[3] = {0};
    for (int k = 0; k < 3; k++) {
        before[k] = i > 0 ? points[i][k] - points[i - 1][k] : points[1][k] - points[0][k];
        after[k] = i + 1 < count ? points[i + 1][k] - points[i][k] : before[k];
    }
    normalise(before);
    normalise(after);
    for (int k = 0; k < 3; k++)
        out[k] = before[k] + after[k];
    normalise(out);
}

static void close_end(mesh *m, const ring *r, bool back)
{
    for (int i = 2; i < r->count; i++)
        put_triangle(m, r->at[0], r->at[back ? i : i - 1], r->at[back ? i - 1 : i]);
}

void tube(mesh *m, const double (*points)[3], int count, const double normal[3], double radius, int sides)
{
    const frame f = {.along = FRONT};
    ring        before = {0};
    for (int i = 0; i < count; i++) {
        double t[3];
        ring   here = {.count = sides};
        tangent(points, count, i, t);
        double across[3] = {t[1] * normal[2] - t[2] * normal[1], t[2] * normal[0] - t[0] * normal[2],
                            t[0] * normal[1] - t[1] * normal[0]};
        for (int j = 0; j < sides; j++) {
            double angle = 2 * PI * (j + 0.5) / sides, at[3];
            for (int k = 0; k < 3; k++)
                at[k] = points[i][k] + radius * (cos(angle) * across[k] - sin(angle) * normal[k]);
            here.at[j] = put_point(m, &f, at[0], at[1], at[2]);
        }
        if (i > 0)
            sew(m, &before, &here);
        if (i == 0 || i == count - 1)
            close_end(m, &here, i == 0);
        before = here;
    }
}

int arc_points(double (*points)[3], int had, const double middle[3], int u, int v, double radius, double from,
               double to, int segments)
{
    for (int i = 0; i <= segments; i++, had++) {
        double angle = (from + (to - from) * i / segments) * PI / 180;
        memcpy(points[had], middle, sizeof points[had]);
        points[had][u] += radius * cos(angle);
        points[had][v] += radius * sin(angle);
    }
    return had;
}

void bevelled_plate(mesh *m, const outline *whole, const outline *inset, double from, double to, double bevel)
{
    const frame f = {.along = FRONT};
    ring        rings[4] = {put_ring(m, &f, inset, from), put_ring(m, &f, whole, from + bevel),
                            put_ring(m, &f, whole, to - bevel), put_ring(m, &f, inset, to)};
    for (int k = 0; k < 3; k++)
        sew(m, &rings[k], &rings[k + 1]);
    cap(m, BACK, &rings[0], NULL, 0);
    cap(m, FRONT, &rings[3], NULL, 0);
}

static outline link_outline(double length, double from_radius, double to_radius)
{
    enum { ROUND = 24 };
    double  lean = asin((from_radius - to_radius) / length) * 180 / PI; /* the sides touch both circles */
    outline o = {0};
    add_arc(&o, length, 0, to_radius, -90 + lean, 90 - lean, ROUND);
    add_arc(&o, 0, 0, from_radius, 90 - lean, 270 + lean, ROUND);
    return o;
}

void link_plate(mesh *m, double length, double from_radius, double to_radius, double from, double to, double bevel)
{
    outline whole = link_outline(length, from_radius, to_radius),
            inset = link_outline(length, from_radius - bevel, to_radius - bevel);
    bevelled_plate(m, &whole, &inset, from, to, bevel);
}

static void add_corner(outline *o, const double *before, const double *at, const double *after)
{
    enum { ROUND = 6 };
    double a[2] = {before[0] - at[0], before[1] - at[1]}, b[2] = {after[0] - at[0], after[1] - at[1]};
    double a_size = hypot(a[0], a[1]), b_size = hypot(b[0], b[1]);
    for (int k = 0; k < 2; k++) {
        a[k] /= a_size;
        b[k] /= b_size;
    }
    double half = acos(a[0] * b[0] + a[1] * b[1]) / 2, off = at[2] / sin(half), reach = at[2] / tan(half);
    double size = hypot(a[0] + b[0], a[1] + b[1]), middle[2];
    for (int k = 0; k < 2; k++)
        middle[k] = at[k] + off * (a[k] + b[k]) / size;
    double from = atan2(at[1] + reach * a[1] - middle[1], at[0] + reach * a[0] - middle[0]);
    double to = atan2(at[1] + reach * b[1] - middle[1], at[0] + reach * b[0] - middle[0]);
    if (to - from > PI)
        to -= 2 * PI;
    if (to - from < -PI)
        to += 2 * PI;
    add_arc(o, middle[0], middle[1], at[2], from * 180 / PI, to * 180 / PI, ROUND);
}

outline rounded(const double (*corners)[3], int count)
{
    outline o = {0};
    for (int i = 0; i < count; i++) {
        if (corners[i][2] > 0)
            add_corner(&o, corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]);
        else
            add_point(&o, corners[i][0], corners[i][1]);
    }
    return o;
}

void turn_about(mesh *m, uint32_t kept, int axis, double degrees, double x, double y, double z)
{
    double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180), by[3] = {x, y, z};
    int    p = (axis + 1) % 3, q = (axis + 2) % 3;
    for (uint32_t i = kept; i < m->point_count; i++) {
        int32_t *at = m->points[i].at;
        double   u = at[p], v = at[q];
        at[axis] = (int32_t)lround(at[axis] + by[axis] * GRID);
        at[p] = (int32_t)lround(c * u - s * v + by[p] * GRID);
        at[q] = (int32_t)lround(s * u + c * v + by[q] * GRID);
    }
}

/* --- clips ---------------------------------------------------------------------------------------------- */

track *clip_add(clip *c, int node, const char *path)
{
    if (c->count == TRACKS_MAX)
        give_up();
    track *t = &c->tracks[c->count++];
    *t = (track){.node = node, .path = path};
    return t;
}

/* Rounded, so that every machine writes the same. */
static void add_key(track *t, double time, const double *value, int numbers)
{
    if (t->count == KEYS_MAX)
        give_up();
    for (int k = 0; k < numbers; k++)
        t->values[t->count * numbers + k] = (float)(round(value[k] * 1e6) / 1e6);
    t->times[t->count++] = (float)(round(time * 1e6) / 1e6);
}

void track_translation(track *t, double time, double x, double y, double z)
{
    add_key(t, time, (const double[]){x, y, z}, 3);
}

void track_rotation(track *t, double time, const double quaternion[4])
{
    add_key(t, time, quaternion, 4);
}

void track_angle(track *t, double time, int axis, double angle)
{
    double q[4] = {0, 0, 0, cos(angle / 2)};
    q[axis] = sin(angle / 2);
    add_key(t, time, q, 4);
}

/* Cubic tracks are added three keys at a time, all with the same time. */
static int put_input(glb *g, const track *t)
{
    float times[KEYS_MAX];
    int   step = t->cubic ? 3 : 1, count = t->count / step;
    for (int i = 0; i < count; i++)
        times[i] = t->times[i * step];
    return glb_put_floats(g, times, (uint32_t)count, 1, "SCALAR", 0);
}

static void put_clip(glb *g, FILE *json, const clip *c)
{
    fprintf(json, "{\"name\":\"%s\",\"samplers\":[", c->name);
    for (int i = 0; i < c->count; i++) {
        const track *t = &c->tracks[i];
        int          numbers = strcmp(t->path, "rotation") == 0 ? 4 : 3, input = put_input(g, t);
        int output = glb_put_floats(g, t->values, (uint32_t)t->count, numbers, numbers == 4 ? "VEC4" : "VEC3", 0);
        fprintf(json, "%s{\"input\":%d,\"output\":%d%s}", i ? "," : "", input, output,
                t->cubic ? ",\"interpolation\":\"CUBICSPLINE\"" : "");
    }
    fprintf(json, "],\"channels\":[");
    for (int i = 0; i < c->count; i++)
        fprintf(json, "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"%s\"}}", i ? "," : "", i, c->tracks[i].node,
                c->tracks[i].path);
    fprintf(json, "]}");
}

void put_clips(glb *g, FILE *json, const clip *clips, int count)
{
    fprintf(json, "\"animations\":[");
    for (int i = 0; i < count; i++) {
        if (i)
            fprintf(json, ",");
        put_clip(g, json, &clips[i]);
    }
    fprintf(json, "],");
}
