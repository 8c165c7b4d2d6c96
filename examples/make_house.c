/* Writes the example model of a brick house: make_house OUT.glb FOLDER
 *
 * It shows what halftone screens are for (Freudenberg 2003, figures 5.12 and 6.17 to 6.21). FOLDER, which is named as
 * it stands beside OUT.glb, gets a picture for each material and beside it the strokes that stand for it, and the
 * indication map. Texture coordinates are metres over metres a tile; the second set is unique. Metres, +y is up. */
#include "house.h"

#include <math.h>
#include <stdlib.h>

static const double half_x = 3.2, half_z = 2.4, eaves = 4.4, ridge = 7.1, plinth = 0.45;
static const double tower_x = -3.2, tower_z = 2.4, tower_r = 1.45, tower_top = 6.1;

/* --- walls with windows --------------------------------------------------------------------------------- */

typedef struct hole {
    double left, bottom, right, top;
    bool   shutters, door;
} hole;

/* Where a wall lies: from `at`, looking at it from outside, to the right along (x, z). */
typedef struct site {
    double at[3], right[2];
} site;

static void out_of(const site *s, double u, double v, double out, double to[3])
{
    to[0] = s->at[0] + u * s->right[0] - out * s->right[1];
    to[1] = s->at[1] + v;
    to[2] = s->at[2] + u * s->right[1] + out * s->right[0];
}

/* A box on a wall, between two distances out of it. */
static void on_wall(house *h, int part, const site *s, double left, double bottom, double right, double top,
                    double from, double to)
{
    double at[3], u[3], v[3] = {0, top - bottom, 0}, w[3];
    out_of(s, left, bottom, from, at);
    u[0] = (right - left) * s->right[0], u[1] = 0, u[2] = (right - left) * s->right[1];
    w[0] = -(to - from) * s->right[1], w[1] = 0, w[2] = (to - from) * s->right[0];
    slanted_box(h, part, at, u, v, w);
}

static void window_of(house *h, const site *s, const hole *o)
{
    double l = o->left, r = o->right, b = o->bottom, t = o->top, m = (l + r) / 2, bar = 0.07;
    on_wall(h, GLASS_PART, s, l, b, r, t, -0.2, -0.14);
    on_wall(h, FRAMES, s, l, b, l + bar, t, -0.24, -0.07);
    on_wall(h, FRAMES, s, r - bar, b, r, t, -0.24, -0.07);
    on_wall(h, FRAMES, s, l + bar, b, r - bar, b + bar, -0.24, -0.08);
    on_wall(h, FRAMES, s, l + bar, t - bar, r - bar, t, -0.24, -0.08);
    on_wall(h, FRAMES, s, m - 0.03, b + bar, m + 0.03, t - bar, -0.23, -0.09);
    for (int k = 1; k < 3; k++)
        on_wall(h, FRAMES, s, l + bar, b + (t - b) * k / 3 - 0.02, r - bar, b + (t - b) * k / 3 + 0.02, -0.23, -0.1);
    on_wall(h, STONES, s, l - 0.14, b - 0.13, r + 0.14, b, -0.12, 0.1);
    on_wall(h, STONES, s, l - 0.16, t, r + 0.16, t + 0.24, -0.12, 0.05);
    for (int side = 0; side < 2 && o->shutters; side++) {
        double from = side ? r + 0.03 : l - 0.03 - (r - l) / 2;
        on_wall(h, SHUTTERS, s, from, b, from + (r - l) / 2, t, 0.02, 0.08);
    }
}

static void door_of(house *h, const site *s, const hole *o)
{
    double l = o->left, r = o->right, b = o->bottom, t = o->top;
    on_wall(h, DOOR, s, l, b, r, t - 0.5, -0.22, -0.13);
    on_wall(h, GLASS_PART, s, l, t - 0.42, r, t, -0.22, -0.16);
    on_wall(h, FRAMES, s, l, t - 0.5, r, t - 0.41, -0.2, -0.06);
    on_wall(h, STONES, s, l - 0.2, b, l, t, -0.14, 0.07);
    on_wall(h, STONES, s, r, b, r + 0.2, t, -0.14, 0.07);
    on_wall(h, STONES, s, l - 0.28, t, r + 0.28, t + 0.28, -0.14, 0.1);
    on_wall(h, IRON_PART, s, r - 0.2, b + 0.95, r - 0.14, b + 1.12, -0.13, -0.08);
}

/* A flat wall with holes. */
static void panel(house *h, int part, const site *s, double width, double height, const hole *holes, int count)
{
    enum { CUTS = 16 };
    double cuts[2][CUTS] = {{0, width}, {0, height}};
    int    n[2] = {2, 2};
    face   f = {.part = part};
    out_of(s, 0, 0, 0, f.at);
    f.u[0] = s->right[0], f.u[2] = s->right[1], f.v[1] = 1;
    f.chart = add_chart(h, width, height, part == WALLS ? 1 : 0.6);
    outline_chart(h, f.chart, (const double[][2]){{0, 0}, {width, 0}, {width, height}, {0, height}}, 4, 1);
    for (int i = 0; i < count; i++) {
        const hole *o = &holes[i];
        cuts[0][n[0]++] = o->left, cuts[0][n[0]++] = o->right, cuts[1][n[1]++] = o->bottom, cuts[1][n[1]++] = o->top;
        outline_chart(
            h, f.chart,
            (const double[][2]){{o->left, o->bottom}, {o->right, o->bottom}, {o->right, o->top}, {o->left, o->top}}, 4,
            0.55);
    }
    sort_numbers(cuts[0], n[0]);
    sort_numbers(cuts[1], n[1]);
    for (int i = 0; i + 1 < n[0]; i++)
        for (int k = 0; k + 1 < n[1]; k++) {
            double x = (cuts[0][i] + cuts[0][i + 1]) / 2, y = (cuts[1][k] + cuts[1][k + 1]) / 2;
            bool   open = cuts[0][i + 1] - cuts[0][i] < 1e-6 || cuts[1][k + 1] - cuts[1][k] < 1e-6;
            for (int j = 0; j < count; j++)
                open |= x > holes[j].left && x < holes[j].right && y > holes[j].bottom && y < holes[j].top;
            if (!open)
                put_rectangle(h, &f, cuts[0][i], cuts[1][k], cuts[0][i + 1], cuts[1][k + 1]);
        }
}

static const double thick = 0.26, capacity_floor = 0.47, capacity_top = 3.2;

/* The room's side of a wall; the upper windows are above its ceiling. */
static void inner_wall(house *h, const site *s, double width, const hole *holes, int count)
{
    hole mirrored[8];
    int  kept = 0;
    site inside = {.right = {-s->right[0], -s->right[1]}};
    out_of(s, width - thick, capacity_floor, -thick, inside.at);
    for (int i = 0; i < count; i++)
        if (holes[i].top < capacity_top)
            mirrored[kept++] = (hole){width - holes[i].right - thick,
                                      holes[i].bottom - capacity_floor + 1e-3,
                                      width - holes[i].left - thick,
                                      holes[i].top - capacity_floor,
                                      false,
                                      false};
    panel(h, CAPACITY, &inside, width - 2 * thick, capacity_top - capacity_floor, mirrored, kept);
}

static void wall(house *h, const site *s, double width, double height, const hole *holes, int count)
{
    panel(h, WALLS, s, width, height, holes, count);
    inner_wall(h, s, width, holes, count);
    for (int i = 0; i < count; i++) {
        const hole *o = &holes[i];
        if (o->door)
            door_of(h, s, o);
        else
            window_of(h, s, o);
        on_wall(h, WALLS, s, o->left - 0.03, o->bottom, o->left, o->top, -0.25, -0.001);
        on_wall(h, WALLS, s, o->right, o->bottom, o->right + 0.03, o->top, -0.25, -0.001);
    }
}

static void build_walls(house *h)
{
    static const hole front[] = {
        {1.95, 1.15, 2.9, 2.7, false, false}, {3.55, 0.45, 4.6, 3.0, false, true},
        {5.15, 1.15, 6.0, 2.7, false, false}, {2.05, 3.35, 2.8, 4.1, false, false},
        {5.2, 3.35, 5.95, 4.1, false, false},
    };
    static const hole side[] = {{0.8, 1.15, 1.7, 2.6, true, false}, {3.1, 1.15, 4.0, 2.6, true, false}};
    const site        sites[4] = {{{-half_x, 0, half_z}, {1, 0}},
                                  {{half_x, 0, half_z}, {0, -1}},
                                  {{half_x, 0, -half_z}, {-1, 0}},
                                  {{-half_x, 0, -half_z}, {0, 1}}};
    wall(h, &sites[0], 2 * half_x, eaves, front, 5);
    wall(h, &sites[1], 2 * half_z, eaves, side, 2);
    wall(h, &sites[2], 2 * half_x, eaves, front, 1);
    wall(h, &sites[3], 2 * half_z, eaves, side, 1);
    /* The plinth stands before the walls, the door's way is free. */
    on_wall(h, PLINTH, &sites[0], 0, 0, 3.3, plinth, -0.1, 0.07);
    on_wall(h, PLINTH, &sites[0], 4.85, 0, 2 * half_x + 0.07, plinth, -0.1, 0.07);
    on_wall(h, PLINTH, &sites[1], 0, 0, 2 * half_z, plinth, -0.1, 0.07);
    on_wall(h, PLINTH, &sites[2], -0.07, 0, 2 * half_x, plinth, -0.1, 0.07);
    on_wall(h, PLINTH, &sites[3], 0, 0, 2 * half_z, plinth, -0.1, 0.07);
}

/* --- gables and roof ------------------------------------------------------------------------------------ */

static void build_gables(house *h)
{
    const double rise = ridge - eaves, points[3][2] = {{-0.1, 0}, {2 * half_z + 0.1, 0}, {half_z, rise}};
    for (int side = 0; side < 2; side++) {
        double turn = side ? -1 : 1;
        site   s = {{turn * half_x, eaves, turn * half_z}, {0, -turn}};
        face   f = {.part = GABLES};
        out_of(&s, 0, 0, 0.06, f.at);
        f.u[2] = -turn, f.v[1] = 1;
        f.chart = add_chart(h, 2 * half_z, rise, 1);
        outline_chart(h, f.chart, points, 3, 1);
        put_polygon(h, &f, points, 3);
        on_wall(h, BEAMS, &s, -0.15, -0.12, 2 * half_z + 0.15, 0.12, -0.1, 0.13);
        /* A hatch to the loft. */
        on_wall(h, FRAMES, &s, half_z - 0.36, 0.62, half_z + 0.36, 1.5, 0.05, 0.1);
        on_wall(h, GLASS_PART, &s, half_z - 0.28, 0.7, half_z + 0.28, 1.42, 0.06, 0.115);
        on_wall(h, FRAMES, &s, half_z - 0.025, 0.7, half_z + 0.025, 1.42, 0.07, 0.13);
    }
}

static void build_roof(house *h)
{
    const double over = 0.45, rise = ridge - eaves, slope = sqrt(rise * rise + half_z * half_z),
                 length = slope * (1 + 0.42 / half_z);
    const double c = half_z / slope, s = rise / slope, long_x = 2 * (half_x + over), thick = 0.16;
    for (int side = 0; side < 2; side++) {
        double turn = side ? -1 : 1;
        double at[3] = {-turn * (half_x + over), ridge - length * s + 0.06, turn * length * c};
        double u[3] = {turn * long_x, 0, 0}, v[3] = {0, length * s, -turn * length * c},
               w[3] = {0, thick * c, turn * thick * s};
        slanted_box(h, ROOF, at, u, v, w);
        /* Barge boards under the verge. */
        for (int end = -1; end <= 1; end += 2) {
            double from[3] = {end * (half_x + over - 0.06) - 0.04, at[1] - 0.2, turn * length * c};
            double across[3] = {0.08, 0, 0}, up[3] = {0, length * s, -turn * length * c},
                   out[3] = {0, 0.2 * c + 0.02, turn * 0.2 * s};
            if (turn < 0) {
                across[0] = -0.08;
                from[0] += 0.08;
            }
            slanted_box(h, BEAMS, from, across, up, out);
        }
        double gutter[3] = {-half_x - over, at[1] - 0.02, turn * (length * c + 0.02) - 0.06};
        box_at(h, BEAMS, gutter[0], gutter[1], gutter[2], half_x + over, gutter[1] + 0.12, gutter[2] + 0.12);
    }
    tube(h, RIDGE, (const double[3]){-half_x - over - 0.02, ridge + 0.15, 0}, RIGHT_DIRECTION, long_x + 0.04, 0.14,
         0.14, 10);
}

/* --- tower, chimney, steps, garden ---------------------------------------------------------------------- */

static void build_tower(house *h)
{
    const double at[3] = {tower_x, 0, tower_z};
    tube(h, TOWER, at, UP_DIRECTION, tower_top, tower_r, tower_r, 40);
    tube(h, TOWER_STONES, at, UP_DIRECTION, plinth + 0.1, tower_r + 0.09, tower_r + 0.09, 40);
    for (int k = 0; k < 2; k++)
        tube(h, TOWER_STONES, (const double[3]){tower_x, k ? 5.75 : 3.25, tower_z}, UP_DIRECTION, k ? 0.34 : 0.16,
             tower_r + 0.08, tower_r + (k ? 0.24 : 0.08), 40);
    tube(h, TOWER_ROOF, (const double[3]){tower_x, tower_top, tower_z}, UP_DIRECTION, 3.5, tower_r + 0.4, 0.04, 40);
    tube(h, IRON_PART, (const double[3]){tower_x, tower_top + 3.35, tower_z}, UP_DIRECTION, 0.8, 0.045, 0.02, 8);
    box_at(h, IRON_PART, tower_x, tower_top + 3.9, tower_z - 0.01, tower_x + 0.5, tower_top + 4.1, tower_z + 0.01);
    static const double windows[][2] = {{-20, 1.5}, {38, 3.9}, {-62, 3.9}, {-20, 3.9}};
    for (int k = 0; k < 4; k++) {
        double angle = windows[k][0] * PI / 180, x = sin(angle), z = cos(angle), bottom = windows[k][1];
        site   s = {{tower_x + (tower_r - 0.06) * x, bottom, tower_z + (tower_r - 0.06) * z}, {z, -x}};
        on_wall(h, STONES, &s, -0.3, -0.12, 0.3, 0, -0.1, 0.16);
        on_wall(h, STONES, &s, -0.32, 1.1, 0.32, 1.3, -0.1, 0.13);
        on_wall(h, STONES, &s, -0.3, 0, -0.2, 1.1, -0.1, 0.1);
        on_wall(h, STONES, &s, 0.2, 0, 0.3, 1.1, -0.1, 0.1);
        on_wall(h, GLASS_PART, &s, -0.2, 0, 0.2, 1.1, -0.1, 0.07);
        on_wall(h, FRAMES, &s, -0.02, 0, 0.02, 1.1, 0.05, 0.09);
        on_wall(h, FRAMES, &s, -0.2, 0.53, 0.2, 0.57, 0.05, 0.09);
    }
}

static void build_chimney(house *h)
{
    box_at(h, CHIMNEY, 1.35, 5.6, -0.55, 2.15, 8.1, 0.25);
    box_at(h, STONES, 1.25, 8.05, -0.65, 2.25, 8.2, 0.35);
    box_at(h, CHIMNEY, 1.3, 7.75, -0.6, 2.2, 7.87, 0.3);
    for (int k = 0; k < 2; k++)
        tube(h, POTS, (const double[3]){1.57 + 0.36 * k, 8.18, -0.15}, UP_DIRECTION, 0.5, 0.14, 0.11, 14);
}

static void pier(house *h, double x, double z)
{
    box_at(h, GARDEN_WALL, x - 0.28, 0, z - 0.28, x + 0.28, 1.35, z + 0.28);
    box_at(h, COPING, x - 0.35, 1.33, z - 0.35, x + 0.35, 1.47, z + 0.35);
    tube(h, COPING, (const double[3]){x, 1.46, z}, UP_DIRECTION, 0.16, 0.16, 0.22, 14);
    tube(h, COPING, (const double[3]){x, 1.62, z}, UP_DIRECTION, 0.2, 0.22, 0.02, 14);
}

static void build_garden(house *h)
{
    const double door_x = -half_x + 4.075, gate = 1.05, wall_z = 5.8, east = 6.1;
    for (int k = 0; k < 3; k++)
        box_at(h, STEPS, door_x - 0.8 - 0.12 * k, 0, half_z + 0.01, door_x + 0.8 + 0.12 * k, 0.45 - 0.15 * k,
               half_z + 0.5 + 0.34 * k);
    box_at(h, PATH, door_x - 0.75, 0, half_z + 1.1, door_x + 0.75, 0.03, 7.2);
    box_at(h, GARDEN_WALL, door_x + gate, 0, wall_z - 0.17, east, 1, wall_z + 0.17);
    box_at(h, COPING, door_x + gate, 0.98, wall_z - 0.23, east, 1.1, wall_z + 0.23);
    box_at(h, GARDEN_WALL, east - 0.17, 0, -3.4, east + 0.17, 1, wall_z);
    box_at(h, COPING, east - 0.23, 0.98, -3.4, east + 0.23, 1.1, wall_z);
    box_at(h, GARDEN_WALL, -5.6, 0, wall_z - 0.17, door_x - gate, 1, wall_z + 0.17);
    box_at(h, COPING, -5.6, 0.98, wall_z - 0.23, door_x - gate, 1.1, wall_z + 0.23);
    pier(h, door_x - gate, wall_z);
    pier(h, door_x + gate, wall_z);
    pier(h, east, wall_z);
    pier(h, -5.6, wall_z);
    pier(h, east, -3.4);
    box_at(h, GROUND, -7, -0.25, -4.4, 7.4, 0, 7.2);
}

/* --- what is inside ------------------------------------------------------------------------------------- */

static void stool(house *h, double x, double z)
{
    box_at(h, FURNITURE, x - 0.2, capacity_floor + 0.42, z - 0.2, x + 0.2, capacity_floor + 0.47, z + 0.2);
    for (int k = 0; k < 4; k++) {
        double u = x + (k & 1 ? 0.14 : -0.14), v = z + (k & 2 ? 0.14 : -0.14);
        box_at(h, FURNITURE, u - 0.03, capacity_floor, v - 0.03, u + 0.03, capacity_floor + 0.43, v + 0.03);
    }
}

static void build_capacity(house *h)
{
    const double x = half_x - thick, z = half_z - thick, y = capacity_floor;
    box_at(h, FLOOR, -x, y - 0.2, -z, x, y, z);
    box_at(h, CAPACITY, -x, capacity_top, -z, x, capacity_top + 0.1, z);
    for (int k = -2; k <= 2; k++)
        box_at(h, JOISTS, 1.15 * k - 0.1, capacity_top - 0.22, -z, 1.15 * k + 0.1, capacity_top + 0.01, z);
    /* The hearth: two cheeks, a beam over them, the breast up to the ceiling. */
    for (int side = -1; side <= 1; side += 2)
        box_at(h, HEARTH, -1 + side * 0.62 - 0.18, y, -z, -1 + side * 0.62 + 0.18, y + 1.15, -z + 0.55);
    box_at(h, JOISTS, -1.95, y + 1.15, -z, -0.05, y + 1.35, -z + 0.68);
    box_at(h, HEARTH, -1.7, y + 1.35, -z, -0.3, capacity_top, -z + 0.45);
    box_at(h, HEARTH, -1.5, y, -z, -0.5, y + 1.15, -z + 0.06);
    box_at(h, STONES, -2, y, -z, 0, y + 0.06, -z + 0.95);
    tube(h, IRON_PART, (const double[3]){-1, y + 0.35, -z + 0.3}, UP_DIRECTION, 0.25, 0.15, 0.2, 16);
    tube(h, BEAMS, (const double[3]){-1.3, y + 0.12, -z + 0.22}, RIGHT_DIRECTION, 0.6, 0.07, 0.06, 9);
    tube(h, BEAMS, (const double[3]){-1.35, y + 0.13, -z + 0.4}, RIGHT_DIRECTION, 0.7, 0.06, 0.07, 9);
    /* A table and what stands on it. */
    box_at(h, FURNITURE, -0.4, y + 0.74, -0.65, 1.3, y + 0.8, 0.25);
    box_at(h, FURNITURE, -0.3, y + 0.62, -0.55, 1.2, y + 0.74, -0.5);
    box_at(h, FURNITURE, -0.3, y + 0.62, 0.1, 1.2, y + 0.74, 0.15);
    for (int k = 0; k < 4; k++) {
        double u = k & 1 ? 1.15 : -0.25, v = k & 2 ? 0.1 : -0.5;
        box_at(h, FURNITURE, u - 0.05, y, v - 0.05, u + 0.05, y + 0.75, v + 0.05);
    }
    stool(h, 0.1, 0.65);
    stool(h, -0.85, -0.15);
    tube(h, CROCKERY, (const double[3]){0.2, y + 0.8, -0.25}, UP_DIRECTION, 0.16, 0.07, 0.11, 16);
    tube(h, CROCKERY, (const double[3]){0.2, y + 0.96, -0.25}, UP_DIRECTION, 0.12, 0.11, 0.06, 16);
    tube(h, CROCKERY, (const double[3]){0.75, y + 0.8, -0.1}, UP_DIRECTION, 0.05, 0.08, 0.17, 20);
    /* A shelf and a chest. */
    box_at(h, FURNITURE, -x, y + 1.5, 0, -x + 0.28, y + 1.55, 0.8);
    for (int k = 0; k < 3; k++)
        tube(h, CROCKERY, (const double[3]){-x + 0.14, y + 1.55, 0.15 + 0.25 * k}, UP_DIRECTION, 0.16 + 0.03 * (k & 1),
             0.07, 0.09, 14);
    box_at(h, FURNITURE, 1.7, y, -z + 0.02, 2.7, y + 0.5, -z + 0.55);
    box_at(h, FURNITURE, 1.67, y + 0.48, -z + 0.01, 2.73, y + 0.56, -z + 0.58);
}

int main(int count, char **arguments)
{
    static house h;
    if (count != 3)
        return EXIT_FAILURE;
    build_walls(&h);
    build_gables(&h);
    build_roof(&h);
    build_tower(&h);
    build_chimney(&h);
    build_garden(&h);
    build_capacity(&h);
    return house_write(&h, arguments[1], arguments[2]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
