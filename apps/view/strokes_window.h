/* The window in which stroke textures are drawn by hand. */
#ifndef LIMNER_VIEW_STROKES_WINDOW_H
#define LIMNER_VIEW_STROKES_WINDOW_H

#include "window.h"

void strokes_window_open(ViewWindow *w);

#endif
