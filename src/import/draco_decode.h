/* Inside the import folder: between Draco, which is C++, and draco.c. */
#ifndef LIMNER_IMPORT_DRACO_DECODE_H
#define LIMNER_IMPORT_DRACO_DECODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Where the decoder puts the answer; false stops it. */
typedef bool (*draco_put_fn)(void *to, const void *bytes, size_t size);

enum { DRACO_COMPONENTS = 4 };

/* What stands before each attribute's floats, DRACO_COMPONENTS a vertex. */
typedef struct draco_attribute {
    uint32_t id;
    float    range;      /* what integers of its type are divided by when they are normalised; 1 for the rest */
    uint32_t components; /* that it has; the others are 0, the fourth 1 */
} draco_attribute;

typedef enum draco_result { DRACO_DONE, DRACO_DAMAGED, DRACO_TOO_LARGE } draco_result;

/* Puts vertex count, triangle count and attribute count (uint32_t), three indices a triangle, and the attributes. */
draco_result draco_decode(const unsigned char *bytes, size_t size, draco_put_fn put, void *to);

#ifdef __cplusplus
}
#endif
#endif
