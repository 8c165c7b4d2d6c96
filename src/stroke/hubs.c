#include "stroke/hubs.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Fewer faces than this are compared as all others are. */
enum { HUB_LEAST = 64 };
/* What directions may be off by beyond `same`, as lengths of unit vectors. */
#define DIRECTION_MARGIN 1e-3

typedef struct hub_key {
    uint32_t hub, face;
} hub_key;

bool hubs_find(uint32_t *hubs, const hub_faces *faces)
{
    uint32_t most = 0;
    for (size_t i = 0; i < faces->count; i++)
        for (int k = 0; k < 3; k++)
            most = faces->corners[i][k] > most ? faces->corners[i][k] : most;
    uint32_t *shared = mem_calloc((size_t)most + 1, sizeof *shared);
    for (size_t i = 0; i < faces->count && shared; i++)
        for (int k = 0; k < 3; k++)
            shared[faces->corners[i][k]]++;
    for (size_t i = 0; i < faces->count && shared; i++) {
        const uint32_t *c = faces->corners[i];
        uint32_t        hub = c[0];
        for (int k = 1; k < 3; k++)
            hub = shared[c[k]] > shared[hub] ? c[k] : hub;
        hubs[i] = shared[hub] >= HUB_LEAST ? hub : KIN_MIXED;
    }
    mem_free(shared);
    return shared != NULL;
}

/* The directions from the hub to a face lie on an arc between those to its other corners; the box around them. */
static box3 direction_box(const hub_faces *faces, uint32_t face, uint32_t hub, void *user)
{
    const uint32_t *c = faces->corners[face];
    const int       at = c[0] == hub ? 0 : c[1] == hub ? 1 : 2;
    const double3   middle = faces->position(user, face, at);
    double          units[2][3], margin = DIRECTION_MARGIN, chord = 0;
    for (int k = 0; k < 2; k++) {
        double3 way = double3_minus(faces->position(user, face, (at + 1 + k) % 3), middle);
        double  length = sqrt(double3_dot(way, way));
        if (!(length > 4 * faces->same))
            return (box3){{-2, -2, -2}, {2, 2, 2}};
        margin += 4 * faces->same / length;
        units[k][0] = way.x / length;
        units[k][1] = way.y / length;
        units[k][2] = way.z / length;
    }
    for (int k = 0; k < 3; k++)
        chord += (units[1][k] - units[0][k]) * (units[1][k] - units[0][k]);
    margin += 1 - sqrt(fmax(1 - 0.25 * chord, 0)); /* the arc's rise over its chord */
    float low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = (float)(fmin(units[0][k], units[1][k]) - margin);
        high[k] = (float)(fmax(units[0][k], units[1][k]) + margin);
    }
    return (box3){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

static int compare_hubs(const void *a, const void *b)
{
    const hub_key *p = a, *q = b;
    return p->hub != q->hub ? (p->hub < q->hub ? -1 : 1) : (p->face > q->face) - (p->face < q->face);
}

/* Those of a hub, with what a tree is made of, which lie together. */
typedef struct hub_group {
    hub_key       *keys;
    box3          *boxes;
    uint32_t      *kin[2];
    hierarchy_pair pair;
    void          *user;
    const hub_key *own;
} hub_group;

static bool pair_of_group(void *user, uint32_t a, uint32_t b)
{
    const hub_group *g = user;
    return g->pair(g->user, g->own[a].face, g->own[b].face);
}

static lmn_status pairs_of_hub(hub_group *g, const hub_faces *faces, size_t begin, size_t end, bool *going,
                               lmn_error *error)
{
    g->own = g->keys + begin;
    for (size_t i = 0; i < end - begin; i++) {
        g->boxes[i] = direction_box(faces, g->own[i].face, g->own[i].hub, g->user);
        g->kin[0][i] = faces->pieces[g->own[i].face];
        g->kin[1][i] = faces->planes[g->own[i].face];
    }
    const hierarchy_kin kin = {{g->kin[0], g->kin[1]}};
    hierarchy           tree;
    lmn_status          status = hierarchy_build(&tree, g->boxes, kin, (uint32_t)(end - begin), error);
    if (status != LMN_OK)
        return status;
    *going = hierarchy_pairs(&tree, g->boxes, kin, pair_of_group, g);
    hierarchy_release(&tree);
    return LMN_OK;
}

lmn_status hubs_pairs(const uint32_t *hubs, const hub_faces *faces, hierarchy_pair pair, void *user, bool *going,
                      lmn_error *error)
{
    size_t count = 0;
    *going = true;
    for (size_t i = 0; i < faces->count; i++)
        count += hubs[i] != KIN_MIXED;
    if (count == 0)
        return LMN_OK;
    hub_group  g = {.keys = mem_alloc(count * sizeof *g.keys),
                    .boxes = mem_alloc(count * sizeof *g.boxes),
                    .kin = {mem_alloc(count * sizeof **g.kin), mem_alloc(count * sizeof **g.kin)},
                    .pair = pair,
                    .user = user};
    lmn_status status = g.keys && g.boxes && g.kin[0] && g.kin[1] ? LMN_OK : error_memory(error);
    count = 0;
    for (uint32_t i = 0; i < faces->count && status == LMN_OK; i++)
        if (hubs[i] != KIN_MIXED)
            g.keys[count++] = (hub_key){hubs[i], i};
    if (status == LMN_OK)
        qsort(g.keys, count, sizeof *g.keys, compare_hubs);
    for (size_t begin = 0, end = 0; begin < count && status == LMN_OK && *going; begin = end) {
        while (end < count && g.keys[end].hub == g.keys[begin].hub)
            end++;
        status = pairs_of_hub(&g, faces, begin, end, going, error);
    }
    mem_free(g.keys);
    mem_free(g.boxes);
    mem_free(g.kin[0]);
    mem_free(g.kin[1]);
    return status;
}
