/* The field of uncertainty value by value, against its formula on the CPU. */
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "noise_twin.h"
#include "scenes.h"
#include "shot.h"

static const double pi = 3.14159265358979323846;

enum { RIM = 4, WIDE = 150, SIDE = 128, SCALE = 24 };

/* The field of a shape that fills the picture; the small amount keeps the rim in which fields shrink narrow. */
static bool field_of(shot *out, const shape *s, const char *settings, const shot_view *view)
{
    char text[640];
    snprintf(
        text, sizeof text,
        "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":\"flat\",\"lines\":\"discontinuity\","
        "\"perturb\":{\"technique\":\"uncertainty\",\"amount\":0.5,%s}}]}",
        settings);
    return shot_of_shape(out, s, "field.glb", text, NULL, view) &&
           check_that("S02", out->uncertainty != NULL, "the drawing has its field of uncertainty");
}

/* A component of the field at a pixel (row 0 on top). */
static double at(const shot *s, int x, int y, int channel)
{
    return (double)s->uncertainty[(size_t)y * (size_t)s->width + (size_t)x][channel];
}

/* A field on the sheet, value by value: texels of one pixel, so that nothing lies between. */
static void formula_on_the_sheet(void)
{
    static const struct {
        int      octaves, tile;
        bool     turbulence;
        uint32_t seed;
    } rows[] = {{1, 0, false, 0}, {3, 0, false, 5}, {2, 100, false, 2}, {2, 0, true, 3}, {3, 90, true, 9}};
    shape wall = {0};
    shape_quad(&wall, "wall", 40, 0);
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        char settings[160];
        shot field;
        snprintf(settings, sizeof settings,
                 "\"lock\":\"screen\",\"scale\":%d,\"octaves\":%d,\"tile\":%d,\"field\":\"%s\"", SCALE, rows[r].octaves,
                 rows[r].tile, rows[r].turbulence ? "turbulence" : "noise");
        shot_view view = {
            .width = 160, .height = 160, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .seed = rows[r].seed};
        noise_field f = {rows[r].octaves, rows[r].turbulence, 0.69 * SCALE, 0, rows[r].seed * 2654435761u, 2.6};
        if (rows[r].tile) {
            f.period = (int)(rows[r].tile / f.side + 0.5);
            f.side = (double)rows[r].tile / f.period;
        }
        if (field_of(&field, &wall, settings, &view)) {
            double worst = 0;
            for (int y = RIM; y < field.height - RIM; y++)
                for (int x = RIM; x < field.width - RIM; x++) {
                    double wanted[3];
                    noise_in_plane(&f, x + 0.5, field.height - y - 0.5, wanted);
                    for (int c = 0; c < 3; c++)
                        worst = fmax(worst, fabs(at(&field, x, y, c) - wanted[c]));
                }
            check_at_most("S02", worst, 2e-3, "on the sheet, %d octaves, tile %d, %s: farthest from the formula",
                          rows[r].octaves, rows[r].tile, rows[r].turbulence ? "turbulence" : "noise");
        }
        shot_release(&field);
    }
    shape_release(&wall);
}

/* The same smoothing along a line as between texels of surfaces: a falling exponential. */
static void smooth(double *values, int width, int height, int step_x, int step_y, double *out)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0, weights = 0;
            for (int i = -8; i <= 8; i++) {
                int u = x + i * step_x, v = y + i * step_y;
                if (u < 0 || v < 0 || u >= width || v >= height)
                    continue;
                double weight = exp(-0.6 * abs(i));
                sum += weight * values[v * width + u];
                weights += weight;
            }
            out[y * width + x] = sum / weights;
        }
}

/* What surfaces say, smoothed, and their own say for a third; how far the drawing is from that, where the page's border
 * does not matter. */
static double farthest(const shot *field, double (*said)[3])
{
    const int width = field->width, height = field->height, amid = 12;
    double   *rough = check_alloc((size_t)(3 * width * height), sizeof *rough), *across = rough + width * height,
           *both = across + width * height, worst = 0;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < width * height; i++)
            rough[i] = said[i][c];
        smooth(rough, width, height, 1, 0, across);
        smooth(across, width, height, 0, 1, both);
        for (int y = amid; y < height - amid; y++)
            for (int x = amid; x < width - amid; x++)
                worst =
                    fmax(worst, fabs(at(field, x, y, c) - (0.5 * rough[y * width + x] + both[y * width + x]) / 1.5));
    }
    free(rough);
    return worst;
}

/* The only part's number counts, too. */
static uint32_t seed_of(uint32_t seed)
{
    return seed * 2654435761u + 0x632be59bu;
}

/* Fields in space, over a wall that is seen face on, whose positions are known; and by direction, over a ball that
 * fills the page. */
static void formula_on_surfaces(void)
{
    static const struct {
        int         octaves;
        bool        turbulence, on_ball;
        uint32_t    seed;
        double      distance;
        const char *by;
    } rows[] = {{1, false, false, 0, 8, "position"},   {3, false, false, 4, 8, "position"},
                {2, false, false, 1, 6.1, "position"}, {2, true, false, 6, 11, "position"},
                {1, false, true, 3, 8, "normal"},      {2, true, true, 0, 8, "normal"},
                {2, false, false, 2, 8, "curvature"},  {1, true, true, 5, 8, "curvature"}};
    double(*said)[3] = check_alloc(WIDE * SIDE, sizeof *said);
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        const double radius = 4, pixel = 2 * rows[r].distance * tan(15 * pi / 180) / SIDE;
        const char  *kind = rows[r].turbulence ? "turbulence" : "noise", *by = rows[r].by;
        char         settings[160];
        shot         field;
        shape        s = {0};
        snprintf(settings, sizeof settings,
                 "\"lock\":\"object\",\"scale\":%d,\"octaves\":%d,\"field\":\"%s\",\"by\":\"%s\"", SCALE,
                 rows[r].octaves, kind, by);
        shot_view   view = {.width = WIDE,
                            .height = SIDE,
                            .eye = {0, 0, rows[r].distance},
                            .up = {0, 1, 0},
                            .orthographic = true,
                            .seed = rows[r].seed};
        noise_field f = {rows[r].octaves, rows[r].turbulence, 1, 0, seed_of(rows[r].seed), 3.0};
        if (rows[r].on_ball)
            shape_sphere(&s, "ball", dvec_of(0, 0, 0), radius, 128, 256, true);
        else
            shape_quad(&s, "wall", 40, 0);
        for (int i = 0; i < WIDE * SIDE; i++) {
            double x = (i % WIDE + 0.5 - WIDE / 2) * pixel, y = (SIDE / 2 - 0.5 - i / WIDE) * pixel;
            /* Over two pixels, to the right and up, a ball's normal turns by two pixels of its radius each. */
            const double across[3] = {2 * x / radius, 2 * y / radius,
                                      2 * sqrt(1 - (x * x + y * y) / (radius * radius))},
                         bend[3] = {rows[r].on_ball ? 4 * 4 * pixel / radius : 0, 0.37, 0.61};
            if (by[0] == 'n' || by[0] == 'c')
                noise_in_space(&f, by[0] == 'n' ? across : bend, said[i]);
            else
                noise_along_ladder(&f, log2(0.69 * SCALE * pixel), (const double[]){x, y, 0}, said[i]);
        }
        if (field_of(&field, &s, settings, &view))
            check_at_most("S02", farthest(&field, said), 5e-3,
                          "by %s, %d octaves, from %g away, %s: farthest from the formula", by, rows[r].octaves,
                          rows[r].distance, kind);
        shot_release(&field);
        shape_release(&s);
    }
    free(said);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"sheet", formula_on_the_sheet}, {"surfaces", formula_on_surfaces}};
    int                     status = check_main(argc, argv, "sketch_noise", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
