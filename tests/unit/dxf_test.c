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
#include "sheet/fit.h"
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

/* --- curves --------------------------------------------------------------------------------------------- */

enum { SHAPES = 6, SHAPE_POINTS = 240, SAMPLES_MOST = 20000 };
static const double pi = 3.14159265358979323846;

/* A circle, a part of one, an ellipse, a part of one, a rounded square, a wave; whole ones are closed. */
static size_t shape(int which, float (*points)[2])
{
    size_t count = which == 0 || which == 2 ? 120 : which == 4 ? 100 : 90;
    for (size_t i = 0; i < count; i++) {
        double t = 2 * pi * (double)i / 120, x = 0, y = 0, turned = which == 3 ? 0.5 : -1.1;
        double centre[2] = {30 + 60.0 * (which % 3), which < 3 ? 50 : 120};
        switch (which) {
        case 0: x = 12 * cos(t), y = 12 * sin(t); break;
        case 1: x = 15 * cos(0.4 - t), y = 15 * sin(0.4 - t); break;
        case 2:
        case 3:
            x = cos(turned) * 18 * cos(t) - sin(turned) * 7 * sin(t);
            y = sin(turned) * 18 * cos(t) + cos(turned) * 7 * sin(t);
            break;
        case 4:
            t = 0.5 * pi * ((double)(i / 25) + (double)(i % 25) / 24);
            x = 5 * cos(t) + (i / 25 == 0 || i / 25 == 3 ? 10 : -10);
            y = 5 * sin(t) + (i / 25 < 2 ? 10 : -10);
            break;
        default: x = 40 * (t / 6 - 0.4), y = 6 * sin(1.3 * t * t / 4); break;
        }
        points[i][0] = (float)(centre[0] + x);
        points[i][1] = (float)(centre[1] + y);
    }
    return count;
}

static void build_curves(sheet *s)
{
    float points[SHAPE_POINTS][2];
    sheet_begin(s, 210, 150, 4);
    uint32_t part = sheet_add_group(s, -1, "K\xC3\xB6rper *1*", "part", 1),
             group = sheet_add_group(s, (int32_t)part, "crease", "hidden crease", 0);
    sheet_add_item(s, SHEET_PATH, group, (colour){0, 0, 0, 1}, 0);
    for (int i = 0; i < SHAPES; i++) {
        size_t count = shape(i, points);
        sheet_add_path(s, &(sheet_path){.width = 0.26f, .curved = true, .closed = i % 2 == 0},
                       (const float(*)[2])points, count);
        sheet_dash_path(s, (const float[2]){2.0f + 0.1f * (float)i, 1.0f + 0.05f * (float)i}, i ? 2 : 0, 0);
    }
    sheet_fit(s, 0.02);
    assert_false(s->failed);
}

typedef struct samples {
    double (*at)[2];
    size_t count;
} samples;

static void add_sample(samples *to, double x, double y)
{
    assert_true(to->count < SAMPLES_MOST);
    to->at[to->count][0] = x;
    to->at[to->count++][1] = y;
}

/* How far the farthest sample of one is from the nearest of the other. */
static double apart(const samples *from, const samples *to)
{
    double most = 0;
    for (size_t i = 0; i < from->count; i++) {
        double least = INFINITY;
        for (size_t k = 0; k < to->count && least > most; k++)
            least = fmin(least, hypot(from->at[i][0] - to->at[k][0], from->at[i][1] - to->at[k][1]));
        most = fmax(most, least);
    }
    return most;
}

/* The shapes' own lines, sampled finely; y up. */
static void sample_shapes(samples *out)
{
    float points[SHAPE_POINTS][2];
    for (int i = 0; i < SHAPES; i++) {
        size_t count = shape(i, points);
        for (size_t k = 0; k + (size_t)(i % 2) < count; k++) {
            const float *a = points[k], *b = points[(k + 1) % count];
            int          pieces = 1 + (int)((double)hypotf(b[0] - a[0], b[1] - a[1]) / 0.05);
            for (int n = 0; n <= pieces; n++)
                add_sample(out, (double)a[0] + (double)(b[0] - a[0]) * n / pieces,
                           150 - (double)a[1] - (double)(b[1] - a[1]) * n / pieces);
        }
    }
}

#ifdef LIMNER_HAVE_DXFLIB
/* From one corner of a polyline to the next one: a bulge is the tangent of a quarter of what the arc turns. */
static void sample_bulge(samples *out, const double a[2], const double b[2], double bulge)
{
    double whole = 4 * atan(bulge), chord = hypot(b[0] - a[0], b[1] - a[1]), radius = chord / (2 * sin(whole / 2)),
           from = atan2(b[1] - a[1], b[0] - a[0]) - whole / 2 - pi / 2;
    for (int i = 0; i <= 400; i++) {
        double t = from + whole * i / 400;
        if (fabs(bulge) < 1e-9)
            add_sample(out, a[0] + (b[0] - a[0]) * i / 400, a[1] + (b[1] - a[1]) * i / 400);
        else
            add_sample(out, a[0] + radius * (cos(t) - cos(from)), a[1] + radius * (sin(t) - sin(from)));
    }
}

static void sample_entity(samples *out, const dxf_file *f, const dxf_entity *e)
{
    const double(*p)[2] = (const double(*)[2])f->points + e->first;
    double to = e->kind == DXF_ARC && e->angles[1] < e->angles[0] ? e->angles[1] + 360 : e->angles[1];
    for (int i = 0; i <= 2000; i++) {
        double t = (double)i / 2000, angle = e->angles[0] + t * (to - e->angles[0]);
        if (e->kind == DXF_CIRCLE)
            add_sample(out, p[0][0] + e->size * cos(2 * pi * t), p[0][1] + e->size * sin(2 * pi * t));
        if (e->kind == DXF_ARC)
            add_sample(out, p[0][0] + e->size * cos(angle * pi / 180), p[0][1] + e->size * sin(angle * pi / 180));
        if (e->kind == DXF_ELLIPSE)
            add_sample(out, p[0][0] + p[1][0] * cos(angle) - e->size * p[1][1] * sin(angle),
                       p[0][1] + p[1][1] * cos(angle) + e->size * p[1][0] * sin(angle));
    }
    for (size_t k = 0; k + 3 < e->count && e->kind == DXF_SPLINE; k += 3)
        for (int i = 0; i <= 400; i++) {
            double u = i / 400.0, v = 1 - u, w[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u},
                   at[2] = {0, 0};
            for (int n = 0; n < 8; n++)
                at[n % 2] += w[n / 2] * p[k + (size_t)n / 2][n % 2];
            add_sample(out, at[0], at[1]);
        }
    for (size_t k = 0; (e->kind == DXF_POLYLINE || e->kind == DXF_LINE) && k + !e->closed < e->count; k++)
        sample_bulge(out, p[k], p[(k + 1) % e->count], f->bulges[e->first + k]);
}
#endif

static void test_curves_by_dxflib(void **state)
{
    (void)state;
#ifdef LIMNER_HAVE_DXFLIB
    sheet    s;
    dxf_file read;
    samples  wanted = {mem_alloc(SAMPLES_MOST * sizeof(double[2])), 0},
            found = {mem_alloc(SAMPLES_MOST * sizeof(double[2])), 0};
    size_t kinds[DXF_SPLINE + 1] = {0}, dashed = 0;
    build_curves(&s);
    read_sheet(&read, &s);
    sample_shapes(&wanted);
    for (size_t i = 0; i < read.entity_count; i++) {
        const dxf_entity *e = &read.entities[i];
        kinds[e->kind]++;
        assert_string_equal(e->layer, "HIDDEN-CREASE - K\\U+00F6rper -1-");
        assert_true(e->kind != DXF_SPLINE || e->knots == e->count + 4);
        dashed += strcmp(e->line_type, "DASHEDTINY") == 0;
        sample_entity(&found, &read, e);
    }
    double there = apart(&found, &wanted), back = apart(&wanted, &found);
    print_message("%zu entities, %zu dashed, %.4f and %.4f mm apart\n", read.entity_count, dashed, there, back);
    assert_true(kinds[DXF_CIRCLE] == 1 && kinds[DXF_ARC] == 1 && kinds[DXF_ELLIPSE] == 2 && kinds[DXF_SPLINE] >= 1);
    assert_true(kinds[DXF_POLYLINE] >= 1 && dashed == read.entity_count - 1);
    assert_true(there < 0.045 && back < 0.045);    /* 0.02, and samples are 0.05 apart, or less */
    for (size_t i = 0; i < read.entity_count; i++) /* one pattern, stretched */
        if (read.entities[i].kind == DXF_ARC)
            assert_true(fabs(read.entities[i].pattern_scale - 1) < 1e-3);
    dxf_release(&read);
    mem_free(wanted.at);
    mem_free(found.at);
    sheet_release(&s);
#else
    print_message("dxflib is not installed: what is written is not read back\n");
    skip();
#endif
}

/* The same by GDAL, which makes lines of curves: they lie on the shapes, and are as long. */
static void test_curves_by_gdal(void **state)
{
    char         path[] = "/tmp/limner-dxf-XXXXXX", command[256], line[65536];
    sheet        s;
    export_bytes bytes;
    lmn_error    error = {0};
    samples      wanted = {mem_alloc(SAMPLES_MOST * sizeof(double[2])), 0},
            found = {mem_alloc(SAMPLES_MOST * sizeof(double[2])), 0};
    (void)state;
    build_curves(&s);
    assert_int_equal(export_dxf(&bytes, &s, &error), LMN_OK);
    size_t entities = 0;
    for (const char *at = strstr((const char *)bytes.data, "ENTITIES"); (at = strstr(at, "\nAcDbEntity\n")); at++)
        entities++;
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(file_store(path, bytes.data, bytes.size, &error), LMN_OK);
    snprintf(command, sizeof command, "ogrinfo -q -al 'DXF:%s' 2>/dev/null || ogrinfo -q -al %s 2>/dev/null", path,
             path);
    FILE *told = popen(command, "r");
    sample_shapes(&wanted);
    size_t strings = 0, layers = 0;
    while (told && fgets(line, sizeof line, told)) {
        layers += strstr(line, "Layer (String) = HIDDEN-CREASE - ") != NULL;
        const char *at = strstr(line, "LINESTRING");
        strings += at != NULL;
        for (at = at ? strpbrk(at, "(") : NULL; at; at = strpbrk(at + 1, ",(")) {
            double x, y;
            if (sscanf(at + 1 + (at[1] == '('), "%lf %lf", &x, &y) == 2)
                add_sample(&found, x, y);
        }
    }
    int status = told ? pclose(told) : -1;
    unlink(path);
    mem_free(bytes.data);
    sheet_release(&s);
    double there = apart(&found, &wanted);
    mem_free(wanted.at);
    mem_free(found.at);
    if (status != 0 || strings == 0) {
        print_message("GDAL is not installed: what is written is not read back\n");
        skip();
    }
    print_message("%zu lines of %zu points on %zu layers, %.4f mm off\n", strings, found.count, layers, there);
    assert_true(strings == entities && layers == strings && found.count > 100 && there < 0.08);
}

/* A hatched square with a hole: GDAL reads its area, ezdxf (where it is) the same and its lines, and finds nothing to
 * mend. */
static void test_hatch(void **state)
{
    static const float square[4][2] = {{20, 30}, {60, 30}, {60, 70}, {20, 70}},
                       hole[4][2] = {{30, 40}, {30, 50}, {40, 50}, {40, 40}};
    const sheet_hatch h = {1.5, 0.5, {25, 35}, 0.25};
    char              path[] = "/tmp/limner-dxf-XXXXXX", command[900], line[65536];
    sheet             s;
    export_bytes      bytes;
    lmn_error         error = {0};
    (void)state;
    sheet_begin(&s, 100, 100, 4);
    uint32_t group = sheet_add_group(&s, -1, "hatch", "hatch", 0);
    sheet_add_hatch(&s, group, (colour){0, 0, 0, 1}, &h);
    sheet_add_path(&s, &(sheet_path){.closed = true, .filled = true}, square, 4);
    sheet_add_path(&s, &(sheet_path){.closed = true, .filled = true}, hole, 4);
    assert_int_equal(export_dxf(&bytes, &s, &error), LMN_OK);
    assert_non_null(strstr((const char *)bytes.data, "\n2\nHATCH\n70\n0\n62\n7\n6\nContinuous\n370\n25\n"));
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(file_store(path, bytes.data, bytes.size, &error), LMN_OK);
    mem_free(bytes.data);
    sheet_release(&s);
    snprintf(command, sizeof command, "ogrinfo -q -al 'DXF:%s' 2>/dev/null || ogrinfo -q -al %s 2>/dev/null", path,
             path);
    FILE *told = popen(command, "r");
    bool  polygon = false, answered = false;
    while (told && fgets(line, sizeof line, told)) {
        polygon = polygon || (strstr(line, "POLYGON") && strstr(line, "20 70") && strstr(line, "40 60"));
        answered = true;
    }
    if (told && pclose(told) == 0 && answered)
        assert_true(polygon);
    else
        print_message("GDAL is not installed: the area is not read back\n");
    snprintf(
        command, sizeof command,
        "/usr/bin/python3 -c \"import ezdxf,math;d=ezdxf.readfile('%s');a=d.audit();h=d.modelspace().query('HATCH')[0];"
        "l=h.pattern.lines[0];print(len(a.errors)+len(a.fixes),len(h.paths.paths),len(h.pattern.lines),round(math."
        "hypot(*l.offset),3),"
        "abs(round(math.sin(math.radians(l.angle)+0.5),4)),round(l.base_point[0],2),round(l.base_point[1],2))\" "
        "2>/dev/null",
        path);
    told = popen(command, "r");
    line[0] = '\0';
    if (!told || !fgets(line, sizeof line, told))
        print_message("ezdxf is not installed: the pattern is not read back\n");
    if (told)
        pclose(told);
    unlink(path);
    if (line[0])
        assert_string_equal(line, "0 2 1 1.5 0.0 25.0 65.0\n");
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
#define LAYER "ODD--NAME----WITH-VERY-MANY-LETTERS-IN-IT"
    assert_non_null(strstr(out, "\n1\nS\\U+00E4ge   \\U+FFFD end\n"));
    assert_non_null(strstr(out, "\n0\nTEXT\n5\n"));
    assert_non_null(strstr(out, "\n8\n" LAYER "\n100\nAcDbText\n10\n30.0\n20\n10.0\n30\n0.0\n40\n7.16\n"));
    assert_non_null(strstr(out, "\n8\n" LAYER "\n100\nAcDbCircle\n10\n10.0\n20\n30.0\n30\n0.0\n40\n2.0\n"));
    assert_non_null(strstr(out, "2\n" LAYER "\n70\n0\n62\n1\n")); /* the layer is red */
    mem_free(bytes.data);
    sheet_release(&s);
}

/* Four lengths are a dash and a dot where they come again, straight or round, and two dashes where they are all of
 * their line. */
static void test_patterns(void **state)
{
    static const float ends[2][2] = {{10, 10}, {50, 10}}, corners[4][2] = {{10, 20}, {20, 20}, {20, 30}, {10, 30}};
    sheet              s;
    export_bytes       bytes;
    lmn_error          error = {0};
    (void)state;
    sheet_begin(&s, 100, 50, 4);
    uint32_t group = sheet_add_group(&s, -1, "lines", "lines", 0);
    sheet_add_item(&s, SHEET_PATH, group, (colour){0, 0, 0, 1}, 0);
    sheet_add_path(&s, &(sheet_path){.width = 0.25f}, ends, 2);
    sheet_dash_path(&s, (const float[4]){6, 0.75f, 0.125f, 0.75f}, 4, 0);
    sheet_add_path(&s, &(sheet_path){.width = 0.25f, .closed = true}, corners, 4);
    sheet_dash_path(&s, (const float[4]){12, 1.5f, 0.25f, 1.5f}, 4, 0);
    sheet_add_path(&s, &(sheet_path){.width = 0.25f}, ends, 2);
    sheet_dash_path(&s, (const float[4]){24, 3, 13, 3}, 4, 0);
    assert_int_equal(export_dxf(&bytes, &s, &error), LMN_OK);
    const char *at = strstr((const char *)bytes.data, "\nENTITIES\n");
    assert_non_null(at = strstr(at, "\n6\nCENTERTINY\n100\nAcDbLine\n"));
    assert_non_null(at = strstr(at, "\n6\nCENTERTINY\n48\n2.0\n100\nAcDbPolyline\n")); /* the same, twice as long */
    assert_non_null(strstr(at, "\n6\nDASHEDTINY\n100\nAcDbLine\n"));
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
    assert_non_null(strstr((const char *)bytes.data, "0\nSECTION\n2\nENTITIES\n0\nENDSEC\n"));
    assert_string_equal((const char *)bytes.data + bytes.size - 6, "0\nEOF\n");
    mem_free(bytes.data);
    sheet_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_read_back),      cmocka_unit_test(test_curves_by_dxflib),
                                       cmocka_unit_test(test_curves_by_gdal), cmocka_unit_test(test_hatch),
                                       cmocka_unit_test(test_words),          cmocka_unit_test(test_patterns),
                                       cmocka_unit_test(test_nothing)};
    return cmocka_run_group_tests_name("dxf", tests, NULL, NULL);
}
