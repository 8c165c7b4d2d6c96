/* SVG and PDF: well-formed, with unique ids, the same bytes each time; and drawn by other programs (rsvg-convert,
 * pdftoppm) equal to ribbons that are rasterised here, as discs along their points, without knowing how they are
 * written. */
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

#include "base/file_store.h"
#include "base/memory.h"
#include "vector/vector_private.h"
#include "export/export.h"
#include "sheet/fit.h"
#include "look/look.h"

#define PI 3.14159265358979323846
static const colour black = {0, 0, 0, 1};

static export_bytes bytes_of(const sheet *s, lmn_status (*write)(export_bytes *, const sheet *, lmn_error *))
{
    export_bytes bytes;
    lmn_error    error = {0};
    if (write(&bytes, s, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return bytes;
}

/* --- the text ------------------------------------------------------------------------------------------- */

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
    int               count = found && found->nodesetval ? found->nodesetval->nodeNr : 0;
    xmlXPathFreeObject(found);
    return count;
}

static xmlDocPtr parse(const export_bytes *bytes)
{
    xmlDocPtr document =
        xmlReadMemory((const char *)bytes->data, (int)bytes->size, "sheet.svg", NULL, XML_PARSE_NONET | XML_PARSE_HUGE);
    assert_non_null(document);
    return document;
}

static void check_ids(xmlDocPtr document)
{
    xmlXPathObjectPtr ids = find(document, "//@id");
    for (int i = 0; ids->nodesetval && i < ids->nodesetval->nodeNr; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal((const char *)ids->nodesetval->nodeTab[i]->children->content,
                                    (const char *)ids->nodesetval->nodeTab[k]->children->content);
    xmlXPathFreeObject(ids);
}

static float number(uint32_t *state, float most)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216 * most;
}

static void test_structure(void **state)
{
    const float line[3][2] = {{1, 2}, {3.5f, 4}, {3.5f, 3.9996f}};
    sheet       s;
    (void)state;
    sheet_begin(&s, 120, 80.5, 4);
    s.ground = (colour){1, 1, 1, 1};
    sheet_set_title(&s, "A <title> & \"more\"", "what it is");
    uint32_t view = sheet_add_group(&s, -1, "view-front", "view", 0),
             wheel = sheet_add_group(&s, (int32_t)view, "Wheel <left>", "part", 3);
    uint32_t contour = sheet_add_group(&s, (int32_t)wheel, "contour", "visible contour", 0),
             again = sheet_add_group(&s, (int32_t)view, "Wheel <left>", "part", 3);
    sheet_clip_group(&s, view, 0, 0, 100, 50);
    sheet_add_item(&s, SHEET_PATH, contour, black, 0x1F);
    sheet_add_path(&s, &(sheet_path){.width = 0.5f}, line, 3);
    sheet_add_item(&s, SHEET_PATH, again, (colour){1, 0, 0, 0.5f}, 0);
    sheet_add_path(&s, &(sheet_path){.width = 0.25f, .cap = SHEET_CAP_BUTT}, line, 3);
    sheet_dash_path(&s, (const float[2]){2, 1}, 2, 0.5f);
    sheet_add_item(&s, SHEET_PATH, contour, black, 0); /* back in a group that was closed */
    sheet_add_path(&s, &(sheet_path){.filled = true}, line, 3);
    sheet_add_item(&s, SHEET_DOTS, view, black, 0);
    sheet_add_path(&s, &(sheet_path){.width = 2}, line, 2);
    sheet_add_item(&s, SHEET_PATH, view, black, 0x2F);
    sheet_add_path(&s, &(sheet_path){.width = 1, .closed = true}, line, 2);
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
    assert_int_equal(
        count_of(document,
                 "//s:g[@id='view-front'][@clip-path]/s:g[@id='view-front-part-3'][@data-part='3'][@data-name='Wheel "
                 "<left>']/s:g[@class='visible contour']"), /* two styles: its items have them */
        1);
    assert_int_equal(count_of(document, "//s:g[@*[local-name()='groupmode']='layer']"), count_of(document, "//s:g"));
    assert_int_equal(count_of(document, "//s:g[@*[local-name()='label']='Wheel <left>']"), 3); /* one again */
    assert_int_equal(count_of(document, "//s:g[@id='view-front-part-3-2']"), 1);
    assert_int_equal(count_of(document, "//s:path[@data-line='V'][@d='M1 2l2.5 2']"),
                     1); /* what rounds to nothing is left out */
    assert_int_equal(count_of(document, "//s:text[.='a < b & c \xEF\xBF\xBD']"), 1);
    assert_int_equal(count_of(document, "//s:path[@stroke-dasharray='2 1'][@stroke-dashoffset='.5']"), 1);
    assert_int_equal(
        count_of(document, "//s:g[@id='view-front-part-3-2'][starts-with(@class,'part s')]/s:path[not(@class)]"), 1);
    assert_int_equal(count_of(document, "//s:g[@class='view']/s:path[not(@class)]"), 0);
    assert_non_null(strstr((const char *)bytes.data, "stroke:#ff0000;stroke-width:.25;stroke-opacity:.5"));
    assert_non_null(strstr((const char *)bytes.data, "stroke-opacity:.5;stroke-linecap:butt"));
    assert_int_equal(count_of(document, "//s:path[@data-line='l'][@d='M1 2l2.5 2z']"), 1);
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

/* What is round is an element of its own, unless dashes begin somewhere on it. */
static void test_round(void **state)
{
    sheet s;
    (void)state;
    sheet_begin(&s, 100, 100, 4);
    uint32_t group = sheet_add_group(&s, -1, "holes", "visible contour", 0);
    for (int i = 0; i < 3; i++) {
        float points[120][2];
        for (int k = 0; k < 120; k++) {
            double x = 12 * cos(k * 3.14159265358979323846 / 60),
                   y = (i == 1 ? 5 : 12) * sin(k * 3.14159265358979323846 / 60);
            points[k][0] = (float)(40 + 0.8 * x - 0.6 * y);
            points[k][1] = (float)(50 + 0.6 * x + 0.8 * y);
        }
        sheet_add_item(&s, SHEET_PATH, group, black, 0);
        sheet_add_path(&s, &(sheet_path){.width = 0.5f, .closed = true, .curved = true}, (const float(*)[2])points,
                       120);
        if (i == 2)
            sheet_dash_path(&s, (const float[2]){2, 1}, 2, 0);
    }
    sheet_fit(&s, 0.02);
    export_bytes bytes = bytes_of(&s, export_svg);
    xmlDocPtr    document = parse(&bytes);
    assert_int_equal(
        count_of(document, "//s:g[@class='visible contour s0']/s:circle[@cx='40'][@cy='50'][@r>11.98][@r<12.02]"), 1);
    assert_int_equal(
        count_of(document, "//s:ellipse[@rx>11.98][@rx<12.02][@ry>4.98][@ry<5.02][starts-with(@transform,'translate(40 "
                           "50)rotate(36.8')]"),
        1);
    assert_int_equal(count_of(document, "//s:path[@stroke-dasharray]"), 1);
    assert_int_equal(count_of(document, "//s:path"), 1);
    xmlFreeDoc(document);
    mem_free(bytes.data);
    sheet_release(&s);
}

/* One number for lines along an axis; hundredths where no dash is moved by more than two of them; what three lines are
 * dashed by is a class. */
static void test_few_bytes(void **state)
{
    const float bent[5][2] = {{1, 2}, {4, 2}, {6, 2}, {6, 1}, {5, 0}}, straight[2][2] = {{10, 10}, {110, 10}};
    const float pattern[2] = {1.591f, 1.06f}, others[4] = {0.365f, 1.061f, 1.592f, 1.061f},
                ended[4] = {5, 1, 2.414f, 1};
    sheet s;
    (void)state;
    sheet_begin(&s, 120, 80, 4);
    uint32_t group = sheet_add_group(&s, -1, "lines", NULL, 0);
    for (int i = 0; i < 6; i++) {
        sheet_add_item(&s, SHEET_PATH, group, black, 0);
        sheet_add_path(&s, &(sheet_path){.width = 0.5f}, i == 3 ? straight : bent, i == 3 ? 2 : 5);
        if (i >= 4)
            sheet_dash_path(&s, i == 4 ? others : ended, 4, 0);
        else
            sheet_dash_path(&s, pattern, 2, i == 1 ? 0.5041f : 0);
    }
    export_bytes bytes = bytes_of(&s, export_svg);
    xmlDocPtr    document = parse(&bytes);
    assert_int_equal(count_of(document, "//s:path[@d='M1 2h3 2v-1l-1-1']"), 5);
    assert_int_equal(count_of(document, "//s:path[@d='M10 10h100'][@stroke-dasharray='1.591 1.06']"), 1);
    assert_int_equal(count_of(document, "//s:path[@class='d0'][not(@stroke-dasharray)]"), 3);
    assert_int_equal(count_of(document, "//s:path[@class='d0'][@stroke-dashoffset='.5']"), 1);
    assert_int_equal(count_of(document, "//s:path[@stroke-dasharray='.37 1.06 1.59 1.06']"), 1);
    assert_int_equal(count_of(document, "//s:path[@stroke-dasharray='5 1']"), 1); /* the line ends with the second */
    assert_int_equal(count_of(document, "//s:style[contains(.,'.d0{stroke-dasharray:1.59 1.06}')]"), 1);
    xmlFreeDoc(document);
    mem_free(bytes.data);
    sheet_release(&s);
}

/* Where the middle of an arc of SVG is, by the formulas of its specification (F.6.5), for circles. */
static void middle_of_arc(const double from[2], const double end[2], double radius, bool large, bool sweeps,
                          double out[2])
{
    double x = (from[0] - end[0]) / 2, y = (from[1] - end[1]) / 2, square = x * x + y * y;
    double along = sqrt(fmax(radius * radius / square - 1, 0)) * (large == sweeps ? -1 : 1);
    double centre[2] = {along * y + (from[0] + end[0]) / 2, -along * x + (from[1] + end[1]) / 2};
    double first = atan2(from[1] - centre[1], from[0] - centre[0]),
           turn = atan2(end[1] - centre[1], end[0] - centre[0]) - first;
    turn += sweeps && turn < 0 ? 2 * PI : !sweeps && turn > 0 ? -2 * PI : 0;
    out[0] = centre[0] + radius * cos(first + turn / 2);
    out[1] = centre[1] + radius * sin(first + turn / 2);
}

/* Arcs have as few digits of their radius as keep them where they are. */
static void test_radii(void **state)
{
    enum { ARCS = 400 };
    uint32_t random = 7;
    size_t   digits = 0;
    (void)state;
    for (int i = 0; i < ARCS; i++) {
        sheet  s;
        double radius = exp((double)number(&random, 5)), sweep = 0.05 + (double)number(&random, 1.95f),
               begin = (double)number(&random, 6), centre[2] = {200, 200}, middle[2], read[6];
        float points[60][2];
        for (int k = 0; k < 60; k++) {
            points[k][0] = (float)(centre[0] + radius * cos(begin + sweep * k / 59));
            points[k][1] = (float)(centre[1] + radius * sin(begin + sweep * k / 59));
        }
        sheet_begin(&s, 400, 400, 4);
        sheet_add_item(&s, SHEET_PATH, sheet_add_group(&s, -1, "arc", NULL, 0), black, 0);
        sheet_add_path(&s, &(sheet_path){.width = 1, .curved = true}, (const float(*)[2])points, 60);
        sheet_fit(&s, 0.02);
        export_bytes bytes = bytes_of(&s, export_svg);
        const char  *at = strstr((const char *)bytes.data, "d=\"M");
        int          large, sweeps, size = 0;
        assert_non_null(at);
        if (s.piece_count == 1 && s.pieces[0].kind == SHEET_ARC) {
            const sheet_piece *arc = &s.pieces[0];
            assert_int_equal(sscanf(at, "d=\"M%lf %lfa%n%lf %lf 0 %d %d%lf%lf\"", &read[0], &read[1], &size, &read[2],
                                    &read[3], &large, &sweeps, &read[4], &read[5]),
                             8);
            assert_true(read[2] == read[3]);
            digits += strcspn(at + size, " ");
            middle_of_arc(read, (const double[2]){read[0] + read[4], read[1] + read[5]}, read[2], large, sweeps,
                          middle);
            double angle = arc->from + arc->sweep / 2,
                   off = hypot(middle[0] - arc->centre[0] - arc->radii[0] * cos(angle),
                               middle[1] - arc->centre[1] - arc->radii[0] * sin(angle));
            if (!(off < 0.0017)) /* rounded ends move it, too */
                fail_msg("arc %d, radius %.4f, turn %.3f: %.5f mm off", i, radius, sweep, off);
        }
        mem_free(bytes.data);
        sheet_release(&s);
    }
    print_message("%.2f characters a radius\n", (double)digits / ARCS);
    assert_true(digits > 2 * ARCS && digits < 4.6 * ARCS);
}

/* Names that want to be the same id, and sheets with nothing in them. */
static void test_hostile(void **state)
{
    static const char *const names[] = {"a", "a", "a-2", "a", "", "\"'<>&", "?????", NULL, "\xFF\xFE", "1"};
    sheet                    s;
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
            sheet_add_item(&s, SHEET_PATH, sheet_add_group(&s, -1, names[i], names[i], round == 2 ? (uint32_t)i : 0),
                           (colour){NAN, 2, -1, NAN}, 0);
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

/* --- pictures ------------------------------------------------------------------------------------------- */

enum { SIDE = 600, RIBBONS = 60, POINTS = 40 };

typedef struct raster {
    uint8_t ink[SIDE][SIDE]; /* not 0 where there is ink */
} raster;

static raster wanted, drawn;

/* Ribbons of all kinds: straight, bent, closed, even ones and such as swell; pixels. */
static void make_ribbons(ribbon_set *set, ribbon *ribbons, ribbon_point *points)
{
    uint32_t state = 3;
    *set = (ribbon_set){.ribbons = ribbons, .points = points, .ribbon_count = RIBBONS};
    for (uint32_t i = 0; i < RIBBONS; i++) {
        bool  even = i % 2 == 0, closed = i % 6 == 0, corner = i % 5 == 0;
        float x = 60 + number(&state, SIDE - 120), y = 60 + number(&state, SIDE - 120),
              radius = 15 + number(&state, 30), turn = number(&state, 6), half = 0.7f + number(&state, 3);
        uint32_t count = closed ? POINTS : corner ? 3 : POINTS;
        ribbons[i] = (ribbon){.kind = (stroke_class)(i % 3),
                              .part = i / 7,
                              .hidden_by = i % 4 == 0,
                              .chain = i,
                              .id = i + 1,
                              .ink = {0, 0, 0, 1},
                              .first = i * POINTS,
                              .count = count,
                              .closed = closed,
                              .even = even,
                              .end = RIBBON_ROUND};
        for (uint32_t k = 0; k < count; k++) {
            float fraction = (float)k / (float)(count - 1), angle = turn + fraction * (closed   ? 6.2831853f
                                                                                       : corner ? 3.5f
                                                                                                : 2.5f);
            if (closed && k + 1 == count)
                angle = turn;
            if (corner && !closed) { /* a sharp one */
                angle = turn + 0.5f * (float)k;
                radius = k == 1 ? 0 : 40;
                half = 4;
            }
            points[i * POINTS + k] =
                (ribbon_point){x + radius * cosf(angle),
                               y + radius * sinf(angle),
                               1,
                               fraction * radius,
                               even || corner ? half : half * (0.4f + 0.6f * sinf(fraction * 3.1f)),
                               1};
        }
    }
}

static void put_disc(raster *r, float x, float y, float radius)
{
    for (int row = (int)(y - radius) - 1; row <= (int)(y + radius) + 1; row++)
        for (int column = (int)(x - radius) - 1; column <= (int)(x + radius) + 1; column++)
            if (row >= 0 && column >= 0 && row < SIDE && column < SIDE &&
                hypotf((float)column + 0.5f - x, (float)row + 0.5f - y) <= radius)
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
    png_image      image = {.version = PNG_IMAGE_VERSION};
    static uint8_t grey[SIDE * SIDE];
    if (!png_image_begin_read_from_file(&image, path))
        return false;
    image.format = PNG_FORMAT_GRAY;
    if (image.width != SIDE || image.height != SIDE ||
        !png_image_finish_read(&image, &(png_color){255, 255, 255}, grey, 0, NULL))
        return false;
    for (int i = 0; i < SIDE * SIDE; i++)
        r->ink[i / SIDE][i % SIDE] = grey[i] < 128;
    return true;
}

/* The fraction of one picture's ink that has ink of the other within 1.5 pixels. */
static double fraction_near(const raster *of, const raster *in)
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
static void check_picture(lmn_status (*write)(export_bytes *, const sheet *, lmn_error *), const char *program,
                          const char *format, bool lines_only)
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
    int  status = system(command);
    bool read = status == 0 && read_png(&drawn, picture);
    unlink(path);
    unlink(picture);
    rmdir(folder);
    mem_free(bytes.data);
    sheet_release(&s);
    scene_free(scene);
    assert_true(read);
    double found = fraction_near(&wanted, &drawn), true_ink = fraction_near(&drawn, &wanted);
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
    check_picture(export_pdf, "pdftoppm", "pdftoppm -singlefile -png -scale-to-x 600 -scale-to-y 600 %s/sheet %s/sheet",
                  false);
}

/* --- hatching ------------------------------------------------------------------------------------------- */

enum { CORNERS = 40 };

/* A ring, hatched as an area, or line by line, which are cut here at both circles. */
static void hatch_ring(sheet *s, bool area)
{
    const double side = SIDE / VECTOR_PIXELS_PER_MM, middle = side / 2, radii[2] = {0.45 * side, 0.2 * side},
                 angle = 0.6, apart = 3, width = 0.8, c = cos(angle), n = sin(angle);
    const sheet_hatch h = {apart, angle, {20, 33}, width};
    float             circles[2][CORNERS][2];
    sheet_begin(s, side, side, VECTOR_PIXELS_PER_MM);
    s->ground = (colour){1, 1, 1, 1};
    uint32_t group = sheet_add_group(s, -1, "view", "view", 0);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < CORNERS; i++) {
            double turn = (k ? -1 : 1) * 6.283185307179586 * i / CORNERS;
            circles[k][i][0] = (float)(middle + radii[k] * cos(turn));
            circles[k][i][1] = (float)(middle + radii[k] * sin(turn));
        }
    if (area) {
        sheet_add_hatch(s, group, black, &h);
        for (int k = 0; k < 2; k++)
            sheet_add_path(s, &(sheet_path){.closed = true, .filled = true}, (const float(*)[2])circles[k], CORNERS);
        return;
    }
    for (int line = -60; line <= 60; line++) { /* where it is in the ring, in small steps */
        double from[2] = {20 - line * apart * n, 33 + line * apart * c}, begun = NAN;
        for (double t = -300; t <= 300; t += 0.02) {
            double away = hypot(from[0] + t * c - middle, from[1] + t * n - middle);
            bool   in = away < radii[0] && away > radii[1];
            if (in && isnan(begun))
                begun = t;
            if (!in && !isnan(begun)) {
                const double ends[2][2] = {{from[0] + begun * c, from[1] + begun * n},
                                           {from[0] + t * c, from[1] + t * n}};
                sheet_add_line(s, group, black, ends[0], ends[1], width);
                begun = NAN;
            }
        }
    }
}

static void draw_hatch_by(raster *out, bool area, lmn_status (*write)(export_bytes *, const sheet *, lmn_error *),
                          const char *format)
{
    char      folder[] = "/tmp/limner-svg-XXXXXX", path[64], picture[64], command[256];
    sheet     s;
    lmn_error error = {0};
    hatch_ring(&s, area);
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/sheet", folder);
    snprintf(picture, sizeof picture, "%s/sheet.png", folder);
    export_bytes bytes = bytes_of(&s, write);
    assert_int_equal(file_store(path, bytes.data, bytes.size, &error), LMN_OK);
    snprintf(command, sizeof command, format, folder, folder);
    int  status = system(command);
    bool read = status == 0 && read_png(out, picture);
    unlink(path);
    unlink(picture);
    rmdir(folder);
    mem_free(bytes.data);
    sheet_release(&s);
    assert_true(read);
}

/* Patterns of the formats, as other programs draw them, are the lines. */
static void test_hatch_pictures(void **state)
{
    static const struct {
        const char *program, *format;
        lmn_status (*write)(export_bytes *, const sheet *, lmn_error *);
    } ways[] = {
        {"rsvg-convert", "rsvg-convert -w 600 -h 600 %s/sheet -o %s/sheet.png", export_svg},
        {"pdftoppm", "pdftoppm -singlefile -png -scale-to-x 600 -scale-to-y 600 %s/sheet %s/sheet", export_pdf}};
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        if (!has_program(ways[i].program)) {
            print_message("%s is not installed: patterns are not drawn\n", ways[i].program);
            continue;
        }
        draw_hatch_by(&wanted, false, ways[i].write, ways[i].format);
        draw_hatch_by(&drawn, true, ways[i].write, ways[i].format);
        double found = fraction_near(&wanted, &drawn), true_ink = fraction_near(&drawn, &wanted);
        print_message("%s: %.4f of the lines are drawn, %.4f of what is drawn is theirs\n", ways[i].program, found,
                      true_ink);
        assert_true(found >= 0.99 && true_ink >= 0.99);
    }
}

/* Who draws a tile as a picture has to be able to: it is no longer than the page needs. */
static void test_hatch_tiles(void **state)
{
    (void)state;
    sheet s;
    hatch_ring(&s, true);
    export_bytes bytes = bytes_of(&s, export_svg);
    const char  *tile = strstr((const char *)bytes.data, "<pattern "), *width = tile ? strstr(tile, " width=\"") : NULL;
    assert_non_null(width);
    const double long_one = strtod(width + strlen(" width=\""), NULL), page = hypot(s.width, s.height);
    assert_true(long_one > page && long_one < page + 7);
    mem_free(bytes.data);
    sheet_release(&s);
}

/* --- areas ---------------------------------------------------------------------------------------------- */

static uint32_t owners[SIDE][SIDE]; /* what is nearest, part index + 1 */
static double   depths[SIDE][SIDE];
static uint8_t  colours[SIDE * SIDE][3];

/* All triangles of a scene as the camera of a view sees them, one by one, with a depth for each pixel. */
static void rasterise_scene(raster *r, const lmn_scene *scene, const view_camera *camera)
{
    mat4 *worlds = scene_world_matrices(scene, NULL), both = mat4_multiply(&camera->projection, &camera->view);
    memset(r, 0, sizeof *r);
    memset(owners, 0, sizeof owners);
    for (size_t i = 0; i < scene->part_count; i++) {
        const mesh *m = &scene->meshes[scene->nodes[scene->parts[i].node].mesh];
        mat4        all = mat4_multiply(&both, &worlds[scene->parts[i].node]);
        for (size_t n = 0; n < m->primitive_count; n++)
            for (uint32_t t = 0; t + 2 < m->primitives[n].index_count; t += 3) {
                double p[3][3];
                for (int k = 0; k < 3; k++) {
                    vec3   v = m->primitives[n].positions[m->primitives[n].indices[t + (uint32_t)k]];
                    double from[4] = {(double)v.x, (double)v.y, (double)v.z, 1}, clip[4] = {0};
                    for (int a = 0; a < 4; a++)
                        for (int b = 0; b < 4; b++)
                            clip[a] += all.m[4 * b + a] * from[b];
                    p[k][0] = (clip[0] / clip[3] + 1) / 2 * SIDE;
                    p[k][1] = (1 - clip[1] / clip[3]) / 2 * SIDE;
                    p[k][2] = clip[2] / clip[3];
                }
                double low = fmin(p[0][1], fmin(p[1][1], p[2][1])), high = fmax(p[0][1], fmax(p[1][1], p[2][1]));
                double left = fmin(p[0][0], fmin(p[1][0], p[2][0])), right = fmax(p[0][0], fmax(p[1][0], p[2][0]));
                for (int y = (int)fmax(low, 0); y <= (int)fmin(high, SIDE - 1); y++)
                    for (int x = (int)fmax(left, 0); x <= (int)fmin(right, SIDE - 1); x++) {
                        int    sides = 0;
                        double z = 0, area = 0;
                        for (int k = 0; k < 3; k++) {
                            const double *a = p[k], *b = p[(k + 1) % 3];
                            double        side = (b[0] - a[0]) * (y + 0.5 - a[1]) - (b[1] - a[1]) * (x + 0.5 - a[0]);
                            sides += side > 0 ? 1 : -1;
                            z += side * p[(k + 2) % 3][2];
                            area += side;
                        }
                        if (sides != 3 && sides != -3)
                            continue;
                        r->ink[y][x] = 1;
                        if (owners[y][x] && z / area >= depths[y][x])
                            continue;
                        depths[y][x] = z / area;
                        owners[y][x] = (uint32_t)i + 1;
                    }
            }
    }
    mem_free(worlds);
}

/* Does every pixel that is not at a border have the colour of the part that is nearest there? */
static void check_colours(const char *model, const lmn_scene *scene, const lmn_look *look)
{
    int inside = 0, wrong = 0;
    for (int y = 2; y < SIDE - 2; y++)
        for (int x = 2; x < SIDE - 2; x++) {
            bool border = owners[y][x] == 0;
            for (int k = 0; k < 25 && !border; k++)
                border = owners[y + k / 5 - 2][x + k % 5 - 2] != owners[y][x];
            if (border)
                continue;
            colour      c = vector_fill_colour(&look->rules[0], scene, owners[y][x] - 1, NULL);
            const float own[3] = {c.r, c.g, c.b};
            bool        same = true;
            for (int k = 0; k < 3; k++)
                same = same && fabsf(own[k] * 255 - colours[y * SIDE + x][k]) < 4;
            inside++;
            wrong += !same;
        }
    print_message("%s: %d of %d pixels have another part's colour\n", model, wrong, inside);
    assert_true(inside > 10000 && wrong <= inside / 1000); /* slivers that one sample a pixel does not see */
}

static void read_colours(const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, path) && image.width == SIDE && image.height == SIDE);
    image.format = PNG_FORMAT_RGB;
    assert_true(png_image_finish_read(&image, &(png_color){255, 255, 255}, colours, 0, NULL));
}

/* Parts in black: all that is there is filled. In their own colours: with what is nearest. */
static void check_fill(const char *model, bool coloured)
{
    static const char lit_text[] = "{\"version\": 1, \"rules\": [{\"select\": \"*\", \"surface\": \"lit\"}]}";
    static const char black_text[] = "{\"version\": 1, \"rules\": [{\"select\": \"*\", \"surface\": {\"technique\": "
                                     "\"flat\", \"colour\": \"#000000\"}}]}";
    char              folder[] = "/tmp/limner-svg-XXXXXX", path[128], command[256], picture[64];
    lmn_scene        *scene = NULL;
    lmn_look         *look = NULL;
    lmn_sheet        *sheet = NULL;
    lmn_load_desc     load = LMN_LOAD_DESC_INIT;
    lmn_draw_desc     how = LMN_DRAW_DESC_INIT;
    lmn_sheet_desc    desc = LMN_SHEET_DESC_INIT;
    lmn_error         error = {0};
    how.width = how.height = SIDE;
    how.dpi = 96;
    desc.fill = true;
    snprintf(path, sizeof path, "%s/examples/%s", LIMNER_SOURCE_DIR, model);
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(scene, path, &load, &error), LMN_OK);
    assert_int_equal(lmn_look_parse(&look, coloured ? lit_text : black_text, "areas", &error), LMN_OK);
    assert_int_equal(lmn_draw_sheet(&sheet, NULL, scene, look, &how, &desc, &error), LMN_OK);
    rasterise_scene(&wanted, scene, &sheet->views[0].camera);
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/sheet", folder);
    snprintf(picture, sizeof picture, "%s/sheet.png", folder);
    assert_int_equal(lmn_sheet_write(sheet, path, ".svg", NULL, &error), LMN_OK);
    snprintf(command, sizeof command, "rsvg-convert -w 600 -h 600 %s/sheet -o %s/sheet.png", folder, folder);
    bool read = system(command) == 0 && read_png(&drawn, picture);
    if (read)
        read_colours(picture);
    unlink(path);
    unlink(picture);
    rmdir(folder);
    if (read && coloured)
        check_colours(model, scene, look);
    lmn_sheet_destroy(&sheet);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    assert_true(read);
    if (coloured)
        return;
    double found = fraction_near(&wanted, &drawn), true_ink = fraction_near(&drawn, &wanted);
    print_message("%s: %.5f of the triangles are filled, %.5f of what is filled is theirs\n", model, found, true_ink);
    assert_true(found >= 0.9995 && true_ink >= 0.9995);
}

/* Closed and open pieces, holes, pieces through each other. */
static void test_fill_picture(void **state)
{
    (void)state;
    if (!has_program("rsvg-convert")) {
        print_message("rsvg-convert is not installed: areas are not drawn\n");
        skip();
    }
    check_fill("gearbox.stl", false);
    check_fill("pump.glb", false);
    check_fill("spot.obj", false);
    check_fill("house.glb", false);
    check_fill("house.glb", true);
    check_fill("pump.glb", true);
    check_fill("crank.glb", true);
}

/* Letters stand where they should: the words are read back, and are as wide as the font has them. */
static void test_pdf_words(void **state)
{
    char      folder[] = "/tmp/limner-svg-XXXXXX", path[64], command[160], line[256] = "";
    sheet     s;
    lmn_error error = {0};
    double    box[4] = {0}, low = INFINITY, high = -INFINITY;
    (void)state;
    if (!has_program("pdftotext")) {
        print_message("pdftotext is not installed: texts are not read back\n");
        skip();
    }
    sheet_begin(&s, 210, 100, 4);
    sheet_add_text(&s, sheet_add_group(&s, -1, "words", NULL, 0), black, "Wide mill", 20, 50, 4.5, -1);
    export_bytes bytes = bytes_of(&s, export_pdf);
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/sheet", folder);
    assert_int_equal(file_store(path, bytes.data, bytes.size, &error), LMN_OK);
    snprintf(command, sizeof command, "pdftotext -bbox %s -", path);
    FILE *words = popen(command, "r");
    int   count = 0;
    while (words && fgets(line, sizeof line, words))
        if (sscanf(line, " <word xMin=\"%lf\" yMin=\"%lf\" xMax=\"%lf\" yMax=\"%lf\">", &box[0], &box[1], &box[2],
                   &box[3]) == 4) {
            assert_non_null(strstr(line, count == 0 ? ">Wide<" : ">mill<"));
            low = fmin(low, box[0]);
            high = fmax(high, box[2]);
            count++;
        }
    pclose(words);
    unlink(path);
    rmdir(folder);
    mem_free(bytes.data);
    sheet_release(&s);
    /* Liberation Sans, as Arial: W i d e _ m i l l in thousandths of its size. */
    double wanted = (944 + 222 + 556 + 556 + 278 + 833 + 222 + 222 + 222) * 4.5 / 1000, got = (high - low) * 25.4 / 72;
    print_message("%.3f mm wide, wanted %.3f mm\n", got, wanted);
    assert_int_equal(count, 2);
    assert_true(fabs(got - wanted) < 0.02 * wanted);
    assert_true(fabs(low * 25.4 / 72 - 20) < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_structure), cmocka_unit_test(test_round),          cmocka_unit_test(test_few_bytes),
        cmocka_unit_test(test_radii),     cmocka_unit_test(test_hatch_pictures), cmocka_unit_test(test_hatch_tiles),
        cmocka_unit_test(test_hostile),   cmocka_unit_test(test_svg_picture),    cmocka_unit_test(test_pdf_picture),
        cmocka_unit_test(test_pdf_words), cmocka_unit_test(test_fill_picture),
    };
    int failed = cmocka_run_group_tests_name("svg", tests, NULL, NULL);
    xmlCleanupParser();
    return failed;
}
