/* A small house written by hand: names, storeys, colours and units as the file says them, walls that are closed bodies
 * with their openings taken out, and what cannot be read told. */
#include "import_support.h"

#include <math.h>

#include "base/colour.h"
#include "import/ifc_text.h"
#include "import/stitch.h"
#include "plan/unit.h"

#define HOUSE LIMNER_SOURCE_DIR "/tests/data/ifc/house.ifc"

static size_t find_part(const lmn_scene *s, const char *path)
{
    for (size_t i = 0; i < s->part_count; i++)
        if (strcmp(s->parts[i].path, path) == 0)
            return i;
    fail_msg("no part %s", path);
    return 0;
}

static const mesh *mesh_at(const lmn_scene *s, size_t part)
{
    return &s->meshes[s->nodes[s->parts[part].node].mesh];
}

/* In the unit that the mesh is in. */
static double volume_of(const mesh *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; k + 2 < p->index_count; k += 3) {
            const vec3 a = p->positions[p->indices[k]], b = p->positions[p->indices[k + 1]],
                       c = p->positions[p->indices[k + 2]];
            sum += ((double)a.x * ((double)b.y * (double)c.z - (double)b.z * (double)c.y) +
                    (double)a.y * ((double)b.z * (double)c.x - (double)b.x * (double)c.z) +
                    (double)a.z * ((double)b.x * (double)c.y - (double)b.y * (double)c.x)) /
                   6;
        }
    }
    return sum;
}

static size_t borders_of(const mesh *m)
{
    size_t count = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        uint32_t *beside = mesh_adjacency(&m->primitives[i]);
        for (uint32_t k = 0; k < m->primitives[i].index_count; k++)
            count += beside[k] == UINT32_MAX;
        mem_free(beside);
    }
    return count;
}

static void parts_are_products_by_storey(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(HOUSE);
    assert_int_equal(s->part_count, 4); /* neither the room nor the opening */
    find_part(s, "house/Building/Ground floor/Floor slab");
    find_part(s, "house/Building/Ground floor/South wall");
    find_part(s, "house/Building/Ground floor/N\xC3\xB6rdliche Wand, aussen");
    const node *n = &s->nodes[s->parts[find_part(s, "house/Building/First floor/Column")].node];
    assert_int_equal(n->attribute_count, 2);
    assert_string_equal(n->attributes[0].key, "ifc-class");
    assert_string_equal(n->attributes[0].value, "IfcColumn");
    assert_string_equal(n->attributes[1].key, "ifc-guid");
    assert_int_equal(strlen(n->attributes[1].value), IFC_GUID);
    lmn_scene_destroy(&s);
}

static void lengths_are_metres_and_z_is_up(void **state)
{
    (void)state;
    file_data f = {0};
    assert_int_equal(file_load(&f, HOUSE, NULL), LMN_OK);
    char *text = malloc(f.size + 1), *at;
    memcpy(text, f.data, f.size);
    text[f.size] = '\0';
    assert_non_null(at = strstr(text, ".MILLI."));
    for (int i = 0; i < 2; i++) {
        lmn_scene  *s = load_or_fail(temp_file("unit.ifc", text, f.size));
        const box3  b = s->parts[find_part(s, "unit/Building/First floor/Column")].bounds;
        const float times = i ? 10 : 1, low[3] = {0.8f, 0.8f, 3}, high[3] = {1.2f, 1.2f, 5.5f};
        double      mm;
        const char *unit_name;
        bool        stated;
        assert_int_equal(s->up, 'z');
        for (int k = 0; k < 3; k++) {
            /* The column stands with its corner at 1, 1. */
            float from = k < 2 ? 1 : low[k], to = k < 2 ? 1.4f : high[k];
            assert_true(fabsf((&b.min.x)[k] - times * from) < 1e-4f * times);
            assert_true(fabsf((&b.max.x)[k] - times * to) < 1e-4f * times);
        }
        assert_int_equal(unit_find(NULL, s, &mm, &unit_name, &stated, NULL), LMN_OK);
        assert_true(stated && mm == 1000);
        lmn_scene_destroy(&s);
        memcpy(at, ".CENTI.", 7);
    }
    free(text);
    file_data_release(&f);
}

/* 6 by 0.3 by 2.8 m without 1.5 by 0.3 by 1.2; closed, so that it can be cut and hatched, and without lines across. */
static void walls_are_bodies_without_their_openings(void **state)
{
    (void)state;
    lmn_scene   *s = load_or_fail(HOUSE);
    const mesh  *wall = mesh_at(s, find_part(s, "house/Building/Ground floor/South wall"));
    const double mm3 = 1e9;
    assert_true(fabs(volume_of(wall) - (6 * 0.3 * 2.8 - 1.5 * 0.3 * 1.2) * mm3) < 1e-5 * mm3);
    assert_int_equal(borders_of(wall), 0);
    const mesh *plain = mesh_at(s, find_part(s, "house/Building/Ground floor/Floor slab"));
    assert_true(fabs(volume_of(plain) - 6 * 4 * 0.2 * mm3) < 1e-5 * mm3);
    assert_int_equal(plain->primitives[0].index_count, 36);
    lmn_scene_destroy(&s);
}

static void products_have_their_colours(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(HOUSE);
    const vec4
        wall = s->materials[mesh_at(s, find_part(s, "house/Building/Ground floor/South wall"))->primitives[0].material]
                   .base_colour,
        column = s->materials[mesh_at(s, find_part(s, "house/Building/First floor/Column"))->primitives[0].material]
                     .base_colour;
    assert_true(fabsf(wall.x - colour_to_linear(0.8f)) < 2e-3f && fabsf(wall.z - colour_to_linear(0.2f)) < 2e-3f);
    assert_true(fabsf(column.x - colour_to_linear(0.2f)) < 2e-3f && fabsf(column.z - colour_to_linear(0.8f)) < 2e-3f);
    lmn_scene_destroy(&s);
}

/* The ball is a sphere, which the library does not make. */
static void what_cannot_be_read_is_told(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(HOUSE);
    bool       told = false;
    for (size_t i = 0; i < s->warnings.count; i++)
        told =
            told || strstr(s->warnings.items[i].text, "1 of 5 things have shapes that cannot be read and are missing, "
                                                      "the first: #136, IFCBUILDINGELEMENTPROXY 'Ball'");
    assert_true(told);
    lmn_scene_destroy(&s);
}

static void headers_are_attributes(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(HOUSE);
    int        seen = 0;
    for (size_t i = 0; i < s->node_count; i++)
        for (uint32_t k = 0; k < s->nodes[i].attribute_count; k++) {
            const attribute *a = &s->nodes[i].attributes[k];
            seen += strcmp(a->key, "file-author") == 0 && strcmp(a->value, "A. Writer") == 0;
            seen += strcmp(a->key, "file-organisation") == 0 && strcmp(a->value, "Works") == 0;
            seen += strcmp(a->key, "file-date") == 0 && strcmp(a->value, "2026-11-01T00:00:00") == 0;
        }
    assert_int_equal(seen, 3);
    lmn_scene_destroy(&s);
}

static void words_are_those_of_the_file(void **state)
{
    (void)state;
    const char *text =
        "ISO-10303-21;HEADER;FILE_NAME('it''s (a) \\X\\E4\\S\\d','t',('w','x'),('o'),'','','');/* #9=IFCWALL('"
        "0123456789012345678901',$,'no',$,$,$,#1,$); */ENDSEC;DATA;\n"
        "#1=IFCPRODUCTDEFINITIONSHAPE($,$,(#7));\n#22= IFCWALL ( '0123456789012345678901' , #2 , 'a;b(c)' "
        ",$,$,#3,#1,$);"
        "#3=IFCSPACE('1123456789012345678901',#2,$,$,$,#3,#1,$);\n#4=IFCSLAB('2123456789012345678901',#2,"
        "'\\X2\\03B103B2\\X0\\\\X4\\0001F600\\X0\\',$,$,#3,$,$);\n#5=IFCWALL('cut off";
    ifc_text t;
    assert_int_equal(ifc_text_read(&t, text, strlen(text), NULL), LMN_OK);
    assert_int_equal(t.count, 3);
    assert_string_equal(t.facts[0], "it's (a) \xC3\xA4\xC3\xA4");
    assert_string_equal(t.facts[1], "w");
    assert_string_equal(t.facts[2], "o");
    assert_string_equal(t.facts[3], "t");
    const ifc_thing *wall = ifc_text_find(&t, "IfcWall_x_0123456789012345678901"),
                    *room = ifc_text_find(&t, "1123456789012345678901"),
                    *slab = ifc_text_find(&t, "2123456789012345678901");
    assert_string_equal(wall->name, "a;b(c)");
    assert_int_equal(wall->number, 22);
    assert_true(wall->shaped && !room->shaped && !slab->shaped && !room->name);
    assert_string_equal(slab->name, "\xCE\xB1\xCE\xB2\xF0\x9F\x98\x80");
    assert_null(ifc_text_find(&t, "IfcWall_3123456789012345678901"));
    assert_null(ifc_text_find(&t, "short"));
    ifc_text_release(&t);
    for (size_t size = 0; size < strlen(text); size++) {
        char *cut = malloc(size + 1); /* so that reading behind it is seen */
        memcpy(cut, text, size);
        assert_int_equal(ifc_text_read(&t, cut, size, NULL), LMN_OK);
        ifc_text_release(&t);
        free(cut);
    }
}

static primitive sheet_of(const vec3 *positions, uint32_t vertices, const uint32_t *indices, uint32_t count)
{
    primitive p = {.vertex_count = vertices, .index_count = count};
    p.positions = mem_copy(positions, vertices * sizeof *positions);
    p.indices = mem_copy(indices, count * sizeof *indices);
    return p;
}

/* Two small squares beside a large one: their common corner lies in its edge. */
static void corners_in_edges_are_joined(void **state)
{
    (void)state;
    const vec3     at[] = {{0, 0, 0},          {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 1, 0},
                           {1, 1.0000001f, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}};
    const uint32_t faces[] = {0, 1, 2, 0, 2, 3, 4, 5, 8, 4, 8, 7, 5, 6, 9, 5, 9, 8};
    primitive      p = sheet_of(at, 10, faces, 18);
    mesh           m = {.primitives = &p, .primitive_count = 1};
    assert_int_equal(borders_of(&m), 2 + 2 + 6);
    assert_true(stitch(&p, 1e-5));
    assert_int_equal(p.index_count, 21);
    assert_int_equal(borders_of(&m), 1 + 2 + 4 + 0);
    assert_true(stitch_holes(&p, 1e-5));
    assert_int_equal(p.index_count, 21);
    primitive_release(&p);
}

/* A box without a third of its lid gets it back; one without all of it stays open, and so does a hole in a sheet. */
static void missing_pieces_of_faces_are_filled(void **state)
{
    (void)state;
    const vec3     at[] = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}, {0, 0, 1},
                           {1, 0, 1}, {3, 0, 1}, {3, 1, 1}, {1, 1, 1}, {0, 1, 1}};
    const uint32_t open[] = {0,
                             2,
                             1,
                             0,
                             3,
                             2,
                             0,
                             1,
                             6,
                             0,
                             6,
                             5,
                             0,
                             5,
                             4,
                             1,
                             2,
                             7,
                             1,
                             7,
                             6,
                             2,
                             3,
                             9,
                             2,
                             9,
                             8,
                             2,
                             8,
                             7,
                             3,
                             0,
                             4,
                             3,
                             4,
                             9,
                             /* of the lid: */ 4,
                             5,
                             8,
                             4,
                             8,
                             9};
    primitive      p = sheet_of(at, 10, open, 42);
    mesh           m = {.primitives = &p, .primitive_count = 1};
    assert_int_equal(borders_of(&m), 4);
    assert_true(stitch(&p, 1e-6) && stitch_holes(&p, 1e-6));
    assert_int_equal(borders_of(&m), 0);
    assert_true(fabs(volume_of(&m) - 3) < 1e-6);
    primitive_release(&p);
    p = sheet_of(at, 10, open, 36);
    assert_true(stitch(&p, 1e-6) && stitch_holes(&p, 1e-6));
    assert_int_equal(borders_of(&m), 6);
    primitive_release(&p);
    const vec3     ring[] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
    const uint32_t around[] = {0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    p = sheet_of(ring, 8, around, 24);
    assert_true(stitch(&p, 1e-6) && stitch_holes(&p, 1e-6));
    assert_int_equal(borders_of(&m), 8);
    primitive_release(&p);
}

static void damaged_files_are_errors(void **state)
{
    (void)state;
    file_data f = {0};
    lmn_error error;
    int       refused = 0;
    assert_int_equal(file_load(&f, HOUSE, NULL), LMN_OK);
    for (int i = 0; i < 6; i++) {
        lmn_status status = load_status(temp_file("cut.ifc", f.data, f.size * (size_t)i / 6), &error);
        assert_true(status == LMN_OK || status == LMN_FORMAT || status == LMN_LIMIT);
        refused += status != LMN_OK;
    }
    assert_true(refused >= 2);
    unsigned char *copy = malloc(f.size);
    uint32_t       seed = 5;
    for (int i = 0; i < 30; i++) {
        memcpy(copy, f.data, f.size);
        for (int k = 0; k < 6; k++) {
            seed = seed * 1664525u + 1013904223u;
            copy[300 + seed % (f.size - 300)] = (unsigned char)("0123456789,;.()#$'"[(seed >> 8) % 18]);
        }
        lmn_status status = load_status(temp_file("overwritten.ifc", copy, f.size), &error);
        assert_true(status == LMN_OK || status == LMN_FORMAT || status == LMN_LIMIT);
    }
    free(copy);
    file_data_release(&f);
    const char *step = "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\n";
    file_data   other = {.data = (unsigned char *)step, .size = strlen(step)};
    assert_false(import_ifc.recognises(&other));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(parts_are_products_by_storey),
                                       cmocka_unit_test(lengths_are_metres_and_z_is_up),
                                       cmocka_unit_test(walls_are_bodies_without_their_openings),
                                       cmocka_unit_test(products_have_their_colours),
                                       cmocka_unit_test(what_cannot_be_read_is_told),
                                       cmocka_unit_test(headers_are_attributes),
                                       cmocka_unit_test(words_are_those_of_the_file),
                                       cmocka_unit_test(corners_in_edges_are_joined),
                                       cmocka_unit_test(missing_pieces_of_faces_are_filled),
                                       cmocka_unit_test(damaged_files_are_errors)};
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
