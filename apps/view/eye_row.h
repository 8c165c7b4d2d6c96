/* Rows of trees with a name and an eye that shows or hides what they stand for: parts, solids. Main thread. */
#ifndef LIMNER_VIEW_EYE_ROW_H
#define LIMNER_VIEW_EYE_ROW_H

#include <gtk/gtk.h>
#include <stdbool.h>

/* The widgets of a row, once; `clicked`(GtkToggleButton *, user) when the eye is toggled by someone: see
 * eye_row_clicked. */
void eye_row_setup(GtkListItem *item, PangoEllipsizeMode ellipsize, GCallback clicked, gpointer user);

/* Puts `row` (which the eye keeps a reference of, taken from the caller) into it; `tree` NULL: not in a tree. Returns
 * the eye. */
GtkWidget *eye_row_bind(GtkListItem *item, GtkTreeListRow *tree, const char *name, gpointer row);

/* How the eye is now. */
void eye_row_show(GtkWidget *eye, const char *name, bool shown);

/* What is toggled by hand: its row; NULL: nothing. Borrowed. */
gpointer eye_row_clicked(GtkToggleButton *eye);

/* Calls `show` with each eye below `widget` that is on the screen now, and its row. */
void eye_row_each(GtkWidget *widget, void (*show)(gpointer user, GtkWidget *eye, gpointer row), gpointer user);

#endif
