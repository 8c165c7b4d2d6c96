/* A coarse ball with scene.round covers a disc, in pictures and in vectors; what a renderer keeps of it follows what is
 * drawn: looks, edits, other scenes. */
#include "checked.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { SIDE = 192, ROWS = 6, COLUMNS = 10, VERTICES = (ROWS + 1) * COLUMNS, CORNERS = ROWS * COLUMNS * 6 };

typedef struct picture {
    uint8_t pixels[SIDE * SIDE * 4];
} picture;

typedef struct ball {
    float         positions[3 * VERTICES], normals[3 * VERTICES];
    uint32_t      indices[CORNERS];
    lmn_mesh_desc desc;
} ball;

/* Latitudes and longitudes, both poles in as many copies as there are columns; `tall` stretches it. */
static void make_ball(ball *b, float tall)
{
    for (int i = 0; i <= ROWS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            double a = PI * i / ROWS, c = 2 * PI * k / COLUMNS, at[3] = {sin(a) * cos(c), cos(a), sin(a) * sin(c)};
            for (int m = 0; m < 3; m++) {
                b->positions[3 * (i * COLUMNS + k) + m] = (float)at[m] * (m == 1 ? tall : 1);
                b->normals[3 * (i * COLUMNS + k) + m] = (float)at[m] / (m == 1 ? tall : 1);
            }
        }
    uint32_t n = 0;
    for (uint32_t i = 0; i < ROWS; i++)
        for (uint32_t k = 0; k < COLUMNS; k++) {
            uint32_t next = (k + 1) % COLUMNS, a = i * COLUMNS + k, c = i * COLUMNS + next, d = a + COLUMNS,
                     e = c + COLUMNS;
            const uint32_t corners[6] = {a, c, e, a, e, d};
            memcpy(b->indices + n, corners, sizeof corners);
            n += 6;
        }
    b->desc = (lmn_mesh_desc)LMN_MESH_DESC_INIT;
    b->desc.positions = b->positions;
    b->desc.normals = b->normals;
    b->desc.vertex_count = VERTICES;
    b->desc.indices = b->indices;
    b->desc.index_count = CORNERS;
}

static lmn_scene *scene_of(float tall, uint32_t *mesh)
{
    ball         *b = malloc(sizeof *b);
    lmn_scene    *s = NULL;
    lmn_node_desc node = LMN_NODE_DESC_INIT;
    uint32_t      number;
    make_ball(b, tall);
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_mesh(s, &b->desc, &node.mesh, &error));
    DO(lmn_scene_add_node(s, &node, &number, &error));
    *mesh = node.mesh;
    free(b);
    return s;
}

static lmn_look *look_of(bool round)
{
    lmn_look *look = NULL;
    DO(lmn_look_parse(&look,
                      round ? "{\"version\": 2, \"scene\": {\"round\": true}, \"rules\": [{\"surface\": "
                              "{\"technique\": \"flat\", \"colour\": \"#000000\"}}]}"
                            : "{\"version\": 2, \"rules\": [{\"surface\": {\"technique\": \"flat\", \"colour\": "
                              "\"#000000\"}}]}",
                      "round", &error));
    return look;
}

static void draw(picture *out, lmn_renderer *renderer, const lmn_scene *s, bool round)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *drawing = NULL;
    lmn_look     *look = look_of(round);
    desc.width = desc.height = SIDE;
    desc.view = LMN_VIEW_FRONT;
    desc.orthographic = true;
    DO(lmn_draw(&drawing, renderer, s, look, &desc, &error));
    memcpy(out->pixels, lmn_drawing_pixels(drawing, NULL, NULL), sizeof out->pixels);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
}

static void draw_anew(picture *out, const lmn_scene *s, bool round)
{
    lmn_renderer     *renderer = NULL;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &desc, &error));
    draw(out, renderer, s, round);
    lmn_renderer_destroy(&renderer);
}

/* What is covered, as a share of the ellipse that fits into its box. */
static double fullness(const picture *p)
{
    int    low[2] = {SIDE, SIDE}, high[2] = {-1, -1};
    double area = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double cover = 1 - p->pixels[4 * (y * SIDE + x)] / 255.0;
            area += cover;
            if (cover < 0.5)
                continue;
            low[0] = x < low[0] ? x : low[0];
            high[0] = x > high[0] ? x : high[0];
            low[1] = y < low[1] ? y : low[1];
            high[1] = y > high[1] ? y : high[1];
        }
    return area / (PI / 4 * (high[0] - low[0] + 1) * (high[1] - low[1] + 1));
}

static int set_up(void **state)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    return lmn_renderer_create((lmn_renderer **)state, &desc, &error) != LMN_OK;
}

static int tear_down(void **state)
{
    lmn_renderer_destroy((lmn_renderer **)state);
    return 0;
}

static void coarse_balls_cover_discs(void **state)
{
    picture    coarse, round;
    uint32_t   mesh;
    lmn_scene *s = scene_of(1, &mesh);
    draw(&coarse, *state, s, false);
    draw(&round, *state, s, true);
    assert_true(fullness(&coarse) < 0.975);
    assert_true(fabs(fullness(&round) - 1) < 0.015);
    lmn_scene_destroy(&s);
}

static void what_is_kept_follows_what_is_drawn(void **state)
{
    picture    now, anew;
    uint32_t   mesh, other_mesh;
    lmn_scene *s = scene_of(1, &mesh), *other = scene_of(1.6f, &other_mesh);
    ball      *b = malloc(sizeof *b);
    for (int step = 0; step < 6; step++) { /* round, not, round; changed and not round, changed and round; another */
        bool round = step != 1 && step != 3;
        if (step == 3) {
            make_ball(b, 0.7f);
            DO(lmn_scene_set_mesh(s, mesh, &b->desc, &error));
        }
        if (step == 4) {
            make_ball(b, 1.2f);
            DO(lmn_scene_set_positions(s, mesh, b->positions, b->normals, VERTICES, &error));
        }
        const lmn_scene *drawn = step == 5 ? other : s;
        draw(&now, *state, drawn, round);
        draw_anew(&anew, drawn, round);
        assert_memory_equal(now.pixels, anew.pixels, sizeof now.pixels);
        assert_true(round ? fabs(fullness(&now) - 1) < 0.015 : fullness(&now) < 0.975);
    }
    free(b);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&other);
}

/* What is constructed is no free form: with "forms" it keeps its facets, whatever was drawn before. */
static void forms_alone_are_another_scene(void **state)
{
    static const bool round[] = {true, false, true, false};
    uint32_t          mesh;
    lmn_scene        *s = scene_of(1, &mesh);
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = SIDE;
    desc.view = LMN_VIEW_FRONT;
    desc.orthographic = true;
    for (size_t i = 0; i < sizeof round / sizeof *round; i++) {
        picture      p;
        lmn_drawing *drawing = NULL;
        lmn_look    *look = look_of(true);
        DO(lmn_look_set(look, "scene.round", round[i] ? "true" : "forms", &error));
        DO(lmn_draw(&drawing, *state, s, look, &desc, &error));
        memcpy(p.pixels, lmn_drawing_pixels(drawing, NULL, NULL), sizeof p.pixels);
        assert_true(round[i] ? fabs(fullness(&p) - 1) < 0.015 : fullness(&p) < 0.975);
        lmn_drawing_destroy(&drawing);
        lmn_look_destroy(&look);
    }
    lmn_scene_destroy(&s);
}

/* Meshes of files all have the same revision: what is kept of one file is nothing of the next. */
static void files_do_not_mix(void **state)
{
    static const char *const files[] = {EXAMPLES "/pump.glb", EXAMPLES "/arm.glb"};
    for (int i = 0; i < 2; i++) {
        picture    now, anew;
        lmn_scene *s = NULL;
        DO(lmn_scene_create(&s, &error));
        DO(lmn_scene_add_file(s, files[i], NULL, &error));
        draw(&now, *state, s, true);
        draw_anew(&anew, s, true);
        assert_memory_equal(now.pixels, anew.pixels, sizeof now.pixels);
        lmn_scene_destroy(&s);
    }
}

/* Points of the outline in a vector drawing, of which "viewBox" says the middle: all at one distance from it. */
static void outlines_are_round_in_vectors(void **state)
{
    (void)state;
    uint32_t       mesh;
    lmn_scene     *s = scene_of(1, &mesh);
    lmn_look      *look = NULL;
    lmn_sheet     *sheet = NULL;
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    lmn_sheet_desc wanted = LMN_SHEET_DESC_INIT;
    uint8_t       *bytes = NULL;
    size_t         size = 0;
    wanted.smooth = 0;
    desc.view = LMN_VIEW_FRONT;
    desc.orthographic = true;
    DO(lmn_look_load(&look, "line", &error));
    DO(lmn_look_set(look, "scene.round", "true", &error));
    DO(lmn_draw_sheet(&sheet, NULL, s, look, &desc, &wanted, &error));
    DO(lmn_sheet_encode(sheet, "svg", &bytes, &size, &error));
    char *text = malloc(size + 1), *path;
    memcpy(text, bytes, size);
    text[size] = '\0';
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    int    points = 0;
    assert_non_null(path = strstr(text, " d=\"M"));
    for (int pass = 0; pass < 2; pass++)
        for (char *at = path + 5; *at && *at != '"';) {
            char  *end;
            double x = strtod(at, &end), y;
            if (end == at) {
                at++;
                continue;
            }
            at = end + (*end == ',');
            y = strtod(at, &end);
            at = end;
            if (pass == 0) {
                low[0] = fmin(low[0], x), high[0] = fmax(high[0], x);
                low[1] = fmin(low[1], y), high[1] = fmax(high[1], y);
                points++;
            } else {
                double r = (high[0] - low[0]) / 2;
                assert_true(fabs(hypot(x - (low[0] + high[0]) / 2, y - (low[1] + high[1]) / 2) / r - 1) < 0.015);
            }
        }
    assert_true(points > 3 * COLUMNS);
    free(text);
    lmn_bytes_free(bytes);
    lmn_sheet_destroy(&sheet);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
}

/* --- bevels ---------------------------------------------------------------------------------------------- */

/* A bar along x whose edges are narrow roundings, smoothly shaded, as those of a truck's body; within it a prism
 * that stands for a tube, so that the mesh is made round. */
enum {
    STRIPS = 6,
    PROFILE = 4 * (STRIPS + 1),
    TUBE = 4 * PROFILE, /* its first corner */
    SIDES = 12,
    BEVEL_CORNERS = TUBE + 2 * SIDES,
    BEVEL_TRIANGLES = 2 * PROFILE + 2 * (PROFILE - 2) + 2 * SIDES
};

typedef struct bevelled {
    float    positions[3 * BEVEL_CORNERS], normals[3 * BEVEL_CORNERS];
    uint32_t indices[3 * BEVEL_TRIANGLES], count;
} bevelled;

static const double half_sides[3] = {1, 0.6, 0.5}, bevel = 0.02;

static void put_vector(float *out, double x, double y, double z)
{
    out[0] = (float)x;
    out[1] = (float)y;
    out[2] = (float)z;
}

static void add_face(bevelled *b, uint32_t i, uint32_t k, uint32_t m)
{
    const uint32_t corners[3] = {i, k, m};
    memcpy(b->indices + b->count, corners, sizeof corners);
    b->count += 3;
}

/* Two rings of corners for the sides, two for the ends, and the tube. */
static void make_bevelled(bevelled *b)
{
    memset(b, 0, sizeof *b);
    for (uint32_t i = 0; i < PROFILE; i++) {
        uint32_t quarter = i / (STRIPS + 1), next = (i + 1) % PROFILE;
        double   angle = PI / 2 * (quarter + (double)(i % (STRIPS + 1)) / STRIPS), c = cos(angle), s = sin(angle);
        double   y = (quarter == 0 || quarter == 3 ? 1 : -1) * (half_sides[1] - bevel) + bevel * c,
               z = (quarter < 2 ? 1 : -1) * (half_sides[2] - bevel) + bevel * s;
        for (uint32_t ring = 0; ring < 4; ring++) {
            uint32_t at = 3 * (ring * PROFILE + i);
            double   side = ring % 2 ? 1 : -1;
            put_vector(&b->positions[at], side * half_sides[0], y, z);
            put_vector(&b->normals[at], ring < 2 ? 0 : side, ring < 2 ? c : 0, ring < 2 ? s : 0);
        }
        add_face(b, i, PROFILE + next, PROFILE + i);
        add_face(b, i, next, PROFILE + next);
        if (i + 2 < PROFILE) {
            add_face(b, 2 * PROFILE, 2 * PROFILE + i + 2, 2 * PROFILE + i + 1);
            add_face(b, 3 * PROFILE, 3 * PROFILE + i + 1, 3 * PROFILE + i + 2);
        }
    }
    for (uint32_t i = 0; i < SIDES; i++) {
        double   angle = 2 * PI * i / SIDES, c = cos(angle), s = sin(angle);
        uint32_t at = TUBE + 2 * i, next = TUBE + 2 * ((i + 1) % SIDES);
        for (uint32_t k = 0; k < 2; k++) {
            put_vector(&b->positions[3 * (at + k)], k ? 0.2 : -0.2, 0.2 * c, 0.2 * s);
            put_vector(&b->normals[3 * (at + k)], 0, c, s);
        }
        add_face(b, at, next, next + 1);
        add_face(b, at, next + 1, at + 1);
    }
}

static lmn_scene *scene_of_bevelled(void)
{
    bevelled      b;
    lmn_scene    *s = NULL;
    lmn_mesh_desc mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc node = LMN_NODE_DESC_INIT;
    uint32_t      number;
    make_bevelled(&b);
    mesh.positions = b.positions;
    mesh.normals = b.normals;
    mesh.vertex_count = BEVEL_CORNERS;
    mesh.indices = b.indices;
    mesh.index_count = b.count;
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_mesh(s, &mesh, &node.mesh, &error));
    DO(lmn_scene_add_node(s, &node, &number, &error));
    return s;
}

enum { BEVEL_SIDE = 800 };

/* Where a place lies in a picture from above the front, without perspective. */
#define HALF_HEIGHT 0.4
#define UP          0.18

static void on_page(const double at[3], double out[2])
{
    const double scale = BEVEL_SIDE / (2 * HALF_HEIGHT);
    out[0] = BEVEL_SIDE / 2.0 + scale * at[0];
    out[1] = BEVEL_SIDE / 2.0 - scale * (0.8 * at[1] - 0.6 * at[2] - UP);
}

/* Of what share of a line there is ink within four pixels. */
static double inked(const uint8_t *pixels, const double from[3], const double to[3])
{
    enum { PLACES = 200, NEAR = 4 }; /* a pen's lines stray */
    int found = 0;
    for (int i = 0; i < PLACES; i++) {
        double at[3], page[2], part = 0.05 + 0.9 * i / (PLACES - 1);
        int    darkest = 255;
        for (int k = 0; k < 3; k++)
            at[k] = from[k] + part * (to[k] - from[k]);
        on_page(at, page);
        for (int y = -NEAR; y <= NEAR; y++)
            for (int x = -NEAR; x <= NEAR; x++) {
                int value = pixels[4 * (((int)page[1] + y) * BEVEL_SIDE + (int)page[0] + x)];
                darkest = value < darkest ? value : darkest;
            }
        found += darkest < 160;
    }
    return (double)found / PLACES;
}

/* The edge between two flat faces is a line all along, though it is rounded a little, in each look that hatches. Their
 * strokes are left out, so that nothing else is ink there. */
static void bevels_are_lines_in_looks_of_strokes(void **state)
{
    static const char *const looks[] = {"hatch", "engraving", "ink", "woodcut", "pen", "quill"};
    static const double      view[16] = {1, 0, 0, 0, 0, 0.8, 0.6, 0, 0, -0.6, 0.8, 0, 0, -UP, -5, 1};
    static const double      projection[16] = {1 / HALF_HEIGHT, 0, 0, 0, 0, 1 / HALF_HEIGHT, 0, 0, 0, 0, -0.25, 0, 0, 0,
                                               -1.25,           1};
    lmn_scene               *s = scene_of_bevelled();
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        lmn_drawing  *drawing = NULL;
        lmn_look     *look = NULL;
        DO(lmn_look_load(&look, looks[i], &error));
        DO(lmn_look_set(look, "scene.ground", "none", &error));
        DO(lmn_look_set(look, "surface.technique", "flat", &error));
        DO(lmn_look_set(look, "surface.colour", "#ffffff", &error));
        desc.width = desc.height = BEVEL_SIDE;
        desc.matrices_given = true;
        memcpy(desc.view_matrix, view, sizeof view);
        memcpy(desc.projection_matrix, projection, sizeof projection);
        DO(lmn_draw(&drawing, *state, s, look, &desc, &error));
        const double from[3] = {-0.9 * HALF_HEIGHT, half_sides[1] - 0.3 * bevel, half_sides[2] - 0.3 * bevel},
                     to[3] = {0.9 * HALF_HEIGHT, from[1], from[2]};
        const uint8_t *pixels = lmn_drawing_pixels(drawing, NULL, NULL);
        double         share = inked(pixels, from, to);
        if (share < 0.98)
            print_message("%s: ink along %.3f of the edge\n", looks[i], share);
        assert_true(share >= 0.98);
        lmn_drawing_destroy(&drawing);
        lmn_look_destroy(&look);
    }
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_balls_cover_discs),      cmocka_unit_test(what_is_kept_follows_what_is_drawn),
        cmocka_unit_test(forms_alone_are_another_scene), cmocka_unit_test(files_do_not_mix),
        cmocka_unit_test(outlines_are_round_in_vectors), cmocka_unit_test(bevels_are_lines_in_looks_of_strokes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
