/* DXF: read back by the library that CAD programs read it with (dxflib) and equal in coordinates; what is in the
 * text beside them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "base/file_store.h"
#include "export/export.h"
#include "../support/dxf_read.h"

enum { LINES = 300, POINTS_MOST = 12 };

typedef struct reference {
    float    points[POINTS_MOST][2];
    uint32_t count;
    bool     closed;
} reference;

static float number(uint32_t *state, float most)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216 * most;
}

static void build(sheet *s, reference *lines)
{
    static const char *const classes[] = {"visible contour", "hidden crease"};
    uint32_t                 state = 7, groups[2];
    sheet_begin(s, 210, 297, 4);
    for (int i = 0; i < 2; i++)
        groups[i] = sheet_add_group(s, -1, "lines", classes[i], 0);
    for (int i = 0; i < LINES; i++) {
        reference *r = &lines[i];
        r->count = i % 3 == 0 ? 2 : 2 + (uint32_t)number(&state, POINTS_MOST - 2);
        r->closed = r->count > 2 && i % 5 == 0;
        for (uint32_t k = 0; k < r->count; k++) {
            r->points[k][0] = number(&state, 210);
            r->points[k][1] = number(&state, 297);
        }
        sheet_add_item(s, SHEET_PATH, groups[i % 2], (colour){0, 0, 0, 1}, 0);
        sheet_add_path(s, &(sheet_path){.width = 0.3f, .closed = r->closed}, (const float(*)[2])r->points, r->count);
    }
}

#ifdef LIMNER_HAVE_DXFLIB
static void read_sheet(dxf_file *out, const sheet *s)
{
    char         path[] = "/tmp/limner-dxf-XXXXXX";
    export_bytes bytes;
    lmn_error    error = {0};
    int          file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(export_dxf(&bytes, s, &error), LMN_OK);
    assert_int_equal(file_store(path, bytes.data, bytes.size, &error), LMN_OK);
    bool read = dxf_read(out, path);
    unlink(path);
    mem_free(bytes.data);
    assert_true(read);
}
#endif

static void test_read_back(void **state)
{
    (void)state;
#ifdef LIMNER_HAVE_DXFLIB
    static reference lines[LINES];
    const float      dot[1][2] = {{10, 20}};
    sheet            s;
    dxf_file         read;
    double           worst = 0;
    build(&s, lines);
    sheet_add_text(&s, 0, (colour){0, 0, 0, 1}, "words", 30, 40, 10, -1);
    sheet_add_item(&s, SHEET_DOTS, 1, (colour){0, 0, 0, 1}, 0);
    sheet_add_path(&s, &(sheet_path){.width = 4}, dot, 1);
    read_sheet(&read, &s);
    assert_int_equal(read.entity_count, LINES + 2);
    assert_int_equal(read.layer_count, 3);
    for (int i = 0; i < LINES; i++) {
        const dxf_entity *e = &read.entities[i];
        assert_int_equal(e->kind, lines[i].count == 2 ? DXF_LINE : DXF_POLYLINE);
        assert_int_equal(e->count, lines[i].count);
        assert_int_equal(e->closed, lines[i].closed);
        assert_string_equal(e->layer, i % 2 ? "HIDDEN-CREASE" : "VISIBLE-CONTOUR");
        for (uint32_t k = 0; k < lines[i].count; k++) {
            const double *p = read.points[e->first + k];
            worst = fmax(worst, fmax(fabs(p[0] - (double)lines[i].points[k][0]),
                                     fabs(297 - p[1] - (double)lines[i].points[k][1])));
        }
    }
    print_message("the worst place is %.6f mm off\n", worst);
    assert_true(worst <= 0.5e-4 + 1e-9);
    const dxf_entity *text = &read.entities[LINES], *circle = text + 1;
    assert_true(text->kind == DXF_TEXT && strcmp(text->words, "words") == 0 && fabs(text->size - 7.16) < 1e-9);
    assert_true(circle->kind == DXF_CIRCLE && circle->size == 2 && read.points[circle->first][1] == 277);
    dxf_release(&read);
    sheet_release(&s);
#else
    print_message("dxflib is not installed: what is written is not read back\n");
    (void)number, (void)build;
    skip();
#endif
}

static void test_words(void **state)
{
    const float  dot[1][2] = {{10, 20}};
    sheet        s;
    export_bytes bytes;
    lmn_error    error = {0};
    (void)state;
    sheet_begin(&s, 100, 50, 4);
    uint32_t group = sheet_add_group(&s, -1, "odd", "odd \"name\"\n% with very many letters in it", 0);
    sheet_add_text(&s, group, (colour){1, 0, 0, 1}, "S\xC3\xA4ge\n\x01 \xFF end", 30, 40, 10, 0);
    sheet_add_item(&s, SHEET_DOTS, group, (colour){1, 0, 0, 1}, 0);
    sheet_add_path(&s, &(sheet_path){.width = 4}, dot, 1);
    assert_int_equal(export_dxf(&bytes, &s, &error), LMN_OK);
    const char *out = (const char *)bytes.data;
    assert_non_null(strstr(out, "\n1\nS\\U+00E4ge   \\U+FFFD end\n"));
    assert_non_null(
        strstr(out, "0\nTEXT\n8\nODD--NAME----WITH-VERY-MANY-LET\n10\n30.0000\n20\n10.0000\n30\n0.0000\n40\n7.1600\n"));
    assert_non_null(strstr(
        out, "0\nCIRCLE\n8\nODD--NAME----WITH-VERY-MANY-LET\n10\n10.0000\n20\n30.0000\n30\n0.0000\n40\n2.0000\n"));
    assert_non_null(strstr(out, "2\nODD--NAME----WITH-VERY-MANY-LET\n70\n0\n62\n1\n")); /* the layer is red */
    mem_free(bytes.data);
    sheet_release(&s);
}

static void test_nothing(void **state)
{
    sheet        s;
    export_bytes bytes;
    lmn_error    error = {0};
    (void)state;
    sheet_begin(&s, 100, 50, 4);
    assert_int_equal(export_dxf(&bytes, &s, &error), LMN_OK);
    assert_non_null(strstr((const char *)bytes.data, "0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n"));
    mem_free(bytes.data);
    sheet_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_read_back), cmocka_unit_test(test_words),
                                       cmocka_unit_test(test_nothing)};
    return cmocka_run_group_tests_name("dxf", tests, NULL, NULL);
}
