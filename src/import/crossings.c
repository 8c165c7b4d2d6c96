#include "import/crossings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "scene/city.h"
#include "scene/content.h"

/* As edge_saying in stroke/edges.h has them. */
enum { SHOWN_NEVER = 0, SHOWN_AS_ALWAYS = 4 };
enum { CUTS_MOST = 24, GRID_MOST = 1024 };
/* Metres: a rim that lies so little beside a road lies on it; surfaces that lie so much over it do not. Water and green
 * lie that much below roads at most. */
static const double BESIDE = 0.002, OVER = 0.075, BELOW = 0.4;
/* Roads that lie on each other are raised in such steps until none is as high as another. */
static const double STEP = 0.002, OVERLAPS = 0.05;
enum { LEVELS = 12 };

typedef struct road_face {
    uint32_t owner;
    vec3     at[3]; /* anticlockwise from above */
} road_face;

typedef struct road_grid {
    road_face *faces;
    uint32_t  *first, *items; /* of cells: where their faces begin among the items */
    size_t     face_count;
    int        side;
    double     low[2], cell;
} road_grid;

/* What of a triangle's edge lies on other roads: pieces from one cut to the next, from 0 to 1. */
typedef struct rim {
    double cuts[CUTS_MOST];
    bool   hidden[CUTS_MOST + 1];
    int    count;
} rim;

/* --- roads ---------------------------------------------------------------------------------------------- */

/* The mesh of a node that is a road laid flat, or what lies below roads; NULL: it is none. */
static mesh *laid_flat(lmn_scene *s, size_t node_index, bool road)
{
    const node *n = &s->nodes[node_index];
    const char *word = scene_attribute_of(s, (int32_t)node_index, CITY_SURFACE_KEY);
    if (n->mesh == NONE || n->has_matrix || n->instance_count || !word)
        return NULL;
    bool below = strcmp(word, "water") == 0 || strcmp(word, "plant") == 0 || strcmp(word, "land") == 0;
    if (road ? strcmp(word, "road") != 0 : !below)
        return NULL;
    mesh *m = &s->meshes[n->mesh];
    bool  plain = m->primitive_count == 1;
    if (plain) {
        const primitive *p = &m->primitives[0];
        plain = !p->normals && !p->uvs[0] && !p->colours && !p->edges.values && p->index_count;
    }
    return plain ? m : NULL;
}

static mesh *road_of(lmn_scene *s, size_t node_index)
{
    return laid_flat(s, node_index, true);
}

static road_face face_of(const primitive *p, uint32_t first, uint32_t owner)
{
    road_face f = {.owner = owner};
    for (uint32_t k = 0; k < 3; k++)
        f.at[k] = p->positions[p->indices[first + k]];
    double turn = ((double)f.at[1].x - (double)f.at[0].x) * ((double)f.at[2].y - (double)f.at[0].y) -
                  ((double)f.at[1].y - (double)f.at[0].y) * ((double)f.at[2].x - (double)f.at[0].x);
    if (turn < 0) {
        vec3 second = f.at[1];
        f.at[1] = f.at[2];
        f.at[2] = second;
    }
    return f;
}

static bool gather(lmn_scene *s, road_grid *g)
{
    size_t capacity = 0;
    for (size_t i = 0; i < s->node_count; i++) {
        const mesh *m = road_of(s, i);
        for (uint32_t k = 0; m && k < m->primitives[0].index_count; k += 3) {
            if (!mem_grow((void **)&g->faces, &capacity, g->face_count + 1, sizeof *g->faces))
                return false;
            g->faces[g->face_count++] = face_of(&m->primitives[0], k, (uint32_t)i);
        }
    }
    return true;
}

/* --- the grid ------------------------------------------------------------------------------------------- */

/* The cells that a box touches: columns, then rows, first and last. */
static void cells_of(const road_grid *g, const double low[2], const double high[2], int out[4])
{
    for (int k = 0; k < 2; k++) {
        out[2 * k] = (int)fmin(fmax((low[k] - BESIDE - g->low[k]) / g->cell, 0), g->side - 1);
        out[2 * k + 1] = (int)fmin(fmax((high[k] + BESIDE - g->low[k]) / g->cell, 0), g->side - 1);
    }
}

static void box_of(const vec3 *at, int count, double low[2], double high[2])
{
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (int i = 0; i < count; i++) {
        const double p[2] = {(double)at[i].x, (double)at[i].y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], p[k]);
        }
    }
}

static bool lay_grid(road_grid *g)
{
    double high[2] = {-INFINITY, -INFINITY}, own[2][2];
    int    cells[4];
    g->low[0] = g->low[1] = INFINITY;
    for (size_t i = 0; i < g->face_count; i++) {
        box_of(g->faces[i].at, 3, own[0], own[1]);
        for (int k = 0; k < 2; k++) {
            g->low[k] = fmin(g->low[k], own[0][k]);
            high[k] = fmax(high[k], own[1][k]);
        }
    }
    g->side = (int)fmin(fmax(sqrt((double)g->face_count), 1), GRID_MOST);
    g->cell = fmax(fmax(high[0] - g->low[0], high[1] - g->low[1]) / g->side, 1e-3);
    size_t cell_count = (size_t)g->side * (size_t)g->side, count = 0;
    g->first = mem_calloc(cell_count + 2, sizeof *g->first);
    for (int round = 0; round < 2 && g->first; round++) { /* counts, then fills */
        for (size_t i = 0; i < g->face_count; i++) {
            box_of(g->faces[i].at, 3, own[0], own[1]);
            cells_of(g, own[0], own[1], cells);
            for (int y = cells[2]; y <= cells[3]; y++)
                for (int x = cells[0]; x <= cells[1]; x++) {
                    uint32_t *at = &g->first[(size_t)y * (size_t)g->side + (size_t)x + 1];
                    if (round)
                        g->items[--at[0]] = (uint32_t)i;
                    else
                        at[0]++;
                }
        }
        for (size_t c = 1; c <= cell_count && !round; c++) {
            count += g->first[c];
            g->first[c] = (uint32_t)count;
        }
        if (!round && !(g->items = mem_alloc((count + 1) * sizeof *g->items)))
            return false;
        if (!round)
            g->first[cell_count + 1] = (uint32_t)count;
    }
    return g->first != NULL;
}

/* --- what of a rim lies on other roads ------------------------------------------------------------------ */

/* The part of an edge that lies over a face, in fractions of it, and how much higher the face is in its middle. False:
 * there is none. */
static bool part_over(const road_face *f, const vec3 *a, const vec3 *b, double out[2], double *higher)
{
    double from[2] = {(double)a->x, (double)a->y}, way[2] = {(double)b->x - from[0], (double)b->y - from[1]};
    double area = 0, height = 0;
    out[0] = 0;
    out[1] = 1;
    for (int k = 0; k < 3; k++) {
        const vec3 *p = &f->at[k], *q = &f->at[(k + 1) % 3];
        double side[2] = {(double)q->x - (double)p->x, (double)q->y - (double)p->y}, size = hypot(side[0], side[1]);
        double begin = side[0] * (from[1] - (double)p->y) - side[1] * (from[0] - (double)p->x) + BESIDE * size;
        double rise = side[0] * way[1] - side[1] * way[0];
        if (fabs(rise) <= 1e-12 * size) {
            if (begin < 0)
                return false;
            continue;
        }
        double at = -begin / rise;
        if (rise > 0)
            out[0] = fmax(out[0], at);
        else
            out[1] = fmin(out[1], at);
    }
    if (!(out[1] > out[0]))
        return false;
    /* Heights in the middle of that part. */
    double t = (out[0] + out[1]) / 2, x = from[0] + t * way[0], y = from[1] + t * way[1];
    for (int k = 0; k < 3; k++) {
        const vec3 *p = &f->at[k], *q = &f->at[(k + 1) % 3];
        double      share =
            ((double)q->x - (double)p->x) * (y - (double)p->y) - ((double)q->y - (double)p->y) * (x - (double)p->x);
        area += share;
        height += share * (double)f->at[(k + 2) % 3].z;
    }
    *higher = height / area - ((double)a->z + t * ((double)b->z - (double)a->z));
    return area > 0;
}

static void add_part(double (*parts)[2], int *count, const double part[2])
{
    if (*count < CUTS_MOST)
        memcpy(parts[(*count)++], part, 2 * sizeof(double));
}

static int by_begin(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (x[0] > y[0]) - (x[0] < y[0]);
}

/* Parts that touch are one; where none is, is a piece of rim. */
static rim rim_of(double (*parts)[2], int count)
{
    const double LEAST = 1e-4;
    rim          out = {.count = 0};
    double       reached = 0;
    qsort(parts, (size_t)count, sizeof *parts, by_begin);
    for (int i = 0; i < count;) {
        double begin = parts[i][0], end = parts[i][1];
        for (i++; i < count && parts[i][0] <= end + LEAST; i++)
            end = fmax(end, parts[i][1]);
        if (end - begin < LEAST || out.count + 2 > CUTS_MOST)
            continue;
        if (begin > reached + LEAST)
            out.cuts[out.count++] = begin;
        out.hidden[out.count] = true;
        if (end < 1 - LEAST)
            out.cuts[out.count++] = end;
        reached = end;
    }
    return out;
}

/* `below`: the edge is of what lies below roads. */
static rim look_up(const road_grid *g, uint32_t owner, bool below, const vec3 *a, const vec3 *b)
{
    double     parts[CUTS_MOST][2], low[2], high[2], part[2], higher;
    int        cells[4], count = 0;
    const vec3 ends[2] = {*a, *b};
    box_of(ends, 2, low, high);
    cells_of(g, low, high, cells);
    for (int y = cells[2]; y <= cells[3]; y++)
        for (int x = cells[0]; x <= cells[1]; x++) {
            size_t cell = (size_t)y * (size_t)g->side + (size_t)x;
            for (uint32_t i = g->first[cell + 1]; i < g->first[cell + 2]; i++) {
                const road_face *f = &g->faces[g->items[i]];
                if (f->owner != owner && part_over(f, a, b, part, &higher) &&
                    (below ? higher > 0 && higher <= BELOW : fabs(higher) <= OVER))
                    add_part(parts, &count, part);
            }
        }
    return rim_of(parts, count);
}

/* --- heights -------------------------------------------------------------------------------------------- */

/* The levels at which an edge's road would be as high as one before it that lies there, as bits. */
static uint32_t taken_at(const road_grid *g, const uint8_t *levels, uint32_t owner, const vec3 *a, const vec3 *b)
{
    double     low[2], high[2], part[2], higher;
    double     size = hypot((double)b->x - (double)a->x, (double)b->y - (double)a->y);
    const vec3 ends[2] = {*a, *b};
    int        cells[4];
    uint32_t   taken = 0;
    box_of(ends, 2, low, high);
    cells_of(g, low, high, cells);
    for (int y = cells[2]; y <= cells[3]; y++)
        for (int x = cells[0]; x <= cells[1]; x++) {
            size_t cell = (size_t)y * (size_t)g->side + (size_t)x;
            for (uint32_t i = g->first[cell + 1]; i < g->first[cell + 2]; i++) {
                const road_face *f = &g->faces[g->items[i]];
                if (f->owner >= owner || !part_over(f, a, b, part, &higher) || (part[1] - part[0]) * size < OVERLAPS)
                    continue;
                double level = higher / STEP + levels[f->owner];
                for (int k = 0; k < LEVELS; k++)
                    taken |= fabs(level - k) < 0.75 ? 1u << k : 0;
            }
        }
    return taken;
}

/* Two colours at one height would flicker: of roads that lie on each other each is a little higher or lower. */
static bool settle(lmn_scene *s, const road_grid *g)
{
    uint8_t *levels = mem_calloc(s->node_count, 1);
    for (size_t i = 0; levels && i < s->node_count && !work_stopped(); i++) {
        mesh      *m = road_of(s, i);
        primitive *p = m ? &m->primitives[0] : NULL;
        uint32_t   taken = 0;
        for (uint32_t k = 0; p && k < p->index_count; k++)
            taken |= taken_at(g, levels, (uint32_t)i, &p->positions[p->indices[k]],
                              &p->positions[p->indices[k % 3 == 2 ? k - 2 : k + 1]]);
        while (levels[i] + 1 < LEVELS && taken >> levels[i] & 1)
            levels[i]++;
        for (uint32_t k = 0; p && levels[i] && k < p->vertex_count; k++)
            p->positions[k].z = (float)((double)p->positions[k].z + STEP * levels[i]);
    }
    bool good = levels != NULL;
    mem_free(levels);
    return good;
}

/* --- cutting -------------------------------------------------------------------------------------------- */

typedef struct cutting {
    primitive *p;
    uint32_t  *indices;
    uint8_t   *said;
    size_t     vertex_capacity, index_capacity, said_capacity, count;
    bool       good;
} cutting;

static uint32_t add_point(cutting *c, uint32_t a, uint32_t b, double t)
{
    primitive *p = c->p;
    c->good =
        c->good && mem_grow((void **)&p->positions, &c->vertex_capacity, (size_t)p->vertex_count + 1, sizeof(vec3));
    if (!c->good)
        return a;
    const vec3 from = p->positions[a], to = p->positions[b];
    p->positions[p->vertex_count] = (vec3){(float)((double)from.x + t * ((double)to.x - (double)from.x)),
                                           (float)((double)from.y + t * ((double)to.y - (double)from.y)),
                                           (float)((double)from.z + t * ((double)to.z - (double)from.z))};
    return p->vertex_count++;
}

static void put(cutting *c, const uint32_t corners[3], const rim rims[3])
{
    c->good = c->good && mem_grow((void **)&c->indices, &c->index_capacity, c->count + 3, sizeof *c->indices) &&
              mem_grow((void **)&c->said, &c->said_capacity, c->count + 3, 1);
    for (size_t k = 0; k < 3 && c->good; k++, c->count++) {
        c->indices[c->count] = corners[k];
        c->said[c->count] = rims[k].hidden[0] ? SHOWN_NEVER : SHOWN_AS_ALWAYS;
    }
}

/* A triangle whose edges are cut: fans from the corner before the first one that is. */
static void cut(cutting *c, const uint32_t corners[3], const rim rims[3])
{
    int e = 0;
    while (e < 3 && rims[e].count == 0)
        e++;
    if (e == 3) {
        put(c, corners, rims);
        return;
    }
    uint32_t a = corners[e], b = corners[(e + 1) % 3], apex = corners[(e + 2) % 3], before = a;
    for (int i = 0; i <= rims[e].count && c->good; i++) {
        uint32_t next = i < rims[e].count ? add_point(c, a, b, rims[e].cuts[i]) : b;
        rim      own[3] = {{.hidden = {rims[e].hidden[i]}}, {.count = 0}, {.count = 0}};
        if (i == rims[e].count)
            own[1] = rims[(e + 1) % 3];
        if (i == 0)
            own[2] = rims[(e + 2) % 3];
        cut(c, (uint32_t[]){before, next, apex}, own);
        before = next;
    }
}

/* The halves of all edges: one whose other half is there is no rim. */
static uint64_t *halves_of(const primitive *p)
{
    uint64_t *out = mem_alloc((size_t)p->index_count * sizeof *out);
    for (uint32_t i = 0; out && i < p->index_count; i++)
        out[i] = (uint64_t)p->indices[i] << 32 | p->indices[i % 3 == 2 ? i - 2 : i + 1];
    return out;
}

static int by_number(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static bool join(const road_grid *g, uint32_t owner, bool below, primitive *p)
{
    uint64_t *halves = halves_of(p);
    cutting   c = {.p = p, .vertex_capacity = p->vertex_count, .good = halves != NULL};
    bool      any = false;
    uint32_t  count = p->index_count;
    if (halves)
        qsort(halves, count, sizeof *halves, by_number);
    for (uint32_t i = 0; i < count && c.good; i += 3) {
        rim      rims[3];
        uint32_t corners[3];
        memcpy(corners, &p->indices[i], sizeof corners);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t from = corners[k], to = corners[(k + 1) % 3];
            uint64_t back = (uint64_t)to << 32 | from;
            rims[k] = (rim){.count = 0};
            if (!bsearch(&back, halves, count, sizeof back, by_number))
                rims[k] = look_up(g, owner, below, &p->positions[from], &p->positions[to]);
            any = any || rims[k].count || rims[k].hidden[0];
        }
        cut(&c, corners, rims);
    }
    mem_free(halves);
    if (c.good && any) {
        mem_free(p->indices);
        p->indices = c.indices;
        p->index_count = (uint32_t)c.count;
        p->edges.values = c.said;
        return true;
    }
    mem_free(c.indices);
    mem_free(c.said);
    return c.good;
}

lmn_status crossings_join(lmn_scene *scene, lmn_error *error)
{
    road_grid g = {.faces = NULL};
    bool      good = gather(scene, &g) && (g.face_count == 0 || (lay_grid(&g) && settle(scene, &g)));
    for (size_t i = 0; i < scene->node_count && good && g.face_count && !work_stopped(); i++) {
        mesh *m = road_of(scene, i), *other = m ? NULL : laid_flat(scene, i, false);
        good = (!m || join(&g, (uint32_t)i, false, &m->primitives[0])) &&
               (!other || join(&g, (uint32_t)i, true, &other->primitives[0]));
    }
    mem_free(g.faces);
    mem_free(g.first);
    mem_free(g.items);
    return good ? work_check(error) : error_memory(error);
}
