/* The frames in a window of GLFW's, whose context GLX makes. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdio.h>

#include "frames.h"

int main(void)
{
    static frames f;
    glfwInitHint(GLFW_JOYSTICK_HAT_BUTTONS, GLFW_FALSE);
    if (!glfwInit())
        return 1;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    GLFWwindow *window = glfwCreateWindow(FRAME_WIDTH, FRAME_HEIGHT, "Limner", NULL, NULL);
    if (!window)
        return 1;
    glfwMakeContextCurrent(window);
    frames_open(&f);
    for (int i = 0; i < frames_wanted(); i++) {
        frames_step(&f, 0, i);
        glfwSwapBuffers(window);
        glfwPollEvents();
        must_be(glfwGetCurrentContext() == window, "the window's context is current");
    }
    frames_close(&f);
    glfwDestroyWindow(window);
    glfwTerminate();
    printf("%d frames\n", frames_wanted());
    return 0;
}
