/* Dashes as a draughtsman places them: ink where lines meet, at corners and at ends, and between them equal dashes. Goes past
 * seed 000, section 5.7, which has no dashed lines because edges of pictures have no identity; tracing gives them one. */
#include "lines/dash.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "lines/lines.h"

/* Ink of less than a line's weight is shading and stays as it is. A side branch shorter than this comes from thinning. */
static const float LINE_INK = 0.15f, SPUR = 3.5f;
/* The detected map's lines reach this far from their middle; and chains of less than this share of a period stay whole. */
static const float DETECTED_REACH = 3.5f, LEAST_PERIOD = 0.75f, LEAST_DASHES = 1.5f;
/* From this width on dots are round; below, a square is rounder. */
static const float ROUND_FROM = 4;

/* Dots smaller than this are faint: they fall between pixels. */
static const float LEAST_DOT = 2;

static float dash_length(const dash_style *s)
{
    return fmaxf(s->dash, fmaxf(s->width, LEAST_DOT));
}

dash_pattern dash_pattern_of(const chain *c, const dash_style *style)
{
    float dash = dash_length(style), period = dash + style->gap;
    /* What the gaps and the dashes between them leave over. */
    float ends = c->closed ? 0 : dash * (float)(2 - c->joined[0] - c->joined[1]) * 0.5f;
    float periods = (c->length - ends) / period;
    if (c->broad || c->length < LEAST_DASHES * dash || c->length < LEAST_PERIOD * period + ends)
        return (dash_pattern){.stretch = 1, .dash = dash, .period = period};
    /* As many gaps as need the least stretching, or squeezing, by factors. */
    int gaps = (int)floorf(periods);
    gaps += gaps < 1 || periods > sqrtf((float)gaps * (float)(gaps + 1));
    float stretch = c->length / ((float)gaps * period + ends);
    dash_pattern out = {.gaps = gaps, .stretch = stretch, .dash = dash * stretch, .period = period * stretch};
    out.lead = c->closed || c->joined[0] ? 0.5f * out.dash : 0;
    return out;
}

float dash_from_middle(const dash_pattern *p, const chain *c, float along)
{
    float at = along + p->lead - 0.5f * p->dash, index = roundf(at / p->period);
    if (!c->closed)
        index = fmaxf(0, fminf((float)p->gaps, index));
    return fabsf(at - index * p->period);
}

float dash_inside(const dash_pattern *p, const chain *c, float along)
{
    float at = along + p->lead - 0.5f * p->dash;
    /* A chain's first and last dash have one end each. */
    bool outermost = !c->closed && (at < 0 || at > (float)p->gaps * p->period);
    return p->gaps == 0 ? p->period : 0.5f * p->dash - (outermost ? 0 : dash_from_middle(p, c, along));
}

/* --- painting ---------------------------------------------------------------------------------------------------- */

typedef struct source {
    int16_t  x, y; /* the pixel */
    uint32_t point, chain;
} source;

typedef struct painting {
    uint8_t            *out;
    int                 width, height;
    const chain_set    *set;
    const dash_style   *style;
    const dash_pattern *patterns;
    source             *sources;
    uint32_t           *nearest; /* source of each pixel + 1; 0 = out of reach */
    uint32_t           *front, *behind; /* pixels */
    size_t              front_count, behind_count, front_room, behind_room;
} painting;

static int distance2(const source *s, int x, int y)
{
    return (s->x - x) * (s->x - x) + (s->y - y) * (s->y - y);
}

/* Share of ink at a pixel, by its place beside the nearest chain. */
static uint8_t share_at(const painting *p, const source *s, int x, int y)
{
    const chain *c = &p->set->chains[s->chain];
    const dash_pattern *pattern = &p->patterns[s->chain];
    if (pattern->gaps == 0)
        return 255;
    const chain_point *points = &p->set->points[c->first], *at = &points[s->point];
    size_t before = s->point ? s->point - 1 : c->closed ? c->count - 1 : 0;
    size_t behind = s->point + 1 < c->count ? s->point + 1 : c->closed ? 0 : s->point;
    float tx = points[behind].x - points[before].x, ty = points[behind].y - points[before].y;
    float size = hypotf(tx, ty), dx = (float)x - at->x, dy = (float)y - at->y;
    float beside = 0, forth = 0;
    if (size > 0) {
        forth = (dx * tx + dy * ty) / size;
        beside = (dx * ty - dy * tx) / size;
    }
    float along = at->along + fmaxf(-2, fminf(2, forth)), inside = dash_inside(pattern, c, along);
    if (p->style->dash <= p->style->width && p->style->width >= ROUND_FROM)
        inside = 0.5f * p->style->width - hypotf(dash_from_middle(pattern, c, along), beside);
    float share = inside + 0.5f;
    return share <= 0 ? 0 : share >= 1 ? 255 : (uint8_t)(share * 255 + 0.5f);
}

static bool claim(painting *p, uint32_t pixel, uint32_t label)
{
    if (!mem_grow((void **)&p->behind, &p->behind_room, p->behind_count + 1, sizeof *p->behind))
        return false;
    p->nearest[pixel] = label;
    p->behind[p->behind_count++] = pixel;
    return true;
}

/* One ring farther out: the pixels beside the front go to whichever chain is nearest. */
static bool spread(painting *p, int reach2)
{
    for (size_t i = 0; i < p->front_count; i++) {
        uint32_t pixel = p->front[i], label = p->nearest[pixel];
        int x = (int)(pixel % (uint32_t)p->width), y = (int)(pixel / (uint32_t)p->width);
        const source *s = &p->sources[label - 1];
        for (int k = 0; k < 9; k++) {
            int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
            if (k == 4 || nx < 0 || ny < 0 || nx >= p->width || ny >= p->height)
                continue;
            uint32_t next = (uint32_t)ny * (uint32_t)p->width + (uint32_t)nx, other = p->nearest[next];
            int distance = distance2(s, nx, ny);
            if (other == label || distance > reach2 || (other && distance2(&p->sources[other - 1], nx, ny) <= distance))
                continue;
            if (!claim(p, next, label))
                return false;
        }
    }
    return true;
}

static void swap_fronts(painting *p)
{
    uint32_t *pixels = p->front;
    size_t room = p->front_room;
    p->front = p->behind;
    p->front_room = p->behind_room;
    p->front_count = p->behind_count;
    p->behind = pixels;
    p->behind_room = room;
    p->behind_count = 0;
}

static void paint_front(const painting *p)
{
    for (size_t i = 0; i < p->front_count; i++) {
        uint32_t pixel = p->front[i];
        p->out[pixel] = share_at(p, &p->sources[p->nearest[pixel] - 1], (int)(pixel % (uint32_t)p->width), (int)(pixel / (uint32_t)p->width));
    }
}

/* Every chain's points claim their own pixels; of several chains at a node the first. */
static bool place_sources(painting *p)
{
    size_t count = 0;
    for (size_t i = 0; i < p->set->chain_count; i++) {
        const chain *c = &p->set->chains[i];
        for (size_t k = 0; k < c->count; k++, count++) {
            uint32_t pixel = p->set->points[c->first + k].pixel;
            p->sources[count] = (source){(int16_t)(pixel % (uint32_t)p->width), (int16_t)(pixel / (uint32_t)p->width), (uint32_t)k, (uint32_t)i};
            if (!p->nearest[pixel] && !claim(p, pixel, (uint32_t)count + 1))
                return false;
        }
    }
    return true;
}

bool dash_paint(uint8_t *out, int width, int height, const chain_set *set, const dash_style *style)
{
    memset(out, 255, (size_t)width * (size_t)height);
    dash_pattern *patterns = mem_alloc(set->chain_count * sizeof *patterns);
    painting p = {.out = out, .width = width, .height = height, .set = set, .style = style, .patterns = patterns};
    p.sources = mem_alloc(set->point_count * sizeof *p.sources);
    p.nearest = mem_calloc((size_t)width * (size_t)height, sizeof *p.nearest);
    bool good = patterns && p.sources && p.nearest;
    for (size_t i = 0; good && i < set->chain_count; i++)
        patterns[i] = dash_pattern_of(&set->chains[i], style);
    float reach = DETECTED_REACH + 0.5f * fmaxf(style->width - 2, 0);
    good = good && place_sources(&p);
    for (swap_fronts(&p); good && p.front_count; swap_fronts(&p)) {
        paint_front(&p);
        good = spread(&p, (int)(reach * reach));
    }
    mem_free(patterns);
    mem_free(p.sources);
    mem_free(p.nearest);
    mem_free(p.front);
    mem_free(p.behind);
    return good;
}

/* --- the pass ----------------------------------------------------------------------------------------------------- */

static float weight_of(float weight, colour own, colour standard)
{
    float alpha = isnan(own.r) ? standard.a : own.a;
    return alpha > 0 ? weight : 0;
}

/* Pixels of lines: the strongest class of ink, as the ink shader weighs them. Lines that are translucent are lines all the same. */
static void find_ink(uint8_t *ink, const pass_pixels *edges, const lines_common *lines)
{
    float profile = weight_of(lines->profile_weight, lines->colour, lines->colour);
    float inner = weight_of(lines->inner_weight, lines->inner_colour, lines->colour);
    float id = weight_of(lines->id_weight, lines->id_colour, lines->colour);
    for (size_t i = 0, count = (size_t)edges->width * (size_t)edges->height; i < count; i++) {
        const float *edge = &edges->values[4 * i];
        ink[i] = (1 - edge[0]) * profile >= LINE_INK || (1 - edge[1]) * inner >= LINE_INK || (1 - edge[3]) * id >= LINE_INK;
    }
}

bool dash_process(const pass_pixels *edges, uint8_t *out, const void *values)
{
    const lines_common *lines = values;
    dash_style style = {lines->dash, lines->gap, lines->width};
    chain_set set = {0};
    uint8_t *ink = mem_alloc((size_t)edges->width * (size_t)edges->height);
    bool good = ink != NULL;
    if (good) {
        find_ink(ink, edges, lines);
        good = chains_trace(&set, ink, edges->width, edges->height, SPUR) && dash_paint(out, edges->width, edges->height, &set, &style);
    }
    chains_release(&set);
    mem_free(ink);
    return good;
}
