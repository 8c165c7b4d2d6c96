/* Inside the api folder: how a file is read. */
#ifndef LIMNER_API_LOAD_DESC_H
#define LIMNER_API_LOAD_DESC_H

#include "limner/scene.h"

/* What was given (NULL: nothing), and defaults for the rest. Errors: LMN_USAGE, in the caller's name. */
lmn_status load_desc_complete(lmn_load_desc *full, const lmn_load_desc *given, const char *caller, lmn_error *error);

#endif
