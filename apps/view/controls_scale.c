#include "controls_scale.h"

#include <math.h>
#include <string.h>

#include "words.h"

struct scale_row {
    lmn_control_info info;
    scale_set        set;
    void            *owner;
    GtkWidget       *widget, *scale, *reset;
    bool             follows;
};

static void moved(GtkRange *range, gpointer user)
{
    scale_row *row = user;
    double     value = gtk_range_get_value(range);
    if (row->follows)
        return;
    value = fabs(value) < 0.03 ? 0 : round(value * 100) / 100; /* 0 is easy to hit */
    row->set(row->owner, row->info.name, value);
}

static void put_back(GtkButton *button, gpointer user)
{
    (void)button;
    scale_row *row = user;
    row->set(row->owner, row->info.name, 0);
}

scale_row *scale_row_new(const lmn_control_info *info, scale_set set, void *owner)
{
    scale_row *row = g_new0(scale_row, 1);
    row->info = *info;
    row->set = set;
    row->owner = owner;
    row->widget = adw_action_row_new();
    char *title = g_strdup(info->name);
    title[0] = g_ascii_toupper(title[0]);
    adw_preferences_row_set_title(ADW_PREFERENCES_ROW(row->widget), title);
    gtk_widget_set_tooltip_text(row->widget, info->doc);
    row->scale = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, -1, 1, 0.05);
    gtk_scale_set_draw_value(GTK_SCALE(row->scale), FALSE);
    gtk_scale_add_mark(GTK_SCALE(row->scale), 0, GTK_POS_BOTTOM, NULL);
    gtk_widget_set_size_request(row->scale, 150, -1);
    gtk_widget_set_valign(row->scale, GTK_ALIGN_CENTER);
    gtk_accessible_update_property(GTK_ACCESSIBLE(row->scale), GTK_ACCESSIBLE_PROPERTY_LABEL, title, -1);
    g_free(title);
    row->reset = gtk_button_new_from_icon_name("edit-undo-symbolic");
    gtk_widget_add_css_class(row->reset, "flat");
    gtk_widget_set_valign(row->reset, GTK_ALIGN_CENTER);
    gtk_widget_set_tooltip_text(row->reset, _("Back to the default"));
    adw_action_row_add_suffix(ADW_ACTION_ROW(row->widget), row->scale);
    adw_action_row_add_suffix(ADW_ACTION_ROW(row->widget), row->reset);
    g_signal_connect(row->scale, "value-changed", G_CALLBACK(moved), row);
    g_signal_connect(row->reset, "clicked", G_CALLBACK(put_back), row);
    return row;
}

void scale_row_free(scale_row *row)
{
    g_free(row);
}

GtkWidget *scale_row_widget(scale_row *row)
{
    return row->widget;
}

void scale_row_refresh(scale_row *row, const lmn_look *look)
{
    lmn_error error = {0};
    double    value = 0;
    row->follows = true;
    if (lmn_look_get_control(look, row->info.name, &value, &error) == LMN_OK)
        gtk_range_set_value(GTK_RANGE(row->scale), value);
    gtk_widget_set_sensitive(row->reset, value != 0);
    row->follows = false;
}

bool scale_row_show(scale_row *row, const lmn_look *look, const char *wanted)
{
    bool shown = lmn_look_has_control(look, row->info.name) && (!*wanted || strstr(row->info.name, wanted) != NULL);
    gtk_widget_set_visible(row->widget, shown);
    return shown;
}
