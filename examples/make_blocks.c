/* Writes the example model of a town: make_blocks OUT.glb
 *
 * A hundred buildings in blocks along a street that runs to −z towards a church; the near ones have doors, frames and
 * balconies, the far ones are simple. Lengths are metres, +y is up. Every piece is one closed shell (pieces.h). Two
 * cameras: in the street, and a bird's. */
#include "blocks.h"

#include "model.h"
#include "pieces.h"

#include <math.h>
#include <stdlib.h>

static const double far_end = -ROWS * (BLOCK_LENGTH + CROSS_STREET);
static const double pavement_edge = 5.2, slab = 0.14;

/* --- streets -------------------------------------------------------------------------------------------- */

static void build_ground(mesh *m)
{
    box(m, -78, -0.6, far_end - 62, 78, 0, 16);
}

/* Blocks stand on pavements with kerbs. */
static void build_pavements(mesh *m)
{
    for (int block = 0; block < ROWS * SIDES; block++) {
        double near_end = row_start(block / SIDES) + 2.4, away = near_end - BLOCK_LENGTH - 4.8,
               inner = STREET_HALF + BLOCK_DEPTH + 1.6, outer = STREET_HALF + BLOCK_DEPTH + LANE;
        int side = block % SIDES ? 1 : -1;
        box(m, fmin(side * pavement_edge, side * inner), -0.1, away, fmax(side * pavement_edge, side * inner), slab,
            near_end);
        box(m, fmin(side * (outer - 1.6), side * (outer + OUTER_DEPTH)), -0.1, away,
            fmax(side * (outer - 1.6), side * (outer + OUTER_DEPTH)), slab, near_end);
    }
    outline square = circle(0, far_end - 26, 30, 48); /* around the church */
    plan(m, &square, NULL, 0, -0.1, slab);
}

static void build_lamp(mesh *m)
{
    TURNED(m, 0, 0, 0, 8, {0, 0}, {0, 0.16}, {0.5, 0.14}, {0.55, 0.07}, {3.9, 0.05}, {3.95, 0.12}, {4.05, 0.13},
           {4.55, 0.21}, {4.6, 0.26}, {4.85, 0.05}, {4.95, 0});
}

/* --- trees ---------------------------------------------------------------------------------------------- */

static void crowned(mesh *m, double height, double radius, int lumps, uint32_t seed)
{
    const double foot[3] = {0, 0, 0}, fork[3] = {0.05, height * 0.5, 0.04};
    bar(m, foot, fork, 0.2, 0.13, 6);
    foliage(m, (const double[3]){0, height * 0.72, 0}, radius * 0.72, height * 0.25, seed);
    for (int k = 0; k < lumps; k++) {
        double angle = 2 * PI * (k / 3.0 + chance(&seed) * 0.15), away = radius * (0.4 + 0.12 * chance(&seed));
        foliage(m, (const double[3]){away * cos(angle), height * (0.48 + 0.09 * chance(&seed)), away * sin(angle)},
                radius * 0.66, height * 0.2, seed);
    }
}

static void build_tree(mesh *m, int number)
{
    static const double sizes[3][2] = {{6.4, 2.0}, {7.4, 2.3}, {6.0, 2.6}};
    crowned(m, sizes[number][0], sizes[number][1], number < 2 ? 3 : 1, (uint32_t)(17 + number * 31));
}

/* --- church --------------------------------------------------------------------------------------------- */

static const double tower_half = 4.2, tower_height = 34, spire_top = 62, church_axis = 1.5;

static void build_church(mesh *m)
{
    const double front = far_end - 14, y = 0.05;
    outline      gable = {0};
    box(m, church_axis - tower_half, y, front - 2 * tower_half, church_axis + tower_half, tower_height, front);
    static const double courses[3] = {11, 22, 33.4};
    for (int k = 0; k < 3; k++)
        box(m, church_axis - tower_half - 0.3, courses[k] - 0.3, front - 2 * tower_half - 0.3,
            church_axis + tower_half + 0.3, courses[k] + 0.3, front + 0.3);
    for (int corner = 0; corner < 4; corner++) { /* buttresses, and pinnacles over them */
        double x = church_axis + (corner % 2 ? 1 : -1) * tower_half, z = front - (corner / 2 ? 2 * tower_half : 0);
        box(m, x - 0.7, 0.06, z - 0.7, x + 0.7, 27, z + 0.7);
        box(m, x - 0.5, 26.9, z - 0.5, x + 0.5, 31, z + 0.5);
        box(m, x - 0.45, 33, z - 0.45, x + 0.45, 36.5, z + 0.45);
        LATHE(m, (&(frame){{x, 36.4, z}, UP}), 4, NULL, NULL, {0, 0}, {0, 0.75}, {3.4, 0});
    }
    add_point(&gable, church_axis - 9, y);
    add_point(&gable, church_axis + 9, y);
    add_point(&gable, church_axis + 9, 12);
    add_point(&gable, church_axis, 21);
    add_point(&gable, church_axis - 9, 12);
    elevation(m, &gable, NULL, 0, front - 40, front - 2 * tower_half + 1.5);
    for (int i = 0; i < 10; i++) {
        double z = front - 2 * tower_half - 2.5 - 6.5 * (i / 2), side = i % 2 ? 1 : -1;
        box(m, church_axis + side * 9.6 - 0.8, 0.07, z - 0.5, church_axis + side * 9.6 + 0.8, 10, z + 0.5);
    }
}

static void build_church_openings(mesh *m)
{
    const double front = far_end - 14;
    outline      portal = round_headed(church_axis, 0.2, 4.2, 1.7, 14),
            frame_of_it = round_headed_frame(church_axis, 0.2, 4.2, 1.72, 0.6, 14);
    elevation(m, &portal, NULL, 0, front - 0.5, front + 0.35);
    elevation(m, &frame_of_it, NULL, 0, front - 0.4, front + 0.7);
    for (int level = 0; level < 2; level++)
        for (int k = -1; k <= 1; k += 2) {
            double  x = church_axis + k * (level ? 1.5 : 0);
            outline o = round_headed(x, level ? 24.5 : 13.5, level ? 29 : 18.6, level ? 0.95 : 1.3, 12);
            if (level || k > 0)
                elevation(m, &o, NULL, 0, front - 0.5, front + 0.4);
        }
}

static void build_church_roofs(mesh *m)
{
    const double front = far_end - 14, middle = front - tower_half;
    LATHE(m, (&(frame){{church_axis, 0, middle}, UP}), 8, NULL, NULL, {tower_height - 0.2, 0},
          {tower_height - 0.2, tower_half + 0.1}, {tower_height + 0.3, tower_half + 0.1},
          {tower_height + 4, tower_half - 1.2}, {spire_top, 0.12}, {spire_top + 0.2, 0});
    TURNED(m, church_axis, spire_top - 0.2, middle, 12, {0, 0}, {0.1, 0.25}, {0.45, 0.42}, {0.8, 0.25}, {0.9, 0});
    box(m, church_axis - 0.07, spire_top + 0.5, middle - 0.07, church_axis + 0.07, spire_top + 3.2, middle + 0.07);
    box(m, church_axis - 0.7, spire_top + 2.2, middle - 0.06, church_axis + 0.7, spire_top + 2.4, middle + 0.06);
    outline      o = {0};
    const double over = 0.6, low = 12 - over, thick = 0.35;
    add_point(&o, church_axis - 9 - over, low - 0.05);
    add_point(&o, church_axis, 21 - 0.05);
    add_point(&o, church_axis + 9 + over, low - 0.05);
    add_point(&o, church_axis + 9 + over, low + thick);
    add_point(&o, church_axis, 21 + thick);
    add_point(&o, church_axis - 9 - over, low + thick);
    elevation(m, &o, NULL, 0, front - 40.4, front - 2 * tower_half + 1.9);
}

/* --- assembly ------------------------------------------------------------------------------------------- */

enum { PLASTER, OCHRE, GREY, ROSE, WHITE, WALLS, TILE = WALLS, GLASS, STONE, ASPHALT, LEAVES, IRON, SLATE, MATERIALS };

/* Light, as paper is: drawings take their tone from it. */
static const model_material materials[MATERIALS] = {
    [PLASTER] = {"Plaster", {0.860, 0.810, 0.710}},    [OCHRE] = {"Ochre render", {0.820, 0.700, 0.500}},
    [GREY] = {"Grey render", {0.720, 0.720, 0.700}},   [ROSE] = {"Brick", {0.740, 0.540, 0.460}},
    [WHITE] = {"White render", {0.900, 0.890, 0.860}}, [TILE] = {"Tiles", {0.600, 0.320, 0.230}},
    [GLASS] = {"Glass", {0.260, 0.300, 0.330}},        [STONE] = {"Paving", {0.760, 0.740, 0.700}},
    [ASPHALT] = {"Asphalt", {0.640, 0.640, 0.640}},    [LEAVES] = {"Leaves", {0.420, 0.540, 0.300}},
    [IRON] = {"Iron", {0.200, 0.200, 0.210}},          [SLATE] = {"Slate", {0.440, 0.470, 0.500}},
};

enum { HOUSES, ROOFS, WINDOWS, STREETS, TREES, CHURCH, GROUPS };

static const model_group groups[GROUPS] = {
    [HOUSES] = {"buildings", {0}, 0}, [ROOFS] = {"roofs", {0}, 0}, [WINDOWS] = {"windows", {0}, 0},
    [STREETS] = {"streets", {0}, 0},  [TREES] = {"trees", {0}, 0}, [CHURCH] = {"church", {0}, 0},
};

static const model_camera cameras[] = {
    {"street", {-2.4, 1.75, 11.5}, {0.9, 19, -90}, 50},
    {"bird", {84, 82, 74}, {-4, 4, -92}, 40},
};

enum { PARTS_MAX = 256, NAME_SIZE = 24 };

typedef struct assembly {
    int        count;
    model_part parts[PARTS_MAX];
    char       names[PARTS_MAX][NAME_SIZE];
} assembly;

static model_part *add(assembly *a, const char *name, int number, int group, int material)
{
    char *own = a->names[a->count];
    snprintf(own, NAME_SIZE, number ? "%s %d" : "%s", name, number);
    a->parts[a->count] = (model_part){.name = own, .group = group, .material = material};
    return &a->parts[a->count++];
}

static void add_many(assembly *a, const char *name, int index, int group, int material, void (*build)(mesh *, int))
{
    model_part *p = add(a, name, index + 1, group, material);
    p->build_one = build;
    p->number = index;
}

/* Trees and lamps stand in turn along both kerbs, and trees around the church. */
static void list_trees(assembly *a)
{
    int trees = 0, lamps = 0;
    for (int i = 0; i < 46; i++) {
        double z = -5 - 12.0 * (i / 2), along = fmod(-z, BLOCK_LENGTH + CROSS_STREET);
        bool   square = i >= 40, lamp = i / 2 % 2 == 0;
        if (!square && (along > BLOCK_LENGTH - 1 || z < far_end + 6))
            continue;
        model_part *p =
            lamp && !square ? add(a, "lamp", ++lamps, STREETS, IRON) : add(a, "tree", ++trees, TREES, LEAVES);
        if (lamp && !square) {
            p->build = build_lamp;
        } else {
            p->build_one = build_tree;
            p->number = z < -66 ? 2 : trees % 2;
        }
        p->at[0] = square ? (i % 2 ? 17 : -15) : (i % 2 ? 1 : -1) * (pavement_edge + 0.75);
        p->at[1] = slab - 0.03;
        p->at[2] = square ? far_end - 8 - 9 * (i / 2 - 20) : z;
    }
}

static void list_parts(assembly *a)
{
    for (int i = 0; i < BUILDINGS; i++) {
        building b = building_of(i);
        int      paint = (int)(b.seed >> 9) % WALLS;
        add_many(a, b.roof == ROOF_TOWER ? "tower" : "house", i, HOUSES, paint, build_walls);
    }
    for (int block = 0; block < ROWS * SIDES; block++) {
        add_many(a, "roofs", block, ROOFS, TILE, build_roofs);
        add_many(a, "windows", block, WINDOWS, GLASS, build_windows);
    }
    add(a, "ground", 0, STREETS, ASPHALT)->build = build_ground;
    add(a, "pavements", 0, STREETS, STONE)->build = build_pavements;
    list_trees(a);
    add(a, "church", 0, CHURCH, STONE)->build = build_church;
    add(a, "church openings", 0, CHURCH, GLASS)->build = build_church_openings;
    add(a, "church roofs", 0, CHURCH, SLATE)->build = build_church_roofs;
}

int main(int count, char **arguments)
{
    if (count != 2)
        return EXIT_FAILURE;
    static assembly a;
    list_parts(&a);
    const model town = {"make_blocks", "Town",  1,       materials, MATERIALS, groups,
                        GROUPS,        a.parts, a.count, NULL,      cameras,   COUNT(cameras)};
    return model_write(&town, arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
}
