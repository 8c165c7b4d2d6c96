/* Writes the example model of a robot's arm: make_arm OUT.glb
 *
 * Six axes and a gripper, as in factories: the column turns, shoulder and elbow lift, the wrist rolls, bends and rolls
 * again. In the clip "Swing" it takes a bush from a stand, swings it over, puts it on a table and lets go. Lengths are
 * metres, +y is up; at rest the arm is as the swing begins. Links lie along +x of their own joints. */
#include "pieces.h"

#include "moving.h"

#include <math.h>
#include <stdlib.h>

enum { ROUND = 40, SMALL_ROUND = 24 };

/* --- dimensions that parts share ------------------------------------------------------------------------ */

static const double shoulder_out = 0.16, shoulder_height = 0.62;
static const double upper_length = 0.72, fore_length = 0.64, wrist_length = 0.1, tool_length = 0.3;
static const double roll_at = 0.2; /* where the forearm's front end begins, which rolls */
static const double finger_open = 0.085, finger_closed = 0.06;
static const double bush_radius = 0.06, bush_height = 0.16;
static const double stand_height = 0.42, table_height = 0.5;

/* The swing: turn of the column, how far out, begin and end. */
static const double turn_from = -70, turn_to = 75, reach_from = 0.82, reach_to = 1.24;
static const double duration = 1.5, closed_at = 0.12, swing_begin = 0.14, swing_end = 1.24, open_begin = 1.26,
                    open_end = 1.36;

/* --- links ---------------------------------------------------------------------------------------------- */

/* A joint's drum about z. */
static void drum(mesh *m, double radius, double half)
{
    LATHE(m, (&(frame){.along = FRONT}), ROUND, NULL, NULL, {-half, 0}, {-half, radius * 0.5},
          {-half + 0.012, radius * 0.55}, {-half + 0.012, radius * 0.9}, {-half + 0.03, radius}, {half - 0.03, radius},
          {half - 0.012, radius * 0.9}, {half - 0.012, radius * 0.55}, {half, radius * 0.5}, {half, 0});
}

static void build_base(mesh *m)
{
    TURNED(m, 0, 0, 0, ROUND, {0, 0}, {0, 0.34}, {0.04, 0.34}, {0.05, 0.32}, {0.05, 0.25}, {0.09, 0.23}, {0.2, 0.21},
           {0.24, 0.21}, {0.24, 0});
    for (int i = 0; i < 8; i++) {
        double angle = 2 * PI * (i + 0.5) / 8;
        TURNED(m, 0.29 * cos(angle), 0.045, 0.29 * sin(angle), 12, {-0.01, 0}, {-0.01, 0.026}, {0.025, 0.026},
               {0.03, 0.018}, {0.03, 0});
    }
}

/* A round table that turns, and two cheeks that hold the shoulder between them. */
static void build_turret(mesh *m)
{
    static const double cheek[][3] = {
        {-0.17, 0.3, 0}, {0.3, 0.3, 0.04}, {0.31, 0.6, 0.1}, {0.25, 0.76, 0.09}, {0.08, 0.76, 0.09}, {-0.18, 0.46, 0.1},
    };
    static const double drawn_in[][3] = {
        {-0.162, 0.308, 0},    {0.292, 0.308, 0.034}, {0.302, 0.598, 0.094},
        {0.245, 0.752, 0.084}, {0.083, 0.752, 0.084}, {-0.172, 0.457, 0.094},
    };
    outline whole = rounded(cheek, COUNT(cheek)), inset = rounded(drawn_in, COUNT(drawn_in));
    TURNED(m, 0, 0, 0, ROUND, {0.23, 0}, {0.23, 0.19}, {0.25, 0.24}, {0.31, 0.24}, {0.33, 0.22}, {0.33, 0});
    bevelled_plate(m, &whole, &inset, 0.105, 0.185, 0.012);
    bevelled_plate(m, &whole, &inset, -0.185, -0.105, 0.012);
}

static void build_shoulder(mesh *m)
{
    drum(m, 0.125, 0.225);
}

static void build_upper(mesh *m)
{
    link_plate(m, upper_length, 0.12, 0.095, -0.095, 0.095, 0.016);
}

/* A stripe that shows which way the link lies. */
static void build_upper_stripe(mesh *m)
{
    for (int side = -1; side <= 1; side += 2) {
        double z = side * 0.095;
        box(m, 0.2, -0.022, z - 0.006, 0.54, 0.022, z + 0.006);
    }
}

static void build_elbow(mesh *m)
{
    drum(m, 0.1, 0.13);
}

/* The forearm's housing, with its motor behind the elbow; it ends in a neck that the front end rolls on. */
static void build_fore(mesh *m)
{
    static const double side[][3] = {
        {-0.2, -0.06, 0.03}, {0.06, -0.085, 0.06}, {0.21, -0.07, 0.02},
        {0.21, 0.07, 0.02},  {0.02, 0.12, 0.06},   {-0.2, 0.11, 0.03},
    };
    static const double drawn_in[][3] = {
        {-0.19, -0.05, 0.025}, {0.06, -0.073, 0.055}, {0.2, -0.06, 0.015},
        {0.2, 0.06, 0.015},    {0.017, 0.108, 0.055}, {-0.19, 0.1, 0.025},
    };
    outline whole = rounded(side, COUNT(side)), inset = rounded(drawn_in, COUNT(drawn_in));
    bevelled_plate(m, &whole, &inset, -0.085, 0.085, 0.014);
}

static void build_motors(mesh *m)
{
    for (int k = -1; k <= 1; k += 2)
        LATHE(m, (&(frame){{-0.17, 0.025, k * 0.042}, LEFT}), SMALL_ROUND, NULL, NULL, {0, 0}, {0, 0.036}, {0.1, 0.036},
              {0.11, 0.03}, {0.11, 0});
}

/* What rolls: a collar, a tapered tube, and a fork about the wrist. Its origin lies at the collar. */
static void build_roll(mesh *m)
{
    const frame  along = {.along = RIGHT};
    const double wrist = fore_length - roll_at;
    LATHE(m, &along, ROUND, NULL, NULL, {0, 0}, {0, 0.068}, {0.03, 0.074}, {0.06, 0.074}, {0.075, 0.062}, {0.3, 0.05},
          {wrist - 0.09, 0.05}, {wrist - 0.09, 0});
    for (int side = -1; side <= 1; side += 2) {
        static const double prong[][3] = {
            {0.26, -0.04, 0.01}, {0.47, -0.045, 0.04}, {0.47, 0.045, 0.04}, {0.26, 0.04, 0.01}};
        outline o = rounded(prong, COUNT(prong));
        extrude(m, &o, NULL, 0, side > 0 ? 0.036 : -0.062, side > 0 ? 0.062 : -0.036);
    }
}

static void build_wrist(mesh *m)
{
    drum(m, 0.046, 0.08);
    LATHE(m, (&(frame){.along = RIGHT}), SMALL_ROUND, NULL, NULL, {0, 0}, {0, 0.034}, {0.06, 0.034}, {0.07, 0.045},
          {wrist_length, 0.045}, {wrist_length, 0});
}

/* --- gripper -------------------------------------------------------------------------------------------- */

static void build_palm(mesh *m)
{
    LATHE(m, (&(frame){.along = RIGHT}), SMALL_ROUND, NULL, NULL, {-0.005, 0}, {-0.005, 0.052}, {0.035, 0.052},
          {0.035, 0});
    box(m, 0.03, -0.11, -0.045, 0.085, 0.11, 0.045);
}

/* Its inner face lies at y = 0 of its own; `side` is where its back is. */
static void build_finger(mesh *m, int side)
{
    outline o = {0};
    add_point(&o, 0.08, 0.002 * side);
    add_point(&o, 0.1, 0.002 * side);
    add_point(&o, 0.15, 0);
    add_point(&o, tool_length + 0.03, 0);
    add_point(&o, tool_length + 0.03, 0.014 * side);
    add_point(&o, 0.17, 0.022 * side);
    add_point(&o, 0.11, 0.04 * side);
    add_point(&o, 0.08, 0.04 * side);
    elevation(m, &o, NULL, 0, -0.03, 0.03);
}

/* --- what stands around --------------------------------------------------------------------------------- */

static void build_bush(mesh *m)
{
    ring first, last;
    LATHE(m, (&(frame){.along = UP}), ROUND, &first, &last, {0, 0.036}, {0, 0.052}, {0.01, bush_radius},
          {bush_height - 0.01, bush_radius}, {bush_height, 0.052}, {bush_height, 0.036});
    sew(m, &last, &first);
}

static void build_stand(mesh *m)
{
    TURNED(m, 0, 0, 0, ROUND, {0, 0}, {0, 0.2}, {0.03, 0.2}, {0.04, 0.19}, {0.06, 0.06}, {stand_height - 0.06, 0.06},
           {stand_height - 0.03, 0.16}, {stand_height, 0.16}, {stand_height, 0});
}

static void build_table_top(mesh *m)
{
    box(m, -0.36, table_height - 0.05, -0.36, 0.36, table_height, 0.36);
}

static void build_table_legs(mesh *m)
{
    for (int x = -1; x <= 1; x += 2)
        for (int z = -1; z <= 1; z += 2)
            box(m, x * 0.3 - 0.03, 0, z * 0.3 - 0.03, x * 0.3 + 0.03, table_height - 0.04, z * 0.3 + 0.03);
    box(m, -0.3, 0.12, -0.32, 0.3, 0.15, -0.28);
    box(m, -0.3, 0.12, 0.28, 0.3, 0.15, 0.32);
}

static void build_floor(mesh *m)
{
    TURNED(m, 0, 0, 0, 64, {-0.05, 0}, {-0.05, 1.9}, {0, 1.9}, {0, 0});
}

/* --- the model ------------------------------------------------------------------------------------------ */

enum { ORANGE, GREY, STEEL, WHITE, BLUE, BRASS, WOOD, FLOOR, MATERIALS };

static const model_material materials[MATERIALS] = {
    [ORANGE] = {"Orange paint", {0.82, 0.26, 0.03}}, [GREY] = {"Dark casting", {0.07, 0.08, 0.1}},
    [STEEL] = {"Steel", {0.5, 0.54, 0.58}},          [WHITE] = {"White paint", {0.85, 0.85, 0.82}},
    [BLUE] = {"Blue paint", {0.06, 0.24, 0.45}},     [BRASS] = {"Brass", {0.72, 0.5, 0.12}},
    [WOOD] = {"Wood", {0.62, 0.42, 0.22}},           [FLOOR] = {"Floor", {0.6, 0.63, 0.62}},
};

/* Each joint is a group of its own, turned about its axis. */
enum { COLUMN, SHOULDER, ELBOW, ROLL, BEND, TOOL, NEAR_FINGER, FAR_FINGER, AROUND, GROUPS };

static const model_group groups[GROUPS] = {
    [COLUMN] = {"column joint", {0}, 0, 0},
    [SHOULDER] = {"shoulder joint", {0.16, 0.62, 0}, 0, 1 + COLUMN},
    [ELBOW] = {"elbow joint", {0.72, 0, 0}, 0, 1 + SHOULDER},
    [ROLL] = {"roll joint", {0.2, 0, 0}, 0, 1 + ELBOW},
    [BEND] = {"bend joint", {0.44, 0, 0}, 0, 1 + ROLL},
    [TOOL] = {"gripper joint", {0.1, 0, 0}, 0, 1 + BEND},
    [NEAR_FINGER] = {"gripper near", {0, 0.06, 0}, 0, 1 + TOOL},
    [FAR_FINGER] = {"gripper far", {0, -0.06, 0}, 0, 1 + TOOL},
    [AROUND] = {"cell", {0}, 0, 0},
};

/* --- kinematics ----------------------------------------------------------------------------------------- */

/* Angles of the six joints, radians. */
typedef struct joints {
    double turn, shoulder, elbow, roll, bend, tool;
} joints;

static double radians(double degrees)
{
    return degrees * PI / 180;
}

/* From 0 to 1, beginning and ending at rest. */
static double ease(double t)
{
    t = fmax(0, fmin(t, 1));
    return t * t * t * (10 + t * (6 * t - 15));
}

/* The fingers' tips are `reach` out and `height` up; the tool points `tilt` degrees up from straight down. */
static joints reach_for(double reach, double height, double tilt)
{
    double hand = wrist_length + tool_length, down = radians(tilt - 90);
    double x = reach - hand * cos(down) - shoulder_out, y = height - hand * sin(down) - shoulder_height;
    double far = x * x + y * y, a = upper_length, b = fore_length;
    double elbow = -acos((far - a * a - b * b) / (2 * a * b));
    double shoulder = atan2(y, x) - atan2(b * sin(elbow), a + b * cos(elbow));
    return (joints){.shoulder = shoulder, .elbow = elbow, .bend = down - shoulder - elbow};
}

/* On the way it is lifted, reaches out and rolls its wrist. The bush is held by its upper half. */
static joints joints_at(double time)
{
    double s = ease((time - swing_begin) / (swing_end - swing_begin)), arch = sin(PI * s) * sin(PI * s);
    double lift = time > open_end ? 0.12 * ease((time - open_end) / (duration - open_end)) : 0;
    double grip = bush_height * 0.6;
    joints j = reach_for(reach_from + (reach_to - reach_from) * s,
                         stand_height + (table_height - stand_height) * s + grip + 0.42 * arch + lift, 38 * arch);
    j.turn = radians(turn_from + (turn_to - turn_from) * s);
    j.roll = radians(25) * arch;
    j.tool = radians(180) * s;
    return j;
}

typedef struct rotation {
    double q[4]; /* x, y, z, w */
} rotation;

static rotation after(rotation a, rotation b)
{
    const double *p = a.q, *q = b.q;
    return (rotation){
        {p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1], p[3] * q[1] - p[0] * q[2] + p[1] * q[3] + p[2] * q[0],
         p[3] * q[2] + p[0] * q[1] - p[1] * q[0] + p[2] * q[3], p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]}};
}

static rotation about(int axis, double angle)
{
    rotation r = {{0, 0, 0, cos(angle / 2)}};
    r.q[axis] = sin(angle / 2);
    return r;
}

static void move_along(double at[3], rotation r, double x, double y)
{
    rotation back = {{-r.q[0], -r.q[1], -r.q[2], r.q[3]}}, v = after(after(r, (rotation){{x, y, 0, 0}}), back);
    for (int k = 0; k < 3; k++)
        at[k] += v.q[k];
}

/* Where the bush is while it is held: it stands upright when the tool points down. */
static rotation held_bush(const joints *j, double at[3])
{
    at[0] = at[1] = at[2] = 0;
    rotation r = about(1, j->turn);
    move_along(at, r, shoulder_out, shoulder_height);
    r = after(r, about(2, j->shoulder));
    move_along(at, r, upper_length, 0);
    r = after(r, about(2, j->elbow));
    move_along(at, r, fore_length, 0);
    r = after(after(r, about(0, j->roll)), about(2, j->bend));
    r = after(r, about(0, j->tool));
    move_along(at, r, wrist_length + tool_length + bush_height * 0.6, 0);
    return after(r, about(2, PI / 2));
}

/* --- the clip ------------------------------------------------------------------------------------------- */

enum { KEYS = 91 }; /* sixty a second */

static double opening(double time)
{
    double closed = ease(time / closed_at) - ease((time - open_begin) / (open_end - open_begin));
    return finger_open + (finger_closed - finger_open) * closed;
}

static void swing(clip *c)
{
    static const int axes[] = {1, 2, 2, 0, 2, 0};
    track           *turning[6], *fingers[2];
    c->name = "Swing";
    for (int k = 0; k < 6; k++)
        turning[k] = clip_add(c, 1 + COLUMN + k, "rotation");
    for (int k = 0; k < 2; k++)
        fingers[k] = clip_add(c, 1 + NEAR_FINGER + k, "translation");
    /* The bush is the first part. */
    track *bush_at = clip_add(c, 1 + GROUPS, "translation"), *bush_turn = clip_add(c, 1 + GROUPS, "rotation");
    for (int i = 0; i < KEYS; i++) {
        double   time = duration * i / (KEYS - 1), at[3];
        joints   j = joints_at(time), held = joints_at(fmin(time, open_begin));
        double   angles[] = {j.turn, j.shoulder, j.elbow, j.roll, j.bend, j.tool};
        rotation r = held_bush(&held, at);
        for (int k = 0; k < 6; k++)
            track_angle(turning[k], time, axes[k], angles[k]);
        track_translation(fingers[0], time, 0, opening(time), 0);
        track_translation(fingers[1], time, 0, -opening(time), 0);
        track_translation(bush_at, time, at[0], at[1], at[2]);
        track_rotation(bush_turn, time, r.q);
    }
}

static void animate(glb *g, FILE *json)
{
    static clip clips[1];
    swing(&clips[0]);
    put_clips(g, json, clips, COUNT(clips));
}

static double out(double reach, double degrees, int axis)
{
    return axis == 0 ? reach * cos(radians(degrees)) : -reach * sin(radians(degrees));
}

int main(int count, char **arguments)
{
    if (count != 2)
        return EXIT_FAILURE;
    const model_part parts[] = {
        {"bush",
         AROUND,
         BRASS,
         build_bush,
         {out(reach_from, turn_from, 0), stand_height, out(reach_from, turn_from, 2)}},
        {"base", AROUND, GREY, build_base, {0}},
        {"turret", COLUMN, ORANGE, build_turret, {0}},
        {"shoulder drum", SHOULDER, GREY, build_shoulder, {0}},
        {"link upper", SHOULDER, ORANGE, build_upper, {0}},
        {"link upper stripe", SHOULDER, WHITE, build_upper_stripe, {0}},
        {"elbow drum", ELBOW, GREY, build_elbow, {0}},
        {"link fore", ELBOW, ORANGE, build_fore, {0}},
        {"link fore motors", ELBOW, GREY, build_motors, {0}},
        {"link wrist", ROLL, ORANGE, build_roll, {0}},
        {"wrist", BEND, GREY, build_wrist, {0}},
        {"gripper palm", TOOL, STEEL, build_palm, {0}},
        {"gripper finger near", NEAR_FINGER, BLUE, NULL, {0}, build_finger, 1},
        {"gripper finger far", FAR_FINGER, BLUE, NULL, {0}, build_finger, -1},
        {"stand", AROUND, STEEL, build_stand, {out(reach_from, turn_from, 0), 0, out(reach_from, turn_from, 2)}},
        {"table top", AROUND, WOOD, build_table_top, {out(reach_to, turn_to, 0), 0, out(reach_to, turn_to, 2)}},
        {"table legs", AROUND, GREY, build_table_legs, {out(reach_to, turn_to, 0), 0, out(reach_to, turn_to, 2)}},
        {"floor", AROUND, FLOOR, build_floor, {0}},
    };
    static const model_camera cameras[] = {{"front", {4.2, 2.2, 1.2}, {0.35, 0.68, 0}, 32, 0},
                                           {"above", {2.9, 4.2, 2.1}, {0.4, 0.35, 0}, 32, 0}};
    const model               arm = {"make_arm", "Arm",        1,       materials, MATERIALS,     groups, GROUPS,
                                     parts,      COUNT(parts), animate, cameras,   COUNT(cameras)};
    return model_write(&arm, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
