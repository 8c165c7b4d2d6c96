/* Models into pictures. */
#include "draw.h"

#include "cli.h"
#include "depict.h"
#include "names.h"
#include "sets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}
static int load_look(draw_session *s)
{
    lmn_error error = {0};
    if (lmn_look_load(&s->look,
                      s->values->look ? s->values->look
                      : s->depicts    ? "storyboard"
                                      : "edges",
                      &error) != LMN_OK)
        return message_error(&error);
    if (s->depicts && lmn_look_add_sign_rules(s->look, &error) != LMN_OK)
        return message_error(&error);
    int status = set_motion(s->look, s->values->motion, s->values->poses);
    if (status == EXIT_DONE)
        status = set_all(s->look, &s->values->sets, s->values->cut != NULL);
    if (status != EXIT_DONE)
        return status;
    if (s->values->cut && lmn_look_set(s->look, "scene.cut", s->values->cut, &error) != LMN_OK)
        return message_error(&error);
    return EXIT_DONE;
}

static void fill_desc(draw_session *s)
{
    const draw_values *v = s->values;
    lmn_draw_desc      d = LMN_DRAW_DESC_INIT;
    if (v->size.given) {
        d.width = v->size.width;
        d.height = v->size.height;
    }
    d.time_s = v->time.given ? v->time.value : d.time_s;
    d.time_given = v->time.given || v->frames;
    d.clip = v->clip;
    d.fit_time = v->fit_time;
    d.seed = v->seed.given ? (uint32_t)v->seed.value : d.seed;
    d.dpi = v->dpi.given ? v->dpi.value : d.dpi;
    d.samples = v->samples.given ? (int)v->samples.value : d.samples;
    d.background = v->background;
    d.select = v->select;
    d.lenient = v->lenient;
    d.maps = v->maps != NULL;
    d.profile = v->report != NULL;
    s->run.bar = &s->progress; /* the view is looked for before any frame */
    d.progress = s->frames.given ? frame_report : progress_report;
    d.progress_user = s->frames.given ? (void *)&s->run : &s->progress;
    s->desc = d;
}

/* The pixels of a page, or its resolution when they are given. */
static int lay_page(draw_session *s)
{
    enum { SCREEN_DPI = 96, SIDE_MOST = 16384 };
    lmn_draw_desc *d = &s->desc;
    lmn_error      error = {0};
    double         mm[2];
    if (!s->values->page)
        return EXIT_DONE;
    if (lmn_page_size(s->values->page, &mm[0], &mm[1], &error) != LMN_OK)
        return message_error(&error);
    if (s->format.vectors)
        return EXIT_DONE; /* the sheet is laid out by the library */
    double longer = fmax(mm[0], mm[1]) / 25.4, dpi = s->values->dpi.given ? s->values->dpi.value : SCREEN_DPI;
    if (s->values->size.given) {
        d->dpi = fmin(fmax((d->width > d->height ? d->width : d->height) / longer, 1), 10000);
        return EXIT_DONE;
    }
    if (longer * dpi > SIDE_MOST)
        return message_usage("give fewer --dpi",
                             "a page of %.0f x %.0f mm has %.0f pixels at %g an inch; allowed are %d", mm[0], mm[1],
                             longer * dpi, dpi, SIDE_MOST);
    d->width = (int)fmax(round(mm[0] / 25.4 * dpi), 1);
    d->height = (int)fmax(round(mm[1] / 25.4 * dpi), 1);
    d->dpi = dpi;
    return EXIT_DONE;
}

/* Target and up that were not given come from the scene; frames are fitted to its clips if it has any. */
static int place_view(draw_session *s, const lmn_scene *scene)
{
    const draw_values *v = s->values;
    lmn_scene_info     info = lmn_scene_info_of(scene);
    s->desc.fit_time = v->fit_time || ((v->frames || v->poses) && info.animations > 0);
    if (v->poses && !v->time.given && !v->frames) {
        s->desc.time_s = clip_end(scene, v->clip);
        s->desc.time_given = info.animations > 0;
    }
    return viewpoint_fill(&s->desc, &v->viewpoint, scene);
}

/* --- one picture ---------------------------------------------------------------------------------------- */

/* The library's report knows neither where the picture went nor how long the files took to read. A film has no size
 * before it is whole (`bytes` 0). */
static int store_report(char *drawn, const char *report, const char *picture, uint64_t bytes, double load_ms)
{
    json_t *json = parse_and_free(drawn);
    if (!json)
        return EXIT_INTERNAL;
    json_t *output = json_pack("{s:s}", "path", picture);
    if (bytes > 0)
        json_object_set_new(output, "bytes", json_integer((json_int_t)bytes));
    json_object_set_new(json, "output", output);
    if (!json_object_get(json, "load_ms"))
        json_object_set_new(json, "load_ms", json_real(load_ms));
    char *text = json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(json);
    if (!text)
        return message_out_of_memory();
    int status = store_text(report, text);
    if (status == EXIT_DONE && strcmp(report, "-") == 0)
        status = store_text("-", "\n");
    free(text);
    return status;
}

static int store_maps(const lmn_drawing *drawing, const char *folder)
{
    lmn_error error = {0};
    return lmn_drawing_write_maps(drawing, folder, &error) == LMN_OK ? EXIT_DONE : message_error(&error);
}

/* A picture or a sheet; one of them is NULL. */
typedef struct result {
    lmn_drawing *drawing;
    lmn_sheet   *sheet;
} result;

/* What only took longer stands in the report, and here for those who asked for more. */
static void print_warnings(draw_session *s, const result *r)
{
    bool   verbose = s->values->verbose;
    size_t count = r->sheet ? lmn_sheet_warning_count(r->sheet) : lmn_drawing_warning_count(r->drawing);
    for (size_t i = 0; i < count; i++) {
        size_t      times = 1;
        const char *code = NULL, *text = r->sheet ? lmn_sheet_warning_at(r->sheet, i, &code, &times)
                                                  : lmn_drawing_warning_at(r->drawing, i, &code, &times);
        if (!text || (!verbose && strcmp(code, "layer-memory") == 0) || (s->frames.given && frame_said(&s->run, text)))
            continue;
        progress_erase(&s->progress);
        message_warning(text, times);
    }
}

static lmn_status store_drawn(const draw_session *s, const result *r, const char *path, uint64_t *bytes,
                              lmn_error *error)
{
    if (s->run.film)
        return lmn_film_add(s->run.film, lmn_drawing_pixels(r->drawing, NULL, NULL), error);
    return r->sheet ? lmn_sheet_write(r->sheet, path, s->ending, bytes, error)
                    : lmn_drawing_write(r->drawing, path, s->ending, bytes, error);
}

static int store_result(const draw_session *s, const result *r, const char *input, long frame, double load_ms)
{
    const draw_values *v = s->values;
    lmn_error          error = {0};
    uint64_t           bytes = 0;
    int                status = EXIT_DONE;
    char *path = name_expand(s->pattern, input, frame), *maps = v->maps ? name_expand(v->maps, input, frame) : NULL;
    char *report = v->report ? name_expand(v->report, input, frame) : NULL;
    if (!path || (v->maps && !maps) || (v->report && !report))
        status = message_out_of_memory();
    /* The picture comes behind its maps and before its report, so that with --resume a frame that has both is done. */
    if (status == EXIT_DONE && maps)
        status = store_maps(r->drawing, maps);
    if (status == EXIT_DONE && store_drawn(s, r, path, &bytes, &error) != LMN_OK)
        status = message_error(&error);
    if (status == EXIT_DONE && report)
        status = store_report(r->sheet ? lmn_sheet_report_json(r->sheet) : lmn_drawing_report_json(r->drawing), report,
                              path, bytes, load_ms);
    if (status == EXIT_DONE && v->verbose && !s->run.film)
        message_note("wrote %s (%llu bytes)", path, (unsigned long long)bytes);
    free(path);
    free(maps);
    free(report);
    return status;
}

/* The words of a list with ';' between them; NULL: there are none. Free it. */
static bool join_words(char **out, const word_list *list)
{
    size_t size = 1, used = 0;
    for (size_t i = 0; i < list->count; i++)
        size += strlen(list->items[i]) + 1;
    *out = list->count ? malloc(size) : NULL;
    for (size_t i = 0; i < list->count && *out; i++)
        used += (size_t)snprintf(*out + used, size - used, "%s%s", i ? ";" : "", list->items[i]);
    return *out || !list->count;
}

static lmn_status draw_sheet(draw_session *s, const lmn_scene *scene, lmn_sheet **out, lmn_error *error)
{
    const double       groups[] = {0.25, 0.35, 0.5, 0.7};
    const draw_values *v = s->values;
    const word_list   *lists[4] = {&v->sections, &v->details, &v->auxiliary, &v->fields};
    char              *joined[4] = {NULL, NULL, NULL, NULL};
    bool               enough = true;
    for (int i = 0; i < 4 && enough; i++)
        enough = join_words(&joined[i], lists[i]);
    lmn_sheet_desc d = LMN_SHEET_DESC_INIT;
    d.page = v->page;
    d.scale = v->scale;
    d.unit = v->unit;
    d.views = v->views;
    d.angle = v->angle == 1 ? LMN_FIRST_ANGLE : LMN_THIRD_ANGLE;
    d.title = v->title;
    d.frame = v->frame;
    d.plotter = v->plotter;
    d.lines_only = !s->format.pictures;
    d.fill = v->fill;
    d.verify = v->verify;
    if (v->smooth.given)
        d.smooth = v->smooth.value;
    d.line_group = v->line_group >= 0 ? groups[v->line_group] : 0;
    d.centre_lines = v->centre_lines;
    d.loose_hatch = v->loose_hatch;
    d.threads = v->threads;
    d.sections = joined[0];
    d.details = joined[1];
    d.auxiliary = joined[2];
    d.fields = joined[3];
    lmn_status status = enough ? lmn_draw_sheet(out, s->renderer, scene, s->look, &s->desc, &d, error) : LMN_MEMORY;
    if (!enough)
        *error = (lmn_error){.status = LMN_MEMORY, .message = "out of memory"};
    for (int i = 0; i < 4; i++)
        free(joined[i]);
    return status;
}

static int draw_picture(draw_session *s, const lmn_scene *scene, const char *input, long frame, double load_ms)
{
    lmn_error error = {0};
    result    drawn = {NULL, NULL};
    double    start = now_ms();
    if (s->frames.given)
        s->desc.time_s = (double)frame / s->frames.rate;
    lmn_status done = s->format.vectors ? draw_sheet(s, scene, &drawn.sheet, &error)
                                        : lmn_draw(&drawn.drawing, s->renderer, scene, s->look, &s->desc, &error);
    /* From frame to frame the bar stays, unless something is said. */
    if (done != LMN_OK || s->values->verbose || !s->frames.given)
        progress_erase(&s->progress);
    if (done != LMN_OK)
        return message_error(&error);
    if (s->values->verbose)
        message_note("%s: %s%sdrawn in %.0f ms", input, s->run.label, s->frames.given ? ": " : "", now_ms() - start);
    if (!s->values->quiet)
        print_warnings(s, &drawn);
    int status = store_result(s, &drawn, input, frame, load_ms);
    lmn_drawing_destroy(&drawn.drawing);
    lmn_sheet_destroy(&drawn.sheet);
    return status;
}

/* --- all pictures --------------------------------------------------------------------------------------- */

static int worse_of(int a, int b)
{
    return a > b ? a : b;
}

bool draw_is_final(int status)
{
    return status == EXIT_GL || status == EXIT_CANCELLED || status == EXIT_INTERNAL;
}

/* The last frame is refused before the first is drawn. */
static int check_last_frame(const draw_session *s, const lmn_scene *scene)
{
    lmn_error     error = {0};
    lmn_draw_desc last = s->desc;
    if (!s->frames.given)
        return EXIT_DONE;
    last.time_s = (double)s->frames.last / s->frames.rate;
    return lmn_draw_check(scene, s->look, &last, s->format.vectors, &error) == LMN_OK ? EXIT_DONE
                                                                                      : message_error(&error);
}

/* --- frames --------------------------------------------------------------------------------------------- */

/* Is the picture of this frame there, and the report that is written behind it? */
static bool is_drawn(const draw_session *s, const char *input, long frame)
{
    struct stat facts;
    const char *pattern = s->values->report;
    char *path = name_expand(s->pattern, input, frame), *report = pattern ? name_expand(pattern, input, frame) : NULL;
    bool  there = path && lmn_picture_is_whole(path, s->desc.width, s->desc.height) &&
                 (!pattern || (report && stat(report, &facts) == 0 && facts.st_size > 0));
    free(path);
    free(report);
    return there;
}

/* Which frames are there already, or another shard's? */
static int find_drawn(draw_session *s, const char *input)
{
    size_t count = (size_t)(s->frames.last - s->frames.first + 1), there = 0;
    s->run.to_draw = (long)count;
    if (!s->values->resume && s->shard.count == 1)
        return EXIT_DONE;
    s->run.there = calloc(count, sizeof *s->run.there);
    if (!s->run.there)
        return message_out_of_memory();
    for (size_t i = 0; i < count && !progress_cancelled(); i++) {
        bool own = shard_has(&s->shard, (long)i);
        s->run.there[i] = !own || (s->values->resume && is_drawn(s, input, s->frames.first + (long)i));
        there += own && s->run.there[i];
        s->run.to_draw -= s->run.there[i];
    }
    if (there > 0 && !s->values->quiet)
        message_note("%zu of %zu frames are there already", there, (size_t)s->run.to_draw + there);
    return EXIT_DONE;
}

static lmn_film_desc film_desc_of(const draw_session *s)
{
    lmn_film_desc d = LMN_FILM_DESC_INIT;
    d.width = s->desc.width;
    d.height = s->desc.height;
    d.rate = s->frames.rate;
    d.frame_count = (uint32_t)(s->frames.last - s->frames.first + 1);
    d.format = s->ending;
    d.progress = progress_poll;
    return d;
}

/* What makes films is missed before anything is read. */
static int check_film(const draw_session *s)
{
    lmn_error     error = {0};
    lmn_film_desc d = film_desc_of(s);
    if (!s->film)
        return EXIT_DONE;
    return lmn_film_check(s->values->output ? s->values->output : s->ending, &d, &error) == LMN_OK
               ? EXIT_DONE
               : message_error(&error);
}

static int begin_film(draw_session *s, const char *input)
{
    lmn_film_desc d = film_desc_of(s);
    char         *path = name_expand(s->pattern, input, s->frames.first);
    int           status = path ? film_begin(&s->run, path, &d) : message_out_of_memory();
    free(path);
    return status;
}

static int end_film(draw_session *s, const char *input, int status)
{
    uint64_t bytes = 0;
    progress_erase(&s->progress);
    status = film_end(&s->run, status, s->values->quiet, &bytes);
    char *path = status == EXIT_DONE && s->values->verbose ? name_expand(s->pattern, input, s->frames.first) : NULL;
    if (path)
        message_note("wrote %s (%llu bytes)", path, (unsigned long long)bytes);
    free(path);
    return status;
}

static int draw_frames(draw_session *s, const lmn_scene *scene, const char *input, double load_ms)
{
    s->run = (frame_run){.bar = &s->progress};
    int status = find_drawn(s, input);
    if (status == EXIT_DONE && s->film)
        status = begin_film(s, input);
    for (long i = s->frames.first; i <= s->frames.last && status == EXIT_DONE; i++) {
        if (s->run.there && s->run.there[i - s->frames.first])
            continue;
        frame_begin(&s->run, &s->frames, i);
        status = draw_picture(s, scene, input, i, load_ms);
        frame_end(&s->run);
    }
    status = s->film ? end_film(s, input, status) : status;
    progress_erase(&s->progress);
    s->progress.label = "";
    frame_run_release(&s->run);
    return status;
}

/* Puts a bent scene in the place of one that is not seen as a single camera does. */
static int project(draw_session *s, lmn_scene **scene)
{
    const draw_values  *v = s->values;
    lmn_projection_desc d = LMN_PROJECTION_DESC_INIT;
    lmn_scene          *bent = NULL;
    lmn_error           error = {0};
    if (v->perspective <= 0)
        return EXIT_DONE;
    d.projection = (lmn_projection)(v->perspective - 1);
    d.angle_deg = v->bend.given ? v->bend.value : v->horizon.given ? v->horizon.value : 0;
    d.from = v->bend_from.given ? v->bend_from.value : d.from;
    d.to = v->bend_to.given ? v->bend_to.value : d.to;
    if (lmn_scene_project(&bent, *scene, &s->desc, &d, &error) != LMN_OK)
        return message_error(&error);
    lmn_scene_destroy(scene);
    *scene = bent;
    return EXIT_DONE;
}

static int draw_scene(draw_session *s, const char *const *paths, size_t count)
{
    lmn_scene            *scene = NULL;
    double                start = now_ms();
    const program_options programs = {&s->values->defines, s->values->strict,         s->values->lod,
                                      s->values->terrain,  s->values->populate.value, s->values->deflection.value};
    int status = scene_of_programs(&scene, paths, count, up_axis_of(s->values->up_axis), &programs, &s->progress);
    if (status != EXIT_DONE)
        return status;
    double load_ms = now_ms() - start;
    if (s->values->verbose)
        message_note("%s: read in %.0f ms", paths[0], load_ms);
    bool pixels = !s->format.vectors ||
                  (lmn_look_needs_pixels(s->look) && !s->values->plotter && !s->values->fill && s->format.pictures);
    /* Made when first needed, so that a missing input is told even where there is no OpenGL, and kept for the rest. */
    if (!s->renderer && pixels) {
        lmn_error         error = {0};
        lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
        if (lmn_renderer_create(&s->renderer, &desc, &error) != LMN_OK)
            status = message_error(&error);
    }
    if (status == EXIT_DONE)
        status = place_view(s, scene);
    if (status == EXIT_DONE && s->depicts)
        status = depict_scene(scene, &s->desc, s->values->expressions, s->values->interval, s->values->explain,
                              s->values->quiet);
    if (status == EXIT_DONE)
        status = project(s, &scene);
    if (status == EXIT_DONE)
        status = check_last_frame(s, scene);
    s->progress.label = paths[0];
    if (status == EXIT_DONE)
        status =
            s->frames.given ? draw_frames(s, scene, paths[0], load_ms) : draw_picture(s, scene, paths[0], 0, load_ms);
    lmn_scene_destroy(&scene);
    return status;
}

static int draw_all(draw_session *s, const word_list *inputs)
{
    int status = EXIT_DONE;
    if (!name_has_name(s->values->output))
        return draw_scene(s, inputs->items, inputs->count);
    for (size_t i = 0; i < inputs->count && !draw_is_final(status); i++)
        status = worse_of(status, progress_cancelled() ? EXIT_CANCELLED : draw_scene(s, &inputs->items[i], 1));
    return status;
}

int draw_run(const word_list *inputs, const draw_values *v, bool depicts)
{
    draw_session s = {.values = v, .depicts = depicts};
    int          status = draw_check(&s, inputs);
    if (status == EXIT_DONE)
        status = load_look(&s);
    if (status == EXIT_DONE && v->samples.given && s.format.vectors && !lmn_look_needs_pixels(s.look))
        status = message_usage(NULL, "--samples goes with pictures; with this look there are lines alone");
    char standard[64];
    snprintf(standard, sizeof standard, "%s%s",
             s.frames.given && !s.film ? NAME_PLACEHOLDER "-" FRAME_PLACEHOLDER : NAME_PLACEHOLDER, s.ending);
    s.pattern = v->output ? v->output : standard;
    if (status == EXIT_DONE && v->job.kind >= 0) {
        lmn_look_destroy(&s.look);
        return job_print(depicts ? &command_depict : &command_draw, inputs, v, &v->job, NULL);
    }
    progress_begin(&s.progress, v->quiet);
    fill_desc(&s);
    if (status == EXIT_DONE)
        status = lay_page(&s);
    if (status == EXIT_DONE)
        status = check_film(&s);
    lmn_task *task = NULL;
    if (status == EXIT_DONE)
        status = task_begin(&task, &v->task, &s.progress);
    if (status == EXIT_DONE)
        status = draw_all(&s, inputs);
    lmn_task_end(&task);
    lmn_renderer_destroy(&s.renderer);
    lmn_look_destroy(&s.look);
    return status;
}
