#include "signs.h"

#include <adwaita.h>
#include <string.h>

#include "controls_row.h"
#include "expressions.h"
#include "trace.h"
#include "words.h"

/* One expression, as rows. */
typedef struct row_group {
    GtkWidget *widget; /* an expander */
    size_t     depiction;
    GPtrArray *rows; /* of control_row */
} row_group;

typedef struct signs {
    document  *document; /* NULL after signs_close */
    artist    *artist;
    GtkWidget *box, *list, *ways, *said;
    GPtrArray *groups; /* of row_group */
    char      *shape;  /* what the groups show: another one, and they are made anew */
} signs;

enum { SLOT_PROPOSE = 6 };

/* What every expression has beside the parameters of its way to depict. */
static const lmn_param_info own_params[] = {
    {.key = "target", .type = LMN_PARAM_TEXT, .doc = N_("What it is told of: the name of a node or part")},
    {.key = "from", .type = LMN_PARAM_TEXT, .doc = N_("Where the interval begins, seconds; empty: at the begin")},
    {.key = "to", .type = LMN_PARAM_TEXT, .doc = N_("Where the interval ends, seconds; empty: at the end")},
    {.key = "now", .type = LMN_PARAM_TEXT, .doc = N_("What is before it is past; empty: the time that is shown")},
    {.key = "partner", .type = LMN_PARAM_TEXT, .doc = N_("Another thing that takes part; empty: none")},
};

static const char *told(const signs *s)
{
    return document_state(s->document)->told;
}

static void say(signs *s, const char *text)
{
    gtk_label_set_text(GTK_LABEL(s->said), text);
    gtk_widget_set_visible(s->said, *text != '\0');
}

/* Takes the list. */
static void put(signs *s, char *list, const char *what)
{
    say(s, "");
    trace_event("expressions count=%u", expressions_count(list));
    document_set_told(s->document, list, what);
}

/* --- options ----------------------------------------------------------------------------------------------- */

static bool find_param(const signs *s, guint index, const char *key, lmn_param_info *out)
{
    size_t depiction;
    for (size_t i = 0; i < G_N_ELEMENTS(own_params); i++)
        if (strcmp(own_params[i].key, key) == 0) {
            *out = own_params[i];
            return true;
        }
    if (!expressions_depiction(told(s), index, &depiction))
        return false;
    for (size_t i = 0; lmn_depiction_param_at(depiction, i, out); i++)
        if (strcmp(out->key, key) == 0)
            return true;
    return false;
}

/* Times are numbers that may be missing. */
static lmn_param_type type_of(const lmn_param_info *info)
{
    const bool is_time =
        strcmp(info->key, "from") == 0 || strcmp(info->key, "to") == 0 || strcmp(info->key, "now") == 0;
    return is_time ? LMN_PARAM_FLOAT : info->type;
}

static bool set_option(void *owner, const place *where, const char *key, const char *value, lmn_error *error)
{
    signs         *s = owner;
    lmn_param_info info = {.type = LMN_PARAM_TEXT};
    const guint    index = (guint)where->rule;
    if (!find_param(s, index, key, &info))
        return false;
    bool own = false; /* what is empty is not there */
    for (size_t i = 0; i < G_N_ELEMENTS(own_params); i++)
        own = own || strcmp(own_params[i].key, key) == 0;
    char *list = expressions_set(told(s), index, key, type_of(&info), own && value && !*value ? NULL : value, error);
    if (!list) {
        trace_event("refused %s", error->message);
        return false;
    }
    char *what = g_strdup_printf("%s.%s", where->kind, key);
    put(s, list, g_intern_string(what));
    g_free(what);
    return true;
}

static void show_option(const expressions_read *r, control_row *row, guint index, const lmn_param_info *info)
{
    char       *text = expressions_member(r, index, info->key);
    const char *otherwise = info->default_text;
    control_row_show_text(row, text ? text : otherwise, !text || strcmp(text, otherwise) == 0);
    g_free(text);
}

static void add_option(signs *s, row_group *g, const expressions_read *r, guint index, const char *kind,
                       const lmn_param_info *info)
{
    const place  where = {index, kind, 0};
    control_row *row = control_row_new(info, &where, set_option, s);
    g_ptr_array_add(g->rows, row);
    adw_expander_row_add_row(ADW_EXPANDER_ROW(g->widget), control_row_widget(row));
    show_option(r, row, index, info);
}

/* --- the list ---------------------------------------------------------------------------------------------- */

static void remove_clicked(GtkButton *button, gpointer user)
{
    signs      *s = user;
    const guint index = GPOINTER_TO_UINT(g_object_get_data(G_OBJECT(button), "index"));
    document_end_step(s->document);
    put(s, expressions_removed(told(s), index), _("Remove sign"));
}

static void name_it(GtkWidget *widget, const char *name)
{
    gtk_widget_set_tooltip_text(widget, name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
}

static void add_remover(signs *s, row_group *g, guint index, const char *depict)
{
    GtkWidget *out = gtk_button_new_from_icon_name("user-trash-symbolic");
    char      *name = g_strdup_printf(_("Remove %s"), depict);
    name_it(out, name);
    gtk_widget_add_css_class(out, "flat");
    gtk_widget_set_valign(out, GTK_ALIGN_CENTER);
    g_object_set_data(G_OBJECT(out), "index", GUINT_TO_POINTER(index));
    g_signal_connect(out, "clicked", G_CALLBACK(remove_clicked), s);
    adw_expander_row_add_action(ADW_EXPANDER_ROW(g->widget), out);
    g_free(name);
}

static void row_free(void *row)
{
    control_row_free(row);
}

static void group_free(void *data)
{
    row_group *g = data;
    g_ptr_array_unref(g->rows);
    g_free(g);
}

static void add_group(signs *s, const expressions_read *r, guint index)
{
    row_group     *g = g_new0(row_group, 1);
    lmn_param_info info;
    char          *target = expressions_member(r, index, "target"), *depict = expressions_member(r, index, "depict");
    const char    *kind = g_intern_string(depict ? depict : "");
    const bool     known = expressions_depiction(told(s), index, &g->depiction);
    g->rows = g_ptr_array_new_with_free_func(row_free);
    g->widget = adw_expander_row_new();
    adw_preferences_row_set_use_markup(ADW_PREFERENCES_ROW(g->widget), FALSE);
    adw_preferences_row_set_title(ADW_PREFERENCES_ROW(g->widget), kind);
    adw_expander_row_set_subtitle(ADW_EXPANDER_ROW(g->widget), target ? target : "");
    add_remover(s, g, index, kind);
    for (size_t i = 0; i < G_N_ELEMENTS(own_params); i++) {
        info = own_params[i];
        info.doc = _(own_params[i].doc);
        add_option(s, g, r, index, kind, &info);
    }
    for (size_t i = 0; known && lmn_depiction_param_at(g->depiction, i, &info); i++)
        add_option(s, g, r, index, kind, &info);
    gtk_list_box_append(GTK_LIST_BOX(s->list), g->widget);
    g_ptr_array_add(s->groups, g);
    g_free(target);
    g_free(depict);
}

/* Which expressions there are; their values are shown in the rows that are there. */
static char *shape_of(const signs *s)
{
    GString          *out = g_string_new(NULL);
    const guint       count = expressions_count(told(s));
    expressions_read *r = expressions_open(told(s));
    for (guint i = 0; i < count; i++) {
        char *depict = expressions_member(r, i, "depict");
        g_string_append_printf(out, "%s\n", depict ? depict : "");
        g_free(depict);
    }
    expressions_close(r);
    return g_string_free(out, FALSE);
}

static void build(signs *s)
{
    GtkWidget *child;
    g_ptr_array_set_size(s->groups, 0);
    while ((child = gtk_widget_get_first_child(s->list)))
        gtk_list_box_remove(GTK_LIST_BOX(s->list), child);
    const guint       count = expressions_count(told(s));
    expressions_read *r = expressions_open(told(s));
    for (guint i = 0; i < count; i++)
        add_group(s, r, i);
    expressions_close(r);
}

static void show_values(signs *s)
{
    expressions_read *r = expressions_open(told(s));
    for (guint i = 0; i < s->groups->len; i++) {
        row_group     *g = g_ptr_array_index(s->groups, i);
        lmn_param_info info;
        char          *target = expressions_member(r, i, "target");
        adw_expander_row_set_subtitle(ADW_EXPANDER_ROW(g->widget), target ? target : "");
        g_free(target);
        for (guint k = 0; k < g->rows->len; k++)
            if (k < G_N_ELEMENTS(own_params))
                show_option(r, g_ptr_array_index(g->rows, k), i, &own_params[k]);
            else if (lmn_depiction_param_at(g->depiction, k - G_N_ELEMENTS(own_params), &info))
                show_option(r, g_ptr_array_index(g->rows, k), i, &info);
    }
    expressions_close(r);
}

static void refresh(signs *s)
{
    char *shape = shape_of(s);
    if (g_strcmp0(shape, s->shape) != 0) {
        build(s);
        g_free(s->shape);
        s->shape = g_strdup(shape);
    } else
        show_values(s);
    g_free(shape);
}

/* --- what is proposed ---------------------------------------------------------------------------------------- */

typedef struct propose_job {
    artist_job  job;
    GtkWidget  *box; /* holds the signs */
    signs      *signs;
    scene_ref  *scene;
    view_state *state;
    char       *json;
} propose_job;

static lmn_status propose(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    propose_job    *j = (propose_job *)base;
    lmn_draw_desc   desc;
    lmn_depict_desc how = LMN_DEPICT_DESC_INIT;
    (void)renderer;
    state_describe(j->state, j->scene, NULL, 800, 600, &desc);
    lmn_status status = scene_ref_edit(j->scene, j->state->edits, error);
    scene_ref_lock(j->scene);
    if (status == LMN_OK)
        status = lmn_depict(j->scene->scene, &desc, &how, &j->json, error);
    scene_ref_unlock(j->scene);
    g_clear_pointer(&j->scene->signs, g_free); /* whoever draws next puts those of its own */
    j->scene->signs = g_strdup("proposed");
    return status;
}

static void proposed(artist_job *base, lmn_status status, const lmn_error *error)
{
    propose_job *j = (propose_job *)base;
    signs       *s = j->signs;
    if (!s->document)
        return;
    if (status != LMN_OK) {
        say(s, error->message);
        trace_event("not-proposed %s", error->message);
        return;
    }
    char *list = expressions_told(j->json);
    document_end_step(s->document);
    if (list && expressions_count(list) > 0) {
        put(s, list, _("Propose signs"));
        return;
    }
    g_clear_pointer(&list, g_ref_string_release);
    say(s, _("Nothing moves that could be told."));
}

static void propose_release(artist_job *base)
{
    propose_job *j = (propose_job *)base;
    lmn_text_free(j->json);
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_object_unref(j->box);
    g_free(j);
}

static void propose_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    signs       *s = user;
    propose_job *j = document_scene(s->document) ? g_new0(propose_job, 1) : NULL;
    if (!j)
        return;
    j->job = (artist_job){ARTIST_EDIT, SLOT_PROPOSE, propose, proposed, propose_release};
    j->box = g_object_ref(s->box);
    j->signs = s;
    j->scene = scene_ref_take((scene_ref *)document_scene(s->document));
    j->state = state_copy(document_state(s->document));
    artist_ask(s->artist, &j->job);
}

/* --- buttons --------------------------------------------------------------------------------------------------- */

/* Told of the first thing that an expression is told of already, or of nothing yet. */
static void add_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    signs             *s = user;
    lmn_depiction_info info;
    GListModel        *names = gtk_drop_down_get_model(GTK_DROP_DOWN(s->ways));
    const char        *way =
        gtk_string_list_get_string(GTK_STRING_LIST(names), gtk_drop_down_get_selected(GTK_DROP_DOWN(s->ways)));
    const uint32_t   part = document_selected(s->document);
    char            *target = expressions_get(told(s), 0, "target");
    lmn_part_info    marked;
    const scene_ref *scene = document_scene(s->document);
    if (scene)
        scene_ref_lock(scene);
    if (scene && part && lmn_scene_part_at(scene->scene, part - 1, &marked)) {
        g_free(target);
        target = g_strdup(marked.path);
    }
    if (scene)
        scene_ref_unlock(scene);
    if (way && lmn_depiction_at(0, &info) && target) {
        document_end_step(s->document);
        put(s, expressions_added(told(s), target, way), _("Add sign"));
    } else
        say(s, _("Mark a part first: a click in the picture does."));
    g_free(target);
}

static void clear_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    signs *s = user;
    document_end_step(s->document);
    put(s, NULL, _("Take signs away"));
}

static void save_to(signs *s, const char *path)
{
    lmn_error error = {0};
    bool      saved = expressions_save(told(s), path, &error);
    char     *text = saved ? g_strdup_printf(_("Saved in %s"), path) : g_strdup(error.message);
    say(s, text);
    trace_event(saved ? "saved-expressions %s" : "not-saved %s", saved ? path : error.message);
    g_free(text);
}

static void file_chosen(GtkNativeDialog *dialog, int response, gpointer user)
{
    signs *s = user;
    if (response == GTK_RESPONSE_ACCEPT && s->document) {
        GFile *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog));
        char  *path = g_file_get_path(file);
        save_to(s, path);
        g_free(path);
        g_object_unref(file);
    }
    g_object_unref(dialog);
    g_object_unref(s->box);
}

/* Into the script that is shown; of other files into one that is chosen. */
static void save_clicked(GtkButton *button, gpointer user)
{
    signs           *s = user;
    const scene_ref *scene = document_scene(s->document);
    for (size_t i = 0; scene && scene->paths[i]; i++)
        if (expressions_is_script(scene->paths[i])) {
            save_to(s, scene->paths[i]);
            return;
        }
    GtkFileChooserNative *dialog =
        gtk_file_chooser_native_new(_("Save expressions"), GTK_WINDOW(gtk_widget_get_root(GTK_WIDGET(button))),
                                    GTK_FILE_CHOOSER_ACTION_SAVE, _("_Save"), _("_Cancel"));
    gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(dialog), "told.json");
    g_object_ref(s->box);
    g_signal_connect(dialog, "response", G_CALLBACK(file_chosen), s);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

/* --- the panel ------------------------------------------------------------------------------------------------- */

static void add_button(signs *s, GtkWidget *box, const char *icon, const char *name, GCallback clicked)
{
    GtkWidget *out = gtk_button_new_from_icon_name(icon);
    name_it(out, name);
    g_signal_connect(out, "clicked", clicked, s);
    gtk_box_append(GTK_BOX(box), out);
}

static GtkWidget *make_buttons(signs *s)
{
    GtkWidget         *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    GtkStringList     *names = gtk_string_list_new(NULL);
    lmn_depiction_info info;
    for (size_t i = 0; lmn_depiction_at(i, &info); i++)
        if (!info.semantics)
            gtk_string_list_append(names, info.name);
    s->ways = gtk_drop_down_new(G_LIST_MODEL(names), NULL);
    name_it(s->ways, _("How it is told"));
    gtk_widget_set_hexpand(s->ways, TRUE);
    gtk_box_append(GTK_BOX(box), s->ways);
    add_button(s, box, "list-add-symbolic", _("Tell it of the marked part"), G_CALLBACK(add_clicked));
    add_button(s, box, "starred-symbolic", _("Propose signs"), G_CALLBACK(propose_clicked));
    add_button(s, box, "edit-clear-all-symbolic", _("Take all signs away"), G_CALLBACK(clear_clicked));
    add_button(s, box, "document-save-symbolic", _("Save expressions"), G_CALLBACK(save_clicked));
    return box;
}

static void document_changed(document *d, unsigned changes, void *user)
{
    (void)d;
    if (changes & (DOCUMENT_TOLD | DOCUMENT_SCENE))
        refresh(user);
}

static void signs_free(void *data)
{
    signs *s = data;
    g_ptr_array_unref(s->groups);
    g_free(s->shape);
    g_free(s);
}

GtkWidget *signs_new(document *d, artist *a)
{
    signs *s = g_new0(signs, 1);
    s->document = d;
    s->artist = a;
    s->groups = g_ptr_array_new_with_free_func(group_free);
    s->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6);
    gtk_widget_set_margin_top(s->box, 6);
    gtk_widget_set_margin_start(s->box, 6);
    gtk_widget_set_margin_end(s->box, 6);
    gtk_box_append(GTK_BOX(s->box), make_buttons(s));
    s->said = gtk_label_new("");
    gtk_label_set_wrap(GTK_LABEL(s->said), TRUE);
    gtk_label_set_xalign(GTK_LABEL(s->said), 0);
    gtk_widget_set_visible(s->said, FALSE);
    gtk_box_append(GTK_BOX(s->box), s->said);
    s->list = gtk_list_box_new();
    gtk_widget_add_css_class(s->list, "boxed-list");
    gtk_list_box_set_selection_mode(GTK_LIST_BOX(s->list), GTK_SELECTION_NONE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(s->list), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Signs"), -1);
    GtkWidget *scrolled = gtk_scrolled_window_new();
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), s->list);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_EXTERNAL, GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scrolled, TRUE);
    gtk_widget_set_margin_end(s->list, 12);
    gtk_widget_set_margin_bottom(s->list, 12);
    gtk_box_append(GTK_BOX(s->box), scrolled);
    g_object_set_data_full(G_OBJECT(s->box), "signs", s, signs_free);
    document_listen(d, document_changed, s);
    refresh(s);
    return s->box;
}

void signs_close(GtkWidget *box)
{
    signs *s = g_object_get_data(G_OBJECT(box), "signs");
    s->document = NULL;
}
