/* Lines of solids, which are the sides of no triangle: against the places where rays find another surface, a step,
 * an angle. And what compositions make of a solid's layers, against colours blended on the CPU. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "csg_map.h"
#include "csg_scenes.h"
#include "paint.h"

static const double pi = 3.14159265358979323846;

static const shot_view views[] = {
    {.width = 260, .height = 220, .eye = {4, 3, 5}, .up = {0, 0, 1}},
    {.width = 240, .height = 250, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 250, .height = 230, .eye = {1, -3.5, 3.5}, .up = {0.2, 1, 0}, .fov_deg = 45},
};

#define LOOK(RULE)                                                                                                     \
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ece4d2\"},\"rules\":[{\"select\":\"*\"," RULE "}]}"
#define OWN_COLOUR "\"surface\":{\"technique\":\"flat\",\"model_colour\":1}"
#define ALL_LAYERS ",\"layers\":{\"technique\":\"peel\",\"count\":0}"
#define LINES      ",\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#102080c0\"}"

static const uint8_t ground[3] = {0xec, 0xe4, 0xd2}, blue[3] = {0x10, 0x20, 0x80};

static bool draw(shot *out, const csg *c, const char *look, const char *const *changes, const shot_view *view)
{
    char path[512];
    snprintf(path, sizeof path, "%s", check_path("lines.csg"));
    return csg_write(c, path) && shot_take(out, path, look, changes, view);
}

/* --- where lines belong --------------------------------------------------------------------------------- */

/* What lies between two neighbouring pixels of one layer. */
typedef enum between {
    SMOOTH,
    MAYBE,   /* an angle or a step that may be a line or not */
    JOINT,   /* two leaves go on in each other without an angle */
    OUTLINE, /* something ends */
    CREASE,  /* a leaf's own edge */
    RIM,     /* two leaves meet at an angle: in no mesh */
    KINDS
} between;

static const char *const kind_names[KINDS] = {"smooth", "maybe", "joint", "outline", "crease", "rim"};

/* Angles in degrees up to which there is no line and from which there is one, of one leaf and between two. */
static const double own_angle[2] = {36, 46}, meet_angle[2] = {3, 12};

typedef struct field {
    const csg_map *map;
    const shot    *view;
    size_t         layer;
} field;

static const csg_hit *hit_at(const field *f, int x, int y)
{
    int i = y * f->map->width + x;
    return csg_count(f->map, i) > f->layer ? &csg_at(f->map, i)[f->layer] : NULL;
}

/* Depth that the facet seen at one pixel would have at another. */
static double facet_depth(const field *f, const csg_hit *h, int x, int y, int other_x, int other_y)
{
    dvec origin, direction;
    shot_ray(f->view, x + 0.5, y + 0.5, &origin, &direction);
    dvec position = dvec_add(origin, dvec_scale(direction, h->t));
    shot_ray(f->view, other_x + 0.5, other_y + 0.5, &origin, &direction);
    double t = dvec_dot(h->flat, dvec_sub(position, origin)) / dvec_dot(h->flat, direction);
    return -shot_to_eye(f->view, dvec_add(origin, dvec_scale(direction, t)), 1).z;
}

/* The step that remains between two facets that do not meet between the pixels, as a fraction of the depth. */
static double step_between(const field *f, const csg_hit *a, const csg_hit *b, int x, int y, int other_x, int other_y)
{
    double at_a = a->depth - facet_depth(f, b, other_x, other_y, x, y),
           at_b = facet_depth(f, a, x, y, other_x, other_y) - b->depth;
    if (!isfinite(at_a) || !isfinite(at_b))
        return 0.01;
    return at_a * at_b <= 0 ? 0 : fmin(fabs(at_a), fabs(at_b)) / a->depth;
}

static between kind_between(const field *f, int x, int y, int other_x, int other_y)
{
    const csg_hit *a = hit_at(f, x, y), *b = hit_at(f, other_x, other_y);
    if (!a || !b)
        return a || b ? OUTLINE : SMOOTH;
    double step = step_between(f, a, b, x, y, other_x, other_y);
    double angle = acos(fmin(1, fmax(-1, dvec_dot(a->normal, b->normal)))) * 180 / pi;
    if (step > 0.03)
        return OUTLINE;
    if (step > 1e-4 || a->front != b->front)
        return MAYBE;
    const double *limits = a->leaf == b->leaf ? own_angle : meet_angle;
    if (angle > limits[0])
        return angle < limits[1] ? MAYBE : a->leaf == b->leaf ? CREASE : RIM;
    return a->leaf == b->leaf ? SMOOTH : JOINT;
}

/* Of each pixel, to its right and below. */
static uint8_t (*classify(const field *f))[2]
{
    int w = f->map->width, h = f->map->height;
    uint8_t(*kinds)[2] = check_alloc((size_t)(w * h), sizeof *kinds);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            kinds[y * w + x][0] = x + 1 < w ? (uint8_t)kind_between(f, x, y, x + 1, y) : SMOOTH;
            kinds[y * w + x][1] = y + 1 < h ? (uint8_t)kind_between(f, x, y, x, y + 1) : SMOOTH;
        }
    return kinds;
}

/* The distance from a position (pixels) to the nearest border of such kinds; 9 when there is none near. */
static double distance_to(uint8_t (*kinds)[2], int w, int h, double x, double y, unsigned wanted)
{
    double least = 9;
    for (int j = (int)y - 5; j <= (int)y + 5; j++)
        for (int i = (int)x - 5; i <= (int)x + 5; i++)
            for (int d = 0; d < 2 && i >= 0 && j >= 0 && i < w && j < h; d++)
                if (wanted >> kinds[j * w + i][d] & 1)
                    least = fmin(least, hypot(x - (d ? i + 0.5 : i + 1), y - (d ? j + 1 : j + 0.5)));
    return least;
}

static bool is_ink(const shot *s, size_t layer, int x, int y)
{
    const uint8_t *e = s->layer_count > 0 ? s->layers[layer].edge : s->edge;
    int            i = 4 * (y * s->width + x);
    return e[i + 2] <= 127 || e[i + 3] <= 127;
}

static double distance_to_ink(const shot *s, size_t layer, double x, double y)
{
    double least = 9;
    for (int j = (int)y - 3; j <= (int)y + 3; j++)
        for (int i = (int)x - 3; i <= (int)x + 3; i++)
            if (i >= 0 && j >= 0 && i < s->width && j < s->height && is_ink(s, layer, i, j))
                least = fmin(least, hypot(i + 0.5 - x, j + 0.5 - y));
    return least;
}

enum { LINES_MUST = 1 << OUTLINE | 1 << CREASE | 1 << RIM, LINES_MAY = LINES_MUST | 1 << MAYBE };

typedef struct line_score {
    int samples[KINDS], missed[KINDS]; /* borders of a kind, and those without ink within 1.5 px */
    int inked_joints;                  /* joints with ink within 1.5 px that nothing else explains */
    int ink, stray; /* pixels of ink, and those farther than 2.5 px from all that may be a line: half the width, a
                       pixel, and round ends */
    int quiet;      /* pixels that no line is near */
    int x, y, stray_x, stray_y;
} line_score;

static line_score score_lines(const csg_map *m, const shot *s, size_t layer)
{
    line_score c = {.x = -1, .stray_x = -1};
    field      f = {m, s, layer};
    int        w = s->width, h = s->height;
    uint8_t(*kinds)[2] = classify(&f);
    for (int y = 3; y < h - 3; y++)
        for (int x = 3; x < w - 3; x++) {
            for (int d = 0; d < 2; d++) {
                int    kind = kinds[y * w + x][d];
                double at_x = d ? x + 0.5 : x + 1, at_y = d ? y + 1 : y + 0.5;
                if (kind == JOINT ? distance_to(kinds, w, h, at_x, at_y, LINES_MAY) <= 4 : !(LINES_MUST >> kind & 1))
                    continue;
                bool near = distance_to_ink(s, layer, at_x, at_y) <= 1.5;
                c.samples[kind]++;
                c.missed[kind] += !near;
                c.inked_joints += kind == JOINT && near;
                if (kind == JOINT ? near : !near)
                    c.x = x, c.y = y;
            }
            bool quiet = distance_to(kinds, w, h, x + 0.5, y + 0.5, LINES_MAY) > 2.5;
            c.quiet += quiet && hit_at(&f, x, y);
            if (!is_ink(s, layer, x, y))
                continue;
            c.ink++;
            c.stray += quiet;
            if (quiet)
                c.stray_x = x, c.stray_y = y;
        }
    free(kinds);
    return c;
}

static void check_lines(const char *title, csg_rays *r, const csg_map *m, const shot *s, size_t layer)
{
    static const char *const rows[KINDS] = {[OUTLINE] = "C8", [CREASE] = "C9", [RIM] = "K04"};
    line_score               c = score_lines(m, s, layer);
    bool                     right = true;
    for (int kind = OUTLINE; kind < KINDS; kind++)
        if (c.samples[kind] >= 20)
            right = check_at_least(rows[kind], 1 - (double)c.missed[kind] / c.samples[kind], kind == RIM ? 0.98 : 0.99,
                                   "%s, layer %zu: fraction of %d places at a %s with ink within 1.5 px", title, layer,
                                   c.samples[kind], kind_names[kind]) &&
                    right;
    if (!right) {
        check_note("the last at %d, %d", c.x, c.y);
        csg_explain(m, r, s, c.x, c.y);
    }
    if (!check_at_most("C9", c.stray, 0,
                       "  pixels of ink, of %d, farther than 2.5 px from all that may be a line (%d pixels are)", c.ink,
                       c.quiet)) {
        check_note("the last at %d, %d", c.stray_x, c.stray_y);
        csg_explain(m, r, s, c.stray_x, c.stray_y);
    }
    if (c.samples[JOINT] > 0)
        check_at_most("C9", c.inked_joints, 0, "  places where leaves join without an angle that have ink, of %d",
                      c.samples[JOINT]);
}

/* The look that ships for lines, and all layers' lines. */
static void against_rays(const char *title, const csg *c, const shot_view *view, int layers)
{
    shot      s;
    csg_map   m = {0};
    csg_rays *r = csg_rays_create(c, 30);
    for (int all = 0; all < 2; all++) {
        if (!draw(&s, c, all ? LOOK("\"surface\":\"flat\"" LINES ALL_LAYERS ",\"compose\":\"wire\"") : "edges", NULL,
                  view))
            continue;
        if (!m.hits)
            csg_map_quickly(&m, r, &s);
        for (int k = all; k < (all ? layers : 1) && (!all || k < s.layer_count); k++)
            check_lines(title, r, &m, &s, (size_t)k);
        shot_release(&s);
    }
    csg_map_release(&m);
    csg_rays_destroy(r);
}

/* --- scenes --------------------------------------------------------------------------------------------- */

/* A bore through a ball and a box. */
static void bored(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_add(c, 0, CSG_UNION);
    csg_box(c, 1, dvec_of(-1.3, -0.9, -0.8), dvec_of(0.1, 0.9, 0.6));
    csg_move(c, csg_ball(c, 1, 0.95, 32, 64), 0.6, 0, 0);
    csg_place(c, csg_cylinder(c, 0, 0.4, 0.4, 4, 48), dvec_of(1, 1, 1), dvec_of(0.2, 1, 0.1), 75,
              dvec_of(-2, 0.1, -0.5));
    csg_place(c, csg_cylinder(c, 0, 0.25, 0.25, 3, 48), dvec_of(1, 1, 1), dvec_of(1, 0, 0), 20, dvec_of(0.6, 0, -1));
}

/* Boxes and a column in one piece, cylinders that go on in each other. */
static void joined(csg *c)
{
    csg_add(c, -1, CSG_UNION);
    csg_box(c, 0, dvec_of(-1.2, -0.6, -0.5), dvec_of(0, 0.6, 0.5));
    csg_box(c, 0, dvec_of(0, -0.6, -0.5), dvec_of(1.2, 0.6, 0.5));
    csg_box(c, 0, dvec_of(-0.4, -0.6, 0.5), dvec_of(0.4, 0.6, 1.1));
    csg_move(c, csg_cylinder(c, 0, 0.35, 0.35, 0.7, 48), 0, 0, -1.2);
    csg_move(c, csg_cylinder(c, 0, 0.35, 0.35, 0.7, 48), 0, 0, -1.9);
    csg_move(c, csg_cylinder(c, 0, 0.3, 0.3, 1.6, 48), 0.8, 0, -0.8);
    csg_move(c, csg_cylinder(c, 0, 0.3, 0.3, 1.8, 48), 0.8, 0, -0.7);
}

static void drilled(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_box(c, 0, dvec_of(-1.4, -1.2, -0.3), dvec_of(1.4, 1.2, 0.4));
    for (int k = 0; k < 6; k++)
        csg_move(c, csg_cylinder(c, 0, 0.25, 0.25, 2, 48), -0.9 + 0.9 * (k % 3), -0.6 + 1.2 * (k / 3), -1);
}

/* Rims at angles that would be no crease within a leaf. */
static void shallow(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_add(c, 0, CSG_UNION);
    csg_box(c, 1, dvec_of(-1.4, -1, -0.5), dvec_of(1.4, 1, 0.3));
    csg_move(c, csg_cylinder(c, 1, 0.55, 0, 0.2, 64), 0.75, 0.1, 0.3);
    csg_move(c, csg_ball(c, 0, 2, 60, 96), -0.5, -0.1, 2.15);
}

static void lines(void)
{
    static const struct {
        const char *name;
        void (*make)(csg *c);
        int layers;
    } scenes[] = {{"a bore through a ball and a box", bored, 4},
                  {"leaves in one piece", joined, 2},
                  {"a drilled plate", drilled, 2},
                  {"shallow rims", shallow, 2},
                  {"a spanner", csg_spanner, 4}};
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++)
        for (int v = 0; v < 2; v++) {
            csg c = {0};
            scenes[k].make(&c);
            csg_colour(&c);
            against_rays(scenes[k].name, &c, &views[((int)k + v) % 3], scenes[k].layers);
            csg_release(&c);
        }
}

static void random_lines(void)
{
    for (uint32_t seed = 31; seed <= 34; seed++) {
        csg  c = {0};
        char title[64];
        csg_random(&c, seed % 2 ? CSG_CONVEX : CSG_CONCAVE, seed);
        snprintf(title, sizeof title, "%s %u", csg_scene_names[seed % 2 ? CSG_CONVEX : CSG_CONCAVE], seed);
        against_rays(title, &c, &views[seed % 3], 2);
        csg_release(&c);
    }
}

static bool one_leaf_around(const field *f, int x, int y)
{
    for (int j = y - 2; j <= y + 2; j++)
        for (int i = x - 2; i <= x + 2; i++)
            if (!hit_at(f, i, j) || hit_at(f, i, j)->leaf != hit_at(f, x, y)->leaf)
                return false;
    return true;
}

/* Nothing on the wall of a bore and of a column but their ends. */
static void smooth_walls(void)
{
    csg c = {0};
    int wall = 0, ink = 0;
    bored(&c);
    csg_colour(&c);
    csg_rays *r = csg_rays_create(&c, 30);
    for (int v = 0; v < 3; v++) {
        shot    s;
        csg_map m;
        if (!draw(&s, &c, "edges", NULL, &views[v]))
            continue;
        csg_map_quickly(&m, r, &s);
        field f = {&m, &s, 0};
        for (int y = 3; y < s.height - 3; y++)
            for (int x = 3; x < s.width - 3; x++) {
                if (!hit_at(&f, x, y) || hit_at(&f, x, y)->leaf < 2 || !one_leaf_around(&f, x, y))
                    continue;
                wall++;
                ink += is_ink(&s, 0, x, y);
            }
        csg_map_release(&m);
        shot_release(&s);
    }
    check_at_least("C9", wall, 1500, "pixels of a bore's wall of 48 facets");
    check_at_most("C9", ink, 0, "  of them with ink");
    csg_rays_destroy(r);
    csg_release(&c);
}

static bool layer_around(const shot *s, int layer, int x, int y, int reach)
{
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < s->width && j < s->height && !isinf(s->layers[layer].depth[j * s->width + i]))
                return true;
    return false;
}

/* Lines of a layer lie around its own borders, half of them beside it: their darker pixels are no farther from it than
 * they are wide. */
static void lines_on_layers(void)
{
    static const char *const widths[] = {"1px", "2px"};
    for (int k = 0; k < 4; k++) {
        csg  c = {0};
        shot s;
        int  ink = 0, away = 0;
        if (k < 2)
            csg_spanner(&c);
        else
            csg_random(&c, k == 2 ? CSG_CONCAVE : CSG_MANY, 5);
        if (draw(&s, &c, LOOK("\"surface\":\"flat\"" LINES ALL_LAYERS ",\"compose\":\"wire\""),
                 (const char *[]){"lines.width", widths[k % 2], NULL}, &views[k % 3]))
            for (int layer = 1; layer < s.layer_count; layer++)
                for (int i = 0; i < s.width * s.height; i++) {
                    bool inked = ink_of(&s.layers[layer].edge[4 * i]) > 0.25;
                    ink += inked;
                    away += inked && !layer_around(&s, layer, i % s.width, i / s.width, 1 + k % 2);
                }
        check_at_least("C12", ink, 1000, "lines %s wide: pixels with ink of hidden layers", widths[k % 2]);
        check_at_most("C12", away, 0, "  farther than they are wide from their layer's surface");
        shot_release(&s);
        csg_release(&c);
    }
}

/* --- compositions --------------------------------------------------------------------------------------- */

typedef struct tally {
    int pixels, wrong, worst, x, y;
} tally;

static void judge(tally *t, const shot *s, int i, paint wanted)
{
    int off = levels_off(&s->picture[4 * i], wanted);
    t->pixels++;
    t->wrong += off > 2;
    if (off > t->worst) {
        t->worst = off;
        t->x = i % s->width;
        t->y = i / s->width;
    }
}

static paint shade_at(const shot *s, int layer, int i, double opacity)
{
    return paint_of(&s->layers[layer].shade[4 * i], opacity);
}

/* Fill and ink of the layers as they are exported, nearest last. Ink is all or nothing, so that 8 bits hold it. */
static void compose(const char *row, const char *what, const char *style, double opacity, bool with_ink,
                    const uint8_t *tint)
{
    static const char ink_lines[] =
        ",\"lines\":{\"operator\":\"discontinuity\",\"gain\":1000,\"colour\":\"#102080c0\"}";
    for (int v = 0; v < 3; v++) {
        char  look[768];
        csg   c = {0};
        shot  s;
        tally bare = {0}, inked = {0};
        if (v == 0)
            csg_spanner(&c);
        else
            csg_random(&c, v == 1 ? CSG_CONCAVE : CSG_COINCIDENT, 8);
        csg_colour(&c);
        snprintf(look, sizeof look, LOOK(OWN_COLOUR ALL_LAYERS "%s,\"compose\":{%s}"), with_ink ? ink_lines : "",
                 style);
        if (draw(&s, &c, look, NULL, &views[v]))
            for (int i = 0; i < s.width * s.height; i++) {
                paint  wanted = paint_of(ground, 1);
                double most = 0;
                for (int k = s.layer_count; k-- > 0;) {
                    const uint8_t *e = &s.layers[k].edge[4 * i];
                    double         a = 0xc0 / 255.0, ink = with_ink ? 1 - (1 - a * (1 - e[0] / 255.0)) *
                                                                      (1 - a * (1 - e[1] / 255.0)) *
                                                                      (1 - a * (1 - e[3] / 255.0))
                                                                    : 0;
                    if (!isinf(s.layers[k].depth[i]))
                        put_over(&wanted, tint ? paint_of(tint, opacity) : shade_at(&s, k, i, opacity));
                    put_over(&wanted, paint_of(blue, ink));
                    most = fmax(most, ink);
                }
                judge(most > 0 ? &inked : &bare, &s, i, wanted);
            }
        check_at_least(row, bare.pixels, 20000, "%s: pixels without ink", what);
        if (!check_at_most(row, bare.wrong, 0, "  farther than 2 levels from their layers' blend (worst %d)",
                           bare.worst))
            check_note("at %d, %d", bare.x, bare.y);
        if (with_ink) {
            check_at_least(row, inked.pixels, 1500, "  and with ink");
            if (!check_at_most(row, inked.wrong, 0, "  farther than 2 levels from their layers' blend (worst %d)",
                               inked.worst))
                check_note("at %d, %d", inked.x, inked.y);
        }
        shot_release(&s);
        csg_release(&c);
    }
}

static void compositions(void)
{
    static const uint8_t tint[3] = {0x20, 0x50, 0xc0};
    compose("K05", "transparent layers", "\"technique\":\"xray\",\"opacity\":0.35", 0.35, false, NULL);
    compose("K07", "transparent layers with lines", "\"technique\":\"xray\",\"opacity\":0.3,\"once\":false", 0.3, true,
            NULL);
    compose("K06", "blueprint", "\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.2,\"once\":false",
            0.2, true, tint);
}

/* Ink above the threshold is a line, and everything else the ground. */
static void wire(void)
{
    csg  c = {0};
    shot s;
    int  ink = 0, bare = 0, wrong_ink = 0, wrong_ground = 0;
    csg_spanner(&c);
    csg_colour(&c);
    if (draw(&s, &c,
             LOOK(OWN_COLOUR ALL_LAYERS
                  ",\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#102080\"},"
                  "\"compose\":{\"technique\":\"wire\",\"once\":false,\"softness\":0,\"threshold\":0.5}"),
             NULL, &views[0]))
        for (int i = 0; i < s.width * s.height; i++) {
            const uint8_t *p = &s.picture[4 * i];
            double         most = largest_ink(&s, i);
            if (most < 0.49) {
                bare++;
                wrong_ground += memcmp(p, ground, 3) != 0;
            } else if (most > 0.51) {
                ink++;
                wrong_ink += abs(p[0] - blue[0]) > 2 || abs(p[1] - blue[1]) > 2 || abs(p[2] - blue[2]) > 2;
            }
        }
    check_at_least("C19", ink, 1500, "wire: pixels with a layer's ink");
    check_at_most("C19", wrong_ink, 0, "  that are not in the line's colour");
    check_at_least("C19", bare, 20000, "  and without");
    check_at_most("C19", wrong_ground, 0, "  that are not the ground");
    shot_release(&s);
    csg_release(&c);
}

/* Bores of a plate that lies before the eye edge on: no layer but hidden ones shows their walls. */
static void bores_seen_through(void)
{
    static const shot_view   side = {.width = 260,
                                     .height = 160,
                                     .eye = {0.1, -7, 0.05},
                                     .target = {0.1, 0, 0.05},
                                     .up = {0, 0, 1},
                                     .orthographic = true};
    static const char *const looks[] = {"blueprint", "technical", "xray"};
    static const char *const undashed[] = {"lines.hidden", "solid", NULL};
    for (int l = 0; l < 3; l++) {
        bool one = strcmp(looks[l], "technical") == 0; /* no layers: its hidden lines are strokes of the picture */
        csg  c = {0};
        shot s, plain;
        int  samples = 0, seen = 0, seen_plain = 0;
        drilled(&c);
        csg_colour(&c);
        if (draw(&s, &c, looks[l], one ? undashed : NULL, &side) && draw(&plain, &c, "edges", NULL, &side)) {
            for (int bore = 0; bore < 3; bore++)
                for (int wall = -1; wall <= 1; wall += 2)
                    for (int k = 0; k < 40; k++) {
                        dvec p = shot_project(&s, dvec_of(-0.9 + 0.9 * bore + 0.25 * wall, -0.6, -0.25 + 0.6 * k / 39));
                        bool ink = false, front = false;
                        for (int x = (int)p.x - 1; x <= (int)p.x + 1; x++) {
                            front = front || is_ink(&plain, 0, x, (int)p.y);
                            for (int layer = 0; layer < s.layer_count; layer++)
                                ink = ink || is_ink(&s, (size_t)layer, x, (int)p.y);
                            ink = ink || (one && s.picture[4 * ((int)p.y * s.width + x)] < 220);
                        }
                        samples++;
                        seen += ink;
                        seen_plain += front;
                    }
            shot_release(&plain);
        }
        check_at_least("K06", samples ? (double)seen / samples : 0, 0.98,
                       "%s: fraction of the outlines of hidden bores with a line", looks[l]);
        check_at_most("K06", seen_plain, 0, "  and of the visible surface alone");
        shot_release(&s);
        csg_release(&c);
    }
}

static double mean_difference(const shot *a, const shot *b)
{
    double sum = 0;
    for (int i = 0; i < 4 * a->width * a->height; i++)
        sum += abs(a->picture[i] - b->picture[i]);
    return sum / (3.0 * a->width * a->height);
}

/* Each further layer changes the picture less. */
static void fewer_layers(void)
{
    static const char *const looks[] = {"blueprint", "xray"};
    for (int l = 0; l < 2; l++)
        for (int v = 0; v < 3; v++) {
            static const char *const counts[] = {"2", "3", "4"};
            csg                      c = {0};
            shot                     s[3] = {{0}};
            bool                     drawn = true;
            csg_spanner(&c);
            csg_colour(&c);
            for (int k = 0; k < 3; k++)
                drawn =
                    draw(&s[k], &c, looks[l], (const char *[]){"layers.count", counts[k], NULL}, &views[v]) && drawn;
            if (drawn)
                check_at_most("K08", mean_difference(&s[1], &s[2]), 0.999 * mean_difference(&s[0], &s[1]),
                              "%s of a spanner: mean difference of 3 and 4 layers, below that of 2 and 3", looks[l]);
            for (int k = 0; k < 3; k++)
                shot_release(&s[k]);
            csg_release(&c);
        }
}

/* Row C19: a union is the same in whichever order its operands stand, layer by layer. */
static void order_of_operands(void)
{
    static const char *const operands[] = {
        "color([1,0,0,1]){cube(size=[2,2,2],center=true);}", "color([0,1,0,1]){sphere($fn=24,$fa=12,$fs=2,r=1.3);}",
        "color([0,0,1,1]){cylinder($fn=24,$fa=12,$fs=2,h=4,r1=0.7,r2=0.4,center=true);}"};
    static const int  orders[][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};
    static const char look[] =
        LOOK(OWN_COLOUR LINES ALL_LAYERS ",\"compose\":{\"technique\":\"xray\",\"opacity\":0.4}");
    for (int v = 0; v < 3; v++) {
        shot drawn[3];
        bool ok = true;
        int  taken = 0;
        for (; taken < 3 && ok; taken++) {
            char  path[512];
            FILE *file;
            snprintf(path, sizeof path, "%s", check_path("order%d.csg", taken));
            file = fopen(path, "wb");
            ok = file && fprintf(file, "union(){%s%s%s}\n", operands[orders[taken][0]], operands[orders[taken][1]],
                                 operands[orders[taken][2]]) > 0;
            ok = file && fclose(file) == 0 && ok && shot_take(&drawn[taken], path, look, NULL, &views[v]);
        }
        for (int k = 1; k < 3 && ok; k++) {
            check_near("C19", drawn[k].layers_drawn, drawn[0].layers_drawn, 0, "layers of a union in another order");
            check_at_most("C19", shot_differing(&drawn[0], &drawn[k], 0), 0, "  values that differ");
        }
        for (int k = 0; k < taken; k++)
            shot_release(&drawn[k]);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"lines", lines},
        {"random", random_lines},
        {"walls", smooth_walls},
        {"layers", lines_on_layers},
        {"compositions", compositions},
        {"wire", wire},
        {"bores", bores_seen_through},
        {"counts", fewer_layers},
        {"order", order_of_operands},
    };
    int status = check_main(argc, argv, "solid_lines", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
