/* Every piece of a context's state that Limner touches or depends on, one row each. From the table comes what is done
 * in a host's context: saved, brought to what Limner's own contexts have, given back; and docs/reference/gl-state.md.
 */
#ifndef LIMNER_GPU_HOST_STATE_H
#define LIMNER_GPU_HOST_STATE_H

#include "gpu/gpu_private.h"

enum { HOST_UNITS = 16, HOST_STORAGE = 8, HOST_VIEWPORTS = 16, HOST_DRAW_BUFFERS = 8, HOST_ATTRIBUTES = 16 };

/* What a row keeps. */
typedef union host_value {
    GLint    i[64];
    GLfloat  f[64];
    GLdouble d[32];
    GLint64  l[32];
} host_value;

typedef struct host_row {
    const char *group;         /* heading on the page */
    const char *name;          /* as OpenGL has it */
    const char *neutral;       /* what it is while Limner draws, for the page */
    int         desktop, es;   /* versions that have it, times ten; 0: none */
    const char *extension;     /* has it where the version has not; NULL: none */
    bool        compatibility; /* compatibility profiles alone have it */
    GLenum      what;
    GLint       value; /* that is set */
    void (*save)(gpu *g, GLenum what, host_value *out);
    void (*set)(gpu *g, GLenum what, GLint value); /* NULL: every pass sets it */
    void (*restore)(gpu *g, GLenum what, const host_value *saved);
} host_row;

extern const host_row host_rows[];
extern const size_t   host_row_count;

/* Does this context have it? */
bool host_row_applies(const gpu *g, const host_row *row);

/* Values have room for host_row_count; the context is current. */
void host_state_save(gpu *g, host_value *values);
void host_state_set(gpu *g);
void host_state_restore(gpu *g, const host_value *values);

/* What can be neither saved nor done without: queries that count what is drawn. NULL, or what is running. */
const char *host_state_in_the_way(const gpu *g);

#endif
