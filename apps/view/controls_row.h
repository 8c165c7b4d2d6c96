/* A row for one parameter: the widget that suits its type, whether it is auto, and a way back to its default. */
#ifndef LIMNER_VIEW_CONTROLS_ROW_H
#define LIMNER_VIEW_CONTROLS_ROW_H

#include <adwaita.h>

#include "limner/limner.h"

/* Where a technique is in a look. */
typedef struct place {
    size_t      rule;
    const char *kind; /* static */
    size_t      index;
} place;

typedef struct control_row control_row;

/* Sets a parameter from text; value NULL: to its default. False with the reason when it is refused. */
typedef bool (*control_set)(void *owner, const place *where, const char *key, const char *value, lmn_error *error);

control_row *control_row_new(const lmn_param_info *info, const place *where, control_set set, void *owner);
void         control_row_free(control_row *row); /* the widget is its parent's */
GtkWidget   *control_row_widget(control_row *row);

/* Shows a value as control_set takes it. */
void control_row_show_text(control_row *row, const char *text, bool is_default);

/* Shows what the look has. */
void control_row_refresh(control_row *row, const lmn_look *look);

/* Shows the row when it matters and has the folded text in its name or documentation ("": all); is it shown? */
bool control_row_show(control_row *row, const lmn_look *look, const char *wanted);

#endif
