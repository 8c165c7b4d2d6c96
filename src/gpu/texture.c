/* Textures, and pictures to draw into from a pool. */
#include "gpu/gpu_private.h"

#include <string.h>

#include "base/memory.h"

/* Where textures are bound to be made and written: a unit that programs do not come to, so that none loses a
 * texture that was set before. */
#define SCRATCH_UNIT GL_TEXTURE15

typedef struct format_row {
    GLenum internal, format, type;
    size_t size; /* of a texel outside of GL, bytes */
} format_row;

static const format_row formats[GPU_FORMAT_COUNT] = {
    [GPU_R8] = {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1},
    [GPU_RG8] = {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2},
    [GPU_RG16F] = {GL_RG16F, GL_RG, GL_FLOAT, 8},
    [GPU_R32F] = {GL_R32F, GL_RED, GL_FLOAT, 4},
    [GPU_R32UI] = {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4},
    [GPU_RGBA8] = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    [GPU_SRGB8] = {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    [GPU_RGBA16F] = {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8},
    [GPU_RGBA32F] = {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    [GPU_RG32UI] = {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8},
    [GPU_RGBA32UI] = {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16},
    [GPU_DEPTH32F_STENCIL8] = {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 8},
    [GPU_DEPTH32F] = {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4},
};

int gpu_texture_width(const gpu_texture *t)
{
    return t->width;
}

int gpu_texture_height(const gpu_texture *t)
{
    return t->height;
}

unsigned gpu_texture_name(const gpu_texture *t)
{
    return t->name;
}

size_t gpu_texel_size(const gpu_texture *t)
{
    return formats[t->format].size;
}

static GLint wrap_of(gpu_wrap wrap)
{
    return wrap == GPU_REPEAT ? GL_REPEAT : wrap == GPU_MIRROR ? GL_MIRRORED_REPEAT : GL_CLAMP_TO_EDGE;
}

/* A texture without content, bound. */
static gpu_texture *make_empty(gpu *g, GLenum target, int width, int height, gpu_format format)
{
    if (g->failed)
        return NULL;
    if (width > g->capabilities.max_texture || height > g->capabilities.max_texture) {
        gpu_fail(g, LMN_LIMIT, "a picture of %dx%d pixels is larger than the driver's limit of %d a side", width,
                 height, g->capabilities.max_texture);
        return NULL;
    }
    gpu_texture *t = mem_calloc(1, sizeof *t);
    if (!t) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    *t = (gpu_texture){.target = target, .width = width, .height = height, .format = format};
    glGenTextures(1, &t->name);
    glActiveTexture(SCRATCH_UNIT);
    glBindTexture(target, t->name);
    return t;
}

/* To be asked after a texture got its memory. */
static void check_memory(gpu *g, const gpu_texture *t)
{
    if (glGetError() == GL_OUT_OF_MEMORY)
        gpu_fail(g, LMN_MEMORY, "the driver has no memory for a texture of %dx%d pixels", t->width, t->height);
}

static gpu_texture *make(gpu *g, int width, int height, gpu_format format, const void *pixels, gpu_wrap wrap_u,
                         gpu_wrap wrap_v)
{
    gpu_texture *t = make_empty(g, GL_TEXTURE_2D, width, height, format);
    if (!t)
        return NULL;
    const format_row *row = &formats[format];
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)row->internal, width, height, 0, row->format, row->type, pixels);
    check_memory(g, t);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_of(wrap_u));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_of(wrap_v));
    return t;
}

gpu_texture *gpu_texture_create(gpu *g, int width, int height, gpu_format format, const void *pixels, bool nearest,
                                gpu_wrap wrap_u, gpu_wrap wrap_v)
{
    gpu_texture *t = make(g, width, height, format, pixels, wrap_u, wrap_v);
    if (!t)
        return NULL;
    t->mipmapped = true;
    t->nearest = nearest;
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                    nearest ? GL_NEAREST_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
    if (!nearest && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
        glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 8.0f);
    return t;
}

gpu_texture *gpu_texture_of_levels(gpu *g, const gpu_levels *l)
{
    const GLenum target = GL_TEXTURE_2D_ARRAY;
    gpu_texture *t = make_empty(g, target, l->width, l->height, l->format);
    if (!t)
        return NULL;
    t->mipmapped = true;
    t->nearest = l->nearest;
    const format_row *row = &formats[l->format];
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int k = 0; k < l->levels; k++) {
        int width = l->width >> k > 1 ? l->width >> k : 1, height = l->height >> k > 1 ? l->height >> k : 1;
        glTexImage3D(target, k, (GLint)row->internal, width, height, l->layers, 0, row->format, row->type, l->data[k]);
    }
    check_memory(g, t);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, l->levels - 1);
    GLint wrap = l->clamped ? GL_CLAMP_TO_EDGE : GL_REPEAT;
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER,
                    l->nearest   ? GL_NEAREST_MIPMAP_NEAREST
                    : l->stepped ? GL_LINEAR_MIPMAP_NEAREST
                                 : GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, l->nearest ? GL_NEAREST : GL_LINEAR);
    return t;
}

void gpu_texture_destroy(gpu *g, gpu_texture **t)
{
    if (!*t)
        return;
    if (!g->gone)
        glDeleteTextures(1, &(*t)->name);
    mem_free(*t);
    *t = NULL;
}

gpu_texture *gpu_target_acquire(gpu *g, int width, int height, gpu_format format)
{
    for (size_t i = 0; i < g->target_count; i++) {
        gpu_texture *t = g->targets[i];
        if (!t->in_use && t->width == width && t->height == height && t->format == format) {
            t->in_use = true;
            return t;
        }
    }
    if (!mem_grow((void **)&g->targets, &g->target_capacity, g->target_count + 1, sizeof *g->targets)) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    gpu_texture *t = make(g, width, height, format, NULL, GPU_CLAMP, GPU_CLAMP);
    if (!t)
        return NULL;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    t->nearest = true;
    t->in_use = true;
    g->targets[g->target_count++] = t;
    return t;
}

void gpu_target_release(gpu *g, gpu_texture *t)
{
    (void)g;
    if (t)
        t->in_use = false;
}

bool gpu_target_possible(gpu *g, int width, int height, gpu_format format)
{
    GLint got = 0;
    if (g->failed || width > g->capabilities.max_texture || height > g->capabilities.max_texture)
        return false;
    if (g->capabilities.es)
        return true; /* it cannot be asked */
    const format_row *row = &formats[format];
    glActiveTexture(SCRATCH_UNIT);
    glTexImage2D(GL_PROXY_TEXTURE_2D, 0, (GLint)row->internal, width, height, 0, row->format, row->type, NULL);
    glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &got);
    return got == width;
}

void gpu_targets_trim(gpu *g)
{
    size_t kept = 0;
    for (size_t i = 0; i < g->target_count; i++) {
        gpu_texture *t = g->targets[i];
        if (t->in_use) {
            g->targets[kept++] = t;
            continue;
        }
        gpu_forget_framebuffers(g, t);
        if (!g->gone)
            glDeleteTextures(1, &t->name);
        mem_free(t);
    }
    g->target_count = kept;
    gpu_buffers_trim(g);
}

void gpu_set_texture(gpu *g, const char *name, gpu_texture *t, bool linear)
{
    if (g->failed || !t || !gpu_has_uniform(g, name))
        return;
    int unit = g->next_unit++;
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(t->target, t->name);
    if (!t->mipmapped && t->linear != linear) {
        GLint filter = linear ? GL_LINEAR : GL_NEAREST;
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
        t->linear = linear;
    }
    gpu_set_int(g, name, unit);
}

/* ES reads no depth back directly: it goes through a shader into a float picture. */
static void read_depth_by_copy(gpu *g, gpu_texture *t, float *out)
{
    gpu_texture *copy = gpu_target_acquire(g, t->width, t->height, GPU_RGBA32F);
    float       *wide = mem_alloc(sizeof(float) * 4 * (size_t)t->width * (size_t)t->height);
    if (copy && wide) {
        gpu_pass_begin(g, &(gpu_pass){.colours = {copy}, .colour_count = 1});
        gpu_use(g, gpu_program_of(g, GPU_FLOOR, "gpu/screen.vert", "gpu/copy_depth.frag", ""), (gpu_state){0});
        gpu_set_texture(g, "t_depth", t, false);
        gpu_draw_screen(g);
        gpu_read(g, copy, wide);
        for (size_t i = 0, count = (size_t)t->width * (size_t)t->height; i < count; i++)
            out[i] = wide[i * 4];
    }
    if (!wide)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(wide);
    gpu_target_release(g, copy);
}

void gpu_read(gpu *g, gpu_texture *t, void *out)
{
    if (g->failed || !t)
        return;
    if (t->format == GPU_DEPTH32F) {
        if (g->capabilities.es) {
            read_depth_by_copy(g, t, out);
            return;
        }
        gpu_pass_begin(g, &(gpu_pass){.depth = t});
        glReadPixels(0, 0, t->width, t->height, GL_DEPTH_COMPONENT, GL_FLOAT, out);
        return;
    }
    gpu_read_box(g, t, (int[]){0, 0, t->width, t->height}, out);
}

/* ES guarantees reads of four components only, integers or floats. */
static void read_narrow(gpu *g, const gpu_texture *t, const int box[4], void *out)
{
    size_t count = (size_t)box[2] * (size_t)box[3], size = formats[t->format].size;
    char  *wide = mem_alloc(count * 16);
    if (!wide) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return;
    }
    glReadPixels(box[0], box[1], box[2], box[3], formats[t->format].type == GL_FLOAT ? GL_RGBA : GL_RGBA_INTEGER,
                 formats[t->format].type, wide);
    for (size_t i = 0; i < count; i++)
        memcpy((char *)out + i * size, wide + i * 16, size);
    mem_free(wide);
}

void gpu_read_box(gpu *g, gpu_texture *t, const int box[4], void *out)
{
    if (g->failed || !t)
        return;
    gpu_pass_begin(g, &(gpu_pass){.colours = {t}, .colour_count = 1});
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    GLenum type = t->format == GPU_RGBA16F ? GL_FLOAT : formats[t->format].type;
    if (g->capabilities.es &&
        (t->format == GPU_RG32UI || t->format == GPU_R32UI || t->format == GPU_R32F || t->format == GPU_RG16F)) {
        read_narrow(g, t, box, out);
        return;
    }
    glReadPixels(box[0], box[1], box[2], box[3], formats[t->format].format, type, out);
}

void gpu_target_write(gpu *g, gpu_texture *t, const int box[4], const void *pixels)
{
    if (g->failed || !t)
        return;
    glActiveTexture(SCRATCH_UNIT);
    glBindTexture(GL_TEXTURE_2D, t->name);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, box[0], box[1], box[2], box[3], formats[t->format].format,
                    formats[t->format].type, pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}
