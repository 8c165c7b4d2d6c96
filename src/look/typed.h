/* Parameter values as numbers, colours and directions, and what a user interface asks of a parameter. */
#ifndef LIMNER_LOOK_TYPED_H
#define LIMNER_LOOK_TYPED_H

#include "look/look.h"

/* The value as value_set_text takes it; `out` holds LMN_VALUE_TEXT_MAX bytes. Only the type is checked here, and what
 * has no text. Errors: LMN_USAGE, beginning with the key. */
lmn_status typed_print_number(const param *p, double value, char *out, lmn_error *error);
lmn_status typed_print_colours(const param *p, const float *rgba, size_t count, char *out, lmn_error *error);
lmn_status typed_print_direction(const param *p, const double value[3], char *out, lmn_error *error);
lmn_status typed_print_auto(const param *p, char *out, lmn_error *error);

/* Errors: LMN_USAGE, it has another type. */
lmn_status typed_number(const param *p, const void *values, double *out, lmn_error *error);
lmn_status typed_colours(const param *p, const void *values, float *rgba, size_t *count, lmn_error *error);
lmn_status typed_direction(const param *p, const void *values, double out[3], lmn_error *error);

/* `k` and `t` are NULL for parameters of what is no technique. */
void typed_info(lmn_param_info *out, const kind *k, const technique *t, const param *p);
/* Does the parameter's condition hold for these values of its technique? */
bool typed_applies(const kind *k, const technique_use *use, const param *p);

#endif
