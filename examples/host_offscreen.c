/* A picture of a model, without a window: host_offscreen MODEL LOOK OUT.png */
#include <limner/limner.h>
#include <stdio.h>

int main(int count, char **arguments)
{
    lmn_error     error = {0};
    lmn_renderer *renderer = NULL;
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    if (count < 4)
        return 1;
    desc.width = 640;
    desc.height = 480;
    lmn_status status = lmn_renderer_create(&renderer, NULL, &error); /* a context of its own */
    if (status == LMN_OK)
        status = lmn_scene_create(&scene, &error);
    if (status == LMN_OK)
        status = lmn_scene_add_file(scene, arguments[1], NULL, &error);
    if (status == LMN_OK)
        status = lmn_look_load(&look, arguments[2], &error);
    if (status == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, &error);
    if (status == LMN_OK)
        status = lmn_drawing_write(drawing, arguments[3], NULL, NULL, &error);
    if (status != LMN_OK)
        fprintf(stderr, "%s\n%s\n", error.message, error.hint);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    lmn_renderer_destroy(&renderer);
    return status != LMN_OK;
}
