/* What needs the surface of a solid that is a tree: sums of two concave ones, hulls and shadows of differences and
 * intersections. Where `openscad` is on the PATH it evaluates these, and nothing else: it gets the operands' triangles
 * and what is done with them, so that it reads no file of the model's. What it answers is kept by what it was asked. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/error.h"
#include "base/file.h"
#include "base/file_temporary.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/store.h"
#include "base/text.h"
#include "import/csg.h"
#include "import/openscad.h"

/* --- what is asked -------------------------------------------------------------------------------------- */

/* "[x,y,z]", whatever the host's decimal point. */
static void print_vector(text *out, const double *values, int count, int apart)
{
    for (int i = 0; i < count; i++) {
        char printed[40], pointed[40];
        snprintf(printed, sizeof printed, "%.17g", values[i * apart]);
        text_with_point(pointed, printed);
        text_append(out, "%s%s", i ? "," : "[", pointed);
    }
    text_append(out, "]");
}

static void print_matrix(text *out, const mat4 *m)
{
    text_append(out, "multmatrix([");
    for (int row = 0; row < 3; row++) {
        print_vector(out, &m->m[row], 4, 4);
        text_append(out, row < 2 ? "," : "])");
    }
}

/* OpenSCAD's faces run clockwise, seen from outside. */
static void print_mesh(text *out, const polyhedron *p)
{
    text_append(out, "polyhedron(points=[");
    for (size_t i = 0; i < p->point_count; i++) {
        print_vector(out, (double[]){p->points[i].x, p->points[i].y, p->points[i].z}, 3, 1);
        text_append(out, ",");
    }
    text_append(out, "],faces=[");
    for (size_t i = 0; i < p->triangle_count; i++)
        text_append(out, "[%u,%u,%u],", p->triangles[3 * i], p->triangles[3 * i + 2], p->triangles[3 * i + 1]);
    text_append(out, "],convexity=10);\n");
}

static void print_shape(text *out, const csg_reader *r, int32_t shape)
{
    const csg_shape *s = &r->shapes[shape];
    print_matrix(out, &s->matrix);
    if (s->kind == SOLID_OPERAND) {
        print_mesh(out, &r->meshes[s->mesh].polyhedron);
        return;
    }
    text_append(out, "%s(){\n",
                s->kind == SOLID_UNION          ? "union"
                : s->kind == SOLID_INTERSECTION ? "intersection"
                                                : "difference");
    for (int32_t c = s->first_child; c != NONE; c = r->shapes[c].next)
        print_shape(out, r, c);
    text_append(out, "}\n");
}

/* --- what is answered: OFF ------------------------------------------------------------------------------ */

/* The next number; false at the end or where there is none. */
static bool next_number(const char **at, const char *end, double *out)
{
    while (*at < end && (**at == ' ' || **at == '\n' || **at == '\r' || **at == '\t'))
        (*at)++;
    const char *after = *at < end ? text_parse_double(*at, end, out) : NULL;
    if (!after || after == *at)
        return false;
    *at = after;
    return true;
}

static bool next_index(const char **at, const char *end, double least, double limit, uint32_t *out)
{
    double value;
    if (!next_number(at, end, &value) || !(value >= least && value < limit))
        return false;
    *out = (uint32_t)value;
    return true;
}

/* A face as a fan, which OpenSCAD's are: triangles, or convex. What stands behind its corners, a colour, goes. */
static bool read_face(const char **at, const char *end, polyhedron *p, size_t *capacity)
{
    uint32_t corners, first = 0, before = 0;
    if (!next_index(at, end, 3, 1e6, &corners))
        return false;
    for (uint32_t i = 0; i < corners; i++) {
        uint32_t own;
        if (!next_index(at, end, 0, (double)p->point_count, &own))
            return false;
        if (i >= 2) {
            if (!mem_grow((void **)&p->triangles, capacity, 3 * (p->triangle_count + 1), sizeof *p->triangles))
                return false;
            memcpy(&p->triangles[3 * p->triangle_count++], (uint32_t[]){first, before, own}, 3 * sizeof own);
        }
        first = i ? first : own;
        before = own;
    }
    while (*at < end && **at != '\n')
        (*at)++;
    return true;
}

/* The text ends in a NUL. */
static bool read_off(polyhedron *out, const char *bytes, size_t size)
{
    const char *at = bytes, *end = bytes + size;
    uint32_t    points, faces, unused;
    size_t      capacity = 0;
    if (size < 4 || strncmp(at, "OFF", 3) != 0)
        return false;
    at += 3;
    if (!next_index(&at, end, 0, (double)LIMIT_VERTICES, &points) ||
        !next_index(&at, end, 0, (double)LIMIT_VERTICES, &faces) || !next_index(&at, end, 0, 1e9, &unused))
        return false;
    out->points = mem_alloc((points + 1) * sizeof *out->points);
    if (!out->points)
        return false;
    for (; out->point_count < points; out->point_count++) {
        point3 *p = &out->points[out->point_count];
        if (!next_number(&at, end, &p->x) || !next_number(&at, end, &p->y) || !next_number(&at, end, &p->z))
            return false;
    }
    for (uint32_t i = 0; i < faces; i++)
        if (!read_face(&at, end, out, &capacity))
            return false;
    return true;
}

/* --- kept answers: as texels, a number of eight bytes before them --------------------------------------- */

enum { KEPT_SIDE = 4096 };

static void keep(const char *description, const file_data *answer)
{
    mip_chain chain = {0};
    uint64_t  size = answer->size;
    size_t    rows = (answer->size + sizeof size + KEPT_SIDE - 1) / KEPT_SIDE;
    if (rows > KEPT_SIDE || mip_chain_create(&chain, KEPT_SIDE, (int)rows, 1, 1, MIP_R8, NULL) != LMN_OK)
        return;
    memcpy(chain.data[0], &size, sizeof size);
    memcpy((char *)chain.data[0] + sizeof size, answer->data, answer->size);
    store_keep(&chain, description);
    mip_chain_release(&chain);
}

static bool find_kept(polyhedron *out, const char *description)
{
    mip_chain chain = {0};
    uint64_t  size = 0;
    if (!store_find(&chain, description))
        return false;
    size_t room = (size_t)chain.width * (size_t)chain.height;
    bool   good = chain.format == MIP_R8 && room > sizeof size;
    if (good)
        memcpy(&size, chain.data[0], sizeof size);
    char *bytes = good && size <= room - sizeof size ? mem_alloc(size + 1) : NULL;
    if (bytes) {
        memcpy(bytes, (char *)chain.data[0] + sizeof size, size);
        bytes[size] = '\0';
    }
    good = bytes && read_off(out, bytes, size);
    mem_free(bytes);
    mip_chain_release(&chain);
    if (!good)
        polyhedron_release(out);
    return good;
}

/* --- asking --------------------------------------------------------------------------------------------- */

static lmn_status write_program(openscad_run *e, char *path, size_t capacity, const char *program)
{
    snprintf(path, capacity, "%s/asked.scad", e->folder);
    FILE *file = fopen(path, "wb");
    bool  good = file && fputs(program, file) >= 0;
    good = file && fclose(file) == 0 && good;
    return good ? LMN_OK : error_in_file(e->error, LMN_WRITE, e->job->path, 0, "%s cannot be written", path);
}

/* Reads what it wrote; when there is nothing, *why says so. An empty solid is an answer. */
static bool read_answer(openscad_run *e, polyhedron *out, const char *description, const char **why)
{
    file_data file;
    lmn_error unused = {0};
    bool      empty = strstr(e->said, "top level object is empty") != NULL;
    *why = openscad_was_stopped(e) ? "openscad took too long" : "openscad failed";
    /* It goes on without a mesh that it cannot work with. */
    if (openscad_was_stopped(e) || strstr(e->said, "ERROR:"))
        return false;
    if (empty)
        return true;
    if (!WIFEXITED(e->status) || WEXITSTATUS(e->status) != 0 || file_load(&file, e->output, &unused) != LMN_OK)
        return false;
    char *bytes = mem_alloc(file.size + 1);
    if (bytes) {
        memcpy(bytes, file.data, file.size);
        bytes[file.size] = '\0';
    }
    bool good = bytes && read_off(out, bytes, file.size);
    mem_free(bytes);
    if (good)
        keep(description, &file);
    else
        polyhedron_release(out);
    file_data_release(&file);
    return good;
}

static lmn_status ask(openscad_run *e, const char *program, polyhedron *out, const char **why)
{
    char       path[OPENSCAD_PATH_CAPACITY + 16];
    lmn_status status = openscad_make_folder(e, "answer.off");
    if (status == LMN_OK)
        status = write_program(e, path, sizeof path, program);
    if (status == LMN_OK)
        status = openscad_evaluate(e, path, NULL, 0);
    if (status == LMN_OK && read_answer(e, out, program, why))
        *why = NULL;
    if (e->folder[0])
        temporary_folder_remove(e->folder);
    return status;
}

lmn_status csg_evaluate(csg_reader *r, const char *head, const mat4 *above, const int32_t *shapes, size_t count,
                        polyhedron *out, const char **why)
{
    text program = {0};
    *out = (polyhedron){0};
    text_append(&program, "// limner 1\n%s{\n", head);
    for (size_t i = 0; i < count; i++) {
        print_matrix(&program, above);
        print_shape(&program, r, shapes[i]);
    }
    text_append(&program, "}\n");
    char         *finished = text_take(&program);
    openscad_run *e = finished ? mem_calloc(1, sizeof *e) : NULL;
    lmn_status    status = LMN_OK;
    *why = NULL;
    if (!e) {
        status = error_memory(r->error);
    } else if (!find_kept(out, finished)) {
        e->job = r->job;
        e->error = r->error;
        *why =
            !openscad_is_allowed() ? "--safe runs no programs" : "openscad, which is not on the PATH, would compute it";
        if (openscad_is_allowed() && openscad_find(e))
            status = ask(e, finished, out, why);
    }
    mem_free(e);
    mem_free(finished);
    return status;
}
