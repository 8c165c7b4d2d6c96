/* limner draw, depict and simulate. */
#include "draw.h"

#include "cli.h"
#include "depict.h"
#include "names.h"
#include "sets.h"

#include <stdio.h>
#include <string.h>

static const char *const angles[] = {"third", "first", NULL};
static const char *const line_groups[] = {"0.25", "0.35", "0.5", "0.7", NULL};
static const char *const perspectives[] = {"single", "multi", "panorama", NULL};

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
    VIEWPOINT_OPTIONS(draw_values),
    {"perspective", 0, OPTION_CHOICE, AT(perspective), "KIND",
     "single as one camera sees it, multi near at hand so and in the distance from above, as maps for tourists are "
     "drawn, or panorama around --eye. Default: single.",
     .choices = perspectives},
    {"bend", 0, OPTION_NUMBER, AT(bend), "DEG",
     "Of --perspective multi: how far the ground stands up in the distance. Default: so that it is seen from 65 "
     "degrees "
     "above.",
     1, 90},
    {"bend-from", 0, OPTION_NUMBER, AT(bend_from), "PART",
     "Where it begins to rise, of the way from the viewer to the far side. Default: 0.25.", 0, 1},
    {"bend-to", 0, OPTION_NUMBER, AT(bend_to), "PART", "Where it is as steep as it gets. Default: 0.75.", 0, 1},
    {"horizon", 0, OPTION_NUMBER, AT(horizon), "DEG",
     "Of --perspective panorama: how much of the horizon the picture is wide. Default: 180.", 30, 360},
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
    DEFLECTION_OPTION(AT(deflection)),
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
    {"field", 0, OPTION_LIST, AT(fields), "KEY=VALUE",
     "Of the title block of --frame, which then has all fields of ISO 7200: owner, number, date, sheet, creator, "
     "approver, type, department, reference, status, revision, language, supplement. May be repeated."},
    {"line-group", 0, OPTION_CHOICE, AT(line_group), "0.25|0.35|0.5|0.7",
     "Of vector drawings: widths of lines by ISO 128-2, outlines and edges so wide (mm), all else half of it. Default: "
     "widths of the look.",
     .choices = line_groups},
    {"centre-lines", 0, OPTION_FLAG, AT(centre_lines), NULL,
     "Of vector drawings in parallel projection: axes of cylinders, and pitch circles."},
    {"threads", 0, OPTION_TEXT, AT(threads), "SELECTOR",
     "Of vector drawings in parallel projection: parts whose threads are drawn by their symbol (ISO 6410-1), '*' for "
     "all: "
     "modelled ones, and cylinders of parts called M8 and the like. Default: as they are modelled."},
    {"loose-hatch", 0, OPTION_FLAG, AT(loose_hatch), NULL,
     "Of vector drawings: hatching of cut faces as one line after the other, for programs that know no patterns. "
     "Default: patterns where a face is seen as a whole."},
    {"section", 0, OPTION_LIST, AT(sections), "VIEW[@WHERE]",
     "Beside --views: a view cut open, with its cutting plane on another view. front, front@40%, front@10,50%,25 (in "
     "steps: at depth 10 up to half of the width, then at 25), front@half. May be repeated."},
    {"detail", 0, OPTION_LIST, AT(details), "VIEW@X,Y,Z/RADIUS[/SCALE]",
     "Beside --views: a part of a view, enlarged; for example front@10,0,25/4/5:1. May be repeated."},
    {"auxiliary", 0, OPTION_LIST, AT(auxiliary), "X,Y,Z",
     "Beside --views: a view along a direction, which points to the eye; or face@X,Y,Z, straight at the face nearest "
     "to "
     "this position. May be repeated."},
    {"plotter", 0, OPTION_FLAG, AT(plotter), NULL,
     "Vector drawings of lines alone, pen by pen, in an order that makes the pen's way short."},
    {"fill", 0, OPTION_FLAG, AT(fill), NULL,
     "Fill parts of vector drawings with their colour instead of a picture below the lines."},
    {"smooth", 0, OPTION_NUMBER, AT(smooth), "ERROR",
     "Of vector drawings: lines become straight lines, arcs and cubics that are nowhere farther from them than this, "
     "in "
     "mm of paper; 0 leaves polylines. Default: 0.02mm.",
     0, 10, .unit = "mm"},
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
static int run(const word_list *inputs, const void *values)
{
    return draw_run(inputs, values, false);
}

/* What the first of the files that says anything of its still says. Exit status; release it also after one. */
static int find_depiction(depiction *out, const char **source, const word_list *inputs)
{
    int status = EXIT_DONE;
    *source = NULL;
    *out = (depiction){.look = NULL};
    for (size_t i = 0; i < inputs->count && !*source && status == EXIT_DONE; i++) {
        depiction_release(out);
        status = depiction_read(out, inputs->items[i]);
        if (out->look || out->camera || out->view || out->time.given || out->has_expressions)
            *source = inputs->items[i];
    }
    return status;
}

/* One still. What a script says counts where the command line says nothing. */
static int depict_one(const word_list *inputs, const draw_values *values)
{
    draw_values full = *values;
    depiction   d;
    const char *source;
    bool        viewed = viewpoint_given(&full.viewpoint);
    int         status = find_depiction(&d, &source, inputs);
    full.look = full.look ? full.look : d.look;
    full.viewpoint.camera = viewed ? full.viewpoint.camera : d.camera;
    full.time = full.time.given ? full.time : d.time;
    if (!full.expressions && d.has_expressions)
        full.expressions = source;
    for (int i = 0; d.view && !viewed && viewpoint_names[i]; i++)
        full.viewpoint.view = strcmp(viewpoint_names[i], d.view) == 0 ? i : full.viewpoint.view;
    if (status == EXIT_DONE && d.view && !viewed && full.viewpoint.view < 0)
        status = message_usage(NULL, "%s: there is no view '%.60s'", source, d.view);
    if (status == EXIT_DONE)
        status = draw_run(inputs, &full, true);
    depiction_release(&d);
    return status;
}

/* A still of each file is what that file says; the worst of their statuses. */
static int run_depict(const word_list *inputs, const void *values)
{
    const draw_values *v = values;
    if (v->frames)
        return message_usage("draw one with --time, or a film with `limner simulate`",
                             "--frames does not go with depict, whose signs tell all times in one still");
    if (inputs->count < 2 || !name_has_name(v->output))
        return depict_one(inputs, v);
    unsigned long same = name_find_same_stem(inputs->items, inputs->count);
    if (same)
        return message_usage("draw them in two runs, or rename one", "%s: another input has the same {name}",
                             inputs->items[same]);
    int status = EXIT_DONE;
    for (size_t i = 0; i < inputs->count && !draw_is_final(status); i++) {
        const word_list one = {&inputs->items[i], 1};
        int             each = progress_cancelled() ? EXIT_CANCELLED : depict_one(&one, v);
        status = each > status ? each : status;
    }
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
    const program_options programs = {&v->defines, v->strict,         v->lod,
                                      v->terrain,  v->populate.value, v->deflection.value};
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
        "--expressions (docs/DEPICTION.md). Defaults of its own, unless a script says others: the look storyboard, "
        "and\n"
        "the time at six tenths of the animation, or of --interval.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(draw_values),
    .inputs_min = 1,
    .inputs_max = (size_t)-1,
    .run = run_depict,
};
