/* Screens that were painted, in layers: Freudenberg 2003, section 6.3.2. */
#include "halftone/screen_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"

enum { SIDE_MOST = 4096, LAYERS_MOST = 64, PATCH = 8 };

static const double MUCH = 1.15; /* times the ink of level 0 that a level may have before texels are taken away */

/* --- pictures ------------------------------------------------------------------------------------------- */

/* The luminance of a pixel over white, as it is coded: the painter's grey is the threshold. 0 … 1, by the weights
 * of Rec. 709. */
static float luminance(const uint8_t *pixel)
{
    float over = (float)pixel[3] / 255,
          light = 0.2126f * (float)pixel[0] + 0.7152f * (float)pixel[1] + 0.0722f * (float)pixel[2];
    return over * light / 255 + (1 - over);
}

/* One axis of resampling: a texel's span of pixels when there are more pixels, else the two pixels around its
 * middle. */
typedef struct span {
    int   first, count;
    float lead, tail; /* weights of the first and last pixel; those between count whole */
} span;

static span span_of(int texel, int side, int pixels)
{
    double scale = (double)pixels / side;
    if (scale < 1) {
        double at = (texel + 0.5) * scale - 0.5, whole = floor(at);
        return (span){(int)whole, 2, (float)(1 - (at - whole)), (float)(at - whole)};
    }
    double from = texel * scale, to = (texel + 1) * scale;
    int    first = (int)from, last = (int)ceil(to);
    last = last > pixels ? pixels : last;
    span out = {first, last - first, (float)(first + 1 - from), (float)(to - (last - 1))};
    if (out.count == 1)
        out.lead = out.tail = 1;
    return out;
}

static float weight_of(const span *s, int i)
{
    return i == 0 ? s->lead : i == s->count - 1 ? s->tail : 1;
}

/* A texel's luminance; pictures repeat. */
static float sample_layer(const screen_layer *layer, const span *across, const span *down)
{
    int   size = (int)layer->width;
    float sum = 0, weights = 0;
    for (int j = 0; j < down->count; j++)
        for (int i = 0; i < across->count; i++) {
            int   x = (across->first + i + size) % size, y = (down->first + j + size) % size;
            float weight = weight_of(across, i) * weight_of(down, j);
            sum += weight * luminance(layer->rgba + 4 * ((size_t)y * (size_t)size + (size_t)x));
            weights += weight;
        }
    return sum / weights;
}

/* Darker of what is there and the layer, which is compressed to ground … 1. For opaque strokes that is the same as
 * painting layers over each other, the last first. */
static void add_layer(uint16_t *ink, int side, const screen_layer *layer, double ground)
{
    int size = (int)layer->width;
    for (int y = 0; y < side; y++) {
        span down = span_of(side - 1 - y, side, size); /* pictures have row 0 on top */
        for (int x = 0; x < side; x++) {
            span     across = span_of(x, side, size);
            double   dark = (1 - ground) * (1 - (double)sample_layer(layer, &across, &down));
            uint16_t value = (uint16_t)(dark * INK_MOST + 0.5);
            size_t   at = (size_t)y * (size_t)side + (size_t)x;
            if (value > ink[at])
                ink[at] = value;
        }
    }
}

/* --- levels --------------------------------------------------------------------------------------------- */

/* The mean of four parents, and the darkest. */
static void reduce(const uint16_t *finer, int half, uint16_t *mean, uint16_t *darkest)
{
    for (int y = 0; y < half; y++)
        for (int x = 0; x < half; x++) {
            const uint16_t *at = finer + (size_t)(2 * y) * (size_t)(2 * half) + (size_t)(2 * x);
            uint32_t        sum = 0, most = 0;
            for (int i = 0; i < 4; i++) {
                uint32_t ink = at[(size_t)(i & 1) + (size_t)(i >> 1) * (size_t)(2 * half)];
                sum += ink;
                most = ink > most ? ink : most;
            }
            size_t to = (size_t)y * (size_t)half + (size_t)x;
            mean[to] = (uint16_t)((sum + 2) / 4);
            darkest[to] = (uint16_t)most;
        }
}

typedef struct thinned {
    uint16_t darkest, mean;
    uint32_t patch; /* which stretch goes first */
    uint32_t index;
} thinned;

static int by_ink(const void *a, const void *b)
{
    const thinned *left = a, *right = b;
    if (left->darkest != right->darkest)
        return left->darkest > right->darkest ? -1 : 1;
    if (left->mean != right->mean)
        return left->mean > right->mean ? -1 : 1;
    if (left->patch != right->patch)
        return left->patch < right->patch ? -1 : 1;
    return left->index < right->index ? -1 : left->index > right->index;
}

/* The darkest of four is as wide as before and has about twice the ink. Where that does not come from many marks,
 * of which some can go, texels go: so that each tone has its fraction again, they get the values of the level 0 in
 * their order; of equally dark ones those around which there was more ink stay, and then those of some patches, so
 * that strokes end rather than fall apart. `up_to`: texels of level 0 that are at least as dark. */
static bool thin(uint16_t *ink, const uint16_t *mean, int side, const uint32_t *up_to, size_t whole)
{
    size_t   count = (size_t)side * (size_t)side;
    thinned *order = mem_alloc(count * sizeof *order);
    if (!order)
        return false;
    int patches = side >= PATCH ? side / PATCH : 1;
    for (size_t i = 0; i < count; i++) {
        uint32_t x = (uint32_t)(i % (size_t)side) / PATCH, y = (uint32_t)(i / (size_t)side) / PATCH;
        order[i] = (thinned){ink[i], mean[i], bayer_rank(x, y, patches), (uint32_t)i};
    }
    qsort(order, count, sizeof *order, by_ink);
    uint32_t tone = INK_MOST;
    for (size_t i = 0; i < count; i++) {
        uint64_t rank = (2 * (uint64_t)i + 1) * whole / (2 * count);
        while (tone > 0 && up_to[tone] <= rank)
            tone--;
        /* Never darker than the strokes that are there. */
        ink[order[i].index] = (uint16_t)(tone < order[i].darkest ? tone : order[i].darkest);
    }
    mem_free(order);
    return true;
}

typedef struct painting {
    uint16_t *ink, *mean, *next;
    uint32_t *up_to; /* texels of level 0 that are at least as dark */
} painting;

static bool painting_begin(painting *p, size_t texels)
{
    *p = (painting){mem_calloc(texels, sizeof *p->ink), mem_calloc(texels / 4 + 1, sizeof *p->mean),
                    mem_calloc(texels / 4 + 1, sizeof *p->next), mem_calloc(INK_TONES, sizeof *p->up_to)};
    return p->ink && p->mean && p->next && p->up_to;
}

static void painting_end(painting *p)
{
    mem_free(p->ink);
    mem_free(p->mean);
    mem_free(p->next);
    mem_free(p->up_to);
}

static void add_up(uint32_t *up_to, const uint16_t *ink, size_t count)
{
    for (size_t i = 0; i < count; i++)
        up_to[ink[i]]++;
    for (size_t t = INK_MOST; t-- > 0;)
        up_to[t] += up_to[t + 1];
}

static double mean_of(const uint16_t *ink, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += ink[i];
    return sum / INK_MOST / (double)count;
}

/* A coarser level with as much ink and lines as wide: first whole marks go, and where that is not enough, texels. */
static bool keep_detail(painting *p, screen_marks *m, int side, double fraction, size_t whole)
{
    size_t count = (size_t)side * (size_t)side;
    reduce(p->ink, side, p->mean, p->next);
    screen_marks_reduce(m, p->next, p->ink, side);
    screen_marks_thin(m, p->next, side, fraction);
    return mean_of(p->next, count) <= MUCH * fraction || thin(p->next, p->mean, side, p->up_to, whole);
}

static bool fill_painting(mip_chain *out, painting *p, screen_detail detail)
{
    size_t       whole = (size_t)out->width * (size_t)out->width;
    double       fraction = mean_of(p->ink, whole);
    screen_marks m = {0};
    bool         good = detail != DETAIL_KEPT || screen_marks_find(&m, p->ink, out->width);
    add_up(p->up_to, p->ink, whole);
    ink_encode(out->data[0], p->ink, whole);
    for (int k = 1; good && k < out->levels; k++) {
        int    side = mip_width(out, k);
        size_t count = (size_t)side * (size_t)side;
        if (detail == DETAIL_KEPT)
            good = keep_detail(p, &m, side, fraction, whole);
        else
            reduce(p->ink, side, p->mean, p->next);
        if (detail == DETAIL_NEAREST)
            for (size_t i = 0; i < count; i++) /* in place: what is read later lies behind */
                p->ink[i] = p->ink[2 * (i / (size_t)side) * (size_t)(2 * side) + 2 * (i % (size_t)side)];
        else
            memcpy(p->ink, detail == DETAIL_AVERAGE ? p->mean : p->next, count * sizeof *p->ink);
        ink_encode(out->data[k], p->ink, count);
    }
    screen_marks_release(&m);
    return good;
}

/* --- all of it ------------------------------------------------------------------------------------------ */

static lmn_status check(const screen_layer *layers, size_t count, double gain, int side, lmn_error *error)
{
    if (!is_power_of_two(side) || side > SIDE_MOST)
        return error_set(error, LMN_LIMIT, "a screen of %d texels a side; allowed are powers of two up to %d", side,
                         SIDE_MOST);
    if (count < 1 || count > LAYERS_MOST)
        return error_set(error, LMN_LIMIT, "a screen of %zu layers; allowed are 1 to %d", count, LAYERS_MOST);
    if (!(gain >= 1))
        return error_set(error, LMN_LIMIT, "a screen for the gain %g; it is 1 or more", gain);
    for (size_t i = 0; i < count; i++) {
        if (layers[i].width != layers[i].height || layers[i].width == 0)
            return error_set(error, LMN_FORMAT, "layer %zu of a screen has %u x %u pixels; layers must be square", i,
                             layers[i].width, layers[i].height);
        if (layers[i].width > LIMIT_IMAGE_SIDE)
            return error_set(error, LMN_LIMIT, "layer %zu of a screen is %u pixels wide; allowed are %d", i,
                             layers[i].width, LIMIT_IMAGE_SIDE);
    }
    return LMN_OK;
}

lmn_status screen_of_layers(mip_chain *out, const screen_layer *layers, size_t count, double gain, int side,
                            screen_detail detail, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    lmn_status status = check(layers, count, gain, side, error);
    if (status == LMN_OK)
        status = mip_chain_create(out, side, side, 1, 0, MIP_R8, error);
    if (status != LMN_OK)
        return status;
    painting p;
    bool     enough = painting_begin(&p, (size_t)side * (size_t)side);
    for (size_t i = 0; enough && i < count; i++)
        add_layer(p.ink, side, &layers[i], count > 1 ? (1 - 1 / gain) * (double)i / (double)(count - 1) : 0);
    enough = enough && fill_painting(out, &p, detail);
    painting_end(&p);
    if (enough)
        return LMN_OK;
    mip_chain_release(out);
    return error_memory(error);
}

lmn_status screen_of_levels(mip_chain *out, const screen_layer *levels, size_t count, int side, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    lmn_status status = check(levels, count, 1, side, error);
    if (status == LMN_OK)
        status = mip_chain_create(out, side, side, 1, 0, MIP_R8, error);
    uint16_t *ink = status == LMN_OK ? mem_alloc((size_t)side * (size_t)side * sizeof *ink) : NULL;
    for (int k = 0; ink && k < out->levels; k++) {
        int    own = mip_width(out, k);
        size_t texels = (size_t)own * (size_t)own;
        memset(ink, 0, texels * sizeof *ink);
        if ((size_t)k < count)
            add_layer(ink, own, &levels[k], 0);
        ink_encode(out->data[k], ink, texels);
    }
    bool enough = ink != NULL;
    mem_free(ink);
    if (status != LMN_OK || enough)
        return status;
    mip_chain_release(out);
    return error_memory(error);
}

/* --- painted normals ------------------------------------------------------------------------------------ */

/* The mean of red or green where a texel is. */
static double mean_channel(const screen_layer *p, int side, int x, int y, size_t channel)
{
    size_t size = p->width, sides = (size_t)side, row = sides - 1 - (size_t)y;
    size_t left = (size_t)x * size / sides, right = ((size_t)x + 1) * size / sides, top = row * size / sides,
           bottom = (row + 1) * size / sides;
    double sum = 0;
    right = right > left ? right : left + 1;
    bottom = bottom > top ? bottom : top + 1;
    for (size_t i = top; i < bottom; i++)
        for (size_t k = left; k < right; k++)
            sum += p->rgba[4 * (i * size + k) + channel];
    return sum / (double)((right - left) * (bottom - top));
}

static uint8_t normal_byte(double component)
{
    return (uint8_t)(128.5 + 127 * component);
}

static void put_normal(uint8_t *to, double x, double y, double steep)
{
    double up = sqrt(fmax(1 - x * x - y * y, 0.0025)), u = x / up * steep, v = y / up * steep;
    double unit = 1 / sqrt(1 + u * u + v * v);
    to[0] = normal_byte(u * unit);
    to[1] = normal_byte(v * unit);
}

lmn_status screen_normals_of_picture(mip_chain *out, const screen_layer *picture, double steep, int side,
                                     lmn_error *error)
{
    memset(out, 0, sizeof *out);
    lmn_status status = check(picture, 1, 1, side, error);
    if (status == LMN_OK)
        status = mip_chain_create(out, side, side, 1, 0, MIP_RG8, error);
    for (int k = 0; status == LMN_OK && k < out->levels; k++) {
        int      own = mip_width(out, k);
        uint8_t *to = out->data[k];
        for (int i = 0; i < own * own; i++, to += 2)
            put_normal(to, (mean_channel(picture, own, i % own, i / own, 0) - 127.5) / 127.5,
                       (mean_channel(picture, own, i % own, i / own, 1) - 127.5) / 127.5, steep);
    }
    return status;
}
