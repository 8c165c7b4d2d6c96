/* The motion technique `accumulate`: the mean of the pictures that are drawn of single times; what
 * does not move keeps every bit. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 120, PIXELS = SIDE * SIDE };

typedef struct fixture {
    lmn_renderer *renderer;
    lmn_scene    *fox, *boxes;
} fixture;

static lmn_scene *load(const char *path)
{
    lmn_scene *s = NULL;
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, path, NULL, &error));
    return s;
}

static int set_up(void **state)
{
    static fixture    f;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&f.renderer, &desc, &error));
    f.fox = load(EXAMPLES "/fox.glb");
    f.boxes = load(EXAMPLES "/box-animated.glb");
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_scene_destroy(&f->fox);
    lmn_scene_destroy(&f->boxes);
    lmn_renderer_destroy(&f->renderer);
    return 0;
}

/* `rules` are the look's. */
static lmn_status try_draw(const fixture *f, const lmn_scene *s, const char *rules, const lmn_draw_desc *wanted,
                           uint8_t *out)
{
    char          json[1024];
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = *wanted;
    snprintf(json, sizeof json, "{\"version\": 1, \"rules\": [%s]}", rules);
    DO(lmn_look_parse(&look, json, "test", &error));
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    lmn_status status = lmn_draw(&drawing, f->renderer, s, look, &desc, &error);
    if (status == LMN_OK)
        memcpy(out, lmn_drawing_pixels(drawing, NULL, NULL), 4 * PIXELS);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    return status;
}

static void draw(const fixture *f, const lmn_scene *s, const char *rules, const lmn_draw_desc *wanted, uint8_t *out)
{
    DO(try_draw(f, s, rules, wanted, out));
}

/* The weighted mean of single pictures, against one that is exposed; the greatest difference in steps of 8 bits. */
static double worst_difference(const fixture *f, const char *plain, const char *exposed, double seconds, int times,
                               const double *weights)
{
    static uint8_t one[4 * PIXELS], whole[4 * PIXELS];
    double        *sum = calloc(4 * PIXELS, sizeof *sum), total = 0, worst = 0;
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    desc.clip = "Run";
    desc.time_s = 0.5;
    desc.fit_time = true;
    draw(f, f->fox, exposed, &desc, whole);
    for (int i = 0; i < times; i++) {
        desc.time_s = 0.5 - seconds * i / times;
        draw(f, f->fox, plain, &desc, one);
        total += weights[i];
        for (size_t k = 0; k < 4 * PIXELS; k++)
            sum[k] += weights[i] * one[k];
    }
    for (size_t k = 0; k < 4 * PIXELS; k++)
        worst = fmax(worst, fabs(sum[k] / total - whole[k]));
    free(sum);
    return worst;
}

#define PLAIN "\"surface\": \"lit\", \"lines\": \"discontinuity\""

static void it_is_the_mean(void **state)
{
    static const double equal[8] = {1, 1, 1, 1, 1, 1, 1, 1}, last[8] = {5, 1, 1, 1, 1, 1, 1, 1},
                        decay[5] = {1, 0.5, 0.25, 0.125, 0.0625};
    double off = worst_difference(*state, "{" PLAIN "}",
                                  "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 8, "
                                  "\"exposure\": 0.2}}",
                                  0.2, 8, equal);
    assert_true(off <= 1.01);
    off = worst_difference(*state, "{" PLAIN "}",
                           "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 8, \"exposure\": 0.2, "
                           "\"weights\": \"last\", \"last\": 5}}",
                           0.2, 8, last);
    assert_true(off <= 1.01);
    off = worst_difference(*state, "{" PLAIN "}",
                           "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 5, \"exposure\": 0.1, "
                           "\"weights\": \"decay\", \"decay\": 0.5}}",
                           0.1, 5, decay);
    assert_true(off <= 1.01);
}

#define BLUR "\"motion\": {\"technique\": \"accumulate\", \"times\": 7, \"exposure\": 0.3}"

/* Without a time nothing moves; nor does a part whose rule has no motion, whatever moves around it. */
/* Row 77c: of all times each channel of a pixel has what is farthest from the white ground, here the darkest; of older
 * ones, with half of the ink. */
static void a_plate_has_all_of_them(void **state)
{
    enum { TIMES = 4 };
    const fixture *f = *state;
    static uint8_t one[4 * PIXELS], whole[4 * PIXELS], wanted[4 * PIXELS];
    const char    *plain = "{\"lines\": \"discontinuity\", \"surface\": \"lit\"}";
    const char    *plate =
        "{\"lines\": \"discontinuity\", \"surface\": \"lit\", \"motion\": {\"technique\": "
        "\"accumulate\", \"times\": 4, \"weights\": \"plate\", \"overlap\": \"through\", \"decay\": %g, "
        "\"exposure\": 0.4}}";
    for (int k = 0; k < 2; k++) {
        double        decay = k ? 0.5 : 1;
        char          rules[512];
        int           worst = 0, figures = 0;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.clip = "Run";
        desc.time_given = desc.fit_time = true;
        desc.time_s = 0.5;
        snprintf(rules, sizeof rules, plate, decay);
        draw(f, f->fox, rules, &desc, whole);
        memset(wanted, 255, sizeof wanted);
        for (int i = 0; i < TIMES; i++) {
            desc.time_s = 0.5 - 0.4 * i / TIMES;
            draw(f, f->fox, plain, &desc, one);
            for (int n = 0; n < 4 * PIXELS; n++) {
                int faded = (int)lround(255 - (255 - one[n]) * pow(decay, i));
                wanted[n] = (uint8_t)(faded < wanted[n] ? faded : wanted[n]);
            }
        }
        for (int n = 0; n < 4 * PIXELS; n++) {
            worst = abs(whole[n] - wanted[n]) > worst ? abs(whole[n] - wanted[n]) : worst;
            figures += n % 4 == 0 && wanted[n] < 200;
        }
        printf("a plate, ink of older ones times %g: off by %d of 255\n", decay, worst);
        assert_true(worst <= 1 && figures > 500);
    }
}

/* The newest figure of a plate is as it is alone, wherever it is: what was there before it does not show through. */
static void the_newest_lies_in_front(void **state)
{
    const fixture *f = *state;
    static uint8_t one[4 * PIXELS], front[4 * PIXELS], through[4 * PIXELS];
    const char *plate = "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 4, \"weights\": \"plate\", "
                        "\"overlap\": \"%s\", \"decay\": 0.9, \"exposure\": 0.4}}";
    char        rules[512];
    int         worst = 0, shown = 0, behind = 0;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.clip = "Run";
    desc.time_given = desc.fit_time = true;
    desc.time_s = 0.5;
    draw(f, f->fox, "{" PLAIN "}", &desc, one);
    snprintf(rules, sizeof rules, plate, "newest");
    draw(f, f->fox, rules, &desc, front);
    snprintf(rules, sizeof rules, plate, "through");
    draw(f, f->fox, rules, &desc, through);
    for (int n = 0; n < 4 * PIXELS; n += 4) {
        bool inside = true; /* beside its outline lines lie beyond what it covers */
        for (int k = 0; k < 25; k++) {
            int beside = n + 4 * (SIDE * (k / 5 - 2) + k % 5 - 2);
            inside = inside && beside >= 0 && beside < 4 * PIXELS && one[beside] < 250;
        }
        worst = inside && abs(front[n] - one[n]) > worst ? abs(front[n] - one[n]) : worst;
        shown += inside && abs(through[n] - one[n]) > 10;
        behind += one[n] == 255 && front[n] < 240;
    }
    printf("the newest figure of a plate is off by %d of 255; others show through at %d pixels\n", worst, shown);
    assert_true(worst <= 1 && shown > 50 && behind > 200);
}

/* Without --fit-time, too, all figures of a plate are in the picture, and none is far from its border. Parts of other
 * rules count where they are. */
static void a_plate_fits_its_figures(void **state)
{
    static const struct {
        const char *model, *clip;
        double      at, exposure;
        const char *moments;
    } plates[] = {{"buggy.glb", NULL, 1.6, 1.5, "equal"},
                  {"arm.glb", NULL, 1.5, 1.4, "equal"},
                  {"box-animated.glb", NULL, 1.9, 1.8, "equal"},
                  {"fox.glb", "Run", 0.5, 0.4, "equal"},
                  {"buggy.glb", NULL, 1.6, 3600, "telling"}};
    const fixture *f = *state;
    static uint8_t pixels[4 * PIXELS];
    for (size_t i = 0; i < sizeof plates / sizeof *plates; i++) {
        char          path[512], rules[512];
        int           margin = SIDE;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        snprintf(path, sizeof path, EXAMPLES "/%s", plates[i].model);
        snprintf(rules, sizeof rules,
                 "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 6, \"weights\": \"plate\", "
                 "\"moments\": \"%s\", \"decay\": 1, \"exposure\": %g}}",
                 plates[i].moments, plates[i].exposure);
        lmn_scene *s = load(path);
        desc.clip = plates[i].clip;
        desc.time_given = true;
        desc.time_s = plates[i].at;
        draw(f, s, rules, &desc, pixels);
        for (int n = 0; n < PIXELS; n++) {
            int x = n % SIDE, y = n / SIDE, sides[] = {x, y, SIDE - 1 - x, SIDE - 1 - y};
            for (int k = 0; k < 4 && pixels[4 * n + 1] < 250; k++)
                margin = sides[k] < margin ? sides[k] : margin;
        }
        lmn_scene_destroy(&s);
        printf("a plate of %s leaves %d of %d pixels beside it\n", plates[i].model, margin, SIDE);
        assert_in_range(margin, 1, SIDE / 6);
    }
}

static void what_rests_keeps_every_bit(void **state)
{
    const fixture *f = *state;
    static uint8_t with[4 * PIXELS], without[4 * PIXELS];
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    draw(f, f->fox, "{" PLAIN ", " BLUR "}", &desc, with);
    draw(f, f->fox, "{" PLAIN "}", &desc, without);
    assert_memory_equal(with, without, sizeof with);
    /* Both boxes move; the inner one rises, and only the outer one may blur. */
    desc.time_s = 1.9;
    desc.eye_given = true;
    memcpy(desc.eye, (double[]){4, 6, 7}, sizeof desc.eye);
    memcpy(desc.target, (double[]){0, 1, 0}, sizeof desc.target);
    desc.up[1] = 1;
    draw(f, f->boxes, "{" PLAIN "}, {\"select\": \"outer*\", " PLAIN ", " BLUR "}", &desc, with);
    draw(f, f->boxes, "{" PLAIN "}", &desc, without);
    static uint8_t blurred[4 * PIXELS];
    draw(f, f->boxes, "{" PLAIN "}, {\"select\": \"inner*\", " PLAIN ", " BLUR "}", &desc, blurred);
    int above = 0, above_blurred = 0;
    for (int i = 0; i < 4 * SIDE * (SIDE / 3); i++) { /* where the inner box is alone */
        above += with[i] != without[i];
        above_blurred += blurred[i] != without[i];
    }
    assert_int_equal(above, 0);
    assert_true(above_blurred > 200);
}

static void one_exposure_a_picture(void **state)
{
    const fixture *f = *state;
    static uint8_t pixels[4 * PIXELS];
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    desc.time_s = 1.9;
    assert_int_equal(try_draw(f, f->boxes,
                              "{" PLAIN ", " BLUR "}, {\"select\": \"inner*\", " PLAIN
                              ", \"motion\": {\"technique\": \"accumulate\", \"times\": 9}}",
                              &desc, pixels),
                     LMN_USAGE);
    assert_non_null(strstr(error.message, "different motion"));
}

static int calls;

static bool stop_later(double fraction, const char *stage, void *user)
{
    (void)fraction;
    (void)stage;
    (void)user;
    return ++calls < 6;
}

static void it_can_be_cancelled(void **state)
{
    const fixture *f = *state;
    static uint8_t pixels[4 * PIXELS];
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    desc.time_s = 1.9;
    desc.progress = stop_later;
    assert_int_equal(try_draw(f, f->boxes, "{" PLAIN ", " BLUR "}", &desc, pixels), LMN_CANCELLED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_mean),           cmocka_unit_test(a_plate_has_all_of_them),
        cmocka_unit_test(the_newest_lies_in_front), cmocka_unit_test(what_rests_keeps_every_bit),
        cmocka_unit_test(one_exposure_a_picture),   cmocka_unit_test(it_can_be_cancelled),
        cmocka_unit_test(a_plate_fits_its_figures),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
