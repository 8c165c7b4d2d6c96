/* Meshes that Draco compressed: decoded behind the fence, read from the answer. */
#include "import/draco.h"

#include <string.h>

#include "base/memory.h"
#include "import/draco_decode.h"

struct draco_model {
    fence_bytes          answer;
    uint32_t             vertices, triangles, attributes;
    const unsigned char *indices, *first; /* first attribute */
};

#ifdef LIMNER_HAVE_DRACO

bool draco_is_built(void)
{
    return true;
}

static bool put(void *to, const void *bytes, size_t size)
{
    fence_bytes *answer = to;
    fence_put(answer, bytes, size);
    return !answer->failed;
}

static lmn_status decode(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    draco_result result = draco_decode(request, size, put, answer);
    if (result == DRACO_DAMAGED)
        return error_set(error, LMN_FORMAT, "the Draco data is damaged");
    return result == DRACO_DONE ? LMN_OK : error_memory(error);
}

#else

bool draco_is_built(void)
{
    return false;
}

static lmn_status decode(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)answer;
    return error_set(error, LMN_UNSUPPORTED, "this build reads no Draco data");
}

#endif

static size_t attribute_size(const draco_model *m)
{
    return sizeof(draco_attribute) + sizeof(float) * DRACO_COMPONENTS * m->vertices;
}

/* What the child says is not believed: sizes must fit, corners must be vertices. */
static bool check(draco_model *m)
{
    fence_reader r = fence_read(m->answer.bytes, m->answer.size);
    m->vertices = fence_take_u32(&r);
    m->triangles = fence_take_u32(&r);
    m->attributes = fence_take_u32(&r);
    m->indices = fence_take(&r, (size_t)m->triangles * 3 * sizeof(uint32_t));
    size_t bytes;
    if (r.ended || !size_mul(attribute_size(m), m->attributes, &bytes) || bytes != (size_t)(r.end - r.at))
        return false;
    m->first = r.at;
    for (size_t i = 0; i < (size_t)m->triangles * 3; i++) {
        uint32_t corner;
        memcpy(&corner, m->indices + i * sizeof corner, sizeof corner);
        if (corner >= m->vertices)
            return false;
    }
    return true;
}

lmn_status draco_open(draco_model **out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    *out = NULL;
    draco_model *m = mem_calloc(1, sizeof *m);
    if (!m)
        return error_memory(error);
    fence_bytes request = {.bytes = (unsigned char *)bytes, .size = size};
    lmn_status  status = fence_call(&m->answer, decode, "the reader of Draco data", &request, error);
    if (status == LMN_OK && !check(m))
        status = error_set(error, LMN_FORMAT, "the Draco data is damaged");
    if (status == LMN_OK)
        *out = m;
    else
        draco_close(m);
    return status;
}

void draco_close(draco_model *model)
{
    if (!model)
        return;
    mem_free(model->answer.bytes);
    mem_free(model);
}

size_t draco_vertex_count(const draco_model *model)
{
    return model->vertices;
}

size_t draco_triangle_count(const draco_model *model)
{
    return model->triangles;
}

void draco_read_indices(const draco_model *model, uint32_t *out)
{
    if (model->triangles)
        memcpy(out, model->indices, (size_t)model->triangles * 3 * sizeof *out);
}

bool draco_read_attribute(const draco_model *model, uint32_t id, int components, bool normalized, float *out)
{
    const unsigned char *at = model->first;
    draco_attribute      head = {0};
    uint32_t             i = 0;
    for (; i < model->attributes; i++, at += attribute_size(model)) {
        memcpy(&head, at, sizeof head);
        if (head.id == id)
            break;
    }
    if (i == model->attributes || components < 1 || components > DRACO_COMPONENTS || head.components == 0)
        return false;
    const float scale = normalized ? 1.0f / head.range : 1.0f;
    for (size_t v = 0; v < model->vertices; v++) {
        float value[DRACO_COMPONENTS];
        memcpy(value, at + sizeof head + v * sizeof value, sizeof value);
        for (int k = 0; k < components; k++)
            *out++ = (uint32_t)k < head.components ? value[k] * scale : k == 3 ? 1.0f : 0.0f;
    }
    return true;
}
