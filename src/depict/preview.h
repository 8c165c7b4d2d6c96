/* The scene as it will be with its glyphs. */
#ifndef LIMNER_DEPICT_PREVIEW_H
#define LIMNER_DEPICT_PREVIEW_H

#include "depict/depict_private.h"

typedef struct preview {
    lmn_scene   scene; /* to be posed, and nothing else: what it has belongs to the job's scene */
    primitive  *primitives;
    node_place *places;
    char        key[sizeof NODE_GLYPH];
    attribute   mark; /* that all glyphs have */
} preview;

/* With the job's glyphs, which must stay, and without what these stand for. Errors: LMN_MEMORY. Release it also after
 * one. */
lmn_status preview_open(preview *out, const depict_job *j, const expression_list *expressions, lmn_error *error);
void       preview_release(preview *p);

#endif
