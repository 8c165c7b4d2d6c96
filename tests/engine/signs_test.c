/* Every option of every sign changes what is drawn: one picture of each row of signs, before a viewer who stays where
 * he is, and one for each option with another value. */
#include "checked.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "depict/depict.h"

enum { SIDE = 128, PIXELS = SIDE * SIDE, OPTIONS_LEAST = 100 };

#define CRATE(NAME, PLACE) "{\"name\": \"" NAME "\", \"box\": {\"size\": [1, 1, 1]}, \"translation\": " PLACE "}"
#define BALL(NAME)         "{\"name\": \"" NAME "\", \"sphere\": {\"radius\": 0.5}, \"colour\": \"#cc4422\"}"
#define PIECE(NAME, PLACE)                                                                                             \
    ", {\"name\": \"" NAME "\", \"parent\": \"crate\", \"box\": {\"size\": [0.5, 0.5, 0.5]}, \"translation\": " PLACE  \
    "}"
#define FLIES(NAME, FROM, TO)                                                                                          \
    "{\"target\": \"" NAME "\", \"linear\": [" FROM ", " FROM ", " TO "], \"times\": [0, 0.5, 2]}"

#define LIMB(OF)        "{\"name\": \"limb\", \"parent\": \"" OF "\", \"sphere\": {\"radius\": 0.3}}"
#define SWINGS(SECONDS) "{\"target\": \"limb\", \"linear\": [[-1.5, 0, 0], [1.5, 0.5, 0]], \"duration\": " SECONDS "}"

typedef struct stage {
    const char *nodes, *behaviour;
    double      eye[3], seen[3];
} stage;

static const stage
    bounce = {"{\"name\": \"ground\", \"box\": {\"size\": [9, 0.2, 4]}, \"translation\": [3, -0.1, 0]}, " BALL("ball"),
              "{\"target\": \"ball\", \"function\": \"bounce\", \"start\": [0, 4, 0], \"velocity\": [2, 0, "
              "0], \"floor\": 0.5, \"duration\": 3}",
              {3, 2, 14},
              {3, 2, 0}},
    /* Things with a limb that goes farther than all else. */
    arm = {BALL("ball") ", " LIMB("ball"),
           "[{\"target\": \"ball\", \"function\": \"bounce\", \"start\": [0, 4, 0], \"velocity\": [2, 0, "
           "0], \"floor\": 0.5, \"duration\": 3}, " SWINGS("3") "]",
           {3, 2, 14},
           {3, 2, 0}},
    plane = {"{\"name\": \"plane\", \"semantics\": \"paper-plane\", \"cone\": {\"radius\": 1, \"height\": 2}}, " LIMB(
                 "plane"),
             "[{\"target\": \"plane\", \"curve\": {\"points\": [[-4, 0, 0], [-1, 1.5, 0], [1, -1.5, 0], [4, "
             "0, 0]]}, \"duration\": 2}, " SWINGS("2") "]",
             {0, 4, 14},
             {0, 0, 0}},
    spin = {CRATE("crate", "[0, 0, 0]"),
            "[{\"target\": \"crate\", \"linear\": [[-2, 0, 0], [2, 0, 0]], \"duration\": 2}, {\"target\": "
            "\"crate\", \"property\": \"rotation\", \"axis\": [1, 0, 0], \"linear\": [0, 250], \"duration\": 2}]",
            {5, 4, 9},
            {0, 0, 0}},
    growth = {CRATE("crate", "[0, 0, 0]"),
              "{\"target\": \"crate\", \"property\": \"scale\", \"linear\": [[1, 1, 1], [2, 2, 2]], "
              "\"duration\": 2}",
              {0, 0, 9},
              {0, 0, 0}},
    shrinkage = {CRATE("crate", "[0, 0, 0]"),
                 "{\"target\": \"crate\", \"property\": \"scale\", \"linear\": [[2, 2, 2], [1, 1, 1]], "
                 "\"duration\": 2}",
                 {0, 0, 9},
                 {0, 0, 0}},
    speaker = {CRATE("somebody", "[0, 0, 0]") ", {\"name\": \"head\", \"parent\": \"somebody\", \"sphere\": "
                                              "{\"radius\": 0.5}, \"translation\": [0, 1, 0]}",
               "{\"target\": \"somebody\", \"linear\": [[0, 0, 0], [0.5, 0, 0]], \"duration\": 2}",
               {0, 1, 9},
               {0, 1, 0}},
    filmed = {CRATE("crate", "[0, 0, 0]") ", {\"name\": \"eye\", \"translation\": [-3, 0, 5], \"camera\": "
                                          "{\"fov\": 20}}",
              "{\"target\": \"eye\", \"linear\": [[-3, 0, 5], [3, 1, 5]], \"duration\": 2}",
              {8, 5, 12},
              {0, 0, 2}},
    crates = {"{\"name\": \"crate\"}" PIECE("a", "[-0.3, -0.3, 0]") PIECE("b", "[0.3, -0.3, 0]")
                  PIECE("c", "[-0.3, 0.3, 0]") PIECE("d", "[0.3, 0.3, 0]"),
              "[" FLIES("a", "[-0.3, -0.3, 0]", "[-3, -3, 0]") "," FLIES("b", "[0.3, -0.3, 0]", "[3, -3, 0]") "," FLIES(
                  "c", "[-0.3, 0.3, 0]", "[-3, 3, 0]") "," FLIES("d", "[0.3, 0.3, 0]", "[3, 3, 0]") "]",
              {1, 1, 14},
              {0, 0, 0}},
    jets = {"{\"name\": \"crate\"}" PIECE("a", "[-4, 0.4, 0]") PIECE("b", "[-4, -0.4, 0]"),
            "[{\"target\": \"a\", \"linear\": [[-4, 0.4, 0], [0, 0.4, 0], [2, 1, 0], [4, 3, 0]], \"duration\": "
            "2}, {\"target\": \"b\", \"linear\": [[-4, -0.4, 0], [0, -0.4, 0], [2, -1, 0], [4, -3, 0]], "
            "\"duration\": 2}]",
            {0, 0, 14},
            {0, 0, 0}},
    kick = {BALL("ball") ", " CRATE("foot", "[-4, 0, 0]"),
            "[{\"target\": \"foot\", \"linear\": [[-4, -1, 0], [-1, 0, 0], [-4, 1, 0]], \"times\": [0, 1, 2]}, "
            "{\"target\": \"ball\", \"linear\": [[0, 0, 0], [0, 0, 0], [4, 2, 0]], \"times\": [0, 1, 2]}]",
            {0, 0, 14},
            {0, 0, 0}},
    drive = {CRATE("crate", "[-3, 0, 0]") ", {\"name\": \"wall\", \"box\": {\"size\": [12, 4, 0.1]}, "
                                          "\"translation\": [0, 1, -6]}",
             "{\"target\": \"crate\", \"linear\": [[-3, 0, 0], [3, 0, 0]], \"duration\": 2}",
             {0, 1, 12},
             {0, 0, 0}};

/* A row, its stage, and what its expression says beside "depict". */
typedef struct scenario {
    const char  *row, *semantics;
    const stage *on;
    const char  *said;
    double       seconds;
} scenario;

static const scenario scenarios[] = {
    {"path", NULL, &bounce, "\"target\": \"ball\"", 1.3},
    {"motion", NULL, &bounce, "\"target\": \"ball\"", 0.8},
    {"still", NULL, &arm, "\"target\": \"ball\", \"count\": 3, \"stretch\": 0.4", 1.3},
    {"still", "paper-plane", &plane, "\"target\": \"plane\", \"count\": 3", 0.7},
    {"collision", NULL, &bounce, "\"target\": \"ball\", \"text\": \"POW\"", 2.2},
    {"turnaround", NULL, &spin, "\"target\": \"crate\"", 1.2},
    {"tailspin", NULL, &spin, "\"target\": \"crate\"", 1.2},
    {"expand", NULL, &growth, "\"target\": \"crate\"", 1},
    {"collapse", NULL, &shrinkage, "\"target\": \"crate\"", 1},
    {"speech", NULL, &speaker, "\"target\": \"somebody\", \"text\": \"Here I am again\", \"side\": \"right\"", 1},
    {"thought", NULL, &speaker, "\"target\": \"somebody\", \"text\": \"Here I am again\", \"side\": \"right\"", 1},
    {"camera-path", NULL, &filmed, "\"target\": \"eye\"", 1.2},
    {"shot-flow", NULL, &filmed, "\"target\": \"eye\"", 1.2},
    {"explode", NULL, &crates, "\"target\": \"crate\", \"text\": \"BOOM\"", 1.6},
    {"split-path", NULL, &jets, "\"target\": \"crate\"", 1.5},
    {"cause", NULL, &kick, "\"target\": \"ball\", \"partner\": \"foot\"", 1.5},
    {"travelling", NULL, &drive, "\"target\": \"crate\"", 1},
    {"inset", NULL, &filmed, "\"target\": \"eye\", \"corner\": \"top-left\"", 1.2},
};

typedef struct fixture {
    lmn_renderer *renderer;
    lmn_look     *plain, *storyboard;
    lmn_scene    *scene;
    char          path[64];
} fixture;

static void load(fixture *f, const stage *on)
{
    FILE *file = fopen(f->path, "w");
    assert_non_null(file);
    fprintf(file, "{\"limner_script\": 1, \"nodes\": [%s], \"behaviour\": %s}", on->nodes, on->behaviour);
    fclose(file);
    lmn_scene_destroy(&f->scene);
    DO(lmn_scene_create(&f->scene, &error));
    DO(lmn_scene_add_file(f->scene, f->path, NULL, &error));
}

static void draw(const fixture *f, const lmn_look *look, const scenario *s, const char *expressions, uint8_t *pixels)
{
    lmn_draw_desc   desc = LMN_DRAW_DESC_INIT;
    lmn_depict_desc told = LMN_DEPICT_DESC_INIT;
    lmn_drawing    *drawing = NULL;
    desc.width = desc.height = SIDE;
    desc.samples = 1;
    desc.eye_given = desc.time_given = true;
    desc.time_s = s->seconds;
    memcpy(desc.eye, s->on->eye, sizeof desc.eye);
    memcpy(desc.target, s->on->seen, sizeof desc.target);
    desc.up[0] = desc.up[2] = 0;
    desc.up[1] = 1;
    told.expressions = expressions;
    check(lmn_depict(f->scene, &desc, &told, NULL, &error), expressions);
    DO(lmn_draw(&drawing, f->renderer, f->scene, look, &desc, &error));
    memcpy(pixels, lmn_drawing_pixels(drawing, NULL, NULL), 4 * PIXELS);
    lmn_drawing_destroy(&drawing);
}

/* Pixels that anyone would see to be others. */
static int differing(const uint8_t *a, const uint8_t *b)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        int most = 0;
        for (int k = 0; k < 3; k++)
            most = abs(a[4 * i + k] - b[4 * i + k]) > most ? abs(a[4 * i + k] - b[4 * i + k]) : most;
        count += most > 12;
    }
    return count;
}

/* Another value than that of the row, by which it is seen. */
static void other_value(const param *p, const char *row, char *out, size_t size)
{
    static const struct {
        const char *row, *key, *value;
    } own[] = {{"collision", "count", "1"},    {"expand", "width", "0.02"},
               {"collapse", "width", "0.02"},  /* there is no room for more */ {"speech", "letters", "5"},
               {"thought", "letters", "5"},    {"cause", "at", "0.5"},
               {"split-path", "apart", "1"},   {"inset", "corner", "\"bottom-right\""},
               {"speech", "side", "\"left\""}, {"thought", "side", "\"left\""},
               {"inset", "aspect", "2.5"}};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strcmp(own[i].row, row) == 0 && strcmp(own[i].key, p->key) == 0) {
            snprintf(out, size, "%s", own[i].value);
            return;
        }
    const double most = p->soft_max != 0 ? p->soft_max : p->max;
    if (p->type == PARAM_BOOL)
        snprintf(out, size, "%s", p->def != 0 ? "false" : "true");
    else if (p->type == PARAM_COLOUR)
        snprintf(out, size, "\"#12c456\"");
    else if (p->type == PARAM_TEXT)
        snprintf(out, size, "\"Other\"");
    else if (p->type == PARAM_ENUM)
        snprintf(out, size, "\"%s\"", p->names[1]);
    else
        snprintf(out, size, p->type == PARAM_INT ? "%.0f" : "%g", p->def == most ? p->min : most);
}

static json_t *with_value(const char *said, const char *row, const char *key, const char *value)
{
    char text[400];
    snprintf(text, sizeof text, "[{%s, \"depict\": \"%s\"}]", said, row);
    json_t *array = json_loads(text, 0, NULL);
    assert_non_null(array);
    if (key)
        json_object_set_new(json_array_get(array, 0), key, json_loads(value, JSON_DECODE_ANY, NULL));
    return array;
}

static void draw_with(const fixture *f, const lmn_look *look, const scenario *s, const param *p, uint8_t *pixels)
{
    char value[64] = "";
    if (p)
        other_value(p, s->row, value, sizeof value);
    json_t *array = with_value(s->said, s->row, p ? p->key : NULL, value);
    char   *text = json_dumps(array, JSON_REAL_PRECISION(17));
    draw(f, look, s, text, pixels);
    free(text);
    json_decref(array);
}

static int check_scenario(fixture *f, const scenario *s)
{
    static uint8_t   before[4 * PIXELS], after[4 * PIXELS], bare[4 * PIXELS];
    const depiction *row = depiction_find(s->row, s->semantics);
    assert_non_null(row);
    load(f, s->on);
    draw(f, f->plain, s, "[]", bare);
    draw_with(f, f->plain, s, NULL, before);
    if (strcmp(s->row, "still") != 0 && differing(bare, before) < 20)
        fail_msg("%s is not seen", s->row);
    for (size_t k = 0; k < row->param_count; k++) {
        const param *p = &row->params[k];
        draw_with(f, f->plain, s, p, after);
        if (differing(before, after) >= 4)
            continue;
        /* What only looks can show. */
        draw_with(f, f->storyboard, s, NULL, bare);
        draw_with(f, f->storyboard, s, p, after);
        if (differing(bare, after) < 4)
            fail_msg("%s.%s changes nothing in the picture", s->row, p->key);
    }
    return (int)row->param_count;
}

static void every_option_changes_the_picture(void **state)
{
    fixture f = {.renderer = NULL};
    int     options = 0, fd;
    (void)state;
    snprintf(f.path, sizeof f.path, "/tmp/limner-signs-XXXXXX.json");
    fd = mkstemps(f.path, 5);
    assert_true(fd >= 0);
    close(fd);
    DO(lmn_renderer_create(&f.renderer, NULL, &error));
    DO(lmn_look_load(&f.plain, "plain", &error));
    DO(lmn_look_load(&f.storyboard, "storyboard", &error));
    for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
        options += check_scenario(&f, &scenarios[i]);
    assert_true(options > OPTIONS_LEAST);
    size_t rows = 0;
    while (depictions[rows])
        rows++;
    assert_int_equal(rows, sizeof scenarios / sizeof *scenarios); /* a row for each */
    unlink(f.path);
    lmn_scene_destroy(&f.scene);
    lmn_look_destroy(&f.plain);
    lmn_look_destroy(&f.storyboard);
    lmn_renderer_destroy(&f.renderer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_option_changes_the_picture)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
