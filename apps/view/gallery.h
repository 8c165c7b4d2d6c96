/* All looks as small pictures of the model that is shown. */
#ifndef LIMNER_VIEW_GALLERY_H
#define LIMNER_VIEW_GALLERY_H

#include <gtk/gtk.h>

#include "artist.h"
#include "document.h"

/* Call gallery_close before the artist ends. */
GtkWidget *gallery_new(document *d, artist *a);
void       gallery_close(GtkWidget *gallery);

#endif
