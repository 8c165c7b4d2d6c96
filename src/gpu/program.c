/* Programs: shader files with #include, a generated prelude, and compile errors that name file and line. */
#include "gpu/gpu_private.h"

#include <stdlib.h>
#include <string.h>

#include "base/embedded.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/work.h"

enum { FILES_MAX = 32, INCLUDE_DEPTH_MAX = 8, FILE_LINES_MAX = 2000 };

/* The files a shader was put together from. Drivers refuse their names in #line, and Mesa forgets their numbers in
 * errors about meaning: so a line's number says which file it is in. The file at i begins at line (i + 1) ·
 * FILE_LINES_MAX + 1; below are the lines of the prelude. */
typedef struct source {
    text        body;
    const char *files[FILES_MAX];
    int         file_count;
} source;

static const char desktop_head[] = "#version 330 core\n#extension GL_ARB_texture_gather : enable\n",
                  fast_head[] = "#version 430 core\n";
static const char es_head[] =
    "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
    "precision highp usampler2D;\nprecision highp sampler2DArray;\n";

static bool append_file(gpu *g, source *s, const char *path, int depth);

static const char *embedded_text(const char *path, size_t *size)
{
    for (size_t i = 0; i < embedded_shaders_count; i++)
        if (strcmp(embedded_shaders[i].path, path) == 0) {
            *size = embedded_shaders[i].size;
            return embedded_shaders[i].data;
        }
    return NULL;
}

/* --- texts from outside of the library ------------------------------------------------------------------ */

static const given_source *given(const gpu *g, const char *path)
{
    for (size_t i = 0; i < g->source_count; i++)
        if (strcmp(g->sources[i].path, path) == 0)
            return &g->sources[i];
    return NULL;
}

/* The one that a '+'-joined list has; NULL: none. */
static const given_source *given_among(const gpu *g, const char *list)
{
    for (size_t i = 0; i < g->source_count; i++)
        if (strstr(list, g->sources[i].path))
            return &g->sources[i];
    return NULL;
}

static void given_release(given_source *s)
{
    mem_free(s->path);
    mem_free(s->label);
    mem_free(s->text);
}

bool gpu_give_source(gpu *g, const char *path, const char *label, const char *content)
{
    if (given(g, path))
        return true;
    if (!mem_grow((void **)&g->sources, &g->source_capacity, g->source_count + 1, sizeof *g->sources))
        return false;
    given_source s = {mem_copy_text(path), mem_copy_text(label), mem_copy_text(content)};
    if (!s.path || !s.label || !s.text) {
        given_release(&s);
        return false;
    }
    g->sources[g->source_count++] = s;
    return true;
}

void gpu_sources_release(gpu *g)
{
    for (size_t i = 0; i < g->source_count; i++)
        given_release(&g->sources[i]);
    mem_free(g->sources);
}

/* --- putting shaders together --------------------------------------------------------------------------- */

/* LIMNER_SHADER_DIR lets shaders be edited without a build. */
static char *load_text(gpu *g, const char *path)
{
    const char         *folder = getenv("LIMNER_SHADER_DIR");
    const given_source *outside = given(g, path);
    if (outside)
        return mem_copy_text(outside->text);
    if (folder) {
        text joined = {0};
        text_append(&joined, "%s/%s", folder, path);
        char     *name = text_take(&joined);
        file_data data;
        if (name && file_load(&data, name, NULL) == LMN_OK) {
            char *copy = mem_copy_text((const char *)data.data);
            file_data_release(&data);
            mem_free(name);
            return copy;
        }
        mem_free(name);
    }
    size_t      size;
    const char *found = embedded_text(path, &size);
    if (!found)
        gpu_fail(g, LMN_INTERNAL, "shader file src/%s is not in the library", path);
    return found ? mem_copy_text(found) : NULL;
}

static bool append_include(gpu *g, source *s, const char *line, size_t length, int depth)
{
    const char *open = memchr(line, '"', length);
    const char *close = open ? memchr(open + 1, '"', length - (size_t)(open + 1 - line)) : NULL;
    if (!close) {
        gpu_fail(g, LMN_INTERNAL, "a shader's #include has no quoted path");
        return false;
    }
    char   path[128];
    size_t size = (size_t)(close - open) - 1;
    if (size >= sizeof path)
        return false;
    memcpy(path, open + 1, size);
    path[size] = '\0';
    for (int i = 0; i < s->file_count; i++)
        if (strcmp(s->files[i], path) == 0)
            return true;
    return append_file(g, s, path, depth + 1);
}

static bool append_file(gpu *g, source *s, const char *path, int depth)
{
    if (depth > INCLUDE_DEPTH_MAX || s->file_count >= FILES_MAX) {
        gpu_fail(g, LMN_INTERNAL, "shader includes are nested too deep at src/%s", path);
        return false;
    }
    char *content = load_text(g, path);
    if (!content)
        return false;
    int id = s->file_count++;
    s->files[id] = mem_copy_text(path);
    bool good = s->files[id] != NULL;
    int  before = (id + 1) * FILE_LINES_MAX;
    text_append(&s->body, "#line %d\n", before + 1);
    int number = 1;
    for (const char *line = content; good && *line; number++) {
        const char *end = strchr(line, '\n');
        size_t      length = end ? (size_t)(end - line) + 1 : strlen(line);
        if (strncmp(line, "#include", 8) == 0) {
            good = append_include(g, s, line, length, depth);
            text_append(&s->body, "#line %d\n", before + number + 1);
        } else {
            text_append_bytes(&s->body, line, length);
        }
        line += length;
    }
    mem_free(content);
    return good;
}

/* Appends the files of a '+'-joined list. */
static bool append_files(gpu *g, source *s, const char *list)
{
    char path[128];
    for (const char *at = list; *at;) {
        size_t length = strcspn(at, "+");
        if (length >= sizeof path)
            return false;
        memcpy(path, at, length);
        path[length] = '\0';
        if (!append_file(g, s, path, 0))
            return false;
        at += length + (at[length] == '+');
    }
    return true;
}

static void source_release(source *s)
{
    for (int i = 0; i < s->file_count; i++)
        mem_free((char *)s->files[i]);
    text_release(&s->body);
}

/* The one of a '+'-joined list that has main(). */
static const char *main_file(const char *list)
{
    const char *last = strrchr(list, '+');
    return last ? last + 1 : list;
}

/* --- what drivers say ----------------------------------------------------------------------------------- */

/* Where a line of the log says that something is: "0:4012(3): error: …", "ERROR: 0:4012: …" and "0(4012) : error …"
 * all mean line 12 of a file. */
typedef struct log_place {
    const char *file;   /* NULL: it does not say */
    long        line;   /* of the file */
    const char *behind; /* what follows it */
} log_place;

static log_place place_of(const source *s, const char *line)
{
    const char *at = strncmp(line, "ERROR: ", 7) == 0 ? line + 7 : strncmp(line, "WARNING: ", 9) == 0 ? line + 9 : line;
    size_t      digits = strspn(at, "0123456789");
    char       *behind = NULL;
    long number = digits > 0 && (at[digits] == ':' || at[digits] == '(') ? strtol(at + digits + 1, &behind, 10) : 0;
    long file = number / FILE_LINES_MAX - 1;
    if (file < 0 || file >= s->file_count)
        return (log_place){.behind = line};
    return (log_place){s->files[file], number % FILE_LINES_MAX, behind + (*behind == ')')};
}

static void append_name(text *out, const gpu *g, const char *file)
{
    const given_source *outside = given(g, file);
    text_append(out, "%s%s", outside ? "" : "src/", outside ? outside->label : file);
}

/* The log with names and lines of files. */
static text explained(const gpu *g, const source *s, const char *log)
{
    text out = {0};
    for (const char *line = log; *line;) {
        size_t    length = strcspn(line, "\n");
        log_place at = place_of(s, line);
        length += line[length] == '\n';
        if (at.file) {
            append_name(&out, g, at.file);
            text_append(&out, ":%ld", at.line);
        }
        text_append_bytes(&out, at.behind, (size_t)(line + length - at.behind));
        line += length;
    }
    while (!out.failed && out.size > 0 && strchr("\n\r ", out.data[out.size - 1]))
        out.data[--out.size] = '\0';
    return out;
}

/* The first error of the log that lies in a text from outside; what warns comes before it. */
static log_place error_outside(const gpu *g, const source *s, const char *log)
{
    for (const char *line = log; *line; line += line[strcspn(line, "\n")] ? strcspn(line, "\n") + 1 : strlen(line)) {
        log_place   at = place_of(s, line);
        const char *word = strstr(line, "rror"), *end = line + strcspn(line, "\n");
        if (at.file && given(g, at.file) && word && word < end)
            return at;
    }
    return (log_place){0};
}

/* The shader is a text from outside together with files of the library, which are right. */
static void explain_outside(gpu *g, const source *s, const given_source *outside, const char *log, const char *all)
{
    log_place at = error_outside(g, s, log);
    if (!at.file) {
        gpu_fail_in(g, LMN_GL, outside->label, 0, "the driver refuses the shader with this text in it: %s", all);
        return;
    }
    const char *from = at.behind + strspn(at.behind, ": ");
    gpu_fail_in(g, LMN_GL, given(g, at.file)->label, (int)at.line, "%.*s", (int)strcspn(from, "\n"), from);
}

static void explain(gpu *g, const source *s, const char *path, const char *log)
{
    text                out = explained(g, s, log);
    const given_source *outside = given_among(g, path);
    if (outside)
        explain_outside(g, s, outside, log, out.failed || !out.data ? log : out.data);
    else if (!out.failed && out.size > 4 && strncmp(out.data, "src/", 4) == 0)
        gpu_fail(g, LMN_GL, "%s", out.data);
    else
        gpu_fail(g, LMN_GL, "src/%s: the driver refuses the shader: %s", main_file(path),
                 out.failed || !out.data ? log : out.data);
    text_release(&out);
}

/* What the driver says of a shader that it takes. */
static void tell_warnings(gpu *g, const source *s, GLuint shader)
{
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    text out = explained(g, s, log);
    if (out.data && out.size)
        work_log(LMN_LOG_DRIVER, "driver", out.data);
    text_release(&out);
}

static GLuint compile(gpu *g, gpu_dialect dialect, GLenum stage, const char *path, const char *prelude)
{
    source s = {0};
    GLuint shader = 0;
    text_append(&s.body, "%s%s%s",
                dialect == GPU_FAST  ? fast_head
                : g->capabilities.es ? es_head
                                     : desktop_head,
                g->capabilities.lanes_stay ? "#define LANES_STAY\n" : "", prelude);
    if (append_files(g, &s, path) && !s.body.failed) {
        shader = glCreateShader(stage);
        const char *body = s.body.data;
        glShaderSource(shader, 1, &body, NULL);
        glCompileShader(shader);
        GLint good = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
        if (!good) {
            char log[1024] = "";
            glGetShaderInfoLog(shader, sizeof log, NULL, log);
            explain(g, &s, path, log);
            glDeleteShader(shader);
            shader = 0;
        } else if (work_listens()) {
            tell_warnings(g, &s, shader);
        }
    } else {
        gpu_fail(g, LMN_MEMORY, "out of memory"); /* where it was something else, that was said first */
    }
    source_release(&s);
    return shader;
}

static GLuint link_program(gpu *g, GLuint vertex, GLuint fragment, const char *path)
{
    GLuint program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    GLint good = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good)
        return program;
    char log[1024] = "";
    glGetProgramInfoLog(program, sizeof log, NULL, log);
    const given_source *outside = given_among(g, path);
    if (outside)
        gpu_fail_in(g, LMN_GL, outside->label, 0, "the driver cannot link the program with this text in it: %s", log);
    else
        gpu_fail(g, LMN_GL, "src/%s: the driver cannot link the program: %s", main_file(path), log);
    glDeleteProgram(program);
    return 0;
}

static gpu_program *add_program(gpu *g, GLuint name, char *key)
{
    gpu_program *p = mem_calloc(1, sizeof *p);
    if (!p || !mem_grow((void **)&g->programs, &g->program_capacity, g->program_count + 1, sizeof *g->programs)) {
        mem_free(p);
        glDeleteProgram(name);
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    p->name = name;
    p->key = key;
    g->programs[g->program_count++] = p;
    return p;
}

gpu_program *gpu_program_of(gpu *g, gpu_dialect dialect, const char *vertex, const char *fragment, const char *prelude)
{
    if (g->failed)
        return NULL;
    text joined = {0};
    text_append(&joined, "%d|%s|%s|%s", (int)dialect, vertex, fragment, prelude);
    char *key = text_take(&joined);
    if (!key) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    for (size_t i = 0; i < g->program_count; i++)
        if (strcmp(g->programs[i]->key, key) == 0) {
            mem_free(key);
            return g->programs[i];
        }
    GLuint vertex_shader = compile(g, dialect, GL_VERTEX_SHADER, vertex, prelude);
    GLuint fragment_shader = vertex_shader ? compile(g, dialect, GL_FRAGMENT_SHADER, fragment, prelude) : 0;
    GLuint name = fragment_shader ? link_program(g, vertex_shader, fragment_shader, fragment) : 0;
    glDeleteShader(vertex_shader);
    glDeleteShader(fragment_shader);
    gpu_program *program = name ? add_program(g, name, key) : NULL;
    if (!program)
        mem_free(key);
    return program;
}

size_t gpu_program_count(const gpu *g)
{
    return g->program_count;
}

static GLint location_of(gpu *g, const char *name)
{
    gpu_program *p = g->program;
    if (!p)
        return -1;
    for (int i = 0; i < p->uniform_count; i++)
        if (strcmp(p->uniforms[i].name, name) == 0)
            return p->uniforms[i].location;
    GLint location = glGetUniformLocation(p->name, name);
    char *copy = p->uniform_count < UNIFORMS_MAX ? mem_copy_text(name) : NULL;
    if (copy)
        p->uniforms[p->uniform_count++] = (uniform_slot){copy, location};
    return location;
}

bool gpu_has_uniform(gpu *g, const char *name)
{
    return location_of(g, name) >= 0;
}

void gpu_set_int(gpu *g, const char *name, int value)
{
    glUniform1i(location_of(g, name), value);
}

void gpu_set_uint(gpu *g, const char *name, unsigned value)
{
    glUniform1ui(location_of(g, name), value);
}

void gpu_set_float(gpu *g, const char *name, float value)
{
    glUniform1f(location_of(g, name), value);
}

void gpu_set_vec2(gpu *g, const char *name, float x, float y)
{
    glUniform2f(location_of(g, name), x, y);
}

void gpu_set_ivec2(gpu *g, const char *name, int x, int y)
{
    glUniform2i(location_of(g, name), x, y);
}

void gpu_set_vec3(gpu *g, const char *name, const float v[3])
{
    glUniform3fv(location_of(g, name), 1, v);
}

void gpu_set_vec4(gpu *g, const char *name, const float v[4])
{
    glUniform4fv(location_of(g, name), 1, v);
}

void gpu_set_vec4_array(gpu *g, const char *name, const float *v, int count)
{
    glUniform4fv(location_of(g, name), count, v);
}

void gpu_set_mat3(gpu *g, const char *name, const float m[9])
{
    glUniformMatrix3fv(location_of(g, name), 1, GL_FALSE, m);
}

void gpu_set_mat4(gpu *g, const char *name, const float m[16])
{
    glUniformMatrix4fv(location_of(g, name), 1, GL_FALSE, m);
}
