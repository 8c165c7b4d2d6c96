/* The rim light: what it adds, and that it takes nothing. */
#include <stdio.h>

#include "check.h"
#include "light_truth.h"
#include "picture.h"

static const dvec      towards_light = {-1, 1.2, 0.5};
static const shot_view above = {
    .width = 400, .height = 320, .eye = {1.4, 5, 7.9}, .up = {0, 1, 0}, .orthographic = true};

/* A rim light comes from behind, from the side of the page that the key light is not on: it lights what Lambert's law
 * says and nothing that faces the viewer. */
static void rim_is_from_behind(void)
{
    light_scene l = {.file = "ball.glb", .towards = towards_light, .softness = -1, .view = above};
    shot        with, without;
    shape_sphere(&l.s, "ball", dvec_of(0, 0, 0), 2, 64, 128, true);
    dvec   key = light_seen_from(&l.view, l.towards);
    double across = hypot(key.x, key.y), length = across * sqrt(1 + 1.2 * 1.2);
    dvec   rim = dvec_of(-key.x / length, -key.y / length, -1.2 * across / length);
    if (light_shot(&without, &l, false)) {
        l.rim = 0.6;
        if (light_shot(&with, &l, false)) {
            int off = 0, lit = 0, dark = 0;
            for (int i = 0; i < with.width * with.height; i++) {
                if (!(with.depth[i] < INFINITY) || with.picture[4 * i] >= 250)
                    continue;
                const float *n = with.normal[i];
                double       law = rim.x * (double)n[0] + rim.y * (double)n[1] + rim.z * (double)n[2];
                double       more = picture_linear(with.picture[4 * i]) - picture_linear(without.picture[4 * i]);
                off += fabs(more - 0.99 * 0.6 * fmax(law, 0)) > 0.015;
                lit += law > 0.05;
                dark += law <= 0;
            }
            check_at_least("P30", lit, 1000, "places of a ball that a rim light reaches");
            check_at_least("P30", dark, 5000, "that it does not reach");
            check_at_most("P30", off, 0.002 * (lit + dark), "of them where it adds something else than Lambert's law");
            shot_release(&with);
        }
        shot_release(&without);
    }
    shape_release(&l.s);
}

/* Techniques that take half of Lambert's law, where lights share one sum, lose nothing to it either. */
static void rim_takes_nothing(void)
{
    shape     s = {0};
    shot      with, without;
    shot_view view = above;
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 2, 64, 128, true);
    const char              *look = "{\"version\":1,\"name\":\"t\",\"scene\":{\"rim\":%s,\"light_direction\":[-1,1,1]},"
                                    "\"rules\":[{\"surface\":{\"technique\":\"%s\"}}]}";
    static const char *const techniques[] = {"tones", "wax"};
    for (int t = 0; t < 2; t++) {
        char none[256], some[256];
        snprintf(none, sizeof none, look, "0", techniques[t]);
        snprintf(some, sizeof some, look, "0.6", techniques[t]);
        if (!shot_of_shape(&without, &s, "ball.glb", none, NULL, &view))
            continue;
        if (shot_of_shape(&with, &s, "ball.glb", some, NULL, &view)) {
            int darker = 0, lighter = 0;
            for (int i = 0; i < with.width * with.height; i++) {
                darker += with.picture[4 * i] < without.picture[4 * i];
                lighter += with.picture[4 * i] > without.picture[4 * i];
            }
            check_at_most("P30", darker, 0, "places that a rim light makes darker, %s", techniques[t]);
            check_at_least("P30", lighter, 500, "that it makes lighter");
            shot_release(&with);
        }
        shot_release(&without);
    }
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"law", rim_is_from_behind}, {"half", rim_takes_nothing}};
    int                     status = check_main(argc, argv, "rim-light", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
