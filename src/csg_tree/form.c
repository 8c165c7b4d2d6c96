#include "csg_tree/form.h"

#include <string.h>

#include "base/memory.h"

/* A term that is empty. */
enum { EMPTY = NONE };

/* NONE − 1 when memory is gone, since NONE is a term of its own here. */
enum { NO_MEMORY = NONE - 1 };

static int32_t add_term(solid_form *f, term_kind kind)
{
    if (!mem_grow((void **)&f->terms, &f->term_capacity, f->term_count + 1, sizeof *f->terms))
        return NO_MEMORY;
    f->terms[f->term_count] =
        (term){.kind = kind, .operand = NONE, .first = NONE, .last = NONE, .next = NONE, .box = box3_empty()};
    return (int32_t)f->term_count++;
}

static void add_child(solid_form *f, int32_t parent, int32_t child, bool negated)
{
    term *p = &f->terms[parent], *c = &f->terms[child];
    c->negated = negated;
    c->next = NONE;
    if (p->last == NONE)
        p->first = child;
    else
        f->terms[p->last].next = child;
    p->last = child;
    p->count++;
}

/* Adds a term to a parent of the same or another kind; what has the parent's kind is dissolved in it. */
static void add_dissolved(solid_form *f, int32_t parent, int32_t child, bool negated)
{
    /* Taking away a union is taking away each of its operands. */
    bool dissolves = f->terms[child].kind == (negated ? TERM_OR : f->terms[parent].kind);
    if (!dissolves) {
        add_child(f, parent, child, negated);
        return;
    }
    for (int32_t c = f->terms[child].first, next; c != NONE; c = next) {
        next = f->terms[c].next;
        add_child(f, parent, c, negated || f->terms[c].negated);
    }
}

static void set_box(solid_form *f, int32_t index)
{
    term *t = &f->terms[index];
    bool  begun = false;
    for (int32_t c = t->first; c != NONE; c = f->terms[c].next) {
        box3 box = f->terms[c].box;
        if (t->kind == TERM_OR)
            t->box = box3_union(t->box, box);
        else if (!f->terms[c].negated)
            t->box = begun ? box3_intersection(t->box, box) : box;
        begun = true;
    }
}

/* A union or intersection of one is that one. */
static int32_t without_shell(const solid_form *f, int32_t index)
{
    return f->terms[index].count == 0 ? EMPTY : f->terms[index].count == 1 ? f->terms[index].first : index;
}

static int32_t make_union(solid_form *f, const solid *s, int32_t node, const int32_t *made)
{
    int32_t out = add_term(f, TERM_OR);
    for (int32_t c = s->nodes[node].first_child; c != NONE && out != NO_MEMORY; c = s->nodes[c].next_sibling)
        if (made[c] != EMPTY)
            add_dissolved(f, out, made[c], false);
    if (out == NO_MEMORY)
        return out;
    set_box(f, out);
    return without_shell(f, out);
}

/* Intersections, and differences as intersections with what is not there. */
static int32_t make_intersection(solid_form *f, const solid *s, int32_t node, const int32_t *made)
{
    bool    takes_away = s->nodes[node].kind == SOLID_DIFFERENCE;
    int32_t first = solid_first_shown(s, node);
    if (first == NONE || made[first] == EMPTY)
        return EMPTY;
    int32_t out = add_term(f, TERM_AND);
    if (out == NO_MEMORY)
        return out;
    add_dissolved(f, out, made[first], false);
    for (int32_t c = solid_next_shown(s, first); c != NONE; c = solid_next_shown(s, c)) {
        if (made[c] == EMPTY && !takes_away)
            return EMPTY;
        if (made[c] != EMPTY)
            add_dissolved(f, out, made[c], takes_away);
    }
    set_box(f, out);
    return without_shell(f, out);
}

/* Children come after their parents in the array, so that from the back every operand is made before who needs it. */
static lmn_status make_terms(solid_form *f, const solid *s, lmn_error *error)
{
    int32_t *made = mem_alloc(sizeof *made * s->node_count);
    if (!made)
        return error_memory(error);
    for (size_t i = 0; i < s->node_count; i++)
        made[i] = EMPTY;
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < f->operand_count && status == LMN_OK; i++) {
        int32_t t = add_term(f, TERM_OPERAND);
        if (t == NO_MEMORY) {
            status = error_memory(error);
            break;
        }
        f->terms[t].operand = (int32_t)i;
        f->terms[t].box = f->operands[i].box;
        made[f->operands[i].node] = t;
    }
    for (size_t i = s->node_count; i-- > 0 && status == LMN_OK;) {
        solid_kind kind = s->nodes[i].kind;
        if (kind == SOLID_OPERAND)
            continue;
        made[i] = kind == SOLID_UNION ? make_union(f, s, (int32_t)i, made) : make_intersection(f, s, (int32_t)i, made);
        if (made[i] == NO_MEMORY)
            status = error_memory(error);
    }
    f->root = status == LMN_OK ? made[0] : EMPTY;
    mem_free(made);
    return status;
}

/* The first operand of an intersection that is no longer there takes all with it. Returns what is left of a term
 * inside `bound`. */
static int32_t prune(solid_form *f, int32_t index, box3 bound)
{
    box3 box = box3_intersection(f->terms[index].box, bound);
    if (box3_is_empty(box))
        return EMPTY;
    if (f->terms[index].kind == TERM_OPERAND)
        return index;
    bool    all = f->terms[index].kind == TERM_AND;
    int32_t child = f->terms[index].first;
    f->terms[index].first = f->terms[index].last = NONE;
    f->terms[index].count = 0;
    f->terms[index].box = box3_empty();
    for (int32_t next; child != NONE; child = next) {
        next = f->terms[child].next;
        bool    negated = f->terms[child].negated;
        int32_t left = prune(f, child, box);
        if (left == EMPTY && all && !negated)
            return EMPTY;
        if (left != EMPTY)
            add_dissolved(f, index, left, negated);
    }
    set_box(f, index);
    if (box3_is_empty(f->terms[index].box))
        return EMPTY;
    return without_shell(f, index);
}

lmn_status solid_form_create(solid_form *out, const solid *s, bool pruned, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->root = EMPTY;
    if (!solid_operands(s, &out->operands, &out->operand_count))
        return error_memory(error);
    lmn_status status = make_terms(out, s, error);
    if (status == LMN_OK && pruned)
        solid_form_prune(out);
    return status;
}

void solid_form_prune(solid_form *f)
{
    if (f->root != EMPTY)
        f->root = prune(f, f->root, f->terms[f->root].box);
    if (f->root != EMPTY)
        f->terms[f->root].next = NONE;
}

lmn_status solid_form_take_away(solid_form *f, const solid_operand *operands, size_t count, lmn_error *error)
{
    if (f->root == EMPTY || count == 0)
        return LMN_OK;
    solid_operand *grown = mem_realloc(f->operands, (f->operand_count + count) * sizeof *grown);
    int32_t whole = grown ? add_term(f, TERM_AND) : NO_MEMORY, common = grown ? add_term(f, TERM_AND) : NO_MEMORY;
    if (grown)
        f->operands = grown;
    if (whole == NO_MEMORY || common == NO_MEMORY)
        return error_memory(error);
    for (size_t i = 0; i < count; i++) {
        int32_t t = add_term(f, TERM_OPERAND);
        if (t == NO_MEMORY)
            return error_memory(error);
        f->operands[f->operand_count] = operands[i];
        f->terms[t].operand = (int32_t)f->operand_count++;
        f->terms[t].box = operands[i].box;
        add_child(f, common, t, false);
    }
    set_box(f, common);
    add_dissolved(f, whole, f->root, false);
    add_dissolved(f, whole, without_shell(f, common), true);
    set_box(f, whole);
    f->root = whole;
    return LMN_OK;
}

void solid_form_release(solid_form *f)
{
    mem_free(f->operands);
    mem_free(f->terms);
    memset(f, 0, sizeof *f);
}

static size_t used_below(const solid_form *f, int32_t index, int32_t *out)
{
    const term *t = &f->terms[index];
    if (t->kind == TERM_OPERAND) {
        *out = t->operand;
        return 1;
    }
    size_t count = 0;
    for (int32_t c = t->first; c != NONE; c = f->terms[c].next)
        count += used_below(f, c, out + count);
    return count;
}

size_t solid_form_used(const solid_form *f, int32_t *out)
{
    return f->root == EMPTY ? 0 : used_below(f, f->root, out);
}
