/* Inside the scene folder: the links of a solid's tree. */
#ifndef LIMNER_CSG_TREE_LINKS_H
#define LIMNER_CSG_TREE_LINKS_H

#include "scene/solid.h"

/* Where a node hangs. */
typedef struct solid_seat {
    int32_t parent, next_sibling; /* NONE: last */
} solid_seat;

/* Takes a node with all below out of its parent's children; it stays in the array. Returns where it was. */
solid_seat solid_unlink(solid *s, int32_t node);
void       solid_link(solid *s, int32_t node, solid_seat seat);
/* Puts all that hangs below the root, and nothing else, into new arrays in the order of the tree, so that parents
 * come before their children again. The arrays that were there, and names of what is left out, are the caller's
 * then. Errors: LMN_MEMORY, and nothing has changed. */
lmn_status solid_arrange(solid *s, lmn_error *error);

#endif
