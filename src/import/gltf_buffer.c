/* Buffers and views: the GLB's chunk, files, data URIs, and views compressed with meshopt. */
#include <stdio.h>
#include <string.h>

#include <meshoptimizer.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "fence/fence.h"
#include "import/access.h"
#include "import/gltf.h"

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c |= 0x20;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Decodes %XX in place of itself; returns the size. A NUL byte inside a name would hide its rest and is kept
 * encoded. */
static size_t decode_percent(const char *from, char *to)
{
    size_t size = 0;
    for (; *from; from++) {
        int high = from[0] == '%' ? hex_digit(from[1]) : -1, low = high >= 0 ? hex_digit(from[2]) : -1;
        if (low >= 0 && high * 16 + low != 0) {
            to[size++] = (char)(high * 16 + low);
            from += 2;
        } else {
            to[size++] = *from;
        }
    }
    to[size] = '\0';
    return size;
}

static int base64_digit(char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

static bool decode_base64(const char *from, unsigned char *to, size_t *size)
{
    uint32_t bits = 0;
    int      have = 0;
    *size = 0;
    for (; *from && *from != '='; from++) {
        int digit = base64_digit(*from);
        if (digit < 0)
            return false;
        bits = bits << 6 | (uint32_t)digit;
        have += 6;
        if (have >= 8) {
            have -= 8;
            to[(*size)++] = (unsigned char)(bits >> have);
        }
    }
    while (*from == '=')
        from++;
    return *from == '\0';
}

static bool load_data_uri(gltf_reader *r, const char *uri, const char *kind, unsigned char **owned, file_data *file)
{
    const char *comma = strchr(uri, ',');
    bool        base64 = comma && comma - uri >= 7 && memcmp(comma - 7, ";base64", 7) == 0;
    if (!comma)
        return gltf_fail(r, LMN_FORMAT, "%s: a data URI without a comma", kind), false;
    *owned = gltf_alloc(r, strlen(comma) + 1, 1);
    if (!*owned)
        return false;
    size_t size = 0;
    if (!base64)
        size = decode_percent(comma + 1, (char *)*owned);
    else if (!decode_base64(comma + 1, *owned, &size))
        return gltf_fail(r, LMN_FORMAT, "%s: a data URI with wrong base64", kind), false;
    file->data = *owned;
    file->size = size;
    return true;
}

static bool has_scheme(const char *uri)
{
    const char *colon = strstr(uri, "://");
    return colon && colon - uri < 16;
}

bool gltf_load_uri(gltf_reader *r, const char *uri, const char *kind, unsigned char **owned, file_data *file,
                   char **name)
{
    memset(file, 0, sizeof *file);
    *owned = NULL;
    *name = NULL;
    if (strncmp(uri, "data:", 5) == 0)
        return load_data_uri(r, uri, kind, owned, file);
    char *decoded = gltf_alloc(r, strlen(uri) + 1, 1);
    if (!decoded)
        return false;
    decode_percent(uri, decoded);
    *name = scene_clean_name(decoded, strlen(decoded));
    char *path = file_beside(r->job->path, decoded);
    mem_free(decoded);
    lmn_error  problem = {.message = "limner does not fetch from the network"};
    bool       refused = false;
    bool       good = *name && path;
    lmn_status status = LMN_READ;
    if (good && !has_scheme(uri))
        status = access_read(r->job, kind, path, file, &refused, &problem);
    mem_free(path);
    if (!good || status == LMN_MEMORY)
        return gltf_out_of_memory(r);
    /* Without a texture a model is still a model; without a buffer it is not. */
    if (refused && strcmp(kind, "buffer") == 0) {
        gltf_fail(r, LMN_READ, "%s", problem.message);
        error_hint(r->error, "%s", problem.hint);
        return false;
    }
    if (refused) {
        gltf_warn(r, WARNING_REFUSED_FILE, "%s; %s", problem.message, problem.hint);
        return false;
    }
    if (status == LMN_LIMIT)
        return gltf_fail(r, LMN_LIMIT, "%s \"%s\": %s", kind, *name, problem.message), false;
    if (status != LMN_OK)
        gltf_warn(r, WARNING_MISSING_FILE, "%s \"%s\": %s", kind, *name, problem.message);
    return status == LMN_OK;
}

static void find_buffer(gltf_reader *r, size_t index, json_t *object, gltf_buffer *b)
{
    char where[GLTF_WHERE];
    snprintf(where, sizeof where, "buffers[%zu]", index);
    json_t *uri = gltf_member(r, object, "uri", JSON_STRING, where);
    if (r->status != LMN_OK)
        return;
    if (uri) {
        b->missing = !gltf_load_uri(r, json_string_value(uri), "buffer", &b->owned, &b->file, &b->name);
        b->data = b->file.data;
        b->size = b->file.size;
        if (b->owned)
            memset(&b->file, 0, sizeof b->file);
    } else if (index == 0 && r->chunk) {
        b->data = r->chunk;
        b->size = r->chunk_size;
    } else {
        b->missing = true;
        gltf_warn(r, WARNING_MISSING_FILE, "%s has neither a uri nor a binary chunk", where);
    }
}

static const gltf_buffer *get_buffer(gltf_reader *r, size_t index)
{
    json_t *object = gltf_item(r, "buffers", index);
    if (!object)
        return NULL;
    gltf_buffer *b = &r->buffers[index];
    if (!b->asked) {
        char   where[GLTF_WHERE];
        size_t length;
        b->asked = true;
        snprintf(where, sizeof where, "buffers[%zu]", index);
        gltf_size(r, object, "byteLength", 0, where, &length);
        find_buffer(r, index, object, b);
        if (b->missing && b->name && !r->missing_buffer)
            r->missing_buffer = b->name;
        r->nameless_buffer |= b->missing && !b->name;
        if (r->status == LMN_OK && !b->missing && b->size < length) {
            gltf_fail(r, LMN_FORMAT, "%s (%s): %zu bytes are promised, there are only %zu", where,
                      b->name ? b->name : "embedded", length, b->size);
            error_hint(r->error, "the file is cut off; copy or export it again");
        }
    }
    return r->status == LMN_OK && !b->missing ? b : NULL;
}

/* Bytes offset … offset + length of a buffer. */
static const unsigned char *get_range(gltf_reader *r, json_t *object, const char *where, size_t *length)
{
    size_t buffer, offset, end;
    if (!gltf_index(r, object, "buffer", r->buffer_count, "buffers", where, &buffer)) {
        gltf_fail(r, LMN_FORMAT, "%s: names no buffer", where);
        return NULL;
    }
    gltf_size(r, object, "byteOffset", 0, where, &offset);
    gltf_size(r, object, "byteLength", 0, where, length);
    const gltf_buffer *b = get_buffer(r, buffer);
    if (!b)
        return NULL;
    if (!size_add(offset, *length, &end) || end > b->size) {
        gltf_fail(r, LMN_FORMAT, "%s: bytes %zu to %zu lie outside buffers[%zu], which has %zu", where, offset, end,
                  buffer, b->size);
        return NULL;
    }
    return b->data + offset;
}

typedef struct packed {
    const unsigned char *data;
    size_t               size, count, stride;
    const char          *mode, *filter;
} packed;

/* The codecs cannot pack better than this; a larger promise would only make us allocate. */
static bool is_plausible(const packed *p, size_t bytes)
{
    if (strcmp(p->mode, "ATTRIBUTES") == 0)
        return bytes / 64 <= p->size + p->stride;
    return strcmp(p->mode, "TRIANGLES") == 0 ? p->count / 3 <= p->size : p->count <= p->size;
}

static bool check_packed(gltf_reader *r, const packed *p, const char *where)
{
    bool   attributes = strcmp(p->mode, "ATTRIBUTES") == 0, triangles = strcmp(p->mode, "TRIANGLES") == 0;
    size_t bytes;
    bool   good = attributes ? p->stride % 4 == 0 && p->stride > 0 && p->stride <= 256
                             : (triangles || strcmp(p->mode, "INDICES") == 0) && (p->stride == 2 || p->stride == 4);
    if (triangles && p->count % 3 != 0)
        good = false;
    if (strcmp(p->filter, "OCTAHEDRAL") == 0)
        good = good && attributes && (p->stride == 4 || p->stride == 8);
    else if (strcmp(p->filter, "QUATERNION") == 0)
        good = good && attributes && p->stride == 8;
    else if (strcmp(p->filter, "EXPONENTIAL") == 0)
        good = good && attributes;
    else
        good = good && strcmp(p->filter, "NONE") == 0;
    if (!good)
        return gltf_fail(r, LMN_FORMAT, "%s: mode %s, filter %s and byteStride %zu do not go together", where, p->mode,
                         p->filter, p->stride),
               false;
    if (!size_mul(p->count, p->stride, &bytes) || bytes > LIMIT_FILE_BYTES || !is_plausible(p, bytes))
        return gltf_fail(r, LMN_FORMAT, "%s: %zu compressed bytes cannot hold %zu elements", where, p->size, p->count),
               false;
    return true;
}

static void apply_filter(const char *filter, void *data, size_t count, size_t stride)
{
    if (strcmp(filter, "OCTAHEDRAL") == 0)
        meshopt_decodeFilterOct(data, count, stride);
    else if (strcmp(filter, "QUATERNION") == 0)
        meshopt_decodeFilterQuat(data, count, stride);
    else if (strcmp(filter, "EXPONENTIAL") == 0)
        meshopt_decodeFilterExp(data, count, stride);
}

/* Behind the fence. Request: count, stride, mode, filter, and the packed bytes, all of them checked before. */
static lmn_status decode_packed(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_reader r = fence_read(request, size);
    uint64_t     counts[2] = {0, 0};
    const void  *at = fence_take(&r, sizeof counts);
    if (at)
        memcpy(counts, at, sizeof counts);
    char          *mode = fence_take_text(&r), *filter = fence_take_text(&r);
    size_t         count = (size_t)counts[0], stride = (size_t)counts[1], packed_size = (size_t)(r.end - r.at);
    unsigned char *out = mode && filter ? mem_calloc(count, stride) : NULL;
    int            failed = 0;
    if (out && strcmp(mode, "ATTRIBUTES") == 0)
        failed = meshopt_decodeVertexBuffer(out, count, stride, r.at, packed_size);
    else if (out && strcmp(mode, "TRIANGLES") == 0)
        failed = meshopt_decodeIndexBuffer(out, count, stride, r.at, packed_size);
    else if (out)
        failed = meshopt_decodeIndexSequence(out, count, stride, r.at, packed_size);
    if (out && !failed)
        apply_filter(filter, out, count, stride);
    mem_free(mode);
    mem_free(filter);
    *answer = (fence_bytes){.bytes = out, .size = out ? count * stride : 0, .capacity = out ? count * stride : 0};
    return !out     ? error_memory(error)
           : failed ? error_set(error, LMN_FORMAT, "the compressed data is damaged")
                    : LMN_OK;
}

static bool unpack(gltf_reader *r, const packed *p, const char *where, gltf_view *v)
{
    if (!check_packed(r, p, where))
        return false;
    lmn_error   problem = {0};
    fence_bytes request = {0}, answer;
    fence_put(&request, &(uint64_t[]){p->count, p->stride}, 2 * sizeof(uint64_t));
    fence_put_text(&request, p->mode);
    fence_put_text(&request, p->filter);
    fence_put(&request, p->data, p->size);
    lmn_status status = fence_call(&answer, decode_packed, "the reader of meshopt data", &request, &problem);
    mem_free(request.bytes);
    if (status == LMN_OK && answer.size != p->count * p->stride)
        status = error_set(&problem, LMN_FORMAT, "the compressed data is damaged");
    v->owned = answer.bytes;
    if (status != LMN_OK) {
        gltf_fail(r, status, "%s: %s", where, problem.message);
        error_hint(r->error, "%s", problem.hint);
        return false;
    }
    v->data = v->owned;
    v->size = p->count * p->stride;
    return true;
}

static bool unpack_view(gltf_reader *r, json_t *extension, size_t index, gltf_view *v)
{
    char where[GLTF_WHERE];
    snprintf(where, sizeof where, "bufferViews[%zu].extensions.EXT_meshopt_compression", index);
    packed p = {.mode = json_string_value(json_object_get(extension, "mode")),
                .filter = json_string_value(json_object_get(extension, "filter"))};
    p.mode = p.mode ? p.mode : "missing";
    p.filter = p.filter ? p.filter : "NONE";
    gltf_size(r, extension, "count", 0, where, &p.count);
    gltf_size(r, extension, "byteStride", 0, where, &p.stride);
    p.data = get_range(r, extension, where, &p.size);
    return p.data && unpack(r, &p, where, v);
}

const gltf_view *gltf_get_view(gltf_reader *r, size_t index, const char *where)
{
    if (r->status != LMN_OK)
        return NULL;
    if (index >= r->view_count) {
        gltf_fail(r, LMN_FORMAT, "%s: bufferViews[%zu] does not exist, the file has %zu", where, index, r->view_count);
        return NULL;
    }
    gltf_view *v = &r->views[index];
    if (!v->asked) {
        char    here[GLTF_WHERE];
        json_t *object = gltf_item(r, "bufferViews", index);
        if (!object)
            return NULL;
        v->asked = true;
        snprintf(here, sizeof here, "bufferViews[%zu]", index);
        gltf_size(r, object, "byteStride", 0, here, &v->stride);
        json_t *extension = gltf_extension(object, "EXT_meshopt_compression");
        if (extension)
            v->missing = !unpack_view(r, extension, index, v);
        else
            v->missing = !(v->data = get_range(r, object, here, &v->size));
    }
    return r->status == LMN_OK && !v->missing ? v : NULL;
}

void gltf_release_buffers(gltf_reader *r)
{
    for (size_t i = 0; r->buffers && i < r->buffer_count; i++) {
        mem_free(r->buffers[i].owned);
        mem_free(r->buffers[i].name);
        file_data_release(&r->buffers[i].file);
    }
    for (size_t i = 0; r->views && i < r->view_count; i++)
        mem_free(r->views[i].owned);
    mem_free(r->buffers);
    mem_free(r->views);
}
