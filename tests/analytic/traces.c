/* Speed lines and contours of the past against what is known of the motion. Großmann 2011; rows 15, 16, 19, 21, 23 to
 * 25, 28 to 31, 33, 77k. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut.h"
#include "check.h"
#include "limner/scene.h"
#include "moving_scene.h"
#include "scene/scene.h"
#include "trace/trace.h"

static const double pi = 3.14159265358979323846, grey[3] = {0.5, 0.5, 0.5};
/* The page: 10 units of the world are 800 of paper, seen along −z in parallel. */
enum { PAGE = 800, UNIT = 80 };

typedef struct traced {
    lmn_scene     *scene;
    pose           pose;
    stroke_scene   strokes;
    stroke_view   *view;
    stroke_camera  camera;
    traces_values  values;
    ribbon_set     ribbons;
    trace_facts    facts;
    stroke_section section;
    bool          *parts;
} traced;

static traces_values standard(void)
{
    traces_values v = {.common = {.exposure = 1}, .width = 1.6f, .lines = 24, .ends = TRACES_FADING};
    v.colour.r = NAN;
    v.length = 0.8f;
    v.uneven = 0.5f;
    v.begin = 4;
    v.groups = 1;
    v.group_apart = 3;
    v.probability = 1;
    v.fade = 0.75f;
    v.contour_width = 1.2f;
    return v;
}

static stroke_camera straight_on(bool orthographic)
{
    stroke_camera c = {
        .view = mat4_identity(), .orthographic = orthographic, .width = PAGE, .height = PAGE, .near = 0.1};
    c.view.m[14] = -20;
    memset(&c.projection, 0, sizeof c.projection);
    c.projection.m[0] = c.projection.m[5] = orthographic ? 0.2 : 4;
    c.projection.m[10] = orthographic ? -0.02 : -1.002;
    c.projection.m[11] = orthographic ? 0 : -1;
    c.projection.m[14] = orthographic ? -1 : -0.2002;
    c.projection.m[15] = orthographic ? 1 : 0;
    return c;
}

/* Reads a scene that was written and poses it; all its parts draw traces. */
static bool open_scene(traced *t, const char *path, double seconds, bool orthographic)
{
    lmn_error error = {0};
    moment    when;
    *t = (traced){.camera = straight_on(orthographic), .values = standard()};
    bool good = lmn_scene_create(&t->scene, &error) == LMN_OK &&
                lmn_scene_add_file(t->scene, path, NULL, &error) == LMN_OK &&
                moment_find(&when, t->scene, NULL, seconds, NULL, &error) == LMN_OK &&
                pose_create(&t->pose, t->scene, &when, &error) == LMN_OK &&
                stroke_scene_create(&t->strokes, &t->pose, NULL, pi / 6, NULL, NULL, &error) == LMN_OK &&
                stroke_view_create(&t->view, &t->strokes, &t->camera, NULL, NULL, &error) == LMN_OK;
    t->parts = check_alloc(t->scene->part_count + 1, sizeof *t->parts);
    for (size_t i = 0; i < t->scene->part_count; i++)
        t->parts[i] = true;
    return check_that("traces", good, "%s is read: %s", path, error.message);
}

static lmn_status trace(traced *t)
{
    lmn_error            error = {0};
    const traces_options o = {.pose = &t->pose,
                              .parts = t->parts,
                              .values = &t->values,
                              .camera = t->camera,
                              .seen = t->view,
                              .section = t->section,
                              .crease_angle = pi / 6,
                              .seed = 7,
                              .brush = BRUSH_PEN};
    ribbon_set_release(&t->ribbons);
    return traces_make(&t->ribbons, &t->facts, &o, &error);
}

static void close_scene(traced *t)
{
    ribbon_set_release(&t->ribbons);
    stroke_view_destroy(&t->view);
    stroke_scene_release(&t->strokes);
    pose_release(&t->pose);
    lmn_scene_destroy(&t->scene);
    free(t->parts);
}

static size_t count_of(const traced *t, stroke_class kind)
{
    size_t count = 0;
    for (size_t i = 0; i < t->ribbons.ribbon_count; i++)
        count += t->ribbons.ribbons[i].kind == kind;
    return count;
}

/* A ball of radius 1 that goes from −x to x in a second, `bend`: faster and faster. */
static const char *write_ball(const char *name, double x, bool faster)
{
    enum { KEYS = 65 };
    moving_scene m;
    double       times[KEYS], places[3 * KEYS];
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, -x, 0, 0, 1, grey);
    for (int i = 0; i < KEYS; i++) {
        double s = (double)i / (KEYS - 1);
        times[i] = s;
        places[3 * i] = -x + 2 * x * (faster ? s * s : s);
        places[3 * i + 1] = places[3 * i + 2] = 0;
    }
    moving_scene_keys(&m, ball, "translation", KEYS, times, places);
    const char *path = check_path("%s.glb", name);
    moving_scene_write(&m, path);
    return path;
}

/* --- lines --------------------------------------------------------------------------------------------------- */

/* All seven requirements, on the lines themselves. */
static void requirements(void)
{
    traced t;
    double lengths[2];
    if (open_scene(&t, write_ball("ball", 3, false), 1, true)) {
        for (int i = 0; i < 2; i++) {
            t.values.length = i ? 0.8f : 0.4f;
            check_that("33", trace(&t) == LMN_OK, "traced");
            lengths[i] = t.facts.measures.length;
        }
        const trace_measures *m = &t.facts.measures;
        check_at_most("A1", m->extent, 2, "the outermost lines begin so far from the extremes, units");
        check_at_least("A2", m->salient, 0.95, "share of lines that begin on the outline");
        check_that("A3", count_of(&t, STROKE_SPEED) == 24, "%zu of 24 lines", count_of(&t, STROKE_SPEED));
        check_at_least("A4", m->uneven, 0.2, "deviation of gaps");
        check_at_most("A5", m->crowded, 2, "lines on a fifth of the extent, of the mean");
        check_at_most("A6", m->inside, 0, "length of lines on the ball");
        check_near("A7", lengths[1] / lengths[0], 2, 0.1, "twice the length is twice as long");
    }
    close_scene(&t);
}

/* The same by what is known of the ball: it is at (3, 0) with radius 1 and came from the left. */
static void lines_lie_behind(void)
{
    traced t;
    if (open_scene(&t, write_ball("behind", 3, false), 1, true) && check_that("28", trace(&t) == LMN_OK, "traced")) {
        double inside = 0, ahead = 0, slant = 0, highest = 0, lowest = PAGE;
        for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
            const ribbon       *r = &t.ribbons.ribbons[i];
            const ribbon_point *p = &t.ribbons.points[r->first];
            highest = fmax(highest, (double)p->y);
            lowest = fmin(lowest, (double)p->y);
            for (uint32_t k = 0; k < r->count; k++) {
                double x = (double)p[k].x - PAGE / 2.0 - 3 * UNIT, y = (double)p[k].y - PAGE / 2.0;
                inside += hypot(x, y) < UNIT * 0.98; /* its facets lie a little inside */
                ahead += x > 0;
                slant = fmax(slant, fabs((double)p[k].y - (double)p[0].y));
            }
        }
        check_at_most("A6", inside, 0, "points on the ball");
        check_at_most("19", ahead, 0, "points ahead of its middle");
        check_at_most("22", slant, 0.1, "lines of a straight way are straight, units off");
        check_near("A1", highest - lowest, 2 * UNIT, 4, "from the first to the last line");
    }
    close_scene(&t);
}

/* A rod that swings by 90 degrees in a second around its end. */
static void rods_leave_arcs(void)
{
    enum { KEYS = 65 };
    moving_scene m;
    traced       t;
    double       times[KEYS], turns[4 * KEYS];
    moving_scene_begin(&m);
    int joint = moving_scene_joint(&m, -1, -1, 0), rod = moving_scene_box(&m, 2, 0, 0, (double[]){2, 0.1, 0.1}, grey);
    moving_scene_put_in(&m, rod, joint);
    for (int i = 0; i < KEYS; i++) {
        double half = pi / 4 * i / (KEYS - 1);
        times[i] = (double)i / (KEYS - 1);
        memcpy(&turns[4 * i], (double[]){0, 0, sin(half), cos(half)}, 4 * sizeof(double));
    }
    moving_scene_keys(&m, joint, "rotation", KEYS, times, turns);
    const char *path = check_path("rod.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true) && check_that("23", trace(&t) == LMN_OK, "traced")) {
        double off = 0, widest = 0;
        size_t lines = 0;
        for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
            const ribbon       *r = &t.ribbons.ribbons[i];
            const ribbon_point *p = &t.ribbons.points[r->first];
            double              radius = 0;
            for (uint32_t k = 0; k < r->count; k++) {
                double x = (double)p[k].x - (PAGE / 2.0 - UNIT), y = PAGE / 2.0 + UNIT - (double)p[k].y;
                radius = k ? radius : hypot(x, y);
                off = fmax(off, fabs(hypot(x, y) - radius));
                check_that("31", k > 0 || x > 0, "the line begins behind the rod, which stands upright now");
            }
            widest = fmax(widest, radius);
            lines++;
        }
        check_at_least("23", (double)lines, 12, "lines");
        check_at_most("23", off, 0.5, "arcs are off by, units");
        check_near("A1", widest, 4 * UNIT, 4, "the outermost arc is that of the tip");
    }
    close_scene(&t);
}

/* --- contours --------------------------------------------------------------------------------------------------- */

/* The x of the middle of a circle that a ribbon's points lie on, radius 1: the mean of what each point says. */
static void check_contours(traced *t, const double *centres, size_t count, bool trailing)
{
    double off = 0, fades = 0, leads = 0;
    size_t found = 0;
    for (size_t n = 0; n < count; n++) {
        bool any = false;
        for (size_t i = 0; i < t->ribbons.ribbon_count; i++) {
            const ribbon       *r = &t->ribbons.ribbons[i];
            const ribbon_point *p = &t->ribbons.points[r->first];
            if (r->kind != STROKE_PAST || fabs((double)p->alpha - pow(0.75, (double)n + 1)) > 1e-4)
                continue;
            any = true;
            for (uint32_t k = 0; k < r->count; k++) {
                double x = (double)p[k].x - PAGE / 2.0 - UNIT * centres[n], y = (double)p[k].y - PAGE / 2.0;
                off = fmax(off, fabs(hypot(x, y) - UNIT));
                fades += (double)p[k].alpha != (double)p->alpha;
                leads += trailing && x > 2;
            }
        }
        found += any;
    }
    check_that("15", found == count, "%zu of %zu contours have their own opacity, by the same factor", found, count);
    check_at_most("15", off, 2, "contours lie where the ball was, units off (facets: 1.5)");
    check_at_most("15", fades, 0, "points of another opacity");
    check_at_most("16", leads, 0, "points on the side that leads");
}

static void contours_of_the_past(void)
{
    traced       t;
    const double even[4] = {1.5, 0, -1.5, -3};
    if (open_scene(&t, write_ball("even", 3, false), 1, true)) {
        t.values.lines = 0;
        t.values.contours = 4;
        check_that("15", trace(&t) == LMN_OK && t.facts.contours == 4, "four times");
        check_contours(&t, even, 4, false);
        t.values.trailing = true;
        check_that("16", trace(&t) == LMN_OK, "the trailing side alone");
        check_contours(&t, even, 3, true); /* before the fourth nothing moved: no side trails */
    }
    close_scene(&t);
    double squares[4];
    for (int i = 0; i < 4; i++)
        squares[i] = -3 + 6 * pow(1 - (i + 1) / 4.0, 2);
    if (open_scene(&t, write_ball("faster", 3, true), 1, true)) {
        t.values.lines = 0;
        t.values.contours = 4;
        check_that("15", trace(&t) == LMN_OK, "at equal times of a motion that grows faster");
        check_contours(&t, squares, 4, false);
        t.values.moments = TRACES_AT_LENGTHS;
        check_that("15", trace(&t) == LMN_OK, "at equal lengths of it");
        check_contours(&t, even, 4, false);
    }
    close_scene(&t);
}

static const char *write_moved(const char *name, int keys, const double *times, const double *places)
{
    moving_scene m;
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, 0, 0, 0, 1, grey);
    if (keys)
        moving_scene_keys(&m, ball, "translation", keys, times, places);
    int other = moving_scene_joint(&m, 0, 0, 0);
    moving_scene_keys(&m, other, "translation", 2, (double[]){0, 1}, (double[]){0, 0, 0, 1, 0, 0});
    const char *path = check_path("%s.glb", name);
    moving_scene_write(&m, path);
    return path;
}

/* --- flow lines --------------------------------------------------------------------------------------------- */

/* Row 77m: the ball at (3, 0) goes to the right. All lines go on ahead of it, side by side or to one point. */
static void flow_lines(void)
{
    traced t;
    if (open_scene(&t, write_ball("flow", 3, false), 1, true)) {
        const double front = PAGE / 2.0 + 4 * UNIT;
        t.values.flow = 30;
        t.values.flow_length = 0.12f;
        for (int way = TRACES_PARALLEL; way <= TRACES_CONVERGING; way++) {
            double slant = 0, off = 0, inside = 0;
            size_t lines = 0, ahead = 0;
            t.values.flow_way = way;
            check_that("77m", trace(&t) == LMN_OK, "traced");
            for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
                const ribbon       *r = &t.ribbons.ribbons[i];
                const ribbon_point *p = &t.ribbons.points[r->first], *q = p + r->count - 1;
                if (!((uint32_t)r->id & 0x80000000u))
                    continue;
                double x = (double)q->x - (double)p->x, y = (double)q->y - (double)p->y,
                       meets[2] = {front + 0.12 * PAGE - (double)p->x, PAGE / 2.0 - (double)p->y};
                lines++;
                ahead += (double)q->x > front;
                slant = fmax(slant, fabs(y / x));
                off = fmax(off, fabs(x * meets[1] - y * meets[0]) / hypot(x, y));
                for (uint32_t k = 0; k < r->count; k++)
                    inside += hypot((double)p[k].x - PAGE / 2.0 - 3 * UNIT, (double)p[k].y - PAGE / 2.0) < UNIT * 0.98;
            }
            check_at_least("77m", (double)lines, 30, "lines, those that the ball parts counted twice");
            check_at_most("77m", inside, 0, "points on the ball");
            check_at_least("77m", (double)ahead, way == TRACES_PARALLEL ? 20 : 12, "lines that end ahead of it");
            check_at_most("77m", way == TRACES_PARALLEL ? slant : off, way == TRACES_PARALLEL ? 0.001 : 0.5,
                          way == TRACES_PARALLEL ? "slant against its way" : "units by which they miss one point");
            check_that("33", t.facts.measures.lines == 24, "measures count speed lines alone: %zu",
                       t.facts.measures.lines);
        }
    }
    close_scene(&t);
}

/* Of what turns they are arcs around its centre that run ahead of it, or spirals to one point ahead. */
static void flow_lines_turn(void)
{
    moving_scene m;
    const double half[3] = {0.7, 0.25, 0.1}, turn = 1.0;
    traced       t;
    moving_scene_begin(&m);
    int hinge = moving_scene_joint(&m, 0, 0, 0);
    moving_scene_put_in(&m, moving_scene_box(&m, 2.2, 0, 0, half, grey), hinge);
    moving_scene_keys(&m, hinge, "rotation", 2, (double[]){0, 1},
                      (double[]){0, 0, -sin(turn / 2), cos(turn / 2), 0, 0, 0, 1});
    const char *path = check_path("flow-turns.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true)) {
        t.values.flow = 30;
        t.values.flow_length = 0.4f;
        for (int way = TRACES_PARALLEL; way <= TRACES_CONVERGING; way++) {
            double off = 0, apart[2] = {0, 0};
            size_t lines = 0, ahead = 0;
            t.values.flow_way = way;
            check_that("77m", trace(&t) == LMN_OK, "traced");
            for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
                const ribbon *r = &t.ribbons.ribbons[i];
                double        radius[2] = {INFINITY, 0}, angle = 0, ends[2] = {0, 0};
                if (!((uint32_t)r->id & 0x80000000u))
                    continue;
                for (uint32_t k = 0; k < r->count; k++) {
                    const ribbon_point *p = &t.ribbons.points[r->first + k];
                    double              x = (double)p->x - PAGE / 2.0, y = PAGE / 2.0 - (double)p->y, now = hypot(x, y);
                    radius[0] = fmin(radius[0], now);
                    radius[1] = fmax(radius[1], now);
                    ends[k == 0 ? 0 : 1] = now / UNIT - 2.2;
                    angle = atan2(y, x);
                }
                lines++;
                ahead += angle > 0.3;
                off = fmax(off, radius[1] - radius[0]);
                for (int k = 0; k < 2 && angle > 0.3; k++)
                    apart[k] = fmax(apart[k], fabs(ends[k]));
            }
            check_at_least("77m", (double)lines, 30, "lines around, those that the box parts counted twice");
            check_at_least("77m", (double)ahead, 12, "lines that end ahead of it");
            if (way == TRACES_PARALLEL)
                check_at_most("77m", off, 0.1, "units by which they leave their circles");
            else
                check_at_most("77m", apart[1] / apart[0], 0.45,
                              "of their distance from one circle is left where they end");
        }
    }
    close_scene(&t);
}

/* Row 20: rays around what comes nearer begin on a circle, at equal angles. */
static void lines_on_circles(void)
{
    traced t;
    if (open_scene(&t, write_moved("circle", 2, (double[]){0, 1}, (double[]){0, 0, -8, 0, 0, 4}), 1, false)) {
        double least = INFINITY, most = 0, apart = 0, off = 0, before = 0;
        size_t count = 0;
        t.values.origin = TRACES_CIRCLE;
        t.values.lines = 24;
        t.values.uneven = 0;
        check_that("20", trace(&t) == LMN_OK, "traced");
        for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
            const ribbon_point *p = &t.ribbons.points[t.ribbons.ribbons[i].first];
            const ribbon_point *q = p + t.ribbons.ribbons[i].count - 1;
            double              x = (double)p->x - PAGE / 2.0, y = (double)p->y - PAGE / 2.0, angle = atan2(y, x);
            least = fmin(least, hypot(x, y));
            most = fmax(most, hypot(x, y));
            off = fmax(off, fabs(x * ((double)q->y - (double)p->y) - y * ((double)q->x - (double)p->x)) / hypot(x, y));
            if (count++)
                apart = fmax(apart, fabs(fabs(remainder(angle - before, 2 * pi)) - 2 * pi / 24));
            before = angle;
        }
        check_that("20", count == 24, "%zu of 24 rays", count);
        check_at_most("20", most - least, 2, "beginnings are off a circle by, units");
        check_at_most("20", apart, 0.02, "angles differ from equal ones by");
        check_at_most("20", off, 0.5, "rays miss the middle by, units");
    }
    close_scene(&t);
}

/* --- figures -------------------------------------------------------------------------------------------------- */

static double to_segment(double x, double y, const double a[2], const double b[2])
{
    double dx = b[0] - a[0], dy = b[1] - a[1],
           f = fmin(fmax(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy), 0), 1);
    return hypot(x - a[0] - f * dx, y - a[1] - f * dy);
}

/* A rod of four units and one of two, each from its joint, that turn by 90 degrees in a second. */
static const char *write_rods(const char *name)
{
    moving_scene m;
    const double turns[8] = {0, 0, 0, 1, 0, 0, sin(pi / 4), cos(pi / 4)};
    moving_scene_begin(&m);
    for (int i = 0; i < 2; i++) {
        double half = i ? 1 : 2;
        int    joint = moving_scene_joint(&m, i ? 1 : -3, -2, 0),
            rod = moving_scene_box(&m, half, 0, 0, (double[]){half, 0.1, 0.1}, grey);
        moving_scene_name(&m, rod, i ? "leg" : "arm");
        moving_scene_put_in(&m, rod, joint);
        moving_scene_keys(&m, joint, "rotation", 2, (double[]){0, 1}, turns);
    }
    const char *path = check_path("%s.glb", name);
    moving_scene_write(&m, path);
    return path;
}

/* Row 77d: of each time a line and two marks, and nothing of what was not asked for. Row 77h: outlines so far from the
 * middle line as the rod is thick. */
static void check_rods(const traced *t, double radius, const char *what)
{
    double off = 0, elsewhere = 0;
    size_t lines = 0;
    for (size_t i = 0; i < t->ribbons.ribbon_count; i++) {
        const ribbon       *r = &t->ribbons.ribbons[i];
        const ribbon_point *p = &t->ribbons.points[r->first];
        double              n = round(log((double)p->alpha) / log(0.75)), angle = pi / 2 * (1 - n / 8);
        const double        joint[2] = {PAGE / 2.0 + UNIT, PAGE / 2.0 + 2 * UNIT},
                     tip[2] = {joint[0] + 2 * UNIT * cos(angle), joint[1] - 2 * UNIT * sin(angle)};
        bool mark = hypot((double)p[0].x - joint[0], (double)p[0].y - joint[1]) < 4 ||
                    hypot((double)p[0].x - tip[0], (double)p[0].y - tip[1]) < 4;
        mark = mark && r->count < 30 && radius == 0;
        lines += !mark;
        for (uint32_t k = 0; k < r->count; k++) {
            double apart = to_segment((double)p[k].x, (double)p[k].y, joint, tip);
            off = mark ? off : fmax(off, fabs(apart - radius));
            elsewhere += apart > radius + 4;
        }
    }
    check_that("77d", lines == 8, "%s: %zu phases of 8 can be counted", what, lines);
    check_at_most("77d", off, 0.6, "%s: off by, units", what);
    check_at_most("77d", elsewhere, 0, "%s: points elsewhere", what);
}

static void figures_of_the_past(void)
{
    traced t;
    if (open_scene(&t, write_rods("rods"), 1, true)) {
        t.values.lines = 0;
        t.values.contours = 8;
        t.values.in_front = true;
        t.values.figures = TRACES_BONES;
        snprintf(t.values.bones.text, sizeof t.values.bones.text, "le*");
        check_that("77d", trace(&t) == LMN_OK, "bones");
        check_rods(&t, 0, "bones");
        t.values.figures = TRACES_SOLIDS;
        check_that("77h", trace(&t) == LMN_OK, "solids");
        check_rods(&t, 0.1 * UNIT, "solids");
        t.values.figures = TRACES_POINTS;
        check_that("77d", trace(&t) == LMN_OK, "points");
        check_that("77d", count_of(&t, STROKE_PAST) == 16, "%zu of 16 marks", count_of(&t, STROKE_PAST));
        t.values.bones.text[0] = 0;
        check_that("77d", trace(&t) == LMN_OK, "points of both rods");
        check_that("77d", count_of(&t, STROKE_PAST) == 32, "%zu of 32 marks", count_of(&t, STROKE_PAST));
    }
    close_scene(&t);
}

/* Row 77g: a ball of radius 1 sweeps a form with straight sides and round ends. */
static void swept_forms(void)
{
    traced t;
    if (open_scene(&t, write_ball("swept", 3, false), 1, true)) {
        double       off = 0, length = 0;
        const double from[2] = {PAGE / 2.0 - 3 * UNIT, PAGE / 2.0}, to[2] = {PAGE / 2.0 + 3 * UNIT, PAGE / 2.0};
        t.values.lines = 0;
        t.values.contours = 1;
        t.values.in_front = true;
        t.values.figures = TRACES_SWEPT;
        check_that("77g", trace(&t) == LMN_OK, "swept");
        check_that("77g", t.ribbons.ribbon_count == 1, "one outline: %zu", t.ribbons.ribbon_count);
        for (size_t i = 0; i < t.ribbons.point_count; i++) {
            const ribbon_point *p = &t.ribbons.points[i];
            off = fmax(off, fabs(to_segment((double)p->x, (double)p->y, from, to) - UNIT));
            length += i ? hypot((double)(p[0].x - p[-1].x), (double)(p[0].y - p[-1].y)) : 0;
        }
        check_at_most("77g", off, 2, "off by, units (facets: 1.5)");
        check_near("77g", length / (12 * UNIT + 2 * pi * UNIT), 1, 0.02, "it is smooth: as long as the true form");
    }
    close_scene(&t);
}

/* A rod half a unit wide that turns quickly about one end: the outline is that of a sector, without teeth; only its
 * three corners are rounded. Another one passes broadside. */
static void swept_rods(void)
{
    enum { KEYS = 65 };
    const double end = 2.6, half[3] = {0.5, 0.0025, 0.0025};
    for (int turns = 0; turns < 2; turns++) {
        moving_scene m;
        double       times[KEYS], keys[4 * KEYS], off = 0, corners = 0, angle = 0;
        size_t       looked = 0;
        traced       t;
        moving_scene_begin(&m);
        int hinge = moving_scene_joint(&m, turns ? -1 : 0, 0, 0);
        for (int i = 0; i < KEYS; i++) {
            times[i] = (double)i / (KEYS - 1);
            angle = 1.3 * times[i];
            memcpy(keys + 4 * i, (double[]){0, 0, sin(angle / 2), cos(angle / 2)}, sizeof(double[4]));
            if (!turns)
                memcpy(keys + 3 * i, (double[]){0, 5 * times[i] - 2.5, 0}, sizeof(double[3]));
        }
        moving_scene_put_in(
            &m,
            moving_scene_box(&m, turns ? end / 2 : 0, 0, 0, turns ? (double[]){end / 2, half[1], half[2]} : half, grey),
            hinge);
        moving_scene_keys(&m, hinge, turns ? "rotation" : "translation", KEYS, times, keys);
        const char *path = check_path("swept-rod.glb");
        moving_scene_write(&m, path);
        if (open_scene(&t, path, 1, true)) {
            t.values.lines = 0;
            t.values.contours = 1;
            t.values.in_front = true;
            t.values.figures = TRACES_SWEPT;
            check_that("77g", trace(&t) == LMN_OK, "swept");
            check_that("77g", t.ribbons.ribbon_count == 1, "%zu outlines", t.ribbons.ribbon_count);
            for (size_t i = 0; i < t.ribbons.point_count; i++) {
                double x = ((double)t.ribbons.points[i].x - PAGE / 2.0) + (turns ? UNIT : 0),
                       y = PAGE / 2.0 - (double)t.ribbons.points[i].y, reach = end * UNIT, a = atan2(y, x),
                       r = hypot(x, y), aside = fmin(fabs(y), fabs(y * cos(1.3) - x * sin(1.3)));
                double to =
                    turns ? fmin(aside, fabs(r - reach)) : fmin(fabs(fabs(x) - 0.5 * UNIT), fabs(fabs(y) - 2.5 * UNIT));
                bool corner = turns ? r < 10 || (fabs(r - reach) < 6 && aside < 6)
                                    : fabs(fabs(x) - 0.5 * UNIT) < 6 && fabs(fabs(y) - 2.5 * UNIT) < 6;
                looked += !corner;
                *(corner ? &corners : &off) = fmax(corner ? corners : off, to);
                check_that("77g", !turns || (a > -0.2 && a < 1.5), "within the sector");
            }
            check_at_least("77g", (double)looked, 200, "positions away from corners");
            check_at_most("77g", off, 0.5, turns ? "a rod turns: off by, units" : "a rod passes: off by, units");
            check_at_most("77g", corners, 1.5, "at corners, units");
        }
        close_scene(&t);
    }
}

/* Row 17: patterns are on contours alone, and leave as much of them as they say. */
static void contours_have_patterns(void)
{
    traced t;
    if (open_scene(&t, write_ball("pattern", 3, false), 1, true)) {
        double lengths[2] = {0, 0}, longest = 0;
        size_t wrong = 0;
        t.values.contours = 2;
        t.values.contour_brush = 1 + BRUSH_CHARCOAL;
        for (int i = 0; i < 2; i++) {
            t.values.contour_dash = i ? 12 : 0;
            check_that("17", trace(&t) == LMN_OK, "traced");
            for (size_t n = 0; n < t.ribbons.ribbon_count; n++) {
                const ribbon       *r = &t.ribbons.ribbons[n];
                const ribbon_point *p = &t.ribbons.points[r->first];
                double              own = (double)(p[r->count - 1].arc - p[0].arc);
                wrong += r->brush != (r->kind == STROKE_PAST ? BRUSH_CHARCOAL : BRUSH_PEN);
                lengths[i] += r->kind == STROKE_PAST ? own : 0;
                longest = i && r->kind == STROKE_PAST ? fmax(longest, own) : longest;
            }
        }
        check_that("17", wrong == 0, "%zu lines with the other one's brush", wrong);
        check_at_most("17", longest, 12.1, "units, the longest dash");
        check_near("17", lengths[1] / lengths[0], 2.0 / 3, 0.1, "of a contour is drawn");
    }
    close_scene(&t);
}

/* A ball that goes to the right, turns and comes back half of the way: its lines tell of the way back alone. */
static void lines_end_where_it_turns(void)
{
    traced t;
    if (open_scene(&t, write_moved("turning", 3, (double[]){0, 0.5, 1}, (double[]){-3.5, 0.5, 0, 3, 0, 0, 1, -0.5, 0}),
                   1, true)) {
        double farthest = INFINITY;
        t.values.length = 1;
        check_that("22", trace(&t) == LMN_OK && count_of(&t, STROKE_SPEED) > 10, "lines");
        for (size_t i = 0; i < t.ribbons.point_count; i++)
            farthest = fmin(farthest, ((double)t.ribbons.points[i].x - PAGE / 2.0) / UNIT);
        check_at_least("22", farthest, -0.1, "no line comes from before the turn: the leftmost point");
    }
    close_scene(&t);
}

/* A wall before the right half of where the ball came from hides both lines and contours there. */
static void walls_hide(void)
{
    moving_scene m;
    traced       t;
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, -3, 0, 0, 1, grey);
    moving_scene_box(&m, 0, 0, 3, (double[]){0.5, 3, 0.1}, grey);
    moving_scene_keys(&m, ball, "translation", 2, (double[]){0, 1}, (double[]){-3, 0, 0, 3, 0, 0});
    const char *path = check_path("wall.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true)) {
        size_t before = 0, beside = 0;
        t.values.contours = 8;
        t.values.length = 1;
        t.values.uneven = 0;
        check_that("18", trace(&t) == LMN_OK, "traced");
        for (size_t i = 0; i < t.ribbons.point_count; i++) {
            bool there = fabs((double)t.ribbons.points[i].x - PAGE / 2.0) < 0.5 * UNIT - 1;
            before += there;
            beside += !there;
        }
        check_at_most("18", (double)before, 0, "points behind the wall");
        check_at_least("18", (double)beside, 200, "points beside it");
    }
    close_scene(&t);
}

/* --- odd motions ---------------------------------------------------------------------------------------------------
 */

static void odd_motions(void)
{
    traced t;
    if (open_scene(&t, write_moved("still", 0, NULL, NULL), 1, true))
        check_that("bad", trace(&t) == LMN_OK && t.facts.bodies == 0 && t.ribbons.ribbon_count == 0,
                   "nothing moves: nothing is drawn");
    close_scene(&t);
    if (open_scene(&t, write_moved("one", 1, (double[]){0}, (double[]){1, 0, 0}), 1, true))
        check_that("bad", trace(&t) == LMN_OK && t.ribbons.ribbon_count == 0, "a clip of one frame: nothing");
    close_scene(&t);
    if (open_scene(
            &t,
            write_moved("jump", 4, (double[]){0, 0.5, 0.5001, 1}, (double[]){-3, 0, 0, -2.7, 0, 0, 2.7, 0, 0, 3, 0, 0}),
            1, true)) {
        double farthest = 3;
        check_that("bad", trace(&t) == LMN_OK && t.facts.jumps > 0, "a jump is found: %zu lines", t.facts.jumps);
        for (size_t i = 0; i < t.ribbons.point_count; i++)
            farthest = fmin(farthest, ((double)t.ribbons.points[i].x - PAGE / 2.0) / UNIT);
        check_at_least("bad", farthest, 1.3, "no line goes over it: the leftmost point");
    }
    close_scene(&t);
    if (open_scene(&t, write_moved("near", 2, (double[]){0, 1}, (double[]){0, 0, -8, 0, 0, 4}), 1, false)) {
        double off = 0, inside = 0;
        check_that("bad", trace(&t) == LMN_OK && t.facts.towards == 1, "what comes nearer is known");
        for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
            const ribbon_point *p = &t.ribbons.points[t.ribbons.ribbons[i].first];
            const ribbon_point *q = p + t.ribbons.ribbons[i].count - 1;
            double              x = (double)p->x - PAGE / 2.0, y = (double)p->y - PAGE / 2.0;
            double              dx = (double)q->x - (double)p->x, dy = (double)q->y - (double)p->y;
            off = fmax(off, fabs(x * dy - y * dx) / fmax(hypot(x, y) * hypot(dx, dy), 1e-9));
            inside += x * dx + y * dy < 0;
        }
        check_at_least("20", (double)count_of(&t, STROKE_SPEED), 20, "rays");
        check_at_most("20", off, 0.02, "rays leave the middle, sine");
        check_at_most("20", inside, 0, "rays that point inwards");
    }
    close_scene(&t);
}

static void chances(void)
{
    enum { FRAMES = 100 };
    traced      t;
    size_t      drawn = 0, same = 0;
    const char *path = write_ball("chance", 3, false);
    for (int i = 0; i < FRAMES; i++) {
        if (!open_scene(&t, path, 0.5 + i * 0.004, true))
            return;
        t.values.probability = 0.3f;
        t.values.lines = 20;
        check_that("21", trace(&t) == LMN_OK, "traced");
        drawn += count_of(&t, STROKE_SPEED);
        ribbon_set first = t.ribbons;
        t.ribbons = (ribbon_set){NULL};
        trace(&t);
        same += first.point_count == t.ribbons.point_count &&
                memcmp(first.points, t.ribbons.points, first.point_count * sizeof *first.points) == 0;
        ribbon_set_release(&first);
        close_scene(&t);
    }
    check_near("21", (double)drawn / (20 * FRAMES), 0.3, 0.04, "share of lines that are there");
    check_that("21", same == FRAMES, "the same call draws the same");
}

/* A ball that shakes along a slope has arcs beside both of its ends, each as far beside the last as is asked for, and
 * none of them is on it; one that passes has none. */
/* `beside`: something passes so fast that a ball that turns round counts as resting beside it. */
static void shake(double swings, bool beside, bool shakes)
{
    enum { KEYS = 129, ARCS = 3 };
    moving_scene m;
    double       times[KEYS], places[3 * KEYS], worst = 0, sides[2] = {0, 0};
    traced       t;
    const double way[2] = {0.8, 0.6};
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, 0, 0, 0, 1, grey);
    for (int i = 0; i < KEYS; i++) {
        double s = 0.4 * sin(2 * pi * swings * i / (KEYS - 1));
        times[i] = (double)i / (KEYS - 1);
        places[3 * i] = s * way[0];
        places[3 * i + 1] = s * way[1];
        places[3 * i + 2] = 0;
    }
    double at[2] = {places[3 * KEYS - 3], places[3 * KEYS - 2]};
    moving_scene_keys(&m, ball, "translation", KEYS, times, places);
    if (beside)
        moving_scene_keys(&m, moving_scene_sphere(&m, 0, 4, 0, 0.5, grey), "translation", 2, (double[]){0, 1},
                          (double[]){-9, 4, 0, 0, 4, 0});
    const char *path = check_path("shaking.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true)) {
        t.values.lines = 0;
        t.values.vibration = ARCS;
        t.values.vibration_apart = 9;
        check_that("2.2.3", trace(&t) == LMN_OK, "traced");
        check_that("2.2.3", t.facts.shaking == shakes && t.ribbons.ribbon_count == 2 * ARCS * shakes,
                   "%g swings: %zu shake, %zu arcs", swings, t.facts.shaking, t.ribbons.ribbon_count);
        for (size_t i = 0; i < t.ribbons.ribbon_count && shakes; i++) {
            const ribbon *r = &t.ribbons.ribbons[i];
            double        asked = UNIT + (double)t.values.begin + 9.0 * (double)(i % ARCS);
            for (uint32_t k = r->first; k < r->first + r->count; k++) {
                double x = (double)t.ribbons.points[k].x - (PAGE / 2 + UNIT * at[0]),
                       y = (double)t.ribbons.points[k].y - (PAGE / 2 - UNIT * at[1]), along = x * way[0] - y * way[1];
                worst = fmax(worst, fabs(hypot(x, y) - asked));
                sides[along > 0]++;
                if (fabs(along) < 0.75 * hypot(x, y))
                    check_that("2.2.3", false, "an arc lies across the swing");
            }
        }
        check_at_most("2.2.3", worst, 0.6, "distance of arcs from where they should be");
        check_that("2.2.3", sides[0] == sides[1], "%g and %g points beside the two ends", sides[0], sides[1]);
    }
    close_scene(&t);
}

static void shaking_has_arcs(void)
{
    enum { ARCS = 3 };
    traced t;
    shake(2.3, false, true);
    shake(2.25, true, true);  /* it turns round just now */
    shake(0.5, false, true);  /* once there and back */
    shake(0.6, false, false); /* and on beyond where it began */
    shake(0.4, false, false);
    if (open_scene(&t, write_ball("passes", 3, false), 1, true)) {
        t.values.lines = 0;
        t.values.vibration = ARCS;
        check_that("2.2.3", trace(&t) == LMN_OK && t.facts.shaking == 0 && t.ribbons.ribbon_count == 0,
                   "what passes has no arcs");
    }
    close_scene(&t);
}

/* Of a pendulum the arcs lie beside its bob, not beside its rod. */
static void pendulums_swing_below(void)
{
    enum { KEYS = 129 };
    moving_scene m;
    double       times[KEYS], turns[4 * KEYS], middle[2] = {0, 0};
    const double rod[3] = {0.05, 1, 0.05};
    traced       t;
    for (int i = 0; i < KEYS; i++) {
        const double swing = 0.2 * sin(2 * pi * 2 * i / (KEYS - 1)), q[4] = {0, 0, sin(swing / 2), cos(swing / 2)};
        times[i] = (double)i / (KEYS - 1);
        memcpy(turns + 4 * i, q, sizeof q);
    }
    moving_scene_begin(&m);
    int hinge = moving_scene_joint(&m, 0, 2, 0);
    moving_scene_put_in(&m, moving_scene_box(&m, 0, -1, 0, rod, grey), hinge);
    moving_scene_put_in(&m, moving_scene_sphere(&m, 0, -2.5, 0, 0.5, grey), hinge);
    moving_scene_keys(&m, hinge, "rotation", KEYS, times, turns);
    const char *path = check_path("pendulum.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true)) {
        t.values.lines = 0;
        t.values.vibration = 2;
        t.values.vibration_apart = 9;
        check_that("2.2.3", trace(&t) == LMN_OK && t.ribbons.ribbon_count == 4, "%zu arcs", t.ribbons.ribbon_count);
        for (size_t i = 0; i < t.ribbons.point_count; i++) {
            middle[0] += (double)t.ribbons.points[i].x / (double)t.ribbons.point_count;
            middle[1] += (double)t.ribbons.points[i].y / (double)t.ribbons.point_count;
        }
        check_at_most("2.2.3", hypot(middle[0] - PAGE / 2, middle[1] - (PAGE / 2 + 0.5 * UNIT)), 0.25 * UNIT,
                      "arcs are so far from being around the bob");
    }
    close_scene(&t);
}

/* What is stretched ever more has lines along its way all the same, from where its rear is now. */
static void shapes_bend_no_lines(void)
{
    traced           t;
    double           aside = 0, low = PAGE, high = 0;
    part_deformation how = {.stretch = 0.8, .full_speed = 3, .full_acceleration = 12};
    pose_deformation all = {&how, 1, 0.04, 1};
    lmn_error        error = {0};
    /* At its full speed, by an acceleration of 12 a second squared. */
    const double stretched = 1.8 * (1 + 0.8 * 12 * 0.04 / 2 / (3 * 2 * sqrt(3)));
    if (open_scene(&t, write_ball("stretched", 3, true), 0.9, true)) {
        moment when = t.pose.when;
        when.deformation = &all;
        when.deformation_hash = all.hash;
        check_that("14", pose_move(&t.pose, &when, &error) == LMN_OK, "deformed");
        t.values.uneven = 0;
        check_that("14", trace(&t) == LMN_OK && t.ribbons.ribbon_count > 10, "lines are drawn");
        for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
            const ribbon       *r = &t.ribbons.ribbons[i];
            const ribbon_point *p = &t.ribbons.points[r->first];
            for (uint32_t n = 0; n < r->count; n++)
                aside = fmax(aside, fabs((double)p[n].y - (double)p[0].y));
            low = fmin(low, (double)p[0].y);
            high = fmax(high, (double)p[0].y);
        }
        check_at_most("14", aside, 0.1, "how far lines leave their height");
        check_at_most("14", fabs(high - low - 2 * UNIT / sqrt(stretched)), 0.3,
                      "the outermost lines are beside a thinner ball");
    }
    close_scene(&t);
}

/* Of what a section takes away there are neither lines nor contours: here all above the middle of a ball. A part that
 * it spares has all of them. */
static void sections_take_lines(void)
{
    traced t;
    cut    upper = {.plane_count = 1, .cell_count = 1, .planes = {{{0, 1, 0}, 0}}, .snap = 1e-6};
    upper.cells[0] = (cut_cell){1, {{0, true}}};
    if (open_scene(&t, write_ball("section", 3, false), 1, true)) {
        t.values.contours = 2;
        t.section.cut = &upper;
        for (int spared = 0; spared < 2; spared++) {
            size_t points[2][2] = {{0, 0}, {0, 0}}; /* of lines, contours: above, below */
            t.section.spared = spared ? t.parts : NULL;
            check_that("section", trace(&t) == LMN_OK, "traced");
            for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
                const ribbon *r = &t.ribbons.ribbons[i];
                for (uint32_t k = r->first; k < r->first + r->count; k++)
                    points[r->kind == STROKE_PAST][(double)t.ribbons.points[k].y > PAGE / 2.0 - 0.1]++;
            }
            for (int past = 0; past < 2; past++) {
                check_at_least("section", (double)points[past][1], 200, "points below");
                if (spared)
                    check_at_least("section", (double)points[past][0], 200, "points above, spared");
                else
                    check_at_most("section", (double)points[past][0], 0, "points above");
            }
            if (!spared)
                check_that("A3", count_of(&t, STROKE_SPEED) == 24, "%zu lines of 24, all of what is left",
                           count_of(&t, STROKE_SPEED));
        }
    }
    close_scene(&t);
}

/* --- figures whose parts pass before each other ------------------------------------------------------------------ */

/* An arm passes before a body that moves more slowly, the upper quarter of it above that: there all of its lines are,
 * from one end of what can be seen to the other, as many as were asked for. */
static void arms_before_bodies(void)
{
    moving_scene m;
    traced       t;
    moving_scene_begin(&m);
    int body = moving_scene_box(&m, 0, 0, 0, (double[]){2, 2, 0.2}, grey),
        arm = moving_scene_box(&m, 0, 1, 1, (double[]){0.2, 2, 0.2}, grey);
    moving_scene_keys(&m, body, "translation", 2, (double[]){0, 1}, (double[]){-0.1, 0, 0, 0, 0, 0});
    moving_scene_keys(&m, arm, "translation", 2, (double[]){0, 1}, (double[]){-1.5, 1, 1, 0, 1, 1});
    const char *path = check_path("arm_before.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true) && check_that("A1", trace(&t) == LMN_OK, "traced")) {
        double low = PAGE, high = 0;
        for (size_t i = 0; i < t.ribbons.ribbon_count; i++) {
            const ribbon_point *p = &t.ribbons.points[t.ribbons.ribbons[i].first];
            low = fmin(low, (double)p->y);
            high = fmax(high, (double)p->y);
        }
        check_that("A3", count_of(&t, STROKE_SPEED) == 24, "%zu of 24 lines", count_of(&t, STROKE_SPEED));
        check_near("A1", low, PAGE / 2.0 - 3 * UNIT, 2, "the uppermost line is that of the arm's end");
        check_near("A1", high, PAGE / 2.0 - 2 * UNIT, 2, "the lowest line is where it passes above the body");
        check_at_most("A1", t.facts.measures.extent, 2, "as measured");
        check_at_most("A6", t.facts.measures.inside, 0, "length of lines on the figure");
    }
    close_scene(&t);
}

/* How far points of a ribbon are off a circle about an axis that is aslant by an angle and lies along x, at best. */
static double off_circle(const ribbon_point *p, uint32_t count, double aslant)
{
    double best = INFINITY;
    for (double middle = -1.2; middle <= 1.2; middle += 0.002) {
        double least = INFINITY, most = 0;
        for (uint32_t k = 0; k < count; k++) {
            double x = ((double)p[k].x - PAGE / 2.0 - middle * UNIT) / cos(aslant), y = (double)p[k].y - PAGE / 2.0;
            least = fmin(least, hypot(x, y));
            most = fmax(most, hypot(x, y));
        }
        best = fmin(best, most - least);
    }
    return best;
}

/* A ball that turns about an axis that is aslant has lines on circles about that axis, and edge-on, too. */
static void wheels_at_any_angle(void)
{
    for (int step = 0; step < 4; step++) {
        moving_scene m;
        traced       t;
        double       aslant = step * pi / 6, times[9], turns[36];
        moving_scene_begin(&m);
        int joint = moving_scene_joint(&m, 0, 0, 0), ball = moving_scene_sphere(&m, 0, 0, 0, 1, grey);
        moving_scene_put_in(&m, ball, joint);
        for (int i = 0; i < 9; i++) { /* aslant · turned */
            double half = pi / 2 * i / 8, c = cos(aslant / 2), s = sin(aslant / 2);
            times[i] = i / 8.0;
            memcpy(&turns[4 * i], (double[]){s * sin(half), s * cos(half), c * sin(half), c * cos(half)},
                   4 * sizeof(double));
        }
        moving_scene_keys(&m, joint, "rotation", 9, times, turns);
        const char *path = check_path("wheel%d.glb", step);
        moving_scene_write(&m, path);
        if (open_scene(&t, path, 1, true) && check_that("23", trace(&t) == LMN_OK, "traced")) {
            double off = 0;
            for (size_t i = 0; i < t.ribbons.ribbon_count && step < 3; i++) {
                const ribbon *r = &t.ribbons.ribbons[i];
                off = fmax(off, off_circle(&t.ribbons.points[r->first], r->count, aslant));
            }
            check_at_least("23", (double)t.facts.measures.lines, step < 3 ? 8 : 2, "lines at an angle");
            check_at_most("23", off, 0.5, "lines are off circles about the axis by, units");
            check_at_most("A6", t.facts.measures.inside, 0, "length of lines on the ball");
            check_at_most("A7", t.facts.measures.length, 1, "of their ways");
        }
        close_scene(&t);
    }
}

/* What jumps from one place to another is no measure of how fast things are: what goes beside it keeps its lines. */
static void jumps_take_no_lines(void)
{
    moving_scene m;
    traced       t;
    moving_scene_begin(&m);
    int slow = moving_scene_sphere(&m, 0, 2, 0, 1, grey), jumping = moving_scene_sphere(&m, 0, -2, 0, 1, grey);
    moving_scene_keys(&m, slow, "translation", 2, (double[]){0, 1}, (double[]){-1, 2, 0, 0, 2, 0});
    moving_scene_keys(&m, jumping, "translation", 4, (double[]){0, 0.97, 0.9701, 1},
                      (double[]){-3, -2, 0, -3, -2, 0, 3, -2, 0, 3, -2, 0});
    const char *path = check_path("leap.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, 1, true) && check_that("bad", trace(&t) == LMN_OK, "traced")) {
        check_that("bad", t.facts.leaps == 1 && t.facts.bodies == 1, "%zu jump, %zu bodies", t.facts.leaps,
                   t.facts.bodies);
        check_that("A3", count_of(&t, STROKE_SPEED) == 24, "%zu of 24 lines", count_of(&t, STROKE_SPEED));
    }
    close_scene(&t);
}

/* Every allocation may fail. */
static void memory_may_run_out(void)
{
    traced t;
    if (open_scene(&t, write_ball("memory", 3, false), 1, true)) {
        lmn_status status = LMN_MEMORY;
        long       n = 1, other = 0;
        t.values.contours = 1;
        t.values.lines = 3;
        t.values.vibration = 1;
        for (; status != LMN_OK && n < 20000; n += 1 + n / 40) {
            mem_fail_at(n);
            status = trace(&t);
            mem_fail_at(0);
            other += status != LMN_OK && status != LMN_MEMORY;
        }
        check_that("memory", status == LMN_OK && n > 40 && other == 0, "%ld allocations", n);
    }
    close_scene(&t);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"requirements", requirements},
        {"behind", lines_lie_behind},
        {"arcs", rods_leave_arcs},
        {"contours", contours_of_the_past},
        {"flow", flow_lines},
        {"flow turns", flow_lines_turn},
        {"circle", lines_on_circles},
        {"pattern", contours_have_patterns},
        {"turn", lines_end_where_it_turns},
        {"figures", figures_of_the_past},
        {"swept", swept_forms},
        {"rods", swept_rods},
        {"walls", walls_hide},
        {"odd", odd_motions},
        {"chances", chances},
        {"shapes", shapes_bend_no_lines},
        {"shaking", shaking_has_arcs},
        {"pendulum", pendulums_swing_below},
        {"section", sections_take_lines},
        {"limbs", arms_before_bodies},
        {"wheels", wheels_at_any_angle},
        {"leap", jumps_take_no_lines},
        {"memory", memory_may_run_out},
    };
    return check_main(argc, argv, "traces", cases, sizeof cases / sizeof *cases);
}
