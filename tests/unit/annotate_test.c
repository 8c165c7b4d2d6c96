/* Labels keep clear of each other and of what else is written, whatever the view; legends say what colours mean; bars
 * are as long as they say. By drawings as users get them. */
#include "import_support.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>

#include "limner/limner.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

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
/* Where a path of straight lines goes: M, and relative l, h and v. Returns the number of places. */
static int places_of(const char *path, double (*out)[2], int most)
{
    int    n = 0;
    char   command = 'M';
    double at[2] = {0, 0};
    for (const char *c = path; n < most && *c && *c != '"';) {
        char  *end;
        double v[2] = {strtod(c, &end), 0};
        if (end == c) {
            command = isalpha((unsigned char)*c) ? *c : command;
            c++;
            continue;
        }
        if (command == 'M' || command == 'l')
            v[1] = strtod(end, &end);
        at[0] = command == 'M' ? v[0] : at[0] + (command == 'v' ? 0 : v[0]);
        at[1] = command == 'M' ? v[1] : at[1] + (command == 'v' ? v[0] : v[1]);
        memcpy(out[n++], at, sizeof at);
        command = command == 'M' ? 'l' : command;
        c = end;
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
        double      n[5][2];
        const char *path = strstr(at, "d=\"M"), *line = strchr(at, '\n'), *text = strstr(at, "<text x=\"");
        int         found = path && path < line ? places_of(path + 3, n, 5) : 0;
        if (found == 4 && n[1][1] == n[0][1] && n[2][0] == n[1][0] && n[3][1] == n[2][1]) {
            const double box[4] = {n[0][0], n[0][1], n[2][0], n[2][1]};
            memcpy(now.box, box, sizeof box);
        } else if (found == 2 && n[1][0] == n[0][0]) {
            const double leader[3] = {n[0][0], fmin(n[0][1], n[1][1]), fmax(n[0][1], n[1][1])};
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
        {"\"datum\":\"use\",\"datum_words\":\"shop\"", {"use", "shop", "others", NULL}},
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
        double n[3][2];
        assert_int_equal(places_of(strstr(strstr(svg, "class=\"annotations\""), "d=\"M") + 3, n, 3), 3);
        /* From the tail, the mean of the other two corners, to the tip. */
        double tail[2] = {(n[1][0] + n[2][0]) / 2 - n[0][0], (n[1][1] + n[2][1]) / 2 - n[0][1]};
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

/* A datum is of the scene before it was bent. */
static void bent_scenes_keep_their_heights(void **state)
{
    (void)state;
    lmn_scene          *scene = scene_of_buildings(), *bent = NULL;
    lmn_look           *look = look_of("\"datum\":\"height\"", "\"legend\":true");
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
    lmn_draw_desc       desc = LMN_DRAW_DESC_INIT;
    lmn_error           error = {0};
    written             list[2][BOXES_MAX];
    size_t              count[2];
    desc.width = desc.height = 512;
    desc.eye_given = true;
    desc.eye[0] = 56, desc.eye[1] = 25, desc.eye[2] = 250;
    desc.target[0] = 56;
    char *plain = svg_of(scene, look, &desc);
    count[0] = read_annotations(plain, list[0], BOXES_MAX);
    assert_int_equal(lmn_scene_project(&bent, scene, &desc, &how, &error), LMN_OK);
    char *text = svg_of(bent, look, &desc);
    count[1] = read_annotations(text, list[1], BOXES_MAX);
    assert_true(count[0] > 4);
    assert_int_equal(count[0], count[1]);
    for (size_t i = 0; i < count[0]; i++)
        assert_string_equal(list[0][i].text, list[1][i].text);
    free(plain);
    free(text);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&bent);
    lmn_scene_destroy(&scene);
}

/* Which part a ray meets first, of all triangles; NONE: none. */
static int32_t part_on_ray(const lmn_scene *scene, const double eye[3], const double way[3])
{
    int32_t nearest = NONE;
    double  best = INFINITY;
    for (size_t i = 0; i < scene->part_count; i++) {
        const mesh *m = &scene->meshes[scene->nodes[scene->parts[i].node].mesh];
        for (size_t k = 0; k < m->primitive_count; k++) {
            const primitive *p = &m->primitives[k];
            for (uint32_t t = 0; t + 2 < p->index_count; t += 3) {
                double a[3], e[2][3], n[3], q[3], w[3];
                for (int c = 0; c < 3; c++) {
                    a[c] = eye[c] - (double)(&p->positions[p->indices[t]].x)[c];
                    for (int j = 0; j < 2; j++)
                        e[j][c] = (double)(&p->positions[p->indices[t + 1 + (uint32_t)j]].x)[c] -
                                  (double)(&p->positions[p->indices[t]].x)[c];
                }
                for (int c = 0; c < 3; c++) {
                    int x = (c + 1) % 3, y = (c + 2) % 3;
                    n[c] = e[0][x] * e[1][y] - e[0][y] * e[1][x];
                    q[c] = a[x] * way[y] - a[y] * way[x];
                }
                double along = way[0] * n[0] + way[1] * n[1] + way[2] * n[2];
                w[0] = -(e[1][0] * q[0] + e[1][1] * q[1] + e[1][2] * q[2]) / along;
                w[1] = (e[0][0] * q[0] + e[0][1] * q[1] + e[0][2] * q[2]) / along;
                w[2] = -(a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / along;
                if (w[0] >= 0 && w[1] >= 0 && w[0] + w[1] <= 1 && w[2] > 0 && w[2] < best) {
                    best = w[2];
                    nearest = (int32_t)i;
                }
            }
        }
    }
    return nearest;
}

/* A low ring around a tall house: its middle is the house's. */
static void add_ring(lmn_scene *scene)
{
    const float    at[8][3] = {{-4, 0, 9},   {40, 0, 9},  {40, 0, 50}, {-4, 0, 50},
                               {-20, 0, -6}, {60, 0, -6}, {60, 0, 70}, {-20, 0, 70}};
    const uint32_t faces[24] = {0, 4, 5, 0, 5, 1, 1, 5, 6, 1, 6, 2, 2, 6, 7, 2, 7, 3, 3, 7, 4, 3, 4, 0};
    uint32_t       mesh, node;
    lmn_error      error = {0};
    lmn_mesh_desc  desc = LMN_MESH_DESC_INIT;
    lmn_node_desc  place = LMN_NODE_DESC_INIT;
    desc.positions = at[0];
    desc.vertex_count = 8;
    desc.indices = faces;
    desc.index_count = 24;
    assert_int_equal(lmn_scene_add_mesh(scene, &desc, &mesh, &error), LMN_OK);
    place.name = "house ring";
    place.mesh = mesh;
    assert_int_equal(lmn_scene_add_node(scene, &place, &node, &error), LMN_OK);
}

/* Whose pins are not on a place of their part that is seen. */
static size_t stray_pins(const lmn_scene *scene, const lmn_draw_desc *desc, const written *list, size_t count)
{
    double ahead[3], right[3], up[3], length = 0, side;
    size_t stray = 0;
    for (int k = 0; k < 3; k++) {
        ahead[k] = desc->target[k] - desc->eye[k];
        length += ahead[k] * ahead[k];
    }
    for (int k = 0; k < 3; k++)
        ahead[k] /= sqrt(length);
    side = hypot(ahead[0], ahead[2]);
    right[0] = -ahead[2] / side, right[1] = 0, right[2] = ahead[0] / side;
    for (int k = 0; k < 3; k++)
        up[k] = right[(k + 1) % 3] * ahead[(k + 2) % 3] - right[(k + 2) % 3] * ahead[(k + 1) % 3];
    for (size_t i = 0; i < count; i++) {
        if (strncmp(list[i].text, "house", 5) != 0)
            continue;
        double slope = tan(desc->fov_deg * 3.14159265358979323846 / 360), way[3];
        for (int k = 0; k < 3; k++)
            way[k] = ahead[k] + slope * ((2 * list[i].leader[0] / PAGE - 1) * right[k] +
                                         (1 - 2 * list[i].leader[2] / PAGE) * up[k]);
        int32_t part = part_on_ray(scene, desc->eye, way);
        stray += part == NONE || strcmp(scene->nodes[scene->parts[part].node].name, list[i].text) != 0;
    }
    return stray;
}

/* Each pin is on a place of its own part that is seen, in bent scenes too. */
static void pins_are_on_what_is_seen(void **state)
{
    (void)state;
    lmn_scene          *scene = scene_of_buildings(), *bent = NULL;
    lmn_look           *look = look_of("\"datum\":\"use\"", "\"labels\":\"name\",\"labels_most\":60");
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
    lmn_error           error = {0};
    add_ring(scene);
    for (int i = 0; i < 8; i++) {
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.width = desc.height = 512;
        desc.eye_given = true;
        desc.fov_deg = 45;
        desc.eye[0] = 56 + 150 * cos(0.8 * i), desc.eye[1] = 20 + 9 * i, desc.eye[2] = 42 + 150 * sin(0.8 * i);
        desc.target[0] = 50, desc.target[1] = 5, desc.target[2] = 42;
        lmn_scene_destroy(&bent);
        if (i % 2)
            assert_int_equal(lmn_scene_project(&bent, scene, &desc, &how, &error), LMN_OK);
        char   *svg = svg_of(bent ? bent : scene, look, &desc);
        written list[BOXES_MAX];
        size_t  count = read_annotations(svg, list, BOXES_MAX);
        assert_true(count >= 8);
        assert_int_equal(stray_pins(bent ? bent : scene, &desc, list, count), 0);
        free(svg);
    }
    lmn_look_destroy(&look);
    lmn_scene_destroy(&bent);
    lmn_scene_destroy(&scene);
}

/* Numbers that a reader gives what has no name are no names. */
static void numbers_are_no_names(void **state)
{
    (void)state;
    static const char text[] =
        "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":"
        "\"urn:ogc:def:crs:EPSG::25832\"}},\"features\":["
        "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"height\":9,\"name\":\"Hall\"},\"geometry\":{"
        "\"type\":\"Polygon\",\"coordinates\":[[[0,0],[9,0],[9,9],[0,9],[0,0]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"height\":9,\"name\":\"  \"},\"geometry\":{"
        "\"type\":\"Polygon\",\"coordinates\":[[[20,0],[29,0],[29,9],[20,9],[20,0]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"height\":9},\"geometry\":{"
        "\"type\":\"Polygon\",\"coordinates\":[[[40,0],[49,0],[49,9],[40,9],[40,0]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"highway\":\"residential\"},\"geometry\":{\"type\":\"LineString\","
        "\"coordinates\":[[-80,-20],[80,-20]]}}]}";
    lmn_look     *look = look_of("\"datum\":\"use\"", "\"labels\":\"name\"");
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    written       list[BOXES_MAX];
    desc.width = desc.height = 512;
    for (int populate = 0; populate < 2; populate++) {
        lmn_scene    *scene = NULL;
        lmn_error     error = {0};
        lmn_load_desc how = LMN_LOAD_DESC_INIT;
        how.populate = populate;
        assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
        assert_int_equal(lmn_scene_add_file(scene, temp_file("names.geojson", text, sizeof text - 1), &how, &error),
                         LMN_OK);
        char  *svg = svg_of(scene, look, &desc);
        size_t count = read_annotations(svg, list, BOXES_MAX);
        for (size_t i = 0; i < count; i++)
            assert_string_equal(list[i].text, "Hall");
        assert_int_equal(count, 1);
        free(svg);
        lmn_scene_destroy(&scene);
    }
    lmn_look_destroy(&look);
}

/* Words beyond the palette's colours have variations of these, and what is beyond those is told as others. */
static void many_words_have_colours(void **state)
{
    (void)state;
    for (int words = 10; words <= 20; words += 10) {
        lmn_scene *scene = scene_of_buildings();
        lmn_error  error = {0};
        for (uint32_t i = 0; i < BUILDINGS; i++) {
            char kind[16];
            snprintf(kind, sizeof kind, "kind %02d", (int)i % words);
            assert_int_equal(lmn_scene_set_attribute(scene, lmn_scene_node_of_part(scene, i + 1), "kind", kind, &error),
                             LMN_OK);
        }
        lmn_look *look =
            look_of("\"datum\":\"kind\",\"datum_palette\":[\"#ff0000\",\"#00ff00\",\"#0000ff\"]", "\"legend\":true");
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        written       list[BOXES_MAX];
        desc.width = desc.height = 512;
        char  *svg = svg_of(scene, look, &desc);
        size_t count = read_annotations(svg, list, BOXES_MAX);
        assert_null(find_text(list, count, "no value"));
        assert_int_equal(find_text(list, count, "others") != NULL, words > 16);
        for (int i = 0; i < (words < 16 ? words : 16); i++) {
            char kind[16];
            snprintf(kind, sizeof kind, "kind %02d", i);
            assert_non_null(find_text(list, count, kind));
        }
        free(svg);
        lmn_look_destroy(&look);
        lmn_scene_destroy(&scene);
    }
}

/* A ramp from more to less is no ramp. */
static void backward_ramps_are_refused(void **state)
{
    (void)state;
    lmn_scene     *scene = scene_of_buildings();
    lmn_look      *look = look_of("\"datum\":\"year\",\"datum_from\":2000,\"datum_to\":1900", "\"legend\":true");
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    lmn_sheet_desc wanted = LMN_SHEET_DESC_INIT;
    lmn_sheet     *sheet = NULL;
    lmn_error      error = {0};
    wanted.lines_only = true;
    assert_int_equal(lmn_draw_sheet(&sheet, NULL, scene, look, &desc, &wanted, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "datum_from"));
    lmn_sheet_destroy(&sheet);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

/* Up where the view looks north, down where south, to a side where east or west: from the street, from below roofs,
 * bent or not. */
static void needles_point_north_at_eye_level(void **state)
{
    (void)state;
    static const struct {
        double eye[3], target[3];
        int    projection; /* -1: none */
        int    axis, sign; /* where the needle points: 0 to the right, 1 up */
    } rows[] = {
        {{56, 12, 300}, {56, 12, 0}, -1, 1, 1},
        {{56, 1, 300}, {56, 8, 0}, -1, 1, 1},
        {{56, 12, -300}, {56, 12, 0}, -1, 1, -1},
        {{-300, 4, 42}, {0, 4, 42}, -1, 0, -1},
        {{56, 60, -150}, {56, 5, 42}, LMN_PROJECTION_MULTI_PERSPECTIVE, 1, -1},
        {{56, 60, 250}, {56, 5, 42}, LMN_PROJECTION_MULTI_PERSPECTIVE, 1, 1},
        {{-150, 40, 42}, {56, 5, 42}, LMN_PROJECTION_MULTI_PERSPECTIVE, 0, -1},
        {{56, 12, 70}, {56, 12, -50}, LMN_PROJECTION_PANORAMA, 1, 1},
        {{56, 12, 20}, {56, 12, 400}, LMN_PROJECTION_PANORAMA, 1, -1},
        {{40, 12, 42}, {400, 12, 42}, LMN_PROJECTION_PANORAMA, 0, -1},
    };
    lmn_scene *scene = scene_of_buildings();
    lmn_look  *look = look_of("\"datum\":\"use\"", "\"north_arrow\":true");
    for (size_t i = 0; i < COUNT(rows); i++) {
        lmn_draw_desc       desc = LMN_DRAW_DESC_INIT;
        lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
        lmn_scene          *bent = NULL;
        lmn_error           error = {0};
        desc.width = desc.height = 512;
        desc.eye_given = true;
        memcpy(desc.eye, rows[i].eye, sizeof desc.eye);
        memcpy(desc.target, rows[i].target, sizeof desc.target);
        if (rows[i].projection >= 0) {
            how.projection = (lmn_projection)rows[i].projection;
            assert_int_equal(lmn_scene_project(&bent, scene, &desc, &how, &error), LMN_OK);
        }
        char  *svg = svg_of(bent ? bent : scene, look, &desc);
        double n[3][2], tip[2];
        assert_int_equal(places_of(strstr(strstr(svg, "class=\"annotations\""), "d=\"M") + 3, n, 3), 3);
        for (int k = 0; k < 2; k++)
            tip[k] = (n[0][k] - (n[1][k] + n[2][k]) / 2) * (k ? -1 : 1);
        if (!(rows[i].sign * tip[rows[i].axis] > 5 * fabs(tip[1 - rows[i].axis])))
            fail_msg("view %zu: the needle points to %g, %g", i, tip[0], tip[1]);
        free(svg);
        lmn_scene_destroy(&bent);
    }
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
        cmocka_unit_test(bent_scenes_keep_their_heights),
        cmocka_unit_test(pins_are_on_what_is_seen),
        cmocka_unit_test(numbers_are_no_names),
        cmocka_unit_test(many_words_have_colours),
        cmocka_unit_test(backward_ramps_are_refused),
        cmocka_unit_test(needles_point_north_at_eye_level),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
