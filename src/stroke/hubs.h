/* Faces around a place that very many share: the tip of a cone, the middle of a star. Near it their boxes all overlap,
 * but what they have in common beside it lies in directions, as seen from it, that both have. */
#ifndef LIMNER_STROKE_HUBS_H
#define LIMNER_STROKE_HUBS_H

#include "stroke/stroke_private.h"

typedef struct hub_faces {
    const uint32_t (*corners)[3]; /* numbers of vertices, of all in the scene */
    const uint32_t *pieces, *planes;
    size_t          count;
    double          same; /* so far off positions may be */
    double3 (*position)(void *user, uint32_t face, int corner);
} hub_faces;

/* hubs[face]: the vertex that it shares with the most others, KIN_MIXED if these are few. */
bool hubs_find(uint32_t *hubs, const hub_faces *faces);
/* Calls `pair` as hierarchy_pairs does, for all pairs of one hub whose directions overlap. *going: false once it has
 * returned false. `user` is of the positions, too. */
lmn_status hubs_pairs(const uint32_t *hubs, const hub_faces *faces, hierarchy_pair pair, void *user, bool *going,
                      lmn_error *error);

#endif
