/* A row for one of a look's controls (weight, darkness, …): a slider from -1 to 1 with a way back to 0. */
#ifndef LIMNER_VIEW_CONTROLS_SCALE_H
#define LIMNER_VIEW_CONTROLS_SCALE_H

#include <adwaita.h>

#include "limner/limner.h"

typedef struct scale_row scale_row;

/* Sets a control; false: it was refused. */
typedef bool (*scale_set)(void *owner, const char *name, double value);

scale_row *scale_row_new(const lmn_control_info *info, scale_set set, void *owner);
void       scale_row_free(scale_row *row); /* the widget is its parent's */
GtkWidget *scale_row_widget(scale_row *row);

/* Shows the look's value; a control that the look does not have is hidden. */
void scale_row_refresh(scale_row *row, const lmn_look *look);

/* Is there something to show for this folded text ("": all)? Shows or hides the row so. */
bool scale_row_show(scale_row *row, const lmn_look *look, const char *wanted);

#endif
