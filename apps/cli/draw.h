/* limner draw, depict and simulate: what their options say, and one run of them. */
#ifndef LIMNER_CLI_DRAW_H
#define LIMNER_CLI_DRAW_H

#include "formats.h"
#include "frames.h"
#include "job.h"
#include "task.h"
#include "viewpoint.h"

typedef struct draw_values {
    const char   *output, *format, *look, *select, *cut, *frames, *background, *maps, *report;
    const char   *clip, *motion, *poses;
    const char   *expressions, *interval; /* of depict alone, with `explain` */
    const char   *page, *scale, *unit, *views, *title, *threads;
    word_list     sets, sections, details, auxiliary, fields;
    option_size   size;
    option_number time, seed, samples, dpi, smooth;
    int up_axis, angle, line_group, perspective; /* perspective: 0 that of a camera, else lmn_projection + 1 */
    option_number bend, bend_from, bend_to, horizon;
    const char   *lod, *terrain;
    option_number populate, deflection;
    word_list     defines;
    bool quiet, verbose, frame, plotter, centre_lines, loose_hatch, fill, verify, lenient, strict, fit_time, resume,
        explain;
    viewpoint_values viewpoint;
    job_values       job;
    task_values      task;
} draw_values;
/* One run of the command. */
typedef struct draw_session {
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
} draw_session;
/* Finds the format and checks that what is asked for goes together; prints what does not. Exit status. */
int draw_check(draw_session *s, const word_list *inputs);

/* Draws; with `depicts` signs of what happens, too. Prints what goes wrong; exit status. */
int draw_run(const word_list *inputs, const draw_values *v, bool depicts);

/* Would the next input fail for the same reason? A selection or a camera may be missing in this one alone. */
bool draw_is_final(int status);

#endif
