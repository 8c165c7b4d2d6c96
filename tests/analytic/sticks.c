/* Media laid with the side of a stick: strokes that follow faces, on teeth that are as large on paper at any size. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "hatch_truth.h"
#include "one_tone.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 512, BLUR = 3 };

static const double PI = 3.14159265358979323846;

static const char *const media[] = {"chalk", "charcoal", "crayon"};
enum { MEDIA = sizeof media / sizeof *media };

static double shown(const uint8_t *rgba)
{
    return (0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2]) / 255;
}

/* Means over squares: grains are finer than strokes. */
static double around(const shot *s, int x, int y)
{
    double sum = 0;
    for (int j = -BLUR; j <= BLUR; j++)
        for (int i = -BLUR; i <= BLUR; i++)
            sum += shown(&s->picture[4 * ((size_t)(y + j) * (size_t)s->width + (size_t)(x + i))]);
    return sum;
}

/* Twice the angle along which the columns from `left` to `right` change least, and how sure that is: the structure
 * tensor's smaller axis. */
static void slant(const shot *s, int left, int right, double out[2])
{
    double xx = 0, xy = 0, yy = 0;
    for (int y = SIDE / 4; y < 3 * SIDE / 4; y += 2)
        for (int x = left; x < right; x += 2) {
            double dx = around(s, x + 1, y) - around(s, x - 1, y), dy = around(s, x, y - 1) - around(s, x, y + 1);
            xx += dx * dx;
            xy += dx * dy;
            yy += dy * dy;
        }
    double cosine = yy - xx, sine = -2 * xy;
    out[0] = atan2(sine, cosine);
    out[1] = hypot(cosine, sine) / (xx + yy);
}

/* The two faces of an edge, equally dark: strokes of each have a direction, and not the other's. */
static void faces_have_their_own_strokes(void)
{
    shape    model = {0};
    one_tone even;
    one_tone_set(&even, 0.55, NULL);
    shape_wedge(&model, "wedge", 80);
    for (size_t m = 0; m < MEDIA; m++) {
        shot      s;
        shot_view view = {.width = SIDE,
                          .height = SIDE,
                          .eye = {0, 0.5, 5},
                          .target = {0, 0.5, 0},
                          .up = {0, 1, 0},
                          .fov_deg = 12,
                          .without_maps = true};
        if (!shot_of_shape(&s, &model, "wedge.glb", media[m], even.changes, &view))
            continue;
        double left[2], right[2];
        slant(&s, SIDE / 2 - SIDE / 3, SIDE / 2 - 24, left);
        slant(&s, SIDE / 2 + 24, SIDE / 2 + SIDE / 3, right);
        double between = fabs(remainder(left[0] - right[0], 2 * PI)) / 2 * 180 / PI;
        check_at_least("sticks", between, 25, "%s: degrees between the strokes of two faces", media[m]);
        check_at_least("sticks", fmin(left[1], right[1]), 0.12, "  how much they have a direction");
        shot_release(&s);
    }
    shape_release(&model);
}

static bool wall(shot *out, const shape *model, const char *look, int finer, double tone)
{
    int       side = finer * SIDE;
    one_tone  even;
    shot_view view = {.width = side,
                      .height = side,
                      .dpi = 96 * finer,
                      .eye = {0, 0, 5},
                      .up = {0, 1, 0},
                      .orthographic = true,
                      .without_maps = true};
    one_tone_set(&even, tone, NULL);
    return shot_of_shape(out, model, "stick_wall.glb", look, even.changes, &view);
}

/* Strokes and teeth are lengths on paper: a picture of twice the size is the same drawing, finer. */
static void sizes_are_one_drawing(void)
{
    shape model = {0};
    shape_quad(&model, "wall", 20, 0);
    for (size_t m = 0; m < MEDIA; m++) {
        shot small, large;
        if (!wall(&small, &model, media[m], 1, 0.55))
            continue;
        if (wall(&large, &model, media[m], 2, 0.55)) {
            double a = 0, b = 0, aa = 0, bb = 0, ab = 0, count = 0;
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++, count++) {
                    const uint8_t *at = &large.picture[8 * ((size_t)(2 * y) * SIDE + (size_t)x)];
                    double         p = shown(&small.picture[4 * ((size_t)y * SIDE + (size_t)x)]),
                           q = (shown(at) + shown(at + 4) + shown(at + 8 * SIDE) + shown(at + 8 * SIDE + 4)) / 4;
                    a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
                }
            double spread = sqrt((aa / count - a * a / count / count) * (bb / count - b * b / count / count));
            check_near("sticks", a / count, b / count, 0.01, "%s: tone at two sizes", media[m]);
            check_at_least("sticks", (ab / count - a * b / count / count) / spread, 0.8, "  how alike they are");
            shot_release(&large);
        }
        shot_release(&small);
    }
    shape_release(&model);
}

enum { SQUARE = 30 }; /* pixels: 8 mm, wider than a stroke */

/* How much the means of squares differ; `inside`: the least deviation in one of them. */
static double unevenness(const shot *s, double *inside)
{
    double sum = 0, squares = 0, count = 0;
    *inside = INFINITY;
    for (int y = 0; y + SQUARE <= SIDE; y += SQUARE)
        for (int x = 0; x + SQUARE <= SIDE; x += SQUARE, count++) {
            double mean = 0, square = 0;
            for (int i = 0; i < SQUARE * SQUARE; i++) {
                size_t at = (size_t)(y + i / SQUARE) * SIDE + (size_t)(x + i % SQUARE);
                double tone = shown(&s->picture[4 * at]);
                mean += tone / (SQUARE * SQUARE), square += tone * tone / (SQUARE * SQUARE);
            }
            sum += mean, squares += mean * mean;
            *inside = fmin(*inside, sqrt(fmax(square - mean * mean, 0)));
        }
    return sqrt(squares / count - sum * sum / count / count);
}

/* A hand presses harder here and lighter there. */
static void hands_press_unevenly(void)
{
    shape model = {0};
    shape_quad(&model, "wall", 20, 0);
    for (size_t m = 0; m < MEDIA; m++) {
        double uneven = 0, inside;
        shot   s;
        for (int i = 1; i < 4; i++)
            if (wall(&s, &model, media[m], 1, 0.25 * i)) {
                uneven += unevenness(&s, &inside) / 3;
                shot_release(&s);
            }
        check_at_least("sticks", uneven, 0.028, "%s: how much squares of 8 mm differ in tone", media[m]);
    }
    shape_release(&model);
}

/* No tone of chalk is paper alone, that of the paper included. */
static void nothing_stays_empty(void)
{
    shape  model = {0};
    double least = INFINITY, inside;
    shot   s;
    shape_quad(&model, "wall", 20, 0);
    for (int i = 4; i < 15; i++)
        if (wall(&s, &model, "chalk", 1, 0.05 * i)) {
            unevenness(&s, &inside);
            least = fmin(least, inside);
            shot_release(&s);
        }
    check_at_least("sticks", least, 0.03, "chalk: deviation of tone within 8 mm, least of all");
    shape_release(&model);
}

/* The mean of a wall, or of two that stand beside each other with a cleft between. */
static double cleft(const shape *model, const char *accent)
{
    const char *changes[] = {
        "surface.accent", accent, "lines.operator", "none", "scene.ground", "none", "surface.shadow", "0.4", NULL};
    shot      s;
    shot_view view = {
        .width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .fov_deg = 25, .without_maps = true};
    double sum = 0;
    if (!shot_of_shape(&s, model, "cleft.glb", "charcoal", changes, &view))
        return NAN;
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += shown(&s.picture[4 * (size_t)i]) / (SIDE * SIDE);
    shot_release(&s);
    return sum;
}

/* Accents darken clefts, and nothing that is open. */
static void accents_lie_in_clefts(void)
{
    shape clefts = {0}, open = {0};
    for (int i = 0; i < 6; i++)
        shape_box(&clefts, "post", dvec_of(0.4 * i - 1.2, -1, 0), dvec_of(0.4 * i - 1.1, 1, 0.3));
    shape_box(&clefts, "back", dvec_of(-1.2, -1, -0.2), dvec_of(1.2, 1, 0));
    shape_quad(&open, "wall", 20, 0);
    check_at_least("sticks", cleft(&clefts, "0") - cleft(&clefts, "1"), 0.003, "how much darker accents make clefts");
    check_near("sticks", cleft(&open, "1"), cleft(&open, "0"), 1e-9, "a wall, with accents and without");
    shape_release(&clefts);
    shape_release(&open);
}

/* --- motion --------------------------------------------------------------------------------------------- */

typedef struct motion {
    const char *what;
    double      turned, aside, nearer, lit; /* degrees, fraction of the distance twice, degrees */
    double      limit;
} motion;

/* A frame of a viewer who turns around a model, goes aside and comes nearer, under a light that stays or turns. */
static bool frame(shot *out, const char *look, const motion *m)
{
    char   light[96];
    double angle = (30 + m->turned) * PI / 180, to = (20 + m->lit - m->turned) * PI / 180, distance = 7 * m->nearer;
    double across = 7 * m->aside;
    const char *changes[] = {"lines.operator",
                             "none",
                             "perturb.technique",
                             "none",
                             "scene.ground",
                             "none",
                             "scene.light_direction",
                             light,
                             NULL};
    dvec        aside = dvec_of(across * cos(angle), 0, -across * sin(angle));
    shot_view   view = {.width = 480, .height = 384, .target = aside, .up = {0, 1, 0}};
    shape       model = {0};
    view.eye = dvec_add(aside, dvec_of(distance * sin(angle), 0.35 * distance, distance * cos(angle)));
    snprintf(light, sizeof light, "%.9f,0.6,%.9f", sin(to), cos(to));
    hatch_model(&model);
    bool good = shot_of_shape(out, &model, "moved.glb", look, changes, &view);
    shape_release(&model);
    return good;
}

/* The bounds that strokes on surfaces have (hatch_coherence.c). Strokes of sticks lie on the page and go with the
 * model's middle; what is seen to change is what the surface moves under them. */
static void frames_follow_each_other(void)
{
    static const motion rest = {"", 0, 0, 1, 0, 0}, steps[] = {{"turning by 0.5 degrees", 0.5, 0, 1, 0, 0.003},
                                                               {"going aside by 1 %", 0, 0.01, 1, 0, 0.003},
                                                               {"approaching by 1 %", 0, 0, 0.99, 0, 0.003},
                                                               {"light turning by 1 degree", 0, 0, 1, 1, 0.007}};
    for (size_t m = 0; m < MEDIA; m++) {
        shot before, now;
        if (!frame(&before, media[m], &rest))
            continue;
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
            if (!frame(&now, media[m], &steps[k]))
                continue;
            hatch_change h = hatch_compare(&now, &before);
            check_at_most("EX-09", h.changed, steps[k].limit,
                          "%s, %s: fraction of pixels that change by more than a quarter", media[m], steps[k].what);
            check_at_most("EX-09", h.block, 0.06,
                          "  largest change of the ink of 16 x 16 px (correlation %.3f, %d pixels)", h.correlation,
                          h.pixels);
            shot_release(&now);
        }
        shot_release(&before);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"faces", faces_have_their_own_strokes}, {"sizes", sizes_are_one_drawing},
                                       {"clefts", accents_lie_in_clefts},       {"pressure", hands_press_unevenly},
                                       {"empty", nothing_stays_empty},          {"motion", frames_follow_each_other}};
    int                     status = check_main(argc, argv, "sticks", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
