#include "controls.h"

#include <string.h>

#include "controls_row.h"
#include "controls_scale.h"
#include "trace.h"
#include "words.h"

/* One technique of a rule or of the whole look, as a group of rows. */
typedef struct group {
    place      where;
    GtkWidget *widget;
    GPtrArray *rows; /* of control_row */
} group;

typedef struct controls {
    document  *document;
    GtkWidget *box, *rules, *selector, *list, *search;
    GtkWidget *whole;  /* the group of scales */
    GPtrArray *scales; /* of scale_row */
    GPtrArray *groups; /* of group */
    char      *shape;  /* which techniques the groups show: another one, and they are made anew */
    size_t     rule;
    bool       follows;
} controls;

static const lmn_look *look_of(const controls *c)
{
    return document_state(c->document)->look->look;
}

/* --- changes --------------------------------------------------------------------------------------------- */

/* Takes the look when the change went well, else ends it and says why. */
static bool put(controls *c, lmn_look *look, lmn_status status, const lmn_error *error, const char *what)
{
    if (look && status == LMN_OK) {
        document_put_look(c->document, look, what);
        return true;
    }
    trace_event("refused %s", error->message);
    lmn_look_destroy(&look);
    return false;
}

static bool set_value(void *owner, const place *where, const char *key, const char *value, lmn_error *error)
{
    controls  *c = owner;
    lmn_look  *look = document_copy_look(c->document, error);
    lmn_status status = !look    ? error->status
                        : !value ? lmn_look_reset(look, where->rule, where->kind, where->index, key, error)
                                 : lmn_look_set_text(look, where->rule, where->kind, where->index, key, value, error);
    char      *name = g_strdup_printf("%s.%s", where->kind, key);
    bool       done = put(c, look, status, error, g_intern_string(name));
    g_free(name);
    return done;
}

static bool set_control(void *owner, const char *name, double value)
{
    controls  *c = owner;
    lmn_error  error = {0};
    lmn_look  *look = document_copy_look(c->document, &error);
    lmn_status status = look ? lmn_look_set_control(look, name, value, &error) : error.status;
    return put(c, look, status, &error, g_intern_string(name));
}

static void technique_chosen(GObject *row, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    controls   *c = user;
    group      *g = g_object_get_data(row, "group");
    GListModel *names = adw_combo_row_get_model(ADW_COMBO_ROW(row));
    const char *name =
        gtk_string_list_get_string(GTK_STRING_LIST(names), adw_combo_row_get_selected(ADW_COMBO_ROW(row)));
    lmn_error error = {0};
    if (c->follows || !name)
        return;
    lmn_look  *look = document_copy_look(c->document, &error);
    bool       none = lmn_look_technique_count(look, g->where.rule, g->where.kind) == 0;
    bool       away = strcmp(name, "none") == 0;
    lmn_status status = away && none ? LMN_OK
                        : away ? lmn_look_remove_technique(look, g->where.rule, g->where.kind, g->where.index, &error)
                        : none
                            ? lmn_look_add_technique(look, g->where.rule, g->where.kind, name, LMN_AT_END, &error)
                            : lmn_look_set_technique(look, g->where.rule, g->where.kind, g->where.index, name, &error);
    document_end_step(c->document);
    put(c, look, status, &error, _("Technique"));
}

/* --- groups ---------------------------------------------------------------------------------------------- */

static void row_free(void *row)
{
    control_row_free(row);
}

static void group_free(void *data)
{
    group *g = data;
    g_ptr_array_unref(g->rows);
    g_free(g);
}

/* The choice of a kind's technique; kinds that may have none offer that, too. */
static void add_choice(controls *c, group *g, const lmn_kind_info *kind, const char *now)
{
    GtkStringList     *names = gtk_string_list_new(NULL);
    lmn_technique_info technique;
    guint              selected = 0, count = 0;
    if (kind->optional || !now) {
        gtk_string_list_append(names, "none");
        count++;
    }
    for (size_t i = 0; i < kind->technique_count && lmn_technique_at(kind->name, i, &technique); i++, count++) {
        gtk_string_list_append(names, technique.name);
        if (g_strcmp0(technique.name, now) == 0)
            selected = count;
    }
    GtkWidget *row = adw_combo_row_new();
    adw_preferences_row_set_title(ADW_PREFERENCES_ROW(row), _("Technique"));
    adw_combo_row_set_model(ADW_COMBO_ROW(row), G_LIST_MODEL(names));
    adw_combo_row_set_selected(ADW_COMBO_ROW(row), selected);
    g_object_unref(names);
    char *name = g_strdup_printf("%s technique", kind->name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(row), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
    g_free(name);
    g_object_set_data(G_OBJECT(row), "group", g);
    g_signal_connect(row, "notify::selected", G_CALLBACK(technique_chosen), c);
    adw_preferences_group_add(ADW_PREFERENCES_GROUP(g->widget), row);
}

static void add_group(controls *c, const lmn_kind_info *kind, size_t rule, size_t index, const char *technique)
{
    group *g = g_new0(group, 1);
    g->where = (place){rule, kind->name, index};
    g->rows = g_ptr_array_new_with_free_func(row_free);
    g->widget = adw_preferences_group_new();
    char *title = g_strdup(kind->name);
    title[0] = g_ascii_toupper(title[0]);
    adw_preferences_group_set_title(ADW_PREFERENCES_GROUP(g->widget), title);
    g_free(title);
    char *doc = g_markup_escape_text(kind->doc, -1);
    adw_preferences_group_set_description(ADW_PREFERENCES_GROUP(g->widget), doc);
    g_free(doc);
    add_choice(c, g, kind, technique);
    lmn_param_info info;
    for (size_t i = 0; technique && lmn_param_at(kind->name, technique, i, &info); i++) {
        control_row *row = control_row_new(&info, &g->where, set_value, c);
        adw_preferences_group_add(ADW_PREFERENCES_GROUP(g->widget), control_row_widget(row));
        g_ptr_array_add(g->rows, row);
    }
    g_ptr_array_add(c->groups, g);
    gtk_box_append(GTK_BOX(c->list), g->widget);
}

/* The look's controls, above all parameters. */
static GtkWidget *make_scales(controls *c)
{
    lmn_control_info info;
    c->whole = adw_preferences_group_new();
    c->scales = g_ptr_array_new_with_free_func((GDestroyNotify)scale_row_free);
    for (size_t i = 0; lmn_control_at(i, &info); i++) {
        scale_row *row = scale_row_new(&info, set_control, c);
        adw_preferences_group_add(ADW_PREFERENCES_GROUP(c->whole), scale_row_widget(row));
        g_ptr_array_add(c->scales, row);
    }
    return c->whole;
}

/* What the groups show, as text: rule, kinds and techniques. */
static char *shape_of(const controls *c)
{
    GString      *out = g_string_new(NULL);
    lmn_kind_info kind;
    g_string_append_printf(out, "%zu/%zu", c->rule, lmn_look_rule_count(look_of(c)));
    for (size_t i = 0; i < lmn_kind_count() && lmn_kind_at(i, &kind); i++) {
        size_t rule = kind.whole_look ? LMN_WHOLE_LOOK : c->rule;
        size_t count = lmn_look_technique_count(look_of(c), rule, kind.name);
        for (size_t k = 0; k < count; k++)
            g_string_append_printf(out, " %s=%s", kind.name, lmn_look_technique(look_of(c), rule, kind.name, k));
    }
    return g_string_free(out, FALSE);
}

static void clear(GtkWidget *box)
{
    for (GtkWidget *child = gtk_widget_get_first_child(box); child; child = gtk_widget_get_first_child(box))
        gtk_box_remove(GTK_BOX(box), child);
}

static void build_groups(controls *c)
{
    lmn_kind_info kind;
    g_ptr_array_set_size(c->groups, 0);
    clear(c->list);
    /* What is of the rule comes before what is of the whole look. */
    for (size_t i = 0; i < 2 * lmn_kind_count() && lmn_kind_at(i % lmn_kind_count(), &kind); i++) {
        size_t rule = kind.whole_look ? LMN_WHOLE_LOOK : c->rule;
        size_t count = lmn_look_technique_count(look_of(c), rule, kind.name);
        if (kind.whole_look != (i >= lmn_kind_count()))
            continue;
        if (count == 0)
            add_group(c, &kind, rule, 0, NULL);
        for (size_t k = 0; k < count; k++)
            add_group(c, &kind, rule, k, lmn_look_technique(look_of(c), rule, kind.name, k));
    }
}

/* --- search ---------------------------------------------------------------------------------------------- */

static void show_found(controls *c)
{
    char *wanted = g_utf8_casefold(gtk_editable_get_text(GTK_EDITABLE(c->search)), -1);
    bool  some = false;
    for (guint i = 0; i < c->scales->len; i++)
        some |= scale_row_show(g_ptr_array_index(c->scales, i), look_of(c), wanted);
    gtk_widget_set_visible(c->whole, some);
    for (guint i = 0; i < c->groups->len; i++) {
        group *g = g_ptr_array_index(c->groups, i);
        bool   any = !*wanted;
        for (guint k = 0; k < g->rows->len; k++)
            any |= control_row_show(g_ptr_array_index(g->rows, k), look_of(c), wanted);
        gtk_widget_set_visible(g->widget, any);
    }
    g_free(wanted);
}

static void searched(GtkSearchEntry *entry, gpointer user)
{
    (void)entry;
    show_found(user);
}

/* --- rules ----------------------------------------------------------------------------------------------- */

static void list_rules(controls *c)
{
    GtkStringList *names = gtk_string_list_new(NULL);
    size_t         count = lmn_look_rule_count(look_of(c));
    if (c->rule >= count)
        c->rule = count - 1;
    for (size_t i = 0; i < count; i++) {
        const char *name = lmn_look_rule_name(look_of(c), i);
        char *text = g_strdup_printf("%zu  %s", i + 1, name && *name ? name : lmn_look_rule_selector(look_of(c), i));
        gtk_string_list_append(names, text);
        g_free(text);
    }
    gtk_drop_down_set_model(GTK_DROP_DOWN(c->rules), G_LIST_MODEL(names));
    gtk_drop_down_set_selected(GTK_DROP_DOWN(c->rules), (guint)c->rule);
    g_object_unref(names);
    const char *selector = lmn_look_rule_selector(look_of(c), c->rule);
    if (g_strcmp0(gtk_editable_get_text(GTK_EDITABLE(c->selector)), selector) != 0)
        gtk_editable_set_text(GTK_EDITABLE(c->selector), selector ? selector : "");
    gtk_widget_remove_css_class(c->selector, "error");
}

static void refresh(controls *c)
{
    c->follows = true;
    list_rules(c);
    char *shape = shape_of(c);
    if (g_strcmp0(shape, c->shape) != 0) {
        build_groups(c);
        g_free(c->shape);
        c->shape = g_strdup(shape);
    }
    g_free(shape);
    for (guint i = 0; i < c->scales->len; i++)
        scale_row_refresh(g_ptr_array_index(c->scales, i), look_of(c));
    for (guint i = 0; i < c->groups->len; i++) {
        group *g = g_ptr_array_index(c->groups, i);
        for (guint k = 0; k < g->rows->len; k++)
            control_row_refresh(g_ptr_array_index(g->rows, k), look_of(c));
    }
    show_found(c);
    c->follows = false;
}

static void rule_chosen(GObject *rules, GParamSpec *pspec, gpointer user)
{
    (void)rules;
    (void)pspec;
    controls *c = user;
    guint     at = gtk_drop_down_get_selected(GTK_DROP_DOWN(c->rules));
    if (c->follows || at == GTK_INVALID_LIST_POSITION || at == c->rule)
        return;
    c->rule = at;
    refresh(c);
}

static void rule_added(GtkButton *button, gpointer user)
{
    (void)button;
    controls  *c = user;
    lmn_error  error = {0};
    uint32_t   part = document_selected(c->document);
    char      *selector = part ? g_strdup_printf("[id=%u]", part) : g_strdup("*");
    size_t     rule = 0;
    lmn_look  *look = document_copy_look(c->document, &error);
    lmn_status status = look ? lmn_look_add_rule(look, selector, LMN_AT_END, &rule, &error) : error.status;
    g_free(selector);
    c->rule = status == LMN_OK ? rule : c->rule;
    document_end_step(c->document);
    put(c, look, status, &error, _("Add rule"));
}

static void rule_removed(GtkButton *button, gpointer user)
{
    (void)button;
    controls  *c = user;
    lmn_error  error = {0};
    lmn_look  *look = document_copy_look(c->document, &error);
    lmn_status status = look ? lmn_look_remove_rule(look, c->rule, &error) : error.status;
    document_end_step(c->document);
    put(c, look, status, &error, _("Remove rule"));
}

static void selector_typed(GtkEditable *entry, gpointer user)
{
    controls *c = user;
    lmn_error error = {0};
    if (c->follows)
        return;
    lmn_look  *look = document_copy_look(c->document, &error);
    lmn_status status =
        look ? lmn_look_set_rule_selector(look, c->rule, gtk_editable_get_text(entry), &error) : error.status;
    if (put(c, look, status, &error, _("Selector")))
        return;
    gtk_widget_add_css_class(c->selector, "error");
    gtk_widget_set_tooltip_text(c->selector, error.message);
}

static GtkWidget *button(const char *icon, const char *name, GCallback clicked, controls *c)
{
    GtkWidget *out = gtk_button_new_from_icon_name(icon);
    gtk_widget_set_tooltip_text(out, name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(out), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
    g_signal_connect(out, "clicked", clicked, c);
    return out;
}

static GtkWidget *make_rules(controls *c)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    c->rules = gtk_drop_down_new(NULL, NULL);
    gtk_widget_set_hexpand(c->rules, TRUE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(c->rules), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Rule"), -1);
    g_signal_connect(c->rules, "notify::selected", G_CALLBACK(rule_chosen), c);
    gtk_box_append(GTK_BOX(box), c->rules);
    gtk_box_append(GTK_BOX(box),
                   button("list-add-symbolic", _("Add a rule for the marked part"), G_CALLBACK(rule_added), c));
    gtk_box_append(GTK_BOX(box), button("list-remove-symbolic", _("Remove the rule"), G_CALLBACK(rule_removed), c));
    return box;
}

static void document_changed(document *d, unsigned changes, void *user)
{
    (void)d;
    if (changes & DOCUMENT_LOOK)
        refresh(user);
}

static void controls_free(void *data)
{
    controls *c = data;
    g_ptr_array_unref(c->scales);
    g_ptr_array_unref(c->groups);
    g_free(c->shape);
    g_free(c);
}

static void name_entry(GtkWidget *entry, const char *name)
{
    gtk_widget_set_tooltip_text(entry, name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(entry), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
}

GtkWidget *controls_new(document *d)
{
    controls *c = g_new0(controls, 1);
    c->document = d;
    c->groups = g_ptr_array_new_with_free_func(group_free);
    c->search = gtk_search_entry_new();
    name_entry(c->search, _("Search parameters"));
    g_signal_connect(c->search, "search-changed", G_CALLBACK(searched), c);
    c->selector = gtk_entry_new();
    name_entry(c->selector, _("Which parts the rule draws"));
    g_signal_connect(c->selector, "changed", G_CALLBACK(selector_typed), c);
    c->list = gtk_box_new(GTK_ORIENTATION_VERTICAL, 18);
    GtkWidget *scrolled = gtk_scrolled_window_new();
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), c->list);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_EXTERNAL, GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scrolled, TRUE);
    gtk_widget_set_margin_end(c->list, 12);
    gtk_widget_set_margin_bottom(c->list, 12);
    c->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6);
    gtk_widget_set_margin_top(c->box, 6);
    gtk_widget_set_margin_start(c->box, 6);
    gtk_widget_set_margin_end(c->box, 6);
    gtk_box_append(GTK_BOX(c->box), c->search);
    gtk_box_append(GTK_BOX(c->box), make_scales(c));
    gtk_box_append(GTK_BOX(c->box), make_rules(c));
    gtk_box_append(GTK_BOX(c->box), c->selector);
    gtk_box_append(GTK_BOX(c->box), scrolled);
    g_object_set_data_full(G_OBJECT(c->box), "controls", c, controls_free);
    document_listen(d, document_changed, c);
    refresh(c);
    return c->box;
}
