/* Lines as of a construction: hidden ones as faint as was asked for, and drawn ones that run on by the length that
 * was asked for. Row P35. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

#define LINES "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"faint\":20,\"crease\":30}"
#define HIDDEN_LOOK                                                                                                    \
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\",\"surface\":{"     \
    "\"technique\":"                                                                                                   \
    "\"flat\",\"colour\":\"#ffffff\"},\"lines\":" LINES ",\"layers\":{\"technique\":\"peel\",\"count\":0},"            \
    "\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0}}]}"

static const shot_view box_view = {
    .width = 640, .height = 600, .eye = {5, 3.4, 6.3}, .up = {0.1, 1, 0}, .without_maps = true};
static const double low[3] = {-1.4, -1, -1.2}, high[3] = {1.2, 1.1, 1.3};

/* Corners by bits: x, y, z high. The first nine edges are seen, the last three hidden. */
enum { EDGES = 12, SEEN = 9 };
static const int edges[EDGES][2] = {{4, 5}, {5, 1}, {1, 3}, {3, 2}, {2, 6}, {6, 4},
                                    {6, 7}, {7, 5}, {7, 3}, {0, 1}, {0, 2}, {0, 4}};

static dvec corner_at(const shot *s, int i)
{
    return shot_project(s, dvec_of((i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]));
}

static double darkness(const shot *s, double x, double y)
{
    int column = (int)floor(x), row = (int)floor(y);
    return column < 0 || row < 0 || column >= s->width || row >= s->height
               ? 0
               : 1 - picture_shown(s->picture[4 * (row * s->width + column)]);
}

/* Ink along an edge in square pixels, from one fraction of it to another, within three pixels of it. */
static double ink_along(const shot *s, dvec a, dvec b, double from, double to)
{
    double       length = hypot(b.x - a.x, b.y - a.y), ux = (b.x - a.x) / length, uy = (b.y - a.y) / length, ink = 0;
    const double step = 0.25;
    for (double along = from; along < to; along += step)
        for (double across = -3; across <= 3; across += step)
            ink += step * step * darkness(s, a.x + along * ux - across * uy, a.y + along * uy + across * ux);
    return ink;
}

/* Away from corners, where other edges are near. */
static double ink_of_edges(const shot *s, int first, int count)
{
    double ink = 0;
    for (int e = first; e < first + count; e++) {
        dvec   a = corner_at(s, edges[e][0]), b = corner_at(s, edges[e][1]);
        double length = hypot(b.x - a.x, b.y - a.y);
        ink += ink_along(s, a, b, 0.15 * length, 0.85 * length);
    }
    return ink;
}

static double length_of_edges(const shot *s, int first, int count)
{
    double length = 0;
    for (int e = first; e < first + count; e++) {
        dvec a = corner_at(s, edges[e][0]), b = corner_at(s, edges[e][1]);
        length += 0.7 * hypot(b.x - a.x, b.y - a.y);
    }
    return length;
}

/* All edges are drawn alike, so that ink goes with length; hidden ones have the fraction of it that their opacity is.
 */
static void hidden_ink(void)
{
    static const char *const opacities[] = {"0", "0.1", "0.3", "0.6", "1"};
    for (int parallel = 0; parallel < 2; parallel++) {
        double crossed = 0; /* ink of visible edges that cross the hidden ones */
        for (int o = 0; o < 5; o++) {
            const char *changes[] = {"compose.hidden_opacity", opacities[o], NULL};
            shot_view   view = box_view;
            shape       s = {0};
            shot        drawing;
            view.orthographic = parallel;
            shape_box(&s, "box", dvec_of(low[0], low[1], low[2]), dvec_of(high[0], high[1], high[2]));
            if (shot_of_shape(&drawing, &s, "construction.glb", HIDDEN_LOOK, changes, &view)) {
                double opacity = atof(opacities[o]), seen = ink_of_edges(&drawing, 0, SEEN),
                       hidden = ink_of_edges(&drawing, SEEN, EDGES - SEEN);
                crossed = o == 0 ? hidden : crossed;
                hidden -= crossed;
                double seen_length = length_of_edges(&drawing, 0, SEEN),
                       hidden_length = length_of_edges(&drawing, SEEN, EDGES - SEEN);
                double wanted = opacity * hidden_length / (seen_length + opacity * hidden_length);
                check_near("P35", hidden / (seen + hidden), wanted, 0.01,
                           "hidden fraction of all ink at opacity %s, %s", opacities[o],
                           parallel ? "parallel" : "perspective");
                check_near("P35", hidden / (hidden_length * seen / seen_length - crossed), opacity, 0.02,
                           "  a hidden edge's ink to a visible one's, by length, between crossings");
            }
            shot_release(&drawing);
            shape_release(&s);
        }
    }
}

/* How far ink goes on beyond b on the line from a. */
static double run_of(const shot *s, dvec a, dvec b)
{
    double length = hypot(b.x - a.x, b.y - a.y), along = 3;
    for (; along < 64 && ink_along(s, a, b, length + along, length + along + 0.5) > 0.05; along += 0.25)
        ;
    return along;
}

static void overdrawn(void)
{
    static const char *const lengths[] = {"0", "10px", "16px", "24px", "32px"};
    for (int i = 0; i < 5; i++) {
        const char *changes[] = {"lines.overshoot", lengths[i], NULL};
        shape       s = {0};
        shot        drawing;
        double      length = atof(lengths[i]), mean = 0;
        shape_box(&s, "box", dvec_of(low[0], low[1], low[2]), dvec_of(high[0], high[1], high[2]));
        if (shot_of_shape(&drawing, &s, "construction.glb", shot_line_look(LINES), changes, &box_view)) {
            for (int e = 0; e < SEEN; e++)
                for (int side = 0; side < 2; side++)
                    mean +=
                        run_of(&drawing, corner_at(&drawing, edges[e][!side]), corner_at(&drawing, edges[e][side])) /
                        (2 * SEEN);
            if (i == 0)
                check_at_most("P35", mean, 4.5, "px that edges run on without, where others meet them");
            else
                check_near("P35", mean, length, 0.15 * length + 1, "px that edges run on, of %s, on average",
                           lengths[i]);
        }
        shot_release(&drawing);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"hidden", hidden_ink}, {"overdrawn", overdrawn}};
    int                     status = check_main(argc, argv, "construction", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
