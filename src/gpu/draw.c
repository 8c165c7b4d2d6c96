/* Passes, state, and draw calls. */
#include "gpu/gpu_private.h"

#include <string.h>

#include "base/memory.h"

void gpu_forget_framebuffers(gpu *g, const gpu_texture *t)
{
    for (int i = 0; i < g->framebuffer_count;) {
        framebuffer *f = &g->framebuffers[i];
        bool         uses = f->depth == t;
        for (int c = 0; c < GPU_COLOURS_MAX; c++)
            uses = uses || f->colours[c] == t;
        if (!uses) {
            i++;
            continue;
        }
        if (!g->gone)
            glDeleteFramebuffers(1, &f->name);
        g->framebuffers[i] = g->framebuffers[--g->framebuffer_count];
    }
}

static framebuffer *framebuffer_slot(gpu *g)
{
    if (g->framebuffer_count < FRAMEBUFFERS_MAX)
        return &g->framebuffers[g->framebuffer_count++];
    framebuffer *oldest = &g->framebuffers[0];
    for (int i = 1; i < g->framebuffer_count; i++)
        if (g->framebuffers[i].used < oldest->used)
            oldest = &g->framebuffers[i];
    glDeleteFramebuffers(1, &oldest->name);
    return oldest;
}

static void bind_framebuffer(gpu *g, const gpu_pass *pass)
{
    g->clock++;
    for (int i = 0; i < g->framebuffer_count; i++) {
        framebuffer *f = &g->framebuffers[i];
        if (f->depth == pass->depth && memcmp(f->colours, pass->colours, sizeof f->colours) == 0) {
            f->used = g->clock;
            glBindFramebuffer(GL_FRAMEBUFFER, f->name);
            return;
        }
    }
    framebuffer *f = framebuffer_slot(g);
    *f = (framebuffer){.depth = pass->depth, .used = g->clock};
    memcpy(f->colours, pass->colours, sizeof f->colours);
    glGenFramebuffers(1, &f->name);
    glBindFramebuffer(GL_FRAMEBUFFER, f->name);
    GLenum buffers[GPU_COLOURS_MAX];
    for (int i = 0; i < pass->colour_count; i++) {
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        glFramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, pass->colours[i]->name, 0);
    }
    if (pass->colour_count == 0)
        buffers[0] = GL_NONE;
    glDrawBuffers(pass->colour_count ? pass->colour_count : 1, buffers);
    if (pass->depth)
        glFramebufferTexture2D(GL_FRAMEBUFFER,
                               pass->depth->format == GPU_DEPTH32F_STENCIL8 ? GL_DEPTH_STENCIL_ATTACHMENT
                                                                            : GL_DEPTH_ATTACHMENT,
                               GL_TEXTURE_2D, pass->depth->name, 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        gpu_fail(g, LMN_GL, "the driver cannot draw into this set of pictures");
}

static void set_scissor(const int box[4])
{
    if (box[2] > 0) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(box[0], box[1], box[2], box[3]);
    } else {
        glDisable(GL_SCISSOR_TEST);
    }
}

static bool is_integer(gpu_format format)
{
    return format == GPU_R32UI || format == GPU_RG32UI || format == GPU_RGBA32UI;
}

/* Nothing outside of its box is looked at, and all of a picture is cleared faster than a large part of it: drivers that
 * do not draw fill memory, others only note it. */
static bool clears_all(const gpu *g, const gpu_pass *pass, const gpu_texture *any)
{
    const int *box = pass->clear_box, faster = g->capabilities.software ? 8 : 2;
    return (int64_t)box[2] * box[3] * faster >= (int64_t)any->width * any->height;
}

static void clear_targets(const gpu *g, const gpu_pass *pass, const gpu_texture *any)
{
    set_scissor(clears_all(g, pass, any) ? (const int[4]){0} : pass->clear_box);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    for (int i = 0; i < pass->colour_count; i++) {
        const float *v = pass->clear_values[i];
        if (is_integer(pass->colours[i]->format))
            glClearBufferuiv(GL_COLOR, i, (GLuint[]){(GLuint)v[0], (GLuint)v[1], (GLuint)v[2], (GLuint)v[3]});
        else
            glClearBufferfv(GL_COLOR, i, v);
    }
    if (pass->depth && !pass->keep_depth) {
        glDepthMask(GL_TRUE);
        glStencilMask(0xFF);
        if (pass->depth->format == GPU_DEPTH32F_STENCIL8)
            glClearBufferfi(GL_DEPTH_STENCIL, 0, 1.0f, 0);
        else
            glClearBufferfv(GL_DEPTH, 0, (GLfloat[]){1.0f});
    }
}

void gpu_pass_begin(gpu *g, const gpu_pass *pass)
{
    if (g->failed)
        return;
    bind_framebuffer(g, pass);
    glDisable(GL_CULL_FACE);
    const gpu_texture *any = pass->colour_count ? pass->colours[0] : pass->depth;
    glViewport(0, 0, any->width, any->height);
    if (pass->clear)
        clear_targets(g, pass, any);
    set_scissor(pass->scissor);
    memcpy(g->box, pass->scissor[2] > 0 ? pass->scissor : (const int[]){0, 0, any->width, any->height}, sizeof g->box);
}

static const GLenum compares[] = {GL_LEQUAL, GL_LESS, GL_EQUAL, GL_NOTEQUAL, GL_GREATER, GL_GEQUAL, GL_ALWAYS};

static void set_stencil(const gpu_stencil *s)
{
    static const GLenum actions[] = {GL_KEEP, GL_ZERO, GL_REPLACE, GL_INCR_WRAP};
    if (!s->on) {
        glDisable(GL_STENCIL_TEST);
        return;
    }
    glEnable(GL_STENCIL_TEST);
    glStencilMask(0xFF);
    glStencilFunc(compares[s->compare], s->reference, 0xFF);
    glStencilOp(actions[s->fails], actions[s->behind], actions[s->passes]);
}

void gpu_use(gpu *g, gpu_program *p, gpu_state state)
{
    g->program = p;
    g->next_unit = 0;
    if (g->failed || !p)
        return;
    glUseProgram(p->name);
    if (state.depth_test || state.depth_write)
        glEnable(GL_DEPTH_TEST);
    else
        glDisable(GL_DEPTH_TEST);
    glDepthFunc(state.depth_test ? compares[state.depth_compare] : GL_ALWAYS);
    set_stencil(&state.stencil);
    if (g->capabilities.depth_clamp && state.depth_clamp)
        glEnable(GL_DEPTH_CLAMP);
    else if (g->capabilities.depth_clamp)
        glDisable(GL_DEPTH_CLAMP);
    glDepthMask(state.depth_write ? GL_TRUE : GL_FALSE);
    if (state.blend == GPU_BLEND_NONE) {
        glDisable(GL_BLEND);
        return;
    }
    glEnable(GL_BLEND);
    glBlendEquation(state.blend == GPU_BLEND_MIN ? GL_MIN : GL_FUNC_ADD);
    if (state.blend == GPU_BLEND_UNDER)
        glBlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    else
        glBlendFunc(GL_ONE, state.blend == GPU_BLEND_MIN ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
}

void gpu_cull_faces(gpu *g, gpu_cull cull)
{
    if (g->failed)
        return;
    if (cull == GPU_CULL_NONE) {
        glDisable(GL_CULL_FACE);
        return;
    }
    glEnable(GL_CULL_FACE);
    glCullFace(cull == GPU_CULL_BACK ? GL_BACK : GL_FRONT);
}

/* Row after row of the pass's box. */
void gpu_draw_screen(gpu *g)
{
    int  rows = pace_rows(g, g->box[2], g->box[3]);
    bool pieces = g->box[3] > rows;
    glBindVertexArray(g->empty_array);
    for (int y = 0; y < g->box[3] && pace_goes_on(g); y += rows) {
        rows = pieces ? pace_rows(g, g->box[2], g->box[3]) : rows;
        int height = g->box[3] - y < rows ? g->box[3] - y : rows;
        if (pieces)
            set_scissor((const int[]){g->box[0], g->box[1] + y, g->box[2], height});
        glDrawArrays(GL_TRIANGLES, 0, 3);
        pace_drawn(g, 3, (int64_t)g->box[2] * height);
    }
    if (pieces)
        set_scissor(g->box);
    g->draws += !g->failed && g->program;
}

/* Boxes are small: tiles. */
static void draw_some_boxes(gpu *g, int (*boxes)[4], size_t count)
{
    float  *corners = mem_alloc(count * 12 * sizeof *corners);
    int64_t pixels = 0;
    if (!corners) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return;
    }
    for (size_t i = 0; i < count; i++) {
        float x = (float)boxes[i][0], y = (float)boxes[i][1], right = x + (float)boxes[i][2],
              top = y + (float)boxes[i][3];
        memcpy(&corners[12 * i], (float[]){x, y, right, y, right, top, x, y, right, top, x, top}, 12 * sizeof *corners);
        pixels += (int64_t)boxes[i][2] * boxes[i][3];
    }
    glBindVertexArray(g->boxes_array);
    glBindBuffer(GL_ARRAY_BUFFER, g->boxes_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * 12 * sizeof *corners), corners, GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, (GLsizei)(count * 6));
    mem_free(corners);
    pace_drawn(g, (uint32_t)count * 6, pixels);
}

void gpu_draw_boxes(gpu *g, int (*boxes)[4], size_t count)
{
    for (size_t i = 0, next; i < count && pace_goes_on(g); i = next) {
        int64_t pixels = 0;
        for (next = i; next < count && (next == i || pixels < g->piece_pixels); next++)
            pixels += (int64_t)boxes[next][2] * boxes[next][3];
        if (!g->capabilities.software)
            next = count;
        draw_some_boxes(g, &boxes[i], next - i);
    }
    g->draws += count && !g->failed && g->program;
}

static void add_attribute(gpu_mesh *m, GLuint index, int components, uint32_t count, const float *data)
{
    if (!data)
        return;
    size_t bytes = sizeof(float) * (size_t)components * count;
    glGenBuffers(1, &m->buffers[index]);
    glBindBuffer(GL_ARRAY_BUFFER, m->buffers[index]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(index);
}

/* Both halves from one buffer. */
static void add_tensors(gpu_mesh *m, const gpu_mesh_data *data)
{
    const GLsizei stride = 6 * sizeof(float);
    if (!data->tensors)
        return;
    m->has_tensors = true;
    glGenBuffers(1, &m->buffers[6]);
    glBindBuffer(GL_ARRAY_BUFFER, m->buffers[6]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)stride * (GLsizeiptr)data->vertex_count, data->tensors, GL_STATIC_DRAW);
    for (GLuint half = 0; half < 2; half++) {
        glVertexAttribPointer(6 + half, 3, GL_FLOAT, GL_FALSE, stride, (const void *)(half * 3 * sizeof(float)));
        glEnableVertexAttribArray(6 + half);
    }
}

/* Whose buffers a mesh lies in. */
static const gpu_mesh *home_of(const gpu_mesh *m)
{
    return m->whole ? m->whole : m;
}

bool gpu_mesh_has_tensors(const gpu_mesh *m)
{
    return m && home_of(m)->has_tensors;
}

void gpu_settle(gpu *g)
{
    if (g->capabilities.software && !g->failed)
        gpu_finish(g);
}

bool gpu_mesh_has_walls(const gpu_mesh *m)
{
    return m && home_of(m)->has_walls;
}

bool gpu_mesh_has_rest(const gpu_mesh *m)
{
    return m && home_of(m)->has_rest;
}

bool gpu_mesh_has_past(const gpu_mesh *m)
{
    return m && home_of(m)->has_past;
}

static void add_indices(gpu_mesh *m, const gpu_mesh_data *data)
{
    GLsizeiptr bytes = (GLsizeiptr)(sizeof(uint32_t) * (size_t)data->index_count),
               glue = (GLsizeiptr)(sizeof(uint32_t) * (size_t)data->glue_count);
    m->index_count = data->index_count;
    m->glue_count = data->glue_count;
    glGenBuffers(1, &m->buffers[GPU_BUFFERS - 1]);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m->buffers[GPU_BUFFERS - 1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes + glue, glue ? NULL : data->indices, GL_STATIC_DRAW);
    if (glue) {
        glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, bytes, data->indices);
        glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, bytes, glue, data->glue);
    }
}

gpu_mesh *gpu_mesh_open(gpu *g)
{
    gpu_mesh *m = g->failed ? NULL : mem_calloc(1, sizeof *m);
    if (!m && !g->failed)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    if (m)
        m->users = 1;
    return m;
}

gpu_mesh *gpu_mesh_within(gpu *g, gpu_mesh *whole, uint32_t first_index, uint32_t index_count, uint32_t key)
{
    gpu_mesh *m = whole ? gpu_mesh_open(g) : NULL;
    if (!m)
        return NULL;
    m->whole = whole;
    m->first_index = first_index;
    m->index_count = index_count;
    m->key = key;
    whole->users++;
    return m;
}

bool gpu_mesh_key(const gpu_mesh *m, uint32_t *key)
{
    if (!m || !m->whole)
        return false;
    *key = m->key;
    return true;
}

bool gpu_meshes_together(const gpu_mesh *a, const gpu_mesh *b)
{
    return a && b && a->whole && a->whole == b->whole;
}

gpu_mesh *gpu_mesh_create(gpu *g, const gpu_mesh_data *data)
{
    gpu_mesh *m = gpu_mesh_open(g);
    if (m)
        gpu_mesh_fill(g, m, data);
    return m;
}

void gpu_mesh_fill(gpu *g, gpu_mesh *m, const gpu_mesh_data *data)
{
    if (g->failed)
        return;
    m->vertex_count = data->vertex_count;
    m->has_colours = data->colours != NULL;
    glGenVertexArrays(1, &m->array);
    glBindVertexArray(m->array);
    add_attribute(m, 0, 3, data->vertex_count, data->positions);
    add_attribute(m, 1, 3, data->vertex_count, data->normals);
    add_attribute(m, 2, 2, data->vertex_count, data->uvs[0]);
    add_attribute(m, 3, 2, data->vertex_count, data->uvs[1]);
    add_attribute(m, 4, 4, data->vertex_count, data->colours);
    if (data->keys) {
        glGenBuffers(1, &m->buffers[5]);
        glBindBuffer(GL_ARRAY_BUFFER, m->buffers[5]);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(sizeof(uint32_t) * (size_t)data->vertex_count), data->keys,
                     GL_STATIC_DRAW);
        glVertexAttribIPointer(5, 1, GL_UNSIGNED_INT, 0, NULL);
        glEnableVertexAttribArray(5);
    }
    add_tensors(m, data);
    add_attribute(m, 8, 4, data->vertex_count, data->walls ? data->walls : data->patches);
    m->has_walls = data->walls != NULL;
    add_attribute(m, 9, 3, data->vertex_count, data->rest);
    m->has_rest = data->rest != NULL;
    for (unsigned k = 0; k < GPU_PAST_MAX; k++)
        add_attribute(m, 10 + k, 3, data->vertex_count, data->past[k]);
    m->has_past = data->past[0] != NULL;
    add_indices(m, data);
    glBindVertexArray(0);
    if (glGetError() == GL_OUT_OF_MEMORY)
        gpu_fail(g, LMN_MEMORY, "the driver has no memory for a mesh of %u vertices", data->vertex_count);
}

static void rewrite(gpu_mesh *m, int buffer, int components, const void *data)
{
    if (!data || !m->buffers[buffer])
        return;
    glBindBuffer(GL_ARRAY_BUFFER, m->buffers[buffer]);
    glBufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(sizeof(float) * (size_t)components * m->vertex_count), data);
}

bool gpu_mesh_rewrite(gpu *g, gpu_mesh *m, const gpu_mesh_data *data)
{
    if (g->failed || !m || m->whole || m->vertex_count != data->vertex_count || m->index_count != data->index_count ||
        m->glue_count != data->glue_count || m->has_tensors != (data->tensors != NULL) ||
        m->has_walls != (data->walls != NULL) || m->has_rest != (data->rest != NULL) ||
        m->has_past != (data->past[0] != NULL))
        return false;
    for (int k = 1; k < GPU_PAST_MAX; k++)
        if ((m->buffers[10 + k] != 0) != (data->past[k] != NULL))
            return false;
    const struct {
        int         buffer, components;
        const void *values;
    } rows[] = {{0, 3, data->positions}, {1, 3, data->normals},
                {2, 2, data->uvs[0]},    {3, 2, data->uvs[1]},
                {4, 4, data->colours},   {5, 1, data->keys},
                {6, 6, data->tensors},   {8, 4, data->walls ? data->walls : data->patches},
                {9, 3, data->rest}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        rewrite(m, rows[i].buffer, rows[i].components, rows[i].values);
    for (int k = 0; k < GPU_PAST_MAX; k++)
        rewrite(m, 10 + k, 3, data->past[k]);
    if (data->indices) {
        glBindVertexArray(m->array); /* the indices' binding belongs to it */
        glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, (GLsizeiptr)(sizeof(uint32_t) * (size_t)m->index_count),
                        data->indices);
        glBindVertexArray(0);
    }
    if (data->glue_count) {
        glBindVertexArray(m->array);
        glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)(sizeof(uint32_t) * (size_t)m->index_count),
                        (GLsizeiptr)(sizeof(uint32_t) * (size_t)m->glue_count), data->glue);
        glBindVertexArray(0);
    }
    return true;
}

void gpu_mesh_destroy(gpu *g, gpu_mesh **m)
{
    gpu_mesh *one = *m, *whole = one ? one->whole : NULL;
    *m = NULL;
    if (!one || --one->users > 0)
        return;
    if (!g->gone && !whole) {
        glDeleteVertexArrays(1, &one->array);
        glDeleteBuffers(GPU_BUFFERS, one->buffers);
    }
    mem_free(one);
    gpu_mesh_destroy(g, &whole);
}

uint32_t gpu_mesh_triangles(const gpu_mesh *m)
{
    return m ? m->index_count / 3 : 0;
}

/* `before`: triangles of what is drawn that come before these. */
static void draw_indices(gpu *g, uint32_t first, uint32_t count, uint32_t before)
{
    if (gpu_has_uniform(g, "u_first_primitive"))
        gpu_set_uint(g, "u_first_primitive", before);
    glDrawElements(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT, (const void *)(sizeof(uint32_t) * (size_t)first));
    pace_drawn(g, count, 0);
}

static void draw_range(gpu *g, uint32_t first, uint32_t end, uint32_t before)
{
    for (uint32_t count; first < end && pace_goes_on(g); first += count, before += count / 3) {
        count = pace_indices(g, end - first);
        draw_indices(g, first, count, before);
    }
}

void gpu_draw_indices(gpu *g, uint32_t first, uint32_t count)
{
    draw_range(g, first, first + count, first / 3);
}

void gpu_draw_mesh_runs(gpu *g, gpu_mesh *m, uint32_t (*runs)[2], size_t count)
{
    if (g->failed || !g->program || !m || !count)
        return;
    glBindVertexArray(m->array);
    for (size_t i = 0, next; i < count; i = next) {
        uint32_t end = runs[i][0] + runs[i][1];
        for (next = i + 1; next < count && runs[next][0] == end; next++)
            end += runs[next][1];
        draw_range(g, runs[i][0], end, runs[i][0] / 3);
    }
    g->draws++;
}

void gpu_query_begin(gpu *g, int query)
{
    if (!g->failed)
        glBeginQuery(GL_ANY_SAMPLES_PASSED, g->queries[query]);
}

void gpu_query_end(gpu *g)
{
    if (!g->failed)
        glEndQuery(GL_ANY_SAMPLES_PASSED);
}

bool gpu_query_any(gpu *g, int query)
{
    GLuint any = 0;
    if (!g->failed)
        glGetQueryObjectuiv(g->queries[query], GL_QUERY_RESULT, &any);
    return any != 0;
}

void gpu_draw_mesh(gpu *g, gpu_mesh *m)
{
    gpu_draw_meshes(g, &m, 1);
}

void gpu_draw_meshes(gpu *g, gpu_mesh *const *meshes, size_t count)
{
    if (g->failed || !g->program || !count || !meshes[0])
        return;
    const gpu_mesh *home = home_of(meshes[0]);
    uint32_t        before = 0;
    glBindVertexArray(home->array);
    if (!home->has_colours)
        glVertexAttrib4f(4, 1, 1, 1, 1);
    for (size_t i = 0, next; i < count; i = next) {
        uint32_t first = meshes[i]->first_index, end = first + meshes[i]->index_count;
        for (next = i + 1; next < count && meshes[next]->first_index == end; next++)
            end += meshes[next]->index_count;
        draw_range(g, first, end, before);
        before += (end - first) / 3;
    }
    g->draws++;
}

void gpu_draw_glue(gpu *g, gpu_mesh *m)
{
    if (g->failed || !g->program || !m || !m->glue_count)
        return;
    glBindVertexArray(m->array);
    draw_range(g, m->index_count, m->index_count + m->glue_count, m->index_count / 3);
    g->draws++;
}
