/* Lines that stop short of what is in front of them: how wide the gap is, and what must stay. Row P35. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

#define LINES "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"faint\":20,\"crease\":30}"

static const shot_view straight = {
    .width = 480, .height = 420, .eye = {0, 0, 9}, .up = {0, 1, 0}, .without_maps = true};

/* 0 = paper, 1 = black. */
static double darkness(const shot *s, double x, double y)
{
    int column = (int)floor(x), row = (int)floor(y);
    return column < 0 || row < 0 || column >= s->width || row >= s->height
               ? 0
               : 1 - picture_shown(s->picture[4 * (row * s->width + column)]);
}

static double most_beside(const shot *s, dvec at, double ux, double uy)
{
    double most = 0;
    for (double across = -1; across <= 1; across += 0.5)
        most = fmax(most, darkness(s, at.x - across * uy, at.y + across * ux));
    return most;
}

static dvec crossing(dvec a, dvec b, dvec c, dvec d)
{
    double ax = b.x - a.x, ay = b.y - a.y, cx = d.x - c.x, cy = d.y - c.y;
    double along = ((c.x - a.x) * cy - (c.y - a.y) * cx) / (ax * cy - ay * cx);
    return dvec_of(a.x + along * ax, a.y + along * ay, 0);
}

static bool draw(shot *out, const shape *s, const char *halo, const char *width, const shot_view *view)
{
    const char *changes[] = {"lines.halo", halo, "lines.width", width, NULL};
    return shot_of_shape(out, s, "halo.glb", shot_line_look(LINES), changes, view);
}

/* --- a plate before a bar ------------------------------------------------------------------------------- */

static const double plate_half = 0.3, plate_front = 1.2, bar_half = 0.55;

static void plate_and_bar(shape *s, double bar_front)
{
    shape_box(s, "plate", dvec_of(-plate_half, -1.6, plate_front - 0.2), dvec_of(plate_half, 1.6, plate_front));
    shape_box(s, "bar", dvec_of(-1.9, -bar_half, bar_front - 0.3), dvec_of(1.9, bar_half, bar_front));
}

/* The darkest position on the axis of a line, or within a pixel of it along the outline that it passes behind. */
static double most_along(const shot *s, dvec at, dvec outline)
{
    double most = 0;
    for (double along = -1; along <= 1; along += 0.5)
        most = fmax(most, darkness(s, at.x + along * outline.x, at.y + along * outline.y));
    return most;
}

/* The paper between the plate's outline and where a line of the bar begins again, across the outline: a halo is as wide
 * whatever the slant at which lines pass behind. Negative: there is none. */
static double gap_of(const shot *s, double bar_front, int side, int line)
{
    double x = side ? plate_half : -plate_half, y = line ? bar_half : -bar_half;
    dvec   near_end = shot_project(s, dvec_of(0, y, bar_front)),
         far_end = shot_project(s, dvec_of(side ? 1.7 : -1.7, y, bar_front)),
         low = shot_project(s, dvec_of(x, -1, plate_front)), high = shot_project(s, dvec_of(x, 1, plate_front));
    dvec   from = crossing(near_end, far_end, low, high);
    double length = hypot(far_end.x - from.x, far_end.y - from.y), height = hypot(high.x - low.x, high.y - low.y);
    dvec   way = {(far_end.x - from.x) / length, (far_end.y - from.y) / length, 0},
         outline = {(high.x - low.x) / height, (high.y - low.y) / height, 0};
    double across = fabs(way.x * outline.y - way.y * outline.x), ends = 0, begins = -1;
    for (double along = 0; along < length - 4 && begins < 0; along += 0.125 / across) {
        bool ink = most_along(s, dvec_of(from.x + along * way.x, from.y + along * way.y, 0), outline) > 0.5;
        if (!ink && ends == 0)
            ends = along * across;
        else if (ink && ends > 0)
            begins = along * across;
    }
    return begins - ends;
}

typedef struct gap_case {
    const char *halo, *width;
    double      bar_front, roll;
    bool        orthographic;
    int         samples;
} gap_case;

static void check_gaps(const gap_case *c)
{
    shot_view view = straight;
    shape     s = {0};
    shot      drawing;
    view.up = dvec_of(c->roll, 1, 0);
    view.orthographic = c->orthographic;
    view.samples = c->samples;
    plate_and_bar(&s, c->bar_front);
    if (draw(&drawing, &s, c->halo, c->width, &view)) {
        double least = 1e9, most = -1e9;
        for (int i = 0; i < 4; i++) {
            double gap = gap_of(&drawing, c->bar_front, i % 2, i / 2);
            least = fmin(least, gap);
            most = fmax(most, gap);
        }
        check_near("P35", least, atof(c->halo), 1,
                   "px of gap beside a plate, halo %s px, lines of %s px, bar at %g, rolled %g, %s, %d samples",
                   c->halo, c->width, c->bar_front, c->roll, c->orthographic ? "parallel" : "perspective",
                   c->samples ? c->samples : 1);
        check_near("P35", most, atof(c->halo), 1, "  the widest of four");
    }
    shot_release(&drawing);
    shape_release(&s);
}

static void gaps(void)
{
    static const char *const halos[] = {"2px", "4px", "8px", "12px"}, *const widths[] = {"1px", "2px", "5px"};
    for (int h = 0; h < 4; h++)
        for (int w = 0; w < 3; w++)
            for (int roll = 0; roll < 3; roll++)
                check_gaps(&(gap_case){halos[h], widths[w], 0, 0.31 * roll, false, 0});
    for (int h = 1; h < 4; h++)
        for (int parallel = 0; parallel < 2; parallel++)
            for (int fine = 0; fine < 2; fine++)
                for (int depth = 0; depth < 2; depth++)
                    check_gaps(
                        &(gap_case){halos[h], depth ? "2px" : "3px", depth ? -6 : 0.7, 0.4, parallel, fine ? 4 : 1});
}

/* Where lines meet at a corner, what their soft rims have beyond it may become as much lighter, of 255: pixels of
 * outlines do not tell whose it is. */
enum { SOFT_RIM = 64 };

/* --- what stays ----------------------------------------------------------------------------------------- */

/* The plate itself, its outline on either side, and whatever is farther away than the halo. */
static void near_object_stays(void)
{
    for (int parallel = 0; parallel < 2; parallel++) {
        shot_view view = straight;
        shape     s = {0};
        shot      plain, haloed;
        view.without_maps = false;
        view.up = dvec_of(0.27, 1, 0);
        view.eye = dvec_of(1.5, 1.1, 9);
        view.orthographic = parallel;
        plate_and_bar(&s, 0);
        bool good = draw(&plain, &s, "0px", "2px", &view);
        if (draw(&haloed, &s, "8px", "2px", &view) && good) {
            int on_plate = 0, beside = 0, away = 0, gone = 0;
            for (int y = 0; y < plain.height; y++)
                for (int x = 0; x < plain.width; x++) {
                    int    i = y * plain.width + x;
                    double nearest = 1e9;
                    if (abs(plain.picture[4 * i] - haloed.picture[4 * i]) <= SOFT_RIM)
                        continue;
                    gone++;
                    on_plate += plain.id[i] == 1;
                    for (int v = -12; v <= 12; v++)
                        for (int u = -12; u <= 12; u++)
                            if (x + u >= 0 && y + v >= 0 && x + u < plain.width && y + v < plain.height &&
                                plain.id[(y + v) * plain.width + x + u] == 1)
                                nearest = fmin(nearest, hypot(u, v));
                    beside += nearest < 1.5;
                    away += nearest > 10.5;
                }
            check_at_least("P35", gone, 40, "pixels that a halo of 8 px takes");
            check_at_most("P35", on_plate, 0, "of them on the near object");
            check_at_most("P35", beside, 0, "of them its outline's own on the farther side");
            check_at_most("P35", away, 0, "of them beyond the halo");
            check_that("P35", memcmp(plain.edge, haloed.edge, (size_t)plain.width * (size_t)plain.height * 4) == 0,
                       "maps show what was detected");
        }
        shot_release(&plain);
        shot_release(&haloed);
        shape_release(&s);
    }
}

static void add_sphere(shape *s)
{
    shape_sphere(s, "ball", dvec_of(0, 0, 0), 1.5, 48, 96, true);
}

static void add_coarse_sphere(shape *s)
{
    shape_sphere(s, "ball", dvec_of(0, 0, 0), 1.5, 12, 20, true);
}

static void add_box(shape *s)
{
    shape_box(s, "box", dvec_of(-1.4, -1, -1.2), dvec_of(1.2, 1.1, 1.3));
}

/* As long as a street, seen along its side. */
static void add_long_box(shape *s)
{
    shape_box(s, "row", dvec_of(0.8, -1, -60), dvec_of(3, 2, 6));
}

static void add_wedge(shape *s)
{
    shape_wedge(s, "wedge", 70);
}

/* Nothing of a convex body is in front of anything else of it. */
static void convex_bodies_stay(void)
{
    static void (*const bodies[])(shape *) = {add_sphere, add_coarse_sphere, add_box, add_long_box, add_wedge};
    static const char *const names[] = {"a sphere", "a coarse sphere", "a box", "a row of houses along the view",
                                        "a fold"};
    static const dvec        eyes[] = {{0.3, 0.4, 8}, {4, 3, 6}, {-5, 1, 5}, {0.2, 6, 3}};
    for (int b = 0; b < 5; b++)
        for (int e = 0; e < 4; e++)
            for (int parallel = 0; parallel < 2; parallel++) {
                shot_view view = straight;
                shape     s = {0};
                shot      plain, haloed;
                view.eye = eyes[e];
                view.orthographic = parallel;
                view.samples = e == 1 ? 4 : 1;
                bodies[b](&s);
                bool good = draw(&plain, &s, "0px", "2px", &view);
                if (draw(&haloed, &s, "9px", "2px", &view) && good)
                    check_at_most("P35", shot_differing(&plain, &haloed, SOFT_RIM), 3, /* a pixel */
                                  "values of %s that change, eye %d, %s", names[b], e,
                                  parallel ? "parallel" : "perspective");
                shot_release(&plain);
                shot_release(&haloed);
                shape_release(&s);
            }
}

/* Off is what it was, whatever else is set; drawn twice and in the other dialect it is the same. */
static void same_again(void)
{
    shot_view other = straight;
    shape     s = {0};
    shot      plain, zero, run, again, es;
    other.es = true;
    plate_and_bar(&s, 0);
    bool good = shot_of_shape(&plain, &s, "halo.glb", shot_line_look(LINES), NULL, &straight);
    if (draw(&zero, &s, "0px", "2px", &straight) && good)
        check_at_most("P35", shot_differing(&plain, &zero, 0), 0, "values that halo 0 changes");
    good = draw(&run, &s, "6px", "2px", &straight);
    if (draw(&again, &s, "6px", "2px", &straight) && good)
        check_at_most("P35", shot_differing(&run, &again, 0), 0, "values that differ in a second drawing");
    if (draw(&es, &s, "6px", "2px", &other) && good)
        check_at_most("GLES", shot_differing(&run, &es, 1), 0, "values that differ in the other dialect");
    shot_release(&plain);
    shot_release(&zero);
    shot_release(&run);
    shot_release(&again);
    shot_release(&es);
    shape_release(&s);
}

/* --- round outlines ------------------------------------------------------------------------------------- */

/* A ball before a larger one: all ink of the larger one's outline by its distance from the nearer one's, a circle. */
static void balls(void)
{
    static const char *const halos[] = {"4px", "8px", "14px"};
    for (int h = 0; h < 3; h++) {
        const double halo = atof(halos[h]), radius = 0.8;
        const dvec   centre = {1.15, 0.5, 2};
        shot_view    view = straight;
        shape        s = {0};
        shot         plain, haloed;
        view.orthographic = true;
        shape_sphere(&s, "near", centre, radius, 64, 128, true);
        shape_sphere(&s, "far", dvec_of(0, 0, -1), 1.5, 64, 128, true);
        bool good = draw(&plain, &s, "0px", "2px", &view);
        if (draw(&haloed, &s, halos[h], "2px", &view) && good) {
            dvec middle = shot_project(&plain, centre),
                 rim = shot_project(&plain, dvec_of(centre.x + radius, centre.y, centre.z));
            int left = 0, changed = 0, within = 0;
            for (int y = 0; y < plain.height; y++)
                for (int x = 0; x < plain.width; x++) {
                    double away =
                        hypot(x + 0.5 - middle.x, y + 0.5 - middle.y) - hypot(rim.x - middle.x, rim.y - middle.y);
                    double before = darkness(&plain, x, y), after = darkness(&haloed, x, y);
                    bool   inside = away > 2 && away < halo;
                    within += inside && before > 0.5;
                    left += inside && after > 0.5;
                    changed += (away < 0.4 || away > halo + 2.6) && fabs(before - after) > 0.01;
                }
            check_at_least("P35", within, halo, "pixels of a far ball's outline within a halo of %s px", halos[h]);
            check_at_most("P35", left, 0, "of them that are left");
            check_at_most("P35", changed, 0, "pixels on the near ball, its outline or beyond the halo that change");
        }
        shot_release(&plain);
        shot_release(&haloed);
        shape_release(&s);
    }
}

/* Lines that run on, dashes and broad lines with a halo: strokes of the near object stay. */
static void with_overshoot(void)
{
    shape s = {0};
    shot  plain, haloed;
    plate_and_bar(&s, 0);
    const char *before[] = {"lines.overshoot", "14px", NULL},
               *after[] = {"lines.overshoot", "14px", "lines.halo", "7px", NULL};
    bool good = shot_of_shape(&plain, &s, "halo.glb", shot_line_look(LINES), before, &straight);
    if (shot_of_shape(&haloed, &s, "halo.glb", shot_line_look(LINES), after, &straight) && good) {
        int stays = 0;
        for (int side = 0; side < 2; side++)
            for (int end = 0; end < 2; end++) {
                dvec low = shot_project(&haloed, dvec_of(side ? 0.3 : -0.3, end ? -1.6 : 1.6, plate_front)),
                     high = shot_project(&haloed, dvec_of(side ? 0.3 : -0.3, end ? 1.6 : -1.6, plate_front));
                double length = hypot(high.x - low.x, high.y - low.y), ux = (high.x - low.x) / length,
                       uy = (high.y - low.y) / length;
                bool same = true;
                for (double along = length; along < length + 8; along++) {
                    dvec at = dvec_of(low.x + along * ux, low.y + along * uy, 0);
                    same = same && fabs(most_beside(&plain, at, ux, uy) - most_beside(&haloed, at, ux, uy)) < 0.05;
                }
                stays += same;
            }
        check_at_least("P35", stays, 4, "ends of the plate's sides that run on as they did");
        for (int i = 0; i < 4; i++)
            check_near("P35", gap_of(&haloed, 0, i % 2, i / 2), 7, 1, "px of gap with lines that run on");
    }
    shot_release(&plain);
    shot_release(&haloed);
    shape_release(&s);
}

/* What is in front may be drawn by another rule, and with another operator. */
static void among_others(void)
{
    static const char *const operators[] = {"discontinuity", "id", "four-tap", "sobel"};
    for (int o = 0; o < 4; o++) {
        char  look[768];
        shape s = {0};
        shot  drawing;
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":["
                 "{\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{"
                 "\"operator\":\"%s\",\"colour\":\"#000000\","
                 "\"gain\":8,\"halo\":8}},"
                 "{\"select\":\"plate\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{"
                 "\"operator\":\"%s\",\"colour\":"
                 "\"#000000\",\"gain\":8}}]}",
                 operators[o], operators[o]);
        plate_and_bar(&s, 0);
        if (shot_of_shape(&drawing, &s, "halo.glb", look, NULL, &straight))
            for (int i = 0; i < 4; i++)
                check_near("P35", gap_of(&drawing, 0, i % 2, i / 2), 8, 1,
                           "px of gap beside what another rule draws, operator %s", operators[o]);
        shot_release(&drawing);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"gaps", gaps},   {"near", near_object_stays},   {"convex", convex_bodies_stay}, {"same", same_again},
        {"balls", balls}, {"overshoot", with_overshoot}, {"others", among_others},
    };
    int status = check_main(argc, argv, "halo", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
