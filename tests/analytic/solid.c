/* Drawings of solids against their surfaces by rays: silhouette, depth, every layer, whose surface it is, its
 * normal. */
#include <limner/limner.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "csg_map.h"
#include "csg_scenes.h"

static const shot_view views[] = {
    {.width = 128, .height = 112, .eye = {4, 3, 5}, .up = {0, 0, 1}},
    {.width = 112, .height = 120, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 121, .height = 107, .eye = {1, -2.5, 3.5}, .target = {0.2, 0.1, 0}, .up = {0.2, 1, 0}, .fov_deg = 55},
};

#define FLAT "\"surface\":{\"technique\":\"flat\",\"model_colour\":1}"
#define LOOK(RULE)                                                                                                     \
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\"," RULE "}]}"

static const char look_front[] = LOOK(FLAT);
static const char look_all[] =
    LOOK(FLAT ",\"layers\":{\"technique\":\"peel\",\"count\":0},\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}");

/* Ways to find the layers; the first is the engine's own choice. */
typedef struct mode {
    const char *name, *key, *value;
    bool        layers, front; /* what it is for */
} mode;

static const mode modes[] = {
    {"auto", NULL, NULL, true, true},
    {"peeling", "layers.producer", "peeling", true, false},
    {"lists", "layers.evaluation", "lists", true, true},
    {"products", "layers.evaluation", "products", true, true},
};

enum { DIRECTIONS = sizeof modes / sizeof *modes };

/* Not every build has a choice. */
static bool is_there(const mode *w, bool front)
{
    lmn_look *look = NULL;
    lmn_error error = {0};
    bool      there = (front ? w->front : w->layers) &&
                 (!w->key || (lmn_look_parse(&look, front ? look_front : look_all, "look", &error) == LMN_OK &&
                              lmn_look_set(look, w->key, w->value, &error) == LMN_OK));
    lmn_look_destroy(&look);
    return there;
}

static bool draw(shot *out, const csg *c, bool front, const mode *w, const shot_view *view)
{
    const char *changes[] = {w->key, w->value, NULL};
    char        path[512];
    snprintf(path, sizeof path, "%s", check_path("solid.csg"));
    return is_there(w, front) && csg_write(c, path) &&
           shot_take(out, path, front ? look_front : look_all, changes, view);
}

/* --- one drawing ---------------------------------------------------------------------------------------- */

/* Layers of the drawing alone: from outside they face the viewer and away in turn, and their number is even. */
static void check_facing(const char *title, const csg_map *m, const shot *s)
{
    int turned = 0, odd = 0;
    for (int i = 0; i < s->width * s->height; i++) {
        int  count = 0;
        dvec origin, direction;
        if (!m->sharp[i])
            continue;
        shot_ray(s, i % s->width + 0.5, i / s->width + 0.5, &origin, &direction);
        direction = dvec_unit(shot_to_eye(s, direction, 0));
        for (; count < s->layer_count && !isinf(s->layers[count].depth[i]); count++) {
            double towards = -dvec_dot(direction, dvec_from(s->layers[count].normal[i]));
            turned += fabs(towards) > 0.2 && (towards > 0) != (count % 2 == 0);
        }
        odd += count % 2;
    }
    check_at_most("C5", odd, 0, "%s: sure pixels with an odd number of layers", title);
    check_at_most("C5", turned, 0, "  layers that do not face to the viewer and away in turn");
}

static void check_score(const char *title, const csg_map *m, csg_rays *r, const shot *s, size_t layers)
{
    csg_score c = csg_compare(m, r, s, layers, true);
    char      wrong[160] = "";
    for (int k = 1, at = 0; k < CSG_VERDICTS; k++)
        if (c.wrong[k])
            at += snprintf(wrong + at, sizeof wrong - (size_t)at, " %zu %s", c.wrong[k], csg_verdict_names[k]);
    check_at_most("K02", (double)c.outline_wrong, 0,
                  "%s: pixels farther than a pixel from the outline that are full or empty and should not be", title);
    check_at_least(layers == 1 ? "K02" : "K03", (double)c.right_inner / (double)(c.inner ? c.inner : 1), 0.999,
                   "  fraction of %zu pixels farther than a pixel from borders that are right", c.inner);
    if (!check_at_most(layers == 1 ? "C1" : "C5", (double)(c.sharp - c.right_sharp), 0,
                       "  wrong pixels, of %zu whose answer is sure%s%s", c.sharp, *wrong ? ":" : "", wrong)) {
        check_note("errors so far: depth %.3g, normal %.3g degrees", c.depth_error, c.normal_error);
        for (int k = 1; k < CSG_VERDICTS; k++)
            if (c.wrong[k])
                csg_explain(m, r, s, c.first[k][0], c.first[k][1]);
    }
    check_at_least("self", (double)c.sharp / (double)c.pixels, 0.85, "  fraction of pixels whose answer is sure");
}

/* Draws in each way, all layers and the front alone; OpenGL ES has no lists for layers. */
static void against_rays(const char *name, const csg *c, const shot_view *view, bool outside)
{
    csg_rays *r = csg_rays_create(c, 30);
    csg_map   map = {0};
    for (int e = 0; e < DIRECTIONS; e++)
        for (int front = view->es; front < 2; front++) {
            char title[128];
            shot s;
            snprintf(title, sizeof title, "%s, %s, %s%s", name, front ? "front" : "all layers", modes[e].name,
                     view->orthographic ? ", parallel" : "");
            if (!draw(&s, c, front, &modes[e], view))
                continue;
            if (!map.hits)
                csg_map_make(&map, r, &s);
            if (front || s.layer_count > 0)
                check_score(title, &map, r, &s, front ? 1 : 0);
            if (!front) {
                check_that("K03", s.layers_drawn >= (int)map.most_sharp && s.layers_drawn <= (int)map.most,
                           "  %d layers; rays find %zu surfaces at most (%zu where it is sure)", s.layers_drawn,
                           map.most, map.most_sharp);
                if (outside)
                    check_facing(title, &map, &s);
            }
            shot_release(&s);
        }
    csg_map_release(&map);
    csg_rays_destroy(r);
}

/* --- trees from seeds ----------------------------------------------------------------------------------- */

static void random_of(csg_scene kind, uint32_t seeds)
{
    for (uint32_t seed = 1; seed <= seeds; seed++) {
        csg  c = {0};
        char title[64];
        csg_random(&c, kind, seed);
        snprintf(title, sizeof title, "%s %u, %d leaves", csg_scene_names[kind], seed, csg_leaf_count(&c));
        against_rays(title, &c, &views[((uint32_t)kind + seed) % 3], true);
        csg_release(&c);
    }
}

static void convex(void)
{
    random_of(CSG_CONVEX, 4);
}

static void concave(void)
{
    random_of(CSG_CONCAVE, 4);
}

static void deep(void)
{
    random_of(CSG_DEEP, 4);
}

static void many(void)
{
    random_of(CSG_MANY, 3);
}

static void coincident(void)
{
    random_of(CSG_COINCIDENT, 6);
}

/* The eye in the solid, and in a leaf that is not of the solid there. */
static void from_inside(void)
{
    static const csg_scene kinds[] = {CSG_CONVEX, CSG_CONCAVE, CSG_DEEP};
    for (uint32_t k = 0, seed = 20; k < 6; seed++) {
        csg  c = {0};
        dvec eye;
        char title[64];
        bool in_solid = k % 2;
        csg_random(&c, kinds[k / 2], seed);
        csg_rays *r = csg_rays_create(&c, 30);
        if (csg_find_position(r, in_solid, seed, &eye)) {
            shot_view view = {.width = 120,
                              .height = 100,
                              .eye = eye,
                              .target = dvec_add(eye, dvec_of(0.3, -0.5, 0.1)),
                              .up = {0.1, 0.2, 1},
                              .fov_deg = 80};
            snprintf(title, sizeof title, "from inside %s, %s %u", in_solid ? "the solid" : "what is cut off",
                     csg_scene_names[kinds[k / 2]], seed);
            against_rays(title, &c, &view, false);
            k++;
        }
        csg_rays_destroy(r);
        csg_release(&c);
    }
}

/* What is convex is found without lists. */
static void dialect(void)
{
    for (uint32_t seed = 1; seed <= 4; seed++) {
        csg       c = {0};
        char      title[64];
        shot_view view = views[seed % 3];
        view.es = true;
        csg_random(&c, CSG_CONVEX, seed);
        snprintf(title, sizeof title, "ES, convex %u, %d leaves", seed, csg_leaf_count(&c));
        against_rays(title, &c, &view, true);
        csg_release(&c);
    }
}

/* --- scenes by hand ------------------------------------------------------------------------------------- */

static void ball_minus_ball(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_ball(c, 0, 1.2, 20, 40);
    csg_move(c, csg_ball(c, 0, 0.8, 20, 40), 0.7, 0.5, 0.6);
}

static void torus_minus_torus(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_torus(c, 0, 1, 0.4, 40, 20);
    csg_place(c, csg_torus(c, 0, 0.9, 0.3, 40, 20), dvec_of(1, 1, 1), dvec_of(1, 0.3, 0), 70, dvec_of(0.2, 0.3, 0));
}

static void nested(csg *c)
{
    int parent = -1;
    for (int k = 0; k < 6; k++) {
        double half = 1.3 - 0.2 * k;
        parent = csg_add(c, parent, CSG_DIFFERENCE);
        if (k % 2)
            csg_move(c, csg_ball(c, parent, 1.1 * half, 14, 28), 0.05 * k, 0, 0.03 * k);
        else
            csg_box(c, parent, dvec_of(-half, -half, -half), dvec_of(half, half, 1.2 * half));
    }
    csg_cylinder(c, parent, 0.2, 0.3, 2, 24);
}

static void hollow(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_box(c, 0, dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    csg_box(c, 0, dvec_of(-0.8, -0.7, -0.9), dvec_of(0.7, 0.8, 0.75));
}

static void drilled(csg *c)
{
    csg_add(c, -1, CSG_DIFFERENCE);
    csg_box(c, 0, dvec_of(-1.4, -1.2, -0.3), dvec_of(1.4, 1.2, 0.4));
    for (int k = 0; k < 12; k++)
        csg_move(c, csg_cylinder(c, 0, 0.2, k % 3 ? 0.2 : 0.1, 2, 24), -1.05 + 0.7 * (k % 4), -0.8 + 0.8 * (k / 4), -1);
}

static void mirrored(csg *c)
{
    csg_place(c, csg_add(c, -1, CSG_DIFFERENCE), dvec_of(1, -1, 1), dvec_of(1, 1, 0), 25, dvec_of(0, 0, 0));
    csg_place(c, csg_angle(c, 0, 1.6, 0.6, 0.9), dvec_of(-1, 1, 1), dvec_of(0, 0, 1), 30, dvec_of(0.3, -0.4, -0.4));
    csg_place(c, csg_cup(c, 0, 0.5, 0.8, 0.15, 24), dvec_of(1, 0.8, -1), dvec_of(1, 0, 0), 20, dvec_of(0.2, 0, 0.4));
    csg_add(c, 0, CSG_UNION);
    csg_place(c, csg_star(c, 3, 0.7, 0.3, 5, 0.5), dvec_of(-1, -1, -1), dvec_of(0, 1, 0.2), 80, dvec_of(-0.2, 0.3, 0));
}

static void plates(csg *c)
{
    csg_place(c, csg_add(c, -1, CSG_UNION), dvec_of(1, 1, 1), dvec_of(1, 2, 3), 50, dvec_of(0, 0, 0));
    csg_box(c, 0, dvec_of(-1, -1, 0), dvec_of(0, 1, 0.5));
    csg_box(c, 0, dvec_of(0, -1, 0), dvec_of(1, 1, 0.5));
    csg_box(c, 0, dvec_of(-1, -1, 0.5), dvec_of(1, 0, 1));
    csg_add(c, 0, CSG_DIFFERENCE);
    csg_box(c, 4, dvec_of(-1, 0, 0.5), dvec_of(1, 1, 1));
    csg_box(c, 4, dvec_of(-0.5, 0, 0.5), dvec_of(0.5, 1, 1));
    csg_cylinder(c, 0, 0.4, 0.4, 1, 20);
}

static void twice(csg *c, csg_kind kind)
{
    csg_place(c, csg_add(c, -1, kind), dvec_of(1, 1, 1), dvec_of(3, 2, 1), 50, dvec_of(0, 0, 0));
    int united = csg_add(c, 0, CSG_UNION);
    csg_torus(c, united, 1, 0.35, 30, 16);
    csg_box(c, united, dvec_of(-1.2, -0.2, -0.2), dvec_of(1.2, 0.2, 0.2));
    csg_torus(c, 0, 1, 0.35, 30, 16);
}

static void twice_united(csg *c)
{
    twice(c, CSG_UNION);
}

static void twice_common(csg *c)
{
    twice(c, CSG_INTERSECTION);
}

static void twice_removed(csg *c)
{
    twice(c, CSG_DIFFERENCE);
}

static void by_hand(void)
{
    static const struct {
        const char *name;
        void (*make)(csg *c);
    } scenes[] = {
        {"ball minus ball", ball_minus_ball},
        {"torus minus torus", torus_minus_torus},
        {"differences in differences", nested},
        {"hollow box", hollow},
        {"drilled plate", drilled},
        {"mirrored leaves", mirrored},
        {"flush plates", plates},
        {"a leaf twice, united", twice_united},
        {"a leaf twice, in common", twice_common},
        {"a leaf twice, taken away", twice_removed},
    };
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        csg c = {0};
        scenes[k].make(&c);
        csg_colour(&c);
        against_rays(scenes[k].name, &c, &views[k % 3], true);
        csg_release(&c);
    }
}

/* --- extremes ------------------------------------------------------------------------------------------- */

/* A plate with 225 bores, seen almost along itself. */
static void crowd(csg *c)
{
    csg_place(c, csg_add(c, -1, CSG_DIFFERENCE), dvec_of(1, 1, 1), dvec_of(1, 0, 0.2), -65, dvec_of(0, 0, 0));
    csg_box(c, 0, dvec_of(-1.5, -1.5, -0.2), dvec_of(1.5, 1.5, 0.2));
    for (int k = 0; k < 225; k++)
        csg_move(c, csg_cylinder(c, 0, 0.06, 0.07, 1, 8), -1.33 + 0.19 * (k % 15), -1.33 + 0.19 * (k / 15), -0.5);
}

/* Shells in shells: every second one is taken away from what is around it. */
static void shells(csg *c)
{
    int parent = -1;
    for (int k = 0; k < 30; k++) {
        parent = csg_add(c, parent, CSG_DIFFERENCE);
        csg_place(c, csg_ball(c, parent, 1.5 - 0.045 * k, 12, 20), dvec_of(1, 1, 1), dvec_of(1, k, 2), 7 * k,
                  dvec_of(0, 0, 0));
    }
    csg_box(c, parent, dvec_of(-0.05, -0.06, -0.07), dvec_of(0.08, 0.05, 0.06));
}

/* Walls of a five-thousandth of the whole, and a pin of a hundredth. */
static void thin(csg *c)
{
    csg_place(c, csg_add(c, -1, CSG_DIFFERENCE), dvec_of(1, 1, 1), dvec_of(1, 2, 3), 35, dvec_of(0, 0, 0));
    csg_add(c, 0, CSG_UNION);
    csg_box(c, 1, dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    csg_move(c, csg_cylinder(c, 1, 0.015, 0.01, 0.3, 8), 0.3, 0.2, 0.9);
    csg_box(c, 0, dvec_of(-0.999, -0.999, -0.999), dvec_of(0.999, 0.999, 0.999));
}

/* Flush faces of what lies fifty times its size away from where numbers begin. */
static void distant(csg *c)
{
    plates(c);
    csg_place(c, 0, dvec_of(1, 1, 1), dvec_of(1, 2, 3), 50, dvec_of(100, -60, 80));
}

static void extremes(void)
{
    static const struct {
        const char *name;
        void (*make)(csg *c);
        int smaller; /* sixty layers under each other cost by their square, and a quarter of the pixels sees them all */
    } scenes[] = {{"225 bores", crowd, 1}, {"30 shells", shells, 2}, {"thin walls", thin, 1}};
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        csg       c = {0};
        shot_view view = views[k % 3];
        view.width /= scenes[k].smaller;
        view.height /= scenes[k].smaller;
        scenes[k].make(&c);
        csg_colour(&c);
        against_rays(scenes[k].name, &c, &view, true);
        csg_release(&c);
    }
    csg       c = {0};
    shot_view view = views[0];
    distant(&c);
    csg_colour(&c);
    view.target = dvec_of(100, -60, 80);
    view.eye = dvec_add(view.eye, view.target);
    against_rays("flush plates far away", &c, &view, true);
    csg_release(&c);
}

/* What is taken away may end behind the far plane, which is tight around the solid: the eye looks through the hole. */
static void through_the_back(void)
{
    static const uint32_t seeds[] = {20, 28};
    for (int k = 0; k < 4; k++) {
        csg       c = {0};
        char      title[64];
        shot_view view = {.width = 100, .height = 90, .eye = {0.3, -6, 0.4}, .up = {0, 0, 1}, .orthographic = k % 2};
        if (k < 2) {
            csg_add(&c, -1, CSG_DIFFERENCE);
            csg_box(&c, 0, dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
            csg_place(&c, csg_cylinder(&c, 0, 0.6, 0.6, 12, 24), dvec_of(1, 1, 1), dvec_of(1, 0, 0), -85,
                      dvec_of(0, -2, 0.3));
            csg_box(&c, 0, dvec_of(-2, -2, 0.6), dvec_of(-0.7, 1.005, 3));
            csg_colour(&c);
        } else {
            csg_random(&c, CSG_CONVEX, seeds[k - 2]);
            view = views[seeds[k - 2] % 3];
        }
        snprintf(title, sizeof title, "%s %d", k < 2 ? "a bore that ends behind the far plane" : "convex",
                 k < 2 ? k : (int)seeds[k - 2]);
        against_rays(title, &c, &view, true);
        csg_release(&c);
    }
}

/* --- single statements ---------------------------------------------------------------------------------- */

/* The second layer of a hollow box is the inner side of its front wall, not the far wall. */
static void inner_side(void)
{
    static const shot_view straight = {.width = 90,
                                       .height = 80,
                                       .eye = {0.03, -6, 0.02},
                                       .target = {0.03, 0, 0.02},
                                       .up = {0, 0, 1},
                                       .orthographic = true};
    for (int e = 0; e < DIRECTIONS; e++) {
        csg  c = {0};
        shot s;
        int  judged = 0, wrong = 0;
        hollow(&c);
        csg_colour(&c);
        bool drawn = draw(&s, &c, false, &modes[e], &straight);
        if (drawn && s.layer_count > 1)
            for (int i = 0; i < s.width * s.height; i++) {
                dvec origin, direction;
                shot_ray(&s, i % s.width + 0.5, i / s.width + 0.5, &origin, &direction);
                if (origin.x < -0.75 || origin.x > 0.65 || origin.z < -0.85 || origin.z > 0.7)
                    continue;
                judged++; /* the wall reaches from y = −1 to −0.7; its inner side looks along +y, away from the viewer
                           */
                wrong += fabs((double)s.layers[1].depth[i] - 5.3) > 0.001 || (double)s.layers[1].normal[i][2] > -0.99;
            }
        if (drawn) {
            check_at_least("C6", judged, 500, "%s: pixels through a hollow box", modes[e].name);
            check_at_most("C6", wrong, 0, "  whose second layer is not the inner side of its front wall");
            shot_release(&s);
        }
        csg_release(&c);
    }
}

/* Overlapping unions have no walls inside: behind the front there is only the back. */
static void no_inner_walls(void)
{
    for (int e = 0; e < DIRECTIONS; e++) {
        csg  c = {0};
        shot s;
        int  more = 0, full = 0;
        csg_add(&c, -1, CSG_UNION);
        for (int k = 0; k < 9; k++) {
            int node = k % 3 == 0 ? csg_box(&c, 0, dvec_of(-0.9, -0.3, -0.3), dvec_of(0.9, 0.3, 0.3))
                                  : csg_ball(&c, 0, 0.7, 12, 24);
            csg_place(&c, node, dvec_of(1, 0.9, 1), dvec_of(1, 2, k), 40 * k,
                      dvec_of(0.06 * (k % 3), 0.05 * (k % 4), 0.04 * (k % 5)));
        }
        csg_ball(&c, 0, 0.95, 12, 24);
        csg_colour(&c);
        csg_rays *r = csg_rays_create(&c, 30);
        csg_map   map = {0};
        if (draw(&s, &c, false, &modes[e], &views[0])) {
            csg_map_make(&map, r, &s);
            for (int i = 0; i < s.width * s.height; i++) {
                size_t drawn = 0;
                for (int k = 0; k < s.layer_count; k++)
                    drawn += !isinf(s.layers[k].depth[i]);
                full += csg_count(&map, i) > 0 && map.sharp[i];
                more += map.sharp[i] && drawn > csg_count(&map, i);
            }
            check_at_least("K03", full, 2000, "%s: pixels of ten leaves in each other", modes[e].name);
            check_at_most("K03", more, 0, "  that show a wall inside the union");
            shot_release(&s);
        }
        csg_map_release(&map);
        csg_rays_destroy(r);
        csg_release(&c);
    }
}

/* A cut's wall has the colour of the leaf that was taken away, whose outermost colour decides. */
static void cut_colours(void)
{
    csg c = {0};
    int inner;
    csg_add(&c, -1, CSG_DIFFERENCE);
    csg_box(&c, 0, dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    inner = csg_add(&c, 0, CSG_UNION);
    csg_move(&c, csg_cylinder(&c, inner, 0.5, 0.5, 3, 32), 0, 0, -0.5);
    csg_move(&c, csg_ball(&c, inner, 0.6, 16, 32), 1, 0.2, 0.3);
    csg_colour(&c);
    c.nodes[inner].has_colour = true;
    memcpy(c.nodes[inner].colour, (uint8_t[3]){250, 20, 120}, 3);
    against_rays("colour of an operation over its leaves", &c, &views[0], true);
    csg_release(&c);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"convex", convex},
        {"concave", concave},
        {"deep", deep},
        {"many", many},
        {"coincident", coincident},
        {"inside", from_inside},
        {"dialect", dialect},
        {"by-hand", by_hand},
        {"extremes", extremes},
        {"through", through_the_back},
        {"inner-side", inner_side},
        {"no-inner-walls", no_inner_walls},
        {"colours", cut_colours},
    };
    int status = check_main(argc, argv, "solid", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
