/* One patch: a map of geodesics from a seed, steered by the field, then evened out by least squares. */
#include "base/memory.h"
#include "field/lapped_private.h"

enum { RELAXING = 20 };

static flat_position flat_add(flat_position a, flat_position b, double factor)
{
    return (flat_position){a.x + factor * b.x, a.y + factor * b.y};
}

static double flat_length(flat_position a)
{
    return sqrt(a.x * a.x + a.y * a.y);
}

/* How far the segment passes from 0. */
static double segment_distance(flat_position a, flat_position b)
{
    flat_position d = flat_add(b, a, -1);
    double        square = d.x * d.x + d.y * d.y, t = square > 0 ? -(a.x * d.x + a.y * d.y) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return flat_length(flat_add(a, d, t));
}

/* A tangent carried from one tangent plane to the next, turned as little as possible. */
static point3 carry_tangent(point3 axis, point3 from, point3 to)
{
    point3 turn = point_cross(from, to);
    double cosine = point_dot(from, to);
    if (cosine < -0.99)
        return axis;
    point3 once = point_cross(turn, axis), twice = point_cross(turn, once);
    return point_add(point_add(axis, once), point_scale(twice, 1 / (1 + cosine)));
}

/* An edge in the frame of one of its ends, as long as it is. */
static flat_position in_frame(point3 edge, point3 normal, point3 axis)
{
    flat_position p = {point_dot(edge, axis), point_dot(edge, point_cross(normal, axis))};
    double        flat = flat_length(p), length = point_length(edge);
    return flat > 1e-12 ? (flat_position){p.x * length / flat, p.y * length / flat} : (flat_position){0, 0};
}

static flat_position edge_direction(const field_surface *s, const patch_vertex *from, const patch_vertex *to)
{
    point3        edge = point_sub(s->positions[to->element], s->positions[from->element]);
    flat_position a = in_frame(edge, s->normals[from->element], from->axis),
                  b = in_frame(edge, s->normals[to->element], to->axis);
    flat_position sum = flat_add(a, b, 1);
    double        flat = flat_length(sum), length = point_length(edge);
    return flat > 1e-12 * length ? (flat_position){sum.x * length / flat, sum.y * length / flat} : a;
}

static bool may_use(const patch_ground *g, uint32_t triangle)
{
    return !g->only_uncovered || !g->covered[triangle];
}

/* Steers a carried axis to the field, as much as the field is sure. The field's line has two ends: the one nearer
 * to the carried axis counts. Beyond the patch, where only the ends of long triangles lie, the field is none of its
 * business: steered there, such triangles would be sheared. */
static point3 steer(const patch_ground *g, uint32_t element, point3 axis, double distance)
{
    point3 n = g->surface->normals[element], d = g->axes[element];
    axis = point_unit_or(point_sub(axis, point_scale(n, point_dot(n, axis))), d);
    double cosine = point_dot(axis, d), sine = point_dot(point_cross(n, axis), d);
    if (cosine < 0) {
        cosine = -cosine;
        sine = -sine;
    }
    double angle = atan2(sine, cosine);
    angle *= (double)g->sure[element] * (1 - smooth_step(0.8, 1.3, fabs(angle))) *
             (1 - smooth_step(g->radius, 1.5 * g->radius, distance));
    return point_add(point_scale(axis, cos(angle)), point_scale(point_cross(n, axis), sin(angle)));
}

/* The patch's number of an element, made when it is new; NOWHERE when memory is gone. */
static uint32_t local_number(patch_ground *g, uint32_t element)
{
    if (g->local[element] != NOWHERE)
        return g->local[element];
    if (!mem_grow((void **)&g->vertices, &g->vertex_capacity, g->vertex_count + 1, sizeof *g->vertices))
        return NOWHERE;
    g->vertices[g->vertex_count] = (patch_vertex){.element = element};
    return g->local[element] = (uint32_t)g->vertex_count++;
}

static const patch_vertex *settled(const patch_ground *g, uint32_t element)
{
    uint32_t l = g->local[element];
    return l != NOWHERE && g->vertices[l].settled ? &g->vertices[l] : NULL;
}

/* Offers the third corners of triangles around an element that have two settled ones. */
static bool offer_around(patch_ground *g, uint32_t element, double radius)
{
    const field_surface *s = g->surface;
    const patch_vertex   own = *settled(g, element);
    for (uint32_t i = s->starts[element]; i < s->starts[element + 1]; i++) {
        uint32_t t = s->around[i] / 3, at = s->around[i] % 3;
        if (!may_use(g, t))
            continue;
        for (uint32_t k = 1; k < 3; k++) {
            uint32_t            other = s->corners[3 * t + (at + k) % 3], third = s->corners[3 * t + (at + 3 - k) % 3];
            const patch_vertex *b = settled(g, other);
            if (!b || settled(g, third) || segment_distance(own.position, b->position) >= radius)
                continue;
            flat_position guess = flat_add(
                own.position,
                in_frame(point_sub(s->positions[third], s->positions[element]), s->normals[element], own.axis), 1);
            if (!near_push(&g->near, flat_length(guess), third))
                return false;
        }
    }
    return true;
}

/* Lays an element by its settled neighbours. */
static bool settle(patch_ground *g, uint32_t element, double distance)
{
    const field_surface *s = g->surface;
    point3               axis = {0, 0, 0};
    flat_position        sum = {0, 0};
    double               weights = 0;
    uint32_t             l = local_number(g, element);
    if (l == NOWHERE)
        return false;
    for (int turn = 0; turn < 2; turn++) {
        for (uint32_t i = s->starts[element]; i < s->starts[element + 1]; i++)
            for (uint32_t k = 1; k < 3; k++) {
                uint32_t            t = s->around[i] / 3, other = s->corners[3 * t + (s->around[i] % 3 + k) % 3];
                const patch_vertex *from = settled(g, other);
                if (!from || other == element || !may_use(g, t))
                    continue;
                double length = point_length(point_sub(s->positions[element], s->positions[other])),
                       weight = 1 / (length + 1e-12);
                if (turn == 0) {
                    axis = point_add(
                        axis, point_scale(carry_tangent(from->axis, s->normals[other], s->normals[element]), weight));
                    continue;
                }
                sum = flat_add(sum, flat_add(from->position, edge_direction(s, from, &g->vertices[l]), 1), weight);
                weights += weight;
            }
        if (turn == 0)
            g->vertices[l].axis = steer(g, element, axis, distance);
    }
    g->vertices[l].position = weights > 0 ? (flat_position){sum.x / weights, sum.y / weights} : (flat_position){0, 0};
    g->vertices[l].settled = true;
    return true;
}

static bool lay_seed(patch_ground *g, uint32_t seed)
{
    const field_surface *s = g->surface;
    const uint32_t      *corners = s->corners + 3 * (size_t)seed;
    point3               axis = {0, 0, 0}, middle = {0, 0, 0}, n = s->directions[seed];
    const double         fractions[3] = {1 - g->middle.x - g->middle.y, g->middle.x, g->middle.y};
    uint32_t             surest = corners[0];
    for (int k = 0; k < 3; k++) {
        middle = point_add(middle, point_scale(s->positions[corners[k]], fractions[k]));
        if (g->sure[corners[k]] > g->sure[surest])
            surest = corners[k];
    }
    n = point_dot(n, n) > 0 ? point_scale(n, s->turned[seed] ? -1 : 1) : s->normals[surest];
    for (int k = 0; k < 3; k++) {
        point3 d = g->axes[corners[k]];
        axis = point_add(
            axis, point_scale(d, (0.01 + (double)g->sure[corners[k]]) * (point_dot(d, g->axes[surest]) < 0 ? -1 : 1)));
    }
    axis = point_sub(axis, point_scale(n, point_dot(n, axis)));
    point3 fallback, unused;
    tangents(n, &fallback, &unused);
    axis = point_unit_or(axis, fallback);
    for (int k = 0; k < 3; k++) {
        uint32_t l = local_number(g, corners[k]);
        if (l == NOWHERE)
            return false;
        point3 away = point_sub(s->positions[corners[k]], middle);
        g->vertices[l].position = (flat_position){point_dot(away, axis), point_dot(away, point_cross(n, axis))};
        g->vertices[l].axis = steer(g, corners[k], carry_tangent(axis, n, s->normals[corners[k]]), point_length(away));
        g->vertices[l].settled = true;
    }
    return true;
}

void patch_positions(const patch_ground *g, uint32_t triangle, flat_position out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = g->vertices[g->local[g->surface->corners[3 * (size_t)triangle + (size_t)k]]].position;
}

double patch_stretch(const patch_ground *g, uint32_t triangle)
{
    const field_surface *s = g->surface;
    const uint32_t      *corners = s->corners + 3 * (size_t)triangle;
    flat_position        flat[3];
    patch_positions(g, triangle, flat);
    point3 n = s->directions[triangle], a = point_sub(s->positions[corners[1]], s->positions[corners[0]]);
    point3 b = point_sub(s->positions[corners[2]], s->positions[corners[0]]), u = point_unit_or(a, (point3){1, 0, 0});
    if (point_dot(n, n) == 0)
        return 1;
    double        length = point_dot(a, u), bx = point_dot(b, u), by = point_dot(b, point_cross(n, u));
    flat_position p = flat_add(flat[1], flat[0], -1), q = flat_add(flat[2], flat[0], -1);
    /* Columns of the map from the triangle's plane to the patch's. */
    flat_position c0 = {p.x / length, p.y / length}, c1 = {(q.x - c0.x * bx) / by, (q.y - c0.y * bx) / by};
    double        determinant = (c0.x * c1.y - c0.y * c1.x) * (s->turned[triangle] ? -1 : 1);
    double        half = (c0.x * c0.x + c0.y * c0.y + c1.x * c1.x + c1.y * c1.y) / 2,
           root = sqrt(fmax(0, half * half - determinant * determinant));
    double most = sqrt(half + root), least = most > 0 ? fabs(determinant) / most : 0;
    if (!(determinant > 0) || !(least > 0))
        return INFINITY;
    return fmax(most, 1 / least);
}

static bool reaches_disc(const flat_position c[3], double radius)
{
    double nearest =
        fmin(fmin(segment_distance(c[0], c[1]), segment_distance(c[1], c[2])), segment_distance(c[2], c[0]));
    if (nearest < radius)
        return true;
    double a = c[0].x * c[1].y - c[0].y * c[1].x, b = c[1].x * c[2].y - c[1].y * c[2].x,
           d = c[2].x * c[0].y - c[2].y * c[0].x;
    return (a >= 0 && b >= 0 && d >= 0) || (a <= 0 && b <= 0 && d <= 0);
}

/* The triangles that hang together with the seed, lie well and reach the disc. */
static bool gather(patch_ground *g, uint32_t seed, double radius)
{
    const field_surface *s = g->surface;
    g->round++;
    g->triangle_count = 0;
    g->stamps[seed] = g->round;
    if (!mem_grow((void **)&g->triangles, &g->triangle_capacity, 1, sizeof *g->triangles))
        return false;
    g->triangles[g->triangle_count++] = seed;
    for (size_t i = 0; i < g->triangle_count; i++)
        for (uint32_t h = 3 * g->triangles[i]; h < 3 * g->triangles[i] + 3; h++) {
            uint32_t      o = s->opposite[h], t = o / 3;
            flat_position positions[3];
            if (o == NOWHERE || g->stamps[t] == g->round || !may_use(g, t) || !settled(g, s->corners[3 * t]) ||
                !settled(g, s->corners[3 * t + 1]) || !settled(g, s->corners[3 * t + 2]))
                continue;
            g->stamps[t] = g->round;
            patch_positions(g, t, positions);
            if (!reaches_disc(positions, radius) || patch_stretch(g, t) > STRETCH_MAX)
                continue;
            if (!mem_grow((void **)&g->triangles, &g->triangle_capacity, g->triangle_count + 1, sizeof *g->triangles))
                return false;
            g->triangles[g->triangle_count++] = t;
        }
    return true;
}

/* Cotangent of the corner across an edge, within bounds that keep weights positive. */
static double edge_weight(const field_surface *s, uint32_t a, uint32_t b, uint32_t across)
{
    point3 u = point_sub(s->positions[a], s->positions[across]), v = point_sub(s->positions[b], s->positions[across]);
    double cotangent = point_dot(u, v) / (point_length(point_cross(u, v)) + 1e-30);
    return fmin(fmax(cotangent, 0.05), 5);
}

static bool list_edges(patch_ground *g)
{
    const field_surface *s = g->surface;
    g->edge_count = 0;
    if (!mem_grow((void **)&g->edges, &g->edge_capacity, 3 * g->triangle_count, sizeof *g->edges) ||
        !mem_grow((void **)&g->kept, &g->kept_capacity, g->vertex_count, sizeof *g->kept))
        return false;
    for (size_t i = 0; i < g->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t     *c = s->corners + 3 * (size_t)g->triangles[i];
            uint32_t            a = c[k], b = c[(k + 1) % 3], across = c[(k + 2) % 3];
            const patch_vertex *from = &g->vertices[g->local[a]], *to = &g->vertices[g->local[b]];
            g->edges[g->edge_count++] =
                (patch_edge){g->local[a], g->local[b], edge_direction(s, from, to), edge_weight(s, a, b, across)};
        }
    for (size_t l = 0; l < g->vertex_count; l++)
        g->kept[l] = g->vertices[l].position;
    return true;
}

/* Least squares: each vertex to where its neighbours want it, together, a little less than all the way so that it
 * settles. */
static void relax(patch_ground *g)
{
    for (int step = 0; step < RELAXING; step++) {
        for (size_t l = 0; l < g->vertex_count; l++) {
            g->vertices[l].sum = (flat_position){0, 0};
            g->vertices[l].weight = 0;
        }
        for (size_t i = 0; i < g->edge_count; i++) {
            const patch_edge *e = &g->edges[i];
            patch_vertex     *a = &g->vertices[e->from], *b = &g->vertices[e->to];
            a->sum = flat_add(a->sum, flat_add(b->position, e->direction, -1), e->weight);
            b->sum = flat_add(b->sum, flat_add(a->position, e->direction, 1), e->weight);
            a->weight += e->weight;
            b->weight += e->weight;
        }
        for (size_t l = 0; l < g->vertex_count; l++) {
            patch_vertex *v = &g->vertices[l];
            if (v->weight > 0)
                v->position =
                    flat_add((flat_position){0.25 * v->position.x, 0.25 * v->position.y}, v->sum, 0.75 / v->weight);
        }
    }
}

static void centre(patch_ground *g, uint32_t seed)
{
    flat_position c[3];
    patch_positions(g, seed, c);
    double        first = 1 - g->middle.x - g->middle.y;
    flat_position middle =
        flat_add(flat_add((flat_position){first * c[0].x, first * c[0].y}, c[1], g->middle.x), c[2], g->middle.y);
    for (size_t l = 0; l < g->vertex_count; l++)
        g->vertices[l].position = flat_add(g->vertices[l].position, middle, -1);
}

bool patch_grow(patch_ground *g, uint32_t seed, flat_position middle, double radius)
{
    const field_surface *s = g->surface;
    g->middle = middle;
    g->radius = radius;
    if (!lay_seed(g, seed))
        return false;
    for (uint32_t k = 0; k < 3; k++)
        if (!offer_around(g, s->corners[3 * (size_t)seed + k], radius))
            return false;
    while (g->near.count > 0) {
        near_position next = near_pop(&g->near);
        uint32_t      element = next.element;
        if (settled(g, element))
            continue;
        if (!settle(g, element, next.distance) || !offer_around(g, element, radius))
            return false;
    }
    if (!gather(g, seed, radius) || !list_edges(g))
        return false;
    relax(g);
    centre(g, seed);
    if (patch_stretch(g, seed) > STRETCH_MAX)
        for (size_t l = 0; l < g->vertex_count; l++)
            g->vertices[l].position = g->kept[l];
    return gather(g, seed, radius);
}

void patch_clear(patch_ground *g)
{
    for (size_t l = 0; l < g->vertex_count; l++)
        g->local[g->vertices[l].element] = NOWHERE;
    g->vertex_count = g->triangle_count = g->edge_count = g->near.count = 0;
}
