/* The frame's uniforms have one list, src/technique/frame.glsl: no shader declares one of them again, and no
 * parameter is called like one. */
#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/embedded.h"
#include "look/look.h"

#define LIST "technique/frame.glsl"

enum { NAME_SIZE = 64, NAMES_MAX = 64 };

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

static const char *skip_word(const char *at, char out[NAME_SIZE])
{
    size_t length = 0;
    while (isspace((unsigned char)*at))
        at++;
    while (is_word(at[length]) && length + 1 < NAME_SIZE)
        length++;
    memcpy(out, at, length);
    out[length] = '\0';
    return at + length;
}

/* The uniforms that GLSL declares, as many as fit. */
static size_t uniforms_of(const char *glsl, char names[][NAME_SIZE])
{
    size_t count = 0;
    char   type[NAME_SIZE];
    for (const char *at = glsl; (at = strstr(at, "uniform ")) && count < NAMES_MAX; at += 8)
        if (at == glsl || at[-1] == '\n') {
            const char *behind = skip_word(at + 8, type);
            skip_word(behind, names[count++]);
        }
    return count;
}

static size_t list(char names[][NAME_SIZE])
{
    for (size_t i = 0; i < embedded_shaders_count; i++)
        if (strcmp(embedded_shaders[i].path, LIST) == 0)
            return uniforms_of(embedded_shaders[i].data, names);
    fail_msg("%s is not in the library", LIST);
    return 0;
}

static bool contains(char names[][NAME_SIZE], size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

static void test_declared_once(void **state)
{
    (void)state;
    static char frame[NAMES_MAX][NAME_SIZE], own[NAMES_MAX][NAME_SIZE];
    size_t      count = list(frame);
    assert_true(count > 20 && contains(frame, count, "u_size") && contains(frame, count, "u_window_depth") &&
                contains(frame, count, "u_rest"));
    for (size_t i = 0; i < embedded_shaders_count; i++) {
        const char *path = embedded_shaders[i].path;
        size_t      found = uniforms_of(embedded_shaders[i].data, own);
        assert_true(found < NAMES_MAX);
        for (size_t k = 0; k < found; k++)
            if (strcmp(path, LIST) != 0 && contains(frame, count, own[k]))
                fail_msg("src/%s declares %s, which src/%s has", path, own[k], LIST);
    }
}

/* No guards: a uniform that needs one is declared in two positions. */
static void test_no_guards(void **state)
{
    (void)state;
    for (size_t i = 0; i < embedded_shaders_count; i++)
        if (strstr(embedded_shaders[i].data, "_DECLARED"))
            fail_msg("src/%s guards a declaration", embedded_shaders[i].path);
}

static void check_params(const kind *k, const param *params, size_t param_count, char frame[][NAME_SIZE], size_t count)
{
    const char *prefix = k->id == KIND_LINES ? "u_line_" : k->id == KIND_PERTURB ? "u_perturb_" : "u_";
    char        name[2 * NAME_SIZE];
    for (size_t i = 0; i < param_count; i++) {
        snprintf(name, sizeof name, "%s%s", prefix, params[i].key);
        if (!params[i].cpu_only && !params[i].variant && contains(frame, count, name))
            fail_msg("%s.%s would be declared as %s, which src/%s has", k->name, params[i].key, name, LIST);
    }
}

static void test_parameters(void **state)
{
    (void)state;
    static char frame[NAMES_MAX][NAME_SIZE];
    size_t      count = list(frame);
    for (int k = 0; k < KIND_COUNT; k++) {
        check_params(kinds[k], kinds[k]->common, kinds[k]->common_count, frame, count);
        for (size_t i = 0; i < kinds[k]->technique_count; i++)
            check_params(kinds[k], kinds[k]->techniques[i]->params, kinds[k]->techniques[i]->param_count, frame, count);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_declared_once),
        cmocka_unit_test(test_no_guards),
        cmocka_unit_test(test_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
