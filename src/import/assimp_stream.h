/* Inside the import folder: how assimp, behind the fence, hands a model over. Numbers are in the machine's order,
 * texts are a length and bytes; the reader trusts nothing. Order: 'M' or ('E' text) · animation count · materials ·
 * embedded pictures · meshes · nodes (parents first) · 'Z'. */
#ifndef LIMNER_IMPORT_ASSIMP_STREAM_H
#define LIMNER_IMPORT_ASSIMP_STREAM_H

#include "fence/fence.h"
#include "import/import.h"

enum { STREAM_MODEL = 'M', STREAM_ERROR = 'E', STREAM_END = 'Z' };
enum { STREAM_NORMALS = 1, STREAM_UV0 = 2, STREAM_UV1 = 4, STREAM_COLOURS = 8 };

/* Behind the fence. Request: the file's name, then its bytes. Answer: how many and which other files assimp asked
 * for, then the model. */
lmn_status assimp_read(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error);

/* Before it: the whole, from the job's file to its scene. */
lmn_status assimp_load(const import_job *job, lmn_error *error);

/* A part of that: checks the bytes and fills the scene. */
lmn_status assimp_stream_read(const import_job *job, const unsigned char *bytes, size_t size, lmn_error *error);

#endif
