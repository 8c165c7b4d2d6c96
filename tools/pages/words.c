/* What can stand for each argument of the command. */
#include "pages.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "formats.h"
#include "import/import.h"

/* The word for an argument in the usage text says what it is. */
static const struct {
    const char *argument;
    value_kind  kind;
} kinds[] = {
    {"OUT", VALUE_FILE},
    {"FILE|-", VALUE_FILE},
    {"DIR", VALUE_FOLDER},
    {"INPUT", VALUE_MODEL},
    {"INPUT…", VALUE_MODEL},
    {"NAME|FILE", VALUE_LOOK},
    {"[NAME]", VALUE_LOOK},
    {"FORMAT", VALUE_FORMAT},
    {"KIND.PARAM=VALUE", VALUE_SETTING},
    {"PATTERN|FILE", VALUE_PATTERN},
};

static value_kind kind_of(const char *argument)
{
    for (size_t i = 0; argument && i < OPTION_COUNT(kinds); i++)
        if (strcmp(kinds[i].argument, argument) == 0)
            return kinds[i].kind;
    return VALUE_PLAIN;
}

value_kind option_value_kind(const command *c, const option *o)
{
    value_kind kind = o->type == OPTION_CHOICE ? VALUE_CHOICE : kind_of(o->argument);
    return kind == VALUE_FORMAT && c == &command_strokes ? VALUE_TEXTURE : kind;
}

value_kind input_value_kind(const command *c)
{
    return kind_of(c->inputs);
}

/* --- words ---------------------------------------------------------------------------------------------- */

typedef struct builder {
    FILE  *out;
    char  *text;
    size_t size;
} builder;

static void stop_without_memory(void)
{
    fputs("limner_pages: out of memory\n", stderr);
    exit(EXIT_INTERNAL);
}

static void begin(builder *b)
{
    *b = (builder){0};
    b->out = open_memstream(&b->text, &b->size);
    if (!b->out)
        stop_without_memory();
}

static void add(builder *b, const char *word)
{
    fprintf(b->out, "%s%s", ftell(b->out) > 0 ? " " : "", word);
}

static char *end(builder *b)
{
    if (fclose(b->out) != 0 || !b->text)
        stop_without_memory();
    return b->text;
}

static void add_models(builder *b)
{
    const import_format *const formats[] = {&import_gltf, &import_stl, &import_obj,  &import_ply,
                                            &import_bvh,  &import_csg, &import_scad, &import_assimp};
    for (size_t i = 0; i < OPTION_COUNT(formats); i++)
        add(b, formats[i]->endings);
}

static void add_looks(builder *b)
{
    for (size_t i = 0; i < lmn_look_count(); i++)
        add(b, lmn_look_name_at(i));
}

static void add_formats(builder *b)
{
    lmn_format_info      f;
    lmn_film_format_info film;
    for (size_t i = 0; lmn_format_at(i, &f); i++)
        add(b, f.ending + 1);
    for (size_t i = 0; lmn_film_format_at(i, &film); i++)
        add(b, film.ending + 1);
}

static void add_patterns(builder *b)
{
    for (int i = 0; lmn_stroke_pattern_name(i); i++)
        add(b, lmn_stroke_pattern_name(i));
}

static void add_setting(json_t *found, const char *kind, const char *name, const char *value)
{
    char word[160];
    snprintf(word, sizeof word, "%s.%s=%s", kind, name, value);
    json_object_set_new(found, word, json_true());
}

/* A parameter with each value that it can have, or up to its '='. */
static void add_parameters(json_t *found, const char *kind, const json_t *list)
{
    size_t  i, k;
    json_t *p, *value;
    json_array_foreach(list, i, p)
    {
        const char *name = text_at(p, "name", "");
        bool        yes_no = strcmp(text_at(p, "type", ""), "bool") == 0;
        json_array_foreach(json_object_get(p, "values"), k, value)
            add_setting(found, kind, name, json_string_value(value));
        if (yes_no) {
            add_setting(found, kind, name, "true");
            add_setting(found, kind, name, "false");
        } else if (!json_object_get(p, "values")) {
            add_setting(found, kind, name, "");
        }
    }
}

static void add_settings(builder *b)
{
    size_t      i, k;
    json_t     *kind, *technique, *found = json_object();
    char       *text = NULL;
    lmn_error   error = {0};
    const char *word;
    if (lmn_look_reference_json(&text, NULL, &error) != LMN_OK)
        stop_without_memory();
    json_t *root = parse_and_free(text);
    json_array_foreach(json_object_get(root, "kinds"), i, kind)
    {
        const char *name = text_at(kind, "name", "");
        add_parameters(found, name, json_object_get(kind, "common"));
        json_array_foreach(json_object_get(kind, "techniques"), k, technique)
        {
            add_setting(found, name, text_at(kind, "key", ""), text_at(technique, "name", ""));
            add_parameters(found, name, json_object_get(technique, "parameters"));
        }
    }
    json_t *value;
    json_object_foreach(found, word, value) add(b, word);
    json_decref(found);
    json_decref(root);
}

static void add_choices(builder *b, const option *o)
{
    for (size_t i = 0; o->choices[i]; i++)
        add(b, o->choices[i]);
}

value_words value_words_of(value_kind kind, const option *o)
{
    builder words, endings;
    begin(&words);
    begin(&endings);
    switch (kind) {
    case VALUE_MODEL: add_models(&endings); break;
    case VALUE_LOOK:
        add_looks(&words);
        add(&endings, ".json");
        break;
    case VALUE_SETTING: add_settings(&words); break;
    case VALUE_FORMAT: add_formats(&words); break;
    case VALUE_TEXTURE: add(&words, "stx svg png"); break;
    case VALUE_PATTERN:
        add_patterns(&words);
        add(&endings, ".stx .svg");
        break;
    case VALUE_CHOICE: add_choices(&words, o); break;
    case VALUE_PLAIN:
    case VALUE_FILE:
    case VALUE_FOLDER: break;
    }
    return (value_words){end(&words), end(&endings)};
}

void value_words_free(value_words *w)
{
    free(w->words);
    free(w->endings);
    *w = (value_words){0};
}

void option_text(const option *o, char *out, size_t size)
{
    if (o->write_doc)
        o->write_doc(out, size);
    else
        snprintf(out, size, "%s", o->doc);
}

void option_brief(const option *o, char *out, size_t size)
{
    option_text(o, out, size);
    char  *stop = strstr(out, ". ");
    size_t length = stop ? (size_t)(stop - out) : strlen(out);
    if (length && out[length - 1] == '.')
        length--;
    out[length] = '\0';
}
