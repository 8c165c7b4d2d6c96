#include "construct/fenced.h"

#include <string.h>

#include "base/memory.h"

void region_put(fence_bytes *to, const contour *contours, size_t count)
{
    fence_put_u32(to, (uint32_t)count);
    for (size_t i = 0; i < count; i++) {
        fence_put_u32(to, (uint32_t)contours[i].count);
        fence_put(to, contours[i].points, contours[i].count * sizeof *contours[i].points);
    }
}

bool region_take(region *out, fence_reader *r)
{
    *out = (region){0};
    uint32_t count = fence_take_u32(r);
    /* A contour takes four bytes at least. */
    if (count > (size_t)(r->end - r->at) / 4)
        return false;
    out->contours = mem_calloc(count, sizeof *out->contours);
    for (uint32_t i = 0; out->contours && i < count; i++) {
        uint32_t    points = fence_take_u32(r);
        const void *at = fence_take(r, (size_t)points * sizeof(point2));
        point2     *copy = at ? mem_copy(at, (size_t)points * sizeof(point2)) : NULL;
        if (!copy)
            return false;
        out->contours[out->count++] = (contour){.points = copy, .count = points};
    }
    return out->contours != NULL && !r->ended;
}
