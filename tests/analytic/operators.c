/* Every edge operator against its twin on the CPU, pixel by pixel, on the raw maps of the same drawing; then the
 * values that the seeds derive for steps and creases, on geometry that has just those. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "shape.h"
#include "twin.h"

static const double pi = 3.14159265358979323846;

/* --- twins ---------------------------------------------------------------------------------------------- */

typedef twin_value (*twin_function)(const twin_map *m, int x, int y);

static twin_value tap_two(const twin_map *m, int x, int y)
{
    return twin_four_tap(m, x, y, 1, true);
}

static twin_value tap_one(const twin_map *m, int x, int y)
{
    return twin_four_tap(m, x, y, 0.5, true);
}

static twin_value tap_third(const twin_map *m, int x, int y)
{
    return twin_four_tap(m, x, y, 2 / 3.0, true);
}

static twin_value tap_listing(const twin_map *m, int x, int y)
{
    return twin_four_tap(m, x, y, 1, false);
}

static twin_value pencil(const twin_map *m, int x, int y)
{
    return twin_pencil(m, x, y, 1);
}

static twin_value pencil_shader(const twin_map *m, int x, int y)
{
    return twin_pencil(m, x, y, 4);
}

static twin_value normalised_default(const twin_map *m, int x, int y)
{
    return twin_saito_normalised(m, x, y, 0.02, 0.0005);
}

static twin_value denormal(const twin_map *m, int x, int y)
{
    return twin_denormal(m, x, y, 0, false);
}

static twin_value denormal_depth(const twin_map *m, int x, int y)
{
    return twin_denormal(m, x, y, 0.05, true);
}

typedef struct twin_case {
    const char   *row, *lines;
    twin_function twin;
    double        sharpen;
    double        levels; /* 0: one, and half of one for rounding */
} twin_case;

/* Denormalisation multiplies what one filtered fetch returns by four: one level of N·N is four of the map. */
static const twin_case twin_cases[] = {
    {"E06", "{\"operator\":\"four-tap\",\"width\":2}", tap_two, 0},
    {"E21", "{\"operator\":\"four-tap\",\"width\":1}", tap_one, 0},
    {"E21", "{\"operator\":\"four-tap\",\"width\":1.3333334}", tap_third, 0},
    {"E06", "{\"operator\":\"four-tap\",\"width\":2,\"squared\":false}", tap_listing, 0},
    {"G13", "{\"operator\":\"sobel\",\"width\":2,\"taps\":\"five\"}", twin_sobel_nine, 0},
    {"OI-04", "{\"operator\":\"sobel\",\"width\":2,\"taps\":\"eight\"}", twin_sobel_nine, 0},
    {"E24", "{\"operator\":\"saito\",\"width\":2}", twin_saito, 0},
    {"P4", "{\"operator\":\"saito\",\"width\":2,\"weights\":\"pencil\"}", pencil, 0},
    {"P4", "{\"operator\":\"saito\",\"width\":2,\"weights\":\"pencil-shader\"}", pencil_shader, 0},
    {"E26", "{\"operator\":\"saito-normalised\",\"width\":2}", normalised_default, 0},
    {"OI-06", "{\"operator\":\"denormal\",\"width\":2}", denormal, 0, 4.5},
    {"OI-08", "{\"operator\":\"denormal\",\"width\":2,\"depth\":true,\"tolerance\":0.05}", denormal_depth, 0, 4.5},
    {"P6", "{\"operator\":\"four-tap\",\"width\":2,\"sharpen\":-0.1}", tap_two, -0.1},
    {"P6", "{\"operator\":\"four-tap\",\"width\":2,\"sharpen\":0.1}", tap_two, 0.1},
};

static void against_twin(const twin_case *c, const shape *s, const char *file, const shot_view *view)
{
    shot drawing;
    if (!shot_of_shape(&drawing, s, file, shot_line_look(c->lines), NULL, view))
        return;
    twin_map map;
    double   worst[3] = {0, 0, 0}, allowed = c->levels > 0 ? c->levels : 1.5;
    int      position[3] = {0, 0, 0}, off = 0;
    twin_map_make(&map, &drawing);
    if (fabs(c->sharpen) > 0)
        twin_sharpen(&map, c->sharpen);
    for (int i = 0; i < map.width * map.height; i++) {
        twin_value v = c->twin(&map, i % map.width, i / map.width);
        double     r = twin_byte(v.profile), g = twin_byte(v.inner), wanted[3] = {r, g, r * g / 255};
        for (int k = 0; k < 3; k++) {
            double error = fabs(drawing.edge[4 * i + k] - wanted[k]);
            off += error > allowed && !v.doubtful;
            if (error > worst[k] && !v.doubtful) {
                worst[k] = error;
                position[k] = i;
            }
        }
    }
    static const char *const channel[] = {"R profile", "G inner", "B both"};
    for (int k = 0; k < 3; k++)
        if (!check_at_most(c->row, worst[k], allowed, "%s on %s: levels between %s and its twin", c->lines, file,
                           channel[k]))
            check_note("worst at %d, %d (got %d); %d values are off", position[k] % map.width, position[k] / map.width,
                       drawing.edge[4 * position[k] + k], off);
    twin_map_release(&map);
    shot_release(&drawing);
}

static void twins(void)
{
    const shot_view central = {.width = 301, .height = 223, .eye = {4, 3, 5}, .up = {0, 1, 0}};
    const shot_view parallel = {.width = 240, .height = 200, .eye = {2, 1.5, 4}, .up = {0, 1, 0}, .orthographic = true};
    shape           mixed = {0}, hills = {0};
    shape_torus(&mixed, "ring", 0.9, 0.3, 96, 48);
    shape_box(&mixed, "box", dvec_of(-0.5, -0.8, -0.5), dvec_of(0.4, 0.9, 0.4));
    shape_place(&mixed, dvec_of(0, 1, 1), 25, dvec_of(0.1, 0, 0));
    shape_terrain(&hills, "terrain", 1.5, 0.5, 64, 5);
    for (size_t i = 0; i < sizeof twin_cases / sizeof *twin_cases; i++) {
        against_twin(&twin_cases[i], &mixed, "mixed.glb", &central);
        against_twin(&twin_cases[i], &hills, "hills.ply", &parallel);
    }
    shape_release(&mixed);
    shape_release(&hills);
}

/* --- steps and creases ---------------------------------------------------------------------------------- */

static const shot_view front = {
    .width = 128, .height = 128, .eye = {0, 0, 10}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 30};

static void add_rectangle(shape *s, const char *name, double x0, double y0, double x1, double y1, double z)
{
    shape_quad(s, name, 1, z);
    shape_part *p = &s->parts[s->count - 1];
    for (int i = 0; i < 4; i++) {
        p->positions[i][0] = (float)(p->positions[i][0] < 0 ? x0 : x1);
        p->positions[i][1] = (float)(p->positions[i][1] < 0 ? y0 : y1);
    }
}

/* Left half at the depth `base`, right half `step` behind, and two marks that stretch the depth range to exactly 1. */
static void step_scene(shape *s, double base, double step)
{
    add_rectangle(s, "left", -3, -2, 0, 3, -base);
    add_rectangle(s, "right", 0, -2, 3, 3, -base - step);
    add_rectangle(s, "mark", -3, -3, -2.5, -2.5, 0);
    add_rectangle(s, "mark", 2.5, -3, 3, -2.5, -1);
}

static double channel(const shot *s, int x, int y, int k)
{
    return s->edge[4 * (y * s->width + x) + k] / 255.0;
}

static void steps(void)
{
    static const double table[][3] = {
        {0.01, 0.980, 0.990}, {0.05, 0.904, 0.951}, {0.1, 0.815, 0.903}, {0.3, 0.522, 0.723}, {0.5, 0.316, 0.563}};
    static const char *const lines[] = {"{\"operator\":\"four-tap\",\"width\":2}",
                                        "{\"operator\":\"four-tap\",\"width\":2,\"squared\":false}",
                                        "{\"operator\":\"saito\",\"width\":2,\"weights\":\"pencil\"}",
                                        "{\"operator\":\"saito\",\"width\":2,\"weights\":\"pencil-shader\"}"};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        shape s = {0};
        step_scene(&s, 0, table[i][0]);
        for (int k = 0; k < 4; k++) {
            shot drawing;
            if (!shot_of_shape(&drawing, &s, "step.glb", shot_line_look(lines[k]), NULL, &front))
                continue;
            /* The clip planes keep a small distance, so a step is a little less of the range than it is of the
             * scene. */
            double step = table[i][0] / (drawing.far_depth - drawing.near_depth);
            double wanted = k < 2 ? table[i][k + 1] : k == 2 ? 1 - 0.5 * step : 1 - 2 * step;
            check_near(k < 2 ? "E06" : "P4", channel(&drawing, 64, 60, 0), wanted, 1.5 / 255, "step %g, %s",
                       table[i][0], lines[k]);
            check_near(k < 2 ? "E06" : "P4", channel(&drawing, 63, 60, 0), wanted, 1.5 / 255, "  on the near side");
            /* Saito's second order tells a step, too. */
            check_near("E07", channel(&drawing, 64, 60, 1), k < 2 ? 1 : 1 - step, 1.5 / 255, "  and its inner channel");
            shot_release(&drawing);
        }
        shape_release(&s);
    }
}

static void creases(void)
{
    static const double      degrees[] = {20, 30, 45, 60, 75, 90, 120, 150};
    static const char *const lines[] = {"{\"operator\":\"four-tap\",\"width\":2}",
                                        "{\"operator\":\"denormal\",\"width\":2}"};
    const shot_view          close = {
                 .width = 128, .height = 128, .eye = {0, 0, 4}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 10};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++)
        for (int k = 0; k < 2; k++) {
            shape  s = {0};
            shot   drawing;
            double a = degrees[i] * pi / 180, least = 1;
            shape_wedge(&s, "wedge", degrees[i]);
            if (shot_of_shape(&drawing, &s, "wedge.glb", shot_line_look(lines[k]), NULL, &close)) {
                for (int x = 62; x <= 65; x++)
                    least = fmin(least, channel(&drawing, x, 64, 1));
                double wanted = k == 0 ? cos(a) : 1 - 4 * (1 - cos(a / 2) * cos(a / 2));
                check_near(k == 0 ? "P3" : "OI-06", least, fmax(wanted, 0), 0.01, "crease of %g degrees, %s",
                           degrees[i], lines[k]);
                check_near(k == 0 ? "P3" : "OI-06", channel(&drawing, 55, 64, 1), 1, 1.5 / 255, "  flat beside it");
                for (int x = 60; x < 68; x++)
                    check_at_most("P5", channel(&drawing, x, 64, 2), channel(&drawing, x, 64, 1) + 1 / 255.0,
                                  "  combined is not lighter");
            }
            shot_release(&drawing);
            shape_release(&s);
        }
}

/* A square whose right side bends away by 30 degrees, which is no crease, from a position on; its normals turn away
 * from the viewer in the middle. */
static void shape_past_the_rim(shape *s, double bend)
{
    const double x[3] = {-1, bend, 1};
    shape_part  *p = shape_add(s, "past", 6, 12, true, false);
    for (uint32_t i = 0; i < 6; i++) {
        double at = x[i / 2];
        p->positions[i][0] = (float)at;
        p->positions[i][1] = i % 2 ? 1 : -1;
        p->positions[i][2] = (float)(fmin(0, bend - at) * tan(pi / 6));
        p->normals[i][0] = 0.9F;
        p->normals[i][1] = 0;
        p->normals[i][2] = (float)(-0.44 * at);
    }
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t a = 2 * k, quad[6] = {a, a + 2, a + 3, a, a + 3, a + 1};
        memcpy(p->indices + 6 * k, quad, sizeof quad);
    }
}

/* Normals that a file interpolates past the rim of what is seen, within one flat face: no line, though the face may end
 * less than a pixel farther on. */
static void normals_past_the_rim(void)
{
    const double pixel = 2 * 10 * tan(15 * pi / 180) / 128;
    for (int k = 0; k < 2; k++) {
        shape s = {0};
        shot  drawing;
        shape_past_the_rim(&s, k ? 0.75 * pixel : 0.8);
        if (shot_of_shape(&drawing, &s, "past.glb", shot_line_look("{\"operator\":\"discontinuity\"}"), NULL, &front)) {
            int ink = 0;
            for (int y = 60; y < 68; y++)
                for (int x = 54; x < 74; x++)
                    ink += shot_ink(&drawing, x, y) <= 200;
            check_at_most("edges", ink, 0, "pixels with ink in the middle of a face whose normals turn away, %s",
                          k ? "beside a bend" : "alone");
            shot_release(&drawing);
        }
        shape_release(&s);
    }
}

/* Is there ink within a pixel of a position? */
static bool inked(const shot *s, dvec at)
{
    dvec p = shot_project(s, at);
    for (int k = 0; k < 9; k++) {
        int x = (int)p.x + k % 3 - 1, y = (int)p.y + k / 3 - 1;
        if (x >= 0 && y >= 0 && x < s->width && y < s->height && shot_ink(s, x, y) <= 127)
            return true;
    }
    return false;
}

/* Two parts with a face in one plane, where either may be in front: the rim of the smaller one is a line, what is
 * within is none. The same with one of them a plate that is thin, but there. */
static void parts_in_one_plane(void)
{
    const shot_view view = {.width = 400, .height = 400, .eye = {2, 1.5, 6}, .up = {0, 1, 0}};
    const double    turn = 23 * pi / 180, lift = 0.005 * 3;
    for (int plate = 0; plate < 2; plate++) {
        shape s = {0};
        shot  drawing;
        shape_box(&s, "large", dvec_of(-1, -1, -1), dvec_of(1, 1, 0));
        shape_box(&s, "small", dvec_of(-0.5, -0.5, -0.7), dvec_of(0.5, 0.5, plate ? lift : 0));
        shape_place(&s, dvec_of(0, 0, 1), turn * 180 / pi, dvec_of(0, 0, 0));
        if (shot_of_shape(&drawing, &s, "plane.glb", shot_line_look("{\"operator\":\"discontinuity\"}"), NULL, &view)) {
            int rim = 0, within = 0;
            for (int i = 0; i < 400; i++) {
                double along = (i % 100 + 0.5) / 100 - 0.5, x = i < 200 ? along : (i < 300 ? 0.5 : -0.5),
                       y = i >= 200 ? along : (i < 100 ? 0.5 : -0.5), z = plate ? lift : 0;
                dvec at = {x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn), z};
                rim += inked(&drawing, at);
                within += inked(&drawing, dvec_of(0.85 * at.x, 0.85 * at.y, z)) +
                          inked(&drawing, dvec_of(0.5 * at.x, 0.5 * at.y, z));
            }
            check_at_least("edges", rim, 398, "positions of 400 of the rim of a part that is flush, plate %d", plate);
            check_at_most("edges", within, 0, "positions within it that have ink");
            shot_release(&drawing);
        }
        shape_release(&s);
    }
}

/* A step of 1/1000 of the range: found by the engine's own operator, seen by the four-tap operator with gain, lost
 * in 8 bits. */
static void thousandth(void)
{
    static const char *const lines[] = {"{\"operator\":\"discontinuity\",\"width\":2}",
                                        "{\"operator\":\"four-tap\",\"width\":2,\"gain\":500}"};
    for (int parallel = 0; parallel < 2; parallel++)
        for (int k = 0; k < 2; k++) {
            shape     s = {0}, joined = {0};
            shot      drawing;
            shot_view view = front;
            int       found = 0, false_ink = 0;
            view.orthographic = parallel;
            view.fov_deg = 28;
            step_scene(&s, 0.3, 0.001);
            shape_join(&joined, "one", &s);
            if (!shot_of_shape(&drawing, &joined, "thousandth.ply", shot_line_look(lines[k]), NULL, &view))
                continue;
            for (int y = 30; y < 90; y++) {
                found += channel(&drawing, 63, y, 0) <= 0.5 || channel(&drawing, 64, y, 0) <= 0.5;
                for (int x = 20; x < 108; x++)
                    false_ink += (x < 61 || x > 66) && shot_ink(&drawing, x, y) <= 127;
            }
            check_at_least("E19", found, 60, "rows of 60 in which a step of 1/1000 is a line: %s, %s", lines[k],
                           parallel ? "parallel" : "central");
            check_at_most("E19", false_ink, 0, "ink beside it");
            shot_release(&drawing);
            shape_release(&joined);
            shape_release(&s);
        }
}

/* Pre-filter: the profile of a line gets wider and darker, across a crease (its inner channel) and across a depth
 * step. The seed's "factor -0.1" can be read two ways; the one in which each neighbour weighs -0.1 (`sharpen` 0.1)
 * does it. */
static void prefilter(void)
{
    const shot_view close = {
        .width = 128, .height = 128, .eye = {0, 0, 4}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 10};
    for (int kind = 0; kind < 2; kind++) {
        double sum[3] = {0}, width[3] = {0}, least[3] = {1, 1, 1};
        for (int k = 0; k < 3; k++) {
            static const char *const amounts[] = {"0", "-0.1", "0.1"};
            const char              *changes[] = {"lines.sharpen", amounts[k], NULL};
            shape                    s = {0};
            shot                     drawing;
            if (kind == 0)
                shape_wedge(&s, "wedge", 45);
            else
                step_scene(&s, 0, 0.3);
            if (shot_of_shape(&drawing, &s, "prefilter.glb", shot_line_look("{\"operator\":\"four-tap\",\"width\":2}"),
                              changes, kind ? &front : &close))
                for (int x = 50; x < 78; x++) {
                    double ink = 1 - channel(&drawing, x, 60, kind ? 0 : 1);
                    sum[k] += ink;
                    width[k] += ink > 1.5 / 255;
                    least[k] = fmin(least[k], 1 - ink);
                }
            shot_release(&drawing);
            shape_release(&s);
        }
        const char *what = kind ? "depth step" : "crease";
        check_note("%s, sharpen 0: width %g, ink %.3f, darkest %.3f; -0.1: %g, %.3f, %.3f; +0.1: %g, %.3f, %.3f", what,
                   width[0], sum[0], least[0], width[1], sum[1], least[1], width[2], sum[2], least[2]);
        check_at_least("P6", width[2], width[0] + 1, "%s: width in px when neighbours weigh -0.1", what);
        check_at_least("P6", sum[2], sum[0] + 0.01, "%s: ink across the line", what);
        check_at_most("P6", least[2], least[0] - 0.01, "%s: its darkest place", what);
    }
}

/* --- ids ------------------------------------------------------------------------------------------------ */

/* Boxes side by side whose fronts lie in one plane, and one a hair in front. */
static void id_scene(shape *s)
{
    shape_box(s, "a", dvec_of(-2, -1, -1), dvec_of(-0.7, 1, 0));
    shape_box(s, "b", dvec_of(-0.7, -1, -1), dvec_of(0.5, 1, 0));
    shape_box(s, "c", dvec_of(0.5, -1, -1), dvec_of(2, 1, 0));
    shape_box(s, "plate", dvec_of(-0.3, -0.4, -0.5), dvec_of(1.1, 0.5, 0.0001));
}

/* Between "a straight neighbour has another id" (must be ink) and "one of all eight has" (may be ink). */
static void judge_ids(const shot *s, bool id_channel, const char *title)
{
    int missing = 0, wrong = 0, borders = 0;
    for (int y = 1; y + 1 < s->height; y++)
        for (int x = 1; x + 1 < s->width; x++) {
            bool straight = false, any = false,
                 ink = (id_channel ? s->edge[4 * (y * s->width + x) + 3] : shot_ink(s, x, y)) <= 127;
            for (int k = 0; k < 9; k++) {
                bool other = s->id[(y + k / 3 - 1) * s->width + x + k % 3 - 1] != s->id[y * s->width + x];
                any = any || other;
                straight = straight || (other && k % 2 == 1);
            }
            borders += straight;
            missing += straight && !ink;
            wrong += ink && !any;
        }
    check_at_least("E22", borders, 200, "%s: border pixels", title);
    check_at_most("E22", missing, 0, "%s: border pixels without an id line", title);
    check_at_most("E22", wrong, 0, "%s: id ink without a border", title);
}

static void id_edges(void)
{
    const shot_view view = {.width = 256, .height = 200, .eye = {0, 0, 8}, .up = {0, 1, 0}};
    shape           s = {0};
    shot            by_id, by_shape, own;
    id_scene(&s);
    int lines = 0, shape_lines = 0;
    if (shot_of_shape(&by_id, &s, "ids.glb", shot_line_look("{\"operator\":\"id\",\"width\":2}"), NULL, &view))
        judge_ids(&by_id, true, "id");
    if (shot_of_shape(&own, &s, "ids.glb", shot_line_look("{\"operator\":\"discontinuity\",\"width\":2}"), NULL, &view))
        judge_ids(&own, false, "discontinuity");
    if (shot_of_shape(&by_shape, &s, "ids.glb", shot_line_look("{\"operator\":\"four-tap\",\"width\":2}"), NULL,
                      &view) &&
        by_id.edge)
        for (int y = 0; y < view.height; y++) {
            dvec seam = shot_project(&by_id, dvec_of(-0.7, 0, 0));
            int  x = (int)floor(seam.x);
            if (isinf(by_id.depth[y * view.width + x]) || isinf(by_id.depth[(y > 2 ? y - 3 : 0) * view.width + x]) ||
                isinf(by_id.depth[(y + 3 < view.height ? y + 3 : y) * view.width + x]))
                continue;
            lines += by_id.edge[4 * (y * view.width + x) + 3] <= 127;
            shape_lines += channel(&by_shape, x, y, 2) < 0.95;
        }
    check_at_least("E22", lines, 60, "rows in which coplanar neighbours are separated by an id line");
    check_at_most("E22", shape_lines, 0, "rows in which depth or normal would have done it");
    shot_release(&by_id);
    shot_release(&by_shape);
    shot_release(&own);
    shape_release(&s);
}

/* --- colour and bumps ----------------------------------------------------------------------------------- */

enum { TEXTURE = 64 };

/* Four dark panes on a light wall; or, as a normal map, an upright groove in the middle, 45 degrees steep on both
 * sides. */
static void paint(shape_part *p, bool bumps)
{
    uint8_t *pixels = check_alloc(TEXTURE * TEXTURE, 4);
    for (int i = 0; i < TEXTURE * TEXTURE; i++) {
        int     x = i % TEXTURE, y = i / TEXTURE;
        bool    pane = x % 32 >= 8 && x % 32 < 24 && y % 32 >= 8 && y % 32 < 24;
        uint8_t wall[4] = {200, 190, 180, 255}, glass[4] = {40, 60, 110, 255}, up[4] = {128, 128, 255, 255},
                left[4] = {38, 128, 218, 255};
        uint8_t right[4] = {218, 128, 218, 255};
        memcpy(&pixels[4 * i], bumps ? (x < 24 || x >= 40 ? up : x < 32 ? left : right) : (pane ? glass : wall), 4);
    }
    p->texture_size = TEXTURE;
    *(bumps ? &p->normal_map : &p->texture) = pixels;
}

static void painted_windows(void)
{
    const shot_view view = {.width = 256, .height = 256, .eye = {0, 0, 4.8}, .up = {0, 1, 0}};
    shape           s = {0}, ball = {0};
    shot            drawing;
    int             found = 0, wrong = 0;
    shape_quad(&s, "wall", 1, 0);
    paint(&s.parts[0], false);
    if (shot_of_shape(&drawing, &s, "windows.glb", shot_line_look("{\"operator\":\"colour\",\"width\":2,\"gain\":4}"),
                      NULL, &view)) {
        for (int i = 0; i < 1000; i++) {
            dvec p = shot_project(&drawing, dvec_of(-1 + 2 * (8 + 16 * (i % 250) / 250.0) / 64,
                                                    1 - 2 * (8 + 16 * (i / 250 % 2)) / 64.0, 0));
            bool ink = false;
            for (int k = 0; k < 9; k++)
                ink = ink || shot_ink(&drawing, (int)p.x + k % 3 - 1, (int)p.y + k / 3 - 1) <= 127;
            found += ink;
        }
        dvec middle = shot_project(&drawing, dvec_of(-0.5, 0.5, 0)), wall = shot_project(&drawing, dvec_of(0, 0, 0));
        for (int k = 0; k < 49; k++) {
            wrong += shot_ink(&drawing, (int)middle.x + k % 7 - 3, (int)middle.y + k / 7 - 3) < 250;
            wrong += shot_ink(&drawing, (int)wall.x + k % 7 - 3, (int)wall.y + k / 7 - 3) < 250;
        }
    }
    check_at_least("P13", found, 990, "of 1000 places on painted borders with a line");
    check_at_most("P13", wrong, 0, "ink inside panes and on the wall");
    shot_release(&drawing);
    shape_sphere(&ball, "ball", dvec_of(0, 0, 0), 1, 64, 128, true);
    const char *changes[] = {"surface.technique", "lambert", NULL};
    wrong = 0;
    if (shot_of_shape(&drawing, &ball, "gradient.ply",
                      shot_line_look("{\"operator\":\"colour\",\"width\":2,\"gain\":4}"), changes, &view))
        for (int i = 0; i < 256 * 256; i++)
            if (!isinf(drawing.depth[i]) && drawing.normal[i][2] > 0.4f)
                wrong += shot_ink(&drawing, i % 256, i / 256) < 254;
    check_at_most("P13", wrong, 0, "lines that a gradient of light makes");
    shot_release(&drawing);
    shape_release(&s);
    shape_release(&ball);
}

static void bumps(void)
{
    static const char *const lines[] = {
        "{\"operator\":\"four-tap\",\"width\":2}", "{\"operator\":\"denormal\",\"width\":2}",
        "{\"operator\":\"discontinuity\",\"width\":2}", "{\"operator\":\"sobel\",\"width\":2}"};
    const shot_view view = {.width = 256, .height = 256, .eye = {0, 0, 10}, .up = {0, 1, 0}};
    for (int k = 0; k < 4; k++) {
        shape s = {0};
        shot  drawing;
        int   found = 0, wrong = 0;
        shape_quad(&s, "wall", 1, 0);
        paint(&s.parts[0], true);
        if (shot_of_shape(&drawing, &s, "bumps.glb", shot_line_look(lines[k]), NULL, &view))
            for (int y = 88; y < 168; y++) {
                bool ink = false;
                for (int x = 126; x < 130; x++)
                    ink = ink || channel(&drawing, x, y, 1) <= 0.5;
                found += ink;
                for (int x = 90; x < 105; x++)
                    wrong += shot_ink(&drawing, x, y) < 253;
            }
        check_at_least("P14", found, 80, "rows in which the groove's bottom is an inner line: %s", lines[k]);
        check_at_most("P14", wrong, 0, "ink on the wall beside it");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* --- properties ----------------------------------------------------------------------------------------- */

/* Lines of every direction and of both signs: around a sphere in each of 32 sectors, and on both sides of a plate. */
static void all_directions(void)
{
    static const char *const lines[] = {"{\"operator\":\"sobel\",\"width\":2,\"gain\":8}",
                                        "{\"operator\":\"sobel\",\"width\":2,\"gain\":8,\"taps\":\"eight\"}",
                                        "{\"operator\":\"four-tap\",\"width\":2,\"gain\":8}",
                                        "{\"operator\":\"saito\",\"width\":2,\"gain\":8}",
                                        "{\"operator\":\"discontinuity\",\"width\":2}"};
    const shot_view          view = {.width = 200, .height = 200, .eye = {0, 0, 8}, .up = {0, 1, 0}, .fov_deg = 20};
    for (int k = 0; k < 5; k++) {
        shape s = {0};
        shot  drawing;
        int   sectors[32] = {0}, empty = 0;
        shape_sphere(&s, "ball", dvec_of(0, 0, 0.5), 0.8, 64, 128, true);
        shape_quad(&s, "wall", 3, -1);
        if (shot_of_shape(&drawing, &s, "ball.glb", shot_line_look(lines[k]), NULL, &view))
            for (int i = 0; i < 200 * 200; i++) {
                double x = i % 200 - 99.5, y = i / 200 - 99.5;
                if (shot_ink(&drawing, i % 200, i / 200) <= 127 && drawing.edge[4 * i] <= 127)
                    sectors[(int)((atan2(y, x) / pi + 1) * 16) % 32]++;
            }
        for (int i = 0; i < 32; i++)
            empty += sectors[i] == 0;
        check_at_most("OI-05", empty, 0, "of 32 sectors without a profile line: %s", lines[k]);
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A depth step between equal normals: nothing for the plain filter, a line when depth is a unit vector too. */
static void depth_as_vector(void)
{
    static const char *const lines[] = {"{\"operator\":\"denormal\",\"width\":2}",
                                        "{\"operator\":\"denormal\",\"width\":2,\"depth\":true}"};
    for (int k = 0; k < 2; k++) {
        shape  s = {0};
        shot   drawing;
        double least = 1;
        step_scene(&s, 0, 0.4);
        if (shot_of_shape(&drawing, &s, "vector.glb", shot_line_look(lines[k]), NULL, &front))
            for (int x = 60; x < 68; x++)
                least = fmin(least, channel(&drawing, x, 60, 2));
        if (k == 0)
            check_near("OI-08", least, 1, 0, "without depth a step of equal normals gives nothing");
        else
            check_at_most("OI-08", least, 0.5, "with depth it is a line");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* The filter takes one fetch a pixel: the shader is read, without the part that adds depth. */
static void one_fetch(void)
{
    FILE *file = fopen(LIMNER_SOURCE "/lines/edge/denormal.frag", "r");
    char  line[512];
    int   fetches = 0;
    bool  extra = false;
    while (file && fgets(line, sizeof line, file)) {
        extra = strncmp(line, "#if DEPTH", 9) == 0 || (extra && strncmp(line, "#endif", 6) != 0);
        fetches += !extra && (strstr(line, "texture") || strstr(line, "texel(") || strstr(line, "texelFetch") ||
                              strstr(line, "bilinear("));
    }
    if (file)
        fclose(file);
    check_near("OI-06", fetches, 1, 0, "lines of the denormalisation shader that fetch");
}

/* I1 answers on both sides of a jump and makes two lines; the normalised operator must not. */
static void double_lines(void)
{
    static const char *const lines[] = {"{\"operator\":\"saito\",\"width\":2,\"gain\":8}",
                                        "{\"operator\":\"saito-normalised\",\"width\":2}"};
    const shot_view          view = {.width = 240, .height = 240, .eye = {0, 0, 8}, .up = {0, 1, 0}, .fov_deg = 20};
    int                      doubled[2] = {0, 0}, profile[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        shape s = {0};
        shot  drawing;
        shape_sphere(&s, "ball", dvec_of(0, 0, 0.5), 0.8, 96, 192, true);
        shape_quad(&s, "wall", 3, -1);
        if (shot_of_shape(&drawing, &s, "double.glb", shot_line_look(lines[k]), NULL, &view))
            for (int i = 0; i < 240 * 240; i++) {
                doubled[k] += drawing.edge[4 * i + 1] <= 127;
                profile[k] += drawing.edge[4 * i] <= 127;
            }
        shot_release(&drawing);
        shape_release(&s);
    }
    check_note("second-order ink on a sphere before a wall: saito %d px, normalised %d px; profile %d and %d px",
               doubled[0], doubled[1], profile[0], profile[1]);
    check_at_least("E26", doubled[0], 200, "I1 doubles the outline (px)");
    check_at_most("E26", doubled[1], 0.05 * doubled[0], "the normalised operator does not (px)");
    check_at_least("E26", profile[1], 200, "and keeps the profile (px)");
}

/* Equation 2 draws broader than equation 3 at the gains that are printed. */
static void pencil_breadth(void)
{
    static const char *const lines[] = {"{\"operator\":\"four-tap\",\"width\":2}",
                                        "{\"operator\":\"saito\",\"width\":2,\"weights\":\"pencil\"}"};
    const shot_view          view = {.width = 240, .height = 240, .eye = {4, 3, 5}, .up = {0, 1, 0}};
    int                      broad[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        shape s = {0};
        shot  drawing;
        shape_torus(&s, "ring", 0.9, 0.3, 96, 48);
        if (shot_of_shape(&drawing, &s, "breadth.ply", shot_line_look(lines[k]), NULL, &view))
            for (int i = 0; i < 240 * 240; i++)
                broad[k] += drawing.edge[4 * i] < 245;
        shot_release(&drawing);
        shape_release(&s);
    }
    check_at_least("P4", broad[0], 1.05 * broad[1], "pixels of lines by equation 2, against equation 3");
}

/* What a report says of the passes that find lines: their names, and how often each is drawn. */
static void passes_of(const shot *s, char *out, size_t size)
{
    const char *at = strstr(s->report, "\"passes\"");
    *out = '\0';
    while (at && (at = strstr(at, "\"name\"")) != NULL) {
        const char *name = strchr(strchr(at, ':'), '"') + 1, *draws = strstr(at, "\"draws\"");
        size_t      length = strcspn(name, "\""), used = strlen(out);
        if (draws && (strncmp(name, "lines: ", 7) == 0 || strncmp(name, "compose: ", 9) == 0))
            snprintf(out + used, size - used, "%.*s x %ld; ", (int)length, name,
                     strtol(strchr(draws, ':') + 1, NULL, 10));
        at++;
    }
}

/* Rows E25, Grossmann 12: finding lines costs as much whatever the mesh: the same passes over the same pixels, as
 * often, with four times the triangles. */
static void cost_is_of_pixels(void)
{
    static const char *const names[] = {"discontinuity", "four-tap", "sobel", "saito", "denormal", "id"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char lines[64], passes[2][600];
        snprintf(lines, sizeof lines, "{\"operator\":\"%s\"}", names[k]);
        for (int fine = 0; fine < 2; fine++) {
            shape     s = {0};
            shot      drawn;
            shot_view view = {
                .width = 200, .height = 200, .eye = {2, 3, 4}, .up = {0, 1, 0}, .profile = true, .without_maps = true};
            passes[fine][0] = '\0';
            shape_torus(&s, "torus", 1, 0.4, fine ? 320 : 160, fine ? 156 : 78); /* 24,960 and 99,840 triangles */
            if (shot_of_shape(&drawn, &s, "cost.ply", shot_line_look(lines), NULL, &view)) {
                passes_of(&drawn, passes[fine], sizeof passes[fine]);
                shot_release(&drawn);
            }
            shape_release(&s);
        }
        check_that("E25", strlen(passes[0]) > 10 && strcmp(passes[0], passes[1]) == 0,
                   "%s of 24,960 triangles: %sof 99,840: %s", names[k], passes[0], passes[1]);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"cost", cost_is_of_pixels},
        {"twins", twins},
        {"steps", steps},
        {"creases", creases},
        {"thousandth", thousandth},
        {"past-the-rim", normals_past_the_rim},
        {"one-plane", parts_in_one_plane},
        {"prefilter", prefilter},
        {"ids", id_edges},
        {"windows", painted_windows},
        {"bumps", bumps},
        {"directions", all_directions},
        {"vector", depth_as_vector},
        {"double", double_lines},
        {"breadth", pencil_breadth},
        {"fetch", one_fetch},
    };
    int status = check_main(argc, argv, "operators", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
