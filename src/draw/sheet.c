#include "draw/sheet.h"

typedef struct sheet_surfaces {
    lmn_renderer    *renderer;
    const lmn_scene *scene;
    const lmn_look  *look;
} sheet_surfaces;

static lmn_status draw_surfaces(uint8_t **out, const lmn_draw_desc *desc, const char *cut, void *user, lmn_error *error)
{
    const sheet_surfaces *s = user;
    lmn_drawing          *drawing;
    *out = NULL;
    lmn_status status = renderer_draw(&drawing, s->renderer, s->scene, s->look,
                                      &(draw_options){.desc = desc, .cut = cut, .surfaces_only = true}, error);
    if (status == LMN_OK) {
        *out = drawing->pixels;
        drawing->pixels = NULL;
    }
    drawing_destroy(&drawing);
    return status;
}

lmn_status sheet_draw(lmn_sheet **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                      const lmn_draw_desc *desc, const lmn_sheet_desc *wanted, lmn_error *error)
{
    sheet_surfaces surfaces = {r, scene, look};
    return vector_draw(out, scene, look, desc, wanted, r ? draw_surfaces : NULL, &surfaces, error);
}
