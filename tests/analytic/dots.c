/* Dots on surfaces: tone by number and size, diameters, number over distance, positions that stay; and the inks of all
 * halftones. Requirement R-L3 of seed 001. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone_scenes.h"
#include "picture.h"

enum { SIDE = 256, DOTS_MAX = 20000 };

static bool take(shot *out, const char *keys, double darkness, double octave)
{
    char surface[400];
    snprintf(surface, sizeof surface, "dots\",\"uneven\":0,\"shadow\":%.9g,\"light\":%.9g,%s", 1 - darkness,
             1 - darkness, keys);
    return halftone_far(out, surface, octave, SIDE, 1);
}

static void tones_on_a_ramp(void)
{
    static const char *const keys[] = {"\"tone_by\":\"number\"", "\"tone_by\":\"size\"",
                                       "\"tone_by\":\"number\",\"wobble\":0", "\"tone_by\":\"size\",\"scale\":12"};
    for (int k = 0; k < 4; k++)
        for (int o = 0; o < 4; o++) {
            double worst = 0, at = 0;
            char   line[256] = "";
            for (int i = 0; i <= 16; i++) {
                shot s;
                if (!take(&s, keys[k], i / 16.0, 0.25 * o))
                    return;
                double ink = halftone_mean(&s, 0, 0, SIDE, SIDE);
                snprintf(line + strlen(line), sizeof line - strlen(line), " %.3f", ink);
                if (fabs(ink - i / 16.0) > worst) {
                    worst = fabs(ink - i / 16.0);
                    at = i / 16.0;
                }
                shot_release(&s);
            }
            check_note("%s", line);
            check_at_most("R-L3", worst, k % 2 ? 0.11 : 0.055,
                          "%s at octave %.2f: ink off on a ramp of 17 tones (worst at %.3f)", keys[k], 0.25 * o, at);
        }
}

typedef struct dot {
    double x, y, area;
} dot;

/* Pixels with ink that hang together; those at the border are left out. */
static int dots_in(const shot *s, dot *out)
{
    int   count = 0;
    int  *stack = check_alloc((size_t)(s->width * s->height), sizeof *stack);
    char *seen = check_alloc((size_t)(s->width * s->height), 1);
    for (int i = 0; i < s->width * s->height; i++) {
        if (seen[i] || halftone_ink(s, i % s->width, i / s->width) < 0.02)
            continue;
        dot  d = {0, 0, 0};
        int  top = 0;
        bool whole = true;
        stack[top++] = i;
        seen[i] = 1;
        while (top) {
            int    at = stack[--top], x = at % s->width, y = at / s->width;
            double ink = halftone_ink(s, x, y);
            d.x += (x + 0.5) * ink;
            d.y += (y + 0.5) * ink;
            d.area += ink;
            whole = whole && x > 0 && y > 0 && x + 1 < s->width && y + 1 < s->height;
            for (int k = 0; k < 8; k++) {
                static const int dx[] = {-1, 0, 1, -1, 1, -1, 0, 1}, dy[] = {-1, -1, -1, 0, 0, 1, 1, 1};
                int              nx = x + dx[k], ny = y + dy[k], n = ny * s->width + nx;
                if (nx >= 0 && ny >= 0 && nx < s->width && ny < s->height && !seen[n] &&
                    halftone_ink(s, nx, ny) >= 0.02) {
                    seen[n] = 1;
                    stack[top++] = n;
                }
            }
        }
        if (whole && d.area > 0.05 && count < DOTS_MAX)
            out[count++] = (dot){d.x / d.area, d.y / d.area, d.area};
    }
    free(stack);
    free(seen);
    return count;
}

static int by_area(const void *a, const void *b)
{
    double left = ((const dot *)a)->area, right = ((const dot *)b)->area;
    return left < right ? -1 : left > right;
}

static void diameters_and_numbers(void)
{
    static dot          dots[DOTS_MAX];
    static const double diameters[] = {3, 6};
    for (int d = 0; d < 2; d++) {
        double least = 1e9, most = 0, thin = 1e9, wide = 0;
        char   keys[128];
        snprintf(keys, sizeof keys, "\"tone_by\":\"number\",\"diameter\":%g", diameters[d]);
        for (int k = 0; k <= 24; k++) {
            shot s;
            if (!take(&s, keys, 0.08, k / 4.0))
                return;
            int    count = dots_in(&s, dots);
            double ink = halftone_mean(&s, 0, 0, SIDE, SIDE);
            shot_release(&s);
            qsort(dots, (size_t)count, sizeof *dots, by_area);
            /* Those of the largest fifth: dots that only begin to be there are small. */
            double middle = count ? 2 * sqrt(dots[count * 4 / 5].area / 3.14159) : 0;
            thin = fmin(thin, middle);
            wide = fmax(wide, middle);
            least = fmin(least, ink);
            most = fmax(most, ink);
        }
        check_at_least("R-L3", thin, diameters[d] - 0.5, "px of dots of %g over 1:64, least", diameters[d]);
        check_at_most("R-L3", wide, diameters[d] + 0.5, "px of dots of %g over 1:64, most", diameters[d]);
        check_at_most("R-L3", most / least - 1, 0.3, "spread of their ink over 1:64 (+-15 %%)");
    }
}

/* The eye goes around by 6 degrees: what was under a dot is under one still. */
static void dots_stay_in_place(void)
{
    static dot     before[DOTS_MAX], after[DOTS_MAX];
    halftone_scene scene = {0};
    shot           a, b;
    shot_view      view = halftone_view(SIDE, SIDE, 100);
    halftone_add_wall(&scene, "wall", (halftone_wall){-5, -5, 0, 12, 12, 1});
    const char *look = halftone_look(
        "dots\",\"uneven\":0,\"wobble\":0.5,\"tone_by\":\"number\",\"diameter\":4,\"shadow\":0.92,\"light\":0.92");
    double    c[3] = {view.target.x, view.target.y, 0}, turn = 6 * 0.0174533;
    shot_view turned = view;
    turned.eye = dvec_of(c[0] + 10 * sin(turn), c[1], 10 * cos(turn));
    if (halftone_shot(&a, &scene, "place.gltf", look, NULL, &view) &&
        halftone_shot(&b, &scene, "place.gltf", look, NULL, &turned)) {
        int n = dots_in(&a, before), m = dots_in(&b, after), found = 0, looked = 0;
        for (int i = 0; i < n; i++) {
            if (before[i].area < 8 || before[i].x < 20 || before[i].x > SIDE - 20)
                continue;
            dvec   at = shot_project(&b, dvec_of(before[i].x / 100, (SIDE - before[i].y) / 100, 0));
            double nearest = 1e9;
            for (int k = 0; k < m; k++)
                nearest = fmin(nearest, hypot(after[k].x - at.x, after[k].y - at.y));
            looked++;
            found += nearest < 0.75;
        }
        check_at_least("R-L3", looked, 50, "dots looked for");
        check_at_least("R-L3", (double)found / fmax(looked, 1), 0.9,
                       "fraction of them found at the same place of the surface after a turn of 6 degrees");
        shot_release(&b);
    }
    shot_release(&a);
    halftone_release(&scene);
}

/* --- inks ----------------------------------------------------------------------------------------------- */

static bool mean_colour(double out[3], const char *surface, const float colour[3])
{
    halftone_scene scene = {0};
    shot           s;
    shot_view      view = halftone_view(SIDE, SIDE, 71);
    halftone_part *p = halftone_add_wall(&scene, "wall", (halftone_wall){-5, -5, 0, 12, 12, 1});
    memcpy(p->colour, colour, sizeof p->colour);
    bool ok = halftone_shot(&s, &scene, "inks.gltf", halftone_look(surface), NULL, &view);
    memset(out, 0, 3 * sizeof *out);
    for (int i = 0; ok && i < SIDE * SIDE; i++)
        for (int k = 0; k < 3; k++)
            out[k] += picture_shown(s.picture[4 * i + k]) / (SIDE * SIDE);
    shot_release(&s);
    halftone_release(&scene);
    return ok;
}

static void two_inks(void)
{
    static const float white[3] = {1, 1, 1};
    double paper[3] = {1, 1, 1}, second[3] = {picture_shown(0xc0), picture_shown(0x40), picture_shown(0x20)};
    for (int i = 0; i <= 4; i++) {
        double got[3], d = i / 4.0, light = fmin(2 * d, 1), dark = fmax(2 * d - 1, 0), worst = 0;
        char   surface[300];
        snprintf(surface, sizeof surface,
                 "dots\",\"uneven\":0,\"ink\":\"#000000\",\"paper\":\"#ffffff\",\"inks\":\"two\",\"second_ink\":\"#"
                 "c04020\",\"shadow\":%g,\"light\":%g",
                 1 - d, 1 - d);
        if (!mean_colour(got, surface, white))
            return;
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(got[k] - (paper[k] * (1 - light) + second[k] * light) * (1 - dark)));
        check_at_most("inks", worst, 0.05, "two inks at darkness %.2f: mean colour off the mixture (%.3f %.3f %.3f)", d,
                      got[0], got[1], got[2]);
    }
}

/* The colours that inks can give are seen on the page; of those they cannot, as deep blue, channels keep their order.
 */
static void four_inks(void)
{
    static const float colours[][3] = {{0.6f, 0.05f, 0.05f}, {0.12f, 0.42f, 0.12f}, {0.6f, 0.55f, 0.05f},
                                       {0.05f, 0.4f, 0.5f},  {0.5f, 0.1f, 0.25f},   {0.3f, 0.3f, 0.3f},
                                       {0.15f, 0.22f, 0.3f}, {0.7f, 0.4f, 0.25f},   {0.05f, 0.05f, 0.6f}};
    enum { COLOURS = sizeof colours / sizeof *colours, SEEN = COLOURS - 1 };
    int    wrong = 0;
    double off = 0;
    for (int i = 0; i < COLOURS; i++) {
        double got[3], worst = 0;
        if (!mean_colour(got,
                         "dots\",\"uneven\":0,\"ink\":\"#000000\",\"paper\":\"#ffffff\",\"inks\":\"cmyk\",\"texture\":"
                         "1,\"shadow\":1,\"light\":1,\"tone_by\":\"size\"",
                         colours[i]))
            return;
        for (int k = 0; k < 3; k++) {
            worst = fmax(worst, fabs(got[k] - picture_srgb((double)colours[i][k]) / 255));
            for (int j = 0; j < 3; j++)
                wrong += (double)(colours[i][k] - colours[i][j]) > 0.2 && got[k] <= got[j];
        }
        off = i < SEEN ? fmax(off, worst) : off;
        check_note("cmyk: wanted %.3f %.3f %.3f, got %.3f %.3f %.3f, off by %.3f",
                   picture_srgb((double)colours[i][0]) / 255, picture_srgb((double)colours[i][1]) / 255,
                   picture_srgb((double)colours[i][2]) / 255, got[0], got[1], got[2], worst);
    }
    check_at_most("inks", wrong, 0, "pairs of components of nine colours that change order in cmyk");
    check_at_most("inks", off, 0.03, "  channels of eight of them off the colour that is wanted");
}

static void light_ink_on_dark_paper(void)
{
    static const float       white[3] = {1, 1, 1};
    static const char *const techniques[] = {"dots", "screen", "tonal-art-map"};
    for (int t = 0; t < 3; t++) {
        double before = -1, worst = 0;
        int    back = 0;
        for (int i = 0; i <= 6; i++) {
            double got[3], tone = i / 7.0;
            char   surface[300];
            snprintf(surface, sizeof surface,
                     "%s\",\"uneven\":0,\"ink\":\"#ffffff\",\"paper\":\"#000000\",\"shadow\":%g,\"light\":%g%s",
                     techniques[t], tone, tone, t == 1 ? ",\"screen\":\"lines\"" : "");
            if (!mean_colour(got, surface, white))
                return;
            back += got[0] < before;
            before = got[0];
            worst = fmax(worst, fabs(got[0] - fmin(tone, t == 2 ? 0.85 : 1)));
        }
        check_at_most("inks", back, 0, "%s, light ink on dark paper: steps at which more light is darker",
                      techniques[t]);
        check_at_most("inks", worst, t == 1 ? 0.24 : 0.06, "%s: mean light off the tone", techniques[t]);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"tones", tones_on_a_ramp},
                                       {"sizes", diameters_and_numbers},
                                       {"places", dots_stay_in_place},
                                       {"two", two_inks},
                                       {"cmyk", four_inks},
                                       {"light", light_ink_on_dark_paper}};
    halftone_begin();
    int status = check_main(argc, argv, "dots", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
