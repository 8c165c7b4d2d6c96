/* Time: clips, play, a slider from frame to frame. Hidden for scenes where nothing moves. */
#ifndef LIMNER_VIEW_TIMELINE_H
#define LIMNER_VIEW_TIMELINE_H

#include <gtk/gtk.h>

#include "document.h"

GtkWidget *timeline_new(document *d);

/* Plays, or stops. */
void timeline_play(GtkWidget *timeline);

#endif
