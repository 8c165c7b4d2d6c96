/* Dashes along lines: which fraction of a picture's ink stays. No GL, only arrays. */
#ifndef LIMNER_LINES_DASH_H
#define LIMNER_LINES_DASH_H

#include "lines/chain.h"

typedef struct dash_style {
    float dash, gap; /* pixels; a dash no longer than the width is a dot */
    float width;     /* of the finished line */
} dash_style;

/* A chain's pattern: `gaps` gaps, dash and gap stretched by `stretch` so that it begins and ends with ink: half a
 * dash where it meets other lines, which have the other half, a whole one where it just stops. No gaps: the chain
 * is too short or no line, it stays whole. */
typedef struct dash_pattern {
    int   gaps;
    float stretch;
    float dash, period; /* stretched */
    float lead;         /* how much of the first dash lies before the chain's beginning */
} dash_pattern;
dash_pattern dash_pattern_of(const chain *c, const dash_style *style);

/* How far a position of the chain lies from the middle of the nearest dash, in pixels along it. */
float dash_from_middle(const dash_pattern *p, const chain *c, float along);

/* How far inside a dash (negative: inside a gap) it is. */
float dash_inside(const dash_pattern *p, const chain *c, float along);

/* The fraction of ink that stays at each pixel, 255 = all: one byte a pixel, everything within the line's reach
 * belongs to the nearest chain. False when memory is gone. */
bool dash_paint(uint8_t *out, int width, int height, const chain_set *set, const dash_style *style);

#endif
