/* Chains are whole before anything is decided by their length, and are the same on any page. */
#include "base/memory.h"
#include "stroke_shapes.h"

#include "stroke/stroke_private.h"

#include "stroke/ribbon.h"

static const double origin[3] = {0, 0, 0};

/* A roof ridge of two faces, from x0 to x1 along y = 0. */
static void add_ridge(lmn_scene *s, double x0, double x1)
{
    vec3           p[6] = {{(float)x0, -1, 0}, {(float)x1, -1, 0}, {(float)x0, 0, 1},
                           {(float)x1, 0, 1},  {(float)x0, 1, 0},  {(float)x1, 1, 0}};
    const uint32_t corners[12] = {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4};
    add_part(s, p, 6, corners, 12);
}

static stroke_options creases_alone(void)
{
    stroke_options w = STROKE_OPTIONS_INIT;
    w.contours = CONTOURS_NONE;
    w.borders = w.materials = w.intersections = 0;
    return w;
}

/* 12 roofs of 5 px in a row, first wall to wall, then with half a millimetre between them, then far apart; a ridge of
 * 60 px is longer than 20, one of 5 is not. 100 px a unit. */
static void pieces_count_as_a_whole(void **state)
{
    (void)state;
    const double apart[3] = {0, 0.015, 0.08};
    for (int k = 0; k < 3; k++) {
        lmn_scene *s = stroke_scene_begin();
        for (int i = 0; i < 12; i++)
            add_ridge(s, i * (0.05 + apart[k]) - 0.5, i * (0.05 + apart[k]) - 0.45);
        stroke_options w = creases_alone();
        w.shortest = 20;
        stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
        double      length;
        size_t      count = count_strokes(&shot.set, STROKE_CREASE, 0, &length);
        assert_int_equal(count, k < 2 ? 12 : 0);
        assert_true(k == 2 || fabs(length - 60) < 0.1);
        shot_release(&shot);
    }
}

/* Ends that turn away, or lie at another depth, are not of one line. */
static void strangers_are_not_linked(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        lmn_scene *s = stroke_scene_begin();
        add_ridge(s, -0.11, -0.01);
        add_ridge(s, 0, 0.1);
        node_place *second = node_own_place(&s->nodes[s->node_count - 1]);
        if (k == 1)
            second->translation[2] = -0.5f; /* 50 px deeper */
        if (k == 2)
            second->translation[1] = 0.05f; /* 5 px aside */
        stroke_options w = creases_alone();
        w.shortest = 15;
        stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
        assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 0, NULL), k == 0 ? 2 : 0);
        shot_release(&shot);
    }
}

/* Bars of 2 px and of 12 px before a line: what is thinner than 1.5 widths is drawn over. */
static void thin_bars_do_not_end_a_line(void **state)
{
    (void)state;
    for (int thick = 0; thick < 2; thick++) {
        lmn_scene *s = stroke_scene_begin();
        add_ridge(s, -2, 2);
        double half = thick ? 0.06 : 0.01;
        add_plate(s, -half, -0.4, half, 0.4, 3);
        stroke_options w = creases_alone();
        stroke_shot    shot = shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
        assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 0, NULL), 2); /* the truth */
        assert_int_equal(shot.check.wrong, 0);
        assert_int_equal(shot.set.strokes[0].chain, shot.set.strokes[1].chain);
        stroke_style style = {.width = 2, .crease_width = 1, .repeats = 1, .wobble_length = 40};
        ribbon_set   drawn;
        assert_int_equal(ribbons_make(&drawn, &shot.set, &style, 0, NULL), LMN_OK);
        assert_int_equal(drawn.ribbon_count, thick ? 2 : 1);
        ribbon_set_release(&drawn);
        style.halo = 3; /* what passes in front is to be seen */
        assert_int_equal(ribbons_make(&drawn, &shot.set, &style, 0, NULL), LMN_OK);
        assert_int_equal(drawn.ribbon_count, 2);
        ribbon_set_release(&drawn);
        shot_release(&shot);
    }
}

/* --- density -------------------------------------------------------------------------------------------- */

/* A comb of 60 ridges 1.5 px apart, and one ridge across them all; then the same comb 12 px apart. */
static stroke_shot shoot_comb(double apart, float detail)
{
    lmn_scene *s = stroke_scene_begin();
    for (int i = 0; i < 60; i++) {
        add_ridge(s, -1, 1);
        node_place *n = node_own_place(&s->nodes[s->node_count - 1]);
        n->translation[1] = (float)(apart * (i - 29.5));
        n->scale[1] = 1e-4f;
    }
    add_ridge(s, -3.5, 3.5);
    node_place *across = node_own_place(&s->nodes[s->node_count - 1]);
    across->rotation[2] = across->rotation[3] = (float)sqrt(0.5);
    across->scale[1] = 1e-4f;
    across->translation[2] = 0.5f;
    stroke_options w = creases_alone();
    w.detail = detail;
    w.crowd = 0;
    return shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
}

static bool has_part(const stroke_set *set, uint32_t part)
{
    for (size_t i = 0; i < set->stroke_count; i++)
        if (set->strokes[i].part == part && set->strokes[i].hidden_by == 0)
            return true;
    return false;
}

/* Parallels fuse, those at the rim stay, what crosses stays, and chains go as a whole. */
static void parallels_fuse(void **state)
{
    (void)state;
    stroke_shot all = shoot_comb(0.015, 1), some = shoot_comb(0.015, 0.75f), few = shoot_comb(0.015, 0.3f),
                wide = shoot_comb(0.12, 0.75f);
    assert_int_equal(all.set.chain_count, some.set.chain_count);
    assert_in_range(count_strokes(&all.set, STROKE_CREASE, 0, NULL), 61, 200);
    assert_in_range(count_strokes(&some.set, STROKE_CREASE, 0, NULL), 10, 45);
    assert_true(count_strokes(&few.set, STROKE_CREASE, 0, NULL) < count_strokes(&some.set, STROKE_CREASE, 0, NULL));
    assert_true(has_part(&some.set, 61) && has_part(&few.set, 61));
    assert_true(has_part(&some.set, 1) || has_part(&some.set, 2));
    assert_true(has_part(&some.set, 60) || has_part(&some.set, 59));
    assert_true(count_strokes(&wide.set, STROKE_CREASE, 0, NULL) >= 61);
    for (size_t i = 0; i < some.set.stroke_count; i++) {
        size_t own = 0, before = 0;
        for (size_t k = 0; k < some.set.stroke_count; k++)
            own += some.set.strokes[k].chain == some.set.strokes[i].chain;
        for (size_t k = 0; k < all.set.stroke_count; k++)
            before += all.set.strokes[k].chain == some.set.strokes[i].chain;
        assert_int_equal(own, before);
    }
    shot_release(&all);
    shot_release(&some);
    shot_release(&few);
    shot_release(&wide);
}

/* A slat below a plate, a pixel beside its rim for nine tenths of its own: what reaches beyond the plate is not lost.
 */
static void outlines_that_reach_beyond_others_stay(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_plate(s, -3, 0, 3, 1, 0);
    add_plate(s, -3, -0.01, 3.2, 0.04, -0.5);
    stroke_options w = STROKE_OPTIONS_INIT;
    w.detail = 0.75f;
    w.crowd = 0;
    stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
    assert_true(has_part(&shot.set, 1) && has_part(&shot.set, 2));
    shot_release(&shot);
}

/* A ridge a pixel beside the rim of a plate for three fifths of its length and alone for 240 px stays; one that is
 * alone for 10 px goes. */
static void lines_that_are_alone_for_long_stay(void **state)
{
    (void)state;
    for (int most = 0; most < 2; most++) {
        lmn_scene *s = stroke_scene_begin();
        add_ridge(s, -3, 3);
        add_plate(s, -3.2, 0.01, most ? 2.9 : 0.6, 1, 2);
        stroke_options w = STROKE_OPTIONS_INIT;
        w.contours = CONTOURS_NONE;
        w.detail = 0.75f;
        w.crowd = 0;
        stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
        assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 0, NULL) > 0, !most);
        shot_release(&shot);
    }
}

/* A box of 5 px keeps its outline, drawn finer; one of 100 px its creases too. */
static void small_pieces_keep_their_outlines(void **state)
{
    (void)state;
    for (int large = 0; large < 2; large++) {
        lmn_scene *s = stroke_scene_begin();
        double     half = large ? 0.5 : 0.02;
        add_box(s, -half, -half, -half, half, half, half);
        stroke_options w = STROKE_OPTIONS_INIT;
        w.detail = 0.75f;
        stroke_shot shot = shoot(s, look_along(-1, -1.2, -0.9, origin, 20, 4, true, 800, 800), w);
        assert_int_equal(count_strokes(&shot.set, STROKE_CONTOUR, 0, NULL), 1);
        assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 0, NULL), large ? 3 : 0);
        stroke_style style = {.width = 2, .crease_width = 1, .repeats = 1, .wobble_length = 40};
        ribbon_set   drawn;
        assert_int_equal(ribbons_make(&drawn, &shot.set, &style, 0, NULL), LMN_OK);
        assert_true(large ? drawn.points[0].half == 1 : drawn.points[0].half > 0.3f && drawn.points[0].half < 0.7f);
        ribbon_set_release(&drawn);
        shot_release(&shot);
    }
}

/* --- what outlines of meshes leave ----------------------------------------------------------------------- */

static stroke_point given_points[16];
static stroke       given_strokes[8];

/* A straight outline; a set of these belongs to the test. */
static void give(stroke_set *set, float x0, float y0, float x1, float y1)
{
    stroke *s = &given_strokes[set->stroke_count++];
    *s = (stroke){.kind = STROKE_CONTOUR,
                  .part = 1,
                  .chain = (uint32_t)set->chain_count++,
                  .first = (uint32_t)set->point_count,
                  .count = 2};
    given_points[set->point_count++] = (stroke_point){x0, y0, 5, 0, 1};
    given_points[set->point_count++] = (stroke_point){x1, y1, 5, hypotf(x1 - x0, y1 - y0), 1};
}

/* Two outlines that go on as each other run past each other side by side: they end where they meet, in the middle.
 * Those that lie farther apart, or turn, or leave a gap, stay. */
static void overlaps_become_one_line(void **state)
{
    const struct {
        float x, y, to_x, to_y;
        bool  meets;
    } others[] = {{90, 51.5f, 200, 51.5f, true},   {200, 51.5f, 90, 51.5f, true},  {90, 53, 200, 53, false},
                  {104, 51.5f, 200, 51.5f, false}, {60, 51.5f, 200, 51.5f, false}, {90, 51.5f, 90, 200, false}};
    struct stroke_view view = {.camera = {.orthographic = true, .height = 100, .width = 100}};
    (void)state;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        stroke_set set = {.strokes = given_strokes, .points = given_points};
        uint32_t(*cut)[2];
        size_t count;
        give(&set, 0, 50, 100, 50);
        give(&set, others[i].x, others[i].y, others[i].to_x, others[i].to_y);
        set.points = mem_copy(given_points, set.point_count * sizeof *set.points);
        assert_int_equal(strokes_trim(&set, &view, &cut, &count, NULL), LMN_OK);
        if (others[i]
                .meets) { /* says which ends these are: the first one's last, and the other one's that is near it */
            assert_int_equal(cut[0][0] + cut[0][1], 1 + (i == 1 ? 3 : 2));
            assert_true(cut[0][0] == 1 || cut[0][1] == 1);
        }
        mem_free(cut);
        const stroke_point *p = &set.points[given_strokes[0].first + given_strokes[0].count - 1],
                           *q = &set.points[given_strokes[1].first + (i == 1 ? given_strokes[1].count - 1 : 0)];
        assert_int_equal(count, others[i].meets);
        assert_int_equal(hypotf(p->x - q->x, p->y - q->y) < 0.1f, others[i].meets);
        if (others[i].meets) {
            assert_float_equal(p->x, 95, 0.1);
            assert_float_equal(p->y, 50.75, 1e-3);
            /* Lines bend to there over five units, and know where they lay. */
            assert_int_equal(given_strokes[0].count, 3);
            assert_float_equal(p[-1].x, 90, 1e-3);
            assert_float_equal(p[-1].y, 50, 1e-6);
            assert_float_equal(p->y - p->aside[1], 50, 1e-3);
            assert_float_equal(q->y - q->aside[1], 51.5, 1e-3);
        }
        mem_free(set.points);
    }
}

/* Lines whose ends almost touch become one, each at its own depth, and do not lean for it: what lies more than a few
 * units from where they meet stays where it was found. */
static void joined_lines_do_not_lean(void **state)
{
    struct stroke_view view = {.camera = {.orthographic = true, .height = 100, .width = 100}};
    stroke_options     options = STROKE_OPTIONS_INIT;
    stroke_set         set = {.strokes = NULL};
    (void)state;
    options.shortest = 0;
    give(&set, 0, 50, 100, 50);
    give(&set, 100.6f, 50.6f, 200, 50.6f);
    given_points[3].depth = given_points[2].depth = 5.5f;
    set.strokes = mem_copy(given_strokes, set.stroke_count * sizeof *set.strokes);
    set.points = mem_copy(given_points, set.point_count * sizeof *set.points);
    assert_int_equal(strokes_join(&set, &view, &options, NULL), LMN_OK);
    assert_int_equal(set.stroke_count, 1);
    for (uint32_t i = 0; i < set.strokes[0].count; i++) {
        const stroke_point *p = &set.points[set.strokes[0].first + i];
        if (fabsf(p->x - 100.3f) > 4)
            assert_float_equal(p->y, p->x < 100 ? 50.0f : 50.6f, 1e-4);
        assert_float_equal(p->depth, p->x < 100.3f ? 5.0f : 5.5f, 1e-4);
    }
    assert_int_equal(set.strokes[0].count, 6);
    stroke_set_release(&set);
}

/* Of several that an outline might go on as it takes the one that lies nearest, whichever comes first. */
static void the_nearest_overlap_is_taken(void **state)
{
    struct stroke_view view = {.camera = {.orthographic = true, .height = 100, .width = 100}};
    (void)state;
    for (int order = 0; order < 2; order++) {
        stroke_set set = {.strokes = given_strokes, .points = given_points};
        uint32_t(*cut)[2];
        size_t count;
        give(&set, 0, 50, 100, 50);
        give(&set, 90, order ? 51.8f : 50.4f, 200, order ? 51.8f : 50.4f);
        give(&set, 90, order ? 50.4f : 51.8f, 200, order ? 50.4f : 51.8f);
        set.points = mem_copy(given_points, set.point_count * sizeof *set.points);
        assert_int_equal(strokes_trim(&set, &view, &cut, &count, NULL), LMN_OK);
        mem_free(cut);
        assert_float_equal(set.points[given_strokes[0].first + given_strokes[0].count - 1].y, 50.2, 1e-3);
        mem_free(set.points);
    }
}

/* The same in a set of its own, which joining takes apart. */
static stroke_set own_set(void)
{
    stroke_set given = {.strokes = given_strokes, .points = given_points};
    give(&given, 0, 50, 100, 50);
    give(&given, 90, 51.5f, 200, 51.5f);
    give(&given, 10, 90, 60, 90); /* has nothing to do with these */
    for (size_t i = 0; i < given.stroke_count; i++)
        given_strokes[i].chain_length = given_points[2 * i + 1].arc;
    stroke_set out = given;
    out.strokes = mem_copy(given_strokes, given.stroke_count * sizeof *given_strokes);
    out.points = mem_copy(given_points, given.point_count * sizeof *given_points);
    return out;
}

/* What was cut is one line then, and what lies elsewhere is as it was; without memory there is an error and no more. */
static void what_is_cut_is_joined(void **state)
{
    struct stroke_view view = {.camera = {.orthographic = true, .height = 100, .width = 100}};
    stroke_options     w = STROKE_OPTIONS_INIT;
    lmn_error          error = {0};
    lmn_status         status = LMN_MEMORY;
    long               failures = 0;
    (void)state;
    for (long n = 1; status == LMN_MEMORY; n++) {
        stroke_set set = own_set();
        mem_fail_at(n);
        status = strokes_join(&set, &view, &w, &error);
        mem_fail_at(0);
        failures += status == LMN_MEMORY;
        if (status == LMN_OK) {
            const stroke *s = set.strokes, *joined = s[0].count > 2 ? &s[0] : &s[1], *other = joined == s ? s + 1 : s;
            assert_int_equal(set.stroke_count, 2);
            const stroke_point *p = &set.points[joined->first];
            int                 meets = 0;
            for (uint32_t i = 1; i + 1 < joined->count; i++)
                meets += fabsf(p[i].x - 95) < 0.1f && fabsf(p[i].y - 50.75f) < 0.1f;
            assert_float_equal(p[0].x + p[joined->count - 1].x, 200, 1e-3);
            assert_true(meets > 0);
            assert_int_equal(other->chain, 2);
            assert_int_equal(other->count, 2);
        }
        stroke_set_release(&set);
    }
    assert_int_equal(status, LMN_OK);
    assert_true(failures > 12);
}

/* A short outline that runs along a longer one is a crumb; one that stands on it, or joins two, is not. */
static void crumbs_of_outlines_go(void **state)
{
    const struct {
        float x, y, to_x, to_y;
        bool  stays;
    } crumbs[] = {{40, 51.5f, 52, 51.5f, false},
                  {40, 51.5f, 43, 57, true},
                  {40, 51.5f, 65, 51.5f, true},
                  {40, 54, 52, 54, true},
                  {101, 51, 101, 52.5f, true}};
    (void)state;
    for (size_t i = 0; i < sizeof crumbs / sizeof *crumbs; i++) {
        stroke_set set = {.strokes = given_strokes, .points = given_points};
        uint8_t    gone[2] = {0, 0};
        give(&set, 0, 50, 100, 50);
        give(&set, crumbs[i].x, crumbs[i].y, crumbs[i].to_x, crumbs[i].to_y);
        assert_int_equal(strokes_thin(&set, 0.75f, 300, 300, gone, NULL), LMN_OK);
        assert_int_equal(gone[0], 0);
        assert_int_equal(gone[1], !crumbs[i].stays);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pieces_count_as_a_whole),
                                       cmocka_unit_test(strangers_are_not_linked),
                                       cmocka_unit_test(thin_bars_do_not_end_a_line),
                                       cmocka_unit_test(parallels_fuse),
                                       cmocka_unit_test(outlines_that_reach_beyond_others_stay),
                                       cmocka_unit_test(lines_that_are_alone_for_long_stay),
                                       cmocka_unit_test(small_pieces_keep_their_outlines),
                                       cmocka_unit_test(overlaps_become_one_line),
                                       cmocka_unit_test(joined_lines_do_not_lean),
                                       cmocka_unit_test(the_nearest_overlap_is_taken),
                                       cmocka_unit_test(what_is_cut_is_joined),
                                       cmocka_unit_test(crumbs_of_outlines_go)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
