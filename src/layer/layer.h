/* The kind "layers": which surfaces of a figure are seen. */
#ifndef LIMNER_LAYER_LAYER_H
#define LIMNER_LAYER_LAYER_H

#include "technique/technique.h"

extern const kind kind_layers;

typedef enum layer_shading { SHADING_FORWARD, SHADING_DEFERRED } layer_shading;

/* The parameters, read by src/draw when it plans the geometry pass. */
typedef struct front_values {
    bool    complement;
    int32_t shading;
} front_values;

#endif
