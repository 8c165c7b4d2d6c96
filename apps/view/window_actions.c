/* What a window's menus, buttons and keys do. */
#include <math.h>

#include "cameras.h"
#include "command.h"
#include "export.h"
#include "look_files.h"
#include "picture.h"
#include "picture_out.h"
#include "section.h"
#include "shortcuts.h"
#include "strokes_window.h"
#include "timeline.h"
#include "trace.h"
#include "window_private.h"
#include "words.h"

enum { TURNTABLE_MS = 33 };

#define ACTION(name) static void name(GSimpleAction *action, GVariant *value, gpointer user)
#define UNUSED       (void)action, (void)value

ACTION(do_open)
{
    UNUSED;
    GtkFileChooserNative *dialog =
        gtk_file_chooser_native_new(_("Open model"), user, GTK_FILE_CHOOSER_ACTION_OPEN, _("_Open"), _("_Cancel"));
    gtk_file_chooser_set_select_multiple(GTK_FILE_CHOOSER(dialog), TRUE);
    g_signal_connect(dialog, "response", G_CALLBACK(window_file_chosen), user);
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

/* Jobs hold the picture and not the window, which would outlive its application else. */
static document *document_of(GObject *picture)
{
    return picture_document(LIMNER_PICTURE(picture));
}

void view_window_fit(ViewWindow *w, const char *what)
{
    const scene_ref *scene = document_scene(w->document);
    int              width, height;
    view_window_picture_size(w, &width, &height);
    if (scene)
        cameras_fit(G_OBJECT(w->picture), document_of, w->artist, (scene_ref *)scene, document_state(w->document),
                    width, height, what);
}

ACTION(do_fit)
{
    UNUSED;
    view_window_fit(user, "Fit");
}

ACTION(do_view)
{
    static const char *const names[] = {"iso", "front", "back", "left", "right", "top", "bottom"};
    (void)action;
    ViewWindow      *w = user;
    const scene_ref *scene = document_scene(w->document);
    orbit            o = document_state(w->document)->view;
    int              width, height;
    view_window_picture_size(w, &width, &height);
    if (scene && g_strcmp0(g_variant_get_string(value, NULL), "best") == 0) {
        cameras_best(G_OBJECT(w->picture), document_of, w->artist, (scene_ref *)scene, document_state(w->document),
                     width, height);
        return;
    }
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        if (g_strcmp0(names[i], g_variant_get_string(value, NULL)) == 0)
            orbit_turn_to(&o, (lmn_view)i);
    if (scene)
        orbit_fit(&o, scene->info.bounds_min, scene->info.bounds_max, width, height);
    document_end_step(w->document);
    document_set_view(w->document, &o, "View");
    view_window_fit(w, "View");
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
        trace_event("not-copied %s", error->message);
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
    copy_text(w, words ? command_line((const char *const *)words) : NULL, &error, _("Command copied"));
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
              _("Program in C copied"));
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
        view_window_say(w, _("Walk with W, A, S, D, Q, E; drag to look around"));
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
        view_window_say(w, _("Left of the divider the look stays as it is now"));
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

ACTION(do_camera)
{
    (void)action;
    ViewWindow *w = user;
    cameras_go(G_OBJECT(w->picture), document_of, w->artist, (scene_ref *)document_scene(w->document),
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
    picture_out_copy(user);
}

ACTION(do_print)
{
    UNUSED;
    picture_out_print(user);
}

ACTION(do_strokes)
{
    UNUSED;
    strokes_window_open(user);
}

ACTION(do_tour)
{
    (void)value;
    tour_run(LIMNER_VIEW_WINDOW(user)->tour, toggled(action));
}

/* Whatever somebody does with pointer or keys, a presentation stands still for it. */
gboolean window_somebody_acts(GtkEventControllerLegacy *events, GdkEvent *event, gpointer user)
{
    (void)events;
    GdkEventType type = gdk_event_get_event_type(event);
    if (type == GDK_BUTTON_PRESS || type == GDK_KEY_PRESS || type == GDK_SCROLL || type == GDK_TOUCH_BEGIN)
        tour_interrupt(LIMNER_VIEW_WINDOW(user)->tour);
    return FALSE;
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
    {.name = "print", .activate = do_print},
    {.name = "strokes", .activate = do_strokes},
    {.name = "tour", .activate = do_tour, .state = "false"},
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

void window_document_changed(document *d, unsigned changes, void *user)
{
    ViewWindow *w = user;
    bool        scene = document_scene(d) != NULL, part = document_selected(d) != 0;
    enable(w, "undo", document_undo_name(d) != NULL);
    enable(w, "redo", document_redo_name(d) != NULL);
    enable(w, "hide", part);
    enable(w, "alone", part);
    static const char *const of_scene[] = {"fit",          "view",   "section",      "camera",   "export", "print",
                                           "copy-command", "copy-c", "copy-picture", "parallel", "compare"};
    for (size_t i = 0; i < G_N_ELEMENTS(of_scene); i++)
        enable(w, of_scene[i], scene);
    if (changes & DOCUMENT_VIEW)
        set_toggle(G_SIMPLE_ACTION(g_action_map_lookup_action(G_ACTION_MAP(w), "parallel")),
                   document_state(d)->view.orthographic);
}

void window_add_actions(ViewWindow *w)
{
    g_action_map_add_action_entries(G_ACTION_MAP(w), actions, G_N_ELEMENTS(actions), w);
}
