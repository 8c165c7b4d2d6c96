/* 3MF, packed by hand: units and names. */
#include <math.h>

#include "import/threemf.h"
#include "import_support.h"

enum { PACKAGE_MOST = 1 << 14 };

typedef struct package {
    unsigned char bytes[PACKAGE_MOST];
    size_t        size, entries;
    unsigned char list[1024]; /* the directory at its end */
    size_t        list_size;
} package;

static void put_u16(unsigned char *at, size_t value)
{
    at[0] = (unsigned char)value;
    at[1] = (unsigned char)(value >> 8);
}

static uint32_t crc_of(const char *text, size_t size)
{
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i < size; i++) {
        crc ^= (unsigned char)text[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0);
    }
    return ~crc;
}

/* The fields that an entry has in both of its places, from the version that is needed on. */
static void put_fields(unsigned char *at, const char *name, const char *text, bool packed)
{
    size_t size = strlen(text);
    memset(at, 0, 26);
    put_u16(at, 20);
    put_u16(at + 4, packed ? 8 : 0);
    put_u32(at + 10, crc_of(text, size));
    put_u32(at + 14, (uint32_t)(size + (packed ? 5 : 0)));
    put_u32(at + 18, (uint32_t)size);
    put_u16(at + 22, strlen(name));
}

/* Packed: by DEFLATE, as one block that is stored. */
static void add(package *p, const char *name, const char *text, bool packed)
{
    size_t         size = strlen(text), length = strlen(name), from = p->size;
    unsigned char *at = p->bytes + from, *entry = p->list + p->list_size;
    assert_true(from + 64 + length + size < PACKAGE_MOST && size < 65536 &&
                p->list_size + 46 + length < sizeof p->list);
    memcpy(at, "PK\3\4", 4);
    put_fields(at + 4, name, text, packed);
    memcpy(at + 30, name, length);
    at += 30 + length;
    if (packed) {
        *at = 1;
        put_u16(at + 1, size);
        put_u16(at + 3, ~size);
        at += 5;
    }
    memcpy(at, text, size);
    p->size = (size_t)(at - p->bytes) + size;
    memset(entry, 0, 46);
    memcpy(entry, "PK\1\2", 4);
    put_u16(entry + 4, 20);
    put_fields(entry + 6, name, text, packed);
    put_u32(entry + 42, (uint32_t)from);
    memcpy(entry + 46, name, length);
    p->list_size += 46 + length;
    p->entries++;
}

static void end_package(package *p)
{
    unsigned char *at = p->bytes + p->size;
    memcpy(at, p->list, p->list_size);
    at += p->list_size;
    memset(at, 0, 22);
    memcpy(at, "PK\5\6", 4);
    put_u16(at + 8, p->entries);
    put_u16(at + 10, p->entries);
    put_u32(at + 12, (uint32_t)p->list_size);
    put_u32(at + 16, (uint32_t)p->size);
    p->size += p->list_size + 22;
}

#define TETRA                                                                                                          \
    "<mesh><vertices><vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='2' z='0'/>"                \
    "<vertex x='0' y='0' z='3'/></vertices><triangles><triangle v1='0' v2='2' v3='1'/>"                                \
    "<triangle v1='0' v2='1' v3='3'/><triangle v1='1' v2='2' v3='3'/><triangle v1='2' v2='0' "                         \
    "v3='3'/></triangles></mesh>"

/* `unit`: attributes of the model; `objects`: what stands in the resources. */
static const package *pack(const char *unit, const char *objects, const char *items, bool packed)
{
    static package p;
    char           model[8192];
    p = (package){.size = 0};
    add(&p, "[Content_Types].xml",
        "<?xml version='1.0'?><Types xmlns='http://schemas.openxmlformats.org/package/2006/content-types'><Default "
        "Extension='model' ContentType='application/vnd.ms-package.3dmanufacturing-3dmodel+xml'/></Types>",
        packed);
    add(&p, "_rels/.rels",
        "<?xml version='1.0'?><Relationships xmlns='http://schemas.openxmlformats.org/package/2006/relationships'>"
        "<Relationship Target='/3D/3dmodel.model' Id='rel0' "
        "Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/></Relationships>",
        packed);
    snprintf(model, sizeof model,
             "<?xml version='1.0' encoding='UTF-8'?>\n<model %s "
             "xmlns='http://schemas.microsoft.com/3dmanufacturing/core/2015/02'><resources>%s</resources><build>%s"
             "</build></model>",
             unit, objects, items);
    add(&p, "3D/3dmodel.model", model, packed);
    end_package(&p);
    return &p;
}

static lmn_scene *load_package(const char *unit, const char *objects, const char *items, bool packed)
{
    const package *p = pack(unit, objects, items, packed);
    return load_or_fail(temp_file("thing.3mf", p->bytes, p->size));
}

static void units_are_obeyed(void **state)
{
    static const struct {
        const char *unit;
        double      mm;
        bool        warned;
    } rows[] = {{"unit='inch'", 25.4, false},     {"unit='micron'", 1e-3, false},
                {"unit='millimeter'", 1, false},  {"", 1, false},
                {"unit='centimeter'", 10, false}, {"unit='foot'", 304.8, false},
                {"unit='meter'", 1000, false},    {"unit='parsec'", 1, true}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_scene *s = load_package(rows[i].unit, "<object id='1' type='model'>" TETRA "</object>",
                                    "<item objectid='1' transform='1 0 0 0 1 0 0 0 1 10 0 0'/>", i % 2);
        box3       b = s->parts[0].bounds;
        if (fabs(b.min.x - 10 * rows[i].mm) > 1e-6 * rows[i].mm || fabs(b.max.z - 3 * rows[i].mm) > 1e-6 * rows[i].mm)
            fail_msg("%s: x from %g, z to %g", rows[i].unit, b.min.x, b.max.z);
        assert_int_equal(has_warning(s, WARNING_BAD_VALUE), rows[i].warned);
        lmn_scene_destroy(&s);
    }
}

/* Objects are called as they are, alone and in assemblies; those without a name by their number. */
static void objects_have_names(void **state)
{
    (void)state;
    for (int packed = 0; packed < 2; packed++) {
        lmn_part_info info;
        lmn_scene    *s = load_package(
               "unit='millimeter'",
               "<object id='1' type='model' name='Tetra &amp; &#67;o'>" TETRA "</object><object id='2' type='model'>" TETRA
               "</object><object id='7' name='Pair'><components><component objectid='1'/><component objectid='2' "
                  "transform='1 0 0 0 1 0 0 0 1 5 0 0'/></components></object>",
               "<item objectid='1'/><item objectid='7'/>", packed);
        static const char *const paths[] = {"thing/Tetra & Co", "thing/Pair/Tetra & Co", "thing/Pair/Object_2"};
        assert_int_equal(s->part_count, 3);
        for (size_t i = 0; i < 3; i++) {
            assert_true(lmn_scene_part_at(s, i, &info));
            assert_string_equal(info.path, paths[i]);
        }
        lmn_scene_destroy(&s);
    }
}

/* A scene as assimp leaves it, described by a package of `size` bytes. */
static lmn_status describe(const unsigned char *bytes, size_t size)
{
    unsigned char *own = malloc(size ? size : 1); /* its end is the end of the memory */
    file_data      file = {own, size};
    lmn_scene     *s = scene_new();
    import_job     job = {.path = "thing.3mf", .model = "thing.3mf", .file = &file, .scene = s};
    assert_non_null(s);
    memcpy(own, bytes, size);
    node *n = scene_append_node(s);
    assert_non_null(n);
    n->name = mem_copy_text("Object_1");
    lmn_status status = threemf_describe(&job, NULL);
    scene_free(s);
    free(own);
    return status;
}

/* Cut off anywhere, and with any bit wrong: it is a warning, and nothing is read that is not there. */
static void damaged_packages_are_borne(void **state)
{
    (void)state;
    for (int packed = 0; packed < 2; packed++) {
        const package       *p = pack("unit='inch'", "<object id='1' name='Tetra'>" TETRA "</object>", "", packed);
        static unsigned char changed[PACKAGE_MOST];
        for (size_t size = 0; size < p->size; size++)
            assert_int_equal(describe(p->bytes, size), LMN_OK);
        for (size_t at = 0; at < p->size; at++)
            for (int bit = 0; bit < 8; bit += 1 + (at < p->size - 400) * 3) {
                memcpy(changed, p->bytes, p->size);
                changed[at] ^= (unsigned char)(1 << bit);
                assert_int_equal(describe(changed, p->size), LMN_OK);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_are_obeyed),
        cmocka_unit_test(objects_have_names),
        cmocka_unit_test(damaged_packages_are_borne),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
