/* Strokes from SVG drawings and back. Row EX-24, and what artists need of EX-17. */
#include "strokes_support.h"

static strokes read_svg(const char *svg)
{
    strokes   s;
    lmn_error error = {0};
    if (strokes_read_svg(&s, "t.svg", svg, strlen(svg), &error) != LMN_OK)
        fail_msg("%d: %s", error.line, error.message);
    return s;
}

static bool has_stroke(const strokes *s, double u0, double v0, double u1, double v1, int32_t layer)
{
    for (size_t i = 0; i < s->count; i++) {
        const texture_stroke *t = &s->items[i];
        if (fabs((double)t->u0 - u0) + fabs((double)t->v0 - v0) + fabs((double)t->u1 - u1) + fabs((double)t->v1 - v1) <
                1e-5 &&
            t->layer == layer)
            return true;
    }
    return false;
}

static void test_svg_shapes(void **state)
{
    (void)state;
    strokes s =
        read_svg("<?xml version='1.0'?><!DOCTYPE svg><svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>"
                 "<defs><path d='M0 0L9 9'/></defs><rect width='100%' height='100%' fill='white'/>"
                 "<g id='a'><line x1='10' y1='90' x2='20' y2='90'/><polyline points='10,10 20,10 20 20'/></g>"
                 "<g id='hidden' style='fill:none; display : none'><line x2='50' y2='50'/></g>"
                 "<g id='b' transform='translate(50 50) scale(2)'><g transform='rotate(90)'><line x2='10'/></g>"
                 "<polygon points='0 0 5 0 5 5'/><rect x='-10' y='-10' width='5' height='5'/><circle r='0.5' cx='20' "
                 "cy='20'/></g>"
                 "</svg>");
    assert_int_equal(strokes_layer_count(&s), 2);
    assert_int_equal(s.count, 3 + 1 + 3 + 4 + 1);
    assert_true(has_stroke(&s, 0.1, 0.1, 0.2, 0.1, 0));
    assert_true(has_stroke(&s, 0.2, 0.9, 0.2, 0.8, 0));
    assert_true(has_stroke(&s, 0.5, 0.5, 0.5, 0.3, 1));
    assert_true(has_stroke(&s, 0.6, 0.4, 0.5, 0.5, 1));
    assert_true(has_stroke(&s, 0.3, 0.7, 0.4, 0.7, 1));
    assert_true(has_stroke(&s, 0.9, 0.1, 0.9, 0.1, 1)); /* a small circle is a dot */
    /* In drawing order; chords of one element together. */
    assert_near(s.items[0].light, 1, 0);
    assert_true(s.items[0].light > s.items[1].light && same_bits(s.items[1].light, s.items[2].light));
    strokes_release(&s);
    s = read_svg("<svg width='200mm' height='100mm'><line x2='755.905512' y2='377.952756'/></svg>");
    assert_true(has_stroke(&s, 0, 0.5, 1, 0, 0));
    strokes_release(&s);
    s = read_svg("<svg viewBox='0 0 10 10'><g><line x2='1'/><g/><g transform='rotate(90,5 5)'><line x1='5' y1='5' "
                 "x2='7' y2='4'/></g></g></svg>");
    assert_int_equal(s.count, 2);
    assert_true(has_stroke(&s, 0, 0, 0.1, 0, 0) || has_stroke(&s, 0, 1, 0.1, 1, 0)); /* v 1 is v 0 */
    assert_true(has_stroke(&s, 0.5, 0.5, 0.6, 0.3, 1));                              /* in the second group */
    strokes_release(&s);
    s = read_svg("<svg><g><g><path d='M10 10h20v10z'/></g></g></svg>"); /* bounds are the square */
    assert_int_equal(s.count, 3);
    assert_true(has_stroke(&s, 0, 0.5, 1, 0.5, 0));
    strokes_release(&s);
}

/* Sum of lengths, and the largest distance of chord ends from a circle. */
static double length_of(const strokes *s)
{
    double sum = 0;
    for (size_t i = 0; i < s->count; i++)
        sum += stroke_length(&s->items[i]);
    return sum;
}

static void assert_on_circle(const strokes *s, double u, double v, double radius)
{
    for (size_t i = 0; i < s->count; i++) {
        const texture_stroke *t = &s->items[i];
        assert_near(hypot((double)t->u0 - u, (double)t->v0 - v), radius, 1e-3);
        assert_near(hypot(((double)t->u0 + (double)t->u1) / 2 - u, ((double)t->v0 + (double)t->v1) / 2 - v), radius,
                    1.5e-3);
    }
}

static void test_svg_curves(void **state)
{
    static const struct {
        const char *d;
        double      fraction; /* of the circle around 50,50 with radius 30 */
    } rows[] = {
        {"M80 50A30 30 0 0 1 50 80", 0.25},
        {"M80 50A30 30 0 1 0 50 80", 0.75},
        {"M80,50a30,30,0,11-30-30", 0.75},
        {"m80 50a30 30 45 0 1-30 30 30 30 0 0 1-30-30", 0.5},
        {"M20 50A5 5 0 0 1 80 50", 0.5}, /* radii too small grow */
        {"M80 50C80 66.569 66.569 80 50 80S20 66.569 20 50", 0.5},
    };
    const double around = 6.28318530717958648 * 0.3;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char svg[256];
        snprintf(svg, sizeof svg, "<svg viewBox='0 0 100 100'><path d='%s'/></svg>", rows[i].d);
        strokes s = read_svg(svg);
        assert_on_circle(&s, 0.5, 0.5, 0.3);
        assert_near(length_of(&s), rows[i].fraction * around, 2e-3);
        strokes_release(&s);
    }
    strokes s = read_svg("<svg viewBox='0 0 100 100'><circle cx='50' cy='50' r='30'/></svg>");
    assert_on_circle(&s, 0.5, 0.5, 0.3);
    assert_near(length_of(&s), around, 3e-3);
    strokes_release(&s);
    s = read_svg("<svg viewBox='0 0 100 100'><ellipse cx='0' cy='0' rx='60' ry='15' "
                 "transform='translate(50,50)scale(.5,2)'/></svg>");
    assert_on_circle(&s, 0.5, 0.5, 0.3);
    strokes_release(&s);
    /* Parabolas: the length of y = x² from 0 to 1 is 1.4789; the smooth one goes on with it. */
    s = read_svg("<svg viewBox='0 0 2 2'><path d='M0 0Q.5 0 1 1'/></svg>");
    assert_near(length_of(&s), 1.478943 / 2, 1e-3);
    strokes_release(&s);
    s = read_svg("<svg viewBox='0 0 4 4'><path d='M0 0Q.5 0 1 1T2 0'/></svg>");
    assert_true(s.count > 4 && fabs((double)s.items[s.count - 1].u1 - 0.5) < 1e-6);
    strokes_release(&s);
    s = read_svg("<svg viewBox='0 0 4 4'><path d='M0 2Q1 0 2 2T4 2'/></svg>"); /* as far up as down */
    double low = 1, high = 0;
    for (size_t i = 0; i < s.count; i++) {
        low = fmin(low, (double)s.items[i].v0);
        high = fmax(high, (double)s.items[i].v0);
    }
    assert_near(low, 0.25, 2e-3);
    assert_near(high, 0.75, 2e-3);
    strokes_release(&s);
    s = read_svg("<svg viewBox='0 0 10 10'><path d='M5 5z m1 1 2 0-.5.5H1V2'/></svg>");
    assert_int_equal(s.count, 5);
    assert_true(has_stroke(&s, 0.5, 0.5, 0.5, 0.5, 0)); /* a subpath without extent is a dot */
    assert_true(has_stroke(&s, 0.6, 0.4, 0.8, 0.4, 0));
    assert_true(has_stroke(&s, 0.75, 0.35, 0.1, 0.35, 0));
    strokes_release(&s);
    s = read_svg("<svg viewBox='0 0 10 10'><rect x='1' y='1' width='8' height='8' rx='4'/></svg>");
    assert_on_circle(&s, 0.5, 0.5, 0.4);
    strokes_release(&s);
}

/* As they are written: by layer. */
static void sort_layers(strokes *s)
{
    strokes out = {.width = 1};
    for (int32_t layer = 0; layer < strokes_layer_count(s); layer++)
        for (size_t i = 0; i < s->count; i++)
            if (s->items[i].layer == layer)
                assert_true(strokes_add(&out, s->items[i]));
    strokes_release(s);
    *s = out;
}

static void test_svg_round_trip(void **state)
{
    (void)state;
    for (int p = 0; p < PATTERN_COUNT; p++) {
        strokes   s = pattern((stroke_pattern)p, 300, 0.5f, 1), back;
        lmn_error error = {0};
        text      out = {0};
        sort_layers(&s);
        strokes_write_svg(&out, &s);
        assert_int_equal(strokes_read_svg(&back, "t.svg", out.data, out.size, &error), LMN_OK);
        assert_int_equal(back.count, s.count);
        for (size_t i = 0; i < s.count; i++) {
            const texture_stroke *a = &s.items[i], *b = &back.items[i];
            assert_true(same_bits(a->light, b->light) && same_bits(a->perspective, b->perspective));
            assert_int_equal(a->layer, b->layer);
            double du = (double)a->u0 - (double)b->u0, dv = (double)a->v0 - (double)b->v0;
            assert_true(fabs(du - round(du)) < 1e-5 && fabs(dv - round(dv)) < 1e-5);
            assert_near(stroke_length(a), stroke_length(b), 1e-5);
        }
        strokes_release(&s);
        strokes_release(&back);
        text_release(&out);
    }
}

static void assert_svg_refused(const char *svg, size_t size, lmn_status status)
{
    strokes   s;
    lmn_error error = {0};
    assert_int_equal(strokes_read_svg(&s, "bad.svg", svg, size, &error), status);
    assert_string_equal(error.file, "bad.svg");
    assert_true(error.message[0]);
    assert_null(s.items);
}

static void test_svg_refuses(void **state)
{
    static const char *const rows[] = {
        "",
        "hello",
        "<svg",
        "<svg><g></svg>",
        "<html/>",
        "<svg viewBox='0 0 0 1'/>",
        "<svg viewBox='a'/>",
        "<svg viewBox='0 0 1 1'><path d='M0 0L'/></svg>",
        "<svg viewBox='0 0 1 1'><path d='L0 0'/></svg>",
        "<svg viewBox='0 0 1 1'><path d='M0 0 X'/></svg>",
        "<svg viewBox='0 0 1 1'><path d='M0 0 L nan 1'/></svg>",
        "<svg viewBox='0 0 1 1'><path d='M0 0A1 1 0 2 1 1 1'/></svg>",
        "<svg viewBox='0 0 1 1'><line x2='1e308'/></svg>",
        "<svg viewBox='0 0 1 1'><line x2='inf'/></svg>",
        "<svg viewBox='0 0 1 1'><line x2='1furlong'/></svg>",
        "<svg viewBox='0 0 1 1'><polyline points='0 0 1'/></svg>",
        "<svg viewBox='0 0 1 1'><g transform='rotate()'/></svg>",
        "<svg viewBox='0 0 1 1'><g transform='twist(1)'/></svg>",
        "<svg viewBox='0 0 1 1'><line x2='100'/></svg>",
        "<svg><line x2='1e300'/><line x1='-1e308' x2='1e308'/></svg>",
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_svg_refused(rows[i], strlen(rows[i]), LMN_FORMAT);
    strokes     s;
    lmn_error   error = {0};
    const char *line = "<svg viewBox='0 0 1 1'>\n<g>\n<path d='M0 0 L'/></g></svg>";
    assert_int_equal(strokes_read_svg(&s, "l.svg", line, strlen(line), &error), LMN_FORMAT);
    assert_int_equal(error.line, 3);
}

static void test_svg_hostile(void **state)
{
    strokes   s;
    lmn_error error = {0};
    text      t = {0};
    (void)state;
    /* Entities that grow: refused or left alone, but soon and in little memory. */
    text_append(&t, "<!DOCTYPE svg [<!ENTITY a0 'M0 0L1 1'>");
    for (int i = 1; i < 30; i++)
        text_append(&t, "<!ENTITY a%d '&a%d;&a%d;&a%d;&a%d;'>", i, i - 1, i - 1, i - 1, i - 1);
    text_append(&t, "]><svg viewBox='0 0 1 1'><path d='&a29;'/>&a29;</svg>");
    if (strokes_read_svg(&s, "bomb.svg", t.data, t.size, &error) == LMN_OK)
        strokes_release(&s);
    text_release(&t);
    /* A file of the machine is not read. */
    const char *outside =
        "<!DOCTYPE svg [<!ENTITY x SYSTEM 'file:///etc/passwd'>]><svg viewBox='0 0 1 1'><g>&x;</g></svg>";
    if (strokes_read_svg(&s, "x.svg", outside, strlen(outside), &error) == LMN_OK) {
        assert_int_equal(s.count, 0);
        strokes_release(&s);
    }
    for (int i = 0; i < 100000; i++)
        text_append(&t, "<svg>");
    assert_svg_refused(t.data, t.size, LMN_FORMAT);
    text_release(&t);
    text_append(&t, "<svg viewBox='0 0 1 1'>");
    for (int i = 0; i < 230; i++)
        text_append(&t, "<g>");
    for (int i = 0; i < 230; i++)
        text_append(&t, "</g>");
    text_append(&t, "</svg>");
    assert_svg_refused(t.data, t.size, LMN_FORMAT);
    text_release(&t);
    text_append(&t, "<svg viewBox='0 0 1 1'><path d='M0 0");
    for (int i = 0; i < 1000001; i++)
        text_append(&t, i % 2 ? "L1 1" : "L0 1");
    text_append(&t, "'/></svg>");
    assert_svg_refused(t.data, t.size, LMN_LIMIT);
    text_release(&t);
    /* A good one, cut anywhere. */
    strokes good = pattern(PATTERN_BRICK, 60, 0.5f, 1);
    strokes_write_svg(&t, &good);
    for (size_t size = 0; size + 2 < t.size; size += 37) {
        if (strokes_read_svg(&s, "cut.svg", t.data, size, &error) == LMN_OK)
            fail_msg("cut at %zu is read", size);
        assert_null(s.items);
    }
    text_release(&t);
    strokes_release(&good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_svg_shapes),  cmocka_unit_test(test_svg_curves),  cmocka_unit_test(test_svg_round_trip),
        cmocka_unit_test(test_svg_refuses), cmocka_unit_test(test_svg_hostile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
