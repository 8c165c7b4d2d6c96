/* Writes the example model of a crank drive: make_crank OUT.glb
 *
 * The shaft of an engine with four cylinders, on a bed with five bearings: flywheel, timing gear and pulley, connecting
 * rods with their caps, pistons. Lengths are millimetres; the shaft runs along z, the flywheel is at −z, +y is up.
 * Pieces of one part reach into each other. */
#include "pieces.h"

#include "model.h"

#include <math.h>
#include <stdlib.h>

enum { ROUND = 56, SMALL_ROUND = 24, CYLINDERS = 4, BEARINGS = 5 };

/* --- dimensions that parts share ------------------------------------------------------------------------ */

static const double spacing = 96; /* of the cylinders: a pin, two webs, a journal */
static const double journal_width = 30, web_thickness = 18;
static const double journal_radius = 28, pin_radius = 24;
static const double stroke = 42;      /* half of it: the pins' distance from the axis */
static const double crank_angle = 38; /* of the outer cranks from upright, the inner ones are opposite */
static const double rod_length = 152;
static const double gudgeon_radius = 11;
static const double piston_radius = 43, piston_low = -34, piston_high = 36; /* from the gudgeon pin */
static const double bed_top = -112, bed_bottom = -128;
static const double shaft_back = -2 * 96 - 15, shaft_front = 2 * 96 + 15; /* ends of the outer journals */
static const double fit = 0.2;

static double cylinder_position(int index)
{
    return (index - (CYLINDERS - 1) / 2.0) * spacing;
}

static double angle_of(int index)
{
    return index == 0 || index == CYLINDERS - 1 ? crank_angle : crank_angle + 180;
}

static double gudgeon_height(double angle)
{
    double aside = stroke * sin(angle * PI / 180);
    return stroke * cos(angle * PI / 180) + sqrt(rod_length * rod_length - aside * aside);
}

/* Turns everything after the first `kept` points about z, clockwise as seen from the front, then moves it. */
static void turn(mesh *m, uint32_t kept, double degrees, double x, double y, double z)
{
    double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    for (uint32_t i = kept; i < m->point_count; i++) {
        int32_t *at = m->points[i].at;
        double   u = at[0], v = at[1];
        at[0] = (int32_t)lround(c * u + s * v + x * GRID);
        at[1] = (int32_t)lround(c * v - s * u + y * GRID);
        at[2] = (int32_t)lround(at[2] + z * GRID);
    }
}

/* A plate between two heights along z whose edges are bevelled: `low` and `high` are the outline drawn in. */
static void bevelled(mesh *m, const outline *drawn_in, const outline *whole, double from, double to, double bevel)
{
    const frame f = {.along = FRONT};
    ring        rings[4] = {put_ring(m, &f, drawn_in, from), put_ring(m, &f, whole, from + bevel),
                            put_ring(m, &f, whole, to - bevel), put_ring(m, &f, drawn_in, to)};
    for (int k = 0; k < 3; k++)
        sew(m, &rings[k], &rings[k + 1]);
    cap(m, BACK, &rings[0], NULL, 0);
    cap(m, FRONT, &rings[3], NULL, 0);
}

static outline hexagon(double across)
{
    outline o = {0};
    for (int i = 0; i < 6; i++)
        add_point(&o, across / sqrt(3) * cos(i * PI / 3), across / sqrt(3) * sin(i * PI / 3));
    return o;
}

/* A hexagonal head that stands on t = 0 of a frame, with the end of a thread. */
static void hexagon_head(mesh *m, const frame *f, double across, double height)
{
    outline o = hexagon(across);
    extrude_along(m, f, &o, NULL, 0, -0.5, height);
    LATHE(m, f, SMALL_ROUND, NULL, NULL, {-0.5, 0}, {-0.5, across * 0.62}, {1.2, across * 0.62}, {1.2, across * 0.45},
          {height + 1.2, across * 0.45}, {height + 2, across * 0.36}, {height + 2, 0});
}

/* --- crankshaft ----------------------------------------------------------------------------------------- */

/* A crank's web: round about the pin, then waisted, then the counterweight. */
static outline web_outline(double inset)
{
    outline o = {0};
    add_arc(&o, 0, stroke, 38 - inset, 5, 175, 28);
    add_arc(&o, -58 - inset, -8, 20 + inset, 20, -60, 8); /* the hollow below the pin's end */
    add_arc(&o, 0, -4, 82 - inset, 206, 334, 30);
    add_arc(&o, 58 + inset, -8, 20 + inset, 240, 160, 8);
    return o;
}

static void web(mesh *m, double angle, double from)
{
    uint32_t kept = m->point_count;
    outline  whole = web_outline(0), drawn_in = web_outline(2);
    bevelled(m, &drawn_in, &whole, from, from + web_thickness, 2);
    turn(m, kept, angle, 0, 0, 0);
}

/* Fillets run into the webs on either side. */
static void journal(mesh *m, double x, double y, double from, double to, double radius)
{
    LATHE(m, (&(frame){{x, y, 0}, FRONT}), ROUND, NULL, NULL, {from - 2, 0}, {from - 2, radius + 4},
          {from + 0.6, radius + 4}, {from + 1, radius + 2.4}, {from + 2, radius + 1}, {from + 3.4, radius},
          {to - 3.4, radius}, {to - 2, radius + 1}, {to - 1, radius + 2.4}, {to - 0.6, radius + 4},
          {to + 2, radius + 4}, {to + 2, 0});
}

static void build_crankshaft(mesh *m)
{
    const frame f = {.along = FRONT};
    for (int i = 0; i < CYLINDERS; i++) {
        double middle = cylinder_position(i), angle = angle_of(i), half = journal_width / 2;
        journal(m, stroke * sin(angle * PI / 180), stroke * cos(angle * PI / 180), middle - half, middle + half,
                pin_radius);
        web(m, angle, middle - half - web_thickness);
        web(m, angle, middle + half);
    }
    for (int i = 1; i < BEARINGS - 1; i++) {
        double middle = (i - 2) * spacing;
        journal(m, 0, 0, middle - journal_width / 2, middle + journal_width / 2, journal_radius);
    }
    /* The ends: a flange for the flywheel, and a stepped nose. */
    LATHE(m, &f, ROUND, NULL, NULL, {shaft_back - 14, 0}, {shaft_back - 14, 42}, {shaft_back - 13, 43},
          {shaft_back - 1, 43}, {shaft_back, 42}, {shaft_back, journal_radius + 3}, {shaft_back + 2, journal_radius},
          {shaft_back + 26.6, journal_radius}, {shaft_back + 28, journal_radius + 1},
          {shaft_back + 29.4, journal_radius + 4}, {shaft_back + 32, journal_radius + 4}, {shaft_back + 32, 0});
    LATHE(m, &f, ROUND, NULL, NULL, {shaft_front - 32, 0}, {shaft_front - 32, journal_radius + 4},
          {shaft_front - 29.4, journal_radius + 4}, {shaft_front - 28, journal_radius + 1},
          {shaft_front - 26.6, journal_radius}, {shaft_front, journal_radius}, {shaft_front + 1, journal_radius - 1},
          {shaft_front + 1, 22}, {shaft_front + 36, 22}, {shaft_front + 37, 21}, {shaft_front + 37, 18},
          {shaft_front + 74, 18}, {shaft_front + 75, 17}, {shaft_front + 75, 0});
}

/* --- flywheel, timing gear, pulley ---------------------------------------------------------------------- */

/* Straight-sided teeth; `fraction` is how much of a tooth's pitch its tip and its foot take. */
static outline toothed(double root, double tip, int teeth, double tip_fraction, double foot_fraction)
{
    outline o = {0};
    for (int i = 0; i < teeth; i++)
        for (int k = 0; k < 4; k++) {
            double fraction = (k == 0 || k == 3 ? foot_fraction : tip_fraction) / 2,
                   radius = k == 0 || k == 3 ? root : tip;
            double angle = 2 * PI * (i + (k < 2 ? -fraction : fraction)) / teeth;
            add_point(&o, radius * cos(angle), radius * sin(angle));
        }
    return o;
}

enum { LIGHTENED = 6, FLYWHEEL_BOLTS = 6 };

static void build_flywheel(mesh *m)
{
    const double front = shaft_back - 14 - fit, back = front - 16;
    outline      disc = circle(0, 0, 112, 96), holes[LIGHTENED], teeth = toothed(129, 134, 108, 0.36, 0.7),
            bore = circle(0, 0, 120, 108);
    for (int i = 0; i < LIGHTENED; i++) {
        double angle = (i + 0.5) * 2 * PI / LIGHTENED;
        holes[i] = circle(78 * cos(angle), 78 * sin(angle), 17, SMALL_ROUND);
    }
    extrude(m, &disc, holes, LIGHTENED, back + 2, front - 2);
    ring inner, outer; /* the heavy rim */
    LATHE(m, &(frame){.along = FRONT}, 96, &inner, &outer, {back - 10, 108}, {back - 10, 125}, {back - 8, 127},
          {front + 8, 127}, {front + 10, 125}, {front + 10, 108}, {front + 8, 106}, {back - 8, 106});
    sew(m, &outer, &inner);
    extrude(m, &teeth, &bore, 1, back + 1, front - 3);
    LATHE(m, &(frame){.along = FRONT}, ROUND, NULL, NULL, {back - 4, 0}, {back - 4, 14}, {back + 3, 14.5},
          {back + 3, 40}, {back - 3, 41}, {back - 4, 42}, {back - 4, 50}, {back - 3, 52}, {front - 1, 52}, {front, 50},
          {front, 0});
}

static void build_flywheel_bolts(mesh *m)
{
    const double back = shaft_back - 14 - fit - 16 + 3;
    for (int i = 0; i < FLYWHEEL_BOLTS; i++) {
        double angle = i * 2 * PI / FLYWHEEL_BOLTS;
        hexagon_head(m, &(frame){{27 * cos(angle), 27 * sin(angle), back}, BACK}, 13, 7);
    }
}

static void build_timing_gear(mesh *m)
{
    const double from = shaft_front + 4, to = from + 20;
    outline      teeth = toothed(53.5, 61, 36, 0.3, 0.72), web_hole = circle(0, 0, 45, ROUND), holes[7];
    extrude(m, &teeth, &web_hole, 1, from, to);
    outline disc = circle(0, 0, 46, ROUND);
    holes[0] = circle(0, 0, 22.2, ROUND);
    for (int i = 0; i < 6; i++)
        holes[1 + i] = circle(37.5 * cos(i * PI / 3), 37.5 * sin(i * PI / 3), 4.5, 24);
    extrude(m, &disc, holes, 7, from + 6, to - 6);
    outline hub = circle(0, 0, 30, ROUND), bore = circle(0, 0, 22.2, ROUND);
    extrude(m, &hub, &bore, 1, from - 2, to + 3);
}

static void build_pulley(mesh *m)
{
    const double at = shaft_front + 42;
    ring         inner, outer;
    LATHE(m, &(frame){.along = FRONT}, 80, &inner, &outer, {at, 18.2}, {at, 40}, {at + 5, 40}, {at + 5, 62}, {at, 62},
          {at, 69}, {at + 1, 70}, {at + 3, 70}, {at + 8, 61}, {at + 10, 61}, {at + 15, 70}, {at + 17, 70},
          {at + 22, 61}, {at + 24, 61}, {at + 29, 70}, {at + 31, 70}, {at + 32, 69}, {at + 32, 54}, {at + 14, 54},
          {at + 14, 30}, {at + 30, 28}, {at + 30, 18.2});
    sew(m, &outer, &inner);
}

static void build_nose_bolt(mesh *m)
{
    hexagon_head(m, &(frame){{0, 0, shaft_front + 75 + 0.5}, FRONT}, 26, 13);
}

/* --- bed and bearings ----------------------------------------------------------------------------------- */

static const double bearing_width = 21, stud_position = 46;

static void build_bed(mesh *m)
{
    outline      whole = {0}, holes[8];
    const double length = 214, breadth = 96, corner = 16, forward = 8; /* the flywheel hangs over its back */
    add_arc(&whole, length - corner, breadth - corner, corner, 0, 90, 8);
    add_arc(&whole, corner - length, breadth - corner, corner, 90, 180, 8);
    add_arc(&whole, corner - length, corner - breadth, corner, 180, 270, 8);
    add_arc(&whole, length - corner, corner - breadth, corner, 270, 360, 8);
    for (int i = 0; i < 8; i++)
        holes[i] = circle((i % 4 - 1.5) * 130, i < 4 ? 78 : -78, 7, 24);
    for (int i = 0; i < whole.count; i++) { /* plans want the long side along z */
        double kept = whole.at[i][0];
        whole.at[i][0] = whole.at[i][1];
        whole.at[i][1] = kept + forward;
    }
    for (int h = 0; h < 8; h++)
        for (int i = 0; i < holes[h].count; i++) {
            double kept = holes[h].at[i][0];
            holes[h].at[i][0] = holes[h].at[i][1];
            holes[h].at[i][1] = kept + forward;
        }
    plan(m, &whole, holes, 8, bed_bottom, bed_top);
    for (int side = -1; side <= 1; side += 2) /* sills under the pedestals */
        box(m, side * 50 - 15, bed_top - 1, forward - length + 2, side * 50 + 15, bed_top + 7, forward + length - 2);
}

/* The lower half of a bearing: a pedestal with a round seat, waisted, on a foot. */
static void build_pedestal(mesh *m)
{
    outline o = {0};
    add_point(&o, -70, bed_top + 6);
    add_point(&o, 70, bed_top + 6);
    add_point(&o, 70, bed_top + 18);
    add_arc(&o, 78, bed_top + 44, 26, 251, 184, 10);
    add_point(&o, 58, -18);
    add_point(&o, 58, -0.3);
    add_arc(&o, 0, 0, journal_radius + fit, 359.4, 180.6, 40);
    add_point(&o, -58, -0.3);
    add_point(&o, -58, -18);
    add_arc(&o, -78, bed_top + 44, 26, -4, -71, 10);
    add_point(&o, -70, bed_top + 18);
    extrude(m, &o, NULL, 0, -bearing_width / 2, bearing_width / 2);
}

static void build_bearing_cap(mesh *m)
{
    outline o = {0};
    add_point(&o, 58, 0.3);
    add_point(&o, 58, 17);
    add_point(&o, 56, 19);
    add_point(&o, 40, 19);
    add_arc(&o, 0, 0, 42, 30, 150, 36);
    add_point(&o, -40, 19);
    add_point(&o, -56, 19);
    add_point(&o, -58, 17);
    add_point(&o, -58, 0.3);
    add_arc(&o, 0, 0, journal_radius + fit, 179.4, 0.6, 40);
    extrude(m, &o, NULL, 0, -bearing_width / 2 + 0.5, bearing_width / 2 - 0.5);
    LATHE(m, (&(frame){{0, 40, 0}, UP}), 24, NULL, NULL, {0, 0}, {0, 6}, {6, 6}, {7, 5}, {7, 3}, {9, 3}, {9, 0});
    for (int side = -1; side <= 1; side += 2)
        hexagon_head(m, &(frame){{side * (stud_position + 2), 19, 0}, UP}, 13, 9);
}

/* --- connecting rods ------------------------------------------------------------------------------------ */

static const double rod_width = 26, ear = 41;

/* Upright, the pin at the origin. */
static void rod(mesh *m)
{
    outline upper = {0}, shank = {0}, pocket = {0}, eye = circle(0, rod_length, 20, SMALL_ROUND),
            bore = circle(0, rod_length, gudgeon_radius + fit, SMALL_ROUND);
    add_point(&upper, ear, 0.3);
    add_point(&upper, ear, 14);
    add_arc(&upper, 34, 22, 8, 320, 360, 4);
    add_arc(&upper, 0, 18, 24, 30, 150, 20);
    add_arc(&upper, -34, 22, 8, 180, 220, 4);
    add_point(&upper, -ear, 14);
    add_point(&upper, -ear, 0.3);
    add_arc(&upper, 0, 0, pin_radius + fit, 179.3, 0.7, 36);
    extrude(m, &upper, NULL, 0, -rod_width / 2, rod_width / 2);
    add_point(&shank, -18.5, 34);
    add_point(&shank, 18.5, 34);
    add_point(&shank, 11.5, rod_length - 15);
    add_point(&shank, -11.5, rod_length - 15);
    add_arc(&pocket, 0, 54, 9.5, 180, 360, 10);
    add_arc(&pocket, 0, rod_length - 30, 6, 0, 180, 10);
    extrude(m, &shank, &pocket, 1, -9, 9);
    outline inside = {0}; /* the web between the flanges, a little larger than the pocket */
    add_arc(&inside, 0, 54, 10.5, 180, 360, 10);
    add_arc(&inside, 0, rod_length - 30, 7, 0, 180, 10);
    extrude(m, &inside, NULL, 0, -3.5, 3.5);
    extrude(m, &eye, &bore, 1, -12, 12);
}

static void rod_cap(mesh *m)
{
    outline lower = {0};
    add_point(&lower, -ear, -0.3);
    add_point(&lower, -ear, -14);
    add_point(&lower, -31, -20);
    add_arc(&lower, 0, 0, 37, 213, 327, 28);
    add_point(&lower, 31, -20);
    add_point(&lower, ear, -14);
    add_point(&lower, ear, -0.3);
    add_arc(&lower, 0, 0, pin_radius + fit, 359.3, 180.7, 36);
    extrude(m, &lower, NULL, 0, -rod_width / 2 + 0.4, rod_width / 2 - 0.4);
    for (int side = -1; side <= 1; side += 2)
        hexagon_head(m, &(frame){{side * 35.5, -15, 0}, DOWN}, 9, 7);
}

/* Leans a rod from its pin to the cylinder's axis. */
static void lean(mesh *m, double angle)
{
    turn(m, 0, -asin(stroke * sin(angle * PI / 180) / rod_length) * 180 / PI, stroke * sin(angle * PI / 180),
         stroke * cos(angle * PI / 180), 0);
}

static void build_outer_rod(mesh *m)
{
    rod(m);
    lean(m, crank_angle);
}

static void build_inner_rod(mesh *m)
{
    rod(m);
    lean(m, crank_angle + 180);
}

static void build_outer_rod_cap(mesh *m)
{
    rod_cap(m);
    lean(m, crank_angle);
}

static void build_inner_rod_cap(mesh *m)
{
    rod_cap(m);
    lean(m, crank_angle + 180);
}

/* --- pistons -------------------------------------------------------------------------------------------- */

/* Hollow; three grooves below the crown, and bosses for the pin. */
static void build_piston(mesh *m)
{
    const double r = piston_radius, top = piston_high, g = 3.4;
    LATHE(m, &(frame){.along = UP}, ROUND, NULL, NULL, {top - 9, 0}, {top - 9, 28}, {top - 13, 34}, {piston_low, r - 5},
          {piston_low, r - 1}, {piston_low + 1, r}, {top - 27, r}, {top - 27, r - g}, {top - 23, r - g}, {top - 23, r},
          {top - 18.5, r}, {top - 18.5, r - g}, {top - 15.5, r - g}, {top - 15.5, r}, {top - 11, r}, {top - 11, r - g},
          {top - 8, r - g}, {top - 8, r}, {top - 1.5, r}, {top, r - 1.5}, {top, 27}, {top - 2.5, 24}, {top - 2.5, 0});
    for (int side = -1; side <= 1; side += 2) {
        const frame f = {.along = side > 0 ? FRONT : BACK};
        LATHE(m, &f, SMALL_ROUND, NULL, NULL, {14, 0}, {14, 15}, {39, 15}, {39, 0});
    }
}

static void build_piston_rings(mesh *m)
{
    static const double positions[3][2] = {{-26.6, 3.2}, {-18.2, 2.4}, {-10.7, 2.4}};
    for (int k = 0; k < 3; k++) {
        double  low = piston_high + positions[k][0];
        outline whole = circle(0, 0, piston_radius + 0.5, ROUND), inside = circle(0, 0, piston_radius - 2.8, ROUND);
        extrude_along(m, &(frame){.along = UP}, &whole, &inside, 1, low, low + positions[k][1]);
    }
}

static void build_gudgeon_pin(mesh *m)
{
    LATHE(m, &(frame){.along = FRONT}, SMALL_ROUND, NULL, NULL, {-36, 0}, {-36, 6}, {-43.6, 6},
          {-43.6, gudgeon_radius - 1}, {-42.6, gudgeon_radius}, {42.6, gudgeon_radius}, {43.6, gudgeon_radius - 1},
          {43.6, 6}, {36, 6}, {36, 0});
}

/* --- assembly ------------------------------------------------------------------------------------------- */

enum { STEEL, BRIGHT, IRON, ALUMINIUM, BLACK, MATERIALS };

static const model_material materials[MATERIALS] = {
    [STEEL] = {"Forged steel", {0.460, 0.470, 0.490}}, [BRIGHT] = {"Bright steel", {0.640, 0.650, 0.660}},
    [IRON] = {"Cast iron", {0.330, 0.350, 0.360}},     [ALUMINIUM] = {"Aluminium", {0.700, 0.710, 0.720}},
    [BLACK] = {"Black bolts", {0.150, 0.150, 0.160}},
};

enum { SHAFT, BED, RODS, PISTONS, GROUPS };

static const model_group groups[GROUPS] = {
    [SHAFT] = {"shaft", {0}, 0},
    [BED] = {"bed plate with bearings", {0}, 0},
    [RODS] = {"rods", {0}, 0},
    [PISTONS] = {"pistons", {0}, 0},
};

enum { PARTS_MAX = 64, NAME_MAX_SIZE = 24 };

typedef struct assembly {
    int        count;
    model_part parts[PARTS_MAX];
    char       names[PARTS_MAX][NAME_MAX_SIZE];
} assembly;

/* number 0: the only one of its name. */
static void add(assembly *a, const char *name, int number, int group, int material, void (*build)(mesh *), double y,
                double z)
{
    char *own = a->names[a->count];
    snprintf(own, NAME_MAX_SIZE, number ? "%s %d" : "%s", name, number);
    a->parts[a->count++] = (model_part){own, group, material, build, {0, y, z}};
}

static void list_parts(assembly *a)
{
    add(a, "Crankshaft", 0, SHAFT, STEEL, build_crankshaft, 0, 0);
    add(a, "Flywheel", 0, SHAFT, IRON, build_flywheel, 0, 0);
    add(a, "Flywheel bolts", 0, SHAFT, BLACK, build_flywheel_bolts, 0, 0);
    add(a, "Timing gear", 0, SHAFT, BRIGHT, build_timing_gear, 0, 0);
    add(a, "Pulley", 0, SHAFT, IRON, build_pulley, 0, 0);
    add(a, "Nose bolt", 0, SHAFT, BLACK, build_nose_bolt, 0, 0);
    add(a, "Bed", 0, BED, IRON, build_bed, 0, 0);
    for (int i = 0; i < BEARINGS; i++) {
        add(a, "Pedestal", i + 1, BED, IRON, build_pedestal, 0, (i - 2) * spacing);
        add(a, "Bearing cap", i + 1, BED, IRON, build_bearing_cap, 0, (i - 2) * spacing);
    }
    for (int i = 0; i < CYLINDERS; i++) {
        bool   outer = angle_of(i) == crank_angle;
        double z = cylinder_position(i), y = gudgeon_height(angle_of(i));
        add(a, "Connecting rod", i + 1, RODS, STEEL, outer ? build_outer_rod : build_inner_rod, 0, z);
        add(a, "Rod cap", i + 1, RODS, STEEL, outer ? build_outer_rod_cap : build_inner_rod_cap, 0, z);
        add(a, "Piston", i + 1, PISTONS, ALUMINIUM, build_piston, y, z);
        add(a, "Piston rings", i + 1, PISTONS, BRIGHT, build_piston_rings, y, z);
        add(a, "Gudgeon pin", i + 1, PISTONS, BRIGHT, build_gudgeon_pin, y, z);
    }
}

int main(int count, char **arguments)
{
    if (count != 2)
        return EXIT_FAILURE;
    static assembly a;
    list_parts(&a);
    const model crank = {"make_crank", "Crank drive", 1000,    materials, MATERIALS,
                         groups,       GROUPS,        a.parts, a.count,   NULL};
    return model_write(&crank, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
