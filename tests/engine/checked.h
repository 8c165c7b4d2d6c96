/* Calls that must succeed: DO(call) fails the test with the call and what its error says. */
#ifndef LIMNER_TESTS_CHECKED_H
#define LIMNER_TESTS_CHECKED_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "limner/limner.h"

static lmn_error error;

static inline void check(lmn_status status, const char *what)
{
    if (status != LMN_OK)
        fail_msg("%s: %s (%s)", what, error.message, error.hint);
}

#define DO(call) check(call, #call)

#endif
