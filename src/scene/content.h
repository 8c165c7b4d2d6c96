/* Changing a scene after it was made: what must stay true of it (counts, the list of parts, bounds, revisions) is
 * brought up to date here. Solids have csg_tree/edit.h. On any error the scene is unchanged. */
#ifndef LIMNER_SCENE_CONTENT_H
#define LIMNER_SCENE_CONTENT_H

#include "scene/scene.h"

/* Makes the list of parts anew, unless changes are open; then it is made when they end. Errors: LMN_MEMORY. */
lmn_status scene_list_parts(lmn_scene *scene, lmn_error *error);

/* Between these the list of parts waits. Errors: LMN_MEMORY (then changes stay open), LMN_USAGE (none are open). */
void       scene_begin_changes(lmn_scene *scene);
lmn_status scene_end_changes(lmn_scene *scene, lmn_error *error);
/* Ends them with the list of parts as it was: for who has taken out again all that was added. Cannot fail. */
void scene_drop_changes(lmn_scene *scene);

/* Appends a node, whose references are in range, below its parent, and takes it over: what it holds is freed with the
 * scene, or by the caller when this fails. Errors: LMN_LIMIT, LMN_FORMAT (it lies too far out), LMN_MEMORY. */
lmn_status scene_add_node(lmn_scene *scene, const node *wanted, lmn_error *error);

/* Moves a node. Errors: LMN_FORMAT (something would lie too far out), LMN_MEMORY. */
lmn_status scene_move_node(lmn_scene *scene, int32_t node_index, const mat4 *matrix, lmn_error *error);

/* Takes over an array of `count` instances (NULL with 0). Errors: as above, and LMN_LIMIT; then it is the caller's. */
lmn_status scene_set_instances(lmn_scene *scene, int32_t node_index, mat4 *instances, size_t count, lmn_error *error);

/* Takes a node and all below it out: empty nodes stay, so that indices hold. Errors: LMN_USAGE (a solid is there),
 * LMN_MEMORY. */
lmn_status scene_remove_node(lmn_scene *scene, int32_t node_index, lmn_error *error);

void scene_hide_node(lmn_scene *scene, int32_t node_index, bool hidden);
/* Is a node hidden, or one above it? */
bool scene_is_hidden(const lmn_scene *scene, int32_t node_index);

/* What the nearest node on the way to the root that states the key says, so that what a file says about an assembly
 * holds for its parts. Lent; NULL: none states it. */
const char *scene_attribute_of(const lmn_scene *scene, int32_t node_index, const char *key);

/* Sets an attribute (value NULL: takes it away); copies both. Errors: LMN_MEMORY. */
lmn_status scene_set_attribute(lmn_scene *scene, int32_t node_index, const char *key, const char *value,
                               lmn_error *error);

/* Checks that vertices and triangles of all meshes stay within limits when `index` (NONE: a new one) holds `wanted`.
 * Errors: LMN_LIMIT. */
lmn_status scene_check_mesh(const lmn_scene *scene, int32_t index, const primitive *wanted, lmn_error *error);

/* Puts a primitive into a mesh of the scene in place of what it has, and takes it over. Errors: LMN_FORMAT (too far
 * out), LMN_MEMORY; then it is the caller's. */
lmn_status scene_exchange_mesh(lmn_scene *scene, int32_t index, const primitive *wanted, lmn_error *error);

/* Exchanges positions and normals of a mesh of one primitive, and takes them over (normals may be NULL). Errors: as
 * above. */
lmn_status scene_exchange_positions(lmn_scene *scene, int32_t index, vec3 *positions, vec3 *normals, lmn_error *error);

#endif
