/* Tonal art maps on surfaces: tone, strokes that go on in darker tones, widths over distance, plateaus. Notes:
 * seed-grossmann rows 4 and 5, seed-pencil-city P17 to P21, P29, P39. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone_scenes.h"
#include "picture.h"

enum { SIDE = 256 };

static bool take(shot *out, const char *keys, double darkness, double octave)
{
    char surface[400];
    snprintf(surface, sizeof surface, "tonal-art-map\",\"shadow\":%.9g,\"light\":%.9g,%s", 1 - darkness, 1 - darkness,
             keys);
    return halftone_far(out, surface, octave, SIDE, 1);
}

/* Mean ink for each darkness of a ramp. */
static void ramp(const char *keys, double octave, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        shot s;
        out[i] = 0;
        if (take(&s, keys, (double)i / (count - 1), octave)) {
            out[i] = halftone_mean(&s, 0, 0, SIDE, SIDE);
            shot_release(&s);
        }
    }
}

static void tones_on_a_ramp(void)
{
    static const char *const keys[] = {"\"coordinates\":\"uv\"", "\"coordinates\":\"triplanar\"",
                                       "\"coordinates\":\"triplanar\",\"opacity\":0.4"};
    /* On texture coordinates of a unit of 100 px, triplanar at full octaves and where they hand over. */
    static const double octaves[] = {-1.35614381, 0, 0.25, 0.5, 0.75};
    for (int k = 0; k < 3; k++)
        for (int o = 0; o < (k ? 5 : 1); o++) {
            double got[17], worst = 0, at = 0;
            ramp(keys[k], octaves[o], 17, got);
            for (int i = 0; i < 17; i++) {
                double wanted = fmin(i / 16.0, 0.85), off = fabs(got[i] - wanted);
                at = off > worst ? i / 16.0 : at;
                worst = fmax(worst, off);
            }
            check_at_most("P17", worst, 0.05, "%s at octave %.2f: ink off on a ramp of 17 tones (worst at %.3f)",
                          keys[k], octaves[o], at);
        }
}

/* Streaks within strokes, and dots instead of them, give the same tones. */
static void other_material_keeps_tones(void)
{
    static const char *const keys[] = {
        "\"coordinates\":\"triplanar\",\"grain\":0.8,\"darkest\":0.7",
        "\"coordinates\":\"triplanar\",\"strokes\":\"stipple\",\"width\":2.5,\"darkest\":0.7"};
    for (int k = 0; k < 2; k++) {
        double got[17], worst = 0;
        ramp(keys[k], 0, 17, got);
        for (int i = 0; i < 17; i++)
            worst = fmax(worst, fabs(got[i] - fmin(i / 16.0, 0.7)));
        check_at_most(k ? "P39" : "P29", worst, 0.05, "%s: ink off on a ramp of 17 tones", keys[k]);
    }
}

/* Mean steps of ink from pixel to pixel, across over up. */
static double lying(const shot *s)
{
    double across = 0, up = 0;
    for (int y = 0; y + 1 < SIDE; y++)
        for (int x = 0; x + 1 < SIDE; x++) {
            across += fabs(halftone_ink(s, x, y) - halftone_ink(s, x + 1, y));
            up += fabs(halftone_ink(s, x, y) - halftone_ink(s, x, y + 1));
        }
    return up / across;
}

static void dots_are_round_and_strokes_grained(void)
{
    static const char *const surfaces[] = {"", ",\"strokes\":\"stipple\"", ",\"grain\":0.9"};
    double                   solid[3] = {0};
    for (int k = 0; k < 3; k++) {
        shot s;
        char keys[200];
        snprintf(keys, sizeof keys, "\"coordinates\":\"uv\",\"cross\":false,\"width\":3%s", surfaces[k]);
        if (!take(&s, keys, 0.3, -1.35614381))
            return;
        for (int i = 0; i < SIDE * SIDE; i++)
            solid[k] += halftone_ink(&s, i % SIDE, i / SIDE) > 0.95;
        if (k == 0)
            check_at_least("P39", lying(&s), 3, "steps of ink across strokes over those along them");
        if (k == 1)
            check_near("P39", lying(&s), 1, 0.1, "the same of dots");
        shot_release(&s);
    }
    check_at_most("P29", solid[2] / solid[0], 0.35, "fraction of full ink in strokes that grain leaves");
}

/* A wall with a window in its map: its bars are there from near, its frame a little longer, its storey and hatching
 * always. */
static void windows_are_there_from_near(void)
{
    static const double octaves[] = {-1.35614381, -0.35614381, 0.64385619}; /* 256, 128 and 64 px a unit */
    for (int k = 0; k < 3; k++) {
        shot   s;
        int    unit = SIDE >> k;
        double bars = 0, frame = 0, storey = 0, hatching = 0;
        if (!take(&s,
                  "\"coordinates\":\"uv\",\"repeat\":1,\"darkest\":0.5,\"strokes\":\"" LIMNER_SOURCE
                  "/../examples/windows.stx\"",
                  0.5, octaves[k]))
            return;
        for (int y = unit * 3 / 10; y < unit * 5 / 10; y++)
            for (int x = -2; x <= 2; x++) {
                bars += halftone_ink(&s, unit / 2 + x, SIDE - 1 - y) / (unit / 5);
                frame += halftone_ink(&s, unit * 3 / 10 + x, SIDE - 1 - y) / (unit / 5);
            }
        for (int y = 0; y < 5; y++)
            storey += halftone_ink(&s, unit * 9 / 10, SIDE - 1 - (int)(0.04 * unit) + 2 - y);
        hatching = halftone_mean(&s, 0, SIDE - unit, unit / 5, unit);
        check_note("%d px a bay: bars %.2f px, frame %.2f px, storey %.2f px, hatching %.2f", unit, bars, frame, storey,
                   hatching);
        check_that("P39", k == 0 ? bars > 1.2 : bars < 0.05, "%d px a bay: the window has %s", unit,
                   k ? "no bars" : "bars");
        check_that("P39", k < 2 ? frame > 1.2 : frame < 0.05, "it has %s", k < 2 ? "a frame" : "no frame");
        check_at_least("P39", storey, 1.2, "px of ink across the storey's line");
        check_at_least("P39", hatching, 0.2, "ink of the wall");
        shot_release(&s);
    }
}

static void strokes_go_on(void)
{
    static const char *const blends[] = {"nearest", "between"};
    for (int b = 0; b < 2; b++) {
        shot   before, now;
        char   keys[128];
        int    lost = 0;
        double largest = 0;
        snprintf(keys, sizeof keys, "\"coordinates\":\"uv\",\"blend\":\"%s\"", blends[b]);
        if (!take(&before, keys, 0, -1.35614381))
            return;
        for (int i = 1; i <= 24; i++) {
            if (!take(&now, keys, 0.85 * i / 24, -1.35614381))
                break;
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    double less = halftone_ink(&before, x, y) - halftone_ink(&now, x, y);
                    largest = fmax(largest, less);
                    lost += less > 0.02;
                }
            shot_release(&before);
            before = now;
        }
        shot_release(&before);
        check_at_most("P18", lost, 0, "%s: pixels in 24 steps towards black that lose ink (at most %.4f)", blends[b],
                      largest);
    }
}

static void widths_over_distance(void)
{
    double thin = 1e9, wide = 0, off = 0, first = 0;
    for (int k = 0; k <= 24; k++) {
        shot   s;
        double within;
        if (!take(&s, "\"coordinates\":\"triplanar\",\"cross\":false,\"uneven\":0,\"width\":1", 0.14, k / 4.0))
            return;
        double width = halftone_width(&s, &within), ink = halftone_mean(&s, 0, 0, SIDE, SIDE);
        shot_release(&s);
        thin = fmin(thin, width);
        wide = fmax(wide, width);
        first = k ? first : ink;
        off = fmax(off, fabs(ink / fmax(first, 1e-9) - 1));
    }
    check_at_least("P19", thin, 0.5, "mean px of strokes over 1:64, least");
    check_at_most("P19", wide, 1.6, "mean px of strokes over 1:64, most");
    check_at_most("P19", off, 0.25, "fraction of ink off the nearest's over 1:64, where octaves hand over as well");
}

static void plateaus(void)
{
    double nearest[49], between[49];
    int    levels = 1;
    double step = 0, largest = 0;
    ramp("\"coordinates\":\"uv\",\"blend\":\"nearest\"", -1.35614381, 49, nearest);
    ramp("\"coordinates\":\"uv\",\"blend\":\"between\"", -1.35614381, 49, between);
    for (int i = 1; i < 49; i++) {
        double change = nearest[i] - nearest[i - 1];
        levels += fabs(change) > 1e-6;
        largest = fmax(largest, change);
        step = fmax(step, fabs(between[i] - between[i - 1]));
    }
    check_near("P20", levels, 7, 0, "amounts of ink of blend=nearest with 6 tones and paper");
    check_near("P20", largest, 0.85 / 6, 0.03, "ink between two of them");
    check_at_most("P20", step, 0.03, "largest step of blend=between in 48");
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"tones", tones_on_a_ramp},
                                       {"material", other_material_keeps_tones},
                                       {"shapes", dots_are_round_and_strokes_grained},
                                       {"windows", windows_are_there_from_near},
                                       {"nested", strokes_go_on},
                                       {"widths", widths_over_distance},
                                       {"plateaus", plateaus}};
    halftone_begin();
    int status = check_main(argc, argv, "tonal_art_map", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
