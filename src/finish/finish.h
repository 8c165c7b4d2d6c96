/* The kind "finish": the sheet the drawing is on. */
#ifndef LIMNER_FINISH_FINISH_H
#define LIMNER_FINISH_FINISH_H

#include "technique/technique.h"

extern const kind kind_finish;

/* The parameters, read by src/draw when it lays out the page. */
typedef struct sheet_values {
    colour ground;
} sheet_values;

#endif
