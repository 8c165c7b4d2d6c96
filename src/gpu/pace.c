/* Pieces: on a software driver long draws are cut, so that a call can be stopped between them and the driver's
 * queue stays short. Cutting changes no pixel: pieces of a screen are the same triangle inside another scissor box,
 * pieces of a mesh are its triangles in order. */
#include "gpu/gpu_private.h"

#include "base/clock.h"
#include "base/work.h"

/* A software driver bins triangles faster than it fills them and keeps every bin in memory: without a stop, a
 * million triangles held 110 MiB; with one, a frame takes an eighth longer. */
enum { INDICES_MOST = 900000, INDICES_LEAST = 3000, PIXELS_MOST = 1 << 20, PIXELS_LEAST = 1 << 14 };

/* A piece that takes longer is halved next time, one that takes less than a quarter may double. */
enum { PIECE_MS = 80, FINISH_MS = 50 };

void pace_start(gpu *g)
{
    g->piece_indices = INDICES_MOST;
    g->piece_pixels = PIXELS_MOST;
    g->finished_ms = clock_ms();
}

bool pace_goes_on(gpu *g)
{
    if (g->failed || !g->program)
        return false;
    if (work_stopped())
        gpu_fail(g, LMN_CANCELLED, "stopped while drawing");
    return !g->failed;
}

static int clamped(int value, int least, int most)
{
    return value < least ? least : value > most ? most : value;
}

void pace_drawn(gpu *g, uint32_t indices, int64_t pixels)
{
    if (!g->capabilities.software)
        return;
    g->indices_in_flight += indices;
    g->pixels_in_flight += pixels;
    double before = clock_ms();
    if (g->indices_in_flight < (uint32_t)g->piece_indices && g->pixels_in_flight < g->piece_pixels &&
        before - g->finished_ms < FINISH_MS)
        return;
    bool by_indices = g->indices_in_flight >= (uint32_t)g->piece_indices,
         by_pixels = g->pixels_in_flight >= g->piece_pixels;
    gpu_finish(g);
    double took = clock_ms() - before;
    int    change = took > PIECE_MS ? -1 : took < PIECE_MS / 4.0 ? 1 : 0;
    if (by_indices || change < 0)
        g->piece_indices =
            clamped(change < 0 ? g->piece_indices / 2 : g->piece_indices << change, INDICES_LEAST, INDICES_MOST);
    if (by_pixels || change < 0)
        g->piece_pixels =
            clamped(change < 0 ? g->piece_pixels / 2 : g->piece_pixels << change, PIXELS_LEAST, PIXELS_MOST);
    work_check(NULL);
}

uint32_t pace_indices(const gpu *g, uint32_t count)
{
    return g->capabilities.software && count > (uint32_t)g->piece_indices ? (uint32_t)g->piece_indices / 3 * 3 : count;
}

/* Whole blocks of sixteen rows, which is what the driver works on. */
int pace_rows(const gpu *g, int width, int height)
{
    enum { BLOCK = 16 };
    int rows = g->capabilities.software && width > 0 ? g->piece_pixels / width / BLOCK * BLOCK : height;
    return rows < BLOCK ? BLOCK : rows;
}
