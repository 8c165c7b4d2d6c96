/* Which hidden lines are drawn, and from where to where their dashes are laid. */
#ifndef LIMNER_STROKE_RIBBON_HIDDEN_H
#define LIMNER_STROKE_RIBBON_HIDDEN_H

#include "stroke/ribbon_private.h"

/* From where to where along its chain the run reaches that a hidden stroke belongs to: other numbers of surfaces in
 * front, and visible stretches too short to be seen, do not end it. */
span ribbon_hidden_run(const ribbon_job *job, size_t stroke);

/* Adds what of the hidden strokes is left out because too little of it is there to be understood; `out` has what is
 * left out for other reasons. Only where hidden lines are dashed. */
void ribbon_find_loose(gap_list *out, const ribbon_job *job);

#endif
