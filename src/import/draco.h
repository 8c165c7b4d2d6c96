/* Inside the import folder: Draco behind C functions. Draco itself is C++, optional, and runs behind the fence. */
#ifndef LIMNER_IMPORT_DRACO_H
#define LIMNER_IMPORT_DRACO_H

#include "fence/fence.h"

typedef struct draco_model draco_model;

bool draco_is_built(void);

/* Decodes a mesh; end it with draco_close (NULL is fine). Errors: LMN_FORMAT, LMN_LIMIT, LMN_MEMORY, LMN_CANCELLED. */
lmn_status draco_open(draco_model **out, const unsigned char *bytes, size_t size, lmn_error *error);
void       draco_close(draco_model *model);
size_t     draco_vertex_count(const draco_model *model);
size_t     draco_triangle_count(const draco_model *model);
void       draco_read_indices(const draco_model *model, uint32_t *out); /* 3 per triangle */
/* The attribute with this unique id as floats, `components` per vertex (a missing fourth is 1). `normalized`: integers
 * stand for 0 … 1 or −1 … 1. False when there is none. */
bool draco_read_attribute(const draco_model *model, uint32_t id, int components, bool normalized, float *out);

#endif
