/* A scene as strokes see it, for one set of parts that may hide lines: kept with the upload, made when first asked
 * for; the edges of its meshes on the GPU; and what the last camera saw of it. */
#ifndef LIMNER_STAGE_STROKE_STORE_H
#define LIMNER_STAGE_STROKE_STORE_H

#include "gpu/gpu.h"
#include "stroke/stroke.h"

/* Edges that may be lines for one viewer. */
typedef struct stroke_seen {
    gpu_marks *edges; /* NULL: not made yet */
    float      viewer[4];
} stroke_seen;

/* Lines of a view: each layer of a figure wants a part of them. Rules and layers with pens of their own ask for others,
 * in every frame again. */
enum { STROKES_FOUND_MOST = 4 };
typedef struct stroke_found {
    stroke_set     lines;
    stroke_options options;
    bool          *parts; /* NULL: nothing is kept here */
    uint64_t       asked; /* when last */
} stroke_found;

typedef struct stroke_store {
    bool             *parts; /* that the scene has; all that may hide lines */
    size_t            part_count;
    int32_t           refine;   /* how often its surfaces are */
    moment            when;     /* of its pose */
    uint64_t          revision; /* of its scene */
    stroke_scene      scene;
    stroke_topologies topologies; /* stay when another moment is asked for */
    gpu_marks       **edges;      /* per mesh of the scene; NULL: not made yet */
    float            *turns;      /* of such a mesh: strokes_gentlest_turn */
    gpu_marks       **crossings;  /* per item, the same */
    stroke_seen      *seen;       /* per item, of meshes that move */
    stroke_view      *view;       /* of the last camera; NULL: none */
    stroke_camera     camera;
    stroke_found      found[STROKES_FOUND_MOST]; /* in this view */
    uint64_t          asked;                     /* how often lines were */
} stroke_store;

typedef struct stroke_store_options {
    const pose           *pose;
    const bool           *hides; /* per part: may hide lines */
    size_t                part_count;
    double                crease_angle;
    int32_t               refine;
    const stroke_section *section; /* NULL: nothing is cut away */
} stroke_store_options;

/* What *slot holds when it is as wished, else a new one in its place; NULL after an error, which sticks to the GPU. */
stroke_store *stroke_store_find(stroke_store **slot, gpu *g, const stroke_store_options *options);
/* Where surfaces cross and how they bend does not depend on the view: it is found once. `crossings`: the parts that
 * have such lines, a flag each; NULL: nobody asks for them. Errors stick to the GPU. */
void stroke_store_fix(stroke_store *s, gpu *g, const bool *crossings, bool bends);
/* What the camera sees, unless that is there. Errors: those of stroke_view_create. */
lmn_status stroke_store_look(stroke_store *s, const stroke_camera *camera, lmn_error *error);
/* The lines of these parts in the last camera's view; the last few that were asked for are kept, and lent until others
 * are. Errors: those of stroke_find. */
lmn_status stroke_store_lines(stroke_store *s, const stroke_set **out, const stroke_options *options, const bool *parts,
                              lmn_error *error);
void       stroke_store_destroy(stroke_store **s, gpu *g);

#endif
