/* Parameter rows: defaults, setting from text, printing, ranges in messages, conditions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "technique/param.h"

typedef struct values {
    int32_t     bands;
    float       width, bias;
    bool        soft;
    int32_t     mode;
    colour      ink, light;
    direction   axis;
    palette     tones;
    param_words words;
} values;

static const char *const modes[] = {"none", "double", "adaptive", NULL};

static const param rows[] = {
    PARAM_INT_ROW(values, bands, .def = 3, .min = 1, .max = 64, .unit = UNIT_COUNT, .doc = "."),
    PARAM_FLOAT_ROW(values, width, .def = 1.5, .min = 0, .max = 64, .unit = UNIT_PT, .doc = "."),
    PARAM_FLOAT_ROW(values, bias, .min = -1, .max = 1, .can_auto = true, .def_auto = true, .doc = "."),
    PARAM_BOOL_ROW(values, soft, .def = 1, .doc = "."),
    PARAM_ENUM_ROW(values, mode, .names = modes, .doc = "."),
    PARAM_COLOUR_ROW(values, ink, .def_colour = {0, 0, 0, 1}, .doc = "."),
    PARAM_COLOUR_ROW(values, light, .can_auto = true, .def_auto = true, .doc = "."),
    PARAM_DIRECTION_ROW(values, axis, .def_direction = {0, 1, 0}, .doc = "."),
    PARAM_PALETTE_ROW(values, tones, .def_palette = {2, {{0, 0, 0, 1}, {1, 1, 1, 1}}}, .doc = "."),
    PARAM_TEXT_ROW(values, words, .doc = "."),
};
enum { BANDS, WIDTH, BIAS, SOFT, MODE, INK, LIGHT, AXIS, TONES, WORDS };

static values defaults(void)
{
    values v;
    memset(&v, 0xA5, sizeof v);
    params_set_defaults(rows, PARAM_COUNT(rows), &v);
    return v;
}

static void test_defaults(void **state)
{
    (void)state;
    values v = defaults();
    assert_int_equal(v.bands, 3);
    assert_float_equal(v.width, 1.5f, 0);
    assert_true(isnan(v.bias));
    assert_true(v.soft);
    assert_int_equal(v.mode, 0);
    assert_float_equal(v.ink.a, 1, 0);
    assert_true(isnan(v.light.r));
    assert_float_equal(v.axis.y, 1, 0);
    assert_int_equal(v.tones.count, 2);
    for (size_t i = 0; i < PARAM_COUNT(rows); i++)
        assert_true(param_is_default(&rows[i], &v));
}

static void test_set_and_print(void **state)
{
    (void)state;
    static const struct {
        int         row;
        const char *text, *printed;
    } cases[] = {
        {BANDS, "64", "64"},
        {BANDS, "+7", "7"},
        {WIDTH, "0.1", "0.1"},
        {WIDTH, "1e1", "10"},
        {WIDTH, "3px", "2.25"},
        {WIDTH, "2pt", "2"},
        {WIDTH, "12.7mm", "36"},
        {WIDTH, "1.27 cm", "36"},
        {WIDTH, "0.5in", "36"},
        {WIDTH, "0.333333343", "0.33333334"},
        {BIAS, "-0.25", "-0.25"},
        {BIAS, "auto", "auto"},
        {SOFT, "no", "false"},
        {SOFT, "true", "true"},
        {MODE, "adaptive", "adaptive"},
        {INK, "red", "#ff0000"},
        {INK, "#12345678", "#12345678"},
        {INK, "none", "#00000000"},
        {LIGHT, "auto", "auto"},
        {LIGHT, "#fff", "#ffffff"},
        {AXIS, "-1, 0.5,2", "-1,0.5,2"},
        {TONES, "#000, red ,#fff8", "#000000,#ff0000,#ffffff88"},
        {WORDS, "name=Räder, x", "name=Räder, x"},
        {WORDS, "", ""},
    };
    for (size_t i = 0; i < PARAM_COUNT(cases); i++) {
        values v = defaults(), again = v;
        char   out[128];
        assert_int_equal(param_set_text(&rows[cases[i].row], &v, cases[i].text, NULL), LMN_OK);
        param_print(&rows[cases[i].row], &v, out, sizeof out);
        assert_string_equal(out, cases[i].printed);
        assert_int_equal(param_set_text(&rows[cases[i].row], &again, out, NULL), LMN_OK);
        param_print(&rows[cases[i].row], &again, out, sizeof out);
        assert_string_equal(out, cases[i].printed);
    }
}

static void test_refused(void **state)
{
    (void)state;
    static const struct {
        int         row;
        const char *text, *message;
    } cases[] = {
        {BANDS, "65", "bands is '65'; allowed is a whole number from 1 to 64"},
        {BANDS, "0", "1 to 64"},
        {BANDS, "3.5", "whole number"},
        {BANDS, "", "1 to 64"},
        {BANDS, "9999999999999999999", "1 to 64"},
        {WIDTH, "64.5", "0 to 64 pt"},
        {WIDTH, "nan", "0 to 64 pt"},
        {WIDTH, "inf", "0 to 64 pt"},
        {WIDTH, "auto", "a number"},
        {WIDTH, "3km", "lengths may say mm, cm, in, pt or px"},
        {BIAS, "nan", "or auto"},
        {SOFT, "maybe", "true or false"},
        {MODE, "adaptve", "none, double, adaptive"},
        {INK, "#12", "colour"},
        {INK, "auto", "colour"},
        {AXIS, "0,0,0", "not all 0"},
        {AXIS, "1,2", "three numbers"},
        {AXIS, "1,2,3,4", "three"},
        {AXIS, "1,nan,0", "three"},
        {TONES, "", "1 to 8"},
        {TONES, "red,", "1 to 8"},
        {WORDS, "two\nlines", "control"},
        {TONES, "#000,#000,#000,#000,#000,#000,#000,#000,#000", "1 to 8"},
    };
    for (size_t i = 0; i < PARAM_COUNT(cases); i++) {
        values    v = defaults();
        lmn_error error = {0};
        assert_int_equal(param_set_text(&rows[cases[i].row], &v, cases[i].text, &error), LMN_USAGE);
        assert_non_null(strstr(error.message, rows[cases[i].row].key));
        if (!strstr(error.message, cases[i].message))
            fail_msg("'%s' gives '%s'", cases[i].text, error.message);
        for (size_t k = 0; k < PARAM_COUNT(rows); k++)
            assert_true(param_is_default(&rows[k], &v));
    }
    lmn_error error = {0};
    values    v = defaults();
    param_set_text(&rows[MODE], &v, "adaptve", &error);
    assert_non_null(strstr(error.hint, "'adaptive'"));
}

static void test_conditions(void **state)
{
    (void)state;
    values v = defaults();
    static const struct {
        const char *condition;
        bool        holds;
    } cases[] = {
        {NULL, true},
        {"soft", true},
        {"!soft", false},
        {"mode", false},
        {"mode=none", true},
        {"mode=double", false},
        {"!mode=double", true},
        {"mode>0", false},
        {"width>1", true},
        {"width<1.5", false},
        {"bands=3", true},
        {"bands>2&width>2", false},
        {"bands>2&soft", true},
        {"bias", false},
        {"bias>0", false},
        {"light", false},
        {"ink", true},
        {"unknown", false},
        {"!unknown", false},
        {"width>", false},
        {"mode=non", false},
        {"", false},
        {"mode=double,none", true},
        {"mode=double,adaptive", false},
        {"!mode=double,adaptive", true},
        {"soft&mode=none,double", true},
        {"mode<2", false},
        {"!mode<2", true},
        {"soft>0", false},
        {"mode=none,", true},
        {"mode=,none", true},
        {"mode=double,", false},
        {"soft&", false},
    };
    for (size_t i = 0; i < PARAM_COUNT(cases); i++)
        if (params_condition(cases[i].condition, rows, PARAM_COUNT(rows), &v) != cases[i].holds)
            fail_msg("condition '%s'", cases[i].condition);
}

static void test_wrong_conditions(void **state)
{
    (void)state;
    static const struct {
        const char *condition, *message; /* NULL: it is right */
    } cases[] = {
        {NULL, NULL},
        {"soft", NULL},
        {"!soft&mode=none,double", NULL},
        {"width>1.5&bands<4", NULL},
        {"bands=3", NULL},
        {"soft=true", NULL},
        {"bias=auto", NULL},
        {"mode", NULL},
        {"sofft", "'sofft'"},
        {"soft&sofft", "'sofft'"},
        {"", "''"},
        {"soft&", "''"},
        {"mode>0", "mode is no number but enum"},
        {"ink<1", "ink is no number"},
        {"width>", "compared with no number"},
        {"width<1px", "no number"},
        {"mode=dubble", "'dubble' is no value of mode"},
        {"mode=none,dubble", "'dubble'"},
        {"mode=none,", "''"},
        {"mode=1", "'1'"},
        {"bands=65", "'65'"},
        {"width=0.50", "'0.50'"},
        {"mode=none|double", "'none|double'"},
    };
    for (size_t i = 0; i < PARAM_COUNT(cases); i++) {
        lmn_error  error = {0};
        lmn_status status = params_condition_check(cases[i].condition, rows, PARAM_COUNT(rows), &error);
        if (status != (cases[i].message ? LMN_USAGE : LMN_OK) ||
            (cases[i].message && !strstr(error.message, cases[i].message)))
            fail_msg("condition '%s' gives '%s'", cases[i].condition, error.message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),   cmocka_unit_test(test_set_and_print),    cmocka_unit_test(test_refused),
        cmocka_unit_test(test_conditions), cmocka_unit_test(test_wrong_conditions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
