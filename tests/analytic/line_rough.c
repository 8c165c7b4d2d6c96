/* Lines found in pixels are as even as what they are lines of. Truth: what a surface hides has no line on it, however
 * little beside the rim it lies; and a step lower than a pixel has the same ink all along its crease. */
#include <math.h>
#include <stdio.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 320 };

static const double width = 1.5;

static double ink_of(const shot *s, int x, int y)
{
    bool within = x >= 0 && y >= 0 && x < s->width && y < s->height;
    return within ? 1 - picture_shown(s->picture[4 * (y * s->width + x)]) : 0;
}

static bool draw(shot *s, const shape *model, dvec eye, dvec target, double faint, double crease)
{
    shot_view view = {
        .width = SIDE, .height = SIDE, .eye = eye, .target = target, .up = {0, 1, 0}, .orthographic = true};
    char lines[160];
    snprintf(
        lines, sizeof lines,
        "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":%g,\"cover\":1,\"faint\":%g,\"crease\":%g}",
        width, faint, crease);
    return shot_of_shape(s, model, "rough.glb", shot_line_look(lines), NULL, &view);
}

/* Signed distance of a pixel's middle from the line through a and b, and how far along it lies, 0 … 1. */
static double distance_from(const double a[2], const double b[2], int x, int y, double *along)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], size = hypot(dx, dy), px = x + 0.5 - a[0], py = y + 0.5 - a[1];
    *along = (px * dx + py * dy) / (size * size);
    return (dx * py - dy * px) / size;
}

/* The darkest pixel of the floor from 2 to 6 pixels in front of the line where the block stands on it. */
static double ink_before(const shot *s, const double a[2], const double b[2], const double before[2])
{
    double along, most = 0, side = distance_from(a, b, (int)before[0], (int)before[1], &along);
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double d = distance_from(a, b, x, y, &along) * (side < 0 ? -1 : 1);
            if (d > 2.25 && d < 6 && along > 0.15 && along < 0.85)
                most = fmax(most, ink_of(s, x, y));
        }
    return most;
}

/* A block that is sunk in the floor: its lower edge is hidden, a little beneath the line where the two meet. */
static void run_beneath(void)
{
    for (double under = 0.004; under < 0.03; under += 0.002) {
        shape sunk = {0};
        shot  s;
        shape_box(&sunk, "floor", (dvec){-1, -0.2, -1}, (dvec){1, 0, 1});
        shape_box(&sunk, "block", (dvec){-0.6, -under, -0.6}, (dvec){0.6, 0.3, 0.4});
        if (draw(&s, &sunk, (dvec){2.2, 2, 3.4}, (dvec){0, 0, 0}, 38, 44)) {
            double a[2], b[2], before[2];
            shot_on_page(&s, (dvec){-0.6, 0, 0.4}, a);
            shot_on_page(&s, (dvec){0.6, 0, 0.4}, b);
            shot_on_page(&s, (dvec){0, 0, 0.8}, before);
            check_at_most("rough", ink_before(&s, a, b, before), 0.05,
                          "edge %.3g beneath a floor: most ink on the floor", under);
            shot_release(&s);
        }
        shape_release(&sunk);
    }
}

/* Courses of tiles whose lower edges are faces narrower than a pixel, of the angle where lines fade in: what sixteen
 * samples a pixel show is the truth. */
static void run_courses(void)
{
    static const double nave_axis = 18.1;
    dvec                target = {-17.3, 23, -nave_axis};
    shot_view           view = {.width = 160,
                                .height = 160,
                                .eye = {target.x + 70, target.y + 57, target.z + 70},
                                .target = target,
                                .up = {0, 1, 0},
                                .fov_deg = 4.8};
    const char         *look = shot_line_look("{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"cover\":1}");
    shot                one, many;
    if (!shot_take(&one, LIMNER_EXAMPLES "/cloister.glb", look, NULL, &view))
        return;
    view.samples = 16;
    if (shot_take(&many, LIMNER_EXAMPLES "/cloister.glb", look, NULL, &view)) {
        double differing = 0, ink = 0;
        for (int y = 0; y < one.height; y++)
            for (int x = 0; x < one.width; x++) {
                differing += fabs(ink_of(&one, x, y) - ink_of(&many, x, y)) > 0.25 ? 1 : 0;
                ink += ink_of(&many, x, y);
            }
        check_at_most("rough", differing / ink, 0.1, "tiles: pixels that differ from sixteen samples, of those inked");
        shot_release(&many);
    }
    shot_release(&one);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"beneath", run_beneath}, {"courses", run_courses}};
    int                     status = check_main(argc, argv, "line_rough", cases, 2);
    shot_end();
    return status;
}
