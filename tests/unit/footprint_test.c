/* What GeoJSON says becomes buildings, roads, water, trees. */
#include "field_shapes.h"

#include "import/footprint.h"
#include "scene/content.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

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
    /* East of Munich, on the meridian that it is projected on: 0.001 degrees are 74.4 m east and 111.2 m north. */
    static const char text[] =
        "{\"type\":\"FeatureCollection\",\"features\":["
        "{\"type\":\"Feature\",\"id\":\"way/1\",\"properties\":{\"building\":\"house\",\"height\":\"12 "
        "m\",\"roof:shape\":"
        "\"gabled\",\"roof:height\":3,\"name\":\"Rathaus\"},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[12.,"
        "48.137],[12.0002,48.137],[12.0002,48.1371],[12.,48.1371],[12.,48.137]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"building:levels\":\"4\"},\"geometry\":{\"type\":"
        "\"MultiPolygon\",\"coordinates\":[[[[12.001,48.137],[12.001,48.1371],[12.0012,48.1371],[12.0012,48.137],[12."
        "001,"
        "48.137]]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"highway\":\"residential\"},\"geometry\":{\"type\":\"LineString\","
        "\"coordinates\":[[11.999,48.1368],[12.001,48.1368]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"natural\":\"water\"},\"geometry\":{\"type\":\"Polygon\","
        "\"coordinates\":[[["
        "11.999,48.138],[12.002,48.138],[12.002,48.139],[11.999,48.138]]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"natural\":\"tree\",\"height\":\"7\"},\"geometry\":{\"type\":\"Point\","
        "\"coordinates\":[12.,48.1365]}},"
        "{\"type\":\"Feature\",\"properties\":{\"shop\":\"bakery\"},\"geometry\":{\"type\":\"Point\",\"coordinates\":["
        "12.,48.1365]}}]}";
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

/* Where parts of a building are there, its outline is not raised; a tunnel is not on the ground. */
static void parts_are_the_building(void **state)
{
    (void)state;
#define BOX(x0, y0, x1, y1)                                                                                            \
    "{\"type\":\"Polygon\",\"coordinates\":[[[" x0 "," y0 "],[" x1 "," y0 "],[" x1 "," y1 "],[" x0 "," y1 "],[" x0     \
    "," y0 "]]]}}"
    static const char text[] =
        "{\"type\":\"FeatureCollection\",\"features\":["
        "{\"properties\":{\"building\":\"yes\",\"height\":30},\"geometry\":" BOX(
            "0", "0", "40",
            "20") ","
                  "{\"properties\":{\"building:part\":\"yes\",\"height\":8},\"geometry\":" BOX(
                      "0", "0", "20",
                      "20") ","
                            "{\"properties\":{\"building:part\":\"yes\",\"min_height\":8,\"height\":12},"
                            "\"geometry\":" BOX(
                                "5", "5", "15",
                                "15") ","
                                      "{\"properties\":{\"building\":\"yes\",\"height\":5},\"geometry\":" BOX(
                                          "50", "0", "60",
                                          "9") ","
                                               "{\"properties\":{\"highway\":\"primary\",\"tunnel\":\"yes\"},"
                                               "\"geometry\":{\"type\":\"LineString\",\"coordinates\":"
                                               "[[0,-10],[90,-10]]}},"
                                               "{\"properties\":{\"highway\":\"primary\"},\"geometry\":{\"type\":"
                                               "\"LineString\",\"coordinates\":[[0,-190],[190,-190]]}}]}";
    lmn_scene     *s = load_or_fail(temp_file("parts.geojson", text, sizeof text - 1));
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_float_equal((float)info.bounds_max[2], 12, 1e-4f);
    assert_int_equal(city_counted(&s->city, CITY_SKIPPED, "coarser-than-parts"), 1);
    assert_int_equal(city_counted(&s->city, CITY_OBJECTS, "BuildingPart"), 2);
    assert_int_equal(city_counted(&s->city, CITY_OBJECTS, "Road"), 1);
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

/* One building of this outline and this property behind its height of 10. */
static lmn_scene *load_building(const char *more, const char *rings)
{
    char text[2000];
    snprintf(text, sizeof text,
             "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":"
             "\"urn:ogc:def:crs:EPSG::25832\"}},\"features\":[{\"type\":\"Feature\",\"properties\":{\"building\":"
             "\"yes\",\"height\":10%s},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":%s}}]}",
             more, rings);
    return load_or_fail(temp_file("one.geojson", text, strlen(text)));
}

/* Of a surface's triangles, seen from above. */
static double level_area(const lmn_scene *s, const char *surface)
{
    double sum = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        const char *own = scene_attribute_of(s, s->parts[i].node, "surface");
        const mesh *m = &s->meshes[s->nodes[s->parts[i].node].mesh];
        if (!own || strcmp(own, surface) != 0)
            continue;
        for (size_t k = 0; k < m->primitive_count; k++) {
            const primitive *p = &m->primitives[k];
            for (uint32_t t = 0; t + 2 < p->index_count; t += 3) {
                const vec3 *a = &p->positions[p->indices[t]], *b = &p->positions[p->indices[t + 1]],
                           *c = &p->positions[p->indices[t + 2]];
                sum += fabs((double)(b->x - a->x) * (double)(c->y - a->y) -
                            (double)(b->y - a->y) * (double)(c->x - a->x)) /
                       2;
            }
        }
    }
    return sum;
}

/* All that an outline goes around is filled; holes that are none are left out. Roof and ground are as large as that. */
static void tangled_outlines_are_filled(void **state)
{
    (void)state;
    static const struct {
        const char *rings;
        double      area;
        int         crossing, stray;
    } rows[] = {
        {"[[[0,0],[10,10],[10,0],[0,10],[0,0]]]", 50, 1, 0},                /* a bow tie */
        {"[[[0,0],[20,0],[20,10],[5,10],[5,-5],[0,-5],[0,0]]]", 175, 1, 0}, /* loops that go either way */
        {"[[[0,10],[6,-8],[-9.5,3],[9.5,3],[-6,-8],[0,10]]]", 111.928, 1,
         0}, /* a star, whose middle it goes around twice */
        {"[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[30,30],[35,30],[35,35],[30,35],[30,30]]]", 100, 0, 1},
        {"[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[5,5],[15,5],[15,8],[5,8],[5,5]]]", 100, 0, 1},
        {"[[[0,0],[20,0],[20,20],[0,20],[0,0]],[[5,5],[15,5],[15,15],[5,15],[5,5]],[[8,8],[12,8],[12,12],[8,12],[8,8]]"
         "]",
         300, 0, 1},
        {"[[[0,0],[20,20],[20,0],[0,20],[0,0]],[[2,9],[4,9],[4,11],[2,11],[2,9]]]", 196, 1, 0},
    };
    static const char *const forms[] = {"", ",\"roof:shape\":\"hipped\""};
    for (size_t i = 0; i < COUNT(rows); i++)
        for (size_t k = 0; k < COUNT(forms); k++) {
            lmn_scene *s = load_building(forms[k], rows[i].rings);
            double     roof = level_area(s, "roof"), ground = level_area(s, "ground");
            if (fabs(roof - rows[i].area) > 0.02 || fabs(ground - rows[i].area) > 0.02)
                fail_msg("row %zu: roof %g, ground %g of %g", i, roof, ground, rows[i].area);
            assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "self-crossing-footprints"), rows[i].crossing);
            assert_int_equal(city_counted(&s->city, CITY_SKIPPED, "stray-holes"), rows[i].stray);
            lmn_scene_destroy(&s);
        }
}

/* What is drawn otherwise than it is stated is counted. */
static void other_forms_and_heights_are_counted(void **state)
{
    (void)state;
    static const struct {
        const char *more;
        int         other, limited;
    } rows[] = {
        {",\"roof:shape\":\"flat\"", 0, 0},
        {",\"roof:shape\":\"gabled\"", 0, 0},
        {",\"roof:shape\":\"cone\"", 0, 0},
        {",\"roof:shape\":\"round\"", 1, 0},
        {",\"roof:shape\":\"sawtooth\"", 1, 0},
        {",\"roof:shape\":\"butterfly\"", 1, 0},
        {",\"roof:shape\":\"half-hipped\"", 1, 0},
        {",\"roof:shape\":\"blah\"", 1, 0},
        {",\"roof:shape\":\"\"", 0, 0},
        {",\"roof:shape\":null", 0, 0},
        {",\"measuredHeight\":1,\"min_height\":1e300", 0, 1},
        {",\"roof:levels\":99999", 0, 1},
        {",\"building:levels\":1e9", 0, 1},
    };
    for (size_t i = 0; i < COUNT(rows); i++) {
        lmn_scene *s = load_building(rows[i].more, "[[[0,0],[20,0],[20,10],[0,10],[0,0]]]");
        if (city_counted(&s->city, CITY_REPAIRED, "other-roofs") != (uint64_t)rows[i].other ||
            city_counted(&s->city, CITY_REPAIRED, "limited-heights") != (uint64_t)rows[i].limited)
            fail_msg("row %zu", i);
        lmn_scene_destroy(&s);
    }
}

/* An error names what it is that nothing comes of, and a system that is not known is told. */
static void causes_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *rings, *message;
    } rows[] = {{"[[[8,95],[8.001,95],[8.001,95.001],[8,95]]]", "latitudes"},
                {"[[[179.999,10],[179.9995,10],[-179.999,10.001],[179.999,10]]]", "antimeridian"},
                {"[[8,5],[8.1,5],[8.1,5.1],[8,5]]", "not nested"}};
    for (size_t i = 0; i < COUNT(rows); i++) {
        char       text[1000];
        lmn_scene *scene = NULL;
        lmn_error  error = {0};
        snprintf(text, sizeof text, FEATURE("{\"type\":\"Polygon\",\"coordinates\":%s}"), rows[i].rings);
        assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
        lmn_status status = lmn_scene_add_file(scene, temp_file("why.geojson", text, strlen(text)), NULL, &error);
        if (status != LMN_FORMAT || !strstr(error.message, rows[i].message) || strstr(error.hint, "points"))
            fail_msg("%s: %d %s", rows[i].rings, (int)status, error.message);
        lmn_scene_destroy(&scene);
    }
    static const struct {
        const char *crs;
        bool        told;
    } systems[] = {{"{}", true},
                   {"{\"properties\":{\"name\":\"EPSG:999999\"}}", true},
                   {"{\"properties\":{\"name\":\"town grid\"}}", true},
                   {"{\"properties\":{\"name\":\"urn:ogc:def:crs:EPSG::25832\"}}", false}};
    for (size_t i = 0; i < COUNT(systems); i++) {
        char text[1000];
        bool told = false;
        snprintf(
            text, sizeof text,
            "{\"type\":\"FeatureCollection\",\"crs\":%s,\"features\":[{\"properties\":{\"building\":1},\"geometry\":{"
            "\"type\":\"Polygon\",\"coordinates\":[[[500000,5e6],[500009,5e6],[500009,5000009],[500000,5e6]]]}}]}",
            systems[i].crs);
        lmn_scene *s = load_or_fail(temp_file("system.geojson", text, strlen(text)));
        for (size_t k = 0; k < s->warnings.count; k++)
            told = told || strstr(s->warnings.items[k].text, "coordinate system");
        if (told != systems[i].told)
            fail_msg("%s", systems[i].crs);
        lmn_scene_destroy(&s);
    }
}

/* Ways of different kinds that cross do not lie at one height, where two colours would flicker, but nearly. */
static void crossing_ways_lie_over_each_other(void **state)
{
    (void)state;
    static const char text[] =
        "{\"type\":\"FeatureCollection\",\"crs\":{\"properties\":{\"name\":\"EPSG:25832\"}},\"features\":["
        "{\"properties\":{\"highway\":\"primary\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0],[90,0]]"
        "}},"
        "{\"properties\":{\"highway\":\"residential\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[20,40],["
        "20,-40]]}},"
        "{\"properties\":{\"highway\":\"footway\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[60,40],[60,-"
        "40]]}}]}";
    lmn_scene  *s = load_or_fail(temp_file("ways.geojson", text, sizeof text - 1));
    const part *ways[3];
    for (int i = 0; i < 3; i++)
        ways[i] = part_of(s, "road", "Road", i);
    for (int i = 0; i < 2; i++)
        assert_true(ways[i]->bounds.max.z - ways[i + 1]->bounds.max.z > 0.0035f);
    assert_true(ways[0]->bounds.max.z - ways[2]->bounds.max.z < 0.05f);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strips_are_mitred),
        cmocka_unit_test(features_become_a_town),
        cmocka_unit_test(parts_are_the_building),
        cmocka_unit_test(mistakes_are_told_or_counted),
        cmocka_unit_test(tangled_outlines_are_filled),
        cmocka_unit_test(other_forms_and_heights_are_counted),
        cmocka_unit_test(causes_are_told),
        cmocka_unit_test(crossing_ways_lie_over_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
