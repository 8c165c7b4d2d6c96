/* Storage buffers from a pool: what single-pass layers are gathered in. */
#include "gpu/gpu_private.h"

#include "base/memory.h"

static gpu_buffer *make(gpu *g, size_t bytes)
{
    gpu_buffer *b = mem_calloc(1, sizeof *b);
    if (!b || !mem_grow((void **)&g->buffers, &g->buffer_capacity, g->buffer_count + 1, sizeof *g->buffers)) {
        mem_free(b);
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    b->bytes = bytes;
    glGenBuffers(1, &b->name);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, b->name);
    glBufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)bytes, NULL, GL_DYNAMIC_COPY);
    if (glGetError() == GL_OUT_OF_MEMORY)
        gpu_fail(g, LMN_MEMORY, "the driver has no memory for a buffer of %zu bytes", bytes);
    g->buffers[g->buffer_count++] = b;
    return b;
}

gpu_buffer *gpu_buffer_acquire(gpu *g, size_t bytes)
{
    if (g->failed)
        return NULL;
    gpu_buffer *best = NULL;
    for (size_t i = 0; i < g->buffer_count; i++) {
        gpu_buffer *b = g->buffers[i];
        if (!b->in_use && b->bytes >= bytes && (!best || b->bytes < best->bytes))
            best = b;
    }
    /* One that is much too large is left to who needs it. */
    if (!best || best->bytes > 2 * bytes)
        best = make(g, bytes);
    if (best)
        best->in_use = true;
    return best;
}

void gpu_buffer_release(gpu *g, gpu_buffer *b)
{
    (void)g;
    if (b)
        b->in_use = false;
}

void gpu_buffers_trim(gpu *g)
{
    size_t kept = 0;
    for (size_t i = 0; i < g->buffer_count; i++) {
        if (g->buffers[i]->in_use) {
            g->buffers[kept++] = g->buffers[i];
            continue;
        }
        if (!g->gone)
            glDeleteBuffers(1, &g->buffers[i]->name);
        mem_free(g->buffers[i]);
    }
    g->buffer_count = kept;
}

void gpu_buffer_fill(gpu *g, gpu_buffer *b, uint32_t word, size_t bytes)
{
    if (g->failed || !b)
        return;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, b->name);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)bytes, GL_RED_INTEGER, GL_UNSIGNED_INT,
                         &word);
}

void gpu_buffer_write(gpu *g, gpu_buffer *b, const void *data, size_t bytes)
{
    if (g->failed || !b)
        return;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, b->name);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)bytes, data);
}

void gpu_buffer_bind(gpu *g, gpu_buffer *b, int binding)
{
    if (!g->failed && b)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint)binding, b->name);
}

void gpu_buffer_read(gpu *g, gpu_buffer *b, size_t bytes, void *out)
{
    if (g->failed || !b)
        return;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, b->name);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)bytes, out);
}

void gpu_buffer_barrier(gpu *g)
{
    if (!g->failed)
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}
