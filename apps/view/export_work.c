#include "export_work.h"

#include <math.h>
#include <string.h>

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strchr(dot, '/') ? dot : "";
}

GStrv export_endings(void)
{
    GStrvBuilder        *out = g_strv_builder_new();
    lmn_format_info      format;
    lmn_film_format_info film;
    for (size_t i = 0; lmn_format_at(i, &format); i++)
        g_strv_builder_add(out, format.ending);
    for (size_t i = 0; lmn_film_format_at(i, &film); i++)
        if (film.usable)
            g_strv_builder_add(out, film.ending);
    GStrv endings = g_strv_builder_end(out);
    g_strv_builder_unref(out);
    return endings;
}

static bool find_format(const char *path, lmn_format_info *out)
{
    for (size_t i = 0; lmn_format_at(i, out); i++)
        if (g_ascii_strcasecmp(out->ending, ending_of(path)) == 0)
            return true;
    return false;
}

bool export_is_film(const char *path)
{
    lmn_film_format_info film;
    for (size_t i = 0; lmn_film_format_at(i, &film); i++)
        if (g_ascii_strcasecmp(film.ending, ending_of(path)) == 0)
            return true;
    return false;
}

typedef struct work {
    scene_ref         *scene;
    const view_state  *state;
    const export_wish *wish;
    lmn_renderer      *renderer;
    lmn_draw_desc      desc;
    lmn_progress_fn    progress;
    void              *user;
    double             done, share; /* of the whole, before this drawing and of it */
} work;

static bool tell(double fraction, const char *stage, void *data)
{
    work *w = data;
    return !w->progress || w->progress(w->done + w->share * fraction, stage, w->user);
}

static lmn_status write_picture(work *w, lmn_error *error)
{
    lmn_drawing *drawing = NULL;
    lmn_status   status = lmn_draw(&drawing, w->renderer, w->scene->scene, w->state->look->look, &w->desc, error);
    if (status == LMN_OK)
        status = lmn_drawing_write(drawing, w->wish->path, NULL, NULL, error);
    lmn_drawing_destroy(&drawing);
    return status;
}

static lmn_status write_sheet(work *w, const lmn_format_info *format, lmn_error *error)
{
    lmn_sheet     *sheet = NULL;
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    desc.lines_only = !format->pictures;
    bool       pixels = format->pictures && lmn_look_needs_pixels(w->state->look->look);
    lmn_status status = lmn_draw_sheet(&sheet, pixels ? w->renderer : NULL, w->scene->scene, w->state->look->look,
                                       &w->desc, &desc, error);
    if (status == LMN_OK)
        status = lmn_sheet_write(sheet, w->wish->path, NULL, NULL, error);
    lmn_sheet_destroy(&sheet);
    return status;
}

static lmn_status add_frame(work *w, lmn_film *film, lmn_error *error)
{
    lmn_drawing *drawing = NULL;
    lmn_status   status = lmn_draw(&drawing, w->renderer, w->scene->scene, w->state->look->look, &w->desc, error);
    if (status == LMN_OK)
        status = lmn_film_add(film, lmn_drawing_pixels(drawing, NULL, NULL), error);
    lmn_drawing_destroy(&drawing);
    return status;
}

static lmn_status write_film(work *w, lmn_error *error)
{
    const export_wish *wish = w->wish;
    double             rate = wish->rate > 0 ? wish->rate : 24;
    long               first = (long)floor(wish->first * rate + 0.5), last = (long)floor(wish->last * rate + 0.5);
    lmn_film          *film = NULL;
    lmn_film_desc      desc = LMN_FILM_DESC_INIT;
    desc.width = wish->width;
    desc.height = wish->height;
    desc.rate = rate;
    desc.frame_count = (uint32_t)(MAX(last, first) - first + 1);
    w->share = 1.0 / desc.frame_count;
    w->desc.time_given = true;
    w->desc.clip = w->state->clip;
    w->desc.fit_time = w->scene->info.animations > 0;
    lmn_status status = lmn_film_open(&film, wish->path, &desc, error);
    for (uint32_t i = 0; i < desc.frame_count && status == LMN_OK; i++) {
        w->done = i * w->share;
        w->desc.time_s = (double)(first + (long)i) / rate;
        status = add_frame(w, film, error);
    }
    if (status == LMN_OK)
        status = lmn_film_close(&film, NULL, error);
    lmn_film_destroy(&film);
    return status;
}

lmn_status export_draw(scene_ref *scene, const view_state *s, const export_wish *wish, lmn_renderer *renderer,
                       lmn_progress_fn progress, void *user, lmn_error *error)
{
    lmn_format_info format;
    char           *selector = state_selector(s, scene);
    work            w = {scene, s, wish, renderer, .progress = progress, .user = user, .share = 1};
    state_describe(s, selector, wish->width, wish->height, &w.desc);
    w.desc.samples = wish->samples;
    w.desc.background = wish->transparent ? "none" : NULL;
    w.desc.progress = tell;
    w.desc.progress_user = &w;
    lmn_status status = scene_ref_edit(scene, s->edits, error);
    if (status == LMN_OK && export_is_film(wish->path))
        status = write_film(&w, error);
    else if (status == LMN_OK && find_format(wish->path, &format) && format.vectors)
        status = write_sheet(&w, &format, error);
    else if (status == LMN_OK)
        status = write_picture(&w, error);
    g_free(selector);
    return status;
}
