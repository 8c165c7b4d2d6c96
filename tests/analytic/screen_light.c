/* What decides about strokes of a screen: indication, their own relief, the light at their middle, shadows; and
 * hatching with edges in a mirror. Seed 001, sections 6.4 to 6.6; seed 000, section 4.6. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone_scenes.h"
#include "picture.h"

enum { TONES = 17, TILE = 128, ACROSS = 8, STROKES = ACROSS * ACROSS };

/* --- indication ----------------------------------------------------------------------------------------- */

/* Tiles of 128 px with tones from black to white by the model's own brightness; `indication` NULL: none. */
static bool take_tones(shot *out, const char *screen, const char *indication, const char *more)
{
    halftone_scene s = {0};
    shot_view      view = halftone_view(TONES * TILE, TILE, TILE);
    char           surface[1200];
    for (int i = 0; i < TONES; i++) {
        halftone_part *p = halftone_add_wall(&s, "tone", (halftone_wall){i, 0, 0, 1, 1, 1});
        for (int k = 0; k < 3; k++)
            p->colour[k] = (float)pow(i / 16.0, 2.2);
    }
    int length = snprintf(surface, sizeof surface,
                          "screen\",\"screen\":\"%s\",\"coordinates\":\"uv\",\"scale\":8,\"texture\":1,\"shadow\":1,"
                          "\"light\":1,\"uneven\":0%s",
                          screen, more);
    if (indication)
        snprintf(surface + length, sizeof surface - (size_t)length, ",\"indication\":\"%s\"", indication);
    bool ok = halftone_shot(out, &s, "tones.gltf", halftone_look(surface), NULL, &view);
    halftone_release(&s);
    return ok;
}

static const char *grey_picture(const char *name, int left, int right)
{
    enum { SIDE = 16 };
    uint8_t rgba[SIDE * SIDE * 4];
    for (int i = 0; i < SIDE * SIDE; i++) {
        memset(&rgba[4 * i], i % SIDE < SIDE / 2 ? left : right, 3);
        rgba[4 * i + 3] = 255;
    }
    const char *path = check_path("%s", name);
    return picture_write_rgba(path, rgba, SIDE, SIDE) ? path : NULL;
}

static void indication_shifts_tone(void)
{
    static const char *const screens[] = {"blue-noise", "lines", "cross"};
    shot                     none, neutral, step;
    for (int k = 0; k < 3; k++)
        if (take_tones(&none, screens[k], NULL, "")) {
            if (take_tones(&neutral, screens[k], grey_picture("neutral.png", 128, 128), "")) {
                check_at_most("IM-15", shot_differing(&none, &neutral, 0), 0,
                              "%s: values that a neutral indication changes", screens[k]);
                shot_release(&neutral);
            }
            shot_release(&none);
        }
    if (!take_tones(&none, "blue-noise", NULL, ",\"scheme\":\"binary\""))
        return;
    if (take_tones(&step, "blue-noise", grey_picture("step.png", 64, 192), ",\"scheme\":\"binary\"")) {
        double worst = 0;
        for (int i = 0; i < TONES; i++)
            for (int side = 0; side < 2; side++) {
                double tone = i / 16.0 + (side ? 64 : -64) / 255.0, wanted = fmin(fmax(1 - tone, 0), 1);
                worst = fmax(worst, fabs(halftone_mean(&step, i * TILE + 12 + side * 64, 12, 40, 104) - wanted));
            }
        check_at_most("IM-15", worst, 0.025,
                      "fraction of ink off what an indication of -0.25 on the left and +0.25 on the right asks for");
        shot_release(&step);
    }
    shot_release(&none);
}

static void indication_limits_tone(void)
{
    shot none, limited;
    if (!take_tones(&none, "blue-noise", NULL, ""))
        return;
    if (take_tones(&limited, "blue-noise", grey_picture("limit.png", 153, 153), ",\"indicate\":\"limit\"")) {
        int    dark = 0, changed = 0;
        double worst = 0, ten = halftone_mean(&limited, 10 * TILE + 2, 2, 124, 124);
        for (int i = 0; i < TONES; i++)
            for (int y = 0; y < TILE; y++)
                for (int x = 1; x < TILE - 1; x++) {
                    const size_t at = 4 * (size_t)(y * none.width + i * TILE + x);
                    if (i / 16.0 < 0.6) {
                        dark++;
                        changed += memcmp(&none.picture[at], &limited.picture[at], 4) != 0;
                    }
                }
        for (int i = 10; i < TONES; i++)
            worst = fmax(worst, fabs(halftone_mean(&limited, i * TILE + 2, 2, 124, 124) - ten));
        check_at_least("IM-16", dark, 10 * TILE * (TILE - 2), "pixels darker than the limit");
        check_at_most("IM-16", changed, 0, "of them changed");
        check_near("IM-16", ten, 0.4, 0.03, "ink where it is lighter");
        check_at_most("IM-16", worst, 0.002, "and no difference between light tones");
        shot_release(&limited);
    }
    shot_release(&none);
}

/* --- relief --------------------------------------------------------------------------------------------- */

static bool write_text(const char *name, const char *text)
{
    FILE *file = fopen(check_path("%s", name), "wb");
    return file && fputs(text, file) >= 0 && fclose(file) == 0;
}

/* The joints around one brick, in wide strokes: the left, right, lower and upper flank of the vertical and the
 * horizontal joint. */
static void strokes_have_flanks(void)
{
    static const char *const lights[] = {"1,1,0.5", "-1,-1,0.5", "-1,1,0.5", "1,-1,0.5"};
    static const int         wanted[4][2] = {
                {1, 1},
                {-1, -1},
                {-1, 1},
                {1, -1}}; /* ink on the right, on the upper flank: those that turn away from the light */
    if (!write_text("joints.stx", "0.1 0.5 0.4 0.5 0.6 1 0\n0.7 0.1 0.7 0.9 0.6 1 0\n"))
        return;
    for (int relief = 0; relief < 2; relief++)
        for (int i = 0; i < 4; i++) {
            halftone_scene scene = {0};
            shot           s;
            shot_view      view = halftone_view(160, 160, 160);
            char           surface[1024], light[128];
            halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
            snprintf(light, sizeof light, "\"fill\":0,\"light_direction\":\"%s\"", lights[i]);
            snprintf(surface, sizeof surface,
                     "screen\",\"screen\":\"%s\",\"coordinates\":\"uv\",\"uneven\":0,\"equalised\":false,\"width\":20,"
                     "\"scale\":200,\"relief\":%d,\"shadow\":0,\"light\":1",
                     check_path("joints.stx"), relief ? -2 : 2);
            if (halftone_shot(&s, &scene, "joints.gltf", halftone_look_with(surface, light, ""), NULL, &view)) {
                double sign = relief ? -1 : 1;
                double left = halftone_mean(&s, 112 - 7, 40, 6, 80), right = halftone_mean(&s, 112 + 1, 40, 6, 80);
                double upper = halftone_mean(&s, 24, 80 - 7, 32, 6), lower = halftone_mean(&s, 24, 80 + 1, 32, 6);
                check_note("relief %s, light from %s: ink left %.3f right %.3f upper %.3f lower %.3f",
                           relief ? "-2" : "2", lights[i], left, right, upper, lower);
                check_at_least("IM-17", sign * wanted[i][0] * (right - left), 0.3,
                               "ink of the flank of the upright joint that turns away more than of the other");
                check_at_least("IM-17", sign * wanted[i][1] * (upper - lower), 0.3, "the same for the level joint");
                shot_release(&s);
            }
            halftone_release(&scene);
        }
}

/* Row IM-17: of a painted screen an artist paints the normals, too. Four fields lean right, left, up, down; those that
 * turn away from the light have the ink, and the other way round where the relief is negative. */
static void normals_are_painted(void)
{
    static const double leaning[4][2] = {{0.7, 0}, {-0.7, 0}, {0, 0.7}, {0, -0.7}};
    static uint8_t      grey[128 * 128 * 4], normals[128 * 128 * 4];
    for (int i = 0; i < 128 * 128; i++) {
        int field = i % 128 / 64 + 2 * (i / 128 / 64);
        memset(&grey[4 * i], 128, 3);
        normals[4 * i] = (uint8_t)(127.5 + 127.5 * leaning[field][0] + 0.5);
        normals[4 * i + 1] = (uint8_t)(127.5 + 127.5 * leaning[field][1] + 0.5);
        normals[4 * i + 2] = grey[4 * i + 3] = normals[4 * i + 3] = 255;
    }
    if (!check_that("files",
                    picture_write_rgba(check_path("fields.png"), grey, 128, 128) &&
                        picture_write_rgba(check_path("fields-normals.png"), normals, 128, 128),
                    "pictures written"))
        return;
    static const char *const lights[] = {"1,0,0.7", "-1,0,0.7", "0,1,0.7", "0,-1,0.7"};
    for (int relief = 1; relief >= -1; relief -= 2)
        for (int i = 0; i < 4; i++) {
            halftone_scene scene = {0};
            shot           s;
            shot_view      view = halftone_view(128, 128, 128);
            char           surface[1024], light[128];
            halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
            snprintf(light, sizeof light, "\"fill\":0,\"light_direction\":\"%s\"", lights[i]);
            snprintf(
                surface, sizeof surface,
                "screen\",\"screen\":\"%s\",\"coordinates\":\"uv\",\"scheme\":\"binary\",\"uneven\":0,\"equalised\":"
                "false,\"scale\":8,\"relief\":%d,\"shadow\":0,\"light\":1",
                check_path("fields.png"), relief);
            if (halftone_shot(&s, &scene, "fields.gltf", halftone_look_with(surface, light, ""), NULL, &view)) {
                double ink[4];
                for (int k = 0; k < 4; k++)
                    ink[k] = halftone_mean(&s, 8 + 64 * (k % 2), 8 + 64 * (k / 2), 48, 48);
                int away = relief > 0 ? i ^ 1 : i;
                check_at_least("IM-17", ink[away], 0.9, "relief %d, light from %s: ink where the paint turns away",
                               relief, lights[i]);
                check_at_most("IM-17", ink[away ^ 1], 0.1, "  and towards it");
            }
            shot_release(&s);
            halftone_release(&scene);
        }
}

/* --- whole strokes -------------------------------------------------------------------------------------- */

typedef struct known_stroke {
    double u, v, value; /* its middle; level strokes, a tenth long */
} known_stroke;

static known_stroke known[STROKES];

static double light_at(double x, double y, const double light[3])
{
    double dx = light[0] - x, dy = light[1] - y;
    return light[2] / sqrt(dx * dx + dy * dy + light[2] * light[2]);
}

typedef enum priorities { ANY, LAMP, TUBE } priorities;
static const double lamp[3] = {0.5, 0.45, 0.12};

/* One stroke in each cell of 8 x 8, of different priorities: of all sizes, or such that each is near its limit in
 * the light of the lamp or around the tube. */
static bool write_strokes(const char *name, priorities near)
{
    FILE    *file = fopen(check_path("%s", name), "wb");
    uint32_t state = 7;
    if (!file)
        return false;
    for (int i = 0; i < STROKES; i++) {
        state = state * 1664525u + 1013904223u;
        double any = (state >> 8) / 16777216.0, u = (i % ACROSS + 0.5) / ACROSS, v = (i / ACROSS + 0.5) / ACROSS;
        double light = near == LAMP ? light_at(u, v, lamp) : fmax(sin(6.283185307 * u), 0);
        double priority =
            near == ANY ? 0.15 + 0.7 * any : fmin(fmax(light + (any < 0.5 ? -0.012 : 0.012) * (1 + any), 0.05), 0.95);
        known[i] = (known_stroke){(i % ACROSS + 0.5) / ACROSS, (i / ACROSS + 0.5) / ACROSS, 1 - priority};
        fprintf(file, "%.6f %.6f %.6f %.6f %.6f 1 0\n", known[i].u - 0.05, known[i].v, known[i].u + 0.05, known[i].v,
                priority);
    }
    return fclose(file) == 0;
}

/* Side 512 px, so that texels of the screen are pixels: strokes across are 64 x 0.1. */
static const char *whole_keys_of(const char *scheme, bool whole, double scale, double gain)
{
    static char surface[1400];
    snprintf(surface, sizeof surface,
             "screen\",\"screen\":\"%s\",\"coordinates\":\"uv\",\"scheme\":\"%s\",\"gain\":%g,\"centred\":false,"
             "\"uneven\":0,\"equalised\":false,\"width\":8,\"scale\":%g,\"whole\":%s,"
             "\"shadow\":0,\"light\":1",
             check_path("known.stx"), scheme, gain, scale, whole ? "true" : "false");
    return surface;
}

static const char *whole_keys(const char *scheme, bool whole, double scale)
{
    return whole_keys_of(scheme, whole, scale, 1);
}

/* Inked fraction of the inner part of a stroke on the page; `at` in pixels from the lower left. */
static double fraction_inked(const shot *s, double x, double y, double half, int thick)
{
    int inked = 0, count = 0;
    for (int j = (int)y - thick; j < (int)y + thick; j++)
        for (int i = (int)ceil(x - half); i <= (int)(x + half); i++) {
            inked += s->picture[4 * ((s->height - 1 - j) * s->width + i)] < 128;
            count++;
        }
    return (double)inked / count;
}

static void whole_or_not_at_all(void)
{
    if (!write_strokes("known.stx", LAMP))
        return;
    for (int whole = 0; whole < 2; whole++) {
        halftone_scene scene = {.lights = {{lamp[0], lamp[1], lamp[2]}}, .light_count = 1};
        shot           s;
        shot_view      view = halftone_view(512, 512, 512);
        int            cut = 0, wrong = 0, drawn = 0, clear = 0;
        halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
        if (halftone_shot(&s, &scene, "lamp.gltf",
                          halftone_look_with(whole_keys("binary", whole, 80), "\"lights\":\"file\"", ""), NULL,
                          &view)) {
            for (int i = 0; i < STROKES; i++) {
                double fraction = fraction_inked(&s, known[i].u * 512, known[i].v * 512, 0.03 * 512, 2),
                       dark = 1 - light_at(known[i].u, known[i].v, scene.lights[0]);
                cut += fraction > 0 && fraction < 1;
                drawn += fraction == 1;
                if (fabs(dark - known[i].value) > 0.008 && fraction != 0.5) {
                    clear++;
                    wrong += (fraction > 0.5) != (known[i].value <= dark);
                }
            }
            if (whole) {
                check_at_most("IM-18", cut, 0, "of 64 strokes in a steep light drawn in part (whole=true)");
                check_at_least("IM-18", drawn, 10, "drawn as a whole");
                check_at_most("IM-18", wrong, 0, "of %d with a clear answer not as the light at their middle says",
                              clear);
            } else
                check_at_least("IM-18", cut / 64.0, 0.2,
                               "fraction of 64 strokes in a steep light drawn in part (whole=false)");
            shot_release(&s);
        }
        halftone_release(&scene);
    }
}

/* The ink of a stroke is the darkness at its middle minus its value, times the gain: so the light map can be read off
 * the picture, to parts of a level where the gain is large. */
static void light_map_is_the_light(void)
{
    const double gain = 6;
    double       worst = 0;
    int          count = 0;
    if (!write_strokes("known.stx", ANY))
        return;
    for (int time = 0; time < 2; time++) {
        halftone_scene scene = {.lights = {{0.5 + 0.3 * time, 0.45 - 0.2 * time, 0.3}}, .light_count = 1};
        shot           s;
        shot_view      view = halftone_view(512, 512, 512);
        halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
        if (halftone_shot(&s, &scene, "lamp.gltf",
                          halftone_look_with(whole_keys_of("smooth", true, 80, gain), "\"lights\":\"file\"", ""), NULL,
                          &view)) {
            for (int i = 0; i < STROKES; i++) {
                double dark = 1 - light_at(known[i].u, known[i].v, scene.lights[0]),
                       value = floor(known[i].value * 255 + 0.5) / 255;
                for (int dx = -15; dx <= 15; dx += 3) {
                    double ink = halftone_ink(&s, (int)(known[i].u * 512) + dx, 511 - (int)(known[i].v * 512));
                    if (ink < 0.03 || ink > 0.97 || dark < 0.03)
                        continue;
                    worst = fmax(worst, fabs(ink / gain - (dark - value)));
                    count++;
                }
            }
            shot_release(&s);
        }
        halftone_release(&scene);
    }
    check_at_least("IM-19", count, 200, "places of strokes whose light was read off, for two places of the lamp");
    check_at_most("IM-19", worst * 255, 1, "levels between the light that they had and the light at their middle");
}

/* A wall whose light lies in the middle of its map, as one island of many. */
static void place_island(double s, double t, const void *user, halftone_corner *out)
{
    (void)user;
    *out = (halftone_corner){.at = {(float)s, (float)t, 0},
                             .normal = {0, 0, 1},
                             .uv = {(float)s, (float)t},
                             .unique = {(float)(0.3 + 0.4 * s), (float)(0.3 + 0.4 * t)}};
}

/* Strokes whose middles lie on an island's border, or a little beyond: their light is that of the border, without
 * anything of the emptiness beside it. */
static void islands_have_margins(void)
{
    enum { LINES = 16 };
    const double   gain = 6;
    double         worst = 0, values[LINES];
    int            count = 0;
    halftone_scene scene = {.lights = {{0.5, 0.45, 0.4}}, .light_count = 1};
    shot           s;
    shot_view      view = halftone_view(256, 256, 256);
    FILE          *file = fopen(check_path("known.stx"), "wb");
    if (!check_that("IM-19", file != NULL, "strokes"))
        return;
    for (int i = 0; i < LINES; i++) { /* one in two is a little darker than its light would have it */
        double v = (i + 0.5) / LINES, dark = 1 - light_at(0, v, scene.lights[0]);
        values[i] = floor((dark - 0.05 - 0.05 * (i % 2)) * 255 + 0.5) / 255;
        fprintf(file, "-0.05 %.6f 0.05 %.6f %.6f 1 0\n", v, v, 1 - values[i]);
    }
    fclose(file);
    halftone_add(&scene, "wall", 1, 1, place_island, NULL)->second = true;
    if (halftone_shot(&s, &scene, "island.gltf",
                      halftone_look_with(whole_keys_of("smooth", true, 161, gain), "\"lights\":\"file\"", ""), NULL,
                      &view)) {
        for (int i = 0; i < LINES; i++)
            for (int x = 1; x < 9; x++)
                for (int right = 0; right < 2; right++) {
                    double v = (i + 0.5) / LINES, dark = 1 - light_at(right, v, scene.lights[0]);
                    double ink = halftone_ink(&s, right ? 255 - x : x, 255 - (int)(v * 256));
                    worst = fmax(worst, fabs(ink / gain - (dark - values[i])));
                    count++;
                }
        check_at_most("IM-19", worst * 255, 2,
                      "levels between the light of %d places and that at the border of their island", count);
        shot_release(&s);
    }
    halftone_release(&scene);
}

static void add_tile(halftone_scene *s, int x, int y)
{
    halftone_add_wall(s, "tile", (halftone_wall){x / 3.0, y / 3.0, 0, 1 / 3.0, 1 / 3.0, 3});
}

/* A third of the picture each: the same strokes nine times, each lit where it is. */
static void tiles_are_lit_apart(void)
{
    halftone_scene whole = {.lights = {{0.5, 0.45, 0.15}}, .light_count = 1},
                   split = {.lights = {{0.5, 0.45, 0.15}}, .light_count = 1};
    shot      a, b;
    shot_view view = halftone_view(768, 768, 768);
    int       cut = 0, wrong = 0, clear = 0, differ = 0, distinct = 0;
    if (!write_strokes("known.stx", ANY))
        return;
    halftone_add_wall(&whole, "wall", (halftone_wall){0, 0, 0, 1, 1, 3})->second = true;
    for (int i = 0; i < 9; i++)
        add_tile(&split, i % 3, i / 3);
    for (size_t i = 0; i < split.count; i++)
        split.parts[i].second = true;
    const char *keys = whole_keys("binary", true, 40);
    if (halftone_shot(&a, &whole, "tiled.gltf", halftone_look_with(keys, "\"lights\":\"file\"", ""), NULL, &view) &&
        halftone_shot(&b, &split, "split.gltf", halftone_look_with(keys, "\"lights\":\"file\"", ""), NULL, &view)) {
        for (int i = 0; i < STROKES; i++) {
            int drawn = 0;
            for (int tile = 0; tile < 9; tile++) {
                double u = (tile % 3 + known[i].u) / 3, v = (tile / 3 + known[i].v) / 3,
                       dark = 1 - light_at(u, v, whole.lights[0]);
                double fraction = fraction_inked(&a, u * 768, v * 768, 0.025 * 256, 1);
                cut += fraction > 0 && fraction < 1;
                drawn += fraction > 0.5;
                if (fabs(dark - known[i].value) > 0.02) {
                    clear++;
                    wrong += (fraction > 0.5) != (known[i].value <= dark);
                }
            }
            distinct += drawn > 0 && drawn < 9;
        }
        for (int y = 0; y < 768; y++)
            for (int x = 0; x < 768; x++) {
                bool seam = x % 256 < 3 || x % 256 > 252 || y % 256 < 3 || y % 256 > 252;
                differ += !seam && abs(a.picture[4 * (y * 768 + x)] - b.picture[4 * (y * 768 + x)]) > 64;
            }
        check_at_most("IM-20", cut, 0, "of 576 strokes on nine tiles drawn in part");
        check_at_most("IM-20", wrong, 0, "of %d with a clear answer not as the light at their own place says", clear);
        check_at_least("IM-20", distinct, 20, "of 64 strokes that are on some tiles and not on others");
        check_at_most("IM-20", differ / (768.0 * 768), 0.001,
                      "fraction of pixels that differ from nine parts with light maps of their own");
        shot_release(&b);
    }
    shot_release(&a);
    halftone_release(&whole);
    halftone_release(&split);
}

/* On a cylinder, whose light falls off around it: strokes are cut or whole as well. */
static void whole_on_a_cylinder(void)
{
    double lone[2] = {0};
    if (!write_strokes("known.stx", TUBE))
        return;
    for (int whole = 0; whole < 2; whole++) {
        halftone_scene scene = {0};
        shot           s;
        shot_view      view = {.width = 400,
                               .height = 400,
                               .eye = {0, 0.5, 8},
                               .target = {0, 0.5, 0},
                               .up = {0, 1, 0},
                               .orthographic = true,
                               .fov_deg = 8,
                               .without_maps = true};
        halftone_add_tube(&scene, "tube", (halftone_tube){0.5, 1, 1, 1})->second = true;
        int cut = 0, seen = 0;
        if (halftone_shot(
                &s, &scene, "tube.gltf",
                halftone_look_with(whole_keys("binary", whole, 110), "\"fill\":0,\"light_direction\":\"1,0,0\"", ""),
                NULL, &view)) {
            for (int i = 0; i < STROKES; i++) {
                int    inked = 0, count = 0;
                double angle = 6.283185307 * known[i].u;
                if (cos(angle) < 0.5)
                    continue;
                for (int k = -8; k <= 8; k++) {
                    double around = 6.283185307 * (known[i].u + 0.035 * k / 8);
                    dvec   at = shot_project(&s, dvec_of(0.5 * sin(around), known[i].v, 0.5 * cos(around)));
                    inked += s.picture[4 * ((int)at.y * 400 + (int)at.x)] < 128;
                    count++;
                }
                seen++;
                cut += inked > 0 && inked < count;
            }
            lone[whole] = seen ? (double)cut / seen : 1;
            shot_release(&s);
        }
        halftone_release(&scene);
    }
    check_at_least("IM-18", lone[0], 0.1, "fraction of strokes on a cylinder drawn in part (whole=false)");
    check_at_most("IM-18", lone[1], 0, "fraction of them drawn in part (whole=true)");
}

/* --- shadows -------------------------------------------------------------------------------------------- */

static void shadows_of(const char *shading)
{
    shot           lit, shadowed;
    halftone_scene scene = {0};
    halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 4, 4, 1});
    halftone_add_wall(&scene, "lid", (halftone_wall){1, 1, 1, 1, 1, 1});
    shot_view view = halftone_view(256, 256, 64);
    char      later[100];
    snprintf(later, sizeof later, ",\"layers\":{\"technique\":\"front\",\"shading\":\"%s\"}", shading);
    const char *keys = "screen\",\"screen\":\"cross\",\"scheme\":\"binary\",\"uneven\":0,\"shadow\":0.1,\"light\":0.95";
    if (!halftone_shot(&lit, &scene, "lid.gltf",
                       halftone_look_with(keys, "\"fill\":0,\"light_direction\":\"-1,0,1\"", later), NULL, &view)) {
        halftone_release(&scene);
        return;
    }
    if (halftone_shot(&shadowed, &scene, "lid.gltf",
                      halftone_look_with(keys, "\"fill\":0,\"shadows\":true,\"light_direction\":\"-1,0,1\"", later),
                      NULL, &view)) {
        int other = 0, lost = 0;
        for (int i = 0; i < 256 * 256; i++) {
            other += shadowed.picture[4 * i] != 0 && shadowed.picture[4 * i] != 255;
            lost += lit.picture[4 * i] == 0 && shadowed.picture[4 * i] == 255;
        }
        /* The shadow falls to the right by as much as the lid is high. */
        double before = halftone_mean(&lit, 132, 132, 56, 56), after = halftone_mean(&shadowed, 132, 132, 56, 56);
        check_at_least("IM-34", after - before, 0.2, "%s: more ink in the shadow (%.3f without)", shading, before);
        check_at_most("IM-34", other, 0, "pixels that are neither ink nor paper");
        check_at_most("IM-34", lost, 0, "inked pixels that shadows make paper");
        check_near("IM-34", halftone_mean(&shadowed, 4, 4, 56, 248), halftone_mean(&lit, 4, 4, 56, 248), 0.002,
                   "ink elsewhere stays");
        shot_release(&shadowed);
    }
    shot_release(&lit);
    halftone_release(&scene);
}

static void shadows_are_denser_strokes(void)
{
    shadows_of("deferred");
    shadows_of("forward");
}

/* --- hatching with edges, in a mirror too --------------------------------------------------------------- */

typedef struct sheet {
    double at[3], right[3], up[3], normal[3];
} sheet;

static void place_sheet(double s, double t, const void *user, halftone_corner *out)
{
    const sheet *p = user;
    *out = (halftone_corner){.uv = {(float)s, (float)t}, .unique = {(float)s, (float)t}};
    for (int k = 0; k < 3; k++) {
        out->at[k] = (float)(p->at[k] + s * p->right[k] + t * p->up[k]);
        out->normal[k] = (float)p->normal[k];
    }
}

/* A lamp throws no shadows: that is said. */
static void lamps_have_no_shadows(void)
{
    for (int wanted = 0; wanted < 2; wanted++) {
        shot            s;
        halftone_scene  scene = {.lights = {{0.5, 0.5, 0.4}}, .light_count = 1};
        const shot_view view = halftone_view(64, 64, 64);
        halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
        if (halftone_shot(&s, &scene, "lamp.gltf",
                          halftone_look_with(
                              "hatch\"", wanted ? "\"lights\":\"file\",\"shadows\":true" : "\"lights\":\"file\"", ""),
                          NULL, &view))
            check_near("P30", shot_has_warning(&s, "unused"), wanted, 0, "a warning about shadows of a lamp, %s",
                       wanted ? "asked for" : "not asked for");
        shot_release(&s);
        halftone_release(&scene);
    }
}

static void mirrored_hatching_has_edges(void)
{
    static const char *const forms[] = {"hatch", "screen"};
    for (int f = 0; f < 2; f++) {
        halftone_scene scene = {0};
        const sheet    upright = {{-1, -0.4, 0}, {2, 0, 0}, {0, 1.8, 0}, {0, 0, 1}};
        halftone_add(&scene, "glass", 1, 1, place_sheet, &(sheet){{-3, -1, 3}, {6, 0, 0}, {0, 0, -6}, {0, 1, 0}});
        halftone_add(&scene, "sheet", 1, 1, place_sheet, &upright);
        char look[1400];
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{\"fill\":0,\"light_"
                 "direction\":\"0,1,1\"},\"rules\":[{\"select\":\"glass\",\"surface\":"
                 "{\"technique\":\"mirror\",\"tint\":\"#ffffff\",\"reflectivity\":1}},{\"select\":\"sheet\","
                 "\"surface\":{\"technique\":\"%s\",\"ink\":\"#0000ff\",\"paper\":\"#ffffff\","
                 "\"shadow\":0.3,\"light\":0.7},\"lines\":{\"operator\":\"discontinuity\",\"width\":2,\"colour\":\"#"
                 "ff0000\"}}]}",
                 forms[f]);
        const shot_view view = {.width = 240,
                                .height = 240,
                                .eye = {0, 2, 9},
                                .target = {0, -0.3, 0},
                                .up = {0, 1, 0},
                                .fov_deg = 26,
                                .without_maps = true};
        shot            s;
        int             edge[2] = {0}, ink[2] = {0};
        if (halftone_shot(&s, &scene, "mirror.gltf", look, NULL, &view)) {
            for (int k = 0; k < 2; k++) {
                /* The sheet itself from y = -0.4 to 1.4, its image from -1.6 to -3.4. */
                dvec low = shot_project(&s, dvec_of(0, k ? -3.4 : -0.4, 0)),
                     high = shot_project(&s, dvec_of(0, k ? -1.6 : 1.4, 0));
                dvec left = shot_project(&s, dvec_of(-1, k ? -2 : 0, 0)),
                     right = shot_project(&s, dvec_of(1, k ? -2 : 0, 0));
                for (int y = (int)high.y - 3; y < (int)low.y + 3 && y < 240; y++)
                    for (int x = (int)left.x - 4; x < (int)right.x + 4; x++) {
                        const uint8_t *p = &s.picture[4 * (y * 240 + x)];
                        edge[k] += p[0] > 150 && p[2] < 100;
                        ink[k] += p[2] > 150 && p[0] < 100;
                    }
            }
            shot_release(&s);
        }
        for (int k = 0; k < 2; k++) {
            check_at_least("E13", edge[k], 100, "%s: pixels of edges %s", forms[f],
                           k ? "in the mirror" : "on the part itself");
            check_at_least("E13", ink[k], 200, "%s: pixels of strokes %s", forms[f],
                           k ? "in the mirror" : "on the part itself");
        }
        halftone_release(&scene);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"lamps", lamps_have_no_shadows},        {"indication", indication_shifts_tone},
        {"limit", indication_limits_tone},       {"relief", strokes_have_flanks},
        {"normals", normals_are_painted},        {"whole", whole_or_not_at_all},
        {"light-map", light_map_is_the_light},   {"islands", islands_have_margins},
        {"tiles", tiles_are_lit_apart},          {"cylinder", whole_on_a_cylinder},
        {"shadows", shadows_are_denser_strokes}, {"mirror", mirrored_hatching_has_edges},
    };
    halftone_begin();
    int status = check_main(argc, argv, "screen_light", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
