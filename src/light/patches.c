#include "light/patches.h"

#include <stddef.h>

#include "base/memory.h"

static bool row_is_empty(const uint8_t *row, int width)
{
    for (int x = 0; x < width; x++)
        if (row[4 * (size_t)x])
            return false;
    return true;
}

/* Of the columns between two rows, those from the first that is not empty to the last. */
static void find_columns(const uint8_t *texels, int width, int from, int to, int *first, int *last)
{
    *first = width;
    *last = -1;
    for (int y = from; y <= to; y++) {
        const uint8_t *row = texels + 4 * (size_t)y * (size_t)width;
        for (int x = 0; x < *first; x++)
            if (row[4 * (size_t)x])
                *first = x;
        for (int x = width - 1; x > *last; x--)
            if (row[4 * (size_t)x])
                *last = x;
    }
}

static int at_least(int a, int b)
{
    return a > b ? a : b;
}

texel_box texel_box_of(uint8_t *texels, int width, int height, int margin)
{
    size_t    row = 4 * (size_t)width;
    texel_box box = {.texels = texels, .picture_width = width, .picture_height = height};
    int       low = 0, high = height - 1, left, right;
    while (low < height && row_is_empty(texels + (size_t)low * row, width))
        low++;
    while (high > low && row_is_empty(texels + (size_t)high * row, width))
        high--;
    if (low == height)
        return box;
    find_columns(texels, width, low, high, &left, &right);
    box.x = at_least(left - margin, 0);
    box.y = at_least(low - margin, 0);
    box.width = (right + margin < width ? right + margin : width - 1) + 1 - box.x;
    box.height = (high + margin < height ? high + margin : height - 1) + 1 - box.y;
    box.texels = texels + (size_t)box.y * row + 4 * (size_t)box.x;
    return box;
}

uint8_t *texel_at(const texel_box *box, int x, int y)
{
    return box->texels + 4 * ((ptrdiff_t)y * box->picture_width + x);
}

bool patch_marks_create(patch_marks *out, const texel_box *box)
{
    *out = (patch_marks){.stride = box->width + 2, .height = box->height + 2};
    size_t count = (size_t)out->stride * (size_t)out->height;
    out->marks = mem_calloc(count, 1);
    out->found = mem_alloc(count * sizeof *out->found);
    return out->marks && out->found;
}

void patch_marks_release(patch_marks *p)
{
    mem_free(p->marks);
    mem_free(p->found);
    *p = (patch_marks){.marks = NULL};
}

int patch_index(const patch_marks *p, int x, int y)
{
    return (y + 1) * p->stride + x + 1;
}

int patch_flood(patch_marks *p, int first, uint8_t into, bool corners)
{
    const int around[8] = {-1, 1, -p->stride, p->stride, -p->stride - 1, -p->stride + 1, p->stride - 1, p->stride + 1};
    int       neighbours = corners ? 8 : 4, count = 1;
    uint8_t   mark = p->marks[first];
    p->found[0] = first;
    p->marks[first] = into;
    for (int k = 0; k < count; k++)
        for (int n = 0; n < neighbours; n++) {
            int next = p->found[k] + around[n];
            if (p->marks[next] != mark)
                continue;
            p->marks[next] = into;
            p->found[count++] = next;
        }
    return count;
}

bool patch_at_border(const patch_marks *p, int index)
{
    int x = index % p->stride, y = index / p->stride;
    return x == 1 || y == 1 || x == p->stride - 2 || y == p->height - 2;
}
