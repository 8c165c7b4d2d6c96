/* Sheets: what the builder keeps and what it refuses, the words of descriptions, layouts of views, and plotter
 * orders. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "vector/vector_private.h"
#include "export/export.h"

static const colour black = {0, 0, 0, 1};

static void assert_near(double got, double wanted, double tolerance)
{
    if (!(fabs(got - wanted) <= tolerance))
        fail_msg("%.9g is not %.9g", got, wanted);
}

static const float *point_of(const sheet *s, size_t path, size_t i)
{
    return s->points[s->paths[path].first + i];
}

static void test_builder(void **state)
{
    const float line[4][2] = {{1, 2}, {3, 4}, {5, 6}, {7, 8}};
    sheet       s;
    (void)state;
    sheet_begin(&s, 100, 50, 4);
    uint32_t view = sheet_add_group(&s, -1, "view", "view", 0),
             part = sheet_add_group(&s, (int32_t)view, "wheel", NULL, 3);
    sheet_add_path(&s, &(sheet_path){.width = 1}, line, 4); /* without an item: nothing */
    assert_int_equal(s.path_count, 0);
    sheet_add_item(&s, SHEET_PATH, part, black, 0xAB);
    sheet_add_path(&s, &(sheet_path){.width = 0.5f, .closed = true}, line, 4);
    sheet_add_path(&s, &(sheet_path){.width = 0.5f}, line, 2);
    sheet_add_path(&s, &(sheet_path){.width = 0.5f}, line, 1);  /* no line */
    sheet_add_path(&s, &(sheet_path){.filled = true}, line, 2); /* no area */
    sheet_add_text(&s, view, black, "words", 1, 2, 3, 0);
    sheet_add_rectangle(&s, view, black, 10, 20, 30, 40, 1);
    assert_int_equal(s.item_count, 3);
    assert_int_equal(s.items[0].count, 2);
    assert_int_equal(s.items[0].id, 0xAB);
    assert_true(s.paths[0].closed && !s.paths[1].closed);
    assert_float_equal(point_of(&s, 1, 1)[1], 4, 0);
    assert_string_equal(s.items[1].text, "words");
    assert_float_equal(point_of(&s, 2, 2)[0], 40, 0);
    assert_int_equal(s.groups[part].parent, view);
    assert_int_equal(s.groups[sheet_add_group(&s, 99, "lost", NULL, 0)].parent, -1);
    sheet_release(&s);
}

static void test_not_finite(void **state)
{
    const float line[6][2] = {{1, 2}, {3, 4}, {NAN, 6}, {7, 8}, {9, 1}, {3e38f, -3e38f}};
    sheet       s;
    (void)state;
    sheet_begin(&s, NAN, -5, INFINITY);
    assert_true(s.width > 0 && s.height > 0 && s.pixels_per_mm > 0);
    sheet_add_item(&s, SHEET_PATH, 0, black, 0);
    sheet_add_path(&s, &(sheet_path){.width = NAN, .closed = true, .dash_count = 7, .piece_count = 7}, line, 6);
    assert_int_equal(s.path_count, 2); /* broken where it is not finite, and so not closed */
    for (size_t i = 0; i < 2; i++)
        assert_true(!s.paths[i].closed && s.paths[i].width == 0 && s.paths[i].dash_count == 0 &&
                    s.paths[i].piece_count == 0);
    for (size_t i = 0; i < s.point_count; i++)
        assert_true(fabsf(s.points[i][0]) <= 1e6f && fabsf(s.points[i][1]) <= 1e6f);
    sheet_add_text(&s, 0, black, "words", NAN, 2, 3, 0);
    sheet_add_text(&s, 0, black, NULL, 1, 2, 3, 0);
    sheet_add_image(&s, 0, (const unsigned char *)"", 0, 0, 0, INFINITY, 1);
    assert_int_equal(s.item_count, 1);
    sheet_release(&s);
}

static void build_all(sheet *s)
{
    const float line[4][2] = {{1, 2}, {30, 4}, {25, 26}, {7, 8}};
    sheet_begin(s, 100, 50, 4);
    sheet_set_title(s, "title", "description");
    uint32_t view = sheet_add_group(s, -1, "view", "view", 0);
    for (uint32_t i = 0; i < 40; i++) {
        uint32_t part = sheet_add_group(s, (int32_t)view, "part", "visible contour", i + 1);
        sheet_add_item(s, SHEET_PATH, part, (colour){(float)i / 40, 0, 0, 1}, i);
        sheet_add_path(s, &(sheet_path){.width = 0.1f * (float)i}, line, 4);
    }
    sheet_add_text(s, view, black, "words", 1, 2, 3, 0);
}

/* Every allocation fails once, in the builder and in each writer. */
static void test_out_of_memory(void **state)
{
    static lmn_status (*const writers[])(export_bytes *, const sheet *, lmn_error *) = {export_svg, export_pdf,
                                                                                        export_dxf};
    (void)state;
    for (size_t w = 0; w < 3; w++) {
        lmn_status status = LMN_MEMORY;
        long       n = 1;
        for (; status != LMN_OK && n < 5000; n++) {
            sheet        s;
            export_bytes bytes;
            lmn_error    error = {0};
            mem_fail_at(n);
            build_all(&s);
            status = writers[w](&bytes, &s, &error);
            mem_fail_at(0);
            if (status != LMN_OK) {
                assert_int_equal(status, LMN_MEMORY);
                assert_null(bytes.data);
            }
            mem_free(bytes.data);
            sheet_release(&s);
        }
        assert_in_range(n, 20, 4999);
    }
}

/* --- words ---------------------------------------------------------------------------------------------- */

static void test_pages(void **state)
{
    const struct {
        const char *words;
        double      width, height;
    } good[] = {{"A4", 210, 297},         {"a4-landscape", 297, 210}, {"A3", 420, 297}, {"A3-portrait", 297, 420},
                {"letter", 215.9, 279.4}, {"120x80mm", 120, 80},      {"7.5x8", 7.5, 8}};
    const char *const bad[] = {"",    "A",      "A44",   "B4",     "A4-",       "A4-sideways", "120",  "120x",
                               "x80", "0x80mm", "-5x80", "nanx80", "5000x80mm", "120x80in",    "infx2"};
    double            size[2];
    lmn_error         error = {0};
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        assert_int_equal(vector_parse_page(good[i].words, size, &error), LMN_OK);
        assert_near(size[0], good[i].width, 1e-9);
        assert_near(size[1], good[i].height, 1e-9);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(vector_parse_page(bad[i], size, &error), LMN_USAGE);
}

static void test_scales(void **state)
{
    const char *const bad[] = {"", "1", "1:", ":2", "1:0", "0:1", "-1:2", "1:2x", "nan:1", "1:inf", "a:b"};
    const struct {
        double      scale, usual;
        const char *words;
    } usual[] = {{1, 1, "1:1"},      {0.99, 0.5, "1:2"},    {0.7, 0.5, "1:2"},      {0.5, 0.5, "1:2"},
                 {0.49, 0.2, "1:5"}, {0.19, 0.1, "1:10"},   {0.14, 0.1, "1:10"},    {0.05, 0.05, "1:20"},
                 {7, 5, "5:1"},      {9, 5, "5:1"},         {1999, 1000, "1000:1"}, {0.00099, 0.0005, "1:2000"},
                 {1.99, 1, "1:1"},   {2, 2, "2:1"},         {4.99, 2, "2:1"},       {10, 10, "10:1"},
                 {49, 20, "20:1"},   {0.0201, 0.02, "1:50"}};
    double    scale;
    char      words[32];
    lmn_error error = {0};
    (void)state;
    assert_int_equal(vector_parse_scale("1:20", &scale, &error), LMN_OK);
    assert_near(scale, 0.05, 1e-12);
    assert_int_equal(vector_parse_scale("2.5:1", &scale, &error), LMN_OK);
    assert_near(scale, 2.5, 1e-12);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(vector_parse_scale(bad[i], &scale, &error), LMN_USAGE);
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) {
        assert_near(vector_usual_scale(usual[i].scale), usual[i].usual, 1e-9 * usual[i].usual);
        vector_print_scale(words, vector_usual_scale(usual[i].scale));
        assert_string_equal(words, usual[i].words);
    }
    vector_print_scale(words, 1 / 3.7);
    assert_string_equal(words, "1:3.7");
}

/* --- views ---------------------------------------------------------------------------------------------- */

static const vector_view *view_called(const vector_view *views, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(views[i].name, name) == 0)
            return &views[i];
    fail_msg("no view %s", name);
    return NULL;
}

static double middle(const vector_view *v, int k)
{
    return v->box[k] + v->box[2 + k] / 2;
}

/* A box of 40 x 20 x 30 (width, height, depth): its views in line, on the side where the projection has them. */
static void test_layout(void **state)
{
    vector_view views[VIEWS_MOST];
    size_t      count;
    lmn_error   error = {0};
    (void)state;
    assert_int_equal(vector_parse_views("front,top,right,left,iso", views, &count, &error), LMN_OK);
    assert_int_equal(count, 5);
    const double sizes[5][2] = {{40, 20}, {40, 30}, {30, 20}, {30, 20}, {50, 45}};
    for (int first = 0; first < 2; first++) {
        vector_layout      how = {{10, 10, 277, 190}, 10, first ? LMN_FIRST_ANGLE : LMN_THIRD_ANGLE, 0, false, 1};
        double             scale = vector_place_views(&how, views, count, sizes);
        const vector_view *front = view_called(views, count, "front"), *top = view_called(views, count, "top"),
                          *right = view_called(views, count, "right"), *left = view_called(views, count, "left");
        assert_near(middle(front, 0), middle(top, 0), 1e-9);
        assert_near(middle(front, 1), middle(right, 1), 1e-9);
        assert_near(middle(front, 1), middle(left, 1), 1e-9);
        assert_true(first ? middle(top, 1) > middle(front, 1) : middle(top, 1) < middle(front, 1));
        assert_true(first ? middle(right, 0) < middle(front, 0) : middle(right, 0) > middle(front, 0));
        double low[2] = {1e9, 1e9}, high[2] = {0, 0};
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < 2; k++) {
                assert_true(views[i].box[2 + k] >= sizes[i][k] * scale);
                low[k] = fmin(low[k], views[i].box[k]);
                high[k] = fmax(high[k], views[i].box[k] + views[i].box[2 + k]);
                for (size_t n = 0; n < i; n++) /* none over another */
                    assert_true(views[n].box[0] + views[n].box[2] <= views[i].box[0] + 1e-9 ||
                                views[i].box[0] + views[i].box[2] <= views[n].box[0] + 1e-9 ||
                                views[n].box[1] + views[n].box[3] <= views[i].box[1] + 1e-9 ||
                                views[i].box[1] + views[i].box[3] <= views[n].box[1] + 1e-9);
            }
        assert_true(low[0] >= 10 - 1e-9 && low[1] >= 10 - 1e-9 && high[0] <= 287 + 1e-9 && high[1] <= 200 + 1e-9);
        assert_true(high[0] - low[0] > 276 || high[1] - low[1] > 189); /* as large as fits */
    }
    assert_int_equal(vector_parse_views("front,front", views, &count, &error), LMN_USAGE);
    assert_int_equal(vector_parse_views("front,", views, &count, &error), LMN_USAGE);
    assert_int_equal(vector_parse_views("", views, &count, &error), LMN_USAGE);
    assert_int_equal(vector_parse_views("front,tip", views, &count, &error), LMN_USAGE);
}

/* --- plotters ------------------------------------------------------------------------------------------- */

static double travel(const sheet *s)
{
    double distance = 0;
    float  pen[2] = {0, 0};
    for (size_t i = 0; i < s->item_count; i++)
        for (uint32_t k = 0; k < s->items[i].count; k++) {
            const sheet_path *p = &s->paths[s->items[i].first + k];
            const float      *from = s->points[p->first], *to = s->points[p->first + (p->closed ? 0 : p->count - 1)];
            distance += hypot((double)(from[0] - pen[0]), (double)(from[1] - pen[1]));
            memcpy(pen, to, sizeof pen);
        }
    return distance;
}

static void test_plotter(void **state)
{
    enum { LINES = 1000 };
    uint32_t  random = 1;
    sheet     s;
    lmn_error error = {0};
    double    lengths = 0, ordered = 0;
    (void)state;
    sheet_begin(&s, 200, 200, 4);
    uint32_t group = sheet_add_group(&s, -1, "view", NULL, 0);
    for (int i = 0; i < LINES; i++) {
        float ends[2][2];
        for (int k = 0; k < 4; k++) {
            random = random * 1664525u + 1013904223u;
            ends[k / 2][k % 2] =
                k < 2 ? (float)(random >> 8) / 16777216 * 190 : ends[0][k % 2] + (float)(random >> 8) / 16777216 * 10;
        }
        lengths += hypot((double)(ends[1][0] - ends[0][0]), (double)(ends[1][1] - ends[0][1]));
        sheet_add_item(&s, SHEET_PATH, group, i % 2 ? black : (colour){1, 0, 0, 1}, (uint64_t)i + 1);
        sheet_add_path(&s, &(sheet_path){.width = 0.3f}, (const float(*)[2])ends, 2);
    }
    sheet_add_text(&s, group, black, "stays", 1, 2, 3, 0);
    double before = travel(&s);
    assert_int_equal(vector_order_for_plotter(&s, &error), LMN_OK);
    assert_int_equal(s.item_count, LINES + 1);
    bool seen[LINES + 1] = {false};
    int  changes = 0;
    for (size_t i = 0; i < LINES; i++) {
        const float *a = point_of(&s, i, 0), *b = point_of(&s, i, 1);
        ordered += hypot((double)(b[0] - a[0]), (double)(b[1] - a[1]));
        assert_false(seen[s.items[i].id]); /* each once */
        seen[s.items[i].id] = true;
        changes += i > 0 && s.items[i].ink.r != s.items[i - 1].ink.r;
    }
    assert_int_equal(changes, 1);
    assert_near(ordered, lengths, 1e-3 * lengths);
    print_message("way of the pen %.0f mm, before %.0f mm\n", travel(&s), before);
    assert_true(travel(&s) < 6600); /* lines turned round where that is nearer */
    assert_string_equal(s.items[LINES].text, "stays");
    sheet_release(&s);
}

/* A box of 10 by 10: lines and areas end at its sides, dots outside go, what has nothing left goes with its item. */
static void test_clip(void **state)
{
    const float zigzag[4][2] = {{-5, 5}, {5, 5}, {15, 5}, {5, 8}}, square[4][2] = {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}},
                away[2][2] = {{20, 20}, {30, 30}};
    sheet s;
    (void)state;
    sheet_begin(&s, 10, 10, 4);
    uint32_t group = sheet_add_group(&s, -1, "view", NULL, 0);
    sheet_add_item(&s, SHEET_PATH, group, black, 1);
    sheet_add_path(&s, &(sheet_path){.width = 1}, zigzag, 4);
    sheet_add_item(&s, SHEET_PATH, group, black, 2);
    sheet_add_path(&s, &(sheet_path){.closed = true, .filled = true}, square, 4);
    sheet_add_item(&s, SHEET_PATH, group, black, 3);
    sheet_add_path(&s, &(sheet_path){.width = 1}, away, 2);
    sheet_add_item(&s, SHEET_DOTS, group, black, 4);
    sheet_add_path(&s, &(sheet_path){.width = 1}, zigzag, 4);
    sheet_clip(&s, 0, 0, 10, 10);
    assert_false(s.failed);
    assert_int_equal(s.item_count, 3);
    assert_int_equal(s.items[0].count, 2); /* out at the right, and back in */
    assert_near((double)point_of(&s, 0, 0)[0], 0, 1e-6);
    assert_near((double)point_of(&s, 0, s.paths[0].count - 1)[0], 10, 1e-6);
    assert_near((double)point_of(&s, 1, 0)[0], 10, 1e-5);
    assert_near((double)point_of(&s, 1, 0)[1], 6.5, 1e-5);
    assert_near((double)point_of(&s, 1, 1)[1], 8, 1e-6);
    const sheet_path *area = &s.paths[s.items[1].first];
    double            twice = 0;
    for (uint32_t i = 0; i < area->count; i++) {
        const float *a = s.points[area->first + i], *b = s.points[area->first + (i + 1) % area->count];
        twice += (double)a[0] * b[1] - (double)b[0] * a[1];
    }
    assert_near(fabs(twice) / 2, 25, 1e-4);
    assert_int_equal(s.paths[s.items[2].first].count, 2);
    sheet_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_builder), cmocka_unit_test(test_not_finite), cmocka_unit_test(test_out_of_memory),
        cmocka_unit_test(test_pages),   cmocka_unit_test(test_scales),     cmocka_unit_test(test_layout),
        cmocka_unit_test(test_plotter), cmocka_unit_test(test_clip),
    };
    return cmocka_run_group_tests_name("sheet", tests, NULL, NULL);
}
