/* Tonal art maps: tone after tone, each from its coarsest level to its finest, so that what is drawn goes on in all
 * that is darker or finer. */
#include "halftone/tonal_art_map_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke_texture/strokes_private.h"

const char *const tam_placement_names[TAM_PLACEMENT_COUNT + 1] = {"best-fit", "strips", NULL};

enum { SIDE_LEAST = 8, SIDE_MOST = 1024, TONES_LEAST = 2, TONES_MOST = 16, STREAM = 0x7a61 };

/* Both ends of a stroke run out over so many widths; what it covers less for that, by stroke_draw's profile, as a
 * fraction of an end. */
static const double CAP_WIDTHS = 6, CAP_LOSS = 1.0 / 3.0;

double tam_target(const tam_options *w, int tone)
{
    return w->darkest * (tone + 1) / w->tones;
}

static double mean_ink(const tam_level *level)
{
    return level->sum / ((double)level->side * level->side);
}

double tam_missing(const tam *t)
{
    return tam_target(t->options, t->tone) - mean_ink(&t->levels[t->level]);
}

double tam_expected(const tam *t, int level, double length)
{
    const tam_level *l = &t->levels[level];
    double           texels = length * l->side, covering = texels - 2 * CAP_LOSS * fmin(t->brush.cap, texels / 4);
    if (t->brush.image)
        covering = texels * stroke_image_mean(t->brush.image, &(stroke_extent){texels, t->brush.width});
    double area = covering * t->brush.width * stroke_grain_mean(t->brush.grain, texels);
    double full = mean_ink(l) / (double)t->limit,
           open = (double)t->limit * (1 - full * full); /* in gaps there is more left than in the mean */
    return area * (double)t->opacity * open / ((double)l->side * l->side);
}

/* --- drawing -------------------------------------------------------------------------------------------- */

typedef struct darkening {
    tam_level *level;
    float      limit, opacity;
} darkening;

/* Each stroke takes its fraction of what is left, so that overlaps darken less and less (Müller, section 3.2; row
 * P32), and never past the limit. */
static void darken(void *user, size_t index, float coverage)
{
    darkening *d = user;
    float     *ink = &d->level->ink[index], more = (d->limit - *ink) * coverage * d->opacity;
    *ink += more;
    d->level->sum += (double)more;
}

/* The priorities that make the stroke appear in its tone and down to its level. */
static bool keep(tam *t, texture_stroke s, int direction)
{
    if (!t->kept)
        return true;
    s.light = 1 - (float)t->tone / (float)t->options->tones;
    s.perspective = 1 - 0.75f / (float)(1 << t->level);
    if (!t->options->drawn)
        s.layer = direction;
    return strokes_add(t->kept, s);
}

bool tam_put(tam *t, texture_stroke s, int direction)
{
    for (int k = t->level; k >= 0; k--) {
        tam_level *level = &t->levels[k];
        darkening  d = {level, t->limit, t->opacity};
        level->count++;
        stroke_draw(&s, level->side, &t->brush, darken, &d);
        if (level->crowd[direction])
            tam_add_crowd(t, level, &s, direction);
    }
    t->drawn_length[direction] += stroke_length(&s);
    return keep(t, s, direction);
}

/* --- strokes that were drawn elsewhere ------------------------------------------------------------------ */

typedef struct ranked {
    float    light;
    uint32_t index;
} ranked;

static int by_light(const void *a, const void *b)
{
    const ranked *left = a, *right = b;
    if (left->light != right->light)
        return left->light > right->light ? -1 : 1;
    return left->index < right->index ? -1 : left->index > right->index;
}

/* Strokes in the order of their priorities; placed ones are taken out. */
typedef struct queue {
    ranked *items;
    size_t  count;
} queue;

static bool queue_fill(queue *q, const strokes *s)
{
    *q = (queue){mem_calloc(s->count, sizeof *q->items), 0};
    if (!q->items)
        return false;
    for (size_t i = 0; i < s->count; i++)
        if (s->items[i].light >= 0)
            q->items[q->count++] = (ranked){s->items[i].light, (uint32_t)i};
    qsort(q->items, q->count, sizeof *q->items, by_light);
    return true;
}

static bool near_enough(const texture_stroke *s, int level)
{
    return (double)s->perspective >= 1 - 1.0 / (double)(1 << level);
}

/* Length of a stroke, or of the curve that begins with it, with what its round ends cover. */
static double whole_length(const tam *t, size_t index)
{
    const strokes *s = t->options->drawn;
    double         length = stroke_length(&s->items[index]);
    for (size_t i = index; i + 1 < s->count && stroke_goes_on(&s->items[i], &s->items[i + 1]); i++)
        length += stroke_length(&s->items[i + 1]);
    return length + 0.8 * t->brush.width / t->levels[t->level].side;
}

/* Positions as many as the level being filled needs, or as there are; curves as a whole. */
static bool fill_drawn(tam *t, queue *q)
{
    const texture_stroke *items = t->options->drawn->items;
    size_t                left = 0, before = SIZE_MAX; /* the stroke that was placed last */
    for (size_t i = 0; i < q->count; i++) {
        size_t index = q->items[i].index;
        bool   goes_on = index > 0 && before == index - 1 && stroke_goes_on(&items[index - 1], &items[index]);
        if (!near_enough(&items[index], t->level) ||
            !(goes_on ||
              (tam_missing(t) > 0 && tam_missing(t) > 0.5 * tam_expected(t, t->level, whole_length(t, index))))) {
            q->items[left++] = q->items[i];
            continue;
        }
        before = index;
        if (!tam_put(t, items[index], TAM_ALONG))
            return false;
    }
    q->count = left;
    return true;
}

/* --- all of it ------------------------------------------------------------------------------------------ */

static lmn_status check(const tam_options *w, lmn_error *error)
{
    if (w->side < SIDE_LEAST || w->side > SIDE_MOST || (w->side & (w->side - 1)))
        return error_set(error, LMN_USAGE,
                         "a tonal art map of %d texels a side; allowed are powers of two from %d to %d", w->side,
                         SIDE_LEAST, SIDE_MOST);
    if (w->tones < TONES_LEAST || w->tones > TONES_MOST)
        return error_set(error, LMN_USAGE, "a tonal art map of %d tones; allowed are %d to %d", w->tones, TONES_LEAST,
                         TONES_MOST);
    if (!(w->darkest >= 0.05 && w->darkest <= 0.98))
        return error_set(error, LMN_USAGE, "the darkest tone of a tonal art map is %g; allowed are 0.05 to 0.98",
                         w->darkest);
    if (!(w->width >= 0.5 && w->width <= w->side / 4.0))
        return error_set(error, LMN_USAGE,
                         "strokes of a tonal art map are %g texels wide; allowed are 0.5 to a quarter of the side",
                         w->width);
    if (!w->drawn && !(w->length >= 0.05 && w->length <= 1))
        return error_set(error, LMN_USAGE, "strokes of a tonal art map are %g long; allowed are 0.05 to 1", w->length);
    if (!(w->opacity >= 0.1 && w->opacity <= 1))
        return error_set(error, LMN_USAGE, "strokes of a tonal art map have the opacity %g; allowed are 0.1 to 1",
                         w->opacity);
    if (!(w->grain >= 0 && w->grain <= 1))
        return error_set(error, LMN_USAGE, "strokes of a tonal art map have the grain %g; allowed are 0 to 1",
                         w->grain);
    if (!(w->uneven >= 0 && w->uneven <= 1) || (int)w->placement < 0 || w->placement >= TAM_PLACEMENT_COUNT)
        return error_set(error, LMN_USAGE, "a tonal art map cannot be uneven by %g, or placed by method %d",
                         (double)w->uneven, (int)w->placement);
    return LMN_OK;
}

static void tam_end(tam *t)
{
    for (int k = 0; k < t->level_count; k++) {
        mem_free(t->levels[k].ink);
        for (int d = 0; d < TAM_DIRECTIONS; d++)
            mem_free(t->levels[k].crowd[d]);
    }
    mem_free(t->crowding);
}

stroke_brush tonal_art_map_brush(const tam_options *w)
{
    stroke_brush out = {.width = w->width,
                        .cap = w->drawn || w->image ? 0 : CAP_WIDTHS * w->width,
                        .grain = w->grain,
                        .image = w->image};
    if (w->drawn && w->drawn->width > 0)
        out.width *= (double)w->drawn->width;
    return out;
}

static bool tam_begin(tam *t, const tam_options *w, strokes *kept)
{
    *t = (tam){.options = w,
               .brush = tonal_art_map_brush(w),
               .opacity = (float)w->opacity,
               .kept = kept,
               .random = random_start(w->seed, STREAM)};
    /* Ink covers paper; graphite leaves some of it even where many strokes lie. */
    t->limit = w->opacity < 1 ? (float)(0.5 + 0.5 * w->darkest) : 1;
    bool enough = true;
    for (int side = w->side; side >= SIDE_LEAST; side /= 2) {
        tam_level *level = &t->levels[t->level_count++];
        size_t     texels = (size_t)side * (size_t)side;
        level->side = side;
        level->ink = mem_calloc(texels, sizeof *level->ink);
        enough = enough && level->ink;
        for (int d = 0; !w->drawn && d < (w->cross ? 2 : 1); d++) {
            level->crowd[d] = mem_calloc(texels, sizeof *level->crowd[d]);
            enough = enough && level->crowd[d];
        }
    }
    return enough;
}

static void keep_tone(const tam *t, mip_chain *out)
{
    for (int k = 0; k < out->levels; k++) {
        uint8_t *texels = mip_layer(out, k, t->tone);
        size_t   count = mip_level_bytes(out, k) / (size_t)out->layers;
        if (k >= t->level_count)
            memset(texels, (int)(255.5 - 255 * tam_target(t->options, t->tone)), count);
        for (size_t i = 0; k < t->level_count && i < count; i++)
            texels[i] = (uint8_t)(255.5f - 255 * t->levels[k].ink[i]);
    }
}

static bool fill_tone(tam *t, queue *q)
{
    bool fitted = t->options->placement == TAM_BEST_FIT, good = t->options->drawn || tam_set_crowding(t);
    for (t->level = t->level_count - 1; good && t->level >= 0; t->level--)
        good = t->options->drawn ? fill_drawn(t, q) : fitted ? tam_fill_best(t) : tam_fill_strips(t);
    return good;
}

lmn_status tonal_art_map(mip_chain *out, strokes *kept, const tam_options *options, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    if (kept)
        *kept = (strokes){.width = 1};
    lmn_status status = check(options, error);
    if (status == LMN_OK)
        status = mip_chain_create(out, options->side, options->side, options->tones, 0, MIP_R8, error);
    if (status != LMN_OK)
        return status;
    tam   t;
    queue q = {NULL, 0};
    bool  good = tam_begin(&t, options, kept) && (!options->drawn || queue_fill(&q, options->drawn));
    for (t.tone = 0; good && t.tone < options->tones; t.tone++) {
        good = fill_tone(&t, &q);
        keep_tone(&t, out);
    }
    mem_free(q.items);
    tam_end(&t);
    if (good)
        return LMN_OK;
    mip_chain_release(out);
    if (kept)
        strokes_release(kept);
    return error_memory(error);
}
