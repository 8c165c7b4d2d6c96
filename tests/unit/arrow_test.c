/* Arrows on the page: whatever way they tell, none of their pieces folds over, and they are the way where that does not
 * turn sharply. */
#include "import_support.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "depict/depict_private.h"
#include "depict/rounded.h"

enum { POINTS = 40 };

/* Sees x and y as they are, from z. */
static depict_job front_job(void)
{
    depict_job j = {.size = 10};
    j.camera.view = mat4_identity();
    j.camera.projection = mat4_identity();
    j.camera.orthographic = true;
    j.camera.eye[2] = 100;
    j.camera.up[1] = 1;
    return j;
}

/* Triangles that look away, of those with an area: a ribbon's all look to one side. */
static int count_folds(const glyph_mesh *m, double least)
{
    int sides[2] = {0, 0};
    for (size_t i = 0; i + 2 < m->index_count; i += 3) {
        const vec3 *a = &m->positions[m->indices[i]], *b = &m->positions[m->indices[i + 1]],
                   *c = &m->positions[m->indices[i + 2]];
        const double area = (double)((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x)) / 2;
        if (fabs(area) > least)
            sides[area > 0]++;
    }
    return sides[0] < sides[1] ? sides[0] : sides[1];
}

static int folds_of(const double (*points)[3], size_t count, double width, double dash)
{
    const depict_job  j = front_job();
    glyph_mesh        m = {0};
    const arrow_style style = {width, dash, dash / 2, dash > 0 ? 1 : 0.35, 3, 0};
    glyph_put_arrow(&m, &j, points, count, &style);
    assert_false(m.failed);
    if (m.index_count == 0)
        return -1;
    const int folds = count_folds(&m, 1e-5 * width * width);
    glyph_mesh_release(&m);
    return folds;
}

static void nothing_folds(void **state)
{
    enum { WAYS = 500 };
    int folded = 0, empty = 0;
    (void)state;
    for (uint32_t seed = 0; seed < WAYS; seed++) {
        random_source r = random_start(7, seed);
        double        points[POINTS][3];
        const size_t  count = 3 + (size_t)(random_unit(&r) * (POINTS - 4));
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < 3; k++)
                points[i][k] = (i ? points[i - 1][k] : 0) + 2 * random_unit(&r) - 1;
        const double width = 0.05 + 0.35 * random_unit(&r);
        const int    folds = folds_of((const double(*)[3])points, count, width, seed % 2 ? 2.5 * width : 0);
        folded += folds > 0;
        empty += folds < 0;
    }
    if (folded || empty)
        fail_msg("%d of %d arrows fold, %d are empty", folded, WAYS, empty);
}

/* A ball that hits the ground, and one that is thrown straight back. */
static void bounces_do_not_fold(void **state)
{
    (void)state;
    for (double sideways = 0.02; sideways < 2; sideways *= 1.5) {
        double points[POINTS][3];
        for (int i = 0; i < POINTS; i++) {
            const double t = 2.0 * i / (POINTS - 1) - 1;
            vector3_set(points[i], sideways * t, 3 * (1 - (1 - fabs(t)) * (1 - fabs(t))), 0.3 * t);
        }
        const int solid = folds_of((const double(*)[3])points, POINTS, 0.25, 0),
                  dashed = folds_of((const double(*)[3])points, POINTS, 0.25, 0.6);
        if (solid || dashed)
            fail_msg("%g to either side: %d and %d folds", sideways, solid, dashed);
    }
}

/* A circle that is broad enough stays as it is, to the bit. */
static void smooth_ways_stay(void **state)
{
    const depict_job j = front_job();
    double           points[POINTS][3];
    rounded_way      way;
    (void)state;
    for (int i = 0; i < POINTS; i++)
        vector3_set(points[i], 2 * cos(0.1 * i), 2 * sin(0.1 * i), 0.1 * i);
    rounded_make(&way, &j, (const double(*)[3])points, POINTS, 0.5);
    assert_false(way.failed);
    assert_int_equal(way.run_count, 1);
    assert_int_equal(way.point_count, POINTS);
    assert_memory_equal(way.points, points, sizeof points);
    rounded_release(&way);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_folds), cmocka_unit_test(bounces_do_not_fold),
                                       cmocka_unit_test(smooth_ways_stay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
