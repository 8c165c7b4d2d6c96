/* Windows: what lmn_draw draws of a part of a picture is what the whole picture has there, to the bit, in every look
 * that ships; and tiles of them make the whole. Arguments: looks (default: all), for a closer look at some. */
#include "checked.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 1200 };

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

/* In the middle of the model, across its outline, in a corner of the page, one pixel. */
static const int places[][4] = {{531, 575, 160, 120}, {0, 700, 203, 144}, {1072, 0, 128, 128}, {601, 600, 1, 1}};

static void looks_have_windows(void **state)
{
    size_t       wrong = 0;
    const char **chosen = *state;
    for (size_t i = 0; chosen ? chosen[i] != NULL : lmn_look_name_at(i) != NULL; i++) {
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
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
