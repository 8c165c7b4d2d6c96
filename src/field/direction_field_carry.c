/* Directions for positions that have none of their own: from the nearest sure position, over the surface; where a piece
 * is flat, one for all of it. */
#include <string.h>

#include "base/memory.h"
#include "field/direction_field_private.h"

enum { STEPS_OF_CARRYING = 8 };

static const double sure_from = 0.1; /* below, a direction of its own fades out as a carried one fades in */
static const double carried = 0.05;  /* how sure those are */

typedef struct carrier {
    const field_surface *surface;
    const bool          *flat;
    tensor              *own, *units; /* units: directions as unit tensors, valid where reached */
    tensor              *flow;
    double              *distances;
    bool                *reached, *sure;
    uint32_t            *pieces, *queue; /* per element: number of its flat piece */
    near_queue           near;
} carrier;

static double sureness(const tensor *t)
{
    double sum = 0;
    for (int k = 0; k < 6; k++)
        sum += (k < 3 ? 1 : 2) * (double)t->v[k] * (double)t->v[k];
    return sqrt(sum / 2);
}

/* The tensor laid into an element's tangent plane, as sure as can be; false when nothing is left of it. */
static bool unit_in_plane(point3 normal, const tensor *t, tensor *out)
{
    point3 u, v;
    double a, b;
    tangents(normal, &u, &v);
    tensor_traceless(t, u, v, &a, &b);
    double length = hypot(a, b);
    if (!(length > 1e-9))
        return false;
    *out = tensor_of(u, v, a / length, b / length, 0);
    return true;
}

/* Offers the direction of e to its neighbours. */
static bool offer(carrier *c, uint32_t e, double distance, bool into_flat)
{
    const field_surface *s = c->surface;
    for (uint32_t i = s->starts[e]; i < s->starts[e + 1]; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t n = s->corners[s->around[i] / 3 * 3 + k];
            if (c->reached[n] || (c->flat[n] && !into_flat))
                continue;
            double far = distance + point_length(point_sub(s->positions[n], s->positions[e]));
            if (far >= c->distances[n] || !unit_in_plane(s->normals[n], &c->units[e], &c->units[n]))
                continue;
            c->distances[n] = far;
            if (!near_push(&c->near, far, n))
                return false;
        }
    return true;
}

/* From all that is reached into all that is not. */
static bool spread(carrier *c, bool into_flat)
{
    c->near.count = 0;
    for (uint32_t e = 0; e < c->surface->element_count; e++)
        c->distances[e] = INFINITY;
    /* Units of positions that are not reached yet are overwritten with each nearer offer; the nearest is the last. */
    for (uint32_t e = 0; e < c->surface->element_count; e++)
        if (c->reached[e] && !offer(c, e, 0, into_flat))
            return false;
    while (c->near.count > 0) {
        near_position p = near_pop(&c->near);
        if (c->reached[p.element])
            continue;
        c->reached[p.element] = true;
        if (!offer(c, p.element, p.distance, into_flat))
            return false;
    }
    return true;
}

/* What is summed over a flat piece, or over a piece of surface on which nothing was sure. */
typedef struct shape {
    point3 normal, mean;
    double area, covariance[6]; /* xx, yy, zz, xy, yz, zx */
    tensor bend;                /* of the sure positions around */
    double bend_weight;
    double border_cos, border_sin, border; /* edges turned by four times their angle */
} shape;

static bool in_piece(const carrier *c, uint32_t t, uint32_t piece)
{
    const uint32_t *k = c->surface->corners + 3 * (size_t)t;
    return c->pieces[k[0]] == piece && c->pieces[k[1]] == piece && c->pieces[k[2]] == piece;
}

/* Collects the elements of a piece in the queue: flat ones that touch, or unreached ones. */
static uint32_t collect(carrier *c, uint32_t first, uint32_t piece)
{
    const field_surface *s = c->surface;
    uint32_t             end = 0;
    c->pieces[first] = piece;
    c->queue[end++] = first;
    for (uint32_t begin = 0; begin < end; begin++) {
        uint32_t e = c->queue[begin];
        for (uint32_t i = s->starts[e]; i < s->starts[e + 1]; i++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t n = s->corners[s->around[i] / 3 * 3 + k];
                if (c->pieces[n] != NOWHERE || c->reached[n] || c->flat[n] != c->flat[first])
                    continue;
                c->pieces[n] = piece;
                c->queue[end++] = n;
            }
    }
    return end;
}

/* Calls for each triangle around the collected elements once: at its first corner that is in the piece. */
static bool is_first_of(const carrier *c, uint32_t corner, uint32_t piece)
{
    for (uint32_t h = corner / 3 * 3; h < corner; h++)
        if (c->pieces[c->surface->corners[h]] == piece)
            return false;
    return true;
}

static point3 centre_of(const field_surface *s, uint32_t t)
{
    const uint32_t *k = s->corners + 3 * (size_t)t;
    return point_scale(point_add(point_add(s->positions[k[0]], s->positions[k[1]]), s->positions[k[2]]), 1.0 / 3);
}

static void measure_middle(const carrier *c, uint32_t count, uint32_t piece, shape *out)
{
    const field_surface *s = c->surface;
    for (uint32_t q = 0; q < count; q++)
        for (uint32_t i = s->starts[c->queue[q]]; i < s->starts[c->queue[q] + 1]; i++) {
            uint32_t t = s->around[i] / 3;
            if (!is_first_of(c, s->around[i], piece))
                continue;
            double area = s->areas[t] + 1e-30;
            out->normal = point_add(out->normal, point_scale(s->directions[t], s->turned[t] ? -area : area));
            out->mean = point_add(out->mean, point_scale(centre_of(s, t), area));
            out->area += area;
        }
    out->mean = point_scale(out->mean, 1 / out->area);
    out->normal = point_unit_or(out->normal, s->normals[c->queue[0]]);
}

static void add_spread(shape *out, point3 p, double weight)
{
    point3       d = point_sub(p, out->mean);
    const double products[6] = {d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
    for (int k = 0; k < 6; k++)
        out->covariance[k] += weight * products[k];
}

static void add_border(shape *out, point3 edge, point3 u, point3 v)
{
    double x = point_dot(edge, u), y = point_dot(edge, v), length = hypot(x, y), angle = 4 * atan2(y, x);
    out->border_cos += length * cos(angle);
    out->border_sin += length * sin(angle);
    out->border += length;
}

static void measure_triangle(const carrier *c, uint32_t t, uint32_t piece, point3 u, point3 v, shape *out)
{
    const field_surface *s = c->surface;
    bool                 inside = in_piece(c, t, piece);
    for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
        uint32_t e = s->corners[h], next = s->corners[h % 3 == 2 ? h - 2 : h + 1], o = s->opposite[h];
        add_spread(out, s->positions[e], s->areas[t]);
        if (inside && (o == NOWHERE || !in_piece(c, o / 3, piece)))
            add_border(out, point_sub(s->positions[next], s->positions[e]), u, v);
        if (!c->reached[e] || c->pieces[e] == piece)
            continue;
        double weight = sqrt(s->areas[t]);
        for (int k = 0; k < 6; k++)
            out->bend.v[k] += (float)weight * c->units[e].v[k];
        out->bend_weight += weight;
    }
}

static void measure(const carrier *c, uint32_t count, uint32_t piece, shape *out)
{
    const field_surface *s = c->surface;
    point3               u, v;
    memset(out, 0, sizeof *out);
    measure_middle(c, count, piece, out);
    tangents(out->normal, &u, &v);
    for (uint32_t q = 0; q < count; q++)
        for (uint32_t i = s->starts[c->queue[q]]; i < s->starts[c->queue[q] + 1]; i++)
            if (is_first_of(c, s->around[i], piece))
                measure_triangle(c, s->around[i] / 3, piece, u, v, out);
    /* Where all sides are alike, rounding must not choose: x before y before z. */
    double trace = out->covariance[0] + out->covariance[1] + out->covariance[2] + 1e-30;
    out->covariance[0] += 0.01 * trace;
    out->covariance[1] += 0.005 * trace;
}

static double covariance_apply(const double m[6], point3 a, point3 b)
{
    return m[0] * a.x * b.x + m[1] * a.y * b.y + m[2] * a.z * b.z + m[3] * (a.x * b.y + a.y * b.x) +
           m[4] * (a.y * b.z + a.z * b.y) + m[5] * (a.z * b.x + a.x * b.z);
}

/* The one direction of a flat piece. */
static tensor flat_direction(const shape *piece)
{
    tensor out;
    point3 u, v;
    tangents(piece->normal, &u, &v);
    if (piece->bend_weight > 0) {
        double a, b;
        tensor_traceless(&piece->bend, u, v, &a, &b);
        if (hypot(a, b) > 0.6 * piece->bend_weight && unit_in_plane(piece->normal, &piece->bend, &out))
            return out;
    }
    double difference = (covariance_apply(piece->covariance, u, u) - covariance_apply(piece->covariance, v, v)) / 2;
    double angle = atan2(covariance_apply(piece->covariance, u, v), difference) / 2;
    /* A border of right angles says more than how far the piece reaches: that of an L is askew. */
    if (hypot(piece->border_cos, piece->border_sin) > 0.5 * piece->border) {
        double straight = atan2(piece->border_sin, piece->border_cos) / 4;
        point3 one = point_add(point_scale(u, cos(straight)), point_scale(v, sin(straight)));
        point3 other = point_cross(piece->normal, one);
        bool   turn = covariance_apply(piece->covariance, other, other) > covariance_apply(piece->covariance, one, one);
        angle = straight + (turn ? 1.57079632679489662 : 0);
    }
    return tensor_of(u, v, cos(2 * angle), sin(2 * angle), 0);
}

static void decide_flat_pieces(carrier *c)
{
    const field_surface *s = c->surface;
    uint32_t             piece = 0;
    memset(c->pieces, 0xFF, s->element_count * sizeof *c->pieces);
    for (uint32_t e = 0; e < s->element_count; e++) {
        if (!c->flat[e] || c->pieces[e] != NOWHERE)
            continue;
        shape    all;
        uint32_t count = collect(c, e, piece);
        measure(c, count, piece++, &all);
        tensor direction = flat_direction(&all);
        for (uint32_t q = 0; q < count; q++)
            if (!unit_in_plane(s->normals[c->queue[q]], &direction, &c->units[c->queue[q]]))
                c->units[c->queue[q]] = (tensor){{0}};
    }
    for (uint32_t e = 0; e < s->element_count; e++)
        c->reached[e] = c->reached[e] || c->flat[e];
}

/* The direction in which a covariance is greatest, by repeated multiplication. */
static point3 longest_axis(const double m[6])
{
    point3 axis = {1, 0.9, 0.8};
    for (int i = 0; i < 400; i++)
        axis = point_unit_or((point3){m[0] * axis.x + m[3] * axis.y + m[5] * axis.z,
                                      m[3] * axis.x + m[1] * axis.y + m[4] * axis.z,
                                      m[5] * axis.x + m[4] * axis.y + m[2] * axis.z},
                             (point3){1, 0, 0});
    return axis;
}

/* A ball has no direction at all: lines towards the ends of its longest axis. */
static void decide_round_pieces(carrier *c)
{
    const field_surface *s = c->surface;
    uint32_t             piece = 0;
    memset(c->pieces, 0xFF, s->element_count * sizeof *c->pieces);
    for (uint32_t e = 0; e < s->element_count; e++) {
        if (c->reached[e] || c->pieces[e] != NOWHERE)
            continue;
        shape    all;
        uint32_t count = collect(c, e, piece);
        measure(c, count, piece++, &all);
        point3 axis = longest_axis(all.covariance);
        tensor along = tensor_of(axis, (point3){0, 0, 0}, 1, 0, 0);
        for (uint32_t q = 0; q < count; q++)
            if (!unit_in_plane(s->normals[c->queue[q]], &along, &c->units[c->queue[q]]))
                c->units[c->queue[q]] = (tensor){{0}};
    }
}

static void mix(carrier *c)
{
    const field_surface *s = c->surface;
    for (int i = 0; i < STEPS_OF_CARRYING; i++)
        field_smooth(s, c->units, c->flow, c->sure);
    for (uint32_t e = 0; e < s->element_count; e++) {
        double sure = sureness(&c->own[e]), a, b;
        point3 u, v;
        if (sure >= sure_from)
            continue;
        tangents(s->normals[e], &u, &v);
        tensor_traceless(&c->units[e], u, v, &a, &b);
        double kept = smooth_step(0, sure_from, sure), given = carried * (1 - kept);
        tensor other = tensor_of(u, v, a * given, b * given, 0);
        for (int k = 0; k < 6; k++)
            c->own[e].v[k] = (float)kept * c->own[e].v[k] + other.v[k];
    }
}

static bool carry(carrier *c)
{
    const field_surface *s = c->surface;
    for (uint32_t e = 0; e < s->element_count; e++) {
        c->sure[e] = sureness(&c->own[e]) >= sure_from && !c->flat[e];
        c->reached[e] = c->sure[e] && unit_in_plane(s->normals[e], &c->own[e], &c->units[e]);
        c->sure[e] = c->reached[e];
    }
    if (!spread(c, false))
        return false;
    decide_flat_pieces(c);
    if (!spread(c, true))
        return false;
    decide_round_pieces(c);
    mix(c);
    return true;
}

bool field_carry(const field_surface *s, tensor *own, const bool *flat)
{
    size_t  count = s->element_count;
    carrier c = {.surface = s, .own = own, .flat = flat};
    c.units = mem_calloc(count, sizeof *c.units);
    c.flow = mem_alloc(s->triangle_count * sizeof *c.flow);
    c.distances = mem_alloc(count * sizeof *c.distances);
    c.reached = mem_calloc(count, sizeof *c.reached);
    c.sure = mem_calloc(count, sizeof *c.sure);
    c.pieces = mem_alloc(count * sizeof *c.pieces);
    c.queue = mem_alloc(count * sizeof *c.queue);
    bool        good = c.units && c.flow && c.distances && c.reached && c.sure && c.pieces && c.queue && carry(&c);
    void *const blocks[] = {c.units, c.flow, c.distances, c.reached, c.sure, c.pieces, c.queue, c.near.items};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    return good;
}
