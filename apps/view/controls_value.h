/* Values of parameters between the library and widgets. No window. */
#ifndef LIMNER_VIEW_CONTROLS_VALUE_H
#define LIMNER_VIEW_CONTROLS_VALUE_H

#include <stdbool.h>
#include <stddef.h>

#include "limner/limner.h"

/* Where a number stands on a slider from 0 to 1, by the parameter's soft range and curve; outside it at an end. */
double slider_position(const lmn_param_info *info, double value);

/* The number at a position of the slider, rounded so that it is short to write. */
double slider_value(const lmn_param_info *info, double position);

/* "line width" from "line_width". */
void param_title(const char *key, char *out, size_t size);

/* "pt", "°"; "" for none. */
const char *param_unit_text(lmn_param_unit unit);

#endif
