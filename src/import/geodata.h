/* Inside the import folder: files of geographic information systems, which GDAL reads: footprints and what lies between
 * them, and rasters of heights. */
#ifndef LIMNER_IMPORT_GEODATA_H
#define LIMNER_IMPORT_GEODATA_H

#include "fence/fence.h"
#include "import/import.h"

/* What is asked of the child. Behind it stand the model's name, the number of files, and each file's name, size and
 * bytes; the first is the model. */
typedef enum geodata_question {
    GEODATA_FEATURES, /* answer: a GeoJSON FeatureCollection */
    GEODATA_EXTENT,   /* answer: geodata_extent, and the system's name */
    GEODATA_HEIGHTS   /* request: geodata_grid and the system's name; answer: a float for each post */
} geodata_question;

/* Posts at (x + column · step, y + row · step). NaN: no height is known. */
typedef struct geodata_grid {
    double   x, y, step;
    uint32_t columns, rows;
} geodata_grid;

typedef struct geodata_extent {
    double   low[2], high[2]; /* longitude first */
    double   step;            /* between two posts, in the same unit */
    uint32_t geographic;
} geodata_extent;

lmn_status geodata_answer(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error);
/* Its parts: an open file, and what to do with it. */
typedef struct geodata_child {
    const struct geodata_library *library;
    struct gdal_thing            *data;
    fence_bytes                  *answer;
    lmn_error                    *error;
} geodata_child;
lmn_status geodata_features(const geodata_child *c);
lmn_status geodata_extent_of(const geodata_child *c);
lmn_status geodata_heights(const geodata_child *c, const geodata_grid *grid, const char *system);
/* "EPSG:25832", or what else it is called; "" where it has none. Valid until the next call. */
const char *geodata_system_name(const geodata_child *c, struct gdal_thing *system, char *room, size_t size);

/* In this process: asks a child about the file that the job has, or about these bytes, with the files beside it. */
lmn_status geodata_ask(const import_job *job, geodata_question question, const geodata_grid *grid, const char *system,
                       fence_bytes *answer, lmn_error *error);
/* Is it a raster of heights? By its content, or its ending. */
bool geodata_is_raster(const char *path, const file_data *file);

#endif
