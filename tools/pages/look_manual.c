/* limner-look(5): the keys of looks, from the tables of techniques. */
#include "pages.h"

#include <jansson.h>
#include <stdlib.h>

static void write_line(FILE *out, const char *before, const char *text)
{
    fputs(before, out);
    write_roff(out, text);
    fputc('\n', out);
}

static void write_range(FILE *out, const json_t *p)
{
    size_t  i;
    json_t *value;
    char    range[96];
    if (json_object_get(p, "min")) {
        snprintf(range, sizeof range, ", %.6g to %.6g", number_at(p, "min", 0), number_at(p, "max", 0));
        write_roff(out, range);
    }
    json_array_foreach(json_object_get(p, "values"), i, value)
    {
        fputs(i ? ", " : ": ", out);
        write_roff(out, json_string_value(value));
    }
    if (json_is_true(json_object_get(p, "auto")))
        fputs(", auto", out);
}

static void write_parameters(FILE *out, const json_t *list)
{
    size_t  i;
    json_t *p;
    json_array_foreach(list, i, p)
    {
        fputs(".TP\n\\fB", out);
        write_roff(out, text_at(p, "name", ""));
        fputs("\\fR (", out);
        write_roff(out, text_at(p, "type", ""));
        write_range(out, p);
        fputs(")\n", out);
        write_line(out, "", text_at(p, "doc", ""));
    }
}

static void write_kind(FILE *out, const json_t *kind)
{
    size_t  i;
    json_t *technique;
    write_line(out, ".SH ", text_at(kind, "name", ""));
    write_line(out, "", text_at(kind, "doc", ""));
    write_line(out, "The technique is named by ", text_at(kind, "key", ""));
    write_parameters(out, json_object_get(kind, "common"));
    json_array_foreach(json_object_get(kind, "techniques"), i, technique)
    {
        write_line(out, ".SS ", text_at(technique, "name", ""));
        write_line(out, "", text_at(technique, "doc", ""));
        write_parameters(out, json_object_get(technique, "parameters"));
    }
}

void write_look_manual(FILE *out, const char *date)
{
    size_t    i;
    json_t   *item;
    char     *text = NULL;
    lmn_error error = {0};
    if (lmn_look_reference_json(&text, NULL, &error) != LMN_OK)
        exit(message_error(&error));
    json_t *root = parse_and_free(text);
    write_title(out, "limner-look", 5, date);
    fputs(".SH NAME\nlimner\\-look \\- how Limner draws: looks, techniques and their parameters\n.SH DESCRIPTION\n"
          "A look is a file of JSON whose rules give sets of parts one technique of each kind.\n"
          "Parameters are set in such files, and with\n.B limner draw \\-\\-set\n.IR KIND . PARAM = VALUE .\n"
          ".SH LOOKS\n",
          out);
    json_array_foreach(json_object_get(root, "looks"), i, item)
    {
        write_line(out, ".TP\n.B ", text_at(item, "name", ""));
        write_line(out, "", text_at(item, "doc", ""));
    }
    json_array_foreach(json_object_get(root, "kinds"), i, item) write_kind(out, item);
    fputs(".SH SEE ALSO\n.BR limner (1),\n.BR limner\\-draw (1),\n.BR limner\\-looks (1)\n", out);
    json_decref(root);
}
