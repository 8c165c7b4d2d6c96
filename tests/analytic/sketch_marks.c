/* What perturbed drawings leave on the paper: how broad lines swell and thin under pressure, and that grains which
 * stay bare hide what stands behind. Rows S06, S08; the weight of lines. */
#include <stdio.h>

#include "../support/check.h"
#include "../support/shape.h"
#include "../support/shot.h"

static const shot_view front = {.width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};

/* The pixels of a row's run of ink that is at least half black. */
static int width_at(const shot *s, int y, int from, int to)
{
    int dark = 0;
    for (int x = from; x < to; x++)
        dark += s->picture[4 * (y * s->width + x) + 1] < 128;
    return dark;
}

/* The left side of a plate in lines of 8 px that stay where they are: with pressure their width varies, without it
 * does not. */
static void broad(void)
{
    static const char *const change[] = {"finish.ground", "#ffffff", NULL};
    for (int pressed = 0; pressed < 2; pressed++) {
        int   least = 1000, most = 0;
        shape s = {0};
        shot  drawn;
        shape_quad(&s, "plate", 1.6, 0);
        const char *look = pressed ? "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":{"
                                     "\"technique\":\"flat\",\"colour\":\"none\"},\"lines\":{\"operator\":"
                                     "\"discontinuity\",\"colour\":\"#000000\",\"width\":8},\"perturb\":{\"technique\":"
                                     "\"uncertainty\",\"amount\":0.01,\"scale\":40,\"pressure\":0.8}}]}"
                                   : "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":{"
                                     "\"technique\":\"flat\",\"colour\":\"none\"},\"lines\":{\"operator\":"
                                     "\"discontinuity\",\"colour\":\"#000000\",\"width\":8},\"perturb\":{\"technique\":"
                                     "\"uncertainty\",\"amount\":0.01,\"scale\":40}}]}";
        if (shot_of_shape(&drawn, &s, "broad.glb", look, change, &front)) {
            int side = (int)shot_project(&drawn, dvec_of(-1.6, 0, 0)).x;
            for (int y = 100; y < 300; y++) {
                int width = width_at(&drawn, y, side - 16, side + 16);
                least = width < least ? width : least;
                most = width > most ? width : most;
            }
            if (pressed) {
                check_at_most("S08", least, 6, "a line of 8 px under pressure: where it is thinnest");
                check_at_least("S08", least, 1, "  but it is there");
                check_at_least("S08", most, 10, "  where it is thickest");
            } else {
                check_near("S08", least, 8, 1, "without pressure: where it is thinnest");
                check_near("S08", most, 8, 1, "  where it is thickest");
            }
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* A red plate wholly behind a chalked one, drawn before and after it: bare grains show the paper, not the plate. */
static void hidden(void)
{
    static const char *const rules[2] = {
        "{\"select\":\"behind\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"}},{\"select\":\"chalk\","
        "\"surface\":{\"technique\":\"flat\",\"colour\":"
        "\"#4060ff\"},\"perturb\":{\"technique\":\"uncertainty\",\"amount\":1,\"tooth\":0.6,\"rough\":1.5}}",
        "{\"select\":\"chalk\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#4060ff\"},\"perturb\":{\"technique\":"
        "\"uncertainty\",\"amount\":1,\"tooth\":0.6,"
        "\"rough\":1.5}},{\"select\":\"behind\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"}}"};
    static const char *const change[] = {"finish.ground", "#ffffff", NULL};
    for (int order = 0; order < 2; order++) {
        char  look[1024];
        int   red = 0, bare = 0, blue = 0;
        shape s = {0};
        shot  drawn;
        snprintf(look, sizeof look, "{\"version\":1,\"name\":\"t\",\"rules\":[%s]}", rules[order]);
        shape_quad(&s, "behind", 1.2, -1);
        shape_quad(&s, "chalk", 1.6, 0);
        if (shot_of_shape(&drawn, &s, "hidden.glb", look, change, &front))
            for (int i = 0; i < drawn.width * drawn.height; i++) {
                const uint8_t *p = &drawn.picture[4 * i];
                red += p[0] > p[2];
                bare += p[0] > 250 && p[2] > 250 && drawn.id[i];
                blue += p[0] < 80 && p[2] > 200;
            }
        check_at_most("S06", red, 0, "pixels of a plate behind a chalked one that show (order %d)", order);
        check_at_least("S08", bare, 1000, "  grains that stay bare");
        check_at_least("S08", blue, 1000, "  grains that are chalked");
        shot_release(&drawn);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"broad", broad}, {"hidden", hidden}};
    int                     status = check_main(argc, argv, "sketch_marks", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
