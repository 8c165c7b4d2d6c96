/* Directions for a whole surface from what some of it is sure of: a field of crosses, which are the same when turned by
 * a right angle, as smooth over the surface as that allows (connection.h); and of the two arms of each cross that along
 * which strokes are laid. Directions are complex numbers in an element's own tangents, whose angle is four times that
 * of an arm, or twice that of a line; from one element to the next they are turned by the least rotation that takes one
 * normal to the other. */
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "base/work.h"
#include "field/connection.h"
#include "field/direction_field_private.h"

enum { PIECE = 8192, SWEEPS_BESIDE_FLATS = 12 };

static const double sure_from = 0.1;    /* below, a direction of its own fades out as one of the field fades in */
static const double carried = 0.05;     /* how sure those are */
static const double sure_enough = 0.03; /* to say how a flat piece beside it lies */
/* Fractions of the diagonal over which a sure direction, and the upright where nothing else is known, have their way.
 */
static const double sharpness = 0.02, upright_reach = 1;
/* Of creases, and of borders, where what is sure goes on beyond more often than not, to a link. */
static const double hold_of_crease = 2.5, hold_of_border = 1;
static const double straight_from = 0.9;
/* How much less an arm is held by its own bend than a cross is: few changes of arms matter more. */
static const double by_bend = 0.03;
static const double settled = 0.5; /* an arm that is this sure is */

typedef struct crosser {
    const field_surface *surface;
    tensor              *own, *units;
    const bool          *flat;
    bool                *sure;
    connection           graph;
    complex_number      *crosses, *arms;  /* arms: real */
    complex_number      *lines;           /* per element: the first arm of its cross, twice its angle */
    complex_number      *borders;         /* per element: border edges that end there, twice their angles, by length */
    float               *border, *crease; /* their length, and that of creases among them */
    float               *straight;        /* how straight they run, 0 … 1 */
    float               *length;          /* room for one an element */
    double               by_data, by_upright;
    double               trust; /* in creases, 0 … 1: where most of them are ragged, they are noise */
} crosser;

bool field_unit_in_plane(point3 normal, const tensor *t, tensor *out)
{
    point3 u, v;
    double a, b;
    tangents(normal, &u, &v);
    tensor_traceless(t, u, v, &a, &b);
    double length = hypot(a, b);
    if (!(length > 1e-9))
        return false;
    *out = tensor_of(u, v, a / length, b / length, 0);
    return true;
}

static complex_number squared(complex_number a)
{
    return complex_product(a, a);
}

static complex_number halved(complex_number a)
{
    float angle = atan2f(a.im, a.re) / 2;
    return (complex_number){cosf(angle), sinf(angle)};
}

/* How sure a tensor is in an element's plane, and its line. */
static double line_of(const crosser *c, const tensor *t, uint32_t e, complex_number *line)
{
    point3 u, v;
    double a, b;
    tangents(c->surface->normals[e], &u, &v);
    tensor_traceless(t, u, v, &a, &b);
    double length = hypot(a, b);
    *line = length > 0 ? (complex_number){(float)(a / length), (float)(b / length)} : (complex_number){0, 0};
    return length;
}

/* The level line through an element, twice its angle, and how steep it is there, squared. */
static double level_of(const crosser *c, uint32_t e, complex_number *line)
{
    const point3 upright = {0, 1, 0};
    point3       u, v, level = point_cross(upright, c->surface->normals[e]);
    double       steep = point_dot(level, level);
    tangents(c->surface->normals[e], &u, &v);
    complex_number once = {(float)point_dot(level, u), (float)point_dot(level, v)};
    *line = steep > 1e-12 ? squared(once) : (complex_number){0, 0};
    if (steep > 1e-12)
        *line = (complex_number){line->re / (float)steep, line->im / (float)steep};
    return steep;
}

/* --- links ---------------------------------------------------------------------------------------------- */

/* By twice how much a line at `from` is turned on its way to `to`; returns how well their normals agree. */
static double turn_between(const field_surface *s, uint32_t to, uint32_t from, complex_number *turn)
{
    point3 n = s->normals[to], m = s->normals[from], u, v, x, y;
    double agree = point_dot(n, m);
    tangents(n, &u, &v);
    tangents(m, &x, &y);
    *turn = (complex_number){1, 0};
    if (!(agree > -0.999))
        return 0;
    point3         moved = point_sub(x, point_scale(point_add(n, m), point_dot(n, x) / (1 + agree)));
    complex_number once = {(float)point_dot(moved, u), (float)point_dot(moved, v)};
    float          square = once.re * once.re + once.im * once.im;
    if (square > 0)
        *turn = complex_product(once, (complex_number){once.re / square, once.im / square});
    return fmax(agree, 0);
}

/* Each edge once: at borders and creases, where triangles do not go on, and at the lower of two half-edges. */
static bool is_first_half(const field_surface *s, uint32_t h)
{
    return s->opposite[h] == NOWHERE || h < s->opposite[h];
}

static uint32_t other_end(const field_surface *s, uint32_t h)
{
    return s->corners[h % 3 == 2 ? h - 2 : h + 1];
}

static bool link_elements(crosser *c)
{
    const field_surface *s = c->surface;
    connection          *g = &c->graph;
    uint32_t             half_edges = 3 * s->triangle_count;
    g->count = s->element_count;
    g->starts = mem_calloc((size_t)g->count + 2, sizeof *g->starts);
    g->links_hold = mem_alloc((size_t)g->count * sizeof *g->links_hold);
    g->hold = mem_alloc((size_t)g->count * sizeof *g->hold);
    g->source = mem_alloc((size_t)g->count * sizeof *g->source);
    if (!g->starts || !g->links_hold || !g->hold || !g->source)
        return false;
    for (uint32_t h = 0; h < half_edges; h++)
        if (is_first_half(s, h)) {
            g->starts[s->corners[h] + 2]++;
            g->starts[other_end(s, h) + 2]++;
        }
    for (uint32_t e = 0; e < g->count; e++)
        g->starts[e + 2] += g->starts[e + 1];
    g->links = mem_alloc((size_t)g->starts[g->count + 1] * sizeof *g->links + sizeof *g->links);
    for (uint32_t h = 0; g->links && h < half_edges; h++)
        if (is_first_half(s, h)) {
            uint32_t a = s->corners[h], b = other_end(s, h);
            g->links[g->starts[a + 1]++].other = b;
            g->links[g->starts[b + 1]++].other = a;
        }
    return g->links != NULL;
}

static void add_borders(crosser *c)
{
    const field_surface *s = c->surface;
    for (uint32_t h = 0; h < 3 * s->triangle_count; h++) {
        if (s->opposite[h] != NOWHERE)
            continue;
        uint32_t ends[2] = {s->corners[h], other_end(s, h)};
        point3   edge = point_sub(s->positions[ends[1]], s->positions[ends[0]]);
        for (int k = 0; k < 2; k++) {
            point3 u, v;
            tangents(s->normals[ends[k]], &u, &v);
            complex_number once = {(float)point_dot(edge, u), (float)point_dot(edge, v)};
            float          square = once.re * once.re + once.im * once.im, length = sqrtf(square);
            if (!(square > 0))
                continue;
            complex_number twice = squared((complex_number){once.re / length, once.im / length});
            c->borders[ends[k]].re += length * twice.re;
            c->borders[ends[k]].im += length * twice.im;
            c->border[ends[k]] += length;
            c->crease[ends[k]] += s->features[h] ? length : 0;
        }
    }
}

/* Borders count where they run on straight, at the next elements too: corners do not, nor ragged ends of scans, nor the
 * rims of single triangles that noise has folded. */
static void find_straight_borders(crosser *c)
{
    const field_surface *s = c->surface;
    float               *own = c->length;
    for (uint32_t e = 0; e < s->element_count; e++) {
        complex_number *b = &c->borders[e];
        float           size = sqrtf(b->re * b->re + b->im * b->im);
        own[e] = c->straight[e] = c->border[e] > 0 ? size / c->border[e] : 0;
        *b = size > 0 ? (complex_number){b->re / size, b->im / size} : (complex_number){0, 0};
    }
    for (uint32_t h = 0; h < 3 * s->triangle_count; h++) {
        if (s->opposite[h] != NOWHERE)
            continue;
        uint32_t a = s->corners[h], b = other_end(s, h);
        c->straight[a] = fminf(c->straight[a], own[b]);
        c->straight[b] = fminf(c->straight[b], own[a]);
    }
    double sum = 0, count = 0;
    for (uint32_t e = 0; e < s->element_count; e++)
        if (c->crease[e] > 0) {
            sum += (double)c->straight[e];
            count++;
        }
    c->trust = count > 0 ? smooth_step(0.3, 0.8, sum / count) : 0;
}

/* --- crosses -------------------------------------------------------------------------------------------- */

static void add_wish(connection *g, uint32_t e, complex_number wish, double hold)
{
    g->hold[e] += (float)hold;
    g->source[e].re += (float)hold * wish.re;
    g->source[e].im += (float)hold * wish.im;
}

static void wish_crosses(size_t begin, size_t end, void *user)
{
    crosser    *c = user;
    connection *g = &c->graph;
    for (uint32_t e = (uint32_t)begin; e < end; e++) {
        complex_number line;
        double         sum = 0;
        for (uint32_t k = g->starts[e]; k < g->starts[e + 1]; k++) {
            complex_number turn;
            double         agree = turn_between(c->surface, e, g->links[k].other, &turn);
            complex_number four = squared(turn);
            float          weight = (float)(agree * agree);
            g->links[k].pull = (complex_number){weight * four.re, weight * four.im};
            sum += (double)weight;
        }
        g->links_hold[e] = (float)sum;
        g->hold[e] = 0;
        g->source[e] = (complex_number){0, 0};
        double steep = level_of(c, e, &line);
        add_wish(g, e, squared(line), c->by_upright * steep);
        if (!c->flat[e]) {
            double sure = line_of(c, &c->own[e], e, &line);
            add_wish(g, e, squared(line), c->by_data * sure * sure);
        }
        if (c->straight[e] > straight_from)
            add_wish(g, e, squared(c->borders[e]),
                     (c->crease[e] > 0.5f * c->border[e] ? c->trust * hold_of_crease : hold_of_border) *
                         smooth_step(straight_from, 1, (double)c->straight[e]));
    }
}

/* Flat pieces have one direction each, to which what lies beside them gives way. */
static bool settle_flats(crosser *c)
{
    const field_surface *s = c->surface;
    bool                 any = false;
    for (uint32_t e = 0; e < s->element_count; e++) {
        complex_number line;
        any = any || c->flat[e];
        c->sure[e] = !c->flat[e] && line_of(c, &c->own[e], e, &line) >= sure_enough &&
                     field_unit_in_plane(s->normals[e], &c->own[e], &c->units[e]);
    }
    if (!any)
        return true;
    if (!field_flat_directions(s, c->flat, c->sure, c->units))
        return false;
    for (uint32_t e = 0; e < s->element_count; e++) {
        complex_number line;
        if (c->flat[e] && line_of(c, &c->units[e], e, &line) > 0)
            c->crosses[e] = squared(line);
    }
    connection_relax(&c->graph, c->crosses, c->flat, SWEEPS_BESIDE_FLATS);
    return !work_stopped();
}

/* --- arms ----------------------------------------------------------------------------------------------- */

static void find_lines(size_t begin, size_t end, void *user)
{
    crosser *c = user;
    for (size_t e = begin; e < end; e++)
        c->lines[e] = halved(c->crosses[e]);
}

static float alike(complex_number a, complex_number b)
{
    return a.re * b.re + a.im * b.im;
}

/* Arms are to be those of the greater bend, those of flat pieces, else level, and go on from one element to the next.
 */
static void wish_arms(size_t begin, size_t end, void *user)
{
    crosser    *c = user;
    connection *g = &c->graph;
    for (uint32_t e = (uint32_t)begin; e < end; e++) {
        complex_number line;
        double         sum = 0;
        for (uint32_t k = g->starts[e]; k < g->starts[e + 1]; k++) {
            complex_number turn;
            double         agree = turn_between(c->surface, e, g->links[k].other, &turn);
            float          fits =
                (float)(agree * agree) * alike(c->lines[e], complex_product(turn, c->lines[g->links[k].other]));
            g->links[k].pull = (complex_number){fits, 0};
            sum += fabs((double)fits);
        }
        g->links_hold[e] = (float)sum;
        g->hold[e] = 0;
        g->source[e] = (complex_number){0, 0};
        double steep = level_of(c, e, &line);
        add_wish(g, e, (complex_number){alike(line, c->lines[e]), 0}, c->by_upright * steep);
        double sure = c->flat[e] ? line_of(c, &c->units[e], e, &line) : line_of(c, &c->own[e], e, &line);
        add_wish(g, e, (complex_number){alike(line, c->lines[e]), 0},
                 (c->flat[e] ? 10 * sure : by_bend * c->by_data) * sure);
    }
}

/* What is to stand there: the arm, as sure as the surface was. */
static void set_tensors(size_t begin, size_t end, void *user)
{
    crosser *c = user;
    for (uint32_t e = (uint32_t)begin; e < end; e++) {
        complex_number own;
        point3         u, v;
        double         sure = line_of(c, &c->own[e], e, &own), kept = smooth_step(0, sure_from, sure);
        double         arm = c->arms[e].re < 0 ? -1 : 1, fits = arm * (double)alike(own, c->lines[e]);
        /* Where arms change, or others than the surface's own are taken, nothing is sure. */
        kept *= fmax(fits, 0) * smooth_step(0, settled, fabs((double)c->arms[e].re));
        double s = fmin(kept * sure + carried * (1 - kept), 1);
        tangents(c->surface->normals[e], &u, &v);
        if (c->flat[e]) {
            complex_number line;
            bool           there = line_of(c, &c->units[e], e, &line) > 0;
            for (int k = 0; k < 6; k++)
                c->own[e].v[k] = there ? (float)carried * c->units[e].v[k] : 0;
            continue;
        }
        c->own[e] = tensor_of(u, v, arm * s * (double)c->lines[e].re, arm * s * (double)c->lines[e].im, 0);
    }
}

static bool cross(crosser *c)
{
    size_t count = c->surface->element_count;
    if (!link_elements(c))
        return false;
    add_borders(c);
    find_straight_borders(c);
    threads_for(count, PIECE, wish_crosses, c);
    if (!connection_solve(&c->graph, c->crosses) || !settle_flats(c))
        return false;
    threads_for(count, PIECE, find_lines, c);
    threads_for(count, PIECE, wish_arms, c);
    if (!connection_solve(&c->graph, c->arms) || !field_join_arms(&c->graph, c->arms))
        return false;
    threads_for(count, PIECE, set_tensors, c);
    return true;
}

bool field_cross(const field_surface *s, tensor *own, const bool *flat, bool rough)
{
    size_t  count = s->element_count;
    double  edge = s->mean_edge, sharp = edge / sharpness, far = edge / upright_reach;
    crosser c = {.surface = s, .own = own, .flat = flat};
    c.by_data = fmin(fmax(25 * sharp * sharp, 1), 10) * (rough ? 0.1 : 1);
    c.by_upright = fmin(fmax(far * far, 1e-6), 0.02);
    c.units = mem_calloc(count, sizeof *c.units);
    c.sure = mem_calloc(count, sizeof *c.sure);
    c.crosses = mem_calloc(count, sizeof *c.crosses);
    c.arms = mem_calloc(count, sizeof *c.arms);
    c.lines = mem_calloc(count, sizeof *c.lines);
    c.borders = mem_calloc(count, sizeof *c.borders);
    c.border = mem_calloc(count, sizeof *c.border);
    c.crease = mem_calloc(count, sizeof *c.crease);
    c.straight = mem_calloc(count, sizeof *c.straight);
    c.length = mem_alloc(count * sizeof *c.length);
    bool good = c.units && c.sure && c.crosses && c.arms && c.lines && c.borders && c.border && c.crease &&
                c.straight && c.length && cross(&c);
    connection_release(&c.graph);
    void *const blocks[] = {c.units,   c.sure,   c.crosses, c.arms,     c.lines,
                            c.borders, c.border, c.crease,  c.straight, c.length};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    return good;
}
