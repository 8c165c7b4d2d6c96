/* Inside the import folder: GDAL, which is no part of the program. It is loaded where it is used, in a fenced child of
 * its own (fence_call_prepared), so that nobody who reads no such file pays for its hundred libraries, and is declared
 * here as far as it is called: its C interface has been the same since version 2. */
#ifndef LIMNER_IMPORT_GEODATA_LIBRARY_H
#define LIMNER_IMPORT_GEODATA_LIBRARY_H

#include <stdbool.h>
#include <stdint.h>

typedef struct gdal_thing *gdal_handle;

#define GEODATA_FUNCTIONS(F)                                                                                           \
    F(void, GDALAllRegister, (void))                                                                                   \
    F(void, CPLSetConfigOption, (const char *, const char *))                                                          \
    F(void *, CPLSetErrorHandler, (void (*)(int, int, const char *)))                                                  \
    F(const char *, CPLGetLastErrorMsg, (void))                                                                        \
    F(void *, VSIFileFromMemBuffer, (const char *, unsigned char *, uint64_t, int))                                    \
    F(int, VSIFCloseL, (void *))                                                                                       \
    F(gdal_handle, GDALOpenEx,                                                                                         \
      (const char *, unsigned, const char *const *, const char *const *, const char *const *))                         \
    F(void, GDALClose, (gdal_handle))                                                                                  \
    F(int, GDALDatasetGetLayerCount, (gdal_handle))                                                                    \
    F(gdal_handle, GDALDatasetGetLayer, (gdal_handle, int))                                                            \
    F(gdal_handle, GDALDatasetGetNextFeature,                                                                          \
      (gdal_handle, gdal_handle *, double *, int (*)(double, const char *, void *), void *))                           \
    F(const char *, OGR_L_GetName, (gdal_handle))                                                                      \
    F(gdal_handle, OGR_L_GetSpatialRef, (gdal_handle))                                                                 \
    F(gdal_handle, OGR_F_GetGeometryRef, (gdal_handle))                                                                \
    F(int, OGR_F_GetFieldCount, (gdal_handle))                                                                         \
    F(gdal_handle, OGR_F_GetFieldDefnRef, (gdal_handle, int))                                                          \
    F(const char *, OGR_Fld_GetNameRef, (gdal_handle))                                                                 \
    F(int, OGR_Fld_GetType, (gdal_handle))                                                                             \
    F(int, OGR_F_IsFieldSetAndNotNull, (gdal_handle, int))                                                             \
    F(const char *, OGR_F_GetFieldAsString, (gdal_handle, int))                                                        \
    F(void, OGR_F_Destroy, (gdal_handle))                                                                              \
    F(int, OGR_G_GetGeometryType, (gdal_handle))                                                                       \
    F(int, OGR_G_GetGeometryCount, (gdal_handle))                                                                      \
    F(gdal_handle, OGR_G_GetGeometryRef, (gdal_handle, int))                                                           \
    F(gdal_handle, OGR_G_GetLinearGeometry, (gdal_handle, double, char **))                                            \
    F(int, OGR_G_GetPointCount, (gdal_handle))                                                                         \
    F(void, OGR_G_GetPoint, (gdal_handle, int, double *, double *, double *))                                          \
    F(int, OGR_G_Transform, (gdal_handle, gdal_handle))                                                                \
    F(void, OGR_G_DestroyGeometry, (gdal_handle))                                                                      \
    F(gdal_handle, OSRNewSpatialReference, (const char *))                                                             \
    F(int, OSRSetFromUserInput, (gdal_handle, const char *))                                                           \
    F(void, OSRSetAxisMappingStrategy, (gdal_handle, int))                                                             \
    F(gdal_handle, OSRClone, (gdal_handle))                                                                            \
    F(void, OSRDestroySpatialReference, (gdal_handle))                                                                 \
    F(int, OSRStripVertical, (gdal_handle))                                                                            \
    F(int, OSRIsGeographic, (gdal_handle))                                                                             \
    F(int, OSRIsProjected, (gdal_handle))                                                                              \
    F(int, OSRIsSame, (gdal_handle, gdal_handle))                                                                      \
    F(int, OSRAutoIdentifyEPSG, (gdal_handle))                                                                         \
    F(const char *, OSRGetAuthorityName, (gdal_handle, const char *))                                                  \
    F(const char *, OSRGetAuthorityCode, (gdal_handle, const char *))                                                  \
    F(const char *, OSRGetName, (gdal_handle))                                                                         \
    F(const char *, OSRGetAttrValue, (gdal_handle, const char *, int))                                                 \
    F(double, OSRGetLinearUnits, (gdal_handle, char **))                                                               \
    F(gdal_handle, OCTNewCoordinateTransformation, (gdal_handle, gdal_handle))                                         \
    F(int, OCTTransformEx, (gdal_handle, int, double *, double *, double *, int *))                                    \
    F(void, OCTDestroyCoordinateTransformation, (gdal_handle))                                                         \
    F(int, GDALGetRasterXSize, (gdal_handle))                                                                          \
    F(int, GDALGetRasterYSize, (gdal_handle))                                                                          \
    F(int, GDALGetGeoTransform, (gdal_handle, double *))                                                               \
    F(int, GDALInvGeoTransform, (const double *, double *))                                                            \
    F(gdal_handle, GDALGetSpatialRef, (gdal_handle))                                                                   \
    F(gdal_handle, GDALGetRasterBand, (gdal_handle, int))                                                              \
    F(double, GDALGetRasterNoDataValue, (gdal_handle, int *))                                                          \
    F(double, GDALGetRasterScale, (gdal_handle, int *))                                                                \
    F(double, GDALGetRasterOffset, (gdal_handle, int *))                                                               \
    F(const char *, GDALGetRasterUnitType, (gdal_handle))                                                              \
    F(int, GDALRasterIO, (gdal_handle, int, int, int, int, int, void *, int, int, int, int, int))

#define GEODATA_FIELD(type, name, parameters) type(*name) parameters;
typedef struct geodata_library {
    GEODATA_FUNCTIONS(GEODATA_FIELD)
} geodata_library;
#undef GEODATA_FIELD

/* In the child, before it is fenced: loads the library and makes it open what it will need. */
void geodata_prepare(void);
/* In the child: its functions. False: it is not installed, or lacks some of them. */
bool geodata_library_get(geodata_library *out);

#endif
