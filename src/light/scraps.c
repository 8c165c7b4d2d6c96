#include "light/scraps.h"

#include <stddef.h>

#include "base/memory.h"
#include "light/patches.h"

static const double ISLAND = 12, HOLE = 4; /* of the square of the radius */

enum { THERE = 1, SEEN = 2 }; /* marks */

static int amount(const uint8_t *texel, bool hole)
{
    return hole ? 255 - texel[0] : texel[0];
}

static uint8_t *texel_of(const texel_box *box, const patch_marks *p, int index)
{
    return texel_at(box, index % p->stride - 1, index / p->stride - 1);
}

/* What was found goes where it is small, unless it must stay. A hole at the box's border is none: all around is
 * light, and beyond that the picture ends. */
static void judge(const texel_box *box, const patch_marks *p, int count, bool hole, double least)
{
    double area = 0;
    bool   kept = false;
    for (int k = 0; k < count && !kept && area < least; k++) {
        const uint8_t *texel = texel_of(box, p, p->found[k]);
        area += amount(texel, hole) / 255.0;
        kept = (!hole && texel[1]) || patch_at_border(p, p->found[k]);
    }
    for (int k = 0; k < count && !kept && area < least; k++)
        texel_of(box, p, p->found[k])[0] = hole ? 255 : 0;
}

/* Islands hang together over corners, holes do not. */
static void drop_below(const texel_box *box, patch_marks *p, bool hole, double least)
{
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++)
            p->marks[patch_index(p, x, y)] = amount(texel_at(box, x, y), hole) ? THERE : 0;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            int at = patch_index(p, x, y);
            if (p->marks[at] == THERE)
                judge(box, p, patch_flood(p, at, SEEN, !hole), hole, least);
        }
}

bool scraps_drop(uint8_t *texels, int width, int height, double radius)
{
    texel_box box = texel_box_of(texels, width, height, 1);
    if (!box.width)
        return true;
    patch_marks p;
    bool        good = patch_marks_create(&p, &box);
    for (int hole = 0; hole < 2 && good; hole++)
        drop_below(&box, &p, hole, (hole ? HOLE : ISLAND) * radius * radius);
    patch_marks_release(&p);
    return good;
}
