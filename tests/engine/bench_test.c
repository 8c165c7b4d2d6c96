/* Looks that need unlike things of the meshes are measured in one call, in any order: walls for facades, fields for
 * hatching, places at rest for what is perturbed, other normals, rounding. */
#include "checked.h"

#include <jansson.h>
#include <stdio.h>

static json_t *measured(const char *const *looks, size_t count)
{
    lmn_renderer *renderer = NULL;
    lmn_scene    *scene = NULL;
    char         *text = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 48;
    DO(lmn_renderer_create(&renderer, NULL, &error));
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, EXAMPLES "/house.glb", NULL, &error));
    DO(lmn_bench_json(&text, renderer, scene, looks, count, &desc, 1, &error));
    json_t *root = json_loads(text, 0, NULL);
    assert_non_null(root);
    lmn_text_free(text);
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
    return root;
}

static void looks_of_unlike_needs_in_one_call(void **state)
{
    (void)state;
    static const char *const looks[] = {"city", "hatch", "toon", "sketch"};
    json_t                  *root = measured(looks, 4), *table = json_object_get(root, "looks");
    assert_int_equal(json_object_size(table), 4);
    for (int i = 0; i < 4; i++)
        assert_true(json_number_value(json_object_get(json_object_get(table, looks[i]), "ms")) > 0);
    json_decref(root);
}

static void plain_frames_alone(void **state)
{
    (void)state;
    json_t *root = measured(NULL, 0);
    assert_int_equal(json_object_size(json_object_get(root, "looks")), 0);
    assert_true(json_number_value(json_object_get(root, "plain_ms")) > 0);
    json_decref(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(looks_of_unlike_needs_in_one_call),
                                       cmocka_unit_test(plain_frames_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
