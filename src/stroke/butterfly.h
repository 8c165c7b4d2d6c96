/* Modified butterfly subdivision (Zorin, Schröder, Sweldens 1996): a finer mesh through the vertices of a coarse
 * one. Freudenberg 2003, section 7.3.1; row OE-09. */
#ifndef LIMNER_STROKE_BUTTERFLY_H
#define LIMNER_STROKE_BUTTERFLY_H

#include "scene/scene.h"

#define BUTTERFLY_NONE UINT32_MAX
enum { BUTTERFLY_STEPS_MAX = 6 };

/* One level. Half-edges are numbered 3 · face + corner that they begin at. The children of face f are 4f … 4f + 3:
 * those at its three corners, which keep the numbers of their corners, and the middle one, whose corner k is the
 * middle of the edge opposite to corner k. */
typedef struct butterfly_level {
    uint32_t vertex_count, face_count;
    uint32_t (*faces)[3];
    uint32_t *opposite; /* per half-edge: the other one of its edge; BUTTERFLY_NONE unless it has exactly two faces,
                           which pass it in opposite directions */
    uint8_t
        *sharp; /* per half-edge: the surface does not go on smoothly over it; always 1 where there is no opposite */
} butterfly_level;

typedef struct butterfly {
    vec3           *positions; /* of the last level; those of the levels before come first */
    butterfly_level levels[BUTTERFLY_STEPS_MAX + 1];
    uint32_t        level_count; /* levels[0] is the mesh that was given */
} butterfly;

/* Refines `steps` times. `sharp` (may be NULL) says per half-edge what stays sharp; one side is enough. Sharp edges
 * are refined as curves of their own, by vertices along them alone, as far as corners: where not exactly two of
 * them meet, or these two turn by more than 75°. Errors: LMN_MEMORY, LMN_LIMIT. End with butterfly_release. */
lmn_status butterfly_refine(butterfly *out, const vec3 *positions, uint32_t vertex_count, const uint32_t (*faces)[3],
                            uint32_t face_count, const uint8_t *sharp, int steps, lmn_error *error);
void       butterfly_release(butterfly *b);

static inline uint32_t half_edge_next(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static inline uint32_t half_edge_before(uint32_t h)
{
    return h % 3 == 0 ? h + 2 : h - 1;
}

/* The two halves of a half-edge on the next level, in its direction. */
static inline uint32_t half_edge_first(uint32_t h)
{
    return 12 * (h / 3) + 4 * (h % 3);
}

static inline uint32_t half_edge_second(uint32_t h)
{
    return 12 * (h / 3) + 3 * ((h + 1) % 3) + h % 3;
}

#endif
