/* Lines that crowd: how much of the page parallel lines ink, by how far apart they are. Truth: lines that have room are
 * as wide as asked and ink width / distance; those that crowd ink the fraction `cover` and no more, and are still
 * there. Lines found in pixels and strokes have the same law; with cover 1 there is none. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 320, SHEETS = 24 };

static const double cover = 0.3, turned = 26;

/* Sheets one behind the other, each reaching out from under the one before: as many parallel lines. */
static void shape_stack(shape *out, double step)
{
    for (int i = 0; i < SHEETS; i++) {
        char name[16];
        snprintf(name, sizeof name, "sheet-%d", i);
        shape_quad(out, name, 1, 0);
        double angle = turned * 3.14159265358979 / 180, along = 1 - (i - SHEETS / 2) * step; /* borders in the middle */
        shape_place(out, (dvec){0, 0, 1}, turned, (dvec){along * cos(angle), along * sin(angle), -0.03 * (double)i});
    }
}

static double ink_at(const shot *s, double x, double y)
{
    int column = (int)floor(x), row = (int)floor(y);
    return column < 0 || row < 0 || column >= s->width || row >= s->height
               ? 0
               : 1 - picture_shown(s->picture[4 * (row * s->width + column)]);
}

/* Ink between the middles of two sheets' left borders, and how far apart lines are there, pixels. */
static double ink_between(const shot *s, const shape *stack, int from, int to, double *apart)
{
    double ends[2][2], ink = 0;
    int    count = 0, numbers[2] = {from, to};
    for (int k = 0; k < 2; k++) {
        const shape_part *p = &stack->parts[numbers[k]];
        dvec              low = shape_point(p, 0), high = shape_point(p, 3);
        shot_on_page(s, (dvec){(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2}, ends[k]);
    }
    double dx = ends[1][0] - ends[0][0], dy = ends[1][1] - ends[0][1], size = hypot(dx, dy);
    *apart = size / (to - from);
    for (double t = 0.5 * *apart; t < size - 0.5 * *apart; t += 0.25) /* whole distances: a strip along the lines */
        for (double u = -20; u < 20; u += 0.5, count++)
            ink += ink_at(s, ends[0][0] + (t * dx - u * dy) / size, ends[0][1] + (t * dy + u * dx) / size);
    return ink / count;
}

static void compare(const char *operator, double step, double width, double share)
{
    shape     stack = {0};
    shot_view view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true};
    char      lines[160];
    snprintf(lines, sizeof lines, "{\"operator\":\"%s\",\"colour\":\"#000000\",\"width\":%g,\"cover\":%g%s}", operator,
             width, share, strcmp(operator, "strokes") == 0 ? ",\"detail\":1,\"visibility\":\"exact\"" : "");
    shape_stack(&stack, step);
    shot s;
    if (shot_of_shape(&s, &stack, "stack.glb", shot_line_look(lines), NULL, &view)) {
        double apart, ink = ink_between(&s, &stack, 6, SHEETS - 6, &apart), alone = fmin(width / apart, 1);
        check_near("crowd", ink, alone > share ? share : alone, 0.035,
                   "%s: lines %.2g wide and %.3g apart, cover %g: ink", operator, width, apart, share);
        shot_release(&s);
    }
    shape_release(&stack);
}

static void run_crowds(void)
{
    static const double steps[] = {0.16, 0.11, 0.05, 0.03}, widths[] = {1.5, 3};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
            compare("discontinuity", steps[i], widths[k], cover);
            compare("strokes", steps[i], widths[k], cover);
        }
    compare("discontinuity", 0.05, 3, 1);
    compare("strokes", 0.05, 3, 1);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"crowds", run_crowds}};
    int                     status = check_main(argc, argv, "crowded_lines", cases, 1);
    shot_end();
    return status;
}
