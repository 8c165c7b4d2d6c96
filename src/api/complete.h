/* Inside the api folder: descriptions as callers hand them over, who may be built against an older header. */
#ifndef LIMNER_API_COMPLETE_H
#define LIMNER_API_COMPLETE_H

#include <stddef.h>

#include "limner/error.h"

/* Copies what was given over `full`, which holds the standard of `size` bytes: what a shorter description lacks keeps
 * it. Both begin with struct_size. `macro` is what initialises it. Errors: LMN_USAGE (NULL, struct_size not set, or
 * larger than this library knows: its fields would be left out). */
lmn_status desc_complete(void *full, size_t size, const void *given, const char *macro, lmn_error *error);
/* The same where NULL stands for the standard. */
lmn_status desc_complete_given(void *full, size_t size, const void *given, const char *macro, lmn_error *error);

#endif
