/* The context: EGL without a surface, so that no display is needed. */
#include "gpu/gpu_private.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static lmn_status no_gl(gpu **g, lmn_error *error, const char *what)
{
    lmn_status status = error_set(error, LMN_GL, "no usable OpenGL: %s", what);
    error_hint(error, "install Mesa's software driver: apt-get install libegl1 libopengl0 libgl1-mesa-dri; `limner "
                      "doctor` tells more");
    gpu_destroy(g);
    return status;
}

/* libepoxy ends the process when a library is missing, so that is found out first. */
static bool library_is_there(const char *const *names)
{
    for (; *names; names++) {
        void *handle = dlopen(*names, RTLD_LAZY | RTLD_LOCAL);
        if (handle)
            return true; /* stays open: it is needed anyway */
    }
    return false;
}

static EGLDisplay open_display(void)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDisplay  display = EGL_NO_DISPLAY;
    if (extensions && strstr(extensions, "EGL_MESA_platform_surfaceless"))
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY && extensions && strstr(extensions, "EGL_EXT_platform_device") &&
        strstr(extensions, "EGL_EXT_device_enumeration")) {
        EGLDeviceEXT device;
        EGLint       count = 0;
        if (eglQueryDevicesEXT(1, &device, &count) && count > 0)
            display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, NULL);
    }
    return display != EGL_NO_DISPLAY ? display : eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

static EGLContext open_version(EGLDisplay display, bool es, int major, int minor, bool debug)
{
    EGLint profile = es ? EGL_NONE : EGL_CONTEXT_OPENGL_PROFILE_MASK;
    EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,
        major,
        EGL_CONTEXT_MINOR_VERSION,
        minor,
        debug ? EGL_CONTEXT_OPENGL_DEBUG : profile,
        debug ? EGL_TRUE : EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
        debug ? profile : EGL_NONE,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
        EGL_NONE,
    };
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
}

/* Some drivers give the newest version that contains the one asked for, others just that one: the newest of use
 * comes first. */
static EGLContext open_context(EGLDisplay display, bool es, bool debug)
{
    static const int versions[2][4][2] = {{{4, 6}, {4, 5}, {4, 3}, {3, 3}}, {{3, 2}, {3, 1}, {3, 0}, {3, 0}}};
    EGLContext       context = EGL_NO_CONTEXT;
    for (int i = 0; i < 4 && context == EGL_NO_CONTEXT; i++)
        context = open_version(display, es, versions[es][i][0], versions[es][i][1], debug);
    return context;
}

static void read_capabilities(gpu *g, bool debug)
{
    gpu_capabilities *f = &g->capabilities;
    f->vendor = (const char *)glGetString(GL_VENDOR);
    f->renderer = (const char *)glGetString(GL_RENDERER);
    f->version = (const char *)glGetString(GL_VERSION);
    f->shading = (const char *)glGetString(GL_SHADING_LANGUAGE_VERSION);
    f->es = !epoxy_is_desktop_gl();
    f->debug = debug;
    f->software =
        strstr(f->renderer, "llvmpipe") || strstr(f->renderer, "softpipe") || strstr(f->renderer, "SwiftShader");
    f->lanes_stay = strstr(f->renderer, "llvmpipe") || strstr(f->renderer, "softpipe");
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &f->max_texture);
    float points[2] = {1, 1};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, points); /* core: GL_POINT_SIZE_RANGE, the same number */
    f->max_point = points[1];
    glGetIntegerv(GL_MAX_SAMPLES, &f->max_samples);
    glGetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &f->max_attachments);
    int         version = epoxy_gl_version();
    const char *path = getenv("LIMNER_PATH");
    bool        able = f->es ? version >= 31 : version >= 43;
    f->fast = able && !(path && strcmp(path, "floor") == 0);
    f->lists = f->fast && !f->es;
    if (able) {
        GLint64 storage = 0;
        glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &storage);
        f->max_storage_mib = (int)(storage >> 20);
    }
}

static void APIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                const GLchar *message, const void *user)
{
    (void)source, (void)id, (void)severity, (void)length;
    gpu *g = (gpu *)(uintptr_t)user;
    if (type == GL_DEBUG_TYPE_ERROR)
        gpu_fail(g, LMN_GL, "the driver reports: %s", message);
}

lmn_status gpu_create(gpu **out, bool es, bool debug, lmn_error *error)
{
    *out = NULL;
    gpu *g = mem_calloc(1, sizeof *g);
    if (!g)
        return error_memory(error);
    g->context = EGL_NO_CONTEXT;
    if (!library_is_there((const char *const[]){"libEGL.so.1", NULL}))
        return no_gl(&g, error, "libEGL.so.1 is not installed");
    if (!library_is_there(es ? (const char *const[]){"libGLESv2.so.2", NULL}
                             : (const char *const[]){"libOpenGL.so.0", "libGL.so.1", NULL}))
        return no_gl(&g, error, es ? "libGLESv2.so.2 is not installed" : "libOpenGL.so.0 is not installed");
    g->display = open_display();
    EGLint major = 0, minor = 0;
    if (g->display == EGL_NO_DISPLAY || !eglInitialize(g->display, &major, &minor)) {
        g->display = EGL_NO_DISPLAY;
        return no_gl(&g, error, "EGL finds no display and no surfaceless driver");
    }
    if (!eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API))
        return no_gl(&g, error, "EGL offers no OpenGL");
    g->context = open_context(g->display, es, debug);
    if (g->context == EGL_NO_CONTEXT)
        return no_gl(&g, error,
                     es ? "the driver gives no OpenGL ES 3.0 context" : "the driver gives no OpenGL 3.3 core context");
    if (!eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, g->context))
        return no_gl(&g, error, "the context cannot be used without a surface");
    read_capabilities(g, debug);
    g->capabilities.depth_clamp = !g->capabilities.es || epoxy_has_gl_extension("GL_EXT_depth_clamp");
    if (g->capabilities.es && !epoxy_has_gl_extension("GL_EXT_color_buffer_float") && epoxy_gl_version() < 32)
        return no_gl(&g, error, "the driver cannot draw into float pictures (EXT_color_buffer_float)");
    if (debug && (!g->capabilities.es || epoxy_gl_version() >= 32 || epoxy_has_gl_extension("GL_KHR_debug"))) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(on_message, g);
    }
    glGenVertexArrays(1, &g->empty_array);
    glGenQueries(GPU_QUERIES, g->queries);
    glGenVertexArrays(1, &g->boxes_array);
    glGenBuffers(1, &g->boxes_buffer);
    glBindVertexArray(g->boxes_array);
    glBindBuffer(GL_ARRAY_BUFFER, g->boxes_buffer);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(0);
    glBindVertexArray(0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    pace_start(g);
    *out = g;
    return LMN_OK;
}

void gpu_make_current(gpu *g)
{
    eglBindAPI(g->capabilities.es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
    if (!eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, g->context))
        gpu_fail(g, LMN_GL, "the OpenGL context cannot be made current on this thread");
}

static void release_objects(gpu *g)
{
    for (size_t i = 0; i < g->program_count; i++) {
        for (int u = 0; u < g->programs[i]->uniform_count; u++)
            mem_free((char *)g->programs[i]->uniforms[u].name);
        glDeleteProgram(g->programs[i]->name);
        mem_free(g->programs[i]->key);
        mem_free(g->programs[i]);
    }
    for (size_t i = 0; i < g->target_count; i++) {
        gpu_forget_framebuffers(g, g->targets[i]);
        glDeleteTextures(1, &g->targets[i]->name);
        mem_free(g->targets[i]);
    }
    for (size_t i = 0; i < g->buffer_count; i++) {
        glDeleteBuffers(1, &g->buffers[i]->name);
        mem_free(g->buffers[i]);
    }
    glDeleteVertexArrays(1, &g->empty_array);
    glDeleteQueries(GPU_QUERIES, g->queries);
    glDeleteVertexArrays(1, &g->boxes_array);
    glDeleteBuffers(1, &g->boxes_buffer);
}

void gpu_destroy(gpu **handle)
{
    if (!handle || !*handle)
        return;
    gpu *g = *handle;
    if (g->context != EGL_NO_CONTEXT) {
        gpu_make_current(g);
        /* Without the context GL has no functions to call; its objects go with it. */
        if (eglGetCurrentContext() == g->context)
            release_objects(g);
        mem_free(g->programs);
        mem_free(g->targets);
        mem_free(g->buffers);
        eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(g->display, g->context);
    }
    /* The display is process-wide and shared with other renderers; it is not terminated. */
    mem_free(g);
    *handle = NULL;
}
