/* limner-viewer: the program behind `limner view`. */
#include "shortcuts.h"
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
    ViewWindow *w = view_window_new(ADW_APPLICATION(application));
    gtk_window_present(GTK_WINDOW(w));
    /* Without files it goes on where it was left, but only in the first window. */
    if (!gtk_application_get_windows(GTK_APPLICATION(application))->next)
        view_window_go_on(w);
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
    shortcuts_add(GTK_APPLICATION(application));
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
