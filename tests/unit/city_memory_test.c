/* What a city takes: loading it never has more than four times its file's bytes, the file among them. Towns are many
 * small things, so that it is their nodes, parts and attributes that count. */
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "base/work.h"
#include "import_support.h"

/* Whose nodes nearly fill a power of two, as arrays that grow do. */
enum { HOUSES = 4000, MOST_OF_FILE = 4 };

/* Three of four have gables. Returns how many vertices it has. */
static int append_house(text *objects, text *vertices, int i, int first)
{
    static const char *const        flat[] = {"0,3,2,1", "0,1,5,4", "1,2,6,5", "2,3,7,6", "3,0,4,7", "4,5,6,7", NULL},
                             *const gabled[] = {"0,3,2,1", "0,1,5,8,4", "1,2,6,5", "2,3,7,9,6",
                                                "3,0,4,7", "4,8,9,7",   "5,6,9,8", NULL};
    const bool                      gable = i % 4 != 0;
    const int x = 17000 * (i % 64), y = 20000 * (i / 64), width = 7013 + 613 * (i % 11), height = 5117 + 703 * (i % 9);
    text_append(objects,
                "%s\"house-%06d\":{\"type\":\"Building\",\"attributes\":{\"function\":\"residential\","
                "\"yearOfConstruction\":%d,\"measuredHeight\":%.2f,\"storeysAboveGround\":%d},\"geometry\":[{\"type\":"
                "\"Solid\",\"lod\":\"2\",\"boundaries\":[[",
                i ? "," : "", i, 1750 + i % 270, height / 1000.0, 1 + i % 5);
    for (const char *const *face = gable ? gabled : flat; *face; face++) {
        const char *separator = face == gabled || face == flat ? "" : ",";
        text_append(objects, "%s[[", separator);
        for (const char *at = *face; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
            text_append(objects, "%s%d", at == *face ? "" : ",", first + (int)strtol(at, NULL, 10));
        text_append(objects, "]]");
    }
    text_append(objects,
                "]],\"semantics\":{\"surfaces\":[{\"type\":\"RoofSurface\"},{\"type\":\"WallSurface\"},"
                "{\"type\":\"GroundSurface\"}],\"values\":[[2,1,1,1,1,0%s]]}}]}",
                gable ? ",0" : "");
    for (int k = 0; k < 8; k++)
        text_append(vertices, "%s[%d,%d,%d]", i || k ? "," : "", x + (k % 4 == 1 || k % 4 == 2 ? width : 0),
                    y + (k % 4 >= 2 ? 9000 : 0), k >= 4 ? height : 0);
    for (int k = 0; k < 2 && gable; k++)
        text_append(vertices, ",[%d,%d,%d]", x + width / 2, y + 9000 * k, height + width / 2);
    return gable ? 10 : 8;
}

static void towns_take_four_times_their_file(void **state)
{
    (void)state;
    text objects = {0}, vertices = {0}, file = {0};
    for (int i = 0, first = 0; i < HOUSES; i++)
        first += append_house(&objects, &vertices, i, first);
    text_append(&file,
                "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":{\"scale\":[0.001,0.001,0.001],\"translate\":"
                "[400000,5600000,0]},\"metadata\":{\"referenceSystem\":"
                "\"https://www.opengis.net/def/crs/EPSG/0/25832\"},\"CityObjects\":{");
    text_append_bytes(&file, objects.data, objects.size);
    text_append(&file, "},\"vertices\":[");
    text_append_bytes(&file, vertices.data, vertices.size);
    text_append(&file, "]}\n");
    assert_false(file.failed);
    const size_t size = file.size;
    const char  *path = temp_file("town.city.json", file.data, size);
    text_release(&objects);
    text_release(&vertices);
    text_release(&file);
    work          task;
    lmn_error     error = {0};
    lmn_scene    *scene = NULL;
    lmn_task_desc desc = {.struct_size = sizeof desc, .limits = lmn_limits_standard()};
    desc.limits.memory = MOST_OF_FILE * size;
    work_begin_task(&task, &desc);
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    lmn_status status = lmn_scene_add_file(scene, path, NULL, &error);
    if (status != LMN_OK)
        fail_msg("%zu bytes, with %d times as many: %s", size, MOST_OF_FILE, error.message);
    assert_int_equal(scene->part_count, 3 * HOUSES);
    assert_int_equal(work_end(&task, LMN_OK, NULL), LMN_OK);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(towns_take_four_times_their_file)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
