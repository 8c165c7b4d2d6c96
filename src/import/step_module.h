/* Inside the import folder: between OpenCASCADE, which is C++ and lies in a module of its own, and step.c. Numbers are
 * in the machine's order, texts are a length and bytes, lengths are millimetres; the reader trusts nothing. What the
 * module puts:
 *   - texts: the file's unit of length, its title, author, organisation and date, "" where it says none
 *   - float: by how much chords missed what was asked for (1: nothing)
 *   - step_losses
 *   - meshes: how many, and each: name; kinds of colours, how many, and each: flag and four floats (sRGB, straight
 *     alpha), vertices, indices (counts), positions, normals (floats), indices, a byte for each index, what the edge
 *     from this corner to the next is (step_edge); vertices, lines (counts), whether some are
 *     no edges of faces, positions, two indices a line
 *   - nodes, parents first: how many, and each: parent (STEP_NONE: a root), name, 16 doubles by columns, mesh or
 *     STEP_NONE */
#ifndef LIMNER_IMPORT_STEP_MODULE_H
#define LIMNER_IMPORT_STEP_MODULE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define STEP_NONE 0xffffffffu

/* Changes whenever what goes between the two does. */
enum { STEP_INTERFACE = 5 };

/* What the file is. */
typedef enum step_kind { STEP_KIND_STEP, STEP_KIND_IGES } step_kind;

/* What an edge of a triangle is: inside of a face, or along an edge of the solid that turns, or that does not. */
typedef enum step_edge { STEP_INSIDE = 1, STEP_SHARP = 2 } step_edge;

typedef enum step_result {
    STEP_DONE,
    STEP_DAMAGED,
    STEP_EMPTY,
    STEP_TOO_MUCH_MEMORY,
    STEP_TOO_MANY, /* triangles */
    STEP_NO_SIZE,  /* its unit makes it smaller or larger than can be drawn */
} step_result;

/* What the file names and cannot be had. Firsts are the file's own numbers (#12; of IGES lines of
 * its directory, D23), 0 when it has none. */
typedef struct step_losses {
    uint32_t damaged, first_damaged;  /* entities that refer to nothing, or to what does not fit */
    uint32_t faces, lost, first_lost; /* of the file; of them, those whose surface or border could not be made */
} step_losses;

/* Where the answer goes; false stops the module. */
typedef bool (*step_put_fn)(void *to, const void *bytes, size_t size);

typedef struct step_request {
    const unsigned char *bytes;
    size_t               size;
    step_kind            kind;
    double               deflection; /* millimetres; 0: a share of each part */
    uint64_t             most_triangles;
} step_request;

/* What the module is asked by: `limner_step_module`. */
typedef struct step_module {
    int         interface;
    const char *version;   /* of OpenCASCADE */
    void (*prepare)(void); /* opens what the library wants to open; once, before the fence */
    step_result (*read)(const step_request *request, step_put_fn put, void *to, char *message, size_t message_size);
} step_module;

#ifdef __cplusplus
}
#endif
#endif
