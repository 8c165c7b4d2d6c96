/* Look files of older versions. */
#ifndef LIMNER_LOOK_LOOK_VERSION_H
#define LIMNER_LOOK_LOOK_VERSION_H

#include <jansson.h>

#include "base/error.h"

/* Brings a document of version `from` to LOOK_VERSION. What is no look stays as it is: reading says what is wrong with
 * it. Errors: LMN_MEMORY. */
lmn_status look_bring_forward(json_t *root, json_int_t from, lmn_error *error);

#endif
