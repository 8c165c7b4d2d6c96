/* Windows: what lmn_draw draws of a part of a picture is what the whole picture has there, to the bit, in every look
 * that ships; and tiles of them make the whole. Arguments: looks (default: all), for a closer look at some. */
#include "checked.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 1000 };

static lmn_renderer *renderer;
static lmn_scene    *scene;

static int set_up(void **state)
{
    (void)state;
    DO(lmn_renderer_create(&renderer, NULL, &error));
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, EXAMPLES "/house.glb", NULL, &error));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
    return 0;
}

static lmn_draw_desc page_desc(void)
{
    lmn_draw_desc d = LMN_DRAW_DESC_INIT;
    d.width = d.height = SIDE;
    d.samples = 1;
    return d;
}

static size_t count_differences(const lmn_drawing *whole, const lmn_drawing *part, const int window[4])
{
    int            width, height;
    const uint8_t *page = lmn_drawing_pixels(whole, NULL, NULL), *pixels = lmn_drawing_pixels(part, &width, &height);
    size_t         count = 0;
    assert_int_equal(width, window[2]);
    assert_int_equal(height, window[3]);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            count += memcmp(page + 4 * ((window[1] + y) * SIDE + window[0] + x), pixels + 4 * (y * width + x), 4) != 0;
    return count;
}

static size_t compare(const lmn_look *look, const lmn_draw_desc *desc, const int (*windows)[4], size_t count)
{
    size_t       wrong = 0;
    lmn_drawing *whole = NULL;
    DO(lmn_draw(&whole, renderer, scene, look, desc, &error));
    for (size_t i = 0; i < count; i++) {
        lmn_draw_desc d = *desc;
        lmn_drawing  *part = NULL;
        memcpy(d.window, windows[i], sizeof d.window);
        DO(lmn_draw(&part, renderer, scene, look, &d, &error));
        wrong += count_differences(whole, part, windows[i]);
        lmn_drawing_destroy(&part);
    }
    lmn_drawing_destroy(&whole);
    return wrong;
}

/* In the middle of the model, across its outline at the rim of the page, one pixel. */
static const int places[][4] = {{431, 475, 100, 80}, {0, 600, 103, 84}, {501, 500, 1, 1}};

/* Near by, edges run all through the page: what decides about one in the window lies far beside it. */
static void edges_are_judged_whole(void **state)
{
    static const char *const looks[] = {"edges", "line", "ink"};
    static const int         near[][4] = {{200, 300, 64, 64}, {900, 850, 64, 64}};
    (void)state;
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        lmn_look     *look = NULL;
        lmn_draw_desc desc = page_desc();
        desc.fit = 4;
        DO(lmn_look_load(&look, looks[i], &error));
        assert_int_equal(compare(look, &desc, near, 2), 0);
        lmn_look_destroy(&look);
    }
}

/* Samples of pixels, an odd size, solids, and what moves. */
static void others_have_windows(void **state)
{
    static const struct {
        const char *file, *look, *set, *value;
        int         samples;
        double      time, fit;
    } rows[] = {
        {"house.glb", "sketch", NULL, NULL, 4, 0},
        {"csg/valve.csg", "xray", NULL, NULL, 1, 0},
        {"house.glb", "plain", "scene.occlusion", "0.8", 1, 0},
        {"house.glb", "technical", "lines.dash", "4", 1, 0},
        {"box-animated.glb", "edges", "motion.technique", "blur", 1, 0.5},
        {"town.geojson", "city", NULL, NULL, 1, 0, 0.15}, /* so small that lines crowd in some tiles */
    };
    static const int odd[][4] = {{333, 401, 97, 61}, {501, 470, 83, 66}};
    lmn_scene       *house = scene;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_look     *look = NULL;
        lmn_draw_desc desc = page_desc();
        char          path[512];
        snprintf(path, sizeof path, EXAMPLES "/%s", rows[i].file);
        desc.samples = rows[i].samples;
        desc.time_s = rows[i].time;
        desc.fit = rows[i].fit > 0 ? rows[i].fit : desc.fit;
        DO(lmn_scene_create(&scene, &error));
        DO(lmn_scene_add_file(scene, path, NULL, &error));
        DO(lmn_look_load(&look, rows[i].look, &error));
        if (rows[i].set)
            DO(lmn_look_set(look, rows[i].set, rows[i].value, &error));
        size_t differences = compare(look, &desc, odd, 2);
        if (differences)
            fail_msg("%s, %s: %zu pixels differ", rows[i].file, rows[i].look, differences);
        lmn_look_destroy(&look);
        lmn_scene_destroy(&scene);
    }
    scene = house;
}

static void check_refused(const lmn_draw_desc *desc)
{
    lmn_look    *look = NULL;
    lmn_drawing *drawing = NULL;
    DO(lmn_look_load(&look, "plain", &error));
    assert_int_equal(lmn_draw(&drawing, renderer, scene, look, desc, &error), LMN_USAGE);
    assert_null(drawing);
    assert_non_null(strstr(error.message, "window"));
    lmn_look_destroy(&look);
}

static void wrong_windows_are_refused(void **state)
{
    static const int wrong[][4] = {{-1, 0, 5, 5},       {0, 0, 5, 0},        {0, 0, -5, 5},
                                   {SIDE - 4, 0, 5, 5}, {0, SIDE - 4, 5, 5}, {2147483647, 0, 5, 5}};
    lmn_draw_desc    desc = page_desc();
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        memcpy(desc.window, wrong[i], sizeof desc.window);
        check_refused(&desc);
    }
    memcpy(desc.window, (int[]){0, 0, 5, 5}, sizeof desc.window);
    desc.maps = true;
    check_refused(&desc);
}

static void parts_are_written(void **state)
{
    const int     inside[4] = {40, 30, 20, 10}, outside[4] = {40, 30, SIDE, 10};
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = page_desc();
    uint64_t      bytes = 0;
    (void)state;
    desc.width = desc.height = 100;
    DO(lmn_look_load(&look, "plain", &error));
    DO(lmn_draw(&drawing, renderer, scene, look, &desc, &error));
    DO(lmn_drawing_write_part(drawing, inside, "windows-part.png", NULL, &bytes, &error));
    assert_true(bytes > 0 && lmn_picture_is_whole("windows-part.png", 20, 10));
    assert_int_equal(lmn_drawing_write_part(drawing, outside, "windows-part.png", NULL, NULL, &error), LMN_USAGE);
    remove("windows-part.png");
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
}

static void looks_have_windows(void **state)
{
    size_t       wrong = 0;
    const char **chosen = *state;
    for (size_t i = 0; chosen ? chosen[i] != NULL : i < lmn_look_count(); i++) {
        lmn_look     *look = NULL;
        lmn_draw_desc desc = page_desc();
        const char   *name = chosen ? chosen[i] : lmn_look_name_at(i);
        DO(lmn_look_load(&look, name, &error));
        size_t differences = compare(look, &desc, places, sizeof places / sizeof *places);
        if (differences)
            print_message("%s: %zu pixels differ\n", name, differences);
        wrong += differences;
        lmn_look_destroy(&look);
    }
    assert_int_equal(wrong, 0);
}

int main(int count, char **arguments)
{
    const char            **chosen = count > 1 ? (const char **)arguments + 1 : NULL;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(looks_have_windows, chosen),
        cmocka_unit_test(edges_are_judged_whole),
        cmocka_unit_test(others_have_windows),
        cmocka_unit_test(wrong_windows_are_refused),
        cmocka_unit_test(parts_are_written),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
