/* Every condition that a kind or a technique states names parameters and values that exist where it is looked up:
 * one that is misspelt would never hold, and nothing would say so. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "look/look.h"

/* What conditions are held against, and what has been found so far. */
typedef struct walk {
    const kind      *kind;
    const technique *technique;
    int              checked, mistakes;
} walk;

static void check(walk *w, const char *of, const char *condition, const param *params, size_t count)
{
    lmn_error error = {0};
    w->checked += condition != NULL;
    if (params_condition_check(condition, params, count, &error) == LMN_OK)
        return;
    print_error("%s, %s, of %s: %s\n", w->kind->name, w->technique ? w->technique->name : "common", of, error.message);
    w->mistakes++;
}

static void check_own(walk *w, const char *of, const char *condition)
{
    check(w, of, condition, w->technique->params, w->technique->param_count);
}

/* Of the kind's common parameters or of the technique's own ones, never of both: pass_applies looks them up in one
 * table. */
static void check_pass(walk *w, const pass *p)
{
    const kind *k = w->kind;
    if (params_condition_check(p->when, k->common, k->common_count, NULL) == LMN_OK)
        check(w, p->name, p->when, k->common, k->common_count);
    else
        check_own(w, p->name, p->when);
}

/* Of passes that are run in any case, a condition would be overlooked. */
static void check_unconditional(walk *w, const pass *p)
{
    if (!p->when)
        return;
    print_error("%s: %s is run whatever '%s' says\n", w->kind->name, p->name, p->when);
    w->mistakes++;
}

static void check_rows(walk *w, const param *params, size_t count)
{
    for (size_t i = 0; i < count; i++)
        check(w, params[i].key, params[i].only_if, params, count);
}

static void check_technique(walk *w)
{
    const technique *t = w->technique;
    const kind      *lines = kinds[KIND_LINES];
    check_rows(w, t->params, t->param_count);
    for (size_t i = 0; i < t->pass_count; i++)
        check_pass(w, &t->passes[i]);
    for (size_t i = 0; i < t->texture_count; i++)
        check_own(w, t->textures[i].name, t->textures[i].when);
    if (t->perturbs && t->perturbs->map)
        check_unconditional(w, t->perturbs->map);
    if (t->compose) {
        check(w, "merges_when", t->compose->merges_when, lines->common, lines->common_count);
        check_own(w, "map_when", t->compose->map_when);
    }
    if (t->surface) {
        check_own(w, "light_map_when", t->surface->light_map_when);
        check_own(w, "forward_when", t->surface->forward_when);
        check_own(w, "deferred_when", t->surface->deferred_when);
    }
}

static void test_every_condition(void **state)
{
    (void)state;
    walk w = {0};
    for (size_t i = 0; i < KIND_COUNT; i++) {
        w.kind = kinds[i];
        w.technique = NULL;
        check_rows(&w, w.kind->common, w.kind->common_count);
        if (w.kind->fold)
            check_unconditional(&w, w.kind->fold);
        for (size_t n = 0; n < w.kind->technique_count; n++) {
            w.technique = w.kind->techniques[n];
            check_technique(&w);
        }
    }
    print_message("%d conditions\n", w.checked);
    assert_true(w.checked > 100);
    assert_int_equal(w.mistakes, 0);
}

/* Whoever draws follows the pointer of the technique's kind without asking. */
static void test_every_technique_has_the_row_of_its_kind(void **state)
{
    (void)state;
    for (size_t i = 0; i < KIND_COUNT; i++)
        for (size_t n = 0; n < kinds[i]->technique_count; n++) {
            const technique *t = kinds[i]->techniques[n];
            const kind_id    id = kinds[i]->id;
            if (!t->surface != (id != KIND_SURFACE) || !t->lines != (id != KIND_LINES) ||
                !t->compose != (id != KIND_COMPOSE) || !t->layers != (id != KIND_LAYERS) ||
                !t->perturbs != (id != KIND_PERTURB) || !t->motion != (id != KIND_MOTION))
                fail_msg("%s '%s' lacks the row of its kind, or has another's", kinds[i]->name, t->name);
            assert_true(id != KIND_SURFACE || t->surface->shader);
            assert_true(id != KIND_LAYERS || t->layers->layering);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_condition),
                                       cmocka_unit_test(test_every_technique_has_the_row_of_its_kind)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
