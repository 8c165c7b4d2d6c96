/* The cameras of the files. */
#ifndef LIMNER_VIEW_CAMERAS_H
#define LIMNER_VIEW_CAMERAS_H

#include <gio/gio.h>

#include "artist.h"
#include "document.h"

/* A menu of them, each an action "win.camera('NAME')"; empty when there are none. */
GMenu *cameras_menu(const scene_ref *scene);

/* Moves so that the picture, of this size, is filled by what is drawn, seen from the same side. `what` names the step
 * of undo; NULL: it is none, and only a view that nobody has changed since is replaced. Else as cameras_go. */
void cameras_fit(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                 const view_state *state, int width, int height, const char *what);

/* The same from where most is seen of what is shown. */
void cameras_best(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                  const view_state *state, int width, int height);

/* Looks through one. `owner` is held until it is done; `document` is asked for then, and may be NULL by that time. */
void cameras_go(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                const view_state *state, const char *name);

#endif
