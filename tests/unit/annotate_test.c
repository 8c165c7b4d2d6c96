/* Labels keep clear of each other and of what else is written, whatever the view; legends say what colours mean; bars
 * are as long as they say. By drawings as users get them. */
#include "import_support.h"

#include <math.h>
#include <stdlib.h>

#include "limner/limner.h"

enum { BUILDINGS = 60, BOXES_MAX = 400 };

#define PAGE 271.0 /* side of a page without a size, mm */

static lmn_scene *scene_of_buildings(void)
{
    lmn_scene *scene = NULL;
    lmn_error  error = {0};
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    uint32_t random = 7;
    for (int i = 0; i < BUILDINGS; i++) {
        float size[3];
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            size[k] = 2 + (float)(random >> 16) / 8192;
        }
        float    at[8][3];
        uint32_t mesh, node;
        for (int c = 0; c < 8; c++) {
            at[c][0] = (float)(i % 8) * 14 + (c & 1 ? size[0] : 0);
            at[c][1] = c & 2 ? size[1] * 2 : 0;
            at[c][2] = (float)(i / 8) * 14 + (c & 4 ? size[2] : 0);
        }
        static const uint32_t faces[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 4, 6, 0, 6, 2,
                                           1, 3, 7, 1, 7, 5, 2, 6, 7, 2, 7, 3, 0, 1, 5, 0, 5, 4};
        lmn_mesh_desc         desc = LMN_MESH_DESC_INIT;
        desc.positions = at[0];
        desc.vertex_count = 8;
        desc.indices = faces;
        desc.index_count = 36;
        assert_int_equal(lmn_scene_add_mesh(scene, &desc, &mesh, &error), LMN_OK);
        lmn_node_desc place = LMN_NODE_DESC_INIT;
        char          name[32], year[8];
        snprintf(name, sizeof name, "house number %d", i);
        snprintf(year, sizeof year, "%d", 1900 + i);
        place.name = name;
        place.mesh = mesh;
        assert_int_equal(lmn_scene_add_node(scene, &place, &node, &error), LMN_OK);
        if (i % 10)
            assert_int_equal(lmn_scene_set_attribute(scene, node, "year", year, &error), LMN_OK);
        assert_int_equal(lmn_scene_set_attribute(scene, node, "use", i % 3 ? "home" : "shop", &error), LMN_OK);
    }
    return scene;
}

static lmn_look *look_of(const char *scene, const char *finish)
{
    char      text[1000];
    lmn_look *look = NULL;
    lmn_error error = {0};
    snprintf(text, sizeof text,
             "{\"version\":2,\"name\":\"a\",\"doc\":\"x.\",\"scene\":{%s},\"finish\":{%s},\"rules\":[{\"select\":\"*\","
             "\"lines\":{\"operator\":\"strokes\",\"width\":0.3,\"contours\":\"none\",\"creases\":false}}]}",
             scene, finish);
    assert_int_equal(lmn_look_parse(&look, text, "a", &error), LMN_OK);
    return look;
}

static char *svg_of(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc)
{
    lmn_sheet     *sheet = NULL;
    lmn_sheet_desc wanted = LMN_SHEET_DESC_INIT;
    lmn_error      error = {0};
    wanted.lines_only = true;
    uint8_t *bytes = NULL;
    size_t   size = 0;
    assert_int_equal(lmn_draw_sheet(&sheet, NULL, scene, look, desc, &wanted, &error), LMN_OK);
    assert_int_equal(lmn_sheet_encode(sheet, "svg", &bytes, &size, &error), LMN_OK);
    lmn_sheet_destroy(&sheet);
    char *text = malloc(size + 1);
    assert_non_null(text);
    memcpy(text, bytes, size);
    text[size] = '\0';
    lmn_bytes_free(bytes);
    return text;
}

/* What is written: a text with the rectangle that was drawn last before it, and the last leader. */
typedef struct written {
    char   text[80];
    double x, y, box[4], leader[3]; /* leader: x, from, to */
} written;

/* Numbers of a path that begins with M x y l, as far as there are `count`. */
static int numbers_of(const char *path, double *out, int count)
{
    int n = 0;
    for (const char *at = path; n < count && *at && *at != '"';) {
        char  *end;
        double v = strtod(at, &end);
        if (end == at) {
            at++;
            continue;
        }
        out[n++] = v;
        at = end;
    }
    return n;
}

static size_t read_annotations(const char *svg, written *out, size_t most)
{
    const char *at = strstr(svg, "class=\"annotations\"");
    size_t      count = 0;
    written     now = {.text = ""};
    assert_non_null(at);
    for (at = strchr(at, '\n') + 1; *at && strncmp(at, "</g>", 4) != 0; at = strchr(at, '\n') + 1) {
        double      n[9];
        const char *path = strstr(at, "d=\"M"), *line = strchr(at, '\n'), *text = strstr(at, "<text x=\"");
        int         found = path && path < line ? numbers_of(path + 3, n, 9) : 0;
        if (found == 8 && n[3] == 0 && n[4] == 0 && n[7] == 0) {
            const double box[4] = {n[0], n[1], n[0] + n[2], n[1] + n[5]};
            memcpy(now.box, box, sizeof box);
        } else if (found == 4 && n[2] == 0) {
            const double leader[3] = {n[0], fmin(n[1], n[1] + n[3]), fmax(n[1], n[1] + n[3])};
            memcpy(now.leader, leader, sizeof leader);
        }
        if (!text || text > line || count == most)
            continue;
        now.x = strtod(text + 9, NULL);
        now.y = strtod(strstr(text, "y=\"") + 3, NULL);
        const char *words = strchr(text, '>') + 1;
        snprintf(now.text, sizeof now.text, "%.*s", (int)strcspn(words, "<"), words);
        out[count++] = now;
    }
    return count;
}

static bool overlap(const double a[4], const double b[4])
{
    return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

static const written *find_text(const written *list, size_t count, const char *text)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(list[i].text, text) == 0)
            return &list[i];
    return NULL;
}

/* How many pairs of labels touch, or a label and the legend, or a leader and another label. */
static int conflicts(const written *list, size_t count, double page)
{
    const written *legend = find_text(list, count, "use");
    int            found = 0;
    assert_non_null(legend);
    for (size_t i = 0; i < count; i++) {
        if (strncmp(list[i].text, "house", 5) != 0)
            continue;
        const double *box = list[i].box;
        found += box[0] < 0 || box[1] < 0 || box[2] > page || box[3] > page;
        found += overlap(box, legend->box);
        const double leader[4] = {list[i].leader[0], list[i].leader[1], list[i].leader[0], list[i].leader[2]};
        for (size_t k = 0; k < count; k++) {
            if (k == i || strncmp(list[k].text, "house", 5) != 0)
                continue;
            found += k > i && overlap(box, list[k].box);
            found += overlap(leader, list[k].box);
        }
        found += overlap(leader, legend->box);
    }
    return found;
}

static void labels_keep_clear(void **state)
{
    (void)state;
    lmn_scene *scene = scene_of_buildings();
    lmn_look  *look =
        look_of("\"datum\":\"use\"", "\"labels\":\"name\",\"labels_most\":60,\"legend\":true,\"north_arrow\":true");
    int      bad = 0, views = 0;
    size_t   labels = 0;
    uint32_t random = 11;
    for (int i = 0; i < 200; i++) {
        double        r[3];
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            r[k] = (random >> 8) / 16777216.0;
        }
        desc.width = desc.height = 512;
        desc.eye_given = true;
        desc.orthographic = i % 3 == 0;
        desc.eye[0] = 56 + (60 + 160 * r[1]) * cos(6.283 * r[0]);
        desc.eye[1] = 8 + 150 * r[2];
        desc.eye[2] = 56 + (60 + 160 * r[1]) * sin(6.283 * r[0]);
        desc.target[0] = desc.target[2] = 56;
        desc.target[1] = 5;
        char   *svg = svg_of(scene, look, &desc);
        written list[BOXES_MAX];
        size_t  count = read_annotations(svg, list, BOXES_MAX), here = 0;
        bad += conflicts(list, count, PAGE);
        for (size_t k = 0; k < count; k++)
            here += strncmp(list[k].text, "house", 5) == 0;
        labels += here;
        views += here > 0;
        free(svg);
    }
    assert_int_equal(bad, 0);
    assert_true(views >= 190);
    assert_true(labels > 200 * 12); /* keeping clear is easy for who writes nothing */
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

/* Each label stands over its part: its leader ends on the top of the box that the name says. */
static void labels_say_which(void **state)
{
    (void)state;
    lmn_scene    *scene = scene_of_buildings();
    lmn_look     *look = look_of("\"datum\":\"use\"", "\"labels\":\"name\",\"labels_most\":5,\"labels_by\":\"year\"");
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.view = LMN_VIEW_TOP;
    desc.orthographic = true;
    desc.width = desc.height = 512;
    char   *svg = svg_of(scene, look, &desc);
    written list[BOXES_MAX];
    size_t  count = read_annotations(svg, list, BOXES_MAX);
    /* Of those the latest years, which the first numbers of tens do not state. */
    assert_int_equal(count, 5);
    for (int i = 59; i > 54; i--) {
        char name[32];
        snprintf(name, sizeof name, "house number %d", i);
        assert_non_null(find_text(list, count, name));
    }
    /* Houses of one column stand over each other, as far apart as on the plan. */
    const written *a = find_text(list, count, "house number 59"), *b = find_text(list, count, "house number 58");
    assert_true(a->leader[0] > b->leader[0]);
    free(svg);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

static void labels_are_as_large_as_asked_for(void **state)
{
    (void)state;
    lmn_scene    *scene = scene_of_buildings();
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    double        high[2];
    desc.width = desc.height = 512;
    for (int k = 0; k < 2; k++) {
        lmn_look *look = look_of("\"datum\":\"use\"",
                                 k ? "\"labels\":\"name\",\"label_size\":16" : "\"labels\":\"name\",\"label_size\":8");
        char     *svg = svg_of(scene, look, &desc);
        written   list[BOXES_MAX];
        assert_true(read_annotations(svg, list, BOXES_MAX) > 0);
        high[k] = list[0].box[3] - list[0].box[1];
        free(svg);
        lmn_look_destroy(&look);
    }
    assert_float_equal((float)high[1], (float)(2 * high[0]), 1e-2f);
    lmn_scene_destroy(&scene);
}

/* Heights that nobody states are there all the same, and surfaces of buildings are called like these. */
static void what_is_not_stated(void **state)
{
    (void)state;
    lmn_scene    *scene = scene_of_buildings();
    lmn_look     *look = look_of("\"datum\":\"height\"", "\"legend\":true,\"labels\":\"name\"");
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_error     error = {0};
    desc.width = desc.height = 512;
    uint32_t nodes[BUILDINGS]; /* first: parts get other numbers when nodes come */
    for (uint32_t n = 0; n < BUILDINGS; n++)
        nodes[n] = lmn_scene_node_of_part(scene, n + 1);
    for (uint32_t n = 1; n <= BUILDINGS; n++) {
        uint32_t      wall;
        lmn_node_desc below = LMN_NODE_DESC_INIT;
        below.parent = nodes[n - 1];
        below.name = "wall";
        below.mesh = n;
        assert_int_equal(lmn_scene_add_node(scene, &below, &wall, &error), LMN_OK);
        assert_int_equal(lmn_scene_set_attribute(scene, wall, "surface", "wall", &error), LMN_OK);
    }
    char   *svg = svg_of(scene, look, &desc);
    written list[BOXES_MAX];
    size_t  count = read_annotations(svg, list, BOXES_MAX), houses = 0;
    assert_non_null(find_text(list, count, "height"));
    assert_null(find_text(list, count, "no value"));
    assert_null(find_text(list, count, "wall"));
    for (size_t i = 0; i < count; i++)
        houses += strncmp(list[i].text, "house", 5) == 0;
    assert_true(houses > 5);
    free(svg);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

static void legends_say_what_colours_mean(void **state)
{
    (void)state;
    static const struct {
        const char *scene, *texts[6];
    } rows[] = {
        {"\"datum\":\"use\"", {"use", "home", "shop", NULL}},
        {"\"datum\":\"year\"", {"year", "1901", "1930", "1959", "no value", NULL}},
        {"\"datum\":\"year\",\"datum_from\":1800,\"datum_to\":2000,\"datum_classes\":2",
         {"year", "1800", "1900", "no value", NULL}},
        {"\"datum\":\"use\",\"datum_words\":\"shop\"", {"use", "shop", "no value", NULL}},
    };
    lmn_scene    *scene = scene_of_buildings();
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 512;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_look *look = look_of(rows[i].scene, "\"legend\":true");
        char     *svg = svg_of(scene, look, &desc);
        written   list[BOXES_MAX];
        size_t    count = read_annotations(svg, list, BOXES_MAX);
        for (int k = 0; rows[i].texts[k]; k++)
            assert_non_null(find_text(list, count, rows[i].texts[k]));
        if (i == 3)
            assert_null(find_text(list, count, "home"));
        free(svg);
        lmn_look_destroy(&look);
    }
    lmn_scene_destroy(&scene);
}

/* North is up where the view is from the top, and to the left where the viewer looks east. */
static void needles_point_north(void **state)
{
    (void)state;
    lmn_scene *scene = scene_of_buildings();
    lmn_look  *look = look_of("\"datum\":\"use\"", "\"north_arrow\":true");
    for (int east = 0; east < 2; east++) {
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.width = desc.height = 512;
        desc.view = LMN_VIEW_TOP;
        desc.orthographic = true;
        desc.eye_given = east;
        const double eye[3] = {-300, 150, 56}, target[3] = {56, 0, 56};
        memcpy(desc.eye, eye, sizeof eye);
        memcpy(desc.target, target, sizeof target);
        char  *svg = svg_of(scene, look, &desc);
        double n[6];
        assert_int_equal(numbers_of(strstr(strstr(svg, "class=\"annotations\""), "d=\"M") + 3, n, 6), 6);
        /* From the tail, the mean of the other two corners, to the tip. */
        double tail[2] = {n[2] / 2 + (n[2] + n[4]) / 2, n[3] / 2 + (n[3] + n[5]) / 2};
        if (east)
            assert_true(tail[0] > 5 * fabs(tail[1]));
        else
            assert_true(tail[1] > 5 * fabs(tail[0]));
        free(svg);
    }
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

static void bars_are_as_long_as_they_say(void **state)
{
    (void)state;
    lmn_scene    *scene = scene_of_buildings();
    lmn_look     *look = look_of("\"datum\":\"use\"", "\"scale_bar\":true,\"labels\":\"name\",\"labels_most\":200");
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 900;
    desc.view = LMN_VIEW_FRONT;
    desc.orthographic = true;
    char          *svg = svg_of(scene, look, &desc);
    written        list[BOXES_MAX];
    size_t         count = read_annotations(svg, list, BOXES_MAX);
    const written *zero = find_text(list, count, "0"), *end = zero ? zero + 1 : NULL;
    assert_non_null(zero);
    /* Columns of houses are 14 apart; leaders stand at their middles, which differ by half their sizes: over 7 columns
     * that is little. */
    double least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < count; i++)
        if (strncmp(list[i].text, "house", 5) == 0) {
            least = fmin(least, list[i].leader[0]);
            most = fmax(most, list[i].leader[0]);
        }
    double per_unit = (end->x - zero->x) / strtod(end->text, NULL);
    assert_true(fabs((most - least) / per_unit - 7 * 14) < 4);
    free(svg);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(labels_keep_clear),
        cmocka_unit_test(labels_say_which),
        cmocka_unit_test(labels_are_as_large_as_asked_for),
        cmocka_unit_test(what_is_not_stated),
        cmocka_unit_test(legends_say_what_colours_mean),
        cmocka_unit_test(needles_point_north),
        cmocka_unit_test(bars_are_as_long_as_they_say),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
