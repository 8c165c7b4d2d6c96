/* Maps in the caller's memory, and picking: against the files of maps and the numbers of a box. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 90, HEIGHT = 70, PIXELS = WIDTH * HEIGHT };

static lmn_renderer *renderer;
static lmn_scene    *scene;
static uint32_t      left_part, right_part;

/* Two unit boxes side by side, seen from the front. */
static int set_up(void **state)
{
    (void)state;
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_scene_create(&scene, &error));
    static const float    corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                           {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const uint32_t indices[] = {4, 5, 6, 4, 6, 7, 0, 2, 1, 0, 3, 2, 0, 4, 7, 0, 7, 3,
                                       1, 2, 6, 1, 6, 5, 3, 7, 6, 3, 6, 2, 0, 1, 5, 0, 5, 4};
    lmn_mesh_desc         mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc         node = LMN_NODE_DESC_INIT;
    mesh.positions = corners[0];
    mesh.vertex_count = 8;
    mesh.indices = indices;
    mesh.index_count = 36;
    DO(lmn_scene_add_mesh(scene, &mesh, &node.mesh, &error));
    node.matrix[12] = -1.25;
    DO(lmn_scene_add_node(scene, &node, NULL, &error));
    node.matrix[12] = 0.25;
    DO(lmn_scene_add_node(scene, &node, NULL, &error));
    left_part = 1;
    right_part = 2;
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
    return 0;
}

static lmn_drawing *draw(bool orthographic, bool maps)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    DO(lmn_look_load(&look, "edges", &error));
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.view = LMN_VIEW_FRONT;
    desc.orthographic = orthographic;
    desc.maps = maps;
    DO(lmn_draw(&drawing, renderer, scene, look, &desc, &error));
    lmn_look_destroy(&look);
    return drawing;
}

/* Drafts show the same surfaces, and lines in the same places; only how exactly these lie is left out. */
static void drafts_have_the_same_lines(void **state)
{
    (void)state;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_look     *look = NULL;
    lmn_drawing  *drawings[2] = {NULL, NULL};
    uint32_t     *ids[2];
    float        *edges[2];
    int           lines[2] = {0, 0}, alike = 0;
    DO(lmn_look_load(&look, "edges", &error));
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.samples = 1;
    desc.dpi = 144;
    desc.maps = true;
    for (int i = 0; i < 2; i++) {
        desc.draft = i == 1;
        DO(lmn_draw(&drawings[i], renderer, scene, look, &desc, &error));
        ids[i] = calloc(PIXELS, sizeof *ids[i]);
        edges[i] = calloc(PIXELS, 4 * sizeof *edges[i]);
        DO(lmn_drawing_copy_map(drawings[i], LMN_MAP_ID, ids[i], PIXELS, &error));
        DO(lmn_drawing_copy_map(drawings[i], LMN_MAP_EDGE, edges[i], 4 * PIXELS, &error));
    }
    assert_memory_equal(ids[0], ids[1], PIXELS * sizeof *ids[0]);
    for (int k = 0; k < PIXELS; k++) {
        for (int i = 0; i < 2; i++)
            lines[i] += edges[i][4 * k + 2] < 0.5f;
        alike += fabsf(edges[0][4 * k + 2] - edges[1][4 * k + 2]) < 0.01f;
    }
    assert_true(lines[0] > 100);
    assert_in_range(lines[1], lines[0] * 8 / 10, lines[0] * 12 / 10);
    assert_true(alike > PIXELS * 8 / 10);
    assert_true(alike < PIXELS); /* else it would cost what a whole picture does */
    for (int i = 0; i < 2; i++) {
        free(ids[i]);
        free(edges[i]);
        lmn_drawing_destroy(&drawings[i]);
    }
    lmn_look_destroy(&look);
}

/* What is picked lies on the box's front, and is put where it was picked. */
static void picks(bool orthographic)
{
    lmn_drawing *d = draw(orthographic, true);
    int          found[3] = {0};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            lmn_pick p;
            double   pixel[2], depth;
            DO(lmn_drawing_pick(d, x, y, &p, &error));
            found[p.part]++;
            if (!p.part)
                continue;
            assert_true(lmn_drawing_project(d, p.position, pixel, &depth));
            assert_float_equal(pixel[0], (float)x + 0.5f, 1e-3);
            assert_float_equal(pixel[1], (float)y + 0.5f, 1e-3);
            assert_float_equal(depth, p.depth, 1e-3);
            bool left = p.position[0] < 0;
            assert_int_equal(p.part, left ? left_part : right_part);
            if (p.normal[2] < 0.5) /* a side, seen in perspective */
                continue;
            assert_float_equal(p.position[2], 1, 1e-3);
            assert_float_equal(p.normal[2], 1, 1e-3);
            assert_true(p.position[1] > -1e-3 && p.position[1] < 1 + 1e-3);
        }
    assert_true(found[0] > 500 && found[1] > 500 && found[2] > 500);
    lmn_drawing_destroy(&d);
}

static void picks_in_perspective(void **state)
{
    (void)state;
    picks(false);
}

static void picks_by_parallel_rays(void **state)
{
    (void)state;
    picks(true);
}

static void rectangles(void **state)
{
    (void)state;
    lmn_drawing *d = draw(true, true);
    uint32_t     parts[2] = {9, 9};
    size_t       count = 9;
    DO(lmn_drawing_pick_parts(d, -5, -5, 500, 500, parts, 2, &count, &error));
    assert_int_equal(count, 2);
    assert_int_equal(parts[0], 1);
    assert_int_equal(parts[1], 2);
    DO(lmn_drawing_pick_parts(d, WIDTH / 2 + 5, 0, 500, 500, parts, 1, &count, &error));
    assert_int_equal(count, 1);
    assert_int_equal(parts[0], right_part);
    DO(lmn_drawing_pick_parts(d, 0, 0, 500, 500, NULL, 0, &count, &error));
    assert_int_equal(count, 2);
    DO(lmn_drawing_pick_parts(d, 0, 0, 0, -3, NULL, 0, &count, &error));
    assert_int_equal(count, 0);
    DO(lmn_drawing_pick_parts(d, 2147483647, 0, 2147483647, 9, NULL, 0, &count, &error));
    assert_int_equal(count, 0);
    lmn_drawing_destroy(&d);
}

/* The same numbers as in the file, whose rows run upwards. */
static void maps_are_those_of_files(void **state)
{
    (void)state;
    static float    depth[PIXELS], read[PIXELS];
    static uint32_t id[PIXELS];
    char            line[64];
    int             width = 0, height = 0;
    lmn_drawing    *d = draw(false, true);
    DO(lmn_drawing_write_maps(d, "maps_test_maps", &error));
    DO(lmn_drawing_copy_map(d, LMN_MAP_DEPTH, depth, PIXELS, &error));
    DO(lmn_drawing_copy_map(d, LMN_MAP_ID, id, PIXELS, &error));
    FILE *file = fopen("maps_test_maps/depth.pfm", "rb");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(fscanf(file, "%d %d\n", &width, &height), 2);
    assert_int_equal(width, WIDTH);
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(fread(read, sizeof *read, PIXELS, file), PIXELS);
    fclose(file);
    for (int y = 0; y < HEIGHT; y++)
        assert_memory_equal(&depth[y * WIDTH], &read[(HEIGHT - 1 - y) * WIDTH], WIDTH * sizeof(float));
    for (int i = 0; i < PIXELS; i++)
        assert_int_equal(id[i] != 0, isfinite(depth[i]) != 0);
    lmn_drawing_destroy(&d);
}

static void the_camera(void **state)
{
    (void)state;
    double view[16], projection[16], clip[4] = {0}, eye[4] = {0}, pixel[2], point[4] = {0.3, 0.9, 0.7, 1}, back[3],
                                     depth;
    lmn_drawing *d = draw(false, false);
    lmn_drawing_camera(d, view, projection);
    for (int r = 0; r < 4; r++)
        for (int k = 0; k < 4; k++)
            eye[r] += view[4 * k + r] * point[k];
    for (int r = 0; r < 4; r++)
        for (int k = 0; k < 4; k++)
            clip[r] += projection[4 * k + r] * eye[k];
    assert_true(lmn_drawing_project(d, point, pixel, &depth));
    assert_true(fabs(pixel[0] - WIDTH * (0.5 + 0.5 * clip[0] / clip[3])) < 1e-9);
    assert_true(fabs(pixel[1] - HEIGHT * (0.5 - 0.5 * clip[1] / clip[3])) < 1e-9);
    lmn_drawing_unproject(d, pixel, depth, back);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(back[k] - point[k]) < 1e-9);
    assert_false(lmn_drawing_project(d, (double[]){0, 0, 1000}, pixel, NULL));
    lmn_drawing_destroy(&d);
}

static void refused(void **state)
{
    (void)state;
    static float numbers[3 * PIXELS];
    lmn_pick     p;
    size_t       count;
    lmn_drawing *without = draw(false, false), *with = draw(false, true);
    assert_int_equal(lmn_drawing_pick(without, 0, 0, &p, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_pick(NULL, 0, 0, &p, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_pick(with, 0, 0, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_pick_parts(with, 0, 0, 1, 1, NULL, 1, &count, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_pick_parts(with, 0, 0, 1, 1, NULL, 0, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_copy_map(with, LMN_MAP_NORMAL, numbers, PIXELS, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_copy_map(with, LMN_MAP_DEPTH, NULL, PIXELS, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_copy_map(with, (lmn_map)99, numbers, PIXELS, &error), LMN_USAGE);
    assert_int_equal(lmn_drawing_copy_map(with, LMN_MAP_VELOCITY, numbers, 3 * PIXELS, &error), LMN_USAGE);
    assert_int_equal(lmn_map_components((lmn_map)-1), 0);
    DO(lmn_drawing_pick(with, -1, HEIGHT, &p, &error));
    assert_int_equal(p.part, 0);
    lmn_drawing_destroy(&without);
    lmn_drawing_destroy(&with);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(drafts_have_the_same_lines),
                                       cmocka_unit_test(picks_in_perspective),
                                       cmocka_unit_test(picks_by_parallel_rays),
                                       cmocka_unit_test(rectangles),
                                       cmocka_unit_test(maps_are_those_of_files),
                                       cmocka_unit_test(the_camera),
                                       cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
