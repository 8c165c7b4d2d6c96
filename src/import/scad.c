/* OpenSCAD programs (.scad): the program `openscad` evaluates them to .csg; a .scad file is a program, and only
 * OpenSCAD knows its language. */
#define _GNU_SOURCE
#include <ctype.h>
#include <limits.h>
#include <string.h>
#include <sys/wait.h>

#include "base/error.h"
#include "base/file_temporary.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/csg.h"
#include "import/openscad.h"

/* --- what the program is given -------------------------------------------------------------------------- */

static size_t define_count(const openscad_run *e)
{
    return e->job->desc ? e->job->desc->define_count : 0;
}

/* How long the name before '=' is; 0: this is no definition. */
static size_t name_length(const char *define)
{
    size_t length = 0;
    while (isalnum((unsigned char)define[length]) || define[length] == '_' || (length == 0 && define[0] == '$'))
        length++;
    bool named = length > (define[0] == '$') && !isdigit((unsigned char)define[0]);
    return named && define[length] == '=' && define[length + 1] ? length : 0;
}

/* Has the program's own text this word? What it includes is not looked at. */
static bool has_word(const file_data *file, const char *word, size_t length)
{
    const char *begin = (const char *)file->data, *end = begin + file->size;
    for (const char *at = begin; (at = memmem(at, (size_t)(end - at), word, length)) != NULL; at++) {
        char before = at > begin ? at[-1] : ' ', after = at + length < end ? at[length] : ' ';
        if (!isalnum((unsigned char)before) && before != '_' && !isalnum((unsigned char)after) && after != '_')
            return true;
    }
    return false;
}

static lmn_status check_defines(openscad_run *e)
{
    const file_data *file = e->job->file;
    bool             alone = !has_word(file, "include", 7) && !has_word(file, "use", 3);
    for (size_t i = 0; i < define_count(e); i++) {
        const char *define = e->job->desc->defines[i];
        size_t      length = define ? name_length(define) : 0;
        if (!length) {
            error_in_file(
                e->error, LMN_USAGE, e->job->path, 0,
                "the definition is '%.80s'; allowed is NAME=VALUE, where the name has letters, digits and '_'",
                define ? define : "");
            error_hint(e->error, "for example -D width=20 or -D 'name=\"lid\"'");
            return LMN_USAGE;
        }
        if (alone && define[0] != '$' && !has_word(file, define, length))
            warnings_add(&e->job->scene->warnings, WARNING_NO_MATCH,
                         "the program has no variable '%.*s' that the definition could change", (int)length, define);
    }
    return LMN_OK;
}

/* --- what it says --------------------------------------------------------------------------------------- */

static void pass_warning(const openscad_run *e, const char *line)
{
    warnings_add(&e->job->scene->warnings, WARNING_BAD_VALUE, "openscad: %s", line);
}

/* The program's line, where the message tells one: "… in file model.scad, line 3". What it includes has lines of
 * its own. */
static int line_of(const openscad_run *e, const char *message)
{
    const char *own = strrchr(e->job->path, '/'), *at = NULL;
    own = own ? own + 1 : e->job->path;
    size_t length = strlen(own);
    for (const char *next = message; (next = strstr(next, "in file ")) != NULL; next++)
        at = next + 8; /* the last: an assertion's own text may have the words, too */
    const char *comma = at ? strstr(at, ", line ") : NULL;
    long long   number = 0;
    if (!comma || (size_t)(comma - at) < length || strncmp(comma - length, own, length) != 0 ||
        !text_parse_int(comma + 7, message + strlen(message), &number) || number < 0 || number > INT_MAX)
        return 0;
    return (int)number;
}

/* The first one stays. */
static void pass_error(const openscad_run *e, const char *line)
{
    if (!e->error->message[0])
        error_in_file(e->error, LMN_FORMAT, e->job->path, line_of(e, line), "openscad: %.400s", line);
}

static lmn_status explain(openscad_run *e)
{
    if (openscad_was_stopped(e)) {
        error_in_file(e->error, LMN_LIMIT, e->job->path, 0, "openscad took longer than %d s and was stopped",
                      LIMIT_SCAD_SECONDS);
        error_hint(e->error, "evaluate it yourself: openscad -o model.csg model.scad");
        return LMN_LIMIT;
    }
    /* Versions differ in whether a failed assertion fails the program; all of them write what came before it. */
    e->error->message[0] = '\0';
    openscad_each_line(e, "ERROR:", pass_error);
    if (!e->error->message[0] && e->job->desc && e->job->desc->strict)
        openscad_each_line(e, "WARNING:", pass_error);
    if (e->error->message[0])
        return LMN_FORMAT;
    if (WIFEXITED(e->status) && WEXITSTATUS(e->status) == 0)
        return LMN_OK;
    return error_in_file(e->error, LMN_FORMAT, e->job->path, 0, "openscad failed%s%.300s", e->said[0] ? ": " : "",
                         e->said);
}

/* --- the format ----------------------------------------------------------------------------------------- */

static lmn_status read_output(openscad_run *e)
{
    file_data  file;
    lmn_status status = file_load(&file, e->output, e->error);
    if (status != LMN_OK)
        return error_in_file(e->error, LMN_FORMAT, e->job->path, 0, "openscad wrote no model");
    openscad_each_line(e, "WARNING:", pass_warning);
    import_job job = *e->job;
    job.file = &file;
    status = csg_read(&job, true, e->error);
    file_data_release(&file);
    return status;
}

static lmn_status read_scad(const import_job *job, lmn_error *error)
{
    lmn_error     own = {0};
    openscad_run *e = mem_calloc(1, sizeof *e);
    if (!e)
        return error_memory(error);
    e->job = job;
    e->error = &own;
    lmn_status status;
    if (!openscad_find(e)) {
        status = error_in_file(&own, LMN_UNSUPPORTED, job->path, 0,
                               "a .scad file is a program that openscad must evaluate, and it is not on the PATH");
        error_hint(&own, "install OpenSCAD, or where it is: openscad -o model.csg model.scad");
    } else {
        status = check_defines(e);
    }
    if (status == LMN_OK)
        status = openscad_make_folder(e, "model.csg");
    if (status == LMN_OK)
        status = openscad_evaluate(e, job->path, job->desc ? job->desc->defines : NULL, define_count(e));
    if (status == LMN_OK)
        status = explain(e);
    if (status == LMN_OK)
        status = read_output(e);
    if (e->folder[0])
        temporary_folder_remove(e->folder);
    mem_free(e);
    if (status != LMN_OK && error)
        *error = own;
    return status;
}

const import_format import_scad = {"OpenSCAD", ".scad", 'z', false, NULL, read_scad};
