#include "context.h"

static EGLDisplay display_of(void)
{
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    eglInitialize(display, NULL, NULL);
    return display;
}

bool context_open(context *out, context_kind kind, int major, int minor)
{
    EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                           major,
                           EGL_CONTEXT_MINOR_VERSION,
                           minor,
                           kind == CONTEXT_ES ? EGL_NONE : EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           kind == CONTEXT_CORE ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
                                                : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                           EGL_NONE};
    out->display = display_of();
    out->api = kind == CONTEXT_ES ? EGL_OPENGL_ES_API : EGL_OPENGL_API;
    eglBindAPI(out->api);
    out->context = eglCreateContext(out->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (out->context)
        context_make_current(out);
    return out->context != EGL_NO_CONTEXT;
}

void context_make_current(const context *c)
{
    eglBindAPI(c->api);
    eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, c->context);
}

void context_release(void)
{
    eglMakeCurrent(display_of(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void context_close(context *c)
{
    context_release();
    eglDestroyContext(c->display, c->context);
    c->context = EGL_NO_CONTEXT;
}

void picture_open(picture *out, int width, int height, picture_depth depth)
{
    GLenum format = depth == PICTURE_DEPTH_24 ? GL_DEPTH24_STENCIL8 : GL_DEPTH32F_STENCIL8;
    *out = (picture){.width = width, .height = height};
    glGenFramebuffers(1, &out->framebuffer);
    glGenRenderbuffers(1, &out->colour);
    glBindFramebuffer(GL_FRAMEBUFFER, out->framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, out->colour);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, out->colour);
    if (depth == PICTURE_DEPTH_NONE)
        return;
    glGenRenderbuffers(1, &out->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, out->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, out->depth);
}

void picture_close(picture *p)
{
    glDeleteFramebuffers(1, &p->framebuffer);
    glDeleteRenderbuffers(1, &p->colour);
    glDeleteRenderbuffers(1, &p->depth);
}
