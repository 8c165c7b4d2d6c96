/* hatch on walls whose picture is known: lines against their formulas, their distance and width at any zoom, tone,
 * nesting, unevenness. Seed 001, section 6.7. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "hatch_truth.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

/* Lines without ends that are as even as can be. */
#define ENDLESS "\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"series\":1"
#define NESTED  "\"wobble\":0,\"uneven\":0,\"loose\":0"

static bool wall_shot(shot *out, double half, double degrees, const char *look, const shot_view *view)
{
    shape s = {0};
    hatch_wall(&s, half, degrees);
    bool ok = shot_of_shape(out, &s, "wall.glb", look, NULL, view);
    shape_release(&s);
    return ok;
}

/* The same tone everywhere. */
static const char *even(double darkness, const char *settings)
{
    return hatch_look("0,0,1", "", "\"shadow\":%.9g,\"light\":%.9g,%s", 1 - darkness, 1 - darkness, settings);
}

/* --- 1: formulas ---------------------------------------------------------------------------------------- */

static int levels_apart(const shot *s, int x, int y, double cover)
{
    double drawn = s->picture[4 * ((size_t)y * (size_t)s->width + (size_t)x)];
    return (int)ceil(fabs(drawn - picture_level(1 - cover)) - 0.5);
}

static void formulas(void)
{
    static const struct {
        bool   by_width;
        double scale, width, angle, darkness;
    } rows[] = {
        {true, 6, 0, 0, 0.3},       {true, 6, 0, 23, 0.05},    {true, 13.7, 0, 90, 0.5}, {true, 4, 0, -45, 0.8},
        {true, 9.1, 0, 171, 0.97},  {true, 30, 0, 12, 0.25},   {false, 6, 1.2, 0, 0.1},  {false, 6, 1.2, 33, 0.2},
        {false, 10, 2.5, -70, 0.5}, {false, 8, 0.7, 45, 0.03}, {false, 6, 1.2, 5, 0.9},  {false, 20, 5, 60, 0.37},
    };
    shot_view view = hatch_front(160, 1);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        hatch_rule rule = {rows[k].by_width, rows[k].scale, rows[k].width};
        char       settings[256];
        int        worst = 0, apart = 0;
        shot       s;
        snprintf(settings, sizeof settings,
                 ENDLESS ",\"coordinates\":\"screen\",\"tone_by\":\"%s\",\"scale\":%g,\"angle\":%g%s%.3g",
                 rows[k].by_width ? "width" : "number", rows[k].scale, rows[k].angle,
                 rows[k].by_width ? ",\"gap\":" : ",\"width\":", rows[k].by_width ? 5 : rows[k].width);
        double turn = rows[k].angle * pi / 180;
        if (wall_shot(&s, 2, 0, even(rows[k].darkness, settings), &view)) {
            for (int y = 0; y < s.height; y++)
                for (int x = 0; x < s.width; x++) {
                    /* Turned about the picture's lower left corner; by floats, lines of an octave may be worked out
                     * for the next one where the two are the same. */
                    double px = x + 0.5, py = s.height - y - 0.5, across = cos(turn) * py - sin(turn) * px;
                    int    off = levels_apart(&s, x, y, hatch_cover(&rule, across, 1, rows[k].darkness));
                    worst = off > worst ? off : worst;
                    apart += off > 2;
                }
            check_at_most("IM-21", worst, 2,
                          "by %s, scale %g, width %g, angle %g, darkness %g: levels between picture and formula (%d "
                          "pixels beyond)",
                          rows[k].by_width ? "width" : "number", rows[k].scale, rows[k].width, rows[k].angle,
                          rows[k].darkness, apart);
        }
        shot_release(&s);
    }
}

/* The slant of lines in degrees, 0 … 180, from how ink changes. */
static double slant_of(const shot *s)
{
    double xx = 0, yy = 0, xy = 0;
    for (int y = 3; y + 3 < s->height; y++)
        for (int x = 3; x + 3 < s->width; x++) {
            double dx = 0, dy = 0;
            for (int v = -3; v <= 3; v++)
                for (int u = -3; u <= 3; u++) {
                    double weight = exp(-(u * u + v * v) / 4.5) * hatch_ink(s, x + u, y + v);
                    dx += u * weight;
                    dy -= v * weight;
                }
            xx += dx * dx;
            yy += dy * dy;
            xy += dx * dy;
        }
    double across = 0.5 * atan2(2 * xy, xx - yy) * 180 / pi;
    return fmod(across + 270, 180);
}

/* Strokes are turned on the surface, against the clock where it is seen from before. Planes through the model turn
 * otherwise, which is only noted. */
static void angles(void)
{
    static const char *const coordinates[] = {"screen", "triplanar", "uv", "axes"};
    shot_view                view = hatch_front(192, 1);
    for (int c = 0; c < 4; c++) {
        double worst = 0, first = 0;
        for (int k = 0; k < 6; k++) {
            char   settings[200];
            double angle = 27 * k;
            shot   s;
            snprintf(settings, sizeof settings,
                     ENDLESS ",\"tone_by\":\"width\",\"scale\":10,\"coordinates\":\"%s\",\"angle\":%g", coordinates[c],
                     angle);
            if (wall_shot(&s, 1.5, 0, even(0.3, settings), &view)) {
                double slant = slant_of(&s);
                first = k ? first : slant;
                double off = fmod(slant - first - angle + 720 + 90, 180) - 90;
                worst = fmax(worst, fabs(off));
            }
            shot_release(&s);
        }
        if (c < 3)
            check_at_most("angle", worst, 3,
                          "%s: degrees that lines are off when they are turned (3: how well slants are read)",
                          coordinates[c]);
        else
            check_note("%s: degrees that lines are off when they are turned: %.1f", coordinates[c], worst);
    }
}

/* A wall seen at a slant in perspective: octaves change over it. The position and its rate come from rays, not from
 * the picture. */
static void formulas_in_perspective(void)
{
    static const struct {
        bool   by_width;
        double darkness;
    } rows[] = {{true, 0.3}, {true, 0.7}, {false, 0.15}, {false, 0.5}};
    shot_view view = {
        .width = 256, .height = 256, .eye = {3.1, 0.4, 4.2}, .target = {0.2, 0.1, 0}, .up = {0, 1, 0}, .fov_deg = 70};
    for (int k = 0; k < 4; k++) {
        hatch_rule rule = {rows[k].by_width, 7, 1.5};
        char       settings[256];
        int        apart = 0, inside = 0;
        shot       s;
        snprintf(settings, sizeof settings,
                 ENDLESS ",\"coordinates\":\"triplanar\",\"tone_by\":\"%s\",\"scale\":7,\"angle\":90%s",
                 rows[k].by_width ? "width" : "number", rows[k].by_width ? "" : ",\"width\":1.5");
        if (wall_shot(&s, 4, 0, even(rows[k].darkness, settings), &view)) {
            for (int y = 0; y < s.height; y++)
                for (int x = 0; x < s.width; x++) {
                    double positions[5];
                    bool   on = !isinf(s.depth[y * s.width + x]);
                    for (int i = 0; i < 5 && on; i++) {
                        static const double step[5][2] = {{0, 0}, {0.01, 0}, {-0.01, 0}, {0, 0.01}, {0, -0.01}};
                        dvec                origin, direction;
                        shot_ray(&s, x + 0.5 + step[i][0], y + 0.5 + step[i][1], &origin, &direction);
                        dvec at = dvec_add(origin, dvec_scale(direction, -origin.z / direction.z));
                        on = fabs(dvec_unit(direction).z) > 0.13 && fabs(at.x) < 3.9 && fabs(at.y) < 3.9;
                        positions[i] = at.x;
                    }
                    if (!on)
                        continue;
                    double rate = hypot(positions[1] - positions[2], positions[3] - positions[4]) / 0.02;
                    inside++;
                    apart += levels_apart(&s, x, y, hatch_cover(&rule, -positions[0], rate, rows[k].darkness)) > 4;
                }
            check_at_least("IM-21", inside, 20000, "in perspective, by %s, darkness %g: pixels compared",
                           rows[k].by_width ? "width" : "number", rows[k].darkness);
            check_at_most("IM-24", (double)apart / inside, 0.005,
                          "  fraction of them more than 4 levels from the formula");
        }
        shot_release(&s);
    }
}

static void ball_with_uvs(shape *s)
{
    enum { RINGS = 64, ROUND = 128 };
    shape_part *p = shape_add(s, "ball", (RINGS + 1) * (ROUND + 1), 6 * RINGS * ROUND, true, true);
    uint32_t    at = 0;
    for (uint32_t i = 0; i <= RINGS; i++)
        for (uint32_t k = 0; k <= ROUND; k++) {
            double   latitude = pi * (0.5 - (double)i / RINGS), longitude = 2 * pi * k / ROUND;
            double   n[3] = {cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude)};
            uint32_t v = i * (ROUND + 1) + k;
            for (int c = 0; c < 3; c++)
                p->positions[v][c] = p->normals[v][c] = (float)n[c];
            p->uvs[v][0] = (float)k / ROUND;
            p->uvs[v][1] = (float)i / RINGS;
            if (i == RINGS || k == ROUND)
                continue;
            const uint32_t around[6] = {v, v + ROUND + 1, v + ROUND + 2, v, v + ROUND + 2, v + 1};
            memcpy(&p->indices[at], around, sizeof around);
            at += 6;
        }
}

/* A pixel's box gives 0.8 px; lines that are thinner than the range count with what they have. */
enum { LATITUDES = 10 };
static const int latitudes[LATITUDES] = {0, 15, 30, 45, 60, 65, 70, 75, 80, 83};

/* The edges around where each latitude faces a viewer who looks down on the ball. */
static void add_latitudes(const shot *ball, double turn, hatch_edges sums[LATITUDES])
{
    for (int i = 0; i < LATITUDES; i++) {
        double latitude = latitudes[i] * pi / 180;
        dvec   at = shot_project(ball, dvec_of(sin(turn) * cos(latitude), sin(latitude), cos(turn) * cos(latitude)));
        int    half = (int)fmax(160 * cos(latitude) * 0.8, 3);
        hatch_add_edges(ball, (int)at.x - half, (int)at.y - 4, (int)at.x + half, (int)at.y + 4, &sums[i]);
    }
}

/* From the equator towards the pole. Edges as wide as a pixel measure 0.8 there; turned a little from picture to
 * picture, they are everywhere on the grid of pixels, and the measure is within 0.1. Within 28 pixels of the pole lines
 * of a width that goes with the tone are thinner than a pixel where they come and go, and have no edges of their own;
 * within 20, all lines meet. */
static void edges(void)
{
    enum { TURNS = 8 };
    shape s = {0};
    ball_with_uvs(&s);
    s.parts->texture = NULL;
    for (int mode = 0; mode < 2; mode++) {
        hatch_edges sums[LATITUDES] = {{0, 0}};
        char        settings[200];
        snprintf(settings, sizeof settings,
                 ENDLESS ",\"coordinates\":\"uv\",\"angle\":90,\"scale\":16,\"shadow\":%g,\"light\":%g,%s",
                 mode ? 0.8 : 0.5, mode ? 0.8 : 0.5,
                 mode ? "\"tone_by\":\"number\",\"width\":3" : "\"tone_by\":\"width\"");
        for (int k = 0; k < TURNS; k++) {
            shot      ball;
            double    turn = 0.0371 * k, up = 40 * pi / 180;
            shot_view view = hatch_front(320, 1);
            view.eye = dvec_of(2 * sin(turn) * cos(up), 2 * sin(up), 2 * cos(turn) * cos(up));
            if (shot_of_shape(&ball, &s, "ball.glb", hatch_look("0,0,1", "", "%s", settings), NULL, &view))
                add_latitudes(&ball, turn, sums);
            shot_release(&ball);
        }
        for (int i = 0; i < LATITUDES; i++) {
            double width = sums[i].variation > 0 ? sums[i].area / sums[i].variation : 0;
            bool   meets = latitudes[i] > (mode ? 80 : 75);
            check_at_least("IM-22", width, meets ? 0.5 : 0.7, "by %s, latitude %d: width of edges from 10 to 90 %%, px",
                           mode ? "number" : "width", latitudes[i]);
            check_at_most("IM-22", width, 2, "  and");
        }
    }
    shape_release(&s);
}

/* --- 2: zoom -------------------------------------------------------------------------------------------- */

/* New lines count as full ones a little before they are: up to 8 % closer than scale / √2. */
static void zoom(void)
{
    static const char *const coordinates[] = {"axes", "triplanar", "uv"};
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = 0, worst = 0, all_low = INFINITY, all_high = 0;
        for (int k = -12; k <= 12; k++) {
            double    power = pow(10, k / 4.0), size = k > 0 ? 1100 : 1.1;
            shot_view view = hatch_front(192, c == 2 ? fmin(power, k > 0 ? 1000 : 1) : power);
            char      settings[160];
            shot      s;
            snprintf(settings, sizeof settings, ENDLESS ",\"coordinates\":\"%s\",\"tone_by\":\"width\",\"scale\":12",
                     coordinates[c]);
            if (wall_shot(&s, size, 0, even(0.3, settings), &view)) {
                hatch_count n = hatch_count_lines(&s);
                low = fmin(low, n.period / 12);
                high = fmax(high, n.period / 12);
                all_low = fmin(all_low, n.all_period / 12);
                all_high = fmax(all_high, n.all_period / 12);
                worst = fmax(worst, fabs(n.mean / 0.3 - 1));
            }
            shot_release(&s);
        }
        check_at_least("IM-23", low, 0.92 / sqrt(2),
                       "%s, by width, zoom 1e-3 to 1e3: least distance of full lines over the scale", coordinates[c]);
        check_at_most("IM-23", high, 1.03 * sqrt(2), "  the greatest (of all lines %.3f to %.3f)", all_low, all_high);
        check_at_most("IM-23", worst, 0.1, "  largest share that a picture's ink is off");
    }
}

static void distance_in_perspective(void)
{
    static const char *const coordinates[] = {"axes", "triplanar", "uv"};
    for (int mode = 0; mode < 3; mode++)
        for (int c = 0; c < 3; c++) {
            double least = INFINITY, most = 0, thin = INFINITY, thick = 0;
            for (int k = 0; k <= 12; k++) {
                double    distance = pow(2, k / 2.0);
                shot_view view = {.width = mode == 2 ? 320 : 192,
                                  .height = mode == 2 ? 320 : 192,
                                  .eye = {0.13, 0.07, distance},
                                  .target = {0.13, 0.07, 0},
                                  .up = {0, 1, 0},
                                  .fov_deg = 50,
                                  .without_maps = true};
                char      settings[200];
                shot      s;
                snprintf(settings, sizeof settings, "\"coordinates\":\"%s\",\"angle\":3,%s",
                         coordinates[c], /* lines are counted along rows: at slants, pixels repeat */
                         mode == 0   ? ENDLESS ",\"tone_by\":\"width\",\"scale\":8"
                         : mode == 1 ? ENDLESS ",\"width\":2,\"scale\":6"
                                     : NESTED ",\"series\":1,\"width\":2,\"scale\":6,\"length\":110");
                if (wall_shot(&s, 40, 0, even(0.2, settings), &view)) {
                    hatch_count n = hatch_count_lines(&s);
                    least = fmin(least, n.mean / 0.2);
                    most = fmax(most, n.mean / 0.2);
                    thin = fmin(thin, mode == 0 ? n.period / 8 : n.width_low);
                    thick = fmax(thick, mode == 0 ? n.period / 8 : n.width_high);
                }
                shot_release(&s);
            }
            const char *what = mode == 0 ? "by width" : mode == 1 ? "by number" : "by number in strokes";
            check_at_least("IM-11", least, 0.85, "%s, %s, distance 1 to 64: least ink over what was asked for",
                           coordinates[c], what);
            check_at_most("IM-11", most, 1.15, "  the greatest");
            if (mode == 0) {
                check_at_least("IM-23", thin, 0.92 / sqrt(2), "  least distance of full lines over the scale");
                check_at_most("IM-23", thick, 1.03 * sqrt(2), "  the greatest");
            } else if (mode == 1) {
                check_at_least("IM-23", thin, 1.5, "  width of full lines of 2 px, the least");
                check_at_most("IM-23", thick, 2.5, "  the greatest");
            } else {
                check_at_most("IM-23", thick, 2.5, "  width of full lines of 2 px, the greatest");
            }
        }
}

/* Strokes counted along lines that are all of one octave: what lies between two gaps is as long as is said, in the
 * mean. */
static void lengths(void)
{
    shot_view view = hatch_front(320, 1.25);
    double    direction = 0, shortest = INFINITY, longest = 0;
    int       gaps = 0;
    for (int k = 0; k < 8; k++) {
        double length = 40 * pow(2, k / 8.0), covered = 1 - (3 + 0.01) / length;
        char   settings[240];
        shot   s;
        snprintf(settings, sizeof settings,
                 NESTED
                 ",\"series\":1,\"coordinates\":\"triplanar\",\"width\":4,\"gap\":3,\"taper\":0.01,\"length\":%.9g",
                 length);
        if (wall_shot(&s, 1.5, 0, even(0.2501 * covered, settings), &view))
            for (int y = 8; y < 312; y++) {
                double row = hatch_mean(&s, 0, y, 320, y + 1);
                int    run = -1;
                if (row < 0.6)
                    continue;
                for (int x = 0; x < 320; x++) {
                    bool inked = hatch_ink(&s, x, y) > 0.5, next = x < 319 && hatch_ink(&s, x + 1, y) > 0.5;
                    direction += inked / length;
                    run = inked && run >= 0 ? run + 1 : run;
                    if (inked && !next) {
                        gaps++;
                        shortest = run > 0 ? fmin(shortest, run / length) : shortest;
                        longest = fmax(longest, run / length);
                    }
                    if (!inked && next)
                        run = 0;
                }
            }
        shot_release(&s);
    }
    check_at_least("IM-11", gaps, 1000, "strokes counted");
    check_near("IM-11", direction / (gaps ? gaps : 1), 1, 0.15,
               "  their mean length over what was asked for (%.2f to %.2f)", shortest, longest);
}

/* --- 3: tone -------------------------------------------------------------------------------------------- */

typedef struct ramp_case {
    const char *what, *settings;
    double      tolerance;
    bool        ends; /* reaches black */
} ramp_case;

static const ramp_case ramps[] = {
    {"by width, endless", ENDLESS ",\"tone_by\":\"width\",\"scale\":7,\"angle\":11", 0.01, true},
    {"by width, endless, crossed",
     "\"length\":0," NESTED ",\"tone_by\":\"width\",\"scale\":7,\"series\":2,\"angle\":11", 0.02, true},
    {"by number, endless", ENDLESS ",\"angle\":11", 0.02, true},
    {"by number, strokes, series 1", "\"series\":1,\"angle\":11", 0.05, false},
    {"by number, strokes, series 2", "\"series\":2,\"angle\":11", 0.05, false},
    {"by number, strokes, series 3", "\"series\":3,\"angle\":11", 0.05, false},
    {"by width, strokes, series 1", "\"tone_by\":\"width\",\"series\":1,\"angle\":11", 0.05, false},
    {"by width, strokes, series 2", "\"tone_by\":\"width\",\"series\":2,\"angle\":11", 0.05, false},
    {"by number, strokes, series 4", "\"series\":4,\"angle\":11", 0.05, false},
};

/* A wall lit at 17 angles, from none to full light. */
static void ramp(void)
{
    shot_view view = hatch_front(256, 1);
    for (size_t r = 0; r < sizeof ramps / sizeof *ramps; r++) {
        double worst = 0, where = 0, last = 2, back = -1, first = 0, full = 0;
        int    odd = 0;
        for (int k = 0; k <= 16; k++) {
            double angle = (90 - 90 * k / 16.0) * pi / 180;
            char   light[64];
            shot   s;
            snprintf(light, sizeof light, "%.9f,0,%.9f", sin(angle), k ? cos(angle) : -1e-3);
            if (wall_shot(&s, 1.5, 0, hatch_look(light, "", "\"shadow\":0,\"light\":1,%s", ramps[r].settings), &view)) {
                double wanted = k ? 1 - cos(angle) : 1, got = hatch_mean(&s, 0, 0, 256, 256);
                bool   judged = ramps[r].ends || wanted < 0.8;
                if (judged && fabs(got - wanted) > worst) {
                    worst = fabs(got - wanted);
                    where = wanted;
                }
                back = fmax(back, got - last);
                last = got;
                first = k ? first : got;
                full = got;
                odd += hatch_odd_pixels(&s);
            }
            shot_release(&s);
        }
        check_at_most("IM-24", worst, ramps[r].tolerance, "%s: largest error of the ink%s (where %.3f was asked for)",
                      ramps[r].what, ramps[r].ends ? "" : " up to 0.8", where);
        check_at_most("IM-25", back, 0.002, "  most by which ink grows with light");
        check_at_most("IM-25", full, 0, "  ink in full light");
        check_at_least("IM-25", first, ramps[r].ends ? 0.999 : 0.7, "  ink without light");
        check_at_most("IM-25", odd, 0, "  pixels that are not grey or not solid");
    }
}

/* The model's own brightness in the tone, blacks below 0, lights above 1. */
static void tone_parameters(void)
{
    shot_view view = hatch_front(192, 1);
    shot      s;
    double    worst = 0;
    for (int k = 0; k <= 8; k++) {
        shape wall = {0};
        hatch_wall(&wall, 1.5, 0);
        float own = powf((float)k / 8, 2.2f);
        for (int c = 0; c < 3; c++)
            wall.parts[0].colour[c] = own;
        wall.parts[0].colour[3] = 1;
        if (shot_of_shape(&s, &wall, "own.glb",
                          hatch_look("0,0,1", "", "\"texture\":1,\"shadow\":0,\"light\":1,%s", ramps[0].settings), NULL,
                          &view))
            worst = fmax(worst, fabs(hatch_mean(&s, 0, 0, 192, 192) - (1 - k / 8.0)));
        shot_release(&s);
        shape_release(&wall);
    }
    check_at_most("tone", worst, 0.015, "texture 1: largest error of the ink over nine greys");
    static const struct {
        const char *light, *settings;
        double      wanted;
    } rows[] = {
        {"0,0,-1", "\"shadow\":-0.3,\"light\":1," ENDLESS, 1},
        {"0,0,-1", "\"shadow\":-1,\"light\":1,\"tone_by\":\"width\"," ENDLESS, 1},
        {"0,0,-1", "\"shadow\":-1,\"light\":1,\"tone_by\":\"width\",\"length\":0," NESTED ",\"series\":3", 1},
        {"0.8,0,0.6", "\"shadow\":-0.2,\"light\":1.2,\"tone_by\":\"width\",\"angle\":11," ENDLESS,
         1 - (-0.2 + 1.4 * 0.6)},
        {"0.8,0,0.6", "\"shadow\":0,\"light\":1,\"contrast\":2,\"tone_by\":\"width\",\"angle\":11," ENDLESS, 1 - 0.36},
        {"0.8,0,0.6", "\"shadow\":0,\"light\":2,\"tone_by\":\"width\"," ENDLESS, 0},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        if (wall_shot(&s, 1.5, 0, hatch_look(rows[k].light, "", "%s", rows[k].settings), &view))
            check_near("tone", hatch_mean(&s, 0, 0, 192, 192), rows[k].wanted, 0.01, "light from %s, %.40s: ink",
                       rows[k].light, rows[k].settings);
        shot_release(&s);
    }
}

/* Light ink on dark paper stands for light: the picture of it is the negative of one whose tone is turned about. */
static void polarity(void)
{
    shot_view view = hatch_front(160, 1);
    shot      light, dark;
    for (int mode = 0; mode < 2; mode++) {
        const char *tail = mode ? "\"tone_by\":\"number\"," ENDLESS : "\"tone_by\":\"width\"," ENDLESS;
        bool        ok = wall_shot(
                   &light, 2, 0,
                   hatch_look("0,0,1", "", "\"ink\":\"#ffffff\",\"paper\":\"#000000\",\"shadow\":0.3,\"light\":0.3,%s", tail),
                   &view);
        if (wall_shot(&dark, 2, 0, hatch_look("0,0,1", "", "\"shadow\":0.7,\"light\":0.7,%s", tail), &view) && ok) {
            double worst = 0;
            for (int y = 0; y < 160; y++)
                for (int x = 0; x < 160; x++)
                    worst = fmax(worst, fabs(1 - hatch_ink(&light, x, y) - hatch_ink(&dark, x, y)));
            check_near("polarity", 1 - hatch_mean(&light, 0, 0, 160, 160), 0.3, 0.02, "white ink for a tone of 0.3");
            check_at_most("polarity", worst, 0.02, "  largest difference to black ink for 0.7");
        }
        shot_release(&light);
        shot_release(&dark);
    }
}

/* Each lighter picture's ink is also in the darker one. */
static void nesting(void)
{
    static const struct {
        const char *what, *settings;
    } rows[] = {
        {"by width", ENDLESS ",\"tone_by\":\"width\",\"angle\":11"},
        {"by number", ENDLESS ",\"angle\":11"},
        {"by width, crossed", "\"length\":0," NESTED ",\"tone_by\":\"width\",\"series\":3"},
        {"by number, crossed", "\"length\":0," NESTED ",\"series\":3"},
        {"by width, strokes", NESTED ",\"tone_by\":\"width\",\"series\":2"},
        {"by number, strokes", NESTED ",\"series\":2"},
        {"by number, strokes, loose", "\"wobble\":0,\"uneven\":0,\"loose\":0.5,\"series\":2"},
        {"by number, all defaults", "\"series\":2"},
    };
    shot_view view = hatch_front(160, 1);
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        shot   before, now = {0};
        int    lost = 0, pixels = 0;
        double worst = 0;
        for (int k = 0; k <= 24; k++) {
            before = now;
            memset(&now, 0, sizeof now);
            if (wall_shot(&now, 1.5, 0, even(k / 24.0, rows[r].settings), &view) && before.picture)
                for (int y = 0; y < 160; y++)
                    for (int x = 0; x < 160; x++) {
                        double step = hatch_ink(&before, x, y) - hatch_ink(&now, x, y);
                        worst = fmax(worst, step);
                        lost += step > 2.0 / 255;
                        pixels++;
                    }
            shot_release(&before);
        }
        shot_release(&now);
        check_at_most("nesting", (double)lost / (pixels ? pixels : 1), 0,
                      "%s, 25 tones: fraction of pixels whose ink gets less when it gets darker (by %.3f at most)",
                      rows[r].what, worst);
    }
}

/* --- 4: borders ----------------------------------------------------------------------------------------- */

/* A floor in perspective: ink by its distance, and steps from one stripe to the next. */
static void no_octave_border(void)
{
    static const char *const settings[] = {
        ENDLESS ",\"tone_by\":\"width\",\"coordinates\":\"triplanar\"", ENDLESS ",\"coordinates\":\"triplanar\"",
        ENDLESS ",\"tone_by\":\"width\",\"coordinates\":\"axes\"", ENDLESS ",\"coordinates\":\"axes\"",
        NESTED ",\"series\":1,\"coordinates\":\"axes\",\"length\":40,\"gap\":3,\"taper\":8"};
    shot_view view = {
        .width = 320, .height = 320, .eye = {0, 0.3, 0.9}, .target = {0, 0, -0.6}, .up = {0, 1, 0}, .fov_deg = 60};
    for (int k = 0; k < 5; k++) {
        shape floor = {0};
        shot  s;
        hatch_wall(&floor, 8, 0);
        shape_place(&floor, dvec_of(1, 0, 0), -90, dvec_of(0, 0, 0));
        char look[300];
        snprintf(look, sizeof look, "%s,\"scale\":4,\"angle\":%d%s", settings[k], k < 2 ? 37 : 0,
                 strstr(settings[k], "width\"") ? "" : ",\"width\":1.3");
        if (shot_of_shape(&s, &floor, "floor.glb", even(0.35, look), NULL, &view)) {
            double worst = 0, step = 0, last = -1;
            int    bands = 0;
            for (int y = 80; y + 16 <= 320; y += 8) {
                if (isinf(s.depth[y * 320]) || isinf(s.depth[y * 320 + 319]))
                    continue;
                double mean = hatch_mean(&s, 0, y, 320, y + 16);
                worst = fmax(worst, fabs(mean / 0.35 - 1));
                step = last >= 0 ? fmax(step, fabs(mean - last)) : step;
                last = mean;
                bands++;
            }
            double limit = k == 4 ? 0.15 : 0.05;
            check_at_least("IM-24", bands, 20, "floor, %.60s: stripes", settings[k]);
            check_at_most("IM-24", worst, limit, "  largest share that a stripe's ink is off");
            check_at_most("IM-24", step / 0.35, limit, "  largest step from one to the next");
        }
        shot_release(&s);
        shape_release(&floor);
    }
}

/* --- 5: unevenness -------------------------------------------------------------------------------------- */

/* One line followed over all columns: how far its middle strays, and the mean distance between lines. */
static double straying(const shot *s, double *spacing)
{
    double sum = 0, squares = 0, directions = 0, distances = 0;
    int    count = 0, gaps = 0;
    for (int x = 0; x < s->width; x++) {
        double ink = 0, moment = 0, first = -1, last = -1, nearest = INFINITY;
        int    lines = 0;
        for (int y = 0; y < s->height; y++) {
            double here = hatch_ink(s, x, y);
            ink += here;
            moment += here * y;
            if (here > 0.004 || ink == 0)
                continue;
            if (ink > 0.3) {
                double at = moment / ink;
                first = lines++ ? first : at;
                last = at;
                nearest = fabs(at - s->height / 2.0 - directions) < fabs(nearest - s->height / 2.0 - directions)
                              ? at
                              : nearest;
            }
            ink = moment = 0;
        }
        if (lines > 1) {
            distances += last - first;
            gaps += lines - 1;
            directions = nearest - s->height / 2.0;
            sum += nearest;
            squares += nearest * nearest;
            count++;
        }
    }
    *spacing = gaps ? distances / gaps : 0;
    return count ? sqrt(fmax(0, squares / count - sum * sum / count / count)) : 0;
}

/* Mean ink of a tone over several places and times, so that what noise does to one of them evens out; on fine
 * lines, whose waves are short. */
static double mean_over_positions(double darkness, const char *settings, double first_time)
{
    double sum = 0;
    for (int k = 0; k < 6; k++) {
        shot_view view = hatch_front(320, 1.37);
        char      all[300];
        shot      s;
        view.time_s = first_time + 0.37 * k;
        view.eye.x = view.target.x = 3.1 * (k - 2.5);
        snprintf(all, sizeof all, "\"length\":0,\"series\":1,\"loose\":0,\"tone_by\":\"width\",\"scale\":2.5,%s",
                 settings);
        if (wall_shot(&s, 10, 0, even(darkness, all), &view))
            sum += hatch_mean(&s, 0, 0, 320, 320) / 6;
        shot_release(&s);
    }
    return sum;
}

static void unevenness(void)
{
    shot_view view = hatch_front(320, 1);
    double    spacing[2], stray[2], deviation[2];
    for (int k = 0; k < 2; k++) {
        char settings[300];
        shot s;
        snprintf(settings, sizeof settings,
                 "\"length\":0,\"series\":1,\"loose\":0,\"wobble\":0,\"uneven\":%g,\"tone_by\":\"width\",\"scale\":8,"
                 "\"coordinates\":\"triplanar\",\"angle\":3",
                 k ? 0.8 : 0.0);
        if (wall_shot(&s, 1.5, 0, even(0.4, settings), &view)) {
            hatch_count n = hatch_count_lines(&s);
            deviation[k] = n.deviation;
        }
        shot_release(&s);
        snprintf(settings, sizeof settings,
                 "\"length\":0,\"series\":1,\"loose\":0,\"uneven\":0,\"wobble\":%g,\"tone_by\":\"width\",\"scale\":12,"
                 "\"coordinates\":\"triplanar\"",
                 k ? 0.5 : 0.0);
        if (wall_shot(&s, 1.5, 0, even(0.3, settings), &view))
            stray[k] = straying(&s, &spacing[k]);
        shot_release(&s);
    }
    check_at_least("IM-26", deviation[1] - deviation[0], 0.15,
                   "uneven 0.8: how much more the width of lines varies than without (%.3f px)", deviation[0]);
    check_near("IM-26", mean_over_positions(0.4, "\"wobble\":0,\"uneven\":0.5", 0), 0.4, 0.02 * 0.4, "  ink of 0.4");
    check_near("IM-27", mean_over_positions(0.4, "\"wobble\":0.5,\"uneven\":0", 0), 0.4, 0.02 * 0.4,
               "wobble 0.5: ink of 0.4");
    check_at_most("IM-27", stray[0], 0.02, "wobble 0: how far the middle of a line strays, px");
    check_at_least("IM-27", stray[1], 0.5, "wobble 0.5 of 12 px: the same");
    check_near("IM-27", spacing[1] / spacing[0], 1, 0.03, "  mean distance of lines over that without");
}

/* Time: slow change is slow, fast change is another picture, and the ink stays. */
static void change(void)
{
    shot_view view = hatch_front(256, 1);
    view.without_maps = false;
    double              difference[3], correlation[3];
    static const double rates[] = {0, 0.5, 60};
    for (int k = 0; k < 3; k++) {
        char settings[300];
        shot a, b;
        view.time_s = 1;
        snprintf(settings, sizeof settings,
                 "\"length\":0,\"series\":1,\"loose\":0,\"wobble\":0.8,\"uneven\":0.5,\"scale\":8,\"tone_by\":"
                 "\"width\",\"change\":%g",
                 rates[k]);
        bool ok = wall_shot(&a, 1.5, 0, even(0.4, settings), &view);
        view.time_s = 1.04;
        if (wall_shot(&b, 1.5, 0, even(0.4, settings), &view) && ok) {
            hatch_change c = hatch_compare(&b, &a);
            difference[k] = c.mean;
            correlation[k] = c.correlation;
        }
        shot_release(&a);
        shot_release(&b);
    }
    check_at_most("IM-31", difference[0], 0, "change 0: mean difference of frames 1/25 s apart");
    check_at_most("IM-31", difference[1], 0.1 * difference[2], "change 0.5: the same; a tenth of that at 60");
    check_at_least("IM-31", correlation[1], 0.95, "  correlation of the two");
    check_at_most("IM-31", correlation[2], 0.4, "change 60: correlation of the two");
    check_near("IM-31", mean_over_positions(0.4, "\"wobble\":0.5,\"uneven\":0.5,\"change\":0.5", 1), 0.4, 0.02 * 0.4,
               "  ink of 0.4 at change 0.5");
    check_near("IM-31", mean_over_positions(0.4, "\"wobble\":0.5,\"uneven\":0.5,\"change\":60", 1), 0.4, 0.02 * 0.4,
               "  at 60");
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"formulas", formulas},
        {"perspective", formulas_in_perspective},
        {"angles", angles},
        {"edges", edges},
        {"zoom", zoom},
        {"distance", distance_in_perspective},
        {"lengths", lengths},
        {"ramp", ramp},
        {"tone", tone_parameters},
        {"polarity", polarity},
        {"nesting", nesting},
        {"borders", no_octave_border},
        {"uneven", unevenness},
        {"change", change},
    };
    int status = check_main(argc, argv, "hatch", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
