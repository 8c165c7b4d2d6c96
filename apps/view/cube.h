/* The view cube: shows how the model is turned; a click on a face, edge or corner turns it there. */
#ifndef LIMNER_VIEW_CUBE_H
#define LIMNER_VIEW_CUBE_H

#include <gtk/gtk.h>

#include "document.h"

GtkWidget *cube_new(document *d);

#endif
