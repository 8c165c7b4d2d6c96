#include "surface/indication.h"

#include <string.h>

#include "base/memory.h"
#include "base/store.h"
#include "fence/image_read.h"

enum { SIDE_MOST = 2048 };

static const char *const checker_name = "checker";

lmn_status indication_check(const char *name, lmn_error *error)
{
    if (image_is_named(name) || strcmp(name, checker_name) == 0)
        return LMN_OK;
    return error_set(error, LMN_USAGE,
                     "indication is '%.200s'; allowed are pictures (.png, .jpg, .webp) and the word checker", name);
}

void indication_describe(text *out, const char *name)
{
    text_append(out, "1 %s", name);
    if (image_is_named(name))
        text_append(out, " content=%016llx", (unsigned long long)store_hash_of_file(name));
}

/* Halves of a picture of greys, each the mean of four. */
static void average_levels(mip_chain *chain)
{
    for (int k = 1; k < chain->levels; k++) {
        const uint8_t *from = chain->data[k - 1];
        uint8_t       *to = chain->data[k];
        int            width = mip_width(chain, k - 1), height = mip_height(chain, k - 1);
        for (int y = 0; y < mip_height(chain, k); y++)
            for (int x = 0; x < mip_width(chain, k); x++) {
                int x0 = 2 * x < width ? 2 * x : width - 1, x1 = x0 + 1 < width ? x0 + 1 : x0;
                int y0 = 2 * y < height ? 2 * y : height - 1, y1 = y0 + 1 < height ? y0 + 1 : y0;
                int sum = from[y0 * width + x0] + from[y0 * width + x1] + from[y1 * width + x0] + from[y1 * width + x1];
                to[y * mip_width(chain, k) + x] = (uint8_t)((sum + 2) / 4);
            }
    }
}

/* Fields of 16 texels, three quarters and a quarter light. */
static lmn_status make_checker(mip_chain *out, lmn_error *error)
{
    enum { SIDE = 256, FIELD = 16 };
    lmn_status status = mip_chain_create(out, SIDE, SIDE, 1, 0, MIP_R8, error);
    if (status != LMN_OK)
        return status;
    for (int i = 0; i < SIDE * SIDE; i++)
        ((uint8_t *)out->data[0])[i] = (i / SIDE / FIELD + i % SIDE / FIELD) & 1 ? 192 : 64;
    average_levels(out);
    return LMN_OK;
}

lmn_status indication_make(mip_chain *out, const char *name, lmn_error *error)
{
    if (strcmp(name, checker_name) == 0)
        return make_checker(out, error);
    image_pixels pixels;
    lmn_status   status = image_load(&pixels, name, error);
    if (status != LMN_OK)
        return status;
    if (pixels.width > SIDE_MOST || pixels.height > SIDE_MOST)
        status = error_in_file(error, LMN_LIMIT, name, 0, "an indication of %u x %u pixels; allowed are %d a side",
                               pixels.width, pixels.height, SIDE_MOST);
    if (status == LMN_OK)
        status = mip_chain_create(out, (int)pixels.width, (int)pixels.height, 1, 0, MIP_R8, error);
    for (uint32_t y = 0; status == LMN_OK && y < pixels.height; y++)
        for (uint32_t x = 0; x < pixels.width; x++) {
            const uint8_t *from = &pixels.rgba[4 * ((size_t)y * pixels.width + x)];
            /* Row 0 is v = 0, as glTF counts. */
            ((uint8_t *)out->data[0])[(size_t)y * pixels.width + x] = image_luma(from);
        }
    if (status == LMN_OK)
        average_levels(out);
    mem_free(pixels.rgba);
    return status;
}
