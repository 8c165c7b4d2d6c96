/* Everything is made of lofts: rings of a few corners one above the other, closed at both ends. */
#include "import/props.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* A ring: its middle, how far it reaches, how high it lies. Four corners are those of a rectangle, others are on an
 * ellipse. */
typedef struct ring {
    double x, y, reach_x, reach_y, z;
} ring;

typedef struct maker {
    city_shape       shape;
    footprint_points points;
    bool             lying; /* rings lie one beside the other along y instead: wheels */
    bool             good;
} maker;

static void put(maker *m, double x, double y, double z)
{
    m->good =
        m->good && (m->lying ? footprint_add_point(&m->points, x, z, y) : footprint_add_point(&m->points, x, y, z));
}

static void face(maker *m, const uint32_t *corners, int count)
{
    for (int i = 0; i < count && m->good; i++)
        m->good = city_shape_corner(&m->shape, corners[m->lying ? count - 1 - i : i]);
    m->good = m->good && city_shape_end_ring(&m->shape) && city_shape_end_face(&m->shape, NONE, CITY_NO_WORD, 0);
}

static void loft(maker *m, int sides, const ring *rings, int count)
{
    const double full = 6.283185307179586;
    uint32_t     first = (uint32_t)m->points.count, n = (uint32_t)sides, ends[2][16];
    for (int k = 0; k < count; k++)
        for (int i = 0; i < sides; i++) {
            double angle = full * (i + 0.5) / sides, c = cos(angle), s = sin(angle);
            if (sides == 4) {
                c = copysign(1, c);
                s = copysign(1, s);
            }
            put(m, rings[k].x + rings[k].reach_x * c, rings[k].y + rings[k].reach_y * s, rings[k].z);
        }
    for (uint32_t k = 0; k + 1 < (uint32_t)count; k++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = first + k * n + i, b = first + k * n + (i + 1) % n;
            face(m, (const uint32_t[]){a, b, b + n, a + n}, 4);
        }
    for (uint32_t i = 0; i < n; i++) {
        ends[0][i] = first + n - 1 - i;
        ends[1][i] = first + ((uint32_t)count - 1) * n + i;
    }
    face(m, ends[0], sides);
    face(m, ends[1], sides);
}

static void box(maker *m, double x, double y, double z, double reach_x, double reach_y, double height)
{
    loft(m, 4, (const ring[]){{x, y, reach_x, reach_y, z}, {x, y, reach_x, reach_y, z + height}}, 2);
}

static void wheel(maker *m, double x, double y, double radius)
{
    m->lying = true;
    loft(m, 8,
         (const ring[]){{x, 0.924 * radius, radius, radius, y - 0.1}, {x, 0.924 * radius, radius, radius, y + 0.1}}, 2);
    m->lying = false;
}

/* Legs, one of them `stride` before the other, a body and a head. */
static void person(maker *m, double high, double stride)
{
    double s = high / 1.75;
    for (int side = -1; side <= 1; side += 2)
        loft(m, 5,
             (const ring[]){{side * stride * s, 0.09 * side * s, 0.09 * s, 0.06 * s, 0},
                            {0.02 * side * s, 0.085 * side * s, 0.09 * s, 0.085 * s, 0.88 * s}},
             2);
    loft(m, 6,
         (const ring[]){{0, 0, 0.11 * s, 0.17 * s, 0.84 * s},
                        {0, 0, 0.10 * s, 0.16 * s, 1.08 * s},
                        {0, 0, 0.12 * s, 0.23 * s, 1.38 * s},
                        {0, 0, 0.06 * s, 0.07 * s, 1.5 * s}},
         4);
    loft(m, 6,
         (const ring[]){{0, 0, 0.06 * s, 0.055 * s, 1.48 * s},
                        {0.01 * s, 0, 0.1 * s, 0.085 * s, 1.57 * s},
                        {0.01 * s, 0, 0.1 * s, 0.085 * s, 1.67 * s},
                        {0, 0, 0.05 * s, 0.045 * s, 1.75 * s}},
         4);
}

static void vehicle(maker *m, prop_kind kind)
{
    if (kind == PROP_CAR) {
        loft(m, 4, (const ring[]){{0, 0, 2.1, 0.84, 0.22}, {0, 0, 2.15, 0.88, 0.55}, {-0.05, 0, 2.02, 0.84, 0.86}}, 3);
        loft(m, 4, (const ring[]){{-0.35, 0, 1.45, 0.8, 0.86}, {-0.45, 0, 0.95, 0.64, 1.45}}, 2);
    } else {
        double half = kind == PROP_BUS ? 5.8 : 2.6, wide = kind == PROP_BUS ? 1.24 : 0.97,
               high = kind == PROP_BUS ? 3.0 : 2.1;
        loft(m, 4,
             (const ring[]){
                 {0, 0, half, wide, 0.3}, {0, 0, half, wide, 0.55 * high}, {-0.15, 0, half - 0.2, wide - 0.08, high}},
             3);
    }
    double axle = kind == PROP_BUS ? 3.6 : kind == PROP_VAN ? 1.65 : 1.32, radius = kind == PROP_BUS ? 0.48 : 0.33;
    double out = kind == PROP_BUS ? 1.16 : kind == PROP_VAN ? 0.89 : 0.78;
    for (int i = 0; i < 4; i++)
        wheel(m, i & 1 ? axle : -axle, i & 2 ? out : -out, radius);
}

static void cyclist(maker *m)
{
    wheel(m, -0.52, 0, 0.34);
    wheel(m, 0.52, 0, 0.34);
    box(m, 0, 0, 0.5, 0.5, 0.03, 0.06);
    box(m, 0.45, 0, 0.5, 0.03, 0.03, 0.5);
    loft(m, 5, (const ring[]){{0, 0, 0.1, 0.13, 0.35}, {-0.1, 0, 0.13, 0.16, 0.95}}, 2);
    loft(m, 6, (const ring[]){{-0.1, 0, 0.12, 0.17, 0.9}, {0.1, 0, 0.12, 0.21, 1.42}, {0.16, 0, 0.06, 0.07, 1.5}}, 3);
    loft(m, 6, (const ring[]){{0.18, 0, 0.06, 0.055, 1.48}, {0.2, 0, 0.1, 0.085, 1.6}, {0.18, 0, 0.05, 0.045, 1.73}},
         3);
}

static void furniture(maker *m, prop_kind kind)
{
    if (kind == PROP_LAMP) {
        loft(m, 6, (const ring[]){{0, 0, 0.11, 0.11, 0}, {0, 0, 0.08, 0.08, 1}, {0, 0, 0.05, 0.05, 6}}, 3);
        box(m, 0.6, 0, 5.9, 0.65, 0.035, 0.07);
        box(m, 1.2, 0, 5.78, 0.32, 0.13, 0.12);
    } else if (kind == PROP_BENCH) {
        box(m, 0, 0, 0.4, 0.24, 0.9, 0.06);
        box(m, -0.24, 0, 0.46, 0.03, 0.9, 0.4);
        box(m, 0, -0.7, 0, 0.2, 0.04, 0.4);
        box(m, 0, 0.7, 0, 0.2, 0.04, 0.4);
    } else if (kind == PROP_BIN) {
        loft(m, 8, (const ring[]){{0, 0, 0.2, 0.2, 0}, {0, 0, 0.25, 0.25, 0.8}, {0, 0, 0.18, 0.18, 0.9}}, 3);
    } else {
        loft(m, 8, (const ring[]){{0, 0, 0.09, 0.09, 0}, {0, 0, 0.09, 0.09, 0.85}, {0, 0, 0.05, 0.05, 0.92}}, 3);
    }
}

static void tree(maker *m, prop_kind kind)
{
    loft(m, 6, (const ring[]){{0, 0, 0.03, 0.03, 0}, {0, 0, 0.022, 0.022, 0.35}}, 2);
    if (kind == PROP_BROAD_TREE)
        loft(m, 12,
             (const ring[]){{0, 0, 0.09, 0.09, 0.25},
                            {0.01, 0, 0.24, 0.23, 0.36},
                            {0.01, 0.01, 0.31, 0.3, 0.56},
                            {0, 0.01, 0.26, 0.25, 0.78},
                            {0, 0, 0.13, 0.12, 0.94},
                            {0, 0, 0.02, 0.02, 1}},
             6);
    else
        loft(m, 7, (const ring[]){{0, 0, 0.1, 0.1, 0.14}, {0, 0, 0.22, 0.22, 0.18}, {0, 0, 0.004, 0.004, 1}}, 3);
}

/* A branch, and those that leave it, each turned by the golden angle from the one before. */
static void branch(maker *m, const double from[3], const double way[3], double length, int depth, int number)
{
    double to[3];
    for (int k = 0; k < 3; k++)
        to[k] = from[k] + length * way[k];
    put(m, from[0], from[1], from[2]);
    put(m, to[0], to[1], to[2]);
    m->good = m->good && city_shape_corner(&m->shape, (uint32_t)m->points.count - 2) &&
              city_shape_corner(&m->shape, (uint32_t)m->points.count - 1) && city_shape_end_ring(&m->shape);
    for (int i = 0; i < 4 && depth > 0 && m->good; i++) {
        double at = 0.45 + 0.18 * i, angle = 2.399963 * (number + i), lean = 0.75 - 0.05 * i, next[3], start[3],
               norm = 0;
        for (int k = 0; k < 3; k++)
            start[k] = from[k] + fmin(at, 1) * length * way[k];
        next[0] = way[0] + lean * cos(angle);
        next[1] = way[1] + lean * sin(angle);
        next[2] = way[2] + 0.25;
        for (int k = 0; k < 3; k++)
            norm += next[k] * next[k];
        for (int k = 0; k < 3; k++)
            next[k] /= sqrt(norm);
        branch(m, start, next, length * (0.62 - 0.06 * i), depth - 1, number * 4 + i + 1);
    }
}

const char *prop_class(prop_kind kind)
{
    return kind <= PROP_CHILD        ? "Person"
           : kind <= PROP_CYCLIST    ? "Vehicle"
           : kind >= PROP_BROAD_TREE ? "SolitaryVegetationObject"
                                     : "CityFurniture";
}

prop_room prop_room_of(prop_kind kind)
{
    switch (kind) {
    case PROP_CAR: return (prop_room){0.95, 1.35, 3};
    case PROP_VAN: return (prop_room){1.05, 1.7, 3};
    case PROP_BUS: return (prop_room){1.35, 2.25, 5};
    case PROP_CYCLIST: return (prop_room){0.45, 0.7, 2};
    case PROP_BENCH: return (prop_room){0.95, 0, 1};
    case PROP_BROAD_TREE:
    case PROP_NEEDLE_TREE:
    case PROP_LINE_TREE: return (prop_room){1.5, 0, 1};
    default: return (prop_room){0.32, 0, 1};
    }
}

static void make(maker *m, prop_kind kind)
{
    static const double ground[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    switch (kind) {
    case PROP_PERSON: person(m, 1.75, 0.02); break;
    case PROP_WALKER: person(m, 1.7, 0.22); break;
    case PROP_CHILD: person(m, 1.2, 0.12); break;
    case PROP_CYCLIST: cyclist(m); break;
    case PROP_CAR:
    case PROP_VAN:
    case PROP_BUS: vehicle(m, kind); break;
    case PROP_BROAD_TREE:
    case PROP_NEEDLE_TREE: tree(m, kind); break;
    case PROP_LINE_TREE:
        m->shape.lines = true;
        branch(m, ground, up, 0.56, 3, 0);
        break;
    default: furniture(m, kind); break;
    }
}

/* Line trees grow as they do; all others are 1 high as they are made. */
static void make_one_high(maker *m)
{
    float high = 0;
    for (size_t i = 0; i < m->points.count; i++)
        high = fmaxf(high, m->points.items[i].z);
    for (size_t i = 0; i < m->points.count && high > 0; i++) {
        vec3 *p = &m->points.items[i];
        *p = (vec3){p->x / high, p->y / high, p->z / high};
    }
}

lmn_status prop_make(city_builder *b, prop_kind kind, city_meshes *out)
{
    maker       m = {.good = true};
    const char *type = prop_class(kind);
    lmn_status  status = LMN_OK;
    make(&m, kind);
    if (kind == PROP_LINE_TREE)
        make_one_high(&m);
    if (m.good) {
        city_builder_points(b, m.points.items, m.points.count);
        status = city_make(b, &m.shape, city_word_of_class(type, strlen(type)), true, out);
    }
    bool good = m.good;
    city_shape_release(&m.shape);
    mem_free(m.points.items);
    return good ? status : error_memory(b->error);
}
