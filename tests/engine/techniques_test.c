/* Surface techniques from outside of the library: against Limner's own with the same shader, by look files and by
 * calls, and what is wrong with them. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 80, HEIGHT = 60 };

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

/* The technique gooch of the library, under another name. */
static const char           gooch[] = "vec4 surface_colour(surface_point p)\n"
                                      "{\n"
                                      "    float tone = 0.5 * dot(p.normal, towards_light(0, p.eye)) + 0.5;\n"
                                      "    vec3 cool = min(u_cool.rgb + u_cool_fraction * p.albedo.rgb, vec3(1.0));\n"
                                      "    vec3 warm = min(u_warm.rgb + u_warm_fraction * p.albedo.rgb, vec3(1.0));\n"
                                      "    vec3 colour = mix(cool, warm, tone) + u_specular * highlight(p, u_shininess);\n"
                                      "    return vec4(shown(min(colour, vec3(1.0))), 1.0);\n"
                                      "}";
static const lmn_param_desc gooch_params[] = {
    {.key = "cool", .type = LMN_PARAM_COLOUR, .standard = "#5266a8", .as_light = true, .doc = "Cool."},
    {.key = "warm", .type = LMN_PARAM_COLOUR, .standard = "#ccb87a", .as_light = true},
    {.key = "cool_fraction", .type = LMN_PARAM_FLOAT, .standard = "0.2", .max = 1, .unit = LMN_UNIT_FRACTION},
    {.key = "warm_fraction", .type = LMN_PARAM_FLOAT, .standard = "0.35", .max = 1, .soft_max = 0.5},
    {.key = "specular", .type = LMN_PARAM_FLOAT, .standard = "0.6", .max = 1},
    {.key = "shininess", .type = LMN_PARAM_FLOAT, .standard = "32", .min = 1, .max = 1000, .logarithmic = true},
};

static lmn_technique_desc describe(const char *name, const char *glsl, const lmn_param_desc *params, size_t count)
{
    lmn_technique_desc desc = LMN_TECHNIQUE_DESC_INIT;
    desc.name = name;
    desc.glsl = glsl;
    desc.params = params;
    desc.param_count = count;
    return desc;
}

static lmn_techniques *make_set(const char *glsl)
{
    lmn_techniques    *set = NULL;
    lmn_technique_desc desc = describe("mine", glsl, gooch_params, 6);
    DO(lmn_techniques_create(&set, &error));
    desc.file = "mine.glsl";
    DO(lmn_techniques_add(set, &desc, &error));
    return set;
}

static lmn_look *open_look(const char *json, lmn_techniques *set)
{
    lmn_look     *look = NULL;
    lmn_look_desc desc = LMN_LOOK_DESC_INIT;
    desc.json = json;
    desc.techniques = set;
    DO(lmn_look_open(&look, &desc, &error));
    return look;
}

static lmn_status draw(lmn_drawing **out, const lmn_look *look)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    return lmn_draw(out, renderer, scene, look, &desc, &error);
}

static void draws_alike(const lmn_look *a, const lmn_look *b, bool alike)
{
    lmn_drawing *one = NULL, *other = NULL;
    DO(draw(&one, a));
    DO(draw(&other, b));
    assert_int_equal(
        !memcmp(lmn_drawing_pixels(one, NULL, NULL), lmn_drawing_pixels(other, NULL, NULL), WIDTH * HEIGHT * 4), alike);
    lmn_drawing_destroy(&one);
    lmn_drawing_destroy(&other);
}

/* Direct, with lines (shaded with the geometry or from the G-buffer), and in layers. */
static void draws_as_our_own(void **state)
{
    static const char *const rules[] = {
        "{\"version\":2,\"rules\":[{\"surface\":{\"technique\":\"%s\",\"shininess\":8}}]}",
        "{\"version\":2,\"rules\":[{\"surface\":\"%s\",\"lines\":\"sobel\"}]}",
        "{\"version\":2,\"scene\":{\"shadows\":true,\"occlusion\":0.5},\"rules\":[{\"surface\":\"%s\"}]}",
        "{\"version\":2,\"rules\":[{\"surface\":\"%s\",\"layers\":{\"technique\":\"front\",\"shading\":\"deferred\"}}"
        "]}",
    };
    (void)state;
    lmn_techniques *set = make_set(gooch);
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        char ours[300], theirs[300];
        snprintf(ours, sizeof ours, rules[i], "gooch");
        snprintf(theirs, sizeof theirs, rules[i], "mine");
        lmn_look *a = open_look(ours, NULL), *b = open_look(theirs, set);
        DO(lmn_look_set(a, "surface.cool", "#5266a8", &error));
        DO(lmn_look_set(a, "surface.warm", "#ccb87a", &error));
        DO(lmn_look_set(a, "surface.cool_fraction", "0.2", &error));
        DO(lmn_look_set(a, "surface.warm_fraction", "0.35", &error));
        draws_alike(a, b, true);
        DO(lmn_look_set_number(b, 0, "surface", 0, "cool_fraction", 0.9, &error));
        draws_alike(a, b, false);
        lmn_look_destroy(&a);
        lmn_look_destroy(&b);
    }
    lmn_techniques_destroy(&set);
}

/* The set's handle goes first; copies and text keep what they name. */
static void looks_know_it(void **state)
{
    (void)state;
    lmn_techniques *set = make_set(gooch);
    lmn_look       *look = open_look(NULL, set), *copy = NULL, *again = NULL;
    double          number = 0;
    DO(lmn_look_set_technique(look, 0, "surface", 0, "gooch", &error));
    DO(lmn_look_set_number(look, 0, "surface", 0, "specular", 0.25, &error));
    DO(lmn_look_set_technique(look, 0, "surface", 0, "mine", &error)); /* what both have stays */
    DO(lmn_look_get_number(look, 0, "surface", 0, "specular", &number, &error));
    assert_float_equal(number, 0.25, 0);
    assert_string_equal(lmn_look_technique(look, 0, "surface", 0), "mine");
    char *json = lmn_look_json(look);
    assert_non_null(strstr(json, "\"mine\""));
    again = open_look(json, set);
    lmn_text_free(json);
    DO(lmn_look_copy(&copy, look, &error));
    lmn_techniques_destroy(&set);
    lmn_look_destroy(&look);
    draws_alike(copy, again, true);
    uint64_t before = lmn_look_revision(copy);
    DO(lmn_look_set(copy, "surface.specular", "0.9", &error));
    assert_int_equal(lmn_look_changes(copy, before), LMN_CHANGE_VALUES); /* compiles nothing */
    draws_alike(copy, again, false);
    assert_int_equal(lmn_look_set(copy, "surface.specular", "2", &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "0 to 1"));
    assert_int_equal(lmn_look_set(copy, "surface.technique", "mime", &error), LMN_USAGE);
    assert_string_equal(error.hint, "did you mean 'mine'?");
    lmn_look_destroy(&copy);
    lmn_look_destroy(&again);
    look = open_look(NULL, NULL);
    assert_int_equal(lmn_look_set(look, "surface.technique", "mine", &error), LMN_USAGE);
    lmn_look_destroy(&look);
}

static void sets_are_listed(void **state)
{
    (void)state;
    lmn_technique_info info;
    lmn_param_info     param;
    lmn_techniques    *set = make_set(gooch);
    assert_true(lmn_techniques_at(set, 0, &info) && info.param_count == 6);
    assert_string_equal(info.name, "mine");
    assert_false(lmn_techniques_at(set, 1, &info));
    assert_true(lmn_techniques_param_at(set, "mine", 3, &param));
    assert_string_equal(param.key, "warm_fraction");
    assert_float_equal(param.default_number, 0.35f, 0);
    assert_true(param.max == 1 && param.soft_max == 0.5 && !param.compiles);
    assert_true(lmn_techniques_param_at(set, "mine", 0, &param));
    assert_string_equal(param.default_text, "#5266a8");
    assert_string_equal(param.doc, "Cool.");
    assert_false(lmn_techniques_param_at(set, "mine", 6, &param));
    assert_false(lmn_techniques_param_at(set, "gooch", 0, &param));
    lmn_techniques_destroy(&set);
}

/* A shader that the driver refuses: file and line of the caller's text, and the renderer draws on. */
static void refuses_by_the_driver(const char *glsl, int line, const char *word)
{
    lmn_techniques *set = make_set(glsl);
    lmn_look       *look = open_look("{\"version\":2,\"rules\":[{\"surface\":\"mine\"}]}", set), *good = NULL;
    lmn_drawing    *drawing = NULL;
    assert_int_equal(draw(&drawing, look), LMN_GL);
    assert_null(drawing);
    assert_string_equal(error.file, "mine.glsl");
    assert_int_equal(error.line, line);
    if (!strstr(error.message, word))
        fail_msg("'%s' does not say '%s'", error.message, word);
    DO(lmn_look_load(&good, "plain", &error));
    DO(draw(&drawing, good));
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&good);
    lmn_look_destroy(&look);
    lmn_techniques_destroy(&set);
}

static void names_lines(void **state)
{
    (void)state;
    refuses_by_the_driver("/* one\n two */\nvec4 surface_colour(surface_point p)\n{\n    return vec4(nothing);\n}\n", 5,
                          "nothing");
    refuses_by_the_driver("vec4 surface_colour(surface_point p)\n{\n    return vec4(1.0)\n}\n", 4, "syntax");
    refuses_by_the_driver("#if 0\nvec4 surface_colour(surface_point p)\n#endif\n", 0, "surface_colour");
    refuses_by_the_driver("vec4 surface_colour(surface_point p);\n", 0, "surface_colour");
}

/* --- what is refused at once ---------------------------------------------------------------------------- */

#define FUNCTION "vec4 surface_colour(surface_point p) { return vec4(1.0); }\n"

static lmn_status add(lmn_technique_desc desc)
{
    lmn_techniques    *set = make_set(gooch);
    lmn_technique_info info;
    memset(&error, 0, sizeof error);
    lmn_status status = lmn_techniques_add(set, &desc, &error);
    assert_int_equal(lmn_techniques_at(set, 1, &info), status == LMN_OK);
    lmn_techniques_destroy(&set);
    return status;
}

static void refuses_param(lmn_param_desc row, const char *word)
{
    lmn_param_desc rows[2] = {{.key = "begin", .type = LMN_PARAM_BOOL}, row};
    assert_int_equal(add(describe("other", FUNCTION, rows, 2)), LMN_USAGE);
    if (!strstr(error.message, word))
        fail_msg("'%s' does not say '%s'", error.message, word);
}

static void refuses_wrong_rows(void **state)
{
    static const char *const twice[] = {"a", "a"};
    (void)state;
    lmn_param_desc good = {.key = "second", .type = LMN_PARAM_FLOAT, .max = 1}, bad = good;
    assert_int_equal(add(describe("other", FUNCTION, &good, 1)), LMN_OK);
    refuses_param((bad = good, bad.key = NULL, bad), "called");
    refuses_param((bad = good, bad.key = "a b", bad), "'a b'");
    refuses_param((bad = good, bad.key = "a__b", bad), "a__b");
    refuses_param((bad = good, bad.key = "begin", bad), "twice");
    refuses_param((bad = good, bad.key = "technique", bad), "Limner");
    refuses_param((bad = good, bad.key = "line_width", bad), "Limner");
    refuses_param((bad = good, bad.key = "time", bad), "Limner");         /* u_time is the frame's */
    refuses_param((bad = good, bad.key = "light_colour", bad), "Limner"); /* the lights' */
    refuses_param((bad = good, bad.type = LMN_PARAM_TEXT, bad), "type");
    refuses_param((bad = good, bad.type = (lmn_param_type)99, bad), "type");
    refuses_param((bad = good, bad.unit = (lmn_param_unit)99, bad), "unit");
    refuses_param((bad = good, bad.max = 0, bad), "range");
    refuses_param((bad = good, bad.max = NAN, bad), "range");
    refuses_param((bad = good, bad.standard = "2", bad), "0 to 1");
    refuses_param((bad = good, bad.only_if = "third", bad), "third");
    refuses_param((bad = good, bad.type = LMN_PARAM_COLOUR, bad.standard = "blueish", bad), "blueish");
    refuses_param((bad = good, bad.type = LMN_PARAM_ENUM, bad), "names");
    refuses_param((bad = good, bad.type = LMN_PARAM_ENUM, bad.names = twice, bad.name_count = 2, bad), "twice");
}

static void refuses_wrong_descriptions(void **state)
{
    static char long_text[4200];
    (void)state;
    lmn_technique_desc good = describe("other", FUNCTION, NULL, 0), bad = good;
    assert_int_equal(add(good), LMN_OK);
    assert_int_equal(add((bad = good, bad.name = "mine", bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.name = "hatch", bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.name = "none", bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.name = "My+own", bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.name = NULL, bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.glsl = NULL, bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.param_count = 1, bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.kind = "lines", bad)), LMN_UNSUPPORTED);
    assert_int_equal(add((bad = good, bad.kind = "surfaces", bad)), LMN_USAGE);
    assert_string_equal(error.hint, "did you mean 'surface'?");
    assert_int_equal(add((bad = good, bad.glsl = "void surface_colours() {}", bad)), LMN_USAGE);
    assert_int_equal(add((bad = good, bad.glsl = "\n # include \"x\"\n" FUNCTION, bad)), LMN_USAGE);
    assert_int_equal(error.line, 2);
    assert_string_equal(error.file, "other");
    memset(long_text, '\n', sizeof long_text - 1);
    memcpy(long_text, FUNCTION, sizeof FUNCTION - 1);
    assert_int_equal(add((bad = good, bad.glsl = long_text, bad)), LMN_LIMIT);
    assert_int_equal(add((bad = good, bad.params = gooch_params, bad.param_count = 6, bad.param_size = 999, bad)),
                     LMN_USAGE);
}

/* Each type reaches the shader. */
static void gives_all_types(void **state)
{
    static const char        types[] = "vec4 surface_colour(surface_point p)\n"
                                       "{\n"
                                       "    bool good = u_flag && u_whole == -3 && u_word == 2 && u_list_count == 2;\n"
                                       "    good = good && u_axis == vec3(1.0, 2.0, 2.0) && u_list[1].g == 1.0;\n"
                                       "    return good ? vec4(u_tint.rgb, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);\n"
                                       "}\n";
    static const char *const words[] = {"a", "b", "c"};
    const lmn_param_desc     rows[] = {
            {.key = "flag", .type = LMN_PARAM_BOOL, .standard = "true"},
            {.key = "whole", .type = LMN_PARAM_INT, .standard = "-3", .min = -5, .max = 5},
            {.key = "word", .type = LMN_PARAM_ENUM, .standard = "c", .names = words, .name_count = 3},
            {.key = "list", .type = LMN_PARAM_PALETTE, .standard = "#000,#0f0"},
            {.key = "axis", .type = LMN_PARAM_DIRECTION, .standard = "1,2,2"},
            {.key = "tint", .type = LMN_PARAM_COLOUR, .standard = "#336699", .only_if = "flag&word=b,c"},
    };
    (void)state;
    lmn_techniques    *set = NULL;
    lmn_technique_desc desc = describe("types", types, rows, 6);
    lmn_drawing       *drawing = NULL;
    DO(lmn_techniques_create(&set, &error));
    DO(lmn_techniques_add(set, &desc, &error));
    lmn_look *look = open_look("{\"version\":2,\"rules\":[{\"surface\":\"types\"}]}", set);
    DO(draw(&drawing, look));
    const uint8_t *middle = lmn_drawing_pixels(drawing, NULL, NULL) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    assert_memory_equal(middle, ((uint8_t[]){0x33, 0x66, 0x99, 255}), 4);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    lmn_techniques_destroy(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_as_our_own),   cmocka_unit_test(looks_know_it),
        cmocka_unit_test(sets_are_listed),    cmocka_unit_test(names_lines),
        cmocka_unit_test(refuses_wrong_rows), cmocka_unit_test(refuses_wrong_descriptions),
        cmocka_unit_test(gives_all_types),
    };
    return cmocka_run_group_tests_name("techniques", tests, set_up, tear_down);
}
