/* A model of parts, each a mesh, in groups that can be turned, and the binary glTF it is written as. Positions
 * alone are written: normals follow from the angles between faces, flat at edges and smooth along curves. */
#ifndef EXAMPLES_MODEL_H
#define EXAMPLES_MODEL_H

#include "solid.h"

#include <stdio.h>

typedef struct model_material {
    const char *name;
    double      colour[3]; /* linear */
} model_material;

typedef struct model_group {
    const char *name;
    double      at[3];
    int         quarter_turns; /* about +y */
    int         inside;        /* 1 + the group that it belongs to and moves with; 0: none */
} model_group;

typedef struct model_part {
    const char *name;
    int         group, material;
    void (*build)(mesh *); /* parts with the same one share a mesh, and so have the same material */
    double at[3];
    void (*build_one)(mesh *, int number); /* instead of `build`, for parts that are many of a kind */
    int number;
} model_part;

typedef struct model_camera {
    const char *name;
    double      at[3], target[3], fov_y; /* degrees; fov_y is the vertical angle */
    int         inside;                  /* like a group's; `at` and `target` are then that group's */
} model_camera;

typedef struct glb glb;

typedef struct model {
    const char           *generator, *name;
    double                units_per_metre; /* of points and of `at` */
    const model_material *materials;
    int                   material_count;
    const model_group    *groups;
    int                   group_count;
    const model_part     *parts;
    int                   part_count;
    void (*animate)(glb *, FILE *json); /* writes "animations":[…], or NULL; group k is node 1 + k */
    const model_camera *cameras;
    int                 camera_count;
} model;

bool model_write(const model *m, const char *path);

/* For `animate`: puts values into the file, returns their accessor. */
int glb_put_floats(glb *g, const float *values, uint32_t count, int components, const char *type, int target);

#endif
