/* Marks: records drawn as quads. Each record is there once a corner, and an index buffer makes triangles of them
 * (Freudenberg 2003, section 5.4.1; row EX-29): on the software driver instances of four corners take a quarter to
 * a half longer. */
#include "gpu/gpu_private.h"

#include <string.h>

#include "base/memory.h"

enum { CORNERS = 4, INDICES = 6, MARKS_MAX = UINT32_MAX / INDICES };

static void set_vectors(GLuint buffer, int vectors, const void *data, size_t bytes)
{
    size_t size = 4 * sizeof(float) * (size_t)vectors;
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    for (int i = 0; i < vectors; i++) {
        glVertexAttribPointer((GLuint)i, 4, GL_FLOAT, GL_FALSE, (GLsizei)size,
                              (const void *)(4 * sizeof(float) * (size_t)i));
        glEnableVertexAttribArray((GLuint)i);
    }
}

static void add_records(GLuint buffer, size_t size, int vectors, const char *records, size_t count, char *corners)
{
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < CORNERS; k++)
            memcpy(corners + (CORNERS * i + k) * size, records + i * size, size);
    set_vectors(buffer, vectors, corners, count * CORNERS * size);
}

static void add_indices(GLuint buffer, size_t count, uint32_t *indices)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t first = (uint32_t)(CORNERS * i);
        memcpy(&indices[INDICES * i], (uint32_t[]){first, first + 1, first + 2, first + 2, first + 1, first + 3},
               INDICES * sizeof *indices);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(count * INDICES * sizeof *indices), indices, GL_STATIC_DRAW);
}

gpu_marks *gpu_marks_create(gpu *g, int vectors, const float *records, size_t count)
{
    if (g->failed)
        return NULL;
    size_t     size = 4 * sizeof(float) * (size_t)vectors;
    gpu_marks *m = count <= MARKS_MAX ? mem_calloc(1, sizeof *m) : NULL;
    char      *corners = m ? mem_alloc(count * CORNERS * size) : NULL;
    uint32_t  *indices = m ? mem_alloc(count * INDICES * sizeof *indices) : NULL;
    if (corners && indices) {
        m->count = count;
        m->bytes = count * (CORNERS * size + INDICES * sizeof *indices);
        glGenVertexArrays(1, &m->array);
        glBindVertexArray(m->array);
        glGenBuffers(2, m->buffers);
        add_records(m->buffers[0], size, vectors, (const char *)records, count, corners);
        add_indices(m->buffers[1], count, indices);
        glBindVertexArray(0);
        if (glGetError() == GL_OUT_OF_MEMORY)
            gpu_fail(g, LMN_MEMORY, "the driver has no memory for %zu marks", count);
    } else {
        mem_free(m);
        m = NULL;
        gpu_fail(g, LMN_MEMORY, "out of memory");
    }
    mem_free(corners);
    mem_free(indices);
    return m;
}

gpu_marks *gpu_marks_create_points(gpu *g, int vectors, const float *records, size_t count)
{
    if (g->failed)
        return NULL;
    gpu_marks *m = count <= MARKS_MAX ? mem_calloc(1, sizeof *m) : NULL;
    if (!m) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    m->count = count;
    m->bytes = count * 4 * sizeof(float) * (size_t)vectors;
    m->points = true;
    glGenVertexArrays(1, &m->array);
    glBindVertexArray(m->array);
    glGenBuffers(1, m->buffers);
    set_vectors(m->buffers[0], vectors, records, count * 4 * sizeof(float) * (size_t)vectors);
    glBindVertexArray(0);
    if (glGetError() == GL_OUT_OF_MEMORY)
        gpu_fail(g, LMN_MEMORY, "the driver has no memory for %zu marks", count);
    return m;
}

gpu_marks *gpu_marks_create_strips(gpu *g, int vectors, const float *records, size_t count, int vertices)
{
    gpu_marks *m = gpu_marks_create_points(g, vectors, records, count);
    if (!m)
        return NULL;
    m->points = false;
    m->strip = vertices;
    glBindVertexArray(m->array);
    for (int i = 0; i < vectors; i++)
        glVertexAttribDivisor((GLuint)i, 1);
    glBindVertexArray(0);
    return m;
}

void gpu_marks_destroy(gpu *g, gpu_marks **m)
{
    if (!*m)
        return;
    if (!g->gone) {
        glDeleteVertexArrays(1, &(*m)->array);
        glDeleteBuffers((*m)->points || (*m)->strip ? 1 : 2, (*m)->buffers);
    }
    mem_free(*m);
    *m = NULL;
}

size_t gpu_marks_count(const gpu_marks *m)
{
    return m ? m->count : 0;
}

size_t gpu_marks_bytes(const gpu_marks *m)
{
    return m ? m->bytes : 0;
}

void gpu_draw_first_marks(gpu *g, gpu_marks *m, size_t count)
{
    if (!m || !count || !pace_goes_on(g))
        return;
    count = count < m->count ? count : m->count;
    glBindVertexArray(m->array);
    if (m->strip) {
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, m->strip, (GLsizei)count);
        pace_drawn(g, (uint32_t)(count * (size_t)m->strip), 0);
        g->draws++;
        return;
    }
    if (!m->points) {
        gpu_draw_indices(g, (uint32_t)(INDICES * count));
        return;
    }
    if (!g->capabilities.es) /* there sizes are always those of the shader */
        glEnable(GL_PROGRAM_POINT_SIZE);
    glDrawArrays(GL_POINTS, 0, (GLsizei)count);
    if (!g->capabilities.es)
        glDisable(GL_PROGRAM_POINT_SIZE);
    pace_drawn(g, (uint32_t)count, 0);
    g->draws++;
}

void gpu_draw_marks(gpu *g, gpu_marks *m)
{
    gpu_draw_first_marks(g, m, gpu_marks_count(m));
}
