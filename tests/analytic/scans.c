/* Outlines of scans: drawings of noisy samplings of a surface against the outlines of the surface itself, taken from a
 * depth map three times as fine. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "outline_truth.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 768, FINER = 3 };

static double hashed(uint32_t n)
{
    n = (n ^ n >> 16) * 0x7FEB352Du;
    n = (n ^ n >> 15) * 0x846CA68Bu;
    return (n ^ n >> 16) / 4294967296.0;
}

/* A lumpy ring, sampled at uneven positions, and off by so many mean edges. */
static void make_ring(shape *s, double noise)
{
    enum { AROUND = 260, ACROSS = 110 };
    const double pi = 3.14159265358979323846, edge = 0.021;
    shape_part  *p = shape_add(s, "ring", AROUND * ACROSS, AROUND * ACROSS * 6, false, false);
    uint32_t     at = 0;
    for (uint32_t i = 0; i < AROUND * ACROSS; i++) {
        double u = 2 * pi * (i / ACROSS + 0.5 * (hashed(7 * i) - 0.5)) / AROUND,
               v = 2 * pi * (i % ACROSS + 0.5 * (hashed(7 * i + 1) - 0.5)) / ACROSS;
        double minor = 0.36 + 0.05 * sin(5 * u) * cos(2 * v) +
                       noise * edge * (hashed(7 * i + 2) + hashed(7 * i + 3) - 1) * 2.4,
               out = 0.9 + minor * cos(v);
        p->positions[i][0] = (float)(out * cos(u));
        p->positions[i][1] = (float)(minor * sin(v));
        p->positions[i][2] = (float)(out * sin(u));
    }
    for (uint32_t a = 0; a < AROUND; a++)
        for (uint32_t c = 0; c < ACROSS; c++) {
            uint32_t       b = (a + 1) % AROUND, d = (c + 1) % ACROSS;
            const uint32_t corners[6] = {a * ACROSS + c, a * ACROSS + d, b * ACROSS + d,
                                         a * ACROSS + c, b * ACROSS + d, b * ACROSS + c};
            for (int k = 0; k < 6; k++)
                p->indices[at++] = corners[k];
        }
}

static void measure(double noise, const char *contours, const float *depth, const shot_view *view)
{
    shape         s = {0};
    shot          drawn;
    outline_score score;
    /* Outlines alone: suggestive contours, which the look has besides, are none. */
    const char *const changes[] = {"lines.contours", contours, "lines.creases", "false", "lines.suggestive", "0", NULL};
    make_ring(&s, noise);
    if (shot_of_shape(&drawn, &s, "scan.ply", "line", changes, view)) {
        outline_measure(&score, drawn.picture, SIDE, SIDE, depth, FINER);
        double stray = score.ink ? 100.0 * (double)score.stray / (double)score.ink : 100;
        check_at_least("LX-02", 100 * score.covered / score.length, 98, "%% of outlines inked, noise %.2f, %s", noise,
                       contours);
        check_at_most("LX-02", score.longest_gap, 4, "longest gap, noise %.2f, %s, at %.0f, %.0f", noise, contours,
                      score.gap_at[0], score.gap_at[1]);
        check_at_most("LX-02", stray, 0.5, "%% of ink that is no outline, noise %.2f, %s, at %.0f, %.0f", noise,
                      contours, score.stray_at[0], score.stray_at[1]);
        shot_release(&drawn);
    }
    shape_release(&s);
}

static void outlines_of_scans_are_whole(void)
{
    static const dvec eyes[] = {{3, 2.2, 3.2}, {5.4, 1.6, 1.2}, {0.5, 5.6, 2}};
    for (int i = 0; i < 3; i++) {
        shot_view view = {.width = SIDE, .height = SIDE, .eye = eyes[i], .up = {0, 1, 0}, .without_maps = true};
        shot_view fine = view;
        shape     s = {0};
        shot      truth;
        fine.width = fine.height = SIDE * FINER;
        fine.without_maps = false;
        make_ring(&s, 0);
        if (shot_of_shape(&truth, &s, "surface.ply", "line", NULL, &fine)) {
            for (int k = 0; k < 4; k++)
                for (int smooth = 0; smooth < 2; smooth++)
                    measure(0.05 * k, smooth ? "smooth" : "edges", truth.depth, &view);
            shot_release(&truth);
        }
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"outlines_of_scans_are_whole", outlines_of_scans_are_whole}};
    int                     failed = check_main(argc, argv, "scans", cases, 1);
    shot_end();
    return failed;
}
