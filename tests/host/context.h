/* Contexts of EGL without a window, for tests. */
#ifndef LIMNER_TESTS_HOST_CONTEXT_H
#define LIMNER_TESTS_HOST_CONTEXT_H

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <stdbool.h>

typedef enum context_kind { CONTEXT_CORE, CONTEXT_COMPATIBILITY, CONTEXT_ES } context_kind;

typedef struct context {
    EGLDisplay display;
    EGLContext context;
    EGLenum    api;
} context;

/* NULL context: the driver has none. Makes it current. */
bool context_open(context *out, context_kind kind, int major, int minor);
void context_make_current(const context *c);
void context_release(void);
void context_close(context *c);

typedef enum picture_depth { PICTURE_DEPTH_24, PICTURE_DEPTH_32F, PICTURE_DEPTH_NONE } picture_depth;

typedef struct picture {
    GLuint framebuffer, colour, depth;
    int    width, height;
} picture;

/* A framebuffer with colour (RGBA8) and depth with stencil. */
void picture_open(picture *out, int width, int height, picture_depth depth);
void picture_close(picture *p);

#endif
