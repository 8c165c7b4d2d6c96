/* Evaluation of solids on the GPU: which surface of the result of their set operations lies at which pixel. Three
 * ways: lists (solids.c), products of convex operands (convex.c), a sweep over operands (sweep.c). */
#ifndef LIMNER_SOLIDS_SOLIDS_H
#define LIMNER_SOLIDS_SOLIDS_H

#include "gpu/profile.h"
#include "plan/camera.h"
#include "stage/upload.h"

/* What they are evaluated for. All lent. */
typedef struct solid_view {
    gpu               *g;
    const upload      *up;
    const view_camera *camera;
    int                width, height; /* of the page */
    gpu_texture       *page_depth;
    gpu_profile       *profile;
} solid_view;

/* The surfaces of solids, layer after layer: what the evaluation of their trees found. */
typedef struct solid_layers {
    bool          ready;
    bool          first_only; /* nothing behind the nearest was looked for */
    int           box[4];     /* pixels where solids can be */
    double        near;       /* that the surfaces' depths are measured from */
    int           count;      /* layers there are */
    int           index;      /* of the current one */
    gpu_texture  *surfaces;   /* of the current layer: (any), depth, key, normal */
    gpu_texture  *nearest;    /* of layer 0 */
    gpu_texture **kept;       /* all of them, when they did not fit into one list; else NULL */
    gpu_texture  *depth;      /* of the surfaces that products of convex operands have; NULL: none */
    gpu_texture  *planes;
    uint32_t     *first_planes; /* per item: of its planes among them */
    gpu_buffer   *heads, *nodes, *chain, *counter;
} solid_layers;

typedef struct solid_options {
    int32_t evaluation; /* layer_evaluation */
    int     layers;     /* at most */
    bool    first_only; /* opaque: what lies behind the nearest is not asked for */
} solid_options;

/* Finds the surfaces of the solids among the wanted items (one a draw item). Errors stick to the GPU. */
void solids_open(const solid_view *v, solid_layers *s, const bool *wanted, const solid_options *options);
/* Makes layer `index` current; layers are asked for in order, from any number to the next or from 0. */
void solids_select(const solid_view *v, solid_layers *s, int index);
void solids_release(gpu *g, solid_layers *s);
/* Uniforms of csg/depth.glsl. */
void solids_set_depth(const solid_view *v, const solid_layers *s);

#endif
