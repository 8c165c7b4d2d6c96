#include "csg_tree/planes.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { NORMAL_CELLS = 512, DISTANCE_CELLS = 4096, KEYS = 4 };

/* Triangles of one plane. */
typedef struct group {
    csg_plane plane;
    uint32_t  owner;  /* of the first triangle */
    bool      shared; /* another operand has triangles here too */
    uint32_t  next;   /* in the same cell; 0 ends, else index + 1 */
} group;

typedef struct finder {
    const csg_soup *soup;
    double          middle[3], extent;
    group          *groups;
    size_t          group_count, group_capacity;
    uint32_t       *cells;      /* open hash of cell to group + 1 */
    size_t          cell_count; /* a power of two */
} finder;

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void corner(const finder *f, size_t triangle, int k, double out[3])
{
    vec3 p = f->soup->positions[f->soup->indices[3 * triangle + (size_t)k]];
    out[0] = (double)p.x - f->middle[0];
    out[1] = (double)p.y - f->middle[1];
    out[2] = (double)p.z - f->middle[2];
}

static bool plane_of(const finder *f, size_t triangle, csg_plane *out)
{
    double p[3][3], u[3], v[3];
    for (int k = 0; k < 3; k++)
        corner(f, triangle, k, p[k]);
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        v[k] = p[2][k] - p[0][k];
    }
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double length = sqrt(dot3(n, n));
    if (!(length > 0))
        return false;
    for (int k = 0; k < 3; k++)
        out->normal[k] = n[k] / length;
    out->distance = (dot3(out->normal, p[0]) + dot3(out->normal, p[1]) + dot3(out->normal, p[2])) / 3;
    return true;
}

static bool lies_in(const finder *f, size_t triangle, const csg_plane *plane)
{
    for (int k = 0; k < 3; k++) {
        double p[3];
        corner(f, triangle, k, p);
        if (fabs(dot3(plane->normal, p) - plane->distance) > CSG_COINCIDENT * f->extent)
            return false;
    }
    return true;
}

/* Coordinates that do not depend on which way round the plane is, in cells. */
static void coordinates(const finder *f, const csg_plane *plane, double out[KEYS])
{
    for (int k = 0; k < 3; k++)
        out[k] = fabs(plane->normal[k]) * NORMAL_CELLS;
    out[3] = fabs(plane->distance) / f->extent * DISTANCE_CELLS;
}

static uint32_t *cell_of(const finder *f, const int64_t at[KEYS])
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (int k = 0; k < KEYS; k++)
        h = (h ^ (uint64_t)at[k]) * UINT64_C(0x9E3779B97F4A7C15) ^ (h >> 31);
    return &f->cells[(h ^ (h >> 29)) & (f->cell_count - 1)];
}

/* The group whose plane holds the triangle; UINT32_MAX when there is none. Near the border of a cell the neighbours
 * are asked too. */
static uint32_t find_group(const finder *f, size_t triangle, const csg_plane *plane)
{
    static const double NEAR = 0.05;
    double              c[KEYS];
    int64_t             low[KEYS], high[KEYS], at[KEYS];
    coordinates(f, plane, c);
    for (int k = 0; k < KEYS; k++) {
        low[k] = (int64_t)floor(c[k] - NEAR);
        high[k] = (int64_t)floor(c[k] + NEAR);
    }
    for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
            for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
                for (at[3] = low[3]; at[3] <= high[3]; at[3]++)
                    for (uint32_t g = *cell_of(f, at); g != 0; g = f->groups[g - 1].next)
                        if (lies_in(f, triangle, &f->groups[g - 1].plane))
                            return g - 1;
    return UINT32_MAX;
}

static bool add_group(finder *f, const csg_plane *plane, uint32_t owner)
{
    if (!mem_grow((void **)&f->groups, &f->group_capacity, f->group_count + 1, sizeof *f->groups))
        return false;
    double  c[KEYS];
    int64_t at[KEYS];
    coordinates(f, plane, c);
    for (int k = 0; k < KEYS; k++)
        at[k] = (int64_t)floor(c[k]);
    uint32_t *cell = cell_of(f, at);
    f->groups[f->group_count] = (group){*plane, owner, false, *cell};
    *cell = (uint32_t)++f->group_count;
    return true;
}

static void measure(finder *f)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < 3 * f->soup->triangle_count; i++)
        box = box3_with_point(box, f->soup->positions[f->soup->indices[i]]);
    double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z},
           high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    for (int k = 0; k < 3; k++)
        f->middle[k] = (low[k] + high[k]) / 2;
    f->extent = f->soup->extent;
}

/* Boxes of operands, and for each those of others that meet it, one list after the other. */
typedef struct neighbours {
    box3     *boxes;
    size_t   *first; /* per operand, and one more */
    uint32_t *others;
    size_t    capacity;
} neighbours;

/* Boxes that lie apart by less than what counts as coincident touch. */
static bool boxes_meet(const finder *f, box3 a, box3 b)
{
    float margin = (float)(2 * CSG_COINCIDENT * f->extent);
    return a.min.x <= b.max.x + margin && b.min.x <= a.max.x + margin && a.min.y <= b.max.y + margin &&
           b.min.y <= a.max.y + margin && a.min.z <= b.max.z + margin && b.min.z <= a.max.z + margin;
}

static bool find_neighbours(const finder *f, neighbours *n)
{
    uint32_t most = 0;
    for (size_t i = 0; i < f->soup->triangle_count; i++)
        most = f->soup->owners[i] > most ? f->soup->owners[i] : most;
    n->boxes = mem_alloc(((size_t)most + 1) * sizeof *n->boxes);
    n->first = mem_calloc((size_t)most + 2, sizeof *n->first);
    if (!n->boxes || !n->first)
        return false;
    for (size_t i = 0; i <= most; i++)
        n->boxes[i] = box3_empty();
    for (size_t i = 0; i < 3 * f->soup->triangle_count; i++) {
        box3 *box = &n->boxes[f->soup->owners[i / 3]];
        *box = box3_with_point(*box, f->soup->positions[f->soup->indices[i]]);
    }
    size_t count = 0;
    for (uint32_t a = 0; a <= most; a++) {
        n->first[a] = count;
        for (uint32_t b = 0; b <= most; b++) {
            if (a == b || !boxes_meet(f, n->boxes[a], n->boxes[b]))
                continue;
            if (!mem_grow((void **)&n->others, &n->capacity, count + 1, sizeof *n->others))
                return false;
            n->others[count++] = b;
        }
    }
    n->first[most + 1] = count;
    return true;
}

/* Does the triangle reach into another operand's box? */
static bool meets_another(const finder *f, const neighbours *n, size_t triangle)
{
    uint32_t owner = f->soup->owners[triangle];
    box3     box = box3_empty();
    for (size_t k = 0; k < 3; k++)
        box = box3_with_point(box, f->soup->positions[f->soup->indices[3 * triangle + k]]);
    for (size_t i = n->first[owner]; i < n->first[owner + 1]; i++)
        if (boxes_meet(f, box, n->boxes[n->others[i]]))
            return true;
    return false;
}

/* The group of each triangle, UINT32_MAX without one. */
static bool sort_into_groups(finder *f, const neighbours *n, uint32_t *group_of)
{
    for (size_t i = 0; i < f->soup->triangle_count; i++) {
        csg_plane plane;
        group_of[i] = UINT32_MAX;
        if (!meets_another(f, n, i) || !plane_of(f, i, &plane))
            continue;
        uint32_t g = find_group(f, i, &plane);
        if (g == UINT32_MAX) {
            if (!add_group(f, &plane, f->soup->owners[i]))
                return false;
            g = (uint32_t)f->group_count - 1;
        } else if (f->groups[g].owner != f->soup->owners[i]) {
            f->groups[g].shared = true;
        }
        group_of[i] = g;
    }
    return true;
}

/* An operand that has triangles in a group. */
typedef struct member {
    uint32_t group, owner;
    bool     meets; /* another member's box touches its own, so that their triangles may lie on each other */
} member;

typedef struct member_list {
    member *items;
    size_t  count;
} member_list;

static int by_group(const void *a, const void *b)
{
    const member *x = a, *y = b;
    if (x->group != y->group)
        return x->group < y->group ? -1 : 1;
    return (x->owner > y->owner) - (x->owner < y->owner);
}

/* The operands of groups that have several, and which of them may lie on each other: most faces that share a plane
 * are far apart. */
static bool find_members(const finder *f, const neighbours *n, const uint32_t *group_of, member_list *l)
{
    size_t capacity = 0, unique = 0;
    for (size_t i = 0; i < f->soup->triangle_count; i++)
        capacity += group_of[i] != UINT32_MAX && f->groups[group_of[i]].shared;
    l->items = mem_alloc((capacity + 1) * sizeof *l->items);
    if (!l->items)
        return false;
    for (size_t i = 0; i < f->soup->triangle_count; i++)
        if (group_of[i] != UINT32_MAX && f->groups[group_of[i]].shared)
            l->items[l->count++] = (member){group_of[i], f->soup->owners[i], false};
    qsort(l->items, l->count, sizeof *l->items, by_group);
    for (size_t i = 0; i < l->count; i++)
        if (unique == 0 || by_group(&l->items[unique - 1], &l->items[i]) != 0)
            l->items[unique++] = l->items[i];
    l->count = unique;
    for (size_t i = 0; i < l->count; i++)
        for (size_t k = i + 1; k < l->count && l->items[k].group == l->items[i].group; k++)
            if (!(l->items[i].meets && l->items[k].meets) &&
                boxes_meet(f, n->boxes[l->items[i].owner], n->boxes[l->items[k].owner]))
                l->items[i].meets = l->items[k].meets = true;
    return true;
}

static bool number_planes(const finder *f, const neighbours *n, const uint32_t *group_of, uint16_t *numbers,
                          csg_plane **planes, size_t *plane_count)
{
    member_list l = {.count = 0};
    uint16_t   *given = mem_calloc(f->group_count + 1, sizeof *given);
    bool        good = given && find_members(f, n, group_of, &l);
    size_t      count = 0;
    for (size_t i = 0; good && i < l.count; i++)
        if (l.items[i].meets && !given[l.items[i].group] && count < CSG_PLANES_MAX)
            given[l.items[i].group] = (uint16_t)++count;
    *planes = good ? mem_calloc(count + 1, sizeof **planes) : NULL;
    *plane_count = count;
    for (size_t g = 0; *planes && g < f->group_count; g++)
        if (given[g]) {
            csg_plane *p = &(*planes)[given[g] - 1];
            *p = f->groups[g].plane;
            p->distance += dot3(p->normal, f->middle);
        }
    for (size_t i = 0; *planes && i < f->soup->triangle_count; i++) {
        member        own = {group_of[i], f->soup->owners[i], false};
        const member *at =
            own.group != UINT32_MAX && given[own.group] ? bsearch(&own, l.items, l.count, sizeof own, by_group) : NULL;
        numbers[i] = at && at->meets ? given[own.group] : 0;
    }
    mem_free(given);
    mem_free(l.items);
    return *planes != NULL;
}

bool csg_find_planes(const csg_soup *soup, uint16_t **numbers, csg_plane **planes, size_t *plane_count)
{
    finder f = {.soup = soup, .cell_count = 64};
    while (f.cell_count < soup->triangle_count)
        f.cell_count *= 2;
    measure(&f);
    size_t    capacity = soup->triangle_count ? soup->triangle_count : 1;
    uint32_t *group_of = mem_alloc(capacity * sizeof *group_of);
    f.cells = mem_calloc(f.cell_count, sizeof *f.cells);
    *numbers = mem_calloc(capacity, sizeof **numbers);
    *planes = NULL;
    *plane_count = 0;
    neighbours n = {.boxes = NULL};
    bool       good = group_of && f.cells && *numbers;
    if (good && f.extent > 0)
        good = find_neighbours(&f, &n) && sort_into_groups(&f, &n, group_of) &&
               number_planes(&f, &n, group_of, *numbers, planes, plane_count);
    mem_free(n.boxes);
    mem_free(n.first);
    mem_free(n.others);
    mem_free(group_of);
    mem_free(f.cells);
    mem_free(f.groups);
    if (!good) {
        mem_free(*numbers);
        mem_free(*planes);
        *numbers = NULL;
        *planes = NULL;
    }
    return good;
}
