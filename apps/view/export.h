/* The dialog that writes pictures, vector drawings and films, and printing. */
#ifndef LIMNER_VIEW_EXPORT_H
#define LIMNER_VIEW_EXPORT_H

#include "window.h"

void export_open(ViewWindow *w);

#endif
