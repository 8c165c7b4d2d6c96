/* Manual pages in the macros of man(7). */
#include "pages.h"

#include <ctype.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 2048 };

static const char *escape_of(char c)
{
    switch (c) {
    case '\\': return "\\e";
    case '-': return "\\-";
    case '`': return "\\(ga";
    case '\'': return "\\(aq";
    case '^': return "\\(ha";
    case '~': return "\\(ti";
    default: return NULL;
    }
}

/* One character that takes more than a byte; how many it takes. */
static size_t write_wide(FILE *out, const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    int                  more = *at >= 0xF0 ? 3 : *at >= 0xE0 ? 2 : 1;
    unsigned             code = *at & (0x3Fu >> more);
    for (int i = 1; i <= more; i++)
        code = code << 6 | (at[i] & 0x3Fu);
    fprintf(out, "\\[u%04X]", code);
    return (size_t)more + 1;
}

void write_roff(FILE *out, const char *text)
{
    if (*text == '.')
        fputs("\\&", out);
    for (const char *at = text; *at;) {
        const char *escape = escape_of(*at);
        if ((unsigned char)*at >= 0xC0) {
            at += write_wide(out, at);
            continue;
        }
        if (escape)
            fputs(escape, out);
        else
            fputc(*at == '\n' ? ' ' : *at, out);
        at++;
    }
}

/* Whole sentences on lines of their own, as typesetters want them. */
static void write_sentences(FILE *out, const char *text)
{
    char rest[TEXT_SIZE];
    snprintf(rest, sizeof rest, "%s", text);
    for (char *at = rest, *stop; at; at = stop) {
        stop = at + strcspn(at, ".");
        while (*stop && !(stop[1] == ' ' || stop[1] == '\n'))
            stop += 1 + strcspn(stop + 1, ".");
        if (*stop) {
            stop[1] = '\0';
            stop += 2;
        } else {
            stop = NULL;
        }
        write_roff(out, at);
        fputc('\n', out);
    }
}

void write_title(FILE *out, const char *name, int section, const char *date)
{
    fputs(".\\\" Made from the command's own tables.\n.TH ", out);
    for (; *name; name++)
        fputc(toupper((unsigned char)*name), out);
    fprintf(out, " %d \"%s\" \"limner %s\" \"%s\"\n", section, date, lmn_version(),
            section == 1 ? "User Commands" : "File Formats");
}

/* The text without the full stop at its end. */
static void write_name(FILE *out, const char *name, const char *what)
{
    fprintf(out, ".SH NAME\n");
    write_roff(out, name);
    fputs(" \\- ", out);
    char line[TEXT_SIZE];
    snprintf(line, sizeof line, "%s", what);
    line[0] = (char)tolower((unsigned char)line[0]);
    size_t length = strlen(line);
    if (length && line[length - 1] == '.')
        line[length - 1] = '\0';
    write_roff(out, line);
    fputc('\n', out);
}

static void write_row(FILE *out, const char *head, const char *text)
{
    fputs(".TP\n.B ", out);
    write_roff(out, head);
    fputc('\n', out);
    write_sentences(out, text);
}

static void write_option(FILE *out, const option *o)
{
    char text[TEXT_SIZE];
    option_text(o, text, sizeof text);
    fputs(".TP\n", out);
    if (o->short_name)
        fprintf(out, "\\fB\\-%c\\fR, ", o->short_name);
    fputs("\\fB\\-\\-", out);
    write_roff(out, o->name);
    fputs("\\fR", out);
    if (o->argument) {
        fputs(" \\fI", out);
        write_roff(out, o->argument);
        fputs("\\fR", out);
    }
    fputc('\n', out);
    write_sentences(out, text);
}

static void write_statuses(FILE *out)
{
    static const char *const rows[][2] = {{"0", "Done."},
                                          {"1", "An argument is wrong."},
                                          {"2", "An input cannot be read or is wrong."},
                                          {"3", "There is no usable OpenGL."},
                                          {"4", "An output cannot be written."},
                                          {"5", "Cancelled."},
                                          {"6", "Out of memory, or a defect of Limner."}};
    fputs(".SH EXIT STATUS\n", out);
    for (size_t i = 0; i < OPTION_COUNT(rows); i++)
        write_row(out, rows[i][0], rows[i][1]);
}

static void write_see_also(FILE *out, const command *but)
{
    fputs(".SH SEE ALSO\n", out);
    if (but)
        fputs(".BR limner (1),\n", out);
    for (size_t i = 0; commands[i]; i++)
        if (commands[i] != but)
            fprintf(out, ".BR limner\\-%s (1),\n", commands[i]->name);
    fputs(".BR limner\\-look (5)\n", out);
}

void write_command_manual(FILE *out, const command *c, const char *date)
{
    char name[64];
    snprintf(name, sizeof name, "limner-%s", c->name);
    write_title(out, name, 1, date);
    write_name(out, name, c->summary);
    fprintf(out, ".SH SYNOPSIS\n.B limner %s\n", c->name);
    if (c->inputs) {
        fputs(".I ", out);
        write_roff(out, c->inputs);
        fputc('\n', out);
    }
    fputs("[\\fIOPTION\\fR]\\[u2026]\n.SH DESCRIPTION\n", out);
    write_sentences(out, c->summary);
    if (c->detail)
        write_sentences(out, c->detail);
    fputs(".SH OPTIONS\n", out);
    for (size_t i = 0; i < c->option_count; i++)
        write_option(out, &c->options[i]);
    fputs(".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nPrint the options.\n", out);
    write_statuses(out);
    write_see_also(out, c);
}

static void write_environment(FILE *out)
{
    static const char *const rows[][2] = {
        {"LIMNER_CACHE", "Folder for what is computed once, such as textures of strokes. Default: limner in "
                         "XDG_CACHE_HOME or ~/.cache; empty: nothing is kept."},
        {"LIMNER_PATH", "floor: use only what every driver since OpenGL 3.3 has; the picture is the same."},
        {"LIMNER_GL", "es: draw with OpenGL ES."},
        {"TMPDIR", "Folder for temporary files. Default: /tmp."},
        {"PATH", "Where ffmpeg (films) and openscad (programs) are looked for."}};
    fputs(".SH ENVIRONMENT\n", out);
    for (size_t i = 0; i < OPTION_COUNT(rows); i++)
        write_row(out, rows[i][0], rows[i][1]);
}

static void write_examples(FILE *out)
{
    static const char *const rows[][2] = {
        {"limner draw part.stl", "A picture, part.png, with soft light and dark edges."},
        {"limner draw part.stl --look technical -o part.svg", "Lines as vectors, hidden ones dashed."},
        {"limner draw pump.glb --cut x --view right --ortho", "A hatched section."},
        {"limner draw fox.glb --clip Run --frames 0:27:24 --look sketch -o fox.mp4", "A film."},
        {"limner looks toon", "What can be set in a look."},
        {"limner draw upload.glb --safe", "A file from a stranger: strict limits, nothing outside of its folder."}};
    fputs(".SH EXAMPLES\n", out);
    for (size_t i = 0; i < OPTION_COUNT(rows); i++)
        write_row(out, rows[i][0], rows[i][1]);
}

void write_manual(FILE *out, const char *date)
{
    write_title(out, "limner", 1, date);
    write_name(out, "limner", "Draws 3D models the way people draw.");
    fputs(".SH SYNOPSIS\n.B limner\n.I COMMAND\n\\[u2026]\n.br\n.B limner \\-\\-version\n.br\n.B limner \\-\\-help\n"
          ".SH DESCRIPTION\n",
          out);
    write_sentences(out, "Limner draws 3D models with outlines and hatching, as blueprints, sketches, engravings or "
                         "cartoons, as pictures, vectors and films. It needs no display, and no GPU. Each command has "
                         "a page of its own.");
    fputs(".SH COMMANDS\n", out);
    for (size_t i = 0; commands[i]; i++)
        write_row(out, commands[i]->name, commands[i]->summary);
    write_environment(out);
    write_statuses(out);
    write_examples(out);
    write_see_also(out, NULL);
}
