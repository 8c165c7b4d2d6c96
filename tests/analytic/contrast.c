/* Lines that stay visible on any ground: second contour, light or dark by the ground, left out where the picture
 * shows the edge by itself, and the second line on the outer side. Rows OI-09 to OI-12. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

static const shot_view front = {
    .width = 240, .height = 240, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 18};

static const uint8_t *pixel(const shot *s, int x, int y)
{
    return &s->picture[4 * (y * s->width + x)];
}

static bool is_grey(const uint8_t *p, int level, int tolerance)
{
    return abs(p[0] - level) <= tolerance && abs(p[1] - level) <= tolerance && abs(p[2] - level) <= tolerance;
}

/* Brightness as the frame buffer holds it, 0 … 1: the seed compares what is on the screen. */
static double luma(const uint8_t *p)
{
    return (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255;
}

#define GREY_LOOK(LINES)                                                                                               \
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#808080\"},\"rules\":[{\"surface\":{\"technique\":"        \
    "\"flat\",\"colour\":\"#808080\"},\"lines\":" LINES "}]}"

static bool take_ball(shot *out, const char *look, const char *const *changes)
{
    shape s = {0};
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 64, 128, true);
    bool ok = shot_of_shape(out, &s, "ball.glb", look, changes, &front);
    shape_release(&s);
    return ok;
}

/* The picture is the edge map in black over the same map in white, one pixel to the right and one down. */
static void double_contours(void)
{
    static const char look[] = GREY_LOOK(
        "{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"contrast\":\"double\",\"light_colour\":\"#ffffff\"}");
    static const int offsets[][2] = {{1, 1}, {2, 0}, {-1, 3}};
    for (int o = 0; o < 3; o++) {
        char across[8], down[8];
        shot s;
        int  black = 0, white = 0, wrong = 0;
        snprintf(across, sizeof across, "%dpx", offsets[o][0]);
        snprintf(down, sizeof down, "%dpx", offsets[o][1]);
        const char *changes[] = {"lines.offset_x", across, "lines.offset_y", down, NULL};
        if (take_ball(&s, look, o ? changes : NULL))
            for (int y = 4; y < 236; y++)
                for (int x = 4; x < 236; x++) {
                    int first = shot_ink(&s, x, y), second = shot_ink(&s, x - offsets[o][0], y - offsets[o][1]);
                    if (first == 0) {
                        black++;
                        wrong += !is_grey(pixel(&s, x, y), 0, 1); /* half a step of the map */
                    } else if (first == 255 && second == 0) {
                        white++;
                        wrong += !is_grey(pixel(&s, x, y), 255, 1);
                    } else if (first == 255 && second == 255) {
                        wrong += !is_grey(pixel(&s, x, y), 128, 1);
                    }
                }
        check_at_least("OI-09", black, 300, "pixels of the first contour");
        check_at_least("OI-09", white, 20, "pixels of the second contour");
        check_at_most("OI-09", wrong, 0, "pixels that are not the two contours %d px right and %d px down",
                      offsets[o][0], offsets[o][1]);
        shot_release(&s);
    }
}

/* Upright stripes of every grey as separate parts; their borders are the lines. */
static void stripes(shape *s, int count)
{
    for (int i = 0; i < count; i++) {
        char name[16];
        snprintf(name, sizeof name, "s%d", i);
        shape_box(s, name, dvec_of(-1 + 2.0 * i / count, -1, -0.1), dvec_of(-1 + 2.0 * (i + 1) / count, 1, 0));
        for (int k = 0; k < 3; k++)
            s->parts[s->count - 1].colour[k] = (float)picture_linear((uint8_t)(255 * i / (count - 1)));
    }
}

static const char *adaptive_look(double suppress, double blur, const char *ground)
{
    static char text[512];
    snprintf(text, sizeof text,
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"%s\"},\"rules\":[{\"surface\":{\"technique\":"
             "\"textured\",\"light\":0},"
             "\"lines\":{\"operator\":\"discontinuity\",\"contrast\":\"adaptive\",\"suppress\":%g,\"blur\":%g}}]}",
             ground, suppress, blur);
    return text;
}

/* How bright what lies under the lines is around a position: the mean of shade map and ground. */
static double ground_around(const shot *s, int x, int y, int radius, double page)
{
    double sum = 0;
    int    count = 0;
    for (int j = y - radius; j <= y + radius; j++)
        for (int i = x - radius; i <= x + radius; i++) {
            if (i < 0 || j < 0 || i >= s->width || j >= s->height)
                continue;
            const uint8_t *p = &s->shade[4 * (j * s->width + i)];
            sum += p[3] ? luma(p) : page;
            count++;
        }
    return sum / count;
}

static void colour_by_ground(void)
{
    static const char *const grounds[] = {"#ffffff", "#000000", "#808080"};
    static const double      pages[] = {1, 0, 128 / 255.0};
    for (int g = 0; g < 3; g++) {
        shape  s = {0};
        shot   drawing;
        double least = 1;
        int    lines = 0, weak = 0, flips = 0;
        stripes(&s, 16);
        if (shot_of_shape(&drawing, &s, "stripes.glb", adaptive_look(0, 4, grounds[g]), NULL, &front)) {
            for (int y = 0; y < 240; y++)
                for (int x = 0; x < 240; x++) {
                    if (shot_ink(&drawing, x, y) > 0)
                        continue;
                    double distance = fabs(luma(pixel(&drawing, x, y)) - ground_around(&drawing, x, y, 3, pages[g]));
                    lines++;
                    least = fmin(least, distance);
                    weak += distance < 0.4;
                }
            for (int x = 0; x < 240; x++)
                for (int y = 60; y < 180; y++)
                    flips += shot_ink(&drawing, x, y) == 0 && shot_ink(&drawing, x, y - 1) == 0 &&
                             fabs(luma(pixel(&drawing, x, y)) - luma(pixel(&drawing, x, y - 1))) > 0.3;
        }
        check_at_least("OI-10", lines, 3000, "contour pixels on stripes of every grey, ground %s", grounds[g]);
        check_at_most("OI-10", weak, 0, "of them less than 0.4 from the local ground's luminance (least %.3f)", least);
        check_at_most("OI-10", flips, 0, "places along an even line at which it switches colour");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A fine checker around middle grey: the colour of a line must not follow single texels. */
static void no_flicker(void)
{
    shape s = {0};
    shot  drawing;
    int   flips = 0, lines = 0;
    for (int i = 0; i < 2; i++) {
        char name[8];
        snprintf(name, sizeof name, "q%d", i);
        shape_quad(&s, name, 1, i ? 0.2 : 0);
        shape_part *p = &s.parts[i];
        p->texture_size = 128;
        p->texture = check_alloc(128 * 128, 4);
        for (int k = 0; k < 128 * 128; k++)
            memset(&p->texture[4 * k], (k / 128 / 2 + k % 128 / 2) % 2 ? 190 : 70, 4);
        for (int k = 0; k < 128 * 128; k++)
            p->texture[4 * k + 3] = 255;
        for (int k = 0; i && k < 4; k++) {
            p->positions[k][0] *= 0.5f;
            p->positions[k][1] *= 0.5f;
        }
    }
    if (shot_of_shape(&drawing, &s, "checker.glb", adaptive_look(0, 6, "#ffffff"), NULL, &front))
        for (int y = 90; y < 150; y++)
            for (int x = 40; x < 100; x++) {
                bool both = shot_ink(&drawing, x, y) == 0 && shot_ink(&drawing, x, y - 1) == 0;
                lines += both;
                flips += both && fabs(luma(pixel(&drawing, x, y)) - luma(pixel(&drawing, x, y - 1))) > 0.3;
            }
    check_at_least("OI-10", lines, 60, "neighbouring contour pixels over a fine checker");
    check_at_most("OI-10", flips, 2, "of them at which the line switches colour");
    shot_release(&drawing);
    shape_release(&s);
}

/* Black beside white needs no line, grey beside the same grey does. */
static void redundant_lines(void)
{
    shape              s = {0};
    shot               drawing;
    static const float tones[4] = {0.0f, 1.0f, 0.2f, 0.2f};
    int                at_contrast = 0, at_equal = 0;
    for (int i = 0; i < 4; i++) {
        char name[8];
        snprintf(name, sizeof name, "t%d", i);
        shape_box(&s, name, dvec_of(-1 + 0.5 * i, -1, -0.1), dvec_of(-0.5 + 0.5 * i, 1, 0));
        for (int k = 0; k < 3; k++)
            s.parts[i].colour[k] = tones[i];
    }
    if (shot_of_shape(&drawing, &s, "redundant.glb", adaptive_look(0.3, 6, "#ffffff"), NULL, &front)) {
        dvec contrast = shot_project(&drawing, dvec_of(-0.5, 0, 0)), equal = shot_project(&drawing, dvec_of(0.5, 0, 0));
        for (int y = 90; y < 150; y++) {
            double black = luma(pixel(&drawing, (int)contrast.x - 5, y)),
                   white = luma(pixel(&drawing, (int)contrast.x + 5, y));
            double grey = luma(pixel(&drawing, (int)equal.x - 8, y));
            bool   line = false, other = false;
            for (int x = -3; x < 3; x++) {
                double v = luma(pixel(&drawing, (int)contrast.x + x, y)),
                       w = luma(pixel(&drawing, (int)equal.x + x, y));
                other = other || (fabs(v - black) > 0.08 && fabs(v - white) > 0.08);
                line = line || fabs(w - grey) > 0.3;
            }
            at_contrast += other;
            at_equal += line;
        }
        /* On black and white the line's colours are almost those of the ground: count where the border itself
         * moved. */
        int moved = 0;
        for (int y = 90; y < 150; y++)
            for (int x = -3; x < 3; x++)
                moved +=
                    (luma(pixel(&drawing, (int)contrast.x + x, y)) > 0.5) != (x + (int)contrast.x + 0.5 > contrast.x);
        check_at_most("OI-11", moved, 0, "pixels beside a black and white border that a line covers");
    }
    check_at_most("OI-11", at_contrast, 0, "rows with a line where the picture shows the edge already");
    check_at_least("OI-11", at_equal, 60, "of 60 rows with a line between equal greys");
    shot_release(&drawing);
    shape_release(&s);
}

/* Going outwards from the middle of a ball, the dark line comes first and the light one behind it, in every
 * direction. */
static void outward(void)
{
    static const char look[] = GREY_LOOK("{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"contrast\":"
                                         "\"directed\",\"light_colour\":\"#ffffff\"}");
    shot              s;
    int               missing = 0, inside_out = 0;
    if (take_ball(&s, look, NULL))
        for (int k = 0; k < 32; k++) {
            double angle = k * 3.14159265358979323846 / 16, dark = 0, light = 0;
            int    darks = 0, lights = 0;
            for (int y = 0; y < 240; y++)
                for (int x = 0; x < 240; x++) {
                    double dx = x - 119.5, dy = y - 119.5, r = hypot(dx, dy);
                    if (r < 40 || fabs(remainder(atan2(dy, dx) - angle, 2 * 3.14159265358979323846)) > 0.09)
                        continue;
                    if (is_grey(pixel(&s, x, y), 0, 60)) {
                        dark += r;
                        darks++;
                    } else if (is_grey(pixel(&s, x, y), 255, 100)) {
                        light += r;
                        lights++;
                    }
                }
            missing += !darks || !lights;
            inside_out += darks && lights && light / lights < dark / darks + 0.5;
        }
    check_at_most("OI-12", missing, 0, "of 32 directions in which one of the two lines is missing");
    check_at_most("OI-12", inside_out, 0, "directions in which the light line is not the outer one");
    shot_release(&s);
}

/* With `lit` the second line lies on the side of the light, all around: what is light lies, on the mean, by about its
 * width farther that way than what is dark, and neither to the right nor to the left. Light from straight ahead is
 * taken for light from above. */
static void towards_the_light(void)
{
    static const double lights[][3] = {{1, 0, 0.3}, {-0.6, 0.8, 0.2}, {0, -1, 1}, {0, 0, 1}};
    for (int k = 0; k < 4; k++) {
        char look[600];
        shot s;
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#808080\"},\"scene\":{\"light_direction\":[%g,"
                 "%g,%g]},"
                 "\"rules\":[{\"surface\":{\"technique\":\"flat\",\"colour\":\"#808080\"},\"lines\":{\"operator\":"
                 "\"discontinuity\",\"width\":4,\"colour\":\"#000000\",\"contrast\":\"lit\",\"light_colour\":\"#"
                 "ffffff\"}}]}",
                 lights[k][0], lights[k][1], lights[k][2]);
        if (take_ball(&s, look, NULL)) {
            double sums[2][3] = {{0}}, size = hypot(lights[k][0], lights[k][1]), x = size > 0 ? lights[k][0] / size : 0,
                   y = size > 0 ? lights[k][1] / size : 1;
            for (int i = 0; i < s.width * s.height; i++) {
                double px = i % s.width - 119.5, py = 119.5 - floor(i / (double)s.width),
                       grey = s.picture[4 * i] - 128.0, *sum = sums[grey > 0];
                sum[0] += fabs(grey);
                sum[1] += fabs(grey) * (px * x + py * y);
                sum[2] += fabs(grey) * (px * -y + py * x);
            }
            check_near("OI-12", sums[1][1] / sums[1][0] - sums[0][1] / sums[0][0], 5, 1.5,
                       "light from %g, %g: how far the light line lies that way, of lines of 4 px", x, y);
            check_near("OI-12", sums[1][2] / sums[1][0] - sums[0][2] / sums[0][0], 0, 0.5, "  and beside");
        }
        shot_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"double", double_contours},    {"ground", colour_by_ground}, {"flicker", no_flicker},
        {"redundant", redundant_lines}, {"outward", outward},         {"lit", towards_the_light},
    };
    int status = check_main(argc, argv, "contrast", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
