/* Lines through many points as few pieces of curves: straight lines, arcs of circles and ellipses, cubic Béziers. */
#ifndef LIMNER_SHEET_FIT_H
#define LIMNER_SHEET_FIT_H

#include "sheet/sheet.h"

/* Gives paths that stand for curves (`curved`) their pieces, which lie nowhere farther than `most` mm from the lines
 * through their points, nor these from them. What is straight becomes one line, a corner stays one; pieces begin and
 * end at points of the path. 0: nothing is done. Closed paths that are not dashed may begin at another of their points
 * afterwards. Call it last: what changes points later must take the pieces away. */
void sheet_fit(sheet *s, double most);

/* Where an arc is at an angle. */
void sheet_arc_at(const sheet_piece *arc, double angle, double out[2]);

#endif
