/* Tone, measured on finished marks: wedges of the looks that draw tone, and what range of it they draw of models. Tone
 * is the mean of what is shown (sRGB). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "one_tone.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { LEVELS = 33, WEDGE = 320, SIDE = 384, CELL = 6 };

static double shown(const uint8_t *rgba)
{
    return (0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2]) / 255;
}

/* A wall that a look draws at one tone; `without`: a parameter that shall be 0, too, or NULL. */
static bool wall_shot(shot *out, const char *look, double tone, double half, const char *without)
{
    shape     model = {0};
    one_tone  even;
    shot_view view = {
        .width = WEDGE, .height = WEDGE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true, .without_maps = true};
    one_tone_set(&even, tone, without);
    shape_quad(&model, "wall", half, 0);
    bool good = shot_of_shape(out, &model, "wall.glb", look, even.changes, &view);
    shape_release(&model);
    return good;
}

/* The mean of such a wall. */
static double wall(const char *look, double tone)
{
    shot   s;
    double sum = 0;
    if (!wall_shot(&s, look, tone, 20, NULL))
        return NAN;
    for (int i = 0; i < WEDGE * WEDGE; i++)
        sum += shown(&s.picture[4 * (size_t)i]) / (WEDGE * WEDGE);
    shot_release(&s);
    return sum;
}

/* Each ink has the curve of its own rows of dots: these lie otherwise to the pixels than those of the others, and as
 * small as here that is a thirtieth of the page. Light tones are of the second ink alone, which covers twice as much as
 * the tone is dark. */
static void inks_have_their_own_curves(void)
{
    static const char *const angles[] = {"0", "7.5", "45"};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++)
        for (int k = 1; k < 5; k++) {
            char look[512];
            snprintf(look, sizeof look,
                     "{\"version\":2,\"name\":\"two\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{"
                     "\"technique\":"
                     "\"screen\",\"screen\":\"dots\",\"coordinates\":\"screen\",\"inks\":\"two\",\"angle\":%s,"
                     "\"uneven\":0,\"scale\":"
                     "2.2,\"ink\":\"#000000\",\"second_ink\":\"#000000\"}}]}",
                     angles[i]);
            check_near("tone", wall(look, 0.5 + 0.1 * k), 0.2 * k, 0.01, "second ink at %s degrees, %d fifths bare",
                       angles[i], k);
        }
}

/* From the medium's black to its paper in even steps. */
static void wedges_are_even(void)
{
    static const struct {
        const char *look;
        double      worst;
    } media[] = {{"pencil", 0.02}, {"pencil-soft", 0.02}, {"charcoal", 0.02},
                 {"crayon", 0.02}, {"chalk", 0.02},       {"halftone", 0.02}};
    for (size_t m = 0; m < sizeof media / sizeof *media; m++) {
        double means[LEVELS], worst = 0;
        int    at = 0;
        for (int i = 0; i < LEVELS; i++)
            means[i] = wall(media[m].look, (double)i / (LEVELS - 1));
        for (int i = 0; i < LEVELS; i++) {
            double off = fabs((means[i] - means[0]) / (means[LEVELS - 1] - means[0]) - (double)i / (LEVELS - 1));
            at = off > worst ? i : at;
            worst = fmax(worst, off);
        }
        check_at_most("tone", worst, media[m].worst, "%s: off an even wedge from %.3f to %.3f (at step %d)",
                      media[m].look, means[0], means[LEVELS - 1], at);
    }
}

/* How far from each other the darkest and the lightest place of a wall are that a look draws at one tone: means over
 * squares of so many pixels, as much as two or three lines. */
static double clouds(const char *look, double tone)
{
    enum { SQUARE = 24, STEP = 8 };
    double *sums = check_alloc((size_t)(WEDGE + 1) * (WEDGE + 1), sizeof *sums), least = 1, most = 0;
    shot    s;
    if (wall_shot(&s, look, tone, 2, "surface.gradient")) {
        for (int y = 0; y < WEDGE; y++)
            for (int x = 0; x < WEDGE; x++)
                sums[(y + 1) * (WEDGE + 1) + x + 1] = shown(&s.picture[4 * ((size_t)y * WEDGE + (size_t)x)]) +
                                                      sums[y * (WEDGE + 1) + x + 1] + sums[(y + 1) * (WEDGE + 1) + x] -
                                                      sums[y * (WEDGE + 1) + x];
        for (int y = STEP; y + SQUARE + STEP <= WEDGE; y += STEP)
            for (int x = STEP; x + SQUARE + STEP <= WEDGE; x += STEP) {
                const double *high = &sums[y * (WEDGE + 1) + x], *low = &sums[(y + SQUARE) * (WEDGE + 1) + x];
                double        mean = (low[SQUARE] - low[0] - high[SQUARE] + high[0]) / (SQUARE * SQUARE);
                least = fmin(least, mean);
                most = fmax(most, mean);
            }
        shot_release(&s);
    }
    free(sums);
    return most - least;
}

/* Where light is even, so are the strokes of looks whose lines swell: their ends make no dark clouds. */
static void even_walls_have_no_clouds(void)
{
    static const char *const looks[] = {"woodcut", "engraving"};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
        for (int k = 0; k < 3; k++)
            check_at_most("tone", clouds(looks[i], 0.4 + 0.1 * k), 0.25, "%s at tone %.1f: dark and light places",
                          looks[i], 0.4 + 0.1 * k);
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Tones of cells that the model fills, from dark to light. */
static size_t tones_of(const shot *s, double *out)
{
    size_t count = 0;
    for (int y = 0; y + CELL <= s->height; y += CELL)
        for (int x = 0; x + CELL <= s->width; x += CELL) {
            double sum = 0;
            bool   whole = true;
            for (int i = 0; i < CELL * CELL; i++) {
                size_t at = (size_t)(y + i / CELL) * (size_t)s->width + (size_t)(x + i % CELL);
                whole = whole && s->depth[at] < INFINITY;
                sum += shown(&s->picture[4 * at]) / (CELL * CELL);
            }
            if (whole)
                out[count++] = sum;
        }
    qsort(out, count, sizeof *out, by_value);
    return count;
}

/* Whatever their colours: highlights stay paper, and the darkest is as dark as the medium goes. */
static void models_have_all_tones(void)
{
    static const char *const models[] = {"spot.obj", "fox.glb", "house.glb", "knot.glb", "pump.glb"}, *const looks[] = {
                                                                                                          "pencil",
                                                                                                          "pencil-soft",
                                                                                                          "charcoal"};
    static double tones[(SIDE / CELL) * (SIDE / CELL)];
    for (size_t l = 0; l < sizeof looks / sizeof *looks; l++) {
        double black = wall(looks[l], 0), paper = wall(looks[l], 1);
        for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
            const char *changes[] = {"lines.operator", "none", NULL};
            char        path[512];
            shot        s;
            shot_view   view = {.width = SIDE, .height = SIDE, .bare = true};
            snprintf(path, sizeof path, "%s/%s", LIMNER_EXAMPLES, models[m]);
            if (!shot_take(&s, path, looks[l], changes, &view))
                continue;
            size_t count = tones_of(&s, tones);
            check_at_least("tone", tones[count - 1 - count / 50], 0.93 * paper, "%s in %s: its lightest fiftieth",
                           models[m], looks[l]);
            check_at_most("tone", tones[count / 50], black + 0.05, "%s in %s: its darkest fiftieth (black is %.2f)",
                          models[m], looks[l], black);
            shot_release(&s);
        }
    }
}

/* A white wall with a painted half, turned from the key light, beside a lit one: what a look makes of the paint in the
 * shade, of the wall's own tone there, and of the lit one. */
static bool walls_in_shade(const char *look, double out[3])
{
    static const float paints[3][4] = {{0.9f, 0.9f, 0.9f, 1}, {0.9f, 0.9f, 0.9f, 1}, {0.18f, 0.25f, 0.08f, 1}};
    const char *changes[] = {"lines.operator", "none", "perturb.technique", "none", "scene.ground", "none", NULL};
    shape       model = {0};
    shot        s;
    shot_view   view = {.width = WEDGE, .height = WEDGE, .eye = {0, 0, 6}, .up = {0, 1, 0}, .orthographic = true};
    for (int i = 0; i < 3; i++) {
        /* the lit one faces the viewer, those in the shade lean to the right */
        shape_quad(&model, i == 0 ? "lit" : i == 1 ? "bare" : "painted", 0.5, 0);
        memcpy(model.parts[i].colour, paints[i], sizeof paints[i]);
        shape_place(&model, dvec_of(0, 1, 0), i ? 58 : -10, dvec_of(i ? 0.35 : -0.6, i == 2 ? -0.5 : i ? 0.5 : 0, 0));
    }
    bool good = shot_of_shape(&s, &model, "shade.glb", look, changes, &view);
    if (good) {
        double sums[3] = {0};
        int    counts[3] = {0};
        for (int y = 0; y < s.height; y++)
            for (int x = 0; x < s.width; x++) {
                int at = y * s.width + x;
                if (!(s.depth[at] < INFINITY))
                    continue;
                int which = x < s.width / 2 ? 0 : y < s.height / 2 ? 1 : 2;
                sums[which] += shown(&s.picture[4 * at]);
                counts[which]++;
            }
        for (int i = 0; i < 3; i++)
            out[i] = sums[i] / fmax(counts[i], 1);
        shot_release(&s);
    }
    shape_release(&model);
    return good;
}

/* Shade is transparent: what is painted there is told, and what is not is no mud. */
static void paint_is_told_in_shade(void)
{
    static const char *const looks[] = {"pencil", "stipple", "charcoal", "chalk", "crayon", "halftone"};
    for (size_t l = 0; l < sizeof looks / sizeof *looks; l++) {
        double at[3];
        if (!walls_in_shade(looks[l], at))
            continue;
        check_at_least("tone", at[1] - at[2], 0.12, "%s: how much darker paint is in the shade (%.2f lit, %.2f, %.2f)",
                       looks[l], at[0], at[1], at[2]);
        check_at_least("tone", at[1], 0.3, "%s: a white wall in the shade", looks[l]);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"wedges", wedges_are_even},
                                       {"inks", inks_have_their_own_curves},
                                       {"models", models_have_all_tones},
                                       {"clouds", even_walls_have_no_clouds},
                                       {"shade", paint_is_told_in_shade}};
    int                     status = check_main(argc, argv, "tone", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
