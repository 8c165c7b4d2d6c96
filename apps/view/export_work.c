#include "export_work.h"

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

bool export_is_film(const char *path)
{
    lmn_format_info format;
    return wish_kind_of(path, &format) == WISH_FILM;
}

typedef struct work {
    const scene_ref   *scene;
    const view_state  *state;
    const export_wish *wish;
    lmn_renderer      *renderer;
    const lmn_look    *look; /* the state's, or with signs one that knows of them */
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

/* Of films: may it go on? The frames say how far it is. */
static bool poll(double fraction, const char *stage, void *data)
{
    (void)fraction;
    return tell(1, stage, data);
}

static lmn_status draw(const work *w, lmn_drawing **out, lmn_error *error)
{
    return lmn_draw(out, w->renderer, w->scene->scene, w->look, &w->desc, error);
}

static lmn_status write_picture(work *w, lmn_error *error)
{
    lmn_drawing *drawing = NULL;
    lmn_status   status = draw(w, &drawing, error);
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
    lmn_status status = lmn_draw_sheet(&sheet, w->renderer, w->scene->scene, w->look, &w->desc, &desc, error);
    if (status == LMN_OK)
        status = lmn_sheet_write(sheet, w->wish->path, NULL, NULL, error);
    lmn_sheet_destroy(&sheet);
    return status;
}

static lmn_status add_frame(work *w, lmn_film *film, lmn_error *error)
{
    lmn_drawing *drawing = NULL;
    lmn_status   status = draw(w, &drawing, error);
    if (status == LMN_OK)
        status = lmn_film_add(film, lmn_drawing_pixels(drawing, NULL, NULL), error);
    lmn_drawing_destroy(&drawing);
    return status;
}

/* The last frame is refused before the first is drawn. */
static lmn_status check_last(const work *w, double time_s, lmn_error *error)
{
    lmn_draw_desc last = w->desc;
    last.time_s = time_s;
    return lmn_draw_check(w->scene->scene, w->look, &last, false, error);
}

static lmn_status write_film(work *w, lmn_error *error)
{
    const export_wish *wish = w->wish;
    long               first, last;
    lmn_film          *film = NULL;
    lmn_film_desc      desc = LMN_FILM_DESC_INIT;
    wish_frames(wish, &first, &last);
    desc.width = wish->width;
    desc.height = wish->height;
    desc.rate = wish->rate;
    desc.frame_count = (uint32_t)(last - first + 1);
    desc.progress = poll;
    desc.progress_user = w;
    w->share = 1.0 / desc.frame_count;
    lmn_status status = lmn_film_check(wish->path, &desc, error);
    if (status == LMN_OK)
        status = check_last(w, (double)last / wish->rate, error);
    if (status == LMN_OK)
        status = lmn_film_open(&film, wish->path, &desc, error);
    for (uint32_t i = 0; i < desc.frame_count && status == LMN_OK; i++) {
        w->done = i * w->share;
        w->desc.time_s = (double)(first + (long)i) / wish->rate;
        status = add_frame(w, film, error);
    }
    if (status == LMN_OK)
        status = lmn_film_close(&film, NULL, error);
    lmn_film_destroy(&film);
    return status;
}

static bool needs_renderer(const work *w)
{
    lmn_format_info format;
    return wish_kind_of(w->wish->path, &format) != WISH_SHEET ||
           (format.pictures && lmn_look_needs_pixels(w->state->look->look));
}

static lmn_status write_file(work *w, lmn_error *error)
{
    lmn_format_info format;
    switch (wish_kind_of(w->wish->path, &format)) {
    case WISH_FILM: return write_film(w, error);
    case WISH_SHEET: return write_sheet(w, &format, error);
    default: return write_picture(w, error);
    }
}

/* With signs it is the artist who draws it, and whose scene has them. */
static lmn_status prepare(work *w, lmn_look **signs, lmn_error *error)
{
    lmn_format_info format;
    w->look = w->state->look->look;
    if (!w->state->told)
        return LMN_OK;
    if (wish_kind_of(w->wish->path, &format) == WISH_FILM) {
        *error = (lmn_error){.status = LMN_USAGE};
        g_snprintf(error->message, sizeof error->message,
                   "signs tell all times in one still, and have no place in a film");
        g_snprintf(error->hint, sizeof error->hint, "take the signs away first");
        return LMN_USAGE;
    }
    return scene_ref_prepare((scene_ref *)w->scene, w->state, &w->desc, &w->look, signs, error);
}

/* Into the file, or into `out` where it is given; with the renderer, or with one that is made for it. */
static lmn_status begin(work *w, lmn_drawing **out, lmn_error *error)
{
    lmn_renderer     *own = NULL;
    lmn_look         *signs = NULL;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    lmn_status        status = LMN_OK;
    char             *selector = state_selector(w->state, w->scene);
    wish_describe(w->state, w->scene, w->wish, selector, &w->desc);
    w->desc.progress = tell;
    w->desc.progress_user = w;
    w->share = 1;
    if (!needs_renderer(w))
        w->renderer = NULL;
    else if (!w->renderer)
        status = lmn_renderer_create(&own, &desc, error);
    if (own)
        w->renderer = own;
    if (status == LMN_OK)
        status = prepare(w, &signs, error);
    if (status == LMN_OK)
        status = out ? draw(w, out, error) : write_file(w, error);
    lmn_look_destroy(&signs);
    lmn_renderer_destroy(&own);
    g_free(selector);
    return status;
}

lmn_status export_draw(const scene_ref *scene, const view_state *s, const export_wish *wish, lmn_renderer *renderer,
                       lmn_progress_fn progress, void *user, lmn_error *error)
{
    work w = {scene, s, wish, renderer, .progress = progress, .user = user};
    return begin(&w, NULL, error);
}

lmn_status export_picture(lmn_drawing **out, const scene_ref *scene, const view_state *s, export_wish wish,
                          lmn_renderer *renderer, lmn_progress_fn progress, void *user, lmn_error *error)
{
    wish.path = ".png";
    work w = {scene, s, &wish, renderer, .progress = progress, .user = user};
    return begin(&w, out, error);
}
