/* Scenes that move, made by tests: unlit boxes, spheres and cylinders whose nodes have keys, before a camera of their
 * own. */
#ifndef LIMNER_TESTS_MOVING_SCENE_H
#define LIMNER_TESTS_MOVING_SCENE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct moving_node {
    char *text; /* its JSON, without name, children and the brackets around it */
    char  name[32];
    int   parent; /* −1: none */
} moving_node;

typedef struct moving_scene {
    moving_node *nodes;
    char        *meshes, *materials, *accessors, *views, *channels, *samplers, *cameras;
    char        *bytes;
    size_t       byte_count;
    int          node_count, mesh_count, accessor_count, channel_count;
    bool         lit; /* set it before anything is added */
} moving_scene;

void moving_scene_begin(moving_scene *m);
/* Each adds a node at a position and returns its number. The colour is linear. */
int moving_scene_box(moving_scene *m, double x, double y, double z, const double half[3], const double colour[3]);
/* Of such a box the face towards +z alone. */
int moving_scene_plate(moving_scene *m, double x, double y, double z, const double half[3], const double colour[3]);
int moving_scene_sphere(moving_scene *m, double x, double y, double z, double radius, const double colour[3]);
/* Along z. */
int moving_scene_cylinder(moving_scene *m, double x, double y, double z, double radius, double half_length,
                          const double colour[3]);
/* A node without a mesh, for others to lie in. */
int moving_scene_joint(moving_scene *m, double x, double y, double z);
/* From now on the node lies in the other one's frame. */
void moving_scene_put_in(moving_scene *m, int node, int parent);
/* Instead of "node" and its number. */
void moving_scene_name(moving_scene *m, int node, const char *name);
/* Linear keys of a node: "translation" (3 numbers a key), "rotation" (4) or "scale" (3). */
void moving_scene_keys(moving_scene *m, int node, const char *path, int count, const double *times,
                       const double *values);
/* Cubic keys: three values each, the tangent before, the value itself, the tangent after. */
void moving_scene_cubic_keys(moving_scene *m, int node, const char *path, int count, const double *times,
                             const double *values);
/* The camera "eye", looks along −z: parallel, so that the page is 2 · size high, or size degrees high. Returns its
 * node.
 */
int moving_scene_camera(moving_scene *m, double x, double y, double z, bool orthographic, double size);
/* Writes a .glb and frees all. */
void moving_scene_write(moving_scene *m, const char *path);

#endif
