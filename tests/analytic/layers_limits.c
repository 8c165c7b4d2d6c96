/* Layers at the edges of what can be asked for: values that are refused, nothing to draw, views from within, little
 * memory. */
#include <limner/limner.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "model.h"
#include "scenes.h"
#include "stack.h"

#define LOOK(RULES) "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ece4d2\"},\"rules\":[" RULES "]}"
#define OWN_COLOUR  "\"surface\":{\"technique\":\"flat\",\"model_colour\":1}"
#define ALL_LAYERS  "\"layers\":{\"technique\":\"peel\",\"count\":0}"
#define LINES       "\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#000000\"}"

static const uint8_t ground[3] = {0xec, 0xe4, 0xd2};

static const shot_view iso = {.width = 160, .height = 128, .eye = {4, 3, 5}, .up = {0, 1, 0}};

static void refuse(const char *key, const char *value)
{
    lmn_error  error = {0};
    lmn_look  *look = NULL;
    lmn_status status = lmn_look_parse(
        &look, LOOK("{\"select\":\"*\"," OWN_COLOUR "," ALL_LAYERS ",\"compose\":\"xray\"}"), "look", &error);
    check_that("bad", status == LMN_OK, "a layered look is read: %s", error.message);
    if (status == LMN_OK) {
        status = lmn_look_set(look, key, value, &error);
        check_that("bad", status == LMN_USAGE && error.message[0], "%s = %s is refused: %s", key, value, error.message);
    }
    lmn_look_destroy(&look);
}

static void refuse_file(const char *layers, const char *compose)
{
    char      text[512];
    lmn_error error = {0};
    lmn_look *look = NULL;
    snprintf(text, sizeof text, LOOK("{\"select\":\"*\",\"surface\":\"flat\",\"layers\":%s,\"compose\":%s}"), layers,
             compose);
    lmn_status status = lmn_look_parse(&look, text, "look", &error);
    check_that("bad", status == LMN_FORMAT && error.line > 0, "layers %s with %s are refused with their line: %s",
               layers, compose, error.message);
    lmn_look_destroy(&look);
}

static void bad_values(void)
{
    static const char *const values[][2] = {
        {"layers.count", "-1"},       {"layers.count", "10000"},      {"layers.count", "257"},
        {"layers.count", "2.5"},      {"layers.count", "many"},       {"layers.fraction", "-0.1"},
        {"layers.fraction", "1.5"},   {"layers.fraction", "nan"},     {"layers.focus_fraction", "2"},
        {"layers.producer", "magic"}, {"compose.opacity", "1.01"},    {"compose.opacity", "-1"},
        {"compose.fade", "2"},        {"compose.halo", "-1px"},       {"compose.hidden_gap", "-3px"},
        {"compose.tint", "#ff0000"},  {"compose.technique", "xrays"}, {"layers.technique", "peeled"}};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        refuse(values[i][0], values[i][1]);
    refuse_file("{\"technique\":\"peel\",\"count\":-1}", "\"xray\"");
    refuse_file("{\"technique\":\"peel\",\"count\":10000}", "\"xray\"");
    refuse_file("{\"technique\":\"peel\",\"fraction\":\"all\"}", "\"xray\"");
    refuse_file("\"peel\"", "{\"technique\":\"wire\",\"threshold\":3}");
    refuse_file("\"peel\"", "{\"technique\":\"xray\",\"tint\":\"#ff0000\"}");
}

static lmn_status draw_text(const char *model, const char *look_text, lmn_error *error)
{
    lmn_scene        *scene = NULL;
    lmn_look         *look = NULL;
    lmn_renderer     *renderer = NULL;
    lmn_drawing      *drawing = NULL;
    lmn_renderer_desc how = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 64;
    desc.dpi = 96;
    lmn_status status = lmn_scene_create(&scene, error);
    if (status == LMN_OK && model)
        status = lmn_scene_add_file(scene, model, NULL, error);
    if (status == LMN_OK)
        status = lmn_look_parse(&look, look_text, "look", error);
    if (status == LMN_OK)
        status = lmn_renderer_create(&renderer, &how, error);
    if (status == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, error);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&renderer);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    return status;
}

static void nothing_and_nonsense(void)
{
    static const char plain_xray[] = LOOK("{\"select\":\"*\"," OWN_COLOUR "," ALL_LAYERS ",\"compose\":\"xray\"}");
    lmn_error         error = {0};
    shape             s = {0};
    shot              drawing;
    lmn_status        status = draw_text(NULL, plain_xray, &error);
    check_that("bad", status == LMN_FORMAT, "an empty scene has nothing to draw: %s", error.message);
    shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    model_write_glb(check_path("one.glb"), &s);
    error = (lmn_error){0};
    status = draw_text(check_path("one.glb"),
                       LOOK("{\"select\":\"*\"," OWN_COLOUR
                            ",\"layers\":{\"technique\":\"peel\",\"focus\":\"[id\"},\"compose\":\"xray\"}"),
                       &error);
    check_that("bad", status == LMN_USAGE || status == LMN_FORMAT, "a focus that is no selector is refused: %s",
               error.message);
    error = (lmn_error){0};
    status = draw_text(check_path("one.glb"),
                       LOOK("{\"select\":\"*\"," OWN_COLOUR
                            ",\"layers\":{\"technique\":\"peel\",\"focus\":\"nobody\"},\"compose\":\"xray\"}"),
                       &error);
    check_note("a focus that matches no part: status %d %s", (int)status, error.message);
    if (shot_of_shape(&drawing, &s, "one.glb",
                      LOOK("{\"select\":\"other\"," OWN_COLOUR "," ALL_LAYERS ",\"compose\":\"xray\"}"), NULL, &iso)) {
        int wrong = 0;
        for (int i = 0; i < drawing.width * drawing.height; i++)
            wrong += memcmp(&drawing.picture[4 * i], ground, 3) != 0;
        check_at_most("bad", wrong, 0, "pixels that are not ground when a layered rule selects nothing");
        check_note("the report says %d layers", drawing.layers_drawn);
    }
    shot_release(&drawing);
    shape_release(&s);
}

/* From within, what lies behind the viewer is no layer. */
static void from_inside(void)
{
    static const char look[] =
        LOOK("{\"select\":\"*\"," OWN_COLOUR ",\"layers\":{\"technique\":\"peel\",\"count\":0,\"producer\":\"%s\"},"
             "\"compose\":{\"technique\":\"xray\",\"opacity\":0.3}}");
    for (int p = 0; p < 2; p++)
        for (int v = 0; v < 2; v++) {
            char            text[512];
            const shot_view view = {.width = 144,
                                    .height = 128,
                                    .eye = v ? dvec_of(0.05, 0.1, 0.02) : dvec_of(0.3, 0.4, 0.6),
                                    .target = {-1, -0.2, -1},
                                    .up = {0, 1, 0},
                                    .fov_deg = 60};
            shape           s = {0};
            shot            drawing;
            snprintf(text, sizeof text, look, p ? "lists" : "peeling");
            scene_make(&s, v ? SCENE_CROSSING : SCENE_CLOSED, 35);
            shape_sphere(&s, "around", dvec_of(0, 0, 0), 1.9, 32, 64, true);
            if (shot_of_shape(&drawing, &s, "inside.glb", text, NULL, &view)) {
                tracer   *rays = tracer_create(&s);
                stack_map map;
                stack_map_make(&map, rays, &drawing);
                stack_score score = stack_compare(&map, rays, &drawing, 0);
                if (!check_at_least(
                        "B01", (double)score.right_sharp / (double)score.sharp, 0.999,
                        "seen from within, %s: fraction of sure pixels with the right layers (of all: %.5f)",
                        drawing.layer_producer, (double)score.right / (double)score.pixels))
                    check_note("%zu count, %zu id, %zu depth, %zu normal, %zu holes; first %d, %d in layer %d",
                               score.wrong_count, score.wrong_id, score.wrong_depth, score.wrong_normal, score.holes,
                               score.x, score.y, score.layer);
                check_at_least("B01", (double)score.sharp, 0.9 * (double)score.pixels, "  sure pixels");
                stack_map_release(&map);
                tracer_destroy(rays);
            }
            shot_release(&drawing);
            shape_release(&s);
        }
}

static int differing_pixels(const shot *a, const shot *b, int levels)
{
    int count = 0;
    for (int i = 0; i < a->width * a->height; i++) {
        bool differs = false;
        for (int k = 4 * i; k < 4 * i + 4; k++)
            differs = differs || abs(a->picture[k] - b->picture[k]) > levels;
        count += differs;
    }
    return count;
}

/* With little memory lists are drawn in pieces; the picture does not show where. */
static void little_memory(void)
{
    static const char look[] =
        LOOK("{\"select\":\"*\"," OWN_COLOUR
             ",\"layers\":{\"technique\":\"peel\",\"count\":0,\"producer\":\"%s\",\"memory\":%d}," LINES
             ",\"compose\":{\"technique\":\"xray\",\"opacity\":0.3%s}}");
    static const char *const styles[] = {"", ",\"once\":false", ",\"halo\":3"};
    const shot_view view = {.width = 256, .height = 256, .eye = {4, 3, 5}, .up = {0, 1, 0}, .without_maps = true};
    for (int v = 0; v < 3; v++) {
        char  text[512];
        shape s = {0};
        shot  large = {0}, small = {0}, peeled = {0};
        scene_make(&s, SCENE_CROSSING, 36);
        snprintf(text, sizeof text, look, "lists", 128, styles[v]);
        bool ok = shot_of_shape(&large, &s, "memory.glb", text, NULL, &view);
        snprintf(text, sizeof text, look, "lists", 1, styles[v]);
        ok = shot_of_shape(&small, &s, "memory.glb", text, NULL, &view) && ok;
        snprintf(text, sizeof text, look, "peeling", 128, styles[v]);
        if (shot_of_shape(&peeled, &s, "memory.glb", text, NULL, &view) && ok) {
            check_note("128 MiB: %s; 1 MiB: %s%s", large.layer_producer, small.layer_producer,
                       shot_has_warning(&small, "layer-memory") ? ", with a warning" : "");
            check_that("memory", !shot_has_warning(&large, "layer-memory"),
                       "128 MiB are enough for a picture of 256 pixels");
            check_near("memory", small.layers_drawn, large.layers_drawn, 0, "layers with little memory");
            check_at_most("memory", differing_pixels(&large, &small, 1), 0,
                          "pixels that differ when lists have 1 MiB%s", styles[v]);
            check_at_most("B01", differing_pixels(&large, &peeled, 2) / (256.0 * 256.0), 0.001,
                          "fraction of pixels of the picture that differ between lists and peeling");
        }
        shot_release(&large);
        shot_release(&small);
        shot_release(&peeled);
        shape_release(&s);
    }
}

/* Whatever finds the lines and whatever is made of the layers, both producers give the same picture. */
static void every_operator(void)
{
    static const char *const operators[] = {"discontinuity", "four-tap", "sobel",  "saito",  "saito-normalised",
                                            "denormal",      "id",       "colour", "shadow", "shell"};
    static const char *const compositions[] = {"blueprint", "wire", "xray"}, *const producers[] = {"peeling", "lists"};
    shape s = {0};
    scene_make(&s, SCENE_CROSSING, 5);
    for (size_t o = 0; o < sizeof operators / sizeof *operators; o++)
        for (size_t c = 0; c < 3; c++) {
            shot   drawings[2];
            char   look[512];
            size_t off = 0, count = 4 * (size_t)iso.width * (size_t)iso.height;
            bool   drawn = true;
            for (int p = 0; p < 2; p++) {
                shot_view view = iso;
                view.without_maps = true;
                snprintf(look, sizeof look,
                         LOOK("{\"select\":\"*\"," OWN_COLOUR ",\"lines\":\"%s\",\"compose\":\"%s\","
                              "\"layers\":{\"technique\":\"peel\",\"count\":0,\"producer\":\"%s\"}}"),
                         operators[o], compositions[c], producers[p]);
                drawn = shot_of_shape(&drawings[p], &s, "operators.glb", look, NULL, &view) && drawn;
            }
            for (size_t i = 0; i < count && drawn; i++)
                off += abs(drawings[0].picture[i] - drawings[1].picture[i]) > 1;
            check_that("B01", drawn, "%s with %s is drawn", compositions[c], operators[o]);
            check_at_most("B01", (double)off, 0, "values that the producers give differently, %s with %s",
                          compositions[c], operators[o]);
            shot_release(&drawings[0]);
            shot_release(&drawings[1]);
        }
    shape_release(&s);
}

/* The borders of surfaces are where they are in the visible layer, too: facing and figure are no part of a
 * surface's name. */
static void borders_of_surfaces(void)
{
    static const char id[] = "\"lines\":{\"operator\":\"id\",\"of\":\"surface\"}";
    char              layered[512], front[512];
    shape             s = {0};
    shot              one, other;
    scene_make(&s, SCENE_OPEN, 3);
    snprintf(front, sizeof front, LOOK("{\"select\":\"*\"," OWN_COLOUR ",%s}"), id);
    snprintf(layered, sizeof layered,
             LOOK("{\"select\":\"*\"," OWN_COLOUR
                  ",%s,\"layers\":{\"technique\":\"peel\",\"count\":1},\"compose\":\"wire\"}"),
             id);
    bool ok = shot_of_shape(&one, &s, "surfaces.glb", front, NULL, &iso);
    if (shot_of_shape(&other, &s, "surfaces.glb", layered, NULL, &iso) && ok) {
        size_t off = 0, count = 4 * (size_t)iso.width * (size_t)iso.height;
        for (size_t i = 0; i < count; i++)
            off += one.edge[i] != other.edge[i];
        check_at_most("B02", (double)off, 0, "bytes of the edge map between surfaces that a layer has differently");
    }
    shot_release(&one);
    shot_release(&other);
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"bad", bad_values},       {"nothing", nothing_and_nonsense}, {"inside", from_inside},
        {"memory", little_memory}, {"operators", every_operator},     {"surfaces", borders_of_surfaces},
    };
    int status = check_main(argc, argv, "layers_limits", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
