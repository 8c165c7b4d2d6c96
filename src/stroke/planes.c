/* Faces in one plane. Faces whose planes are rounded to the same are a heap; three of its corners, as far from each
 * other as can be found, say which plane that is, since thin faces do not know their own; a face lies in it when all
 * its corners are as near to it as roundings may take them. */
#include "stroke/planes.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/stroke_private.h"

/* Meshes with fewer pieces, or with more faces a piece, are not asked. */
enum { PIECES_LEAST = 64, FACES_A_PIECE = 32 };
/* Steps that normals and distances from the middle are rounded to, over what these may be; what is nearer to the next
 * step than BORDER may be of that heap, too. */
#define NORMAL_STEPS 128
#define OFFSET_STEPS 1024
#define BORDER       0.1
/* So much of the tolerance of positions: two faces of a plane are apart by twice as much at most. */
#define NEAR_FRACTION 0.5
/* Planes are told of where so many faces lie in them: fraction of all. */
#define SHARED 0.1

typedef struct heap {
    double   steps[4];
    double3  corners[3];
    double   far, wide; /* of the second from the first; twice the area that the third makes */
    uint32_t next;      /* of its slot, + 1; 0: none */
    uint32_t count;     /* of faces that lie in its plane */
} heap;

typedef struct heap_search {
    edge_mesh *m;
    heap      *heaps;
    size_t     count, capacity, mask;
    uint32_t  *heads; /* per slot: a heap + 1 */
    double3    middle;
    double     size;
} heap_search;

static double3 corner_of(const heap_search *s, uint32_t face, int corner)
{
    vec3 p = s->m->positions[s->m->faces[face][corner]];
    return (double3){p.x - s->middle.x, p.y - s->middle.y, p.z - s->middle.z};
}

/* Both sides of a plane are one: its largest component is above 0. */
static double3 upright(vec3 n)
{
    float  x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z), most = x >= y && x >= z ? n.x : y >= z ? n.y : n.z;
    double sign = most < 0 ? -1 : 1;
    return (double3){sign * n.x, sign * n.y, sign * n.z};
}

static size_t slot_of(const heap_search *s, const double steps[4])
{
    uint64_t h = 0;
    for (int k = 0; k < 4; k++)
        h = line_id(h, (uint64_t)(int64_t)steps[k]);
    return h & s->mask;
}

static uint32_t find_heap(const heap_search *s, const double steps[4])
{
    uint32_t at = s->heads[slot_of(s, steps)];
    while (at && memcmp(s->heaps[at - 1].steps, steps, 4 * sizeof *steps) != 0)
        at = s->heaps[at - 1].next;
    return at;
}

static uint32_t open_heap(heap_search *s, const double steps[4], double3 corner)
{
    if (!mem_grow((void **)&s->heaps, &s->capacity, s->count + 1, sizeof *s->heaps))
        return 0;
    uint32_t *head = &s->heads[slot_of(s, steps)];
    heap     *h = &s->heaps[s->count++];
    *h = (heap){.corners = {corner, corner, corner}, .next = *head};
    memcpy(h->steps, steps, sizeof h->steps);
    return *head = (uint32_t)s->count;
}

/* The heap of a face, + 1; 0: memory is gone. */
static uint32_t heap_of(heap_search *s, uint32_t face)
{
    double3      n = upright(s->m->normals[face]), corner = corner_of(s, face, 0);
    const double at[4] = {n.x * NORMAL_STEPS, n.y * NORMAL_STEPS, n.z * NORMAL_STEPS,
                          double3_dot(n, corner) / s->size * OFFSET_STEPS};
    double       steps[4], others[4];
    unsigned     either = 0;
    for (int k = 0; k < 4; k++) {
        steps[k] = floor(at[k]) + 0.0; /* no zero with a sign */
        double beyond = at[k] - steps[k];
        others[k] = (beyond < BORDER ? steps[k] - 1 : steps[k] + 1) + 0.0;
        either |= beyond < BORDER || beyond > 1 - BORDER ? 1u << k : 0;
    }
    for (unsigned chosen = 0; chosen < 16; chosen++) {
        double there[4];
        for (int k = 0; k < 4; k++)
            there[k] = chosen >> k & 1 ? others[k] : steps[k];
        uint32_t found = chosen & ~either ? 0 : find_heap(s, there);
        if (found)
            return found;
    }
    return open_heap(s, steps, corner);
}

static bool fill_heaps(heap_search *s)
{
    for (uint32_t f = 0; f < s->m->face_count; f++) {
        uint32_t number = s->m->planes[f] = heap_of(s, f);
        if (!number)
            return false;
        heap *h = &s->heaps[number - 1];
        for (int k = 0; k < 3; k++) {
            double3 p = corner_of(s, f, k), way = double3_minus(p, h->corners[0]);
            double  far = double3_dot(way, way);
            h->corners[1] = far > h->far ? p : h->corners[1];
            h->far = fmax(h->far, far);
        }
    }
    return true;
}

/* The third corner makes the largest triangle with the others. */
static void spread_heaps(heap_search *s)
{
    for (uint32_t f = 0; f < s->m->face_count; f++) {
        heap *h = &s->heaps[s->m->planes[f] - 1];
        for (int k = 0; k < 3; k++) {
            double3 p = corner_of(s, f, k),
                    area = double3_cross(double3_minus(h->corners[1], h->corners[0]), double3_minus(p, h->corners[0]));
            double wide = double3_dot(area, area);
            h->corners[2] = wide > h->wide ? p : h->corners[2];
            h->wide = fmax(h->wide, wide);
        }
    }
}

static bool lies_in(const heap_search *s, const heap *h, uint32_t face, double near)
{
    double3 area =
        double3_cross(double3_minus(h->corners[1], h->corners[0]), double3_minus(h->corners[2], h->corners[0]));
    double length = sqrt(double3_dot(area, area));
    for (int k = 0; k < 3; k++)
        if (!(fabs(double3_dot(double3_minus(corner_of(s, face, k), h->corners[0]), area)) <= near * length))
            return false;
    return length > 0;
}

/* What lies in no plane, or alone in one, has none. Returns how many faces have. */
static uint32_t settle(heap_search *s, double near)
{
    edge_mesh *m = s->m;
    uint32_t   kept = 0;
    for (uint32_t f = 0; f < m->face_count; f++)
        if (lies_in(s, &s->heaps[m->planes[f] - 1], f, near))
            s->heaps[m->planes[f] - 1].count++;
        else
            m->planes[f] = 0;
    for (uint32_t f = 0; f < m->face_count; f++) {
        bool alone = !m->planes[f] || s->heaps[m->planes[f] - 1].count < 2;
        m->planes[f] = alone ? 0 : m->planes[f];
        kept += !alone;
    }
    return kept;
}

bool planes_find(edge_mesh *m)
{
    box3 box = box3_empty();
    if (m->piece_count < PIECES_LEAST || m->face_count > (uint64_t)FACES_A_PIECE * m->piece_count || m->solid)
        return true;
    for (uint32_t i = 0; i < m->piece_count; i++)
        box = box3_union(box, m->boxes[i]);
    heap_search s = {.m = m, .size = box3_is_empty(box) ? 0 : box3_diagonal(box), .mask = 63};
    s.middle = (double3){0.5 * ((double)box.min.x + box.max.x), 0.5 * ((double)box.min.y + box.max.y),
                         0.5 * ((double)box.min.z + box.max.z)};
    if (!(s.size > 0) || !isfinite(s.size))
        return true;
    while (s.mask < m->face_count)
        s.mask = 2 * s.mask + 1;
    s.heads = mem_calloc(s.mask + 1, sizeof *s.heads);
    m->planes = mem_alloc(m->face_count * sizeof *m->planes);
    bool     good = s.heads && m->planes && fill_heaps(&s);
    uint32_t kept = 0;
    if (good) {
        spread_heaps(&s);
        kept = settle(&s, NEAR_FRACTION * SAME_POSITION * box_farthest(box));
        m->plane_count = (uint32_t)s.count;
    }
    if (good && kept < SHARED * m->face_count) { /* they say nothing */
        mem_free(m->planes);
        m->planes = NULL;
        m->plane_count = 0;
    }
    mem_free(s.heads);
    mem_free(s.heaps);
    return good;
}
