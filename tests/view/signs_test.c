/* Expressions in the viewer, without a window: lists of them, scripts that they are saved in, and the signs that a
 * scene has for a state. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

#include "document.h"
#include "expressions.h"

static lmn_error error;

#define DO(call)                                                                                                       \
    do {                                                                                                               \
        if ((call) != LMN_OK)                                                                                          \
            fail_msg("%s: %s", #call, error.message);                                                                  \
    } while (0)

static char *read_text(const char *path)
{
    char *text = NULL;
    assert_true(g_file_get_contents(path, &text, NULL, NULL));
    return text;
}

/* A list is edited from text, of the type that each member has; what is no value of it is refused. */
static void test_expressions_are_edited(void **state)
{
    (void)state;
    double time_s;
    size_t way;
    char  *list = expressions_of_file(EXAMPLES "/scripts/bounce.json", &time_s);
    assert_non_null(list);
    assert_true(time_s > 2);
    const guint count = expressions_count(list);
    assert_true(count > 2 && expressions_depiction(list, 0, &way));
    char *more = expressions_added(list, "ball", "speech");
    assert_int_equal(expressions_count(more), count + 1);
    assert_int_equal(expressions_count(list), count);
    char *loud = expressions_set(more, count, "text", LMN_PARAM_TEXT, "He \"said\" so", &error),
         *wide = expressions_set(loud, count, "size", LMN_PARAM_FLOAT, "0.1", &error),
         *text = expressions_get(wide, count, "text"), *size = expressions_get(wide, count, "size"),
         *none = expressions_get(wide, count, "ink");
    assert_string_equal(text, "He \"said\" so");
    assert_string_equal(size, "0.1");
    assert_null(none);
    assert_null(expressions_set(wide, count, "size", LMN_PARAM_FLOAT, "large", &error));
    assert_int_equal(error.status, LMN_USAGE);
    char *fewer = expressions_removed(wide, count),
         *plain = expressions_set(wide, count, "size", LMN_PARAM_FLOAT, NULL, &error);
    assert_string_equal(fewer, list);
    assert_string_equal(plain, loud);
    char *lists[] = {list, more, loud, wide, fewer, plain};
    for (size_t i = 0; i < G_N_ELEMENTS(lists); i++)
        g_ref_string_release(lists[i]);
    g_free(text);
    g_free(size);
}

/* Only the expressions of a script are others when they are saved; a script without any gets them, and what is no
 * script stays as it is. */
static void test_expressions_are_saved_in_scripts(void **state)
{
    (void)state;
    double time_s;
    char  *folder = g_dir_make_tmp("limner-view-XXXXXX", NULL), *path = g_build_filename(folder, "s.json", NULL);
    static const char begin[] =
        "{\"limner_script\": 1, \"doc\": \"a \\\"expressions\\\": {[\",\n \"units\": {\"expressions\": 3},\n  ",
                      end[] = " ,\n \"nodes\": [ 9.81, 1e-3 ]}\n";
    char *script =
        g_strconcat(begin, "\"expressions\": [{\"target\": \"a\", \"depict\": \"path\", \"gap\": 0.3}]", end, NULL);
    assert_true(g_file_set_contents(path, script, -1, NULL));
    char *list = expressions_of_file(path, &time_s),
         *other = expressions_set(list, 0, "gap", LMN_PARAM_FLOAT, "0.7", &error);
    assert_true(expressions_save(list, path, &error)); /* nothing is different */
    char *same = read_text(path);
    assert_string_equal(same, script);
    g_free(same);
    assert_true(expressions_save(other, path, &error));
    char *saved = read_text(path);
    assert_true(g_str_has_prefix(saved, begin) && g_str_has_suffix(saved, end));
    assert_non_null(strstr(saved, "\"gap\": 0.7}"));
    char *again = expressions_of_file(path, &time_s);
    assert_string_equal(again, other);
    g_free(saved);
    g_free(script);
    script = g_strconcat(begin, "\"up\": \"y\"", end, NULL);
    assert_true(g_file_set_contents(path, script, -1, NULL));
    assert_true(expressions_save(other, path, &error));
    saved = read_text(path);
    char *inserted = expressions_of_file(path, &time_s);
    assert_string_equal(inserted, other);
    assert_true(g_str_has_prefix(saved, begin));
    assert_true(g_file_set_contents(path, "{\"asset\": 1}", -1, NULL));
    assert_false(expressions_save(other, path, &error));
    assert_int_equal(error.status, LMN_USAGE);
    char *lists[] = {list, other, again, inserted};
    for (size_t i = 0; i < G_N_ELEMENTS(lists); i++)
        g_ref_string_release(lists[i]);
    g_free(saved);
    g_free(script);
    g_remove(path);
    g_rmdir(folder);
    g_free(path);
    g_free(folder);
}

static size_t count_parts(const scene_ref *s)
{
    lmn_part_info part;
    size_t        count = 0;
    while (lmn_scene_part_at(s->scene, count, &part))
        count++;
    return count;
}

/* A script comes with its signs; they follow what is told and of whom they are seen, and go when nothing is. */
static void test_signs_are_those_of_the_state(void **state)
{
    (void)state;
    static const char *const paths[] = {EXAMPLES "/scripts/bounce.json", NULL};
    lmn_scene               *scene = NULL;
    lmn_draw_desc            desc;
    const lmn_look          *look;
    lmn_look                *own;
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, paths[0], NULL, &error));
    document *d = document_make();
    document_set_scene(d, scene_ref_make(scene, paths), true, 200, 200);
    scene_ref *s = (scene_ref *)document_scene(d);
    assert_non_null(document_state(d)->told);
    assert_true(document_state(d)->timed && fabs(document_state(d)->time_s - 2.2) < 1e-9);
    state_describe(document_state(d), s, NULL, 200, 200, &desc);
    const size_t files = count_parts(s);
    assert_int_equal(files, s->info.parts);
    DO(scene_ref_prepare(s, document_state(d), &desc, &look, &own, &error));
    const size_t signs = count_parts(s);
    assert_true(signs > files + 3);
    assert_ptr_equal(look, own);
    lmn_look_destroy(&own);
    char *made = g_strdup(s->signs);
    DO(scene_ref_prepare(s, document_state(d), &desc, &look, &own, &error));
    assert_string_equal(made, s->signs); /* nothing is made anew */
    lmn_look_destroy(&own);
    document_set_told(d, expressions_removed(document_state(d)->told, 0), "less");
    DO(scene_ref_prepare(s, document_state(d), &desc, &look, &own, &error));
    assert_true(count_parts(s) < signs && strcmp(made, s->signs) != 0);
    lmn_look_destroy(&own);
    document_set_told(d, expressions_added(NULL, "nobody", "path"), "wrong");
    assert_int_equal(scene_ref_prepare(s, document_state(d), &desc, &look, &own, &error), LMN_FORMAT);
    lmn_look_destroy(&own);
    assert_int_equal(count_parts(s), files);
    for (int i = 0; i < 2; i++)
        assert_true(document_undo(d));
    DO(scene_ref_prepare(s, document_state(d), &desc, &look, &own, &error));
    assert_int_equal(count_parts(s), signs);
    lmn_look_destroy(&own);
    document_set_told(d, NULL, "nothing");
    DO(scene_ref_prepare(s, document_state(d), &desc, &look, &own, &error));
    assert_int_equal(count_parts(s), files);
    assert_null(own);
    g_free(made);
    document_free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_expressions_are_edited),
        cmocka_unit_test(test_expressions_are_saved_in_scripts),
        cmocka_unit_test(test_signs_are_those_of_the_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
