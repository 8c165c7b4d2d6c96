#include "base/mip_chain.h"

#include <string.h>

#include "base/memory.h"

enum { SIDE_MAX = 4096 };

static int side_of(int side, int level)
{
    return side >> level > 1 ? side >> level : 1;
}

int mip_width(const mip_chain *chain, int level)
{
    return side_of(chain->width, level);
}

int mip_height(const mip_chain *chain, int level)
{
    return side_of(chain->height, level);
}

size_t mip_texel_size(mip_format format)
{
    return format == MIP_R8 ? 1 : format == MIP_RG8 ? 2 : 2 * sizeof(float);
}

static size_t layer_bytes(const mip_chain *chain, int level)
{
    return (size_t)mip_width(chain, level) * (size_t)mip_height(chain, level) * mip_texel_size(chain->format);
}

size_t mip_level_bytes(const mip_chain *chain, int level)
{
    return layer_bytes(chain, level) * (size_t)chain->layers;
}

void *mip_layer(const mip_chain *chain, int level, int layer)
{
    return (unsigned char *)chain->data[level] + layer_bytes(chain, level) * (size_t)layer;
}

static int whole_chain(int width, int height)
{
    int levels = 1;
    while ((width | height) >> levels)
        levels++;
    return levels;
}

lmn_status mip_chain_create(mip_chain *out, int width, int height, int layers, int levels, mip_format format,
                            lmn_error *error)
{
    *out = (mip_chain){.width = width, .height = height, .layers = layers, .format = format};
    if (width < 1 || height < 1 || layers < 1 || layers > 256 || width > SIDE_MAX || height > SIDE_MAX)
        return error_set(error, LMN_LIMIT,
                         "a texture of %d x %d texels and %d layers; allowed are %d a side and 256 layers", width,
                         height, layers, SIDE_MAX);
    int most = whole_chain(width, height);
    out->levels = levels > 0 && levels < most ? levels : most;
    for (int k = 0; k < out->levels; k++) {
        out->data[k] = mem_calloc(mip_level_bytes(out, k), 1);
        if (!out->data[k]) {
            mip_chain_release(out);
            return error_memory(error);
        }
    }
    return LMN_OK;
}

void mip_chain_release(mip_chain *chain)
{
    for (int k = 0; k < MIP_LEVELS_MAX; k++)
        mem_free(chain->data[k]);
    memset(chain, 0, sizeof *chain);
}
