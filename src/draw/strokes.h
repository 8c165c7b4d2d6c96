/* Strokes of a drawing: what of the scene they are made of, kept with the upload, and the pass that draws them. */
#ifndef LIMNER_DRAW_STROKES_H
#define LIMNER_DRAW_STROKES_H

#include "gpu/gpu.h"
#include "stroke/stroke.h"

/* The scene as strokes see it, made when first asked for, for a set of parts that may hide lines; the edges of its meshes on the GPU; and what the last camera saw of
 * it. */
typedef struct stroke_store stroke_store;

void stroke_store_destroy(stroke_store **s, gpu *g);

#endif
