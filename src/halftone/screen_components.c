/* The marks of a painted screen: texels of ink that hang together. Levels of detail leave out whole marks, as those
 * of strokes do. */
#include "halftone/screen_private.h"
#include "stroke_texture/strokes_private.h"

#include <string.h>

#include "base/memory.h"

enum {
    FAINT = INK_MOST / 8, /* less ink does not join screen_marks */
    POINT_APART = 16,     /* texels of a mark of which one tells where it is */
    NOBODY = -1
};

static int32_t root_of(int32_t *parent, int32_t at)
{
    while (parent[at] != at) {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    return at;
}

/* Joins neighbours, around the border too; each texel's parent is one before it, or itself. */
static void join_texels(int32_t *parent, const uint16_t *ink, int side)
{
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    int              mask = side - 1;
    for (int i = 0; i < side * side; i++)
        parent[i] = ink[i] >= FAINT ? i : NOBODY;
    for (int i = 0; i < side * side; i++)
        for (int w = 0; w < 4 && parent[i] != NOBODY; w++) {
            int other = ((i / side + directions[w][1]) & mask) * side + ((i + directions[w][0]) & mask);
            if (parent[other] == NOBODY)
                continue;
            int32_t a = root_of(parent, i), b = root_of(parent, other);
            parent[a > b ? a : b] = a > b ? b : a;
        }
}

/* Numbers marks by their first texels, and gives each texel its mark's number. Roots come before their texels. */
static void number_marks(screen_marks *m, int side)
{
    for (int i = 0; i < side * side; i++) {
        int32_t parent = m->label[i];
        if (parent == i)
            m->label[i] = (int32_t)m->count++;
        else if (parent != NOBODY)
            m->label[i] = m->label[parent];
    }
}

/* Every so many texels of each mark stand for it; sorted by mark. `first` is where each mark's points begin. */
static void place_points(spread_point *points, size_t *first, const screen_marks *m, int side)
{
    size_t texels = (size_t)side * (size_t)side, sum = 0;
    for (size_t i = 0; i < texels; i++)
        if (m->label[i] != NOBODY)
            first[m->label[i]]++;
    for (size_t mark = 0; mark < m->count; mark++) {
        size_t own = (first[mark] + POINT_APART - 1) / POINT_APART;
        first[mark] = sum * POINT_APART;
        sum += own;
    }
    for (size_t i = 0; i < texels; i++) {
        if (m->label[i] == NOBODY)
            continue;
        size_t mark = (size_t)m->label[i], at = first[mark]++;
        if (at % POINT_APART == 0)
            points[at / POINT_APART] = (spread_point){((float)(i % (size_t)side) + 0.5f) / (float)side,
                                                      ((float)(i / (size_t)side) + 0.5f) / (float)side, mark};
    }
}

static size_t count_points(const screen_marks *m, size_t texels)
{
    size_t inked = 0;
    for (size_t i = 0; i < texels; i++)
        inked += m->label[i] != NOBODY;
    return inked / POINT_APART + m->count;
}

/* An order in which marks that come after each other lie apart. */
static bool order_marks(screen_marks *m, int side)
{
    size_t        texels = (size_t)side * (size_t)side, most = count_points(m, texels);
    spread_point *points = mem_calloc(most, sizeof *points);
    size_t       *first = mem_calloc(m->count, sizeof *first);
    m->order = mem_calloc(m->count, sizeof *m->order);
    m->ink = mem_calloc(m->count, sizeof *m->ink);
    m->gone = mem_calloc(m->count, sizeof *m->gone);
    bool enough = points && first && m->order && m->ink && m->gone;
    if (enough && m->count > 0) {
        place_points(points, first, m, side);
        size_t last = first[m->count - 1];
        enough = spread_order(m->order, m->count, points, (last + POINT_APART - 1) / POINT_APART, m->count, 1);
    }
    mem_free(points);
    mem_free(first);
    return enough;
}

bool screen_marks_find(screen_marks *m, const uint16_t *ink, int side)
{
    *m = (screen_marks){.label = mem_alloc((size_t)side * (size_t)side * sizeof *m->label)};
    if (!m->label)
        return false;
    join_texels(m->label, ink, side);
    /* Each texel points to its mark's first texel. */
    for (int32_t i = 0; i < side * side; i++)
        if (m->label[i] != NOBODY)
            m->label[i] = root_of(m->label, i);
    number_marks(m, side);
    return order_marks(m, side);
}

void screen_marks_release(screen_marks *m)
{
    mem_free(m->label);
    mem_free(m->order);
    mem_free(m->ink);
    mem_free(m->gone);
}

void screen_marks_reduce(screen_marks *m, uint16_t *ink, const uint16_t *finer, int half)
{
    int side = 2 * half;
    for (int y = 0; y < half; y++)
        for (int x = 0; x < half; x++) {
            size_t   at = (size_t)(2 * y) * (size_t)side + (size_t)(2 * x), to = (size_t)y * (size_t)half + (size_t)x;
            int32_t  owner = NOBODY;
            uint16_t most = 0;
            for (size_t i = 0; i < 4; i++) {
                size_t parent = at + (i & 1) + (i >> 1) * (size_t)side;
                if (m->label[parent] != NOBODY && (owner == NOBODY || finer[parent] > most)) {
                    owner = m->label[parent];
                    most = finer[parent];
                }
            }
            ink[to] = most;
            m->label[to] = owner;
        }
}

/* Marks stay in their order as long as there is too little ink; what is gone stays away on all coarser levels. */
void screen_marks_thin(screen_marks *m, uint16_t *ink, int side, double fraction)
{
    size_t texels = (size_t)side * (size_t)side;
    double wanted = fraction * INK_MOST * (double)texels, sum = 0;
    memset(m->ink, 0, m->count * sizeof *m->ink);
    for (size_t i = 0; i < texels; i++)
        if (m->label[i] != NOBODY)
            m->ink[m->label[i]] += ink[i];
    for (size_t i = 0; i < m->count; i++) {
        size_t mark = m->order[i];
        /* The first always stays: a drawing of one mark is thinned otherwise. */
        m->gone[mark] = m->gone[mark] || (i > 0 && sum + 0.5 * m->ink[mark] > wanted);
        sum += m->gone[mark] ? 0 : m->ink[mark];
    }
    for (size_t i = 0; i < texels; i++)
        if (m->label[i] != NOBODY && m->gone[m->label[i]]) {
            ink[i] = 0;
            m->label[i] = NOBODY;
        }
}
