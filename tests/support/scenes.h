/* Scenes with many surfaces behind each pixel, made from seeds: the same on every machine. All fit into a ball of
 * radius 2. */
#ifndef TRUTH_SCENES_H
#define TRUTH_SCENES_H

#include "shape.h"

typedef enum scene_kind {
    SCENE_CLOSED,     /* boxes, spheres and rings, turned and overlapping */
    SCENE_OPEN,       /* plates, hills, spheres with holes */
    SCENE_CROSSING,   /* long parts that all run through the middle and through each other */
    SCENE_COINCIDENT, /* faces of two parts in one plane, a part twice at one position, sheets that lie in one part
                       * twice
                       */
    SCENE_KINDS
} scene_kind;

extern const char *const scene_names[SCENE_KINDS];

void scene_make(shape *s, scene_kind kind, uint32_t seed);

/* The next of a sequence of numbers 0 … 1, and one between two bounds. */
double scene_random(uint32_t *state);
double scene_between(uint32_t *state, double low, double high);

/* A sphere whose triangles around the axis up to these degrees from both poles are missing, and those of every
 * third column. */
void scene_holed_sphere(shape *s, const char *name, double radius, int stacks, int slices, double pole_degrees);

/* The last part's triangles once more in the same part: the same way round, or turned (with turned normals). */
void scene_double(shape *s, bool turned);

/* A copy of a part under another name. */
void scene_copy(shape *s, size_t part, const char *name);

/* Adds the parts of another shape in the given order; order[k] is the index of the k-th. */
void scene_reorder(shape *out, const shape *s, const size_t *order);

/* Gives each part a colour of its own. */
void scene_colour(shape *s);

/* One small triangle at each of two positions, as one part that stretches the scene's box; to be kept out of the
 * picture. */
void scene_anchor(shape *s, const char *name, dvec low, dvec high);

#endif
