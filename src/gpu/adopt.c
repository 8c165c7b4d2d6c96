/* A host's context: taken as it is, with its state given back after each call. */
#include "gpu/host_state.h"

#include "base/memory.h"

/* Not for ever: a lost context reports errors without end. */
static void forget_errors(void)
{
    enum { MOST = 16 };
    for (int i = 0; i < MOST && glGetError() != GL_NO_ERROR; i++) {
    }
}

static lmn_status check_queries(const gpu *g, lmn_error *error)
{
    const char *running = host_state_in_the_way(g);
    if (!running)
        return LMN_OK;
    error_set(error, LMN_USAGE, "a query of %s is running in the context: it would count what Limner draws", running);
    error_hint(error, "end it before and begin another one afterwards");
    return LMN_USAGE;
}

/* How the host's depth is made. */
static void ask_depth(gpu *g)
{
    GLfloat range[2];
    GLint   mode = GL_NEGATIVE_ONE_TO_ONE;
    glGetFloatv(GL_DEPTH_RANGE, range);
    if (g->capabilities.es ? epoxy_has_gl_extension("GL_EXT_clip_control") : g->version >= 45)
        glGetIntegerv(GL_CLIP_DEPTH_MODE, &mode);
    g->host_zero_to_one = mode == GL_ZERO_TO_ONE;
    g->host_range[0] = (double)range[0];
    g->host_range[1] = (double)range[1];
}

lmn_status adopt_enter(gpu *g, lmn_error *error)
{
    if (!current_same(&g->own, &g->before)) {
        error_set(error, LMN_USAGE, "the context that the renderer has adopted is not current on this thread");
        error_hint(error, "make it current before calls with this renderer");
        return LMN_USAGE;
    }
    lmn_status status = check_queries(g, error);
    if (status != LMN_OK)
        return status;
    ask_depth(g);
    if (!g->keeps_state)
        host_state_save(g, g->host_values);
    host_state_set(g);
    forget_errors();
    return LMN_OK;
}

void adopt_leave(gpu *g)
{
    if (!g->keeps_state)
        host_state_restore(g, g->host_values);
    forget_errors();
}

/* A framebuffer with stencil: only with one do contexts tell all of their stencil state. */
static void make_probe(gpu *g)
{
    GLint framebuffer, renderbuffer;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    glGetIntegerv(GL_RENDERBUFFER_BINDING, &renderbuffer);
    glGenFramebuffers(1, &g->probe);
    glGenRenderbuffers(1, &g->probe_buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, g->probe_buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, 1, 1);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, g->probe);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, g->probe_buffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, (GLuint)renderbuffer);
}

void adopt_release(gpu *g)
{
    if (g->gone || !g->adopted)
        return;
    glDeleteFramebuffers(1, &g->probe);
    glDeleteRenderbuffers(1, &g->probe_buffer);
}

static lmn_status too_old(gpu **g, lmn_error *error)
{
    bool es = (*g)->capabilities.es;
    int  version = (*g)->version;
    error_set(error, LMN_GL, "the context that is current has OpenGL %s%d.%d; OpenGL 3.3 or OpenGL ES 3.0 is needed",
              es ? "ES " : "", version / 10, version % 10);
    error_hint(error, "ask for a newer one when the context is made, or let the renderer have its own");
    gpu_destroy(g);
    return LMN_GL;
}

static lmn_status none_current(gpu **g, lmn_error *error)
{
    error_set(error, LMN_USAGE, "no OpenGL context is current on this thread that could be adopted");
    error_hint(error, "make one of EGL or GLX current first (glfwMakeContextCurrent, SDL_GL_MakeCurrent, "
                      "gtk_gl_area_make_current)");
    gpu_destroy(g);
    return LMN_USAGE;
}

/* What the profile and the table of state are here. */
static bool prepare(gpu *g)
{
    GLint profile = GL_CONTEXT_CORE_PROFILE_BIT;
    if (!g->capabilities.es)
        glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    g->compatibility = (profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT) != 0;
    g->host_values = mem_calloc(host_row_count, sizeof *g->host_values);
    g->host_has = mem_calloc(host_row_count, sizeof *g->host_has);
    for (size_t i = 0; g->host_has && i < host_row_count; i++)
        g->host_has[i] = host_row_applies(g, &host_rows[i]);
    return g->host_values && g->host_has;
}

lmn_status gpu_adopt(gpu **out, bool debug, bool keeps_state, lmn_error *error)
{
    gpu       *g;
    lmn_status status = gpu_begin(&g, debug, error);
    *out = NULL;
    if (status != LMN_OK)
        return status;
    if (!g->before.context)
        return none_current(&g, error);
    if (!gpu_library_is_there((const char *const[]){"libOpenGL.so.0", "libGL.so.1", "libGLESv2.so.2", NULL}))
        return gpu_no_gl(&g, error, "libOpenGL.so.0 is not installed");
    g->adopted = true;
    g->keeps_state = keeps_state;
    g->version = epoxy_gl_version();
    g->capabilities.es = !epoxy_is_desktop_gl();
    if (g->version < (g->capabilities.es ? 30 : 33))
        return too_old(&g, error);
    if (!prepare(g)) {
        gpu_destroy(&g);
        return error_memory(error);
    }
    status = check_queries(g, error);
    if (status != LMN_OK) {
        gpu_destroy(&g);
        return status;
    }
    make_probe(g);
    g->own = g->before;
    g->entered = true;
    adopt_enter(g, NULL);
    status = gpu_start(&g, error);
    *out = g;
    return status;
}
