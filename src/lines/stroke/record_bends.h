/* How the edges of a mesh that stand for curves leave their chords, for records of edges. */
#ifndef LIMNER_LINES_STROKE_RECORD_BENDS_H
#define LIMNER_LINES_STROKE_RECORD_BENDS_H

#include "stroke/edges.h"

/* What is known at the vertices of a mesh. */
typedef struct record_bends {
    const edge_mesh *m;
    vec3            *normals; /* of the surface, where no line passes; 0 elsewhere */
    uint32_t (*lines)[2];     /* edges that are always lines, of vertices where two meet */
    uint8_t *counts;          /* of such edges, 3: or more */
    float   *turns;           /* from the one to the other, radians; 0: no curve's */
} record_bends;

bool record_bends_open(record_bends *out, const edge_mesh *m);
void record_bends_close(record_bends *b);

/* The curve over an edge's chord at u, 0 … 1, is off it by u (1 − u)² begin + u² (1 − u) end, in lengths of the chord:
 * cubic, as the edges of PN triangles are, with the tangent that its neighbours have, too. Each packed into a number of
 * 24 bits; 0: straight. */
void record_bend(const record_bends *b, uint32_t edge, float *begin, float *end);

#endif
