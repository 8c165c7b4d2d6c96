/* What `limner draw` is asked for: do its options go together? */
#include "draw.h"

#include "cli.h"
#include "names.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* The format: given, or the ending of the output. */
static void find_format(draw_session *s)
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

static int check_format(const draw_session *s)
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
static int check_capacity(const draw_session *s)
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
static int check_effect(const draw_session *s)
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
        {v->fields.count && !v->frame, "field", "stands in the title block of --frame"},
        {v->sections.count && !v->views, "section", "stands beside other --views, for example front,top"},
        {v->details.count && !v->views, "detail", "stands beside other --views, for example front,top"},
        {v->auxiliary.count && !v->views, "auxiliary", "stands beside other --views, for example front,top"},
        {v->verify && !v->report, "verify", "puts its result into the report; add --report FILE"},
        {v->viewpoint.fit.given && v->views, "fit", "does not go with --views, which fill the page"},
        {v->viewpoint.fit.given && v->scale, "fit", "does not go with --scale"},
    };
    for (size_t i = 0; i < OPTION_COUNT(rows); i++)
        if (rows[i].given)
            return message_usage(NULL, "--%s %s", rows[i].name, rows[i].why);
    return EXIT_DONE;
}

/* What a bent scene cannot be drawn with. */
static int check_perspective(const draw_session *s)
{
    enum { MULTI = 1, PANORAMA };
    const draw_values *v = s->values;
    bool               multi = v->perspective == MULTI, round = v->perspective == PANORAMA;
    const struct {
        bool        given;
        const char *name, *why;
    } rows[] = {
        {!multi && (v->bend.given || v->bend_from.given || v->bend_to.given), "bend", "goes with --perspective multi"},
        {!round && v->horizon.given, "horizon", "goes with --perspective panorama"},
        {round && !v->viewpoint.eye.given, "perspective", "panorama needs --eye X,Y,Z"},
        {round && (v->viewpoint.fov.given || v->viewpoint.orthographic || v->viewpoint.fit.given), "perspective",
         "panorama is as wide as --horizon says: it goes neither with --fov nor with --fit or --ortho"},
        {round && v->page, "perspective", "panorama has the shape of --size, not of --page"},
        {(multi || round) && v->frames, "perspective", "bends what stands still: it does not go with --frames"},
        {(multi || round) && v->fit_time, "perspective", "bends what stands still: it does not go with --fit-time"},
        {(multi || round) && v->poses, "perspective", "bends what stands still: it does not go with --poses"},
        {(multi || round) && (v->views || v->scale), "perspective",
         "has no scale: it goes neither with --views nor with --scale"},
        {(multi || round) && s->depicts, "perspective", "goes with `limner draw`"},
    };
    for (size_t i = 0; i < OPTION_COUNT(rows); i++)
        if (rows[i].given)
            return message_usage(NULL, "--%s %s", rows[i].name, rows[i].why);
    return EXIT_DONE;
}

/* Options of one kind of drawing that the other has not. */
static int check_vectors(const draw_session *s)
{
    const draw_values *v = s->values;
    const struct {
        const char *name;
        bool        given;
    } sheet_only[] = {{"scale", v->scale != NULL},
                      {"unit", v->unit != NULL},
                      {"views", v->views != NULL},
                      {"projection", v->angle >= 0},
                      {"title", v->title != NULL},
                      {"frame", v->frame},
                      {"plotter", v->plotter},
                      {"fill", v->fill},
                      {"verify", v->verify},
                      {"smooth", v->smooth.given},
                      {"field", v->fields.count > 0},
                      {"line-group", v->line_group >= 0},
                      {"centre-lines", v->centre_lines},
                      {"threads", v->threads != NULL},
                      {"loose-hatch", v->loose_hatch},
                      {"section", v->sections.count > 0},
                      {"detail", v->details.count > 0},
                      {"auxiliary", v->auxiliary.count > 0}};
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
    if (status == EXIT_DONE)
        status = check_perspective(s);
    if (status != EXIT_DONE)
        return status;
    if (v->views && (v->viewpoint.view >= 0 || v->viewpoint.eye.given || v->viewpoint.camera))
        return message_usage(NULL, "--views excludes --view, --eye and --camera");
    if (v->views && v->viewpoint.fov.given)
        return message_usage(NULL, "--views are in parallel projection; they have no --fov");
    if (v->scale && v->viewpoint.fov.given)
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
static int check_side_name(const draw_session *s, const char *option_name, const char *pattern)
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
static int check_frames(const draw_session *s)
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

static int check_output(const draw_session *s, const word_list *inputs)
{
    const draw_values *v = s->values;
    bool               to_standard = v->output && strcmp(v->output, "-") == 0;
    if (to_standard && v->report && strcmp(v->report, "-") == 0)
        return message_usage("write one of them into a file", "picture and report cannot both go to standard output");
    if (v->explain && (to_standard || (v->report && strcmp(v->report, "-") == 0)))
        return message_usage("write the other one into a file",
                             "what --explain prints and %s cannot both go to standard output",
                             to_standard ? "picture" : "report");
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

int draw_check(draw_session *s, const word_list *inputs)
{
    const draw_values *v = s->values;
    find_format(s);
    int status = viewpoint_check(&v->viewpoint);
    if (status == EXIT_DONE && v->time.given && v->frames)
        status = message_usage(NULL, "--time and --frames exclude each other");
    if (status == EXIT_DONE && v->quiet && v->verbose)
        status = message_usage(NULL, "--quiet and --verbose exclude each other");
    if (status == EXIT_DONE)
        status = check_samples(&v->samples);
    if (status == EXIT_DONE && v->frames)
        status = frames_parse(v->frames, &s->frames);
    if (status == EXIT_DONE)
        status = job_check(&v->job);
    if (status == EXIT_DONE)
        status = shard_parse(v->job.shard, &s->shard);
    if (status == EXIT_DONE)
        status = check_output(s, inputs);
    return status == EXIT_DONE ? check_programs(inputs, &(program_options){&v->defines, v->strict, NULL, NULL, 0})
                               : status;
}
