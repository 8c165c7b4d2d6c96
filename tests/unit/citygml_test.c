/* CityGML: small cities of which everything is known, and what is wrong with files. */
#include <math.h>

#include "import/city.h"
#include "import_support.h"
#include "stroke/edges.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

#define ROOT                                                                                                           \
    "<?xml version=\"1.0\"?><core:CityModel xmlns:core=\"http://www.opengis.net/citygml/2.0\" xmlns:bldg=\"b\" "       \
    "xmlns:gml=\"g\" xmlns:xlink=\"x\" xmlns:gen=\"n\" xmlns:app=\"a\" xmlns:dem=\"d\" xmlns:veg=\"v\" "               \
    "xmlns:tran=\"t\" xmlns:frn=\"f\" xmlns:con=\"c\">"
#define END          "</core:CityModel>"
#define MEMBER(text) "<core:cityObjectMember>" text "</core:cityObjectMember>"
#define RING(points) "<gml:LinearRing><gml:posList>" points "</gml:posList></gml:LinearRing>"
#define POLYGON(attributes, points)                                                                                    \
    "<gml:surfaceMember><gml:Polygon " attributes                                                                      \
    "><gml:exterior>" RING(points) "</gml:exterior></gml:Polygon></gml:surfaceMember>"
#define BOTTOM "0 0 0 0 1 0 1 1 0 1 0 0 0 0 0"
#define TOP    "0 0 1 1 0 1 1 1 1 0 1 1 0 0 1"
#define SOUTH  "0 0 0 1 0 0 1 0 1 0 0 1 0 0 0"
#define EAST   "1 0 0 1 1 0 1 1 1 1 0 1 1 0 0"
#define NORTH  "1 1 0 0 1 0 0 1 1 1 1 1 1 1 0"
#define WEST   "0 1 0 0 0 0 0 0 1 0 1 1 0 1 0"
#define CUBE                                                                                                           \
    POLYGON("", BOTTOM) POLYGON("", TOP) POLYGON("", SOUTH) POLYGON("", EAST) POLYGON("", NORTH) POLYGON("", WEST)
#define SOLID(lod, members)                                                                                            \
    "<bldg:lod" lod "Solid><gml:Solid><gml:exterior><gml:CompositeSurface>" members                                    \
    "</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod" lod "Solid>"
#define SURFACE(class, lod, members)                                                                                   \
    "<bldg:boundedBy><bldg:" class "><bldg:lod" lod "MultiSurface><gml:MultiSurface>" members                          \
                                   "</gml:MultiSurface></bldg:lod" lod                                                 \
                                   "MultiSurface></bldg:" class "></bldg:boundedBy>"
#define REFERENCE(id) "<gml:surfaceMember xlink:href=\"#" id "\"/>"

static lmn_scene *load_text(const char *text)
{
    return load_or_fail(temp_file("city.gml", text, strlen(text)));
}

static const char *attribute_of(const lmn_scene *s, int32_t node, const char *key)
{
    for (; node != NONE; node = s->nodes[node].parent)
        for (size_t i = 0; i < s->nodes[node].attribute_count; i++)
            if (strcmp(s->nodes[node].attributes[i].key, key) == 0)
                return s->nodes[node].attributes[i].value;
    return "";
}

static double measure(const lmn_scene *s, const char *surface, double *volume)
{
    double area = 0;
    mat4  *worlds = scene_world_matrices(s, NULL);
    *volume = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        int32_t     at = s->parts[i].node;
        const mesh *m = &s->meshes[s->nodes[at].mesh];
        for (size_t k = 0; k < m->primitive_count; k++) {
            const primitive *p = &m->primitives[k];
            if (surface && strcmp(attribute_of(s, at, "surface"), surface) != 0)
                continue;
            for (size_t c = 0; c < p->index_count; c += 3) {
                vec3   a = mat4_transform_point(&worlds[at], p->positions[p->indices[c]]);
                vec3   b = mat4_transform_point(&worlds[at], p->positions[p->indices[c + 1]]);
                vec3   d = mat4_transform_point(&worlds[at], p->positions[p->indices[c + 2]]);
                double u[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[3] = {d.x - a.x, d.y - a.y, d.z - a.z};
                double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
                area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
                *volume += (a.x * n[0] + a.y * n[1] + a.z * n[2]) / 6;
            }
        }
    }
    mem_free(worlds);
    return area;
}

static void expect(const lmn_scene *s, const char *surface, double area)
{
    double volume, found = measure(s, surface, &volume);
    if (fabs(found - area) > 1e-4)
        fail_msg("%s: area %g, not %g", surface ? surface : "all", found, area);
}

static size_t skipped(const lmn_scene *s, const char *what)
{
    return (size_t)city_counted(&s->city, CITY_SKIPPED, what);
}

static void test_solid(void **state)
{
    (void)state;
    lmn_scene *s = load_text(ROOT MEMBER(
        "<bldg:Building gml:id=\"h1\"><gml:name>Town &amp; hall</gml:name><gen:stringAttribute "
        "name=\"owner\"><gen:value>me</gen:value>"
        "</gen:stringAttribute><gen:measureAttribute name=\"depth\"><gen:value "
        "uom=\"ft\">12</gen:value></gen:measureAttribute>"
        "<bldg:function>1000</bldg:function><bldg:measuredHeight uom=\"urn:adv:uom:m\"> 9.25 </bldg:measuredHeight>"
        "<bldg:address><core:Address><x>deep</x></core:Address></bldg:address>" SOLID("1", CUBE) "</bldg:Building>")
                                 END);
    double     volume;
    measure(s, NULL, &volume);
    assert_true(fabs(volume - 1) < 1e-6);
    expect(s, "roof", 1);
    expect(s, "wall", 4);
    assert_string_equal(s->parts[0].path, "city/h1/roof");
    int32_t node = s->parts[0].node;
    assert_string_equal(attribute_of(s, node, "type"), "Building");
    assert_string_equal(attribute_of(s, node, "name"), "Town & hall");
    assert_string_equal(attribute_of(s, node, "owner"), "me");
    assert_string_equal(attribute_of(s, node, "function"), "1000");
    assert_string_equal(attribute_of(s, node, "measuredHeight"), "9.25");
    assert_string_equal(attribute_of(s, node, "measuredHeight.uom"), "");
    assert_string_equal(attribute_of(s, node, "depth.uom"), "ft");
    lmn_scene_destroy(&s);
}

/* A solid that refers to the surfaces that bound it, before and behind them, draws them once. */
static void test_references(void **state)
{
    (void)state;
#define WALLS                                                                                                          \
    POLYGON("gml:id=\"s\"", SOUTH)                                                                                     \
    POLYGON("gml:id=\"e\"", EAST) POLYGON("gml:id=\"n\"", NORTH) POLYGON("gml:id=\"w\"", WEST)
#define BOUNDS                                                                                                         \
    SURFACE("RoofSurface", "2", POLYGON("gml:id=\"t\"", TOP))                                                          \
    SURFACE("GroundSurface", "2", POLYGON("gml:id=\"b\"", BOTTOM)) SURFACE("WallSurface", "2", WALLS)
#define ALL REFERENCE("t") REFERENCE("b") REFERENCE("s") REFERENCE("e") REFERENCE("n") REFERENCE("w")
    static const char *const texts[] = {
        ROOT MEMBER("<bldg:Building gml:id=\"a\">" SOLID("2", ALL) BOUNDS "</bldg:Building>") END,
        ROOT MEMBER("<bldg:Building gml:id=\"a\">" BOUNDS SOLID("2", ALL) "</bldg:Building>") END,
        /* The other way round: the solid has them, and what bounds refers to it. */
        ROOT MEMBER("<bldg:Building gml:id=\"a\">" SOLID("2", POLYGON("gml:id=\"t\"", TOP)
                                                                  POLYGON("gml:id=\"b\"", BOTTOM) WALLS)
                        SURFACE("RoofSurface", "2", REFERENCE("t")) SURFACE("GroundSurface", "2", REFERENCE("b"))
                            SURFACE("WallSurface", "2",
                                    REFERENCE("s") REFERENCE("e") REFERENCE("n") REFERENCE("w")) "</bldg:Building>")
            END,
        /* Both have them. */
        ROOT MEMBER("<bldg:Building gml:id=\"a\">" SOLID("2", CUBE) BOUNDS "</bldg:Building>") END,
    };
    for (size_t i = 0; i < COUNT(texts); i++) {
        lmn_scene *s = load_text(texts[i]);
        double     volume;
        measure(s, NULL, &volume);
        if (fabs(volume - 1) > 1e-6)
            fail_msg("text %zu: volume %g", i, volume);
        expect(s, "roof", 1);
        expect(s, "ground", 1);
        expect(s, "wall", 4);
        lmn_scene_destroy(&s);
    }
    /* What another object has is drawn by both; what nobody has is counted. */
    lmn_scene *s =
        load_text(ROOT MEMBER(
            "<bldg:Building gml:id=\"a\">" SOLID("1", POLYGON("gml:id=\"t\"", TOP) REFERENCE("zz")) "</bldg:Building>")
                      MEMBER("<bldg:Building gml:id=\"b\">" SOLID("1", REFERENCE("t")) "</bldg:Building>") END);
    expect(s, NULL, 2);
    assert_int_equal(skipped(s, "broken-references"), 1);
    lmn_scene_destroy(&s);
}

static void test_levels_and_parts(void **state)
{
    (void)state;
    static const char text[] = ROOT MEMBER("<bldg:Building gml:id=\"a\"><bldg:lod0FootPrint><gml:MultiSurface>" POLYGON(
        "",
        BOTTOM) "</gml:MultiSurface></bldg:lod0FootPrint>"
                "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"p\">" SOLID("1", CUBE) SOLID(
                    "2",
                    POLYGON("", TOP)) "</bldg:BuildingPart>"
                                      "</"
                                      "bldg:consistsOfBuildingPart><bldg:outerBuildingInstallation><bldg:"
                                      "BuildingInstallation gml:id=\"i\"><bldg:lod3Geometry>"
                                      "<gml:MultiSurface>" POLYGON(
                                          "",
                                          WEST) "</gml:MultiSurface></bldg:lod3Geometry></bldg:BuildingInstallation>"
                                                "</bldg:outerBuildingInstallation><bldg:interiorRoom><bldg:Room "
                                                "gml:id=\"r\"><bldg:lod4Solid>" CUBE "</bldg:lod4Solid></bldg:Room>"
                                                "</bldg:interiorRoom></bldg:Building>") END;
    static const struct {
        const char *lod;
        double      area;
    } cases[] = {{NULL, 2}, {"2", 1}, {"1", 6}, {"0", 1}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        lmn_scene    *s = NULL;
        lmn_load_desc desc = LMN_LOAD_DESC_INIT;
        desc.lod = cases[i].lod;
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        assert_int_equal(lmn_scene_add_file(s, temp_file("city.gml", text, sizeof text - 1), &desc, NULL), LMN_OK);
        expect(s, NULL, cases[i].area);
        assert_int_equal(skipped(s, "interiors"), 1);
        if (i == 0)
            assert_string_equal(s->parts[0].path, "city/a/p");
        lmn_scene_destroy(&s);
    }
}

static void test_holes_and_windows(void **state)
{
    (void)state;
#define HOLE "0.2 0 0.2 0.6 0 0.2 0.6 0 0.7 0.2 0 0.7 0.2 0 0.2"
    lmn_scene *s = load_text(ROOT MEMBER(
        "<bldg:Building "
        "gml:id=\"a\"><bldg:boundedBy><bldg:WallSurface><bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember><"
        "gml:Polygon>"
        "<gml:exterior>" RING(
            SOUTH) "</gml:exterior><gml:interior><gml:LinearRing><gml:pos>0.2 0 0.2</gml:pos><gml:pos>0.6 0 "
                   "0.2</gml:pos>"
                   "<gml:pos>0.6 0 0.7</gml:pos><gml:pos>0.2 0 0.7</gml:pos><gml:pos>0.2 0 "
                   "0.2</gml:pos></gml:LinearRing></gml:interior></gml:Polygon>"
                   "</gml:surfaceMember></gml:MultiSurface></"
                   "bldg:lod3MultiSurface><bldg:opening><bldg:Window><bldg:lod3MultiSurface><gml:MultiSurface>" POLYGON(
                       "", HOLE) "</gml:MultiSurface></bldg:lod3MultiSurface></bldg:Window></bldg:opening></"
                                 "bldg:WallSurface></bldg:boundedBy>"
                                 "</bldg:Building>") END);
    expect(s, "window", 0.2);
    expect(s, "wall", 0.8);
    lmn_scene_destroy(&s);
}

static void test_other_objects(void **state)
{
    (void)state;
    lmn_scene *s = load_text(ROOT MEMBER(
        "<tran:Road gml:id=\"r\"><tran:trafficArea><tran:TrafficArea><tran:lod2MultiSurface><gml:MultiSurface>" POLYGON(
            "", BOTTOM) "</gml:MultiSurface></tran:lod2MultiSurface></tran:TrafficArea></tran:trafficArea></tran:Road>")
                                 MEMBER(
                                     "<dem:ReliefFeature><dem:lod>1</dem:lod><dem:reliefComponent><dem:TINRelief "
                                     "gml:id=\"d\"><dem:tin><gml:TriangulatedSurface>"
                                     "<gml:trianglePatches><gml:Triangle><gml:exterior>" RING(
                                         "0 0 0 2 0 0 0 2 0 0 0 0") "</gml:exterior></gml:Triangle>"
                                                                    "</gml:trianglePatches></gml:TriangulatedSurface></"
                                                                    "dem:tin></dem:TINRelief></dem:reliefComponent></"
                                                                    "dem:ReliefFeature>") END);
    expect(s, "road", 1);
    expect(s, "terrain", 2);
    lmn_scene_destroy(&s);
}

/* A ridge of ground that turns by a right angle has no crease, and one normal along it. */
static void test_ground_is_smooth(void **state)
{
    (void)state;
#define FACE(corners) "<gml:Triangle><gml:exterior>" RING(corners) "</gml:exterior></gml:Triangle>"
    lmn_scene *s = load_text(ROOT MEMBER(
        "<dem:ReliefFeature><dem:lod>1</dem:lod><dem:reliefComponent><dem:TINRelief gml:id=\"d\"><dem:tin>"
        "<gml:TriangulatedSurface><gml:trianglePatches>" FACE("0 0 1 4 0 1 2 -1 0 0 0 1")
            FACE("0 0 1 2 1 0 4 0 1 0 0 1") "</gml:trianglePatches></gml:TriangulatedSurface></dem:tin></dem:TINRelief>"
                                            "</dem:reliefComponent></dem:ReliefFeature>") END);
    edge_mesh  edges;
    lmn_error  error = {0};
    assert_int_equal(s->mesh_count, 1);
    const primitive *p = &s->meshes[0].primitives[0];
    assert_int_equal(p->index_count, 6);
    assert_non_null(p->normals);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (fabs((double)p->positions[i].y) < 1e-6)
            assert_true((double)p->normals[i].z > 0.999);
    assert_int_equal(edge_mesh_create(&edges, &s->meshes[0], NULL, 0.5, &error), LMN_OK);
    int creases = 0, borders = 0;
    for (uint32_t i = 0; i < edges.edge_count; i++) {
        creases += (edges.edges[i].flags & EDGE_CREASE) != 0;
        borders += (edges.edges[i].flags & EDGE_BORDER) != 0;
    }
    assert_int_equal(creases, 0);
    assert_int_equal(borders, 4);
    edge_mesh_release(&edges);
    lmn_scene_destroy(&s);
#undef FACE
}

/* Two trees of one shape: the first brings it, the second refers to it. */
static void test_implicit_geometry(void **state)
{
    (void)state;
#define TREE(id, matrix, shape, at)                                                                                    \
    MEMBER("<veg:SolitaryVegetationObject gml:id=\"" id "\"><veg:lod2ImplicitRepresentation><core:ImplicitGeometry>"   \
           "<core:transformationMatrix>" matrix "</core:transformationMatrix>" shape                                   \
           "<core:referencePoint><gml:Point><gml:pos>" at                                                              \
           "</gml:pos></gml:Point></core:referencePoint></core:ImplicitGeometry></veg:lod2ImplicitRepresentation></"   \
           "veg:SolitaryVegetationObject>")
    lmn_scene *s =
        load_text(ROOT TREE("one", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1",
                            "<core:relativeGMLGeometry><gml:MultiSurface gml:id=\"shape\">" POLYGON(
                                "", TOP) "</gml:MultiSurface></core:relativeGMLGeometry>",
                            "5000000 100 7") TREE("two", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                                                  "<core:relativeGMLGeometry xlink:href=\"#shape\"/>", "5000010 100 7")
                      TREE("bad", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                           "<core:relativeGMLGeometry xlink:href=\"#nothing\"/>", "5000010 100 7") END);
    assert_int_equal(s->part_count, 2);
    assert_int_equal(s->mesh_count, 1);
    expect(s, "plant", 5);
    assert_true(fabs((double)s->parts[1].bounds.min.x - (double)s->parts[0].bounds.min.x - 10) < 1e-5);
    assert_true(fabs((double)s->parts[0].bounds.max.z - 9) < 1e-5);
    assert_int_equal(skipped(s, "broken-references"), 1);
    lmn_scene_destroy(&s);
}

static void test_appearance(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        ROOT
        "<app:appearanceMember><app:Appearance><app:surfaceDataMember><app:X3DMaterial><app:diffuseColor>1 0 "
        "0</app:diffuseColor>"
        "<app:transparency>0.5</app:transparency><app:target>#t</app:target><app:target>#none</app:target></"
        "app:X3DMaterial>"
        "</app:surfaceDataMember><app:surfaceDataMember><app:ParameterizedTexture><app:imageURI>gone.jpg</app:imageURI>"
        "<app:target uri=\"#b\"><app:TexCoordList><app:textureCoordinates ring=\"#br\">0 0 1 0 1 1 0 1 0 "
        "0</app:textureCoordinates>"
        "</app:TexCoordList></app:target></app:ParameterizedTexture></app:surfaceDataMember></app:Appearance></"
        "app:appearanceMember>" MEMBER("<bldg:Building gml:id=\"a\">" SOLID(
            "2", POLYGON("gml:id=\"t\"", TOP) POLYGON("gml:id=\"b\"", BOTTOM)) "</bldg:Building>") END);
    size_t red = 0;
    for (size_t i = 0; i < s->mesh_count; i++) {
        const material *m = &s->materials[s->meshes[i].primitives[0].material];
        red += m->alpha == ALPHA_BLEND && m->base_colour.x > 0.99f && m->base_colour.y < 0.01f;
    }
    assert_int_equal(red, 1);
    lmn_scene_destroy(&s);
}

/* PLATEAU's files are in degrees, latitude first. */
static void test_degrees(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        ROOT "<gml:boundedBy><gml:Envelope srsName=\"http://www.opengis.net/def/crs/EPSG/0/6697\" "
             "srsDimension=\"3\"/></gml:boundedBy>" MEMBER("<bldg:Building gml:id=\"a\">" SOLID(
                 "1", POLYGON("", "35 139 0 35.001 139 0 35.001 139.001 0 35 139.001 0 35 139 0")) "</bldg:Building>")
                 END);
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(s->city.geographic);
    assert_true(fabs(info.bounds_max[0] - info.bounds_min[0] - 92.404) < 0.01);
    assert_true(fabs(info.bounds_max[1] - info.bounds_min[1] - 111.861) < 0.01);
    lmn_scene_destroy(&s);
}

/* What version 3.0 says otherwise. */
static void test_version_3(void **state)
{
    (void)state;
    lmn_scene *s = load_text(ROOT MEMBER(
        "<bldg:Building "
        "gml:id=\"a\"><core:genericAttribute><gen:StringAttribute><gen:name>owner</gen:name><gen:value>me</gen:value>"
        "</gen:StringAttribute></"
        "core:genericAttribute><core:boundary><con:RoofSurface><core:lod2MultiSurface><gml:MultiSurface>" POLYGON(
            "", TOP) "</gml:MultiSurface></core:lod2MultiSurface></con:RoofSurface></"
                     "core:boundary><core:boundary><con:WallSurface>"
                     "<con:fillingSurface><con:WindowSurface><core:lod2MultiSurface><gml:MultiSurface>" POLYGON(
                         "", SOUTH) "</gml:MultiSurface></core:lod2MultiSurface></con:WindowSurface></"
                                    "con:fillingSurface></con:WallSurface></core:boundary>"
                                    "<con:dateOfConstruction>1898-05-02</con:dateOfConstruction></bldg:Building>") END);
    expect(s, "roof", 1);
    expect(s, "window", 1);
    assert_string_equal(attribute_of(s, s->parts[0].node, "owner"), "me");
    assert_string_equal(attribute_of(s, s->parts[0].node, "dateOfConstruction"), "1898-05-02");
    lmn_scene_destroy(&s);
}

/* --- what is wrong with files --------------------------------------------------------------------------- */

static void test_counted(void **state)
{
    (void)state;
    static const struct {
        const char *points, *what;
    } cases[] = {
        {"0 0 0 1 0 0 2 0 0", "degenerate-faces"},
        {"0 0 0 1 0 0", "degenerate-faces"},
        {"", "degenerate-faces"},
        {"0 0 0 1 0 0 1 x 0", "missing-points"},
        {"0 0 0 1 0 0 1 nan 0", "missing-points"},
        {"0 0 0 1 0 0 1 1e999 0", "missing-points"},
        {"0 0 0 0 0 0 0 0 0", "degenerate-faces"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[6000];
        snprintf(text, sizeof text, "%s%s%s%s%s%s", ROOT,
                 "<core:cityObjectMember><bldg:Building gml:id=\"a\">" SOLID(
                     "1", CUBE) "</bldg:Building></core:cityObjectMember>",
                 "<bldg:Building gml:id=\"b\"><bldg:lod1Solid><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>",
                 cases[i].points,
                 "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></bldg:lod1Solid></bldg:Building>", END);
        lmn_scene *s = load_text(text);
        if (skipped(s, cases[i].what) != 1)
            fail_msg("'%s': %s is %zu", cases[i].points, cases[i].what, skipped(s, cases[i].what));
        expect(s, NULL, 6);
        lmn_scene_destroy(&s);
    }
}

static lmn_status try_bytes(const char *bytes, size_t size, lmn_error *error)
{
    lmn_scene *s = NULL;
    *error = (lmn_error){0};
    assert_int_equal(lmn_scene_create(&s, error), LMN_OK);
    lmn_status status = lmn_scene_add_file(s, temp_file("city.gml", bytes, size), NULL, error);
    lmn_scene_destroy(&s);
    return status;
}

static void test_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        ROOT "<a></b>" END,
        ROOT "<a>",
        ROOT END,
        /* Billions of laughs, and a file of the system. */
        "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;\"><!ENTITY c \"&b;&b;&b;&b;&b;\">]>"
        "<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/2.0\"><x>&c;</x></core:CityModel>",
        "<!DOCTYPE x [<!ENTITY a SYSTEM \"file:///etc/passwd\">]><core:CityModel "
        "xmlns:core=\"citygml\"><x>&a;</x></core:CityModel>",
    };
    lmn_error error;
    for (size_t i = 0; i < COUNT(texts); i++)
        if (try_bytes(texts[i], strlen(texts[i]), &error) != LMN_FORMAT)
            fail_msg("text %zu: %s", i, error.message);
    static char deep[8000];
    size_t      size = (size_t)snprintf(deep, sizeof deep, "%s", ROOT);
    for (int i = 0; i < 1000; i++)
        size += (size_t)snprintf(deep + size, sizeof deep - size, "<a>");
    assert_int_not_equal(try_bytes(deep, size, &error), LMN_OK);
}

/* Twenty million bytes in one list of numbers, on one line. */
static void test_long_line(void **state)
{
    (void)state;
    static const char begin[] = ROOT
        "<bldg:Building gml:id=\"a\">" SOLID("1", CUBE) "</bldg:Building><bldg:Building gml:id=\"b\"><bldg:lod1Solid>"
                                                        "<gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>";
    static const char end[] =
        "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></bldg:lod1Solid></bldg:Building>" END;
    size_t room = ((size_t)20 << 20) + sizeof begin + sizeof end, size = sizeof begin - 1;
    char  *text = malloc(room);
    assert_non_null(text);
    memcpy(text, begin, size);
    while (size + sizeof end + 16 < room)
        size += (size_t)snprintf(text + size, room - size, "%zu 7 0 ", size % 1000);
    memcpy(text + size, end, sizeof end - 1);
    lmn_scene *s = load_or_fail(temp_file("city.gml", text, size + sizeof end - 1));
    expect(s, NULL, 6);
    assert_int_equal(skipped(s, "degenerate-faces"), 1);
    lmn_scene_destroy(&s);
    free(text);
}

/* A few bytes that refer to much again and again. */
static void test_amplified(void **state)
{
    (void)state;
    size_t room = (size_t)8 << 20, size = 0;
    char  *text = malloc(room);
    assert_non_null(text);
    size += (size_t)snprintf(text, room,
                             "%s<bldg:Building gml:id=\"a\"><bldg:lod1Solid><gml:Polygon "
                             "gml:id=\"p\"><gml:exterior><gml:LinearRing><gml:posList>",
                             ROOT);
    for (int i = 0; i < 20000; i++)
        size += (size_t)snprintf(text + size, room - size, "%d %d 0 ", i, i % 2);
    size +=
        (size_t)snprintf(text + size, room - size,
                         "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></bldg:lod1Solid></bldg:Building>"
                         "<bldg:Building gml:id=\"b\"><bldg:lod1Solid>");
    for (int i = 0; i < 50000; i++)
        size += (size_t)snprintf(text + size, room - size, "<gml:surfaceMember xlink:href=\"#p\"/>");
    size += (size_t)snprintf(text + size, room - size, "</bldg:lod1Solid></bldg:Building>%s", END);
    lmn_error error;
    assert_int_equal(try_bytes(text, size, &error), LMN_LIMIT);
    free(text);
}

static void test_cut_off_and_memory(void **state)
{
    (void)state;
    static const char text[] = ROOT MEMBER("<bldg:Building gml:id=\"a\"><bldg:function>7</bldg:function>" SOLID(
        "2", REFERENCE("t")) SURFACE("RoofSurface", "2", POLYGON("gml:id=\"t\"", TOP)) "</bldg:Building>") END;
    lmn_error                       error;
    for (size_t size = 200; size < sizeof text - 1; size += 3)
        assert_int_not_equal(try_bytes(text, size, &error), LMN_OK);
    const char *path = temp_file("city.gml", text, sizeof text - 1);
    lmn_status  status = LMN_MEMORY;
    for (long n = 1; status == LMN_MEMORY; n++) {
        lmn_scene *s = NULL;
        assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
        mem_fail_at(n);
        status = lmn_scene_add_file(s, path, NULL, &error);
        mem_fail_at(0);
        lmn_scene_destroy(&s);
    }
    assert_int_equal(status, LMN_OK);
}

static void test_data(void **state)
{
    (void)state;
    static const struct {
        const char *file, *type;
        size_t      objects, triangles, images;
    } cases[] = {{"LoD2_32_280_5657_1_NW.gml", "Building", 83, 2675, 0},
                 {"plateau-yokosuka/52397519_bldg_6697_op.gml", "Building", 13, 1296, 3},
                 {"plateau-yokosuka/523965_dem_6697_05_op.gml", "TINRelief", 2, 1064, 0}};
    const char *folder = data_folder();
    for (size_t i = 0; folder && i < COUNT(cases); i++) {
        char path[1200];
        snprintf(path, sizeof path, "%s/city/%s", folder, cases[i].file);
        lmn_scene *s = load_or_fail(path);
        assert_int_equal(city_counted(&s->city, CITY_OBJECTS, cases[i].type), cases[i].objects);
        assert_int_equal(lmn_scene_info_of(s).triangles, cases[i].triangles);
        assert_int_equal(s->image_count, cases[i].images);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solid),
        cmocka_unit_test(test_references),
        cmocka_unit_test(test_levels_and_parts),
        cmocka_unit_test(test_holes_and_windows),
        cmocka_unit_test(test_other_objects),
        cmocka_unit_test(test_ground_is_smooth),
        cmocka_unit_test(test_implicit_geometry),
        cmocka_unit_test(test_appearance),
        cmocka_unit_test(test_degrees),
        cmocka_unit_test(test_version_3),
        cmocka_unit_test(test_counted),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_long_line),
        cmocka_unit_test(test_amplified),
        cmocka_unit_test(test_cut_off_and_memory),
        cmocka_unit_test(test_data),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
