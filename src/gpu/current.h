/* Which OpenGL context is current on this thread: asked, changed and given back, whether EGL or GLX made it. */
#ifndef LIMNER_GPU_CURRENT_H
#define LIMNER_GPU_CURRENT_H

#include <stdbool.h>

typedef enum window_system { SYSTEM_NONE, SYSTEM_EGL, SYSTEM_GLX } window_system;

/* A context with what it draws to and reads from. */
typedef struct current_context {
    window_system system;
    void         *context, *display;
    void         *surfaces[2];  /* EGL: draw, read */
    unsigned long drawables[2]; /* GLX: draw, read */
    unsigned api; /* EGL: the API that is bound on this thread, also where no context is current; 0: EGL is not there */
} current_context;

/* Asks only libraries that the process has loaded. */
current_context current_get(void);

/* Makes it current instead of `before`, which is what is current now. Two window systems share a thread only one after
 * the other: what the other one has current is released first. Without context nothing is current afterwards. */
bool current_set(const current_context *wanted, const current_context *before);

bool current_same(const current_context *a, const current_context *b);

#endif
