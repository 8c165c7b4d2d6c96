/* Writing the maps of a drawing. */
#ifndef LIMNER_DRAW_MAPS_H
#define LIMNER_DRAW_MAPS_H

#include "draw/drawing.h"

lmn_status maps_write(const frame_maps *m, size_t part_count, const char *directory, lmn_error *error);

#endif
