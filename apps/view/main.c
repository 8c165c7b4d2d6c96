/* limner-viewer: the program behind `limner view`. */
#include "trace.h"
#include "window.h"

static void open_files(GApplication *application, GFile **files, int count, const char *hint, gpointer user)
{
    (void)hint;
    (void)user;
    GPtrArray *paths = g_ptr_array_new_with_free_func(g_free);
    for (int i = 0; i < count; i++) {
        char *path = g_file_get_path(files[i]);
        if (path)
            g_ptr_array_add(paths, path);
    }
    g_ptr_array_add(paths, NULL);
    ViewWindow *w = view_window_new(ADW_APPLICATION(application));
    gtk_window_present(GTK_WINDOW(w));
    if (paths->len > 1)
        view_window_open(w, (const char *const *)paths->pdata);
    g_ptr_array_unref(paths);
}

static void activate(GApplication *application, gpointer user)
{
    (void)user;
    gtk_window_present(GTK_WINDOW(view_window_new(ADW_APPLICATION(application))));
}

static void add_keys(GtkApplication *application)
{
    static const struct {
        const char *action, *keys[3];
    } rows[] = {
        {"win.open", {"<Control>o"}},
        {"win.export", {"<Control>e"}},
        {"win.save-look", {"<Control>s"}},
        {"win.undo", {"<Control>z"}},
        {"win.redo", {"<Control><Shift>z", "<Control>y"}},
        {"win.fit", {"<Control>0", "Home"}},
        {"win.view('front')", {"<Control>1"}},
        {"win.view('back')", {"<Control>2"}},
        {"win.view('left')", {"<Control>3"}},
        {"win.view('right')", {"<Control>4"}},
        {"win.view('top')", {"<Control>5"}},
        {"win.view('bottom')", {"<Control>6"}},
        {"win.view('iso')", {"<Control>7"}},
        {"win.parallel", {"<Control>p"}},
        {"win.walk", {"<Control>g"}},
        {"win.turntable", {"<Control>t"}},
        {"win.compare", {"<Control>b"}},
        {"win.hide", {"<Control>h"}},
        {"win.alone", {"<Control>i"}},
        {"win.show-all", {"<Control><Shift>h"}},
        {"win.copy-command", {"<Control><Shift>c"}},
        {"win.copy-picture", {"<Control>c"}},
        {"win.keys", {"<Control>question", "F1"}},
        {"win.play", {"<Control>space"}},
        {"app.new", {"<Control>n"}},
        {"window.close", {"<Control>w"}},
        {"app.quit", {"<Control>q"}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(rows); i++)
        gtk_application_set_accels_for_action(application, rows[i].action, rows[i].keys);
}

static void new_window(GSimpleAction *action, GVariant *parameter, gpointer application)
{
    (void)action;
    (void)parameter;
    activate(application, NULL);
}

static void quit(GSimpleAction *action, GVariant *parameter, gpointer application)
{
    (void)action;
    (void)parameter;
    GList *windows = g_list_copy(gtk_application_get_windows(GTK_APPLICATION(application)));
    for (GList *i = windows; i; i = i->next)
        gtk_window_close(i->data);
    g_list_free(windows);
}

static void startup(GApplication *application, gpointer user)
{
    (void)user;
    static const GActionEntry actions[] = {{.name = "new", .activate = new_window}, {.name = "quit", .activate = quit}};
    g_action_map_add_action_entries(G_ACTION_MAP(application), actions, G_N_ELEMENTS(actions), application);
    add_keys(GTK_APPLICATION(application));
}

int main(int count, char **arguments)
{
    enum { NO_DISPLAY = 3 }; /* as the command's status where there is no driver */
    trace_begin();
    if (!gtk_init_check()) {
        g_printerr("limner: there is no display to show a window on\n"
                   "hint: `limner draw` writes a picture without one\n");
        return NO_DISPLAY;
    }
    AdwApplication *application =
        adw_application_new("io.github.limner.Viewer", G_APPLICATION_HANDLES_OPEN | G_APPLICATION_NON_UNIQUE);
    g_signal_connect(application, "startup", G_CALLBACK(startup), NULL);
    g_signal_connect(application, "activate", G_CALLBACK(activate), NULL);
    g_signal_connect(application, "open", G_CALLBACK(open_files), NULL);
    int status = g_application_run(G_APPLICATION(application), count, arguments);
    g_object_unref(application);
    return status;
}
