/* Soft shadows and ambient occlusion against counted rays; lines around hard shadows. Rows P30, P31, P15, P21. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "light_truth.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

static const dvec lights[3] = {{-1, 1.2, 0.5}, {0.4, 1, 1}, {1, 2, -0.6}};

static shot_view view_of(double degrees, bool orthographic)
{
    double angle = degrees * pi / 180;
    return (shot_view){.width = 400,
                       .height = 320,
                       .eye = {8 * sin(angle), 5, 8 * cos(angle)},
                       .up = {0, 1, 0},
                       .orthographic = orthographic};
}

/* --- the width of penumbras ----------------------------------------------------------------------------- */

enum { PLATES = 3, EDGE = 240, ROWS = 8 };
static const double heights[PLATES] = {0.3, 0.6, 1.2};

/* Plates above a floor, in lanes; their shadows fall to the right. */
static void plates(shape *s)
{
    shape_box(s, "floor", dvec_of(-3, -0.1, -3.6), dvec_of(3, 0, 3.6));
    for (int k = 0; k < PLATES; k++)
        shape_box(s, "plate", dvec_of(-2.5, heights[k] - 0.002, -3.4 + 2.6 * k),
                  dvec_of(-1.5, heights[k], -1.8 + 2.6 * k));
}

/* Between the positions, in pixels, where a fraction grows beyond 0.1 and 0.9. */
static double width_of(const double *fractions, int count)
{
    double at[2] = {-1, -1};
    for (int i = 1; i < count; i++)
        for (int k = 0; k < 2; k++) {
            double level = k ? 0.9 : 0.1;
            if (at[k] < 0 && fractions[i - 1] < level && fractions[i] >= level)
                at[k] = i - 1 + (level - fractions[i - 1]) / (fractions[i] - fractions[i - 1]);
        }
    return at[0] < 0 || at[1] < 0 ? -1 : at[1] - at[0];
}

/* Along the middle of a lane, across the border of the plate's shadow. */
static double plate_width(const light_scene *l, const shot *s, const light_map *m, const tracer *t, int plate,
                          double *truth)
{
    double drawn[EDGE], counted[EDGE];
    double z = -2.6 + 2.6 * plate, border = -1.5 + heights[plate], half = 0.3 * heights[plate] + 0.1;
    dvec   first = shot_project(s, dvec_of(border - half, 0, z)), end = shot_project(s, dvec_of(border + half, 0, z));
    int    y = (int)first.y, low = (int)first.x, count = (int)end.x - low;
    count = count < EDGE ? count : EDGE;
    for (int i = 0; i < count; i++) {
        dvec      origin, direction;
        trace_hit hit;
        shot_ray(s, low + i + 0.5, y + 0.5, &origin, &direction);
        drawn[i] = 0;
        for (int row = -ROWS; row < ROWS; row++) /* the border runs down the picture */
            drawn[i] += (double)m->drawn[(y + row) * m->width + low + i] / (2 * ROWS);
        counted[i] = tracer_hit(t, origin, direction, -INFINITY, INFINITY, NULL, &hit)
                         ? light_of_disc(t, dvec_add(origin, dvec_scale(direction, hit.t)), dvec_of(0, 1, 0),
                                         l->towards, l->softness, 4000)
                         : 1;
    }
    *truth = width_of(counted, count);
    return width_of(drawn, count);
}

static void penumbras_grow(void)
{
    static const double angles[] = {4, 10, 20};
    light_scene         l = {.file = "plates.glb",
                             .towards = {-1, 1, 0},
                             .view = {.width = 960, .height = 640, .eye = {0, 14, 0}, .up = {0, 0, -1}, .orthographic = true}};
    plates(&l.s);
    tracer *t = tracer_create(&l.s);
    for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
        shot      with, without;
        light_map m;
        l.softness = angles[a];
        if (!light_shot(&with, &l, true))
            break;
        if (light_shot(&without, &l, false)) {
            double widths[PLATES], truth[PLATES];
            light_map_drawn(&m, &with, &without);
            for (int k = 0; k < PLATES; k++) {
                widths[k] = plate_width(&l, &with, &m, t, k, &truth[k]);
                check_near("P30", widths[k], truth[k], fmax(1.5, 0.1 * truth[k]),
                           "light of %g degrees, height %g: pixels from 0.1 to 0.9 (counted %.2f)", angles[a],
                           heights[k], truth[k]);
            }
            if (angles[a] >= 10)
                check_near("P30", widths[2] / widths[1], heights[2] / heights[1], 0.2,
                           "%g degrees: twice as high, twice as wide", angles[a]);
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    tracer_destroy(t);
    shape_release(&l.s);
}

/* Between samples, light runs evenly from row to row as from column to column: how uneven its steps are across a broad
 * penumbra, over their mean. */
static double unevenness(const light_map *m, bool rightwards)
{
    enum { MOST = 480 };
    double line[MOST] = {0}, steps = 0, bends = 0;
    int    length = rightwards ? m->width : m->height, lines = rightwards ? m->height : m->width, first = lines * 2 / 5,
        last = lines * 3 / 5;
    for (int i = 0; i < length; i++)
        for (int k = first; k < last; k++)
            line[i] += (double)m->drawn[rightwards ? k * m->width + i : i * m->width + k] / (last - first);
    for (int i = 2; i < length; i++)
        if (line[i] > 0.2 && line[i] < 0.8 && line[i - 2] > 0.2 && line[i - 2] < 0.8) {
            steps += fabs(line[i] - line[i - 2]) / 2;
            bends += fabs(line[i] - 2 * line[i - 1] + line[i - 2]);
        }
    return steps > 0 ? bends / steps : INFINITY;
}

static void light_is_even_between_samples(void)
{
    for (int i = 0; i < 4; i++) {
        const int    k = i % 2, slanted = i / 2; /* the way light changes in is the one in which depth does */
        const double far = slanted ? 5.7 : 0;
        light_scene  l = {.file = "even.glb",
                          .towards = k ? (dvec){-1, 1, 0} : (dvec){0, 1, -1},
                          .softness = 20,
                          .view = {.width = 320,
                                   .height = 320,
                                   .eye = {k ? far : 0, slanted ? 5.7 : 8, k ? 0 : far},
                                   .up = {0, 0, -1},
                                   .orthographic = true}};
        shot         with, without;
        light_map    m;
        shape_box(&l.s, "floor", dvec_of(-4, -0.1, -4), dvec_of(4, 0, 4));
        shape_box(&l.s, "plate", k ? dvec_of(-6, 1.198, -4) : dvec_of(-4, 1.198, -6),
                  k ? dvec_of(-1.2, 1.2, 4) : dvec_of(4, 1.2, -1.2));
        if (light_shot(&with, &l, true)) {
            if (light_shot(&without, &l, false)) {
                light_map_drawn(&m, &with, &without);
                check_at_most("P30", unevenness(&m, k), 0.3,
                              "steps of light across a penumbra that runs %s%s: how uneven they are",
                              k ? "to the right" : "down", slanted ? ", on a floor that leans" : "");
                light_map_release(&m);
                shot_release(&without);
            }
            shot_release(&with);
        }
        shape_release(&l.s);
    }
}

/* The least light on what has none of it kept off. */
static void check_all_light(const light_scene *l, const char *what, int side)
{
    shot      with, without;
    light_map m;
    if (!light_shot(&with, l, true))
        return;
    if (light_shot(&without, l, false)) {
        double least = 1;
        light_map_drawn(&m, &with, &without);
        for (int i = 0; i < m.width * m.height; i++)
            least = m.drawn[i] >= 0 ? fmin(least, (double)m.drawn[i]) : least;
        check_at_least("P31", least, 0.9999, "%s, side %d: least light", what, side);
        light_map_release(&m);
        shot_release(&without);
    }
    shot_release(&with);
}

/* At the borders of the page, where there is nothing beside a pixel to tell how a surface leans, what goes on beyond
 * them is as light as elsewhere. */
static void borders_of_the_page_are_light(void)
{
    for (int side = 0; side < 4; side++) {
        const double x = side == 0 ? 1 : side == 1 ? -1 : 0, y = side == 2 ? 1 : side == 3 ? -1 : 0;
        light_scene  l = {
             .file = "borders.glb",
             .towards = {0.3 * x, 0.3 * y, 1},
             .softness = 5,
             .occlusion = 1,
             .radius = 0.02,
             .view = {.width = 128, .height = 128, .eye = {4 * x, 4 * y, 4}, .up = {y != 0 ? 1 : 0, y != 0 ? 0 : 1, 0}}};
        shape_box(&l.s, "floor", dvec_of(-9, -9, -0.1), dvec_of(9, 9, 0));
        check_all_light(&l, "a slanted plane that is all of the page", side);
        shape_release(&l.s);
    }
}

/* A face that is in full light is so up to its ridge with another one that is turned away. */
static void ridges_are_light(void)
{
    for (int side = 0; side < 8; side++) {
        const double turn = side * pi / 4 + 0.1;
        light_scene  l = {.file = "ridge.glb",
                          .towards = {-1, 0.6, 0},
                          .softness = 4,
                          .view = {.width = 160,
                                   .height = 160,
                                   .eye = {5, 4, 1},
                                   .up = {sin(turn), cos(turn), 0.7 * sin(2 * turn)},
                                   .orthographic = true}};
        shot         with, without;
        light_map    m;
        shape_box(&l.s, "block", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        if (light_shot(&with, &l, true)) {
            if (light_shot(&without, &l, false)) {
                double missing = 0, count = 0;
                light_map_drawn(&m, &with, &without);
                for (int i = 0; i < m.width * m.height; i++)
                    if (m.drawn[i] >= 0) {
                        missing += 1 - (double)m.drawn[i];
                        count++;
                    }
                check_at_least("P30", count, 5000, "turned by %g degrees: pixels of faces in the light",
                               turn * 180 / pi);
                check_at_most("P30", missing, 25, "  light that they lack, pixels");
                light_map_release(&m);
                shot_release(&without);
            }
            shot_release(&with);
        }
        shape_release(&l.s);
    }
}

/* A floor below a roof that keeps all light off is dark, however flat it is looked at, up to where it ends. */
static void floors_are_dark_at_a_grazing_view(void)
{
    for (int k = 0; k < 2; k++) {
        light_scene l = {
            .file = "roof.glb",
            .towards = {0.1, 1, 0},
            .softness = 10,
            .view = {.width = 240, .height = 160, .eye = {0, 0.5, 7}, .up = {0, 1, 0}, .orthographic = k > 0}};
        shot      with, without;
        light_map m;
        shape_box(&l.s, "floor", dvec_of(-2, -0.1, -2), dvec_of(2, 0, 2));
        shape_box(&l.s, "roof", dvec_of(-9, 3, -9), dvec_of(9, 3.1, 9));
        if (light_shot(&with, &l, true)) {
            if (light_shot(&without, &l, false)) {
                double sum = 0;
                int    count = 0;
                light_map_drawn(&m, &with, &without);
                for (int i = 0; i < m.width * m.height; i++)
                    if (m.drawn[i] >= 0) {
                        sum += (double)m.drawn[i];
                        count++;
                    }
                check_at_least("P30", count, 500, "pixels of a floor that is seen at 4 degrees, %s",
                               k ? "parallel rays" : "perspective");
                check_at_most("P30", sum / fmax(count, 1), 0.05, "  fraction of the light on it, below a roof");
                light_map_release(&m);
                shot_release(&without);
            }
            shot_release(&with);
        }
        shape_release(&l.s);
    }
}

/* What lies the other way round has its hard shadows the other way round, as broad at their borders: how far both
 * pictures are apart, over all pixels. */
static void shadows_are_mirrored(void)
{
    light_map maps[2];
    shot      with[2], without[2];
    bool      good = true;
    for (int k = 0; k < 2; k++) {
        const double sign = k ? -1 : 1;
        light_scene  l = {.file = "mirrored.glb",
                          .towards = {sign * 0.7, 1, 0.4},
                          .view = {.width = 240, .height = 200, .eye = {0, 5, 7}, .up = {0, 1, 0}}};
        shape_box(&l.s, "floor", dvec_of(-2, -0.1, -2), dvec_of(2, 0, 2));
        for (int i = 0; i < 5; i++)
            shape_box(&l.s, "post", dvec_of(sign * (0.9 + 0.15 * i) - 0.05, 0, 0.5 * i - 1.05),
                      dvec_of(sign * (0.9 + 0.15 * i) + 0.05, 0.6, 0.5 * i - 0.95));
        good = light_shot(&with[k], &l, true) && good;
        good = light_shot(&without[k], &l, false) && good;
        shape_release(&l.s);
    }
    if (good) {
        double apart = 0, between = 0;
        for (int k = 0; k < 2; k++)
            light_map_drawn(&maps[k], &with[k], &without[k]);
        for (int i = 0; i < maps[0].width * maps[0].height; i++) {
            double own = (double)maps[0].drawn[i],
                   other =
                       (double)maps[1].drawn[i / maps[0].width * maps[0].width + maps[0].width - 1 - i % maps[0].width];
            if (own < 0 || other < 0)
                continue;
            apart += fabs(own - other);
            between += own * (1 - own);
        }
        check_at_least("P15", between, 20,
                       "what lies between light and shadow along borders that are as broad as pixels");
        check_at_most("P15", apart / between, 0.5,
                      "how far the mirrored scene's picture is from the picture's mirror image, over that");
        for (int k = 0; k < 2; k++)
            light_map_release(&maps[k]);
    }
    for (int k = 0; k < 2; k++) {
        shot_release(&with[k]);
        shot_release(&without[k]);
    }
}

/* --- whole pictures ------------------------------------------------------------------------------------- */

static void court(shape *s)
{
    shape_box(s, "floor", dvec_of(-3, -0.1, -2.5), dvec_of(3, 0, 2.5));
    shape_box(s, "wall", dvec_of(-2.6, 0, -2.2), dvec_of(2, 1.3, -2));
    shape_box(s, "block", dvec_of(-1.6, 0, -0.8), dvec_of(-0.6, 0.9, 0.2));
    shape_sphere(s, "ball", dvec_of(0.9, 0.7, 0.1), 0.7, 48, 96, true);
    shape_box(s, "step", dvec_of(-0.2, 0, 1.2), dvec_of(1.4, 0.25, 1.8));
    shape_box(s, "pole", dvec_of(-2.2, 0, 1.3), dvec_of(-2.14, 1.6, 1.36));
    shape_box(s, "beam", dvec_of(1.9, 1.1, -1.5), dvec_of(2.6, 1.25, 1.8));
}

/* The score of one drawing, at a fifth of its positions: of some 10000 places the mean difference is then known to
 * 0.0005 and the fraction of those far off to 0.001. */
static bool score_of(const light_scene *l, bool sky, int rays, int step, const char *picture, light_score *out)
{
    shot      with, without;
    light_map m;
    bool      ok = light_shot(&with, l, true);
    if (ok && (ok = light_shot(&without, l, false))) {
        light_map_drawn(&m, &with, &without);
        if (sky)
            light_map_occlusion(&m, l, &with, rays, step);
        else
            light_map_shadows(&m, l, &with, rays, step);
        *out = light_compare(&m);
        light_map_write(&m, picture);
        light_map_release(&m);
        shot_release(&without);
    }
    if (ok)
        shot_release(&with);
    return ok;
}

static void shadows_are_a_discs(void)
{
    static const double angles[] = {3, 8, 20},
                        means[] = {0.0075, 0.009,
                                   0.018}; /* half a sample of the small picture aside is more than that */
    for (int k = 0; k < 6; k++) {
        light_scene l = {.file = "court.glb",
                         .towards = lights[k % 3],
                         .view = view_of(k < 3 ? 25 : -35, k >= 3),
                         .softness = angles[k % 3]};
        light_score score;
        court(&l.s);
        char name[32];
        snprintf(name, sizeof name, "shadows-%d.png", k);
        if (score_of(&l, false, 96, 5, name, &score)) {
            check_at_least("P30", score.positions, 8000, "places compared, %s, %g degrees",
                           l.view.orthographic ? "parallel rays" : "perspective", l.softness);
            check_at_most("P30", score.mean, means[k % 3], "mean difference of the light that arrives");
            check_at_most("P30", score.far, 0.01, "fraction of places that are off by more than 0.25 (worst %.2f)",
                          score.worst);
        }
        shape_release(&l.s);
    }
}

/* Without softness nothing changes: the words for it, and for no occlusion, draw the same bytes as silence. */
static void hard_is_hard(void)
{
    light_scene quiet = {.file = "court.glb", .towards = lights[0], .view = view_of(25, false), .layers = NULL},
                said = quiet;
    shot a, b, again;
    char look[512];
    court(&quiet.s);
    said.s = quiet.s;
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"t\",\"scene\":{\"shadows\":true,\"light_direction\":\"-1,1,1\"%s},\"rules\":[{"
             "\"surface\":\"lambert\"}]}",
             "");
    if (shot_of_shape(&a, &quiet.s, "court.glb", look, NULL, &quiet.view)) {
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"scene\":{\"shadows\":true,\"light_direction\":\"-1,1,1\"%s},"
                 "\"rules\":[{\"surface\":\"lambert\"}]}",
                 ",\"shadow_softness\":0,\"occlusion\":0,\"occlusion_radius\":0.3");
        if (shot_of_shape(&b, &quiet.s, "court.glb", look, NULL, &quiet.view)) {
            check_at_most("P30", shot_differing(&a, &b, 0), 0, "values that a softness and an occlusion of 0 change");
            shot_release(&b);
        }
        shot_release(&a);
    }
    said.softness = 8;
    said.occlusion = 0.7;
    if (light_shot(&a, &said, true)) {
        if (light_shot(&again, &said, true)) {
            check_at_most("P31", shot_differing(&a, &again, 0), 0, "values that differ when the same is drawn twice");
            shot_release(&again);
        }
        shot_release(&a);
    }
    shape_release(&quiet.s);
}

/* A shadow begins where its thing stands: a strip of floor just behind the wall is dark, and it stays so towards
 * the corner. */
static void contact_has_no_gap(void)
{
    static const double angles[] = {2, 8, 20};
    light_scene         l = {.file = "contact.glb",
                             .towards = {-1, 1, 0.2},
                             .view = {.width = 640, .height = 480, .eye = {5, 5, 2}, .up = {0, 1, 0}}};
    shape_box(&l.s, "floor", dvec_of(-2, -0.1, -2), dvec_of(2, 0, 2));
    shape_box(&l.s, "wall", dvec_of(-0.1, 0, -1), dvec_of(0, 1, 1));
    shape_box(&l.s, "kerb", dvec_of(1.3, 0, -1), dvec_of(1.4, 0.06, 1));
    for (int k = 0; k < 3; k++) {
        shot      with, without;
        light_map m;
        l.softness = angles[k];
        if (!light_shot(&with, &l, true))
            break;
        if (light_shot(&without, &l, false)) {
            double worst = 0, lit = 1, low = 0;
            light_map_drawn(&m, &with, &without);
            for (int i = 0; i <= 60; i++) { /* along the wall's foot, two pixels from it; and before the wall */
                dvec at = shot_project(&with, dvec_of(0.04, 0, -0.9 + 1.6 * i / 60)),
                     before = shot_project(&with, dvec_of(-0.7, 0, -1.9 + 1.0 * i / 60));
                float shadowed = m.drawn[(int)at.y * m.width + (int)at.x],
                      open = m.drawn[(int)before.y * m.width + (int)before.x];
                worst = fmax(worst, shadowed >= 0 ? (double)shadowed : 0);
                dvec foot = shot_project(&with, dvec_of(1.425, 0, -0.8 + 1.6 * i / 60));
                low += (double)m.drawn[(int)foot.y * m.width + (int)foot.x] / 61;
                lit = fmin(lit, open >= 0 ? (double)open : 1);
            }
            check_at_most("P30", worst, 0.05, "%g degrees: most light at the foot of the wall's dark side", angles[k]);
            check_at_most("P30", low, 0.2, "%g degrees: light behind a kerb of seven pixels", angles[k]);
            check_at_least("P30", lit, 0.98, "%g degrees: least light on open floor", angles[k]);
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    shape_release(&l.s);
}

/* What floats closely over a floor throws a shadow: the least distance that counts is a few texels of the map. */
static void thin_gaps_are_dark(void)
{
    static const double angles[] = {0.5, 2, 8};
    const double        low = 0.012, wide = 0.4;
    light_scene         l = {
                .file = "sheet.glb",
                .towards = {-1, 0.6, 0},
                .view = {
                    .width = 640, .height = 480, .eye = {2.5, 1.6, 0}, .target = {wide, 0, 0}, .up = {0, 1, 0}, .fov_deg = 3}};
    shape_box(&l.s, "floor", dvec_of(-1.5, -0.05, -1.5), dvec_of(1.5, 0, 1.5));
    shape_box(&l.s, "sheet", dvec_of(0, low, -0.5), dvec_of(wide, low + 0.001, 0.5));
    for (int k = 0; k < 3; k++) {
        shot      with, without;
        light_map m;
        l.softness = angles[k];
        if (!light_shot(&with, &l, true))
            break;
        if (light_shot(&without, &l, false)) {
            double dark = 0;
            light_map_drawn(&m, &with, &without);
            for (int i = 0; i <= 40; i++) { /* the middle of the strip that it darkens beside itself */
                dvec at = shot_project(&with, dvec_of(wide + 0.5 * low / 0.6, 0, -0.03 + 0.06 * i / 40));
                dark += (double)m.drawn[(int)at.y * m.width + (int)at.x] / 41;
            }
            check_at_most("P30", dark, 0.1,
                          "%g degrees: light beside a sheet that floats over a floor by a 350th of the scene",
                          angles[k]);
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    shape_release(&l.s);
}

/* Is everything around a position fully lit? A border of light may be three pixels soft. */
static bool open_around(const light_map *m, int x, int y)
{
    for (int j = y - 3; j <= y + 3; j++)
        for (int i = x - 3; i <= x + 3; i++)
            if (i < 0 || j < 0 || i >= m->width || j >= m->height || m->truth[j * m->width + i] < 0.999f)
                return false;
    return true;
}

/* Round things, also coarse ones, do not shadow themselves where they face the light. */
static void no_acne(void)
{
    for (int k = 0; k < 6; k++) {
        light_scene l = {
            .file = "ball.glb", .towards = lights[k % 3], .softness = k % 2 ? 1.5 : 10, .view = view_of(10, false)};
        shot      with, without;
        light_map m;
        shape_sphere(&l.s, "ball", dvec_of(0, 0, 0), 2, k < 3 ? 12 : 64, k < 3 ? 24 : 128, true);
        if (light_shot(&with, &l, true)) {
            if (light_shot(&without, &l, false)) {
                int dark = 0, all = 0;
                light_map_drawn(&m, &with, &without);
                light_map_shadows(&m, &l, &with, 16, 1);
                for (int i = 0; i < m.width * m.height; i++)
                    if (m.drawn[i] >= 0 && open_around(&m, i % m.width, i / m.width)) {
                        all++;
                        dark += m.drawn[i] < 0.95f;
                    }
                check_at_least("P30", all, 3000, "places of a ball of %s facets that face the light",
                               k < 3 ? "12 x 24" : "64 x 128");
                check_at_most("P30", dark, 0.0005 * all, "of them dark, light of %g degrees", l.softness);
                light_map_release(&m);
                shot_release(&without);
            }
            shot_release(&with);
        }
        shape_release(&l.s);
    }
}

/* Only the first of several lights is kept off. */
static void other_lights_stay(void)
{
    light_scene l = {.file = "court.glb", .towards = lights[0], .softness = 8, .view = view_of(25, false)};
    shot        both, fill, key;
    court(&l.s);
    l.fill = 0.5;
    bool ok = light_shot(&both, &l, true);
    if (ok && light_shot(&fill, &l, false)) {
        l.fill = 0;
        if (light_shot(&key, &l, true)) {
            shot first;
            if (light_shot(&first, &l, false)) {
                int off = 0, all = 0;
                for (int i = 0; i < both.width * both.height; i++) {
                    double second = picture_linear(fill.picture[4 * i]) - picture_linear(first.picture[4 * i]);
                    if (fill.picture[4 * i] >= 250 || !(both.depth[i] < INFINITY))
                        continue;
                    all++;
                    off +=
                        fabs(picture_linear(both.picture[4 * i]) - picture_linear(key.picture[4 * i]) - second) > 0.02;
                }
                check_at_least("P30", all, 5000, "places lit by two lights");
                check_at_most("P30", off, 0, "of them where the second light is not the same with and without shadows");
                shot_release(&first);
            }
            shot_release(&key);
        }
        shot_release(&fill);
    }
    if (ok)
        shot_release(&both);
    shape_release(&l.s);
}

/* Shading with the geometry, after it, on ES, and with samples: one picture. */
static void one_picture(void)
{
    light_scene l = {.file = "court.glb",
                     .towards = lights[1],
                     .softness = 8,
                     .occlusion = 0.8,
                     .radius = 0.1,
                     .view = view_of(25, false)};
    shot        one, other;
    court(&l.s);
    if (light_shot(&one, &l, true)) {
        l.layers = ",\"layers\":{\"technique\":\"front\",\"shading\":\"deferred\"}";
        if (light_shot(&other, &l, true)) {
            check_at_most("P30", shot_differing(&one, &other, 2), 0,
                          "values that differ by more than 2 when shaded later");
            shot_release(&other);
        }
        l.layers = NULL;
        l.view.es = true;
        if (light_shot(&other, &l, true)) {
            check_at_most("P30", shot_differing(&one, &other, 2), 0, "values that differ by more than 2 on ES");
            shot_release(&other);
        }
        l.view.es = false;
        l.view.samples = 4;
        if (light_shot(&other, &l, true)) {
            double mean = 0;
            int    all = 0;
            for (int i = 0; i < one.width * one.height; i++)
                if (one.depth[i] < INFINITY) {
                    mean += abs((int)one.picture[4 * i] - (int)other.picture[4 * i]);
                    all++;
                }
            check_at_most("P30", mean / all, 2.5, "mean difference, of 255, from a picture with four samples a pixel");
            shot_release(&other);
        }
        shot_release(&one);
    }
    shape_release(&l.s);
}

/* A solid throws the shadow, and has the corners, of the mesh that it looks like. */
static void solids_too(void)
{
    light_scene mesh = {.file = "boxes.glb",
                        .towards = lights[0],
                        .softness = 8,
                        .occlusion = 0.8,
                        .radius = 0.1,
                        .view = view_of(25, false)},
                solid = mesh;
    shot one, other;
    solid.file = check_path("boxes.csg");
    FILE *file = fopen(solid.file, "wb");
    if (!file ||
        fputs("union() { multmatrix([[1,0,0,-2],[0,1,0,-0.2],[0,0,1,-2],[0,0,0,1]]) { cube(size = [4, 0.2, 4], center "
              "= false); }\n"
              "difference() { multmatrix([[1,0,0,-1],[0,1,0,-0.1],[0,0,1,-1],[0,0,0,1]]) { cube(size = [1, 1.1, 1], "
              "center = false); }\n"
              "multmatrix([[1,0,0,-0.5],[0,1,0,0.5],[0,0,1,-2],[0,0,0,1]]) { cube(size = [1, 1.1, 4], center = false); "
              "} } }\n",
              file) < 0 ||
        fclose(file) != 0)
        return;
    shape_box(&mesh.s, "floor", dvec_of(-2, -0.2, -2), dvec_of(2, 0, 2));
    shape_box(&mesh.s, "low", dvec_of(-1, 0, -1), dvec_of(0, 0.5, 0));
    shape_box(&mesh.s, "high", dvec_of(-1, 0.5, -1), dvec_of(-0.5, 1, 0));
    shot bare[2];
    bool ok = light_shot(&one, &mesh, true) && light_shot(&other, &solid, true) && light_shot(&bare[0], &mesh, false) &&
              light_shot(&bare[1], &solid, false);
    check_that("P30", ok, "a solid is drawn");
    if (ok) {
        light_map a, b;
        double    mean = 0;
        int       all = 0;
        light_map_drawn(&a, &one, &bare[0]);
        light_map_drawn(&b, &other, &bare[1]);
        for (int i = 0; i < a.width * a.height; i++)
            if (a.drawn[i] >= 0 && b.drawn[i] >= 0) {
                mean += fabs((double)a.drawn[i] - (double)b.drawn[i]);
                all++;
            }
        check_at_least("P30", all, 5000, "places of both");
        check_at_most("P30", mean / all, 0.005, "mean difference of a solid's light from that of the same boxes");
        light_map_release(&a);
        light_map_release(&b);
        shot_release(&one);
        shot_release(&other);
        shot_release(&bare[0]);
        shot_release(&bare[1]);
    }
    shape_release(&mesh.s);
}

/* A light that moves a little changes a little. */
static void light_moves(void)
{
    light_scene l = {.file = "court.glb", .softness = 8, .view = view_of(25, false)};
    shot        before, now;
    court(&l.s);
    for (int k = 0; k < 8; k++) {
        double angle = (100 + 0.5 * k) * pi / 180;
        l.towards = dvec_of(cos(angle), 1, sin(angle));
        if (!light_shot(&now, &l, true))
            break;
        if (k > 0) {
            double mean = 0;
            int    jumps = 0, all = 0;
            for (int i = 0; i < now.width * now.height; i++) {
                if (!(now.depth[i] < INFINITY))
                    continue;
                int change = abs((int)now.picture[4 * i] - (int)before.picture[4 * i]);
                mean += change;
                jumps += change > 80;
                all++;
            }
            if (k == 4)
                check_note("half a degree on: mean change %.2f, %d of %d places by more than 80", mean / all, jumps,
                           all);
            check_at_most("P30", mean / all, 2.5,
                          "mean change of a picture, of 255, when the light turns by half a degree");
            check_at_most("P30", jumps, 0.01 * all, "places that change by more than 80");
            shot_release(&before);
        }
        before = now;
        if (k == 7)
            shot_release(&now);
    }
    shape_release(&l.s);
}

/* --- ambient occlusion ---------------------------------------------------------------------------------- */

static const dvec from_viewer = {0.3, 0.55, 0.8};

static void corner(shape *s)
{
    shape_box(s, "floor", dvec_of(-2, -0.2, -2), dvec_of(2, 0, 2));
    shape_box(s, "back", dvec_of(-2, 0, -2.2), dvec_of(2, 2.4, -2));
    shape_box(s, "left", dvec_of(-2.2, -0.2, -2.2), dvec_of(-2, 2.4, 2));
}

static void box_on_floor(shape *s)
{
    shape_box(s, "floor", dvec_of(-2.5, -0.2, -2.5), dvec_of(2.5, 0, 2.5));
    shape_box(s, "box", dvec_of(-0.8, 0, -0.8), dvec_of(0.6, 1, 0.6));
}

static void ball_on_floor(shape *s)
{
    shape_box(s, "floor", dvec_of(-2.5, -0.2, -2.5), dvec_of(2.5, 0, 2.5));
    shape_sphere(s, "ball", dvec_of(0, 1, 0), 1, 64, 128, true);
}

static void cleft(shape *s)
{
    shape_box(s, "floor", dvec_of(-2, -0.2, -2), dvec_of(2, 0, 2));
    shape_box(s, "left", dvec_of(-2, 0, -1.5), dvec_of(-0.25, 0.8, 1.5));
    shape_box(s, "right", dvec_of(0.25, 0, -1.5), dvec_of(2, 0.8, 1.5));
}

static void corners_are_darker(void)
{
    static const struct {
        const char *name;
        void (*make)(shape *);
        double radius, mean;
    } rows[] = {{"corner", corner, 0.12, 0.015},
                {"corner, wide", corner, 0.35, 0.04},
                {"box on floor", box_on_floor, 0.1, 0.01},
                {"ball on floor", ball_on_floor, 0.12, 0.02},
                {"cleft", cleft, 0.15, 0.02}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (int k = 0; k < 2; k++) {
            light_scene l = {.file = "occluded.glb",
                             .towards = from_viewer,
                             .view = view_of(k ? 15 : 30, k != 0),
                             .softness = -1,
                             .occlusion = 1,
                             .radius = rows[r].radius};
            light_score score;
            rows[r].make(&l.s);
            char name[32];
            snprintf(name, sizeof name, "sky-%zu-%d.png", r, k);
            if (score_of(&l, true, 128, 5, name, &score)) {
                check_at_least("P31", score.positions, 5000, "%s, %s: places compared", rows[r].name,
                               k ? "parallel rays" : "perspective");
                check_at_most("P31", score.mean, rows[r].mean,
                              "mean difference of the fraction of the sky (worst %.2f)", score.worst);
                check_at_most("P31", score.far, 0.02, "fraction of places that are off by more than 0.25");
            }
            shape_release(&l.s);
        }
}

/* The nearer to the corner, the darker; far from it nothing. */
static void darkness_falls_off(void)
{
    light_scene l = {.file = "occluded.glb",
                     .towards = from_viewer,
                     .view = view_of(30, false),
                     .softness = -1,
                     .occlusion = 1,
                     .radius = 0.12};
    shot        with, without;
    light_map   m;
    corner(&l.s);
    if (light_shot(&with, &l, true)) {
        if (light_shot(&without, &l, false)) {
            static const double apart[] = {0.05, 0.15, 0.3, 0.5, 0.9};
            double              before = 0;
            light_map_drawn(&m, &with, &without);
            for (int k = 0; k < 5; k++) { /* from the foot of the back wall */
                dvec   at = shot_project(&with, dvec_of(0.6, 0, -2 + apart[k]));
                double fraction = (double)m.drawn[(int)at.y * m.width + (int)at.x];
                check_at_least("P31", fraction, before - 0.01, "fraction of the sky %g from the wall", apart[k]);
                before = fraction;
            }
            check_at_least("P31", before, 0.995, "and none is lost beyond the radius");
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    shape_release(&l.s);
}

/* Of what the sky does not give, as much is missed as its strength says. */
static void strength_is_a_fraction(void)
{
    static const double strengths[] = {0.25, 0.6};
    light_scene         l = {.file = "occluded.glb",
                             .towards = from_viewer,
                             .view = view_of(30, false),
                             .softness = -1,
                             .occlusion = 1,
                             .radius = 0.3};
    shot                whole, without, part;
    corner(&l.s);
    if (light_shot(&without, &l, false) && light_shot(&whole, &l, true)) {
        light_map full, some;
        light_map_drawn(&full, &whole, &without);
        for (int k = 0; k < 2; k++) {
            double off = 0, missed = 0;
            int    all = 0;
            l.occlusion = strengths[k];
            if (!light_shot(&part, &l, true))
                break;
            light_map_drawn(&some, &part, &without);
            for (int i = 0; i < some.width * some.height; i++)
                if (full.drawn[i] >= 0) {
                    off = fmax(off, fabs(1 - (double)some.drawn[i] - strengths[k] * (1 - (double)full.drawn[i])));
                    missed += 1 - (double)some.drawn[i];
                    all++;
                }
            check_at_least("P31", missed / all, 0.01, "mean share that a corner misses at a strength of %g",
                           strengths[k]);
            check_at_most("P31", off, 0.04, "how far from that fraction of what it misses at 1");
            light_map_release(&some);
            shot_release(&part);
        }
        light_map_release(&full);
        shot_release(&whole);
        shot_release(&without);
    }
    shape_release(&l.s);
}

static void planes_stay(void)
{
    static const double elevations[] = {90, 45, 15, 6, 3};
    for (int e = 0; e < 10; e++) {
        double      angle = elevations[e % 5] * pi / 180;
        light_scene l = {.file = "plane.glb",
                         .towards = {0.6, 1, 0.4},
                         .softness = e % 2 ? 40 : -1,
                         .occlusion = 1,
                         .radius = e % 3 ? 0.1 : 0.4,
                         .view = {.width = 401,
                                  .height = 301,
                                  .eye = {0.7, 3 * sin(angle), 3 * cos(angle) + 0.02},
                                  .up = {0, 1, 0},
                                  .orthographic = e >= 5}};
        shot        with, without;
        light_map   m;
        shape_box(&l.s, "floor", dvec_of(-5, -0.1, -5), dvec_of(5, 0, 5));
        if (light_shot(&with, &l, true)) {
            if (light_shot(&without, &l, false)) {
                double least = 1;
                int    all = 0;
                light_map_drawn(&m, &with, &without);
                for (int i = 0; i < m.width * m.height; i++)
                    if (m.drawn[i] >= 0) {
                        least = fmin(least, (double)m.drawn[i]);
                        all++;
                    }
                check_at_least("P31", all, 1000, "pixels of a plane seen at %g degrees, %s", elevations[e % 5],
                               e >= 5 ? "parallel rays" : "perspective");
                check_at_least("P31", least, 0.995, "least light on it");
                light_map_release(&m);
                shot_release(&without);
            }
            shot_release(&with);
        }
        shape_release(&l.s);
    }
}

/* What stands far before a wall leaves it as it is. */
static void no_halo(void)
{
    light_scene l = {.file = "halo.glb",
                     .towards = {0.1, 0.2, 1},
                     .softness = -1,
                     .occlusion = 1,
                     .radius = 0.05,
                     .view = {.width = 400, .height = 320, .eye = {0.3, 0.2, 9}, .up = {0, 1, 0}}};
    shot        with, without;
    light_map   m;
    shape_box(&l.s, "wall", dvec_of(-2, -2, -0.1), dvec_of(2, 2, 0));
    shape_box(&l.s, "plate", dvec_of(-0.7, -0.7, 1), dvec_of(0.7, 0.7, 1.1));
    shape_box(&l.s, "pole", dvec_of(1.2, -1.5, 1), dvec_of(1.23, 1.5, 1.03));
    if (light_shot(&with, &l, true)) {
        if (light_shot(&without, &l, false)) {
            int dark = 0, all = 0;
            light_map_drawn(&m, &with, &without);
            for (int i = 0; i < m.width * m.height; i++)
                if (m.drawn[i] >= 0) {
                    all++;
                    dark += m.drawn[i] < 0.97f;
                }
            check_at_least("P31", all, 20000, "pixels of a wall, a plate and a pole far before it");
            check_at_most("P31", dark, 0, "of them darkened, though the step is larger than the radius");
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    shape_release(&l.s);
}

/* --- lines around shadows ------------------------------------------------------------------------------- */

/* What a position is, by rays: lit, in a shadow, or nothing that a line is drawn for (empty, turned away, hardly
 * facing the light). */
typedef enum lit_state { LIT, SHADOWED, NO_MATTER } lit_state;

typedef struct hard_map {
    int       width, height;
    uint8_t  *state;
    trace_map seen;
} hard_map;

static void hard_map_make(hard_map *m, const light_scene *l, const shot *s, double least)
{
    tracer *t = tracer_create(&l->s);
    dvec    towards = dvec_unit(shot_to_eye(s, l->towards, 0));
    *m = (hard_map){
        .width = s->width, .height = s->height, .state = check_alloc((size_t)s->width * (size_t)s->height, 1)};
    trace_map_make(&m->seen, t, s);
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            dvec      origin, direction;
            trace_hit hit;
            size_t    at = (size_t)y * (size_t)s->width + (size_t)x;
            m->state[at] = NO_MATTER;
            shot_ray(s, x + 0.5, y + 0.5, &origin, &direction);
            if (!m->seen.id[at] || dvec_dot(m->seen.normal[at], towards) < least ||
                !tracer_hit(t, origin, direction, s->orthographic ? -INFINITY : 0, INFINITY, NULL, &hit))
                continue;
            size_t                count;
            const trace_triangle *f = &tracer_triangles(t, &count)[hit.triangle];
            dvec                  normal = dvec_dot(f->flat, l->towards) < 0 ? dvec_scale(f->flat, -1) : f->flat;
            m->state[at] =
                light_of_disc(t, dvec_add(origin, dvec_scale(direction, hit.t)), normal, l->towards, 0, 1) > 0.5
                    ? LIT
                    : SHADOWED;
        }
    tracer_destroy(t);
}

/* Does the shadow end between this pixel and one within `reach` of it, on one surface? */
static bool shadow_ends(const hard_map *m, int x, int y, int reach)
{
    size_t own = (size_t)y * (size_t)m->width + (size_t)x;
    bool   lit = false, dark = false;
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++) {
            size_t at = (size_t)j * (size_t)m->width + (size_t)i;
            if (i < 0 || j < 0 || i >= m->width || j >= m->height || m->seen.id[at] != m->seen.id[own] ||
                dvec_dot(m->seen.normal[at], m->seen.normal[own]) < 0.7)
                continue;
            lit = lit || m->state[at] == LIT;
            dark = dark || m->state[at] == SHADOWED;
        }
    return lit && dark;
}

static bool ink_near(const shot *s, int x, int y, int reach)
{
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < s->width && j < s->height && s->picture[4 * (j * s->width + i)] < 160)
                return true;
    return false;
}

static const char *outline_look(const light_scene *l, const char *more, const char *layers)
{
    static char look[768];
    dvec back = dvec_unit(dvec_sub(l->view.eye, l->view.target)), right = dvec_unit(dvec_cross(l->view.up, back)),
         up = dvec_cross(back, right);
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"t\",\"scene\":{\"light_direction\":\"%.9f,%.9f,%.9f\"%s},\"finish\":{"
             "\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},"
             "\"lines\":{\"operator\":\"shadow\",\"colour\":\"#000000\"}%s}]}",
             dvec_dot(right, l->towards), dvec_dot(up, l->towards), dvec_dot(back, l->towards), more, layers);
    return look;
}

static void outlines_lie_on_borders(void)
{
    for (int k = 0; k < 6; k++) {
        light_scene l = {.file = "court.glb", .towards = lights[k % 3], .view = view_of(k < 3 ? 25 : -35, k >= 3)};
        hard_map    sure, perhaps;
        shot        s;
        l.view.width = 640;
        l.view.height = 512;
        court(&l.s);
        if (shot_of_shape(&s, &l.s, l.file, outline_look(&l, "", ""), NULL, &l.view)) {
            int ink = 0, stray = 0, border = 0, missed = 0;
            hard_map_make(&sure, &l, &s, 0.25);
            hard_map_make(&perhaps, &l, &s, 0.04);
            for (int y = 0; y < s.height; y++)
                for (int x = 0; x < s.width; x++) {
                    if (s.picture[4 * (y * s.width + x)] < 64) { /* three quarters ink */
                        ink++;
                        stray += !shadow_ends(&perhaps, x, y, 3);
                    }
                    if (shadow_ends(&sure, x, y, 1) && !trace_map_border(&sure.seen, x, y, 0.02)) {
                        border++;
                        missed += !ink_near(&s, x, y, 2);
                    }
                }
            check_at_least("P15", border, 300, "pixels at shadows' borders, light %d, %s", k % 3,
                           k < 3 ? "perspective" : "parallel rays");
            check_at_most("P15", missed, 0.02 * border, "of them without a line");
            check_at_most("P15", stray, 0.01 * ink, "pixels of lines elsewhere (of %d)", ink);
            free(sure.state);
            free(perhaps.state);
            trace_map_release(&sure.seen);
            trace_map_release(&perhaps.seen);
            shot_release(&s);
        }
        shape_release(&l.s);
    }
}

/* A floor of one sheet, whose corners run the other way around when it is seen from behind, and a block over it. */
static void sheet_and_block(shape *s, bool from_behind)
{
    static const float corners[4][3] = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
    shape_part        *p = shape_add(s, "sheet", 4, 6, true, false);
    for (uint32_t i = 0; i < 6; i++)
        p->indices[i] = (uint32_t[]){0, 1, 2, 0, 2, 3}[from_behind ? 5 - i : i];
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) {
            p->positions[k][c] = corners[k][c];
            p->normals[k][c] = c != 1 ? 0.0f : from_behind ? -1.0f : 1.0f;
        }
    shape_box(s, "block", dvec_of(-0.5, 0.1, -0.5), dvec_of(0.5, 0.9, 0.5));
}

/* Ink of the lines around the block's shadow. */
static double outline_ink(double elevation, bool from_behind)
{
    double      ink = 0, angle = elevation * pi / 180;
    light_scene l = {
        .file = "sheet.glb", .towards = {-cos(angle), sin(angle), 0.1 * cos(angle)}, .view = view_of(25, false)};
    shot s;
    sheet_and_block(&l.s, from_behind);
    if (shot_of_shape(&s, &l.s, l.file, outline_look(&l, "", ""), NULL, &l.view)) {
        for (int i = 0; i < s.width * s.height; i++)
            ink += s.id[i] == 1 ? 1 - s.picture[4 * i] / 255.0 : 0;
        shot_release(&s);
    }
    shape_release(&l.s);
    return ink;
}

/* On both sides of a sheet; fainter where it hardly faces the light, until nothing is left. */
static void outlines_on_sheets(void)
{
    double high = outline_ink(40, false), low = outline_ink(6, false);
    check_at_least("P15", high, 300, "ink of lines around a shadow on a sheet");
    check_near("P15", outline_ink(40, true), high, 0.05 * high, "the same on its other side");
    check_at_least("P15", low, 10, "ink of lines where light comes from 6 degrees above");
    check_at_most("P15", low, 0.5 * high, "and the lines are faint there");
    check_at_most("P15", outline_ink(2.5, false), 0, "from 2.5 degrees");
}

/* Balls have silhouettes and terminators, and no shadow ends on them. */
static void outlines_nowhere_else(void)
{
    static const int facets[] = {16, 32, 96};
    for (int k = 0; k < 9; k++) {
        light_scene l = {.file = "ball.glb", .towards = lights[k % 3], .view = view_of(10 + 40 * k, k % 2)};
        shot        s;
        shape_sphere(&l.s, "ball", dvec_of(0, 0, 0), 2, facets[k / 3], 2 * facets[k / 3], true);
        if (shot_of_shape(&s, &l.s, l.file, outline_look(&l, "", ""), NULL, &l.view)) {
            int ink = 0;
            for (int i = 0; i < s.width * s.height; i++)
                ink += s.picture[4 * i] < 160;
            check_at_most("P15", ink, 0, "pixels of lines on a ball of %d facets around", 2 * facets[k / 3]);
            shot_release(&s);
        }
        shape_release(&l.s);
    }
    /* The lines are the same with shadows, with layers, and soft. */
    light_scene l = {.file = "court.glb", .towards = lights[0], .view = view_of(25, false)};
    shot        s, other;
    court(&l.s);
    static const char *const scenes[] = {",\"shadows\":true", ",\"shadows\":true,\"shadow_softness\":8,\"occlusion\":1",
                                         ""};
    static const char *const layers[] = {"", "", ",\"layers\":{\"technique\":\"peel\",\"count\":1}"};
    if (shot_of_shape(&s, &l.s, l.file, outline_look(&l, "", ""), NULL, &l.view)) {
        for (int k = 0; k < 3; k++)
            if (shot_of_shape(&other, &l.s, l.file, outline_look(&l, scenes[k], layers[k]), NULL, &l.view)) {
                check_at_most("P15", shot_differing(&s, &other, 2), 0, "values that differ, way %d", k);
                shot_release(&other);
            }
        shot_release(&s);
    }
    shape_release(&l.s);
}

/* --- halftones ------------------------------------------------------------------------------------------ */

/* Blocks of dots have as much ink as shadow and corner take light. */
static void dots_follow(void)
{
    enum { BLOCK = 20 };
    light_scene l = {.file = "court.glb",
                     .towards = lights[1],
                     .softness = 10,
                     .occlusion = 0.9,
                     .radius = 0.12,
                     .view = view_of(25, false)};
    shot        light, dots;
    char        look[768];
    l.view.width = 800;
    l.view.height = 640;
    court(&l.s);
    dvec back = dvec_unit(dvec_sub(l.view.eye, l.view.target)), right = dvec_unit(dvec_cross(l.view.up, back)),
         up = dvec_cross(back, right);
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"t\",\"scene\":{\"fill\":0,\"light_scale\":0.99,\"light_direction\":\"%.9f,%.9f,"
             "%.9f\",\"shadows\":true,\"shadow_softness\":10,\"occlusion\":0.9,\"occlusion_radius\":0.12},"
             "\"rules\":[{\"surface\":{\"technique\":\"dots\",\"uneven\":0,\"shadow\":0,\"light\":1,\"contrast\":1,"
             "\"texture\":0,\"ink\":\"#000000\",\"paper\":\"#ffffff\",\"diameter\":2}}]}",
             dvec_dot(right, l.towards), dvec_dot(up, l.towards), dvec_dot(back, l.towards));
    if (light_shot(&light, &l, true)) {
        if (shot_of_shape(&dots, &l.s, l.file, look, NULL, &l.view)) {
            double off = 0, low = 1, high = 0;
            int    blocks = 0;
            for (int y = 0; y + BLOCK <= light.height; y += BLOCK)
                for (int x = 0; x + BLOCK <= light.width; x += BLOCK) {
                    double tone = 0, drawn = 0;
                    bool   whole = true;
                    for (int j = y; j < y + BLOCK; j++)
                        for (int i = x; i < x + BLOCK; i++) {
                            size_t at = (size_t)j * (size_t)light.width + (size_t)i;
                            whole = whole && light.depth[at] < INFINITY &&
                                    light.id[at] == light.id[(size_t)y * (size_t)light.width + (size_t)x];
                            tone += picture_linear(light.picture[4 * at]) / (BLOCK * BLOCK);
                            drawn += picture_shown(dots.picture[4 * at]) / (BLOCK * BLOCK);
                        }
                    if (!whole)
                        continue;
                    off += fabs(tone - drawn);
                    low = fmin(low, tone);
                    high = fmax(high, tone);
                    blocks++;
                }
            check_at_least("P21", blocks, 100, "blocks of one surface, tones from %.2f to %.2f", low, high);
            check_at_least("P21", high - low, 0.5, "range of their tones");
            check_at_most("P21", off / blocks, 0.05, "mean difference of paper left from light that arrives");
            shot_release(&dots);
        }
        shot_release(&light);
    }
    shape_release(&l.s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"penumbra", penumbras_grow},
        {"even", light_is_even_between_samples},
        {"borders", borders_of_the_page_are_light},
        {"ridges", ridges_are_light},
        {"grazing", floors_are_dark_at_a_grazing_view},
        {"mirrored", shadows_are_mirrored},
        {"shadows", shadows_are_a_discs},
        {"hard", hard_is_hard},
        {"contact", contact_has_no_gap},
        {"gap", thin_gaps_are_dark},
        {"acne", no_acne},
        {"lights", other_lights_stay},
        {"paths", one_picture},
        {"solid", solids_too},
        {"motion", light_moves},
        {"corners", corners_are_darker},
        {"falloff", darkness_falls_off},
        {"strength", strength_is_a_fraction},
        {"plane", planes_stay},
        {"halo", no_halo},
        {"outlines", outlines_lie_on_borders},
        {"elsewhere", outlines_nowhere_else},
        {"sheets", outlines_on_sheets},
        {"dots", dots_follow},
    };
    int status = check_main(argc, argv, "light", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
