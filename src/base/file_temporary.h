/* Names of files and folders that are there only while something is made. A name says whose it is, so that what a
 * killed process left behind can be told from what another one is at. */
#ifndef LIMNER_BASE_FILE_TEMPORARY_H
#define LIMNER_BASE_FILE_TEMPORARY_H

#include <stdbool.h>
#include <stddef.h>

enum { TEMPORARY_NAME_CAPACITY = 256 };

/* "STEMlimner-HOST-PROCESS-RANDOM". The stem is cut where the name would be longer than file systems take. */
void temporary_name(char out[TEMPORARY_NAME_CAPACITY], const char *stem);

/* Removes the files ".….limner-…" of an open folder whose process is gone: regular ones, of the same user, made on
 * the same host. */
void temporary_sweep(int folder);

/* Makes an empty folder for this user alone in TMPDIR, else /tmp, and removes those that processes left there which
 * are gone. False when it cannot be made; errno says why. */
bool temporary_folder_make(char *out, size_t capacity);
/* Removes it with the files in it. */
void temporary_folder_remove(const char *path);

#endif
