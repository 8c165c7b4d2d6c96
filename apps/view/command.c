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

/* Have they as many rules, of the same names and for the same parts? */
static bool same_rules(const lmn_look *a, const lmn_look *b)
{
    size_t rules = lmn_look_rule_count(a);
    bool   same = rules == lmn_look_rule_count(b);
    for (size_t r = 0; r < rules && same; r++)
        same = g_strcmp0(lmn_look_rule_selector(a, r), lmn_look_rule_selector(b, r)) == 0 &&
               g_strcmp0(lmn_look_rule_name(a, r), lmn_look_rule_name(b, r)) == 0;
    return same;
}

/* How a rule is called in a key: not at all where it is the only one, by a name that no other has, or by its number. */
static char *rule_prefix(const lmn_look *look, size_t rule)
{
    size_t      rules = lmn_look_rule_count(look), same = 0;
    const char *name = rule == LMN_WHOLE_LOOK ? NULL : lmn_look_rule_name(look, rule);
    for (size_t r = 0; r < rules && name; r++)
        same += g_strcmp0(lmn_look_rule_name(look, r), name) == 0;
    if (rule == LMN_WHOLE_LOOK || rules == 1)
        return g_strdup("");
    return name && *name && same == 1 ? g_strdup_printf("%s:", name) : g_strdup_printf("%zu:", rule);
}

/* One kind of one rule, in both looks. `before` is brought along, so that what follows is compared with what it will
 * be. */
typedef struct comparison {
    GArray              *out;
    const lmn_look      *now;
    lmn_look            *before;
    size_t               rule;
    const lmn_kind_info *kind;
    char                *prefix;
} comparison;

/* Adds what sets one key of the technique at `index`; of a kind's only technique it needs no number. */
static void add_setting(const comparison *c, size_t index, bool numbered, const char *param, const char *value)
{
    char        *number = numbered ? g_strdup_printf("[%zu]", index) : g_strdup("");
    look_setting s = {g_strdup_printf("%s%s%s.%s", c->prefix, c->kind->name, number, param), g_strdup(value)};
    lmn_error    error = {0};
    (void)lmn_look_set(c->before, s.key, s.value, &error); /* what this cannot say comes out at the end */
    g_array_append_val(c->out, s);
    g_free(number);
}

/* Techniques that were exchanged, added at the end or taken from there. */
static void add_techniques(const comparison *c)
{
    size_t now = lmn_look_technique_count(c->now, c->rule, c->kind->name);
    size_t before = lmn_look_technique_count(c->before, c->rule, c->kind->name);
    bool   numbered = c->kind->several && MAX(now, before) > 1;
    for (size_t i = 0; i < now; i++) {
        const char *technique = lmn_look_technique(c->now, c->rule, c->kind->name, i);
        if (g_strcmp0(technique, lmn_look_technique(c->before, c->rule, c->kind->name, i)) != 0)
            add_setting(c, i, numbered, "technique", technique);
    }
    for (size_t i = before; i > now; i--)
        add_setting(c, i - 1, numbered, "technique", "none");
}

static void add_values(const comparison *c)
{
    size_t count = lmn_look_technique_count(c->now, c->rule, c->kind->name);
    for (size_t i = 0; i < count; i++) {
        lmn_param_info param;
        const char    *kind = c->kind->name, *technique = lmn_look_technique(c->now, c->rule, kind, i);
        for (size_t p = 0; lmn_param_at(kind, technique, p, &param); p++) {
            char      text[2][LMN_VALUE_TEXT_MAX];
            lmn_error error = {0};
            if (lmn_look_get_text(c->now, c->rule, kind, i, param.key, text[0], sizeof *text, &error) == LMN_OK &&
                lmn_look_get_text(c->before, c->rule, kind, i, param.key, text[1], sizeof *text, &error) == LMN_OK &&
                strcmp(text[0], text[1]) != 0)
                add_setting(c, i, c->kind->several && count > 1, param.key, text[0]);
        }
    }
}

/* Techniques before their values, as the command sets them. */
static void add_differences(GArray *out, const lmn_look *now, lmn_look *before, void (*add)(const comparison *c))
{
    lmn_kind_info kind;
    size_t        rules = lmn_look_rule_count(now);
    for (size_t k = 0; lmn_kind_at(k, &kind); k++)
        for (size_t r = 0; r < (kind.whole_look ? 1 : rules); r++) {
            comparison c = {out, now, before, kind.whole_look ? LMN_WHOLE_LOOK : r, &kind, NULL};
            c.prefix = rule_prefix(now, c.rule);
            add(&c);
            g_free(c.prefix);
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

/* What controls are set to. */
static void add_controls(GArray *out, const lmn_look *now, const lmn_look *before)
{
    lmn_control_info info;
    lmn_error        error = {0};
    double           is, was;
    for (size_t i = 0; lmn_control_at(i, &info); i++)
        if (lmn_look_get_control(now, info.name, &is, &error) == LMN_OK &&
            lmn_look_get_control(before, info.name, &was, &error) == LMN_OK && is != was) {
            char         value[G_ASCII_DTOSTR_BUF_SIZE];
            look_setting s = {g_strdup(info.name), g_strdup(g_ascii_dtostr(value, sizeof value, is))};
            g_array_append_val(out, s);
        }
}

GArray *look_settings(const look_ref *look)
{
    lmn_look *origin = NULL, *before = NULL;
    lmn_error error = {0};
    GArray   *out = NULL;
    if (lmn_look_load(&origin, look->origin, &error) == LMN_OK && same_rules(look->look, origin) &&
        lmn_look_copy(&before, origin, &error) == LMN_OK) {
        out = g_array_new(FALSE, FALSE, sizeof(look_setting));
        g_array_set_clear_func(out, setting_clear);
        add_differences(out, look->look, before, add_techniques);
        add_differences(out, look->look, before, add_values);
        add_controls(out, look->look, before);
        if (!settings_suffice(out, origin, look->look))
            g_clear_pointer(&out, g_array_unref);
    }
    lmn_look_destroy(&origin);
    lmn_look_destroy(&before);
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

/* --- wishes ---------------------------------------------------------------------------------------------- */

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strchr(dot, '/') ? dot : "";
}

wish_kind wish_kind_of(const char *path, lmn_format_info *format)
{
    lmn_film_format_info film;
    for (size_t i = 0; lmn_format_at(i, format); i++)
        if (g_ascii_strcasecmp(format->ending, ending_of(path)) == 0)
            return format->vectors ? WISH_SHEET : WISH_PICTURE;
    for (size_t i = 0; lmn_film_format_at(i, &film); i++)
        if (g_ascii_strcasecmp(film.ending, ending_of(path)) == 0) {
            /* Of its frames. */
            for (size_t k = 0; lmn_format_at(k, format) && format->vectors;)
                k++;
            return WISH_FILM;
        }
    return WISH_UNKNOWN;
}

void wish_frames(const export_wish *wish, long *first, long *last)
{
    *first = (long)floor(wish->first * wish->rate + 0.5);
    *last = MAX(*first, (long)floor(wish->last * wish->rate + 0.5));
}

/* The angle of view goes by the height, so that narrow pages would cut off what is seen at the sides. */
static orbit widened(const orbit *o, const export_wish *wish)
{
    enum { MOST_DEG = 170 };
    orbit  out = *o;
    double factor = wish->shown * wish->height / wish->width;
    if (factor > 1)
        out.fov_deg = fmin(MOST_DEG, atan(tan(o->fov_deg * G_PI / 360) * factor) * 360 / G_PI);
    return out;
}

void wish_describe(const view_state *s, const scene_ref *scene, const export_wish *wish, const char *selector,
                   lmn_draw_desc *desc)
{
    lmn_format_info format;
    wish_kind       kind = wish_kind_of(wish->path, &format);
    bool            pixels = lmn_look_needs_pixels(s->look->look);
    view_state      state = *s; /* borrows all of it */
    state.view = widened(&s->view, wish);
    state_describe(&state, scene, selector, wish->width, wish->height, desc);
    desc->dpi = wish->dpi;
    desc->samples = kind != WISH_SHEET || (format.pictures && pixels) ? wish->samples : 0;
    desc->background = wish->transparent && (kind == WISH_UNKNOWN || format.ground) ? "none" : NULL;
    if (kind == WISH_FILM) {
        desc->time_given = true;
        desc->clip = s->clip;
        desc->fit_time = scene->info.animations > 0;
    }
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
    char            rate[NUMBER_MAX];
    long            first, last;
    lmn_format_info format;
    if (wish_kind_of(wish->path, &format) == WISH_FILM) {
        wish_frames(wish, &first, &last);
        add(words, "--frames");
        add(words, "%ld:%ld:%s", first, last, number_text(wish->rate, rate));
    } else if (d->time_given) {
        add_number(words, "--time", d->time_s);
    }
    if (d->clip && *d->clip) {
        add(words, "--clip");
        add(words, "%s", d->clip);
    }
}

/* What the command takes of a wish: not what the format has no room for, which it refuses. */
static void add_page(GStrvBuilder *words, const lmn_draw_desc *d)
{
    add(words, "--size");
    add(words, "%dx%d", d->width, d->height);
    if (d->dpi > 0)
        add_number(words, "--dpi", d->dpi);
    if (d->seed)
        add_number(words, "--seed", d->seed);
    if (d->samples)
        add_number(words, "--samples", d->samples);
    if (d->background) {
        add(words, "--background");
        add(words, "%s", d->background);
    }
}

/* Can a command say all of it? */
static bool is_sayable(const view_state *s, const export_wish *wish, const char *by, lmn_error *error)
{
    char *message = NULL;
    if (s->edits && s->edits->len)
        message = g_strdup_printf("the solids were edited by hand, which no %s can say", by);
    if (message) {
        complain(error, message, "undo the edits, or change the program that the solids come from");
    } else if (s->told) {
        message = g_strdup_printf("there are signs, which no %s says", by);
        complain(error, message, "save the expressions and draw them with `limner depict --expressions`");
    } else if (strpbrk(wish->path, "{}")) {
        message = g_strdup("the file's name has braces, which stand for other names in commands");
        complain(error, message, "give the file a name without { and }");
    }
    g_free(message);
    return !message;
}

GStrv command_words(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error)
{
    if (!is_sayable(s, wish, "command", error))
        return NULL;
    lmn_draw_desc d;
    char         *selector = state_selector(s, scene);
    GStrvBuilder *words = g_strv_builder_new();
    wish_describe(s, scene, wish, selector, &d);
    add(words, "limner");
    add(words, "draw");
    for (size_t i = 0; scene->paths[i]; i++)
        add(words, "%s", scene->paths[i]);
    bool good = add_look(words, s->look, error);
    add_camera(words, &d);
    if (selector) {
        add(words, "--select");
        add(words, "%s", selector);
    }
    add_time(words, &d, wish);
    add_page(words, &d);
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

static void print_desc(GString *out, const lmn_draw_desc *d)
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
    if (d->dpi > 0)
        g_string_append_printf(out, "    desc.dpi = %s;\n", number_text(d->dpi, t));
    if (d->samples)
        g_string_append_printf(out, "    desc.samples = %d;\n", d->samples);
    if (d->background)
        print_text(out, "    desc.background = ", d->background, ";\n");
}

static void print_picture(GString *out, const export_wish *wish)
{
    g_string_append(out, "    lmn_drawing *drawing = NULL;\n"
                         "    check(lmn_draw(&drawing, renderer, scene, look, &desc, &error), &error);\n");
    print_text(out, "    check(lmn_drawing_write(drawing, ", wish->path, ", NULL, NULL, &error), &error);\n");
    g_string_append(out, "    lmn_drawing_destroy(&drawing);\n");
}

static void print_sheet(GString *out, const export_wish *wish, bool lines_only)
{
    g_string_append_printf(out,
                           "    lmn_sheet     *sheet = NULL;\n"
                           "    lmn_sheet_desc page = LMN_SHEET_DESC_INIT;\n"
                           "%s"
                           "    check(lmn_draw_sheet(&sheet, renderer, scene, look, &desc, &page, &error), &error);\n",
                           lines_only ? "    page.lines_only = true;\n" : "");
    print_text(out, "    check(lmn_sheet_write(sheet, ", wish->path, ", NULL, NULL, &error), &error);\n");
    g_string_append(out, "    lmn_sheet_destroy(&sheet);\n");
}

static void print_film(GString *out, const export_wish *wish)
{
    char t[NUMBER_MAX];
    long first, last;
    wish_frames(wish, &first, &last);
    g_string_append_printf(out,
                           "    lmn_film     *film = NULL;\n"
                           "    lmn_film_desc frames = LMN_FILM_DESC_INIT;\n"
                           "    frames.width = desc.width;\n"
                           "    frames.height = desc.height;\n"
                           "    frames.rate = %s;\n"
                           "    frames.frame_count = %ld;\n"
                           "    desc.fit_time = lmn_scene_info_of(scene).animations > 0;\n",
                           number_text(wish->rate, t), last - first + 1);
    print_text(out, "    check(lmn_film_open(&film, ", wish->path, ", &frames, &error), &error);\n");
    g_string_append_printf(
        out,
        "    for (long i = %ld; i <= %ld; i++) {\n"
        "        lmn_drawing *drawing = NULL;\n"
        "        desc.time_s = (double)i / frames.rate;\n"
        "        check(lmn_draw(&drawing, renderer, scene, look, &desc, &error), &error);\n"
        "        check(lmn_film_add(film, lmn_drawing_pixels(drawing, NULL, NULL), &error), &error);\n"
        "        lmn_drawing_destroy(&drawing);\n"
        "    }\n"
        "    check(lmn_film_close(&film, NULL, &error), &error);\n",
        first, last);
}

static void print_drawing(GString *out, const view_state *s, const export_wish *wish)
{
    lmn_format_info format;
    wish_kind       kind = wish_kind_of(wish->path, &format);
    if (kind != WISH_SHEET || (format.pictures && lmn_look_needs_pixels(s->look->look)))
        g_string_append(out, "    lmn_renderer_desc with = LMN_RENDERER_DESC_INIT;\n"
                             "    check(lmn_renderer_create(&renderer, &with, &error), &error);\n");
    if (kind == WISH_SHEET)
        print_sheet(out, wish, !format.pictures);
    else if (kind == WISH_FILM)
        print_film(out, wish);
    else
        print_picture(out, wish);
}

char *command_in_c(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error)
{
    if (!is_sayable(s, wish, "program", error))
        return NULL;
    lmn_draw_desc d;
    char         *selector = state_selector(s, scene);
    wish_describe(s, scene, wish, selector, &d);
    GString *out = g_string_new("/* cc drawing.c $(pkg-config --cflags --libs limner) */\n"
                                "#include <limner/limner.h>\n"
                                "#include <stdio.h>\n"
                                "#include <stdlib.h>\n\n"
                                "static void check(lmn_status status, const lmn_error *error)\n{\n"
                                "    if (status == LMN_OK)\n        return;\n"
                                "    fprintf(stderr, \"%s\\n\", error->message);\n"
                                "    exit(1);\n}\n\n"
                                "int main(void)\n{\n"
                                "    lmn_error     error = {0};\n"
                                "    lmn_scene    *scene = NULL;\n"
                                "    lmn_look     *look = NULL;\n"
                                "    lmn_renderer *renderer = NULL;\n"
                                "    lmn_load_desc load = LMN_LOAD_DESC_INIT;\n"
                                "    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;\n"
                                "    check(lmn_scene_create(&scene, &error), &error);\n");
    for (size_t i = 0; scene->paths[i]; i++)
        print_text(out, "    check(lmn_scene_add_file(scene, ", scene->paths[i], ", &load, &error), &error);\n");
    bool good = print_look(out, s->look, error);
    print_desc(out, &d);
    print_drawing(out, s, wish);
    g_string_append(out, "    lmn_renderer_destroy(&renderer);\n"
                         "    lmn_look_destroy(&look);\n"
                         "    lmn_scene_destroy(&scene);\n"
                         "    return 0;\n}\n");
    g_free(selector);
    return g_string_free(out, !good);
}
