/* What a wish would draw, small. */
#ifndef LIMNER_VIEW_EXPORT_PREVIEW_H
#define LIMNER_VIEW_EXPORT_PREVIEW_H

#include "command.h"
#include "window.h"

enum { EXPORT_PREVIEW_SIDE = 320 };

GtkWidget *export_preview_new(void);

/* Draws what the window shows now, when nobody has asked for anything else in a while. */
void export_preview_ask(GtkWidget *preview, ViewWindow *w, const export_wish *wish);

/* Nothing is to be drawn any more. */
void export_preview_end(GtkWidget *preview);

#endif
