/* Everything that can be set of the look: rules, techniques and their parameters, made from the library's tables. */
#ifndef LIMNER_VIEW_CONTROLS_H
#define LIMNER_VIEW_CONTROLS_H

#include <gtk/gtk.h>

#include "document.h"

GtkWidget *controls_new(document *d);

#endif
