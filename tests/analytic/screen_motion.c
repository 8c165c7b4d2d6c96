/* Halftones in time and in motion: frames that follow each other, unevenness, wavering; approaching, turning, light
 * that moves; a slow panel. Seed 001, sections 6.8 and 9.2. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone_scenes.h"
#include "picture.h"
#include "shape.h"

/* --- time ----------------------------------------------------------------------------------------------- */

enum { TIMED = 256 };

static bool take_time(shot *out, const char *surface, double time)
{
    halftone_scene s = {0};
    shot_view      view = halftone_view(TIMED, TIMED, 40);
    view.time_s = time;
    halftone_add_wall(&s, "wall", (halftone_wall){0, 0, 0, 8, 8, 1});
    bool ok = halftone_shot(out, &s, "time.gltf", halftone_look(surface), NULL, &view);
    halftone_release(&s);
    return ok;
}

static void frames_follow_each_other(void)
{
    const char *surface = "screen\",\"screen\":\"cross\",\"scheme\":\"smooth\",\"uneven\":0,\"shadow\":0.5,\"light\":0."
                          "5,\"frames\":4,\"change\":2";
    shot        before, now, first;
    double      step = 0, whole = 0, mean = 0, spread = 0;
    if (!take_time(&first, surface, 0))
        return;
    if (!take_time(&before, surface, 0)) {
        shot_release(&first);
        return;
    }
    for (int i = 1; i <= 44; i++) {
        if (!take_time(&now, surface, i * 0.05))
            break;
        step = fmax(step, halftone_difference(&before, &now));
        whole = i == 10 ? halftone_difference(&first, &now) : whole;
        if (i == 40)
            check_at_most("IM-28", halftone_difference(&first, &now), 0.001,
                          "difference after all frames: they begin again");
        mean = halftone_mean(&now, 0, 0, TIMED, TIMED);
        spread = fmax(spread, fabs(mean - halftone_mean(&first, 0, 0, TIMED, TIMED)));
        shot_release(&before);
        before = now;
    }
    check_at_least("IM-28", whole, 0.1, "mean difference between two frames");
    check_at_most("IM-28", step / fmax(whole, 1e-9), 0.35, "fraction of it in a tenth of the time between them, most");
    check_note("tone while frames mix is off by up to %.4f", spread);
    shot_release(&before);
    shot_release(&first);
}

static void unevenness_lives(void)
{
    shot even, rough, later;
    if (!take_time(&even, "screen\",\"screen\":\"lines\",\"uneven\":0,\"shadow\":0.5,\"light\":0.5", 0))
        return;
    const char *surface = "screen\",\"screen\":\"lines\",\"uneven\":0.1,\"shadow\":0.5,\"light\":0.5,\"change\":1";
    if (take_time(&rough, surface, 0.3) && take_time(&later, surface, 1.9)) {
        check_at_least("IM-29", halftone_difference(&even, &rough), 0.01, "mean change by unevenness");
        check_at_least("IM-29", halftone_difference(&later, &rough), 0.01, "mean change over time");
        check_near("IM-29", halftone_mean(&rough, 0, 0, TIMED, TIMED), halftone_mean(&even, 0, 0, TIMED, TIMED), 0.06,
                   "mean ink stays");
        check_near("IM-29", halftone_mean(&later, 0, 0, TIMED, TIMED), halftone_mean(&even, 0, 0, TIMED, TIMED), 0.06,
                   "mean ink stays, later");
        shot_release(&later);
    }
    shot_release(&rough);
    shot_release(&even);
}

/* Middles of lines in one column, top to bottom. */
static int middles(const shot *s, int x, double *out, int capacity)
{
    int count = 0;
    for (int y = 0; y < s->height && count < capacity; y++) {
        double sum = 0, at = 0;
        int    from = y;
        while (y < s->height && halftone_ink(s, x, y) > 0.05) {
            sum += halftone_ink(s, x, y);
            at += y * halftone_ink(s, x, y);
            y++;
        }
        if (sum > 1 && from > 0 && y < s->height)
            out[count++] = at / sum;
    }
    return count;
}

static void wobble_has_its_size(void)
{
    static const double amounts[] = {2, 6};
    for (int i = 0; i < 2; i++) {
        shot   straight, wavy;
        char   surface[256];
        double most = 0, square = 0;
        int    count = 0;
        if (!take_time(&straight,
                       "screen\",\"screen\":\"lines\",\"uneven\":0,\"shadow\":0.8,\"light\":0.8,\"scale\":40", 0))
            return;
        snprintf(surface, sizeof surface,
                 "screen\",\"screen\":\"lines\",\"uneven\":0,\"shadow\":0.8,\"light\":0.8,\"scale\":40,\"wobble\":%g",
                 amounts[i]);
        if (take_time(&wavy, surface, 0)) {
            for (int x = 0; x < TIMED; x++) {
                double a[16], b[16];
                int    n = middles(&straight, x, a, 16), m = middles(&wavy, x, b, 16);
                for (int k = 0; k < n; k++) {
                    double off = 1e9;
                    for (int j = 0; j < m; j++)
                        off = fmin(off, fabs(a[k] - b[j]));
                    if (off > 19)
                        continue;
                    most = fmax(most, off);
                    square += off * off;
                    count++;
                }
            }
            double rms = sqrt(square / fmax(count, 1));
            check_at_least("IM-30", count, 100, "middles of lines compared at wobble %g", amounts[i]);
            check_at_most("IM-30", most, 1.15 * amounts[i], "px of displacement, most");
            check_at_least("IM-30", rms, 0.2 * amounts[i], "px of displacement, mean");
            shot_release(&wavy);
        }
        shot_release(&straight);
    }
}

/* --- motion --------------------------------------------------------------------------------------------- */

/* Blocks of each picture of an approach are compared with the same positions of the surface in the next one; a facing
 * wall, so that blocks stay rectangles. */
static void approaching(const char *technique, const char *keys)
{
    enum { SIDE = 112, BLOCK = 16, STEPS = 71 };
    double worst = 0, whole = 0;
    int    at = 0;
    shot   before = {0}, now;
    char   surface[256];
    snprintf(surface, sizeof surface, "%s\",%s\"uneven\":0,\"shadow\":0.5,\"light\":0.5", technique, keys);
    halftone_scene scene = {0};
    halftone_add_wall(&scene, "wall", (halftone_wall){-5, -5, 0, 10, 10, 1});
    for (int i = 0; i < STEPS; i++) { /* a little more than once as near */
        shot_view view = halftone_view(SIDE, SIDE, 100 * pow(1.01, i));
        if (!halftone_shot(&now, &scene, "approach.gltf", halftone_look(surface), NULL, &view))
            break;
        for (int y = 0; y + BLOCK <= SIDE - 2 && i; y += BLOCK)
            for (int x = 0; x + BLOCK <= SIDE - 2; x += BLOCK) {
                /* The lower left corner of the picture stays. */
                double a = halftone_box(&before, x, SIDE - y - BLOCK, BLOCK, BLOCK);
                double b = halftone_box(&now, x * 1.01, SIDE - (y + BLOCK) * 1.01, BLOCK * 1.01, BLOCK * 1.01);
                at = fabs(a - b) > worst ? i : at;
                worst = fmax(worst, fabs(a - b));
            }
        if (i)
            whole = fmax(whole, fabs(halftone_mean(&before, 0, 0, SIDE, SIDE) - halftone_mean(&now, 0, 0, SIDE, SIDE)));
        shot_release(&before);
        before = now;
    }
    shot_release(&before);
    check_at_most("coherence", worst, strcmp(technique, "screen") == 0 ? 0.12 : 0.08,
                  "%s (%s): change of a block's ink in a step of 1 %% nearer (step %d)", technique, keys, at);
    check_at_most("coherence", whole, 0.04, "change of the ink of the picture");
    halftone_release(&scene);
}

static void approach(void)
{
    approaching("screen", "\"screen\":\"cross\",");
    approaching("screen", "\"screen\":\"lines\",");
    approaching("tonal-art-map", "\"scale\":1,");
    approaching("dots", "");
}

/* Light turned by one degree, and the ball by half a degree: tone in blocks of the picture. */
static double largest_block_change(const shot *a, const shot *b)
{
    double worst = 0;
    for (int y = 0; y + 16 <= a->height; y += 16)
        for (int x = 0; x + 16 <= a->width; x += 16)
            worst = fmax(worst, fabs(halftone_mean(a, x, y, 16, 16) - halftone_mean(b, x, y, 16, 16)));
    return worst;
}

static void turning(void)
{
    static const char *const techniques[] = {"screen", "tonal-art-map", "dots"};
    shape                    ball = {0};
    shape_sphere(&ball, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
    for (int t = 0; t < 3; t++) {
        double lit = 0, turned = 0;
        for (int i = 0; i < 4; i++) {
            shot s[3] = {{0}};
            char surface[100], light[80];
            snprintf(surface, sizeof surface, "%s\",\"uneven\":0%s", techniques[t], t == 1 ? "" : "");
            bool ok = true;
            for (int k = 0; k < 3 && ok; k++) {
                double    a = (10 * i + (k == 1)) * 0.0174533, b = (k == 2 ? 0.5 : 0) * 0.0174533 + i * 0.3;
                shot_view view = {.width = 160,
                                  .height = 160,
                                  .eye = {8 * sin(b), 1, 8 * cos(b)},
                                  .up = {0, 1, 0},
                                  .fov_deg = 16,
                                  .without_maps = true};
                snprintf(light, sizeof light, "\"fill\":0,\"light_direction\":\"%g,0.5,%g\"", sin(a), cos(a));
                ok = shot_of_shape(&s[k], &ball, "turning.glb", halftone_look_with(surface, light, ""), NULL, &view);
            }
            if (ok) {
                lit = fmax(lit, largest_block_change(&s[0], &s[1]));
                turned = fmax(turned, largest_block_change(&s[0], &s[2]));
            }
            for (int k = 0; k < 3; k++)
                shot_release(&s[k]);
        }
        check_at_most("coherence", lit, 0.06, "%s: change of a block's ink when light turns by a degree",
                      techniques[t]);
        check_at_most("coherence", turned, 0.12,
                      "%s: change of a block's ink when the ball turns by half a degree (uncompensated)",
                      techniques[t]);
    }
    shape_release(&ball);
}

/* Light of a panel whose pixels rise in 12 ms and fall in 25 ms at 60 frames a second, of its light at rest, when a
 * wall moves by half a pixel a frame. `ink`: of the wall at rest. */
static double panel_light(const char *keys, double *ink)
{
    enum { SIDE = 96, FRAMES = 24 };
    halftone_scene scene = {0};
    double        *lag = check_alloc(SIDE * SIDE, sizeof *lag), rest = 0, moving = 0;
    char           surface[300];
    snprintf(surface, sizeof surface, "screen\",\"screen\":\"lines\",\"angle\":60,\"uneven\":0%s", keys);
    halftone_add_wall(&scene, "wall", (halftone_wall){-5, -5, 0, 12, 12, 1});
    for (int i = 0; i < FRAMES; i++) {
        shot      s;
        shot_view view = halftone_view(SIDE, SIDE, 60);
        view.eye.x += i * 0.5 / 60;
        view.target.x += i * 0.5 / 60;
        if (!halftone_shot(&s, &scene, "panel.gltf", halftone_look(surface), NULL, &view))
            break;
        double sum = 0, shown = 0;
        for (int k = 0; k < SIDE * SIDE; k++) {
            double goal = picture_shown(s.picture[4 * k]), constant = goal > lag[k] ? 12 : 25;
            lag[k] = i ? goal + (lag[k] - goal) * exp(-16.67 / constant) : goal;
            sum += goal;
            shown += lag[k];
        }
        if (i >= FRAMES / 2) {
            rest += sum / (SIDE * SIDE) / (FRAMES / 2);
            moving += shown / (SIDE * SIDE) / (FRAMES / 2);
        }
        *ink = halftone_mean(&s, 0, 0, SIDE, SIDE);
        shot_release(&s);
    }
    free(lag);
    halftone_release(&scene);
    return moving / rest;
}

/* Fine black and white is lighter on a slow panel while it moves; larger strokes or a paler ink of the same tone, which
 * is how drawings are softened, are hardly. */
static void slow_panel(void)
{
    double ink, fine = panel_light(",\"shadow\":0.6,\"light\":0.6", &ink);
    check_near("CS-05", ink, 0.4, 0.02, "ink of fine black strokes");
    check_at_most("CS-05", fine, 1.08, "light of a slow panel in motion against rest");
    check_near("CS-05", panel_light(",\"scale\":22,\"shadow\":0.6,\"light\":0.6", &ink), 1, 0.03,
               "  of strokes four times as far apart");
    check_near("CS-05", ink, 0.4, 0.03, "  with their ink");
    check_near(
        "CS-05",
        panel_light(",\"scale\":12,\"shadow\":0.25,\"light\":0.25,\"ink\":\"#707070\",\"paper\":\"#ffffff\"", &ink), 1,
        0.03, "  of grey ones twice as far apart");
    check_near("CS-05", ink, 0.4, 0.04, "  with their ink");
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"frames", frames_follow_each_other},
                                       {"uneven", unevenness_lives},
                                       {"wobble", wobble_has_its_size},
                                       {"approach", approach},
                                       {"turning", turning},
                                       {"panel", slow_panel}};
    halftone_begin();
    int status = check_main(argc, argv, "screen_motion", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
