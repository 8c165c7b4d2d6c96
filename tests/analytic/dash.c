/* Dashed lines in drawings: how much ink goes, runs along the projected edges of a box, and what must not change. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

#define LINES "{\"operator\":\"discontinuity\",\"colour\":\"#000000\"}"

static const shot_view box_view = {
    .width = 640, .height = 600, .eye = {5, 3.4, 6.3}, .up = {0.1, 1, 0}, .without_maps = true};

/* 0 = paper, 1 = black. */
static double darkness(const shot *s, int x, int y)
{
    return x < 0 || y < 0 || x >= s->width || y >= s->height ? 0
                                                             : 1 - picture_shown(s->picture[4 * (y * s->width + x)]);
}

static double ink_sum(const shot *s)
{
    double sum = 0;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            sum += darkness(s, x, y);
    return sum;
}

static void box_of(shape *s)
{
    shape_box(s, "box", dvec_of(-1.4, -1, -1.2), dvec_of(1.2, 1.1, 1.3));
}

static void torus_of(shape *s)
{
    shape_torus(s, "torus", 1, 0.42, 192, 96);
}

/* Drawn with these lines.dash, lines.gap and lines.width. */
static bool draw(shot *out, void (*make)(shape *), const char *dash, const char *gap, const char *width,
                 const shot_view *view)
{
    const char *changes[] = {"lines.dash", dash, "lines.gap", gap, "lines.width", width, NULL};
    shape       s = {0};
    make(&s);
    bool good = shot_of_shape(out, &s, "dash.glb", shot_line_look(LINES), changes, view);
    shape_release(&s);
    return good;
}

static void fraction_of_ink(void)
{
    static const char *const styles[][3] = {{"8px", "5px", "1px"},  {"8px", "5px", "2px"},   {"14px", "4px", "3px"},
                                            {"6px", "10px", "2px"}, {"20px", "20px", "6px"}, {"2px", "6px", "2px"}};
    for (int shape_index = 0; shape_index < 2; shape_index++)
        for (size_t i = 0; i < sizeof styles / sizeof *styles; i++) {
            shot   whole, dashed;
            double dash = atof(styles[i][0]), gap = atof(styles[i][1]);
            bool   good = draw(&whole, shape_index ? torus_of : box_of, "0px", styles[i][1], styles[i][2], &box_view);
            if (draw(&dashed, shape_index ? torus_of : box_of, styles[i][0], styles[i][1], styles[i][2], &box_view) &&
                good)
                check_near("dash", 1 - ink_sum(&dashed) / ink_sum(&whole), gap / (dash + gap), 0.1 * gap / (dash + gap),
                           "fraction of the ink of a %s that dash %s, gap %s, width %s take away",
                           shape_index ? "torus" : "box", styles[i][0], styles[i][1], styles[i][2]);
            shot_release(&whole);
            shot_release(&dashed);
        }
}

/* The darkest of what lies across the line at a position. */
static double across(const shot *s, dvec at, double nx, double ny, double reach)
{
    double most = 0;
    for (double t = -reach; t <= reach; t += 0.5)
        most = fmax(most, darkness(s, (int)floor(at.x + t * nx), (int)floor(at.y + t * ny)));
    return most;
}

typedef struct verdict {
    double run, ends, stretch; /* worst difference of a run, of ink at ends, of the stretch from 1 */
} verdict;

/* Runs along one edge. Between the first and the last gap all dashes are alike and so are all gaps; at both ends
 * there is ink, of half a dash, or more where another line leaves at an acute angle. */
static void judge_edge(const shot *s, dvec a, dvec b, double dash, double gap, verdict *v)
{
    double length = hypot(b.x - a.x, b.y - a.y), nx = -(b.y - a.y) / length, ny = (b.x - a.x) / length, turns[256];
    int    count = 0;
    bool   last = true;
    for (double at = 2; at <= length - 2; at += 0.05) { /* the very corner is a pixel's matter */
        bool on = across(s, dvec_mix(a, b, at / length), nx, ny, 1.5) > 0.5;
        if (on != last && count < 255)
            turns[count++] = at;
        last = on;
    }
    if (count < 4 || count % 2 || turns[0] <= 2) {
        *v = (verdict){length, length, 1};
        return;
    }
    int    gaps = count / 2;
    double inner = turns[count - 1] - turns[0], stretch = inner / (gaps * gap + (gaps - 1) * dash);
    v->stretch = fmax(v->stretch, fabs(stretch - 1));
    v->ends = fmax(v->ends, fmax(fabs(turns[0] - 0.5 * dash), fabs(length - turns[count - 1] - 0.5 * dash)));
    for (int i = 1; i < count; i++)
        v->run = fmax(v->run, fabs(turns[i] - turns[i - 1] - stretch * (i % 2 ? gap : dash)));
}

/* The nine edges of the box that are seen from in front, right, above. */
static void runs_along_edges(void)
{
    static const double corner[8][3] = {{-1.4, -1, -1.2}, {1.2, -1, -1.2}, {-1.4, 1.1, -1.2}, {1.2, 1.1, -1.2},
                                        {-1.4, -1, 1.3},  {1.2, -1, 1.3},  {-1.4, 1.1, 1.3},  {1.2, 1.1, 1.3}};
    static const int    edges[9][2] = {{4, 5}, {5, 1}, {1, 3}, {3, 2}, {2, 6}, {6, 4}, {6, 7}, {7, 5}, {7, 3}};
    for (int roll = 0; roll < 5; roll++) {
        shot_view view = box_view;
        shot      s;
        verdict   v = {0};
        view.up = dvec_of(0.35 * roll - 0.7, 1, 0);
        if (draw(&s, box_of, "12px", "8px", "2px", &view)) {
            for (int e = 0; e < 9; e++) {
                const double *p = corner[edges[e][0]], *q = corner[edges[e][1]];
                judge_edge(&s, shot_project(&s, dvec_of(p[0], p[1], p[2])), shot_project(&s, dvec_of(q[0], q[1], q[2])),
                           12, 8, &v);
            }
            check_at_most("dash", v.run, 2, "px that a dash or gap differs from the others of its edge, rolled %d",
                          roll);
            check_at_most("dash", v.stretch, 0.12, "most that a pattern is stretched");
            check_at_most("dash", v.ends, 6, "px that the ink at an edge's ends is longer or shorter than half a dash");
        }
        shot_release(&s);
    }
}

static void what_stays(void)
{
    shot  plain, zero, dashed, again, es, one, two;
    shape s = {0};
    torus_of(&s);
    shot_view other = box_view;
    other.es = true;
    bool good = shot_of_shape(&plain, &s, "dash.glb", shot_line_look(LINES), NULL, &box_view);
    if (draw(&zero, torus_of, "0px", "17px", "2px", &box_view) && good)
        check_at_most("dash", shot_differing(&plain, &zero, 0), 0, "values that dash 0 changes");
    good = draw(&dashed, torus_of, "9px", "6px", "2px", &box_view);
    if (draw(&again, torus_of, "9px", "6px", "2px", &box_view) && good)
        check_at_most("dash", shot_differing(&dashed, &again, 0), 0, "values that differ in a second drawing");
    if (draw(&es, torus_of, "9px", "6px", "2px", &other) && good)
        check_at_most("GLES", shot_differing(&dashed, &es, 1), 0, "values that differ in the other dialect");
    /* Of two line techniques each has its own dashes: unbroken blue over and under dashed red. */
    static const char *const pairs[2] = {"[{\"operator\":\"discontinuity\",\"colour\":\"#ff0000\",\"dash\":9},{"
                                         "\"operator\":\"discontinuity\",\"colour\":\"#0000ff\"}]",
                                         "[{\"operator\":\"discontinuity\",\"colour\":\"#0000ff\"},{\"operator\":"
                                         "\"discontinuity\",\"colour\":\"#ff0000\",\"dash\":9}]"};
    good = shot_of_shape(&one, &s, "dash.glb", shot_line_look(pairs[0]), NULL, &box_view);
    if (shot_of_shape(&two, &s, "dash.glb", shot_line_look(pairs[1]), NULL, &box_view) && good) {
        int red = 0, blue = 0, lost = 0, mixed = 0;
        for (int i = 0; i < one.width * one.height; i++) {
            const uint8_t *p = &one.picture[4 * i], *q = &two.picture[4 * i];
            bool           ink = plain.picture[4 * i] < 60;
            lost += ink && (p[1] > 60 || q[1] > 60);
            red += ink && q[0] > 200;
            blue += ink && q[2] > 200;
            mixed += ink && p[0] > 60;
        }
        check_at_most("dash", lost, 0, "pixels of an unbroken line that another technique's dashes take away");
        check_at_most("dash", mixed, 0, "pixels of it that are not blue where blue is on top");
        check_near("dash", red / (double)(red + blue), 9.0 / 13, 0.1, "fraction of red dashes on a blue line");
        shot_release(&two);
    }
    shot_release(&plain);
    shot_release(&zero);
    shot_release(&dashed);
    shot_release(&again);
    shot_release(&es);
    shot_release(&one);
    shape_release(&s);
}

/* --- hidden edges while the model turns --------------------------------------------------------------------- */

enum { DASHES_MAX = 64 };

/* Where the dashes of an edge have their middles, pixels from a, those at both ends apart. */
static int middles_of(const shot *s, dvec a, dvec b, double out[DASHES_MAX])
{
    double length = hypot(b.x - a.x, b.y - a.y), nx = -(b.y - a.y) / length, ny = (b.x - a.x) / length, since = -1;
    int    count = 0;
    bool   last = true; /* what begins at the corner is not counted */
    for (double at = 2; at <= length - 2; at += 0.05) {
        bool on = across(s, dvec_mix(a, b, at / length), nx, ny, 1.5) > 0.5;
        if (on && !last)
            since = at;
        else if (!on && last && since >= 0 && count < DASHES_MAX)
            out[count++] = (since + at) / 2;
        last = on;
    }
    return count;
}

typedef struct turning {
    double dash, moved; /* worst difference of the distance of two dashes from dash + gap, per cent; of a middle from
                           where its place on the edge went, pixels */
    int changes, most;  /* of how many dashes an edge has; the most it could have by its change of length, to and fro
                           not counted */
    int followed;
} turning;

/* A box in a box, seen through: creases of the inner one are hidden, and nothing is drawn over them. Nienhaus et al.
 * 2006 could not dash them; row csg C26.
 */
static void dashes_stay_while_it_turns(void)
{
    static const double far_ends[3][3] = {{-0.6, 0.7, 0.8}, {0.9, -0.7, 0.8}, {0.9, 0.7, -0.8}};
    enum { STEPS = 17 };
    turning t = {0};
    double  before[3][DASHES_MAX], length_before[3] = {0};
    int     count_before[3] = {0}, first[3] = {0};
    for (int step = 0; step < STEPS; step++) {
        double    turn = (35 + 0.5 * step) * 3.14159265358979323846 / 180;
        shot_view view = {.width = 520,
                          .height = 480,
                          .eye = {9 * sin(turn), 4.5, 9 * cos(turn)},
                          .up = {0, 1, 0},
                          .orthographic = true,
                          .without_maps = true};
        shape     shapes = {0};
        shot      s;
        shape_box(&shapes, "outer", dvec_of(-2, -1.8, -1.9), dvec_of(2, 1.8, 1.9));
        shape_box(&shapes, "inner", dvec_of(-0.6, -0.7, -0.8), dvec_of(0.9, 0.7, 0.8));
        if (shot_of_shape(
                &s, &shapes, "turning.glb",
                "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\","
                "\"surface\":\"flat\",\"layers\":{\"technique\":\"peel\",\"count\":2},"
                "\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#ff000000\",\"width\":2},"
                "\"compose\":{\"technique\":\"wire\",\"hidden_colour\":\"#000000\",\"hidden_dash\":9,"
                "\"hidden_gap\":6,\"once\":false}}]}",
                NULL, &view))
            for (int e = 0; e < 3; e++) {
                double middles[DASHES_MAX];
                dvec   a = shot_project(&s, dvec_of(0.9, 0.7, 0.8)),
                     b = shot_project(&s, dvec_of(far_ends[e][0], far_ends[e][1], far_ends[e][2]));
                double length = hypot(b.x - a.x, b.y - a.y);
                int    count = middles_of(&s, a, b, middles);
                for (int i = 1; i < count; i++)
                    t.dash = fmax(t.dash, 100 * fabs((middles[i] - middles[i - 1]) / 15 - 1));
                for (int i = 0; i < count && step && count == count_before[e]; i++, t.followed++)
                    t.moved = fmax(t.moved, fabs(middles[i] - before[e][i] * length / length_before[e]));
                t.changes += step ? abs(count - count_before[e]) : 0;
                first[e] = step ? first[e] : count;
                t.most += step == STEPS - 1 ? abs(count - first[e]) : 0;
                count_before[e] = count;
                length_before[e] = length;
                memcpy(before[e], middles, sizeof middles);
            }
        shot_release(&s);
        shape_release(&shapes);
    }
    check_at_least("C26", t.followed, 200, "dashes that are followed from picture to picture");
    check_at_most("C26", t.dash, 15,
                  "per cent that the distance of two hidden dashes is off, over 8 degrees of turning");
    /* Of 15 px; ends of what is traced lie on pixels. */
    check_at_most("C26", t.moved, 2, "px that a dash leaves its place on the edge by, in half a degree");
    check_at_most("C26", t.changes, t.most, "changes of how many there are: no edge has more and fewer by turns");
}

/* Supersampling counts dashes in the finished picture's pixels. */
static void supersampled(void)
{
    shot_view fine = box_view;
    shot      one, many;
    fine.samples = 9;
    bool good = draw(&one, box_of, "12px", "8px", "3px", &box_view);
    if (draw(&many, box_of, "12px", "8px", "3px", &fine) && good) {
        dvec    a = shot_project(&one, dvec_of(-1.4, 1.1, 1.3)), b = shot_project(&one, dvec_of(1.2, 1.1, 1.3));
        verdict v = {0};
        judge_edge(&many, a, b, 12, 8, &v);
        check_at_most("samples", v.run, 2, "px that a dash or gap differs with nine samples a pixel");
        check_near("samples", ink_sum(&many) / ink_sum(&one), 1, 0.15, "ink with nine samples, to that with one");
    }
    shot_release(&one);
    shot_release(&many);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"fraction", fraction_of_ink},           {"runs", runs_along_edges}, {"stays", what_stays},
        {"turning", dashes_stay_while_it_turns}, {"samples", supersampled},
    };
    int status = check_main(argc, argv, "dash", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
