/* Stroke textures: files, drawing, priorities, patterns. Rows EX-18 to EX-24 of the seed's table. */
#include "strokes_support.h"

#include "stroke_texture/generate.h"

enum { SIDE = 128 };

static strokes read_text(const char *stx)
{
    strokes   s;
    lmn_error error = {0};
    if (strokes_read(&s, "t.stx", stx, strlen(stx), &error) != LMN_OK)
        fail_msg("%d: %s", error.line, error.message);
    return s;
}

/* --- files (EX-24) --- */

static void assert_same_strokes(const strokes *a, const strokes *b)
{
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        const texture_stroke *x = &a->items[i], *y = &b->items[i];
        assert_true(same_bits(x->u0, y->u0) && same_bits(x->v0, y->v0) && same_bits(x->u1, y->u1) &&
                    same_bits(x->v1, y->v1));
        assert_true(same_bits(x->light, y->light) && same_bits(x->perspective, y->perspective));
        assert_int_equal(x->layer, y->layer);
    }
}

static void round_trip(const strokes *s)
{
    text      written = {0};
    strokes   back;
    lmn_error error = {0};
    strokes_write(&written, s);
    assert_false(written.failed);
    assert_int_equal(strokes_read(&back, "t.stx", written.data, written.size, &error), LMN_OK);
    assert_same_strokes(s, &back);
    strokes_release(&back);
    text_release(&written);
}

static void test_stx_round_trip(void **state)
{
    (void)state;
    for (int p = 0; p < PATTERN_COUNT; p++) {
        strokes s = pattern((stroke_pattern)p, 0, 0.5f, 3);
        round_trip(&s);
        strokes_release(&s);
    }
    /* Every kind of float: of random bits, denormal, negative zero; priorities outside of 0 … 1. */
    strokes  s = {.width = 1};
    uint32_t bits = 12345;
    for (int i = 0; i < 20000; i++) {
        float f[6];
        for (int k = 0; k < 6; k++)
            do {
                bits = bits * 1664525u + 1013904223u;
                uint32_t mixed = bits ^ (bits >> 13) * 2654435761u;
                memcpy(&f[k], &mixed, 4);
            } while (!isfinite(f[k]) || (k < 4 && fabsf(f[k]) > 16));
        assert_true(strokes_add(&s, (texture_stroke){f[0], f[1], f[2], f[3], f[4], f[5], i % 7}));
    }
    assert_true(strokes_add(&s, (texture_stroke){-0.0f, 0x1p-149f, 16, -16, 1.5f, -3, 65535}));
    round_trip(&s);
    strokes_release(&s);
    round_trip(&s); /* no strokes */
}

static void test_stx_reads(void **state)
{
    (void)state;
    strokes s = read_text("\xEF\xBB\xBF# a comment\r\n\r\n 0.25 .5\t1e-1 +1.25 2 -0.5 3 # behind\r\n\n0 0 0 0 1 1 0");
    assert_int_equal(s.count, 2);
    assert_near(s.items[0].u0, 0.25, 0);
    assert_near(s.items[0].v1, 1.25, 0);
    assert_near(s.items[0].light, 2, 0);
    assert_near(s.items[0].perspective, -0.5, 0);
    assert_int_equal(s.items[0].layer, 3);
    assert_int_equal(strokes_layer_count(&s), 4);
    strokes_release(&s);
    s = read_text("");
    assert_int_equal(s.count, 0);
    assert_int_equal(strokes_layer_count(&s), 0);
    strokes_release(&s);
    /* Numbers are as short as they can be. */
    text out = {0};
    s = read_text("0.5 0.1 1 0 1 0.3333333 0\n");
    strokes_write(&out, &s);
    assert_non_null(strstr(out.data, "0.5 0.1 1 0 1 0.3333333 0\n"));
    text_release(&out);
    strokes_release(&s);
}

static void test_stx_refuses(void **state)
{
    static const struct {
        const char *text, *message;
        int         line;
    } rows[] = {
        {"0 0 1 1 1 1\n", "six numbers; a stroke has 7", 1},
        {"# x\n\n0 0 1 1 1 1 0 5\n", "more than seven numbers", 3},
        {"0 0 1 1 1 1 0\nhello\n", "u0 is 'hello'", 2},
        {"0 0 1 1x 1 1 0\n", "v1 is '1x'", 1},
        {"0 0 nan 1 1 1 0\n", "u1 is 'nan'", 1},
        {"inf 0 1 1 1 1 0\n", "u0 is 'inf'", 1},
        {"0 1e308 1 1 1 1 0\n", "allowed is a number from -16 to 16", 1},
        {"0 0 1 1 1e308 1 0\n", "light is '1e308'; allowed is a finite number", 1},
        {"0 0 1 1 1 -inf 0\n", "perspective is '-inf'", 1},
        {"0 0 1 1 1 1 -1\n", "layer is '-1'; allowed is a whole number from 0 to 65535", 1},
        {"0 0 1 1 1 1 0.5\n", "layer is '0.5'", 1},
        {"0 0 1 1 1 1 99999999999\n", "layer is", 1},
        {"0,0,1,1,1,1,0\n", "u0 is '0,0,1,1,1,1,0'", 1},
        {"17 0 1 1 1 1 0\n", "u0 is '17'", 1},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        strokes   s;
        lmn_error error = {0};
        assert_int_equal(strokes_read(&s, "bad.stx", rows[i].text, strlen(rows[i].text), &error), LMN_FORMAT);
        assert_non_null(strstr(error.message, rows[i].message));
        assert_string_equal(error.file, "bad.stx");
        assert_int_equal(error.line, rows[i].line);
        assert_true(error.hint[0]);
        assert_null(s.items);
    }
    strokes   s;
    lmn_error error = {0};
    assert_int_equal(strokes_read(&s, "zero.stx", "0 0 1 1 \0 1 0", 13, &error), LMN_FORMAT);
    text many = {0};
    for (int i = 0; i < 1000001; i++)
        text_append_bytes(&many, "0 0 1 1 1 1 0\n", 14);
    assert_int_equal(strokes_read(&s, "many.stx", many.data, many.size, &error), LMN_LIMIT);
    assert_int_equal(error.line, 1000001);
    text_release(&many);
    assert_int_equal(strokes_load(&s, "nosuch.stx", &error), LMN_READ);
    assert_int_equal(strokes_load(&s, "strokes.gif", &error), LMN_UNSUPPORTED);
}

static void test_wrap(void **state)
{
    (void)state;
    strokes s = read_text("1.25 -0.25 1.5 0.25 1 1 0\n-1e-10 1 0.5 1.5 1 1 0\n0.5 0.5 -3 9 1 1 0\n");
    strokes_wrap(&s);
    assert_near(s.items[0].u0, 0.25, 0);
    assert_near(s.items[0].v0, 0.75, 0);
    assert_near(s.items[0].u1, 0.5, 0);
    assert_near(s.items[0].v1, 1.25, 0);
    assert_near(s.items[1].u0, 0, 0);
    assert_near(s.items[1].u1, 0.5, 0);
    assert_near(s.items[1].v1, 0.5, 0);
    assert_near(s.items[2].v1, 9, 0);
    strokes_release(&s);
}

/* --- drawing (EX-18, EX-23) --- */

typedef struct canvas {
    float ink[SIDE * SIDE];
    int   calls[SIDE * SIDE];
} canvas;

static void record(void *user, size_t index, float coverage)
{
    canvas *c = user;
    assert_true(index < SIDE * SIDE);
    assert_true(coverage > 0 && coverage <= 1);
    c->ink[index] = fmaxf(c->ink[index], coverage);
    c->calls[index]++;
}

/* The same, by looking at all copies of the stroke from every texel. */
static float expected_ink(const texture_stroke *s, int x, int y, double width)
{
    double best = 0, length = stroke_length(s) * SIDE;
    for (int j = -4; j <= 4; j++)
        for (int i = -4; i <= 4; i++) {
            double px = x + 0.5 - ((double)s->u0 + i) * SIDE, py = y + 0.5 - ((double)s->v0 + j) * SIDE;
            double dx = ((double)s->u1 - (double)s->u0) * SIDE, dy = ((double)s->v1 - (double)s->v0) * SIDE;
            double t = length > 0 ? fmax(0, fmin(1, (px * dx + py * dy) / (length * length))) : 0;
            double away = hypot(px - t * dx, py - t * dy);
            best = fmax(best, fmin(fmin(1, width), fmax(0, width / 2 + 0.5 - away)));
        }
    return (float)best;
}

static void test_draw_exact(void **state)
{
    static const texture_stroke rows[] = {
        {0.2f, 0.3f, 0.7f, 0.5f, 1, 1, 0},   {0.9f, 0.9f, 1.2f, 1.1f, 1, 1, 0},
        {0.5f, 0.5f, 0.5f, 0.5f, 1, 1, 0},   {0, 0, 0, 0, 1, 1, 0},
        {0.1f, 0.5f, 1.1f, 0.5f, 1, 1, 0},   {0.3f, 0.2f, 0.3f, -0.9f, 1, 1, 0},
        {0.1f, 0.1f, 2.4f, 1.3f, 1, 1, 0},   {0.99f, 0.01f, 0.01f, 0.99f, 1, 1, 0},
        {0.5f, 0.25f, -1.7f, 0.2f, 1, 1, 0},
    };
    static const double widths[] = {0.4, 1, 2.5, 9};
    static canvas       c;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
            memset(&c, 0, sizeof c);
            stroke_draw(&rows[i], SIDE, &(stroke_brush){.width = widths[k]}, record, &c);
            for (int at = 0; at < SIDE * SIDE; at++) {
                float wanted = expected_ink(&rows[i], at % SIDE, at / SIDE, widths[k]);
                if (c.calls[at] > 1 || fabsf(c.ink[at] - wanted) > 1e-4f)
                    fail_msg("stroke %zu width %g at %d: %g instead of %g, %d calls", i, widths[k], at,
                             (double)c.ink[at], (double)wanted, c.calls[at]);
            }
        }
    stroke_draw(&rows[0], SIDE, &(stroke_brush){.width = 0}, record, &c);
    stroke_draw(&rows[0], 0, &(stroke_brush){.width = 1}, record, &c);
}

static double ink_of(const texture_stroke *s, stroke_brush brush)
{
    static canvas c;
    double        sum = 0;
    memset(&c, 0, sizeof c);
    stroke_draw(s, SIDE, &brush, record, &c);
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (double)c.ink[i];
    return sum;
}

static void test_draw_taper(void **state)
{
    texture_stroke whole = {0.1f, 0.5f, 0.9f, 0.53f, 1, 1, 0};
    double         plain = ink_of(&whole, (stroke_brush){.width = 6}), length = stroke_length(&whole) * SIDE;
    (void)state;
    assert_near(plain, 6 * length + 3.14159 * 9, 3);
    /* A parabola has two thirds of its box; its ends have no caps. */
    assert_near(ink_of(&whole, (stroke_brush){.width = 6, .taper = 0.5}), 6 * length * 2 / 3, 6);
    /* Two halves that know that they are halves are drawn as the whole. */
    strokes        s = read_text("0.1 0.5 0.5 0.5 1 1 0\n0.5 0.5 0.9 0.5 1 1 0\n");
    strokes        one = read_text("0.1 0.5 0.9 0.5 1 1 0\n");
    static uint8_t a[SIDE * SIDE], b[SIDE * SIDE];
    strokes_draw(&s, SIDE, &(stroke_brush){.width = 8, .taper = 0.3}, 0, 0, a);
    strokes_draw(&one, SIDE, &(stroke_brush){.width = 8, .taper = 0.3}, 0, 0, b);
    assert_memory_equal(a, b, sizeof a);
    strokes_release(&s);
    strokes_release(&one);
}

/* A picture that is moved by half its side is the picture of moved strokes. */
static void test_seamless(void **state)
{
    static uint8_t a[SIDE * SIDE], b[SIDE * SIDE];
    (void)state;
    for (int p = 0; p < PATTERN_COUNT; p++) {
        strokes      s = pattern((stroke_pattern)p, 0, 0.6f, 9);
        stroke_brush brush = {.width = 1.7, .taper = 0.1};
        strokes_draw(&s, SIDE, &brush, 0, 0, a);
        for (size_t i = 0; i < s.count; i++) {
            assert_true(s.items[i].u0 >= 0 && s.items[i].u0 < 1 && s.items[i].v0 >= 0 && s.items[i].v0 < 1);
            s.items[i].u0 += 0.5f;
            s.items[i].u1 += 0.5f;
            s.items[i].v0 += 0.5f;
            s.items[i].v1 += 0.5f;
        }
        strokes_wrap(&s);
        strokes_draw(&s, SIDE, &brush, 0, 0, b);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                int moved = ((y + SIDE / 2) % SIDE) * SIDE + (x + SIDE / 2) % SIDE;
                assert_true(abs(a[y * SIDE + x] - b[moved]) <= 1);
            }
        strokes_release(&s);
    }
}

static int compare_floats(const void *a, const void *b)
{
    return *(const float *)a < *(const float *)b ? -1 : *(const float *)a > *(const float *)b;
}

/* Rows are as far apart across the border as within the square, and what sways them goes on there. */
static void test_pattern_repeats(void **state)
{
    (void)state;
    strokes s = pattern(PATTERN_CROSS, 400, 0, 1);
    for (int32_t layer = 0; layer < 4; layer++) {
        float  positions[401];
        size_t count = 0;
        for (size_t i = 0; i < s.count; i++) {
            const texture_stroke *t = &s.items[i];
            double                across[] = {(double)t->v0, (double)t->u0, (double)t->v0 - (double)t->u0,
                                              (double)t->v0 + (double)t->u0};
            if (t->layer == layer)
                positions[count++] = (float)(across[layer] - floor(across[layer] + 1e-6));
        }
        assert_true(count > 60 && count < 400);
        qsort(positions, count, sizeof *positions, compare_floats);
        positions[count] = positions[0] + 1;
        double widest = 0, narrowest = 1;
        for (size_t i = 0; i < count; i++) {
            double gap = (double)positions[i + 1] - (double)positions[i];
            widest = fmax(widest, gap);
            narrowest = gap > 1e-4 ? fmin(narrowest, gap) : narrowest; /* strokes of one row */
        }
        assert_near(widest, narrowest, 1e-4);
    }
    strokes_release(&s);
    random_source chance = random_start(1, 2);
    sway          w = sway_of(&chance, 0.1, 4);
    for (double u = 0; u < 1; u += 0.1) {
        assert_near(sway_at(&w, (position){u, 0.3}), sway_at(&w, (position){u + 1, 0.3}), 1e-9);
        assert_near(sway_at(&w, (position){u, 0.3}), sway_at(&w, (position){u, -1.7}), 1e-9);
    }
}

static void test_preview(void **state)
{
    static uint8_t all[SIDE * SIDE], few[SIDE * SIDE];
    (void)state;
    strokes s = read_text("0.1 0.25 0.4 0.25 0.5 1 0\n0.1 0.75 0.4 0.75 1 0.5 0\n0.6 0.5 0.9 0.5 1.5 1.5 0\n");
    strokes_draw(&s, SIDE, &(stroke_brush){.width = 2}, 0.5f, 0.5f, all);
    strokes_draw(&s, SIDE, &(stroke_brush){.width = 2}, 0.6f, 0.6f, few);
    int quarter = SIDE / 4;
    assert_int_equal(all[quarter * SIDE + quarter], 0);
    assert_int_equal(all[3 * quarter * SIDE + quarter], 0);
    assert_int_equal(few[quarter * SIDE + quarter], 255);
    assert_int_equal(few[3 * quarter * SIDE + quarter], 255);
    assert_int_equal(few[2 * quarter * SIDE + 3 * quarter], 0);
    /* The first is short of light, the second of nearness: which is which. */
    for (int near = 0; near < 2; near++) {
        strokes_draw(&s, SIDE, &(stroke_brush){.width = 2}, near ? 0.4f : 0.6f, near ? 0.6f : 0.4f, few);
        assert_int_equal(few[quarter * SIDE + quarter], near ? 0 : 255);
        assert_int_equal(few[3 * quarter * SIDE + quarter], near ? 255 : 0);
    }
    strokes_draw(&s, SIDE, &(stroke_brush){.width = 2}, 1.2f, 1.2f, few); /* above 1 stays in full light */
    assert_int_equal(few[2 * quarter * SIDE + 3 * quarter], 0);
    strokes_release(&s);
}

/* --- priorities --- */

static void set_light(strokes *s, priority_order order, priority_fraction fraction, double covering, uint32_t seed)
{
    lmn_error error = {0};
    assert_int_equal(strokes_set_light(s, order, fraction, covering, seed, &error), LMN_OK);
}

static void set_perspective(strokes *s, perspective_order order, uint32_t seed)
{
    lmn_error error = {0};
    assert_int_equal(strokes_set_perspective(s, order, seed, &error), LMN_OK);
}

static const strokes *sorted_strokes;

static int compare_light(const void *a, const void *b)
{
    float x = sorted_strokes->items[*(const size_t *)a].light, y = sorted_strokes->items[*(const size_t *)b].light;
    return x > y ? -1 : x < y;
}

static int compare_perspective(const void *a, const void *b)
{
    float x = sorted_strokes->items[*(const size_t *)a].perspective,
          y = sorted_strokes->items[*(const size_t *)b].perspective;
    return x > y ? -1 : x < y;
}

static size_t *sorted(const strokes *s, int (*compare)(const void *, const void *))
{
    size_t *order = malloc(s->count * sizeof *order);
    for (size_t i = 0; i < s->count; i++)
        order[i] = i;
    sorted_strokes = s;
    qsort(order, s->count, sizeof *order, compare);
    return order;
}

/* Chi-square of the quadrants in which the middles of the first strokes lie; the largest over all beginnings. */
static double worst_quadrants(const strokes *s, const size_t *order, size_t least)
{
    double worst = 0, counts[4] = {0}, all[4] = {0};
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < s->count; i++) {
            const texture_stroke *t = &s->items[order[i]];
            double                u = ((double)t->u0 + (double)t->u1) / 2, v = ((double)t->v0 + (double)t->v1) / 2;
            int                   quadrant = 2 * (v - floor(v) >= 0.5) + (u - floor(u) >= 0.5);
            (pass ? counts : all)[quadrant]++;
            if (!pass || i + 1 < least)
                continue;
            double sum = 0;
            for (int q = 0; q < 4; q++) {
                double wanted = (double)(i + 1) * all[q] / (double)s->count;
                sum += (counts[q] - wanted) * (counts[q] - wanted) / wanted;
            }
            worst = fmax(worst, sum);
        }
    return worst;
}

/* Drawing order sweeps over the square; shuffled or even, every beginning is spread over it (EX-19). */
static void test_spread(void **state)
{
    (void)state;
    strokes s = {.width = 1};
    for (int i = 0; i < 400; i++)
        assert_true(strokes_add(&s, (texture_stroke){(float)(i % 20) / 20, (float)(i / 20) / 20,
                                                     (float)(i % 20) / 20 + 0.03f, (float)(i / 20) / 20, 0, 0, 0}));
    set_light(&s, ORDER_DRAWN, FRACTION_COUNT, 0, 0);
    size_t *order = sorted(&s, compare_light);
    assert_true(worst_quadrants(&s, order, 8) > 50);
    free(order);
    for (uint32_t seed = 0; seed < 8; seed++) {
        set_light(&s, ORDER_SHUFFLED, FRACTION_COUNT, 0, seed);
        order = sorted(&s, compare_light);
        /* Three degrees of freedom: 1 in 10,000 is above 21.1. */
        assert_true(worst_quadrants(&s, order, 20) < 21.1);
        free(order);
        set_light(&s, ORDER_EVEN, FRACTION_COUNT, 0, seed);
        order = sorted(&s, compare_light);
        double even = worst_quadrants(&s, order, 8);
        if (even >= 4)
            fail_msg("even, seed %u: %g", seed, even);
        free(order);
    }
    strokes_release(&s);
}

static void test_fraction_length(void **state)
{
    (void)state;
    strokes s = pattern(PATTERN_CROSS, 0, 0.8f, 2);
    double  lengths[4] = {0}, sum = 0, top = 1;
    for (size_t i = 0; i < s.count; i++) {
        lengths[s.items[i].layer] += stroke_length(&s.items[i]);
        sum += stroke_length(&s.items[i]);
    }
    for (int order = ORDER_DRAWN; order <= ORDER_EVEN; order++) {
        set_light(&s, (priority_order)order, FRACTION_LENGTH, 0, 5);
        top = 1;
        for (int k = 0; k < 4; k++) {
            double high = 0, bottom = top - lengths[k] / sum;
            for (size_t i = 0; i < s.count; i++)
                if (s.items[i].layer == k) {
                    high = fmax(high, (double)s.items[i].light);
                    assert_true((double)s.items[i].light > bottom - 1e-6);
                }
            assert_near(high, top, 1e-6);
            top = bottom;
        }
    }
    strokes_release(&s);
}

static double tone(const strokes *s, float threshold, double width, uint8_t *picture, int side)
{
    double sum = 0;
    strokes_draw(s, side, &(stroke_brush){.width = width}, threshold, -1e9f, picture);
    for (int i = 0; i < side * side; i++)
        sum += 255 - picture[i];
    return sum;
}

/* Largest distance of the ink from a straight line. */
static double bend_of_tone(const strokes *s, double width)
{
    enum { FINE = 512, STEPS = 40 };
    static uint8_t picture[FINE * FINE];
    double         all = tone(s, -1, width * FINE, picture, FINE), worst = 0;
    for (int i = 1; i < STEPS; i++) {
        float t = (float)i / STEPS;
        worst = fmax(worst, fabs(tone(s, 1 - t + 1e-7f, width * FINE, picture, FINE) / all - (double)t));
    }
    return worst;
}

static void test_fraction_area(void **state)
{
    static const stroke_pattern rows[] = {PATTERN_CROSS, PATTERN_RANDOM, PATTERN_PARALLEL, PATTERN_STIPPLE,
                                          PATTERN_BRICK};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        strokes s = pattern(rows[i], 0, 0.5f, 4);
        double  width = rows[i] == PATTERN_STIPPLE ? 0.012 : 1.0 / 96;
        set_light(&s, ORDER_EVEN, FRACTION_AREA, width, 1);
        double bend = bend_of_tone(&s, width);
        if (bend >= 0.02)
            fail_msg("%s: tone is %g from straight", stroke_pattern_names[rows[i]], bend);
        if (rows[i] == PATTERN_CROSS) { /* where strokes cover each other, lengths are not enough */
            set_light(&s, ORDER_EVEN, FRACTION_LENGTH, width, 1);
            assert_true(bend_of_tone(&s, width) > 0.04);
        }
        strokes_release(&s);
    }
}

static double rank_correlation(const strokes *s)
{
    size_t *a = sorted(s, compare_light), *b = sorted(s, compare_perspective), *rank = malloc(s->count * sizeof *rank);
    double  sum = 0, n = (double)s->count;
    for (size_t i = 0; i < s->count; i++)
        rank[a[i]] = i;
    for (size_t i = 0; i < s->count; i++)
        sum += ((double)rank[b[i]] - (double)i) * ((double)rank[b[i]] - (double)i);
    free(a);
    free(b);
    free(rank);
    return 1 - 6 * sum / (n * (n * n - 1));
}

static void test_perspective(void **state)
{
    (void)state;
    strokes s = pattern(PATTERN_CROSS, 1200, 0.5f, 6);
    set_perspective(&s, PERSPECTIVE_TIED, 0);
    for (size_t i = 0; i < s.count; i++)
        assert_true(same_bits(s.items[i].light, s.items[i].perspective));
    for (uint32_t seed = 0; seed < 5; seed++) {
        set_perspective(&s, PERSPECTIVE_RANDOM, seed);
        assert_true(fabs(rank_correlation(&s)) < 0.1);
    }
    /* A half, a quarter, an eighth at twice, four times, eight times the distance. */
    for (int order = PERSPECTIVE_RANDOM; order <= PERSPECTIVE_LAYERS; order++) {
        set_perspective(&s, (perspective_order)order, 3);
        for (int k = 0; k < 4; k++) {
            double kept = 0, all = 0;
            for (size_t i = 0; i < s.count; i++) { /* of their number where chance orders them, else of their length */
                double own = order == PERSPECTIVE_RANDOM ? 1 : stroke_length(&s.items[i]);
                kept += (double)s.items[i].perspective >= 1 - pow(2, -k) ? own : 0;
                all += own;
            }
            assert_near(kept / all, pow(2, -k), 0.002);
        }
    }
    for (size_t i = 0; i < s.count; i++) /* layers: what is far has few directions */
        if (s.items[i].perspective >= 0.76f)
            assert_int_equal(s.items[i].layer, 0);
    set_perspective(&s, PERSPECTIVE_EVEN, 3);
    size_t *order = sorted(&s, compare_perspective);
    assert_true(worst_quadrants(&s, order, 8) < 6);
    free(order);
    strokes_release(&s);
}

/* Priorities outside of 0 … 1 are kept by everything but setting them anew. */
static void test_indication(void **state)
{
    (void)state;
    strokes s = read_text("0.1 0.1 0.2 0.1 1.5 -0.5 0\n0.1 0.3 0.2 0.3 0.5 0.5 0\n");
    strokes_wrap(&s);
    assert_true(s.items[0].light > 1 && s.items[0].perspective < 0);
    set_perspective(&s, PERSPECTIVE_RANDOM, 1);
    assert_true(s.items[0].light > 1);
    strokes_release(&s);
}

/* Chords of a curve have one priority; a dot beside a stroke's end is no part of it. */
static void test_curves(void **state)
{
    (void)state;
    strokes s = pattern(PATTERN_SCRIBBLE, 0, 0.5f, 6);
    size_t  curves = 1;
    for (size_t i = 1; i < s.count; i++) {
        bool same = same_bits(s.items[i].light, s.items[i - 1].light);
        assert_int_equal(same, same_bits(s.items[i].perspective, s.items[i - 1].perspective));
        curves += !same;
    }
    assert_true(curves > 40 && curves < 120);
    strokes_release(&s);
    s = read_text("0 0 0.5 0.5 0 0 0\n0.5 0.5 0.5 0.5 0 0 0\n0.5 0.5 0.6 0.6 0 0 1\n");
    set_light(&s, ORDER_DRAWN, FRACTION_COUNT, 0, 0);
    assert_true(s.items[0].light > s.items[1].light && s.items[1].light > s.items[2].light);
    strokes_release(&s);
}

static void test_priority_corners(void **state)
{
    lmn_error error = {0};
    strokes   none = {.width = 1};
    (void)state;
    for (int order = ORDER_DRAWN; order <= ORDER_EVEN; order++)
        for (int fraction = FRACTION_COUNT; fraction <= FRACTION_AREA; fraction++)
            assert_int_equal(
                strokes_set_light(&none, (priority_order)order, (priority_fraction)fraction, 0.01, 1, &error), LMN_OK);
    set_perspective(&none, PERSPECTIVE_EVEN, 1);
    strokes dots = read_text("0.5 0.5 0.5 0.5 0 0 0\n0.2 0.2 0.2 0.2 0 0 0\n");
    set_light(&dots, ORDER_DRAWN, FRACTION_LENGTH, 0, 0);
    assert_near(dots.items[0].light, 1, 0);
    assert_near(dots.items[1].light, 0.5, 1e-6);
    /* All in one place. */
    for (int i = 0; i < 500; i++)
        assert_true(strokes_add(&dots, (texture_stroke){0.5f, 0.5f, 0.5f, 0.5f, 0, 0, 0}));
    set_light(&dots, ORDER_EVEN, FRACTION_AREA, 0.01, 0);
    for (size_t i = 0; i < dots.count; i++)
        assert_true(dots.items[i].light > 0 && dots.items[i].light <= 1);
    strokes_release(&dots);
}

/* --- patterns --- */

static void test_patterns(void **state)
{
    (void)state;
    for (int p = 0; p < PATTERN_COUNT; p++)
        for (int u = 0; u <= 2; u++) {
            strokes a = pattern((stroke_pattern)p, 0, (float)u / 2, 11),
                    b = pattern((stroke_pattern)p, 0, (float)u / 2, 11);
            strokes c = pattern((stroke_pattern)p, 0, (float)u / 2, 12);
            assert_same_strokes(&a, &b);
            assert_true(a.count >= 100);
            if (u > 0)
                assert_true(c.count != a.count || memcmp(a.items, c.items, a.count * sizeof *a.items) != 0);
            for (size_t i = 0; i < a.count; i++) {
                assert_true(isfinite(a.items[i].u1) && isfinite(a.items[i].v1) && fabsf(a.items[i].u1) < 3 &&
                            fabsf(a.items[i].v1) < 3);
                assert_true(a.items[i].light > 0 && a.items[i].light <= 1);
                assert_true(a.items[i].perspective > 0 && a.items[i].perspective < 1);
            }
            strokes_release(&a);
            strokes_release(&b);
            strokes_release(&c);
        }
}

static void test_pattern_counts(void **state)
{
    static const size_t counts[] = {1, 2, 37, 400, 3000};
    (void)state;
    for (int p = 0; p < PATTERN_COUNT; p++)
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
            strokes s = pattern((stroke_pattern)p, counts[i], 0.5f, 1);
            assert_true(s.count > 0);
            if (counts[i] == 3000)
                assert_true(s.count > 2400 && s.count < 3600);
            strokes_release(&s);
        }
    strokes         s;
    lmn_error       error = {0};
    pattern_options many = {.pattern = PATTERN_STIPPLE, .count = (size_t)-1};
    assert_int_equal(strokes_generate(&s, &many, &error), LMN_LIMIT);
    assert_null(s.items);
    pattern_options odd = {.pattern = PATTERN_RANDOM, .count = 10, .length = 1e30f, .uneven = 9};
    assert_int_equal(strokes_generate(&s, &odd, &error), LMN_OK);
    strokes_release(&s);
}

/* Dots of every beginning keep a distance: random ones would come near to 0. */
static void test_stipple_distance(void **state)
{
    (void)state;
    strokes s = pattern(PATTERN_STIPPLE, 2048, 0, 1);
    for (size_t count = 16; count <= s.count; count *= 4) {
        double nearest = 1;
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < i; k++) {
                double du = fabs((double)s.items[i].u0 - (double)s.items[k].u0),
                       dv = fabs((double)s.items[i].v0 - (double)s.items[k].v0);
                nearest = fmin(nearest, hypot(fmin(du, 1 - du), fmin(dv, 1 - dv)));
            }
        /* A hexagonal lattice has 1.07 / sqrt(count). */
        if (nearest * sqrt((double)count) <= 0.5)
            fail_msg("%zu dots: %g", count, nearest * sqrt((double)count));
        assert_true(s.items[count - 1].light < s.items[count - 2].light);
    }
    strokes_release(&s);
}

/* --- memory --- */

static bool read_while_failing(long n)
{
    static const char stx[] = "0 0 1 1 1 1 0\n0 0 1 1 1 1 0\n";
    static const char svg[] = "<svg viewBox='0 0 1 1'><path d='M0 0L1 1L0 1z'/></svg>";
    strokes           s;
    lmn_error         error = {0};
    mem_fail_at(n);
    lmn_status first = strokes_read(&s, "t", stx, sizeof stx - 1, &error);
    strokes_release(&s);
    lmn_status second = strokes_read_svg(&s, "t", svg, sizeof svg - 1, &error);
    text       out = {0};
    if (second == LMN_OK) {
        strokes_write_svg(&out, &s);
        strokes_write(&out, &s);
    }
    bool written = second == LMN_OK && !out.failed;
    text_release(&out);
    strokes_release(&s);
    mem_fail_at(0);
    assert_true(first == LMN_OK || first == LMN_MEMORY);
    assert_true(second == LMN_OK || second == LMN_MEMORY);
    return first == LMN_OK && second == LMN_OK && written;
}

static bool generate_while_failing(stroke_pattern p, long n)
{
    strokes         s;
    lmn_error       error = {0};
    pattern_options options = {.pattern = p, .count = 60, .uneven = 0.5f};
    mem_fail_at(n);
    lmn_status status = strokes_generate(&s, &options, &error);
    if (status == LMN_OK)
        status = strokes_set_light(&s, ORDER_EVEN, FRACTION_AREA, 0.01, 0, &error);
    mem_fail_at(0);
    strokes_release(&s);
    assert_true(status == LMN_OK || status == LMN_MEMORY);
    return status == LMN_OK;
}

static void test_memory(void **state)
{
    (void)state;
    long n = 1;
    while (!read_while_failing(n))
        assert_true(n++ < 1000);
    assert_true(n > 4);
    for (int p = 0; p < PATTERN_COUNT; p++) {
        for (n = 1; !generate_while_failing((stroke_pattern)p, n); n++)
            assert_true(n < 1000);
        assert_true(n > 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stx_round_trip),   cmocka_unit_test(test_stx_reads),
        cmocka_unit_test(test_stx_refuses),      cmocka_unit_test(test_wrap),
        cmocka_unit_test(test_draw_exact),       cmocka_unit_test(test_draw_taper),
        cmocka_unit_test(test_seamless),         cmocka_unit_test(test_pattern_repeats),
        cmocka_unit_test(test_preview),          cmocka_unit_test(test_spread),
        cmocka_unit_test(test_fraction_length),  cmocka_unit_test(test_fraction_area),
        cmocka_unit_test(test_perspective),      cmocka_unit_test(test_indication),
        cmocka_unit_test(test_curves),           cmocka_unit_test(test_priority_corners),
        cmocka_unit_test(test_patterns),         cmocka_unit_test(test_pattern_counts),
        cmocka_unit_test(test_stipple_distance), cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
