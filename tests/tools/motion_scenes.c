/* Writes the scenes that depiction of motion is judged by, S1.glb to S12.glb: `motion_scenes FOLDER`.
 *
 * One frame is 0.04 seconds, which is what a picture is exposed for. Perspective cameras are four units away and 40
 * degrees high, so that at 512 pixels a unit in the plane z = 0 is 175.8 pixels. tools/motion-scenes draws them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/moving_scene.h"

static const double pi = 3.141592653589793, frame_s = 0.04, height_degrees = 40, distance = 4;

static const double red[3] = {0.75, 0.06, 0.05}, green[3] = {0.1, 0.5, 0.12}, blue[3] = {0.08, 0.2, 0.7},
                    white[3] = {0.8, 0.8, 0.76}, grey[3] = {0.35, 0.36, 0.38}, yellow[3] = {0.9, 0.6, 0.08},
                    brown[3] = {0.4, 0.22, 0.1}, black[3] = {0.04, 0.04, 0.05}, turquoise[3] = {0.1, 0.6, 0.6};

static const char *folder;

static void finish(moving_scene *m, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.glb", folder, name);
    moving_scene_write(m, path);
    printf("%s\n", path);
}

/* Pixels of a picture 512 high are so many units at this distance. */
static double units(double pixels, double away)
{
    return pixels * away * tan(height_degrees / 2 * pi / 180) / 256;
}

static int eye(moving_scene *m)
{
    return moving_scene_camera(m, 0, 0, distance, false, height_degrees);
}

/* One key, which is a turn that stays. */
static void lean(moving_scene *m, int node, int axis, double degrees)
{
    double q[4] = {0, 0, 0, cos(degrees * pi / 360)};
    q[axis] = sin(degrees * pi / 360);
    moving_scene_keys(m, node, "rotation", 1, (double[]){0}, q);
}

/* `turns` times around an axis in so many seconds, at constant speed. */
static void spin(moving_scene *m, int node, int axis, double turns, double seconds)
{
    enum { KEYS_MAX = 129 };
    static double times[KEYS_MAX], values[KEYS_MAX * 4];
    int           steps = (int)fmin(KEYS_MAX - 1, ceil(fabs(turns) * 4));
    for (int i = 0; i <= steps; i++) {
        double half = pi * turns * i / steps;
        times[i] = seconds * i / steps;
        memset(&values[4 * i], 0, 4 * sizeof *values);
        values[4 * i + axis] = sin(half);
        values[4 * i + 3] = cos(half);
    }
    moving_scene_keys(m, node, "rotation", steps + 1, times, values);
}

/* Through (0, 0, z) in the middle of two seconds, with a speed in units a frame. */
static void pass(moving_scene *m, int node, double dx, double dy, double x, double y, double z)
{
    double reach = 1 / frame_s;
    moving_scene_keys(m, node, "translation", 2, (double[]){0, 2},
                      (double[]){x - dx * reach, y - dy * reach, z, x + dx * reach, y + dy * reach, z});
}

static int box_in(moving_scene *m, int parent, double x, double y, double z, double a, double b, double c,
                  const double colour[3])
{
    int node = moving_scene_box(m, x, y, z, (double[]){a, b, c}, colour);
    if (parent >= 0)
        moving_scene_put_in(m, node, parent);
    return node;
}

static int ball_in(moving_scene *m, int parent, double x, double y, double z, double radius, const double colour[3])
{
    int node = moving_scene_sphere(m, x, y, z, radius, colour);
    if (parent >= 0)
        moving_scene_put_in(m, node, parent);
    return node;
}

static void scaled(moving_scene *m, int node, double x, double y, double z)
{
    moving_scene_keys(m, node, "scale", 1, (double[]){0}, (double[]){x, y, z});
}

/* The box that renderers are compared with: a red and a green wall, two things in it. */
static int cornell_box(moving_scene *m)
{
    const double t = 0.04;
    int          all = moving_scene_joint(m, 0, 0, 0);
    moving_scene_name(m, all, "cornell");
    box_in(m, all, 0, -1, 0, 1 + t, t, 1, white);
    box_in(m, all, 0, 1, 0, 1 + t, t, 1, white);
    box_in(m, all, 0, 0, -1, 1 + t, 1 + t, t, grey);
    box_in(m, all, -1, 0, 0, t, 1, 1, red);
    box_in(m, all, 1, 0, 0, t, 1, 1, green);
    ball_in(m, all, 0.45, -0.6, 0.25, 0.36, yellow);
    int block = box_in(m, all, -0.4, -0.36, -0.3, 0.3, 0.6, 0.3, blue);
    lean(m, block, 1, 20);
    return all;
}

/* --- the scenes ----------------------------------------------------------------------------------------- */

/* The whole scene goes sideways by 0, 4, 16 and 64 pixels a frame, in the plane z = 0. */
static void sideways_box(void)
{
    static const int speeds[] = {0, 4, 16, 64};
    for (int i = 0; i < 4; i++) {
        moving_scene m;
        char         name[16];
        moving_scene_begin(&m);
        int all = cornell_box(&m);
        scaled(&m, all, 1.2, 1.2, 1.2); /* beyond the page, so that it comes in at the border */
        pass(&m, all, units(speeds[i], distance), 0, 0, 0, 0);
        eye(&m);
        snprintf(name, sizeof name, "S1-%d", speeds[i]);
        finish(&m, name);
    }
}

/* The camera goes straight in: by 0.2 a frame, at 1 s it is where the others' are. */
static void zoom(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    cornell_box(&m);
    moving_scene_keys(&m, eye(&m), "translation", 3, (double[]){0, 0.5, 1.2},
                      (double[]){0, 0, 6.5, 0, 0, 6.5, 0, 0, 3});
    finish(&m, "S2");
}

/* Red is behind at 0.25 s and in front at 0.75 s, green the other way round. */
static void orbits(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    int level = moving_scene_joint(&m, 0, 0, 0), tilted = moving_scene_joint(&m, 0, 0, 0),
        turning = moving_scene_joint(&m, 0, 0, 0);
    moving_scene_name(&m, ball_in(&m, -1, 0, 0, 0, 0.45, blue), "blue ball");
    moving_scene_name(&m, ball_in(&m, level, 0.95, 0, 0, 0.24, red), "red ball");
    moving_scene_name(&m, ball_in(&m, turning, 0.8, 0, 0, 0.2, green), "green ball");
    moving_scene_put_in(&m, turning, tilted);
    lean(&m, tilted, 2, 50);
    spin(&m, level, 1, 2, 2);
    spin(&m, turning, 1, -2, 2);
    eye(&m);
    finish(&m, "S3");
}

/* An animal of balls that looks to the left. */
static int rabbit(moving_scene *m, double x, double y, double z)
{
    static const double fur[3] = {0.62, 0.45, 0.3}, belly[3] = {0.85, 0.76, 0.62};
    int                 all = moving_scene_joint(m, x, y, z);
    scaled(m, ball_in(m, all, 0.12, -0.12, 0, 0.36, fur), 1.2, 1, 0.85);
    ball_in(m, all, -0.3, 0.25, 0, 0.24, fur);
    for (int side = -1; side <= 1; side += 2) {
        int ear = ball_in(m, all, -0.18, 0.6, side * 0.12, 0.08, belly);
        moving_scene_keys(m, ear, "rotation", 1, (double[]){0}, (double[]){0, 0, -0.16, 0.987});
        scaled(m, ear, 0.8, 3.2, 0.6);
        scaled(m, ball_in(m, all, -0.2, -0.42, side * 0.18, 0.09, belly), 1.6, 0.8, 1);
        ball_in(m, all, -0.44, 0.32, side * 0.16, 0.045, black);
    }
    ball_in(m, all, 0.56, -0.12, 0, 0.13, belly);
    return all;
}

/* The same animal at 1, 5 and 25 times the distance, 48 pixels a frame to the left each. */
static void near_and_far(void)
{
    static const double times[] = {1, 5, 25}, right[] = {-40, 130, 130}, up[] = {-40, 130, -110};
    moving_scene        m;
    moving_scene_begin(&m);
    for (int i = 0; i < 3; i++) {
        double away = 3 * times[i], z = distance - away;
        int    one = rabbit(&m, 0, 0, z);
        pass(&m, one, -units(48, away), 0, units(right[i], away), units(up[i], away), z);
    }
    eye(&m);
    finish(&m, "S4");
}

/* The red box grows till 0.2 s and shrinks till 0.4 s; at 0.1 and 0.3 s it is as large. The blue one turns in it. */
static void pulsating_box(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    int outer = box_in(&m, -1, 0, 0, 0, 0.5, 0.5, 0.5, red), inner = box_in(&m, -1, 0, 0, 0, 0.25, 0.25, 0.25, blue);
    moving_scene_keys(&m, outer, "scale", 3, (double[]){0, 0.2, 0.4},
                      (double[]){0.5, 0.5, 0.5, 1.5, 1.5, 1.5, 0.5, 0.5, 0.5});
    spin(&m, inner, 1, 1, 0.4);
    moving_scene_name(&m, outer, "outer");
    moving_scene_name(&m, inner, "inner");
    eye(&m);
    finish(&m, "S5");
}

/* A ball goes by behind a wall with a slit, 56 pixels a frame. */
static void curtain(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    moving_scene_name(&m, box_in(&m, -1, -0.85, 0, 0.5, 0.65, 0.9, 0.05, grey), "wall left");
    moving_scene_name(&m, box_in(&m, -1, 0.75, 0, 0.5, 0.55, 0.9, 0.05, grey), "wall right");
    box_in(&m, -1, 0, -0.95, 0, 1.6, 0.05, 0.8, brown);
    int ball = ball_in(&m, -1, 0, 0, -0.2, 0.4, red);
    moving_scene_name(&m, ball, "ball");
    pass(&m, ball, units(56, distance), 0, 0, 0, -0.2);
    eye(&m);
    finish(&m, "S6");
}

/* Parallel rays: the page is 512 units, and pixels, wide. A bar 40 wide goes 120 a frame, from left to right. */
static void bar(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    pass(&m, box_in(&m, -1, 0, 0, 0, 20, 120, 1, black), 120, 0, 60, 0, 0);
    moving_scene_camera(&m, 0, 0, 10, true, 256);
    finish(&m, "S7");
}

/* A cube that stands on a corner goes up to the right, 60 pixels a frame. */
static void cube(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    int mover = moving_scene_joint(&m, 0, 0, 0), tilt = moving_scene_joint(&m, 0, 0, 0),
        one = box_in(&m, tilt, 0, 0, 0, 0.45, 0.45, 0.45, turquoise);
    moving_scene_put_in(&m, tilt, mover);
    lean(&m, tilt, 0, 30);
    lean(&m, one, 1, 40);
    pass(&m, mover, units(42, distance), units(42, distance), 0.2, 0.2, 0);
    eye(&m);
    finish(&m, "S8");
}

static int wheel(moving_scene *m, double x, double y, double radius, const double colour[3])
{
    int all = moving_scene_joint(m, x, y, 0), tyre = moving_scene_cylinder(m, 0, 0, 0, radius, 0.08, black),
        disc = moving_scene_cylinder(m, 0, 0, 0.05, radius * 0.8, 0.05, white);
    moving_scene_put_in(m, tyre, all);
    moving_scene_put_in(m, disc, all);
    for (int i = 0; i < 3; i++) {
        int spoke = box_in(m, all, 0, 0, 0.08, radius * 0.76, radius * 0.08, 0.04, colour);
        lean(m, spoke, 2, 60 * i);
    }
    return all;
}

/* One spins, 35 degrees a frame; the other rolls to the right without slipping. */
static void wheels(void)
{
    const double radius = 0.5, travel = 0.3;
    moving_scene m;
    moving_scene_begin(&m);
    int spinning = wheel(&m, -0.35, 0.66, radius, red), rolling = wheel(&m, 0, 0, radius, blue);
    moving_scene_name(&m, spinning, "spinning");
    moving_scene_name(&m, rolling, "rolling");
    spin(&m, spinning, 2, -35.0 / 360 / frame_s * 2, 2);
    spin(&m, rolling, 2, -2 * travel / frame_s / (2 * pi * radius), 2);
    pass(&m, rolling, travel, 0, 0.3, -0.66, 0);
    moving_scene_name(&m, box_in(&m, -1, 0, -1.2, 0, 1.6, 0.04, 0.4, brown), "ground");
    eye(&m);
    finish(&m, "S9");
}

/* Falls from 0 s, touches the ground at 0.4 s and 1.2 s. Parabolas, which cubic keys tell exactly. */
static void bounce(void)
{
    enum { KEYS = 3 };
    const double radius = 0.25, ground = -0.95, top = 0.85, fall_s = 0.4, across = 1.5;
    double       drop = top - ground - radius, hit = 2 * drop / fall_s, low = ground + radius, values[KEYS * 9] = {0};
    double       times[KEYS] = {0, fall_s, 3 * fall_s}, y[KEYS] = {top, low, low}, before[KEYS] = {0, -hit, -hit},
           after[KEYS] = {0, hit, hit};
    moving_scene m;
    moving_scene_begin(&m);
    for (int i = 0; i < KEYS; i++) {
        values[9 * i] = values[9 * i + 6] = across;
        values[9 * i + 3] = across * (times[i] - 0.6);
        values[9 * i + 1] = before[i];
        values[9 * i + 4] = y[i];
        values[9 * i + 7] = after[i];
    }
    int ball = ball_in(&m, -1, 0, 0, 0, radius, red);
    moving_scene_name(&m, ball, "ball");
    moving_scene_cubic_keys(&m, ball, "translation", KEYS, times, values);
    moving_scene_name(&m, box_in(&m, -1, 0, ground - 0.04, 0, 1.8, 0.04, 0.6, brown), "ground");
    eye(&m);
    finish(&m, "S10");
}

/* Goes to the left, 60 pixels a frame. */
static void styles(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    pass(&m, rabbit(&m, 0, 0, 0), -units(60, distance), 0, -0.25, 0, 0);
    eye(&m);
    finish(&m, "S11");
}

/* The camera goes along with a car, past poles, 48 pixels a frame. */
static void tracked_car(void)
{
    const double travel = units(48, distance), radius = 0.2;
    moving_scene m;
    moving_scene_begin(&m);
    int car = moving_scene_joint(&m, 0, 0, 0), view = eye(&m);
    moving_scene_put_in(&m, view, car);
    moving_scene_name(&m, box_in(&m, car, 0, -0.42, 0, 0.75, 0.17, 0.3, red), "body");
    moving_scene_name(&m, box_in(&m, car, -0.08, -0.14, 0, 0.36, 0.13, 0.26, white), "body roof");
    for (int k = -1; k <= 1; k += 2) {
        int one = wheel(&m, k * 0.45, -0.62, radius, grey);
        moving_scene_name(&m, one, k < 0 ? "wheel back" : "wheel front");
        moving_scene_put_in(&m, one, car);
        int front = moving_scene_joint(&m, 0, 0, 0.3); /* the wheels stand at the car's near side */
        moving_scene_put_in(&m, front, car);
        moving_scene_put_in(&m, one, front);
        spin(&m, one, 2, -2 * travel / frame_s / (2 * pi * radius), 2);
    }
    pass(&m, car, travel, 0, 0, 0, 0);
    double half = travel / frame_s + 4;
    moving_scene_name(&m, box_in(&m, -1, 0, -0.86, -0.4, half, 0.04, 1.2, grey), "ground");
    for (double x = -half + 0.2; x < half; x += 0.8)
        moving_scene_name(&m, box_in(&m, -1, x, 0.1, -0.9, 0.06, 0.92, 0.06, blue), "pole");
    finish(&m, "S12");
}

int main(int count, char **arguments)
{
    if (count != 2) {
        fprintf(stderr, "usage: motion_scenes FOLDER\n");
        return EXIT_FAILURE;
    }
    folder = arguments[1];
    void (*const scenes[])(void) = {sideways_box, zoom, orbits, near_and_far, pulsating_box, curtain,
                                    bar,          cube, wheels, bounce,       styles,        tracked_car};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        scenes[i]();
    return EXIT_SUCCESS;
}
