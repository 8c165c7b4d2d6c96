/* The frames in a window of SDL's. */
#include <SDL.h>
#include <stdio.h>

#include "frames.h"

int main(int count, char **arguments)
{
    static frames f;
    (void)count, (void)arguments;
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        return 1;
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 24);
    SDL_GL_SetAttribute(SDL_GL_STENCIL_SIZE, 8);
    SDL_Window   *window = SDL_CreateWindow("Limner", 0, 0, FRAME_WIDTH, FRAME_HEIGHT, SDL_WINDOW_OPENGL);
    SDL_GLContext context = window ? SDL_GL_CreateContext(window) : NULL;
    if (!context) {
        printf("%s\n", SDL_GetError());
        return 1;
    }
    frames_open(&f);
    for (int i = 0; i < frames_wanted(); i++) {
        SDL_Event event;
        frames_step(&f, 0, i);
        SDL_GL_SwapWindow(window);
        while (SDL_PollEvent(&event)) {
        }
        must_be(SDL_GL_GetCurrentContext() == context, "the window's context is current");
    }
    frames_close(&f);
    SDL_GL_DeleteContext(context);
    SDL_DestroyWindow(window);
    SDL_Quit();
    printf("%d frames\n", frames_wanted());
    return 0;
}
