#include "stroke/propagate.h"

#include <string.h>

#include "base/memory.h"

enum { UNKNOWN, FRONT, BACK };

typedef struct propagator {
    const butterfly *b;
    propagate_front  is_front;
    void            *user;
    uint32_t         level, first;                    /* first: the one of which all faces are asked for */
    uint8_t         *facing[BUTTERFLY_STEPS_MAX + 1]; /* per face: UNKNOWN where it is as its parent is */
    uint8_t         *touched;                         /* per face of the level: shares a vertex with the silhouette */
    uint32_t        *band;                            /* faces of the level that were asked for, in that order */
    size_t           band_count, band_capacity;
    silhouette      *out;
} propagator;

/* As far as it is known without asking. */
static uint8_t facing_of(const propagator *p, uint32_t level, uint32_t face)
{
    for (;; level--, face /= 4)
        if (p->facing[level][face] != UNKNOWN || level == p->first)
            return p->facing[level][face];
}

static bool ask(propagator *p, uint32_t face)
{
    if (p->facing[p->level][face] != UNKNOWN)
        return true;
    if (!mem_grow((void **)&p->band, &p->band_capacity, p->band_count + 1, sizeof *p->band))
        return false;
    p->facing[p->level][face] = p->is_front(p->user, p->level, face) ? FRONT : BACK;
    p->out->tested[p->level]++;
    p->band[p->band_count++] = face;
    return true;
}

/* Asks on beyond each face that differs from what lies beside it. */
static bool widen_band(propagator *p)
{
    const butterfly_level *l = &p->b->levels[p->level];
    for (size_t i = 0; i < p->band_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t o = l->opposite[3 * p->band[i] + k];
            if (o != BUTTERFLY_NONE && facing_of(p, p->level, o / 3) != p->facing[p->level][p->band[i]] &&
                !ask(p, o / 3))
                return false;
        }
    return true;
}

static bool is_silhouette(const propagator *p, uint32_t h)
{
    uint32_t o = p->b->levels[p->level].opposite[h];
    return o != BUTTERFLY_NONE && p->facing[p->level][h / 3] == FRONT && p->facing[p->level][o / 3] == BACK;
}

/* All faces around the vertex that a half-edge begins at. */
static void touch_fan(propagator *p, uint32_t h)
{
    const butterfly_level *l = &p->b->levels[p->level];
    uint32_t               at = h;
    do {
        p->touched[at / 3] = 1;
        at = l->opposite[half_edge_before(at)];
    } while (at != BUTTERFLY_NONE && at != h);
    for (at = at == h ? BUTTERFLY_NONE : l->opposite[h]; at != BUTTERFLY_NONE && at != h;
         at = l->opposite[at]) { /* the other way round, from a border on */
        at = half_edge_next(at);
        p->touched[at / 3] = 1;
    }
}

static bool propagate_level(propagator *p)
{
    const butterfly_level *l = &p->b->levels[p->level];
    p->touched = mem_calloc((size_t)l->face_count + 1, 1);
    p->facing[p->level + 1] = mem_calloc((size_t)l->face_count * 4 + 1, 1);
    if (!p->touched || !p->facing[p->level + 1])
        return false;
    for (size_t i = 0; i < p->band_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t h = 3 * p->band[i] + k;
            if (is_silhouette(p, h)) {
                touch_fan(p, h);
                touch_fan(p, half_edge_next(h));
            }
        }
    bool     good = true;
    uint32_t count = l->face_count;
    p->level++;
    p->band_count = 0;
    for (uint32_t f = 0; f < count && good; f++)
        for (uint32_t k = 0; p->touched[f] && k < 4 && good; k++)
            good = ask(p, 4 * f + k);
    mem_free(p->touched);
    p->touched = NULL;
    return good && widen_band(p);
}

static bool put_silhouette(propagator *p)
{
    size_t         capacity = 0;
    const uint8_t *facing = p->facing[p->level];
    for (uint32_t f = 0; f < p->b->levels[p->level].face_count; f++)
        for (uint32_t k = 0; facing[f] == FRONT && k < 3; k++)
            if (is_silhouette(p, 3 * f + k)) {
                if (!mem_grow((void **)&p->out->halves, &capacity, p->out->count + 1, sizeof *p->out->halves))
                    return false;
                p->out->halves[p->out->count++] = 3 * f + k;
            }
    return true;
}

lmn_status silhouette_propagate(silhouette *out, const butterfly *b, uint32_t all_of, propagate_front is_front,
                                void *user, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    propagator p = {.b = b, .is_front = is_front, .user = user, .out = out};
    while (p.level + 1 < b->level_count && b->levels[p.level + 1].face_count <= all_of)
        p.level++;
    p.first = p.level;
    p.facing[p.level] = mem_calloc((size_t)b->levels[p.level].face_count + 1, 1);
    bool good = p.facing[p.level] != NULL;
    for (uint32_t f = 0; f < b->levels[p.level].face_count && good; f++)
        good = ask(&p, f);
    while (p.level + 1 < b->level_count && good)
        good = propagate_level(&p);
    good = good && put_silhouette(&p);
    for (uint32_t i = 0; i < b->level_count; i++)
        mem_free(p.facing[i]);
    mem_free(p.touched);
    mem_free(p.band);
    if (!good)
        silhouette_release(out);
    return good ? LMN_OK : error_memory(error);
}

void silhouette_release(silhouette *s)
{
    mem_free(s->halves);
    memset(s, 0, sizeof *s);
}
