/* Inside the import folder: the header of a PLY file and reading its values. */
#ifndef LIMNER_IMPORT_PLY_H
#define LIMNER_IMPORT_PLY_H

#include "import/import.h"

typedef enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64
} ply_type;

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE, PLY_BIG } ply_encoding;

enum { PLY_NAME_SIZE = 64 };

typedef struct ply_property {
    char     name[PLY_NAME_SIZE];
    ply_type type, count_type; /* count_type PLY_NONE: a single value */
} ply_property;

typedef struct ply_element {
    char          name[PLY_NAME_SIZE];
    uint64_t      count;
    ply_property *properties;
    size_t        property_count, property_capacity;
} ply_element;

typedef struct ply_reader {
    const import_job *job;
    lmn_error        *error;
    ply_encoding      encoding;
    ply_element      *elements;
    size_t            element_count, element_capacity;
    const char       *begin, *at, *end;
    bool              lone_returns; /* lines end with CR alone: a LF behind one is data */
    const char       *texture;      /* in the file's bytes, of a "comment TextureFile NAME" */
    size_t            texture_length;
} ply_reader;

size_t ply_type_size(ply_type type);
/* Reads the header and leaves `at` on the first byte of the data. */
lmn_status ply_read_header(ply_reader *r);
void       ply_release(ply_reader *r);
/* One value at `at`, as a number. The caller has checked that a binary file has the bytes left. False in a text
 * file without a number there. */
bool ply_read_value(ply_reader *r, ply_type type, double *out);
/* The error for data that ends or goes wrong in a row of an element. */
lmn_status ply_bad_row(const ply_reader *r, const ply_element *e, uint64_t row, const char *what);

#endif
