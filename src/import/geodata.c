/* GeoPackages, shapefiles, OpenStreetMap's extracts, and rasters of heights: a child with GDAL in it gets their bytes
 * and those of the files beside them, and nothing else. Footprints come back as GeoJSON, rasters as terrain. */
#define _GNU_SOURCE /* memmem */
#include "import/geodata.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "import/access.h"
#include "import/build.h"
#include "import/city.h"
#include "import/geodata_library.h"
#include "import/gunzip.h"
#include "import/terrain.h"

/* --- requests ------------------------------------------------------------------------------------------- */

static lmn_status put_file(fence_bytes *request, const char *name, const file_data *file, lmn_error *error)
{
    if (file->size > UINT32_MAX)
        return error_set(error, LMN_LIMIT, "files of these formats may have up to 4 GiB");
    fence_put_text(request, name);
    fence_put_u32(request, (uint32_t)file->size);
    fence_put(request, file->data, file->size);
    return LMN_OK;
}

/* What GDAL calls it: without its folder, and without ".gz". */
static void name_of(const char *path, char *out, size_t size)
{
    const char *slash = strrchr(path, '/');
    char        ending[16];
    snprintf(out, size, "%s", slash ? slash + 1 : path);
    file_ending(out, ending, sizeof ending);
    if (strcmp(ending, ".gz") == 0)
        out[strlen(out) - 3] = '\0';
}

/* Files beside a model are called like it but for their ending. */
static lmn_status put_beside(fence_bytes *request, const import_job *job, const char *name, uint32_t *count,
                             lmn_error *error)
{
    static const struct {
        const char *ending, *others[6];
    } rows[] = {{".shp", {".shx", ".dbf", ".prj", ".cpg", NULL}},
                {".tif", {".tfw", ".prj", NULL}},
                {".tiff", {".tfw", ".prj", NULL}},
                {".asc", {".prj", NULL}}};
    char       ending[16], other[300];
    lmn_status status = LMN_OK;
    file_ending(name, ending, sizeof ending);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int k = 0; strcmp(rows[i].ending, ending) == 0 && rows[i].others[k] && status == LMN_OK; k++) {
            file_data file = {0};
            snprintf(other, sizeof other, "%.*s%s", (int)(strlen(name) - strlen(ending)), name, rows[i].others[k]);
            if (!build_has_file(job, other))
                continue;
            status = build_side_file(job, "part of the model", other, &file, error);
            if (status == LMN_OK && file.data)
                status = put_file(request, other, &file, error);
            *count += status == LMN_OK && file.data;
            file_data_release(&file);
        }
    return status;
}

lmn_status geodata_ask(const import_job *job, geodata_question question, const geodata_grid *grid, const char *system,
                       fence_bytes *answer, lmn_error *error)
{
    fence_bytes request = {0}, beside = {0};
    char        name[256];
    uint32_t    count = 1;
    name_of(job->path, name, sizeof name);
    *answer = (fence_bytes){0};
    lmn_status status = put_beside(&beside, job, name, &count, error);
    fence_put_u32(&request, (uint32_t)question);
    fence_put_text(&request, name);
    fence_put_u32(&request, count);
    if (status == LMN_OK)
        status = put_file(&request, name, job->file, error);
    fence_put(&request, beside.bytes, beside.size);
    request.failed = request.failed || beside.failed;
    mem_free(beside.bytes);
    if (grid) {
        fence_put(&request, grid, sizeof *grid);
        fence_put_text(&request, system);
    }
    if (status == LMN_OK)
        status =
            fence_call_prepared(answer, geodata_answer, geodata_prepare, "the reader of this format", &request, error);
    mem_free(request.bytes);
    if (status != LMN_OK)
        error_file(error, job->path);
    return status;
}

/* --- formats -------------------------------------------------------------------------------------------- */

static bool begins(const file_data *file, const char *bytes, size_t size)
{
    return file->size >= size && memcmp(file->data, bytes, size) == 0;
}

static bool is_package(const file_data *file)
{
    return begins(file, "SQLite format 3", 16) && file->size >= 72 && memcmp(file->data + 68, "GPKG", 4) == 0;
}

static bool is_openstreetmap(const file_data *file)
{
    size_t size = file->size < 512 ? file->size : 512;
    return (file->size > 16 && memcmp(file->data, "\0\0\0", 3) == 0 && memmem(file->data, 32, "OSMHeader", 9)) ||
           (size > 4 && memmem(file->data, size, "<osm", 4));
}

static bool is_tiff(const file_data *file)
{
    return begins(file, "II*\0", 4) || begins(file, "MM\0*", 4) || begins(file, "II+\0", 4);
}

static bool is_ascii_grid(const file_data *file)
{
    return begins(file, "ncols", 5) || begins(file, "NCOLS", 5);
}

bool geodata_is_raster(const char *path, const file_data *file)
{
    char ending[16];
    gunzip_ending(path, ending, sizeof ending);
    return is_tiff(file) || is_ascii_grid(file) || strcmp(ending, ".hgt") == 0;
}

static bool recognises(const file_data *file)
{
    return is_package(file) || is_openstreetmap(file) || is_tiff(file) || is_ascii_grid(file) ||
           begins(file, "\x00\x00\x27\x0a", 4) || begins(file, "fgb\x03", 4);
}

static lmn_status read_features(const import_job *job, lmn_error *error)
{
    fence_bytes answer;
    lmn_status  status = geodata_ask(job, GEODATA_FEATURES, NULL, NULL, &answer, error);
    if (status != LMN_OK)
        return status;
    file_data  text = {answer.bytes, answer.size};
    import_job as_text = *job;
    as_text.file = &text;
    status = import_geojson.read(&as_text, error);
    file_data_release(&text);
    return status;
}

static lmn_status read_geodata(const import_job *job, lmn_error *error)
{
    return geodata_is_raster(job->path, job->file) ? terrain_read(job, error) : read_features(job, error);
}

const import_format import_geodata = {
    .name = "geodata",
    .endings = ".gpkg .shp .osm .pbf .fgb .tif .tiff .hgt .asc",
    .up = 'z',
    .recognises = recognises,
    .read = read_geodata,
};
