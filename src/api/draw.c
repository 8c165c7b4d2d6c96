/* The public drawing calls: arguments are checked here, the work is done in src/draw. */
#include "limner/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/check_desc.h"
#include "api/complete.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_store.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"
#include "draw/maps.h"
#include "export/export.h"
#include "limner/version.h"
#include "plan/best_view.h"
#include "plan/refuse.h"
#include "plan/time.h"

static lmn_status missing(const char *caller, const char *what, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s: `%s` is NULL", caller, what);
}

const char *lmn_version(void)
{
    return LMN_VERSION;
}

lmn_status lmn_renderer_create(lmn_renderer **out, const lmn_renderer_desc *desc, lmn_error *error)
{
    lmn_renderer_desc full = LMN_RENDERER_DESC_INIT;
    const char       *wish = getenv("LIMNER_GL");
    if (!out)
        return missing("lmn_renderer_create", "out", error);
    *out = NULL;
    lmn_status status = desc ? desc_complete(&full, sizeof full, desc, "LMN_RENDERER_DESC_INIT", error) : LMN_OK;
    if (status != LMN_OK)
        return status;
    full.es = full.es || (wish && strcmp(wish, "es") == 0);
    return renderer_create(out, &full, error);
}

void lmn_renderer_destroy(lmn_renderer **renderer)
{
    renderer_destroy(renderer);
}

char *lmn_renderer_json(const lmn_renderer *renderer)
{
    return renderer ? renderer_json(renderer) : NULL;
}

static lmn_status check_range(lmn_error *error, const char *name, double value, double low, double high)
{
    if (value >= low && value <= high)
        return LMN_OK;
    return error_set(error, LMN_USAGE, "%s is %g, it must be between %g and %g", name, value, low, high);
}

static lmn_status check_numbers(const lmn_draw_desc *d, lmn_error *error)
{
    lmn_status status = check_range(error, "the width", d->width, 1, LIMIT_PICTURE_SIDE);
    if (status == LMN_OK)
        status = check_range(error, "the height", d->height, 1, LIMIT_PICTURE_SIDE);
    if (status == LMN_OK)
        status = check_range(error, "the view", d->view, LMN_VIEW_ISO, LMN_VIEW_BOTTOM);
    if (status == LMN_OK)
        status = check_range(error, "the field of view", d->fov_deg, 1, 170);
    if (status == LMN_OK)
        status = check_range(error, "fit", d->fit, 0.01, 10);
    if (status == LMN_OK)
        status = check_range(error, "the number of samples", d->samples, 0, 64);
    if (status == LMN_OK && d->dpi != 0)
        status = check_range(error, "the resolution", d->dpi, LIMIT_DPI_LEAST, LIMIT_DPI_MOST);
    int side = (int)lround(sqrt((double)d->samples));
    if (status == LMN_OK && side * side != d->samples)
        status =
            error_set(error, LMN_USAGE,
                      "the number of samples is %d, it must be a square number, 1, 4, 9, 16 … 64, or 0", d->samples);
    for (int k = 0; k < 3 && status == LMN_OK; k++)
        if (!isfinite(d->eye[k]) || !isfinite(d->target[k]) || !isfinite(d->up[k]))
            status = error_set(error, LMN_USAGE, "the camera's numbers must be finite");
    for (int k = 0; k < 16 && status == LMN_OK && d->matrices_given; k++)
        if (!isfinite(d->view_matrix[k]) || !isfinite(d->projection_matrix[k]))
            status = error_set(error, LMN_USAGE, "the matrices' numbers must be finite");
    if (status == LMN_OK && !isfinite(d->time_s))
        status = error_set(error, LMN_USAGE, "the time must be finite");
    return status;
}

/* A part of the picture lies inside it, and has pixels alone. */
static lmn_status check_window(const lmn_draw_desc *d, lmn_error *error)
{
    const int *w = d->window;
    if (w[2] == 0)
        return LMN_OK;
    if (w[0] < 0 || w[1] < 0 || w[2] < 0 || w[3] < 1 || w[0] > d->width - w[2] || w[1] > d->height - w[3])
        return error_set(error, LMN_USAGE, "the window %d,%d %dx%d does not lie in the picture of %dx%d pixels", w[0],
                         w[1], w[2], w[3], d->width, d->height);
    if (d->maps || d->profile || d->textures)
        return error_set(error, LMN_USAGE, "a window has neither maps nor a profile nor textures");
    return LMN_OK;
}

lmn_status check_draw_desc(lmn_draw_desc *full, const lmn_draw_desc *given, lmn_error *error)
{
    *full = (lmn_draw_desc)LMN_DRAW_DESC_INIT;
    lmn_status status = desc_complete(full, sizeof *full, given, "LMN_DRAW_DESC_INIT", error);
    if (status == LMN_OK)
        status = check_numbers(full, error);
    return status == LMN_OK ? check_window(full, error) : status;
}

lmn_status check_pixels(const lmn_draw_desc *d, lmn_error *error)
{
    int      side = samples_side(d), samples = side * side;
    uint64_t pixels = (uint64_t)d->width * (uint64_t)d->height * (uint64_t)samples, most = work_limits().pixels;
    if (!most || pixels <= most)
        return LMN_OK;
    return work_exceeded(error, "pixels",
                         "a picture of %dx%d pixels with %d samples each has %llu in all; allowed are %llu", d->width,
                         d->height, samples, (unsigned long long)pixels, (unsigned long long)most);
}

lmn_status lmn_draw_check(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, bool vectors,
                          lmn_error *error)
{
    if (!scene || !look)
        return error_set(error, LMN_USAGE, "a scene and a look are needed to draw");
    lmn_draw_desc full;
    lmn_status    status = check_draw_desc(&full, desc, error);
    refusal       r = {scene, status == LMN_OK && full.lenient, NULL, error};
    moment        when;
    if (status == LMN_OK)
        status = time_moment(&when, scene, &full, NULL, error);
    return status == LMN_OK ? refuse_time(&r, look, full.time_s, !vectors) : status;
}

lmn_status lmn_scene_best_view(const lmn_scene *scene, lmn_draw_desc *desc, lmn_error *error)
{
    lmn_draw_desc full;
    if (!scene || !desc)
        return error_set(error, LMN_USAGE, "lmn_scene_best_view: `%s` is NULL", scene ? "desc" : "scene");
    lmn_status status = check_draw_desc(&full, desc, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    status = best_view_find(&full, scene, error);
    status = work_end(&w, status, error);
    if (status == LMN_OK) { /* as much of it as the caller knows */
        const size_t known = desc->struct_size;
        memcpy(desc, &full, known);
        desc->struct_size = known;
    }
    return status;
}

/* Textures are of use where the caller's calls of OpenGL are. */
static lmn_status check_textures(const lmn_renderer *renderer, const lmn_draw_desc *d, lmn_error *error)
{
    if (!d->textures)
        return LMN_OK;
    if (d->profile)
        return error_set(error, LMN_USAGE, "a drawing with `textures` has no profile, whose frame is waited for");
    if (gpu_is_adopted(renderer->g))
        return LMN_OK;
    error_set(error, LMN_USAGE, "the renderer has a context of its own, whose textures nobody else can use");
    error_hint(error, "set `adopt` of its description, or leave `textures` away");
    return LMN_USAGE;
}

/* Is its picture in memory? */
static lmn_status check_read_back(const lmn_drawing *d, const char *caller, lmn_error *error)
{
    if (d->pixels)
        return LMN_OK;
    error_set(error, LMN_USAGE, "%s: the drawing lies on the GPU alone", caller);
    error_hint(error, "call lmn_drawing_read_back before the renderer draws again");
    return LMN_USAGE;
}

lmn_status lmn_draw(lmn_drawing **out, lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                    const lmn_draw_desc *desc, lmn_error *error)
{
    if (!out)
        return missing("lmn_draw", "out", error);
    *out = NULL;
    if (!renderer || !scene || !look)
        return error_set(error, LMN_USAGE, "a renderer, a scene and a look are needed to draw");
    lmn_draw_desc full;
    lmn_status    status = check_draw_desc(&full, desc, error);
    if (status == LMN_OK)
        status = check_textures(renderer, &full, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    status = check_pixels(&full, error);
    if (status == LMN_OK)
        status = renderer_draw(out, renderer, scene, look, &(draw_options){.desc = &full}, error);
    status = work_end(&w, status, error);
    if (status != LMN_OK)
        drawing_destroy(out);
    return status;
}

void lmn_drawing_destroy(lmn_drawing **drawing)
{
    drawing_destroy(drawing);
}

const uint8_t *lmn_drawing_pixels(const lmn_drawing *drawing, int *width, int *height)
{
    if (width)
        *width = drawing ? drawing->width : 0;
    if (height)
        *height = drawing ? drawing->height : 0;
    return drawing ? drawing->pixels : NULL;
}

lmn_status lmn_drawing_write(const lmn_drawing *drawing, const char *path, const char *format, uint64_t *bytes,
                             lmn_error *error)
{
    const export_format *chosen = NULL;
    if (!drawing || !path || !*path)
        return missing("lmn_drawing_write", drawing ? "path" : "drawing", error);
    lmn_status status = check_read_back(drawing, "lmn_drawing_write", error);
    if (status == LMN_OK)
        status = export_choose(&chosen, path, format, false, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, NULL, NULL);
    export_bytes data = {0};
    status = chosen->write_pixels(&data, drawing->pixels, drawing->width, drawing->height, error);
    if (status == LMN_OK)
        status = file_store(path, data.data, data.size, error);
    if (bytes)
        *bytes = data.size;
    mem_free(data.data);
    return status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
}

lmn_status lmn_drawing_write_part(const lmn_drawing *drawing, const int part[4], const char *path, const char *format,
                                  uint64_t *bytes, lmn_error *error)
{
    if (!drawing || !part)
        return missing("lmn_drawing_write_part", drawing ? "part" : "drawing", error);
    if (part[0] < 0 || part[1] < 0 || part[2] < 1 || part[3] < 1 || part[0] > drawing->width - part[2] ||
        part[1] > drawing->height - part[3])
        return error_set(error, LMN_USAGE, "the part %d,%d %dx%d does not lie in the picture of %dx%d pixels", part[0],
                         part[1], part[2], part[3], drawing->width, drawing->height);
    lmn_status status = check_read_back(drawing, "lmn_drawing_write_part", error);
    if (status != LMN_OK)
        return status;
    lmn_drawing cut = {.width = part[2], .height = part[3]};
    size_t      row = (size_t)part[2] * 4;
    if (!(cut.pixels = mem_alloc(row * (size_t)part[3])))
        return error_memory(error);
    for (size_t y = 0; y < (size_t)part[3]; y++)
        memcpy(cut.pixels + y * row,
               drawing->pixels + 4 * (((size_t)part[1] + y) * (size_t)drawing->width + (size_t)part[0]), row);
    status = lmn_drawing_write(&cut, path, format, bytes, error);
    mem_free(cut.pixels);
    return status;
}

lmn_status lmn_drawing_encode(const lmn_drawing *drawing, const char *format, uint8_t **bytes, size_t *size,
                              lmn_error *error)
{
    const export_format *chosen = NULL;
    export_bytes         data = {0};
    if (bytes)
        *bytes = NULL;
    if (!drawing || !format || !bytes || !size)
        return missing("lmn_drawing_encode",
                       !drawing  ? "drawing"
                       : !format ? "format"
                       : !bytes  ? "bytes"
                                 : "size",
                       error);
    lmn_status status = check_read_back(drawing, "lmn_drawing_encode", error);
    if (status == LMN_OK)
        status = export_choose(&chosen, "-", format, false, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, NULL, NULL);
    status = chosen->write_pixels(&data, drawing->pixels, drawing->width, drawing->height, error);
    if (status != LMN_OK) {
        mem_free(data.data);
        return work_end(&w, status, error);
    }
    *bytes = data.data;
    *size = data.size;
    return work_end_done(&w);
}

void lmn_bytes_free(uint8_t *bytes)
{
    mem_free(bytes);
}

lmn_status lmn_drawing_write_maps(const lmn_drawing *drawing, const char *directory, lmn_error *error)
{
    if (!drawing || !directory)
        return missing("lmn_drawing_write_maps", drawing ? "directory" : "drawing", error);
    lmn_status status = check_read_back(drawing, "lmn_drawing_write_maps", error);
    if (status != LMN_OK)
        return status;
    if (!drawing->maps.depth)
        return error_set(error, LMN_USAGE, "the drawing was made without its maps; set `maps` in its description");
    work w;
    work_begin(&w, NULL, NULL);
    status = maps_write(&drawing->maps, drawing->facts.part_count, directory, error);
    return status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
}

char *lmn_drawing_report_json(const lmn_drawing *drawing)
{
    return drawing ? drawing_report_json(drawing) : NULL;
}

size_t lmn_drawing_warning_count(const lmn_drawing *drawing)
{
    return drawing ? drawing->warnings.count : 0;
}

const char *lmn_drawing_warning_at(const lmn_drawing *drawing, size_t index, const char **code, size_t *count)
{
    if (!drawing || index >= drawing->warnings.count)
        return NULL;
    const warning *w = &drawing->warnings.items[index];
    if (code)
        *code = warning_code_text(w->code);
    if (count)
        *count = w->count;
    return w->text;
}

static lmn_status load_all(lmn_look **loaded, const char *const *names, size_t count, lmn_error *error)
{
    for (size_t i = 0; i < count; i++) {
        lmn_status status = lmn_look_load(&loaded[i], names[i], error);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

static lmn_status bench_looks(char **out, lmn_renderer *renderer, const lmn_scene *scene, const char *const *looks,
                              size_t look_count, const lmn_draw_desc *desc, int repeat, lmn_error *error)
{
    lmn_look **loaded = mem_calloc(look_count + 1, sizeof *loaded);
    if (!loaded)
        return error_memory(error);
    lmn_status status = load_all(loaded, (const char *const[]){"plain"}, 1, error);
    if (status == LMN_OK)
        status = load_all(loaded + 1, looks, look_count, error);
    if (status == LMN_OK)
        status = bench_json(out, renderer, scene, (const lmn_look *const *)(loaded + 1), look_count, loaded[0], desc,
                            repeat, error);
    for (size_t i = 0; i <= look_count; i++)
        lmn_look_destroy(&loaded[i]);
    mem_free(loaded);
    return status;
}

lmn_status lmn_bench_json(char **out, lmn_renderer *renderer, const lmn_scene *scene, const char *const *looks,
                          size_t look_count, const lmn_draw_desc *desc, int repeat, lmn_error *error)
{
    if (!out)
        return missing("lmn_bench_json", "out", error);
    *out = NULL;
    if (!looks && look_count)
        return missing("lmn_bench_json", "looks", error);
    if (!renderer || !scene)
        return error_set(error, LMN_USAGE, "a renderer and a scene are needed to measure");
    lmn_draw_desc full;
    lmn_status    status = check_draw_desc(&full, desc, error);
    if (status == LMN_OK)
        status = check_range(error, "the number of repeats", repeat, 1, 10000);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    status = check_pixels(&full, error);
    if (status == LMN_OK)
        status = bench_looks(out, renderer, scene, looks, look_count, &full, repeat, error);
    status = work_end(&w, status, error);
    if (status != LMN_OK) {
        mem_free(*out);
        *out = NULL;
    }
    return status;
}
