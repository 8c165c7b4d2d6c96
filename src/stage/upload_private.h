/* What the files that put a scene on the GPU share: upload*.c. */
#ifndef LIMNER_STAGE_UPLOAD_PRIVATE_H
#define LIMNER_STAGE_UPLOAD_PRIVATE_H

#include "pose/posed_mesh.h"
#include "stage/upload.h"

/* One part while it is put on the GPU. */
typedef struct upload_part_job {
    size_t           part_index, instance;
    const mesh      *mesh;
    uint32_t         mesh_uses; /* how often it is drawn, as the upload has it */
    const part_pose *pose;
    gpu_mesh       **meshes, **lapped; /* per primitive, NULL: not made yet */
    gpu_mesh       **former;           /* per primitive: of another moment; NULL: there are none */
    posed_mesh      *posed;            /* per primitive, what cutting needs; NULL: not made yet */
    cut_input       *inputs;
    vec3           **input_positions;
    box3             box;    /* of the pose */
    float            nearer; /* of its cut faces */
    bool             open;
} upload_part_job;

/* --- upload.c --- */
/* Where an instance was earlier: item->past. */
void upload_set_past(const upload *u, draw_item *item, size_t instance);

/* The vertices of a primitive at several times. */
typedef struct upload_vertices {
    const vertex_arrays *now;
    const float         *walls;               /* four numbers a vertex, upload_walls.c; NULL: nobody asks */
    const vec3          *straight;            /* before a projection bent them, in the world; NULL: as they are */
    const vec3          *at_rest;             /* the same vertices; NULL: nobody asks, or it is that */
    const vec3          *past[POSE_PAST_MAX]; /* likewise; as many as there are */
    const vec3          *rest_positions;      /* of at_rest, in its part's frame */
} upload_vertices;
/* What a mesh is made of, with all its times. */
gpu_mesh_data upload_data_over_time(const upload_vertices *v);

/* --- upload_glue.c --- */
/* Gives the mesh its glue patches, where the plan wants them: free data->glue with mem_free, also after an error. */
lmn_status upload_glue(const upload *u, gpu_mesh_data *data, lmn_error *error);

/* --- upload_mesh.c --- */
gpu_mesh_data upload_data_of(const vertex_arrays *from);
/* The mesh of a part's primitive, in the buffers of a former one where it fits into these. */
gpu_mesh *upload_mesh_make(gpu *g, const upload_part_job *job, size_t primitive_index, const gpu_mesh_data *data);

/* A piece, which the upload owns. */
lmn_status upload_add_piece(upload *u, gpu *g, gpu_mesh **out, const gpu_mesh_data *data, lmn_error *error);
bool       upload_add_item(upload *u, const draw_item *item);
draw_item  upload_item(const upload_part_job *job, size_t primitive_index);

/* --- upload_pack.c --- */
/* Is the mesh of a part's primitive to lie in a pack? */
bool upload_packs(const upload *u, const upload_part_job *job, const gpu_mesh_data *data);
/* Adds it; `out` can be drawn once packs are closed. Errors: LMN_MEMORY, the GPU's. */
lmn_status upload_pack_add(upload *u, gpu *g, gpu_mesh **out, const gpu_mesh_data *data, lmn_error *error);
/* Puts on the GPU what is not full yet, and forgets what was gathered. Errors stick to the GPU. */
void upload_packs_close(upload *u, gpu *g);
/* Per mesh of the scene; NULL when memory is gone. Free with mem_free. */
uint32_t *upload_count_uses(const lmn_scene *scene);

/* --- upload_field.c --- */
/* The mesh with the direction in which it bends, and when wished for once more with patches that cover it (else that
 * one stays NULL). What is deformed bends as it does at rest, moved along. */
lmn_status upload_with_field(const upload *u, gpu *g, const upload_part_job *job, size_t primitive_index,
                             const upload_vertices *v, lmn_error *error);
/* Of the patches of a mesh with these bounds. */
float upload_patch_radius(const upload *u, box3 bounds);

/* --- upload_walls.c --- */
/* A primitive with vertices of their own for each of its walls. */
typedef struct upload_walls {
    vertex_arrays data; /* points into the rest */
    float        *positions, *normals, *colours, *uvs[UV_SETS];
    uint32_t     *indices;
    float (*numbers)[4];
} upload_walls;
/* Of what is not deformed. Errors: LMN_MEMORY. Release it also after one. */
lmn_status upload_find_walls(upload_walls *out, const upload *u, const upload_part_job *job, const upload_vertices *v,
                             lmn_error *error);
void       upload_walls_release(upload_walls *w);

/* --- part_frames.c --- */
/* Where the vertices of a deformed part are when nothing has moved, in its part's frame; free with mem_free. NULL when
 * memory is gone. */
vec3 *upload_rest_positions(upload *u, size_t part_index, const vec3 *at_rest, uint32_t count);

/* --- upload_solid.c --- */
lmn_status upload_solid_part(upload *u, gpu *g, size_t part_index, upload *earlier, lmn_error *error);
void       upload_solids_release(upload *u, gpu *g);
void       upload_shape_release(upload_shape *s);
/* What shaders read about all solids; once they are all there. */
lmn_status upload_solids_close(upload *u, gpu *g, lmn_error *error);

/* --- upload_cut.c --- */
/* Bits of a cut face's surface id. */
uint32_t cut_face_bits(const cut *c, int32_t plane, uint32_t body, bool positive);
/* Cuts one instance; what is left of it is added unless it stays whole. */
lmn_status upload_cut(upload *u, gpu *g, upload_part_job *job, const mat4 *world, cut_verdict *verdict,
                      lmn_error *error);
void       upload_part_close(upload_part_job *job);

#endif
