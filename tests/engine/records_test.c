/* Records of edges are drawn kind by kind on software drivers, and all at once on GPUs: the same picture. The pump has
 * edges of each kind: short and long on the page, outlines of what is smooth and creases. */
#include "checked.h"

#include <string.h>

#include "draw/session.h"

enum { SIDE = 480, BYTES = 4 * SIDE * SIDE };

static void draw(lmn_renderer *r, const lmn_scene *s, const lmn_look *look, bool software, uint8_t *pixels)
{
    gpu_capabilities *facts = (gpu_capabilities *)(uintptr_t)gpu_capabilities_of(r->g);
    const bool        is_software = facts->software;
    lmn_drawing      *drawing = NULL;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = SIDE;
    facts->software = software;
    DO(lmn_draw(&drawing, r, s, look, &desc, &error));
    facts->software = is_software;
    memcpy(pixels, lmn_drawing_pixels(drawing, NULL, NULL), BYTES);
    lmn_drawing_destroy(&drawing);
}

static void the_same_picture_both_ways(void **state)
{
    (void)state;
    static uint8_t by_kind[BYTES], at_once[BYTES];
    lmn_renderer  *r = NULL;
    lmn_scene     *s = NULL;
    lmn_look      *look = NULL;
    DO(lmn_renderer_create(&r, NULL, &error));
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, EXAMPLES "/pump.glb", NULL, &error));
    DO(lmn_look_load(&look, "edges", &error));
    draw(r, s, look, true, by_kind);
    draw(r, s, look, false, at_once);
    assert_memory_equal(at_once, by_kind, BYTES);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_same_picture_both_ways)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
