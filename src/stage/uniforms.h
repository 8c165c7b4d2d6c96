/* From parameter tables to shaders: the declarations of a program's prelude and the values of its uniforms. */
#ifndef LIMNER_STAGE_UNIFORMS_H
#define LIMNER_STAGE_UNIFORMS_H

#include "gpu/gpu.h"
#include "technique/technique.h"

/* One table with the values that belong to it. */
typedef struct param_set {
    const char  *prefix; /* of the uniforms' names: "u_", for lines "u_line_", so that both fit into one program */
    const param *params;
    size_t       count;
    const void  *values;
} param_set;

/* Appends declarations of the parameters: uniforms PREFIX+KEY, and #define KEY for variants. */
void uniforms_declare(text *prelude, param_set set);
/* Sets the uniforms of the program in use. */
void uniforms_set(gpu *g, param_set set);

/* A key as it stands in the names of macros. */
enum { CAPITALS_SIZE = 64 };
void uniforms_capitals(const char *key, char out[CAPITALS_SIZE]);

/* The light that a parameter's colour shows, straight alpha: what stands in for the model's own. */
void uniforms_light(colour c, float out[4]);

/* Declares a picture that is there: its sampler t_NAME, and HAS_NAME. Once is enough, more does no harm. */
void target_declare(text *prelude, const target_row *row);

#endif
