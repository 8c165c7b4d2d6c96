#include "frames.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int frames_parse(const char *text, frame_range *out)
{
    int  used = 0;
    bool plain = isdigit((unsigned char)*text) != 0;
    *out = (frame_range){.given = true};
    if (!plain || sscanf(text, "%6ld:%6ld:%lf%n", &out->first, &out->last, &out->rate, &used) != 3 || text[used] ||
        out->last < out->first || !(out->rate > 0 && out->rate <= 1e6))
        return message_usage("for example --frames 0:47:24",
                             "--frames is '%s'; allowed is FIRST:LAST:FPS with FIRST up to LAST", text);
    return EXIT_DONE;
}

bool film_find(lmn_film_format_info *out, const char *ending)
{
    for (size_t i = 0; lmn_film_format_at(i, out); i++)
        if (strcmp(out->ending, ending) == 0)
            return true;
    *out = (lmn_film_format_info){.ending = ""};
    return false;
}

const char *film_list(char out[FORMAT_LIST_SIZE], bool dots)
{
    lmn_film_format_info f, next;
    size_t               used = 0;
    out[0] = '\0';
    for (size_t i = 0; lmn_film_format_at(i, &f) && used < FORMAT_LIST_SIZE; i++) {
        const char *before = i == 0 ? "" : lmn_film_format_at(i + 1, &next) ? ", " : " or ";
        used += (size_t)snprintf(out + used, FORMAT_LIST_SIZE - used, "%s%s", before, f.ending + (dots ? 0 : 1));
    }
    return out;
}

/* --- progress ------------------------------------------------------------------------------------------- */

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

/* ", 2 min 5 s left"; nothing before it can be told. The first frame, which also compiles shaders, counts only until
 * there is another one. */
static void write_left(const frame_run *r, char *out, size_t size)
{
    double now = now_ms();
    long   count = r->drawn > 1 ? r->drawn - 1 : r->drawn;
    out[0] = '\0';
    if (r->drawn == 0)
        return;
    double each = (now - (r->drawn > 1 ? r->warm_ms : r->begin_ms)) / (double)count,
           left = each * (double)(r->to_draw - r->drawn) / 1000;
    long seconds = left < 1e9 ? (long)(left + 0.999) : 1000000000;
    if (seconds >= 3600)
        snprintf(out, size, ", %ld h %ld min left", seconds / 3600, seconds / 60 % 60);
    else if (seconds >= 60)
        snprintf(out, size, ", %ld min %ld s left", seconds / 60, seconds % 60);
    else
        snprintf(out, size, ", %ld s left", seconds);
}

void frame_begin(frame_run *r, const frame_range *frames, long frame)
{
    char left[48];
    if (r->begin_ms == 0)
        r->begin_ms = now_ms();
    write_left(r, left, sizeof left);
    snprintf(r->label, sizeof r->label, "frame %ld of %ld%s", frame - frames->first + 1,
             frames->last - frames->first + 1, left);
    r->bar->label = r->label;
}

void frame_end(frame_run *r)
{
    if (r->drawn++ == 0)
        r->warm_ms = now_ms();
}

bool frame_report(double fraction, const char *stage, void *user)
{
    const frame_run *r = user;
    double           all = r->to_draw > 0 ? (double)r->to_draw : 1;
    return progress_report(((double)r->drawn + fraction) / all, stage, r->bar);
}

/* --- warnings ------------------------------------------------------------------------------------------- */

bool frame_said(frame_run *r, const char *text)
{
    for (size_t i = 0; i < r->said_count; i++)
        if (strcmp(r->said[i], text) == 0)
            return true;
    char  *copy = strdup(text);
    char **more = copy ? realloc(r->said, (r->said_count + 1) * sizeof *more) : NULL;
    if (more) {
        r->said = more;
        r->said[r->said_count++] = copy;
    } else {
        free(copy); /* said again next time, and no harm done */
    }
    return false;
}

/* --- films ---------------------------------------------------------------------------------------------- */

int film_begin(frame_run *r, const char *path, const lmn_film_desc *desc)
{
    lmn_error error = {0};
    return lmn_film_open(&r->film, path, desc, &error) == LMN_OK ? EXIT_DONE : message_error(&error);
}

static void print_warnings(const lmn_film *film)
{
    size_t times;
    for (size_t i = 0; i < lmn_film_warning_count(film); i++)
        message_warning(lmn_film_warning_at(film, i, NULL, &times), 1);
}

int film_end(frame_run *r, int status, bool quiet, uint64_t *bytes)
{
    lmn_error error = {0};
    if (r->film && status == EXIT_DONE) {
        if (!quiet)
            print_warnings(r->film);
        if (lmn_film_close(&r->film, bytes, &error) != LMN_OK)
            status = message_error(&error);
    }
    lmn_film_destroy(&r->film);
    return status;
}

void frame_run_release(frame_run *r)
{
    lmn_film_destroy(&r->film);
    for (size_t i = 0; i < r->said_count; i++)
        free(r->said[i]);
    free(r->said);
    free(r->there);
    *r = (frame_run){0};
}
