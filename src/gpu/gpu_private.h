/* What the files of this folder share. */
#ifndef LIMNER_GPU_GPU_PRIVATE_H
#define LIMNER_GPU_GPU_PRIVATE_H

#include <epoxy/gl.h>
#include <epoxy/egl.h>

#include <stdatomic.h>

#include "gpu/current.h"
#include "gpu/gpu.h"

enum { FRAMEBUFFERS_MAX = 64, UNIFORMS_MAX = 96 };

struct gpu_texture {
    GLuint     name;
    GLenum     target;
    int        width, height;
    gpu_format format;
    bool       mipmapped, nearest, in_use;
    bool       linear; /* the filter that is set now */
};

typedef struct uniform_slot {
    const char *name; /* owned by the program */
    GLint       location;
} uniform_slot;

struct gpu_buffer {
    GLuint name;
    size_t bytes;
    bool   in_use;
};

struct gpu_program {
    GLuint       name;
    char        *key;
    uniform_slot uniforms[UNIFORMS_MAX];
    int          uniform_count;
};

/* A shader text from outside of the library. */
typedef struct given_source {
    char *path, *label, *text;
} given_source;

enum { GPU_BUFFERS = 15 };

struct gpu_mesh {
    GLuint           array, buffers[GPU_BUFFERS];           /* by attribute, the last for indices */
    uint32_t         index_count, glue_count, vertex_count; /* glue: behind the indices */
    bool             has_colours, has_tensors, has_walls, has_rest, has_past;
    struct gpu_mesh *whole;       /* whose buffers it lies in, instead of its own, or NULL */
    uint32_t         first_index; /* in these */
    uint32_t         key;         /* with a whole: of its vertices */
    size_t           users;       /* that hold it: who made it, and what lies in its buffers */
};

struct gpu_marks {
    GLuint          array, buffers[2]; /* records, indices; the latter of quads that are there once a corner */
    size_t          count, bytes;
    gpu_mark_layout layout;
    int             strip; /* vertices of one */
};

/* A framebuffer object for one set of attachments. */
typedef struct framebuffer {
    GLuint       name;
    gpu_texture *colours[GPU_COLOURS_MAX], *depth;
    uint64_t     used;
} framebuffer;

struct gpu {
    current_context   own;                  /* Limner's context, or the host's that it adopted */
    current_context   before;               /* what was current when the call entered */
    bool              adopted, keeps_state; /* of a host; without giving its state back */
    bool              entered, gone;        /* gone: no call of GL is possible any more */
    atomic_bool       busy;
    int               version;             /* times ten */
    bool              compatibility;       /* the profile */
    GLuint            probe, probe_buffer; /* adopted: a framebuffer with stencil */
    union host_value *host_values;         /* adopted: what the host's state was */
    bool             *host_has;            /* per row of the table */
    bool              host_zero_to_one;    /* adopted: of the host's clip control */
    double            host_range[2];       /* of its depth */
    GLenum (*reset_status)(void);          /* NULL: the driver does not tell */
    gpu_capabilities capabilities;
    lmn_error        error;
    bool             failed;
    gpu_texture    **targets;
    size_t           target_count, target_capacity;
    gpu_program    **programs;
    size_t           program_count, program_capacity;
    given_source    *sources;
    size_t           source_count, source_capacity;
    gpu_buffer     **buffers;
    size_t           buffer_count, buffer_capacity;
    framebuffer      framebuffers[FRAMEBUFFERS_MAX];
    int              framebuffer_count;
    uint64_t         clock, draws;
    uint32_t         indices_in_flight; /* drawn since the last finish */
    int64_t          pixels_in_flight;
    int              piece_indices, piece_pixels; /* drawn at once, at most */
    double           finished_ms;                 /* when the last finish was */
    int              box[4];                      /* scissor of the pass, whole when there is none */
    GLuint           empty_array, boxes_array, boxes_buffer, queries[GPU_QUERIES];
    gpu_program     *program; /* in use */
    int              next_unit;
};

/* --- pace.c: pieces of long draws --- */
void     pace_start(gpu *g);
bool     pace_goes_on(gpu *g); /* may something be drawn? Asks whether the call is to stop */
void     pace_drawn(gpu *g, uint32_t indices, int64_t pixels);
uint32_t pace_indices(const gpu *g, uint32_t count); /* how many at once */
int      pace_rows(const gpu *g, int width, int height);

void gpu_buffers_trim(gpu *g);
void gpu_sources_release(gpu *g);
/* --- context.c, adopt.c --- */
lmn_status gpu_begin(gpu **out, bool debug, lmn_error *error); /* an empty one, busy; `before` is asked */
lmn_status gpu_no_gl(gpu **g, lmn_error *error, const char *what);
bool       gpu_library_is_there(const char *const *names);
lmn_status gpu_start(gpu **g, lmn_error *error); /* capabilities and objects of the context that is current */
bool       gpu_has_debug_output(const gpu *g);
lmn_status adopt_enter(gpu *g, lmn_error *error);
void       adopt_leave(gpu *g);
void       adopt_release(gpu *g);

/* Triangles of the vertex array that is bound, from the first index on; at most as many at once as the driver holds
 * well. */
void gpu_draw_indices(gpu *g, uint32_t first, uint32_t count);
void gpu_forget_framebuffers(gpu *g, const gpu_texture *t);

#endif
