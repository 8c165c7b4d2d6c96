/* Dashes as a draughtsman places them: ink where lines meet, at corners and at ends, and between them equal dashes.
 * Goes past Nienhaus 2005, section 5.7, which has no dashed lines because edges of pictures have no identity;
 * tracing gives them one. */
#include "lines/dash.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "lines/lines.h"

/* The detected map's lines reach this far from their middle; and chains of less than this fraction of a period stay
 * whole. */
static const float DETECTED_REACH = 3.5f, LEAST_PERIOD = 0.75f, LEAST_DASHES = 1.5f;
/* Half of the widest lines, with eight samples a side. */
enum { REACH_MAX = 140 };
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
    float        stretch = c->length / ((float)gaps * period + ends);
    dash_pattern out = {.gaps = gaps, .stretch = stretch, .dash = dash * stretch, .period = period * stretch};
    out.lead = c->closed || c->joined[0] ? 0.5f * out.dash : 0;
    return out;
}

float dash_from_middle(const dash_pattern *p, const chain *c, float along)
{
    float at = along + p->lead - 0.5f * p->dash,
          index = (float)(int)(at / p->period + 0.5f); /* at is never far below 0 */
    if (!c->closed && index > (float)p->gaps)
        index = (float)p->gaps;
    return fabsf(at - index * p->period);
}

float dash_inside(const dash_pattern *p, const chain *c, float along)
{
    float at = along + p->lead - 0.5f * p->dash;
    /* A chain's first and last dash have one end each. */
    bool outermost = !c->closed && (at < 0 || at > (float)p->gaps * p->period);
    return p->gaps == 0 ? p->period : 0.5f * p->dash - (outermost ? 0 : dash_from_middle(p, c, along));
}

/* --- painting ------------------------------------------------------------------------------------------- */

/* A chain's point as pixels around it see it. */
typedef struct source {
    float    x, y, along;
    float    tx, ty; /* direction of the line, a unit vector */
    uint32_t chain;
} source;

typedef struct painting {
    int               width, height;
    const chain_set  *set;
    const dash_style *style;
    dash_pattern     *patterns;
    source           *sources;
    uint32_t         *nearest;  /* source of each pixel */
    uint16_t         *distance; /* to it, squared, + 1; 0 = out of reach of all */
} painting;

/* The chain's direction at a point: between its neighbours. */
static void set_direction(source *s, const chain *c, const trace_point *points, size_t i)
{
    const trace_point *before = i ? &points[i - 1] : c->closed ? &points[c->count - 1] : &points[0];
    const trace_point *behind = i + 1 < c->count ? &points[i + 1] : c->closed ? &points[0] : &points[i];
    float              tx = behind->x - before->x, ty = behind->y - before->y, size = sqrtf(tx * tx + ty * ty);
    s->tx = size > 0 ? tx / size : 0;
    s->ty = size > 0 ? ty / size : 0;
}

/* Takes the pixels in reach of a point's own pixel that no other point is nearer to; of equals the first stays. */
static void claim(painting *p, uint32_t label, uint32_t pixel, int reach, const int *spans)
{
    int x = (int)(pixel % (uint32_t)p->width), y = (int)(pixel / (uint32_t)p->width);
    int top = y > reach ? -reach : -y, bottom = y + reach < p->height ? reach : p->height - 1 - y;
    for (int dy = top; dy <= bottom; dy++) {
        int       span = spans[dy < 0 ? -dy : dy];
        int       left = x > span ? -span : -x, right = x + span < p->width ? span : p->width - 1 - x;
        size_t    row = (size_t)(y + dy) * (size_t)p->width + (size_t)x;
        uint16_t *distance = &p->distance[row];
        for (int dx = left; dx <= right; dx++) {
            int d = dx * dx + dy * dy + 1;
            if (distance[dx] && distance[dx] <= d)
                continue;
            distance[dx] = (uint16_t)d;
            p->nearest[(int64_t)row + dx] = label;
        }
    }
}

static void place_sources(painting *p)
{
    int   spans[REACH_MAX + 1];
    float reach = DETECTED_REACH + 0.5f * (p->style->width > 2 ? p->style->width - 2 : 0);
    reach = reach > REACH_MAX ? REACH_MAX : reach;
    for (int i = 0; i <= (int)reach; i++)
        spans[i] = (int)sqrtf(reach * reach - (float)(i * i));
    uint32_t count = 0;
    for (size_t i = 0; i < p->set->chain_count; i++) {
        const chain       *c = &p->set->chains[i];
        const trace_point *points = &p->set->points[c->first];
        p->patterns[i] = dash_pattern_of(c, p->style);
        for (size_t k = 0; k < c->count; k++, count++) {
            source *s = &p->sources[count];
            *s = (source){.x = points[k].x, .y = points[k].y, .along = points[k].along, .chain = (uint32_t)i};
            set_direction(s, c, points, k);
            claim(p, count, points[k].pixel, (int)reach, spans);
        }
    }
}

/* Fraction of ink at a pixel, by its position beside the nearest chain. */
static uint8_t fraction_at(const painting *p, const source *s, int x, int y)
{
    const chain        *c = &p->set->chains[s->chain];
    const dash_pattern *pattern = &p->patterns[s->chain];
    if (pattern->gaps == 0)
        return 255;
    float dx = (float)x - s->x, dy = (float)y - s->y, forth = dx * s->tx + dy * s->ty;
    float along = s->along + (forth < -2 ? -2 : forth > 2 ? 2 : forth), inside;
    if (p->style->dash <= p->style->width && p->style->width >= ROUND_FROM)
        inside = 0.5f * p->style->width - hypotf(dash_from_middle(pattern, c, along), dx * s->ty - dy * s->tx);
    else
        inside = dash_inside(pattern, c, along);
    float fraction = inside + 0.5f;
    return fraction <= 0 ? 0 : fraction >= 1 ? 255 : (uint8_t)(fraction * 255 + 0.5f);
}

static void paint_row(const painting *p, uint8_t *out, int y)
{
    size_t first = (size_t)y * (size_t)p->width;
    for (int x = 0; x < p->width; x++) {
        uint64_t four;
        /* Most of a picture is empty. */
        while (x + 4 <= p->width && (memcpy(&four, &p->distance[first + (size_t)x], sizeof four), four == 0))
            x += 4;
        if (x < p->width && p->distance[first + (size_t)x])
            out[first + (size_t)x] = fraction_at(p, &p->sources[p->nearest[first + (size_t)x]], x, y);
    }
}

bool dash_paint(uint8_t *out, int width, int height, const chain_set *set, const dash_style *style)
{
    size_t   pixels = (size_t)width * (size_t)height;
    painting p = {.width = width,
                  .height = height,
                  .set = set,
                  .style = style,
                  .patterns = mem_alloc(set->chain_count * sizeof *p.patterns),
                  .sources = mem_alloc(set->point_count * sizeof *p.sources),
                  .nearest = mem_alloc(pixels * sizeof *p.nearest),
                  .distance = mem_calloc(pixels, sizeof *p.distance)};
    bool     good = p.patterns && p.sources && p.nearest && p.distance;
    if (good) {
        place_sources(&p);
        memset(out, 255, pixels);
        for (int y = 0; y < height; y++)
            paint_row(&p, out, y);
    }
    mem_free(p.patterns);
    mem_free(p.sources);
    mem_free(p.nearest);
    mem_free(p.distance);
    return good;
}

/* --- the pass ------------------------------------------------------------------------------------------- */

bool dash_process(const pass_pixels *in, void *out, const void *values)
{
    const lines_common *lines = values;
    dash_style          style = {lines->dash, lines->gap, lines->width};
    chain_set           set = {0};
    size_t              count = (size_t)in->width * (size_t)in->height;
    uint8_t            *ink = mem_alloc(count);
    bool                good = ink != NULL;
    if (good) {
        lines_find_ink(ink, in->values[1] ? in->values[1] : in->values[0], count, lines);
        good = chains_trace(&set, ink, in->width, in->height, LINES_SPUR) &&
               dash_paint(out, in->width, in->height, &set, &style);
    }
    chains_release(&set);
    mem_free(ink);
    return good;
}
