/* Figures whose lines look at each other's surfaces share one geometry pass: each part is drawn once, however many
 * rules there are, and every pixel has the colour of the rule whose part is in front. Ghost images of one thing have
 * one set of edges. */
#include "checked.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "depict/depict.h"
#include "stroke/stroke.h"

enum { SIDE = 120, BOXES = 3 };

/* Each box is 2 wide and high, 1 to the right of and 2 before the one on its left. */
static const char script[] = "{\"limner_script\": 1, \"nodes\": ["
                             "{\"name\": \"a\", \"box\": {\"size\": [2, 2, 1]}, \"translation\": [-1, 0, -2]},"
                             "{\"name\": \"b\", \"box\": {\"size\": [2, 2, 1]}, \"translation\": [0, 0, 0]},"
                             "{\"name\": \"c\", \"box\": {\"size\": [2, 2, 1]}, \"translation\": [1, 0, 2]}],"
                             "\"behaviour\": {\"target\": \"b\", \"linear\": [[0, 0, 0], [0, 8, 0]], \"duration\": 2}}";

#define RULE(SELECT, COLOUR, LINES)                                                                                    \
    "{\"select\": \"" SELECT "\", \"surface\": {\"technique\": \"flat\", \"colour\": \"" COLOUR                        \
    "\", \"model_colour\": 0}, \"lines\": {" LINES ", \"colour\": \"#000000\", \"width\": 0.75}}"
#define LOOK(LINES)                                                                                                    \
    "{\"version\": 2, \"name\": \"test\", \"rules\": [" RULE("*", "#ff0000", LINES) "," RULE(                          \
        "b", "#00ff00", LINES) "," RULE("c", "#0000ff", LINES) "]}"

static lmn_scene *load(void)
{
    char       path[64];
    lmn_scene *scene = NULL;
    snprintf(path, sizeof path, "/tmp/limner-together-XXXXXX.json");
    const int fd = mkstemps(path, 5);
    assert_true(fd >= 0);
    FILE *file = fdopen(fd, "w");
    assert_non_null(file);
    fputs(script, file);
    fclose(file);
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, path, NULL, &error));
    unlink(path);
    return scene;
}

/* How many draws the geometry took. */
static int geometry_draws(const lmn_drawing *drawing)
{
    char   *text = lmn_drawing_report_json(drawing);
    json_t *root = json_loads(text, 0, NULL);
    int     draws = -1;
    size_t  i;
    json_t *pass;
    json_array_foreach(json_object_get(root, "passes"), i, pass)
    {
        if (strcmp(json_string_value(json_object_get(pass, "name")), "geometry") == 0)
            draws = (int)json_integer_value(json_object_get(pass, "draws"));
    }
    json_decref(root);
    lmn_text_free(text);
    return draws;
}

static void each_part_is_drawn_once(void **state)
{
    static const char *const looks[] = {LOOK("\"operator\": \"strokes\", \"visibility\": \"exact\""),
                                        LOOK("\"operator\": \"strokes\", \"visibility\": \"sampled\""),
                                        LOOK("\"operator\": \"discontinuity\"")};
    lmn_renderer            *renderer = NULL;
    lmn_scene               *scene = load();
    (void)state;
    DO(lmn_renderer_create(&renderer, NULL, &error));
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        lmn_look     *look = NULL;
        lmn_drawing  *drawing = NULL;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        DO(lmn_look_parse(&look, looks[i], "test", &error));
        desc.width = desc.height = SIDE;
        desc.samples = 1;
        desc.profile = true;
        desc.view = LMN_VIEW_FRONT;
        desc.orthographic = true;
        desc.fit = 0.5; /* four units are half the page wide */
        DO(lmn_draw(&drawing, renderer, scene, look, &desc, &error));
        const uint8_t *pixels = lmn_drawing_pixels(drawing, NULL, NULL);
        for (int box = 0; box < BOXES; box++) { /* what is seen of each, between its lines: half a unit of it */
            const int      x = SIDE / 2 + (int)((box == 2 ? 1 : -1.5 + box) * SIDE / 8);
            const uint8_t *p = &pixels[4 * (SIDE / 2 * SIDE + x)];
            for (int k = 0; k < 3; k++)
                if (p[k] != (k == box ? 255 : 0))
                    fail_msg("look %zu, box %d: %d %d %d", i, box, p[0], p[1], p[2]);
        }
        assert_int_equal(geometry_draws(drawing), BOXES);
        lmn_drawing_destroy(&drawing);
        lmn_look_destroy(&look);
    }
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
}

static void ghosts_share_their_edges(void **state)
{
    lmn_scene      *scene = load();
    lmn_draw_desc   draw = LMN_DRAW_DESC_INIT;
    lmn_depict_desc told = LMN_DEPICT_DESC_INIT;
    pose            posed;
    stroke_scene    strokes;
    moment          when = {.clip_count = 0};
    (void)state;
    draw.time_given = true;
    draw.time_s = 1;
    told.expressions = "[{\"target\": \"b\", \"depict\": \"still\", \"count\": 4}]";
    DO(lmn_depict(scene, &draw, &told, NULL, &error));
    DO(pose_create(&posed, scene, &when, &error));
    DO(stroke_scene_create(&strokes, &posed, NULL, 0.5, NULL, NULL, &error));
    assert_int_equal(strokes.item_count, 2 + 1 + 4); /* with the target itself, which is hidden */
    assert_int_equal(strokes.mesh_count, 2 + 1 + 1);
    stroke_scene_release(&strokes);
    pose_release(&posed);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_part_is_drawn_once),
                                       cmocka_unit_test(ghosts_share_their_edges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
