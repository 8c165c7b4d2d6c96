/* limner/strokes.h: arguments that are refused, strokes set one by one, and files through the library. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "limner/limner.h"

static lmn_strokes *create(const lmn_pattern_desc *desc)
{
    lmn_strokes *s = NULL;
    lmn_error    error = {0};
    if (lmn_strokes_create(&s, desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return s;
}

static void refuse_desc(lmn_pattern_desc desc, lmn_status status, const char *message)
{
    lmn_strokes *s = (lmn_strokes *)&desc;
    lmn_error    error = {0};
    assert_int_equal(lmn_strokes_create(&s, &desc, &error), status);
    assert_non_null(strstr(error.message, message));
    assert_null(s);
}

static void test_create(void **state)
{
    const lmn_pattern_desc good = LMN_PATTERN_DESC_INIT;
    lmn_pattern_desc       desc = good;
    lmn_error              error = {0};
    (void)state;
    desc.pattern = (lmn_stroke_pattern)7;
    refuse_desc(desc, LMN_USAGE, "no pattern 7");
    desc = good, desc.length = NAN;
    refuse_desc(desc, LMN_USAGE, "length is nan; allowed is 0 to 4");
    desc = good, desc.uneven = -0.1;
    refuse_desc(desc, LMN_USAGE, "uneven is -0.1; allowed is 0 to 1");
    desc = good, desc.count = 500001;
    refuse_desc(desc, LMN_LIMIT, "allowed are 500000");
    desc = good, desc.struct_size = 0;
    refuse_desc(desc, LMN_USAGE, "struct_size is 0");
    assert_int_equal(lmn_strokes_create(NULL, &good, &error), LMN_USAGE);
    /* A caller that knows less of the struct gets defaults for the rest. */
    desc = good;
    desc.uneven = 99;
    desc.struct_size = offsetof(lmn_pattern_desc, uneven);
    lmn_strokes *s = create(&desc), *none = create(NULL);
    assert_true(lmn_strokes_count(s) > 100);
    assert_int_equal(lmn_strokes_count(none), 0);
    assert_int_equal(lmn_strokes_count(NULL), 0);
    lmn_strokes_destroy(&s);
    lmn_strokes_destroy(&none);
    assert_null(s);
    lmn_strokes_destroy(&s);
    lmn_strokes_destroy(NULL);
    assert_string_equal(lmn_stroke_pattern_name(LMN_PATTERN_RANDOM), "random");
    assert_null(lmn_stroke_pattern_name(7));
    assert_null(lmn_stroke_pattern_name(-1));
}

static void test_set(void **state)
{
    lmn_error    error = {0};
    lmn_strokes *s = create(NULL);
    lmn_stroke   stroke = {1.25f, 0.5f, 1.5f, 0.75f, 1.5f, -1, 3}, got;
    (void)state;
    assert_int_equal(lmn_strokes_get(s, 0, &got, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set(s, 1, &stroke, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set(s, 0, &stroke, &error), LMN_OK);
    assert_int_equal(lmn_strokes_count(s), 1);
    assert_int_equal(lmn_strokes_get(s, 0, &got, &error), LMN_OK);
    assert_true(got.u0 == 0.25f && got.v0 == 0.5f && got.u1 == 0.5f && got.v1 == 0.75f && got.light == 1.5f &&
                got.perspective == -1 && got.layer == 3);
    got.u1 = 0.9f;
    assert_int_equal(lmn_strokes_set(s, 0, &got, &error), LMN_OK);
    assert_int_equal(lmn_strokes_count(s), 1);
    lmn_stroke wrong = got;
    wrong.v1 = 17;
    assert_int_equal(lmn_strokes_set(s, 0, &wrong, &error), LMN_USAGE);
    wrong = got, wrong.u0 = NAN;
    assert_int_equal(lmn_strokes_set(s, 0, &wrong, &error), LMN_USAGE);
    wrong = got, wrong.light = INFINITY;
    assert_int_equal(lmn_strokes_set(s, 0, &wrong, &error), LMN_USAGE);
    wrong = got, wrong.layer = -1;
    assert_int_equal(lmn_strokes_set(s, 1, &wrong, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_count(s), 1);
    assert_int_equal(lmn_strokes_set(s, 0, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set(NULL, 0, &got, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_get(NULL, 0, &got, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_get(s, 0, NULL, &error), LMN_USAGE);
    lmn_strokes_destroy(&s);
}

static void test_priorities(void **state)
{
    lmn_pattern_desc desc = LMN_PATTERN_DESC_INIT;
    lmn_error        error = {0};
    lmn_stroke       stroke;
    (void)state;
    lmn_strokes *s = create(&desc);
    assert_int_equal(lmn_strokes_set_light(s, LMN_ORDER_DRAWN, LMN_FRACTION_COUNT, 0, 0, &error), LMN_OK);
    lmn_strokes_get(s, 0, &stroke, &error);
    assert_true(stroke.light == 1);
    lmn_strokes_get(s, lmn_strokes_count(s) - 1, &stroke, &error);
    assert_true(fabs((double)stroke.light * (double)lmn_strokes_count(s) - 1) < 1e-3);
    assert_int_equal(lmn_strokes_set_perspective(s, LMN_PERSPECTIVE_TIED, 0, &error), LMN_OK);
    lmn_stroke tied;
    lmn_strokes_get(s, 7, &tied, &error);
    assert_true(tied.light == tied.perspective);
    assert_int_equal(lmn_strokes_set_light(s, (lmn_stroke_order)3, LMN_FRACTION_COUNT, 0, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set_light(s, LMN_ORDER_EVEN, LMN_FRACTION_AREA, 0, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set_light(s, LMN_ORDER_EVEN, LMN_FRACTION_AREA, NAN, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set_light(s, LMN_ORDER_EVEN, LMN_FRACTION_AREA, 0.01, 0, &error), LMN_OK);
    assert_int_equal(lmn_strokes_set_perspective(s, (lmn_stroke_perspective)-1, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set_light(NULL, LMN_ORDER_EVEN, LMN_FRACTION_COUNT, 0, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_set_perspective(NULL, LMN_PERSPECTIVE_TIED, 0, &error), LMN_USAGE);
    lmn_strokes_destroy(&s);
}

static void test_files(void **state)
{
    char             folder[] = "/tmp/strokes-XXXXXX", path[64];
    lmn_pattern_desc desc = LMN_PATTERN_DESC_INIT;
    lmn_error        error = {0};
    (void)state;
    desc.pattern = LMN_PATTERN_BRICK;
    lmn_strokes *s = create(&desc), *back = NULL;
    assert_non_null(mkdtemp(folder));
    static const char *const names[] = {"a.stx", "a.svg", "a.PNG"};
    for (int i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        assert_int_equal(lmn_strokes_write(s, path, NULL, NULL, &error), LMN_OK);
        lmn_status status = lmn_strokes_load(&back, path, &error);
        assert_int_equal(status, i < 2 ? LMN_OK : LMN_UNSUPPORTED);
        assert_int_equal(lmn_strokes_count(back), i < 2 ? lmn_strokes_count(s) : 0);
        for (size_t k = 0; i == 0 && k < lmn_strokes_count(s); k++) {
            lmn_stroke a, b;
            lmn_strokes_get(s, k, &a, &error);
            lmn_strokes_get(back, k, &b, &error);
            assert_memory_equal(&a, &b, sizeof a);
        }
        lmn_strokes_destroy(&back);
        unlink(path);
    }
    rmdir(folder);
    lmn_strokes_view view = LMN_STROKES_VIEW_INIT;
    assert_int_equal(lmn_strokes_write(s, "x.gif", NULL, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_write(s, "", NULL, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_write(NULL, "x.stx", NULL, NULL, &error), LMN_USAGE);
    view.size = 0;
    assert_int_equal(lmn_strokes_write(s, "/nosuch/x.png", NULL, &view, &error), LMN_USAGE);
    view = (lmn_strokes_view)LMN_STROKES_VIEW_INIT;
    view.width = -1;
    assert_int_equal(lmn_strokes_write(s, "/nosuch/x.png", NULL, &view, &error), LMN_USAGE);
    view = (lmn_strokes_view)LMN_STROKES_VIEW_INIT;
    view.light = NAN;
    assert_int_equal(lmn_strokes_write(s, "/nosuch/x.png", NULL, &view, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_write(s, "/nosuch/x.png", NULL, NULL, &error), LMN_WRITE);
    assert_int_equal(lmn_strokes_load(&back, "/nosuch/x.stx", &error), LMN_READ);
    assert_int_equal(lmn_strokes_load(&back, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_strokes_load(NULL, "x.stx", &error), LMN_USAGE);
    assert_null(back);
    lmn_strokes_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_create), cmocka_unit_test(test_set),
                                       cmocka_unit_test(test_priorities), cmocka_unit_test(test_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
