/* The normal form of solids: a tree, its simplified form and its partial products say the same of every point and
 * of every choice of operands. Rows K01, C2. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "csg_tree/products.h"

enum { OPERANDS_MAX = 40 };

/* A scene with one unit box as its mesh. */
static lmn_scene *scene_with_box(void)
{
    static const vec3     corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const uint32_t indices[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                         1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    lmn_scene            *scene = scene_new();
    mesh                 *m = scene_append_mesh(scene);
    primitive             p = {.vertex_count = 8,
                               .index_count = 36,
                               .material = NONE,
                               .positions = mem_copy(corners, sizeof corners),
                               .indices = mem_copy(indices, sizeof indices),
                               .bounds = {{0, 0, 0}, {1, 1, 1}}};
    assert_true(mesh_set_primitives(m, &p, 1));
    return scene;
}

static uint32_t next(uint32_t *state, uint32_t below)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) % below;
}

static void add_operand(solid *s, int32_t parent, uint32_t *random)
{
    int32_t n = solid_append(s, parent, SOLID_OPERAND);
    s->nodes[n].mesh = 0;
    for (int k = 0; k < 3; k++) {
        s->nodes[n].matrix.m[5 * k] = 1 + next(random, 5);
        s->nodes[n].matrix.m[12 + k] = next(random, 8);
    }
}

/* A tree of boxes on a grid, so that they touch, hold and miss each other. */
static void grow(solid *s, int32_t parent, uint32_t *random, int depth, size_t *operands, size_t most)
{
    uint32_t count = 1 + next(random, 4);
    for (uint32_t i = 0; i < count && *operands < most; i++) {
        if (depth == 0 || next(random, 3) == 0) {
            add_operand(s, parent, random);
            ++*operands;
        } else {
            int32_t child = solid_append(s, parent, SOLID_UNION + (solid_kind)next(random, 3));
            grow(s, child, random, depth - 1, operands, most);
        }
    }
}

static bool tree_holds(const solid *s, int32_t index, const bool *inside)
{
    const solid_node *n = &s->nodes[index];
    if (n->kind == SOLID_OPERAND)
        return inside[index];
    bool any = false, all = n->first_child != NONE, first = false, others = false;
    for (int32_t c = n->first_child; c != NONE; c = s->nodes[c].next_sibling) {
        bool holds = tree_holds(s, c, inside);
        any = any || holds;
        all = all && holds;
        if (c == n->first_child)
            first = holds;
        else
            others = others || holds;
    }
    return n->kind == SOLID_UNION ? any : n->kind == SOLID_INTERSECTION ? all : first && !others;
}

static bool form_holds(const solid_form *f, int32_t index, const bool *inside)
{
    if (index == NONE)
        return false;
    const term *t = &f->terms[index];
    if (t->kind == TERM_OPERAND)
        return inside[f->operands[t->operand].node];
    bool value = t->kind == TERM_AND;
    for (int32_t c = t->first; c != NONE; c = f->terms[c].next) {
        bool holds = form_holds(f, c, inside) != f->terms[c].negated;
        value = t->kind == TERM_AND ? value && holds : value || holds;
    }
    return value;
}

static bool products_hold(const product_list *l, const solid_form *f, const bool *inside)
{
    for (size_t i = 0; i < l->count; i++) {
        bool holds = true;
        for (size_t k = 0; k < l->items[i].count; k++)
            holds = holds && inside[f->operands[l->items[i].operands[k]].node] == (k < l->items[i].kept);
        if (holds)
            return true;
    }
    return false;
}

typedef struct both {
    lmn_scene   *scene;
    solid       *solid;
    solid_form   form[2]; /* pruned or not */
    product_list products[2];
} both;

static void open_both(both *b, uint32_t seed, size_t most)
{
    uint32_t  random = seed;
    size_t    operands = 0;
    lmn_error error;
    b->scene = scene_with_box();
    b->solid = scene_append_solid(b->scene, SOLID_UNION + (solid_kind)(seed % 3));
    grow(b->solid, 0, &random, 3, &operands, most);
    assert_true(solid_measure(b->scene, b->solid));
    for (int pruned = 0; pruned < 2; pruned++) {
        assert_int_equal(solid_form_create(&b->form[pruned], b->solid, pruned, &error), LMN_OK);
        assert_int_equal(
            solid_products_create(&b->products[pruned], &b->form[pruned], b->form[pruned].root, pruned, &error),
            LMN_OK);
    }
}

static void close_both(both *b)
{
    for (int pruned = 0; pruned < 2; pruned++) {
        solid_products_release(&b->products[pruned]);
        solid_form_release(&b->form[pruned]);
    }
    scene_free(b->scene);
}

/* Without pruning nothing is known of where operands are: every choice of them must agree. */
static void test_every_choice_of_operands(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 60; seed++) {
        both b;
        open_both(&b, seed * 77u, 9);
        bool inside[1024] = {false};
        assert_true(b.solid->node_count < 1024);
        assert_false(b.products[0].too_many);
        for (uint32_t choice = 0; choice < 1u << b.form[0].operand_count; choice++) {
            for (size_t i = 0; i < b.form[0].operand_count; i++)
                inside[b.form[0].operands[i].node] = choice >> i & 1;
            bool truth = tree_holds(b.solid, 0, inside);
            assert_int_equal(form_holds(&b.form[0], b.form[0].root, inside), truth);
            assert_int_equal(products_hold(&b.products[0], &b.form[0], inside), truth);
        }
        close_both(&b);
    }
}

/* With pruning, every cell of the grid that the boxes lie on. */
static void test_every_cell_of_the_grid(void **state)
{
    (void)state;
    size_t pruned = 0, whole = 0;
    for (uint32_t seed = 1; seed <= 80; seed++) {
        both b;
        open_both(&b, seed * 131u, 24);
        for (int cell = 0; cell < 14 * 14 * 14; cell++) {
            const double at[3] = {cell % 14 + 0.5, cell / 14 % 14 + 0.5, cell / 196 + 0.5};
            bool         inside[1024] = {false};
            for (size_t i = 0; i < b.form[0].operand_count; i++) {
                const double *m = b.form[0].operands[i].matrix.m;
                bool          holds = true;
                for (int k = 0; k < 3; k++)
                    holds = holds && at[k] > m[12 + k] && at[k] < m[12 + k] + m[5 * k];
                inside[b.form[0].operands[i].node] = holds;
            }
            bool truth = tree_holds(b.solid, 0, inside);
            assert_int_equal(form_holds(&b.form[1], b.form[1].root, inside), truth);
            if (!b.products[1].too_many)
                assert_int_equal(products_hold(&b.products[1], &b.form[1], inside), truth);
            if (!b.products[0].too_many)
                assert_int_equal(products_hold(&b.products[0], &b.form[0], inside), truth);
        }
        pruned += b.products[1].count;
        whole += b.products[0].too_many ? PRODUCTS_MAX : b.products[0].count;
        close_both(&b);
    }
    assert_true(pruned < whole);
}

/* (a + b)(c + d)(e + f) … doubles with each factor: past the limit there is no list, and no memory is lost. */
static void test_too_many_products(void **state)
{
    (void)state;
    lmn_error  error;
    lmn_scene *scene = scene_with_box();
    solid     *s = scene_append_solid(scene, SOLID_INTERSECTION);
    for (int i = 0; i < 14; i++) {
        int32_t either = solid_append(s, 0, SOLID_UNION);
        for (int k = 0; k < 2; k++) {
            int32_t at = solid_append(s, either, SOLID_OPERAND); /* moves the nodes */
            s->nodes[at].mesh = 0;
        }
    }
    assert_true(solid_measure(scene, s));
    solid_form   f;
    product_list l;
    assert_int_equal(solid_form_create(&f, s, true, &error), LMN_OK);
    assert_int_equal(solid_products_create(&l, &f, f.root, true, &error), LMN_OK);
    assert_true(l.too_many);
    assert_int_equal(l.count, 0);
    solid_products_release(&l);
    solid_form_release(&f);
    scene_free(scene);
}

static void test_memory(void **state)
{
    (void)state;
    for (long n = 1; n < 400; n += 7) {
        uint32_t   random = 5;
        size_t     operands = 0;
        lmn_error  error;
        lmn_scene *scene = scene_with_box();
        solid     *s = scene_append_solid(scene, SOLID_DIFFERENCE);
        grow(s, 0, &random, 3, &operands, 12);
        assert_true(solid_measure(scene, s));
        solid_form   f;
        product_list l = {.count = 0};
        mem_fail_at(n);
        lmn_status status = solid_form_create(&f, s, true, &error);
        if (status == LMN_OK)
            status = solid_products_create(&l, &f, f.root, true, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        solid_products_release(&l);
        solid_form_release(&f);
        scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_choice_of_operands),
        cmocka_unit_test(test_every_cell_of_the_grid),
        cmocka_unit_test(test_too_many_products),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
