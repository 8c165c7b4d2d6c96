/* Maps that stay on the GPU: what collect.c does in memory. */
#ifndef LIMNER_FRAME_MERGE_H
#define LIMNER_FRAME_MERGE_H

#include "frame/frame_private.h"

void merge_edges(frame *f, const figure_state *s);  /* after each line technique of a figure */
void merge_figure(frame *f, const figure_state *s); /* at its end */
void merge_layer_edges_end(frame *f);               /* instead, of layers behind the first */
void merge_uncertainty(frame *f, const figure_state *s);
void merge_direction(frame *f, const figure_state *s);

#endif
