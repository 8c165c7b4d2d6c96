/* Drawings that stay on the GPU: their textures have the bytes that drawings in memory have, and last as they promise.
 * And pixels that are picked without a drawing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "context.h"
#include "limner/limner.h"

enum { WIDTH = 60, HEIGHT = 44, PIXELS = WIDTH * HEIGHT };

static lmn_error error;

static void check(lmn_status status, const char *what)
{
    if (status != LMN_OK)
        fail_msg("%s: %s (%s)", what, error.message, error.hint);
}
#define DO(call) check(call, #call)

/* Scenes and looks that maps differ by: one figure and several, layers, several line techniques, fields, directions,
 * velocities, solids, what is written beside a drawing. A look that begins with { is one. */
typedef struct subject {
    const char *model, *look;
    double      time_s;
    unsigned    more; /* maps beside the first five, as bits */
} subject;

#define BIT(map) (1u << (map))
static const char several[] =
    "{\"version\": 2, \"rules\": [{\"select\": \"*\", \"surface\": \"lit\", \"lines\": \"discontinuity\"},"
    "{\"select\": \"*Bolt*\", \"surface\": \"toon\", \"lines\": [{\"operator\": \"sobel\"}, {\"operator\": \"id\"}]},"
    "{\"select\": \"*Gasket*\", \"surface\": \"gooch\"},"
    "{\"select\": \"*Housing*\", \"surface\": \"lit\", \"lines\": \"discontinuity\","
    " \"layers\": {\"technique\": \"peel\", \"count\": 4}, \"compose\": \"xray\"},"
    "{\"select\": \"*Cover*\", \"surface\": \"flat\", \"lines\": [{\"operator\": \"sobel\"}, {\"operator\": \"id\"}],"
    " \"layers\": {\"technique\": \"peel\", \"count\": 3}, \"compose\": \"wire\"}]}";
static const char    form[] = "{\"version\": 2, \"rules\": [{\"select\": \"*\", \"lines\": \"discontinuity\","
                              " \"surface\": {\"technique\": \"hatch\", \"coordinates\": \"form\"}}]}";
static const char    written[] = "{\"version\": 2, \"scene\": {\"datum\": \"yearOfConstruction\"},"
                                 " \"finish\": {\"labels\": \"name\", \"legend\": true, \"north_arrow\": true},"
                                 " \"rules\": [{\"select\": \"*\", \"surface\": \"tones\"}]}";
static const subject subjects[] = {
    {"box.glb", "edges", 0, 0},
    {"pump.glb", "line", 0, 0},
    {"pump.glb", several, 0, 0},
    {"pump.glb", "xray", 0, 0},
    {"pump.glb", "sketch", 0, BIT(LMN_MAP_UNCERTAINTY)},
    {"pump.glb", form, 0, BIT(LMN_MAP_DIRECTION)},
    {"pump.glb", several, 0.6, BIT(LMN_MAP_VELOCITY)},
    {"csg/widget.csg", "technical", 0, 0},
    {"town.geojson", written, 0, 0},
};
enum { SUBJECTS = sizeof subjects / sizeof *subjects };

static lmn_renderer *adopt(void)
{
    lmn_renderer     *out;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    desc.adopt = desc.debug = true;
    DO(lmn_renderer_create(&out, &desc, &error));
    return out;
}

typedef struct opened {
    lmn_scene    *scene;
    lmn_look     *look;
    lmn_draw_desc desc;
} opened;

static opened open_subject(const subject *s)
{
    opened o = {.desc = LMN_DRAW_DESC_INIT};
    char   path[512];
    snprintf(path, sizeof path, EXAMPLES "/%s", s->model);
    DO(lmn_scene_create(&o.scene, &error));
    DO(lmn_scene_add_file(o.scene, path, NULL, &error));
    if (s->look[0] == '{')
        DO(lmn_look_parse(&o.look, s->look, "test", &error));
    else
        DO(lmn_look_load(&o.look, s->look, &error));
    o.desc.width = WIDTH;
    o.desc.height = HEIGHT;
    o.desc.samples = 4;
    o.desc.time_s = s->time_s;
    o.desc.maps = true;
    return o;
}

static void close_subject(opened *o)
{
    lmn_look_destroy(&o->look);
    lmn_scene_destroy(&o->scene);
}

static lmn_drawing *draw(lmn_renderer *r, const opened *o, bool textures)
{
    lmn_draw_desc desc = o->desc;
    lmn_drawing  *out;
    desc.textures = textures;
    DO(lmn_draw(&out, r, o->scene, o->look, &desc, &error));
    return out;
}

/* What the host reads of a texture: four numbers a pixel, rows turned to run from the top. */
static void read_texture(uint32_t name, GLenum format, GLenum type, void *out)
{
    const size_t row = WIDTH * (type == GL_UNSIGNED_BYTE ? 4u : 16u);
    char        *read = malloc(row * HEIGHT);
    GLuint       framebuffer;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
    assert_int_equal(glCheckFramebufferStatus(GL_READ_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, WIDTH, HEIGHT, format, type, read);
    glDeleteFramebuffers(1, &framebuffer);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    for (size_t y = 0; y < HEIGHT; y++)
        memcpy((char *)out + y * row, read + (HEIGHT - 1 - y) * row, row);
    free(read);
}

static void same_map(const lmn_drawing *stays, const lmn_drawing *memory, lmn_map map, const char *what)
{
    static uint32_t wide[4 * PIXELS], numbers[4 * PIXELS];
    size_t          components = (size_t)lmn_map_components(map);
    bool            integer = map == LMN_MAP_ID;
    uint32_t        name = 0;
    check(lmn_drawing_map_texture(stays, map, &name, &error), what);
    assert_true(glIsTexture(name));
    DO(lmn_drawing_copy_map(memory, map, numbers, PIXELS * components, &error));
    read_texture(name, integer ? GL_RGBA_INTEGER : GL_RGBA, integer ? GL_UNSIGNED_INT : GL_FLOAT, wide);
    size_t differ = 0, first = 0;
    for (size_t i = 0; i < PIXELS; i++)
        if (memcmp(&wide[4 * i], &numbers[components * i], components * sizeof *numbers) != 0 && differ++ == 0)
            first = i;
    if (differ)
        fail_msg("%s, map %d: %zu pixels differ, first %zu %zu", what, (int)map, differ, first % WIDTH, first / WIDTH);
}

/* The picture and each map, byte for byte; maps that the one does not have the other has not. */
static void compare(const subject *s, context_kind kind)
{
    context c;
    char    what[64];
    assert_true(context_open(&c, kind, 3, kind == CONTEXT_ES ? 0 : 3));
    snprintf(what, sizeof what, "%s %.20s %g", s->model, s->look, s->time_s);
    static uint8_t  pixels[4 * PIXELS];
    static uint32_t numbers[4 * PIXELS];
    lmn_renderer   *r = adopt();
    opened          o = open_subject(s);
    lmn_drawing    *memory = draw(r, &o, false), *stays = draw(r, &o, true);
    int             width = 0, height = 0;
    uint32_t        name = 0;
    assert_null(lmn_drawing_pixels(stays, &width, &height));
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    DO(lmn_drawing_texture(stays, &name, &error));
    read_texture(name, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    assert_memory_equal(pixels, lmn_drawing_pixels(memory, NULL, NULL), sizeof pixels);
    for (int i = 0; i <= LMN_MAP_DIRECTION; i++) {
        bool there = i <= LMN_MAP_SHADE || s->more & BIT(i);
        if (there)
            same_map(stays, memory, (lmn_map)i, what);
        assert_int_equal(lmn_drawing_map_texture(stays, (lmn_map)i, &name, &error) == LMN_OK, there);
        assert_int_equal(lmn_drawing_copy_map(memory, (lmn_map)i, numbers,
                                              (size_t)PIXELS * (size_t)lmn_map_components((lmn_map)i),
                                              &error) == LMN_OK,
                         there);
    }
    lmn_drawing_destroy(&stays);
    lmn_drawing_destroy(&memory);
    close_subject(&o);
    lmn_renderer_destroy(&r);
    context_close(&c);
}

static void textures_have_the_bytes_of_memory(void **unused)
{
    (void)unused;
    for (int i = 0; i < SUBJECTS; i++)
        compare(&subjects[i], CONTEXT_CORE);
}

static void in_es_too(void **unused)
{
    (void)unused;
    compare(&subjects[2], CONTEXT_ES);
    compare(&subjects[6], CONTEXT_ES);
}

/* After it the drawing is one like others, without its renderer. */
static void read_back(void **unused)
{
    (void)unused;
    static uint32_t numbers[2][4 * PIXELS];
    for (int kind = CONTEXT_CORE; kind <= CONTEXT_ES; kind++) {
        context c;
        assert_true(context_open(&c, (context_kind)kind, 3, kind == CONTEXT_ES ? 0 : 3));
        lmn_renderer *r = adopt();
        opened        o = open_subject(&subjects[6]);
        lmn_drawing  *memory = draw(r, &o, false), *stays = draw(r, &o, true);
        lmn_pick      a, b;
        uint32_t      name[2];
        DO(lmn_drawing_texture(stays, &name[0], &error));
        DO(lmn_drawing_read_back(stays, &error));
        DO(lmn_drawing_texture(stays, &name[1], &error)); /* it is there still */
        assert_int_equal(name[0], name[1]);
        lmn_renderer_destroy(&r);
        DO(lmn_drawing_read_back(stays, &error)); /* nothing is left to do */
        assert_int_equal(lmn_drawing_texture(stays, &name[1], &error), LMN_USAGE);
        assert_memory_equal(lmn_drawing_pixels(stays, NULL, NULL), lmn_drawing_pixels(memory, NULL, NULL), 4 * PIXELS);
        for (int i = 0; i <= LMN_MAP_VELOCITY; i++) {
            size_t count = (size_t)PIXELS * (size_t)lmn_map_components((lmn_map)i);
            if (i == LMN_MAP_UNCERTAINTY)
                continue;
            DO(lmn_drawing_copy_map(memory, (lmn_map)i, numbers[0], count, &error));
            DO(lmn_drawing_copy_map(stays, (lmn_map)i, numbers[1], count, &error));
            assert_memory_equal(numbers[0], numbers[1], count * sizeof **numbers);
        }
        DO(lmn_drawing_pick(memory, WIDTH / 2, HEIGHT / 2, &a, &error));
        DO(lmn_drawing_pick(stays, WIDTH / 2, HEIGHT / 2, &b, &error));
        assert_true(a.part != 0);
        assert_memory_equal(&a, &b, sizeof a);
        lmn_drawing_destroy(&stays);
        lmn_drawing_destroy(&memory);
        close_subject(&o);
        context_close(&c);
    }
}

static void refused(lmn_status status, const char *word)
{
    if (status != LMN_USAGE || !strstr(error.message, word))
        fail_msg("status %d, '%s', expected one with '%s'", (int)status, error.message, word);
}

/* Valid until the renderer draws again, also when the drawing has ended before. */
static void how_long_they_last(void **unused)
{
    (void)unused;
    context c;
    assert_true(context_open(&c, CONTEXT_CORE, 3, 3));
    lmn_renderer  *r = adopt();
    opened         o = open_subject(&subjects[0]);
    static uint8_t first[4 * PIXELS], second[4 * PIXELS];
    lmn_drawing   *stays = draw(r, &o, true), *other;
    uint32_t       name, bytes_name;
    lmn_pick       pick;
    DO(lmn_drawing_texture(stays, &name, &error));
    read_texture(name, GL_RGBA, GL_UNSIGNED_BYTE, first);
    lmn_drawing_destroy(&stays);
    read_texture(name, GL_RGBA, GL_UNSIGNED_BYTE, second); /* it has outlasted its drawing */
    assert_memory_equal(first, second, sizeof first);
    stays = draw(r, &o, true);
    DO(lmn_drawing_texture(stays, &bytes_name, &error));
    other = draw(r, &o, true);
    refused(lmn_drawing_texture(stays, &name, &error), "drawn again");
    refused(lmn_drawing_map_texture(stays, LMN_MAP_ID, &name, &error), "drawn again");
    refused(lmn_drawing_read_back(stays, &error), "drawn again");
    DO(lmn_drawing_texture(other, &name, &error));
    DO(lmn_draw_pick(r, o.scene, o.look, &o.desc, 1, 1, &pick, &error));
    refused(lmn_drawing_texture(other, &name, &error), "drawn again");
    lmn_drawing_destroy(&stays);
    lmn_drawing_destroy(&other);
    stays = draw(r, &o, true);
    lmn_renderer_destroy(&r);
    refused(lmn_drawing_map_texture(stays, LMN_MAP_DEPTH, &name, &error), "ended");
    lmn_drawing_destroy(&stays);
    close_subject(&o);
    context_close(&c);
}

static void what_is_refused(void **unused)
{
    (void)unused;
    context c;
    assert_true(context_open(&c, CONTEXT_CORE, 3, 3));
    lmn_renderer *r = adopt(), *own;
    opened        o = open_subject(&subjects[0]);
    lmn_drawing  *stays, *memory = draw(r, &o, false), *none;
    lmn_sheet    *sheet;
    lmn_pick      pick;
    uint32_t      name;
    float         number;
    uint8_t      *bytes;
    size_t        size;
    DO(lmn_drawing_read_back(memory, &error)); /* it is in memory */
    refused(lmn_drawing_texture(memory, &name, &error), "without textures");
    o.desc.maps = false;
    stays = draw(r, &o, true);
    refused(lmn_drawing_map_texture(stays, LMN_MAP_DEPTH, &name, &error), "does not have");
    refused(lmn_drawing_map_texture(stays, (lmn_map)99, &name, &error), "no map");
    refused(lmn_drawing_texture(stays, NULL, &error), "`name`");
    refused(lmn_drawing_write(stays, "textures_test.png", NULL, NULL, &error), "GPU alone");
    refused(lmn_drawing_encode(stays, ".png", &bytes, &size, &error), "GPU alone");
    refused(lmn_drawing_write_maps(stays, "textures_test_maps", &error), "GPU alone");
    refused(lmn_drawing_copy_map(stays, LMN_MAP_DEPTH, &number, 1, &error), "without its maps");
    lmn_drawing_destroy(&stays);
    o.desc.maps = true;
    stays = draw(r, &o, true);
    refused(lmn_drawing_copy_map(stays, LMN_MAP_DEPTH, &number, 1, &error), "GPU alone");
    refused(lmn_drawing_pick(stays, 0, 0, &pick, &error), "GPU alone");
    o.desc.textures = true;
    refused(lmn_draw_sheet(&sheet, r, o.scene, o.look, &o.desc, NULL, &error), "textures");
    o.desc.profile = true;
    refused(lmn_draw(&none, r, o.scene, o.look, &o.desc, &error), "profile");
    o.desc.profile = false;
    DO(lmn_renderer_create(&own, NULL, &error));
    refused(lmn_draw(&none, own, o.scene, o.look, &o.desc, &error), "own");
    lmn_renderer_destroy(&own);
    lmn_drawing_destroy(&stays);
    lmn_drawing_destroy(&memory);
    lmn_renderer_destroy(&r);
    close_subject(&o);
    context_close(&c);
}

/* The same answer as that of the maps. */
static void pixels_are_picked_alone(void **unused)
{
    (void)unused;
    enum { APART = 7 };
    lmn_renderer *r;
    DO(lmn_renderer_create(&r, NULL, &error));
    for (int i = 0; i < SUBJECTS; i++) {
        opened       o = open_subject(&subjects[i]);
        lmn_drawing *memory = draw(r, &o, false);
        int          seen = 0;
        for (int y = -1; y <= HEIGHT; y += APART)
            for (int x = -1; x <= WIDTH; x += APART) {
                lmn_pick a, b;
                DO(lmn_drawing_pick(memory, x, y, &a, &error));
                DO(lmn_draw_pick(r, o.scene, o.look, &o.desc, x, y, &b, &error));
                if (memcmp(&a, &b, sizeof a) != 0)
                    fail_msg("%s %.20s at %d %d: part %u depth %.9g normal %.9g, not part %u depth %.9g normal %.9g",
                             subjects[i].model, subjects[i].look, x, y, b.part, b.depth, b.normal[0], a.part, a.depth,
                             a.normal[0]);
                seen += a.part != 0;
            }
        assert_true(seen > 5);
        lmn_drawing_destroy(&memory);
        close_subject(&o);
    }
    lmn_renderer_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(textures_have_the_bytes_of_memory),
        cmocka_unit_test(in_es_too),
        cmocka_unit_test(read_back),
        cmocka_unit_test(how_long_they_last),
        cmocka_unit_test(what_is_refused),
        cmocka_unit_test(pixels_are_picked_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
