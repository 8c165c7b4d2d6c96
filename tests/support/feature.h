/* The lines a perfect observer would draw, found on the mesh and not on a picture: silhouettes, borders, creases and
 * intersections, cut to what is visible; and the comparison of an edge map with them. */
#ifndef TRUTH_FEATURE_H
#define TRUTH_FEATURE_H

#include "trace.h"

typedef enum feature_class {
    FEATURE_SILHOUETTE,
    FEATURE_BORDER,
    FEATURE_CREASE,
    FEATURE_INTERSECTION,
    FEATURE_CLASSES
} feature_class;

extern const char *const feature_names[FEATURE_CLASSES];

/* A straight piece of line on the model and the two triangles it lies on. */
typedef struct feature {
    dvec          a, b;
    int64_t       triangles[2];
    feature_class kind;
} feature;

typedef struct feature_sample {
    float         x, y; /* pixels, row 0 on top */
    feature_class kind;
} feature_sample;

typedef struct feature_lines {
    feature        *edges;
    size_t          edge_count, edge_capacity, visible_edges; /* an edge is visible when some sample of it is */
    feature_sample *samples;
    size_t          sample_count, sample_capacity;
} feature_lines;

/* All visible lines in the view of the shot. `crease_degrees`: the least angle between normals that is a crease. */
void feature_find(feature_lines *out, const shape *s, const tracer *t, const shot *view, double crease_degrees);
void feature_release(feature_lines *f);

typedef struct feature_score {
    double recall, false_ink; /* shares */
    size_t samples, ink;
    double recall_of[FEATURE_CLASSES];
    size_t samples_of[FEATURE_CLASSES];
} feature_score;

/* Recall: the fraction of samples with ink within 1.5 px. False ink: the fraction of ink pixels farther than 2.5 px
 * from every sample. Writes a picture when `path` is not NULL: lines green, ink black, missed lines red, false ink
 * blue. */
feature_score feature_compare(const feature_lines *f, const shot *s, const char *path);

#endif
