/* Blue noise by void and cluster (Ulichney 1993), in integers. Freudenberg 2003 names only "any generator of nested
 * tones" (section 6.3.1). */
#include "halftone/screen_private.h"

#include "base/memory.h"

enum { REACH = 7, KERNEL = 2 * REACH + 1 };

/* exp(−1 / (2 σ²)) for σ = 1.5; its powers are the kernel, by multiplication alone. */
static const double FALLOFF = 0.80073740291680804;

typedef struct dither {
    int       side;
    size_t    count;
    uint32_t  kernel[KERNEL * KERNEL];
    uint32_t *energy; /* how crowded a texel is */
    uint8_t  *on;
} dither;

static void fill_kernel(uint32_t *kernel)
{
    double powers[2 * REACH * REACH + 1] = {1};
    for (int i = 1; i <= 2 * REACH * REACH; i++)
        powers[i] = powers[i - 1] * FALLOFF;
    for (int y = -REACH; y <= REACH; y++)
        for (int x = -REACH; x <= REACH; x++)
            kernel[(y + REACH) * KERNEL + x + REACH] = (uint32_t)(powers[x * x + y * y] * (1 << 20));
}

static void turn(dither *d, size_t index, bool on)
{
    int side = d->side, mask = side - 1, column = (int)index & mask, row = (int)(index / (size_t)side);
    d->on[index] = on;
    for (int y = -REACH; y <= REACH; y++) {
        uint32_t       *energy = d->energy + (size_t)((row + y) & mask) * (size_t)side;
        const uint32_t *kernel = d->kernel + (y + REACH) * KERNEL + REACH;
        for (int x = -REACH; x <= REACH; x++)
            energy[(column + x) & mask] += on ? kernel[x] : 0 - kernel[x];
    }
}

/* The most crowded texel that is on, or the loneliest that is off. */
static size_t extreme(const dither *d, bool on)
{
    size_t best = d->count;
    for (size_t i = 0; i < d->count; i++) {
        if ((bool)d->on[i] != on)
            continue;
        if (best == d->count || (on ? d->energy[i] > d->energy[best] : d->energy[i] < d->energy[best]))
            best = i;
    }
    return best;
}

/* A tenth of the texels, anywhere, moved until no cluster is tighter than the widest void. */
static size_t scatter(dither *d)
{
    size_t   wanted = d->count / 10 > 0 ? d->count / 10 : 1, placed = 0;
    uint32_t state = 0x9e3779b9u;
    while (placed < wanted) {
        state = state * 1664525u + 1013904223u;
        size_t at = (size_t)(state >> 8) % d->count;
        if (d->on[at])
            continue;
        turn(d, at, true);
        placed++;
    }
    /* It settles long before; the bound keeps two equal positions from taking turns. */
    for (size_t i = 0; i < 4 * d->count; i++) {
        size_t cluster = extreme(d, true);
        turn(d, cluster, false);
        size_t gap = extreme(d, false);
        turn(d, gap, true);
        if (gap == cluster)
            break;
    }
    return wanted;
}

static void rank_all(uint32_t *ranks, dither *d)
{
    size_t placed = scatter(d);
    /* Backwards from the pattern, then forwards. */
    for (size_t rank = placed; rank-- > 0;) {
        size_t cluster = extreme(d, true);
        ranks[cluster] = (uint32_t)rank;
        turn(d, cluster, false);
    }
    for (size_t i = 0; i < d->count; i++)
        if (ranks[i] < placed)
            turn(d, i, true);
    /* Ulichney's last phase fills the tightest cluster of what is off. What is on and what is off add up to the
     * same everywhere, so that this is again the loneliest texel. */
    for (size_t rank = placed; rank < d->count; rank++) {
        size_t gap = extreme(d, false);
        ranks[gap] = (uint32_t)rank;
        turn(d, gap, true);
    }
}

lmn_status blue_noise_ranks(uint32_t *ranks, int side, lmn_error *error)
{
    dither d = {.side = side, .count = (size_t)side * (size_t)side};
    fill_kernel(d.kernel);
    for (size_t i = 0; i < d.count; i++)
        ranks[i] = UINT32_MAX;
    d.energy = mem_calloc(d.count, sizeof *d.energy);
    d.on = mem_calloc(d.count, 1);
    bool enough = d.energy && d.on;
    if (enough)
        rank_all(ranks, &d);
    mem_free(d.energy);
    mem_free(d.on);
    return enough ? LMN_OK : error_memory(error);
}
