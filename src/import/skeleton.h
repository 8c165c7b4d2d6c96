/* Inside the import folder: straight skeletons of outlines with holes, as roofs of one slope have them (Aichholzer
 * et al. 1995): every edge moves inwards as fast as all others; where the corners between them
 * go are the arcs, and what an edge passes over is its face. */
#ifndef LIMNER_IMPORT_SKELETON_H
#define LIMNER_IMPORT_SKELETON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SKELETON_CORNERS_MAX = 2048 };

/* Time is how far the edges have moved, and so the height of a roof that rises by one in one. */
typedef struct skeleton_node {
    double x, y, time;
} skeleton_node;

/* Edge k leaves corner k of the outline, which is node k, and ends at corner ends[k]. Its face is the edge and, from
 * its end back to its beginning, the nodes face_nodes[face_ends[k − 1]] … face_nodes[face_ends[k] − 1]. */
typedef struct skeleton {
    skeleton_node *nodes;
    uint32_t      *ends, *face_ends, *face_nodes;
    bool          *upright; /* faces that whoever has the skeleton has moved out over their edge: they cover nothing */
    size_t         corner_count, node_count;
    double         size, top; /* the longer side of the outline's box; the latest time */
} skeleton;

typedef enum skeleton_status {
    SKELETON_MADE,
    SKELETON_NOT_SIMPLE, /* the outline crosses or touches itself, or has too many corners */
    SKELETON_FAILED,     /* what came out does not cover the outline */
    SKELETON_NO_MEMORY
} skeleton_status;

/* Of an anticlockwise outline and clockwise holes, ring k of counts[k] positions, one ring behind the other. Exactly
 * three faces meet in each node that is no corner: where more meet in truth, there are several nodes as good as one
 * above the other, which skeleton_join makes one. To be released also when it was not made. */
skeleton_status skeleton_make(skeleton *out, const double (*positions)[2], const size_t *counts, size_t rings);
void            skeleton_release(skeleton *s);

/* Nodes in one face that are nearer to each other than this become one, unless faces would then no longer fit together:
 * then all stays. False when memory is gone. */
bool skeleton_join(skeleton *s, double tolerance);

/* Where a face's nodes begin. */
static inline uint32_t skeleton_face_first(const skeleton *s, uint32_t edge)
{
    return edge ? s->face_ends[edge - 1] : 0;
}

/* skeleton_check.c */
/* Does no edge cross or touch another one but where it goes on, and do holes lie inside? `ends` as above. */
bool skeleton_is_simple(const double (*positions)[2], const uint32_t *ends, const size_t *counts, size_t rings);
/* Do the faces cover the outline, each of them once, and lie in planes of slope one over their edges? */
bool skeleton_covers(const skeleton *s);

#endif
