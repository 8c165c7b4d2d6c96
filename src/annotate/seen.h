/* Which part is seen where: a small picture of numbers, drawn without a GPU, so that pictures and sheets of one view
 * have the same labels at the same places. */
#ifndef LIMNER_ANNOTATE_SEEN_H
#define LIMNER_ANNOTATE_SEEN_H

#include "annotate/annotate.h"

typedef struct seen_map {
    int      width, height;
    int32_t *parts;  /* per pixel, from the top left: part; NONE: the ground */
    float   *depths; /* per pixel: the more, the nearer */
} seen_map;

/* Draws what the plan draws and nothing cuts away, of triangles. Errors: LMN_MEMORY. Release it also after one. */
lmn_status seen_make(seen_map *out, const annotated_view *view, lmn_error *error);
void       seen_release(seen_map *m);

#endif
