#include "depict/pieces.h"

#include <string.h>

#include "base/error.h"
#include "base/memory.h"

/* A flag a node: is there a part at it or below? NULL: out of memory. */
static bool *find_carriers(const lmn_scene *s)
{
    bool *carries = mem_calloc(s->node_count + 1, sizeof *carries);
    for (size_t i = 0; carries && i < s->part_count; i++)
        for (int32_t n = s->parts[i].node; n != NONE && !carries[n]; n = s->nodes[n].parent)
            carries[n] = true;
    return carries;
}

static lmn_status open_below(pieces *out, const depict_job *j, int32_t node, const bool *carries, lmn_error *error)
{
    const lmn_scene *s = j->scene;
    for (int depth = 0; depth < 64; depth++) {
        int32_t only = NONE;
        size_t  children = 0;
        for (int32_t n = s->nodes[node].first_child; n != NONE; n = s->nodes[n].next_sibling)
            if (carries[n]) {
                only = n;
                children++;
            }
        if (children != 1)
            break;
        node = only;
    }
    for (int32_t n = s->nodes[node].first_child; n != NONE && out->count < PIECES_MOST; n = s->nodes[n].next_sibling)
        if (carries[n]) {
            lmn_status status = target_open(&out->items[out->count++], j, n, error);
            if (status != LMN_OK)
                return status;
        }
    return LMN_OK;
}

lmn_status pieces_open(pieces *out, const depict_job *j, int32_t node, lmn_error *error)
{
    bool *carries = find_carriers(j->scene);
    memset(out, 0, sizeof *out);
    lmn_status status = carries ? open_below(out, j, node, carries, error) : error_memory(error);
    mem_free(carries);
    return status;
}

void pieces_release(pieces *p)
{
    for (size_t i = 0; i < p->count; i++)
        target_release(&p->items[i]);
    p->count = 0;
}

void piece_at(const pieces *p, size_t i, double seconds, double out[3])
{
    way_point(&p->items[i].way, p->items[i].centre, seconds, out);
}

double pieces_spread(const pieces *p, double from, double seconds)
{
    double moved[PIECES_MOST][3], most = 0;
    for (size_t i = 0; i < p->count; i++) {
        double begin[3];
        piece_at(p, i, from, begin);
        piece_at(p, i, seconds, moved[i]);
        vector3_add(moved[i], moved[i], -1, begin);
        for (size_t k = 0; k < i; k++)
            most = fmax(most, vector3_distance(moved[i], moved[k]));
    }
    return most;
}

double pieces_parting(const pieces *p, double from, double to, double apart)
{
    enum { STEPS = 256, HALVINGS = 20 };
    double low = from, high = to;
    for (int i = 1; i <= STEPS; i++) {
        const double seconds = from + (to - from) * i / STEPS;
        if (pieces_spread(p, from, seconds) > apart) {
            high = seconds;
            break;
        }
        low = seconds;
    }
    for (int i = 0; i < HALVINGS && low < high; i++) {
        const double middle = (low + high) / 2;
        if (pieces_spread(p, from, middle) > apart)
            high = middle;
        else
            low = middle;
    }
    return low;
}
