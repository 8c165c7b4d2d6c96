#include "contact/touch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "contact/sphere.h"
#include "contact/surface.h"
#include "contact/touch_private.h"

/* --- surfaces in pieces ------------------------------------------------------------------------------------------- */

typedef struct piece_list {
    touch_piece *items;
    size_t       count, capacity;
    bool         failed; /* out of memory */
} piece_list;

static void take_sphere(touch_piece *out, const sphere *s, const mat4 *world)
{
    out->is_sphere = true;
    for (int k = 0; k < 3; k++) {
        out->centre[k] = world->m[k] * s->centre[0] + world->m[4 + k] * s->centre[1] + world->m[8 + k] * s->centre[2] +
                         world->m[12 + k];
        for (int a = 0; a < 3; a++)
            out->radii[k][a] = s->radius * world->m[4 * k + a];
    }
}

/* Which way triangles that close are wound: their areas, as vectors, sum up to nothing, and their volume has a sign. */
static int outward_of(const touch_piece *p)
{
    double sum[3] = {0, 0, 0}, whole = 0, volume = 0;
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        const double *first = p->vertices[p->indices[0]];
        double        c[3][3], a[3], b[3], area[3];
        for (int k = 0; k < 3; k++)
            vector3_add(c[k], p->vertices[p->indices[i + (uint32_t)k]], -1, first);
        vector3_add(a, c[1], -1, c[0]);
        vector3_add(b, c[2], -1, c[0]);
        vector3_cross(area, a, b);
        vector3_add(sum, sum, 1, area);
        whole += vector3_length(area);
        volume += vector3_dot(area, c[0]);
    }
    const bool closes = vector3_length(sum) < 1e-5 * whole && fabs(volume) > 1e-9 * whole * sqrt(whole);
    return !closes ? 0 : volume > 0 ? 1 : -1;
}

static void take_piece(const surface_piece *seen, void *user)
{
    piece_list  *l = user;
    touch_piece  piece = {.part = seen->part,
                          .indices = seen->from->indices,
                          .vertex_count = seen->from->vertex_count,
                          .index_count = seen->from->index_count};
    sphere       s;
    const size_t size = (piece.vertex_count + 1) * sizeof *piece.vertices;
    if (l->failed || piece.index_count < 3)
        return;
    piece.vertices = mem_copy(seen->vertices, size - sizeof *piece.vertices);
    l->failed = !piece.vertices || !mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items);
    if (l->failed) {
        mem_free(piece.vertices);
        return;
    }
    if (!seen->deformed && sphere_of(&s, seen->from))
        take_sphere(&piece, &s, &seen->world);
    piece.outward = outward_of(&piece);
    piece.world = seen->world;
    piece.is_turned = !piece.is_sphere && !seen->deformed && piece.outward && turned_of(&piece.turned, seen->from);
    l->items[l->count++] = piece;
}

static void release_pieces(piece_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        mem_free(l->items[i].vertices);
    mem_free(l->items);
    memset(l, 0, sizeof *l);
}

static lmn_status list_part(piece_list *out, const pose *p, size_t part, lmn_error *error)
{
    lmn_status status = surface_visit(p, part, take_piece, out, error);
    return status == LMN_OK && out->failed ? error_memory(error) : status;
}

/* --- what has been found ------------------------------------------------------------------------------------------ */

lmn_status touch_keep(touch_places *all, const touch_place *one, double gone, double tie, lmn_error *error)
{
    if (all->count > 0 && gone > all->first + tie)
        return LMN_OK;
    if (all->count > 0 && gone < all->first - tie)
        all->count = 0;
    all->first = all->count > 0 ? fmin(all->first, gone) : gone;
    if (!mem_grow((void **)&all->items, &all->capacity, all->count + 1, sizeof *all->items))
        return error_memory(error);
    all->items[all->count++] = *one;
    return LMN_OK;
}

/* A face before an edge, then what lies most against the motion. */
static const touch_place *best_of(const touch_places *all, const double along[3])
{
    const touch_place *best = &all->items[0];
    for (size_t i = 1; i < all->count; i++) {
        const touch_place *one = &all->items[i];
        const double       more = vector3_dot(best->normal, along) - vector3_dot(one->normal, along);
        if (one->of_face != best->of_face ? one->of_face : more > 1e-9)
            best = one;
    }
    return best;
}

/* --- all pairs ---------------------------------------------------------------------------------------------------- */

typedef struct touch_search {
    const pose         *p;
    const touch_motion *motion;
    box3                box; /* of the own parts */
    piece_list          own;
    bool                is_listed;
    const bool         *own_parts;
    double              size;
} touch_search;

static bool is_near(const touch_search *s, const box3 *other, double within)
{
    const float off = (float)(within * 1.00001 + 1e-6 * s->size);
    return s->box.min.x <= other->max.x + off && other->min.x <= s->box.max.x + off &&
           s->box.min.y <= other->max.y + off && other->min.y <= s->box.max.y + off &&
           s->box.min.z <= other->max.z + off && other->min.z <= s->box.max.z + off;
}

static lmn_status list_own(touch_search *s, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < s->p->scene->part_count && status == LMN_OK && !s->is_listed; i++)
        if (s->own_parts[i])
            status = list_part(&s->own, s->p, i, error);
    s->is_listed = true;
    return status;
}

static lmn_status meet_as_meshes(touch_places *all, const touch_piece *own, const touch_piece *other,
                                 const touch_pair *how, lmn_error *error)
{
    touch_pair pair = *how;
    pair.own = own->is_sphere || !other->is_sphere ? own : other;
    pair.other = pair.own == own ? other : own;
    return pair.own->is_sphere ? touch_round(all, &pair, pair.own != own, error) : touch_sweep(all, &pair, error);
}

/* Both as meshes in which what stands for a cylinder or a cone has vertices where they meet. */
static lmn_status meet_turned(touch_places *all, const touch_piece *own, const touch_piece *other,
                              const touch_pair *how, const touch_met *met, lmn_error *error)
{
    touch_piece finer[2] = {{0}};
    lmn_status  status = LMN_OK;
    if (own->is_turned)
        status = touch_lathe(&finer[0], own, other, how->along, how->within, met, error);
    if (status == LMN_OK && other->is_turned)
        status = touch_lathe(&finer[1], other, own, how->along, how->within, met ? met + 1 : NULL, error);
    if (status == LMN_OK)
        status =
            meet_as_meshes(all, finer[0].vertices ? &finer[0] : own, finer[1].vertices ? &finer[1] : other, how, error);
    touch_lathe_release(&finer[0]);
    touch_lathe_release(&finer[1]);
    return status;
}

/* Of cylinders and cones first where they meet, exactly, and then along which line or area they do. */
static lmn_status meet_pieces(touch_places *all, const touch_piece *own, const touch_piece *other,
                              const touch_pair *how, lmn_error *error)
{
    touch_met    met[2]; /* of the own piece, of the other */
    touch_pair   exact = *how;
    touch_places first = {.first = INFINITY};
    if (!own->is_turned && !other->is_turned)
        return meet_as_meshes(all, own, other, how, error);
    exact.tie *= 1e-4;
    lmn_status status = meet_turned(&first, own, other, &exact, NULL, error);
    if (status == LMN_OK && first.count > 0) {
        const touch_place *best = best_of(&first, how->along);
        for (int i = 0; i < 2; i++) {
            vector3_copy(met[i].place, best->own);
            vector3_set(met[i].facing, 0, 0, 0);
            vector3_add(met[i].facing, met[i].facing, i ? 1 : -1, best->normal);
        }
        status = meet_turned(all, own, other, how, met, error);
    }
    mem_free(first.items);
    return status;
}

/* The first places at which the own parts meet those of another one. */
static lmn_status meet_part(touch *out, bool *found, touch_search *s, size_t part, const touch_pair *how,
                            lmn_error *error)
{
    piece_list   theirs = {0};
    touch_places all = {.first = INFINITY};
    lmn_status   status = list_own(s, error);
    if (status == LMN_OK)
        status = list_part(&theirs, s->p, part, error);
    for (size_t i = 0; i < s->own.count; i++)
        for (size_t k = 0; k < theirs.count && status == LMN_OK; k++)
            status = meet_pieces(&all, &s->own.items[i], &theirs.items[k], how, error);
    *found = status == LMN_OK && all.count > 0;
    if (*found) {
        const touch_place *best = best_of(&all, how->along);
        *out = (touch){.part = part, .gap = best->gap};
        vector3_copy(out->normal, best->normal);
        status = touch_middle(&all, out->normal, out->place, error);
    }
    release_pieces(&theirs);
    mem_free(all.items);
    return status;
}

/* A place of the own surface that is nearest to another part: from each other's nearest place to the next one. */
static lmn_status nearest_to_part(double at[3], touch_search *s, size_t part, lmn_error *error)
{
    enum { STEPS = 8 };
    surface_place there;
    bool          found = true, *theirs = mem_calloc(s->p->scene->part_count + 1, sizeof *theirs);
    lmn_status    status = theirs ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        theirs[part] = true;
    for (int i = 0; i < STEPS && status == LMN_OK && found; i++) {
        status = surface_nearest(&there, &found, s->p, i % 2 ? s->own_parts : theirs, at, INFINITY, error);
        if (found)
            vector3_copy(at, there.place);
    }
    mem_free(theirs);
    return status;
}

/* Another part, when it is near enough and both come together. */
static lmn_status try_part(touch *out, bool *found, touch_search *s, size_t part, lmn_error *error)
{
    const touch_motion *m = s->motion;
    touch_pair          how = {.within = m->reach, .tie = 1e-5 * s->size};
    double              middle[3];
    touch               here;
    bool                meets = false, good = false;
    if (!is_near(s, &s->p->part_boxes[part], m->reach))
        return LMN_OK;
    box3_middle(s->box, middle);
    lmn_status status = m->turns ? nearest_to_part(middle, s, part, error) : LMN_OK;
    if (status == LMN_OK)
        status = m->approach(how.along, m->user, part, middle, error);
    if (status != LMN_OK || !vector3_normalise(how.along))
        return status;
    status = meet_part(&here, &meets, s, part, &how, error);
    if (status == LMN_OK && meets && (!*found || fabs(here.gap) < fabs(out->gap)))
        status = m->accepts(&good, m->user, &here, error);
    if (good) {
        *out = here;
        *found = true;
    }
    return status;
}

lmn_status touch_find(touch *out, bool *found, const pose *p, const bool *own, const bool *others,
                      const touch_motion *motion, lmn_error *error)
{
    touch_search s = {.p = p, .motion = motion, .box = box3_empty(), .own_parts = own};
    lmn_status   status = LMN_OK;
    *found = false;
    for (size_t i = 0; i < p->scene->part_count; i++)
        if (own[i])
            s.box = box3_union(s.box, p->part_boxes[i]);
    if (box3_is_empty(s.box))
        return LMN_OK;
    s.size = box3_diagonal(s.box) / 2;
    for (size_t i = 0; i < p->scene->part_count && status == LMN_OK; i++)
        if (others[i] && !own[i])
            status = try_part(out, found, &s, i, error);
    release_pieces(&s.own);
    return status == LMN_OK ? work_check(error) : status;
}
