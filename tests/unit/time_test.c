/* The time that a drawing is of. */
#include "import_support.h"

#include "plan/time.h"

/* Who asks for a picture that is fitted to clips hears that there are none. */
static void fits_to_no_clips_are_said(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        bool        timed;
        const char *said;
    } rows[] = {{"box", false, "the model has no animation"},
                {"box", true, "the model has no animation"},
                {"fox", false, "the model is drawn at rest"},
                {"fox", true, NULL}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char          path[512];
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        warnings      warned = {0};
        lmn_error     error = {0};
        moment        m;
        snprintf(path, sizeof path, LIMNER_SOURCE_DIR "/examples/%s.glb", rows[i].file);
        lmn_scene *s = load_or_fail(path);
        desc.time_given = rows[i].timed;
        assert_int_equal(time_moment(&m, s, &desc, &warned, &error), LMN_OK);
        assert_int_equal(warned.count, 0);
        desc.fit_time = true;
        assert_int_equal(time_moment(&m, s, &desc, NULL, &error), LMN_OK);
        assert_int_equal(time_moment(&m, s, &desc, &warned, &error), LMN_OK);
        assert_int_equal(warned.count, rows[i].said ? 1 : 0);
        if (rows[i].said) {
            assert_non_null(strstr(warned.items[0].text, rows[i].said));
            assert_int_equal(warned.items[0].code, WARNING_UNUSED);
        }
        warnings_release(&warned);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fits_to_no_clips_are_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
