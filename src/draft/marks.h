/* What tells on one view where another one comes from (ISO 128-3): cutting planes, circles around details, arrows of
 * auxiliary views, and the letters of all. */
#ifndef LIMNER_DRAFT_MARKS_H
#define LIMNER_DRAFT_MARKS_H

#include "draft/draw.h"
#include "draft/extras.h"

/* Can the cutting plane of a section be told on this view? It has to be seen from the side there. */
bool draft_shows_plane(const draft_view *v, const draft_extra *e);
/* Where the trace runs: a polyline of the sheet of at most 2 · DRAFT_DEPTHS_MOST points, from the left of the section
 * to its right; of a half section from its middle. */
size_t draft_trace(const draft_view *v, const draft_extra *e, box3 bounds, double letter, double (*out)[2]);
/* The trace of a cutting plane: a long-dashed dotted line, wide at its ends and where it turns, with arrows in the
 * direction of the view, and letters; of a half section from its middle on, with one arrow. `bounds`: of the model. */
void draft_cutting_plane(const draft_view *v, const draft_extra *e, box3 bounds, double letter);
/* A narrow circle with its letter. */
void draft_detail_circle(const draft_view *v, const draft_extra *e, double letter);
/* On the detail itself: where it ends. */
void draft_detail_rim(const draft_view *v, const draft_extra *e);
/* An arrow beside the model in the direction of an auxiliary view, with its letter. False where that is not seen
 * from the side. `bounds`: of the model. */
bool draft_view_arrow(const draft_view *v, const draft_extra *e, box3 bounds, double letter);
/* Letters above a view: "A–A", "B (5:1)". `top`: of what is drawn. */
void draft_title(const draft_view *v, const char *words, double top, double letter);

#endif
