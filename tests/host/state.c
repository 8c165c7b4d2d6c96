#include "state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool has(int desktop, int es)
{
    int since = epoxy_is_desktop_gl() ? desktop : es;
    return since && epoxy_gl_version() >= since;
}

static bool is_compatibility(void)
{
    GLint profile = 0;
    if (epoxy_is_desktop_gl())
        glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    return profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT;
}

static void add(state *s, const char *name, int index, double value)
{
    if (s->count < STATE_MAX)
        s->values[s->count++] = (state_value){name, index, value};
}

typedef struct named {
    const char *name;
    GLenum      what;
    int         desktop, es; /* versions that have it */
    int         numbers;
} named;

#define N(name, desktop, es, numbers)                                                                                  \
    {                                                                                                                  \
#name, name, desktop, es, numbers                                                                              \
    }

static const named switches[] = {
    N(GL_BLEND, 33, 30, 1),
    N(GL_CULL_FACE, 33, 30, 1),
    N(GL_DEPTH_TEST, 33, 30, 1),
    N(GL_DITHER, 33, 30, 1),
    N(GL_POLYGON_OFFSET_FILL, 33, 30, 1),
    N(GL_POLYGON_OFFSET_LINE, 33, 0, 1),
    N(GL_POLYGON_OFFSET_POINT, 33, 0, 1),
    N(GL_PRIMITIVE_RESTART_FIXED_INDEX, 43, 30, 1),
    N(GL_RASTERIZER_DISCARD, 33, 30, 1),
    N(GL_SAMPLE_ALPHA_TO_COVERAGE, 33, 30, 1),
    N(GL_SAMPLE_COVERAGE, 33, 30, 1),
    N(GL_SCISSOR_TEST, 33, 30, 1),
    N(GL_STENCIL_TEST, 33, 30, 1),
    N(GL_COLOR_LOGIC_OP, 33, 0, 1),
    N(GL_DEPTH_CLAMP, 33, 0, 1),
    N(GL_FRAMEBUFFER_SRGB, 33, 0, 1),
    N(GL_LINE_SMOOTH, 33, 0, 1),
    N(GL_MULTISAMPLE, 33, 0, 1),
    N(GL_POLYGON_SMOOTH, 33, 0, 1),
    N(GL_PRIMITIVE_RESTART, 33, 0, 1),
    N(GL_PROGRAM_POINT_SIZE, 33, 0, 1),
    N(GL_SAMPLE_ALPHA_TO_ONE, 33, 0, 1),
    N(GL_SAMPLE_MASK, 33, 31, 1),
    N(GL_SAMPLE_SHADING, 40, 32, 1),
    N(GL_TEXTURE_CUBE_MAP_SEAMLESS, 33, 0, 1),
    N(GL_CLIP_DISTANCE0, 33, 0, 1),
    N(GL_CLIP_DISTANCE1, 33, 0, 1),
    N(GL_CLIP_DISTANCE2, 33, 0, 1),
    N(GL_CLIP_DISTANCE3, 33, 0, 1),
    N(GL_CLIP_DISTANCE4, 33, 0, 1),
    N(GL_CLIP_DISTANCE5, 33, 0, 1),
    N(GL_CLIP_DISTANCE6, 33, 0, 1),
    N(GL_CLIP_DISTANCE7, 33, 0, 1),
    N(GL_DEBUG_OUTPUT, 43, 32, 1),
};

static const named numbers[] = {
    N(GL_ACTIVE_TEXTURE, 33, 30, 1),
    N(GL_ARRAY_BUFFER_BINDING, 33, 30, 1),
    N(GL_BLEND_COLOR, 33, 30, 4),
    N(GL_BLEND_DST_ALPHA, 33, 30, 1),
    N(GL_BLEND_DST_RGB, 33, 30, 1),
    N(GL_BLEND_EQUATION_ALPHA, 33, 30, 1),
    N(GL_BLEND_EQUATION_RGB, 33, 30, 1),
    N(GL_BLEND_SRC_ALPHA, 33, 30, 1),
    N(GL_BLEND_SRC_RGB, 33, 30, 1),
    N(GL_COLOR_CLEAR_VALUE, 33, 30, 4),
    N(GL_COLOR_WRITEMASK, 33, 30, 4),
    N(GL_COPY_READ_BUFFER, 33, 30, 1),
    N(GL_COPY_WRITE_BUFFER, 33, 30, 1),
    N(GL_CULL_FACE_MODE, 33, 30, 1),
    N(GL_CURRENT_PROGRAM, 33, 30, 1),
    N(GL_DEPTH_CLEAR_VALUE, 33, 30, 1),
    N(GL_DEPTH_FUNC, 33, 30, 1),
    N(GL_DEPTH_RANGE, 33, 30, 2),
    N(GL_DEPTH_WRITEMASK, 33, 30, 1),
    N(GL_DRAW_BUFFER0, 33, 30, 1),
    N(GL_DRAW_FRAMEBUFFER_BINDING, 33, 30, 1),
    N(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, 33, 30, 1),
    N(GL_FRONT_FACE, 33, 30, 1),
    N(GL_LINE_WIDTH, 33, 30, 1),
    N(GL_PACK_ALIGNMENT, 33, 30, 1),
    N(GL_PACK_ROW_LENGTH, 33, 30, 1),
    N(GL_PACK_SKIP_PIXELS, 33, 30, 1),
    N(GL_PACK_SKIP_ROWS, 33, 30, 1),
    N(GL_PIXEL_PACK_BUFFER_BINDING, 33, 30, 1),
    N(GL_PIXEL_UNPACK_BUFFER_BINDING, 33, 30, 1),
    N(GL_POLYGON_OFFSET_FACTOR, 33, 30, 1),
    N(GL_POLYGON_OFFSET_UNITS, 33, 30, 1),
    N(GL_READ_BUFFER, 33, 30, 1),
    N(GL_READ_FRAMEBUFFER_BINDING, 33, 30, 1),
    N(GL_RENDERBUFFER_BINDING, 33, 30, 1),
    N(GL_SAMPLE_COVERAGE_INVERT, 33, 30, 1),
    N(GL_SAMPLE_COVERAGE_VALUE, 33, 30, 1),
    N(GL_SCISSOR_BOX, 33, 30, 4),
    N(GL_STENCIL_BACK_FAIL, 33, 30, 1),
    N(GL_STENCIL_BACK_FUNC, 33, 30, 1),
    N(GL_STENCIL_BACK_PASS_DEPTH_FAIL, 33, 30, 1),
    N(GL_STENCIL_BACK_PASS_DEPTH_PASS, 33, 30, 1),
    N(GL_STENCIL_BACK_REF, 33, 30, 1),
    N(GL_STENCIL_BACK_VALUE_MASK, 33, 30, 1),
    N(GL_STENCIL_BACK_WRITEMASK, 33, 30, 1),
    N(GL_STENCIL_CLEAR_VALUE, 33, 30, 1),
    N(GL_STENCIL_FAIL, 33, 30, 1),
    N(GL_STENCIL_FUNC, 33, 30, 1),
    N(GL_STENCIL_PASS_DEPTH_FAIL, 33, 30, 1),
    N(GL_STENCIL_PASS_DEPTH_PASS, 33, 30, 1),
    N(GL_STENCIL_REF, 33, 30, 1),
    N(GL_STENCIL_VALUE_MASK, 33, 30, 1),
    N(GL_STENCIL_WRITEMASK, 33, 30, 1),
    N(GL_UNIFORM_BUFFER_BINDING, 33, 30, 1),
    N(GL_UNPACK_ALIGNMENT, 33, 30, 1),
    N(GL_UNPACK_IMAGE_HEIGHT, 33, 30, 1),
    N(GL_UNPACK_ROW_LENGTH, 33, 30, 1),
    N(GL_UNPACK_SKIP_IMAGES, 33, 30, 1),
    N(GL_UNPACK_SKIP_PIXELS, 33, 30, 1),
    N(GL_UNPACK_SKIP_ROWS, 33, 30, 1),
    N(GL_VERTEX_ARRAY_BINDING, 33, 30, 1),
    N(GL_VIEWPORT, 33, 30, 4),
    N(GL_CLAMP_READ_COLOR, 33, 0, 1),
    N(GL_LOGIC_OP_MODE, 33, 0, 1),
    N(GL_PACK_IMAGE_HEIGHT, 33, 0, 1),
    N(GL_PACK_LSB_FIRST, 33, 0, 1),
    N(GL_PACK_SKIP_IMAGES, 33, 0, 1),
    N(GL_PACK_SWAP_BYTES, 33, 0, 1),
    N(GL_POINT_FADE_THRESHOLD_SIZE, 33, 0, 1),
    N(GL_POINT_SIZE, 33, 0, 1),
    N(GL_POINT_SPRITE_COORD_ORIGIN, 33, 0, 1),
    N(GL_POLYGON_MODE, 33, 0, 1),
    N(GL_PRIMITIVE_RESTART_INDEX, 33, 0, 1),
    N(GL_PROVOKING_VERTEX, 33, 0, 1),
    N(GL_UNPACK_LSB_FIRST, 33, 0, 1),
    N(GL_UNPACK_SWAP_BYTES, 33, 0, 1),
    N(GL_CLIP_ORIGIN, 45, 0, 1),
    N(GL_CLIP_DEPTH_MODE, 45, 0, 1),
    N(GL_PROGRAM_PIPELINE_BINDING, 41, 31, 1),
    N(GL_SHADER_STORAGE_BUFFER_BINDING, 43, 31, 1),
    N(GL_ATOMIC_COUNTER_BUFFER_BINDING, 42, 31, 1),
    N(GL_DRAW_INDIRECT_BUFFER_BINDING, 40, 31, 1),
    N(GL_DISPATCH_INDIRECT_BUFFER_BINDING, 43, 31, 1),
    N(GL_TRANSFORM_FEEDBACK_BINDING, 40, 30, 1),
    N(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 33, 30, 1),
    N(GL_MIN_SAMPLE_SHADING_VALUE, 40, 32, 1),
    N(GL_PATCH_VERTICES, 40, 32, 1),
};

static const named old[] = {
    N(GL_ALPHA_TEST, 33, 0, 1),   N(GL_POLYGON_STIPPLE, 33, 0, 1), N(GL_POINT_SMOOTH, 33, 0, 1),
    N(GL_MAP_COLOR, 33, 0, 1),    N(GL_GREEN_SCALE, 33, 0, 1),     N(GL_BLUE_SCALE, 33, 0, 1),
    N(GL_ALPHA_SCALE, 33, 0, 1),  N(GL_RED_BIAS, 33, 0, 1),        N(GL_BLUE_BIAS, 33, 0, 1),
    N(GL_ALPHA_BIAS, 33, 0, 1),   N(GL_DEPTH_BIAS, 33, 0, 1),      N(GL_RED_SCALE, 33, 0, 1),
    N(GL_GREEN_BIAS, 33, 0, 1),   N(GL_DEPTH_SCALE, 33, 0, 1),     N(GL_CLAMP_FRAGMENT_COLOR, 33, 0, 1),
    N(GL_POLYGON_MODE, 33, 0, 2),
};

static void take_numbers(state *s, const named *rows, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        GLdouble v[4] = {0};
        GLfloat  f[4] = {0};
        if (!has(rows[i].desktop, rows[i].es))
            continue;
        if (epoxy_is_desktop_gl())
            glGetDoublev(rows[i].what, v);
        else
            glGetFloatv(rows[i].what, f);
        for (int k = 0; k < rows[i].numbers; k++)
            add(s, rows[i].name, k, epoxy_is_desktop_gl() ? v[k] : (double)f[k]);
    }
}

static void take_units(state *s)
{
    static const GLenum bindings[] = {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_3D,
                                      GL_TEXTURE_BINDING_CUBE_MAP, GL_SAMPLER_BINDING};
    GLint               active, v;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLenum unit = 0; unit < 20; unit++) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (size_t k = 0; k < sizeof bindings / sizeof *bindings; k++) {
            glGetIntegerv(bindings[k], &v);
            add(s, k == 4 ? "sampler of unit" : "texture of unit", (int)unit, v);
        }
    }
    glActiveTexture((GLenum)active);
}

static void take_indexed(state *s)
{
    static const GLenum blends[] = {GL_BLEND_SRC_RGB,   GL_BLEND_DST_RGB,      GL_BLEND_SRC_ALPHA,
                                    GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA};
    GLint               v[4];
    GLboolean           mask[4];
    for (GLuint i = 0; i < 8 && has(40, 32); i++) {
        add(s, "GL_BLEND of buffer", (int)i, glIsEnabledi(GL_BLEND, i));
        for (size_t k = 0; k < sizeof blends / sizeof *blends; k++) {
            glGetIntegeri_v(blends[k], i, v);
            add(s, "blend function of buffer", (int)i, v[0]);
        }
        glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask);
        add(s, "colour mask of buffer", (int)i, mask[0] + 2 * mask[1] + 4 * mask[2] + 8 * mask[3]);
    }
    for (GLuint i = 0; i < 16 && has(41, 0); i++) {
        GLfloat  f[4];
        GLdouble d[2];
        glGetFloati_v(GL_VIEWPORT, i, f);
        glGetIntegeri_v(GL_SCISSOR_BOX, i, v);
        glGetDoublei_v(GL_DEPTH_RANGE, i, d);
        for (int k = 0; k < 4; k++) {
            add(s, "viewport", (int)i, (double)f[k]);
            add(s, "scissor", (int)i, v[k]);
        }
        add(s, "depth range", (int)i, d[0]);
        add(s, "depth range", (int)i, d[1]);
        add(s, "scissor test", (int)i, glIsEnabledi(GL_SCISSOR_TEST, i));
    }
    for (GLuint i = 0; i < 8 && has(43, 31); i++) {
        GLint64 l[3];
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &l[0]);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, i, &l[1]);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, i, &l[2]);
        for (int k = 0; k < 3; k++)
            add(s, "storage buffer", (int)i, (double)l[k]);
    }
    for (GLuint i = 0; i < 4; i++) {
        glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, i, v);
        add(s, "uniform buffer", (int)i, v[0]);
    }
    for (GLuint i = is_compatibility(); i < 16; i++) {
        GLfloat f[4];
        glGetVertexAttribfv(i, GL_CURRENT_VERTEX_ATTRIB, f);
        for (int k = 0; k < 4; k++)
            add(s, "current attribute", (int)i, (double)f[k]);
    }
}

void state_take(state *out)
{
    out->count = 0;
    for (size_t i = 0; i < sizeof switches / sizeof *switches; i++)
        if (has(switches[i].desktop, switches[i].es))
            add(out, switches[i].name, 0, glIsEnabled(switches[i].what));
    take_numbers(out, numbers, sizeof numbers / sizeof *numbers);
    if (is_compatibility())
        take_numbers(out, old, sizeof old / sizeof *old);
    take_units(out);
    take_indexed(out);
}

bool state_same(const state *before, const state *after)
{
    bool same = before->count == after->count && before->count < STATE_MAX;
    for (int i = 0; i < before->count && i < after->count; i++) {
        const state_value *a = &before->values[i], *b = &after->values[i];
        if (a->value == b->value)
            continue;
        printf("%s %d: was %g, is %g\n", a->name, a->index, a->value, b->value);
        same = false;
    }
    return same;
}

static GLuint shader(GLenum stage, const char *body)
{
    GLuint      name = glCreateShader(stage);
    const char *parts[] = {epoxy_is_desktop_gl() ? "#version 330 core\n" : "#version 300 es\nprecision highp float;\n",
                           body};
    glShaderSource(name, 2, parts, NULL);
    glCompileShader(name);
    return name;
}

/* Colours come from the current value of an attribute, a texture and the depth: what is upset there is seen. */
static GLuint make_program(void)
{
    GLuint vertex = shader(GL_VERTEX_SHADER, "layout(location = 0) in vec2 position;\n"
                                             "layout(location = 3) in vec4 tint;\n"
                                             "uniform float u_shift;\n"
                                             "flat out vec4 colour;\n"
                                             "void main() {\n"
                                             "  colour = tint + 0.1 * float(gl_VertexID);\n"
                                             "  gl_Position = vec4(position + u_shift, 0.3 + u_shift, 1.0);\n"
                                             "  gl_PointSize = 9.0; }\n");
    GLuint fragment = shader(GL_FRAGMENT_SHADER, "flat in vec4 colour;\n"
                                                 "uniform sampler2D t;\n"
                                                 "layout(location = 0) out vec4 out_0;\n"
                                                 "void main() {\n"
                                                 "  vec4 texel = texture(t, gl_FragCoord.xy / 32.0);\n"
                                                 "  out_0 = 0.5 * colour + 0.5 * texel + 0.2 * gl_FragCoord.z; }\n");
    GLuint program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    return program;
}

void state_objects_create(state_objects *o)
{
    static const float corners[] = {-0.9f, -0.9f, 0.7f,  -0.6f, -0.2f, 0.9f, 0.9f,  0.9f, -0.7f,
                                    0.8f,  0.1f,  -0.9f, 0.f,   0.f,   0.9f, -0.1f, 0.3f, 0.8f};
    unsigned char      texels[4 * 4 * 4];
    for (size_t i = 0; i < sizeof texels; i++)
        texels[i] = (unsigned char)(37 * i + 11);
    glGenTextures(3, o->textures);
    glBindTexture(GL_TEXTURE_2D, o->textures[0]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, o->textures[1]);
    glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
    glBindTexture(GL_TEXTURE_CUBE_MAP, o->textures[2]);
    glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    glGenSamplers(2, o->samplers);
    glSamplerParameteri(o->samplers[0], GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(o->samplers[0], GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(o->samplers[0], GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
    glSamplerParameteri(o->samplers[1], GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glGenBuffers(4, o->buffers);
    glGenVertexArrays(1, &o->array);
    glBindVertexArray(o->array);
    glBindBuffer(GL_ARRAY_BUFFER, o->buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(0);
    glBindVertexArray(0);
    for (int i = 1; i < 4; i++) {
        glBindBuffer(GL_ARRAY_BUFFER, o->buffers[i]);
        glBufferData(GL_ARRAY_BUFFER, 1 << 16, NULL, GL_STATIC_DRAW);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    o->program = make_program();
    glGenRenderbuffers(1, &o->renderbuffer);
    glGenFramebuffers(1, &o->framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, o->framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

void state_objects_destroy(state_objects *o)
{
    glDeleteTextures(3, o->textures);
    glDeleteSamplers(2, o->samplers);
    glDeleteBuffers(4, o->buffers);
    glDeleteVertexArrays(1, &o->array);
    glDeleteProgram(o->program);
    glDeleteRenderbuffers(1, &o->renderbuffer);
    glDeleteFramebuffers(1, &o->framebuffer);
}

static void upset_units(const state_objects *o)
{
    for (GLuint unit = 0; unit < 16; unit++) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, o->textures[0]);
        glBindTexture(GL_TEXTURE_2D_ARRAY, o->textures[1]);
        glBindTexture(GL_TEXTURE_CUBE_MAP, o->textures[2]);
        glBindSampler(unit, o->samplers[unit > 0 && unit % 2]);
    }
    glActiveTexture(GL_TEXTURE6);
}

static void upset_arrays(void)
{
    for (GLuint i = 1; i < 16; i++)
        glVertexAttrib4f(i, 0.1f * (float)i, 0.3f, 0.9f - 0.05f * (float)i, 0.6f);
    for (GLuint i = 1; i < 8 && has(40, 32); i++) {
        glBlendFuncSeparatei(i, GL_ONE, GL_DST_COLOR, GL_ZERO, GL_SRC_ALPHA);
        glBlendEquationSeparatei(i, GL_MAX, GL_FUNC_REVERSE_SUBTRACT);
        glColorMaski(i, i % 2, GL_TRUE, GL_FALSE, i % 3 == 0);
        (i % 2 ? glEnablei : glDisablei)(GL_BLEND, i);
    }
    for (GLuint i = 1; i < 16 && has(41, 0); i++) {
        glViewportIndexedf(i, (float)i, 2, 30 + (float)i, 40);
        glScissorIndexed(i, 1, (GLint)i, 20, 10 + (GLsizei)i);
        glDepthRangeIndexed(i, 0.1, 0.5 + 0.01 * i);
        (i % 2 ? glEnablei : glDisablei)(GL_SCISSOR_TEST, i);
    }
}

static void upset_stencil(GLenum function)
{
    glStencilFuncSeparate(GL_FRONT, function, 3, 0x7F);
    glStencilFuncSeparate(GL_BACK, function, 5, 0x3F);
    glStencilOpSeparate(GL_FRONT, GL_INCR, GL_DECR, GL_INVERT);
    glStencilOpSeparate(GL_BACK, GL_ZERO, GL_INCR_WRAP, GL_KEEP);
    glStencilMaskSeparate(GL_FRONT, 0x0F);
    glStencilMaskSeparate(GL_BACK, 0xF0);
    glEnable(GL_STENCIL_TEST);
}

static const GLenum scales[] = {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE, GL_DEPTH_SCALE},
                    biases[] = {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS, GL_DEPTH_BIAS};

static void upset_transfer(void)
{
    glPixelStorei(GL_PACK_ALIGNMENT, 8);
    glPixelStorei(GL_PACK_ROW_LENGTH, 777);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 3);
    glPixelStorei(GL_PACK_SKIP_ROWS, 2);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 5);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 9);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 1);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 1);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 1);
    if (!has(33, 0))
        return;
    glPixelStorei(GL_PACK_SWAP_BYTES, 1);
    glPixelStorei(GL_PACK_LSB_FIRST, 1);
    glPixelStorei(GL_PACK_IMAGE_HEIGHT, 4);
    glPixelStorei(GL_PACK_SKIP_IMAGES, 1);
    glPixelStorei(GL_UNPACK_SWAP_BYTES, 1);
    glPixelStorei(GL_UNPACK_LSB_FIRST, 1);
    glClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
    if (!is_compatibility())
        return;
    glPixelTransferf(GL_MAP_COLOR, 1);
    for (GLenum k = 0; k < 5; k++) {
        glPixelTransferf(scales[k], 0.5f);
        glPixelTransferf(biases[k], 0.25f);
    }
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE);
}

static void upset_more_if_deadly(const state_objects *o)
{
    glBindFramebuffer(GL_FRAMEBUFFER, o->framebuffer);
    glUseProgram(0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, o->buffers[2]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, o->buffers[3]);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    upset_stencil(GL_NEVER);
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glCullFace(GL_FRONT_AND_BACK);
    glEnable(GL_RASTERIZER_DISCARD);
    glEnable(GL_SAMPLE_COVERAGE);
    glSampleCoverage(0, GL_FALSE);
    glScissor(3, 4, 5, 6);
    if (has(43, 30))
        glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
    if (!has(33, 0))
        return;
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(1);
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_INVERT);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    glEnable(GL_SAMPLE_MASK);
    glSampleMaski(0, 0);
    glEnable(GL_DEPTH_CLAMP);
    for (GLenum i = 0; i < 8; i++)
        glEnable(GL_CLIP_DISTANCE0 + i);
    if (!is_compatibility())
        return;
    glPolygonMode(GL_FRONT, GL_LINE);
    glEnable(GL_ALPHA_TEST);
    glAlphaFunc(GL_NEVER, 1);
    glEnable(GL_POLYGON_STIPPLE);
    glEnable(GL_POINT_SMOOTH);
}

void state_upset(const state_objects *o, state_preset preset)
{
    glViewport(2, 1, 70, 90);
    glScissor(4, 3, 60, 80);
    glEnable(GL_SCISSOR_TEST);
    glDepthRangef(0.9f, 0.2f);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_DST_COLOR, GL_ONE_MINUS_CONSTANT_ALPHA, GL_ONE, GL_DST_ALPHA);
    glBlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MAX);
    glBlendColor(0.2f, 0.4f, 0.6f, 0.8f);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
    glClearColor(0.8f, 0.7f, 0.2f, 0.5f);
    glClearDepthf(0.1f);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glFrontFace(GL_CW);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-3, 100);
    glDisable(GL_DITHER);
    glHint(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_FASTEST);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    upset_stencil(GL_ALWAYS);
    upset_transfer();
    upset_arrays();
    upset_units(o);
    glBindVertexArray(o->array);
    glBindBuffer(GL_ARRAY_BUFFER, o->buffers[1]);
    glBindRenderbuffer(GL_RENDERBUFFER, o->renderbuffer);
    for (GLuint i = 0; i < 8 && has(43, 31); i++)
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, o->buffers[1 + i % 3], 256 * i, 512);
    if (has(33, 0)) {
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
        glEnable(GL_PROGRAM_POINT_SIZE);
        glEnable(GL_FRAMEBUFFER_SRGB);
        glDisable(GL_MULTISAMPLE);
        glEnable(GL_SAMPLE_ALPHA_TO_ONE);
        glEnable(GL_POLYGON_SMOOTH);
    }
    if (has(40, 32))
        glEnable(GL_SAMPLE_SHADING);
    if (has(45, 0))
        glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    if (preset == STATE_DEADLY)
        upset_more_if_deadly(o);
}

static void calm_switches(void)
{
    for (size_t i = 0; i < sizeof switches / sizeof *switches; i++)
        if (has(switches[i].desktop, switches[i].es) && switches[i].what != GL_DEBUG_OUTPUT)
            (switches[i].what == GL_DITHER || switches[i].what == GL_MULTISAMPLE ? glEnable
                                                                                 : glDisable)(switches[i].what);
}

void state_calm(void)
{
    calm_switches();
    if (has(45, 0))
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDepthRangef(0, 1);
    glClearDepthf(1);
    glStencilMask(~0U);
    glFrontFace(GL_CCW);
    glCullFace(GL_BACK);
    for (int k = 0; k < 2; k++) {
        glPixelStorei(k ? GL_PACK_ALIGNMENT : GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(k ? GL_PACK_ROW_LENGTH : GL_UNPACK_ROW_LENGTH, 0);
        glPixelStorei(k ? GL_PACK_SKIP_PIXELS : GL_UNPACK_SKIP_PIXELS, 0);
        glPixelStorei(k ? GL_PACK_SKIP_ROWS : GL_UNPACK_SKIP_ROWS, 0);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (GLuint unit = 0; unit < 16; unit++)
        glBindSampler(unit, 0);
    if (has(33, 0)) {
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glPixelStorei(GL_PACK_SWAP_BYTES, 0);
        glClampColor(GL_CLAMP_READ_COLOR, GL_FIXED_ONLY);
        glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    }
    if (!is_compatibility())
        return;
    glDisable(GL_ALPHA_TEST);
    glDisable(GL_POLYGON_STIPPLE);
    glPixelTransferf(GL_MAP_COLOR, 0);
    for (GLenum k = 0; k < 5; k++) {
        glPixelTransferf(scales[k], 1);
        glPixelTransferf(biases[k], 0);
    }
}
