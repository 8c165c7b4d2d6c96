/* Overshoot: straight lines run on past their corners and junctions, as architects draw drafts. No GL, only arrays. */
#ifndef LIMNER_LINES_OVERSHOOT_H
#define LIMNER_LINES_OVERSHOOT_H

#include "lines/chain.h"
#include "technique/technique.h"

/* Lengths vary by this much, up and down. The most that a line can run on, as a multiple of the length that was
 * asked for: where an arc touches it, its own length and half as much again are counted from where they part. */
#define OVERSHOOT_VARIATION 0.3f
#define OVERSHOOT_MOST      (2.5f * (1 + OVERSHOOT_VARIATION))

typedef struct overshoot_style {
    float length; /* of an extension, about; pixels */
    float width;  /* of the detected lines */
    float spread; /* how far beside the detected line its ink may come to lie */
    float fade;   /* fraction of the ink that is missing at the tip */
} overshoot_style;

enum { OVERSHOOT_CLASSES = 3 }; /* profile, inner, id */

/* An extension: a straight line from a chain's end. */
typedef struct extension {
    float x, y;                   /* the end of the chain; pixels, centres are whole numbers */
    float dx, dy;                 /* unit vector */
    float start;                  /* how far from there it leaves the ink that is drawn already; 0 at corners */
    float length;                 /* from the chain's end to the tip */
    float ink[OVERSHOOT_CLASSES]; /* of the line that runs on */
    float depth, slope; /* eye depth, or in perspective its inverse, there and its growth a pixel; depth 0: unknown */
} extension;

typedef struct extension_set {
    extension *extensions;
    size_t     count, capacity;
} extension_set;

/* What the chains of an edge map run on by. `in` has the edge map and, where it is known, normals with eye depth;
 * `ink` is what was traced. False when memory is gone; then there are none. */
bool overshoot_find(extension_set *out, const chain_set *set, const pass_pixels *in, const uint8_t *ink,
                    const overshoot_style *style);
void overshoot_release(extension_set *s);

/* Draws extensions into a picture as TARGET_OVERSHOOT is one: two words a pixel. */
void overshoot_paint(uint32_t *out, const pass_pixels *in, const extension_set *set, const overshoot_style *style);

#endif
