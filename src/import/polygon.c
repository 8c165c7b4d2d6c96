/* Polygons to triangles. */
#include <math.h>
#include <string.h>

#include "import/build.h"

/* Clipping takes a time that grows with the square of the corners; larger polygons become fans. */
enum { CLIP_MAX = 256 };

typedef struct point2 {
    double x, y;
} point2;

static void make_fan(const uint32_t *corners, uint32_t count, uint32_t *out)
{
    for (uint32_t i = 2; i < count; i++) {
        *out++ = corners[0];
        *out++ = corners[i - 1];
        *out++ = corners[i];
    }
}

/* Newell's normal: also right for polygons that are not quite flat. */
static void polygon_normal(const vec3 *positions, const uint32_t *corners, uint32_t count, double n[3])
{
    n[0] = n[1] = n[2] = 0;
    for (uint32_t i = 0; i < count; i++) {
        vec3 a = positions[corners[i]], b = positions[corners[(i + 1) % count]];
        n[0] += ((double)a.y - b.y) * ((double)a.z + b.z);
        n[1] += ((double)a.z - b.z) * ((double)a.x + b.x);
        n[2] += ((double)a.x - b.x) * ((double)a.y + b.y);
    }
}

/* Drops the axis that the normal is longest in, so that the polygon runs counter-clockwise in the plane. */
static void flatten(const vec3 *positions, const uint32_t *corners, uint32_t count, point2 *out)
{
    double n[3];
    polygon_normal(positions, corners, count, n);
    double ax = fabs(n[0]), ay = fabs(n[1]), az = fabs(n[2]);
    int    axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    double flip = n[axis] < 0 ? -1 : 1;
    for (uint32_t i = 0; i < count; i++) {
        vec3 p = positions[corners[i]];
        out[i] = axis == 0   ? (point2){p.y * flip, p.z}
                 : axis == 1 ? (point2){p.z * flip, p.x}
                             : (point2){p.x * flip, p.y};
    }
}

static double turn(point2 a, point2 b, point2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static bool inside(point2 p, point2 a, point2 b, point2 c)
{
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

static bool same_point(point2 a, point2 b)
{
    return a.x == b.x && a.y == b.y;
}

/* Can the corner at position `i` of the ring be cut off? */
static bool is_ear(const point2 *flat, const uint32_t *ring, uint32_t count, uint32_t i)
{
    point2 a = flat[ring[(i + count - 1) % count]], b = flat[ring[i]], c = flat[ring[(i + 1) % count]];
    if (turn(a, b, c) <= 0)
        return false;
    for (uint32_t k = 0; k < count; k++) {
        point2 p = flat[ring[k]];
        if (!same_point(p, a) && !same_point(p, b) && !same_point(p, c) && inside(p, a, b, c))
            return false;
    }
    return true;
}

static bool is_convex(const point2 *flat, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (turn(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) < 0)
            return false;
    return true;
}

void build_triangulate(const vec3 *positions, const uint32_t *corners, uint32_t count, uint32_t *out)
{
    point2   flat[CLIP_MAX];
    uint32_t ring[CLIP_MAX];
    if (count <= 3 || count > CLIP_MAX) {
        make_fan(corners, count, out);
        return;
    }
    flatten(positions, corners, count, flat);
    if (is_convex(flat, count)) {
        make_fan(corners, count, out);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        ring[i] = i;
    uint32_t from = 0; /* the search goes on where it stopped, as the neighbourhood changes only there */
    while (count > 3) {
        uint32_t tries = 0;
        while (tries < count && !is_ear(flat, ring, count, (from + tries) % count))
            tries++;
        if (tries == count)
            break; /* the polygon crosses itself */
        uint32_t ear = (from + tries) % count;
        *out++ = corners[ring[(ear + count - 1) % count]];
        *out++ = corners[ring[ear]];
        *out++ = corners[ring[(ear + 1) % count]];
        memmove(ring + ear, ring + ear + 1, (count - ear - 1) * sizeof *ring);
        count--;
        from = ear ? ear - 1 : 0;
    }
    for (uint32_t i = 2; i < count; i++) {
        *out++ = corners[ring[0]];
        *out++ = corners[ring[i - 1]];
        *out++ = corners[ring[i]];
    }
}
