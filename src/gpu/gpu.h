/* GPU: context, programs, textures, meshes and passes over OpenGL 3.3 core or ES 3.0. Thin and explicit; GL is
 * called nowhere else. The first error sticks: later calls do nothing, gpu_check returns it. */
#ifndef LIMNER_GPU_GPU_H
#define LIMNER_GPU_GPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/text.h"

typedef struct gpu         gpu;
typedef struct gpu_texture gpu_texture;
typedef struct gpu_program gpu_program;
typedef struct gpu_mesh    gpu_mesh;
typedef struct gpu_buffer  gpu_buffer;
typedef struct gpu_marks   gpu_marks;

typedef enum gpu_format {
    GPU_R8,
    GPU_RG8,
    GPU_RG16F,
    GPU_R32F,
    GPU_R32UI,
    GPU_RGBA8,
    GPU_SRGB8,
    GPU_RGBA16F,
    GPU_RGBA32F,
    GPU_RG32UI,
    GPU_RGBA32UI,
    GPU_DEPTH32F,
    GPU_DEPTH32F_STENCIL8,
    GPU_FORMAT_COUNT
} gpu_format;
/* The source is premultiplied. UNDER: the picture's alpha is what still shows through, 1 at first, which 16-bit
 * floats hold better than what does not. */
typedef enum gpu_blend { GPU_BLEND_NONE, GPU_BLEND_MIN, GPU_BLEND_OVER, GPU_BLEND_UNDER } gpu_blend;
typedef enum gpu_cull { GPU_CULL_NONE, GPU_CULL_BACK, GPU_CULL_FRONT } gpu_cull;
/* The shading language of a program: the floor's, or GLSL 4.30 with storage blocks (only where
 * gpu_capabilities.lists). */
typedef enum gpu_dialect { GPU_FLOOR, GPU_FAST } gpu_dialect;
typedef enum gpu_wrap { GPU_CLAMP, GPU_REPEAT, GPU_MIRROR } gpu_wrap;
enum { GPU_COLOURS_MAX = 6 };

/* Makes a context without display or window. Errors: LMN_GL (with what is missing and how to get it), LMN_MEMORY. */
lmn_status gpu_create(gpu **out, bool es, bool debug, lmn_error *error);
/* Takes the context that is current on this thread, which stays the host's. `keeps_state`: its state is left as
 * drawing leaves it. Errors: LMN_USAGE (none is current), LMN_GL (with what it lacks), LMN_MEMORY. */
lmn_status gpu_adopt(gpu **out, bool debug, bool keeps_state, lmn_error *error);
/* Both leave the context entered. Whoever is outside calls nothing of GL in between: enter makes the context current,
 * or saves the state of the host's; leave gives back what was current, or the state. Errors of enter, after which
 * there is nothing to leave: LMN_USAGE (in use by another thread; the host's context is not current; what runs in it
 * is in the way), LMN_GL (lost, or cannot be made current). Leave returns `status`, or when that is LMN_OK what else
 * went wrong: LMN_GL. */
lmn_status gpu_enter(gpu *g, lmn_error *error);
lmn_status gpu_leave(gpu *g, lmn_status status, lmn_error *error);
bool       gpu_entered(const gpu *g);
/* Enters so that things can be freed; where that cannot be done, freeing calls nothing of GL: what it made goes with
 * the context. */
void gpu_enter_to_free(gpu *g);
/* Leaves, too. */
void gpu_destroy(gpu **g);
bool gpu_is_adopted(const gpu *g);
/* Returns the sticky error and clears it. */
lmn_status gpu_check(gpu *g, lmn_error *error);
void       gpu_fail(gpu *g, lmn_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* The same, for what is wrong with a file of someone else's. */
void gpu_fail_in(gpu *g, lmn_status status, const char *file, int line, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
bool gpu_failed(const gpu *g);
/* Waits until everything is done. */
void gpu_finish(gpu *g);

typedef struct gpu_capabilities {
    const char *vendor, *renderer, *version, *shading; /* owned by the context */
    bool        es, debug, software;                   /* software: the driver runs on the CPU */
    bool lanes_stay; /* fragments that were discarded go on computing, so that their neighbours' derivatives stay right:
                        LANES_STAY in shaders */
    int   max_texture, max_samples, max_attachments, max_storage_mib; /* storage: 0 = no storage blocks */
    float max_point;                                                  /* diameter of points, pixels */
    bool  fast;                                                       /* GL 4.3 or ES 3.1 paths may be used */
    bool  depth_clamp;
    bool  lists; /* GPU_FAST programs and buffers may be used: GL 4.3 */
} gpu_capabilities;
const gpu_capabilities *gpu_capabilities_of(const gpu *g);
/* Is there storage enough to gather fragments in lists? */
bool gpu_has_lists(const gpu *g);

/* --- textures and targets ------------------------------------------------------------------------------- */

/* A texture from pixels (RGBA8 or SRGB8), with mip levels. NULL after an error. */
gpu_texture *gpu_texture_create(gpu *g, int width, int height, gpu_format format, const void *pixels, bool nearest,
                                gpu_wrap wrap_u, gpu_wrap wrap_v);
/* Several pictures of one size, for samplers of arrays, with levels made by hand: level k holds all of them one
 * after the other in half the size of level k − 1. R8 and RG8 take bytes, RG16F floats. `nearest`: texels are not
 * mixed. Trilinear otherwise. NULL after an error. */
typedef struct gpu_levels {
    int                width, height, layers, levels;
    gpu_format         format;
    bool               nearest, stepped, clamped; /* stepped: levels are not mixed */
    const void *const *data;
} gpu_levels;
gpu_texture *gpu_texture_of_levels(gpu *g, const gpu_levels *levels);
void         gpu_texture_destroy(gpu *g, gpu_texture **t);
/* A picture to draw into, from a pool; nearest sampling, clamped. Its content is undefined. */
gpu_texture *gpu_target_acquire(gpu *g, int width, int height, gpu_format format);
void         gpu_target_release(gpu *g, gpu_texture *t);
/* Does the driver say that it can make such a picture? Nothing is made. Some say so too readily. */
bool gpu_target_possible(gpu *g, int width, int height, gpu_format format);
/* Frees the pool's unused pictures. */
void gpu_targets_trim(gpu *g);
int  gpu_texture_width(const gpu_texture *t);
int  gpu_texture_height(const gpu_texture *t);
/* OpenGL's name, to be lent. */
unsigned gpu_texture_name(const gpu_texture *t);
/* Bytes of a texel as gpu_target_write takes it. */
size_t gpu_texel_size(const gpu_texture *t);
/* Reads a picture back, row 0 at the bottom: RGBA8 → 4 bytes, RGBA16F/32F → 4 floats, R32F → 1, RG32UI → 2 uint32,
 * R32UI → 1, RGBA32UI → 4, DEPTH32F → 1 float. */
void gpu_read(gpu *g, gpu_texture *t, void *out);
/* The same for a part (x, y, width, height); not of depth or R8. */
void gpu_read_box(gpu *g, gpu_texture *t, const int box[4], void *out);
/* Writes a part of a picture of bytes or integers; rows follow each other without gaps. */
void gpu_target_write(gpu *g, gpu_texture *t, const int box[4], const void *pixels);

/* --- programs ------------------------------------------------------------------------------------------- */

/* Compiles (or finds) a program. Paths are below src/, several joined by '+' make one stage; `prelude` is GLSL put
 * before both stages. `#include "path"` in shader files is resolved below src/. NULL after an error; compile errors
 * name file and line. */
gpu_program *gpu_program_of(gpu *g, gpu_dialect dialect, const char *vertex, const char *fragment, const char *prelude);
size_t       gpu_program_count(const gpu *g);
/* Lets programs name `text` by this path, which must mean the same text for good and end in its own way. `label` stands
 * for it in errors, which have it as their file, and the line. Copies what it is given; a path that is known stays as
 * it is. False when memory is gone. */
bool gpu_give_source(gpu *g, const char *path, const char *label, const char *text);

/* --- meshes --------------------------------------------------------------------------------------------- */

enum { GPU_PAST_MAX = 4 };

/* Vertex data; arrays other than positions may be NULL. Colours are linear, straight alpha. */
typedef struct gpu_mesh_data {
    uint32_t        vertex_count, index_count;
    const float    *positions, *normals, *uvs[2], *colours;
    const float    *tensors;            /* six numbers a vertex: locations 6 and 7 */
    const float    *patches;            /* four numbers a vertex: location 8 */
    const float    *walls;              /* likewise, in meshes without patches: location 8, too */
    const float    *rest;               /* positions when nothing has moved: location 9 */
    const float    *past[GPU_PAST_MAX]; /* positions earlier: locations 10 and up */
    const uint32_t *keys;               /* a number a vertex; that of a triangle's last corner is the triangle's */
    const uint32_t *indices;
    const uint32_t *glue; /* triangles that only gpu_draw_glue draws */
    uint32_t        glue_count;
} gpu_mesh_data;
gpu_mesh *gpu_mesh_create(gpu *g, const gpu_mesh_data *data);
void      gpu_mesh_destroy(gpu *g, gpu_mesh **m);
/* Writes other values into the mesh's buffers; what is NULL stays as it is. False, and nothing is written, unless the
 * mesh has as many vertices and indices, and tensors, walls and positions at rest and earlier just where these are
 * given. */
bool gpu_mesh_rewrite(gpu *g, gpu_mesh *m, const gpu_mesh_data *data);

/* Many small meshes in the same buffers, so that one call draws several: a whole is opened, meshes are said to lie
 * within it, and it is filled. It lasts as long as anything in it; who opened it destroys it, too. `key`: what the
 * data's keys have for its vertices. Such meshes are not rewritten. NULL after an error. */
gpu_mesh *gpu_mesh_open(gpu *g);
gpu_mesh *gpu_mesh_within(gpu *g, gpu_mesh *whole, uint32_t first_index, uint32_t index_count, uint32_t key);
void      gpu_mesh_fill(gpu *g, gpu_mesh *whole, const gpu_mesh_data *data);
/* The key of a mesh that lies within another one; false for others. */
bool gpu_mesh_key(const gpu_mesh *m, uint32_t *key);
/* Do they lie in the same whole? */
bool gpu_meshes_together(const gpu_mesh *a, const gpu_mesh *b);

uint32_t gpu_mesh_triangles(const gpu_mesh *m);
bool     gpu_mesh_has_tensors(const gpu_mesh *m);
bool     gpu_mesh_has_walls(const gpu_mesh *m);
bool     gpu_mesh_has_rest(const gpu_mesh *m);
bool     gpu_mesh_has_past(const gpu_mesh *m);

/* --- marks ---------------------------------------------------------------------------------------------- */

/* Records drawn as quads: strokes, dots, pieces of lines. A record is `vectors` times four floats, attributes 0 and
 * up, the same in all four corners of its quad; which one a vertex is, is gl_VertexID & 3. Corners 0 1 2 and 2 1 3
 * are its triangles. NULL after an error. */
enum { MARK_VECTORS_MAX = 8 };
gpu_marks *gpu_marks_create(gpu *g, int vectors, const float *records, size_t count);
/* The same drawn as points, one vertex a record: gl_PointSize is at most gpu_capabilities.max_point, and the middle
 * must lie inside of what is drawn. */
gpu_marks *gpu_marks_create_points(gpu *g, int vectors, const float *records, size_t count);
/* The same drawn as strips of so many vertices, instance by instance: gl_VertexID counts within one. */
gpu_marks *gpu_marks_create_strips(gpu *g, int vectors, const float *records, size_t count, int vertices);
/* How records are laid out in memory, and what is drawn of them (row EX-29). */
typedef enum gpu_mark_number { MARK_FLOAT, MARK_SNORM16, MARK_UNORM16 } gpu_mark_number;
typedef struct gpu_mark_field {
    gpu_mark_number number;
    int             components; /* 1 … 4; of numbers of 16 bits 2 or 4 */
} gpu_mark_field;
typedef enum gpu_mark_form {
    MARK_QUADS,    /* as above */
    MARK_POINTS,   /* as above */
    MARK_SEGMENTS, /* native lines, a pixel wide: gl_VertexID & 1 says which end a vertex is */
    MARK_STRIPS    /* only of gpu_marks_create_strips */
} gpu_mark_form;
typedef struct gpu_mark_layout {
    gpu_mark_field fields[MARK_VECTORS_MAX]; /* attributes 0 and up, one behind the other */
    int            count;
    gpu_mark_form  form;
    bool           once; /* each record is there once and drawn as an instance, instead of once a vertex */
} gpu_mark_layout;
size_t     gpu_mark_record_size(const gpu_mark_layout *layout);
gpu_marks *gpu_marks_create_as(gpu *g, const gpu_mark_layout *layout, const void *records, size_t count);
void       gpu_marks_destroy(gpu *g, gpu_marks **m);
size_t     gpu_marks_count(const gpu_marks *m);
size_t     gpu_marks_bytes(const gpu_marks *m); /* that their buffers take */

/* --- storage buffers (only where gpu_capabilities.lists) ------------------------------------------------ */

/* A buffer of at least this size from a pool; its content is undefined. NULL after an error. */
gpu_buffer *gpu_buffer_acquire(gpu *g, size_t bytes);
void        gpu_buffer_release(gpu *g, gpu_buffer *b);
/* Sets the first `bytes` to copies of a word. */
void gpu_buffer_fill(gpu *g, gpu_buffer *b, uint32_t word, size_t bytes);
/* Writes the first bytes. */
void gpu_buffer_write(gpu *g, gpu_buffer *b, const void *data, size_t bytes);
void gpu_buffer_bind(gpu *g, gpu_buffer *b, int binding);
void gpu_buffer_read(gpu *g, gpu_buffer *b, size_t bytes, void *out);
/* What shaders wrote is seen by everything after. */
void gpu_buffer_barrier(gpu *g);

/* --- drawing -------------------------------------------------------------------------------------------- */

typedef struct gpu_pass {
    gpu_texture *colours[GPU_COLOURS_MAX];
    int          colour_count;
    gpu_texture *depth;
    bool         clear;                            /* all colours to clear_values, depth to 1 */
    bool         keep_depth;                       /* with clear: leave the depth as it is */
    float        clear_values[GPU_COLOURS_MAX][4]; /* integer formats take them as integers */
    int          scissor[4];                       /* drawing: x, y, width, height; width 0 = all */
    int          clear_box[4];                     /* clearing: the same */
} gpu_pass;
void gpu_pass_begin(gpu *g, const gpu_pass *pass);

/* A framebuffer of the host whose context was adopted. */
typedef struct gpu_host_target {
    unsigned framebuffer;
    bool     encodes;     /* it encodes as sRGB what is written, and cannot be told not to */
    bool     zero_to_one; /* the host's clip space has depths from 0 on, not from −1 */
    double   range[2];    /* of the host's window depth */
} gpu_host_target;
/* Looks at it. Errors: LMN_USAGE (it is not there, not complete, or has no depth and that is wanted). */
lmn_status gpu_host_open(gpu *g, unsigned framebuffer, bool depth, gpu_host_target *out, lmn_error *error);
/* Begins a pass into a box of its pixels, and ends it. Only the first draw buffer is written. */
void gpu_host_begin(gpu *g, const gpu_host_target *target, const int box[4]);
void gpu_host_end(gpu *g);

/* What a fragment must be, compared with what is there. */
typedef enum gpu_compare {
    GPU_LESS_EQUAL,
    GPU_LESS,
    GPU_EQUAL,
    GPU_NOT_EQUAL,
    GPU_GREATER,
    GPU_GREATER_EQUAL,
    GPU_ALWAYS
} gpu_compare;
typedef enum gpu_stencil_action {
    GPU_STENCIL_KEEP,
    GPU_STENCIL_ZERO,
    GPU_STENCIL_REPLACE,
    GPU_STENCIL_COUNT
} gpu_stencil_action;

/* Of the reference with what is there: equal, not equal or always. */
typedef struct gpu_stencil {
    bool               on;
    gpu_compare        compare;
    int                reference;
    gpu_stencil_action fails, behind, passes; /* the stencil test, the depth test, none */
} gpu_stencil;

typedef struct gpu_state {
    bool depth_test, depth_write;
    bool depth_clamp; /* where gpu_capabilities.depth_clamp: nothing is cut off at the near and far planes, it gets
                         their depth */
    gpu_compare depth_compare;
    gpu_blend   blend;
    gpu_stencil stencil;
} gpu_state;
/* Selects program and state for what follows; textures of the last program are forgotten. */
void gpu_use(gpu *g, gpu_program *p, gpu_state state);
/* Before a draw whose vertex shader reads what was drawn before: software drivers run it at once, while the pictures
 * may still be in the making. */
void gpu_settle(gpu *g);
/* Changes which faces are left out; all else stays. */
void gpu_cull_faces(gpu *g, gpu_cull cull);
/* Uniforms of the program in use; names that it does not have are ignored. */
void gpu_set_int(gpu *g, const char *name, int value);
void gpu_set_uint(gpu *g, const char *name, unsigned value);
void gpu_set_float(gpu *g, const char *name, float value);
void gpu_set_vec2(gpu *g, const char *name, float x, float y);
void gpu_set_ivec2(gpu *g, const char *name, int x, int y);
void gpu_set_vec3(gpu *g, const char *name, const float v[3]);
void gpu_set_vec4(gpu *g, const char *name, const float v[4]);
void gpu_set_vec4_array(gpu *g, const char *name, const float *v, int count);
void gpu_set_mat3(gpu *g, const char *name, const float m[9]);
void gpu_set_mat4(gpu *g, const char *name, const float m[16]);
/* Binds a texture to a sampler; `linear` asks for filtering (16-bit float and 8-bit formats only). */
void gpu_set_texture(gpu *g, const char *name, gpu_texture *t, bool linear);
bool gpu_has_uniform(gpu *g, const char *name);
/* One triangle that covers the target. */
void gpu_draw_screen(gpu *g);
/* Sets the program's uniform u_first_primitive, if it has one, to what gl_PrimitiveID must be raised by. */
void gpu_draw_mesh(gpu *g, gpu_mesh *m);
/* One after the other; all in one whole, or a single one. gl_PrimitiveID goes on from each to the next as above. */
void gpu_draw_meshes(gpu *g, gpu_mesh *const *meshes, size_t count);
/* Its glue patches alone. */
void gpu_draw_glue(gpu *g, gpu_mesh *m);
/* Some of its triangles: runs of indices, first and count. */
void gpu_draw_mesh_runs(gpu *g, gpu_mesh *m, uint32_t (*runs)[2], size_t count);
/* Was any fragment between the two calls left by the tests? The answer of one of GPU_QUERIES occlusion queries is
 * waited for when it is asked. */
enum { GPU_QUERIES = 64 };
void gpu_query_begin(gpu *g, int query);
void gpu_query_end(gpu *g);
bool gpu_query_any(gpu *g, int query);
/* Rectangles of pixels (x, y, width, height) that do not overlap, with a program of the vertex shader
 * gpu/boxes.vert. */
void gpu_draw_boxes(gpu *g, int (*boxes)[4], size_t count);
/* All of the marks, in their order; or runs of them: the first one, how many. */
void gpu_draw_marks(gpu *g, gpu_marks *m);
void gpu_draw_mark_runs(gpu *g, gpu_marks *m, uint32_t (*runs)[2], size_t count);
/* Draw calls since the context was made. */
uint64_t gpu_draw_count(const gpu *g);

#endif
