/* Automatic exposure: its law, and what it finds on models. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "limner/limner.h"
#include "plan/time.h"
#include "plan/tone_range.h"

static double drawn(tone_range r, double tone)
{
    return pow(fmin(fmax((tone - (double)r.low) * (double)r.gain, 0), 1), (double)r.gamma);
}

/* Tones from one to another, all as frequent. */
static void even(uint32_t counts[TONE_BINS], int from, int to)
{
    memset(counts, 0, TONE_BINS * sizeof *counts);
    for (int i = from; i < to; i++)
        counts[i] = 100;
}

static void ends_become_black_and_paper(void **state)
{
    (void)state;
    uint32_t counts[TONE_BINS];
    even(counts, 64, 192);
    tone_range r = tone_range_of(counts);
    double     low = (64 + 0.05 * 128) / 256, high = (64 + 0.98 * 128) / 256;
    assert_true(fabs(drawn(r, low)) < 1e-3 && fabs(drawn(r, high) - 1) < 1e-3);
    assert_true(fabs(drawn(r, 0.5) - 0.58) < 2e-3); /* the middle one */
    assert_true(drawn(r, low - 0.1) == 0 && drawn(r, high + 0.1) == 1);
}

/* Tones that are nearly alike are not torn apart: they are light. */
static void gain_is_limited(void **state)
{
    (void)state;
    uint32_t counts[TONE_BINS];
    even(counts, 100, 110);
    tone_range r = tone_range_of(counts);
    assert_true(fabs((double)r.gain - 3) < 1e-6);
    assert_true(drawn(r, 109.8 / 256) > 0.99 && drawn(r, 100.0 / 256) > 0.8);
    memset(counts, 0, sizeof counts);
    r = tone_range_of(counts);
    assert_true(r.low == 0 && r.gain == 1 && r.gamma == 1);
    counts[0] = 7;
    r = tone_range_of(counts);
    assert_true(isfinite(r.low) && isfinite(r.gain) && isfinite(r.gamma));
}

static void bend_is_limited(void **state)
{
    (void)state;
    uint32_t counts[TONE_BINS] = {0};
    counts[10] = 1000;
    counts[250] = 60;
    assert_true(fabs((double)tone_range_of(counts).gamma - 0.6) < 1e-6);
    counts[10] = 60;
    counts[250] = 1000;
    counts[249] = 1;
    assert_true(fabs((double)tone_range_of(counts).gamma - 1.7) < 1e-6);
}

/* --- models --------------------------------------------------------------------------------------------- */

static tone_range range_of(const char *model, const char *look_name, double seconds, lmn_view view)
{
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_error     error = {0};
    pose          posed;
    plan          planned;
    view_camera   camera;
    moment        when;
    warnings      list = {0};
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.time_s = seconds;
    desc.view = view;
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(scene, model, NULL, &error), LMN_OK);
    assert_int_equal(lmn_look_load(&look, look_name, &error), LMN_OK);
    assert_int_equal(time_moment(&when, scene, &desc, &list, &error), LMN_OK);
    assert_int_equal(pose_create(&posed, scene, &when, &error), LMN_OK);
    assert_int_equal(plan_create(&planned, &posed, look, &(plan_options){.pixels_per_mm = 4}, &list, &error), LMN_OK);
    assert_int_equal(camera_place(&camera, &desc, &posed, &planned.fit, &error), LMN_OK);
    tone_range out;
    assert_int_equal(tone_range_find(&out, &planned, &camera, &error), LMN_OK);
    plan_release(&planned);
    pose_release(&posed);
    warnings_release(&list);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    return out;
}

static bool same(tone_range a, tone_range b)
{
    return a.automatic == b.automatic && a.low == b.low && a.gain == b.gain && a.gamma == b.gamma;
}

static void models_have_ranges(void **state)
{
    (void)state;
    const char *fox = LIMNER_SOURCE_DIR "/examples/fox.glb", *box = LIMNER_SOURCE_DIR "/examples/box.glb";
    tone_range  none = range_of(fox, "hatch", 0, LMN_VIEW_ISO), r = range_of(fox, "pencil", 0, LMN_VIEW_ISO);
    assert_true(!none.automatic && none.low == 0 && none.gain == 1);
    assert_true(r.automatic && r.gain > 1 && r.gain <= 3 && r.gamma >= 0.6f && r.gamma <= 1.7f);
    assert_true(same(r, range_of(fox, "pencil", 0, LMN_VIEW_ISO)));
    /* Nothing flickers while it runs. */
    assert_true(same(r, range_of(fox, "pencil", 0.3, LMN_VIEW_ISO)));
    /* Another side has other light. */
    assert_false(same(r, range_of(fox, "pencil", 0, LMN_VIEW_BACK)));
    /* Three faces of a box: by the law of the light, the lightest is paper, and the darkest black. */
    r = range_of(box, "charcoal", 0, LMN_VIEW_ISO);
    assert_true(drawn(r, 0) < 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_become_black_and_paper),
        cmocka_unit_test(gain_is_limited),
        cmocka_unit_test(bend_is_limited),
        cmocka_unit_test(models_have_ranges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
