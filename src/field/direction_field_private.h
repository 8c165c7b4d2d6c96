/* Inside the scene folder: a surface on which fields live and patches grow. Corners at one position are one element
 * as long as no feature edge separates them; copies of a triangle are left out, and windings that disagree are
 * turned, so that neighbours' normals can be compared. */
#ifndef LIMNER_FIELD_DIRECTION_FIELD_PRIVATE_H
#define LIMNER_FIELD_DIRECTION_FIELD_PRIVATE_H

#include <math.h>

#include "base/smooth_step.h"
#include "field/connection.h"
#include "field/direction_field.h"

#define NOWHERE UINT32_MAX

typedef struct point3 {
    double x, y, z;
} point3;

/* A symmetric tensor: xx, yy, zz, xy, yz, zx. */
typedef struct tensor {
    float v[6];
} tensor;

typedef struct field_surface {
    uint32_t  triangle_count, element_count;
    uint32_t *triangles;       /* per triangle: the primitive's triangle */
    uint32_t *kept;            /* per triangle of the primitive: ours, NOWHERE for those that are degenerate */
    uint32_t *ids;             /* per vertex of the primitive: the first vertex at its position */
    uint32_t *corners;         /* 3 per triangle: elements */
    uint32_t *opposite;        /* 3 per triangle: the half-edge on the other side, NOWHERE at borders and features */
    uint32_t *starts, *around; /* around[starts[e]] … around[starts[e + 1] − 1]: the corners of element e */
    point3   *positions;       /* per element; the primitive's box has its centre at 0 and the diagonal 1 */
    point3   *normals;         /* per element, unit */
    point3   *directions;      /* per triangle: unit normal by its own winding, 0 without an area */
    double   *areas;           /* per triangle */
    bool     *features;        /* 3 per triangle: the half-edge is a feature edge, not a border */
    bool     *turned;          /* per triangle: its winding disagrees with the first of its piece */
    double    size, mean_edge; /* the diagonal in model units; the mean length of an edge, diagonal 1 */
    bool      cut;             /* some edge is sharper than the feature angle */
    double    rounding;        /* what a float rounds away from positions, diagonal 1 */
} field_surface;

/* Positions in the order of their distances; free `items`. */
typedef struct near_position {
    double   distance;
    uint32_t element;
} near_position;

typedef struct near_queue {
    near_position *items;
    size_t         count, capacity;
} near_queue;

bool          near_push(near_queue *q, double distance, uint32_t element); /* false when memory is gone */
near_position near_pop(near_queue *q);                                     /* only when there is one */

/* Errors: LMN_MEMORY; then there is nothing to release. */
lmn_status field_surface_make(field_surface *out, const primitive *p, double feature_angle, lmn_error *error);
void       field_surface_release(field_surface *s);

/* The element of a corner of the primitive, NOWHERE if its triangle was left out. */
uint32_t field_surface_element(const field_surface *s, const primitive *p, uint32_t corner);

/* One step of smoothing: to the triangles, and back by area. `flow` has room for a tensor a triangle. */
void field_smooth(const field_surface *s, tensor *values, tensor *flow, const bool *fixed);

/* The tensor laid into an element's tangent plane, as sure as can be; false when nothing is left of it. */
bool field_unit_in_plane(point3 normal, const tensor *t, tensor *out);

/* Gives each flat element the direction of its piece, as a unit tensor: that of the sure elements around it, else that
 * of its border, along its longer side. False when memory is gone. */
bool field_flat_directions(const field_surface *s, const bool *flat, const bool *sure, tensor *units);

/* What is summed over a flat piece. */
typedef struct flat_shape {
    point3 normal, mean;
    double area, covariance[6]; /* xx, yy, zz, xy, yz, zx */
    tensor bend;                /* of the sure positions around */
    double bend_weight;
    double border_cos, border_sin, border; /* edges turned by four times their angle */
} flat_shape;

/* The piece's normal and middle must be known. A triangle is the middles of its edges, each with its area: these have
 * its moments, however a piece is triangulated. */
void flat_shape_add(flat_shape *out, point3 p, double weight);
void flat_shape_add_border(flat_shape *out, point3 edge, point3 u, point3 v);
/* Where all sides are alike, rounding must not choose: x before y before z. */
void flat_shape_settle(flat_shape *out);
/* The direction of what bends around the piece, as a unit tensor; false: nothing does, or not one way. */
bool flat_shape_bend(const flat_shape *piece, tensor *out);
/* The one direction of the piece, as a unit tensor: that, or one by its shape. */
tensor flat_shape_direction(const flat_shape *piece);

/* Planes of a surface: what is even from border to border, however it is triangulated and whatever bends beside it. */
typedef struct field_planes {
    uint32_t *of;    /* per triangle: its plane, NOWHERE for what is none */
    tensor   *units; /* per plane: its direction, a unit tensor */
    uint32_t  count;
} field_planes;
/* `tensors`: of elements, with `flat` saying which of them know nothing of their own. Pieces that lie in one plane have
 * the direction of the largest of them. False when memory is gone or work is to stop; release it in any case. */
bool field_planes_find(field_planes *out, const field_surface *s, const tensor *tensors, const bool *flat);
void field_planes_release(field_planes *p);

/* From what elements know, tensors T, a cross field over all of them, and which of the arms of each cross is meant;
 * out: what is to stand there. What rough surfaces know is trusted less. False when memory is gone or work is to stop.
 */
bool field_cross(const field_surface *s, tensor *own, const bool *flat, bool rough);
/* Islands of arms that lie across those around go over to these, as long as that joins more than what their elements
 * wish (`g->source`) holds. False when memory is gone or work is to stop. */
bool field_join_arms(const connection *g, complex_number *arms);

static inline point3 point_add(point3 a, point3 b)
{
    return (point3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline point3 point_sub(point3 a, point3 b)
{
    return (point3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline point3 point_scale(point3 a, double f)
{
    return (point3){a.x * f, a.y * f, a.z * f};
}

static inline double point_dot(point3 a, point3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline point3 point_cross(point3 a, point3 b)
{
    return (point3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline uint32_t field_next_half(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static inline point3 field_edge_middle(const field_surface *s, uint32_t h)
{
    return point_scale(point_add(s->positions[s->corners[h]], s->positions[s->corners[field_next_half(h)]]), 0.5);
}

static inline double point_length(point3 a)
{
    return sqrt(point_dot(a, a));
}

static inline point3 point_unit_or(point3 a, point3 otherwise)
{
    double length = point_length(a);
    return length > 0 && isfinite(length) ? point_scale(a, 1 / length) : otherwise;
}

/* Two unit tangents that with the normal make a right-handed frame. */
static inline void tangents(point3 normal, point3 *u, point3 *v)
{
    point3 axis = fabs(normal.x) < 0.6 ? (point3){1, 0, 0} : (point3){0, 1, 0};
    *u = point_unit_or(point_cross(axis, normal), (point3){0, 0, 1});
    *v = point_cross(normal, *u);
}

static inline double tensor_apply(const tensor *t, point3 a, point3 b)
{
    const float *v = t->v;
    return (double)v[0] * a.x * b.x + (double)v[1] * a.y * b.y + (double)v[2] * a.z * b.z +
           (double)v[3] * (a.x * b.y + a.y * b.x) + (double)v[4] * (a.y * b.z + a.z * b.y) +
           (double)v[5] * (a.z * b.x + a.x * b.z);
}

/* a (u uᵀ − v vᵀ) + b (u vᵀ + v uᵀ) + c (u uᵀ + v vᵀ) */
static inline tensor tensor_of(point3 u, point3 v, double a, double b, double c)
{
    double p = c + a, q = c - a;
    return (tensor){{(float)(p * u.x * u.x + q * v.x * v.x + 2 * b * u.x * v.x),
                     (float)(p * u.y * u.y + q * v.y * v.y + 2 * b * u.y * v.y),
                     (float)(p * u.z * u.z + q * v.z * v.z + 2 * b * u.z * v.z),
                     (float)(p * u.x * u.y + q * v.x * v.y + b * (u.x * v.y + u.y * v.x)),
                     (float)(p * u.y * u.z + q * v.y * v.z + b * (u.y * v.z + u.z * v.y)),
                     (float)(p * u.z * u.x + q * v.z * v.x + b * (u.z * v.x + u.x * v.z))}};
}

/* What of a tensor lies in the plane of u and v and has no trace: a and b of tensor_of. */
static inline void tensor_traceless(const tensor *t, point3 u, point3 v, double *a, double *b)
{
    *a = (tensor_apply(t, u, u) - tensor_apply(t, v, v)) / 2;
    *b = tensor_apply(t, u, v);
}

#endif
