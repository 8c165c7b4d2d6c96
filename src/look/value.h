/* Parameter values as JSON. */
#ifndef LIMNER_LOOK_VALUE_H
#define LIMNER_LOOK_VALUE_H

#include <jansson.h>

#include "technique/param.h"

/* Sets a field from text; selectors are checked too. Errors: LMN_USAGE, LMN_MEMORY. */
lmn_status value_set_text(const param *p, void *values, const char *given, lmn_error *error);

/* Sets a field from a JSON value of the parameter's own type. Errors: LMN_USAGE (key, value and range), LMN_MEMORY. */
lmn_status value_set_json(const param *p, void *values, const json_t *json, lmn_error *error);

/* The field as JSON that value_set_json takes; NULL when memory is gone. */
json_t *value_json(const param *p, const void *values);

/* A number without the noise of binary fractions: whole ones as integers. */
json_t *value_number(double number);

/* JSON as text, allocated with mem_alloc, ends in a newline; takes over the reference (NULL gives NULL). */
char *value_text(json_t *json);
/* The same with as many digits as give the same doubles again, and no more; value_text has those of floats. */
char *value_text_exact(json_t *json);

#endif
