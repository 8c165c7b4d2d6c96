/* Flat pieces of a surface: one direction for all of each. */
#include <string.h>

#include "base/memory.h"
#include "field/direction_field_private.h"

typedef struct flat_walk {
    const field_surface *surface;
    const bool          *flat;
    const tensor        *units;          /* of elements that bend: unit tensors, where they are sure of them */
    const bool          *reached;        /* those */
    uint32_t            *pieces, *queue; /* per element: number of its flat piece */
} flat_walk;

static bool in_piece(const flat_walk *c, uint32_t t, uint32_t piece)
{
    const uint32_t *k = c->surface->corners + 3 * (size_t)t;
    return c->pieces[k[0]] == piece && c->pieces[k[1]] == piece && c->pieces[k[2]] == piece;
}

/* Collects the elements of a piece in the queue: flat ones that touch. */
static uint32_t collect(flat_walk *c, uint32_t first, uint32_t piece)
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
                if (c->pieces[n] != NOWHERE || !c->flat[n])
                    continue;
                c->pieces[n] = piece;
                c->queue[end++] = n;
            }
    }
    return end;
}

/* Calls for each triangle around the collected elements once: at its first corner that is in the piece. */
static bool is_first_of(const flat_walk *c, uint32_t corner, uint32_t piece)
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

static void measure_middle(const flat_walk *c, uint32_t count, uint32_t piece, flat_shape *out)
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

void flat_shape_settle(flat_shape *out)
{
    double trace = out->covariance[0] + out->covariance[1] + out->covariance[2] + 1e-30;
    out->covariance[0] += 0.01 * trace;
    out->covariance[1] += 0.005 * trace;
}

void flat_shape_add(flat_shape *out, point3 p, double weight)
{
    point3       d = point_sub(p, out->mean);
    const double products[6] = {d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
    for (int k = 0; k < 6; k++)
        out->covariance[k] += weight * products[k];
}

void flat_shape_add_border(flat_shape *out, point3 edge, point3 u, point3 v)
{
    double x = point_dot(edge, u), y = point_dot(edge, v), length = hypot(x, y), angle = 4 * atan2(y, x);
    out->border_cos += length * cos(angle);
    out->border_sin += length * sin(angle);
    out->border += length;
}

static void measure_triangle(const flat_walk *c, uint32_t t, uint32_t piece, point3 u, point3 v, flat_shape *out)
{
    const field_surface *s = c->surface;
    bool                 inside = in_piece(c, t, piece);
    for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
        uint32_t e = s->corners[h], next = s->corners[field_next_half(h)], o = s->opposite[h];
        flat_shape_add(out, field_edge_middle(s, h), s->areas[t]);
        if (inside && (o == NOWHERE || !in_piece(c, o / 3, piece)))
            flat_shape_add_border(out, point_sub(s->positions[next], s->positions[e]), u, v);
        if (!c->reached[e] || c->pieces[e] == piece)
            continue;
        double weight = sqrt(s->areas[t]);
        for (int k = 0; k < 6; k++)
            out->bend.v[k] += (float)weight * c->units[e].v[k];
        out->bend_weight += weight;
    }
}

static void measure(const flat_walk *c, uint32_t count, uint32_t piece, flat_shape *out)
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
    flat_shape_settle(out);
}

static double covariance_apply(const double m[6], point3 a, point3 b)
{
    return m[0] * a.x * b.x + m[1] * a.y * b.y + m[2] * a.z * b.z + m[3] * (a.x * b.y + a.y * b.x) +
           m[4] * (a.y * b.z + a.z * b.y) + m[5] * (a.z * b.x + a.x * b.z);
}

bool flat_shape_bend(const flat_shape *piece, tensor *out)
{
    point3 u, v;
    double a, b;
    tangents(piece->normal, &u, &v);
    tensor_traceless(&piece->bend, u, v, &a, &b);
    return piece->bend_weight > 0 && hypot(a, b) > 0.6 * piece->bend_weight &&
           field_unit_in_plane(piece->normal, &piece->bend, out);
}

tensor flat_shape_direction(const flat_shape *piece)
{
    tensor out;
    point3 u, v;
    if (flat_shape_bend(piece, &out))
        return out;
    tangents(piece->normal, &u, &v);
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

bool field_flat_directions(const field_surface *s, const bool *flat, const bool *sure, tensor *units)
{
    flat_walk c = {.surface = s, .flat = flat, .units = units, .reached = sure};
    c.pieces = mem_alloc(s->element_count * sizeof *c.pieces);
    c.queue = mem_alloc(s->element_count * sizeof *c.queue);
    bool     good = c.pieces && c.queue;
    uint32_t piece = 0;
    if (good)
        memset(c.pieces, 0xFF, s->element_count * sizeof *c.pieces);
    for (uint32_t e = 0; good && e < s->element_count; e++) {
        if (!flat[e] || c.pieces[e] != NOWHERE)
            continue;
        flat_shape all;
        uint32_t   count = collect(&c, e, piece);
        measure(&c, count, piece++, &all);
        tensor direction = flat_shape_direction(&all);
        for (uint32_t q = 0; q < count; q++)
            if (!field_unit_in_plane(s->normals[c.queue[q]], &direction, &units[c.queue[q]]))
                units[c.queue[q]] = (tensor){{0}};
    }
    mem_free(c.pieces);
    mem_free(c.queue);
    return good;
}
