/* The widget that shows a document's drawing and takes pointer, keys and touch. While something moves it asks for
 * pictures that can be drawn in time, at rest for the whole one. */
#ifndef LIMNER_VIEW_PICTURE_H
#define LIMNER_VIEW_PICTURE_H

#include <gtk/gtk.h>

#include "artist.h"
#include "document.h"

#define PICTURE_TYPE (picture_get_type())
G_DECLARE_FINAL_TYPE(Picture, picture, LIMNER, PICTURE, GtkWidget)

/* Borrows both; they outlive the widget's use of them: call picture_close before either ends. */
GtkWidget *picture_new(document *d, artist *a);
void       picture_close(Picture *p);

/* Shows this look on the left of a divider and the document's on the right; takes the reference; NULL: no more. */
void picture_compare(Picture *p, look_ref *look);

/* What it shows; NULL after picture_close. */
document *picture_document(const Picture *p);

/* The picture's size in device pixels. */
void picture_size(const Picture *p, int *width, int *height);

/* What it shows now; NULL: nothing yet. Borrowed. */
GdkTexture *picture_texture(const Picture *p);

/* Moves with the keyboard's letters and the pointer as if walking. */
void picture_set_walking(Picture *p, bool walking);

/* Signals: "status" (const char *text): what was drawn, or why it could not be; "menu" (double x, double y, uint part):
 * a context menu is asked for; "resized". */

#endif
