/* What comes back of lines that were left out: what closes a corner, and nothing else; and what goes since it belongs
 * to nothing. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "stroke/stroke_private.h"

enum { STROKES_MOST = 12 };

/* Straight strokes in millimetres on paper. */
typedef struct drawing {
    stroke       strokes[STROKES_MOST];
    stroke_point points[2 * STROKES_MOST];
    uint8_t      gone[STROKES_MOST];
    stroke_set   set;
} drawing;

static size_t add(drawing *d, double x0, double y0, double x1, double y1, bool gone)
{
    const size_t   i = d->set.stroke_count++;
    const float    mm = (float)PAPER_UNITS_PER_MM;
    const uint32_t first = (uint32_t)(2 * i);
    d->strokes[i] = (stroke){.chain = (uint32_t)i, .first = first, .count = 2};
    d->points[first] = (stroke_point){.x = (float)x0 * mm, .y = (float)y0 * mm};
    d->points[first + 1] = (stroke_point){.x = (float)x1 * mm, .y = (float)y1 * mm};
    d->gone[i] = gone;
    d->set.strokes = d->strokes;
    d->set.points = d->points;
    d->set.point_count += 2;
    return i;
}

/* Three sides of a box are drawn, the short fourth one was left out. */
static void test_short_sides_come_back(void **state)
{
    (void)state;
    drawing d = {.set = {0}};
    add(&d, 10, 10, 30, 10, false);
    add(&d, 10, 10, 10, 12, false);
    add(&d, 10, 12, 30, 12, false);
    const size_t side = add(&d, 30, 10, 30, 12, true);
    assert_true(strokes_close_corners(&d.set, d.gone));
    assert_false(d.gone[side]);
}

/* … or in two pieces that meet where nothing is drawn. */
static void test_ways_of_two_come_back(void **state)
{
    (void)state;
    drawing d = {.set = {0}};
    add(&d, 10, 10, 30, 10, false);
    add(&d, 10, 12, 32, 12, false);
    const size_t first = add(&d, 30, 10, 32, 10, true), second = add(&d, 32, 10, 32, 12, true);
    assert_true(strokes_close_corners(&d.set, d.gone));
    assert_false(d.gone[first] || d.gone[second]);
}

static void test_others_stay_away(void **state)
{
    (void)state;
    drawing d = {.set = {0}};
    add(&d, 10, 10, 30, 10, false);
    add(&d, 30, 10, 30, 30, false);
    add(&d, 29, 10, 29, 11, false);
    add(&d, 29, 11, 30, 11, false);
    const size_t beside = add(&d, 20, 10, 21, 10.5, true), /* leads nowhere */
        corner = add(&d, 30, 10, 29, 11, true),            /* the corner is closed already */
        across = add(&d, 10, 10, 30, 28, true),            /* long */
        alone = add(&d, 50, 50, 51, 50, true),             /* touches nothing */
        out = add(&d, 10, 10, 9, 9, true);                 /* leads an end on to nothing that is drawn */
    const size_t all[] = {beside, corner, across, alone, out};
    assert_true(strokes_close_corners(&d.set, d.gone));
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!d.gone[all[i]])
            fail_msg("stroke %zu came back", all[i]);
}

/* A line that ran on beside the end of another one comes back, where both of its ends meet what is drawn. */
static void test_lines_beside_ends_come_back(void **state)
{
    (void)state;
    drawing d = {.set = {0}};
    add(&d, 10, 5, 10, 15, false);
    add(&d, 30, 5, 30, 15, false);
    add(&d, 10, 10, 29, 10, false); /* ends 1 mm before the second one */
    const size_t on = add(&d, 28, 10.2, 30, 10.2, true), far = add(&d, 28, 10.4, 30, 10.4, true);
    add(&d, 28, 10, 28, 11, false);
    assert_true(strokes_close_corners(&d.set, d.gone));
    assert_false(d.gone[on]);
    assert_true(d.gone[far]);
}

/* What lies on other lines goes, but for what closes a corner: the same drawing with and without the corner. */
static void test_thin_lines_close_corners(void **state)
{
    (void)state;
    for (int cornered = 0; cornered < 2; cornered++) {
        drawing d = {.set = {0}};
        add(&d, 10, 10, 30, 10, false);
        add(&d, 30.15, 5, 30.15, 15, false);
        const size_t link = add(&d, 30, 10, 30.15, 10, false);
        if (!cornered)
            add(&d, 30, 10, 25, 15, false);
        memset(d.gone, 0, sizeof d.gone);
        for (size_t i = 0; i < d.set.stroke_count; i++)
            d.points[2 * i + 1].arc = i == link ? 0.5f : 50;
        assert_int_equal(strokes_thin(&d.set, 0.75f, 300, 300, d.gone, NULL), LMN_OK);
        assert_true(d.gone[link]);
        assert_true(strokes_close_corners(&d.set, d.gone));
        assert_int_equal(d.gone[link], !cornered);
    }
}

/* What is hidden neither closes a corner nor has one. */
static void test_hidden_lines_do_not_count(void **state)
{
    (void)state;
    drawing d = {.set = {0}};
    add(&d, 10, 10, 30, 10, false);
    const size_t hidden = add(&d, 30, 12, 10, 12, false), side = add(&d, 30, 10, 30, 12, true);
    d.strokes[hidden].hidden_by = 1;
    assert_true(strokes_close_corners(&d.set, d.gone));
    assert_true(d.gone[side]);
    d.strokes[hidden].hidden_by = 0;
    assert_true(strokes_close_corners(&d.set, d.gone));
    assert_false(d.gone[side]);
}

/* What ends in the open with nothing near it goes, alone or where two meet; with all detail it stays. */
static void test_ticks_go(void **state)
{
    (void)state;
    for (int all = 0; all < 2; all++) {
        drawing d = {.set = {0}};
        add(&d, 10, 10, 60, 10, false);
        const size_t tick = add(&d, 20, 20, 23, 20, false), hook = add(&d, 30, 20, 32, 20, false),
                     hooked = add(&d, 32, 20, 32, 22, false);
        for (size_t i = 0; i < d.set.stroke_count; i++)
            d.strokes[i].kind = STROKE_CREASE;
        assert_true(strokes_drop_orphans(&d.set, all ? 1 : 0.6f, 0, d.gone));
        assert_false(d.gone[0]);
        assert_int_equal(d.gone[tick], !all);
        assert_int_equal(d.gone[hook], !all);
        assert_int_equal(d.gone[hooked], !all);
    }
}

/* What meets or nears other lines stays, and what closes, outlines, long lines and the only ones of a part. */
static void test_lines_that_belong_stay(void **state)
{
    (void)state;
    drawing d = {.set = {0}};
    add(&d, 10, 10, 60, 10, false);
    add(&d, 20, 10, 20, 13, false);    /* meets it */
    add(&d, 30, 8.5, 30, 11.5, false); /* crosses it */
    add(&d, 40, 10.5, 40, 13, false);  /* nears it */
    add(&d, 20, 20, 21, 20, false);    /* three sides that close */
    add(&d, 21, 20, 21, 21, false);
    add(&d, 21, 21, 20, 20, false);
    const size_t outline = add(&d, 30, 30, 32, 30, false), alone = add(&d, 40, 40, 42, 40, false);
    add(&d, 30, 50, 45, 50, false); /* long enough */
    for (size_t i = 0; i < d.set.stroke_count; i++)
        d.strokes[i].kind = i == outline ? STROKE_CONTOUR : STROKE_CREASE;
    d.strokes[alone].part = 7;
    assert_true(strokes_drop_orphans(&d.set, 0.6f, 0, d.gone));
    for (size_t i = 0; i < d.set.stroke_count; i++)
        if (d.gone[i])
            fail_msg("stroke %zu is gone", i);
}

/* With all detail, too, what is shorter than a few of the shortest chains goes where it ends in the open, an outline as
 * well as a crease; a longer one, and one that meets another line, stays. */
static void test_scraps_go_with_all_detail(void **state)
{
    (void)state;
    static const stroke_class kinds[] = {STROKE_CREASE, STROKE_CONTOUR, STROKE_INTERSECTION};
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds; kind++) {
        drawing      d = {.set = {0}};
        const float  shortest = (float)(2 * PAPER_UNITS_PER_MM);
        const size_t outline = add(&d, 10, 10, 60, 10, false), scrap = add(&d, 20, 20, 27, 20, false),
                     line = add(&d, 20, 30, 29, 30, false), branch = add(&d, 40, 10, 40, 13, false);
        for (size_t i = 0; i < d.set.stroke_count; i++)
            d.strokes[i].kind = i == outline ? STROKE_CONTOUR : kinds[kind];
        assert_true(strokes_drop_orphans(&d.set, 1, shortest, d.gone));
        assert_true(d.gone[scrap]);
        assert_false(d.gone[outline] || d.gone[line] || d.gone[branch]);
    }
}

/* A hidden outline that comes along, turns back at a cusp behind one surface more, turns again behind two, and crosses
 * itself on its way: it goes on at the crossing, and so do arcs. What is seen, or large, stays as it is. */
static void test_swallowtails_are_cut(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        const double at[5][2] = {{10, 10}, {22, 10}, {23, 8}, {21, 6}, {21, 20}}, size = kind == 2 ? 10 : 1;
        drawing      d = {.set = {0}};
        float        arc = 0;
        for (size_t i = 0; i < 4; i++) {
            stroke_point *p = &d.points[2 * add(&d, size * at[i][0], size * at[i][1], size * at[i + 1][0],
                                                size * at[i + 1][1], false)];
            p[0].arc = arc;
            p[1].arc = arc += hypotf(p[1].x - p->x, p[1].y - p->y);
            d.strokes[i].chain = 0;
            d.strokes[i].hidden_by = i == 1 ? 2 : i == 2 ? 3 : kind == 1 ? 0 : 1;
        }
        strokes_cut_swallowtails(&d.set);
        assert_int_equal(d.set.stroke_count, kind == 0 ? 2 : 4);
        if (kind != 0)
            continue;
        const stroke_point *end = &d.points[d.strokes[0].first + 1], *begin = &d.points[d.strokes[1].first];
        const double        mm = PAPER_UNITS_PER_MM;
        assert_true(fabs((double)end->x - 21 * mm) < 1e-3 && fabs((double)end->y - 10 * mm) < 1e-3);
        assert_true(fabs((double)begin->x - 21 * mm) < 1e-3 && fabs((double)begin->y - 10 * mm) < 1e-3);
        assert_true(fabs((double)end->arc - 11 * mm) < 1e-3 && fabs((double)begin->arc - 11 * mm) < 1e-3);
        assert_true(fabs((double)begin[1].arc - 21 * mm) < 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_short_sides_come_back),
        cmocka_unit_test(test_ways_of_two_come_back),
        cmocka_unit_test(test_others_stay_away),
        cmocka_unit_test(test_lines_beside_ends_come_back),
        cmocka_unit_test(test_thin_lines_close_corners),
        cmocka_unit_test(test_hidden_lines_do_not_count),
        cmocka_unit_test(test_ticks_go),
        cmocka_unit_test(test_lines_that_belong_stay),
        cmocka_unit_test(test_scraps_go_with_all_detail),
        cmocka_unit_test(test_swallowtails_are_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
