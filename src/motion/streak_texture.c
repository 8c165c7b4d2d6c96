#include "motion/streak_texture.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "fence/image_read.h"

/* Of a made texture. Its caps are as long as it is high, halved, so that they are round where they are not stretched.
 */
enum { MADE_WIDTH = 256, MADE_HEIGHT = 64 };
static const double CAP = 0.15, BORDER = 0.3, CLEAR = 0.45, BORDER_TONE = 0.25;

typedef enum streak_fill { FILL_SOLID, FILL_CLEAR, FILL_GRADIENT, FILL_COUNT } streak_fill;
static const char *const names[FILL_COUNT] = {"solid", "clear", "gradient"};

/* Which fill, and whether it has a border; false: neither. */
static bool find_name(const char *name, streak_fill *fill, bool *border)
{
    size_t length = strcspn(name, "-");
    *border = strcmp(name + length, "-border") == 0;
    if (name[length] && !*border)
        return false;
    for (int i = 0; i < FILL_COUNT; i++)
        if (strlen(names[i]) == length && memcmp(names[i], name, length) == 0) {
            *fill = (streak_fill)i;
            return true;
        }
    return false;
}

lmn_status streak_texture_check(const char *name, lmn_error *error)
{
    streak_fill fill;
    bool        border;
    if (!name[0] || find_name(name, &fill, &border) || image_is_named(name))
        return LMN_OK;
    error_set(error, LMN_USAGE, "texture is '%.100s'; allowed is a texture of streaks, or a picture", name);
    error_hint(error, "solid, clear, gradient, solid-border, clear-border, gradient-border, or a picture (.png, .jpg, "
                      ".webp) from tail to head");
    return LMN_USAGE;
}

/* How far inside of the rim, half heights: 1 on the axis, 0 at the rim, below 0 outside. */
static double inside_of(double u, double v)
{
    double along = u < CAP ? (CAP - u) / CAP : u > 1 - CAP ? (u - 1 + CAP) / CAP : 0;
    return 1 - hypot(along, 2 * v - 1);
}

static void draw_made(mip_chain *chain, streak_fill fill, bool border)
{
    uint8_t *texel = mip_layer(chain, 0, 0);
    for (int y = 0; y < MADE_HEIGHT; y++)
        for (int x = 0; x < MADE_WIDTH; x++, texel += 2) {
            double u = (x + 0.5) / MADE_WIDTH, v = (y + 0.5) / MADE_HEIGHT, inside = inside_of(u, v);
            double rim = fmin(fmax(inside * MADE_HEIGHT / 4 + 0.5, 0), 1);
            double edge = border ? fmin(fmax((BORDER - inside) * MADE_HEIGHT / 4 + 0.5, 0), 1) : 0;
            double opacity = fill == FILL_CLEAR ? CLEAR : fill == FILL_GRADIENT ? u : 1;
            opacity += (1 - opacity) * edge * (fill == FILL_GRADIENT ? u : 1);
            texel[0] = (uint8_t)lrint(255 * (1 - edge * (1 - BORDER_TONE)));
            texel[1] = (uint8_t)lrint(255 * opacity * rim);
        }
}

/* Each level half of the one before; lightness counts where something is. */
static void fill_levels(mip_chain *chain)
{
    for (int level = 1; level < chain->levels; level++) {
        const uint8_t *from = mip_layer(chain, level - 1, 0);
        uint8_t       *to = mip_layer(chain, level, 0);
        int            width = mip_width(chain, level - 1), height = mip_height(chain, level - 1);
        for (int y = 0; y < mip_height(chain, level); y++)
            for (int x = 0; x < mip_width(chain, level); x++, to += 2) {
                unsigned tone = 0, opacity = 0, plain = 0;
                for (int k = 0; k < 4; k++) {
                    int            column = 2 * x + (k & 1), row = 2 * y + (k >> 1);
                    const uint8_t *texel =
                        from + 2 * ((row < height ? row : height - 1) * width + (column < width ? column : width - 1));
                    tone += (unsigned)texel[0] * texel[1];
                    opacity += texel[1];
                    plain += texel[0];
                }
                to[0] = (uint8_t)(opacity ? (tone + opacity / 2) / opacity : (plain + 2) / 4);
                to[1] = (uint8_t)((opacity + 2) / 4);
            }
    }
}

static lmn_status load_picture(mip_chain *out, const char *path, lmn_error *error)
{
    image_pixels picture;
    lmn_status   status = image_load(&picture, path, error);
    if (status == LMN_OK)
        status = mip_chain_create(out, (int)picture.width, (int)picture.height, 1, 0, MIP_RG8, error);
    for (uint32_t y = 0; status == LMN_OK && y < picture.height; y++) {
        const uint8_t *from = picture.rgba + 4 * (size_t)(picture.height - 1 - y) * picture.width;
        uint8_t       *to = (uint8_t *)mip_layer(out, 0, 0) + 2 * (size_t)y * picture.width;
        for (uint32_t x = 0; x < picture.width; x++, from += 4, to += 2) {
            to[0] = image_luma(from);
            to[1] = from[3];
        }
    }
    mem_free(picture.rgba);
    return status;
}

lmn_status streak_texture_make(mip_chain *out, const char *name, lmn_error *error)
{
    streak_fill fill = FILL_GRADIENT;
    bool        border = false, made = !name[0] || find_name(name, &fill, &border);
    lmn_status  status =
        made ? mip_chain_create(out, MADE_WIDTH, MADE_HEIGHT, 1, 0, MIP_RG8, error) : load_picture(out, name, error);
    if (status != LMN_OK)
        return status;
    if (made)
        draw_made(out, fill, border);
    fill_levels(out);
    out->clamped = true;
    return LMN_OK;
}

/* --- masks ---------------------------------------------------------------------------------------------- */

lmn_status streak_mask_check(const char *name, lmn_error *error)
{
    if (!name[0] || strcmp(name, "checker") == 0 || image_is_named(name))
        return LMN_OK;
    error_set(error, LMN_USAGE, "mask is '%.100s'; allowed is checker, or a picture", name);
    error_hint(error, "pictures end in .png, .jpg or .webp");
    return LMN_USAGE;
}

lmn_status streak_mask_make(mip_chain *out, const char *name, lmn_error *error)
{
    enum { SQUARES = 8 };
    if (strcmp(name, "checker") != 0) {
        lmn_status status = load_picture(out, name, error);
        if (status == LMN_OK)
            fill_levels(out);
        return status;
    }
    lmn_status status = mip_chain_create(out, SQUARES, SQUARES, 1, 1, MIP_RG8, error);
    for (int i = 0; status == LMN_OK && i < SQUARES * SQUARES; i++) {
        uint8_t *texel = (uint8_t *)mip_layer(out, 0, 0) + 2 * i;
        texel[0] = (i + i / SQUARES) % 2 ? 255 : 0;
        texel[1] = 255;
    }
    out->nearest = true;
    return status;
}
