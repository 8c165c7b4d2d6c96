/* The container of a .glb file: a header, the JSON, the bytes. */
#ifndef EXAMPLES_GLB_H
#define EXAMPLES_GLB_H

#include <stdbool.h>
#include <stddef.h>

/* `bytes` come in fours. False when the file cannot be written. */
bool glb_write(const char *path, const char *json, size_t json_size, const char *bytes, size_t byte_count);

#endif
