#include "halftone/paper.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"

const char *const paper_names[PAPER_COUNT + 1] = {"none", "smooth", "drawing", "rough", "laid", "canvas", NULL};

enum { SIDE = PAPER_SIDE, MASK = SIDE - 1, TEXELS = SIDE * SIDE, BINS = 1 << 14, REACH_MOST = 96, STREAM = 0x9a9e };

static const double PI = 3.14159265358979323846;

/* By paper: how much of its valleys stays out of reach, its steepest slopes' fraction of 45 degrees, and the deviation
 * in texels of its widest marks. */
static const struct {
    float  depth, steep;
    double widest;
} natures[PAPER_COUNT] = {
    [PAPER_SMOOTH] = {0.35f, 0.5f, 8}, [PAPER_DRAWING] = {0.65f, 0.9f, 10}, [PAPER_ROUGH] = {0.9f, 1.2f, 12},
    [PAPER_LAID] = {0.6f, 0.9f, 20},   [PAPER_CANVAS] = {0.65f, 1.1f, 20},
};

/* The stroke comes from the upper left, as a right hand draws; the window stands there too. */
static const float TOWARDS[2] = {-0.7071f, 0.7071f};
static const float FLANK = 0.45f; /* weight of the side that faces the stroke against the height */

/* --- fields --------------------------------------------------------------------------------------------- */

/* A field and room for one step of work on it. */
typedef struct bench {
    random_source random;
    float        *field, *other, *capacity;
} bench;

static void add_noise(bench *b, float *out)
{
    for (int i = 0; i < TEXELS; i++)
        out[i] = (float)random_signed(&b->random);
}

/* Adds a pair of lines, several positions at once: nothing of it is kept elsewhere. */
static void add_pair(float *restrict out, const float *restrict a, const float *restrict b, float weight)
{
    for (int i = 0; i < SIDE; i++)
        out[i] += weight * (a[i] + b[i]);
}

/* A line as the weighted sum of itself and of pairs of lines around it. */
static void sum_lines(float *out, const float *const *lines, const float *weights, int reach)
{
    for (int i = 0; i < SIDE; i++)
        out[i] = weights[0] * lines[0][i];
    for (int k = 1; k <= reach; k++)
        add_pair(out, lines[2 * k - 1], lines[2 * k], weights[k]);
}

/* Of a Gaussian's one side; returns how many count. */
static int fill_weights(float *weights, double deviation)
{
    int    reach = (int)fmin(ceil(3 * deviation), REACH_MOST);
    double sum = 0;
    for (int k = 0; k <= reach; k++) {
        double weight = exp(-0.5 * k * k / (deviation * deviation));
        weights[k] = (float)weight;
        sum += k ? 2 * weight : weight;
    }
    for (int k = 0; k <= reach; k++)
        weights[k] /= (float)sum;
    return reach;
}

static void blur_across(bench *b, float *field, double deviation)
{
    float        weights[REACH_MOST + 1], line[SIDE + 2 * REACH_MOST];
    const float *lines[2 * REACH_MOST + 1] = {line + REACH_MOST};
    int          reach = fill_weights(weights, deviation);
    for (int k = 1; k <= reach; k++) {
        lines[2 * k - 1] = line + REACH_MOST - k;
        lines[2 * k] = line + REACH_MOST + k;
    }
    for (int y = 0; y < SIDE; y++) {
        for (int i = 0; i < SIDE + 2 * REACH_MOST; i++)
            line[i] = field[y * SIDE + ((i - REACH_MOST) & MASK)];
        sum_lines(b->capacity + y * SIDE, lines, weights, reach);
    }
    memcpy(field, b->capacity, TEXELS * sizeof *field);
}

static void blur_up(bench *b, float *field, double deviation)
{
    float        weights[REACH_MOST + 1];
    const float *lines[2 * REACH_MOST + 1];
    int          reach = fill_weights(weights, deviation);
    for (int y = 0; y < SIDE; y++) {
        lines[0] = field + y * SIDE;
        for (int k = 1; k <= reach; k++) {
            lines[2 * k - 1] = field + ((y - k) & MASK) * SIDE;
            lines[2 * k] = field + ((y + k) & MASK) * SIDE;
        }
        sum_lines(b->capacity + y * SIDE, lines, weights, reach);
    }
    memcpy(field, b->capacity, TEXELS * sizeof *field);
}

/* A Gaussian around the corners, of a deviation for each axis in texels. */
static void blur(bench *b, float *field, double across, double up)
{
    blur_across(b, field, across);
    blur_up(b, field, up);
}

/* Mean 0, deviation 1. */
static void standardise(float *field)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < TEXELS; i++) {
        sum += (double)field[i];
        squares += (double)field[i] * (double)field[i];
    }
    double mean = sum / TEXELS, deviation = sqrt(fmax(squares / TEXELS - mean * mean, 1e-20));
    for (int i = 0; i < TEXELS; i++)
        field[i] = (float)(((double)field[i] - mean) / deviation);
}

/* Noise of lengths around one: what is finer and what is coarser is left out. */
static void band(bench *b, float *out, double fine, double coarse)
{
    add_noise(b, out);
    blur(b, out, fine, fine);
    memcpy(b->other, out, TEXELS * sizeof *out);
    double more = sqrt(coarse * coarse - fine * fine);
    blur(b, b->other, more, more);
    for (int i = 0; i < TEXELS; i++)
        out[i] -= b->other[i];
    standardise(out);
}

static void add_band(bench *b, float *scratch, double fine, double coarse, float weight)
{
    band(b, scratch, fine, coarse);
    for (int i = 0; i < TEXELS; i++)
        b->field[i] += weight * scratch[i];
}

/* Each value becomes the fraction of values below it. */
static bool flatten(float *field)
{
    float     low = field[0], high = field[0];
    uint32_t *below = mem_calloc(BINS + 1, sizeof *below);
    if (!below)
        return false;
    for (int i = 1; i < TEXELS; i++) {
        low = fminf(low, field[i]);
        high = fmaxf(high, field[i]);
    }
    float scale = high > low ? (float)(BINS - 1) / (high - low) : 0;
    for (int i = 0; i < TEXELS; i++)
        below[(int)((field[i] - low) * scale) + 1]++;
    for (int k = 0; k < BINS; k++)
        below[k + 1] += below[k];
    for (int i = 0; i < TEXELS; i++) {
        float at = (field[i] - low) * scale;
        int   bin = (int)at;
        field[i] = ((float)below[bin] + (at - (float)bin) * (float)(below[bin + 1] - below[bin])) / TEXELS;
    }
    mem_free(below);
    return true;
}

/* Takes out what is wider than a paper's own marks: from sheet to sheet it would be seen to come back. */
static void level(bench *b, double deviation)
{
    memcpy(b->other, b->field, TEXELS * sizeof *b->field);
    blur(b, b->other, deviation, deviation);
    for (int i = 0; i < TEXELS; i++)
        b->field[i] -= b->other[i];
}

/* --- papers --------------------------------------------------------------------------------------------- */

/* Fibres that lie on each other in all directions: thin ridges that bend a little. */
static void add_fibres(bench *b, float *scratch, int count, float weight)
{
    memset(scratch, 0, TEXELS * sizeof *scratch);
    for (int i = 0; i < count; i++) {
        double x = (1 + random_unit(&b->random)) * SIDE, y = (1 + random_unit(&b->random)) * SIDE,
               turn = random_unit(&b->random) * 2 * PI;
        double bend = 0.03 * random_hand(&b->random), height = 0.4 + 0.6 * random_unit(&b->random);
        int    steps = 30 + (int)random_below(&b->random, 60);
        for (int k = 0; k < steps; k++, turn += bend) {
            double end = fmin(fmin(k, steps - k) / 8.0, 1);
            scratch[((int)y & MASK) * SIDE + ((int)x & MASK)] += (float)(height * end);
            x += 0.7 * cos(turn);
            y += 0.7 * sin(turn);
        }
    }
    blur(b, scratch, 1.3, 1.3);
    standardise(scratch);
    for (int i = 0; i < TEXELS; i++)
        b->field[i] += weight * scratch[i];
}

static void make_smooth(bench *b, float *scratch)
{
    add_band(b, scratch, 1.5, 3, 1);
    add_fibres(b, scratch, 24000, 0.4f);
    add_band(b, scratch, 3, 6, 0.2f);
}

static void make_drawing(bench *b, float *scratch)
{
    add_band(b, scratch, 1.7, 3.6, 1);
    add_fibres(b, scratch, 14000, 0.45f);
    add_band(b, scratch, 4, 8, 0.3f);
}

/* The felt's marks: hills whose tops are broad and whose pits are narrow. */
static void make_rough(bench *b, float *scratch)
{
    band(b, b->field, 3.5, 7);
    for (int i = 0; i < TEXELS; i++)
        b->field[i] = 1 - expf(-0.9f * b->field[i]);
    standardise(b->field);
    add_band(b, scratch, 1.6, 3.2, 0.4f);
    add_band(b, scratch, 6, 12, 0.35f);
}

/* Ribs run along x; the wires were laid by hand. */
static void make_laid(bench *b, float *scratch)
{
    enum { RIBS = 96, CHAINS = 6 };
    float *strength = b->field; /* of ribs, which here and there were pressed flat */
    band(b, scratch, 5, 24);
    add_noise(b, strength);
    blur(b, strength, 14, 6);
    standardise(strength);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            int    i = y * SIDE + x;
            double aside = (double)x / SIDE * CHAINS,
                   chain = fabs(aside - floor(aside) - 0.5) * SIDE / CHAINS; /* texels to the nearest chain line */
            double rib = sin(2 * PI * RIBS * y / SIDE + 0.45 * (double)scratch[i]);
            strength[i] = (float)(rib * (0.9 + 0.12 * (double)strength[i]) - 1.1 * exp(-chain * chain / 30));
        }
    add_band(b, scratch, 1.6, 3.2, 0.5f);
    add_fibres(b, scratch, 10000, 0.3f);
}

/* A thread's round back at a position across it, from −1/2 to 1/2. */
static double back_of(double aside)
{
    return sqrt(fmax(1 - 3.6 * aside * aside, 0));
}

/* Which thread lies on top changes from crossing to crossing. */
static double weave_at(double x, double y, double width_x, double width_y)
{
    double column = floor(x), row = floor(y), over = sin(PI * y) * (fmod(column, 2) != 0 ? -1 : 1),
           under = sin(PI * x) * (fmod(row, 2) != 0 ? 1 : -1);
    double upright = back_of((x - column - 0.5) / width_x) + 0.5 * over,
           lying = back_of((y - row - 0.5) / width_y) + 0.5 * under;
    return fmax(upright, lying);
}

static void make_canvas(bench *b, float *scratch)
{
    enum { THREADS = 64 };
    double widths[2][THREADS];
    for (int i = 0; i < 2 * THREADS; i++)
        widths[i / THREADS][i % THREADS] = 1 + 0.12 * random_hand(&b->random);
    float *sway = b->field;
    add_noise(b, sway);
    blur(b, sway, 14, 14);
    standardise(sway);
    band(b, scratch, 12, 30);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            int    i = y * SIDE + x;
            double across = (double)x * THREADS / SIDE + 0.06 * (double)sway[i],
                   up = (double)y * THREADS / SIDE + 0.06 * (double)scratch[i];
            across -= floor(across / THREADS) * THREADS;
            up -= floor(up / THREADS) * THREADS;
            sway[i] = (float)weave_at(across, up, widths[0][(int)across % THREADS], widths[1][(int)up % THREADS]);
        }
    standardise(b->field);
    blur(b, b->field, 1, 1);
    add_band(b, scratch, 1.5, 3, 0.28f);
}

lmn_status paper_create(paper *out, paper_kind kind, uint32_t seed, lmn_error *error)
{
    static void (*const makers[PAPER_COUNT])(bench *, float *) = {
        [PAPER_SMOOTH] = make_smooth, [PAPER_DRAWING] = make_drawing, [PAPER_ROUGH] = make_rough,
        [PAPER_LAID] = make_laid,     [PAPER_CANVAS] = make_canvas,
    };
    *out = (paper){.kind = kind, .seed = seed};
    bench  b = {.random = random_start(seed, STREAM + (uint32_t)kind),
                .field = mem_calloc(TEXELS, sizeof(float)),
                .other = mem_alloc(TEXELS * sizeof(float)),
                .capacity = mem_alloc(TEXELS * sizeof(float))};
    float *scratch = mem_alloc(TEXELS * sizeof *scratch);
    bool   good = b.field && b.other && b.capacity && scratch;
    if (good) {
        makers[kind](&b, scratch);
        good = flatten(b.field);
        level(&b, natures[kind].widest);
        good = good && flatten(b.field);
    }
    mem_free(b.other);
    mem_free(b.capacity);
    mem_free(scratch);
    if (!good) {
        mem_free(b.field);
        return error_memory(error);
    }
    out->heights = b.field;
    return LMN_OK;
}

void paper_release(paper *p)
{
    mem_free(p->heights);
    p->heights = NULL;
}

/* --- what a pencil finds -------------------------------------------------------------------------------- */

void paper_normal(const paper *p, int x, int y, float out[3])
{
    const float *row = p->heights + (y & MASK) * SIDE, *above = p->heights + ((y + 1) & MASK) * SIDE,
                *below = p->heights + ((y - 1) & MASK) * SIDE;
    /* Of flat heights a grain rises from 0 to 1 in its half; that is `steep`. */
    float k = natures[p->kind].steep * PAPER_TEXELS_A_GRAIN;
    out[0] = -k * 0.5f * (row[(x + 1) & MASK] - row[(x - 1) & MASK]);
    out[1] = -k * 0.5f * (above[x & MASK] - below[x & MASK]);
    out[2] = 1;
    float length = sqrtf(out[0] * out[0] + out[1] * out[1] + 1);
    for (int i = 0; i < 3; i++)
        out[i] /= length;
}

lmn_status paper_texture(mip_chain *out, const paper *p, lmn_error *error)
{
    lmn_status status = mip_chain_create(out, SIDE, SIDE, 1, 1, MIP_RG8, error);
    float     *contact = mem_alloc(TEXELS * sizeof *contact);
    uint8_t   *texels = out->data[0];
    if (status == LMN_OK && !contact)
        status = error_memory(error);
    for (int i = 0; status == LMN_OK && i < TEXELS; i++) {
        float normal[3];
        paper_normal(p, i % SIDE, i / SIDE, normal);
        float facing = normal[0] * TOWARDS[0] + normal[1] * TOWARDS[1];
        contact[i] = p->heights[i] + FLANK * facing;
        texels[2 * i + 1] = (uint8_t)(fminf(fmaxf(0.5f + 0.5f * facing, 0), 1) * 255 + 0.5f);
    }
    if (status == LMN_OK && !flatten(contact))
        status = error_memory(error);
    for (int i = 0; status == LMN_OK && i < TEXELS; i++)
        texels[2 * i] = (uint8_t)fminf(contact[i] * 256, 255);
    out->fact = natures[p->kind].depth;
    mem_free(contact);
    if (status != LMN_OK)
        mip_chain_release(out);
    return status;
}
