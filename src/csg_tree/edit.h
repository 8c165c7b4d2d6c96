/* Editing solids in a scene: what a tree needs to stay true (boxes, counts, parts, revisions) is brought up to date
 * with each edit. Every function leaves the scene as it was when it fails. Nodes are given by their positions in the
 * solid; ids outlast edits, positions do not. Row K09. */
#ifndef LIMNER_CSG_TREE_EDIT_H
#define LIMNER_CSG_TREE_EDIT_H

#include "scene/solid.h"

/* Appends a solid and a root node of the scene that draws it. *out: which of the scene's solids. */
lmn_status solid_edit_create(lmn_scene *scene, solid_kind root, const char *name, size_t *out, lmn_error *error);

/* What is added. */
typedef struct solid_addition {
    solid_kind  kind;
    mesh       *mesh; /* operand: moved into the scene, released when that fails; empty afterwards */
    mat4        matrix;
    const char *name; /* copied; NULL: none */
} solid_addition;
/* As the last child of `parent`. */
lmn_status solid_edit_add(lmn_scene *scene, size_t index, int32_t parent, const solid_addition *what, uint32_t *id,
                          lmn_error *error);
/* A node with all below once more, as the last child of `parent`; meshes are shared. */
lmn_status solid_edit_copy(lmn_scene *scene, size_t index, int32_t parent, int32_t source, uint32_t *id,
                           lmn_error *error);
/* A union, described by `what`, of all solids of another scene, which gives away their meshes. */
lmn_status solid_edit_graft(lmn_scene *scene, size_t index, int32_t parent, lmn_scene *from, const solid_addition *what,
                            uint32_t *id, lmn_error *error);

/* Moved into the scene, released when that fails; empty afterwards. */
lmn_status solid_edit_set_mesh(lmn_scene *scene, size_t index, int32_t node, mesh *shape, lmn_error *error);
lmn_status solid_edit_set_matrix(lmn_scene *scene, size_t index, int32_t node, const mat4 *matrix, lmn_error *error);
void       solid_edit_set_colour(lmn_scene *scene, size_t index, int32_t node, const vec4 *colour); /* NULL: none */
lmn_status solid_edit_set_shown(lmn_scene *scene, size_t index, int32_t node, bool shown, lmn_error *error);
lmn_status solid_edit_set_operation(lmn_scene *scene, size_t index, int32_t node, solid_kind kind, lmn_error *error);
lmn_status solid_edit_set_name(lmn_scene *scene, size_t index, int32_t node, const char *name, lmn_error *error);

/* Removes a node with all below; the root takes the solid with it. Meshes that nothing uses any longer are freed. */
lmn_status solid_edit_remove(lmn_scene *scene, size_t index, int32_t node, lmn_error *error);
/* Under `parent`, in front of its child `before` (NONE: last). */
lmn_status solid_edit_move(lmn_scene *scene, size_t index, int32_t node, int32_t parent, int32_t before,
                           lmn_error *error);

#endif
