/* Walls between a footprint and its eaves, and a roof over them. */
#include "import/footprint.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

typedef struct raiser {
    city_shape       *shape;
    footprint_points *points;
    const footprint  *how;
    uint8_t           ground, wall, roof;
    bool              good;
} raiser;

static uint8_t word_of(const char *class_name)
{
    return city_word_of_class(class_name, strlen(class_name));
}

bool footprint_add_point(footprint_points *p, double x, double y, double z)
{
    if (!mem_grow((void **)&p->items, &p->capacity, p->count + 1, sizeof *p->items))
        return false;
    p->items[p->count++] = (vec3){(float)x, (float)y, (float)z};
    return true;
}

static uint32_t put(raiser *r, double x, double y, double z)
{
    r->good = r->good && footprint_add_point(r->points, x, y, z);
    return r->good ? (uint32_t)r->points->count - 1 : 0;
}

static void face(raiser *r, uint8_t word, const uint32_t *corners, size_t count)
{
    for (size_t i = 0; i < count && r->good; i++)
        r->good = city_shape_corner(r->shape, corners[i]);
    r->good = r->good && city_shape_end_ring(r->shape) && city_shape_end_face(r->shape, NONE, word, 0);
}

/* All rings, from a first point on, as one level face; `down`: it looks down. */
static void level_face(raiser *r, uint8_t word, uint32_t first, const size_t *counts, size_t rings, bool down)
{
    for (size_t k = 0; k < rings; first += (uint32_t)counts[k], k++) {
        for (size_t i = 0; i < counts[k] && r->good; i++)
            r->good = city_shape_corner(r->shape, first + (uint32_t)(down ? counts[k] - 1 - i : i));
        r->good = r->good && city_shape_end_ring(r->shape);
    }
    r->good = r->good && city_shape_end_face(r->shape, NONE, word, 0);
}

static double cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool is_convex(const double (*p)[2], size_t n)
{
    int left = 0, right = 0;
    for (size_t i = 0; i < n; i++) {
        double turn = cross(p[i], p[(i + 1) % n], p[(i + 2) % n]);
        left += turn > 0;
        right += turn < 0;
    }
    return n >= 3 && (left == 0) != (right == 0);
}

/* The centroid of an area. */
static void middle_of(const double (*p)[2], size_t n, double out[2])
{
    double area = 0, sum[2] = {0, 0};
    for (size_t i = 0; i < n; i++) {
        const double *a = p[i], *b = p[(i + 1) % n];
        double        part = (a[0] - p[0][0]) * (b[1] - p[0][1]) - (b[0] - p[0][0]) * (a[1] - p[0][1]);
        area += part;
        for (int k = 0; k < 2; k++)
            sum[k] += part * (a[k] + b[k] + p[0][k]) / 3;
    }
    for (int k = 0; k < 2; k++)
        out[k] = fabs(area) > 0 ? sum[k] / area : p[0][k];
}

static void walls(raiser *r, uint32_t base, uint32_t eaves, const size_t *counts, size_t rings)
{
    for (size_t k = 0; k < rings; base += (uint32_t)counts[k], eaves += (uint32_t)counts[k], k++)
        for (uint32_t i = 0; i < counts[k]; i++) {
            uint32_t next = (i + 1) % (uint32_t)counts[k];
            face(r, r->wall, (const uint32_t[]){base + i, base + next, eaves + next, eaves + i}, 4);
        }
}

static void pyramid(raiser *r, uint32_t eaves, const double (*p)[2], size_t n)
{
    double middle[2];
    middle_of(p, n, middle);
    uint32_t apex = put(r, middle[0], middle[1], r->how->ridge);
    for (uint32_t i = 0; i < n; i++)
        face(r, r->roof, (const uint32_t[]){eaves + i, eaves + (i + 1) % (uint32_t)n, apex}, 3);
}

/* Steep sides up to a smaller outline of the same form, flat on top. */
static void mansard(raiser *r, uint32_t eaves, const double (*p)[2], size_t n)
{
    double   middle[2], share = 0.3;
    uint32_t top = (uint32_t)r->points->count;
    middle_of(p, n, middle);
    for (size_t i = 0; i < n; i++)
        put(r, p[i][0] + share * (middle[0] - p[i][0]), p[i][1] + share * (middle[1] - p[i][1]), r->how->ridge);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t next = (i + 1) % (uint32_t)n;
        face(r, r->roof, (const uint32_t[]){eaves + i, eaves + next, top + next, top + i}, 4);
    }
    level_face(r, r->roof, top, &n, 1, false);
}

/* A ridge between the middles of the two short sides, from gable to gable or as far in as the sides are half as long.
 */
static void ridge(raiser *r, uint32_t base, uint32_t eaves, const double (*p)[2], bool hipped)
{
    double sides[4], ends[2][2];
    for (int i = 0; i < 4; i++)
        sides[i] = hypot(p[(i + 1) % 4][0] - p[i][0], p[(i + 1) % 4][1] - p[i][1]);
    /* Long sides from corner c[0] to c[1] and from c[2] to c[3]. */
    uint32_t c[4], turned = sides[0] + sides[2] < sides[1] + sides[3];
    for (uint32_t i = 0; i < 4; i++)
        c[i] = (i + turned) % 4;
    for (int k = 0; k < 2; k++) {
        ends[0][k] = (p[c[3]][k] + p[c[0]][k]) / 2;
        ends[1][k] = (p[c[1]][k] + p[c[2]][k]) / 2;
    }
    double   length = hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
    double   width = (sides[c[1]] + sides[c[3]]) / 2, in = hipped && length > 0 ? fmin(width / 2 / length, 0.45) : 0;
    uint32_t a =
        put(r, ends[0][0] + in * (ends[1][0] - ends[0][0]), ends[0][1] + in * (ends[1][1] - ends[0][1]), r->how->ridge);
    uint32_t b =
        put(r, ends[1][0] + in * (ends[0][0] - ends[1][0]), ends[1][1] + in * (ends[0][1] - ends[1][1]), r->how->ridge);
    face(r, r->roof, (const uint32_t[]){eaves + c[0], eaves + c[1], b, a}, 4);
    face(r, r->roof, (const uint32_t[]){eaves + c[2], eaves + c[3], a, b}, 4);
    face(r, r->wall, (const uint32_t[]){base + c[0], base + c[1], eaves + c[1], eaves + c[0]}, 4);
    face(r, r->wall, (const uint32_t[]){base + c[2], base + c[3], eaves + c[3], eaves + c[2]}, 4);
    if (hipped) {
        face(r, r->roof, (const uint32_t[]){eaves + c[1], eaves + c[2], b}, 3);
        face(r, r->roof, (const uint32_t[]){eaves + c[3], eaves + c[0], a}, 3);
        face(r, r->wall, (const uint32_t[]){base + c[1], base + c[2], eaves + c[2], eaves + c[1]}, 4);
        face(r, r->wall, (const uint32_t[]){base + c[3], base + c[0], eaves + c[0], eaves + c[3]}, 4);
    } else {
        face(r, r->wall, (const uint32_t[]){base + c[1], base + c[2], eaves + c[2], b, eaves + c[1]}, 5);
        face(r, r->wall, (const uint32_t[]){base + c[3], base + c[0], eaves + c[0], a, eaves + c[3]}, 5);
    }
}

bool footprint_raise(city_shape *shape, footprint_points *points, const footprint *how, const double (*positions)[2],
                     const size_t *counts, size_t rings, bool *fits)
{
    raiser r = {shape, points, how, word_of("GroundSurface"), word_of("WallSurface"), word_of("RoofSurface"), true};
    size_t total = 0;
    for (size_t k = 0; k < rings; k++)
        total += counts[k];
    uint32_t  base = (uint32_t)points->count, eaves = base + (uint32_t)total;
    bool      pitched = how->ridge > how->eaves && rings == 1 && is_convex(positions, counts[0]);
    roof_form form = how->roof;
    *fits = form == ROOF_FLAT || (pitched && (counts[0] == 4 || form == ROOF_PYRAMIDAL || form == ROOF_MANSARD));
    if (!*fits)
        form = ROOF_FLAT;
    for (int level = 0; level < 2; level++)
        for (size_t i = 0; i < total; i++)
            put(&r, positions[i][0], positions[i][1],
                level == 0          ? how->base
                : form == ROOF_FLAT ? how->ridge
                                    : how->eaves);
    level_face(&r, r.ground, base, counts, rings, true);
    if (form != ROOF_GABLED && form != ROOF_HIPPED)
        walls(&r, base, eaves, counts, rings);
    switch (form) {
    case ROOF_FLAT: level_face(&r, r.roof, eaves, counts, rings, false); break;
    case ROOF_PYRAMIDAL: pyramid(&r, eaves, positions, counts[0]); break;
    case ROOF_MANSARD: mansard(&r, eaves, positions, counts[0]); break;
    case ROOF_GABLED:
    case ROOF_HIPPED: ridge(&r, base, eaves, positions, form == ROOF_HIPPED); break;
    }
    return r.good;
}

/* Unit, to the left of the way from a to b; false where they are one. */
static bool left_of(const double a[2], const double b[2], double out[2])
{
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    out[0] = length > 0 ? -(b[1] - a[1]) / length : 0;
    out[1] = length > 0 ? (b[0] - a[0]) / length : 0;
    return length > 0;
}

bool footprint_strip(city_shape *shape, footprint_points *points, const double (*positions)[2], size_t count,
                     double width, double height)
{
    const double MITRE = 2; /* a sharper bend is cut off there */
    raiser       r = {.shape = shape, .points = points, .good = true};
    uint32_t     first = (uint32_t)points->count;
    for (int side = 0; side < 2; side++)
        for (size_t n = 0; n < count; n++) {
            size_t i = side ? count - 1 - n : n;
            double before[2] = {0, 0}, behind[2] = {0, 0};
            bool   any = i > 0 && left_of(positions[i - 1], positions[i], before);
            bool   other = i + 1 < count && left_of(positions[i], positions[i + 1], behind);
            double sum[2] = {(any ? before[0] : 0) + (other ? behind[0] : 0),
                             (any ? before[1] : 0) + (other ? behind[1] : 0)};
            double length = hypot(sum[0], sum[1]), half = (side ? -0.5 : 0.5) * width;
            /* Of two unit vectors the mean is as long as the cosine of half the angle between them. */
            double reach = any && other && length > 0 ? fmin(4 / (length * length), MITRE) / 2
                           : length > 0               ? 1 / length
                                                      : 0;
            put(&r, positions[i][0] + half * reach * sum[0], positions[i][1] + half * reach * sum[1], height);
        }
    size_t total = 2 * count;
    level_face(&r, CITY_NO_WORD, first, &total, 1, true);
    return r.good;
}
