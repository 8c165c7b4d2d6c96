/* Whole files: reading into memory and writing so that a file appears whole or not at all. */
#ifndef LIMNER_BASE_FILE_H
#define LIMNER_BASE_FILE_H

#include "base/error.h"

/* A file's bytes. `data` has one NUL byte behind `size`. Mapped files are read-only. */
typedef struct file_data {
    const unsigned char *data;
    size_t               size;
    void                *mapping; /* private: NULL when `data` was allocated */
    size_t               mapping_size;
} file_data;

/* Reads a regular file (mapped when large). Messages name the file; errors: LMN_READ (missing, a directory, not allowed),
 * LMN_LIMIT, LMN_MEMORY. End with file_data_release. */
lmn_status file_load(file_data *out, const char *path, lmn_error *error);
void       file_data_release(file_data *data);

/* Writes bytes beside the path and renames them there; path "-" is standard output. Errors: LMN_WRITE. */
lmn_status file_store(const char *path, const void *data, size_t size, lmn_error *error);

/* Makes a folder and its parents; an existing one is fine. Errors: LMN_WRITE. */
lmn_status file_make_folder(const char *path, lmn_error *error);

/* The ending of a path in lower case with its dot (".glb"), "" when there is none; at most size−1 characters. */
void file_ending(const char *path, char *out, size_t size);

/* `folder of path` + name, allocated; NULL when memory is gone. An absolute name is returned as it is. */
char *file_beside(const char *path, const char *name);

#endif
