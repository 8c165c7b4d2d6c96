/* Writes the example model of a medieval cloister: make_cloister OUT.glb
 *
 * The garth with its well lies in the middle, an arcaded walk on each side, a church with a tower in the north and a
 * range in the west. All sides are told as the north one and turned: the walk lies towards −z, the garth towards +z.
 * Metres, +y is up. */
#include "facade.h"
#include "model.h"
#include "pieces.h"

#include <math.h>
#include <stdlib.h>

/* --- dimensions that parts share ------------------------------------------------------------------------ */

enum { BAYS = 3, ARCHES = 3, ARCH_ROUND = 18 };

static const double garth = 9, walk = 9.6, wall = 13.6, outside = 14.4; /* distances from the middle */
static const double arcade = 9.3;                                       /* the middle of the arcade's wall */
static const double pier_corner = 8.85, pier = 0.8;
static const double floor_top = 0.18, coping = 0.82, springing = 2.42, arcade_top = 3.62;
static const double eave = 8.55, eave_height = 3.86, slope = 0.42;
static const double nave_back = 22.6, nave_axis = 18.1, nave_eave = 10.2, nave_east = 17;
static const double range_axis = 17.6, range_eave = 8.5;
static const double tower_axis = 17.3, tower_half = 3, tower_top = 20.6;

static double bay_width(void)
{
    return (2 * pier_corner - (BAYS - 1) * pier) / BAYS;
}

static double bay_start(int bay)
{
    return -pier_corner + bay * (bay_width() + pier);
}

static double pitch(void)
{
    return bay_width() / ARCHES;
}

static double arch_radius(void)
{
    return (pitch() - 0.32) / 2;
}

/* The top of a walk's roof where it is so far from the middle. */
static double roof_height(double distance)
{
    return eave_height + slope * (distance - eave);
}

/* --- the arcade ----------------------------------------------------------------------------------------- */

static void parapet(mesh *m, double left, double right)
{
    box(m, left, -0.23, -walk, right, coping - 0.08, -garth);
    box(m, left - 0.01, coping - 0.1, -walk - 0.05, right + 0.01, coping, -garth + 0.05);
}

/* The parapet of the middle bay has a gap in the middle, where one goes into the garth. */
static void parapets(mesh *m)
{
    for (int bay = 0; bay < BAYS; bay++) {
        double left = bay_start(bay) - 0.08, right = bay_start(bay) + bay_width() + 0.08;
        if (bay != BAYS / 2) {
            parapet(m, left, right);
            continue;
        }
        parapet(m, left, -pitch() / 2 + 0.2);
        parapet(m, pitch() / 2 - 0.2, right);
        box(m, -pitch() / 2, -0.23, -walk + 0.02, pitch() / 2, floor_top - 0.01, -garth + 0.01);
        box(m, -pitch() / 2 + 0.22, -0.23, -garth - 0.01, pitch() / 2 - 0.22, floor_top / 2, -garth + 0.36);
    }
}

static void build_arcade(mesh *m)
{
    outline o = {0};
    parapets(m);
    add_point(&o, -garth, springing - 0.04);
    for (int bay = 0; bay < BAYS; bay++)
        for (int k = 0; k < ARCHES; k++) {
            double middle = bay_start(bay) + (k + 0.5) * pitch(), radius = arch_radius();
            add_point(&o, middle - radius, springing - 0.04);
            add_arc(&o, middle, springing, radius, 180, 0, ARCH_ROUND);
            add_point(&o, middle + radius, springing - 0.04);
            outline frame = round_headed_frame(middle, springing - 0.03, springing, radius - 0.012, 0.15, ARCH_ROUND);
            elevation(m, &frame, NULL, 0, -walk + 0.02, -garth - 0.02);
        }
    add_point(&o, garth, springing - 0.04);
    add_point(&o, garth, arcade_top);
    add_point(&o, -garth, arcade_top);
    elevation(m, &o, NULL, 0, -walk + 0.05, -garth - 0.05);
}

/* Corbels under a moulded slab, mitred in the corners with a joint. */
static void build_cornice(mesh *m)
{
    outline      slab = {0}, corbel = {0};
    const double joint = 0.004, ends[2][2] = {{joint, 1}, {-joint, -1}};
    add_point(&slab, -walk, arcade_top - 0.02);
    add_point(&slab, -garth + 0.02, arcade_top - 0.02);
    add_point(&slab, -garth + 0.2, arcade_top + 0.07);
    add_point(&slab, -garth + 0.2, arcade_top + 0.13);
    add_point(&slab, -walk, arcade_top + 0.13);
    mitred_section(m, &slab, ends[0], ends[1]);
    add_point(&corbel, -garth - 0.1, arcade_top - 0.26);
    add_point(&corbel, -garth + 0.02, arcade_top - 0.2);
    add_point(&corbel, -garth + 0.13, arcade_top - 0.08);
    add_point(&corbel, -garth + 0.13, arcade_top + 0.01);
    add_point(&corbel, -garth - 0.1, arcade_top + 0.01);
    double step = pitch() / 3;
    for (int k = -14; k <= 14; k++)
        section(m, &corbel, k * step - 0.07, k * step + 0.07);
}

static outline impost_outline(double half, double bottom, double top)
{
    outline o = {0};
    double  edge = (top - bottom) * 0.45;
    add_point(&o, -half + edge, bottom);
    add_point(&o, half - edge, bottom);
    add_point(&o, half, bottom + edge);
    add_point(&o, half, top);
    add_point(&o, -half, top);
    add_point(&o, -half, bottom + edge);
    return o;
}

/* A capital goes from the round of its column to the square of the impost. */
static void capital(mesh *m, double x, double z)
{
    enum { AROUND = 12, STEPS = 3 };
    static const double shape[STEPS][3] = {{1.88, 0.086, 0}, {2.04, 0.103, 0.3}, {2.26, 0.142, 1}};
    const frame         f = {{x, 0, z}, UP};
    ring                rings[STEPS];
    for (int k = 0; k < STEPS; k++) {
        outline o = {0};
        for (int i = 0; i < AROUND; i++) {
            double angle = 2 * PI * (i + 0.5) / AROUND, u = cos(angle), v = sin(angle);
            double radius = shape[k][1] * (1 - shape[k][2] + shape[k][2] / fmax(fabs(u), fabs(v)));
            add_point(&o, radius * u, radius * v);
        }
        rings[k] = put_ring(m, &f, &o, shape[k][0]);
        if (k > 0)
            sew(m, &rings[k - 1], &rings[k]);
    }
    cap(m, DOWN, &rings[0], NULL, 0);
    cap(m, UP, &rings[STEPS - 1], NULL, 0);
}

/* Two columns one behind the other on a plinth, with an impost over both. */
static void column_pair(mesh *m, double x)
{
    outline  impost = impost_outline(0.17, springing - 0.18, springing - 0.02);
    uint32_t kept = m->point_count;
    box(m, x - 0.15, coping - 0.02, -arcade - 0.3, x + 0.15, coping + 0.08, -arcade + 0.3);
    for (int side = -1; side <= 1; side += 2) {
        double z = -arcade + 0.155 * side;
        TURNED(m, x, 0, z, 12, {coping + 0.06, 0}, {coping + 0.06, 0.135}, {coping + 0.13, 0.138},
               {coping + 0.2, 0.094}, {1.84, 0.083}, {1.86, 0.102}, {1.9, 0.094}, {1.9, 0});
        capital(m, x, z);
    }
    kept = m->point_count;
    elevation(m, &impost, NULL, 0, -0.31, 0.31);
    position(m, kept, 0, x, 0, -arcade);
}

/* A flat respond at a pier. */
static void respond(mesh *m, double x)
{
    outline  impost = impost_outline(0.17, springing - 0.18, springing - 0.02);
    uint32_t kept = m->point_count;
    elevation(m, &impost, NULL, 0, -0.31, 0.31);
    box(m, -0.15, coping - 0.02, -0.3, 0.15, coping + 0.12, 0.3);
    box(m, -0.1, coping + 0.1, -0.24, 0.1, springing - 0.17, 0.24);
    position(m, kept, 0, x, 0, -arcade);
}

static void build_columns(mesh *m)
{
    for (int bay = 0; bay < BAYS; bay++)
        for (int k = 0; k <= ARCHES; k++) {
            double x = bay_start(bay) + k * pitch();
            if (k > 0 && k < ARCHES)
                column_pair(m, x);
            else
                respond(m, x + (k ? -0.04 : 0.04)); /* its impost stands out of the pier's */
        }
}

/* The pier between two bays with its buttress, and a corner pier on the left. */
static void build_piers(mesh *m)
{
    outline      o = {0};
    const double foot = -garth + 0.58, shaft = -garth + 0.5;
    add_point(&o, -garth - 0.3, -0.2);
    add_point(&o, foot, -0.2);
    add_point(&o, foot, 0.5);
    add_point(&o, shaft, 0.58);
    add_point(&o, shaft, 2.3);
    add_point(&o, shaft + 0.06, 2.3);
    add_point(&o, shaft + 0.06, 2.38);
    add_point(&o, -garth - 0.02, 3.1);
    add_point(&o, -garth - 0.3, 3.1);
    for (int k = 1; k < BAYS; k++) {
        double middle = bay_start(k) - pier / 2;
        box(m, middle - pier / 2, -0.2, -walk - 0.03, middle + pier / 2, springing - 0.03, -garth + 0.03);
        box(m, middle - pier / 2 - 0.05, springing - 0.15, -walk - 0.08, middle + pier / 2 + 0.05, springing,
            -garth + 0.08);
        section(m, &o, middle - 0.29, middle + 0.29);
    }
    const double corner = -arcade;
    box(m, corner - 0.45, -0.26, corner - 0.45, corner + 0.45, arcade_top - 0.01, corner + 0.45);
    box(m, corner - 0.52, -0.26, corner - 0.52, corner + 0.52, 0.62, corner + 0.52);
    box(m, corner - 0.5, springing - 0.15, corner - 0.5, corner + 0.5, springing, corner + 0.5);
}

/* --- roofs ---------------------------------------------------------------------------------------------- */

/* The upper side of a roof from its eave up: courses of tiles, each with its lower edge over the one below. */
static void add_courses(outline *o, double u, double v, double to_u, double to_v, int courses)
{
    const double lip = 0.05;
    for (int k = 0; k < courses; k++) {
        double from = (double)k / courses, to = (double)(k + 1) / courses;
        add_point(o, u + (to_u - u) * from, v + (to_v - v) * from + lip);
        add_point(o, u + (to_u - u) * to, v + (to_v - v) * to);
    }
}

/* Two roofs meet in a valley. Each reaches a little into the other. */
static void build_walk_roof(mesh *m)
{
    outline      o = {0};
    const double top = wall + 0.06, into = 0.03, ends[2][2] = {{-into, 1}, {into, -1}};
    add_courses(&o, -eave, eave_height, -top, roof_height(top), 9);
    add_point(&o, -top, roof_height(top) - 0.13);
    add_point(&o, -eave, eave_height - 0.13);
    mitred_section(m, &o, ends[0], ends[1]);
}

static void build_rafters(mesh *m)
{
    const double step = pitch() / 2, top = wall + 0.05;
    box(m, -arcade - 0.12, arcade_top + 0.11, -arcade - 0.12, arcade - 0.12, arcade_top + 0.3, -arcade + 0.12);
    box(m, -wall - 0.01, roof_height(wall - 0.2) - 0.5, -wall - 0.02, wall - 0.18, roof_height(wall - 0.2) - 0.29,
        -wall + 0.18);
    for (int k = -14; k <= 14; k++) {
        outline o = {0};
        double  x = k * step, low = fmax(arcade - 0.1, fabs(x) + 0.02);
        add_point(&o, -low, roof_height(low) - 0.32);
        add_point(&o, -low, roof_height(low) - 0.11);
        add_point(&o, -top, roof_height(top) - 0.11);
        add_point(&o, -top, roof_height(top) - 0.32);
        section(m, &o, x - 0.07, x + 0.07);
    }
    const double low[3] = {-arcade, roof_height(arcade) - 0.26, -arcade},
                 high[3] = {-top, roof_height(top) - 0.26, -top};
    bar(m, low, high, 0.17, 0.17, 4);
}

/* A gable roof over a section that is symmetric about u = 0: `half` to the eaves, `rise` at the ridge. */
static outline gable_roof(double half, double height, double rise, int courses)
{
    outline      o = {0};
    const double thick = 0.2;
    for (int side = 1; side >= -1; side -= 2) {
        outline direction = {0};
        add_courses(&direction, side * half, height, 0, height + rise, courses);
        for (int k = 0; k < direction.count - 1; k++) {
            int i = side > 0 ? k : direction.count - 2 - k;
            add_point(&o, direction.at[i][0], direction.at[i][1]);
        }
        if (side > 0)
            add_point(&o, 0, height + rise);
    }
    add_point(&o, -half, height - thick);
    add_point(&o, 0, height + rise - thick * 1.3);
    add_point(&o, half, height - thick);
    return o;
}

/* --- the walls at the walks ----------------------------------------------------------------------------- */

static const opening church_openings[] = {
    {-11.8, 0.18, 2.3, 0.7, DOOR}, {11.2, 0.18, 2.7, 1.0, DOOR}, {-12.5, 7.1, 8.6, 0.42, PANE},
    {-8.3, 7.1, 8.6, 0.42, PANE},  {-4.1, 7.1, 8.6, 0.42, PANE}, {0.1, 7.1, 8.6, 0.42, PANE},
    {4.3, 7.1, 8.6, 0.42, PANE},   {8.5, 7.1, 8.6, 0.42, PANE},  {12.7, 7.1, 8.6, 0.42, PANE},
};
static const opening range_openings[] = {
    {0, 0.18, 2.2, 0.85, DOOR},  {-2.75, 1, 2.2, 0.42, PANE},  {-1.75, 1, 2.2, 0.42, PANE},
    {1.75, 1, 2.2, 0.42, PANE},  {2.75, 1, 2.2, 0.42, PANE},   {-9.5, 0.18, 2.1, 0.65, DOOR},
    {9, 0.18, 2.1, 0.65, DOOR},  {-11.1, 6.7, 7.5, 0.3, PANE}, {-7.4, 6.7, 7.5, 0.3, PANE},
    {-3.7, 6.7, 7.5, 0.3, PANE}, {0, 6.7, 7.5, 0.3, PANE},     {3.7, 6.7, 7.5, 0.3, PANE},
    {7.4, 6.7, 7.5, 0.3, PANE},  {11.1, 6.7, 7.5, 0.3, PANE},
};
static const opening south_openings[] = {
    {2.7, 0.18, 2.2, 0.75, DOOR},
    {-8.05, 1.6, 2.6, 0.4, PANE},
    {-2.7, 1.6, 2.6, 0.4, PANE},
    {8.05, 1.6, 2.6, 0.4, PANE},
};
static const opening east_openings[] = {
    {-8.05, 0.18, 2.2, 0.7, DOOR},
    {-2.7, 1.6, 2.6, 0.4, PANE},
    {2.7, 1.6, 2.6, 0.4, PANE},
    {8.05, 1.6, 2.6, 0.4, PANE},
};

/* In the order of the groups. West and east stand between the others. */
static const facade walk_walls[4] = {
    {-14.38, 16.21, -0.4, 10.19, -14.4, -13.62, church_openings, COUNT(church_openings)},
    {-13.6, 13.6, -0.4, 8.5, -14.4, -13.6, range_openings, COUNT(range_openings)},
    {-14.4, 14.4, -0.4, 6.5, -14.4, -13.6, south_openings, COUNT(south_openings)},
    {-13.6, 13.6, -0.4, 6.48, -14.4, -13.6, east_openings, COUNT(east_openings)},
};

enum { NORTH, WEST, SOUTH, EAST };

/* A bench along the wall, as far as doors let it. */
static void bench(mesh *m, const facade *f)
{
    double from = -wall + 0.1;
    for (bool more = true; more;) {
        const opening *next = NULL;
        for (int k = 0; k < f->count; k++) {
            const opening *a = &f->openings[k];
            if (a->filling == DOOR && a->x > from && (!next || a->x < next->x))
                next = a;
        }
        more = next;
        double to = next ? next->x - next->radius - 0.4 : wall - 0.45; /* where the next side's begins */
        if (to - from > 1.2) {
            box(m, from, -0.1, -wall - 0.02, to, floor_top + 0.36, -wall + 0.36);
            box(m, from - 0.03, floor_top + 0.34, -wall - 0.02, to + 0.03, floor_top + 0.44, -wall + 0.42);
        }
        if (next)
            from = next->x + next->radius + 0.4;
    }
}

#define WALK_WALL(side, SIDE)                                                                                          \
    static void build_##side##_wall(mesh *m)                                                                           \
    {                                                                                                                  \
        facade_wall(m, &walk_walls[SIDE]);                                                                             \
    }                                                                                                                  \
    static void build_##side##_frames(mesh *m)                                                                         \
    {                                                                                                                  \
        facade_frames(m, &walk_walls[SIDE]);                                                                           \
        bench(m, &walk_walls[SIDE]);                                                                                   \
    }                                                                                                                  \
    static void build_##side##_doors(mesh *m)                                                                          \
    {                                                                                                                  \
        facade_doors(m, &walk_walls[SIDE]);                                                                            \
    }                                                                                                                  \
    static void build_##side##_panes(mesh *m)                                                                          \
    {                                                                                                                  \
        facade_panes(m, &walk_walls[SIDE]);                                                                            \
    }

WALK_WALL(north, NORTH)
WALK_WALL(west, WEST)
WALK_WALL(south, SOUTH)
WALK_WALL(east, EAST)

/* What the walls have outside where nothing stands behind them: coping, buttresses, frames around the openings. */
static void outer_side(mesh *m, const facade *f, double half)
{
    const double top = f->top;
    outline      saddle = {0}, buttress = {0};
    add_point(&saddle, -outside - 0.16, top - 0.02);
    add_point(&saddle, -wall + 0.16, top - 0.02);
    add_point(&saddle, -wall + 0.16, top + 0.06);
    add_point(&saddle, -(wall + outside) / 2, top + 0.34);
    add_point(&saddle, -outside - 0.16, top + 0.06);
    section(m, &saddle, -half, half);
    add_point(&buttress, -outside + 0.13, -0.45);
    add_point(&buttress, -outside - 1.1, -0.45);
    add_point(&buttress, -outside - 1.1, 0.6);
    add_point(&buttress, -outside - 1, 0.7);
    add_point(&buttress, -outside - 1, 2.6);
    add_point(&buttress, -outside - 0.6, 3.1);
    add_point(&buttress, -outside - 0.6, 4.6);
    add_point(&buttress, -outside - 0.03, 5.4);
    add_point(&buttress, -outside + 0.13, 5.4);
    for (int k = -2; k <= 2; k++)
        section(m, &buttress, k * 5.37 - 0.41, k * 5.37 + 0.41);
    facade_outer_frames(m, f);
}

static void build_south_outside(mesh *m)
{
    outer_side(m, &walk_walls[SOUTH], outside + 0.02);
}

static void build_east_outside(mesh *m)
{
    outer_side(m, &walk_walls[EAST], wall + 0.1);
}

/* --- floors and the garth ------------------------------------------------------------------------------- */

/* Slabs in three rows along the walk and through the corner on its right. Every other one is of a part of its own,
 * as parts always show a border, and joints that are narrower than a pixel do not. */
static void slabs(mesh *m, int parity)
{
    enum { ROWS = 3, LENGTH = 18 };
    const double joint = 0.008, left = -walk - 0.01, wide = (wall - walk - 0.02) / ROWS, size = (wall + walk) / LENGTH;
    for (int row = 0; row < ROWS; row++)
        for (int k = parity ^ (row & 1); k < LENGTH; k += 2) {
            double front = -walk - 0.01 - row * wide, from = left + k * size;
            box(m, from + joint, -0.3, front - wide + joint, from + size - joint, floor_top, front - joint);
        }
}

static void build_walk_floor(mesh *m)
{
    slabs(m, 0);
}

static void build_walk_floor_between(mesh *m)
{
    slabs(m, 1);
}

static void build_walk_ground(mesh *m)
{
    outline outer = rectangle(-outside + 0.2, -outside + 0.2, outside - 0.2, outside - 0.2);
    outline hole = rectangle(-garth - 0.1, -garth - 0.1, garth + 0.1, garth + 0.1);
    plan(m, &outer, &hole, 1, -0.5, floor_top - 0.015);
}

static void build_lawn(mesh *m)
{
    box(m, -garth - 0.15, -0.45, -garth - 0.15, garth + 0.15, 0, garth + 0.15);
}

static void build_path(mesh *m)
{
    for (int k = 0; k < 6; k++)
        for (int side = -1; side <= 1; side += 2) {
            double back = -garth + 0.4 + k * 1.04, split = k % 2 ? 0.15 : -0.15;
            box(m, side < 0 ? -0.85 : split + 0.03, -0.1, back + 0.03, side < 0 ? split - 0.03 : 0.85, 0.06,
                back + 1.01);
        }
}

/* One quarter of the garth: hedges around a bed. */
static void build_hedge(mesh *m)
{
    static const double rounds[2][2] = {{1.7, 7.6}, {2.15, 7.15}};
    outline             o[2];
    for (int k = 0; k < 2; k++) {
        double from = rounds[k][0], to = rounds[k][1];
        o[k] = (outline){0};
        add_point(&o[k], from, -from - 1.9 + 0.4 * k);
        add_point(&o[k], from + 1.9 - 0.4 * k, -from);
        add_point(&o[k], to, -from);
        add_point(&o[k], to, -to);
        add_point(&o[k], from, -to);
    }
    plan(m, &o[0], &o[1], 1, -0.1, 0.5);
}

static void build_shrubs(mesh *m)
{
    static const double positions[][3] = {{3.4, -3.9, 0.5}, {5.9, -3.3, 0.42}, {3.1, -6.1, 0.4}, {6.1, -6, 0.55}};
    for (int k = 0; k < COUNT(positions); k++) {
        const double middle[3] = {positions[k][0], positions[k][2] * 0.8, positions[k][1]};
        foliage(m, middle, positions[k][2], positions[k][2], (uint32_t)k + 7);
    }
}

static void build_tree(mesh *m)
{
    const double foot[3] = {-4.7, -0.1, 4.7};
    tree(m, foot, 5.6, 11);
}

static void build_well(mesh *m)
{
    ring        first, last;
    const frame f = {.along = UP};
    TURNED(m, 0, 0, 0, 8, {-0.1, 0}, {-0.1, 2.15}, {0.14, 2.15}, {0.14, 0});
    TURNED(m, 0, 0, 0, 8, {0.1, 0}, {0.1, 1.62}, {0.3, 1.62}, {0.3, 0});
    LATHE(m, &f, 8, &first, &last, {0.28, 1.02}, {0.4, 1.02}, {0.46, 0.95}, {1.02, 0.95}, {1.02, 1.06}, {1.16, 1.06},
          {1.2, 1.02}, {1.2, 0.74}, {1.16, 0.7}, {0.28, 0.7});
    sew(m, &last, &first);
}

static void build_well_frame(mesh *m)
{
    for (int side = -1; side <= 1; side += 2) {
        const double low[3] = {1.2 * side, 2.35, 0}, high[3] = {0.62 * side, 3.03, 0};
        box(m, 1.2 * side - 0.09, 0.28, -0.09, 1.2 * side + 0.09, 3.06, 0.09);
        box(m, 1.2 * side - 0.075, 3.0, -0.85, 1.2 * side + 0.075, 3.15, 0.85);
        bar(m, low, high, 0.07, 0.07, 4);
        for (int direction = -1; direction <= 1; direction += 2) {
            const double foot[3] = {1.2 * side, 2.5, 0}, head[3] = {1.2 * side, 3.04, 0.6 * direction};
            bar(m, foot, head, 0.06, 0.06, 4);
        }
    }
    box(m, -1.4, 2.98, -0.08, 1.4, 3.13, 0.08);
    const double windlass[2][3] = {{-1.35, 1.85, 0}, {1.45, 1.85, 0}}, crank[2][3] = {{1.43, 1.88, 0}, {1.43, 1.5, 0}};
    const double handle[2][3] = {{1.4, 1.52, 0}, {1.75, 1.52, 0}}, rope[2][3] = {{0, 1.85, 0.1}, {0, 1.28, 0.1}};
    const double drum[2][3] = {{-0.4, 1.85, 0}, {0.4, 1.85, 0}};
    bar(m, windlass[0], windlass[1], 0.05, 0.05, 10);
    bar(m, drum[0], drum[1], 0.11, 0.11, 12);
    bar(m, crank[0], crank[1], 0.025, 0.025, 8);
    bar(m, handle[0], handle[1], 0.022, 0.022, 8);
    bar(m, rope[0], rope[1], 0.014, 0.014, 6);
    TURNED(m, 0, 0, 0.1, 14, {0.96, 0}, {0.96, 0.14}, {1.3, 0.18}, {1.3, 0});
}

static void build_well_roof(mesh *m)
{
    outline o = gable_roof(1.12, 3.06, 0.95, 5);
    section(m, &o, -1.55, 1.55);
}

/* --- church, range, tower ------------------------------------------------------------------------------- */

static const opening nave_openings[] = {
    {-11, 4, 8, 0.6, PANE}, {-5.5, 4, 8, 0.6, PANE}, {0, 4, 8, 0.6, PANE},
    {5.5, 4, 8, 0.6, PANE}, {11, 4, 8, 0.6, PANE},
};
static const facade nave_wall = {-14.35, 16.21, -0.36, 10.19, -22.58, -21.8, nave_openings, COUNT(nave_openings)};

static void build_nave(mesh *m)
{
    outline gable = {0}, copings = gable_roof(4.75, nave_eave + 0.12, 5.3, 1);
    add_point(&gable, -nave_back, -0.36);
    add_point(&gable, -wall, -0.36);
    add_point(&gable, -wall, nave_eave);
    add_point(&gable, -nave_axis, nave_eave + 5.05);
    add_point(&gable, -nave_back, nave_eave);
    facade_wall(m, &nave_wall);
    section(m, &gable, nave_east - 0.8, nave_east);
    section(m, &gable, -outside - 0.02, -outside + 0.7);
    uint32_t kept = m->point_count;
    section(m, &copings, nave_east - 0.42, nave_east + 0.08);
    position(m, kept, 0, 0, 0, -nave_axis);
    for (int k = 0; k < 6; k++) { /* pilaster strips between the windows over the walk's roof */
        double x = -10.4 + 4.2 * k;
        box(m, x - 0.25, roof_height(wall), -wall - 0.1, x + 0.25, nave_eave - 0.3, -wall + 0.12);
    }
    box(m, -14.35, nave_eave - 0.32, -wall - 0.1, 16.95, nave_eave - 0.05, -wall + 0.2);
    box(m, -13.2, roof_height(wall) + 0.1, -wall - 0.1, 15.9, roof_height(wall) + 0.26, -wall + 0.09);
}

static void build_nave_frames(mesh *m)
{
    facade_outer_frames(m, &nave_wall);
}

static void build_nave_panes(mesh *m)
{
    facade_panes(m, &nave_wall);
}

static void build_nave_roof(mesh *m)
{
    outline  o = gable_roof(4.98, nave_eave - 0.28, 5.55, 13);
    uint32_t kept = m->point_count;
    section(m, &o, -14.5, nave_east - 0.35);
    position(m, kept, 0, 0, 0, -nave_axis);
}

/* The apse: a drum with pilaster strips and windows that are only drawn on it. */
static void build_apse(mesh *m)
{
    TURNED(m, nave_east - 0.4, 0, -nave_axis, 28, {-0.33, 0}, {-0.33, 3.3}, {0.6, 3.3}, {0.7, 3.2}, {6.7, 3.2},
           {6.7, 3.36}, {6.95, 3.42}, {6.95, 0});
    for (int k = -2; k <= 2; k++) {
        uint32_t kept = m->point_count;
        outline  o = round_headed_frame(0, 2.6, 4.6, 0.36, 0.16, WINDOW_ROUND);
        if (k % 2 == 0) {
            elevation(m, &o, NULL, 0, 3.0, 3.27);
            box(m, -0.6, 2.48, 3, 0.6, 2.62, 3.32);
        } else {
            box(m, -0.2, 0.5, 3, 0.2, 6.75, 3.3);
        }
        position(m, kept, 90 + k * 30, nave_east - 0.4, 0, -nave_axis);
    }
}

static void build_apse_roof(mesh *m)
{
    enum { COURSES = 6 };
    double profile[2 * COURSES + 2][2] = {{6.93, 0}};
    int    count = 1;
    for (int k = 0; k < COURSES; k++) {
        profile[count][0] = 6.93 + 2.4 * k / COURSES + (k ? 0.09 : 0);
        profile[count++][1] = 3.62 * (1 - (double)k / COURSES);
        profile[count][0] = 6.97 + 2.4 * (k + 1) / COURSES;
        profile[count++][1] = k + 1 < COURSES ? 3.62 * (1 - (double)(k + 1) / COURSES) : 0;
    }
    lathe(m, &(frame){{nave_east - 0.4, 0, -nave_axis}, UP}, (const double(*)[2])profile, count, 28, NULL, NULL);
}

static const opening range_west_openings[] = {
    {-10, 4.8, 6.2, 0.45, PANE}, {-5, 4.8, 6.2, 0.45, PANE}, {0, 4.8, 6.2, 0.45, PANE},
    {5, 4.8, 6.2, 0.45, PANE},   {10, 4.8, 6.2, 0.45, PANE}, {-7.5, 1, 1.8, 0.35, PANE},
    {-2.5, 1, 1.8, 0.35, PANE},  {2.5, 1, 1.8, 0.35, PANE},  {7.5, 1, 1.8, 0.35, PANE},
};
static const facade range_west_wall = {
    -13.65, 14.6, -0.42, 8.49, -21.6, -20.8, range_west_openings, COUNT(range_west_openings)};
static const opening range_gable_openings[] = {
    {-2, 1.2, 2.6, 0.5, PANE}, {2, 1.2, 2.6, 0.5, PANE},  {-2, 5.2, 6.7, 0.45, PANE},
    {0, 5.2, 6.7, 0.45, PANE}, {2, 5.2, 6.7, 0.45, PANE}, {0, 9.6, 10.5, 0.3, PANE},
};
static const facade range_gable = {-4, 4, -0.4, 8.5, 13.62, 14.42, range_gable_openings, COUNT(range_gable_openings)};

/* The outer walls of the west range; its wall at the walk is a part of the walk. */
static void build_range(mesh *m)
{
    outline gable = {0}, holes[COUNT(range_gable_openings)];
    facade_wall(m, &range_west_wall);
    position(m, 0, 90, 0, 0, 0);
    add_point(&gable, -4, -0.42);
    add_point(&gable, 4, -0.42);
    add_point(&gable, 4, range_eave);
    add_point(&gable, 0, range_eave + 4.2);
    add_point(&gable, -4, range_eave);
    for (int k = 0; k < range_gable.count; k++) {
        const opening *a = &range_gable.openings[k];
        holes[k] = round_headed(a->x, a->sill, a->springing, a->radius, WINDOW_ROUND);
    }
    uint32_t kept = m->point_count;
    elevation(m, &gable, holes, range_gable.count, range_gable.back, range_gable.front);
    elevation(m, &gable, NULL, 0, -15.3, -14.5);
    position(m, kept, 0, -range_axis, 0, 0);
}

typedef void facade_maker(mesh *m, const facade *f);

static void fill_range_openings(mesh *m, facade_maker *of_gable, facade_maker *of_wall)
{
    of_gable(m, &range_gable);
    position(m, 0, 0, -range_axis, 0, 0);
    uint32_t kept = m->point_count;
    of_wall(m, &range_west_wall);
    position(m, kept, 90, 0, 0, 0);
}

static void build_range_frames(mesh *m)
{
    fill_range_openings(m, facade_frames, facade_outer_frames);
}

static void build_range_panes(mesh *m)
{
    fill_range_openings(m, facade_panes, facade_panes);
}

static void build_range_roof(mesh *m)
{
    outline  o = gable_roof(4.5, range_eave - 0.2, 4.75, 11);
    uint32_t kept = m->point_count;
    section(m, &o, -14.75, 15.0);
    position(m, kept, 90, -range_axis, 0, 0);
}

static const opening tower_openings[] = {{0, 5, 6, 0.16, OPEN},
                                         {0, 13.6, 14.6, 0.16, OPEN},
                                         {-0.72, 16.7, 18.5, 0.52, OPEN},
                                         {0.72, 16.7, 18.5, 0.52, OPEN}};

/* Told about its own middle, each face as the back one. */
static void build_tower(mesh *m)
{
    const double half = tower_half;
    const facade face = {-half + 0.9, half,        -0.44,          tower_top,
                         -half,       -half + 0.9, tower_openings, COUNT(tower_openings)};
    for (int k = 0; k < 4; k++) {
        uint32_t kept = m->point_count;
        facade_wall(m, &face);
        for (int w = 2; w < 4; w++) {
            const opening *a = &tower_openings[w];
            outline        o = round_headed_frame(a->x, a->sill, a->springing, a->radius - 0.015, 0.14, WINDOW_ROUND);
            elevation(m, &o, NULL, 0, -half - 0.05, -half + 0.2);
        }
        box(m, half - 0.95, -0.35, -half - 0.14, half + 0.14, 15.7, -half + 0.95); /* the corner's strip */
        for (int c = 0; c < 9; c++) {
            double x = -half + 0.3 + (2 * half - 0.6) * c / 8;
            box(m, x - 0.1, tower_top - 0.45, -half - 0.16, x + 0.1, tower_top - 0.1, -half + 0.1);
        }
        position(m, kept, 90 * k, 0, 0, 0);
    }
    static const double courses[][3] = {{0.5, 0.25, 0.3}, {12.2, 0.2, 0.2}, {15.6, 0.28, 0.24}, {20.45, 0.3, 0.34}};
    for (int k = 0; k < COUNT(courses); k++) {
        double  far = half + courses[k][2], low = courses[k][0];
        outline outer = rectangle(-far, -far, far, far),
                hole = rectangle(-half + 0.5, -half + 0.5, half - 0.5, half - 0.5);
        plan(m, &outer, &hole, 1, low, low + courses[k][1]);
    }
    box(m, -half + 0.4, 15.9, -half + 0.4, half - 0.4, 16.2, half - 0.4);
    position(m, 0, 0, -tower_axis, 0, -nave_axis);
}

static void build_tower_roof(mesh *m)
{
    enum { COURSES = 12 };
    const frame  f = {{-tower_axis, 0, -nave_axis}, UP};
    const double base = tower_top + 0.12, rise = 5.4, half = tower_half + 0.62;
    ring         before = {0};
    for (int k = 0; k <= 2 * COURSES - 1; k++) {
        double  at = (double)((k + 1) / 2) / COURSES, far = half * (1 - at);
        outline o = rectangle(-far, -far, far, far);
        ring    here = put_ring(m, &f, &o, base + rise * at + (k % 2 ? 0 : 0.09));
        if (k == 2 * COURSES - 1) {
            uint32_t tip = put_point(m, &f, 0, 0, base + rise);
            for (int i = 0; i < 4; i++)
                here.at[i] = tip;
        }
        for (int i = 0; i < 4 && k > 0; i++) {
            int j = (i + 1) % 4;
            put_triangle(m, before.at[i], before.at[j], here.at[j]);
            if (here.at[i] != here.at[j])
                put_triangle(m, before.at[i], here.at[j], here.at[i]);
        }
        if (k == 0) {
            ring low = put_ring(m, &f, &o, base - 0.1);
            sew(m, &low, &here);
            cap(m, DOWN, &low, NULL, 0);
        }
        before = here;
    }
}

static void build_cross(mesh *m)
{
    const double x = -tower_axis, z = -nave_axis, top = tower_top + 5.4;
    TURNED(m, x, 0, z, 16, {top - 0.15, 0}, {top - 0.1, 0.1}, {top + 0.12, 0.19}, {top + 0.3, 0.16}, {top + 0.42, 0.05},
           {top + 0.42, 0});
    box(m, x - 0.045, top + 0.36, z - 0.045, x + 0.045, top + 1.75, z + 0.045);
    box(m, x - 0.42, top + 1.18, z - 0.04, x + 0.42, top + 1.27, z + 0.04);
}

/* A monk with his hands in his sleeves, for scale; he looks to the front. */
static void build_monk(mesh *m)
{
    const double fold[3] = {0, 1.08, 0.22};
    TURNED(m, 0, 0, 0, 12, {-0.02, 0}, {-0.02, 0.31}, {0.5, 0.26}, {1.0, 0.2}, {1.36, 0.22}, {1.46, 0.13}, {1.5, 0.1},
           {1.6, 0.13}, {1.7, 0.115}, {1.78, 0.06}, {1.8, 0});
    for (int side = -1; side <= 1; side += 2) {
        const double shoulder[3] = {0.2 * side, 1.38, 0}, elbow[3] = {0.27 * side, 1.06, 0.03};
        bar(m, shoulder, elbow, 0.07, 0.085, 6);
        bar(m, elbow, fold, 0.085, 0.07, 6);
    }
}

static void build_bell(mesh *m)
{
    ring        first, last;
    const frame f = {{-tower_axis, 0, -nave_axis}, UP};
    LATHE(m, &f, 16, &first, &last, {17.3, 0.66}, {17.42, 0.68}, {17.6, 0.58}, {18.0, 0.46}, {18.35, 0.4}, {18.5, 0.24},
          {18.52, 0.02}, {18.44, 0.02}, {18.42, 0.2}, {18.3, 0.33}, {18.0, 0.39}, {17.55, 0.52}, {17.3, 0.6});
    sew(m, &last, &first);
}

static void build_bell_frame(mesh *m)
{
    const double x = -tower_axis, z = -nave_axis;
    box(m, x - tower_half + 0.6, 18.5, z - 0.12, x + tower_half - 0.6, 18.78, z + 0.12);
}

static void build_terrain(mesh *m)
{
    box(m, -25.5, -0.8, -26, 23.5, -0.06, 20);
}

/* --- stones that show ----------------------------------------------------------------------------------- */

static void build_south_stones(mesh *m)
{
    facade_stones(m, &walk_walls[SOUTH], false, 0.3, 6.2, 16, 3);
    quoins(m, -outside, -outside, 1, 1, 0, 6.4); /* the south-eastern corner of the whole */
}

static void build_east_stones(mesh *m)
{
    facade_stones(m, &walk_walls[EAST], false, 0.3, 6.2, 15, 29);
}

static void build_north_stones(mesh *m)
{
    facade_stones(m, &walk_walls[NORTH], true, 0.8, 5, 9, 17);
    facade_stones(m, &walk_walls[NORTH], true, 6.5, 9.6, 8, 4);
}

static void build_church_stones(mesh *m)
{
    const facade high = {nave_axis - 3.6, nave_axis + 3.6, 0, 0, 0, nave_east, NULL, 0};
    facade_stones(m, &high, true, 9.6, 12, 6, 9);
    position(m, 0, 90, 0, 0, 0);
    quoins(m, nave_east, -wall, -1, -1, 0, nave_eave - 0.3);
}

static void build_range_stones(mesh *m)
{
    facade_stones(m, &range_gable, true, 0.3, 8.4, 8, 21);
    position(m, 0, 0, -range_axis, 0, 0);
    quoins(m, -range_axis - 4, 14.42, 1, -1, 0, range_eave - 0.4);
    quoins(m, -range_axis + 4, 14.42, -1, -1, 0, range_eave - 0.4);
}

static void build_tower_stones(mesh *m)
{
    const facade face = {-tower_half + 1, tower_half - 1, 0, 0, 0, tower_half, tower_openings, COUNT(tower_openings)};
    for (int k = 0; k < 4; k++) {
        uint32_t kept = m->point_count;
        facade_stones(m, &face, true, 0.9, 15.4, 9, (uint32_t)k + 60);
        position(m, kept, 90 * k, 0, 0, 0);
    }
    position(m, 0, 0, -tower_axis, 0, -nave_axis);
}

/* --- the assembly --------------------------------------------------------------------------------------- */

typedef enum material {
    STONE,
    DRESSED,
    PLASTER,
    TILE,
    TIMBER,
    GRASS,
    PAVING,
    PAVING_TOO,
    LEAVES,
    GLASS,
    IRON,
    EARTH,
    HABIT,
    MATERIALS
} material;

static const model_material materials[MATERIALS] = {
    [STONE] = {"Stone", {0.560, 0.500, 0.400}},     [DRESSED] = {"Dressed stone", {0.690, 0.640, 0.530}},
    [PLASTER] = {"Plaster", {0.780, 0.730, 0.620}}, [TILE] = {"Tile", {0.520, 0.190, 0.095}},
    [TIMBER] = {"Timber", {0.240, 0.135, 0.070}},   [GRASS] = {"Grass", {0.260, 0.360, 0.120}},
    [PAVING] = {"Paving", {0.480, 0.440, 0.370}},   [PAVING_TOO] = {"Worn paving", {0.530, 0.490, 0.415}},
    [LEAVES] = {"Leaves", {0.110, 0.210, 0.065}},   [GLASS] = {"Leaded glass", {0.090, 0.120, 0.140}},
    [IRON] = {"Iron", {0.060, 0.060, 0.065}},       [HABIT] = {"Habit", {0.160, 0.120, 0.090}},
    [EARTH] = {"Earth", {0.420, 0.400, 0.260}},
};

enum { GARTH = 4, CHURCH, RANGE, TOWER, SITE, GROUPS };

static const model_group groups[GROUPS] = {
    [NORTH] = {"north walk", {0}},  [WEST] = {"west walk", {0}, 1}, [SOUTH] = {"south walk", {0}, 2},
    [EAST] = {"east walk", {0}, 3}, [GARTH] = {"garth", {0}},       [CHURCH] = {"church", {0}},
    [RANGE] = {"west range", {0}},  [TOWER] = {"bell tower", {0}},  [SITE] = {"site", {0}},
};

#define SIDE(side, GROUP)                                                                                              \
    {#side " arcade", GROUP, STONE, build_arcade, {0}}, {#side " cornice", GROUP, DRESSED, build_cornice, {0}},        \
        {#side " columns", GROUP, DRESSED, build_columns, {0}}, {#side " piers", GROUP, STONE, build_piers, {0}},      \
        {#side " roof", GROUP, TILE, build_walk_roof, {0}}, {#side " rafters", GROUP, TIMBER, build_rafters, {0}},     \
        {#side " floor", GROUP, PAVING, build_walk_floor, {0}},                                                        \
        {#side " floor between", GROUP, PAVING_TOO, build_walk_floor_between, {0}},                                    \
        {#side " wall", GROUP, PLASTER, build_##side##_wall, {0}},                                                     \
        {#side " frames", GROUP, DRESSED, build_##side##_frames, {0}},                                                 \
        {#side " doors", GROUP, TIMBER, build_##side##_doors, {0}},                                                    \
    {                                                                                                                  \
#side " windows", GROUP, GLASS, build_##side##_panes,                                                          \
        {                                                                                                              \
            0                                                                                                          \
        }                                                                                                              \
    }

static const model_part parts[] = {
    SIDE(north, NORTH),
    SIDE(west, WEST),
    SIDE(south, SOUTH),
    SIDE(east, EAST),
    {"south buttresses", SOUTH, STONE, build_south_outside, {0}},
    {"east buttresses", EAST, STONE, build_east_outside, {0}},
    {"north stones", NORTH, STONE, build_north_stones, {0}},
    {"south stones", SOUTH, STONE, build_south_stones, {0}},
    {"east stones", EAST, STONE, build_east_stones, {0}},
    {"church stones", CHURCH, STONE, build_church_stones, {0}},
    {"range stones", RANGE, STONE, build_range_stones, {0}},
    {"tower stones", TOWER, DRESSED, build_tower_stones, {0}},
    {"lawn", GARTH, GRASS, build_lawn, {0}},
    {"well", GARTH, DRESSED, build_well, {0}},
    {"well frame", GARTH, TIMBER, build_well_frame, {0}},
    {"well roof", GARTH, TILE, build_well_roof, {0}},
    {"tree", GARTH, TIMBER, build_tree, {0}},
    {"north path", NORTH, PAVING, build_path, {0}},
    {"west path", WEST, PAVING, build_path, {0}},
    {"south path", SOUTH, PAVING, build_path, {0}},
    {"east path", EAST, PAVING, build_path, {0}},
    {"north hedge", NORTH, LEAVES, build_hedge, {0}},
    {"west hedge", WEST, LEAVES, build_hedge, {0}},
    {"south hedge", SOUTH, LEAVES, build_hedge, {0}},
    {"east hedge", EAST, LEAVES, build_hedge, {0}},
    {"north shrubs", NORTH, LEAVES, build_shrubs, {0}},
    {"west shrubs", WEST, LEAVES, build_shrubs, {0}},
    {"east shrubs", EAST, LEAVES, build_shrubs, {0}},
    {"nave", CHURCH, PLASTER, build_nave, {0}},
    {"nave frames", CHURCH, DRESSED, build_nave_frames, {0}},
    {"nave windows", CHURCH, GLASS, build_nave_panes, {0}},
    {"nave roof", CHURCH, TILE, build_nave_roof, {0}},
    {"apse", CHURCH, STONE, build_apse, {0}},
    {"apse roof", CHURCH, TILE, build_apse_roof, {0}},
    {"range", RANGE, PLASTER, build_range, {0}},
    {"range frames", RANGE, DRESSED, build_range_frames, {0}},
    {"range windows", RANGE, GLASS, build_range_panes, {0}},
    {"range roof", RANGE, TILE, build_range_roof, {0}},
    {"tower", TOWER, STONE, build_tower, {0}},
    {"tower roof", TOWER, TILE, build_tower_roof, {0}},
    {"cross", TOWER, IRON, build_cross, {0}},
    {"bell", TOWER, IRON, build_bell, {0}},
    {"bell frame", TOWER, TIMBER, build_bell_frame, {0}},
    {"monk at the well", GARTH, HABIT, build_monk, {-1.1, 0, 3.2}},
    {"monk in the walk", EAST, HABIT, build_monk, {-2.5, 0.18, -10.9}},
    {"ground", SITE, EARTH, build_terrain, {0}},
    {"walk ground", SITE, STONE, build_walk_ground, {0}},
};

int main(int count, char **arguments)
{
    const model cloister = {"make_cloister", "Cloister", 1,     materials,    MATERIALS,
                            groups,          GROUPS,     parts, COUNT(parts), NULL};
    return count == 2 && model_write(&cloister, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
