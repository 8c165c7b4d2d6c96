/* CityJSON: small cities of which everything is known, and what is wrong with files. */
#include <math.h>
#include <zlib.h>

#include "import/city.h"
#include "import_support.h"
#include "limner/content.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* A cube of 1 m at 0 in vertices of 1 mm; its faces look outwards: bottom, top, and four sides. */
#define CUBE_VERTICES                                                                                                  \
    "\"vertices\":[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,1000],[1000,0,1000],[1000,1000,1000],[0,1000,"     \
    "1000]]"
#define TRANSFORM          "\"transform\":{\"scale\":[0.001,0.001,0.001],\"translate\":[0,0,0]}"
#define HEAD               "{\"type\":\"CityJSON\",\"version\":\"2.0\"," TRANSFORM ","
#define CUBE_FACES         "[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]"
#define SOLID              "{\"type\":\"Solid\",\"lod\":\"2\",\"boundaries\":[[" CUBE_FACES "]]}"
#define BUILDING(geometry) "{\"type\":\"Building\",\"geometry\":[" geometry "]}"
#define MODEL(objects)     HEAD "\"CityObjects\":{" objects "}," CUBE_VERTICES "}"

static lmn_scene *load_text(const char *text)
{
    return load_or_fail(temp_file("city.json", text, strlen(text)));
}

static lmn_status try_text(const char *text, lmn_scene **out, lmn_error *error)
{
    *error = (lmn_error){0};
    assert_int_equal(lmn_scene_create(out, error), LMN_OK);
    return lmn_scene_add_file(*out, temp_file("city.json", text, strlen(text)), NULL, error);
}

static const char *attribute_of(const lmn_scene *s, int32_t node, const char *key)
{
    for (; node != NONE; node = s->nodes[node].parent)
        for (size_t i = 0; i < s->nodes[node].attribute_count; i++)
            if (strcmp(s->nodes[node].attributes[i].key, key) == 0)
                return s->nodes[node].attributes[i].value;
    return "";
}

/* Of the parts with this surface (NULL: all): area, and the volume that they enclose together. */
static double measure(const lmn_scene *s, const char *surface, double *volume)
{
    double area = 0;
    mat4  *worlds = scene_world_matrices(s, NULL);
    *volume = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        int32_t     at = s->parts[i].node;
        const mesh *m = &s->meshes[s->nodes[at].mesh];
        if (surface && strcmp(attribute_of(s, at, "surface"), surface) != 0)
            continue;
        for (size_t k = 0; k < m->primitive_count; k++)
            for (size_t c = 0; c < m->primitives[k].index_count; c += 3) {
                vec3 p[3];
                for (int j = 0; j < 3; j++)
                    p[j] = mat4_transform_point(&worlds[at],
                                                m->primitives[k].positions[m->primitives[k].indices[c + (size_t)j]]);
                double u[3] = {p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z};
                double v[3] = {p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z};
                double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
                area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
                *volume += (p[0].x * n[0] + p[0].y * n[1] + p[0].z * n[2]) / 6;
            }
    }
    mem_free(worlds);
    return area;
}

static void expect(const lmn_scene *s, const char *surface, double area)
{
    double volume, found = measure(s, surface, &volume);
    if (fabs(found - area) > 1e-5)
        fail_msg("%s: area %g, not %g", surface ? surface : "all", found, area);
}

static size_t skipped(const lmn_scene *s, const char *what)
{
    return (size_t)city_counted(&s->city, CITY_SKIPPED, what);
}

/* --- what becomes of a building ------------------------------------------------------------------------- */

static void test_solid(void **state)
{
    (void)state;
    lmn_scene *s = load_text(MODEL("\"house-1\":{\"type\":\"Building\",\"attributes\":{\"measuredHeight\":9.5,"
                                   "\"name\":\"Sch\\u00f6n \\\"x\\\"\",\"flat\":true,\"none\":null,\"list\":[1,2]},"
                                   "\"geometry\":[" SOLID "]}"));
    double     volume;
    assert_int_equal(lmn_scene_info_of(s).triangles, 12);
    assert_int_equal(s->up, 'z');
    measure(s, NULL, &volume);
    assert_true(fabs(volume - 1) < 1e-6);
    /* The file does not say which faces are what. */
    assert_int_equal(s->part_count, 3);
    expect(s, "roof", 1);
    expect(s, "wall", 4);
    expect(s, "ground", 1);
    assert_string_equal(s->parts[0].path, "city/house-1/roof");
    int32_t node = s->parts[0].node;
    assert_string_equal(attribute_of(s, node, "type"), "Building");
    assert_string_equal(attribute_of(s, node, "measuredHeight"), "9.5");
    assert_string_equal(attribute_of(s, node, "name"), "Sch\xc3\xb6n \"x\"");
    assert_string_equal(attribute_of(s, node, "flat"), "true");
    assert_string_equal(attribute_of(s, node, "none"), "");
    assert_string_equal(attribute_of(s, node, "list"), "[1,2]");
    assert_int_equal(city_counted(&s->city, CITY_OBJECTS, "Building"), 1);
    assert_int_equal(city_counted(&s->city, CITY_LODS, "2"), 1);
    assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "guessed-surfaces"), 6);
    lmn_scene_destroy(&s);
}

/* Names and attributes of surfaces are the same for all nodes of a kind, until one of them gets others. */
static void test_facts_of_surfaces(void **state)
{
    (void)state;
    lmn_scene *s = load_text(MODEL("\"a\":" BUILDING(SOLID) ",\"b\":" BUILDING(SOLID)));
    lmn_error  error = {0};
    assert_int_equal(s->part_count, 6);
    const int32_t one = s->parts[0].node, other = s->parts[3].node;
    assert_string_equal(s->parts[3].path, "city/b/roof");
    assert_int_equal(lmn_scene_set_attribute(s, (uint32_t)one + 1, "colour", "red", &error), LMN_OK);
    assert_int_equal(lmn_scene_set_attribute(s, (uint32_t)one + 1, "surface", "dome", &error), LMN_OK);
    assert_string_equal(s->nodes[one].name, "roof");
    assert_string_equal(attribute_of(s, one, "surface"), "dome");
    assert_string_equal(attribute_of(s, one, "colour"), "red");
    assert_string_equal(attribute_of(s, other, "surface"), "roof");
    assert_string_equal(attribute_of(s, other, "colour"), "");
    assert_int_equal(lmn_scene_set_attribute(s, (uint32_t)other + 1, "surface", NULL, &error), LMN_OK);
    assert_string_equal(attribute_of(s, other, "surface"), "");
    assert_string_equal(attribute_of(s, s->parts[1].node, "surface"), "wall");
    lmn_scene_destroy(&s);
}

/* Whichever faces look the wrong way: they are turned, and only they; when all do, all are. */
static void test_turned_faces(void **state)
{
    (void)state;
    static const char *const right[] = {"0,3,2,1", "4,5,6,7", "0,1,5,4", "1,2,6,5", "2,3,7,6", "3,0,4,7"};
    static const char *const wrong[] = {"1,2,3,0", "7,6,5,4", "4,5,1,0", "5,6,2,1", "6,7,3,2", "7,4,0,3"};
    for (unsigned which = 0; which < 64; which++) {
        char   text[1200], *at = text;
        size_t turned = 0;
        at += snprintf(at, sizeof text - (size_t)(at - text),
                       "%s\"CityObjects\":{\"a\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"MultiSurface\","
                       "\"lod\":2,\"boundaries\":[",
                       HEAD);
        for (unsigned f = 0; f < 6; f++) {
            turned += which >> f & 1;
            at += snprintf(at, sizeof text - (size_t)(at - text), "%s[[%s]]", f ? "," : "",
                           which >> f & 1 ? wrong[f] : right[f]);
        }
        snprintf(at, sizeof text - (size_t)(at - text), "]}]}},%s}", CUBE_VERTICES);
        lmn_scene *s = load_text(text);
        double     volume;
        measure(s, NULL, &volume);
        if (fabs(volume - 1) > 1e-6 || city_counted(&s->city, CITY_REPAIRED, "turned-faces") != turned)
            fail_msg("faces %#x: volume %g", which, volume);
        expect(s, "roof", 1);
        lmn_scene_destroy(&s);
    }
}

/* An open roof looks up and a ground down; water, too. */
static void test_open_surfaces(void **state)
{
    (void)state;
    lmn_scene *s = load_text(MODEL("\"b\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":"
                                   "\"2\",\"boundaries\":[[[7,6,5,4]],"
                                   "[[0,1,2,3]]],\"semantics\":{\"surfaces\":[{\"type\":\"RoofSurface\"},{\"type\":"
                                   "\"GroundSurface\"}],\"values\":[0,1]}}]},"
                                   "\"w\":{\"type\":\"WaterBody\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":"
                                   "\"1\",\"boundaries\":[[[3,2,1,0]]]}]}"));
    assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "turned-faces"), 3);
    for (size_t i = 0; i < s->part_count; i++) {
        const primitive *p = &s->meshes[s->nodes[s->parts[i].node].mesh].primitives[0];
        vec3   a = p->positions[p->indices[0]], b = p->positions[p->indices[1]], c = p->positions[p->indices[2]];
        double up = (double)(b.x - a.x) * (double)(c.y - a.y) - (double)(b.y - a.y) * (double)(c.x - a.x);
        bool   ground = strcmp(attribute_of(s, s->parts[i].node, "surface"), "ground") == 0;
        assert_true(ground ? up < 0 : up > 0);
    }
    expect(s, "water", 1);
    assert_string_equal(s->parts[2].path, "city/w");
    lmn_scene_destroy(&s);
}

/* A wall with a hole and a window in it; the hole may run either way. */
static void test_holes(void **state)
{
    (void)state;
    static const char *const holes[] = {"8,9,10,11", "11,10,9,8"};
    for (size_t i = 0; i < COUNT(holes); i++) {
        char text[1200];
        snprintf(
            text, sizeof text,
            "%s\"CityObjects\":{\"a\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":3,"
            "\"boundaries\":"
            "[[[0,1,5,4],[%s]],[[8,9,10,11]]],\"semantics\":{\"surfaces\":[{\"type\":\"WallSurface\"},{\"type\":"
            "\"Window\"}],"
            "\"values\":[0,1]}}]}},\"vertices\":[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,1000],[1000,0,1000],"
            "[1000,1000,1000],[0,1000,1000],[200,0,200],[600,0,200],[600,0,700],[200,0,700]]}",
            HEAD, holes[i]);
        lmn_scene *s = load_text(text);
        expect(s, "window", 0.2);
        expect(s, "wall", 0.8);
        lmn_scene_destroy(&s);
    }
}

/* Values may be null on every level. */
static void test_semantics(void **state)
{
    (void)state;
#define WORDS "\"surfaces\":[{\"type\":\"RoofSurface\"},{\"type\":\"WallSurface\"},{\"type\":\"+Odd\"}]"
    static const struct {
        const char *type, *boundaries, *values;
        double      roof, wall;
    } cases[] = {
        {"MultiSurface", CUBE_FACES, "[null,0,1,1,1,1]", 1, 4},
        {"MultiSurface", CUBE_FACES, "[2,0,1]", 1, 1},
        {"MultiSurface", CUBE_FACES, "[0,0,0,0,0,0,0,0]", 6, 0},
        {"MultiSurface", CUBE_FACES, "[7,0,-1,1.5]", 1, 0},
        {"Solid", "[" CUBE_FACES "]", "[[null,0,1,1,1,1]]", 1, 4},
        {"Solid", "[" CUBE_FACES "],[[[4,5,6,7]]]", "[null,[0]]", 1, 0},
        {"CompositeSolid", "[[" CUBE_FACES "]],[[" CUBE_FACES "],[[[4,5,6,7]]]],[[[[0,1,5,4]]]]",
         "[null,[null,[0]],[[1]]]", 1, 1},
        {"MultiSolid", "[[" CUBE_FACES "]],[[[[0,1,5,4]]]]", "[[[0]],null]", 1, 0},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[2000];
        snprintf(text, sizeof text,
                 "%s\"CityObjects\":{\"a\":{\"type\":\"Building\",\"geometry\":[{\"semantics\":{" WORDS
                 ",\"values\":%s},\"boundaries\":[%s],\"type\":\"%s\",\"lod\":\"2\"}]}},%s}",
                 HEAD, cases[i].values, cases[i].boundaries, cases[i].type, CUBE_VERTICES);
        lmn_scene *s = load_text(text);
        double     volume, roof = measure(s, "roof", &volume), wall = measure(s, "wall", &volume);
        if (fabs(roof - cases[i].roof) > 1e-5 || fabs(wall - cases[i].wall) > 1e-5)
            fail_msg("case %zu: roof %g, wall %g", i, roof, wall);
        lmn_scene_destroy(&s);
    }
}

/* --- levels of detail, parts, templates ----------------------------------------------------------------- */

#define LOD(lod, faces) "{\"type\":\"MultiSurface\",\"lod\":" lod ",\"boundaries\":[" faces "]}"

static void test_levels_of_detail(void **state)
{
    (void)state;
    static const char text[] =
        MODEL("\"a\":{\"type\":\"Building\",\"geometry\":[" LOD("\"1.2\"", "[[0,1,2,3]],[[4,5,6,7]]") "," LOD(
            "\"2.2\"",
            CUBE_FACES) "," LOD("0", "[[0,1,2,3]]") "]},\"b\":{\"type\":\"Building\",\"children\":[\"c\"],"
                                                    "\"geometry\":[" LOD(
                                                        "\"0\"", "[[0,1,2,3]]") "]},\"c\":{\"type\":"
                                                                                "\"BuildingPart\",\"parents\":[\"b\"],"
                                                                                "\"geometry\":[" LOD("\"1.3\"",
                                                                                                     CUBE_FACES) "]}");
    static const struct {
        const char *lod;
        double      area;
        size_t      without, coarser;
    } cases[] = {{NULL, 12, 0, 1}, {"2", 8, 0, 1}, {"1.2", 3, 1, 0}, {"0.5", 2, 1, 0}, {"9", 12, 0, 1}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        lmn_scene    *s = NULL;
        lmn_load_desc desc = LMN_LOAD_DESC_INIT;
        desc.lod = cases[i].lod;
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        assert_int_equal(lmn_scene_add_file(s, temp_file("city.json", text, sizeof text - 1), &desc, NULL), LMN_OK);
        expect(s, NULL, cases[i].area);
        assert_int_equal(skipped(s, "objects-without-this-lod"), cases[i].without);
        assert_int_equal(skipped(s, "coarser-than-parts"), cases[i].coarser);
        if (!cases[i].lod)
            assert_string_equal(s->parts[s->part_count - 1].path, "city/b/c/ground");
        lmn_scene_destroy(&s);
    }
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    lmn_error     error = {0};
    lmn_scene    *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    desc.lod = "two";
    assert_int_equal(lmn_scene_add_file(s, temp_file("city.json", text, sizeof text - 1), &desc, &error), LMN_USAGE);
    desc.lod = "2";
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_int_equal(lmn_scene_add_file(s, temp_file("a.obj", obj, sizeof obj - 1), &desc, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "city models"));
    lmn_scene_destroy(&s);
}

static void test_templates(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        HEAD
        "\"geometry-templates\":{\"templates\":[{\"type\":\"MultiSurface\",\"lod\":\"2\",\"boundaries\":[[[0,1,2]]]}],"
        "\"vertices-templates\":[[0,0,0],[2.5,0,0],[0,2,0]]},\"CityObjects\":{"
        "\"t1\":{\"type\":\"SolitaryVegetationObject\",\"geometry\":[{\"type\":\"GeometryInstance\",\"template\":0,"
        "\"boundaries\":[5],"
        "\"transformationMatrix\":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]}]},"
        "\"t2\":{\"type\":\"SolitaryVegetationObject\",\"geometry\":[{\"type\":\"GeometryInstance\",\"template\":0,"
        "\"boundaries\":[0],"
        "\"transformationMatrix\":[1,0,0,7,0,1,0,0,0,0,1,0,0,0,0,1]}]},"
        "\"bad\":{\"type\":\"CityFurniture\",\"geometry\":[{\"type\":\"GeometryInstance\",\"template\":3,"
        "\"boundaries\":[0],"
        "\"transformationMatrix\":[1,0,0,7,0,1,0,0,0,0,1,0,0,0,0,1]}]}}," CUBE_VERTICES "}");
    assert_int_equal(s->part_count, 2);
    assert_int_equal(s->mesh_count, 1);
    expect(s, "plant", 10 + 2.5);
    /* The file's middle is the origin: 1 m, on whole metres, is at 0 or 1. */
    double origin = s->city.origin[0];
    assert_true(fabs((double)s->parts[0].bounds.min.x - (1 - origin)) < 1e-6);
    assert_true(fabs((double)s->parts[0].bounds.max.x - (6 - origin)) < 1e-6);
    assert_true(fabs((double)s->parts[0].bounds.min.z - 1) < 1e-6);
    assert_true(fabs((double)s->parts[1].bounds.min.x - (7 - origin)) < 1e-6);
    assert_string_equal(s->parts[0].path, "city/t1");
    assert_int_equal(skipped(s, "broken-references"), 1);
    lmn_scene_destroy(&s);
}

static void test_lines_and_points(void **state)
{
    (void)state;
    lmn_scene *s = load_text(MODEL("\"a\":{\"type\":\"CityFurniture\",\"geometry\":[{\"type\":\"MultiLineString\","
                                   "\"lod\":\"1\",\"boundaries\":[[0,1,2],[4,5]]},"
                                   "{\"type\":\"MultiPoint\",\"lod\":\"1\",\"boundaries\":[0,1]}]}"));
    assert_int_equal(lmn_scene_info_of(s).lines, 3);
    assert_int_equal(skipped(s, "points"), 1);
    lmn_scene_destroy(&s);
}

/* --- appearance ----------------------------------------------------------------------------------------- */

static void test_materials(void **state)
{
    (void)state;
    lmn_scene *s = load_text(HEAD "\"appearance\":{\"default-theme-material\":\"night\",\"materials\":[{\"name\":"
                                  "\"red\",\"diffuseColor\":[1,0,0]},{\"name\":"
                                  "\"glass\",\"diffuseColor\":[0,0,1],\"transparency\":0.75}]},\"CityObjects\":{\"a\":{"
                                  "\"type\":\"Building\",\"geometry\":[{"
                                  "\"type\":\"MultiSurface\",\"lod\":\"2\",\"boundaries\":[" CUBE_FACES
                                  "],\"material\":{\"day\":{\"value\":0},\"night\":"
                                  "{\"values\":[0,1,null,null,9,0]}}}]}}," CUBE_VERTICES "}");
    double     area[3] = {0};
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            const primitive *p = &s->meshes[i].primitives[k];
            const char      *name = s->materials[p->material].name;
            area[strcmp(name, "red") == 0 ? 0 : strcmp(name, "glass") == 0 ? 1 : 2] += (double)p->index_count / 6;
            if (strcmp(name, "glass") == 0) {
                assert_true(fabsf(s->materials[p->material].base_colour.w - 0.25f) < 1e-6f);
                assert_int_equal(s->materials[p->material].alpha, ALPHA_BLEND);
            }
        }
    assert_true(fabs(area[0] - 2) < 1e-6 && fabs(area[1] - 1) < 1e-6 && fabs(area[2] - 3) < 1e-6);
    assert_int_equal(skipped(s, "broken-references"), 1);
    lmn_scene_destroy(&s);
}

/* A red pixel as the texture of one face; another names a file that is not there. */
static void test_textures(void **state)
{
    (void)state;
    static const unsigned char png[] = {0x89, 'P',  'N',  'G',  13,   10,  26,  10,  0,   0,    0,    13,   'I',  'H',
                                        'D',  'R',  0,    0,    0,    1,   0,   0,   0,   1,    8,    2,    0,    0,
                                        0,    0x90, 0x77, 0x53, 0xde, 0,   0,   0,   12,  'I',  'D',  'A',  'T',  8,
                                        0xd7, 0x63, 0xf8, 0xcf, 0xc0, 0,   0,   3,   1,   1,    0,    0x18, 0xdd, 0x8d,
                                        0xb0, 0,    0,    0,    0,    'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    temp_file("red.png", png, sizeof png);
    lmn_scene *s = load_text(HEAD "\"appearance\":{\"textures\":[{\"type\":\"PNG\",\"image\":\"red.png\",\"wrapMode\":"
                                  "\"clamp\"},{\"type\":\"JPG\",\"image\":"
                                  "\"gone.jpg\"},{\"type\":\"JPG\",\"image\":\"gone, "
                                  "too.jpg\"}],\"vertices-texture\":[[0,0],[1,0],[1,0.25],[0,1]]},\"CityObjects\":{"
                                  "\"a\":{\"type\":\"Building\",\"geometry\":[{"
                                  "\"type\":\"MultiSurface\",\"lod\":\"2\",\"boundaries\":[[[4,5,6,7]],[[0,1,5,4]],[[1,"
                                  "2,6,5]]],\"texture\":{\"t\":{\"values\":"
                                  "[[[0,0,1,2,3]],[[2,0,1,2,3]],[[1,0,1,2,3]]]}}}]}}," CUBE_VERTICES "}");
    assert_int_equal(s->image_count, 1);
    size_t textured = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            const primitive *p = &s->meshes[i].primitives[k];
            if (s->materials[p->material].base_texture.image == NONE)
                continue;
            textured++;
            assert_int_equal(s->materials[p->material].base_texture.wrap_u, WRAP_CLAMP);
            for (uint32_t v = 0; v < p->vertex_count; v++)
                if (p->positions[v].x > 0.5f - (float)s->city.origin[0] &&
                    p->positions[v].y > 0.5f - (float)s->city.origin[1])
                    assert_true(fabsf(p->uvs[0][v].y - 0.75f) < 1e-6f); /* the file's places are counted from below */
        }
    assert_int_equal(textured, 1);
    size_t told = 0;
    for (size_t i = 0; i < s->warnings.count; i++)
        if (s->warnings.items[i].code == WARNING_MISSING_FILE) {
            told++;
            assert_non_null(strstr(s->warnings.items[i].text, "2 textures are missing"));
            assert_non_null(strstr(s->warnings.items[i].text, "gone"));
        }
    assert_int_equal(told, 1);
    lmn_scene_destroy(&s);
}

/* --- where it lies -------------------------------------------------------------------------------------- */

/* Ten thousand kilometres off, and two files of one city side by side. */
static void test_origins(void **state)
{
    (void)state;
    char        text[2][900], path[300];
    const char *translate[] = {"10000000,5000000,12", "10000100.5,5000000,12"};
    for (int i = 0; i < 2; i++)
        snprintf(
            text[i], sizeof text[i],
            "{\"type\":\"CityJSON\",\"version\":\"1.1\",\"transform\":{\"scale\":[0.001,0.001,0.001],\"translate\":[%s]"
            "},\"metadata\":"
            "{\"referenceSystem\":\"https://www.opengis.net/def/crs/EPSG/0/7415\"},\"CityObjects\":{\"a\":" BUILDING(
                SOLID) "}," CUBE_VERTICES "}",
            translate[i]);
    snprintf(path, sizeof path, "%s", temp_file("one.city.json", text[0], strlen(text[0])));
    lmn_scene *s = load_or_fail(path);
    assert_int_equal(lmn_scene_add_file(s, temp_file("two.city.json", text[1], strlen(text[1])), NULL, NULL), LMN_OK);
    assert_string_equal(s->city.crs, "https://www.opengis.net/def/crs/EPSG/0/7415");
    lmn_scene_info info = lmn_scene_info_of(s);
    double         volume;
    assert_true(fabs(s->city.origin[0] - 10000000) <= 1 && fabs(s->city.origin[1] - 5000000) <= 1);
    assert_true(fabs(info.bounds_min[0] + s->city.origin[0] - 10000000) < 1e-5);
    assert_true(fabs(info.bounds_max[0] - info.bounds_min[0] - 101.5) < 1e-4);
    assert_true(fabs(info.bounds_min[2] - 12) < 1e-5);
    measure(s, NULL, &volume);
    assert_true(fabs(volume - 2) < 1e-3);
    lmn_scene_destroy(&s);
}

/* Degrees become metres on the plane of the meridian 138, where north is turned by half a degree here. */
static void test_degrees(void **state)
{
    (void)state;
    lmn_scene *s = load_text("{\"type\":\"CityJSON\",\"version\":\"1.1\",\"metadata\":{\"referenceSystem\":\"urn:ogc:"
                             "def:crs:EPSG::6697\"},\"CityObjects\":"
                             "{\"a\":{\"type\":\"LandUse\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":\"1\","
                             "\"boundaries\":[[[0,1,2,3]]]}]}},"
                             "\"vertices\":[[35.0,139.0,3],[35.001,139.0,3],[35.001,139.001,3],[35.0,139.001,3]]}");
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(s->city.geographic);
    assert_true(fabs(s->city.origin[0] - 139.0005) < 6e-5 && fabs(s->city.origin[1] - 35.0005) < 6e-5);
    assert_true(fabs(info.bounds_max[0] - info.bounds_min[0] - 92.404) < 0.01);
    assert_true(fabs(info.bounds_max[1] - info.bounds_min[1] - 111.861) < 0.01);
    lmn_scene_destroy(&s);
}

/* A square of a thousand feet, twenty feet up, and what the web calls metres. */
static void test_units(void **state)
{
    (void)state;
#define SQUARE(crs, x0, y0, x1, y1)                                                                                    \
    "{\"type\":\"CityJSON\",\"version\":\"1.1\",\"metadata\":{\"referenceSystem\":\"" crs "\"},\"CityObjects\":"       \
    "{\"a\":{\"type\":\"LandUse\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":\"1\",\"boundaries\":[[[0,1,2,3]]]" \
    "}]}},"                                                                                                            \
    "\"vertices\":[[" x0 "," y0 ",20],[" x1 "," y0 ",20],[" x1 "," y1 ",20],[" x0 "," y1 ",20]]}"
    static const struct {
        const char *text;
        double      side, height;
    } rows[] = {
        {SQUARE("urn:ogc:def:crs:EPSG::2263", "980000", "200000", "981000", "201000"), 304.8006, 6.096},
        {SQUARE("urn:ogc:def:crs,crs:EPSG::2263,crs:EPSG::5703", "980000", "200000", "981000", "201000"), 304.8006, 20},
        {SQUARE("https://www.opengis.net/def/crs/EPSG/0/2222", "700000", "900000", "701000", "901000"), 304.8, 6.096},
        {SQUARE("urn:ogc:def:crs:EPSG::25832", "500000", "5300000", "501000", "5301000"), 1000, 20},
        /* At 60 degrees these metres are half as long. */
        {SQUARE("urn:ogc:def:crs:EPSG::3857", "1001875", "8399237", "1002875", "8400237"), 500.6, 20},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_scene     *s = load_text(rows[i].text);
        lmn_scene_info info = lmn_scene_info_of(s);
        if (fabs(info.bounds_max[0] - info.bounds_min[0] - rows[i].side) > 0.002 * rows[i].side ||
            fabs(info.bounds_max[1] - info.bounds_min[1] - rows[i].side) > 0.003 * rows[i].side ||
            fabs(info.bounds_max[2] - rows[i].height) > 0.001)
            fail_msg("row %zu: %g by %g, %g up", i, info.bounds_max[0] - info.bounds_min[0],
                     info.bounds_max[1] - info.bounds_min[1], info.bounds_max[2]);
        lmn_scene_destroy(&s);
    }
}

/* Against PROJ: gdaltransform -s_srs +proj=longlat -t_srs "+proj=tmerc +lon_0=MERIDIAN", both with +ellps=WGS84. */
static void test_plane(void **state)
{
    (void)state;
    static const double rows[][5] = {
        {11.575, 48.137, 12, -31631.6820183, 5333748.2234670}, {139.7, 35.6, 141, -117805.1310226, 3941938.6112385},
        {-73.97, 40.78, -75, 86947.4425617, 4516652.3850884},  {7.4, 43.73, 6, 112797.1474066, 4844775.4842252},
        {179.5, -17.5, 180, -53100.2724258, -1935712.8280996}, {4.36, 52.0, 3, 93399.9877364, 5764217.1270925}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double p[2];
        city_plane(rows[i][0], rows[i][1], rows[i][2], p);
        if (fabs(p[0] - rows[i][3]) > 1e-4 || fabs(p[1] - rows[i][4]) > 1e-4)
            fail_msg("row %zu: %.5f, %.5f", i, p[0], p[1]);
    }
}

/* --- sequences and packed files ------------------------------------------------------------------------- */

#define FEATURE(id)                                                                                                    \
    "{\"type\":\"CityJSONFeature\",\"id\":\"" id "\",\"CityObjects\":{\"" id "\":" BUILDING(SOLID) "}," CUBE_VERTICES  \
                                                                                                   "}\n"

static void test_sequence(void **state)
{
    (void)state;
    static const char text[] = HEAD "\"CityObjects\":{},\"vertices\":[]}\n" FEATURE("a") FEATURE("b") "\n" FEATURE("c");
    lmn_scene        *s = load_or_fail(temp_file("town.city.jsonl", text, sizeof text - 1));
    assert_int_equal(city_counted(&s->city, CITY_OBJECTS, "Building"), 3);
    expect(s, NULL, 18);
    lmn_scene_destroy(&s);
}

static const char *pack(const char *name, const void *bytes, size_t size, size_t cut)
{
    uLong          room = compressBound((uLong)size) + 64;
    unsigned char *packed = malloc(room);
    z_stream       stream = {
              .next_in = (Bytef *)(uintptr_t)bytes, .avail_in = (uInt)size, .next_out = packed, .avail_out = (uInt)room};
    assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    const char *path = temp_file(name, packed, stream.total_out - cut);
    deflateEnd(&stream);
    free(packed);
    return path;
}

static void test_packed(void **state)
{
    (void)state;
    static const char text[] = MODEL("\"a\":" BUILDING(SOLID));
    lmn_scene        *s = load_or_fail(pack("town.city.json.gz", text, sizeof text - 1, 0));
    expect(s, NULL, 6);
    lmn_error error = {0};
    assert_int_equal(lmn_scene_add_file(s, pack("cut.city.json.gz", text, sizeof text - 1, 40), NULL, &error),
                     LMN_FORMAT);
    assert_non_null(strstr(error.message, "gzip"));
    size_t size = (size_t)100 << 20;
    char  *bomb = calloc(1, size);
    assert_non_null(bomb);
    const char *path = pack("bomb.json.gz", bomb, size, 0);
    free(bomb);
    assert_int_equal(lmn_scene_add_file(s, path, NULL, &error), LMN_LIMIT);
    lmn_scene_destroy(&s);
}

/* --- what is wrong with files --------------------------------------------------------------------------- */

/* Each beside a good building: the file loads, and what is left out is counted. */
static void test_counted(void **state)
{
    (void)state;
    static const struct {
        const char *object, *what;
        size_t      count;
    } cases[] = {
        {BUILDING(LOD("\"2\"", "[[0,0,0]]")), "degenerate-faces", 1},
        {BUILDING(LOD("\"2\"", "[[0,1]],[[0,1,0]],[[]],[]")), "degenerate-faces", 4},
        {BUILDING(LOD("\"2\"", "[[0,1,1,0]]")), "degenerate-faces", 1},
        {BUILDING(LOD("\"2\"", "[[0,1,99]],[[0,1,-1]],[[0,1,2.5]],[[0,1,1e30]]")), "missing-points", 4},
        {BUILDING(LOD("\"2\"", "[[0,1,4294967296]]")), "missing-points", 1},
        {BUILDING(LOD("\"2\"", "[0,1,2]")), "bad-geometries", 1},
        {BUILDING(LOD("\"2\"", "[[[[0,1,2]]]]")), "bad-geometries", 1},
        {BUILDING(LOD("\"2\"", "[[\"a\"]]")), "bad-geometries", 1},
        {BUILDING("{\"type\":\"Solid\",\"lod\":1}"), "bad-geometries", 1},
        {BUILDING("7"), "bad-geometries", 1},
        {BUILDING("{\"type\":\"Sphere\",\"lod\":1,\"boundaries\":[]}"), "unknown-types", 1},
        {"{\"type\":\"+Noise\",\"geometry\":[" SOLID "]}", "extensions", 1},
        {"{\"type\":\"Building\"}", "objects-without-geometry", 1},
        {"{\"type\":\"BuildingPart\",\"parents\":[\"nobody\"],\"geometry\":[" SOLID "]}", "broken-references", 1},
        {"{\"type\":\"BuildingPart\",\"parents\":[\"x\"],\"geometry\":[" SOLID "]}", "parents", 1},
        {"{\"type\":\"Building\",\"children\":[\"nobody\",5],\"geometry\":[" SOLID "]}", "broken-references", 2},
        {"{\"geometry\":3,\"attributes\":4,\"children\":5,\"parents\":{},\"type\":6}", "objects-without-geometry", 1},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[4000];
        snprintf(text, sizeof text, "%s\"CityObjects\":{\"good\":%s,\"x\":%s},%s}", HEAD, BUILDING(SOLID),
                 cases[i].object, CUBE_VERTICES);
        lmn_scene *s = load_text(text);
        if (skipped(s, cases[i].what) != cases[i].count)
            fail_msg("%s: %s is %zu", cases[i].object, cases[i].what, skipped(s, cases[i].what));
        lmn_scene_destroy(&s);
    }
}

/* A bow tie, and a face that is far from flat. */
static void test_crossing(void **state)
{
    (void)state;
    lmn_scene *s = load_text(MODEL("\"a\":" BUILDING(LOD("\"2\"", "[[0,1,3,2]],[[4,5,6,3]]"))));
    assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "self-crossing-faces") + skipped(s, "degenerate-faces"), 1);
    assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "uneven-faces"), 1);
    lmn_scene_destroy(&s);
}

static void test_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"{\"type\":\"CityJSON\",\"CityObjects\"", "':' is expected"},
        {HEAD "\"CityObjects\":{\"a\":{}", "ends within"},
        {HEAD "\"CityObjects\":{\"a\":]}}", "bracket"},
        {HEAD "\"CityObjects\":{\"a\":\"b}", "does not end"},
        {HEAD "\"CityObjects\":{\"a\":{}} \"vertices\":[]}", "',' or '}'"},
        {HEAD "\"CityObjects\":[]," CUBE_VERTICES "}", "an object is expected"},
        {HEAD "\"CityObjects\":{}," CUBE_VERTICES "} x", "an object"},
        {HEAD "\"CityObjects\":{}," CUBE_VERTICES "} {}", "features"},
        {HEAD "\"CityObjects\":{},\"vertices\":[[1,2]]}", "three coordinates"},
        {HEAD "\"CityObjects\":{},\"vertices\":[[1,2,\"3\"]]}", "a number"},
        {"{\"type\":\"CityJSON\",\"transform\":{\"scale\":[1,1],\"translate\":[0,0,0]},\"CityObjects\":{}}",
         "three numbers"},
        {"{\"type\":\"CityJSON\",\"transform\":{\"scale\":[1e300,1,1]},\"CityObjects\":{}}", "three numbers"},
        {"{\"type\":\"Town\",\"x\":\"CityJSON\",\"CityObjects\":{}}", "\"CityJSON\""},
        {HEAD "\"CityObjects\":{}," CUBE_VERTICES "}", "no objects"},
        {"{\"type\":\"CityJSON\",\"version\":\"9.0\",\"CityObjects\":{}," CUBE_VERTICES "}", "version"},
        {"{\"type\":\"CityJSON\",\"version\":\"1.1\",\"transform\":{\"scale\":[0,0,0],\"translate\":[0,0,0]},"
         "\"CityObjects\":{\"a\":{\"type\":"
         "\"Building\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":\"2\",\"boundaries\":[[[0,1,2,3]]]}]}}"
         "," CUBE_VERTICES "}",
         "scale"},
        {HEAD "\"CityObjects\":{\"a\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"Solid\",\"lod\":\"2\","
              "\"boundaries\":[[[0,1,2,3]]]}]}}," CUBE_VERTICES "}",
         "nested"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        lmn_scene *s;
        lmn_error  error;
        lmn_status status = try_text(cases[i].text, &s, &error);
        if (status != LMN_FORMAT || !strstr(error.message, cases[i].message))
            fail_msg("%s: %d %s", cases[i].text, (int)status, error.message);
        lmn_scene_destroy(&s);
    }
    lmn_scene *s;
    lmn_error  error;
    assert_int_equal(try_text("{\"type\":\"CityJSON\",\n\"CityObjects\":{},\n \"vertices\":[[1,2,x]]}", &s, &error),
                     LMN_FORMAT);
    assert_int_equal(error.line, 3);
    lmn_scene_destroy(&s);
    static char deep[3000];
    size_t      head = (size_t)snprintf(deep, sizeof deep, "{\"type\":\"CityJSON\",\"CityObjects\":{},\"x\":");
    memset(deep + head, '[', 2000);
    assert_int_equal(try_text(deep, &s, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "deep"));
    lmn_scene_destroy(&s);
}

/* A file cut off anywhere is an error or a whole scene, and so it is without memory. */
static void test_cut_off_and_memory(void **state)
{
    (void)state;
    static const char text[] =
        HEAD "\"appearance\":{\"materials\":[{\"name\":\"m\"}]},\"CityObjects\":{\"a\":{\"type\":\"Building\","
             "\"attributes\":{\"k\":\"v\"},"
             "\"geometry\":[" SOLID "]},\"b\":{\"type\":\"BuildingPart\",\"parents\":[\"a\"],\"geometry\":[{\"type\":"
             "\"MultiSurface\",\"lod\":\"2\","
             "\"boundaries\":[[[4,5,6,7]]],\"material\":{\"t\":{\"value\":0}}}]}}," CUBE_VERTICES "}";
    lmn_scene *s;
    lmn_error  error;
    for (size_t size = 1; size < sizeof text - 1; size += 5) {
        char cut[sizeof text];
        memcpy(cut, text, size);
        cut[size] = '\0';
        assert_int_not_equal(try_text(cut, &s, &error), LMN_OK);
        lmn_scene_destroy(&s);
    }
    const char *path = temp_file("city.json", text, sizeof text - 1);
    lmn_status  status = LMN_MEMORY;
    for (long n = 1; status == LMN_MEMORY; n++) {
        assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
        mem_fail_at(n);
        status = lmn_scene_add_file(s, path, NULL, &error);
        mem_fail_at(0);
        lmn_scene_destroy(&s);
    }
    assert_int_equal(status, LMN_OK);
}

/* --- real cities ---------------------------------------------------------------------------------------- */

static void test_data(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        size_t      buildings, triangles, turned;
        double      area; /* of the file's polygons by Newell's formula, worked out elsewhere; 0: not known */
    } cases[] = {{"delft.city.json", 160, 36269, 0, 77526.0884},
                 {"rotterdam_subset.city.json", 16, 622, 0, 10636.2778},
                 {"zurich_subset_lod2.city.json", 49, 5138, 5, 62309.8438},
                 {"nyc-da4.city.json", 16665, 400882, 67692, 0}};
    const char *folder = data_folder();
    for (size_t i = 0; folder && i < COUNT(cases); i++) {
        char path[1200];
        snprintf(path, sizeof path, "%s/city/%s", folder, cases[i].file);
        lmn_scene *s = load_or_fail(path);
        assert_int_equal(city_counted(&s->city, CITY_OBJECTS, "Building"), cases[i].buildings);
        assert_int_equal(lmn_scene_info_of(s).triangles, cases[i].triangles);
        assert_int_equal(city_counted(&s->city, CITY_REPAIRED, "turned-faces"), cases[i].turned);
        double volume, area = measure(s, NULL, &volume);
        if (cases[i].area > 0 && fabs(area / cases[i].area - 1) > 2e-4)
            fail_msg("%s: area %.3f, not %.3f", cases[i].file, area, cases[i].area);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solid),
        cmocka_unit_test(test_facts_of_surfaces),
        cmocka_unit_test(test_turned_faces),
        cmocka_unit_test(test_open_surfaces),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_semantics),
        cmocka_unit_test(test_levels_of_detail),
        cmocka_unit_test(test_templates),
        cmocka_unit_test(test_lines_and_points),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_textures),
        cmocka_unit_test(test_origins),
        cmocka_unit_test(test_degrees),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_sequence),
        cmocka_unit_test(test_packed),
        cmocka_unit_test(test_counted),
        cmocka_unit_test(test_crossing),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_cut_off_and_memory),
        cmocka_unit_test(test_data),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
