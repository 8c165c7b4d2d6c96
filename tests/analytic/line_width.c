/* Profiles of slanted lines at one sample: how much of each pixel across the border of a turned square is ink, against
 * the area of a band of the line's width in the pixel, counted on a fine lattice; and all of its ink together. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 200, FINE = 40 };

static const double slopes[] = {0.05, 0.13, 0.31, 0.5, 0.77, 1}, widths[] = {0.5, 1, 1.6, 2, 3, 4.5, 6};

typedef struct page_point {
    double x, y;
} page_point;

static page_point on_page(const shot *s, dvec p)
{
    double at[2];
    shot_on_page(s, p, at);
    return (page_point){at[0], at[1]};
}

/* The area of a pixel within half a width of the line through a and b. */
static double band_in_pixel(page_point a, page_point b, int x, int y, double width)
{
    double dx = b.x - a.x, dy = b.y - a.y, size = hypot(dx, dy);
    int    inside = 0;
    for (int v = 0; v < FINE; v++)
        for (int u = 0; u < FINE; u++) {
            double px = x + (u + 0.5) / FINE - a.x, py = y + (v + 0.5) / FINE - a.y;
            inside += fabs(px * dy - py * dx) / size <= width / 2;
        }
    return (double)inside / (FINE * FINE);
}

typedef struct profile_error {
    double most, area, truth_area;
    int    pixels;
} profile_error;

/* Pixels beside one side of the square, away from its corners. */
static void compare_side(profile_error *e, const shot *s, page_point a, page_point b, double width)
{
    double dx = b.x - a.x, dy = b.y - a.y, size = hypot(dx, dy), away = 4 * width + 12;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double px = x + 0.5 - a.x, py = y + 0.5 - a.y, along = (px * dx + py * dy) / size;
            double across = (px * dy - py * dx) / size;
            if (along < away || along > size - away || fabs(across) > width / 2 + 3)
                continue;
            double truth = band_in_pixel(a, b, x, y, width);
            double ink = 1 - picture_shown(s->picture[4 * (y * s->width + x)]);
            e->most = fmax(e->most, fabs(ink - truth));
            e->area += ink;
            e->truth_area += truth;
            e->pixels++;
        }
}

/* The area of a pixel within half a width of a point. */
static double disc_in_pixel(page_point c, int x, int y, double width)
{
    int inside = 0;
    for (int v = 0; v < FINE; v++)
        for (int u = 0; u < FINE; u++)
            inside += hypot(x + (u + 0.5) / FINE - c.x, y + (v + 0.5) / FINE - c.y) <= width / 2;
    return (double)inside / (FINE * FINE);
}

/* Beyond the corner b, whose neighbours are a and c, lines end round: pixels on the rim of the disc about it, of all to
 * which nothing else is nearer. */
static void compare_corner(profile_error *e, const shot *s, page_point a, page_point b, page_point c, double width)
{
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double px = x + 0.5 - b.x, py = y + 0.5 - b.y, away = hypot(px, py);
            if (px * (a.x - b.x) + py * (a.y - b.y) > 0 || px * (c.x - b.x) + py * (c.y - b.y) > 0 ||
                fabs(away - width / 2) > 1.5)
                continue;
            double truth = disc_in_pixel(b, x, y, width), ink = 1 - picture_shown(s->picture[4 * (y * s->width + x)]);
            e->most = fmax(e->most, fabs(ink - truth));
            e->area += fabs(ink - truth);
            e->pixels++;
        }
}

/* The corners of turned squares. */
static void run_corners(void)
{
    const shot_view view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true};
    const double    half = 0.8, width = 12;
    char            lines[120];
    snprintf(lines, sizeof lines, "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":%g}", width);
    for (size_t i = 0; i < sizeof slopes / sizeof *slopes; i++) {
        const double  turn = atan(slopes[i]);
        shape         square = {0};
        shot          s = {0};
        profile_error e = {0};
        shape_quad(&square, "square", half, 0);
        shape_place(&square, (dvec){0, 0, 1}, turn * 180 / 3.14159265358979, (dvec){0.0123, 0.0077, 0});
        if (shot_of_shape(&s, &square, "corners.ply", shot_line_look(lines), NULL, &view)) {
            page_point corners[4];
            for (int k = 0; k < 4; k++) {
                double x = k == 0 || k == 3 ? -half : half, y = k < 2 ? -half : half;
                corners[k] = on_page(
                    &s, (dvec){0.0123 + x * cos(turn) - y * sin(turn), 0.0077 + x * sin(turn) + y * cos(turn), 0});
            }
            for (int k = 0; k < 4; k++)
                compare_corner(&e, &s, corners[(k + 3) % 4], corners[k], corners[(k + 1) % 4], width);
            check_at_least("line-corner", e.pixels, 40, "slope %g: pixels on the rims of the discs about the corners",
                           slopes[i]);
            check_at_most("line-corner", e.most, 0.05, "  ink against the area of the disc, worst");
        }
        shot_release(&s);
        shape_release(&square);
    }
}

static void profile_of(const shape *square, const char *file, double slope, double width, double limit)
{
    shot_view   view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true};
    char        lines[120];
    const char *row = "line-profile";
    snprintf(lines, sizeof lines, "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":%g}", width);
    shot          s;
    profile_error e = {0};
    if (shot_of_shape(&s, square, file, shot_line_look(lines), NULL, &view)) {
        const shape_part *p = &square->parts[0];
        for (uint32_t i = 0; i < p->vertex_count; i++)
            for (uint32_t k = i + 1; k < p->vertex_count; k++) {
                page_point a = on_page(&s, shape_point(p, i)), b = on_page(&s, shape_point(p, k));
                dvec       u = shape_point(p, i), v = shape_point(p, k);
                if (hypot(u.x - v.x, u.y - v.y) < 2.5 && hypot(a.x - b.x, a.y - b.y) > 10) /* no diagonal */
                    compare_side(&e, &s, a, b, width);
            }
        check_at_most(row, e.most, limit, "slope %g, width %g: ink against area, worst of %d pixels", slope, width,
                      e.pixels);
        check_near(row, e.area / e.truth_area, 1, 0.01, "slope %g, width %g: all ink", slope, width);
        shot_release(&s);
    }
}

static void run_profiles(void)
{
    for (size_t i = 0; i < sizeof slopes / sizeof *slopes; i++) {
        shape square = {0};
        char  file[40];
        shape_quad(&square, "square", 1, 0);
        shape_place(&square, (dvec){0, 0, 1}, atan(slopes[i]) * 180 / 3.14159265358979, (dvec){0.0123, 0.0077, 0});
        snprintf(file, sizeof file, "square-%zu.ply", i);
        for (size_t k = 0; k < sizeof widths / sizeof *widths; k++)
            profile_of(&square, file, slopes[i], widths[k], 0.02);
        shape_release(&square);
    }
}

/* Creases of a solid, which no record knows: one that runs up and one that runs to the right have as much ink, on both
 * sides. */
static void run_creases(void)
{
    const shot_view view = {
        .width = SIDE, .height = SIDE, .eye = {0.003, 0.002, 5}, .up = {0, 1, 0}, .orthographic = true};
    double ink[2][2] = {{0}};
    for (int level = 0; level < 2; level++) {
        shot        s = {0};
        const char *path = check_path("wedge.csg");
        FILE       *file = fopen(path, "w");
        if (!check_that("line-crease", file != NULL, "a solid is written"))
            return;
        const char *turn = level
                               ? "[[1,0,0,0.0021],[0,0.7071068,-0.7071068,0.0013],[0,0.7071068,0.7071068,0],[0,0,0,1]]"
                               : "[[0.7071068,0,0.7071068,0.0021],[0,1,0,0.0013],[-0.7071068,0,0.7071068,0],[0,0,0,1]]";
        fprintf(file, "multmatrix(%s) { cube(size=[1.2,1.2,1.2],center=true); }\n", turn);
        fclose(file);
        if (shot_take(&s, path, shot_line_look("{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":2}"),
                      NULL, &view)) {
            for (int side = 0; side < 2; side++) /* of the ridge, whose middle is that of the picture */
                for (int across = 0; across < 5; across++)
                    for (int along = SIDE / 2 - 20; along < SIDE / 2 + 20; along++) {
                        int at = side ? SIDE / 2 + across : SIDE / 2 - 1 - across, x = level ? along : at,
                            y = level ? at : along;
                        ink[level][side] += (1 - picture_shown(s.picture[4 * (y * SIDE + x)])) / 40;
                    }
            shot_release(&s);
        }
    }
    check_near("line-crease", ink[0][0] + ink[0][1], 2, 0.25,
               "a crease that runs up: its ink, pixels (left %.2f, right %.2f)", ink[0][0], ink[0][1]);
    check_near("line-crease", ink[1][0] + ink[1][1], ink[0][0] + ink[0][1], 0.03,
               "  one that runs to the right (above %.2f, below %.2f)", ink[1][0], ink[1][1]);
}

/* Broad lines of a solid, of which pixels alone are known, end alike on all sides: a picture of what is turned by a
 * quarter is the picture, turned. */
static void run_turned(void)
{
    enum { SIDE = 200 };
    static const dvec ups[] = {{0, 1, 0}, {1, 0, 0}, {0, -1, 0}, {-1, 0, 0}};
    const char       *path = check_path("square.csg");
    FILE             *file = fopen(path, "w");
    shot              first;
    if (!check_that("E21", file != NULL, "a file can be written"))
        return;
    fputs("multmatrix([[0.9563, -0.2924, 0, 0.1], [0.2924, 0.9563, 0, 0.2], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(size = "
          "[2.2, 1.6, 1], center = true); }\n",
          file);
    fclose(file);
    for (int k = 0; k < 4; k++) {
        const shot_view   view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 8}, .up = ups[k], .orthographic = true};
        const char *const changes[] = {"lines.width", "12px", "lines.colour", "#000000", "lines.cover", "1", NULL};
        shot              drawing;
        const bool        drawn =
            shot_take(&drawing, path, shot_line_look("{\"operator\":\"discontinuity\"}"), changes, &view);
        double apart = 0, ink = 0;
        for (int y = 0; y < SIDE && drawn && k; y++)
            for (int x = 0; x < SIDE; x++) {
                const int turned[4][2] = {{x, y}, {y, SIDE - 1 - x}, {SIDE - 1 - x, SIDE - 1 - y}, {SIDE - 1 - y, x}};
                const int own = shot_ink(&drawing, turned[k][0], turned[k][1]), other = shot_ink(&first, x, y);
                apart += abs(own - other);
                ink += 255 - other;
            }
        if (k) {
            check_at_most("E21", apart / fmax(ink, 1), 0.0012,
                          "a solid square, turned by %d quarters: ink that is elsewhere", k);
            shot_release(&drawing);
        } else {
            first = drawing;
        }
    }
    shot_release(&first);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"profiles", run_profiles}, {"corners", run_corners}, {"creases", run_creases}, {"turned", run_turned}};
    int status = check_main(argc, argv, "line_width", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
