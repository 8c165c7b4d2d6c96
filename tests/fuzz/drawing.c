/* The fuzzer of drawing: a model of any format with any look, as a picture and as vectors. One renderer is kept for
 * the process. */
#include <limner/limner.h>

#include "base/memory.h"
#include "vector/vector.h"
#include "export/export.h"
#include "fuzz.h"
#include "import/csg.h"

/* Kept until the process ends. */
static lmn_renderer *renderer;

static lmn_renderer *the_renderer(void)
{
    const lmn_renderer_desc desc = {.struct_size = sizeof desc, .debug = true};
    lmn_error               error;
    if (!renderer && lmn_renderer_create(&renderer, &desc, &error) != LMN_OK)
        __builtin_trap(); /* without a renderer nothing would be tested */
    return renderer;
}

static lmn_scene *read_model(unsigned choice, const uint8_t *bytes, size_t size)
{
    static const struct {
        const import_format *format;
        char                 up;
    } formats[] = {{&import_gltf, 'y'}, {&import_csg, 'z'}, {&import_obj, 'y'}, {&import_stl, 'z'}, {&import_ply, 'y'}};
    const unsigned which = choice % (sizeof formats / sizeof *formats);
    return fuzz_read_model(formats[which].format->read, formats[which].up, bytes, size);
}

static void draw_picture(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc)
{
    lmn_drawing *drawing = NULL;
    lmn_error    error;
    lmn_status   status = lmn_draw(&drawing, the_renderer(), scene, look, desc, &error);
    if (status == LMN_INTERNAL || status == LMN_GL)
        __builtin_trap(); /* no input may bring the driver to an error */
    if (status == LMN_OK)
        lmn_text_free(lmn_drawing_report_json(drawing));
    lmn_drawing_destroy(&drawing);
}

static void draw_sheet(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, unsigned choice)
{
    static lmn_status (*const writers[])(export_bytes *, const sheet *, lmn_error *) = {export_svg, export_pdf,
                                                                                        export_dxf};
    lmn_sheet_desc how = LMN_SHEET_DESC_INIT;
    lmn_sheet     *drawn = NULL;
    lmn_error      error;
    how.views = choice & 1 ? "front,top,iso" : NULL;
    how.frame = choice & 2;
    how.plotter = choice & 4;
    how.fill = choice & 8;
    how.verify = choice & 16;
    how.page = choice & 32 ? "A6" : NULL;
    how.title = "title";
    lmn_status status = lmn_draw_sheet(&drawn, choice & 64 ? the_renderer() : NULL, scene, look, desc, &how, &error);
    if (status == LMN_INTERNAL || status == LMN_GL)
        __builtin_trap();
    export_bytes data = {0};
    if (status == LMN_OK && writers[(choice >> 2) % 3](&data, &drawn->page, &error) == LMN_OK)
        mem_free(data.data);
    if (status == LMN_OK)
        lmn_text_free(lmn_sheet_report_json(drawn));
    lmn_sheet_destroy(&drawn);
}

void fuzz_draw(const uint8_t *bytes, size_t size)
{
    if (size <= DRAWING_CHOICES)
        return;
    lmn_look  *look = NULL;
    lmn_error  error;
    lmn_scene *scene = read_model(bytes[0], bytes + DRAWING_CHOICES, size - DRAWING_CHOICES);
    if (!scene || lmn_look_load(&look, lmn_look_name_at(bytes[1] % lmn_look_count()), &error) != LMN_OK) {
        scene_free(scene);
        return;
    }
    /* Looks that spread strokes over surfaces spread twenty thousand; with sanitizers these would take all the
     * time. Other looks have no such number. */
    lmn_look_set(look, "surface.count", "300", &error);
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.view = (lmn_view)(bytes[2] % 7);
    desc.orthographic = bytes[2] & 128;
    desc.width = bytes[3] % 64 + 1;
    desc.height = bytes[4] % 64 + 1;
    desc.samples = bytes[5] & 1 ? 4 : 1;
    desc.maps = bytes[5] & 2;
    desc.background = bytes[5] & 4 ? "none" : NULL;
    desc.fit = bytes[5] & 8 ? 8 : 0.9;
    desc.fov_deg = bytes[5] & 16 ? 170 : 30;
    desc.seed = bytes[5];
    desc.time_s = (bytes[6] - 16) / 16.0;
    if (bytes[7] & 128)
        draw_sheet(scene, look, &desc, bytes[7]);
    else
        draw_picture(scene, look, &desc);
    lmn_look_destroy(&look);
    scene_free(scene);
}
