/* A ball of few faces that is shaded smoothly throws no shadow on itself where it faces the light, and what lies
 * between it and the light still does. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { SIDE = 256, ROWS = 6, COLUMNS = 10, VERTICES = (ROWS + 1) * COLUMNS, CORNERS = ROWS * COLUMNS * 6 };

typedef struct picture {
    uint8_t pixels[SIDE * SIDE * 4];
} picture;

/* Latitudes and longitudes around `middle`, with the normals of a ball. */
static void add_ball(lmn_scene *s, const float middle[3], double radius)
{
    float    positions[3 * VERTICES], normals[3 * VERTICES];
    uint32_t indices[CORNERS], n = 0;
    for (int i = 0; i <= ROWS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            double a = PI * i / ROWS, c = 2 * PI * k / COLUMNS, at[3] = {sin(a) * cos(c), cos(a), sin(a) * sin(c)};
            for (int m = 0; m < 3; m++) {
                normals[3 * (i * COLUMNS + k) + m] = (float)at[m];
                positions[3 * (i * COLUMNS + k) + m] = middle[m] + (float)(radius * at[m]);
            }
        }
    for (uint32_t i = 0; i < ROWS; i++)
        for (uint32_t k = 0; k < COLUMNS; k++) {
            uint32_t       a = i * COLUMNS + k, c = i * COLUMNS + (k + 1) % COLUMNS, d = a + COLUMNS, e = c + COLUMNS;
            const uint32_t corners[6] = {a, c, e, a, e, d};
            memcpy(indices + n, corners, sizeof corners);
            n += 6;
        }
    lmn_mesh_desc mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc node = LMN_NODE_DESC_INIT;
    uint32_t      number;
    mesh.positions = positions;
    mesh.normals = normals;
    mesh.vertex_count = VERTICES;
    mesh.indices = indices;
    mesh.index_count = CORNERS;
    DO(lmn_scene_add_mesh(s, &mesh, &node.mesh, &error));
    DO(lmn_scene_add_node(s, &node, &number, &error));
}

static void draw(picture *out, lmn_renderer *renderer, const lmn_scene *s, bool shadows, int softness,
                 const char *light, const char *rule)
{
    char          text[512];
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *drawing = NULL;
    lmn_look     *look = NULL;
    snprintf(text, sizeof text,
             "{\"version\": 2, \"scene\": {\"shadows\": %s, \"shadow_softness\": %d, \"ground\": \"none\", "
             "\"light_direction\": %s}, \"rules\": "
             "[{%s}]}",
             shadows ? "true" : "false", softness, light, rule);
    DO(lmn_look_parse(&look, text, "self-shadow", &error));
    desc.width = desc.height = SIDE;
    desc.view = LMN_VIEW_FRONT;
    desc.orthographic = true;
    DO(lmn_draw(&drawing, renderer, s, look, &desc, &error));
    memcpy(out->pixels, lmn_drawing_pixels(drawing, NULL, NULL), sizeof out->pixels);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
}

/* Pixels that differ by more than what rounds and blends. */
static int differing(const picture *a, const picture *b)
{
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        count += abs(a->pixels[4 * i] - b->pixels[4 * i]) > 8;
    return count;
}

static const char *const forward = "\"surface\": {\"technique\": \"lambert\"}";
static const char *const deferred =
    "\"layers\": {\"technique\": \"front\", \"shading\": \"deferred\"}, \"surface\": {\"technique\": \"lambert\"}";

static void none_on_itself(void **state)
{
    static const char *const lights[] = {"[0.3, 0.5, 1]", "[-1, 0.4, 0.5]", "[0.9, 0.7, 0.1]", "[0, 1, 0]"};
    for (int way = 0; way < 4; way++)
        for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
            bool       deferred_too = way % 2 == 1;
            int        softness = way / 2 * 5;
            picture    with, without;
            lmn_scene *s = NULL;
            DO(lmn_scene_create(&s, &error));
            add_ball(s, (const float[3]){0, 0, 0}, 1);
            draw(&with, *state, s, true, softness, lights[i], deferred_too ? deferred : forward);
            draw(&without, *state, s, false, softness, lights[i], deferred_too ? deferred : forward);
            if (differing(&with, &without) > SIDE * SIDE / 1000)
                fail_msg("%d pixels of the ball lie in its own shadow, light %s of %d degrees, %s",
                         differing(&with, &without), lights[i], softness, deferred_too ? "deferred" : "forward");
            lmn_scene_destroy(&s);
        }
}

/* A small ball between light and ball: the disc of its shadow, seen from where the light is. */
static void others_still_throw_theirs(void **state)
{
    for (int way = 0; way < 4; way++) {
        bool       deferred_too = way % 2 == 1;
        int        softness = way / 2; /* the border stays narrow, so that the disc can be counted */
        picture    with, without;
        lmn_scene *s = NULL;
        DO(lmn_scene_create(&s, &error));
        add_ball(s, (const float[3]){0, 0, 0}, 1);
        add_ball(s, (const float[3]){-1.4f, 1.4f, 1.4f}, 0.3);
        draw(&with, *state, s, true, softness, "[-1, 1, 1]", deferred_too ? deferred : forward);
        draw(&without, *state, s, false, softness, "[-1, 1, 1]", deferred_too ? deferred : forward);
        /* The ball's shadow: a disc of 0.3 around the place of the ball that faces the light, seen 55° from the side.
         */
        double scale = 0.0, expected;
        int    low = SIDE, high = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                if (without.pixels[4 * (y * SIDE + x) + 1] < 250) {
                    low = x < low ? x : low;
                    high = x > high ? x : high;
                }
        scale = (high - low + 1) / 2.7; /* from -1.7 to 1 */
        expected = PI * 0.3 * 0.3 / sqrt(3) * scale * scale;
        if (fabs(differing(&with, &without) / expected - 1) > 0.15)
            fail_msg("the shadow covers %d pixels instead of %.0f", differing(&with, &without), expected);
        lmn_scene_destroy(&s);
    }
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(none_on_itself), cmocka_unit_test(others_still_throw_theirs)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
