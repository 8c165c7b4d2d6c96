/* Curvature of a form surface. */
#ifndef LIMNER_STROKE_FORM_BEND_H
#define LIMNER_STROKE_FORM_BEND_H

#include "stroke/form_surface.h"

/* Fills `bends`. False when memory is gone. */
bool form_bend_make(form_surface *s, const edge_mesh *m);

#endif
