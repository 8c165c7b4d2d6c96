/* What the files that put a scene on the GPU share: upload.c, upload_cut.c, upload_mesh.c and upload_solid.c. */
#ifndef LIMNER_DRAW_UPLOAD_PRIVATE_H
#define LIMNER_DRAW_UPLOAD_PRIVATE_H

#include "draw/upload.h"

typedef struct part_pose {
    const mat4  *joints; /* NULL: no skin */
    size_t       joint_count;
    const float *weights;
    size_t       weight_count;
} part_pose;

/* A primitive ready to be drawn: split where the crease angle asks for it, in its pose. `data` points into the rest and into the
 * primitive. */
typedef struct posed_mesh {
    gpu_mesh_data   data;
    render_vertices split;
    vec3           *positions, *normals;
    vec2           *uvs[UV_SETS];
    vec4           *colours;
} posed_mesh;

/* One part while it is put on the GPU. */
typedef struct upload_part_job {
    size_t      part_index;
    const mesh *mesh;
    part_pose   pose;
    gpu_mesh  **meshes, **lapped; /* per primitive, NULL: not made yet */
    posed_mesh *posed;  /* per primitive, what cutting needs; NULL: not made yet */
    cut_input  *inputs;
    vec3      **input_positions;
    box3        box;    /* of the pose */
    float       nearer; /* of its cut faces */
    bool        open;
} upload_part_job;

/* --- upload.c --- */
/* How a part stands; *joints belongs to the caller. Errors: LMN_MEMORY. */
lmn_status upload_pose(part_pose *out, mat4 **joints, const lmn_scene *scene, const mat4 *worlds, size_t part_index, lmn_error *error);

/* --- upload_mesh.c --- */
/* Elements of `size` bytes in the order of a map; NULL when there are none (a NULL source) or memory is gone. The caller frees it. */
void      *upload_gather(const void *source, const uint32_t *map, uint32_t count, size_t size);
lmn_status posed_make(posed_mesh *out, const upload *u, const primitive *p, const part_pose *pose, lmn_error *error);
void       posed_release(posed_mesh *m);
/* A piece, which the upload owns. */
lmn_status upload_add_piece(upload *u, gpu *g, gpu_mesh **out, const gpu_mesh_data *data, lmn_error *error);
bool       upload_add_item(upload *u, const draw_item *item);
draw_item  upload_item(const upload_part_job *job, size_t primitive_index);

/* --- upload_field.c --- */
/* The mesh with the way it bends, and when wished for once more with patches that cover it (else *lapped stays NULL). */
lmn_status upload_with_field(const upload *u, gpu *g, gpu_mesh **out, gpu_mesh **lapped, const gpu_mesh_data *data, lmn_error *error);
/* Of the patches of a mesh with these bounds. */
float      upload_patch_radius(const upload *u, box3 bounds);

/* --- upload_solid.c --- */
lmn_status upload_solid_part(upload *u, gpu *g, const lmn_scene *scene, size_t part_index, upload *earlier, lmn_error *error);
void       upload_solids_release(upload *u, gpu *g);
void       upload_shape_release(upload_shape *s);
/* What shaders read about all solids; once they are all there. */
lmn_status upload_solids_close(upload *u, gpu *g, lmn_error *error);

/* --- upload_solid_cut.c --- */
/* Takes what is cut away from the form of a solid at this place; `half_space_mesh`: the number that its new operands give as their mesh, a box from 0
 * to 1 in each direction. *bits, one an operand of the form, are 0 or those of a cut face's surface id, and are made here. */
lmn_status upload_cut_solid(upload *u, solid_form *form, size_t part_index, const mat4 *world, int32_t half_space_mesh, uint32_t **bits,
                            lmn_error *error);

/* --- upload_cut.c --- */
/* Bits of a cut face's surface id. */
uint32_t   cut_face_bits(const cut *c, int32_t plane, uint32_t body, bool positive);
/* Cuts one instance; what is left of it is added unless it stays whole. */
lmn_status upload_cut(upload *u, gpu *g, upload_part_job *job, const mat4 *world, cut_verdict *verdict, lmn_error *error);
void       upload_part_close(upload_part_job *job);

#endif
