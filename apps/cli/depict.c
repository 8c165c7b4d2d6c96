#include "depict.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "sets.h"

/* "1:2.5" */
static int parse_interval(const char *text, lmn_depict_desc *d)
{
    char *end = NULL, *last = NULL;
    d->from_s = strtod(text, &end);
    if (end != text && *end == ':')
        d->to_s = strtod(end + 1, &last);
    d->interval_given = last && last != end + 1 && !*last && d->from_s >= 0 && d->to_s > d->from_s;
    return d->interval_given
               ? EXIT_DONE
               : message_usage("for example --interval 0:1.5",
                               "--interval is '%.60s'; allowed is FROM:TO in seconds, FROM before TO", text);
}

static int message_file(const char *path, const char *what)
{
    lmn_error error = {.status = LMN_READ};
    snprintf(error.file, sizeof error.file, "%s", path);
    snprintf(error.message, sizeof error.message, "%s", what);
    return message_error(&error);
}

/* The text of a file with expressions. Exit status; free *out also after one. */
static int read_expressions(char **out, const char *path)
{
    enum { MOST = 16 << 20 };
    FILE *file = fopen(path, "rb");
    *out = file ? malloc(MOST + 1) : NULL;
    if (!file)
        return message_file(path, strerror(errno));
    if (!*out) {
        fclose(file);
        return message_out_of_memory();
    }
    const size_t size = fread(*out, 1, MOST + 1, file);
    const bool   failed = ferror(file) != 0;
    const int    reason = errno;
    fclose(file);
    if (failed || size > MOST)
        return message_file(path, failed ? strerror(reason) : "expressions have at most 16 MiB");
    (*out)[size] = '\0';
    if (strlen(*out) < size)
        return message_file(path, "expressions are JSON: there is a NUL byte in it");
    return EXIT_DONE;
}

static char *copy_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? strdup(text) : NULL;
}

/* A member that is there and of another type. */
static int check_depiction(const char *path, const json_t *given)
{
    static const char *const texts[] = {"look", "camera", "view"};
    const char              *key;
    json_t                  *value;
    json_object_foreach((json_t *)given, key, value)
    {
        bool known = strcmp(key, "time") == 0 && json_is_number(value);
        for (int i = 0; i < 3; i++)
            known = known || (strcmp(key, texts[i]) == 0 && json_is_string(value));
        if (!known)
            return message_usage("look, view and camera are texts, time is seconds",
                                 "%s: \"depiction\" has a member '%.60s' that is not known, or not of its type", path,
                                 key);
    }
    return EXIT_DONE;
}

/* NULL: it is no JSON. Editors put a byte order mark before it. */
static json_t *read_json(const char *path)
{
    FILE   *file = fopen(path, "rb");
    char    mark[3];
    json_t *root = NULL;
    if (!file)
        return NULL;
    if (fread(mark, 1, sizeof mark, file) != sizeof mark || memcmp(mark, "\xEF\xBB\xBF", sizeof mark) != 0)
        rewind(file);
    root = json_loadf(file, 0, NULL);
    fclose(file);
    return root;
}

int depiction_read(depiction *out, const char *path)
{
    const char *dot = strrchr(path, '.');
    *out = (depiction){NULL, NULL, NULL, {false, 0}, false};
    json_t *root = dot && strcmp(dot, ".json") == 0 ? read_json(path) : NULL;
    /* What is wrong with a script is told when it is read as one. */
    const json_t *given = json_object_get(root, "depiction"), *time = json_object_get(given, "time");
    int           status = given ? check_depiction(path, given) : EXIT_DONE;
    out->look = copy_text(given, "look");
    out->camera = copy_text(given, "camera");
    out->view = copy_text(given, "view");
    out->time = (option_number){json_is_number(time), json_number_value(time)};
    out->has_expressions = json_is_array(json_object_get(root, "expressions"));
    json_decref(root);
    return status;
}

void depiction_release(depiction *d)
{
    free(d->look);
    free(d->camera);
    free(d->view);
}

/* Without a time: where most of the motion is past and some is to come. */
static void settle_time(const lmn_scene *scene, lmn_draw_desc *desc, const lmn_depict_desc *d)
{
    const double end = desc->time_given ? 0 : clip_end(scene, desc->clip);
    if (end > 0) {
        desc->time_s = d->interval_given ? d->from_s + 0.6 * (d->to_s - d->from_s) : 0.6 * end;
        desc->time_given = true;
    }
    desc->fit_time = false;
}

/* What could not be told, for who looks at a picture that tells little. */
static void print_warnings(const char *json)
{
    json_t       *root = json_loads(json, 0, NULL);
    size_t        i;
    const json_t *text;
    json_array_foreach(json_object_get(root, "warnings"), i, text) message_warning(json_string_value(text), 1);
    json_decref(root);
}

int depict_scene(lmn_scene *scene, lmn_draw_desc *desc, const char *expressions, const char *interval, bool explain,
                 bool quiet)
{
    lmn_depict_desc d = LMN_DEPICT_DESC_INIT;
    lmn_error       error = {0};
    char           *json = NULL, *text = NULL;
    int             status = interval ? parse_interval(interval, &d) : EXIT_DONE;
    if (status == EXIT_DONE && expressions)
        status = read_expressions(&text, expressions);
    if (status == EXIT_DONE) {
        settle_time(scene, desc, &d);
        d.expressions = text;
        if (lmn_depict(scene, desc, &d, &json, &error) != LMN_OK) {
            if (error.line > 0 && expressions) /* that is where the expressions were */
                snprintf(error.file, sizeof error.file, "%s", expressions);
            status = message_error(&error);
        }
    }
    free(text);
    if (json && !quiet)
        print_warnings(json);
    if (status == EXIT_DONE && explain)
        return print_and_free(json);
    lmn_text_free(json);
    return status;
}
