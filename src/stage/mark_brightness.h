/* How bright what marks lie on is by itself, at any place: the colours of materials and vertices, and their pictures,
 * averaged over as much of them as a mark has to itself. */
#ifndef LIMNER_STAGE_MARK_BRIGHTNESS_H
#define LIMNER_STAGE_MARK_BRIGHTNESS_H

#include "stage/mark_ground.h"

enum { BRIGHTNESS_LEVELS = 32 };

/* The brightness of a picture at halves of its size, of halves of that … */
typedef struct brightness_picture {
    uint16_t *levels[BRIGHTNESS_LEVELS]; /* linear, rows as in the picture */
    uint32_t  widths[BRIGHTNESS_LEVELS], heights[BRIGHTNESS_LEVELS];
    int       count; /* 0: not used, or it could not be read */
} brightness_picture;

typedef struct mark_brightness {
    const mark_ground  *ground; /* borrowed */
    brightness_picture *pictures;
    size_t              picture_count;
} mark_brightness;

/* Errors: LMN_MEMORY. Release also after one. */
lmn_status mark_brightness_make(mark_brightness *out, const mark_ground *g, lmn_error *error);
void       mark_brightness_release(mark_brightness *b);
/* mark_surface.brightness of a mark_brightness. */
double mark_brightness_at(const void *brightness, uint32_t triangle, vec3 at, double around);

#endif
