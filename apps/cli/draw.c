/* limner draw: models into pictures. */
#include "cli.h"
#include "depict.h"
#include "formats.h"
#include "frames.h"
#include "job.h"
#include "names.h"
#include "sets.h"
#include "task.h"

#include <ctype.h>
#include <stdio.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

typedef struct draw_values {
    const char   *output, *format, *look, *select, *cut, *camera, *frames, *background, *maps, *report;
    const char   *clip, *motion, *poses;
    const char   *expressions, *interval; /* of depict alone, with `explain` */
    const char   *page, *scale, *unit, *views, *title;
    word_list     sets;
    option_size   size;
    option_vector eye, target, up;
    option_number fov, fit, time, seed, samples, dpi;
    int           view, up_axis, angle;
    const char   *lod, *terrain;
    option_number populate;
    word_list     defines;
    bool        orthographic, quiet, verbose, frame, plotter, fill, verify, lenient, strict, fit_time, resume, explain;
    job_values  job;
    task_values task;
} draw_values;

static const char *const views[] = {"iso", "front", "back", "left", "right", "top", "bottom", NULL};

static const char *const angles[] = {"third", "first", NULL};

static void write_format_doc(char *out, size_t size)
{
    char pixels[FORMAT_LIST_SIZE], vectors[FORMAT_LIST_SIZE], films[FORMAT_LIST_SIZE];
    snprintf(out, size, "Format whatever the ending: %s, as vectors %s, or as films %s.",
             format_list(pixels, FORMATS_PIXELS, false), format_list(vectors, FORMATS_VECTORS, false),
             film_list(films, false));
}

#define AT(field) offsetof(draw_values, field)

static const option options[] = {
    {"output", 'o', OPTION_TEXT, AT(output), "OUT",
     "Picture to write; its ending is the format. {name} gives one picture for each INPUT, {frame} is the frame's "
     "number, - is "
     "standard output. Default: the first INPUT's stem and .png."},
    {"format", 0, OPTION_TEXT, AT(format), "FORMAT", .write_doc = write_format_doc},
    {"look", 'l', OPTION_TEXT, AT(look), "NAME|FILE", "Look: one of `limner looks`, or a file. Default: edges."},
    {"set", 's', OPTION_LIST, AT(sets), "KIND.PARAM=VALUE",
     "Set a parameter of the look, for all rules or with RULE:KIND.PARAM for one. May be repeated."},
    {"motion", 0, OPTION_TEXT, AT(motion), "WAY", .write_doc = write_motion_doc},
    {"poses", 0, OPTION_TEXT, AT(poses), "N|auto",
     "Several poses in one picture, at the moments that tell most of the motion up to --time (default: the end of the "
     "clip): where things turn back, rebound or stop. auto: as many as tell something. Laid over each other as on one "
     "plate; with --motion ghosts, echoes, comic or speed-lines as contours behind the last one. Fitted to all times."},
    {"select", 0, OPTION_TEXT, AT(select), "SEL",
     "Draw and fit only these parts, for example 'Wheel*' or '[material=Glass]'."},
    {"cut", 0, OPTION_TEXT, AT(cut), "SPEC",
     "Cut a section: x, -z=40%, 1,1,0@0,0,5 or box=50%,0%,50%:100%,100%,100%, several separated by ';'. The same as "
     "--set scene.cut=SPEC."},
    {"size", 0, OPTION_SIZE, AT(size), "WxH",
     "Picture size in pixels: how finely the drawing is seen. Its longer side is 271 mm (1024 px of 1/96 inch) unless "
     "--dpi or --page say otherwise. Default: 1024x1024.",
     1, 16384},
    {"dpi", 0, OPTION_NUMBER, AT(dpi), "N",
     "Pixels an inch, for lengths of looks, which are on paper. Default: what makes the longer side 271 mm; with "
     "--page 96.",
     1, 10000},
    {"view", 0, OPTION_CHOICE, AT(view), "VIEW", "iso, front, back, left, right, top or bottom. Default: iso.",
     .choices = views},
    {"eye", 0, OPTION_VECTOR, AT(eye), "X,Y,Z", "Where the viewer is, in the scene's unit."},
    {"target", 0, OPTION_VECTOR, AT(target), "X,Y,Z", "What the viewer looks at. Default: the scene's middle."},
    {"up", 0, OPTION_VECTOR, AT(up), "X,Y,Z", "Which way is up in the picture. Default: the scene's up axis."},
    {"camera", 0, OPTION_TEXT, AT(camera), "NAME", "A camera of the file."},
    {"ortho", 0, OPTION_FLAG, AT(orthographic), NULL, "Parallel projection."},
    {"fov", 0, OPTION_NUMBER, AT(fov), "DEG", "Vertical angle of view. Default: 30.", 1, 170},
    {"fit", 0, OPTION_NUMBER, AT(fit), "FACTOR",
     "Fraction of the frame that the model fills. With --eye only its direction counts then. Default: 0.9; with --eye "
     "nothing is fitted.",
     0.01, 10},
    {"time", 0, OPTION_NUMBER, AT(time), "SECONDS",
     "Draw the model as it is at this time of its animation; also the time of what changes by itself (perturb.boil, "
     "surface.change). Default: the model at rest.",
     -1e9, 1e9},
    {"clip", 0, OPTION_TEXT, AT(clip), "NAME|N",
     "Animations to draw, by name or number from 1 on; several separated by commas. Default: the first of each INPUT, "
     "when a time is given."},
    {"fit-time", 0, OPTION_FLAG, AT(fit_time), NULL,
     "Fit the picture to where the model comes at any time of its animation. Frames are always fitted so."},
    {"frames", 0, OPTION_TEXT, AT(frames), "FIRST:LAST:FPS",
     "One picture a frame, or a film of them (.mp4, .webm, .gif, .webp); frame i is at i/FPS seconds, and something "
     "must change with time."},
    {"resume", 0, OPTION_FLAG, AT(resume), NULL,
     "Of numbered pictures: go on where a run was broken off, drawing only frames whose picture is not there yet."},
    JOB_OPTIONS(draw_values),
    {"seed", 0, OPTION_WHOLE, AT(seed), "N", "Seed of everything random. Default: 0.", 0, 4294967295.0},
    {"samples", 0, OPTION_WHOLE, AT(samples), "N",
     "Samples a pixel: 1, 4, 9, 16, 25, 36, 49 or 64. Default: 1, and more for small pictures (below 64 --dpi).", 1,
     64},
    {"background", 0, OPTION_TEXT, AT(background), "COLOUR|none", "Ground of the picture. Default: the look's."},
    {"up-axis", 0, OPTION_CHOICE, AT(up_axis), "y|z", "Which of the file's axes points up. Default: the format's.",
     .choices = up_axis_choices},
    LOD_OPTION(AT(lod)),
    TERRAIN_OPTION(AT(terrain)),
    POPULATE_OPTION(AT(populate)),
    {"page", 0, OPTION_TEXT, AT(page), "PAGE",
     "Size of the paper: A4, A3-landscape, letter or 210x120mm. Pictures have --dpi pixels an inch of it, or --size in "
     "all. "
     "Default: the picture's size at its resolution."},
    {"scale", 0, OPTION_TEXT, AT(scale), "PAPER:MODEL",
     "Of vector drawings, in parallel projection: 1:20, 2:1. Default: as large as fits."},
    {"unit", 0, OPTION_TEXT, AT(unit), "UNIT",
     "Of the model, for scales: mm, cm, m or in. Default: the format's (glTF metres, others millimetres)."},
    {"views", 0, OPTION_TEXT, AT(views), "VIEW,VIEW…",
     "Of vector drawings: several views on one sheet, aligned and at one scale, for example front,top,right,iso."},
    {"projection", 0, OPTION_CHOICE, AT(angle), "third|first",
     "How --views lie: in third angle the top view is above, in first angle below. Default: third.", .choices = angles},
    {"title", 0, OPTION_TEXT, AT(title), "TEXT", "Title of a vector drawing."},
    {"frame", 0, OPTION_FLAG, AT(frame), NULL,
     "Frame and title block around a vector drawing; its scale is one of the usual ones."},
    {"plotter", 0, OPTION_FLAG, AT(plotter), NULL,
     "Vector drawings of lines alone, pen by pen, in an order that makes the pen's way short."},
    {"fill", 0, OPTION_FLAG, AT(fill), NULL,
     "Fill parts of vector drawings with their colour instead of a picture below the lines."},
    {"verify", 0, OPTION_FLAG, AT(verify), NULL,
     "Check the visibility of a vector drawing's lines by casting rays; the report has the result."},
    {"aov", 0, OPTION_TEXT, AT(maps), "DIR",
     "Write depth, normal, id, edge and shade maps into this folder, of sketches the field of uncertainty, too."},
    {"report", 0, OPTION_TEXT, AT(report), "FILE|-", "Write what was drawn as JSON."},
    TASK_OPTIONS(draw_values),
    {"define", 'D', OPTION_LIST, AT(defines), "NAME=VALUE",
     "Of OpenSCAD programs (.scad): a variable's value instead of the program's. May be repeated."},
    {"strict", 0, OPTION_FLAG, AT(strict), NULL, "Of OpenSCAD programs: warnings are errors."},
    {"lenient", 0, OPTION_FLAG, AT(lenient), NULL,
     "Draw what can be drawn and warn of the rest, instead of refusing it."},
    {"quiet", 'q', OPTION_FLAG, AT(quiet), NULL, "No warnings and no progress."},
    {"verbose", 'v', OPTION_FLAG, AT(verbose), NULL, "Say what is done and how long it takes."},
    DEPICT_OPTIONS(draw_values),
};

/* One run of the command. */
typedef struct session {
    const draw_values *values;
    const char        *pattern; /* of the output's name */
    frame_range        frames;
    shard              shard;
    frame_run          run;
    lmn_look          *look;
    lmn_renderer      *renderer;
    lmn_draw_desc      desc;
    char               ending[16]; /* of the format, ".svg"; empty: the path's */
    lmn_format_info    format;     /* asked before the work, not after it; of films: that of their frames */
    bool               known;      /* there is such a format */
    bool               film;       /* frames go into one file */
    bool               depicts;    /* signs are put into the scene before it is drawn */
    progress           progress;
} session;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

/* --- arguments ------------------------------------------------------------------------------------------ */

/* The format: given, or the ending of the output. */
static void find_format(session *s)
{
    const draw_values *v = s->values;
    const char        *dot = v->output ? strrchr(v->output, '.') : NULL;
    if (v->format)
        snprintf(s->ending, sizeof s->ending, "%s%s", *v->format == '.' ? "" : ".", v->format);
    else if (!v->output || strcmp(v->output, "-") == 0)
        snprintf(s->ending, sizeof s->ending, "%s", format_standard(false));
    else if (dot && !strchr(dot, '/'))
        snprintf(s->ending, sizeof s->ending, "%s", dot);
    for (char *c = s->ending; *c; c++)
        *c = (char)tolower((unsigned char)*c);
    s->known = format_find(&s->format, s->ending);
    lmn_film_format_info film;
    if (!s->known && film_find(&film, s->ending)) {
        s->known = s->film = format_find(&s->format, format_standard(false));
        s->format.ending = film.ending;
    }
}

static bool is_ending(const char *text)
{
    lmn_format_info      format;
    lmn_film_format_info film;
    return format_find(&format, text) || film_find(&film, text);
}

static int check_format(const session *s)
{
    const draw_values *v = s->values;
    const char        *dot = v->output ? strrchr(v->output, '.') : NULL;
    char               list[FORMAT_LIST_SIZE], films[FORMAT_LIST_SIZE], hint[3 * FORMAT_LIST_SIZE];
    if (s->known && v->format && dot && is_ending(dot) && strcmp(dot, s->ending) != 0)
        return message_usage(NULL, "the name '%s' says %s and --format says %s", v->output, dot + 1, s->ending + 1);
    if (s->known)
        return EXIT_DONE;
    if (v->format) {
        snprintf(hint, sizeof hint, "the format is %s; of films %s", format_list(list, FORMATS_ALL, false),
                 film_list(films, false));
        return message_usage(hint, "--format is '%s'; there is no such format", v->format);
    }
    snprintf(hint, sizeof hint, "the ending says the format: %s, of films %s; --format says it whatever the ending",
             format_list(list, FORMATS_ALL, true), film_list(films, true));
    return message_usage(hint, "%s: cannot tell the format from '%s'", v->output, *s->ending ? s->ending : v->output);
}

/* Options for which the format has no room. */
static int check_capacity(const session *s)
{
    const draw_values     *v = s->values;
    const lmn_format_info *f = &s->format;
    if (v->background && !f->ground)
        return message_usage(NULL, "--background does not go with %s, which has no ground", f->ending);
    if (v->fill && !f->areas)
        return message_usage(NULL, "--fill does not go with %s, which has no areas", f->ending);
    if (v->title && !f->title && !v->frame)
        return message_usage(NULL, "--title needs --frame in %s, which has no title of its own", f->ending);
    return EXIT_DONE;
}

/* Options that the others given leave without effect. */
static int check_effect(const session *s)
{
    const draw_values     *v = s->values;
    const lmn_format_info *f = &s->format;
    const struct {
        bool        given;
        const char *name, *why;
    } rows[] = {
        {v->samples.given && f->vectors && (!f->pictures || v->plotter || v->fill), "samples",
         "goes with pictures; here are lines and areas alone"},
        {v->fill && v->plotter, "fill", "does not go with --plotter, which draws lines alone"},
        {v->angle >= 0 && !v->views, "projection", "says how --views lie, and there are none"},
        {v->verify && !v->report, "verify", "puts its result into the report; add --report FILE"},
        {v->fit.given && v->camera, "fit", "does not go with --camera, which says how near the model is"},
        {v->fit.given && v->views, "fit", "does not go with --views, which fill the page"},
        {v->fit.given && v->scale, "fit", "does not go with --scale"},
        {v->orthographic && v->camera, "ortho", "does not go with --camera, which has a projection of its own"},
    };
    for (size_t i = 0; i < OPTION_COUNT(rows); i++)
        if (rows[i].given)
            return message_usage(NULL, "--%s %s", rows[i].name, rows[i].why);
    return EXIT_DONE;
}

/* Options of one kind of drawing that the other has not. */
static int check_vectors(const session *s)
{
    const draw_values *v = s->values;
    const struct {
        const char *name;
        bool        given;
    } sheet_only[] = {{"scale", v->scale != NULL},   {"unit", v->unit != NULL},   {"views", v->views != NULL},
                      {"projection", v->angle >= 0}, {"title", v->title != NULL}, {"frame", v->frame},
                      {"plotter", v->plotter},       {"fill", v->fill},           {"verify", v->verify}};
    char list[FORMAT_LIST_SIZE];
    for (size_t i = 0; i < OPTION_COUNT(sheet_only) && !s->format.vectors; i++)
        if (sheet_only[i].given)
            return message_usage("for example -o drawing.svg", "--%s goes with vector drawings: %s", sheet_only[i].name,
                                 format_list(list, FORMATS_VECTORS, true));
    if (s->format.vectors && v->maps)
        return message_usage("draw a .png for them", "--aov goes with pictures");
    int status = check_capacity(s);
    if (status == EXIT_DONE)
        status = check_effect(s);
    if (status != EXIT_DONE)
        return status;
    if (v->views && (v->view >= 0 || v->eye.given || v->camera))
        return message_usage(NULL, "--views excludes --view, --eye and --camera");
    if (v->views && v->fov.given)
        return message_usage(NULL, "--views are in parallel projection; they have no --fov");
    if (v->scale && v->fov.given)
        return message_usage(NULL, "--scale is for parallel projection; it excludes --fov");
    if (v->page && v->size.given && s->format.vectors)
        return message_usage(NULL, "--page and --size exclude each other");
    if (v->page && v->size.given && v->dpi.given)
        return message_usage("leave one of them out", "--page and --dpi say how many pixels there are, and --size too");
    return EXIT_DONE;
}

static int check_samples(const option_number *samples)
{
    for (int side = 1; side <= 8; side++)
        if (!samples->given || (int)samples->value == side * side)
            return EXIT_DONE;
    return message_usage(NULL, "--samples is '%d'; allowed is a square number: 1, 4, 9, 16, 25, 36, 49 or 64",
                         (int)samples->value);
}

/* {word} in a name is one of its positions. */
static int check_positions(const char *option_name, const char *pattern)
{
    int         length;
    const char *position = name_unknown_placeholder(pattern, &length);
    if (!position)
        return EXIT_DONE;
    if (strncmp(position, "{view}", 6) == 0)
        return message_usage("draw one view at a time with --view, or a sheet with --views",
                             "--%s has {view}, but there is one picture for all views", option_name);
    return message_usage("allowed are " NAME_PLACEHOLDER " and " FRAME_PLACEHOLDER,
                         "--%s has %.*s, which stands for nothing", option_name, length < 60 ? length : 60, position);
}

static bool is_same_file(const char *a, const char *b)
{
    struct stat one, other;
    return a && b && strcmp(a, "-") != 0 && strcmp(b, "-") != 0 &&
           (strcmp(a, b) == 0 || (stat(a, &one) == 0 && stat(b, &other) == 0 && S_ISREG(one.st_mode) &&
                                  one.st_dev == other.st_dev && one.st_ino == other.st_ino));
}

/* What is written must not be what is read, nor be written over. */
static int check_overwriting(const draw_values *v, const word_list *inputs)
{
    const char *written[] = {v->output, v->report};
    for (size_t i = 0; i < inputs->count; i++)
        for (int k = 0; k < 2; k++)
            if (is_same_file(written[k], inputs->items[i]))
                return message_usage(NULL, "--%s is '%s', which is an input", k ? "report" : "output", written[k]);
    if (is_same_file(v->output, v->report))
        return message_usage(NULL, "--output and --report are the same file");
    return EXIT_DONE;
}

/* Several pictures must not overwrite each other's side files. */
static int check_side_name(const session *s, const char *option_name, const char *pattern)
{
    if (!pattern || strcmp(pattern, "-") == 0)
        return EXIT_DONE;
    int status = check_positions(option_name, pattern);
    if (status != EXIT_DONE)
        return status;
    if (name_has_frame(pattern) && !s->frames.given)
        return message_usage(NULL, "--%s has {frame}, but there is no --frames", option_name);
    if (s->frames.given && !name_has_frame(pattern))
        return message_usage("put {frame} into the name", "--%s names one file for all frames", option_name);
    if (name_has_name(s->values->output) && !name_has_name(pattern))
        return message_usage("put {name} into the name", "--%s names one file for all inputs", option_name);
    return EXIT_DONE;
}

/* Do frames and their output go together? */
static int check_frames(const session *s)
{
    const draw_values *v = s->values;
    char               hint[2 * FORMAT_LIST_SIZE], list[FORMAT_LIST_SIZE];
    if (s->film && !s->frames.given)
        return message_usage("for example --frames 0:47:24", "%s is a film, which needs --frames FIRST:LAST:FPS",
                             s->ending);
    if (s->film && v->resume)
        return message_usage("draw numbered pictures (-o name-{frame}.png), which a later run can continue",
                             "--resume does not go with a film, which is written in one go");
    if (s->film && name_has_frame(v->output))
        return message_usage("leave {frame} out of its name", "-o has {frame}, but a film has all frames");
    if (v->resume && !s->frames.given)
        return message_usage("for example --frames 0:47:24", "--resume goes with frames, but there is no --frames");
    if (v->resume && strcmp(s->ending, format_standard(false)) != 0)
        return message_usage(NULL, "--resume goes with numbered pictures, *%s, which it can tell to be whole",
                             format_standard(false));
    if ((v->job.shard || v->job.kind >= 0) && (!s->frames.given || s->film))
        return message_usage("for example --frames 0:47:24 -o name-{frame}.png",
                             "--%s goes with frames as numbered pictures", v->job.shard ? "shard" : "job");
    if (v->job.kind >= 0 && strcmp(s->ending, format_standard(false)) != 0)
        return message_usage(NULL, "--job goes with numbered pictures, *%s, which a task can tell to be whole",
                             format_standard(false));
    if (v->output && s->frames.given && !s->film && !name_has_frame(v->output)) {
        snprintf(hint, sizeof hint, "put {frame} into the name, or make it a film: %s", film_list(list, true));
        return message_usage(hint, "-o names one file for all frames");
    }
    return EXIT_DONE;
}

static int check_output(const session *s, const word_list *inputs)
{
    const draw_values *v = s->values;
    bool               to_standard = v->output && strcmp(v->output, "-") == 0;
    if (to_standard && v->report && strcmp(v->report, "-") == 0)
        return message_usage("write one of them into a file", "picture and report cannot both go to standard output");
    if (to_standard && s->frames.given)
        return message_usage("use -o NAME-{frame}.png", "frames cannot go to standard output");
    if (name_has_frame(v->output) && !s->frames.given)
        return message_usage("for example --frames 0:47:24", "-o has {frame}, but there is no --frames");
    unsigned long same = name_has_name(v->output) ? name_find_same_stem(inputs->items, inputs->count) : 0;
    if (same)
        return message_usage("draw them in two runs, or rename one", "%s: another input has the same {name}",
                             inputs->items[same]);
    int status = check_format(s);
    if (status == EXIT_DONE)
        status = check_frames(s);
    if (status == EXIT_DONE)
        status = check_vectors(s);
    if (status == EXIT_DONE)
        status = check_positions("output", v->output);
    if (status == EXIT_DONE)
        status = check_overwriting(v, inputs);
    if (status == EXIT_DONE)
        status = check_side_name(s, "report", v->report);
    return status == EXIT_DONE ? check_side_name(s, "aov", v->maps) : status;
}

static int check_camera(const draw_values *v)
{
    if (v->orthographic && v->fov.given)
        return message_usage(NULL, "--ortho and --fov exclude each other");
    if (v->camera && (v->eye.given || v->view >= 0))
        return message_usage(NULL, "--camera excludes --eye and --view");
    if (v->eye.given && v->view >= 0)
        return message_usage(NULL, "--eye and --view exclude each other");
    if (!v->eye.given && (v->target.given || v->up.given))
        return message_usage("add --eye X,Y,Z", "--%s needs --eye", v->target.given ? "target" : "up");
    if (v->time.given && v->frames)
        return message_usage(NULL, "--time and --frames exclude each other");
    if (v->quiet && v->verbose)
        return message_usage(NULL, "--quiet and --verbose exclude each other");
    return check_samples(&v->samples);
}

static int load_look(session *s)
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

static void fill_desc(session *s)
{
    const draw_values *v = s->values;
    lmn_draw_desc      d = LMN_DRAW_DESC_INIT;
    if (v->size.given) {
        d.width = v->size.width;
        d.height = v->size.height;
    }
    if (v->view >= 0)
        d.view = (lmn_view)v->view;
    d.camera = v->camera;
    d.orthographic = v->orthographic;
    d.fov_deg = v->fov.given ? v->fov.value : d.fov_deg;
    d.fit = v->fit.given ? v->fit.value : d.fit;
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
    d.progress = s->frames.given ? frame_report : progress_report;
    d.progress_user = s->frames.given ? (void *)&s->run : &s->progress;
    s->desc = d;
}

/* The pixels of a page, or its resolution when they are given. */
static int lay_page(session *s)
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
static void place_view(session *s, const lmn_scene *scene)
{
    const draw_values *v = s->values;
    lmn_scene_info     info = lmn_scene_info_of(scene);
    s->desc.fit_time = v->fit_time || ((v->frames || v->poses) && info.animations > 0);
    if (v->poses && !v->time.given && !v->frames) {
        s->desc.time_s = clip_end(scene, v->clip);
        s->desc.time_given = info.animations > 0;
    }
    s->desc.eye_given = v->eye.given;
    s->desc.fit_direction = v->eye.given && v->fit.given;
    for (int i = 0; i < 3; i++) {
        s->desc.eye[i] = v->eye.value[i];
        s->desc.target[i] = v->target.given ? v->target.value[i] : (info.bounds_min[i] + info.bounds_max[i]) / 2;
        s->desc.up[i] = v->up.given ? v->up.value[i] : i == (info.up == 'z' ? 2 : 1) ? 1 : 0;
    }
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
static void print_warnings(session *s, const result *r)
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

static lmn_status store_drawn(const session *s, const result *r, const char *path, uint64_t *bytes, lmn_error *error)
{
    if (s->run.film)
        return lmn_film_add(s->run.film, lmn_drawing_pixels(r->drawing, NULL, NULL), error);
    return r->sheet ? lmn_sheet_write(r->sheet, path, s->ending, bytes, error)
                    : lmn_drawing_write(r->drawing, path, s->ending, bytes, error);
}

static int store_result(const session *s, const result *r, const char *input, long frame, double load_ms)
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

static lmn_status draw_sheet(session *s, const lmn_scene *scene, lmn_sheet **out, lmn_error *error)
{
    const draw_values *v = s->values;
    lmn_sheet_desc     d = LMN_SHEET_DESC_INIT;
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
    return lmn_draw_sheet(out, s->renderer, scene, s->look, &s->desc, &d, error);
}

static int draw_picture(session *s, const lmn_scene *scene, const char *input, long frame, double load_ms)
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

/* Would the next input fail for the same reason? A selection or a camera may be missing in this one alone. */
static bool is_final(int status)
{
    return status == EXIT_GL || status == EXIT_CANCELLED || status == EXIT_INTERNAL;
}

/* The last frame is refused before the first is drawn. */
static int check_last_frame(const session *s, const lmn_scene *scene)
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
static bool is_drawn(const session *s, const char *input, long frame)
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
static int find_drawn(session *s, const char *input)
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

static lmn_film_desc film_desc_of(const session *s)
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
static int check_film(const session *s)
{
    lmn_error     error = {0};
    lmn_film_desc d = film_desc_of(s);
    if (!s->film)
        return EXIT_DONE;
    return lmn_film_check(s->values->output ? s->values->output : s->ending, &d, &error) == LMN_OK
               ? EXIT_DONE
               : message_error(&error);
}

static int begin_film(session *s, const char *input)
{
    lmn_film_desc d = film_desc_of(s);
    char         *path = name_expand(s->pattern, input, s->frames.first);
    int           status = path ? film_begin(&s->run, path, &d) : message_out_of_memory();
    free(path);
    return status;
}

static int end_film(session *s, const char *input, int status)
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

static int draw_frames(session *s, const lmn_scene *scene, const char *input, double load_ms)
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

static int draw_scene(session *s, const char *const *paths, size_t count)
{
    lmn_scene            *scene = NULL;
    double                start = now_ms();
    const program_options programs = {&s->values->defines, s->values->strict, s->values->lod, s->values->terrain,
                                      s->values->populate.value};
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
    place_view(s, scene);
    if (status == EXIT_DONE && s->depicts)
        status = depict_scene(scene, &s->desc, s->values->expressions, s->values->interval, s->values->explain);
    if (status == EXIT_DONE)
        status = check_last_frame(s, scene);
    s->progress.label = paths[0];
    if (status == EXIT_DONE)
        status =
            s->frames.given ? draw_frames(s, scene, paths[0], load_ms) : draw_picture(s, scene, paths[0], 0, load_ms);
    lmn_scene_destroy(&scene);
    return status;
}

static int draw_all(session *s, const word_list *inputs)
{
    int status = EXIT_DONE;
    if (!name_has_name(s->values->output))
        return draw_scene(s, inputs->items, inputs->count);
    for (size_t i = 0; i < inputs->count && !is_final(status); i++)
        status = worse_of(status, progress_cancelled() ? EXIT_CANCELLED : draw_scene(s, &inputs->items[i], 1));
    return status;
}

static int run_as(const word_list *inputs, const draw_values *v, bool depicts)
{
    session s = {.values = v, .depicts = depicts};
    find_format(&s);
    int status = check_camera(v);
    if (status == EXIT_DONE && v->frames)
        status = frames_parse(v->frames, &s.frames);
    if (status == EXIT_DONE)
        status = job_check(&v->job);
    if (status == EXIT_DONE)
        status = shard_parse(v->job.shard, &s.shard);
    if (status == EXIT_DONE)
        status = check_output(&s, inputs);
    if (status == EXIT_DONE)
        status = check_programs(inputs, &(program_options){&v->defines, v->strict, NULL, NULL, 0});
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

static int run(const word_list *inputs, const void *values)
{
    return run_as(inputs, values, false);
}

/* What a script says counts where the command line says nothing. */
static int run_depict(const word_list *inputs, const void *values)
{
    draw_values full = *(const draw_values *)values;
    depiction   d = {.look = NULL};
    bool        viewed = full.view >= 0 || full.camera || full.eye.given;
    if (full.frames)
        return message_usage("draw one with --time, or a film with `limner simulate`",
                             "--frames does not go with depict, whose signs tell all times in one still");
    int status = inputs->count == 1 ? depiction_read(&d, inputs->items[0]) : EXIT_DONE;
    full.look = full.look ? full.look : d.look;
    full.camera = viewed ? full.camera : d.camera;
    full.time = full.time.given ? full.time : d.time;
    if (!full.expressions && d.has_expressions)
        full.expressions = inputs->items[0];
    for (int i = 0; d.view && !viewed && views[i]; i++)
        full.view = strcmp(views[i], d.view) == 0 ? i : full.view;
    if (status == EXIT_DONE && d.view && !viewed && full.view < 0)
        status = message_usage(NULL, "%s: there is no view '%.60s'", inputs->items[0], d.view);
    if (status == EXIT_DONE)
        status = run_as(inputs, &full, true);
    depiction_release(&d);
    return status;
}

/* --- what happens, from its begin to its end -------------------------------------------------------------- */

enum { SIMULATION_RATE = 24 };

/* Frames for the whole of the scene's first animation. */
static int find_whole(char *out, size_t size, const word_list *inputs, const draw_values *v)
{
    lmn_scene            *scene = NULL;
    progress              bar;
    lmn_task             *task = NULL;
    const program_options programs = {&v->defines, v->strict, v->lod, v->terrain, v->populate.value};
    double                duration = 0;
    progress_begin(&bar, true);
    int status = check_programs(inputs, &programs);
    if (status == EXIT_DONE)
        status = task_begin(&task, &v->task, &bar);
    if (status == EXIT_DONE)
        status = scene_of_programs(&scene, inputs->items, inputs->count, up_axis_of(v->up_axis), &programs, &bar);
    json_t *root = status == EXIT_DONE ? parse_and_free(lmn_scene_dynamics_json(scene)) : NULL;
    if (status == EXIT_DONE && !root)
        status = EXIT_INTERNAL;
    if (root)
        duration = number_at(root, "duration", 0);
    if (status == EXIT_DONE && !(duration > 0))
        status = message_usage("`limner draw` draws what stands still", "nothing happens in '%s'", inputs->items[0]);
    snprintf(out, size, "0:%.0f:%d", duration * SIMULATION_RATE, SIMULATION_RATE);
    json_decref(root);
    lmn_scene_destroy(&scene);
    lmn_task_end(&task);
    return status;
}

static int run_simulation(const word_list *inputs, const void *values)
{
    draw_values whole = *(const draw_values *)values;
    char        frames[64];
    int         status = EXIT_DONE;
    if (!whole.output && !whole.format)
        whole.format = "webp";
    if (!whole.frames) {
        status = find_whole(frames, sizeof frames, inputs, &whole);
        whole.frames = frames;
    }
    return status == EXIT_DONE ? run(inputs, &whole) : status;
}

const command command_simulate = {
    .name = "simulate",
    .inputs = "SCRIPT",
    .summary = "Play what happens in a script or model as frames.",
    .detail =
        "Draws the whole of it, 24 frames a second, into a film unless OUT has {frame}. Scripts: docs/SCRIPTS.md.\n"
        "Exit status: as `limner draw`.",
    .options = options,
    .option_count = OPTION_COUNT(options) - DEPICT_OPTION_COUNT,
    .values_size = sizeof(draw_values),
    .inputs_min = 1,
    .inputs_max = 1,
    .run = run_simulation,
};

const command command_draw = {
    .name = "draw",
    .inputs = "INPUT…",
    .summary = "Draw models into a picture or as vectors.",
    .detail = "Several INPUTs make one scene, unless OUT contains {name}: then one picture each.\n"
              "Exit status: 0 done, 1 wrong argument, 2 wrong input, 3 no OpenGL, 4 output not written, 5 cancelled,\n"
              "6 out of memory or a defect.",
    .options = options,
    .option_count = OPTION_COUNT(options) - DEPICT_OPTION_COUNT,
    .values_size = sizeof(draw_values),
    .inputs_min = 1,
    .inputs_max = (size_t)-1,
    .run = run,
};

const command command_depict = {
    .name = "depict",
    .inputs = "INPUT…",
    .summary = "Draw what happens in models: arrows, ghost images and signs in one still.",
    .detail =
        "Draws as `limner draw` does, with signs that tell the motion. What is told follows from what moves, or from\n"
        "--expressions (docs/DEPICTION.md).",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(draw_values),
    .inputs_min = 1,
    .inputs_max = (size_t)-1,
    .run = run_depict,
};
