/* A window: a document, the artist that draws it, and the panels around the picture. */
#ifndef LIMNER_VIEW_WINDOW_H
#define LIMNER_VIEW_WINDOW_H

#include <adwaita.h>

#include "artist.h"
#include "document.h"

#define VIEW_WINDOW_TYPE (view_window_get_type())
G_DECLARE_FINAL_TYPE(ViewWindow, view_window, LIMNER, VIEW_WINDOW, AdwApplicationWindow)

ViewWindow *view_window_new(AdwApplication *application);

/* Reads files and shows them when they are there. */
void view_window_open(ViewWindow *w, const char *const *paths);

/* Shows what was shown when a window was closed last. */
void view_window_go_on(ViewWindow *w);

/* Draws with this look, or says why it cannot. */
void view_window_set_look(ViewWindow *w, const char *name_or_path);

/* A short message over the picture. */
void view_window_say(ViewWindow *w, const char *text);
void view_window_say_error(ViewWindow *w, const lmn_error *error);

/* Of these the window consists; for its panels and dialogs. */
document *view_window_document(ViewWindow *w);
artist   *view_window_artist(ViewWindow *w);
void      view_window_picture_size(ViewWindow *w, int *width, int *height);
/* Comes as near as fills the picture, soon; `what` as cameras_fit takes it. */
void view_window_fit(ViewWindow *w, const char *what);

#endif
