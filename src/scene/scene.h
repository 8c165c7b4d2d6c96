/* The scene's data: what importers fill and everything else reads. Indices into the scene's arrays are int32_t,
 * NONE = −1. Angles are radians, colours linear RGBA, matrices column-major doubles acting on columns. */
#ifndef LIMNER_SCENE_SCENE_H
#define LIMNER_SCENE_SCENE_H

#include "base/colour.h"
#include "base/error.h"
#include "base/warnings.h"
#include "limner/scene.h"
#include "scene/city.h"
#include "scene/letterings.h"

enum { NONE = -1, UV_SETS = 2 };

typedef struct vec2 {
    float x, y;
} vec2;
typedef struct vec3 {
    float x, y, z;
} vec3;
typedef struct vec4 {
    float x, y, z, w;
} vec4;
typedef struct mat4 {
    double m[16];
} mat4;
typedef struct box3 {
    vec3 min, max;
} box3; /* empty: min > max */

/* One morph target: offsets per vertex, arrays NULL when absent. */
typedef struct morph_target {
    vec3 *positions, *normals;
} morph_target;

/* Which edges of a primitive a file wants shown (EXT_mesh_primitive_edge_visibility); kept for later. From EDGE_TURNED
 * on an edge is hard and has turned by edge_turn before the mesh was made round (scene/round.h). */
typedef struct edge_visibility {
    uint8_t *values; /* 3 per triangle, edge k runs from corner k to k+1: 0 hidden, 1 silhouette, 2 hard, 3 repeated */
} edge_visibility;

enum { EDGE_TURNED = 128, EDGE_TURNED_MOST = 255 };

/* Radians, of 0 to π. */
static inline uint8_t edge_turned(float turn)
{
    float steps = (float)(EDGE_TURNED_MOST - EDGE_TURNED), at = turn * (steps / 3.14159265f) + 0.5f;
    return (uint8_t)(EDGE_TURNED + (int)(at < 0 ? 0 : at > steps ? steps : at));
}

static inline float edge_turn(uint8_t value)
{
    return (float)(value - EDGE_TURNED) * (3.14159265f / (float)(EDGE_TURNED_MOST - EDGE_TURNED));
}

/* Triangles of one material, or lines. Vertices as the file has them; positions are always there, other arrays may be
 * NULL. Of triangles `indices` is always there, 3 per triangle, each < vertex_count; of lines `lines`, 2 per line. In a
 * mesh those with triangles come first. */
typedef struct primitive {
    uint32_t      vertex_count, index_count;
    uint32_t      influences; /* joints a vertex; 0 without joints */
    uint32_t      line_count; /* pairs */
    bool          edge_lines; /* they all run along edges of the mesh's triangles */
    int32_t       material;   /* NONE: the default material */
    bool          welded;     /* no two vertices lie at one position */
    vec3         *positions;
    vec3         *normals;  /* unit; NULL: made from the crease angle when drawn */
    vec3         *straight; /* where the vertices were in the world before a projection bent it; NULL: it is not bent */
    vec2         *uvs[UV_SETS];
    vec4         *colours; /* linear, straight alpha */
    uint16_t     *joints;  /* `influences` per vertex */
    float        *weights; /* of the joints, as many; those of a vertex sum to 1 */
    uint32_t     *indices;
    uint32_t     *lines; /* NULL: none, as where there are triangles */
    morph_target *morphs;
    size_t        morph_count;
    edge_visibility edges;
    box3            bounds; /* of positions; set by scene_finish */
} primitive;

typedef struct mesh {
    char      *name; /* may be NULL */
    primitive *primitives;
    size_t     primitive_count;
    float     *morph_weights; /* defaults, as many as the first primitive has morphs */
    size_t     morph_weight_count;
    uint64_t   revision; /* 0 as long as it is what was imported; another one for each content put here later */
    uint64_t   topology; /* the same for its vertices and triangles, wherever they are */
    bool       moved;    /* its vertices have other positions than those that it came with */
    bool       spare;    /* nothing uses it any longer; empty */
    size_t     twin; /* 1 + the number of a mesh that has the same content, but for materials, as long as both have the
                        same revision; 0: none is known */
} mesh;

typedef struct image {
    char    *name;
    uint32_t width, height;
    uint8_t *pixels;  /* RGBA, row 0 on top, NULL when it could not be decoded */
    char    *strokes; /* path of the stroke texture that stands for it in halftones; NULL: none */
} image;

typedef enum wrap_mode { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR } wrap_mode;

/* A use of an image by a material. uv' = offset + R(rotation)·scale·uv (KHR_texture_transform). */
typedef struct texture_use {
    int32_t   image; /* NONE: no texture */
    int32_t   uv_set;
    wrap_mode wrap_u, wrap_v;
    bool      nearest;
    float     offset[2], scale[2], rotation;
} texture_use;
#define TEXTURE_USE_NONE                                                                                               \
    {                                                                                                                  \
        NONE, 0, WRAP_REPEAT, WRAP_REPEAT, false, {0, 0}, {1, 1}, 0                                                    \
    }

typedef enum alpha_mode { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND } alpha_mode;

typedef struct material {
    char       *name;
    vec4        base_colour; /* linear, straight alpha */
    texture_use base_texture, normal_texture;
    float       normal_scale;
    float       emissive[3];
    float       shininess; /* Phong exponent the file asks for; 0 = the look decides */
    alpha_mode  alpha;
    float       alpha_cutoff;
    bool        double_sided, unlit;
} material;

typedef struct camera {
    char  *name;
    bool   orthographic;
    double fov_y;       /* radians, perspective */
    double half_height; /* orthographic */
    double near, far;   /* far 0 = none */
} camera;

typedef enum light_type { LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT } light_type;

typedef struct light {
    char      *name;
    light_type type;
    float      colour[3]; /* linear */
    float      intensity;
    float      range, inner_cone, outer_cone;
} light;

/* Free-form facts a file states about a node: glTF extras, attributes of city objects. Values as text. Both lie in one
 * block, that of the key: cities have millions of them. */
typedef struct attribute {
    char *key, *value;
} attribute;
/* A copy of texts; false when memory is gone. */
bool attribute_make(attribute *out, const char *key, const char *value);
bool attribute_make_sized(attribute *out, const char *key, size_t key_size, const char *value, size_t value_size);
void attribute_release(attribute *a);

/* Where a node is below its parent. Most nodes of a city are where their parents are. */
typedef struct node_place {
    mat4   matrix;
    double translation[3], rotation[4] /* x y z w */, scale[3];
} node_place;

/* One node. Its world matrix is parent · local; `local` is its place's matrix when `has_matrix`, else T·R·S. */
typedef struct node {
    char       *name;                              /* may be NULL */
    int32_t     parent, first_child, next_sibling; /* NONE when absent; children keep the file's order */
    int32_t     last_child;                        /* makes scene_link_child O(1) */
    int32_t     mesh, skin, camera, light;
    int32_t     solid; /* a node has a mesh or a solid */
    bool        has_matrix;
    bool        lent;      /* name and attributes are the program's, for many nodes: never freed, never written */
    bool        hidden;    /* with all below it, by who uses the library */
    bool        removed;   /* taken out of the scene, and empty */
    bool        numbered;  /* its file has no name for it: the reader made one of a number */
    bool        ghost;     /* what its parent's solid takes away; nothing counts or draws it unless it is asked for */
    node_place *place;     /* NULL: that of its parent, without a matrix */
    mat4       *instances; /* EXT_mesh_gpu_instancing: each instance draws world · instances[i] */
    uint32_t    instance_count; /* 0: the node itself is the one instance */
    uint32_t    morph_weight_count, attribute_count;
    float      *morph_weights; /* NULL: the mesh's */
    attribute  *attributes;
} node;

typedef struct skin {
    char    *name;
    int32_t *joints; /* node indices */
    mat4    *inverse_binds;
    size_t   joint_count;
} skin;

/* What a channel moves: something of a node, and from PATH_CAMERA_FOV on of a camera, from PATH_LIGHT_COLOUR on of a
 * light (KHR_animation_pointer). Values are in the units that the thing itself has in the scene. */
typedef enum animation_path {
    PATH_TRANSLATION,
    PATH_ROTATION,
    PATH_SCALE,
    PATH_WEIGHTS,
    PATH_CAMERA_FOV,
    PATH_CAMERA_HALF_HEIGHT,
    PATH_LIGHT_COLOUR,
    PATH_LIGHT_INTENSITY
} animation_path;
typedef enum interpolation { INTERPOLATION_LINEAR, INTERPOLATION_STEP, INTERPOLATION_CUBIC } interpolation;

/* What an animation's path belongs to. */
typedef enum animated_thing { ANIMATED_NODE, ANIMATED_CAMERA, ANIMATED_LIGHT } animated_thing;
animated_thing animation_thing_of(animation_path path);

/* `values` holds key_count · components numbers, times three (in-tangent, value, out-tangent) for cubic. */
typedef struct animation_channel {
    int32_t        target; /* index of the node, camera or light */
    animation_path path;
    interpolation  interpolation;
    size_t         key_count, components;
    float         *times, *values;
} animation_channel;

typedef struct animation {
    char              *name;
    animation_channel *channels;
    size_t             channel_count;
    double             duration; /* seconds: the last key */
} animation;

/* A part: node with geometry, in drawing order; ids start at 1 = index + 1. Counts and bounds are kept here, in the
 * scene's axes, because asking for them part by part would walk the whole tree each time. */
typedef struct part {
    int32_t  node;
    char    *name, *path; /* paths are unique */
    uint64_t triangles;   /* of one instance */
    uint64_t lines;       /* likewise, straight ones that the file brings */
    bool     edge_lines;  /* these all run along edges of its own triangles */
    box3     bounds;      /* rest pose, all instances */
    bool     ghost;       /* its node is one */
} part;

struct lmn_scene {
    node             *nodes;
    size_t            node_count, node_capacity;
    mesh             *meshes;
    size_t            mesh_count, mesh_capacity;
    material         *materials;
    size_t            material_count, material_capacity;
    image            *images;
    size_t            image_count, image_capacity;
    camera           *cameras;
    size_t            camera_count, camera_capacity;
    light            *lights;
    size_t            light_count, light_capacity;
    skin             *skins;
    size_t            skin_count, skin_capacity;
    animation        *animations;
    size_t            animation_count, animation_capacity;
    struct solid     *solids; /* scene/solid.h */
    size_t            solid_count, solid_capacity;
    struct behaviour *behaviour;  /* scene/behaviour.h; NULL: none */
    letterings        letterings; /* what signs were written with */
    box3              stage;      /* pictures are fitted to what of large parts lies in it, if `staged` */
    bool              staged;
    city_facts        city;  /* where it lies and what of city data it consists of; empty of other models */
    part             *parts; /* ordinary ones, and behind them all ghosts, so that these change nobody's id */
    size_t            part_count, ghost_count;
    char            **files; /* paths as they were given, one per merged file */
    size_t            file_count, file_capacity;
    uint64_t          revision; /* changes whenever the content does; no two scenes of a process ever share one */
    uint64_t          identity; /* the same as long as the scene lives; no other scene of the process ever has it */
    size_t            spare_meshes;
    int               changes_open; /* above 0 the list of parts waits for changes to end, and nothing draws */
    char              up;           /* 'y', 'z', or 0 while empty */
    bool              may_be_empty; /* set by an importer: the file is whole and has nothing to draw */
    bool is_motion; /* set by an importer: a skeleton of its own that may move a model (import/retarget.h) */
    /* Of a scene that a projection bent: where north and up are in the middle of what is seen. 0: along the axes. */
    double   north[3], zenith[3];
    warnings warnings;
    double   load_ms;
};

/* An empty scene; NULL when memory is gone. */
lmn_scene *scene_new(void);
/* Frees a scene and all it owns. NULL is accepted. */
void scene_free(lmn_scene *scene);

/* --- building: importers fill a scene of their own, then it is merged ----------------------------------- */

/* Append a zeroed (NONE where that is the neutral value) element; NULL when memory is gone. Pointers into an array are
 * valid until the next append to it. Strings and arrays stored in elements are owned by the scene (mem_alloc). */
node      *scene_append_node(lmn_scene *scene);
mesh      *scene_append_mesh(lmn_scene *scene);
material  *scene_append_material(lmn_scene *scene); /* white, opaque, no textures */
image     *scene_append_image(lmn_scene *scene);
camera    *scene_append_camera(lmn_scene *scene);
light     *scene_append_light(lmn_scene *scene);
skin      *scene_append_skin(lmn_scene *scene);
animation *scene_append_animation(lmn_scene *scene);
/* Those behind it get numbers that are smaller by one. */
void scene_remove_animation(lmn_scene *scene, size_t index);

/* Appends `child` as the last child of `parent` (both indices; parent NONE makes a root, which needs no call). */
void scene_link_child(lmn_scene *scene, int32_t parent, int32_t child);

/* Frees everything a mesh or primitive owns, not the struct itself. */
void mesh_release(mesh *m);
void primitive_release(primitive *p);
/* Puts the primitives into the mesh's array; the mesh then owns what they hold. False when memory is gone. */
bool mesh_set_primitives(mesh *m, const primitive *primitives, size_t count);

/* A number that no other content of this process has had. Any thread. */
uint64_t scene_next_revision(void);

/* Checks an imported scene whole (indices in range, trees without cycles, finite values), drops triangles and lines
 * that are degenerate or have non-finite vertices (a warning each kind), sets bounds, numbers the parts. `file` stands
 * in messages. Errors: LMN_FORMAT (nothing left to draw, broken references), LMN_LIMIT, LMN_MEMORY. With may_be_empty
 * set, having nothing to draw is a warning: a valid glTF may hold only cameras, or nothing at all. */
lmn_status scene_finish(lmn_scene *scene, const char *file, lmn_error *error);

/* Brings the up axis `from` to `to`, 'y' or 'z', with exact zeros so that boxes stay boxes. `from` may be any axis, in
 * capitals its negative side. */
mat4 scene_up_rotation(char from, char to);
/* The up axis of both together: that of `into`, or else that of `from`, if it is one that scenes may have; else 'y'. */
char scene_up_together(const lmn_scene *into, const lmn_scene *from);

/* Moves all content of `from` (finished) into `into` below a new root node named after the file, rotated to
 * `into`'s up axis; `from` is empty afterwards. On error `into` is unchanged, and `from` may have lost its list of
 * parts. Errors: LMN_LIMIT, LMN_MEMORY. */
lmn_status scene_merge(lmn_scene *into, lmn_scene *from, const char *file, lmn_error *error);

/* A copy of `size` bytes as valid UTF-8 without control characters (bad bytes become U+FFFD), for names from files.
 * NULL when memory is gone. */
char *scene_clean_name(const char *bytes, size_t size);
/* "spot" for "models/spot.stl": what a file's root node is called. NULL when memory is gone. */
char *scene_name_of_file(const char *path);

/* --- reading -------------------------------------------------------------------------------------------- */

/* World matrices of all nodes, node_count of them; free with mem_free. `locals` (may be NULL: the nodes' own) are those
 * of all nodes. NULL when memory is gone. */
mat4 *scene_world_matrices(const lmn_scene *scene, const mat4 *locals);
/* That of one node. */
mat4 scene_world_matrix(const lmn_scene *scene, int32_t node_index);
mat4 node_local_matrix(const node *n);
/* Its place, or one that changes nothing; and a place of its own to be changed, NULL when memory is gone. */
const node_place *node_place_of(const node *n);
node_place       *node_own_place(node *n);
bool              node_set_matrix(node *n, const mat4 *matrix);
/* Gives it a name and attributes of its own. False when memory is gone. */
bool node_own_facts(node *n);

/* What --camera calls a camera: its name, else that of a node that has it (may be NULL), else "camera-N", counted
 * from 1, in `numbered`. */
enum { CAMERA_NAME_CAPACITY = 32 };
const char *scene_camera_name(const lmn_scene *scene, size_t index, const char *node_name,
                              char numbered[CAMERA_NAME_CAPACITY]);

/* The scene's bounds with these world matrices: skinned and morphed parts as they are drawn. Empty box when
 * nothing. */
box3 scene_bounds(const lmn_scene *scene, const mat4 *worlds);
box3 part_bounds(const lmn_scene *scene, const mat4 *worlds, size_t part_index);

/* Vertices of a primitive as a pose has them, in its mesh's axes. */
typedef struct posed_vertices {
    vec3 *positions, *normals; /* room for all; NULL: not needed yet. Normals are for primitives that have some */
    bool  made;
} posed_vertices;

/* The same for any node with a mesh. `weights` (may be NULL: those that it has) are of its morph targets. What is posed
 * for it is left in `keep` (may be NULL), one a primitive of its mesh; the caller frees it with mem_free. */
box3 node_bounds(const lmn_scene *scene, const mat4 *worlds, int32_t node_index, const float *weights,
                 posed_vertices *keep);
/* The same at rest, of a scene without skins, where only the node's own matrix is needed. */
box3 node_bounds_unskinned(const lmn_scene *scene, const mat4 *world, int32_t node_index);
/* The node after this one, depth first, within the tree below `root`; NONE at the end. */
int32_t scene_next_node(const lmn_scene *scene, int32_t root, int32_t current);

/* Nodes that are no ghosts. */
size_t scene_plain_node_count(const lmn_scene *scene);
/* The ordinary part that a ghost was taken away from; SIZE_MAX when it is none. */
size_t scene_part_of_ghost(const lmn_scene *scene, size_t ghost_index);

/* How many times a node's mesh is drawn: its instances, or once. */
size_t node_draw_count(const node *n);
/* Is the node a kind of surface of what is above it ("roof", "wall"), which has the name that people know? */
bool node_is_surface(const node *n);
/* Does it lie over the picture, which is not fitted to it? Attribute NODE_OVERLAY. */
#define NODE_OVERLAY "overlay"
bool node_is_overlay(const node *n);
/* What of a part's box pictures are fitted to: of a scene with a stage, all of signs and of what is small and reaches
 * into it, and what of others lies in it. */
#define NODE_GLYPH "glyph"
box3 scene_fitted_box(const lmn_scene *scene, size_t part_index, box3 box);
/* How much paler than by its look it is drawn, eighths: a ghost image of what was or will be. Attribute NODE_PALE. */
#define NODE_PALE "pale"
enum { PALE_MOST = 8 };
int node_paleness(const node *n);
/* And the colour that it has where the look makes it paler. Attribute NODE_TINT. False: that of its material. */
#define NODE_TINT "tint"
bool node_tint(const node *n, colour *out);
/* Signs throw no shadow. Attribute NODE_SHADOWLESS: the number of the image that it is a piece of, as a ghost is made
 * of several; 0: of none. */
#define NODE_SHADOWLESS "shadowless"
bool     node_throws_shadow(const node *n);
uint32_t node_image(const node *n);
uint64_t mesh_triangle_count(const mesh *m);
uint64_t mesh_line_count(const mesh *m);

mat4 mat4_identity(void);
mat4 mat4_multiply(const mat4 *a, const mat4 *b); /* a · b */
vec3 mat4_transform_point(const mat4 *m, vec3 p);
/* Cofactors of the upper left 3 by 3, column-major: what normals are turned by, up to the sign. Returns its
 * determinant. */
double mat4_cofactors(const mat4 *m, double out[9]);
/* Does it send solids to a plane, a line or a point, however large it is? */
bool mat4_is_flat(const mat4 *m);
/* The identity where there is none. */
mat4   mat4_inverse(const mat4 *m);
mat4   mat4_from_trs(const double t[3], const double r[4], const double s[3]);
box3   box3_empty(void);
bool   box3_is_empty(box3 b);
box3   box3_union(box3 a, box3 b);
void   box3_middle(box3 b, double out[3]);
double box3_diagonal(box3 b);             /* its length */
bool   box3_overlap(box3 a, box3 b);      /* do they share more than their borders? */
box3   box3_intersection(box3 a, box3 b); /* empty unless they overlap */
box3   box3_with_point(box3 b, vec3 p);
box3   box3_transform(box3 b, const mat4 *m); /* the box around the 8 moved corners */

#endif
