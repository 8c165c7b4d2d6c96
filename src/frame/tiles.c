/* Which tiles of a band have pixels of a layer. Layers get emptier with depth, and a layer lies inside the one
 * before, so that passes over the tiles of the layer before miss nothing. */
#include "frame/frame_private.h"

#include <string.h>

void tiles_start(tile_grid *t, const int band[4])
{
    int longest = band[2] > band[3] ? band[2] : band[3];
    memset(t, 0, sizeof *t);
    memcpy(t->band, band, sizeof t->band);
    t->size = (longest + TILES_SIDE - 1) / TILES_SIDE;
    t->size = t->size > 0 ? t->size : 1;
    t->columns = (band[2] + t->size - 1) / t->size;
    t->rows = (band[3] + t->size - 1) / t->size;
    for (int y = 0; y < t->rows; y++)
        for (int x = 0; x < t->columns; x++)
            t->full[y][x] = true;
}

void tiles_clear(tile_grid *t)
{
    memset(t->full, 0, sizeof t->full);
}

int tiles_mark(tile_grid *t, const int box[4], bool full)
{
    int first[2], last[2], count = 0;
    for (int k = 0; k < 2; k++) {
        const int low = box[k] - t->band[k], end = low + box[2 + k], most = (k ? t->rows : t->columns) - 1;
        first[k] = low > 0 ? low / t->size : 0;
        last[k] = end <= 0 || box[2 + k] <= 0 ? -1 : (end - 1) / t->size;
        last[k] = last[k] < most ? last[k] : most;
    }
    for (int y = first[1]; y <= last[1]; y++)
        for (int x = first[0]; x <= last[0]; x++, count++)
            t->full[y][x] = t->full[y][x] || full;
    return count;
}

/* Spreads the tiles that are full by whole tiles along one axis. */
static void spread(bool to[TILES_SIDE][TILES_SIDE], bool (*from)[TILES_SIDE], int reach, bool across)
{
    for (int y = 0; y < TILES_SIDE; y++)
        for (int x = 0; x < TILES_SIDE; x++) {
            to[y][x] = false;
            for (int k = -reach; k <= reach; k++) {
                int at_x = across ? x + k : x, at_y = across ? y : y + k;
                if (at_x >= 0 && at_x < TILES_SIDE && at_y >= 0 && at_y < TILES_SIDE && from[at_y][at_x])
                    to[y][x] = true;
            }
        }
}

/* A tile's box; those at the rim reach as far outwards as the margin, inside the limits. */
static void arrange(const tile_grid *t, int x, int y, int end, int margin, const int limits[4], int out[4])
{
    int low[2] = {t->band[0] + x * t->size, t->band[1] + y * t->size},
        high[2] = {t->band[0] + end * t->size, low[1] + t->size};
    const int first[2] = {x, y}, last[2] = {end, y + 1}, counts[2] = {t->columns, t->rows};
    for (int k = 0; k < 2; k++) {
        if (first[k] == 0)
            low[k] -= margin;
        if (last[k] == counts[k])
            high[k] = t->band[k] + t->band[2 + k] + margin;
        low[k] = low[k] > limits[k] ? low[k] : limits[k];
        high[k] = high[k] < limits[k] + limits[2 + k] ? high[k] : limits[k] + limits[2 + k];
        out[k] = low[k];
        out[2 + k] = high[k] > low[k] ? high[k] - low[k] : 0;
    }
}

size_t tiles_boxes(const tile_grid *t, int margin, const int limits[4], int (*out)[4])
{
    bool wide[TILES_SIDE][TILES_SIDE], both[TILES_SIDE][TILES_SIDE];
    int  reach = (margin + t->size - 1) / t->size;
    memcpy(both, t->full, sizeof both);
    spread(wide, both, reach, true);
    spread(both, wide, reach, false);
    size_t count = 0;
    for (int y = 0; y < t->rows; y++)
        for (int x = 0; x < t->columns;) {
            int end = x;
            while (end < t->columns && both[y][end])
                end++;
            if (end > x)
                arrange(t, x, y, end, margin, limits, out[count++]);
            x = end > x ? end : x + 1;
        }
    return count;
}
