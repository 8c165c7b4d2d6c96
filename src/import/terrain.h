/* Inside the import folder: terrain from rasters of heights (geodata.h), as a grid around a city's origin, and what
 * lies on it. Nienhaus 2005, section 4.8; row C02. */
#ifndef LIMNER_IMPORT_TERRAIN_H
#define LIMNER_IMPORT_TERRAIN_H

#include "import/footprint.h"
#include "import/geodata.h"

/* Posts at low + step · (column, row), in the scene's coordinates. Each cell is two triangles, which meet along the
 * line from its first to its last post. */
typedef struct terrain {
    double   low[2], step;
    uint32_t columns, rows;
    float   *heights; /* everywhere; where none is known, those nearby */
    bool    *known;
    uint64_t filled; /* posts without a known height */
} terrain;
void terrain_free(terrain *t); /* NULL is fine */

/* The terrain in a file below what lies between these bounds, which are the scene's. Errors: those of geodata_ask;
 * LMN_USAGE when the city does not say where it lies. */
lmn_status terrain_load(terrain **out, const char *path, const city_facts *city, lmn_error *error);
/* What the child answers (geodata.h) is checked like a file: where a raster lies, and the heights of a terrain whose
 * grid is laid, less those of `zero`. Errors: LMN_FORMAT, LMN_MEMORY. */
lmn_status terrain_take_extent(geodata_extent *out, char *system, size_t size, const fence_bytes *answer,
                               const char *path, lmn_error *error);
lmn_status terrain_take_heights(terrain *t, const fence_bytes *answer, double zero, const char *path, lmn_error *error);

/* The height, at the edge beyond it. */
double terrain_height(const terrain *t, double x, double y);
/* The lowest height along a closed ring. */
double terrain_lowest(const terrain *t, const double (*ring)[2], size_t count);

/* Lays the faces of a flat shape on the terrain, `above` it: pieces that each lie on one of its triangles, so that
 * nothing of it comes through. False when memory is gone. */
bool terrain_drape(const terrain *t, const city_shape *flat, const vec3 *flat_points, double above, city_shape *out,
                   footprint_points *points);

/* Ground turns where triangles meet, but has no edges there: gives it normals, and outlines and rims as its only
 * lines. False: memory is gone; what there is of them is the primitive's. */
bool terrain_make_smooth(primitive *p);

/* A node "terrain" with all of it. */
lmn_status terrain_into_scene(const terrain *t, city_builder *b);

/* A raster as a model of its own. */
lmn_status terrain_read(const import_job *job, lmn_error *error);

#endif
