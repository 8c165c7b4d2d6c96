/* A window's files: opening, watching, what is there at the next start. */
#include <string.h>

#include "cameras.h"
#include "load.h"
#include "picture.h"
#include "trace.h"
#include "window_private.h"
#include "words.h"

enum { RELOAD_AFTER_MS = 200 };

/* --- menus that change ----------------------------------------------------------------------------------- */

static void list_cameras(ViewWindow *w)
{
    GMenu *menu = cameras_menu(document_scene(w->document));
    g_menu_remove_all(w->cameras);
    g_menu_append_section(w->cameras, NULL, G_MENU_MODEL(menu));
    g_object_unref(menu);
}

void window_list_recent(ViewWindow *w)
{
    enum { SHOWN = 10 };
    GList *items = gtk_recent_manager_get_items(gtk_recent_manager_get_default());
    int    count = 0;
    g_menu_remove_all(w->recent);
    for (GList *i = items; i && count < SHOWN; i = i->next) {
        char *path = gtk_recent_info_has_application(i->data, g_get_application_name())
                         ? g_filename_from_uri(gtk_recent_info_get_uri(i->data), NULL, NULL)
                         : NULL;
        if (path) {
            GMenuItem *item = g_menu_item_new(gtk_recent_info_get_display_name(i->data), NULL);
            g_menu_item_set_action_and_target(item, "win.recent", "s", path);
            g_menu_append_item(w->recent, item);
            g_object_unref(item);
            count++;
        }
        g_free(path);
    }
    g_list_free_full(items, (GDestroyNotify)gtk_recent_info_unref);
}

/* --- files ----------------------------------------------------------------------------------------------- */

static void open_again(ViewWindow *w);

static gboolean reload_now(gpointer data)
{
    ViewWindow *w = data;
    w->reload = 0;
    open_again(w);
    return G_SOURCE_REMOVE;
}

/* Programs write a file in several steps: it is read when none has come for a while. */
static void file_changed(GFileMonitor *monitor, GFile *file, GFile *other, GFileMonitorEvent event, gpointer user)
{
    (void)monitor;
    (void)file;
    (void)other;
    ViewWindow *w = user;
    if (event == G_FILE_MONITOR_EVENT_ATTRIBUTE_CHANGED || event == G_FILE_MONITOR_EVENT_DELETED)
        return;
    g_clear_handle_id(&w->reload, g_source_remove);
    w->reload = g_timeout_add(RELOAD_AFTER_MS, reload_now, w);
}

void window_stop_watch(gpointer monitor)
{
    g_file_monitor_cancel(monitor);
    g_object_unref(monitor);
}

static void watch(ViewWindow *w, const char *const *paths)
{
    g_ptr_array_set_size(w->watches, 0);
    for (size_t i = 0; paths[i]; i++) {
        GFile        *file = g_file_new_for_path(paths[i]);
        GFileMonitor *monitor = g_file_monitor_file(file, G_FILE_MONITOR_WATCH_MOVES, NULL, NULL);
        if (monitor) {
            g_signal_connect(monitor, "changed", G_CALLBACK(file_changed), w);
            g_ptr_array_add(w->watches, monitor);
        }
        g_object_unref(file);
    }
}

static void show_title(ViewWindow *w, const char *const *paths)
{
    char *name = g_path_get_basename(paths[0]), *folder = g_path_get_dirname(paths[0]);
    adw_window_title_set_title(ADW_WINDOW_TITLE(w->title), name);
    adw_window_title_set_subtitle(ADW_WINDOW_TITLE(w->title), folder);
    gtk_window_set_title(GTK_WINDOW(w), name);
    g_free(name);
    g_free(folder);
}

static void remember(const char *const *paths)
{
    for (size_t i = 0; paths[i]; i++) {
        char *uri = g_filename_to_uri(paths[i], NULL, NULL);
        if (uri)
            gtk_recent_manager_add_item(gtk_recent_manager_get_default(), uri);
        g_free(uri);
    }
}

static void loaded(GObject *source, GAsyncResult *result, gpointer user)
{
    (void)source;
    ViewWindow *w = user;
    lmn_error   error = {0};
    scene_ref  *scene = load_finish(result, &error);
    g_clear_object(&w->loading);
    if (w->document) {
        gtk_widget_set_visible(w->progress, FALSE);
        if (scene) {
            int width, height;
            view_window_picture_size(w, &width, &height);
            show_title(w, (const char *const *)scene->paths);
            remember((const char *const *)scene->paths);
            trace_event("loaded parts=%zu reload=%d", scene->info.parts, w->reloads);
            gtk_stack_set_visible_child_name(GTK_STACK(w->pages), "picture");
            document_set_scene(w->document, scene_ref_take(scene), !w->reloads, width, height);
            if (!w->restored.has_view && !w->reloads)
                view_window_fit(w, NULL);
            if (w->restored.has_view && !w->reloads)
                document_set_view(w->document, &w->restored.view, "Restore");
            w->restored.has_view = false;
            list_cameras(w);
            window_list_recent(w);
        } else if (error.status != LMN_CANCELLED) {
            trace_event("not-loaded %s", error.message);
            view_window_say_error(w, &error);
        }
    }
    scene_ref_drop(scene);
    g_object_unref(w);
}

static void load_progressed(double fraction, void *user)
{
    ViewWindow *w = user;
    if (!w->document)
        return;
    gtk_widget_set_visible(w->progress, TRUE);
    gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(w->progress), fraction);
}

static void load(ViewWindow *w, bool reloads)
{
    if (w->loading)
        g_cancellable_cancel(w->loading);
    g_clear_object(&w->loading);
    w->reloads = reloads;
    w->loading = g_cancellable_new();
    load_begin((const char *const *)w->loading_paths, w->loading, load_progressed, loaded, g_object_ref(w));
}

void view_window_open(ViewWindow *w, const char *const *paths)
{
    GStrv copy = g_strdupv((char **)paths);
    g_strfreev(w->loading_paths);
    w->loading_paths = copy;
    watch(w, (const char *const *)copy);
    load(w, false);
}

static void open_again(ViewWindow *w)
{
    if (w->loading_paths)
        load(w, document_scene(w->document) != NULL);
}

void view_window_set_look(ViewWindow *w, const char *name_or_path)
{
    lmn_error error = {0};
    look_ref *look = look_ref_load(name_or_path, &error);
    if (look)
        document_set_look(w->document, look, _("Look"));
    else
        view_window_say_error(w, &error);
}

void view_window_go_on(ViewWindow *w)
{
    lmn_error error = {0};
    lmn_look *look = NULL;
    if (w->restored.look && lmn_look_parse(&look, w->restored.look, "session", &error) == LMN_OK) {
        char *name = g_strdup(lmn_look_name(look));
        document_set_look(w->document, look_ref_make(look, name ? name : "edges"), "Restore");
        g_free(name);
    }
    if (w->restored.paths && w->restored.paths[0] && g_file_test(w->restored.paths[0], G_FILE_TEST_EXISTS))
        view_window_open(w, (const char *const *)w->restored.paths);
    else
        w->restored.has_view = false;
}

static void keep_session(ViewWindow *w)
{
    session          s = {.maximized = gtk_window_is_maximized(GTK_WINDOW(w))};
    const scene_ref *scene = document_scene(w->document);
    char            *json = lmn_look_json(document_state(w->document)->look->look);
    gtk_window_get_default_size(GTK_WINDOW(w), &s.width, &s.height);
    s.paths = scene ? scene->paths : NULL;
    s.look = json;
    s.view = document_state(w->document)->view;
    s.has_view = scene != NULL;
    s.lists = adw_flap_get_reveal_flap(ADW_FLAP(w->left));
    s.panel = adw_flap_get_reveal_flap(ADW_FLAP(w->right));
    session_write(&s);
    lmn_text_free(json);
}

gboolean window_closing(GtkWindow *window, gpointer user)
{
    (void)user;
    keep_session(LIMNER_VIEW_WINDOW(window));
    return FALSE;
}

void window_file_chosen(GtkNativeDialog *dialog, int response, gpointer user)
{
    ViewWindow *w = user;
    if (response == GTK_RESPONSE_ACCEPT) {
        GListModel   *files = gtk_file_chooser_get_files(GTK_FILE_CHOOSER(dialog));
        GStrvBuilder *paths = g_strv_builder_new();
        for (guint i = 0; i < g_list_model_get_n_items(files); i++) {
            GFile *file = g_list_model_get_item(files, i);
            char  *path = g_file_get_path(file);
            if (path)
                g_strv_builder_add(paths, path);
            g_free(path);
            g_object_unref(file);
        }
        GStrv list = g_strv_builder_end(paths);
        if (list[0])
            view_window_open(w, (const char *const *)list);
        g_strfreev(list);
        g_strv_builder_unref(paths);
        g_object_unref(files);
    }
    g_object_unref(dialog);
}

gboolean window_dropped(GtkDropTarget *target, const GValue *value, double x, double y, gpointer user)
{
    (void)target;
    (void)x;
    (void)y;
    GStrvBuilder *paths = g_strv_builder_new();
    for (GSList *i = g_value_get_boxed(value); i; i = i->next) {
        char *path = g_file_get_path(i->data);
        if (path)
            g_strv_builder_add(paths, path);
        g_free(path);
    }
    GStrv list = g_strv_builder_end(paths);
    bool  any = list[0] != NULL;
    if (any)
        view_window_open(user, (const char *const *)list);
    g_strfreev(list);
    g_strv_builder_unref(paths);
    return any;
}
