/* Is the edge set right? True visible feature lines, found on the mesh, against the ink of the look `edges`: at
 * least 98 % of the lines have ink within 1.5 px, at most 2 % of the ink is farther than 2.5 px from every line. */
#include <stdio.h>

#include "check.h"
#include "feature.h"
#include "model.h"

static const double crease = 45, recall_needed = 0.98, false_allowed = 0.02;

static bool save(const char *path, const shape *s)
{
    return model_write(path, s) || check_that("files", false, "%s cannot be written", path);
}

static void compare(const char *title, const shape *s, const shot *drawing, bool judged)
{
    char          path[256];
    tracer       *t = tracer_create(s);
    feature_lines lines;
    feature_find(&lines, s, t, drawing, crease);
    snprintf(path, sizeof path, "%s", check_path("%s.png", title));
    feature_score score = feature_compare(&lines, drawing, path);
    if (judged) {
        check_at_least("edge set", score.recall, recall_needed, "%s: lines with ink (%zu samples)", title,
                       score.samples);
        check_at_most("edge set", score.false_ink, false_allowed, "%s: ink without line (%zu px)", title, score.ink);
    } else {
        check_note("%s: recall %.4f, false ink %.4f", title, score.recall, score.false_ink);
    }
    for (int k = 0; k < FEATURE_CLASSES; k++)
        if (score.samples_of[k] && score.recall_of[k] < 1)
            check_note("%s: %s %.4f of %zu", title, feature_names[k], score.recall_of[k], score.samples_of[k]);
    feature_release(&lines);
    tracer_destroy(t);
}

/* Draws the file from the given positions with the look and compares each picture. */
static void judge(const char *name, const char *ending, const shape *s, const shot_view *views, size_t count)
{
    char model[256], title[64];
    snprintf(model, sizeof model, "%s", check_path("%s.%s", name, ending));
    if (!save(model, s))
        return;
    for (size_t i = 0; i < count; i++) {
        shot drawing;
        if (!shot_take(&drawing, model, "edges", NULL, &views[i]))
            return;
        snprintf(title, sizeof title, "%s-%s-%zu", name, ending, i);
        compare(title, s, &drawing, true);
        shot_release(&drawing);
    }
}

static const shot_view around[] = {
    {.width = 512, .height = 512, .eye = {4, 3, 5}, .up = {0, 1, 0}},
    {.width = 512, .height = 384, .eye = {-6, 2, 2.5}, .up = {0, 1, 0}},
    {.width = 384, .height = 512, .eye = {3, 5, -3}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 256, .height = 256, .eye = {1.3, -4, 5}, .up = {0, 1, 0}},
};

static void cube(void)
{
    shape s = {0};
    shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    judge("cube", "ply", &s, around, 4);
    judge("cube", "stl", &s, around, 1);
    judge("cube", "glb", &s, around + 1, 1);
    shape_release(&s);
}

static void stepped_block(void)
{
    const double edges[] = {-1.4, -1, -0.5, 0, 0.4, 0.9, 1.4}, heights[] = {0.3, 0.8, 1.0, 0.55, 0.25, 0.45};
    shape        s = {0};
    shape_steps(&s, "block", edges, heights, 6, 1.2);
    judge("steps", "stl", &s, around, 3);
    judge("steps", "ply", &s, around, 3);
    shape_release(&s);
}

/* Steps of 1/1000 of the depth range, seen from above so that they are steps of depth, and at an angle. */
static void fine_steps(void)
{
    const double    edges[] = {-1.2, -0.8, -0.4, 0, 0.4, 0.8, 1.2}, heights[] = {1.0, 0.502, 0.5, 0.503, 0.5, 0.002};
    const shot_view views[] = {
        {.width = 512, .height = 512, .eye = {0.1, 6, 0.7}, .target = {0, 0, 0.5}, .up = {0, 0, -1}},
        {.width = 512,
         .height = 512,
         .eye = {0.1, 6, 0.7},
         .target = {0, 0, 0.5},
         .up = {0, 0, -1},
         .orthographic = true},
    };
    shape s = {0};
    shape_steps(&s, "block", edges, heights, 6, 1);
    judge("fine-steps", "ply", &s, views, 2);
    shape_release(&s);
}

static void torus(void)
{
    const shot_view views[] = {
        {.width = 512, .height = 512, .eye = {3, 3, 4}, .up = {0, 1, 0}},
        {.width = 512, .height = 512, .eye = {4, 1.2, 3}, .up = {0, 1, 0}},
        {.width = 512, .height = 512, .eye = {1, 5, 1}, .up = {0, 0, -1}, .orthographic = true},
    };
    shape s = {0};
    shape_torus(&s, "torus", 1, 0.4, 128, 64);
    judge("torus", "ply", &s, views, 3);
    judge("torus", "glb", &s, views, 1);
    judge("torus", "stl", &s, views, 1);
    shape_release(&s);
}

static void interpenetrating_boxes(void)
{
    shape two = {0}, one = {0};
    shape_box(&two, "first", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
    shape_box(&two, "second", dvec_of(-0.6, -0.6, -0.6), dvec_of(0.6, 0.6, 0.6));
    shape_place(&two, dvec_of(0.3, 1, 0.2), 37, dvec_of(0.6, 0.3, 0.3));
    shape_join(&one, "both", &two);
    judge("boxes-two", "glb", &two, around, 4);
    judge("boxes-one", "ply", &one, around, 4);
    judge("boxes-one", "stl", &one, around, 1);
    shape_release(&two);
    shape_release(&one);
}

/* Several landscapes, so that nobody tunes an operator to one. */
static void terrain(void)
{
    const shot_view views[] = {
        {.width = 512, .height = 384, .eye = {0.5, 1.1, 5}, .target = {0, 0.2, 0}, .up = {0, 1, 0}},
        {.width = 512, .height = 384, .eye = {3.4, 0.75, 3}, .target = {0, 0.2, 0}, .up = {0, 1, 0}},
        {.width = 512,
         .height = 512,
         .eye = {-4, 0.9, 1},
         .target = {0, 0.2, 0},
         .up = {0, 1, 0},
         .orthographic = true},
    };
    static const uint32_t seeds[] = {7, 11, 23, 42};
    for (size_t i = 0; i < 4; i++) {
        char  name[32];
        shape s = {0};
        shape_terrain(&s, "terrain", 2, i % 2 ? 0.4 : 0.6, i == 3 ? 160 : 96, seeds[i]);
        snprintf(name, sizeof name, "terrain%u", seeds[i]);
        judge(name, i ? "ply" : "glb", &s, views, 3);
        shape_release(&s);
    }
}

/* Twelve more landscapes, coarse and fine, flat and steep, pooled. */
static void landscapes(void)
{
    double found = 0, wrong = 0;
    size_t samples = 0, ink = 0;
    for (uint32_t i = 0; i < 12; i++) {
        const shot_view view = {.width = 400,
                                .height = 300,
                                .eye = {4.5 * sin(i), 0.8 + 0.06 * i, 4.5 * cos(i)},
                                .target = {0, 0.2, 0},
                                .up = {0, 1, 0},
                                .orthographic = i % 3 == 2};
        shape           s = {0};
        shot            drawing;
        shape_terrain(&s, "terrain", 2, 0.3 + 0.1 * (i % 5), 64 + 32 * (int)(i % 4), 100 + 17 * i);
        if (shot_of_shape(&drawing, &s, "landscape.ply", "edges", NULL, &view)) {
            tracer       *t = tracer_create(&s);
            feature_lines lines;
            feature_find(&lines, &s, t, &drawing, crease);
            feature_score score = feature_compare(&lines, &drawing, NULL);
            check_note("landscape %u: recall %.4f, false ink %.4f", i, score.recall, score.false_ink);
            found += score.recall * (double)score.samples;
            wrong += score.false_ink * (double)score.ink;
            samples += score.samples;
            ink += score.ink;
            feature_release(&lines);
            tracer_destroy(t);
        }
        shot_release(&drawing);
        shape_release(&s);
    }
    check_at_least("edge set", samples ? found / (double)samples : 0, recall_needed,
                   "landscapes: lines with ink (%zu samples)", samples);
    check_at_most("edge set", ink ? wrong / (double)ink : 1, false_allowed, "landscapes: ink without line (%zu px)",
                  ink);
}

/* Depth and normal Sobel finds the outline and the creases of a cube, all nine edges. */
static void sobel_cube(void)
{
    shape s = {0};
    shot  drawing;
    shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    if (shot_of_shape(&drawing, &s, "sobel-cube.ply",
                      shot_line_look("{\"operator\":\"sobel\",\"gain\":2,\"threshold\":0.1}"), NULL, &around[0]))
        compare("sobel-cube", &s, &drawing, true);
    shot_release(&drawing);
    shape_release(&s);
}

/* The operators of the seeds on the same scenes, for comparison only: none of them knows a slope from a step. */
static void operators_compared(void)
{
    static const char *const looks[] = {"four-tap", "sobel", "saito", "saito-normalised", "denormal"};
    shape                    boxes = {0}, hills = {0};
    char                     path[2][256], look[256], title[64];
    shape_box(&boxes, "first", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
    shape_box(&boxes, "second", dvec_of(0, -0.3, -0.3), dvec_of(1.2, 0.9, 0.9));
    shape_terrain(&hills, "terrain", 2, 0.6, 96, 7);
    for (int i = 0; i < 2; i++) {
        snprintf(path[i], sizeof path[i], "%s", check_path(i ? "compared-hills.ply" : "compared-boxes.ply"));
        save(path[i], i ? &hills : &boxes);
    }
    for (size_t k = 0; k < sizeof looks / sizeof *looks; k++)
        for (int i = 0; i < 2; i++) {
            shot            drawing;
            const shot_view view = {.width = 384, .height = 384, .eye = {4, 1.5, 5}, .up = {0, 1, 0}};
            snprintf(look, sizeof look,
                     "{\"version\":1,\"name\":\"t\",\"rules\":[{\"surface\":\"flat\",\"lines\":{\"operator\":\"%s\","
                     "\"gain\":4}}]}",
                     looks[k]);
            snprintf(title, sizeof title, "%s-%s", looks[k], i ? "terrain" : "boxes");
            if (!shot_take(&drawing, path[i], look, NULL, &view))
                continue;
            compare(title, i ? &hills : &boxes, &drawing, false);
            shot_release(&drawing);
        }
    shape_release(&boxes);
    shape_release(&hills);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"cube", cube},
        {"steps", stepped_block},
        {"fine-steps", fine_steps},
        {"torus", torus},
        {"boxes", interpenetrating_boxes},
        {"terrain", terrain},
        {"landscapes", landscapes},
        {"sobel", sobel_cube},
        {"compared", operators_compared},
    };
    int status = check_main(argc, argv, "edge_set", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
