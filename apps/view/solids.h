/* The trees of solids: operations and operands. The marked one gets handles in the picture and is moved by them. */
#ifndef LIMNER_VIEW_SOLIDS_H
#define LIMNER_VIEW_SOLIDS_H

#include <gtk/gtk.h>

#include "document.h"

/* Hidden for scenes without solids. */
GtkWidget *solids_new(document *d);

#endif
