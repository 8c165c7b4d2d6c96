/* Outlines of letters. The counts, areas and positions are OpenSCAD 2021.01's, with the Liberation fonts; without
 * these most is skipped. */
#include "construct_shapes.h"

static bool has_liberation(void)
{
    region r;
    bool   missing = true;
    assert_int_equal(construct_text(&r, "I", &(text_style){.size = 10, .spacing = 1}, plain, &missing, NULL), LMN_OK);
    region_release(&r);
    if (missing)
        printf("skipped: the Liberation fonts are not installed\n");
    return !missing;
}

/* Makes the text, checks its numbers and where it begins and ends. */
static void assert_text(const char *text, text_style style, double fn, size_t contours, size_t points, double area,
                        const double box[4])
{
    region r;
    double low[2], high[2];
    bool   missing;
    style.size = style.size != 0 ? style.size : 10;
    style.spacing = style.spacing != 0 ? style.spacing : 1;
    assert_int_equal(construct_text(&r, text, &style, (facets){fn, 12, 2}, &missing, NULL), LMN_OK);
    assert_false(missing);
    assert_region(&r, contours, points, area);
    assert_true(region_bounds(&r, low, high));
    assert_close(low[0], box[0], 1e-4);
    assert_close(low[1], box[1], 1e-4);
    assert_close(high[0], box[2], 1e-4);
    assert_close(high[1], box[3], 1e-4);
    region_release(&r);
}

static void letters_are_openscads(void **state)
{
    (void)state;
    if (!has_liberation())
        return;
    assert_text("I", (text_style){0}, 0, 1, 4, 12.37535, (double[]){1.28169, 0, 2.57689, 9.55479});
    assert_text("O", (text_style){0}, 0, 2, 128, 32.7014, (double[]){0.657791, -0.13559, 10.138, 9.69719});
    assert_text("O", (text_style){0}, 4, 2, 64, 32.5449, (double[]){0.657791, -0.13559, 10.138, 9.69719});
    assert_text("O", (text_style){0}, 50, 2, 224, 32.73656, (double[]){0.657791, -0.13559, 10.138, 9.69719});
    assert_text("H", (text_style){.size = -5}, 0, 1, 12, 7.589348, (double[]){-4.44849, -4.77739, -0.56964, 0});
}

static void lines_of_letters_are_openscads(void **state)
{
    (void)state;
    if (!has_liberation())
        return;
    /* Kerning: without it this would end at 34.3. */
    assert_text("AVAV", (text_style){0}, 0, 6, 148, 102.4849, (double[]){0.0271, 0, 33.3223, 9.55479});
    assert_text("II", (text_style){.size = 20, .spacing = 2}, 0, 2, 8, 99.0030,
                (double[]){2.56339, 0, 20.2272, 19.1096});
    assert_text("HI", (text_style){.direction = "rtl"}, 0, 2, 16, 42.7326, (double[]){1.28169, 0, 12.6653, 9.55479});
    assert_text("HI", (text_style){.direction = "ttb"}, 0, 2, 16, 42.7326,
                (double[]){-3.75815, -23.7558, 3.99953, -1.47205});
    assert_text("HI", (text_style){.font = "Liberation Sans:style=Bold"}, 0, 2, 16, 64.232368,
                (double[]){0.92899, 0, 12.7245, 9.55479});
    assert_text("HI", (text_style){.font = "Liberation Mono"}, 0, 2, 24, 48.453488,
                (double[]){1.09859, 0, 15.0901, 9.14789});
}

static void alignments_are_openscads(void **state)
{
    (void)state;
    static const struct {
        text_style style;
        double     x, y; /* where the lower left corner is */
    } cases[] = {
        {{.halign = "left", .valign = "baseline"}, 1.1393, -2.88199},
        {{.valign = "top"}, 1.1393, -12.2132},
        {{.valign = "center"}, 1.1393, -6.13824},
        {{.valign = "bottom"}, 1.1393, -0.06325},
        {{.halign = "bogus", .valign = "bogus"}, 1.1393, -2.88199},
        {{.direction = "ttb", .valign = "top"}, -3.75815, 1.25052},
        {{.direction = "btt", .valign = "center"}, -3.75815, -11.0269},
        {{.direction = "ttb", .valign = "bottom"}, -3.75815, -24.2073},
    };
    if (!has_liberation())
        return;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        region     r;
        double     low[2], high[2];
        bool       missing;
        text_style style = cases[i].style;
        style.size = 10;
        style.spacing = 1;
        assert_int_equal(construct_text(&r, "Hg", &style, plain, &missing, NULL), LMN_OK);
        assert_region(&r, 3, 218, 61.4206);
        assert_true(region_bounds(&r, low, high));
        assert_close(low[0], cases[i].x, 1e-4);
        assert_close(low[1], cases[i].y, 1e-4);
        region_release(&r);
    }
    assert_text("HI", (text_style){.halign = "right", .spacing = 2}, 0, 2, 16, 42.7326,
                (double[]){-25.9875, 0, -4.95981, 9.55479});
    assert_text("HI", (text_style){.halign = "center"}, 0, 2, 16, 42.7326, (double[]){-5.64238, 0, 5.59023, 9.55479});
}

static void other_fonts_stand_in(void **state)
{
    (void)state;
    region     r;
    bool       missing = false;
    text_style style = {.font = "No Such Font", .size = 10, .spacing = 1};
    assert_int_equal(construct_text(&r, "A", &style, plain, &missing, NULL), LMN_OK);
    assert_true(missing);
    assert_true(r.count > 0);
    region_release(&r);
    style.font = "::=-,\xff";
    assert_int_equal(construct_text(&r, "A", &style, plain, &missing, NULL), LMN_OK);
    region_release(&r);
}

static void odd_texts(void **state)
{
    (void)state;
    region     r;
    bool       missing;
    text_style style = {.size = 10, .spacing = 1};
    assert_int_equal(construct_text(&r, "", &style, plain, &missing, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(construct_text(&r, "  ", &style, plain, &missing, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(construct_text(&r, "\xff\xc3(\xe2\x82 \x01", &style, plain, &missing, NULL), LMN_OK);
    region_release(&r);
    assert_int_equal(construct_text(&r, "O", &style, (facets){1e9, 12, 2}, &missing, NULL), LMN_LIMIT);
    style.direction = style.language = style.script = style.halign = style.valign = "?";
    assert_int_equal(construct_text(&r, "\xd9\x85\xd8\xb1 A", &style, plain, &missing, NULL), LMN_OK);
    region_release(&r);
    style.spacing = NAN;
    assert_int_equal(construct_text(&r, "A", &style, plain, &missing, NULL), LMN_FORMAT);
    style = (text_style){.size = 0, .spacing = 1};
    assert_int_equal(construct_text(&r, "A", &style, plain, &missing, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
}

static void letters_become_solids(void **state)
{
    (void)state;
    region     r;
    polyhedron p;
    bool       missing;
    text_style style = {.size = 10, .spacing = 1};
    assert_int_equal(construct_text(&r, "Limner & Co. 2026 @%", &style, plain, &missing, NULL), LMN_OK);
    assert_int_equal(construct_linear_extrude(&p, &r, &(linear_extrusion){3, 0, {1, 1}}, NULL), LMN_OK);
    assert_watertight(&p);
    assert_close(polyhedron_volume(&p), 3 * region_area(&r), 1e-6);
    polyhedron_release(&p);
    region_release(&r);
}

static void memory_may_end_in_texts(void **state)
{
    (void)state;
    lmn_status status = LMN_MEMORY;
    text_style style = {.size = 10, .spacing = 1};
    long       n = 0;
    while (status == LMN_MEMORY) {
        region r;
        bool   missing;
        mem_fail_at(++n);
        status = construct_text(&r, "8i", &style, plain, &missing, NULL);
        mem_fail_at(0);
        region_release(&r);
    }
    assert_int_equal(status, LMN_OK);
    assert_true(n > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(letters_are_openscads),
        cmocka_unit_test(lines_of_letters_are_openscads),
        cmocka_unit_test(alignments_are_openscads),
        cmocka_unit_test(other_fonts_stand_in),
        cmocka_unit_test(odd_texts),
        cmocka_unit_test(letters_become_solids),
        cmocka_unit_test(memory_may_end_in_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
