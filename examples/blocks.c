#include "blocks.h"

#include "pieces.h"

#include <math.h>
#include <stddef.h>

static const double ground_floor = 4.0, storey = 3.2, footing = 0.05;

/* --- lots ----------------------------------------------------------------------------------------------- */

double row_start(int row)
{
    return -row * (BLOCK_LENGTH + CROSS_STREET);
}

static uint32_t seed_of(int a, int b)
{
    uint32_t seed = (uint32_t)(a * 7919 + b * 104729 + 12345);
    for (int i = 0; i < 3; i++)
        chance(&seed);
    return seed;
}

/* Where a lot begins along its block and how wide it is; `count` lots fill the block. */
static void share_out(int key, int lot, int count, double *start, double *width)
{
    uint32_t seed = seed_of(key, count);
    double   sum = 0, before = 0, own = 0;
    for (int i = 0; i < count; i++) {
        double part = 1 + 0.55 * chance(&seed);
        before += i < lot ? part : 0;
        own = i == lot ? part : own;
        sum += part;
    }
    *start = BLOCK_LENGTH * before / sum;
    *width = BLOCK_LENGTH * own / sum - 0.05; /* neighbours do not touch */
}

static building tower_of(building b, int row)
{
    b.roof = ROOF_TOWER;
    b.floors = 6 + row * 2 + (int)(5 * chance(&b.seed));
    b.width = fmin(b.width - 3.4, 13.5);
    b.depth = 12;
    return b;
}

building building_of(int index)
{
    int      row = index / (SIDES * LOTS), side = index / LOTS % SIDES, lot = index % LOTS;
    bool     front = lot < FRONT_LOTS, back = !front && lot < FRONT_LOTS + BACK_LOTS;
    int      count = front ? FRONT_LOTS : BACK_LOTS, position_in = front  ? lot
                                                                   : back ? lot - FRONT_LOTS
                                                                          : lot - FRONT_LOTS - BACK_LOTS;
    building b = {.seed = seed_of(index, 3)};
    double   start;
    share_out(index / LOTS * 3 + (front ? 0 : back ? 1 : 2), position_in, count, &start, &b.width);
    bool first = position_in == 0, last = position_in == count - 1;
    b.depth = front ? 11.5 + 1.2 * chance(&b.seed) : 10.5 + chance(&b.seed);
    b.floors = 3 + (int)(3.4 * chance(&b.seed)) + (front && row == 2 ? 1 : 0);
    b.detail = !front || row > 1 || (row == 1 && lot > 1) ? 0 : row == 0 && lot < 2 ? 2 : 1;
    b.roof = (roof_shape)((int)(5 * chance(&b.seed)));
    double from_middle = front  ? STREET_HALF + 0.35 * chance(&b.seed)
                         : back ? STREET_HALF + BLOCK_DEPTH
                                : STREET_HALF + BLOCK_DEPTH + LANE;
    double near_end = row_start(row) - start, far_end = near_end - b.width;
    if (!front && !back)
        b = tower_of(b, row);
    /* The left side's fronts look to +x; those at the back look the other way, and the right side mirrors the left. */
    bool to_right = (side == 0) != back;
    b.x = (side == 0 ? -1 : 1) * from_middle;
    b.degrees = to_right ? 90 : -90;
    b.z = to_right ? near_end : far_end;
    b.left_free = to_right ? first : last;
    b.right_free = to_right ? last : first;
    if (b.roof == ROOF_TOWER) {
        b.z += to_right ? -2 : 2;
        uint32_t turned = seed_of(index / LOTS, 17); /* a whole row, so that neighbours stay apart */
        b.degrees += row > 0 ? 9 - 18 * chance(&turned) : 0;
    }
    return b;
}

static double wall_height(const building *b)
{
    return ground_floor + (b->floors - 1) * storey;
}

static double gable_rise(const building *b)
{
    return b->width * 0.42;
}

/* --- facades -------------------------------------------------------------------------------------------- */

typedef enum layer { STONEWORK, PANES } layer;

typedef struct opening {
    double left, bottom, right, top;
} opening;

/* An upright pane, with its edge in the wall: two thirds of a box's triangles. */
static void pane(mesh *m, double left, double bottom, double right, double top, double front)
{
    outline o = {0};
    add_point(&o, left, front);
    add_point(&o, right, front);
    add_point(&o, (left + right) / 2, -0.3);
    plan(m, &o, NULL, 0, bottom, top);
}

/* From near by a frame with lintel, sill and glazing bars, farther off a frame and a sill, from afar the pane
 * alone. */
static void window(mesh *m, layer part, const opening *w, int detail)
{
    static const double bar = 0.035, rim = 0.13, fronts[] = {0.05, 0.28, 0.04};
    const opening       outer = {w->left - rim, w->bottom - 0.02, w->right + rim, w->top + rim};
    if (part == PANES) {
        pane(m, w->left, w->bottom, w->right, w->top, fronts[detail]);
        if (detail > 1) { /* bars, a cross */
            double middle = (w->left + w->right) / 2, crossing = w->bottom + 0.64 * (w->top - w->bottom);
            pane(m, middle - bar, w->bottom - 0.03, middle + bar, w->top + 0.03, 0.1);
            pane(m, w->left - 0.03, crossing - bar, w->right + 0.03, crossing + bar, 0.09);
        }
    } else if (detail > 1) {
        outline whole = rectangle(outer.left, outer.bottom, outer.right, outer.top),
                hole = rectangle(w->left, w->bottom, w->right, w->top);
        elevation(m, &whole, &hole, 1, -0.15, 0.22);
        box(m, w->left - 0.22, w->top + 0.11, -0.13, w->right + 0.22, w->top + 0.3, 0.32);
    } else if (detail) {
        pane(m, outer.left, outer.bottom, outer.right, outer.top, 0.22);
    }
    if (part == STONEWORK && detail == 1) {
        outline sill = {0};
        add_point(&sill, 0.36, w->bottom - 0.01);
        add_point(&sill, -0.1, w->bottom - 0.01);
        add_point(&sill, -0.1, w->bottom - 0.3);
        section(m, &sill, w->left - 0.24, w->right + 0.24);
    } else if (part == STONEWORK && detail) {
        box(m, w->left - 0.24, w->bottom - 0.16, -0.14, w->right + 0.24, w->bottom - 0.01, 0.34);
    }
}

/* A door in a stone frame, on a step. */
static void door(mesh *m, layer part, double middle, int detail)
{
    const opening leaf = {middle - 0.6, 0.2, middle + 0.6, 2.75};
    if (part == PANES) {
        pane(m, leaf.left, leaf.bottom, leaf.right, leaf.top, detail ? 0.02 : 0.06);
        return;
    }
    if (!detail)
        return;
    outline outer = rectangle(leaf.left - 0.22, 0.1, leaf.right + 0.22, leaf.top + 0.28),
            hole = rectangle(leaf.left, 0.15, leaf.right, leaf.top);
    elevation(m, &outer, &hole, 1, -0.15, 0.26);
    box(m, leaf.left - 0.4, leaf.top + 0.26, -0.14, leaf.right + 0.4, leaf.top + 0.42, 0.5);
    box(m, leaf.left - 0.3, footing + 0.01, -0.16, leaf.right + 0.3, 0.24, 0.55);
}

/* A balcony's slab and its railing. */
static void balcony(mesh *m, double middle, double floor, double half)
{
    box(m, middle - half, floor - 0.18, -0.1, middle + half, floor - 0.02, 0.85);
    box(m, middle - half, floor + 0.98, 0.74, middle + half, floor + 1.06, 0.82);
    for (int side = -1; side <= 1; side += 2)
        box(m, middle + side * (half - 0.04) - 0.03, floor + 0.97, -0.05, middle + side * (half - 0.04) + 0.03,
            floor + 1.05, 0.76);
    int bars = (int)(2 * half / 0.42);
    for (int i = 0; i <= bars; i++) {
        double x = middle - half + 0.04 + (2 * half - 0.08) * i / bars;
        box(m, x - 0.02, floor - 0.04, 0.76, x + 0.02, floor + 1, 0.8);
    }
}

static int columns_of(double width)
{
    int columns = (int)((width - 0.8) / 2.9);
    return columns < 2 ? 2 : columns;
}

/* What is on a wall of this width, ground floor and all. */
static void facade(mesh *m, layer part, const building *b, double width, bool street)
{
    uint32_t seed = b->seed * 3 + 1;
    int columns = columns_of(width), door_at = (int)(columns * chance(&seed)), balconies = chance(&seed) > 0.55 ? 1 : 0;
    double bay = width / columns, half = fmin(0.62, bay * 0.26), tall = 1.7 + 0.35 * chance(&seed);
    for (int f = 0; f < b->floors; f++)
        for (int c = 0; c < columns; c++) {
            double middle = bay * (c + 0.5), floor = f ? ground_floor + (f - 1) * storey : 0;
            if (f == 0 && street && c == door_at) {
                door(m, part, middle, b->detail);
            } else if (f == 0) {
                double wide = street ? bay * 0.36 : half;
                window(m, part, &(opening){middle - wide, street ? 0.75 : 1.2, middle + wide, 2.95}, b->detail);
            } else {
                double sill = floor + (balconies && street && b->detail > 1 && c % 2 == 1 && f % 2 == 1 ? 0.1 : 0.85);
                window(m, part, &(opening){middle - half, sill, middle + half, floor + 0.85 + tall}, b->detail);
                if (part == STONEWORK && sill < floor + 0.5)
                    balcony(m, middle, floor, half + 0.45);
            }
        }
    if (part == STONEWORK && street) {
        if (b->detail)
            box(m, 0.03, footing + 0.02, -0.12, width - 0.03, 0.62, 0.2);
        box(m, 0.02, ground_floor - 0.5, -0.11, width - 0.02, ground_floor - 0.22, 0.3);
    }
}

/* The front, and the sides that are seen from near by, each turned to where it stands. */
static void all_facades(mesh *m, layer part, const building *b)
{
    facade(m, part, b, b->width, true);
    for (int right = 0; right < 2; right++)
        if (b->z > -3 * (BLOCK_LENGTH + CROSS_STREET) && (right ? b->right_free : b->left_free)) {
            uint32_t kept = m->point_count;
            building side = *b;
            side.detail = b->detail > 1 ? 1 : 0;
            facade(m, part, &side, b->depth, false);
            position(m, kept, right ? 90 : -90, right ? b->width : 0, 0, right ? 0 : -b->depth);
        }
}

/* --- towers --------------------------------------------------------------------------------------------- */

enum { TIERS = 3 };

typedef struct tier {
    double inset, from, to;
} tier;

/* Towers step back twice on their way up. */
static void tiers_of(const building *b, tier out[TIERS])
{
    double   height = wall_height(b);
    uint32_t seed = b->seed * 5 + 3;
    double   first = 0.5 + 0.2 * chance(&seed), second = first + 0.18 + 0.08 * chance(&seed);
    out[0] = (tier){0, footing, ground_floor + storey * floor((height * first - ground_floor) / storey)};
    out[1] = (tier){1.3, out[0].to - 0.5, ground_floor + storey * floor((height * second - ground_floor) / storey)};
    out[2] = (tier){2.9, out[1].to - 0.5, height};
}

static void tower_walls(mesh *m, const building *b)
{
    tier     tiers[TIERS];
    uint32_t seed = b->seed * 7;
    bool     banded = chance(&seed) > 0.45;
    tiers_of(b, tiers);
    for (int t = 0; t < TIERS; t++) {
        double in = tiers[t].inset, from = tiers[t].from, to = tiers[t].to;
        box(m, in, from, -b->depth + in, b->width - in, to, -in);
        box(m, in - 0.5, to - 0.45, -b->depth + in - 0.5, b->width - in + 0.5, to + 0.5, -in + 0.5); /* cornice */
        for (double y = t ? from + 0.5 + storey : ground_floor; banded && y < to - 1;
             y += (b->floors > 11 ? 2 : 1) * storey)
            box(m, in - 0.4, y - 0.42, -b->depth + in - 0.4, b->width - in + 0.4, y + (b->floors > 11 ? 1.2 : 0.42),
                -in + 0.4);
        for (int i = 0; !banded && i <= 3; i++) {
            double x = in + 0.35 + (b->width - 2 * in - 0.7) * i / 3, z = in + 0.35 + (b->depth - 2 * in - 0.7) * i / 3;
            box(m, x - 0.28, from + 0.01, -b->depth + in - 0.38, x + 0.28, to - 0.2, -in + 0.38);
            if (i > 0 && i < 3)
                box(m, in - 0.38, from + 0.02, -z - 0.28, b->width - in + 0.38, to - 0.21, -z + 0.28);
        }
    }
    box(m, b->width * 0.35, tiers[2].to - 0.1, -b->depth * 0.62, b->width * 0.6, tiers[2].to + 3, -b->depth * 0.36);
    TURNED(m, b->width * 0.7, tiers[2].to, -b->depth * 0.5, 12, {0, 0}, {0, 1.1}, {2.4, 1.1}, {3.1, 0});
}

/* --- walls ---------------------------------------------------------------------------------------------- */

static void chimney(mesh *m, double x, double z, double foot, double top, int detail)
{
    box(m, x - 0.55, foot, z - 0.35, x + 0.55, top, z + 0.35);
    if (detail)
        box(m, x - 0.63, top - 0.35, z - 0.43, x + 0.63, top - 0.15, z + 0.43);
    for (int side = -1; side <= 1 && detail; side += 2)
        TURNED(m, x + side * 0.27, top - 0.05, z, 8, {0, 0}, {0, 0.17}, {0.6, 0.13}, {0.6, 0});
}

static void gabled_walls(mesh *m, const building *b)
{
    double  height = wall_height(b), rise = gable_rise(b);
    outline o = {0};
    add_point(&o, 0, footing);
    add_point(&o, b->width, footing);
    add_point(&o, b->width, height);
    add_point(&o, b->width / 2, height + rise);
    add_point(&o, 0, height);
    elevation(m, &o, NULL, 0, -b->depth, 0);
    if (b->roof != ROOF_STEPPED)
        return;
    enum { STEPS = 5 };
    outline g = {0}; /* the gable climbs in steps before the roof */
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < 2 * STEPS; i++) {
            int    step = side ? 2 * STEPS - 1 - i : i;
            double in = 0.02 + (b->width / 2 - 0.75) * (step / 2) / (STEPS - 1),
                   y = height + 0.25 + (rise + 0.55) * ((step + 1) / 2) / STEPS;
            add_point(&g, side ? in : b->width - in, step == 0 ? height - 0.4 : y);
        }
    elevation(m, &g, NULL, 0, -0.45, 0.07);
}

static void plain_walls(mesh *m, const building *b)
{
    double height = wall_height(b);
    box(m, 0, footing, -b->depth, b->width, height + (b->roof == ROOF_FLAT ? 0 : 0.05), 0);
    box(m, 0.01, height - 0.45, -0.2, b->width - 0.01, height - 0.12, 0.5); /* cornice */
    if (b->detail)
        box(m, 0.015, height - 0.62, -0.19, b->width - 0.015, height - 0.43, 0.3);
    if (b->roof == ROOF_FLAT) {
        outline outer = rectangle(0.02, -b->depth + 0.01, b->width - 0.02, 0.02),
                inner = rectangle(0.35, -b->depth + 0.35, b->width - 0.35, -0.35);
        plan(m, &outer, &inner, 1, height - 0.14, height + 0.9);
        box(m, b->width * 0.3, height - 0.1, -b->depth * 0.7, b->width * 0.55, height + 2.3, -b->depth * 0.45);
    }
}

static double ridge_height(const building *b)
{
    double height = wall_height(b);
    return b->roof == ROOF_FLAT      ? height + 0.6
           : b->roof == ROOF_EAVES   ? height + b->depth * 0.36
           : b->roof == ROOF_MANSARD ? height + 3.9
                                     : height + gable_rise(b);
}

void build_walls(mesh *m, int index)
{
    building b = building_of(index);
    uint32_t seed = b.seed * 11;
    if (b.roof == ROOF_TOWER) {
        tower_walls(m, &b);
    } else {
        if (b.roof == ROOF_GABLE || b.roof == ROOF_STEPPED)
            gabled_walls(m, &b);
        else
            plain_walls(m, &b);
        double foot = wall_height(&b) - 0.3, ridge = ridge_height(&b);
        bool   gabled = b.roof == ROOF_GABLE || b.roof == ROOF_STEPPED;
        chimney(m, gabled ? b.width * 0.3 : 0.8, gabled ? -b.depth * 0.35 : -b.depth / 2, foot, ridge + 1.3, b.detail);
        if (chance(&seed) > 0.45)
            chimney(m, gabled ? b.width * 0.7 : b.width - 0.8, -b.depth * 0.62, foot, ridge + 1.1, b.detail);
        all_facades(m, STONEWORK, &b);
    }
    position(m, 0, b.degrees, b.x, 0, b.z);
}

void build_windows(mesh *m, int block)
{
    for (int lot = 0; lot < LOTS; lot++) {
        building b = building_of(block * LOTS + lot);
        uint32_t kept = m->point_count;
        bool     unseen = lot >= FRONT_LOTS && block >= 2 * SIDES; /* backs that are too far off */
        if (b.roof == ROOF_TOWER || unseen)
            continue;
        all_facades(m, PANES, &b);
        position(m, kept, b.degrees, b.x, 0, b.z);
    }
}

/* --- roofs ---------------------------------------------------------------------------------------------- */

static void dormers(mesh *m, const building *b, double sill, double back)
{
    int    columns = columns_of(b->width);
    double bay = b->width / columns;
    for (int c = 0; c < columns; c++) {
        double  middle = bay * (c + 0.5);
        outline o = {0};
        add_point(&o, middle - 0.62, sill);
        add_point(&o, middle + 0.62, sill);
        add_point(&o, middle + 0.62, sill + 1.35);
        add_point(&o, middle, sill + 1.85);
        add_point(&o, middle - 0.62, sill + 1.35);
        elevation(m, &o, NULL, 0, back, -0.3);
        if (b->detail) {
            outline frame = rectangle(middle - 0.46, sill + 0.1, middle + 0.46, sill + 1.3),
                    hole = rectangle(middle - 0.36, sill + 0.2, middle + 0.36, sill + 1.2);
            elevation(m, &frame, &hole, 1, -0.5, -0.24);
        }
    }
}

/* A roof over a section that runs along the street; `points` are {z, y}. */
static void roof_along(mesh *m, const building *b, const double (*points)[2], int count)
{
    outline o = {0};
    for (int i = 0; i < count; i++)
        add_point(&o, points[i][0], points[i][1]);
    section(m, &o, 0.015, b->width - 0.015);
}

static void gable_roof(mesh *m, const building *b)
{
    double  height = wall_height(b), rise = gable_rise(b), slope = rise / (b->width / 2), over = 0.28, thick = 0.24;
    double  front = b->roof == ROOF_STEPPED ? -0.2 : 0.35;
    outline o = {0};
    bool    left = b->left_free, right = b->right_free; /* eaves only where there is no neighbour */
    double  a = left ? over : -0.035, c = right ? over : -0.035;
    add_point(&o, -a, height - a * slope - 0.03);
    add_point(&o, b->width / 2, height + rise - 0.03);
    add_point(&o, b->width + c, height - c * slope - 0.03);
    add_point(&o, b->width + c, height - c * slope + thick);
    add_point(&o, b->width / 2, height + rise + thick);
    add_point(&o, -a, height - a * slope + thick);
    elevation(m, &o, NULL, 0, -b->depth - 0.2, front);
}

void build_roofs(mesh *m, int block)
{
    for (int lot = 0; lot < LOTS; lot++) {
        building b = building_of(block * LOTS + lot);
        uint32_t kept = m->point_count;
        double   h = wall_height(&b), d = b.depth;
        if (b.roof == ROOF_EAVES) {
            roof_along(
                m, &b,
                (const double[][2]){
                    {0.5, h - 0.1}, {0.5, h + 0.08}, {-d / 2, h + d * 0.36}, {-d - 0.4, h + 0.08}, {-d - 0.4, h - 0.1}},
                5);
            if (chance(&b.seed) > 0.35)
                dormers(m, &b, h + 0.7, -3.2);
        } else if (b.roof == ROOF_MANSARD) {
            roof_along(m, &b,
                       (const double[][2]){{0.3, h - 0.1},
                                           {0.3, h + 0.1},
                                           {-0.9, h + 2.7},
                                           {-d / 2, h + 3.9},
                                           {0.9 - d, h + 2.7},
                                           {-d - 0.2, h + 0.1},
                                           {-d - 0.2, h - 0.1}},
                       7);
            dormers(m, &b, h + 0.55, -2.2);
        } else if (b.roof == ROOF_GABLE || b.roof == ROOF_STEPPED) {
            gable_roof(m, &b);
        }
        position(m, kept, b.degrees, b.x, 0, b.z);
    }
}
