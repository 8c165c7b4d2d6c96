/* Colour that a broad pen lays: where paper shows between its strokes, and what it leaves out. */
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "shape.h"
#include "shot.h"
#include "surface_look.h"

/* A broad pen's strokes over a wall: in full light some of the paper shows between them, without any light hardly, and
 * the page changes across them and not along. */
static void broad_strokes_leave_paper(void)
{
    for (int dark = 0; dark < 2; dark++) {
        shape  s = {0};
        shot   wall;
        double paper = 0, along = 0, across = 0;
        shape_quad(&s, "wall", 20, 0);
        s.parts[0].colour[0] = 0.1f;
        const char *look =
            surface_look("{\"technique\":\"lines\",\"shadow\":1,\"light\":4,\"paper_tint\":1,\"paper_light\":0,"
                         "\"paper_strokes\":\"10px\"}",
                         dark ? "0,0,-1" : "0,0,1", 0);
        if (shot_of_shape(&wall, &s, "pen.glb", look, NULL, &front))
            for (int y = 8; y < 248; y++)
                for (int x = 8; x < 248; x++) {
                    int here = wall.picture[4 * (y * 256 + x)];
                    paper += here > 250;
                    along += abs(here - wall.picture[4 * ((y - 3) * 256 + x + 4)]); /* 37 degrees; rows run downwards */
                    across += abs(here - wall.picture[4 * ((y + 4) * 256 + x + 3)]);
                }
        check_near("pen", paper / (240 * 240), dark ? 0.01 : 0.25, dark ? 0.01 : 0.15, "share of paper %s",
                   dark ? "in the dark" : "in full light");
        check_at_most("pen", along / across, 0.5, "  changes along strokes beside those across");
        shot_release(&wall);
        shape_release(&s);
    }
}

/* Light grey has no colour to lay: in full light it is paper, in the dark it is laid over as all else is. */
static void broad_strokes_leave_grey(void)
{
    for (int dark = 0; dark < 2; dark++) {
        shape  s = {0};
        shot   wall;
        double laid = 0;
        shape_quad(&s, "wall", 20, 0);
        for (int k = 0; k < 3; k++)
            s.parts[0].colour[k] = 0.5f;
        const char *look =
            surface_look("{\"technique\":\"lines\",\"shadow\":1,\"light\":4,\"paper_tint\":1,\"paper_light\":0,"
                         "\"paper_strokes\":\"10px\"}",
                         dark ? "0,0,-1" : "0,0,1", 0);
        if (shot_of_shape(&wall, &s, "grey.glb", look, NULL, &front))
            for (int y = 8; y < 248; y++)
                for (int x = 8; x < 248; x++)
                    laid += wall.picture[4 * (y * 256 + x)] < 250;
        check_near("pen", laid / (240 * 240), dark, 0.02, "share of light grey that is laid over %s",
                   dark ? "in the dark" : "in full light");
        shot_release(&wall);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"broad-pen", broad_strokes_leave_paper},
        {"broad-grey", broad_strokes_leave_grey},
    };
    int status = check_main(argc, argv, "broad_pen", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
