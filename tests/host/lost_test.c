/* A context that is lost, as the driver would tell: reported, and everything can be freed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "context.h"
#include "draw/session.h"
#include "gpu/gpu_private.h"
#include "limner/limner.h"

static lmn_error error;
static int       asked, lost_from;

static GLenum status_of_reset(void)
{
    return ++asked >= lost_from ? GL_GUILTY_CONTEXT_RESET : GL_NO_ERROR;
}

/* The n-th time that the driver is asked, it says so. */
static void lose(bool adopted, int when)
{
    context           c;
    lmn_renderer     *r;
    lmn_scene        *scene;
    lmn_look         *look;
    lmn_drawing      *drawing = NULL;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    lmn_renderer_desc how = LMN_RENDERER_DESC_INIT;
    desc.width = desc.height = 32;
    how.adopt = adopted;
    assert_true(context_open(&c, CONTEXT_CORE, 3, 3));
    assert_int_equal(lmn_renderer_create(&r, &how, &error), LMN_OK);
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(scene, EXAMPLES "/box.glb", NULL, &error), LMN_OK);
    assert_int_equal(lmn_look_load(&look, "pencil", &error), LMN_OK);
    assert_int_equal(lmn_draw(&drawing, r, scene, look, &desc, &error), LMN_OK);
    lmn_drawing_destroy(&drawing);
    assert_non_null(r->g->reset_status);
    r->g->reset_status = status_of_reset;
    asked = 0;
    lost_from = when;
    for (int i = 0; i < 3; i++) {
        lmn_status status = lmn_draw(&drawing, r, scene, look, &desc, &error);
        bool       still = 2 * (i + 1) < when;
        assert_int_equal(status, still ? LMN_OK : LMN_GL);
        if (!still) {
            assert_null(drawing);
            assert_non_null(strstr(error.message, "lost"));
            assert_non_null(strstr(error.hint, "destroy the renderer"));
        }
        lmn_drawing_destroy(&drawing);
        assert_ptr_equal(eglGetCurrentContext(), c.context);
    }
    lmn_renderer_destroy(&r);
    assert_null(r);
    assert_ptr_equal(eglGetCurrentContext(), c.context);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    context_close(&c);
}

static void contexts_get_lost(void **unused)
{
    (void)unused;
    for (int adopted = 0; adopted < 2; adopted++)
        for (int when = 1; when <= 4; when++)
            lose(adopted, when);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(contexts_get_lost)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
