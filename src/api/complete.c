#include "api/complete.h"

#include <string.h>

#include "base/error.h"

lmn_status desc_complete(void *full, size_t size, const void *given, const char *macro, lmn_error *error)
{
    size_t given_size = 0;
    if (given)
        memcpy(&given_size, given, sizeof given_size);
    if (given_size < sizeof given_size || given_size > size) {
        if (given)
            error_set(error, LMN_USAGE, "struct_size is %zu, of what %s initialises it is %zu", given_size, macro,
                      size);
        else
            error_set(error, LMN_USAGE, "what %s initialises is NULL", macro);
        if (given_size > size)
            error_hint(error, "the program was built for a newer Limner: use its library");
        else
            error_hint(error, "initialise it with %s", macro);
        return LMN_USAGE;
    }
    memcpy(full, given, given_size);
    memcpy(full, &size, sizeof size);
    return LMN_OK;
}

lmn_status desc_complete_given(void *full, size_t size, const void *given, const char *macro, lmn_error *error)
{
    return given ? desc_complete(full, size, given, macro, error) : LMN_OK;
}
