/* Fuzzers of texts: looks, and what stands on a command line. */
#include <string.h>

#include "base/memory.h"
#include "draft/extras.h"
#include "plan/unit.h"
#include "vector/vector_private.h"
#include "fuzz.h"
#include "look/look.h"
#include "cut/cut.h"

/* A look that was accepted prints as one that is accepted. */
static void use_look(lmn_look **look)
{
    lmn_error error;
    char     *json = look_json(*look);
    lmn_look *again = NULL;
    if (json && look_parse(&again, json, strlen(json), "again", NULL, &error) != LMN_OK && error.status != LMN_MEMORY)
        __builtin_trap();
    look_destroy(&again);
    mem_free(json);
    look_destroy(look);
}

void fuzz_look(const uint8_t *bytes, size_t size)
{
    lmn_look *look = NULL;
    lmn_error error;
    if (look_parse(&look, (const char *)bytes, size, "fuzz", NULL, &error) == LMN_OK)
        use_look(&look);
}

/* The first line is the key, the rest the value. What is set is set on a look that ships, chosen by the first byte. */
void fuzz_set(const uint8_t *bytes, size_t size)
{
    lmn_look *look = NULL;
    lmn_error error;
    if (size < 2 || look_load(&look, look_name_at(bytes[0] % lmn_look_count()), NULL, &error) != LMN_OK)
        return;
    char *key = mem_copy_text((const char *)bytes + 1), *value = key ? strchr(key, '\n') : NULL;
    if (value) {
        *value++ = '\0';
        look_set(look, key, value, &error);
    }
    mem_free(key);
    use_look(&look);
}

/* Three parts, one below another, with attributes. */
static const char few_parts[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,3]}],\"nodes\":[{\"name\":\"Truck\","
    "\"children\":[1,2],\"extras\":{\"layer\":\"road\"}},"
    "{\"name\":\"Front Axle\",\"mesh\":0},{\"name\":\"Wheel, left\",\"mesh\":0,\"extras\":{\"size\":3}},{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,"
    "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

void fuzz_selector(const uint8_t *bytes, size_t size)
{
    (void)size;
    selector *s = NULL;
    lmn_error error;
    if (selector_parse(&s, (const char *)bytes, &error) != LMN_OK)
        return;
    lmn_scene *scene = fuzz_read_model(import_gltf.read, 'y', (const uint8_t *)few_parts, sizeof few_parts - 1);
    if (!scene)
        __builtin_trap(); /* the model above is right */
    for (size_t i = 0; i < lmn_scene_info_of(scene).parts; i++)
        selector_matches(s, scene, i);
    scene_free(scene);
    selector_destroy(&s);
}

/* A cut that is accepted cuts a cube. */
void fuzz_cut(const uint8_t *bytes, size_t size)
{
    (void)size;
    static const vec3     corners[8] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                        {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
    static const uint32_t indices[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const box3            bounds = {{-1, -1, -1}, {1, 1, 1}};
    cut                   c;
    lmn_error             error;
    if (cut_parse(&c, (const char *)bytes, bounds, &error) != LMN_OK)
        return;
    const mat4 world = mat4_identity();
    cut_input  input = {corners, 8, indices, 36};
    cut_result result = {0};
    cut_part(&result, &c, &world, &input, 1, &error);
    cut_result_release(&result);
}

/* Lines: page, scale, unit, views, title, and the lists of sections, details and auxiliary views. */
void fuzz_sheet(const uint8_t *bytes, size_t size)
{
    (void)size;
    char *lines = mem_copy_text((const char *)bytes), *at = lines;
    enum { LINES = 8 };
    const char *words[LINES] = {"", "", "", "", ""};
    double      paper[2], scale, mm;
    const char *unit;
    bool        stated;
    vector_view views[VIEWS_MOST];
    size_t      count;
    lmn_error   error;
    for (int i = 0; i < LINES && at; i++)
        words[i] = strsep(&at, "\n");
    if (lines) {
        lmn_scene *scene = scene_new();
        vector_parse_page(words[0], paper, &error);
        vector_parse_scale(words[1], &scale, &error);
        if (scene)
            unit_find(words[2], scene, &mm, &unit, &stated, &error);
        vector_parse_views(words[3], views, &count, &error);
        draft_extras extras;
        draft_extras_parse(&extras, words[5], words[6], words[7], 'y', (box3){{-1, -2, -3}, {4, 5, 6}}, &error);
        scene_free(scene);
    }
    mem_free(lines);
}
