/* A host that draws triangles with a state of its own, and Limner beside them, frame after frame: in whatever context
 * is current. What is wrong ends the process. */
#ifndef LIMNER_TESTS_HOST_FRAMES_H
#define LIMNER_TESTS_HOST_FRAMES_H

#include "limner/limner.h"
#include "state.h"

enum { FRAME_WIDTH = 320, FRAME_HEIGHT = 120, FRAME_HALF = 160, FRAME_CASES = 6 };

typedef struct frames {
    state_objects objects;
    lmn_renderer *renderer;
    lmn_scene    *scenes[FRAME_CASES];
    lmn_look     *looks[FRAME_CASES];
    lmn_drawing  *expected[FRAME_CASES]; /* by a renderer with a context of its own */
} frames;

/* How many frames a test draws: 100, or what LIMNER_HOST_FRAMES says. */
int  frames_wanted(void);
void frames_open(frames *f);
/* One frame into a framebuffer that is at least as large; `i` from 0 on. */
void frames_step(frames *f, GLuint framebuffer, int i);
void frames_close(frames *f);

/* Ends the process unless the call was good. */
void must(lmn_status status, const lmn_error *error, const char *what);
void must_be(bool good, const char *what);

#endif
