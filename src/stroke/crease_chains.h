/* Creases as lines from end to end: what is drawn of them is decided for whole chains. */
#ifndef LIMNER_STROKE_CREASE_CHAINS_H
#define LIMNER_STROKE_CREASE_CHAINS_H

#include "stroke/edges.h"

/* Links creases that go on as one another and gives all edges of a chain the turn of the chain, its mean by length
 * (mesh_edge). Chains that end anywhere, without another line, and are short and weak beside `angle`, radians, are no
 * creases but candidates for outlines; those that files name stay. Only of shapes that bend
 * everywhere (`hand_made`): elsewhere a line that runs out is meant. `size`: diagonal of the mesh. False when memory is
 * gone. */
bool crease_chains_judge(edge_mesh *m, double size, double angle, bool hand_made);

#endif
