/* Lines that files bring with a mesh: glTF's primitives of lines, OBJ's "l". They have no faces; CAD programs lay them
 * onto those of others, as edges of what was drawn there. */
#ifndef LIMNER_STROKE_DRAWN_H
#define LIMNER_STROKE_DRAWN_H

#include "stroke/edges.h"

/* Takes the lines of a mesh whose vertices have been welded: `ids` says what each has become. Those that are there
 * twice are one. False when memory is gone. */
bool drawn_take(edge_mesh *out, const mesh *m, const uint32_t *ids);

/* The same lines for another pose or refinement, whose vertices have the same numbers. False when memory is gone. */
bool drawn_copy(edge_mesh *out, const edge_mesh *from);

/* Once edges, pieces and their boxes are known: which edge a line runs along, how far it may lie off its surface, and
 * the piece that lines are, behind all others. False when memory is gone. */
bool drawn_close(edge_mesh *m);

/* Of the pieces, how many have faces. */
uint32_t drawn_face_pieces(const edge_mesh *m);

#endif
