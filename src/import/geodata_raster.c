/* In the child: heights of a raster where they are asked for, in whatever system. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/geodata.h"
#include "import/geodata_library.h"

enum { READ = 0, FLOAT32 = 6, POSTS_MAX = 4000000, CELLS_MAX = 64000000 };

typedef struct raster {
    gdal_handle band;
    int         width, height;
    double      to_cell[6]; /* from its system to columns and rows */
    /* What is read of it: columns from left, rows from top. */
    int    left, top, columns, rows;
    float *cells;
    float  none;
    bool   has_none;
    double scale, offset, metres;
} raster;

static bool open_raster(const geodata_child *c, raster *r)
{
    const geodata_library *g = c->library;
    double                 place[6];
    int                    known = 0;
    memset(r, 0, sizeof *r);
    r->width = g->GDALGetRasterXSize(c->data);
    r->height = g->GDALGetRasterYSize(c->data);
    r->band = g->GDALGetRasterBand(c->data, 1);
    if (!r->band || r->width < 2 || r->height < 2 || g->GDALGetGeoTransform(c->data, place) != 0 ||
        !g->GDALInvGeoTransform(place, r->to_cell))
        return false;
    r->none = (float)g->GDALGetRasterNoDataValue(r->band, &known);
    r->has_none = known != 0;
    r->scale = g->GDALGetRasterScale(r->band, &known);
    r->scale = known && isfinite(r->scale) && fabs(r->scale) > 0 ? r->scale : 1;
    r->offset = g->GDALGetRasterOffset(r->band, &known);
    r->offset = known && isfinite(r->offset) ? r->offset : 0;
    const char *unit = g->GDALGetRasterUnitType(r->band);
    r->metres = unit && (strcmp(unit, "ft") == 0 || strcmp(unit, "foot") == 0 || strcmp(unit, "feet") == 0) ? 0.3048
                : unit && strncmp(unit, "US survey", 9) == 0 ? 1200.0 / 3937
                                                             : 1;
    return true;
}

lmn_status geodata_extent_of(const geodata_child *c)
{
    const geodata_library *g = c->library;
    double                 place[6];
    char                   name[256];
    raster                 r;
    if (!open_raster(c, &r) || g->GDALGetGeoTransform(c->data, place) != 0)
        return error_set(c->error, LMN_FORMAT, "the raster does not say where it lies");
    geodata_extent e = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    /* Heights are those of the cells' middles. */
    for (int corner = 0; corner < 4; corner++) {
        double x = corner & 1 ? r.width - 0.5 : 0.5, y = corner & 2 ? r.height - 0.5 : 0.5;
        for (int k = 0; k < 2; k++) {
            double at = place[3 * k] + x * place[3 * k + 1] + y * place[3 * k + 2];
            e.low[k] = fmin(e.low[k], at);
            e.high[k] = fmax(e.high[k], at);
        }
    }
    e.step = hypot(place[1], place[4]);
    gdal_handle system = g->GDALGetSpatialRef(c->data), copy = system ? g->OSRClone(system) : NULL;
    e.geographic = copy && g->OSRIsGeographic(copy);
    if (copy)
        g->OSRAutoIdentifyEPSG(copy);
    bool known = copy && g->OSRGetAuthorityCode(copy, NULL) != NULL;
    fence_put(c->answer, &e, sizeof e);
    /* Names that nobody can look up say nothing; then heights are asked for in the raster's own system. */
    fence_put_text(c->answer, known          ? geodata_system_name(c, copy, name, sizeof name)
                              : e.geographic ? "urn:ogc:def:crs:OGC:1.3:CRS84"
                                             : "");
    if (copy)
        g->OSRDestroySpatialReference(copy);
    return LMN_OK;
}

/* The posts as columns and rows of the raster, in place: x and y, and whether each is any. */
static lmn_status find_cells(const geodata_child *c, const raster *r, const char *system, double *x, double *y,
                             int *good, size_t count)
{
    const geodata_library *g = c->library;
    gdal_handle            own = g->GDALGetSpatialRef(c->data), from = g->OSRNewSpatialReference(NULL), way = NULL;
    gdal_handle            to = own ? g->OSRClone(own) : NULL;
    lmn_status             status = LMN_OK;
    if (system[0] && to) {
        g->OSRSetAxisMappingStrategy(to, 0);
        if (g->OSRSetFromUserInput(from, system) != 0) {
            status =
                error_set(c->error, LMN_UNSUPPORTED, "the model's coordinate system \"%.100s\" is not known", system);
        } else {
            g->OSRSetAxisMappingStrategy(from, 0);
            g->OSRStripVertical(from);
            g->OSRStripVertical(to);
            way = g->OCTNewCoordinateTransformation(from, to);
            if (!way)
                status = error_set(c->error, LMN_UNSUPPORTED,
                                   "there is no way from the model's coordinate system to that of the terrain");
        }
    }
    for (size_t i = 0; i < count; i++)
        good[i] = 1;
    for (size_t first = 0; way && first < count; first += 65536) {
        size_t some = count - first < 65536 ? count - first : 65536;
        g->OCTTransformEx(way, (int)some, x + first, y + first, NULL, good + first);
    }
    for (size_t i = 0; i < count; i++) {
        double a = x[i], b = y[i];
        x[i] = r->to_cell[0] + a * r->to_cell[1] + b * r->to_cell[2] - 0.5;
        y[i] = r->to_cell[3] + a * r->to_cell[4] + b * r->to_cell[5] - 0.5;
        good[i] = good[i] && isfinite(x[i]) && isfinite(y[i]) && x[i] >= -0.5 && y[i] >= -0.5 &&
                  x[i] <= r->width - 0.5 && y[i] <= r->height - 0.5;
    }
    if (way)
        g->OCTDestroyCoordinateTransformation(way);
    if (to)
        g->OSRDestroySpatialReference(to);
    g->OSRDestroySpatialReference(from);
    return status;
}

/* Reads the part that the posts lie in. */
static lmn_status read_cells(const geodata_child *c, raster *r, const double *x, const double *y, const int *good,
                             size_t count)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        if (!good[i])
            continue;
        low[0] = fmin(low[0], x[i]);
        high[0] = fmax(high[0], x[i]);
        low[1] = fmin(low[1], y[i]);
        high[1] = fmax(high[1], y[i]);
    }
    if (!(high[0] >= low[0]))
        return error_set(c->error, LMN_FORMAT, "the terrain does not reach to the model");
    r->left = (int)fmax(floor(low[0]), 0);
    r->top = (int)fmax(floor(low[1]), 0);
    r->columns = (int)fmin(ceil(high[0]) + 1, r->width - 1) - r->left + 1;
    r->rows = (int)fmin(ceil(high[1]) + 1, r->height - 1) - r->top + 1;
    if ((double)r->columns * r->rows > CELLS_MAX)
        return error_set(c->error, LMN_LIMIT, "the part of the terrain below the model has more than %d posts",
                         CELLS_MAX);
    r->cells = mem_calloc((size_t)r->columns * (size_t)r->rows, sizeof *r->cells);
    if (!r->cells)
        return error_memory(c->error);
    if (c->library->GDALRasterIO(r->band, READ, r->left, r->top, r->columns, r->rows, r->cells, r->columns, r->rows,
                                 FLOAT32, 0, 0) != 0)
        return error_set(c->error, LMN_FORMAT, "GDAL cannot read it: %.200s", c->library->CPLGetLastErrorMsg());
    return LMN_OK;
}

static double cell(const raster *r, int column, int row)
{
    column = column < 0 ? 0 : column >= r->columns ? r->columns - 1 : column;
    row = row < 0 ? 0 : row >= r->rows ? r->rows - 1 : row;
    float value = r->cells[(size_t)row * (size_t)r->columns + (size_t)column];
    bool  known = isfinite(value) && (!r->has_none || value < r->none || value > r->none) && fabsf(value) < 20000;
    return known ? (value * r->scale + r->offset) * r->metres : NAN;
}

/* Between four posts, or of those of them that there are the nearest. */
static float height_at(const raster *r, double x, double y)
{
    x -= r->left;
    y -= r->top;
    int    column = (int)floor(x), row = (int)floor(y);
    double u = x - column, v = y - row;
    double h[4] = {cell(r, column, row), cell(r, column + 1, row), cell(r, column, row + 1),
                   cell(r, column + 1, row + 1)};
    double all = (h[0] * (1 - u) + h[1] * u) * (1 - v) + (h[2] * (1 - u) + h[3] * u) * v;
    if (isfinite(all))
        return (float)all;
    return (float)h[(v > 0.5 ? 2 : 0) + (u > 0.5 ? 1 : 0)];
}

lmn_status geodata_heights(const geodata_child *c, const geodata_grid *grid, const char *system)
{
    raster r;
    size_t count = (size_t)grid->columns * grid->rows;
    if (!open_raster(c, &r))
        return error_set(c->error, LMN_FORMAT, "the raster does not say where it lies");
    if (grid->columns < 2 || grid->rows < 2 || grid->columns > POSTS_MAX / grid->rows || !isfinite(grid->step))
        return error_set(c->error, LMN_LIMIT, "a terrain of more than %d posts", POSTS_MAX);
    double *x = mem_calloc(count, sizeof *x), *y = mem_calloc(count, sizeof *y);
    int    *good = mem_calloc(count, sizeof *good);
    bool    room = x && y && good;
    for (size_t i = 0; i < count && room; i++) {
        x[i] = grid->x + (double)(i % grid->columns) * grid->step;
        y[i] = grid->y + (double)(i / grid->columns) * grid->step;
    }
    lmn_status status = room ? find_cells(c, &r, system, x, y, good, count) : error_memory(c->error);
    if (status == LMN_OK)
        status = read_cells(c, &r, x, y, good, count);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        float height = good[i] ? height_at(&r, x[i], y[i]) : NAN;
        fence_put(c->answer, &height, sizeof height);
    }
    mem_free(x);
    mem_free(y);
    mem_free(good);
    mem_free(r.cells);
    return status;
}
