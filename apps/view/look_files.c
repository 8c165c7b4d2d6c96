#include "look_files.h"

#include <glib/gstdio.h>

#include "trace.h"
#include "words.h"

char *look_files_folder(void)
{
    char *out = g_build_filename(g_get_user_data_dir(), "limner", "looks", NULL);
    g_mkdir_with_parents(out, 0700);
    return out;
}

/* The look is called as its file from then on. */
static void save_as(ViewWindow *w, const char *path)
{
    document *d = view_window_document(w);
    lmn_error error = {0};
    lmn_look *look = document_copy_look(d, &error);
    char     *base = g_path_get_basename(path), *dot = g_strrstr(base, ".json");
    if (dot)
        *dot = 0;
    char      *json = NULL;
    lmn_status status = look ? lmn_look_set_name(look, base, &error) : error.status;
    if (status == LMN_OK)
        json = lmn_look_json(look);
    if (status == LMN_OK && !json)
        status = LMN_MEMORY;
    if (status == LMN_OK)
        status = lmn_text_write(json, path, &error);
    lmn_text_free(json);
    if (status == LMN_OK) {
        document_set_look(d, look_ref_make(look, path), _("Save look"));
        view_window_say(w, _("The look is saved"));
        trace_event("saved-look %s", path);
    } else {
        lmn_look_destroy(&look);
        view_window_say_error(w, &error);
    }
    g_free(base);
}

static void chosen_to_save(GtkNativeDialog *dialog, int response, gpointer window)
{
    if (response == GTK_RESPONSE_ACCEPT) {
        GFile *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog));
        char  *path = g_file_get_path(file);
        char  *whole = path && !g_str_has_suffix(path, ".json") ? g_strconcat(path, ".json", NULL) : g_strdup(path);
        if (whole)
            save_as(window, whole);
        g_free(path);
        g_free(whole);
        g_object_unref(file);
    }
    g_object_unref(dialog);
}

static void chosen_to_load(GtkNativeDialog *dialog, int response, gpointer window)
{
    if (response == GTK_RESPONSE_ACCEPT) {
        GFile *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog));
        char  *path = g_file_get_path(file);
        if (path)
            view_window_set_look(window, path);
        g_free(path);
        g_object_unref(file);
    }
    g_object_unref(dialog);
}

static GtkFileChooserNative *chooser(ViewWindow *w, const char *title, GtkFileChooserAction action, const char *accept)
{
    GtkFileChooserNative *out = gtk_file_chooser_native_new(title, GTK_WINDOW(w), action, accept, _("_Cancel"));
    char                 *folder = look_files_folder();
    GFile                *file = g_file_new_for_path(folder);
    GtkFileFilter        *filter = gtk_file_filter_new();
    gtk_file_chooser_set_current_folder(GTK_FILE_CHOOSER(out), file, NULL);
    gtk_file_filter_set_name(filter, _("Looks (*.json)"));
    gtk_file_filter_add_pattern(filter, "*.json");
    gtk_file_chooser_add_filter(GTK_FILE_CHOOSER(out), filter);
    g_object_unref(filter);
    g_object_unref(file);
    g_free(folder);
    return out;
}

void look_files_save(ViewWindow *w)
{
    GtkFileChooserNative *dialog = chooser(w, _("Save the look"), GTK_FILE_CHOOSER_ACTION_SAVE, _("_Save"));
    gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(dialog), "my-look.json");
    g_signal_connect(dialog, "response", G_CALLBACK(chosen_to_save), w);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

void look_files_load(ViewWindow *w)
{
    GtkFileChooserNative *dialog = chooser(w, _("Load a look"), GTK_FILE_CHOOSER_ACTION_OPEN, _("_Open"));
    g_signal_connect(dialog, "response", G_CALLBACK(chosen_to_load), w);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

/* --- files that change ----------------------------------------------------------------------------------- */

typedef struct look_watch {
    ViewWindow   *window; /* whose data it is */
    char         *path;   /* NULL: the look comes from no file */
    GFileMonitor *monitor;
    guint         timer;
} look_watch;

enum { READ_AFTER_MS = 200 };

static bool same_look(const lmn_look *a, const lmn_look *b)
{
    char *one = lmn_look_json(a), *other = lmn_look_json(b);
    bool  same = g_strcmp0(one, other) == 0;
    lmn_text_free(one);
    lmn_text_free(other);
    return same;
}

/* What is half written is no look: then the one that is there stays, and the message says where the mistake is. */
static gboolean read_again(gpointer data)
{
    look_watch *l = data;
    lmn_error   error = {0};
    l->timer = 0;
    document *d = view_window_document(l->window);
    look_ref *look = d && l->path ? look_ref_load(l->path, &error) : NULL;
    if (look && !same_look(look->look, document_state(d)->look->look)) {
        trace_event("reloaded-look %s", l->path);
        document_set_look(d, look, _("Look file"));
        view_window_say(l->window, _("The look was read again"));
    } else if (look) {
        look_ref_drop(look);
    } else if (d && l->path) {
        char *text = g_strdup_printf("%s:%d:%d: %s%s%s", *error.file ? error.file : l->path, error.line, error.column,
                                     error.message, *error.hint ? " – " : "", error.hint);
        trace_event("not-reloaded-look %d:%d %s", error.line, error.column, error.message);
        view_window_say(l->window, text);
        g_free(text);
    }
    return G_SOURCE_REMOVE;
}

static void file_changed(GFileMonitor *monitor, GFile *file, GFile *other, GFileMonitorEvent event, gpointer user)
{
    (void)monitor;
    (void)file;
    (void)other;
    look_watch *l = user;
    if (event == G_FILE_MONITOR_EVENT_ATTRIBUTE_CHANGED || event == G_FILE_MONITOR_EVENT_DELETED)
        return;
    g_clear_handle_id(&l->timer, g_source_remove);
    l->timer = g_timeout_add(READ_AFTER_MS, read_again, l);
}

static void stop(look_watch *l)
{
    g_clear_handle_id(&l->timer, g_source_remove);
    if (l->monitor)
        g_file_monitor_cancel(l->monitor);
    g_clear_object(&l->monitor);
    g_clear_pointer(&l->path, g_free);
}

static void follow_origin(document *d, unsigned changes, void *user)
{
    look_watch *l = user;
    const char *origin = document_state(d)->look->origin;
    const char *path = origin && g_path_is_absolute(origin) ? origin : NULL;
    if (!(changes & DOCUMENT_LOOK) || g_strcmp0(path, l->path) == 0)
        return;
    stop(l);
    if (!path)
        return;
    GFile *file = g_file_new_for_path(path);
    l->path = g_strdup(path);
    l->monitor = g_file_monitor_file(file, G_FILE_MONITOR_WATCH_MOVES, NULL, NULL);
    if (l->monitor)
        g_signal_connect(l->monitor, "changed", G_CALLBACK(file_changed), l);
    g_object_unref(file);
}

static void watch_free(void *data)
{
    stop(data);
    g_free(data);
}

void look_files_watch(ViewWindow *w)
{
    look_watch *l = g_new0(look_watch, 1);
    l->window = w;
    g_object_set_data_full(G_OBJECT(w), "look-watch", l, watch_free);
    document_listen(view_window_document(w), follow_origin, l);
}
