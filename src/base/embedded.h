/* Files that travel inside the library: shaders (paths below src/) and looks (their names, without
 * ending). Tables end in a row of zeros. */
#ifndef LIMNER_BASE_EMBEDDED_H
#define LIMNER_BASE_EMBEDDED_H

#include <stddef.h>

typedef struct embedded_file {
    const char *path, *data; /* data has a NUL byte behind its size */
    size_t      size;
} embedded_file;

extern const embedded_file embedded_shaders[], embedded_looks[];
extern const size_t        embedded_shaders_count, embedded_looks_count;

#endif
