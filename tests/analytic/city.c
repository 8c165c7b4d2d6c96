/* Illustrative city models: few tones a building, facades that tell storeys, use and occupancy, and a depth cue that
 * leaves light alone. Nienhaus 2005, section 4.8; rows C04 to C07, C10. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "light_truth.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 480 };

static const shot_view front = {
    .width = SIDE, .height = SIDE, .eye = {12, 12, 100}, .target = {12, 12, 0}, .up = {0, 1, 0}, .orthographic = true};

/* A box of this size whose front lies at z = 0, from x = 0 and y = 0 on, as a script with attributes. */
static const char *building(const char *name, double width, double height, const char *attributes)
{
    static char path[600];
    snprintf(path, sizeof path, "%s", check_path("%s.json", name));
    FILE *file = fopen(path, "w");
    if (file) {
        fprintf(file,
                "{\"limner_script\":1,\"nodes\":[{\"name\":\"building\",\"box\":{\"size\":[%g,%g,10]},\"translation\":["
                "%g,%g,-5],\"attributes\":{%s}}]}",
                width, height, width / 2, height / 2, attributes);
        fclose(file);
    }
    return path;
}

/* White tones, black glass, no frames: what is dark in the picture is a window. */
static const char *facade_look(const char *more)
{
    static char text[1200];
    snprintf(
        text, sizeof text,
        "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\","
        "\"surface\":{\"technique\":\"tones\",\"palette\":[\"#ffffff\",\"#ffffff\"],\"tint\":0,\"glass\":\"#000000\","
        "\"frame\":0,%s},\"lines\":\"none\"}]}",
        more);
    return text;
}

/* Numbers of connected places whose red is below (or, with `above`, over) a level, larger than 3 pixels. */
static int spots(const shot *s, int level, bool red_alone)
{
    unsigned char *seen = calloc((size_t)SIDE * SIDE, 1);
    int           *stack = malloc(sizeof *stack * SIDE * SIDE), count = 0;
    for (int start = 0; seen && stack && start < SIDE * SIDE; start++) {
        int size = 0, top = 0;
        stack[top++] = start;
        while (top > 0) {
            int            at = stack[--top];
            const uint8_t *c = &s->picture[4 * at];
            bool           is = red_alone ? c[0] > level && c[1] < 128 : c[0] < level;
            if (seen[at] || !is)
                continue;
            seen[at] = 1;
            size++;
            if (at % SIDE > 0)
                stack[top++] = at - 1;
            if (at % SIDE < SIDE - 1)
                stack[top++] = at + 1;
            if (at >= SIDE)
                stack[top++] = at - SIDE;
            if (at < SIDE * (SIDE - 1))
                stack[top++] = at + SIDE;
        }
        count += size > 3;
    }
    free(seen);
    free(stack);
    return count;
}

static int windows(const char *model, const char *more)
{
    shot s;
    int  count = -1;
    if (shot_take(&s, model, facade_look(more), NULL, &front)) {
        count = spots(&s, 128, false);
        shot_release(&s);
    }
    return count;
}

/* Row C07: as many windows as bays times storeys, and what says so otherwise counts. */
static void storeys_and_bays(void)
{
    const char *plain = building("plain", 21, 15, "");
    check_near("C07", windows(plain, "\"facade\":\"none\""), 0, 0, "windows without a facade");
    check_near("C07", windows(plain, "\"facade\":\"residential\""), 35, 0, "5 storeys of 7 bays, one with a door");
    check_near("C07", windows(plain, "\"facade\":\"residential\",\"storey\":5"), 21, 0, "higher storeys");
    check_near("C07", windows(plain, "\"facade\":\"residential\",\"bay\":4.3"), 25, 0,
               "wider bays: 21 / 4.3 is nearest to 5");
    check_near("C07", windows(plain, "\"facade\":\"industrial\",\"storey\":5"), 12, 0,
               "industrial ones are twice as wide: 21 / 6 is nearest to 4");
    check_near("C07", windows(plain, "\"facade\":\"residential\",\"ground_storey\":\"blank\""), 28, 0,
               "a blank ground storey");
    const char *low = building("low", 21, 15, "\"storeysAboveGround\":\"3\"");
    check_near("C07", windows(low, "\"facade\":\"residential\""), 21, 0, "the file says three storeys");
    const char *narrow = building("narrow", 1.5, 15, "");
    check_near("C07", windows(narrow, "\"facade\":\"residential\""), 0, 0, "windows where there is no room for one");
}

/* Bars part windows: panes are spots of glass. Far away they are left out. */
static void bars_part_windows(void)
{
    const char *plain = building("plain", 21, 15, "");
    const char *wide = "\"bars\":4,\"frame_colour\":\"#ffffff\"";
    static const struct {
        const char *facade;
        double      storey;
        int         panes;
    } rows[] = {{"residential", 7.5, 5 * 4 + 1}, {"office", 7.5, 6 * 4}, {"industrial", 15, 2 * 15}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char more[200];
        snprintf(more, sizeof more, "\"facade\":\"%s\",\"storey\":%g,\"bay\":7,%s", rows[i].facade, rows[i].storey,
                 wide);
        check_near("C07", windows(plain, more), rows[i].panes, 0, "panes of %s windows", rows[i].facade);
    }
    char thin[200];
    snprintf(thin, sizeof thin, "\"facade\":\"residential\",\"storey\":1,\"bay\":1,%s", wide);
    check_near("C07", windows(plain, thin), 15 * 21, 0, "windows with panes too small for bars");
}

/* Uses are told apart by how much of a wall is glass: each the area that its openings have. */
static void uses_differ(void)
{
    static const struct {
        const char *facade;
        double      glass;
    } rows[] = {{"residential", 34.0 / 35 * 0.44 * 0.54 + 1.0 / 35 * 0.38 * 0.76},
                {"office", 0.94 * 0.56},
                {"industrial", 0.76 * 0.34}};
    const char *model = building("plain", 21, 15, "");
    for (int i = 0; i < 3; i++) {
        char more[64];
        snprintf(more, sizeof more, "\"facade\":\"%s\"", rows[i].facade);
        shot   s;
        double dark = 0, pixels = 0;
        if (!shot_take(&s, model, facade_look(more), NULL, &front))
            continue;
        for (int k = 0; k < SIDE * SIDE; k++)
            if (s.id[k]) {
                dark += 1 - s.picture[4 * k] / 255.0;
                pixels++;
            }
        check_near("C07", dark / pixels, rows[i].glass, 0.01, "fraction of glass of %s walls", rows[i].facade);
        shot_release(&s);
    }
}

/* Lines around windows: as much dark as their outlines are long, and none where they are 0 wide. */
static void windows_have_frames(void)
{
    const char *model = building("plain", 21, 15, "");
    double      dark[3] = {0};
    for (int k = 0; k < 3; k++) {
        char more[200];
        snprintf(
            more, sizeof more,
            "\"facade\":\"industrial\",\"glass\":\"#ffffff\",\"storey\":15,\"bay\":5.25,\"frame\":\"%dpx\",\"frame_"
            "colour\":\"%s\"",
            k ? 2 : 0, k == 2 ? "#808080" : "#000000");
        shot s;
        char look[1400];
        snprintf(look, sizeof look,
                 "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{"
                 "\"select\":\"*\",\"surface\":{\"technique\":\"tones\",\"palette\":[\"#ffffff\",\"#ffffff\"],\"tint\":"
                 "0,%s},"
                 "\"lines\":\"none\"}]}",
                 more);
        if (!shot_take(&s, model, look, NULL, &front))
            continue;
        for (int i = 0; i < SIDE * SIDE; i++)
            dark[k] += s.id[i] ? 1 - s.picture[4 * i] / 255.0 : 0;
        if (k == 1) {
            /* 1 storey of 2 windows: each (0.76 · 21 / 2) by (0.34 · 15) units, lines of 2 px. */
            double a[2], b[2];
            shot_on_page(&s, dvec_of(0, 0, 0), a);
            shot_on_page(&s, dvec_of(1, 0, 0), b);
            double unit = b[0] - a[0], outline = 2 * 2 * (0.76 * 21 / 2 + 0.34 * 15) * unit;
            check_near("C07", dark[1] / (2 * outline), 1, 0.06, "dark of frames over the length of outlines");
        }
        shot_release(&s);
    }
    check_at_most("C07", dark[0], 1, "dark pixels of frames of no width");
    check_near("C07", dark[2] / fmax(dark[1], 1), 127.0 / 255, 0.03, "grey frames over black ones");
    /* Windows six pixels wide: frames as wide as asked for would leave nothing of the wall. */
    shot              small;
    static const char crowded[] =
        "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\","
        "\"surface\":{\"technique\":\"tones\",\"palette\":[\"#ffffff\",\"#ffffff\"],\"tint\":0,\"facade\":"
        "\"residential\","
        "\"glass\":\"#ffffff\",\"storey\":1.6,\"bay\":1.6,\"frame\":\"4px\",\"frame_colour\":\"#000000\"},\"lines\":"
        "\"none\"}]}";
    if (shot_take(&small, model, crowded, NULL, &front)) {
        double black = 0, all = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            all += small.id[i] != 0;
            black += small.id[i] ? 1 - small.picture[4 * i] / 255.0 : 0;
        }
        check_at_most("C07", black / fmax(all, 1), 0.2, "share of a wall that frames of small windows take");
        check_at_least("C07", black / fmax(all, 1), 0.02, "and they are there");
        shot_release(&small);
    }
}

/* Lit windows are the given share of a high house. */
static void occupancy_is_counted(void)
{
    static const double shares[] = {0, 0.25, 0.75, 1};
    const char         *model = building("high", 24, 24, "");
    for (int i = 0; i < 4; i++) {
        char more[160];
        snprintf(more, sizeof more,
                 "\"facade\":\"residential\",\"storey\":1.2,\"bay\":1.2,\"lit\":\"#ff0000\",\"occupancy\":%g",
                 shares[i]);
        shot s;
        if (!shot_take(&s, model, facade_look(more), NULL, &front))
            continue;
        int lit = spots(&s, 128, true);
        check_near("C07", lit / 400.0, shares[i], shares[i] > 0 && shares[i] < 1 ? 0.07 : 0, "lit windows of 400");
        shot_release(&s);
    }
}

/* From far away a facade is even: what it is on the average, and the same wherever it stands between pixels. */
static void far_facades_are_calm(void)
{
    const char *model = building("plain", 21, 15, "");
    double      least = 1, most = 0;
    for (int i = 0; i < 8; i++) {
        shot_view far = front;
        far.width = far.height = SIDE;
        far.orthographic = false;
        far.fov_deg = 20;
        far.eye = dvec_of(10.5 + 0.37 * i, 7.5, 1500);
        far.target = dvec_of(10.5 + 0.37 * i, 7.5, 0);
        shot s;
        if (!shot_take(&s, model, facade_look("\"facade\":\"office\""), NULL, &far))
            continue;
        for (int k = 0; k < SIDE * SIDE; k++)
            if (s.id[k] && s.id[k - 1] && s.id[k + 1] && s.id[k - SIDE] && s.id[k + SIDE]) {
                least = fmin(least, s.picture[4 * k] / 255.0);
                most = fmax(most, s.picture[4 * k] / 255.0);
            }
        shot_release(&s);
    }
    check_at_most("C07", most - least, 0.02, "unevenness of a far facade, over eight places");
    check_near("C07", (most + least) / 2, 1 - 0.94 * 0.56, 0.02, "its tone: that of its parts together");
}

/* Row C05: nothing but the palette's colours on a building, and each building its own. */
static void only_its_tones(void)
{
    shape s = {0};
    shape_sphere(&s, "dome", dvec_of(4, 12, 0), 4, 40, 60, true);
    shape_box(&s, "tower", dvec_of(14, 2, -4), dvec_of(20, 20, 2));
    static const char look[] =
        "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"scene\":{\"light_direction\":[1,0.1,0.1]},\"rules\":[{"
        "\"select\":\"dome\",\"surface\":{\"technique\":\"tones\","
        "\"palette\":[\"#204060\",\"#6080a0\",\"#c0d0e0\"],\"tint\":0},\"lines\":\"none\"},{\"select\":\"tower\","
        "\"surface\":{"
        "\"technique\":\"tones\",\"palette\":[\"#602010\",\"#e0b090\"],\"tint\":0},\"lines\":\"none\"}]}";
    static const int palettes[2][3] = {{0x20, 0x60, 0xc0}, {0x60, 0xe0, -1}};
    shot_view        slanted = front;
    slanted.eye = dvec_of(-80, 40, 100); /* the sun stands at the right, so that both sides of it are seen */
    shot got;
    if (shot_of_shape(&got, &s, "tones.glb", look, NULL, &slanted)) {
        int other = 0, counts[2][3] = {{0}};
        for (int k = 0; k < SIDE * SIDE; k++) {
            int part = got.id[k] - 1, is = -1;
            for (int tone = 0; part >= 0 && tone < 3; tone++)
                is = abs(got.picture[4 * k] - palettes[part][tone]) <= 1 ? tone : is;
            if (part >= 0 && is >= 0)
                counts[part][is]++;
            other += part >= 0 && is < 0;
        }
        check_near("C05", other, 0, 0, "pixels of another colour than the building's tones");
        check_at_least("C05", counts[0][0] > 50 && counts[0][1] > 50 && counts[0][2] > 50, 1,
                       "all three tones of the dome are there");
        check_at_least("C05", counts[1][0] > 50 && counts[1][1] > 50, 1, "both of the tower");
        shot_release(&got);
    }
    shape_release(&s);
}

/* Row C04: blocks in streets, from above and among them. What lies in shadow by rays is so in the picture, but for what
 * a border within a pixel takes. */
static void shadows_are_where_rays_say(void)
{
    static const struct {
        const char *name;
        dvec        eye, target;
    } views[] = {{"above", {-120, 160, 220}, {100, 0, 100}},
                 {"roofs", {-20, 40, 215}, {110, 0, 90}},
                 {"street", {38, 2.2, 205}, {60, 6, 0}}};
    shape    s = {0};
    uint32_t random = 5;
    shape_box(&s, "ground", dvec_of(-40, -1, -40), dvec_of(240, 0, 240));
    for (int i = 0; i < 64; i++) {
        double r[3];
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            r[k] = (random >> 8) / 16777216.0;
        }
        double x = 25.0 * (i % 8), z = 25.0 * (i / 8);
        char   name[16];
        snprintf(name, sizeof name, "block%d", i);
        shape_box(&s, name, dvec_of(x, 0, z), dvec_of(x + 10 + 8 * r[0], 4 + 24 * r[1] * r[1], z + 10 + 8 * r[2]));
    }
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        light_scene l = {.s = s,
                         .file = "blocks.glb",
                         .view = {.width = 512,
                                  .height = 512,
                                  .eye = views[i].eye,
                                  .target = views[i].target,
                                  .up = {0, 1, 0},
                                  .fov_deg = 50},
                         .towards = {-0.5, 0.55, 0.7}};
        shot        with, without;
        light_map   m;
        if (!light_shot(&with, &l, true))
            continue;
        if (light_shot(&without, &l, false)) {
            light_map_drawn(&m, &with, &without);
            light_map_shadows(&m, &l, &with, 1, 5);
            light_score score = light_compare(&m);
            check_at_least("C04", score.positions, 5000, "positions compared (%s)", views[i].name);
            check_at_most("C04", score.wrong, 0.005, "fraction of them that is lit or in shadow and should not be");
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    shape_release(&s);
}

/* Row C10: what is known about a building is its colour, of the ramp's or the word's; a change of the datum changes it.
 */
static void data_are_colours(void)
{
    static const struct {
        const char *scene;
        int         red[3]; /* of three buildings: 1900, 2000, and one without a year */
    } rows[] = {
        {"\"datum\":\"year\",\"datum_palette\":[\"#200000\",\"#e00000\"],\"datum_other\":\"#800000\"",
         {0x20, 0xe0, 0x80}},
        {"\"datum\":\"year\",\"datum_palette\":[\"#200000\",\"#e00000\"],\"datum_other\":\"none\"", {0x20, 0xe0, 0xff}},
        {"\"datum\":\"year\",\"datum_palette\":[\"#200000\",\"#e00000\"],\"datum_from\":1900,\"datum_to\":2100",
         {0x20, 0x80, 0xd9}},
        {"\"datum\":\"use\",\"datum_palette\":[\"#100000\",\"#900000\"],\"datum_words\":\"shop|bank,home\"",
         {0x90, 0x10, 0x10}},
    };
    const char *path = check_path("data.json");
    FILE       *file = fopen(path, "w");
    if (!file)
        return;
    fprintf(file, "{\"limner_script\":1,\"nodes\":[");
    static const char *const facts[] = {"\"year\":\"1900\",\"use\":\"home\"", "\"year\":\"2000\",\"use\":\"shop\"",
                                        "\"use\":\"bank\""};
    for (int i = 0; i < 3; i++)
        fprintf(file,
                "%s{\"name\":\"b%d\",\"box\":{\"size\":[4,8,4]},\"translation\":[%d,8,0],\"colour\":\"#ff0000\","
                "\"attributes\":{%s}}",
                i ? "," : "", i, 4 + 8 * i, facts[i]);
    fprintf(file, "]}");
    fclose(file);
    for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
        char look[700];
        snprintf(
            look, sizeof look,
            "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"scene\":{%s},\"rules\":[{\"select\":\"*\",\"surface\":{"
            "\"technique\":\"tones\",\"palette\":[\"#ffffff\",\"#ffffff\"]},\"lines\":\"none\"}]}",
            rows[row].scene);
        shot s;
        if (!shot_take(&s, path, look, NULL, &front))
            continue;
        for (int i = 0; i < 3; i++) {
            double at[2];
            shot_on_page(&s, dvec_of(4 + 8 * i, 8, 2), at);
            check_near("C10", s.picture[4 * ((int)at[1] * SIDE + (int)at[0])], rows[row].red[i], 1,
                       "row %zu: colour of building %d", row, i);
        }
        shot_release(&s);
    }
}

static double luminance_of(const uint8_t *c)
{
    return 0.2126 * picture_linear(c[0]) + 0.7152 * picture_linear(c[1]) + 0.0722 * picture_linear(c[2]);
}

static double colourfulness_of(const uint8_t *c)
{
    double y = luminance_of(c), sum = 0;
    for (int k = 0; k < 3; k++)
        sum += pow(picture_linear(c[k]) - y, 2);
    return sqrt(sum);
}

/* Row C06: boxes one behind the other keep their light and lose colour by what the law says: linearly with depth. */
static void depth_cue(void)
{
    enum { ROW = 6 };
    static const float colours[3][3] = {{0.6f, 0.1f, 0.05f}, {0.05f, 0.4f, 0.1f}, {0.1f, 0.15f, 0.7f}};
    shape              s = {0};
    for (int i = 0; i < ROW; i++) {
        char name[16];
        snprintf(name, sizeof name, "box%d", i);
        shape_box(&s, name, dvec_of(4 * i, 10, -20.0 * i - 1), dvec_of(4 * i + 3, 13, -20.0 * i));
        memcpy(s.parts[i].colour, colours[i % 3], sizeof colours[0]);
    }
    double light[2][ROW] = {{0}}, colour[2][ROW] = {{0}};
    for (int on = 0; on < 2; on++)
        for (int form = 0; form < 2; form++) {
            char look[600];
            snprintf(look, sizeof look,
                     "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"scene\":{\"depth_cue\":%g},\"rules\":[{\"select\":"
                     "\"*\","
                     "\"surface\":\"lambert\",\"lines\":\"%s\"}]}",
                     on ? 0.8 : 0.0, form ? "discontinuity" : "none");
            shot got;
            if (!shot_of_shape(&got, &s, "row.glb", look, NULL, &front))
                continue;
            for (int i = 0; i < ROW; i++) {
                double at[2];
                shot_on_page(&got, dvec_of(4 * i + 1.5, 11.5, -20.0 * i), at);
                const uint8_t *c = &got.picture[4 * ((int)at[1] * SIDE + (int)at[0])];
                light[on][i] = luminance_of(c);
                colour[on][i] = colourfulness_of(c);
                if (on) {
                    /* The nearest place is the first box's front, the farthest the last one's back. */
                    double law = 1 - 0.8 * (20.0 * i) / (20.0 * (ROW - 1) + 1);
                    check_near("C06", light[1][i] / light[0][i], 1, 0.02, "light of box %d with the cue over without",
                               i);
                    check_near("C06", colour[1][i] / colour[0][i], law, 0.03, "and its colourfulness");
                }
            }
            shot_release(&got);
            if (!on)
                form = 1; /* without, one is enough */
        }
    shape_release(&s);
}

/* A plane of this slope along z, 20 a side, seen from above. */
static bool take_slope(shot *out, double rises, const char *surface)
{
    static char     look[700];
    const shot_view above = {.width = SIDE,
                             .height = SIDE,
                             .eye = {10, 100, 10},
                             .target = {10, 0, 10},
                             .up = {0, 0, -1},
                             .orthographic = true};
    const char     *path = check_path("%s", "slope.obj");
    FILE           *file = fopen(path, "w");
    if (!file)
        return false;
    fprintf(file, "v 0 0 0\nv 20 0 0\nv 20 %g 20\nv 0 %g 20\nf 4 3 2 1\n", 20 * rises, 20 * rises);
    fclose(file);
    snprintf(look, sizeof look,
             "{\"version\":2,\"name\":\"r\",\"doc\":\"x.\",\"scene\":{\"light_direction\":[-0.6,0,0.8]},"
             "\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":\"relief\",%s},\"lines\":\"none\"}]}",
             surface);
    return shot_take(out, path, look, NULL, &above);
}

/* Contour lines lie where heights are whole multiples, are as wide as they say and leave where they crowd; tints run
 * from the lowest to the highest; slopes are as much darker as they have less light than level ground. */
static void relief_is_what_heights_say(void)
{
    static const char white[] = "\"palette\":[\"#ffffff\"],\"shade\":0,\"contour_colour\":\"#000000\"";
    char              surface[300];
    shot              s;
    snprintf(surface, sizeof surface, "%s,\"interval\":2,\"contour\":3", white);
    if (take_slope(&s, 0.5, surface)) {
        double ink = 0, count = 0, wrong = 0, pixel = 0;
        for (int k = SIDE + 1; k < SIDE * (SIDE - 1); k++) {
            if (!s.id[k] || !s.id[k + SIDE] || !s.id[k - SIDE])
                continue;
            double height = 100 - (double)s.depth[k], off = fabs(height / 2 - round(height / 2)) * 2;
            double dark = 1 - s.picture[4 * k] / 255.0;
            pixel = fabs((double)s.depth[k] - (double)s.depth[k + SIDE]);
            bool bold = fmod(round(height / 2), 5) == 0;
            ink += bold ? 0 : dark;
            count += bold ? 0 : 1;
            wrong += (off < 1 * pixel && dark < 0.9) || (off > (bold ? 5 : 3) * pixel && dark > 0.1);
        }
        check_near("relief", wrong, 0, 0, "places of contour lines that have none, or beside them that have some");
        /* 3 points are 4 pixels of 1/96 inch; a drawing of this size is as large as one of 1024 pixels on paper. */
        check_at_least("relief", count, 1000, "pixels compared");
        check_near("relief", ink / count / (pixel / 2), 3 * 96.0 / 72, 0.5, "width of the lines, pixels");
        shot_release(&s);
    }
    snprintf(surface, sizeof surface, "%s,\"interval\":0.05,\"contour\":1", white);
    if (take_slope(&s, 2, surface)) {
        double dark = 0;
        for (int k = 0; k < SIDE * SIDE; k++)
            dark = s.id[k] ? fmax(dark, 1 - s.picture[4 * k] / 255.0) : dark;
        check_near("relief", dark, 0, 0.01, "ink where lines would be closer than three pixels");
        shot_release(&s);
    }
    if (take_slope(&s, 0.5, "\"palette\":[\"#000000\",\"#ffffff\"],\"shade\":0,\"contour\":0")) {
        double worst = 0;
        for (int k = 0; k < SIDE * SIDE; k++)
            if (s.id[k])
                worst = fmax(worst, fabs(s.picture[4 * k] / 255.0 - (100 - (double)s.depth[k]) / 10));
        check_at_most("relief", worst, 0.01, "tints against heights");
        shot_release(&s);
    }
    double grey[2] = {0, 0};
    for (int i = 0; i < 2; i++)
        if (take_slope(&s, i ? 0.75 : 0.0001,
                       "\"palette\":[\"#808080\"],\"shade\":1,\"contour\":0,\"sea\":\"#80808000\"")) {
            grey[i] = s.picture[4 * (SIDE / 2 * SIDE + SIDE / 2)] / 255.0;
            shot_release(&s);
        }
    check_near("relief", grey[0], 0.502, 0.005, "level ground keeps its tint");
    check_near("relief", grey[1], 0.502 * (1 - 0.75 * 0.2), 0.006, "a slope whose cosine is 0.8 of the level one's");
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"storeys", storeys_and_bays},
        {"uses", uses_differ},
        {"frames", windows_have_frames},
        {"bars", bars_part_windows},
        {"data", data_are_colours},
        {"occupancy", occupancy_is_counted},
        {"calm", far_facades_are_calm},
        {"tones", only_its_tones},
        {"cue", depth_cue},
        {"shadows", shadows_are_where_rays_say},
        {"relief", relief_is_what_heights_say},
    };
    int status = check_main(argc, argv, "city", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
