/* The version of the library. */
#ifndef LIMNER_VERSION_H
#define LIMNER_VERSION_H

#include "limner/error.h"

#define LMN_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif

/* The version the library was built as; static. */
LMN_API const char *lmn_version(void);

#ifdef __cplusplus
}
#endif
#endif
