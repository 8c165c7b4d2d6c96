/* Roads that cross have one outline: the rims that are shown are as long as that of their union, and areas stay. */
#include "import_support.h"

#include <math.h>

#include "scene/content.h"

static lmn_scene *load_roads(const char *lines)
{
    char          text[2000];
    lmn_scene    *scene = NULL;
    lmn_error     error = {0};
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    int           size =
        snprintf(text, sizeof text,
                 "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:25832\"}},"
                 "\"features\":[%s]}",
                 lines);
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    if (lmn_scene_add_file(scene, temp_file("roads.geojson", text, (size_t)size), &desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return scene;
}

#define ROAD(width, points)                                                                                            \
    "{\"properties\":{\"highway\":\"residential\",\"width\":" #width                                                   \
    "},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[" points "]}}"

/* How long the rims of all roads are that are shown, and how large their faces. */
static void measure(const lmn_scene *s, double *length, double *area)
{
    *length = *area = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        const primitive *p = &s->meshes[s->nodes[s->parts[i].node].mesh].primitives[0];
        for (uint32_t k = 0; k < p->index_count; k++) {
            uint32_t from = p->indices[k], to = p->indices[k % 3 == 2 ? k - 2 : k + 1];
            bool     rim = true;
            for (uint32_t j = 0; j < p->index_count; j++)
                rim = rim && !(p->indices[j] == to && p->indices[j % 3 == 2 ? j - 2 : j + 1] == from);
            vec3 a = p->positions[from], b = p->positions[to];
            if (rim && !(p->edges.values && p->edges.values[k] == 0))
                *length += hypot((double)b.x - (double)a.x, (double)b.y - (double)a.y);
            *area += ((double)a.x * (double)b.y - (double)a.y * (double)b.x) / 2;
        }
    }
}

static void check(const char *roads, double length, double area)
{
    lmn_scene *s = load_roads(roads);
    double     found[2];
    measure(s, &found[0], &found[1]);
    if (fabs(found[0] - length) > 0.1 || fabs(found[1] - area) > 0.05)
        fail_msg("outline %g, wanted %g; area %g, wanted %g", found[0], length, found[1], area);
    lmn_scene_destroy(&s);
}

static void crossings_have_one_outline(void **state)
{
    (void)state;
    /* One alone; two that cross; three through one place, at right angles and aslant. */
    check(ROAD(8, "[500000,5300000],[500100,5300000]"), 2 * 108, 800);
    check(ROAD(8, "[500000,5300000],[500100,5300000]") "," ROAD(6, "[500050,5299950],[500050,5300050]"),
          2 * 108 + 2 * 106 - 2 * 6 - 2 * 8, 1400);
    check(ROAD(8, "[500000,5300000],[500100,5300000]") "," ROAD(6, "[500050,5299950],[500050,5300050]") "," ROAD(
              4, "[500080,5299950],[500080,5300050]"),
          2 * 108 + 2 * 106 + 2 * 104 - 2 * 6 - 2 * 8 - 2 * 4 - 2 * 8, 1800);
}

static void ends_join(void **state)
{
    (void)state;
    /* Ways that go on, as maps cut them; one that ends in the middle of another. */
    check(ROAD(8, "[500000,5300000],[500100,5300000]") "," ROAD(8, "[500100,5300000],[500180,5300000]"), 2 * 188, 1440);
    check(ROAD(8, "[500000,5300000],[500100,5300000]") "," ROAD(6, "[500050,5300000],[500050,5300050]"),
          2 * 108 - 6 + 2 * 46 + 6, 1100);
}

/* Where a stream passes below a road the road's rims are drawn and its own are not. */
static void streams_pass_below(void **state)
{
    (void)state;
    check(ROAD(8, "[500000,5300000],[500100,5300000]") ",{\"properties\":{\"waterway\":\"canal\",\"width\":10},"
                                                       "\"geometry\":{\"type\":\"LineString\",\"coordinates\":["
                                                       "[500050,5299950],[500050,5300050]]}}",
          2 * 108 + 2 * 110 - 2 * 8, 1800);
}

/* Roads that lie on each other are not as high, however wide they are: two colours would flicker. */
static void crossings_do_not_flicker(void **state)
{
    (void)state;
    lmn_scene *s = load_roads(ROAD(6, "[500000,5300000],[500100,5300000]") "," ROAD(
        6,
        "[500050,5299950],[500050,"
        "5300050]") "," ROAD(6, "[500010,5299960],[500090,5300040]") "," ROAD(6.2, "[500090,5299960],[500010,"
                                                                                   "5300040]") "," ROAD(6, "[500300,"
                                                                                                           "5300000],["
                                                                                                           "500400,"
                                                                                                           "5300000]"));
    double     heights[5];
    assert_int_equal(s->part_count, 5);
    for (size_t i = 0; i < 5; i++) {
        heights[i] = (double)s->meshes[s->nodes[s->parts[i].node].mesh].primitives[0].positions[0].z;
        for (size_t k = 0; k < i && i < 4; k++)
            assert_true(fabs(heights[i] - heights[k]) > 0.0015);
    }
    assert_true(fabs(heights[4] - heights[0]) < 1e-6); /* it lies alone */
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(crossings_have_one_outline), cmocka_unit_test(ends_join),
                                       cmocka_unit_test(streams_pass_below),
                                       cmocka_unit_test(crossings_do_not_flicker)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
