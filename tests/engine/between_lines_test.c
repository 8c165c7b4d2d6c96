/* surface.solid of engraved lines: from that darkness on there is no paper between them, below it there is. */
#include "checked.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 128 };

static lmn_renderer *renderer;
static lmn_scene    *scene;

static int set_up(void **state)
{
    (void)state;
    DO(lmn_renderer_create(&renderer, NULL, &error));
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, EXAMPLES "/spot.obj", NULL, &error));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
    return 0;
}

/* Fraction of the figure that is ink, where all of it has this tone: blue ink on red paper. Few lines only, thin ones,
 * and none so faint: what is inked is between them. */
static double inked(double tone, double solid)
{
    char          text[640];
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *drawing = NULL;
    lmn_look     *look = NULL;
    double        ink = 0, all = 0;
    snprintf(
        text, sizeof text,
        "{\"version\": 2, \"finish\": {\"ground\": \"#00ff00\"}, \"rules\": [{\"surface\": {\"technique\": \"lines\", "
        "\"count\": 1, \"least\": 0.5, \"widest\": 0.2, \"series\": 1, \"shadow\": %g, \"light\": %g, \"texture\": 0, "
        "\"ink\": "
        "\"#0000ff\", "
        "\"paper\": \"#ff0000\", \"solid\": %g}}]}",
        tone, tone, solid);
    DO(lmn_look_parse(&look, text, "between lines", &error));
    desc.width = desc.height = SIDE;
    DO(lmn_draw(&drawing, renderer, scene, look, &desc, &error));
    const uint8_t *pixels = lmn_drawing_pixels(drawing, NULL, NULL);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (pixels[4 * i + 1] == 0) {
            ink += pixels[4 * i + 2] / 255.0;
            all += 1;
        }
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    assert_true(all > 1000);
    return ink / all;
}

static void dark_is_inked_whole(void **state)
{
    (void)state;
    assert_true(inked(0.3, 0) < 0.5); /* never, unless a look asks for it */
    assert_true(inked(0.3, 0.6) > 0.999);
    assert_true(inked(0.5, 0.6) < 0.3);
    assert_true(inked(0.5, 0.4) > 0.999);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(dark_is_inked_whole)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
