#include "halftone/graphite.h"

#include <math.h>

#include "base/colour.h"
#include "base/memory.h"
#include "base/random.h"
#include "stroke_texture/strokes.h"

enum { OCTAVES = 4, CELLS = 8, STREAKS = 5200 };

const char *const lead_grade_names[LEAD_COUNT + 1] = {"6H", "5H", "4H", "3H", "2H", "H",  "F",  "HB", "B",
                                                      "2B", "3B", "4B", "5B", "6B", "7B", "8B", NULL};

/* Hard leads differ more from grade to grade than soft ones, which all come near to black. */
float lead_darkest(lead_grade grade)
{
    float soft = (float)grade / (float)(LEAD_COUNT - 1);
    return 0.36f + 0.59f * (1 - (1 - soft) * sqrtf(1 - soft));
}

/* --- clouds --------------------------------------------------------------------------------------------- */

/* Sixteen directions, so that nothing depends on a library's sine. */
static const double gradients[16][2] = {
    {1, 0},  {0.92, 0.38},   {0.71, 0.71},   {0.38, 0.92},   {0, 1},  {-0.38, 0.92}, {-0.71, 0.71}, {-0.92, 0.38},
    {-1, 0}, {-0.92, -0.38}, {-0.71, -0.71}, {-0.38, -0.92}, {0, -1}, {0.38, -0.92}, {0.71, -0.71}, {0.92, -0.38}};

static double slope_at(uint32_t seed, int x, int y, int cells, double right, double up)
{
    x = (x % cells + cells) % cells;
    y = (y % cells + cells) % cells;
    random_source r = random_start(seed, (uint32_t)(y * cells + x));
    const double *g = gradients[random_bits(&r) & 15];
    return g[0] * right + g[1] * up;
}

static double eased(double t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

/* Perlin's noise, which repeats after so many cells. */
static double noise_at(double x, double y, int cells, uint32_t seed)
{
    int    left = (int)floor(x), low = (int)floor(y);
    double right = x - left, up = y - low, across = eased(right);
    double below = slope_at(seed, left, low, cells, right, up),
           below_right = slope_at(seed, left + 1, low, cells, right - 1, up);
    double above = slope_at(seed, left, low + 1, cells, right, up - 1),
           above_right = slope_at(seed, left + 1, low + 1, cells, right - 1, up - 1);
    double lower = below + (below_right - below) * across, upper = above + (above_right - above) * across;
    return lower + (upper - lower) * eased(up);
}

static void fill_clouds(double *out, uint32_t seed)
{
    for (size_t i = 0; i < (size_t)GRAPHITE_SIDE * GRAPHITE_SIDE; i++) {
        double x = ((double)(i % GRAPHITE_SIDE) + 0.5) / GRAPHITE_SIDE,
               y = ((double)(i / GRAPHITE_SIDE) + 0.5) / GRAPHITE_SIDE;
        out[i] = 0;
        for (int k = 0; k < OCTAVES; k++)
            out[i] += ldexp(noise_at(ldexp(x * CELLS, k), ldexp(y * CELLS, k), CELLS << k, seed + (uint32_t)k), -k);
    }
}

/* --- streaks -------------------------------------------------------------------------------------------- */

static void darken(void *user, size_t index, float coverage)
{
    double *bare = user;
    bare[index] *= 1 - 0.16 * (double)coverage;
}

/* As a hand shades: all much in one direction. */
static void fill_streaks(double *out, uint32_t seed)
{
    for (size_t i = 0; i < (size_t)GRAPHITE_SIDE * GRAPHITE_SIDE; i++)
        out[i] = 1;
    random_source      r = random_start(seed, 7);
    const stroke_brush brush = {.width = 1.3, .taper = 0.4};
    for (int i = 0; i < STREAKS; i++) {
        double u = random_unit(&r), v = random_unit(&r), length = 0.03 + 0.08 * random_unit(&r),
               slope = 0.85 + 0.1 * random_hand(&r);
        double         along = length / sqrt(1 + slope * slope);
        texture_stroke s = {.u0 = (float)u, .v0 = (float)v, .u1 = (float)(u + along), .v1 = (float)(v + slope * along)};
        stroke_draw(&s, GRAPHITE_SIDE, &brush, darken, out);
    }
    for (size_t i = 0; i < (size_t)GRAPHITE_SIDE * GRAPHITE_SIDE; i++)
        out[i] = 1 - out[i];
}

/* The whole range from the least to the greatest value. */
static void store_channel(mip_chain *out, int channel, const double *values)
{
    uint8_t *bytes = mip_layer(out, 0, 0);
    double   least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < (size_t)GRAPHITE_SIDE * GRAPHITE_SIDE; i++) {
        least = fmin(least, values[i]);
        most = fmax(most, values[i]);
    }
    for (size_t i = 0; i < (size_t)GRAPHITE_SIDE * GRAPHITE_SIDE; i++)
        bytes[2 * i + (size_t)channel] = (uint8_t)lround(255 * (values[i] - least) / fmax(most - least, 1e-9));
}

lmn_status graphite_grain(mip_chain *out, uint32_t seed, lmn_error *error)
{
    lmn_status status = mip_chain_create(out, GRAPHITE_SIDE, GRAPHITE_SIDE, 1, 1, MIP_RG8, error);
    double    *values = mem_alloc((size_t)GRAPHITE_SIDE * GRAPHITE_SIDE * sizeof *values);
    if (status == LMN_OK && !values)
        status = error_memory(error);
    if (status == LMN_OK) {
        fill_clouds(values, seed);
        store_channel(out, 0, values);
        fill_streaks(values, seed);
        store_channel(out, 1, values);
    } else {
        mip_chain_release(out);
    }
    mem_free(values);
    return status;
}
