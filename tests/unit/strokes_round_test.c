/* Lines of coarse meshes drawn as curves (stroke_options.round): rims become ellipses, boxes stay boxes, and what hides
 * lines hides them where it did. */
#include "stroke_shapes.h"

static const double origin[3] = {0, 0, 0};
enum { PAGE = 800, SIDES = 16, RADIUS = 4, FILLET = 6 };

static stroke_camera askew(void)
{
    return look_along(0.3, 0.5, -1, origin, 20, 5, true, PAGE, PAGE);
}

/* A flat disc of few sides. */
static void add_disc(lmn_scene *s)
{
    vec3     positions[SIDES + 1] = {{0, 0, 0}};
    uint32_t corners[3 * SIDES];
    for (uint32_t k = 0; k < SIDES; k++) {
        const uint32_t face[3] = {0, k + 1, (k + 1) % SIDES + 1};
        double         turn = 2 * stroke_pi * k / SIDES;
        positions[k + 1] = (vec3){(float)(RADIUS * cos(turn)), (float)(RADIUS * sin(turn)), 0};
        memcpy(corners + 3 * k, face, sizeof face);
    }
    add_part(s, positions, SIDES + 1, corners, 3 * SIDES);
}

/* A strip with one fillet: a long side, a quarter of a circle, a short side. */
static void add_filleted(lmn_scene *s)
{
    enum { RIM = FILLET + 3 };
    vec3     positions[RIM + 1];
    uint32_t corners[3 * (RIM - 1)], at = 0, count = 0;
    positions[count++] = (vec3){-4, 3, 0};
    positions[count++] = (vec3){-4, -4, 0};
    for (int k = 0; k <= FILLET; k++) {
        double turn = 0.5 * stroke_pi * (k - FILLET) / FILLET;
        positions[count++] = (vec3){(float)(3 + cos(turn)), (float)(-3 + sin(turn)), 0};
    }
    positions[count++] = (vec3){4, 3, 0};
    for (uint32_t k = 1; k + 1 < count; k++, at += 3) {
        const uint32_t face[3] = {0, k, k + 1};
        memcpy(corners + at, face, sizeof face);
    }
    add_part(s, positions, count, corners, at);
}

/* By how much points of strokes lie off the circle that the disc stands for, page units: where they lie on its plane.
 */
static double off_the_disc(const stroke_shot *f, stroke_camera c)
{
    double        most = 0;
    const double *m = c.view.m, unit = PAGE / 10.0; /* the page is 10 high */
    for (size_t i = 0; i < f->set.point_count; i++) {
        const stroke_point *p = &f->set.points[i];
        double              x = (p->x - PAGE / 2.0) / unit, y = (PAGE / 2.0 - p->y) / unit;
        /* x = m0 X + m4 Y, y = m1 X + m5 Y on the plane Z = 0. */
        double whole = m[0] * m[5] - m[4] * m[1], wide = (x * m[5] - m[4] * y) / whole,
               high = (m[0] * y - x * m[1]) / whole;
        most = fmax(most, fabs(hypot(wide, high) - RADIUS) * unit);
    }
    return most;
}

static void rims_are_ellipses(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        lmn_scene *s = stroke_scene_begin();
        add_disc(s);
        stroke_options w = STROKE_OPTIONS_INIT;
        w.simplify = 0.001f;
        w.round = i ? 20 : 0;
        stroke_shot f = shoot(s, askew(), w);
        assert_int_equal(f.set.stroke_count, 1);
        assert_true(i ? f.set.point_count > 3 * SIDES : f.set.point_count == SIDES + 1);
        double off = off_the_disc(&f, askew());
        printf("round %d: %zu points, %.3f off the circle\n", i, f.set.point_count, off);
        assert_true(off < (i ? 0.6 : 0.01)); /* corners lie on it either way; the chords' middles are off by 6 */
        shot_release(&f);
    }
}

static void boxes_stay_boxes(void **state)
{
    (void)state;
    double lengths[2];
    for (int i = 0; i < 2; i++) {
        lmn_scene *s = stroke_scene_begin();
        add_box(s, -3, -2, -1, 3, 2, 1);
        stroke_options w = STROKE_OPTIONS_INIT;
        w.round = i ? 20 : 0;
        w.hidden = true;
        stroke_shot f = shoot(s, look_along(0.5, 1, -0.7, origin, 20, 5, true, PAGE, PAGE), w);
        count_strokes(&f.set, STROKE_CLASS_COUNT, -1, &lengths[i]);
        assert_int_equal(f.check.wrong, 0);
        shot_release(&f);
    }
    assert_true(fabs(lengths[0] - lengths[1]) < 0.01);
}

/* How far from a position on the page the nearest end of a stroke is. */
static double nearest_end(const stroke_set *set, double x, double y)
{
    double least = INFINITY;
    for (size_t n = 0; n < set->stroke_count; n++)
        for (uint32_t k = 0; k < 2; k++) {
            const stroke_point *p = &set->points[set->strokes[n].first + (k ? set->strokes[n].count - 1 : 0)];
            least = fmin(least, hypot(p->x - x, p->y - y));
        }
    return least;
}

/* Posts in front of the long side next to a fillet: short lines beside long ones must not shift where lines are
 * hidden, neither on arcs nor on four-point curves, which leave the straight side by a little near its end. */
static void what_hides_lines_hides_them_there(void **state)
{
    (void)state;
    static const double posts[4] = {-1, 0, 2, 2.5};
    for (int i = 0; i < 3; i++) {
        lmn_scene *s = stroke_scene_begin();
        add_filleted(s);
        add_box(s, posts[0], -4.5, 1, posts[1], 0, 1.5);
        add_box(s, posts[2], -4.5, 1, posts[3], 0, 1.5);
        stroke_options w = STROKE_OPTIONS_INIT;
        w.contours = CONTOURS_NONE;
        w.creases = w.intersections = w.materials = false;
        w.simplify = 0.001f;
        w.round = i == 1 ? 20 : 0;
        w.curve = i == 2 ? 3 : 0;
        stroke_shot f = shoot(s, look_along(0, 0, -1, origin, 20, 5, true, PAGE, PAGE), w);
        double      most = 0;
        for (int k = 0; k < 4; k++)
            most = fmax(most, nearest_end(&f.set, PAGE / 2.0 + posts[k] * PAGE / 10, PAGE / 2.0 + 4 * PAGE / 10.0));
        printf("way %d: ends are off by %.2f\n", i, most);
        assert_true(most < (i < 2 ? 0.1 : 4));
        shot_release(&f);
    }
}

/* A rim of few sides behind a plate that it peeps out from, as drawn and as it is: rays at the facets say the same of
 * curves as of lines, and curves lie no farther from these than they may. */
static void curves_are_verified_where_lines_are(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        lmn_scene *s = stroke_scene_begin();
        add_disc(s);
        add_box(s, -2.9, -2.9, 1, 2.9, 3.9, 1.5);
        stroke_options w = STROKE_OPTIONS_INIT;
        w.round = i ? 20 : 0;
        w.hidden = true;
        stroke_shot f = shoot(s, look_along(0.02, 0.01, -1, origin, 20, 5, true, PAGE, PAGE), w);
        double      most = 0;
        for (size_t k = 0; k < f.set.point_count; k++)
            most = fmax(most, hypot((double)f.set.points[k].aside[0], (double)f.set.points[k].aside[1]));
        printf("round %d: %d samples, %d wrong, up to %.2f aside\n", i, (int)f.check.samples, (int)f.check.wrong, most);
        assert_true(f.check.samples > 100 && f.check.wrong == 0);
        assert_true(i ? most > 4 && most <= 20 : most == 0);
        shot_release(&f);
    }
}

static void memory_may_run_out(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_disc(s);
    stroke_options w = STROKE_OPTIONS_INIT;
    w.round = 2;
    stroke_shot f = shoot(s, askew(), w);
    lmn_status  status = LMN_MEMORY;
    long        n = 1;
    for (; status != LMN_OK && n < 1000; n++) {
        stroke_set set;
        mem_fail_at(n);
        status = stroke_find(&set, f.view, &w, NULL, NULL, NULL, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        if (status == LMN_OK) {
            assert_int_equal(set.point_count, f.set.point_count);
            stroke_set_release(&set);
        }
    }
    assert_true(n > 20 && status == LMN_OK);
    shot_release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rims_are_ellipses),
        cmocka_unit_test(boxes_stay_boxes),
        cmocka_unit_test(what_hides_lines_hides_them_there),
        cmocka_unit_test(curves_are_verified_where_lines_are),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
