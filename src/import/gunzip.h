/* Inside the import folder: files that are packed by gzip, whatever is in them. */
#ifndef LIMNER_IMPORT_GUNZIP_H
#define LIMNER_IMPORT_GUNZIP_H

#include "base/file.h"

/* Unpacks a file whose first bytes say that it is packed; others stay as they are. Several members one behind the other
 * are one file. `file` is released on an error, and its message names `path`. Errors: LMN_FORMAT (damaged, cut off),
 * LMN_LIMIT (more bytes than a file may have, or so many more than are packed that no model has them), LMN_MEMORY. */
lmn_status gunzip(file_data *file, const char *path, lmn_error *error);

/* file_ending of what is packed: ".json" of "town.json.gz". */
void gunzip_ending(const char *path, char *out, size_t size);

#endif
