/* Controls of the looks that ship: each changes the drawing at both ends and between, heavier is more ink, darker is
 * darker, and 0 is the look without its controls, byte for byte. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "checked.h"

static int wrong; /* all are said before the test fails */

#define WRONG(...) (wrong++, print_error(__VA_ARGS__), print_error("\n"))

enum { SIDE = 160, DPI = 29, PIXELS = SIDE * SIDE };

typedef struct fixture {
    lmn_renderer *renderer;
    lmn_scene    *arm, *walker, *pump; /* the walker for looks that tell of motion, the pump for hidden lines */
} fixture;

static int set_up(void **state)
{
    static fixture    f;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&f.renderer, &desc, &error));
    DO(lmn_scene_create(&f.arm, &error));
    DO(lmn_scene_add_file(f.arm, EXAMPLES "/arm.glb", NULL, &error));
    DO(lmn_scene_create(&f.walker, &error));
    DO(lmn_scene_add_file(f.walker, EXAMPLES "/walker.bvh", NULL, &error));
    DO(lmn_scene_create(&f.pump, &error));
    DO(lmn_scene_add_file(f.pump, EXAMPLES "/pump.glb", NULL, &error));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_scene_destroy(&f->arm);
    lmn_scene_destroy(&f->walker);
    lmn_scene_destroy(&f->pump);
    lmn_renderer_destroy(&f->renderer);
    return 0;
}

static bool tells_of_motion(const char *name)
{
    static const char *const names[] = {"speed-lines", "ghosts", "chrono", "manga", "squash"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

static const lmn_scene *scene_for(const fixture *f, const char *name)
{
    return tells_of_motion(name) ? f->walker : strcmp(name, "technical") == 0 ? f->pump : f->arm;
}

static void draw(const fixture *f, const char *name, const lmn_look *look, uint8_t *out)
{
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = SIDE;
    /* On a page of 14 cm hidden lines crowd so that none is left: those of the pump are drawn on one of 27. */
    desc.dpi = scene_for(f, name) == f->pump ? DPI / 2 : DPI;
    if (tells_of_motion(name)) {
        desc.time_s = 1;
        desc.view = LMN_VIEW_RIGHT;
    }
    DO(lmn_draw(&drawing, f->renderer, scene_for(f, name), look, &desc, &error));
    memcpy(out, lmn_drawing_pixels(drawing, NULL, NULL), 4 * PIXELS);
    lmn_drawing_destroy(&drawing);
}

static double mean(const uint8_t *rgba)
{
    double sum = 0;
    for (size_t i = 0; i < 4 * PIXELS; i++)
        sum += i % 4 == 3 ? 0 : rgba[i];
    return sum / (3 * PIXELS);
}

/* How much is on the page: the mean distance from its ground, which the first pixel shows. */
static double ink(const uint8_t *rgba)
{
    double sum = 0;
    for (size_t i = 0; i < 4 * PIXELS; i++)
        sum += i % 4 == 3 ? 0 : abs(rgba[i] - rgba[i % 4]);
    return sum / (3 * PIXELS);
}

static lmn_look *load(const char *name, const char *control, double value)
{
    lmn_look *look = NULL;
    DO(lmn_look_load(&look, name, &error));
    if (control)
        DO(lmn_look_set_control(look, control, value, &error));
    return look;
}

/* At -1, 0 and 1; weights at -0.5 and 0.5, too. */
static void check_control(const fixture *f, const char *name, const char *control, const uint8_t *shipped)
{
    static uint8_t drawn[5][4 * PIXELS];
    const int      step = strcmp(control, "weight") == 0 ? 1 : 2;
    for (int i = 0; i < 5; i += step) {
        lmn_look *look = i == 2 ? NULL : load(name, control, (i - 2) / 2.0);
        if (look)
            draw(f, name, look, drawn[i]);
        else
            memcpy(drawn[i], shipped, sizeof drawn[i]);
        lmn_look_destroy(&look);
    }
    if (memcmp(drawn[0], drawn[4], sizeof drawn[0]) == 0 || memcmp(drawn[2], drawn[4], sizeof drawn[0]) == 0)
        WRONG("%s: %s does nothing", name, control);
    for (int i = step; i < 5; i += step) {
        if (strcmp(control, "weight") == 0 && !(ink(drawn[i]) > ink(drawn[i - step])))
            WRONG("%s: weight %g has no more ink: %.3f after %.3f", name, (i - 2) / 2.0, ink(drawn[i]),
                  ink(drawn[i - step]));
        if (strcmp(control, "darkness") == 0 && !(mean(drawn[i]) < mean(drawn[i - step])))
            WRONG("%s: darkness %g is no darker: %.3f after %.3f", name, (i - 2) / 2.0, mean(drawn[i]),
                  mean(drawn[i - step]));
    }
}

static void all_looks(void **state)
{
    static uint8_t shipped[4 * PIXELS], at_zero[4 * PIXELS];
    int            controls = 0;
    for (size_t i = 0; i < lmn_look_count(); i++) {
        lmn_control_info info;
        lmn_look        *look = load(lmn_look_name_at(i), NULL, 0);
        draw(*state, lmn_look_name_at(i), look, shipped);
        for (size_t c = 0; lmn_control_at(c, &info); c++)
            if (lmn_look_has_control(look, info.name)) {
                check_control(*state, lmn_look_name_at(i), info.name, shipped);
                DO(lmn_look_set_control(look, info.name, 0, &error));
                controls++;
            }
        draw(*state, lmn_look_name_at(i), look, at_zero);
        if (memcmp(at_zero, shipped, sizeof shipped) != 0)
            WRONG("%s: with its controls at 0 it is not the look as it ships", lmn_look_name_at(i));
        lmn_look_destroy(&look);
    }
    assert_true(controls > 100);
    assert_int_equal(wrong, 0);
}

/* A drawing says what changes: what a control changes is changed by its parameters, too. */
static void as_by_parameters(void **state)
{
    static uint8_t one[4 * PIXELS], other[4 * PIXELS];
    lmn_look      *look = load("edges", "weight", 1);
    draw(*state, "edges", look, one);
    uint64_t before = lmn_look_revision(look);
    DO(lmn_look_set_control(look, "weight", 0.75, &error));
    assert_true(lmn_look_changes(look, before) & LMN_CHANGE_VALUES);
    DO(lmn_look_set(look, "weight", "0", &error));
    DO(lmn_look_set(look, "lines.width", "3.6", &error)); /* twice what it has */
    draw(*state, "edges", look, other);
    assert_memory_equal(one, other, sizeof one);
    lmn_look_destroy(&look);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_looks), cmocka_unit_test(as_by_parameters)};
    return cmocka_run_group_tests_name("controls", tests, set_up, tear_down);
}
