/* Meshes: attributes, indices, strips and fans, lines, morphs, Draco. */
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/draco.h"
#include "import/gltf.h"

enum { JOINT_SETS_MAX = 16 };
enum { MODE_POINTS, MODE_LINES, MODE_LINE_LOOP, MODE_LINE_STRIP, MODE_TRIANGLES, MODE_STRIP, MODE_FAN };

/* One primitive on its way. */
typedef struct shape {
    char         where[GLTF_WHERE];
    json_t      *object, *attributes;
    draco_model *draco;
    json_t      *draco_ids;
    primitive    p;
    bool         missing; /* its data is not there: left out */
} shape;

static size_t accessor_total(gltf_reader *r)
{
    return gltf_count(r, "accessors");
}

/* Values of one attribute, `components` floats a vertex; NULL when the primitive does not have it (or after an
 * error). */
static float *read_attribute(gltf_reader *r, shape *s, const char *name, int components)
{
    size_t        index;
    gltf_accessor a;
    char          where[GLTF_WHERE + 32];
    if (r->status != LMN_OK || s->missing ||
        !gltf_index(r, s->attributes, name, accessor_total(r), "accessors", s->where, &index))
        return NULL;
    snprintf(where, sizeof where, "%s.%s", s->where, name);
    json_t *id = json_object_get(s->draco_ids, name);
    if (s->draco && json_is_integer(id)) {
        json_t *object = gltf_item(r, "accessors", index);
        float  *values = gltf_alloc(r, s->p.vertex_count, (size_t)components * sizeof *values);
        if (values && !draco_read_attribute(s->draco, (uint32_t)json_integer_value(id), components,
                                            gltf_true(object, "normalized"), values)) {
            gltf_fail(r, LMN_FORMAT, "%s: the Draco data has no such attribute", where);
            mem_free(values);
            return NULL;
        }
        return values;
    }
    if (!gltf_open_accessor(r, index, where, &a)) {
        s->missing = true;
        return NULL;
    }
    if (a.count != s->p.vertex_count) {
        gltf_fail(r, LMN_FORMAT, "%s: %zu values for %u vertices", where, a.count, (unsigned)s->p.vertex_count);
        return NULL;
    }
    return gltf_read_floats(r, &a, components, where);
}

/* How many vertices, checked against the limits before anything is allocated. */
static bool count_vertices(gltf_reader *r, shape *s)
{
    size_t        index, count;
    gltf_accessor a;
    if (!gltf_index(r, s->attributes, "POSITION", accessor_total(r), "accessors", s->where, &index)) {
        if (r->status == LMN_OK)
            gltf_warn(r, WARNING_BAD_GEOMETRY, "%s has no positions and was left out", s->where);
        return false;
    }
    if (s->draco) {
        count = draco_vertex_count(s->draco);
    } else {
        if (!gltf_open_accessor(r, index, s->where, &a))
            return false;
        count = a.count;
    }
    r->vertices += count;
    if (r->vertices > LIMIT_VERTICES)
        return gltf_fail(r, LMN_LIMIT, "%s: more than %zu vertices in all", s->where, LIMIT_VERTICES), false;
    s->p.vertex_count = (uint32_t)count;
    return count > 0;
}

/* Four joints of each vertex, with their weights, into places `at` … `at` + 3 of its influences. */
static bool read_joint_set(gltf_reader *r, shape *s, int set)
{
    char name[2][16];
    snprintf(name[0], sizeof name[0], "JOINTS_%d", set);
    snprintf(name[1], sizeof name[1], "WEIGHTS_%d", set);
    float *joints = read_attribute(r, s, name[0], 4), *weights = read_attribute(r, s, name[1], 4);
    size_t count = joints && weights ? s->p.vertex_count : 0;
    for (size_t i = 0; i < 4 * count; i++) {
        size_t to = (i / 4) * s->p.influences + 4 * (size_t)set + i % 4;
        s->p.weights[to] = weights[i];
        /* Joints without weight may hold anything. */
        if (weights[i] != 0 && joints[i] >= 0 && joints[i] < 65536.0f)
            s->p.joints[to] = (uint16_t)joints[i];
    }
    mem_free(joints);
    mem_free(weights);
    return count > 0;
}

static bool has_joint_set(const shape *s, int set)
{
    char name[2][16];
    snprintf(name[0], sizeof name[0], "JOINTS_%d", set);
    snprintf(name[1], sizeof name[1], "WEIGHTS_%d", set);
    return json_object_get(s->attributes, name[0]) && json_object_get(s->attributes, name[1]);
}

/* A vertex may follow any number of joints, four an attribute. */
static void read_joints(gltf_reader *r, shape *s)
{
    int sets = 0;
    while (sets < JOINT_SETS_MAX && has_joint_set(s, sets))
        sets++;
    if (sets == 0)
        return;
    s->p.influences = 4 * (uint32_t)sets;
    s->p.joints = gltf_alloc(r, (size_t)s->p.vertex_count * s->p.influences, sizeof *s->p.joints);
    s->p.weights = gltf_alloc(r, (size_t)s->p.vertex_count * s->p.influences, sizeof *s->p.weights);
    bool good = s->p.joints && s->p.weights;
    for (int set = 0; set < sets && good; set++)
        good = read_joint_set(r, s, set);
    if (!good) {
        mem_free(s->p.joints);
        mem_free(s->p.weights);
        s->p.joints = NULL;
        s->p.weights = NULL;
        s->p.influences = 0;
    }
}

/* Lines have no surface that these could say something of. */
static void read_shading(gltf_reader *r, shape *s)
{
    s->p.normals = (vec3 *)read_attribute(r, s, "NORMAL", 3);
    s->p.uvs[0] = (vec2 *)read_attribute(r, s, "TEXCOORD_0", 2);
    s->p.uvs[1] = (vec2 *)read_attribute(r, s, "TEXCOORD_1", 2);
    s->p.colours = (vec4 *)read_attribute(r, s, "COLOR_0", 4);
    if (json_object_get(s->attributes, "TEXCOORD_2"))
        gltf_warn(r, WARNING_IGNORED, "texture coordinate sets beyond the second");
}

static void read_attributes(gltf_reader *r, shape *s, bool lines)
{
    s->p.positions = (vec3 *)read_attribute(r, s, "POSITION", 3);
    if (!lines)
        read_shading(r, s);
    read_joints(r, s);
}

/* --- indices -------------------------------------------------------------------------------------------- */

/* The corners as the file lists them; without indices, all vertices in order. */
static uint32_t *read_corners(gltf_reader *r, shape *s, size_t *count)
{
    size_t        index;
    gltf_accessor a;
    char          where[GLTF_WHERE + 32];
    snprintf(where, sizeof where, "%s.indices", s->where);
    if (s->draco) {
        *count = draco_triangle_count(s->draco) * 3;
        uint32_t *corners = gltf_alloc(r, *count, sizeof *corners);
        if (corners)
            draco_read_indices(s->draco, corners);
        return corners;
    }
    if (!gltf_index(r, s->object, "indices", accessor_total(r), "accessors", s->where, &index)) {
        *count = s->p.vertex_count;
        uint32_t *corners = gltf_alloc(r, *count, sizeof *corners);
        for (size_t i = 0; corners && i < *count; i++)
            corners[i] = (uint32_t)i;
        return corners;
    }
    if (!gltf_open_accessor(r, index, where, &a)) {
        s->missing = true;
        return NULL;
    }
    *count = a.count;
    return gltf_read_integers(r, &a, 1, where);
}

static bool check_corners(gltf_reader *r, const shape *s, const uint32_t *corners, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (corners[i] >= s->p.vertex_count)
            return gltf_fail(r, LMN_FORMAT, "%s.indices[%zu] is %u, but there are only %u vertices", s->where, i,
                             (unsigned)corners[i], (unsigned)s->p.vertex_count),
                   false;
    return true;
}

/* Strips turn every second triangle; fans share the first corner. */
static uint32_t *unroll(gltf_reader *r, const uint32_t *corners, size_t triangles, int mode)
{
    uint32_t *out = gltf_alloc(r, triangles * 3, sizeof *out);
    for (size_t i = 0; out && i < triangles; i++) {
        bool odd = i & 1;
        out[3 * i] = mode == MODE_FAN ? corners[0] : corners[odd ? i + 1 : i];
        out[3 * i + 1] = mode == MODE_FAN ? corners[i + 1] : corners[odd ? i : i + 1];
        out[3 * i + 2] = corners[i + 2];
    }
    return out;
}

static void read_triangles(gltf_reader *r, shape *s, int mode)
{
    size_t    count = 0;
    uint32_t *corners = read_corners(r, s, &count);
    size_t    triangles = mode == MODE_TRIANGLES ? count / 3 : count < 3 ? 0 : count - 2;
    r->triangles += triangles;
    if (corners && r->triangles > LIMIT_TRIANGLES)
        gltf_fail(r, LMN_LIMIT, "%s: more than %zu triangles in all", s->where, LIMIT_TRIANGLES);
    if (corners && mode == MODE_TRIANGLES && count % 3 != 0)
        gltf_warn(r, WARNING_BAD_GEOMETRY, "%s: %zu corners are left over", s->where, count % 3);
    if (!corners || r->status != LMN_OK || !check_corners(r, s, corners, count)) {
        mem_free(corners);
        return;
    }
    s->p.index_count = (uint32_t)(triangles * 3);
    if (mode == MODE_TRIANGLES || triangles == 0) {
        s->p.indices = corners;
        return;
    }
    s->p.indices = unroll(r, corners, triangles, mode);
    mem_free(corners);
}

/* Loops come back to where they begin. */
static uint32_t *unroll_lines(gltf_reader *r, const uint32_t *corners, size_t count, size_t lines)
{
    uint32_t *out = gltf_alloc(r, lines * 2, sizeof *out);
    for (size_t i = 0; out && i < lines; i++) {
        out[2 * i] = corners[i];
        out[2 * i + 1] = corners[i + 1 < count ? i + 1 : 0];
    }
    return out;
}

/* Draco has no lines: its extension is for triangles alone. */
static void read_lines(gltf_reader *r, shape *s, int mode)
{
    size_t    count = 0;
    uint32_t *corners = read_corners(r, s, &count);
    size_t    lines = mode == MODE_LINES ? count / 2 : count < 2 ? 0 : mode == MODE_LINE_LOOP ? count : count - 1;
    r->lines += lines;
    if (corners && r->lines > LIMIT_LINES)
        gltf_fail(r, LMN_LIMIT, "%s: more than %zu lines in all", s->where, LIMIT_LINES);
    if (corners && mode == MODE_LINES && count % 2 != 0)
        gltf_warn(r, WARNING_BAD_GEOMETRY, "%s: 1 corner is left over", s->where);
    if (!corners || r->status != LMN_OK || !check_corners(r, s, corners, count)) {
        mem_free(corners);
        return;
    }
    s->p.line_count = (uint32_t)lines;
    if (mode == MODE_LINES || lines == 0) {
        s->p.lines = corners;
        return;
    }
    s->p.lines = unroll_lines(r, corners, count, lines);
    mem_free(corners);
}

/* EXT_mesh_primitive_edge_visibility packs four edges of two bits into a byte. */
static void read_edges(gltf_reader *r, shape *s, int mode)
{
    size_t        index;
    gltf_accessor a;
    json_t       *extension = gltf_extension(s->object, "EXT_mesh_primitive_edge_visibility");
    if (!extension || mode != MODE_TRIANGLES ||
        !gltf_index(r, extension, "visibility", accessor_total(r), "accessors", s->where, &index) ||
        !gltf_open_accessor(r, index, s->where, &a))
        return;
    if (a.count < ((size_t)s->p.index_count + 3) / 4) {
        gltf_warn(r, WARNING_BAD_VALUE, "%s: too few edge visibility values", s->where);
        return;
    }
    uint32_t *packed = gltf_read_integers(r, &a, 1, s->where);
    s->p.edges.values = packed ? gltf_alloc(r, s->p.index_count, 1) : NULL;
    for (size_t i = 0; s->p.edges.values && i < s->p.index_count; i++)
        s->p.edges.values[i] = (uint8_t)(packed[i / 4] >> (i % 4 * 2) & 3);
    mem_free(packed);
}

/* --- morphs --------------------------------------------------------------------------------------------- */

static void read_morphs(gltf_reader *r, shape *s, bool lines)
{
    json_t *targets = gltf_member(r, s->object, "targets", JSON_ARRAY, s->where);
    size_t  count = json_array_size(targets);
    if (count == 0 || r->status != LMN_OK)
        return;
    s->p.morphs = gltf_alloc(r, count, sizeof *s->p.morphs);
    if (!s->p.morphs)
        return;
    s->p.morph_count = count;
    shape target = {.p = {.vertex_count = s->p.vertex_count}, .draco_ids = NULL};
    for (size_t i = 0; i < count && r->status == LMN_OK; i++) {
        snprintf(target.where, sizeof target.where, "%.100s.targets[%zu]", s->where, i);
        target.attributes = json_array_get(targets, i);
        s->p.morphs[i].positions = (vec3 *)read_attribute(r, &target, "POSITION", 3);
        s->p.morphs[i].normals = lines ? NULL : (vec3 *)read_attribute(r, &target, "NORMAL", 3);
    }
}

/* --- the whole ------------------------------------------------------------------------------------------ */

/* A build without Draco can still use the plain data that a file may offer beside it. */
static void check_plain(gltf_reader *r, shape *s)
{
    size_t index;
    if (gltf_index(r, s->attributes, "POSITION", accessor_total(r), "accessors", s->where, &index) &&
        !json_object_get(gltf_item(r, "accessors", index), "bufferView"))
        gltf_fail(r, LMN_UNSUPPORTED,
                  "%s needs the extension KHR_draco_mesh_compression, which this build does not read", s->where);
}

static void open_draco(gltf_reader *r, shape *s)
{
    size_t  view_index;
    json_t *extension = gltf_extension(s->object, "KHR_draco_mesh_compression");
    if (extension && !draco_is_built())
        check_plain(r, s);
    if (!extension || !draco_is_built())
        return;
    if (!gltf_index(r, extension, "bufferView", r->view_count, "bufferViews", s->where, &view_index)) {
        gltf_fail(r, LMN_FORMAT, "%s.KHR_draco_mesh_compression: no bufferView", s->where);
        return;
    }
    const gltf_view *v = gltf_get_view(r, view_index, s->where);
    s->missing = !v;
    if (!v)
        return;
    s->draco_ids = json_object_get(extension, "attributes");
    lmn_error  problem = {0};
    lmn_status status = draco_open(&s->draco, v->data, v->size, &problem);
    if (status != LMN_OK) {
        gltf_fail(r, status, "%s: %s", s->where, problem.message);
        error_hint(r->error, "%s", problem.hint);
    }
}

static bool is_drawn(gltf_reader *r, size_t mode, const char *where)
{
    if (mode > MODE_POINTS && mode <= MODE_FAN)
        return true;
    if (mode > MODE_FAN)
        gltf_fail(r, LMN_FORMAT, "%s.mode: %zu is none of 0 to 6", where, mode);
    else
        gltf_warn(r, WARNING_IGNORED, "primitives of points are not drawn");
    return false;
}

static void fill_shape(gltf_reader *r, shape *s)
{
    size_t mode, index;
    gltf_size(r, s->object, "mode", MODE_TRIANGLES, s->where, &mode);
    if (r->status != LMN_OK || !is_drawn(r, mode, s->where))
        return;
    s->attributes = gltf_member(r, s->object, "attributes", JSON_OBJECT, s->where);
    s->p.material = NONE;
    if (gltf_index(r, s->object, "material", gltf_count(r, "materials"), "materials", s->where, &index))
        s->p.material = (int32_t)index;
    bool lines = mode < MODE_TRIANGLES;
    if (!lines)
        open_draco(r, s);
    if (r->status != LMN_OK || s->missing || !count_vertices(r, s))
        return;
    read_attributes(r, s, lines);
    read_morphs(r, s, lines);
    if (r->status == LMN_OK && !s->missing && lines)
        read_lines(r, s, (int)mode);
    else if (r->status == LMN_OK && !s->missing)
        read_triangles(r, s, (int)mode);
    if (r->status == LMN_OK && !s->missing)
        read_edges(r, s, (int)mode);
}

/* False when there is nothing to draw in it; then nothing is left to release. */
static bool read_primitive(gltf_reader *r, json_t *object, size_t mesh_index, size_t index, primitive *out)
{
    shape s = {.object = object};
    snprintf(s.where, sizeof s.where, "meshes[%zu].primitives[%zu]", mesh_index, index);
    if (!json_is_object(object))
        gltf_fail(r, LMN_FORMAT, "%s: expected an object", s.where);
    else
        fill_shape(r, &s);
    draco_close(s.draco);
    bool good = r->status == LMN_OK && !s.missing && s.p.positions && (s.p.indices || s.p.lines);
    if (!good) {
        primitive_release(&s.p);
        return false;
    }
    *out = s.p;
    return true;
}

/* Default weights, one for each morph of the first primitive that has any. */
static void read_weights(gltf_reader *r, json_t *object, mesh *m)
{
    size_t count = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        if (m->primitives[i].morph_count > count)
            count = m->primitives[i].morph_count;
    if (count == 0)
        return;
    m->morph_weights = gltf_alloc(r, count, sizeof *m->morph_weights);
    m->morph_weight_count = m->morph_weights ? count : 0;
    json_t *weights = json_object_get(object, "weights");
    for (size_t i = 0; i < m->morph_weight_count; i++)
        m->morph_weights[i] = (float)json_number_value(json_array_get(weights, i));
}

static void fill_mesh(gltf_reader *r, json_t *object, size_t index, mesh *m)
{
    char where[GLTF_WHERE];
    snprintf(where, sizeof where, "meshes[%zu]", index);
    m->name = gltf_name(r, object);
    json_t *list = gltf_member(r, object, "primitives", JSON_ARRAY, where);
    size_t  count = json_array_size(list);
    m->primitives = gltf_alloc(r, count, sizeof *m->primitives);
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        if (read_primitive(r, json_array_get(list, i), index, i, &m->primitives[m->primitive_count]))
            m->primitive_count++;
    if (r->status == LMN_OK)
        read_weights(r, object, m);
}

int32_t gltf_get_mesh(gltf_reader *r, size_t index)
{
    json_t *object = gltf_item(r, "meshes", index);
    if (!object || r->mesh_map[index] != NONE)
        return object ? r->mesh_map[index] : NONE;
    mesh *m = scene_append_mesh(r->scene);
    if (!m) {
        gltf_out_of_memory(r);
        return NONE;
    }
    r->mesh_map[index] = (int32_t)r->scene->mesh_count - 1;
    fill_mesh(r, object, index, m);
    if (r->status == LMN_OK)
        r->status = import_progress(r->job, 0.8 * (double)r->scene->mesh_count / (double)(r->mesh_count + 1), "reading",
                                    r->error);
    return r->mesh_map[index];
}
