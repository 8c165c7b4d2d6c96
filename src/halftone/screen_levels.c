/* Equalising, hatch maps, and what a screen does with a light. */
#include "halftone/screen_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* --- tone ----------------------------------------------------------------------------------------------- */

/* A group of equally dark texels takes the middle of its fraction, so that the ink is never off by more than half of
 * the group. Rounded up, since v is inked up to the light 1 − v: so the ink at light t/255 is the fraction (255 −
 * t)/255 exactly where groups are single texels, and none in full light. */
static uint8_t value_of_fraction(uint64_t before, uint64_t group, uint64_t all)
{
    uint64_t value = (255 * (2 * before + group) + 2 * all - 1) / (2 * all);
    return (uint8_t)(value > 254 ? 254 : value < 1 ? 1 : value);
}

void ink_equalise(uint8_t *out, const uint16_t *ink, size_t count, uint32_t *tones)
{
    memset(tones, 0, INK_TONES * sizeof *tones);
    for (size_t i = 0; i < count; i++)
        tones[ink[i]]++;
    uint64_t before = 0;
    for (size_t t = INK_MOST; t > 0; t--) {
        uint32_t group = tones[t];
        if (group)
            tones[t] = value_of_fraction(before, group, count);
        before += group;
    }
    tones[0] = 255;
    for (size_t i = 0; i < count; i++)
        out[i] = (uint8_t)tones[ink[i]];
}

lmn_status screen_equalise(mip_chain *screen, lmn_error *error)
{
    if (screen->format != MIP_R8)
        return error_set(error, LMN_USAGE, "only screens of one byte a texel can be equalised");
    size_t    most = mip_level_bytes(screen, 0) / (size_t)screen->layers;
    uint16_t *ink = mem_calloc(most, sizeof *ink);
    uint32_t *tones = mem_calloc(INK_TONES, sizeof *tones);
    bool      enough = ink && tones;
    for (int k = 0; enough && k < screen->levels; k++)
        for (int layer = 0; layer < screen->layers; layer++) {
            uint8_t *texels = mip_layer(screen, k, layer);
            size_t   count = mip_level_bytes(screen, k) / (size_t)screen->layers;
            for (size_t i = 0; i < count; i++)
                ink[i] = (uint16_t)(255 - texels[i]);
            ink_equalise(texels, ink, count, tones);
        }
    mem_free(ink);
    mem_free(tones);
    return enough ? LMN_OK : error_memory(error);
}

double screen_ink(const mip_chain *screen, int level, double light, double gain, bool centred)
{
    const uint8_t *texels = mip_layer(screen, level, 0);
    size_t         count = mip_level_bytes(screen, level) / (size_t)screen->layers, tones[256] = {0};
    for (size_t i = 0; i < count; i++)
        tones[texels[i]]++;
    double sum = 0;
    for (int v = 0; v < 255; v++) {
        double below = 1 - v / 255.0 - light, ink;
        if (gain <= 0)
            ink = below >= -1e-9;
        else
            ink = fmax(0, fmin(1, gain * below + (centred ? 0.5 : 0)));
        sum += ink * (double)tones[v];
    }
    return sum / (double)count;
}

/* --- hatch map ------------------------------------------------------------------------------------------ */

lmn_status screen_hatch_map(mip_chain *out, int side, int spacing, bool centred, bool white_end, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    int least = centred ? 3 : 2;
    if (spacing < least || side < spacing || side % spacing || !is_power_of_two(side / spacing))
        return error_set(error, LMN_LIMIT,
                         "a hatch map of %d texels with lines %d apart; allowed are %d texels or more, and sides that "
                         "are 1, 2, 4, 8 … times as large",
                         side, spacing, least);
    lmn_status status = mip_chain_create(out, 1, side, 1, 0, MIP_R8, error);
    if (status != LMN_OK)
        return status;
    int     wide = centred ? 2 : 1;
    uint8_t grey = (uint8_t)((255 * (spacing - wide) + spacing / 2) / spacing);
    for (int k = 0; k < out->levels; k++) {
        int      rows = mip_height(out, k);
        uint8_t *texels = out->data[k];
        bool     lines = rows >= spacing;
        memset(texels, lines || white_end ? 255 : grey, (size_t)rows);
        for (int y = 0; lines && y < rows; y += spacing) {
            texels[y] = 0;
            if (centred)
                texels[(y + rows - 1) % rows] = 0;
        }
    }
    return LMN_OK;
}
