/* Towns at any scale: lines between buildings, ground and roads wherever these meet; passes that cost the same however
 * many buildings there are, far quarters that stay calm; and people beside facades that say how high they are. Nienhaus
 * 2005, section 4.8; rows C08, C13, C14. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 480, PIXELS = SIDE * SIDE };

/* --- lines where things meet ---------------------------------------------------------------------------- */

enum { LEFT_LAWN = 1, ROAD, RIGHT_LAWN, FIRST_HOUSE, SECOND_HOUSE, MEETINGS = 3 };

/* Which of the meetings two neighbours are: houses, a house and its lawn, a lawn and the road; −1: another one. */
static int meeting_of(int a, int b)
{
    int low = a < b ? a : b, high = a < b ? b : a;
    if (low == FIRST_HOUSE && high == SECOND_HOUSE)
        return 0;
    if (low == RIGHT_LAWN && high >= FIRST_HOUSE)
        return 1;
    return (low == LEFT_LAWN && high == ROAD) || (low == ROAD && high == RIGHT_LAWN) ? 2 : -1;
}

/* By an operator on a picture of a scene with these parts. */
static void check_meetings(const shape *s, const char *lines)
{
    static const char *const names[MEETINGS] = {"houses", "a house and its lawn", "a lawn and the road"};
    char                     look[500];
    int                      met[MEETINGS] = {0}, inked[MEETINGS] = {0}, alone = 0, blots = 0;
    shot                     got;
    shot_view                view = {
                       .width = SIDE, .height = SIDE, .eye = {5, 34, 74}, .target = {24, 2, 18}, .up = {0, 1, 0}, .fov_deg = 40};
    snprintf(look, sizeof look,
             "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":"
             "\"tones\","
             "\"palette\":[\"#ffffff\",\"#ffffff\"],\"tint\":0},\"lines\":{\"operator\":\"%s\",\"width\":2,\"colour\":"
             "\"#000000\"}}]}",
             lines);
    if (!shot_of_shape(&got, s, "meet.glb", look, NULL, &view))
        return;
    for (int y = 4; y < SIDE - 4; y++)
        for (int x = 4; x < SIDE - 4; x++) {
            int  own = got.id[y * SIDE + x], ink = shot_ink(&got, x, y);
            bool beside = own == 0 || own > RIGHT_LAWN;
            for (int k = -4; k <= 4; k++)
                for (int i = -4; i <= 4; i++)
                    beside = beside || got.id[(y + k) * SIDE + x + i] != own;
            alone += !beside;
            blots += !beside && ink <= 127;
            for (int side = 0; side < 2; side++) {
                int other = got.id[(y + side) * SIDE + x + 1 - side], kind = meeting_of(own, other);
                if (kind < 0)
                    continue;
                met[kind]++;
                inked[kind] += ink <= 127 || shot_ink(&got, x + 1 - side, y + side) <= 127;
            }
        }
    for (int k = 0; k < MEETINGS; k++) {
        check_at_least("C08", met[k], 60, "%s: pairs of pixels between %s", lines, names[k]);
        check_at_least("C08", (double)inked[k] / met[k], 0.99, "share of them with a line between %s", names[k]);
    }
    check_at_least("C08", alone, 5000, "%s: pixels of lawns and road, away from all borders", lines);
    check_at_most("C08", blots, 0, "of which have ink");
    shot_release(&got);
}

/* Row C08: two houses wall to wall, of one height and one front, on a lawn in one plane with the road and with another
 * lawn: neither depth nor normals tell them apart, and all have the same colour. Their numbers do, and the edges of
 * their meshes. */
static void lines_lie_where_things_meet(void)
{
    shape s = {0};
    shape_box(&s, "left lawn", dvec_of(-20, -1, 0), dvec_of(10, 0, 120));
    shape_box(&s, "road", dvec_of(10, -1, 0), dvec_of(16, 0, 120));
    shape_box(&s, "right lawn", dvec_of(16, -1, 0), dvec_of(60, 0, 120));
    shape_box(&s, "first house", dvec_of(22, 0, 10), dvec_of(34, 9, 22));
    shape_box(&s, "second house", dvec_of(34, 0, 10), dvec_of(46, 9, 22));
    check_meetings(&s, "id");
    check_meetings(&s, "discontinuity");
    shape_release(&s);
}

/* --- many buildings -------------------------------------------------------------------------------------- */

static void build_town(shape *s, int rows)
{
    uint32_t random = 3;
    for (int i = 0; i < rows * rows; i++) {
        double r[3];
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            r[k] = (random >> 8) / 16777216.0;
        }
        double x = 25.0 * (i % rows - rows / 2), z = -25.0 * (i / rows);
        char   name[16];
        snprintf(name, sizeof name, "block%d", i);
        shape_box(s, name, dvec_of(x, 0, z), dvec_of(x + 10 + 8 * r[0], 6 + 18 * r[1] * r[1], z + 10 + 8 * r[2]));
    }
}

/* How often passes whose name begins so are drawn with, by the report. */
static int draws_of(const shot *s, const char *passes)
{
    int         draws = 0;
    const char *list = strstr(s->report, "\"passes\"");
    for (const char *at = list; at && (at = strstr(at, "\"name\"")); at++) {
        const char *name = strchr(strchr(at, ':'), '"') + 1, *number = strstr(at, "\"draws\"");
        if (!number || strncmp(name, passes, strlen(passes)) != 0 || strncmp(name, "lines: records", 14) == 0)
            continue;
        draws += (int)strtol(strchr(number, ':') + 1, NULL, 10);
    }
    return draws;
}

/* Row C13: a hundred buildings or nine hundred, lines take as many draws; and so do their surfaces and shadows, which
 * lie in the same buffers. */
static void passes_do_not_count_buildings(void)
{
    static const char *const passes[] = {"lines: ", "geometry", "scene: shadow", "compose: "};
    int                      draws[2][4] = {{0}};
    for (int k = 0; k < 2; k++) {
        shape     s = {0};
        shot      got;
        shot_view view = {.width = SIDE,
                          .height = SIDE,
                          .eye = {60, 300, 520},
                          .target = {0, 0, -60},
                          .up = {0, 1, 0},
                          .fov_deg = 50,
                          .profile = true,
                          .without_maps = true};
        build_town(&s, k ? 30 : 10);
        if (shot_of_shape(&got, &s, "town.glb", "city", NULL, &view)) {
            for (int i = 0; i < 4; i++)
                draws[k][i] = draws_of(&got, passes[i]);
            shot_release(&got);
        }
        shape_release(&s);
    }
    for (int i = 0; i < 4; i++) {
        check_at_least("C13", draws[0][i], 1, "draws of '%s' with 100 buildings", passes[i]);
        check_near("C13", draws[1][i], draws[0][i], 0, "and with 900");
    }
}

/* Mean light of squares of 4 × 4 pixels between two rows of the picture. */
static size_t squares_of(const shot *s, int top, int bottom, double *out)
{
    size_t count = 0;
    for (int y = top; y + 4 <= bottom; y += 4)
        for (int x = 0; x + 4 <= SIDE; x += 4) {
            double sum = 0;
            for (int k = 0; k < 16; k++)
                sum += s->picture[4 * ((y + k / 4) * SIDE + x + k % 4)] / 255.0;
            out[count++] = sum / 16;
        }
    return count;
}

/* How much squares between two rows change when the eye moves by less than a pixel there; and how dark they are. */
static double shimmer_of(const shot *a, const shot *b, int top, int bottom, double *dark)
{
    static double one[PIXELS / 16], other[PIXELS / 16];
    size_t        count = squares_of(a, top, bottom, one);
    double        change = 0;
    squares_of(b, top, bottom, other);
    *dark = 0;
    for (size_t i = 0; i < count; i++) {
        change += fabs(one[i] - other[i]) / (double)count;
        *dark += (1 - one[i]) / (double)count;
    }
    return change;
}

/* A town that runs to the horizon, twice, the eye moved by less than a pixel between: how much squares of its far
 * quarter change, and of the near one. NAN: it could not be drawn. */
typedef struct unrest {
    double far, far_dark, near, near_dark;
} unrest;

static unrest unrest_of(const shape *s, const char *look, const char *const *changes)
{
    unrest out = {NAN, NAN, NAN, NAN};
    shot   got[2];
    int    drawn = 0;
    for (int k = 0; k < 2; k++) {
        shot_view view = {.width = SIDE,
                          .height = SIDE,
                          .eye = {0.3 * k, 60, 90},
                          .target = {0.3 * k, 0, -120},
                          .up = {0, 1, 0},
                          .fov_deg = 40,
                          .without_maps = true};
        drawn += shot_of_shape(&got[k], s, "quarter.glb", look, changes, &view);
    }
    if (drawn == 2) {
        out.far = shimmer_of(&got[0], &got[1], 40, 110, &out.far_dark);
        out.near = shimmer_of(&got[0], &got[1], 260, 440, &out.near_dark);
    }
    for (int k = 0; k < drawn; k++)
        shot_release(&got[k]);
    return out;
}

/* Row C13: the far half of a town is no darker than the near one, and does not shimmer: lines that thin out where they
 * crowd leave a good part less of it than lines that keep their width, and facades, which are one tone there, add none.
 */
static void far_quarters_are_calm(void)
{
    static const char *const names[] = {"city", "city-comic"}, *const crowded[] = {"lines.cover", "1", NULL},
                             *const blank[] = {"surface.facade", "none", NULL};
    shape                           s = {0};
    build_town(&s, 30);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        unrest own = unrest_of(&s, names[i], NULL), all = unrest_of(&s, names[i], crowded),
               bare = unrest_of(&s, names[i], blank);
        check_note("%s: near %g changes by %g, far %g by %g; with all lines %g by %g, without facades %g by %g",
                   names[i], own.near_dark, own.near, own.far_dark, own.far, all.far_dark, all.far, bare.far_dark,
                   bare.far);
        check_at_most("C13", own.far, 0.006, "%s: change of far squares of 4 x 4 pixels", names[i]);
        check_at_most("C13", own.far_dark, own.near_dark, "%s: darkness of the far quarter", names[i]);
        check_at_most("C13", own.far_dark / all.far_dark, 0.8, "of their darkness");
        check_at_most("C13", own.far / bare.far, 1.15, "change over that of walls without windows");
    }
    shape_release(&s);
}

/* Mean darkness of what is drawn of a town, from this far. */
static double darkness_from(const shape *s, const char *look, double distance)
{
    shot      got;
    double    dark = 0, count = 0;
    shot_view view = {.width = SIDE,
                      .height = SIDE,
                      .eye = {0, 0.6 * distance, -360 + 0.8 * distance},
                      .target = {0, 0, -360},
                      .up = {0, 1, 0},
                      .orthographic = true,
                      .fov_deg = 30};
    if (!shot_of_shape(&got, s, "quarter.glb", look, NULL, &view))
        return NAN;
    for (int i = 0; i < PIXELS; i++)
        if (got.id[i]) {
            dark += 1 - got.picture[4 * i] / 255.0;
            count++;
        }
    shot_release(&got);
    return dark / count;
}

/* Row C13: seen from far enough that a house is four pixels wide a town is hardly darker than at hand: lines thin out
 * where they crowd, and windows become a tone. */
static void small_towns_are_no_darker(void)
{
    static const char *const names[] = {"city", "city-comic"};
    shape                    s = {0};
    build_town(&s, 30);
    for (size_t i = 0; i < 2; i++) {
        double near = darkness_from(&s, names[i], 300), far = darkness_from(&s, names[i], 3000);
        check_at_least("C13", near, 0.02, "%s: darkness of a quarter near at hand", names[i]);
        check_at_most("C13", far / near, 1.75, "and of the town from ten times as far, over that");
    }
    shape_release(&s);
}

/* --- scale ------------------------------------------------------------------------------------------------ */

/* Row C14: who stands before a house tells how high it is: storeys are three metres where nobody says otherwise, and a
 * person is 1.75. */
static void people_give_scale(void)
{
    static const char look[] = "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"rules\":[{\"select\":\"*\",\"surface\":{"
                               "\"technique\":\"tones\","
                               "\"palette\":[\"#ffffff\",\"#ffffff\"],\"tint\":0,\"glass\":\"#000000\",\"frame\":0,"
                               "\"facade\":\"residential\"},"
                               "\"lines\":{\"operator\":\"discontinuity\",\"width\":1.5,\"colour\":\"#ff0000\"}}]}";
    shape             s = {0};
    shot_view         view = {.width = SIDE,
                              .height = SIDE,
                              .eye = {10.5, 7.5, 60},
                              .target = {10.5, 7.5, 0},
                              .up = {0, 1, 0},
                              .orthographic = true,
                              .fov_deg = 20};
    shot              got;
    shape_box(&s, "house", dvec_of(0, 0, -10), dvec_of(21, 15, 0));
    shape_box(&s, "person", dvec_of(12.0, 0, 0.2), dvec_of(12.5, 1.75, 0.5));
    if (shot_of_shape(&got, &s, "scale.glb", look, NULL, &view)) {
        int top = SIDE, bottom = -1, borders = 0, inked = 0, seen[2] = {-1, -1}, windows = 0;
        for (int y = 1; y < SIDE - 1; y++)
            for (int x = 1; x < SIDE - 1; x++) {
                if (got.id[y * SIDE + x] != 2)
                    continue;
                top = y < top ? y : top;
                bottom = y > bottom ? y : bottom;
                for (int side = 0; side < 3; side++) {
                    int beside_x = x + (side == 0) - (side == 1), beside_y = y - (side == 2);
                    if (got.id[beside_y * SIDE + beside_x] != 1)
                        continue;
                    borders++;
                    inked += shot_ink(&got, x, y) <= 127 || shot_ink(&got, beside_x, beside_y) <= 127;
                }
            }
        /* Up a column through the windows of the second bay: where each begins. */
        double at[2];
        shot_on_page(&got, dvec_of(4.5, 7, 0), at);
        for (int y = 1; y < SIDE; y++) {
            const uint8_t *c = &got.picture[4 * (y * SIDE + (int)at[0])], *above = c - 4 * SIDE;
            if (c[1] < 128 && above[1] >= 128 && c[0] < 128) {
                seen[windows > 0] = y;
                windows++;
            }
        }
        check_at_least("C14", windows, 4, "storeys that are seen");
        double storey = (double)(seen[1] - seen[0]) / (windows - 1), person = bottom - top + 1;
        check_near("C14", storey / person, 3 / 1.75, 0.08, "a storey over a person");
        check_at_least("C14", borders, 20, "pairs of pixels across the person's outline");
        check_at_least("C14", (double)inked / borders, 0.95, "share of them with a line");
        shot_release(&got);
    }
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"meetings", lines_lie_where_things_meet},
        {"draws", passes_do_not_count_buildings},
        {"calm", far_quarters_are_calm},
        {"small", small_towns_are_no_darker},
        {"scale", people_give_scale},
    };
    int status = check_main(argc, argv, "city_scale", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
