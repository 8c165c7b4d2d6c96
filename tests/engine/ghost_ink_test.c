/* Ghost images are paler than what is there now, and the older the paler, in every look: a ball on its way, told by
 * four images beside each other, whose ink is what differs from the paper above them. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/scene.h"
#include "vector/vector.h"

enum { WIDE = 200, HIGH = 60, IMAGES = 4, FOURTHS = 4 };

/* At 0, 1, 2 (now) and 3 seconds the ball is at −6, −2, 2 and 6. */
static const char script[] =
    "{\"limner_script\": 1, \"nodes\": ["
    "{\"name\": \"ball\", \"sphere\": {\"radius\": 1.3}, \"colour\": \"#b04a30\"}],"
    "\"behaviour\": {\"target\": \"ball\", \"linear\": [[-6, 0, 0], [6, 0, 0]], \"duration\": 3}}";

typedef struct fixture {
    lmn_renderer *renderer;
    lmn_scene    *scene;
} fixture;

static lmn_draw_desc description(void)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = WIDE;
    desc.height = HIGH;
    desc.eye_given = desc.time_given = true;
    desc.fov_deg = 3;
    desc.time_s = 2;
    desc.eye[0] = desc.eye[1] = 0;
    desc.eye[2] = 91.6;
    desc.target[0] = desc.target[1] = desc.target[2] = 0;
    desc.up[1] = 1;
    desc.up[0] = desc.up[2] = 0;
    return desc;
}

static void load(fixture *f)
{
    char  path[64];
    FILE *file;
    snprintf(path, sizeof path, "/tmp/limner-ghost-ink-XXXXXX.json");
    const int fd = mkstemps(path, 5);
    assert_true(fd >= 0);
    file = fdopen(fd, "w");
    assert_non_null(file);
    fputs(script, file);
    fclose(file);
    DO(lmn_scene_create(&f->scene, &error));
    DO(lmn_scene_add_file(f->scene, path, NULL, &error));
    unlink(path);
    DO(lmn_renderer_create(&f->renderer, NULL, &error));
    lmn_depict_desc told = LMN_DEPICT_DESC_INIT;
    lmn_draw_desc   desc = description();
    told.expressions = "[{\"target\": \"ball\", \"depict\": \"still\", \"count\": 4}]";
    DO(lmn_depict(f->scene, &desc, &told, NULL, &error));
}

static void draw(const fixture *f, const lmn_look *look, uint8_t *pixels)
{
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = description();
    DO(lmn_draw(&drawing, f->renderer, f->scene, look, &desc, &error));
    memcpy(pixels, lmn_drawing_pixels(drawing, NULL, NULL), (size_t)4 * WIDE * HIGH);
    lmn_drawing_destroy(&drawing);
}

/* Without a legend, which counts parts. */
static void load_look(lmn_look **look, const char *name)
{
    DO(lmn_look_load(look, name, &error));
    DO(lmn_look_set(*look, "finish.legend", "false", &error));
    DO(lmn_look_add_sign_rules(*look, &error));
}

/* How far pixels are from a colour, mean of 0 … 1. */
static double distance(const uint8_t *pixels, int first, int end, int quarter, const double from[3])
{
    double    sum = 0;
    const int wide = WIDE / IMAGES;
    for (int y = first; y < end; y++)
        for (int x = quarter * wide; x < (quarter + 1) * wide; x++)
            for (int k = 0; k < 3; k++)
                sum += fabs(pixels[4 * (y * WIDE + x) + k] - from[k]);
    return sum / (3 * 255.0 * (end - first) * wide);
}

/* The ink of each quarter of the page, in the rows where the ball is; above it is paper, and its grain. */
static void measure(const fixture *f, const lmn_look *look, double ink[IMAGES])
{
    enum { CLEAR = 9, BALL = 11 }; /* rows */
    static uint8_t drawn[4 * WIDE * HIGH];
    double         paper[3] = {0, 0, 0};
    draw(f, look, drawn);
    for (int i = 0; i < CLEAR * WIDE; i++)
        for (int k = 0; k < 3; k++)
            paper[k] += drawn[4 * i + k] / (double)(CLEAR * WIDE);
    for (int i = 0; i < IMAGES; i++)
        ink[i] = distance(drawn, BALL, HIGH - BALL, i, paper) - distance(drawn, 0, CLEAR, i, paper);
}

/* Every fourth look, from one on. */
static void ghosts_are_paler_in_every_look(void **state)
{
    const size_t from = *(const size_t *)*state;
    const double most = 0.75;
    fixture      f = {NULL, NULL};
    int          wrong = 0, drawn = 0;
    load(&f);
    for (size_t i = from; i < lmn_look_count(); i += FOURTHS) {
        lmn_look *look = NULL;
        double    ink[IMAGES];
        load_look(&look, lmn_look_name_at(i));
        measure(&f, look, ink);
        const double now = ink[2];
        const bool paler = ink[0] < most * now && ink[1] < most * now && ink[3] < most * now && ink[0] < 0.95 * ink[1];
        if (now < 0.002)
            print_message("%s: nothing is seen (%g)\n", lmn_look_name_at(i), now);
        else if (!paler)
            print_message("%s: now %.4f, 1 s before %.2f of that, 2 s before %.2f, 1 s later %.2f\n",
                          lmn_look_name_at(i), now, ink[1] / now, ink[0] / now, ink[3] / now);
        wrong += now < 0.002 || !paler;
        drawn++;
        lmn_look_destroy(&look);
    }
    assert_true(drawn >= 10);
    assert_int_equal(wrong, 0);
    lmn_scene_destroy(&f.scene);
    lmn_renderer_destroy(&f.renderer);
}

static uint32_t part_of(const sheet *page, uint32_t group)
{
    int32_t at = (int32_t)group;
    while (at >= 0 && !page->groups[at].part)
        at = page->groups[at].parent;
    return at >= 0 ? page->groups[at].part : 0;
}

/* The same of vectors: the darkest ink of an image, and its broadest line. */
static void ghosts_are_paler_in_vectors(void **state)
{
    static const char *const looks[] = {"line", "technical", "engraving", "stipple", "pen", "storyboard", "comic"};
    fixture                  f = {NULL, NULL};
    (void)state;
    load(&f);
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        lmn_look      *look = NULL;
        lmn_sheet     *drawn = NULL;
        lmn_draw_desc  desc = description();
        lmn_sheet_desc how = LMN_SHEET_DESC_INIT;
        double         darkest[2] = {0, 0};
        load_look(&look, looks[i]);
        DO(lmn_draw_sheet(&drawn, f.renderer, f.scene, look, &desc, &how, &error));
        for (size_t k = 0; k < drawn->page.item_count; k++) {
            const sheet_item *item = &drawn->page.items[k];
            const uint32_t    part = part_of(&drawn->page, item->group);
            const node       *n = part ? &f.scene->nodes[f.scene->parts[part - 1].node] : NULL;
            if (!n || item->kind == SHEET_IMAGE || strcmp(n->name, "still of ball") != 0)
                continue;
            const bool   ghost = node_paleness(n) > 0;
            const double dark = 1 - (double)(item->ink.r + item->ink.g + item->ink.b) / 3;
            darkest[ghost] = fmax(darkest[ghost], dark);
        }
        if (!(darkest[0] > 0.3 && darkest[1] > 0 && darkest[1] < 0.75 * darkest[0]))
            fail_msg("%s: ink of now %.3f, of ghost images %.3f", looks[i], darkest[0], darkest[1]);
        lmn_sheet_destroy(&drawn);
        lmn_look_destroy(&look);
    }
    lmn_scene_destroy(&f.scene);
    lmn_renderer_destroy(&f.renderer);
}

/* ghost_ink_test FOURTH: of all looks. */
int main(int count, char **arguments)
{
    size_t                  fourth = count > 1 ? (size_t)(arguments[1][0] - '0') % FOURTHS : 0;
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(ghosts_are_paler_in_every_look, &fourth),
                                       cmocka_unit_test(ghosts_are_paler_in_vectors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
