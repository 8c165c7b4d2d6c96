/* Limits: how much of the machine one call may use. Models come from anywhere, and a file of 50 bytes can ask for
 * hours and gigabytes. */
#ifndef LIMNER_LIMITS_H
#define LIMNER_LIMITS_H

#include "limner/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What one call that reads or draws may use. What exceeds it ends with LMN_LIMIT, a message that names the limit,
 * and a hint how to raise it. Begin with lmn_limits_standard or lmn_limits_safe. 0 means no limit, for `memory`
 * three quarters of the machine's. Fixed limits on the content of files come on top (docs/reference/limits.md). */
typedef struct lmn_limits {
    size_t   struct_size;
    double   time_s;    /* seconds by the clock that one call may take */
    uint64_t memory;    /* bytes that the call may hold more than when it began, and of each child process; the driver's
                           not counted */
    uint64_t triangles; /* of one scene, instances counted */
    uint64_t pixels;    /* of one picture, samples counted */
    uint64_t textures;  /* bytes of all decoded textures of one scene; beyond it the largest are halved */
} lmn_limits;

/* Generous limits, for files that one trusts; these hold where none are given. Any thread. */
LMN_API lmn_limits lmn_limits_standard(void);

/* Strict limits, for files from strangers on a server. Any thread. */
LMN_API lmn_limits lmn_limits_safe(void);

/* Sets limits from text such as "time=30s,memory=2G,triangles=5M"; units are s, min, h for time, k, M, G (1024 for
 * bytes, else 1000) for the rest, "none" is 0. On an error nothing has changed. Errors: LMN_USAGE. Any thread. */
LMN_API lmn_status lmn_limits_set(lmn_limits *limits, const char *text, lmn_error *error);

/* One limit by index from 0, for lists: its name, what it limits, its standard and safe value as text for people.
 * False when out of range. */
typedef struct lmn_limit_info {
    const char *name, *doc;
    char        standard[32], safe[32];
} lmn_limit_info;
LMN_API bool lmn_limit_at(size_t index, lmn_limit_info *out);

#ifdef __cplusplus
}
#endif
#endif
