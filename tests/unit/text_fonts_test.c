/* Texts in more than one font, and in both directions: which pieces they are split into, and what is said where no font
 * has a letter. */
#include "import_support.h"

#include "construct/construct.h"
#include "construct/text_fonts.h"

static void join_words(const text_runs *r, char out[256])
{
    size_t size = 0;
    for (size_t i = 0; i < r->count && size < 256; i++)
        size += (size_t)snprintf(out + size, 256 - size, "%s/", r->items[i].words);
}

static void check_runs(const char *words, const char *expected)
{
    text_runs runs = {0};
    lmn_error error = {0};
    char      joined[256];
    if (text_runs_find(&runs, words, "Liberation Sans", &error) != LMN_OK)
        fail_msg("%s: %s", words, error.message);
    join_words(&runs, joined);
    assert_string_equal(joined, expected);
    text_runs_release(&runs);
}

/* One font has all of it; Hebrew begins at the right, and figures within it stay as they are. */
static void runs_stand_from_left_to_right(void **state)
{
    (void)state;
    check_runs("Look, there!", "Look, there!/");
    check_runs("\u05d0\u05d1 abc", "abc/\u05d0\u05d1 /");
    check_runs("abc \u05d0\u05d1", "abc /\u05d0\u05d1/");
}

/* An aeroplane is in no font of the Liberation family. */
static void other_fonts_have_what_one_lacks(void **state)
{
    (void)state;
    text_runs runs = {0};
    lmn_error error = {0};
    if (text_runs_find(&runs, "a \u2708 b", "Liberation Sans", &error) != LMN_OK)
        skip(); /* no other font is installed */
    assert_true(runs.count >= 2);
    assert_string_not_equal(runs.items[0].file, runs.items[1].file);
    text_runs_release(&runs);
    text_style style = {.size = 1, .spacing = 1, .font = "Liberation Sans", .fallback = true};
    region     with, without;
    bool       missing;
    double     low[2], high[2], right;
    assert_int_equal(construct_text(&without, "ab", &style, (facets){.fn = 12}, &missing, &error), LMN_OK);
    assert_true(region_bounds(&without, low, high));
    right = high[0];
    assert_int_equal(construct_text(&with, "a\u2708b", &style, (facets){.fn = 12}, &missing, &error), LMN_OK);
    assert_true(region_bounds(&with, low, high));
    assert_true(high[0] > right + 0.5);
    region_release(&with);
    region_release(&without);
}

static void letters_that_no_font_has_are_named(void **state)
{
    (void)state;
    text_runs runs = {0};
    lmn_error error = {0};
    assert_int_equal(text_runs_find(&runs, "a\U0010fedcb", "Liberation Sans", &error), LMN_UNSUPPORTED);
    assert_non_null(strstr(error.message, "U+10FEDC"));
    assert_int_equal(text_runs_find(&runs, "a\xff", "Liberation Sans", &error), LMN_FORMAT);
    text_runs_release(&runs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_stand_from_left_to_right),
        cmocka_unit_test(other_fonts_have_what_one_lacks),
        cmocka_unit_test(letters_that_no_font_has_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
