/* Velocities of pixels, against the corners of triangles at two times, worked out in double precision by a second
 * reading of glTF; rows 42 and 43. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/gltf_truth.h"
#include "../support/moving_scene.h"
#include "draw/drawing.h"

enum { SIDE = 200 };

/* Where a corner is on the page, pixels, its w, and how deep. */
static void project(const view_camera *c, const double p[3], double out[4])
{
    double eye[4], clip[4];
    for (int r = 0; r < 4; r++)
        eye[r] = c->view.m[r] * p[0] + c->view.m[4 + r] * p[1] + c->view.m[8 + r] * p[2] + c->view.m[12 + r];
    for (int r = 0; r < 4; r++)
        clip[r] = c->projection.m[r] * eye[0] + c->projection.m[4 + r] * eye[1] + c->projection.m[8 + r] * eye[2] +
                  c->projection.m[12 + r] * eye[3];
    out[0] = (clip[0] / clip[3] + 1) * SIDE / 2;
    out[1] = (clip[1] / clip[3] + 1) * SIDE / 2;
    out[2] = clip[3];
    out[3] = -eye[2];
}

/* The pixels of one triangle that the maps show: how far their velocity is from the truth at most. */
static double compare_triangle(const lmn_drawing *d, double (*now)[3], double (*before)[3], int *pixels)
{
    double a[3][4], worst = 0;
    for (int k = 0; k < 3; k++)
        project(&d->camera, now[k], a[k]);
    double area = (a[1][0] - a[0][0]) * (a[2][1] - a[0][1]) - (a[2][0] - a[0][0]) * (a[1][1] - a[0][1]);
    int    low_x = (int)floor(fmin(a[0][0], fmin(a[1][0], a[2][0]))),
        low_y = (int)floor(fmin(a[0][1], fmin(a[1][1], a[2][1])));
    int high_x = (int)ceil(fmax(a[0][0], fmax(a[1][0], a[2][0]))),
        high_y = (int)ceil(fmax(a[0][1], fmax(a[1][1], a[2][1])));
    for (int y = low_y < 0 ? 0 : low_y; y < high_y && y < SIDE && fabs(area) > 1e-9; y++)
        for (int x = low_x < 0 ? 0 : low_x; x < high_x && x < SIDE; x++) {
            double px = x + 0.5, py = y + 0.5, b[3], sum = 0, depth = 0, was[3] = {0, 0, 0}, seen[4];
            b[1] = ((px - a[0][0]) * (a[2][1] - a[0][1]) - (a[2][0] - a[0][0]) * (py - a[0][1])) / area;
            b[2] = ((a[1][0] - a[0][0]) * (py - a[0][1]) - (px - a[0][0]) * (a[1][1] - a[0][1])) / area;
            b[0] = 1 - b[1] - b[2];
            if (fmin(b[0], fmin(b[1], b[2])) < 0.01)
                continue;
            for (int k = 0; k < 3; k++)
                sum += b[k] /= a[k][2]; /* along the surface, not along the page */
            for (int k = 0; k < 3; k++)
                depth += b[k] / sum * a[k][3];
            size_t at = (size_t)y * SIDE + (size_t)x;
            if (fabs((double)d->maps.depth[at] - depth) > 1e-4 * depth)
                continue;
            for (int k = 0; k < 3; k++)
                for (int r = 0; r < 3; r++)
                    was[r] += b[k] / sum * before[k][r];
            project(&d->camera, was, seen);
            const float *v = &d->maps.velocity[3 * at];
            worst = fmax(worst, hypot(px - seen[0] - (double)v[0], py - seen[1] - (double)v[1]));
            assert_true(v[2] == 0);
            ++*pixels;
        }
    return worst;
}

static void velocities_are_those_of_surfaces(void **state)
{
    static const struct {
        const char *name, *clip;
        size_t      number;
        double      seconds, exposure;
        bool        orthographic;
    } rows[] = {{"fox", "Run", 2, 0.5, 0.1, false},
                {"fox", "Walk", 1, 0.3, 0.04, true},
                {"box-animated", NULL, 0, 1.9, 0.3, false},
                {"box-animated", NULL, 0, 0.2, 0.5, false}, /* from before the clip's begin */
                {"morph-cube", NULL, 0, 0.9, 0.2, false}};
    (void)state;
    lmn_renderer     *renderer = NULL;
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &rd, &error));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char          path[512], exposure[32];
        lmn_scene    *s = NULL;
        lmn_look     *look = NULL;
        lmn_drawing  *d = NULL;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        double(*now)[3], (*before)[3], worst = 0, fastest = 0;
        int pixels = 0, shown = 0;
        snprintf(path, sizeof path, EXAMPLES "/%s.glb", rows[i].name);
        DO(lmn_scene_create(&s, &error));
        DO(lmn_scene_add_file(s, path, NULL, &error));
        DO(lmn_look_load(&look, "edges", &error));
        DO(lmn_look_set(look, "motion.technique", "accumulate", &error));
        DO(lmn_look_set(look, "motion.times", "2", &error));
        snprintf(exposure, sizeof exposure, "%g", rows[i].exposure);
        DO(lmn_look_set(look, "motion.exposure", exposure, &error));
        desc.width = desc.height = SIDE;
        desc.maps = true;
        desc.clip = rows[i].clip;
        desc.time_s = rows[i].seconds;
        desc.orthographic = rows[i].orthographic;
        DO(lmn_draw(&d, renderer, s, look, &desc, &error));
        assert_non_null(d->maps.velocity);
        gltf_truth *t = gltf_truth_load(path);
        size_t      count = gltf_truth_corners(t, rows[i].number, rows[i].seconds, &now);
        gltf_truth_corners(t, rows[i].number, fmax(rows[i].seconds - rows[i].exposure, 0), &before);
        for (size_t c = 0; c + 2 < count; c += 3)
            worst = fmax(worst, compare_triangle(d, &now[c], &before[c], &pixels));
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            shown += d->maps.id[k] != 0;
            fastest = fmax(fastest, hypot((double)d->maps.velocity[3 * k], (double)d->maps.velocity[3 * k + 1]));
        }
        if (worst > 0.1 || pixels < shown / 2 || fastest < 1)
            fail_msg("%s at %g s: velocities off by %g px at most, %d of %d pixels, the fastest %g", rows[i].name,
                     rows[i].seconds, worst, pixels, shown, fastest);
        printf("%s at %g s: %.4f px off at most, %d pixels, the fastest %.1f px\n", rows[i].name, rows[i].seconds,
               worst, pixels, fastest);
        free(now);
        free(before);
        gltf_truth_destroy(t);
        lmn_drawing_destroy(&d);
        lmn_look_destroy(&look);
        lmn_scene_destroy(&s);
    }
    lmn_renderer_destroy(&renderer);
}

/* A camera that moves and turns nothing: what a plane before it shows has moved as its points have on the page; row 41.
 */
static void cameras_move_too(void **state)
{
    const double      half[3] = {2, 2, 0.5}, colour[3] = {1, 1, 1}, now[3] = {0.3, -0.2, 4}, before[3] = {0, 0.1, 5};
    const double      focal = SIDE / 2 / tan(25 * 3.141592653589793 / 180);
    double            worst = 0;
    int               pixels = 0;
    moving_scene      m;
    lmn_renderer     *renderer = NULL;
    lmn_scene        *s = NULL;
    lmn_look         *look = NULL;
    lmn_drawing      *d = NULL;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    (void)state;
    moving_scene_begin(&m);
    moving_scene_box(&m, 0, 0, 0, half, colour);
    int eye = moving_scene_camera(&m, 0, 0, 4, false, 50);
    moving_scene_keys(&m, eye, "translation", 2, (double[]){1, 2},
                      (double[]){before[0], before[1], before[2], now[0], now[1], now[2]});
    moving_scene_write(&m, "velocity_camera.glb");
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, "velocity_camera.glb", NULL, &error));
    DO(lmn_look_load(&look, "edges", &error));
    DO(lmn_look_set(look, "motion.technique", "accumulate", &error));
    DO(lmn_look_set(look, "motion.exposure", "1", &error));
    DO(lmn_look_set(look, "motion.times", "2", &error));
    desc.width = desc.height = SIDE;
    desc.maps = true;
    desc.camera = "eye";
    desc.time_given = true;
    desc.time_s = 2;
    DO(lmn_draw(&d, renderer, s, look, &desc, &error));
    assert_non_null(d->maps.velocity);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            size_t at = (size_t)y * SIDE + (size_t)x;
            double depth = now[2] - half[2], here[2] = {x + 0.5 - SIDE / 2., y + 0.5 - SIDE / 2.}, moved[2];
            if (!d->maps.id[at] || fabs((double)d->maps.depth[at] - depth) > 1e-3)
                continue;
            for (int k = 0; k < 2; k++)
                moved[k] = here[k] - focal * (here[k] / focal * depth + now[k] - before[k]) / (before[2] - half[2]);
            worst = fmax(worst, hypot((double)d->maps.velocity[3 * at] - moved[0],
                                      (double)d->maps.velocity[3 * at + 1] - moved[1]));
            pixels++;
        }
    printf("a camera that moves: %.4f px off at most, %d pixels\n", worst, pixels);
    assert_true(pixels > SIDE * SIDE / 2 && worst < 0.1);
    lmn_drawing_destroy(&d);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&renderer);
}

/* What a section leaves of a skin moves as the skin does. */
static void sections_of_skins_move(void **state)
{
    lmn_renderer     *renderer = NULL;
    lmn_scene        *s = NULL;
    lmn_look         *look = NULL;
    lmn_drawing      *d[2] = {NULL};
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    double            off = 0;
    int               same = 0;
    (void)state;
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, EXAMPLES "/fox.glb", NULL, &error));
    DO(lmn_look_load(&look, "plain", &error));
    DO(lmn_look_set(look, "motion.technique", "blur", &error));
    DO(lmn_look_set(look, "motion.exposure", "0.1", &error));
    desc.width = desc.height = SIDE;
    desc.maps = true;
    desc.clip = "Run";
    desc.time_s = 0.5;
    for (int cut = 0; cut < 2; cut++) {
        if (cut)
            DO(lmn_look_set(look, "scene.cut", "z=50%", &error));
        DO(lmn_draw(&d[cut], renderer, s, look, &desc, &error));
    }
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        const frame_maps *whole = &d[0]->maps, *part = &d[1]->maps;
        if (!part->id[i] || fabs((double)whole->depth[i] - (double)part->depth[i]) > 1e-3)
            continue;
        off = fmax(off, hypot((double)whole->velocity[3 * i] - (double)part->velocity[3 * i],
                              (double)whole->velocity[3 * i + 1] - (double)part->velocity[3 * i + 1]));
        same++;
    }
    printf("what a section leaves: %d pixels, %.4f px off at most\n", same, off);
    assert_true(same > 1000 && off < 0.1);
    for (int cut = 0; cut < 2; cut++)
        lmn_drawing_destroy(&d[cut]);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&renderer);
}

/* Where the corners of a ball are that falls and is stretched by its speed. */
static void place_ball(double (*out)[3], const primitive *p, double seconds)
{
    const double fall = 9.81, full = 6 * 2 * sqrt(3), speed = fmin(fall * seconds / full, 1),
                 f = (1 + 0.8 * speed) * (1 + 0.8 * fall * 0.04 / 2 / full), thin = 1 / sqrt(f);
    for (uint32_t i = 0; i < p->index_count; i++) {
        vec3 at = p->positions[p->indices[i]];
        out[i][0] = thin * (double)at.x;
        out[i][1] = f * (double)at.y - fall / 2 * seconds * seconds;
        out[i][2] = thin * (double)at.z;
    }
}

/* What is deformed was deformed otherwise earlier: its surface moves by both. */
static void what_is_deformed_moves_by_that_too(void **state)
{
    const double      t = 0.9, exposure = 0.25, drop = 9.81 / 2, colour[3] = {1, 1, 1};
    double            worst = 0;
    int               pixels = 0;
    moving_scene      m;
    lmn_renderer     *renderer = NULL;
    lmn_scene        *s = NULL;
    lmn_look         *look = NULL;
    lmn_drawing      *d = NULL;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    (void)state;
    moving_scene_begin(&m);
    int node = moving_scene_sphere(&m, 0, 0, 0, 1, colour);
    moving_scene_cubic_keys(&m, node, "translation", 2, (double[]){0, 1},
                            (double[]){0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -2 * drop, 0, 0, -drop, 0, 0, 0, 0});
    moving_scene_write(&m, "velocity_ball.glb");
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, "velocity_ball.glb", NULL, &error));
    DO(lmn_look_load(&look, "edges", &error));
    static const char *const sets[][2] = {{"motion.technique", "accumulate"}, {"motion.times", "2"},
                                          {"motion.exposure", "0.25"},        {"motion.stretch", "0.8"},
                                          {"motion.full_speed", "6"},         {"motion.response", "0.04"}};
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
        DO(lmn_look_set(look, sets[i][0], sets[i][1], &error));
    desc.width = desc.height = SIDE;
    desc.maps = true;
    desc.view = LMN_VIEW_FRONT;
    desc.time_given = true;
    desc.time_s = t;
    DO(lmn_draw(&d, renderer, s, look, &desc, &error));
    assert_non_null(d->maps.velocity);
    const primitive *p = &s->meshes[0].primitives[0];
    double(*now)[3] = malloc(p->index_count * sizeof *now), (*before)[3] = malloc(p->index_count * sizeof *before);
    place_ball(now, p, t);
    place_ball(before, p, t - exposure);
    for (size_t c = 0; c + 2 < p->index_count; c += 3)
        worst = fmax(worst, compare_triangle(d, &now[c], &before[c], &pixels));
    printf("a ball that is stretched: %.4f px off at most, %d pixels\n", worst, pixels);
    assert_true(pixels > SIDE * SIDE / 8 && worst < 0.1);
    free(now);
    free(before);
    lmn_drawing_destroy(&d);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&renderer);
}

static void scenes_at_rest_have_none(void **state)
{
    (void)state;
    lmn_renderer     *renderer = NULL;
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    lmn_scene        *s = NULL;
    lmn_look         *look = NULL;
    lmn_drawing      *d = NULL;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, EXAMPLES "/fox.glb", NULL, &error));
    DO(lmn_look_load(&look, "edges", &error));
    desc.width = desc.height = 32;
    desc.maps = true;
    DO(lmn_draw(&d, renderer, s, look, &desc, &error));
    assert_null(d->maps.velocity);
    lmn_drawing_destroy(&d);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&renderer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(velocities_are_those_of_surfaces),
                                       cmocka_unit_test(cameras_move_too), cmocka_unit_test(sections_of_skins_move),
                                       cmocka_unit_test(what_is_deformed_moves_by_that_too),
                                       cmocka_unit_test(scenes_at_rest_have_none)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
