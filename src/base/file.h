/* Whole files: reading into memory, and what their names say. */
#ifndef LIMNER_BASE_FILE_H
#define LIMNER_BASE_FILE_H

#include "base/error.h"

/* A file's bytes. `data` has one NUL byte behind `size`. */
typedef struct file_data {
    const unsigned char *data;
    size_t               size;
} file_data;

/* Reads a regular file into memory: a mapping would end the process when somebody cuts the file off meanwhile.
 * Messages name the file; errors: LMN_READ (missing, a directory, not allowed), LMN_LIMIT, LMN_MEMORY. End with
 * file_data_release. */
lmn_status file_load(file_data *out, const char *path, lmn_error *error);
void       file_data_release(file_data *data);
/* Gives back the memory of all but the first `size` bytes, which may move. */
void file_data_cut(file_data *data, size_t size);

/* The ending of a path in lower case with its dot (".glb"), "" when there is none; at most size−1 characters. */
void file_ending(const char *path, char *out, size_t size);

/* `folder of path` + name, allocated; NULL when memory is gone. An absolute name is returned as it is. */
char *file_beside(const char *path, const char *name);

#endif
