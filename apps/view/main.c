/* limner-viewer: the program behind `limner view`. */
#include "shortcuts.h"
#include "trace.h"
#include "window.h"
#include "words.h"

/* What the command line asks for. */
typedef struct beginning {
    char *look; /* NULL: not given */
} beginning;

static void open_files(GApplication *application, GFile **files, int count, const char *hint, gpointer user)
{
    (void)hint;
    const beginning *begin = user;
    GPtrArray       *paths = g_ptr_array_new_with_free_func(g_free);
    for (int i = 0; i < count; i++) {
        char *path = g_file_get_path(files[i]);
        if (path)
            g_ptr_array_add(paths, path);
    }
    g_ptr_array_add(paths, NULL);
    ViewWindow *w = view_window_new(ADW_APPLICATION(application));
    gtk_window_present(GTK_WINDOW(w));
    if (begin->look)
        view_window_set_look(w, begin->look);
    if (paths->len > 1)
        view_window_open(w, (const char *const *)paths->pdata);
    g_ptr_array_unref(paths);
}

static void activate(GApplication *application, gpointer user)
{
    const beginning *begin = user;
    ViewWindow      *w = view_window_new(ADW_APPLICATION(application));
    gtk_window_present(GTK_WINDOW(w));
    /* Without files it goes on where it was left, but only in the first window. */
    if (!gtk_application_get_windows(GTK_APPLICATION(application))->next)
        view_window_go_on(w);
    if (begin && begin->look)
        view_window_set_look(w, begin->look);
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

static int take_options(GApplication *application, GVariantDict *options, gpointer user)
{
    (void)application;
    beginning *b = user;
    g_variant_dict_lookup(options, "look", "s", &b->look);
    return -1; /* go on */
}

/* Translations lie beside the program in the build, and in share/locale where it is installed. */
static void find_translations(void)
{
    char *program = g_file_read_link("/proc/self/exe", NULL), *folder = program ? g_path_get_dirname(program) : NULL;
    char *beside = folder ? g_build_filename(folder, "locale", NULL) : NULL;
    char *installed = folder ? g_build_filename(folder, "..", "share", "locale", NULL) : NULL;
    if (folder)
        bindtextdomain("limner", g_file_test(beside, G_FILE_TEST_IS_DIR) ? beside : installed);
    bind_textdomain_codeset("limner", "UTF-8");
    textdomain("limner");
    g_free(program);
    g_free(folder);
    g_free(beside);
    g_free(installed);
}

/* Without a GPU GTK would paint the window by the same software driver that draws the picture, and take its cores:
 * with cairo the main loop's gaps while a model of 100,000 triangles turns went from 72 to 20 ms. */
static void paint_without_gpu(void)
{
    GDir       *nodes = g_dir_open("/dev/dri", 0, NULL);
    const char *name = NULL;
    bool        gpu = false;
    while (nodes && !gpu && (name = g_dir_read_name(nodes)))
        gpu = g_str_has_prefix(name, "renderD");
    if (nodes)
        g_dir_close(nodes);
    if (!gpu)
        g_setenv("GSK_RENDERER", "cairo", FALSE);
}

int main(int count, char **arguments)
{
    enum { NO_DISPLAY = 3 }; /* as the command's status where there is no driver */
    trace_begin();
    paint_without_gpu();
    find_translations();
    if (!gtk_init_check()) {
        g_printerr("limner: there is no display to show a window on\n"
                   "hint: `limner draw` writes a picture without one\n");
        return NO_DISPLAY;
    }
    beginning       begin = {NULL};
    AdwApplication *application =
        adw_application_new("io.github.limner.Viewer", G_APPLICATION_HANDLES_OPEN | G_APPLICATION_NON_UNIQUE);
    static const GOptionEntry entries[] = {
        {"look", 'l', 0, G_OPTION_ARG_STRING, NULL, N_("Look to begin with: a name or a file"), N_("NAME|FILE")},
        {NULL}};
    g_application_add_main_option_entries(G_APPLICATION(application), entries);
    g_signal_connect(application, "handle-local-options", G_CALLBACK(take_options), &begin);
    g_signal_connect(application, "startup", G_CALLBACK(startup), NULL);
    g_signal_connect(application, "activate", G_CALLBACK(activate), &begin);
    g_signal_connect(application, "open", G_CALLBACK(open_files), &begin);
    int status = g_application_run(G_APPLICATION(application), count, arguments);
    g_object_unref(application);
    g_free(begin.look);
    return status;
}
