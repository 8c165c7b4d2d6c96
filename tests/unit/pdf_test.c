/* PDF: what the file says to a reader of its own: every object is where the table says, the page description has the
 * operators of what lies on the sheet, and layers are opened and closed as the sheet's groups are. Pictures of it are
 * in svg_test. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <zlib.h>

#include "base/memory.h"
#include "export/cairo_sheet.h"
#include "export/export.h"
#include "sheet/fit.h"

static const colour black = {0, 0, 0, 1};

static export_bytes pdf_of(const sheet *s)
{
    export_bytes bytes;
    lmn_error    error = {0};
    assert_int_equal(export_pdf(&bytes, s, &error), LMN_OK);
    return bytes;
}

/* A stream of the object that begins here, unpacked; mem_free. */
static unsigned char *unpack(const char *object, size_t *size)
{
    const char   *at = strstr(object, "/Length ");
    unsigned long length = 0;
    uLongf        most = 1 << 21;
    assert_true(at && sscanf(at, "/Length %lu", &length) == 1);
    unsigned char *out = mem_alloc(most + 1);
    at = strstr(at, "stream\n") + 7;
    assert_int_equal(uncompress(out, &most, (const unsigned char *)at, length), Z_OK);
    out[most] = '\0';
    *size = most;
    return out;
}

static size_t number_at(const unsigned char *bytes, size_t count)
{
    size_t out = 0;
    for (size_t i = 0; i < count; i++)
        out = out << 8 | bytes[i];
    return out;
}

/* Objects that are packed: each stands in the stream where its head says. */
static void check_packed(const char *object, size_t number, const unsigned char *rows, unsigned count)
{
    size_t         size, packed = 0;
    unsigned       told = 0, first = 0;
    const char    *n = strstr(object, "/N "), *f = strstr(object, "/First ");
    unsigned char *all = unpack(object, &size);
    assert_true(n && f && sscanf(n, "/N %u", &told) == 1 && sscanf(f, "/First %u", &first) == 1);
    const char *head = (const char *)all;
    for (unsigned i = 0; i < told; i++) {
        char  *end;
        size_t own = strtoul(head, &end, 10), place = strtoul(end, &end, 10);
        head = end;
        assert_true(own < count && first + place + 2 < size);
        const unsigned char *row = rows + 11 * own;
        assert_true(row[0] == 2 && number_at(row + 1, 5) == number && number_at(row + 6, 5) == i);
        assert_memory_equal(all + first + place, "<<", 2);
    }
    for (unsigned i = 1; i < count; i++)
        packed += rows[11 * i] == 2;
    assert_int_equal(packed, told);
    mem_free(all);
}

/* The table of references: returns how many objects there are; each stands where it says. */
static unsigned check_table(const export_bytes *pdf)
{
    const char *data = (const char *)pdf->data, *start = NULL;
    for (size_t i = 0; i + 9 < pdf->size; i++)
        if (memcmp(data + i, "startxref", 9) == 0)
            start = data + i;
    assert_non_null(start);
    size_t   at = strtoul(start + 9, NULL, 10), size;
    unsigned count = 0;
    assert_true(at < pdf->size && sscanf(strstr(data + at, "/Size "), "/Size %u/W[1 5 5]", &count) == 1);
    unsigned char *rows = unpack(data + at, &size);
    assert_int_equal(size, (size_t)count * 11);
    for (unsigned i = 1; i < count; i++) {
        char   head[32];
        size_t place = number_at(rows + 11 * i + 1, 5);
        int    length = snprintf(head, sizeof head, "%u 0 obj\n", i);
        if (rows[11 * i] == 2)
            continue;
        assert_true(rows[11 * i] == 1 && place + (size_t)length < pdf->size);
        assert_memory_equal(data + place, head, (size_t)length);
        if (strncmp(data + place + strcspn(data + place, "/"), "/Length", 7) == 0 && i == count - 2)
            check_packed(data + place, i, rows, count);
    }
    mem_free(rows);
    return count;
}

/* The page description, unpacked; mem_free. */
static char *content_of(const export_bytes *pdf)
{
    const char *data = (const char *)pdf->data, *at = NULL;
    for (size_t i = 0; i + 8 < pdf->size && !at; i++)
        if (memcmp(data + i, "4 0 obj\n", 8) == 0)
            at = data + i;
    assert_non_null(at);
    size_t size;
    return (char *)unpack(at, &size);
}

/* Objects that are packed, as text; mem_free. */
static char *packed_of(const export_bytes *pdf)
{
    const char *data = (const char *)pdf->data;
    size_t      size, at = 0, begin = 0;
    for (; at + 12 < pdf->size && memcmp(data + at, "/Type/ObjStm", 12) != 0; at++)
        begin = memcmp(data + at, " 0 obj\n", 7) == 0 ? at : begin;
    assert_true(begin > 0);
    return (char *)unpack(data + begin, &size);
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (; (text = strstr(text, word)); text += strlen(word))
        count++;
    return count;
}

/* A circle, dashed, and a straight line on a layer each, two views, one of which is cut. */
static void build(sheet *s)
{
    const float        line[3][2] = {{10, 10}, {20, 10.001f}, {30, 10}};
    float              circle[60][2];
    static const float cosines[5] = {1, 0.809017f, 0.309017f, -0.309017f, -0.809017f};
    for (int i = 0; i < 10; i++) {
        circle[i][0] = 50 + 8 * (i < 5 ? cosines[i] : -cosines[i - 5]);
        circle[i][1] = 50 + 8 * ((i < 5 ? 1.0f : -1.0f) * (float)(i % 5 == 0                 ? 0
                                                                  : i % 5 == 1 || i % 5 == 4 ? 0.587785
                                                                                             : 0.951057));
    }
    sheet_begin(s, 100, 100, 4);
    sheet_set_title(s, "A (title) \xE2\x80\x94 \xF0\x9F\x98\x80", NULL);
    uint32_t view = sheet_add_group(s, -1, "view", "view", 0),
             part = sheet_add_group(s, (int32_t)view, "Wheel", "part", 1),
             crease = sheet_add_group(s, (int32_t)part, "crease", "visible crease", 0),
             other = sheet_add_group(s, -1, "view-2", "view", 0);
    sheet_clip_group(s, other, 0, 0, 40, 40);
    sheet_add_item(s, SHEET_PATH, crease, black, 0);
    sheet_add_path(s, &(sheet_path){.width = 0.5f, .closed = true, .curved = true}, (const float(*)[2])circle, 10);
    sheet_dash_path(s, (const float[2]){2, 1}, 2, 0.5f);
    sheet_add_item(s, SHEET_PATH, other, (colour){1, 0, 0, 0.5f}, 0);
    sheet_add_path(s, &(sheet_path){.width = 0.25f, .curved = true}, line, 3);
    sheet_add_item(s, SHEET_PATH, crease, black, 0);
    sheet_add_path(s, &(sheet_path){.filled = true}, line, 3);
    sheet_add_text(s, view, black, "two words", 1, 20, 3, 0);
    sheet_fit(s, 0.5);
}

static void what_is_on_the_page(void **state)
{
    sheet s;
    (void)state;
    build(&s);
    export_bytes pdf = pdf_of(&s), again = pdf_of(&s);
    assert_int_equal(pdf.size, again.size);
    assert_memory_equal(pdf.data, again.data, pdf.size);
    assert_true(check_table(&pdf) >= 13);
    char  *page = content_of(&pdf);
    double dash = 0, gap = 0; /* as many as along its chords, which are shorter than the circle by 1.6 % */
    assert_int_equal(sscanf(strstr(page, "\n[") + 2, "%lf %lf ]", &dash, &gap), 2);
    assert_true(dash > 2.03 && dash < 2.036 && gap > 1.015 && gap < 1.018);
    assert_true(count_of(page, " c\n") >= 4);
    assert_non_null(strstr(page, "10 10 m\n30 10 l\nS\n")); /* one straight line */
    assert_non_null(strstr(page, "/OC /L0 BDC\n/OC /L1 BDC\n/OC /L2 BDC\n"));
    assert_non_null(strstr(page, "/OC /L3 BDC\nq\n0 0 40 40 re W n\n"));
    assert_int_equal(count_of(page, "BDC\n"), count_of(page, "EMC\n"));
    assert_int_equal(count_of(page, "\nq\n"), count_of(page, "\nQ\n"));
    assert_int_equal(count_of(page, "/Span <</ActualText "), 2);
    mem_free(page);
    mem_free(pdf.data);
    mem_free(again.data);
    sheet_release(&s);
}

static void layers_are_a_tree(void **state)
{
    sheet s;
    (void)state;
    build(&s);
    export_bytes pdf = pdf_of(&s);
    char        *text = packed_of(&pdf);
    assert_int_equal(count_of(text, "(D:20000101000000Z)"), 2); /* the time of day is not in it */
    assert_int_equal(count_of(text, "/Type/OCG/Name<FEFF"), 4);
    assert_non_null(strstr(text, "/Order[7 0 R [8 0 R [9 0 R ]]10 0 R ]"));
    assert_non_null(strstr(text, "/Title<FEFF0041002000280074")); /* A (t */
    assert_non_null(strstr(text, "D83DDE00>"));                   /* beyond the first plane: two */
    mem_free(text);
    mem_free(pdf.data);
    sheet_release(&s);
}

static void many_groups_are_no_layers(void **state)
{
    const float line[2][2] = {{1, 2}, {30, 4}};
    sheet       s;
    (void)state;
    sheet_begin(&s, 100, 100, 4);
    uint32_t view = sheet_add_group(&s, -1, "view", "view", 0);
    for (uint32_t i = 0; i < 5000; i++) {
        sheet_add_item(&s, SHEET_PATH, sheet_add_group(&s, (int32_t)view, "part", "part", i + 1), black, 0);
        sheet_add_path(&s, &(sheet_path){.width = 0.5f}, line, 2);
    }
    export_bytes pdf = pdf_of(&s);
    char        *page = content_of(&pdf);
    assert_int_equal(check_table(&pdf), 10);
    assert_int_equal(count_of(page, "BDC"), 1);
    assert_int_equal(count_of(page, "S\n"), 5000);
    mem_free(page);
    mem_free(pdf.data);
    sheet_release(&s);
}

/* Arcs are cubics: of large circles, too, these are no farther off than is said. */
static void large_circles_are_round(void **state)
{
    static float circle[1440][2];
    (void)state;
    for (int size = 0; size < 3; size++) {
        const double radius = size == 0 ? 2 : size == 1 ? 60 : 400;
        sheet        s;
        double       worst = 0, at[2] = {0, 0}, c[6];
        for (int i = 0; i < 1440; i++) {
            circle[i][0] = (float)(420 + radius * cos(i * 3.14159265358979323846 / 720));
            circle[i][1] = (float)(420 + radius * sin(i * 3.14159265358979323846 / 720));
        }
        sheet_begin(&s, 841, 841, 4);
        sheet_add_item(&s, SHEET_PATH, 0, black, 0);
        sheet_add_path(&s, &(sheet_path){.width = 0.5f, .closed = true, .curved = true}, (const float(*)[2])circle,
                       1440);
        sheet_fit(&s, 0.02);
        export_bytes pdf = pdf_of(&s);
        char        *page = content_of(&pdf);
        int          cubics = 0;
        for (char *line = page, *next; line; line = next) {
            next = strchr(line, '\n');
            if (next)
                *next++ = '\0';
            if (sscanf(line, "%lf %lf m", &c[4], &c[5]) == 2 && strchr(line, 'm') && !strchr(line, 'c'))
                memcpy(at, c + 4, sizeof at);
            if (strlen(line) < 2 || strcmp(line + strlen(line) - 2, " c") != 0 ||
                sscanf(line, "%lf %lf %lf %lf %lf %lf", &c[0], &c[1], &c[2], &c[3], &c[4], &c[5]) != 6)
                continue;
            for (int i = 0; i <= 100; i++) {
                double u = i / 100.0, v = 1 - u, p[2];
                for (int k = 0; k < 2; k++)
                    p[k] = v * v * v * at[k] + 3 * u * v * v * c[k] + 3 * u * u * v * c[2 + k] + u * u * u * c[4 + k];
                worst = fmax(worst, fabs(hypot(p[0] - 420, p[1] - 420) - radius));
            }
            memcpy(at, c + 4, sizeof at);
            cubics++;
        }
        print_message("radius %g mm: %d cubics, %.5f mm off\n", radius, cubics, worst);
        assert_true(cubics >= 3 && worst < 0.003);
        mem_free(page);
        mem_free(pdf.data);
        sheet_release(&s);
    }
}

/* Far from where a text begins its letters are there, too: cairo leaves out what lies far outside of a surface. */
static void long_texts_are_whole(void **state)
{
    cairo_letters all = {.steps = NULL};
    double        reach = 0;
    (void)state;
    assert_true(cairo_find_letters(
        &all, "Title, supplementary title, and as many more words as a title block has room for", 3));
    for (size_t i = 0; i < all.count; i++)
        reach = all.steps[i].kind == 'm' || all.steps[i].kind == 'l'
                    ? (all.steps[i].at[0] > reach ? all.steps[i].at[0] : reach)
                    : reach;
    print_message("letters reach %.2f mm of %.2f\n", reach, all.width);
    assert_true(reach > all.width - 1 && reach < all.width + 1);
    cairo_letters_release(&all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_on_the_page), cmocka_unit_test(layers_are_a_tree),
                                       cmocka_unit_test(many_groups_are_no_layers),
                                       cmocka_unit_test(large_circles_are_round),
                                       cmocka_unit_test(long_texts_are_whole)};
    return cmocka_run_group_tests_name("pdf", tests, NULL, NULL);
}
