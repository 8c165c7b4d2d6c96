/* Rows of pictures, and what passes do with them: complete, told apart, made by somebody before they are read. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "stage/uniforms.h"
#include "look/look.h"

static bool is_complete(const target_row *row)
{
    return row->name && strncmp(row->name, "t_", 2) == 0 && row->name[2] && row->format != TEXEL_NONE &&
           row->format < TEXEL_FORMAT_COUNT;
}

static void test_rows(void **state)
{
    (void)state;
    for (int t = TARGET_NONE + 1; t < TARGET_COUNT; t++) {
        const target_row *row = &target_rows[t];
        if (!is_complete(row))
            fail_msg("row %d is not complete: '%s'", t, row->name ? row->name : "");
        if (row->owner == OWNER_TECHNIQUE)
            fail_msg("%s has no owner", row->name);
        for (int k = TARGET_NONE + 1; k < t; k++)
            if (strcmp(row->name, target_rows[k].name) == 0)
                fail_msg("%s is there twice", row->name);
    }
}

/* Calls back for each technique with its kind. */
static void each_technique(void (*see)(const kind *k, const technique *t))
{
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; i < kinds[k]->technique_count; i++)
            see(kinds[k], kinds[k]->techniques[i]);
}

static void see_own_rows(const kind *k, const technique *t)
{
    if (t->target_count > OWN_TARGETS_MAX || (t->target_count > 0) != (t->targets != NULL))
        fail_msg("%s.%s has %zu pictures of its own", k->name, t->name, t->target_count);
    for (size_t i = 0; i < t->target_count; i++) {
        const target_row *row = &t->targets[i];
        if (!is_complete(row) || row->owner != OWNER_TECHNIQUE || row->scale == SCALE_OWN)
            fail_msg("%s.%s: its picture %zu is not complete", k->name, t->name, i);
        for (int other = TARGET_NONE + 1; other < TARGET_COUNT; other++)
            if (strcmp(row->name, target_rows[other].name) == 0)
                fail_msg("%s.%s calls a picture of its own %s, as that of all is called", k->name, t->name, row->name);
        for (size_t other = 0; other < i; other++)
            if (strcmp(row->name, t->targets[other].name) == 0)
                fail_msg("%s.%s has %s twice", k->name, t->name, row->name);
    }
}

static void test_own_rows(void **state)
{
    (void)state;
    each_technique(see_own_rows);
}

static bool reads(const pass *p, target t)
{
    for (int i = 0; i < PASS_READS_MAX && p->reads[i]; i++)
        if (p->reads[i] == t)
            return true;
    return false;
}

/* Passes of movers at each pixel's moments write the depth behind their picture, too. */
static bool pass_writes(const pass *p, target which)
{
    return p->writes == which || (p->writes_too && p->writes_too == which) || (p->scattered && p->writes + 1 == which);
}

/* A pass that is repeated reads what it wrote itself. */
static bool writes_before(const technique *t, size_t end, target which)
{
    for (size_t i = 0; i < end; i++)
        if (pass_writes(&t->passes[i], which))
            return true;
    return t->passes[end].repeat > 1 && t->passes[end].writes == which;
}

/* What a technique reads of its own one of its earlier passes wrote, since it lasts no longer than they run; and no
 * pass names what there is not. */
static void see_own_passes(const kind *k, const technique *t)
{
    for (size_t i = 0; i < t->pass_count; i++) {
        const pass *p = &t->passes[i];
        size_t      known = TARGET_COUNT + t->target_count;
        if (p->writes == TARGET_NONE || p->writes >= known)
            fail_msg("%s.%s, pass '%s', writes what there is not", k->name, t->name, p->name);
        for (int n = 0; n < PASS_READS_MAX && p->reads[n]; n++) {
            if (p->reads[n] >= known)
                fail_msg("%s.%s, pass '%s', reads what there is not", k->name, t->name, p->name);
            if (p->reads[n] >= TARGET_COUNT && !writes_before(t, i, p->reads[n]))
                fail_msg("%s.%s, pass '%s', reads %s, which no pass before has written", k->name, t->name, p->name,
                         t->targets[p->reads[n] - TARGET_COUNT].name);
        }
    }
}

static void test_own_passes(void **state)
{
    (void)state;
    each_technique(see_own_passes);
}

/* Is the own picture of this name read by some technique of the kind that has it? */
static bool kind_reads_own(const kind *k, const char *name)
{
    for (size_t i = 0; i < k->technique_count; i++) {
        const technique *t = k->techniques[i];
        for (size_t row = 0; row < t->target_count; row++)
            for (size_t p = 0; p < t->pass_count && strcmp(t->targets[row].name, name) == 0; p++)
                if (reads(&t->passes[p], TARGET_OWN(row)))
                    return true;
    }
    return false;
}

static void see_use(const kind *k, const technique *t)
{
    for (size_t i = 0; i < t->target_count; i++)
        if (!kind_reads_own(k, t->targets[i].name))
            fail_msg("%s.%s has %s, which nobody reads", k->name, t->name, t->targets[i].name);
}

static void test_own_used(void **state)
{
    (void)state;
    each_technique(see_use);
}

/* What frames make without any pass: the geometry pass, mirrors, the shadow map, the edge map of the layer before, and
 * of movers how they look and move. */
static bool frame_makes(target t)
{
    static const target of_movers[] = {TARGET_PAST_1, TARGET_PAST_2,      TARGET_PAST_3,
                                       TARGET_MOVER,  TARGET_MOVER_DEPTH, TARGET_STRETCHED};
    for (size_t i = 0; i < sizeof of_movers / sizeof *of_movers; i++)
        if (t == of_movers[i])
            return true;
    return (target_rows[t].owner >= OWNER_LAYER && t != TARGET_PAGE && t != TARGET_LAYERS) || t == TARGET_REFLECTION ||
           t == TARGET_EDGE_BEFORE;
}

static bool some_pass(bool (*matches)(const pass *p, target t), target t)
{
    for (int k = 0; k < KIND_COUNT; k++) {
        if (kinds[k]->fold && matches(kinds[k]->fold, t))
            return true;
        for (size_t i = 0; i < kinds[k]->technique_count; i++) {
            const technique *q = kinds[k]->techniques[i];
            if (q->perturbs && q->perturbs->map && matches(q->perturbs->map, t))
                return true;
            for (size_t n = 0; n < q->pass_count; n++)
                if (matches(&q->passes[n], t))
                    return true;
        }
    }
    return false;
}

static bool writes(const pass *p, target t)
{
    return p->writes == t;
}

/* Strips are drawn into pictures that are there. */
static bool makes(const pass *p, target t)
{
    return p->writes == t && !p->strips;
}

static void test_made(void **state)
{
    (void)state;
    for (target t = TARGET_NONE + 1; t < TARGET_COUNT; t++) {
        if (some_pass(reads, t) && !frame_makes(t) && !some_pass(writes, t))
            fail_msg("%s is read, and nobody makes it", target_rows[t].name);
        if (target_rows[t].scale == SCALE_OWN && some_pass(makes, t))
            fail_msg("%s is written by a pass, which cannot tell how large it is", target_rows[t].name);
    }
}

/* A line technique that always reads a channel asks for it: else the picture is not there, and its sampler not
 * declared. */
static void see_channels(const kind *k, const technique *t)
{
    static const struct {
        target  read;
        channel asked;
    } rows[] = {{TARGET_NORMAL_DEPTH, CHANNEL_NORMAL_DEPTH}, {TARGET_ID, CHANNEL_ID}, {TARGET_ALBEDO, CHANNEL_ALBEDO}};
    for (size_t i = 0; i < t->pass_count && k->id == KIND_LINES; i++)
        for (size_t r = 0; r < sizeof rows / sizeof *rows && !t->passes[i].when; r++)
            if (reads(&t->passes[i], rows[r].read) && !((t->channels | t->part_channels) & (unsigned)rows[r].asked))
                fail_msg("%s.%s reads %s and does not ask for it", k->name, t->name, target_rows[rows[r].read].name);
}

/* What a composition may do itself has nothing but what all know. */
static void see_merging(const kind *k, const technique *t)
{
    for (size_t i = 0; i < t->pass_count && t->lines && t->lines->detect; i++)
        for (int n = 0; n < PASS_READS_MAX && t->passes[i].shader && strstr(t->passes[i].shader, t->lines->detect) &&
                        t->passes[i].reads[n];
             n++)
            if (t->passes[i].reads[n] >= TARGET_COUNT)
                fail_msg("%s.%s detects from a picture of its own, which compositions do not have", k->name, t->name);
}

static void test_reads(void **state)
{
    (void)state;
    each_technique(see_channels);
    each_technique(see_merging);
}

static void declares(const target_row *row, const char *expected)
{
    text prelude = {0};
    target_declare(&prelude, row);
    char *made = text_take(&prelude);
    assert_string_equal(made, expected);
    mem_free(made);
}

static void test_declared(void **state)
{
    (void)state;
    declares(&target_rows[TARGET_EDGE], "#ifndef HAS_EDGE\n#define HAS_EDGE\nuniform sampler2D t_edge;\n#endif\n");
    declares(&target_rows[TARGET_NORMAL_DEPTH],
             "#ifndef HAS_NORMAL_DEPTH\n#define HAS_NORMAL_DEPTH\nuniform sampler2D t_normal_depth;\n#endif\n");
    declares(&target_rows[TARGET_OVERSHOOT],
             "#ifndef HAS_OVERSHOOT\n#define HAS_OVERSHOOT\nuniform usampler2D t_overshoot;\n#endif\n");
}

static void test_empty(void **state)
{
    (void)state;
    float out[4];
    target_empty(&target_rows[TARGET_NORMAL_DEPTH], 12.5, out);
    assert_memory_equal(out, ((float[]){0, 0, 1, 12.5f}), sizeof out);
    target_empty(&target_rows[TARGET_EDGE], 12.5, out);
    assert_memory_equal(out, ((float[]){1, 1, 1, 1}), sizeof out);
    target_empty(&target_rows[TARGET_LAYERS], 12.5, out);
    assert_memory_equal(out, ((float[]){0, 0, 0, 1}), sizeof out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows),     cmocka_unit_test(test_own_rows), cmocka_unit_test(test_own_passes),
        cmocka_unit_test(test_own_used), cmocka_unit_test(test_made),     cmocka_unit_test(test_reads),
        cmocka_unit_test(test_declared), cmocka_unit_test(test_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
