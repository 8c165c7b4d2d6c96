#include "import/street.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

enum { NOBODY = UINT32_MAX, THINGS_MAX = 200000, CELLS_OF_ONE = 20000 };

#define CELL  10.0 /* m */
#define PIECE 15.0 /* m: roads are looked up by pieces of this length */

typedef enum entry_kind { ENTRY_ROAD, ENTRY_OBSTACLE, ENTRY_THING } entry_kind;

typedef struct entry {
    uint32_t   next, index;
    int32_t    column, row;
    entry_kind kind;
} entry;

typedef struct piece {
    double   a[2], b[2], half;
    uint32_t road;
    bool     cars;
} piece;

typedef struct road {
    size_t first, count; /* positions */
    double width;
    bool   cars;
} road;

typedef struct outline {
    size_t first, count;
} outline;

typedef struct circle {
    double x, y, radius;
} circle;

typedef struct list {
    mat4  *items;
    size_t count, capacity;
} list;

struct street {
    double (*positions)[2];
    piece    *pieces;
    road     *roads;
    outline  *outlines;
    circle   *circles;
    entry    *entries;
    uint32_t *table;
    size_t    position_count, position_capacity, piece_count, piece_capacity, road_count, road_capacity, outline_count,
        outline_capacity, circle_count, circle_capacity, entry_count, entry_capacity, table_size;
    list           lists[PROPS];
    const terrain *terrain;
    uint64_t       total, refused, chance;
};

street *street_new(void)
{
    return mem_calloc(1, sizeof(street));
}

void street_free(street *s)
{
    if (!s)
        return;
    mem_free(s->positions);
    mem_free(s->pieces);
    mem_free(s->roads);
    mem_free(s->outlines);
    mem_free(s->circles);
    mem_free(s->entries);
    mem_free(s->table);
    for (int i = 0; i < PROPS; i++)
        mem_free(s->lists[i].items);
    mem_free(s);
}

/* --- what is where -------------------------------------------------------------------------------------- */

static size_t slot_of(const street *s, int32_t column, int32_t row)
{
    uint32_t h = (uint32_t)column * 0x9E3779B1u ^ (uint32_t)row * 0x85EBCA77u;
    h ^= h >> 15;
    return h & (s->table_size - 1);
}

static bool grow_table(street *s)
{
    size_t    size = s->table_size ? 2 * s->table_size : 1024;
    uint32_t *table = mem_alloc(size * sizeof *table);
    if (!table)
        return false;
    mem_free(s->table);
    s->table = table;
    s->table_size = size;
    for (size_t i = 0; i < size; i++)
        table[i] = NOBODY;
    for (size_t i = 0; i < s->entry_count; i++) {
        size_t slot = slot_of(s, s->entries[i].column, s->entries[i].row);
        s->entries[i].next = table[slot];
        table[slot] = (uint32_t)i;
    }
    return true;
}

static bool add_entry(street *s, int32_t column, int32_t row, entry_kind kind, uint32_t index)
{
    if (s->entry_count >= s->table_size && !grow_table(s))
        return false;
    if (!mem_grow((void **)&s->entries, &s->entry_capacity, s->entry_count + 1, sizeof *s->entries))
        return false;
    size_t slot = slot_of(s, column, row);
    s->entries[s->entry_count] = (entry){s->table[slot], index, column, row, kind};
    s->table[slot] = (uint32_t)s->entry_count++;
    return true;
}

static int32_t cell_of(double v)
{
    return (int32_t)fmax(-1e8, fmin(1e8, floor(v / CELL)));
}

static bool add_box(street *s, const double low[2], const double high[2], entry_kind kind, uint32_t index)
{
    int32_t from[2] = {cell_of(low[0]), cell_of(low[1])}, to[2] = {cell_of(high[0]), cell_of(high[1])};
    double  cells = ((double)to[0] - from[0] + 1) * ((double)to[1] - from[1] + 1);
    for (int32_t column = from[0]; cells <= CELLS_OF_ONE && column <= to[0]; column++)
        for (int32_t row = from[1]; row <= to[1]; row++)
            if (!add_entry(s, column, row, kind, index))
                return false;
    return true;
}

static bool keep(street *s, const double (*positions)[2], size_t count)
{
    if (!mem_grow((void **)&s->positions, &s->position_capacity, s->position_count + count, sizeof *s->positions))
        return false;
    memcpy(s->positions + s->position_count, positions, count * sizeof *positions);
    s->position_count += count;
    return true;
}

bool street_add_road(street *s, const double (*positions)[2], size_t count, double width, bool cars)
{
    uint32_t number = (uint32_t)s->road_count;
    if (count < 2)
        return true;
    if (!mem_grow((void **)&s->roads, &s->road_capacity, s->road_count + 1, sizeof *s->roads))
        return false;
    s->roads[s->road_count++] = (road){s->position_count, count, width, cars};
    if (!keep(s, positions, count))
        return false;
    for (size_t i = 0; i + 1 < count; i++) {
        double length = hypot(positions[i + 1][0] - positions[i][0], positions[i + 1][1] - positions[i][1]);
        int    parts = 1 + (int)fmin(length / PIECE, 10000);
        for (int k = 0; k < parts; k++) {
            piece p = {.half = width / 2, .road = number, .cars = cars};
            for (int c = 0; c < 2; c++) {
                double way = positions[i + 1][c] - positions[i][c];
                p.a[c] = positions[i][c] + way * k / parts;
                p.b[c] = positions[i][c] + way * (k + 1) / parts;
            }
            const double low[2] = {fmin(p.a[0], p.b[0]) - p.half, fmin(p.a[1], p.b[1]) - p.half},
                         high[2] = {fmax(p.a[0], p.b[0]) + p.half, fmax(p.a[1], p.b[1]) + p.half};
            if (!mem_grow((void **)&s->pieces, &s->piece_capacity, s->piece_count + 1, sizeof *s->pieces) ||
                !add_box(s, low, high, ENTRY_ROAD, (uint32_t)s->piece_count))
                return false;
            s->pieces[s->piece_count++] = p;
        }
    }
    return true;
}

bool street_add_obstacle(street *s, const double (*ring)[2], size_t count)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], ring[i][k]);
            high[k] = fmax(high[k], ring[i][k]);
        }
    if (count < 3)
        return true;
    if (!mem_grow((void **)&s->outlines, &s->outline_capacity, s->outline_count + 1, sizeof *s->outlines))
        return false;
    s->outlines[s->outline_count] = (outline){s->position_count, count};
    return keep(s, ring, count) && add_box(s, low, high, ENTRY_OBSTACLE, (uint32_t)s->outline_count++);
}

bool street_add_thing(street *s, double x, double y, double radius)
{
    const double low[2] = {x - radius, y - radius}, high[2] = {x + radius, y + radius};
    if (!mem_grow((void **)&s->circles, &s->circle_capacity, s->circle_count + 1, sizeof *s->circles) ||
        !add_box(s, low, high, ENTRY_THING, (uint32_t)s->circle_count))
        return false;
    s->circles[s->circle_count++] = (circle){x, y, radius};
    return true;
}

/* --- is there room -------------------------------------------------------------------------------------- */

static double distance_to(const double a[2], const double b[2], double x, double y)
{
    double wx = b[0] - a[0], wy = b[1] - a[1], length = wx * wx + wy * wy;
    double t = length > 0 ? fmax(0, fmin(1, ((x - a[0]) * wx + (y - a[1]) * wy) / length)) : 0;
    return hypot(x - a[0] - t * wx, y - a[1] - t * wy);
}

static bool in_outline(const street *s, const outline *o, double x, double y, double radius)
{
    const double(*p)[2] = (const double(*)[2])s->positions + o->first;
    bool inside = false;
    for (size_t i = 0, j = o->count - 1; i < o->count; j = i++) {
        if (distance_to(p[j], p[i], x, y) < radius)
            return true;
        if ((p[i][1] > y) != (p[j][1] > y) && x < (p[j][0] - p[i][0]) * (y - p[i][1]) / (p[j][1] - p[i][1]) + p[i][0])
            inside = !inside;
    }
    return inside;
}

/* Whose lanes it may stand in: NOBODY: in none; ANYBODY: in all. */
#define ANYBODY (UINT32_MAX - 1)

static bool is_hit(const street *s, const entry *e, double x, double y, double radius, uint32_t own)
{
    switch (e->kind) {
    case ENTRY_OBSTACLE: return in_outline(s, &s->outlines[e->index], x, y, radius + 0.1);
    case ENTRY_THING: {
        const circle *c = &s->circles[e->index];
        return hypot(c->x - x, c->y - y) < c->radius + radius;
    }
    case ENTRY_ROAD: {
        const piece *p = &s->pieces[e->index];
        return p->cars && own != ANYBODY && own != p->road && distance_to(p->a, p->b, x, y) < p->half + radius;
    }
    }
    return false;
}

static bool is_free(const street *s, double x, double y, double radius, uint32_t own)
{
    for (int32_t column = cell_of(x - radius); s->table_size && column <= cell_of(x + radius); column++)
        for (int32_t row = cell_of(y - radius); row <= cell_of(y + radius); row++)
            for (uint32_t i = s->table[slot_of(s, column, row)]; i != NOBODY; i = s->entries[i].next) {
                const entry *e = &s->entries[i];
                if (e->column == column && e->row == row && is_hit(s, e, x, y, radius, own))
                    return false;
            }
    return true;
}

/* --- putting -------------------------------------------------------------------------------------------- */

static double chance(street *s)
{
    s->chance += 0x9E3779B97F4A7C15u;
    uint64_t h = s->chance;
    h = (h ^ h >> 30) * 0xBF58476D1CE4E5B9u;
    h = (h ^ h >> 27) * 0x94D049BB133111EBu;
    return (double)((h ^ h >> 31) >> 11) / 9007199254740992.0;
}

typedef struct spot {
    double x, y, angle, size;
} spot;

/* False when memory is gone; where there is no room nothing is put. */
static bool place(street *s, prop_kind kind, spot at, uint32_t own)
{
    prop_room room = prop_room_of(kind);
    list     *l = &s->lists[kind];
    double    c = cos(at.angle), n = sin(at.angle);
    if (s->total >= THINGS_MAX)
        return true;
    for (int i = 0; i < room.circles; i++) {
        double along = room.apart * (i - (room.circles - 1) / 2.0);
        if (!is_free(s, at.x + c * along, at.y + n * along, room.radius, own)) {
            s->refused++;
            return true;
        }
    }
    for (int i = 0; i < room.circles; i++) {
        double along = room.apart * (i - (room.circles - 1) / 2.0);
        if (!street_add_thing(s, at.x + c * along, at.y + n * along, room.radius))
            return false;
    }
    if (!mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items))
        return false;
    double z = s->terrain ? terrain_height(s->terrain, at.x, at.y) + 0.1 : 0, k = at.size;
    l->items[l->count++] = (mat4){{k * c, k * n, 0, 0, -k * n, k * c, 0, 0, 0, 0, k, 0, at.x, at.y, z, 1}};
    s->total++;
    return true;
}

/* --- along a road --------------------------------------------------------------------------------------- */

typedef struct walk {
    const double (*p)[2];
    size_t count, edge;
    double done; /* length of the edges before */
} walk;

/* The place so far along, `aside` to the left of the way; false behind the end. Asked for in order. */
static bool walk_to(walk *w, double along, double aside, spot *out)
{
    for (; w->edge + 1 < w->count; w->edge++) {
        const double *a = w->p[w->edge], *b = w->p[w->edge + 1];
        double        x = b[0] - a[0], y = b[1] - a[1], length = hypot(x, y);
        if (along <= w->done + length && length > 0) {
            double t = (along - w->done) / length;
            *out = (spot){a[0] + t * x - aside * y / length, a[1] + t * y + aside * x / length, atan2(y, x), 1};
            return true;
        }
        w->done += length;
    }
    return false;
}

static prop_kind some_person(street *s)
{
    double c = chance(s);
    return c < 0.3 ? PROP_PERSON : c < 0.88 ? PROP_WALKER : PROP_CHILD;
}

/* One kind of row: how far apart on average, where, and what it is. */
typedef enum row_kind { ROW_LAMPS, ROW_TREES, ROW_PARKED, ROW_MOVING, ROW_PEOPLE, ROW_SEATS, ROWS } row_kind;

static bool put_one(street *s, row_kind kind, const road *r, uint32_t number, int side, spot at)
{
    const double turn = 3.141592653589793;
    switch (kind) {
    case ROW_LAMPS: at.angle -= side * turn / 2; return place(s, PROP_LAMP, at, NOBODY);
    case ROW_SEATS: at.angle -= side * turn / 2; return place(s, chance(s) < 0.6 ? PROP_BENCH : PROP_BIN, at, NOBODY);
    case ROW_TREES:
        at.size = 5.5 + 3 * chance(s);
        at.angle = turn * 2 * chance(s);
        return place(s, PROP_BROAD_TREE, at, NOBODY);
    case ROW_PARKED:
        at.angle += side > 0 ? turn : 0;
        return place(s, chance(s) < 0.88 ? PROP_CAR : PROP_VAN, at, number);
    case ROW_MOVING: {
        double c = chance(s);
        at.angle += side > 0 ? turn : 0;
        return place(s,
                     c < 0.72                   ? PROP_CAR
                     : c < 0.85                 ? PROP_VAN
                     : c < 0.94 || r->width < 8 ? PROP_CYCLIST
                                                : PROP_BUS,
                     at, number);
    }
    default:
        at.angle += chance(s) < 0.5 ? turn : 0;
        at.angle += 0.4 * (chance(s) - 0.5);
        at.size = 0.94 + 0.12 * chance(s);
        return place(s, some_person(s), at, r->cars ? NOBODY : number);
    }
}

static bool put_row(street *s, row_kind kind, uint32_t number, int side, double apart, double aside, double spread,
                    bool even)
{
    const road *r = &s->roads[number];
    walk        w = {(const double(*)[2])s->positions + r->first, r->count, 0, 0};
    double      along = apart * (even ? 0.5 + 0.25 * side : chance(s));
    spot        at;
    while (s->total < THINGS_MAX && s->refused < 4 * THINGS_MAX &&
           walk_to(&w, along, side * (aside + spread * (chance(s) - 0.5)), &at)) {
        if (!put_one(s, kind, r, number, side, at))
            return false;
        along += even ? apart : apart * (0.3 + 1.4 * chance(s));
    }
    return true;
}

/* Cars keep to the right. What is more than one in a place stands where there was room: lamps and trees come first. */
static bool put_rows(street *s, uint32_t number, double density, row_kind kind)
{
    const road *r = &s->roads[number];
    double      half = r->width / 2, more = fmax(density, 1e-3);
    bool        good = true;
    s->chance = (uint64_t)number * 977 + (uint64_t)kind;
    for (int side = -1; side <= 1 && good; side += 2)
        switch (kind) {
        case ROW_LAMPS: good = !r->cars || put_row(s, kind, number, side, 44, half + 0.5, 0, true); break;
        case ROW_TREES:
            good = !r->cars || r->width < 5.5 || put_row(s, kind, number, side, 17 / more, half + 1.75, 0.2, false);
            break;
        case ROW_PARKED:
            good = !r->cars || r->width < 5.5 || put_row(s, kind, number, side, 14 / more, half - 1.05, 0.1, false);
            break;
        case ROW_MOVING:
            good = !r->cars || put_row(s, kind, number, side, (r->width < 7 ? 80 : 40) / more, half * 0.42, 0.3, false);
            break;
        case ROW_PEOPLE:
            good = r->cars ? put_row(s, kind, number, side, 16 / more, half + 1.7, 1.8, false)
                           : put_row(s, kind, number, side, 14 / more, half * 0.4, half * 0.8, false);
            break;
        default: good = !r->cars || put_row(s, kind, number, side, 70 / more, half + 2.2, 0, false); break;
        }
    return good;
}

static lmn_status into_scene(street *s, city_builder *b, prop_kind kind)
{
    static const char *const names[PROPS] = {"people",   "walkers",  "children", "cars",      "vans",
                                             "buses",    "cyclists", "lamps",    "benches",   "bins",
                                             "bollards", "trees",    "conifers", "line-trees"};
    list                    *l = &s->lists[kind];
    const char              *type = prop_class(kind);
    city_meshes              meshes = {NULL, 0, 0};
    lmn_status               status = prop_make(b, kind, &meshes);
    int32_t node = status == LMN_OK ? city_object(b, mem_copy_text(names[kind]), type, strlen(type)) : NONE;
    if (node == NONE)
        status = error_memory(b->error);
    if (status == LMN_OK)
        status = city_attach(b, node, &meshes, NULL, true);
    mem_free(meshes.items);
    if (status != LMN_OK)
        return status;
    b->scene->nodes[node].numbered = true;
    b->scene->nodes[node].instances = l->items;
    b->scene->nodes[node].instance_count = (uint32_t)l->count;
    l->items = NULL;
    /* The object itself has been counted. */
    return city_add(&b->scene->city, CITY_OBJECTS, type, l->count - 1) ? LMN_OK : error_memory(b->error);
}

lmn_status street_populate(street *s, city_builder *b, double density)
{
    bool good = true;
    s->terrain = b->terrain;
    for (int kind = 0; kind < ROWS && good; kind++)
        for (uint32_t i = 0; i < s->road_count && good; i++)
            good = put_rows(s, i, density, (row_kind)kind);
    lmn_status status = good ? LMN_OK : error_memory(b->error);
    for (int kind = 0; kind < PROPS && status == LMN_OK; kind++)
        if (s->lists[kind].count)
            status = into_scene(s, b, (prop_kind)kind);
    if (status == LMN_OK && s->refused && !city_add(&b->scene->city, CITY_SKIPPED, "no-room", s->refused))
        status = error_memory(b->error);
    return status;
}
