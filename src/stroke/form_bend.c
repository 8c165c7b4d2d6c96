/* Curvature from how normals differ along the edges of each face (Rusinkiewicz 2004), as a tensor of space, which
 * may be averaged where directions may not. What is smoothed is the tensor, not the surface: noise goes, positions
 * stay. */
#include "stroke/form_bend.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Curvature is smoothed over this fraction of the mesh's size. */
#define SMOOTHED_OVER 0.01
enum { SMOOTH_MIN = 2, SMOOTH_MAX = 12 };

typedef struct vector {
    double x, y, z;
} vector;

/* A symmetric tensor: xx, yy, zz, xy, yz, zx. */
typedef struct tensor {
    double t[6];
} tensor;

/* A unit basis of a face. */
typedef struct frame {
    vector u, v, n;
} frame;

typedef struct bender {
    form_surface    *s;
    const edge_mesh *m;
    tensor          *tensors, *sums; /* per knot */
    double          *weights;        /* per knot: the area around */
} bender;

static vector vector_of(vec3 p)
{
    return (vector){p.x, p.y, p.z};
}

static vector scaled(vector a, double s)
{
    return (vector){s * a.x, s * a.y, s * a.z};
}

static vector minus(vector a, vector b)
{
    return (vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vector plus(vector a, vector b)
{
    return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static double dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector cross(vector a, vector b)
{
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static vector unit(vector a)
{
    double l = sqrt(dot(a, a));
    return l > 0 ? scaled(a, 1 / l) : (vector){0, 0, 0};
}

/* Turned as one unit normal is to be turned to get to another one, the shortest way. */
static vector turned(vector a, vector from, vector to)
{
    vector axis = cross(from, to);
    double cosine = dot(from, to);
    if (cosine <= -0.999)
        return a;
    return plus(plus(scaled(a, cosine), cross(axis, a)), scaled(axis, dot(axis, a) / (1 + cosine)));
}

/* b uu + c (uv + vu) + d vv */
static tensor tensor_of(vector u, vector v, double b, double c, double d)
{
    return (tensor){
        {b * u.x * u.x + 2 * c * u.x * v.x + d * v.x * v.x, b * u.y * u.y + 2 * c * u.y * v.y + d * v.y * v.y,
         b * u.z * u.z + 2 * c * u.z * v.z + d * v.z * v.z, b * u.x * u.y + c * (u.x * v.y + u.y * v.x) + d * v.x * v.y,
         b * u.y * u.z + c * (u.y * v.z + u.z * v.y) + d * v.y * v.z,
         b * u.z * u.x + c * (u.z * v.x + u.x * v.z) + d * v.z * v.x}};
}

static double apply(const tensor *t, vector a, vector b)
{
    const double *m = t->t;
    return a.x * (m[0] * b.x + m[3] * b.y + m[5] * b.z) + a.y * (m[3] * b.x + m[1] * b.y + m[4] * b.z) +
           a.z * (m[5] * b.x + m[4] * b.y + m[2] * b.z);
}

static void add_tensor(tensor *sum, const tensor *t, double weight)
{
    for (int k = 0; k < 6; k++)
        sum->t[k] += weight * t->t[k];
}

static vector position_at(const bender *b, uint32_t face, uint32_t corner)
{
    return vector_of(b->m->positions[b->m->faces[face][corner % 3]]);
}

static vector normal_at(const bender *b, uint32_t face, uint32_t corner)
{
    return vector_of(b->s->normals[b->s->corners[face][corner % 3]]);
}

/* Returns twice the face's area. */
static double frame_of(const bender *b, uint32_t f, frame *out)
{
    vector   p = position_at(b, f, 0), n = cross(minus(position_at(b, f, 1), p), minus(position_at(b, f, 2), p));
    double   area = sqrt(dot(n, n));
    uint32_t piece = b->m->pieces[f];
    out->n = scaled(unit(n), b->m->closed[piece] && b->m->inward[piece] ? -1 : 1);
    out->u = unit(minus(position_at(b, f, 1), p));
    out->v = cross(out->n, out->u);
    return area;
}

/* --- the tensor ----------------------------------------------------------------------------------------- */

/* Symmetric 3 by 3 equations; false when they say nothing. */
static bool solve(double a[3][3], const double r[3], double out[3])
{
    double c0 = a[1][1] * a[2][2] - a[1][2] * a[2][1], c1 = a[1][2] * a[2][0] - a[1][0] * a[2][2],
           c2 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
    double whole = a[0][0] * c0 + a[0][1] * c1 + a[0][2] * c2, size = a[0][0] + a[1][1] + a[2][2];
    if (!(fabs(whole) > 1e-12 * size * size * size))
        return false;
    double d0 = a[0][2] * a[2][1] - a[0][1] * a[2][2], d1 = a[0][0] * a[2][2] - a[0][2] * a[2][0],
           d2 = a[0][1] * a[2][0] - a[0][0] * a[2][1];
    double e0 = a[0][1] * a[1][2] - a[0][2] * a[1][1], e1 = a[0][2] * a[1][0] - a[0][0] * a[1][2],
           e2 = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    out[0] = (c0 * r[0] + d0 * r[1] + e0 * r[2]) / whole;
    out[1] = (c1 * r[0] + d1 * r[1] + e1 * r[2]) / whole;
    out[2] = (c2 * r[0] + d2 * r[1] + e2 * r[2]) / whole;
    return true;
}

/* The second fundamental form that fits best how normals differ along the three edges. */
static bool face_form(const bender *b, uint32_t f, const frame *t, double out[3])
{
    double a[3][3] = {{0}}, r[3] = {0};
    for (uint32_t k = 0; k < 3; k++) {
        vector edge = minus(position_at(b, f, k + 1), position_at(b, f, k)),
               turn = minus(normal_at(b, f, k + 1), normal_at(b, f, k));
        double u = dot(edge, t->u), v = dot(edge, t->v), du = dot(turn, t->u), dv = dot(turn, t->v);
        a[0][0] += u * u;
        a[0][1] += u * v;
        a[1][1] += u * u + v * v;
        a[2][2] += v * v;
        r[0] += u * du;
        r[1] += v * du + u * dv;
        r[2] += v * dv;
    }
    a[1][0] = a[1][2] = a[2][1] = a[0][1];
    return solve(a, r, out);
}

static void gather_tensors(bender *b)
{
    for (uint32_t f = 0; f < b->s->face_count; f++) {
        frame  t;
        double form[3], area = frame_of(b, f, &t);
        if (!(area > 0) || !face_form(b, f, &t, form))
            continue;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t knot = b->s->corners[f][k];
            vector   n = normal_at(b, f, k);
            tensor   own = tensor_of(turned(t.u, t.n, n), turned(t.v, t.n, n), form[0], form[1], form[2]);
            add_tensor(&b->tensors[knot], &own, area);
            b->weights[knot] += area;
        }
    }
    for (uint32_t i = 0; i < b->s->knot_count; i++)
        for (int k = 0; k < 6 && b->weights[i] > 0; k++)
            b->tensors[i].t[k] /= b->weights[i];
}

/* A tensor of one tangent plane in another one. */
static tensor carried(const tensor *t, vector from, vector to)
{
    vector side = fabs(from.x) < 0.6 ? (vector){1, 0, 0} : (vector){0, 1, 0}, u = unit(cross(from, side)),
           v = cross(from, u);
    return tensor_of(turned(u, from, to), turned(v, from, to), apply(t, u, u), apply(t, u, v), apply(t, v, v));
}

/* Each knot gets half of what is around it, along edges. */
static void smooth_once(bender *b)
{
    const form_surface *s = b->s;
    memset(b->sums, 0, s->knot_count * sizeof *b->sums);
    memset(b->weights, 0, s->knot_count * sizeof *b->weights);
    for (uint32_t h = 0; h < 3 * s->face_count; h++) {
        uint32_t p = s->corners[h / 3][h % 3], q = s->corners[h / 3][(h + 1) % 3];
        vector   n = vector_of(s->normals[p]), o = vector_of(s->normals[q]);
        tensor   there = carried(&b->tensors[q], o, n);
        add_tensor(&b->sums[p], &there, 1);
        b->weights[p] += 1;
        if (s->opposite[h] == NO_HALF) { /* nobody comes back along this edge */
            tensor here = carried(&b->tensors[p], n, o);
            add_tensor(&b->sums[q], &here, 1);
            b->weights[q] += 1;
        }
    }
    for (uint32_t i = 0; i < s->knot_count; i++)
        for (int k = 0; k < 6 && b->weights[i] > 0; k++)
            b->tensors[i].t[k] = 0.5 * b->tensors[i].t[k] + 0.5 * b->sums[i].t[k] / b->weights[i];
}

/* As often as it takes to reach the fraction of the size: a step spreads by half an edge, steps add as squares. */
static int smoothing_steps(const bender *b)
{
    double sum = 0;
    for (uint32_t h = 0; h < 3 * b->s->face_count; h++) {
        vector edge = minus(position_at(b, h / 3, h % 3 + 1), position_at(b, h / 3, h % 3));
        sum += sqrt(dot(edge, edge));
    }
    double mean = sum / (3.0 * b->s->face_count + 1),
           steps = mean > 0 ? 4 * pow(SMOOTHED_OVER * b->s->size / mean, 2) : 0;
    return steps < SMOOTH_MIN ? SMOOTH_MIN : steps > SMOOTH_MAX ? SMOOTH_MAX : (int)steps;
}

static void find_directions(bender *b)
{
    for (uint32_t i = 0; i < b->s->knot_count; i++) {
        vector n = vector_of(b->s->normals[i]), side = fabs(n.x) < 0.6 ? (vector){1, 0, 0} : (vector){0, 1, 0},
               u = unit(cross(n, side)), v = cross(n, u);
        double uu = apply(&b->tensors[i], u, u), uv = apply(&b->tensors[i], u, v), vv = apply(&b->tensors[i], v, v);
        double angle = 0.5 * atan2(2 * uv, uu - vv), spread = 0.5 * sqrt((uu - vv) * (uu - vv) + 4 * uv * uv);
        vector d = plus(scaled(u, cos(angle)), scaled(v, sin(angle)));
        b->s->bends[i] = (surface_bend){{(float)d.x, (float)d.y, (float)d.z},
                                        (float)(0.5 * (uu + vv) + spread),
                                        (float)(0.5 * (uu + vv) - spread),
                                        {0}};
    }
}

/* --- its change ----------------------------------------------------------------------------------------- */

/* Change of the form over a face, in its basis: uuu, uuv, uvv, vvv. What the directions u v w … change to is
 * symmetric on a surface; the mean makes it so. */
static void face_change(const bender *b, uint32_t f, const frame *t, double area, double out[4])
{
    double along_u[3] = {0}, along_v[3] = {0};
    for (uint32_t k = 0; k < 3; k++) {
        vector        n = normal_at(b, f, k), u = turned(t->u, t->n, n), v = turned(t->v, t->n, n);
        const tensor *own = &b->tensors[b->s->corners[f][k]];
        const double  form[3] = {apply(own, u, u), apply(own, u, v), apply(own, v, v)};
        vector        edge = minus(position_at(b, f, k + 2), position_at(b, f, k + 1));
        /* The gradient of what is 1 at this corner and 0 at the others: the opposite edge, a quarter turn on. It is
         * the same seen from the back. */
        vector p = minus(position_at(b, f, k), position_at(b, f, k + 1)),
               g = minus(p, scaled(edge, dot(p, edge) / dot(edge, edge)));
        g = scaled(g, dot(edge, edge) / (area * area));
        for (int i = 0; i < 3; i++) {
            along_u[i] += form[i] * dot(g, t->u);
            along_v[i] += form[i] * dot(g, t->v);
        }
    }
    out[0] = along_u[0];
    out[1] = (along_v[0] + 2 * along_u[1]) / 3;
    out[2] = (along_u[2] + 2 * along_v[1]) / 3;
    out[3] = along_v[2];
}

/* A symmetric form of three directions, each given by its fractions of u and v. */
static double apply_change(const double c[4], const double p[2], const double q[2], const double r[2])
{
    return c[0] * p[0] * q[0] * r[0] + c[1] * (p[1] * q[0] * r[0] + p[0] * q[1] * r[0] + p[0] * q[0] * r[1]) +
           c[2] * (p[0] * q[1] * r[1] + p[1] * q[0] * r[1] + p[1] * q[1] * r[0]) + c[3] * p[1] * q[1] * r[1];
}

static void gather_changes(bender *b)
{
    memset(b->sums, 0, b->s->knot_count * sizeof *b->sums); /* four of the six numbers are used */
    memset(b->weights, 0, b->s->knot_count * sizeof *b->weights);
    for (uint32_t f = 0; f < b->s->face_count; f++) {
        frame  t;
        double change[4], area = frame_of(b, f, &t);
        if (!(area > 0))
            continue;
        face_change(b, f, &t, area, change);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t knot = b->s->corners[f][k];
            vector   n = normal_at(b, f, k), u = turned(t.u, t.n, n), v = turned(t.v, t.n, n),
                   d = vector_of(b->s->bends[knot].direction), e = cross(n, d);
            const double p[2] = {dot(d, u), dot(d, v)}, q[2] = {dot(e, u), dot(e, v)};
            double      *sum = b->sums[knot].t;
            sum[0] += area * apply_change(change, p, p, p);
            sum[1] += area * apply_change(change, p, p, q);
            sum[2] += area * apply_change(change, p, q, q);
            sum[3] += area * apply_change(change, q, q, q);
            b->weights[knot] += area;
        }
    }
    for (uint32_t i = 0; i < b->s->knot_count; i++)
        for (int k = 0; k < 4; k++)
            b->s->bends[i].change[k] = b->weights[i] > 0 ? (float)(b->sums[i].t[k] / b->weights[i]) : 0;
}

bool form_bend_make(form_surface *s, const edge_mesh *m)
{
    bender b = {.s = s, .m = m};
    size_t count = (size_t)s->knot_count + 1;
    b.tensors = mem_calloc(count, sizeof *b.tensors);
    b.sums = mem_calloc(count, sizeof *b.sums);
    b.weights = mem_calloc(count, sizeof *b.weights);
    s->bends = mem_calloc(count, sizeof *s->bends);
    bool good = b.tensors && b.sums && b.weights && s->bends;
    if (good) {
        gather_tensors(&b);
        for (int steps = smoothing_steps(&b); steps > 0; steps--)
            smooth_once(&b);
        find_directions(&b);
        gather_changes(&b);
    }
    mem_free(b.tensors);
    mem_free(b.sums);
    mem_free(b.weights);
    return good;
}
