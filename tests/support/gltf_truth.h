/* Where glTF 2.0 says that the corners of a model's triangles are at a time: a second reading of the specification, in
 * double precision, which shares no code with the library. For files with buffers in one .glb or beside a .gltf,
 * without sparse accessors, compression and instancing. */
#ifndef LIMNER_TESTS_GLTF_TRUTH_H
#define LIMNER_TESTS_GLTF_TRUTH_H

#include <stdbool.h>
#include <stddef.h>

typedef struct gltf_truth gltf_truth;

/* NULL when the file cannot be read; end with gltf_truth_destroy. */
gltf_truth *gltf_truth_load(const char *path);
void        gltf_truth_destroy(gltf_truth *t);

size_t gltf_truth_clip_count(const gltf_truth *t);
double gltf_truth_duration(const gltf_truth *t, size_t clip);
/* World positions of all triangles' corners, nodes depth first; free `out` with free. `clip` SIZE_MAX: at rest. */
size_t gltf_truth_corners(const gltf_truth *t, size_t clip, double seconds, double (**out)[3]);

#endif
