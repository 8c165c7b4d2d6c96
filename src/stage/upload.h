/* The scene on the GPU: meshes ready to draw, textures, and a list of what is drawn where. */
#ifndef LIMNER_STAGE_UPLOAD_H
#define LIMNER_STAGE_UPLOAD_H

#include "csg/csg.h"
#include "stage/mark_sets.h"
#include "stage/stroke_store.h"
#include "gpu/gpu.h"
#include "plan/building.h"
#include "plan/section.h"
#include "technique/technique.h"
#include "pose/pose.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "csg_tree/products.h"

/* A solid ready to be drawn. Operands are numbered from 0 on in the order of the tree, those alone that pruning
 * left. */
typedef struct upload_solid {
    solid_form form;
    int32_t   *used;     /* per operand: its number in the form */
    uint32_t  *cut_bits; /* per operand of the form: bits of a cut face's surface id, 0: none */
    size_t     count;
    uint32_t (*runs)[2]; /* per operand: its indices in the mesh, first and count */
    box3 *boxes;         /* per operand: solid's axes */
    bool *taken_away;    /* per operand */
    bool *in_products;   /* per operand: belongs to a branch of the tree that is given by products of convex operands */
    product_list products;   /* of those branches; of operands as they are numbered here */
    bool        *meets;      /* per operand: is taken away from where another one is taken away too */
    bool         ghost;      /* what another one takes away */
    bool         all_convex; /* there is nothing but these products */
    product_list rest;       /* of the other branches */
    int32_t      source;     /* in the scene's solids */
    uint64_t     revision;   /* of that one */
    gpu_mesh    *mesh;       /* of all operands; NULL: nothing is left to draw */
    uint64_t     triangles;
    csg_plane   *planes;
    size_t       plane_count, planes_found; /* there may have been no room for all */
} upload_solid;

/* A mesh on the GPU. `revision`, `topology`: of the scene's mesh, as it was then. */
typedef struct upload_mesh {
    uint64_t   revision, topology;
    gpu_mesh **primitives; /* NULL, as each of them: not made yet */
    gpu_mesh **lapped;     /* the same covered with patches, where these are wished for */
    gpu_mesh   *
        *former; /* of another moment, or before its vertices were moved: their buffers are used again. NULL: none */
    size_t count;
} upload_mesh;

/* What poses of a mesh without normals have in common. `revision`, `topology`: as above. */
typedef struct upload_corners {
    uint64_t       revision, topology;
    corner_groups *groups; /* per primitive; NULL: not made yet */
    size_t         count;
} upload_corners;

/* What solids ask of a mesh. */
typedef struct upload_shape {
    uint64_t         revision;
    render_vertices *vertices; /* per primitive, split at creases; NULL: not made yet */
    size_t           count;
    signed char      convex, inside_out; /* 1 yes, −1 no, 0 not asked yet */
} upload_shape;

/* One draw call: a primitive of a part at one position. */
typedef struct draw_item {
    gpu_mesh      *mesh, *lapped; /* lapped: NULL: there is none */
    float          patch_radius;
    mat4           world, past[POSE_PAST_MAX]; /* past: where it was earlier, as many as the pose has */
    uint32_t       part_id, surface_id;
    size_t         part_index;
    int32_t        material;
    bool           has_uvs, has_uv1, has_colours;
    building_facts building; /* where walls are asked for */
    bool           has_key;  /* its mesh lies in a pack and is drawn here alone: `key` is that of its vertices */
    uint32_t       key;
    bool           is_solid;                     /* operands of a solid: nothing of them is drawn as it is */
    size_t         solid;                        /* in the upload's solids */
    uint32_t       first_operand, operand_count; /* solids: numbers from first_operand + 1 on */
    uint32_t       first_plane, plane_count;
    box3           reach;  /* world axes; of all operands, what is taken away too */
    bool           is_cut; /* a cut face: unlit, hatched */
    float nearer; /* window depth by which it is drawn nearer, so that cut faces of parts that overlap do not flicker */
} draw_item;

/* Stores of figures that hide what is behind, of those that are seen through, and of edges that are looked up. */
enum { STROKES_OPAQUE, STROKES_SEEN_THROUGH, STROKES_LOOKED_UP, STROKE_STORES };

/* Keys of packed meshes are numbers that single precision has exactly. */
enum { UPLOAD_KEYS_MOST = 1 << 24 };
typedef struct upload_pack upload_pack;

/* What the first light saw last, and by what: pictures of a scene that stands still, for the same viewer, need not ask
 * again. Nothing but these can change it as long as the upload lives. */
typedef struct seen_by_light {
    gpu_texture *depth;            /* NULL: nothing is kept */
    mat4         view, projection; /* of the light */
    bool        *parts;            /* that throw shadows */
} seen_by_light;

/* The shadow on the ground as it fell last, and as it was then drawn with a calm border: what falls so again need not
 * be traced again. */
typedef struct calmed_shadow {
    uint8_t *fallen, *calmed; /* texels of the box; NULL: nothing is kept */
    int      width, height;
    double   smoothing; /* texels */
    bool     softened;
} calmed_shadow;

typedef struct upload {
    uint64_t        revision, identity; /* of the scene */
    double          crease_angle;       /* radians */
    mesh_needs      needs;              /* of all techniques */
    section         section;
    size_t          open_parts;   /* some of whose sections are not closed */
    double          extent;       /* of the scene as it is posed */
    const pose     *pose;         /* that it was made of; lent */
    moment          when;         /* of that one, as it was then */
    double          past_seconds; /* how much earlier its last pose of the past is; 0: there was none */
    int             past_count;
    size_t          part_count;  /* with the ghosts when the look asks for them */
    bool            has_removed; /* it does */
    draw_item      *items;
    size_t          item_count, item_capacity;
    gpu_mesh      **pieces; /* what sections left */
    size_t          piece_count, piece_capacity;
    upload_mesh    *meshes;  /* per mesh of the scene, for parts in no pose */
    upload_mesh    *posed;   /* per node of the scene */
    upload_shape   *shapes;  /* per mesh of the scene, and behind them that of the half-spaces of sections */
    upload_corners *corners; /* per mesh of the scene */
    size_t          mesh_count, node_count;
    upload_pack    *packs;     /* while meshes are made; NULL: none was begun */
    uint32_t       *mesh_uses; /* per mesh of the scene: how often it is drawn, 2 for more than once */
    size_t          key_count; /* of packed meshes, those of former uploads too */
    gpu_texture   **textures;  /* one per image and colour space: index 2·image + linear */
    size_t          texture_count;
    upload_solid   *solids;
    size_t          solid_count, solid_capacity;
    csg_program     program; /* of all solids */
    csg_plane      *planes;  /* of all solids, in their own axes; items know theirs */
    size_t          plane_count, plane_capacity;
    seen_by_light   lit;
    calmed_shadow   ground_shadow;
    float (*operands)[8]; /* per operand: linear colour, part, index of a cut face, whether it is one, 0 */
    size_t        operand_capacity;
    gpu_texture  *operand_table;     /* the same, two texels an operand, 512 operands a row; NULL: no solids */
    gpu_buffer   *program_buffer;    /* NULL where there are no storage blocks */
    gpu_texture  *part_frames;       /* NULL: not asked for yet */
    float        *part_frame_values; /* what is in it */
    float        *rest_frame_values; /* the same of the pose at rest; NULL: not asked for yet */
    double        frame_origin[3];
    mark_sets    *marks;                  /* NULL: none yet */
    stroke_store *strokes[STROKE_STORES]; /* NULL: not asked for yet */
    uint64_t      triangles;              /* drawn, instances counted */
} upload;

/* How a scene is put on the GPU. */
typedef struct upload_desc {
    double         crease_angle;
    bool           removed; /* what solids take away, too */
    mesh_needs     needs;
    const section *section; /* copied */
} upload_desc;

/* Fails by returning LMN_MEMORY or the GPU's error; the upload can be released in any case. The pose is lent. What
 * an earlier upload (may be NULL) of the same scene and crease angle has that still holds is taken over: after an
 * edit, meshes, textures and solids that did not change. Release that one too. */
lmn_status upload_create(upload *out, gpu *g, const pose *pose, const upload_desc *desc, upload *earlier,
                         lmn_progress_fn progress, void *user, lmn_error *error);
void       upload_release(upload *u, gpu *g);
/* The texture of a use, made when first asked for; NULL when the image is missing. `linear`: not a colour. */
gpu_texture *upload_texture(upload *u, gpu *g, const texture_use *use, bool linear);

enum { PART_FRAME_FLOATS = 20 };

/* Five texels a part, 1024 parts a row: rows of the matrix that takes a position in the world, measured from
 * `frame_origin`, to where it is when nothing has moved, in the scene's unit; in the fourth one a number, and which
 * way is up there; in the fifth a level axis of the part. Parts of one file without animated nodes between have the
 * same frame and number; when what they hang on moves or turns, they keep these positions. Made when first asked for;
 * NULL after an error. */
gpu_texture *upload_part_frames(upload *u, gpu *g);

#endif
