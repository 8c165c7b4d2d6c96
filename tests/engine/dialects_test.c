/* Every technique and every look draws without a GL error on desktop GL and on ES, and both give the same picture. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "limner/limner.h"
#include "look/look.h"

enum { SIDE = 96 };

typedef struct fixture {
    lmn_scene    *scene;
    lmn_renderer *renderers[2]; /* desktop, ES */
    uint8_t       picture[SIDE * SIDE * 4];
} fixture;

static void check(lmn_status status, const lmn_error *error, const char *what)
{
    if (status != LMN_OK)
        fail_msg("%s: %s (%s)", what, error->message, error->hint);
}

static int set_up(void **state)
{
    fixture          *f = calloc(1, sizeof *f);
    lmn_error         error;
    lmn_load_desc     load = LMN_LOAD_DESC_INIT;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    desc.debug = true;
    check(lmn_scene_create(&f->scene, &error), &error, "scene");
    check(lmn_scene_add_file(f->scene, TEST_DATA "/two-parts.gltf", &load, &error), &error, "file");
    check(lmn_renderer_create(&f->renderers[0], &desc, &error), &error, "desktop");
    desc.es = true;
    check(lmn_renderer_create(&f->renderers[1], &desc, &error), &error, "ES");
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_renderer_destroy(&f->renderers[0]);
    lmn_renderer_destroy(&f->renderers[1]);
    lmn_scene_destroy(&f->scene);
    free(f);
    return 0;
}

/* A look of one rule: the technique's example. */
static lmn_look *example_look(const technique *t)
{
    text json = {0};
    text_append(&json, "{\"version\": 1, \"name\": \"example\", \"rules\": [%s]}", t->example);
    lmn_look *look;
    lmn_error error;
    check(lmn_look_parse(&look, json.data, t->name, &error), &error, t->example);
    text_release(&json);
    return look;
}

static void draw(fixture *f, int which, const lmn_look *look, const char *what)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    lmn_drawing *drawing;
    lmn_error    error;
    check(lmn_draw(&drawing, f->renderers[which], f->scene, look, &desc, &error), &error, what);
    memcpy(f->picture, lmn_drawing_pixels(drawing, NULL, NULL), sizeof f->picture);
    lmn_drawing_destroy(&drawing);
}

/* The largest difference between the pictures of both contexts. */
static int difference_of_dialects(fixture *f, const lmn_look *look, const char *what)
{
    uint8_t desktop[sizeof f->picture];
    draw(f, 0, look, what);
    memcpy(desktop, f->picture, sizeof desktop);
    draw(f, 1, look, what);
    int worst = 0;
    for (size_t k = 0; k < sizeof desktop; k++) {
        int difference = abs((int)desktop[k] - (int)f->picture[k]);
        worst = difference > worst ? difference : worst;
    }
    return worst;
}

static void assert_alike(fixture *f, const lmn_look *look, const char *what)
{
    int worst = difference_of_dialects(f, look, what);
    if (worst > 1)
        fail_msg("%s: the dialects differ by up to %d levels", what, worst);
}

static void every_example_draws_the_same_in_both_dialects(void **state)
{
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; i < kinds[k]->technique_count; i++) {
            const technique *t = kinds[k]->techniques[i];
            lmn_look        *look = example_look(t);
            assert_alike(*state, look, t->name);
            lmn_look_destroy(&look);
        }
}

static void every_look_draws_the_same_in_both_dialects(void **state)
{
    for (size_t i = 0; i < lmn_look_count(); i++) {
        lmn_look *look;
        lmn_error error;
        check(lmn_look_load(&look, lmn_look_name_at(i), &error), &error, lmn_look_name_at(i));
        assert_alike(*state, look, lmn_look_name_at(i));
        lmn_look_destroy(&look);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_example_draws_the_same_in_both_dialects),
        cmocka_unit_test(every_look_draws_the_same_in_both_dialects),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
