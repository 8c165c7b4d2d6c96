/* A program of the library's users: draws a model in the look `line`. Usage: program MODEL OUT */
#include <limner/limner.h>
#include <stdio.h>
#include <string.h>

/* The library has functions of these names inside, and users may too. */
int mem_alloc(void);
int error_set(void);
int mem_alloc(void)
{
    return 1;
}
int error_set(void)
{
    return 2;
}

static lmn_status draw(lmn_scene *scene, const char *model, const char *out, lmn_error *error)
{
    lmn_look         *look = NULL;
    lmn_renderer     *renderer = NULL;
    lmn_drawing      *drawing = NULL;
    lmn_load_desc     load = LMN_LOAD_DESC_INIT;
    lmn_renderer_desc make = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 64;
    lmn_status status = lmn_scene_add_file(scene, model, &load, error);
    if (status == LMN_OK)
        status = lmn_look_load(&look, "line", error);
    if (status == LMN_OK)
        status = lmn_renderer_create(&renderer, &make, error);
    if (status == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, error);
    if (status == LMN_OK)
        status = lmn_drawing_write(drawing, out, NULL, NULL, error);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&renderer);
    lmn_look_destroy(&look);
    return status;
}

int main(int count, char **arguments)
{
    lmn_error  error = {0};
    lmn_scene *scene = NULL;
    if (count != 3 || strcmp(lmn_version(), LMN_VERSION) != 0 || mem_alloc() + error_set() != 3)
        return 1;
    lmn_status status = lmn_scene_create(&scene, &error);
    if (status == LMN_OK)
        status = draw(scene, arguments[1], arguments[2], &error);
    lmn_scene_destroy(&scene);
    if (status != LMN_OK)
        fprintf(stderr, "%s\n", error.message);
    return status != LMN_OK;
}
