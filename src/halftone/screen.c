/* Screens, warp maps, normals and ink maps, all from one rasterised level: who owns a texel, and how strongly. */
#include "halftone/screen_private.h"
#include "stroke_texture/strokes_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

const char *const screen_detail_names[DETAIL_COUNT + 1] = {"kept", "minimum", "average", "nearest", NULL};

enum { SIDE_MOST = 4096, NOBODY = -1 };

static const double QUARTER_TURN = 0.78539816339744831; /* π / 4 */
/* Dots have room where a level is this many times as wide as they are. */
static const double DOT_ROOM = 4;

/* Strokes by light, the most important first. */
typedef struct ranked {
    float    light;
    uint32_t index;
} ranked;

/* What a stroke is besides its numbers: perhaps a chord of a curve, which counts as one stroke. */
typedef struct mark {
    stroke_brush brush;
    float        middle[2];    /* of the whole curve */
    bool         begins, ends; /* it is the first or last chord */
} mark;

/* One level at a time, from the finest on. */
typedef struct raster {
    const strokes        *strokes;
    const screen_options *options;
    double                width; /* with the strokes' own fraction */
    mark                 *marks;
    ranked               *order;
    size_t                count;
    double                longest;
    bool                  dots, flat; /* flat: priorities of light do not matter */
    int                   side;       /* of the level */
    uint16_t             *ink;
    int32_t              *owner;
    uint32_t             *tones;
    /* the stroke being drawn */
    float   strength;
    int32_t drawn;
} raster;

static bool is_dot(const texture_stroke *s)
{
    return s->u0 == s->u1 && s->v0 == s->v1;
}

static int by_light(const void *a, const void *b)
{
    const ranked *left = a, *right = b;
    if (left->light != right->light)
        return left->light > right->light ? -1 : 1;
    return left->index < right->index ? -1 : left->index > right->index;
}

static void raster_end(raster *r)
{
    mem_free(r->marks);
    mem_free(r->order);
    mem_free(r->ink);
    mem_free(r->owner);
    mem_free(r->tones);
}

static lmn_status check_options(const screen_options *w, lmn_error *error)
{
    if (!is_power_of_two(w->side) || w->side > SIDE_MOST)
        return error_set(error, LMN_LIMIT, "a screen of %d texels a side; allowed are powers of two up to %d", w->side,
                         SIDE_MOST);
    if (!(w->brush.width > 0) || !(w->brush.width <= w->side))
        return error_set(
            error, LMN_LIMIT,
            "strokes %g texels wide in a screen of %d texels a side; allowed are widths above 0 up to the side",
            w->brush.width, w->side);
    return LMN_OK;
}

/* The diagonal of what the chords `first` to `last` reach over: the length of a straight stroke, and how far a
 * curve goes that wanders. Chords may lie on different copies of the square, so that their ways are added. */
static double extent_of(const texture_stroke *items, size_t first, size_t last)
{
    double at[2] = {0, 0}, low[2] = {0, 0}, high[2] = {0, 0};
    for (size_t i = first; i <= last; i++) {
        at[0] += (double)items[i].u1 - (double)items[i].u0;
        at[1] += (double)items[i].v1 - (double)items[i].v0;
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], at[axis]);
            high[axis] = fmax(high[axis], at[axis]);
        }
    }
    double du = high[0] - low[0], dv = high[1] - low[1];
    return sqrt(du * du + dv * dv);
}

/* Marks of the chords `first` to `last`, which are one curve. */
static void mark_curve(raster *r, size_t first, size_t last)
{
    const texture_stroke *items = r->strokes->items;
    double                length = 0, before = 0;
    float                 middle[2] = {items[first].u0, items[first].v0};
    for (size_t i = first; i <= last; i++)
        length += stroke_length(&items[i]);
    for (size_t i = first; i <= last; i++) {
        const texture_stroke *s = &items[i];
        double                size = stroke_length(s), along = size > 0 ? (0.5 * length - before) / size : 0;
        if (along >= 0 && along <= 1) {
            middle[0] = (float)((double)s->u0 + along * ((double)s->u1 - (double)s->u0));
            middle[1] = (float)((double)s->v0 + along * ((double)s->v1 - (double)s->v0));
        }
        before += size;
    }
    for (size_t i = first; i <= last; i++)
        r->marks[i] =
            (mark){strokes_brush_at(r->strokes, i, &r->options->brush), {middle[0], middle[1]}, i == first, i == last};
}

static void mark_strokes(raster *r)
{
    const strokes *s = r->strokes;
    for (size_t first = 0, last; first < s->count; first = last + 1) {
        for (last = first; last + 1 < s->count && stroke_goes_on(&s->items[last], &s->items[last + 1]);)
            last++;
        double extent = extent_of(s->items, first, last);
        mark_curve(r, first, last);
        for (size_t i = first; i <= last; i++) {
            float light = s->items[i].light;
            if (r->flat ? light < 0 : !(light > 0))
                continue;
            r->order[r->count++] = (ranked){light, (uint32_t)i};
            r->longest = fmax(r->longest, extent);
            r->dots |= is_dot(&s->items[i]);
        }
    }
    qsort(r->order, r->count, sizeof *r->order, by_light);
}

static lmn_status raster_begin(raster *r, const strokes *s, const screen_options *w, bool flat, lmn_error *error)
{
    *r = (raster){.strokes = s, .options = w, .width = w->brush.width, .flat = flat, .side = w->side};
    lmn_status status = check_options(w, error);
    if (status != LMN_OK)
        return status;
    r->width *= s->width > 0 ? (double)s->width : 1;
    size_t texels = (size_t)w->side * (size_t)w->side;
    r->marks = mem_calloc(s->count, sizeof *r->marks);
    r->order = mem_calloc(s->count, sizeof *r->order);
    r->ink = mem_calloc(texels, sizeof *r->ink);
    r->owner = mem_calloc(texels, sizeof *r->owner);
    r->tones = mem_calloc(INK_TONES, sizeof *r->tones);
    if (!r->marks || !r->order || !r->ink || !r->owner || !r->tones) {
        raster_end(r);
        return error_memory(error);
    }
    mark_strokes(r);
    return LMN_OK;
}

static bool has_capacity(const raster *r, int level)
{
    if (r->options->levels > 0)
        return level < r->options->levels;
    double spacing = fmax(r->longest, r->dots ? 1 / DOT_ROOM : 0) * (r->options->side >> level);
    return level == 0 || spacing >= r->width;
}

/* Each level has a quarter of the texels and strokes half as long, so that half of them keep its tone. Dots stay as
 * large, and a quarter of them does. */
static bool is_kept(const texture_stroke *s, int level)
{
    int shift = is_dot(s) ? 2 * level : level;
    return shift >= 24 ? s->perspective >= 1 : (double)s->perspective >= 1 - 1.0 / (double)(1 << shift);
}

/* Round ends cover more of a coarse level than of the finest; strokes are shortened by the difference, so that what
 * is kept is as dark. The length is that of a piece of stroke which covers as much as both its ends, with the rims
 * that stroke_draw gives them. */
static double ends_as_length(double width)
{
    return QUARTER_TURN * (width < 1 ? 1 + width * width / 3 : width + 1 / (3 * width));
}

static texture_stroke fit_ends(const raster *r, size_t index, int level)
{
    texture_stroke out = r->strokes->items[index];
    const mark    *m = &r->marks[index];
    double         length = stroke_length(&out);
    if (m->brush.taper > 0 || length <= 0)
        return out;
    double excess = ends_as_length(m->brush.width) * ((double)(1 << level) - 1) / r->options->side;
    float  cut = (float)(0.5 * fmin(1, excess / length)), du = (out.u1 - out.u0) * cut, dv = (out.v1 - out.v0) * cut;
    if (m->begins) {
        out.u0 += du;
        out.v0 += dv;
    }
    if (m->ends) {
        out.u1 -= du;
        out.v1 -= dv;
    }
    return out;
}

/* The strongest owns a texel; of equal ones the first drawn. So a texel's value and its reference are of the same
 * stroke, and a stroke's light rim does not bite into the one below. */
static void own_texel(void *user, size_t index, float coverage)
{
    raster  *r = user;
    uint16_t ink = (uint16_t)(coverage * r->strength * (float)INK_MOST + 0.5f);
    if (r->owner[index] == NOBODY || ink > r->ink[index]) {
        r->ink[index] = ink;
        r->owner[index] = r->drawn;
    }
}

static void draw_level(raster *r, int level)
{
    size_t texels = (size_t)r->side * (size_t)r->side;
    memset(r->ink, 0, texels * sizeof *r->ink);
    memset(r->owner, 0xff, texels * sizeof *r->owner);
    for (size_t i = 0; i < r->count && has_capacity(r, level); i++) {
        uint32_t              index = r->order[i].index;
        const texture_stroke *s = &r->strokes->items[index];
        if (!is_kept(s, level))
            continue;
        texture_stroke fitted = fit_ends(r, index, level);
        r->drawn = (int32_t)index;
        r->strength = r->flat || s->light > 1 ? 1 : s->light;
        stroke_draw(&fitted, r->side, &r->marks[index].brush, own_texel, r);
    }
}

/* In place: each texel is written where all that is read later lies behind it. */
static void reduce_level(raster *r, screen_detail detail)
{
    int half = r->side / 2;
    for (int y = 0; y < half; y++)
        for (int x = 0; x < half; x++) {
            size_t   at = (size_t)(2 * y) * (size_t)r->side + (size_t)(2 * x), darkest = at;
            uint32_t sum = 0;
            for (size_t i = 0; i < 4; i++) {
                size_t parent = at + (i & 1) + (i >> 1) * (size_t)r->side;
                sum += r->ink[parent];
                if (detail != DETAIL_NEAREST && r->owner[parent] != NOBODY &&
                    (r->owner[darkest] == NOBODY || r->ink[parent] > r->ink[darkest]))
                    darkest = parent;
            }
            size_t  to = (size_t)y * (size_t)half + (size_t)x;
            int32_t owner = r->owner[darkest];
            r->ink[to] = detail == DETAIL_AVERAGE ? (uint16_t)((sum + 2) / 4) : r->ink[darkest];
            r->owner[to] = owner;
        }
    r->side = half;
}

/* Levels must be asked for in order. */
static void raster_level(raster *r, int level)
{
    if (level == 0 || r->options->detail == DETAIL_KEPT) {
        r->side = r->options->side >> level;
        draw_level(r, level);
    } else {
        reduce_level(r, r->options->detail);
    }
}

/* Fills one level of a chain from the raster. */
typedef void (*fill_fn)(const raster *r, int level, void *texels, double user);

static lmn_status fill_levels(mip_chain *out, raster *r, mip_format format, fill_fn fill, double user, lmn_error *error)
{
    lmn_status status = mip_chain_create(out, r->options->side, r->options->side, 1, 0, format, error);
    for (int k = 0; status == LMN_OK && k < out->levels; k++) {
        raster_level(r, k);
        fill(r, k, out->data[k], user);
    }
    raster_end(r);
    return status;
}

void ink_encode(uint8_t *out, const uint16_t *ink, size_t count)
{
    for (size_t i = 0; i < count; i++)
        out[i] = (uint8_t)(255 - (ink[i] * 255u + INK_MOST / 2) / INK_MOST);
}

static void fill_values(const raster *r, int level, void *texels, double user)
{
    (void)level, (void)user;
    size_t count = (size_t)r->side * (size_t)r->side;
    if (r->options->equalised && !r->flat)
        ink_equalise(texels, r->ink, count, r->tones);
    else
        ink_encode(texels, r->ink, count);
}

lmn_status screen_of_strokes(mip_chain *out, const strokes *s, const screen_options *options, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    raster     r;
    lmn_status status = raster_begin(&r, s, options, false, error);
    return status == LMN_OK ? fill_levels(out, &r, MIP_R8, fill_values, 0, error) : status;
}

lmn_status screen_ink_map(mip_chain *out, const strokes *s, const screen_options *options, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    raster     r;
    lmn_status status = raster_begin(&r, s, options, true, error);
    return status == LMN_OK ? fill_levels(out, &r, MIP_R8, fill_values, 0, error) : status;
}

/* The shortest way around the border. */
static double around(double offset)
{
    return offset - floor(offset + 0.5);
}

static void fill_warp(const raster *r, int level, void *texels, double user)
{
    (void)level, (void)user;
    float *to = texels;
    for (int y = 0; y < r->side; y++)
        for (int x = 0; x < r->side; x++, to += 2) {
            int32_t owner = r->owner[(size_t)y * (size_t)r->side + (size_t)x];
            if (owner == NOBODY)
                continue;
            const float *middle = r->marks[owner].middle;
            to[0] = (float)around((double)middle[0] - (x + 0.5) / r->side);
            to[1] = (float)around((double)middle[1] - (y + 0.5) / r->side);
        }
}

lmn_status screen_warp(mip_chain *out, const strokes *s, const screen_options *options, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    raster     r;
    lmn_status status = raster_begin(&r, s, options, false, error);
    if (status == LMN_OK)
        status = fill_levels(out, &r, MIP_RG16F, fill_warp, 0, error);
    out->nearest = true;
    return status;
}

/* From a position to the nearest point of a stroke's axis, whichever copy that is on. */
static void to_axis(const texture_stroke *s, double u, double v, double offset[2])
{
    double du = (double)s->u1 - (double)s->u0, dv = (double)s->v1 - (double)s->v0, size = du * du + dv * dv,
           best = INFINITY;
    int reach_u = (int)ceil(fabs(du)) + 1, reach_v = (int)ceil(fabs(dv)) + 1;
    for (int j = -reach_v; j <= reach_v; j++)
        for (int i = -reach_u; i <= reach_u; i++) {
            double pu = u + i - (double)s->u0, pv = v + j - (double)s->v0;
            double along = size > 0 ? fmax(0, fmin(1, (pu * du + pv * dv) / size)) : 0;
            double wu = along * du - pu, wv = along * dv - pv, distance = wu * wu + wv * wv;
            if (distance < best) {
                best = distance;
                offset[0] = wu;
                offset[1] = wv;
            }
        }
}

/* A groove whose section is a parabola: level at the axis, steepest at the border. */
static void fill_normals(const raster *r, int level, void *texels, double steep)
{
    uint8_t *to = texels;
    double   half = 0.5 * r->width / r->side;
    for (int y = 0; y < r->side; y++)
        for (int x = 0; x < r->side; x++, to += 2) {
            int32_t owner = r->owner[(size_t)y * (size_t)r->side + (size_t)x];
            double  offset[2] = {0, 0};
            if (owner != NOBODY) {
                texture_stroke s = fit_ends(r, (size_t)owner, r->options->detail == DETAIL_KEPT ? level : 0);
                to_axis(&s, (x + 0.5) / r->side, (y + 0.5) / r->side, offset);
            }
            double distance = sqrt(offset[0] * offset[0] + offset[1] * offset[1]);
            double slope = distance > 0 ? steep * fmin(1, distance / half) / distance : 0;
            double nu = offset[0] * slope, nv = offset[1] * slope, unit = 1 / sqrt(1 + nu * nu + nv * nv);
            to[0] = (uint8_t)(128.5 + 127 * nu * unit);
            to[1] = (uint8_t)(128.5 + 127 * nv * unit);
        }
}

lmn_status screen_normals(mip_chain *out, const strokes *s, const screen_options *options, double steep,
                          lmn_error *error)
{
    memset(out, 0, sizeof *out);
    raster     r;
    lmn_status status = raster_begin(&r, s, options, false, error);
    return status == LMN_OK ? fill_levels(out, &r, MIP_RG8, fill_normals, steep, error) : status;
}
