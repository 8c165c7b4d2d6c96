/* Pencil shading: strokes along quantised directions, tones, leads, colours, and what depth focus leaves. Notes:
 * seed-pencil-city P16, P20 to P24, P32 to P34, P36, P37. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone/graphite.h"
#include "halftone_scenes.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

static const double PI = 3.14159265358979323846;

enum { WALL = 256 };

/* --- tones ---------------------------------------------------------------------------------------------- */

/* Mean ink on a wall of one tone, as fraction of what the lead takes. */
static double wall_ink(const char *keys, double darkness, lead_grade lead)
{
    char surface[400];
    shot s;
    snprintf(
        surface, sizeof surface,
        "pencil\",\"coordinates\":\"screen\",\"lead\":\"%s\",\"shadow\":%.9g,\"light\":%.9g,\"ink\":\"#000000\",%s",
        lead_grade_names[lead], 1 - darkness, 1 - darkness, keys);
    if (!halftone_far(&s, surface, 0, WALL, 1))
        return NAN;
    double ink = halftone_mean(&s, 0, 0, WALL, WALL);
    shot_release(&s);
    return ink / (double)lead_darkest(lead);
}

/* What strokes of one time over cover where all are there: full darkness. */
static const double whole_cover[] = {0.82, 0.9};

/* Row P20: plateaus against a steady ramp. */
static void hatching_and_gradation(void)
{
    static const char *const shadings[] = {"hatching", "gradation"};
    for (int k = 0; k < 2; k++) {
        double last = -1, step = 0, worst = 0;
        int    levels = 0, falls = 0;
        for (int i = 0; i <= 48; i++) {
            char keys[100];
            snprintf(keys, sizeof keys, "\"overlays\":1,\"shading\":\"%s\"", shadings[k]);
            double ink = wall_ink(keys, i / 48.0, LEAD_8B);
            levels += fabs(ink - last) > 0.002;
            falls += ink < last - 0.002;
            step = i ? fmax(step, ink - last) : 0;
            last = ink;
            worst = fmax(worst, fabs(ink - whole_cover[k] * i / 48.0));
        }
        check_at_most("P20", falls, 0, "%s: tones of a ramp that get lighter", shadings[k]);
        check_at_most("P21", worst, k ? 0.02 : 0.82 / 12 + 0.02,
                      "ink off the wanted darkness, at most: half of one of six steps for hatching");
        if (k == 0) {
            check_near("P20", levels, 7, 0, "amounts of ink of six tones and paper");
            check_near("P20", step, 0.82 / 6, 0.04, "between two of them");
        } else {
            check_at_least("P20", levels, 40, "amounts of ink of 49 tones");
            check_at_most("P20", step, 0.035, "largest step");
        }
    }
}

/* Strokes that do not all end at the border between two tones: the ramp is steadier, and as dark. */
static void ragged_tones(void)
{
    double last = 0, step = 0, worst = 0;
    for (int i = 0; i <= 48; i++) {
        double ink = wall_ink("\"overlays\":1,\"ragged\":1", i / 48.0, LEAD_8B);
        step = fmax(step, ink - last);
        worst = fmax(worst, fabs(ink - whole_cover[0] * i / 48.0));
        last = ink;
    }
    check_at_most("P21", wall_ink("\"overlays\":1,\"ragged\":2", 0, LEAD_8B), 0, "ragged: ink where none is wanted");
    check_at_most("P21", worst, 0.02, "ragged: ink off the wanted darkness, at most");
    check_at_most("P20", step, 0.06, "largest step of a ramp of 49 tones, which without is a sixth");
}

/* Rows P32, P33: no pixel is darker than the lead can be, soft leads get darker. */
static void leads(void)
{
    double before = 0;
    for (int k = 0; k < LEAD_COUNT; k++) {
        char surface[300];
        shot s;
        snprintf(surface, sizeof surface,
                 "pencil\",\"coordinates\":\"screen\",\"overlays\":4,\"vary\":40,\"lead\":\"%s\",\"shadow\":0,"
                 "\"light\":0,\"ink\":\"#000000",
                 lead_grade_names[k]);
        double darkest = 0;
        surface[strlen(surface)] = '\0';
        char whole[320];
        snprintf(whole, sizeof whole, "%s\",\"opacity\":1,\"paper_tint\":0", surface);
        if (halftone_far(&s, whole, 0, WALL, 1)) {
            for (int i = 0; i < WALL * WALL; i++)
                darkest = fmax(darkest, 1 - s.picture[4 * i] / 255.0);
            check_near("P33", darkest, (double)lead_darkest((lead_grade)k), 0.008,
                       "%s: darkest pixel of four times over", lead_grade_names[k]);
            check_at_least("P33", darkest - before, 0.004, "darker than the harder one by");
            before = darkest;
        }
        shot_release(&s);
    }
    /* Each time over adds less. */
    double ink[5] = {0};
    for (int n = 1; n <= 4; n++) {
        char keys[64];
        snprintf(keys, sizeof keys, "\"overlays\":%d,\"vary\":40", n);
        /* As dark each time as once alone at a half. */
        ink[n] = wall_ink(keys, (1 - pow(0.5, n)) / (1 - pow(1 - whole_cover[0], n)), LEAD_4B);
    }
    for (int n = 2; n <= 4; n++)
        check_at_most("P32", ink[n] - ink[n - 1], 0.75 * (ink[n - 1] - ink[n - 2]),
                      "ink that time %d adds, of what the one before added (ink %.3f)", n, ink[n]);
}

/* How much ink changes along rows, as a fraction of how much it does along columns: strokes from left to right hardly
 * do. */
static double steps_along(const shot *s)
{
    double along = 0, across = 1e-12;
    for (int y = 0; y + 2 < WALL; y++)
        for (int x = 0; x + 2 < WALL; x++) {
            along += pow(halftone_ink(s, x + 2, y + 1) - halftone_ink(s, x, y + 1), 2);
            across += pow(halftone_ink(s, x + 1, y + 2) - halftone_ink(s, x + 1, y), 2);
        }
    return along / across;
}

/* How much ink changes along with how it changes across, of its changes across: the slope of strokes that lean to one
 * side, 0 where as many lean to the other. */
static double lean_of(const shot *s)
{
    double both = 0, up = 0;
    for (int y = 1; y + 1 < s->height; y++)
        for (int x = 1; x + 1 < s->width; x++) {
            double across = halftone_ink(s, x + 1, y) - halftone_ink(s, x - 1, y),
                   down = halftone_ink(s, x, y + 1) - halftone_ink(s, x, y - 1);
            both += across * down;
            up += down * down;
        }
    return both / fmax(up, 1e-9);
}

/* Row P36: repetitions lie elsewhere, so that together they are as dark as wanted, and they turn to both sides. */
static void repetitions_differ(void)
{
    static const int degrees[] = {0, 20, 40};
    double           before = 0;
    for (int n = 2; n <= 4; n++) {
        char keys[64];
        snprintf(keys, sizeof keys, "\"overlays\":%d,\"vary\":0,\"shading\":\"gradation\"", n);
        check_near("P36", wall_ink(keys, 0.6, LEAD_8B), 0.6, 0.012, "ink of %d times over that lie alike, wanted 0.6",
                   n);
    }
    for (int k = 0; k < 3; k++) {
        char surface[200];
        shot s;
        snprintf(surface, sizeof surface,
                 "pencil\",\"coordinates\":\"screen\",\"angle\":0,\"overlays\":2,\"vary\":%d,\"shadow\":0.7,\"light\":"
                 "0.7,\"ink\":\"#000000\"",
                 degrees[k]);
        if (!halftone_far(&s, surface, 0, WALL, 1))
            return;
        double now = steps_along(&s), slope = tan(degrees[k] * PI / 180);
        check_at_least("P36", now - before, 0.7 * slope * slope,
                       "turned by %d degrees to both sides: by how much more ink changes from left to right",
                       degrees[k]);
        check_at_most("P36", now, slope * slope + 0.2, "and not more than strokes that lie like this");
        check_at_most("P36", fabs(lean_of(&s)), 0.12 * slope + 0.03,
                      "  and by how much they lean to one side on the mean");
        before = k ? before : now;
        shot_release(&s);
    }
}

/* Rows P33, P34: coloured leads have their strength, too. */
static void coloured_leads(void)
{
    for (int k = 0; k < LEAD_COUNT; k += 3) {
        char   surface[300];
        shot   s;
        double darkest = 0;
        snprintf(surface, sizeof surface,
                 "pencil\",\"coordinates\":\"screen\",\"overlays\":4,\"vary\":40,\"lead\":\"%s\",\"shadow\":0,"
                 "\"light\":0,\"pencils\":[\"#000000\",\"#000001\"],\"opacity\":1,"
                 "\"paper_tint\":0",
                 lead_grade_names[k]);
        if (!halftone_far(&s, surface, 0, WALL, 1))
            return;
        for (int i = 0; i < WALL * WALL; i++)
            darkest = fmax(darkest, 1 - s.picture[4 * i] / 255.0);
        check_near("P33", darkest, (double)lead_darkest((lead_grade)k), 0.008,
                   "%s, two colours: darkest pixel of four times over", lead_grade_names[k]);
        shot_release(&s);
    }
}

/* --- strokes of a picture ------------------------------------------------------------------------------- */

/* Ink runs of columns that lie as far apart as a gap is wide, by the gap; and runs, by their length. */
typedef struct runs {
    double gaps[WALL], inks[WALL], all_gaps, all_inks; /* those of up to 16 pixels */
} runs;

static runs runs_of(const shot *s)
{
    runs out = {.all_gaps = 0};
    for (int x = 0; x < WALL; x++)
        for (int y = 0, begin = 0; y < WALL - 1; y++) {
            bool here = halftone_ink(s, x, y) > 0.45, next = halftone_ink(s, x, y + 1) > 0.45;
            if (here == next)
                continue;
            int length = y + 1 - begin;
            if (begin && length <= 16)
                (here ? out.inks : out.gaps)[length] += 1;
            if (begin && length <= 16)
                *(here ? &out.all_inks : &out.all_gaps) += 1;
            begin = y + 1;
        }
    return out;
}

static double fraction_of(const double *counts, double all, int from, int to)
{
    double sum = 0;
    for (int i = from; i <= to; i++)
        sum += counts[i];
    return sum / fmax(all, 1);
}

/* Row P16: a hard double line, a quarter of the stroke each and half of it between them, on a wall of so little tone
 * that strokes lie apart: what is seen are lines of 3 pixels with 6 between, where strokes without a picture are 12
 * wide. Slanting and antialiasing take a pixel. */
static void strokes_of_a_picture(void)
{
    static uint8_t rgba[512 * 32 * 4];
    char           path[512], surface[900];
    for (int i = 0; i < 512 * 32; i++)
        rgba[4 * i + 3] = i / 512 < 8 || i / 512 >= 24 ? 255 : 0;
    snprintf(path, sizeof path, "%s", check_path("double.png"));
    if (!check_that("files", picture_write_rgba(path, rgba, 512, 32), "%s written", path))
        return;
    for (int k = 0; k < 2; k++) {
        shot s;
        snprintf(surface, sizeof surface,
                 "pencil\",\"coordinates\":\"screen\",\"overlays\":1,\"width\":12,\"opacity\":1,\"lead\":\"8B\","
                 "\"shadow\":0.85,\"light\":0.85,\"ink\":\"#000000\"%s%s%s",
                 k ? ",\"strokes\":\"" : "", k ? path : "", k ? "\"" : "");
        if (!halftone_far(&s, surface, 0, WALL, 1))
            return;
        runs   r = runs_of(&s);
        double thin = fraction_of(r.inks, r.all_inks, 2, 4), gaps = fraction_of(r.gaps, r.all_gaps, 5, 7);
        check_near("P16", halftone_mean(&s, 0, 0, WALL, WALL), 0.95 * 0.82 / 6, 0.01, "ink of the wall");
        if (k) {
            check_at_least("P16", thin, 0.85, "of %.0f runs of ink as wide as one of both lines", r.all_inks);
            check_at_least("P16", gaps, 0.75, "of %.0f gaps as wide as between them", r.all_gaps);
        } else {
            check_at_most("P16", thin, 0.2, "without a picture: of %.0f runs of ink as wide as that", r.all_inks);
        }
        shot_release(&s);
    }
}

/* --- directions ----------------------------------------------------------------------------------------- */

enum { RING = 640, WINDOW = 17, POSITIONS = 144, MAPS = 6 };

/* Seen along its axis, a ring's tube bends most along the radius: all ways there are, in order. */
static bool ring(shot *out, const char *keys)
{
    shape s = {0};
    char  look[900];
    shape_torus(&s, "ring", 1.5, 0.6, 400, 160);
    shape_place(&s, dvec_of(1, 0, 0), 90, dvec_of(0, 0, 0));
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"ring\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{"
             "\"select\":\"*\",\"surface\":{\"technique\":\"pencil\","
             "\"coordinates\":\"form\",\"shadow\":0.55,\"light\":0.55,\"ink\":\"#000000\",\"texture\":0%s%s}}]}",
             *keys ? "," : "", keys);
    const shot_view view = {
        .width = RING, .height = RING, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 0};
    bool drawn = shot_of_shape(out, &s, "ring.glb", look, NULL, &view);
    shape_release(&s);
    return drawn;
}

typedef struct stroke_direction {
    double xx, xy, yy, ink, count; /* sums */
    double angle, coherence;       /* radians from the right to the top; how alike directions are, 0 … 1 */
} stroke_direction;

/* Ink, blurred by four binomial steps: differences of neighbours read slants of thin strokes wrongly. */
static double *blurred(const shot *s)
{
    size_t  count = (size_t)s->width * (size_t)s->height;
    double *now = check_alloc(count, sizeof *now), *next = check_alloc(count, sizeof *next);
    for (size_t i = 0; i < count; i++)
        now[i] = halftone_ink(s, (int)(i % (size_t)s->width), (int)(i / (size_t)s->width));
    for (int round = 0; round < 8; round++) {
        size_t apart = round & 1 ? (size_t)s->width : 1;
        for (size_t i = apart; i + apart < count; i++)
            next[i] = 0.25 * now[i - apart] + 0.5 * now[i] + 0.25 * now[i + apart];
        double *kept = now;
        now = next;
        next = kept;
    }
    free(next);
    return now;
}

/* Adds a round window's structure tensor. */
static void add_direction(stroke_direction *out, const shot *s, const double *ink, double cx, double cy)
{
    for (int y = -WINDOW; y <= WINDOW; y++)
        for (int x = -WINDOW; x <= WINDOW; x++) {
            if (x * x + y * y > WINDOW * WINDOW)
                continue;
            size_t at = (size_t)((int)(cy + 0.5) + y) * (size_t)s->width + (size_t)((int)(cx + 0.5) + x),
                   row = (size_t)s->width;
            double gx = ink[at + 1] - ink[at - 1], gy = ink[at - row] - ink[at + row];
            out->xx += gx * gx;
            out->xy += gx * gy;
            out->yy += gy * gy;
            out->ink += ink[at];
            out->count += 1;
        }
}

static double turned_by(double a, double b)
{
    double off = fmod(a - b, PI);
    off = off > PI / 2 ? off - PI : off < -PI / 2 ? off + PI : off;
    return off * 180 / PI;
}

/* Around the ring's crest, which lies in the page's plane; several maps of strokes together, so that what single
 * strokes do is averaged. */
static bool measure_ring(const char *keys, stroke_direction out[POSITIONS], double radial[POSITIONS])
{
    memset(out, 0, POSITIONS * sizeof *out);
    for (int m = 0; m < MAPS; m++) {
        shot s;
        char with_map[300];
        snprintf(with_map, sizeof with_map, "%s,\"map_seed\":%d", keys, m);
        if (!ring(&s, with_map))
            return false;
        dvec    centre = shot_project(&s, dvec_of(0, 0, 0));
        double *ink = blurred(&s);
        for (int i = 0; i < POSITIONS; i++) {
            double angle = 2 * PI * (i + 0.5) / POSITIONS;
            dvec   at = shot_project(&s, dvec_of(1.5 * cos(angle), 1.5 * sin(angle), 0.6));
            radial[i] = atan2(centre.y - at.y, at.x - centre.x);
            add_direction(&out[i], &s, ink, at.x - 0.5, at.y - 0.5);
        }
        free(ink);
        shot_release(&s);
    }
    for (int i = 0; i < POSITIONS; i++) {
        stroke_direction *w = &out[i];
        w->angle = 0.5 * atan2(2 * w->xy, w->xx - w->yy) + PI / 2;
        w->coherence = hypot(w->xx - w->yy, 2 * w->xy) / fmax(w->xx + w->yy, 1e-12);
        w->ink /= w->count;
    }
    return true;
}

/* Rows P23, P24. */
static void directions_of_strokes(void)
{
    static const int    directions[] = {6, 12, 24};
    static const double angles[] = {0, 30, 90, -45};
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < (directions[k] == 12 ? 4 : 1); a++) {
            char             keys[160];
            stroke_direction direction[POSITIONS];
            double           radial[POSITIONS], worst = 0, mean = 0, least = 1, most = 0;
            snprintf(keys, sizeof keys, "\"overlays\":1,\"vary\":0,\"directions_on_page\":%d,\"angle\":%g",
                     directions[k], angles[a]);
            if (!measure_ring(keys, direction, radial))
                return;
            for (int i = 0; i < POSITIONS; i++) {
                double off = turned_by(direction[i].angle, radial[i] + angles[a] * PI / 180);
                worst = fmax(worst, fabs(off));
                mean += off / POSITIONS;
                least = fmin(least, direction[i].ink);
                most = fmax(most, direction[i].ink);
            }
            check_at_most(
                "P23", worst, 90.0 / directions[k] + 1.5,
                "%d ways, angle %g: degrees that strokes lie off, at most (half a step and how well it is measured)",
                directions[k], angles[a]);
            check_near("P24", mean, 0, 1, "degrees off on the mean, the angle taken into account");
            check_at_most("P23", (most - least) / (most + least), 0.2,
                          "ink in windows of %d px: half the range over the mean (%.3f to %.3f)", 2 * WINDOW, least,
                          most);
        }
}

/* Row P24: strokes on the page move with the middle of the model. */
static void strokes_move_along(void)
{
    enum { MOVED = 37 };
    shape s = {0};
    shot  here, there;
    int   off = 0, all = 0;
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
    const char *look = "{\"version\":1,\"name\":\"m\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{"
                       "\"technique\":\"pencil\",\"coordinates\":\"form\",\"shadow\":0.55,\"light\":0.55,"
                       "\"ink\":\"#000000\",\"texture\":0}}]}";
    shot_view   view = {
          .width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 30};
    if (shot_of_shape(&here, &s, "moved.glb", look, NULL, &view)) {
        double pixel = 1 / (shot_project(&here, dvec_of(1, 0, 0)).x - shot_project(&here, dvec_of(0, 0, 0)).x);
        view.eye.x = view.target.x = -MOVED * pixel;
        if (shot_of_shape(&there, &s, "moved.glb", look, NULL, &view)) {
            for (int y = 0; y < 400; y++)
                for (int x = 0; x + MOVED < 400; x++)
                    if (here.id[400 * y + x] && there.id[400 * y + x + MOVED]) {
                        off += abs(here.picture[4 * (400 * y + x)] - there.picture[4 * (400 * y + x + MOVED)]) > 60;
                        all++;
                    }
            check_at_least("P24", all, 10000, "pixels of a ball that moves by %d", MOVED);
            check_at_most("P24", off, 0.1 * all, "of them with other strokes");
            shot_release(&there);
        }
        shot_release(&here);
    }
    shape_release(&s);
}

/* The part of a sequence around the ring that repeats so many times. */
static double repeating(const stroke_direction direction[POSITIONS], int times)
{
    double a = 0, b = 0;
    for (int i = 0; i < POSITIONS; i++) {
        a += direction[i].coherence * cos(2 * PI * times * (i + 0.5) / POSITIONS) * 2 / POSITIONS;
        b += direction[i].coherence * sin(2 * PI * times * (i + 0.5) / POSITIONS) * 2 / POSITIONS;
    }
    return hypot(a, b);
}

/* Row P36: where two directions meet, strokes cross; that shows in how alike directions are, twice for each way. Gone
 * over three times, it is no more than what any place has. */
static void seams_vanish(void)
{
    double seams[2];
    for (int k = 0; k < 2; k++) {
        stroke_direction direction[POSITIONS];
        double           radial[POSITIONS], noise = 0;
        if (!measure_ring(k ? "\"overlays\":3,\"vary\":0,\"directions_on_page\":9"
                            : "\"overlays\":1,\"vary\":0,\"directions_on_page\":9",
                          direction, radial))
            return;
        for (int times = 11; times <= 31; times++)
            noise += times == 18 ? 0 : repeating(direction, times) / 20;
        seams[k] = repeating(direction, 18);
        if (k == 0)
            check_at_least("P36", seams[k] / noise, 3,
                           "once over: what repeats with the ways, over the noise beside it");
        else
            check_at_most("P36", seams[k] / noise, 2, "three times over");
    }
    check_at_most("P36", seams[1] / seams[0], 0.4, "of the seams, what is left");
}

/* --- colours, gloss, light ------------------------------------------------------------------------------ */

static void coloured_pencils(void)
{
    shape s = {0};
    shot  got;
    shape_quad(&s, "red", 0.9, 0);
    s.parts[0].colour[0] = 0.8f, s.parts[0].colour[1] = 0.1f, s.parts[0].colour[2] = 0.1f, s.parts[0].colour[3] = 1;
    shape_place(&s, dvec_of(0, 1, 0), 0, dvec_of(-1, 0, 0));
    shape_quad(&s, "blue", 0.9, 0);
    s.parts[1].colour[0] = 0.1f, s.parts[1].colour[1] = 0.1f, s.parts[1].colour[2] = 0.8f, s.parts[1].colour[3] = 1;
    shape_place(&s, dvec_of(0, 1, 0), 0, dvec_of(1, 0, 0));
    const shot_view view = {.width = 400, .height = 200, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    const char *look = "{\"version\":1,\"name\":\"c\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{"
                       "\"select\":\"*\",\"surface\":{\"technique\":\"pencil\",\"shadow\":0.4,"
                       "\"light\":0.4,\"ink_tint\":1,\"texture\":0}}]}";
    if (shot_of_shape(&got, &s, "pencils.glb", look, NULL, &view)) {
        double sums[2][3] = {{0}};
        int    counts[2] = {0};
        for (int i = 0; i < got.width * got.height; i++)
            if (got.id[i])
                for (int c = 0; c < 3; c++, counts[got.id[i] - 1]++)
                    sums[got.id[i] - 1][c] += 1 - got.picture[4 * i + c] / 255.0;
        check_at_least("P34", sums[0][2] / fmax(sums[0][0], 1e-9), 1.6,
                       "the red part's pencil takes more blue than red away");
        check_at_least("P34", sums[1][0] / fmax(sums[1][2], 1e-9), 1.6, "the blue part's more red than blue");
    }
    shot_release(&got);
    look = "{\"version\":1,\"name\":\"c\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*"
           "\",\"surface\":{\"technique\":\"pencil\",\"shadow\":0.3,\"light\":0.3,"
           "\"pencils\":[\"#ffe000\",\"#30a0ff\"],\"overlays\":2,\"vary\":40,\"opacity\":1,\"lead\":\"8B\",\"texture\":"
           "0}}]}";
    int yellow = 0, blue = 0, green = 0;
    if (shot_of_shape(&got, &s, "pencils.glb", look, NULL, &view))
        for (int i = 0; i < got.width * got.height; i++) {
            const uint8_t *p = &got.picture[4 * i];
            yellow += p[0] > 220 && p[1] > 200 && p[2] < 110;
            blue += p[0] < 120 && p[1] > 140 && p[2] > 220;
            green += p[0] < 120 && p[1] > 120 && p[2] < 110;
        }
    check_at_least("P34", yellow, 500, "pixels of the yellow pencil alone");
    check_at_least("P34", blue, 500, "of the blue one");
    check_at_least("P34", green, 200, "of both: green");
    shot_release(&got);
    shape_release(&s);
}

/* A wall in black on white, the same on no ground, and in white on black. */
static void grounds(void)
{
    static const char *const looks[][3] = {
        {"#ffffff", "#000000", "0.4"}, {"none", "#000000", "0.4"}, {"#000000", "#ffffff", "0.6"}};
    shape s = {0};
    shape_quad(&s, "wall", 2, 0);
    shape_place(&s, dvec_of(0, 1, 0), 0, dvec_of(0, 0, 0));
    const shot_view view = {.width = WALL, .height = WALL, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    double          ink[3] = {0};
    for (int k = 0; k < 3; k++) {
        shot got;
        char look[500];
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"g\",\"doc\":\"x.\",\"finish\":{\"ground\":\"%s\"},\"rules\":[{\"select\":"
                 "\"*\",\"surface\":{\"technique\":\"pencil\","
                 "\"lead\":\"8B\",\"texture\":0,\"ink\":\"%s\",\"shadow\":%s,\"light\":%s}}]}",
                 looks[k][0], looks[k][1], looks[k][2], looks[k][2]);
        if (!shot_of_shape(&got, &s, "ground.glb", look, NULL, &view))
            continue;
        int count = 0;
        for (int i = 0; i < WALL * WALL; i++)
            if (got.id[i]) {
                ink[k] += k == 0   ? 1 - picture_shown(got.picture[4 * i])
                          : k == 1 ? got.picture[4 * i + 3] / 255.0
                                   : picture_shown(got.picture[4 * i]);
                count++;
            }
        ink[k] /= fmax(count, 1);
        shot_release(&got);
    }
    check_at_least("P21", ink[0], 0.4, "ink on white");
    check_near("P21", ink[1], ink[0], 0.01, "on a transparent ground: as much ink as on white");
    check_near("P21", ink[2], ink[0], 0.03,
               "white on black: as much light as there is ink on white where the tone is its opposite");
    shape_release(&s);
}

/* Blocks of a lit ball against Lambert's law, worked out here; row P21. And the highlight, row P37. */
static void light_on_a_ball(void)
{
    enum { SIZE = 480, BLOCK = 24 };
    shape s = {0};
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 96, 192, true);
    const shot_view view = {.width = SIZE, .height = SIZE, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    double          bare[2] = {0}, sums[2] = {0};
    for (int k = 0; k < 2; k++) {
        shot got;
        char look[900];
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"b\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{\"light_"
                 "direction\":[-0.4,0.5,0.8],\"fill\":0},\"rules\":[{"
                 "\"select\":\"*\",\"surface\":{\"technique\":\"pencil\",\"shading\":\"gradation\",\"shadow\":0.2,"
                 "\"light\":0.9,\"texture\":0,\"ink\":\"#000000\",\"lead\":\"6B\",\"gloss\":%g}}]}",
                 k ? 0.6 : 0.0);
        if (!shot_of_shape(&got, &s, "ball.glb", look, NULL, &view))
            continue;
        double worst = 0, before = NAN;
        dvec   light = dvec_unit(dvec_of(-0.4, 0.5, 0.8));
        int    blocks = 0;
        (void)before;
        for (int y = 0; y + BLOCK <= SIZE; y += BLOCK)
            for (int x = 0; x + BLOCK <= SIZE; x += BLOCK) {
                double wanted = 0, ink = 0;
                int    count = 0;
                for (int i = 0; i < BLOCK * BLOCK; i++) {
                    size_t at = (size_t)(y + i / BLOCK) * SIZE + (size_t)(x + i % BLOCK);
                    if (!got.id[at])
                        continue;
                    wanted += 1 - (0.2 + 0.7 * fmax(dvec_dot(dvec_from(got.normal[at]), light), 0));
                    ink += halftone_ink(&got, x + i % BLOCK, y + i / BLOCK) / (double)lead_darkest(LEAD_6B);
                    count++;
                }
                sums[k] += ink;
                if (count < BLOCK * BLOCK)
                    continue;
                worst = fmax(worst, fabs(ink - wanted) / count);
                blocks++;
            }
        if (k == 0) {
            check_at_least("P21", blocks, 45, "blocks of %d px on a lit ball", BLOCK);
            check_at_most("P21", worst, 1.0 / 6, "ink off Lambert's tone, at most: one step of six");
        }
        for (int i = 0; i < SIZE * SIZE; i++)
            bare[k] += got.id[i] != 0 && got.picture[4 * i + 1] > 250;
        shot_release(&got);
    }
    check_at_least("P37", sums[0] / fmax(sums[1], 1e-9), 1.01, "ink without the highlight over that with it");
    check_at_most("P37", sums[0] / fmax(sums[1], 1e-9), 1.2, "which is small beside diffuse light");
    check_at_least("P37", (bare[1] - bare[0]) / (PI * 200 * 200), 0.002, "fraction of the ball that stays bare for it");
    shape_release(&s);
}

/* --- depth focus ---------------------------------------------------------------------------------------- */

enum { ROW = 8 };

/* Row P22: boxes one behind the other, all as large on the page. */
static void depth_focus(void)
{
    static const double at[] = {0, 0.5};
    shape               s = {0};
    for (int i = 0; i < ROW; i++) {
        char name[16];
        snprintf(name, sizeof name, "box%d", i);
        double x = 2.2 * i, z = -3.0 * i;
        shape_box(&s, name, dvec_of(x, 0, z - 0.8), dvec_of(x + 1.6, 1.6, z));
    }
    const shot_view view = {.width = 1100,
                            .height = 200,
                            .eye = {8.5, 0.8, 40},
                            .target = {8.5, 0.8, 0},
                            .up = {0, 1, 0},
                            .orthographic = true};
    double          sharp = 0;
    for (int k = 0; k < 3; k++) {
        shot got;
        char look[1000];
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"f\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#f0e8d8\"},\"scene\":{"
                 "\"focus\":%g,\"focus_at\":%g,\"focus_depth\":0.9},\"rules\":[{\"select\":\"*\","
                 "\"surface\":{\"technique\":\"pencil\",\"shadow\":0.5,\"light\":0.5,\"texture\":0},\"lines\":{"
                 "\"operator\":\"discontinuity\",\"colour\":\"#000000\"},"
                 "\"perturb\":{\"technique\":\"pencil\",\"light\":0}}]}",
                 k ? 1.0 : 0.0, k ? at[k - 1] : 0.0);
        if (!shot_of_shape(&got, &s, "row.glb", look, NULL, &view))
            continue;
        double ink[ROW] = {0};
        int    dark[ROW] = {0}, count[ROW] = {0}, painted = 0;
        for (int i = 0; i < got.width * got.height; i++) {
            if (!got.id[i])
                continue;
            int box = got.id[i] - 1;
            ink[box] += 1 - got.picture[4 * i + 1] / 232.0;
            dark[box] += got.picture[4 * i + 1] < 110;
            count[box]++;
            /* The paper between strokes is the page's, not a paler one. */
            painted += got.picture[4 * i + 1] > 233 || got.picture[4 * i] > 241;
        }
        double beside =
            0; /* lines of the first box beyond its outline are as near as it is, though there is nothing under them */
        int border = (int)shot_project(&got, dvec_of(1.9, 0.8, 0)).x;
        for (int y = 0; y < got.height; y++)
            for (int x = 0; x < border; x++)
                beside += got.id[y * got.width + x] ? 0 : fmax(1 - got.picture[4 * (y * got.width + x) + 1] / 232.0, 0);
        sharp = k ? sharp : beside;
        if (k == 0)
            check_at_least("P22", beside, 20, "ink beyond the first box's outline");
        if (k == 1)
            check_near("P22", beside, sharp, 0.03 * sharp, "the same where that box is in focus");
        check_at_most("P22", painted, 0, "focus at %g: pixels paler than the paper", k ? at[k - 1] : 0.0);
        int    rises = 0;
        double first = ink[0] / count[0], last = ink[ROW - 1] / count[ROW - 1], middle = ink[ROW / 2] / count[ROW / 2];
        for (int i = 1; i < ROW; i++)
            rises += ink[i] / count[i] > ink[i - 1] / count[i - 1] + 0.004;
        if (k == 0) {
            check_near("P22", last / first, 1, 0.08, "without focus: ink of the last box over that of the first");
        } else if (k == 1) {
            check_at_most("P22", rises, 0, "boxes that have more ink than the one before");
            check_at_most("P22", last / first, 0.05, "ink of the last box over that of the first");
            check_at_most("P22", (double)dark[ROW - 1], 0.05 * dark[0],
                          "dark pixels of the last box, of the first one's");
        } else {
            check_at_least("P22", middle / fmax(first, 1e-9), 1.5, "focus in the middle: its ink over the first box's");
            check_at_least("P22", middle / fmax(last, 1e-9), 1.5, "and over the last one's");
        }
        shot_release(&got);
    }
    shape_release(&s);
}

/* Row P22: how much is left grows as the curve says, from box to box. */
static void focus_curve(void)
{
    shape s = {0};
    for (int i = 0; i < ROW; i++)
        shape_box(&s, "box", dvec_of(2.2 * i, 0, -3.0 * i - 0.8), dvec_of(2.2 * i + 1.6, 1.6, -3.0 * i));
    const shot_view view = {.width = 1100,
                            .height = 200,
                            .eye = {8.5, 0.8, 40},
                            .target = {8.5, 0.8, 0},
                            .up = {0, 1, 0},
                            .orthographic = true};
    shot            got;
    if (shot_of_shape(&got, &s, "row.glb",
                      "{\"version\":1,\"name\":\"f\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{\"focus\":1,"
                      "\"focus_at\":0,\"focus_depth\":1},\"rules\":[{\"surface\":{\"technique\":\"pencil\","
                      "\"shading\":\"gradation\",\"lead\":\"8B\",\"ink\":\"#000000\",\"coordinates\":\"screen\","
                      "\"shadow\":0.4,\"light\":0.4,\"texture\":0}}]}",
                      NULL, &view)) {
        double ink[ROW] = {0}, count[ROW] = {0};
        for (int i = 0; i < got.width * got.height; i++)
            if (got.id[i]) {
                ink[got.id[i] - 1] += halftone_ink(&got, i % got.width, i / got.width);
                count[got.id[i] - 1]++;
            }
        for (int i = 1; i < ROW; i++) {
            double off = 3.0 * i / (3.0 * (ROW - 1) + 0.8);
            check_near("P22", ink[i] / count[i] / (ink[0] / count[0]), 1 - off * off * (3 - 2 * off), 0.07,
                       "fraction of its ink that box %d keeps", i);
        }
        shot_release(&got);
    }
    shape_release(&s);
}

static const check_case cases[] = {
    {"hatching_and_gradation", hatching_and_gradation},
    {"ragged_tones", ragged_tones},
    {"leads", leads},
    {"repetitions_differ", repetitions_differ},
    {"coloured_leads", coloured_leads},
    {"strokes_of_a_picture", strokes_of_a_picture},
    {"directions_of_strokes", directions_of_strokes},
    {"strokes_move_along", strokes_move_along},
    {"seams_vanish", seams_vanish},
    {"coloured_pencils", coloured_pencils},
    {"grounds", grounds},
    {"light_on_a_ball", light_on_a_ball},
    {"depth_focus", depth_focus},
    {"focus_curve", focus_curve},
};

int main(int argc, char **argv)
{
    halftone_begin_kept("pencil");
    int status = check_main(argc, argv, "pencil", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
