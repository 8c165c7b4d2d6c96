/* Sample elimination: which points of many are to go first, so that whatever is left is spread evenly. After Yuksel
 * 2015, "Sample Elimination for Generating Poisson Disk Sample Sets", with the order of all prefixes; distances are
 * straight ones, between points whose surfaces do not turn away from each other. */
#include "marks/marks.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"

/* A point in the order of the table. */
typedef struct table_entry {
    int32_t         cell[3];
    spread_position point;
} table_entry;

/* Points with neighbours, of one round: until half of them are left. */
typedef struct round_of {
    const spread_position *points;
    const uint32_t        *alive; /* numbers of the points that are left when it begins */
    uint32_t               count;
    double                 reach; /* beyond it points do not crowd each other */
    double       longer;  /* strokes: distances along them count this many times less than sideways, squared; 1: dots */
    double       cell;    /* side of the table's cells */
    double       closest; /* nearer than this is as bad as this */
    uint32_t    *table;   /* first of each bucket in `members`, one more behind */
    uint32_t    *members;
    table_entry *entries; /* of the members */
    int32_t (*cells)[3];
    uint32_t  mask;
    uint32_t *starts; /* of each one's neighbours, count + 1 */
    uint32_t *others;
    float    *weights; /* of a pair */
} round_of;

/* Cells of a block of four by four by four lie together in the table, so that neighbours do in memory. */
static uint32_t bucket_of(const int32_t cell[3], uint32_t mask)
{
    uint32_t h = (uint32_t)(cell[0] >> 2) * 73856093u ^ (uint32_t)(cell[1] >> 2) * 19349663u ^
                 (uint32_t)(cell[2] >> 2) * 83492791u;
    return ((h ^ h >> 15) << 6 | (uint32_t)((cell[2] & 3) << 4 | (cell[1] & 3) << 2 | (cell[0] & 3))) & mask;
}

static void find_cells(size_t begin, size_t end, void *user)
{
    round_of *r = user;
    for (size_t i = begin; i < end; i++) {
        const vec3 *p = &r->points[r->alive[i]].position;
        r->cells[i][0] = (int32_t)floor((double)p->x / r->cell);
        r->cells[i][1] = (int32_t)floor((double)p->y / r->cell);
        r->cells[i][2] = (int32_t)floor((double)p->z / r->cell);
    }
}

static void fill_table(round_of *r)
{
    memset(r->table, 0, ((size_t)r->mask + 2) * sizeof *r->table);
    for (uint32_t i = 0; i < r->count; i++)
        r->table[bucket_of(r->cells[i], r->mask) + 1]++;
    for (uint32_t b = 0; b <= r->mask; b++)
        r->table[b + 1] += r->table[b];
    for (uint32_t i = r->count; i-- > 0;) { /* backwards: each bucket's end runs to its beginning */
        uint32_t b = bucket_of(r->cells[i], r->mask);
        r->members[--r->table[b + 1]] = i;
    }
    memmove(r->table, r->table + 1, ((size_t)r->mask + 1) * sizeof *r->table);
    r->table[r->mask + 1] = r->count;
    for (uint32_t m = 0; m < r->count; m++) {
        uint32_t     i = r->members[m];
        table_entry *e = &r->entries[m];
        memcpy(e->cell, r->cells[i], sizeof e->cell);
        e->point = r->points[r->alive[i]];
    }
}

static double square_between(vec3 a, vec3 b)
{
    double x = (double)a.x - (double)b.x, y = (double)a.y - (double)b.y, z = (double)a.z - (double)b.z;
    return x * x + y * y + z * z;
}

/* How much a point crowds another; 0: not at all. */
static float weight_of(const round_of *r, const spread_position *a, const spread_position *b)
{
    enum { POWER = 8 };
    const double AWAY = -0.25; /* cosine from which on surfaces are each other's backs */
    double       x = (double)a->position.x - (double)b->position.x, y = (double)a->position.y - (double)b->position.y,
           z = (double)a->position.z - (double)b->position.z;
    double square = x * x + y * y + z * z;
    if (r->longer > 1) {
        double own = x * (double)a->direction.x + y * (double)a->direction.y + z * (double)a->direction.z,
               other = x * (double)b->direction.x + y * (double)b->direction.y + z * (double)b->direction.z;
        double along = fmin(0.5 * (own * own + other * other), square);
        square = r->longer * (square - along) + along / r->longer;
    }
    if (square >= r->reach * r->reach)
        return 0;
    double facing = (double)a->normal.x * (double)b->normal.x + (double)a->normal.y * (double)b->normal.y +
                    (double)a->normal.z * (double)b->normal.z;
    if (facing < AWAY)
        return 0;
    double left = 1 - fmax(sqrt(square), r->closest) / r->reach;
    for (int power = 1; power < POWER; power *= 2)
        left *= left;
    return (float)left;
}

/* What lies in a cell and those around it, as stretches of the table: found once for all points of the cell. */
typedef struct cells_around {
    int32_t middle[3];
    int     count;
    struct {
        int32_t  cell[3];
        uint32_t first, end; /* with others of the same bucket among them */
    } parts[27];
} cells_around;

static bool is_cell(const int32_t a[3], const int32_t b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static void look_around(cells_around *around, const round_of *r, const int32_t middle[3])
{
    memcpy(around->middle, middle, sizeof around->middle);
    around->count = 0;
    for (int k = 0; k < 27; k++) {
        const int32_t cell[3] = {middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1};
        uint32_t      bucket = bucket_of(cell, r->mask), first = r->table[bucket], end = r->table[bucket + 1];
        while (first < end && !is_cell(r->entries[first].cell, cell))
            first++;
        while (first < end && !is_cell(r->entries[end - 1].cell, cell))
            end--;
        if (first == end)
            continue;
        memcpy(around->parts[around->count].cell, cell, sizeof cell);
        around->parts[around->count].first = first;
        around->parts[around->count++].end = end;
    }
}

/* Goes over the neighbours of points; counts them, or once there is room writes them down. Points are taken in the
 * order of the table, so that what is compared lies together in memory. */
static void find_neighbours(size_t begin, size_t end, void *user)
{
    round_of    *r = user;
    const double farthest = r->cell * r->cell * 1.0001; /* beyond it nothing has a weight */
    cells_around around = {.count = 0};
    for (size_t s = begin; s < end; s++) {
        const table_entry *own = &r->entries[s];
        uint32_t           i = r->members[s], found = 0;
        if (s == begin || !is_cell(around.middle, own->cell))
            look_around(&around, r, own->cell);
        for (int k = 0; k < around.count; k++)
            for (uint32_t m = around.parts[k].first; m < around.parts[k].end; m++) {
                const table_entry *e = &r->entries[m];
                if (square_between(own->point.position, e->point.position) >= farthest || m == s ||
                    !is_cell(e->cell, around.parts[k].cell))
                    continue;
                float weight = weight_of(r, &own->point, &e->point);
                if (!(weight > 0))
                    continue;
                if (r->others) {
                    r->others[r->starts[i] + found] = r->members[m];
                    r->weights[r->starts[i] + found] = weight;
                }
                found++;
            }
        if (!r->others)
            r->starts[i + 1] = found;
    }
}

static void round_release(round_of *r)
{
    mem_free(r->table);
    mem_free(r->members);
    mem_free(r->entries);
    mem_free(r->cells);
    mem_free(r->starts);
    mem_free(r->others);
    mem_free(r->weights);
}

static bool round_open(round_of *r)
{
    enum { SMALLEST = 4096 };
    for (r->mask = 1; r->mask < r->count; r->mask = r->mask * 2 + 1)
        ;
    r->table = mem_alloc(((size_t)r->mask + 2) * sizeof *r->table);
    r->members = mem_alloc(r->count * sizeof *r->members);
    r->entries = mem_alloc(r->count * sizeof *r->entries);
    r->cells = mem_alloc(r->count * sizeof *r->cells);
    r->starts = mem_calloc((size_t)r->count + 1, sizeof *r->starts);
    if (!r->table || !r->members || !r->entries || !r->cells || !r->starts)
        return false;
    threads_for(r->count, SMALLEST, find_cells, r);
    fill_table(r);
    threads_for(r->count, SMALLEST, find_neighbours, r);
    for (uint32_t i = 0; i < r->count; i++)
        r->starts[i + 1] += r->starts[i];
    uint32_t pairs = r->starts[r->count];
    r->weights = mem_alloc((size_t)pairs * sizeof *r->weights);
    r->others = mem_alloc((size_t)pairs * sizeof *r->others);
    if (!r->weights || !r->others)
        return false;
    threads_for(r->count, SMALLEST, find_neighbours, r);
    return true;
}

/* --- the most crowded one: a heap ----------------------------------------------------------------------- */

typedef struct crowd {
    float    *weights;      /* per point of the round */
    uint32_t *heap, *where; /* points, the most crowded first; where each one is */
    uint32_t  count;
} crowd;

/* Equals are told apart by their numbers, so that the order is the same everywhere. */
static bool more_crowded(const crowd *c, uint32_t a, uint32_t b)
{
    return c->weights[a] != c->weights[b] ? c->weights[a] > c->weights[b] : a < b;
}

static void put(crowd *c, uint32_t at, uint32_t point)
{
    c->heap[at] = point;
    c->where[point] = at;
}

static void sift_down(crowd *c, uint32_t at)
{
    uint32_t point = c->heap[at];
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child >= c->count)
            break;
        if (child + 1 < c->count && more_crowded(c, c->heap[child + 1], c->heap[child]))
            child++;
        if (!more_crowded(c, c->heap[child], point))
            break;
        put(c, at, c->heap[child]);
        at = child;
    }
    put(c, at, point);
}

static bool crowd_open(crowd *c, const round_of *r)
{
    c->count = r->count;
    c->weights = mem_calloc(r->count, sizeof *c->weights);
    c->heap = mem_alloc(r->count * sizeof *c->heap);
    c->where = mem_alloc(r->count * sizeof *c->where);
    if (!c->weights || !c->heap || !c->where)
        return false;
    for (uint32_t i = 0; i < r->count; i++) {
        for (uint32_t k = r->starts[i]; k < r->starts[i + 1]; k++)
            c->weights[i] += r->weights[k];
        put(c, i, i);
    }
    for (uint32_t i = c->count / 2; i-- > 0;)
        sift_down(c, i);
    return true;
}

static void crowd_release(crowd *c)
{
    mem_free(c->weights);
    mem_free(c->heap);
    mem_free(c->where);
}

/* Takes the most crowded one away; its neighbours have more room. */
static uint32_t take_away(crowd *c, const round_of *r)
{
    uint32_t gone = c->heap[0];
    c->count--;
    if (c->count > 0) {
        put(c, 0, c->heap[c->count]);
        sift_down(c, 0);
    }
    c->where[gone] = UINT32_MAX;
    for (uint32_t k = r->starts[gone]; k < r->starts[gone + 1]; k++) {
        uint32_t other = r->others[k];
        if (c->where[other] == UINT32_MAX)
            continue;
        c->weights[other] -= r->weights[k];
        sift_down(c, c->where[other]);
    }
    return gone;
}

/* --- rounds --------------------------------------------------------------------------------------------- */

/* Takes points away until `target` are left; those that go when fewer than `wanted` are left get their ranks. */
static bool eliminate_to(uint32_t *alive, uint32_t *count, uint32_t target, size_t wanted, uint32_t *ranks,
                         const spread_position *points, double area, double length)
{
    const double LONGEST = 8, OVERLAP = 0.8; /* ends of strokes may lie beside each other */
    /* What discs of the densest packing have room for; from the paper, with its β and γ for how close the closest
     * may be. */
    double radius = sqrt(area / (2 * sqrt(3.0) * target));
    double closest = 2 * radius * (1 - pow((double)target / *count, 1.5)) * 0.65;
    /* Strokes that follow each other at their length leave this much room sideways. */
    double   longer = fmin(fmax(OVERLAP * OVERLAP * length * length * target / area, 1), LONGEST);
    round_of r = {.points = points,
                  .alive = alive,
                  .count = *count,
                  .reach = 2 * radius,
                  .closest = closest,
                  .longer = longer,
                  .cell = 2 * radius * sqrt(longer)};
    crowd    c = {NULL, NULL, NULL, 0};
    bool     done = round_open(&r) && crowd_open(&c, &r);
    while (done && c.count > target) {
        uint32_t gone = take_away(&c, &r);
        if (c.count < wanted)
            ranks[alive[gone]] = c.count;
    }
    if (done) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < *count; i++)
            if (c.where[i] != UINT32_MAX)
                alive[kept++] = alive[i];
        *count = kept;
    }
    crowd_release(&c);
    round_release(&r);
    return done;
}

bool marks_eliminate(uint32_t *ranks, const spread_position *points, size_t count, size_t wanted, double area,
                     double length)
{
    uint32_t *alive = mem_alloc(count * sizeof *alive), left = (uint32_t)count;
    if (!alive)
        return false;
    for (uint32_t i = 0; i < left; i++) {
        alive[i] = i;
        ranks[i] = UINT32_MAX;
    }
    bool     done = true;
    uint32_t target = wanted < left ? (uint32_t)wanted : left / 2;
    while (done && left > 1) {
        done = eliminate_to(alive, &left, target > 1 ? target : 1, wanted, ranks, points, area, length);
        target = left / 2;
    }
    if (done && left == 1 && wanted > 0)
        ranks[alive[0]] = 0;
    mem_free(alive);
    return done;
}
