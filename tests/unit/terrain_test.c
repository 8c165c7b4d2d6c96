/* Terrain: what lies on it follows it, and rasters and footprints of other programs arrive where they should. Files are
 * made here or by GDAL's own programs; without these, and without GDAL, those tests are skipped. */
#include "import_support.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "import/geodata.h"
#include "import/geodata_library.h"
#include "import/terrain.h"
#include "scene/content.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* --- draping -------------------------------------------------------------------------------------------- */

static terrain hills(float *heights, bool *known)
{
    terrain t = {{-50, -50}, 10, 11, 11, heights, known, 0};
    for (uint32_t i = 0; i < 121; i++) {
        heights[i] = (float)(20 * sin(i % 11 * 0.7) + 3 * cos(i / 11 * 1.3)); /* NOLINT: rows are whole */
        known[i] = true;
    }
    return t;
}

static void add_ring(city_shape *s, footprint_points *p, const double (*at)[2], size_t count)
{
    for (size_t i = 0; i < count; i++) {
        assert_true(footprint_add_point(p, at[i][0], at[i][1], 0));
        assert_true(city_shape_corner(s, (uint32_t)p->count - 1));
    }
    assert_true(city_shape_end_ring(s));
}

static double distance_to(const double a[2], const double b[2], double x, double y)
{
    double wx = b[0] - a[0], wy = b[1] - a[1], t = ((x - a[0]) * wx + (y - a[1]) * wy) / (wx * wx + wy * wy);
    t = fmax(0, fmin(1, t));
    return hypot(x - a[0] - t * wx, y - a[1] - t * wy);
}

/* Nothing is open but along the rings. */
static void check_seams(const city_shape *s, const vec3 *points, const double (*const rings[])[2], const size_t *counts,
                        size_t ring_count)
{
    for (size_t f = 0; f < s->face_count; f++) {
        size_t first = city_first_corner(s, f), count = s->rings[f] - first;
        for (size_t i = 0; i < count; i++) {
            uint32_t a = s->corners[first + i], b = s->corners[first + (i + 1) % count];
            bool     paired = false, outside = false;
            for (size_t g = 0; g < s->face_count && !paired; g++) {
                size_t from = city_first_corner(s, g), many = s->rings[g] - from;
                for (size_t k = 0; k < many; k++)
                    paired = paired || (s->corners[from + k] == b && s->corners[from + (k + 1) % many] == a);
            }
            double x = ((double)points[a].x + (double)points[b].x) / 2,
                   y = ((double)points[a].y + (double)points[b].y) / 2;
            for (size_t r = 0; r < ring_count && !paired; r++)
                for (size_t k = 0; k < counts[r]; k++)
                    outside = outside || distance_to(rings[r][k], rings[r][(k + 1) % counts[r]], x, y) < 2e-3;
            if (!paired && !outside)
                fail_msg("an open edge at %g, %g, %g long", x, y,
                         hypot((double)(points[a].x - points[b].x), (double)(points[a].y - points[b].y)));
        }
    }
}

/* An area with a hole: every piece lies on one triangle of the terrain, all together cover what the area covers, and
 * pieces share their corners. */
static void areas_follow_the_terrain(void **state)
{
    (void)state;
    float            heights[121];
    bool             known[121];
    terrain          t = hills(heights, known);
    city_shape       flat = {0}, out = {0};
    footprint_points flat_points = {0}, points = {0};
    /* Some corners lie on lines of the grid, or nearly. */
    const double ring[7][2] = {{-31.3, -27.9}, {33.1, -41.7},  {41.9, 12.2}, {30.004, 30.0013},
                               {3.3, 37.1},    {-20.0003, 20}, {-44.4, 21.2}};
    const double hole[3][2] = {{-5, -5}, {3, 11}, {9, -2}};
    double       area = 0, expected = 0;
    add_ring(&flat, &flat_points, ring, 7);
    add_ring(&flat, &flat_points, hole, 3);
    assert_true(city_shape_end_face(&flat, NONE, CITY_NO_WORD, 0));
    assert_true(terrain_drape(&t, &flat, flat_points.items, 0.25, &out, &points));
    for (size_t i = 0; i < 7; i++)
        expected += (ring[i][0] * ring[(i + 1) % 7][1] - ring[(i + 1) % 7][0] * ring[i][1]) / 2;
    for (size_t i = 0; i < 3; i++)
        expected += (hole[i][0] * hole[(i + 1) % 3][1] - hole[(i + 1) % 3][0] * hole[i][1]) / 2;
    for (size_t i = 0; i < points.count; i++) {
        vec3 p = points.items[i];
        assert_float_equal(p.z, (float)terrain_height(&t, (double)p.x, (double)p.y) + 0.25f, 1e-3f);
        for (size_t k = 0; k < i; k++)
            assert_true(hypot((double)(points.items[k].x - p.x), (double)(points.items[k].y - p.y)) > 5e-4);
    }
    for (size_t f = 0; f < out.face_count; f++) {
        double n[3], x = 0, y = 0, z = 0;
        city_normal(points.items, &out, f, n);
        size_t first = city_first_corner(&out, f), count = out.rings[f] - first;
        for (size_t i = first; i < out.rings[f]; i++) {
            vec3 p = points.items[out.corners[i]];
            x += (double)p.x / (double)count;
            y += (double)p.y / (double)count;
            z += (double)p.z / (double)count;
        }
        /* In the middle, too: no piece goes over an edge of the terrain. */
        assert_true(fabs(z - terrain_height(&t, x, y) - 0.25) < 2e-3);
        assert_true(n[2] > 0);
        area += n[2] / 2;
    }
    assert_true(fabs(area - expected) < 1e-3 * expected);
    const double(*const rings[])[2] = {ring, hole};
    check_seams(&out, points.items, rings, (const size_t[]){7, 3}, 2);
    city_shape_release(&flat);
    city_shape_release(&out);
    mem_free(flat_points.items);
    mem_free(points.items);
}

/* A diagonal that passes a post by half a millimetre cuts off a piece that hardly has an area, which must not be
 * missing. */
static void tiny_pieces_are_there(void **state)
{
    (void)state;
    float            heights[121];
    bool             known[121];
    terrain          t = hills(heights, known);
    const double     ring[4][2] = {{-23, -11.5}, {20, -30}, {26, 13.0024}, {-18, 31}};
    city_shape       flat = {0}, out = {0};
    footprint_points flat_points = {0}, points = {0};
    add_ring(&flat, &flat_points, ring, 4);
    assert_true(city_shape_end_face(&flat, NONE, CITY_NO_WORD, 0));
    assert_true(terrain_drape(&t, &flat, flat_points.items, 0.25, &out, &points));
    const double(*const rings[])[2] = {ring};
    check_seams(&out, points.items, rings, (const size_t[]){4}, 1);
    city_shape_release(&flat);
    city_shape_release(&out);
    mem_free(flat_points.items);
    mem_free(points.items);
}

/* --- rasters and other programs' files ------------------------------------------------------------------ */

static bool has_gdal(void)
{
    return system("command -v ogr2ogr > /dev/null 2>&1 && command -v gdal_translate > /dev/null 2>&1") == 0;
}

static char *in_folder(const char *name)
{
    char *path = mem_copy_text(temp_file(name, "", 0));
    assert_non_null(path);
    assert_int_equal(remove(path), 0);
    return path;
}

static void run(const char *format, const char *a, const char *b)
{
    char command[1024];
    snprintf(command, sizeof command, format, a, b);
    if (system(command) != 0)
        fail_msg("failed: %s", command);
}

static lmn_status load(lmn_scene **out, const char *path, const char *terrain_path, lmn_error *error)
{
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.terrain = terrain_path;
    assert_int_equal(lmn_scene_create(out, error), LMN_OK);
    lmn_status status = lmn_scene_add_file(*out, path, &desc, error);
    if (status != LMN_OK)
        lmn_scene_destroy(out);
    return status;
}

static const part *part_with(const lmn_scene *s, const char *surface)
{
    for (size_t i = 0; i < s->part_count; i++) {
        const char *own = scene_attribute_of(s, s->parts[i].node, "surface");
        if (own && strcmp(own, surface) == 0)
            return &s->parts[i];
    }
    fail_msg("no %s", surface);
    return NULL;
}

/* A slope: a metre up for ten to the north, 400 at latitude 47.5. Posts are 3'' apart. */
static const char *slope_of_degrees(void)
{
    enum { SIDE = 1201 };
    static unsigned char heights[SIDE * SIDE * 2];
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++) {
            long metres = lround(400 + 0.1 * 111180 * (0.5 - row / 1200.0)); /* NOLINT: from the north */
            heights[2 * (row * SIDE + column)] = (unsigned char)((unsigned long)metres >> 8 & 255);
            heights[2 * (row * SIDE + column) + 1] = (unsigned char)((unsigned long)metres & 255);
        }
    return temp_file("N47E008.hgt", heights, sizeof heights);
}

static const char village[] = "{\"type\":\"FeatureCollection\",\"features\":["
                              "{\"type\":\"Feature\",\"properties\":{\"building\":\"yes\",\"height\":9,\"name\":"
                              "\"one\"},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[8.999,"
                              "47.5],[8.9992,47.5],[8.9992,47.5002],[8.999,47.5002],[8.999,47.5]]]}},"
                              "{\"type\":\"Feature\",\"properties\":{\"highway\":\"residential\"},\"geometry\":{"
                              "\"type\":\"LineString\",\"coordinates\":[[8.9995,47.499],"
                              "[8.9995,47.501]]}}]}";

static void houses_stand_on_terrain(void **state)
{
    (void)state;
    lmn_scene *s;
    lmn_error  error = {0};
    if (!has_gdal())
        skip();
    char *hgt = mem_copy_text(slope_of_degrees());
    char *model = mem_copy_text(temp_file("village.geojson", village, sizeof village - 1));
    assert_int_equal(load(&s, model, hgt, &error), LMN_OK);
    /* At the lowest corner, which is the southern one, at 47.5; the road goes up by 22 m in 222. */
    const part *wall = part_with(s, "wall"), *road = part_with(s, "road"), *ground = part_with(s, "terrain");
    assert_float_equal(wall->bounds.min.z, 400, 0.7f);
    assert_float_equal(wall->bounds.max.z, 409, 0.7f);
    assert_float_equal(road->bounds.max.z - road->bounds.min.z, 22.2f, 0.7f);
    assert_true(road->triangles > 2);
    assert_true(ground->bounds.min.y < road->bounds.min.y && ground->bounds.max.x > road->bounds.max.x);
    lmn_scene_destroy(&s);
    mem_free(hgt);
    mem_free(model);
}

/* The same terrain in another system, in feet of heights it does not have, as GeoTIFF and ESRI's grid. */
static void rasters_may_be_in_other_systems(void **state)
{
    (void)state;
    lmn_error  error = {0};
    lmn_scene *s;
    if (!has_gdal())
        skip();
    char *hgt = mem_copy_text(slope_of_degrees()), *tif = in_folder("slope.tif"), *grid = in_folder("slope.asc");
    char *model = mem_copy_text(temp_file("village.geojson", village, sizeof village - 1));
    run("gdalwarp -q -t_srs EPSG:2056 -te 2715000 1255000 2725000 1265000 -tr 25 25 -r bilinear %s %s > /dev/null 2>&1",
        hgt, tif);
    run("gdal_translate -q -of AAIGrid %s %s > /dev/null 2>&1", tif, grid);
    const char *const files[] = {tif, grid};
    for (size_t i = 0; i < COUNT(files); i++) {
        run("gdalinfo %s > /dev/null 2>&1%s", files[i], "");
        if (load(&s, model, files[i], &error) != LMN_OK)
            fail_msg("%s: %s", files[i], error.message);
        assert_float_equal(part_with(s, "wall")->bounds.min.z, 400, 1.5f);
        assert_float_equal(part_with(s, "wall")->bounds.max.z, 409, 1.5f);
        lmn_scene_destroy(&s);
    }
    /* Alone they are models, too, also where the system's name is one that only its maker knows. In the first one
     * heights are known from 2715000 to where the ninth meridian is. */
    char *degrees = in_folder("degrees.asc");
    run("gdal_translate -q -srcwin 500 500 40 40 -of AAIGrid %s %s > /dev/null 2>&1", hgt, degrees);
    const char *const alone[] = {grid, degrees};
    for (size_t i = 0; i < COUNT(alone); i++) {
        if (load(&s, alone[i], NULL, &error) != LMN_OK)
            fail_msg("%s: %s", alone[i], error.message);
        assert_int_equal(s->part_count, 1);
        assert_float_equal(s->parts[0].bounds.max.x - s->parts[0].bounds.min.x, i ? 39 * 62.7f : 2730, i ? 60 : 40);
        lmn_scene_destroy(&s);
    }
    mem_free(degrees);
    assert_int_equal(load(&s, tif, NULL, &error), LMN_OK);
    assert_true(s->part_count == 1 && s->up == 'z');
    assert_string_equal(s->city.crs, "EPSG:2056");
    lmn_scene_destroy(&s);
    mem_free(hgt);
    mem_free(tif);
    mem_free(grid);
    mem_free(model);
}

/* One village in many files: the same houses, at the same place, in metres. */
static void formats_say_the_same(void **state)
{
    (void)state;
    static const struct {
        const char *name, *command;
    } rows[] = {
        {"v.gpkg", "ogr2ogr %s %s > /dev/null 2>&1"},
        {"v-feet.gpkg", "ogr2ogr -t_srs EPSG:2263 %s %s > /dev/null 2>&1"},
        {"v-web.fgb", "ogr2ogr -t_srs EPSG:3857 %s %s > /dev/null 2>&1"},
        {"v.shp", "ogr2ogr -where \"OGR_GEOMETRY='Polygon'\" -t_srs EPSG:25832 %s %s > /dev/null 2>&1"},
    };
    lmn_error error = {0};
    if (!has_gdal())
        skip();
    char *model = mem_copy_text(temp_file("village.geojson", village, sizeof village - 1));
    for (size_t i = 0; i < COUNT(rows); i++) {
        lmn_scene *s;
        char      *path = in_folder(rows[i].name);
        run(rows[i].command, path, model);
        if (load(&s, path, NULL, &error) != LMN_OK)
            fail_msg("%s: %s", rows[i].name, error.message);
        const part *wall = part_with(s, "wall");
        double      area =
            (double)(wall->bounds.max.x - wall->bounds.min.x) * (double)(wall->bounds.max.y - wall->bounds.min.y);
        /* New York's plane is turned by sixty degrees here, and stretched. */
        bool bent = strcmp(rows[i].name, "v-feet.gpkg") == 0;
        if (!bent && fabs(area - 15.06 * 22.24) > 6)
            fail_msg("%s: a house of %g m²", rows[i].name, area);
        if (bent)
            assert_true(area > 300 && area < 2500);
        assert_float_equal(wall->bounds.max.z, 9, 0.01f);
        assert_string_equal(scene_attribute_of(s, wall->node, "name"), "one");
        lmn_scene_destroy(&s);
        mem_free(path);
    }
    mem_free(model);
}

static void openstreetmap_has_tags(void **state)
{
    (void)state;
    static const char text[] =
        "<?xml version='1.0'?><osm version='0.6'><node id='1' lat='47.5' lon='8.999'/><node id='2' lat='47.5' "
        "lon='8.9992'/>"
        "<node id='3' lat='47.5002' lon='8.9992'/><node id='4' lat='47.5002' lon='8.999'/><node id='5' lat='47.499' "
        "lon='8.9995'/>"
        "<node id='6' lat='47.501' lon='8.9995'/><node id='7' lat='47.5' lon='9'><tag k='amenity' v='bench'/></node>"
        "<way id='10'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/><tag k='building' v='yes'/>"
        "<tag k='height' v='9'/><tag k='name' v='&quot;Zum Löwen&quot;, \\'/></way>"
        "<way id='11'><nd ref='5'/><nd ref='6'/><tag k='highway' v='residential'/></way></osm>";
    lmn_scene *s;
    lmn_error  error = {0};
    if (!has_gdal())
        skip();
    char *path = mem_copy_text(temp_file("v.osm", text, sizeof text - 1));
    if (load(&s, path, NULL, &error) != LMN_OK)
        fail_msg("%s", error.message);
    const part *wall = part_with(s, "wall");
    assert_float_equal(wall->bounds.max.z, 9, 0.01f);
    assert_string_equal(scene_attribute_of(s, wall->node, "name"), "\"Zum Löwen\", \\");
    assert_true(part_with(s, "road")->triangles == 2);
    assert_float_equal(part_with(s, "furniture")->bounds.max.z, 0.86f, 0.01f);
    lmn_scene_destroy(&s);
    mem_free(path);
}

/* --- what goes wrong ------------------------------------------------------------------------------------ */

/* In a child that has not prepared it there is no library, as where it is not installed. */
static void without_the_library_it_says_so(void **state)
{
    (void)state;
    fence_bytes request = {0}, answer;
    lmn_error   error = {0};
    fence_put_u32(&request, GEODATA_FEATURES);
    assert_int_equal(fence_call_always(&answer, geodata_answer, "the reader", &request, &error), LMN_UNSUPPORTED);
    assert_non_null(strstr(error.message, "GDAL"));
    assert_non_null(strstr(error.hint, "gdal-bin"));
    mem_free(request.bytes);
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const char cut[] = "SQLite format 3\0 and nothing else that a package would have in it at the right place.";
    char              package[128] = {0};
    memcpy(package, cut, sizeof cut);
    memcpy(package + 68, "GPKG", 4);
    static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const char small[] = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    lmn_scene        *s;
    lmn_error         error = {0};
    char             *box = mem_copy_text(temp_file("box.obj", triangle, sizeof triangle - 1));
    char             *model = mem_copy_text(temp_file("village.geojson", village, sizeof village - 1));
    char             *broken = mem_copy_text(temp_file("broken.gpkg", package, sizeof package));
    char             *far = mem_copy_text(temp_file("far.asc", small, sizeof small - 1));
    assert_int_equal(load(&s, box, model, &error), LMN_USAGE);  /* no city */
    assert_int_equal(load(&s, model, box, &error), LMN_FORMAT); /* no raster */
    assert_int_equal(load(&s, model, "/nowhere.tif", &error), LMN_READ);
    if (has_gdal()) {
        assert_int_equal(load(&s, broken, NULL, &error), LMN_FORMAT);
        assert_int_equal(load(&s, model, far, &error), LMN_FORMAT);
        assert_non_null(strstr(error.message, "reach"));
    }
    mem_free(box);
    mem_free(model);
    mem_free(broken);
    mem_free(far);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_follow_the_terrain),       cmocka_unit_test(tiny_pieces_are_there),
        cmocka_unit_test(houses_stand_on_terrain),        cmocka_unit_test(rasters_may_be_in_other_systems),
        cmocka_unit_test(formats_say_the_same),           cmocka_unit_test(openstreetmap_has_tags),
        cmocka_unit_test(without_the_library_it_says_so), cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
