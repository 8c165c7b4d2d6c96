/* Patterns of single marks: dots, loops, bricks, strokes in all directions. */
#include "stroke_texture/generate.h"

#include "base/memory.h"

static const double turn = 6.28318530717958648;

static position *allocate_positions(generator *g, size_t count, double uneven)
{
    position *positions = mem_calloc(count, sizeof *positions);
    if (!positions)
        g->failed = true;
    else
        generate_positions(g, positions, count, uneven);
    return positions;
}

void pattern_stipple(generator *g)
{
    position *positions = allocate_positions(g, g->count, g->uneven);
    for (size_t i = 0; !g->failed && i < g->count; i++)
        generate_stroke(g, positions[i], positions[i], 0);
    mem_free(positions);
}

void pattern_random(generator *g)
{
    position *positions = allocate_positions(g, g->count, g->uneven);
    double    angle = random_unit(&g->chance);
    for (size_t i = 0; !g->failed && i < g->count; i++) {
        /* Steps of the golden ratio are even in direction whatever is left out at the end. */
        angle += 0.61803398874989485 + 0.1 * g->uneven * random_hand(&g->chance);
        double half = 0.5 * g->length * (1 + 0.6 * g->uneven * random_hand(&g->chance));
        double du = half * cos(0.5 * turn * angle), dv = half * sin(0.5 * turn * angle);
        generate_stroke(g, (position){positions[i].u - du, positions[i].v - dv},
                        (position){positions[i].u + du, positions[i].v + dv}, 0);
    }
    mem_free(positions);
}

/* --- scribble --- */

enum { LOOPS = 9, LOOP_CHORDS = 17, SCRIBBLE_CHORDS = LOOPS * LOOP_CHORDS };

/* A pen that always turns the same way, now tighter, now wider: where it turns slowly it moves on, and so its loops
 * wander, none like another. */
static void scribble(generator *g, position middle, double heading)
{
    position points[SCRIBBLE_CHORDS + 1] = {{0, 0}};
    double   mean_u = 0, mean_v = 0, uneven = 0.5 + 0.5 * g->uneven, phases[3];
    double   step = g->length / SCRIBBLE_CHORDS * (1 + 0.5 * g->uneven * random_hand(&g->chance));
    double   side = random_unit(&g->chance) < 0.5 ? -1 : 1, pace = 1 + 0.12 * random_hand(&g->chance),
           direction = heading;
    for (int k = 0; k < 3; k++)
        phases[k] = turn * random_unit(&g->chance);
    for (int i = 0; i < SCRIBBLE_CHORDS; i++) {
        double t = (double)i / LOOP_CHORDS * pace;
        double swing = 0.8 * sin(0.91 * turn * t + phases[0]) + 0.8 * sin(0.41 * turn * t + phases[1]) +
                       0.5 * sin(1.57 * turn * t + phases[2]);
        direction += side * turn / LOOP_CHORDS * (1 + 0.6 * uneven * swing);
        points[i + 1] = (position){points[i].u + step * cos(direction), points[i].v + step * sin(direction)};
        mean_u += points[i + 1].u / SCRIBBLE_CHORDS;
        mean_v += points[i + 1].v / SCRIBBLE_CHORDS;
    }
    for (int i = 0; i <= SCRIBBLE_CHORDS; i++)
        points[i] = (position){middle.u + points[i].u - mean_u, middle.v + points[i].v - mean_v};
    generate_curve(g, points, SCRIBBLE_CHORDS + 1, 0);
}

void pattern_scribble(generator *g)
{
    size_t count = (g->count + SCRIBBLE_CHORDS / 2) / SCRIBBLE_CHORDS;
    count = count ? count : 1;
    position *positions = allocate_positions(g, count, 0.4 * g->uneven);
    sway      drift = sway_of(&g->chance, 1.2, 2);
    for (size_t i = 0; !g->failed && i < count; i++)
        scribble(g, positions[i], sway_at(&drift, positions[i]) + 0.6 * g->uneven * random_hand(&g->chance));
    mem_free(positions);
}

/* --- brick --- */

enum { EDGE_CHORDS = 3 };

/* One brick of the bond: its middle and half its sides, without the joint. */
typedef struct brick {
    double u, v, half_width, half_height;
} brick;

/* A position in the brick, −1 … 1 both ways. */
static position in_brick(const brick *b, double x, double y)
{
    return (position){b->u + x * b->half_width, b->v + y * b->half_height};
}

/* A line between two positions in a brick, slightly bowed. */
static void bowed(generator *g, const brick *b, position from, position to, int32_t layer)
{
    position points[EDGE_CHORDS + 1];
    double   bow = 0.1 * g->uneven * random_hand(&g->chance), du = to.u - from.u, dv = to.v - from.v;
    for (int i = 0; i <= EDGE_CHORDS; i++) {
        double t = (double)i / EDGE_CHORDS, lift = 4 * t * (1 - t) * bow * b->half_height;
        double length = fmax(hypot(du, dv), 1e-9);
        points[i] = (position){from.u + t * du - lift * dv / length, from.v + t * dv + lift * du / length};
    }
    generate_curve(g, points, EDGE_CHORDS + 1, layer);
}

/* An edge from corner to corner, now and then put down twice with a gap between; corners stay open. */
static void edge(generator *g, const brick *b, double x0, double y0, double x1, double y1)
{
    double shy = 0.05, wander = 0.05 * g->uneven;
    double begin = shy + 0.08 * g->uneven * random_hand(&g->chance),
           end = 1 - shy + 0.08 * g->uneven * random_hand(&g->chance);
    double a = wander * random_hand(&g->chance), c = wander * random_hand(&g->chance);
    bool   upright = x0 == x1, twice = !upright && random_unit(&g->chance) < 0.55 * g->uneven;
    double gap = 0.3 + 0.4 * random_unit(&g->chance), open = twice ? 0.035 + 0.05 * random_unit(&g->chance) : 0;
    double cuts[4] = {begin, twice ? gap - open : end, gap + open, end};
    for (int i = 0; i < (twice ? 2 : 1); i++) {
        double s = cuts[2 * i], t = cuts[2 * i + 1];
        double out_s = a + (c - a) * s, out_t = a + (c - a) * t;
        /* Aside from the edge by as much in the square, whichever way it runs. */
        double   aside = upright ? b->half_height / b->half_width : 1;
        position from = in_brick(b, x0 + s * (x1 - x0) + (upright ? aside * out_s : 0),
                                 y0 + s * (y1 - y0) + (upright ? 0 : 2 * out_s));
        position to = in_brick(b, x0 + t * (x1 - x0) + (upright ? aside * out_t : 0),
                               y0 + t * (y1 - y0) + (upright ? 0 : 2 * out_t));
        bowed(g, b, from, to, 0);
    }
}

/* How much of the way from a position in a brick to another stays at a distance from its edges; 0 … 1. */
static double fraction_inside(const brick *b, position from, position to)
{
    double fraction = 1, du = to.u - from.u, dv = to.v - from.v;
    double wall_u = b->u + (du < 0 ? -0.93 : 0.93) * b->half_width,
           wall_v = b->v + (dv < 0 ? -0.8 : 0.8) * b->half_height;
    if (du != 0)
        fraction = fmin(fraction, (wall_u - from.u) / du);
    if (dv != 0)
        fraction = fmin(fraction, (wall_v - from.v) / dv);
    return fmax(fraction, 0);
}

/* Short parallel scratches between two positions along a brick (−1 … 1), as shade is put on it: slanted, from its
 * lower edge. */
static void scratches(generator *g, const brick *b, double left, double right, double slant, int32_t layer)
{
    double low = -0.78 + 0.3 * random_unit(&g->chance) * g->uneven,
           pitch = 0.11 + 0.04 * g->uneven * random_hand(&g->chance);
    for (double x = left; x < right; x += pitch * (1 + 0.6 * g->uneven * random_hand(&g->chance))) {
        double   reach = g->length * (0.95 + 0.4 * g->uneven * random_hand(&g->chance));
        position from = in_brick(b, x, low + 0.2 * g->uneven * random_hand(&g->chance));
        position to = {from.u + reach * cos(slant), from.v + reach * sin(slant)};
        double   fraction = fraction_inside(b, from, to);
        if (fraction > 0.4)
            generate_stroke(
                g, from, (position){from.u + fraction * (to.u - from.u), from.v + fraction * (to.v - from.v)}, layer);
    }
}

static void one_brick(generator *g, const brick *b)
{
    edge(g, b, -1, -1, 1, -1);
    edge(g, b, 1, -1, 1, 1);
    edge(g, b, 1, 1, -1, 1);
    edge(g, b, -1, 1, -1, -1);
    /* Not every brick has the same shade: some are left bare, some are scratched all over, or crosswise. */
    double shade = random_unit(&g->chance), slant = 0.75 + 0.3 * g->uneven * random_hand(&g->chance);
    if (shade >= 0.35 * g->uneven)
        scratches(g, b, 0.8 - 1.0 * shade + 0.2 * random_signed(&g->chance), 0.85, slant, 1);
    if (shade >= 0.6 * g->uneven)
        scratches(g, b, -0.9, 0.1 + 0.4 * random_signed(&g->chance), slant, 2);
    else if (shade < 0.2 * g->uneven)
        scratches(g, b, -0.5 + 0.4 * random_signed(&g->chance), 0.9, 3.14 - slant, 2);
}

/* A running bond: each course is moved by half a brick. Bricks are nearly three times as long as they are high. */
void pattern_brick(generator *g)
{
    enum { STROKES_A_BRICK = 22 };
    size_t across = (size_t)fmax(1, floor(sqrt((double)g->count / STROKES_A_BRICK / 2.5) + 0.5));
    size_t courses = 2 * (size_t)fmax(1, floor(1.25 * (double)across + 0.5));
    double width = 1 / (double)across, height = 1 / (double)courses, joint = 0.08 * height;
    for (size_t y = 0; y < courses; y++)
        for (size_t x = 0; x < across && !g->failed; x++) {
            double shift = y % 2 ? 0.5 : 0;
            brick  b = {((double)x + shift + 0.5) * width, ((double)y + 0.5) * height, 0.5 * width - joint,
                        0.5 * height - joint};
            b.u += 0.12 * height * g->uneven * random_hand(&g->chance);
            b.half_width += 0.1 * height * g->uneven * random_hand(&g->chance);
            one_brick(g, &b);
        }
}
