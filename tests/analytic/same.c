/* Same input, same picture: twice, with one thread and two, through the command and the library, after another
 * scene, in both dialects of GL, and for every technique in its own example. */
#include <jansson.h>
#include <limner/limner.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"
#include "model.h"
#include "picture.h"
#include "shot.h"

static const shot_view view = {.width = 200, .height = 160, .eye = {4, 3, 5}, .up = {0, 1, 0}};

static void scene_of(shape *s)
{
    shape_box(s, "base", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
    shape_torus(s, "ring", 0.9, 0.25, 64, 32);
    shape_place(s, dvec_of(1, 0.3, 0), 60, dvec_of(0.1, 0.1, 0.2));
    for (size_t i = 0; i < s->count; i++)
        s->parts[i].colour[i] = 0.3f;
}

static int differing(const uint8_t *a, const uint8_t *b, size_t count, int tolerance)
{
    int different = 0;
    for (size_t i = 0; i < count; i++)
        different += abs(a[i] - b[i]) > tolerance;
    return different;
}

static void twice(void)
{
    static const char *const looks[] = {"plain", "edges", "gooch", "toon"};
    for (int i = 0; i < 4; i++) {
        shape s = {0};
        shot  first, second;
        scene_of(&s);
        bool ok = shot_of_shape(&first, &s, "twice.glb", looks[i], NULL, &view);
        if (shot_of_shape(&second, &s, "twice.glb", looks[i], NULL, &view) && ok) {
            size_t count = (size_t)(first.width * first.height);
            check_at_most("same", differing(first.picture, second.picture, 4 * count, 0), 0,
                          "bytes that differ between two calls: %s", looks[i]);
            check_that("same",
                       memcmp(first.depth, second.depth, count * sizeof(float)) == 0 &&
                           memcmp(first.edge, second.edge, 4 * count) == 0,
                       "and so do the maps");
        }
        shot_release(&first);
        shot_release(&second);
        shape_release(&s);
    }
}

/* Scenes that come and go at one address must not be taken for one another. */
static void one_after_another(void)
{
    shot fresh[8], later[8];
    int  wrong = 0;
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 8; i++) {
            shape s = {0};
            shot *out = round ? &later[i] : &fresh[i];
            shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 0.2 * i - 0.7, 1));
            shot_of_shape(out, &s, "after.ply", "edges", NULL, &view);
            shape_release(&s);
            if (round == 0)
                shot_end(); /* the next picture gets a renderer of its own */
        }
    }
    for (int i = 0; i < 8; i++) {
        wrong += !fresh[i].picture || !later[i].picture ||
                 differing(fresh[i].picture, later[i].picture, (size_t)(view.width * view.height * 4), 0) > 0;
        shot_release(&fresh[i]);
        shot_release(&later[i]);
    }
    check_at_most("same", wrong, 0,
                  "of 8 scenes drawn one after another that look different from a renderer of their own");
}

/* Runs the command with one more variable in the environment; its exit status. */
static int run_command(const char *variable, const char *value, const char *model, const char *out, const char *look)
{
    pid_t child = fork();
    if (child == 0) {
        setenv(variable, value, 1);
        execl(LIMNER_COMMAND, "limner", "draw", model, "-o", out, "--look", look, "--size", "200x160", "--dpi", "96",
              "--eye", "4,3,5", "--target", "0,0,0", "--up", "0,1,0", "--quiet", (char *)NULL);
        _exit(127);
    }
    int status = -1;
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static bool same_files(const char *a, const char *b)
{
    FILE *first = fopen(a, "rb"), *second = fopen(b, "rb");
    int   x = 0, y = 0;
    while (first && second && x == y && x != EOF) {
        x = fgetc(first);
        y = fgetc(second);
    }
    bool same = first && second && x == y;
    if (first)
        fclose(first);
    if (second)
        fclose(second);
    return same;
}

static void command_and_threads(void)
{
    static const char *const variables[][2] = {
        {"LP_NUM_THREADS", "1"}, {"LP_NUM_THREADS", "2"}, {"LP_NUM_THREADS", "0"}, {"LIMNER_GL", "es"}};
    static const char *const looks[] = {"edges", "toon", "gooch"};
    shape                    s = {0};
    char                     model[256], paths[4][256];
    scene_of(&s);
    snprintf(model, sizeof model, "%s", check_path("command.glb"));
    model_write(model, &s);
    for (int l = 0; l < 3; l++) {
        shot      drawing;
        shot_view bare = view;
        bool      ran = true;
        bare.without_maps = true;
        for (int i = 0; i < 4; i++) {
            snprintf(paths[i], sizeof paths[i], "%s", check_path("%s-%d.png", looks[l], i));
            ran = check_near("command", run_command(variables[i][0], variables[i][1], model, paths[i], looks[l]), 0, 0,
                             "exit status with %s=%s", variables[i][0], variables[i][1]) &&
                  ran;
        }
        check_that("same", same_files(paths[0], paths[1]), "one and two threads write the same file: %s", looks[l]);
        check_that("same", same_files(paths[0], paths[2]), "and none as well");
        if (ran && shot_take(&drawing, model, looks[l], NULL, &bare)) {
            int      w = 0, h = 0;
            uint8_t *gl = picture_read_rgba(paths[1], &w, &h), *es = picture_read_rgba(paths[3], &w, &h);
            size_t   count = (size_t)(w * h * 4);
            if (check_that("command", gl && es && w == 200 && h == 160, "the command's pictures can be read")) {
                check_at_most("same", differing(gl, drawing.picture, count, 0), 0,
                              "bytes that differ between command and library");
                check_at_most("GLES", differing(gl, es, count, 1), 0,
                              "values that differ by more than a level with LIMNER_GL=es");
            }
            free(gl);
            free(es);
            shot_release(&drawing);
        }
    }
    shape_release(&s);
}

/* Every technique of every kind, in its own example, in both dialects: it compiles and gives the same picture and
 * maps. */
static void judge_example(const char *kind, const char *name, const char *rule, const shape *s)
{
    char      look[2048];
    shot      gl, es;
    shot_view other = view;
    other.es = true;
    snprintf(look, sizeof look, "{\"version\":1,\"name\":\"t\",\"rules\":[%s]}", rule);
    bool ok = shot_of_shape(&gl, s, "example.glb", look, NULL, &view);
    if (shot_of_shape(&es, s, "example.glb", look, NULL, &other) && ok) {
        size_t count = (size_t)(gl.width * gl.height);
        int    depth = 0;
        for (size_t i = 0; i < count; i++)
            depth += isinf(gl.depth[i]) != isinf(es.depth[i]) ||
                     fabs((double)gl.depth[i] - (double)es.depth[i]) > 1e-5 * (double)gl.depth[i];
        check_at_most(
            "GLES", differing(gl.picture, es.picture, 4 * count, 1) + differing(gl.edge, es.edge, 4 * count, 1) + depth,
            0, "values that differ between 330 and 300 es: %s %s", kind, name);
    }
    shot_release(&gl);
    shot_release(&es);
}

static void both_dialects(void)
{
    char     *text = NULL;
    lmn_error error = {0};
    size_t    done = 0;
    shape     s = {0};
    if (!check_that("GLES", lmn_look_reference_json(&text, NULL, &error) == LMN_OK, "the reference is there (%s)",
                    error.message))
        return;
    scene_of(&s);
    json_t *reference = json_loads(text, 0, NULL), *kind, *technique;
    size_t  i, k;
    json_array_foreach(json_object_get(reference, "kinds"), i, kind)
        json_array_foreach(json_object_get(kind, "techniques"), k, technique)
    {
        const char *example = json_string_value(json_object_get(technique, "example"));
        char       *dumped = example ? strdup(example) : json_dumps(json_object_get(technique, "example"), 0);
        if (!dumped)
            continue;
        judge_example(json_string_value(json_object_get(kind, "name")),
                      json_string_value(json_object_get(technique, "name")), dumped, &s);
        free(dumped);
        done++;
    }
    check_at_least("GLES", (double)done, 20, "techniques tried in both dialects");
    json_decref(reference);
    lmn_text_free(text);
    shape_release(&s);
}

/* More samples a pixel change neither the geometry nor the tones of flat areas. */
static void supersampled(void)
{
    shape     s = {0};
    shot      one, many;
    shot_view fine = view;
    fine.samples = 16;
    scene_of(&s);
    bool ok = shot_of_shape(&one, &s, "samples.glb", "edges", NULL, &view);
    if (shot_of_shape(&many, &s, "samples.glb", "edges", NULL, &fine) && ok) {
        int flat = 0, wrong = 0;
        for (int y = 3; y + 3 < view.height; y++)
            for (int x = 3; x + 3 < view.width; x++) {
                bool quiet = true;
                int  i = y * view.width + x;
                for (int k = 0; k < 49; k++) {
                    const uint8_t *p = &one.picture[4 * (i + (k / 7 - 3) * view.width + k % 7 - 3)];
                    quiet = quiet && abs(p[0] - one.picture[4 * i]) <= 6 && abs(p[1] - one.picture[4 * i + 1]) <= 6;
                }
                flat += quiet;
                wrong += quiet && differing(&one.picture[4 * i], &many.picture[4 * i], 4, 3) > 0;
            }
        check_at_least("samples", flat, 10000, "pixels in flat areas");
        check_at_most("samples", wrong, 0, "of them that 16 samples change");
        check_at_most("samples", differing(one.edge, many.edge, (size_t)(view.width * view.height * 4), 0), 0,
                      "the edge map stays single-sampled");
    }
    shot_release(&one);
    shot_release(&many);
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"twice", twice},
        {"after", one_after_another},
        {"command", command_and_threads},
        {"dialects", both_dialects},
        {"samples", supersampled},
    };
    int status = check_main(argc, argv, "same", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
