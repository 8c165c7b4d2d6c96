/* Bodies on footprints are closed, look outwards and hold what they should, whatever the footprint; and what GeoJSON
 * says becomes buildings, roads, water, trees. */
#include "field_shapes.h"

#include "import/footprint.h"
#include "scene/content.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static uint32_t next_random = 1;
static double   chance(double low, double high)
{
    next_random = next_random * 1664525u + 1013904223u;
    return low + (high - low) * (next_random >> 8) / 16777216.0;
}

static bool is_paired(const uint32_t (*edges)[2], size_t count)
{
    for (size_t i = 0; i < count; i++) {
        int same = 0, back = 0;
        for (size_t k = 0; k < count; k++) {
            same += edges[k][0] == edges[i][0] && edges[k][1] == edges[i][1];
            back += edges[k][0] == edges[i][1] && edges[k][1] == edges[i][0];
        }
        if (same != 1 || back != 1)
            return false;
    }
    return true;
}

/* Each edge of a face is one of just one other face, the other way round: closed, manifold, all faces alike. */
static bool is_closed(const city_shape *s)
{
    uint32_t(*edges)[2] = mem_calloc(s->corner_count, sizeof *edges);
    size_t count = 0, first = 0;
    for (size_t ring = 0; ring < s->ring_count; first = s->rings[ring++])
        for (size_t i = first; i < s->rings[ring]; i++, count++) {
            edges[count][0] = s->corners[i];
            edges[count][1] = s->corners[i + 1 < s->rings[ring] ? i + 1 : first];
        }
    bool closed = is_paired((const uint32_t(*)[2])edges, count);
    mem_free(edges);
    return closed && count > 0;
}

static double volume_of(const city_shape *s, const vec3 *points)
{
    double volume = 0;
    size_t first = 0;
    for (size_t ring = 0; ring < s->ring_count; first = s->rings[ring++])
        for (size_t i = first + 1; i + 1 < s->rings[ring]; i++) {
            vec3 a = points[s->corners[first]], b = points[s->corners[i]], c = points[s->corners[i + 1]];
            volume += (double)(a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                               a.z * (b.x * c.y - b.y * c.x)) /
                      6;
        }
    return volume;
}

/* A star-shaped outline around 0, maybe with a hole like it. */
static size_t random_footprint(double (*p)[2], size_t counts[2])
{
    size_t rings = chance(0, 1) < 0.3 ? 2 : 1, at = 0;
    counts[0] = (size_t)chance(3, 12.99);
    counts[1] = (size_t)chance(3, 8.99);
    for (size_t k = 0; k < rings; k++)
        for (size_t i = 0; i < counts[k]; i++) {
            double angle = (k ? -1 : 1) * 2 * field_pi * ((double)i + chance(0, 0.7)) / (double)counts[k];
            double radius = k ? chance(1, 2) : chance(6, 20);
            p[at][0] = radius * cos(angle);
            p[at++][1] = radius * sin(angle);
        }
    return rings;
}

static void bodies_are_closed(void **state)
{
    (void)state;
    city_shape       shape = {0};
    footprint_points points = {0};
    int              pitched = 0;
    next_random = 1;
    for (int n = 0; n < 1000; n++) {
        double    p[32][2];
        size_t    counts[2], rings = random_footprint(p, counts);
        footprint how = {(roof_form)(n % 5), chance(0, 5), chance(6, 20), 0};
        bool      fits;
        how.ridge = how.eaves + chance(0, 6);
        city_shape_clear(&shape);
        points.count = 0;
        assert_true(footprint_raise(&shape, &points, &how, (const double(*)[2])p, counts, rings, &fits));
        if (!is_closed(&shape))
            fail_msg("footprint %d, roof %d", n, (int)how.roof);
        assert_true(volume_of(&shape, points.items) > 0);
        pitched += fits && how.roof != ROOF_FLAT;
    }
    assert_true(pitched > 100);
    city_shape_release(&shape);
    mem_free(points.items);
}

static void roofs_hold_what_they_should(void **state)
{
    (void)state;
    const double     box[4][2] = {{0, 0}, {10, 0}, {10, 6}, {0, 6}}, turned[4][2] = {{0, 0}, {6, 0}, {6, 10}, {0, 10}};
    const double     high = 3, below = 60 * 5, top = 0.7 * 0.7 * 60;
    const double     over[] = {60 * high, 60 * high / 2, high * (6 * 4 / 2.0 + 6 * 6 / 3.0), 60 * high / 3,
                               high / 3 * (60 + top + sqrt(60 * top))};
    city_shape       shape = {0};
    footprint_points points = {0};
    for (int form = 0; form < 5; form++)
        for (int t = 0; t < 2; t++) {
            const size_t    count = 4;
            const footprint how = {(roof_form)form, 1, 6, 9};
            bool            fits;
            city_shape_clear(&shape);
            points.count = 0;
            assert_true(footprint_raise(&shape, &points, &how, t ? turned : box, &count, 1, &fits));
            assert_true(fits);
            assert_float_equal((float)volume_of(&shape, points.items), (float)(below + over[form]), 1e-3f);
        }
    city_shape_release(&shape);
    mem_free(points.items);
}

/* A strip is as long and wide as it should be, round a corner, too. */
static void strips_are_mitred(void **state)
{
    (void)state;
    const double     bend[3][2] = {{0, 0}, {20, 0}, {20, 30}};
    city_shape       shape = {0};
    footprint_points points = {0};
    double           normal[3];
    assert_true(footprint_strip(&shape, &points, bend, 3, 4, 0.5));
    assert_int_equal(points.count, 6);
    city_normal(points.items, &shape, 0, normal);
    /* Two rectangles that share the corner's square: 4 · (22 + 28 + …) */
    assert_float_equal((float)normal[2] / 2, 4 * (20 + 30), 1e-3f);
    city_shape_release(&shape);
    mem_free(points.items);
}

/* --- GeoJSON -------------------------------------------------------------------------------------------- */

static lmn_scene *load_town(void)
{
    /* Around Munich: 0.001 degrees are 74.4 m east and 111.2 m north. */
    static const char text[] =
        "{\"type\":\"FeatureCollection\",\"features\":["
        "{\"type\":\"Feature\",\"id\":\"way/1\",\"properties\":{\"building\":\"house\",\"height\":\"12 "
        "m\",\"roof:shape\":"
        "\"gabled\",\"roof:height\":3,\"name\":\"Rathaus\"},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[11."
        "575,"
        "48.137],[11.5752,48.137],[11.5752,48.1371],[11.575,48.1371],[11.575,48.137]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"building:levels\":\"4\"},\"geometry\":{\"type\":"
        "\"MultiPolygon\",\"coordinates\":[[[[11.576,48.137],[11.576,48.1371],[11.5762,48.1371],[11.5762,48.137],[11."
        "576,"
        "48.137]]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"highway\":\"residential\"},\"geometry\":{\"type\":\"LineString\","
        "\"coordinates\":[[11.574,48.1368],[11.577,48.1368]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"natural\":\"water\"},\"geometry\":{\"type\":\"Polygon\","
        "\"coordinates\":[[["
        "11.574,48.138],[11.577,48.138],[11.577,48.139],[11.574,48.138]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"natural\":\"tree\",\"height\":\"7\"},\"geometry\":{\"type\":\"Point\","
        "\"coordinates\":[11.575,48.1365]}},"
        "{\"type\":\"Feature\",\"properties\":{\"shop\":\"bakery\"},\"geometry\":{\"type\":\"Point\",\"coordinates\":["
        "11.575,48.1365]}}]}";
    return load_or_fail(temp_file("town.geojson", text, sizeof text - 1));
}

static const part *part_of(const lmn_scene *s, const char *surface, const char *type, int which)
{
    for (size_t i = 0; i < s->part_count; i++) {
        const char *own = scene_attribute_of(s, s->parts[i].node, "surface"),
                   *class = scene_attribute_of(s, s->parts[i].node, "type");
        if (own && class && strcmp(own, surface) == 0 && strcmp(class, type) == 0 && which-- == 0)
            return &s->parts[i];
    }
    fail_msg("no %s of a %s", surface, type);
    return NULL;
}

static void features_become_a_town(void **state)
{
    (void)state;
    lmn_scene  *s = load_town();
    const part *roof = part_of(s, "roof", "Building", 0), *wall = part_of(s, "wall", "Building", 0),
               *flat = part_of(s, "roof", "Building", 1);
    assert_true(s->up == 'z' && s->city.known && s->city.geographic);
    assert_string_equal(scene_attribute_of(s, roof->node, "name"), "Rathaus");
    /* The stated height is the ridge's; gables are walls. */
    assert_float_equal(roof->bounds.max.z, 12, 1e-4f);
    assert_float_equal(roof->bounds.min.z, 9, 1e-4f);
    assert_float_equal(wall->bounds.max.z, 12, 1e-4f);
    assert_float_equal(flat->bounds.max.z, 12, 1e-4f); /* four storeys */
    assert_float_equal(flat->bounds.min.z, 12, 1e-4f);
    /* Degrees are as long as they are there. */
    assert_float_equal(roof->bounds.max.x - roof->bounds.min.x, 14.88f, 0.03f);
    assert_float_equal(roof->bounds.max.y - roof->bounds.min.y, 11.12f, 0.02f);
    const part *road = part_of(s, "road", "Road", 0), *tree = part_of(s, "plant", "SolitaryVegetationObject", 0);
    assert_float_equal(road->bounds.max.y - road->bounds.min.y, 6, 1e-3f);
    assert_true(road->bounds.min.z > part_of(s, "water", "WaterBody", 0)->bounds.max.z);
    assert_float_equal(tree->bounds.max.z, 7, 1e-4f);
    assert_int_equal(city_counted(&s->city, CITY_SKIPPED, "points"), 1); /* the bakery */
    assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "turned-faces"), 0);
    lmn_scene_destroy(&s);
}

static void mistakes_are_told_or_counted(void **state)
{
    (void)state;
#define FEATURE(geometry)                                                                                              \
    "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\"},"       \
    "\"geometry\":" geometry "}]}"
    static const struct {
        const char *text;
        lmn_status  status;
    } rows[] = {
        {"{\"type\":\"FeatureCollection\"}", LMN_FORMAT},
        {"{\"type\":\"FeatureCollection\",\"features\":[{]}", LMN_FORMAT},
        {"{\"type\":\"FeatureCollection\",\"features\":[", LMN_FORMAT},
        {"{\"type\":\"FeatureCollection\",\"features\":[1,null,\"x\"]}", LMN_FORMAT}, /* nothing to draw */
        {FEATURE("null"), LMN_FORMAT},
        {FEATURE("{\"type\":\"Polygon\",\"coordinates\":5}"), LMN_FORMAT},
        {FEATURE("{\"type\":\"Polygon\",\"coordinates\":[[[1,2],[3,4],[1,2]]]}"), LMN_FORMAT},
        {FEATURE("{\"type\":\"Polygon\",\"coordinates\":[[[1,2],[1e99,4],[1,5],[1,2]]]}"), LMN_FORMAT},
        {FEATURE("{\"type\":\"Blob\",\"coordinates\":[[[1,2],[3,4],[1,2]]]}"), LMN_FORMAT},
        {FEATURE("{\"type\":\"Polygon\",\"coordinates\":[[[1,2],[1.001,2],[1.001,2.001],[1,2]],[[1,2],[1,2]]]}"),
         LMN_OK},
        {FEATURE("{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[0.001,0.001],[0.001,0],[0,0.001],[0,0]]]}"),
         LMN_OK}, /* crosses itself */
    };
    for (size_t i = 0; i < COUNT(rows); i++) {
        lmn_scene *scene = NULL;
        lmn_error  error = {0};
        assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
        lmn_status status =
            lmn_scene_add_file(scene, temp_file("bad.geojson", rows[i].text, strlen(rows[i].text)), NULL, &error);
        if ((status == LMN_OK) != (rows[i].status == LMN_OK) && !(status == LMN_OK && scene->part_count == 0))
            fail_msg("row %zu: %d %s", i, (int)status, error.message);
        lmn_scene_destroy(&scene);
    }
}

static void memory_may_run_out(void **state)
{
    (void)state;
    const double    box[4][2] = {{0, 0}, {10, 0}, {10, 6}, {0, 6}};
    const size_t    count = 4;
    const footprint how = {ROOF_HIPPED, 0, 5, 8};
    long            n = 1;
    for (; n < 200; n++) {
        city_shape       shape = {0};
        footprint_points points = {0};
        bool             fits;
        mem_fail_at(n);
        bool done = footprint_raise(&shape, &points, &how, box, &count, 1, &fits);
        mem_fail_at(0);
        city_shape_release(&shape);
        mem_free(points.items);
        if (done)
            break;
    }
    assert_true(n > 3 && n < 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_closed),
        cmocka_unit_test(roofs_hold_what_they_should),
        cmocka_unit_test(strips_are_mitred),
        cmocka_unit_test(features_become_a_town),
        cmocka_unit_test(mistakes_are_told_or_counted),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
