/* Washes of look draft: paint on paper, so never lighter than it, and of the model's colours. */
#include "checked.h"

#include <string.h>

enum { SIDE = 160, PIXELS = SIDE * SIDE };

/* A box of one colour, before the look's own ground. */
static void draw_box(const float colour[3], uint8_t *out)
{
    static const float    corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                           {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const uint32_t indices[] = {4, 5, 6, 4, 6, 7, 0, 2, 1, 0, 3, 2, 0, 4, 7, 0, 7, 3,
                                       1, 2, 6, 1, 6, 5, 3, 7, 6, 3, 6, 2, 0, 1, 5, 0, 5, 4};
    lmn_renderer         *renderer = NULL;
    lmn_scene            *scene = NULL;
    lmn_look             *look = NULL;
    lmn_drawing          *drawing = NULL;
    lmn_renderer_desc     rd = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc         desc = LMN_DRAW_DESC_INIT;
    lmn_material_desc     material = LMN_MATERIAL_DESC_INIT;
    lmn_mesh_desc         mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc         node = LMN_NODE_DESC_INIT;
    memcpy(material.colour, colour, 3 * sizeof *colour);
    mesh.positions = corners[0];
    mesh.vertex_count = 8;
    mesh.indices = indices;
    mesh.index_count = 36;
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_material(scene, &material, &mesh.material, &error));
    DO(lmn_scene_add_mesh(scene, &mesh, &node.mesh, &error));
    DO(lmn_scene_add_node(scene, &node, NULL, &error));
    DO(lmn_look_load(&look, "draft", &error));
    DO(lmn_look_set(look, "scene.ground", "none", &error)); /* its shadow would take room on the page */
    desc.width = desc.height = SIDE;
    DO(lmn_draw(&drawing, renderer, scene, look, &desc, &error));
    memcpy(out, lmn_drawing_pixels(drawing, NULL, NULL), 4 * PIXELS);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
}

static double luminance(const uint8_t *p)
{
    return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
}

static void nothing_is_lighter_than_the_paper(void **state)
{
    static uint8_t     pixels[4 * PIXELS];
    static const float white[3] = {1, 1, 1};
    double             lightest = 0;
    size_t             washed = 0;
    (void)state;
    draw_box(white, pixels);
    for (size_t i = 0; i < PIXELS; i++) {
        double light = luminance(pixels + 4 * i);
        lightest = light > lightest ? light : lightest;
        washed += memcmp(pixels, pixels + 4 * i, 3) != 0;
    }
    assert_true(washed > PIXELS / 5);
    if (lightest > luminance(pixels) + 0.5)
        fail_msg("%.2f on a paper of %.2f", lightest, luminance(pixels));
}

static void washes_keep_their_colour(void **state)
{
    static uint8_t     pixels[4 * PIXELS];
    static const float orange[3] = {0.8f, 0.25f, 0.03f};
    size_t             coloured = 0;
    (void)state;
    draw_box(orange, pixels);
    for (size_t i = 0; i < PIXELS; i++)
        coloured += pixels[4 * i] - pixels[4 * i + 2] > 80;
    if (coloured < PIXELS / 8)
        fail_msg("%zu of %d pixels are orange", coloured, PIXELS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_lighter_than_the_paper),
                                       cmocka_unit_test(washes_keep_their_colour)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
