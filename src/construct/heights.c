/* Fields of heights: each cell is four triangles round its middle, which is as high as its corners are on average. */
#include <math.h>

#include "base/memory.h"
#include "construct/construct_private.h"

typedef struct field {
    const double *heights;
    size_t        columns, rows;
    double        base;
} field;

static void add_points(solid_builder *b, const field *f, double left, double front)
{
    for (size_t y = 0; y < f->rows; y++)
        for (size_t x = 0; x < f->columns; x++)
            builder_point(b, left + (double)x, front + (double)y, f->heights[y * f->columns + x]);
    for (size_t y = 0; y + 1 < f->rows; y++)
        for (size_t x = 0; x + 1 < f->columns; x++) {
            const double *h = &f->heights[y * f->columns + x];
            double        middle = (h[0] + h[1] + h[f->columns] + h[f->columns + 1]) / 4;
            builder_point(b, left + (double)x + 0.5, front + (double)y + 0.5, middle);
        }
    builder_point(b, left + (double)(f->columns - 1) / 2, front + (double)(f->rows - 1) / 2, f->base);
}

static void add_top(solid_builder *b, const field *f)
{
    uint32_t columns = (uint32_t)f->columns, middle = columns * (uint32_t)f->rows;
    for (uint32_t y = 0; y + 1 < f->rows; y++)
        for (uint32_t x = 0; x + 1 < f->columns; x++, middle++) {
            uint32_t at = y * columns + x, corners[4] = {at, at + 1, at + columns + 1, at + columns};
            for (int k = 0; k < 4; k++)
                builder_triangle(b, corners[k], corners[(k + 1) % 4], middle);
        }
}

/* One step along the rim, anticlockwise from above: a wall down to the base, and the base's triangle to its middle. */
static void add_wall(solid_builder *b, const field *f, uint32_t from, uint32_t to, uint32_t middle)
{
    uint32_t      down = (uint32_t)b->point_count;
    const point3 *p = b->failed ? NULL : b->points;
    if (!p)
        return;
    point3 a = p[from], c = p[to];
    builder_point(b, a.x, a.y, f->base);
    builder_point(b, c.x, c.y, f->base);
    builder_quad(b, from, down, down + 1, to);
    builder_triangle(b, down, middle, down + 1);
}

static void add_walls(solid_builder *b, const field *f)
{
    uint32_t columns = (uint32_t)f->columns, rows = (uint32_t)f->rows, middle = (uint32_t)b->point_count - 1;
    for (uint32_t x = 0; x + 1 < columns; x++) {
        add_wall(b, f, x, x + 1, middle);
        add_wall(b, f, (rows - 1) * columns + x + 1, (rows - 1) * columns + x, middle);
    }
    for (uint32_t y = 0; y + 1 < rows; y++) {
        add_wall(b, f, y * columns + columns - 1, (y + 1) * columns + columns - 1, middle);
        add_wall(b, f, (y + 1) * columns, y * columns, middle);
    }
}

lmn_status construct_heights(polyhedron *out, const double *heights, size_t columns, size_t rows, bool centre,
                             lmn_error *error)
{
    *out = (polyhedron){0};
    lmn_status status = check_point_count("surface", (double)columns * (double)rows * 2, error);
    if (status == LMN_OK)
        status = check_numbers("surface", heights, columns * rows, error);
    if (status != LMN_OK || columns < 2 || rows < 2)
        return status;
    field f = {heights, columns, rows, 1};
    /* One below the lowest, but never above 0: as OpenSCAD has it. */
    for (size_t i = 0; i < columns * rows; i++)
        f.base = fmin(f.base, heights[i]);
    f.base -= 1;
    solid_builder b = {0};
    add_points(&b, &f, centre ? -(double)(columns - 1) / 2 : 0, centre ? -(double)(rows - 1) / 2 : 0);
    add_top(&b, &f);
    add_walls(&b, &f);
    return builder_finish(&b, out, error);
}
