/* What is dark is eroded; of what is left large pieces grow back (morphological opening: Serra 1982, "Image analysis
 * and mathematical morphology"). What these do not reach falls apart into corners, necks and, where something of it
 * outlived the erosion, appendages. Corners stay, so that nothing is rounded. Distances are those of 3-4 chamfers
 * (Borgefors 1986, "Distance transformations in digital images"). */
#include "light/appendages.h"

#include <stddef.h>

#include "base/memory.h"

enum { NEXT = 3, ACROSS = 4, FAR = 1 << 28 }; /* distances of neighbours, and of what has none */
/* Half the width of a neck, of the radius; areas, of its square: of an appendage, and what is left of it eroded. */
static const double NECK = 0.3, LEAST = 12, LEAST_ERODED = 4;
static const int    SLIVER = 4; /* borders are rough by so much */

typedef struct search {
    uint8_t *texels, *seen;
    int     *distance, *found;
    int      width, height, neck;
} search;

static bool is_dark(const search *s, int i)
{
    return s->texels[4 * i] > 127;
}

static void lower(search *s, int x, int y, int dx, int dy)
{
    int i = y * s->width + x, from = x + dx < 0 || x + dx >= s->width || y + dy < 0 || y + dy >= s->height
                                         ? FAR
                                         : s->distance[i + dy * s->width + dx];
    int far = from + (dx && dy ? ACROSS : NEXT);
    s->distance[i] = far < s->distance[i] ? far : s->distance[i];
}

/* From what is 0 on, in two sweeps. */
static void spread_distance(search *s)
{
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            for (int k = 0; k < 4; k++)
                lower(s, x, y, k < 3 ? k - 1 : -1, k < 3 ? -1 : 0);
    for (int y = s->height - 1; y >= 0; y--)
        for (int x = s->width - 1; x >= 0; x--)
            for (int k = 0; k < 4; k++)
                lower(s, x, y, k < 3 ? k - 1 : 1, k < 3 ? 1 : 0);
}

/* What hangs together with `first` of texels with the same mark becomes another; how many there are. */
static int flood(search *s, int first, uint8_t into)
{
    uint8_t mark = s->seen[first];
    int     count = 1;
    s->found[0] = first;
    s->seen[first] = into;
    for (int k = 0; k < count; k++) {
        int at = s->found[k], x = at % s->width, y = at / s->width;
        for (int n = 0; n < 9; n++) {
            int dx = n % 3 - 1, dy = n / 3 - 1, next = at + dy * s->width + dx;
            if (x + dx < 0 || x + dx >= s->width || y + dy < 0 || y + dy >= s->height || s->seen[next] != mark)
                continue;
            s->seen[next] = into;
            s->found[count++] = next;
        }
    }
    return count;
}

enum { OUTSIDE, ERODED, LARGE, SMALL, HANGS, DONE }; /* marks; HANGS: dark, and not within what is large */

/* Marks what is left of what is dark, and which of it is large. */
static void erode(search *s, double radius)
{
    int count = s->width * s->height;
    for (int i = 0; i < count; i++)
        s->distance[i] = is_dark(s, i) ? FAR : 0;
    spread_distance(s);
    for (int i = 0; i < count; i++)
        s->seen[i] = s->distance[i] > s->neck ? ERODED : OUTSIDE;
    for (int i = 0; i < count; i++) {
        if (s->seen[i] != ERODED)
            continue;
        int  size = flood(s, i, LARGE);
        bool small = size < LEAST_ERODED * radius * radius;
        for (int k = 0; k < size && small; k++)
            s->seen[s->found[k]] = SMALL;
    }
}

/* Lets what is large grow back; `distance` is then 1 where something small outlived, 2 at what is large, else 0. */
static void grow_back(search *s)
{
    int count = s->width * s->height;
    for (int i = 0; i < count; i++)
        s->distance[i] = s->seen[i] == LARGE ? 0 : FAR;
    spread_distance(s);
    for (int i = 0; i < count; i++) {
        int  away = s->distance[i];
        bool within = away <= s->neck + SLIVER;
        s->distance[i] = s->seen[i] == SMALL ? 1 : is_dark(s, i) && within ? 2 : 0;
        s->seen[i] = is_dark(s, i) && !within ? HANGS : OUTSIDE;
    }
}

/* Does what was found hang on something large, and is it no corner of it, nor near what throws it? */
static bool is_appendage(const search *s, int count)
{
    bool outlived = false, hangs = false, kept = false;
    for (int k = 0; k < count && !kept; k++) {
        int at = s->found[k], x = at % s->width, y = at / s->width;
        kept = s->texels[4 * at + 1] || x == 0 || y == 0 || x == s->width - 1 || y == s->height - 1;
        outlived = outlived || s->distance[at] == 1;
        for (int n = 0; n < 9 && !kept && !hangs; n++)
            hangs = s->distance[at + (n / 3 - 1) * s->width + n % 3 - 1] == 2;
    }
    return outlived && hangs && !kept;
}

/* With the half covered texels of its border. */
static void wipe(search *s, int count)
{
    for (int k = 0; k < count; k++) {
        int at = s->found[k];
        for (int n = 0; n < 9; n++) {
            int next = at + (n / 3 - 1) * s->width + n % 3 - 1;
            if (next == at || !is_dark(s, next))
                s->texels[4 * next] = 0;
        }
    }
}

static void cut(search *s, double radius)
{
    erode(s, radius);
    grow_back(s);
    for (int i = 0; i < s->width * s->height; i++) {
        int count = s->seen[i] == HANGS ? flood(s, i, DONE) : 0;
        if (count && count < LEAST * radius * radius && is_appendage(s, count))
            wipe(s, count);
    }
}

bool appendages_cut(uint8_t *texels, int width, int height, double radius)
{
    size_t count = (size_t)width * (size_t)height;
    search s = {.texels = texels, .width = width, .height = height, .neck = (int)(NEXT * NECK * radius)};
    s.seen = mem_alloc(count);
    s.distance = mem_alloc(count * sizeof *s.distance);
    s.found = mem_alloc(count * sizeof *s.found);
    bool good = s.seen && s.distance && s.found;
    if (good)
        cut(&s, radius);
    mem_free(s.seen);
    mem_free(s.distance);
    mem_free(s.found);
    return good;
}
