/* Writes the example model of a department store: make_store OUT.glb
 *
 * It stands on a corner, which is round and where one enters. Four storeys of glass between floor slabs, fins before
 * the straight fronts, a set-back storey on the roof's terrace. Metres, +y is up; the fronts look to +z and +x.
 *
 * Whatever runs along the fronts is told by a way: metres before the round corner (negative), degrees along it (0 to
 * 90), 90 and metres behind it; and by how far it is set back from the slabs' edges. */
#include "model.h"
#include "pieces.h"

#include <math.h>
#include <stdlib.h>

/* --- dimensions that parts share ------------------------------------------------------------------------ */

enum { STOREYS = 4, ESCALATOR_STEPS = 21 };

static const double left = -20, back = -13, corner_x = 8, corner_z = 5, corner_radius = 8;
static const double direction_begin = -27.8, direction_end = 107.8; /* between the walls at the neighbours */
static const double module = 1.5; /* from mullion to mullion; on the corner an eighth of it */
static const double levels[STOREYS + 1] = {0.16, 5.2, 9.4, 13.6, 17.8};
static const double slab = 0.42, glass = 0.45, pavement = 0.12;
static const double void_left = -6, void_right = 4, void_half = 4; /* the hall through which the escalators rise */
static const double pavilion = 5, pavilion_top = 21.5;

/* --- along the fronts ----------------------------------------------------------------------------------- */

static void add_direction_point(outline *o, double direction, double set_back)
{
    if (direction <= 0)
        add_point(o, corner_x + direction, corner_z + corner_radius - set_back);
    else if (direction < 90)
        add_point(o, corner_x + (corner_radius - set_back) * sin(direction * PI / 180),
                  corner_z + (corner_radius - set_back) * cos(direction * PI / 180));
    else
        add_point(o, corner_x + corner_radius - set_back, corner_z - (direction - 90));
}

static void add_direction(outline *o, double from, double to, double set_back, bool backwards)
{
    enum { ROUND = 24 };
    double directions[ROUND + 3];
    int    count = 0;
    directions[count++] = from;
    for (int k = 0; k <= ROUND; k++)
        if (90.0 * k / ROUND > from && 90.0 * k / ROUND < to)
            directions[count++] = 90.0 * k / ROUND;
    directions[count++] = to;
    for (int k = 0; k < count; k++)
        add_direction_point(o, directions[backwards ? count - 1 - k : k], set_back);
}

/* An upright band along the fronts. */
static void strip(mesh *m, double from, double to, double outer, double inner, double low, double high)
{
    outline o = {0};
    add_direction(&o, from, to, outer, false);
    add_direction(&o, from, to, inner, true);
    plan(m, &o, NULL, 0, low, high);
}

/* Puts what was made at the origin, looking to the front, to its position on the slabs' edges. */
static void position_on_direction(mesh *m, uint32_t kept, double direction, double set_back)
{
    outline at = {0};
    add_direction_point(&at, direction, set_back);
    position(m, kept, direction <= 0 ? 0 : direction >= 90 ? 90 : direction, at.at[0][0], 0, at.at[0][1]);
}

/* A post that reaches from `outer` to `inner` behind the slabs' edges. */
static void post(mesh *m, double direction, double width, double outer, double inner, double low, double high)
{
    uint32_t kept = m->point_count;
    box(m, -width / 2, low, -inner, width / 2, high, -outer);
    position_on_direction(m, kept, direction, 0);
}

/* The mullions' ways: from the left wall to the corner, along it, and on to the wall at the back. */
enum {
    FRONT_MODULES = 18,
    CORNER_MODULES = 8,
    SIDE_MODULES = 11,
    STATIONS = FRONT_MODULES + CORNER_MODULES + SIDE_MODULES + 1
};

static double station(int k)
{
    if (k <= FRONT_MODULES)
        return (k - FRONT_MODULES) * module;
    if (k <= FRONT_MODULES + CORNER_MODULES)
        return (k - FRONT_MODULES) * 90.0 / CORNER_MODULES;
    return 90 + (k - FRONT_MODULES - CORNER_MODULES) * module;
}

/* The building's plan, set back by so much on all sides but at the neighbours'. */
static outline footprint(double set_back, double from_left, double from_back)
{
    outline o = {0};
    add_point(&o, left + from_left, back + from_back);
    add_direction(&o, left + from_left - corner_x, 90 + corner_z - back - from_back, set_back, false);
    return o;
}

/* --- structure ------------------------------------------------------------------------------------------ */

static void build_slabs(mesh *m)
{
    outline edge = footprint(0, 0.05, 0.05), hall = rectangle(void_left, -void_half, void_right, void_half);
    for (int k = 1; k <= STOREYS; k++)
        plan(m, &edge, &hall, k < STOREYS, levels[k] - slab, levels[k]);
}

static void build_ground_floor(mesh *m)
{
    outline edge = footprint(0.2, 0.1, 0.1);
    plan(m, &edge, NULL, 0, -0.37, levels[0]);
}

/* The walls at the neighbours, which end as blades before the fronts. */
static void build_party_walls(mesh *m)
{
    const double top = levels[STOREYS] + 1.25;
    box(m, left - 0.1, -0.4, back - 0.1, left + 0.3, top, corner_z + corner_radius + 0.5);
    box(m, left + 0.28, -0.4, back - 0.08, corner_x + corner_radius + 0.5, top - 0.02, back + 0.3);
}

static void build_columns(mesh *m)
{
    static const double xs[] = {-16, -11, -6.7, 4.7, 10}, zs[] = {-8.8, -4.7, 4.7, 9.2};
    for (int i = 0; i < COUNT(xs); i++)
        for (int j = 0; j < COUNT(zs); j++)
            TURNED(m, xs[i], 0, zs[j], 14, {0.1, 0}, {0.1, 0.26}, {levels[STOREYS] - 0.2, 0.26},
                   {levels[STOREYS] - 0.2, 0});
    for (int k = 0; k < 6; k++) /* the pavilion's */
        TURNED(m, -15 + 4.6 * k, 0, 6.6, 12, {levels[STOREYS] - 0.1, 0}, {levels[STOREYS] - 0.1, 0.14},
               {pavilion_top - 0.2, 0.14}, {pavilion_top - 0.2, 0});
}

/* Lifts and stairs at the wall at the back, with lift doors on every floor. */
static void build_core(mesh *m)
{
    box(m, -4.5, 0.05, back + 0.25, 3.5, pavilion_top + 1.2, -9.4);
    for (int k = 0; k <= STOREYS; k++)
        for (int lift = 0; lift < 3; lift++) {
            double x = -3.9 + 2.4 * lift, low = levels[k] - 0.01;
            box(m, x, low, -9.5, x + 1.9, low + 2.5, -9.34);
        }
}

static void build_lift_doors(mesh *m)
{
    for (int k = 0; k <= STOREYS; k++)
        for (int lift = 0; lift < 3; lift++)
            for (int leaf = 0; leaf < 2; leaf++) {
                double x = -3.9 + 2.4 * lift + 0.2 + 0.76 * leaf;
                box(m, x, levels[k] - 0.02, -9.4, x + 0.74, levels[k] + 2.25, -9.3);
            }
}

/* --- fronts --------------------------------------------------------------------------------------------- */

static void build_glass_ground(mesh *m)
{
    strip(m, direction_begin, 36.5, glass, glass + 0.04, levels[0] - 0.03, levels[1] - slab + 0.02);
    strip(m, 53.5, direction_end, glass, glass + 0.04, levels[0] - 0.03, levels[1] - slab + 0.02);
    strip(m, 36.5, 53.5, glass, glass + 0.04, 3.1, levels[1] - slab + 0.02);
}

static void glass_of_storey(mesh *m, int storey)
{
    strip(m, direction_begin, direction_end, glass, glass + 0.04, levels[storey] - 0.02,
          levels[storey + 1] - slab + 0.02);
}

static void build_glass_first(mesh *m)
{
    glass_of_storey(m, 1);
}

static void build_glass_second(mesh *m)
{
    glass_of_storey(m, 2);
}

static void build_glass_third(mesh *m)
{
    glass_of_storey(m, 3);
}

/* Above the ground floor every module has its mullion, on it every other one, as shop windows are wide. */
static void build_mullions(mesh *m)
{
    for (int storey = 0; storey < STOREYS; storey++) {
        double low = levels[storey] - 0.05, high = levels[storey + 1] - slab + 0.05;
        for (int k = 0; k < STATIONS; k++)
            if (storey > 0 || (k % 2 == 0 && k != FRONT_MODULES + CORNER_MODULES / 2))
                post(m, station(k), 0.07, glass - 0.06, glass + 0.12, low, high);
        if (storey > 0) {
            strip(m, direction_begin + 0.03, direction_end - 0.03, glass - 0.05, glass + 0.09, levels[storey] + 0.92,
                  levels[storey] + 0.98);
            continue;
        }
        for (int side = 0; side < 2; side++) {
            double from = side ? 53.4 : direction_begin + 0.03, to = side ? direction_end - 0.03 : 36.6;
            strip(m, from, to, glass - 0.05, glass + 0.09, 3.2, 3.28);
            strip(m, from, to, glass - 0.09, glass + 0.13, levels[0] - 0.07, levels[0] + 0.22);
            post(m, side ? 53.5 : 36.5, 0.1, glass - 0.07, glass + 0.13, low, high);
        }
        strip(m, 36.6, 53.4, glass - 0.05, glass + 0.09, 3.02, 3.14);
    }
}

static void build_fins(mesh *m)
{
    const double low = levels[1] - slab - 0.12, high = levels[STOREYS] + 0.62;
    for (int k = 0; k < STATIONS; k++)
        if (k <= FRONT_MODULES || k >= FRONT_MODULES + CORNER_MODULES)
            post(m, station(k), 0.09, -0.34, 0.12, low, high);
}

/* The slabs' edges on the corner, where no fins are, stand out as bands. */
static void build_bands(mesh *m)
{
    for (int k = 1; k <= STOREYS; k++)
        strip(m, 1, 89, -0.3, 0.2, levels[k] - slab - 0.06, levels[k] + 0.08);
}

/* --- entrance ------------------------------------------------------------------------------------------- */

static void build_canopy(mesh *m)
{
    strip(m, -2.2, 92.2, -3.1, 0.15, 3.82, 4.08);
    strip(m, -2.3, 92.3, -3.2, -3.0, 3.74, 4.2);
}

static void build_canopy_columns(mesh *m)
{
    for (int k = 0; k < 6; k++) {
        outline at = {0};
        add_direction_point(&at, k * 18, -2.6);
        TURNED(m, at.at[0][0], 0, at.at[0][1], 12, {0.05, 0}, {0.05, 0.12}, {0.17, 0.12}, {0.19, 0.065}, {3.88, 0.065},
               {3.88, 0});
    }
}

/* A revolving door: drum, three wings. */
static void build_revolving_door(mesh *m)
{
    ring         first, last;
    const frame  f = {.along = UP};
    const double low = levels[0] - 0.02;
    LATHE(m, &f, 32, &first, &last, {2.5, 1.16}, {2.95, 1.16}, {2.95, 1.02}, {2.5, 1.02});
    sew(m, &last, &first);
    TURNED(m, 0, 0, 0, 32, {2.8, 0}, {2.8, 1.1}, {2.9, 1.1}, {2.9, 0});
    TURNED(m, 0, 0, 0, 10, {low, 0}, {low, 0.06}, {2.83, 0.06}, {2.83, 0});
    for (int k = 0; k < 3; k++) {
        uint32_t kept = m->point_count;
        box(m, -0.02, low + 0.04, 0.03, 0.02, 2.52, 1.0);
        box(m, -0.035, 1.05, 0.03, 0.035, 1.12, 1.01);
        position(m, kept, 120 * k + 25, 0, 0, 0);
    }
    for (int side = -1; side <= 1; side += 2) { /* the curved walls of the drum */
        outline o = {0};
        add_arc(&o, 0, 0, 1.13, side < 0 ? 135 : -45, side < 0 ? 225 : 45, 10);
        add_arc(&o, 0, 0, 1.07, side < 0 ? 225 : 45, side < 0 ? 135 : -45, 10);
        plan(m, &o, NULL, 0, low, 2.55);
    }
    position_on_direction(m, 0, 45, glass + 0.02);
}

/* Letters of the height 1 as outlines; R has its eye as a second one. */
static const double letter_l[][2] = {{0, 0}, {0.62, 0}, {0.62, 0.2}, {0.22, 0.2}, {0.22, 1}, {0, 1}};
static const double letter_i[][2] = {{0.2, 0}, {0.42, 0}, {0.42, 1}, {0.2, 1}};
static const double letter_m[][2] = {{-0.08, 0}, {0.12, 0}, {0.12, 0.62}, {0.31, 0.26}, {0.5, 0.62}, {0.5, 0},
                                     {0.7, 0},   {0.7, 1},  {0.52, 1},    {0.31, 0.58}, {0.1, 1},    {-0.08, 1}};
static const double letter_n[][2] = {{0, 0},    {0.2, 0},  {0.2, 0.62},  {0.44, 0}, {0.64, 0},
                                     {0.64, 1}, {0.44, 1}, {0.44, 0.38}, {0.2, 1},  {0, 1}};
static const double letter_e[][2] = {{0, 0},      {0.6, 0},    {0.6, 0.2},  {0.22, 0.2}, {0.22, 0.41}, {0.52, 0.41},
                                     {0.52, 0.6}, {0.22, 0.6}, {0.22, 0.8}, {0.6, 0.8},  {0.6, 1},     {0, 1}};
static const double letter_r[][2] = {{0, 0},       {0.21, 0},  {0.21, 0.36}, {0.28, 0.36}, {0.44, 0}, {0.67, 0},
                                     {0.49, 0.39}, {0.6, 0.5}, {0.64, 0.68}, {0.58, 0.88}, {0.42, 1}, {0, 1}};
static const double letter_eye[][2] = {{0.21, 0.54}, {0.36, 0.54}, {0.43, 0.6}, {0.44, 0.7},
                                       {0.4, 0.8},   {0.34, 0.82}, {0.21, 0.82}};

static const struct {
    const double (*points)[2];
    int count;
} letters[] = {{letter_l, COUNT(letter_l)}, {letter_i, COUNT(letter_i)}, {letter_m, COUNT(letter_m)},
               {letter_n, COUNT(letter_n)}, {letter_e, COUNT(letter_e)}, {letter_r, COUNT(letter_r)}};

static void build_sign(mesh *m)
{
    box(m, -0.2, 6.3, 0.5, 0.2, 17.3, 2.3);
    for (int k = 2; k < STOREYS; k++)
        box(m, -0.1, levels[k] - 0.32, -0.2, 0.1, levels[k] - 0.1, 0.52);
    position_on_direction(m, 0, -2.25, 0);
}

/* Top to bottom on both sides of the sign. */
static void build_letters(mesh *m)
{
    const double height = 1.35;
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < COUNT(letters); k++) {
            outline  o = {0}, eye = {0};
            uint32_t kept = m->point_count;
            for (int i = 0; i < letters[k].count; i++)
                add_point(&o, (letters[k].points[i][0] - 0.31) * height, letters[k].points[i][1] * height);
            for (int i = 0; i < COUNT(letter_eye); i++)
                add_point(&eye, (letter_eye[i][0] - 0.31) * height, letter_eye[i][1] * height);
            elevation(m, &o, &eye, letters[k].points == letter_r, 0.17, 0.26);
            position(m, kept, side ? 90 : -90, 0, 15.55 - 1.76 * k, 1.4);
        }
    position_on_direction(m, 0, -2.25, 0);
}

/* --- inside --------------------------------------------------------------------------------------------- */

/* A moving staircase from one floor to the next over z = 0. Both of its landings reach onto the slabs around the
 * hall. */
static void escalator(mesh *m, double low, double high)
{
    const double run = (high - low) / tan(PI / 6), from = -run / 2, flat = (void_right - void_left - run) / 2 + 0.3,
                 tread = run / ESCALATOR_STEPS;
    outline o = {0};
    add_point(&o, from - flat, low - 0.35);
    add_point(&o, from + 0.45, low - 0.35);
    add_point(&o, -from + 0.4, high - 0.72);
    add_point(&o, -from + flat, high - 0.72);
    add_point(&o, -from + flat, high + 0.01);
    for (int k = ESCALATOR_STEPS; k > 0; k--) {
        add_point(&o, from + k * tread, low + 0.01 + (high - low) * k / ESCALATOR_STEPS);
        add_point(&o, from + k * tread, low + 0.01 + (high - low) * (k - 1) / ESCALATOR_STEPS);
    }
    add_point(&o, from - flat, low + 0.01);
    elevation(m, &o, NULL, 0, -0.5, 0.5);
    for (int side = -1; side <= 1; side += 2) {
        outline rail = {0};
        add_point(&rail, from - flat, low - 0.3);
        add_point(&rail, from + 0.45, low - 0.3);
        add_point(&rail, -from + 0.4, high - 0.68);
        add_point(&rail, -from + flat, high - 0.68);
        add_arc(&rail, -from + flat - 0.1, high + 0.68, 0.3, -60, 90, 6);
        add_point(&rail, -from - 0.1, high + 0.98);
        add_point(&rail, from - 0.3, low + 0.98);
        add_arc(&rail, from - flat + 0.1, low + 0.68, 0.3, 90, 240, 6);
        elevation(m, &rail, NULL, 0, side * 0.55 - 0.07, side * 0.55 + 0.07);
    }
}

/* Two beside each other on every floor, one up and one down. */
static void build_escalators(mesh *m)
{
    for (int k = 0; k < STOREYS - 1; k++)
        for (int side = -1; side <= 1; side += 2) {
            uint32_t kept = m->point_count;
            escalator(m, levels[k], levels[k + 1]);
            position(m, kept, 0, (void_left + void_right) / 2, 0, 1.05 * side);
        }
}

/* Around the hall on every floor, but where the escalators arrive. */
static void build_balustrades(mesh *m)
{
    for (int k = 1; k < STOREYS; k++) {
        double low = levels[k] - 0.06, high = levels[k] + 1.02;
        for (int side = -1; side <= 1; side += 2) {
            double z = side * (void_half + 0.12);
            box(m, void_left - 0.12, low, z - 0.02, void_right + 0.12, high, z + 0.02);
            box(m, void_left - 0.15, high - 0.02, z - 0.045, void_right + 0.15, high + 0.05, z + 0.045);
            for (int end = 0; end < 2; end++) {
                double x = end ? void_right + 0.12 : void_left - 0.12, a = 1.9 * side, b = z - side * 0.03;
                box(m, x - 0.02, low, fmin(a, b), x + 0.02, high - 0.01, fmax(a, b));
                box(m, x - 0.04, high - 0.025, fmin(a, b), x + 0.04, high + 0.045, fmax(a, b));
            }
        }
    }
}

/* Counters and shelves in rows; a few left out, others shifted. */
static void build_counters(mesh *m)
{
    static const double rows[] = {-7.2, -2.2, 2.6, 7.2, 10.6};
    uint32_t            seed = 5;
    for (int storey = 0; storey < STOREYS; storey++)
        for (int i = 0; i < 11; i++)
            for (int j = 0; j < COUNT(rows); j++) {
                double x = -18 + 2.8 * i + 0.5 * chance(&seed), z = rows[j] + 0.5 * chance(&seed),
                       high = chance(&seed) < 0.3 ? 1.8 : 0.95;
                bool   hall = x + 1.8 > void_left - 2 && x < void_right + 2 && fabs(z) < void_half + 1.2;
                double far = hypot(fmax(0, x + 1.8 - corner_x), fmax(0, z + 0.7 - corner_z));
                bool   entrance = storey == 0 && x > 6 && z > 1;
                if (hall || entrance || far > 6.8 || chance(&seed) < 0.25)
                    continue;
                box(m, x, levels[storey] - 0.02, z, x + 1.7, levels[storey] + high, z + 0.6);
                box(m, x - 0.04, levels[storey] + high - 0.02, z - 0.04, x + 1.74, levels[storey] + high + 0.05,
                    z + 0.64);
            }
}

/* --- the roof's terrace --------------------------------------------------------------------------------- */

static void build_parapet(mesh *m)
{
    strip(m, direction_begin, direction_end, 0.03, 0.3, levels[STOREYS] - 0.05, levels[STOREYS] + 0.3);
}

static void build_railing(mesh *m)
{
    const double low = levels[STOREYS] + 0.25, high = levels[STOREYS] + 1.12;
    for (int k = 0; k < STATIONS; k++)
        post(m, station(k), 0.035, 0.14, 0.19, low, high - 0.01);
    strip(m, direction_begin, direction_end, 0.13, 0.2, high - 0.03, high + 0.02);
    for (int k = 1; k < 4; k++) {
        double y = low + (high - low) * k / 4;
        strip(m, direction_begin, direction_end, 0.155, 0.175, y, y + 0.02);
    }
}

static void build_pavilion_glass(mesh *m)
{
    strip(m, -25, 103, pavilion, pavilion + 0.04, levels[STOREYS] - 0.02, pavilion_top - 0.28);
}

static void build_pavilion_mullions(mesh *m)
{
    for (int k = 0; k < STATIONS; k++)
        if (station(k) > -25 && station(k) < 103 &&
            (k < FRONT_MODULES || k > FRONT_MODULES + CORNER_MODULES || k % 2 == 0))
            post(m, station(k), 0.07, pavilion - 0.06, pavilion + 0.12, levels[STOREYS] - 0.03, pavilion_top - 0.27);
    strip(m, -24.96, 102.96, pavilion - 0.05, pavilion + 0.1, levels[STOREYS] + 2.3, levels[STOREYS] + 2.36);
}

static void build_pavilion_walls(mesh *m)
{
    box(m, corner_x - 25.2, levels[STOREYS] - 0.05, back + 3, corner_x - 24.9, pavilion_top - 0.2,
        corner_z + corner_radius - pavilion + 0.2);
    box(m, corner_x - 24.95, levels[STOREYS] - 0.06, -8.2, corner_x + corner_radius - pavilion + 0.2,
        pavilion_top - 0.21, -7.9);
}

static void build_pavilion_roof(mesh *m)
{
    outline o = {0};
    add_point(&o, corner_x - 26, back + 1.5);
    add_direction(&o, -26, 90 + corner_z - back - 1.5, pavilion - 1.6, false);
    plan(m, &o, NULL, 0, pavilion_top - 0.3, pavilion_top);
}

static void build_plant_capacity(mesh *m)
{
    const double low = pavilion_top - 0.05;
    box(m, -15, low, -10.5, -6, low + 2.5, -2.5);
    box(m, -15.15, low + 2.45, -10.65, -5.85, low + 2.62, -2.35);
    for (int k = 0; k < 2; k++)
        TURNED(m, -13 + 4 * k, 0, -6.5, 24, {low + 2.55, 0}, {low + 2.55, 1}, {low + 3.1, 1}, {low + 3.1, 0.85},
               {low + 2.9, 0.8}, {low + 2.9, 0});
}

static void build_louvres(mesh *m)
{
    for (int k = 0; k < 4; k++) {
        double y = pavilion_top + 0.4 + 0.48 * k;
        box(m, -14.6, y, -2.6, -6.4, y + 0.2, -2.42);
        box(m, -6.1, y, -10.1, -5.92, y + 0.2, -2.9);
    }
}

static void build_roof_light(mesh *m)
{
    box(m, -2.5, pavilion_top - 0.04, -3.5, 5.5, pavilion_top + 0.35, 2.5);
    for (int k = 0; k < 4; k++) {
        outline o = {0};
        add_point(&o, -2.4 + 1.95 * k, pavilion_top + 0.3);
        add_point(&o, -0.5 + 1.95 * k, pavilion_top + 0.3);
        add_point(&o, -1.45 + 1.95 * k, pavilion_top + 1.25);
        elevation(m, &o, NULL, 0, -3.3, 2.3);
    }
}

static void build_tables(mesh *m)
{
    for (int k = 0; k < 6; k++) {
        double x = -15.5 + 4.1 * k, z = 10.6 + 0.5 * (k % 2), y = levels[STOREYS];
        TURNED(m, x, y, z, 16, {-0.02, 0}, {-0.02, 0.28}, {0.03, 0.28}, {0.04, 0.035}, {0.71, 0.035}, {0.71, 0.45},
               {0.75, 0.45}, {0.75, 0});
        for (int side = -1; side <= 1; side += 2) {
            double seat = x + 0.75 * side;
            box(m, seat - 0.2, y - 0.02, z - 0.2, seat + 0.2, y + 0.45, z + 0.2);
            box(m, seat + 0.17 * side - 0.03, y + 0.4, z - 0.2, seat + 0.17 * side + 0.03, y + 0.85, z + 0.2);
        }
    }
}

static void build_planters(mesh *m)
{
    for (int k = 0; k < 4; k++)
        post(m, -19 + 6.2 * k, 2.6, 0.5, 1.15, levels[STOREYS] - 0.02, levels[STOREYS] + 0.55);
}

static void build_plants(mesh *m)
{
    for (int k = 0; k < 12; k++) {
        const double middle[3] = {corner_x - 19.85 + 6.2 * (k / 3) + 0.85 * (k % 3), levels[STOREYS] + 0.7,
                                  corner_z + corner_radius - 0.83};
        foliage(m, middle, 0.42, 0.4, (uint32_t)k + 3);
    }
}

/* --- the street ----------------------------------------------------------------------------------------- */

static void build_street(mesh *m)
{
    box(m, -25, -0.7, -17, 31, 0, 28);
}

static void build_pavement(mesh *m)
{
    outline o = footprint(-6.5, -4.5, -3.5);
    plan(m, &o, NULL, 0, -0.3, pavement);
}

static void build_kerb(mesh *m)
{
    strip(m, -32.4, 111.4, -6.75, -6.45, -0.28, pavement + 0.015);
}

/* Every other panel of the pavement is of darker stone, in two rows. They alone make a border; joints would make two
 * lines each.
 */
static void build_paving_panels(mesh *m)
{
    for (int k = 0; k + 2 < STATIONS; k += 2) {
        double outer = k % 4 ? -6.44 : -3.2, inner = k % 4 ? -3.2 : 0.1;
        strip(m, station(k), station(k + 2), outer, inner, pavement - 0.1, pavement + 0.01);
    }
}

static void build_bollards(mesh *m)
{
    for (int k = 0; k < 7; k++) {
        outline at = {0};
        add_direction_point(&at, 9 + 12 * k, -5.9);
        TURNED(m, at.at[0][0], 0, at.at[0][1], 12, {0.05, 0}, {0.05, 0.09}, {0.8, 0.09}, {0.84, 0.075}, {0.9, 0.075},
               {0.93, 0.05}, {0.93, 0});
    }
}

static void build_lamps(mesh *m)
{
    static const double directions[] = {-20.5, -4, 96};
    for (int k = 0; k < COUNT(directions); k++) {
        uint32_t     kept = m->point_count;
        const double low[3] = {0, 0.05, 0}, high[3] = {0, 6.2, 0}, end[3] = {0, 6.35, 1.6};
        bar(m, low, high, 0.09, 0.05, 10);
        bar(m, high, end, 0.045, 0.035, 8);
        box(m, -0.13, 6.29, 1.3, 0.13, 6.38, 2.1);
        position_on_direction(m, kept, directions[k], -5.9);
    }
}

static void build_first_tree(mesh *m)
{
    const double foot[3] = {-14.6, 0, 17.2};
    tree(m, foot, 8.2, 23);
}

static void build_second_tree(mesh *m)
{
    const double foot[3] = {-2.6, 0, 17.4};
    tree(m, foot, 7.6, 5);
}

static void build_tree_grates(mesh *m)
{
    static const double positions[][2] = {{-14.6, 17.2}, {-2.6, 17.4}};
    for (int k = 0; k < 2; k++) {
        outline outer =
            rectangle(positions[k][0] - 0.9, positions[k][1] - 0.9, positions[k][0] + 0.9, positions[k][1] + 0.9);
        outline hole = circle(positions[k][0], positions[k][1], 0.42, 16);
        plan(m, &outer, &hole, 1, -0.03, pavement + 0.02);
    }
}

/* --- people --------------------------------------------------------------------------------------------- */

static const double walking[][2] = {
    {0, 1.79},     {0.09, 1.75}, {0.115, 1.66}, {0.085, 1.56},  {0.07, 1.49},   {0.17, 1.44},  {0.235, 1.32},
    {0.27, 1.1},   {0.33, 0.92}, {0.3, 0.84},   {0.24, 0.88},   {0.2, 1.04},    {0.17, 1.08},  {0.18, 0.9},
    {0.25, 0.5},   {0.3, 0.12},  {0.42, 0.06},  {0.43, 0.0},    {0.22, 0.0},    {0.2, 0.1},    {0.11, 0.5},
    {0.02, 0.76},  {-0.06, 0.5}, {-0.22, 0.2},  {-0.17, 0.06},  {-0.2, 0.01},   {-0.36, 0.1},  {-0.31, 0.24},
    {-0.19, 0.52}, {-0.17, 0.9}, {-0.16, 1.06}, {-0.2, 0.98},   {-0.28, 0.82},  {-0.34, 0.85}, {-0.3, 0.98},
    {-0.25, 1.2},  {-0.19, 1.4}, {-0.07, 1.49}, {-0.085, 1.57}, {-0.105, 1.67}, {-0.08, 1.75},
};
static const double standing[][2] = {
    {0, 1.72},     {0.09, 1.67}, {0.1, 1.57},   {0.11, 1.46},  {0.06, 1.42},  {0.15, 1.38},  {0.21, 1.3},
    {0.25, 1.05},  {0.25, 0.84}, {0.2, 0.8},    {0.18, 0.98},  {0.2, 0.72},   {0.25, 0.48},  {0.14, 0.46},
    {0.12, 0.2},   {0.16, 0.03}, {0.14, 0.0},   {0.03, 0.0},   {0.03, 0.22},  {0, 0.45},     {-0.03, 0.22},
    {-0.03, 0.0},  {-0.14, 0.0}, {-0.16, 0.03}, {-0.12, 0.2},  {-0.14, 0.46}, {-0.25, 0.48}, {-0.2, 0.72},
    {-0.18, 0.98}, {-0.2, 0.8},  {-0.25, 0.84}, {-0.25, 1.05}, {-0.21, 1.3},  {-0.15, 1.38}, {-0.06, 1.42},
    {-0.11, 1.46}, {-0.1, 1.57}, {-0.09, 1.67},
};

/* A flat figure, as cut out of card. */
static void figure(mesh *m, bool walks, double size, double turn, double x, double y, double z)
{
    outline  o = walks ? smooth(walking, COUNT(walking), 2) : smooth(standing, COUNT(standing), 2);
    uint32_t kept = m->point_count;
    for (int i = 0; i < o.count; i++)
        for (int k = 0; k < 2; k++)
            o.at[i][k] *= size;
    elevation(m, &o, NULL, 0, -0.05, 0.05);
    position(m, kept, turn, x, y - 0.02, z);
}

static void build_people(mesh *m)
{
    const double street = pavement;
    figure(m, true, 1, 25, 13.5, street, 15.4);
    figure(m, false, 0.97, 40, 15.3, street, 13.6);
    figure(m, false, 0.66, 40, 15.8, street, 13.2);
    figure(m, true, 1.02, -160, 3.5, street, 15.6);
    figure(m, true, 0.97, 10, -9.5, street, 16.2);
    figure(m, false, 1, 10, -10.4, street, 16.1);
    figure(m, true, 1, 100, 19.2, street, 3);
    figure(m, true, 0.98, -80, 18.3, street, -3.5);
    figure(m, true, 1, 20, -17.3, street, 15.4);
    figure(m, true, 0.96, 30, 11, street, 17.3);
}

static void build_customers(mesh *m)
{
    static const double positions[][3] = {{11.5, 8.6, 50}, {9, 10.2, 10},    {12.8, 4, 60},
                                          {-9, 9.4, 0},    {-14.5, 8.8, 20}, {6.5, 2, 30}};
    for (int storey = 0; storey < STOREYS; storey++)
        for (int k = 0; k < COUNT(positions); k++)
            if ((k + storey) % 2 == 0)
                figure(m, k % 3 == 1, 1 - 0.03 * k / 2, positions[k][2] + 30 * storey, positions[k][0] - 0.7 * storey,
                       levels[storey], positions[k][1] - 0.3 * storey);
    figure(m, false, 1, 45, 12.4, levels[STOREYS], 10.1);
    figure(m, false, 0.95, 60, 13.1, levels[STOREYS], 9.5);
    figure(m, true, 1, 10, 3, levels[STOREYS], 12);
}

/* --- the assembly --------------------------------------------------------------------------------------- */

typedef enum material {
    CONCRETE,
    WHITE,
    GLASS,
    ALUMINIUM,
    STEEL,
    WARM,
    SIGN,
    LETTERS,
    PAVING,
    PANELS,
    STONE,
    ASPHALT,
    BARK,
    LEAVES,
    PERSON,
    MATERIALS
} material;

/* The glass is opaque, as most looks have no layers to show what is behind it; a rule for [material=Glass] can see
 * through it. */
static const model_material materials[MATERIALS] = {
    [CONCRETE] = {"Concrete", {0.560, 0.550, 0.530}},
    [WHITE] = {"White render", {0.800, 0.790, 0.760}},
    [GLASS] = {"Glass", {0.420, 0.580, 0.640}},
    [ALUMINIUM] = {"Bronze aluminium", {0.420, 0.320, 0.220}},
    [STEEL] = {"Steel", {0.120, 0.130, 0.140}},
    [WARM] = {"Oak", {0.560, 0.390, 0.220}},
    [SIGN] = {"Sign", {0.560, 0.060, 0.050}},
    [LETTERS] = {"Letters", {0.870, 0.860, 0.820}},
    [PANELS] = {"Darker paving", {0.510, 0.490, 0.455}},
    [PAVING] = {"Paving", {0.600, 0.580, 0.540}},
    [STONE] = {"Granite", {0.380, 0.370, 0.350}},
    [ASPHALT] = {"Asphalt", {0.300, 0.300, 0.310}},
    [BARK] = {"Bark", {0.230, 0.160, 0.110}},
    [LEAVES] = {"Leaves", {0.150, 0.290, 0.090}},
    [PERSON] = {"Card", {0.230, 0.220, 0.240}},
};

enum { STRUCTURE, FRONTS, ENTRANCE, INSIDE, ROOF, STREET, PEOPLE, GROUPS };

static const model_group groups[GROUPS] = {
    [STRUCTURE] = {"structure", {0}}, [FRONTS] = {"fronts", {0}}, [ENTRANCE] = {"entrance", {0}},
    [INSIDE] = {"inside", {0}},       [ROOF] = {"roof", {0}},     [STREET] = {"street", {0}},
    [PEOPLE] = {"people", {0}},
};

static const model_part parts[] = {
    {"slabs", STRUCTURE, WHITE, build_slabs, {0}},
    {"ground floor", STRUCTURE, CONCRETE, build_ground_floor, {0}},
    {"party walls", STRUCTURE, CONCRETE, build_party_walls, {0}},
    {"columns", STRUCTURE, CONCRETE, build_columns, {0}},
    {"core", STRUCTURE, CONCRETE, build_core, {0}},
    {"glass ground", FRONTS, GLASS, build_glass_ground, {0}},
    {"glass first", FRONTS, GLASS, build_glass_first, {0}},
    {"glass second", FRONTS, GLASS, build_glass_second, {0}},
    {"glass third", FRONTS, GLASS, build_glass_third, {0}},
    {"mullions", FRONTS, STEEL, build_mullions, {0}},
    {"fins", FRONTS, ALUMINIUM, build_fins, {0}},
    {"bands", FRONTS, WHITE, build_bands, {0}},
    {"canopy", ENTRANCE, WHITE, build_canopy, {0}},
    {"canopy columns", ENTRANCE, STEEL, build_canopy_columns, {0}},
    {"revolving door", ENTRANCE, STEEL, build_revolving_door, {0}},
    {"sign", ENTRANCE, SIGN, build_sign, {0}},
    {"sign letters", ENTRANCE, LETTERS, build_letters, {0}},
    {"escalators", INSIDE, STEEL, build_escalators, {0}},
    {"balustrades", INSIDE, STEEL, build_balustrades, {0}},
    {"counters", INSIDE, WARM, build_counters, {0}},
    {"lift doors", INSIDE, STEEL, build_lift_doors, {0}},
    {"parapet", ROOF, WHITE, build_parapet, {0}},
    {"railing", ROOF, STEEL, build_railing, {0}},
    {"pavilion glass", ROOF, GLASS, build_pavilion_glass, {0}},
    {"pavilion mullions", ROOF, STEEL, build_pavilion_mullions, {0}},
    {"pavilion walls", ROOF, CONCRETE, build_pavilion_walls, {0}},
    {"pavilion roof", ROOF, WHITE, build_pavilion_roof, {0}},
    {"plant room", ROOF, CONCRETE, build_plant_capacity, {0}},
    {"louvres", ROOF, STEEL, build_louvres, {0}},
    {"roof light", ROOF, GLASS, build_roof_light, {0}},
    {"tables", ROOF, WARM, build_tables, {0}},
    {"planters", ROOF, CONCRETE, build_planters, {0}},
    {"plants", ROOF, LEAVES, build_plants, {0}},
    {"street", STREET, ASPHALT, build_street, {0}},
    {"pavement", STREET, PAVING, build_pavement, {0}},
    {"kerb", STREET, STONE, build_kerb, {0}},
    {"paving panels", STREET, PANELS, build_paving_panels, {0}},
    {"bollards", STREET, STEEL, build_bollards, {0}},
    {"lamps", STREET, STEEL, build_lamps, {0}},
    {"tree 1", STREET, BARK, build_first_tree, {0}},
    {"tree 2", STREET, BARK, build_second_tree, {0}},
    {"tree grates", STREET, STONE, build_tree_grates, {0}},
    {"people", PEOPLE, PERSON, build_people, {0}},
    {"customers", PEOPLE, PERSON, build_customers, {0}},
};

int main(int count, char **arguments)
{
    const model store = {"make_store", "Department store", 1,   materials, MATERIALS, groups, GROUPS,
                         parts,        COUNT(parts),       NULL};
    return count == 2 && model_write(&store, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
