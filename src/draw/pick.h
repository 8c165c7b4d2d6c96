/* Reading a drawing's maps and camera. Rows count from the top here, as callers count them. */
#ifndef LIMNER_DRAW_PICK_H
#define LIMNER_DRAW_PICK_H

#include "draw/drawing.h"
#include "limner/maps.h"

/* The numbers of a map, row 0 at the bottom; NULL where the drawing does not have it. */
const void *pick_map(const lmn_drawing *d, lmn_map map);

/* What is at a pixel inside of the picture. */
lmn_pick pick_at(const lmn_drawing *d, int x, int y);

/* The same of a picture that is not drawn; pixels outside show nothing. */
lmn_status renderer_pick(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                         int x, int y, lmn_pick *out, lmn_error *error);

bool pick_project(const lmn_drawing *d, const double point[3], double pixel[2], double *depth);
void pick_unproject(const lmn_drawing *d, const double pixel[2], double depth, double point[3]);

#endif
