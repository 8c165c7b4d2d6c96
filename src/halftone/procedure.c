/* Screens that need no strokes: engraved lines, clustered dots, Bayer's matrix and blue noise. A small tile is made
 * per level and repeated. */
#include "halftone/screen_private.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

const char *const screen_procedure_names[PROCEDURE_COUNT + 1] = {"lines", "dots", "ordered", "blue-noise", NULL};

enum {
    PERIOD_MOST = 256,
    WAVE = 128,      /* texels over which an engraved line sways by one texel */
    WAVE_APART = 79, /* and from line to line */
    DOT_TILE = 64,   /* texels over which clustered dots take turns in growing */
    BLUE_TILE = 64,
    FINE = 1 << 16 /* fixed point */
};

/* --- order ---------------------------------------------------------------------------------------------- */

typedef struct placed {
    uint64_t key; /* the lowest is inked first */
    uint32_t index;
} placed;

static int by_key(const void *a, const void *b)
{
    const placed *left = a, *right = b;
    if (left->key != right->key)
        return left->key < right->key ? -1 : 1;
    return left->index < right->index ? -1 : left->index > right->index;
}

/* A rank's value; rounded up as ink_equalise does, so that full light leaves no ink. */
static uint8_t value_of_rank(uint64_t rank, uint64_t count)
{
    uint64_t value = (255 * (2 * rank + 1) + 2 * count - 1) / (2 * count);
    return (uint8_t)(value > 254 ? 254 : value);
}

uint32_t bayer_rank(uint32_t x, uint32_t y, int side)
{
    /* The finest distinction counts most: neighbours are far apart in the order. */
    uint32_t rank = 0;
    for (uint32_t half = 1; half < (uint32_t)side; half *= 2) {
        uint32_t right = (x & half) != 0, up = (y & half) != 0;
        rank = rank * 4 + ((right ^ up) * 2 + up);
    }
    return rank;
}

/* --- spots ---------------------------------------------------------------------------------------------- */

/* Distance of a lattice position to the next multiple of `period`, as a fraction of half a period, 0 … FINE. */
static int64_t fraction_of_half(int64_t at, int64_t period)
{
    int64_t rest = ((at % period) + period) % period;
    return FINE * (rest * 2 < period ? rest * 2 : (period - rest) * 2) / period;
}

/* A cosine over half a turn by two parabolas: 1 … −1 for 0 … FINE, times FINE. Integers, so that it is the same
 * everywhere. */
static int64_t near_cosine(int64_t turn)
{
    int64_t rest = FINE - turn;
    return turn * 2 <= FINE ? FINE - 4 * turn * turn / FINE : 4 * rest * rest / FINE - FINE;
}

/* Dots at (0, 0) and (P/2, P/2), holes between them; squares of both at half tone. The dots grow in turns, in
 * Bayer's order of the cells, so that there are as many tones as texels in the tile. */
static uint64_t dot_key(int x, int y, int period, int tile)
{
    int64_t a = near_cosine(fraction_of_half(2 * x + 1, 2 * period)),
            b = near_cosine(fraction_of_half(2 * y + 1, 2 * period));
    int64_t spot = (int64_t)FINE * FINE - a * b;
    /* Counted from between the dots, so that a dot is in one cell. */
    int      left = (x + period / 4) % tile, low = (y + period / 4) % tile;
    uint32_t turn = bayer_rank((uint32_t)(left * 2 / period), (uint32_t)(low * 2 / period), tile * 2 / period);
    uint32_t right = (uint32_t)(left * 4 / period) & 1, up = (uint32_t)(low * 4 / period) & 1,
             corner = (right ^ up) * 2 + up;
    return (uint64_t)spot << 24 | (uint64_t)(corner << 20) | turn;
}

/* How far a line's middle is off, in fractions of a texel times 2 × wave. Where it lay between texels, the tone would
 * go in steps of two rows. So lines sway by half a texel to both sides, each at other positions, or all would grow
 * wider in the same columns; and the few lines of small levels, which shall be straight, are off by different parts
 * of half a texel. */
static int64_t line_sway(int x, int line, int lines, int wave)
{
    int at = (x + line * WAVE_APART) % wave;
    if (lines < 8)
        return (2 * line + 1) * (int64_t)wave / (2 * lines);
    return at * 2 < wave ? 4 * at + 2 - wave : 4 * (wave - 1 - at) + 2 - wave;
}

static uint8_t line_value(int x, int y, int period, int side)
{
    int     wave = side < WAVE ? side : WAVE, lines = side / period;
    int64_t unit = (int64_t)2 * wave, off = line_sway(x, (y + period / 2) / period % lines, lines, wave);
    int64_t fraction = period > 1 ? fraction_of_half(unit * y + wave + off, unit * period) : FINE / 2;
    int64_t value = (255 * fraction + FINE - 1) / FINE;
    return (uint8_t)(value > 254 ? 254 : value < 1 ? 1 : value);
}

/* --- tiles ---------------------------------------------------------------------------------------------- */

static void repeat_tile(uint8_t *texels, int side, const uint8_t *tile, int tile_side)
{
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x += tile_side)
            memcpy(texels + (size_t)y * (size_t)side + (size_t)x, tile + (size_t)(y % tile_side) * (size_t)tile_side,
                   (size_t)tile_side);
}

static bool make_dots(uint8_t *tile, int period, int side)
{
    size_t  count = (size_t)side * (size_t)side;
    placed *order = mem_alloc(count * sizeof *order);
    if (!order)
        return false;
    for (size_t i = 0; i < count; i++)
        order[i] = (placed){dot_key((int)(i % (size_t)side), (int)(i / (size_t)side), period, side), (uint32_t)i};
    qsort(order, count, sizeof *order, by_key);
    for (size_t i = 0; i < count; i++)
        tile[order[i].index] = value_of_rank(i, count);
    mem_free(order);
    return true;
}

static void make_ordered(uint8_t *tile, int side)
{
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            tile[y * side + x] =
                value_of_rank(bayer_rank((uint32_t)x, (uint32_t)y, side), (uint64_t)side * (uint64_t)side);
}

static lmn_status make_blue_noise(uint8_t *tile, int side, lmn_error *error)
{
    size_t    count = (size_t)side * (size_t)side;
    uint32_t *ranks = mem_alloc(count * sizeof *ranks);
    if (!ranks)
        return error_memory(error);
    lmn_status status = blue_noise_ranks(ranks, side, error);
    for (size_t i = 0; status == LMN_OK && i < count; i++)
        tile[i] = value_of_rank(ranks[i], count);
    mem_free(ranks);
    return status;
}

static int tile_side(screen_procedure procedure, int period, int side)
{
    int wanted = procedure == PROCEDURE_LINES        ? side
                 : procedure == PROCEDURE_BLUE_NOISE ? BLUE_TILE
                 : procedure == PROCEDURE_ORDERED    ? period
                 : period > DOT_TILE                 ? period
                                                     : DOT_TILE;
    return wanted < side ? wanted : side;
}

/* A level that is narrower than a period has a narrower one, so that its tones are right as well. */
static lmn_status fill_level(uint8_t *texels, screen_procedure procedure, int side, int wanted, lmn_error *error)
{
    int period = wanted < side ? wanted : side, small = tile_side(procedure, period, side);
    if (procedure == PROCEDURE_LINES) {
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++)
                texels[(size_t)y * (size_t)side + (size_t)x] = line_value(x, y, period, side);
        return LMN_OK;
    }
    uint8_t *tile = mem_alloc((size_t)small * (size_t)small);
    if (!tile)
        return error_memory(error);
    lmn_status status = LMN_OK;
    if (procedure == PROCEDURE_BLUE_NOISE)
        status = make_blue_noise(tile, small, error);
    else if (procedure == PROCEDURE_ORDERED || period < 4)
        make_ordered(tile, small);
    else if (!make_dots(tile, period, small))
        status = error_memory(error);
    if (status == LMN_OK)
        repeat_tile(texels, side, tile, small);
    mem_free(tile);
    return status;
}

/* Levels of the same tile are made once. */
static bool same_tile(screen_procedure procedure, int side, int period, int level)
{
    int finer = side >> (level - 1), here = side >> level;
    return procedure != PROCEDURE_LINES && period <= here &&
           tile_side(procedure, period, finer) == tile_side(procedure, period, here);
}

lmn_status screen_of_procedure(mip_chain *out, screen_procedure procedure, int side, int period, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    if ((int)procedure < 0 || procedure >= PROCEDURE_COUNT)
        return error_set(error, LMN_USAGE, "no procedure of screens has the number %d", (int)procedure);
    if (!is_power_of_two(side) || !is_power_of_two(period) || period < 2 || period > PERIOD_MOST || side < period)
        return error_set(error, LMN_LIMIT,
                         "a screen of %d texels a side with a period of %d; both must be powers of two, the period 2 "
                         "to %d and within the side",
                         side, period, PERIOD_MOST);
    lmn_status status = mip_chain_create(out, side, side, 1, 0, MIP_R8, error);
    for (int k = 0; status == LMN_OK && k < out->levels; k++) {
        int here = side >> k;
        if (k > 0 && same_tile(procedure, side, period, k)) {
            for (int y = 0; y < here; y++) /* the lower left quarter of the finer level */
                memcpy((uint8_t *)out->data[k] + (size_t)y * (size_t)here,
                       (const uint8_t *)out->data[k - 1] + (size_t)y * (size_t)here * 2, (size_t)here);
            continue;
        }
        status = fill_level(out->data[k], procedure, here, period, error);
    }
    if (status != LMN_OK)
        mip_chain_release(out);
    return status;
}
