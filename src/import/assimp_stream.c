/* The parent's side: from the child's bytes to a scene. */
#include "import/assimp_stream.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/colour.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "import/build.h"
#include "scene/mesh.h"

enum { CHAIN_MAX = 64, MATERIAL_FLOATS = 9, INVENTED = -2 };

typedef struct stream {
    const import_job    *job;
    const unsigned char *at, *end;
    lmn_error           *error;
    lmn_status           status;
    primitive           *meshes; /* as the child sent them, welded */
    char               **mesh_names;
    uint32_t            *uses;
    uint32_t             mesh_count, material_count;
    int32_t             *materials; /* the child's → the scene's; INVENTED: assimp's own, made when a mesh uses it */
    int32_t             *images;    /* of embedded pictures, NONE when they cannot be had */
    uint32_t             image_count;
    size_t               vertices, triangles;
} stream;

/* The child died in the middle, or lied. */
static bool broken(stream *s)
{
    if (s->status == LMN_OK)
        s->status = error_in_file(s->error, LMN_FORMAT, s->job->path, 0, "the reader of this format gave broken data");
    return false;
}

static bool out_of_memory(stream *s)
{
    if (s->status == LMN_OK)
        s->status = error_memory(s->error);
    return false;
}

static const unsigned char *take(stream *s, size_t size)
{
    if (s->status != LMN_OK || (size_t)(s->end - s->at) < size) {
        broken(s);
        return NULL;
    }
    const unsigned char *from = s->at;
    s->at += size;
    return from;
}

static uint32_t take_u32(stream *s)
{
    uint32_t             value = 0;
    const unsigned char *from = take(s, sizeof value);
    if (from)
        memcpy(&value, from, sizeof value);
    return value;
}

/* A count of things that take at least `smallest` bytes each. */
static uint32_t take_count(stream *s, size_t smallest)
{
    uint32_t count = take_u32(s);
    if (s->status == LMN_OK && count > (size_t)(s->end - s->at) / smallest)
        broken(s);
    return s->status == LMN_OK ? count : 0;
}

/* NULL for an empty text or after an error. */
static char *take_text(stream *s)
{
    uint32_t             size = take_count(s, 1);
    const unsigned char *from = take(s, size);
    if (!from || size == 0)
        return NULL;
    char *copy = scene_clean_name((const char *)from, size);
    if (!copy)
        out_of_memory(s);
    return copy;
}

static void *take_array(stream *s, size_t count, size_t size)
{
    size_t               bytes;
    const unsigned char *from = size_mul(count, size, &bytes) ? take(s, bytes) : NULL;
    void                *copy = from ? mem_copy(from, bytes) : NULL;
    if (!copy)
        from ? out_of_memory(s) : broken(s);
    return copy;
}

/* --- materials ------------------------------------------------------------------------------------------ */

static int32_t embedded_image(stream *s, const char *name)
{
    long index = strtol(name + 1, NULL, 10);
    return index >= 0 && (uint32_t)index < s->image_count ? s->images[index] : NONE;
}

static bool was_loaded(const stream *s, const char *name, int32_t *out)
{
    for (size_t i = 0; i < s->job->scene->image_count; i++)
        if (s->job->scene->images[i].name && strcmp(s->job->scene->images[i].name, name) == 0) {
            *out = (int32_t)i;
            return true;
        }
    return false;
}

static int32_t find_image(stream *s, char *name)
{
    int32_t image_index = NONE;
    if (name[0] == '*')
        return embedded_image(s, name);
    for (char *p = name; *p; p++)
        if (*p == '\\')
            *p = '/';
    if (!was_loaded(s, name, &image_index)) {
        lmn_status status = build_image_file(s->job, name, &image_index, s->error);
        if (s->status == LMN_OK)
            s->status = status;
    }
    return image_index;
}

static float unit(float value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

static void read_material(stream *s, uint32_t index)
{
    float                v[MATERIAL_FLOATS];
    char                *name = take_text(s);
    const unsigned char *from = take(s, sizeof v);
    char                *texture = take_text(s);
    bool                 invented = name && strcmp(name, "DefaultMaterial") == 0; /* the file has none */
    if (s->status == LMN_OK && invented) {
        s->materials[index] = INVENTED;
        mem_free(name);
    } else if (s->status == LMN_OK) {
        material *m = scene_append_material(s->job->scene);
        if (m) {
            memcpy(v, from, sizeof v);
            m->name = name;
            m->base_colour = (vec4){colour_to_linear(unit(v[0])), colour_to_linear(unit(v[1])),
                                    colour_to_linear(unit(v[2])), unit(v[3])};
            for (int i = 0; i < 3; i++)
                m->emissive[i] = colour_to_linear(unit(v[4 + i]));
            m->shininess = isfinite(v[7]) && v[7] > 0 ? v[7] : 0;
            m->double_sided = v[8] > 0;
            m->alpha = m->base_colour.w < 1 ? ALPHA_BLEND : ALPHA_OPAQUE;
            s->materials[index] = (int32_t)s->job->scene->material_count - 1;
            m->base_texture.image = texture ? find_image(s, texture) : NONE;
        } else {
            mem_free(name);
            out_of_memory(s);
        }
    } else {
        mem_free(name);
    }
    mem_free(texture);
}

/* Pictures come behind the materials that name them, so they are found first. */
static void skip_material(stream *s)
{
    uint32_t size = take_count(s, 1);
    take(s, size);
    take(s, MATERIAL_FLOATS * sizeof(float));
    size = take_count(s, 1);
    take(s, size);
}

static void read_pictures(stream *s)
{
    s->image_count = take_count(s, 4);
    s->images = mem_alloc(s->image_count * sizeof *s->images);
    if (!s->images) {
        s->image_count = 0;
        out_of_memory(s);
    }
    for (uint32_t i = 0; i < s->image_count; i++)
        s->images[i] = NONE;
    for (uint32_t i = 0; i < s->image_count && s->status == LMN_OK; i++) {
        char                 name[32];
        uint32_t             size = take_count(s, 1);
        const unsigned char *bytes = take(s, size);
        snprintf(name, sizeof name, "embedded %u", (unsigned)i);
        if (bytes && size > 0)
            s->status = build_image_bytes(s->job, name, bytes, size, &s->images[i], s->error);
    }
}

static void read_materials(stream *s)
{
    s->material_count = take_count(s, 4 + MATERIAL_FLOATS * sizeof(float) + 4);
    const unsigned char *first = s->at;
    s->materials = mem_calloc(s->material_count, sizeof *s->materials);
    if (!s->materials)
        out_of_memory(s);
    for (uint32_t i = 0; i < s->material_count && s->status == LMN_OK; i++)
        skip_material(s);
    read_pictures(s);
    const unsigned char *behind = s->at;
    s->at = first;
    for (uint32_t i = 0; i < s->material_count && s->status == LMN_OK; i++)
        read_material(s, i);
    if (s->status == LMN_OK)
        s->at = behind;
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static bool same_bytes(const void *array, size_t element, uint32_t a, uint32_t b)
{
    const char *bytes = array;
    return !bytes || memcmp(bytes + a * element, bytes + b * element, element) == 0;
}

static bool same_vertex(const primitive *p, uint32_t a, uint32_t b)
{
    return same_bytes(p->normals, sizeof *p->normals, a, b) && same_bytes(p->uvs[0], sizeof *p->uvs[0], a, b) &&
           same_bytes(p->uvs[1], sizeof *p->uvs[1], a, b) && same_bytes(p->colours, sizeof *p->colours, a, b);
}

/* Gives back the sharing that assimp takes away: corners that agree in all the file says become one vertex. The
 * unused ones are dropped when the scene is finished. */
static bool share_vertices(stream *s, primitive *p)
{
    uint32_t *ids = mesh_position_ids(p);
    uint32_t *next = mem_alloc((size_t)p->vertex_count * sizeof *next);
    bool      good = ids && next;
    for (uint32_t v = 0; good && v < p->vertex_count; v++) {
        uint32_t other = ids[v], last = v;
        next[v] = UINT32_MAX;
        if (other == v)
            continue;
        int steps = 0;
        for (; other != UINT32_MAX && steps < CHAIN_MAX; last = other, other = next[other], steps++)
            if (same_vertex(p, other, v))
                break;
        if (other != UINT32_MAX && steps < CHAIN_MAX)
            ids[v] = other;
        else {
            if (other == UINT32_MAX)
                next[last] = v;
            ids[v] = v;
        }
    }
    for (uint32_t i = 0; good && i < p->index_count; i++)
        p->indices[i] = ids[p->indices[i]];
    mem_free(ids);
    mem_free(next);
    return good || out_of_memory(s);
}

static void convert(primitive *p)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        for (int k = 0; k < UV_SETS; k++)
            if (p->uvs[k])
                p->uvs[k][i].y = 1.0f - p->uvs[k][i].y;
        if (p->colours) {
            vec4 *c = &p->colours[i];
            *c = (vec4){colour_to_linear(unit(c->x)), colour_to_linear(unit(c->y)), colour_to_linear(unit(c->z)), c->w};
        }
    }
}

static bool check_indices(stream *s, const primitive *p)
{
    for (uint32_t i = 0; i < p->index_count; i++)
        if (p->indices[i] >= p->vertex_count)
            return broken(s);
    return true;
}

static void read_mesh_arrays(stream *s, primitive *p, uint32_t flags)
{
    size_t count = p->vertex_count;
    p->positions = take_array(s, count, sizeof *p->positions);
    if (flags & STREAM_NORMALS)
        p->normals = take_array(s, count, sizeof *p->normals);
    if (flags & STREAM_UV0)
        p->uvs[0] = take_array(s, count, sizeof *p->uvs[0]);
    if (flags & STREAM_UV1)
        p->uvs[1] = take_array(s, count, sizeof *p->uvs[1]);
    if (flags & STREAM_COLOURS)
        p->colours = take_array(s, count, sizeof *p->colours);
    p->indices = take_array(s, p->index_count, sizeof *p->indices);
}

static int32_t find_material(stream *s, uint32_t index, bool has_colours)
{
    if (s->status != LMN_OK || index >= s->material_count)
        return NONE;
    if (s->materials[index] == INVENTED) {
        int32_t made = build_plain_material(s->job->scene, has_colours);
        if (made == NONE)
            out_of_memory(s);
        s->materials[index] = made;
    }
    return s->materials[index];
}

static void read_mesh(stream *s, uint32_t index)
{
    primitive *p = &s->meshes[index];
    s->mesh_names[index] = take_text(s);
    uint32_t used_material = take_u32(s), flags = take_u32(s);
    p->vertex_count = take_u32(s);
    p->index_count = take_u32(s);
    uint32_t left_out = take_u32(s);
    p->material = find_material(s, used_material, (flags & STREAM_COLOURS) != 0);
    s->vertices += p->vertex_count;
    s->triangles += p->index_count / 3;
    if (s->status == LMN_OK && (s->vertices > 3 * LIMIT_VERTICES || s->triangles > LIMIT_TRIANGLES))
        s->status = error_in_file(s->error, LMN_LIMIT, s->job->path, 0, "more than %zu triangles", LIMIT_TRIANGLES);
    if (s->status == LMN_OK && p->index_count % 3 != 0)
        broken(s);
    if (s->status != LMN_OK)
        return;
    if (left_out)
        warnings_add(&s->job->scene->warnings, WARNING_IGNORED, "points and lines are not drawn");
    read_mesh_arrays(s, p, flags);
    if (s->status == LMN_OK && check_indices(s, p)) {
        convert(p);
        share_vertices(s, p);
    }
}

static void read_meshes(stream *s)
{
    uint32_t count = take_count(s, 24);
    s->meshes = mem_calloc(count, sizeof *s->meshes);
    s->mesh_names = mem_calloc(count, sizeof *s->mesh_names);
    s->uses = mem_calloc(count, sizeof *s->uses);
    if (!s->meshes || !s->mesh_names || !s->uses) {
        out_of_memory(s);
        return;
    }
    s->mesh_count = count;
    for (uint32_t i = 0; i < count && s->status == LMN_OK; i++)
        read_mesh(s, i);
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

static bool copy_primitive(primitive *out, const primitive *p)
{
    size_t n = p->vertex_count;
    *out = *p;
    out->positions = mem_copy(p->positions, n * sizeof *p->positions);
    out->indices = mem_copy(p->indices, p->index_count * sizeof *p->indices);
    bool good = out->positions && out->indices;
    out->normals = p->normals ? mem_copy(p->normals, n * sizeof *p->normals) : NULL;
    out->colours = p->colours ? mem_copy(p->colours, n * sizeof *p->colours) : NULL;
    good = good && (!p->normals || out->normals) && (!p->colours || out->colours);
    for (int i = 0; i < UV_SETS; i++) {
        out->uvs[i] = p->uvs[i] ? mem_copy(p->uvs[i], n * sizeof *p->uvs[i]) : NULL;
        good = good && (!p->uvs[i] || out->uvs[i]);
    }
    return good;
}

/* A scene's mesh of the child's meshes `list`; the last use of each takes it over, earlier ones copy. */
static int32_t make_mesh(stream *s, const uint32_t *list, uint32_t count)
{
    mesh      *m = scene_append_mesh(s->job->scene);
    primitive *primitives = mem_calloc(count, sizeof *primitives);
    if (!m || !primitives) {
        mem_free(primitives);
        out_of_memory(s);
        return NONE;
    }
    m->primitives = primitives;
    for (uint32_t i = 0; i < count; i++) {
        primitive *from = &s->meshes[list[i]];
        m->primitive_count++;
        if (--s->uses[list[i]] == 0) {
            primitives[i] = *from;
            memset(from, 0, sizeof *from);
        } else {
            s->vertices += from->vertex_count;
            if (s->vertices > 3 * LIMIT_VERTICES) {
                s->status =
                    error_in_file(s->error, LMN_LIMIT, s->job->path, 0, "more than %zu vertices", LIMIT_VERTICES);
                m->primitive_count--;
                return NONE;
            }
            if (!copy_primitive(&primitives[i], from)) {
                out_of_memory(s);
                return NONE;
            }
        }
    }
    const char *name = s->mesh_names[list[0]];
    m->name = mem_copy_text(name);
    if (name && !m->name)
        out_of_memory(s);
    return (int32_t)s->job->scene->mesh_count - 1;
}

/* One node's header and the list of its meshes. */
typedef struct node_record {
    uint32_t             parent, mesh_count;
    char                *name;
    const unsigned char *matrix, *meshes;
} node_record;

static bool take_node(stream *s, uint32_t index, node_record *out)
{
    out->parent = take_u32(s);
    out->name = take_text(s);
    out->matrix = take(s, 16 * sizeof(float));
    out->mesh_count = take_count(s, 4);
    out->meshes = take(s, (size_t)out->mesh_count * 4);
    if (s->status == LMN_OK && out->parent != UINT32_MAX && out->parent >= index)
        broken(s);
    for (uint32_t i = 0; s->status == LMN_OK && i < out->mesh_count; i++) {
        uint32_t mesh_index;
        memcpy(&mesh_index, out->meshes + 4 * i, 4);
        if (mesh_index >= s->mesh_count)
            broken(s);
    }
    return s->status == LMN_OK;
}

static void count_uses(stream *s, uint32_t count)
{
    for (uint32_t i = 0; i < count && s->status == LMN_OK; i++) {
        node_record n;
        if (take_node(s, i, &n))
            for (uint32_t k = 0; k < n.mesh_count; k++) {
                uint32_t mesh_index;
                memcpy(&mesh_index, n.meshes + 4 * k, 4);
                s->uses[mesh_index]++;
            }
        mem_free(n.name);
    }
}

static void read_node(stream *s, uint32_t index)
{
    node_record record;
    float       matrix[16];
    if (!take_node(s, index, &record)) {
        mem_free(record.name);
        return;
    }
    node *n = scene_append_node(s->job->scene);
    if (!n) {
        mem_free(record.name);
        out_of_memory(s);
        return;
    }
    n->name = record.name;
    mat4 place;
    memcpy(matrix, record.matrix, sizeof matrix);
    for (int i = 0; i < 16; i++)
        place.m[i] = (double)matrix[i];
    if (!node_set_matrix(n, &place))
        out_of_memory(s);
    /* assimp calls the root like the file or "ROOT"; the scene has its own node for that. */
    if (record.parent == UINT32_MAX) {
        mem_free(n->name);
        n->name = NULL;
    } else {
        scene_link_child(s->job->scene, (int32_t)record.parent, (int32_t)index);
    }
    uint32_t *list = record.mesh_count ? mem_copy(record.meshes, (size_t)record.mesh_count * 4) : NULL;
    if (record.mesh_count && !list)
        out_of_memory(s);
    if (list) {
        int32_t made = make_mesh(s, list, record.mesh_count);
        s->job->scene->nodes[index].mesh = made;
    }
    mem_free(list);
}

static void read_nodes(stream *s)
{
    uint32_t count = take_count(s, 4 + 4 + 64 + 4);
    if (s->status == LMN_OK && count > LIMIT_NODES)
        s->status = error_in_file(s->error, LMN_LIMIT, s->job->path, 0, "%u nodes, allowed are %zu", (unsigned)count,
                                  LIMIT_NODES);
    const unsigned char *first = s->at;
    count_uses(s, count);
    s->at = s->status == LMN_OK ? first : s->at;
    for (uint32_t i = 0; i < count && s->status == LMN_OK; i++)
        read_node(s, i);
}

/* --- the whole ------------------------------------------------------------------------------------------ */

static void read_error(stream *s)
{
    char *message = take_text(s);
    if (s->status == LMN_OK && message && strstr(message, "bad_alloc")) {
        s->status = error_in_file(s->error, LMN_LIMIT, s->job->path, 0,
                                  "reading the file takes more than %zu GiB of memory", LIMIT_IMPORT_MEMORY >> 30);
        error_hint(s->error, "its header promises too much, or the model must be simplified");
    } else if (s->status == LMN_OK) {
        s->status = error_in_file(s->error, LMN_FORMAT, s->job->path, 0, "%.300s",
                                  message ? message : "the file cannot be read");
        error_hint(s->error, "the file is damaged or of another format than its ending says");
    }
    mem_free(message);
}

lmn_status assimp_stream_read(const import_job *job, const unsigned char *bytes, size_t size, lmn_error *error)
{
    stream               s = {.job = job, .at = bytes, .end = bytes + size, .error = error};
    const unsigned char *kind = take(&s, 1);
    if (kind && *kind == STREAM_ERROR) {
        read_error(&s);
    } else if (kind && *kind == STREAM_MODEL) {
        if (take_u32(&s) > 0)
            warnings_add(&job->scene->warnings, WARNING_IGNORED, "animations of this format; use glTF for movement");
        read_materials(&s);
        if (s.status == LMN_OK)
            read_meshes(&s);
        if (s.status == LMN_OK)
            read_nodes(&s);
        const unsigned char *end = take(&s, 1);
        if (end && *end != STREAM_END)
            broken(&s);
    } else {
        broken(&s);
    }
    for (uint32_t i = 0; i < s.mesh_count; i++) {
        primitive_release(&s.meshes[i]);
        mem_free(s.mesh_names[i]);
    }
    mem_free(s.meshes);
    mem_free(s.mesh_names);
    mem_free(s.uses);
    mem_free(s.images);
    mem_free(s.materials);
    return s.status;
}
