/* The state of a context as a program sees it that knows nothing of Limner: everything that can be asked for, put out
 * of order in two ways, and compared. */
#ifndef LIMNER_TESTS_HOST_STATE_H
#define LIMNER_TESTS_HOST_STATE_H

#include <epoxy/gl.h>
#include <stdbool.h>

enum { STATE_MAX = 1600 };

typedef struct state_value {
    const char *name;
    int         index;
    double      value;
} state_value;

typedef struct state {
    state_value values[STATE_MAX];
    int         count;
} state;

void state_take(state *out);
/* Prints what differs; true when nothing does. */
bool state_same(const state *before, const state *after);

/* Objects that hostile states bind. */
typedef struct state_objects {
    GLuint textures[3], samplers[2], buffers[4], array, program, framebuffer, renderbuffer;
} state_objects;
void state_objects_create(state_objects *out);
void state_objects_destroy(state_objects *o);

/* LIVELY: everything is unusual, and triangles can still be seen. DEADLY: nothing would be drawn or sent right.
 * What is bound to GL_FRAMEBUFFER and the program stay as they are when LIVELY. */
typedef enum state_preset { STATE_LIVELY, STATE_DEADLY, STATE_PRESETS } state_preset;
void state_upset(const state_objects *o, state_preset preset);
/* Everything as in a new context, for what the test itself does; nothing is bound but the framebuffer and program. */
void state_calm(void);

#endif
