/* The picture as the window shows it: to the clipboard, and onto paper. */
#ifndef LIMNER_VIEW_PICTURE_OUT_H
#define LIMNER_VIEW_PICTURE_OUT_H

#include "window.h"

/* Drawn whole, whatever the window is showing just now. */
void picture_out_copy(ViewWindow *w);

/* Asks for a printer, and fills its page: lines are as wide on paper as the look says. */
void picture_out_print(ViewWindow *w);

#endif
