/* Writes the example model of a buggy: make_buggy OUT.glb
 *
 * A small open car on a road, which it drives along towards +x, past a kerb, lamp posts and trees at −z. Lengths are
 * metres; +y is up. The clip "Drive" passes at constant speed, "Brake" comes to a stop with its nose down. One camera
 * stands beside the road, one drives along. */
#include "pieces.h"

#include "moving.h"

#include <math.h>
#include <stdlib.h>

enum { ROUND = 40, SMALL_ROUND = 20, BAR_ROUND = 10, POLES = 11, TREES = 8, NAME_MAX_SIZE = 32, PARTS_MAX = 80 };

/* --- dimensions that parts share ------------------------------------------------------------------------ */

static const double wheel_radius = 0.4, front_axle = 1.12, rear_axle = -1.02, half_track = 0.7;
static const double road_end = 16, road_edge = -1.9, kerb_edge = -2.1, lawn_edge = -8;
static const double pole_z = -2.7, pole_spacing = 3, tree_spacing = 4.5;
static const double speed = 8;

/* --- car ------------------------------------------------------------------------------------------------ */

static void rounded_elevation(mesh *m, const double (*corners)[3], int count, double from, double to)
{
    outline o = rounded(corners, count);
    elevation(m, &o, NULL, 0, from, to);
}

static void build_fender(mesh *m, double x, double side)
{
    outline o = {0};
    add_arc(&o, x, wheel_radius, 0.52, 12, 168, SMALL_ROUND);
    add_arc(&o, x, wheel_radius, 0.48, 168, 12, SMALL_ROUND);
    elevation(m, &o, NULL, 0, side > 0 ? 0.46 : -0.9, side > 0 ? 0.9 : -0.46);
}

/* Nose, floor and tail in one, between sides that leave the cockpit open. */
static void build_body(mesh *m)
{
    static const double tub[][3] = {
        {-1.5, 0.5, 0.12},  {-1.15, 0.3, 0.2},   {1.2, 0.3, 0.2},    {1.68, 0.5, 0.1},
        {1.62, 0.66, 0.1},  {0.66, 0.94, 0.3},   {0.48, 0.92, 0.04}, {0.44, 0.42, 0.05},
        {-0.5, 0.42, 0.05}, {-0.66, 0.96, 0.05}, {-1.0, 1.0, 0.15},  {-1.56, 0.78, 0.15},
    };
    static const double flank[][3] = {
        {-1.42, 0.52, 0.08}, {-1.12, 0.33, 0.15}, {1.18, 0.33, 0.15}, {1.6, 0.5, 0.06},
        {1.55, 0.62, 0.06},  {0.64, 0.89, 0.25},  {0.36, 0.84, 0.18}, {0.18, 0.66, 0.2},
        {-0.4, 0.64, 0.2},   {-0.64, 0.9, 0.15},  {-1.0, 0.95, 0.15}, {-1.48, 0.74, 0.1},
    };
    rounded_elevation(m, tub, COUNT(tub), -0.44, 0.44);
    for (int side = -1; side <= 1; side += 2) {
        rounded_elevation(m, flank, COUNT(flank), side > 0 ? 0.4 : -0.51, side > 0 ? 0.51 : -0.4);
        build_fender(m, front_axle, side);
        build_fender(m, rear_axle, side);
    }
}

static void build_roundels(mesh *m)
{
    for (int side = -1; side <= 1; side += 2)
        LATHE(m, (&(frame){{-0.12, 0.49, side * 0.5}, side > 0 ? FRONT : BACK}), ROUND, NULL, NULL, {-0.03, 0},
              {-0.03, 0.13}, {0.02, 0.13}, {0.02, 0});
}

static void build_seats(mesh *m)
{
    static const double seat[][3] = {
        {-0.56, 0.4, 0.05}, {-0.02, 0.4, 0.03},  {0, 0.56, 0.06},
        {-0.34, 0.56, 0.1}, {-0.46, 1.06, 0.06}, {-0.6, 1.06, 0.06},
    };
    rounded_elevation(m, seat, COUNT(seat), 0.03, 0.38);
    rounded_elevation(m, seat, COUNT(seat), -0.38, -0.03);
}

/* A bow that stands on y = 0 in the plane x = 0. */
static void bow(mesh *m, double half_width, double height, double corner, double radius)
{
    double points[24][3] = {{0, 0, half_width}};
    int    count =
        arc_points(points, 1, (const double[]){0, height - corner, half_width - corner}, 2, 1, corner, 0, 90, 6);
    count =
        arc_points(points, count, (const double[]){0, height - corner, corner - half_width}, 2, 1, corner, 90, 180, 6);
    points[count][0] = points[count][1] = 0;
    points[count++][2] = -half_width;
    tube(m, (const double(*)[3])points, count, (const double[]){1, 0, 0}, radius, BAR_ROUND);
}

static void build_roll_bar(mesh *m)
{
    bow(m, 0.4, 1.05, 0.16, 0.035);
    turn_about(m, 0, 2, 4, -0.68, 0.5, 0);
    for (int side = -1; side <= 1; side += 2)
        bar(m, (const double[]){-0.74, 1.42, side * 0.34}, (const double[]){-1.3, 0.84, side * 0.34}, 0.025, 0.025,
            BAR_ROUND);
}

static void build_windscreen(mesh *m)
{
    bow(m, 0.4, 0.42, 0.08, 0.022);
    turn_about(m, 0, 2, 20, 0.62, 0.84, 0);
}

static void build_steering_wheel(mesh *m)
{
    const double middle[3] = {0, 0, 0};
    hoop(m, middle, 0.17, 0.02, 28, 8);
    bar(m, (const double[]){0, -0.4, 0}, (const double[]){0, 0.03, 0}, 0.02, 0.03, BAR_ROUND);
    for (int i = 0; i < 3; i++) {
        double angle = 2 * PI * i / 3;
        bar(m, middle, (const double[]){0.16 * cos(angle), 0, 0.16 * sin(angle)}, 0.014, 0.014, 6);
    }
    turn_about(m, 0, 2, 58, 0.18, 0.9, 0.21);
}

static void build_lamps(mesh *m)
{
    for (int side = -1; side <= 1; side += 2)
        LATHE(m, (&(frame){{1.42, 0.84, side * 0.29}, RIGHT}), SMALL_ROUND, NULL, NULL, {-0.15, 0}, {-0.13, 0.05},
              {-0.06, 0.1}, {0.02, 0.125}, {0.06, 0.13}, {0.06, 0.11}, {0.04, 0.1}, {0.04, 0});
}

static void build_lenses(mesh *m)
{
    for (int side = -1; side <= 1; side += 2)
        LATHE(m, (&(frame){{1.42, 0.84, side * 0.29}, RIGHT}), SMALL_ROUND, NULL, NULL, {0.03, 0}, {0.03, 0.105},
              {0.07, 0.08}, {0.085, 0.04}, {0.09, 0});
}

/* Bumpers, and two exhaust pipes that turn up behind. */
static void build_chrome(mesh *m)
{
    bar(m, (const double[]){1.74, 0.47, -0.5}, (const double[]){1.74, 0.47, 0.5}, 0.035, 0.035, BAR_ROUND);
    for (int side = -1; side <= 1; side += 2) {
        double points[16][3] = {{-1.3, 0.45, side * 0.24}};
        int    count = arc_points(points, 1, (const double[]){-1.62, 0.57, side * 0.24}, 0, 1, 0.12, 270, 190, 6);
        points[count][0] = -1.77;
        points[count][1] = 0.78;
        points[count++][2] = side * 0.24;
        tube(m, (const double(*)[3])points, count, (const double[]){0, 0, 1}, 0.045, BAR_ROUND);
        bar(m, (const double[]){1.5, 0.45, side * 0.25}, (const double[]){1.73, 0.47, side * 0.25}, 0.025, 0.025,
            BAR_ROUND);
    }
}

static void build_axles(mesh *m)
{
    for (int end = 0; end < 2; end++) {
        double x = end ? front_axle : rear_axle;
        bar(m, (const double[]){x, wheel_radius, -half_track}, (const double[]){x, wheel_radius, half_track}, 0.04,
            0.04, BAR_ROUND);
    }
}

static void build_tyre(mesh *m)
{
    ring first, last;
    LATHE(m, (&(frame){.along = FRONT}), ROUND, &first, &last, {-0.11, 0.26}, {-0.135, 0.3}, {-0.135, 0.34},
          {-0.11, 0.385}, {-0.06, 0.4}, {0.06, 0.4}, {0.11, 0.385}, {0.135, 0.34}, {0.135, 0.3}, {0.11, 0.26});
    sew(m, &last, &first);
}

static void build_spokes(mesh *m)
{
    enum { SPOKES = 5 };
    const frame f = {.along = FRONT};
    ring        first, last;
    LATHE(m, &f, ROUND, &first, &last, {-0.1, 0.235}, {-0.115, 0.245}, {-0.115, 0.265}, {0.115, 0.265}, {0.115, 0.245},
          {0.1, 0.235});
    sew(m, &last, &first);
    for (int i = 0; i < SPOKES; i++) {
        uint32_t kept = m->point_count;
        outline  o = {0};
        add_point(&o, -0.04, 0.03);
        add_point(&o, 0.04, 0.03);
        add_point(&o, 0.026, 0.245);
        add_point(&o, -0.026, 0.245);
        elevation(m, &o, NULL, 0, -0.06, 0.06);
        turn_about(m, kept, 2, 360.0 * i / SPOKES, 0, 0, 0);
    }
}

static void build_hub(mesh *m)
{
    LATHE(m, (&(frame){.along = FRONT}), SMALL_ROUND, NULL, NULL, {-0.1, 0}, {-0.09, 0.04}, {-0.07, 0.07}, {0.07, 0.07},
          {0.09, 0.04}, {0.1, 0});
}

/* --- beside the road ------------------------------------------------------------------------------------ */

static void build_road(mesh *m)
{
    box(m, -road_end, -0.15, road_edge, road_end, 0, 2.4);
}

/* Dashes between the lanes; thin, and in front of the car. */
static void build_dashes(mesh *m)
{
    for (double x = -15; x < road_end; x += 2)
        box(m, x, -0.01, 1.55, x + 1, 0.008, 1.67);
}

static void build_kerb(mesh *m, int odd)
{
    for (double x = -road_end + odd; x < road_end; x += 2)
        box(m, x + 0.01, -0.1, kerb_edge, x + 0.99, 0.12, road_edge + 0.02);
}

static void build_lawn(mesh *m)
{
    box(m, -road_end, -0.15, lawn_edge, road_end, 0.06, kerb_edge + 0.02);
}

static void build_pole(mesh *m)
{
    TURNED(m, 0, 0, 0, SMALL_ROUND, {0, 0}, {0, 0.1}, {0.3, 0.1}, {0.34, 0.055}, {2.3, 0.045}, {2.32, 0.1}, {2.38, 0.1},
           {2.4, 0});
}

static void build_pole_lamp(mesh *m)
{
    TURNED(m, 0, 2.56, 0, SMALL_ROUND, {-0.19, 0}, {-0.17, 0.08}, {-0.11, 0.15}, {0, 0.19}, {0.11, 0.15}, {0.17, 0.08},
           {0.19, 0});
}

static void build_trunk(mesh *m)
{
    TURNED(m, 0, 0, 0, BAR_ROUND, {0, 0}, {0, 0.2}, {0.3, 0.14}, {1.6, 0.11}, {1.6, 0});
}

static void build_crown(mesh *m, int seed)
{
    foliage(m, (const double[]){0, 2.7, 0}, 1.1, 1.45, (uint32_t)seed);
}

/* --- the model ------------------------------------------------------------------------------------------ */

enum { RED, CREAM, LEATHER, BLACK, CHROME, YELLOW, RUBBER, ASPHALT, WHITE, LAWN, BLUE, BARK, LEAVES, MATERIALS };

static const model_material materials[MATERIALS] = {
    [RED] = {"Red paint", {0.62, 0.055, 0.035}},   [CREAM] = {"Cream", {0.86, 0.76, 0.52}},
    [LEATHER] = {"Leather", {0.32, 0.13, 0.05}},   [BLACK] = {"Black paint", {0.03, 0.03, 0.035}},
    [CHROME] = {"Chrome", {0.6, 0.63, 0.66}},      [YELLOW] = {"Lamp glass", {0.95, 0.72, 0.2}},
    [RUBBER] = {"Rubber", {0.045, 0.045, 0.055}},  [ASPHALT] = {"Asphalt", {0.36, 0.37, 0.4}},
    [WHITE] = {"White paint", {0.85, 0.85, 0.82}}, [LAWN] = {"Lawn", {0.3, 0.52, 0.16}},
    [BLUE] = {"Blue paint", {0.05, 0.2, 0.42}},    [BARK] = {"Bark", {0.25, 0.14, 0.07}},
    [LEAVES] = {"Leaves", {0.1, 0.34, 0.12}},
};

enum { CAR, BODY, FRONT_LEFT, FRONT_RIGHT, REAR_LEFT, REAR_RIGHT, ROADSIDE, GROUPS };

static const model_group groups[GROUPS] = {
    [CAR] = {"buggy", {0}, 0, 0},
    [BODY] = {"body", {0}, 0, 1 + CAR},
    [FRONT_LEFT] = {"front left", {1.12, 0.4, -0.7}, 0, 1 + CAR},
    [FRONT_RIGHT] = {"front right", {1.12, 0.4, 0.7}, 0, 1 + CAR},
    [REAR_LEFT] = {"rear left", {-1.02, 0.4, -0.7}, 0, 1 + CAR},
    [REAR_RIGHT] = {"rear right", {-1.02, 0.4, 0.7}, 0, 1 + CAR},
    [ROADSIDE] = {"roadside", {0}, 0, 0},
};

static const model_camera cameras[] = {
    {"beside", {0, 1.6, 8}, {0, 0.95, 0}, 32, 0},
    {"with", {0, 1.6, 8}, {0, 0.95, 0}, 32, 1 + CAR},
};

typedef struct assembly {
    int        count;
    model_part parts[PARTS_MAX];
    char       names[PARTS_MAX][NAME_MAX_SIZE];
} assembly;

static model_part *add(assembly *a, const char *name, int number, int group, int material)
{
    if (a->count == PARTS_MAX)
        give_up();
    char *own = a->names[a->count];
    snprintf(own, NAME_MAX_SIZE, number ? "%s %d" : "%s", name, number);
    a->parts[a->count] = (model_part){.name = own, .group = group, .material = material};
    return &a->parts[a->count++];
}

static void add_built(assembly *a, const char *name, int group, int material, void (*build)(mesh *))
{
    add(a, name, 0, group, material)->build = build;
}

static void list_car(assembly *a)
{
    static const char *const corners[] = {"front left", "front right", "rear left", "rear right"};
    add_built(a, "body shell", BODY, RED, build_body);
    add_built(a, "body roundels", BODY, CREAM, build_roundels);
    add_built(a, "seats", BODY, LEATHER, build_seats);
    add_built(a, "roll bar", BODY, BLACK, build_roll_bar);
    add_built(a, "windscreen frame", BODY, BLACK, build_windscreen);
    add_built(a, "steering gear", BODY, BLACK, build_steering_wheel);
    add_built(a, "head lamps", BODY, CHROME, build_lamps);
    add_built(a, "head lamp glasses", BODY, YELLOW, build_lenses);
    add_built(a, "bumper and exhaust", BODY, CHROME, build_chrome);
    add_built(a, "axles", CAR, BLACK, build_axles);
    for (int k = 0; k < 4; k++) {
        char name[3][NAME_MAX_SIZE];
        snprintf(name[0], NAME_MAX_SIZE, "%s wheel tyre", corners[k]);
        snprintf(name[1], NAME_MAX_SIZE, "%s wheel spokes", corners[k]);
        snprintf(name[2], NAME_MAX_SIZE, "%s wheel hub", corners[k]);
        add_built(a, name[0], FRONT_LEFT + k, RUBBER, build_tyre);
        add_built(a, name[1], FRONT_LEFT + k, CREAM, build_spokes);
        add_built(a, name[2], FRONT_LEFT + k, CHROME, build_hub);
    }
}

static void list_roadside(assembly *a)
{
    add_built(a, "ground road", ROADSIDE, ASPHALT, build_road);
    add_built(a, "ground dashes", ROADSIDE, WHITE, build_dashes);
    add_built(a, "ground lawn", ROADSIDE, LAWN, build_lawn);
    for (int odd = 0; odd < 2; odd++) {
        model_part *p = add(a, odd ? "kerb white" : "kerb red", 0, ROADSIDE, odd ? WHITE : RED);
        p->build_one = build_kerb;
        p->number = odd;
    }
    for (int i = 0; i < POLES; i++) {
        model_part *pole = add(a, "pole", i + 1, ROADSIDE, BLUE), *lamp = add(a, "pole lamp", i + 1, ROADSIDE, CREAM);
        pole->build = build_pole;
        lamp->build = build_pole_lamp;
        pole->at[0] = lamp->at[0] = (i - (POLES - 1) / 2.0) * pole_spacing;
        pole->at[2] = lamp->at[2] = pole_z;
    }
    for (int i = 0; i < TREES; i++) {
        model_part *trunk = add(a, "tree trunk", i + 1, ROADSIDE, BARK),
                   *crown = add(a, "tree crown", i + 1, ROADSIDE, LEAVES);
        trunk->build = build_trunk;
        crown->build_one = build_crown;
        crown->number = 1 + i % 3;
        trunk->at[0] = crown->at[0] = (i - (TREES - 1) / 2.0) * tree_spacing + 0.4 * (i % 3);
        trunk->at[2] = crown->at[2] = -5.4 - 0.7 * (i % 2);
    }
}

/* --- clips ---------------------------------------------------------------------------------------------- */

/* Wheels have turned back by as much as the car has come forward. */
static void roll_wheels(clip *c, int count, const double *times, const double *positions)
{
    for (int k = FRONT_LEFT; k <= REAR_RIGHT; k++) {
        track *t = clip_add(c, 1 + k, "rotation");
        for (int i = 0; i < count; i++)
            track_angle(t, times[i], 2, -positions[i] / wheel_radius);
    }
}

/* Two seconds at constant speed, the middle at x = 0. A key for each quarter turn of the wheels. */
static void drive(clip *c)
{
    enum { QUARTERS = 25 };
    static double times[QUARTERS + 2], positions[QUARTERS + 2];
    for (int i = 0; i < QUARTERS + 2; i++) {
        times[i] = i <= QUARTERS ? i * PI / 2 * wheel_radius / speed : 2;
        positions[i] = speed * (times[i] - 1);
    }
    c->name = "Drive";
    track *t = clip_add(c, 1 + CAR, "translation");
    track_translation(t, 0, -speed, 0, 0);
    track_translation(t, 2, speed, 0, 0);
    roll_wheels(c, QUARTERS + 2, times, positions);
}

static const double brake_begin = 0.4, brake_end = 1.6, brake_from = -7.5;

static double braked_position(double time)
{
    double braked = fmax(0, fmin(time, brake_end) - brake_begin);
    return brake_from + speed * fmin(time, brake_begin) + speed * braked -
           speed * braked * braked / (2 * (brake_end - brake_begin));
}

/* The nose goes down while it brakes, and swings back when it stands. Degrees. */
static double braked_pitch(double time)
{
    if (time < brake_begin)
        return 0;
    if (time < brake_end)
        return -3.2 * (1 - exp(-7 * (time - brake_begin)));
    return -3.2 * exp(-6 * (time - brake_end)) * cos(14 * (time - brake_end));
}

/* The car's keys are few and exact: it moves in a parabola, which is a cubic. */
static void brake(clip *c)
{
    enum { KEYS = 41 };
    static const double times[] = {0, 0.4, 1.6, 2}, speeds[] = {8, 8, 0, 0};
    static double       moments[KEYS], positions[KEYS];
    c->name = "Brake";
    track *t = clip_add(c, 1 + CAR, "translation");
    t->cubic = true;
    for (int i = 0; i < COUNT(times); i++) {
        track_translation(t, times[i], speeds[i], 0, 0);
        track_translation(t, times[i], braked_position(times[i]), 0, 0);
        track_translation(t, times[i], speeds[i], 0, 0);
    }
    for (int i = 0; i < KEYS; i++) {
        moments[i] = 2.0 * i / (KEYS - 1);
        positions[i] = braked_position(moments[i]);
    }
    roll_wheels(c, KEYS, moments, positions);
    t = clip_add(c, 1 + BODY, "rotation");
    for (int i = 0; i < KEYS; i++)
        track_angle(t, moments[i], 2, braked_pitch(moments[i]) * PI / 180);
}

static void animate(glb *g, FILE *json)
{
    static clip clips[2];
    drive(&clips[0]);
    brake(&clips[1]);
    put_clips(g, json, clips, COUNT(clips));
}

int main(int count, char **arguments)
{
    if (count != 2)
        return EXIT_FAILURE;
    static assembly a;
    list_car(&a);
    list_roadside(&a);
    const model buggy = {"make_buggy", "Buggy", 1,       materials, MATERIALS, groups,
                         GROUPS,       a.parts, a.count, animate,   cameras,   COUNT(cameras)};
    return model_write(&buggy, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
