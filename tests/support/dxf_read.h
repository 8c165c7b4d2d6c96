/* DXF read by dxflib: what CAD programs make of it. */
#ifndef TRUTH_DXF_READ_H
#define TRUTH_DXF_READ_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum dxf_kind { DXF_LINE, DXF_POLYLINE, DXF_CIRCLE, DXF_TEXT } dxf_kind;

typedef struct dxf_entity {
    dxf_kind kind;
    char     layer[64], words[128];
    bool     closed;
    size_t   first, count; /* points */
    double   size;         /* radius or height */
} dxf_entity;

typedef struct dxf_file {
    dxf_entity *entities;
    double (*points)[2];
    size_t entity_count, point_count, layer_count;
} dxf_file;

/* False when it cannot be read. End with dxf_release. */
bool dxf_read(dxf_file *out, const char *path);
void dxf_release(dxf_file *f);

#ifdef __cplusplus
}
#endif
#endif
