#include "import/geodata_library.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

/* By the number in the library's name, newest first; the one without is there for developers. */
enum { NEWEST = 45, OLDEST = 26 };

static void *load(int flags)
{
    char name[32];
    for (int i = NEWEST; i >= OLDEST; i--) {
        snprintf(name, sizeof name, "libgdal.so.%d", i);
        void *found = dlopen(name, RTLD_NOW | RTLD_LOCAL | flags);
        if (found)
            return found;
    }
    return dlopen("libgdal.so", RTLD_NOW | RTLD_LOCAL | flags);
}

static bool find(void *library, const char *name, void *out)
{
    void *address = dlsym(library, name);
    *(void **)out = address;
    return address != NULL;
}

static bool find_all(void *library, geodata_library *out)
{
    bool good = library != NULL;
#define GEODATA_FIND(type, name, parameters) good = good && find(library, #name, &out->name);
    GEODATA_FUNCTIONS(GEODATA_FIND)
#undef GEODATA_FIND
    return good;
}

bool geodata_library_get(geodata_library *out)
{
    return find_all(load(RTLD_NOLOAD), out);
}

static void say_nothing(int kind, int number, const char *message)
{
    (void)kind;
    (void)number;
    (void)message;
}

/* PROJ reads its database when the first system is looked up, and keeps it open. */
static void open_database(const geodata_library *g)
{
    static const char *const names[] = {"EPSG:4326", "EPSG:32632", "EPSG:2263", "EPSG:4269", "EPSG:7415"};
    gdal_handle              first = g->OSRNewSpatialReference(NULL);
    g->OSRSetFromUserInput(first, names[0]);
    for (size_t i = 1; i < sizeof names / sizeof *names; i++) {
        gdal_handle other = g->OSRNewSpatialReference(NULL);
        gdal_handle way =
            g->OSRSetFromUserInput(other, names[i]) == 0 ? g->OCTNewCoordinateTransformation(other, first) : NULL;
        double x = 500000, y = 5000000;
        int    good;
        if (way) {
            g->OCTTransformEx(way, 1, &x, &y, NULL, &good);
            g->OCTDestroyCoordinateTransformation(way);
        }
        g->OSRAutoIdentifyEPSG(other);
        g->OSRDestroySpatialReference(other);
    }
    g->OSRDestroySpatialReference(first);
}

void geodata_prepare(void)
{
    /* What starts threads when it is loaded must not. */
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("PROJ_NETWORK", "OFF", 1);
    geodata_library g;
    if (!find_all(load(0), &g))
        return;
    static const char *const options[][2] = {{"GDAL_DRIVER_PATH", "disable"},
                                             {"GDAL_NUM_THREADS", "1"},
                                             {"GDAL_PAM_ENABLED", "NO"},
                                             {"GDAL_CACHEMAX", "128"},
                                             {"CPL_VSIL_CURL_ALLOWED_EXTENSIONS", "none"},
                                             {"OSR_DEFAULT_AXIS_MAPPING_STRATEGY", "TRADITIONAL_GIS_ORDER"},
                                             {"SHAPE_RESTORE_SHX", "YES"},
                                             {"OSM_MAX_TMPFILE_SIZE", "4000"},
                                             {"OSM_CONFIG_FILE", "/vsimem/limner/osmconf.ini"}};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        g.CPLSetConfigOption(options[i][0], options[i][1]);
    g.CPLSetErrorHandler(say_nothing);
    g.GDALAllRegister();
    open_database(&g);
}
