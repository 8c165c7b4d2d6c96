/* Whole files: writing so that a file appears whole or not at all. What is written neither ends the process by a
 * signal (SIGPIPE, SIGXFSZ) nor changes how it handles them. */
#ifndef LIMNER_BASE_FILE_STORE_H
#define LIMNER_BASE_FILE_STORE_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* Writes bytes where no name shows them and gives them their name when they are on the disk. Links are followed,
 * dangling ones too; path "-" is standard output; devices and pipes are written straight, and a pipe without a
 * reader is waited for. Messages name the file; errors: LMN_WRITE, LMN_CANCELLED. */
lmn_status file_store(const char *path, const void *data, size_t size, lmn_error *error);

/* The same for what can be made again: whatever has the name is replaced, be it a link or a pipe, and nobody waits
 * for the disk. Errors: LMN_WRITE. */
lmn_status file_replace(const char *path, const void *data, size_t size, lmn_error *error);

/* A file that is written piece by piece, here or by a child process, and gets its name when it is whole. */
typedef struct file_arrival file_arrival;

/* Begins one where the path leads: to a regular file, which is replaced at the end, or to nothing yet. Errors:
 * LMN_WRITE, LMN_MEMORY. */
lmn_status file_arrival_begin(file_arrival **out, const char *path, lmn_error *error);
/* Where the bytes go, from 0 on; a child process may open "/proc/self/fd/N" of it anew. */
int file_arrival_descriptor(const file_arrival *a);
/* Writes behind what was written so before. Errors: LMN_WRITE, LMN_CANCELLED. */
lmn_status file_arrival_write(file_arrival *a, const void *data, size_t size, lmn_error *error);
/* Puts it on the disk, gives it its name, and frees `*a` in any case. `bytes` may be NULL. Errors: LMN_WRITE. */
lmn_status file_arrival_end(file_arrival **a, uint64_t *bytes, lmn_error *error);
/* Leaves nothing of it. NULL and a pointer to NULL are accepted. */
void file_arrival_drop(file_arrival **a);

/* Makes a folder and its parents; an existing one is fine. Errors: LMN_WRITE. */
lmn_status file_make_folder(const char *path, lmn_error *error);

#endif
