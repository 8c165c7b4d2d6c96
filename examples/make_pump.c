/* Writes the example model of a gear pump: make_pump OUT.glb
 *
 * Every part is one closed shell (solid.h), and no part cuts into another: what fits has a clearance of some
 * hundredths. Threads are left out, as on drawings. Lengths are millimetres; the shafts run along z, the driving end is
 * at +z, +y is up. The inlet is at +x, the outlet at −x. */
#include "model.h"

#include <math.h>
#include <stdlib.h>

enum { ROUND = 64, SMALL_ROUND = 40 };

/* --- dimensions that parts share ------------------------------------------------------------------------ */

enum { TEETH = 13, BODY_ARC = 48, CHAMBER_ARC = 72 };

static const double module = 3;
static const double axle = 19.5; /* the shafts are at y = ±axle: half of module · TEETH */
static const double flange_radius = 37, body_radius = 31;
static const double chamber_radius = 22.55;
static const double pocket = 8; /* half the height of the flat walls in which the ports open */
static const double joint = 32; /* housing up to here, then the gasket */
static const double cover_back = 33, cover_front = 50;
static const double bolt_circle = 29, bolt_seat = 49;
static const double port_z = 8.5;
static const double valve_z = -13;   /* the relief valve lies between the bearings */
static const double valve_seat = 11; /* the seat is the cone r = x + valve_seat */
static const double ball_radius = 4, plug_tip = 21.5;
static const double fit = 0.03; /* clearance of parts that sit tight */

static void bolt_position(int index, double at[2])
{
    double angle = (30 + 60 * index) * PI / 180;
    at[0] = bolt_circle * cos(angle);
    at[1] = bolt_circle * sin(angle) + (index < 3 ? axle : -axle);
}

static double pocket_angle(double radius)
{
    return asin((axle - pocket) / radius) * 180 / PI;
}

static double ball_position(void)
{
    return -valve_seat + (ball_radius + fit) * sqrt(2);
}

/* --- housing -------------------------------------------------------------------------------------------- */

/* The body's rings from the back: its edge, its wall with the foot in the middle, then the flange. Rings 1 to 4
 * bound the sides. */
enum { BODY_RINGS = 8, WALL_FIRST = 1, FOOT_BACK = 2, FOOT_FRONT = 3, WALL_LAST = 4 };

enum { SIDE_LEFT = BODY_ARC, LOWER_ARC = BODY_ARC + 1, SIDE_RIGHT = 2 * BODY_ARC + 1 };

/* One port from the outside of its boss into the chamber. `base` is where the boss stands on the side of the body,
 * `mouth` the hole in the chamber's wall. */
static void port(mesh *m, direction side, ring *base, ring *mouth)
{
    const frame f = {{0, 0, port_z}, side};
    double      wall = chamber_radius * cos(pocket_angle(chamber_radius) * PI / 180);
    LATHE(m, &f, ROUND, base, mouth, {body_radius, 12.5}, {39, 12.5}, {40, 11.5}, {40, 9.5}, {39, 8.5}, {28, 8.5},
          {26.5, 7}, {wall, 7});
}

/* A length of a bore along x whose wall has a hole towards +z, drilled from the floor of the chamber. The wall is a
 * GRID of which a window is left out; the drilled hole's edge has as many points as the window's. */
static ring branch(mesh *m, const frame *f, const ring *start, double radius, double middle, double half, double drill,
                   int wide, ring *mouth)
{
    enum { STEPS = 6 };
    const frame down = {.along = FRONT};
    int         first = SMALL_ROUND / 4 - wide, last = SMALL_ROUND / 4 + wide;
    ring        rows[STEPS + 1], window = {0};
    outline     o = circle(0, 0, radius, SMALL_ROUND), edge = {0}, top = {0};
    for (int j = 0; j <= STEPS; j++) {
        rows[j] = put_ring(m, f, &o, middle + half - 2 * half * j / STEPS);
        if (j == 0)
            sew(m, start, &rows[0]);
        else
            sew_columns(m, &rows[j - 1], &rows[j], last, SMALL_ROUND - 2 * wide);
    }
    for (int i = last; i > first; i--)
        window.at[window.count++] = rows[0].at[i];
    for (int j = 0; j < STEPS; j++)
        window.at[window.count++] = rows[j].at[first];
    for (int i = first; i < last; i++)
        window.at[window.count++] = rows[STEPS].at[i];
    for (int j = STEPS; j > 0; j--)
        window.at[window.count++] = rows[j].at[last];
    for (int i = 0; i < window.count; i++) {
        const int32_t *at = m->points[window.at[i]].at;
        double         angle = atan2(at[1] / GRID, at[0] / GRID - middle);
        double         y = drill * sin(angle);
        add_point(&edge, middle + drill * cos(angle), y);
        edge.at[i][2] = f->origin[2] + sqrt(radius * radius - y * y);
        add_point(&top, middle + drill * cos(angle), y);
    }
    ring low = put_ring(m, &down, &edge, 0);
    *mouth = put_ring(m, &down, &top, 0);
    sew(m, mouth, &low);
    sew(m, &low, &window);
    return rows[STEPS];
}

/* The relief valve's bore from the right side of the body: spring room, seat, orifice. Each has a way into the
 * chamber, one on the inlet's side, one on the outlet's. */
static void valve_bore(mesh *m, ring *base, ring mouths[2])
{
    const frame f = {{0, 0, valve_z}, RIGHT};
    outline     o = circle(0, 0, 5, SMALL_ROUND);
    *base = put_ring(m, &f, &o, body_radius);
    ring capacity = branch(m, &f, base, 5, 15.5, 2.6, 2, 4, &mouths[0]);
    ring upper = put_ring(m, &f, &o, 5 - valve_seat);
    o = circle(0, 0, 2.6, SMALL_ROUND);
    ring lower = put_ring(m, &f, &o, 2.6 - valve_seat);
    sew(m, &capacity, &upper);
    sew(m, &upper, &lower);
    ring orifice = branch(m, &f, &lower, 2.6, -15.5, 2, 1.6, 5, &mouths[1]);
    ring end;
    LATHE(m, &f, SMALL_ROUND, &end, NULL, {-19, 2.6}, {-20.5, 0});
    sew(m, &orifice, &end);
}

/* What the foot adds to the body's outline, from its left side round the bottom to its right side; the ends are the
 * body's. */
static outline foot_outline(void)
{
    outline o = {0};
    add_point(&o, -body_radius, -axle);
    add_arc(&o, -37, -50, 6, 0, -90, 8);
    add_arc(&o, -53, -59, 3, 90, 180, 6);
    add_point(&o, -56, -66);
    add_point(&o, -24, -66);
    add_point(&o, -24, -64.5);
    for (int i = o.count - 1; i >= 0; i--)
        add_point(&o, -o.at[i][0], o.at[i][1]);
    return o;
}

/* The foot between the body's rings `back` and `front`, whose lower arcs it replaces. */
static void foot(mesh *m, const ring *back, const ring *front, double from, double to)
{
    const frame f = {.along = FRONT};
    outline     o = foot_outline();
    ring        ends[2] = {{0}, {0}};
    const ring *body[2] = {back, front};
    int         half = o.count / 2, top = 9, pad = half - 3; /* columns of the left half that are flat with holes */
    for (int e = 0; e < 2; e++) {
        ends[e].count = o.count;
        for (int i = 0; i < o.count; i++)
            ends[e].at[i] = i == 0             ? body[e]->at[LOWER_ARC]
                            : i == o.count - 1 ? body[e]->at[SIDE_RIGHT]
                                               : put_point(m, &f, o.at[i][0], o.at[i][1], e ? to : from);
        ring face = ends[e];
        for (int i = SIDE_RIGHT - 1; i > LOWER_ARC; i--)
            face.at[face.count++] = body[e]->at[i];
        cap(m, e ? FRONT : BACK, &face, NULL, 0);
    }
    for (int c = 0; c < o.count - 1; c++) {
        int mirrored = o.count - 2 - c, kind = c < half ? c : mirrored;
        if (kind != top && kind != pad)
            sew_columns(m, &ends[0], &ends[1], c, 1);
    }
    for (int side = -1; side <= 1; side += 2) {
        ring upper[2], lower[2];
        for (int h = 0; h < 2; h++) {
            const frame hole = {{46 * side, 0, h ? to - 8 : from + 8}, UP};
            LATHE(m, &hole, SMALL_ROUND, &upper[h], &lower[h], {-56, 4.5}, {-66, 4.5});
        }
        for (int level = 0; level < 2; level++) {
            int  c = level ? top : pad, i = side < 0 ? c : o.count - 2 - c;
            ring face = {4, {ends[0].at[i], ends[0].at[i + 1], ends[1].at[i + 1], ends[1].at[i]}};
            cap(m, level ? UP : DOWN, &face, level ? upper : lower, 2);
        }
    }
}

/* A flat side of the body with what opens in it. */
static void body_side(mesh *m, const ring rings[BODY_RINGS], direction facing, const ring *holes, int hole_count)
{
    ring face = {0};
    int  lower = facing == RIGHT ? SIDE_RIGHT : LOWER_ARC, upper = facing == RIGHT ? 0 : SIDE_LEFT;
    for (int k = WALL_FIRST; k <= WALL_LAST; k++)
        face.at[face.count++] = rings[k].at[lower];
    for (int k = WALL_LAST; k >= WALL_FIRST; k--)
        face.at[face.count++] = rings[k].at[upper];
    cap(m, facing, &face, holes, hole_count);
}

static void chamber(mesh *m, const ring mouths[2], const ring drilled[2], ring *open)
{
    const frame f = {.along = FRONT};
    outline     o = double_round(axle, chamber_radius, pocket_angle(chamber_radius), CHAMBER_ARC);
    ring        floor = put_ring(m, &f, &o, 0), holes[4] = {drilled[0], drilled[1]};
    *open = put_ring(m, &f, &o, joint);
    sew_columns(m, open, &floor, 0, CHAMBER_ARC);
    sew_columns(m, open, &floor, CHAMBER_ARC + 1, CHAMBER_ARC);
    for (int side = 0; side < 2; side++) {
        int  i = side ? CHAMBER_ARC : 2 * CHAMBER_ARC + 1, j = (i + 1) % o.count;
        ring face = {4, {floor.at[i], floor.at[j], open->at[j], open->at[i]}};
        cap(m, side ? RIGHT : LEFT, &face, &mouths[side], 1);
        const frame bearing = {{0, side ? -axle : axle, 0}, FRONT};
        ring        bottom;
        LATHE(m, &bearing, ROUND, &holes[2 + side], &bottom, {0, 12}, {-20.5, 12}, {-20.5, 7.5}, {-22, 6}, {-22, 0});
    }
    cap(m, FRONT, &floor, holes, 4);
}

static void build_housing(mesh *m)
{
    static const double shape[BODY_RINGS][2] = {{-28, 29}, {-26, 31}, {-16, 31}, {16, 31},
                                                {22, 31},  {22, 36},  {23, 37},  {32, 37}};
    const frame         f = {.along = FRONT};
    ring                rings[BODY_RINGS], right[2], left, mouths[2], drilled[2], front[7], back[2];
    for (int k = 0; k < BODY_RINGS; k++) {
        outline o = double_round(axle, shape[k][1], 0, BODY_ARC);
        rings[k] = put_ring(m, &f, &o, shape[k][0]);
        bool wall = k > WALL_FIRST && k <= WALL_LAST;
        if (wall)
            sew_columns(m, &rings[k - 1], &rings[k], 0, BODY_ARC);
        if (wall && k != FOOT_FRONT)
            sew_columns(m, &rings[k - 1], &rings[k], LOWER_ARC, BODY_ARC);
        if (!wall && k > 0)
            sew(m, &rings[k - 1], &rings[k]);
    }
    for (int k = 0; k < 2; k++) {
        const frame bearing = {{0, k ? -axle : axle, 0}, BACK};
        LATHE(m, &bearing, ROUND, &back[k], NULL, {28, 16}, {29.5, 16}, {30.5, 15}, {30.5, 0});
    }
    cap(m, BACK, &rings[0], back, 2);
    foot(m, &rings[FOOT_BACK], &rings[FOOT_FRONT], shape[FOOT_BACK][0], shape[FOOT_FRONT][0]);
    port(m, RIGHT, &right[0], &mouths[0]);
    port(m, LEFT, &left, &mouths[1]);
    valve_bore(m, &right[1], drilled);
    body_side(m, rings, RIGHT, right, 2);
    body_side(m, rings, LEFT, &left, 1);
    chamber(m, mouths, drilled, &front[0]);
    for (int b = 0; b < 6; b++) {
        double at[2];
        bolt_position(b, at);
        const frame hole = {{at[0], at[1], 0}, FRONT};
        LATHE(m, &hole, SMALL_ROUND, &front[1 + b], NULL, {joint, 3.6}, {joint - 0.5, 3.06}, {25, 3.06}, {23.4, 0});
    }
    cap(m, FRONT, &rings[BODY_RINGS - 1], front, 7);
}

/* --- cover and gasket ----------------------------------------------------------------------------------- */

static void build_gasket(mesh *m)
{
    double  radius = chamber_radius + 0.1;
    outline outer = double_round(axle, flange_radius - 0.1, 0, BODY_ARC), holes[7];
    holes[0] = double_round(axle, radius, pocket_angle(radius), CHAMBER_ARC);
    for (int b = 0; b < 6; b++) {
        double at[2];
        bolt_position(b, at);
        holes[1 + b] = circle(at[0], at[1], 3.5, SMALL_ROUND);
    }
    extrude(m, &outer, holes, 7, joint + fit, cover_back - fit);
}

static void build_cover(mesh *m)
{
    const frame         f = {.along = FRONT}, drive = {{0, axle, 0}, FRONT}, idler = {{0, -axle, 0}, FRONT};
    static const double heights[3] = {cover_back, cover_front - 1.2, cover_front};
    ring                rings[3], back[8], front[8];
    for (int k = 0; k < 3; k++) {
        outline o = double_round(axle, k < 2 ? flange_radius : flange_radius - 1.2, 0, BODY_ARC);
        rings[k] = put_ring(m, &f, &o, heights[k]);
        if (k > 0)
            sew(m, &rings[k - 1], &rings[k]);
    }
    /* From the boss through the seal's room and the bearing; the other bearing is blind. */
    LATHE(m, &drive, ROUND, &front[0], &back[0], {cover_front, 20}, {58.5, 20}, {60, 18.5}, {60, 14.8}, {59.2, 14},
          {49, 14}, {49, 9.5}, {46, 9.5}, {46, 12}, {cover_back, 12});
    LATHE(m, &idler, ROUND, &front[1], NULL, {cover_front, 15}, {52, 15}, {53, 14}, {53, 0});
    LATHE(m, &idler, ROUND, NULL, &back[1], {47.5, 0}, {47.5, 6}, {46, 7.5}, {46, 12}, {cover_back, 12});
    for (int b = 0; b < 6; b++) {
        double at[2];
        bolt_position(b, at);
        const frame hole = {{at[0], at[1], 0}, FRONT};
        LATHE(m, &hole, SMALL_ROUND, &front[2 + b], &back[2 + b], {cover_front, 6.4}, {bolt_seat, 6.4},
              {bolt_seat, 3.8}, {bolt_seat - 0.5, 3.3}, {cover_back, 3.3});
    }
    cap(m, BACK, &rings[0], back, 8);
    cap(m, FRONT, &rings[2], front, 8);
}

/* --- bolts ---------------------------------------------------------------------------------------------- */

/* A hexagon across flats, with points along its sides. Its height falls off outside of `flat`, the way a turned
 * chamfer cuts the corners of a bolt's head. */
static outline hexagon(double across, double flat)
{
    outline o = {0};
    for (int i = 0; i < 48; i++) {
        double angle = i * PI / 24, side = fmod(i, 8) * PI / 24 - PI / 6, radius = across / 2 / cos(side);
        add_point(&o, radius * cos(angle), radius * sin(angle));
        o.at[i][2] = flat > 0 ? -(radius - flat) * 0.65 : 0; /* steeper than 30°, so that it shows as an edge */
    }
    return o;
}

/* The head stands on t = 0, the shank goes down from there. */
static void bolt(mesh *m, const frame *f, double radius, double length, double across, double head)
{
    ring   shank;
    double flat = across / 2 * 0.95;
    LATHE(m, f, SMALL_ROUND, NULL, &shank, {-length, 0}, {-length, radius * 0.85}, {-length + radius * 0.3, radius},
          {0, radius});
    outline o = hexagon(across, 0);
    ring    low = put_ring(m, f, &o, 0);
    o = hexagon(across, flat);
    ring high = put_ring(m, f, &o, head);
    o = circle(0, 0, flat, o.count);
    ring top = put_ring(m, f, &o, head);
    cap(m, f->along == FRONT ? BACK : LEFT, &low, &shank, 1);
    sew(m, &low, &high);
    sew(m, &high, &top);
    cap(m, f->along, &top, NULL, 0);
}

static void build_bolt(mesh *m)
{
    bolt(m, &(frame){.along = FRONT}, 3, 22, 10, 4);
}

static void build_plug(mesh *m)
{
    bolt(m, &(frame){.along = RIGHT}, 4.97, body_radius - plug_tip, 13, 5);
}

/* --- shafts, keys, gears, coupling ---------------------------------------------------------------------- */

enum { SHAFT_ARC = 60, SLOT_ARC = 6, SLOT_KEEPS = SHAFT_ARC + 1 };

/* A circle with points where a keyway's edges are. The first SLOT_KEEPS points are the same in keyed_round. */
static outline round_for_key(double radius, double half)
{
    outline o = {0};
    double  gap = asin(half / radius) * 180 / PI;
    add_arc(&o, 0, 0, radius, 90 + gap, 450 - gap, SHAFT_ARC);
    for (int i = 1; i < SLOT_ARC; i++) {
        double angle = (90 - gap + 2 * gap * i / SLOT_ARC) * PI / 180;
        add_point(&o, radius * cos(angle), radius * sin(angle));
    }
    return o;
}

/* The same with the keyway: into the shaft when `bottom` is less than the radius, out into the hub when it is more. */
static outline keyed_round(double radius, double half, double bottom)
{
    outline o = round_for_key(radius, half);
    o.count = SLOT_KEEPS;
    add_point(&o, half, bottom);
    add_point(&o, -half, bottom);
    return o;
}

/* The end of a keyway: what the round ring has and the keyed one has not. */
static ring keyway_end(mesh *m, direction facing, const frame *f, const ring *whole, const outline *keyed, double t)
{
    ring r = {.count = keyed->count}, face = {0};
    for (int i = 0; i < keyed->count; i++)
        r.at[i] = i < SLOT_KEEPS ? whole->at[i] : put_point(m, f, keyed->at[i][0], keyed->at[i][1], t);
    for (int i = SLOT_KEEPS - 1; i <= whole->count; i++)
        face.at[face.count++] = whole->at[i % whole->count];
    face.at[face.count++] = r.at[SLOT_KEEPS + 1];
    face.at[face.count++] = r.at[SLOT_KEEPS];
    cap(m, facing, &face, NULL, 0);
    return r;
}

/* A keyway from where the shaft has got to; returns the ring behind it. */
static ring keyway(mesh *m, const frame *f, const ring *start, double radius, double half, double bottom, double from,
                   double to)
{
    outline whole = round_for_key(radius, half), keyed = keyed_round(radius, half, bottom);
    ring    first = keyway_end(m, FRONT, f, start, &keyed, from);
    ring    end = put_ring(m, f, &whole, to);
    ring    last = keyway_end(m, BACK, f, &end, &keyed, to);
    sew(m, &first, &last);
    return end;
}

static const double key_half = 2.5;

static void build_drive_shaft(mesh *m)
{
    static const double start[][2] = {{-19.5, 7}, {-18.5, 8}, {3.9, 8}}, middle[][2] = {{61, 8}, {62, 7}, {68, 7}};
    const frame         f = {.along = FRONT};
    ring                at = {0};
    for (int k = 0; k < 3; k++) {
        outline o = round_for_key(start[k][1], key_half);
        ring    next = put_ring(m, &f, &o, start[k][0]);
        if (k == 0)
            cap(m, BACK, &next, NULL, 0);
        else
            sew(m, &at, &next);
        at = next;
    }
    at = keyway(m, &f, &at, 8, key_half, 5, 3.9, 29.1);
    for (int k = 0; k < 3; k++) {
        outline o = round_for_key(middle[k][1], key_half);
        ring    next = put_ring(m, &f, &o, middle[k][0]);
        sew(m, &at, &next);
        at = next;
    }
    at = keyway(m, &f, &at, 7, key_half, 4, 68, 86);
    outline o = round_for_key(6, key_half);
    ring    last = put_ring(m, &f, &o, 87);
    sew(m, &at, &last);
    cap(m, FRONT, &last, NULL, 0);
}

static void build_idler_shaft(mesh *m)
{
    const frame f = {.along = FRONT};
    LATHE(m, &f, ROUND, NULL, NULL, {-19.5, 0}, {-19.5, 7}, {-18.5, 8}, {44, 8}, {45, 7}, {45, 0});
}

static void build_gear_key(mesh *m)
{
    outline o = rectangle(-key_half + fit, 5 + fit, key_half - fit, 10);
    extrude(m, &o, NULL, 0, 4, 29);
}

static void build_coupling_key(mesh *m)
{
    outline o = rectangle(-key_half + fit, 4 + fit, key_half - fit, 9);
    extrude(m, &o, NULL, 0, 68.1, 84.9);
}

/* How far a flank is from the middle of its tooth at some radius, as an angle. Below the base circle it is radial. */
static double half_tooth(double radius)
{
    double pitch = module * TEETH / 2, pressure = 20 * PI / 180, base = pitch * cos(pressure), backlash = 0.12;
    double roll = radius > base ? acos(base / radius) : 0;
    return (PI * module / 2 - backlash) / 2 / pitch + (tan(pressure) - pressure) - (tan(roll) - roll);
}

static void add_polar(outline *o, double radius, double angle)
{
    add_point(o, radius * cos(angle), radius * sin(angle));
}

/* Involute teeth; a tooth points down and, as their number is odd, a gap up, so that two of these mesh one over the
 * other. */
static outline gear_outline(void)
{
    enum { FLANK = 8, FILLET = 4 };
    const double pitch = module * TEETH / 2, root = pitch - 1.25 * module, tip = pitch + module, round = 1.1;
    outline      o = {0};
    for (int k = 0; k < TEETH; k++) {
        double middle = -PI / 2 + 2 * PI * k / TEETH, foot = half_tooth(root), next = middle + 2 * PI / TEETH;
        for (int i = 0; i < FLANK; i++) {
            double radius = root + round + (tip - root - round) * i / FLANK;
            add_polar(&o, radius, middle - half_tooth(radius));
        }
        for (int i = -1; i <= 1; i++)
            add_polar(&o, tip, middle + i * half_tooth(tip));
        for (int i = FLANK - 1; i >= 0; i--) {
            double radius = root + round + (tip - root - round) * i / FLANK;
            add_polar(&o, radius, middle + half_tooth(radius));
        }
        /* Fillet, root, fillet: a curve that leaves the flank radially and arrives along the root circle. */
        for (int i = 1; i <= FILLET; i++) {
            double s = (double)i / FILLET, radius = root + round * (1 - s) * (1 - s);
            add_polar(&o, radius, middle + foot + round / root * s * s);
        }
        for (int i = FILLET; i >= 1; i--) {
            double s = (double)i / FILLET, radius = root + round * (1 - s) * (1 - s);
            add_polar(&o, radius, next - foot - round / root * s * s);
        }
    }
    return o;
}

static void build_drive_gear(mesh *m)
{
    outline o = gear_outline(), bore = keyed_round(8 + fit, key_half, 10 + fit);
    extrude(m, &o, &bore, 1, 0.05, cover_back - 0.05);
}

static void build_idler_gear(mesh *m)
{
    outline o = gear_outline(), bore = circle(0, 0, 8 + fit, ROUND);
    extrude(m, &o, &bore, 1, 0.05, cover_back - 0.05);
}

/* Half a claw coupling: hub, flange and three claws. */
static void build_coupling(mesh *m)
{
    const frame f = {.along = FRONT};
    outline     o = keyed_round(7 + fit, key_half, 9 + fit);
    ring        back = put_ring(m, &f, &o, 67), front = put_ring(m, &f, &o, 88), low, high, holes[4] = {front};
    LATHE(m, &f, ROUND, &low, &high, {67, 12}, {68, 13}, {78, 13}, {78, 21}, {79, 22}, {87, 22}, {88, 21});
    sew(m, &front, &back);
    cap(m, BACK, &low, &back, 1);
    for (int k = 0; k < 3; k++) {
        outline claw = {0};
        add_arc(&claw, 0, 0, 20, 120 * k + 65, 120 * k + 115, 16);
        add_arc(&claw, 0, 0, 11, 120 * k + 115, 120 * k + 65, 16);
        holes[1 + k] = put_ring(m, &f, &claw, 88);
        ring top = put_ring(m, &f, &claw, 98);
        sew(m, &holes[1 + k], &top);
        cap(m, FRONT, &top, NULL, 0);
    }
    cap(m, FRONT, &high, holes, 4);
}

/* --- bearings, seal, valve ------------------------------------------------------------------------------ */

static void bush(mesh *m, double length)
{
    const frame  f = {.along = FRONT};
    ring         first, last;
    const double in = 8 + fit, out = 12 - fit, edge = 0.6;
    LATHE(m, &f, ROUND, &first, &last, {0, out - edge}, {edge, out}, {length - edge, out}, {length, out - edge},
          {length, in + edge}, {length - edge, in}, {edge, in}, {0, in + edge});
    sew(m, &last, &first);
}

static void build_long_bush(mesh *m)
{
    bush(m, 20);
}

static void build_short_bush(mesh *m)
{
    bush(m, 12.5);
}

/* A lip seal: the lip bends towards the pressure. */
static void build_seal(mesh *m)
{
    const frame f = {.along = FRONT};
    ring        first, last;
    LATHE(m, &f, ROUND, &first, &last, {0, 14 - fit}, {7, 14 - fit}, {7, 9.2}, {5.2, 9.2}, {3.6, 8 + fit}, {3, 8 + fit},
          {1.2, 9}, {1.2, 10.4}, {4.6, 10.8}, {4.6, 12.6}, {0, 12.6});
    sew(m, &last, &first);
}

static void build_ball(mesh *m)
{
    enum { STACKS = 24 };
    double profile[STACKS + 1][2] = {{-ball_radius, 0}, [STACKS] = {ball_radius, 0}};
    for (int i = 1; i < STACKS; i++) {
        profile[i][0] = -ball_radius * cos(PI * i / STACKS);
        profile[i][1] = ball_radius * sin(PI * i / STACKS);
    }
    lathe(m, &(frame){.along = RIGHT}, (const double(*)[2])profile, STACKS + 1, SMALL_ROUND, NULL, NULL);
}

static const double coil = 3.2, wire = 0.6, turns = 8;

/* How far along x the spring's wire is after so many turns: the first and the last turn lie close, as ground
 * springs have it. */
static double spring_rise(double turn)
{
    double from = sqrt(pow(ball_radius + wire + fit, 2) - coil * coil), to = plug_tip - ball_position() - wire - fit;
    double tight = 2 * wire + 0.1, rise = (to - from - 2 * tight) / (turns - 2);
    return from + (turn < 1           ? tight * turn
                   : turn > turns - 1 ? to - from - tight * (turns - turn)
                                      : tight + rise * (turn - 1));
}

/* Its origin is the ball's middle. */
static void build_spring(mesh *m)
{
    enum { STEPS = 32, AROUND = 12 };
    const frame f = {.along = RIGHT};
    ring        before = {0};
    int         rows = STEPS * (int)turns;
    for (int k = 0; k <= rows; k++) {
        double at = (double)k / STEPS, angle = 2 * PI * at, x = spring_rise(at);
        double slope = atan2((spring_rise(at + 0.01) - spring_rise(at - 0.01)) / 0.02, 2 * PI * coil);
        ring   here = {.count = AROUND};
        for (int i = 0; i < AROUND; i++) {
            double part = 2 * PI * i / AROUND, out = coil + wire * cos(part), side = wire * sin(part);
            here.at[i] = put_point(m, &f, out * cos(angle) - side * sin(slope) * -sin(angle),
                                   out * sin(angle) - side * sin(slope) * cos(angle), x + side * cos(slope));
        }
        for (int i = 2; i < AROUND && k == 0; i++)
            put_triangle(m, here.at[0], here.at[i - 1], here.at[i]);
        for (int i = 2; i < AROUND && k == rows; i++)
            put_triangle(m, here.at[0], here.at[i], here.at[i - 1]);
        if (k > 0)
            sew(m, &here, &before);
        before = here;
    }
}

/* --- the assembly --------------------------------------------------------------------------------------- */

typedef enum material { CASTING, COVER, STEEL, GEAR, BRASS, RUBBER, IRON, ZINC, FIBRE, MATERIALS } material;

static const model_material materials[MATERIALS] = {
    [CASTING] = {"Casting", {0.110, 0.180, 0.270}}, [COVER] = {"Machined casting", {0.190, 0.270, 0.350}},
    [STEEL] = {"Steel", {0.520, 0.540, 0.570}},     [GEAR] = {"Hardened steel", {0.350, 0.370, 0.410}},
    [BRASS] = {"Brass", {0.600, 0.390, 0.120}},     [RUBBER] = {"Rubber", {0.025, 0.025, 0.030}},
    [IRON] = {"Black iron", {0.060, 0.065, 0.075}}, [ZINC] = {"Zinc-plated steel", {0.420, 0.410, 0.360}},
    [FIBRE] = {"Fibre", {0.260, 0.090, 0.050}},
};

typedef enum group { CASING, DRIVE, IDLER, BEARINGS, VALVE, GROUPS } group;

/* Drive and idler have their axles as origins, so that they can be turned. */
static const model_group groups[GROUPS] = {
    [CASING] = {"Casing", {0}},     [DRIVE] = {"Drive", {0, 19.5, 0}},       [IDLER] = {"Idler", {0, -19.5, 0}},
    [BEARINGS] = {"Bearings", {0}}, [VALVE] = {"Relief valve", {0, 0, -13}},
};

enum { PARTS_MAX = 32 };

typedef struct assembly {
    model_part parts[PARTS_MAX];
    int        count;
    char       names[6][8]; /* of the bolts */
} assembly;

static void list_parts(assembly *a)
{
    static const model_part rest[] = {
        {"Drive shaft", DRIVE, STEEL, build_drive_shaft, {0}},
        {"Gear key", DRIVE, ZINC, build_gear_key, {0}},
        {"Drive gear", DRIVE, GEAR, build_drive_gear, {0}},
        {"Coupling key", DRIVE, ZINC, build_coupling_key, {0}},
        {"Coupling", DRIVE, IRON, build_coupling, {0}},
        {"Idler shaft", IDLER, STEEL, build_idler_shaft, {0}},
        {"Idler gear", IDLER, GEAR, build_idler_gear, {0}},
        {"Bush 1", BEARINGS, BRASS, build_long_bush, {0, 19.5, -20.2}},
        {"Bush 2", BEARINGS, BRASS, build_long_bush, {0, -19.5, -20.2}},
        {"Bush 3", BEARINGS, BRASS, build_short_bush, {0, 19.5, 33.2}},
        {"Bush 4", BEARINGS, BRASS, build_short_bush, {0, -19.5, 33.2}},
        {"Seal", BEARINGS, RUBBER, build_seal, {0, 19.5, 51}},
    };
    a->parts[a->count++] = (model_part){"Housing", CASING, CASTING, build_housing, {0}};
    a->parts[a->count++] = (model_part){"Gasket", CASING, FIBRE, build_gasket, {0}};
    a->parts[a->count++] = (model_part){"Cover", CASING, COVER, build_cover, {0}};
    for (int b = 0; b < 6; b++) {
        model_part *p = &a->parts[a->count++];
        snprintf(a->names[b], sizeof a->names[b], "Bolt %d", (b + 1) % 10);
        *p = (model_part){a->names[b], CASING, ZINC, build_bolt, {0, 0, bolt_seat + fit}};
        bolt_position(b, p->at);
    }
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        a->parts[a->count++] = rest[i];
    a->parts[a->count++] = (model_part){"Valve ball", VALVE, STEEL, build_ball, {ball_position(), 0, 0}};
    a->parts[a->count++] = (model_part){"Valve spring", VALVE, STEEL, build_spring, {ball_position(), 0, 0}};
    a->parts[a->count++] = (model_part){"Valve plug", VALVE, ZINC, build_plug, {body_radius + fit, 0, 0}};
}

/* One turn of both shafts in four seconds, the driving one the way that brings the oil from the inlet (at +x) to
 * the outlet. */
static void animate(glb *g, FILE *json)
{
    enum { KEYS = 4 };
    static const float times[KEYS] = {0, (float)4 / 3, (float)8 / 3, 4};
    int                input = glb_put_floats(g, times, KEYS, 1, "SCALAR", 0);
    fprintf(json, "\"animations\":[{\"name\":\"Run\",\"samplers\":[");
    for (int direction = 1; direction >= -1; direction -= 2) {
        float values[KEYS][4] = {0};
        for (int k = 0; k < KEYS; k++) {
            values[k][2] = (float)(direction * round(sin(PI * k / 3) * 1e6) / 1e6);
            values[k][3] = (float)(round(cos(PI * k / 3) * 1e6) / 1e6);
        }
        int output = glb_put_floats(g, values[0], KEYS, 4, "VEC4", 0);
        fprintf(json, "%s{\"input\":%d,\"output\":%d}", direction < 0 ? "," : "", input, output);
    }
    fprintf(json, "],\"channels\":[");
    for (int k = 0; k < 2; k++)
        fprintf(json, "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"rotation\"}}", k ? "," : "", k,
                1 + (k ? IDLER : DRIVE));
    fprintf(json, "]}],");
}

int main(int count, char **arguments)
{
    if (count != 2)
        return EXIT_FAILURE;
    assembly a = {.count = 0};
    list_parts(&a);
    const model pump = {"make_pump", "Gear pump", 1000,    materials, MATERIALS,
                        groups,      GROUPS,      a.parts, a.count,   animate};
    return model_write(&pump, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
