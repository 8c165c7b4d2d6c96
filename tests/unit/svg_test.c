/* SVG and PDF: well-formed, with unique ids, the same bytes each time; and drawn by other programs (rsvg-convert, pdftoppm) equal to ribbons that are rasterised here, as discs along their
 * points, without knowing how they are written. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <libxml/parser.h>
#include <libxml/tree.h>
#include <libxml/xpath.h>
#include <libxml/xpathInternals.h>
#include <png.h>

#include "base/file.h"
#include "base/memory.h"
#include "draw/vector_private.h"
#include "export/export.h"

static const colour black = {0, 0, 0, 1};

static export_bytes bytes_of(const sheet *s, lmn_status (*write)(export_bytes *, const sheet *, lmn_error *))
{
    export_bytes bytes;
    lmn_error    error = {0};
    if (write(&bytes, s, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return bytes;
}

/* --- the text --------------------------------------------------------------------------------------------------------- */

static xmlXPathObjectPtr find(xmlDocPtr document, const char *path)
{
    xmlXPathContextPtr context = xmlXPathNewContext(document);
    xmlXPathRegisterNs(context, (const xmlChar *)"s", (const xmlChar *)"http://www.w3.org/2000/svg");
    xmlXPathObjectPtr found = xmlXPathEvalExpression((const xmlChar *)path, context);
    xmlXPathFreeContext(context);
    return found;
}

static int count_of(xmlDocPtr document, const char *path)
{
    xmlXPathObjectPtr found = find(document, path);
    int count = found && found->nodesetval ? found->nodesetval->nodeNr : 0;
    xmlXPathFreeObject(found);
    return count;
}

static xmlDocPtr parse(const export_bytes *bytes)
{
    xmlDocPtr document = xmlReadMemory((const char *)bytes->data, (int)bytes->size, "sheet.svg", NULL, XML_PARSE_NONET | XML_PARSE_HUGE);
    assert_non_null(document);
    return document;
}

static void check_ids(xmlDocPtr document)
{
    xmlXPathObjectPtr ids = find(document, "//@id");
    for (int i = 0; ids->nodesetval && i < ids->nodesetval->nodeNr; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal((const char *)ids->nodesetval->nodeTab[i]->children->content, (const char *)ids->nodesetval->nodeTab[k]->children->content);
    xmlXPathFreeObject(ids);
}

static void test_structure(void **state)
{
    const float line[3][2] = {{1, 2}, {3.5f, 4}, {3.5f, 3.9996f}};
    sheet       s;
    (void)state;
    sheet_begin(&s, 120, 80.5, 4);
    s.ground = (colour){1, 1, 1, 1};
    sheet_set_title(&s, "A <title> & \"more\"", "what it is");
    uint32_t view = sheet_add_group(&s, -1, "view-front", "view", 0), wheel = sheet_add_group(&s, (int32_t)view, "Wheel <left>", "part", 3);
    uint32_t contour = sheet_add_group(&s, (int32_t)wheel, "contour", "visible contour", 0), again = sheet_add_group(&s, (int32_t)view, "Wheel <left>", "part", 3);
    sheet_clip_group(&s, view, 0, 0, 100, 50);
    sheet_add_item(&s, SHEET_PATH, contour, black, 0x1F);
    sheet_add_path(&s, &(sheet_path){.width = 0.5f}, line, 3);
    sheet_add_item(&s, SHEET_PATH, again, (colour){1, 0, 0, 0.5f}, 0);
    sheet_add_path(&s, &(sheet_path){.width = 0.25f, .dash = 2, .gap = 1, .phase = 0.5f, .cap = SHEET_CAP_BUTT}, line, 3);
    sheet_add_item(&s, SHEET_PATH, contour, black, 0); /* back in a group that was closed */
    sheet_add_path(&s, &(sheet_path){.filled = true}, line, 3);
    sheet_add_item(&s, SHEET_DOTS, view, black, 0);
    sheet_add_path(&s, &(sheet_path){.width = 2}, line, 2);
    sheet_add_text(&s, view, black, "a < b & c\x02\xFF", 1, 2, 3, 0);
    export_bytes bytes = bytes_of(&s, export_svg), twice = bytes_of(&s, export_svg);
    assert_int_equal(bytes.size, twice.size);
    assert_memory_equal(bytes.data, twice.data, bytes.size);
    xmlDocPtr document = parse(&bytes);
    check_ids(document);
    assert_int_equal(count_of(document, "/s:svg[@width='120mm'][@height='80.5mm'][@viewBox='0 0 120 80.5']"), 1);
    assert_int_equal(count_of(document, "/s:svg/s:title[.='A <title> & \"more\"']"), 1);
    assert_int_equal(count_of(document, "/s:svg/s:desc[.='what it is']"), 1);
    assert_int_equal(count_of(document, "/s:svg/s:style"), 1);
    assert_int_equal(count_of(document, "//s:rect[@class='ground']"), 1);
    assert_int_equal(count_of(document, "//s:g[@id='view-front'][@clip-path]/s:g[@id='view-front-part-3'][@data-part='3'][@data-name='Wheel <left>']/s:g[@class='visible contour']"), 1);
    assert_int_equal(count_of(document, "//s:g[@id='view-front-part-3-2']"), 1);
    assert_int_equal(count_of(document, "//s:path[@data-line='1f'][@d='M1 2l2.5 2']"), 1); /* what rounds to nothing is left out */
    assert_int_equal(count_of(document, "//s:text[.='a < b & c \xEF\xBF\xBD']"), 1);
    assert_non_null(strstr((const char *)bytes.data, "stroke-dasharray:2,1;stroke-dashoffset:.5"));
    assert_non_null(strstr((const char *)bytes.data, "stroke:#ff0000;stroke-width:.25;stroke-opacity:.5"));
    assert_null(strstr((const char *)bytes.data, "nan"));
    xmlFreeDoc(document);
    mem_free(bytes.data);
    mem_free(twice.data);
    export_bytes pdf = bytes_of(&s, export_pdf), pdf_twice = bytes_of(&s, export_pdf);
    assert_int_equal(pdf.size, pdf_twice.size);
    assert_memory_equal(pdf.data, pdf_twice.data, pdf.size);
    mem_free(pdf.data);
    mem_free(pdf_twice.data);
    sheet_release(&s);
}

/* Names that want to be the same id, and sheets with nothing in them. */
static void test_hostile(void **state)
{
    static const char *const names[] = {"a", "a", "a-2", "a", "", "\"'<>&", "?????", NULL, "\xFF\xFE", "1"};
    sheet s;
    (void)state;
    sheet_begin(&s, 10, 10, 4);
    for (int round = 0; round < 3; round++) {
        export_bytes svg = bytes_of(&s, export_svg), pdf = bytes_of(&s, export_pdf);
        xmlDocPtr    document = parse(&svg);
        check_ids(document);
        xmlFreeDoc(document);
        mem_free(svg.data);
        mem_free(pdf.data);
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            const float line[2][2] = {{1, (float)i}, {5, (float)i}};
            sheet_add_item(&s, SHEET_PATH, sheet_add_group(&s, -1, names[i], names[i], round == 2 ? (uint32_t)i : 0), (colour){NAN, 2, -1, NAN}, 0);
            sheet_add_path(&s, &(sheet_path){.width = 1}, line, 2);
        }
    }
    sheet_add_image(&s, 0, (const unsigned char *)"no picture", 10, 0, 0, 1, 1);
    sheet_set_title(&s, "\xFF\x01", "\x02");
    export_bytes svg = bytes_of(&s, export_svg), pdf = bytes_of(&s, export_pdf);
    xmlDocPtr    document = parse(&svg);
    check_ids(document);
    xmlFreeDoc(document);
    mem_free(svg.data);
    mem_free(pdf.data);
    sheet_release(&s);
}

/* --- pictures --------------------------------------------------------------------------------------------------------- */

enum { SIDE = 600, RIBBONS = 60, POINTS = 40 };

typedef struct raster {
    uint8_t ink[SIDE][SIDE]; /* not 0 where there is ink */
} raster;

static raster wanted, drawn;

static float number(uint32_t *state, float most)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216 * most;
}

/* Ribbons of all kinds: straight, bent, closed, even ones and such as swell; pixels. */
static void make_ribbons(ribbon_set *set, ribbon *ribbons, ribbon_point *points)
{
    uint32_t state = 3;
    *set = (ribbon_set){.ribbons = ribbons, .points = points, .ribbon_count = RIBBONS};
    for (uint32_t i = 0; i < RIBBONS; i++) {
        bool  even = i % 2 == 0, closed = i % 6 == 0, corner = i % 5 == 0;
        float x = 60 + number(&state, SIDE - 120), y = 60 + number(&state, SIDE - 120), radius = 15 + number(&state, 30), turn = number(&state, 6), half = 0.7f + number(&state, 3);
        uint32_t count = closed ? POINTS : corner ? 3 : POINTS;
        ribbons[i] = (ribbon){.kind = (stroke_class)(i % 3), .part = i / 7, .hidden_by = i % 4 == 0, .chain = i, .id = i + 1, .ink = {0, 0, 0, 1}, .first = i * POINTS, .count = count,
                              .closed = closed, .even = even, .end = RIBBON_ROUND};
        for (uint32_t k = 0; k < count; k++) {
            float share = (float)k / (float)(count - 1), angle = turn + share * (closed ? 6.2831853f : corner ? 3.5f : 2.5f);
            if (closed && k + 1 == count)
                angle = turn;
            points[i * POINTS + k] = (ribbon_point){x + radius * cosf(angle), y + radius * sinf(angle), 1, share * radius, even ? half : half * (0.4f + 0.6f * sinf(share * 3.1f)), 1};
        }
    }
}

static void put_disc(raster *r, float x, float y, float radius)
{
    for (int row = (int)(y - radius) - 1; row <= (int)(y + radius) + 1; row++)
        for (int column = (int)(x - radius) - 1; column <= (int)(x + radius) + 1; column++)
            if (row >= 0 && column >= 0 && row < SIDE && column < SIDE && hypotf((float)column + 0.5f - x, (float)row + 0.5f - y) <= radius)
                r->ink[row][column] = 1;
}

static void rasterise(raster *r, const ribbon_set *set)
{
    memset(r, 0, sizeof *r);
    for (size_t i = 0; i < set->ribbon_count; i++)
        for (uint32_t k = 0; k + 1 < set->ribbons[i].count; k++) {
            const ribbon_point *a = &set->points[set->ribbons[i].first + k], *b = a + 1;
            for (int n = 0; n <= 400; n++) {
                float t = (float)n / 400;
                put_disc(r, a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), a->half + t * (b->half - a->half));
            }
        }
}

static bool read_png(raster *r, const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    static uint8_t grey[SIDE * SIDE];
    if (!png_image_begin_read_from_file(&image, path))
        return false;
    image.format = PNG_FORMAT_GRAY;
    if (image.width != SIDE || image.height != SIDE || !png_image_finish_read(&image, &(png_color){255, 255, 255}, grey, 0, NULL))
        return false;
    for (int i = 0; i < SIDE * SIDE; i++)
        r->ink[i / SIDE][i % SIDE] = grey[i] < 128;
    return true;
}

/* The share of one picture's ink that has ink of the other within 1.5 pixels. */
static double share_near(const raster *of, const raster *in)
{
    int ink = 0, near = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            bool found = false;
            for (int k = 0; of->ink[y][x] && k < 9; k++) {
                int row = y + k / 3 - 1, column = x + k % 3 - 1;
                found = found || (row >= 0 && column >= 0 && row < SIDE && column < SIDE && in->ink[row][column]);
            }
            ink += of->ink[y][x];
            near += found;
        }
    return ink ? (double)near / ink : 0;
}

static bool has_program(const char *name)
{
    char command[128];
    snprintf(command, sizeof command, "command -v %s > /dev/null 2>&1", name);
    return system(command) == 0;
}

/* The ribbons as a sheet, written by `write` and drawn by the command, "PROGRAM … FILE … PICTURE.png". */
static void check_picture(lmn_status (*write)(export_bytes *, const sheet *, lmn_error *), const char *program, const char *format, bool lines_only)
{
    static ribbon       ribbons[RIBBONS];
    static ribbon_point points[RIBBONS * POINTS];
    char                folder[] = "/tmp/limner-svg-XXXXXX", path[64], command[256], picture[64];
    ribbon_set          set;
    sheet               s;
    lmn_error           error = {0};
    if (!has_program(program)) {
        print_message("%s is not installed: what is written is not drawn\n", program);
        skip();
    }
    lmn_scene *scene = scene_new();
    make_ribbons(&set, ribbons, points);
    rasterise(&wanted, &set);
    sheet_begin(&s, SIDE / VECTOR_PIXELS_PER_MM, SIDE / VECTOR_PIXELS_PER_MM, VECTOR_PIXELS_PER_MM);
    s.ground = (colour){1, 1, 1, 1};
    vector_ink ink = {&s, scene, sheet_add_group(&s, -1, "view", "view", 0), {0, 0}, lines_only};
    assert_int_equal(vector_put_ribbons(&ink, &set, 1, &error), LMN_OK);
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/sheet", folder);
    snprintf(picture, sizeof picture, "%s/sheet.png", folder);
    export_bytes bytes = bytes_of(&s, write);
    assert_int_equal(file_store(path, bytes.data, bytes.size, &error), LMN_OK);
    snprintf(command, sizeof command, format, folder, folder);
    int status = system(command);
    bool read = status == 0 && read_png(&drawn, picture);
    unlink(path);
    unlink(picture);
    rmdir(folder);
    mem_free(bytes.data);
    sheet_release(&s);
    scene_free(scene);
    assert_true(read);
    double found = share_near(&wanted, &drawn), true_ink = share_near(&drawn, &wanted);
    print_message("%s: %.4f of the ribbons are drawn, %.4f of what is drawn is theirs\n", program, found, true_ink);
    assert_true(found >= 0.99 && true_ink >= 0.99);
}

static void test_svg_picture(void **state)
{
    (void)state;
    check_picture(export_svg, "rsvg-convert", "rsvg-convert -w 600 -h 600 %s/sheet -o %s/sheet.png", false);
}

static void test_pdf_picture(void **state)
{
    (void)state;
    check_picture(export_pdf, "pdftoppm", "pdftoppm -singlefile -png -scale-to-x 600 -scale-to-y 600 %s/sheet %s/sheet", false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_structure), cmocka_unit_test(test_hostile), cmocka_unit_test(test_svg_picture), cmocka_unit_test(test_pdf_picture),
    };
    int failed = cmocka_run_group_tests_name("svg", tests, NULL, NULL);
    xmlCleanupParser();
    return failed;
}
