/* How area is filled: tones counted on spheres, Gooch's ramp in closed form, tone borders, orientation of textures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"
#include "surface_look.h"

static const double PI = 3.14159265358979323846;

static bool take_ball(shot *out, const char *look, const char *const *changes)
{
    shape s = {0};
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 96, 192, true);
    bool ok = shot_of_shape(out, &s, "ball.glb", look, changes, &front);
    shape_release(&s);
    return ok;
}

static double luminance(const uint8_t *p)
{
    return 0.2126 * picture_linear(p[0]) + 0.7152 * picture_linear(p[1]) + 0.0722 * picture_linear(p[2]);
}

/* Distinct colours inside the figure and how many pixels each has, the most frequent first; at most `capacity`. */
static int colours_of(const shot *s, uint32_t *colours, int *pixels, int capacity)
{
    int count = 0;
    for (int i = 0; i < s->width * s->height; i++) {
        if (isinf(s->depth[i]))
            continue;
        uint32_t c;
        memcpy(&c, &s->picture[4 * i], 4);
        int k = 0;
        while (k < count && colours[k] != c)
            k++;
        if (k == capacity)
            continue;
        if (k == count) {
            colours[count] = c;
            pixels[count++] = 0;
        }
        pixels[k]++;
    }
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k < count; k++)
            if (pixels[k] > pixels[i]) {
                int      n = pixels[i];
                uint32_t c = colours[i];
                pixels[i] = pixels[k];
                pixels[k] = n;
                colours[i] = colours[k];
                colours[k] = c;
            }
    return count;
}

/* Is a pixel lighter than another whenever it is turned to the light by a tenth more? */
static int wrong_order(const shot *s, dvec light)
{
    double darkest[21], lightest[21];
    int    wrong = 0;
    for (int k = 0; k < 21; k++) {
        darkest[k] = INFINITY;
        lightest[k] = -INFINITY;
    }
    for (int i = 0; i < s->width * s->height; i++) {
        if (isinf(s->depth[i]))
            continue;
        int    k = (int)floor((dvec_dot(dvec_unit(light), dvec_from(s->normal[i])) + 1) * 10);
        double l = luminance(&s->picture[4 * i]);
        darkest[k] = fmin(darkest[k], l);
        lightest[k] = fmax(lightest[k], l);
    }
    for (int k = 0; k + 1 < 21; k++)
        for (int j = k + 2; j < 21; j++)
            wrong += lightest[k] > darkest[j] + 0.01;
    return wrong;
}

/* Pixels whose colour is not that of their light: half of what the lights' directions have in common with the normal,
 * and a half, by their strengths. Those at the border of a tone are not asked. `tones`: how many their lights
 * come to. */
static int wrong_tones(const shot *s, const char *palette, int steps, double fill, int *tones)
{
    dvec key = {0.8, 0.5, 0.4}, other = dvec_unit((dvec){-key.x, -0.3 * key.y, fabs(key.z) + 0.2});
    dvec both = dvec_scale(dvec_add(dvec_unit(key), dvec_scale(other, fill)), 1 / (1 + fill));
    int  wrong = 0;
    bool seen[8] = {false};
    *tones = 0;
    for (int i = 0; i < s->width * s->height; i++) {
        if (isinf(s->depth[i]))
            continue;
        double   light = 0.5 + 0.5 * dvec_dot(dvec_from(s->normal[i]), both), tone = light * steps;
        unsigned colour = 0;
        int      own = (int)fmin(floor(tone), steps - 1);
        *tones += !seen[own];
        seen[own] = true;
        sscanf(palette + 3 + 10 * own, "%2x", &colour);
        wrong += fabs(tone - floor(tone + 0.5)) > 0.02 && abs(s->picture[4 * i] - (int)colour) > 1;
    }
    return wrong;
}

static void tones_are_counted(void)
{
    static const char *const palettes[] = {"[\"#202020\",\"#f0f0f0\"]", "[\"#202020\",\"#808080\",\"#f0f0f0\"]",
                                           "[\"#101010\",\"#404040\",\"#707070\",\"#a0a0a0\",\"#d0d0d0\"]"};
    static const int         steps[] = {2, 3, 5};
    uint32_t                 colours[64];
    int                      pixels[64];
    for (int i = 0; i < 3; i++)
        for (int fill = 0; fill < 2; fill++) {
            char surface[160];
            shot s;
            snprintf(surface, sizeof surface, "{\"technique\":\"tones\",\"palette\":%s}", palettes[i]);
            if (take_ball(&s, surface_look(surface, "0.8,0.5,0.4", fill ? 0.6 : 0), NULL)) {
                int count = colours_of(&s, colours, pixels, 64);
                int tones;
                check_at_most("G1", wrong_tones(&s, palettes[i], steps[i], fill ? 0.6 : 0, &tones), 0,
                              "pixels of a sphere that have another tone of %d than their light says%s", steps[i],
                              fill ? ", with a second light" : "");
                check_near("G1", count, tones, 0, "  tones, as many as there are in its light");
                if (!fill)
                    check_at_most("G1", wrong_order(&s, dvec_of(0.8, 0.5, 0.4)), 0,
                                  "places where the side to the light is the darker one");
            }
            shot_release(&s);
        }
    for (int bands = 2; bands <= 5; bands++)
        for (int fill = 0; fill < 2; fill++) {
            char surface[160];
            shot s;
            snprintf(surface, sizeof surface, "{\"technique\":\"toon\",\"bands\":%d,\"softness\":0,\"highlight\":0}",
                     bands);
            if (take_ball(&s, surface_look(surface, "0.5,0.5,0.7", fill ? 0.8 : 0), NULL))
                check_near("G1", colours_of(&s, colours, pixels, 64), bands, 0, "tones of toon with %d bands, %s",
                           bands, fill ? "two lights" : "one light");
            shot_release(&s);
        }
}

/* An even wash has every tone between shadow and light; half of one leaves both of them flat. */
static void washes(void)
{
    enum { MOST = 256 };
    uint32_t colours[MOST];
    int      pixels[MOST], flat[3];
    for (int k = 0; k < 3; k++) {
        char surface[160];
        shot s;
        snprintf(surface, sizeof surface,
                 "{\"technique\":\"toon\",\"bands\":2,\"softness\":0,\"highlight\":0,\"gradation\":%g}", 0.5 * k);
        flat[k] = 0;
        if (take_ball(&s, surface_look(surface, "0.5,0.5,0.5", 0), NULL)) {
            int count = colours_of(&s, colours, pixels, MOST), all = 0, most = 0;
            for (int i = 0; i < count; i++) {
                all += pixels[i];
                most = pixels[i] > most ? pixels[i] : most;
            }
            flat[k] = 100 * most / (all ? all : 1);
            if (k == 0)
                check_near("G1", count, 2, 0, "tones of toon without gradation");
            else
                check_at_least("G1", count, 40, "with a gradation of %g", 0.5 * k);
        }
        shot_release(&s);
    }
    check_at_least("G1", flat[0] - flat[1], 5, "percent that the flat tone loses to half a wash");
    check_at_least("G1", flat[1] - flat[2], 5, "and half a wash to a whole one");
}

/* Flat tones stay constant; between them lie one to three pixels of transition. Counted along rows that cross the
 * borders nearly at right angles. */
static void tone_borders(void)
{
    static const char *const forms[] = {
        "{\"technique\":\"toon\",\"bands\":3,\"softness\":1,\"highlight\":0}",
        "{\"technique\":\"toon\",\"bands\":3,\"softness\":0,\"highlight\":0,\"seed_blur\":true}"};
    for (int f = 0; f < 2; f++) {
        uint32_t colours[256];
        int      pixels[256], runs = 0, short_runs = 0, long_runs = 0, flat = 0, inside = 0;
        shot     s;
        if (take_ball(&s, surface_look(forms[f], "1,0.1,0.3", 0), NULL)) {
            colours_of(&s, colours, pixels, 256);
            for (int y = 80; y < 176; y++) {
                int run = -1, tone = -1;
                for (int x = 0; x < 256; x++) {
                    int      i = y * 256 + x, k = 0;
                    uint32_t c;
                    if (isinf(s.depth[i]) || s.normal[i][2] < 0.35f) {
                        run = -1;
                        continue;
                    }
                    memcpy(&c, &s.picture[4 * i], 4);
                    while (k < 3 && colours[k] != c)
                        k++;
                    inside++;
                    flat += k < 3;
                    if (k == 3) {
                        run += run >= 0;
                    } else {
                        if (run >= 0 && k != tone) {
                            runs++;
                            short_runs += run < 1;
                            long_runs += run > 3;
                        }
                        tone = k;
                        run = 0;
                    }
                }
            }
        }
        check_at_least("E12", runs, 100, "borders between tones crossed (%s)",
                       f ? "blurred as the seed" : "softness 1");
        check_at_most("E12", short_runs, 0, "of them without a transition");
        check_at_most("E12", long_runs, 0, "of them with more than 3 px");
        check_at_least("E12", inside ? (double)flat / inside : 0, 0.9, "fraction of pixels in one of the flat tones");
        shot_release(&s);
    }
}

/* Four bilinear samples at two thirds of a pixel are the mean of nine. */
static void blur_is_a_box(void)
{
    shot        sharp, blurred;
    double      worst = 0;
    int         changed = 0;
    const char *hard = "{\"technique\":\"toon\",\"bands\":4,\"softness\":0,\"highlight\":0}";
    const char *soft = "{\"technique\":\"toon\",\"bands\":4,\"softness\":0,\"highlight\":0,\"seed_blur\":true}";
    bool        ok = take_ball(&sharp, surface_look(hard, "1,0.35,0.3", 0), NULL);
    if (take_ball(&blurred, surface_look(soft, "1,0.35,0.3", 0), NULL) && ok)
        for (int y = 1; y < 255; y++)
            for (int x = 1; x < 255; x++) {
                double mean = 0;
                bool   inside = true;
                for (int k = 0; k < 9; k++) {
                    int i = (y + k / 3 - 1) * 256 + x + k % 3 - 1;
                    inside = inside && !isinf(sharp.depth[i]);
                    mean += picture_shown(sharp.picture[4 * i]) / 9;
                }
                int i = y * 256 + x;
                if (!inside)
                    continue;
                worst = fmax(worst, fabs(picture_shown(blurred.picture[4 * i]) - mean));
                changed += blurred.picture[4 * i] != sharp.picture[4 * i];
            }
    check_at_least("E02", changed, 200, "pixels that the blur changes");
    check_at_most("E02", worst * 255, 1.5, "levels between the blur and the mean of nine");
    shot_release(&sharp);
    shot_release(&blurred);
}

/* A ball whose normals are scanned with noise. */
static void noisy_ball(shape *s, int rings, int sides, uint32_t noise, float by)
{
    shape_sphere(s, "ball", dvec_of(0, 0, 0), 1, rings, sides, true);
    for (uint32_t i = 0; i < s->parts[0].vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            noise = noise * 1664525u + 1013904223u;
            s->parts[0].normals[i][k] += by * ((float)(noise >> 8) / 8388608.0f - 1);
        }
}

/* Pairs of neighbouring pixels of different tones on a noisy ball. */
static int tone_changes(double smoothing)
{
    char  surface[160];
    shape s = {0};
    shot  ball;
    int   changes = 0;
    snprintf(surface, sizeof surface,
             "{\"technique\":\"toon\",\"bands\":3,\"softness\":0,\"highlight\":0,\"smoothing\":%g}", smoothing);
    noisy_ball(&s, 48, 96, 1, 0.2f);
    if (shot_of_shape(&ball, &s, "noisy.glb", surface_look(surface, "1,0.3,0.5", 0), NULL, &front))
        for (int y = 80; y < 176; y++)
            for (int x = 81; x < 176; x++)
                changes += ball.picture[4 * (y * 256 + x)] != ball.picture[4 * (y * 256 + x - 1)];
    shot_release(&ball);
    shape_release(&s);
    return changes;
}

/* Each row crosses each border between tones once where there are no islands and borders are smooth. */
static void tones_leave_the_faces(void)
{
    int noisy = tone_changes(0), smooth = tone_changes(12);
    check_at_least("E12", noisy, 350, "changes of tone along rows of a noisy scan");
    check_at_least("E12", smooth, 96, "  smoothed");
    check_at_most("E12", smooth, 230, "  smoothed: hardly more than two a row");
}

/* Pixels of a coarse ball whose tone is not that of the ball it stands for: where 2 N·L − 1 changes its sign. Its
 * vertices' normals lean from the ball's by up to 11 degrees. */
static int tones_off(const char *smoothing)
{
    const double light[3] = {0.8, 0.36, 0.48};
    char         surface[160];
    shape        s = {0};
    shot         ball;
    int          wrong = 0;
    snprintf(surface, sizeof surface,
             "{\"technique\":\"toon\",\"bands\":2,\"softness\":0,\"highlight\":0,\"smoothing\":\"%s\"}", smoothing);
    noisy_ball(&s, 16, 32, 7, 0.12f);
    if (shot_of_shape(&ball, &s, "coarse.glb", surface_look(surface, "0.8,0.36,0.48", 0), NULL, &front)) {
        double radius = 256 / (2 * 8 * tan(9 * PI / 180)), lightest = 0;
        for (int i = 0; i < 256 * 256; i++)
            lightest = isinf(ball.depth[i]) ? lightest : fmax(lightest, ball.picture[4 * i]);
        for (int y = 0; y < 256; y++)
            for (int x = 0; x < 256; x++) {
                double at[3] = {(x + 0.5 - 128) / radius, (128 - y - 0.5) / radius, 0}, turned = 0;
                double off = at[0] * at[0] + at[1] * at[1];
                at[2] = sqrt(fmax(1 - off, 0));
                for (int k = 0; k < 3; k++)
                    turned += at[k] * light[k];
                wrong += off < 0.7 && (ball.picture[4 * (y * 256 + x)] >= lightest) != (turned >= 0.5);
            }
        shot_release(&ball);
    }
    shape_release(&s);
    return wrong;
}

/* Triangles show in the borders of tones; over a length on paper that is longer than they are, hardly. */
static void borders_leave_the_triangles(void)
{
    int faces = tones_off("6px"), form = tones_off("40px");
    check_at_least("E12", faces, 300, "pixels of a coarse ball in another tone than the ball it stands for");
    check_at_most("E12", form, 0.45 * faces, "  smoothed over more than a triangle");
}

static void dark_fill_is_legible(void)
{
    for (int k = 0; k < 4; k++) {
        char   surface[160];
        double darkest = 1, floor = k & 1 ? 0.3 : 0;
        shot   s;
        snprintf(surface, sizeof surface,
                 "{\"technique\":\"toon\",\"shadow\":0,\"highlight\":0,\"smoothing\":%d,\"darkest\":%g}", k & 2, floor);
        if (take_ball(&s, surface_look(surface, "1,0.1,0.3", 0), NULL))
            for (int i = 0; i < 256 * 256; i++)
                if (!isinf(s.depth[i]))
                    darkest = fmin(darkest, s.picture[4 * i] / 255.0);
        check_near("E12", darkest, floor, 0.005, "the darkest fill shown, smoothed over %d", k & 2);
        shot_release(&s);
    }
}

/* A prism of eight flanks, each with normals of its own. */
static void shape_prism(shape *s)
{
    enum { SIDES = 8 };
    shape_part *p = shape_add(s, "prism", 4 * SIDES, 6 * SIDES, true, false);
    for (uint32_t side = 0; side < SIDES; side++) {
        static const uint32_t quad[6] = {0, 1, 3, 0, 3, 2};
        for (uint32_t k = 0; k < 4; k++) {
            double at = (side + (k & 1) + 0.25) * 2 * PI / SIDES, middle = (side + 0.75) * 2 * PI / SIDES;
            float *position = p->positions[4 * side + k], *normal = p->normals[4 * side + k];
            position[0] = (float)sin(at);
            position[1] = k & 2 ? 0.9f : -0.9f;
            position[2] = (float)cos(at);
            normal[0] = (float)sin(middle);
            normal[1] = 0;
            normal[2] = (float)cos(middle);
        }
        for (uint32_t k = 0; k < 6; k++)
            p->indices[6 * side + k] = 4 * side + quad[k];
    }
}

/* Faces that turn by 45 degrees from one to the next: each keeps its one tone up to its edges. */
static void flat_faces_stay_flat(void)
{
    shape    s = {0};
    shot     drawing;
    uint32_t colours[64];
    int      pixels[64];
    shape_prism(&s);
    if (shot_of_shape(&drawing, &s, "prism.glb",
                      surface_look("{\"technique\":\"toon\",\"bands\":16,\"softness\":0,\"highlight\":0,"
                                   "\"smoothing\":\"8px\"}",
                                   "0.7,0.5,0.6", 0),
                      NULL, &front)) {
        int count = colours_of(&drawing, colours, pixels, 64), few = 0;
        for (int k = 0; k < count; k++)
            few += pixels[k] < 1000;
        check_at_least("E12", count - few, 4, "tones of a prism's flanks");
        check_at_most("E12", few, 0, "  tones between them, along edges");
    }
    shot_release(&drawing);
    shape_release(&s);
}

/* The lines of a dark floor, and a light plate so close above it that on the page it is hardly a pixel up: none shows
 * through, and the floor beside it has them all. */
static void lines_are_hidden_by_what_lies_close(void)
{
    const char *look =
        surface_look("{\"technique\":\"lines\",\"ink\":\"#ff0000\",\"scale\":\"5px\",\"texture\":1}", "0,1,1", 0.5);
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        shot_view view = {.width = 256,
                          .height = 256,
                          .eye = {5, 5, 5},
                          .up = {0, 1, 0},
                          .orthographic = orthographic,
                          .fov_deg = 18};
        shape     s = {0};
        shot      drawing;
        int       red[2] = {0}, seen[2] = {0};
        shape_box(&s, "floor", dvec_of(-1, -0.1, -1), dvec_of(1, 0, 1));
        for (int k = 0; k < 3; k++)
            s.parts[0].colour[k] = 0.1f;
        shape_box(&s, "plate", dvec_of(-0.6, 0.012, -0.6), dvec_of(0.6, 0.014, 0.6));
        if (shot_of_shape(&drawing, &s, "plates.glb", look, NULL, &view))
            for (int i = 3 * 256; i < 253 * 256; i++) {
                /* Whether a line is hidden is asked at its axis: half of its width may stand over an edge. */
                bool within = drawing.id[i] == drawing.id[i + 3] && drawing.id[i] == drawing.id[i - 3] &&
                              drawing.id[i] == drawing.id[i + 3 * 256] && drawing.id[i] == drawing.id[i - 3 * 256];
                if (!within || isinf(drawing.depth[i]) || drawing.normal[i][1] < 0.5f)
                    continue;
                int plate = drawing.id[i] == 2;
                seen[plate]++;
                red[plate] += drawing.picture[4 * i + 1] < 200;
            }
        check_at_least("EX-14", seen[1], 2000, "pixels of a plate above a floor");
        check_at_most("EX-14", red[1], 0, "  with ink of the floor's lines");
        check_at_least("EX-14", (double)red[0] / fmax(seen[0], 1), 0.3, "share of the floor beside it that is inked");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A coarse ball, so large that chords of lines leave its facets by pixels: where it is black, lines cover all of it,
 * also where one stroke ends and the next begins; where it is hardly dark, strokes run out there. */
static void lines_join_where_it_is_dark(void)
{
    static const char *const tones[] = {"\"shadow\":-1,\"light\":0", "\"shadow\":0.8,\"light\":0.8"};
    double                   bare[2][2] = {{0}};
    for (int tone = 0; tone < 2; tone++)
        for (int cut = 0; cut < 2; cut++) {
            char  surface[256];
            shape s = {0};
            shot  drawing;
            int   seen = 0, light = 0;
            snprintf(surface, sizeof surface,
                     "{\"technique\":\"lines\",\"series\":1,\"scale\":\"16px\",\"taper\":6,%s,\"length\":%g}",
                     tones[tone], cut ? 0.1 : 0.0);
            shot_view view = {.width = 512, .height = 512, .eye = {3, 4, 5}, .up = {0, 1, 0}, .fov_deg = 4};
            shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 12, 24, true);
            if (shot_of_shape(&drawing, &s, "coarse.glb", surface_look(surface, "0.5,0.6,0.7", 0), NULL, &view))
                for (int i = 0; i < 512 * 512; i++) {
                    seen += !isinf(drawing.depth[i]);
                    light += !isinf(drawing.depth[i]) && drawing.picture[4 * i] > 128;
                }
            bare[tone][cut] = seen ? (double)light / seen : 1;
            check_at_least("EX-14", seen, 200000, "pixels of a coarse ball");
            shot_release(&drawing);
            shape_release(&s);
        }
    check_at_most("EX-14", bare[0][0], 0.002, "share of a black ball that whole lines leave bare");
    check_at_most("EX-14", bare[0][1], 0.002, "  that strokes leave bare");
    check_at_least("EX-14", bare[1][1] - bare[1][0], 0.01, "  more where it is light, for strokes run out there");
}

/* The darkest tone has the shade's colour, the lightest the surface's own. */
static void shade_tints_the_dark(void)
{
    uint32_t colours[64];
    int      pixels[64];
    shot     s;
    if (take_ball(&s,
                  surface_look("{\"technique\":\"toon\",\"bands\":2,\"softness\":0,\"highlight\":0,\"saturation\":1,"
                               "\"shadow\":0.5,\"shade\":\"#8080ff\"}",
                               "0.8,0.6,0", 0),
                  NULL)) {
        check_near("E12", colours_of(&s, colours, pixels, 64), 2, 0, "tones with a shade");
        for (int k = 0; k < 2; k++) {
            const uint8_t *c = (const uint8_t *)&colours[k];
            bool           dark = c[0] < 200;
            check_near("E12", picture_linear(c[0]) / picture_linear(c[2]), dark ? picture_linear(0x80) : 1, 0.01,
                       "red of the %s tone beside its blue", dark ? "dark" : "light");
        }
    }
    shot_release(&s);
}

/* What looks opposite the light is a step lighter inside the darkest tone, and nowhere else. */
static void shade_has_reflected_light(void)
{
    static const double back[3] = {-0.911, -0.41, 0.057}; /* of (-0.8, -0.6 * 0.6, 0.05) */
    for (int smoothing = 0; smoothing < 2; smoothing++) {
        uint32_t colours[64];
        int      pixels[64], wrong = 0, returned = 0;
        char     surface[240];
        shot     s;
        snprintf(surface, sizeof surface,
                 "{\"technique\":\"toon\",\"bands\":2,\"softness\":0,\"highlight\":0,\"shadow\":0.3,\"reflected\":0.5,"
                 "\"smoothing\":\"%dpx\"}",
                 8 * smoothing);
        if (take_ball(&s, surface_look(surface, "0.8,0.6,0", 0), NULL)) {
            check_near("E12", colours_of(&s, colours, pixels, 64), 3, 0, "tones of two bands with reflected light");
            for (int i = 0; i < 256 * 256; i++) {
                double turned = 0, level = picture_linear(s.picture[4 * i]);
                for (int k = 0; k < 3; k++)
                    turned += back[k] * (double)s.normal[i][k];
                if (isinf(s.depth[i]) || fabs(turned - 0.52) < 0.03)
                    continue;
                bool lighter = level > 0.36 && level < 0.6;
                returned += lighter;
                wrong += lighter != (turned > 0.52);
            }
            check_at_least("E12", returned, 1000, "  pixels of it");
            check_at_most("E12", wrong, 0, "  in another place than looks there");
        }
        shot_release(&s);
    }
}

/* A picture's soft glow, as baked shadows are: cartoons have flat colours with borders. A mean of what is alike alone
 * left 3144 pixels of it. */
static void textures_become_flat(void)
{
    enum { SIDE = 256 };
    shape s = {0};
    shot  drawing;
    int   between = 0;
    shape_quad(&s, "wall", 1, 0);
    s.parts[0].texture_size = SIDE;
    s.parts[0].texture = check_alloc(SIDE * SIDE, 4);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double  from = hypot(i % SIDE - 127.5, i / SIDE - 127.5) - 60; /* a blue disc, its glow 14 wide */
        uint8_t glow = (uint8_t)(from < 0 ? 0 : from < 14 ? 150 + 100 * from / 14 : 250);
        memcpy(&s.parts[0].texture[4 * i],
               from < 0 ? (uint8_t[]){40, 90, 200, 255} : (uint8_t[]){glow, glow, glow, 255}, 4);
    }
    const char *look = surface_look("{\"technique\":\"toon\",\"bands\":1,\"light\":1,\"saturation\":1,\"highlight\":0,"
                                    "\"smoothing\":\"60px\"}",
                                    "0,0,1", 0);
    if (shot_of_shape(&drawing, &s, "glow.glb", look, NULL, &front))
        for (int y = 20; y < 236; y++)
            for (int x = 20; x < 236; x++) {
                int red = drawing.picture[4 * (y * 256 + x)];
                between += red > 60 && red < 240;
            }
    shot_release(&drawing);
    shape_release(&s);
    check_at_most("E12", between, 2300, "pixels of a glow that are neither of the colours it joins");
}

/* --- An inker's blacks ------------------------------------------------------------------------------------ */

static const double light_of_blacks[3] = {0.8, 0.6, 0};

/* White paper but for the blacks. */
static bool take_inked(shot *out, double blacks, double feather)
{
    char surface[240];
    snprintf(surface, sizeof surface,
             "{\"technique\":\"toon\",\"bands\":1,\"light\":1,\"highlight\":0,\"ink\":\"#000000\",\"blacks\":%g,"
             "\"feather\":%g,\"spacing\":\"8px\"}",
             blacks, feather);
    return take_ball(out, surface_look(surface, "0.8,0.6,0", 0), NULL);
}

/* 0 turned away from the light … 1 towards it. */
static double turned_at(const shot *s, int i)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += light_of_blacks[k] * (double)s->normal[i][k];
    return 0.5 + 0.5 * sum;
}

static double ink_at(const shot *s, int i)
{
    return 1 - s->picture[4 * i] / 255.0;
}

static void blacks_lie_away_from_the_light(void)
{
    for (int k = 0; k < 4; k++) {
        double blacks = 0.3 * k;
        int    wrong = 0, filled = 0;
        shot   s;
        if (take_inked(&s, blacks, 0))
            for (int i = 0; i < 256 * 256; i++) {
                double beyond = isinf(s.depth[i]) ? 1 : turned_at(&s, i) - 0.5 * blacks;
                filled += !isinf(s.depth[i]) && ink_at(&s, i) > 0.5;
                wrong += !isinf(s.depth[i]) && fabs(beyond) > 0.015 && (ink_at(&s, i) > 0.5) != (beyond < 0);
            }
        check_at_most("S1", wrong, 0, "pixels inked wrongly where blacks are %g", blacks);
        check_at_least("S1", filled, k ? 1000 * k : 0, "  pixels inked");
        shot_release(&s);
    }
}

/* What a brush leaves that is lifted, over a stripe's width: 1 in its middle. */
static double brush(double x)
{
    return 1 - sqrt(fabs(2 * (x - floor(x)) - 1));
}

static double next_number(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* The share of ink, at a fraction of the way, of strokes that are as long as 0.3 and up to 0.3 of their own and 0.4 of
 * their group's more, these going over into each other, while strokes come between them. */
static double reaching(double fraction)
{
    enum { TRIES = 200000 };
    int      count = 0;
    uint32_t state = 3;
    for (int k = 0; k < TRIES; k++) {
        double x = 2 * next_number(&state), between = next_number(&state), part = next_number(&state), wave = 0;
        double blend = part * part * (3 - 2 * part);
        for (int octave = 0; octave < 2; octave++) {
            double group = (1 - blend) * next_number(&state) + blend * next_number(&state);
            double length = 0.3 + 0.3 * next_number(&state) + 0.4 * group;
            wave += (octave ? between : 1 - between) * length * brush(octave ? x / 2 : x);
        }
        count += wave > fraction;
    }
    return (double)count / TRIES;
}

/* From where all is ink to where nothing is, strokes taper, and none is seen in the light. */
static void feathers_taper(void)
{
    enum { BINS = 8 };
    double ink[BINS + 2] = {0}, pixels[BINS + 2] = {0}, worst = 0;
    shot   s;
    if (take_inked(&s, 0.3, 0.3))
        for (int i = 0; i < 256 * 256; i++) {
            if (isinf(s.depth[i]) || s.normal[i][2] < 0.5f)
                continue; /* foreshortened there */
            int bin = 1 + (int)floor((turned_at(&s, i) - 0.15) / 0.3 * BINS);
            bin = bin < 0 ? 0 : bin > BINS + 1 ? BINS + 1 : bin;
            ink[bin] += ink_at(&s, i);
            pixels[bin]++;
        }
    shot_release(&s);
    for (int k = 1; k <= BINS; k++)
        if (pixels[k] > 0)
            worst = fmax(worst, fabs(ink[k] / pixels[k] - reaching((k - 0.5) / BINS)));
    check_at_most("S1", worst, 0.08, "share of ink on the way from the blacks into the light, beside tapering strokes");
    check_at_most("S1", ink[BINS + 1], 0, "ink in the light");
}

/* In the middle of the ball's dark border strokes run along the light as the page shows it. */
static void feathers_cross_the_border(void)
{
    double along = 0, across = 0;
    int    pairs = 0;
    shot   s;
    if (take_inked(&s, 0.3, 0.3))
        for (int y = 8; y < 248; y++)
            for (int x = 8; x < 248; x++) {
                int i = y * 256 + x, ahead = (y - 3) * 256 + x + 4, beside = (y + 4) * 256 + x + 3;
                if (isinf(s.depth[i]) || fabs(turned_at(&s, i) - 0.3) > 0.06 || s.normal[i][2] < 0.6f)
                    continue;
                along += fabs(ink_at(&s, ahead) - ink_at(&s, i));
                across += fabs(ink_at(&s, beside) - ink_at(&s, i));
                pairs++;
            }
    shot_release(&s);
    check_at_least("S1", pairs, 300, "pixels among feathering strokes");
    check_at_most("S1", along / fmax(across, 1), 0.5, "changes of ink along the light beside those across it");
}

/* A wall hardly turned into the light has no blacks from which strokes could reach over it. */
static void walls_are_not_feathered(void)
{
    shot_view view = {
        .width = 256, .height = 256, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 20};
    shape  s = {0};
    shot   drawing;
    double ink = 0, seen = 0;
    shape_box(&s, "wall", dvec_of(-1, -1, -0.1), dvec_of(1, 1, 0));
    const char *look =
        surface_look("{\"technique\":\"toon\",\"bands\":1,\"light\":1,\"highlight\":0,\"ink\":\"#000000\","
                     "\"blacks\":0.9,\"feather\":0.3,\"spacing\":\"8px\"}",
                     "1,0,0.1", 0);
    if (shot_of_shape(&drawing, &s, "wall.glb", look, NULL, &view))
        for (int i = 0; i < 256 * 256; i++)
            if (!isinf(drawing.depth[i])) {
                ink += ink_at(&drawing, i);
                seen++;
            }
    check_at_least("S1", seen, 10000, "pixels of a wall beyond the blacks by less than feathers reach");
    check_at_most("S1", ink, 0, "  their ink");
    shot_release(&drawing);
    shape_release(&s);
}

static const char *spotted_surface(double spotted)
{
    static char surface[240];
    snprintf(surface, sizeof surface,
             "{\"technique\":\"toon\",\"bands\":1,\"light\":1,\"highlight\":0,\"ink\":\"#000000\",\"blacks\":0.3,"
             "\"darkest\":0.3,\"spotted\":%g}",
             spotted);
    return surface;
}

/* What is dark itself is black farther into the light: by 0.3 of the way where it is darker than 0.15; not what has a
 * colour, as panes do (2). */
static void dark_things_are_blacker(void)
{
    for (int which = 0; which < 3; which++) {
        shape s = {0};
        shot  ball;
        int   wrong = 0, filled = 0, spotted = which > 0, blacker = which == 1;
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 96, 192, true);
        for (int k = 0; k < 3; k++)
            s.parts[0].colour[k] = which == 2 && k > 0 ? 0.075f : 0.01f; /* 0.3 and 0.1 as it is shown */
        if (shot_of_shape(&ball, &s, "dark.glb", surface_look(spotted_surface(spotted), "0.8,0.6,0", 0), NULL, &front))
            for (int i = 0; i < 256 * 256; i++) {
                double beyond = isinf(ball.depth[i]) ? 1 : turned_at(&ball, i) - 0.15 - 0.3 * blacker;
                bool   inked = ball.picture[4 * i] < 40; /* the fill is no darker than 76 */
                filled += !isinf(ball.depth[i]) && inked;
                wrong += fabs(beyond) > 0.015 && inked != (beyond < 0);
            }
        check_at_least("S1", filled, 2000, "pixels of black on a dark ball, spotted %d, %s", spotted,
                       which == 2 ? "coloured" : "grey");
        check_at_most("S1", wrong, 0, "  that are inked wrongly");
        shot_release(&ball);
        shape_release(&s);
    }
}

/* In a deep slot it is black, and beside it not. */
static void clefts_are_black(void)
{
    shot_view view = {
        .width = 256, .height = 256, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 18};
    for (int spotted = 0; spotted < 2; spotted++) {
        shape  s = {0};
        shot   drawing;
        char   look[700];
        double inside = 0, outside = 0;
        shape_box(&s, "left", dvec_of(-1, -1, -1), dvec_of(-0.1, 1, 0));
        shape_box(&s, "right", dvec_of(0.1, -1, -1), dvec_of(1, 1, 0));
        shape_box(&s, "floor", dvec_of(-1, -1, -1.2), dvec_of(1, 1, -1));
        snprintf(look, sizeof look,
                 "{\"version\":2,\"name\":\"t\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{"
                 "\"light_direction\":[0,0.99,0.14],\"fill\":0,\"occlusion\":1,\"occlusion_radius\":1},"
                 "\"rules\":[{\"select\":\"*\",\"surface\":%s}]}",
                 spotted_surface(spotted));
        if (shot_of_shape(&drawing, &s, "slot.glb", look, NULL, &view)) {
            for (int y = 60; y < 196; y++)
                for (int x = 40; x < 216; x++)
                    *(abs(x - 128) < 6    ? &inside
                      : abs(x - 128) > 30 ? &outside
                                          : &(double){0}) += drawing.picture[4 * (y * 256 + x)] < 40;
            check_near("S1", inside / (136 * 11), spotted, 0.05, "share of ink in a slot, spotted %d", spotted);
            check_at_most("S1", outside, 0, "  beside it");
            shot_release(&drawing);
        }
        shape_release(&s);
    }
}

/* --- Watercolour ------------------------------------------------------------------------------------------- */

static bool take_washed(shot *out, bool ball, const char *more, const char *light)
{
    shape s = {0};
    char  surface[300];
    if (ball)
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 96, 192, true);
    else
        shape_quad(&s, "wall", 20, 0);
    for (int k = 0; k < 3; k++)
        s.parts[0].colour[k] = 0.4f;
    snprintf(surface, sizeof surface,
             "{\"technique\":\"watercolour\",\"pale\":0.5,\"deep\":1.5,\"shade\":\"#8090c0\",\"wander\":0,%s}", more);
    bool ok = shot_of_shape(out, &s, "wash.glb", surface_look(surface, light, 0), NULL, &front);
    shape_release(&s);
    return ok;
}

/* Light goes through as much pigment as there is: the colour to the power of it, and the shade's once more. */
static void pigment_takes_light(void)
{
    const double own = picture_srgb(0.4) / 255;
    for (int dark = 0; dark < 2; dark++) {
        shot s;
        if (take_washed(&s, false, "\"flow\":0,\"pooling\":0", dark ? "0,0,-1" : "0,0,1"))
            for (int k = 0; k < 3; k++) {
                static const double shade[3] = {0x80 / 255.0, 0x90 / 255.0, 0xc0 / 255.0};
                double              wanted = dark ? pow(own, 1.5) * shade[k] : pow(own, 0.5);
                check_near("watercolour", s.picture[4 * (128 * 256 + 128) + k] / 255.0, wanted, 0.004,
                           "channel %d of a wall %s", k, dark ? "without light" : "in full light");
            }
        shot_release(&s);
    }
}

/* Pigment of a pixel, where there is but one wash. */
static double pigment_at(const shot *s, int i)
{
    return log(fmax(s->picture[4 * i], 1) / 255.0) / log(picture_srgb(0.4) / 255);
}

/* Where a wash ends there is more of it. */
static void pigment_pools(void)
{
    double sums[3] = {0}, counts[3] = {0};
    shot   s;
    if (take_washed(&s, true, "\"washes\":1,\"flow\":0,\"pooling\":0.8,\"pool\":\"4px\",\"smoothing\":\"8px\"",
                    "0,0,1"))
        for (int y = 0; y < 256; y++)
            for (int x = 0; x < 256; x++) {
                double inside = 128 / (8 * tan(9 * PI / 180)) - hypot(x + 0.5 - 128, y + 0.5 - 128); /* pixels */
                int    at = inside < 1 ? -1 : inside < 3 ? 0 : inside < 6 ? 1 : inside > 20 ? 2 : -1;
                if (at >= 0) {
                    sums[at] += pigment_at(&s, y * 256 + x);
                    counts[at]++;
                }
            }
    shot_release(&s);
    for (int k = 0; k < 3; k++)
        sums[k] /= fmax(counts[k], 1);
    check_near("watercolour", sums[2], 0.5, 0.01, "pigment in the middle of a ball");
    check_at_least("watercolour", sums[0], 1.3 * sums[2], "  at its border");
    check_at_most("watercolour", sums[0], 1.81 * sums[2], "  and no more than it was told to be");
    check_at_least("watercolour", sums[0], 1.05 * sums[1], "  less farther inside");
    check_at_least("watercolour", sums[1], 1.03 * sums[2], "  and still more than in the middle");
}

/* Flow makes it uneven, neither more nor less. */
static void pigment_flows(void)
{
    double sum = 0, squares = 0;
    shot   s;
    if (take_washed(&s, false, "\"washes\":1,\"flow\":0.5,\"flow_size\":\"12px\",\"pooling\":0", "0,0,1"))
        for (int i = 0; i < 256 * 256; i++) {
            double p = pigment_at(&s, i);
            sum += p / (256 * 256);
            squares += p * p / (256 * 256);
        }
    shot_release(&s);
    check_near("watercolour", sum, 0.5, 0.02, "mean pigment where it flows");
    check_at_least("watercolour", sqrt(fmax(squares - sum * sum, 0)), 0.05, "  how much it differs");
}

/* Pigment settles here and there, no more of it and no less; and a paper that has a colour shows it through. */
static void pigment_settles(void)
{
    double sum = 0, squares = 0;
    shot   s;
    if (take_washed(&s, false, "\"washes\":1,\"flow\":0,\"pooling\":0,\"granulation\":0.3", "0,0,1"))
        for (int i = 0; i < 256 * 256; i++) {
            double p = pigment_at(&s, i);
            sum += p / (256 * 256);
            squares += p * p / (256 * 256);
        }
    shot_release(&s);
    check_near("watercolour", sum, 0.5, 0.02, "mean pigment where it settles");
    check_at_least("watercolour", sqrt(fmax(squares - sum * sum, 0)), 0.05, "  how much it differs");
    for (int clear = 0; clear < 2; clear++)
        if (take_washed(&s, false,
                        clear ? "\"flow\":0,\"pooling\":0,\"paper\":\"#00000000\""
                              : "\"flow\":0,\"pooling\":0,\"paper\":\"#808080\"",
                        "0,0,1")) {
            check_near("watercolour", s.picture[4 * (128 * 256 + 128)],
                       (clear ? 255 : 0x80) * sqrt(picture_srgb(0.4) / 255), 1, "%s paper under half of the pigment",
                       clear ? "no" : "grey");
            shot_release(&s);
        }
}

/* --- Gooch ---------------------------------------------------------------------------------------------- */

static void gooch_ramp(void)
{
    static const double cool[3] = {0x52, 0x66, 0xa8}, warm[3] = {0xcc, 0xb8, 0x7a};
    const char         *look =
        surface_look("{\"technique\":\"gooch\",\"cool\":\"#5266a8\",\"warm\":\"#ccb87a\",\"cool_fraction\":0.2,"
                     "\"warm_fraction\":0.35,\"specular\":0}",
                     "0.7,0.6,0.4", 0);
    dvec   light = dvec_unit(dvec_of(0.7, 0.6, 0.4));
    double worst = 0, darkest = 1, hue[21] = {0};
    int    in_bin[21] = {0}, back = 0;
    shot   s;
    if (take_ball(&s, look, NULL))
        for (int i = 0; i < 256 * 256; i++) {
            if (isinf(s.depth[i]))
                continue;
            const uint8_t *p = &s.picture[4 * i];
            double         t = 0.5 * dvec_dot(light, dvec_from(s.normal[i])) + 0.5;
            for (int k = 0; k < 3; k++) {
                double kc = fmin(picture_linear((uint8_t)cool[k]) + 0.2, 1),
                       kw = fmin(picture_linear((uint8_t)warm[k]) + 0.35, 1);
                worst = fmax(worst, fabs(p[k] - picture_srgb(kc * (1 - t) + kw * t)));
            }
            darkest = fmin(darkest, luminance(p));
            hue[(int)(t * 20)] += p[0] - p[2];
            in_bin[(int)(t * 20)]++;
        }
    for (int k = 0, last = -1; k < 21; k++)
        if (in_bin[k]) {
            back += last >= 0 && hue[k] / in_bin[k] <= hue[last] / in_bin[last];
            last = k;
        }
    check_at_most("E10", worst, 1.5, "levels between Gooch's shading and its closed form");
    check_at_most("G2", back, 0, "steps at which the hue goes back towards cool while n.l rises");
    check_at_least("G2", darkest, 0.05, "luminance of the darkest place");
    shot_release(&s);
}

/* Gooch et al. 1998: blue on the one side, yellow on the other, on grey. */
static void gooch_colours_are_apart(void)
{
    dvec light = dvec_unit(dvec_of(1, 0, 0.2));
    int  coolest = 0, warmest = 0;
    shot s;
    if (take_ball(&s, surface_look("{\"technique\":\"gooch\",\"specular\":0}", "1,0,0.2", 0), NULL))
        for (int i = 0; i < 256 * 256; i++) {
            const uint8_t *p = &s.picture[4 * i];
            double         turned = isinf(s.depth[i]) ? 0 : dvec_dot(light, dvec_from(s.normal[i]));
            coolest = turned < -0.7 && p[2] - p[0] > coolest ? p[2] - p[0] : coolest;
            warmest = turned > 0.7 && p[0] - p[2] > warmest ? p[0] - p[2] : warmest;
        }
    check_at_least("E10", coolest, 60, "levels by which blue is above red on the cool side");
    check_at_least("E10", warmest, 30, "levels by which red is above blue on the warm side");
    shot_release(&s);
}

/* Where the light's mirror image stands on a ball: its normal halves the way to the light and the way to the viewer. */
static void highlights_are_where_light_is_mirrored(void)
{
    static const char *const        with[2] = {"{\"technique\":\"toon\",\"light\":0.6,\"highlight\":0.3}",
                                               "{\"technique\":\"gooch\",\"specular\":0.6}"},
                             *const without[2] = {"{\"technique\":\"toon\",\"light\":0.6,\"highlight\":0}",
                                                  "{\"technique\":\"gooch\",\"specular\":0}"};
    static const struct {
        const char *text;
        double      towards[3];
    } lights[] = {{"0.6,0.48,0.64", {0.6, 0.48, 0.64}}, {"-0.6,-0.48,0.64", {-0.6, -0.48, 0.64}}};
    const double radius = 128 / (8 * tan(9 * PI / 180));
    for (int t = 0; t < 2; t++)
        for (int l = 0; l < 2; l++) {
            shot   shiny, dull;
            double sum = 0, at[2] = {0}, half[3], length = 0;
            int    darker = 0;
            bool   ok = take_ball(&shiny, surface_look(with[t], lights[l].text, 0), NULL);
            if (take_ball(&dull, surface_look(without[t], lights[l].text, 0), NULL) && ok)
                for (int i = 0; i < 256 * 256; i++) {
                    double more = shiny.picture[4 * i + 2] - dull.picture[4 * i + 2];
                    darker += more < 0;
                    sum += more;
                    at[0] += more * (i % 256 + 0.5 - 128);
                    at[1] += more * (128 - i / 256 - 0.5);
                }
            for (int k = 0; k < 3; k++) {
                half[k] = lights[l].towards[k] + (k == 2);
                length += half[k] * half[k];
            }
            check_at_least("E12", sum, 1000, "light of the highlight, %s", t ? "gooch" : "toon");
            check_at_most("E12", darker, 0, "  pixels that it makes darker");
            for (int k = 0; k < 2; k++)
                check_near("E12", at[k] / fmax(sum, 1), radius * half[k] / sqrt(length), 4,
                           "  its middle, pixels %s of the ball's", k ? "up" : "to the right");
            shot_release(&shiny);
            shot_release(&dull);
        }
}

static void gooch_lines(void)
{
    const shot_view view = {.width = 300, .height = 240, .eye = {4, 3, 5}, .up = {0, 1, 0}};
    shape           s = {0};
    shot            drawing;
    int             outline = 0, light_outline = 0, inner = 0, dark_inner = 0, extreme = 0, away = 0;
    shape_box(&s, "box", dvec_of(-1, -0.8, -0.8), dvec_of(0.9, 0.7, 0.8));
    if (shot_of_shape(&drawing, &s, "gooch.ply", "gooch", NULL, &view))
        for (int i = 0; i < view.width * view.height; i++) {
            const uint8_t *e = &drawing.edge[4 * i], *p = &drawing.picture[4 * i];
            if (e[0] == 0) {
                outline++;
                light_outline += luminance(p) > 0.05;
            } else if (e[0] == 255 && e[1] == 0 && !isinf(drawing.depth[i])) {
                inner++;
                dark_inner += luminance(p) < 0.7;
            } else if (e[0] == 255 && e[1] == 255 && !isinf(drawing.depth[i])) {
                away++;
                extreme += luminance(p) < 0.01 || luminance(p) > 0.98;
            }
        }
    check_at_least("E10", outline, 200, "pixels of the outline");
    check_at_most("E10", light_outline, 0, "of them not black");
    check_at_least("E10", inner, 100, "pixels of inner lines");
    check_at_most("E10", dark_inner, 0, "of them not white");
    check_at_least("E10", away, 5000, "pixels of shading");
    check_at_most("E10", extreme, 0, "of them pure black or pure white");
    shot_release(&drawing);
    shape_release(&s);
}

/* --- wax ------------------------------------------------------------------------------------------------ */

/* Without depth, wax is Lambert's law in its colour. With it, a channel is dark only where the light is further
 * behind than it goes, and no position is darker than the opaque one. The border is of the glow's hue. */
static void wax_wraps(void)
{
    static const double fraction[3] = {1, 0.5, 0.25}, depth[] = {0, 0.4, 1};
    dvec                light = dvec_unit(dvec_of(0.8, 0.2, 0.4));
    for (int d = 0; d < 3; d++) {
        char   surface[200];
        double worst = 0;
        shot   s;
        /* sRGB of 1, 0.5, 0.25 */
        snprintf(
            surface, sizeof surface,
            "{\"technique\":\"wax\",\"colour\":\"#ffffff\",\"glow\":\"#ffbc89\",\"depth\":%g,\"warmth\":0,\"shine\":0}",
            depth[d]);
        if (take_ball(&s, surface_look(surface, "0.8,0.2,0.4", 0), NULL))
            for (int i = 0; i < 256 * 256; i++)
                for (int k = 0; k < 3 && !isinf(s.depth[i]); k++) {
                    double reach = depth[d] * sqrt(fraction[k]), t = dvec_dot(light, dvec_from(s.normal[i]));
                    double lit = fmax((t + reach) / (1 + reach), 0);
                    worst = fmax(worst, fabs(s.picture[4 * i + k] -
                                             picture_srgb(lit + (1 - lit) * 0.4 * depth[d] * fraction[k])));
                }
        check_at_most("wax", worst, 2, "levels between wax of depth %g and its closed form", depth[d]);
        shot_release(&s);
    }
    shot s;
    int  border = 0, cold = 0;
    if (take_ball(
            &s,
            surface_look("{\"technique\":\"wax\",\"colour\":\"#ffffff\",\"glow\":\"#ff8040\",\"warmth\":1,\"shine\":0}",
                         "0,0,1", 0),
            NULL))
        for (int i = 0; i < 256 * 256; i++)
            if (!isinf(s.depth[i]) && s.normal[i][2] < 0.3f) {
                border++;
                cold += s.picture[4 * i] <= s.picture[4 * i + 2] + 20;
            }
    check_at_least("wax", border, 1000, "pixels near the border of a ball that is lit from the front");
    check_at_most("wax", cold, 0, "of them not warmer than white");
    shot_release(&s);
}

/* --- plain facts ---------------------------------------------------------------------------------------- */

static void light_comes_from_where_it_is_said(void)
{
    static const char *const from[] = {"1,0,0.2", "-1,0.3,0.5", "0,1,0.3", "0.2,-1,0.4", "0,0,1"};
    for (size_t i = 0; i < sizeof from / sizeof *from; i++) {
        shot   s;
        double x, y, z;
        sscanf(from[i], "%lf,%lf,%lf", &x, &y, &z);
        if (take_ball(&s, surface_look("{\"technique\":\"lambert\",\"ambient\":0}", from[i], 0), NULL)) {
            dvec sum = {0, 0, 0};
            int  best = 0;
            for (int k = 0; k < 256 * 256; k++)
                if (!isinf(s.depth[k]) && s.picture[4 * k + 1] > best)
                    best = s.picture[4 * k + 1];
            for (int k = 0; k < 256 * 256; k++)
                if (!isinf(s.depth[k]) && s.picture[4 * k + 1] == best)
                    sum = dvec_add(sum, dvec_from(s.normal[k]));
            double angle = acos(fmin(1, dvec_dot(dvec_unit(sum), dvec_unit(dvec_of(x, y, z))))) * 57.29578;
            check_at_most("light", angle, 5, "degrees between the brightest place and the light %s", from[i]);
        }
        shot_release(&s);
    }
}

/* A texture with four different quarters, seen straight on: nothing is mirrored, nothing changes its colour. */
static void texture_stands_upright(void)
{
    static const uint8_t quarters[4][4] = {{255, 0, 0, 255}, {0, 180, 0, 255}, {0, 0, 200, 255}, {90, 90, 90, 255}};
    const shot_view      view = {.width = 200, .height = 200, .eye = {0, 0, 4.8}, .up = {0, 1, 0}};
    shape                s = {0};
    shot                 drawing;
    int                  wrong = 0;
    shape_quad(&s, "wall", 1, 0);
    s.parts[0].texture_size = 64;
    s.parts[0].texture = check_alloc(64 * 64, 4);
    for (int i = 0; i < 64 * 64; i++)
        memcpy(&s.parts[0].texture[4 * i], quarters[(i / 64 >= 32 ? 2 : 0) + (i % 64 >= 32 ? 1 : 0)], 4);
    if (shot_of_shape(&drawing, &s, "quarters.glb",
                      surface_look("{\"technique\":\"textured\",\"light\":0}", "0,0,1", 0), NULL, &view))
        for (int q = 0; q < 4; q++)
            for (int k = 0; k < 400; k++) {
                const uint8_t *p =
                    &drawing.picture[4 * (((q / 2 ? 130 : 50) + k / 20) * 200 + (q % 2 ? 130 : 50) + k % 20)];
                for (int c = 0; c < 3; c++)
                    wrong += abs(p[c] - quarters[q][c]) > 1;
            }
    check_at_most("texture", wrong, 0, "values that differ from the painted ones");
    shot_release(&drawing);
    shape_release(&s);
}

/* What the file asks no light for has its own colour and nothing else, shaded with its geometry or from the G-buffer.
 */
static void unlit_stays_unlit(void)
{
    const moving_box  box = {.name = "box", .half = {3, 3, 3}, .colour = {0.4, 0.4, 0.4}, .parent = -1};
    shot_view         view = {.width = 128, .height = 128, .eye = {9, 6, 14}, .up = {0, 1, 0}, .fov_deg = 40};
    const char *const forms[] = {"{\"technique\":\"toon\",\"highlight\":0}",
                                 "{\"technique\":\"toon\",\"highlight\":0,\"smoothing\":6}"};
    char              path[512];
    snprintf(path, sizeof path, "%s", check_path("unlit.glb"));
    boxes_write(path, &box, 1);
    for (int f = 0; f < 2; f++) {
        double worst = 0;
        int    pixels = 0;
        shot   drawing;
        if (shot_take(&drawing, path, surface_look(forms[f], "1,0.1,0.3", 0), NULL, &view))
            for (int i = 0; i < 128 * 128; i++)
                if (!isinf(drawing.depth[i])) {
                    worst = fmax(worst, fabs(picture_linear(drawing.picture[4 * i]) - box.colour[0]));
                    pixels++;
                }
        check_at_least("G2", pixels, 1000, "pixels of an unlit box");
        check_at_most("G2", worst, 0.01, "light on it, %s", f ? "shaded later" : "shaded with its geometry");
        shot_release(&drawing);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"tones", tones_are_counted},
        {"washes", washes},
        {"borders", tone_borders},
        {"blur", blur_is_a_box},
        {"flat", flat_faces_stay_flat},
        {"shade", shade_tints_the_dark},
        {"hidden", lines_are_hidden_by_what_lies_close},
        {"join", lines_join_where_it_is_dark},
        {"reflected", shade_has_reflected_light},
        {"textures-flat", textures_become_flat},
        {"blacks", blacks_lie_away_from_the_light},
        {"feathers", feathers_taper},
        {"feathers-cross", feathers_cross_the_border},
        {"walls", walls_are_not_feathered},
        {"dark-things", dark_things_are_blacker},
        {"clefts", clefts_are_black},
        {"pigment", pigment_takes_light},
        {"pools", pigment_pools},
        {"flows", pigment_flows},
        {"settles", pigment_settles},
        {"gooch", gooch_ramp},
        {"highlights", highlights_are_where_light_is_mirrored},
        {"gooch-lines", gooch_lines},
        {"gooch-apart", gooch_colours_are_apart},
        {"faces", tones_leave_the_faces},
        {"triangles", borders_leave_the_triangles},
        {"legible", dark_fill_is_legible},
        {"unlit", unlit_stays_unlit},
        {"wax", wax_wraps},
        {"light", light_comes_from_where_it_is_said},
        {"texture", texture_stands_upright},
    };
    int status = check_main(argc, argv, "surfaces", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
