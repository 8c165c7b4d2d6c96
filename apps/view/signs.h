/* Signs that tell what happens: the list of expressions, each with its options, made from the library's tables. */
#ifndef LIMNER_VIEW_SIGNS_H
#define LIMNER_VIEW_SIGNS_H

#include <gtk/gtk.h>

#include "artist.h"
#include "document.h"

GtkWidget *signs_new(document *d, artist *a);
/* Before document or artist end. */
void signs_close(GtkWidget *signs);

#endif
