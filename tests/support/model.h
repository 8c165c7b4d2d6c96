/* Shapes as model files. */
#ifndef TRUTH_MODEL_H
#define TRUTH_MODEL_H

#include "shape.h"

/* Binary PLY (with normals when every part has them) and binary STL; all parts as one mesh. */
bool model_write_ply(const char *path, const shape *s);
bool model_write_stl(const char *path, const shape *s);

/* GLB with one node, mesh and material a part; textures embedded as PNG. */
bool model_write_glb(const char *path, const shape *s);

#endif
