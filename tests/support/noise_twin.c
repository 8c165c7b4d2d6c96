#include "noise_twin.h"

#include <math.h>
#include <stddef.h>

static const double shift[3] = {0.4331, 0.2719, 0.6173};

static uint32_t hash_of(const uint32_t v[3], uint32_t seed)
{
    uint32_t hash = v[0] * 0x9e3779b1u ^ v[1] * 0x85ebca77u ^ v[2] * 0xc2b2ae3du ^ seed;
    hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
    return hash ^ (hash >> 15);
}

/* Weighted gradients of the corners of a cell, in `dimensions` dimensions: a component's gradient along each axis is
 * one of eight values, −1 … 1. */
static void add_noise(const double position[3], int dimensions, int period, uint32_t seed, double weight,
                      bool turbulence, double sum[3])
{
    double inside[3] = {0}, here[3] = {0};
    int    first[3] = {0};
    for (int k = 0; k < dimensions; k++) {
        double at = position[k] + shift[k] * (1 + (seed & 7));
        first[k] = (int)floor(at);
        inside[k] = at - floor(at);
    }
    for (int corner = 0; corner < 1 << dimensions; corner++) {
        double   fraction = 1;
        uint32_t lattice[3] = {0};
        for (int k = 0; k < dimensions; k++) {
            int    far = corner >> k & 1, index = first[k] + far;
            double t = inside[k], fade = 6 * pow(t, 5) - 15 * pow(t, 4) + 10 * pow(t, 3);
            fraction *= far ? fade : 1 - fade;
            lattice[k] = (uint32_t)(period ? (index % period + period) % period : index);
        }
        uint32_t hash = hash_of(lattice, seed);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < dimensions; k++)
                here[c] += fraction * ((hash >> (9 * c + 3 * k) & 7) / 3.5 - 1) * (inside[k] - (corner >> k & 1));
    }
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (turbulence ? fabs(here[c]) : here[c]);
}

/* The sum's mean taken off, as strong as one octave, and bent into −1 … 1. */
static void finish(const noise_field *f, double weights, double squares, double out[3])
{
    for (int c = 0; c < 3; c++) {
        double v = f->turbulence ? 1.6 * (out[c] - 0.157 * weights) : out[c];
        v *= f->gain / sqrt(squares);
        out[c] = v / sqrt(1 + v * v);
    }
}

static void octaves_of(const noise_field *f, const double *position, int dimensions, double out[3])
{
    double weights = 0, squares = 0;
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < f->octaves; i++) {
        double at[3] = {0}, weight = pow(0.5, i);
        for (int k = 0; k < dimensions; k++)
            at[k] = position[k] / f->side * pow(2, i);
        add_noise(at, dimensions, f->period << i, f->seed + (uint32_t)i * 0x51ed270bu, weight, f->turbulence, out);
        weights += weight;
        squares += weight * weight;
    }
    finish(f, weights, squares, out);
}

void noise_in_plane(const noise_field *f, double x, double y, double out[3])
{
    octaves_of(f, (const double[]){x, y}, 2, out);
}

void noise_in_space(const noise_field *f, const double position[3], double out[3])
{
    octaves_of(f, position, 3, out);
}

void noise_along_ladder(const noise_field *f, double level, const double position[3], double out[3])
{
    double weights = 0, squares = 0;
    out[0] = out[1] = out[2] = 0;
    for (int octave = (int)floor(level) + 1; octave > level - f->octaves; octave--) {
        /* The longest fades out over the doubling of its length, the shortest in; between them half as strong at half
         * the length. */
        double above = octave - level, weight = above > 0 ? 1 - above : pow(2, above);
        weight *= above + f->octaves < 1 ? above + f->octaves : 1;
        double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = position[k] * pow(2, -octave);
        add_noise(at, 3, 0, f->seed + (uint32_t)(octave + 64) * 0x51ed270bu, weight, f->turbulence, out);
        weights += weight;
        squares += weight * weight;
    }
    finish(f, weights, squares, out);
}
