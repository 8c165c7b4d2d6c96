/* A solid's tree evaluated step by step, as in csg/resolve.frag: an operand is entered or left, and the terms above it
 * are counted. Roth 1982. */
#include "stroke/solid.h"

#include <string.h>

#include "base/memory.h"

bool solid_state_open(solid_state *s, const csg_program *program)
{
    s->program = program;
    s->value = false;
    s->inside = mem_calloc(program->operand_count + 1, sizeof *s->inside);
    s->held = mem_calloc(program->term_count + 1, sizeof *s->held);
    return s->inside && s->held;
}

void solid_state_release(solid_state *s)
{
    mem_free(s->inside);
    mem_free(s->held);
    memset(s, 0, sizeof *s);
}

void solid_state_pass(solid_state *s, uint32_t operand)
{
    bool     value = s->inside[operand] = !s->inside[operand];
    uint32_t link = s->program->operands[operand][0];
    while (link != 0) {
        uint32_t        term = (link >> 1) - 1;
        const uint32_t *above = s->program->terms[term];
        bool            more = value != ((link & 1) != 0);
        int32_t         before = s->held[term], after = before + (more ? 1 : -1), need = (int32_t)above[1];
        s->held[term] = after;
        value = after >= need;
        if (value == (before >= need))
            return;
        link = above[0];
    }
    s->value = value;
}

/* By insertion: few lie on one line, and most come in order. */
static void sort_hits(solid_hit *hits, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        solid_hit moved = hits[i];
        size_t    k = i;
        for (; k > 0 && (hits[k - 1].at > moved.at || (hits[k - 1].at == moved.at && hits[k - 1].plane > moved.plane));
             k--)
            hits[k] = hits[k - 1];
        hits[k] = moved;
    }
}

/* What lies in one plane lies at one place, however it was rounded. */
static void gather_planes(solid_hit *hits, size_t count)
{
    for (size_t i = 1; i < count; i++)
        for (size_t k = 0; k < i && hits[i].plane; k++)
            if (hits[k].plane == hits[i].plane) {
                hits[i].at = hits[k].at;
                break;
            }
}

/* Goes through the hits that are one event, from the first on. Returns the one behind them. */
static size_t pass_event(solid_state *s, const solid_hit *hits, size_t count, size_t first, bool *sure)
{
    size_t end = first;
    *sure = true;
    for (; end < count && (end == first ||
                           (hits[end].plane && hits[end].plane == hits[first].plane && hits[end].at == hits[first].at));
         end++) {
        solid_state_pass(s, hits[end].operand);
        *sure = *sure && hits[end].sure;
    }
    return end;
}

solid_entries solid_count_entries(solid_state *s, solid_hit *hits, size_t count)
{
    solid_entries out = {0, 0};
    bool          around = s->value;
    gather_planes(hits, count);
    sort_hits(hits, count);
    for (size_t i = 0; i < count;) {
        bool before = s->value, sure;
        i = pass_event(s, hits, count, i, &sure);
        bool entered = s->value != before && (s->value || around);
        around = around && s->value;
        out.all += entered;
        out.sure += entered && sure;
    }
    for (size_t i = 0; i < count; i++)
        solid_state_pass(s, hits[i].operand);
    return out;
}

bool solid_first_entry(solid_state *s, solid_hit *hits, size_t count, double *at)
{
    bool   before = s->value, found = false, sure;
    size_t passed = 0;
    gather_planes(hits, count);
    sort_hits(hits, count);
    while (passed < count && !found) {
        *at = hits[passed].at;
        passed = pass_event(s, hits, count, passed, &sure);
        found = s->value != before;
    }
    for (size_t i = 0; i < passed; i++)
        solid_state_pass(s, hits[i].operand);
    return found;
}
