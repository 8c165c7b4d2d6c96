/* Which edges are creases: by the feature that they are part of, not by their angle alone. */
#ifndef LIMNER_STROKE_CREASES_H
#define LIMNER_STROKE_CREASES_H

#include "stroke/edges.h"

/* While edges are sorted: convex. */
enum { EDGE_CONVEX = 1 << 16 };

/* What a file's normals say of an edge. */
typedef enum edge_shading { SHADED_UNKNOWN, SHADED_SMOOTH, SHADED_SPLIT } edge_shading;

/* A corner's normal, as it is compared with others; the second where the file gives none. */
uint32_t shading_pack(vec3 normal);
#define SHADING_NONE UINT32_MAX
/* What `packed`, the normals of all corners, says of each half-edge. NULL when memory is gone. Files in which all edges
 * are split, or none, tell nothing of which are sharp: *mixed is false. */
uint8_t *shading_judge(const edge_mesh *m, const uint32_t *opposite, const uint32_t *packed, bool *mixed);

typedef struct crease_facts {
    const uint32_t *opposite; /* per half-edge 3 · face + corner: the other one of an edge whose two faces agree which
                                 side is out, EDGE_NO_FACE elsewhere */
    const uint8_t *shading;   /* per half-edge: edge_shading; NULL: the file has no normals */
    bool           mixed;     /* some are smooth and some are split */
    double         angle;     /* radians: what turns by more may be a crease */
} crease_facts;

/* What is known of a mesh before its edges are. */
typedef struct crease_measure {
    double noise, mean_edge, size; /* radians, lengths; noise below 0: the mesh is no sampling */
} crease_measure;
/* Measures, and sets the mesh's `sampling`; asks for positions, faces and normals. False when memory is gone. */
bool creases_measure(crease_measure *out, edge_mesh *m, const crease_facts *facts);

/* Judges again which of a mesh's edges are creases. Those that come by angle alone stay, but not
 *   - where the file's normals go on smoothly;
 *   - in tessellated roundings: three steps or more in a row that turn alike;
 *   - in samplings of surfaces, scans for example: what their noise alone makes, or how they bend, or what is short.
 * Where a crease fades out, edges that turn by half of the angle belong to it. What the file says of edges (`said`)
 * stays. False when memory is gone. */
bool creases_judge(edge_mesh *m, const crease_facts *facts, const crease_measure *measured);

#endif
