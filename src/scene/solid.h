/* Solids: trees of set operations over closed meshes (constructive solid geometry). Nobody computes their surface:
 * drawing finds it pixel by pixel. Nienhaus et al. 2006, section 2; Nienhaus 2005, section 5.6. */
#ifndef LIMNER_SCENE_SOLID_H
#define LIMNER_SCENE_SOLID_H

#include "scene/scene.h"

/* An operand is a closed mesh; an operation has any number of operands in order. A union or intersection without
 * operands is empty, a difference takes all later operands from the first. */
typedef enum solid_kind { SOLID_OPERAND, SOLID_UNION, SOLID_INTERSECTION, SOLID_DIFFERENCE } solid_kind;

/* One node of the tree. Its position in the solid is parent · matrix. */
typedef struct solid_node {
    solid_kind kind;
    uint32_t   id; /* stays what it is when the tree is edited; from 1 on, which is the root's */
    int32_t    parent, first_child, last_child, next_sibling; /* NONE when absent */
    mat4       matrix;
    bool       has_colour; /* of all operands below that have no colour from above: the outermost decides */
    vec4       colour;     /* linear, straight alpha */
    bool       hidden;     /* it and all below are no operands, as if the tree were without them */
    int32_t    mesh;       /* operand: the scene's mesh, NONE: empty */
    char      *name;       /* "cylinder"; may be NULL */
    uint32_t   line;       /* of the file; 0: unknown */
    box3       box;        /* where it can be at most, solid's space; measured, as are the triangles; hidden: empty */
    uint64_t   triangles;  /* operand: its mesh's */
} solid_node;

typedef struct solid {
    solid_node *nodes; /* 0 is the root; parents come before their children. None: the solid was removed */
    size_t      node_count, node_capacity;
    int32_t    *positions; /* of ids, from 1 on: which node; NONE: removed */
    size_t      id_count, position_capacity;
    uint64_t    revision, triangles; /* a revision is for one content, as the scene's */
    size_t      operand_count;
    bool        ghost; /* what another one takes away; it follows that one's edits and is not edited itself */
} solid;

enum { SOLID_OPERANDS_MAX = 16383, SOLID_DEPTH_MAX = 4096 };
#define SOLID_FARTHEST 1e18f /* beyond, squares overflow in single precision */

/* Appends a solid with its root; NULL when memory is gone. A scene node draws it by its `solid`. */
solid *scene_append_solid(lmn_scene *scene, solid_kind root);
/* The same for what a solid takes away, a union; solids stay where they are in memory. */
solid *scene_append_ghost(lmn_scene *scene);
/* Appends a node as the last child: identity matrix, no colour, no mesh. Returns its index, NONE when memory is
 * gone. Pointers to nodes are valid until the next append. */
int32_t solid_append(solid *s, int32_t parent, solid_kind kind);
/* Takes back what was appended last, which has no children. */
void solid_take_back(solid *s);
void solid_release(solid *s);
/* Gives the solid of a node a companion, where it takes something away: below it a node "removed", marked as a
 * ghost, whose solid is the union of all that differences take away, whole subtrees, in the same positions and
 * colours. Meshes are shared. What is taken away from something that is taken away itself was never there and is
 * none of it. Once the solid is whole; false when memory is gone. */
bool scene_append_removed(lmn_scene *scene, int32_t node_index);
/* The same after an edit of solid `index`, which may have its companion already. False when memory is gone; then
 * that is as it was. */
bool scene_update_removed(lmn_scene *scene, size_t index);
/* The node after this one, depth first, within the tree below `top`; NONE at the end. */
int32_t solid_next(const solid *s, int32_t top, int32_t current);
/* The first operand of an operation that is not hidden itself, and the one after this one; NONE at the end. */
int32_t solid_first_shown(const solid *s, int32_t operation);
int32_t solid_next_shown(const solid *s, int32_t operand);
/* Is the node hidden, or anything above it? */
bool solid_is_hidden(const solid *s, int32_t node);

/* What boxes and counts say comes from here: scene_finish calls it once all meshes are there. False when memory is
 * gone. */
bool solid_measure(const lmn_scene *scene, solid *s);
/* After a change below a node: its operands' boxes again. False when one is not finite or lies farther than
 * SOLID_FARTHEST. */
bool solid_measure_below(const lmn_scene *scene, solid *s, int32_t top);
/* Boxes of operations and all counts, from the operands'. */
void solid_sum_up(solid *s);
/* The same when nothing but one operand has changed. */
void solid_sum_up_above(solid *s, int32_t operand);

/* An operand with all that stands above it in the tree folded in. */
typedef struct solid_operand {
    int32_t node, mesh;
    mat4    matrix; /* to the solid's space */
    bool    has_colour;
    vec4    colour;
    box3    box; /* solid's space */
} solid_operand;

/* The operands in the order of the tree that are shown and have a mesh with triangles; free with mem_free. False when
 * memory is gone. */
bool solid_operands(const solid *s, solid_operand **out, size_t *count);
/* Where the solid can be at most: boxes of operands, united, intersected, or that of the first. */
box3 solid_bounds(const solid *s);
/* Of what one instance of the node draws. */
uint64_t node_triangle_count(const lmn_scene *scene, const node *n);

#endif
