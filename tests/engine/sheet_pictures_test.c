/* Pictures below the lines of a sheet lie where the lines are: of views, sections, details and auxiliary views, what is
 * drawn of surfaces has the bounds of the lines around it. A bracket whose four sides all differ, so that a picture
 * that is turned over, moved or of another size does not fit. */
#include "checked.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "scene/scene.h"
#include "vector/vector.h"

/* Pixels of 600 an inch, as far as outlines stand out beyond surfaces, and what smooth edges of pictures leave. */
static const double near_enough = 0.15; /* mm */

#define MOVED(X, Y, Z, WHAT) "multmatrix([[1,0,0," #X "],[0,1,0," #Y "],[0,0,1," #Z "],[0,0,0,1]]) { " WHAT " }\n"
static const char bracket[] =
    "color([0.8, 0.3, 0.2, 1]) { difference() { union() { cube([60, 20, 8]); cube([12, 20, 40]);\n" MOVED(
        48, 4, 0, "cube([6, 9, 21]);") "}\n" MOVED(24, 10, -1, "cylinder(h = 10, r1 = 5, r2 = 5, $fn = 64);")
        MOVED(-1, 6, 28, "cube([14, 5, 30]);") "} }\n";

typedef struct extent {
    double low[2], high[2];
} extent;

static const extent nothing = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

static void take(extent *e, double x, double y)
{
    const double p[2] = {x, y};
    for (int k = 0; k < 2; k++) {
        e->low[k] = fmin(e->low[k], p[k]);
        e->high[k] = fmax(e->high[k], p[k]);
    }
}

static lmn_scene *load(void)
{
    char       path[64] = "/tmp/limner-bracket-XXXXXX.csg";
    const int  fd = mkstemps(path, 4);
    FILE      *file = fdopen(fd, "w");
    lmn_scene *scene = NULL;
    assert_non_null(file);
    fputs(bracket, file);
    fclose(file);
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, path, NULL, &error));
    unlink(path);
    return scene;
}

/* The view that a group lies in. */
static int32_t view_of(const sheet *s, uint32_t group)
{
    int32_t at = (int32_t)group;
    while (s->groups[at].parent >= 0)
        at = s->groups[at].parent;
    return at;
}

typedef struct picture {
    const sheet_item *item;
    unsigned char    *pixels;
    int               width, height;
} picture;

static picture open_picture(const sheet_item *item)
{
    picture   p = {.item = item};
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_memory(&image, item->png, item->png_size) != 0);
    image.format = PNG_FORMAT_RGBA;
    p.pixels = malloc(PNG_IMAGE_SIZE(image));
    p.width = (int)image.width;
    p.height = (int)image.height;
    assert_non_null(p.pixels);
    assert_true(png_image_finish_read(&image, NULL, p.pixels, 0, NULL) != 0);
    return p;
}

/* The least of red, green and blue; 255 where nothing is. */
static int darkest_at(const picture *p, int x, int y)
{
    if (x < 0 || y < 0 || x >= p->width || y >= p->height)
        return 255;
    const unsigned char *at = p->pixels + 4 * (y * p->width + x);
    const int            least = at[0] < at[1] ? at[0] : at[1];
    return at[3] < 128 ? 255 : least < at[2] ? least : at[2];
}

enum { PAPER = 240, CUT_FACE = 190 /* paler than any surface of it */ };

/* What of a picture is no paper, on the sheet. */
static extent extent_of_picture(const picture *p)
{
    extent        e = nothing;
    const double *box = p->item->box, wide = box[2] / p->width, high = box[3] / p->height;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            if (darkest_at(p, x, y) < PAPER) {
                take(&e, box[0] + wide * x, box[1] + high * y);
                take(&e, box[0] + wide * (x + 1), box[1] + high * (y + 1));
            }
    return e;
}

/* Of the lines of hatching in a view, how many have a cut face below their middle, per cent. */
static double hatched_on_cut_faces(const sheet *s, int32_t view, const picture *p)
{
    const double *box = p->item->box;
    size_t        all = 0, right = 0;
    for (size_t i = 0; i < s->item_count; i++) {
        const sheet_item *item = &s->items[i];
        const char *class = s->groups[item->group].css_class;
        if (item->kind != SHEET_PATH || view_of(s, item->group) != view || !class || !strstr(class, "hatch"))
            continue;
        for (uint32_t k = item->first; k < item->first + item->count; k++, all++) {
            const float *a = s->points[s->paths[k].first], *b = s->points[s->paths[k].first + 1];
            const double x = 0.5 * (double)(a[0] + b[0]) - box[0], y = 0.5 * (double)(a[1] + b[1]) - box[1];
            const int    here = darkest_at(p, (int)(x / box[2] * p->width), (int)(y / box[3] * p->height));
            right += here > CUT_FACE && here < PAPER;
        }
    }
    return all ? 100.0 * (double)right / (double)all : 100;
}

/* The visible lines of a view, by their middle. */
static extent extent_of_lines(const sheet *s, int32_t view)
{
    extent e = nothing;
    for (size_t i = 0; i < s->item_count; i++) {
        const sheet_item *item = &s->items[i];
        const char *class = s->groups[item->group].css_class;
        if (item->kind != SHEET_PATH || view_of(s, item->group) != view || !class || !strstr(class, "visible "))
            continue;
        for (uint32_t k = item->first; k < item->first + item->count; k++)
            for (uint32_t p = s->paths[k].first; p < s->paths[k].first + s->paths[k].count; p++)
                take(&e, (double)s->points[p][0], (double)s->points[p][1]);
    }
    return e;
}

static size_t check_pictures(lmn_renderer *renderer, const lmn_scene *scene, const lmn_sheet_desc *desc)
{
    lmn_look     *look = NULL;
    lmn_sheet    *drawn = NULL;
    lmn_draw_desc how = LMN_DRAW_DESC_INIT;
    size_t        pictures = 0;
    how.dpi = 300;
    DO(lmn_look_load(&look, "edges", &error));
    DO(lmn_look_set(look, "scene.ground", "none", &error));
    DO(lmn_draw_sheet(&drawn, renderer, scene, look, &how, desc, &error));
    const sheet *s = &drawn->page;
    for (size_t i = 0; i < s->item_count; i++) {
        if (s->items[i].kind != SHEET_IMAGE)
            continue;
        int32_t view = view_of(s, s->items[i].group);
        picture below = open_picture(&s->items[i]);
        extent  seen = extent_of_picture(&below), lines = extent_of_lines(s, view);
        double  off = 0;
        if (strstr(s->groups[view].name, "detail")) /* the circle ends surfaces below, where it ends no line */
            seen.high[1] = lines.high[1] = fmin(seen.high[1], lines.high[1]);
        for (int k = 0; k < 2; k++)
            off = fmax(off, fmax(fabs(seen.low[k] - lines.low[k]), fabs(seen.high[k] - lines.high[k])));
        double hatched = hatched_on_cut_faces(s, view, &below);
        print_message("%-14s %.1f x %.1f mm of lines, picture %.3f mm off, %.1f %% of hatching on cut faces\n",
                      s->groups[view].name, lines.high[0] - lines.low[0], lines.high[1] - lines.low[1], off, hatched);
        assert_true(off < near_enough && hatched > 95);
        free(below.pixels);
        pictures++;
    }
    lmn_sheet_destroy(&drawn);
    lmn_look_destroy(&look);
    return pictures;
}

static void pictures_lie_below_their_lines(void **state)
{
    lmn_renderer  *renderer = NULL;
    lmn_scene     *scene = load();
    lmn_sheet_desc d = LMN_SHEET_DESC_INIT;
    (void)state;
    DO(lmn_renderer_create(&renderer, NULL, &error));
    d.page = "A4-landscape";
    d.smooth = 0;
    d.views = "front,top,iso";
    assert_int_equal(check_pictures(renderer, scene, &d), 3);
    d.views = "front,top";
    d.sections = "front@half;top@40%";
    d.details = "front@51,8,20/6";
    d.auxiliary = "1,0,1";
    assert_int_equal(check_pictures(renderer, scene, &d), 6);
    lmn_renderer_destroy(&renderer);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_lie_below_their_lines)};
    return cmocka_run_group_tests_name("sheet pictures", tests, NULL, NULL);
}
