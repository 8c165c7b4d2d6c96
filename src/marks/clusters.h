/* Marks in clusters: those that lie near each other on faces that look the same way, so that what cannot be seen is
 * left out at once. Freudenberg 2003, section 5.4.6; row EX-30. Needs no GPU. */
#ifndef LIMNER_MARKS_CLUSTERS_H
#define LIMNER_MARKS_CLUSTERS_H

#include "marks/marks.h"

/* All lengths and positions are those of the marks. */
typedef struct mark_cluster {
    uint32_t first, count;    /* of the order */
    double   low[3], high[3]; /* around all that its marks cover */
    double   decided[2][3];   /* the same, lowest and highest, of the positions at which marks are decided */
    double   axis[3], spread; /* marks' normals are within this angle of the axis, radians */
    double   lean;            /* most of its marks' */
    double   steepest;        /* most cosine between a mark's normal and its own direction; 0: exactly across */
    double   density;         /* least length of strokes to a unit of area; of dots their number */
} mark_cluster;

typedef struct mark_clusters {
    mark_cluster *clusters;
    size_t        count;
    uint32_t     *order; /* numbers of marks, cluster after cluster; those that stay longest with distance first */
    float        *ranks; /* in that order: 1 − priority for distance */
    float        *leans; /* in that order: a mark whose normal turns away from the viewer by a larger cosine lies on a
                            face that turns away, too, though its normal leans off the face's */
    uint32_t *triangles; /* by the number of a mark: that it is decided on */
    size_t    mark_count;
    bool      solid; /* the surface is closed and looks outwards: what turns away is hidden */
} mark_clusters;

/* Groups dots, or lines. `s`: what the marks were made on. False when memory is gone: nothing is left to release. */
bool mark_clusters_make(mark_clusters *out, const marks *m, const mark_surface *s);
void mark_clusters_release(mark_clusters *c);
/* Measures them again after marks and surface have moved (marks_carry): who belongs together stays. */
void mark_clusters_measure(mark_clusters *c, const marks *m, const mark_surface *s);

/* Do its triangles enclose space, each piece of it by itself, with normals that look out? `parts`: per triangle, which
 * are pieces for themselves; NULL: one. False too when memory is gone. */
bool mark_surface_is_solid(const mark_surface *s, const uint32_t *parts);

/* Who looks at marks. */
typedef struct cluster_view {
    mat4   model_view, projection; /* the first without scale */
    bool   orthographic;
    double near;          /* depth */
    double focal;         /* of the projection: pixels at depth 1, or to a unit */
    int    width, height; /* of the page, pixels */
    double reach;         /* how far marks reach beyond their positions, pixels */
    bool   outside;       /* nothing of the surface is cut away, by the near plane or otherwise */
} cluster_view;

typedef enum cluster_fate { CLUSTER_SEEN, CLUSTER_BESIDE, CLUSTER_TURNED_AWAY } cluster_fate;
cluster_fate mark_cluster_fate(const mark_clusters *c, const mark_cluster *cluster, const cluster_view *view);

/* Most pixels to a unit of length across its marks, or to a unit of its area; INFINITY where it may reach the eye. */
double mark_cluster_scale(const mark_cluster *cluster, const cluster_view *view, bool area);

/* How many marks of a cluster, from its first on, have at most this rank. */
size_t mark_cluster_prefix(const mark_clusters *c, const mark_cluster *cluster, double rank);

#endif
