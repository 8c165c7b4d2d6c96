/* Whole files: writing so that a file appears whole or not at all. What is written neither ends the process by a
 * signal (SIGPIPE, SIGXFSZ) nor changes how it handles them. */
#ifndef LIMNER_BASE_FILE_STORE_H
#define LIMNER_BASE_FILE_STORE_H

#include "base/error.h"

/* Writes bytes where no name shows them and gives them their name when they are on the disk. Links are followed,
 * dangling ones too; path "-" is standard output; devices and pipes are written straight, and a pipe without a
 * reader is waited for. Messages name the file; errors: LMN_WRITE, LMN_CANCELLED. */
lmn_status file_store(const char *path, const void *data, size_t size, lmn_error *error);

/* The same for what can be made again: whatever has the name is replaced, be it a link or a pipe, and nobody waits
 * for the disk. Errors: LMN_WRITE. */
lmn_status file_replace(const char *path, const void *data, size_t size, lmn_error *error);

/* Makes a folder and its parents; an existing one is fine. Errors: LMN_WRITE. */
lmn_status file_make_folder(const char *path, lmn_error *error);

#endif
