/* The frames in contexts of EGL without a window: core, compatibility, ES. */
#include <stdio.h>
#include <string.h>

#include "context.h"
#include "frames.h"

int main(int count, char **arguments)
{
    static frames f;
    context       c;
    picture       p;
    context_kind  kind = count > 1 && strcmp(arguments[1], "es") == 0              ? CONTEXT_ES
                         : count > 1 && strcmp(arguments[1], "compatibility") == 0 ? CONTEXT_COMPATIBILITY
                                                                                   : CONTEXT_CORE;
    if (!context_open(&c, kind, 3, kind == CONTEXT_ES ? 0 : 3)) {
        printf("skipped: the driver has no such context\n");
        return 77;
    }
    printf("%s\n", (const char *)glGetString(GL_VERSION));
    picture_open(&p, FRAME_WIDTH, FRAME_HEIGHT, PICTURE_DEPTH_24);
    frames_open(&f);
    for (int i = 0; i < frames_wanted(); i++)
        frames_step(&f, p.framebuffer, i);
    frames_close(&f);
    state_calm();
    picture_close(&p);
    context_close(&c);
    printf("%d frames\n", frames_wanted());
    return 0;
}
