/* Inside the import folder: files that a model names, and whether it may have them (limner/task.h, SECURITY.md). */
#ifndef LIMNER_IMPORT_ACCESS_H
#define LIMNER_IMPORT_ACCESS_H

#include "import/import.h"

/* Reads the file that `path` names: the model itself when `job` is NULL, else one that the job's model names
 * (`what`: "buffer", "texture" …; `path` is already relative to the file that names it). Errors: those of
 * file_load; LMN_READ with the hint how to allow it for one that the model may not have, and then *refused (may be
 * NULL) is set. */
lmn_status access_read(const import_job *job, const char *what, const char *path, file_data *out, bool *refused,
                       lmn_error *error);

/* May the model have this file, there or not? Errors: LMN_READ with the hint, LMN_MEMORY. */
lmn_status access_check(const import_job *job, const char *what, const char *path, lmn_error *error);

/* Is there such a file, and may the model have it? */
bool access_has(const import_job *job, const char *path);

#endif
