/* Inside the import folder: what an IFC file says in words. The library that makes its shapes takes the spaces out of
 * names, and leaves out what it cannot make without a word. */
#ifndef LIMNER_IMPORT_IFC_TEXT_H
#define LIMNER_IMPORT_IFC_TEXT_H

#include "base/error.h"

enum { IFC_GUID = 22, IFC_FACTS = 4 };

/* What has an identity: products, storeys, the project. */
typedef struct ifc_thing {
    char     guid[IFC_GUID];
    uint64_t number;      /* #12 */
    char    *type, *name; /* "IFCWALL"; NULL: it has none */
    bool     shaped;      /* it should be drawn: no space, no opening */
} ifc_thing;

typedef struct ifc_text {
    ifc_thing *things; /* by identity */
    size_t     count, capacity;
    char      *facts[IFC_FACTS]; /* title, author, organisation, date of the header; NULL: it says none */
} ifc_text;

/* Reads what of it can be read: text that is damaged says less. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status ifc_text_read(ifc_text *out, const char *bytes, size_t size, lmn_error *error);
void       ifc_text_release(ifc_text *t);

/* The last of a node's letters are its identity. NULL: it has none that the file knows. */
const ifc_thing *ifc_text_find(const ifc_text *t, const char *node_name);

#endif
