/* Strokes that a person draws in a square which repeats: what is there, taking back, which are seen at two thresholds.
 * Freudenberg 2003, section 5.2.1. No window. */
#ifndef LIMNER_VIEW_STROKE_SHEET_H
#define LIMNER_VIEW_STROKE_SHEET_H

#include <glib.h>

#include "limner/limner.h"

typedef struct stroke_sheet {
    GArray    *strokes; /* of lmn_stroke */
    GPtrArray *before;  /* of GArray: what was there before each change */
} stroke_sheet;

stroke_sheet *stroke_sheet_make(void);
void          stroke_sheet_free(stroke_sheet *s);

/* Keeps what is there now for stroke_sheet_undo; before each change that a person takes for one. */
void stroke_sheet_step(stroke_sheet *s);
bool stroke_sheet_undo(stroke_sheet *s);

/* Adds a straight piece in a layer; a piece that begins where the last one of the layer ends goes on with its curve. */
void stroke_sheet_add(stroke_sheet *s, double u0, double v0, double u1, double v1, int layer);

/* The stroke with an end nearest to a position, within `reach`; −1: none. *second: it is the one where it ends. */
int  stroke_sheet_pick(const stroke_sheet *s, double u, double v, double reach, bool *second);
void stroke_sheet_move_end(stroke_sheet *s, int index, bool second, double u, double v);
void stroke_sheet_set_layer(stroke_sheet *s, int index, int layer);
void stroke_sheet_remove(stroke_sheet *s, int index);

/* Is it drawn in this light, and at this distance? Both from 0 to 1, each by itself. */
bool stroke_is_seen(const lmn_stroke *stroke, double light, double distance);

/* Gives all strokes their priorities, layer by layer; the order within a layer is random when it is shuffled. */
lmn_status stroke_sheet_order(stroke_sheet *s, lmn_stroke_order order, lmn_stroke_perspective perspective,
                              uint32_t seed, lmn_error *error);

lmn_status stroke_sheet_load(stroke_sheet *s, const char *path, lmn_error *error);
lmn_status stroke_sheet_save(const stroke_sheet *s, const char *path, lmn_error *error);

#endif
