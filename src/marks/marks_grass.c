/* Grass, hair, fur: tufts of blades that stand on the surface, strewn as evenly as dots are, bent over to one side.
 * Freudenberg 2003, figure 6.21 (particle grass, which the text does not explain); row IM-34. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/random.h"
#include "marks/d3.h"
#include "marks/marks.h"

enum { PIECES = 4 };

typedef struct growth {
    const grass_options *options;
    marks               *out;
    random_source        random;
} growth;

static d3 scaled(d3 a, double by)
{
    return (d3){by * a.x, by * a.y, by * a.z};
}

static d3 plus(d3 a, d3 b)
{
    return (d3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static d3 unit_or(d3 a, d3 other)
{
    double length = sqrt(dot(a, a));
    return length > 1e-9 ? scaled(a, 1 / length) : other;
}

static vec3 rounded(d3 a)
{
    return (vec3){(float)a.x, (float)a.y, (float)a.z};
}

/* What is left of a direction in the plane across a normal. */
static d3 across(d3 a, d3 normal)
{
    return minus(a, scaled(normal, dot(a, normal)));
}

/* Nothing grows into the surface, nor along it. */
static d3 off_surface(d3 way, d3 normal)
{
    const double LEAST = 0.15; /* cosine with the normal */
    double       out = dot(way, normal);
    return out < LEAST ? unit_or(plus(way, scaled(normal, LEAST - out)), normal) : way;
}

/* The way in which blades grow where none leans: between the surface's normal and upwards. */
static d3 way_up(const growth *g, d3 normal)
{
    double upright = g->options->upright;
    return off_surface(unit_or(plus(scaled(normal, 1 - upright), scaled(of(g->options->up), upright)), normal), normal);
}

/* What grows upwards does not grow on what looks down, and hair everywhere. */
static bool grows_there(growth *g, d3 normal)
{
    const double SCATTER = 0.12; /* so that it ends at no line */
    return dot(normal, of(g->options->up)) > 1.25 * g->options->upright - 1.2 + SCATTER * random_signed(&g->random);
}

/* Where a blade leans: down the slope, and on level ground the same way everywhere, or anywhere. */
static d3 side_of(growth *g, d3 normal, d3 way)
{
    const d3 wind = {0.8, 0.36, 0.48}, other = {0.36, 0.48, -0.8};
    d3       down = across(scaled(of(g->options->up), -1), normal), any = {0, 0, 0};
    double   slope = sqrt(dot(down, down));
    down = plus(down, scaled(unit_or(across(wind, normal), across(other, normal)), 0.3 * (1 - slope)));
    any = (d3){random_signed(&g->random), random_signed(&g->random), random_signed(&g->random)};
    any = unit_or(across(any, normal), other);
    d3 both = plus(scaled(unit_or(down, any), g->options->combed), scaled(any, 1 - g->options->combed));
    return unit_or(across(both, way), unit_or(across(other, way), wind));
}

/* A blade bends over more and more: at its root by half of what it leans, at its tip by half more. */
static bool add_blade(growth *g, const mark_dot *seed, d3 root, double length)
{
    marks *m = g->out;
    if (!mem_grow((void **)&m->lines, &m->line_capacity, m->line_count + PIECES, sizeof *m->lines))
        return false;
    d3     normal = of(seed->normal), way = way_up(g, normal), side = side_of(g, normal, way), at = root;
    double lean = g->options->lean * (1 + g->options->uneven * random_hand(&g->random));
    size_t first = m->line_count;
    for (int i = 0; i < PIECES; i++) {
        double angle = lean * (0.5 + (i + 0.5) / PIECES);
        d3     step = off_surface(plus(scaled(way, cos(angle)), scaled(side, sin(angle))), normal),
           next = plus(at, scaled(step, length / PIECES));
        m->lines[m->line_count++] = (mark_line){.a = rounded(at),
                                                .b = rounded(next),
                                                .normal = seed->normal,
                                                .middle = seed->position,
                                                .middle_normal = seed->normal,
                                                .light = 1,
                                                .perspective = seed->priority,
                                                .span = 1,
                                                .from = (float)(i * length / PIECES),
                                                .to = (float)((i + 1) * length / PIECES),
                                                .length = (float)length,
                                                .bright = 1,
                                                .triangle = seed->triangle,
                                                .stroke = (uint32_t)m->stroke_count};
        at = next;
    }
    mark_stroke_middle(&m->lines[first], PIECES);
    m->stroke_count++;
    m->line_length += length;
    return true;
}

static bool add_tuft(growth *g, const mark_dot *seed)
{
    const grass_options *w = g->options;
    const double         WIDE = 0.12; /* of tufts, in lengths of blades */
    d3                   normal = of(seed->normal), other = {0.36, 0.48, -0.8};
    bool                 done = true;
    for (int i = 0; i < w->tuft && done; i++) {
        d3     aside = {random_hand(&g->random), random_hand(&g->random), random_hand(&g->random)};
        double length = w->length * (1 + 0.6 * w->uneven * random_signed(&g->random));
        aside = w->tuft > 1 ? scaled(across(aside, normal), WIDE * w->length) : scaled(other, 0);
        done = add_blade(g, seed, plus(of(seed->position), aside), length);
    }
    return done;
}

lmn_status marks_grass(marks *out, const mark_surface *s, const grass_options *w, lmn_error *error)
{
    marks  seeds;
    growth g = {.options = w, .out = out};
    memset(out, 0, sizeof *out);
    out->area = mark_surface_area(s);
    if (!(out->area > 0))
        return LMN_OK;
    if (w->count > LIMIT_MARKS / PIECES)
        return error_set(error, LMN_LIMIT, "%zu blades are more than %d", w->count, LIMIT_MARKS / PIECES);
    lmn_status status = marks_stipple(&seeds, s, (w->count + (size_t)w->tuft - 1) / (size_t)w->tuft, w->seed, error);
    for (size_t i = 0; i < seeds.dot_count && status == LMN_OK; i++) {
        g.random = random_start(w->seed, 0x6A55u ^ (uint32_t)i * 2654435761u);
        if (grows_there(&g, of(seeds.dots[i].normal)) && !add_tuft(&g, &seeds.dots[i]))
            status = error_memory(error);
    }
    const size_t places = seeds.dot_count;
    surface_marks_release(&seeds);
    /* To a unit of the area that they grow on: places without any are no sparse ones. */
    double grown = out->area * (double)out->stroke_count / fmax((double)(places * (size_t)w->tuft), 1);
    for (size_t i = 0; i < out->line_count; i++)
        out->lines[i].density = (float)(out->line_length / grown);
    if (status != LMN_OK)
        surface_marks_release(out);
    return status;
}
