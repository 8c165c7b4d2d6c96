#include "csg_tree/program.h"

#include <string.h>

#include "base/memory.h"

static bool append(uint32_t (**list)[2], size_t *count, size_t *capacity, uint32_t a, uint32_t b)
{
    if (!mem_grow((void **)list, capacity, *count + 1, sizeof **list))
        return false;
    (*list)[*count][0] = a;
    (*list)[*count][1] = b;
    ++*count;
    return true;
}

/* Adds a term and what is below it; `link` leads upwards. */
static bool add(csg_program *p, const solid_form *f, int32_t index, uint32_t link, bool taken_away)
{
    const term *t = &f->terms[index];
    if (t->kind == TERM_OPERAND) {
        if (!mem_grow((void **)&p->taken_away, &p->taken_capacity, p->operand_count + 1, sizeof *p->taken_away))
            return false;
        p->taken_away[p->operand_count] = taken_away;
        return append(&p->operands, &p->operand_count, &p->operand_capacity, link, (uint32_t)p->solid_count);
    }
    uint32_t own = (uint32_t)p->term_count, negated = 0;
    for (int32_t c = t->first; c != NONE; c = f->terms[c].next)
        negated += f->terms[c].negated;
    /* Where nothing is, what is taken away holds already. */
    uint32_t need = t->kind == TERM_OR ? 1 : (uint32_t)t->count - negated;
    if (!append(&p->terms, &p->term_count, &p->term_capacity, link, need))
        return false;
    for (int32_t c = t->first; c != NONE; c = f->terms[c].next)
        if (!add(p, f, c, (own + 1) << 1 | f->terms[c].negated, taken_away != f->terms[c].negated))
            return false;
    return true;
}

bool csg_program_add(csg_program *p, const solid_form *form)
{
    bool good = form->root == NONE || add(p, form, form->root, 0, false);
    p->solid_count++;
    return good;
}

void csg_program_release(csg_program *p)
{
    mem_free(p->operands);
    mem_free(p->taken_away);
    mem_free(p->terms);
    memset(p, 0, sizeof *p);
}
