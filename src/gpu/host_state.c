#include "gpu/host_state.h"

/* --- on or off --- */

static void save_switch(gpu *g, GLenum what, host_value *out)
{
    (void)g;
    out->i[0] = glIsEnabled(what);
}

static void set_switch(gpu *g, GLenum what, GLint on)
{
    (void)g;
    (on ? glEnable : glDisable)(what);
}

static void restore_switch(gpu *g, GLenum what, const host_value *saved)
{
    set_switch(g, what, saved->i[0]);
}

/* --- one number --- */

static void save_number(gpu *g, GLenum what, host_value *out)
{
    (void)g;
    glGetIntegerv(what, out->i);
}

#define NUMBER(name, call)                                                                                             \
    static void set_##name(gpu *g, GLenum what, GLint value)                                                           \
    {                                                                                                                  \
        (void)g, (void)what;                                                                                           \
        call;                                                                                                          \
    }                                                                                                                  \
    static void restore_##name(gpu *g, GLenum what, const host_value *saved)                                           \
    {                                                                                                                  \
        set_##name(g, what, saved->i[0]);                                                                              \
    }

NUMBER(depth_mask, glDepthMask((GLboolean)value))
NUMBER(depth_function, glDepthFunc((GLenum)value))
NUMBER(cull_mode, glCullFace((GLenum)value))
NUMBER(front_face, glFrontFace((GLenum)value))
NUMBER(provoking_vertex, glProvokingVertex((GLenum)value))
NUMBER(derivative_hint, glHint(what, (GLenum)value))
NUMBER(clamp_colour, glClampColor(what, (GLenum)value))
NUMBER(pixel_store, glPixelStorei(what, value))
NUMBER(active_unit, glActiveTexture((GLenum)value))
NUMBER(program, glUseProgram((GLuint)value))
NUMBER(vertex_array, glBindVertexArray((GLuint)value))
NUMBER(draw_framebuffer, glBindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)value))
NUMBER(read_framebuffer, glBindFramebuffer(GL_READ_FRAMEBUFFER, (GLuint)value))
NUMBER(array_buffer, glBindBuffer(GL_ARRAY_BUFFER, (GLuint)value))
NUMBER(pack_buffer, glBindBuffer(GL_PIXEL_PACK_BUFFER, (GLuint)value))
NUMBER(unpack_buffer, glBindBuffer(GL_PIXEL_UNPACK_BUFFER, (GLuint)value))
NUMBER(storage_buffer, glBindBuffer(GL_SHADER_STORAGE_BUFFER, (GLuint)value))

/* --- several of a kind --- */

static int least(GLint a, int b)
{
    return a < b ? a : b;
}

static int viewport_count(const gpu *g)
{
    GLint count = 1;
    if (!g->capabilities.es && g->version >= 41)
        glGetIntegerv(GL_MAX_VIEWPORTS, &count);
    return least(count, HOST_VIEWPORTS);
}

static int draw_buffer_count(const gpu *g, int desktop)
{
    GLint count = 1;
    if (g->version >= (g->capabilities.es ? 32 : desktop))
        glGetIntegerv(GL_MAX_DRAW_BUFFERS, &count);
    return least(count, HOST_DRAW_BUFFERS);
}

static void save_viewports(gpu *g, GLenum what, host_value *out)
{
    int count = viewport_count(g);
    if (count == 1)
        glGetFloatv(what, out->f);
    for (int i = 0; i < count && count > 1; i++)
        glGetFloati_v(what, (GLuint)i, &out->f[4 * i]);
}

static void restore_viewports(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    int            count = viewport_count(g);
    const GLfloat *v = saved->f;
    if (count == 1)
        glViewport((GLint)v[0], (GLint)v[1], (GLsizei)v[2], (GLsizei)v[3]);
    else
        glViewportArrayv(0, count, v);
}

static void save_scissors(gpu *g, GLenum what, host_value *out)
{
    int count = viewport_count(g);
    if (count == 1)
        glGetIntegerv(what, out->i);
    for (int i = 0; i < count && count > 1; i++)
        glGetIntegeri_v(what, (GLuint)i, &out->i[4 * i]);
}

static void restore_scissors(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    int count = viewport_count(g);
    if (count == 1)
        glScissor(saved->i[0], saved->i[1], saved->i[2], saved->i[3]);
    else
        glScissorArrayv(0, count, saved->i);
}

static void save_switches(int count, GLenum what, host_value *out)
{
    if (count == 1)
        out->i[0] = glIsEnabled(what);
    for (int i = 0; i < count && count > 1; i++)
        out->i[i] = glIsEnabledi(what, (GLuint)i);
}

static void restore_switches(int count, GLenum what, const host_value *saved)
{
    if (count == 1)
        set_switch(NULL, what, saved->i[0]);
    for (int i = 0; i < count && count > 1; i++)
        (saved->i[i] ? glEnablei : glDisablei)(what, (GLuint)i);
}

static void save_scissor_tests(gpu *g, GLenum what, host_value *out)
{
    save_switches(viewport_count(g), what, out);
}

static void restore_scissor_tests(gpu *g, GLenum what, const host_value *saved)
{
    restore_switches(viewport_count(g), what, saved);
}

static void save_blends(gpu *g, GLenum what, host_value *out)
{
    save_switches(draw_buffer_count(g, 30), what, out);
}

static void restore_blends(gpu *g, GLenum what, const host_value *saved)
{
    restore_switches(draw_buffer_count(g, 30), what, saved);
}

static void save_depth_ranges(gpu *g, GLenum what, host_value *out)
{
    int     count = viewport_count(g);
    GLfloat range[2];
    if (count == 1) {
        glGetFloatv(what, range);
        out->d[0] = (GLdouble)range[0];
        out->d[1] = (GLdouble)range[1];
    }
    for (int i = 0; i < count && count > 1; i++)
        glGetDoublei_v(what, (GLuint)i, &out->d[2 * i]);
}

static void set_depth_range(gpu *g, GLenum what, GLint value)
{
    (void)what, (void)value;
    if (g->capabilities.es)
        glDepthRangef(0, 1);
    else
        glDepthRange(0, 1);
}

static void restore_depth_ranges(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    int count = viewport_count(g);
    if (count > 1)
        glDepthRangeArrayv(0, count, saved->d);
    else if (g->capabilities.es)
        glDepthRangef((GLfloat)saved->d[0], (GLfloat)saved->d[1]);
    else
        glDepthRange(saved->d[0], saved->d[1]);
}

/* Per draw buffer: source and target factor of colours, of alpha, equations. */
enum { BLEND_NUMBERS = 6 };
static const GLenum blend_numbers[BLEND_NUMBERS] = {
    GL_BLEND_SRC_RGB,   GL_BLEND_DST_RGB,      GL_BLEND_SRC_ALPHA,
    GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA,
};

static void save_blend_functions(gpu *g, GLenum what, host_value *out)
{
    (void)what;
    int count = draw_buffer_count(g, 40);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < BLEND_NUMBERS; k++)
            if (count == 1)
                glGetIntegerv(blend_numbers[k], &out->i[k]);
            else
                glGetIntegeri_v(blend_numbers[k], (GLuint)i, &out->i[i * BLEND_NUMBERS + k]);
}

static void restore_blend_functions(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    int count = draw_buffer_count(g, 40);
    for (int i = 0; i < count; i++) {
        const GLint *v = &saved->i[i * BLEND_NUMBERS];
        if (count == 1) {
            glBlendFuncSeparate((GLenum)v[0], (GLenum)v[1], (GLenum)v[2], (GLenum)v[3]);
            glBlendEquationSeparate((GLenum)v[4], (GLenum)v[5]);
        } else {
            glBlendFuncSeparatei((GLuint)i, (GLenum)v[0], (GLenum)v[1], (GLenum)v[2], (GLenum)v[3]);
            glBlendEquationSeparatei((GLuint)i, (GLenum)v[4], (GLenum)v[5]);
        }
    }
}

static void save_colour_masks(gpu *g, GLenum what, host_value *out)
{
    int count = draw_buffer_count(g, 30);
    for (int i = 0; i < count; i++) {
        GLboolean mask[4];
        if (count == 1)
            glGetBooleanv(what, mask);
        else
            glGetBooleani_v(what, (GLuint)i, mask);
        for (int k = 0; k < 4; k++)
            out->i[4 * i + k] = mask[k];
    }
}

static void set_colour_masks(gpu *g, GLenum what, GLint value)
{
    (void)g, (void)what;
    GLboolean on = (GLboolean)value;
    glColorMask(on, on, on, on);
}

static void restore_colour_masks(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    int count = draw_buffer_count(g, 30);
    for (int i = 0; i < count; i++) {
        GLboolean mask[4];
        for (int k = 0; k < 4; k++)
            mask[k] = (GLboolean)saved->i[4 * i + k];
        if (count == 1)
            glColorMask(mask[0], mask[1], mask[2], mask[3]);
        else
            glColorMaski((GLuint)i, mask[0], mask[1], mask[2], mask[3]);
    }
}

/* Front, then back. */
enum { STENCIL_NUMBERS = 7 };
static const GLenum stencil_numbers[2][STENCIL_NUMBERS] = {
    {GL_STENCIL_FUNC, GL_STENCIL_REF, GL_STENCIL_VALUE_MASK, GL_STENCIL_FAIL, GL_STENCIL_PASS_DEPTH_FAIL,
     GL_STENCIL_PASS_DEPTH_PASS, GL_STENCIL_WRITEMASK},
    {GL_STENCIL_BACK_FUNC, GL_STENCIL_BACK_REF, GL_STENCIL_BACK_VALUE_MASK, GL_STENCIL_BACK_FAIL,
     GL_STENCIL_BACK_PASS_DEPTH_FAIL, GL_STENCIL_BACK_PASS_DEPTH_PASS, GL_STENCIL_BACK_WRITEMASK},
};

/* References are told as far as the framebuffer that is bound has bits for them. */
static void save_stencil(gpu *g, GLenum what, host_value *out)
{
    (void)what;
    GLint bound;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, g->probe);
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < STENCIL_NUMBERS; k++)
            glGetIntegerv(stencil_numbers[side][k], &out->i[side * STENCIL_NUMBERS + k]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)bound);
}

static void set_stencil(gpu *g, GLenum what, GLint value)
{
    (void)g, (void)what, (void)value;
    glStencilFunc(GL_ALWAYS, 0, ~0U);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glStencilMask(~0U);
}

static void restore_stencil(gpu *g, GLenum what, const host_value *saved)
{
    (void)g, (void)what;
    for (int side = 0; side < 2; side++) {
        const GLint *v = &saved->i[side * STENCIL_NUMBERS];
        GLenum       face = side ? GL_BACK : GL_FRONT;
        glStencilFuncSeparate(face, (GLenum)v[0], v[1], (GLuint)v[2]);
        glStencilOpSeparate(face, (GLenum)v[3], (GLenum)v[4], (GLenum)v[5]);
        glStencilMaskSeparate(face, (GLuint)v[6]);
    }
}

/* Compatibility profiles have one for each side. */
static void save_polygon_mode(gpu *g, GLenum what, host_value *out)
{
    (void)g;
    GLint modes[2] = {0, 0};
    glGetIntegerv(what, modes);
    out->i[0] = modes[0];
    out->i[1] = modes[1] ? modes[1] : modes[0];
}

static void set_polygon_mode(gpu *g, GLenum what, GLint value)
{
    (void)g, (void)what;
    glPolygonMode(GL_FRONT_AND_BACK, (GLenum)value);
}

static void restore_polygon_mode(gpu *g, GLenum what, const host_value *saved)
{
    if (!g->compatibility) {
        set_polygon_mode(g, what, saved->i[0]);
        return;
    }
    glPolygonMode(GL_FRONT, (GLenum)saved->i[0]);
    glPolygonMode(GL_BACK, (GLenum)saved->i[1]);
}

static void save_clip_control(gpu *g, GLenum what, host_value *out)
{
    (void)g, (void)what;
    glGetIntegerv(GL_CLIP_ORIGIN, &out->i[0]);
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &out->i[1]);
}

static void clip_control(const gpu *g, GLenum origin, GLenum depth)
{
    if (g->capabilities.es)
        glClipControlEXT(origin, depth);
    else
        glClipControl(origin, depth);
}

static void set_clip_control(gpu *g, GLenum what, GLint value)
{
    (void)what, (void)value;
    clip_control(g, GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

static void restore_clip_control(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    clip_control(g, (GLenum)saved->i[0], (GLenum)saved->i[1]);
}

static void save_clip_distances(gpu *g, GLenum what, host_value *out)
{
    (void)g;
    for (GLenum i = 0; i < 8; i++)
        out->i[i] = glIsEnabled(what + i);
}

static void set_clip_distances(gpu *g, GLenum what, GLint value)
{
    for (GLenum i = 0; i < 8; i++)
        set_switch(g, what + i, value);
}

static void restore_clip_distances(gpu *g, GLenum what, const host_value *saved)
{
    for (GLenum i = 0; i < 8; i++)
        set_switch(g, what + i, saved->i[i]);
}

/* --- what is bound --- */

/* Unit by unit: picture, array of pictures, sampler. */
static void save_units(gpu *g, GLenum what, host_value *out)
{
    (void)g;
    static const GLenum bindings[3] = {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY, GL_SAMPLER_BINDING};
    GLint               active;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLenum unit = 0; unit < HOST_UNITS; unit++) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (int k = 0; k < 3; k++)
            glGetIntegerv(bindings[k], &out->i[unit * 3 + (GLenum)k]);
    }
    (void)what;
    glActiveTexture((GLenum)active);
}

static void set_units(gpu *g, GLenum what, GLint value)
{
    (void)g, (void)what, (void)value;
    for (GLuint unit = 0; unit < HOST_UNITS; unit++)
        glBindSampler(unit, 0);
}

static void restore_units(gpu *g, GLenum what, const host_value *saved)
{
    (void)g, (void)what;
    for (GLenum unit = 0; unit < HOST_UNITS; unit++) {
        const GLint *v = &saved->i[unit * 3];
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, (GLuint)v[0]);
        glBindTexture(GL_TEXTURE_2D_ARRAY, (GLuint)v[1]);
        glBindSampler(unit, (GLuint)v[2]);
    }
}

/* Buffer, first byte, bytes. */
static void save_storage(gpu *g, GLenum what, host_value *out)
{
    (void)g, (void)what;
    for (GLuint i = 0; i < HOST_STORAGE; i++) {
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &out->l[3 * i]);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, i, &out->l[3 * i + 1]);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, i, &out->l[3 * i + 2]);
    }
}

static void restore_storage(gpu *g, GLenum what, const host_value *saved)
{
    (void)g, (void)what;
    for (GLuint i = 0; i < HOST_STORAGE; i++) {
        const GLint64 *v = &saved->l[3 * i];
        if (v[2])
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, (GLuint)v[0], (GLintptr)v[1], (GLsizeiptr)v[2]);
        else
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, (GLuint)v[0]);
    }
}

/* In compatibility profiles the first is the position, which has no current value. */
static void save_attributes(gpu *g, GLenum what, host_value *out)
{
    for (GLuint i = g->compatibility; i < HOST_ATTRIBUTES; i++)
        glGetVertexAttribfv(i, what, &out->f[4 * i]);
}

static void set_attributes(gpu *g, GLenum what, GLint value)
{
    (void)what, (void)value;
    for (GLuint i = g->compatibility; i < HOST_ATTRIBUTES; i++)
        glVertexAttrib4f(i, 0, 0, 0, 1);
}

static void restore_attributes(gpu *g, GLenum what, const host_value *saved)
{
    (void)what;
    for (GLuint i = g->compatibility; i < HOST_ATTRIBUTES; i++)
        glVertexAttrib4fv(i, &saved->f[4 * i]);
}

/* While it runs, programs cannot be changed. */
static void save_feedback(gpu *g, GLenum what, host_value *out)
{
    (void)g, (void)what;
    GLint paused = 0;
    glGetIntegerv(GL_TRANSFORM_FEEDBACK_ACTIVE, &out->i[0]);
    glGetIntegerv(GL_TRANSFORM_FEEDBACK_PAUSED, &paused);
    out->i[0] = out->i[0] && !paused;
}

static void set_feedback(gpu *g, GLenum what, GLint value)
{
    host_value now;
    (void)value;
    save_feedback(g, what, &now);
    if (now.i[0])
        glPauseTransformFeedback();
}

static void restore_feedback(gpu *g, GLenum what, const host_value *saved)
{
    (void)g, (void)what;
    if (saved->i[0])
        glResumeTransformFeedback();
}

/* --- compatibility profiles --- */

static void save_transfer(gpu *g, GLenum what, host_value *out)
{
    (void)g;
    glGetFloatv(what, out->f);
}

static void set_transfer(gpu *g, GLenum what, GLint value)
{
    (void)g;
    glPixelTransferf(what, (GLfloat)value);
}

static void restore_transfer(gpu *g, GLenum what, const host_value *saved)
{
    (void)g;
    glPixelTransferf(what, saved->f[0]);
}

/* --- the table --- */

#define SWITCH(group, name, on, desktop, es, extension)                                                                \
    {                                                                                                                  \
        group, #name, on ? "on" : "off", desktop, es, extension, false, name, on, save_switch, set_switch,             \
            restore_switch                                                                                             \
    }
#define TOGGLED(group, name, desktop, es, extension)                                                                   \
    {                                                                                                                  \
        group, #name, "off and on", desktop, es, extension, false, name, 0, save_switch, set_switch, restore_switch    \
    }
#define OLD_SWITCH(name)                                                                                               \
    {                                                                                                                  \
        "Compatibility profiles", #name, "off", 33, 0, NULL, true, name, 0, save_switch, set_switch, restore_switch    \
    }
#define STORE(name, value, desktop, es)                                                                                \
    {                                                                                                                  \
        "Pixel transfer", #name, #value, desktop, es, NULL, false, name, value, save_number, set_pixel_store,          \
            restore_pixel_store                                                                                        \
    }
#define TRANSFER(name, value)                                                                                          \
    {                                                                                                                  \
        "Compatibility profiles", #name, #value, 33, 0, NULL, true, name, value, save_transfer, set_transfer,          \
            restore_transfer                                                                                           \
    }

/* Given back from the last to the first: what is bound to units is there before the unit is chosen. */
const host_row host_rows[] = {
    {"Binding", "transform feedback", "paused", 40, 30, NULL, false, 0, 0, save_feedback, set_feedback,
     restore_feedback},
    {"Binding", "GL_DRAW_FRAMEBUFFER", "Limner's", 33, 30, NULL, false, GL_DRAW_FRAMEBUFFER_BINDING, 0, save_number,
     NULL, restore_draw_framebuffer},
    {"Binding", "GL_READ_FRAMEBUFFER", "Limner's", 33, 30, NULL, false, GL_READ_FRAMEBUFFER_BINDING, 0, save_number,
     NULL, restore_read_framebuffer},
    {"Binding", "program", "Limner's", 33, 30, NULL, false, GL_CURRENT_PROGRAM, 0, save_number, NULL, restore_program},
    {"Binding", "vertex array", "Limner's", 33, 30, NULL, false, GL_VERTEX_ARRAY_BINDING, 0, save_number,
     set_vertex_array, restore_vertex_array},
    {"Binding", "GL_ARRAY_BUFFER", "Limner's", 33, 30, NULL, false, GL_ARRAY_BUFFER_BINDING, 0, save_number, NULL,
     restore_array_buffer},
    {"Binding", "GL_PIXEL_PACK_BUFFER", "none", 33, 30, NULL, false, GL_PIXEL_PACK_BUFFER_BINDING, 0, save_number,
     set_pack_buffer, restore_pack_buffer},
    {"Binding", "GL_PIXEL_UNPACK_BUFFER", "none", 33, 30, NULL, false, GL_PIXEL_UNPACK_BUFFER_BINDING, 0, save_number,
     set_unpack_buffer, restore_unpack_buffer},
    {"Binding", "GL_SHADER_STORAGE_BUFFER", "Limner's", 43, 0, NULL, false, GL_SHADER_STORAGE_BUFFER_BINDING, 0,
     save_number, NULL, restore_storage_buffer},
    {"Binding", "GL_SHADER_STORAGE_BUFFER 0 … 7, with their ranges", "Limner's", 43, 0, NULL, false, 0, 0, save_storage,
     NULL, restore_storage},
    {"Binding", "GL_ACTIVE_TEXTURE", "any", 33, 30, NULL, false, GL_ACTIVE_TEXTURE, GL_TEXTURE0, save_number, NULL,
     restore_active_unit},
    {"Binding", "GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY and samplers of units 0 … 15", "Limner's, no samplers", 33, 30,
     NULL, false, 0, 0, save_units, set_units, restore_units},
    {"Binding", "GL_CURRENT_VERTEX_ATTRIB 0 … 15", "0, 0, 0, 1 (as floats)", 33, 30, NULL, false,
     GL_CURRENT_VERTEX_ATTRIB, 0, save_attributes, set_attributes, restore_attributes},

    {"Page and depth", "GL_VIEWPORT, all", "the picture", 33, 30, NULL, false, GL_VIEWPORT, 0, save_viewports, NULL,
     restore_viewports},
    {"Page and depth", "GL_SCISSOR_BOX, all", "what is drawn", 33, 30, NULL, false, GL_SCISSOR_BOX, 0, save_scissors,
     NULL, restore_scissors},
    {"Page and depth", "GL_SCISSOR_TEST, all", "off and on", 33, 30, NULL, false, GL_SCISSOR_TEST, 0,
     save_scissor_tests, set_switch, restore_scissor_tests},
    {"Page and depth", "GL_DEPTH_RANGE, all", "0 … 1", 33, 30, NULL, false, GL_DEPTH_RANGE, 0, save_depth_ranges,
     set_depth_range, restore_depth_ranges},
    TOGGLED("Page and depth", GL_DEPTH_TEST, 33, 30, NULL),
    {"Page and depth", "GL_DEPTH_WRITEMASK", "off and on", 33, 30, NULL, false, GL_DEPTH_WRITEMASK, 1, save_number,
     set_depth_mask, restore_depth_mask},
    {"Page and depth", "GL_DEPTH_FUNC", "several", 33, 30, NULL, false, GL_DEPTH_FUNC, GL_LESS, save_number,
     set_depth_function, restore_depth_function},
    TOGGLED("Page and depth", GL_DEPTH_CLAMP, 33, 0, "GL_EXT_depth_clamp"),
    SWITCH("Page and depth", GL_DEPTH_BOUNDS_TEST_EXT, 0, 0, 0, "GL_EXT_depth_bounds_test"),
    {"Page and depth", "glClipControl", "GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE", 45, 0, "GL_EXT_clip_control", false, 0,
     0, save_clip_control, set_clip_control, restore_clip_control},
    {"Page and depth", "GL_CLIP_DISTANCE0 … 7", "off", 33, 0, "GL_EXT_clip_cull_distance", false, GL_CLIP_DISTANCE0, 0,
     save_clip_distances, set_clip_distances, restore_clip_distances},
    TOGGLED("Page and depth", GL_STENCIL_TEST, 33, 30, NULL),
    {"Page and depth", "stencil functions, operations and masks, front and back", "several", 33, 30, NULL, false, 0, 0,
     save_stencil, set_stencil, restore_stencil},

    {"Colour", "GL_BLEND, all draw buffers", "off and on", 33, 30, NULL, false, GL_BLEND, 0, save_blends, set_switch,
     restore_blends},
    {"Colour", "blend functions and equations, all draw buffers", "several", 33, 30, NULL, false, 0, 0,
     save_blend_functions, NULL, restore_blend_functions},
    {"Colour", "GL_COLOR_WRITEMASK, all draw buffers", "all", 33, 30, NULL, false, GL_COLOR_WRITEMASK, 1,
     save_colour_masks, set_colour_masks, restore_colour_masks},
    SWITCH("Colour", GL_COLOR_LOGIC_OP, 0, 33, 0, NULL),
    SWITCH("Colour", GL_DITHER, 1, 33, 30, NULL),
    SWITCH("Colour", GL_FRAMEBUFFER_SRGB, 0, 33, 0, "GL_EXT_sRGB_write_control"),
    {"Colour", "GL_CLAMP_READ_COLOR", "GL_FIXED_ONLY", 33, 0, NULL, false, GL_CLAMP_READ_COLOR, GL_FIXED_ONLY,
     save_number, set_clamp_colour, restore_clamp_colour},

    TOGGLED("Triangles and samples", GL_CULL_FACE, 33, 30, NULL),
    {"Triangles and samples", "GL_CULL_FACE_MODE", "several", 33, 30, NULL, false, GL_CULL_FACE_MODE, GL_BACK,
     save_number, set_cull_mode, restore_cull_mode},
    {"Triangles and samples", "GL_FRONT_FACE", "GL_CCW", 33, 30, NULL, false, GL_FRONT_FACE, GL_CCW, save_number,
     set_front_face, restore_front_face},
    {"Triangles and samples", "GL_POLYGON_MODE", "GL_FILL", 33, 0, NULL, false, GL_POLYGON_MODE, GL_FILL,
     save_polygon_mode, set_polygon_mode, restore_polygon_mode},
    SWITCH("Triangles and samples", GL_POLYGON_OFFSET_FILL, 0, 33, 30, NULL),
    SWITCH("Triangles and samples", GL_POLYGON_SMOOTH, 0, 33, 0, NULL),
    SWITCH("Triangles and samples", GL_RASTERIZER_DISCARD, 0, 33, 30, NULL),
    SWITCH("Triangles and samples", GL_PRIMITIVE_RESTART, 0, 33, 0, NULL),
    SWITCH("Triangles and samples", GL_PRIMITIVE_RESTART_FIXED_INDEX, 0, 43, 30, NULL),
    {"Triangles and samples", "GL_PROVOKING_VERTEX", "GL_LAST_VERTEX_CONVENTION", 33, 0, NULL, false,
     GL_PROVOKING_VERTEX, GL_LAST_VERTEX_CONVENTION, save_number, set_provoking_vertex, restore_provoking_vertex},
    TOGGLED("Triangles and samples", GL_PROGRAM_POINT_SIZE, 33, 0, NULL),
    {"Triangles and samples", "GL_FRAGMENT_SHADER_DERIVATIVE_HINT", "GL_DONT_CARE", 33, 30, NULL, false,
     GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_DONT_CARE, save_number, set_derivative_hint, restore_derivative_hint},
    SWITCH("Triangles and samples", GL_MULTISAMPLE, 1, 33, 0, NULL),
    SWITCH("Triangles and samples", GL_SAMPLE_ALPHA_TO_COVERAGE, 0, 33, 30, NULL),
    SWITCH("Triangles and samples", GL_SAMPLE_ALPHA_TO_ONE, 0, 33, 0, NULL),
    SWITCH("Triangles and samples", GL_SAMPLE_COVERAGE, 0, 33, 30, NULL),
    SWITCH("Triangles and samples", GL_SAMPLE_MASK, 0, 33, 31, NULL),
    SWITCH("Triangles and samples", GL_SAMPLE_SHADING, 0, 40, 32, NULL),

    STORE(GL_PACK_ALIGNMENT, 1, 33, 30),
    STORE(GL_PACK_ROW_LENGTH, 0, 33, 30),
    STORE(GL_PACK_SKIP_ROWS, 0, 33, 30),
    STORE(GL_PACK_SKIP_PIXELS, 0, 33, 30),
    STORE(GL_PACK_IMAGE_HEIGHT, 0, 33, 0),
    STORE(GL_PACK_SKIP_IMAGES, 0, 33, 0),
    STORE(GL_PACK_SWAP_BYTES, 0, 33, 0),
    STORE(GL_PACK_LSB_FIRST, 0, 33, 0),
    STORE(GL_UNPACK_ALIGNMENT, 1, 33, 30),
    STORE(GL_UNPACK_ROW_LENGTH, 0, 33, 30),
    STORE(GL_UNPACK_SKIP_ROWS, 0, 33, 30),
    STORE(GL_UNPACK_SKIP_PIXELS, 0, 33, 30),
    STORE(GL_UNPACK_IMAGE_HEIGHT, 0, 33, 30),
    STORE(GL_UNPACK_SKIP_IMAGES, 0, 33, 30),
    STORE(GL_UNPACK_SWAP_BYTES, 0, 33, 0),
    STORE(GL_UNPACK_LSB_FIRST, 0, 33, 0),

    OLD_SWITCH(GL_ALPHA_TEST),
    OLD_SWITCH(GL_POLYGON_STIPPLE),
    OLD_SWITCH(GL_POINT_SMOOTH),
    {"Compatibility profiles", "GL_CLAMP_FRAGMENT_COLOR", "GL_FIXED_ONLY", 33, 0, NULL, true, GL_CLAMP_FRAGMENT_COLOR,
     GL_FIXED_ONLY, save_number, set_clamp_colour, restore_clamp_colour},
    TRANSFER(GL_MAP_COLOR, 0),
    TRANSFER(GL_RED_SCALE, 1),
    TRANSFER(GL_GREEN_SCALE, 1),
    TRANSFER(GL_BLUE_SCALE, 1),
    TRANSFER(GL_ALPHA_SCALE, 1),
    TRANSFER(GL_DEPTH_SCALE, 1),
    TRANSFER(GL_RED_BIAS, 0),
    TRANSFER(GL_GREEN_BIAS, 0),
    TRANSFER(GL_BLUE_BIAS, 0),
    TRANSFER(GL_ALPHA_BIAS, 0),
    TRANSFER(GL_DEPTH_BIAS, 0),
};
const size_t host_row_count = sizeof host_rows / sizeof *host_rows;

bool host_row_applies(const gpu *g, const host_row *row)
{
    int since = g->capabilities.es ? row->es : row->desktop;
    if (row->compatibility && !g->compatibility)
        return false;
    return (since && g->version >= since) || (row->extension && epoxy_has_gl_extension(row->extension));
}

void host_state_save(gpu *g, host_value *values)
{
    for (size_t i = 0; i < host_row_count; i++)
        if (g->host_has[i])
            host_rows[i].save(g, host_rows[i].what, &values[i]);
}

void host_state_set(gpu *g)
{
    for (size_t i = 0; i < host_row_count; i++)
        if (g->host_has[i] && host_rows[i].set)
            host_rows[i].set(g, host_rows[i].what, host_rows[i].value);
}

void host_state_restore(gpu *g, const host_value *values)
{
    for (size_t i = host_row_count; i-- > 0;)
        if (g->host_has[i])
            host_rows[i].restore(g, host_rows[i].what, &values[i]);
}

const char *host_state_in_the_way(const gpu *g)
{
    static const struct {
        GLenum      target;
        const char *name;
        int         desktop, es;
    } queries[] = {
        {GL_SAMPLES_PASSED, "GL_SAMPLES_PASSED", 33, 0},
        {GL_ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED", 33, 30},
        {GL_ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE", 43, 30},
        {GL_PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED", 33, 32},
    };
    for (size_t i = 0; i < sizeof queries / sizeof *queries; i++) {
        int   since = g->capabilities.es ? queries[i].es : queries[i].desktop;
        GLint running = 0;
        if (since && g->version >= since)
            glGetQueryiv(queries[i].target, GL_CURRENT_QUERY, &running);
        if (running)
            return queries[i].name;
    }
    return NULL;
}
