/* Strokes in the window: how wide, how whole, and nothing of what is hidden, in both ways of drawing them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "feature.h"
#include "picture.h"
#include "scenes.h"
#include "shape.h"
#include "shot.h"

#define PI 3.14159265358979323846

static const char *const modes[] = {"sampled", "exact"};

/* Black strokes on white. */
static const char *look_of(const char *mode, double width, const char *more)
{
    static char texts[4][640];
    static int  next;
    char       *text = texts[next++ % 4];
    snprintf(text, sizeof texts[0],
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{\"technique\":"
             "\"flat\",\"colour\":\"#ffffff\"},\"lines\":"
             "{\"operator\":\"strokes\",\"colour\":\"#000000\",\"crease_width\":1,\"intersections\":false,\"detail\":1,"
             "\"visibility\":\"%s\",\"width\":%g%s}}]}",
             mode, width, more);
    return text;
}

static double darkness(const shot *s, int x, int y)
{
    return x < 0 || y < 0 || x >= s->width || y >= s->height ? 0
                                                             : 1 - picture_shown(s->picture[4 * (y * s->width + x)]);
}

/* Between the middles of pixels. */
static double darkness_at(const shot *s, double x, double y)
{
    int    column = (int)floor(x - 0.5), row = (int)floor(y - 0.5);
    double u = x - 0.5 - column, v = y - 0.5 - row;
    return (1 - v) * ((1 - u) * darkness(s, column, row) + u * darkness(s, column + 1, row)) +
           v * ((1 - u) * darkness(s, column, row + 1) + u * darkness(s, column + 1, row + 1));
}

/* Width of the ink across a line at a position, as far as `reach` on both sides. */
static double width_at(const shot *s, dvec at, dvec along, double reach)
{
    double       sum = 0;
    const double step = 0.125;
    for (double t = -reach; t <= reach; t += step)
        sum += darkness_at(s, at.x - along.y * t, at.y + along.x * t) * step;
    return sum;
}

static dvec direction_of(dvec a, dvec b)
{
    return dvec_unit(dvec_of(b.x - a.x, b.y - a.y, 0));
}

static bool on_page(const shot *s, dvec at, double margin)
{
    return at.z > 0 && at.x > margin && at.y > margin && at.x < s->width - margin && at.y < s->height - margin;
}

/* --- width ---------------------------------------------------------------------------------------------- */

/* A triangle of which one border is measured; the others are far from it. */
static void sail_of(shape *s)
{
    shape_part *p = shape_add(s, "sail", 3, 3, false, false);
    const float corners[3][3] = {{-3, 0, 0}, {3, 0, 0}, {0, 6, 0}};
    memcpy(p->positions, corners, sizeof corners);
    memcpy(p->indices, (uint32_t[]){0, 1, 2}, 3 * sizeof(uint32_t));
}

/* Does another border come near? */
static bool is_crowded(const shot *s, dvec at, double reach)
{
    for (int i = 0; i <= 200; i++)
        for (int side = -1; side <= 1; side += 2) {
            dvec other = shot_project(s, dvec_of(3.0 * side * (1 - i / 200.0), 6 * i / 200.0, 0));
            if (other.z > 0 && hypot(other.x - at.x, other.y - at.y) < reach)
                return true;
        }
    return false;
}

/* The worst and the mean difference from the width that was asked for, along the first border. */
static void measure_width(const shot *s, double width, double *worst, double *mean, int *count)
{
    for (int i = 0; i <= 40; i++) {
        double t = -2.2 + 4.4 * i / 40;
        dvec   at = shot_project(s, dvec_of(t, 0, 0)), next = shot_project(s, dvec_of(t + 1e-4, 0, 0));
        if (!on_page(s, at, width) || next.z <= 0 || is_crowded(s, at, width + 8))
            continue;
        double off = width_at(s, at, direction_of(at, next), width / 2 + 2) - width;
        *worst = fmax(*worst, fabs(off));
        *mean += off;
        ++*count;
    }
}

static void widths(void)
{
    static const int    sizes[][2] = {{400, 400}, {640, 200}, {200, 640}};
    static const double wanted[] = {0.7, 1, 2, 3.3, 8, 20};
    shape               s = {0};
    sail_of(&s);
    for (int mode = 0; mode < 2; mode++)
        for (size_t w = 0; w < sizeof wanted / sizeof *wanted; w++) {
            double worst = 0, mean = 0;
            int    count = 0;
            for (int i = 0; i < 24; i++) {
                double    turn = i * PI / 12 + 0.03, tilt = 0.5 * (i % 3);
                shot_view view = {.width = sizes[i % 3][0],
                                  .height = sizes[i % 3][1],
                                  .eye = {0.3, 7 * sin(tilt), 9 * cos(tilt)},
                                  .up = {sin(turn), cos(turn), 0.1},
                                  .orthographic = i % 4 == 3,
                                  .without_maps = true};
                shot      t;
                if (shot_of_shape(&t, &s, "sail.ply", look_of(modes[mode], wanted[w], ""), NULL, &view))
                    measure_width(&t, wanted[w], &worst, &mean, &count);
                shot_release(&t);
            }
            check_at_least("EX-12", count, 300, "%s: places measured", modes[mode]);
            check_at_most("EX-12", worst, 0.25,
                          "%s: width %g at any angle and aspect, px off at worst (%.3f on average)", modes[mode],
                          wanted[w], mean / count);
        }
    shape_release(&s);
}

/* Fraction of a pixel that lies within half a width of a line, by a grid of positions in it. */
static double exact_cover(double x, double y, dvec at, dvec along, double width)
{
    enum { SIDE = 64 };
    int inside = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double px = x + (i % SIDE + 0.5) / SIDE - at.x, py = y + (i / SIDE + 0.5) / SIDE - at.y;
        inside += fabs(px * along.y - py * along.x) <= width / 2;
    }
    return (double)inside / (SIDE * SIDE);
}

/* The edge map around the first border against what covers each pixel. */
static void measure_cover(const shot *s, double width, double *worst, double *ink, double *wanted, int *count)
{
    dvec from = shot_project(s, dvec_of(-2, 0, 0)), to = shot_project(s, dvec_of(2, 0, 0)),
         along = direction_of(from, to);
    double length = hypot(to.x - from.x, to.y - from.y);
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double ahead = (x + 0.5 - from.x) * along.x + (y + 0.5 - from.y) * along.y,
                   aside = (x + 0.5 - from.x) * along.y - (y + 0.5 - from.y) * along.x;
            if (ahead < 0 || ahead > length || fabs(aside) > width / 2 + 2 ||
                is_crowded(s, dvec_of(x + 0.5, y + 0.5, 1), width + 8))
                continue;
            double cover = exact_cover(x, y, from, along, width), own = 1 - s->edge[4 * (y * s->width + x)] / 255.0;
            *worst = fmax(*worst, fabs(own - cover));
            *ink += own;
            *wanted += cover;
            ++*count;
        }
}

/* Rims cover each pixel as much as they do, at one sample; what is thinner than a pixel keeps its area. */
static void rims(void)
{
    static const double widths_of[] = {0.5, 0.7, 1, 2, 3.3, 6};
    shape               s = {0};
    sail_of(&s);
    for (int mode = 0; mode < 2; mode++)
        for (size_t w = 0; w < sizeof widths_of / sizeof *widths_of; w++) {
            double worst = 0, ink = 0, wanted = 0;
            int    count = 0;
            for (int i = 0; i < 12; i++) {
                double    turn = i * PI / 13 + 0.05;
                shot_view view = {.width = 320,
                                  .height = 320,
                                  .eye = {0.3, 0.2, 12},
                                  .up = {sin(turn), cos(turn), 0.1},
                                  .orthographic = i % 2 == 1};
                shot      t;
                if (shot_of_shape(&t, &s, "sail.ply", look_of(modes[mode], widths_of[w], ""), NULL, &view))
                    measure_cover(&t, widths_of[w], &worst, &ink, &wanted, &count);
                shot_release(&t);
            }
            check_at_least("EX-12", count, 3000, "%s: pixels measured", modes[mode]);
            check_at_most("EX-12", worst, 0.02, "%s: width %g, cover of a pixel off at worst", modes[mode],
                          widths_of[w]);
            check_at_most("EX-12", fabs(ink / wanted - 1), 0.01, "%s: width %g, ink off", modes[mode], widths_of[w]);
        }
    shape_release(&s);
}

/* The border runs from far away to behind the viewer. */
static void near_plane(void)
{
    shape s = {0};
    sail_of(&s);
    for (int mode = 0; mode < 2; mode++) {
        double worst = 0, mean = 0;
        int    count = 0;
        for (int i = 0; i < 16; i++) {
            double    height = 0.05 + 0.05 * i, side = i % 2 ? -1 : 1; /* either end is behind the viewer */
            shot_view view = {.width = 400,
                              .height = 300,
                              .eye = {1.5 * side, -height, 0.3 * height},
                              .target = {-2 * side, 0.1 * i, 0},
                              .up = {0, 0.2, 1},
                              .fov_deg = 70,
                              .without_maps = true};
            shot      t;
            if (shot_of_shape(&t, &s, "sail.ply", look_of(modes[mode], 5, ""), NULL, &view))
                measure_width(&t, 5, &worst, &mean, &count);
            shot_release(&t);
        }
        check_at_least("EX-12", count, 60, "%s: places measured before a near plane that the line crosses",
                       modes[mode]);
        check_at_most("EX-12", worst, 0.25, "%s: width, px off at worst", modes[mode]);
    }
    shape_release(&s);
}

/* --- whole ---------------------------------------------------------------------------------------------- */

/* A fan of triangles whose border zigzags. */
static void star_of(shape *s)
{
    enum { POINTS = 14 };
    shape_part *p = shape_add(s, "star", 2 * POINTS + 1, 6 * POINTS, false, false);
    for (int i = 0; i < 2 * POINTS; i++) {
        double turn = i * PI / POINTS, r = i % 2 ? 0.9 : 2;
        memcpy(p->positions[i], (float[]){(float)(r * cos(turn)), (float)(r * sin(turn)), 0}, sizeof p->positions[i]);
        memcpy(&p->indices[3 * i], (uint32_t[]){(uint32_t)i, (uint32_t)((i + 1) % (2 * POINTS)), 2 * POINTS},
               3 * sizeof(uint32_t));
    }
    memset(p->positions[2 * POINTS], 0, sizeof p->positions[0]);
}

/* The lightest position within `radius` of a joint. */
static double least_ink(const shot *s, dvec at, double radius)
{
    double least = 1;
    for (int y = (int)(at.y - radius) - 1; y <= at.y + radius + 1; y++)
        for (int x = (int)(at.x - radius) - 1; x <= at.x + radius + 1; x++)
            if (hypot(x + 0.5 - at.x, y + 0.5 - at.y) <= radius)
                least = fmin(least, darkness(s, x, y));
    return least;
}

static void joints(void)
{
    static const double wanted[] = {2, 4, 9, 16, 32};
    shape               s = {0};
    star_of(&s);
    shot_view view = {.width = 500, .height = 500, .eye = {1, 0.5, 9}, .up = {0.2, 1, 0}, .without_maps = true};
    for (int mode = 0; mode < 2; mode++)
        for (size_t w = 0; w < sizeof wanted / sizeof *wanted; w++) {
            double least = 1;
            shot   t;
            if (shot_of_shape(&t, &s, "star.ply", look_of(modes[mode], wanted[w], ",\"cover\":1"), NULL, &view))
                for (uint32_t i = 0; i < s.parts[0].vertex_count - 1; i++)
                    least =
                        fmin(least, least_ink(&t, shot_project(&t, shape_point(&s.parts[0], i)), wanted[w] / 2 - 0.5));
            /* A gap of half a pixel would leave a pixel half as dark. */
            check_at_least("OE-08", least, 0.9, "%s: ink around joints, to half a pixel from the rim, width %g",
                           modes[mode], wanted[w]);
            shot_release(&t);
        }
    shape_release(&s);
}

/* How much ink there is at least along what a perfect observer sees, within a pixel and a half. */
static double whole_along(const feature_lines *f, const shot *s, double limit)
{
    size_t whole = 0;
    for (size_t i = 0; i < f->sample_count; i++) {
        double most = 0;
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                most = fmax(most, darkness(s, (int)floor(f->samples[i].x) + x, (int)floor(f->samples[i].y) + y));
        whole += most >= limit;
    }
    return f->sample_count ? (double)whole / (double)f->sample_count : 0;
}

/* The fraction of ink that is farther from every visible line than a stroke is wide. */
static double stray_ink(const feature_lines *f, const shot *s, double reach)
{
    size_t ink = 0, stray = 0;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            if (darkness(s, x, y) < 0.5)
                continue;
            double nearest = INFINITY;
            for (size_t i = 0; i < f->sample_count; i++)
                nearest = fmin(nearest, hypot(x + 0.5 - f->samples[i].x, y + 0.5 - f->samples[i].y));
            ink++;
            stray += nearest > reach;
        }
    return ink ? (double)stray / (double)ink : 0;
}

static void box_scene(shape *s)
{
    shape_box(s, "box", dvec_of(-1.2, -1, -1.1), dvec_of(1.1, 0.9, 1.2));
}

static void sphere_scene(shape *s)
{
    shape_sphere(s, "ball", dvec_of(0, 0, 0), 1.4, 48, 96, false);
}

static void ring_scene(shape *s)
{
    shape_torus(s, "ring", 1.1, 0.45, 96, 48);
}

/* Boxes, balls and rings in front of each other that do not touch. */
static void crowd_scene(shape *s)
{
    shape_box(s, "wall", dvec_of(-0.3, -1.2, 0.9), dvec_of(1.1, 0.7, 1.1));
    shape_sphere(s, "ball", dvec_of(-0.9, 0.5, 0), 0.6, 32, 64, false);
    shape_torus(s, "ring", 0.7, 0.2, 64, 24);
    shape_place(s, dvec_of(1, 0.4, 0), 70, dvec_of(0.8, 0, -0.4));
    shape_box(s, "box", dvec_of(-1.4, -1.2, -1), dvec_of(-0.5, -0.4, 0.3));
}

static void whole_lines(void)
{
    static const struct {
        const char *name;
        void (*make)(shape *);
    } scenes[] = {{"box", box_scene}, {"sphere", sphere_scene}, {"ring", ring_scene}, {"crowd", crowd_scene}};
    static const double wanted[] = {1, 2, 5, 12, 32};
    for (int i = 0; i < 4; i++) {
        shape s = {0};
        scenes[i].make(&s);
        tracer *t = tracer_create(&s);
        char    file[40];
        snprintf(file, sizeof file, "%s.glb", scenes[i].name);
        for (int k = 0; k < 4; k++) {
            double    turn = 0.7 + 1.3 * k;
            shot_view view = {.width = 320,
                              .height = 320,
                              .eye = {7 * cos(turn), 2.5 + k, 7 * sin(turn)},
                              .up = {0, 1, 0},
                              .orthographic = k == 2,
                              .without_maps = true};
            for (size_t w = 0; w < sizeof wanted / sizeof *wanted; w++) {
                const int     mode = (int)(w + (size_t)k) % 2;
                shot          picture;
                feature_lines lines = {0};
                if (!shot_of_shape(&picture, &s, file, look_of(modes[mode], wanted[w], ""), NULL, &view)) {
                    shot_release(&picture);
                    continue;
                }
                feature_find(&lines, &s, t, &picture, 30);
                check_at_least("EX-14", whole_along(&lines, &picture, wanted[w] < 2 ? 0.4 : 0.9), 0.995,
                               "%s, view %d, %s: fraction of visible lines with whole ink, width %g", scenes[i].name, k,
                               modes[mode], wanted[w]);
                if (wanted[w] <= 5)
                    check_at_most("EX-14", stray_ink(&lines, &picture, wanted[w] / 2 + 2), 0.002,
                                  "%s, view %d, %s: fraction of ink of hidden lines", scenes[i].name, k, modes[mode]);
                feature_release(&lines);
                shot_release(&picture);
            }
        }
        tracer_destroy(t);
        shape_release(&s);
    }
}

/* Outlines keep their full width: the inner half lies on a surface that bends away, the outer one on nothing. */
static void full_width(void)
{
    static const double wanted[] = {2, 4, 8, 16, 32};
    shape               s = {0};
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1.4, 128, 256, false);
    for (int mode = 0; mode < 2; mode++)
        for (size_t w = 0; w < sizeof wanted / sizeof *wanted; w++) {
            shot_view view = {.width = 400,
                              .height = 400,
                              .eye = {1, 2, 7},
                              .up = {0, 1, 0},
                              .orthographic = w % 2,
                              .without_maps = true};
            shot      t;
            double    least = INFINITY, most = 0, radius = 0;
            if (shot_of_shape(&t, &s, "ball.glb", look_of(modes[mode], wanted[w], ",\"creases\":false"), NULL, &view)) {
                dvec middle = shot_project(&t, dvec_of(0, 0, 0));
                while (radius < 190 && darkness_at(&t, middle.x + radius, middle.y) < 0.5)
                    radius += 0.25;
                for (int i = 0; i < 180; i++) {
                    dvec out = dvec_of(cos(i * PI / 90), sin(i * PI / 90), 0),
                         at = dvec_of(middle.x + (radius + wanted[w] / 2) * out.x,
                                      middle.y + (radius + wanted[w] / 2) * out.y, 0);
                    double width = width_at(&t, at, dvec_of(-out.y, out.x, 0), wanted[w] / 2 + 6);
                    least = fmin(least, width);
                    most = fmax(most, width);
                }
            }
            check_at_least("EX-14", least, wanted[w] - 0.25, "%s: least width around a ball of an outline of width %g",
                           modes[mode], wanted[w]);
            check_at_most("EX-14", most, wanted[w] + 0.25, "%s: largest", modes[mode]);
            shot_release(&t);
        }
    shape_release(&s);
}

/* --- both ways ------------------------------------------------------------------------------------------ */

/* The fraction of ink of one picture that has none of the other within a pixel and a half. */
static double alone(const shot *a, const shot *b)
{
    size_t ink = 0, single = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            if (darkness(a, x, y) < 0.3)
                continue;
            bool near = false;
            for (int v = -1; v <= 1; v++)
                for (int u = -1; u <= 1; u++)
                    near = near || darkness(b, x + u, y + v) >= 0.15;
            ink++;
            single += !near;
        }
    return ink ? (double)single / (double)ink : 1;
}

static void both_ways(void)
{
    static const char *const models[] = {"gearbox.stl", "pump.glb", "crank.glb", "spot.obj", "house.glb"};
    for (int i = 0; i < 5; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", LIMNER_EXAMPLES, models[i]);
        shot              a, b;
        shot_view         view = {.width = 700, .height = 700, .bare = true, .without_maps = true};
        const char *const changes[] = {"lines.intersections", "true", NULL};
        bool              good = shot_take(&a, path, look_of("sampled", 2, ""), changes, &view);
        good = shot_take(&b, path, look_of("exact", 2, ",\"simplify\":0,\"shortest\":0"), changes, &view) && good;
        if (good) {
            check_at_most("EX-14", alone(&a, &b), 0.01, "%s: ink of sampled strokes that exact ones have not",
                          models[i]);
            check_at_most("EX-14", alone(&b, &a), 0.01, "%s: ink of exact strokes that sampled ones have not",
                          models[i]);
        }
        shot_release(&a);
        shot_release(&b);
    }
}

/* Bodies that run through each other, one of them mirrored, and through an open sheet: what crosses is found and
 * hidden alike, from everywhere. */
static void crossings(void)
{
    shape s = {0};
    shape_box(&s, "floor", dvec_of(-2, -1.2, -2), dvec_of(2, -1, 2));
    shape_box(&s, "box", dvec_of(-1.2, -1, -1.1), dvec_of(0.1, 0.6, 0.3)); /* stands on it */
    shape_sphere(&s, "ball", dvec_of(0, 0.4, 0), 0.8, 24, 48, false);
    shape_torus(&s, "ring", 0.9, 0.3, 48, 24);
    shape_place(&s, dvec_of(1, 0.4, 0), 70, dvec_of(0.6, -0.5, 0.3));
    for (int k = 0; k < 3; k++)
        s.parts[s.count - 1].matrix[k] *= -1;
    shape_quad(&s, "sheet", 1.6, -0.4);
    const char *const changes[] = {"lines.intersections", "true", NULL};
    for (int k = 0; k < 8; k++) {
        shot_view view = {.width = 500,
                          .height = 500,
                          .eye = {7 * cos(k), 4.0 - k, 7 * sin(k)},
                          .up = {0, 1, 0},
                          .orthographic = k % 2,
                          .without_maps = true};
        shot      a, b;
        bool      good = shot_of_shape(&a, &s, "crossings.glb", look_of("sampled", 2, ""), changes, &view);
        good = shot_of_shape(&b, &s, "crossings.glb", look_of("exact", 2, ",\"simplify\":0,\"shortest\":0"), changes,
                             &view) &&
               good;
        if (good) {
            check_at_most("EX-14", alone(&a, &b), 0.01,
                          "crossings, view %d: ink of sampled strokes that exact ones have not", k);
            check_at_most("EX-14", alone(&b, &a), 0.005,
                          "crossings, view %d: ink of exact strokes that sampled ones have not", k);
        }
        shot_release(&a);
        shot_release(&b);
    }
    shape_release(&s);
}

/* Lines of the file on a barrel that is divided otherwise, on its lid, below it and beside it. */
static const char *write_lines(void)
{
    enum { SIDES = 24, AROUND = 40 };
    static char path[512];
    snprintf(path, sizeof path, "%s", check_path("lines.obj"));
    FILE *file = fopen(path, "w");
    if (!file)
        return NULL;
    fprintf(file, "o barrel\n");
    for (int i = 0; i < 2 * SIDES; i++)
        fprintf(file, "v %.9g %d %.9g\n", cos(2 * PI * (i % SIDES) / SIDES), i < SIDES ? -1 : 1,
                sin(2 * PI * (i % SIDES) / SIDES));
    for (int i = 0; i < AROUND; i++)
        fprintf(file, "v %.9g 0.3 %.9g\n", cos(2 * PI * i / AROUND + 0.1), sin(2 * PI * i / AROUND + 0.1));
    fprintf(file, "v -0.5 1 0.2\nv 0.6 1 -0.1\nv -0.5 -1 0.2\nv 0.6 -1 -0.1\nv 1.3 -1 0\nv 1.3 1 0\n");
    for (int i = 0; i < SIDES; i++)
        fprintf(file, "f %d %d %d %d\n", i + 1, SIDES + i + 1, SIDES + (i + 1) % SIDES + 1, (i + 1) % SIDES + 1);
    for (int lid = 0; lid < 2; lid++) {
        fprintf(file, "f");
        for (int i = 0; i < SIDES; i++)
            fprintf(file, " %d", lid ? 2 * SIDES - i : i + 1);
        fprintf(file, "\n");
    }
    fprintf(file, "o wire\nl");
    for (int i = 0; i <= AROUND; i++)
        fprintf(file, " %d", 2 * SIDES + i % AROUND + 1);
    fprintf(file, "\nl -6 -5\nl -4 -3\nl -2 -1\n");
    return fclose(file) == 0 ? path : NULL;
}

/* On the surface of another figure, lines are not broken by it. */
static void lines_on_figures(const char *path, const shot_view *view, int number)
{
    static const char *const start =
        "{\"version\":1,\"name\":\"two\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{\"technique\":"
        "\"flat\",\"colour\":\"#ffffff\"}},{\"select\":\"wire\",\"surface\":\"flat\",\"lines\":{\"operator\":"
        "\"strokes\","
        "\"width\":2,\"crease_width\":1,\"detail\":1,\"simplify\":0,\"shortest\":0,\"visibility\":";
    shot shots[2];
    bool good = true;
    for (int mode = 0; mode < 2; mode++) {
        char look[1024];
        snprintf(look, sizeof look, "%s\"%s\"}}]}", start, modes[mode]);
        good = shot_take(&shots[mode], path, look, NULL, view) && good;
    }
    for (int mode = 0; mode < 2 && good; mode++)
        check_at_most("EX-14", alone(&shots[mode], &shots[!mode]), 0.01,
                      "lines on another figure, view %d: ink of %s strokes that the others have not", number,
                      modes[mode]);
    shot_release(&shots[0]);
    shot_release(&shots[1]);
}

static void lines_of_files(void)
{
    const char *path = write_lines();
    for (int k = 0; k < 6 && path; k++) {
        shot_view view = {.width = 500,
                          .height = 500,
                          .eye = {6 * cos(k), 3.5 - k, 6 * sin(k)},
                          .up = {0, 1, 0},
                          .orthographic = k % 2,
                          .without_maps = true};
        shot      a, b, none;
        bool      good = shot_take(&a, path, look_of("sampled", 2, ""), NULL, &view);
        good = shot_take(&b, path, look_of("exact", 2, ",\"simplify\":0,\"shortest\":0"), NULL, &view) && good;
        good = shot_take(&none, path, look_of("sampled", 2, ",\"drawn\":false"), NULL, &view) && good;
        if (good) {
            check_at_least("OE-05", alone(&a, &none), 0.15, "view %d: ink of lines that the file brings", k);
            check_at_most("EX-14", alone(&a, &b), 0.01,
                          "lines of files, view %d: ink of sampled strokes that exact ones have not", k);
            check_at_most("EX-14", alone(&b, &a), 0.01,
                          "lines of files, view %d: ink of exact strokes that sampled ones have not", k);
        }
        lines_on_figures(path, &view, k);
        shot_release(&a);
        shot_release(&b);
        shot_release(&none);
    }
}

/* --- what is at the edge of sense ----------------------------------------------------------------------- */

static size_t count_ink(const shot *s)
{
    size_t ink = 0;
    for (int i = 0; i < s->width * s->height; i++)
        ink += darkness(s, i % s->width, i / s->width) > 0.02;
    return ink;
}

static void limits(void)
{
    shot_view view = {.width = 200, .height = 160, .eye = {2, 2, 6}, .up = {0, 1, 0}, .without_maps = true};
    for (int mode = 0; mode < 2; mode++) {
        shape s = {0};
        shot  t;
        sphere_scene(&s);
        if (shot_of_shape(&t, &s, "plain.glb", look_of(modes[mode], 2, ",\"contours\":\"none\""), NULL, &view))
            check_at_most("OE-03", (double)count_ink(&t), 0, "%s: a smooth ball without outlines has no line",
                          modes[mode]);
        shot_release(&t);
        shape_release(&s);
        sail_of(&s);
        if (shot_of_shape(&t, &s, "one.glb", look_of(modes[mode], 2, ""), NULL, &view))
            check_at_least("OE-05", (double)count_ink(&t), 200, "%s: one triangle has three borders", modes[mode]);
        shot_release(&t);
        if (shot_of_shape(&t, &s, "one.glb", look_of(modes[mode], 2, ",\"borders\":false"), NULL, &view))
            check_at_most("OE-05", (double)count_ink(&t), 0, "%s: and none where borders are not wanted", modes[mode]);
        shot_release(&t);
        shape_release(&s);
    }
}

/* A ball with lines, half behind a plate of another rule that has none, half in front of another plate. */
static void figures(void)
{
    shape s = {0};
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, false);
    shape_box(&s, "plate", dvec_of(-2, -2, 1.2), dvec_of(0, 2, 1.3));
    shape_box(&s, "back", dvec_of(-0.2, -2, -1.5), dvec_of(2, 2, -1.3));
    for (int mode = 0; mode < 2; mode++) {
        char look[900];
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{"
                 "\"technique\":\"flat\",\"colour\":\"#ffffff\"}},"
                 "{\"select\":\"ball\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{"
                 "\"operator\":\"strokes\",\"colour\":\"#000000\",\"width\":10,"
                 "\"visibility\":\"%s\"}}]}",
                 modes[mode]);
        shot_view view = {.width = 300,
                          .height = 300,
                          .eye = {0, 0, 12},
                          .up = {0, 1, 0},
                          .orthographic = true,
                          .without_maps = true};
        shot      t;
        if (shot_of_shape(&t, &s, "figures.glb", look, NULL, &view)) {
            dvec middle = shot_project(&t, dvec_of(0, 0, 0)), right = shot_project(&t, dvec_of(1, 0, 0)),
                 top = shot_project(&t, dvec_of(0.6, 0.8, 0));
            double covered = 0;
            for (int y = 0; y < t.height; y++)
                for (int x = 0; x < (int)middle.x - 1; x++)
                    covered = fmax(covered, darkness(&t, x, y));
            check_at_most("EX-14", covered, 0, "%s: ink on a plate of another rule in front", modes[mode]);
            check_near("EX-14", width_at(&t, right, dvec_of(0, 1, 0), 12), 10, 0.25,
                       "%s: width in front of a plate of another rule", modes[mode]);
            check_near("EX-14", width_at(&t, top, dvec_of(0.8, 0.6, 0), 12), 10, 0.25, "%s: and higher up",
                       modes[mode]);
        }
        shot_release(&t);
    }
    shape_release(&s);
}

/* More samples a pixel: lines of the same width, smoother. ES: the same picture. */
static void samples_and_dialects(void)
{
    shape s = {0};
    crowd_scene(&s);
    for (int mode = 0; mode < 2; mode++) {
        shot_view   view = {.width = 240, .height = 240, .eye = {4, 3, 6}, .up = {0, 1, 0}, .without_maps = true};
        shot        one, four, es;
        const char *look = look_of(modes[mode], 3, "");
        bool        good = shot_of_shape(&one, &s, "crowd.glb", look, NULL, &view);
        view.samples = 4;
        good = shot_of_shape(&four, &s, "crowd.glb", look, NULL, &view) && good;
        view.samples = 1;
        view.es = true;
        good = shot_of_shape(&es, &s, "crowd.glb", look, NULL, &view) && good;
        double ink[2] = {0, 0};
        for (int i = 0; i < 240 * 240 && good; i++) {
            ink[0] += darkness(&one, i % 240, i / 240);
            ink[1] += darkness(&four, i % 240, i / 240);
        }
        if (good) {
            check_near("EX-12", ink[1] / ink[0], 1, 0.03,
                       "%s: ink with four samples a pixel, as a fraction of that with one", modes[mode]);
            check_at_most("EX-12", shot_differing(&one, &es, 2), 20, "%s: values that differ between desktop GL and ES",
                          modes[mode]);
        }
        shot_release(&one);
        shot_release(&four);
        shot_release(&es);
    }
    shape_release(&s);
}

/* --- valleys -------------------------------------------------------------------------------------------- */

/* A valley between two steep walls that are so broad on the page and bend once, as between two columns. */
static void valley_of(shape *s, double left, double right, double height)
{
    const float x[7] = {-3, (float)(-2 * left), (float)-left, 0, (float)right, (float)(2 * right), 3},
                h = (float)height, z[7] = {1.5F * h, 1.5F * h, h, 0, h, 1.5F * h, 1.5F * h};
    shape_part *p = shape_add(s, "valley", 14, 36, false, false);
    for (uint32_t i = 0; i < 7; i++)
        for (uint32_t k = 0; k < 2; k++) {
            const float at[3] = {x[i], k ? 3 : -3, z[i]};
            memcpy(p->positions[2 * i + k], at, sizeof at);
        }
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t a = 2 * i, quad[6] = {a, a + 2, a + 3, a, a + 3, a + 1};
        memcpy(p->indices + 6 * i, quad, sizeof quad);
    }
}

/* The line at the bottom of narrow walls is whole, whatever its slant. */
static void valleys(void)
{
    const shot_view view = {.width = 300, .height = 300, .eye = {0, 0, 10}, .up = {0.12, 1, 0}, .orthographic = true};
    for (int k = 1; k <= 8; k++) {
        shape  s = {0};
        shot   drawing;
        double pixels = 0.4 * k, pixel = 2 * 10 * tan(15 * PI / 180) / 300;
        valley_of(&s, pixels * pixel, 0.7 * pixels * pixel, 1);
        if (shot_of_shape(&drawing, &s, "valley.ply", look_of("sampled", 1.5, ""), NULL, &view)) {
            int seen = 0, all = 0;
            for (double y = -2; y < 2; y += pixel) {
                dvec at = shot_project(&drawing, dvec_of(0, y, 0));
                all++;
                seen += width_at(&drawing, at, dvec_of(0, 1, 0), 1.5) > 0.4;
            }
            check_at_least("EX-14", (double)seen / all, 0.995, "of a valley's line beside walls of %.1f px", pixels);
            shot_release(&drawing);
        }
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"widths", widths},
        {"rims", rims},
        {"near", near_plane},
        {"joints", joints},
        {"whole", whole_lines},
        {"full", full_width},
        {"ways", both_ways},
        {"crossings", crossings},
        {"lines-of-files", lines_of_files},
        {"valleys", valleys},
        {"limits", limits},
        {"figures", figures},
        {"samples", samples_and_dialects},
    };
    int status = check_main(argc, argv, "strokes_window", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
