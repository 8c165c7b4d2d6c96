/* The GLSL of every technique compiles, in the three dialects that it is written for: desktop GL 3.3, the floor; GL
 * 4.3; and ES 3. Techniques draw their examples, tiny, shaded with their geometry, later, and layer by layer, then
 * with each value of each parameter that decides what is compiled, on the floor and on ES. What is drawn is looked
 * at elsewhere. Usage: shaders_test [floor|es|fast]…, the dialects; none: all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hold.h"
#include "limner/limner.h"

enum { SIDE = 12, WHAT_SIZE = 320, SEEN_MAX = 64 };

/* GL 4.3 is written in for what gathers lists alone, which no parameter changes. */
enum { FLOOR, ES, DIALECTS_OF_VALUES, FAST = DIALECTS_OF_VALUES, DIALECTS };

typedef struct fixture {
    lmn_scene    *scene, *solid;
    lmn_renderer *renderers[DIALECTS]; /* NULL: not wanted */
    bool          wanted[DIALECTS];
    int           drawn, mistakes;
    char          seen[SEEN_MAX][sizeof((lmn_error *)0)->message]; /* messages, of which each is said once */
} fixture;

static const char *const dialect_names[DIALECTS] = {[FLOOR] = "GL 3.3", [ES] = "ES 3", [FAST] = "GL 4.3"};

/* Ways to draw a figure. */
static const struct {
    const char *name, *settings[3][2];
} modes[] = {
    {"as it is", {{NULL}}},
    {"shaded later", {{"0:layers.technique", "front"}, {"0:layers.shading", "deferred"}, {NULL}}},
    {"in layers", {{"0:compose.technique", "xray"}, {NULL}}},
};

static bool make_scene(lmn_scene **scene, const char *path, lmn_error *error)
{
    lmn_load_desc load = LMN_LOAD_DESC_INIT;
    return lmn_scene_create(scene, error) == LMN_OK && lmn_scene_add_file(*scene, path, &load, error) == LMN_OK;
}

static bool set_up(fixture *f)
{
    lmn_error error = {0};
    bool      done = make_scene(&f->scene, TEST_DATA "/two-parts.gltf", &error) &&
                make_scene(&f->solid, EXAMPLES "/csg/widget.csg", &error);
    for (int i = 0; i < DIALECTS && done; i++) {
        if (!f->wanted[i])
            continue;
        lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
        desc.es = i == ES;
        if (i == FLOOR)
            setenv("LIMNER_PATH", "floor", 1);
        else
            unsetenv("LIMNER_PATH");
        done = lmn_renderer_create(&f->renderers[i], &desc, &error) == LMN_OK;
    }
    if (!done)
        print_error("%s\n", error.message);
    return done;
}

static void tear_down(fixture *f)
{
    for (int i = 0; i < DIALECTS; i++)
        lmn_renderer_destroy(&f->renderers[i]);
    lmn_scene_destroy(&f->scene);
    lmn_scene_destroy(&f->solid);
}

static lmn_look *example_look(const technique *t)
{
    char      json[2048];
    lmn_look *look = NULL;
    lmn_error error = {0};
    snprintf(json, sizeof json, "{\"version\": 1, \"rules\": [%s]}", t->example);
    if (lmn_look_parse(&look, json, t->name, &error) != LMN_OK)
        fail_msg("example of %s: %s", t->name, error.message);
    return look;
}

/* One mistake in a shader fails many pictures: its message, with file and line, is said for the first one. */
static void complain(fixture *f, const char *what, const char *dialect, const char *message)
{
    f->mistakes++;
    for (int i = 0; i < SEEN_MAX; i++) {
        if (strcmp(f->seen[i], message) == 0)
            return;
        if (!f->seen[i][0]) {
            snprintf(f->seen[i], sizeof f->seen[i], "%s", message);
            break;
        }
    }
    print_error("%s, %s: %s\n", what, dialect, message);
}

static void draw(fixture *f, int dialects, const lmn_scene *scene, const lmn_look *look, const char *what)
{
    for (int i = 0; i < dialects; i++) {
        if (!f->renderers[i])
            continue;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        lmn_drawing  *drawing = NULL;
        lmn_error     error = {0};
        desc.width = desc.height = SIDE;
        desc.dpi = 96;
        desc.lenient = true;
        f->drawn++;
        if (lmn_draw(&drawing, f->renderers[i], scene, look, &desc, &error) != LMN_OK)
            complain(f, what, dialect_names[i], error.message);
        lmn_drawing_destroy(&drawing);
    }
}

static void every_technique_in_every_way(void **state)
{
    fixture *f = *state;
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t n = 0; n < kinds[k]->technique_count; n++)
            for (size_t w = 0; w < sizeof modes / sizeof *modes; w++) {
                char      what[WHAT_SIZE];
                lmn_look *look = example_look(kinds[k]->techniques[n]);
                hold_lighter(look, kinds[k], kinds[k]->techniques[n], "");
                bool fits = true; /* not every way goes together with every technique */
                for (size_t s = 0; modes[w].settings[s][0]; s++)
                    fits = lmn_look_set(look, modes[w].settings[s][0], modes[w].settings[s][1], NULL) == LMN_OK && fits;
                snprintf(what, sizeof what, "%s.%s, %s", kinds[k]->name, kinds[k]->techniques[n]->name, modes[w].name);
                if (fits)
                    draw(f, DIALECTS, f->scene, look, what);
                lmn_look_destroy(&look);
            }
    assert_int_equal(f->mistakes, 0);
}

/* Draws one value of a parameter. */
static void draw_value(fixture *f, const kind *k, const technique *t, const param *p, const char *value)
{
    char      path[HOLD_KEY_SIZE], what[WHAT_SIZE];
    lmn_look *look = example_look(t);
    hold_key(path, k, p->key);
    hold_lighter(look, k, t, p->key);
    hold_condition(look, k, t, p->only_if);
    snprintf(what, sizeof what, "%s.%s.%s=%s", k->name, t->name, p->key, value);
    if (lmn_look_set(look, path, value, NULL) != LMN_OK)
        fail_msg("%s cannot be set", what);
    draw(f, DIALECTS_OF_VALUES, f->scene, look, what);
    lmn_look_destroy(&look);
}

/* All values that compile something else. Whole numbers are unrolled loops: the least and the standard do. */
static void draw_param(fixture *f, const kind *k, const technique *t, const param *p)
{
    char value[32];
    if (p->type == PARAM_ENUM && (p->variant || k->id == KIND_LAYERS))
        for (size_t i = 0; p->names[i]; i++)
            draw_value(f, k, t, p, p->names[i]);
    else if (p->type == PARAM_BOOL && p->variant)
        draw_value(f, k, t, p, p->def != 0 ? "false" : "true");
    else if (p->variant || p->toggles) {
        snprintf(value, sizeof value, "%.6g",
                 p->def != 0 || p->variant ? p->min
                 : p->soft_max != 0        ? p->soft_max
                                           : p->max);
        draw_value(f, k, t, p, value);
    }
}

static void every_value_that_compiles_something_else(void **state)
{
    fixture *f = *state;
    for (int k = 0; k < KIND_COUNT; k++) {
        const kind *of = kinds[k];
        for (size_t i = 0; i < of->common_count; i++)
            draw_param(f, of, of->standard ? of->standard : of->techniques[0], &of->common[i]);
        for (size_t n = 0; n < of->technique_count; n++)
            for (size_t i = 0; i < of->techniques[n]->param_count; i++)
                draw_param(f, of, of->techniques[n], &of->techniques[n]->params[i]);
    }
    assert_int_equal(f->mistakes, 0);
}

/* Solids have shaders of their own, for each way to evaluate them. */
static void every_evaluation_of_solids(void **state)
{
    fixture                 *f = *state;
    static const char *const evaluations[] = {"auto", "lists", "products"}, *const compositions[] = {"opaque", "xray"};
    for (size_t c = 0; c < 2; c++)
        for (size_t e = 0; e < 3; e++) {
            char      what[WHAT_SIZE];
            lmn_look *look = example_look(kinds[KIND_LINES]->techniques[0]);
            assert_int_equal(lmn_look_set(look, "0:compose.technique", compositions[c], NULL), LMN_OK);
            assert_int_equal(lmn_look_set(look, "0:layers.evaluation", evaluations[e], NULL), LMN_OK);
            snprintf(what, sizeof what, "a solid, %s, %s", compositions[c], evaluations[e]);
            draw(f, DIALECTS, f->solid, look, what);
            lmn_look_destroy(&look);
        }
    print_message("%d pictures\n", f->drawn);
    assert_int_equal(f->mistakes, 0);
}

int main(int count, char **arguments)
{
    static const char *const names[DIALECTS] = {[FLOOR] = "floor", [ES] = "es", [FAST] = "fast"};
    static fixture           f;
    for (int i = 0; i < DIALECTS; i++) {
        f.wanted[i] = count < 2;
        for (int k = 1; k < count; k++)
            f.wanted[i] = f.wanted[i] || strcmp(arguments[k], names[i]) == 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(every_technique_in_every_way, &f),
        cmocka_unit_test_prestate(every_value_that_compiles_something_else, &f),
        cmocka_unit_test_prestate(every_evaluation_of_solids, &f),
    };
    int failures = set_up(&f) ? cmocka_run_group_tests(tests, NULL, NULL) : 1;
    tear_down(&f);
    return failures;
}
