#include "gpu/current.h"

#include <epoxy/egl.h>
#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

/* The library's function, when the process has loaded the library. Windowing libraries load theirs for themselves
 * alone, so that it is not found by its function's name. */
static void *loaded(const char *const *libraries, const char *function)
{
    void *found = NULL;
    for (; *libraries && !found; libraries++) {
        void *handle = dlopen(*libraries, RTLD_LAZY | RTLD_NOLOAD);
        if (!handle)
            continue;
        found = dlsym(handle, function);
        dlclose(handle);
    }
    return found;
}

static const char *const egl_libraries[] = {"libEGL.so.1", NULL}, *const glx_libraries[] = {"libGLX.so.0", "libGL.so.1",
                                                                                            NULL};

typedef void *(*pointer_fn)(void);
typedef unsigned long (*drawable_fn)(void);
typedef int (*glx_make_current_fn)(void *display, unsigned long draw, unsigned long read, void *context);
typedef EGLSurface (*surface_fn)(EGLint which);
typedef EGLBoolean (*egl_make_current_fn)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
typedef EGLenum (*query_api_fn)(void);
typedef EGLBoolean (*bind_api_fn)(EGLenum);

/* Functions are found as data pointers. */
#define FUNCTION(type, libraries, name) ((type)(size_t)loaded(libraries, name))

static bool get_glx(current_context *out)
{
    pointer_fn context = FUNCTION(pointer_fn, glx_libraries, "glXGetCurrentContext"),
               display = FUNCTION(pointer_fn, glx_libraries, "glXGetCurrentDisplay");
    drawable_fn draw = FUNCTION(drawable_fn, glx_libraries, "glXGetCurrentDrawable"),
                read = FUNCTION(drawable_fn, glx_libraries, "glXGetCurrentReadDrawable");
    if (!context || !display || !draw || !read)
        return false;
    out->context = context();
    if (!out->context)
        return false;
    out->system = SYSTEM_GLX;
    out->display = display();
    out->drawables[0] = draw();
    out->drawables[1] = read();
    return true;
}

/* A thread has one context for each API of EGL; of OpenGL and OpenGL ES, it is one for both. */
static bool get_egl(current_context *out)
{
    query_api_fn api = FUNCTION(query_api_fn, egl_libraries, "eglQueryAPI");
    bind_api_fn  bind = FUNCTION(bind_api_fn, egl_libraries, "eglBindAPI");
    pointer_fn   context = FUNCTION(pointer_fn, egl_libraries, "eglGetCurrentContext"),
               display = FUNCTION(pointer_fn, egl_libraries, "eglGetCurrentDisplay");
    surface_fn surface = FUNCTION(surface_fn, egl_libraries, "eglGetCurrentSurface");
    if (!api || !bind || !context || !display || !surface)
        return false;
    const EGLenum bound = api();
    out->api = bound;
    const EGLenum all[] = {bound, EGL_OPENGL_API, EGL_OPENGL_ES_API};
    for (size_t i = 0; i < 3 && !out->context; i++) {
        bind(all[i]);
        out->context = context();
        if (!out->context)
            continue;
        out->system = SYSTEM_EGL;
        out->display = display();
        out->surfaces[0] = surface(EGL_DRAW);
        out->surfaces[1] = surface(EGL_READ);
    }
    bind(bound);
    return out->context != NULL;
}

current_context current_get(void)
{
    current_context out = {.system = SYSTEM_NONE};
    if (!get_egl(&out))
        get_glx(&out);
    return out;
}

static bool set_glx(const current_context *c, bool release)
{
    glx_make_current_fn make = FUNCTION(glx_make_current_fn, glx_libraries, "glXMakeContextCurrent");
    return make &&
           make(c->display, release ? 0 : c->drawables[0], release ? 0 : c->drawables[1], release ? NULL : c->context);
}

static bool set_egl(const current_context *c, bool release)
{
    egl_make_current_fn make = FUNCTION(egl_make_current_fn, egl_libraries, "eglMakeCurrent");
    return make && make(c->display, release ? EGL_NO_SURFACE : c->surfaces[0],
                        release ? EGL_NO_SURFACE : c->surfaces[1], release ? EGL_NO_CONTEXT : c->context);
}

static bool set(const current_context *c, bool release)
{
    return c->system == SYSTEM_GLX ? set_glx(c, release) : set_egl(c, release);
}

bool current_set(const current_context *wanted, const current_context *before)
{
    bind_api_fn bind = FUNCTION(bind_api_fn, egl_libraries, "eglBindAPI");
    bool        good = true;
    if (before->context && before->system != wanted->system)
        good = set(before, true);
    if (bind && wanted->api)
        bind(wanted->api);
    if (good && wanted->context)
        good = set(wanted, false);
    return good;
}

bool current_same(const current_context *a, const current_context *b)
{
    return a->system == b->system && a->context == b->context;
}
