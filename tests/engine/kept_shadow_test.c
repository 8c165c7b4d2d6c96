/* What the light sees is kept from one picture to the next. Whatever has changed between them, the next picture is,
 * byte by byte, that of a renderer that has never drawn; and where nothing has, the light is not asked again. */
#include "checked.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/session.h"

enum { SIDE = 96, BYTES = 4 * SIDE * SIDE };

/* What is drawn: changed step by step. */
typedef struct wish {
    const char *light, *select;
    double      eye[3];
    int         side;
    double      softness;
} wish;

static uint32_t add_box(lmn_scene *s, const char *name, const double low[3], const double high[3])
{
    static const uint32_t faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    float                 positions[8][3];
    uint32_t              indices[36], *at = indices, mesh = 0, node = 0;
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            positions[i][k] = (float)(i >> k & 1 ? high[k] : low[k]);
    for (int f = 0; f < 6; f++)
        for (int k = 0; k < 6; k++)
            *at++ = faces[f][(int[]){0, 2, 1, 0, 3, 2}[k]];
    lmn_mesh_desc desc = LMN_MESH_DESC_INIT;
    desc.positions = positions[0];
    desc.vertex_count = 8;
    desc.indices = indices;
    desc.index_count = 36;
    DO(lmn_scene_add_mesh(s, &desc, &mesh, &error));
    lmn_node_desc wanted = LMN_NODE_DESC_INIT;
    wanted.name = name;
    wanted.mesh = mesh;
    DO(lmn_scene_add_node(s, &wanted, &node, &error));
    return node;
}

static void draw(lmn_renderer *r, const lmn_scene *s, const wish *w, uint8_t *pixels)
{
    char          text[600];
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    snprintf(text, sizeof text,
             "{\"version\":2,\"name\":\"s\",\"doc\":\"x.\",\"scene\":{\"shadows\":true,\"shadow_softness\":%g,"
             "\"ground\":\"cast\",\"ground_smoothing\":20,\"light_direction\":%s},\"rules\":[{\"select\":\"%s\","
             "\"surface\":\"lambert\"}]}",
             w->softness, w->light, w->select);
    DO(lmn_look_parse(&look, text, "s.json", &error));
    desc.width = w->side;
    desc.height = SIDE;
    desc.samples = 1;
    memcpy(desc.eye, w->eye, sizeof desc.eye);
    desc.eye_given = true;
    desc.up[1] = 1;
    DO(lmn_draw(&drawing, r, s, look, &desc, &error));
    memset(pixels, 0, BYTES);
    memcpy(pixels, lmn_drawing_pixels(drawing, NULL, NULL), 4u * SIDE * (size_t)w->side);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
}

static void draw_fresh(const lmn_scene *s, const wish *w, uint8_t *pixels)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    lmn_renderer     *r = NULL;
    DO(lmn_renderer_create(&r, &desc, &error));
    draw(r, s, w, pixels);
    lmn_renderer_destroy(&r);
}

static void pictures_know_of_every_change(void **state)
{
    (void)state;
    static uint8_t    before[BYTES], kept[BYTES], fresh[BYTES];
    lmn_renderer     *r = NULL;
    lmn_scene        *s = NULL;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    wish              w = {"[0.5,1,0.4]", "*", {7, 9, 11}, SIDE, 0};
    DO(lmn_renderer_create(&r, &desc, &error));
    DO(lmn_scene_create(&s, &error));
    add_box(s, "plate", (double[]){-4, -1, -4}, (double[]){4, 0, 4});
    uint32_t tower = add_box(s, "tower", (double[]){0, 0, 0}, (double[]){1, 4, 1});
    add_box(s, "wall", (double[]){-3, 0, -2}, (double[]){-2.5, 2, 2});
    draw(r, s, &w, before);
    for (int step = 0; step < 8; step++) {
        const void *seen = r->up.lit.depth;
        assert_non_null(seen);
        switch (step) {
        case 0: break; /* the same again */
        case 1: w.light = "[-0.5,1,0.4]"; break;
        case 2: w.select = "!tower"; break; /* the scene has not changed; what throws shadows has */
        case 3:
            w.select = "*";
            w.eye[0] = 5;
            break;
        case 4: w.side = SIDE / 2; break;
        case 5: w.softness = 12; break;
        case 6: w.light = "[0.5,1,0.4]"; break; /* mirrored: the light's picture is as large as before */
        default: {
            const double moved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1.5, 0, 1, 1};
            DO(lmn_scene_set_matrix(s, tower, moved, &error));
        }
        }
        draw(r, s, &w, kept);
        draw_fresh(s, &w, fresh);
        if (memcmp(kept, fresh, BYTES) != 0)
            fail_msg("step %d: another picture than without what was kept", step);
        assert_true((memcmp(kept, before, BYTES) == 0) == (step == 0));
        if (step == 0)
            assert_ptr_equal(r->up.lit.depth, seen);
        memcpy(before, kept, BYTES);
    }
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&r);
}

/* Mirrored, the shadow on the ground lies in as large a box of the page, and is another one. */
static void shadows_on_the_ground_too(void **state)
{
    (void)state;
    static uint8_t    kept[BYTES], fresh[BYTES], before[BYTES];
    lmn_scene        *s = NULL;
    lmn_renderer     *r = NULL;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    wish              w = {"[0.5,1,0]", "*", {0, 9, 9}, SIDE, 0};
    DO(lmn_renderer_create(&r, &desc, &error));
    DO(lmn_scene_create(&s, &error));
    add_box(s, "tower", (double[]){-1, 0, -1}, (double[]){1, 4, 1});
    draw(r, s, &w, before);
    const void *calmed = r->up.ground_shadow.calmed;
    assert_non_null(calmed);
    draw(r, s, &w, kept);
    assert_ptr_equal(r->up.ground_shadow.calmed, calmed);
    assert_memory_equal(kept, before, BYTES);
    w.light = "[-0.5,1,0]";
    draw(r, s, &w, kept);
    draw_fresh(s, &w, fresh);
    assert_memory_not_equal(kept, before, BYTES);
    assert_memory_equal(kept, fresh, BYTES);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_know_of_every_change),
                                       cmocka_unit_test(shadows_on_the_ground_too)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
