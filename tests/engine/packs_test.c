/* Packs: small meshes that lie in the same buffers are drawn by few calls, and every pixel is what it is when each is
 * drawn for itself. Meshes that two nodes draw lie in no pack: a town with a twin of each house, that nobody sees, is
 * drawn house by house. Row C13. */
#include "checked.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 160, HOUSES = 60, MATERIALS = 3 };

static lmn_renderer *renderer;

static int set_up(void **state)
{
    (void)state;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &desc, &error));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_renderer_destroy(&renderer);
    return 0;
}

static uint32_t add_box(lmn_scene *s, int house, const uint32_t materials[MATERIALS])
{
    static const uint32_t faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    float                 positions[8][3];
    uint32_t              indices[36], mesh = 0, *at = indices;
    double                size[3] = {6 + house % 4, 5 + house * 7 % 19, 6 + house % 3};
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) /* where it stands is in its vertices, as in files of cities */
            positions[i][k] = (float)((i >> k & 1 ? size[k] : 0) + (k == 0   ? 10.0 * (house % 8)
                                                                    : k == 2 ? 10.0 * (house / 8)
                                                                             : 0));
    for (int f = 0; f < 6; f++)
        for (int k = 0; k < 6; k++)
            *at++ = faces[f][(int[]){0, 2, 1, 0, 3, 2}[k]];
    lmn_mesh_desc desc = LMN_MESH_DESC_INIT;
    desc.positions = positions[0];
    desc.vertex_count = 8;
    desc.indices = indices;
    desc.index_count = 36;
    desc.material = materials[house % MATERIALS];
    DO(lmn_scene_add_mesh(s, &desc, &mesh, &error));
    return mesh;
}

static void add_house(lmn_scene *s, uint32_t mesh, const char *kind, int house)
{
    char          name[32], storeys[8];
    lmn_node_desc desc = LMN_NODE_DESC_INIT;
    uint32_t      node = 0;
    snprintf(name, sizeof name, "%s%d", kind, house);
    snprintf(storeys, sizeof storeys, "%d", 1 + house % 5);
    desc.name = name;
    desc.mesh = mesh;
    DO(lmn_scene_add_node(s, &desc, &node, &error));
    DO(lmn_scene_set_attribute(s, node, "storeys", storeys, &error));
    if (house % 3)
        DO(lmn_scene_set_attribute(s, node, "function", house % 3 == 1 ? "office" : "residential", &error));
}

static lmn_scene *town(bool twins)
{
    static const double colours[MATERIALS][4] = {{0.8, 0.3, 0.2, 1}, {0.2, 0.5, 0.8, 1}, {0.4, 0.7, 0.3, 1}};
    lmn_scene          *s;
    uint32_t            materials[MATERIALS], meshes[HOUSES];
    DO(lmn_scene_create(&s, &error));
    for (int i = 0; i < MATERIALS; i++) {
        lmn_material_desc desc = LMN_MATERIAL_DESC_INIT;
        for (int k = 0; k < 4; k++)
            desc.colour[k] = (float)colours[i][k];
        DO(lmn_scene_add_material(s, &desc, &materials[i], &error));
    }
    for (int i = 0; i < HOUSES; i++)
        add_house(s, meshes[i] = add_box(s, i, materials), "house", i);
    for (int i = 0; i < HOUSES && twins; i++)
        add_house(s, meshes[i], "twin", i);
    return s;
}

static lmn_drawing *draw(const lmn_scene *s, const char *look_text, bool near)
{
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    const double  far_eye[3] = {-60, 90, 140}, near_eye[3] = {38, 12, 85}, target[3] = {40, 0, 35};
    DO(lmn_look_parse(&look, look_text, "test", &error));
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    desc.samples = 1;
    desc.select = "house*";
    desc.profile = true;
    desc.eye_given = true;
    memcpy(desc.eye, near ? near_eye : far_eye, sizeof desc.eye);
    memcpy(desc.target, target, sizeof target);
    DO(lmn_draw(&drawing, renderer, s, look, &desc, &error));
    lmn_look_destroy(&look);
    return drawing;
}

/* Calls of the passes that draw geometry. */
static int calls_of(const lmn_drawing *d)
{
    char   *text = lmn_drawing_report_json(d);
    json_t *report = json_loads(text, 0, NULL), *pass;
    size_t  i;
    int     calls = 0;
    json_array_foreach(json_object_get(report, "passes"), i, pass)
    {
        const char *name = json_string_value(json_object_get(pass, "name"));
        if (strstr(name, "geometry") || strstr(name, "shadow") || strstr(name, "layers"))
            calls += (int)json_integer_value(json_object_get(pass, "draws"));
    }
    json_decref(report);
    free(text);
    return calls;
}

/* Own colours and those of a datum, facades, ids, shadows, layers by lists and by peeling. */
static const struct {
    const char *look;
    bool        few; /* drawn by few calls; peeled layers are drawn part by part */
} looks[] = {
    {"{\"version\":2,\"rules\":[{\"select\":\"*\",\"surface\":\"lambert\"}]}", true},
    {"{\"version\":2,\"scene\":{\"shadows\":true},\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":\"tones\","
     "\"facade\":\"auto\"},\"lines\":\"discontinuity\"}]}",
     true},
    {"{\"version\":2,\"scene\":{\"datum\":\"storeys\"},\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":"
     "\"tones\",\"facade\":\"office\"},\"lines\":\"id\"}]}",
     true},
    {"{\"version\":2,\"rules\":[{\"select\":\"*\",\"surface\":\"lit\"},{\"select\":\"[function=office]\",\"surface\":"
     "\"toon\",\"lines\":\"sobel\"}]}",
     false},
    {"{\"version\":2,\"rules\":[{\"select\":\"*\",\"surface\":\"lit\",\"layers\":{\"technique\":\"peel\",\"count\":3},"
     "\"lines\":\"discontinuity\",\"compose\":\"xray\"}]}",
     false},
};

static void pixels_are_the_same(void **state)
{
    (void)state;
    lmn_scene *packed = town(false), *single = town(true);
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
        for (int near = 0; near < (i == 1 ? 2 : 1); near++) { /* near at hand most houses are out of view */
            lmn_drawing   *a = draw(packed, looks[i].look, near), *b = draw(single, looks[i].look, near);
            const uint8_t *one = lmn_drawing_pixels(a, NULL, NULL), *other = lmn_drawing_pixels(b, NULL, NULL);
            size_t         differing = 0;
            int            calls = calls_of(a), each = calls_of(b);
            for (size_t k = 0; k < (size_t)SIDE * SIDE; k++)
                differing += memcmp(&one[4 * k], &other[4 * k], 4) != 0;
            if (differing)
                fail_msg("look %zu, near %d: %zu pixels differ", i, near, differing);
            if (looks[i].few && (calls > 4 || each < (near ? 10 : HOUSES)))
                fail_msg("look %zu, near %d: %d calls in packs, %d one by one", i, near, calls, each);
            lmn_drawing_destroy(&a);
            lmn_drawing_destroy(&b);
        }
    lmn_scene_destroy(&packed);
    lmn_scene_destroy(&single);
}

/* A house that changes leaves its pack; one that is drawn once more is no longer drawn with it. */
static void edits_leave_packs(void **state)
{
    (void)state;
    lmn_scene  *edited = town(false), *fresh = town(false);
    const char *look = looks[1].look;
    for (int step = 0; step < 3; step++) {
        if (step == 0) {
            lmn_drawing *before = draw(edited, look, true);
            lmn_drawing_destroy(&before);
        }
        lmn_scene *both[2] = {edited, fresh};
        for (int k = 0; k < 2; k++) {
            uint32_t node = lmn_scene_node_of_part(both[k], 20);
            if (step == 0)
                DO(lmn_scene_set_attribute(both[k], node, "storeys", "9", &error));
            else if (step == 1)
                DO(lmn_scene_set_matrix(both[k], node, (double[]){1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 1, 0, 3, 1},
                                        &error));
            else
                DO(lmn_scene_remove_node(both[k], node, &error));
        }
        lmn_renderer *kept = renderer;
        lmn_drawing  *a = draw(edited, look, true), *b;
        DO(lmn_renderer_create(&renderer, NULL, &error));
        b = draw(fresh, look, true);
        assert_memory_equal(lmn_drawing_pixels(a, NULL, NULL), lmn_drawing_pixels(b, NULL, NULL), 4 * SIDE * SIDE);
        lmn_drawing_destroy(&a);
        lmn_drawing_destroy(&b);
        lmn_renderer_destroy(&renderer);
        renderer = kept;
    }
    lmn_scene_destroy(&edited);
    lmn_scene_destroy(&fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pixels_are_the_same), cmocka_unit_test(edits_leave_packs)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
