/* What the files of a window share. */
#ifndef LIMNER_VIEW_WINDOW_PRIVATE_H
#define LIMNER_VIEW_WINDOW_PRIVATE_H

#include "session.h"
#include "tour.h"
#include "window.h"

struct _ViewWindow {
    AdwApplicationWindow parent;
    document            *document;
    artist              *artist;
    GtkWidget           *title, *picture, *status, *progress, *toasts, *gallery, *signs, *pages, *timeline;
    GCancellable        *loading; /* NULL: nothing is read */
    GStrv                loading_paths;
    bool                 reloads; /* the same files, seen from where one is */
    GPtrArray           *watches; /* of GFileMonitor */
    guint                reload, turntable;
    tour                *tour;
    GtkWidget           *left, *right; /* flaps around the picture */
    GMenu               *cameras, *recent;
    session              restored; /* until it is shown */
};

/* window_files.c */
gboolean window_dropped(GtkDropTarget *target, const GValue *value, double x, double y, gpointer window);
void     window_file_chosen(GtkNativeDialog *dialog, int response, gpointer window);
void     window_list_recent(ViewWindow *w);
void     window_stop_watch(gpointer monitor);
gboolean window_closing(GtkWindow *window, gpointer user);

/* window_actions.c */
void     window_add_actions(ViewWindow *w);
void     window_document_changed(document *d, unsigned changes, void *window);
gboolean window_somebody_acts(GtkEventControllerLegacy *events, GdkEvent *event, gpointer window);

#endif
