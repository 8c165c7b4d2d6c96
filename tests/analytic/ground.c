/* The shadow on the ground against its law, added up column by column in double precision; where it is not; and that
 * nothing else changes for it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { CELLS = 60, HEIGHTS = 80 };

/* What stands over a place of the ground, from a to b; false: nothing. */
typedef bool (*column_fn)(double x, double z, double *a, double *b);

typedef struct ground_scene {
    const char *name;
    column_fn   column;
    void (*make)(shape *s);
    double half[2], height; /* of the model, whose middle is above the origin */
} ground_scene;

static bool ball_column(double x, double z, double *a, double *b)
{
    double left = 1 - x * x - z * z;
    *a = 1 - sqrt(fmax(left, 0));
    *b = 2 - *a;
    return left > 0;
}

static void make_ball(shape *s)
{
    shape_sphere(s, "ball", dvec_of(0, 1, 0), 1, 64, 128, true);
}

static bool box_column(double x, double z, double *a, double *b)
{
    *a = 0;
    *b = 1;
    return fabs(x) < 0.8 && fabs(z) < 0.6;
}

static void make_box(shape *s)
{
    shape_box(s, "box", dvec_of(-0.8, 0, -0.6), dvec_of(0.8, 1, 0.6));
}

static bool chair_column(double x, double z, double *a, double *b)
{
    *a = fabs(x - 0.5) < 0.2 && fabs(z - 0.4) < 0.2 ? 0 : 0.5;
    *b = z < -0.4 ? 1.2 : 0.6; /* like a chair */
    return fabs(x) < 1 && fabs(z) < 0.8;
}

static void make_chair(shape *s)
{
    shape_box(s, "top", dvec_of(-1, 0.5, -0.8), dvec_of(1, 0.6, 0.8));
    shape_box(s, "leg", dvec_of(0.3, 0, 0.2), dvec_of(0.7, 0.5, 0.6));
    shape_box(s, "back", dvec_of(-1, 0.6, -0.8), dvec_of(1, 1.2, -0.4));
}

static bool step_column(double x, double z, double *a, double *b)
{
    *a = 0;
    *b = z < -0.2 ? 1 : 0.05;
    return fabs(x) < 0.8 && fabs(z) < 0.6;
}

static void make_step(shape *s)
{
    shape_box(s, "plate", dvec_of(-0.8, 0, -0.6), dvec_of(0.8, 0.05, 0.6));
    shape_box(s, "wall", dvec_of(-0.8, 0.05, -0.6), dvec_of(0.8, 1, -0.2));
}

static const ground_scene scenes[] = {
    {"ball", ball_column, make_ball, {1, 1}, 2},
    {"box", box_column, make_box, {0.8, 0.6}, 1},
    {"chair", chair_column, make_chair, {1, 0.8}, 1.2},
    {"step", step_column, make_step, {0.8, 0.6}, 1},
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* --- the law -------------------------------------------------------------------------------------------- */

typedef struct ground_cell {
    double x, z, a, b;
    bool   there;
} ground_cell;

typedef struct ground_law {
    ground_cell cells[CELLS][CELLS];
    double      reach, side[2];
} ground_law;

static double reach_of(const ground_scene *g)
{
    return 0.15 * sqrt(4 * g->half[0] * g->half[0] + 4 * g->half[1] * g->half[1] + g->height * g->height);
}

static ground_law *law_of(const ground_scene *g)
{
    ground_law *law = check_alloc(1, sizeof *law);
    law->reach = reach_of(g);
    for (int k = 0; k < 2; k++)
        law->side[k] = 2 * g->half[k] / CELLS;
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            ground_cell *c = &law->cells[i][k];
            c->x = -g->half[0] + (i + 0.5) * law->side[0];
            c->z = -g->half[1] + (k + 0.5) * law->side[1];
            c->there = g->column(c->x, c->z, &c->a, &c->b);
        }
    return law;
}

/* Of a Gaussian around a place, what falls between two others. */
static double between(double from, double to, double around, double deviation)
{
    double narrow = 1 / (fmax(deviation, 1e-6) * sqrt(2));
    return 0.5 * (erf((to - around) * narrow) - erf((from - around) * narrow));
}

static double law_at(const ground_law *law, double x, double z)
{
    double sum = 0, across[CELLS], along[CELLS];
    for (int n = 0; n < HEIGHTS; n++) { /* each takes as much */
        double height = -law->reach * log((n + 0.5) / HEIGHTS);
        for (int i = 0; i < CELLS; i++) {
            const ground_cell *c = &law->cells[i][0], *d = &law->cells[0][i];
            across[i] = between(c->x - law->side[0] / 2, c->x + law->side[0] / 2, x, height / 2);
            along[i] = between(d->z - law->side[1] / 2, d->z + law->side[1] / 2, z, height / 2);
        }
        for (int i = 0; i < CELLS; i++)
            for (int k = 0; k < CELLS; k++) {
                const ground_cell *c = &law->cells[i][k];
                if (c->there && height >= c->a && height <= c->b)
                    sum += across[i] * along[k] / HEIGHTS;
            }
    }
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            const ground_cell *c = &law->cells[i][k];
            if (c->there)
                sum += exp(-c->b / law->reach) *
                       between(c->x - law->side[0] / 2, c->x + law->side[0] / 2, x, c->a / 2) *
                       between(c->z - law->side[1] / 2, c->z + law->side[1] / 2, z, c->a / 2);
        }
    return fmin(sum, 1);
}

/* --- drawings ------------------------------------------------------------------------------------------- */

static const char *look_of(const char *scene)
{
    static char look[512];
    snprintf(look, sizeof look,
             "{\"version\":2,\"name\":\"t\",\"scene\":{%s},\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":"
             "\"flat\"}]}",
             scene);
    return look;
}

static const char *const dark = "\"ground\":\"contact\",\"ground_strength\":1,\"ground_colour\":\"#000000\"";

static shot_view view_of(double degrees, double height, bool orthographic)
{
    double angle = degrees * 3.14159265358979 / 180;
    return (shot_view){.width = 400,
                       .height = 400,
                       .eye = {6 * sin(angle), height, 6 * cos(angle)},
                       .target = {0, 0.3, 0},
                       .up = {0, 1, 0},
                       .orthographic = orthographic};
}

static double darkness_at(const shot *s, int x, int y)
{
    return 1 - s->picture[4 * ((size_t)y * (size_t)s->width + (size_t)x)] / 255.0;
}

/* Where the ray of a pixel meets the ground at a level. */
static dvec on_ground(const shot *s, int x, int y, double level)
{
    dvec origin, direction;
    shot_ray(s, x + 0.5, y + 0.5, &origin, &direction);
    return dvec_add(origin, dvec_scale(direction, (level - origin.y) / direction.y));
}

static void the_law_holds(void)
{
    for (int i = 0; i < 2 * SCENES; i++) {
        const ground_scene *g = &scenes[i / 2];
        shot_view           view = view_of(25 + 40 * (i % 2), 4 + 2 * (i % 2), i % 2);
        shape               model = {0};
        shot                s;
        g->make(&model);
        if (shot_of_shape(&s, &model, "ground.glb", look_of(dark), NULL, &view)) {
            ground_law *law = law_of(g);
            double      mean = 0, worst = 0, most = 0;
            int         count = 0, far = 0;
            for (int y = 3; y < s.height; y += 12)
                for (int x = 3 + y % 5; x < s.width; x += 13) {
                    if (s.depth[y * s.width + x] < INFINITY)
                        continue;
                    dvec   at = on_ground(&s, x, y, 0);
                    double wanted = law_at(law, at.x, at.z), off = fabs(darkness_at(&s, x, y) - wanted);
                    mean += off;
                    worst = fmax(worst, off);
                    most = fmax(most, wanted);
                    far += off > 0.05;
                    count++;
                }
            check_at_least("ground", most, 0.1, "%s: the darkest of %d places beside it", g->name, count);
            check_at_most("ground", mean / count, 0.006, "%s: mean difference from the law", g->name);
            /* Where something upright touches, the law has a step, and the map texels. */
            check_at_most("ground", (double)far / count, 0.005, "%s: fraction of places off by 0.05 (worst %.3f)",
                          g->name, worst);
            picture_write_rgba(check_path("%s-%d.png", g->name, i % 2), s.picture, s.width, s.height);
            free(law);
            shot_release(&s);
        }
        shape_release(&model);
    }
}

/* What floats six reaches high leaves the ground beneath it as it is; what stands beside it does not. */
static void floating_has_none(void)
{
    shape     model = {0};
    shot      s;
    shot_view view = view_of(0, 6, true);
    shape_box(&model, "standing", dvec_of(-2, 0, -0.4), dvec_of(-1.2, 0.8, 0.4));
    shape_box(&model, "floating", dvec_of(1.2, 4, -0.4), dvec_of(2, 4.4, 0.4));
    if (shot_of_shape(&s, &model, "floating.glb", look_of(dark), NULL, &view)) {
        dvec beneath = shot_project(&s, dvec_of(1.6, 0, 0)), beside = shot_project(&s, dvec_of(-1.1, 0, 0.0));
        check_at_most("ground", darkness_at(&s, (int)beneath.x, (int)beneath.y), 0.02, "beneath what floats");
        check_at_least("ground", darkness_at(&s, (int)beside.x, (int)beside.y), 0.08, "beside what stands");
        shot_release(&s);
    }
    shape_release(&model);
}

/* --- where there is none -------------------------------------------------------------------------------- */

static int pixels_changed(const char *scene, const shot_view *view, bool *same_maps)
{
    shape model = {0};
    char  with[256];
    shot  a, b;
    int   changed = -1;
    snprintf(with, sizeof with, "%s%s%s", dark, *scene ? "," : "", scene);
    make_ball(&model);
    if (shot_of_shape(&a, &model, "none.glb", look_of(scene), NULL, view)) {
        if (shot_of_shape(&b, &model, "none.glb", look_of(with), NULL, view)) {
            changed = shot_differing(&a, &b, 0);
            *same_maps = memcmp(a.depth, b.depth, sizeof *a.depth * (size_t)(a.width * a.height)) == 0 &&
                         memcmp(a.id, b.id, sizeof *a.id * (size_t)(a.width * a.height)) == 0 &&
                         memcmp(a.view, b.view, sizeof a.view) == 0 &&
                         memcmp(a.projection, b.projection, sizeof a.projection) == 0;
            shot_release(&b);
        }
        shot_release(&a);
    }
    shape_release(&model);
    return changed;
}

static void nothing_else_changes(void)
{
    shot_view below = view_of(30, -3, false), level = view_of(30, 0.3, true), above = view_of(30, 4, false),
              fitted = {.width = 400, .height = 300, .bare = true};
    bool same = false;
    check_near("ground", pixels_changed("", &below, &same), 0, 0, "values that it changes in a view from below");
    check_near("ground", pixels_changed("", &level, &same), 0, 0, "the same in an elevation with parallel rays");
    check_near("ground", pixels_changed("\"cut\":\"x=60%\"", &above, &same), 0, 0, "the same in a section");
    check_at_least("ground", pixels_changed("", &above, &same), 1000, "the same from above");
    check_that("ground", same, "depths, parts and camera are the same");
    check_at_least("ground", pixels_changed("", &fitted, &same), 1000, "in a view that is fitted");
    check_that("ground", !same, "and what is seen of it is fitted, too (analytic.fit)");
}

/* A flat shadow has two tones and a border of a pixel. */
static void flat_has_one_tone(void)
{
    shape     model = {0};
    shot      s;
    shot_view view = view_of(25, 5, false);
    char      scene[256];
    snprintf(scene, sizeof scene, "%s,\"ground_flat\":true", dark);
    make_ball(&model);
    if (shot_of_shape(&s, &model, "flat.glb", look_of(scene), NULL, &view)) {
        int full = 0, between_tones = 0;
        for (int i = 0; i < s.width * s.height; i++) {
            uint8_t value = s.picture[4 * i];
            bool    empty = !(s.depth[i] < INFINITY);
            full += empty && value == 0;
            between_tones += empty && value > 0 && value < 255;
        }
        check_at_least("ground", full, 500, "pixels of the flat tone");
        check_at_most("ground", between_tones, 4 * sqrt(full) * 3, "pixels between it and the paper");
        shot_release(&s);
    }
    shape_release(&model);
}

/* --- by the medium -------------------------------------------------------------------------------------- */

/* A screen of dots draws it: nothing but ink and paper, as much ink as the shadow is dark. */
static void media_draw_it(void)
{
    const ground_scene *g = &scenes[0];
    shape               model = {0};
    shot                s, plain;
    shot_view           view = view_of(25, 6, true);
    static const char  *look =
        "{\"version\":2,\"name\":\"t\",\"scene\":{%s},\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"surface\":{"
        "\"technique\":\"dots\",\"coordinates\":\"screen\",\"ink\":\"#000000\"}}]}";
    char with[512], without[512];
    snprintf(with, sizeof with, look, dark);
    snprintf(without, sizeof without, look, "\"ground\":\"none\"");
    view.width = view.height = 600;
    make_ball(&model);
    if (shot_of_shape(&s, &model, "medium.glb", with, NULL, &view)) {
        ground_law *law = law_of(g);
        double      drawn = 0, wanted = 0;
        int         count = 0;
        for (int y = 0; y < s.height; y++)
            for (int x = 0; x < s.width; x++) {
                dvec at = on_ground(&s, x, y, 0);
                if (s.depth[y * s.width + x] < INFINITY || hypot(at.x, at.z) > 1.05 || at.z < 0)
                    continue;
                drawn += darkness_at(&s, x, y);
                wanted += (x + y) % 13 == 0 ? 13 * law_at(law, at.x, at.z) : 0;
                count++;
            }
        check_at_least("ground", count, 2000, "pixels of the shadow");
        check_near("ground", drawn / count, wanted / count, 0.05, "ink that dots lay there");
        free(law);
        if (shot_of_shape(&plain, &model, "medium.glb", without, NULL, &view)) {
            int outside = 0;
            for (int i = 0; i < s.width * s.height; i++)
                outside += s.depth[i] < INFINITY && memcmp(&s.picture[4 * i], &plain.picture[4 * i], 4) != 0;
            check_at_most("ground", outside, 40, "pixels of the model that are drawn otherwise for it");
            shot_release(&plain);
        }
        picture_write_rgba(check_path("dots.png"), s.picture, s.width, s.height);
        shot_release(&s);
    }
    shape_release(&model);
}

/* --- the shadow that a light throws ---------------------------------------------------------------------- */

enum { CAST_SIDE = 400, UNKNOWN = -1 };

/* A block that stands on the ground. */
static const double cast_low[3] = {-1, 0, -0.6}, cast_high[3] = {1, 2.4, 0.7};

/* Does the ray from a place hit it? */
static bool is_kept_off(dvec from, dvec towards)
{
    const double at[3] = {from.x, from.y, from.z}, way[3] = {towards.x, towards.y, towards.z};
    double       enters = 0, leaves = INFINITY;
    for (int k = 0; k < 3; k++) {
        double first = (cast_low[k] - at[k]) / way[k], second = (cast_high[k] - at[k]) / way[k];
        enters = fmax(enters, fmin(first, second));
        leaves = fmin(leaves, fmax(first, second));
    }
    return enters < leaves;
}

/* A direction of the viewer's. The view turns and shifts alone: its transpose turns back. */
static dvec in_scene(const shot *s, dvec direction)
{
    double        ignored;
    const double *m = s->view;
    const double  back[16] = {m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, 0, 0, 0, 1};
    return dmat_apply(back, direction, 0, &ignored);
}

/* Per pixel 1 where the ground lies in shadow, 0 where it is lit, UNKNOWN where it is not seen. */
static signed char *cast_truth(const shot *s, dvec light)
{
    signed char *out = check_alloc((size_t)CAST_SIDE * CAST_SIDE, 1);
    dvec         towards = in_scene(s, light);
    for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
        dvec origin, way;
        shot_ray(s, i % CAST_SIDE + 0.5, i / CAST_SIDE + 0.5, &origin, &way);
        bool falls = way.y < 0 && !s->id[i];
        dvec at = falls ? dvec_add(origin, dvec_scale(way, -origin.y / way.y)) : origin;
        out[i] = (signed char)(falls ? is_kept_off(at, towards) : UNKNOWN);
    }
    return out;
}

/* Is there another answer within so many pixels? */
static bool is_near_border(const signed char *truth, int at, int reach)
{
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            int column = at % CAST_SIDE + x, row = at / CAST_SIDE + y;
            if (column >= 0 && row >= 0 && column < CAST_SIDE && row < CAST_SIDE &&
                truth[row * CAST_SIDE + column] != truth[at])
                return true;
        }
    return false;
}

static bool shoot_cast_with(shot *out, const shape *model, const char *more, const char *surface, bool orthographic)
{
    char      look[700];
    shot_view view = {.width = CAST_SIDE,
                      .height = CAST_SIDE,
                      .eye = {3, 7, 9},
                      .target = {1.2, 0, 0},
                      .up = {0, 1, 0},
                      .fov_deg = 45,
                      .orthographic = orthographic};
    snprintf(
        look, sizeof look,
        "{\"version\":2,\"name\":\"f\",\"doc\":\"x.\",\"scene\":{\"ground\":\"cast\",\"ground_colour\":\"#000000\","
        "\"light_direction\":[-0.7,0.75,0.3],%s},\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\","
        "\"surface\":%s}]}",
        more, surface);
    return shot_of_shape(out, model, "cast.glb", look, NULL, &view);
}

static bool shoot_cast(shot *out, const shape *model, const char *more, bool orthographic)
{
    return shoot_cast_with(out, model, more, "\"flat\"", orthographic);
}

/* How dark a soft shadow is, over all pixels of ground that some of the light's disc does not reach, against the
 * fraction of it that does not, counted: the mean difference. */
static double soft_shadow_off(const shot *soft, dvec light, double degrees)
{
    enum { RAYS = 64 };
    const int pixels = CAST_SIDE * CAST_SIDE;
    double   *dark = check_alloc((size_t)pixels, sizeof *dark), off = 0;
    int       count = 0;
    dvec      ahead = dvec_unit(light), right = dvec_unit(dvec_cross(ahead, dvec_of(0, 1, 0))),
         up = dvec_cross(right, ahead);
    for (int r = 0; r < RAYS; r++) {
        double away = tan(degrees / 2 * 3.14159265358979 / 180) * sqrt((r + 0.5) / RAYS), turn = 2.39996323 * r;
        dvec towards = dvec_add(ahead, dvec_add(dvec_scale(right, away * cos(turn)), dvec_scale(up, away * sin(turn))));
        signed char *truth = cast_truth(soft, towards);
        for (int i = 0; i < pixels; i++)
            dark[i] += truth[i] == UNKNOWN ? -1e9 : (double)truth[i] / RAYS;
        free(truth);
    }
    for (int i = 0; i < pixels; i++)
        if (dark[i] > 0) {
            off += fabs(dark[i] - (1 - picture_shown(soft->picture[4 * i])));
            count++;
        }
    free(dark);
    return off / fmax(count, 1);
}

/* By rays: where the light does not reach the ground it is dark, elsewhere it is as it was. */
static void cast_shadows_are_where_rays_say(void)
{
    const dvec light = dvec_of(-0.7, 0.75, 0.3);
    shape      model = {0};
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        shot hard, soft, edged;
        int  counts[2] = {0}, wrong = 0, greys[2] = {0}, far_ink = 0, borders = 0, inked = 0;
        if (!shoot_cast(&hard, &model, "\"ground_strength\":1", orthographic))
            continue;
        bool         both = shoot_cast(&soft, &model, "\"ground_strength\":1,\"shadow_softness\":12", orthographic);
        bool         all = both && shoot_cast(&edged, &model, "\"ground_strength\":0,\"ground_edge\":2", orthographic);
        signed char *truth = cast_truth(&hard, light);
        for (int i = 0; i < CAST_SIDE * CAST_SIDE && all; i++) {
            if (truth[i] == UNKNOWN)
                continue;
            int ink = 255 - edged.picture[4 * i];
            counts[truth[i]]++;
            greys[0] += hard.picture[4 * i] > 20 && hard.picture[4 * i] < 235;
            greys[1] += soft.picture[4 * i] > 20 && soft.picture[4 * i] < 235;
            wrong += (hard.picture[4 * i] < 128) != (truth[i] == 1) && !is_near_border(truth, i, 1);
            far_ink += ink > 20 && !is_near_border(truth, i, 4);
            int here = i % CAST_SIDE + 1 < CAST_SIDE && truth[i] + truth[i + 1] == 1 && truth[i] != UNKNOWN &&
                       truth[i + 1] != UNKNOWN;
            borders += here;
            inked += here && (ink > 127 || edged.picture[4 * (i + 1)] < 128);
        }
        check_at_least("ground", counts[1], 3000, "pixels of ground in shadow");
        check_at_most("ground", (double)wrong / fmax(counts[0] + counts[1], 1), 0.0005,
                      "share that is drawn otherwise");
        check_at_least("ground", (double)greys[1] / fmax(greys[0], 1), 2,
                       "grey pixels of a soft shadow over a hard one's");
        check_at_most("ground", all ? soft_shadow_off(&soft, light, 12) : INFINITY, 0.05,
                      "a soft shadow against the fraction of the light that is kept off, mean");
        check_at_most("ground", far_ink, 0, "ink of the border's line away from it");
        check_at_least("ground", borders, 60, "places of the border");
        check_at_least("ground", (double)inked / fmax(borders, 1), 0.98, "share of them with the line");
        free(truth);
        shot_release(&hard);
        if (both)
            shot_release(&soft);
        if (all)
            shot_release(&edged);
    }
    shape_release(&model);
}

/* What is drawn with strokes: their share of ink where they are whole and near the border, and how much of it changes
 * along them and across. */
typedef struct strokes_seen {
    double inner, border, outside, along, across;
    int    inner_count, border_count;
} strokes_seen;

enum { STROKES_APART = 4 };

static strokes_seen look_at_strokes(const shot *s, const signed char *truth)
{
    strokes_seen out = {0};
    for (int y = 8; y < CAST_SIDE - 8; y++)
        for (int x = 8; x < CAST_SIDE - 8; x++) {
            int    i = y * CAST_SIDE + x;
            double ink = 1 - s->picture[4 * i] / 255.0;
            if (truth[i] == 0 && !is_near_border(truth, i, 1))
                out.outside += ink;
            if (truth[i] != 1)
                continue;
            if (is_near_border(truth, i, 2)) {
                out.border += ink;
                out.border_count++;
            } else if (!is_near_border(truth, i, 3 * STROKES_APART)) {
                out.inner += ink;
                out.inner_count++;
                /* about 30 degrees, and half way to the next stroke; rows run downwards */
                out.along += fabs(ink - (1 - s->picture[4 * (i - CAST_SIDE + 2)] / 255.0));
                out.across += fabs(ink - (1 - s->picture[4 * (i - 2 * CAST_SIDE - 1)] / 255.0));
            }
        }
    out.inner /= fmax(out.inner_count, 1);
    out.border /= fmax(out.border_count, 1);
    return out;
}

/* As dense as the shadow is dark, tapered at its border, none beside it, and where they were told to run. */
static void cast_shadows_are_hatched(void)
{
    static const double strengths[] = {0.25, 0.5, 1};
    const dvec          light = dvec_of(-0.7, 0.75, 0.3);
    shape               model = {0};
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    for (int k = 0; k < 3; k++) {
        char text[120];
        shot s;
        snprintf(text, sizeof text, "\"ground_strength\":%g,\"ground_hatch\":\"%dpx\",\"ground_angle\":30",
                 strengths[k], STROKES_APART);
        if (!shoot_cast(&s, &model, text, k & 1))
            continue;
        signed char *truth = cast_truth(&s, light);
        strokes_seen seen = look_at_strokes(&s, truth);
        check_at_least("ground", seen.inner_count, 400, "pixels well within the shadow");
        check_near("ground", seen.inner, strengths[k], 0.05, "share of ink of strokes %g dark", strengths[k]);
        check_at_most("ground", seen.border, 0.75 * seen.inner, "  at the border, where they taper");
        check_at_most("ground", seen.outside, 0, "  ink beside the shadow");
        if (strengths[k] < 1)
            check_at_most("ground", seen.along, 0.5 * seen.across, "  changes along strokes and across");
        free(truth);
        shot_release(&s);
    }
    shape_release(&model);
}

/* Pixels of shadow within so much of where the shadow of a place falls. */
static int dark_below(const shot *s, dvec place, dvec light, double reach)
{
    dvec towards = in_scene(s, light), foot = dvec_sub(place, dvec_scale(towards, place.y / towards.y));
    int  dark = 0;
    for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
        dvec origin, way;
        shot_ray(s, i % CAST_SIDE + 0.5, i / CAST_SIDE + 0.5, &origin, &way);
        dvec at = dvec_add(origin, dvec_scale(way, -origin.y / way.y));
        dark += !s->id[i] && s->picture[4 * i] < 128 && hypot(at.x - foot.x, at.z - foot.z) < reach;
    }
    return dark;
}

/* A block, a leaf in the air, whose shadow lies by itself, and a peg as small that stands on the ground: of the three
 * shadows the leaf's goes. */
static void scraps_of_shadow_are_left_out(void)
{
    const dvec light = dvec_of(-0.7, 0.75, 0.3), leaf = dvec_of(2.37, 1, 1.7), peg = dvec_of(1.55, 0.125, 1.85);
    shape      model = {0};
    shot       as_it_falls, calm;
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    shape_box(&model, "leaf", dvec_of(2.27, 0.99, 1.62), dvec_of(2.47, 1.01, 1.78));
    shape_box(&model, "peg", dvec_of(1.5, 0, 1.8), dvec_of(1.6, 0.25, 1.9));
    shape_box(&model, "other peg", dvec_of(-1.5, 0, 1.8), dvec_of(-1.4, 0.25, 1.9));
    if (shoot_cast(&as_it_falls, &model, "\"ground_strength\":1", false) &&
        shoot_cast(&calm, &model, "\"ground_strength\":1,\"ground_smoothing\":\"5px\"", false)) {
        int          lost = 0, seen = 0, pegs = dark_below(&as_it_falls, peg, light, 0.4);
        signed char *truth = cast_truth(&calm, light);
        check_at_least("ground", dark_below(&as_it_falls, leaf, light, 0.4), 30, "pixels of a leaf's shadow");
        check_at_most("ground", dark_below(&calm, leaf, light, 0.4), 0, "  where scraps are left out");
        check_at_least("ground", pegs, 20, "pixels of the shadow of a peg that stands there");
        check_at_least("ground", dark_below(&calm, peg, light, 0.4), 0.6 * pegs, "  where scraps are left out");
        for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
            seen += truth[i] == 1 && !is_near_border(truth, i, 2);
            lost += truth[i] == 1 && !is_near_border(truth, i, 2) && calm.picture[4 * i] > 127;
        }
        check_at_least("ground", seen, 2000, "pixels well within the block's shadow");
        check_at_most("ground", lost, 0, "  that are lost");
        free(truth);
        shot_release(&as_it_falls);
        shot_release(&calm);
    }
    shape_release(&model);
}

/* A smoothed border keeps the corners of what has straight edges. */
static void calm_shadows_keep_corners(void)
{
    const dvec light = dvec_of(-0.7, 0.75, 0.3);
    shape      model = {0};
    shot       calm;
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    if (shoot_cast(&calm, &model, "\"ground_strength\":1,\"ground_smoothing\":\"24px\"", false)) {
        int          known = 0, wrong = 0;
        signed char *truth = cast_truth(&calm, light);
        for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
            known += truth[i] != UNKNOWN;
            wrong +=
                truth[i] != UNKNOWN && (calm.picture[4 * i] < 128) != (truth[i] == 1) && !is_near_border(truth, i, 1);
        }
        check_at_least("ground", known, 3000, "pixels of ground");
        check_at_most("ground", wrong, 2, "that are drawn otherwise, smoothed over 24 pixels");
        free(truth);
        shot_release(&calm);
    }
    shape_release(&model);
}

/* How dark the ground is on the mean where the shadow of the block's side falls that lies between two heights. */
static double mean_dark(const shot *s, const signed char *truth, dvec light, double low, double high)
{
    double sum = 0;
    int    count = 0;
    dvec   towards = in_scene(s, light);
    for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
        dvec origin, way;
        if (truth[i] != 1 || is_near_border(truth, i, 4))
            continue;
        shot_ray(s, i % CAST_SIDE + 0.5, i / CAST_SIDE + 0.5, &origin, &way);
        dvec   at = dvec_add(origin, dvec_scale(way, -origin.y / way.y));
        double in[2] = {INFINITY, INFINITY};
        for (int k = 0; k < 2; k++) { /* the block is entered where the later of its two sides is */
            double from = k ? at.z : at.x, by = (k ? towards.z : towards.x) / towards.y;
            double side = by > 0 ? cast_low[2 * k] : cast_high[2 * k];
            in[k] = (side - from) / by;
        }
        double height = fmax(in[0], in[1]);
        if (height >= low && height < high) {
            sum += 255 - s->picture[4 * i];
            count++;
        }
    }
    return count ? sum / count / 255 : NAN;
}

/* Of watercolour they are washes: as dark as any other inside, with a rim where they end, as wide as it is told to be.
 */
static void cast_shadows_are_washed(void)
{
    const dvec light = dvec_of(-0.7, 0.75, 0.3);
    shape      model = {0};
    double     inside[2] = {0}, border[2] = {0};
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    for (int pools = 0; pools < 2; pools++) {
        shot s;
        int  counts[2] = {0};
        if (!shoot_cast_with(&s, &model, "\"ground_strength\":0.5",
                             pools ? "{\"technique\":\"watercolour\",\"flow\":0,\"pool\":\"6px\",\"pooling\":1}"
                                   : "{\"technique\":\"watercolour\",\"flow\":0,\"pool\":\"6px\",\"pooling\":0}",
                             false))
            continue;
        signed char *truth = cast_truth(&s, light);
        for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
            if (truth[i] != 1 || is_near_border(truth, i, 1))
                continue;
            bool near = is_near_border(truth, i, 3);
            if (!near && is_near_border(truth, i, 9))
                continue;
            *(near ? &border[pools] : &inside[pools]) += 1 - s.picture[4 * i] / 255.0;
            counts[near]++;
        }
        inside[pools] /= fmax(counts[0], 1);
        border[pools] /= fmax(counts[1], 1);
        check_at_least("ground", counts[0], 1000, "pixels inside the shadow");
        free(truth);
        shot_release(&s);
    }
    check_near("ground", inside[0], 0.5, 0.01, "darkness of a wash without pools");
    check_near("ground", border[0], 0.5, 0.01, "  beside its border");
    check_near("ground", inside[1], 0.5, 0.01, "with pools, inside");
    check_at_least("ground", border[1], 0.55, "  beside the border");
    shape_release(&model);
}

/* Soft ones are drawn by the strokes and dots of mediums that draw on the ground, where rays say and as dark. */
static void soft_shadows_are_drawn(void)
{
    static const char *const media[] = {"{\"technique\":\"pencil\",\"ink\":\"#000000\"}",
                                        "{\"technique\":\"stick\",\"ink\":\"#000000\"}",
                                        "{\"technique\":\"stipple\",\"ink\":\"#000000\"}",
                                        "{\"technique\":\"dots\",\"coordinates\":\"screen\",\"ink\":\"#000000\"}"};
    const dvec               light = dvec_of(-0.7, 0.75, 0.3);
    shape                    model = {0};
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    for (size_t m = 0; m < sizeof media / sizeof *media; m++) {
        shot   s;
        double inside = 0, outside = 0, squares = 0;
        int    counts[2] = {0};
        if (!shoot_cast_with(&s, &model, "\"ground_strength\":0.5,\"shadows\":true,\"shadow_softness\":3", media[m],
                             false))
            continue;
        signed char *truth = cast_truth(&s, light);
        for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
            if (truth[i] == UNKNOWN || is_near_border(truth, i, 8))
                continue;
            double dark = 1 - picture_shown(s.picture[4 * i]);
            *(truth[i] ? &inside : &outside) += dark;
            squares += truth[i] ? dark * dark : 0;
            counts[truth[i] ? 1 : 0]++;
        }
        check_at_least("ground", counts[1], 700, "pixels inside the shadow that %s draws", media[m]);
        double mean = inside / fmax(counts[1], 1);
        check_near("ground", mean, 0.45, 0.12, "  how dark it is");
        check_at_most("ground", outside / fmax(counts[0], 1), 0.002, "  and outside of it");
        check_at_least("ground", sqrt(fmax(squares / fmax(counts[1], 1) - mean * mean, 0)), 0.05,
                       "  deviation within it: marks, no tone");
        free(truth);
        shot_release(&s);
    }
    shape_release(&model);
}

/* What is thrown from higher up is paler; what stands there throws all of it. */
static void cast_shadows_fade(void)
{
    const dvec light = dvec_of(-0.7, 0.75, 0.3);
    shape      model = {0};
    shot       even, fading, two;
    shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
              dvec_of(cast_high[0], cast_high[1], cast_high[2]));
    if (shoot_cast(&even, &model, "\"ground_strength\":1", false) &&
        shoot_cast(&fading, &model, "\"ground_strength\":1,\"ground_fade\":0.8,\"ground_reach\":0.2", false) &&
        shoot_cast(&two, &model, "\"ground_strength\":1,\"ground_fade\":0.8,\"ground_reach\":0.2,\"ground_flat\":true",
                   false)) {
        signed char *truth = cast_truth(&even, light);
        double       top = cast_high[1], low = mean_dark(&fading, truth, light, 0, 0.1 * top),
               middle = mean_dark(&fading, truth, light, 0.3 * top, 0.5 * top),
               high = mean_dark(&fading, truth, light, 0.7 * top, top);
        check_at_least("ground", mean_dark(&even, truth, light, 0.7 * top, top), 0.95, "dark where it does not fade");
        check_at_least("ground", low, 0.7, "dark at the foot");
        check_at_most("ground", middle, 0.85 * low, "  farther off");
        check_at_most("ground", high, 0.85 * middle, "  and farther");
        int greys = 0, all = 0;
        for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++) {
            int most = 0;
            for (int k = 0; k < 2; k++)
                most |= abs(two.picture[4 * i] -
                            two.picture[4 * (i + (k ? CAST_SIDE : 1)) % (4 * CAST_SIDE * CAST_SIDE)]) > 3;
            bool inner = truth[i] == 1 && !is_near_border(truth, i, 3);
            all += inner;
            greys += inner && most;
        }
        check_at_most("ground", (double)greys / fmax(all, 1), 0.06, "of two tones what lies between them");
        free(truth);
        shot_release(&even);
        shot_release(&fading);
        shot_release(&two);
    }
    shape_release(&model);
}

/* Of two tones the darker one is what stands there has at its foot: a plate that hangs low over the ground throws the
 * paler one, and with a leg the darker one. */
static void dark_tone_lies_at_feet(void)
{
    const dvec light = dvec_of(-0.7, 0.75, 0.3), plate = dvec_of(2.3, 0.3, 1.7);
    for (int stands = 0; stands < 2; stands++) {
        shape model = {0};
        shot  two;
        shape_box(&model, "block", dvec_of(cast_low[0], cast_low[1], cast_low[2]),
                  dvec_of(cast_high[0], cast_high[1], cast_high[2]));
        shape_box(&model, "plate", dvec_of(2, 0.28, 1.4), dvec_of(2.6, 0.32, 2));
        if (stands)
            shape_box(&model, "leg", dvec_of(2.1, 0, 1.5), dvec_of(2.5, 0.28, 1.9));
        shape_box(&model, "peg", dvec_of(-1.5, 0, 1.8), dvec_of(-1.4, 0.25, 1.9));
        shape_box(&model, "other peg", dvec_of(-1.5, 0, -1.8), dvec_of(-1.4, 0.25, -1.7));
        if (shoot_cast(&two, &model,
                       "\"ground_strength\":1,\"ground_fade\":0.8,\"ground_reach\":0.2,\"ground_flat\":true", false)) {
            int dark = dark_below(&two, plate, light, 0.5);
            if (stands)
                check_at_least("ground", dark, 30, "pixels of the darker tone below a plate that stands on a leg");
            else
                check_at_most("ground", dark, 0, "pixels of the darker tone below a plate that hangs");
            shot_release(&two);
        }
        shape_release(&model);
    }
}

/* Things that stand at different heights would throw their shadows far below themselves. */
static void cast_shadows_need_a_level(void)
{
    for (int lifted = 0; lifted < 3; lifted++) { /* 2: those that stand higher stand on a shelf */
        shape model = {0};
        shot  got;
        if (lifted == 2) {
            shape_box(&model, "shelf", dvec_of(0.3, 1.4, -0.3), dvec_of(2.4, 1.5, 0.3));
            shape_box(&model, "leg", dvec_of(0.3, 0, -0.3), dvec_of(0.4, 1.4, 0.3));
        }
        for (int i = 0; i < 4; i++) {
            double low = lifted && i > 1 ? 1.5 : 0;
            char   name[16];
            snprintf(name, sizeof name, "block%d", i);
            shape_box(&model, name, dvec_of(1.2 * i - 2, low, -0.3), dvec_of(1.2 * i - 1.6, low + 1, 0.3));
        }
        if (shoot_cast(&got, &model, "\"ground_strength\":1", false)) {
            int dark = 0;
            for (int i = 0; i < CAST_SIDE * CAST_SIDE; i++)
                dark += !got.id[i] && got.picture[4 * i] < 128;
            if (lifted == 1)
                check_at_most("ground", dark, 0, "pixels of shadow where half of all stands higher");
            else
                check_at_least("ground", dark, 500, "pixels of shadow where all stands on one level");
            shot_release(&got);
        }
        shape_release(&model);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"law", the_law_holds},
        {"floating", floating_has_none},
        {"nothing", nothing_else_changes},
        {"flat", flat_has_one_tone},
        {"media", media_draw_it},
        {"cast", cast_shadows_are_where_rays_say},
        {"hatched", cast_shadows_are_hatched},
        {"level", cast_shadows_need_a_level},
        {"scraps", scraps_of_shadow_are_left_out},
        {"corners", calm_shadows_keep_corners},
        {"fade", cast_shadows_fade},
        {"washed", cast_shadows_are_washed},
        {"soft", soft_shadows_are_drawn},
        {"feet", dark_tone_lies_at_feet},
    };
    int status = check_main(argc, argv, "ground", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
