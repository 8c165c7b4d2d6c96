/* Between two neighbouring positions at which a cover begins or ends, and at which two of them change places, the order
 * of the covers is one, and so is the number of surfaces that the tree makes of them. */
#include "stroke/solid_cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { SPLITS_MOST = 24 };

solid_cover solid_cover_of(const stroke_view *v, uint32_t item, uint32_t face, double from, double to, double z_from,
                           double z_to)
{
    const edge_solid *s = v->scene->meshes[v->scene->items[item].mesh].solid;
    uint32_t          own = face - v->items[item].first_face;
    return (solid_cover){from, to, {z_from, z_to}, item, s->operands[own], s->planes[own], true};
}

bool solid_covers_put(solid_covers *c, const solid_cover *cover)
{
    if (!mem_grow((void **)&c->items, &c->capacity, c->count + 1, sizeof *c->items))
        return false;
    c->items[c->count++] = *cover;
    return true;
}

void solid_covers_release(solid_covers *c)
{
    for (size_t i = 0; i < c->state_count; i++)
        solid_state_release(&c->states[i]);
    mem_free(c->states);
    mem_free(c->items);
    mem_free(c->stops);
    mem_free(c->active);
    mem_free(c->hits);
    memset(c, 0, sizeof *c);
}

static solid_state *state_of(solid_covers *c, const stroke_view *v, uint32_t item)
{
    if (!c->states) {
        c->states = mem_calloc(v->scene->item_count + 1, sizeof *c->states);
        c->state_count = c->states ? v->scene->item_count : 0;
    }
    if (!c->states)
        return NULL;
    solid_state *s = &c->states[item];
    if (!s->program && !solid_state_open(s, &v->scene->meshes[v->scene->items[item].mesh].solid->program))
        return NULL;
    return s;
}

/* By item, then by where they begin; what begins together in a fixed order. */
static int compare_covers(const void *a, const void *b)
{
    const solid_cover *p = a, *q = b;
    if (p->item != q->item)
        return p->item < q->item ? -1 : 1;
    if (p->from != q->from)
        return p->from < q->from ? -1 : 1;
    if (p->to != q->to)
        return p->to < q->to ? -1 : 1;
    if (p->z[0] != q->z[0])
        return p->z[0] < q->z[0] ? -1 : 1;
    return (p->operand > q->operand) - (p->operand < q->operand);
}

static int compare_doubles(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* --- one stretch ---------------------------------------------------------------------------------------- */

typedef struct sweep {
    solid_covers      *c;
    const stroke_view *v;
    solid_state       *state;
    solid_step         step;
    void              *user;
    uint32_t           before; /* surfaces in front of the last stretch */
} sweep;

static double depth_at(const solid_cover *c, double at)
{
    return c->z[0] + (at - c->from) / (c->to - c->from) * (c->z[1] - c->z[0]);
}

/* The first cover of those of its plane, of which all have one depth. */
static const solid_cover *plane_of(const sweep *s, size_t active)
{
    const solid_cover *own = &s->c->items[s->c->active[active]];
    for (size_t i = 0; i < active && own->plane; i++)
        if (s->c->items[s->c->active[i]].plane == own->plane)
            return &s->c->items[s->c->active[i]];
    return own;
}

/* Active covers in the order of their depths in the middle of a stretch. */
static void sort_active(sweep *s, double middle)
{
    size_t *a = s->c->active;
    for (size_t i = 1; i < s->c->active_count; i++) {
        size_t moved = a[i], k = i;
        double z = depth_at(&s->c->items[moved], middle);
        for (; k > 0 && depth_at(&s->c->items[a[k - 1]], middle) > z; k--)
            a[k] = a[k - 1];
        a[k] = moved;
    }
}

/* A position within the stretch at which two covers that follow each other change places. */
static bool find_exchange(const sweep *s, double from, double to, double *at)
{
    double margin = (to - from) * 1e-6;
    for (size_t i = 1; i < s->c->active_count; i++) {
        const solid_cover *p = &s->c->items[s->c->active[i - 1]], *q = &s->c->items[s->c->active[i]];
        if (p->plane && p->plane == q->plane)
            continue;
        double low = depth_at(q, from) - depth_at(p, from), high = depth_at(q, to) - depth_at(p, to);
        if ((low < 0) == (high < 0))
            continue;
        *at = from + low / (low - high) * (to - from);
        if (*at > from + margin && *at < to - margin)
            return true;
    }
    return false;
}

static uint32_t count_entries(sweep *s, double middle)
{
    solid_covers *c = s->c;
    size_t        count = 0;
    bool          around = s->v->around[c->items[c->active[0]].item];
    /* What is met an odd number of times held at the eye already. */
    for (size_t i = 0; i < c->active_count && around; i++)
        solid_state_pass(s->state, c->items[c->active[i]].operand);
    for (size_t i = 0; i < c->active_count; i++) {
        const solid_cover *own = &c->items[c->active[i]];
        if (own->nearer)
            c->hits[count++] = (solid_hit){depth_at(plane_of(s, i), middle), own->operand, own->plane, true};
    }
    uint32_t out = solid_count_entries(s->state, c->hits, count).all;
    for (size_t i = 0; i < c->active_count && around; i++)
        solid_state_pass(s->state, c->items[c->active[i]].operand);
    return out;
}

static void count_stretch(sweep *s, double from, double to)
{
    for (int splits = 0; from < to; splits++) {
        double end = to, at;
        for (int k = 0; k < SPLITS_MOST && s->c->active_count > 1; k++) {
            sort_active(s, (from + end) / 2);
            if (!find_exchange(s, from, end, &at))
                break;
            end = at;
        }
        uint32_t now = s->c->active_count ? count_entries(s, (from + end) / 2) : 0;
        if (now != s->before)
            s->step(s->user, from, (int32_t)now - (int32_t)s->before);
        s->before = now;
        from = splits < SPLITS_MOST ? end : to;
    }
}

/* --- one solid ------------------------------------------------------------------------------------------ */

static size_t find_stops(solid_covers *c, const solid_cover *covers, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        c->stops[2 * i] = covers[i].from;
        c->stops[2 * i + 1] = covers[i].to;
    }
    if (count)
        qsort(c->stops, 2 * count, sizeof *c->stops, compare_doubles);
    for (size_t i = 0; i < 2 * count; i++)
        if (kept == 0 || c->stops[kept - 1] < c->stops[i])
            c->stops[kept++] = c->stops[i];
    return kept;
}

static void sweep_solid(sweep *s, size_t first, size_t count)
{
    solid_covers *c = s->c;
    size_t        stops = find_stops(c, c->items + first, count), next = first;
    c->active_count = 0;
    s->before = 0;
    for (size_t i = 0; i + 1 < stops; i++) {
        size_t kept = 0;
        for (size_t k = 0; k < c->active_count; k++)
            if (c->items[c->active[k]].to > c->stops[i])
                c->active[kept++] = c->active[k];
        for (; next < first + count && c->items[next].from <= c->stops[i]; next++)
            c->active[kept++] = next;
        c->active_count = kept;
        count_stretch(s, c->stops[i], c->stops[i + 1]);
    }
    if (s->before)
        s->step(s->user, c->stops[stops - 1], -(int32_t)s->before);
}

bool solid_covers_count(solid_covers *c, const stroke_view *v, solid_step step, void *user)
{
    if (!mem_grow((void **)&c->stops, &c->stop_capacity, 2 * c->count, sizeof *c->stops) ||
        !mem_grow((void **)&c->active, &c->active_capacity, c->count, sizeof *c->active) ||
        !mem_grow((void **)&c->hits, &c->hit_capacity, c->count, sizeof *c->hits))
        return false;
    if (c->count)
        qsort(c->items, c->count, sizeof *c->items, compare_covers);
    for (size_t i = 0, end; i < c->count; i = end) {
        for (end = i; end < c->count && c->items[end].item == c->items[i].item;)
            end++;
        sweep s = {.c = c, .v = v, .state = state_of(c, v, c->items[i].item), .step = step, .user = user};
        if (!s.state)
            return false;
        sweep_solid(&s, i, end - i);
    }
    return true;
}
