/* Expressions of depictions: whatever stands in them, the scene has its signs or is as it was. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "fuzz.h"
#include "limner/depict.h"
#include "scene/scene.h"

#include <jansson.h>

/* Something that bounces, turns, grows and looks, with parts that go apart, a wall, and a camera that goes along. Few
 * triangles, so that much can be tried. */
static const char few_things[] =
    "{\"limner_script\": 1, \"nodes\": ["
    "{\"name\": \"ground\", \"box\": {\"size\": [11, 0.2, 4]}, \"translation\": [4, -0.1, 0]},"
    "{\"name\": \"ball\", \"box\": {\"size\": [1, 1, 1]}, \"translation\": [0, 4, 0], \"semantics\": \"ball\"},"
    "{\"name\": \"glider\", \"box\": {\"size\": [1, 0.1, 2]}, \"translation\": [0, 6, 0], \"semantics\": "
    "\"paper-plane\"},"
    "{\"name\": \"figure\", \"translation\": [6, 0, -1]},"
    "{\"name\": \"left\", \"parent\": \"figure\", \"box\": {\"size\": [1, 1, 1]}},"
    "{\"name\": \"head\", \"parent\": \"figure\", \"box\": {\"size\": [1, 1, 1]}, \"translation\": [0, 2, 0]},"
    "{\"name\": \"eye\", \"translation\": [0, 2, 9], \"camera\": {\"fov\": 40}}],"
    "\"behaviour\": ["
    "{\"target\": \"ball\", \"function\": \"bounce\", \"floor\": 0.5, \"velocity\": [2, 0, 0], \"duration\": 3},"
    "{\"target\": \"ball\", \"property\": \"rotation\", \"function\": \"spin\", \"axis\": [1, 0, 0], \"duration\": 3},"
    "{\"target\": \"glider\", \"curve\": {\"points\": [[0, 6, 0], [3, 4, 1], [6, 6, 0], [9, 5, 0]]}, \"duration\": 3},"
    "{\"target\": \"left\", \"linear\": [[0, 0, 0], [0, 0, 0], [-3, 1, 0]], \"duration\": 3},"
    "{\"target\": \"head\", \"linear\": [[0, 2, 0], [0, 2, 0], [3, 3, 0]], \"duration\": 3},"
    "{\"target\": \"figure\", \"property\": \"scale\", \"linear\": [[1, 1, 1], [2, 2, 2]], \"duration\": 3},"
    "{\"target\": \"eye\", \"linear\": [[0, 2, 9], [5, 4, 9]], \"duration\": 3}]}";

static lmn_draw_desc draw_of(uint8_t choice)
{
    static const double times[] = {0, 0.4, 0.9, 1.7, 2.99, 3, 100, -1};
    lmn_draw_desc       draw = LMN_DRAW_DESC_INIT;
    draw.width = draw.height = 256;
    draw.view = (lmn_view)(choice % 7);
    draw.camera = choice & 128 ? "eye" : NULL;
    draw.time_given = true;
    draw.time_s = times[choice >> 4 & 7];
    return draw;
}

/* Of the document that lmn_depict gives, the expressions as text; free with mem_free. */
static char *expressions_of(const char *document)
{
    json_t *root = json_loads(document, 0, NULL);
    char   *dumped = root ? json_dumps(json_object_get(root, "expressions"), 0) : NULL, *out = mem_copy_text(dumped);
    free(dumped);
    json_decref(root);
    return out;
}

static void check_places(const lmn_scene *s)
{
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            const primitive *p = &s->meshes[i].primitives[k];
            for (uint32_t v = 0; v < p->vertex_count; v++)
                if (!isfinite(p->positions[v].x) || !isfinite(p->positions[v].y) || !isfinite(p->positions[v].z))
                    __builtin_trap();
        }
}

/* The first byte chooses who looks at which time, the rest are expressions. What is accepted is written as what is
 * accepted, in the same words. */
void fuzz_depict(const uint8_t *bytes, size_t size)
{
    lmn_error  error;
    char      *told = NULL, *again = NULL, *first = NULL, *second = NULL;
    lmn_scene *s = fuzz_read_model(import_script.read, 'y', (const uint8_t *)few_things, sizeof few_things - 1);
    if (!s || size < 2) {
        scene_free(s);
        return;
    }
    const size_t    parts = s->part_count;
    lmn_draw_desc   draw = draw_of(bytes[0]);
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    desc.expressions = (const char *)bytes + 1;
    lmn_status status = lmn_depict(s, &draw, &desc, &told, &error);
    if (status == LMN_OK) {
        check_places(s);
        first = expressions_of(told);
        desc.expressions = first;
        status = first ? lmn_depict(s, &draw, &desc, &again, &error) : LMN_MEMORY;
        second = status == LMN_OK ? expressions_of(again) : NULL;
        if (status != LMN_OK && status != LMN_MEMORY && status != LMN_LIMIT)
            __builtin_trap();
        if (first && second && strcmp(first, second) != 0)
            __builtin_trap();
    }
    if (lmn_depict_clear(s, &error) == LMN_OK && s->part_count != parts)
        __builtin_trap();
    lmn_text_free(told);
    lmn_text_free(again);
    mem_free(first);
    mem_free(second);
    scene_free(s);
}
