/* The silhouette of a refined mesh, found level by level: only near the silhouette of one level is there one on the
 * next. Freudenberg 2003, section 7.3.2; row OE-10. */
#ifndef LIMNER_STROKE_PROPAGATE_H
#define LIMNER_STROKE_PROPAGATE_H

#include "stroke/butterfly.h"

/* Is a face of a level seen from the front? */
typedef bool (*propagate_front)(void *user, uint32_t level, uint32_t face);

typedef struct silhouette {
    uint32_t *halves; /* half-edges of the last level whose face is seen from the front and whose opposite's is not,
                         ascending */
    size_t   count;
    uint64_t tested[BUTTERFLY_STEPS_MAX + 1]; /* faces asked for, per level */
} silhouette;

/* On level 0 and on further levels of up to `all_of` faces all faces are asked for: where a few large faces stand
 * for a shape, the next level may well have outlines that they have not. After that, faces are asked for when their
 * parent shares a vertex with the parent level's silhouette, and further on as long as what is found differs from
 * what is beside it; all others are as their parents are. So what is found is part of the true silhouette and ends
 * nowhere. New ones far from the old, small waves that refining made, are not found, nor are they wanted. Errors:
 * LMN_MEMORY. */
lmn_status silhouette_propagate(silhouette *out, const butterfly *b, uint32_t all_of, propagate_front is_front,
                                void *user, lmn_error *error);
void       silhouette_release(silhouette *s);

#endif
