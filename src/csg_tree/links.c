#include "csg_tree/links.h"

#include "base/error.h"
#include "base/memory.h"

static int32_t sibling_before(const solid *s, int32_t parent, int32_t child)
{
    int32_t before = NONE;
    for (int32_t c = s->nodes[parent].first_child; c != child; c = s->nodes[c].next_sibling)
        before = c;
    return before;
}

solid_seat solid_unlink(solid *s, int32_t node)
{
    solid_node *n = &s->nodes[node], *above = &s->nodes[n->parent];
    solid_seat  seat = {n->parent, n->next_sibling};
    int32_t     before = sibling_before(s, n->parent, node);
    if (before == NONE)
        above->first_child = n->next_sibling;
    else
        s->nodes[before].next_sibling = n->next_sibling;
    if (above->last_child == node)
        above->last_child = before;
    n->next_sibling = NONE;
    return seat;
}

void solid_link(solid *s, int32_t node, solid_seat seat)
{
    solid_node *n = &s->nodes[node], *above = &s->nodes[seat.parent];
    int32_t before = seat.next_sibling == NONE ? above->last_child : sibling_before(s, seat.parent, seat.next_sibling);
    n->parent = seat.parent;
    n->next_sibling = seat.next_sibling;
    if (before == NONE)
        above->first_child = node;
    else
        s->nodes[before].next_sibling = node;
    if (seat.next_sibling == NONE)
        above->last_child = node;
}

static void translate(int32_t *link, const int32_t *now)
{
    if (*link != NONE)
        *link = now[*link];
}

lmn_status solid_arrange(solid *s, lmn_error *error)
{
    solid_node *nodes = mem_alloc(s->node_count * sizeof *nodes);
    int32_t    *now = mem_alloc(s->node_count * sizeof *now), *positions = mem_alloc(s->id_count * sizeof *positions);
    if (!nodes || !now || !positions) {
        mem_free(nodes);
        mem_free(now);
        mem_free(positions);
        return error_memory(error);
    }
    size_t count = 0;
    for (size_t i = 0; i < s->id_count; i++)
        positions[i] = NONE;
    for (int32_t i = 0; i != NONE; i = solid_next(s, 0, i)) {
        now[i] = (int32_t)count;
        positions[s->nodes[i].id - 1] = (int32_t)count;
        nodes[count++] = s->nodes[i];
    }
    for (size_t i = 0; i < count; i++) {
        translate(&nodes[i].parent, now);
        translate(&nodes[i].first_child, now);
        translate(&nodes[i].last_child, now);
        translate(&nodes[i].next_sibling, now);
    }
    mem_free(now);
    s->node_capacity = s->node_count;
    s->position_capacity = s->id_count;
    s->nodes = nodes;
    s->positions = positions;
    s->node_count = count;
    return LMN_OK;
}
