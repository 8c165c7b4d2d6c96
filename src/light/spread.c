/* Three means over boxes, one after the other, along rows and then along columns: nearly a Gaussian (central limit), in
 * a time that does not depend on its width. */
#include "light/spread.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/memory.h"
#include "light/patches.h"

enum { MEANS = 3 };

/* The mean of what lies within `reach` texels; beyond the ends it is as there. */
static void mean_over(const float *from, int count, int reach, float *into)
{
    double sum = 0;
    for (int k = -reach; k <= reach; k++)
        sum += (double)from[k < 0 ? 0 : k < count ? k : count - 1];
    for (int i = 0; i < count; i++) {
        int before = i - reach, behind = i + reach + 1;
        into[i] = (float)(sum / (2 * reach + 1));
        sum += (double)from[behind < count ? behind : count - 1] - (double)from[before > 0 ? before : 0];
    }
}

/* One row or column, `step` bytes from texel to texel. */
static void spread_along(uint8_t *first, size_t step, int count, int reach, float *rows)
{
    float *from = rows, *into = rows + count;
    for (int i = 0; i < count; i++)
        from[i] = first[(size_t)i * step];
    for (int k = 0; k < MEANS; k++) {
        float *swapped = from;
        mean_over(from, count, reach, into);
        from = into;
        into = swapped;
    }
    for (int i = 0; i < count; i++)
        first[(size_t)i * step] = (uint8_t)(from[i] + 0.5F);
}

bool coverage_spread(uint8_t *texels, int width, int height, double radius)
{
    /* The variance of one is (side² - 1) / 12. */
    int       reach = (int)(0.5 * (sqrt(12.0 / MEANS * 0.25 * radius * radius + 1) - 1) + 0.5);
    size_t    row = 4 * (size_t)width;
    texel_box box = texel_box_of(texels, width, height, MEANS * (reach + 1));
    float    *rows = mem_alloc(2 * (size_t)(width > height ? width : height) * sizeof *rows);
    if (!rows)
        return false;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        texels[4 * i + 2] = texels[4 * i];
    for (int y = 0; y < box.height; y++)
        spread_along(texel_at(&box, 0, y) + 2, 4, box.width, reach, rows);
    for (int x = 0; x < box.width; x++)
        spread_along(texel_at(&box, x, 0) + 2, row, box.height, reach, rows);
    mem_free(rows);
    return true;
}
