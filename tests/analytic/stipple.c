/* Dots and strokes that lie on surfaces, as the GPU draws them: their tone, size and number, which of them there
 * are against the same decisions in doubles on the CPU, that they stay on the surface when the viewer moves, and
 * that nothing hides what is seen. Seed 001, chapter 5; rows EX-05, EX-07 to EX-14, EX-29, EX-30, EX-32. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "stage/mark_ground.h"
#include "halftone_scenes.h"
#include "limner/limner.h"
#include "shape.h"
#include "surface/marks.h"
#include "surface/surface.h"

enum { SIDE = 256 };

/* --- scenes --------------------------------------------------------------------------------------------- */

static shot_view view_of(double x, double y, double z, double fov)
{
    return (shot_view){.width = SIDE,
                       .height = SIDE,
                       .eye = {x, y, z},
                       .target = {0, 0, 0},
                       .up = {0, 1, 0},
                       .fov_deg = fov,
                       .without_maps = true};
}

/* A wall of side 2 around the middle, facing +z. */
static bool draw_wall(shot *out, const char *keys, const char *scene, const char *more, const shot_view *view)
{
    halftone_scene s = {0};
    halftone_add_wall(&s, "wall", (halftone_wall){-1, -1, 0, 2, 2, 1});
    bool ok = halftone_shot(out, &s, "stipple-wall.gltf", halftone_look_with(keys, scene, more), NULL, view);
    halftone_release(&s);
    return ok;
}

/* Without light: a wall of one darkness. `keys` begins with the technique and more numbers. */
static const char *dark(const char *technique, double darkness, const char *keys)
{
    static char texts[4][400];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(text, sizeof texts[0], "%s\",\"texture\":0,\"shadow\":%.9g,\"light\":%.9g%s%s", technique, 1 - darkness,
             1 - darkness, *keys ? "," : "", keys);
    return text;
}

/* Ink on the wall, away from its border. */
static double ink_of_wall(const char *surface, const shot_view *view)
{
    shot s;
    if (!draw_wall(&s, surface, "", "", view))
        return -1;
    int    margin = SIDE / 8;
    double ink = halftone_mean(&s, margin, margin, SIDE - 2 * margin, SIDE - 2 * margin);
    shot_release(&s);
    return ink;
}

/* --- tone (EX-31, EX-32, EX-05) ------------------------------------------------------------------------- */

static void tones(void)
{
    static const double sizes[] = {1.5, 2.2, 4, 8};
    shot_view           view = view_of(0, 0, 3, 30);
    for (int k = 0; k < 4; k++) {
        double worst = 0, at = 0;
        char   line[256] = "", keys[64];
        snprintf(keys, sizeof keys, "\"count\":100000,\"diameter\":%g", sizes[k]);
        for (int i = 0; i <= 16; i++) {
            double ink = ink_of_wall(dark("stipple", 0.95 * i / 16, keys), &view);
            snprintf(line + strlen(line), sizeof line - strlen(line), " %.3f", ink);
            if (fabs(ink - 0.95 * i / 16) > worst) {
                worst = fabs(ink - 0.95 * i / 16);
                at = 0.95 * i / 16;
            }
        }
        check_note("%s", line);
        check_at_most("EX-32", worst, 0.03, "dots of %g px: ink off on a ramp of 17 tones up to 0.95 (worst at %.3f)",
                      sizes[k], at);
    }
}

/* The same tone at any distance, tilt and field of view, without larger dots. */
static void tone_over_distance(void)
{
    const double tone = 0.3;
    for (int k = 0; k <= 6; k++) {
        double    distance = 3 * exp2(0.5 * k);
        shot_view view =
            view_of(0, 0, distance,
                    2 * atan(0.35 * 3 / distance / 1.4) * 180 / 3.14159265); /* closer up to the wall's middle */
        double ink = ink_of_wall(dark("stipple", tone, "\"count\":30000,\"grow\":1"), &view);
        check_near("EX-05", ink, tone, 0.03 * tone + 0.006,
                   "dots at %.1f times the distance, the field of view with it", distance / 3);
        view.fov_deg = 12;
        view.eye = (dvec){0, 0, 9 * exp2(-0.25 * k)};
        ink = ink_of_wall(dark("stipple", tone, "\"count\":60000,\"grow\":1"), &view);
        check_near("EX-05", ink, tone, 0.03 * tone + 0.006, "dots from %.2f away", view.eye.z);
    }
    for (int tilt = 0; tilt <= 75; tilt += 15) {
        double    a = tilt * 3.14159265 / 180;
        shot_view view = view_of(8 * sin(a), 0, 8 * cos(a), 3);
        double    ink = ink_of_wall(dark("stipple", tone, "\"count\":150000,\"grow\":1"), &view);
        check_near("EX-05", ink, tone, 0.1 * tone, "dots on a wall turned by %d degrees", tilt);
    }
}

/* Strokes: their law keeps the ink on a wall that goes away or turns. */
static void strokes_over_distance(void)
{
    static const char *const keys = "\"placed\":\"planes\",\"count\":20000,\"length\":0.04,\"series\":1,\"uneven\":0.3";
    double                   first = 0;
    for (int k = 0; k <= 6; k += 3) {
        shot_view view = view_of(0, 0, 4 * exp2(0.5 * k), 2 * atan(0.3 / exp2(0.5 * k)) * 180 / 3.14159265);
        view.fov_deg = 8;
        view.eye = (dvec){0, 0, 12 * exp2(-0.25 * k)};
        double ink = ink_of_wall(dark("strokes", 0.3, keys), &view);
        if (k == 0)
            first = ink;
        check_near("EX-05", ink, first, 0.1 * first, "strokes from %.2f away", view.eye.z);
    }
    for (int tilt = 25; tilt <= 75; tilt += 25) {
        double    a = tilt * 3.14159265 / 180;
        shot_view view = view_of(12 * sin(a), 0, 12 * cos(a), 3);
        double    ink = ink_of_wall(dark("strokes", 0.3, keys), &view);
        check_near("EX-05", ink, first, 0.1 * first, "strokes on a wall turned by %d degrees", tilt);
    }
    static const char *const sets[] = {
        "\"placed\":\"planes\",\"count\":40000,\"length\":0.04,\"series\":1",
        "\"placed\":\"form\",\"count\":40000,\"length\":0.04,\"series\":2",
        "\"placed\":\"planes\",\"count\":40000,\"length\":0.04,\"series\":3,\"width\":2.5,\"scale\":2"};
    for (int k = 0; k < 3; k++) {
        double    worst = 0, at = 0;
        char      line[128] = "";
        shot_view view = view_of(0, 0, 6, 10);
        for (int i = 4; i <= 8; i += 4) { /* tracing strokes takes long; what lies between has been looked at, too */
            double ink = ink_of_wall(dark("strokes", i / 12.0, sets[k]), &view);
            snprintf(line + strlen(line), sizeof line - strlen(line), " %.3f", ink);
            if (fabs(ink - i / 12.0) > worst) {
                worst = fabs(ink - i / 12.0);
                at = i / 12.0;
            }
        }
        check_note("%s", line);
        check_at_most("EX-05", worst, 0.03, "strokes, way %d: ink off at 1/3 and 2/3 (worst at %.3f)", k, at);
    }
}

/* --- the same set as on the CPU (EX-07) ----------------------------------------------------------------- */

typedef struct blob {
    double x, y, ink;
} blob;

/* Pixels with ink that hang together. */
static int blobs_of(const shot *s, blob *out, int capacity)
{
    int   count = 0, *stack = check_alloc((size_t)(s->width * s->height), sizeof *stack);
    char *seen = check_alloc((size_t)(s->width * s->height), 1);
    for (int i = 0; i < s->width * s->height; i++) {
        if (seen[i] || halftone_ink(s, i % s->width, i / s->width) < 0.02)
            continue;
        blob b = {0, 0, 0};
        int  top = 0;
        stack[top++] = i;
        seen[i] = 1;
        while (top) {
            int    at = stack[--top], x = at % s->width, y = at / s->width;
            double ink = halftone_ink(s, x, y);
            b.x += (x + 0.5) * ink;
            b.y += (y + 0.5) * ink;
            b.ink += ink;
            for (int k = 0; k < 9; k++) {
                int nx = x + k % 3 - 1, ny = y + k / 3 - 1, n = ny * s->width + nx;
                if (nx >= 0 && ny >= 0 && nx < s->width && ny < s->height && !seen[n] &&
                    halftone_ink(s, nx, ny) >= 0.02) {
                    seen[n] = 1;
                    stack[top++] = n;
                }
            }
        }
        if (count < capacity)
            out[count++] = (blob){b.x / b.ink, b.y / b.ink, b.ink};
    }
    free(stack);
    free(seen);
    return count;
}

/* What the CPU draws of the same file in the same view. */
static bool page_of(marks_page *page, const shot *s, const char *model, const stipple_values *values,
                    const float light[3])
{
    lmn_scene    *scene = NULL;
    lmn_error     error = {0};
    mark_ground   ground = {.extent = 0};
    marks         m = {.dots = NULL};
    technique_use use = {&surface_stipple, (void *)(uintptr_t)values};
    bool          ok = lmn_scene_create(&scene, &error) == LMN_OK &&
              lmn_scene_add_file(scene, check_path("%s", model), NULL, &error) == LMN_OK;
    pose at_rest = {.scene = NULL};
    ok = ok && pose_create(&at_rest, scene, &(moment){.seconds = 0}, &error) == LMN_OK &&
         mark_ground_create(&ground, &at_rest, NULL, scene->part_count, 0.5, &error) == LMN_OK &&
         mark_ground_marks(&m, &ground, &use, &error) == LMN_OK;
    if (ok) {
        mark_view view = {.orthographic = s->orthographic,
                          .width = s->width,
                          .height = s->height,
                          .light_count = 1,
                          .lights = {{light[0], light[1], light[2], 0}},
                          .colours = {{1, 1, 1, 1}}};
        mat4      world = mat4_identity(), eye;
        memcpy(&world.m[12], ground.origin, sizeof ground.origin);
        memcpy(eye.m, s->view, sizeof eye.m);
        memcpy(view.projection.m, s->projection, sizeof view.projection.m);
        view.model_view = mat4_multiply(&eye, &world);
        mark_style style;
        surface_mark_style(&style, &use);
        style.pixels = true;
        ok = marks_visible(page, &m, &view, &style, NULL, NULL, &error) == LMN_OK;
    }
    check_that("EX-07", ok, "the CPU draws the same marks: %s", error.message);
    surface_marks_release(&m);
    mark_ground_release(&ground);
    pose_release(&at_rest);
    lmn_scene_destroy(&scene);
    return ok;
}

/* A lit ball with few dots, so that each stands alone: every one that the CPU draws is there, as large, and no
 * other. */
static void same_set(void)
{
    enum { CAPACITY = 20000, SIZE = 512 };
    static const char *const surface = "stipple\",\"texture\":0,\"count\":3000,\"diameter\":2.5,\"shadow\":0.85,"
                                       "\"light\":1.02,\"fade\":0.001,\"grow\":1";
    stipple_values           values;
    params_set_defaults(surface_stipple.params, surface_stipple.param_count, &values);
    values.common.texture = 0;
    values.common.count = 3000;
    values.common.shadow = 0.85f;
    values.common.light = 1.02f;
    values.common.fade = 0.001f;
    values.common.paper = (colour){1, 1, 1, 1};
    values.diameter = 2.5f;
    values.grow = 1;
    const float light[3] = {0.48f / 1.0f, 0.6f, 0.64f};
    blob       *blobs = check_alloc(CAPACITY, sizeof *blobs);
    shape       ball = {0};
    shape_sphere(&ball, "ball", (dvec){0.2, 0.1, 0}, 1, 60, 90, true);
    for (int k = 0; k < 12; k++) {
        double     a = 0.5 * k;
        shot_view  view = {.width = SIZE,
                           .height = SIZE,
                           .eye = {4 * sin(a), 1.5 * cos(2 * a), 4 * cos(a)},
                           .target = {0.2, 0.1, 0},
                           .up = {0, 1, 0},
                           .fov_deg = 32,
                           .without_maps = true,
                           .orthographic = k % 4 == 3};
        shot       s;
        marks_page page = {.dots = NULL};
        if (!shot_of_shape(&s, &ball, "stipple-ball.ply",
                           halftone_look_with(surface, "\"light_direction\":[0.48,0.6,0.64],\"fill\":0", ""), NULL,
                           &view))
            return;
        if (page_of(&page, &s, "stipple-ball.ply", &values, light)) {
            int    count = blobs_of(&s, blobs, CAPACITY), missing = 0, extra = 0, off = 0, alone = 0;
            double radius = 0, worst = 0;
            for (size_t i = 0; i < page.dot_count; i++)
                radius = fmax(radius, hypot((double)page.dots[i].x - SIZE / 2.0, (double)page.dots[i].y - SIZE / 2.0));
            for (size_t i = 0; i < page.dot_count; i++) {
                bool found = false, single = hypot((double)page.dots[i].x - SIZE / 2.0,
                                                   (double)page.dots[i].y - SIZE / 2.0) < 0.97 * radius;
                for (size_t j = 0; j < page.dot_count && single; j++)
                    single = j == i || hypot((double)(page.dots[i].x - page.dots[j].x),
                                             (double)(page.dots[i].y - page.dots[j].y)) > 5.5;
                if (!single)
                    continue;
                alone++;
                for (int j = 0; j < count && !found; j++)
                    if (hypot(blobs[j].x - (double)page.dots[i].x, blobs[j].y - (double)page.dots[i].y) < 0.5) {
                        found = true;
                        worst = fmax(worst, fabs(blobs[j].ink -
                                                 0.785398 * (double)page.dots[i].width * (double)page.dots[i].width));
                        off += fabs(blobs[j].ink - 0.785398 * (double)page.dots[i].width * (double)page.dots[i].width) >
                               0.35;
                    }
                missing += !found;
            }
            for (int j = 0; j < count; j++) {
                bool found = false;
                for (size_t i = 0; i < page.dot_count && !found; i++)
                    found = hypot(blobs[j].x - (double)page.dots[i].x, blobs[j].y - (double)page.dots[i].y) < 4;
                /* Where a ball's normals turn away a little before it does, both are right. */
                extra += !found && hypot(blobs[j].x - SIZE / 2.0, blobs[j].y - SIZE / 2.0) < 0.97 * radius;
            }
            check_that("EX-07", missing == 0 && extra == 0 && off == 0 && alone > 150,
                       "view %d: %zu dots, %d alone; %d missing on the GPU, %d there alone, %d of another size (area "
                       "off by %.2f at most)",
                       k, page.dot_count, alone, missing, extra, off, worst);
        }
        marks_page_release(&page);
        shot_release(&s);
    }
    shape_release(&ball);
    free(blobs);
}

/* --- coherence (EX-08, EX-09) --------------------------------------------------------------------------- */

/* Between views half a degree apart, dots move with the surface and few of them change. Tracked on the CPU by their
 * number, whose set EX-07 compares with the GPU's. */
static void stays_put(void)
{
    marks m;
    vec3  positions[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
         normals[4] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    uint32_t     indices[6] = {0, 1, 2, 0, 2, 3};
    mark_surface wall = {positions, normals, NULL, indices, 4, 2};
    if (!check_that("EX-09", marks_stipple(&m, &wall, 5000, 1, NULL) == LMN_OK, "dots"))
        return;
    mark_style style = {.diameter = 2, .fade = 0.15f, .most = 1, .shadow = 0.5f, .light = 0.5f, .contrast = 1};
    double     fraction = 0, most = 0;
    int        steps = 0;
    float     *before = check_alloc(m.dot_count, sizeof *before), *now = check_alloc(m.dot_count, sizeof *now);
    for (int k = 0; k <= 40; k++) {
        double    a = (20 + 0.5 * k) * 3.14159265 / 180, c = cos(a), s = sin(a);
        mark_view view = {.width = SIDE, .height = SIDE};
        view.model_view = mat4_identity();
        view.projection = mat4_identity();
        view.model_view.m[0] = view.model_view.m[10] = c;
        view.model_view.m[2] = s;
        view.model_view.m[8] = -s;
        view.model_view.m[14] = -5;
        view.projection.m[0] = view.projection.m[5] = 3;
        view.projection.m[10] = -1.1;
        view.projection.m[11] = -1;
        view.projection.m[14] = -1;
        view.projection.m[15] = 0;
        for (size_t i = 0; i < m.dot_count; i++) { /* one by one, so that it is known which is which */
            marks      one = {.dots = &m.dots[i], .dot_count = 1, .area = m.area / (double)m.dot_count};
            marks_page page = {.dots = NULL};
            marks_visible(&page, &one, &view, &style, NULL, NULL, NULL);
            now[i] = page.dot_count ? page.dots[0].width * page.dots[0].width / 4 : 0;
            marks_page_release(&page);
        }
        int changed = 0;
        for (size_t i = 0; i < m.dot_count && k > 0; i++) {
            changed += fabsf(now[i] - before[i]) > 0.1f;
            most = fmax(most, fabs((double)(now[i] - before[i])));
        }
        if (k > 0) {
            fraction = fmax(fraction, (double)changed / (double)m.dot_count);
            steps++;
        }
        memcpy(before, now, m.dot_count * sizeof *now);
    }
    check_at_most("EX-09", fraction, 0.02,
                  "fraction of dots that change by more than a tenth in a step of half a degree, most of %d steps",
                  steps);
    check_at_most("EX-08", most, 0.1, "change of a dot in such a step");
    free(before);
    free(now);
    surface_marks_release(&m);
}

/* --- sizes (EX-10, EX-12) ------------------------------------------------------------------------------- */

static void sizes(void)
{
    static const double diameters[] = {1, 1.5, 2.25, 3.7, 8, 16, 33, 64};
    blob               *blobs = check_alloc(1000, sizeof *blobs);
    for (int k = 0; k < 8; k++) {
        double worst = 0;
        int    seen = 0;
        for (int far = 0; far < 2; far++) {
            char keys[96];
            snprintf(keys, sizeof keys, "\"count\":%d,\"diameter\":%g,\"fade\":0.001,\"grow\":1",
                     diameters[k] > 40 ? 6 : 12, diameters[k]);
            shot_view view = view_of(far ? 0.6 : 0, 0, far ? 4 : 3, far ? 18 : 30);
            shot      s;
            if (!draw_wall(&s, dark("stipple", 0.9, keys), "", "", &view))
                return;
            int count = blobs_of(&s, blobs, 1000);
            for (int i = 0; i < count; i++) {
                double reach = diameters[k] / 2 + 2;
                if (blobs[i].x < reach || blobs[i].y < reach || blobs[i].x > SIDE - reach ||
                    blobs[i].y > SIDE - reach || blobs[i].ink > 1.5 * 0.785 * diameters[k] * diameters[k] + 1)
                    continue; /* at the rim, or two */
                double d = sqrt(blobs[i].ink / 0.785398);
                if (d > 0.75 * diameters[k]) { /* those that the wall's border cuts are others */
                    worst = fmax(worst, fabs(d - diameters[k]));
                    seen++;
                }
            }
            shot_release(&s);
        }
        check_at_most("EX-10", worst, 0.25, "diameter of dots of %g px off (%d dots)", diameters[k], seen);
        check_at_least("EX-10", seen, 1, "dots seen");
    }
    free(blobs);
}

/* Strokes are as wide at every angle, aspect and depth: the ink of each, by its principal axes, is a bar of that
 * width. */
static void widths(void)
{
    static const double wanted[] = {1.5, 3, 6, 12};
    static const int    sizes[3][2] = {{256, 256}, {320, 180}, {180, 320}};
    for (int w = 0; w < 4; w++) {
        double worst = 0;
        int    seen = 0;
        for (int turn = 0; turn < 9; turn++) {
            char keys[200];
            snprintf(keys, sizeof keys,
                     "\"placed\":\"planes\",\"count\":%d,\"length\":0.08,\"series\":1,\"taper\":0,\"uneven\":0,"
                     "\"fade\":0.001,\"width\":%g,\"pattern_seed\":%d",
                     wanted[w] > 8 ? 16 : 40, wanted[w], turn);
            shot_view view = view_of(0.6 * (turn % 3 - 1), 0.15 * turn - 0.6, 4, 17);
            double    a = 0.35 * turn;
            view.up = (dvec){sin(a), cos(a), 0};
            view.width = sizes[turn % 3][0];
            view.height = sizes[turn % 3][1];
            shot s;
            if (!draw_wall(&s, dark("strokes", 0.9, keys), "", "", &view))
                return;
            char *used = check_alloc((size_t)(s.width * s.height), 1);
            int  *stack = check_alloc((size_t)(s.width * s.height), sizeof *stack);
            for (int i = 0; i < s.width * s.height; i++) {
                if (used[i] || halftone_ink(&s, i % s.width, i / s.width) < 0.02)
                    continue;
                double m[6] = {0}; /* ink, x, y, xx, xy, yy */
                bool   whole = true;
                int    top = 0;
                stack[top++] = i;
                used[i] = 1;
                while (top) {
                    int          at = stack[--top], x = at % s.width, y = at / s.width;
                    double       ink = halftone_ink(&s, x, y);
                    const double add[6] = {1, x, y, (double)x * x, (double)x * y, (double)y * y};
                    for (int k = 0; k < 6; k++)
                        m[k] += ink * add[k];
                    whole = whole && x > 0 && y > 0 && x + 1 < s.width && y + 1 < s.height;
                    for (int k = 0; k < 9; k++) {
                        int nx = x + k % 3 - 1, ny = y + k / 3 - 1, n = ny * s.width + nx;
                        if (nx >= 0 && ny >= 0 && nx < s.width && ny < s.height && !used[n] &&
                            halftone_ink(&s, nx, ny) >= 0.02) {
                            used[n] = 1;
                            stack[top++] = n;
                        }
                    }
                }
                double xx = m[3] / m[0] - m[1] * m[1] / m[0] / m[0], xy = m[4] / m[0] - m[1] * m[2] / m[0] / m[0],
                       yy = m[5] / m[0] - m[2] * m[2] / m[0] / m[0];
                double mean = 0.5 * (xx + yy), apart = sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy),
                       length = sqrt(12 * (mean + apart));
                if (!whole || length < 22 || length > 70)
                    continue; /* at the rim, cut by the wall's, or two */
                double across = mean - apart,
                       width = sqrt(fmax(12 * (across - 1.0 / 12), 0)); /* a rim is a pixel wide */
                if (width > 1.5 * wanted[w])
                    continue; /* two */
                worst = fmax(worst, fabs(width - wanted[w]));
                seen++;
            }
            free(used);
            free(stack);
            shot_release(&s);
        }
        check_at_most("EX-12", worst, 0.25, "width of strokes of %g px off (%d strokes)", wanted[w], seen);
        check_at_least("EX-12", seen, 12, "strokes seen");
    }
}

/* What points and quads draw is the same: row EX-29's layouts. Dots that might grow too large for the driver's
 * points are quads. */
static void points_and_quads(void)
{
    shot_view view = view_of(0.5, 0.4, 3, 30);
    shot      points, quads;
    if (!draw_wall(&points, dark("stipple", 0.4, "\"count\":40000,\"diameter\":17,\"grow\":1"), "", "", &view))
        return;
    if (draw_wall(&quads, dark("stipple", 0.4, "\"count\":40000,\"diameter\":17,\"grow\":16"), "", "", &view)) {
        check_at_most("EX-29", shot_differing(&points, &quads, 2), 0, "pixels in which points and quads differ");
        shot_release(&quads);
    }
    shot_release(&points);
}

/* A dot whose middle is outside of the picture is seen all the same: drawn into a picture twice as large, the
 * middle is the same. */
static void at_the_rim(void)
{
    shot_view small = view_of(0, 0, 3, 20), large = small;
    large.width = large.height = 2 * SIDE;
    large.fov_deg = 2 * atan(2 * tan(10 * 3.14159265358979 / 180)) * 180 / 3.14159265358979;
    shot                     a, b;
    static const char *const keys = "\"count\":3000,\"diameter\":13,\"grow\":1";
    if (!draw_wall(&a, dark("stipple", 0.3, keys), "", "", &small))
        return;
    if (draw_wall(&b, dark("stipple", 0.3, keys), "", "", &large)) {
        int off = 0, rim = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                bool differs = fabs(halftone_ink(&a, x, y) - halftone_ink(&b, x + SIDE / 2, y + SIDE / 2)) > 0.05;
                off += differs;
                rim += (x == 0 || y == 0 || x == SIDE - 1 || y == SIDE - 1) && halftone_ink(&a, x, y) > 0.5;
            }
        check_at_most("EX-10", off, 8, "pixels that differ from those of the larger picture");
        check_at_least("EX-10", rim, 50, "pixels of dots at the rim");
        shot_release(&b);
    }
    shot_release(&a);
}

/* --- hidden ones (EX-14) -------------------------------------------------------------------------------- */

/* A ball in front of a wall. Lit from the side, the wall is full of marks and half of the ball has none: nothing of
 * the wall, nor of the ball's far side, may be seen through it. */
static void hidden(void)
{
    shape s = {0};
    shape_sphere(&s, "ball", (dvec){0, 0, 0}, 1, 60, 90, true);
    shape_quad(&s, "wall", 3, -1.5);
    shape_make_normals(&s, 40);
    static const char *const surfaces[2] = {
        "stipple\",\"texture\":0,\"count\":20000,\"diameter\":3,\"shadow\":0.2,\"light\":3",
        "strokes\",\"texture\":0,\"count\":8000,\"width\":3,\"shadow\":0.2,\"light\":3"};
    for (int k = 0; k < 2; k++) {
        shot_view view = view_of(0, 0, 5, 28);
        view.without_maps = false;
        shot front;
        if (!shot_of_shape(&front, &s, "stipple-hidden.ply",
                           halftone_look_with(surfaces[k], "\"light_direction\":[1,0,0.1],\"fill\":0", ""), NULL,
                           &view))
            return;
        int inked = 0, all = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                if (front.normal[y * SIDE + x][0] > 0.4f && front.normal[y * SIDE + x][2] > 0.45f) {
                    all++;
                    inked += halftone_ink(&front, x, y) > 0.02;
                }
        check_that("EX-14", inked == 0 && all > 3000,
                   "%s: %d of %d pixels of the lit side have marks of what is behind", k ? "strokes" : "dots", inked,
                   all);
        shot_release(&front);
    }
    shape_release(&s);
}

/* On a flat face, however it is turned, a mark is not cut by the face itself: its ink is that of its size. */
static void uncut(void)
{
    blob *blobs = check_alloc(4000, sizeof *blobs);
    for (int tilt = 0; tilt <= 80; tilt += 20) {
        double    a = tilt * 3.14159265 / 180;
        shot_view view = view_of(5 * sin(a), 0.7, 5 * cos(a), 18);
        shot      s;
        if (!draw_wall(&s, dark("stipple", 0.1, "\"count\":2000,\"diameter\":6,\"fade\":0.001,\"grow\":1"), "", "",
                       &view))
            return;
        int count = blobs_of(&s, blobs, 4000), cut = 0, seen = 0;
        for (int i = 0; i < count; i++) {
            /* Those near the wall's border are cut by it: it is 2 wide. */
            dvec at = {(blobs[i].x / SIDE - 0.5), (0.5 - blobs[i].y / SIDE), 0};
            if (fabs(at.x) > 0.3 * fmax(cos(a), 0.2) || fabs(at.y) > 0.3 || blobs[i].ink > 1.2 * 28.27)
                continue;
            seen++;
            cut += sqrt(blobs[i].ink / 0.785398) < 5; /* a pixel less */
        }
        check_that("EX-14", cut == 0 && seen > 3, "turned by %d degrees, %d of %d dots are cut by their own face", tilt,
                   cut, seen);
        shot_release(&s);
    }
    free(blobs);
}

/* --- rows EX-29, EX-30: how many marks are drawn, and what they take ------------------------------------------- */

typedef struct told {
    double there, drawn, bytes, clusters, clusters_drawn, off_page, turned_away, too_dense;
} told;

static double number_in(json_t *object, const char *key)
{
    return (double)json_integer_value(json_object_get(object, key));
}

static told told_of(const shot *s)
{
    json_t *root = json_loads(s->report, 0, NULL), *marks = json_object_get(root, "surface_marks"),
           *left = json_object_get(marks, "left_out");
    told out = {number_in(marks, "there"),      number_in(marks, "drawn"),          number_in(marks, "bytes"),
                number_in(marks, "clusters"),   number_in(marks, "clusters_drawn"), number_in(left, "off_page"),
                number_in(left, "turned_away"), number_in(left, "too_dense")};
    json_decref(root);
    return out;
}

/* A dot drawn as a point takes two vectors of four floats; a stroke five at each of four corners, and six indices. From
 * afar few are looked at: those that the nearest place asks for. */
static void marks_are_told(void)
{
    static const char *const surfaces[] = {"stipple\",\"texture\":0,\"count\":20000,\"diameter\":2",
                                           "strokes\",\"placed\":\"planes\",\"texture\":0,\"count\":6000"};
    static const double      bytes[] = {2 * 16, 5 * 16 * 4 + 6 * 4};
    shape                    ball = {0};
    shape_sphere(&ball, "ball", (dvec){0, 0, 0}, 1, 30, 45, true);
    for (int kind = 0; kind < 2; kind++) {
        told seen[3] = {{0}};
        for (int k = 0; k < 3; k++) {
            shot      s;
            shot_view view = {.width = 256,
                              .height = 256,
                              .eye = {0, 0, (double[]){4, 40, 400}[k]},
                              .up = {0, 1, 0},
                              .fov_deg = 32,
                              .without_maps = true};
            if (shot_of_shape(&s, &ball, "told-ball.ply", halftone_look(surfaces[kind]), NULL, &view))
                seen[k] = told_of(&s);
            shot_release(&s);
        }
        check_at_least("EX-29", seen[0].there, 5000, "marks, %.7s", surfaces[kind]);
        check_near("EX-29", seen[0].bytes / fmax(seen[0].there, 1), bytes[kind], 0, "  bytes each");
        check_near("EX-30", seen[0].drawn + seen[0].off_page + seen[0].turned_away + seen[0].too_dense, seen[0].there,
                   0, "  those drawn and those left out are all");
        check_at_least("EX-30", seen[1].too_dense / fmax(seen[1].there, 1), kind ? 0.05 : 0.3,
                       "  farther away, too dense");
        /* Dots go with the square of the distance, strokes with the distance. */
        double law = kind ? 1.0 / 10 : 1.0 / 100;
        check_near("EX-30", seen[2].drawn / fmax(seen[1].drawn, 1), law, 0.15 * law,
                   "  ten times as far, the share of those");
    }
    shape_release(&ball);
}

/* --- row EX-30: what clusters leave out is not seen ------------------------------------------------------------- */

typedef struct cull_case {
    const char *name;
    int         shape; /* 0: ball; 1: torus; 2: an open terrain; 3: the ball's shell without its top */
    shot_view   view;
    bool        turned, beside, dense; /* some must be left out for this, and else none */
} cull_case;

static void make_case_shape(shape *s, int which)
{
    if (which == 1)
        shape_torus(s, "torus", 1, 0.35, 40, 20);
    else if (which == 2)
        shape_terrain(s, "terrain", 1.2, 0.3, 16, 3);
    else
        shape_sphere(s, "ball", (dvec){0, 0, 0}, 1, 20, 30, true);
    if (which == 3) { /* without half of its triangles */
        shape_part *p = &s->parts[0];
        p->index_count = p->index_count / 2 / 3 * 3;
    }
    if (which == 1 || which == 2)
        shape_make_normals(s, 60);
}

/* The picture is the same, value by value, whether clusters are left out or not; and each reason leaves some out where
 * it holds, and none where it does not: what turns away is seen of surfaces that are open, or from within. */
static void culled(void)
{
    static const char *const techniques[] = {
        "stipple\",\"texture\":0,\"shadow\":0.3,\"light\":0.8,\"count\":12000,\"diameter\":2",
        "strokes\",\"texture\":0,\"light\":0.8,\"placed\":\"planes\",\"count\":6000,\"width\":1.5",
        "lines\",\"texture\":0,\"light\":0.8,\"count\":60,\"scale\":5"};
    const dvec      up = {0, 1, 0}, none = {0, 0, 0};
    const cull_case cases[] = {
        {"whole", 0, {SIDE, SIDE, {0.5, 1, 4}, none, up, .fov_deg = 32, .without_maps = true}, true, false, false},
        {"near",
         0,
         {SIDE, SIDE, {0, 0.4, 1.5}, {0, 0.3, 0}, up, .fov_deg = 25, .without_maps = true},
         true,
         true,
         false},
        {"far", 1, {SIDE, SIDE, {1, 30, 60}, none, up, .fov_deg = 15, .without_maps = true}, true, false, true},
        {"parallel",
         1,
         {SIDE, SIDE, {1, 3, 2}, none, up, .orthographic = true, .without_maps = true},
         true,
         false,
         false},
        {"inside",
         0,
         {SIDE, SIDE, {0.2, 0.1, 0.3}, {1, 0, 0}, up, .fov_deg = 60, .without_maps = true},
         false,
         true,
         false},
        {"open", 2, {SIDE, SIDE, {0.3, -2, -1}, none, up, .fov_deg = 75, .without_maps = true}, false, false, false},
        {"shell", 3, {SIDE, SIDE, {0.5, -4, -2}, none, up, .fov_deg = 32, .without_maps = true}, false, false, false},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        shape s = {0};
        make_case_shape(&s, cases[c].shape);
        for (int t = 0; t < 3; t++) {
            char keys[200];
            shot with, without;
            snprintf(keys, sizeof keys, "%s,\"cull\":false", techniques[t]);
            if (!shot_of_shape(&with, &s, "culled.ply", halftone_look(techniques[t]), NULL, &cases[c].view))
                return;
            if (shot_of_shape(&without, &s, "culled.ply", halftone_look(keys), NULL, &cases[c].view)) {
                told now = told_of(&with), all = told_of(&without);
                check_at_most("EX-30", shot_differing(&with, &without, 0), 0, "%s, %.7s: values that differ",
                              cases[c].name, techniques[t]);
                check_at_least("EX-30", halftone_mean(&with, 0, 0, SIDE, SIDE), 0.0005, "  ink");
                check_near("EX-30", all.drawn, all.there, 0, "  all are drawn without");
                check_that("EX-30",
                           (now.turned_away > 0 || (t == 2 && cases[c].turned)) >= cases[c].turned &&
                               (now.turned_away == 0 || cases[c].turned),
                           "  %.0f of %.0f turn away", now.turned_away, now.there);
                check_that("EX-30", (now.off_page > 0) == cases[c].beside, "  %.0f are off the page", now.off_page);
                check_that("EX-30", now.too_dense > 0 || !cases[c].dense || t == 2, "  %.0f are too dense",
                           now.too_dense);
                check_that("EX-30", now.clusters > 3 && now.clusters_drawn <= now.clusters, "  %.0f of %.0f clusters",
                           now.clusters_drawn, now.clusters);
                shot_release(&without);
            }
            shot_release(&with);
        }
        shape_release(&s);
    }
}

/* --- rows EX-11, EX-13, EX-29: layouts, native lines, ways to leave strokes out ---------------------------------- */

static bool draw_strokes(shot *out, const char *more)
{
    static char keys[400];
    shot_view   view = view_of(1.2, 0.8, 3, 36);
    snprintf(
        keys, sizeof keys,
        "strokes\",\"texture\":0,\"placed\":\"planes\",\"count\":3000,\"length\":0.08,\"series\":2,\"shadow\":0.2%s%s",
        *more ? "," : "", more);
    shape ball = {0};
    shape_sphere(&ball, "ball", (dvec){0, 0, 0}, 1, 20, 30, true);
    bool ok = shot_of_shape(out, &ball, "laid-ball.ply", halftone_look(keys), NULL, &view);
    shape_release(&ball);
    return ok;
}

/* Numbers packed into 64 bytes, and records that are there once, give the picture of whole ones at each corner. */
static void layouts(void)
{
    static const char *const primitives[] = {"quads", "lines"}, *const names[] = {"corners", "packed", "instances"};
    static const double bytes[2][3] = {{4 * 80 + 24, 4 * 64 + 24, 64}, {2 * 80, 2 * 64, 64}};
    for (int p = 0; p < 2; p++) {
        shot whole = {0};
        for (int k = 0; k < 3; k++) {
            char keys[120];
            shot s;
            snprintf(keys, sizeof keys, "\"primitive\":\"%s\",\"layout\":\"%s\",\"width\":1.4", primitives[p],
                     names[k]);
            if (!draw_strokes(&s, keys))
                break;
            told t = told_of(&s);
            check_near("EX-29", t.bytes / fmax(t.there, 1), bytes[p][k], 0, "%s, %s: bytes a stroke's piece",
                       primitives[p], names[k]);
            if (k > 0) {
                check_at_most("EX-29", shot_differing(&whole, &s, 2), 0, "  values that differ by more than 2 of 255");
                shot_release(&s);
            } else {
                whole = s;
                check_at_least("EX-29", halftone_mean(&s, 0, 0, SIDE, SIDE), 0.02, "  ink");
            }
        }
        shot_release(&whole);
    }
}

/* Native lines are the strokes of quads a pixel wide: as much ink, and none elsewhere. A line one end of which is left
 * out and the other not would lead out of the picture. */
static void thin_lines(void)
{
    shot quads, lines;
    if (!draw_strokes(&quads, "\"width\":1,\"taper\":0.1"))
        return;
    if (draw_strokes(&lines, "\"width\":1,\"taper\":0.1,\"primitive\":\"lines\"")) {
        double a = halftone_mean(&quads, 0, 0, SIDE, SIDE), b = halftone_mean(&lines, 0, 0, SIDE, SIDE);
        int    stray = 0, missing = 0, inked = 0;
        for (int y = 2; y < SIDE - 2; y++)
            for (int x = 2; x < SIDE - 2; x++) {
                double near[2] = {0, 0};
                for (int k = 0; k < 9; k++) {
                    near[0] = fmax(near[0], halftone_ink(&quads, x + k % 3 - 1, y + k / 3 - 1));
                    near[1] = fmax(near[1], halftone_ink(&lines, x + k % 3 - 1, y + k / 3 - 1));
                }
                inked += halftone_ink(&lines, x, y) > 0.1;
                stray += halftone_ink(&lines, x, y) > 0.1 && near[0] < 0.02;
                missing += halftone_ink(&quads, x, y) > 0.6 && near[1] < 0.1;
            }
        check_at_least("EX-11", inked, 2000, "pixels of native lines");
        check_near("EX-11", b, a, 0.12 * a, "their ink, against quads a pixel wide");
        check_at_most("EX-11", stray, 0, "pixels of them beside all quads");
        check_at_most("EX-11", missing, inked / 500, "pixels of quads without one");
        shot_release(&lines);
    }
    shot_release(&quads);
}

/* Whichever way strokes are left out, the same ones are seen. */
static void hidings(void)
{
    static const char *const ways[] = {"outside", "winding", "width", "depth", "discard", "alpha"};
    shot                     first = {0};
    for (int k = 0; k < 6; k++) {
        char keys[80];
        shot s;
        snprintf(keys, sizeof keys, "\"width\":2,\"hiding\":\"%s\",\"cull\":false", ways[k]);
        if (!draw_strokes(&s, keys))
            break;
        double ink = halftone_mean(&s, 0, 0, SIDE, SIDE);
        check_that("EX-13", ink > 0.02 && ink < 0.6, "%s: ink %.4f", ways[k], ink);
        if (k > 0) {
            check_at_most("EX-13", shot_differing(&first, &s, 0), 0, "  values that differ from outside");
            shot_release(&s);
        } else {
            first = s;
        }
    }
    shot_release(&first);
}

/* --- row IM-34: grass ------------------------------------------------------------------------------------------- */

static const shot_view meadow_view = {
    .width = SIDE, .height = SIDE, .eye = {0, -4, 4}, .up = {0, 1, 0}, .fov_deg = 24, .without_maps = true};

/* Where a position is in that view: pixels from the left and from the top. */
static void meadow_pixel(double x, double y, double z, double out[2])
{
    const double half = sqrt(0.5), size = 2 * tan(12 * 3.14159265358979 / 180);
    double       depth = half * (y + 4) - half * (z - 4), up = half * (y + 4) + half * (z - 4);
    out[0] = SIDE * (0.5 + x / (depth * size));
    out[1] = SIDE * (0.5 - up / (depth * size));
}

/* A meadow of side 2 in the plane z = 0, and a lid over it, whose shadow falls to the right and up: light
 * comes from the left of the viewer. */
static bool draw_meadow(shot *out, const char *more, bool shadows)
{
    char           keys[400], scene[120];
    halftone_scene s = {0};
    halftone_add_wall(&s, "meadow", (halftone_wall){-1, -1, 0, 2, 2, 1});
    halftone_add_wall(&s, "lid", (halftone_wall){-1, -0.4, 0.6, 0.8, 0.8, 1});
    snprintf(keys, sizeof keys,
             "strokes\",\"placed\":\"grass\",\"upright\":0,\"texture\":0,\"count\":24000,\"length\":0.02,\"width\":1.5,"
             "\"scale\":1.2,\"shadow\":0.1,\"light\":1.4,\"fade\":0.02%s",
             more);
    snprintf(scene, sizeof scene, "\"fill\":0,\"light_direction\":\"-1,0,1\"%s", shadows ? ",\"shadows\":true" : "");
    bool ok = halftone_shot(out, &s, "meadow.gltf", halftone_look_with(keys, scene, ""), NULL, &meadow_view);
    halftone_release(&s);
    return ok;
}

/* What is inked in a part of the meadow: mean; `grey`: the share of inked pixels that are not nearly black, `paper`: of
 * all that have no ink. */
static double meadow_ink(const shot *s, const double box[4], double *grey, double *paper)
{
    double ink = 0, inked = 0, greys = 0, all = 0;
    for (double y = box[1]; y < box[3]; y += 0.004)
        for (double x = box[0]; x < box[2]; x += 0.004) {
            double at[2];
            meadow_pixel(x, y, 0, at);
            double own = halftone_ink(s, (int)at[0], (int)at[1]);
            ink += own;
            inked += own > 0.02;
            greys += own > 0.02 && own < 0.5;
            all++;
        }
    *grey = greys / fmax(inked, 1);
    *paper = 1 - inked / all;
    return ink / all;
}

/* In the shadow there are more blades, each as black as in the light, and paper is left between them; no blade of the
 * light is lost. Blades stand: seen from aside they look over the border. */
static void grass(void)
{
    static const double shade[4] = {-0.05, 0.4, 0.5, 0.9}, aside[4] = {0.4, -0.9, 0.95, 0};
    shot                lit, shadowed;
    double              grey[2], paper[2];
    if (!draw_meadow(&lit, "", false))
        return;
    if (draw_meadow(&shadowed, "", true)) {
        double before = meadow_ink(&lit, shade, &grey[0], &paper[0]),
               after = meadow_ink(&shadowed, shade, &grey[1], &paper[1]);
        int lost = 0, over = 0;
        for (int i = 0; i < SIDE * SIDE; i++)
            lost += halftone_ink(&lit, i % SIDE, i / SIDE) > 0.9 && halftone_ink(&shadowed, i % SIDE, i / SIDE) < 0.5;
        check_at_least("IM-34", before, 0.02, "ink of grass in the light");
        check_at_least("IM-34", after - before, 0.2, "more of it in the shadow");
        check_at_least("IM-34", paper[1], 0.03, "paper between blades there");
        check_at_most("IM-34", grey[1], grey[0] + 0.05,
                      "share of inked pixels that are grey, no more than in the light");
        check_at_most("IM-34", lost, 0, "blades that the shadow takes away");
        before = meadow_ink(&lit, aside, &grey[0], &paper[0]);
        after = meadow_ink(&shadowed, aside, &grey[1], &paper[1]);
        check_near("IM-34", after, before, 0.004, "ink elsewhere stays");
        check_at_most("IM-34", grey[0], 0.45, "share of inked pixels that are grey in the light");
        double corner[2], lid[2];
        meadow_pixel(0, 1, 0, corner);
        meadow_pixel(-0.2, 0.4, 0.6, lid);
        for (int y = 0; y < (int)corner[1] - 1; y++)
            for (int x = (int)lid[0] + 10; x < SIDE; x++) /* right of the lid and its blades */
                over += halftone_ink(&shadowed, x, y) > 0.3;
        check_that("IM-34", over > 60, "%d pixels of blades look over the far border", over);
        shot_release(&shadowed);
    }
    shot_release(&lit);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"tones", tones},
        {"tone_over_distance", tone_over_distance},
        {"strokes_over_distance", strokes_over_distance},
        {"same_set", same_set},
        {"told", marks_are_told},
        {"culled", culled},
        {"layouts", layouts},
        {"thin_lines", thin_lines},
        {"hidings", hidings},
        {"grass", grass},
        {"stays_put", stays_put},
        {"sizes", sizes},
        {"widths", widths},
        {"points_and_quads", points_and_quads},
        {"at_the_rim", at_the_rim},
        {"hidden", hidden},
        {"uncut", uncut},
    };
    halftone_begin_kept("stipple");
    int status = check_main(argc, argv, "stipple", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
