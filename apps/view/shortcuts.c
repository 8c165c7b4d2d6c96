#include "shortcuts.h"

#include "words.h"

static const struct {
    const char *group; /* the first of one has its name */
    const char *action, *keys[3], *doc;
} rows[] = {
    {N_("Files"), "win.open", {"<Control>o"}, N_("Open")},
    {NULL, "win.export", {"<Control>e"}, N_("Export")},
    {NULL, "win.print", {"<Control><Shift>p"}, N_("Print")},
    {NULL, "win.save-look", {"<Control>s"}, N_("Save the look")},
    {NULL, "win.copy-picture", {"<Control>c"}, N_("Copy the picture")},
    {NULL, "win.copy-command", {"<Control><Shift>c"}, N_("Copy as command")},
    {NULL, "app.new", {"<Control>n"}, N_("New window")},
    {NULL, "window.close", {"<Control>w"}, N_("Close the window")},
    {NULL, "app.quit", {"<Control>q"}, N_("Quit")},
    {N_("Changes"), "win.undo", {"<Control>z"}, N_("Undo")},
    {NULL, "win.redo", {"<Control><Shift>z", "<Control>y"}, N_("Redo")},
    {NULL, "win.compare", {"<Control>b"}, N_("Compare looks")},
    {N_("View"), "win.fit", {"<Control>0", "Home"}, N_("Fit")},
    {NULL, "win.view('front')", {"<Control>1"}, N_("From the front")},
    {NULL, "win.view('back')", {"<Control>2"}, N_("From behind")},
    {NULL, "win.view('left')", {"<Control>3"}, N_("From the left")},
    {NULL, "win.view('right')", {"<Control>4"}, N_("From the right")},
    {NULL, "win.view('top')", {"<Control>5"}, N_("From above")},
    {NULL, "win.view('bottom')", {"<Control>6"}, N_("From below")},
    {NULL, "win.view('iso')", {"<Control>7"}, N_("Isometric")},
    {NULL, "win.view('best')", {"<Control>8"}, N_("Where most is seen")},
    {NULL, "win.parallel", {"<Control>p"}, N_("Parallel projection")},
    {NULL, "win.walk", {"<Control>g"}, N_("Walk")},
    {NULL, "win.turntable", {"<Control>t"}, N_("Turntable")},
    {NULL, "win.play", {"<Control>space"}, N_("Play")},
    {N_("Parts"), "win.hide", {"<Control>h"}, N_("Hide or show the marked part")},
    {NULL, "win.alone", {"<Control>i"}, N_("Show it alone")},
    {NULL, "win.show-all", {"<Control><Shift>h"}, N_("Show all parts")},
    {N_("Help"), "win.keys", {"<Control>question", "F1"}, N_("These keys")},
};

/* What the picture itself answers to, without actions. */
static const struct {
    const char *keys, *doc;
} picture_rows[] = {
    {"Left Right Up Down", N_("Turn")},
    {"<Shift>Left <Shift>Right <Shift>Up <Shift>Down", N_("Move")},
    {"plus minus", N_("Nearer and farther")},
    {"w a s d q e", N_("Walk, when walking is on")},
};

void shortcuts_add(GtkApplication *application)
{
    for (size_t i = 0; i < G_N_ELEMENTS(rows); i++)
        gtk_application_set_accels_for_action(application, rows[i].action, rows[i].keys);
}

static void add_shortcut(GtkWidget *group, const char *keys, const char *doc)
{
    GtkWidget *out = g_object_new(GTK_TYPE_SHORTCUTS_SHORTCUT, "accelerator", keys, "title", _(doc), NULL);
    gtk_box_append(GTK_BOX(group), out);
}

static GtkWidget *add_group(GtkWidget *section, const char *title)
{
    GtkWidget *out = g_object_new(GTK_TYPE_SHORTCUTS_GROUP, "title", title, NULL);
    gtk_box_append(GTK_BOX(section), out);
    return out;
}

void shortcuts_show(GtkWindow *parent)
{
    GtkWidget *window = g_object_new(GTK_TYPE_SHORTCUTS_WINDOW, "modal", TRUE, "transient-for", parent, NULL);
    GtkWidget *section = g_object_new(GTK_TYPE_SHORTCUTS_SECTION, "section-name", "keys", "max-height", 14, NULL);
    GtkWidget *group = NULL;
    for (size_t i = 0; i < G_N_ELEMENTS(rows); i++) {
        if (rows[i].group)
            group = add_group(section, _(rows[i].group));
        char *keys = g_strjoinv(" ", (char **)rows[i].keys);
        add_shortcut(group, keys, rows[i].doc);
        g_free(keys);
    }
    group = add_group(section, _("In the picture"));
    for (size_t i = 0; i < G_N_ELEMENTS(picture_rows); i++)
        add_shortcut(group, picture_rows[i].keys, picture_rows[i].doc);
    gtk_window_set_child(GTK_WINDOW(window), section);
    gtk_window_present(GTK_WINDOW(window));
}
