/* Selectors against a small tree: Truck (attribute kind=vehicle) with Body, Wheel Front and Wheel Rear below
 * Truck/Axle. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "look/selector.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static attribute vehicle[] = {{"kind", "vehicle"}, {"height", "7"}},
                 spare[] = {{"kind", "spare part"},  {"stock", ""},       {"height", "30.0"},
                            {"built", "1898-05-02"}, {"mass", "12.5 kg"}, {"surface", "roof"}};
static node nodes[] = {
    {.parent = NONE, .mesh = NONE, .solid = NONE, .attributes = vehicle, .attribute_count = COUNT(vehicle)},
    {.parent = 0, .mesh = 0, .solid = NONE},
    {.parent = 0, .mesh = 1, .solid = NONE},
    {.parent = 0, .mesh = 1, .solid = 0, .attributes = spare, .attribute_count = COUNT(spare)},
    {.parent = 1, .mesh = NONE, .solid = NONE, .ghost = true},
};
static primitive painted = {.material = 0}, rubber = {.material = 1};
static mesh meshes[] = {{.primitives = &painted, .primitive_count = 1}, {.primitives = &rubber, .primitive_count = 1}};
static material materials[] = {{.name = "Red Paint"}, {.name = "Rubber"}};
static part     parts[] = {{1, "Body", "Truck/Body"},
                           {2, "Wheel Front", "Truck/Axle/Wheel Front"},
                           {3, "Wheel Rear", "Truck/Axle/Wheel Rear"},
                           {4, "removed", "Truck/Body/removed", .ghost = true}};
enum { PARTS = COUNT(parts) - 1 }; /* and a ghost */
static const lmn_scene scene = {.nodes = nodes,
                                .node_count = COUNT(nodes),
                                .meshes = meshes,
                                .mesh_count = COUNT(meshes),
                                .materials = materials,
                                .material_count = COUNT(materials),
                                .parts = parts,
                                .part_count = PARTS,
                                .ghost_count = 1};

static void test_matches(void **state)
{
    (void)state;
    static const struct {
        const char *text, *parts; /* 1 for each part that matches */
    } cases[] = {
        {"*", "111"},
        {"Body", "100"},
        {"body", "000"},
        {"Wheel*", "011"},
        {"\"Wheel Front\"", "010"},
        {"'Wheel Rear', Body", "101"},
        {"Truck/*", "111"},
        {"Truck/Axle/*", "011"},
        {"*/Body", "100"},
        {"!Body", "011"},
        {"!!Body", "100"},
        {"Wheel* !*Rear", "010"},
        {"[kind]", "111"},
        {"[kind=vehicle]", "110"},
        {"[kind=\"spare part\"]", "001"},
        {"[stock]", "001"},
        {"[stock=]", "001"},
        {"[stock=x]", "000"},
        {"[material=Rub*]", "011"},
        {"[material='Red Paint']", "100"},
        {"![material]", "000"},
        {"[id=2]", "010"},
        {"[id=1], [id=3]", "101"},
        {"Wheel*[kind=vehicle]", "010"},
        {"  Body  ", "100"},
        {"[missing]", "000"},
        {"! [id=1]", "011"},
        /* The last one is the ghost: only who says @removed gets it. */
        {"*", "1110"},
        {"removed", "0000"},
        {"[id=4]", "0000"},
        {"!Body", "0110"},
        {"Truck/*", "1110"},
        {"[kind]", "1110"},
        {"@removed", "0001"},
        {"!@removed", "1110"},
        {"!!@removed", "0001"},
        {"*, @removed", "1111"},
        {"Wheel* @removed", "0000"},
        {"@removed Truck/Body/*", "0001"},
        {"@removed !Truck/Body/*", "0000"},
        {"@removed[kind=vehicle]", "0001"},
        {"Body, @removed removed", "1001"},
        {"@solid", "0010"},
        {"!@solid", "1100"},
        {"\"@solid\"", "0000"},
        {"\"@removed\"", "0000"},
        {"@removed !removed, *", "1110"},
        /* Numbers compare as numbers: as text, 7 comes behind 30. */
        {"[height>7]", "001"},
        {"[height>=7]", "111"},
        {"[height<30]", "110"},
        {"[height<=30.00]", "111"},
        {"[height=30]", "001"},
        {"[height=3e1]", "001"},
        {"[height!=30]", "110"},
        {"[height!=x]", "111"},
        {"[missing!=x]", "000"},
        {"![missing=x]", "111"},
        {"[kind!=veh*]", "001"},
        {"[kind>0]", "000"},
        {"[kind<0]", "000"},
        {"[built<1900]", "001"},
        {"[built>1898]", "001"},
        {"[built<1898-05-03]", "001"},
        {"[built<1898-05-02]", "000"},
        {"[built<=1898-05-02]", "001"},
        {"[mass>12]", "001"},
        {"[mass='12.5']", "001"},
        {"[\"height\" > 7]", "000"},
        {"[\"height\">7]", "001"},
        {"[id>1]", "011"},
        {"@roof", "001"},
        {"!@roof", "110"},
        {"@wall", "000"},
        {"@roof[height>50]", "000"},
        {"\"@roof\"", "000"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        selector *s = NULL;
        lmn_error error = {0};
        if (selector_parse(&s, cases[i].text, &error) != LMN_OK)
            fail_msg("%s", error.message);
        for (size_t p = 0; p < COUNT(parts) && cases[i].parts[p]; p++)
            if (selector_matches(s, &scene, p) != (cases[i].parts[p] == '1'))
                fail_msg("'%s' on %s", cases[i].text, parts[p].name);
        assert_false(selector_matches(s, &scene, COUNT(parts)));
        selector_destroy(&s);
        assert_null(s);
    }
}

static void test_names_removed(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        bool        names;
    } cases[] = {{"*", false},         {"@removed", true},    {"a, b @removed", true},
                 {"!@removed", false}, {"'@removed'", false}, {"removed", false}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        selector *s = NULL;
        assert_int_equal(selector_parse(&s, cases[i].text, NULL), LMN_OK);
        assert_int_equal(selector_names_removed(s), cases[i].names);
        selector_destroy(&s);
    }
}

static void test_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",      "  ",       ",",         "a,",   ",a",   "a,,b",       "[",
                                        "[a",    "[]",       "[=x]",      "]",    "\"a",  "!",          "a !",
                                        "@",     "@Removed", "@removed2", "a @x", "[a>]", "[a>b]",      "[a<=x1]",
                                        "[a!b]", "[a!]",     "[>3]",      "[a>3", "@rof", "[a<1999-13]"};
    for (size_t i = 0; i < COUNT(wrong); i++) {
        selector *s = NULL;
        lmn_error error = {0};
        if (selector_parse(&s, wrong[i], &error) != LMN_USAGE)
            fail_msg("'%s' was accepted", wrong[i]);
        assert_null(s);
        assert_non_null(strstr(error.message, "selector"));
    }
}

static void test_memory(void **state)
{
    (void)state;
    lmn_status status = LMN_MEMORY;
    for (long n = 1; status == LMN_MEMORY; n++) {
        selector *s = NULL;
        mem_fail_at(n);
        status = selector_parse(&s, "a, \"b c\" [d=e] !f", NULL);
        mem_fail_at(0);
        assert_true((status == LMN_OK) == (s != NULL));
        selector_destroy(&s);
    }
    assert_int_equal(status, LMN_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_matches),
        cmocka_unit_test(test_names_removed),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
