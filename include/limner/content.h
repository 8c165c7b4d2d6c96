/* Content of scenes from memory: meshes, materials, textures, nodes, skins, cameras and lights that a program makes
 * and changes from drawing to drawing, beside what files brought.
 *
 * A scene names its content by numbers from 1 on, each kind by itself; 0 is none. Numbers stay what they are, and that
 * of something removed is never given again. Arrays and texts are copied during the call. Lengths are in the scene's
 * unit, angles in degrees, colours in sRGB with straight alpha, 0 … 1, matrices column after column (a translation is
 * numbers 12, 13 and 14) with the last row 0 0 0 1. A scene that begins with content from memory has +Y up unless
 * lmn_scene_set_up says otherwise.
 *
 * On any error the scene is unchanged. Every function can fail with LMN_USAGE (a NULL, a number that is not there, a
 * value that is not finite or not in its range), LMN_LIMIT (docs/reference/limits.md) and LMN_MEMORY. A scene is
 * changed by one thread at a time and never while it is drawn; different scenes by different threads. No GL context
 * needed. All since 0.1. */
#ifndef LIMNER_CONTENT_H
#define LIMNER_CONTENT_H

#include "limner/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- meshes --------------------------------------------------------------------------------------------- */

/* Triangles of one material, or straight lines. Initialise with LMN_MESH_DESC_INIT. */
typedef struct lmn_mesh_desc {
    size_t          struct_size;
    const char     *name;      /* NULL: none */
    const float    *positions; /* 3 a vertex */
    const float    *normals;   /* 3 a vertex, of any length above 0; NULL: made where edges are smooth enough */
    const float    *uvs;       /* 2 a vertex; NULL: none */
    const float    *colours;   /* 4 a vertex; NULL: none */
    const uint16_t *joints;    /* 4 a vertex, numbers from 0 on in the node's skin; NULL: none */
    const float    *weights;   /* 4 a vertex, 0 or more and not all 0; with joints alone */
    size_t          vertex_count;
    const uint32_t *indices; /* of vertices, from 0 on: 3 a triangle, anticlockwise seen from outside; NULL with a count
                                of 0: as they come */
    size_t          index_count;
    const uint32_t *lines; /* of vertices: 2 a line, instead of triangles; NULL: triangles */
    size_t          line_index_count;
    uint32_t        material; /* 0: light grey, or white under colours */
} lmn_mesh_desc;
#define LMN_MESH_DESC_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_mesh_desc), NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, 0                        \
    }

/* Adds a mesh; nodes draw it. *mesh gets its number. */
LMN_API lmn_status lmn_scene_add_mesh(lmn_scene *scene, const lmn_mesh_desc *desc, uint32_t *mesh, lmn_error *error);

/* Exchanges all of a mesh, one from memory or one that a file brought as a single piece. */
LMN_API lmn_status lmn_scene_set_mesh(lmn_scene *scene, uint32_t mesh, const lmn_mesh_desc *desc, lmn_error *error);

/* Moves the vertices of such a mesh, as many as it has: for what deforms from picture to picture. Its triangles and
 * which of them share edges stay what they are. `normals`: NULL where it has none, or to have them made again. */
LMN_API lmn_status lmn_scene_set_positions(lmn_scene *scene, uint32_t mesh, const float *positions,
                                           const float *normals, size_t vertex_count, lmn_error *error);

/* --- materials and textures ----------------------------------------------------------------------------- */

/* Adds a picture for materials: RGBA, 8 bits, sRGB, straight alpha, row 0 on top; 1 … 16384 pixels a side. */
LMN_API lmn_status lmn_scene_add_texture(lmn_scene *scene, const char *name, int width, int height,
                                         const uint8_t *pixels, uint32_t *texture, lmn_error *error);

/* What surfaces are like. Initialise with LMN_MATERIAL_DESC_INIT. */
typedef struct lmn_material_desc {
    size_t      struct_size;
    const char *name; /* NULL: none */
    float       colour[4];
    uint32_t    texture;      /* multiplies the colour; 0: none */
    float       alpha_cutoff; /* what is less opaque is left out, 0 … 1; 0: nothing */
    bool        unlit;        /* wants no light */
} lmn_material_desc;
#define LMN_MATERIAL_DESC_INIT                                                                                         \
    {                                                                                                                  \
        sizeof(lmn_material_desc), NULL, {1, 1, 1, 1}, 0, 0, false                                                     \
    }

/* Adds a material; meshes name it. *material gets its number. */
LMN_API lmn_status lmn_scene_add_material(lmn_scene *scene, const lmn_material_desc *desc, uint32_t *material,
                                          lmn_error *error);

/* Exchanges all of a material, also of one that a file brought. */
LMN_API lmn_status lmn_scene_set_material(lmn_scene *scene, uint32_t material, const lmn_material_desc *desc,
                                          lmn_error *error);

/* --- cameras, lights and skins -------------------------------------------------------------------------- */

/* Looks along −z of its node, +y up. Initialise with LMN_CAMERA_DESC_INIT. */
typedef struct lmn_camera_desc {
    size_t      struct_size;
    const char *name; /* by which lmn_draw_desc.camera asks for it */
    bool        orthographic;
    double      fov_deg;     /* vertical, 1 … 170; perspective */
    double      half_height; /* above 0; orthographic */
} lmn_camera_desc;
#define LMN_CAMERA_DESC_INIT                                                                                           \
    {                                                                                                                  \
        sizeof(lmn_camera_desc), NULL, false, 30, 1                                                                    \
    }

/* Adds a camera; it is where a node with it is. *camera gets its number. */
LMN_API lmn_status lmn_scene_add_camera(lmn_scene *scene, const lmn_camera_desc *desc, uint32_t *camera,
                                        lmn_error *error);

typedef enum lmn_light_type { LMN_LIGHT_DIRECTIONAL = 0, LMN_LIGHT_POINT, LMN_LIGHT_SPOT } lmn_light_type;

/* Shines along −z of its node, or from its origin; used by looks that take the scene's lights. Initialise with
 * LMN_LIGHT_DESC_INIT. */
typedef struct lmn_light_desc {
    size_t         struct_size;
    const char    *name; /* NULL: none */
    lmn_light_type type;
    float          colour[3];
    float          intensity;              /* 0 or more */
    float          inner_cone, outer_cone; /* spot: degrees from the axis, 0 … 90, inner < outer */
} lmn_light_desc;
#define LMN_LIGHT_DESC_INIT                                                                                            \
    {                                                                                                                  \
        sizeof(lmn_light_desc), NULL, LMN_LIGHT_DIRECTIONAL, {1, 1, 1}, 1, 0, 45                                       \
    }

/* Adds a light; it shines where a node with it is. *light gets its number. */
LMN_API lmn_status lmn_scene_add_light(lmn_scene *scene, const lmn_light_desc *desc, uint32_t *light, lmn_error *error);

/* Adds a skin: nodes that move the vertices of skinned meshes, and for each the matrix from the mesh to the joint as
 * it is when nothing has moved (16 numbers a joint). At most 65535 joints. */
LMN_API lmn_status lmn_scene_add_skin(lmn_scene *scene, const uint32_t *joints, const double *inverse_binds,
                                      size_t joint_count, uint32_t *skin, lmn_error *error);

/* --- nodes ---------------------------------------------------------------------------------------------- */

/* Where something is. Initialise with LMN_NODE_DESC_INIT. */
typedef struct lmn_node_desc {
    size_t      struct_size;
    const char *name;   /* by which looks select it; NULL: none */
    uint32_t    parent; /* 0: none */
    uint32_t    mesh, camera, light, skin;
    double      matrix[16]; /* to the parent's axes */
} lmn_node_desc;
#define LMN_NODE_DESC_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_node_desc), NULL, 0, 0, 0, 0, 0,                                                                    \
        {                                                                                                              \
            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1                                                             \
        }                                                                                                              \
    }

/* Adds a node as the last child of its parent. With a mesh it is a part, and parts behind it are numbered anew. */
LMN_API lmn_status lmn_scene_add_node(lmn_scene *scene, const lmn_node_desc *desc, uint32_t *node, lmn_error *error);

/* The node of a part (lmn_part_info.id), also of one that a file brought; 0 when there is none. */
LMN_API uint32_t lmn_scene_node_of_part(const lmn_scene *scene, uint32_t part);

/* Moves a node and what is below it. Animations of files that move it win over this. */
LMN_API lmn_status lmn_scene_set_matrix(lmn_scene *scene, uint32_t node, const double matrix[16], lmn_error *error);

/* Draws a node's mesh at each of these positions in its own axes (16 numbers each) instead of once; 0: once. */
LMN_API lmn_status lmn_scene_set_instances(lmn_scene *scene, uint32_t node, const double *matrices, size_t count,
                                           lmn_error *error);

/* Hides a node and all below it, or shows it again. What is hidden is not drawn, hides nothing and is not fitted. */
LMN_API lmn_status lmn_scene_set_visible(lmn_scene *scene, uint32_t node, bool visible, lmn_error *error);

/* Gives a node an attribute, by which selectors find it: [KEY=VALUE]. A set of parts is an attribute that they have.
 * `value` NULL takes it away. */
LMN_API lmn_status lmn_scene_set_attribute(lmn_scene *scene, uint32_t node, const char *key, const char *value,
                                           lmn_error *error);

/* Takes a node and all below it out of the scene. Meshes stay, for other nodes. Nodes of solids go with
 * lmn_solid_remove. */
LMN_API lmn_status lmn_scene_remove_node(lmn_scene *scene, uint32_t node, lmn_error *error);

/* --- the whole ------------------------------------------------------------------------------------------ */

/* Which axis points up, Y or Z, in a scene without content yet. */
LMN_API lmn_status lmn_scene_set_up(lmn_scene *scene, lmn_up_axis up, lmn_error *error);

/* For many nodes at once: between begin and end parts are not numbered, and the scene cannot be drawn. Pairs nest. */
LMN_API lmn_status lmn_scene_begin_changes(lmn_scene *scene, lmn_error *error);
LMN_API lmn_status lmn_scene_end_changes(lmn_scene *scene, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
