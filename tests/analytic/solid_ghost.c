/* What solids take away, drawn see-through: where it is seen, what of the picture it leaves alone, how many layers
 * it has, and what the picture is fitted to. The truth are rays through the solid and through what was taken away. */
#include <limner/limner.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "csg_map.h"
#include "csg_scenes.h"

static const shot_view views[] = {
    {.width = 260, .height = 220, .eye = {4, 3, 5}, .up = {0, 0, 1}, .without_maps = true},
    {.width = 220, .height = 240, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true, .without_maps = true},
    {.width = 240, .height = 230, .eye = {1, -3.5, 3.5}, .up = {0.2, 1, 0}, .fov_deg = 45, .without_maps = true},
    {.width = 230, .height = 210, .eye = {4, -3, 2}, .up = {0, 0, 1}, .without_maps = true, .es = true},
};

enum { VIEWS = sizeof views / sizeof *views };

/* White, without light or lines, and each layer of a ghost takes half of its green and blue away. */
static const char counting[] =
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":["
    "{\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"}},"
    "{\"select\":\"@removed\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"},"
    "\"layers\":{\"technique\":\"peel\",\"count\":0},\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}}]}";

/* --- models: the solid, and what was taken away from it ------------------------------------------------- */

typedef struct model {
    const char *name;
    void (*make)(csg *whole, csg *gone);
} model;

static dvec same(void)
{
    return dvec_of(1, 1, 1);
}

/* A through hole, drilled along z, and a blind one from the side whose drill ends in a tip. */
static void drilled(csg *whole, csg *gone)
{
    csg_add(whole, -1, CSG_DIFFERENCE);
    csg_box(whole, 0, dvec_of(-1, -1, -0.6), dvec_of(1, 1, 0.6));
    csg_move(whole, csg_cylinder(whole, 0, 0.4, 0.4, 2, 32), 0.3, 0.3, -1);
    csg_place(whole, csg_cylinder(whole, 0, 0, 0.25, 1.6, 24), same(), dvec_of(1, 0, 0), 90, dvec_of(-0.5, -0.1, 0.1));
    csg_add(gone, -1, CSG_UNION);
    csg_copy(gone, 0, whole, 2);
    csg_copy(gone, 0, whole, 3);
}

/* What is taken away is a shell: a ball without a bar. */
static void shelled(csg *whole, csg *gone)
{
    csg_add(whole, -1, CSG_UNION);
    int cut = csg_add(whole, 0, CSG_DIFFERENCE);
    csg_place(whole, cut, same(), dvec_of(0, 1, 0), 20, dvec_of(0.1, 0, 0));
    csg_box(whole, cut, dvec_of(-1, -0.9, -0.8), dvec_of(0.8, 1, 0.6));
    int shell = csg_add(whole, cut, CSG_DIFFERENCE);
    csg_move(whole, shell, 0.6, 0.5, 0.4);
    csg_ball(whole, shell, 0.9, 16, 24);
    csg_box(whole, shell, dvec_of(-0.2, -2, -0.3), dvec_of(0.3, 2, 0.2));
    csg_add(gone, -1, CSG_UNION);
    int position = csg_add(gone, 0, CSG_UNION);
    csg_place(gone, position, same(), dvec_of(0, 1, 0), 20, dvec_of(0.1, 0, 0));
    csg_copy(gone, position, whole, shell);
}

/* Cutters that overlap and are not convex, one after the other. */
static void carved(csg *whole, csg *gone)
{
    csg_add(whole, -1, CSG_DIFFERENCE);
    int first = csg_add(whole, 0, CSG_DIFFERENCE);
    csg_ball(whole, first, 1.2, 20, 32);
    int star = csg_star(whole, first, 0.7, 0.35, 5, 2.4);
    int ring = csg_torus(whole, 0, 1.0, 0.3, 32, 16);
    csg_add(gone, -1, CSG_UNION);
    csg_copy(gone, 0, whole, star);
    csg_copy(gone, 0, whole, ring);
}

static const model models[] = {{"drilled", drilled}, {"shelled", shelled}, {"carved", carved}};

enum { MODELS = sizeof models / sizeof *models };

/* --- where it is seen ----------------------------------------------------------------------------------- */

typedef struct truth {
    csg_map whole, gone;
} truth;

static double depth_at(const csg_map *m, int pixel, size_t layer)
{
    return csg_count(m, pixel) > layer ? csg_at(m, pixel)[layer].depth : (double)INFINITY;
}

/* Layers of what was taken away that lie in front of the solid, and those on its surface: walls of the hole. */
static int layers_in_front(const truth *t, int pixel, int *on)
{
    double wall = depth_at(&t->whole, pixel, 0);
    int    before = 0;
    *on = 0;
    for (size_t k = 0; k < csg_count(&t->gone, pixel); k++) {
        double depth = depth_at(&t->gone, pixel, k), off = isinf(wall) ? -1 : (depth - wall) / wall;
        before += off < -1e-4;
        *on += off >= -1e-4 && off <= 1e-4;
    }
    return before;
}

/* Is any of it seen within so many pixels? */
static bool seen_near(const truth *t, int x, int y, int reach)
{
    int on;
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
            if (i >= 0 && j >= 0 && i < t->whole.width && j < t->whole.height &&
                layers_in_front(t, j * t->whole.width + i, &on) + on > 0)
                return true;
    return false;
}

static bool is_border(const truth *t, int x, int y)
{
    return csg_map_border(&t->whole, x, y, 1) || csg_map_border(&t->gone, x, y, 0);
}

/* Lines have soft rims: a pixel farther. */
static bool is_line(const truth *t, int x, int y)
{
    for (int k = 0; k < 9; k++)
        if (is_border(t, x + k % 3 - 1, y + k / 3 - 1))
            return true;
    return false;
}

/* Pixels in which it is seen are tinted towards red; beyond the reach of its lines nothing changes. `unseen`:
 * nothing of it has a colour. Where it sticks out nearer or farther than the solid, the depth range is another one
 * and depth is rounded otherwise, in which a pixel of a line may differ from edges. */
static void check_tint(const char *name, const truth *t, const shot *plain, const shot *unseen, const shot *ghost)
{
    int tinted = 0, bare = 0, alone = 0, changed = 0, rounded = 0, on;
    for (int i = 0; i < plain->width * plain->height; i++) {
        const uint8_t *a = &plain->picture[4 * i], *b = &ghost->picture[4 * i];
        int            x = i % plain->width, y = i / plain->width;
        if (!seen_near(t, x, y, 5)) {
            alone++;
            changed += memcmp(&unseen->picture[4 * i], b, 4) != 0;
            rounded += memcmp(a, b, 4) != 0;
        } else if (layers_in_front(t, i, &on) > 0 && !is_line(t, x, y)) {
            tinted++;
            bare += memcmp(a, b, 4) == 0 || b[0] - (b[1] + b[2]) / 2 <= a[0] - (a[1] + a[2]) / 2;
        }
    }
    check_at_least("C9", tinted, 800, "%s: pixels in which something taken away is seen", name);
    check_at_most("C9", bare, 0, "  of them, those that are not tinted");
    check_at_least("C9", alone, 2000, "  pixels out of its reach");
    bool same_range = plain->near_depth == ghost->near_depth && plain->far_depth == ghost->far_depth;
    check_at_most("C9", changed, 0, "  of them, those that are not as when it is there without a colour");
    check_at_most("C9", rounded, same_range ? 0 : 0.0005 * alone, "  of them, those that are not as in edges, %s",
                  same_range ? "at the same depth range" : "rounded otherwise");
}

/* 255 after no layer, then halves; −1: none of these. */
static int layers_of(const uint8_t *p)
{
    for (int n = 0; n < 12; n++) {
        if (fabs(p[1] - 255 * pow(0.5, n)) <= 1.5)
            return n;
    }
    return -1;
}

/* Layers in front of the solid count; one on its surface may, but then everywhere alike: no speckles. */
static void check_layers(const char *name, const truth *t, const shot *s)
{
    int sure = 0, wrong = 0, walls[2] = {0}, on;
    for (int i = 0; i < s->width * s->height; i++) {
        if (is_border(t, i % s->width, i / s->width))
            continue;
        int before = layers_in_front(t, i, &on), drawn = layers_of(&s->picture[4 * i]);
        sure++;
        if (drawn == before && on > 0)
            walls[0]++;
        else if (on > 0 && drawn == before + 1)
            walls[1]++;
        else
            wrong += drawn != before;
    }
    check_at_least("C9", sure, 0.8 * s->width * s->height, "%s: pixels that are no border", name);
    check_at_most("C9", wrong, 0.0005 * sure, "  with another number of layers");
    check_at_most("C9", walls[0] < walls[1] ? walls[0] : walls[1], 0.01 * (walls[0] + walls[1]),
                  "  walls of holes that differ from the %d others", walls[0] < walls[1] ? walls[1] : walls[0]);
}

static void check_view(const model *m, const char *path, csg_rays *whole, csg_rays *gone, int v)
{
    char title[64];
    snprintf(title, sizeof title, "%s, view %d", m->name, v);
    static const char *const colourless[] = {
        "1:compose.opacity", "0", "1:compose.rim", "0", "1:lines.operator", "none", NULL};
    shot plain, unseen, ghost, layers;
    if (!shot_take(&plain, path, "edges", NULL, &views[v]) ||
        !shot_take(&unseen, path, "ghost", colourless, &views[v]) ||
        !shot_take(&ghost, path, "ghost", NULL, &views[v]) || !shot_take(&layers, path, counting, NULL, &views[v]))
        return;
    truth t;
    csg_map_make(&t.whole, whole, &ghost); /* whose near plane is in front of both */
    csg_map_make(&t.gone, gone, &ghost);
    check_tint(title, &t, &plain, &unseen, &ghost);
    check_layers(title, &t, &layers);
    csg_map_release(&t.whole);
    csg_map_release(&t.gone);
    shot_release(&plain);
    shot_release(&unseen);
    shot_release(&ghost);
    shot_release(&layers);
}

static void seen_in_front(void)
{
    for (int i = 0; i < MODELS; i++) {
        csg  whole = {0}, gone = {0};
        char path[512];
        models[i].make(&whole, &gone);
        snprintf(path, sizeof path, "%s", check_path("%s.csg", models[i].name));
        if (!check_that("files", csg_write(&whole, path), "%s can be written", path))
            continue;
        csg_rays *a = csg_rays_create(&whole, 30), *b = csg_rays_create(&gone, 30);
        for (int v = 0; v < VIEWS; v++)
            check_view(&models[i], path, a, b, v);
        csg_rays_destroy(a);
        csg_rays_destroy(b);
        csg_release(&whole);
        csg_release(&gone);
    }
}

/* --- what the picture is fitted to ---------------------------------------------------------------------- */

/* A cube of two units, and a rod through it that ends so far from its middle. */
static bool pierced(shot *out, const char *look, const char *select, double reach, double side)
{
    static const shot_view fitted = {.width = 160, .height = 160, .bare = true, .without_maps = true};
    char                   path[512];
    csg                    c = {0};
    csg_add(&c, -1, CSG_DIFFERENCE);
    csg_box(&c, 0, dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    csg_box(&c, 0, dvec_of(-side, -0.3, -reach), dvec_of(0.3, 0.3, reach));
    snprintf(path, sizeof path, "%s", check_path("pierced.csg"));
    shot_view view = fitted;
    view.select = select;
    bool good = csg_write(&c, path) && shot_take(out, path, look, NULL, &view);
    csg_release(&c);
    return good;
}

static double view_difference(const shot *a, const shot *b)
{
    double most = 0;
    for (int i = 0; i < 16; i++)
        most = fmax(most, fabs(a->view[i] - b->view[i]));
    return most;
}

static void fitted_to_the_solid(void)
{
    const double diagonal = sqrt(12), edge = 1 + diagonal / 4;
    shot         plain, inside, at_edge, far;
    if (!pierced(&plain, "edges", NULL, 100, 0.3) || !pierced(&inside, "ghost", NULL, 1, 0.3) ||
        !pierced(&at_edge, "ghost", NULL, edge, 0.3) || !pierced(&far, "ghost", NULL, 100, 0.3))
        return;
    check_at_most("C9", view_difference(&plain, &inside), 0,
                  "a cutter that stays inside: the camera differs from that of edges by");
    check_at_least("C9", view_difference(&plain, &far), 0.1, "one that sticks out: it differs by");
    check_at_most("C9", view_difference(&at_edge, &far), 1e-5,
                  "one of 100 units: it differs from that of one that ends a quarter of the diagonal out by");
    shot_release(&plain);
    shot_release(&inside);
    shot_release(&at_edge);
    shot_release(&far);
}

/* --- what stays as it is -------------------------------------------------------------------------------- */

/* One renderer and one scene, looks in turn: a picture depends on its look alone. */
static void in_turn(void)
{
    static const char *const looks[] = {"edges", "ghost", "edges", "ghost", "xray", "ghost", "xray"};
    enum { TURNS = sizeof looks / sizeof *looks };
    char              path[512];
    lmn_renderer     *renderer = NULL;
    lmn_scene        *scene = NULL;
    lmn_drawing      *drawn[TURNS] = {NULL};
    lmn_renderer_desc how = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    csg               whole = {0}, gone = {0};
    drilled(&whole, &gone);
    snprintf(path, sizeof path, "%s", check_path("turns.csg"));
    desc.width = desc.height = 160;
    desc.dpi = 96;
    bool good = csg_write(&whole, path) && lmn_renderer_create(&renderer, &how, NULL) == LMN_OK &&
                lmn_scene_create(&scene, NULL) == LMN_OK && lmn_scene_add_file(scene, path, NULL, NULL) == LMN_OK;
    for (int i = 0; i < TURNS && good; i++) {
        lmn_look *look = NULL;
        good = lmn_look_load(&look, looks[i], NULL) == LMN_OK &&
               lmn_draw(&drawn[i], renderer, scene, look, &desc, NULL) == LMN_OK;
        lmn_look_destroy(&look);
    }
    if (check_that("files", good, "all are drawn")) {
        static const int pairs[][2] = {{0, 2}, {1, 3}, {1, 5}, {4, 6}};
        for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
            const uint8_t *a = lmn_drawing_pixels(drawn[pairs[i][0]], NULL, NULL),
                          *b = lmn_drawing_pixels(drawn[pairs[i][1]], NULL, NULL);
            check_that("C9", memcmp(a, b, 160 * 160 * 4) == 0, "%s after %s is what it was", looks[pairs[i][1]],
                       looks[pairs[i][1] - 1]);
        }
        check_that("C9",
                   memcmp(lmn_drawing_pixels(drawn[0], NULL, NULL), lmn_drawing_pixels(drawn[1], NULL, NULL),
                          160 * 160 * 4) != 0,
                   "ghost is not edges");
    }
    for (int i = 0; i < TURNS; i++)
        lmn_drawing_destroy(&drawn[i]);
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
    csg_release(&whole);
    csg_release(&gone);
}

/* Asked for and not there: a warning, and the picture of edges. With --select, it goes with its part. */
static void selected(void)
{
    shot plain, without, with, alone;
    csg  c = {0};
    char path[512];
    csg_add(&c, -1, CSG_UNION);
    csg_box(&c, 0, dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    snprintf(path, sizeof path, "%s", check_path("whole.csg"));
    if (!csg_write(&c, path) || !shot_take(&plain, path, "edges", NULL, &views[0]) ||
        !shot_take(&without, path, "ghost", NULL, &views[0]))
        return;
    check_at_most("C9", shot_differing(&plain, &without, 0), 0, "nothing taken away: values that differ from edges");
    check_that("C9", shot_has_warning(&without, "no-match") && !shot_has_warning(&plain, "no-match"),
               "  with a warning");
    shot_release(&plain);
    shot_release(&without);
    csg_release(&c);
    if (!pierced(&plain, "ghost", NULL, 1.5, 0.3) || !pierced(&with, "ghost", "pierced", 1.5, 0.3) ||
        !pierced(&alone, "ghost", "@removed", 1.5, 0.3))
        return;
    check_at_most("C9", shot_differing(&plain, &with, 0), 0, "the part selected: values that differ");
    check_at_least("C9", shot_differing(&plain, &alone, 0), 1000, "@removed selected alone: values that differ");
    shot_release(&plain);
    shot_release(&with);
    shot_release(&alone);
}

/* Sections cut it with its part; where that stays whole, so does it. */
static void cut_with_its_part(void)
{
    static const char *const cut[] = {"scene.cut", "x", NULL}, *const kept[] = {"scene.cut", "x", "scene.cut_keep",
                                                                                "pierced", NULL};
    shot      whole, other;
    shot_view view = {.width = 160, .height = 160, .eye = {6, 3, 4}, .up = {0, 0, 1}, .without_maps = true};
    if (!pierced(&whole, "ghost", NULL, 1.5, 0.3) ||
        !shot_take(&other, check_path("pierced.csg"), "ghost", kept, &view))
        return;
    shot_release(&whole);
    if (!shot_take(&whole, check_path("pierced.csg"), "ghost", NULL, &view))
        return;
    check_at_most("C9", shot_differing(&whole, &other, 0), 0, "its part stays whole: values that differ");
    shot_release(&whole);
    shot_release(&other);
    if (!shot_take(&whole, check_path("pierced.csg"), "edges", cut, &view) ||
        !shot_take(&other, check_path("pierced.csg"), "ghost", cut, &view))
        return;
    /* The hole is open to the viewer, and of the hatched face beside it nothing changes. */
    int red = 0, face = 0;
    for (int i = 0; i < view.width * view.height; i++) {
        const uint8_t *a = &whole.picture[4 * i], *b = &other.picture[4 * i];
        red += b[0] > b[1] + 20;
        face += a[0] < 200 && memcmp(a, b, 4) == 0;
    }
    check_at_least("C9", red, 500, "cut: pixels that are tinted");
    check_at_least("C9", face, 1500, "  pixels of the solid that are not");
    shot_release(&whole);
    shot_release(&other);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"seen", seen_in_front},
                                       {"fitted", fitted_to_the_solid},
                                       {"turns", in_turn},
                                       {"selected", selected},
                                       {"cut", cut_with_its_part}};
    int                     status = check_main(argc, argv, "solid_ghost", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
