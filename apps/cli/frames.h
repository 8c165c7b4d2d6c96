/* Frames of `limner draw`: which there are, which were drawn before, how long the rest takes, and films of them. */
#ifndef LIMNER_CLI_FRAMES_H
#define LIMNER_CLI_FRAMES_H

#include "formats.h"
#include "message.h"

typedef struct frame_range {
    bool   given;
    long   first, last;
    double rate; /* frames a second */
} frame_range;

/* FIRST:LAST:FPS. Prints what is wrong; exit status. */
int frames_parse(const char *text, frame_range *out);

/* The film format of an ending (".mp4"), or false. */
bool film_find(lmn_film_format_info *out, const char *ending);
/* ".mp4, .webm, .gif or .webp", or without the dots. Returns `out`. */
const char *film_list(char out[FORMAT_LIST_SIZE], bool dots);

/* A run through frames. Zero-initialise. */
typedef struct frame_run {
    progress *bar;
    long      frame, last;    /* the one that is drawn */
    long      drawn, to_draw; /* in this run */
    double    begin_ms;       /* of the first; 0: not begun */
    double    warm_ms;        /* when the first was done, which takes longer than others */
    char      label[96];      /* what the bar says */
    bool     *there;          /* which need not be drawn, from the first on; NULL: all are drawn */
    char    **said;           /* warnings that were printed */
    size_t    said_count;
    lmn_film *film; /* what they go into; NULL: each into a file */
} frame_run;

/* Before a frame, and when it is done. */
void frame_begin(frame_run *r, const frame_range *frames, long frame);
void frame_end(frame_run *r);

/* lmn_progress_fn of a frame_run: the whole run as one bar. */
bool frame_report(double fraction, const char *stage, void *user);

/* Was this text asked about before? From now on it was. */
bool frame_said(frame_run *r, const char *text);

/* Opens the film; its warnings are printed when it is closed. Prints what goes wrong; exit status. */
int film_begin(frame_run *r, const char *path, const lmn_film_desc *desc);
/* Closes it after frames that went well (`status` EXIT_DONE), else leaves nothing of it. */
int film_end(frame_run *r, int status, bool quiet, uint64_t *bytes);

void frame_run_release(frame_run *r);

#endif
