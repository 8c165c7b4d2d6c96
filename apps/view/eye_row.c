#include "eye_row.h"

#include "words.h"

/* The eye is being set by the program: eye_row_show. */
static const char *const SETTING = "setting", *const ROW = "row";

void eye_row_setup(GtkListItem *item, PangoEllipsizeMode ellipsize, GCallback clicked, gpointer user)
{
    GtkWidget *expander = gtk_tree_expander_new(), *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 4);
    GtkWidget *label = gtk_label_new(NULL), *eye = gtk_toggle_button_new();
    gtk_label_set_xalign(GTK_LABEL(label), 0);
    gtk_label_set_ellipsize(GTK_LABEL(label), ellipsize);
    gtk_widget_set_hexpand(label, TRUE);
    gtk_widget_add_css_class(eye, "flat");
    gtk_widget_set_tooltip_text(eye, _("Show or hide"));
    g_signal_connect(eye, "toggled", clicked, user);
    gtk_box_append(GTK_BOX(box), label);
    gtk_box_append(GTK_BOX(box), eye);
    gtk_tree_expander_set_child(GTK_TREE_EXPANDER(expander), box);
    gtk_list_item_set_child(item, expander);
}

GtkWidget *eye_row_bind(GtkListItem *item, GtkTreeListRow *tree, const char *name, gpointer row)
{
    GtkTreeExpander *expander = GTK_TREE_EXPANDER(gtk_list_item_get_child(item));
    GtkWidget       *label = gtk_widget_get_first_child(gtk_tree_expander_get_child(expander));
    GtkWidget       *eye = gtk_widget_get_next_sibling(label);
    gtk_tree_expander_set_list_row(expander, tree);
    gtk_label_set_text(GTK_LABEL(label), name);
    gtk_widget_set_tooltip_text(label, name);
    g_object_set_data_full(G_OBJECT(eye), ROW, row, g_object_unref);
    return eye;
}

void eye_row_show(GtkWidget *eye, const char *name, bool shown)
{
    char *told = g_strdup_printf(_("Show %s"), name);
    g_object_set_data(G_OBJECT(eye), SETTING, GINT_TO_POINTER(1));
    gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(eye), shown);
    gtk_button_set_icon_name(GTK_BUTTON(eye), shown ? "view-reveal-symbolic" : "view-conceal-symbolic");
    g_object_set_data(G_OBJECT(eye), SETTING, NULL);
    gtk_accessible_update_property(GTK_ACCESSIBLE(eye), GTK_ACCESSIBLE_PROPERTY_LABEL, told, -1);
    g_free(told);
}

gpointer eye_row_clicked(GtkToggleButton *eye)
{
    return g_object_get_data(G_OBJECT(eye), SETTING) ? NULL : g_object_get_data(G_OBJECT(eye), ROW);
}

void eye_row_each(GtkWidget *widget, void (*show)(gpointer user, GtkWidget *eye, gpointer row), gpointer user)
{
    gpointer row = GTK_IS_TOGGLE_BUTTON(widget) ? g_object_get_data(G_OBJECT(widget), ROW) : NULL;
    if (row)
        show(user, widget, row);
    for (GtkWidget *c = gtk_widget_get_first_child(widget); c; c = gtk_widget_get_next_sibling(c))
        eye_row_each(c, show, user);
}
