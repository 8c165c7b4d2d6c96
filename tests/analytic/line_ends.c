/* Lines that are found in pixels run out on a smooth body in one end, which may fade, and not in dots: dark pixels are
 * in pieces of ink no smaller than a line may be. */
#include <stdlib.h>

#include "check.h"
#include "shot.h"

enum { DARK = 127, FAINT = 230, SMALLEST = 12 };

static bool is_inked(const shot *s, int x, int y)
{
    return x >= 0 && y >= 0 && x < s->width && y < s->height && shot_ink(s, x, y) <= FAINT;
}

/* Dark pixels of the piece of ink around the one at `first`, which is marked; `stack` has room for all pixels. */
static int piece_size(const shot *s, int first, bool *marked, int *stack)
{
    int size = 0, waiting = 0;
    marked[first] = true;
    stack[waiting++] = first;
    while (waiting > 0) {
        int at = stack[--waiting], x = at % s->width, y = at / s->width;
        size += shot_ink(s, x, y) <= DARK ? 1 : 0;
        for (int k = 0; k < 9; k++) {
            int beside_x = x + k % 3 - 1, beside_y = y + k / 3 - 1, beside = beside_y * s->width + beside_x;
            if (is_inked(s, beside_x, beside_y) && !marked[beside]) {
                marked[beside] = true;
                stack[waiting++] = beside;
            }
        }
    }
    return size;
}

static int count_dots(const shot *s)
{
    size_t pixels = (size_t)s->width * (size_t)s->height;
    bool  *marked = check_alloc(pixels, sizeof *marked);
    int   *stack = check_alloc(pixels, sizeof *stack), dots = 0;
    for (int i = 0; i < s->width * s->height; i++)
        if (!marked[i] && is_inked(s, i % s->width, i / s->width)) {
            int size = piece_size(s, i, marked, stack);
            if (size > 0 && size < SMALLEST) {
                check_note("a piece of %d dark pixels around %d, %d", size, i % s->width, i / s->width);
                dots++;
            }
        }
    free(stack);
    free(marked);
    return dots;
}

static void run_model(const char *model, int side)
{
    shot      s;
    shot_view view = {.width = side, .height = side, .bare = true};
    if (shot_take(&s, model, "edges", NULL, &view)) {
        check_at_most("ends", count_dots(&s), 0, "%s at %d: dots", model, side);
        shot_release(&s);
    }
}

static void run_spot(void)
{
    for (int side = 512; side <= 2048; side *= 2)
        run_model(LIMNER_EXAMPLES "/spot.obj", side);
}

static void run_fox(void)
{
    for (int side = 512; side <= 2048; side *= 2)
        run_model(LIMNER_EXAMPLES "/fox.glb", side);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"spot", run_spot}, {"fox", run_fox}};
    int                     status = check_main(argc, argv, "line_ends", cases, 2);
    shot_end();
    return status;
}
