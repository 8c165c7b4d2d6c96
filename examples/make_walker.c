/* Writes the example of motion capture: make_walker OUT.bvh
 *
 * Two seconds of walking, two cycles of two steps, as sines have it: nobody was captured. Lengths are centimetres, the
 * figure looks along +z and stands in a T when nothing moves it. Legs swing, knees bend and feet roll by the cycle; how
 * high the hips are and how far they get follows from the foot that stands, so that it neither sinks nor slides. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { FRAMES = 61, FRAMES_A_SECOND = 30, FRAMES_A_CYCLE = 30 }; /* the last one is the first one, farther on */
enum { HIPS, SPINE, CHEST, NECK, HEAD };
enum { LEFT_SHOULDER = 5, LEFT_ARM, LEFT_FOREARM, LEFT_HAND, RIGHT_SHOULDER, RIGHT_ARM, RIGHT_FOREARM, RIGHT_HAND };
enum { LEFT_THIGH = 13, LEFT_SHIN, LEFT_FOOT, RIGHT_THIGH, RIGHT_SHIN, RIGHT_FOOT, JOINTS };

typedef struct joint {
    const char *name;
    int         parent;
    double      offset[3];
    const char *order;  /* in which the rotations stand in the file, the last one done first */
    double      end[3]; /* of joints without children */
} joint;

static const joint joints[JOINTS] = {
    [HIPS] = {"Hips", -1, {0, 0, 0}, "YXZ", {0}},
    [SPINE] = {"Spine", HIPS, {0, 10, 0}, "YXZ", {0}},
    [CHEST] = {"Chest", SPINE, {0, 18, -1}, "YXZ", {0}},
    [NECK] = {"Neck", CHEST, {0, 22, 0}, "YXZ", {0}},
    [HEAD] = {"Head", NECK, {0, 9, 2}, "YXZ", {0, 20, 0}},
    [LEFT_SHOULDER] = {"LeftShoulder", CHEST, {4, 17, 0}, "XYZ", {0}},
    [LEFT_ARM] = {"LeftArm", LEFT_SHOULDER, {13, 0, 0}, "XZY", {0}},
    [LEFT_FOREARM] = {"LeftForeArm", LEFT_ARM, {28, 0, 0}, "YXZ", {0}},
    [LEFT_HAND] = {"LeftHand", LEFT_FOREARM, {25, 0, 0}, "YXZ", {17, 0, 0}},
    [RIGHT_SHOULDER] = {"RightShoulder", CHEST, {-4, 17, 0}, "XYZ", {0}},
    [RIGHT_ARM] = {"RightArm", RIGHT_SHOULDER, {-13, 0, 0}, "XZY", {0}},
    [RIGHT_FOREARM] = {"RightForeArm", RIGHT_ARM, {-28, 0, 0}, "YXZ", {0}},
    [RIGHT_HAND] = {"RightHand", RIGHT_FOREARM, {-25, 0, 0}, "YXZ", {-17, 0, 0}},
    [LEFT_THIGH] = {"LeftUpLeg", HIPS, {9, -4, 0}, "XYZ", {0}},
    [LEFT_SHIN] = {"LeftLeg", LEFT_THIGH, {0, -43, 0}, "XYZ", {0}},
    [LEFT_FOOT] = {"LeftFoot", LEFT_SHIN, {0, -42, 0}, "XYZ", {0, -8, 16}},
    [RIGHT_THIGH] = {"RightUpLeg", HIPS, {-9, -4, 0}, "XYZ", {0}},
    [RIGHT_SHIN] = {"RightLeg", RIGHT_THIGH, {0, -43, 0}, "XYZ", {0}},
    [RIGHT_FOOT] = {"RightFoot", RIGHT_SHIN, {0, -42, 0}, "XYZ", {0, -8, 16}},
};
static const double heel[3] = {0, -8, -6}; /* in the foot's axes */

/* Degrees about x, y and z for each joint, and where the hips are. */
typedef struct figure {
    double angles[JOINTS][3], at[3];
} figure;

/* --- where everything is -------------------------------------------------------------------------------- */

typedef struct frame {
    double turn[3][3], at[3];
} frame;

static void turn_further(double m[3][3], int axis, double degrees)
{
    const double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    const int    next = (axis + 1) % 3, last = (axis + 2) % 3;
    for (int row = 0; row < 3; row++) {
        const double a = m[row][next], b = m[row][last];
        m[row][next] = a * c + b * s;
        m[row][last] = b * c - a * s;
    }
}

static void move(const frame *f, const double p[3], double out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = f->at[row] + f->turn[row][0] * p[0] + f->turn[row][1] * p[1] + f->turn[row][2] * p[2];
}

static void find_frames(const figure *g, frame frames[JOINTS])
{
    for (int i = 0; i < JOINTS; i++) {
        frame *f = &frames[i];
        if (joints[i].parent < 0) {
            *f = (frame){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {g->at[0], g->at[1], g->at[2]}};
        } else {
            memcpy(f->turn, frames[joints[i].parent].turn, sizeof f->turn);
            move(&frames[joints[i].parent], joints[i].offset, f->at);
        }
        for (int k = 0; k < 3; k++)
            turn_further(f->turn, joints[i].order[k] - 'X', g->angles[i][joints[i].order[k] - 'X']);
    }
}

/* The lowest point of a foot's sole. */
static void find_sole(const figure *g, int foot, double out[3])
{
    frame  frames[JOINTS];
    double back[3], front[3];
    find_frames(g, frames);
    move(&frames[foot], heel, back);
    move(&frames[foot], joints[foot].end, front);
    memcpy(out, back[1] < front[1] ? back : front, sizeof back);
}

/* --- the walk ------------------------------------------------------------------------------------------- */

/* 1 at `middle` of a cycle, 0 half a cycle away; the higher the power, the narrower. */
static double bump(double cycle, double middle, double power)
{
    return pow(0.5 + 0.5 * cos(2 * PI * (cycle - middle)), power);
}

/* A leg whose heel comes down at 0. Turning about +x brings it backwards. */
static void pose_leg(figure *g, int thigh, double cycle)
{
    const double hip = -6 - 23 * cos(2 * PI * cycle) - 5 * bump(cycle, 0.8, 3);
    const double knee = 4 + 13 * bump(cycle, 0.14, 8) + 56 * bump(cycle, 0.72, 5);
    const double pitch = -16 * bump(cycle, 0.98, 12) + 34 * bump(cycle, 0.62, 12); /* of the sole, toes down */
    g->angles[thigh][0] = hip;
    g->angles[thigh + 1][0] = knee;
    g->angles[thigh + 2][0] = pitch - hip - knee;
}

/* `side`: 1 of the left arm, −1 of the right one. An arm swings with the other leg. */
static void pose_arm(figure *g, int shoulder, double side, double cycle)
{
    const double swing = cos(2 * PI * cycle);
    g->angles[shoulder][1] = -4 * side * swing;
    g->angles[shoulder + 1][0] = 4 - 22 * swing;
    g->angles[shoulder + 1][2] = -78 * side;
    g->angles[shoulder + 2][1] = -side * (22 + 13 * swing);
    g->angles[shoulder + 3][1] = -6 * side;
}

static void pose(figure *g, double cycle)
{
    const double turn = cos(2 * PI * cycle), step = cos(4 * PI * cycle);
    memset(g, 0, sizeof *g);
    pose_leg(g, LEFT_THIGH, cycle);
    pose_leg(g, RIGHT_THIGH, cycle + 0.5);
    pose_arm(g, LEFT_SHOULDER, 1, cycle + 0.5);
    pose_arm(g, RIGHT_SHOULDER, -1, cycle);
    /* The side of the leg that is in front goes along with it, and the chest turns against. */
    g->angles[HIPS][0] = 2;
    g->angles[HIPS][1] = -5 * turn;
    g->angles[HIPS][2] = -2.5 * sin(2 * PI * cycle);
    g->angles[SPINE][0] = 1 + step;
    g->angles[SPINE][1] = 5 * turn;
    g->angles[SPINE][2] = 2.5 * sin(2 * PI * cycle);
    g->angles[CHEST][1] = 5 * turn;
    g->angles[NECK][1] = -2.5 * turn;
    g->angles[HEAD][0] = -2 - step;
    g->angles[HEAD][1] = -2.5 * turn;
    g->at[0] = 1.8 * sin(2 * PI * cycle);
}

/* Stands the figure on the ground and says which foot it stands on. */
static int stand(figure *g)
{
    double left[3], right[3];
    find_sole(g, LEFT_FOOT, left);
    find_sole(g, RIGHT_FOOT, right);
    g->at[1] -= left[1] < right[1] ? left[1] : right[1];
    return left[1] < right[1] ? LEFT_FOOT : RIGHT_FOOT;
}

/* How far the point goes back, seen from the hips, that the figure stands on at `from`. */
static double step_between(double from, double to)
{
    enum { PIECES = 40 };
    double way = 0;
    for (int i = 0; i < PIECES; i++) {
        const double a = from + (to - from) * i / PIECES, b = from + (to - from) * (i + 1) / PIECES;
        figure       before, after;
        frame        frames[2][JOINTS];
        double       back[2][3], front[2][3];
        pose(&before, a);
        pose(&after, b);
        const int foot = stand(&before);
        find_frames(&before, frames[0]);
        find_frames(&after, frames[1]);
        for (int k = 0; k < 2; k++) {
            move(&frames[k][foot], heel, back[k]);
            move(&frames[k][foot], joints[foot].end, front[k]);
        }
        way += back[0][1] < front[0][1] ? back[0][2] - back[1][2] : front[0][2] - front[1][2];
    }
    return way;
}

/* --- the file ------------------------------------------------------------------------------------------- */

static void indent(FILE *f, int level)
{
    for (int i = 0; i < level; i++)
        fputc('\t', f);
}

static void put_offset(FILE *f, int level, const double o[3])
{
    indent(f, level);
    fprintf(f, "OFFSET %.2f %.2f %.2f\n", o[0], o[1], o[2]);
}

static void put_joint(FILE *f, int number, int level)
{
    const joint *j = &joints[number];
    bool         leaf = true;
    indent(f, level);
    fprintf(f, "%s %s\n", level ? "JOINT" : "ROOT", j->name);
    indent(f, level);
    fprintf(f, "{\n");
    put_offset(f, level + 1, j->offset);
    indent(f, level + 1);
    fprintf(f, level ? "CHANNELS 3" : "CHANNELS 6 Xposition Yposition Zposition");
    fprintf(f, " %crotation %crotation %crotation\n", j->order[0], j->order[1], j->order[2]);
    for (int i = 0; i < JOINTS; i++)
        if (joints[i].parent == number) {
            put_joint(f, i, level + 1);
            leaf = false;
        }
    if (leaf) {
        indent(f, level + 1);
        fprintf(f, "End Site\n");
        indent(f, level + 1);
        fprintf(f, "{\n");
        put_offset(f, level + 2, j->end);
        indent(f, level + 1);
        fprintf(f, "}\n");
    }
    indent(f, level);
    fprintf(f, "}\n");
}

static void put_number(FILE *f, double value)
{
    const double rounded = round(value * 1000) / 1000;
    fprintf(f, "%.3f ", rounded == 0 ? 0 : rounded); /* no −0 */
}

/* The numbers of a joint and of what is below it, as put_joint has them. */
static void put_angles(FILE *f, const figure *g, int number)
{
    for (int k = 0; k < 3; k++)
        put_number(f, g->angles[number][joints[number].order[k] - 'X']);
    for (int i = 0; i < JOINTS; i++)
        if (joints[i].parent == number)
            put_angles(f, g, i);
}

static void put_motion(FILE *f)
{
    double way = 0;
    fprintf(f, "MOTION\nFrames: %d\nFrame Time: %.7f\n", FRAMES, 1.0 / FRAMES_A_SECOND);
    for (int i = 0; i < FRAMES; i++) {
        const double cycle = (double)i / FRAMES_A_CYCLE;
        figure       g;
        pose(&g, cycle);
        stand(&g);
        g.at[2] = way;
        way += step_between(cycle, cycle + 1.0 / FRAMES_A_CYCLE);
        for (int k = 0; k < 3; k++)
            put_number(f, g.at[k]);
        put_angles(f, &g, HIPS);
        fputc('\n', f);
    }
}

int main(int count, char **arguments)
{
    FILE *f = count == 2 ? fopen(arguments[1], "wb") : NULL;
    if (!f)
        return EXIT_FAILURE;
    fprintf(f, "HIERARCHY\n");
    put_joint(f, HIPS, 0);
    put_motion(f);
    return fclose(f) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
