/* Which strokes of a texture are drawn: their two priorities against light and distance, each stroke known by its
 * place, on the GPU, on the CPU and as a screen; that strokes are drawn whole; what of marks is cut off, and by what.
 * Freudenberg 2003, sections 5.1, 5.3 and 5.4; rows EX-01, EX-03, EX-04, EX-06, EX-12, EX-14, EX-26, EX-28. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone_scenes.h"
#include "picture.h"
#include "shape.h"

enum { SIDE = 288, CELLS = 12, STROKES = CELLS * CELLS };

static const double pi = 3.14159265358979323846;

/* A stroke in the middle of each cell of the texture, half as long as the cell, along u. */
typedef struct priorities {
    double light[STROKES], perspective[STROKES];
} priorities;

static void middle_of(int i, double out[2])
{
    out[0] = (i % CELLS + 0.5) / CELLS;
    out[1] = (floor(i / (double)CELLS) + 0.5) / CELLS;
}

/* Every value between 0 and 1 once, in an order that has nothing to do with places. */
static double mixed(int i, int step)
{
    return ((i * step + 7) % STROKES + 0.5) / STROKES;
}

static bool write_strokes(const char *name, const priorities *p)
{
    FILE *file = fopen(check_path("%s", name), "wb");
    if (!file)
        return false;
    for (int i = 0; i < STROKES; i++) {
        double at[2];
        middle_of(i, at);
        fprintf(file, "%.9g %.9g %.9g %.9g %.9g %.9g 0\n", at[0] - 0.25 / CELLS, at[1], at[0] + 0.25 / CELLS, at[1],
                p->light[i], p->perspective[i]);
    }
    return fclose(file) == 0;
}

/* The strokes laid out once on a wall, each as far as its priorities say and no other: `more` are further keys. */
static const char *tiled_of(const char *path, double tone, const char *more)
{
    static char texts[4][1000];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(text, sizeof texts[0],
             "strokes\",\"placed\":\"uv\",\"strokes\":\"%s\",\"repeat\":1,\"jitter\":0,\"equalised\":false,"
             "\"fade\":0.001,\"taper\":0,\"width\":3,\"texture\":0,\"shadow\":%.9g,\"light\":%.9g%s%s",
             path, tone, tone, *more ? "," : "", more);
    return text;
}

static const char *tiled(const char *file, double tone, const char *more)
{
    return tiled_of(check_path("%s", file), tone, more);
}

static bool draw_wall(shot *out, const char *surface, const char *finish, const shot_view *view)
{
    halftone_scene s = {0};
    halftone_add_wall(&s, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
    bool ok = halftone_shot(out, &s, "marks-wall.gltf", halftone_look_with(surface, "", finish), NULL, view);
    halftone_release(&s);
    return ok;
}

/* Most ink in the pixels around a point of the scene. */
static double ink_at(const shot *s, dvec point)
{
    double at[2], most = 0;
    shot_on_page(s, point, at);
    for (int k = 0; k < 9; k++) {
        int x = (int)floor(at[0]) + k % 3 - 1, y = (int)floor(at[1]) + k / 3 - 1;
        if (x >= 0 && y >= 0 && x < s->width && y < s->height)
            most = fmax(most, halftone_ink(s, x, y));
    }
    return most;
}

static dvec on_wall(int i)
{
    double at[2];
    middle_of(i, at);
    return (dvec){at[0], at[1], 0};
}

/* How many strokes are there that should not be, or are not there that should; those within `near` of the limit are
 * not judged. margin[i]: by how much stroke i stays within what it needs. */
static int count_wrong(const shot *s, const double *margin, double near, bool white, int *there)
{
    int wrong = 0;
    *there = 0;
    for (int i = 0; i < STROKES; i++) {
        double ink = ink_at(s, on_wall(i));
        bool   drawn = (white ? 1 - ink : ink) > 0.5;
        *there += drawn;
        wrong += fabs(margin[i]) > near && drawn != (margin[i] > 0);
    }
    return wrong;
}

/* --- light (EX-06) -------------------------------------------------------------------------------------- */

static void take_all_distances(priorities *p)
{
    for (int i = 0; i < STROKES; i++) {
        p->light[i] = mixed(i, 55);
        p->perspective[i] = 1;
    }
}

/* A stroke is drawn where its light priority is not below the tone: as marks and as a screen the same ones. */
static void light(void)
{
    static priorities p;
    take_all_distances(&p);
    if (!check_that("EX-06", write_strokes("light.stx", &p), "strokes"))
        return;
    shot_view view = halftone_view(SIDE, SIDE, SIDE);
    for (int k = 1; k < 8; k++) {
        double tone = k / 8.0, margin[STROKES];
        for (int i = 0; i < STROKES; i++)
            margin[i] = p.light[i] - tone;
        for (int screen = 0; screen < 2; screen++) {
            char surface[1000];
            snprintf(surface, sizeof surface,
                     "screen\",\"screen\":\"%s\",\"coordinates\":\"uv\",\"uneven\":0,\"equalised\":false,\"width\":3,"
                     "\"scheme\":\"binary\",\"scale\":48.02,\"texture\":0,\"shadow\":%.9g,\"light\":%.9g",
                     check_path("light.stx"), tone, tone);
            shot s;
            int  there;
            if (!draw_wall(&s, screen ? surface : tiled("light.stx", tone, ""), "", &view))
                return;
            int wrong = count_wrong(&s, margin, 0.003, false, &there);
            check_that("EX-06", wrong == 0, "%s, tone %.3f: %d of %d strokes are there, %d wrongly or not",
                       screen ? "as a screen" : "on the wall", tone, there, STROKES, wrong);
            shot_release(&s);
        }
    }
}

/* How many shapes the marks of an SVG file are; -1: it has none. */
static int shapes_of_marks(const char *path)
{
    char   text[65536];
    FILE  *file = fopen(path, "rb");
    size_t length = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file)
        fclose(file);
    text[length] = 0;
    char *marks = strstr(text, "class=\"marks"), *end = marks ? strstr(marks, "</g>") : NULL;
    int   count = 0;
    for (char *at = marks; at && at < end; at++)
        count += *at == 'z';
    return end ? count : -1;
}

/* Row EX-07: files of vectors have the same strokes; none of the wall is hidden, so it is enough to count them. */
static void vectors(void)
{
    static priorities p;
    take_all_distances(&p);
    halftone_scene scene = {0};
    halftone_add_wall(&scene, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
    if (!check_that("EX-07", write_strokes("light.stx", &p) && halftone_write(check_path("vectors.gltf"), &scene),
                    "strokes and a wall"))
        return;
    halftone_release(&scene);
    for (int k = 1; k < 8; k += 2) {
        double tone = k / 8.0;
        char   arguments[1024], said[1024], svg[256];
        int    wanted = 0;
        for (int i = 0; i < STROKES; i++)
            wanted += p.light[i] >= tone;
        FILE *look = fopen(check_path("vectors.json"), "wb"); /* names files from where it lies */
        bool  written = look && fputs(halftone_look(tiled_of("light.stx", tone, "")), look) >= 0;
        written = look && fclose(look) == 0 && written;
        snprintf(svg, sizeof svg, "%s", check_path("vectors.svg"));
        snprintf(arguments, sizeof arguments, "draw %s --look %s --size 600x600 --view %s -o %s",
                 check_path("vectors.gltf"), check_path("vectors.json"), k % 4 == 1 ? "front" : "iso", svg);
        if (check_that("EX-07", written && halftone_command(LIMNER_COMMAND, arguments, said, sizeof said) == 0,
                       "a file of vectors: %s", said))
            check_near("EX-07", shapes_of_marks(svg), wanted, 0, "strokes of a file of vectors, tone %.3f", tone);
    }
}

/* White ones stand for light: they are there where it is lighter than their priority has it. */
static void white(void)
{
    static priorities p;
    take_all_distances(&p);
    if (!check_that("EX-06", write_strokes("white.stx", &p), "strokes"))
        return;
    shot_view view = halftone_view(SIDE, SIDE, SIDE);
    for (int k = 1; k < 8; k += 2) {
        double tone = k / 8.0, margin[STROKES];
        for (int i = 0; i < STROKES; i++)
            margin[i] = p.light[i] - (1 - tone);
        shot s;
        int  there;
        if (!draw_wall(&s, tiled("white.stx", tone, "\"ink\":\"#ffffff\",\"paper\":\"#000000\""), "", &view))
            return;
        int wrong = count_wrong(&s, margin, 0.003, true, &there);
        check_that("EX-06", wrong == 0, "white strokes, tone %.3f: %d of %d are there, %d wrongly or not", tone, there,
                   STROKES, wrong);
        shot_release(&s);
        char dots[300];
        snprintf(dots, sizeof dots,
                 "stipple\",\"count\":30000,\"diameter\":2.5,\"texture\":0,\"shadow\":%.9g,\"light\":%.9g,"
                 "\"ink\":\"#ffffff\",\"paper\":\"#000000\"",
                 tone, tone);
        if (!draw_wall(&s, dots, "", &view))
            return;
        check_near("EX-06", 1 - halftone_mean(&s, 40, 40, SIDE - 80, SIDE - 80), tone, 0.03, "white dots, tone %.3f",
                   tone);
        shot_release(&s);
    }
}

/* Indication: more where a picture is dark, fewer where it is light, by as much as it is from grey. The same map asks
 * the same of a screen. */
static void indication(void)
{
    enum { MAP = CELLS };
    static priorities p;
    uint8_t           map[4 * MAP * MAP];
    take_all_distances(&p);
    for (int i = 0; i < MAP * MAP; i++) {
        for (int k = 0; k < 4; k++)
            map[4 * i + k] =
                k == 3 ? 255 : (uint8_t)(255 * (0.15 + 0.6 * (i % MAP) / MAP + 0.15 * floor(i / (double)MAP) / MAP));
    }
    if (!check_that("EX-28",
                    write_strokes("indicated.stx", &p) && picture_write_rgba(check_path("map.png"), map, MAP, MAP),
                    "strokes and a map"))
        return;
    shot_view view = halftone_view(SIDE, SIDE, SIDE);
    for (int k = 0; k < 4; k++) {
        double tone = k % 2 ? 0.35 : 0.6, strength = k / 2 ? 0.5 : 1, margin[STROKES];
        for (int i = 0; i < STROKES; i++) /* rows of the map begin at the top, those of the strokes below */
            margin[i] = p.light[i] - tone - strength * (map[4 * ((MAP - 1 - i / MAP) * MAP + i % MAP)] / 255.0 - 0.5);
        char keys[400];
        snprintf(keys, sizeof keys, "\"indication\":\"%s\",\"indication_strength\":%g", check_path("map.png"),
                 strength);
        shot s;
        int  there;
        if (!draw_wall(&s, tiled("indicated.stx", tone, keys), "", &view))
            return;
        int wrong = count_wrong(&s, margin, 0.004, false, &there);
        check_that("EX-28", wrong == 0, "tone %g, strength %g: %d of %d strokes are there, %d wrongly or not", tone,
                   strength, there, STROKES, wrong);
        shot_release(&s);
    }
}

/* --- distance and tilt (EX-01, EX-03, EX-04) ------------------------------------------------------------ */

/* Pixels that a small step along a direction makes on the page, to a unit of it. */
static dvec on_page_per_unit(const shot *s, dvec at, dvec direction)
{
    const double step = 1e-4;
    double       a[2], b[2];
    shot_on_page(s, dvec_sub(at, dvec_scale(direction, step)), a);
    shot_on_page(s, dvec_add(at, dvec_scale(direction, step)), b);
    return (dvec){(b[0] - a[0]) / (2 * step), (b[1] - a[1]) / (2 * step), 0};
}

/* Fraction of all strokes that should be there for where they are. By `line`, what is drawn has the same length to an
 * area of the page everywhere, 1 / scale; by the thesis, t = 1 - d |N.P| / |P|^2. */
static double fraction_there(const shot *s, dvec at, double scale, bool line)
{
    double density = STROKES * 0.5 / CELLS; /* length to a unit of area, all of them */
    dvec   x = on_page_per_unit(s, at, (dvec){1, 0, 0}), y = on_page_per_unit(s, at, (dvec){0, 1, 0});
    if (line)
        return fabs(x.x * y.y - x.y * y.x) / hypot(x.x, x.y) / density / scale;
    dvec   eye = shot_to_eye(s, at, 1), normal = shot_to_eye(s, (dvec){0, 0, 1}, 0);
    double focal = s->projection[5] * s->height / 2;
    return focal / (density * scale) * fabs(dvec_dot(eye, normal)) / dvec_dot(eye, eye);
}

static void distance(void)
{
    static priorities p;
    for (int i = 0; i < STROKES; i++) {
        p.light[i] = mixed(i, 55);
        p.perspective[i] = mixed(i, 89);
    }
    if (!check_that("EX-03", write_strokes("distance.stx", &p), "strokes"))
        return;
    static const double places[][4] = {/* tilt about y and x, distance, tone */
                                       {0, 0, 2.1, 0},  {0, 0, 3.2, 0},  {0, 0, 2, 0.5},
                                       {50, 0, 2, 0},   {50, 0, 2, 0.4}, {0, 50, 2, 0},
                                       {70, 0, 1.6, 0}, {0, 70, 1.6, 0}, {30, 40, 2.4, 0.3}};
    for (int line = 0; line < 2; line++)
        for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
            double    a = places[k][0] * pi / 180, b = places[k][1] * pi / 180, tone = places[k][3];
            shot_view view = {.width = SIDE, .height = SIDE, .target = {0.5, 0.5, 0}, .up = {0, 1, 0}, .fov_deg = 36};
            view.without_maps = true;
            view.eye = (dvec){0.5 + places[k][2] * sin(a) * cos(b), 0.5 + places[k][2] * sin(b),
                              places[k][2] * cos(a) * cos(b)};
            shot   s;
            double scale = 40, margin[STROKES], least = 1, most = 0;
            char   keys[100];
            snprintf(keys, sizeof keys, "\"scale\":%g,\"law\":\"%s\"", scale, line ? "line" : "thesis");
            if (!draw_wall(&s, tiled("distance.stx", tone, keys), "", &view))
                return;
            for (int i = 0; i < STROKES; i++) {
                double fraction = fraction_there(&s, on_wall(i), scale, line);
                margin[i] = fmin(p.perspective[i] - (1 - fraction), tone > 0 ? p.light[i] - tone : 1);
                double at[2];
                shot_on_page(&s, on_wall(i), at);
                if (at[0] < 0 || at[1] < 0 || at[0] > SIDE || at[1] > SIDE)
                    margin[i] = 0; /* not to be seen either way */
                least = fmin(least, fraction);
                most = fmax(most, fraction);
            }
            int there, wrong = count_wrong(&s, margin, 0.003, false, &there);
            check_that("EX-03", wrong == 0 && least < 0.95,
                       "law %s, turned by %g and %g degrees, %g away, tone %g: %.3f to %.3f of all, %d are there, %d "
                       "wrongly or not",
                       line ? "line" : "thesis", places[k][0], places[k][1], places[k][2], tone, least, most, there,
                       wrong);
            shot_release(&s);
        }
}

/* From far away only the first dots of the set are looked at: as many as the darkest place of the figure needs. */
static void darkest(void)
{
    static const double diameters[] = {1.5, 3, 6};
    shot_view           view = halftone_view(SIDE, SIDE, SIDE);
    for (int k = 0; k < 3; k++) {
        char surface[200];
        shot s;
        snprintf(surface, sizeof surface,
                 "stipple\",\"count\":400000,\"diameter\":%g,\"texture\":0,\"shadow\":0,\"light\":0", diameters[k]);
        if (!draw_wall(&s, surface, "", &view))
            return;
        check_near("EX-30", halftone_mean(&s, 40, 40, SIDE - 80, SIDE - 80), 0.98, 0.02,
                   "ink of dots of %g px where it is darkest", diameters[k]);
        shot_release(&s);
    }
}

/* A flat wall cuts nothing off the strokes that lie on it, however it is turned. */
static void uncut(void)
{
    static priorities p;
    for (int i = 0; i < STROKES; i++)
        p.light[i] = p.perspective[i] = 1;
    if (!check_that("EX-14", write_strokes("uncut.stx", &p), "strokes"))
        return;
    for (int tilt = 0; tilt <= 80; tilt += 20)
        for (int up = 0; up < 2; up++) {
            double    a = tilt * pi / 180;
            shot_view view = {.width = SIDE, .height = SIDE, .target = {0.5, 0.5, 0}, .up = {0, 1, 0}, .fov_deg = 30};
            shot      s;
            view.without_maps = true;
            view.eye = (dvec){0.5 + (up ? 0 : 2.6 * sin(a)), 0.5 + (up ? 2.6 * sin(a) : 0), 2.6 * cos(a)};
            if (!draw_wall(&s, tiled("uncut.stx", 0, ""), "", &view))
                return;
            int cut = 0, asked = 0;
            for (int i = 0; i < STROKES; i++)
                for (double along = -0.22; along <= 0.22; along += 0.02, asked++) {
                    dvec at = on_wall(i);
                    at.x += along / CELLS;
                    cut += ink_at(&s, at) < 0.9;
                }
            check_that("EX-14", cut == 0, "turned by %d degrees: %d of %d places of strokes are cut by their own wall",
                       tilt, cut, asked);
            shot_release(&s);
        }
}

/* --- strokes are drawn whole (EX-12, EX-26) --------------------------------------------------------------- */

enum { ROWS = 24 };

/* A flat wall whose normals turn away to the right, so that it is lit like a tube: cos of 80 degrees times u. */
static void place_bent(double s, double t, const void *user, halftone_corner *out)
{
    (void)user;
    double a = 80 * pi / 180 * s;
    *out = (halftone_corner){.at = {(float)s, (float)t, 0},
                             .normal = {(float)sin(a), 0, (float)cos(a)},
                             .uv = {(float)s, (float)t},
                             .unique = {(float)s, (float)t}};
}

static void place_even(double s, double t, const void *user, halftone_corner *out)
{
    place_bent(0, t, user, out);
    out->at[0] = out->uv[0] = out->unique[0] = (float)s;
}

typedef struct wall_scene {
    halftone_place place;
    int            across; /* cells of two triangles, each way */
    bool           lamp;   /* lit by one at `lamp_at`, else from the front */
} wall_scene;

static const double lamp_at[3] = {0.15, 0.5, 0.3};

static bool draw_cut(shot *out, const char *surface, wall_scene wall)
{
    halftone_scene s = {0};
    halftone_add(&s, "wall", wall.across, wall.across, wall.place, NULL);
    memcpy(s.lights[0], lamp_at, sizeof lamp_at);
    s.light_count = wall.lamp;
    shot_view view = halftone_view(SIDE, SIDE, SIDE);
    /* So that no joint goes through the middle of a pixel, which is of both pieces then. */
    view.eye.x = view.target.x += 0.21 / SIDE;
    view.eye.y = view.target.y += 0.34 / SIDE;
    const char *light = wall.lamp ? "\"lights\":\"file\"" : "\"light_direction\":[0,0,1],\"fill\":0";
    bool        ok = halftone_shot(out, &s, "marks-cut.gltf", halftone_look_with(surface, light, ""), NULL, &view);
    halftone_release(&s);
    return ok;
}

/* Long strokes that are cut into pieces by many triangles: all of one are there, or none, as the tone of its middle
 * says, whether the surface turns from the light or lies farther from it. */
static void whole(void)
{
    FILE *file = fopen(check_path("whole.stx"), "wb");
    if (!check_that("EX-12", file != NULL, "strokes"))
        return;
    for (int i = 0; i < ROWS; i++)
        fprintf(file, "0.05 %.9g 0.95 %.9g %.9g 1 0\n", (i + 0.5) / ROWS, (i + 0.5) / ROWS,
                (i * 7 % ROWS + 0.5) / ROWS);
    fclose(file);
    char surface[1000];
    snprintf(surface, sizeof surface, "%s", tiled("whole.stx", 0, ""));
    snprintf(strstr(surface, "\"shadow\""), 60, "\"shadow\":0,\"light\":1");
    for (int lamp = 0; lamp < 2; lamp++) {
        shot s;
        if (!draw_cut(&s, surface, (wall_scene){lamp ? place_even : place_bent, 24, lamp}))
            return;
        int parts = 0, wrong = 0, there = 0;
        for (int i = 0; i < ROWS; i++) {
            int    inked = 0, places = 0;
            double v = (i + 0.5) / ROWS, to[3] = {lamp_at[0] - 0.5, lamp_at[1] - v, lamp_at[2]};
            double tone = lamp ? to[2] / sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]) : cos(40 * pi / 180);
            for (double u = 0.08; u < 0.93; u += 0.01, places++)
                inked += ink_at(&s, (dvec){u, v, 0}) > 0.5;
            double priority = (i * 7 % ROWS + 0.5) / ROWS;
            parts += inked > 0 && inked < places;
            wrong += fabs(priority - tone) > 0.01 && (inked > 0) != (priority > tone);
            there += inked > 0;
        }
        check_that("EX-12", parts == 0 && wrong == 0 && there > 2 && there < ROWS - 2,
                   "%s: of %d strokes on a wall of 1152 triangles %d are there, %d in parts, %d wrongly or not",
                   lamp ? "beside a lamp" : "turning from the light", ROWS, there, parts, wrong);
        shot_release(&s);
    }
}

/* The same around a tube: a stroke is thinned out by how its middle lies, not piece by piece, as it turns away. */
static void around(void)
{
    enum { LINES = 40 };
    FILE *file = fopen(check_path("around.stx"), "wb");
    if (!check_that("EX-12", file != NULL, "strokes"))
        return;
    for (int i = 0; i < LINES; i++) /* over the half that is seen but for its rims */
        fprintf(file, "0.28 %.9g 0.72 %.9g 1 %.9g 0\n", (i + 0.5) / LINES, (i + 0.5) / LINES,
                (i * 7 % LINES + 0.5) / LINES);
    fclose(file);
    for (int line = 0; line < 2; line++) {
        halftone_scene s = {0};
        shot           drawn;
        char           keys[100];
        shot_view view = {.width = SIDE, .height = SIDE, .eye = {0.4, 0.6, -3}, .target = {0, 0.5, 0}, .up = {0, 1, 0}};
        view.fov_deg = 24;
        view.without_maps = true;
        snprintf(keys, sizeof keys, "\"scale\":52,\"law\":\"%s\"", line ? "line" : "thesis");
        halftone_add_tube(&s, "tube", (halftone_tube){0.5, 1, 1, 1});
        if (halftone_shot(&drawn, &s, "marks-tube.gltf", halftone_look_with(tiled("around.stx", 0, keys), "", ""), NULL,
                          &view)) {
            int parts = 0, there = 0;
            for (int i = 0; i < LINES; i++) {
                int inked = 0, places = 0;
                for (double u = 0.35; u < 0.65; u += 0.005, places++) {
                    double a = 2 * pi * u;
                    inked += ink_at(&drawn, (dvec){0.5 * sin(a), (i + 0.5) / LINES, 0.5 * cos(a)}) > 0.5;
                }
                parts += inked > 0 && inked < places;
                there += inked == places;
            }
            check_that("EX-12", parts == 0 && there > 4 && there < LINES - 4,
                       "law %s, around a tube: %d of %d strokes are there, %d in parts", line ? "line" : "thesis",
                       there, LINES, parts);
            shot_release(&drawn);
        }
        halftone_release(&s);
    }
}

/* A quad as 2, 8 and 512 triangles is drawn with the same strokes: pieces meet without a gap and without ink that is
 * there twice. */
static void joints(void)
{
    static const char *const sets[] = {"\"width\":3,\"taper\":0", "\"width\":2,\"taper\":0.25",
                                       "\"width\":0.6,\"taper\":0.25",
                                       "\"width\":5,\"taper\":0,\"ink\":\"#00000080\",\"paper\":\"#ffffff\""};
    for (int k = 0; k < 4; k++) {
        shot whole, cut;
        char surface[1000];
        snprintf(
            surface, sizeof surface,
            "strokes\",\"placed\":\"uv\",\"strokes\":\"cross\",\"repeat\":3,\"texture\":0,\"shadow\":0.5,\"light\":"
            "0.5,%s",
            sets[k]);
        if (!draw_cut(&whole, surface, (wall_scene){place_even, 1, false}))
            return;
        check_at_least("EX-26", halftone_mean(&whole, 0, 0, SIDE, SIDE), 0.1, "%s: ink", sets[k]);
        for (int across = 2; across <= 16; across *= 8) {
            if (!draw_cut(&cut, surface, (wall_scene){place_even, across, false}))
                break;
            int most = 0, off = 0;
            for (int i = 0; i < SIDE * SIDE; i++) {
                int d = abs(whole.picture[4 * i] - cut.picture[4 * i]);
                most = d > most ? d : most;
                off += d > 2;
            }
            /* A joint within a 512th of a pixel of a pixel's middle is drawn by both pieces: one that is not would be a
             * gap. */
            check_that("EX-26", off <= 60, "%s: %d triangles instead of 2: %d pixels differ, by up to %d levels",
                       sets[k], 2 * across * across, off, most);
            shot_release(&cut);
        }
        shot_release(&whole);
    }
}

/* --- what is cut off (EX-12, EX-14) ----------------------------------------------------------------------- */

static void place_ground(double s, double t, const void *user, halftone_corner *out)
{
    (void)user;
    *out = (halftone_corner){.at = {(float)(2 * s - 1), 0, (float)(8 - 20 * t)},
                             .normal = {0, 1, 0},
                             .uv = {(float)s, (float)t},
                             .unique = {(float)s, (float)t}};
}

/* Strokes that begin behind the viewer and end far in front: what is in front is there, where it is, and nothing else.
 */
static void near_plane(void)
{
    enum { LINES = 8 };
    FILE *file = fopen(check_path("near.stx"), "wb");
    if (!check_that("EX-12", file != NULL, "strokes"))
        return;
    for (int i = 0; i < LINES; i++)
        fprintf(file, "%.9g 0.01 %.9g 0.99 1 1 0\n", (i + 0.5) / LINES, (i + 0.5) / LINES);
    fclose(file);
    halftone_scene scene = {0};
    shot           s;
    shot_view view = {.width = SIDE, .height = SIDE, .eye = {0.07, 0.6, 0}, .target = {0.07, 0.2, -2}, .up = {0, 1, 0}};
    view.fov_deg = 55;
    view.without_maps = true;
    halftone_add(&scene, "ground", 1, 1, place_ground, NULL);
    if (halftone_shot(&s, &scene, "marks-near.gltf", halftone_look_with(tiled("near.stx", 0, ""), "", ""), NULL,
                      &view)) {
        int missing = 0, asked = 0, alien = 0, inked = 0;
        for (int i = 0; i < LINES; i++)
            for (double z = -0.2; z > -6; z -= 0.05) {
                dvec at = {2 * (i + 0.5) / LINES - 1, 0, z};
                dvec page = shot_project(&s, at);
                if (page.z <= 0 || page.x < 2 || page.y < 2 || page.x > SIDE - 2 || page.y > SIDE - 2)
                    continue;
                asked++;
                missing += ink_at(&s, at) < 0.9;
            }
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (halftone_ink(&s, i % SIDE, i / SIDE) < 0.02)
                continue;
            dvec   from, direction;
            bool   own = false;
            double t;
            shot_ray(&s, i % SIDE + 0.5, i / SIDE + 0.5, &from, &direction);
            t = -from.y / fmin(direction.y, -1e-9);
            double x = from.x + t * direction.x, z = from.z + t * direction.z, pixel;
            dvec   there = shot_project(&s, (dvec){x, 0, z}), beside = shot_project(&s, (dvec){x + 0.01, 0, z});
            pixel = 0.01 / fmax(fabs(beside.x - there.x), 1e-9);
            for (int k = 0; k < LINES && !own; k++)
                own = z > -11.9 && fabs(x - (2 * (k + 0.5) / LINES - 1)) < 6 * pixel;
            inked++;
            alien += !own;
        }
        check_that("EX-12", asked > 300 && missing == 0,
                   "%d of %d places of strokes in front of the viewer have no ink", missing, asked);
        check_that("EX-12", inked > 1000 && alien == 0, "%d of %d inked pixels lie on no stroke", alien, inked);
        shot_release(&s);
    }
    halftone_release(&scene);
}

/* How far within the plate's border; below 0 outside. */
static double inside_plate(double x, double y)
{
    return fmin(fmin(x - 0.3, 0.7 - x), fmin(y - 0.2, 0.8 - y));
}

static bool draw_plate(shot *out, const char *look, double z, const shot_view *view)
{
    halftone_scene s = {0};
    halftone_add_wall(&s, "wall", (halftone_wall){0, 0, 0, 1, 1, 1});
    halftone_part *plate = halftone_add_wall(&s, "plate", (halftone_wall){0.3, 0.2, z, 0.4, 0.6, 1});
    for (int i = 0; i < 4; i++) { /* turned to the light, whatever its triangles are */
        plate->corners[i].normal[0] = 0.995f;
        plate->corners[i].normal[2] = 0.1f;
    }
    bool ok = halftone_shot(out, &s, "marks-rims.gltf", look, NULL, view);
    halftone_release(&s);
    return ok;
}

/* A wall full of large dots behind a plate that is too light for any: a dot is there where its middle is not hidden,
 * and only as far as the plate leaves it. */
static void rims(void)
{
    const char *look =
        halftone_look_with("stipple\",\"count\":380,\"diameter\":11,\"grow\":1,\"fade\":0.001,\"texture\":0,"
                           "\"shadow\":0.7,\"light\":3",
                           "\"light_direction\":[1,0,0],\"fill\":0", "");
    shot      without, with;
    shot_view view = halftone_view(SIDE, SIDE, SIDE);
    if (!draw_plate(&without, look, -0.5, &view))
        return;
    if (draw_plate(&with, look, 0.5, &view)) {
        int *label = check_alloc(SIDE * SIDE, sizeof *label), *stack = check_alloc(SIDE * SIDE, sizeof *stack);
        int  outside = 0, inside = 0, lost = 0, hidden_ones = 0, cut_ones = 0;
        for (int first = 0; first < SIDE * SIDE; first++) {
            double sum = 0, x = 0, y = 0;
            int    count = 0, done = 0;
            if (label[first] || halftone_ink(&without, first % SIDE, first / SIDE) < 0.02)
                continue;
            label[first] = 1;
            stack[count++] = first;
            while (done < count) { /* all of them stay on the stack */
                int    at = stack[done++];
                double ink = halftone_ink(&without, at % SIDE, at / SIDE);
                sum += ink;
                x += ink * (at % SIDE + 0.5);
                y += ink * (at / SIDE + 0.5);
                for (int k = 0; k < 9; k++) {
                    int nx = at % SIDE + k % 3 - 1, ny = at / SIDE + k / 3 - 1, n = ny * SIDE + nx;
                    if (nx >= 0 && ny >= 0 && nx < SIDE && ny < SIDE && !label[n] &&
                        halftone_ink(&without, nx, ny) >= 0.02) {
                        label[n] = 1;
                        stack[count++] = n;
                    }
                }
            }
            /* One dot, whose middle is clearly on one side of the plate's border. */
            double mx = x / sum / SIDE, my = 1 - y / sum / SIDE, border = 1.5 / SIDE;
            double depth = inside_plate(mx, my);
            if (fabs(sum - pi / 4 * 11 * 11) > 6 || fabs(depth) < border)
                continue;
            int across = 0;
            for (int i = 0; i < count; i++) {
                double px = (stack[i] % SIDE + 0.5) / SIDE, py = 1 - (stack[i] / SIDE + 0.5) / SIDE;
                bool   over = inside_plate(px, py) > 0,
                     bare = halftone_ink(&with, stack[i] % SIDE, stack[i] / SIDE) < 0.02;
                across += over != (depth > 0);
                outside += !over && depth > 0 && !bare;
                inside += over && !bare;
                lost += !over && depth < 0 && halftone_ink(&without, stack[i] % SIDE, stack[i] / SIDE) > 0.5 && bare;
            }
            hidden_ones += depth > 0 && across > 0;
            cut_ones += depth < 0 && across > 0;
        }
        check_that("EX-14", hidden_ones > 3 && outside == 0,
                   "%d dots with hidden middles reach out: %d pixels of them are there", hidden_ones, outside);
        check_that("EX-14", cut_ones > 3 && inside == 0 && lost == 0,
                   "%d dots reach in behind the plate: %d pixels of them lie on it, %d beside it are lost", cut_ones,
                   inside, lost);
        free(label);
        free(stack);
        shot_release(&with);
    }
    shot_release(&without);
}

/* How near to a pixel another part is seen: 1 beside it, 3 within three pixels, 9: neither. */
static int other_part_near(const shot *s, int x, int y)
{
    uint16_t own = s->id[y * s->width + x];
    for (int reach = 1; reach <= 3; reach += 2)
        for (int k = 0; k < (2 * reach + 1) * (2 * reach + 1); k++) {
            int nx = x + k % (2 * reach + 1) - reach, ny = y + k / (2 * reach + 1) - reach;
            if (nx >= 0 && ny >= 0 && nx < s->width && ny < s->height && s->id[ny * s->width + nx] != own)
                return reach;
        }
    return 9;
}

/* Wide lines of a dark wall end where a white plate, which stands askew before it, begins: none lies over the plate,
 * and none ends before. */
static void sides(void)
{
    static const char *const look =
        "{\"version\":2,\"name\":\"sides\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{"
        "\"technique\":\"lines\",\"scale\":7,\"series\":1,\"ink\":\"#000000\",\"shadow\":1,\"light\":1,"
        "\"texture\":1}}]}";
    shape     model = {0};
    shot      s;
    double    over = 0, near = 0, far = 0;
    int       inside = 0, nears = 0, fars = 0;
    shot_view view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true};
    shape_quad(&model, "wall", 2, 0);
    model.parts[0].colour[0] = model.parts[0].colour[1] = model.parts[0].colour[2] = 0.2f;
    shape_quad(&model, "plate", 0.9, 0);
    shape_place(&model, (dvec){0, 0, 1}, 27, (dvec){0, 0, 1});
    model.parts[1].colour[0] = model.parts[1].colour[1] = model.parts[1].colour[2] = 1;
    if (shot_of_shape(&s, &model, "sides.glb", look, NULL, &view)) {
        for (int y = 8; y < SIDE - 8; y++)
            for (int x = 8; x < SIDE - 8; x++) {
                int    part = s.id[y * SIDE + x], where = other_part_near(&s, x, y);
                double ink = halftone_ink(&s, x, y);
                inside += part == 2 && where > 1;
                over += part == 2 && where > 1 ? ink : 0;
                nears += part == 1 && where == 3;
                near += part == 1 && where == 3 ? ink : 0;
                fars += part == 1 && where == 9;
                far += part == 1 && where == 9 ? ink : 0;
            }
        check_that("EX-12", inside > 5000 && nears > 300 && fars > 5000, "%d, %d, %d pixels", inside, nears, fars);
        check_at_most("EX-12", over, 0.5, "pixels of ink over what stands before a wall");
        check_near("EX-12", near / nears, far / fars, 0.03, "covered of the wall beside it, and farther on");
        shot_release(&s);
    }
    shape_release(&model);
}

/* The mean ink of a dark square face that has room for so many distances of lines; `black`: 0, or from where it is
 * filled. */
static double ink_of_face(double distances, double black)
{
    enum { RIM = 8, FACE = 214 /* pixels */ };
    const double TICK = 0.6; /* of its length, room of a line from edge to edge */
    char         look[500];
    shape        model = {0};
    shot         s;
    double       ink = 0;
    int          inside = 0;
    shot_view    view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true};
    snprintf(look, sizeof look,
             "{\"version\":2,\"name\":\"face\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{"
             "\"technique\":\"lines\",\"scale\":%.9g,\"series\":2,\"crossed\":0.5,\"ink\":\"#000000\","
             "\"shadow\":0.35,\"light\":0.35,\"texture\":0,\"room\":4,\"black\":%.9g}}]}",
             0.75 * FACE * TICK / distances, black);
    shape_quad(&model, "face", 1, 0);
    bool good = shot_of_shape(&s, &model, "face.glb", look, NULL, &view);
    for (int y = RIM; good && y < SIDE - RIM; y++)
        for (int x = RIM; x < SIDE - RIM; x++)
            if (s.id[y * SIDE + x] == 1 && other_part_near(&s, x, y) == 9) {
                ink += halftone_ink(&s, x, y);
                inside++;
            }
    if (good)
        check_near("EX-12", sqrt(inside), FACE - 6, 4, "side of the face within its rim, pixels");
    if (good)
        shot_release(&s);
    shape_release(&model);
    return good ? ink / inside : NAN;
}

/* A face that has no room for lines is black; one that has none but for further sets, which need more, is not. */
static void room(void)
{
    check_that("EX-12", ink_of_face(1.2, 0.6) > 0.95, "a dark face without room is filled");
    for (int k = 0; k < 3; k++)
        check_near("EX-12", ink_of_face(4.5 + k, 0.6), ink_of_face(4.5 + k, 0), 0.02,
                   "ink of a face that has room for %.1f lines", 4.5 + k);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"light", light},           {"vectors", vectors},
                                       {"white", white},           {"distance", distance},
                                       {"darkest", darkest},       {"uncut", uncut},
                                       {"whole", whole},           {"around", around},
                                       {"joints", joints},         {"near-plane", near_plane},
                                       {"indication", indication}, {"rims", rims},
                                       {"sides", sides},           {"room", room}};
    halftone_begin_kept("marks");
    int status = check_main(argc, argv, "marks", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
