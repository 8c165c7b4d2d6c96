/* A model of flat faces and tubes with two sets of texture coordinates: tiled, in metres over metres a tile, and
 * unique, in charts of an atlas. */
#ifndef EXAMPLES_HOUSE_H
#define EXAMPLES_HOUSE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define PI 3.14159265358979323846

enum { CHARTS_MAX = 4096, EDGES_MAX = 24, ATLAS_SIDE = 384 };

/* Parts in the order of the file; house.c has their names and materials. */
enum {
    GROUND,
    PATH,
    STEPS,
    PLINTH,
    WALLS,
    GABLES,
    ROOF,
    RIDGE,
    BEAMS,
    STONES,
    FRAMES,
    SHUTTERS,
    DOOR,
    GLASS_PART,
    IRON_PART,
    CHIMNEY,
    POTS,
    TOWER,
    TOWER_STONES,
    TOWER_ROOF,
    GARDEN_WALL,
    COPING,
    CAPACITY,
    FLOOR,
    JOISTS,
    HEARTH,
    FURNITURE,
    CROCKERY,
    PART_COUNT
};
enum { BRICK, TILES, WOOD, STONE, GRASS, GLASS, PAINT, IRON, MATERIAL_COUNT };

typedef enum direction { RIGHT_DIRECTION, UP_DIRECTION } direction;

typedef struct vertex {
    double at[3], normal[3], metres[2], unique[2]; /* unique: metres in the chart */
    int    chart;
} vertex;

typedef struct part_mesh {
    vertex   *vertices;
    uint32_t *indices;
    uint32_t  vertex_count, index_count, space, index_space;
} part_mesh;

/* A rectangle of the atlas, in metres; where its edges are, for the indication. */
typedef struct chart {
    double width, height, density;
    int    x, y, across, down; /* texels */
    int    edge_count;
    double edges[EDGES_MAX][5]; /* from, to, weight */
} chart;

typedef struct house {
    part_mesh parts[PART_COUNT];
    chart     charts[CHARTS_MAX];
    int       chart_count;
    double    texels_per_metre;
} house;

/* A plane with the frame in which its texture lies: u to the right, v upwards, both of length 1. */
typedef struct face {
    int    part, chart;
    double at[3], u[3], v[3];
    bool   turned; /* the tiled texture, by a quarter */
} face;

_Noreturn void give_up(void);
void           sort_numbers(double *numbers, int count);

int  add_chart(house *h, double width, double height, double density);
void outline_chart(house *h, int index, const double (*points)[2], int count, double weight);
void put_rectangle(house *h, const face *f, double left, double bottom, double right, double top);
void put_polygon(house *h, const face *f, const double (*points)[2], int count);

/* A box of three edges from a corner, right-handed. */
void slanted_box(house *h, int part, const double at[3], const double u[3], const double v[3], const double w[3]);
void box_at(house *h, int part, double left, double bottom, double back, double right, double top, double front);

/* A tube or a cone that stands at a position; its ends are closed. */
void tube(house *h, int part, const double at[3], direction along, double length, double from_radius, double to_radius,
          int segments);

bool house_write(house *h, const char *path, const char *folder);

/* house_paint.c */
extern const double metres_a_tile[MATERIAL_COUNT];
bool                paint_materials(const char *folder);
bool                paint_indication(const house *h, const char *folder);
bool                file_of(const char *folder, const char *name, const char *ending, FILE **out);

#endif
