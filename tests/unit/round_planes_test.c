/* A plate with round holes and a slot, whose rims are bevelled: made round, it stays flat between its rims, these
 * become as round as they were cut, and all of it is drawn one way. */
#include "field_shapes.h"

#include "construct/triangulate.h"
#include "field/direction_field.h"
#include "scene/mesh.h"
#include "scene/round.h"

/* A half circle, a straight piece along y, and the other half. Straight 0: a circle. */
typedef struct rim {
    double x, y, radius, straight; /* the middle; half the length of the straight piece */
    double bevel;                  /* its width; 0: none */
    int    steps;                  /* of both half circles, in a fine mesh */
} rim;

static const rim rims[] = {
    {0, 0, 37, 19, 1.2, 96},  {8, 19.5, 13.5, 0, 0, 64}, {0, -12, 2.5, 9, 0.5, 24}, {25, 34, 3, 0, 0, 24},
    {-25, 34, 3, 0, 0.5, 24}, {25, -34, 3, 0, 0, 24},    {-25, -34, 3, 0, 0, 24},
};
enum { RIMS = sizeof rims / sizeof *rims, RIM_MOST = 128, DEEP = 3 };

static const double crease = 0.785398163397448;

/* Bevels lean by 43.5 degrees: they are joined with the plate. Or by 45: along arcs they are a hair steeper and part.
 */
typedef struct make {
    uint32_t coarser;
    double   steep;
} make;

static const make makes[] = {{1, 0.95}, {2, 0.95}, {1, 1}, {2, 1}};
enum { MAKES = sizeof makes / sizeof *makes };

/* Corner k of n, moved by so much into the air; anticlockwise around the plate, clockwise around what is cut out of it.
 */
static point2 rim_point(const rim *r, int n, int k, double off)
{
    bool   hole = r != rims, straight = r->straight > 0;
    int    at = hole ? n - 1 - k : k, half = n / 2, far = at >= half;
    double angle = straight ? far * field_pi + field_pi * (at - far * half) / (half - 1) : 2 * field_pi * at / n,
           radius = hole ? r->radius - off : r->radius + off;
    return (point2){r->x + radius * cos(angle), r->y + (far ? -r->straight : r->straight) + radius * sin(angle)};
}

/* As it is triangulated: askew, so that many long triangles go from one place of the outer rim to another. */
static point2 askew(point2 p)
{
    double c = cos(field_pi / 3), s = sin(field_pi / 3);
    return (point2){c * p.x - s * p.y, s * p.x + c * p.y};
}

static uint32_t triangulate(uint32_t steps[RIMS], uint32_t **corners, size_t *count)
{
    point2   points[RIMS][RIM_MOST];
    contour  contours[RIMS];
    uint32_t total = 0;
    bool     exact;
    for (int r = 0; r < RIMS; r++) {
        for (uint32_t k = 0; k < steps[r]; k++)
            points[r][k] = askew(rim_point(&rims[r], (int)steps[r], (int)k, 0));
        contours[r] = (contour){points[r], steps[r]};
        total += steps[r];
    }
    assert_int_equal(contours_triangulate(contours, RIMS, corners, count, &exact, NULL), LMN_OK);
    assert_true(exact);
    return total;
}

/* Each rim has three rows of corners: at the plate, below its bevel, and at the bottom. */
static primitive plate(const make *as)
{
    uint32_t *corners, steps[RIMS], first = 0;
    size_t    count;
    for (int r = 0; r < RIMS; r++)
        steps[r] = (uint32_t)rims[r].steps / as->coarser;
    const uint32_t total = triangulate(steps, &corners, &count);
    primitive      p = empty_primitive(DEEP * total, (uint32_t)count + 12 * total);
    memcpy(p.indices, corners, count * sizeof *corners);
    mem_free(corners);
    uint32_t *to = p.indices + count;
    for (int r = 0; r < RIMS; first += steps[r++])
        for (uint32_t c = 0, n = steps[r]; c < DEEP * n; c++) {
            uint32_t row = c / n, a = row * total + first + c % n, b = row * total + first + (c + 1) % n;
            double   bevel = rims[r].bevel;
            point2   q = rim_point(&rims[r], (int)n, (int)(c % n), row ? bevel : 0);
            p.positions[a] = (vec3){(float)q.x, (float)q.y,
                                    row == 0                ? 0
                                    : row == 1 && bevel > 0 ? (float)(-as->steep * bevel)
                                                            : -5};
            const uint32_t two[6] = {a, a + total, b + total, a, b + total, b};
            if (bevel > 0 && row + 1 < DEEP) {
                memcpy(to, two, sizeof two);
                to += 6;
            } else if (row == 0) { /* straight down */
                const uint32_t wall[6] = {a, a + 2 * total, b + 2 * total, a, b + 2 * total, b};
                memcpy(to, wall, sizeof wall);
                to += 6;
            }
        }
    p.index_count = (uint32_t)(to - p.indices);
    p.bounds = box3_empty();
    for (uint32_t v = 0; v < p.vertex_count; v++)
        p.bounds = box3_with_point(p.bounds, p.positions[v]);
    return p;
}

/* What the cutter left. */
static double area_of_plate(void)
{
    double sum = 0;
    for (int r = 0; r < RIMS; r++)
        sum += (r ? -1 : 1) * (field_pi * rims[r].radius * rims[r].radius + 4 * rims[r].radius * rims[r].straight);
    return sum;
}

static mesh rounded_plate(const make *as, primitive *p)
{
    mesh                from = {.primitives = p, .primitive_count = 1}, out;
    const round_options options = {.crease_angle = crease, .tolerance = 1.0 / 2000, .most_vertices = 100000};
    *p = plate(as);
    assert_int_equal(mesh_round(&out, &from, &options, NULL), LMN_OK);
    assert_int_equal(out.primitive_count, 1);
    return out;
}

/* The triangle's area if it belongs to the plate, else 0. */
static double area_on_top(const primitive *p, uint32_t t)
{
    vec3 a = p->positions[p->indices[3 * t]], b = p->positions[p->indices[3 * t + 1]],
         c = p->positions[p->indices[3 * t + 2]];
    place3 u = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z},
           v = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z},
           n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    double size = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    return n.z > cos(15 * field_pi / 180) * size ? size / 2 : 0;
}

/* What their chords take away from the rims comes back, as far as edges may lie off. */
static void plates_stay_flat_between_bevels(void **state)
{
    (void)state;
    for (const make *as = makes; as < makes + MAKES; as++) {
        primitive        p;
        mesh             m = rounded_plate(as, &p);
        const primitive *made = &m.primitives[0];
        double           flat = 0, coarse = 0, truth = area_of_plate();
        for (uint32_t t = 0; t < made->index_count / 3; t++) {
            double z = 0;
            for (uint32_t k = 0; k < 3; k++)
                z = fmax(z, fabs((double)made->positions[made->indices[3 * t + k]].z));
            flat += z < 1e-4 ? area_on_top(made, t) : 0;
        }
        for (uint32_t t = 0; t < p.index_count / 3; t++)
            coarse += area_on_top(&p, t);
        printf("flat: %.4f of the plate, %.4f before\n", flat / truth, coarse / truth);
        assert_true(fabs(flat / truth - 1) < 0.003);
        mesh_release(&m);
        primitive_release(&p);
    }
}

/* Along the longer side, as bevels bend every way; across it, if only the straight ones bend. */
static void plates_between_bevels_are_drawn_one_way(void **state)
{
    (void)state;
    for (const make *as = makes; as < makes + MAKES; as++) {
        primitive       p;
        direction_field f;
        mesh            m = rounded_plate(as, &p);
        double          along = 0, all = 0, across = as->steep < 1 ? 0 : 1;
        assert_int_equal(direction_field_make(&f, &m.primitives[0], 0.7, 0, 0, NULL), LMN_OK);
        for (uint32_t t = 0; t < m.primitives[0].index_count / 3; t++) {
            double area = area_on_top(&m.primitives[0], t), worst = 0;
            for (uint32_t k = 0; k < 3; k++) {
                const float *is = direction_field_at(&f, &m.primitives[0], 3 * t + k);
                double       twice = atan2(2 * (double)is[3], (double)is[1] - (double)is[0]) - across * field_pi;
                worst = fmax(worst, fabs(remainder(twice, 2 * field_pi)) / 2);
            }
            all += area;
            along += worst < 2 * field_pi / 180 ? area : 0;
        }
        printf("one way: %.4f of the plate\n", along / all);
        assert_true(all > 0.98 * area_of_plate() && along >= 0.98 * all);
        direction_field_release(&f);
        mesh_release(&m);
        primitive_release(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plates_stay_flat_between_bevels),
        cmocka_unit_test(plates_between_bevels_are_drawn_one_way),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
