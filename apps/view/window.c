#include "window.h"

#include <math.h>

#include "cameras.h"
#include "command.h"
#include "controls.h"
#include "cube.h"
#include "export.h"
#include "gallery.h"
#include "load.h"
#include "look_files.h"
#include "parts.h"
#include "picture.h"
#include "section.h"
#include "session.h"
#include "shortcuts.h"
#include "solids.h"
#include "timeline.h"
#include "trace.h"
#include "words.h"

struct _ViewWindow {
    AdwApplicationWindow parent;
    document            *document;
    artist              *artist;
    GtkWidget           *title, *picture, *status, *progress, *toasts, *gallery, *pages, *timeline;
    GCancellable        *loading; /* NULL: nothing is read */
    GStrv                loading_paths;
    bool                 reloads; /* the same files, seen from where one is */
    GPtrArray           *watches; /* of GFileMonitor */
    guint                reload, turntable;
    GtkWidget           *left, *right; /* flaps around the picture */
    GMenu               *cameras, *recent;
    session              restored; /* until it is shown */
};
G_DEFINE_TYPE(ViewWindow, view_window, ADW_TYPE_APPLICATION_WINDOW)

enum { RELOAD_AFTER_MS = 200, TURNTABLE_MS = 33 };

document *view_window_document(ViewWindow *w)
{
    return w->document;
}

artist *view_window_artist(ViewWindow *w)
{
    return w->artist;
}

void view_window_picture_size(ViewWindow *w, int *width, int *height)
{
    /* Before a model is there the picture has no room of its own yet, but that of the page it will take. */
    picture_size(LIMNER_PICTURE(w->picture), width, height);
    if (gtk_widget_get_width(w->picture) == 0 && gtk_widget_get_width(w->pages) > 0) {
        int scale = gtk_widget_get_scale_factor(w->pages);
        *width = gtk_widget_get_width(w->pages) * scale;
        *height = MAX(1, gtk_widget_get_height(w->pages) * scale);
    }
}

void view_window_say(ViewWindow *w, const char *text)
{
    char *escaped = g_markup_escape_text(text, -1);
    adw_toast_overlay_add_toast(ADW_TOAST_OVERLAY(w->toasts), adw_toast_new(escaped));
    g_free(escaped);
    trace_event("said %s", text);
}

void view_window_say_error(ViewWindow *w, const lmn_error *error)
{
    char *text = g_strdup_printf("%s%s%s%s%s", error->file, *error->file ? ": " : "", error->message,
                                 *error->hint ? " – " : "", error->hint);
    view_window_say(w, text);
    g_free(text);
}

/* --- menus that change ----------------------------------------------------------------------------------- */

static void list_cameras(ViewWindow *w)
{
    GMenu *menu = cameras_menu(document_scene(w->document));
    g_menu_remove_all(w->cameras);
    g_menu_append_section(w->cameras, NULL, G_MENU_MODEL(menu));
    g_object_unref(menu);
}

static void list_recent(ViewWindow *w)
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

static void stop_watch(gpointer monitor)
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
            if (w->restored.has_view && !w->reloads)
                document_set_view(w->document, &w->restored.view, "Restore");
            w->restored.has_view = false;
            list_cameras(w);
            list_recent(w);
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

static gboolean closing(GtkWindow *window, gpointer user)
{
    (void)user;
    keep_session(LIMNER_VIEW_WINDOW(window));
    return FALSE;
}

static void file_chosen(GtkNativeDialog *dialog, int response, gpointer user)
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

static gboolean dropped(GtkDropTarget *target, const GValue *value, double x, double y, gpointer user)
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

/* --- actions --------------------------------------------------------------------------------------------- */

#define ACTION(name) static void name(GSimpleAction *action, GVariant *value, gpointer user)
#define UNUSED       (void)action, (void)value

ACTION(do_open)
{
    UNUSED;
    GtkFileChooserNative *dialog =
        gtk_file_chooser_native_new("Open model", user, GTK_FILE_CHOOSER_ACTION_OPEN, "_Open", "_Cancel");
    gtk_file_chooser_set_select_multiple(GTK_FILE_CHOOSER(dialog), TRUE);
    g_signal_connect(dialog, "response", G_CALLBACK(file_chosen), user);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

ACTION(do_undo)
{
    UNUSED;
    document_undo(LIMNER_VIEW_WINDOW(user)->document);
}

ACTION(do_redo)
{
    UNUSED;
    document_redo(LIMNER_VIEW_WINDOW(user)->document);
}

ACTION(do_fit)
{
    UNUSED;
    ViewWindow      *w = user;
    const scene_ref *scene = document_scene(w->document);
    if (!scene)
        return;
    int   width, height;
    orbit o = document_state(w->document)->view;
    view_window_picture_size(w, &width, &height);
    orbit_fit(&o, scene->info.bounds_min, scene->info.bounds_max, width, height);
    document_set_view(w->document, &o, "Fit");
}

ACTION(do_view)
{
    static const char *const names[] = {"iso", "front", "back", "left", "right", "top", "bottom"};
    (void)action;
    ViewWindow *w = user;
    orbit       o = document_state(w->document)->view;
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        if (g_strcmp0(names[i], g_variant_get_string(value, NULL)) == 0)
            orbit_turn_to(&o, (lmn_view)i);
    document_set_view(w->document, &o, "View");
    do_fit(NULL, NULL, w);
}

ACTION(do_export)
{
    UNUSED;
    export_open(user);
}

ACTION(do_show_all)
{
    UNUSED;
    document_show_all(LIMNER_VIEW_WINDOW(user)->document);
}

ACTION(do_hide)
{
    UNUSED;
    document *d = LIMNER_VIEW_WINDOW(user)->document;
    uint32_t  part = document_selected(d);
    if (part)
        document_show_parts(d, &part, 1, document_is_hidden(d, part));
}

ACTION(do_alone)
{
    UNUSED;
    document *d = LIMNER_VIEW_WINDOW(user)->document;
    uint32_t  part = document_selected(d);
    if (part)
        document_show_alone(d, &part, 1);
}

static void copy_text(ViewWindow *w, char *text, const lmn_error *error, const char *what)
{
    if (!text) {
        view_window_say_error(w, error);
        return;
    }
    gdk_clipboard_set_text(gtk_widget_get_clipboard(GTK_WIDGET(w)), text);
    trace_event("copied %s", text);
    view_window_say(w, what);
    g_free(text);
}

static export_wish copied_wish(ViewWindow *w)
{
    export_wish wish = {.path = "drawing.png"};
    view_window_picture_size(w, &wish.width, &wish.height);
    return wish;
}

ACTION(do_copy_command)
{
    UNUSED;
    ViewWindow *w = user;
    lmn_error   error = {0};
    if (!document_scene(w->document))
        return;
    export_wish wish = copied_wish(w);
    GStrv       words = command_words(document_state(w->document), document_scene(w->document), &wish, &error);
    copy_text(w, words ? command_line((const char *const *)words) : NULL, &error, "Command copied");
    g_strfreev(words);
}

ACTION(do_copy_c)
{
    UNUSED;
    ViewWindow *w = user;
    lmn_error   error = {0};
    if (!document_scene(w->document))
        return;
    export_wish wish = copied_wish(w);
    copy_text(w, command_in_c(document_state(w->document), document_scene(w->document), &wish, &error), &error,
              "Program in C copied");
}

static void set_toggle(GSimpleAction *action, bool on)
{
    g_simple_action_set_state(action, g_variant_new_boolean(on));
}

static bool toggled(GSimpleAction *action)
{
    GVariant *state = g_action_get_state(G_ACTION(action));
    bool      on = !g_variant_get_boolean(state);
    g_variant_unref(state);
    set_toggle(action, on);
    return on;
}

ACTION(do_parallel)
{
    (void)value;
    ViewWindow *w = user;
    orbit       o = document_state(w->document)->view;
    o.orthographic = toggled(action);
    document_set_view(w->document, &o, "Projection");
}

ACTION(do_walk)
{
    (void)value;
    ViewWindow *w = user;
    bool        on = toggled(action);
    picture_set_walking(LIMNER_PICTURE(w->picture), on);
    gtk_widget_grab_focus(w->picture);
    if (on)
        view_window_say(w, "Walk with W, A, S, D, Q, E; drag to look around");
}

static gboolean turn_table(gpointer data)
{
    ViewWindow *w = data;
    orbit       o = document_state(w->document)->view;
    o.yaw += 0.5 * G_PI / 180 * TURNTABLE_MS / 33;
    document_set_view(w->document, &o, "Turntable");
    return G_SOURCE_CONTINUE;
}

ACTION(do_turntable)
{
    (void)value;
    ViewWindow *w = user;
    g_clear_handle_id(&w->turntable, g_source_remove);
    if (toggled(action))
        w->turntable = g_timeout_add(TURNTABLE_MS, turn_table, w);
}

/* Keeps the look as it is now on the left; what is changed from here on shows on the right. */
ACTION(do_compare)
{
    (void)value;
    ViewWindow *w = user;
    bool        on = toggled(action);
    picture_compare(LIMNER_PICTURE(w->picture), on ? look_ref_take(document_state(w->document)->look) : NULL);
    if (on)
        view_window_say(w, "Left of the divider the look stays as it is now");
}

/* "x", "y", "z" toggle a plane across that axis; "flip" turns it round; "box" cuts a corner out; "none" mends all. */
ACTION(do_section)
{
    (void)action;
    ViewWindow *w = user;
    const char *what = g_variant_get_string(value, NULL);
    char        text[LMN_VALUE_TEXT_MAX] = "";
    lmn_error   error = {0};
    lmn_look   *look = document_copy_look(w->document, &error);
    if (!look) {
        view_window_say_error(w, &error);
        return;
    }
    lmn_look_get_text(look, LMN_WHOLE_LOOK, "scene", 0, "cut", text, sizeof text, &error);
    section s = section_parse(text);
    if (g_strcmp0(what, "flip") == 0) {
        s.flipped = !s.flipped;
    } else {
        s = section_parse("");
        s.kind = g_strcmp0(what, "none") == 0  ? SECTION_NONE
                 : g_strcmp0(what, "box") == 0 ? SECTION_BOX
                                               : SECTION_PLANE;
        s.axis = s.kind == SECTION_PLANE ? *what - 'x' : 0;
        for (int k = 0; k < 3; k++) {
            s.low[k] = 50;
            s.high[k] = s.kind == SECTION_BOX ? 100 : 50;
        }
    }
    section_write(&s, text);
    if (lmn_look_set(look, "scene.cut", text, &error) == LMN_OK) {
        document_end_step(w->document);
        document_put_look(w->document, look, "Section");
    } else {
        lmn_look_destroy(&look);
        view_window_say_error(w, &error);
    }
}

static document *document_of(GObject *window)
{
    return LIMNER_VIEW_WINDOW(window)->document;
}

ACTION(do_camera)
{
    (void)action;
    ViewWindow *w = user;
    cameras_go(G_OBJECT(w), document_of, w->artist, (scene_ref *)document_scene(w->document),
               document_state(w->document), g_variant_get_string(value, NULL));
}

ACTION(do_keys)
{
    UNUSED;
    shortcuts_show(GTK_WINDOW(user));
}

ACTION(do_recent)
{
    (void)action;
    const char *paths[] = {g_variant_get_string(value, NULL), NULL};
    view_window_open(user, paths);
}

ACTION(do_save_look)
{
    UNUSED;
    look_files_save(user);
}

ACTION(do_load_look)
{
    UNUSED;
    look_files_load(user);
}

ACTION(do_copy_picture)
{
    UNUSED;
    ViewWindow *w = user;
    GdkTexture *texture = picture_texture(LIMNER_PICTURE(w->picture));
    if (!texture)
        return;
    gdk_clipboard_set_texture(gtk_widget_get_clipboard(GTK_WIDGET(w)), texture);
    view_window_say(w, _("Picture copied"));
}

ACTION(do_play)
{
    UNUSED;
    timeline_play(LIMNER_VIEW_WINDOW(user)->timeline);
}

static const GActionEntry actions[] = {
    {.name = "open", .activate = do_open},
    {.name = "undo", .activate = do_undo},
    {.name = "redo", .activate = do_redo},
    {.name = "fit", .activate = do_fit},
    {.name = "view", .activate = do_view, .parameter_type = "s"},
    {.name = "export", .activate = do_export},
    {.name = "section", .activate = do_section, .parameter_type = "s"},
    {.name = "camera", .activate = do_camera, .parameter_type = "s"},
    {.name = "recent", .activate = do_recent, .parameter_type = "s"},
    {.name = "keys", .activate = do_keys},
    {.name = "save-look", .activate = do_save_look},
    {.name = "load-look", .activate = do_load_look},
    {.name = "copy-picture", .activate = do_copy_picture},
    {.name = "play", .activate = do_play},
    {.name = "show-all", .activate = do_show_all},
    {.name = "hide", .activate = do_hide},
    {.name = "alone", .activate = do_alone},
    {.name = "copy-command", .activate = do_copy_command},
    {.name = "copy-c", .activate = do_copy_c},
    {.name = "parallel", .activate = do_parallel, .state = "false"},
    {.name = "walk", .activate = do_walk, .state = "false"},
    {.name = "turntable", .activate = do_turntable, .state = "false"},
    {.name = "compare", .activate = do_compare, .state = "false"},
};

static void enable(ViewWindow *w, const char *name, bool on)
{
    g_simple_action_set_enabled(G_SIMPLE_ACTION(g_action_map_lookup_action(G_ACTION_MAP(w), name)), on);
}

static void document_changed(document *d, unsigned changes, void *user)
{
    ViewWindow *w = user;
    bool        scene = document_scene(d) != NULL, part = document_selected(d) != 0;
    enable(w, "undo", document_undo_name(d) != NULL);
    enable(w, "redo", document_redo_name(d) != NULL);
    enable(w, "hide", part);
    enable(w, "alone", part);
    static const char *const of_scene[] = {"fit",          "view",   "section",  "camera", "export",
                                           "copy-command", "copy-c", "parallel", "compare"};
    for (size_t i = 0; i < G_N_ELEMENTS(of_scene); i++)
        enable(w, of_scene[i], scene);
    if (changes & DOCUMENT_VIEW)
        set_toggle(G_SIMPLE_ACTION(g_action_map_lookup_action(G_ACTION_MAP(w), "parallel")),
                   document_state(d)->view.orthographic);
}

/* --- the window ------------------------------------------------------------------------------------------ */

static void name_it(GtkWidget *widget, const char *name)
{
    gtk_widget_set_tooltip_text(widget, name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
}

static GtkWidget *button(const char *icon, const char *name, const char *action)
{
    GtkWidget *out = gtk_button_new_from_icon_name(icon);
    name_it(out, name);
    gtk_actionable_set_detailed_action_name(GTK_ACTIONABLE(out), action);
    return out;
}

static GMenuModel *make_menu(ViewWindow *w)
{
    GMenu *menu = g_menu_new(), *views = g_menu_new(), *look = g_menu_new(), *copy = g_menu_new(), *end = g_menu_new();
    GMenu *section = g_menu_new();
    static const char *const names[][2] = {{"Front", "win.view('front')"},  {"Back", "win.view('back')"},
                                           {"Left", "win.view('left')"},    {"Right", "win.view('right')"},
                                           {"Top", "win.view('top')"},      {"Bottom", "win.view('bottom')"},
                                           {"Isometric", "win.view('iso')"}};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        g_menu_append(views, names[i][0], names[i][1]);
    static const char *const cuts[][2] = {{"Across X", "win.section('x')"}, {"Across Y", "win.section('y')"},
                                          {"Across Z", "win.section('z')"}, {"Other side", "win.section('flip')"},
                                          {"Box", "win.section('box')"},    {"None", "win.section('none')"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cuts); i++)
        g_menu_append(section, cuts[i][0], cuts[i][1]);
    g_menu_append_submenu(look, "View from", G_MENU_MODEL(views));
    g_menu_append_submenu(look, "Section", G_MENU_MODEL(section));
    g_menu_append_submenu(look, "Cameras", G_MENU_MODEL(w->cameras));
    g_menu_append_submenu(look, "Recent files", G_MENU_MODEL(w->recent));
    g_menu_append(look, "Fit", "win.fit");
    g_menu_append(look, "Parallel projection", "win.parallel");
    g_menu_append(look, "Walk", "win.walk");
    g_menu_append(look, "Turntable", "win.turntable");
    g_menu_append(look, "Compare looks", "win.compare");
    g_menu_append(look, "Show all parts", "win.show-all");
    g_menu_append(copy, "Save the look", "win.save-look");
    g_menu_append(copy, "Load a look", "win.load-look");
    g_menu_append(copy, "Copy the picture", "win.copy-picture");
    g_menu_append(copy, "Copy as command", "win.copy-command");
    g_menu_append(copy, "Copy as C", "win.copy-c");
    g_menu_append(end, "Keys", "win.keys");
    g_menu_append(end, "New window", "app.new");
    g_menu_append(end, "Quit", "app.quit");
    g_menu_append_section(menu, NULL, G_MENU_MODEL(look));
    g_menu_append_section(menu, NULL, G_MENU_MODEL(copy));
    g_menu_append_section(menu, NULL, G_MENU_MODEL(end));
    GMenu *all[] = {views, section, look, copy, end};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        g_object_unref(all[i]);
    return G_MENU_MODEL(menu);
}

static GtkWidget *make_header(ViewWindow *w, GtkWidget *left, GtkWidget *right)
{
    GtkWidget *bar = adw_header_bar_new(), *menu = gtk_menu_button_new();
    GtkWidget *parts = gtk_toggle_button_new(), *panel = gtk_toggle_button_new();
    w->title = adw_window_title_new("Limner", NULL);
    adw_header_bar_set_title_widget(ADW_HEADER_BAR(bar), w->title);
    gtk_menu_button_set_icon_name(GTK_MENU_BUTTON(menu), "open-menu-symbolic");
    name_it(menu, "Main menu");
    GMenuModel *model = make_menu(w);
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(menu), model);
    g_object_unref(model);
    gtk_button_set_icon_name(GTK_BUTTON(parts), "sidebar-show-symbolic");
    name_it(parts, "Parts");
    gtk_button_set_icon_name(GTK_BUTTON(panel), "applications-graphics-symbolic");
    name_it(panel, "Looks and controls");
    g_object_bind_property(left, "reveal-flap", parts, "active", G_BINDING_BIDIRECTIONAL | G_BINDING_SYNC_CREATE);
    g_object_bind_property(right, "reveal-flap", panel, "active", G_BINDING_BIDIRECTIONAL | G_BINDING_SYNC_CREATE);
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), button("document-open-symbolic", "Open", "win.open"));
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), parts);
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), button("edit-undo-symbolic", "Undo", "win.undo"));
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), button("edit-redo-symbolic", "Redo", "win.redo"));
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), menu);
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), panel);
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), button("document-save-symbolic", "Export", "win.export"));
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), button("zoom-fit-best-symbolic", "Fit", "win.fit"));
    return bar;
}

static GtkWidget *make_panel(ViewWindow *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *stack = adw_view_stack_new();
    GtkWidget *bar = adw_view_switcher_bar_new(), *controls = controls_new(w->document);
    w->gallery = gallery_new(w->document, w->artist);
    adw_view_stack_add_titled(ADW_VIEW_STACK(stack), w->gallery, "looks", "Looks");
    adw_view_stack_add_titled(ADW_VIEW_STACK(stack), controls, "controls", "Controls");
    adw_view_stack_page_set_icon_name(adw_view_stack_get_page(ADW_VIEW_STACK(stack), w->gallery), "view-grid-symbolic");
    adw_view_stack_page_set_icon_name(adw_view_stack_get_page(ADW_VIEW_STACK(stack), controls),
                                      "preferences-other-symbolic");
    adw_view_stack_set_hhomogeneous(ADW_VIEW_STACK(stack), FALSE);
    adw_view_switcher_bar_set_stack(ADW_VIEW_SWITCHER_BAR(bar), ADW_VIEW_STACK(stack));
    adw_view_switcher_bar_set_reveal(ADW_VIEW_SWITCHER_BAR(bar), TRUE);
    gtk_widget_set_vexpand(stack, TRUE);
    gtk_box_append(GTK_BOX(box), stack);
    gtk_box_append(GTK_BOX(box), bar);
    gtk_widget_set_size_request(box, 348, -1);
    gtk_widget_set_hexpand(box, FALSE); /* whatever is in it: the room is the picture's */
    return box;
}

static gboolean drop_menu(gpointer popover)
{
    gtk_widget_unparent(popover);
    return G_SOURCE_REMOVE;
}

/* Its action runs after it has closed. */
static void menu_closed(GtkPopover *popover, gpointer user)
{
    (void)user;
    g_idle_add(drop_menu, popover);
}

static void picture_said(Picture *p, const char *text, gpointer user)
{
    (void)p;
    gtk_label_set_text(GTK_LABEL(LIMNER_VIEW_WINDOW(user)->status), text);
}

/* What can be done with the part below the pointer. */
static void picture_menu(Picture *p, double x, double y, guint part, gpointer user)
{
    (void)user;
    GMenu *menu = g_menu_new();
    if (part) {
        g_menu_append(menu, _("Hide"), "win.hide");
        g_menu_append(menu, _("Show alone"), "win.alone");
    }
    g_menu_append(menu, _("Show all parts"), "win.show-all");
    g_menu_append(menu, _("Fit"), "win.fit");
    GtkWidget *popover = gtk_popover_menu_new_from_model(G_MENU_MODEL(menu));
    gtk_widget_set_parent(popover, GTK_WIDGET(p));
    gtk_popover_set_pointing_to(GTK_POPOVER(popover), &(GdkRectangle){(int)x, (int)y, 1, 1});
    gtk_popover_set_has_arrow(GTK_POPOVER(popover), FALSE);
    g_signal_connect(popover, "closed", G_CALLBACK(menu_closed), NULL);
    gtk_popover_popup(GTK_POPOVER(popover));
    g_object_unref(menu);
}

static GtkWidget *make_middle(ViewWindow *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *overlay = gtk_overlay_new();
    GtkWidget *empty = adw_status_page_new();
    adw_status_page_set_title(ADW_STATUS_PAGE(empty), "Open a model");
    adw_status_page_set_description(ADW_STATUS_PAGE(empty), "Drop a file here, or press Ctrl+O");
    adw_status_page_set_icon_name(ADW_STATUS_PAGE(empty), "document-open-symbolic");
    w->picture = picture_new(w->document, w->artist);
    g_signal_connect_object(w->picture, "status", G_CALLBACK(picture_said), w, 0);
    g_signal_connect_object(w->picture, "menu", G_CALLBACK(picture_menu), w, 0);
    w->pages = gtk_stack_new();
    gtk_stack_add_named(GTK_STACK(w->pages), empty, "empty");
    gtk_stack_add_named(GTK_STACK(w->pages), w->picture, "picture");
    w->progress = gtk_progress_bar_new();
    gtk_widget_add_css_class(w->progress, "osd");
    gtk_widget_set_valign(w->progress, GTK_ALIGN_START);
    gtk_widget_set_visible(w->progress, FALSE);
    name_it(w->progress, "Reading the model");
    gtk_overlay_set_child(GTK_OVERLAY(overlay), w->pages);
    gtk_overlay_add_overlay(GTK_OVERLAY(overlay), w->progress);
    gtk_overlay_add_overlay(GTK_OVERLAY(overlay), cube_new(w->document));
    w->status = gtk_label_new("");
    gtk_label_set_xalign(GTK_LABEL(w->status), 0);
    gtk_label_set_ellipsize(GTK_LABEL(w->status), PANGO_ELLIPSIZE_END);
    gtk_widget_add_css_class(w->status, "dim-label");
    gtk_widget_set_margin_start(w->status, 6);
    gtk_box_append(GTK_BOX(box), overlay);
    w->timeline = timeline_new(w->document);
    gtk_box_append(GTK_BOX(box), w->timeline);
    gtk_box_append(GTK_BOX(box), w->status);
    return box;
}

static GtkWidget *make_flap(GtkWidget *flap, GtkWidget *content, GtkPackType side)
{
    GtkWidget *out = adw_flap_new();
    adw_flap_set_flap(ADW_FLAP(out), flap);
    adw_flap_set_content(ADW_FLAP(out), content);
    adw_flap_set_flap_position(ADW_FLAP(out), side);
    adw_flap_set_separator(ADW_FLAP(out), gtk_separator_new(GTK_ORIENTATION_VERTICAL));
    adw_flap_set_swipe_to_open(ADW_FLAP(out), FALSE);
    adw_flap_set_swipe_to_close(ADW_FLAP(out), FALSE);
    return out;
}

static void view_window_dispose(GObject *object)
{
    ViewWindow *w = LIMNER_VIEW_WINDOW(object);
    g_clear_handle_id(&w->reload, g_source_remove);
    g_clear_handle_id(&w->turntable, g_source_remove);
    g_clear_pointer(&w->watches, g_ptr_array_unref);
    g_clear_object(&w->cameras);
    g_clear_object(&w->recent);
    if (w->loading)
        g_cancellable_cancel(w->loading);
    g_clear_pointer(&w->loading_paths, g_strfreev);
    session_clear(&w->restored);
    if (w->picture)
        picture_close(LIMNER_PICTURE(w->picture));
    if (w->gallery)
        gallery_close(w->gallery);
    w->picture = w->gallery = NULL;
    g_clear_pointer(&w->artist, artist_end);
    G_OBJECT_CLASS(view_window_parent_class)->dispose(object);
    g_clear_pointer(&w->document, document_free);
}

static void view_window_class_init(ViewWindowClass *class)
{
    G_OBJECT_CLASS(class)->dispose = view_window_dispose;
}

static void view_window_init(ViewWindow *w)
{
    w->document = document_make();
    w->artist = artist_start();
    if (!w->document || !w->artist)
        g_error("limner: there is no memory for a window");
    w->cameras = g_menu_new();
    w->recent = g_menu_new();
    w->watches = g_ptr_array_new_with_free_func(stop_watch);
    g_action_map_add_action_entries(G_ACTION_MAP(w), actions, G_N_ELEMENTS(actions), w);
    GtkWidget *middle = make_middle(w);
    GtkWidget *right = make_flap(make_panel(w), middle, GTK_PACK_END);
    GtkWidget *lists = gtk_paned_new(GTK_ORIENTATION_VERTICAL);
    gtk_paned_set_start_child(GTK_PANED(lists), parts_new(w->document));
    gtk_paned_set_end_child(GTK_PANED(lists), solids_new(w->document));
    GtkWidget *left = make_flap(lists, right, GTK_PACK_START);
    w->toasts = adw_toast_overlay_new();
    adw_toast_overlay_set_child(ADW_TOAST_OVERLAY(w->toasts), left);
    gtk_widget_set_vexpand(w->toasts, TRUE);
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    gtk_box_append(GTK_BOX(box), make_header(w, left, right));
    gtk_box_append(GTK_BOX(box), w->toasts);
    adw_application_window_set_content(ADW_APPLICATION_WINDOW(w), box);
    w->left = left;
    w->right = right;
    w->restored = session_read();
    adw_flap_set_reveal_flap(ADW_FLAP(left), w->restored.lists);
    adw_flap_set_reveal_flap(ADW_FLAP(right), w->restored.panel);
    gtk_window_set_default_size(GTK_WINDOW(w), w->restored.width > 0 ? w->restored.width : 1280,
                                w->restored.height > 0 ? w->restored.height : 900);
    if (w->restored.maximized)
        gtk_window_maximize(GTK_WINDOW(w));
    g_signal_connect(w, "close-request", G_CALLBACK(closing), NULL);
    list_recent(w);
    GtkDropTarget *drop = gtk_drop_target_new(GDK_TYPE_FILE_LIST, GDK_ACTION_COPY);
    g_signal_connect(drop, "drop", G_CALLBACK(dropped), w);
    gtk_widget_add_controller(GTK_WIDGET(w), GTK_EVENT_CONTROLLER(drop));
    document_listen(w->document, document_changed, w);
    document_changed(w->document, 0, w);
}

ViewWindow *view_window_new(AdwApplication *application)
{
    return g_object_new(VIEW_WINDOW_TYPE, "application", application, NULL);
}
