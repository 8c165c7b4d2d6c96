/* Faces of city models to triangles: polygons in space, with holes, nearly flat. */
#include <math.h>

#include "base/memory.h"
#include "construct/triangulate.h"
#include "import/build.h"
#include "import/city.h"

/* Above this GLU's sweep is faster than clipping ears. */
enum { EARS_MAX = 200 };

/* How far corners may lie off their plane, in sizes of the face, before it counts as uneven. */
static const double UNEVEN = 0.01;

size_t city_first_ring(const city_shape *shape, size_t face)
{
    return face ? shape->faces[face - 1].ring_end : 0;
}

size_t city_first_corner(const city_shape *shape, size_t ring)
{
    return ring ? shape->rings[ring - 1] : 0;
}

void city_normal(const vec3 *points, const city_shape *shape, size_t face, double out[3])
{
    size_t ring = city_first_ring(shape, face), first = city_first_corner(shape, ring), end = shape->rings[ring];
    vec3   o = points[shape->corners[first]];
    double n[3] = {0, 0, 0};
    for (size_t i = first + 1; i + 1 < end; i++) {
        vec3   a = points[shape->corners[i]], b = points[shape->corners[i + 1]];
        double ax = (double)a.x - (double)o.x, ay = (double)a.y - (double)o.y, az = (double)a.z - (double)o.z;
        double bx = (double)b.x - (double)o.x, by = (double)b.y - (double)o.y, bz = (double)b.z - (double)o.z;
        n[0] += ay * bz - az * by;
        n[1] += az * bx - ax * bz;
        n[2] += ax * by - ay * bx;
    }
    for (int k = 0; k < 3; k++)
        out[k] = n[k];
}

static bool append(city_triangles *t, uint32_t a, uint32_t b, uint32_t c)
{
    if (t->count + 3 > t->capacity && !mem_grow((void **)&t->corners, &t->capacity, t->count + 3, sizeof *t->corners))
        return false;
    t->corners[t->count++] = a;
    t->corners[t->count++] = b;
    t->corners[t->count++] = c;
    return true;
}

/* Is the outline's thinnest measure nothing beside its longest? */
static bool is_flat_to_a_line(const double normal[3], double reach)
{
    double area = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    return !(area > 1e-6 * reach * reach) || !(area > 1e-9);
}

/* How far the corners are from the first, and how far from the plane through it. */
static void measure(const vec3 *points, const uint32_t *corners, size_t count, const double normal[3], double *reach,
                    double *off)
{
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]), most = 0, farthest = 0;
    vec3   o = points[corners[0]];
    for (size_t i = 1; i < count; i++) {
        vec3   p = points[corners[i]];
        double d[3] = {(double)p.x - (double)o.x, (double)p.y - (double)o.y, (double)p.z - (double)o.z};
        double away = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        double height = fabs(d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2]);
        most = away > most ? away : most;
        farthest = height > farthest ? height : farthest;
    }
    *reach = sqrt(most);
    *off = length > 0 ? farthest / length : 0;
}

/* Does a triangle look the other way than the face? Then clipping found no ear: the outline crosses itself. */
static bool is_turned(const vec3 *at, const uint32_t *t, const double n[3])
{
    vec3   a = at[t[0]], b = at[t[1]], c = at[t[2]];
    double u[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    double v[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y, (double)c.z - (double)a.z};
    double along =
        (u[1] * v[2] - u[2] * v[1]) * n[0] + (u[2] * v[0] - u[0] * v[2]) * n[1] + (u[0] * v[1] - u[1] * v[0]) * n[2];
    return along < -1e-4 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

static city_cut cut_simple(city_triangles *out, const vec3 *points, const city_shape *shape, size_t first, size_t count,
                           const double normal[3])
{
    vec3     own[EARS_MAX];
    uint32_t numbers[EARS_MAX], triangles[3 * EARS_MAX];
    if (count < 3 || count > EARS_MAX)
        return CITY_CUT_NOTHING;
    vec3 o = points[shape->corners[first]];
    for (size_t i = 0; i < count; i++) {
        vec3 p = points[shape->corners[first + i]];
        own[i] = (vec3){p.x - o.x, p.y - o.y, p.z - o.z};
        numbers[i] = (uint32_t)i;
    }
    build_triangulate(own, numbers, (uint32_t)count, triangles);
    bool crossing = false;
    for (size_t i = 0; i < count - 2; i++) {
        const uint32_t *t = triangles + 3 * i;
        crossing = crossing || is_turned(own, t, normal);
        if (!append(out, (uint32_t)first + t[0], (uint32_t)first + t[1], (uint32_t)first + t[2]))
            return CITY_CUT_NO_MEMORY;
    }
    return crossing ? CITY_CUT_CROSSING : CITY_CUT_WELL;
}

/* In the plane of the normal, so that the outline is anticlockwise. */
typedef struct plane_axes {
    double u[3], v[3];
} plane_axes;

static plane_axes axes_of(const double normal[3])
{
    double ax = fabs(normal[0]), ay = fabs(normal[1]), az = fabs(normal[2]);
    double length = sqrt(ax * ax + ay * ay + az * az);
    double n[3] = {normal[0] / length, normal[1] / length, normal[2] / length};
    double e[3] = {ax <= ay && ax <= az, 0, 0};
    e[1] = !(e[0] > 0) && ay <= az;
    e[2] = !(e[0] > 0) && !(e[1] > 0);
    plane_axes a = {{e[1] * n[2] - e[2] * n[1], e[2] * n[0] - e[0] * n[2], e[0] * n[1] - e[1] * n[0]}, {0, 0, 0}};
    double     u = sqrt(a.u[0] * a.u[0] + a.u[1] * a.u[1] + a.u[2] * a.u[2]);
    for (int k = 0; k < 3; k++)
        a.u[k] /= u;
    a.v[0] = n[1] * a.u[2] - n[2] * a.u[1];
    a.v[1] = n[2] * a.u[0] - n[0] * a.u[2];
    a.v[2] = n[0] * a.u[1] - n[1] * a.u[0];
    return a;
}

static double area_of(const contour *c)
{
    double sum = 0;
    for (size_t i = 0; i < c->count; i++) {
        point2 a = c->points[i], b = c->points[(i + 1) % c->count];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum / 2;
}

/* The outline runs anticlockwise, holes the other way, whatever the file has; `backwards` says whose order that is. */
static void put_contour(contour *c, bool *backwards, bool hole)
{
    *backwards = area_of(c) < 0 ? !hole : hole;
    for (size_t i = 0; *backwards && i < c->count / 2; i++) {
        point2 kept = c->points[i];
        c->points[i] = c->points[c->count - 1 - i];
        c->points[c->count - 1 - i] = kept;
    }
}

typedef struct holed {
    point2   *points;
    contour  *contours;
    uint32_t *numbers; /* of the corners, in the order of the points */
} holed;

static bool flatten(holed *h, const vec3 *points, const city_shape *shape, size_t face, const double normal[3])
{
    size_t ring = city_first_ring(shape, face), rings = shape->faces[face].ring_end - ring;
    size_t first = city_first_corner(shape, ring), count = shape->rings[ring + rings - 1] - first;
    h->points = mem_calloc(count, sizeof *h->points);
    h->contours = mem_calloc(rings, sizeof *h->contours);
    h->numbers = mem_calloc(count, sizeof *h->numbers);
    if (!h->points || !h->contours || !h->numbers)
        return false;
    plane_axes a = axes_of(normal);
    vec3       o = points[shape->corners[first]];
    for (size_t i = 0; i < count; i++) {
        vec3   p = points[shape->corners[first + i]];
        double d[3] = {(double)p.x - (double)o.x, (double)p.y - (double)o.y, (double)p.z - (double)o.z};
        h->points[i] =
            (point2){d[0] * a.u[0] + d[1] * a.u[1] + d[2] * a.u[2], d[0] * a.v[0] + d[1] * a.v[1] + d[2] * a.v[2]};
    }
    for (size_t r = 0; r < rings; r++) {
        size_t   from = city_first_corner(shape, ring + r), many = shape->rings[ring + r] - from;
        contour *c = &h->contours[r];
        bool     backwards;
        *c = (contour){.points = h->points + (from - first), .count = many};
        put_contour(c, &backwards, r > 0);
        for (size_t i = 0; i < many; i++)
            h->numbers[from - first + i] = (uint32_t)(backwards ? from + many - 1 - i : from + i);
    }
    return true;
}

static city_cut cut_holed(city_triangles *out, const vec3 *points, const city_shape *shape, size_t face,
                          const double normal[3])
{
    holed     h = {0};
    uint32_t *made = NULL;
    size_t    count = 0;
    bool      exact = false;
    city_cut  result = CITY_CUT_NO_MEMORY;
    size_t    rings = shape->faces[face].ring_end - city_first_ring(shape, face);
    if (flatten(&h, points, shape, face, normal) &&
        contours_triangulate(h.contours, rings, &made, &count, &exact, NULL) == LMN_OK) {
        result = count == 0 ? CITY_CUT_NOTHING : exact ? CITY_CUT_WELL : CITY_CUT_CROSSING;
        for (size_t i = 0; i + 2 < count && result != CITY_CUT_NO_MEMORY; i += 3)
            if (!append(out, h.numbers[made[i]], h.numbers[made[i + 1]], h.numbers[made[i + 2]]))
                result = CITY_CUT_NO_MEMORY;
    }
    mem_free(made);
    mem_free(h.points);
    mem_free(h.contours);
    mem_free(h.numbers);
    return result;
}

city_cut city_triangulate(city_triangles *out, const vec3 *points, const city_shape *shape, size_t face)
{
    size_t ring = city_first_ring(shape, face), rings = shape->faces[face].ring_end - ring;
    size_t first = city_first_corner(shape, ring), count = shape->rings[ring] - first;
    double normal[3], reach, off;
    city_normal(points, shape, face, normal);
    measure(points, shape->corners + first, count, normal, &reach, &off);
    if (is_flat_to_a_line(normal, reach))
        return CITY_CUT_NOTHING;
    city_cut result;
    if (rings == 1 && count == 3)
        result =
            append(out, (uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2) ? CITY_CUT_WELL : CITY_CUT_NO_MEMORY;
    else if (rings == 1 && count <= EARS_MAX)
        result = cut_simple(out, points, shape, first, count, normal);
    else
        result = cut_holed(out, points, shape, face, normal);
    return result == CITY_CUT_WELL && off > UNEVEN * reach ? CITY_CUT_UNEVEN : result;
}
