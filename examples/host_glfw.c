/* A model that Limner draws in a window of GLFW's, turning, with the depth of the window's scene.
 * host_glfw MODEL LOOK [FRAMES] */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <limner/limner.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static lmn_error error;

static void must(lmn_status status)
{
    if (status == LMN_OK)
        return;
    fprintf(stderr, "%s\n%s\n", error.message, error.hint);
    exit(1);
}

/* Turned around the vertical axis, seen from a distance: column by column. */
static void set_camera(lmn_draw_desc *desc, const lmn_scene_info *info, double angle, double aspect)
{
    double size = 0, middle[3], scale = 2.5, near, far;
    for (int k = 0; k < 3; k++) {
        middle[k] = (info->bounds_min[k] + info->bounds_max[k]) / 2;
        size = fmax(size, info->bounds_max[k] - info->bounds_min[k]);
    }
    near = size, far = 7 * size;
    double c = cos(angle), s = sin(angle), *v = desc->view_matrix, *p = desc->projection_matrix;
    v[0] = v[10] = c, v[2] = -s, v[8] = s, v[5] = v[15] = 1;
    v[12] = -c * middle[0] - s * middle[2];
    v[13] = -middle[1];
    v[14] = s * middle[0] - c * middle[2] - 4 * size;
    p[0] = scale / aspect, p[5] = scale, p[11] = -1;
    p[10] = -(far + near) / (far - near), p[14] = -2 * far * near / (far - near);
    desc->matrices_given = true;
}

int main(int count, char **arguments)
{
    int         frames = count > 3 ? atoi(arguments[3]) : -1;
    GLFWwindow *window;
    if (count < 3 || !glfwInit())
        return 1;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window = glfwCreateWindow(640, 480, "Limner", NULL, NULL);
    if (!window)
        return 1;
    glfwMakeContextCurrent(window);

    lmn_renderer     *renderer;
    lmn_scene        *scene;
    lmn_look         *look;
    lmn_renderer_desc how = LMN_RENDERER_DESC_INIT;
    how.adopt = true; /* the context that is current */
    must(lmn_renderer_create(&renderer, &how, &error));
    must(lmn_scene_create(&scene, &error));
    must(lmn_scene_add_file(scene, arguments[1], NULL, &error));
    must(lmn_look_load(&look, arguments[2], &error));
    lmn_scene_info info = lmn_scene_info_of(scene);

    for (int i = 0; i != frames && !glfwWindowShouldClose(window); i++) {
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        lmn_target    target = LMN_TARGET_INIT; /* framebuffer 0: the window's */
        glfwGetFramebufferSize(window, &target.width, &target.height);
        target.depth = LMN_TARGET_DEPTH_TEST_AND_WRITE;
        set_camera(&desc, &info, 0.01 * i, (double)target.width / target.height);
        desc.background = "none";
        desc.samples = 1;

        glViewport(0, 0, target.width, target.height);
        glClearColor(0.9f, 0.87f, 0.8f, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        /* ... what the program draws itself, with the same matrices ... */
        must(lmn_draw_into(renderer, scene, look, &desc, &target, &error));
        /* ... and after it, too: the depth buffer knows the drawing ... */
        glfwSwapBuffers(window);
        glfwPollEvents();
    }
    lmn_renderer_destroy(&renderer); /* while its context is current */
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    glfwTerminate();
    return 0;
}
