/* OpenStreetMap's binary extracts (PBF), written here by the format's description
 * (wiki.openstreetmap.org/wiki/PBF_Format), read by GDAL in its fence. Without GDAL the test is skipped. */
#include "import_support.h"

#include "import/geodata.h"
#include "scene/content.h"

typedef struct bytes {
    unsigned char at[4096];
    size_t        count;
} bytes;

static void put_varint(bytes *b, uint64_t value)
{
    for (; value >= 0x80; value >>= 7)
        b->at[b->count++] = (unsigned char)(value | 0x80);
    b->at[b->count++] = (unsigned char)value;
}

static uint64_t zigzag(int64_t value)
{
    return (uint64_t)value << 1 ^ (uint64_t)(value < 0 ? -1 : 0);
}

static void put_number(bytes *b, unsigned field, uint64_t value)
{
    put_varint(b, field << 3);
    put_varint(b, value);
}

static void put_bytes(bytes *b, unsigned field, const void *data, size_t size)
{
    put_varint(b, field << 3 | 2);
    put_varint(b, size);
    memcpy(b->at + b->count, data, size);
    b->count += size;
}

static void put_message(bytes *b, unsigned field, const bytes *message)
{
    put_bytes(b, field, message->at, message->count);
}

/* Numbers in the table of strings: each key with its value. */
static void put_tags(bytes *b, const unsigned (*tags)[2], size_t count)
{
    for (unsigned k = 0; k < 2 && count; k++) {
        bytes list = {.count = 0};
        for (size_t i = 0; i < count; i++)
            put_varint(&list, tags[i][k]);
        put_message(b, 2 + k, &list);
    }
}

static void put_node(bytes *group, int64_t id, double latitude, double longitude, const unsigned (*tags)[2],
                     size_t count)
{
    bytes node = {.count = 0};
    put_number(&node, 1, zigzag(id));
    put_tags(&node, tags, count);
    put_number(&node, 8, zigzag((int64_t)(latitude * 1e7 + 0.5)));
    put_number(&node, 9, zigzag((int64_t)(longitude * 1e7 + 0.5)));
    put_message(group, 1, &node);
}

static void put_way(bytes *group, uint64_t id, const int64_t *nodes, size_t node_count, const unsigned (*tags)[2],
                    size_t count)
{
    bytes   way = {.count = 0}, list = {.count = 0};
    int64_t before = 0;
    put_number(&way, 1, id);
    put_tags(&way, tags, count);
    for (size_t i = 0; i < node_count; before = nodes[i++])
        put_varint(&list, zigzag(nodes[i] - before));
    put_message(&way, 8, &list);
    put_message(group, 3, &way);
}

static void put_block(bytes *file, const char *type, const bytes *content)
{
    bytes blob = {.count = 0}, header = {.count = 0};
    put_bytes(&blob, 1, content->at, content->count);
    put_bytes(&header, 1, type, strlen(type));
    put_number(&header, 3, blob.count);
    for (int shift = 24; shift >= 0; shift -= 8)
        file->at[file->count++] = (unsigned char)(header.count >> shift);
    memcpy(file->at + file->count, header.at, header.count);
    file->count += header.count;
    memcpy(file->at + file->count, blob.at, blob.count);
    file->count += blob.count;
}

static void write_town(bytes *file)
{
    static const char *const words[] = {"",          "building", "yes",         "height",  "9",    "name",
                                        "Zum Löwen", "highway",  "residential", "amenity", "bench"};
    static const unsigned    house[][2] = {{1, 2}, {3, 4}, {5, 6}}, road[][2] = {{7, 8}}, bench[][2] = {{9, 10}};
    static const int64_t     around[] = {1, 2, 3, 4, 1}, along[] = {5, 6};
    bytes header = {.count = 0}, block = {.count = 0}, table = {.count = 0}, nodes = {.count = 0}, ways = {.count = 0};
    put_bytes(&header, 4, "OsmSchema-V0.6", 14);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        put_bytes(&table, 1, words[i], strlen(words[i]));
    put_node(&nodes, 1, 47.5, 8.999, NULL, 0);
    put_node(&nodes, 2, 47.5, 8.9992, NULL, 0);
    put_node(&nodes, 3, 47.5002, 8.9992, NULL, 0);
    put_node(&nodes, 4, 47.5002, 8.999, NULL, 0);
    put_node(&nodes, 5, 47.499, 8.9995, NULL, 0);
    put_node(&nodes, 6, 47.501, 8.9995, NULL, 0);
    put_node(&nodes, 7, 47.5, 9.0, bench, 1);
    put_way(&ways, 10, around, 5, house, 3);
    put_way(&ways, 11, along, 2, road, 1);
    put_message(&block, 1, &table);
    put_message(&block, 2, &nodes);
    put_message(&block, 2, &ways);
    put_block(file, "OSMHeader", &header);
    put_block(file, "OSMData", &block);
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

static void extracts_are_read(void **state)
{
    (void)state;
    static bytes  file;
    lmn_scene    *s = NULL;
    lmn_error     error = {0};
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    write_town(&file);
    char *path = mem_copy_text(temp_file("town.osm.pbf", file.at, file.count));
    assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
    lmn_status status = lmn_scene_add_file(s, path, &desc, &error);
    if (status == LMN_UNSUPPORTED && strstr(error.message, "GDAL")) {
        lmn_scene_destroy(&s);
        mem_free(path);
        skip();
    }
    if (status != LMN_OK)
        fail_msg("%s", error.message);
    const part *wall = part_with(s, "wall");
    double      size[2] = {(double)(wall->bounds.max.x - wall->bounds.min.x),
                           (double)(wall->bounds.max.y - wall->bounds.min.y)};
    assert_true(size[0] > 14.9 && size[0] < 15.2 && size[1] > 22.1 && size[1] < 22.4);
    assert_float_equal(wall->bounds.max.z, 9, 0.01f);
    assert_string_equal(scene_attribute_of(s, wall->node, "name"), "Zum Löwen");
    assert_true(part_with(s, "road")->triangles == 2);
    assert_float_equal(part_with(s, "furniture")->bounds.max.z, 0.86f, 0.01f);
    lmn_scene_destroy(&s);
    mem_free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(extracts_are_read)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
