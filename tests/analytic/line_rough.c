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

/* Ink across the line from a to b, of as many pixels as it is wide, at a position along it: the mean of three pixels.
 */
static double ink_across(const shot *s, const double a[2], const double b[2], double at)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], size = hypot(dx, dy), ink = 0;
    for (int i = -6; i <= 6; i++)
        for (int k = -24; k <= 24; k++) {
            double along = at + 0.25 * i, across = 0.25 * k;
            double x = a[0] + (along * dx - across * dy) / size, y = a[1] + (along * dy + across * dx) / size;
            ink += ink_of(s, (int)floor(x), (int)floor(y)) * 0.25 / 13;
        }
    return ink;
}

/* The least and the most ink along the line from a to b, in pixels across it. */
static void ink_along(const shot *s, dvec begin, dvec end, double *least, double *most)
{
    double a[2], b[2];
    shot_on_page(s, begin, a);
    shot_on_page(s, end, b);
    double size = hypot(b[0] - a[0], b[1] - a[1]);
    *most = 0;
    *least = 1e9;
    for (double at = 24; at < size - 24; at += 0.5) {
        double ink = ink_across(s, a, b, at);
        *most = fmax(*most, ink);
        *least = fmin(*least, ink);
    }
}

/* How much ink changes along the line from a to b, in pixels across it. */
static double change_along(const shot *s, dvec begin, dvec end)
{
    double least, most;
    ink_along(s, begin, end, &least, &most);
    return most - least;
}

/* The change along the line from begin to end, seen from four sides and from so high: the most there has been. */
static double most_change(double most, const shape *model, dvec begin, dvec end, double high)
{
    for (int turn = 0; turn < 4; turn++) {
        shot s;
        if (draw(&s, model, (dvec){2.2 + 0.4 * turn, high, 3.4 - 0.7 * turn}, (dvec){0, 0, 0}, 38, 44)) {
            most = fmax(most, change_along(&s, begin, end));
            shot_release(&s);
        }
    }
    return most;
}

/* A slab of another part on the floor, from a tenth of a pixel to four pixels high; and one sunk in it, up to a pixel
 * high, whose lower edge is hidden, seen from where depth steps by more than the floor's slope explains. */
static void run_kerbs(void)
{
    double most = 0;
    for (int sunk = 0; sunk < 2; sunk++)
        for (double height = 0.001; height < (sunk ? 0.01 : 0.04); height *= 1.6) {
            shape slab = {0};
            shape_box(&slab, "floor", (dvec){-1, -0.2, -1}, (dvec){1, 0, 1});
            shape_box(&slab, "slab", (dvec){-0.6, sunk ? -0.05 : 0, -0.6}, (dvec){0.6, height, 0.4});
            most = most_change(most, &slab, (dvec){-0.6, 0.5 * height, 0.4}, (dvec){0.6, 0.5 * height, 0.4},
                               sunk ? 3.2 : 2);
            shape_release(&slab);
        }
    check_at_most("rough", most, 0.25, "kerbs: change of ink along them, pixels");
}

/* A lid on a box that it reaches over by a fraction of a pixel: the box's own edge is hidden beneath its rim. */
static void run_rims(void)
{
    double most = 0;
    for (double over = 0.0005; over < 0.02; over *= 1.6) {
        shape closed = {0};
        shape_box(&closed, "box", (dvec){-0.6, -0.6, -0.6}, (dvec){0.6, 0, 0.4 - over});
        shape_box(&closed, "lid", (dvec){-0.6, 0.001, -0.6}, (dvec){0.6, 0.3, 0.4});
        most = most_change(most, &closed, (dvec){-0.6, 0, 0.4}, (dvec){0.6, 0, 0.4}, 2);
        shape_release(&closed);
    }
    check_at_most("rough", most, 0.25, "rims: change of ink along them, pixels");
}

enum { AROUND = 16 };

static void add_pipe(shape *s, double radius)
{
    shape_part *p = shape_add(s, "pipe", 2 * (AROUND + 1), 6 * AROUND, true, false);
    for (uint32_t i = 0; i <= AROUND; i++)
        for (uint32_t end = 0; end < 2; end++) {
            double angle = 2 * 3.14159265358979 * (i % AROUND) / AROUND;
            float *at = p->positions[2 * i + end], *normal = p->normals[2 * i + end];
            normal[1] = (float)cos(angle);
            normal[2] = (float)sin(angle);
            at[0] = end ? 0.9F : -0.9F;
            at[1] = (float)(radius * cos(angle));
            at[2] = (float)(radius * sin(angle));
        }
    for (uint32_t i = 0; i < AROUND; i++) {
        const uint32_t corners[6] = {2 * i, 2 * i + 1, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 2};
        for (uint32_t k = 0; k < 6; k++)
            p->indices[6 * i + k] = corners[k];
    }
}

/* The outline of a pipe, whose last face before it is about a pixel wide. */
static void run_pipes(void)
{
    double most = 0;
    for (double radius = 0.1; radius < 0.4; radius *= 1.25) {
        shape pipe = {0};
        shot  s;
        add_pipe(&pipe, radius);
        if (draw(&s, &pipe, (dvec){2.2, 2, 3.4}, (dvec){0, 0, 0}, 38, 44)) {
            double a[2], b[2], highest = 0;
            dvec   top = {0, 0, 0};
            for (uint32_t i = 0; i < AROUND; i++) {
                dvec at = {0, pipe.parts[0].positions[2 * i][1], pipe.parts[0].positions[2 * i][2]};
                shot_on_page(&s, at, a);
                shot_on_page(&s, (dvec){0, 0, 0}, b);
                if (b[1] - a[1] > highest) {
                    highest = b[1] - a[1];
                    top = at;
                }
            }
            most = fmax(most, change_along(&s, (dvec){-0.9, top.y, top.z}, (dvec){0.9, top.y, top.z}));
            shot_release(&s);
        }
        shape_release(&pipe);
    }
    check_at_most("rough", most, 0.25, "pipes: change of ink along their outline, pixels");
}

/* A chamfer of a mesh is a line, also where it turns by less than facets in pixels may; what turns by half of that is
 * none. */
static void run_chamfers(void)
{
    static const double angles[2] = {34, 18};
    for (int flat = 0; flat < 2; flat++) {
        shape wedge = {0};
        shot  s;
        shape_wedge(&wedge, "wedge", angles[flat]);
        if (draw(&s, &wedge, (dvec){0.8, 0.4, 2}, (dvec){0, 0, 0}, 38, 44)) {
            double least, most;
            ink_along(&s, (dvec){0, -0.5, 0}, (dvec){0, 0.5, 0}, &least, &most);
            if (flat)
                check_at_most("rough", most, 0.01, "what turns by 18 degrees: ink along it");
            else
                check_at_least("rough", least, 0.9 * width, "chamfer of 34 degrees: ink along it");
            shot_release(&s);
        }
        shape_release(&wedge);
    }
}

/* Creases may be finer than outlines: of a box, the ink along an edge between two faces that are seen, and along one
 * before nothing. */
static void run_classes(void)
{
    static const double share = 0.5, rim = 0.6;
    shape               box = {0};
    shot                s;
    shot_view view = {.width = SIDE, .height = SIDE, .eye = {2.2, 2, 3.4}, .up = {0, 1, 0}, .orthographic = true};
    char      lines[160];
    snprintf(lines, sizeof lines,
             "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":%g,\"cover\":1,\"crease_width\":%g}",
             2 * width, share);
    shape_box(&box, "box", (dvec){-rim, -rim, -rim}, (dvec){rim, rim, rim});
    if (shot_of_shape(&s, &box, "classes.glb", shot_line_look(lines), NULL, &view)) {
        double least, most;
        ink_along(&s, (dvec){rim, -rim, rim}, (dvec){rim, rim, rim}, &least, &most);
        check_near("rough", least, share * 2 * width, 0.1, "crease of half the width: least ink along it");
        check_near("rough", most, share * 2 * width, 0.1, "crease of half the width: most ink along it");
        ink_along(&s, (dvec){-rim, rim, -rim}, (dvec){rim, rim, -rim}, &least, &most);
        check_near("rough", least, 2 * width, 0.1, "outline beside it: least ink along it");
        shot_release(&s);
    }
    shape_release(&box);
}

enum { STEPS = 4 }; /* of a quarter of a turn */

/* Two walls at right angles, 4 high and 2 wide, and a rounding between them; and a third wall beyond a sharp edge. */
static void add_rounded_corner(shape *s, double radius)
{
    enum { COLUMNS = STEPS + 4 };
    shape_part *p = shape_add(s, "corner", 2 * COLUMNS, 6 * (COLUMNS - 1), false, false);
    for (int i = 0; i < COLUMNS; i++) {
        double angle = 3.14159265358979 / 2 * (STEPS + 1 - i) / STEPS, x = radius * (cos(angle) - 1),
               z = radius * (sin(angle) - 1);
        x = i == 0 ? -2 : x;
        z = i == 0 ? 0 : i > STEPS + 1 ? -2 : z;
        x = i == STEPS + 2 ? 0 : i == STEPS + 3 ? -2 : x;
        for (int top = 0; top < 2; top++) {
            float *at = p->positions[2 * i + top];
            at[0] = (float)x;
            at[1] = top ? 2 : -2;
            at[2] = (float)z;
        }
    }
    for (uint32_t i = 0; i + 1 < COLUMNS; i++) {
        const uint32_t corners[6] = {2 * i, 2 * i + 2, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 1};
        for (uint32_t k = 0; k < 6; k++)
            p->indices[6 * i + k] = corners[k];
    }
}

/* A narrow rounding is one line, in its middle, though none of its steps turns as far as a crease; here it is a dozen
 * pixels wide, so that nothing but the mesh tells. */
static void run_roundings(void)
{
    static const double radius = 0.024, share = 0.70710678;
    shape               rounded = {0};
    shot                s;
    add_rounded_corner(&rounded, radius);
    dvec middle = {radius * (share - 1), 0, radius * (share - 1)};
    if (draw(&s, &rounded, (dvec){1.1, 0.3, 1}, middle, 38, 44)) {
        double least, most;
        ink_along(&s, (dvec){middle.x, -0.3, middle.z}, (dvec){middle.x, 0.3, middle.z}, &least, &most);
        check_at_least("rough", least, 0.9 * width, "narrow rounding: least ink along it");
        check_at_most("rough", most, 1.1 * width, "narrow rounding: most ink along it");
        shot_release(&s);
    }
    shape_release(&rounded);
}

/* The rim of a disc of sixteen corners is the circle that it stands for, where lines may leave the mesh so far; in the
 * middle of its sides the mesh is far inside. */
static void run_circles(void)
{
    shape       disc = {0};
    shot        s;
    shot_view   view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 5}, .up = {0, 1, 0}, .orthographic = true};
    shape_part *p = shape_add(&disc, "disc", AROUND + 1, 3 * AROUND, false, false);
    for (uint32_t i = 0; i < AROUND; i++) {
        double angle = 2 * 3.14159265358979 * i / AROUND;
        p->positions[i + 1][0] = (float)cos(angle);
        p->positions[i + 1][1] = (float)sin(angle);
        p->indices[3 * i + 1] = i + 1;
        p->indices[3 * i + 2] = (i + 1) % AROUND + 1;
    }
    const char *look =
        shot_line_look("{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":2,\"cover\":1,\"round\":4}");
    if (shot_of_shape(&s, &disc, "disc.glb", look, NULL, &view)) {
        double middle[2], corner[2], worst = 0;
        shot_on_page(&s, (dvec){0, 0, 0}, middle);
        shot_on_page(&s, (dvec){1, 0, 0}, corner);
        double radius = hypot(corner[0] - middle[0], corner[1] - middle[1]);
        for (int i = 0; i < AROUND; i++) {
            double angle = 2 * 3.14159265358979 * (i + 0.5) / AROUND, ink = 0, moment = 0;
            for (double at = radius - 8; at < radius + 6; at += 0.05) {
                double here =
                    ink_of(&s, (int)floor(middle[0] + at * cos(angle)), (int)floor(middle[1] + at * sin(angle)));
                ink += here;
                moment += here * at;
            }
            worst = fmax(worst, ink > 0 ? fabs(moment / ink - radius) : radius);
        }
        check_at_least("rough", radius * (1 - cos(3.14159265358979 / AROUND)), 2,
                       "disc: how far its sides are inside the circle");
        check_at_most("rough", worst, 0.5, "disc: how far its rim is off the circle");
        shot_release(&s);
    }
    shape_release(&disc);
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
    static const check_case cases[] = {
        {"beneath", run_beneath}, {"kerbs", run_kerbs},       {"rims", run_rims},
        {"pipes", run_pipes},     {"chamfers", run_chamfers}, {"roundings", run_roundings},
        {"courses", run_courses}, {"classes", run_classes},   {"circles", run_circles}};
    int status = check_main(argc, argv, "line_rough", cases, 9);
    shot_end();
    return status;
}
