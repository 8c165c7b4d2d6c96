/* The limits that callers set (limner/limits.h), a row each. */
#ifndef LIMNER_BASE_LIMIT_ROWS_H
#define LIMNER_BASE_LIMIT_ROWS_H

#include "limner/limits.h"

typedef enum limit_kind { LIMIT_SECONDS, LIMIT_BYTES, LIMIT_COUNT } limit_kind;

typedef struct limit_row {
    const char *name;
    limit_kind  kind;
    size_t      at; /* in lmn_limits */
    double      standard, safe;
    const char *doc;
} limit_row;

extern const limit_row limit_rows[];
extern const size_t    limit_row_count;

void limit_put(lmn_limits *limits, const limit_row *row, double value);

#endif
