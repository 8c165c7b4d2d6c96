/* What is dark is eroded; of what is left large pieces grow back (morphological opening: Serra 1982, "Image analysis
 * and mathematical morphology"). What these do not reach falls apart into corners, necks and, where something of it
 * outlived the erosion, appendages. Corners stay, so that nothing is rounded. Distances are those of 3-4 chamfers
 * (Borgefors 1986, "Distance transformations in digital images"). */
#include "light/appendages.h"

#include <stddef.h>

#include "base/memory.h"
#include "light/patches.h"

enum { NEXT = 3, ACROSS = 4, FAR = 1 << 28 }; /* distances of neighbours, and of what has none */
/* Half the width of a neck, of the radius; areas, of its square: of an appendage, and what is left of it eroded. */
static const double NECK = 0.3, LEAST = 12, LEAST_ERODED = 4;
static const int    SLIVER = 4; /* borders are rough by so much */

typedef struct search {
    texel_box   box;
    patch_marks marks;
    int        *distance; /* as the marks lie, with the same frame */
    int         neck;
} search;

enum { OUTSIDE, ERODED, LARGE, SMALL, HANGS, DONE }; /* marks; HANGS: dark, and not within what is large */

static uint8_t *texel_of(const search *s, int index)
{
    return texel_at(&s->box, index % s->marks.stride - 1, index / s->marks.stride - 1);
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* A row from the one beside it, and then from what lies before in it. */
static void spread_row(int *row, const int *beside, int count, int ahead)
{
    for (int x = 1; x <= count; x++) {
        int across = smaller(beside[x - 1], beside[x + 1]) + ACROSS;
        row[x] = smaller(row[x], smaller(across, beside[x] + NEXT));
    }
    for (int k = 1; k <= count; k++) {
        int x = ahead > 0 ? k : count + 1 - k;
        row[x] = smaller(row[x], row[x - ahead] + NEXT);
    }
}

/* From what is 0 on, in two sweeps. The frame stays far. */
static void spread_distance(search *s)
{
    int stride = s->marks.stride;
    for (int y = 1; y <= s->box.height; y++)
        spread_row(s->distance + (ptrdiff_t)y * stride, s->distance + (ptrdiff_t)(y - 1) * stride, s->box.width, 1);
    for (int y = s->box.height; y >= 1; y--)
        spread_row(s->distance + (ptrdiff_t)y * stride, s->distance + (ptrdiff_t)(y + 1) * stride, s->box.width, -1);
}

/* Marks what is left of what is dark, and which of it is large. */
static void erode(search *s, double radius)
{
    int count = s->marks.stride * s->marks.height;
    for (int y = 0; y < s->box.height; y++)
        for (int x = 0; x < s->box.width; x++)
            s->distance[patch_index(&s->marks, x, y)] = texel_at(&s->box, x, y)[0] > 127 ? FAR : 0;
    spread_distance(s);
    for (int y = 0; y < s->box.height; y++)
        for (int x = 0; x < s->box.width; x++) {
            int at = patch_index(&s->marks, x, y);
            s->marks.marks[at] = s->distance[at] > s->neck ? ERODED : OUTSIDE;
        }
    for (int i = 0; i < count; i++) {
        if (s->marks.marks[i] != ERODED)
            continue;
        int  size = patch_flood(&s->marks, i, LARGE, true);
        bool small = size < LEAST_ERODED * radius * radius;
        for (int k = 0; k < size && small; k++)
            s->marks.marks[s->marks.found[k]] = SMALL;
    }
}

/* Lets what is large grow back; `distance` is then 1 where something small outlived, 2 at what is large, else 0. */
static void grow_back(search *s)
{
    int count = s->marks.stride * s->marks.height;
    for (int i = 0; i < count; i++)
        s->distance[i] = s->marks.marks[i] == LARGE ? 0 : FAR;
    spread_distance(s);
    for (int y = 0; y < s->box.height; y++)
        for (int x = 0; x < s->box.width; x++) {
            int  at = patch_index(&s->marks, x, y), away = s->distance[at];
            bool dark = texel_at(&s->box, x, y)[0] > 127, within = away <= s->neck + SLIVER;
            s->distance[at] = s->marks.marks[at] == SMALL ? 1 : dark && within ? 2 : 0;
            s->marks.marks[at] = dark && !within ? HANGS : OUTSIDE;
        }
}

static int around(const search *s, int index, int n)
{
    return index + (n / 3 - 1) * s->marks.stride + n % 3 - 1;
}

/* Does what was found hang on something large, and is it no corner of it, nor near what throws it? */
static bool is_appendage(const search *s, int count)
{
    bool outlived = false, hangs = false, kept = false;
    for (int k = 0; k < count && !kept; k++) {
        int at = s->marks.found[k];
        kept = texel_of(s, at)[1] || patch_at_border(&s->marks, at);
        outlived = outlived || s->distance[at] == 1;
        for (int n = 0; n < 9 && !kept && !hangs; n++)
            hangs = s->distance[around(s, at, n)] == 2;
    }
    return outlived && hangs && !kept;
}

/* With the half covered texels of its border. */
static void wipe(search *s, int count)
{
    for (int k = 0; k < count; k++) {
        int at = s->marks.found[k];
        for (int n = 0; n < 9; n++) {
            uint8_t *texel = texel_of(s, around(s, at, n));
            if (n == 4 || texel[0] <= 127)
                texel[0] = 0;
        }
    }
}

static void cut(search *s, double radius)
{
    erode(s, radius);
    grow_back(s);
    for (int i = 0; i < s->marks.stride * s->marks.height; i++) {
        int count = s->marks.marks[i] == HANGS ? patch_flood(&s->marks, i, DONE, true) : 0;
        if (count && count < LEAST * radius * radius && is_appendage(s, count))
            wipe(s, count);
    }
}

bool appendages_cut(uint8_t *texels, int width, int height, double radius)
{
    search s = {.box = texel_box_of(texels, width, height, 1), .neck = (int)(NEXT * NECK * radius)};
    if (!s.box.width)
        return true;
    bool   good = patch_marks_create(&s.marks, &s.box);
    size_t count = (size_t)s.marks.stride * (size_t)s.marks.height;
    s.distance = mem_alloc(count * sizeof *s.distance);
    good = good && s.distance;
    for (size_t i = 0; i < count && good; i++)
        s.distance[i] = FAR;
    if (good)
        cut(&s, radius);
    mem_free(s.distance);
    patch_marks_release(&s.marks);
    return good;
}
