/* Accessors: typed numbers in views, with sparse replacements, converted to what the scene holds. */
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/gltf.h"

enum { TYPE_BYTE = 5120, TYPE_UBYTE, TYPE_SHORT, TYPE_USHORT, TYPE_UINT = 5125, TYPE_FLOAT };

static size_t type_size(int type)
{
    switch (type) {
    case TYPE_BYTE:
    case TYPE_UBYTE: return 1;
    case TYPE_SHORT:
    case TYPE_USHORT: return 2;
    case TYPE_UINT:
    case TYPE_FLOAT: return 4;
    default: return 0;
    }
}

static int component_count(const char *name)
{
    static const struct {
        const char *name;
        int         count;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (size_t i = 0; name && i < sizeof types / sizeof *types; i++)
        if (strcmp(name, types[i].name) == 0)
            return types[i].count;
    return 0;
}

/* Does the view hold `count` elements of `element` bytes at `offset`? */
static bool fits(const gltf_view *v, size_t offset, size_t count, size_t stride, size_t element)
{
    size_t span, end;
    if (count == 0)
        return true;
    return size_mul(count - 1, stride, &span) && size_add(span, offset, &end) && size_add(end, element, &end) &&
           end <= v->size;
}

static bool locate(gltf_reader *r, json_t *object, const char *where, gltf_accessor *a)
{
    size_t view_index, offset, element = type_size(a->type) * (size_t)a->components;
    a->stride = element;
    if (!json_object_get(object, "bufferView"))
        return r->status == LMN_OK;
    if (!gltf_index(r, object, "bufferView", r->view_count, "bufferViews", where, &view_index) ||
        !gltf_size(r, object, "byteOffset", 0, where, &offset))
        return false;
    const gltf_view *v = gltf_get_view(r, view_index, where);
    if (!v)
        return false;
    if (v->stride)
        a->stride = v->stride;
    if (!fits(v, offset, a->count, a->stride, element)) {
        gltf_fail(r, LMN_FORMAT,
                  "%s: %zu elements of %zu bytes from byte %zu do not fit bufferViews[%zu], which has %zu", where,
                  a->count, element, offset, view_index, v->size);
        return false;
    }
    a->data = v->data + offset;
    return true;
}

bool gltf_open_accessor(gltf_reader *r, size_t index, const char *where, gltf_accessor *out)
{
    char   here[GLTF_WHERE];
    size_t type;
    memset(out, 0, sizeof *out);
    if (r->status != LMN_OK)
        return false;
    if (index >= gltf_count(r, "accessors")) {
        gltf_fail(r, LMN_FORMAT, "%s: accessors[%zu] does not exist, the file has %zu", where, index,
                  gltf_count(r, "accessors"));
        return false;
    }
    json_t *object = gltf_item(r, "accessors", index);
    if (!object)
        return false;
    snprintf(here, sizeof here, "accessors[%zu]", index);
    gltf_size(r, object, "count", 0, here, &out->count);
    gltf_size(r, object, "componentType", 0, here, &type);
    if (r->status != LMN_OK)
        return false;
    out->type = type < 65536 ? (int)type : 0;
    out->components = component_count(json_string_value(json_object_get(object, "type")));
    out->normalized = gltf_true(object, "normalized");
    out->sparse = gltf_member(r, object, "sparse", JSON_OBJECT, here);
    if (type_size(out->type) == 0 || out->components == 0)
        return gltf_fail(r, LMN_FORMAT, "%s: unknown type or componentType", here), false;
    if (out->count > LIMIT_VERTICES)
        return gltf_fail(r, LMN_LIMIT, "%s: %zu elements, allowed are %zu", here, out->count, LIMIT_VERTICES), false;
    return locate(r, object, here, out);
}

static float one_float(const unsigned char *p, int type, bool normalized)
{
    float value;
    switch (type) {
    case TYPE_BYTE: {
        int8_t v = (int8_t)*p;
        return !normalized ? (float)v : v < -127 ? -1.0f : (float)v / 127.0f;
    }
    case TYPE_UBYTE: return normalized ? (float)*p / 255.0f : (float)*p;
    case TYPE_SHORT: {
        int16_t v = (int16_t)(p[0] | p[1] << 8);
        return !normalized ? (float)v : v < -32767 ? -1.0f : (float)v / 32767.0f;
    }
    case TYPE_USHORT: {
        uint16_t v = (uint16_t)(p[0] | p[1] << 8);
        return normalized ? (float)v / 65535.0f : (float)v;
    }
    case TYPE_UINT: {
        uint32_t v = p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
        return normalized ? (float)((double)v / 4294967295.0) : (float)v;
    }
    default: memcpy(&value, p, sizeof value); return value;
    }
}

static uint32_t one_integer(const unsigned char *p, int type)
{
    switch (type) {
    case TYPE_BYTE:
    case TYPE_UBYTE: return *p;
    case TYPE_SHORT:
    case TYPE_USHORT: return p[0] | (uint32_t)p[1] << 8;
    case TYPE_UINT: return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    default: {
        float value;
        memcpy(&value, p, sizeof value);
        return value >= 0 && value < 4294967040.0f ? (uint32_t)value : UINT32_MAX;
    }
    }
}

typedef struct sparse_part {
    const unsigned char *data;
    size_t               stride;
    int                  type;
} sparse_part;

static bool open_sparse(gltf_reader *r, json_t *sparse, const char *key, size_t count, size_t element,
                        const char *where, sparse_part *out)
{
    size_t  view_index, offset;
    json_t *object = gltf_member(r, sparse, key, JSON_OBJECT, where);
    if (!object || !gltf_index(r, object, "bufferView", r->view_count, "bufferViews", where, &view_index)) {
        gltf_fail(r, LMN_FORMAT, "%s.sparse.%s: no bufferView", where, key);
        return false;
    }
    gltf_size(r, object, "byteOffset", 0, where, &offset);
    const gltf_view *v = gltf_get_view(r, view_index, where);
    if (!v)
        return false;
    if (!fits(v, offset, count, element, element)) {
        gltf_fail(r, LMN_FORMAT, "%s.sparse.%s: %zu elements do not fit bufferViews[%zu]", where, key, count,
                  view_index);
        return false;
    }
    out->data = v->data + offset;
    out->stride = element;
    return true;
}

/* Calls back for each replaced element. */
typedef void (*store_fn)(void *out, size_t index, const unsigned char *value, const gltf_accessor *a, int components);

static bool apply_sparse(gltf_reader *r, const gltf_accessor *a, int components, const char *where, void *out,
                         store_fn store)
{
    size_t count, type;
    if (!a->sparse)
        return true;
    gltf_size(r, a->sparse, "count", 0, where, &count);
    gltf_size(r, json_object_get(a->sparse, "indices"), "componentType", 0, where, &type);
    size_t index_size = type == TYPE_UBYTE ? 1 : type == TYPE_USHORT ? 2 : type == TYPE_UINT ? 4 : 0;
    if (r->status != LMN_OK || index_size == 0 || count > a->count)
        return gltf_fail(r, LMN_FORMAT, "%s.sparse: wrong count or index type", where), false;
    sparse_part indices, values;
    size_t      element = type_size(a->type) * (size_t)a->components;
    if (!open_sparse(r, a->sparse, "indices", count, index_size, where, &indices) ||
        !open_sparse(r, a->sparse, "values", count, element, where, &values))
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t index = one_integer(indices.data + i * index_size, (int)type);
        if (index >= a->count)
            return gltf_fail(r, LMN_FORMAT, "%s.sparse.indices: %u is out of range", where, (unsigned)index), false;
        store(out, index, values.data + i * element, a, components);
    }
    return true;
}

static void store_floats(void *out, size_t index, const unsigned char *value, const gltf_accessor *a, int components)
{
    float *to = (float *)out + index * (size_t)components;
    size_t size = type_size(a->type);
    for (int k = 0; k < components; k++)
        to[k] = k < a->components ? one_float(value + (size_t)k * size, a->type, a->normalized) : k == 3 ? 1.0f : 0.0f;
}

static void store_integers(void *out, size_t index, const unsigned char *value, const gltf_accessor *a, int components)
{
    uint32_t *to = (uint32_t *)out + index * (size_t)components;
    size_t    size = type_size(a->type);
    for (int k = 0; k < components; k++)
        to[k] = k < a->components ? one_integer(value + (size_t)k * size, a->type) : 0;
}

/* Room for the elements, after they were counted against the limit: one accessor may be used many times. */
static void *make_room(gltf_reader *r, const gltf_accessor *a, int components, const char *where)
{
    r->elements += a->count;
    /* Accessors without a view are zeros: they promise much and cost the file nothing. */
    if (!a->data)
        r->zeros += a->count;
    if (r->zeros > LIMIT_ZERO_ELEMENTS) {
        gltf_fail(r, LMN_LIMIT, "%s: more than %zu elements without data in all", where, LIMIT_ZERO_ELEMENTS);
        return NULL;
    }
    if (r->elements > LIMIT_ELEMENTS) {
        gltf_fail(r, LMN_LIMIT, "%s: more than %zu elements in all", where, LIMIT_ELEMENTS);
        return NULL;
    }
    return gltf_alloc(r, a->count, (size_t)components * 4);
}

static void *read_all(gltf_reader *r, const gltf_accessor *a, int components, const char *where, store_fn store)
{
    void *out = make_room(r, a, components, where);
    if (!out)
        return NULL;
    bool packed = store == store_floats && a->type == TYPE_FLOAT && a->components == components &&
                  a->stride == (size_t)components * 4;
    if (a->data && packed && a->count)
        memcpy(out, a->data, a->count * a->stride);
    else
        for (size_t i = 0; a->data && i < a->count; i++)
            store(out, i, a->data + i * a->stride, a, components);
    if (!apply_sparse(r, a, components, where, out, store)) {
        mem_free(out);
        return NULL;
    }
    return out;
}

float *gltf_read_floats(gltf_reader *r, const gltf_accessor *a, int components, const char *where)
{
    return read_all(r, a, components, where, store_floats);
}

uint32_t *gltf_read_integers(gltf_reader *r, const gltf_accessor *a, int components, const char *where)
{
    return read_all(r, a, components, where, store_integers);
}
