/* Inside the import folder: how the child process that runs assimp hands a model over. Numbers are in the machine's order,
 * texts are a length and bytes; the reader trusts nothing. Order: 'M' or ('E' text) · animation count · materials · embedded
 * pictures · meshes · nodes (parents first) · 'Z'. */
#ifndef LIMNER_IMPORT_ASSIMP_STREAM_H
#define LIMNER_IMPORT_ASSIMP_STREAM_H

#include "import/import.h"

enum { STREAM_MODEL = 'M', STREAM_ERROR = 'E', STREAM_END = 'Z' };
enum { STREAM_NORMALS = 1, STREAM_UV0 = 2, STREAM_UV1 = 4, STREAM_COLOURS = 8 };

/* In the child: imports the file with assimp and writes the model to the descriptor. */
void assimp_child_write(const char *path, int descriptor);

/* In the parent: checks the bytes and fills the scene. */
lmn_status assimp_stream_read(const import_job *job, const unsigned char *bytes, size_t size, lmn_error *error);

#endif
