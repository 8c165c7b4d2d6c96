/* Marks: records drawn as quads, points, segments or strips. A record is there once a corner, and for quads an index
 * buffer makes triangles of them, or once alone, and is drawn as an instance (Freudenberg 2003, section 5.4.1; row
 * EX-29): on the software driver instances of four corners take a quarter to a half longer. */
#include "gpu/gpu_private.h"

#include <string.h>

#include "base/memory.h"

enum { CORNERS = 4, ENDS = 2, INDICES = 6, MARKS_MAX = UINT32_MAX / INDICES };

static const struct {
    GLenum    type;
    GLboolean normalised;
    size_t    size;
} numbers[] = {[MARK_FLOAT] = {GL_FLOAT, GL_FALSE, 4},
               [MARK_SNORM16] = {GL_SHORT, GL_TRUE, 2},
               [MARK_UNORM16] = {GL_UNSIGNED_SHORT, GL_TRUE, 2}};

size_t gpu_mark_record_size(const gpu_mark_layout *l)
{
    size_t size = 0;
    for (int i = 0; i < l->count; i++)
        size += numbers[l->fields[i].number].size * (size_t)l->fields[i].components;
    return size;
}

/* Attributes of the buffer that is bound, from a record on. */
static void set_fields(const gpu_mark_layout *l, size_t first)
{
    size_t size = gpu_mark_record_size(l), at = first * size;
    for (int i = 0; i < l->count; i++) {
        const gpu_mark_field *f = &l->fields[i];
        glVertexAttribPointer((GLuint)i, f->components, numbers[f->number].type, numbers[f->number].normalised,
                              (GLsizei)size, (const void *)at);
        at += numbers[f->number].size * (size_t)f->components;
    }
}

static void fill_buffer(const gpu_marks *m, const void *data, size_t bytes)
{
    glBindBuffer(GL_ARRAY_BUFFER, m->buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    set_fields(&m->layout, 0);
    for (int i = 0; i < m->layout.count; i++) {
        glEnableVertexAttribArray((GLuint)i);
        glVertexAttribDivisor((GLuint)i, m->layout.once ? 1 : 0);
    }
}

/* Each record as many times as a mark has vertices. */
static bool add_records(const gpu_marks *m, const char *records, size_t times)
{
    size_t size = gpu_mark_record_size(&m->layout);
    char  *corners = times > 1 ? mem_alloc(m->count * times * size) : NULL;
    for (size_t i = 0; corners && i < m->count; i++)
        for (size_t k = 0; k < times; k++)
            memcpy(corners + (times * i + k) * size, records + i * size, size);
    if (times == 1 || corners)
        fill_buffer(m, times > 1 ? corners : records, m->count * times * size);
    mem_free(corners);
    return times == 1 || corners;
}

static bool add_indices(GLuint buffer, size_t count)
{
    uint32_t *indices = mem_alloc(count * INDICES * sizeof *indices);
    for (size_t i = 0; indices && i < count; i++) {
        uint32_t first = (uint32_t)(CORNERS * i);
        memcpy(&indices[INDICES * i], (uint32_t[]){first, first + 1, first + 2, first + 2, first + 1, first + 3},
               INDICES * sizeof *indices);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
    if (indices)
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(count * INDICES * sizeof *indices), indices, GL_STATIC_DRAW);
    mem_free(indices);
    return indices != NULL;
}

static bool is_indexed(const gpu_marks *m)
{
    return m->layout.form == MARK_QUADS && !m->layout.once;
}

gpu_marks *gpu_marks_create_as(gpu *g, const gpu_mark_layout *layout, const void *records, size_t count)
{
    static const size_t vertices[] = {
        [MARK_QUADS] = CORNERS, [MARK_POINTS] = 1, [MARK_SEGMENTS] = ENDS, [MARK_STRIPS] = 1};
    if (g->failed)
        return NULL;
    gpu_marks *m = count <= MARKS_MAX ? mem_calloc(1, sizeof *m) : NULL;
    if (!m) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    m->count = count;
    m->layout = *layout;
    size_t times = layout->once ? 1 : vertices[layout->form];
    m->bytes = count * (times * gpu_mark_record_size(layout) + (is_indexed(m) ? INDICES * sizeof(uint32_t) : 0));
    glGenVertexArrays(1, &m->array);
    glBindVertexArray(m->array);
    glGenBuffers(is_indexed(m) ? 2 : 1, m->buffers);
    bool done = add_records(m, records, times) && (!is_indexed(m) || add_indices(m->buffers[1], count));
    glBindVertexArray(0);
    if (!done)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    else if (glGetError() == GL_OUT_OF_MEMORY)
        gpu_fail(g, LMN_MEMORY, "the driver has no memory for %zu marks", count);
    if (!done)
        gpu_marks_destroy(g, &m);
    return m;
}

static gpu_mark_layout vectors_of(int vectors, gpu_mark_form form)
{
    gpu_mark_layout out = {.count = vectors, .form = form};
    for (int i = 0; i < vectors; i++)
        out.fields[i] = (gpu_mark_field){MARK_FLOAT, 4};
    return out;
}

gpu_marks *gpu_marks_create(gpu *g, int vectors, const float *records, size_t count)
{
    const gpu_mark_layout layout = vectors_of(vectors, MARK_QUADS);
    return gpu_marks_create_as(g, &layout, records, count);
}

gpu_marks *gpu_marks_create_points(gpu *g, int vectors, const float *records, size_t count)
{
    const gpu_mark_layout layout = vectors_of(vectors, MARK_POINTS);
    return gpu_marks_create_as(g, &layout, records, count);
}

gpu_marks *gpu_marks_create_strips(gpu *g, int vectors, const float *records, size_t count, int vertices)
{
    gpu_mark_layout layout = vectors_of(vectors, MARK_STRIPS);
    layout.once = true;
    gpu_marks *m = gpu_marks_create_as(g, &layout, records, count);
    if (m)
        m->strip = vertices;
    return m;
}

void gpu_marks_destroy(gpu *g, gpu_marks **m)
{
    if (!*m)
        return;
    if (!g->gone) {
        glDeleteVertexArrays(1, &(*m)->array);
        glDeleteBuffers(is_indexed(*m) ? 2 : 1, (*m)->buffers);
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

/* Instances have no first one in the oldest OpenGL that is wanted: their attributes begin elsewhere. */
static void draw_instances(gpu *g, const gpu_marks *m, size_t first, size_t count)
{
    static const GLenum  primitives[] = {GL_TRIANGLE_STRIP, GL_POINTS, GL_LINES, GL_TRIANGLE_STRIP};
    static const GLsizei vertices[] = {CORNERS, 1, ENDS, 0};
    GLsizei              each = m->layout.form == MARK_STRIPS ? m->strip : vertices[m->layout.form];
    glBindBuffer(GL_ARRAY_BUFFER, m->buffers[0]);
    set_fields(&m->layout, first);
    glDrawArraysInstanced(primitives[m->layout.form], 0, each, (GLsizei)count);
    pace_drawn(g, (uint32_t)(count * (size_t)each), 0);
}

static void draw_run(gpu *g, const gpu_marks *m, size_t first, size_t count)
{
    const size_t each = m->layout.form == MARK_SEGMENTS ? ENDS : 1;
    if (m->layout.once) {
        draw_instances(g, m, first, count);
    } else if (m->layout.form == MARK_QUADS) {
        gpu_draw_indices(g, (uint32_t)(INDICES * first), (uint32_t)(INDICES * count));
    } else {
        glDrawArrays(each == ENDS ? GL_LINES : GL_POINTS, (GLint)(each * first), (GLsizei)(each * count));
        pace_drawn(g, (uint32_t)(each * count), 0);
    }
}

void gpu_draw_mark_runs(gpu *g, gpu_marks *m, uint32_t (*runs)[2], size_t count)
{
    if (!m || !pace_goes_on(g))
        return;
    const bool sized = m->layout.form == MARK_POINTS && !g->capabilities.es; /* there sizes are always the shader's */
    glBindVertexArray(m->array);
    if (sized)
        glEnable(GL_PROGRAM_POINT_SIZE);
    for (size_t i = 0, next; i < count && pace_goes_on(g); i = next) {
        uint32_t end = runs[i][0] + runs[i][1];
        for (next = i + 1; next < count && runs[next][0] == end; next++)
            end += runs[next][1];
        if (end > runs[i][0])
            draw_run(g, m, runs[i][0], end - runs[i][0]);
    }
    if (sized)
        glDisable(GL_PROGRAM_POINT_SIZE);
    g->draws++;
}

void gpu_draw_marks(gpu *g, gpu_marks *m)
{
    uint32_t all[1][2] = {{0, (uint32_t)gpu_marks_count(m)}};
    gpu_draw_mark_runs(g, m, all, 1);
}
