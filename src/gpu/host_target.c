/* Drawing into a framebuffer of the host's. */
#include "gpu/host_state.h"

static bool has_depth(GLuint framebuffer)
{
    GLint type = GL_NONE;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, framebuffer ? GL_DEPTH_ATTACHMENT : GL_DEPTH,
                                          GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
    return type != GL_NONE;
}

/* Do what is written get encoded, whether or not one wants it? */
static bool encodes(const gpu *g, GLuint framebuffer)
{
    GLint encoding = GL_LINEAR;
    if (g->capabilities.es && !epoxy_has_gl_extension("GL_EXT_sRGB_write_control"))
        glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, framebuffer ? GL_COLOR_ATTACHMENT0 : GL_BACK,
                                              GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING, &encoding);
    return encoding == GL_SRGB;
}

static void mask_further_buffers(const gpu *g, GLboolean on)
{
    GLint count = 1;
    if (g->version >= (g->capabilities.es ? 32 : 30))
        glGetIntegerv(GL_MAX_DRAW_BUFFERS, &count);
    for (GLint i = 1; i < count && i < HOST_DRAW_BUFFERS; i++)
        glColorMaski((GLuint)i, on, on, on, on);
}

lmn_status gpu_host_open(gpu *g, unsigned framebuffer, bool depth, gpu_host_target *out, lmn_error *error)
{
    GLuint name = framebuffer;
    *out = (gpu_host_target){.framebuffer = framebuffer, .zero_to_one = g->host_zero_to_one};
    out->range[0] = g->host_range[0];
    out->range[1] = g->host_range[1];
    if (name && !glIsFramebuffer(name))
        return error_set(error, LMN_USAGE, "the context has no framebuffer %u", framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
    if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return error_set(error, LMN_USAGE, "the framebuffer %u of the target is not complete", framebuffer);
    if (depth && !has_depth(name)) {
        error_set(error, LMN_USAGE, "the framebuffer %u of the target has no depth", framebuffer);
        error_hint(error, "ask for it when it is made (gtk_gl_area_set_has_depth_buffer), or ignore depth");
        return LMN_USAGE;
    }
    out->encodes = encodes(g, name);
    return LMN_OK;
}

void gpu_host_begin(gpu *g, const gpu_host_target *target, const int box[4])
{
    if (g->failed)
        return;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target->framebuffer);
    glDisable(GL_CULL_FACE);
    glViewport(box[0], box[1], box[2], box[3]);
    glEnable(GL_SCISSOR_TEST);
    glScissor(box[0], box[1], box[2], box[3]);
    mask_further_buffers(g, GL_FALSE);
    for (int i = 0; i < 4; i++)
        g->box[i] = box[i];
}

void gpu_host_end(gpu *g)
{
    mask_further_buffers(g, GL_TRUE);
}
