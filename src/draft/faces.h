/* Which faces of a mesh go on into each other: what cylinders grow over. */
#ifndef LIMNER_DRAFT_FACES_H
#define LIMNER_DRAFT_FACES_H

#include "stroke/edges.h"

typedef struct draft_faces {
    double (*normals)[3]; /* per face, unit */
    uint32_t *beside;     /* per corner: the face behind the edge that begins there; EDGE_NO_FACE: none, or an edge that
                             is drawn or turns sharply */
} draft_faces;

/* Errors: LMN_MEMORY. */
lmn_status draft_faces_make(draft_faces *out, const edge_mesh *m, lmn_error *error);
void       draft_faces_release(draft_faces *f);

static inline uint32_t draft_faces_beside(const draft_faces *f, uint32_t face, int corner)
{
    return f->beside[3 * (size_t)face + (size_t)corner];
}

/* Radians. */
double draft_faces_turn(const draft_faces *f, uint32_t a, uint32_t b);

#endif
