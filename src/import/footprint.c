/* Walls between a footprint and its eaves, and roofs that need no skeleton. */
#include "import/footprint.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "import/footprint_raiser.h"

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

/* --- faces ---------------------------------------------------------------------------------------------- */

uint32_t raiser_put(raiser *r, double x, double y, double z)
{
    r->good = r->good && footprint_add_point(r->points, x, y, z);
    return r->good ? (uint32_t)r->points->count - 1 : 0;
}

void raiser_corner(raiser *r, uint32_t point)
{
    r->good = r->good && city_shape_corner(r->shape, point);
}

void raiser_end_ring(raiser *r)
{
    r->good = r->good && city_shape_end_ring(r->shape);
}

void raiser_end_face(raiser *r, uint8_t word)
{
    r->good = r->good && city_shape_end_face(r->shape, NONE, word, 0);
}

void raiser_begin_wall(raiser *r, uint32_t edge, uint32_t end)
{
    raiser_corner(r, r->base + edge);
    raiser_corner(r, r->base + end);
    raiser_corner(r, r->eaves + end);
}

/* All rings, from a first point on, as one face; `down`: it looks down. */
static void whole_face(raiser *r, uint8_t word, uint32_t first, bool down)
{
    for (size_t k = 0; k < r->rings; first += (uint32_t)r->counts[k], k++) {
        for (size_t i = 0; i < r->counts[k]; i++)
            raiser_corner(r, first + (uint32_t)(down ? r->counts[k] - 1 - i : i));
        raiser_end_ring(r);
    }
    raiser_end_face(r, word);
}

static void walls(raiser *r)
{
    uint32_t first = 0;
    for (size_t k = 0; k < r->rings; first += (uint32_t)r->counts[k], k++)
        for (uint32_t i = 0; i < r->counts[k]; i++) {
            raiser_begin_wall(r, first + i, first + (i + 1) % (uint32_t)r->counts[k]);
            raiser_corner(r, r->eaves + first + i);
            raiser_end_ring(r);
            raiser_end_face(r, r->wall);
        }
}

/* --- roofs ---------------------------------------------------------------------------------------------- */

static double cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
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
            sum[k] += part * (a[k] + b[k] - 2 * p[0][k]) / 3;
    }
    for (int k = 0; k < 2; k++)
        out[k] = p[0][k] + (fabs(area) > 0 ? sum[k] / area : 0);
}

/* Does the middle see all of the outline, and no edge from its end? */
static bool has_middle(const raiser *r, double middle[2])
{
    const double(*p)[2] = r->positions;
    size_t n = r->corners;
    if (r->rings != 1)
        return false;
    middle_of(p, n, middle);
    for (size_t i = 0; i < n; i++) {
        const double *a = p[i], *b = p[(i + 1) % n];
        if (!(cross(a, b, middle) > 0.02 * hypot(b[0] - a[0], b[1] - a[1]) * hypot(middle[0] - a[0], middle[1] - a[1])))
            return false;
    }
    return true;
}

/* Roofs that go up to one point: how large the outline still is, and how high of the roof, from below the first of them
 * on up to the point. */
typedef struct roof_profile {
    const double (*steps)[2];
    size_t count;
} roof_profile;

static roof_profile profile_of(roof_form form)
{
    /* A quarter of a circle, every 15 degrees; and a bulb that draws in to a spike. */
    static const double dome[][2] = {
        {0.9659, 0.2588}, {0.8660, 0.5}, {0.7071, 0.7071}, {0.5, 0.8660}, {0.2588, 0.9659}};
    static const double onion[][2] = {{1.1, 0.12},  {1.14, 0.25}, {1.06, 0.38}, {0.82, 0.5},
                                      {0.48, 0.61}, {0.22, 0.72}, {0.09, 0.84}};
    return form == ROOF_DOME    ? (roof_profile){dome, sizeof dome / sizeof *dome}
           : form == ROOF_ONION ? (roof_profile){onion, sizeof onion / sizeof *onion}
                                : (roof_profile){NULL, 0};
}

static void pointed(raiser *r, roof_form form, const double middle[2])
{
    const roof_profile profile = profile_of(form);
    const uint32_t     count = (uint32_t)r->corners;
    uint32_t           below = r->eaves;
    walls(r);
    for (size_t k = 0; k < profile.count; k++, below = (uint32_t)r->points->count - count) {
        const double scale = profile.steps[k][0],
                     z = r->how->eaves + profile.steps[k][1] * (r->how->ridge - r->how->eaves);
        uint32_t above = (uint32_t)r->points->count;
        for (uint32_t i = 0; i < count; i++)
            raiser_put(r, middle[0] + scale * (r->positions[i][0] - middle[0]),
                       middle[1] + scale * (r->positions[i][1] - middle[1]), z);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t corners[4] = {below + i, below + (i + 1) % count, above + (i + 1) % count, above + i};
            for (int c = 0; c < 4; c++)
                raiser_corner(r, corners[c]);
            raiser_end_ring(r);
            raiser_end_face(r, r->roof);
        }
    }
    uint32_t apex = raiser_put(r, middle[0], middle[1], r->how->ridge);
    for (uint32_t i = 0; i < count; i++) {
        raiser_corner(r, below + i);
        raiser_corner(r, below + (i + 1) % count);
        raiser_corner(r, apex);
        raiser_end_ring(r);
        raiser_end_face(r, r->roof);
    }
}

/* Where a skillion rises to: away from where it is said to fall, else across the longest edge. */
static void find_rise(const raiser *r, double out[2])
{
    double longest = 0;
    if (r->how->has_direction) {
        out[0] = -sin(r->how->direction);
        out[1] = -cos(r->how->direction);
        return;
    }
    for (size_t i = 0; i < r->counts[0]; i++) {
        const double *a = r->positions[i], *b = r->positions[(i + 1) % r->counts[0]];
        double        length = hypot(b[0] - a[0], b[1] - a[1]);
        if (length > longest) {
            longest = length;
            out[0] = -(b[1] - a[1]) / length;
            out[1] = (b[0] - a[0]) / length;
        }
    }
}

/* One slope over all: only the points at the eaves are otherwise. */
static void skillion(raiser *r)
{
    double rise[2] = {1, 0}, low = INFINITY, high = -INFINITY;
    find_rise(r, rise);
    for (size_t i = 0; i < r->corners; i++) {
        double at = rise[0] * r->positions[i][0] + rise[1] * r->positions[i][1];
        low = fmin(low, at);
        high = fmax(high, at);
    }
    for (size_t i = 0; i < r->corners && high > low && r->good; i++) {
        double at = rise[0] * r->positions[i][0] + rise[1] * r->positions[i][1];
        double z = r->how->eaves + (r->how->ridge - r->how->eaves) * (at - low) / (high - low);
        r->points->items[r->eaves + i].z = (float)z;
    }
    walls(r);
    whole_face(r, r->roof, r->eaves, false);
}

static void flat(raiser *r)
{
    for (size_t i = 0; i < r->corners && r->good; i++)
        r->points->items[r->eaves + i].z = (float)r->how->ridge;
    walls(r);
    whole_face(r, r->roof, r->eaves, false);
}

static roof_made roof(raiser *r)
{
    double    middle[2];
    roof_form form = r->how->ridge > r->how->eaves ? r->how->roof : ROOF_FLAT;
    roof_made made = ROOF_AS_ASKED;
    switch (form) {
    case ROOF_FLAT: flat(r); return ROOF_AS_ASKED;
    case ROOF_SKILLION: skillion(r); return ROOF_AS_ASKED;
    case ROOF_PYRAMIDAL:
    case ROOF_DOME:
    case ROOF_ONION:
        if (has_middle(r, middle)) {
            pointed(r, form, middle);
            return ROOF_AS_ASKED;
        }
        made = ROOF_OTHERWISE;
        form = ROOF_HIPPED;
        break;
    default: break;
    }
    roof_made slopes = footprint_slopes(r, form);
    if (slopes == ROOF_MADE_FLAT)
        flat(r);
    return slopes == ROOF_AS_ASKED ? made : slopes;
}

bool footprint_raise(city_shape *shape, footprint_points *points, const footprint *how, const double (*positions)[2],
                     const size_t *counts, size_t rings, roof_made *made)
{
    raiser r = {.shape = shape,
                .points = points,
                .how = how,
                .positions = positions,
                .counts = counts,
                .rings = rings,
                .ground = word_of("GroundSurface"),
                .wall = word_of("WallSurface"),
                .roof = word_of("RoofSurface"),
                .good = true};
    for (size_t k = 0; k < rings; k++)
        r.corners += counts[k];
    r.base = (uint32_t)points->count;
    r.eaves = r.base + (uint32_t)r.corners;
    for (int level = 0; level < 2; level++)
        for (size_t i = 0; i < r.corners; i++)
            raiser_put(&r, positions[i][0], positions[i][1], level ? how->eaves : how->base);
    whole_face(&r, r.ground, r.base, true);
    *made = roof(&r);
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
    raiser       r = {.shape = shape, .points = points, .good = true, .rings = 1};
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
            raiser_put(&r, positions[i][0] + half * reach * sum[0], positions[i][1] + half * reach * sum[1], height);
        }
    size_t total = 2 * count;
    r.counts = &total;
    whole_face(&r, CITY_NO_WORD, first, true);
    return r.good;
}
