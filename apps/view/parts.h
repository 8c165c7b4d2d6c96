/* The list of parts: search, mark, hide, show alone. */
#ifndef LIMNER_VIEW_PARTS_H
#define LIMNER_VIEW_PARTS_H

#include <gtk/gtk.h>

#include "document.h"

GtkWidget *parts_new(document *d);

#endif
