/* Dots and strokes of surfaces as vectors, drawn by another program (rsvg-convert), beside the picture that the GPU
 * draws of the same look and view: the same tone everywhere, and ink in the same positions. Lines are left out, for
 * those of pictures are others. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"

enum { SIDE = 1024, FINER = 2, BLOCK = 16 };

static bool run(const char *command)
{
    return system(command) == 0;
}

/* A look of nothing but marks. */
static bool write_look(const char *path, const char *surface)
{
    FILE *f = fopen(path, "w");
    if (!f)
        return false;
    fprintf(f, "{\"version\":1,\"rules\":[{\"select\":\"*\",\"surface\":{%s,\"ink\":\"#171717\"}}]}\n", surface);
    return fclose(f) == 0;
}

static bool draw(const char *model, const char *look, const char *options, const char *out)
{
    char command[1024];
    snprintf(command, sizeof command, "%s draw %s/%s --look %s --size %dx%d %s --quiet -o %s", LIMNER_COMMAND,
             LIMNER_EXAMPLES, model, look, SIDE, SIDE, options, out);
    return run(command);
}

static double fraction_of(double value, double paper, double ink)
{
    return fmin(fmax((paper - value) / (paper - ink), 0), 1);
}

/* The fraction of each pixel that ink covers. */
static double *cover_of(const char *path, int finer)
{
    static const uint8_t ink = 0x17;
    int                  width, height;
    uint8_t             *p = picture_read_rgba(path, &width, &height);
    if (!check_that("8", p && width == SIDE * finer && height == SIDE * finer, "%s is a picture of that size", path)) {
        free(p);
        return NULL;
    }
    double *out = check_alloc(SIDE * SIDE, sizeof *out);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint8_t v = p[4 * ((size_t)y * (size_t)width + (size_t)x)];
            out[y / finer * SIDE + x / finer] += fraction_of(v, 255, ink) / (finer * finer);
        }
    free(p);
    return out;
}

/* Mean difference of blocks in which either has ink. */
static double tone_off(const double *a, const double *b)
{
    double sum = 0;
    int    count = 0;
    for (int y = 0; y < SIDE; y += BLOCK)
        for (int x = 0; x < SIDE; x += BLOCK) {
            double one = 0, other = 0;
            for (int i = 0; i < BLOCK * BLOCK; i++) {
                size_t at = (size_t)(y + i / BLOCK) * SIDE + (size_t)(x + i % BLOCK);
                one += a[at] / (BLOCK * BLOCK);
                other += b[at] / (BLOCK * BLOCK);
            }
            sum += one + other > 0 ? fabs(one - other) : 0;
            count += one + other > 0;
        }
    return count ? sum / count : 1;
}

/* The fraction of one's ink that has some of the other's within 1.5 pixels. */
static double fraction_near(const double *a, const double *b)
{
    size_t all = 0, near = 0;
    for (int y = 1; y < SIDE - 1; y++)
        for (int x = 1; x < SIDE - 1; x++) {
            if (a[y * SIDE + x] < 0.5)
                continue;
            bool found = false;
            for (int j = -1; j <= 1 && !found; j++)
                for (int i = -1; i <= 1 && !found; i++)
                    found = b[(y + j) * SIDE + x + i] >= 0.5;
            all++;
            near += found;
        }
    return all ? (double)near / (double)all : 0;
}

static void same_as_pictures(void)
{
    static const char *const models[] = {"spot.obj", "gearbox.stl", "house.glb"}, *const looks[] = {"stipple",
                                                                                                    "strokes", "lines",
                                                                                                    "pen"};
    static const char *const surfaces[] = {"\"technique\":\"stipple\",\"shadow\":0.16,\"texture\":0.3",
                                           "\"technique\":\"strokes\"",
                                           "\"technique\":\"lines\",\"length\":0.17,\"groups\":0.6,\"pressure\":0.9,"
                                           "\"patchy\":0.6,\"stray\":1.2,\"room\":4",
                                           "\"technique\":\"lines\",\"length\":0.2,\"series\":3,\"steady\":true,"
                                           "\"crossed\":0.35,\"join\":0.4,\"taper\":6"};
    /* Lines that swell pass half a pixel of width, below which pictures and vectors round ink off differently. */
    static const double drawn[] = {0.99, 0.99, 0.975, 0.975}, found[] = {0.99, 0.99, 0.935, 0.935};
    if (!run("command -v rsvg-convert >/dev/null 2>&1")) {
        check_note("rsvg-convert is not installed: vector drawings are not compared with pictures");
        return;
    }
    for (size_t m = 0; m < sizeof models / sizeof *models; m++)
        for (size_t l = 0; l < sizeof looks / sizeof *looks; l++) {
            char look[256], png[256], svg[256], shown[256], command[1024];
            snprintf(look, sizeof look, "%s", check_path("%s.json", looks[l]));
            snprintf(png, sizeof png, "%s", check_path("marks-%s-%s.png", models[m], looks[l]));
            snprintf(svg, sizeof svg, "%s", check_path("marks-%s-%s.svg", models[m], looks[l]));
            snprintf(shown, sizeof shown, "%s", check_path("marks-%s-%s-svg.png", models[m], looks[l]));
            snprintf(command, sizeof command, "rsvg-convert -w %d -h %d %s -o %s", SIDE * FINER, SIDE * FINER, svg,
                     shown);
            if (!check_that("8",
                            write_look(look, surfaces[l]) && draw(models[m], look, "--samples 4", png) &&
                                draw(models[m], look, "", svg) && run(command),
                            "%s is drawn as %s", models[m], looks[l]))
                continue;
            double *own = cover_of(png, 1), *other = cover_of(shown, FINER);
            if (own && other) {
                check_at_most("EX-07", tone_off(own, other), 0.03,
                              "%s, %s: tone of %dx%d pixels off, mean of those with ink", models[m], looks[l], BLOCK,
                              BLOCK);
                check_at_least("EX-07", fraction_near(other, own), drawn[l],
                               "%s, %s: ink that the picture has within 1.5 px", models[m], looks[l]);
                check_at_least("EX-07", fraction_near(own, other), found[l],
                               "%s, %s: ink of the picture that vectors have within 1.5 px", models[m], looks[l]);
            }
            free(own);
            free(other);
        }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"marks are those of pictures", same_as_pictures}};
    return check_main(argc, argv, "vector_marks", cases, 1);
}
