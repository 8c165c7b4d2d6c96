#include "csg_tree/products.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* What multiplying out needs to know. */
typedef struct expansion {
    const solid_form *form;
    bool              prune;
    size_t            total;  /* operands of all products made so far */
    bool              failed; /* memory is gone */
} expansion;

static const box3 everywhere = {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};

void solid_products_release(product_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        mem_free(l->items[i].operands);
    mem_free(l->items);
    memset(l, 0, sizeof *l);
}

static void give_up(product_list *l)
{
    solid_products_release(l);
    l->too_many = true;
}

/* Takes the product over. */
static void append(expansion *e, product_list *l, product p)
{
    e->total += p.count;
    if (l->too_many || l->count >= PRODUCTS_MAX || e->total > PRODUCT_OPERANDS_MAX) {
        mem_free(p.operands);
        give_up(l);
    } else if (!mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items)) {
        mem_free(p.operands);
        e->failed = true;
    } else {
        l->items[l->count++] = p;
    }
}

static void append_literal(expansion *e, product_list *l, int32_t operand, bool negated)
{
    product p = {.operands = mem_alloc(sizeof *p.operands),
                 .kept = !negated,
                 .count = 1,
                 .box = negated ? everywhere : e->form->operands[operand].box};
    if (!p.operands) {
        e->failed = true;
        return;
    }
    p.operands[0] = operand;
    append(e, l, p);
}

static bool contains(const int32_t *operands, size_t count, int32_t which)
{
    for (size_t i = 0; i < count; i++)
        if (operands[i] == which)
            return true;
    return false;
}

/* Adds to `out` what was not there before and is not pruned. */
static size_t join(const expansion *e, int32_t *out, size_t count, const int32_t *more, size_t more_count,
                   const box3 *bound)
{
    size_t before = count;
    for (size_t i = 0; i < more_count; i++)
        if (!contains(out, before, more[i]) && (!bound || box3_overlap(e->form->operands[more[i]].box, *bound)))
            out[count++] = more[i];
    return count;
}

/* The intersection of two products; nothing when it is empty. */
static void multiply_pair(expansion *e, product_list *out, const product *a, const product *b)
{
    product p = {.box = box3_intersection(a->box, b->box)};
    bool    bounded = a->kept + b->kept > 0;
    if (e->prune && bounded && box3_is_empty(p.box))
        return;
    p.operands = mem_alloc((a->count + b->count) * sizeof *p.operands);
    if (!p.operands) {
        e->failed = true;
        return;
    }
    const box3 *bound = e->prune && bounded ? &p.box : NULL;
    p.kept = join(e, p.operands, 0, a->operands, a->kept, NULL);
    p.kept = join(e, p.operands, p.kept, b->operands, b->kept, NULL);
    int32_t *taken = p.operands + p.kept;
    size_t   taken_count = join(e, taken, 0, a->operands + a->kept, a->count - a->kept, bound);
    taken_count = join(e, taken, taken_count, b->operands + b->kept, b->count - b->kept, bound);
    p.count = p.kept + taken_count;
    for (size_t i = 0; i < taken_count; i++)
        if (contains(p.operands, p.kept, taken[i])) { /* both there and not there */
            mem_free(p.operands);
            return;
        }
    append(e, out, p);
}

/* Operands of products that are about to go. */
static size_t operands_of(const product_list *l)
{
    size_t sum = 0;
    for (size_t i = 0; i < l->count; i++)
        sum += l->items[i].count;
    return sum;
}

static void multiply(expansion *e, product_list *into, product_list *by)
{
    e->total -= operands_of(into) + operands_of(by);
    product_list out = {.too_many = into->too_many || by->too_many};
    for (size_t i = 0; i < into->count && !out.too_many && !e->failed; i++)
        for (size_t k = 0; k < by->count && !out.too_many && !e->failed; k++)
            multiply_pair(e, &out, &into->items[i], &by->items[k]);
    if (out.too_many)
        give_up(&out);
    solid_products_release(into);
    solid_products_release(by);
    *into = out;
}

/* A union adds products, an intersection multiplies them; under a negation it is the other way round. */
static void expand(expansion *e, product_list *out, int32_t index, bool negated)
{
    const term *t = &e->form->terms[index];
    if (t->kind == TERM_OPERAND) {
        append_literal(e, out, t->operand, negated);
        return;
    }
    bool adds = (t->kind == TERM_OR) != negated;
    bool begun = false;
    for (int32_t c = t->first; c != NONE && !e->failed && !out->too_many; c = e->form->terms[c].next) {
        product_list one = {.count = 0};
        expand(e, &one, c, negated != e->form->terms[c].negated);
        if (adds) {
            e->total -= operands_of(&one);
            for (size_t i = 0; i < one.count; i++)
                append(e, out, one.items[i]);
            bool too_many = one.too_many;
            mem_free(one.items);
            if (too_many)
                give_up(out);
        } else if (begun) {
            multiply(e, out, &one);
        } else {
            *out = one;
        }
        begun = true;
    }
}

static int by_number(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

lmn_status solid_products_create(product_list *out, const solid_form *form, int32_t index, bool prune, lmn_error *error)
{
    expansion e = {.form = form, .prune = prune};
    memset(out, 0, sizeof *out);
    if (index != NONE)
        expand(&e, out, index, false);
    if (e.failed) {
        solid_products_release(out);
        return error_memory(error);
    }
    for (size_t i = 0; i < out->count; i++) {
        product *p = &out->items[i];
        qsort(p->operands, p->kept, sizeof *p->operands, by_number);
        qsort(p->operands + p->kept, p->count - p->kept, sizeof *p->operands, by_number);
    }
    return LMN_OK;
}
