/* DXF read by dxflib: what CAD programs make of it. */
#ifndef TRUTH_DXF_READ_H
#define TRUTH_DXF_READ_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum dxf_kind {
    DXF_LINE,
    DXF_POLYLINE,
    DXF_CIRCLE,
    DXF_TEXT,
    DXF_ARC,     /* angles: degrees */
    DXF_ELLIPSE, /* points: centre, end of the longer radius from there; size: ratio; angles: parameters */
    DXF_SPLINE   /* points: of control */
} dxf_kind;

typedef struct dxf_entity {
    dxf_kind kind;
    char     layer[64], line_type[32], words[128];
    bool     closed;
    size_t   first, count; /* points */
    double   size;         /* radius or height */
    double   angles[2];
    double   pattern_scale;
    size_t   knots;
} dxf_entity;

typedef struct dxf_file {
    dxf_entity *entities;
    double (*points)[2];
    double *bulges; /* of each point */
    size_t  entity_count, point_count, layer_count;
} dxf_file;

/* False when it cannot be read. End with dxf_release. */
bool dxf_read(dxf_file *out, const char *path);
void dxf_release(dxf_file *f);

#ifdef __cplusplus
}
#endif
#endif
