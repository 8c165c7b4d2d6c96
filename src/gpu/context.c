/* The context: our own by EGL without a surface, so that no display is needed, or a host's. Current only while a call
 * runs. */
#include "gpu/gpu_private.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"

lmn_status gpu_no_gl(gpu **g, lmn_error *error, const char *what)
{
    lmn_status status = error_set(error, LMN_GL, "no usable OpenGL: %s", what);
    error_hint(error, "install Mesa's software driver: apt-get install libegl1 libopengl0 libgl1-mesa-dri; `limner "
                      "doctor` tells more");
    gpu_destroy(g);
    return status;
}

/* libepoxy ends the process when a library is missing, so that is found out first. */
bool gpu_library_is_there(const char *const *names)
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

/* `tells`: the driver says when the context is lost, where it can. */
static EGLContext open_version(EGLDisplay display, bool es, int major, int minor, bool debug, bool tells)
{
    EGLint attributes[11], count = 0;
    attributes[count++] = EGL_CONTEXT_MAJOR_VERSION;
    attributes[count++] = major;
    attributes[count++] = EGL_CONTEXT_MINOR_VERSION;
    attributes[count++] = minor;
    if (debug) {
        attributes[count++] = EGL_CONTEXT_OPENGL_DEBUG;
        attributes[count++] = EGL_TRUE;
    }
    if (!es) {
        attributes[count++] = EGL_CONTEXT_OPENGL_PROFILE_MASK;
        attributes[count++] = EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT;
    }
    if (tells) {
        attributes[count++] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY;
        attributes[count++] = EGL_LOSE_CONTEXT_ON_RESET;
    }
    attributes[count] = EGL_NONE;
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
}

/* Some drivers give the newest version that contains the one asked for, others just that one: the newest of use
 * comes first. */
static EGLContext open_context(EGLDisplay display, bool es, bool debug)
{
    static const int versions[2][4][2] = {{{4, 6}, {4, 5}, {4, 3}, {3, 3}}, {{3, 2}, {3, 1}, {3, 0}, {3, 0}}};
    EGLContext       context = EGL_NO_CONTEXT;
    for (int tells = epoxy_egl_version(display) >= 15; tells >= 0; tells--)
        for (int i = 0; i < 4 && context == EGL_NO_CONTEXT; i++)
            context = open_version(display, es, versions[es][i][0], versions[es][i][1], debug, tells);
    return context;
}

static void read_capabilities(gpu *g)
{
    gpu_capabilities *f = &g->capabilities;
    f->vendor = (const char *)glGetString(GL_VENDOR);
    f->renderer = (const char *)glGetString(GL_RENDERER);
    f->version = (const char *)glGetString(GL_VERSION);
    f->shading = (const char *)glGetString(GL_SHADING_LANGUAGE_VERSION);
    f->es = !epoxy_is_desktop_gl();
    f->software =
        strstr(f->renderer, "llvmpipe") || strstr(f->renderer, "softpipe") || strstr(f->renderer, "SwiftShader");
    f->lanes_stay = strstr(f->renderer, "llvmpipe") || strstr(f->renderer, "softpipe");
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &f->max_texture);
    float points[2] = {1, 1};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, points); /* core: GL_POINT_SIZE_RANGE, the same number */
    f->max_point = points[1];
    glGetIntegerv(GL_MAX_SAMPLES, &f->max_samples);
    glGetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &f->max_attachments);
    int         version = g->version;
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
    work_log(LMN_LOG_DRIVER, "driver", message);
}

lmn_status gpu_begin(gpu **out, bool debug, lmn_error *error)
{
    gpu *g = *out = mem_calloc(1, sizeof *g);
    if (!g)
        return error_memory(error);
    g->capabilities.debug = debug;
    g->before = current_get();
    if (!g->before.api)
        g->before.api = EGL_OPENGL_ES_API; /* of threads that have not asked for another one */
    atomic_store(&g->busy, true);
    return LMN_OK;
}

bool gpu_has_debug_output(const gpu *g)
{
    return !g->capabilities.es || g->version >= 32 || epoxy_has_gl_extension("GL_KHR_debug");
}

static void find_reset_status(gpu *g)
{
    if (g->version >= (g->capabilities.es ? 32 : 45) || epoxy_has_gl_extension("GL_KHR_robustness"))
        g->reset_status = glGetGraphicsResetStatus;
    else if (!g->capabilities.es && epoxy_has_gl_extension("GL_ARB_robustness"))
        g->reset_status = glGetGraphicsResetStatusARB;
    else if (g->capabilities.es && epoxy_has_gl_extension("GL_EXT_robustness"))
        g->reset_status = glGetGraphicsResetStatusEXT;
}

lmn_status gpu_start(gpu **handle, lmn_error *error)
{
    gpu *g = *handle;
    read_capabilities(g);
    g->capabilities.depth_clamp = !g->capabilities.es || epoxy_has_gl_extension("GL_EXT_depth_clamp");
    if (g->capabilities.es && !epoxy_has_gl_extension("GL_EXT_color_buffer_float") && g->version < 32)
        return gpu_no_gl(handle, error, "the driver cannot draw into float pictures (EXT_color_buffer_float)");
    find_reset_status(g);
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
    return LMN_OK;
}

lmn_status gpu_create(gpu **out, bool es, bool debug, lmn_error *error)
{
    gpu       *g;
    lmn_status status = gpu_begin(&g, debug, error);
    *out = NULL;
    if (status != LMN_OK)
        return status;
    if (!gpu_library_is_there((const char *const[]){"libEGL.so.1", NULL}))
        return gpu_no_gl(&g, error, "libEGL.so.1 is not installed");
    if (!gpu_library_is_there(es ? (const char *const[]){"libGLESv2.so.2", NULL}
                                 : (const char *const[]){"libOpenGL.so.0", "libGL.so.1", NULL}))
        return gpu_no_gl(&g, error, es ? "libGLESv2.so.2 is not installed" : "libOpenGL.so.0 is not installed");
    g->own = (current_context){.system = SYSTEM_EGL, .api = es ? EGL_OPENGL_ES_API : EGL_OPENGL_API};
    EGLDisplay display = open_display();
    EGLint     major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor))
        return gpu_no_gl(&g, error, "EGL finds no display and no surfaceless driver");
    g->own.display = display;
    if (!eglBindAPI(g->own.api))
        return gpu_no_gl(&g, error, "EGL offers no OpenGL");
    EGLContext context = open_context(display, es, debug);
    if (context == EGL_NO_CONTEXT)
        return gpu_no_gl(&g, error,
                         es ? "the driver gives no OpenGL ES 3.0 context"
                            : "the driver gives no OpenGL 3.3 core context");
    g->own.context = context;
    g->entered = current_set(&g->own, &g->before);
    if (!g->entered) {
        current_set(&g->before, &(current_context){0});
        return gpu_no_gl(&g, error, "the context cannot be used without a surface");
    }
    g->version = epoxy_gl_version();
    g->capabilities.es = !epoxy_is_desktop_gl();
    if (debug && gpu_has_debug_output(g)) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(on_message, g);
    }
    status = gpu_start(&g, error);
    *out = g;
    return status;
}

static lmn_status say_lost(gpu *g, lmn_error *error)
{
    g->gone = true;
    error_set(error, LMN_GL, "the graphics context was lost: the driver was reset");
    error_hint(error, g->adopted ? "destroy the renderer and the context, and adopt a new one"
                                 : "destroy the renderer and make a new one");
    return LMN_GL;
}

static bool is_lost(const gpu *g)
{
    return g->reset_status && g->reset_status() != GL_NO_ERROR;
}

lmn_status gpu_enter(gpu *g, lmn_error *error)
{
    if (atomic_exchange(&g->busy, true)) {
        error_set(error, LMN_USAGE,
                  "the renderer is in use: by another thread, or by a call whose callback made this one");
        error_hint(error, "one thread at a time uses a renderer; make one for each thread");
        return LMN_USAGE;
    }
    lmn_status status = LMN_OK;
    g->before = current_get();
    g->failed = false; /* what an earlier call has said */
    if (g->gone) {
        status = say_lost(g, error);
    } else if (g->adopted) {
        status = adopt_enter(g, error);
    } else if (!current_same(&g->own, &g->before) && !current_set(&g->own, &g->before)) {
        current_set(&g->before, &(current_context){0});
        status = error_set(error, LMN_GL, "the OpenGL context cannot be made current on this thread");
    }
    g->entered = status == LMN_OK;
    if (g->entered && is_lost(g))
        return gpu_leave(g, LMN_OK, error);
    if (!g->entered)
        atomic_store(&g->busy, false);
    return status;
}

lmn_status gpu_leave(gpu *g, lmn_status status, lmn_error *error)
{
    if (!g->gone && is_lost(g))
        status = say_lost(g, error);
    else if (g->adopted && g->capabilities.debug && status == LMN_OK) {
        GLenum code = glGetError();
        if (code != GL_NO_ERROR)
            status = error_set(error, LMN_GL, "the driver reports error 0x%04X", code);
    }
    if (g->adopted && !g->gone)
        adopt_leave(g);
    else if (!g->adopted && !current_same(&g->own, &g->before) && !current_set(&g->before, &g->own) && status == LMN_OK)
        status = error_set(error, LMN_GL, "what was current before cannot be made current again");
    g->entered = false;
    atomic_store(&g->busy, false);
    return status;
}

bool gpu_entered(const gpu *g)
{
    return g->entered;
}

void gpu_enter_to_free(gpu *g)
{
    if (!g->entered && gpu_enter(g, NULL) != LMN_OK)
        g->gone = true;
}

bool gpu_is_adopted(const gpu *g)
{
    return g->adopted;
}

static void release_objects(gpu *g)
{
    gpu_targets_trim(g);
    for (size_t i = 0; i < g->program_count; i++) {
        for (int u = 0; u < g->programs[i]->uniform_count; u++)
            mem_free((char *)g->programs[i]->uniforms[u].name);
        if (!g->gone)
            glDeleteProgram(g->programs[i]->name);
        mem_free(g->programs[i]->key);
        mem_free(g->programs[i]);
    }
    if (!g->gone) {
        glDeleteVertexArrays(1, &g->empty_array);
        glDeleteQueries(GPU_QUERIES, g->queries);
        glDeleteVertexArrays(1, &g->boxes_array);
        glDeleteBuffers(1, &g->boxes_buffer);
    }
    gpu_sources_release(g);
    mem_free(g->programs);
    mem_free(g->targets);
    mem_free(g->buffers);
}

void gpu_destroy(gpu **handle)
{
    if (!handle || !*handle)
        return;
    gpu *g = *handle;
    if (g->own.context) {
        gpu_enter_to_free(g);
        for (size_t i = 0; i < g->target_count; i++)
            g->targets[i]->in_use = false;
        for (size_t i = 0; i < g->buffer_count; i++)
            g->buffers[i]->in_use = false;
        release_objects(g);
        adopt_release(g);
        if (g->entered)
            gpu_leave(g, LMN_OK, NULL);
        if (!g->adopted)
            eglDestroyContext(g->own.display, g->own.context);
    } else if (g->own.api) {
        current_set(&g->before, &g->before); /* the API that was bound */
    }
    /* The display is process-wide and shared with other renderers; it is not terminated. */
    mem_free(g->host_values);
    mem_free(g->host_has);
    mem_free(g);
    *handle = NULL;
}
