/* glTF 2.0 and GLB: the container, versions and extensions; the content is read by its neighbours gltf_*.c. */
#define _GNU_SOURCE /* memmem */
#include "import/gltf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"
#include "import/draco.h"

enum { GLB_HEADER = 12, CHUNK_HEADER = 8, CHUNK_JSON = 0x4E4F534A, CHUNK_BIN = 0x004E4942 };

static uint32_t read_u32(const unsigned char *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static bool is_glb(const file_data *file)
{
    return file->size >= 4 && memcmp(file->data, "glTF", 4) == 0;
}

static bool recognises(const file_data *file)
{
    if (is_glb(file))
        return true;
    const unsigned char *p = file->data, *end = p + file->size;
    if (file->size >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0)
        p += 3;
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\n' || *p == '\r'))
        p++;
    return p < end && *p == '{' && memmem(p, (size_t)(end - p), "\"asset\"", 7) &&
           memmem(p, (size_t)(end - p), "\"version\"", 9);
}

/* --- container ------------------------------------------------------------------------------------------ */

static bool cut_off(gltf_reader *r, const char *what, size_t wanted, size_t have)
{
    gltf_fail(r, LMN_FORMAT, "the file is cut off: %s takes %zu bytes, there are %zu", what, wanted, have);
    error_hint(r->error, "copy or export the file again");
    return false;
}

/* Finds the JSON and binary chunks; unknown ones are skipped, as the format asks. */
static bool split_glb(gltf_reader *r, const unsigned char **json, size_t *json_size)
{
    const unsigned char *data = r->job->file->data;
    size_t               size = r->job->file->size;
    if (size < GLB_HEADER)
        return cut_off(r, "the GLB header", GLB_HEADER, size);
    if (read_u32(data + 4) != 2) {
        gltf_fail(r, LMN_UNSUPPORTED, "GLB version %u; limner reads version 2", (unsigned)read_u32(data + 4));
        error_hint(r->error, "convert the model to glTF 2.0");
        return false;
    }
    size_t length = read_u32(data + 8), at = GLB_HEADER;
    if (length > size)
        return cut_off(r, "the GLB", length, size);
    if (length < size)
        gltf_warn(r, WARNING_IGNORED, "%zu bytes behind the end of the GLB", size - length);
    for (int chunk = 0; at + CHUNK_HEADER <= length; chunk++) {
        size_t chunk_size = read_u32(data + at), type = read_u32(data + at + 4);
        at += CHUNK_HEADER;
        if (chunk_size > length - at)
            return cut_off(r, "a chunk of the GLB", chunk_size, length - at);
        if (chunk == 0 && type == CHUNK_JSON) {
            *json = data + at;
            *json_size = chunk_size;
        } else if (chunk == 1 && type == CHUNK_BIN) {
            r->chunk = data + at;
            r->chunk_size = chunk_size;
        }
        at += chunk_size;
    }
    if (!*json)
        gltf_fail(r, LMN_FORMAT, "the GLB's first chunk (byte 12) is not JSON");
    return *json != NULL;
}

/* What the parser makes of one value, bytes. It takes memory past base/memory.h. */
enum { VALUE_BYTES = 96 };

/* Nesting is checked before the parser recurses, and that what it makes will find room. */
static bool check_json(gltf_reader *r, const unsigned char *json, size_t size)
{
    int    depth = 0;
    size_t values = 0;
    bool   quoted = false;
    for (size_t i = 0; i < size; i++) {
        unsigned char c = json[i];
        values += !quoted && (c == ',' || c == '{' || c == '[' || c == ':');
        if (quoted) {
            i += c == '\\';
            quoted = c != '"';
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > LIMIT_JSON_DEPTH)
                return gltf_fail(r, LMN_LIMIT, "byte %zu: JSON nested deeper than %d", i, LIMIT_JSON_DEPTH), false;
        } else if (c == '}' || c == ']') {
            depth--;
        }
    }
    return work_has_memory(size + values * VALUE_BYTES) || gltf_out_of_memory(r);
}

/* A part of the text for the parser, which can be stopped in between. */
typedef struct json_text {
    const unsigned char *at, *end;
} json_text;

static size_t next_part(void *buffer, size_t size, void *user)
{
    json_text *t = user;
    size_t     left = (size_t)(t->end - t->at), some = left < size ? left : size;
    if (work_stopped())
        return (size_t)-1;
    memcpy(buffer, t->at, some);
    t->at += some;
    return some;
}

static bool parse(gltf_reader *r)
{
    const unsigned char *json = NULL;
    size_t               size = 0;
    if (is_glb(r->job->file)) {
        if (!split_glb(r, &json, &size))
            return false;
    } else {
        json = r->job->file->data;
        size = r->job->file->size;
    }
    if (size >= 3 && memcmp(json, "\xEF\xBB\xBF", 3) == 0) {
        json += 3;
        size -= 3;
    }
    /* GLB chunks are padded with blanks, by some writers with zeros. */
    while (size > 0 && json[size - 1] == '\0')
        size--;
    if (size > LIMIT_JSON_BYTES)
        return gltf_fail(r, LMN_LIMIT, "%zu bytes of JSON, allowed are %zu", size, LIMIT_JSON_BYTES), false;
    if (!check_json(r, json, size))
        return false;
    json_error_t problem;
    r->root = json_load_callback(next_part, &(json_text){json, json + size}, 0, &problem);
    if (!r->root) {
        bool memory = json_error_code(&problem) == json_error_out_of_memory;
        if (memory || work_stopped())
            return gltf_out_of_memory(r);
        gltf_fail(r, LMN_FORMAT, "JSON: %s", problem.text);
        if (r->error) {
            r->error->line = problem.line;
            r->error->column = problem.column;
        }
        return false;
    }
    if (!json_is_object(r->root))
        return gltf_fail(r, LMN_FORMAT, "JSON: the file's root is not an object"), false;
    return true;
}

/* --- version and extensions ----------------------------------------------------------------------------- */

/* Those whose absence would not change what is drawn, or that are read. */
static bool is_known(const char *name)
{
    static const char *const known[] = {"KHR_mesh_quantization",
                                        "EXT_meshopt_compression",
                                        "KHR_texture_transform",
                                        "KHR_lights_punctual",
                                        "EXT_mesh_gpu_instancing",
                                        "EXT_mesh_primitive_edge_visibility",
                                        "EXT_texture_webp",
                                        "KHR_node_visibility",
                                        "KHR_animation_pointer",
                                        "KHR_materials_unlit",
                                        "KHR_materials_emissive_strength",
                                        "KHR_materials_pbrSpecularGlossiness"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(name, known[i]) == 0)
            return true;
    return draco_is_built() && strcmp(name, "KHR_draco_mesh_compression") == 0;
}

/* Surface properties beyond colour: a drawing can do without. */
static bool is_harmless(const char *name)
{
    return strncmp(name, "KHR_materials_", 14) == 0 || strcmp(name, "KHR_xmp_json_ld") == 0 ||
           strcmp(name, "KHR_xmp") == 0;
}

static void check_extensions(gltf_reader *r)
{
    json_t *name;
    size_t  i;
    json_t *required = gltf_member(r, r->root, "extensionsRequired", JSON_ARRAY, "glTF");
    json_array_foreach(required, i, name)
    {
        const char *text = json_string_value(name);
        if (!text || is_known(text) || is_harmless(text))
            continue;
        gltf_fail(r, LMN_UNSUPPORTED, "the file requires the extension %.100s, which this build does not read", text);
        error_hint(r->error, "export the model without it");
        return;
    }
    json_t *used = gltf_member(r, r->root, "extensionsUsed", JSON_ARRAY, "glTF");
    json_array_foreach(used, i, name)
    {
        const char *text = json_string_value(name);
        if (text && !is_known(text))
            gltf_warn(r, WARNING_IGNORED, "glTF extension %.100s", text);
    }
}

static void check_version(gltf_reader *r)
{
    json_t     *asset = gltf_member(r, r->root, "asset", JSON_OBJECT, "glTF");
    const char *version = json_string_value(json_object_get(asset, "version"));
    if (!version) {
        gltf_fail(r, LMN_FORMAT, "asset.version is missing: this is not a glTF file, or not a whole one");
        return;
    }
    if (strncmp(version, "2.", 2) != 0) {
        gltf_fail(r, LMN_UNSUPPORTED, "asset.version: glTF %.20s; limner reads 2.x", version);
        error_hint(r->error, "convert the model to glTF 2.0");
    }
}

/* --- the whole ------------------------------------------------------------------------------------------ */

static int32_t *make_map(gltf_reader *r, const char *list, size_t *count)
{
    *count = gltf_count(r, list);
    int32_t *map = gltf_alloc(r, *count, sizeof *map);
    if (map)
        memset(map, 0xFF, *count * sizeof *map); /* all NONE */
    return map;
}

static void prepare(gltf_reader *r)
{
    r->buffer_count = gltf_count(r, "buffers");
    r->view_count = gltf_count(r, "bufferViews");
    r->buffers = gltf_alloc(r, r->buffer_count, sizeof *r->buffers);
    r->views = gltf_alloc(r, r->view_count, sizeof *r->views);
    r->mesh_map = make_map(r, "meshes", &r->mesh_count);
    r->node_map = make_map(r, "nodes", &r->node_count);
    r->image_map = make_map(r, "images", &r->image_count);
    if (r->node_count > LIMIT_NODES)
        gltf_fail(r, LMN_LIMIT, "%zu nodes, allowed are %zu", r->node_count, LIMIT_NODES);
}

/* When nothing can be drawn because a file is missing, that file is to blame. A valid file in which no drawn node
 * has a mesh, or whose only data is not there to be found (a buffer without a uri), is an empty scene. */
static void check_content(gltf_reader *r)
{
    for (size_t i = 0; i < r->scene->mesh_count; i++)
        if (mesh_triangle_count(&r->scene->meshes[i]) + mesh_line_count(&r->scene->meshes[i]) > 0)
            return;
    r->scene->may_be_empty = r->scene->mesh_count == 0 || r->nameless_buffer;
    if (!r->missing_buffer)
        return;
    gltf_fail(r, LMN_READ, "nothing to draw: the buffer \"%s\" cannot be read", r->missing_buffer);
    error_hint(r->error, "put the .bin file beside the .gltf, or export as .glb");
}

static lmn_status read_gltf(const import_job *job, lmn_error *error)
{
    static void (*const steps[])(gltf_reader *) = {
        check_version,    check_extensions, prepare,         gltf_read_materials,  gltf_read_cameras,
        gltf_read_lights, gltf_read_nodes,  gltf_read_skins, gltf_read_animations, check_content};
    gltf_reader r = {.job = job, .scene = job->scene, .error = error};
    bool        parsed = parse(&r);
    for (size_t i = 0; parsed && r.status == LMN_OK && i < sizeof steps / sizeof *steps; i++)
        steps[i](&r);
    gltf_release_buffers(&r);
    mem_free(r.mesh_map);
    mem_free(r.node_map);
    mem_free(r.image_map);
    json_decref(r.root);
    return r.status;
}

const import_format import_gltf = {"glTF", ".gltf .glb", 'y', false, recognises, read_gltf};
