/* Bytes that grow, and reading them again. */
#include <string.h>

#include "base/memory.h"
#include "fence/fence.h"

void fence_put(fence_bytes *to, const void *bytes, size_t size)
{
    size_t needed;
    if (to->failed || size == 0)
        return;
    if (!size_add(to->size, size, &needed) || !mem_grow((void **)&to->bytes, &to->capacity, needed, 1)) {
        to->failed = true;
        return;
    }
    memcpy(to->bytes + to->size, bytes, size);
    to->size = needed;
}

void fence_put_u32(fence_bytes *to, uint32_t value)
{
    fence_put(to, &value, sizeof value);
}

void fence_put_text(fence_bytes *to, const char *text)
{
    size_t size = text ? strlen(text) : 0;
    fence_put_u32(to, (uint32_t)size);
    fence_put(to, text, size);
}

fence_reader fence_read(const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    return (fence_reader){.at = at, .end = at ? at + size : at};
}

const void *fence_take(fence_reader *r, size_t size)
{
    if (r->ended || (size_t)(r->end - r->at) < size) {
        r->ended = true;
        return NULL;
    }
    const unsigned char *at = r->at;
    r->at += size;
    return at;
}

uint32_t fence_take_u32(fence_reader *r)
{
    uint32_t    value = 0;
    const void *at = fence_take(r, sizeof value);
    if (at)
        memcpy(&value, at, sizeof value);
    return value;
}

char *fence_take_text(fence_reader *r)
{
    size_t      size = fence_take_u32(r);
    const char *at = fence_take(r, size);
    char       *text = at ? mem_alloc(size + 1) : NULL;
    if (text) {
        memcpy(text, at, size);
        text[size] = '\0';
    }
    return text;
}
