/* Whether a test shall take less of its input: with sanitizers, which look at memory. What is left walks every path of
 * the code; the whole input is read without them. tests/CMakeLists.txt sets the variable. */
#ifndef SMALL_INPUT_H
#define SMALL_INPUT_H

#include <stdbool.h>
#include <stdlib.h>

static inline bool small_input(void)
{
    return getenv("LIMNER_TEST_SMALL") != NULL;
}

#endif
