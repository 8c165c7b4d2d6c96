/* Keys: one table for what they do and for the window that lists them. */
#ifndef LIMNER_VIEW_SHORTCUTS_H
#define LIMNER_VIEW_SHORTCUTS_H

#include <gtk/gtk.h>

void shortcuts_add(GtkApplication *application);
void shortcuts_show(GtkWindow *parent);

#endif
