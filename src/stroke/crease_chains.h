/* Creases as lines from end to end: what is drawn of them is decided for whole chains. */
#ifndef LIMNER_STROKE_CREASE_CHAINS_H
#define LIMNER_STROKE_CREASE_CHAINS_H

#include "stroke/creases.h"

/* Links creases that go on as one another and gives all edges of a chain the turn of the chain, its mean by length
 * (mesh_edge). Chains that end anywhere, without another line, and are short and weak beside the crease angle are no
 * creases but candidates for outlines. Where the file's normals go on over them all, the mesh stands for a curved
 * surface: there short chains go, too, that turn hardly more than the surface does around them. What files name stays.
 * Only of shapes that bend everywhere (`hand_made`): elsewhere a line that runs out is meant. False when memory is
 * gone. */
bool crease_chains_judge(edge_mesh *m, const crease_facts *facts, const crease_measure *measured, bool hand_made);

#endif
