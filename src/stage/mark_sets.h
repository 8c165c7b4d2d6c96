/* Marks on the surfaces of figures, on the GPU: kept with the upload as long as what they are made from stays the
 * same. */
#ifndef LIMNER_STAGE_MARK_SETS_H
#define LIMNER_STAGE_MARK_SETS_H

#include "gpu/gpu.h"
#include "marks/clusters.h"
#include "marks/marks.h"
#include "pose/pose.h"
#include "technique/technique.h"

/* The marks of one figure. */
typedef struct mark_set {
    uint64_t            key, used; /* of what they are made from; when they were drawn last */
    gpu_marks          *marks;     /* NULL: there are none */
    double              origin[3];
    double              density;  /* dots to a unit of area */
    mark_clusters       clusters; /* in whose order they are */
    size_t              count;
    bool                lines;
    int                 levels; /* of lines that flow */
    double              apart;  /* of those, where only the first level is there */
    double              sag;    /* how far pieces may leave the surface */
    moment              when;   /* of the pose that they are in */
    marks              *made;   /* as they are at rest, on `ground`, of scenes that move; NULL: it does not */
    struct mark_ground *ground;
} mark_set;

typedef struct mark_sets mark_sets;

typedef struct mark_set_options {
    const pose          *pose;
    const bool          *parts; /* per part: is marked */
    size_t               part_count;
    double               crease_angle;
    const technique_use *surface; /* whose marks they are */
    bool                 points;  /* dots are drawn as points */
} mark_set_options;

/* Finds or makes a set; that which was not drawn for longest goes. *slot is made when it is NULL. NULL after an
 * error, which sticks to the GPU. */
mark_set *mark_sets_find(mark_sets **slot, gpu *g, const mark_set_options *options);
void      mark_sets_release(mark_sets **all, gpu *g);

#endif
