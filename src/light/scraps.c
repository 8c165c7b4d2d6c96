#include "light/scraps.h"

#include <stddef.h>

#include "base/memory.h"

static const double ISLAND = 12, HOLE = 4; /* of the square of the radius */

/* Texels that hang together. */
typedef struct patch {
    double area;
    bool   kept; /* whatever its area */
} patch;

typedef struct scrap_search {
    uint8_t *texels, *seen;
    int     *found; /* the patch's texels, which are looked around in this order */
    int      width, height;
    bool     hole;
} scrap_search;

static int amount(const scrap_search *s, int i)
{
    return s->hole ? 255 - s->texels[4 * i] : s->texels[4 * i];
}

/* All that hangs together with `first`; how many. Islands do so over corners, holes do not. */
static int gather(scrap_search *s, int first, patch *out)
{
    int count = 1;
    s->found[0] = first;
    s->seen[first] = 1;
    *out = (patch){0};
    for (int k = 0; k < count; k++) {
        int at = s->found[k], x = at % s->width, y = at / s->width;
        out->area += amount(s, at) / 255.0;
        out->kept = out->kept || (!s->hole && s->texels[4 * at + 1]) || x == 0 || y == 0 || x == s->width - 1 ||
                    y == s->height - 1;
        for (int n = 0; n < 9; n++) {
            int dx = n % 3 - 1, dy = n / 3 - 1, next = at + dy * s->width + dx;
            if (x + dx < 0 || x + dx >= s->width || y + dy < 0 || y + dy >= s->height || (s->hole && dx && dy))
                continue;
            if (!s->seen[next] && amount(s, next)) {
                s->seen[next] = 1;
                s->found[count++] = next;
            }
        }
    }
    return count;
}

static void drop_below(scrap_search *s, double least)
{
    for (int i = 0; i < s->width * s->height; i++) {
        patch p;
        if (s->seen[i] || !amount(s, i))
            continue;
        int count = gather(s, i, &p);
        if (!p.kept && p.area < least)
            for (int k = 0; k < count; k++)
                s->texels[4 * s->found[k]] = s->hole ? 255 : 0;
    }
}

bool scraps_drop(uint8_t *texels, int width, int height, double radius)
{
    size_t count = (size_t)width * (size_t)height;
    bool   good = true;
    for (int hole = 0; hole < 2 && good; hole++) {
        scrap_search s = {texels, mem_calloc(count, 1), mem_alloc(count * sizeof *s.found), width, height, hole != 0};
        good = s.seen && s.found;
        if (good)
            drop_below(&s, (hole ? HOLE : ISLAND) * radius * radius);
        mem_free(s.seen);
        mem_free(s.found);
    }
    return good;
}
