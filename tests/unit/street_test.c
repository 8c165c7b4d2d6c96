/* Streets that are populated: as large as life, deterministic, and nothing stands in anything else. */
#include "import_support.h"

#include <math.h>

#include "import/street.h"
#include "scene/content.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Two roads that cross, a footway, houses at the corners. Metres of a projected system. */
static const char town[] =
    "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:25832\"}},\"features\":"
    "["
    "{\"properties\":{\"highway\":\"residential\",\"width\":7},\"geometry\":{\"type\":\"LineString\",\"coordinates\":"
    "[[500000,5300000],[500200,5300000],[500400,5300040]]}},"
    "{\"properties\":{\"highway\":\"primary\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[500200,5299850],"
    "[500200,5300150]]}},"
    "{\"properties\":{\"highway\":\"footway\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[500000,5300050],"
    "[500400,5300090]]}},"
    "{\"properties\":{\"building\":\"yes\",\"height\":9},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[500020,"
    "5300006],[500060,5300006],[500060,5300020],[500020,5300020],[500020,5300006]]]}},"
    "{\"properties\":{\"building\":\"yes\",\"height\":9},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[500210,"
    "5299960],[500260,5299960],[500260,5299995],[500210,5299995],[500210,5299960]]]}},"
    "{\"properties\":{\"natural\":\"tree\",\"height\":6},\"geometry\":{\"type\":\"Point\",\"coordinates\":[500100,"
    "5300005]}},"
    "{\"properties\":{\"kind\":\"bus\",\"direction\":90},\"geometry\":{\"type\":\"Point\",\"coordinates\":[500100,"
    "5299998]}}]}";

static lmn_scene *load_town(double density)
{
    lmn_scene    *scene = NULL;
    lmn_error     error = {0};
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.populate = density;
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    if (lmn_scene_add_file(scene, temp_file("street.geojson", town, sizeof town - 1), &desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return scene;
}

static prop_kind kind_of(const lmn_scene *s, const node *n)
{
    static const char *const names[PROPS] = {"people",   "walkers",  "children", "cars",      "vans",
                                             "buses",    "cyclists", "lamps",    "benches",   "bins",
                                             "bollards", "trees",    "conifers", "line-trees"};
    (void)s;
    for (int i = 0; i < PROPS; i++)
        if (n->name && strcmp(n->name, names[i]) == 0)
            return (prop_kind)i;
    return PROPS;
}

typedef struct disc {
    double    x, y, radius;
    uint32_t  owner;
    prop_kind kind;
} disc;

static size_t discs_of(const lmn_scene *s, disc *out, size_t most)
{
    size_t   count = 0;
    uint32_t owner = 0;
    for (size_t i = 0; i < s->node_count; i++) {
        prop_kind kind = kind_of(s, &s->nodes[i]);
        for (size_t k = 0; kind != PROPS && k < s->nodes[i].instance_count; k++, owner++) {
            const double *m = s->nodes[i].instances[k].m;
            prop_room     room = prop_room_of(kind);
            double        size = hypot(m[0], m[1]);
            for (int c = 0; c < room.circles; c++) {
                double along = room.apart * (c - (room.circles - 1) / 2.0);
                assert_true(count < most);
                out[count++] =
                    (disc){m[12] + along * m[0] / size, m[13] + along * m[1] / size, room.radius, owner, kind};
            }
        }
    }
    return count;
}

static void nothing_stands_in_anything(void **state)
{
    (void)state;
    static disc discs[8192];
    lmn_scene  *s = load_town(2);
    size_t      count = discs_of(s, discs, COUNT(discs)), kinds[PROPS] = {0};
    /* The houses and lanes, around the origin that the scene has. */
    double x0 = 500000 - s->city.origin[0], y0 = 5300000 - s->city.origin[1];
    assert_true(count > 200);
    for (size_t i = 0; i < count; i++) {
        const disc *d = &discs[i];
        double      x = d->x - x0, y = d->y - y0;
        kinds[d->kind]++;
        for (size_t k = 0; k < i; k++)
            if (discs[k].owner != d->owner &&
                hypot(discs[k].x - d->x, discs[k].y - d->y) < 0.999 * (discs[k].radius + d->radius))
                fail_msg("something of kind %d stands in one of kind %d", (int)d->kind, (int)discs[k].kind);
        assert_false(x > 20 && x < 60 && y > 6 && y < 20);
        assert_false(x > 210 && x < 260 && y > -40 && y < -5);
        bool walks = d->kind <= PROP_CHILD || d->kind >= PROP_LAMP;
        if (walks && ((x > 1 && x < 199 && fabs(y) < 3.5) || (fabs(x - 200) < 5.5 && fabs(y) < 149)))
            fail_msg("kind %d stands in the lanes at %g, %g", (int)d->kind, x, y);
        if (!walks && x > 20 && x < 180 && fabs(y) < 3.5 && d->kind != PROP_CYCLIST)
            assert_true(fabs(y) > 0.3);
    }
    assert_true(kinds[PROP_WALKER] && kinds[PROP_CAR] && kinds[PROP_LAMP] && kinds[PROP_BROAD_TREE]);
    assert_true(city_counted(&s->city, CITY_OBJECTS, "Person") > 40);
    assert_true(city_counted(&s->city, CITY_SKIPPED, "no-room") > 0);
    lmn_scene_destroy(&s);
}

static void chance_is_the_same_each_time(void **state)
{
    (void)state;
    static disc first[4096], second[4096];
    lmn_scene  *s = load_town(1);
    size_t      count = discs_of(s, first, COUNT(first));
    lmn_scene_destroy(&s);
    s = load_town(1);
    assert_int_equal(discs_of(s, second, COUNT(second)), count);
    assert_memory_equal(first, second, count * sizeof *first);
    lmn_scene_destroy(&s);
    s = load_town(0);
    assert_int_equal(discs_of(s, second, COUNT(second)), 0);
    lmn_scene_destroy(&s);
}

/* Metres: a person is as high as one, a car as long. */
static void all_is_as_large_as_life(void **state)
{
    (void)state;
    static const double sizes[PROPS][2] = {/* along x, and up */
                                           {0.3, 1.75},  {0.6, 1.7},   {0.3, 1.2}, {4.3, 1.45}, {5.2, 2.1},
                                           {11.6, 3.0},  {1.72, 1.73}, {1.6, 6},   {0.5, 0.86}, {0.5, 0.9},
                                           {0.18, 0.92}, {0.6, 1},     {0.43, 1},  {0, 1}};
    for (int kind = 0; kind < PROPS; kind++) {
        lmn_scene   *s = scene_new();
        import_job   job = {.path = "x", .model = "x", .scene = s};
        city_builder b;
        city_meshes  meshes = {NULL, 0, 0};
        lmn_error    error;
        assert_int_equal(city_builder_open(&b, &job, &error), LMN_OK);
        assert_int_equal(prop_make(&b, (prop_kind)kind, &meshes), LMN_OK);
        assert_int_equal(meshes.count, 1);
        const primitive *p = &s->meshes[meshes.items[0].mesh].primitives[0];
        float            low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
        for (uint32_t i = 0; i < p->vertex_count; i++) {
            const float v[3] = {p->positions[i].x, p->positions[i].y, p->positions[i].z};
            for (int k = 0; k < 3; k++) {
                low[k] = fminf(low[k], v[k]);
                high[k] = fmaxf(high[k], v[k]);
            }
        }
        assert_float_equal(low[2], 0, 1e-3f);
        if (fabs((double)high[2] - sizes[kind][1]) > 0.02)
            fail_msg("kind %d is %g high", kind, (double)high[2]);
        if (kind != PROP_LINE_TREE && fabs((double)(high[0] - low[0]) - sizes[kind][0]) > 0.15 * sizes[kind][0] + 0.05)
            fail_msg("kind %d is %g long", kind, (double)(high[0] - low[0]));
        if (kind == PROP_LINE_TREE)
            assert_true(p->line_count > 40 && p->index_count == 0);
        else
            assert_true(p->index_count / 3 <= 220);
        /* Nothing was open, turned or without area. */
        assert_int_equal(b.tally.turned + b.tally.degenerate + b.tally.crossing, 0);
        mem_free(meshes.items);
        city_builder_close(&b, LMN_OK);
        scene_free(s);
    }
}

static void points_become_what_they_are(void **state)
{
    (void)state;
    lmn_scene *s = load_town(0);
    bool       bus = false;
    for (size_t i = 0; i < s->part_count; i++) {
        const char *class = scene_attribute_of(s, s->parts[i].node, "type");
        if (!class || strcmp(class, "Vehicle") != 0)
            continue;
        bus = true; /* towards the east */
        assert_float_equal(s->parts[i].bounds.max.x - s->parts[i].bounds.min.x, 11.6f, 0.01f);
        assert_float_equal(s->parts[i].bounds.max.z, 3, 0.01f);
        assert_string_equal(scene_attribute_of(s, s->parts[i].node, "surface"), "vehicle");
    }
    assert_true(bus);
    lmn_scene_destroy(&s);
}

static void other_models_are_refused(void **state)
{
    (void)state;
    static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const struct {
        double     density;
        lmn_status status;
    } rows[] = {{1, LMN_USAGE}, {-1, LMN_USAGE}, {4.5, LMN_USAGE}, {NAN, LMN_USAGE}, {0, LMN_OK}};
    for (size_t i = 0; i < COUNT(rows); i++) {
        lmn_scene    *scene = NULL;
        lmn_error     error = {0};
        lmn_load_desc desc = LMN_LOAD_DESC_INIT;
        desc.populate = rows[i].density;
        assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
        assert_int_equal(lmn_scene_add_file(scene, temp_file("t.obj", triangle, sizeof triangle - 1), &desc, &error),
                         rows[i].status);
        lmn_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_stands_in_anything), cmocka_unit_test(chance_is_the_same_each_time),
        cmocka_unit_test(all_is_as_large_as_life),    cmocka_unit_test(points_become_what_they_are),
        cmocka_unit_test(other_models_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
