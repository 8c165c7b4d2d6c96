/* Does a picture fill as much of its frame as it was told to, whatever the model's shape: seen in the drawing itself.
 */
#include <limner/limner.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { SIDE = 400, PIXELS_OFF = 2 };

static lmn_error error;

static void good(lmn_status status, const char *what)
{
    if (status != LMN_OK) {
        check_that("FIT", false, "%s: %s %s", what, error.message, error.hint);
        exit(1);
    }
}

#define DO(call) good((call), #call)

static lmn_renderer *renderer(void)
{
    static lmn_renderer *made;
    lmn_renderer_desc    desc = LMN_RENDERER_DESC_INIT;
    if (!made)
        DO(lmn_renderer_create(&made, &desc, &error));
    return made;
}

static const lmn_look *flat(void)
{
    static lmn_look *made;
    if (!made)
        DO(lmn_look_parse(&made, "{\"version\":1,\"rules\":[{\"select\":\"*\",\"surface\":\"flat\"}]}", "flat",
                          &error));
    return made;
}

/* The same, and a shadow on the ground as dense as what throws it. */
static lmn_look *shadowed(const char *light_direction)
{
    char      text[512];
    lmn_look *made = NULL;
    snprintf(text, sizeof text,
             "{\"version\":1,\"scene\":{\"ground\":\"cast\",\"ground_strength\":1,\"light_direction\":%s},"
             "\"rules\":[{\"select\":\"*\",\"surface\":\"flat\"}]}",
             light_direction);
    DO(lmn_look_parse(&made, text, "shadowed", &error));
    return made;
}

/* What is drawn, pixels: from the left, to the right, from the top, to the bottom. False: nothing is. */
static bool find_drawn_as(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, int box[4])
{
    lmn_drawing *drawing = NULL;
    int          width, height;
    DO(lmn_draw(&drawing, renderer(), scene, look, desc, &error));
    const uint8_t *pixels = lmn_drawing_pixels(drawing, &width, &height);
    box[0] = width;
    box[2] = height;
    box[1] = box[3] = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (pixels[4 * (y * width + x) + 3] > 127) {
                box[0] = x < box[0] ? x : box[0];
                box[1] = x + 1 > box[1] ? x + 1 : box[1];
                box[2] = y < box[2] ? y : box[2];
                box[3] = y + 1 > box[3] ? y + 1 : box[3];
            }
    lmn_drawing_destroy(&drawing);
    return box[1] > box[0];
}

static bool find_drawn(const lmn_scene *scene, const lmn_draw_desc *desc, int box[4])
{
    return find_drawn_as(scene, flat(), desc, box);
}

/* The wider side fills its fraction, and nothing lies beside the middle. Returns how many pixels it is off at most. */
static double misfit_as(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc)
{
    int box[4];
    if (!find_drawn_as(scene, look, desc, box))
        return INFINITY;
    double wide = box[1] - box[0] - desc->fit * desc->width, high = box[3] - box[2] - desc->fit * desc->height;
    double off = fabs(fmax(wide, high));
    off = fmax(off, abs(box[0] - (desc->width - box[1])));
    return fmax(off, abs(box[2] - (desc->height - box[3])));
}

static double misfit(const lmn_scene *scene, const lmn_draw_desc *desc)
{
    return misfit_as(scene, flat(), desc);
}

static lmn_scene *load(const char *name)
{
    char       path[512];
    lmn_scene *scene = NULL;
    snprintf(path, sizeof path, "%s/%s", LIMNER_EXAMPLES, name);
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, path, NULL, &error));
    return scene;
}

static lmn_draw_desc describe(int width, int height)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = width;
    desc.height = height;
    desc.background = "none";
    desc.samples = 1;
    return desc;
}

static void models_fill_the_frame(void)
{
    static const char *const models[] = {"pump.glb", "gearbox.stl", "house.glb", "buggy.glb", "box.glb"};
    static const int         sizes[3][2] = {{SIDE, SIDE}, {SIDE, SIDE / 2}, {SIDE / 2, SIDE}};
    for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
        lmn_scene *scene = load(models[m]);
        double     worst = 0;
        int        pictures = 0;
        for (int view = LMN_VIEW_ISO; view <= LMN_VIEW_BOTTOM; view++)
            for (int parallel = 0; parallel < 2; parallel++) {
                const int    *size = sizes[pictures++ % 3];
                lmn_draw_desc desc = describe(size[0], size[1]);
                desc.view = (lmn_view)view;
                desc.orthographic = parallel;
                desc.fit = pictures % 2 ? 0.9 : 0.6;
                worst = fmax(worst, misfit(scene, &desc));
            }
        check_at_most("FIT", worst, PIXELS_OFF, "%s: pixels that the picture's fill is off, in %d views", models[m],
                      pictures);
        lmn_scene_destroy(&scene);
    }
}

/* From any side, whatever the distance of the eye that was given. */
static void directions_fill_the_frame(void)
{
    lmn_scene *scene = load("gearbox.stl");
    double     worst = 0;
    for (int step = 0; step < 6; step++) {
        lmn_draw_desc desc = describe(SIDE, SIDE * 3 / 4);
        desc.eye_given = desc.fit_direction = true;
        desc.orthographic = step % 2;
        desc.eye[0] = cos(step) * 1000;
        desc.eye[1] = sin(step) * 1000;
        desc.eye[2] = 300 - 100 * step;
        desc.up[2] = 1;
        worst = fmax(worst, misfit(scene, &desc));
    }
    check_at_most("FIT", worst, PIXELS_OFF, "the gearbox from six sides: pixels off");
    lmn_scene_destroy(&scene);
}

/* Vertices are where joints put them. */
static void postures_fill_the_frame(void)
{
    lmn_scene *scene = load("fox.glb");
    double     worst = 0;
    for (int step = 0; step < 4; step++) {
        lmn_draw_desc desc = describe(SIDE, SIDE);
        desc.time_given = true;
        desc.clip = "Run";
        desc.time_s = 0.2 * step;
        desc.fit = 0.95;
        worst = fmax(worst, misfit(scene, &desc));
    }
    check_at_most("FIT", worst, PIXELS_OFF, "the running fox: pixels off");
    /* At rest joints have put them elsewhere than the mesh has them, too. */
    lmn_draw_desc desc = describe(SIDE, SIDE);
    check_at_most("FIT", misfit(scene, &desc), PIXELS_OFF, "the fox at rest: pixels off");
    lmn_scene_destroy(&scene);
}

/* Parts that are chosen alone are what counts. */
static void selections_fill_the_frame(void)
{
    lmn_scene    *scene = load("pump.glb");
    lmn_draw_desc desc = describe(SIDE, SIDE);
    desc.select = "[id=3]";
    check_at_most("FIT", misfit(scene, &desc), PIXELS_OFF, "one part of the pump: pixels off");
    lmn_scene_destroy(&scene);
}

/* Pictures of all times of a clip are fitted alike, and hold it at each. */
static void all_times_are_held(void)
{
    lmn_scene *scene = load("fox.glb");
    int        box[4], outside = 0;
    for (int step = 0; step < 4; step++) {
        lmn_draw_desc desc = describe(SIDE, SIDE);
        desc.time_given = desc.fit_time = true;
        desc.clip = "Run";
        desc.time_s = 0.2 * step;
        desc.fit = 1;
        outside += !find_drawn(scene, &desc, box) || box[0] < 1 || box[2] < 1 || box[1] > SIDE - 1 || box[3] > SIDE - 1;
    }
    check_at_most("FIT", outside, 0, "times at which the fox touches the frame that holds all times");
    lmn_scene_destroy(&scene);
}

/* Solids and ghosts have no mesh: their boxes hold them. */
static void solids_lie_in_the_frame(void)
{
    lmn_scene    *scene = load("csg/widget.csg");
    lmn_draw_desc desc = describe(SIDE, SIDE);
    int           box[4];
    desc.fit = 1;
    check_that("FIT", find_drawn(scene, &desc, box) && box[0] >= 0 && box[1] <= SIDE && box[1] - box[0] > SIDE / 2,
               "a solid lies in the frame and fills more than half of it");
    lmn_scene_destroy(&scene);
}

/* A shadow on the ground is drawn, so it is fitted, with parallel rays and without, of light from either side. */
static void shadows_lie_in_the_frame(void)
{
    static const char *const models[] = {"box.glb", "house.glb"};
    static const char *const lights[] = {"[-0.5,0.85,0.42]", "[0.5,0.9,-0.1]"};
    for (int m = 0; m < 2; m++) {
        lmn_scene *scene = load(models[m]);
        double     worst = 0;
        for (int k = 0; k < 8; k++) {
            lmn_look     *look = shadowed(lights[k % 2]);
            lmn_draw_desc desc = describe(SIDE, k & 2 ? SIDE / 2 : SIDE);
            desc.orthographic = k & 4;
            worst = fmax(worst, misfit_as(scene, look, &desc));
            lmn_look_destroy(&look);
        }
        check_at_most("FIT", worst, PIXELS_OFF, "%s with its shadow: pixels off", models[m]);
        lmn_scene_destroy(&scene);
    }
}

/* The darkest of the page's border, 0 … 255, and how much of the page's height the figure's box takes. */
static int darkest_at_border(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc)
{
    lmn_drawing *drawing = NULL;
    int          width, height, darkest = 0;
    DO(lmn_draw(&drawing, renderer(), scene, look, desc, &error));
    const uint8_t *pixels = lmn_drawing_pixels(drawing, &width, &height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x += y == 0 || y == height - 1 ? 1 : width - 1)
            darkest = pixels[4 * (y * width + x) + 3] > darkest ? pixels[4 * (y * width + x) + 3] : darkest;
    lmn_drawing_destroy(&drawing);
    return darkest;
}

/* Where the ground is touched it is dark, and what can be seen of that is fitted, from above; what cannot, is not. */
static void touched_ground_lies_in_the_frame(void)
{
    static const char *const models[] = {"box.glb", "house.glb"};
    lmn_look                *look = NULL;
    DO(lmn_look_parse(
        &look,
        "{\"version\":1,\"scene\":{\"ground\":\"contact\",\"ground_strength\":1,\"ground_colour\":\"#000000\"},"
        "\"rules\":[{\"select\":\"*\",\"surface\":\"flat\"}]}",
        "touched", &error));
    for (int m = 0; m < 2; m++) {
        lmn_scene *scene = load(models[m]);
        int        worst = 0, box[2][4];
        for (int k = 0; k < 4; k++) {
            lmn_draw_desc desc = describe(SIDE, k & 2 ? SIDE / 2 : SIDE);
            desc.orthographic = k & 1;
            desc.fit = 0.97;
            int darkest = darkest_at_border(scene, look, &desc);
            worst = darkest > worst ? darkest : worst;
        }
        check_at_most("FIT", worst, 26, "%s on the ground: darkest of the page's border, of 255", models[m]);
        lmn_draw_desc desc = describe(SIDE, SIDE);
        desc.view = LMN_VIEW_FRONT; /* along the ground */
        check_that("FIT",
                   find_drawn_as(scene, look, &desc, box[0]) && find_drawn(scene, &desc, box[1]) &&
                       memcmp(box[0], box[1], sizeof box[0]) == 0,
                   "%s seen along the ground is as large as without", models[m]);
        lmn_scene_destroy(&scene);
    }
    lmn_look_destroy(&look);
}

/* A low light's shadow would leave little room for the figure: it runs out of the frame instead. */
static void low_light_leaves_room(void)
{
    lmn_scene    *scene = load("box.glb");
    lmn_draw_desc desc = describe(SIDE, SIDE);
    lmn_look     *look = shadowed("[-1,0.2,0.1]");
    int           box[4];
    desc.samples = 1;
    bool drawn = find_drawn_as(scene, look, &desc, box);
    check_that("FIT", drawn && (box[0] == 0) != (box[1] == SIDE), "a long shadow leaves the frame on one side");
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"models", models_fill_the_frame},
                                       {"directions", directions_fill_the_frame},
                                       {"postures", postures_fill_the_frame},
                                       {"selections", selections_fill_the_frame},
                                       {"times", all_times_are_held},
                                       {"solids", solids_lie_in_the_frame},
                                       {"shadows", shadows_lie_in_the_frame},
                                       {"low light", low_light_leaves_room},
                                       {"touched", touched_ground_lies_in_the_frame}};
    return check_main(argc, argv, "fit", cases, sizeof cases / sizeof *cases);
}
