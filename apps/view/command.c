#include "command.h"

#include <glib/gstdio.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { NUMBER_MAX = 32 };

static void setting_clear(void *data)
{
    look_setting *s = data;
    g_free(s->key);
    g_free(s->value);
}

static void complain(lmn_error *error, const char *message, const char *hint)
{
    *error = (lmn_error){.status = LMN_UNSUPPORTED};
    g_strlcpy(error->message, message, sizeof error->message);
    g_strlcpy(error->hint, hint, sizeof error->hint);
}

/* --- what differs from the origin ------------------------------------------------------------------------ */

static bool same_techniques(const lmn_look *a, const lmn_look *b, size_t rule, const char *kind)
{
    size_t count = lmn_look_technique_count(a, rule, kind);
    if (count != lmn_look_technique_count(b, rule, kind))
        return false;
    for (size_t i = 0; i < count; i++)
        if (g_strcmp0(lmn_look_technique(a, rule, kind, i), lmn_look_technique(b, rule, kind, i)) != 0)
            return false;
    return true;
}

/* Have they the same rules, and in these the same techniques? */
static bool same_shape(const lmn_look *a, const lmn_look *b)
{
    size_t        rules = lmn_look_rule_count(a);
    lmn_kind_info kind;
    bool          same = rules == lmn_look_rule_count(b);
    for (size_t r = 0; r < rules && same; r++)
        same = g_strcmp0(lmn_look_rule_selector(a, r), lmn_look_rule_selector(b, r)) == 0 &&
               g_strcmp0(lmn_look_rule_name(a, r), lmn_look_rule_name(b, r)) == 0;
    for (size_t k = 0; same && lmn_kind_at(k, &kind); k++) {
        if (kind.whole_look)
            same = same_techniques(a, b, LMN_WHOLE_LOOK, kind.name);
        for (size_t r = 0; r < rules && same && !kind.whole_look; r++)
            same = same_techniques(a, b, r, kind.name);
    }
    return same;
}

static void add_settings(GArray *out, const lmn_look *now, const lmn_look *before, size_t rule,
                         const lmn_kind_info *kind)
{
    for (size_t i = 0; i < lmn_look_technique_count(now, rule, kind->name); i++) {
        lmn_param_info param;
        const char    *technique = lmn_look_technique(now, rule, kind->name, i);
        for (size_t p = 0; lmn_param_at(kind->name, technique, p, &param); p++) {
            char      text[2][LMN_VALUE_TEXT_MAX];
            lmn_error error = {0};
            if (lmn_look_get_text(now, rule, kind->name, i, param.key, text[0], sizeof *text, &error) != LMN_OK ||
                lmn_look_get_text(before, rule, kind->name, i, param.key, text[1], sizeof *text, &error) != LMN_OK ||
                strcmp(text[0], text[1]) == 0)
                continue;
            char        *prefix = kind->whole_look ? g_strdup("") : g_strdup_printf("%zu:", rule);
            char        *index = kind->several ? g_strdup_printf("[%zu]", i) : g_strdup("");
            look_setting s = {g_strdup_printf("%s%s%s.%s", prefix, kind->name, index, param.key), g_strdup(text[0])};
            g_array_append_val(out, s);
            g_free(prefix);
            g_free(index);
        }
    }
}

/* Does setting all of it make the one look of the other? */
static bool settings_suffice(const GArray *settings, lmn_look *origin, const lmn_look *wanted)
{
    lmn_error error = {0};
    bool      same = true;
    for (guint i = 0; i < settings->len && same; i++) {
        const look_setting *s = &g_array_index(settings, look_setting, i);
        same = lmn_look_set(origin, s->key, s->value, &error) == LMN_OK;
    }
    if (same && lmn_look_set_name(origin, lmn_look_name(wanted), &error) != LMN_OK)
        return false;
    char *a = lmn_look_json(origin), *b = lmn_look_json(wanted);
    same = same && a && b && strcmp(a, b) == 0;
    lmn_text_free(a);
    lmn_text_free(b);
    return same;
}

GArray *look_settings(const look_ref *look)
{
    lmn_look     *origin = NULL;
    lmn_error     error = {0};
    lmn_kind_info kind;
    if (lmn_look_load(&origin, look->origin, &error) != LMN_OK)
        return NULL;
    GArray *out = g_array_new(FALSE, FALSE, sizeof(look_setting));
    g_array_set_clear_func(out, setting_clear);
    bool same = same_shape(look->look, origin);
    for (size_t k = 0; same && lmn_kind_at(k, &kind); k++) {
        if (kind.whole_look)
            add_settings(out, look->look, origin, LMN_WHOLE_LOOK, &kind);
        for (size_t r = 0; !kind.whole_look && r < lmn_look_rule_count(look->look); r++)
            add_settings(out, look->look, origin, r, &kind);
    }
    if (!same || !settings_suffice(out, origin, look->look))
        g_clear_pointer(&out, g_array_unref);
    lmn_look_destroy(&origin);
    return out;
}

char *look_keep(const look_ref *look, lmn_error *error)
{
    char *json = lmn_look_json(look->look);
    if (!json) {
        complain(error, "out of memory", "");
        return NULL;
    }
    char *sum = g_compute_checksum_for_string(G_CHECKSUM_SHA256, json, -1);
    char *folder = g_build_filename(g_get_user_data_dir(), "limner", "copied-looks", NULL);
    char *name = g_strdup_printf("%.12s.json", sum), *path = g_build_filename(folder, name, NULL);
    bool  made = g_mkdir_with_parents(folder, 0700) == 0;
    bool  there = g_file_test(path, G_FILE_TEST_EXISTS) || lmn_text_write(json, path, error) == LMN_OK;
    if (!made && !there)
        complain(error, "the look cannot be kept among your data", "save it as a file first");
    lmn_text_free(json);
    g_free(sum);
    g_free(folder);
    g_free(name);
    if (!there)
        g_clear_pointer(&path, g_free);
    return path;
}

/* --- words ----------------------------------------------------------------------------------------------- */

static void add(GStrvBuilder *words, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void add(GStrvBuilder *words, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    char *text = g_strdup_vprintf(format, list);
    va_end(list);
    g_strv_builder_add(words, text);
    g_free(text);
}

/* The shortest text that reads as the same number. */
static const char *number_text(double value, char out[NUMBER_MAX])
{
    for (int digits = 6; digits <= 17; digits++) {
        char format[8];
        snprintf(format, sizeof format, "%%.%dg", digits);
        g_ascii_formatd(out, NUMBER_MAX, format, value);
        if (g_ascii_strtod(out, NULL) == value)
            break;
    }
    return out;
}

static void add_vector(GStrvBuilder *words, const char *option, const double v[3])
{
    char t[3][NUMBER_MAX];
    add(words, "%s", option);
    add(words, "%s,%s,%s", number_text(v[0], t[0]), number_text(v[1], t[1]), number_text(v[2], t[2]));
}

static void add_number(GStrvBuilder *words, const char *option, double value)
{
    char text[NUMBER_MAX];
    add(words, "%s", option);
    add(words, "%s", number_text(value, text));
}

static bool add_look(GStrvBuilder *words, const look_ref *look, lmn_error *error)
{
    GArray *settings = look_settings(look);
    char   *path = settings ? g_strdup(look->origin) : look_keep(look, error);
    if (!path)
        return false;
    add(words, "--look");
    add(words, "%s", path);
    for (guint i = 0; settings && i < settings->len; i++) {
        const look_setting *s = &g_array_index(settings, look_setting, i);
        add(words, "--set");
        add(words, "%s=%s", s->key, s->value);
    }
    g_free(path);
    if (settings)
        g_array_unref(settings);
    return true;
}

static void add_camera(GStrvBuilder *words, const lmn_draw_desc *d)
{
    add_vector(words, "--eye", d->eye);
    add_vector(words, "--target", d->target);
    add_vector(words, "--up", d->up);
    if (d->orthographic)
        add(words, "--ortho");
    else if (d->fov_deg != 30)
        add_number(words, "--fov", d->fov_deg);
}

static void add_time(GStrvBuilder *words, const lmn_draw_desc *d, const export_wish *wish)
{
    char rate[NUMBER_MAX];
    if (wish->rate > 0) {
        add(words, "--frames");
        add(words, "%.0f:%.0f:%s", floor(wish->first * wish->rate + 0.5), floor(wish->last * wish->rate + 0.5),
            number_text(wish->rate, rate));
    } else if (d->time_given) {
        add_number(words, "--time", d->time_s);
    }
    if (d->clip && *d->clip) {
        add(words, "--clip");
        add(words, "%s", d->clip);
    }
}

GStrv command_words(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error)
{
    if (s->edits && s->edits->len) {
        complain(error, "the solids were moved by hand, which no command can say",
                 "undo the moves, or change the program that the solids come from");
        return NULL;
    }
    lmn_draw_desc d;
    char         *selector = state_selector(s, scene);
    GStrvBuilder *words = g_strv_builder_new();
    state_describe(s, selector, wish->width, wish->height, &d);
    add(words, "limner");
    add(words, "draw");
    for (size_t i = 0; scene->paths[i]; i++)
        add(words, "%s", scene->paths[i]);
    bool good = add_look(words, s->look, error);
    add(words, "--size");
    add(words, "%dx%d", wish->width, wish->height);
    add_camera(words, &d);
    if (selector) {
        add(words, "--select");
        add(words, "%s", selector);
    }
    add_time(words, &d, wish);
    if (d.seed)
        add_number(words, "--seed", d.seed);
    if (wish->samples)
        add_number(words, "--samples", wish->samples);
    if (wish->transparent) {
        add(words, "--background");
        add(words, "none");
    }
    add(words, "-o");
    add(words, "%s", wish->path);
    GStrv out = good ? g_strv_builder_end(words) : NULL;
    g_strv_builder_unref(words);
    g_free(selector);
    return out;
}

char *command_line(const char *const *words)
{
    GString *out = g_string_new(NULL);
    for (size_t i = 0; words[i]; i++) {
        bool  plain = *words[i] && strspn(words[i], "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                                     "-_./,:=+%@") == strlen(words[i]);
        char *quoted = plain ? g_strdup(words[i]) : g_shell_quote(words[i]);
        g_string_append_printf(out, "%s%s", i ? " " : "", quoted);
        g_free(quoted);
    }
    return g_string_free(out, FALSE);
}

/* --- a program ------------------------------------------------------------------------------------------- */

/* Text as C has it between quotes. */
static char *quoted(const char *text)
{
    char *escaped = g_strescape(text, NULL), *out = g_strdup_printf("\"%s\"", escaped);
    g_free(escaped);
    return out;
}

static void print_vector(GString *out, const char *name, const double v[3])
{
    char t[NUMBER_MAX];
    for (int k = 0; k < 3; k++)
        g_string_append_printf(out, "    desc.%s[%d] = %s;\n", name, k, number_text(v[k], t));
}

static void print_text(GString *out, const char *before, const char *text, const char *after)
{
    char *literal = quoted(text);
    g_string_append_printf(out, "%s%s%s", before, literal, after);
    g_free(literal);
}

static bool print_look(GString *out, const look_ref *look, lmn_error *error)
{
    GArray *settings = look_settings(look);
    char   *json = settings ? NULL : lmn_look_json(look->look);
    if (!settings && !json) {
        complain(error, "out of memory", "");
        return false;
    }
    if (settings)
        print_text(out, "    check(lmn_look_load(&look, ", look->origin, ", &error), &error);\n");
    else
        print_text(out, "    check(lmn_look_parse(&look, ", json, ", \"look\", &error), &error);\n");
    for (guint i = 0; settings && i < settings->len; i++) {
        const look_setting *s = &g_array_index(settings, look_setting, i);
        print_text(out, "    check(lmn_look_set(look, ", s->key, ", ");
        print_text(out, "", s->value, ", &error), &error);\n");
    }
    lmn_text_free(json);
    if (settings)
        g_array_unref(settings);
    return true;
}

static void print_desc(GString *out, const lmn_draw_desc *d, const export_wish *wish)
{
    char t[NUMBER_MAX];
    g_string_append_printf(out, "    desc.width = %d;\n    desc.height = %d;\n    desc.eye_given = true;\n", d->width,
                           d->height);
    print_vector(out, "eye", d->eye);
    print_vector(out, "target", d->target);
    print_vector(out, "up", d->up);
    if (d->orthographic)
        g_string_append(out, "    desc.orthographic = true;\n");
    g_string_append_printf(out, "    desc.fov_deg = %s;\n", number_text(d->fov_deg, t));
    if (d->select)
        print_text(out, "    desc.select = ", d->select, ";\n");
    if (d->time_given)
        g_string_append_printf(out, "    desc.time_given = true;\n    desc.time_s = %s;\n", number_text(d->time_s, t));
    if (d->clip)
        print_text(out, "    desc.clip = ", d->clip, ";\n");
    if (d->seed)
        g_string_append_printf(out, "    desc.seed = %u;\n", d->seed);
    if (wish->samples)
        g_string_append_printf(out, "    desc.samples = %d;\n", wish->samples);
    if (wish->transparent)
        g_string_append(out, "    desc.background = \"none\";\n");
}

char *command_in_c(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error)
{
    if (s->edits && s->edits->len) {
        complain(error, "the solids were moved by hand, which the program would have to repeat",
                 "undo the moves, or change the program that the solids come from");
        return NULL;
    }
    lmn_draw_desc d;
    char         *selector = state_selector(s, scene);
    state_describe(s, selector, wish->width, wish->height, &d);
    GString *out = g_string_new("/* cc drawing.c $(pkg-config --cflags --libs limner) */\n"
                                "#include <limner/limner.h>\n"
                                "#include <stdio.h>\n"
                                "#include <stdlib.h>\n\n"
                                "static void check(lmn_status status, const lmn_error *error)\n{\n"
                                "    if (status == LMN_OK)\n        return;\n"
                                "    fprintf(stderr, \"%s\\n\", error->message);\n"
                                "    exit(1);\n}\n\n"
                                "int main(void)\n{\n"
                                "    lmn_error         error = {0};\n"
                                "    lmn_scene        *scene = NULL;\n"
                                "    lmn_look         *look = NULL;\n"
                                "    lmn_renderer     *renderer = NULL;\n"
                                "    lmn_drawing      *drawing = NULL;\n"
                                "    lmn_renderer_desc with = LMN_RENDERER_DESC_INIT;\n"
                                "    lmn_load_desc     load = LMN_LOAD_DESC_INIT;\n"
                                "    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;\n"
                                "    check(lmn_scene_create(&scene, &error), &error);\n");
    for (size_t i = 0; scene->paths[i]; i++)
        print_text(out, "    check(lmn_scene_add_file(scene, ", scene->paths[i], ", &load, &error), &error);\n");
    bool good = print_look(out, s->look, error);
    print_desc(out, &d, wish);
    g_string_append(out, "    check(lmn_renderer_create(&renderer, &with, &error), &error);\n"
                         "    check(lmn_draw(&drawing, renderer, scene, look, &desc, &error), &error);\n");
    print_text(out, "    check(lmn_drawing_write(drawing, ", wish->path, ", NULL, NULL, &error), &error);\n");
    g_string_append(out, "    lmn_drawing_destroy(&drawing);\n"
                         "    lmn_renderer_destroy(&renderer);\n"
                         "    lmn_look_destroy(&look);\n"
                         "    lmn_scene_destroy(&scene);\n"
                         "    return 0;\n}\n");
    g_free(selector);
    return g_string_free(out, !good);
}
