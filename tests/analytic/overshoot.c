/* Lines that run on in drawings: how far along the projected edges of a box, what lies in front of them, and what
 * must not change. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

#define LINES       "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"faint\":20,\"crease\":30}"
#define LOOK(RULES) "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[" RULES "]}"
#define FLAT        "\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"}"

static const shot_view box_view = {
    .width = 640, .height = 600, .eye = {5, 3.4, 6.3}, .up = {0.1, 1, 0}, .without_maps = true};

static const double corner[8][3] = {{-1.4, -1, -1.2}, {1.2, -1, -1.2}, {-1.4, 1.1, -1.2}, {1.2, 1.1, -1.2},
                                    {-1.4, -1, 1.3},  {1.2, -1, 1.3},  {-1.4, 1.1, 1.3},  {1.2, 1.1, 1.3}};
/* The nine edges that are seen from in front, right, above, and the three that are not. */
static const int box_edges[12][2] = {{4, 5}, {5, 1}, {1, 3}, {3, 2}, {2, 6}, {6, 4},
                                     {6, 7}, {7, 5}, {7, 3}, {0, 1}, {0, 2}, {0, 4}};

static void box_of(shape *s)
{
    shape_box(s, "box", dvec_of(-1.4, -1, -1.2), dvec_of(1.2, 1.1, 1.3));
}

static void sphere_of(shape *s)
{
    shape_sphere(s, "ball", dvec_of(0, 0, 0), 1.5, 96, 192, true);
}

/* An upright cylinder whose mantle is smooth: normals by a crease angle. */
static void cylinder_of(shape *s)
{
    enum { AROUND = 192 };
    shape_part *p = shape_add(s, "cylinder", 2 * AROUND + 2, 12 * AROUND, false, false);
    for (uint32_t i = 0; i <= AROUND; i++)
        for (uint32_t k = 0; k < 2; k++) {
            double turn = 2 * 3.14159265358979323846 * i / AROUND, r = i == AROUND ? 0 : 1.2, y = k ? 1.3 : -1.3;
            memcpy(p->positions[2 * i + k], (float[]){(float)(r * cos(turn)), (float)y, (float)(r * sin(turn))},
                   sizeof p->positions[0]);
        }
    for (uint32_t i = 0; i < AROUND; i++) {
        uint32_t a = 2 * i, b = 2 * ((i + 1) % AROUND), c = 2 * AROUND;
        memcpy(&p->indices[12 * i], (uint32_t[]){a, a + 1, b + 1, a, b + 1, b, a, b, c, a + 1, c + 1, b + 1},
               12 * sizeof(uint32_t));
    }
    shape_make_normals(s, 40);
}

/* 0 = paper, 1 = black. */
static double darkness(const shot *s, double x, double y)
{
    int column = (int)floor(x), row = (int)floor(y);
    return column < 0 || row < 0 || column >= s->width || row >= s->height
               ? 0
               : 1 - picture_shown(s->picture[4 * (row * s->width + column)]);
}

static dvec corner_at(const shot *s, int i)
{
    return shot_project(s, dvec_of(corner[i][0], corner[i][1], corner[i][2]));
}

/* A point `along` pixels beyond b on the line from a, `across` beside it. */
static dvec beyond(dvec a, dvec b, double along, double across)
{
    double size = hypot(b.x - a.x, b.y - a.y), ux = (b.x - a.x) / size, uy = (b.y - a.y) / size;
    return dvec_of(b.x + along * ux - across * uy, b.y + along * uy + across * ux, 0);
}

/* How far ink goes on beyond b within a pixel of the line from a. Up to `first` other lines are too near to tell. */
static double run_of(const shot *s, dvec a, dvec b, double first)
{
    double along = first;
    for (;; along += 0.25) {
        double most = 0;
        for (double across = -1; across <= 1; across += 0.5) {
            dvec at = beyond(a, b, along, across);
            most = fmax(most, darkness(s, at.x, at.y));
        }
        if (most < 0.12)
            return along;
    }
}

/* The distance from the line between a and b, lengthened on both sides. */
static double distance_to(dvec a, dvec b, double longer, double x, double y)
{
    double size = hypot(b.x - a.x, b.y - a.y), ux = (b.x - a.x) / size, uy = (b.y - a.y) / size;
    double along = (x - a.x) * ux + (y - a.y) * uy, over = fmax(0, fmax(-longer - along, along - size - longer));
    return hypot(over, (x - a.x) * uy - (y - a.y) * ux);
}

/* Lengths vary by 30 %, the tip is faint, and pointed corners are blunt. */
static double least_of(double length)
{
    return 0.7 * length - 4;
}

typedef struct box_verdict {
    double shortest, longest, mean;
    int    strays; /* pixels of ink away from all edges and their continuations */
} box_verdict;

/* The first `count` edges of the box, which should run on by `length`. */
static box_verdict judge_box(const shot *s, int count, double length, double width)
{
    box_verdict v = {1e9, 0, 0, 0};
    for (int e = 0; e < count; e++)
        for (int side = 0; side < 2; side++) {
            double run = run_of(s, corner_at(s, box_edges[e][!side]), corner_at(s, box_edges[e][side]), 3);
            v.shortest = fmin(v.shortest, run);
            v.longest = fmax(v.longest, run);
            v.mean += run / (2 * count);
        }
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double nearest = 1e9;
            if (darkness(s, x, y) < 0.1)
                continue;
            for (int e = 0; e < count; e++)
                nearest = fmin(nearest, distance_to(corner_at(s, box_edges[e][0]), corner_at(s, box_edges[e][1]),
                                                    1.3 * length + 1, x + 0.5, y + 0.5));
            v.strays += nearest > 0.5 * width + 1.5;
        }
    return v;
}

static bool draw(shot *out, void (*make)(shape *), const char *overshoot, const char *width, const char *look,
                 const shot_view *view)
{
    const char *changes[] = {"lines.overshoot", overshoot, "lines.width", width, NULL};
    shape       s = {0};
    make(&s);
    bool good = shot_of_shape(out, &s, "overshoot.glb", look, changes, view);
    shape_release(&s);
    return good;
}

static void edges_of_a_box(void)
{
    static const char *const lengths[] = {"12px", "20px", "32px"};
    for (int roll = 0; roll < 4; roll++)
        for (int i = 0; i < 3; i++)
            for (int parallel = 0; parallel < 2; parallel++) {
                shot_view view = box_view;
                double    length = atof(lengths[i]);
                shot      s;
                view.up = dvec_of(0.4 * roll - 0.7, 1, 0);
                view.orthographic = parallel;
                if (draw(&s, box_of, lengths[i], i == 1 ? "1px" : "2px", shot_line_look(LINES), &view)) {
                    box_verdict v = judge_box(&s, 9, length, 2);
                    check_at_least("overshoot", v.shortest, least_of(length),
                                   "px of the shortest stroke of %s px, rolled %d", lengths[i], roll);
                    check_at_most("overshoot", v.longest, 1.3 * length + 3, "px of the longest");
                    check_near("overshoot", v.mean, length, 0.2 * length + 1, "px on average");
                    check_at_most("overshoot", v.strays, 0, "pixels of ink elsewhere");
                }
                shot_release(&s);
            }
}

static void what_stays(void)
{
    shot      plain, zero, run, again, es;
    shape     s = {0};
    shot_view other = box_view;
    other.es = true;
    box_of(&s);
    bool good = shot_of_shape(&plain, &s, "overshoot.glb", shot_line_look(LINES), NULL, &box_view);
    if (draw(&zero, box_of, "0px", "2px", shot_line_look(LINES), &box_view) && good)
        check_at_most("overshoot", shot_differing(&plain, &zero, 0), 0, "values that overshoot 0 changes");
    good = draw(&run, box_of, "14px", "2px", shot_line_look(LINES), &box_view);
    if (draw(&again, box_of, "14px", "2px", shot_line_look(LINES), &box_view) && good)
        check_at_most("overshoot", shot_differing(&run, &again, 0), 0, "values that differ in a second drawing");
    if (draw(&es, box_of, "14px", "2px", shot_line_look(LINES), &other) && good)
        check_at_most("GLES", shot_differing(&run, &es, 1), 0, "values that differ in the other dialect");
    shot_release(&plain);
    shot_release(&zero);
    shot_release(&run);
    shot_release(&again);
    shot_release(&es);
    shape_release(&s);
    /* Maps show what was detected. */
    shot_view mapped = box_view;
    mapped.without_maps = false;
    good = draw(&zero, box_of, "0px", "2px", shot_line_look(LINES), &mapped);
    if (draw(&run, box_of, "14px", "2px", shot_line_look(LINES), &mapped) && good)
        check_that("overshoot", memcmp(zero.edge, run.edge, (size_t)zero.width * (size_t)zero.height * 4) == 0,
                   "the edge map is the same");
    shot_release(&zero);
    shot_release(&run);
}

static void round_things(void)
{
    shot plain, run;
    for (int i = 0; i < 3; i++) {
        shot_view view = box_view;
        view.eye = dvec_of(2 + 2 * i, 3.4, 6.3);
        bool good = draw(&plain, sphere_of, "0px", "2px", shot_line_look(LINES), &view);
        if (draw(&run, sphere_of, "20px", "2px", shot_line_look(LINES), &view) && good)
            check_at_most("overshoot", shot_differing(&plain, &run, 0), 0, "values of a sphere that change");
        shot_release(&plain);
        shot_release(&run);
    }
    /* A cylinder's sides run on past its rims, and nothing else does. */
    shot_view view = box_view;
    view.up = dvec_of(0, 1, 0);
    view.eye = dvec_of(0, 2.2, 8);
    view.orthographic = true;
    bool good = draw(&plain, cylinder_of, "0px", "2px", shot_line_look(LINES), &view);
    if (draw(&run, cylinder_of, "16px", "2px", shot_line_look(LINES), &view) && good) {
        int elsewhere = 0;
        for (int side = 0; side < 2; side++) {
            dvec low = shot_project(&run, dvec_of(side ? 1.2 : -1.2, -1.3, 0)),
                 high = shot_project(&run, dvec_of(side ? 1.2 : -1.2, 1.3, 0));
            check_at_least("overshoot", run_of(&run, low, high, 6), 16,
                           "px by which side %d of a cylinder runs on above", side);
            check_at_least("overshoot", run_of(&run, high, low, 6), 16, "px below");
        }
        for (int y = 0; y < run.height; y++)
            for (int x = 0; x < run.width; x++) {
                double nearest = 1e9;
                for (int side = 0; side < 2; side++)
                    nearest = fmin(nearest, distance_to(shot_project(&run, dvec_of(side ? 1.2 : -1.2, -1.3, 0)),
                                                        shot_project(&run, dvec_of(side ? 1.2 : -1.2, 1.3, 0)), 52,
                                                        x + 0.5, y + 0.5));
                elsewhere += abs(run.picture[4 * (y * run.width + x)] - plain.picture[4 * (y * run.width + x)]) > 8 &&
                             nearest > 2.5;
            }
        check_at_most("overshoot", elsewhere, 0, "pixels that change elsewhere");
    }
    shot_release(&plain);
    shot_release(&run);
}

/* The box, and a wall before or behind the left part of it, which another rule draws. */
static void box_and_wall(shape *s, bool in_front)
{
    box_of(s);
    shape_quad(s, "wall", 6, 0);
    shape_place(s, dvec_of(0, 1, 0), 38, in_front ? dvec_of(-2.9, 0, 5) : dvec_of(-4, 0, -7));
}

/* Strokes outside their figure lie as deep as their line would. */
static void among_others(void)
{
    static const char *const look =
        LOOK("{\"select\":\"*\"," FLAT ",\"lines\":" LINES "},"
             "{\"select\":\"wall*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#d0e0ff\"}}");
    const char *changes[] = {"0:lines.overshoot", "24", NULL};
    for (int in_front = 0; in_front < 2; in_front++) {
        shape s = {0};
        shot  run;
        box_and_wall(&s, in_front);
        if (shot_of_shape(&run, &s, "wall.glb", look, changes, &box_view)) {
            int shown = 0, all = 0;
            for (int e = 0; e < 9; e++)
                for (int side = 0; side < 2; side++) {
                    dvec a = corner_at(&run, box_edges[e][!side]), b = corner_at(&run, box_edges[e][side]),
                         at = beyond(a, b, 9, 0);
                    dvec beside = beyond(a, b, 9, 12);
                    if (run.picture[4 * ((int)beside.y * run.width + (int)beside.x) + 2] < 250)
                        continue; /* near another line */
                    bool on_wall = run.picture[4 * ((int)beside.y * run.width + (int)beside.x)] < 250;
                    all += on_wall;
                    shown += on_wall && darkness(&run, at.x, at.y) > 0.4;
                }
            check_at_least("E20", all, 4, "strokes over a wall that another rule draws %s",
                           in_front ? "in front" : "behind");
            check_near("E20", shown, in_front ? 0 : all, 0.5, "of which show");
        }
        shot_release(&run);
        shape_release(&s);
    }
}

/* A box on a floor of another rule: strokes of its lower edges lie on the floor. */
static void on_a_floor(void)
{
    static const char *const look =
        LOOK("{\"select\":\"*\"," FLAT ",\"lines\":" LINES "},"
             "{\"select\":\"floor*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#d0e0ff\"}}");
    const char *changes[] = {"0:lines.overshoot", "24", NULL};
    shape       s = {0};
    shot        run;
    box_of(&s);
    shape_quad(&s, "floor", 5, 0);
    shape_place(&s, dvec_of(1, 0, 0), -90, dvec_of(0, -1, 0));
    if (shot_of_shape(&run, &s, "floor.glb", look, changes, &box_view)) {
        double shortest = 1e9;
        for (int e = 0; e < 2; e++) {
            dvec a = corner_at(&run, box_edges[e][0]), b = corner_at(&run, box_edges[e][1]);
            for (int side = 0; side < 2; side++) {
                double last = 3;
                for (double along = 3; along < 24; along += 0.5)
                    for (double across = -1; across <= 1; across += 0.5) {
                        dvec at = side ? beyond(a, b, along, across) : beyond(b, a, along, across);
                        last = darkness(&run, at.x, at.y) > 0.5 ? along : last;
                    }
                shortest = fmin(shortest, last);
            }
        }
        check_at_least("E20", shortest, least_of(24), "px of the shortest stroke on a floor that another rule draws");
    }
    shot_release(&run);
    shape_release(&s);
}

/* Each layer has its own lines: hidden edges run on as well. */
static void through_layers(void)
{
    static const char *const look =
        LOOK("{\"select\":\"*\"," FLAT ",\"lines\":" LINES ",\"layers\":{\"technique\":\"peel\",\"count\":0},"
             "\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0,\"hidden_opacity\":1}}");
    shot run;
    if (draw(&run, box_of, "16px", "2px", look, &box_view)) {
        box_verdict v = judge_box(&run, 12, 16, 2);
        check_at_least("B04", v.shortest, least_of(16),
                       "px of the shortest of the strokes of 16 px of all edges, hidden ones too");
        check_at_most("B04", v.strays, 0, "pixels of ink elsewhere");
    }
    shot_release(&run);
}

/* Wide lines, several samples, and two line techniques of which the first runs on. */
static void variants(void)
{
    shot      run;
    shot_view fine = box_view;
    fine.samples = 9;
    if (draw(&run, box_of, "16px", "6px", shot_line_look(LINES), &box_view)) {
        box_verdict v = judge_box(&run, 9, 16, 6);
        check_at_least("overshoot", v.shortest, least_of(16), "px of the shortest stroke of wide lines");
        check_at_most("overshoot", v.strays, 0, "pixels of ink elsewhere");
    }
    shot_release(&run);
    if (draw(&run, box_of, "16px", "2px", shot_line_look(LINES), &fine)) {
        box_verdict v = judge_box(&run, 9, 16, 2);
        check_at_least("samples", v.shortest, least_of(16), "px of the shortest stroke with nine samples a pixel");
        check_near("samples", v.mean, 16, 4, "px on average");
    }
    shot_release(&run);
    static const char *const pair = "[{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"overshoot\":16},"
                                    "{\"operator\":\"id\",\"colour\":\"#000000\"}]";
    shape                    s = {0};
    box_of(&s);
    if (shot_of_shape(&run, &s, "overshoot.glb", shot_line_look(pair), NULL, &box_view)) {
        box_verdict v = judge_box(&run, 9, 16, 2);
        check_at_least("overshoot", v.shortest, least_of(16),
                       "px of the shortest stroke of the first of two line techniques");
    }
    shot_release(&run);
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"box", edges_of_a_box}, {"stays", what_stays},      {"round", round_things}, {"others", among_others},
        {"floor", on_a_floor},   {"layers", through_layers}, {"variants", variants},
    };
    int status = check_main(argc, argv, "overshoot", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
