/* A texture whose mip levels are made by hand, one by one: what halftoning needs, since averaged strokes are grey.
 * Data only. */
#ifndef LIMNER_BASE_MIP_CHAIN_H
#define LIMNER_BASE_MIP_CHAIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

enum { MIP_LEVELS_MAX = 15 };

typedef enum mip_format {
    MIP_R8,   /* one byte a texel */
    MIP_RG8,  /* two */
    MIP_RG16F /* two floats in memory, halves on the GPU */
} mip_format;

/* Level k is max(1, width >> k) × max(1, height >> k) texels; its layers follow each other, each with row 0 at the
 * bottom (v = 0). */
typedef struct mip_chain {
    int        width, height, layers, levels;
    mip_format format;
    bool       clamped; /* does not repeat */
    bool       nearest; /* texels must not be mixed */
    bool       stepped; /* nor levels, by the sampler: who looks them up does */
    bool       similar; /* level k + 1 is level k, laid out half as large */
    float fact; /* a number that belongs to it, which shaders get too: of screens, texels between strokes of level 0, on
                   the mean */
    void *data[MIP_LEVELS_MAX];
} mip_chain;

/* All texels 0. Sides at most 4096; levels 0: down to one texel. Errors: LMN_LIMIT, LMN_MEMORY. */
lmn_status mip_chain_create(mip_chain *out, int width, int height, int layers, int levels, mip_format format,
                            lmn_error *error);
void       mip_chain_release(mip_chain *chain);
int        mip_width(const mip_chain *chain, int level);
int        mip_height(const mip_chain *chain, int level);
size_t     mip_texel_size(mip_format format); /* in memory */
size_t     mip_level_bytes(const mip_chain *chain, int level);
/* One layer of one level. */
void *mip_layer(const mip_chain *chain, int level, int layer);

#endif
