#include "controls_row.h"

#include <math.h>
#include <string.h>

#include "controls_value.h"
#include "words.h"

struct control_row {
    lmn_param_info info;
    place          where;
    control_set    set;
    void          *owner;
    GtkWidget     *row, *value, *entry, *reset; /* value: slider, switch, drop-down, box of colours; entry: of text */
    char          *folded;                      /* name and documentation, as search compares them */
    bool           follows;
};

GtkWidget *control_row_widget(control_row *r)
{
    return r->row;
}

static void show_error(control_row *r, const char *message)
{
    GtkWidget *at = r->entry ? r->entry : r->row;
    (message ? gtk_widget_add_css_class : gtk_widget_remove_css_class)(at, "error");
    gtk_widget_set_tooltip_text(at, message ? message : r->info.doc);
}

static void set(control_row *r, const char *value)
{
    lmn_error error = {0};
    if (r->follows)
        return;
    bool done = r->set(r->owner, &r->where, r->info.key, value, &error);
    show_error(r, done ? NULL : error.message);
}

/* --- widgets by type ------------------------------------------------------------------------------------- */

static void switched(GObject *value, GParamSpec *pspec, gpointer row)
{
    (void)pspec;
    set(row, gtk_switch_get_active(GTK_SWITCH(value)) ? "true" : "false");
}

static void slid(GtkRange *range, gpointer user)
{
    control_row *r = user;
    char         text[G_ASCII_DTOSTR_BUF_SIZE];
    set(r, g_ascii_formatd(text, sizeof text, "%.6g", slider_value(&r->info, gtk_range_get_value(range))));
}

static void picked(GObject *value, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    control_row *r = user;
    guint        at = gtk_drop_down_get_selected(GTK_DROP_DOWN(value));
    if (at < r->info.name_count)
        set(r, r->info.names[at]);
}

static void typed(GtkEditable *entry, gpointer row)
{
    set(row, gtk_editable_get_text(entry));
}

static void append_colour(GString *out, const GdkRGBA *c)
{
    const float of[4] = {c->red, c->green, c->blue, c->alpha};
    g_string_append(out, out->len ? ",#" : "#");
    for (int k = 0; k < (c->alpha < 1 ? 4 : 3); k++)
        g_string_append_printf(out, "%02x", (unsigned)lrintf(of[k] * 255));
}

static void coloured(GtkColorButton *button, gpointer user)
{
    (void)button;
    control_row *r = user;
    GString     *text = g_string_new(NULL);
    for (GtkWidget *w = gtk_widget_get_first_child(r->value); w; w = gtk_widget_get_next_sibling(w)) {
        GdkRGBA c;
        gtk_color_chooser_get_rgba(GTK_COLOR_CHOOSER(w), &c);
        append_colour(text, &c);
    }
    set(r, text->str);
    g_string_free(text, TRUE);
}

static void reset(GtkButton *button, gpointer row)
{
    (void)button;
    set(row, NULL);
}

static GtkWidget *make_entry(control_row *r, int width)
{
    GtkWidget *out = gtk_entry_new();
    gtk_editable_set_width_chars(GTK_EDITABLE(out), width);
    gtk_editable_set_max_width_chars(GTK_EDITABLE(out), width);
    gtk_widget_set_valign(out, GTK_ALIGN_CENTER);
    g_signal_connect(out, "changed", G_CALLBACK(typed), r);
    return out;
}

static GtkWidget *make_slider(control_row *r)
{
    GtkWidget *out = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, 0, 1, 0.01);
    gtk_scale_set_draw_value(GTK_SCALE(out), FALSE);
    gtk_widget_set_size_request(out, 90, -1);
    gtk_widget_set_valign(out, GTK_ALIGN_CENTER);
    g_signal_connect(out, "value-changed", G_CALLBACK(slid), r);
    return out;
}

static GtkWidget *make_choice(control_row *r)
{
    GtkStringList *names = gtk_string_list_new(NULL);
    for (size_t i = 0; i < r->info.name_count; i++)
        gtk_string_list_append(names, r->info.names[i]);
    GtkWidget *out = gtk_drop_down_new(G_LIST_MODEL(names), NULL);
    gtk_widget_set_valign(out, GTK_ALIGN_CENTER);
    g_signal_connect(out, "notify::selected", G_CALLBACK(picked), r);
    return out;
}

static void make_widgets(control_row *r)
{
    switch (r->info.type) {
    case LMN_PARAM_BOOL:
        r->value = gtk_switch_new();
        gtk_widget_set_valign(r->value, GTK_ALIGN_CENTER);
        g_signal_connect(r->value, "notify::active", G_CALLBACK(switched), r);
        break;
    case LMN_PARAM_INT:
    case LMN_PARAM_FLOAT:
        r->value = make_slider(r);
        r->entry = make_entry(r, 6);
        break;
    case LMN_PARAM_ENUM: r->value = make_choice(r); break;
    case LMN_PARAM_COLOUR:
    case LMN_PARAM_PALETTE:
        r->value = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 2);
        gtk_widget_set_valign(r->value, GTK_ALIGN_CENTER);
        if (r->info.can_auto)
            r->entry = make_entry(r, 8);
        break;
    default: r->entry = make_entry(r, 14); break;
    }
}

/* --- a row ----------------------------------------------------------------------------------------------- */

static void name_widget(GtkWidget *widget, const control_row *r, const char *suffix)
{
    char *name = g_strdup_printf("%s.%s%s", r->where.kind, r->info.key, suffix);
    if (widget)
        gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
    g_free(name);
}

control_row *control_row_new(const lmn_param_info *info, const place *where, control_set setter, void *owner)
{
    control_row *r = g_new0(control_row, 1);
    char         title[64];
    r->info = *info;
    r->where = *where;
    r->set = setter;
    r->owner = owner;
    param_title(info->key, title, sizeof title);
    const char *unit = param_unit_text(info->unit);
    if (*unit)
        snprintf(title + strlen(title), sizeof title - strlen(title), " (%s)", unit);
    char *text = g_strdup_printf("%s %s %s", title, info->key, info->doc);
    r->folded = g_utf8_casefold(text, -1);
    g_free(text);
    r->row = adw_action_row_new();
    adw_preferences_row_set_title(ADW_PREFERENCES_ROW(r->row), title);
    gtk_widget_set_tooltip_text(r->row, info->doc);
    make_widgets(r);
    r->reset = gtk_button_new_from_icon_name("edit-clear-symbolic");
    gtk_widget_add_css_class(r->reset, "flat");
    gtk_widget_set_valign(r->reset, GTK_ALIGN_CENTER);
    gtk_widget_set_tooltip_text(r->reset, _("Back to the default"));
    g_signal_connect(r->reset, "clicked", G_CALLBACK(reset), r);
    GtkWidget *all[] = {r->value, r->entry, r->reset};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        if (all[i])
            adw_action_row_add_suffix(ADW_ACTION_ROW(r->row), all[i]);
    name_widget(r->value, r, "");
    name_widget(r->entry, r, r->value ? " as text" : "");
    name_widget(r->reset, r, " reset");
    return r;
}

void control_row_free(control_row *r)
{
    g_free(r->folded);
    g_free(r);
}

/* --- what the look has ----------------------------------------------------------------------------------- */

static void show_colours(control_row *r, const lmn_look *look)
{
    float     rgba[4 * LMN_PALETTE_MAX];
    size_t    count = 0;
    lmn_error error = {0};
    lmn_look_get_colours(look, r->where.rule, r->where.kind, r->where.index, r->info.key, rgba, &count, &error);
    size_t shown = count ? count : 1;
    for (GtkWidget *w = gtk_widget_get_first_child(r->value); w;
         w = gtk_widget_get_first_child(r->value), shown = shown) {
        size_t there = 0;
        for (GtkWidget *i = w; i; i = gtk_widget_get_next_sibling(i))
            there++;
        if (there <= shown)
            break;
        gtk_box_remove(GTK_BOX(r->value), w);
    }
    size_t     i = 0;
    GtkWidget *w = gtk_widget_get_first_child(r->value);
    for (; i < shown; i++, w = w ? gtk_widget_get_next_sibling(w) : NULL) {
        if (!w) {
            w = gtk_color_button_new();
            gtk_color_chooser_set_use_alpha(GTK_COLOR_CHOOSER(w), TRUE);
            gtk_accessible_update_property(GTK_ACCESSIBLE(w), GTK_ACCESSIBLE_PROPERTY_LABEL, r->info.key, -1);
            g_signal_connect(w, "color-set", G_CALLBACK(coloured), r);
            gtk_box_append(GTK_BOX(r->value), w);
        }
        GdkRGBA c = {0.5f, 0.5f, 0.5f, 1};
        if (count)
            c = (GdkRGBA){rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2], rgba[4 * i + 3]};
        gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(w), &c);
    }
}

static void show_value(control_row *r, const lmn_look *look)
{
    double    number = 0;
    lmn_error error = {0};
    if (r->info.type <= LMN_PARAM_ENUM)
        lmn_look_get_number(look, r->where.rule, r->where.kind, r->where.index, r->info.key, &number, &error);
    switch (r->info.type) {
    case LMN_PARAM_BOOL: gtk_switch_set_active(GTK_SWITCH(r->value), number != 0); break;
    case LMN_PARAM_INT:
    case LMN_PARAM_FLOAT:
        /* While somebody drags it the slider stays where it is held, not where rounding puts it. */
        if (fabs(slider_value(&r->info, gtk_range_get_value(GTK_RANGE(r->value))) - number) > 1e-6 * fabs(number))
            gtk_range_set_value(GTK_RANGE(r->value), slider_position(&r->info, number));
        break;
    case LMN_PARAM_ENUM:
        gtk_drop_down_set_selected(GTK_DROP_DOWN(r->value), isnan(number) ? GTK_INVALID_LIST_POSITION : (guint)number);
        break;
    case LMN_PARAM_COLOUR:
    case LMN_PARAM_PALETTE: show_colours(r, look); break;
    default: break;
    }
}

static void show_colour_text(control_row *r, const char *text)
{
    GtkWidget *button = gtk_widget_get_first_child(r->value);
    GdkRGBA    c = {0, 0, 0, 0};
    if (!button) {
        button = gtk_color_button_new();
        gtk_color_chooser_set_use_alpha(GTK_COLOR_CHOOSER(button), TRUE);
        name_widget(button, r, "");
        g_signal_connect(button, "color-set", G_CALLBACK(coloured), r);
        gtk_box_append(GTK_BOX(r->value), button);
    }
    gdk_rgba_parse(&c, text); /* "none" has no colour */
    gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(button), &c);
}

static void show_number_text(control_row *r, const char *text)
{
    const double number = g_ascii_strtod(text, NULL);
    if (fabs(slider_value(&r->info, gtk_range_get_value(GTK_RANGE(r->value))) - number) > 1e-6 * fabs(number))
        gtk_range_set_value(GTK_RANGE(r->value), slider_position(&r->info, number));
}

void control_row_show_text(control_row *r, const char *text, bool is_default)
{
    guint chosen = GTK_INVALID_LIST_POSITION;
    for (size_t i = 0; i < r->info.name_count; i++)
        chosen = strcmp(r->info.names[i], text) == 0 ? (guint)i : chosen;
    r->follows = true;
    switch (r->info.type) {
    case LMN_PARAM_BOOL: gtk_switch_set_active(GTK_SWITCH(r->value), strcmp(text, "true") == 0); break;
    case LMN_PARAM_INT:
    case LMN_PARAM_FLOAT: show_number_text(r, text); break;
    case LMN_PARAM_ENUM: gtk_drop_down_set_selected(GTK_DROP_DOWN(r->value), chosen); break;
    case LMN_PARAM_COLOUR: show_colour_text(r, text); break;
    default: break;
    }
    if (r->entry && !gtk_widget_has_focus(gtk_widget_get_first_child(r->entry)) &&
        strcmp(gtk_editable_get_text(GTK_EDITABLE(r->entry)), text) != 0)
        gtk_editable_set_text(GTK_EDITABLE(r->entry), text);
    gtk_widget_set_opacity(r->reset, is_default ? 0 : 1);
    gtk_widget_set_sensitive(r->reset, !is_default);
    show_error(r, NULL);
    r->follows = false;
}

void control_row_refresh(control_row *r, const lmn_look *look)
{
    char            text[LMN_VALUE_TEXT_MAX];
    lmn_param_state state = {.is_default = true, .applies = true};
    lmn_error       error = {0};
    if (lmn_look_get_text(look, r->where.rule, r->where.kind, r->where.index, r->info.key, text, sizeof text, &error) !=
        LMN_OK)
        return;
    lmn_look_param_state(look, r->where.rule, r->where.kind, r->where.index, r->info.key, &state, &error);
    r->follows = true;
    show_value(r, look);
    /* What is being typed stays as it is typed. */
    if (r->entry && !gtk_widget_has_focus(gtk_widget_get_first_child(r->entry)) &&
        strcmp(gtk_editable_get_text(GTK_EDITABLE(r->entry)), text) != 0)
        gtk_editable_set_text(GTK_EDITABLE(r->entry), text);
    gtk_widget_set_opacity(r->reset, state.is_default ? 0 : 1);
    gtk_widget_set_sensitive(r->reset, !state.is_default);
    show_error(r, NULL);
    r->follows = false;
}

bool control_row_show(control_row *r, const lmn_look *look, const char *wanted)
{
    lmn_param_state state = {.applies = true};
    lmn_error       error = {0};
    lmn_look_param_state(look, r->where.rule, r->where.kind, r->where.index, r->info.key, &state, &error);
    bool shown = state.applies && (!*wanted || strstr(r->folded, wanted));
    gtk_widget_set_visible(r->row, shown);
    return shown;
}
